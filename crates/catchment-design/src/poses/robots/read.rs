//! The parser of a file of robots.

use super::super::covariance::IDENTITY;
use super::super::distribution::size;
use super::super::written::in_range;
use super::super::{FAMILY, OffsetsAt, PoseTable, defect, shortened};
use super::{Robot, Spread};
use crate::design::{Design, Quantity, SourceText, nearest};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::{Dof, PoseError};
use catchment_base::suggest::value_help;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Most robots of a file: each takes seconds.
pub const MOST_ROBOTS: usize = 100;
/// Longest name of a robot, in characters.
const LONGEST_NAME: usize = 80;
/// Smallest number of rows of a table of measured errors: a single row does not define a spread.
const FEWEST_ROWS: usize = 2;
/// The keys for the spread of errors.
const KINDS: [&str; 4] = ["sigma", "covariance", "uniform", "measured"];
const KEYS: [&str; 7] = ["name", "sigma", "correlation", "covariance", "uniform", "measured", "mean"];

/// Reads a file of robots for a design. `table` returns the text of a table of measured errors for the path
/// in the file.
///
/// # Errors
/// All errors of the file, each with its place; if it has no errors, all errors of the first table.
pub fn read_robots(
    source: &SourceText,
    design: &Design,
    table: &mut dyn FnMut(&str) -> Result<SourceText, String>,
) -> Result<Vec<Robot>, Diagnostics> {
    let (document, syntax) = DeTable::parse_recoverable(&source.text);
    let mut reader = Reader {
        diagnostics: DiagnosticCollector::default(),
        broken: Vec::new(),
        foreign: None,
        design,
        table,
    };
    for error in syntax {
        let span = error.span().unwrap_or(0..0);
        let help = value_help(&source.text, span.start);
        reader
            .diagnostics
            .push_at(Diagnostic::error(FAMILY, error.message().to_owned(), help), || Some(span.clone()));
        reader.broken.push(span);
    }
    let robots = reader.robots(document.get_ref());
    let Reader { diagnostics, foreign, .. } = reader;
    diagnostics.refuse().map_err(|diagnostics| diagnostics.of(source.clone()))?;
    foreign.map_or(Ok(robots), Err)
}

/// A value with its place.
pub(super) type Value<'t> = Spanned<DeValue<'t>>;

/// The result so far.
pub(super) struct Reader<'a> {
    diagnostics: DiagnosticCollector,
    /// Ranges in which the text is not TOML: errors there are consequences.
    broken: Vec<Range<usize>>,
    /// The errors of a table.
    foreign: Option<Diagnostics>,
    pub(super) design: &'a Design,
    table: &'a mut dyn FnMut(&str) -> Result<SourceText, String>,
}

impl Reader<'_> {
    pub(super) fn note(&mut self, span: Range<usize>, fault: Diagnostic) {
        if !self.broken.iter().any(|b| b.start <= span.end && span.start <= b.end) {
            self.diagnostics.push_at(fault, || Some(span).filter(|span| !span.is_empty()));
        }
    }

    pub(super) fn refuse(&mut self, span: Range<usize>, message: impl Into<String>, help: &str) {
        self.note(span, defect(message, help));
    }

    fn robots(&mut self, root: &DeTable<'_>) -> Vec<Robot> {
        const HELP: &str = "begin each robot with [[robot]]";
        self.unknown(root, &["robot"], "the file");
        let Some(list) = root.get("robot") else {
            if self.broken.is_empty() {
                self.refuse(0..0, "the file names no robot", HELP);
            }
            return Vec::new();
        };
        let DeValue::Array(list_of) = list.get_ref() else {
            self.refuse(list.span(), "`robot` is no list of tables", HELP);
            return Vec::new();
        };
        if list_of.is_empty() {
            self.refuse(list.span(), "the file names no robot", HELP);
        }
        if list_of.len() > MOST_ROBOTS {
            let message = format!("{} robots, and more than {MOST_ROBOTS} are too many", list_of.len());
            self.refuse(list.span(), message, "divide the file");
            return Vec::new();
        }
        let mut robots: Vec<Robot> = Vec::new();
        for (number, entry) in list_of.iter().enumerate() {
            let DeValue::Table(table) = entry.get_ref() else {
                self.refuse(entry.span(), "a robot is a table", HELP);
                continue;
            };
            let name = self.name(table, number, &robots);
            if let Some(errors) = self.spread(table, entry.span()) {
                robots.push(Robot { name, errors });
            }
        }
        robots
    }

    fn name(&mut self, table: &DeTable<'_>, number: usize, before: &[Robot]) -> String {
        let default = format!("robot {}", number + 1);
        let Some(value) = table.get("name") else { return default };
        let DeValue::String(name) = value.get_ref() else {
            self.refuse(value.span(), "`name` is no text", "name = \"arm A\"");
            return default;
        };
        if name.trim().is_empty() || name.chars().count() > LONGEST_NAME {
            let message = format!("a name has 1 to {LONGEST_NAME} characters");
            self.refuse(value.span(), message, "shorten it, or leave it out");
        }
        if before.iter().any(|robot| robot.name == **name) {
            let message = format!("a second robot is called `{}`", shortened(name));
            self.refuse(value.span(), message, "each needs a name of its own");
        }
        name.to_string()
    }

    fn spread(&mut self, table: &DeTable<'_>, span: Range<usize>) -> Option<Spread> {
        self.unknown(table, &KEYS, "[[robot]]");
        let written: Vec<&str> = KINDS.into_iter().filter(|kind| table.contains_key(*kind)).collect();
        let [kind] = written[..] else {
            let message = match written.len() {
                0 => "it does not say how its errors spread".to_owned(),
                _ => format!("its errors spread in {} ways: {}", written.len(), written.join(", ")),
            };
            if self.broken.is_empty() {
                self.refuse(span, message, "give one of sigma, covariance, uniform, measured");
            }
            return None;
        };
        let mean = self.mean(table, kind);
        if let Some(correlation) = table.get("correlation").filter(|_| kind != "sigma") {
            self.refuse(correlation.span(), format!("correlations beside {kind}"), "they belong to sigma");
        }
        let value = table.get(kind)?;
        match kind {
            "sigma" => {
                let sigma = self.sizes(value, "sigma")?;
                let correlation = match table.get("correlation") {
                    Some(value) => self.correlation(value, &sigma)?,
                    None => IDENTITY,
                };
                Some(Spread::Normal { mean: mean?, sigma: PoseError::from_array(sigma), correlation })
            }
            "uniform" => {
                let half_width = PoseError::from_array(self.sizes(value, "uniform")?);
                Some(Spread::Uniform { mean: mean?, half_width })
            }
            "covariance" => {
                let (sigma, correlation) = self.covariance(value)?;
                Some(Spread::Normal { mean: mean?, sigma, correlation })
            }
            _ => self.measured(value),
        }
    }

    /// Every error that a table names, by `read`.
    fn errors(
        &mut self,
        value: &Value<'_>,
        key: &str,
        read: impl Fn(Dof, Quantity, &Design) -> Result<f64, Diagnostic>,
    ) -> Option<[f64; 5]> {
        let DeValue::Table(table) = value.get_ref() else {
            let help = format!("{key} = {{ x = \"1 mm\", yaw = \"2 deg\" }}");
            self.refuse(value.span(), format!("`{key}` is no table"), &help);
            return None;
        };
        let mut values = [0.0; 5];
        let mut sound = true;
        for (name, value) in table {
            let read = match self.dof(name.get_ref(), name.span()) {
                Some(dof) => self.quantity(value).and_then(|quantity| {
                    read(dof, quantity, self.design)
                        .map(|value| (dof, value))
                        .map_err(|fault| self.note(value.span(), fault))
                        .ok()
                }),
                None => None,
            };
            match read {
                Some((dof, value)) => values[dof.index()] = value,
                None => sound = false,
            }
        }
        sound.then_some(values)
    }

    fn sizes(&mut self, value: &Value<'_>, key: &str) -> Option<[f64; 5]> {
        let values = self.errors(value, key, |dof, quantity, design| {
            in_range(dof, quantity, design)?;
            size(dof, quantity, design)
        })?;
        if values.iter().all(|value| *value == 0.0) {
            self.refuse(value.span(), "no error occurs", "name at least one that is not 0");
            return None;
        }
        Some(values)
    }

    fn mean(&mut self, table: &DeTable<'_>, kind: &str) -> Option<PoseError> {
        let Some(value) = table.get("mean") else { return Some(PoseError::default()) };
        if kind == "measured" {
            self.refuse(
                value.span(),
                "a mean beside measured errors",
                "leave it out: the table has its own mean",
            );
            return None;
        }
        let mean = self.errors(value, "mean", |dof, quantity, design| {
            size(dof, Quantity { value: quantity.value.abs(), ..quantity }, design)?;
            in_range(dof, quantity, design)
        })?;
        Some(PoseError::from_array(mean))
    }

    pub(super) fn dof(&mut self, name: &str, span: Range<usize>) -> Option<Dof> {
        let read = name.parse::<Dof>();
        read.map_err(|unknown| self.note(span, Diagnostic::error(FAMILY, unknown.to_string(), None))).ok()
    }

    fn quantity(&mut self, value: &Value<'_>) -> Option<Quantity> {
        let text: &str = match value.get_ref() {
            DeValue::String(text) => text,
            DeValue::Integer(integer) => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            _ => {
                self.refuse(value.span(), "it is no number", "such as 0.1 or \"2 mm\"");
                return None;
            }
        };
        // TOML lets digits be grouped.
        let read = text.replace('_', "").parse::<Quantity>();
        read.map_err(|c| self.note(value.span(), Diagnostic::error(FAMILY, c.to_string(), c.help()))).ok()
    }

    fn measured(&mut self, value: &Value<'_>) -> Option<Spread> {
        let DeValue::String(path) = value.get_ref() else {
            self.refuse(value.span(), "`measured` is no path", "measured = \"errors.csv\"");
            return None;
        };
        let source = match (self.table)(path) {
            Ok(source) => source,
            Err(message) => {
                self.refuse(value.span(), message, "a path is taken from the folder of this file");
                return None;
            }
        };
        match measured(source, self.design) {
            Ok(spread) => Some(spread),
            Err(diagnostics) => {
                self.foreign.get_or_insert(diagnostics);
                None
            }
        }
    }

    pub(super) fn unknown(&mut self, table: &DeTable<'_>, known: &[&str], place: &str) {
        for (name, _) in table {
            let written: &str = name.get_ref();
            if known.contains(&written) {
                continue;
            }
            let help = match nearest(written, known.iter().copied()) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("it has {}", known.join(", ")),
            };
            self.refuse(name.span(), format!("unknown key `{}` in {place}", shortened(written)), &help);
        }
    }
}

/// Errors as a table has them.
///
/// # Errors
/// Everything that is wrong with the table, or that it is too short.
pub(super) fn measured(source: SourceText, design: &Design) -> Result<Spread, Diagnostics> {
    let read = PoseTable::parse(&source.text, design, OffsetsAt::Face);
    let poses = read.map(|table| table.errors().to_vec()).and_then(|poses| {
        let mut diagnostics = DiagnosticCollector::default();
        if poses.len() < FEWEST_ROWS {
            let fault = defect(
                format!("{} row says nothing of how errors spread", poses.len()),
                "measure more of them",
            );
            diagnostics.push(fault);
        } else if poses.iter().all(|pose| *pose == PoseError::default()) {
            diagnostics.push(defect("every error of the table is 0", "is it the right table?"));
        }
        diagnostics.refuse()?;
        Ok(poses)
    });
    match poses {
        Ok(poses) => Ok(Spread::Measured { source: source.path.display().to_string(), poses }),
        Err(diagnostics) => Err(diagnostics.of(source)),
    }
}
