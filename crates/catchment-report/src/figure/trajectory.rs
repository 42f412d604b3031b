//! A motion: the trajectory of the moving half in section, and its remaining errors.

use super::draw::axis::{AxisScale, PlotFrame, ShownUnits};
use super::draw::colour::{self, hex};
use super::draw::layout::{Layout, Legend, Panel, stacked, stroked};
use super::draw::svg::{Anchor, INK, JOIN, LABEL, Rect, SOFT, Svg, polyline};
use super::plane::{Patch, Plane};
use super::section::{MovingHalfPose, View, approach_axis, describe};
use super::solid::touching;
use super::{FigureError, Picture};
use catchment_core::acceptance::Outcome;
use catchment_core::connector::Connector;
use catchment_core::design::Design;
use catchment_core::method::descent::{Trajectory, Waypoint};
use catchment_core::pose::Dof;
use glam::DVec3;

/// Ghosts of the moving half, the first and the last pose included.
const GHOSTS: usize = 7;

/// Draws a trajectory: left the section with the moving half ghosted along its path, cut through the contacts
/// at its end for a jam, else through the first contacts; right its errors over the path length (in the
/// ρ-metric, D). If it moves out of a plane, in between, both halves in space at first contact and at the
/// end. ● and ○ are contacts.
///
/// # Errors
/// If the halves never met, so that there is no path.
pub fn trajectory(design: &Design, connector: &Connector, path: &Trajectory) -> Result<Picture, FigureError> {
    let Some((first, last)) = path.waypoints.first().zip(path.waypoints.last()) else {
        return Err(FigureError::Empty { what: "the halves never met, there is no path" });
    };
    let ghosts = ghosts(&path.waypoints);
    let placements: Vec<MovingHalfPose> = ghosts.iter().map(|w| placed(w)).collect();
    let meeting = path.waypoints.iter().find(|w| !w.touches.is_empty()).unwrap_or(first);
    // A half that docks has contacts all around at its end, and a half that misses has none, so only a jam is
    // shown at its end.
    let jams = path.outcome == Outcome::Jammed;
    let shown = if jams { last } else { meeting };
    let patches = patches(design, shown);
    let plane = Plane::showing(design, connector, &placed(shown), &patches);
    let view = View::along(design, connector, &placements, plane)?;
    let is_planar = is_planar(design);
    let height = 400.0;
    let mut section = Panel::with_axes([430.0, height]);
    if !patches.is_empty() {
        let when = if jams { "contacts where it jams" } else { "where it first touches" };
        let words = view.words().map_or_else(|| when.to_owned(), |cut| format!("{when}; {cut}"));
        section = section.under(Legend::titled(&format!("● {words}")));
    }
    let space = Panel::of([if is_planar { 0.0 } else { SPACE }, height]);
    // Over each chart of errors stand their names.
    let errors_left = Panel::with_axes([340.0, height]).with_room([0.0, NAMES, 0.0, 0.0]);
    let story = format!("from {} → {}", describe(design, &placed(first)), path.outcome.word());
    let (mut svg, frames) = Layout::of(design).story(story).row([section, space, errors_left]).open();
    let frame = view.frame(frames[0]);
    svg.begin_clip(frame.rect);
    approach_axis(&mut svg, &frame);
    view.fixed(&mut svg, &frame);
    for (k, placement) in placements.iter().enumerate() {
        let age = k as f64 / (placements.len() - 1).max(1) as f64;
        svg.begin_opacity(if k + 1 == placements.len() { 0.92 } else { 0.16 + 0.22 * age });
        view.moving(&mut svg, &frame, placement);
        svg.end();
    }
    let trace = path.waypoints.iter().map(|w| {
        let (_, face) = placed(w).of(design);
        view.seen(&frame, face)
    });
    svg.path(&polyline(trace, false), &format!(r#"fill="none" stroke="{INK}" stroke-width="1.6" {JOIN}"#));
    for (w, radius) in [(first, 2.6), (last, 3.6)] {
        let (_, face) = placed(w).of(design);
        svg.circle(view.seen(&frame, face), radius, &format!(r#"fill="{INK}""#));
    }
    view.contacts(&mut svg, &frame, &patches);
    svg.end();
    frame.draw(&mut svg);
    if !is_planar {
        let views = [("where it first touches", meeting), ("at its end", last)];
        for ((when, waypoint), rect) in views.into_iter().zip(stacked(frames[1], 2, 2.0 * NAMES)) {
            svg.text([rect.x, rect.y - 8.0], LABEL, Anchor::Start, INK, when);
            let points: Vec<DVec3> = waypoint.touches.iter().map(|touch| touch.point).collect();
            touching(&mut svg, rect, design, connector, &placed(waypoint), &points)?;
        }
    }
    errors(&mut svg, design, &path.waypoints, frames[2]);
    Ok(Picture::of(svg))
}

/// Room for the names over a chart or a view.
const NAMES: f64 = 20.0;

/// How wide the halves are drawn in space, in SVG units.
const SPACE: f64 = 280.0;

/// Whether all motion is in the plane of x and pitch.
fn is_planar(design: &Design) -> bool {
    design.alignment.free.iter().all(|dof| matches!(dof, Dof::X | Dof::Pitch))
}

const fn placed(w: &Waypoint) -> MovingHalfPose {
    MovingHalfPose { error: w.error, height: w.height }
}

/// The contacts: points with the same normal belong to a face or edge.
fn patches(design: &Design, waypoint: &Waypoint) -> Vec<Patch> {
    /// Cosine of a fiftieth of a degree.
    const SAME: f64 = 1.0 - 1e-7;
    let mut patches: Vec<(DVec3, Vec<DVec3>)> = Vec::new();
    for touch in &waypoint.touches {
        match patches.iter_mut().find(|(normal, _)| normal.dot(touch.normal) > SAME) {
            Some((_, points)) => points.push(touch.point),
            None => patches.push((touch.normal, vec![touch.point])),
        }
    }
    let at = placed(waypoint).of(design);
    patches.into_iter().map(|(normal, points)| Patch::new(points, normal, at)).collect()
}

/// Waypoints evenly spaced along the path.
fn ghosts(waypoints: &[Waypoint]) -> Vec<&Waypoint> {
    let total = waypoints.last().map_or(0.0, |w| w.travelled);
    let mut chosen: Vec<usize> = (0..GHOSTS)
        .map(|k| total * k as f64 / (GHOSTS - 1) as f64)
        .map(|s| waypoints.partition_point(|w| w.travelled < s).min(waypoints.len() - 1))
        .collect();
    chosen.push(waypoints.len() - 1);
    chosen.dedup();
    chosen.into_iter().map(|k| &waypoints[k]).collect()
}

/// A path is drawn over so much at least, in D: that of a half which does not move has no length.
const SHORT: f64 = 1e-3;

/// Lengths above, angles below, over a common path length.
fn errors(svg: &mut Svg, design: &Design, waypoints: &[Waypoint], rect: Rect) {
    let units = ShownUnits::of(design);
    let moves = |dof: &Dof| {
        design.alignment.free.contains(*dof)
            || waypoints.iter().any(|w| w.error.to_array()[dof.index()].abs() > 1e-9)
    };
    let (angles, lengths): (Vec<Dof>, Vec<Dof>) =
        Dof::ALL.into_iter().filter(moves).partition(|dof| dof.is_rotation());
    let groups: Vec<Vec<Dof>> = [lengths, angles].into_iter().filter(|g| !g.is_empty()).collect();
    let travelled = waypoints.last().map_or(0.0, |w| w.travelled).max(SHORT);
    // Between two charts: an axis, and names.
    for (group, rect) in groups.iter().zip(stacked(rect, groups.len(), 46.0 + NAMES)) {
        let angle = group[0].is_rotation();
        let factor = units.factor(group[0]);
        let values = |dof: Dof| waypoints.iter().map(move |w| w.error.to_array()[dof.index()] * factor);
        let (lo, hi) = group
            .iter()
            .flat_map(|d| values(*d))
            .fold((0.0f64, 0.0f64), |(lo, hi), v| (lo.min(v), hi.max(v)));
        let margin = 0.08 * (hi - lo).max(1e-6 * factor);
        let label = if angle { "angle [deg]".to_owned() } else { units.length("offset", 0.0, 0.0).label };
        let frame = PlotFrame {
            rect,
            x: AxisScale::new("path length [D]".to_owned(), 0.0, travelled, false),
            y: AxisScale::new(label, lo - margin, hi + margin, angle),
        };
        let zero = frame.py(0.0);
        let dotted = format!(r#"stroke="{SOFT}" stroke-width="0.9" stroke-dasharray="2 3""#);
        svg.line([rect.x, zero], [rect.x + rect.w, zero], &dotted);
        svg.begin_clip(frame.rect);
        for dof in group {
            let points = waypoints.iter().zip(values(*dof)).map(|(w, v)| frame.at([w.travelled, v]));
            let stroke = hex(colour::CURVES[dof.index()]);
            if let [point] = points.clone().collect::<Vec<_>>()[..] {
                svg.circle(point, 3.0, &format!(r#"fill="{stroke}""#));
            }
            svg.path(
                &polyline(points, false),
                &format!(r#"fill="none" stroke="{stroke}" stroke-width="2" {JOIN}"#),
            );
        }
        svg.end();
        frame.draw(svg);
        legend(group, waypoints, &units).draw(svg, [rect.x, rect.y - 8.0]);
    }
}

/// Names of the curves with the error that is left, above their frame.
fn legend(group: &[Dof], waypoints: &[Waypoint], units: &ShownUnits) -> Legend {
    group.iter().fold(Legend::default(), |legend, dof| {
        let left = waypoints.last().map_or(0.0, |w| w.error.to_array()[dof.index()]);
        let words = format!("{} left", units.value(*dof, left));
        legend.line(stroked(colour::CURVES[dof.index()], 2.4), words)
    })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{look, v_face};
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::acceptance::Outcome;
    use catchment_core::pose::PoseError;

    fn path() -> Trajectory {
        let waypoint = |k: u32| {
            let s = f64::from(k) / 40.0;
            let left = 1.0 - s;
            let error = PoseError { x: 0.35 * left, pitch: 0.45 * left * left, ..PoseError::default() };
            Waypoint { error, height: 0.45 * left, travelled: 0.6 * s, touches: Vec::new() }
        };
        Trajectory { waypoints: (0..=40).map(waypoint).collect(), outcome: Outcome::Aligned }
    }

    #[test]
    fn a_path_is_drawn_with_its_errors() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let picture = trajectory(&design, &v_face(), &path()).unwrap();
        look("trajectory", &picture);
        assert!(picture.svg().contains("from x = 17.5 mm, pitch = 25.8° → docked"));
        assert!(picture.svg().contains("pitch = 0° left"));
    }

    #[test]
    fn ghosts_span_the_path() {
        let path = path();
        let shown: Vec<f64> = ghosts(&path.waypoints).iter().map(|w| w.travelled).collect();
        assert_eq!(shown.len(), GHOSTS);
        assert_eq!((shown[0], shown[GHOSTS - 1]), (0.0, 0.6));
        assert_eq!(ghosts(&path.waypoints[..1]).len(), 1);
    }

    #[test]
    fn a_miss_has_no_path() {
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let missed = Trajectory { waypoints: Vec::new(), outcome: Outcome::Missed };
        assert!(matches!(trajectory(&design, &v_face(), &missed), Err(FigureError::Empty { .. })));
    }
}
