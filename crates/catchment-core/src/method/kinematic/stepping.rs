//! Two planar X-Faces that pivot, stepped by a single contact at a time.
//!
//! ```text
//!          P_M ○                 moving half: pivots about P_M, which only moves along z (x = x₀ is kept)
//!              │╲ θ_M
//!         ┌────┼─╲───┐
//!          ╲   ┊  ╲ ╱            y     height of P_M over P_B
//!           ╲  ┊   ●  contact    n     normal of the touched edge, from the base up, n_z > 0
//!        ╱───╲─┊──╱              r_M, r_B   the contact seen from P_M and from P_B
//!       └──────┼─┘
//!          P_B ○                 base half: pivots about P_B, which is fixed
//! ```
//!
//! **Bodies.** A layer is the right triangle (−½, 0), (½, 0), (½, H) of the base, D = 1; the second layer is
//! its mirror image; the moving half is the base rotated by a half turn in the plane. Both pivot at a
//! distance `r_p`/2 behind mid height H/2: `r_p` half-widths. Angles are counter-clockwise (the tip swings to
//! +x for θ > 0); start at `θ_M = θ₀`, `θ_B = 0`.
//!
//! **Contact.** y is the largest over all pairs of a corner and an edge of the same layer that overlap
//! laterally: corners of the moving half over upward edges of the base, corners of the base under downward
//! edges of the moving half. The highest pair is *the* contact.
//!
//! **Motion.** Overdamped, frictionless, both halves with the same rotational damping and no damping of y:
//! with `g = (∂y/∂θ_M, ∂y/∂θ_B) = (−r_M × n, r_B × n)/n_z`, the angles move along −g. Only the path matters:
//! a step rotates them such that the farthest corner moves by [`STEP`] (midpoint rule, unless another pair is
//! the highest halfway). When another pair becomes the highest, the contact has changed, whether it slid over
//! a corner or fell.
//!
//! **End.** With ψ the angle from the normal of the edge (pointing at the edge's body) to the lever from the
//! corner's pivot to the corner, and ψ* its value for parallel halves (the text's `β_p + α_e`),
//! `θ₂ = ψ·sign ψ*`:
//!
//! | halt | when |
//! |---|---|
//! | success | θ₂ reaches `β_p + α_e` on a ramp: `θ_M − θ_B` reaches or passes 0; at θ₀ = 0 if |x₀| < 1 |
//! | beside | the same on another edge: the halves are parallel, side by side or one on the other's back |
//! | away | θ₂ < 0: the corner's body turns away |
//! | missed | no pair is left |
//! | bound | two pairs, each of which pushes back into the other: `g₁·g₂ < min(|g₁|², |g₂|²)` |
//! | at rest | y no longer falls, or [`MOST_STEPS`] steps are over |
//!
//! There is no distance condition; the printed table for this face does not follow that condition either. Not
//! promised: agreement with the computation behind that table, from which it differs, see [`super`]. Source:
//! the dissertation, section 3.1.1.

use glam::DVec2;
use serde::Serialize;

/// Displacement of the farthest corner in a step, in D. Half of it changes the outcome of 656 of the 203 401
/// starts of the tables (0.32 %).
pub const STEP: f64 = 0.02;

/// Steps after which a motion that has not ended counts as at rest. The corner farthest from its pivot cannot go around more
/// than once.
pub const MOST_STEPS: usize = 100_000;

/// End of the stepping from a given start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Halt {
    /// The halves are parallel on a ramp: they slide home.
    Success,
    /// They are parallel on another edge.
    Beside,
    /// The corner's body turns away from alignment.
    Away,
    /// The halves pass each other by.
    Missed,
    /// Two contacts hold each other.
    Bound,
    /// A single contact holds both.
    AtRest,
}

impl Halt {
    /// Name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Success => "success",
            Self::Beside => "beside",
            Self::Away => "away",
            Self::Missed => "missed",
            Self::Bound => "bound",
            Self::AtRest => "at rest",
        }
    }
}

/// The two halves.
#[derive(Debug, Clone)]
pub struct Faces {
    /// Corners of the base's layers seen from its pivot, counter-clockwise. Those of the moving half are their negatives.
    layers: [[DVec2; 3]; 2],
    /// Distance of the farthest corner from its pivot, at least 1.
    reach: f64,
}

/// A corner on an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    layer: usize,
    corner: usize,
    edge: usize,
    /// Whether the corner is the moving half's.
    moving: bool,
}

impl Pair {
    /// The halt if the halves are parallel at this contact.
    const fn when_parallel(self) -> Halt {
        // The ramp goes from the last corner to the first in the rising layer, from the second to the last in the other.
        if self.edge == 2 - self.layer { Halt::Success } else { Halt::Beside }
    }
}

/// A pair at a pose.
#[derive(Debug, Clone, Copy)]
struct Contact {
    pair: Pair,
    /// y at the contact of this pair.
    height: f64,
    /// The contact seen from the base's pivot.
    point: DVec2,
    /// Normal of the edge, up.
    normal: DVec2,
}

/// Angles of the two halves.
type Angles = [f64; 2];

impl Faces {
    /// X-Faces of height `h` (H/D) whose pivots are `rotation_point` half-widths behind mid height.
    pub fn new(h: f64, rotation_point: f64) -> Self {
        let z = 0.5 * (rotation_point - h);
        let rising = [DVec2::new(-0.5, z), DVec2::new(0.5, z), DVec2::new(0.5, z + h)];
        let falling = [DVec2::new(-0.5, z), DVec2::new(0.5, z), DVec2::new(-0.5, z + h)];
        let reach = rising.iter().map(|corner| corner.length()).fold(1.0, f64::max);
        Self { layers: [rising, falling], reach }
    }

    /// y and θ₂ of the contact that a start (x₀ in D, θ₀ in radians) begins with.
    #[cfg(test)]
    pub(super) fn first(&self, x0: f64, theta0: f64) -> Option<(f64, f64)> {
        let angles = [theta0, 0.0];
        self.highest(x0, angles).map(|contact| (contact.height, Self::theta2(&contact, x0, angles)))
    }

    /// The halt of the start (x₀ in D, θ₀ in radians), stepped by `step`, in D.
    pub fn follow(&self, x0: f64, theta0: f64, step: f64) -> Halt {
        let mut angles = [theta0, 0.0];
        if theta0 == 0.0 && x0.abs() >= 1.0 {
            // No more than corners would touch.
            return Halt::Missed;
        }
        let Some(mut contact) = self.highest(x0, angles) else { return Halt::Missed };
        let side = theta0.signum();
        for _ in 0..MOST_STEPS {
            if (angles[0] - angles[1]) * side <= 0.0 {
                return contact.pair.when_parallel();
            }
            if Self::theta2(&contact, x0, angles) < 0.0 {
                return Halt::Away;
            }
            let half = self.step(&contact, x0, angles, 0.5 * step);
            // The midpoint rule, while the contact stays between the same features.
            let middle = self.highest(x0, half).filter(|middle| middle.pair == contact.pair);
            let next = self.step(&middle.unwrap_or(contact), x0, angles, step);
            if [half, next].iter().any(|[moving, base]| (moving - base) * side <= 0.0) {
                return contact.pair.when_parallel();
            }
            let Some(result) = self.highest(x0, next) else { return Halt::Missed };
            if result.pair != contact.pair && self.binds(contact.pair, &result, x0, next) {
                return Halt::Bound;
            }
            if result.height >= contact.height {
                return Halt::AtRest;
            }
            (contact, angles) = (result, next);
        }
        Halt::AtRest
    }

    /// The angles after a step of this length along the descent of a contact.
    fn step(&self, contact: &Contact, x0: f64, from: Angles, length: f64) -> Angles {
        let g = gradient(contact, x0);
        let steepness = g[0].hypot(g[1]);
        if steepness == 0.0 {
            return from;
        }
        let turn = length / (self.reach * steepness);
        [from[0] - turn * g[0], from[1] - turn * g[1]]
    }

    /// Corners of a layer of a half at these angles, each half's from its own pivot.
    fn corners(&self, layer: usize, moving: bool, angles: Angles) -> [DVec2; 3] {
        let turn = DVec2::from_angle(angles[usize::from(!moving)]);
        let sign = if moving { -1.0 } else { 1.0 };
        self.layers[layer].map(|corner| turn.rotate(sign * corner))
    }

    /// The highest pair.
    fn highest(&self, x0: f64, angles: Angles) -> Option<Contact> {
        let mut best: Option<Contact> = None;
        for layer in 0..self.layers.len() {
            let [base, moving] = [false, true].map(|moving| self.corners(layer, moving, angles));
            for is_moving in [true, false] {
                for corner in 0..3 {
                    for edge in 0..3 {
                        let pair = Pair { layer, corner, edge, moving: is_moving };
                        let result = touch(pair, &base, &moving, x0);
                        best = match (best, result) {
                            (Some(a), Some(b)) => Some(if b.height > a.height { b } else { a }),
                            (a, b) => a.or(b),
                        };
                    }
                }
            }
        }
        best
    }

    /// Whether the previously highest pair blocks the pair that is highest now.
    fn binds(&self, before: Pair, now: &Contact, x0: f64, angles: Angles) -> bool {
        let [base, moving] = [false, true].map(|moving| self.corners(before.layer, moving, angles));
        // A corner that has left its edge holds nothing.
        let Some(before) = touch(before, &base, &moving, x0) else { return false };
        let (a, b) = (gradient(&before, x0), gradient(now, x0));
        let dot = |u: Angles, v: Angles| u[0] * v[0] + u[1] * v[1];
        dot(a, b) < dot(a, a).min(dot(b, b))
    }

    /// θ₂ of a contact, in (−π, π].
    fn theta2(contact: &Contact, x0: f64, [moving, base]: Angles) -> f64 {
        let [r_moving, r_base] = levers(contact, x0);
        // The lever of the corner's body against the normal that points at the other body.
        let (lever, normal, apart) = if contact.pair.moving {
            (r_moving, -contact.normal, moving - base)
        } else {
            (r_base, contact.normal, base - moving)
        };
        let psi = normal.perp_dot(lever).atan2(normal.dot(lever));
        let aligned = wrapped(psi - apart);
        if aligned < 0.0 { -psi } else { psi }
    }
}

/// An angle in (−π, π].
fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

/// A corner on an edge, if they overlap laterally and the edge faces the other half.
fn touch(pair: Pair, base: &[DVec2; 3], moving: &[DVec2; 3], x0: f64) -> Option<Contact> {
    let (corners, edges) = if pair.moving { (moving, base) } else { (base, moving) };
    let (corner, a, b) = (corners[pair.corner], edges[pair.edge], edges[(pair.edge + 1) % 3]);
    // The third corner determines on which side of the edge the solid lies.
    let inside = edges[(pair.edge + 2) % 3];
    let shift = if pair.moving { x0 } else { -x0 };
    let (x, along) = (corner.x + shift, b - a);
    let (lo, hi) = (a.x.min(b.x), a.x.max(b.x));
    if !(lo <= x && x <= hi && lo < hi) {
        return None;
    }
    let mut normal = DVec2::new(-along.y, along.x).normalize();
    if normal.y < 0.0 {
        normal = -normal;
    }
    let solid_below = normal.dot(inside - a) < 0.0;
    if solid_below != pair.moving {
        return None;
    }
    // A share of the edge first: an edge that is nearly vertical has no slope to speak of.
    let z = a.y + along.y * ((x - a.x) / along.x);
    let (height, point) = if pair.moving { (z - corner.y, DVec2::new(x, z)) } else { (corner.y - z, corner) };
    Some(Contact { pair, height, point, normal })
}

/// The contact seen from the pivots of the moving half and of the base.
fn levers(contact: &Contact, x0: f64) -> [DVec2; 2] {
    [contact.point - DVec2::new(x0, contact.height), contact.point]
}

/// `(∂y/∂θ_M, ∂y/∂θ_B)`.
fn gradient(contact: &Contact, x0: f64) -> Angles {
    let [moving, base] = levers(contact, x0).map(|lever| lever.perp_dot(contact.normal));
    [-moving / contact.normal.y, base / contact.normal.y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Nilsson's bound: without rotation an X-Face finds home from a full width to either side, whatever its height.
    #[test]
    fn without_rotation_the_bound_is_nilssons() {
        for (h, r) in [(0.0625, 0.0), (1.0, 1.0), (16.0, 10.0), (0.5, 4.0)] {
            let faces = Faces::new(h, r);
            for side in [-1.0, 1.0] {
                assert_eq!(faces.follow(side * (1.0 - 1e-9), 0.0, STEP), Halt::Success);
                assert_eq!(faces.follow(side * (1.0 + 1e-9), 0.0, STEP), Halt::Missed);
            }
        }
    }

    /// The gradient is the derivative of the height, by central differences, wherever the same pair stays the
    /// highest.
    #[test]
    fn the_motion_is_downhill() {
        let mut compared = 0;
        for k in 0..400 {
            let t = f64::from(k);
            let faces = Faces::new(0.1 + 0.004 * t, 0.02 * t);
            let (x0, angles) = ((0.7 * t).sin() * 0.6, [(1.3 * t).sin() * 0.6, (2.1 * t).sin() * 0.6]);
            let Some(contact) = faces.highest(x0, angles) else { continue };
            let g = gradient(&contact, x0);
            for axis in 0..2 {
                const H: f64 = 1e-6;
                let at = |sign: f64| {
                    let mut moved = angles;
                    moved[axis] += sign * H;
                    faces.highest(x0, moved).filter(|c| c.pair == contact.pair).map(|c| c.height)
                };
                let (Some(above), Some(below)) = (at(1.0), at(-1.0)) else { continue };
                let slope = (above - below) / (2.0 * H);
                assert!((slope - g[axis]).abs() < 1e-4 * (1.0 + g[axis].abs()), "{slope} for {}", g[axis]);
                compared += 1;
            }
        }
        assert!(compared > 500, "{compared}");
    }

    /// θ₂ of the tip on the opposite ramp, for parallel halves: `β_p + α_e = atan(1/(r_p + H)) + atan H`.
    #[test]
    fn the_aligned_angle_is_that_of_the_text() {
        for (h, r) in [(0.25, 1.0), (1.0, 4.0), (4.0, 2.0)] {
            let faces = Faces::new(h, r);
            let tilt = 0.3;
            let pair = Pair { layer: 0, corner: 2, edge: 2, moving: true };
            let angles = [tilt, 0.0];
            let [base, moving] = [false, true].map(|m| faces.corners(0, m, angles));
            // The moving half's tip over the middle of the ramp.
            let contact = touch(pair, &base, &moving, -moving[2].x).unwrap();
            let theta2 = Faces::theta2(&contact, -moving[2].x, angles);
            let aligned = f64::atan(1.0 / (r + h)) + f64::atan(h);
            assert!((theta2 - (aligned - tilt)).abs() < 1e-12, "{theta2} for {aligned} - {tilt}");
        }
    }

    proptest! {
        /// The pair of halves is its own mirror image, layers exchanged.
        #[test]
        fn mirrored_starts_halt_alike(
            h in 0.0625f64..16.0, r in 0.0f64..10.0, x0 in -1.0f64..1.0, theta in 0.0f64..FRAC_PI_2,
        ) {
            let faces = Faces::new(h, r);
            prop_assert_eq!(faces.follow(x0, theta, 0.02), faces.follow(-x0, -theta, 0.02));
        }

        /// No success without contact at the start, nor with θ₂ < 0.
        #[test]
        fn success_begins_in_contact_and_towards_alignment(
            h in 0.0625f64..16.0, r in 0.0f64..10.0, x0 in -1.0f64..1.0, theta in 0.01f64..FRAC_PI_2,
        ) {
            let faces = Faces::new(h, r);
            let first = faces.highest(x0, [theta, 0.0]);
            let halt = faces.follow(x0, theta, 0.02);
            prop_assert_eq!(halt == Halt::Missed && first.is_none(), first.is_none());
            if let Some(first) = first {
                let theta2 = Faces::theta2(&first, x0, [theta, 0.0]);
                prop_assert!(halt != Halt::Success || (0.0..=PI).contains(&theta2));
            }
        }
    }
}
