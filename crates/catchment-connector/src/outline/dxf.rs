//! The closed outlines of a DXF drawing: its visible lines, arcs, circles and polylines.
//!
//! ```text
//!   0            a group code and a value, a line each
//! LINE
//!  10            10, 20: start; 11, 21: end
//! 0.0
//! ```
//!
//! Entities on layers that are off or frozen, invisible entities (group 60), and those of paper space (group
//! 67) are counted and skipped. Lines, arcs and open polylines are joined if their ends meet. Text,
//! dimensions, points and hatches are not outlines and are skipped; blocks, splines and ellipses are
//! rejected. The reader is our own because it reports the line of every defect and uses no more memory than
//! the text.

use super::{OutlineProblem, Stroke, Within};
use catchment_base::tolerance::COINCIDENT;
use glam::DVec2;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Entities that are no outlines.
const LEFT_OUT: [&str; 15] = [
    "TEXT",
    "MTEXT",
    "DIMENSION",
    "POINT",
    "HATCH",
    "VIEWPORT",
    "LEADER",
    "MULTILEADER",
    "MLEADER",
    "ATTDEF",
    "ATTRIB",
    "XLINE",
    "RAY",
    "TOLERANCE",
    "SEQEND",
];
/// Flags of polylines and their vertices (group 70).
const CLOSED: i64 = 1;
const MESH: i64 = 16;
const CONTROL_POINT: i64 = 16;
const POLYFACE: i64 = 64;
/// Metres in the units of `$INSUNITS`, by their numbers.
const UNITS: [(i64, f64); 6] = [(1, 0.0254), (2, 0.3048), (4, 1e-3), (5, 1e-2), (6, 1.0), (13, 1e-6)];

/// A group: its code, its value, and the line of the code.
#[derive(Clone, Copy)]
struct Group<'t> {
    code: i64,
    value: &'t str,
    line: usize,
}

impl Group<'_> {
    fn number(self) -> Result<f64, OutlineProblem> {
        let number: Option<f64> = self.value.parse().ok();
        number.filter(|number| number.is_finite()).ok_or_else(|| OutlineProblem::Syntax {
            line: self.line + 1,
            message: "expected a number: the DXF file is broken, export it again".to_owned(),
        })
    }
}

fn groups(text: &str) -> impl Iterator<Item = Result<Group<'_>, OutlineProblem>> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (number, code) = lines.next()?;
        let broken = |message: &str| {
            Some(Err(OutlineProblem::Syntax { line: number + 1, message: message.to_owned() }))
        };
        if number == 0 && code.starts_with("AutoCAD Binary DXF") {
            return broken("this is a binary DXF file: export it as ASCII DXF");
        }
        let Ok(code) = code.trim().parse() else {
            let blank = code.trim().is_empty() && lines.clone().all(|(_, line)| line.trim().is_empty());
            return if blank {
                None
            } else {
                broken("expected a group code: this is no ASCII DXF file, or it is broken")
            };
        };
        let Some((_, value)) = lines.next() else { return broken("the DXF file was cut off") };
        Some(Ok(Group { code, value: value.trim(), line: number + 1 }))
    })
}

/// Metres per unit of the drawing's coordinates, if it states a unit.
pub(super) fn metres(text: &str) -> Result<Option<f64>, OutlineProblem> {
    let mut is_next = false;
    for group in groups(text) {
        let group = group?;
        if is_next {
            let unit: Option<i64> = group.value.parse().ok();
            return Ok(UNITS.iter().find(|(number, _)| Some(*number) == unit).map(|(_, metres)| *metres));
        }
        is_next = group.code == 9 && group.value == "$INSUNITS";
    }
    Ok(None)
}

/// Layers that are off or frozen, by their names in capitals: case does not count.
fn hidden_layers(text: &str) -> Result<BTreeSet<String>, OutlineProblem> {
    let (mut hidden, mut section, mut entity, mut name) = (BTreeSet::new(), "", "", String::new());
    for group in groups(text) {
        let group = group?;
        match (group.code, entity) {
            (0, _) if group.value == "ENDSEC" => (section, entity) = ("", ""),
            (0, _) => entity = group.value,
            (2, "SECTION") => section = group.value,
            (2, "LAYER") => name = group.value.to_uppercase(),
            _ => {}
        }
        if section == "ENTITIES" {
            break;
        }
        let is_layer = section == "TABLES" && entity == "LAYER";
        let is_off = group.code == 62 && is_layer && group.number()? < 0.0;
        let is_frozen = group.code == 70 && is_layer && group.number()? as i64 & 1 == 1;
        if is_off || is_frozen {
            hidden.insert(name.clone());
        }
    }
    Ok(hidden)
}

/// The closed outlines of a drawing, and how many of its entities are hidden.
pub(super) fn read(text: &str, within: Within) -> Result<(Vec<Stroke>, usize), OutlineProblem> {
    let layers = hidden_layers(text)?;
    let (mut loops, mut open, mut hidden) = (Vec::new(), Vec::new(), 0);
    let (mut section, mut last_line) = ("", 1);
    let mut entity: Vec<Group<'_>> = Vec::new();
    let mut polyline: Option<Entity<'_>> = None;
    let mut corners = 0;
    let mut groups = groups(text).peekable();
    while let Some(group) = groups.next() {
        let group = group?;
        last_line = group.line;
        if group.code == 2 && entity.len() == 1 && entity[0].value == "SECTION" {
            section = group.value;
        }
        entity.push(group);
        let is_last = match groups.peek() {
            Some(Ok(next)) => next.code == 0,
            _ => true,
        };
        if !is_last {
            continue;
        }
        let own = std::mem::take(&mut entity);
        let name = own[0].value;
        if let Some(polyline) = polyline.as_ref().filter(|_| !["VERTEX", "SEQEND"].contains(&name)) {
            return Err(broken(polyline.line, "the POLYLINE has no SEQEND"));
        }
        if name == "ENDSEC" {
            section = "";
        }
        if section != "ENTITIES" || name == "SECTION" {
            continue;
        }
        let read = Entity::of(&own)?;
        let is_hidden = read.is_hidden || layers.contains(&read.layer.to_uppercase());
        let done = match name {
            // The head of a polyline decides whether it is drawn.
            "POLYLINE" => {
                polyline = Some(Entity { is_hidden, ..read });
                None
            }
            "VERTEX" => {
                let Some(polyline) = &mut polyline else {
                    return Err(broken(own[0].line, "a VERTEX belongs to no POLYLINE"));
                };
                // Control points of a curve are not on it.
                if !read.has_flag(CONTROL_POINT) {
                    polyline.points.extend(read.points);
                }
                None
            }
            "SEQEND" => polyline.take().map(|polyline| (polyline.is_hidden, polyline)),
            name if LEFT_OUT.contains(&name) => None,
            _ => Some((is_hidden, read)),
        };
        let Some((is_hidden, done)) = done else { continue };
        if is_hidden {
            hidden += 1;
            continue;
        }
        let line = done.line;
        let (points, is_closed) = done.drawn(within)?;
        corners += points.len();
        within.holds(&points)?;
        if corners > super::MOST_CORNERS {
            return Err(OutlineProblem::TooMany);
        }
        if points.len() < 2 {
            continue;
        }
        let stroke = Stroke { corners: points, line };
        if is_closed { loops.push(stroke) } else { open.push(stroke) }
    }
    if section == "ENTITIES" {
        return Err(broken(last_line, "the DXF file was cut off among its entities"));
    }
    loops.extend(joined(open)?);
    Ok((loops, hidden))
}

fn broken(line: usize, what: &str) -> OutlineProblem {
    OutlineProblem::Syntax { line, message: format!("{what}: the DXF file is broken, export it again") }
}

/// The values in the groups of an entity.
#[derive(Default)]
struct Entity<'t> {
    name: &'t str,
    layer: &'t str,
    line: usize,
    start: DVec2,
    end: DVec2,
    radius: f64,
    /// In degrees.
    angles: [f64; 2],
    flags: i64,
    /// Invisible, or on a sheet of paper.
    is_hidden: bool,
    /// Seen from below: x is mirrored.
    is_mirrored: bool,
    /// Corners with their bulges: the tangent of a quarter of the arc that follows.
    points: Vec<(DVec2, f64)>,
}

impl<'t> Entity<'t> {
    fn of(groups: &[Group<'t>]) -> Result<Self, OutlineProblem> {
        let (name, line) = (groups[0].value, groups[0].line);
        let mut entity = Self { name, line, ..Self::default() };
        let has_points = ["LWPOLYLINE", "VERTEX"].contains(&name);
        let (mut tilt, mut count, mut ys) = (0.0f64, None, 0);
        for group in &groups[1..] {
            match (group.code, entity.points.last_mut()) {
                (8, _) => entity.layer = group.value,
                (60 | 67, _) => entity.is_hidden |= group.number()? != 0.0,
                (10, _) if has_points => {
                    if ys < entity.points.len() {
                        return Err(broken(group.line, "a corner has no y (group 20)"));
                    }
                    entity.points.push((DVec2::new(group.number()?, 0.0), 0.0));
                }
                (20, Some((point, _))) => {
                    point.y = group.number()?;
                    ys += 1;
                }
                (42, Some((_, bulge))) => *bulge = group.number()?,
                (90, _) if name == "LWPOLYLINE" => count = Some(group.number()?),
                (10, _) => entity.start.x = group.number()?,
                (20, _) => entity.start.y = group.number()?,
                (11, _) => entity.end.x = group.number()?,
                (21, _) => entity.end.y = group.number()?,
                (40, _) => entity.radius = group.number()?,
                (50, _) => entity.angles[0] = group.number()?,
                (51, _) => entity.angles[1] = group.number()?,
                (70, _) => entity.flags = group.number()? as i64,
                (210 | 220, _) => tilt = tilt.max(group.number()?.abs()),
                (230, _) => entity.is_mirrored = group.number()? < 0.0,
                _ => {}
            }
        }
        let needed: &[i64] = match name {
            "LINE" => &[10, 20, 11, 21],
            "CIRCLE" => &[10, 20, 40],
            "ARC" => &[10, 20, 40, 50, 51],
            "VERTEX" => &[10, 20],
            _ => &[],
        };
        let missing = needed.iter().find(|code| !groups.iter().any(|group| group.code == **code));
        if let Some(code) = missing {
            return Err(broken(line, &format!("{name} has no group {code}")));
        }
        if ys != entity.points.len() {
            return Err(broken(line, &format!("{name} has {} x and {ys} y of corners", entity.points.len())));
        }
        if let Some(count) = count.filter(|count| *count != entity.points.len() as f64) {
            let what = format!("{name} announces {count} corners and has {}", entity.points.len());
            return Err(broken(line, &what));
        }
        if ["CIRCLE", "ARC"].contains(&name) && entity.radius <= 0.0 {
            return Err(broken(line, &format!("{name} has the radius {}", entity.radius)));
        }
        if tilt > COINCIDENT.sqrt() && !entity.is_hidden {
            let advice = "draw all outlines in the x-y plane";
            let what = "an outline in a tilted plane".to_owned();
            return Err(OutlineProblem::Unsupported { line, what, advice });
        }
        // Lines alone are in the coordinates of the drawing, whichever way they face.
        entity.is_mirrored &= name != "LINE";
        Ok(entity)
    }

    const fn has_flag(&self, flag: i64) -> bool {
        self.flags & flag != 0
    }

    /// Its corners, and whether they close.
    fn drawn(self, within: Within) -> Result<(Vec<DVec2>, bool), OutlineProblem> {
        let is_mesh = self.name == "POLYLINE" && self.has_flag(MESH | POLYFACE);
        match self.name {
            "POLYLINE" | "LWPOLYLINE" if !is_mesh => self.polyline(within),
            "LINE" => Ok((vec![self.start, self.end], false)),
            "ARC" => Ok((self.arc(within), false)),
            "CIRCLE" => Ok((self.circle(within), true)),
            name => {
                let what =
                    catchment_design::design::shortened(if is_mesh { "a mesh of polylines" } else { name });
                let advice = "explode blocks and turn curves into polylines or arcs before exporting";
                Err(OutlineProblem::Unsupported { line: self.line, what, advice })
            }
        }
    }

    fn placed(&self, points: Vec<DVec2>) -> Vec<DVec2> {
        if !self.is_mirrored {
            return points;
        }
        points.into_iter().map(|p| DVec2::new(-p.x, p.y)).collect()
    }

    fn on_circle(&self, from: f64, turn: f64, chords: f64) -> Vec<DVec2> {
        let count = chords.min(2.0 * super::MOST_CORNERS as f64) as usize;
        let at = |k| self.start + self.radius * DVec2::from_angle(from + turn * k as f64 / count as f64);
        self.placed((0..=count).map(at).collect())
    }

    fn circle(&self, within: Within) -> Vec<DVec2> {
        let mut points = self.on_circle(0.0, TAU, (within.chords(self.radius) / 4.0).ceil() * 4.0);
        points.pop();
        points
    }

    fn arc(&self, within: Within) -> Vec<DVec2> {
        let [from, to] = self.angles.map(f64::to_radians);
        let turn = (to - from).rem_euclid(TAU);
        self.on_circle(from, turn, (within.chords(self.radius) * turn / TAU).ceil().max(1.0))
    }

    fn polyline(self, within: Within) -> Result<(Vec<DVec2>, bool), OutlineProblem> {
        let n = self.points.len();
        let mut corners = Vec::new();
        for k in 0..n {
            let ((from, bulge), (to, _)) = (self.points[k], self.points[(k + 1) % n]);
            corners.push(from);
            if bulge == 0.0 || (k + 1 == n && !self.has_flag(CLOSED)) || from == to {
                continue;
            }
            // The centre lies on the bisector of the chord, the arc turns by four times the angle whose tangent the bulge is.
            let turn = 4.0 * bulge.atan();
            let center = from.midpoint(to) + (to - from).perp() * (1.0 - bulge * bulge) / (4.0 * bulge);
            let radius = center.distance(from);
            let chords = (within.chords(radius) * turn.abs() / TAU).ceil().max(1.0);
            let count = chords.min(2.0 * super::MOST_CORNERS as f64) as usize;
            let at =
                |k: usize| center + DVec2::from_angle(turn * k as f64 / count as f64).rotate(from - center);
            corners.extend((1..count).map(at));
            if corners.len() > super::MOST_CORNERS {
                return Err(OutlineProblem::TooMany);
            }
        }
        let is_closed = self.has_flag(CLOSED);
        Ok((self.placed(corners), is_closed))
    }
}

/// Loops from lines whose ends meet.
fn joined(mut open: Vec<Stroke>) -> Result<Vec<Stroke>, OutlineProblem> {
    let size = open.iter().flat_map(|s| &s.corners).fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    // Ends that were rounded to six digits meet.
    let near = 1e3 * COINCIDENT * size;
    let mut loops = Vec::new();
    while let Some(Stroke { mut corners, line }) = open.pop() {
        loop {
            let (first, last) = (corners[0], corners[corners.len() - 1]);
            if corners.len() > 2 && first.distance(last) <= near {
                corners.pop();
                loops.push(Stroke { corners, line });
                break;
            }
            let meets = |s: &Stroke| {
                let ends = [s.corners[0], s.corners[s.corners.len() - 1]];
                ends.iter().position(|end| end.distance(last) <= near)
            };
            let next = open.iter().enumerate().find_map(|(k, s)| Some((k, meets(s)?)));
            let Some((k, end)) = next else { return Err(OutlineProblem::Open { line, at: first }) };
            let mut next = open.swap_remove(k).corners;
            if end == 1 {
                next.reverse();
            }
            corners.extend(next.into_iter().skip(1));
        }
    }
    Ok(loops)
}
