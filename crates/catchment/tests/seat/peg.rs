//! A peg and its chamfered hole as convex pieces: the simplest real dock.
//!
//! ```text
//!    ┌───────────────┐  flange (through) or none (blind)
//!    └───┐       ┌───┘
//!        │  peg  │        r: radius of the corners of the peg's tip
//!  ────╲ └───────┘ ╱──── R + c: mouth
//!       ╲         ╱ c
//!        │   R   │        R: of the hole
//!  ──────┴───────┴────── floor of a blind hole, t below the rim
//! ```

use catchment::prelude::*;
use std::f64::consts::TAU;

/// Corners of an n-gon, one of them on the x-axis.
fn ring(sides: u32, radius: f64, z: f64) -> Vec<DVec3> {
    (0..sides)
        .map(|k| {
            let a = TAU * f64::from(k) / f64::from(sides);
            DVec3::new(radius * a.cos(), radius * a.sin(), z)
        })
        .collect()
}

/// A peg in its hole; lengths in D. Radii are those of the corners.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peg {
    pub(crate) sides: u32,
    /// Radius of the hole.
    pub(crate) hole: f64,
    /// Radius of the peg.
    pub(crate) body: f64,
    /// Width and depth of the chamfer of the hole.
    pub(crate) chamfer: f64,
    /// Depth of the hole.
    pub(crate) deep: f64,
    /// Whether the peg stands on the floor of its hole, or hangs by a flange.
    pub(crate) blind: bool,
}

impl Peg {
    pub(crate) const fn new(sides: u32, hole: f64, play: f64, chamfer: f64) -> Self {
        Self { sides, hole, body: hole - play, chamfer, deep: 0.3, blind: true }
    }

    /// Area of the offsets from which the peg slides into its hole: those with its tip over the mouth.
    pub(crate) fn area(&self) -> f64 {
        let reach = self.hole + self.chamfer - self.body;
        let n = f64::from(self.sides);
        0.5 * n * (TAU / n).sin() * reach * reach
    }

    fn fixed(&self) -> Vec<Vec<DVec3>> {
        let &Self { sides, hole, chamfer, deep, blind, .. } = self;
        let (outer, below) = (1.0, deep + 0.1);
        let wedge = |levels: [(f64, f64); 2]| {
            let [low, high] = levels;
            let rings = [low, high].map(|(radius, z)| (ring(sides, radius, z), ring(sides, outer, z)));
            (0..sides as usize)
                .map(move |k| {
                    let next = (k + 1) % sides as usize;
                    rings
                        .iter()
                        .flat_map(|(inner, outer)| [inner[k], inner[next], outer[k], outer[next]])
                        .collect::<Vec<_>>()
                })
                .collect::<Vec<_>>()
        };
        let mut pieces = wedge([(hole, -deep), (hole, -chamfer)]);
        if chamfer > 0.0 {
            pieces.extend(wedge([(hole, -chamfer), (hole + chamfer, 0.0)]));
        }
        if blind {
            pieces.push([ring(sides, outer, -below), ring(sides, outer, -deep)].concat());
        }
        pieces
    }

    fn moving(&self) -> Vec<Vec<DVec3>> {
        let &Self { sides, body, deep, blind, .. } = self;
        let tip = if blind { deep } else { 0.7 * deep };
        let mut pieces = vec![[ring(sides, body, -0.2), ring(sides, body, tip)].concat()];
        if !blind {
            pieces.push([ring(4, 1.2, -0.2), ring(4, 1.2, 0.0)].concat());
        }
        pieces
    }

    /// The problem with these errors free, half ranges of `range` D and 0.6 rad.
    pub(crate) fn problem(
        &self,
        free: &[Dof],
        range: f64,
        change: impl FnOnce(&mut Alignment),
    ) -> Result<Problem, ProblemError> {
        let mut alignment = Alignment::new(free.iter().copied().collect(), Mount::X);
        alignment.half_ranges = [range, range, 0.6, 0.6, 0.6];
        change(&mut alignment);
        Problem::new(HalfSource::Pieces(self.fixed()), HalfSource::Pieces(self.moving()), alignment)
    }
}
