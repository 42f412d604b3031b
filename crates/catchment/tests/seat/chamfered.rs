//! A peg and a hole with chamfers of the same slope, so that face slides on face: the most common drawing of a peg, and the hardest to
//! follow.
//!
//! ```text
//!        │  body │
//!         ╲ tip ╱           both chamfers: `slope`
//!   ─mouth─╲───╱────
//!           ╲ ╱             docks where the tip is over the mouth: an n-gon of circumradius mouth − tip
//!           │ │ hole
//! ```

use catchment::prelude::*;
use std::f64::consts::TAU;

/// Radii are those of the corners; lengths in D.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chamfered {
    pub(crate) sides: u32,
    pub(crate) slope: f64,
    /// Decimals to which the drawing is rounded.
    pub(crate) digits: i32,
}

const HOLE: f64 = 0.2;
const MOUTH: f64 = 0.24;
const BODY: f64 = 0.18;
const TIP: f64 = 0.15;
const OUTER: f64 = 0.7;
const DEEP: f64 = 0.25;
const BELOW: f64 = 0.35;

impl Chamfered {
    fn ring(&self, radius: f64, z: f64) -> Vec<DVec3> {
        let unit = 10f64.powi(self.digits);
        let corner = |k| {
            let (sine, cosine) = (TAU * f64::from(k) / f64::from(self.sides)).sin_cos();
            DVec3::new(radius * cosine, radius * sine, z).map(|x| (x * unit).round() / unit)
        };
        (0..self.sides).map(corner).collect()
    }

    fn hole(&self) -> [Vec<DVec3>; 3] {
        let rim = self.slope * (HOLE - MOUTH);
        [self.ring(MOUTH, 0.0), self.ring(HOLE, rim), self.ring(HOLE, -DEEP)]
    }

    fn peg(&self) -> [Vec<DVec3>; 3] {
        [self.ring(BODY, -0.2), self.ring(BODY, DEEP - self.slope * (BODY - TIP)), self.ring(TIP, DEEP)]
    }

    /// As convex pieces.
    pub(crate) fn pieces(&self) -> [HalfSource; 2] {
        let outer = self.ring(OUTER, 0.0);
        let mut fixed = vec![[self.ring(OUTER, -BELOW), self.ring(OUTER, -DEEP)].concat()];
        for level in self.hole().windows(2) {
            for k in 0..outer.len() {
                let next = (k + 1) % outer.len();
                let ends = |inner: &Vec<DVec3>| {
                    let z = inner[k].z;
                    [inner[k], inner[next], outer[k].with_z(z), outer[next].with_z(z)]
                };
                fixed.push(level.iter().flat_map(ends).collect());
            }
        }
        [HalfSource::Pieces(fixed), HalfSource::Pieces(vec![self.peg().concat()])]
    }

    /// As read from an STL file: triangles in single precision.
    pub(crate) fn triangles(&self) -> [HalfSource; 2] {
        let [mouth, rim, floor] = self.hole();
        let plate = [self.ring(OUTER, -BELOW), self.ring(OUTER, 0.0), mouth, rim, floor];
        [through(&plate), through(&self.peg())].map(HalfSource::Triangles)
    }

    /// The problem of two translations.
    pub(crate) fn problem(&self, [fixed, moving]: [HalfSource; 2]) -> Problem {
        let mut alignment = Alignment::new([Dof::X, Dof::Y].into_iter().collect(), Mount::X);
        alignment.half_ranges = [0.12, 0.12, 1.0, 1.0, 1.0];
        Problem::new(fixed, moving, alignment).unwrap_or_else(|e| panic!("{self:?}: {e}"))
    }

    /// Area of the captured n-gon, in D².
    pub(crate) fn captured(&self) -> f64 {
        0.5 * f64::from(self.sides) * (MOUTH - TIP).powi(2) * (TAU / f64::from(self.sides)).sin()
    }

    /// Signed distance of an offset from the border of the captured n-gon, in D; negative outside.
    pub(crate) fn inside(&self, error: &PoseError) -> f64 {
        let half = 0.5 * TAU / f64::from(self.sides);
        let side = |k| {
            let (sine, cosine) = (half * f64::from(2 * k + 1)).sin_cos();
            (MOUTH - TIP) * half.cos() - (error.x * cosine + error.y * sine)
        };
        (0..self.sides).map(side).fold(f64::INFINITY, f64::min)
    }
}

/// The closed surface through rings: the first closes it from below, the last from above.
fn through(rings: &[Vec<DVec3>]) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    let cap = |ring: &[DVec3]| -> Vec<[DVec3; 3]> {
        (1..ring.len() - 1).map(|k| [ring[0], ring[k], ring[k + 1]]).collect()
    };
    let (first, last) = (&rings[0], &rings[rings.len() - 1]);
    triangles.extend(cap(first).into_iter().map(|[a, b, c]| [a, c, b]));
    triangles.extend(cap(last));
    for pair in rings.windows(2) {
        for k in 0..first.len() {
            let next = (k + 1) % first.len();
            let [a, b, c, d] = [pair[0][k], pair[0][next], pair[1][next], pair[1][k]];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.iter().map(|corners| corners.map(|p| p.as_vec3().as_dvec3())).collect()
}
