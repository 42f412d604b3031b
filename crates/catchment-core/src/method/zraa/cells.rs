//! The upper envelope of the sheets as convex cells that tile the plane, with the neighbours across each
//! border.

use super::polygon_index::PolygonIndex;
use super::sheet::{Sheet, area};
use crate::exec::{Cancelled, Exec};
use glam::DVec2;

/// Cells smaller than this square of the seam's width, in multiples of the seam, are rounding.
const SLIVER: f64 = 10.0;

/// A convex cell in which a given sheet is the highest.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// Corners, counter-clockwise.
    pub(super) polygon: Vec<DVec2>,
    /// Which sheet.
    pub(super) sheet: usize,
}

/// Part of a cell's border with at most one neighbour across it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Border {
    /// From here, counter-clockwise around the cell,
    pub(super) from: DVec2,
    /// to here.
    pub(super) to: DVec2,
    /// The cell across; `None` if the halves pass each other by.
    pub(super) across: Option<usize>,
}

impl Border {
    pub(super) fn midpoint(&self) -> DVec2 {
        self.from.midpoint(self.to)
    }
}

/// The upper envelope of the sheets: every sheet keeps the region in which no other is higher.
pub(super) fn upper_envelope(sheets: &[Sheet], seam: f64, exec: &Exec) -> Result<Vec<Cell>, Cancelled> {
    let seen = seen(sheets, exec)?;
    let places = PolygonIndex::new(seen.iter().map(|i| &sheets[*i].footprint[..]), 0.0);
    let parts = exec.map(seen.len(), |k| {
        let polygons = uncovered(seen[k], &seen, sheets, &places, seam);
        polygons.into_iter().map(|polygon| Cell { polygon, sheet: seen[k] }).collect::<Vec<_>>()
    })?;
    Ok(parts.into_iter().flatten().collect())
}

/// The sheets that are not hidden by a single other sheet, ascending: about one in ten for pins and holes.
///
/// A sheet is hidden if another reaches over all its corners and is nowhere lower there; of two equal sheets
/// the first is visible. Only the sheet that is the highest over the middle is tried.
fn seen(sheets: &[Sheet], exec: &Exec) -> Result<Vec<usize>, Cancelled> {
    let places = PolygonIndex::new(sheets.iter().map(|sheet| &sheet.footprint[..]), 0.0);
    let is_seen = |i: usize| {
        let own = &sheets[i];
        let middle = own.footprint.iter().sum::<DVec2>() / own.footprint.len() as f64;
        let above = |j: usize| (sheets[j].height(middle), std::cmp::Reverse(j));
        let order = |a: &(f64, std::cmp::Reverse<usize>), b: &(f64, std::cmp::Reverse<usize>)| {
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
        };
        let top = places
            .near(&[middle])
            .filter(|j| *j != i && holds(&sheets[*j].footprint, middle))
            .map(above)
            .max_by(order);
        let hidden = top.is_some_and(|(_, std::cmp::Reverse(j))| {
            let other = &sheets[j];
            let steps = own.footprint.iter().map(|p| other.height(*p) - own.height(*p));
            let (least, most) = steps.fold((f64::INFINITY, 0.0f64), |(lo, hi), d| (lo.min(d), hi.max(d)));
            least >= 0.0 && (most > 0.0 || j < i) && own.footprint.iter().all(|p| holds(&other.footprint, *p))
        });
        !hidden
    };
    let seen = exec.map(sheets.len(), is_seen)?;
    Ok((0..sheets.len()).filter(|i| seen[*i]).collect())
}

/// Whether a point lies in a convex polygon or on its border.
fn holds(polygon: &[DVec2], at: DVec2) -> bool {
    (0..polygon.len())
        .all(|k| (polygon[(k + 1) % polygon.len()] - polygon[k]).perp_dot(at - polygon[k]) >= 0.0)
}

/// The region of a sheet in which no other is higher. Sheets that lie highest over its middle are tried
/// first, because little remains after them.
fn uncovered(
    i: usize,
    seen: &[usize],
    sheets: &[Sheet],
    places: &PolygonIndex,
    seam: f64,
) -> Vec<Vec<DVec2>> {
    let sheet = &sheets[i];
    let middle = sheet.footprint.iter().sum::<DVec2>() / sheet.footprint.len() as f64;
    let mut others: Vec<(f64, usize)> = places
        .near(&sheet.footprint)
        .map(|k| seen[k])
        .filter(|j| *j != i)
        .map(|j| (sheets[j].height(middle), j))
        .collect();
    others.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut pieces = vec![sheet.footprint.clone()];
    for (_, j) in others {
        let other = &sheets[j];
        let higher = |p: DVec2| other.height(p) - sheet.height(p);
        let steepness = (other.gradient - sheet.gradient).length();
        let region = if steepness <= seam {
            // Parallel planes: the higher sheet wins everywhere; of two equal sheets, the first.
            let above = higher(sheet.footprint[0]);
            let wins = above > seam || (above >= -seam && j < i);
            if !wins {
                continue;
            }
            other.footprint.clone()
        } else {
            clip(&other.footprint, |p| higher(p) / steepness)
        };
        if is_cell(&region, seam) {
            pieces = pieces.into_iter().flat_map(|piece| minus(piece, &region, seam)).collect();
        }
        if pieces.is_empty() {
            break;
        }
    }
    pieces
}

/// The part of a convex polygon in which `inside`, linear and in units of length, is at least 0.
pub fn clip(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (da, db) = (inside(a), inside(b));
        if da >= 0.0 {
            out.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            out.push(a.lerp(b, da / (da - db)));
        }
    }
    out
}

/// Convex pieces of `piece` outside the convex `region`.
fn minus(piece: Vec<DVec2>, region: &[DVec2], seam: f64) -> Vec<Vec<DVec2>> {
    if !overlap(bounds(&piece), bounds(region)) {
        return vec![piece];
    }
    let mut outside = Vec::new();
    let mut rest = piece.clone();
    for (k, &a) in region.iter().enumerate() {
        let along = region[(k + 1) % region.len()] - a;
        // A side shorter than the seam has no direction; its neighbours close the region without it.
        if along.length() <= seam {
            continue;
        }
        let inward = along.perp().normalize();
        let distance = |p: DVec2| {
            let d = inward.dot(p - a);
            if d.abs() <= seam { 0.0 } else { d }
        };
        let cut = clip(&rest, |p| -distance(p));
        if is_cell(&cut, seam) {
            outside.push(cut);
        }
        rest = clip(&rest, distance);
        if !is_cell(&rest, seam) {
            return vec![piece];
        }
    }
    outside
}

/// Whether a polygon is more than rounding.
fn is_cell(polygon: &[DVec2], seam: f64) -> bool {
    if polygon.len() < 3 {
        return false;
    }
    let size = polygon.iter().map(|p| p.distance(polygon[0])).fold(0.0, f64::max);
    area(polygon) > SLIVER * seam * size
}

fn bounds(polygon: &[DVec2]) -> (DVec2, DVec2) {
    polygon.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
}

fn overlap(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> bool {
    a.0.cmple(b.1).all() && b.0.cmple(a.1).all()
}

/// The border of every cell, cut at the points at which the neighbour across changes.
pub(super) fn borders(cells: &[Cell], seam: f64, exec: &Exec) -> Result<Vec<Vec<Border>>, Cancelled> {
    // Sides are shared if their lines coincide within a few seams.
    let near = SLIVER * seam;
    let places = PolygonIndex::new(cells.iter().map(|cell| &cell.polygon[..]), 2.0 * near);
    let mut borders = Vec::with_capacity(cells.len());
    for (i, cell) in cells.iter().enumerate() {
        exec.check()?;
        let mut neighbours = places.overlapping(&cell.polygon);
        neighbours.retain(|j| *j != i);
        let n = cell.polygon.len();
        let mut own = Vec::new();
        for k in 0..n {
            let (from, to) = (cell.polygon[k], cell.polygon[(k + 1) % n]);
            let length = from.distance(to);
            if length <= near {
                continue;
            }
            let along = (to - from) / length;
            // Stretches of this side, as distances from its start, with the cell across.
            let mut stretches: Vec<(f64, f64, usize)> = Vec::new();
            for &j in &neighbours {
                let other = &cells[j].polygon;
                for l in 0..other.len() {
                    let (a, b) = (other[l] - from, other[(l + 1) % other.len()] - from);
                    if along.perp_dot(a).abs() > near || along.perp_dot(b).abs() > near {
                        continue;
                    }
                    // Across means running the other way.
                    let (start, end) = (along.dot(b).max(0.0), along.dot(a).min(length));
                    if end - start > near {
                        stretches.push((start, end, j));
                    }
                }
            }
            stretches.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
            let point = |t: f64| from + along * t;
            let mut reached = 0.0;
            for (start, end, j) in stretches {
                if start - reached > near {
                    own.push(Border { from: point(reached), to: point(start), across: None });
                }
                let start = if start - reached > near { start } else { reached };
                if end - start > near {
                    own.push(Border { from: point(start), to: point(end), across: Some(j) });
                    reached = end;
                }
            }
            if length - reached > near {
                own.push(Border { from: point(reached), to, across: None });
            } else if let Some(last) = own.last_mut() {
                last.to = to;
            }
        }
        borders.push(own);
    }
    Ok(borders)
}
