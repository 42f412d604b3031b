//! A sweep: the Sum of every design in colours, and the accepted set of each near zero.
//!
//! ```text
//!            cor -1    0    1                      cor -1     0      1
//!   AR 0.5   ┌─────┬─────┬─────┐          AR 0.5   ┌─────┐┌─────┐┌─────┐
//!            │ 1.2 │ 1.7 │ 2.1▲│                   │ ▒▒  ││ ▒▒▒ ││▒▒▒▒▒│     slices through zero, at the same scale
//!   AR 1     ├─────┼─────┼─────┤                   └─────┘└─────┘└─────┘
//!            │ 0.9▼│ 1.6 │ 2.0 │
//!            └─────┴─────┴─────┘
//! ```
//!
//! Rows are the first axis, columns the second; further axes are maps side by side, or further rows.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::layout::{Layout, Legend, Panel};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, width_of};
use super::map::{self, Map};
use super::number_map::{Colouring, Digits, NumberMap, number_maps};
use super::{FigureError, Picture};
use crate::SweepReport;
use catchment_core::acceptance::Outcome;
use catchment_core::document::significant;
use catchment_core::landscape::GridAxis;
use catchment_core::merit::slice::GridSlice;
use catchment_study::sweep::{Outline, SweepAxis};

/// Cells of a heat map.
const CELL: [f64; 2] = [62.0, 40.0];
/// Maps that stand side by side at most; a sweep with more is for programs.
const MOST_MAPS: usize = 12;
/// Room for the numbers beside outlines, and below them.
const TICKS: f64 = 44.0;
const BELOW: f64 = 18.0;
/// Outlines that are drawn at most.
const MOST_OUTLINES: usize = 400;

/// The axes of a sweep as rows and columns: the last axis gives columns, the others together rows.
fn table(axes: &[SweepAxis]) -> (Vec<String>, Vec<String>) {
    let named = |axis: &SweepAxis, value: &str| format!("{} {value}", short_name(axis));
    let (columns, others) = match axes {
        [] => return (Vec::new(), Vec::new()),
        [rows] => (vec![String::new()], std::slice::from_ref(rows)),
        [others @ .., columns] => {
            (columns.values.iter().map(|value| named(columns, value)).collect(), others)
        }
    };
    let rows = others.iter().fold(vec![String::new()], |rows, axis| {
        let longer = |row: &String, value: &String| {
            let between = if row.is_empty() { "" } else { ", " };
            format!("{row}{between}{}", named(axis, value))
        };
        rows.iter().flat_map(|row| axis.values.iter().map(move |value| longer(row, value))).collect()
    });
    (rows, columns)
}

/// A key in few letters.
fn short_name(axis: &SweepAxis) -> &str {
    match axis.name() {
        "aspect_ratio" => "AR",
        "center_of_rotation" => "COR",
        "rotation_length" => "ρ",
        name => name,
    }
}

/// Draws the Sum of every design in the colour of its size, and its share of the error box; `None` for more rows than fit a page.
pub fn sweep_map(report: &SweepReport) -> Option<Picture> {
    const MOST_ROWS: usize = 60;
    let (rows, columns) = table(&report.settings.axes);
    if rows.len() > MOST_ROWS || columns.len() > MOST_MAPS {
        return None;
    }
    let figures = || report.designs.iter().map(|trial| trial.result.figures());
    let values = |of: fn(&catchment_study::sweep::Figures) -> Option<f64>| -> Vec<Vec<f64>> {
        let all: Vec<f64> = figures().map(|f| f.and_then(of).unwrap_or(f64::NAN)).collect();
        all.chunks(columns.len().max(1)).map(<[f64]>::to_vec).collect()
    };
    let extremes = |values: &[Vec<f64>]| {
        let all = values.iter().flatten().copied().filter(|v| v.is_finite());
        let (lo, hi) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        Colouring::Sequential([lo, hi])
    };
    let place = |number: Option<usize>| number.map(|k| [k / columns.len().max(1), k % columns.len().max(1)]);
    let marks: Vec<([usize; 2], &str)> = [(report.largest, "▲"), (report.smallest, "▼")]
        .into_iter()
        .filter_map(|(number, mark)| Some((place(number)?, mark)))
        .collect();
    let sum = format!("Sum [{}]", report.unit());
    let (sums, edges) = (values(|f| Some(f.sum)), values(|f| f.onaa_edge));
    let map = |title, values: Vec<Vec<f64>>, marks| NumberMap {
        title,
        rows: &rows,
        columns: &columns,
        colouring: extremes(&values),
        values,
        digits: Digits::Decimals(3),
        marks,
    };
    let mut maps = vec![map(sum.as_str(), sums, marks)];
    if edges.iter().flatten().any(|edge| edge.is_finite()) {
        maps.push(map("ONAA edge, of the error box", edges, Vec::new()));
    }
    let extreme = |what: &str, number: Option<usize>| {
        let trial = &report.designs[number?];
        Some(format!("{what}: {} at {}", significant(trial.result.figures()?.sum), report.named(trial)))
    };
    let story = [extreme("▲ largest Sum", report.largest), extreme("▼ smallest Sum", report.smallest)];
    let head = story.into_iter().flatten().fold(Layout::of(&report.design), Layout::story);
    Some(number_maps(head, CELL, &maps))
}

/// Draws the slice through zero of every design, at a common scale; `None` if there is none, or too many.
///
/// # Errors
/// A map cannot be encoded.
pub fn sweep_outlines(report: &SweepReport) -> Result<Option<Picture>, FigureError> {
    let (rows, columns) = table(&report.settings.axes);
    let outlines: Vec<Option<&Outline>> =
        report.designs.iter().map(|trial| trial.result.figures().and_then(|f| f.outline.as_ref())).collect();
    let Some(first) = outlines.iter().flatten().next() else { return Ok(None) };
    if outlines.len() > MOST_OUTLINES || columns.len() > MOST_MAPS {
        return Ok(None);
    }
    let units = ShownUnits::of(&report.design);
    let side = if columns.len() > 6 { 92.0 } else { 118.0 };
    let names = rows.iter().map(|row| width_of(row, TICK)).fold(0.0, f64::max) + TICKS;
    let others: Vec<String> = first.at.iter().map(|(dof, value)| units.value(*dof, *value)).collect();
    let others = if others.is_empty() { String::new() } else { format!(" at {}", others.join(", ")) };
    let [across, up] = first.axes.map(|dof| units.label(dof));
    let panel = |number: usize| {
        let (row, column) = (number / columns.len(), number % columns.len());
        let left = if column == 0 { names } else { 0.0 };
        let below = if row + 1 == rows.len() { BELOW } else { 0.0 };
        let panel = Panel::of([side; 2]).with_room([left, 0.0, 0.0, below]);
        if row == 0 { panel.over(Legend::titled(&columns[column])) } else { panel }
    };
    let (mut svg, frames) = Layout::of(&report.design)
        .story(format!("area of acceptance over {across} and {up}{others}"))
        .story("all to one scale; ▲ largest Sum, ▼ smallest")
        .grid(columns.len(), (0..outlines.len()).map(panel))
        .open();
    let reach = |axis: usize| {
        outlines.iter().flatten().fold(0.0, |most: f64, o| most.max(o.hi[axis]).max(-o.lo[axis]))
    };
    let reach = [reach(0), reach(1)];
    for (number, (outline, rect)) in outlines.iter().zip(frames).enumerate() {
        let (row, column) = (number / columns.len(), number % columns.len());
        if column == 0 {
            let place = [rect.x - names, rect.y + 0.5 * side + 4.0];
            svg.text(place, TICK, Anchor::Start, SOFT, &rows[row]);
        }
        let Some(outline) = outline else {
            svg.text([rect.x + 0.5 * side, rect.y + 0.5 * side], TICK, Anchor::Middle, SOFT, "not computed");
            continue;
        };
        draw(&mut svg, outline, rect, reach, &units)?;
        let axes = shared_frame(rect, outline, reach, &units);
        if column == 0 {
            ticks_beside(&mut svg, &axes);
        }
        if row + 1 == rows.len() {
            ticks_below(&mut svg, &axes);
        }
        let mark = report.mark(number);
        svg.text([rect.x + side - 4.0, rect.y + 14.0], LABEL, Anchor::End, INK, mark);
    }
    Ok(Some(Picture::of(svg)))
}

/// The frame of an outline on the common scale.
fn shared_frame(rect: Rect, outline: &Outline, reach: [f64; 2], units: &ShownUnits) -> PlotFrame {
    let scale = |axis: usize| {
        let (dof, half) = (outline.axes[axis], reach[axis] * units.factor(outline.axes[axis]));
        AxisScale::new(units.label(dof), -half, half, dof.is_rotation())
    };
    PlotFrame { rect, x: scale(0), y: scale(1) }
}

/// A slice, in its part of the shared frame.
fn draw(
    svg: &mut Svg,
    outline: &Outline,
    rect: Rect,
    reach: [f64; 2],
    units: &ShownUnits,
) -> Result<(), FigureError> {
    let axis = |k: usize| GridAxis {
        dof: outline.axes[k],
        lo: outline.lo[k],
        hi: outline.hi[k],
        cells: outline.cells[k],
    };
    let slice = GridSlice { axes: vec![axis(0), axis(1)], at: outline.at.clone(), cells: Vec::new() };
    let outcome =
        |digit: u8| Outcome::ALL.into_iter().find(|o| *o as u8 == digit - b'0').unwrap_or(Outcome::Undecided);
    let map = Map { slice, outcomes: outline.outcomes.bytes().map(outcome).collect() };
    let whole = shared_frame(rect, outline, reach, units);
    let [x0, x1] = [outline.lo[0], outline.hi[0]].map(|v| whole.px(v * units.factor(outline.axes[0])));
    let [y0, y1] = [outline.lo[1], outline.hi[1]].map(|v| whole.py(v * units.factor(outline.axes[1])));
    let own = map.frame(Rect { x: x0, y: y1, w: x1 - x0, h: y0 - y1 }, units);
    map::inside(svg, &map, &own, units, &[])?;
    svg.rect(rect, &format!(r#"fill="none" stroke="{SOFT}" stroke-width="0.6""#));
    Ok(())
}

/// Few ticks without a label: the story has it.
fn ticks_below(svg: &mut Svg, frame: &PlotFrame) {
    let r = frame.rect;
    for x in frame.x.ticks(2) {
        let words = super::draw::axis::tick_label(x);
        svg.text([frame.px(x), r.y + r.h + 14.0], TICK - 1.0, Anchor::Middle, SOFT, &words);
    }
}

fn ticks_beside(svg: &mut Svg, frame: &PlotFrame) {
    for y in frame.y.ticks(3) {
        let words = super::draw::axis::tick_label(y);
        svg.text([frame.rect.x - 5.0, frame.py(y) + 3.5], TICK - 1.0, Anchor::End, SOFT, &words);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use catchment_core::design::SourceText;
    use catchment_core::exec::Exec;
    use catchment_core::run::{Over, Run, Sample};
    use catchment_study::sweep::{NoStore, SweepPlan, SweepSettings};

    fn swept(text: &str, axes: &[&str]) -> SweepReport {
        let source = SourceText::new("d.toml", text);
        let run = Run { over: Over::Grid("15".parse().unwrap()), sample: Sample::None, ..Run::default() };
        let axes = axes.iter().map(|axis| axis.parse().unwrap()).collect();
        let plan = SweepPlan::new(&source, SweepSettings { axes, run }, Ok).unwrap();
        let design = plan.base().clone();
        SweepReport::new(&design, plan.run(&NoStore, &Exec::new()).unwrap(), Vec::new(), None)
    }

    #[test]
    fn two_axes_one_axis_and_three() {
        let text = "name = 'V-Face'\n[connector]\nfamily = 'v-face'\nwidth = 50\nunit = 'mm'\n";
        for (name, axes) in [
            ("sweep-2", &["aspect_ratio=0.5,1,2", "cor=-1..1/5"][..]),
            ("sweep-1", &["cor=-1,0,1"]),
            ("sweep-3", &["aspect_ratio=0.5,1", "errors.pitch=30 deg,60 deg", "cor=-1,1"]),
        ] {
            let report = swept(text, axes);
            let map = sweep_map(&report).unwrap();
            look(name, &map);
            let outlines = sweep_outlines(&report).unwrap().unwrap();
            look(&format!("{name}-outlines"), &outlines);
            let designs = report.designs.len();
            assert_eq!(outlines.svg().matches("<image").count(), designs);
            assert!(map.svg().matches("▲").count() == 2 && outlines.svg().matches("▲").count() == 2);
        }
    }

    #[test]
    fn one_free_error_has_no_outline() {
        let text = "[connector]\nfamily = 'v-face'\n[alignment]\nfree = ['x']\n";
        assert!(sweep_outlines(&swept(text, &["cor=0,1"])).unwrap().is_none());
    }
}
