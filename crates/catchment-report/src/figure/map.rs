//! Maps over two errors: the common part of slices, height maps and the overview.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits, TICK_LINE, short, tick_label};
use super::draw::colour::{self, Rgb};
use super::draw::layout::{Legend, filled};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, polyline, width_of};
use super::{FigureError, raster};
use catchment_core::acceptance::{Acceptance, Outcome};
use catchment_core::landscape::Grid;
use catchment_core::merit::onaa::Interval;
use catchment_core::merit::slice::GridSlice;
use catchment_core::pose::{Dof, PoseError};

/// Two axes of a grid, with the others fixed, and the outcomes there.
pub(super) struct Map {
    pub(super) slice: GridSlice,
    pub(super) outcomes: Vec<Outcome>,
}

impl Map {
    pub(super) fn of(acceptance: &Acceptance, pair: [Dof; 2], at: &PoseError) -> Result<Self, FigureError> {
        let grid = acceptance.grid().ok_or(catchment_core::merit::MeritError::NotAGrid)?;
        let slice = GridSlice::of(grid, &pair, at)?;
        let outcomes = slice.pick(&acceptance.outcomes);
        Ok(Self { slice, outcomes })
    }

    /// The same map as a part of `whole`, which may have more errors: those are fixed at zero.
    pub(super) fn within(mut self, whole: &Acceptance, pair: [Dof; 2]) -> Result<Self, FigureError> {
        let grid = whole.grid().ok_or(catchment_core::merit::MeritError::NotAGrid)?;
        let beside = |dof: Dof| !pair.contains(&dof) && self.slice.at.iter().all(|(d, _)| *d != dof);
        let more: Vec<(Dof, f64)> =
            grid.axes.iter().filter(|a| beside(a.dof)).map(|a| (a.dof, 0.0)).collect();
        self.slice.at.extend(more);
        Ok(self)
    }

    pub(super) fn frame(&self, rect: Rect, units: &ShownUnits) -> PlotFrame {
        PlotFrame { rect, x: units.axis(&self.slice.axes[0]), y: units.axis(&self.slice.axes[1]) }
    }

    /// The fixed errors in words; empty without fixed errors.
    pub(super) fn fixed(&self, units: &ShownUnits) -> String {
        let values: Vec<String> = self.slice.at.iter().map(|(dof, v)| units.value(*dof, *v)).collect();
        values.join(", ")
    }

    /// Its content, and its position among the fixed errors, within this width: `…, slice through zero`,
    /// `…, slice at yaw = 1.5°`.
    pub(super) fn heading(&self, shows: &str, units: &ShownUnits, width: f64) -> String {
        if self.slice.at.is_empty() {
            return shows.to_owned();
        }
        if self.is_central() {
            return format!("{shows}, slice through zero");
        }
        let exact = format!("{shows}, slice at {}", self.fixed(units));
        if width_of(&exact, LABEL) < width { exact } else { format!("{shows}, slice beside zero") }
    }

    /// Whether every fixed error is zero: cells of an even grid are centred beside it.
    pub(super) fn is_central(&self) -> bool {
        self.slice.at.iter().all(|(_, value)| value.abs() < 1e-9)
    }

    /// The share of its cells with an outcome.
    pub(super) fn share(&self, outcome: Outcome) -> f64 {
        let count = self.outcomes.iter().filter(|result| **result == outcome).count();
        count as f64 / self.outcomes.len().max(1) as f64
    }

    /// A pixel for each cell, first axis to the right, second upwards.
    pub(super) fn paint(&self, svg: &mut Svg, frame: &PlotFrame, colours: &[Rgb]) -> Result<(), FigureError> {
        let [width, height] = [self.slice.axes[0].cells, self.slice.axes[1].cells];
        svg.image(frame.rect, &raster::cells(width, height, colours)?, true);
        Ok(())
    }

    /// The border of the accepted set: along cell borders, runs joined.
    pub(super) fn border(&self, frame: &PlotFrame) -> String {
        let [width, height] = [self.slice.axes[0].cells, self.slice.axes[1].cells];
        let accepted = |i: usize, j: usize| self.outcomes[i + j * width] == Outcome::Aligned;
        let place = |i: usize, j: usize| {
            let r = frame.rect;
            [r.x + r.w * i as f64 / width as f64, r.y + r.h * (1.0 - j as f64 / height as f64)]
        };
        let mut data = String::new();
        for i in 1..width {
            for (from, to) in runs(height, |j| accepted(i - 1, j) != accepted(i, j)) {
                data += &polyline([place(i, from), place(i, to)], false);
            }
        }
        for j in 1..height {
            for (from, to) in runs(width, |i| accepted(i, j - 1) != accepted(i, j)) {
                data += &polyline([place(from, j), place(to, j)], false);
            }
        }
        data
    }
}

/// The maximal runs `from..to` of 0..n in which `holds` is true.
fn runs(n: usize, holds: impl Fn(usize) -> bool) -> Vec<(usize, usize)> {
    let mut result: Vec<(usize, usize)> = Vec::new();
    for k in (0..n).filter(|k| holds(*k)) {
        match result.last_mut() {
            Some((_, to)) if *to == k => *to = k + 1,
            _ => result.push((k, k + 1)),
        }
    }
    result
}

/// Paints outcomes, border, zero lines, the ONAA cube (nothing without bounds), and the axes.
pub(super) fn outcomes(
    svg: &mut Svg,
    map: &Map,
    frame: &PlotFrame,
    units: &ShownUnits,
    onaa: &[Interval],
) -> Result<(), FigureError> {
    inside(svg, map, frame, units, onaa)?;
    frame.draw(svg);
    Ok(())
}

/// The same without the axes.
pub(super) fn inside(
    svg: &mut Svg,
    map: &Map,
    frame: &PlotFrame,
    units: &ShownUnits,
    onaa: &[Interval],
) -> Result<(), FigureError> {
    let colours: Vec<Rgb> = map.outcomes.iter().map(|o| colour::outcome(*o)).collect();
    map.paint(svg, frame, &colours)?;
    zero_lines(svg, frame);
    svg.path(&map.border(frame), BORDER);
    cube(svg, map, frame, units, onaa);
    Ok(())
}

/// The style of the border of the accepted set.
pub(super) const BORDER: &str =
    r##"fill="none" stroke="#123a5c" stroke-width="1.6" stroke-linecap="round" stroke-linejoin="round""##;

/// Thin lines through zero.
pub(super) fn zero_lines(svg: &mut Svg, frame: &PlotFrame) {
    let r = frame.rect;
    let style = r##"stroke="#ffffff" stroke-opacity="0.75" stroke-width="0.9""##;
    if frame.x.lo < 0.0 && frame.x.hi > 0.0 {
        svg.line([frame.px(0.0), r.y], [frame.px(0.0), r.y + r.h], style);
    }
    if frame.y.lo < 0.0 && frame.y.hi > 0.0 {
        svg.line([r.x, frame.py(0.0)], [r.x + r.w, frame.py(0.0)], style);
    }
}

/// The cube's shadow on the two axes; dashed if the slice does not cut it.
fn cube(svg: &mut Svg, map: &Map, frame: &PlotFrame, units: &ShownUnits, onaa: &[Interval]) {
    let range = |dof: Dof| onaa.iter().find(|i| i.axis == dof).map(|i| (i.lo, i.hi));
    let [a, b] = [map.slice.axes[0].dof, map.slice.axes[1].dof];
    let (Some((x0, x1)), Some((y0, y1))) = (range(a), range(b)) else { return };
    let cuts = map.slice.at.iter().all(|(dof, v)| range(*dof).is_none_or(|(lo, hi)| (lo..=hi).contains(v)));
    let [left, top] = frame.at([x0 * units.factor(a), y1 * units.factor(b)]);
    let [right, bottom] = frame.at([x1 * units.factor(a), y0 * units.factor(b)]);
    let dash = if cuts { "" } else { r#" stroke-dasharray="5 3""# };
    let rect = Rect { x: left, y: top, w: right - left, h: bottom - top };
    svg.rect(
        rect,
        &format!(r##"fill="#ffffff" fill-opacity="0.16" stroke="#ffffff" stroke-width="3.6"{dash}"##),
    );
    svg.rect(rect, &format!(r#"fill="none" stroke="{INK}" stroke-width="1.7"{dash}"#));
}

/// The outcomes in a map with their shares of it, and its cube.
pub(super) fn legend(map: &Map, onaa: bool) -> Legend {
    let of = if map.slice.at.is_empty() { "of the error box:" } else { "of this slice:" };
    let words = |outcome| format!("{} {} %", Outcome::word(outcome), short(100.0 * map.share(outcome)));
    outcome_squares(
        Legend::titled(of),
        |outcome| map.outcomes.contains(&outcome),
        words,
        onaa.then_some(CUBE),
    )
}

/// Words for the largest cube.
pub(super) const CUBE: &str = "largest cube (ONAA)";

/// A square for each outcome that occurs, and one for the largest cube with its words.
pub(super) fn outcome_squares(
    legend: Legend,
    occurs: impl Fn(Outcome) -> bool,
    words: impl Fn(Outcome) -> String,
    cube: Option<&str>,
) -> Legend {
    let legend = Outcome::ALL
        .into_iter()
        .filter(|outcome| occurs(*outcome))
        .fold(legend, |legend, outcome| legend.square(filled(colour::outcome(outcome)), words(outcome)));
    match cube {
        Some(words) => legend.square(format!(r#"fill="none" stroke="{INK}" stroke-width="1.7""#), words),
        None => legend,
    }
}

/// A colour bar with ticks and its label, to the right of a map: in the room of [`Panel::with_bar`].
///
/// [`Panel::with_bar`]: super::draw::layout::Panel::with_bar
pub(super) fn colour_bar(svg: &mut Svg, map: &PlotFrame, scale: AxisScale) -> Result<(), FigureError> {
    const STEPS: usize = 128;
    let rect = Rect { x: map.rect.x + map.rect.w + 14.0, y: map.rect.y, w: 12.0, h: map.rect.h };
    let colours: Vec<Rgb> = (0..STEPS).map(|k| colour::sequential(k as f64 / (STEPS - 1) as f64)).collect();
    svg.image(rect, &raster::cells(1, STEPS, &colours)?, false);
    svg.rect(rect, &format!(r#"fill="none" stroke="{INK}" stroke-opacity="0.5" stroke-width="0.8""#));
    let frame = PlotFrame { rect, x: scale.clone(), y: scale };
    let (right, mut widest) = (rect.x + rect.w, 0.0f64);
    for z in frame.y.ticks((rect.h / 42.0) as usize) {
        let (y, number) = (frame.py(z), tick_label(z));
        svg.line([right, y], [right + 4.0, y], TICK_LINE);
        svg.text([right + 7.0, y + 3.8], TICK, Anchor::Start, SOFT, &number);
        widest = widest.max(width_of(&number, TICK));
    }
    svg.text_up([right + widest + 22.0, rect.y + 0.5 * rect.h], LABEL, &frame.y.label);
    Ok(())
}

/// Path data of the lines at which a field over cell centres equals `level`: marching squares, straight in
/// each square. Squares with a corner that is not finite are skipped.
pub(super) fn contour(frame: &PlotFrame, [width, height]: [usize; 2], field: &[f64], level: f64) -> String {
    let at = |i: usize, j: usize| field[i + j * width];
    let place = |i: f64, j: f64| {
        let r = frame.rect;
        [r.x + r.w * (i + 0.5) / width as f64, r.y + r.h * (1.0 - (j + 0.5) / height as f64)]
    };
    let mut data = String::new();
    for j in 1..height {
        for i in 1..width {
            let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
            let values = [at(i - 1, j - 1), at(i, j - 1), at(i, j), at(i - 1, j)];
            if values.iter().any(|v| !v.is_finite()) {
                continue;
            }
            let mut crossings = Vec::with_capacity(4);
            for k in 0..4 {
                let (a, b) = (values[k], values[(k + 1) % 4]);
                if (a < level) != (b < level) {
                    let t = (level - a) / (b - a);
                    let ((i0, j0), (i1, j1)) = (corners[k], corners[(k + 1) % 4]);
                    let between = |p: usize, q: usize| p as f64 + t * (q as f64 - p as f64);
                    crossings.push(place(between(i0, i1), between(j0, j1)));
                }
            }
            for ends in crossings.chunks_exact(2) {
                data += &polyline(ends.iter().copied(), false);
            }
        }
    }
    data
}

/// Every pair of axes, or the requested ones; an error if there is none.
pub(super) fn pairs_or_all(grid: &Grid, pairs: &[[Dof; 2]]) -> Result<Vec<[Dof; 2]>, FigureError> {
    let all = if pairs.is_empty() { catchment_core::merit::slice::pairs(grid) } else { pairs.to_vec() };
    if all.is_empty() {
        return Err(FigureError::Empty { what: "a map needs two free errors" });
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::landscape::GridAxis;

    fn map(outcomes: Vec<Outcome>, width: usize) -> Map {
        let cells = outcomes.len() / width;
        let axes = vec![
            GridAxis { dof: Dof::X, lo: 0.0, hi: 1.0, cells: width },
            GridAxis { dof: Dof::Y, lo: 0.0, hi: 1.0, cells },
        ];
        Map { slice: GridSlice { axes, at: Vec::new(), cells: (0..outcomes.len()).collect() }, outcomes }
    }

    fn frame(map: &Map, side: f64) -> PlotFrame {
        let units = ShownUnits::of(&crate::schema::testing::design(catchment_core::pose::DofSet::ALL));
        map.frame(Rect { x: 0.0, y: 0.0, w: side, h: side }, &units)
    }

    #[test]
    fn the_border_runs_between_accepted_and_rejected_cells() {
        // The lower left quarter of a 4 × 4 map: a joined run up and a run to the right; y grows upwards.
        let accepted = |k: usize| if k % 4 < 2 && k < 8 { Outcome::Aligned } else { Outcome::Missed };
        let map = map((0..16).map(accepted).collect(), 4);
        assert_eq!(map.border(&frame(&map, 4.0)), "M2 4L2 2M0 2L2 2");
    }

    #[test]
    fn contours_of_a_plane_are_straight() {
        // x from 0 to 3 across four columns of width 1: level 1.5 lies midway between centres 1.5 and 2.5.
        let map = map(vec![Outcome::Missed; 12], 4);
        let field: Vec<f64> = (0..12).map(|k| f64::from(k % 4)).collect();
        let data = contour(&frame(&map, 12.0), [4, 3], &field, 1.5);
        assert_eq!(data.matches('M').count(), 2);
        assert!(data.split(['M', 'L']).filter(|p| !p.is_empty()).all(|p| p.starts_with("6 ")), "{data}");
    }
}
