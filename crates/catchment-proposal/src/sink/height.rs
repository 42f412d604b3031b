//! Height maps of a part over a fine lattice in plan view, and the few points that decide first contact.

use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;
use std::ops::Range;

/// Highest z over a lattice; −∞ at points without material.
pub(super) struct PartHeights {
    /// The first point of the lattice, and the distance to the next.
    pub(super) first: DVec2,
    pub(super) cell: f64,
    pub(super) counts: [usize; 2],
    pub(super) z: Vec<f32>,
}

pub(super) const NOTHING: f32 = f32::NEG_INFINITY;

impl PartHeights {
    /// The box of triangles as they are turned.
    pub(super) fn bounds(triangles: &[[DVec3; 3]], turn: &DMat3) -> (DVec3, DVec3) {
        let points = triangles.iter().flatten().map(|p| *turn * *p);
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// All of a part.
    pub(super) fn whole(triangles: &[[DVec3; 3]], turn: &DMat3, cell: f64, multiple: usize) -> Self {
        let (low, high) = Self::bounds(triangles, turn);
        let counts =
            [0, 1].map(|k| (((high[k] - low[k]) / cell).ceil() as usize + 1).next_multiple_of(multiple));
        Self::window(triangles, turn, cell, low.truncate(), counts)
    }

    /// The section of a part over a lattice.
    pub(super) fn window(
        triangles: &[[DVec3; 3]],
        turn: &DMat3,
        cell: f64,
        first: DVec2,
        counts: [usize; 2],
    ) -> Self {
        let mut map = Self { first, cell, counts, z: vec![NOTHING; counts[0] * counts[1]] };
        for triangle in triangles {
            map.add(triangle.map(|p| *turn * p));
        }
        map
    }

    /// Also the points next to the edges of a part, so that walls thinner than a cell are there.
    pub(super) fn thickened(mut self, triangles: &[[DVec3; 3]], turn: &DMat3) -> Self {
        for triangle in triangles {
            let corners = triangle.map(|p| *turn * p);
            for (p, q) in [(corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])] {
                let steps = (2.0 * p.truncate().distance(q.truncate()) / self.cell).ceil().max(1.0);
                for k in 0..=steps as usize {
                    let at = p.lerp(q, k as f64 / steps);
                    let cell = ((at.truncate() - self.first) / self.cell).round();
                    let inside = cell.x >= 0.0 && cell.y >= 0.0;
                    let (i, j) = (cell.x as usize, cell.y as usize);
                    if inside && i < self.counts[0] && j < self.counts[1] {
                        let held = &mut self.z[j * self.counts[0] + i];
                        *held = held.max(at.z as f32);
                    }
                }
            }
        }
        self
    }

    fn add(&mut self, corners: [DVec3; 3]) {
        let plan = corners.map(|p| (p.truncate() - self.first) / self.cell);
        let (low, high) = (plan[0].min(plan[1]).min(plan[2]), plan[0].max(plan[1]).max(plan[2]));
        let last = DVec2::new(self.counts[0] as f64 - 1.0, self.counts[1] as f64 - 1.0);
        if high.cmplt(DVec2::ZERO).any() || low.cmpgt(last).any() {
            return;
        }
        let area = (plan[1] - plan[0]).perp_dot(plan[2] - plan[0]);
        if area.abs() < 1e-9 {
            return;
        }
        let (a, b, c) = (corners[0].z, corners[1].z, corners[2].z);
        let slope = {
            let (u, v) = (plan[1] - plan[0], plan[2] - plan[0]);
            DVec2::new((b - a) * v.y - (c - a) * u.y, (c - a) * u.x - (b - a) * v.x) / area
        };
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let rows = low.y.max(0.0).ceil() as usize..=high.y.min(last.y).floor() as usize;
        for row in rows {
            let y = row as f64;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..3 {
                let (p, q) = (plan[k], plan[(k + 1) % 3]);
                if p.y.min(q.y) <= y && y <= p.y.max(q.y) {
                    if p.y == q.y {
                        left = left.min(p.x.min(q.x));
                        right = right.max(p.x.max(q.x));
                    } else {
                        let x = p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y);
                        left = left.min(x);
                        right = right.max(x);
                    }
                }
            }
            let from = left.max(0.0).ceil();
            let to = right.min(last.x).floor();
            if from > to {
                continue;
            }
            for column in from as usize..=to as usize {
                let level = a + slope.dot(DVec2::new(column as f64, y) - plan[0]);
                let held = &mut self.z[row * self.counts[0] + column];
                *held = held.max(level.clamp(least, most) as f32);
            }
        }
    }

    /// Every point as low as the lowest of those up to `reach` points around it: points beside the part have
    /// the lowest value.
    pub(super) fn eroded(&self, reach: usize) -> Self {
        let [wide, deep] = self.counts;
        let mut rows = vec![NOTHING; wide * deep];
        for j in 0..deep {
            for i in reach..wide.saturating_sub(reach) {
                let around = &self.z[j * wide + i - reach..=j * wide + i + reach];
                rows[j * wide + i] = around.iter().copied().fold(f32::INFINITY, f32::min);
            }
        }
        let mut z = vec![NOTHING; wide * deep];
        for j in reach..deep.saturating_sub(reach) {
            let (one, more) = (j * wide, (j - reach)..=(j + reach));
            z[one..one + wide].copy_from_slice(&rows[one..one + wide]);
            for other in more {
                let from = &rows[other * wide..other * wide + wide];
                for (held, z) in z[one..one + wide].iter_mut().zip(from) {
                    *held = held.min(*z);
                }
            }
        }
        Self { z, ..*self }
    }

    /// Every point as high as the highest of those up to `reach` points around it.
    pub(super) fn dilated(&self, reach: usize) -> Self {
        let [wide, deep] = self.counts;
        let mut rows = vec![NOTHING; wide * deep];
        for (held, row) in rows.chunks_exact_mut(wide).zip(self.z.chunks_exact(wide)) {
            for (i, held) in held.iter_mut().enumerate() {
                let around = &row[i.saturating_sub(reach)..wide.min(i + reach + 1)];
                *held = around.iter().copied().fold(NOTHING, f32::max);
            }
        }
        let mut z = rows.clone();
        for j in 0..deep {
            for other in j.saturating_sub(reach)..deep.min(j + reach + 1) {
                let from = &rows[other * wide..other * wide + wide];
                for (held, z) in z[j * wide..j * wide + wide].iter_mut().zip(from) {
                    *held = held.max(*z);
                }
            }
        }
        Self { z, ..*self }
    }

    /// Whether two maps are equal up to `level`, measured from their highest points.
    pub(super) fn is_like(&self, other: &Self, level: f32) -> bool {
        if self.counts != other.counts {
            return false;
        }
        let highest = |map: &Self| map.z.iter().copied().fold(NOTHING, f32::max);
        let lift = highest(self) - highest(other);
        // A step may fall on either of two neighbouring points.
        let most = 8 + self.z.len() / 200;
        let differ = self.z.iter().zip(&other.z).filter(|(a, b)| {
            (a.is_finite() || b.is_finite()) && {
                let off = (**a - **b - lift).abs();
                off.is_nan() || off > level
            }
        });
        differ.take(most + 1).count() <= most
    }
}

/// How many times finer than the lattice of offsets the parts are sampled.
pub(super) const SUB: usize = 4;

/// A height map in phases: every [`SUB`]-th point of it in both directions, so that rows of offsets are rows in memory.
pub(super) struct Phases {
    counts: [usize; 2],
    z: Vec<Vec<f32>>,
}

impl Phases {
    pub(super) fn of(map: &PartHeights) -> Self {
        let counts = map.counts.map(|count| count / SUB);
        let phase = |p: usize| {
            let (a, b) = (p % SUB, p / SUB);
            (0..counts[1])
                .flat_map(|j| (0..counts[0]).map(move |i| (i, j)))
                .map(|(i, j)| map.z[(j * SUB + b) * map.counts[0] + i * SUB + a])
                .collect()
        };
        Self { counts, z: (0..SUB * SUB).map(phase).collect() }
    }
}

/// h over all offsets at which the parts may overlap.
pub(super) struct Offsets {
    pub(super) z: Vec<f32>,
    /// Points of a row, and how many cells before no offset the first point is.
    pub(super) wide: usize,
    pub(super) before: DVec2,
}

/// Whether the part seen from below, shifted by `shift` points relative to the fixed part and `height` above
/// it, would overlap it: by all points of both.
pub(super) fn overlaps(fixed: &PartHeights, below: &PartHeights, shift: [isize; 2], height: f32) -> bool {
    /// Distant rows come first: most overlaps are along a side.
    const STRIDE: usize = 16;
    // The index range of the moving part along an axis, and the index of the fixed part under its first
    // point.
    let range = |k: usize| {
        let [ahead, behind] = [shift[k].max(0).unsigned_abs(), shift[k].min(0).unsigned_abs()];
        let to = (fixed.counts[k] + behind).saturating_sub(ahead).min(below.counts[k]);
        (behind..to.max(behind), ahead)
    };
    let ((columns, first_column), (rows, first_row)) = (range(0), range(1));
    let row_overlaps = |row: usize| {
        let under = (row - rows.start + first_row) * fixed.counts[0] + first_column;
        let under = &fixed.z[under..under + columns.len()];
        let over = row * below.counts[0];
        let over = &below.z[over + columns.start..over + columns.end];
        under.iter().zip(over).fold(NOTHING, |most, (f, m)| most.max(*f + *m)) > height
    };
    !columns.is_empty() && (0..STRIDE).any(|first| rows.clone().skip(first).step_by(STRIDE).any(row_overlaps))
}

/// h over all offsets, of the fixed part in phases for the groups of points of the moving part, and of a
/// moving part with this many points in a row and a column.
pub(super) fn heights(groups: &[(&Phases, &[Point])], counts: [usize; 2]) -> Offsets {
    let sub = SUB as u32;
    let before = counts.map(|count| count.div_ceil(SUB));
    let of_fixed = groups.first().map_or([0; 2], |(fixed, _)| fixed.counts);
    let size = [0, 1].map(|k| of_fixed[k] + before[k] + 1);
    let mut z = vec![NOTHING; size[0] * size[1]];
    for (fixed, ([i, j], m)) in
        groups.iter().flat_map(|(fixed, points)| points.iter().map(move |point| (fixed, point)))
    {
        let phase = ((j % sub) * sub + i % sub) as usize;
        // The offset number a brings this point to the cell a − before + i / SUB.
        let [a, b] = [before[0] - (i / sub) as usize, before[1] - (j / sub) as usize];
        for (row, from) in fixed.z[phase].chunks_exact(fixed.counts[0]).enumerate() {
            for (held, f) in z[(b + row) * size[0] + a..].iter_mut().zip(from) {
                let sum = *f + *m;
                *held = if sum > *held { sum } else { *held };
            }
        }
    }
    Offsets { z, wide: size[0], before: DVec2::new(before[0] as f64, before[1] as f64) }
}

/// A point of the moving part: its position on its lattice, and its height, negated.
pub(super) type Point = ([u32; 2], f32);

/// Content of a block of points.
enum Block {
    Nothing,
    /// Its points are level, and this is the highest.
    Level(Point),
    /// It holds a step.
    Stepped,
}

/// The block with these columns and rows; if it has a step, appends to `points` its highest point, and the
/// points of the highest level that reach farthest to the four sides.
fn block(map: &PartHeights, [is, js]: [Range<usize>; 2], step: f32, points: &mut Vec<Point>) -> Block {
    let [wide, deep] = map.counts;
    // A step may lie between two blocks, or at the border of the map.
    let inside = is.start > 0 && js.start > 0 && is.end < wide && js.end < deep;
    let (mut top, mut bottom, mut at) = (NOTHING, if inside { f32::INFINITY } else { NOTHING }, [0, 0]);
    for j in js.start.saturating_sub(1)..deep.min(js.end + 1) {
        for i in is.start.saturating_sub(1)..wide.min(is.end + 1) {
            let z = map.z[j * wide + i];
            bottom = bottom.min(z);
            if z > top && is.contains(&i) && js.contains(&j) {
                (top, at) = (z, [i, j]);
            }
        }
    }
    let of = |[i, j]: [usize; 2]| ([i as u32, j as u32], map.z[j * wide + i]);
    if top == NOTHING {
        return Block::Nothing;
    }
    if top - bottom <= step {
        return Block::Level(of(at));
    }
    points.push(of(at));
    let level = top - step;
    let high = js.flat_map(|j| is.clone().map(move |i| [i, j])).filter(|[i, j]| map.z[j * wide + i] >= level);
    let mut ends = [at; 4];
    for [i, j] in high {
        if i < ends[0][0] {
            ends[0] = [i, j];
        }
        if i > ends[1][0] {
            ends[1] = [i, j];
        }
        if j < ends[2][1] {
            ends[2] = [i, j];
        }
        if j > ends[3][1] {
            ends[3] = [i, j];
        }
    }
    for (k, end) in ends.iter().enumerate() {
        if *end != at && !ends[..k].contains(end) {
            points.push(of(*end));
        }
    }
    Block::Stepped
}

/// The columns and rows of blocks of this side.
fn blocks([wide, deep]: [usize; 2], side: usize) -> impl Iterator<Item = [Range<usize>; 2]> {
    let parts = move |count: usize| (0..count).step_by(side).map(move |k| k..count.min(k + side));
    parts(deep).flat_map(move |js| parts(wide).map(move |is| [is, js.clone()]))
}

/// The points of a height map that decide first contact: a few of every block of this side.
pub(super) fn deciding(map: &PartHeights, side: usize, step: f32) -> Vec<Point> {
    let mut points = Vec::new();
    for ranges in blocks(map.counts, side) {
        if let Block::Level(point) = block(map, ranges, step, &mut points) {
            points.push(point);
        }
    }
    points
}

/// The same by the side of the block that a point represents: level blocks are large, and a point at the
/// middle of a block meets the highest point under all of it, so that a narrower rim cannot fall between two
/// points. Points that represent themselves have the side 1.
pub(super) fn deciding_blocks(map: &PartHeights, [small, large]: [usize; 2], step: f32) -> Groups {
    let (mut points, mut aside) = (Vec::new(), Vec::new());
    let middle = |[is, js]: &[Range<usize>; 2], z: f32| {
        ([is.start.midpoint(is.end) as u32, js.start.midpoint(js.end) as u32], z)
    };
    let mut result = Groups::new();
    for outer in blocks(map.counts, large) {
        aside.clear();
        match block(map, outer.clone(), step, &mut aside) {
            Block::Nothing => {}
            Block::Level((_, z)) => result.entry(large).or_default().push(middle(&outer, z)),
            Block::Stepped => {
                let [is, js] = &outer;
                for [i, j] in blocks([is.len(), js.len()], small) {
                    let inner = [is.start + i.start..is.start + i.end, js.start + j.start..js.start + j.end];
                    if let Block::Level((_, z)) = block(map, inner.clone(), step, &mut points) {
                        result.entry(small).or_default().push(middle(&inner, z));
                    }
                }
            }
        }
    }
    result.insert(1, points);
    result
}

/// Points by the side of the block that each stands for.
pub(super) type Groups = BTreeMap<usize, Vec<Point>>;
