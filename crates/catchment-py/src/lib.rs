//! The module that Python loads: `Problem` and `Run` of the library, their reports, and arrays. Its public interface is
//! the package `python/catchment`, which adds names, units and docstrings; `_catchment.pyi` lists the contents of the module.
//!
//! ```text
//!   catchment (Python)  ──▶ _catchment.Problem ──▶ catchment::problem::Problem      geometry, checked once
//!     arguments, units          .plan → Run as JSON ──▶ .run → Answer               a run is data
//!     docstrings, pictures      .follow_many      arrays in, arrays out, no copies
//!                               .window …  ──▶ Rendered: JSON, table, CSV, picture     the reports of the command line
//! ```
//!
//! Every computation releases the interpreter, reports its progress, and ends on Ctrl-C ([`work`]). Errors are
//! Python exceptions with places ([`refusal`]).
//!
//! Not promised: a stable interface for code that imports `_catchment` without the package.

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

/// The module `_catchment`.
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
