//! Methods that decide outcomes of pose errors. All share an interface ([`Method`]): settings + problem +
//! domain + `&Exec` → outcomes, warnings and by-products ([`MethodOutput`]).
//!
//! ```text
//!   confluence  exact motions that join each other              the default
//!   descent     exact quasi-static motion of every pose         the ground truth
//!   flood       basins of the heights, to the lowest neighbour  steepest: to the steepest; meyer: by a queue, with dams
//!   partition   the contact space as polytopes, without a grid
//!   kinematic   planar bounds and stepping
//!   certified   boxes of poses that certainly dock, or do not
//!   drop        trials in a rigid-body engine                   feature `drop`
//!   transport   arrival along exact directions over a grid
//! ```
//!
//! [`correction`] adds an interval to the Sum of any of them by exact motions. [`zraa`] decides translation
//! alone and has a separate interface. A new method needs its folder, which implements [`DecisionMethod`], and a line
//! in [`REGISTRY`].

pub mod certified;
pub mod confluence;
pub mod correction;
mod cost;
pub mod descent;
#[cfg(feature = "drop")]
pub mod drop;
pub mod flood;
mod interface;
pub mod kinematic;
mod metric;
pub mod partition;
mod registry;
pub mod transport;
pub mod zraa;

pub use cost::{affordable, ensure_fits, motions_in, seconds_per_motion};
pub use interface::{
    ByProducts, CellFractions, Cost, DecideError, DecisionMethod, Info, MethodOutput, NotApplicable,
    PoseMethod, PoseObserver,
};
pub use registry::{Method, MethodError, REGISTRY, RegistryEntry};
