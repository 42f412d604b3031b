//! The height of first contact, and the contacts at that height.
//!
//! ```text
//!        ┆ moving half, lowered along −z from far above
//!     ╲__▼__╱      h(q) = z of the COR when the first point touches
//!     ╲     ╱           = upper envelope of  fixed ⊕ (−R·moving)
//!      ╲___╱
//! ```
//!
//! At a fixed rotation R the envelope is piecewise linear in the lateral position: its pieces come from a
//! corner of one half on a facet of the other, or from two crossing edges. [`brute`] implements that
//! definition in plain loops and is the reference for every fast path.
//!
//! Two rules apply to planes and borders that both halves share. *Heights* are those of closed solids:
//! features above a border, or beyond it by rounding, touch. *Overlap* is that of open solids
//! ([`Nearby::overlaps`]): a point inside both proves it, and coincident surfaces do not.

mod bounds;
pub mod brute;
mod cache;
mod candidates;
mod cone;
mod crease;
pub mod display_unit;
mod element;
mod envelope;
pub mod face;
mod feature;
pub mod height_map;
mod hold;
mod layers;
pub mod mated;
#[cfg(test)]
#[path = "../../benches/meshes/mod.rs"]
pub(crate) mod meshes;
mod mirror;
mod nearby;
mod overlap;
mod plan;
mod play;
mod push;
mod raster;
mod search;
mod seat;
pub mod settle;
mod shape;
mod side_by_side;
#[cfg(test)]
mod tests;
mod tree;
mod turned;
mod walls;
pub mod width;

pub(crate) use candidates::FLUSH;
pub use element::Meeting;
pub use envelope::HeightEnvelope;
pub use feature::{FaceOrientation, Feature, FeatureKind, Features};
pub use mirror::Mirror;
pub use nearby::Nearby;
pub(crate) use nearby::chord;
pub use play::play_on;
pub use play::{Play, play};
pub use seat::Seat;
pub(crate) use seat::{CORE as SEAT_CORE, OVER_A_PATH};
pub use side_by_side::SideBySide;

use crate::connector::{Connector, Half};
use crate::design::Alignment;
use crate::pose::{CorPose, DofSet, PoseError};
use cache::{MotionCache, SeatCache};
use glam::{DMat3, DVec2, DVec3};
use search::Trees;
use shape::Shape;
use turned::Turned;

/// Product of the numbers of facets from which on halves have trees, for heights and motions. Motions with trees are half as fast at 10 × 10 facets,
/// as fast at 25 × 25 to 75 × 75, 1.7 times as fast at 140 × 140, and 4 times at 300 × 300.
const MANY: usize = 100 * 100;
/// From this product on grids use the trees, too: below it a list of all possible carriers, which serves all
/// cells of a rotation, is as fast.
const MOST_LISTED: usize = 3000 * 3000;

/// Facets of a half.
fn facets(half: &Half) -> usize {
    half.surfaces.iter().map(|surface| surface.facets.len()).sum()
}

/// A connector whose moving half is given from the COR: ready for heights.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The fixed half in the world frame.
    pub fixed: Half,
    /// The moving half, mounted, seen from the COR.
    pub moving: Half,
    /// The alignment problem it was built for.
    pub alignment: Alignment,
    fixed_shapes: Vec<Shape>,
    moving_shapes: Vec<Shape>,
    /// Of halves of [`MANY`] facets.
    trees: Option<Trees>,
    /// Whether all that can carry at a rotation is listed for a grid.
    lists: bool,
    mirrors: Vec<Mirror>,
    tight: bool,
    mated_height: f64,
    pub(crate) seat_cache: SeatCache,
    pub(crate) motion_cache: MotionCache,
}

impl Pair {
    /// Places the COR of `alignment` into the moving half.
    pub fn new(connector: &Connector, alignment: &Alignment) -> Self {
        let face_from_cor = DVec3::new(0.0, 0.0, alignment.center_of_rotation);
        let fixed = connector.fixed.clone();
        let moving = connector.moving.mapped(|p| p + face_from_cor);
        let shapes = |half: &Half| -> Vec<Shape> { half.surfaces.iter().map(Shape::new).collect() };
        let (fixed_shapes, moving_shapes) = (shapes(&fixed), shapes(&moving));
        let count = facets(&fixed) * facets(&moving);
        let lists = count < MOST_LISTED;
        let mirrors = mirror::of(&fixed, &moving);
        let tight = walls::are_close(&fixed_shapes, &moving_shapes, alignment);
        let trees = (count >= MANY).then(|| Trees::over(&fixed_shapes, &moving_shapes));
        let (alignment, mated_height) = (alignment.clone(), f64::NEG_INFINITY);
        let mut pair = Self {
            fixed,
            moving,
            alignment,
            fixed_shapes,
            moving_shapes,
            trees,
            lists,
            mirrors,
            tight,
            mated_height,
            seat_cache: SeatCache::default(),
            motion_cache: MotionCache::default(),
        };
        let aligned = CorPose { lateral: DVec2::ZERO, rotation: DMat3::IDENTITY };
        pair.mated_height = pair.height(&aligned).unwrap_or(f64::NEG_INFINITY);
        pair
    }

    /// The same halves with other free errors.
    #[must_use]
    pub(crate) fn with_free(&self, free: DofSet) -> Self {
        let mut pair = self.clone();
        pair.alignment.free = free;
        pair.tight = walls::are_close(&pair.fixed_shapes, &pair.moving_shapes, &pair.alignment);
        if free != self.alignment.free {
            pair.seat_cache = SeatCache::default();
            pair.motion_cache = MotionCache::default();
        }
        pair
    }

    /// Whether the halves have so many facets that possible contacts are searched anew for every cell of a
    /// grid, not listed.
    pub(crate) fn is_large(&self) -> bool {
        self.searched().is_some()
    }

    /// Whether motions use trees to find possible contacts.
    pub(crate) const fn has_trees(&self) -> bool {
        self.trees.is_some()
    }

    /// The trees, if a list for a grid would be too long.
    fn searched(&self) -> Option<&Trees> {
        self.trees.as_ref().filter(|_| !self.lists)
    }

    /// The same halves without trees: motions use lists of possible contacts.
    #[cfg(test)]
    pub(crate) fn without_trees(&self) -> Self {
        Self { trees: None, lists: true, ..self.clone() }
    }

    /// h₀, the z of the COR at first contact at zero error, in D; −∞ if the halves pass each other by.
    pub const fn mated_height(&self) -> f64 {
        self.mated_height
    }

    /// The reflections that map the pair onto itself: poses that are images of each other have the same
    /// outcome.
    pub fn mirrors(&self) -> &[Mirror] {
        &self.mirrors
    }

    /// Whether steep walls of the two halves face each other closely when mated, as those of a peg and its
    /// hole: the inner half can only move as its contacts permit, one after another.
    pub fn is_tight(&self) -> bool {
        self.tight
    }

    /// Lateral position of the COR and rotation of the moving half at a pose error.
    pub fn pose(&self, error: &PoseError) -> CorPose {
        CorPose::from_error(error, self.alignment.center_of_rotation, self.alignment.free)
    }

    /// z of the COR at first contact, in D; `None` if the halves pass each other by.
    pub fn height(&self, pose: &CorPose) -> Option<f64> {
        Turned::height_at(self, pose)
    }

    /// The same two features as in `before`, seen as planes and lines without borders, at another pose.
    pub fn contact(&self, before: &Contact, meeting: &Meeting, rotation: &DMat3, position: DVec3) -> Contact {
        let [fixed, moving] = meeting.shapes.map(|s| s as usize);
        meeting.at(before, &self.fixed_shapes[fixed], &self.moving_shapes[moving], rotation, position)
    }

    /// The pair near a pose that will move by small steps, with queries up to this `slack` and `reach`: see
    /// [`Nearby::turn`].
    pub fn nearby(&self, slack: f64, reach: f64) -> Nearby<'_> {
        Nearby::new(self, slack, reach)
    }

    /// The pair for heights at poses some of which are within `reach` of each other, in the ρ-metric.
    pub fn about(&self, reach: f64) -> Nearby<'_> {
        Nearby::new(self, reach / self.alignment.rotation_length, reach)
    }

    /// The pair at a given rotation: heights for any lateral position.
    pub fn at_rotation(&self, rotation: DMat3) -> HeightEnvelope<'_> {
        HeightEnvelope::new(self, &rotation)
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

/// A point at which the halves touch, or nearly touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Distance along the normal, in D; 0 when touching, negative when the halves overlap by rounding.
    pub gap: f64,
    /// Unit normal, from the fixed half to the moving one.
    pub normal: DVec3,
    /// The touching point of the fixed half, in the world frame.
    pub point: DVec3,
}

impl Contact {
    /// Gradient of the height of first contact if this is the only contact: `[∂h/∂x, ∂h/∂y]` (D/D) of the
    /// COR's lateral position and `∂h/∂ω` (D/rad) of a rotation about the COR in world axes.
    ///
    /// `∂h/∂x = −n_x/n_z`, `∂h/∂y = −n_y/n_z`, `∂h/∂ω = −(r × n)/n_z` with r from the COR to the contact.
    pub fn gradient(&self, cor: DVec3) -> ([f64; 2], DVec3) {
        let n = self.normal;
        ([-n.x / n.z, -n.y / n.z], -(self.point - cor).cross(n) / n.z)
    }
}
