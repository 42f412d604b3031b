//! The outline of a layer, derived from the dissertation's sentences.
//!
//! 1. The arm's profile y = f(x) from the outer edge to the hook at xₑ = L/2 + o/2.
//! 2. The hook: down to y = 0, back under the overhang to L/2 − o/2, down to −h: the trench for the partner's hook.
//! 3. The same profile turned by 180° about (L/2, 0), down to −f(0) at x = L.
//! 4. The stop slit, cut into it from above; left of it the neck, left of that the cut-out, open at the outer edge. The arm
//!    hangs on the neck alone.
//! 5. The body below, to which everything is fixed.
//!
//! Why the slit lies right of the hook, inside the part, although its distance is stated without saying from what: f falls
//! everywhere and its tangent at the hook passes through P (both stated), so that P lies below and to the *right* of the hook.
//! Pressing then pushes the hook outward with the longest lever, tension turns the arm clockwise, closes the slit and drives the hook deeper
//! into the partner's trench, all as stated. Fifteen millimetres from the outer edge would put P on the left.
//!
//! Curves are polylines whose corners lie on the curve; chords are off by less than [`CHORD`]. Both halves share their corners, so
//! that they mate without gap or overlap.

use super::Latch;
use super::profile::Profile;
use glam::DVec2;

/// Steps of the profile.
const STEPS: usize = 256;
/// What a chord may be off from the curve, in mm: a fiftieth of a usual kerf. A test holds it at the defaults.
pub const CHORD: f64 = 0.004;
/// Halvings of the search for the end angle: down to the last bit.
const HALVINGS: usize = 200;
/// The steepest end angle that is tried, in rad: beyond it the profile is a wall.
const STEEPEST: f64 = 89.9 * std::f64::consts::PI / 180.0;

/// Knots nearer than this are one, in mm.
const SAME: f64 = 1e-9;

/// A closed curve, counter-clockwise, without its first point at the end.
pub type Polygon = Vec<DVec2>;

/// Why there is no outline.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// The pivot is not to the right of the hook.
    #[error(
        "the neck must stand right of the hook: its middle is at x = {pivot:.2} mm, the hook ends at {hook:.2} mm"
    )]
    PivotLeft {
        /// Where the middle of the neck is.
        pivot: f64,
        /// Where the hook ends.
        hook: f64,
    },
    /// The slit leaves the face.
    #[error("the slit lies outside the face: it ends at x = {slit:.2} mm of {width:.2} mm")]
    SlitOutside {
        /// Its far side.
        slit: f64,
        /// The face.
        width: f64,
    },
    /// The tangent that passes through P is flatter than the start: the curve would have to bend upwards.
    #[error(
        "no falling profile of negative curvature ends in a tangent through P: it would start at {start:.1}° and end at no more"
    )]
    NoProfile {
        /// Its angle at the outer edge, in degrees.
        start: f64,
    },
}

impl GeometryError {
    /// The key of the design file that it is about.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::PivotLeft { .. } | Self::SlitOutside { .. } => "slit_distance",
            Self::NoProfile { .. } => "spline_start",
        }
    }

    /// What helps.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::PivotLeft { .. } => "a larger slit_distance moves it; 15 mm was found to be sufficient",
            Self::SlitOutside { .. } => "a smaller slit_distance moves it inward",
            Self::NoProfile { .. } => {
                "start flatter (35 deg was found to be best), or put P lower: cutout_depth and l_eq decide it"
            }
        }
    }
}

/// The outline of a layer in numbers; mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Width of the face.
    pub width: f64,
    /// Overhang.
    pub overhang: f64,
    /// The arm's profile.
    pub profile: Profile,
    /// The middle of the neck, about which the arm turns.
    pub pivot: DVec2,
    /// Thickness of the neck.
    pub neck: f64,
    /// Near and far side of the stop slit.
    pub slit: [f64; 2],
    /// Its lower end.
    pub slit_end: f64,
    /// Lower and upper side of the cut-out.
    pub cutout: [f64; 2],
    /// The lower edge.
    pub bottom: f64,
    /// Middles of the dowel holes, and their diameter.
    pub dowels: Option<([DVec2; 2], f64)>,
}

impl Geometry {
    /// The outline that follows from the parameters.
    ///
    /// # Errors
    /// No profile meets them.
    pub fn of(latch: &Latch) -> Result<Self, GeometryError> {
        let middle = 0.5 * latch.width;
        let x_end = middle + 0.5 * latch.overhang;
        let near = middle + latch.slit_distance;
        let slit = [near, near + latch.slit_gap];
        let pivot_x = near - 0.5 * latch.neck;
        if pivot_x <= x_end {
            return Err(GeometryError::PivotLeft { pivot: pivot_x, hook: x_end });
        }
        if slit[1] >= latch.width {
            return Err(GeometryError::SlitOutside { slit: slit[1], width: latch.width });
        }
        let face = |profile: &Profile| -profile.height(latch.width - near);
        let pivot_y = |profile: &Profile| face(profile) - latch.cutout_depth + 0.5 * latch.l_eq;
        let end = match latch.spline_end {
            Some(end) => end,
            None => through_pivot(latch, pivot_x, &pivot_y)?,
        };
        let profile = Profile::of(latch, end);
        let (face, bottom) = (face(&profile), -latch.base);
        let slit_end = face - latch.slit_depth;
        let dowels = latch.dowel.map(|diameter| {
            let y = 0.5 * (slit_end + bottom);
            ([DVec2::new(0.2 * latch.width, y), DVec2::new(0.8 * latch.width, y)], diameter)
        });
        Ok(Self {
            width: latch.width,
            overhang: latch.overhang,
            profile,
            pivot: DVec2::new(pivot_x, pivot_y(&profile)),
            neck: latch.neck,
            slit,
            slit_end,
            cutout: [face - latch.cutout_depth, face - latch.cutout_depth + latch.l_eq],
            bottom,
            dowels,
        })
    }

    /// Lever from P to the hook's upper corner: across and up, both positive.
    pub fn lever(&self) -> DVec2 {
        DVec2::new(self.pivot.x - self.profile.x_end, self.profile.hook - self.pivot.y)
    }

    /// How far the tangent at the hook passes from P.
    pub fn tangent_miss(&self) -> f64 {
        let lever = self.lever();
        let (sin, cos) = self.profile.end.sin_cos();
        (lever.x * sin - lever.y * cos).abs()
    }

    /// Height of the arm's outer edge, the highest point: f(0).
    pub fn height(&self) -> f64 {
        self.profile.height(0.0)
    }

    /// x of the face's corners, left half: even steps, and the places that the slit cuts in the turned half.
    fn knots(&self) -> Vec<f64> {
        let x_end = self.profile.x_end;
        let mut knots: Vec<f64> = (0..=STEPS).map(|k| x_end * k as f64 / STEPS as f64).collect();
        for x in self.slit {
            let x = self.width - x;
            // A knot that all but coincides would leave an edge without direction.
            knots.retain(|k| (k - x).abs() > 1e-3 * x_end / STEPS as f64 || *k == 0.0 || *k == x_end);
            knots.push(x);
        }
        knots.retain(|x| (0.0..=x_end).contains(x));
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    }

    /// The profile of the arm from the outer edge to the hook.
    pub fn arm_profile(&self) -> Vec<DVec2> {
        self.knots().into_iter().map(|x| DVec2::new(x, self.profile.height(x))).collect()
    }

    /// The point turned by 180° about the middle of the overhang.
    pub fn turned(&self, p: DVec2) -> DVec2 {
        DVec2::new(self.width - p.x, -p.y)
    }

    /// The face from the outer edge to the lowest point, with the hook.
    pub fn face(&self) -> Vec<DVec2> {
        let arm = self.arm_profile();
        let x_end = self.profile.x_end;
        let mut face = arm.clone();
        face.push(DVec2::new(x_end, 0.0));
        face.push(DVec2::new(self.width - x_end, 0.0));
        face.extend(arm.iter().rev().map(|p| self.turned(*p)));
        face
    }

    /// A layer without slit and cut-out, as if the arm were rigid.
    pub fn solid(&self) -> Polygon {
        let mut around = self.face();
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.reverse();
        around
    }

    /// A layer as it is cut.
    pub fn layer(&self) -> Polygon {
        let [near, far] = self.slit;
        let neck = near - self.neck;
        // The slit's upper corners are knots of the face: what lies between them is cut away.
        let face = self.face();
        let left = face.iter().filter(|p| p.y >= 0.0 || p.x < near + SAME);
        let right = face.iter().filter(|p| p.y < 0.0 && p.x > far - SAME);
        let mut around: Polygon = left.copied().collect();
        around.extend([DVec2::new(near, self.slit_end), DVec2::new(far, self.slit_end)]);
        around.extend(right);
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        let [low, high] = self.cutout;
        around.extend([(0.0, low), (neck, low), (neck, high), (0.0, high)].map(|(x, y)| DVec2::new(x, y)));
        around.reverse();
        around
    }

    /// The part of a layer that turns as one: above the cut-out, left of the slit.
    pub fn arm(&self) -> Polygon {
        let near = self.slit[0];
        let mut around: Vec<DVec2> =
            self.face().into_iter().filter(|p| p.y >= 0.0 || p.x < near + SAME).collect();
        around.push(DVec2::new(near, self.cutout[1]));
        around.push(DVec2::new(0.0, self.cutout[1]));
        around.reverse();
        around
    }

    /// The rest of it, without the neck: what is fixed to the module.
    pub fn body(&self) -> Polygon {
        let far = self.slit[1];
        let mut around: Vec<DVec2> =
            self.face().into_iter().filter(|p| p.y < 0.0 && p.x > far - SAME).collect();
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.push(DVec2::new(0.0, self.cutout[0]));
        around.push(DVec2::new(far, self.cutout[0]));
        around.reverse();
        around
    }

    /// The sheet between the layers: what both have in common, without hooks.
    ///
    /// Only there does it leave the partner's separator free; the union of both layers would stand 2·f high in its way.
    pub fn separator(&self) -> Polygon {
        let middle = 0.5 * self.width;
        let left: Vec<DVec2> = self.arm_profile().into_iter().filter(|p| p.x < middle).collect();
        let mut around: Vec<DVec2> = left.iter().map(|p| DVec2::new(p.x, -p.y)).collect();
        around.push(DVec2::new(middle, -self.profile.height(middle)));
        around.extend(left.iter().rev().map(|p| DVec2::new(self.width - p.x, -p.y)));
        around.push(DVec2::new(self.width, self.bottom));
        around.push(DVec2::new(0.0, self.bottom));
        around.reverse();
        around
    }

    /// The mirror image, counter-clockwise again.
    pub fn mirrored(&self, polygon: &[DVec2]) -> Polygon {
        polygon.iter().rev().map(|p| DVec2::new(self.width - p.x, p.y)).collect()
    }
}

/// The angle at the hook with which the tangent there passes through P. P moves with the angle, because the slit is measured
/// from the face.
fn through_pivot(
    latch: &Latch,
    pivot_x: f64,
    pivot_y: &impl Fn(&Profile) -> f64,
) -> Result<f64, GeometryError> {
    let flatter_than_p = |end: f64| {
        let profile = Profile::of(latch, end);
        end.tan() * (pivot_x - profile.x_end) < profile.hook - pivot_y(&profile)
    };
    // Beyond the steepest angle the tangent is steeper than any line to P.
    let (mut low, mut high) = (latch.spline_start, STEEPEST);
    if !flatter_than_p(low) || flatter_than_p(high) {
        return Err(GeometryError::NoProfile { start: latch.spline_start.to_degrees() });
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if flatter_than_p(middle) { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Area of a polygon, in mm²: positive counter-clockwise.
pub fn area(polygon: &[DVec2]) -> f64 {
    edges(polygon).map(|(a, b)| 0.5 * a.perp_dot(b)).sum()
}

/// Whether no two edges that are not neighbours touch.
pub fn is_simple(polygon: &[DVec2]) -> bool {
    let all: Vec<(DVec2, DVec2)> = edges(polygon).collect();
    let n = all.len();
    (0..n).all(|i| (i + 2..n).all(|j| (i == 0 && j == n - 1) || !touch(all[i], all[j])))
}

/// The edges, around.
pub fn edges(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    polygon.iter().enumerate().map(|(k, a)| (*a, polygon[(k + 1) % polygon.len()]))
}

fn touch((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    // Boxes that are apart spare most of the work.
    let apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    if apart(0) || apart(1) {
        return false;
    }
    let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
    let (p, q) = (side(a, b, c), side(a, b, d));
    let (r, s) = (side(c, d, a), side(c, d, b));
    p * q <= 0.0 && r * s <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use i_overlay::core::fill_rule::FillRule;
    use i_overlay::core::overlay_rule::OverlayRule;
    use i_overlay::float::single::SingleFloatOverlay;
    use proptest::prelude::*;

    /// Area of two polygons combined, by another library in whole numbers of 64 bits.
    fn combined(a: &Polygon, b: &Polygon, rule: OverlayRule) -> f64 {
        let flat = |polygon: &Polygon| polygon.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
        flat(a)
            .overlay_as::<i64>(&flat(b), rule, FillRule::NonZero)
            .iter()
            .flatten()
            .map(|path| area(&path.iter().map(|p| DVec2::from_array(*p)).collect::<Vec<_>>()))
            .sum()
    }

    fn turned(geometry: &Geometry, polygon: &Polygon) -> Polygon {
        polygon.iter().map(|p| geometry.turned(*p)).collect()
    }

    /// The numbers that were computed by hand from the same sentences.
    #[test]
    fn the_defaults_give_the_recomputed_geometry() {
        let geometry = Geometry::of(&Latch::default()).unwrap();
        let lever = geometry.lever();
        let told = [
            geometry.profile.end.to_degrees(),
            geometry.height(),
            geometry.pivot.x,
            geometry.pivot.y,
            lever.x,
            lever.y,
            geometry.slit_end,
        ];
        let digits = [1, 1, 2, 1, 2, 1, 1];
        let said: Vec<String> = told.iter().zip(digits).map(|(v, d)| format!("{v:.d$}")).collect();
        assert_eq!(said, ["75.7", "36.5", "46.25", "-40.0", "10.95", "43.0", "-44.3"]);
        assert!(geometry.tangent_miss() < 1e-9);
    }

    #[test]
    fn chords_are_near_the_curve() {
        let geometry = Geometry::of(&Latch::default()).unwrap();
        for pair in geometry.arm_profile().windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let drop = geometry.profile.height(middle.x) - middle.y;
            // Straight up from the chord is farther than across it.
            let off = drop * geometry.profile.angle(middle.x).cos();
            assert!((-1e-9..CHORD).contains(&off), "{off}");
        }
    }

    /// Two halves fill their box: nothing twice, nothing left over but slits and cut-outs.
    #[test]
    fn halves_mate_without_gap_or_overlap() {
        for overhang in [2.5, 3.8, 5.1] {
            let latch = Latch { overhang, ..Latch::default() };
            let geometry = Geometry::of(&latch).unwrap();
            let (solid, layer) = (geometry.solid(), geometry.layer());
            let full = latch.width * latch.base;
            // The turned half fills what is missing of the box, so that each is a half of it.
            assert!((area(&solid) - full).abs() < 1e-9);
            let partner = turned(&geometry, &solid);
            assert!(combined(&solid, &partner, OverlayRule::Intersect) < 1e-4);
            assert!((combined(&solid, &partner, OverlayRule::Union) - 2.0 * full).abs() < 1e-4);
            let partner = turned(&geometry, &layer);
            assert!(combined(&layer, &partner, OverlayRule::Intersect) < 1e-4);
            let cut = area(&solid) - area(&layer);
            let slot = (geometry.slit[0] - latch.neck) * latch.l_eq;
            // Along a gap of 0.36 the face is straight but for a micrometre.
            let slit = latch.slit_gap * latch.slit_depth;
            assert!((cut - slot - slit).abs() < 0.06, "{cut} {slot} {slit}");
        }
    }

    #[test]
    fn outlines_are_closed_simple_and_made_of_their_parts() {
        let geometry = Geometry::of(&Latch::default()).unwrap();
        let layer = geometry.layer();
        assert!(is_simple(&layer) && is_simple(&geometry.separator()) && area(&layer) > 0.0);
        let neck = geometry.neck * (geometry.cutout[1] - geometry.cutout[0]);
        let parts = area(&geometry.arm()) + area(&geometry.body()) + neck;
        // The body of the picture goes straight across where the slit ends a little deeper.
        let deeper = (geometry.slit[1] - geometry.slit[0]) * (geometry.cutout[0] - geometry.slit_end);
        assert!((parts - area(&layer) - deeper).abs() < 1e-6);
        let mirrored = geometry.mirrored(&layer);
        assert!((area(&mirrored) - area(&layer)).abs() < 1e-9);
        let mut crossed = layer;
        crossed.swap(3, 200);
        assert!(!is_simple(&crossed));
    }

    /// What both layers have in common leaves the partner's separator free; the union of both would not.
    #[test]
    fn separators_do_not_meet() {
        let geometry = Geometry::of(&Latch::default()).unwrap();
        let separator = geometry.separator();
        let partner = turned(&geometry, &separator);
        assert!(combined(&separator, &partner, OverlayRule::Intersect) < 1e-6);
        let front = geometry.solid();
        let both = combined(&front, &geometry.mirrored(&front), OverlayRule::Intersect);
        assert!(
            (both - area(&separator)).abs()
                < geometry.overhang * 2.0 * geometry.profile.height(geometry.width / 2.0)
        );
        // The union stands above the plane where the partner's hangs below it.
        let union: Vec<Vec<[f64; 2]>> = {
            let flat = |polygon: &Polygon| polygon.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
            let shapes = flat(&front).overlay_as::<i64>(
                &flat(&geometry.mirrored(&front)),
                OverlayRule::Union,
                FillRule::NonZero,
            );
            shapes.into_iter().flatten().collect()
        };
        let union: Polygon = union[0].iter().map(|p| DVec2::from_array(*p)).collect();
        assert!(combined(&union, &turned(&geometry, &union), OverlayRule::Intersect) > 1000.0);
    }

    #[test]
    fn what_has_no_outline_is_refused() {
        // A cut-out as high as that puts P above the hook.
        let refuse = |latch: Latch| Geometry::of(&latch).unwrap_err().key();
        assert_eq!(refuse(Latch { slit_distance: 2.0, ..Latch::default() }), "slit_distance");
        assert_eq!(refuse(Latch { slit_distance: 40.0, ..Latch::default() }), "slit_distance");
        assert_eq!(refuse(Latch { l_eq: 100.0, ..Latch::default() }), "spline_start");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Whatever the lengths, the profile falls, bends one way and ends towards P, and halves fill their box.
        #[test]
        fn every_outline_meets_its_definition(
            o in 1.0f64..8.0, t in 2.0f64..5.0, hook in 1.0f64..6.0, bend in 3.0f64..12.0, start in 20f64..45.0,
        ) {
            let latch = Latch { overhang: o, neck: t, hook, bend, spline_start: start.to_radians(), base: 90.0, ..Latch::default() };
            let geometry = Geometry::of(&latch).unwrap();
            let profile = &geometry.profile;
            for k in 1..40 {
                let x = profile.x_end * f64::from(k) / 40.0;
                prop_assert!(profile.slope(x) < 0.0 && profile.second(x) < 0.0);
                prop_assert!(profile.height(x) < geometry.height());
            }
            prop_assert!(geometry.tangent_miss() < 1e-6);
            prop_assert!((area(&geometry.solid()) - latch.width * latch.base).abs() < 1e-6);
            let solid = geometry.solid();
            prop_assert!(combined(&solid, &turned(&geometry, &solid), OverlayRule::Intersect) < 1e-3);
        }
    }
}
