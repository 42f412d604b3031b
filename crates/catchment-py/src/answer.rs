//! Runs, whole and in parts, and their results.

use crate::problem::Problem;
use crate::refusal::Refusal;
use crate::rendered::PNG_SCALE;
use crate::work::{How, work};
use catchment::report::figure::DrawnFigures;
use catchment::report::{Report, save, save_group};
use catchment::run::{self, PartAnswer, Run, RunPart};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The result of a run.
#[pyclass(frozen, module = "catchment._catchment")]
pub(crate) struct Answer {
    inner: run::Answer,
}

#[pymethods]
impl Problem {
    /// Computes a run of `plan`.
    fn run(&self, py: Python<'_>, run: &str, how: How) -> PyResult<Answer> {
        let inner = work(py, &how, |exec| Ok(read(run)?.on(&self.inner, exec)?))?;
        Ok(Answer { inner })
    }

    /// Decides a part of a run; returns JSON for `merge`.
    fn part(&self, py: Python<'_>, run: &str, number: usize, of: usize, how: How) -> PyResult<String> {
        work(py, &how, |exec| {
            let part = read(run)?.part(&self.inner, RunPart { number, of }, exec)?;
            Ok(serde_json::to_string(&part)?)
        })
    }

    /// Merges the parts of a run, and continues as `run` does.
    fn merge(&self, py: Python<'_>, run: &str, parts: Vec<String>, how: How) -> PyResult<Answer> {
        let inner = work(py, &how, |exec| {
            let parts = parts.iter().map(|part| serde_json::from_str(part));
            let parts = parts.collect::<Result<Vec<PartAnswer>, _>>()?;
            Ok(read(run)?.merge(&self.inner, parts, exec)?)
        })?;
        Ok(Answer { inner })
    }
}

/// Parses a run that `plan` wrote.
fn read(run: &str) -> Result<Run, Refusal> {
    Ok(serde_json::from_str(run)?)
}

#[pymethods]
impl Answer {
    /// The report, as the command line prints it.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        Report::of_answer(&self.inner).to_json().map_err(|error| Refusal::from(error).raise(py))
    }

    /// The report as a table to read.
    fn table(&self) -> String {
        Report::of_answer(&self.inner).table()
    }

    /// The code of every outcome: 1 aligned, 2 jammed, 3 missed, 4 undecided. The first axis varies fastest.
    fn outcomes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        let codes = self.inner.acceptance.outcomes.iter().map(|outcome| *outcome as u8).collect();
        PyArray1::from_vec(py, codes)
    }

    /// Heights of first contact over the grid, in D; `None` unless they were kept.
    fn heights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f32>>> {
        self.inner
            .by_products
            .landscape
            .as_ref()
            .map(|landscape| PyArray1::from_slice(py, &landscape.heights))
    }

    /// Unmet requirements, as sentences.
    fn unmet(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let verdicts = Report::of_answer(&self.inner)
            .verdicts(&self.inner.run.requirements)
            .map_err(|error| Refusal::from(error).raise(py))?;
        Ok(verdicts.iter().filter(|verdict| !verdict.met).map(ToString::to_string).collect())
    }

    /// Draws every picture: its name, SVG and PNG.
    fn draw(&self, py: Python<'_>, how: How) -> PyResult<Vec<(&'static str, String, Vec<u8>)>> {
        work(py, &how, |exec| {
            let drawn = DrawnFigures::of(&self.inner, exec)?.pictures;
            let encoded = drawn.into_iter().map(|(name, picture)| {
                exec.check()?;
                Ok((name, picture.svg().to_owned(), picture.png(PNG_SCALE)?))
            });
            encoded.collect()
        })
    }

    /// Writes everything into a folder, or only the Zarr group if the path ends with `.zarr`.
    fn save(&self, py: Python<'_>, path: PathBuf, how: How) -> PyResult<()> {
        work(py, &how, |exec| {
            if path.extension().is_some_and(|ending| ending == "zarr") {
                Ok(save_group(&self.inner, &path, exec)?)
            } else {
                Ok(save(&self.inner, &path, exec).map(drop)?)
            }
        })
    }
}
