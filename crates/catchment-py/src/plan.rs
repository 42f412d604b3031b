//! Conversion of the arguments of a run to a `Run`, which is passed as JSON.

use crate::problem::Problem;
use crate::refusal::Refusal;
use catchment::landscape::Resolution;
use catchment::method::correction::Stop;
use catchment::method::{Method, REGISTRY};
use catchment::poses::Distribution;
use catchment::report::{UnanswerableError, check_requirements};
use catchment::run::{Over, Requirement, Run, Sample};
use pyo3::prelude::*;
use serde_json::{Map, Value};
use std::time::Duration;

/// Every method: its name, and a description in a single line.
#[pyfunction]
pub(crate) fn methods() -> Vec<(&'static str, &'static str)> {
    REGISTRY.iter().map(|entry| (entry.info.name, entry.info.summary)).collect()
}

/// The method of this name, with the given settings.
pub(crate) fn method(name: &str, settings: &str) -> Result<Method, Refusal> {
    let settings: Map<String, Value> = serde_json::from_str(settings)?;
    Ok(name.parse::<Method>()?.with(&settings)?)
}

/// Parses a resolution.
pub(crate) fn resolution(text: Option<&str>) -> Result<Option<Resolution>, Refusal> {
    Ok(text.map(str::parse::<Resolution>).transpose()?)
}

/// Expected pose errors of a robot.
#[derive(FromPyObject)]
pub(crate) struct Expected {
    #[pyo3(item)]
    error_sigma: Option<String>,
    #[pyo3(item)]
    error_uniform: Option<String>,
}

impl Expected {
    /// The distribution of the errors, in D and radians.
    pub(crate) fn distribution(
        &self,
        problem: &catchment::problem::Problem,
    ) -> Result<Option<Distribution>, Refusal> {
        let design = problem.design();
        let (name, read) = match (&self.error_sigma, &self.error_uniform) {
            (Some(_), Some(_)) => {
                return Err(Refusal::argument(
                    "error_uniform",
                    "error_sigma is given as well; leave out one of them",
                ));
            }
            (Some(text), None) => ("error_sigma", Distribution::normal(text, design)),
            (None, Some(text)) => ("error_uniform", Distribution::uniform(text, design)),
            (None, None) => return Ok(None),
        };
        read.map(Some).map_err(|diagnostics| Refusal::of_argument(name, diagnostics))
    }
}

/// Arguments of a run.
#[derive(FromPyObject)]
pub(crate) struct RunRequest {
    #[pyo3(item)]
    method: String,
    #[pyo3(item)]
    settings: String,
    #[pyo3(item)]
    resolution: Option<String>,
    #[pyo3(item)]
    poses: Option<usize>,
    #[pyo3(item)]
    samples: Option<usize>,
    #[pyo3(item)]
    budget_s: Option<f64>,
    #[pyo3(item)]
    tolerance: Option<f64>,
    #[pyo3(item)]
    seed: u64,
    #[pyo3(item)]
    require: Vec<String>,
    #[pyo3(item)]
    heights: bool,
    #[pyo3(item)]
    jams: bool,
    #[pyo3(item)]
    window: bool,
}

/// The smallest tolerance; 10¹⁰ exact motions would not reach it.
const SMALLEST_SHARE: f64 = 1e-5;
/// The largest time budget, in seconds.
const LONGEST_S: f64 = 1e7;

impl RunRequest {
    fn sample(&self) -> Result<Sample, Refusal> {
        let given = [self.samples.is_some(), self.budget_s.is_some(), self.tolerance.is_some()];
        if given.into_iter().filter(|given| *given).count() > 1 {
            let message = "samples, budget and tolerance each say when sampling stops; give one of them";
            return Err(Refusal::argument("samples", message));
        }
        Ok(match (self.samples, self.budget_s, self.tolerance) {
            (_, Some(seconds), _) if seconds > 0.0 && seconds <= LONGEST_S => {
                Sample::Until(Stop::Budget(Duration::from_secs_f64(seconds)))
            }
            (_, Some(_), _) => {
                return Err(Refusal::argument("budget", "a time is a positive number of seconds"));
            }
            (_, _, Some(share)) if (SMALLEST_SHARE..1.0).contains(&share) => {
                Sample::Until(Stop::Tolerance(share))
            }
            (_, _, Some(_)) => {
                let message = "a tolerance is a share of the Sum between 0.00001 and 1, such as 0.01";
                return Err(Refusal::argument("tolerance", message));
            }
            (Some(0), ..) => Sample::None,
            (Some(samples), ..) => Sample::Until(Stop::Samples(samples)),
            (None, None, None) => Sample::ByMethod,
        })
    }

    /// The run of a problem with these arguments.
    pub(crate) fn run(
        &self,
        problem: &catchment::problem::Problem,
        expected: &Expected,
    ) -> Result<Run, Refusal> {
        let requirement =
            |text: &String| text.parse::<Requirement>().map_err(|error| Refusal::argument("require", error));
        Ok(Run {
            method: method(&self.method, &self.settings)?,
            over: match self.poses {
                Some(poses) => Over::Stream(poses),
                None => Over::Grid(resolution(self.resolution.as_deref())?.unwrap_or_default()),
            },
            sample: self.sample()?,
            seed: self.seed,
            errors: expected.distribution(problem)?,
            requirements: self.require.iter().map(requirement).collect::<Result<_, _>>()?,
            heights: self.heights,
            jams: self.jams,
            window: self.window,
        })
    }
}

#[pymethods]
impl Problem {
    /// The arguments as a run in JSON. Raises if the run is impossible.
    fn plan(&self, py: Python<'_>, requested: RunRequest, expected: Expected) -> PyResult<String> {
        let plan = || -> Result<String, Refusal> {
            let run = requested.run(&self.inner, &expected)?;
            run.plan(&self.inner)?;
            check_requirements(&run, &self.inner).map_err(|error| match error {
                UnanswerableError::Run(error) => error.into(),
                error @ UnanswerableError::Requirement { .. } => Refusal::argument("require", error),
            })?;
            Ok(serde_json::to_string(&run)?)
        };
        plan().map_err(|refusal| refusal.raise(py))
    }
}
