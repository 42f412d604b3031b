//! The module that Python loads: the library's `Problem` and `Run`, their reports, and arrays. What people see of it is
//! the package `python/catchment`, which adds names, units and docstrings; `_catchment.pyi` says what is here.
//!
//! ```text
//!   catchment (Python)  ──▶ _catchment.Problem ──▶ catchment::problem::Problem      geometry, checked once
//!     arguments, units          .plan → Run as JSON ──▶ .run → Answer               what changes an answer is data
//!     docstrings, pictures      .follow_many      arrays in, arrays out, no copies
//!                               .window …  ──▶ Rendered: JSON, table, CSV, picture     the reports of the command line
//! ```
//!
//! Every computation leaves the interpreter free, tells its progress, and ends on Ctrl-C ([`work`]). Refusals are
//! Python exceptions with places ([`refusal`]).
//!
//! Not promised: anything to who imports `_catchment` without the package around it.

#![expect(clippy::needless_pass_by_value, reason = "Python hands arguments over as values")]

mod answer;
mod follow;
mod plan;
mod problem;
mod program;
mod refusal;
mod rendered;
mod studies;
mod sweep;
mod work;

use pyo3::prelude::*;

/// The module.
#[pymodule]
fn _catchment(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<answer::Answer>()?;
    module.add_class::<rendered::Rendered>()?;
    module.add_class::<sweep::Sweep>()?;
    module.add_function(wrap_pyfunction!(problem::read_text, module)?)?;
    module.add_function(wrap_pyfunction!(plan::methods, module)?)?;
    module.add_function(wrap_pyfunction!(studies::compare, module)?)?;
    module.add_function(wrap_pyfunction!(program::program, module)?)
}
