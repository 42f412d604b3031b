//! Everything that a program needs from the library in one `use`: from a problem to its result.
//!
//! ```
//! use catchment::prelude::*;
//! ```

pub use crate::acceptance::{Acceptance, Outcome};
pub use crate::connector::HalfSource;
pub use crate::design::{Alignment, Design, Family, FamilySpec};
pub use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Warning};
pub use crate::exec::Exec;
pub use crate::landscape::{Grid, Resolution};
pub use crate::method::Method;
pub use crate::method::correction::Stop;
pub use crate::pose::{Dof, DofSet, Mount, PoseError};
pub use crate::poses::Distribution;
pub use crate::problem::{Draft, Problem, ProblemError};
pub use crate::report::Report;
pub use crate::run::{Answer, Over, Run, RunError, Sample};
pub use glam::DVec3;
