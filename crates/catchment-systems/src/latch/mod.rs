//! The latching X-Face: two halves of the same shape that align, press their arms aside and hook into each
//! other.
//!
//! ```text
//!   f(0) ●__                       one layer, seen from the side; x right, y up, mm
//!        │  ‾‾‾──__                  y = 0   the plane of the overhang's underside
//!        │         ‾‾─_    hook      o       overhang: the hook covers this much of the partner's
//!        │   arm       ╲_●           t       compliance neck, the only support of the arm
//!        │             ┌─┘ y = 0     P       its middle, about which the arm turns
//!        │             ●─o─          The partner is the same part, turned by 180° about (L/2, 0).
//!        │              ╲            The second layer is the mirror image.
//!   ─────┴─────────┐t║   ‾─_
//!   ───cut-out─────┘P║slit  ‾‾──●   −f(0)
//!        body        ║          │
//!   ────────────────────────────┘
//! ```
//!
//! [`LatchDesign`] is the content of a design file, [`Geometry`] the outline that follows from it, [`rules()`] the
//! requirements on the outline with their reasons. [`force`] computes the forces to latch and to break, from
//! the nine measured designs of [`measured`]; [`press`] simulates the pressing of two halves. [`drawing`]
//! writes the files for a laser cutter.
//!
//! Source: the dissertation, sections 6.1 and 6.2 (pages 91 to 101), table 6.1. Its drawings are lost to us:
//! the outline is *derived* from its sentences, and every reading of ours is marked [`Basis::Inferred`].
//!
//! Lengths are in mm, angles in rad, forces in N, moduli in `MPa`.
//!
//! # Not promised
//!
//! Arms are rigid, necks are springs without mass, hysteresis or damage. The force to latch is a fit to nine
//! prototypes of one material and one sheet; outside their range it is an extrapolation, and is marked as
//! such. The force to break at the tip of the overhang is known at a single overhang. The three-sided part
//! has a cut-out of another shape that is not described.

pub mod connector;
pub mod drawing;
pub mod figure;
pub mod fit;
pub mod force;
pub mod kerf;
pub mod measured;
pub mod outline;
pub mod parameters;
pub mod press;
pub mod profile;
pub mod report;
pub mod rules;
pub mod stiffness;
pub mod table;

pub use outline::{Geometry, GeometryError};
pub use parameters::{LatchDesign, Press};
pub use report::{LatchBody, LatchReport};
pub use rules::{LatchRule, RuleCheck, rules};
pub use table::{TableBody, TableReport};

use serde::{Deserialize, Serialize};

/// Basis of a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// The dissertation states it.
    Stated,
    /// Computed again from its numbers.
    Recomputed,
    /// Our reading of it.
    Inferred,
}

impl Basis {
    /// The letter that stands for it in tables.
    pub const fn letter(self) -> &'static str {
        match self {
            Self::Stated => "D",
            Self::Recomputed => "R",
            Self::Inferred => "I",
        }
    }
}
