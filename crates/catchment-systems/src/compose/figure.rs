//! Three panels: the swept region of A, the swept region of B, and the approach region.

use super::report::bracket;
use super::{Composition, OverlapMap, Region, RegionFrames};
use catchment::report::figure::draw::axis::{AxisScale, PlotFrame, short};
use catchment::report::figure::draw::colour::{self, Rgb, hex, mix, sequential};
use catchment::report::figure::draw::layout::{Layout, Legend, Panel};
use catchment::report::figure::draw::svg::{Anchor, INK, JOIN, Rect, SOFT, Svg, TICK, polyline};
use catchment::report::figure::{FigureError, Picture};
use glam::DVec2;

/// Side of a panel, in SVG units.
const SIDE: f64 = 300.0;
/// Room around a region, as a share of its extent.
const MARGIN: f64 = 0.08;

/// The square of the plane around points.
fn frame(around: [DVec2; 2], rect: Rect, unit: &str) -> PlotFrame {
    let (center, half) = ((around[0] + around[1]) / 2.0, (around[1] - around[0]).max_element() / 2.0);
    let half = (half * (1.0 + 2.0 * MARGIN)).max(1e-6);
    let scale = |name: &str, middle: f64| {
        AxisScale::new(format!("{name} [{unit}]"), middle - half, middle + half, false)
    };
    PlotFrame { rect, x: scale("x", center.x), y: scale("y", center.y) }
}

/// The smallest rectangle around regions and the origin.
fn around<'r>(regions: impl IntoIterator<Item = &'r Region>) -> [DVec2; 2] {
    regions
        .into_iter()
        .filter_map(Region::bounds)
        .fold([DVec2::ZERO; 2], |[low, high], [l, h]| [low.min(l), high.max(h)])
}

fn path(frame: &PlotFrame, region: &Region) -> String {
    let data = |outline: Vec<DVec2>| polyline(outline.iter().map(|p| frame.at(p.to_array())), true);
    region.outlines().into_iter().map(data).collect()
}

/// Origin of a robot's frame, and its facing direction.
fn robot(svg: &mut Svg, frame: &PlotFrame, facing: Option<DVec2>) {
    let [x, y] = frame.at([0.0, 0.0]);
    svg.circle([x, y], 3.6, &format!(r##"fill="{INK}" stroke="#ffffff" stroke-width="1.2""##));
    if let Some(way) = facing {
        const ARROW: f64 = 26.0;
        let tip = [x + ARROW * way.x, y - ARROW * way.y];
        let style = format!(r#"stroke="{INK}" stroke-width="1.6" {JOIN}"#);
        svg.line([x, y], tip, &style);
        for side in [-1.0, 1.0] {
            let back = DVec2::from_angle(side * 0.5).rotate(-way) * 8.0;
            svg.line(tip, [tip[0] + back.x, tip[1] - back.y], &style);
        }
    }
}

/// The overlap as an image, transparent without overlap.
fn image(map: &OverlapMap) -> Result<Vec<u8>, FigureError> {
    let largest = map.values.iter().copied().fold(0.0, f64::max);
    let mut pixels = Vec::with_capacity(4 * map.values.len());
    for row in map.values.chunks(map.cells[0]).rev() {
        for value in row {
            let share = value / largest;
            // Light for a small overlap: the border of the region fades out.
            let [r, g, b] = mix([0xff, 0xff, 0xff], sequential(1.0 - 0.8 * share), 0.25 + 0.75 * share);
            pixels.extend(if *value > 0.0 { [r, g, b, 255] } else { [255, 255, 255, 0] });
        }
    }
    let failed = |error: png::EncodingError| FigureError::Encode { reason: error.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, map.cells[0] as u32, map.cells[1] as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels)).map_err(failed)?;
    Ok(bytes)
}

/// Draws a composition.
///
/// # Errors
/// If there is nothing to draw.
pub fn figure(found: &Composition) -> Result<Picture, FigureError> {
    let slice = &found.slices[found.shown];
    let unit = found.halves[0].measure.symbol();
    let names = [&found.halves[0].name, &found.halves[1].name];
    let frames = match found.settings.frames {
        RegionFrames::Own => "each drawn in its own frame, facing +y; the second is mounted by a half turn",
        RegionFrames::World => "both drawn in one frame, as they stand before each other",
    };
    let heading = short(slice.heading.to_degrees());
    let mut words = vec![format!("colour: area of the overlap, up to {}", significant_area(found, unit))];
    if found.slices.len() > 1 {
        words.push(format!("heading {heading}°; thin lines: first and last heading"));
    }
    if found.bodies.is_some() {
        words.push("dashed: bodies".to_owned());
    }
    let panel = |name: &str, area: [f64; 2]| {
        Panel::with_axes([SIDE; 2]).over(format!("{name}: {} {unit}²", bracket(area)))
    };
    let (mut svg, rects) = Layout::titled(format!("{} and {}: approach region", names[0], names[1]))
        .story(frames)
        .row([
            panel(names[0], found.halves[0].region.area()),
            panel(names[1], found.halves[1].region.area()),
            panel("both", slice.region.area()),
        ])
        .legend(Legend::titled(&words.join("  ·  ")))
        .open();
    let style = |fill: Rgb, edge: Rgb| {
        format!(
            r#"fill="{}" stroke="{}" stroke-width="1.2" fill-rule="evenodd" {JOIN}"#,
            hex(fill),
            hex(edge)
        )
    };
    let colours = [(colour::FIXED, colour::FIXED_EDGE), (colour::MOVING, colour::MOVING_EDGE)];
    let body = format!(r#"fill="none" stroke="{SOFT}" stroke-width="1.1" stroke-dasharray="5 3" {JOIN}"#);
    for (k, half) in found.halves.iter().enumerate() {
        let own = found.bodies.as_ref().map(|bodies| &bodies[k].region.outer);
        let frame = frame(around([&half.region.outer]), rects[k], unit);
        svg.begin_clip(frame.rect);
        svg.path(&path(&frame, &half.region.inner), &style(colours[k].0, colours[k].1));
        if let Some(own) = own {
            svg.path(&path(&frame, own), &body);
        }
        robot(&mut svg, &frame, (found.settings.frames == RegionFrames::Own || k == 0).then_some(DVec2::Y));
        svg.end();
        frame.draw(&mut svg);
    }
    meeting(&mut svg, found, rects[2], unit)?;
    Ok(Picture::of(svg))
}

fn significant_area(found: &Composition, unit: &str) -> String {
    let [least, most] = found.peak.map_or([0.0; 2], |peak| [peak.value, peak.at_most]);
    format!("{} {unit}²", bracket([least, most]))
}

/// The third panel.
fn meeting(svg: &mut Svg, found: &Composition, rect: Rect, unit: &str) -> Result<(), FigureError> {
    let slice = &found.slices[found.shown];
    let own = found.bodies.as_ref().map(|bodies| &bodies[0].region.outer);
    let all = found.slices.iter().map(|slice| &slice.region.outer);
    let frame = frame(around(all), rect, unit);
    svg.begin_clip(frame.rect);
    let map = &found.map;
    if !map.values.is_empty() {
        let [x, y] = frame.at([map.low.x, map.low.y + map.cell * map.cells[1] as f64]);
        let [w, h] = map.cells.map(|n| n as f64 * map.cell * SIDE / (frame.x.hi - frame.x.lo));
        svg.image(Rect { x, y, w, h }, &image(map)?, false);
    }
    if let Some(own) = own {
        // White covers the part of the overlap that the bodies exclude.
        let covered = [slice.region.outer.bounds(), map_bounds(map)];
        if let Some([low, high]) = covered[1].or(covered[0]) {
            let taken = Region::rectangle(low, high).minus(&slice.region.outer);
            svg.path(&path(&frame, &taken), r##"fill="#ffffff" fill-rule="evenodd" stroke="none""##);
        }
        let body = format!(r#"fill="none" stroke="{SOFT}" stroke-width="1.1" stroke-dasharray="5 3" {JOIN}"#);
        svg.path(&path(&frame, own), &body);
    }
    let line = |width: f64| {
        format!(r#"fill="none" stroke="{}" stroke-width="{width}" {JOIN}"#, hex(colour::FIXED_EDGE))
    };
    if found.slices.len() > 1 {
        for end in [&found.slices[0], &found.slices[found.slices.len() - 1]] {
            svg.path(&path(&frame, &end.region.inner), &line(0.6));
        }
    }
    svg.path(&path(&frame, &slice.region.inner), &line(1.6));
    if let Some(square) = found.square {
        let h = square.side / 2.0;
        let corners = [(-h, -h), (h, -h), (h, h), (-h, h)]
            .map(|(x, y)| frame.at([square.center.x + x, square.center.y + y]));
        let style = format!(
            r#"fill="none" stroke="{}" stroke-width="1.3" stroke-dasharray="4 3""#,
            hex(colour::CURVES[1])
        );
        svg.path(&polyline(corners, true), &style);
        let [x, y] = frame.at(square.center.to_array());
        svg.circle([x, y], 2.6, &format!(r#"fill="{}""#, hex(colour::CURVES[1])));
        let name = format!("square {}", short(square.side));
        svg.text([x, y - 7.0], TICK, Anchor::Middle, INK, &name);
    }
    robot(svg, &frame, Some(DVec2::Y));
    svg.end();
    frame.draw(svg);
    Ok(())
}

fn map_bounds(map: &OverlapMap) -> Option<[DVec2; 2]> {
    let size = DVec2::new(map.cells[0] as f64, map.cells[1] as f64) * map.cell;
    (!map.values.is_empty()).then_some([map.low, map.low + size])
}
