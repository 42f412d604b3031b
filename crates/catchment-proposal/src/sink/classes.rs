//! Equivalence of places: among all places at which a part sinks in, the best of each axis, and the places
//! that differ from it.
//!
//! ```text
//!   same axis, same side      turned about the approach: one class          same line, other side up     a twin: turned end for end
//!   same axis, elsewhere      another place                                 anything else                another way
//! ```

use super::height::PartHeights;
use super::{Grain, Sunk, Triangles};
use crate::layout::PartLayout;
use glam::DMat3;

/// The best place of those that differ by a turn about the approach.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Class {
    pub(crate) best: Sunk,
    /// The best of those that are turned about the approach from it.
    pub(crate) turned: Option<Sunk>,
}

/// Places at which the parts' middles are closer than this across the approach are equal, in small lengths.
const ONE_PLACE: f64 = 4.0;

/// The classes of places, the steepest first. `sunk` is sorted.
pub(crate) fn classes(moving: &Triangles, sunk: &[Sunk], grain: Grain) -> Vec<Class> {
    let (low, high) = PartHeights::bounds(moving, &DMat3::IDENTITY);
    let middle = low.midpoint(high);
    let at = |sunk: &Sunk| (sunk.lie.turns()[1] * middle).truncate() + sunk.offset;
    let sides = |sunk: &Sunk| match sunk.lie {
        PartLayout::Facing { fixed, moving, .. } => Some((fixed, moving)),
        PartLayout::Assembled { .. } => None,
    };
    let mut result: Vec<Class> = Vec::new();
    for one in sunk {
        let same = |class: &&mut Class| {
            sides(&class.best) == sides(one) && at(&class.best).distance(at(one)) < ONE_PLACE * grain.small
        };
        match result.iter_mut().find(same) {
            Some(class) if class.turned.is_none() && class.best.lie != one.lie => class.turned = Some(*one),
            Some(_) => {}
            None => result.push(Class { best: *one, turned: None }),
        }
    }
    result
}
