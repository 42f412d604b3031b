//! A design that was read but not built yet: it can still be changed, and it knows the places of its values
//! in the file.

use super::{Problem, ProblemError, defect_keys, measure, remedies};
use crate::connector::Connector;
use crate::contact::display_unit::DisplayUnit;
use crate::contact::mated::{self, MatedProblem};
use crate::contact::{Pair, face, settle};
use crate::design::{
    ConnectorSpec, Design, DesignDefect, FilesInMemory, SourceText, Sources, Width, load, read_as,
};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::exec::Exec;
use std::path::Path;

/// A design, its text, and the places of its keys.
#[derive(Debug, Clone)]
pub struct Draft {
    design: Design,
    source: Option<SourceText>,
    places: Sources,
    /// Files that are in memory and not on disk.
    pub(super) files: FilesInMemory,
}

impl From<Design> for Draft {
    /// A design without a text: its errors have no place.
    fn from(design: Design) -> Self {
        Self { design, source: None, places: Sources::default(), files: FilesInMemory::default() }
    }
}

impl Draft {
    /// Reads a design file.
    ///
    /// # Errors
    /// The file cannot be read, or all errors of its content.
    pub fn open(path: &Path) -> Result<Self, ProblemError> {
        Self::open_on(path, &Exec::new())
    }

    /// The same, cancelled if a stop is requested while a STEP file is meshed.
    ///
    /// # Errors
    /// As [`Draft::open`].
    pub fn open_on(path: &Path, exec: &Exec) -> Result<Self, ProblemError> {
        Self::read_on(SourceText::new(path, load(path)?), exec)
    }

    /// Reads the text of a design file; meshes are searched beside `source.path`. Uses no file, unless the
    /// text omits D, which is then measured from the halves.
    ///
    /// # Errors
    /// All errors of the text; if D is omitted, also those of the geometry.
    pub fn read(source: SourceText) -> Result<Self, ProblemError> {
        Self::read_on(source, &Exec::new())
    }

    /// The same, cancelled if a stop is requested while a STEP file is meshed.
    ///
    /// # Errors
    /// As [`Draft::read`].
    pub fn read_on(source: SourceText, exec: &Exec) -> Result<Self, ProblemError> {
        let (draft, is_measured) = Self::read_as(source, Width::Provisional(None))?;
        if is_measured { measure::measured(draft, exec) } else { Ok(draft) }
    }

    /// The text of a design without D, if D is not needed: lengths in its unit, round surfaces drawn
    /// coarsely.
    pub fn read_roughly(source: SourceText) -> Result<Self, ProblemError> {
        Self::read_as(source, Width::Provisional(None)).map(|(draft, _)| draft)
    }

    /// The same with the known state of D; and whether that was needed.
    pub(super) fn read_as(source: SourceText, width: Width) -> Result<(Self, bool), ProblemError> {
        let folder = source.path.parent().unwrap_or_else(|| Path::new(""));
        match read_as(&source.text, folder, width) {
            Ok((file, is_used)) => {
                let files = source.files.clone();
                Ok((Self { design: file.design, places: file.sources, source: Some(source), files }, is_used))
            }
            Err(problems) => {
                let place = |problem: crate::design::LocatedDefect| Diagnostic {
                    span: Some(problem.span),
                    ..Diagnostic::error("design", problem.defect.to_string(), problem.defect.help())
                };
                let list = problems.list.into_iter().map(place).collect();
                Err(Diagnostics { source: Some(source), list, omitted: problems.omitted }.into())
            }
        }
    }

    /// The design as it stands.
    pub const fn design(&self) -> &Design {
        &self.design
    }

    /// The text it was read from.
    pub const fn source(&self) -> Option<&SourceText> {
        self.source.as_ref()
    }

    /// This draft with the files in memory of another.
    pub(super) fn beside(self, other: &Self) -> Self {
        Self { files: other.files.clone(), ..self }
    }

    /// The design with a change. A rejected change is reported beside the key that forbids it, prefixed with
    /// `what`, the name of the change.
    ///
    /// # Errors
    /// The change is not allowed.
    pub fn change(
        mut self,
        what: &str,
        change: impl FnOnce(Design) -> Result<Design, DesignDefect>,
    ) -> Result<Self, ProblemError> {
        match change(self.design.clone()) {
            Ok(design) => {
                self.design = design;
                Ok(self)
            }
            Err(defect) => {
                let message = format!("{what}: {defect}");
                Err(self.refused(defect_keys::of_change(&defect), message, defect.help()).into())
            }
        }
    }

    /// This design, rejected for an error of the key at `place` (such as `connector.fixed.pieces[2]`), or of
    /// the nearest item in the file.
    pub fn refused(self, place: &str, message: String, help: Option<String>) -> Diagnostics {
        let list = vec![self.diagnostic("design", place, message, help)];
        Diagnostics { source: self.source, list, omitted: 0 }
    }

    fn diagnostic(
        &self,
        code: &'static str,
        place: &str,
        message: String,
        help: Option<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, message, help).at(self.places.span(place))
    }

    /// Loads the meshes, builds the halves and checks the mated pose.
    ///
    /// # Errors
    /// All errors of the geometry; halves that do not meet in the aligned pose. An aligned pose with contact
    /// that is not stable is a warning ([`Problem::mated_warnings`]).
    pub fn build(self) -> Result<Problem, ProblemError> {
        self.build_on(&Exec::new())
    }

    /// The same with progress; cancelled if a stop is requested while a STEP file is meshed.
    ///
    /// # Errors
    /// As [`Draft::build`].
    pub fn build_on(self, exec: &Exec) -> Result<Problem, ProblemError> {
        match self.judged_on(exec)? {
            (problem, None) => Ok(problem),
            (_, Some(refusal)) => Err(refusal.into()),
        }
    }

    /// The same, with the problem even if it is rejected only for its mated pose: for drawing, not for
    /// computing.
    ///
    /// # Errors
    /// All errors of the geometry.
    pub fn judged_on(self, exec: &Exec) -> Result<(Problem, Option<Diagnostics>), ProblemError> {
        exec.report(0.0, "halves");
        match Connector::build_on(&self.design, &self.files, exec) {
            Ok(connector) => {
                let connector = match &self.design.connector {
                    ConnectorSpec::Own(own) => {
                        let result = face::with_derived_face(connector, own);
                        match own.settle.then(|| settle::settled(result.clone(), &self.design.alignment)) {
                            None => result,
                            Some(Some(settled)) => settled,
                            Some(None) => return Ok(self.run_off(result)),
                        }
                    }
                    ConnectorSpec::Family(_) => connector,
                };
                Ok(self.judged(connector, exec))
            }
            Err(problems) => Err(self.unbuilt(&problems).into()),
        }
    }

    /// Halves that settle nowhere near.
    fn run_off(mut self, connector: Connector) -> (Problem, Option<Diagnostics>) {
        self.design = self.design.with_contents(&connector.contents);
        let refusal = self.clone().unmated(&[MatedProblem::RunsOff], None);
        let pair = Pair::new(&connector, &self.design.alignment);
        (Problem::assembled(self, connector, pair, Vec::new()), Some(refusal))
    }

    /// The errors of the geometry, with their places.
    pub(super) fn unbuilt(self, problems: &[crate::connector::GeometryDefect]) -> Diagnostics {
        let list = defect_keys::of_geometry(problems, DisplayUnit::of(&self.design))
            .into_iter()
            .map(|(place, message, help)| self.diagnostic("geometry", &place, message, help))
            .collect();
        Diagnostics { source: self.source, list, omitted: 0 }
    }

    /// Whether there is no mated pose to decide about: the halves do not meet in it, or the seat leaves an error free.
    const fn is_apart(problem: &MatedProblem) -> bool {
        !matches!(problem, MatedProblem::NotMinimum { .. } | MatedProblem::LimitCutsPlay { .. })
    }

    /// The problem of built halves, unless their mated pose is invalid.
    pub(super) fn with_halves(self, connector: Connector, exec: &Exec) -> Result<Problem, ProblemError> {
        match self.judged(connector, exec) {
            (problem, None) => Ok(problem),
            (_, Some(refusal)) => Err(refusal.into()),
        }
    }

    /// The problem of built halves, and the errors of their mated pose.
    fn judged(mut self, connector: Connector, exec: &Exec) -> (Problem, Option<Diagnostics>) {
        exec.report(0.0, "contact");
        self.design = self.design.with_contents(&connector.contents);
        let pair = Pair::new(&connector, &self.design.alignment);
        let misdrawn = face::misdrawn(&connector, &self.design.connector);
        let problems = misdrawn.map_or_else(|| mated::problems_on(&pair, exec), |problem| vec![problem]);
        let (apart, unstable): (Vec<_>, Vec<_>) = problems.into_iter().partition(Self::is_apart);
        let refusal = apart.first().map(|first| {
            // Reported once: all problems concern the same pose.
            let advice = remedies::advice(&connector, &pair, &self.design, first);
            self.clone().unmated(&apart, advice)
        });
        (Problem::assembled(self, connector, pair, unstable), refusal)
    }

    /// Rejection for the mated pose; additional advice is attached to the first error.
    pub(super) fn unmated(self, problems: &[MatedProblem], mut advice: Option<String>) -> Diagnostics {
        let display = DisplayUnit::of(&self.design);
        let diagnostic = |problem: &MatedProblem| {
            let help: Vec<String> = problem.help(display).into_iter().chain(advice.take()).collect();
            let help = (!help.is_empty()).then(|| help.join("; "));
            self.diagnostic("mated-pose", defect_keys::of_mated(problem), problem.in_words(display), help)
        };
        let list = problems.iter().map(diagnostic).collect();
        Diagnostics { list, source: self.source, omitted: 0 }
    }
}
