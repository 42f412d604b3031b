//! Jams and rests: each cut through its contacts, and in space, with the features that hold it.

use super::draw::layout::{self, Layout};
use super::draw::svg::{Anchor, INK, LABEL, Rect, SOFT, Svg, width_of};
use super::plane::{Patch, Plane};
use super::section::{MovingHalfPose, View, describe};
use super::solid::touching;
use super::{FigureError, Picture};
use crate::RestsReport;
use catchment_core::acceptance::Outcome;
use catchment_core::connector::Connector;
use catchment_core::design::Design;
use catchment_core::document::{grouped, tenths};
use catchment_core::run::jams::{FeatureContact, Jam, Jams, Stability, contacts_in_words, escape_height};
use catchment_core::run::rests::RestPlace;
use glam::{DMat3, DVec3};

/// Jams that are drawn.
const SHOWN: usize = 6;
/// How many beside each other.
const COLUMNS: usize = 2;
/// Lines of words that a panel holds beside the last.
const MOST_LINES: usize = 3;
/// A section and the view in space beside it, in SVG units, and between them.
const SIZE: [f64; 2] = [470.0, 210.0];
const SPACE: [f64; 2] = [180.0, 190.0];
const BESIDE: f64 = 20.0;
/// Room for the words above them and for those below, which begin at the label of the axis.
const WORDS: f64 = 102.0;
const CUT: f64 = 14.0;
const AXIS: f64 = 48.0;
/// How wide words may be.
const WIDTH: f64 = SIZE[0] + AXIS;

/// Content of a panel.
struct Panel<'a> {
    head: String,
    contacts: &'a [FeatureContact],
    placement: MovingHalfPose,
    /// Text below: the contacts and their positions.
    tail: Vec<String>,
}

/// Draws the jams with most of the poses: the halves of `connector` as the design places them.
///
/// # Errors
/// If nothing jams.
pub fn jams(design: &Design, found: &Jams, connector: &Connector) -> Result<Picture, FigureError> {
    if found.jams.is_empty() {
        return Err(FigureError::Empty { what: "none of the poses jams" });
    }
    let all: Vec<String> = found
        .outcomes
        .iter()
        .filter(|(_, share)| share.count > 0)
        .map(|(outcome, share)| format!("{} {}", outcome.word(), tenths(share.share)))
        .collect();
    let story = format!("rests of motions that do not dock; of the error box {}", all.join(", "));
    let panels: Vec<Panel<'_>> = found
        .jams
        .iter()
        .take(SHOWN)
        .enumerate()
        .map(|(k, jam)| jam_panel(design, found, k + 1, jam))
        .collect();
    draw_all(design, connector, &story, &panels)
}

fn jam_panel<'a>(design: &Design, found: &Jams, number: usize, jam: &'a Jam) -> Panel<'a> {
    let tail = jam.examined.map(|examined| {
        let level = match examined.stability {
            _ if examined.is_held_by_friction(found.settings.friction) => "held by friction alone",
            Stability::Level => "almost level",
            stability => stability.name(),
        };
        let way = examined
            .escape_path
            .map_or_else(String::new, |way| format!("; {}", escape_height(design, way.climb)));
        format!("{level}{way}")
    });
    Panel {
        head: format!(
            "jam {number}:  {} of jams, {} of the error box",
            tenths(jam.of_jams),
            tenths(jam.of_box.share)
        ),
        contacts: &jam.contacts,
        placement: MovingHalfPose { error: jam.pose, height: jam.height_d },
        tail: tail.into_iter().collect(),
    }
}

/// Draws the rests with the largest basins.
///
/// # Errors
/// If there are no rests.
pub fn rests(report: &RestsReport, connector: &Connector) -> Result<Picture, FigureError> {
    if report.rests.is_empty() {
        return Err(FigureError::Empty { what: "none of the poses comes to rest" });
    }
    let off: Vec<String> = report
        .outcomes
        .iter()
        .filter(|(outcome, share)| matches!(outcome, Outcome::Missed | Outcome::Undecided) && share.count > 0)
        .map(|(outcome, share)| format!(", {} {}", outcome.word(), tenths(share.share)))
        .collect();
    let story = format!(
        "rests under a load along −z, from {} random poses of the error box{}",
        grouped(report.motions),
        off.concat()
    );
    let panels: Vec<Panel<'_>> = report
        .rests
        .iter()
        .take(SHOWN)
        .enumerate()
        .map(|(k, rest)| rest_panel(report, k + 1, rest))
        .collect();
    draw_all(&report.design, connector, &story, &panels)
}

fn rest_panel<'a>(report: &RestsReport, number: usize, rest: &'a RestPlace) -> Panel<'a> {
    let docked = if rest.is_docked() { ", docked" } else { "" };
    let mut tail = Vec::new();
    if let Some(examined) = &rest.examined {
        tail.extend(examined.immobility.map(|held| held.words()));
        tail.push(report.escape_path(&report.design, rest));
    }
    Panel {
        head: format!("rest {number}:  basin {} of the error box{docked}", tenths(rest.of_box.share)),
        contacts: &rest.contacts,
        placement: MovingHalfPose { error: rest.pose, height: rest.height_d },
        tail,
    }
}

fn draw_all(
    design: &Design,
    connector: &Connector,
    story: &str,
    panels: &[Panel<'_>],
) -> Result<Picture, FigureError> {
    let broken = broken(story, panels.len().min(COLUMNS) as f64 * WIDTH);
    let layout = broken.into_iter().fold(Layout::of(design), Layout::story);
    let frame = || layout::Panel::with_axes(SIZE).with_room([0.0, WORDS, 0.0, CUT]);
    let (mut svg, frames) = layout.grid(COLUMNS, panels.iter().map(|_| frame())).open();
    for (panel, frame) in panels.iter().zip(frames) {
        draw(&mut svg, frame, design, connector, panel)?;
    }
    Ok(Picture::of(svg))
}

fn draw(
    svg: &mut Svg,
    rect: Rect,
    design: &Design,
    connector: &Connector,
    shown: &Panel<'_>,
) -> Result<(), FigureError> {
    let placement = shown.placement;
    let [x, y] = [rect.x - AXIS, rect.y - WORDS];
    svg.bold([x, y + LABEL], LABEL + 1.0, Anchor::Start, &shown.head);
    let mut lines: Vec<(&str, String)> = Vec::new();
    for words in contacts_in_words(shown.contacts) {
        lines.extend(broken(&words, WIDTH).into_iter().map(|line| (INK, line)));
    }
    let most = MOST_LINES + 1 - shown.tail.len().clamp(1, MOST_LINES);
    if lines.len() > most {
        lines.truncate(most);
        if let Some((_, last)) = lines.last_mut() {
            last.push_str(" …");
        }
    }
    lines.push((SOFT, describe(design, &placement)));
    lines.extend(shown.tail.iter().map(|words| (SOFT, words.clone())));
    for (k, (colour, words)) in lines.iter().enumerate() {
        svg.text([x, y + 29.0 + 15.0 * k as f64], LABEL - 0.5, Anchor::Start, colour, words);
    }
    let placed = placement.of(design);
    let patches: Vec<Patch> = shown.contacts.iter().map(|contact| patch(contact, placed)).collect();
    let plane = Plane::showing(design, connector, &placement, &patches);
    let view = View::along(design, connector, std::slice::from_ref(&placement), plane)?;
    let frame = view.frame(Rect { w: SIZE[0] - SPACE[0] - BESIDE, ..rect });
    view.halves(svg, &frame, &placement);
    svg.begin_clip(frame.rect);
    view.contacts(svg, &frame, &patches);
    svg.end();
    frame.draw(svg);
    if let Some(words) = view.words() {
        svg.text([rect.x, rect.y + rect.h + 48.0], LABEL - 2.0, Anchor::Start, SOFT, &words);
    }
    let space = Rect { x: rect.x + rect.w - SPACE[0], w: SPACE[0], h: SPACE[1], ..rect };
    let points: Vec<DVec3> = patches.into_iter().flat_map(|patch| patch.points).collect();
    touching(svg, space, design, connector, &placement, &points)
}

fn patch(contact: &FeatureContact, placed: (DMat3, DVec3)) -> Patch {
    let points = contact.points_d.iter().copied().map(DVec3::from_array).collect();
    Patch::new(points, DVec3::from_array(contact.normal), placed)
}

/// Words in lines no wider than this, in SVG units.
fn broken(words: &str, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split_whitespace() {
        let last = lines.len() - 1;
        let longer = if lines[last].is_empty() { word.to_owned() } else { format!("{} {word}", lines[last]) };
        if width_of(&longer, LABEL - 0.5) > width && !lines[last].is_empty() {
            lines.push(word.to_owned());
        } else {
            lines[last] = longer;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;
    use catchment_core::design::read;
    use catchment_core::exec::Exec;
    use catchment_core::problem::Problem;
    use catchment_core::run::jams::{JamsSettings, run};
    use std::path::Path;

    fn drawn(text: &str) -> Result<Picture, FigureError> {
        let problem = Problem::of(read(text, Path::new("")).unwrap().design).unwrap();
        let found =
            run(&problem, &JamsSettings { motions: Some(400), ..JamsSettings::default() }, &Exec::new())
                .unwrap();
        jams(problem.design(), &found, problem.connector())
    }

    #[test]
    fn every_jam_is_drawn_with_its_contacts() {
        let text = "[connector]\nfamily = \"v-face\"\nwidth = 50\nunit = \"mm\"\n[alignment]\nrotation_length = 1.0\n";
        let picture = drawn(text).unwrap();
        look("jams", &picture);
        assert!(picture.svg().contains("of the fixed one"));
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\naspect_ratio = 0.5\n";
        look("jams-pyramid", &drawn(text).unwrap());
    }

    #[test]
    fn every_rest_is_drawn() {
        use catchment_core::run::rests;
        let text = "[connector]\nfamily = \"v-face\"\nwidth = 50\nunit = \"mm\"\n[alignment]\nrotation_length = 1.0\n";
        let problem = Problem::of(read(text, Path::new("")).unwrap().design).unwrap();
        let settings = rests::RestsSettings { motions: Some(400), ..rests::RestsSettings::default() };
        let found = rests::run(&problem, &settings, &Exec::new()).unwrap();
        let report = RestsReport::new(problem.design(), found, Vec::new(), None);
        let picture = super::rests(&report, problem.connector()).unwrap();
        look("rests", &picture);
        assert!(picture.svg().contains("first-order immobile"));
    }

    #[test]
    fn where_nothing_jams_there_is_nothing_to_draw() {
        let text = "[connector]\nfamily = \"pyramid\"\n[alignment]\nfree = [\"x\", \"y\"]\n[errors]\nx = 0.1\ny = 0.1\n";
        assert!(matches!(drawn(text), Err(FigureError::Empty { .. })));
    }
}
