//! Closed outlines in a plane: from loose polygons, or the curves of a drawing, to the regions that they
//! bound.
//!
//! ```text
//! SVG, DXF ──curves to chords──▶ loops ──no two cross, none open──▶ regions: an outline with its holes
//! ```
//!
//! A loop outside all others bounds a region, a loop inside it a hole, and a loop inside that hole a region
//! again; the direction in which a loop is drawn has no effect.

mod dxf;
mod svg;

use super::source::{FileBytes, UnitProblem, unit};
use catchment_base::budget::Overspent;
use catchment_base::tolerance::COINCIDENT;
use catchment_design::design::FileSpec;
use glam::DVec2;

/// Largest drawing that is read, in bytes: of outlines, megabytes are thousands of curves.
pub(super) const MOST_BYTES: u64 = 4 << 20;
/// Largest number of corners of a part's outlines: triangulating their caps takes the square of it in steps.
const MOST_CORNERS: usize = 2000;
/// Farthest from the origin that outlines may go, in D: as far as pieces may.
const REACH: f64 = 1e3;

/// Reason why outlines bound no region. Positions are in the coordinates of the drawing, or in D without a
/// drawing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OutlineProblem {
    /// There is no such file.
    #[error("there is no such file; a path is relative to the folder of the design file")]
    NoFile,
    /// Larger than a drawing of outlines.
    #[error("{bytes} bytes, more than the {MOST_BYTES} that are read: leave out what is no outline")]
    TooLarge {
        /// Size of the file.
        bytes: u64,
    },
    /// Not the type of its extension, or broken.
    #[error("line {line}: {message}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Description and advice.
        message: String,
    },
    /// Something that is drawn and not read.
    #[error("line {line}: {what} is not read: {advice}")]
    Unsupported {
        /// Line, from 1.
        line: usize,
        /// The item.
        what: String,
        /// Advice for it.
        advice: &'static str,
    },
    /// A line that does not return to its start.
    #[error("line {line}: the outline that begins at {at} is open: close it, or leave it out of the drawing")]
    Open {
        /// Line of the file, from 1.
        line: usize,
        /// Its start.
        at: DVec2,
    },
    /// Nothing closed in it.
    #[error(
        "there is no closed outline in the drawing{}",
        if *hidden > 0 { format!(", of which {hidden} hidden entities are left out: show those that are meant") } else { String::new() }
    )]
    Empty {
        /// How many entities or elements are hidden.
        hidden: usize,
    },
    /// A number that is invalid, or too large for a length.
    #[error("a coordinate is no number, or more than {REACH} D: check the unit")]
    TooFar,
    /// A loop without area.
    #[error("the outline that begins at {at} has no area")]
    Flat {
        /// Its start.
        at: DVec2,
    },
    /// Two lines cross or touch.
    #[error("the outline crosses or touches itself or another near {at}: unite what is drawn there")]
    Crossing {
        /// Position.
        at: DVec2,
    },
    /// More corners than a part may have.
    #[error("more than {MOST_CORNERS} corners: give a larger chord_error, or a simpler drawing")]
    TooMany,
    /// Corners too close to each other to be distinguished.
    #[error("the outline is too intricate to be cut into triangles: leave out its smallest details")]
    TooIntricate,
    /// More work than a drawing may take.
    #[error(transparent)]
    Overspent(#[from] Overspent),
    /// The unit of its coordinates is not known.
    #[error(transparent)]
    UnitOf(#[from] UnitProblem),
}

/// A region of the plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    /// Counter-clockwise.
    outer: Vec<DVec2>,
    /// Clockwise.
    holes: Vec<Vec<DVec2>>,
}

impl Region {
    /// Its outline and its holes.
    pub(super) fn loops(&self) -> impl Iterator<Item = &Vec<DVec2>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }
}

/// A line of a drawing, from corner to corner, in its coordinates; y up.
struct Stroke {
    corners: Vec<DVec2>,
    /// Its line in the file.
    line: usize,
}

/// Limits for every drawing, in its coordinates.
#[derive(Clone, Copy)]
struct Within {
    /// Largest distance of a curve to its chords.
    chord_error: f64,
    /// Farthest from the origin that anything may go.
    reach: f64,
}

impl Within {
    /// Chords of a full turn on a circle.
    fn chords(self, radius: f64) -> f64 {
        let half_angle = (1.0 - self.chord_error / radius.abs()).clamp(-1.0, 1.0).acos();
        (std::f64::consts::PI / half_angle).ceil().max(8.0)
    }

    /// Rejects coordinates that are too large, and too many corners.
    fn holds(self, corners: &[DVec2]) -> Result<(), OutlineProblem> {
        if !corners.iter().all(|p| p.abs().max_element() <= self.reach) {
            return Err(OutlineProblem::TooFar);
        }
        if corners.len() > MOST_CORNERS { Err(OutlineProblem::TooMany) } else { Ok(()) }
    }
}

/// The content of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DrawnLoops {
    /// Closed loops, in D.
    pub(super) loops: Vec<Vec<DVec2>>,
    /// Entities or elements, with all that is in them, that are hidden and left out.
    pub(super) hidden: usize,
}

/// The line that holds a byte of a text, from 1.
fn line_of(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count()
}

/// The closed loops of a drawing; curves are left by their chords by at most `chord_error`, in D.
pub(super) fn read(
    spec: &FileSpec,
    file: &FileBytes,
    chord_error: f64,
) -> Result<DrawnLoops, OutlineProblem> {
    if file.size > MOST_BYTES {
        return Err(OutlineProblem::TooLarge { bytes: file.size });
    }
    let text = String::from_utf8_lossy(&file.bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let is_dxf = spec.ending() == "dxf";
    let metres = if is_dxf { dxf::metres(text)? } else { svg::metres(text)? };
    let scale = unit::scale(spec, metres)?;
    let within = Within { chord_error: chord_error / scale, reach: REACH / scale };
    let (strokes, hidden) = if is_dxf { dxf::read(text, within)? } else { svg::read(text, within)? };
    if strokes.is_empty() {
        return Err(OutlineProblem::Empty { hidden });
    }
    let loops = strokes.into_iter().map(|stroke| stroke.corners.into_iter().map(|p| p * scale).collect());
    Ok(DrawnLoops { loops: loops.collect(), hidden })
}

/// The regions that loops bound.
pub(super) fn regions(loops: Vec<Vec<DVec2>>) -> Result<Vec<Region>, OutlineProblem> {
    let all = || loops.iter().flatten();
    if !all().all(|p| p.is_finite()) {
        return Err(OutlineProblem::TooFar);
    }
    let (low, high) = all().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let near = COINCIDENT * (high - low).length();
    let loops: Vec<Vec<DVec2>> = loops.into_iter().map(|ring| distinct(ring, near)).collect();
    if loops.iter().map(Vec::len).sum::<usize>() > MOST_CORNERS {
        return Err(OutlineProblem::TooMany);
    }
    if let Some(flat) = loops.iter().find(|ring| ring.len() < 3 || area(ring).abs() <= near * near) {
        return Err(OutlineProblem::Flat { at: flat.first().copied().unwrap_or_default() });
    }
    refuse_crossings(&loops, near)?;
    let inside = |k: usize, of: usize| k != of && holds(&loops[of], loops[k][0]);
    let depth: Vec<usize> =
        (0..loops.len()).map(|k| (0..loops.len()).filter(|of| inside(k, *of)).count()).collect();
    let wound = |ring: &[DVec2], forward: bool| -> Vec<DVec2> {
        if (area(ring) > 0.0) == forward { ring.to_vec() } else { ring.iter().rev().copied().collect() }
    };
    let region = |outer: usize| {
        let hole = |k: &usize| depth[*k] == depth[outer] + 1 && inside(*k, outer);
        Region {
            outer: wound(&loops[outer], true),
            holes: (0..loops.len()).filter(hole).map(|k| wound(&loops[k], false)).collect(),
        }
    };
    Ok((0..loops.len()).filter(|k| depth[*k].is_multiple_of(2)).map(region).collect())
}

/// A loop without repeated successive corners.
fn distinct(mut ring: Vec<DVec2>, near: f64) -> Vec<DVec2> {
    ring.dedup_by(|a, b| a.distance(*b) <= near);
    while ring.len() > 1 && ring[0].distance(ring[ring.len() - 1]) <= near {
        ring.pop();
    }
    ring
}

/// Signed area of a loop.
fn area(ring: &[DVec2]) -> f64 {
    // Relative to a corner: far from the origin the sum would lose its digits.
    ring.windows(2).map(|w| (w[0] - ring[0]).perp_dot(w[1] - ring[0])).sum::<f64>() / 2.0
}

/// Whether a point lies inside of a loop, by the lines to its right.
fn holds(ring: &[DVec2], p: DVec2) -> bool {
    let n = ring.len();
    let crosses = |k: &usize| {
        let (a, b) = (ring[*k], ring[(k + 1) % n]);
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    (0..n).filter(crosses).count() % 2 == 1
}

/// Every line against every other, a sweep along x.
fn refuse_crossings(loops: &[Vec<DVec2>], near: f64) -> Result<(), OutlineProblem> {
    let mut lines: Vec<(f64, [DVec2; 2], usize, usize, usize)> = Vec::new();
    for (ring, corners) in loops.iter().enumerate() {
        let n = corners.len();
        lines.extend((0..n).map(|k| {
            let ends = [corners[k], corners[(k + 1) % n]];
            (ends[0].x.min(ends[1].x), ends, ring, k, n)
        }));
    }
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (position, &(_, own, ring, k, n)) in lines.iter().enumerate() {
        let right = own[0].x.max(own[1].x) + near;
        for &(left, other, other_ring, j, _) in &lines[position + 1..] {
            if left > right {
                break;
            }
            let (next, previous) = ((k + 1) % n == j, (j + 1) % n == k);
            let at = if ring == other_ring && (next || previous) {
                // Neighbours share a corner; they may not fold back over each other.
                let (first, second) = if next { (own, other) } else { (other, own) };
                let (u, v) = (first[1] - first[0], second[1] - second[0]);
                let folded = u.dot(v) < 0.0 && u.perp_dot(v).abs() <= near * u.length().max(v.length());
                folded.then_some(first[1])
            } else {
                crossing(own, other, near)
            };
            if let Some(at) = at {
                return Err(OutlineProblem::Crossing { at });
            }
        }
    }
    Ok(())
}

/// The point at which two lines cross, or are within `near` of each other.
pub(super) fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2], near: f64) -> Option<DVec2> {
    let (u, v) = (b - a, d - c);
    let turn = u.perp_dot(v);
    if turn != 0.0 {
        let (s, t) = ((c - a).perp_dot(v) / turn, (c - a).perp_dot(u) / turn);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return Some(a + u * s);
        }
    }
    // They do not cross, so that they are nearest to each other at an end.
    let nearest = |p: DVec2, from: DVec2, along: DVec2| {
        let share = ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p.distance(from + along * share) <= near
    };
    let touches = [(a, c, v), (b, c, v), (c, a, u), (d, a, u)];
    touches.into_iter().find(|(p, from, along)| nearest(*p, *from, *along)).map(|(p, ..)| p)
}

#[cfg(test)]
mod tests;
