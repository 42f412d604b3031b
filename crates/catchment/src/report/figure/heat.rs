//! Tables of numbers as maps: every cell in the colour of its number, with the number in it.

use super::axis::short;
use super::colour::{Rgb, hex, mix, sequential};
use super::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, TITLE};
use super::{FigureError, Picture};
use crate::report::{Agreement, AgreementReport};
use crate::study::reproduce::{Entry, TableComparison};

/// The colour of a number.
type Colouring<'a> = &'a dyn Fn(f64) -> Rgb;

/// A table to draw.
struct Panel<'a> {
    title: &'a str,
    rows: &'a [String],
    columns: &'a [String],
    /// Row by row; NaN leaves a cell empty.
    values: Vec<Vec<f64>>,
    write: fn(f64) -> String,
    colour: Colouring<'a>,
}

/// Room for the names of rows, above a panel, and between panels.
const NAMES: f64 = 82.0;
const HEAD: f64 = 46.0;
const GAP: f64 = 30.0;

impl Panel<'_> {
    /// Draws it with its cells beginning at a place; `cell` is their size.
    fn draw(&self, svg: &mut Svg, [x, y]: [f64; 2], [w, h]: [f64; 2]) {
        svg.text([x, y - 26.0], LABEL, Anchor::Start, INK, self.title);
        for (k, name) in self.columns.iter().enumerate() {
            svg.text([x + (k as f64 + 0.5) * w, y - 7.0], TICK, Anchor::Middle, SOFT, name);
        }
        for (j, (name, row)) in self.rows.iter().zip(&self.values).enumerate() {
            let top = y + j as f64 * h;
            svg.text([x - 8.0, top + 0.5 * h + 3.8], TICK, Anchor::End, SOFT, name);
            for (k, value) in row.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                let fill = (self.colour)(*value);
                let rect = Rect { x: x + k as f64 * w, y: top, w, h };
                svg.rect(rect, &format!(r##"fill="{}" stroke="#ffffff" stroke-width="1""##, hex(fill)));
                let ink = if is_dark(fill) { "#ffffff" } else { INK };
                let place = [rect.x + 0.5 * w, rect.y + 0.5 * h + 3.6];
                svg.text(place, TICK - 1.0, Anchor::Middle, ink, &(self.write)(*value));
            }
        }
    }
}

/// Whether white reads better on a colour than ink (relative luminance, Rec. 709).
fn is_dark([r, g, b]: Rgb) -> bool {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b) < 130.0
}

/// Draws how each two methods of a design agree: left the share of cells, right the overlap of the accepted sets.
pub fn agreement(report: &AgreementReport) -> Picture {
    let names: Vec<String> = report.results().map(|(name, _)| name.to_owned()).collect();
    let values = |of: fn(&Agreement) -> f64| -> Vec<Vec<f64>> {
        report.agreement.iter().map(|row| row.iter().map(of).collect()).collect()
    };
    // From orange, where they disagree on much, to white: agreement of half the cells is no better than chance.
    let colour =
        |share: f64| mix([0xd5, 0x5e, 0x00], [0xf2, 0xf6, 0xfa], ((share - 0.5) / 0.5).clamp(0.0, 1.0));
    let cell = [76.0, 40.0];
    let side = [names.len() as f64 * cell[0], names.len() as f64 * cell[1]];
    let (left, top) = (24.0 + NAMES, 70.0 + HEAD);
    let right = left + side[0] + GAP + NAMES;
    let mut svg = Svg::new((right + side[0] + 24.0).max(560.0), top + side[1] + 28.0);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &report.design.name);
    let cells: Vec<String> = report.cells.iter().map(ToString::to_string).collect();
    let story = format!("every method that applies, on {} cells", cells.join(" × "));
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &story);
    let shares = values(|a| a.agreement);
    let overlaps = values(|a| a.jaccard);
    for (x, title, values) in [
        (left, "share of the cells that both accept or both reject", shares),
        (right, "Jaccard: accepted by both, of all that one accepts", overlaps),
    ] {
        let write = |value: f64| format!("{value:.4}");
        let panel = Panel { title, rows: &names, columns: &names, values, write, colour: &colour };
        panel.draw(&mut svg, [x, top], cell);
    }
    Picture { svg: svg.finish() }
}

/// Draws a published table, ours, and the ratio of the two: the first two in the same colours.
///
/// # Errors
/// If there is no entry.
pub fn published(table: &TableComparison) -> Result<Picture, FigureError> {
    let values = |of: &dyn Fn(&Entry) -> Option<f64>| -> Vec<Vec<f64>> {
        let value = |entry: &Entry| of(entry).unwrap_or(f64::NAN);
        table.entries.iter().map(|row| row.iter().map(value).collect()).collect()
    };
    let (printed, ours) = (values(&|e| Some(e.published)), values(&|e| e.ours));
    let exact = values(&|e| e.exact.map(|exact| exact.value));
    let all = || printed.iter().chain(&ours).chain(&exact).flatten().copied().filter(|v| v.is_finite());
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return Err(FigureError::Empty { what: "the table has no entry" });
    }
    let colour = |value: f64| sequential((value - low) / (high - low).max(f64::MIN_POSITIVE));
    // White where they agree, blue below, orange above; a factor of two is full colour.
    let beside = |ratio: f64| {
        let share = (ratio.max(1e-9).ln() / 2f64.ln()).clamp(-1.0, 1.0);
        let end = if share < 0.0 { [0x00, 0x72, 0xb2] } else { [0xd5, 0x5e, 0x00] };
        mix([0xf7, 0xf7, 0xf7], end, share.abs())
    };
    let ratio = |of: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let divided = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a / b).collect();
        of.iter().zip(&printed).map(divided).collect()
    };
    let (rows, columns) = (&table.rows[..], &table.columns[..]);
    let write: fn(f64) -> String = short;
    let panel = |title, values, colour| Panel { title, rows, columns, values, write, colour };
    let mut panels = vec![panel("published", printed.clone(), &colour as Colouring)];
    for (name, of, name_of_ratio) in
        [(table.method, &ours, "by the same method / published"), ("exact", &exact, "exact / published")]
    {
        if of.iter().flatten().any(|value| value.is_finite()) {
            panels.push(panel(name, of.clone(), &colour));
            panels.push(panel(name_of_ratio, ratio(of), &beside));
        }
    }
    let cell = [if columns.len() > 8 { 40.0 } else { 56.0 }, 26.0];
    let side = [columns.len() as f64 * cell[0], rows.len() as f64 * cell[1]];
    let (left, top) = (24.0 + NAMES, 92.0 + HEAD);
    let step = side[0] + GAP + NAMES;
    let width = left + panels.len() as f64 * step - GAP - NAMES + 24.0;
    let mut svg = Svg::new(width.max(640.0), top + side[1] + 28.0);
    svg.bold([24.0, 30.0], TITLE, Anchor::Start, &format!("Table {}: {}", table.table, table.title));
    let axes = format!("rows: {}  ·  columns: {}", table.row_name, table.column_name);
    svg.text([24.0, 50.0], LABEL, Anchor::Start, SOFT, &axes);
    svg.text([24.0, 68.0], LABEL, Anchor::Start, SOFT, &format!("values in {}", table.unit));
    for (k, panel) in panels.iter().enumerate() {
        panel.draw(&mut svg, [left + k as f64 * step, top], cell);
    }
    Ok(Picture { svg: svg.finish() })
}
