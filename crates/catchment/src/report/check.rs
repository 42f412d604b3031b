//! A design file that was checked: the design as it is understood, or everything that is wrong with it.

use super::envelope::{Body, Envelope};
use super::text::line;
use crate::design::{ConnectorSpec, Design, Finding, Findings, HalfSpec, SourceText};
use crate::pose::{Dof, DofSet};
use crate::problem::Problem;
use serde::Serialize;

/// What a check has to say, with its head.
pub type CheckReport = Envelope<CheckBody>;

/// What a check has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckBody {
    /// The file.
    pub file: String,
    /// Whether nothing is wrong with it.
    pub ok: bool,
    /// The design, resolved: lengths in D, angles in radians; only where nothing is wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<Design>,
    /// Whether both halves have the same shape; only where nothing is wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ungendered: Option<bool>,
    /// What is wrong, in the order of its places.
    pub problems: Vec<ProblemReport>,
    /// How many more problems there are.
    pub omitted: usize,
}

/// Something wrong with a design file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ProblemReport {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Where, if it has a place in the file.
    pub place: Option<Place>,
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Its line, from 1.
    pub line: usize,
    /// Its column in characters, from 1.
    pub column: usize,
    /// From its first byte to behind its last.
    pub bytes: [usize; 2],
}

impl Body for CheckBody {
    const KIND: &'static str = "check";
}

impl CheckReport {
    /// Of a problem with nothing wrong.
    pub fn good(problem: &Problem) -> Self {
        let design = problem.design();
        let body = CheckBody {
            file: shown(problem.source()),
            ok: true,
            design: Some(design.clone()),
            ungendered: Some(problem.connector().ungendered(design.alignment.mount)),
            problems: Vec::new(),
            omitted: 0,
        };
        Self::of(body, Vec::new(), None)
    }

    /// Of everything that is wrong with a file.
    pub fn bad(findings: &Findings) -> Self {
        let source = findings.source.as_ref();
        let problem = |finding: &Finding| ProblemReport {
            message: finding.message.clone(),
            help: finding.help.clone(),
            place: finding.span.as_ref().zip(source).map(|(span, source)| {
                let (line, column) = source.line_column(span.start);
                Place { line, column, bytes: [span.start, span.end] }
            }),
        };
        let body = CheckBody {
            file: shown(source),
            ok: false,
            design: None,
            ungendered: None,
            problems: findings.list.iter().map(problem).collect(),
            omitted: findings.omitted,
        };
        Self::of(body, Vec::new(), None)
    }

    /// The design as understood, degrees and lengths in its own unit beside D; or the problems, a line each.
    pub fn table(&self) -> String {
        let mut text = String::new();
        if let Some(design) = &self.design {
            line(&mut text, &format!("{}: no problems", self.file));
            understood(&mut text, design, self.ungendered == Some(true));
        }
        for problem in &self.problems {
            let place = problem.place.map_or_else(String::new, |p| format!("{}:{}:", p.line, p.column));
            line(&mut text, &format!("{}:{place} {}", self.file, problem.message));
        }
        if self.omitted > 0 {
            line(&mut text, &format!("and {} more", self.omitted));
        }
        text
    }
}

/// The name of a file.
fn shown(source: Option<&SourceText>) -> String {
    source.map_or_else(String::new, |source| source.path.display().to_string())
}

fn understood(text: &mut String, design: &Design, ungendered: bool) {
    let alignment = &design.alignment;
    let length = |d: f64| match design.unit {
        Some(unit) => format!("{d} D = {} {}", rounded(d * design.width), unit.symbol()),
        None => format!("{d} D"),
    };
    let mut row = |name: &str, value: &str| line(text, &format!("  {name:<20}{value}"));
    row("name", &design.name);
    match &design.connector {
        ConnectorSpec::Family(spec) => {
            row("connector", &format!("{}, H/D = {}", spec.family().name(), spec.aspect_ratio()));
        }
        ConnectorSpec::Own(own) => {
            row("fixed half", &half(&own.fixed));
            row("moving half", &half(&own.moving));
        }
    }
    row("halves", if ungendered { "alike (ungendered)" } else { "different" });
    let unit = design.unit.map_or("(dimensionless)", |unit| unit.symbol());
    row("width D", &format!("{} {unit}", design.width));
    row("free", &names(alignment.free));
    if !alignment.dont_care.is_empty() {
        row("does not matter", &names(alignment.dont_care));
    }
    row("centre of rotation", &length(alignment.center_of_rotation));
    row("rotation length", &length(alignment.rotation_length));
    if alignment.symmetry > 1 {
        row("symmetry", &format!("{}-fold", alignment.symmetry));
    }
    for dof in alignment.free.iter() {
        let half_range = alignment.half_range(dof);
        let range = if dof.is_rotation() {
            format!("{} deg", rounded(half_range.to_degrees()))
        } else {
            length(half_range)
        };
        row(&format!("error in {}", dof.name()), &format!("up to {range}"));
    }
}

fn half(half: &HalfSpec) -> String {
    match half {
        HalfSpec::Pieces(pieces) if pieces.len() == 1 => "1 convex piece".to_owned(),
        HalfSpec::Pieces(pieces) => format!("{} convex pieces", pieces.len()),
        HalfSpec::Mesh { path, .. } => format!("mesh {}", path.display()),
        HalfSpec::Memory { content } => format!("{} triangles in memory", content.triangles),
    }
}

fn names(set: DofSet) -> String {
    set.iter().map(Dof::name).collect::<Vec<_>>().join(", ")
}

/// Without the last digits, which the conversion of units leaves.
fn rounded(value: f64) -> f64 {
    const DIGITS: f64 = 1e9;
    (value * DIGITS).round() / DIGITS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Draft;

    fn problem(name: &str, place: &str) -> Problem {
        let draft = Draft::read(SourceText::new(place, "[connector]\nfamily = \"pyramid\"\n")).unwrap();
        let named = draft.change("name", |design| Ok(Design { name: name.to_owned(), ..design }));
        named.and_then(Draft::build).unwrap()
    }

    #[test]
    fn names_in_a_check_are_harmless() {
        let text = CheckReport::good(&problem("evil\u{1b}[2J\nname", "a\u{7}.toml")).table();
        assert!(text.starts_with("a?.toml: no problems\n  name                evil?[2J?name\n"), "{text}");
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'));
        assert!(text.contains("  error in pitch      up to 90 deg\n"), "{text}");
    }

    #[test]
    fn problems_are_told_with_their_places() {
        let source = Some(SourceText::new("d.toml", "a = 1\nb = 2\nkey = 4\n"));
        let list = vec![Finding::new("no such key", None).at(Some(18..19)), Finding::new("empty", None)];
        let report = CheckReport::bad(&Findings { source, list, omitted: 2 });
        assert_eq!(report.table(), "d.toml:3:7: no such key\nd.toml: empty\nand 2 more\n");
    }
}
