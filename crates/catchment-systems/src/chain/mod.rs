//! Chains of modules: the error of the last face, its docking, and the folding of a chain into a lattice.
//!
//! ```text
//!    base                                            module n
//!     ▼   a      a      a                            ┌─────┐
//!     ●──────●──────●──────●── … ──●─────────────────●  b  ▐▌◀ last face, b = ½ a beyond its rotor
//!     1      2      3      4                          rotor n
//!
//!   levers   l_k = (n − k) a + b            joint k turns everything that follows by its error δ_k
//!   lateral  y   = Σ l_k δ_k                σ_y = σ a √(n (4n² − 1) / 12)      for b = ½ a
//!   heading  θ   = Σ δ_k                    σ_θ = σ √n
//! ```
//!
//! A module has one revolute joint; its *rotor* is the axis of the joint, its *pitch* the distance from one
//! rotor to the next. Modules are numbered from the control computer, which holds the base: 1 is nearest. A
//! positive joint angle turns left. A module's latching faces are its front and its two sides, all behind the
//! joint; the first module's back is before it.
//!
//! - [`kinematics`]: poses of rotors and faces, exactly.
//! - [`shape`]: the shapes P, Block and O: cells of a lattice, rotating joints, latching faces.
//! - [`accumulation`]: accumulation of joint errors at a face: first order, closed forms, and exactly by
//!   random chains.
//! - [`docking`]: probability that those errors lie in a connector's area of acceptance, by exact motions.
//! - [`ring`]: the corners of the O, ranked by error and by force.
//! - [`sequence`]: commands over time, including those of the dissertation's table 6.2.
//! - [`fold`]: a chain with springs that follows such commands: contact, latches, collisions.
//! - [`file`](mod@file), [`study`], [`report`], [`figure`]: from a chain file to its results.
//!
//! # Units
//!
//! Millimetres, radians, newtons, newton metres. Lengths of a connector are in its width D.
//!
//! # The sign
//!
//! Seen from the fixed half, a chain that bends by +h moves its face to −x while its pitch is +h. An area of
//! acceptance is symmetric only under (x, pitch) → (−x, −pitch), so the sign matters. The centre of rotation
//! is the last rotor, which lies behind the face: `center_of_rotation = −b/D`, −0.725 for the published
//! module. It replaces the value of the design.
//!
//! # Source
//!
//! The dissertation, chapter 1 (p. 1–2), 2 (p. 8), 6.3 (p. 101–105), table 6.2, figures 6.5 and 6.6. Its sentence that errors
//! accumulate exponentially with the number of modules does not hold for independent joint errors: the lateral standard deviation
//! grows like n^1.5, the heading's like √n.
//!
//! # Not promised
//!
//! Friction, speed, mass and play of joints are neglected. Gravity does not act in the plane. The folding is
//! quasi-static, its contact two springs per face, its latches thresholds; only table 6.2 is the
//! dissertation's, all other commands and the readings of its lost pictures are ours, and reports state this.

pub mod accumulation;
pub mod docking;
pub mod figure;
pub mod file;
pub mod fold;
pub mod kinematics;
pub mod random;
pub mod report;
pub mod ring;
pub mod sequence;
pub mod shape;
pub mod study;

pub use accumulation::{ChainErrors, Covariance};
pub use file::ChainFile;
pub use kinematics::{ModuleDimensions, PlanarPose};
pub use report::ChainReport;
pub use shape::{ChainShape, LatchingPair, ModuleFace};
