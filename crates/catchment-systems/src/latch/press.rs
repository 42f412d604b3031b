//! Two halves pressed together, slowly: the swing of the arms, and the force.
//!
//! ```text
//!   C = ((L + s)/2, d/2)             the middle between the halves: d above the seat, s off sideways
//!   θ(d) = least swing that puts C outside the hook      both arms swing alike, about their own P
//!   N = k·θ / (r × (−n + μ·τ))       r = C − P, n the outer normal of the arm at C, τ the sliding direction of the partner
//!   F = N·(n_y + μ·|τ_y|)            per layer
//! ```
//!
//! A single point decides: the partner is the same part rotated by 180° about C, so that it contains a point
//! p of the plane if this half contains 2C − p. The upper part of the arm, above the overhang's underside, is
//! convex (its profile has negative curvature): if two such parts overlap, the middle of p and 2C − p, which
//! is C, lies in both. So they touch if C is on the hook's border, and the force acts there. A test overlaps
//! the whole outlines instead, arms and bodies.
//!
//! Three phases: C slides down the profile, past the corner, down the wall of the hook; below the wall the
//! arms snap back. An open arm's hook lies lower than at rest, so that halves are pressed slightly beyond the
//! seat before they snap; open arms leave the room for this.
//!
//! Not computed: the further compression of a snapped layer (the steep end of the dissertation's record),
//! speed, and the compliance of the machine.

use super::outline::Geometry;
use super::{LatchDesign, stiffness};
use glam::DVec2;
use serde::Serialize;

/// Positions along the way.
const STEPS: usize = 480;
/// The way starts so far above the first contact, in mm.
const APPROACH: f64 = 2.0;
/// It ends so far after the last snap.
const AFTER: f64 = 0.5;
/// Steps to a swing, at most; a handful is enough.
const TRIES: usize = 60;
/// A swing that moves by less is found, in rad.
const SETTLED: f64 = 1e-13;

/// Contact state of a layer and its partner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum LayerContact {
    /// No contact yet.
    Apart,
    /// The profiles slide on each other.
    Profile,
    /// The walls of the hooks slide on each other.
    Wall,
    /// The hooks have passed and the arms are back.
    Latched,
}

impl LayerContact {
    /// Its name, as in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Apart => "apart",
            Self::Profile => "profile",
            Self::Wall => "wall",
            Self::Latched => "latched",
        }
    }
}

/// A layer at a given position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayerForce {
    /// Contact state.
    pub contact: LayerContact,
    /// Swing of each arm, in rad.
    pub swing: f64,
    /// Force on the layer, in N.
    pub force: f64,
}

/// Both layers at a given position.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Position {
    /// Height of one half above its seat, in mm; negative beyond it.
    pub above: f64,
    /// Each layer.
    pub layers: Vec<LayerForce>,
    /// Force on all layers, in N.
    pub force: f64,
}

/// The force drop as a hook passes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Dip {
    /// The layer, from 1.
    pub layer: usize,
    /// Height above the seat, in mm.
    pub above: f64,
    /// Force just before the drop, in N.
    pub from: f64,
    /// Force just after the drop, in N.
    pub to: f64,
}

/// The motion of a pair from approach to seat.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Record {
    /// Positions in order; the last is the deepest.
    pub positions: Vec<Position>,
    /// Height of first contact above the seat, in mm.
    pub first_contact: f64,
    /// Largest force, in N.
    pub peak: f64,
    /// Height of the largest force above the seat, in mm.
    pub peak_above: f64,
    /// Drops as layers snap; two layers at one height count as one drop.
    pub dips: Vec<Dip>,
}

/// Friction holds the arm against any push.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "with friction {friction} the push does not open the arm any more {above:.2} mm above the seat: the halves jam"
)]
pub struct Jammed {
    /// The coefficient.
    pub friction: f64,
    /// Height above the seat.
    pub above: f64,
}

/// A layer of a pair with a lateral offset.
struct Layer<'a> {
    geometry: &'a Geometry,
    /// Stiffness of a neck, in N·mm/rad.
    stiffness: f64,
    friction: f64,
    /// Offset of the partner along x, in mm.
    offset: f64,
}

impl Layer<'_> {
    /// The middle between the halves.
    fn middle(&self, above: f64) -> DVec2 {
        DVec2::new(0.5 * (self.geometry.width + self.offset), 0.5 * above)
    }

    /// Height of first contact of the profiles.
    fn first_contact(&self) -> f64 {
        2.0 * self.geometry.profile.height(self.middle(0.0).x)
    }

    /// Height at which the hooks have passed: C emerges under the corner of an open hook.
    fn snap(&self) -> f64 {
        let (pivot, x_end) = (self.geometry.pivot, self.geometry.profile.x_end);
        let corner = DVec2::new(x_end, 0.0) - pivot;
        let across = self.middle(0.0).x - pivot.x;
        2.0 * (pivot.y + (corner.length_squared() - across * across).max(0.0).sqrt())
    }

    /// C as an arm sees it that has swung by `swing`.
    fn seen(&self, middle: DVec2, swing: f64) -> DVec2 {
        let pivot = self.geometry.pivot;
        pivot + DVec2::from_angle(-swing).rotate(middle - pivot)
    }

    /// The swing with which C is on the wall of the hook.
    fn at_wall(&self, middle: DVec2) -> f64 {
        let (pivot, x_end) = (self.geometry.pivot, self.geometry.profile.x_end);
        let arm = middle - pivot;
        // The angles from the vertical, to the left.
        let wall = ((pivot.x - x_end) / arm.length()).clamp(-1.0, 1.0).asin();
        (-arm.x).atan2(arm.y) - wall
    }

    /// State of the layer; `passed` if it has latched already.
    fn hold(&self, above: f64, passed: bool) -> Result<LayerForce, Jammed> {
        let free = |contact| LayerForce { contact, swing: 0.0, force: 0.0 };
        if passed {
            return Ok(free(LayerContact::Latched));
        }
        let (middle, profile) = (self.middle(above), &self.geometry.profile);
        if middle.y >= profile.height(middle.x) {
            return Ok(free(LayerContact::Apart));
        }
        let wall = self.at_wall(middle);
        let (contact, swing) = if self.seen(middle, wall).y <= profile.hook {
            (LayerContact::Wall, wall)
        } else {
            // Newton steps for C on the profile, bracketed by a swing that is too small and a swing that is
            // too large.
            let (mut inside, mut outside) = (0.0, wall);
            let mut swing = wall;
            for _ in 0..TRIES {
                let seen = self.seen(middle, swing);
                let over = seen.y - profile.height(seen.x);
                if over < 0.0 {
                    inside = swing;
                } else {
                    outside = swing;
                }
                let moved = -(seen - self.geometry.pivot).perp();
                let next = swing - over / (moved.y - profile.slope(seen.x) * moved.x);
                let kept = if inside < next && next < outside { next } else { 0.5 * (inside + outside) };
                if (kept - swing).abs() < SETTLED {
                    break;
                }
                swing = kept;
            }
            (LayerContact::Profile, swing)
        };
        let angle = match contact {
            LayerContact::Profile => profile.angle(self.seen(middle, swing).x),
            _ => std::f64::consts::FRAC_PI_2,
        };
        // Down the slope of the arm as it stands, and out of it.
        let along = DVec2::from_angle(swing - angle);
        let normal = along.perp();
        let push = -normal + along * self.friction;
        let lever = (middle - self.geometry.pivot).perp_dot(push);
        let least = f64::EPSILON * self.geometry.width;
        if lever <= least {
            return Err(Jammed { friction: self.friction, above });
        }
        let force = self.stiffness * swing / lever * -push.y;
        Ok(LayerForce { contact, swing, force })
    }
}

/// Presses a pair together.
///
/// # Errors
/// Friction holds an arm: the halves jam.
pub fn record(latch: &LatchDesign, geometry: &Geometry) -> Result<Record, Jammed> {
    let press = latch.press;
    let layer = |sign: f64| Layer {
        geometry,
        stiffness: stiffness::torsional(latch),
        friction: press.friction,
        offset: sign * press.offset,
    };
    let layers: Vec<Layer<'_>> = [1.0, -1.0].into_iter().take(latch.layers as usize).map(layer).collect();
    // A tilt out of the plane of the layers raises one layer and lowers the other.
    let ahead =
        if latch.layers == 2 { 0.5 * (latch.sheet + latch.separator) * press.tilt.tan() } else { 0.0 };
    let lift = |k: usize| if k == 0 { -ahead } else { ahead };
    let snaps: Vec<f64> = layers.iter().enumerate().map(|(k, layer)| layer.snap() - lift(k)).collect();
    let contacts = layers.iter().enumerate().map(|(k, layer)| layer.first_contact() - lift(k));
    let first_contact = contacts.fold(f64::NEG_INFINITY, f64::max);
    let at = |above: f64, passed: &dyn Fn(usize) -> bool| -> Result<Position, Jammed> {
        let held: Result<Vec<LayerForce>, Jammed> =
            layers.iter().enumerate().map(|(k, layer)| layer.hold(above + lift(k), passed(k))).collect();
        let layers = held?;
        let force = layers.iter().map(|hold| hold.force).sum();
        Ok(Position { above, layers, force })
    };
    let deepest = snaps.iter().copied().fold(f64::INFINITY, f64::min) - AFTER;
    let (from, length) = (first_contact + APPROACH, first_contact + APPROACH - deepest);
    let mut positions = Vec::new();
    let mut dips: Vec<Dip> = Vec::new();
    let mut last = f64::INFINITY;
    for step in 0..=STEPS {
        let above = from - length * step as f64 / STEPS as f64;
        // Snaps lie between two steps: the moment before and the moment after are both kept.
        let mut due: Vec<usize> =
            (0..snaps.len()).filter(|k| snaps[*k] < last && snaps[*k] >= above).collect();
        due.sort_by(|a, b| snaps[*b].total_cmp(&snaps[*a]));
        for k in due {
            let there = snaps[k];
            let before = at(there, &|j| snaps[j] > there || (snaps[j] == there && j < k))?;
            let after = at(there, &|j| snaps[j] > there || (snaps[j] == there && j <= k))?;
            dips.push(Dip { layer: k + 1, above: there, from: before.force, to: after.force });
            positions.extend([before, after]);
        }
        positions.push(at(above, &|k| snaps[k] >= above)?);
        last = above;
    }
    let highest = positions.iter().max_by(|a, b| a.force.total_cmp(&b.force));
    let (peak, peak_above) = highest.map_or((0.0, 0.0), |p| (p.force, p.above));
    Ok(Record { positions, first_contact, peak, peak_above, dips })
}

#[cfg(test)]
mod tests {
    use super::super::outline::{Polygon, area};
    use super::super::{Press, force::Forces};
    use super::*;
    use i_overlay::core::fill_rule::FillRule;
    use i_overlay::core::overlay_rule::OverlayRule;
    use i_overlay::float::single::SingleFloatOverlay;
    use proptest::prelude::*;

    fn common(a: &Polygon, b: &Polygon) -> f64 {
        let flat = |polygon: &Polygon| polygon.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
        flat(a)
            .overlay_as::<i64>(&flat(b), OverlayRule::Intersect, FillRule::NonZero)
            .iter()
            .flatten()
            .map(|path| area(&path.iter().map(|p| DVec2::from_array(*p)).collect::<Vec<_>>()))
            .sum()
    }

    fn centred(friction: f64, offset: f64) -> LatchDesign {
        LatchDesign { press: Press { friction, offset, tilt: 0.0 }, layers: 1, ..LatchDesign::default() }
    }

    /// Without friction, work equals the energy of the springs: two arms, k·θ²/2 each, at every position.
    #[test]
    fn work_is_stored_in_the_springs() {
        let latch = centred(0.0, 0.0);
        let geometry = Geometry::of(&latch).unwrap();
        let record = record(&latch, &geometry).unwrap();
        let (mut work, mut most) = (0.0, 0.0f64);
        for pair in record.positions.windows(2) {
            if pair[1].layers[0].contact == LayerContact::Latched {
                break;
            }
            work += 0.5 * (pair[0].force + pair[1].force) * (pair[0].above - pair[1].above);
            let stored = stiffness::torsional(&latch) * pair[1].layers[0].swing.powi(2);
            most = most.max(stored);
            // The trapezium rule over steps of 0.06 mm; within one of them, at the corner, the force falls by
            // some 1.4 N.
            assert!((work - stored).abs() < 0.05, "{work} {stored} at {}", pair[1].above);
        }
        assert!(most > 15.0, "{most} N·mm");
    }

    /// The whole outlines, arms swung and bodies, do not overlap at any position; a little less swing and they do.
    #[test]
    fn whole_halves_touch_and_do_not_overlap() {
        for offset in [0.0, 1.0, -1.5] {
            let latch = centred(0.3, offset);
            let geometry = Geometry::of(&latch).unwrap();
            let record = record(&latch, &geometry).unwrap();
            let half = |swing: f64| -> [Polygon; 2] {
                let turn = DVec2::from_angle(swing);
                let arm = geometry.arm();
                [
                    arm.iter().map(|p| geometry.pivot + turn.rotate(*p - geometry.pivot)).collect(),
                    geometry.body(),
                ]
            };
            let overlap = |swing: f64, above: f64| -> f64 {
                let middle = DVec2::new(0.5 * (geometry.width + offset), 0.5 * above);
                let mine = half(swing);
                let theirs = mine.clone().map(|p| p.iter().map(|p| 2.0 * middle - *p).collect::<Polygon>());
                mine.iter().map(|a| theirs.iter().map(|b| common(a, b)).sum::<f64>()).sum()
            };
            for position in record.positions.iter().step_by(8) {
                let hold = position.layers[0];
                if !matches!(hold.contact, LayerContact::Profile | LayerContact::Wall) {
                    continue;
                }
                let over = overlap(hold.swing, position.above);
                // Chords cut the convex profile: they leave room and never take it.
                assert!(over < 1e-4, "{over} mm² at {}", position.above);
                let less = overlap(hold.swing - 2e-3, position.above);
                assert!(hold.swing < 4e-3 || less > 1e-3, "{less} mm² at {}", position.above);
            }
        }
    }

    /// Near the corner the record agrees with the lever formula, up to the neglected second order in the
    /// swing.
    #[test]
    fn the_lever_formula_is_near() {
        let latch = centred(0.3, 0.0);
        let geometry = Geometry::of(&latch).unwrap();
        let record = record(&latch, &geometry).unwrap();
        let formula = Forces::new().unwrap().latching(&latch, &geometry).spring_n;
        assert!((record.peak / formula - 1.0).abs() < 0.25, "{} {formula}", record.peak);
    }

    #[test]
    fn layers_that_are_not_level_snap_one_after_the_other() {
        let dips = |press: Press| {
            let latch = LatchDesign { press, ..LatchDesign::default() };
            record(&latch, &Geometry::of(&latch).unwrap()).unwrap()
        };
        let tilted = dips(Press::default());
        assert_eq!(tilted.dips.len(), 2);
        let [first, second] = tilted.dips[..] else { panic!() };
        // A lever of 12.7 mm and two degrees: 0.44 mm between the snaps.
        assert!((first.above - second.above - 12.7 * 2f64.to_radians().tan()).abs() < 1e-12);
        assert!(first.to > 0.0 && first.to < first.from && second.to == 0.0);
        let level = dips(Press { tilt: 0.0, ..Press::default() });
        assert!(level.dips[0].above == level.dips[1].above && level.peak > tilted.peak);
        let aside = dips(Press { tilt: 0.0, offset: 0.5, ..Press::default() });
        assert!(aside.dips[0].above > aside.dips[1].above, "the less open layer snaps first");
        assert!(tilted.positions.last().unwrap().force == 0.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Scaling: twice the modulus takes twice the force, on the same way; more friction never less.
        #[test]
        fn forces_scale_with_the_modulus(o in 2.5f64..6.0, t in 2.0f64..4.6, friction in 0.0f64..0.5) {
            let press = Press { friction, ..Press::default() };
            let latch = LatchDesign { overhang: o, neck: t, press, ..LatchDesign::default() };
            let geometry = Geometry::of(&latch).unwrap();
            let one = record(&latch, &geometry).unwrap();
            let two = record(&LatchDesign { modulus: 4200.0, ..latch.clone() }, &geometry).unwrap();
            prop_assert!((two.peak - 2.0 * one.peak).abs() < 1e-9 * two.peak);
            let rough = LatchDesign { press: Press { friction: friction + 0.1, ..press }, ..latch };
            prop_assert!(record(&rough, &geometry).unwrap().peak > one.peak);
        }
    }
}
