//! Studies: evaluations that combine many computations of a design.
//!
//! ```text
//!   slices       two errors at a time, everything free            one design, n (n − 1)/2 planes
//!   planes       the same through zero only, beside a grid       one design, the planes of figures at zero
//!   agreement    every method on one grid                        one design, agreement of each pair
//!   convergence  finer and finer grids until stable               one design, every method
//!   sensitivity  the Sum against rho, COR and aspect ratio         one design, the same poses for each value
//!   trials       trials of single poses beside the exact region  one design, finer grids and time steps
//!   success      probability that robot errors are corrected     one design, stratified exact motions
//!   friction     docking and sticking at each friction           one design, the same poses at every friction
//!   hold         forces and torques that a docked half resists   one design, contact forces alone
//!   chance       probability of docking in drop tests             one design, declared laws, trials in a rigid-body engine
//!   plan         test poses for a robot                          one design, exact motions at every pose
//!   validate     test of the prediction by a robot's trials      one design, exact motions and the trials
//!   sweep        any keys of the design file, all combinations     many designs, one run
//! ```

pub mod agreement;
#[cfg(feature = "drop")]
pub mod chance;
pub mod convergence;
pub mod friction;
pub mod hold;
pub mod plan;
pub mod planes;
pub mod refinement;
pub mod sensitivity;
pub mod slices;
pub mod success;
pub mod sweep;
pub mod trials;
pub mod validate;

use catchment_core::acceptance::Outcome;
use catchment_core::method::descent;

/// Bytes per descent while they run: the end and the outcome of each, and the ends once more while the parts of the
/// threads are put together.
const fn pose_bytes() -> u64 {
    (2 * size_of::<descent::End>() + size_of::<Outcome>()) as u64
}

#[cfg(test)]
mod testing {
    //! Problems to try things on.

    use catchment_core::design::{Design, Family};
    use catchment_core::pose::DofSet;
    use catchment_core::problem::Problem;

    /// A family with its defaults, free in `free`.
    pub(crate) fn problem(family: Family, free: DofSet) -> Problem {
        Problem::of(Design::of_family(family, free)).unwrap()
    }
}
