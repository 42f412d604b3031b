//! Holding forces: lateral forces over their direction, torques as bars.

use super::draw::colour::{CURVES, hex};
use super::draw::layout::{Layout, Legend, Panel, stroked};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK, polyline};
use super::{FigureError, Picture};
use crate::HoldReport;
use catchment_core::document::significant;
use catchment_study::hold::LoadLimits;

/// The radius of the polar chart, and the size of the bars, in SVG units.
const RADIUS: f64 = 180.0;
const BARS: [f64; 2] = [300.0, 360.0];
/// Room of the chart for the names of its axes and the words below it, and of the bars for their names and numbers.
const AROUND: [f64; 4] = [20.0, 22.0, 20.0, 48.0];
const BESIDE: [f64; 4] = [50.0, 22.0, 84.0, 24.0];
/// Rings of the polar chart, at most.
const RINGS: f64 = 4.0;
/// Values beyond this multiple of the finite median are drawn at the rim, so that the rest is visible.
const BEYOND: f64 = 4.0;
/// Shares of the preload below this are nothing: rounding.
const NOTHING: f64 = 1e-6;

/// A column of [`LoadLimits::columns`]: its name, colour and stroke.
struct Column {
    name: &'static str,
    number: usize,
    colour: usize,
    dashed: bool,
}

const COLUMNS: [Column; 4] = [
    Column { name: "guided", number: 0, colour: 0, dashed: true },
    Column { name: "free", number: 1, colour: 0, dashed: false },
    Column { name: "guided, friction", number: 2, colour: 1, dashed: true },
    Column { name: "free, friction", number: 3, colour: 1, dashed: false },
];

impl Column {
    /// Infinite if any load is resisted; `None` if unknown.
    fn of(&self, withstood: &LoadLimits) -> Option<f64> {
        withstood.columns()[self.number]
    }
}

/// Draws the holding force over the direction of the force, and the holding torques.
///
/// # Errors
/// If no free error can be loaded.
pub fn hold(report: &HoldReport) -> Result<Picture, FigureError> {
    if report.sideways.is_empty() && report.torques.is_empty() {
        return Err(FigureError::Empty { what: "no free error can be pushed" });
    }
    let preload = report.preload_n.map_or_else(|| "F".to_owned(), |n| format!("{} N", significant(n)));
    let friction = report.settings.friction;
    let with = if friction > 0.0 { format!(", friction {friction}") } else { String::new() };
    let story = format!("load limits at rest, with a preload of {preload} along −z{with}");
    let columns = COLUMNS.iter().take(if friction > 0.0 { 4 } else { 2 });
    let legend = columns.fold(Legend::default(), |legend, column| legend.line(style(column), column.name));
    let force = report.force_unit();
    let unit = report.design.unit.map_or("D", |unit| unit.symbol());
    let (mut svg, frames) = Layout::of(&report.design)
        .story(story)
        .row([
            Panel::of([2.0 * RADIUS; 2]).with_room(AROUND).over(format!("sideways force resisted [{force}]")),
            Panel::of(BARS).with_room(BESIDE).over(format!("torque resisted [{force} {unit}]")),
        ])
        .legend(legend)
        .open();
    polar(&mut svg, report, frames[0]);
    bars(&mut svg, report, frames[1]);
    Ok(Picture::of(svg))
}

fn style(column: &Column) -> String {
    let dash = if column.dashed { r#" stroke-dasharray="5 4""# } else { "" };
    stroked(CURVES[column.colour % CURVES.len()], 2.0) + dash
}

/// The value drawn at the rim of a chart: a round number above all finite values close to the others.
fn rim(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.filter(|value| *value > NOTHING && value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let Some(median) = values.get(values.len() / 2) else { return 1.0 };
    let most = values.iter().copied().filter(|value| *value <= BEYOND * median).fold(0.0, f64::max);
    let unit = 10f64.powf((most / RINGS).log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|k| k * unit).into_iter().find(|step| RINGS * step >= most);
    let step = step.unwrap_or(10.0 * unit);
    (most / step - NOTHING).ceil() * step
}

fn polar(svg: &mut Svg, report: &HoldReport, rect: Rect) {
    let middle = [rect.x + RADIUS, rect.y + RADIUS];
    let [cx, cy] = middle;
    let scale = report.preload_n.unwrap_or(1.0);
    let sides: Vec<(f64, LoadLimits)> =
        report.sideways.iter().map(|side| (side.direction_rad, side.withstood)).collect();
    if sides.is_empty() {
        svg.text([cx, cy], LABEL, Anchor::Middle, SOFT, "x and y are locked");
        return;
    }
    let finite = sides.iter().flat_map(|(_, two)| COLUMNS.iter().filter_map(|column| column.of(two)));
    let rim = rim(finite);
    let at = |direction: f64, value: f64| {
        let r = RADIUS * (value / rim).min(1.0);
        [cx + r * direction.cos(), cy - r * direction.sin()]
    };
    let grid = r##"fill="none" stroke="#d5dbe2" stroke-width="1""##;
    let rings =
        (1..).map(|k: u32| f64::from(k) * ring(rim)).take_while(|ring| *ring <= rim * (1.0 + NOTHING));
    for value in rings {
        svg.circle(middle, RADIUS * value / rim, grid);
        let place = [cx + 4.0, cy - RADIUS * value / rim - 3.0];
        svg.haloed(place, TICK - 1.0, Anchor::Start, SOFT, &significant_short(value * scale));
    }
    svg.line([cx - RADIUS, cy], [cx + RADIUS, cy], grid);
    svg.line([cx, cy - RADIUS], [cx, cy + RADIUS], grid);
    svg.text([cx + RADIUS + 8.0, cy + 4.0], LABEL, Anchor::Start, INK, "x");
    svg.text([cx, cy - RADIUS - 10.0], LABEL, Anchor::Middle, INK, "y");
    let mut beyond = false;
    for column in &COLUMNS {
        let values: Vec<(f64, f64)> =
            sides.iter().filter_map(|(direction, two)| Some((*direction, column.of(two)?))).collect();
        beyond |= values.iter().any(|(_, value)| *value > rim * (1.0 + NOTHING));
        if sides.len() > 2 {
            let points = values.iter().map(|(direction, value)| at(*direction, *value));
            svg.path(&polyline(points, true), &style(column));
        } else {
            for (direction, value) in &values {
                svg.line(middle, at(*direction, *value), &style(column));
                svg.circle(at(*direction, *value), 3.5, &style(column));
            }
        }
    }
    if beyond {
        svg.text(
            [cx, cy + RADIUS + 26.0],
            TICK,
            Anchor::Middle,
            SOFT,
            "drawn at the rim: more than that, or any",
        );
    }
    weakest(svg, report, [cx, cy + RADIUS + 46.0], at);
}

/// The weakest direction of the decisive column: free, with friction if requested.
fn weakest(svg: &mut Svg, report: &HoldReport, below: [f64; 2], at: impl Fn(f64, f64) -> [f64; 2]) {
    let found = report.weakest.rough_free.or(report.weakest.smooth_free);
    let (Some(side), Some(force)) = (found, report.least_force) else { return };
    let place = at(side.direction_rad, force);
    svg.circle(place, 5.0, &format!(r##"fill="#ffffff" stroke="{INK}" stroke-width="2""##));
    let unit = report.force_unit();
    let force =
        if force < NOTHING { "0".to_owned() } else { significant(force * report.preload_n.unwrap_or(1.0)) };
    let words = format!("○ weakest: {force} {unit} at {:.1}°", side.direction_rad.to_degrees());
    svg.text(below, LABEL, Anchor::Middle, INK, &words);
}

/// Between two rings.
fn ring(rim: f64) -> f64 {
    let unit = 10f64.powf((rim / RINGS).log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|k| k * unit)
        .into_iter()
        .find(|step| RINGS * step >= rim * (1.0 - NOTHING));
    step.unwrap_or(10.0 * unit)
}

/// Up to four digits, without zeros at their end.
fn significant_short(value: f64) -> String {
    let text = significant(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn bars(svg: &mut Svg, report: &HoldReport, Rect { x, y, w, h }: Rect) {
    let width = if report.design.unit.is_some() { report.design.width } else { 1.0 };
    let scale = report.preload_n.unwrap_or(1.0) * width;
    if report.torques.is_empty() {
        svg.text([x, y + 20.0], LABEL, Anchor::Start, SOFT, "rotations are locked");
        return;
    }
    let torques: Vec<(String, LoadLimits)> = report
        .torques
        .iter()
        .map(|torque| {
            let sign = if torque.sign > 0.0 { '+' } else { '−' };
            (format!("{sign}{}", torque.axis.name()), torque.withstood)
        })
        .collect();
    let finite = torques.iter().flat_map(|(_, two)| COLUMNS.iter().filter_map(|column| column.of(two)));
    let most = rim(finite);
    let requested = |column: &&Column| torques.iter().any(|(_, two)| column.of(two).is_some());
    let columns: Vec<&Column> = COLUMNS.iter().filter(requested).collect();
    let each = (h / torques.len() as f64).min(80.0);
    let thick = (0.8 * each / columns.len().max(1) as f64).min(14.0);
    for (k, (name, two)) in torques.iter().enumerate() {
        let top = y + each * k as f64;
        svg.text([x - 8.0, top + 0.5 * thick * columns.len() as f64 + 4.0], LABEL, Anchor::End, INK, name);
        for (j, column) in columns.iter().enumerate() {
            let Some(value) = column.of(two) else { continue };
            let length = w * (value / most).min(1.0);
            let colour = hex(CURVES[column.colour % CURVES.len()]);
            let opacity = if column.dashed { 0.35 } else { 0.85 };
            let bar = Rect { x, y: top + thick * j as f64, w: length.max(0.5), h: 0.8 * thick };
            svg.rect(bar, &format!(r#"fill="{colour}" fill-opacity="{opacity}" stroke="none""#));
            let force = match value {
                f64::INFINITY => "any".to_owned(),
                value if value < NOTHING => "0".to_owned(),
                value => significant(value * scale),
            };
            svg.text(
                [x + length + 6.0, bar.y + 0.8 * thick],
                TICK.min(thick + 1.0),
                Anchor::Start,
                INK,
                &force,
            );
        }
    }
    let bottom = y + each * torques.len() as f64;
    svg.line([x, y - 6.0], [x, bottom], &format!(r#"stroke="{SOFT}" stroke-width="1""#));
    svg.text(
        [x, bottom + 18.0],
        TICK,
        Anchor::Start,
        SOFT,
        "about the centre of rotation; guided in pale colour",
    );
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use catchment_core::design::read;
    use catchment_core::exec::Exec;
    use catchment_core::problem::Problem;
    use catchment_study::hold::{HoldSettings, HoldingForces, run};
    use std::path::Path;

    fn drawn(text: &str, friction: f64, preload: Option<f64>) -> Picture {
        let problem = Problem::of(read(text, Path::new("")).unwrap().design).unwrap();
        let found =
            run(&problem, &HoldSettings { friction, ..HoldSettings::default() }, &Exec::new()).unwrap();
        let found = HoldingForces { preload_n: preload, ..found };
        let report = HoldReport::new(problem.design(), found, Vec::new(), None);
        hold(&report).unwrap()
    }

    #[test]
    fn forces_and_torques_are_drawn() {
        let text = "[connector]\nfamily = \"x-face-3d\"\nwidth = 50\nunit = \"mm\"\naspect_ratio = 0.577\n";
        let picture = drawn(text, 0.0, None);
        look("hold", &picture);
        assert!(picture.svg().contains("weakest"));
        let rough = drawn(text, 0.2, Some(40.0));
        look("hold-friction", &rough);
        assert!(rough.svg().contains("[N mm]") && rough.svg().contains("free, friction"));
        let planar = "[connector]\nfamily = \"v-face\"\n[alignment]\nrotation_length = 1.0\n";
        look("hold-planar", &drawn(planar, 0.3, None));
        let locked =
            "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"pitch\"]\nrotation_length = 1.0\n";
        assert!(drawn(locked, 0.0, None).svg().contains("x and y are locked"));
    }
}
