//! `[sweep]`: a shape and its motion, as a form.

use super::super::sum::SumError;
use super::super::sweep::{Bracket, Motion, SweptShape};
use super::{Measure, ParsedRegion};
use crate::form::{Form, FormTable};
use glam::DVec2;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Lengths of a shape, in mm.
const LENGTHS: RangeInclusive<f64> = 1e-3..=1e5;
/// Coordinates, in mm.
const PLACES: RangeInclusive<f64> = -1e5..=1e5;
/// Angles.
const ANGLES: RangeInclusive<f64> = -TAU..=TAU;
/// Factors of growth.
const FACTORS: RangeInclusive<f64> = 0.0..=100.0;
/// Default chord error, in mm: finer than the manufacturing of such parts.
const CHORD_ERROR: f64 = 0.01;

/// Most corners of a polygon in a form.
const MOST_CORNERS: usize = 1000;

/// The kinds of shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    AnnularSector,
    HalfEllipse,
    Disc,
    Box,
    Polygon,
}

const KINDS: [(&str, Kind); 5] = [
    ("annular-sector", Kind::AnnularSector),
    ("half-ellipse", Kind::HalfEllipse),
    ("disc", Kind::Disc),
    ("box", Kind::Box),
    ("polygon", Kind::Polygon),
];

/// A sweep as written.
#[derive(Debug, Clone)]
pub(super) struct Swept {
    name: String,
    shape: SweptShape,
    center: DVec2,
    motions: Vec<Motion>,
    chord_error: f64,
}

impl Swept {
    /// The swept region: by motions in sequence.
    pub(super) fn read(self) -> Result<ParsedRegion, SumError> {
        let mut region: Bracket = self.shape.bracket(self.center, self.chord_error);
        for motion in &self.motions {
            region = motion.sweep(&region, self.chord_error)?;
        }
        Ok(ParsedRegion { name: self.name, region, measure: Measure::Millimetres, notes: Vec::new() })
    }
}

/// Reads the file.
pub(super) fn fill(form: &mut Form<'_>, root: &FormTable<'_>, stem: &str) -> Swept {
    let name = form.word(root, "name").map_or_else(|| stem.to_owned(), |word| word.text.to_owned());
    if !root.has("sweep") && !form.is_refused() {
        form.refuse(
            root.span(),
            "the file has neither [sweep] nor [connector]",
            Some("a region is a [sweep], or the design of a connector"),
        );
    }
    let table = form.table(root, "sweep");
    let kind = form.choice(&table, "shape", &KINDS);
    if table.is_written() && !table.has("shape") {
        let help = format!("it can be {}", KINDS.map(|(name, _)| format!("\"{name}\"")).join(", "));
        form.refuse(table.span(), "`sweep.shape` is missing", Some(&help));
    }
    if form.is_refused() {
        // The remaining keys depend on the shape.
        return Swept {
            name,
            shape: SweptShape::Disc { radius: 1.0 },
            center: DVec2::ZERO,
            motions: Vec::new(),
            chord_error: 1.0,
        };
    }
    let shape = shape(form, &table, kind);
    let center = DVec2::new(
        form.length(&table, "center_x", PLACES, Some(0.0)),
        form.length(&table, "center_y", PLACES, Some(0.0)),
    );
    let chord_error = form.length(&table, "chord_error", 1e-5..=1e3, Some(CHORD_ERROR));
    let motions = motions(form, &table);
    form.close(&table);
    form.close(root);
    Swept { name, shape, center, motions, chord_error }
}

fn shape(form: &mut Form<'_>, table: &FormTable<'_>, kind: Kind) -> SweptShape {
    match kind {
        Kind::AnnularSector => {
            let inner = form.length(table, "inner_radius", 0.0..=1e5, Some(0.0));
            let outer = form.length(table, "outer_radius", LENGTHS, None);
            if inner >= outer && !form.is_refused() {
                form.refuse(
                    table.span_of("outer_radius"),
                    "`outer_radius` must be larger than `inner_radius`",
                    None,
                );
            }
            let [from, to] = angles(form, table);
            SweptShape::AnnularSector { inner, outer, from, to }
        }
        Kind::HalfEllipse => SweptShape::HalfEllipse {
            half_width: form.length(table, "half_width", LENGTHS, None),
            reach: form.length(table, "reach", LENGTHS, None),
        },
        Kind::Disc => SweptShape::Disc { radius: form.length(table, "radius", LENGTHS, None) },
        Kind::Box => SweptShape::Box {
            width: form.length(table, "width", LENGTHS, None),
            height: form.length(table, "height", LENGTHS, None),
        },
        Kind::Polygon => polygon(form, table),
    }
}

fn polygon(form: &mut Form<'_>, table: &FormTable<'_>) -> SweptShape {
    let lists = ["x", "y"].map(|key| {
        form.lengths(table, key).unwrap_or_else(|| {
            if !form.is_refused() {
                form.refuse(table.span(), format!("`sweep.{key}` is missing: an array of lengths"), None);
            }
            Vec::new()
        })
    });
    let [x, y] = &lists;
    if (x.len() != y.len() || x.len() < 3) && !form.is_refused() {
        let message = format!("the polygon has {} x and {} y", x.len(), y.len());
        form.refuse(table.span_of("y"), message, Some("it needs as many of each, at least three"));
    }
    if x.len() > MOST_CORNERS && !form.is_refused() {
        let message =
            format!("the polygon has {} corners, and more than {MOST_CORNERS} are too many", x.len());
        form.refuse(table.span_of("x"), message, Some("give it as a .csv"));
    }
    let corners: Vec<DVec2> = x.iter().zip(y).map(|((x, _), (y, _))| DVec2::new(*x, *y)).collect();
    let shape = SweptShape::Polygon(corners.clone());
    if !form.is_refused() {
        let n = corners.len();
        let cross = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let crossed = (0..n).any(|i| {
            (0..i).any(|j| {
                let (a, b, c, d) = (corners[i], corners[(i + 1) % n], corners[j], corners[(j + 1) % n]);
                cross(a, b, c) * cross(a, b, d) < 0.0 && cross(c, d, a) * cross(c, d, b) < 0.0
            })
        });
        if crossed {
            form.refuse(table.span_of("x"), "the polygon crosses itself", Some("list its corners in order"));
        } else if shape.bracket(DVec2::ZERO, CHORD_ERROR).inner.is_empty() {
            form.refuse(table.span_of("x"), "the polygon has no area", None);
        }
    }
    shape
}

/// `from` and `to`, at most a full turn apart.
fn angles(form: &mut Form<'_>, table: &FormTable<'_>) -> [f64; 2] {
    let from = form.angle(table, "from", ANGLES, None);
    let to = form.angle(table, "to", ANGLES, None);
    let sound = from < to && to - from <= TAU + 1e-9;
    if !sound && !form.is_refused() {
        form.refuse(table.span_of("to"), "`to` must be larger than `from`, by at most a full turn", None);
    }
    [from, to.min(from + TAU)]
}

fn motions(form: &mut Form<'_>, table: &FormTable<'_>) -> Vec<Motion> {
    let mut motions = Vec::new();
    let scale = form.table(table, "scale");
    if scale.is_written() {
        let about = point(form, &scale, ["about_x", "about_y"]);
        let from = form.number(&scale, "from", FACTORS, None);
        let to = form.number(&scale, "to", FACTORS, None);
        if from >= to && !form.is_refused() {
            form.refuse(scale.span_of("to"), "`to` must be larger than `from`", None);
        }
        form.close(&scale);
        motions.push(Motion::Scale { about, from, to });
    }
    let slide = form.table(table, "slide");
    if slide.is_written() {
        let by = point(form, &slide, ["x", "y"]);
        form.close(&slide);
        motions.push(Motion::Slide { by });
    }
    let turn = form.table(table, "turn");
    if turn.is_written() {
        let pivot = point(form, &turn, ["pivot_x", "pivot_y"]);
        let [from, to] = angles(form, &turn);
        form.close(&turn);
        motions.push(Motion::Turn { pivot, from, to });
    }
    motions
}

fn point(form: &mut Form<'_>, table: &FormTable<'_>, keys: [&'static str; 2]) -> DVec2 {
    let [x, y] = keys.map(|key| form.length(table, key, PLACES, Some(0.0)));
    DVec2::new(x, y)
}
