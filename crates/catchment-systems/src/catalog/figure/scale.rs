//! Every published area on a logarithmic scale.

use super::super::data::{Catalog, RowSource, System};
use super::super::facts::{Fact, Provenance};
use super::NAMES;
use super::cells::ACCEPTED;
use catchment::report::figure::draw::axis::tick_label;
use catchment::report::figure::draw::colour::{MOVING, MOVING_EDGE, hex};
use catchment::report::figure::draw::layout::{Legend, Panel};
use catchment::report::figure::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, TICK};

/// Height of a line.
const LINE: f64 = 19.0;
/// Width of the scale, and of the text after it.
const WIDTH: f64 = 730.0;
const REMARK: f64 = 250.0;
/// Ends of the scale, in D².
const ENDS: [f64; 2] = [0.002, 4.0];

/// Systems with an area, the smallest first.
fn systems(catalog: &Catalog) -> Vec<&System> {
    let mut systems: Vec<&System> = catalog.systems.iter().filter(|system| system.area().is_some()).collect();
    let area = |system: &System| system.area().unwrap_or_default();
    systems.sort_by(|a, b| area(a).total_cmp(&area(b)));
    systems
}

/// The panel of the scale.
pub(super) fn panel(catalog: &Catalog) -> Panel {
    Panel::of([WIDTH, LINE * systems(catalog).len() as f64])
        .below()
        .with_room([NAMES, 0.0, REMARK, 0.0])
        .over("All published areas")
        .over(Legend::titled("logarithmic scale; * an estimate; filled if the shape is known"))
}

/// The known facts about the shape.
fn shape_of(system: &System) -> &'static str {
    match Fact::of(system).and_then(|fact| fact.shape) {
        Some((_, Provenance::Inferred)) => "shape unknown; a square agrees [I]",
        Some(_) => "shape known",
        None if system.source == RowSource::Appended => "a design, computed",
        None if system.name == "SINGO" => "shape unknown, but for its concave X",
        None => "shape unknown",
    }
}

pub(super) fn draw(svg: &mut Svg, catalog: &Catalog, rect: Rect) {
    let (left, right) = (rect.x, rect.x + rect.w);
    let logs = ENDS.map(f64::log10);
    let at = |area: f64| {
        left + (area.clamp(ENDS[0], ENDS[1]).log10() - logs[0]) / (logs[1] - logs[0]) * (right - left)
    };
    let systems = systems(catalog);
    let (top, bottom) = (rect.y, rect.y + rect.h);
    for tick in [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0] {
        let x = at(tick);
        svg.line(
            [x, top],
            [x, bottom],
            &format!(r#"stroke="{SOFT}" stroke-opacity="0.22" stroke-width="0.8""#),
        );
        svg.text([x, bottom + 15.5], TICK, Anchor::Middle, SOFT, &tick_label(tick));
    }
    svg.text([0.5 * (left + right), bottom + 32.0], LABEL, Anchor::Middle, INK, "area of acceptance [D²]");
    for (k, system) in systems.iter().enumerate() {
        let middle = top + LINE * (k as f64 + 0.5);
        let Some(area) = system.area() else { continue };
        let name = system.zraa_name().unwrap_or(&system.name);
        svg.text([left - 10.0, middle + 4.0], LABEL, Anchor::End, INK, &short(name));
        let known = shape_of(system) == "shape known";
        let (fill, edge) = match (known, &system.source) {
            (_, RowSource::Appended) => (hex(MOVING), hex(MOVING_EDGE)),
            (true, _) => (hex(ACCEPTED), hex(ACCEPTED)),
            (false, _) => ("#ffffff".to_owned(), hex(ACCEPTED)),
        };
        svg.line([left, middle], [at(area), middle], &format!(r#"stroke="{edge}" stroke-width="1.6""#));
        let dot = format!(r#"fill="{fill}" stroke="{edge}" stroke-width="1.6""#);
        svg.circle([at(area), middle], 5.0, &dot);
        let printed = system.published.as_ref().map_or_else(|| tick_label(area), |zraa| zraa.printed.clone());
        let star = if system.published.as_ref().is_some_and(|zraa| zraa.estimated) { "*" } else { "" };
        svg.text([at(area) + 11.0, middle + 4.0], LABEL, Anchor::Start, INK, &format!("{printed}{star}"));
        svg.text([right + 44.0, middle + 4.0], LABEL, Anchor::Start, SOFT, shape_of(system));
    }
}

/// A name that fits before the scale.
fn short(name: &str) -> String {
    /// Characters that do.
    const FIT: usize = 24;
    if name.chars().count() <= FIT {
        return name.to_owned();
    }
    name.chars().take(FIT - 1).chain(std::iter::once('…')).collect()
}
