//! The parts of a page: a result, computed or stored, its halves, and its studies.

use super::Page;
#[cfg(feature = "zarr")]
use crate::document::OfDesign;
use crate::schema::WindowSection;
use crate::{JamsReport, Report, WindowReport};
use catchment_core::acceptance::Acceptance;
#[cfg(feature = "zarr")]
use catchment_core::acceptance::Domain;
#[cfg(feature = "zarr")]
use catchment_core::design::{Design, hex};
use catchment_core::diagnostic::Advice;
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::method::Method;
use catchment_core::problem::Problem;
use catchment_core::run::Answer;
use catchment_core::run::jams::{self, JamsError};
use catchment_core::run::window::ToleranceWindow;
use catchment_core::run::window::{self, WindowError};
use catchment_study::planes;
use serde_json::json;

/// A page in parts.
#[derive(Debug, Clone)]
pub struct PageParts {
    /// The run.
    pub report: Report,
    /// Its outcomes.
    pub acceptance: Acceptance,
    /// Outcomes over planes through zero, once they are studied.
    pub planes: Vec<Acceptance>,
    /// The decided problem, if its halves are available.
    pub problem: Option<Problem>,
    /// The jams.
    pub jams: Option<JamsReport>,
    /// The window.
    pub window: Option<WindowReport>,
    /// Notes about the page.
    pub notes: Vec<String>,
}

/// Studies beside a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Studies {
    /// Planes through zero, of a grid of three or more errors.
    pub planes: bool,
    /// Whether to compute the jams.
    pub jams: bool,
    /// The largest box that docks.
    pub window: bool,
}

impl PageParts {
    /// Of an answer.
    pub fn of(answer: &Answer) -> Self {
        let (report, acceptance) = (Report::of_answer(answer), answer.acceptance.clone());
        let problem = Some(answer.problem.clone());
        Self { report, acceptance, planes: Vec::new(), problem, jams: None, window: None, notes: Vec::new() }
    }

    /// Parts of a stored result, from its folder or its group, with its stored jams and window. Halves from
    /// files are read again; if they are missing or have changed, the page omits them and notes this.
    ///
    /// # Errors
    /// It cannot be read.
    /// It cannot be read.
    #[cfg(feature = "zarr")]
    pub fn stored(path: &std::path::Path, exec: &Exec) -> Result<Self, crate::zarr::ZarrError> {
        use crate::folder::RESULT;
        let inner = path.join(RESULT);
        let without_grid = if inner.is_dir() { None } else { sampled(path) };
        let (report, acceptance) = match without_grid {
            Some(report) => {
                let domain = Domain::Poses(Vec::new());
                let (method, outcomes) = ("descent", Vec::new());
                (report, Acceptance { method, domain, outcomes, warnings: Vec::new() })
            }
            None => crate::zarr::read(if inner.is_dir() { &inner } else { path }, exec)?,
        };
        let (problem, notes) = match again(&report.design) {
            Ok(problem) => (Some(problem), Vec::new()),
            Err(why) => (None, vec![why]),
        };
        let design = || report.design.clone();
        let jams = report
            .jams
            .clone()
            .map(|result| JamsReport::of(OfDesign { design: design(), result }, Vec::new(), None));
        let window = report.window.clone().map(|WindowSection { half_widths, details }| {
            let result = ToleranceWindow { window: half_widths, details };
            WindowReport::of(OfDesign { design: design(), result }, Vec::new(), None)
        });
        Ok(Self { report, acceptance, planes: Vec::new(), problem, jams, window, notes })
    }

    /// Adds studies, with the friction of the run. A study without a result leaves a note.
    ///
    /// # Errors
    /// The computation was cancelled.
    pub fn study(&mut self, studies: Studies, exec: &Exec) -> Result<(), Cancelled> {
        let Some(problem) = &self.problem else { return Ok(()) };
        let (design, friction) = (problem.design(), self.report.friction());
        if studies.planes {
            match through_zero(problem, &self.report, &self.acceptance, exec) {
                Ok(planes) => self.planes = planes,
                Err(PlanesError::Cancelled(cancelled)) => return Err(cancelled),
                Err(why) => self.notes.push(format!("slices at zero show cells of the grid: {why}")),
            }
        }
        if studies.jams {
            match jams::run(problem, &jams::JamsSettings { friction, ..jams::JamsSettings::default() }, exec)
            {
                Ok(found) => self.jams = Some(JamsReport::new(design, found, Vec::new(), None)),
                Err(JamsError::Cancelled(cancelled)) => return Err(cancelled),
                Err(why) => self.notes.push(format!("no jams: {why}")),
            }
        }
        if studies.window {
            match window::run(
                problem,
                &window::WindowSettings { friction, ..window::WindowSettings::default() },
                exec,
            ) {
                Ok(found) => self.window = Some(WindowReport::new(design, found, Vec::new(), None)),
                Err(WindowError::Cancelled(cancelled)) => return Err(cancelled),
                Err(why) => self.notes.push(format!("no window: {why}")),
            }
        }
        Ok(())
    }

    /// The page, of a file.
    pub fn page(&self) -> Page<'_> {
        let Self { report, acceptance, planes, problem, jams, window, notes } = self;
        Page {
            report,
            acceptance,
            planes,
            halves: problem.as_ref().map(Problem::connector),
            jams: jams.as_ref(),
            window: window.as_ref(),
            notes: notes.clone(),
            is_served: false,
        }
    }
}

/// Why a page has no planes through zero.
#[derive(Debug, thiserror::Error)]
enum PlanesError {
    #[error("the settings of its method cannot be read ({0})")]
    Method(#[from] serde_json::Error),
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The planes of the result's pictures: by the motions of its method; empty if the method's own cells are
/// shown.
fn through_zero(
    problem: &Problem,
    report: &Report,
    acceptance: &Acceptance,
    exec: &Exec,
) -> Result<Vec<Acceptance>, PlanesError> {
    let method = json!({ "name": report.method, "settings": report.settings });
    let method: Method = serde_json::from_value(method)?;
    let Some(grid) = acceptance.grid().filter(|_| !method.info().departs) else { return Ok(Vec::new()) };
    let (pair, motions) = (problem.pair(), method.motions());
    let needed = planes::bytes(pair, &motions, grid);
    exec.ensure_fits("the slices at zero", needed, |_| vec![Advice::MoreMemory])?;
    Ok(planes::through_zero(pair, &motions, grid, exec)?)
}

/// The report of a stored run without a grid; its poses are in no picture of a page.
#[cfg(feature = "zarr")]
fn sampled(path: &std::path::Path) -> Option<Report> {
    use crate::{bounded, folder::REPORT};
    let bytes = bounded::read(&path.join(REPORT), bounded::REPORT_BYTES).ok()?;
    let report = Report::from_json(std::str::from_utf8(&bytes).ok()?).ok()?;
    (report.axes.is_empty() && report.check().is_ok()).then_some(report)
}

/// The problem of a stored design, if it is unchanged; else a note.
#[cfg(feature = "zarr")]
fn again(design: &Design) -> Result<Problem, String> {
    let without = "the page has no halves and no motions";
    let problem = Problem::of(design.clone()).map_err(|error| {
        let first = error.to_string().lines().next().unwrap_or_default().to_owned();
        format!("{without}: they cannot be built again from what the result says: {first}")
    })?;
    match design.digest() {
        Some(digest) if hex(&digest) == problem.digest() => Ok(problem),
        _ => Err(format!("{without}: their files are no longer what the result was computed from")),
    }
}
