//! The error grid and the height of first contact over it.

mod grid;

pub use grid::{Grid, GridAxis};
