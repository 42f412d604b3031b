//! Studies of a problem, and comparisons of two: each returns the report of its command.

use crate::plan::{Expected, method, resolution};
use crate::problem::Problem;
use crate::refusal::Refusal;
use crate::rendered::Rendered;
use crate::work::{How, work};
use catchment::exec::Stopwatch;
use catchment::method::zraa::{self, AcceptedSquare, Nilsson};
use catchment::pose::PoseError;
use catchment::poses::parse_sizes;
use catchment::report::compare::{ComparisonSource, compare as compared};
use catchment::report::schema::Timing;
use catchment::report::{AcceptedOffsets, JamsReport, WindowReport, ZraaReport, figure};
use catchment::run::window;
use catchment::run::{Run, jams};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Wall-clock time, and number of threads.
fn timing(started: &Stopwatch, exec: &catchment::exec::Exec) -> Timing {
    Timing { total_s: started.seconds(), threads: exec.threads() }
}

#[pymethods]
impl Problem {
    /// Finds the tolerance window: the largest box of errors that all dock.
    #[expect(clippy::too_many_arguments, reason = "Python's package gives each its name")]
    fn window(
        &self,
        py: Python<'_>,
        fix: Option<String>,
        proportions: Option<String>,
        motions: Option<usize>,
        seed: u64,
        friction: f64,
        how: How,
    ) -> PyResult<Rendered> {
        work(py, &how, |exec| {
            let started = Stopwatch::start();
            let problem = &self.inner;
            let sizes = |name: &str, text: &Option<String>| {
                let read = text.as_ref().map(|text| parse_sizes(text, problem.design())).transpose();
                read.map_err(|diagnostics| Refusal::of_argument(name, diagnostics))
            };
            let fixed = sizes("fix", &fix)?.unwrap_or_default();
            let proportions = sizes("proportions", &proportions)?;
            if let Some(both) = problem.alignment().free.iter().find(|axis| {
                let is_given = |sizes: &[Option<f64>; 5]| sizes[axis.index()].is_some();
                is_given(&fixed) && proportions.as_ref().is_some_and(is_given)
            }) {
                let message = format!("{} is both given by fix and among the proportions", both.name());
                return Err(Refusal::argument("fix", message));
            }
            let proportions =
                proportions.map(|sizes| PoseError::from_array(sizes.map(Option::unwrap_or_default)));
            let settings = window::WindowSettings { fixed, proportions, motions, seed, friction };
            let results = window::run(problem, &settings, exec)?;
            let report = WindowReport::new(
                problem.design(),
                results,
                problem.warnings(),
                Some(timing(&started, exec)),
            );
            Rendered::of(&report)
        })
    }

    /// Finds the jams: rests that do not dock, with their features.
    #[expect(clippy::too_many_arguments, reason = "Python's package gives each its name")]
    fn jams(
        &self,
        py: Python<'_>,
        motions: Option<usize>,
        seed: u64,
        examine: usize,
        cells: Option<String>,
        friction: f64,
        certified: bool,
        expected: Expected,
        how: How,
    ) -> PyResult<Rendered> {
        work(py, &how, |exec| {
            let started = Stopwatch::start();
            let problem = &self.inner;
            let errors = expected.distribution(problem)?;
            let resolution = resolution(cells.as_deref())?;
            let settings = jams::JamsSettings {
                motions,
                seed,
                errors,
                examined: examine,
                friction,
                resolution,
                certified,
            };
            let results = jams::run(problem, &settings, exec)?;
            let report =
                JamsReport::new(problem.design(), results, problem.warnings(), Some(timing(&started, exec)));
            let rendered = Rendered::of(&report)?;
            rendered.with(figure::jams(&report.design, &report.result, problem.connector()))
        })
    }

    /// Computes exactly the offsets corrected with all rotations locked (ZRAA).
    fn zraa(&self, py: Python<'_>, how: How) -> PyResult<Rendered> {
        work(py, &how, |exec| {
            let problem = &self.inner;
            let results = zraa::run(problem.pair(), &zraa::ZraaSettings::default(), exec)?;
            let square = AcceptedSquare::of(&results, exec)?;
            let nilsson = Nilsson::beside(&results, problem.pair());
            let offsets = AcceptedOffsets::new(problem.design(), &results, &square, nilsson.as_ref());
            let report = ZraaReport::new(problem.design(), offsets, Vec::new(), None);
            let rendered = Rendered::of(&report)?;
            rendered.with(Ok(figure::region(problem.design(), &results, &square)))
        })
    }
}

/// A side of a comparison: a problem with its name, method and settings, or a stored result.
#[derive(FromPyObject)]
pub(crate) enum Side<'py> {
    /// Path of a stored result.
    Stored(PathBuf),
    /// Displayed name, problem, method, and settings of the method.
    Fresh(String, PyRef<'py, Problem>, String, String),
}

/// Compares two areas of acceptance.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    sides: [Side<'_>; 2],
    cells: Option<String>,
    how: How,
) -> PyResult<Rendered> {
    let source = |side: &Side<'_>| -> Result<ComparisonSource, Refusal> {
        Ok(match side {
            Side::Stored(path) => ComparisonSource::Stored(path.clone()),
            Side::Fresh(source, problem, name, settings) => {
                let method = method(name, settings)?;
                method.applies_to(problem.inner.design())?;
                let (problem, run) = (Box::new(problem.inner.clone()), Box::new(Run::by(method)));
                ComparisonSource::Fresh { source: source.clone(), problem, run }
            }
        })
    };
    let sources =
        || -> Result<[ComparisonSource; 2], Refusal> { Ok([source(&sides[0])?, source(&sides[1])?]) };
    let sources = sources().map_err(|refusal| refusal.raise(py))?;
    work(py, &how, |exec| {
        let results = compared(sources, resolution(cells.as_deref())?, true, exec)?;
        let rendered = Rendered::of(&results.report)?;
        match results.picture {
            Some(picture) => rendered.with(picture),
            None => Ok(rendered),
        }
    })
}
