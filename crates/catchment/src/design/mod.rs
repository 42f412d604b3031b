//! What a person wrote, typed: the connector they mean and the alignment problem it has to solve.
//!
//! A [`Design`] is resolved: units are gone (lengths in D, angles in radians), defaults are filled in, every
//! number has been checked. Geometry is built from it by the next room, [`crate::connector`].

mod alignment;
mod model;

pub use alignment::Alignment;
pub use model::{ConnectorSpec, Design, Family, FamilySpec, HalfSpec, LengthUnit, OwnSpec};
