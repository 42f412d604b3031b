//! Exact flow of every point of every cell.
//!
//! Inside a cell the motion follows the constant −gradient, so a cell is divided into strips that leave it
//! through different segments of its border. The type of the border determines the continuation of a strip:
//!
//! ```text
//!   crossing   the neighbour's flow leads on          → the strip of the neighbour
//!   drop       the neighbour lies lower               → likewise, or along the foot of the wall
//!   valley     the neighbour's flow leads back        → down the border to its lower end
//!   wall       the neighbour lies higher              → likewise
//!   level      a valley or wall without slope         → at rest: entirely in the seat, or not
//!   nothing    no contact across the border           → missed
//! ```
//!
//! and at the end of a valley the steepest continuation is taken. Heights fall along every path, so the
//! recursion ends; strips with the same outcome are joined, which keeps their number small.

use super::cells::{Border, Cell};
use super::polygon_index::PolygonIndex;
use super::sheet::Sheet;
use glam::DVec2;

/// Longest chain of cells and valleys: far more than a path has, and it stops a cycle that rounding made.
const MAX_DEPTH: usize = 4096;

/// Distance below which two points are equal, in seams.
const NEAR: f64 = 20.0;

/// A strip of a cell: positions between two values of [`Flow::across`], and whether it reaches the seat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Strip {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) accepted: bool,
}

/// Outcome of the points that leave by a border.
#[derive(Debug, Clone)]
enum Stretch {
    Unknown,
    Sought,
    Known(Vec<Strip>),
}

/// The flow over all cells.
pub(super) struct Flow<'a, D> {
    sheets: &'a [Sheet],
    cells: &'a [Cell],
    borders: &'a [Vec<Border>],
    places: PolygonIndex,
    seam: f64,
    /// Whether a half at a position and height is in the seat.
    docked: D,
    /// Per cell and border.
    stretches: Vec<Vec<Stretch>>,
    /// Whether some path was too long or came round to itself.
    pub(super) tangled: bool,
}

/// Continuation of a motion at a border.
enum BorderStep {
    /// Into a cell.
    Into(usize),
    /// Along the border to one of its ends.
    Along(DVec2),
    /// On the border, at the height of a cell.
    Rest(usize),
    Missed,
}

/// Continuation of a motion from a point at which borders meet.
enum JunctionStep {
    /// Into a cell.
    Into(usize),
    /// Along a valley of a cell, to its end.
    Along(usize, DVec2),
}

impl<'a, D: FnMut(DVec2, f64) -> bool> Flow<'a, D> {
    pub(super) fn new(
        sheets: &'a [Sheet],
        cells: &'a [Cell],
        borders: &'a [Vec<Border>],
        seam: f64,
        docked: D,
    ) -> Self {
        let stretches = borders.iter().map(|b| vec![Stretch::Unknown; b.len()]).collect();
        // Boxes are enlarged so that each cell within `near` of a point is found at the point.
        let places = PolygonIndex::new(cells.iter().map(|cell| &cell.polygon[..]), 2.0 * NEAR * seam);
        Self { sheets, cells, borders, places, seam, docked, stretches, tangled: false }
    }

    fn sheet(&self, cell: usize) -> &'a Sheet {
        &self.sheets[self.cells[cell].sheet]
    }

    /// Unit direction of the motion in a cell; zero if it is level.
    fn direction(&self, cell: usize) -> DVec2 {
        let g = self.sheet(cell).gradient;
        if g.length() <= self.seam { DVec2::ZERO } else { -g.normalize() }
    }

    /// Coordinate across the motion of a cell.
    pub(super) fn across(&self, cell: usize, at: DVec2) -> f64 {
        self.direction(cell).perp_dot(at)
    }

    /// Distance below which two points are equal: a few seams, as for the borders.
    fn near(&self) -> f64 {
        NEAR * self.seam
    }

    /// The strips of a cell, in order.
    pub(super) fn strips(&mut self, cell: usize) -> Vec<Strip> {
        self.strips_between(cell, f64::NEG_INFINITY, f64::INFINITY, 0)
    }

    /// The strips of a cell that lie in part between two values of [`Flow::across`], in order.
    fn strips_between(&mut self, cell: usize, low: f64, high: f64, depth: usize) -> Vec<Strip> {
        if self.direction(cell) == DVec2::ZERO {
            // A level cell is at rest: it is entirely in the seat or entirely outside.
            let polygon = &self.cells[cell].polygon;
            let middle = polygon.iter().sum::<DVec2>() / polygon.len() as f64;
            let height = self.sheet(cell).height(middle);
            let accepted = (self.docked)(middle, height);
            return vec![Strip { from: f64::NEG_INFINITY, to: f64::INFINITY, accepted }];
        }
        let mut strips: Vec<Strip> = Vec::new();
        for k in 0..self.borders[cell].len() {
            let (from, to) = self.span(cell, k);
            if to - from > self.near() && from < high && to > low {
                strips.extend(self.stretch(cell, k, depth));
            }
        }
        strips.sort_by(|a, b| a.from.total_cmp(&b.from));
        strips.dedup_by(|next, last| {
            let join = last.accepted == next.accepted && next.from - last.to <= self.near();
            if join {
                last.to = next.to;
            }
            join
        });
        strips
    }

    /// A border's ends in its cell's own coordinate. The motion leaves by the borders along which it grows,
    /// because the outside of a counter-clockwise border is to its right.
    fn span(&self, cell: usize, border: usize) -> (f64, f64) {
        let border = &self.borders[cell][border];
        (self.across(cell, border.from), self.across(cell, border.to))
    }

    /// Outcomes of the points that leave `cell` by its k-th border, in the cell's own coordinate.
    fn stretch(&mut self, cell: usize, k: usize, depth: usize) -> Vec<Strip> {
        match &self.stretches[cell][k] {
            Stretch::Known(strips) => return strips.clone(),
            // Heights fall along every path, but a long border may be met twice at different heights.
            Stretch::Sought => self.tangled = true,
            Stretch::Unknown => {}
        }
        if self.tangled || depth > MAX_DEPTH {
            self.tangled = true;
            return Vec::new();
        }
        self.stretches[cell][k] = Stretch::Sought;
        let strips = self.sought(cell, k, depth);
        self.stretches[cell][k] = Stretch::Known(strips.clone());
        strips
    }

    fn sought(&mut self, cell: usize, k: usize, depth: usize) -> Vec<Strip> {
        let border = self.borders[cell][k];
        let (from, to) = self.span(cell, k);
        let whole = |accepted| vec![Strip { from, to, accepted }];
        match self.way(cell, &border) {
            BorderStep::Missed => whole(false),
            BorderStep::Rest(floor) => {
                let middle = border.midpoint();
                let height = self.sheet(floor).height(middle);
                let seated = (self.docked)(middle, height);
                whole(seated)
            }
            BorderStep::Along(end) => {
                let height = self.sheet(cell).height(end);
                let on = (end - border.midpoint()).normalize_or_zero();
                whole(self.ends_well(end, height, on, depth + 1))
            }
            BorderStep::Into(next) => {
                // Both coordinates are linear along the border.
                let (a, b) = (self.across(next, border.from), self.across(next, border.to));
                if (b - a).abs() <= self.near() {
                    // The neighbour flows along the border: its strip there decides.
                    let accepted = self.follow(next, border.midpoint(), depth + 1);
                    return whole(accepted);
                }
                let back = |s: f64| from + (s - a) / (b - a) * (to - from);
                self.strips_between(next, a.min(b), a.max(b), depth + 1)
                    .into_iter()
                    .filter_map(|s| {
                        let (u, v) = (back(s.from), back(s.to));
                        let (u, v) = (u.min(v).max(from), u.max(v).min(to));
                        (v - u > 0.0).then_some(Strip { from: u, to: v, accepted: s.accepted })
                    })
                    .collect()
            }
        }
    }

    /// Continuation of a motion that leaves `cell` at one of its borders.
    fn way(&self, cell: usize, border: &Border) -> BorderStep {
        let Some(next) = border.across else { return BorderStep::Missed };
        let middle = border.midpoint();
        let along = border.to - border.from;
        let outward = -along.perp().normalize_or_zero();
        let step = self.sheet(next).height(middle) - self.sheet(cell).height(middle);
        let leads_on = self.direction(next).dot(outward);
        let angle = self.near() / along.length();
        if step <= self.near() && (leads_on > angle || self.direction(next) == DVec2::ZERO) {
            return BorderStep::Into(next);
        }
        // A drop lands at the foot of the wall, whose slope counts from then on.
        let floor = if step < -self.near() { next } else { cell };
        let slope = -self.sheet(floor).gradient.dot(along.normalize_or_zero());
        if slope.abs() <= self.seam {
            BorderStep::Rest(floor)
        } else {
            BorderStep::Along(if slope > 0.0 { border.to } else { border.from })
        }
    }

    /// The cells that touch a point, ascending.
    fn touching(&self, at: DVec2) -> Vec<usize> {
        let mut cells = self.places.overlapping(&[at]);
        cells.retain(|cell| self.touches(*cell, at));
        cells
    }

    fn touches(&self, cell: usize, at: DVec2) -> bool {
        let polygon = &self.cells[cell].polygon;
        (0..polygon.len()).all(|k| {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            (b - a).perp_dot(at - a) >= -self.near() * (b - a).length()
        })
    }

    /// Whether a motion that arrives at a point at which borders meet, sliding in direction `on`, reaches the
    /// seat.
    fn ends_well(&mut self, at: DVec2, height: f64, on: DVec2, depth: usize) -> bool {
        if (self.docked)(at, height) {
            return true;
        }
        if depth > MAX_DEPTH {
            self.tangled = true;
            return false;
        }
        let mut best: Option<(f64, JunctionStep)> = None;
        let mut offer = |steepness: f64, way| {
            if best.as_ref().is_none_or(|(most, _)| steepness > *most + 1e-12) {
                best = Some((steepness, way));
            }
        };
        for cell in self.touching(at) {
            if (self.sheet(cell).height(at) - height).abs() > self.near() {
                continue;
            }
            let direction = self.direction(cell);
            let polygon = &self.cells[cell].polygon;
            let leads_in = direction != DVec2::ZERO
                && (0..polygon.len()).all(|k| {
                    let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
                    let along = (b - a).normalize_or_zero();
                    along.perp_dot(at - a) > self.near() || along.perp_dot(direction) >= -1e-9
                });
            if leads_in {
                offer(self.sheet(cell).gradient.length(), JunctionStep::Into(cell));
            }
            for (k, border) in self.borders[cell].iter().enumerate() {
                let (from, to) = self.span(cell, k);
                let leaves = to - from > self.near();
                let starts = border.from.distance(at) <= self.near() || border.to.distance(at) <= self.near();
                if !leaves || !starts {
                    continue;
                }
                if let BorderStep::Along(end) = self.way(cell, border)
                    && end.distance(at) > self.near()
                {
                    let slope = -self.sheet(cell).gradient.dot((end - at).normalize_or_zero());
                    if slope > self.seam {
                        offer(slope, JunctionStep::Along(cell, end));
                    }
                }
            }
        }
        match best {
            Some((_, JunctionStep::Into(cell))) => self.follow(cell, at, depth + 1),
            Some((_, JunctionStep::Along(cell, end))) => {
                let below = self.sheet(cell).height(end);
                self.ends_well(end, below, (end - at).normalize_or_zero(), depth + 1)
            }
            None => self.over_the_rim(at, height, on, depth),
        }
    }

    /// Nothing leads on at this height: the motion falls over a rim ahead of it, or rests.
    fn over_the_rim(&mut self, at: DVec2, height: f64, on: DVec2, depth: usize) -> bool {
        let ahead = at + on * (4.0 * self.near());
        let there = self.touching(ahead);
        let lower = |c: usize| self.sheet(c).height(at) < height - self.near();
        let landing = there
            .iter()
            .copied()
            .filter(|c| lower(*c))
            .max_by(|&a, &b| self.sheet(a).height(ahead).total_cmp(&self.sheet(b).height(ahead)));
        let blocked = there.into_iter().any(|c| !lower(c));
        match landing {
            Some(cell) if !blocked => self.follow(cell, ahead, depth + 1),
            _ => false,
        }
    }

    /// Whether the point `at` of a cell reaches the seat.
    fn follow(&mut self, cell: usize, at: DVec2, depth: usize) -> bool {
        if depth > MAX_DEPTH {
            self.tangled = true;
            return false;
        }
        let direction = self.direction(cell);
        if direction == DVec2::ZERO {
            return self.strips(cell).first().is_some_and(|s| s.accepted);
        }
        let s = direction.perp_dot(at);
        for k in 0..self.borders[cell].len() {
            let (from, to) = self.span(cell, k);
            if to - from <= self.near() {
                continue;
            }
            let border = self.borders[cell][k];
            for (end, across) in [(border.from, from), (border.to, to)] {
                // The motion runs straight into a point at which borders meet.
                if (across - s).abs() <= self.near() && end.distance(at) > self.near() {
                    return self.ends_well(end, self.sheet(cell).height(end), direction, depth + 1);
                }
            }
            if s > from + self.near() && s < to - self.near() {
                return self.stretch(cell, k, depth).iter().any(|t| t.accepted && t.from <= s && s <= t.to);
            }
        }
        false
    }
}
