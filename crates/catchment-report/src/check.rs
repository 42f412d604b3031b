//! Result of checking a design file: the resolved design, or all its errors.

use super::document::{
    Printed, SINGLE_PRECISION, characteristic_length, error_box, pose_errors, seven_digits,
};
use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::connector::Origin;
use catchment_core::design::{
    ConnectorSpec, Design, DrawnFrames, FileSpec, HalfSpec, LengthUnit, OutlineSpec,
};
use catchment_core::design::{OwnSpec, PartSpec, ShapeSpec, SourceText, WidthFrom};
use catchment_core::diagnostic::{Diagnostic, Diagnostics};
use catchment_core::document::{
    Column, Document, Table, length as length_in, point_to_digits, rounded as shortened,
};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::problem::Problem;
use glam::{DAffine3, DVec3};
use serde::Serialize;
use std::borrow::Cow;

/// Result of a check, with its head.
pub type CheckReport = ReportEnvelope<CheckBody>;

/// Result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckBody {
    /// The design file.
    pub file: String,
    /// Whether the file has no errors.
    pub ok: bool,
    /// The design, resolved: lengths in D, angles in radians; null if the file has errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<Design>,
    /// Positions of the face centre and the centre of rotation in the coordinates in which each half is
    /// drawn; only for own halves without errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<DrawingReport>,
    /// Whether both halves have the same shape; null if the file has errors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ungendered: Option<bool>,
    /// The errors, in the order of their places.
    pub problems: Vec<LocatedDiagnostic>,
    /// Number of further errors that are not listed.
    pub omitted: usize,
}

/// Reference points of the results in the coordinates of the files.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DrawingReport {
    /// In the coordinates of the fixed half.
    pub fixed: DrawnReport,
    /// In the coordinates of the moving half.
    pub moving: DrawnReport,
    /// Distance along the approach between the halves as drawn, in D, if they were moved to first contact.
    pub apart: Option<f64>,
    /// Pose error of the rest that the halves reach when released as drawn, in D and radians, if it serves as
    /// the mated pose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settled: Option<PoseError>,
}

/// Reference points in the coordinates in which a half is drawn: those of its mesh file; for parts, the unit
/// of the design; for pieces and for triangles in memory, D.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DrawnReport {
    /// Unit of these coordinates, such as `mm` or `D`; `None` if the design has none.
    pub unit: Option<&'static str>,
    /// The face centre.
    pub face_center: [f64; 3],
    /// The centre of rotation, in the mated pose.
    pub center_of_rotation: [f64; 3],
    /// Unit vector of positive errors in x.
    pub x: [f64; 3],
    /// Unit vector of positive errors in y.
    pub y: [f64; 3],
}

/// Unit of the coordinates that a frame maps to D.
fn unit_of(frame: &DAffine3, design: &Design) -> Option<&'static str> {
    let in_d = frame.matrix3.determinant().abs().cbrt();
    let is_about = |a: f64, b: f64| (a / b - 1.0).abs() < UNIT_ACCURACY;
    if is_about(in_d, 1.0) {
        return Some("D");
    }
    let metres = in_d * design.width * design.unit?.metres();
    LengthUnit::ALL.into_iter().find(|unit| is_about(metres, unit.metres())).map(LengthUnit::symbol)
}

/// Relative accuracy at which a scale is that of a unit.
const UNIT_ACCURACY: f64 = 1e-6;

impl DrawingReport {
    fn of(origin: &Origin, design: &Design) -> Self {
        let center_of_rotation = design.alignment.center_of_rotation;
        let drawn = |frame: &DAffine3| {
            let back = frame.inverse();
            let place = |z: f64| back.transform_point3(DVec3::new(0.0, 0.0, z)).to_array();
            // No −0, and no 1e-17 beside a 1.
            let along =
                |axis| back.transform_vector3(axis).normalize_or_zero().map(|c| rounded(c) + 0.0).to_array();
            DrawnReport {
                unit: unit_of(frame, design),
                face_center: place(0.0),
                // In front of the moving face, which faces down.
                center_of_rotation: place(-center_of_rotation),
                x: along(DVec3::X),
                y: along(DVec3::Y),
            }
        };
        Self {
            fixed: drawn(&origin.fixed),
            moving: drawn(&origin.moving),
            apart: origin.apart,
            settled: origin.settled,
        }
    }
}

/// An error in a design file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LocatedDiagnostic {
    /// The error.
    #[serde(flatten)]
    pub diagnostic: Diagnostic,
    /// Its place, if it has a place in the file.
    pub place: Option<FileLocation>,
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FileLocation {
    /// Its line, from 1.
    pub line: usize,
    /// Its column in characters, from 1.
    pub column: usize,
    /// Byte range: first byte, and the byte after the last.
    pub bytes: [usize; 2],
}

impl ReportBody for CheckBody {
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
            drawing: matches!(design.connector, ConnectorSpec::Own(_))
                .then(|| DrawingReport::of(&problem.connector().origin, design)),
            ungendered: Some(problem.connector().ungendered(design.alignment.mount)),
            problems: Vec::new(),
            omitted: 0,
        };
        Self::of(body, Vec::new(), None)
    }

    /// Of everything that is wrong with a file.
    pub fn bad(diagnostics: &Diagnostics) -> Self {
        let source = diagnostics.source.as_ref();
        let problem = |diagnostic: &Diagnostic| LocatedDiagnostic {
            diagnostic: diagnostic.clone(),
            place: diagnostic.span.as_ref().zip(source).map(|(span, source)| {
                let (line, column) = source.line_column(span.start);
                FileLocation { line, column, bytes: [span.start, span.end] }
            }),
        };
        let body = CheckBody {
            file: shown(source),
            ok: false,
            design: None,
            drawing: None,
            ungendered: None,
            problems: diagnostics.list.iter().map(problem).collect(),
            omitted: diagnostics.omitted,
        };
        Self::of(body, Vec::new(), None)
    }
}

impl Printed for CheckBody {
    fn title(&self) -> Cow<'_, str> {
        (&self.file).into()
    }

    /// The design as it was understood, or the table of problems.
    fn document(&self) -> Document {
        let mut document = Document::default();
        if let Some(design) = &self.design {
            document.row("problems", "none");
            understood(&mut document, design, self.drawing.as_ref(), self.ungendered == Some(true));
        }
        document.section(None).table(self.table_of_problems());
        if self.omitted > 0 {
            document.paragraph(format!("and {} more", self.omitted));
        }
        document
    }
}

impl CheckBody {
    /// Shown if there are errors; for a design without errors programs read only the column names.
    fn table_of_problems(&self) -> Table {
        let column = |title: &str, key: &str| {
            if self.problems.is_empty() { Column::data(key) } else { Column::new(title).key(key).left() }
        };
        let mut table = Table::new([
            Column { left: false, ..column("line", "line") },
            Column { left: false, ..column("column", "column") },
            column("problem", "message"),
            column("advice", "help"),
        ]);
        for problem in &self.problems {
            table.push([
                problem.place.map(|place| place.line).into(),
                problem.place.map(|place| place.column).into(),
                problem.diagnostic.message.clone().into(),
                problem.diagnostic.help().into(),
            ]);
        }
        table
    }
}

/// The name of a file.
fn shown(source: Option<&SourceText>) -> String {
    source.map_or_else(String::new, |source| source.path.display().to_string())
}

fn understood(document: &mut Document, design: &Design, drawing: Option<&DrawingReport>, ungendered: bool) {
    let alignment = &design.alignment;
    let length = |d: f64| in_both_units(d, design);
    let mut row = |name: &str, value: &str| {
        document.row(name, value);
    };
    row("name", &design.name);
    match &design.connector {
        ConnectorSpec::Family(spec) => {
            row("connector", &format!("{}, H/D = {}", spec.family().name(), spec.aspect_ratio()));
        }
        ConnectorSpec::Own(own) => {
            for (name, spec) in [("fixed half", &own.fixed), ("moving half", &own.moving)] {
                row(name, &half(spec));
                if let Some(words) = spec.meshing_in_words(design) {
                    row("", &words);
                }
                if let Some(done) = spec.repairs_in_words(design) {
                    row("", &done);
                }
            }
            let round = [&own.fixed, &own.moving].into_iter().filter_map(chord_error).reduce(f64::max);
            if let Some(error) = round {
                row("round parts", &format!("made of facets, at most {} inside the surface", length(error)));
            }
        }
    }
    if let Some(drawing) = drawing {
        describe_drawing(document, design, drawing);
    }
    let mut row = |name: &str, value: &str| {
        document.row(name, value);
    };
    row(
        "halves",
        if ungendered { "of the same shape (ungendered)" } else { "of two different shapes (gendered)" },
    );
    let unit = design.unit.map_or("(dimensionless)", |unit| unit.symbol());
    let from = match &design.connector {
        ConnectorSpec::Own(OwnSpec { width_from: WidthFrom::Touching, .. }) => {
            ", the larger lateral extent of the facets that can touch"
        }
        ConnectorSpec::Own(OwnSpec { width_from: WidthFrom::Size, .. }) => {
            ", as small as the parts allow: the facets that can touch are smaller"
        }
        _ => "",
    };
    row("width D", &format!("{} {unit}{from}", seven_digits(design.width)));
    row("pose errors", &pose_errors(design));
    if !alignment.dont_care.is_empty() {
        row("ignored", &alignment.dont_care.to_string());
    }
    row(
        "COR",
        &format!(
            "centre of rotation: {} in front of the centre of the moving half's mating face, towards the fixed half",
            length(alignment.center_of_rotation)
        ),
    );
    row(
        "ρ",
        &characteristic_length(
            &length(alignment.rotation_length),
            alignment.free.iter().any(Dof::is_rotation),
        ),
    );
    if alignment.symmetry > 1 {
        row(
            "symmetry",
            &format!(
                "{}-fold: turned by a multiple of {}° about z the halves count as docked, too",
                alignment.symmetry,
                360.0 / f64::from(alignment.symmetry)
            ),
        );
    }
    row("error box", &error_box(design));
}

/// A length in D, and in the unit of the design if it has one.
fn in_both_units(d: f64, design: &Design) -> String {
    match design.unit {
        Some(unit) => format!("{} D = {} {}", shortened(d), seven_digits(d * design.width), unit.symbol()),
        None => format!("{d} D"),
    }
}

/// The reference points of the results in the drawings of the halves.
fn describe_drawing(document: &mut Document, design: &Design, drawing: &DrawingReport) {
    let length = |d: f64| in_both_units(d, design);
    let DrawingReport { fixed, moving, apart, settled } = drawing;
    let mut row = |name: &str, value: &str| {
        document.row(name, value);
    };
    let point = |half: &DrawnReport, p: [f64; 3]| {
        let [x, y, z] = point_to_digits(p, SINGLE_PRECISION);
        let unit = half.unit.map(|unit| format!(" {unit}")).unwrap_or_default();
        format!("({x}, {y}, {z}){unit}")
    };
    let mut places = |name: &str, what: &str, of: fn(&DrawnReport) -> [f64; 3]| {
        let [f, m] = [fixed, moving].map(|half| point(half, of(half)));
        row(name, &format!("{what}fixed half {f}, moving half {m}; they coincide when mated"));
    };
    places("face centre", "of the mating face: ", |half| half.face_center);
    places("COR, as drawn", "", |half| half.center_of_rotation);
    let along = format!("{} and {} of the fixed half's drawing", direction(fixed.x), direction(fixed.y));
    row("errors in x and y", &format!("along {along}"));
    let is_assembled =
        matches!(&design.connector, ConnectorSpec::Own(OwnSpec { drawn: DrawnFrames::Assembled { .. }, .. }));
    let moved = apart.filter(|apart| is_assembled && rounded(apart.abs()) > 0.0);
    if let Some(apart) = moved {
        let way = if apart > 0.0 { "apart" } else { "into each other" };
        row("drawn", &format!("{} {way}, moved to where they first touch", length(rounded(apart.abs()))));
    }
    if let Some(error) = settled {
        // Smaller deviations are within the accuracy of the rest.
        let counts = |(_, off): &(Dof, f64)| off.abs() > 1e-5;
        let amount = |(dof, off): (Dof, f64)| match design.unit {
            _ if dof.is_rotation() => format!("{} {:.3} deg", dof.name(), off.to_degrees()),
            Some(unit) => {
                let off = length_in(off * design.width, design.width);
                format!("{} {off} {}", dof.name(), unit.symbol())
            }
            None => format!("{} {off:.5} D", dof.name()),
        };
        let parts = Dof::ALL.into_iter().zip(error.to_array()).filter(counts);
        let parts: Vec<String> = parts.map(amount).collect();
        let off = if parts.is_empty() { "at rest as drawn".to_owned() } else { parts.join(", ") };
        row("settled", &format!("{off}, taken as the mated pose"));
    }
}

/// Name of a unit vector, if it has one.
fn direction(vector: [f64; 3]) -> String {
    let axis = ["x", "y", "z"].into_iter().zip(vector).find(|(_, c)| c.abs() == 1.0);
    if let Some((name, c)) = axis {
        return format!("{}{name}", if c > 0.0 { "+" } else { "-" });
    }
    let [x, y, z] = vector;
    format!("({x:.4}, {y:.4}, {z:.4})")
}

fn half(half: &HalfSpec) -> String {
    match half {
        HalfSpec::Pieces(pieces) if pieces.len() == 1 => "1 convex piece".to_owned(),
        HalfSpec::Pieces(pieces) => format!("{} convex pieces", pieces.len()),
        HalfSpec::Mesh(file) => mesh(file),
        HalfSpec::Parts(parts) => parts_of(parts),
        HalfSpec::Memory { content } => format!("{} triangles in memory", content.triangles),
    }
}

fn mesh(file: &FileSpec) -> String {
    let bodies = file.content.as_ref().map_or(1, |content| content.bodies);
    let united = if bodies > 1 { format!(", the union of {bodies} bodies") } else { String::new() };
    let body = file.treatment.body.map_or_else(String::new, |body| format!(", body {body}"));
    format!("mesh {}{body}{united}", catchment_core::terminal::shown(&file.path))
}

/// The parts of a half, with equal parts combined; and the accuracy of its round surfaces.
fn parts_of(parts: &[PartSpec]) -> String {
    let mut kinds: Vec<(String, usize)> = Vec::new();
    for part in parts {
        let kind = match &part.shape {
            ShapeSpec::Mesh(file) => mesh(file),
            ShapeSpec::Pieces(_) => "convex pieces".to_owned(),
            ShapeSpec::Sphere { .. } => "ball".to_owned(),
            ShapeSpec::Cone { radius, top_radius, .. } if radius == top_radius => "cylinder".to_owned(),
            ShapeSpec::Cone { .. } => "cone".to_owned(),
            ShapeSpec::Box { .. } => "box".to_owned(),
            ShapeSpec::Profile { outline: OutlineSpec::Corners(_), .. } => "profile".to_owned(),
            ShapeSpec::Profile { outline: OutlineSpec::File(file), .. } => {
                let left_out = match file.content.as_ref().map_or(0, |content| content.hidden) {
                    0 => String::new(),
                    1 => " (1 hidden entity left out)".to_owned(),
                    hidden => format!(" ({hidden} hidden entities left out)"),
                };
                format!("profile {}{left_out}", catchment_core::terminal::shown(&file.path))
            }
        };
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, count)) => *count += 1,
            None => kinds.push((kind, 1)),
        }
    }
    let words = |(kind, count): (String, usize)| if count == 1 { kind } else { format!("{count} × {kind}") };
    kinds.into_iter().map(words).collect::<Vec<_>>().join(", ")
}

/// Largest distance between round surfaces of a half and their facets, in D.
fn chord_error(half: &HalfSpec) -> Option<f64> {
    let HalfSpec::Parts(parts) = half else { return None };
    parts.iter().filter_map(|part| part.shape.chord_error()).reduce(f64::max)
}

/// Without the last digits, which the conversion of units leaves.
fn rounded(value: f64) -> f64 {
    const DIGITS: f64 = 1e9;
    (value * DIGITS).round() / DIGITS
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::problem::Draft;

    fn problem(name: &str, place: &str) -> Problem {
        let draft = Draft::read(SourceText::new(place, "[connector]\nfamily = \"pyramid\"\n")).unwrap();
        let named = draft.change("name", |design| Ok(Design { name: name.to_owned(), ..design }));
        named.and_then(Draft::build).unwrap()
    }

    #[test]
    fn names_in_a_check_are_harmless() {
        let text = CheckReport::good(&problem("evil\u{1b}[2J\nname", "a\u{7}.toml")).table();
        assert!(text.starts_with("a?.toml\n") && text.contains("  name           evil?[2J?name\n"), "{text}");
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'));
        assert!(text.contains("pitch, yaw ±90°\n"), "{text}");
    }

    #[test]
    fn problems_have_their_places() {
        let source = Some(SourceText::new("d.toml", "a = 1\nb = 2\nkey = 4\n"));
        let list = vec![
            Diagnostic::error("design", "no such key", None).at(Some(18..19)),
            Diagnostic::error("design", "empty", None),
        ];
        let report = CheckReport::bad(&Diagnostics { source, list, omitted: 2 });
        let text = report.table();
        assert!(text.contains("     3       7  no such key\n") && text.ends_with("  and 2 more\n"), "{text}");
        assert_eq!(report.records()[2], ["", "", "empty", ""]);
    }
}
