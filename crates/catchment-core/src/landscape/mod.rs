//! The error grid and the height of first contact over it.
//!
//! ```text
//!   h │ ╲       ╱╲          one height per cell of the error box: z of the centre of rotation
//!     │  ╲     ╱  ╲         at first contact of the moving half, lowered with that pose error;
//!     │   ╲   ╱    ╲        −∞ if it passes by
//!     │    ╲_╱
//!     └─────┴────────▶ x, y, roll, pitch, yaw
//!         mated
//! ```
//!
//! Lengths in D, angles in radians. The heights are exact at the cells' centres up to single precision. Not
//! promised: heights between centres. Any range of a grid's rotations can be computed separately, and the
//! assembled parts equal the whole, bit for bit.

mod backend;
mod fold;
mod gradient_field;
mod grid;
mod heights;
mod part;
mod resolution;

pub use backend::{Backend, Brute, Fast};
pub use fold::{Fold, Image};
pub use gradient_field::{DescentDirections, Gradient, GradientField, Patch, Patches};
pub use grid::{Grid, GridAxis};
pub use heights::{Landscape, LandscapeError};
pub use part::{GradientFieldPart, LandscapePart, MergeError};
pub use resolution::{Resolution, ResolutionError};
