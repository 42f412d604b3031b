//! Ways to decide what becomes of a pose error. All enter through one door ([`Method`]): settings + problem + domain + `&Exec` →
//! outcomes, doubts and by-products ([`Decided`]).
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
//! [`correction`] gives the Sum of any of them its interval by exact descents. [`zraa`] decides translation alone and is
//! entered by itself. A method is added by its folder, which implements [`Decide`], and by one line in [`REGISTRY`].

pub mod certified;
pub mod confluence;
pub mod correction;
pub mod descent;
mod door;
#[cfg(feature = "drop")]
pub mod drop;
pub mod flood;
pub mod kinematic;
mod metric;
pub mod partition;
pub mod transport;
pub mod zraa;

pub use door::{
    ByProducts, Cost, Decide, DecideError, Decided, Doubts, Entry, Finished, Follow, Info, Method,
    MethodError, NotApplicable, affordable, ensure_fits,
};

/// Every method, the default first.
pub static REGISTRY: &[Entry] = &[
    confluence::door::ENTRY,
    descent::door::ENTRY,
    flood::door::ENTRY,
    flood::door::ENTRY_STEEPEST,
    flood::meyer::door::ENTRY,
    partition::door::ENTRY,
    kinematic::door::ENTRY,
    certified::door::ENTRY,
    #[cfg(feature = "drop")]
    drop::door::ENTRY,
    transport::door::ENTRY,
];

impl Method {
    /// Every registered method with its default settings, the default method first.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        REGISTRY.iter().map(Entry::method)
    }

    /// Those whose answer depends on nothing but the grid and its resolution: what studies of resolution compare.
    pub fn on_grids() -> Vec<Self> {
        REGISTRY.iter().filter(|entry| entry.info.on_grids).map(Entry::method).collect()
    }
}
