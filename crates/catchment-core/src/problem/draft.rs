//! A design that was read but not built yet: it can still be changed, and it knows the places of its values
//! in the file.

use super::{Problem, ProblemError, defect_keys, measure, remedies};
use crate::connector::Connector;
use crate::contact::display_unit::DisplayUnit;
use crate::contact::mated::{self, MatedProblem};
use crate::contact::{Pair, face, settle};
use crate::design::{
    ConnectorSpec, Design, DesignDefect, Diagnostic, Diagnostics, FilesInMemory, SourceText, Sources, Width,
    load, read_as,
};
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
    /// A design without a text: what is wrong with it has no place.
    fn from(design: Design) -> Self {
        Self { design, source: None, places: Sources::default(), files: FilesInMemory::default() }
    }
}

impl Draft {
    /// Reads a design file.
    ///
    /// # Errors
    /// The file cannot be read, or everything that is wrong with what it says.
    pub fn open(path: &Path) -> Result<Self, ProblemError> {
        Self::open_on(path, &Exec::new())
    }

    /// The same, given up where a stop is asked for while a STEP file is meshed.
    ///
    /// # Errors
    /// As [`Draft::open`].
    pub fn open_on(path: &Path, exec: &Exec) -> Result<Self, ProblemError> {
        Self::read_on(SourceText::new(path, load(path)?), exec)
    }

    /// Reads the text of a design file; meshes are looked for beside `source.path`. Touches no file, unless the text leaves D out, which is
    /// then measured from the halves.
    ///
    /// # Errors
    /// Everything that is wrong with what the text says; where D is left out, with the geometry.
    pub fn read(source: SourceText) -> Result<Self, ProblemError> {
        Self::read_on(source, &Exec::new())
    }

    /// The same, given up where a stop is asked for while a STEP file is meshed.
    ///
    /// # Errors
    /// As [`Draft::read`].
    pub fn read_on(source: SourceText, exec: &Exec) -> Result<Self, ProblemError> {
        let (draft, is_measured) = Self::read_as(source, Width::Provisional(None))?;
        if is_measured { measure::measured(draft, exec) } else { Ok(draft) }
    }

    /// The text of a design without a D, which nobody asks for: lengths in its unit, what is round drawn roughly.
    pub fn read_roughly(source: SourceText) -> Result<Self, ProblemError> {
        Self::read_as(source, Width::Provisional(None)).map(|(draft, _)| draft)
    }

    /// The same with what is known of D; and whether that was needed.
    pub(super) fn read_as(source: SourceText, width: Width) -> Result<(Self, bool), ProblemError> {
        let folder = source.path.parent().unwrap_or_else(|| Path::new(""));
        match read_as(&source.text, folder, width) {
            Ok((file, is_used)) => {
                let files = source.files.clone();
                Ok((Self { design: file.design, places: file.sources, source: Some(source), files }, is_used))
            }
            Err(problems) => {
                let place = |problem: crate::design::LocatedDefect| Diagnostic {
                    message: problem.defect.to_string(),
                    help: problem.defect.help(),
                    span: Some(problem.span),
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

    /// This one with the files in memory of another.
    pub(super) fn beside(self, other: &Self) -> Self {
        Self { files: other.files.clone(), ..self }
    }

    /// The design with something changed. A refused change is reported beside the key that forbids it, with `what`, the
    /// name under which the change was asked for, before it.
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

    /// This design, refused for one thing about the key at `place` (such as `connector.fixed.pieces[2]`), or about what the
    /// file mentions around it.
    pub fn refused(self, place: &str, message: String, help: Option<String>) -> Diagnostics {
        let diagnostic = self.diagnostic(place, message, help);
        Diagnostics { source: self.source, list: vec![diagnostic], omitted: 0 }
    }

    fn diagnostic(&self, place: &str, message: String, help: Option<String>) -> Diagnostic {
        Diagnostic::new(message, help).at(self.places.span(place))
    }

    /// Loads the meshes, builds the halves and asks whether the mated pose holds.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry; halves that do not meet in the aligned pose. That the aligned pose
    /// meets but does not hold is a doubt ([`Problem::doubts`]).
    pub fn build(self) -> Result<Problem, ProblemError> {
        self.build_on(&Exec::new())
    }

    /// The same with its progress; where a stop is asked for while a STEP file is meshed, it is given up.
    ///
    /// # Errors
    /// As [`Draft::build`].
    pub fn build_on(self, exec: &Exec) -> Result<Problem, ProblemError> {
        match self.judged_on(exec)? {
            (problem, None) => Ok(problem),
            (_, Some(refusal)) => Err(refusal.into()),
        }
    }

    /// The same, with the problem also where it is refused for its mated pose alone: something to draw, and nothing to decide about.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry.
    pub fn judged_on(self, exec: &Exec) -> Result<(Problem, Option<Diagnostics>), ProblemError> {
        exec.report(0.0, "halves");
        match Connector::build_on(&self.design, &self.files, exec) {
            Ok(connector) => {
                let connector = match &self.design.connector {
                    ConnectorSpec::Own(own) => {
                        let found = face::found(connector, own);
                        match own.settle.then(|| settle::settled(found.clone(), &self.design.alignment)) {
                            None => found,
                            Some(Some(settled)) => settled,
                            Some(None) => return Ok(self.run_off(found)),
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

    /// What is wrong with the geometry, in its places.
    pub(super) fn unbuilt(self, problems: &[crate::connector::GeometryDefect]) -> Diagnostics {
        let list = defect_keys::of_geometry(problems, DisplayUnit::of(&self.design))
            .into_iter()
            .map(|(place, message, help)| self.diagnostic(&place, message, help))
            .collect();
        Diagnostics { source: self.source, list, omitted: 0 }
    }

    /// Whether there is no mated pose to decide about: the halves do not meet in it, or the seat leaves an error free.
    const fn is_apart(problem: &MatedProblem) -> bool {
        !matches!(problem, MatedProblem::NotMinimum { .. } | MatedProblem::LimitCutsPlay { .. })
    }

    /// The problem of halves that were built, unless their mated pose is none.
    pub(super) fn with_halves(self, connector: Connector, exec: &Exec) -> Result<Problem, ProblemError> {
        match self.judged(connector, exec) {
            (problem, None) => Ok(problem),
            (_, Some(refusal)) => Err(refusal.into()),
        }
    }

    /// The problem of halves that were built, and why their mated pose is none.
    fn judged(mut self, connector: Connector, exec: &Exec) -> (Problem, Option<Diagnostics>) {
        exec.report(0.0, "contact");
        self.design = self.design.with_contents(&connector.contents);
        let pair = Pair::new(&connector, &self.design.alignment);
        let misdrawn = face::misdrawn(&connector, &self.design.connector);
        let problems = misdrawn.map_or_else(|| mated::problems_on(&pair, exec), |problem| vec![problem]);
        let (apart, doubts): (Vec<_>, Vec<_>) = problems.into_iter().partition(Self::is_apart);
        let refusal = apart.first().map(|first| {
            // Said once: all are about one pose.
            let advice = remedies::advice(&connector, &pair, &self.design, first);
            self.clone().unmated(&apart, advice)
        });
        (Problem::assembled(self, connector, pair, doubts), refusal)
    }

    /// Refused for its mated pose; what helps beside what the problems say themselves stands with the first.
    pub(super) fn unmated(self, problems: &[MatedProblem], mut advice: Option<String>) -> Diagnostics {
        let told = DisplayUnit::of(&self.design);
        let diagnostic = |problem: &MatedProblem| {
            let help: Vec<String> = problem.help(told).into_iter().chain(advice.take()).collect();
            let help = (!help.is_empty()).then(|| help.join("; "));
            self.diagnostic(defect_keys::of_mated(problem), problem.told(told), help)
        };
        let list = problems.iter().map(diagnostic).collect();
        Diagnostics { list, source: self.source, omitted: 0 }
    }
}
