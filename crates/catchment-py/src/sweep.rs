//! A sweep, whole or design by design. Results that were computed elsewhere are merged here into the report of a single
//! machine, byte for byte.
//!
//! ```text
//!   Sweep ──▶ key(k) ──▶ stored? ──no──▶ design(k), anywhere ──▶ (key, JSON) ──▶ keep ──▶ report()
//! ```

use crate::plan::{Expected, RunRequest};
use crate::problem::Problem;
use crate::refusal::Refusal;
use crate::rendered::Rendered;
use crate::work::{How, work};
use catchment::exec::{Exec, Stopwatch};
use catchment::report::folder::{StudyFolder, encode};
use catchment::report::schema::Timing;
use catchment::report::{FinishedDesigns, SweepReport, figure};
use catchment::study::sweep::{
    DesignResult, DesignStore, NoStore, SweepAxis, SweepError, SweepPlan, SweepSettings,
};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;

/// The designs of a sweep, parsed and not yet computed.
#[pyclass(frozen, module = "catchment._catchment")]
pub(crate) struct Sweep {
    plan: SweepPlan,
    parts: Option<FinishedDesigns>,
    output: Option<PathBuf>,
}

/// Results that were computed elsewhere, and results stored beside the output.
struct Both<'a> {
    found: BTreeMap<String, DesignResult>,
    kept: Option<&'a FinishedDesigns>,
}

impl DesignStore for Both<'_> {
    fn find(&self, key: &str) -> Option<DesignResult> {
        self.found.get(key).cloned().or_else(|| self.kept?.find(key))
    }

    fn keep(&self, key: &str, found: &DesignResult) -> io::Result<()> {
        self.kept.map_or(Ok(()), |kept| kept.keep(key, found))
    }
}

/// The error of a sweep, at the argument that causes it.
fn refused(error: SweepError) -> Refusal {
    match error {
        SweepError::Problem(error) => error.into(),
        SweepError::Run(error) => error.into(),
        SweepError::NotApplicable(error) => error.into(),
        SweepError::Cancelled(_) => Refusal::Cancelled,
        SweepError::Key { .. }
        | SweepError::TwoAxes { .. }
        | SweepError::NoAxis
        | SweepError::TooMany { .. } => Refusal::argument("over", error),
        error => error.into(),
    }
}

#[pymethods]
impl Sweep {
    #[new]
    fn new(
        py: Python<'_>,
        problem: &Problem,
        over: Vec<String>,
        requested: RunRequest,
        expected: Expected,
        output: Option<PathBuf>,
    ) -> PyResult<Self> {
        let plan = || -> Result<SweepPlan, Refusal> {
            let axes = over.iter().map(|axis| axis.parse::<SweepAxis>()).collect::<Result<Vec<_>, _>>();
            let axes = axes.map_err(|error| Refusal::argument("over", error))?;
            if let Some((name, _)) =
                problem.changes.keys().find(|(_, key)| axes.iter().any(|axis| axis.key == *key))
            {
                let message = format!("{name} was replaced in the problem, and is varied; do one of both");
                return Err(Refusal::argument("over", message));
            }
            let run = requested.run(&problem.inner, &expected)?;
            if let Some(path) = &output {
                StudyFolder { path, name: "sweep" }.check(&Exec::new())?;
            }
            let settings = SweepSettings { axes, run };
            SweepPlan::new(&problem.source, settings, |draft| problem.changes.apply(draft)).map_err(refused)
        };
        let plan = plan().map_err(|refusal| refusal.raise(py))?;
        let parts = output.as_deref().map(FinishedDesigns::beside);
        Ok(Self { plan, parts, output })
    }

    fn __len__(&self) -> usize {
        self.plan.len()
    }

    /// The numbers of the designs without a stored result.
    fn missing(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        let Some(parts) = &self.parts else { return Ok((0..self.plan.len()).collect()) };
        let missing = |number: &usize| match self.plan.key(*number) {
            Ok(Some(key)) => Ok(parts.find(&key).is_none()),
            Ok(None) => Ok(false),
            Err(error) => Err(error),
        };
        let numbers = (0..self.plan.len()).map(|number| missing(&number).map(|is| is.then_some(number)));
        let numbers = py.detach(|| numbers.collect::<Result<Vec<_>, _>>());
        Ok(numbers.map_err(|error| refused(error).raise(py))?.into_iter().flatten().collect())
    }

    /// Computes a design: its key and its results as JSON; `None` if its halves cannot be built.
    fn design(&self, py: Python<'_>, number: usize, how: How) -> PyResult<Option<(String, String)>> {
        if number >= self.plan.len() {
            let message = format!("there is no design {number} of {}", self.plan.len());
            return Err(Refusal::argument("number", message).raise(py));
        }
        work(py, &how, |exec| match self.plan.design(number, exec).map_err(refused)? {
            Some((key, found)) => Ok(Some((key, serde_json::to_string(&found)?))),
            None => Ok(None),
        })
    }

    /// Stores the result of a design that was computed elsewhere, if results are stored.
    fn keep(&self, py: Python<'_>, key: &str, found: &str) -> PyResult<()> {
        let keep = || -> Result<(), Refusal> {
            let found: DesignResult = serde_json::from_str(found)?;
            Ok(self.parts.as_ref().map_or(Ok(()), |parts| parts.keep(key, &found))?)
        };
        keep().map_err(|refusal| refusal.raise(py))
    }

    /// Computes the designs that are neither in `found` nor in the folder; returns the report of all designs.
    fn run(&self, py: Python<'_>, found: Vec<(String, String)>, how: How) -> PyResult<Rendered> {
        work(py, &how, |exec| {
            let started = Stopwatch::start();
            let read =
                |(key, found): (String, String)| Ok::<_, Refusal>((key, serde_json::from_str(&found)?));
            let found = found.into_iter().map(read).collect::<Result<BTreeMap<String, DesignResult>, _>>()?;
            let keep = Both { found, kept: self.parts.as_ref() };
            let is_nothing = keep.found.is_empty() && keep.kept.is_none();
            let keep: &dyn DesignStore = if is_nothing { &NoStore } else { &keep };
            let base = self.plan.base().clone();
            let found = self.plan.clone().run(keep, exec).map_err(refused)?;
            let timing = Timing { total_s: started.seconds(), threads: exec.threads() };
            let report = SweepReport::new(&base, found, Vec::new(), Some(timing));
            let map = figure::sweep_map(&report);
            let rendered = Rendered::of(&report)?;
            if let Some(path) = &self.output {
                self.save(&report, path, exec)?;
            }
            match map {
                Some(map) => rendered.with(Ok(map)),
                None => Ok(rendered),
            }
        })
    }
}

impl Sweep {
    /// Writes the same files as the command line.
    fn save(&self, report: &SweepReport, path: &std::path::Path, exec: &Exec) -> Result<(), Refusal> {
        let mut drawn = Vec::new();
        drawn.extend(figure::sweep_map(report).map(|picture| ("sweep", picture)));
        drawn.extend(figure::sweep_outlines(report)?.map(|picture| ("outlines", picture)));
        let pictures = encode(&drawn, exec)?;
        let folder = StudyFolder { path, name: "sweep" };
        folder.write(&report.to_json()?, &report.records(), pictures, exec, |into| {
            report.save_group(into, exec)
        })?;
        if let Some(parts) = &self.parts {
            parts.clear();
        }
        Ok(())
    }
}
