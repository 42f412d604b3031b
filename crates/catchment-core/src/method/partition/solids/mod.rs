//! The solids behind the method, for display: convex pieces with closed boundaries.
//!
//! ```text
//!   halves      C and C′, each a union of convex pieces, docked                          figures 5.1, 5.2
//!   swept       C_full: the reflected moving half at every slice of its angle, the slices joined     5.5
//!   collision   { place of the COR : the halves overlap } = fixed ⊕ (−moving)                  5.3, 5.4
//!               with a rotation:  fixed ⊕ C_full                                                5.6
//! ```
//! Positions are those of the centre of rotation, so the upper side of the collision solid is the height of
//! first contact: exact without rotations and on every slice; between slices the composites approximate it
//! (see [`super::Settings::strips`]). Its lower side is that of contact from below.
//!
//! Lengths in D, angles in radians. A translation keeps its axis of the file (x, y; z is the approach); the
//! angle takes y, or x if y is a free error. A flat body lies in a plane: profiles and their sums at the
//! middle of their layer in y.
//!
//! Not promised: bodies of a solid overlap as in the dissertation (composites, and sums with different
//! pieces), so their measures do not add up to that of the union; [`Polytope`] and its collections give that
//! measure.
//!
//! Source: dissertation, section 5.1; the point reflection of its C′ is our mounting half turn. [I] The angle
//! covers both ends of the error box and always includes 0.

use super::compose::{self, Compartment};
use super::pieces::{EVERYWHERE, Piece, PiecePair, Pieces};
use super::space::unlocked;
use super::{POLYTOPE_BYTES, PartitionError, PartitionSettings};
use crate::contact::Pair;
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::polytope::{Polytope, PolytopePoint, minkowski_sum_of};
use crate::pose::{Dof, DofSet};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The solid to export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum SolidShape {
    /// Both halves, docked.
    Halves,
    /// The reflected moving half, swept over its angle.
    Swept,
    /// All positions of the centre of rotation at which the halves overlap.
    Collision,
}

/// A convex body.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Corners, on the axes of the file.
    pub vertices: Vec<DVec3>,
    /// Faces as numbers of corners: counter-clockwise seen from outside, every edge in two of them. A flat
    /// body has a single face.
    pub faces: Vec<Vec<usize>>,
    /// Its piece of the fixed half.
    pub fixed: Option<usize>,
    /// Its piece of the moving half.
    pub moving: Option<usize>,
    /// Slices between which it lies: the number of the lower slice, and both angles in radians.
    pub slice: Option<(usize, [f64; 2])>,
}

/// A shape of many convex bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Solids {
    /// The solid.
    pub subject: SolidShape,
    /// Meaning of the three axes of the file: lengths in D (x, y, z), or an angle in radians by its name.
    pub axes: [&'static str; 3],
    /// 3, or 2 for flat bodies.
    pub dimension: usize,
    /// How it was made.
    pub settings: PartitionSettings,
    /// Number of convex pieces of the fixed half and of the moving half, before the cut into strips.
    pub pieces: [usize; 2],
    /// The bodies.
    pub solids: Vec<Solid>,
}

/// Why there is no shape.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolidError {
    /// More dimensions than can be displayed.
    #[error("{what} has {dimensions} dimensions, of which a picture shows three: {advice}")]
    Dimensions {
        /// The solid, with its errors.
        what: String,
        /// How many.
        dimensions: usize,
        /// Advice.
        advice: &'static str,
    },
    /// Nothing turns.
    #[error("no rotation is free, so nothing is swept: free one, such as x,pitch, or ask for the halves")]
    NothingTurns,
    /// Nothing moves.
    #[error("no error is free, so there is no collision shape: free one or two, such as x,y or x,pitch")]
    NothingMoves,
    /// The halves do not fall into convex pieces, or a setting is out of its range.
    #[error(transparent)]
    Partition(#[from] PartitionError),
}

impl From<Cancelled> for SolidError {
    fn from(error: Cancelled) -> Self {
        Self::Partition(error.into())
    }
}

impl From<OutOfBudget> for SolidError {
    fn from(error: OutOfBudget) -> Self {
        Self::Partition(error.into())
    }
}

/// Computes a solid of a pair. `settings` matter only with a free rotation, except for the strips, which cut
/// every moving piece except those of the halves themselves.
///
/// # Errors
/// [`SolidError`]; cancellation is checked for every body.
pub fn shapes(
    pair: &Pair,
    subject: SolidShape,
    settings: &PartitionSettings,
    exec: &Exec,
) -> Result<Solids, SolidError> {
    settings.check()?;
    let free = pair.alignment.free;
    let width = if subject == SolidShape::Halves { f64::INFINITY } else { 1.0 / settings.strips as f64 };
    let pieces = Pieces::of(pair, width)?;
    let frame = match subject {
        SolidShape::Halves => Frame::of_solids(),
        SolidShape::Swept if free.rotations() == 0 => return Err(SolidError::NothingTurns),
        SolidShape::Swept => Frame::of_swept(&pieces, free)?,
        SolidShape::Collision => Frame::of_collision(free)?,
    };
    let mut maker = Maker { frame, exec, solids: Vec::new() };
    match subject {
        SolidShape::Halves => maker.halves(&pieces, pair.mated_height())?,
        SolidShape::Swept => maker.swept(&pieces, &slices(pair, settings))?,
        SolidShape::Collision => maker.collision(&pieces, &slices(pair, settings), free)?,
    }
    let count = |pieces: &[Piece]| pieces.iter().map(|p| p.number + 1).max().unwrap_or(0);
    let dimension = maker.solids.iter().map(|s| if s.faces.len() == 1 { 2 } else { 3 }).max().unwrap_or(3);
    let pieces = [count(&pieces.fixed), count(&pieces.moving)];
    let axes = maker.frame.axes;
    Ok(Solids { subject, axes, dimension, settings: *settings, pieces, solids: maker.solids })
}

/// The slices of the free angle, if any.
fn slices(pair: &Pair, settings: &PartitionSettings) -> Vec<Compartment> {
    Compartment::all(&settings.slices_of(&pair.alignment))
}

/// The map from coordinates of a body to those of the file.
struct Frame {
    /// The axes of the file.
    axes: [&'static str; 3],
    /// Of free translations, the approach and the angle, in this order: the axis in the file.
    places: Vec<usize>,
}

/// Lengths on all three.
const LENGTHS: [&str; 3] = ["x", "y", "z"];

impl Frame {
    fn of_solids() -> Self {
        Self { axes: LENGTHS, places: vec![0, 1, 2] }
    }

    /// Profiles over one angle.
    fn of_swept(pieces: &Pieces, free: DofSet) -> Result<Self, SolidError> {
        let dimensions = pieces.moving.first().map_or(3, |piece| piece.dimension) + free.rotations();
        if dimensions > 3 {
            return Err(SolidError::Dimensions {
                what: "the swept half".to_owned(),
                dimensions,
                advice: "only halves that are profiles extruded along y, with x and pitch free, are swept in three",
            });
        }
        Ok(Self { axes: ["x", Dof::Pitch.name(), "z"], places: vec![0, 2, 1] })
    }

    /// Free errors and the approach.
    fn of_collision(free: DofSet) -> Result<Self, SolidError> {
        if free.is_empty() {
            return Err(SolidError::NothingMoves);
        }
        let names: Vec<_> = free.iter().map(Dof::name).collect();
        if free.len() > 2 {
            return Err(SolidError::Dimensions {
                what: format!("the collision shape over {}", names.join(", ")),
                dimensions: free.len() + 1,
                advice: "free two errors at most, such as x,y or x,pitch",
            });
        }
        if free.rotations() == 2 {
            return Err(SolidError::Dimensions {
                what: format!("the collision shape over {} and two lengths", names.join(", ")),
                dimensions: 4,
                advice: "free one rotation at most",
            });
        }
        let mut axes = LENGTHS;
        let mut places = Vec::new();
        places.extend(free.contains(Dof::X).then_some(0));
        places.extend(free.contains(Dof::Y).then_some(1));
        places.push(2);
        if let Some(rotation) = free.iter().find(|dof| dof.is_rotation()) {
            let place = usize::from(!free.contains(Dof::Y));
            axes[place] = rotation.name();
            places.push(place);
        }
        Ok(Self { axes, places })
    }

    /// A polytope as a body; a flat body lies at `layer` in y.
    fn solid(&self, polytope: &Polytope, places: &[usize], layer: f64) -> Solid {
        let in_a_layer = self.axes == LENGTHS && *places == [0, 2];
        let at = |point: &PolytopePoint| {
            let mut place = [0.0; 3];
            if in_a_layer {
                place[1] = layer;
            }
            for (axis, value) in places.iter().zip(point) {
                place[*axis] = *value;
            }
            DVec3::from(place)
        };
        let mut faces = polytope.boundary();
        // An odd order of axes is a mirror, which swaps inside and outside.
        if *places == [0, 2, 1] {
            for face in &mut faces {
                face.reverse();
            }
        }
        let vertices = polytope.vertices().iter().map(at).collect();
        Solid { vertices, faces, fixed: None, moving: None, slice: None }
    }
}

struct Maker<'a> {
    frame: Frame,
    exec: &'a Exec,
    solids: Vec<Solid>,
}

impl Maker<'_> {
    fn halves(&mut self, pieces: &Pieces, height: f64) -> Result<(), SolidError> {
        // Halves that pass each other by are shown with their centres together.
        let height = if height.is_finite() { height } else { 0.0 };
        for (is_moving, pieces) in [(false, &pieces.fixed), (true, &pieces.moving)] {
            for piece in pieces {
                self.exec.check()?;
                let polytope = Polytope::hull(piece.dimension, &piece.vertices);
                let polytope = polytope.ok_or(PartitionError::FlatPiece)?;
                let places: &[usize] = if piece.dimension == 2 { &[0, 2] } else { &[0, 1, 2] };
                let mut solid = self.frame.solid(&polytope, places, middle(piece.slab));
                if is_moving {
                    for vertex in &mut solid.vertices {
                        vertex.z += height;
                    }
                    solid.moving = Some(piece.number);
                } else {
                    solid.fixed = Some(piece.number);
                }
                self.solids.push(solid);
            }
        }
        Ok(())
    }

    fn swept(&mut self, pieces: &Pieces, compartments: &[Compartment]) -> Result<(), SolidError> {
        self.ensure_fits(pieces.moving.iter(), compartments)?;
        for (number, compartment) in compartments.iter().enumerate() {
            for piece in &pieces.moving {
                for composite in compose::compose(piece, compartment) {
                    self.exec.check()?;
                    let Some(polytope) = Polytope::hull(3, &composite) else { continue };
                    let solid = self.frame.solid(&polytope, &self.frame.places, 0.0);
                    let moving = Some(piece.number);
                    self.solids.push(Solid { moving, slice: span(number, compartment), ..solid });
                }
            }
        }
        Ok(())
    }

    fn collision(
        &mut self,
        pieces: &Pieces,
        compartments: &[Compartment],
        free: DofSet,
    ) -> Result<(), SolidError> {
        let pairs = pieces.pairs()?;
        self.ensure_fits(pairs.iter().map(|met| met.moving), compartments)?;
        for (number, compartment) in compartments.iter().enumerate() {
            for PiecePair { fixed, moving, slab } in &pairs {
                for composite in compose::compose(moving, compartment) {
                    self.exec.check()?;
                    let dimension = moving.dimension + compartment.spans.len();
                    let Some(sum) = minkowski_sum_of(dimension, &composite, &fixed.vertices) else {
                        continue;
                    };
                    let Some((polytope, _)) = unlocked(sum, moving.dimension, free) else { continue };
                    let solid = self.frame.solid(&polytope, &self.frame.places, middle(*slab));
                    let slice = span(number, compartment);
                    let (fixed, moving) = (Some(fixed.number), Some(moving.number));
                    self.solids.push(Solid { fixed, moving, slice, ..solid });
                }
            }
        }
        Ok(())
    }

    /// Refuses more bodies than fit into memory.
    fn ensure_fits<'p>(
        &self,
        turned: impl Iterator<Item = &'p Piece>,
        compartments: &[Compartment],
    ) -> Result<(), SolidError> {
        let rotations = compartments.first().map_or(0, |compartment| compartment.spans.len());
        let bodies: u64 = turned.map(|piece| compose::count(piece, rotations)).sum();
        let bytes = bodies.saturating_mul(compartments.len() as u64).saturating_mul(POLYTOPE_BYTES);
        Ok(self.exec.ensure_fits("the bodies of the shape", bytes, |_| {
            vec![Advice::FewerSlices, Advice::MoreMemory]
        })?)
    }
}

/// The middle of a layer; 0 for a solid, which has no layer.
fn middle(slab: [f64; 2]) -> f64 {
    if slab == EVERYWHERE { 0.0 } else { f64::midpoint(slab[0], slab[1]) }
}

/// Slices between which a compartment of a single angle lies.
fn span(number: usize, compartment: &Compartment) -> Option<(usize, [f64; 2])> {
    compartment.spans.first().map(|(_, angles)| (number, *angles))
}

#[cfg(test)]
mod tests;
