//! Nilsson's bounds: the lateral offset that a single-piece planar profile corrects without rotation.
//!
//! ```text
//!      q ╲        ╱             offset s: the moving half's minimum p slides home as long as
//!         ╲  ▼p  ╱              it has not passed the fixed half's maximum q:   s < q − p
//!          ╲    ╱
//!           ╲╱╲╱       climb(s) = max { f(u) − f(v) : u − v = s }   = the height of first contact
//! ```
//!
//! **Rule.** At an offset s to +x the halves touch at height climb(s), and slide into the seat from all s
//! below the first value at which climb stops rising. There the moving half's minimum p stands over the fixed
//! half's maximum q: with p, q among the extrema of the profile, including its ends, such that nothing
//! between them is lower than f(p) or higher than f(q),
//!
//! `reach₊ = min { q − p : p < q, f(q) − f(p) = climb(q − p), climb rises no further }`,
//!
//! and 0 if climb does not rise from 0. Towards −x the same holds for the mirrored profile. The offset
//! corrected to *both* sides is the smaller reach. For a single minimum m in [0, D], and maxima at the ends,
//! it is min(m, D − m); for a profile that a half turn maps onto itself, with one maximum at M < D/2, hence
//! its minimum at D − M, it is min(M, D − 2M) (M: the left end's climb; D − 2M: from the maximum to the
//! minimum).
//!
//! **Bounds.** No profile of width D corrects more than D/2 to both sides, and no profile with equal halves,
//! f(D − x) = c − f(x), more than D/3: reached with x(min) = D/2, and with x(max) = D/3, x(min) = 2D/3. A
//! monotone profile corrects nothing to one side. Source: Nilsson, as stated in the dissertation at the
//! beginning of chapter 3. The rule for arbitrary extrema is our own; tests with random profiles confirm that
//! none exceeds the bounds.
//!
//! Not promised: results for halves in layers, with play, or with steps ([`Profile::of`] finds no profile
//! there), or the effect of `docked.depth`: an offset whose whole climb is at most that depth counts as
//! docked at its start. Lengths in D.

use super::Zraa;
use super::profile::HeightProfile;
use crate::contact::Pair;
use crate::pose::Dof;
use crate::tolerance::ROUNDING;
use glam::DVec2;

/// Limit of a side: the moving half's minimum must stay short of the fixed half's maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Catch {
    /// x of the minimum on the moving half, mated, in D.
    pub minimum: f64,
    /// x of the maximum on the fixed half, in D.
    pub maximum: f64,
}

impl Catch {
    /// The largest offset, in D: positive to +x, negative to −x.
    pub fn reach(&self) -> f64 {
        self.maximum - self.minimum
    }
}

/// Offsets that a profile corrects without rotation, compared with the bound for its kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nilsson {
    /// Whether both halves are alike: then the bound is a third of the width, else half of it.
    pub ungendered: bool,
    /// Width of the profile, in D.
    pub width: f64,
    /// Limits of offsets to −x and to +x; `None` if nothing is corrected.
    pub catches: [Option<Catch>; 2],
}

impl Nilsson {
    /// The comparison for the exact offsets along x, if the halves of a pair meet along a single profile.
    pub fn beside(zraa: &Zraa, pair: &Pair) -> Option<Self> {
        matches!(zraa, Zraa::Interval { axis: Dof::X, .. }).then_some(())?;
        HeightProfile::of(pair).map(|profile| Self::of(&profile))
    }

    /// Of a profile.
    pub fn of(profile: &HeightProfile) -> Self {
        let behind = reach(&profile.mirrored())
            .map(|result| Catch { minimum: -result.minimum, maximum: -result.maximum });
        Self {
            ungendered: profile.is_point_symmetric(),
            width: profile.width(),
            catches: [behind, reach(profile)],
        }
    }

    /// The most that any profile of this kind corrects to both sides, in widths of the profile: 1/2, ungendered 1/3.
    pub const fn share(&self) -> f64 {
        if self.ungendered { 1.0 / 3.0 } else { 0.5 }
    }

    /// The same in D.
    pub fn bound(&self) -> f64 {
        self.share() * self.width
    }

    /// Corrected offsets, from the most negative to the most positive, in D.
    pub fn reaches(&self) -> [f64; 2] {
        self.catches.map(|side| side.map_or(0.0, |result| result.reach()))
    }

    /// The offset that is corrected to both sides, in D.
    pub fn both(&self) -> f64 {
        let [from, to] = self.reaches();
        to.min(-from)
    }
}

/// The limit of offsets to +x.
fn reach(profile: &HeightProfile) -> Option<Catch> {
    let curve = Curve(profile.corners());
    if curve.steepest() <= ROUNDING {
        return None;
    }
    // Ends are extrema too: the half ends there.
    let n = curve.0.len();
    let minima = (0..n).filter(|&k| k == 0 || curve.0[k - 1].y >= curve.0[k].y);
    let maxima: Vec<usize> = (0..n).filter(|&k| k + 1 == n || curve.0[k + 1].y <= curve.0[k].y).collect();
    let mut pairs: Vec<Catch> = minima
        .flat_map(|p| maxima.iter().filter(move |q| p < **q).map(move |q| (p, *q)))
        .map(|(p, q)| Catch { minimum: curve.0[p].x, maximum: curve.0[q].x })
        .collect();
    pairs.sort_by(|a, b| a.reach().total_cmp(&b.reach()));
    pairs.into_iter().find(|pair| {
        let (height, rises) = curve.climb(pair.reach());
        !rises && curve.at(pair.maximum) - curve.at(pair.minimum) >= height - ROUNDING
    })
}

/// The corners of a profile, from left to right.
struct Curve<'a>(&'a [DVec2]);

impl Curve<'_> {
    /// The segment that contains an x; at a corner the segment to its left, or with `right` that to its
    /// right.
    fn piece(&self, x: f64, right: bool) -> [DVec2; 2] {
        let before = if right {
            self.0.partition_point(|p| p.x <= x + ROUNDING)
        } else {
            self.0.partition_point(|p| p.x < x - ROUNDING)
        };
        let k = before.clamp(1, self.0.len() - 1);
        [self.0[k - 1], self.0[k]]
    }

    fn at(&self, x: f64) -> f64 {
        let [a, b] = self.piece(x, true);
        a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x))
    }

    fn slope(&self, x: f64, right: bool) -> f64 {
        let [a, b] = self.piece(x, right);
        (b.y - a.y) / (b.x - a.x)
    }

    fn steepest(&self) -> f64 {
        self.0.windows(2).map(|w| (w[1].y - w[0].y) / (w[1].x - w[0].x)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// climb(s), and whether it rises further. The highest pair has a corner of the profile at one of its
    /// ends: between corners both its heights are linear.
    fn climb(&self, s: f64) -> (f64, bool) {
        let (first, last) = (self.0[0].x, self.0[self.0.len() - 1].x);
        let mut pairs = Vec::new();
        for corner in self.0 {
            let (left, right) = (corner.x - s, corner.x + s);
            if left >= first - ROUNDING {
                // A longer climb begins farther left, if there is profile left.
                let rises = left > first + ROUNDING && self.slope(left, false) > ROUNDING;
                pairs.push((corner.y - self.at(left), rises));
            }
            if right <= last + ROUNDING {
                let rises = right < last - ROUNDING && self.slope(right, true) > ROUNDING;
                pairs.push((self.at(right) - corner.y, rises));
            }
        }
        let height = pairs.iter().map(|pair| pair.0).fold(f64::NEG_INFINITY, f64::max);
        (height, pairs.iter().any(|(h, rises)| *rises && *h >= height - ROUNDING))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{pair, pair_of};
    use super::super::{Zraa, ZraaError, ZraaSettings, run};
    use super::*;
    use crate::connector::Connector;
    use crate::contact::mated::MatedProblem;
    use crate::design::{ConnectorSpec, Family, FamilySpec, HalfSpec, OwnSpec};
    use crate::exec::Exec;
    use proptest::prelude::*;

    /// Corners lie on this many columns, so that halves and thirds of the width are among them.
    const COLUMNS: u32 = 24;

    /// A profile of width 1 around 0: inner corners on columns, heights in eighths of D.
    fn profile(inner: &[(u32, i32)], ends: [i32; 2]) -> HeightProfile {
        let mut inner = inner.to_vec();
        inner.sort_unstable();
        inner.dedup_by_key(|corner| corner.0);
        let corner = |column: u32, z: i32| {
            DVec2::new(f64::from(column) / f64::from(COLUMNS) - 0.5, f64::from(z) / 8.0)
        };
        let mut corners = vec![corner(0, ends[0])];
        corners.extend(inner.iter().map(|(column, z)| corner(*column, *z)));
        corners.push(corner(COLUMNS, ends[1]));
        HeightProfile::new(&corners).unwrap()
    }

    /// A profile that a half turn maps onto itself: its left half is drawn, its middle lies at height 0.
    fn symmetric(left: &[(u32, i32)], end: i32) -> HeightProfile {
        let mut left = left.to_vec();
        left.sort_unstable();
        left.dedup_by_key(|corner| corner.0);
        let other = left.iter().map(|(column, z)| (COLUMNS - column, -z));
        let inner: Vec<_> = left.iter().copied().chain([(COLUMNS / 2, 0)]).chain(other).collect();
        profile(&inner, [end, -end])
    }

    /// Columns of material under a profile, down to z = −2, as a half that faces +z.
    fn columns(corners: &[DVec2]) -> HalfSpec {
        let block = |w: &[DVec2]| {
            let [a, b] = [w[0], w[1]];
            let ring = [(a.x, -2.0), (b.x, -2.0), (b.x, b.y), (a.x, a.y)];
            ring.iter().flat_map(|(x, z)| [[*x, -0.5, *z], [*x, 0.5, *z]]).collect()
        };
        HalfSpec::Pieces(corners.windows(2).map(block).collect())
    }

    /// Exact result for the solids of a profile and of its counterpart.
    fn exact(profile: &HeightProfile) -> Result<Zraa, ZraaError> {
        // The moving half is mounted by a half turn about y: drawn, it is the profile turned in its plane.
        let turned: Vec<DVec2> = profile.corners().iter().rev().map(|p| -*p).collect();
        let own = OwnSpec::new(0.0, columns(profile.corners()), columns(&turned));
        let pair = pair_of(ConnectorSpec::Own(own), true);
        let result = HeightProfile::of(&pair).unwrap();
        let same = |(a, b): (&DVec2, &DVec2)| a.distance(*b) < 1e-12;
        assert_eq!(result.corners().len(), profile.corners().len());
        assert!(result.corners().iter().zip(profile.corners()).all(same), "{result:?} {profile:?}");
        run(&pair, &ZraaSettings::default(), &Exec::new())
    }

    /// The reaches are those of the solids, which know nothing of extrema.
    fn agree(profile: &HeightProfile) {
        let result = Nilsson::of(profile);
        let [from, to] = result.reaches();
        match exact(profile) {
            Ok(Zraa::Interval { from: exact_from, to: exact_to, .. }) => {
                let off = (exact_from - from).abs().max((exact_to - to).abs());
                assert!(off < 1e-9, "{from} … {to}, solids {exact_from} … {exact_to}: {profile:?}");
            }
            Err(ZraaError::NotHeld(MatedProblem::NotMinimum { .. })) => {
                assert!(result.catches.contains(&None), "{result:?}: {profile:?}");
            }
            other => panic!("{other:?}: {profile:?}"),
        }
    }

    fn inner() -> impl Strategy<Value = Vec<(u32, i32)>> {
        prop::collection::vec((1..COLUMNS, -8i32..8), 0..7)
    }

    fn left() -> impl Strategy<Value = Vec<(u32, i32)>> {
        prop::collection::vec((1..COLUMNS / 2, -8i32..8), 0..5)
    }

    /// Level segments are seats of their own, or ground on which nothing slides: the theorem excludes them.
    fn has_no_level(profile: &HeightProfile) -> bool {
        profile.corners().windows(2).all(|w| (w[0].y - w[1].y).abs() > ROUNDING)
    }

    proptest! {
        #[test]
        fn the_rule_agrees_with_solids(inner in inner(), ends in [-8i32..8, -8i32..8]) {
            let profile = profile(&inner, ends);
            prop_assume!(has_no_level(&profile));
            agree(&profile);
        }

        #[test]
        fn the_rule_agrees_for_ungendered_halves(left in left(), end in -8i32..8) {
            let profile = symmetric(&left, end);
            prop_assume!(has_no_level(&profile));
            prop_assert!(Nilsson::of(&profile).ungendered);
            agree(&profile);
        }

        #[test]
        fn a_monotone_profile_has_no_offset_to_both_sides(steps in prop::collection::vec(1i32..5, 2..8)) {
            let mut z = 0;
            let inner: Vec<_> = (1..).zip(&steps).map(|(k, step)| { z += step; (k, z) }).collect();
            let result = Nilsson::of(&profile(&inner, [0, z + 1]));
            prop_assert_eq!(result.both(), 0.0);
            prop_assert_eq!(result.reaches(), [0.0, 1.0]);
        }

        /// Seen from behind the sides change places; turned upside down, halves exchange their parts.
        #[test]
        fn mirrored_profiles_have_mirrored_reaches(inner in inner(), ends in [-8i32..8, -8i32..8]) {
            let profile = profile(&inner, ends);
            let [from, to] = Nilsson::of(&profile).reaches();
            let upside_down: Vec<DVec2> = profile.corners().iter().map(|p| DVec2::new(p.x, -p.y)).collect();
            for other in [profile.mirrored(), HeightProfile::new(&upside_down).unwrap()] {
                let [other_from, other_to] = Nilsson::of(&other).reaches();
                prop_assert!((from + other_to).abs() < 1e-12 && (to + other_from).abs() < 1e-12);
            }
        }
    }

    /// No random profile is above the bounds, and some reach them: the search walks uphill from thousands of starts.
    #[test]
    fn no_profile_beats_the_bounds_and_a_search_reaches_them() {
        const STARTS: usize = 300;
        const STEPS: usize = 60;
        let mut state = 7u64;
        let mut dice = |n: u32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32 % n
        };
        for ungendered in [false, true] {
            let columns = if ungendered { COLUMNS / 2 } else { COLUMNS };
            let bound = if ungendered { 1.0 / 3.0 } else { 0.5 };
            let both = |inner: &[(u32, i32)], ends: [i32; 2]| {
                let profile = if ungendered { symmetric(inner, ends[0]) } else { profile(inner, ends) };
                Nilsson::of(&profile).both()
            };
            let mut best = 0.0f64;
            for _ in 0..STARTS {
                let count = dice(6) as usize;
                let mut corner = || (1 + dice(columns - 1), dice(17).cast_signed() - 8);
                let mut inner: Vec<_> = (0..count).map(|_| corner()).collect();
                let mut ends = [corner().1, corner().1];
                let mut here = both(&inner, ends);
                for _ in 0..STEPS {
                    let (mut next, mut next_ends) = (inner.clone(), ends);
                    let new = corner();
                    match new.1.rem_euclid(4) {
                        0 => next_ends[new.0 as usize % 2] = new.1,
                        1 => next.truncate(next.len().saturating_sub(1)),
                        2 if !next.is_empty() => next[0] = new,
                        _ => next.push(new),
                    }
                    let there = both(&next, next_ends);
                    assert!(there <= bound + 1e-12, "{there} beats {bound}: {next:?} {next_ends:?}");
                    if there >= here {
                        (inner, ends, here) = (next, next_ends, there);
                    }
                }
                best = best.max(here);
            }
            assert!((best - bound).abs() < 1e-12, "{best} of {bound}");
        }
    }

    #[test]
    fn the_faces_reach_their_bounds_and_report_the_minimum() {
        for (family, ungendered, reach) in [(Family::VFace, false, 0.5), (Family::SFace, true, 1.0 / 3.0)] {
            for base in [None, Some(0.4)] {
                let pair = pair(FamilySpec::new(family).with_base_thickness(base));
                let result = Nilsson::of(&HeightProfile::of(&pair).unwrap());
                assert_eq!(result.ungendered, ungendered);
                assert!((result.bound() - reach).abs() < 1e-12 && (result.both() - reach).abs() < 1e-12);
                let [_, to] = result.catches.map(Option::unwrap);
                // V: the tip up to the rim. S: the climb of the left end to the maximum at −D/6, which comes
                // before the right end's climb.
                let minimum = if ungendered { [-0.5, 1.0 / 6.0] } else { [0.0; 2] };
                assert!(minimum.iter().any(|x| (to.minimum - x).abs() < 1e-12), "{to:?}");
            }
        }
        // Two layers are no profile; neither are halves with play between them.
        assert_eq!(HeightProfile::of(&pair(FamilySpec::new(Family::XFace))), None);
        assert_eq!(HeightProfile::of(&pair(FamilySpec::new(Family::Pyramid))), None);
        let flat = [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.0)];
        let ramp = [DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.3)];
        let own = OwnSpec::new(0.0, columns(&flat), columns(&ramp));
        let design = crate::design::Design {
            name: String::new(),
            connector: ConnectorSpec::Own(own),
            width: 1.0,
            unit: None,
            alignment: crate::design::Alignment::default_for(Some(Family::VFace)),
        };
        let apart = crate::contact::Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
        assert_eq!(HeightProfile::of(&apart), None);
    }

    /// Slopes of 12 meet gentle slopes: rounding at such a kink is not a wall.
    #[test]
    fn steep_kinks_are_no_walls() {
        let left = [(-0.5, -0.125), (-1.0 / 3.0, -0.875), (-7.0 / 24.0, -0.375)];
        let corners: Vec<DVec2> = left
            .into_iter()
            .chain(left.into_iter().rev().map(|(x, z)| (-x, -z)))
            .map(|(x, z)| DVec2::new(x, z))
            .collect();
        agree(&HeightProfile::new(&corners).unwrap());
    }

    /// A single minimum at m, ends higher: min(m, D − m). A single maximum at M of a symmetric profile:
    /// min(M, D − 2M).
    #[test]
    fn single_extrema_have_closed_forms() {
        for m in 1..COLUMNS {
            let at = f64::from(m) / f64::from(COLUMNS);
            let result = Nilsson::of(&profile(&[(m, -8)], [3, 5]));
            assert!((result.both() - at.min(1.0 - at)).abs() < 1e-12, "{m}: {result:?}");
        }
        for m in 1..COLUMNS / 2 {
            let at = f64::from(m) / f64::from(COLUMNS);
            let result = Nilsson::of(&symmetric(&[(m, 8)], 1));
            assert!((result.both() - at.min(1.0 - 2.0 * at)).abs() < 1e-12, "{m}: {result:?}");
        }
    }
}
