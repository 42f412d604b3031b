//! The height of first contact, and what touches there.
//!
//! ```text
//!        ┆ moving half, lowered along −z from far above
//!     ╲__▼__╱      h(q) = z of the COR when the first point touches
//!     ╲     ╱           = upper envelope of  fixed ⊕ (−R·moving)
//!      ╲___╱
//! ```
//!
//! At a fixed rotation R the envelope is piecewise linear in the lateral position: its pieces come from a
//! corner of one half on a facet of the other, or from two crossing edges. [`brute`] writes that definition
//! down in plain loops and judges every fast path.

pub mod brute;
pub mod mated;

use crate::connector::{Connector, Half};
use crate::design::Alignment;
use crate::pose::CorPose;
use glam::{DMat3, DVec2, DVec3};

/// A connector whose moving half is given from the COR: ready for heights.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The fixed half in the world frame.
    pub fixed: Half,
    /// The moving half, mounted, seen from the COR.
    pub moving: Half,
    /// The alignment problem it was built for.
    pub alignment: Alignment,
}

impl Pair {
    /// Places the COR of `alignment` into the moving half.
    pub fn new(connector: &Connector, alignment: &Alignment) -> Self {
        let face_from_cor = DVec3::new(0.0, 0.0, alignment.center_of_rotation);
        Self {
            fixed: connector.fixed.clone(),
            moving: connector.moving.mapped(|p| p + face_from_cor),
            alignment: alignment.clone(),
        }
    }

    /// z of the COR at first contact, in D; `None` where the halves pass each other by.
    pub fn height(&self, pose: &CorPose) -> Option<f64> {
        brute::height(self, pose)
    }

    /// The pair at one rotation: heights for any lateral position.
    pub fn at_rotation(&self, rotation: DMat3) -> Envelope<'_> {
        Envelope { pair: self, rotation }
    }
}

/// Evenly spaced coordinates: `first + step·k`, k in `0..count`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// The first coordinate.
    pub first: f64,
    /// Distance between neighbours.
    pub step: f64,
    /// How many.
    pub count: usize,
}

impl Lattice {
    /// The k-th coordinate.
    pub fn at(&self, k: usize) -> f64 {
        self.first + self.step * k as f64
    }
}

/// The heights of a pair at one rotation, over the lateral plane.
#[derive(Debug)]
pub struct Envelope<'a> {
    pair: &'a Pair,
    rotation: DMat3,
}

impl Envelope<'_> {
    /// z of the COR at first contact with the COR at `lateral`, in D.
    pub fn height(&self, lateral: DVec2) -> Option<f64> {
        brute::height(self.pair, &CorPose { lateral, rotation: self.rotation })
    }

    /// Heights over a lattice of *COR* positions, x fastest; −∞ where the halves pass each other by.
    ///
    /// `out` has `x.count · y.count` cells and is overwritten.
    pub fn heights(&self, x: Lattice, y: Lattice, out: &mut [f64]) {
        for (row, cells) in out.chunks_exact_mut(x.count).enumerate() {
            for (column, cell) in cells.iter_mut().enumerate() {
                *cell = self.height(DVec2::new(x.at(column), y.at(row))).unwrap_or(f64::NEG_INFINITY);
            }
        }
    }
}
