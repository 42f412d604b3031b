//! The tolerance window and the single-axis limits of a run, a row per error.

use crate::document::{Style, lines};
use crate::schema::RunBody;
use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, DesignUnits, Document, Table, decimals, grouped};
use catchment_core::merit::centered::CenteredBox;
use catchment_core::merit::tolerance::Tolerance;
use catchment_core::pose::DofSet;
use catchment_core::run::Upright;

/// Limits this near to the end of the error box, as a share of its range, are shown as open.
const AT_BORDER: f64 = 1e-3;

impl RunBody {
    /// The tolerance window, and the limit of each error alone.
    pub(super) fn describe_limits(&self, document: &mut Document) {
        const OUTCOMES: &str = "jammed: at rest elsewhere; missed: no contact, or slid off";
        let centered = self.centered.as_ref();
        document.section(None);
        if self.tolerances.is_empty() && centered.is_none() {
            document.paragraph(OUTCOMES);
            return;
        }
        let mut is_open = limits(document, &self.design, centered, &self.tolerances);
        if let Some(found) = &self.upright {
            document.paragraph("the same with roll and pitch locked at 0");
            is_open |= limits(document, &self.design, Some(&found.window), &found.tolerances);
        }
        document.section(None).paragraph(OUTCOMES);
        match centered {
            Some(found) if found.followed => {
                let all = found.sampled.map_or_else(
                    || "every pose sampled inside it docks".to_owned(),
                    |poses| format!("all of {} poses sampled inside it dock", grouped(poses)),
                );
                let limits = if found.limited_by.is_empty() {
                    ""
                } else {
                    "; limited by: with any of these slightly larger and the others inside the window, poses fail"
                };
                document.paragraph(format!(
                    "tolerance window: all errors at once; the error box shrunk in proportion until {all}{limits}"
                ));
            }
            Some(_) => {
                document.paragraph(
                    "tolerance window: all errors at once; the error box shrunk in proportion until all its cells dock",
                );
            }
            None => {}
        }
        if self.tolerances.iter().all(|t| t.followed) {
            document.paragraph("single-axis limit: this error, all others zero");
        } else if self.certificate.is_some() {
            document.paragraph(
                "single-axis limit: this error, all others zero; at least, by cells that certainly dock",
            );
        } else {
            let half = |t: &Tolerance| {
                if t.axis.is_rotation() {
                    format!("{} {:.2}°", t.axis.name(), t.half_cell.to_degrees())
                } else {
                    format!("{} {:.4} D", t.axis.name(), t.half_cell)
                }
            };
            let half: Vec<String> = self.tolerances.iter().map(half).collect();
            document.paragraph(format!(
                "single-axis limit: this error, all others zero; ± half a cell: {}",
                half.join(", ")
            ));
        }
        if is_open {
            document.paragraph("* the error box ends here: the limit may be larger");
        }
    }
}

/// Early results of a long run: the tolerances with roll and pitch locked, as lines.
pub fn first_look(design: &Design, found: &Upright) -> Vec<String> {
    let Upright { window, tolerances } = found;
    let mut document = Document::default();
    document.section("first look, with roll and pitch locked:");
    limits(&mut document, design, Some(window), tolerances);
    lines(&document, Style::default())
}

/// A row per error; whether the error box ends any of them.
fn limits(
    document: &mut Document,
    design: &Design,
    window: Option<&CenteredBox>,
    limits: &[Tolerance],
) -> bool {
    let mut table = Table::new([
        Column::new("error").key("axis").left(),
        Column::new("tolerance window").key("half_width"),
        Column::new("single-axis limit"),
        Column::data("minus"),
        Column::data("plus"),
    ]);
    let mut is_open = false;
    for axis in design.alignment.free.iter() {
        let side = window.and_then(|found| found.bounds.iter().find(|side| side.axis == axis));
        let limit = limits.iter().find(|limit| limit.axis == axis).map(|limit| at_border(limit, design));
        let limit = limit.as_ref();
        if side.is_none() && limit.is_none() {
            continue;
        }
        let box_ends = window.is_some_and(|found| found.reaches_border);
        is_open |=
            box_ends || limit.is_some_and(|limit| limit.minus_reaches_border || limit.plus_reaches_border);
        let star = if box_ends { "*" } else { "" };
        let half_width = side.map(|side| {
            Cell::shown(format!("{}{star}", DesignUnits::of(design).half_width(axis, side.hi)), side.hi)
        });
        let shown = |words: fn(&Tolerance, &Design) -> String| limit.map(|limit| words(limit, design));
        table.push([
            axis.name().into(),
            half_width.unwrap_or_default(),
            shown(in_own_unit).into(),
            limit.map(|limit| limit.minus).into(),
            limit.map(|limit| limit.plus).into(),
        ]);
    }
    document.table(table);
    if let Some(found) = window.filter(|found| !found.limited_by.is_empty()) {
        document.row("limited by", found.limited_by.iter().copied().collect::<DofSet>().to_string());
    }
    is_open
}

/// A limit that ends within its last bisection of the error box ends at the box.
fn at_border(limit: &Tolerance, design: &Design) -> Tolerance {
    let end = (1.0 - AT_BORDER) * design.alignment.half_range(limit.axis);
    let mut limit = *limit;
    limit.minus_reaches_border |= limit.minus >= end;
    limit.plus_reaches_border |= limit.plus >= end;
    limit
}

/// A limit in the unit of the design, or in D; angles in degrees.
fn in_own_unit(limit: &Tolerance, design: &Design) -> String {
    if limit.axis.is_rotation() {
        return both(limit, 1f64.to_degrees(), 2, "°");
    }
    let (scale, digits, unit) =
        design.unit.map_or((1.0, 4, "D"), |unit| (design.width, decimals(design.width), unit.symbol()));
    let words = both(limit, scale, digits, "");
    // The star of a single number stands behind its unit.
    match words.strip_suffix('*').filter(|words| words.starts_with('±')) {
        Some(number) => format!("{number} {unit}*"),
        None => format!("{words} {unit}"),
    }
}

/// `±0.5` if both sides agree, `−0.5 / +0.3` if not; with a star at the border of the error box.
fn both(t: &Tolerance, scale: f64, digits: usize, unit: &str) -> String {
    let side = |value: f64, is_open: bool| {
        format!("{:.digits$}{unit}{}", value * scale, if is_open { "*" } else { "" })
    };
    let (minus, plus) = (side(t.minus, t.minus_reaches_border), side(t.plus, t.plus_reaches_border));
    if minus == plus { format!("±{plus}") } else { format!("−{minus} / +{plus}") }
}
