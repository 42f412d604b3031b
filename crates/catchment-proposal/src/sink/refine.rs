//! Heights of first contact near a given offset, on a fine lattice: the floor of a basin, its middle, its
//! play.

use super::height::{NOTHING, PartHeights, deciding};
use super::{Grain, Sunk, Triangles, UPSIDE_DOWN};
use glam::{DMat3, DVec2};

/// Side of a cell and search range, in small lengths.
const CELL: f64 = 0.2;
const REACH: f64 = 5.0;
/// A part that moves farther than this while it hardly rises is loose.
const LOOSE: f64 = 0.9 * REACH;
/// Largest number of points of the moving part.
const MOST_POINTS: usize = 40000;
/// Largest climb that counts, in small lengths, for the play at half of it.
const TALL: f64 = 20.0;

/// The deepest region of a part.
pub(super) struct Floor {
    pub(super) middle: DVec2,
    /// Play to each side at half the climb.
    pub(super) play: f64,
    /// Whether it moves through the whole search range while it hardly rises.
    pub(super) is_loose: bool,
    /// Smallest play over the directions.
    pub(super) least: f64,
}

/// Heights over the offsets around a given offset.
pub(super) struct Window {
    pub(super) z: Vec<f32>,
    /// Points of a row, and the offset of the first.
    pub(super) wide: usize,
    pub(super) first: DVec2,
    pub(super) cell: f64,
}

impl Window {
    /// Around `offset`, within [`REACH`]; the fixed part eroded by `worn` cells, so that a part exactly as
    /// wide as its hole still fits.
    pub(super) fn around(
        [fixed, moving]: [&Triangles; 2],
        turns: [DMat3; 2],
        offset: DVec2,
        worn: usize,
        grain: Grain,
    ) -> Self {
        let most = Self::cell_of(moving, &turns[1]);
        let cell = (CELL * grain.small).max(most);
        let steps = (REACH * grain.small / cell).round().max(4.0) as usize;
        let bottom = PartHeights::whole(moving, &(UPSIDE_DOWN * turns[1]), cell, 1);
        let room = steps + worn;
        let counts = bottom.counts.map(|count| count + 2 * room);
        let corner = bottom.first + offset - DVec2::splat(room as f64 * cell);
        let top = PartHeights::window(fixed, &turns[0], cell, corner, counts);
        let (top, bottom) = if worn > 0 {
            (top.eroded(worn), bottom)
        } else {
            (top.thickened(fixed, &turns[0]), bottom.thickened(moving, &(UPSIDE_DOWN * turns[1])))
        };
        let mut block = 6;
        let points = loop {
            let points = deciding(&bottom, block, cell as f32);
            if points.len() <= MOST_POINTS || block > 20 {
                break points;
            }
            block += 2;
        };
        let wide = 2 * steps + 1;
        let mut z = vec![NOTHING; wide * wide];
        for ([i, j], m) in points {
            for row in 0..wide {
                let at = (j as usize + row + worn) * counts[0] + i as usize + worn;
                for (held, f) in z[row * wide..(row + 1) * wide].iter_mut().zip(&top.z[at..]) {
                    let sum = *f + m;
                    *held = if sum > *held { sum } else { *held };
                }
            }
        }
        Self { z, wide, first: offset - DVec2::splat(steps as f64 * cell), cell }
    }

    /// The least cell with which a part has not too many points.
    fn cell_of(moving: &Triangles, turn: &DMat3) -> f64 {
        const MOST: f64 = 1200.0;
        let (low, high) = PartHeights::bounds(moving, turn);
        (high - low).truncate().max_element() / MOST
    }

    pub(super) fn at(&self, k: usize) -> DVec2 {
        self.first + self.cell * DVec2::new((k % self.wide) as f64, (k / self.wide) as f64)
    }

    /// The lowest point within `reach` of an offset.
    pub(super) fn lowest(&self, offset: DVec2, reach: f64) -> Option<usize> {
        let near = |k: &usize| (self.at(*k) - offset).abs().max_element() <= reach && self.z[*k] > NOTHING;
        (0..self.z.len()).filter(near).min_by(|a, b| self.z[*a].total_cmp(&self.z[*b]))
    }

    /// The region connected with a point and not above `level`; whether it reaches the border, or points
    /// without contact.
    pub(super) fn below(&self, start: usize, level: f32) -> (Vec<usize>, bool) {
        let (mut seen, mut stack, mut result) = (vec![false; self.z.len()], vec![start], Vec::new());
        seen[start] = true;
        let mut leaves = false;
        while let Some(k) = stack.pop() {
            result.push(k);
            let (i, j) = (k % self.wide, k / self.wide);
            if i == 0 || j == 0 || i + 1 == self.wide || j + 1 == self.wide {
                leaves = true;
                continue;
            }
            for next in [k - 1, k + 1, k - self.wide, k + self.wide] {
                if !seen[next] && self.z[next] <= level {
                    seen[next] = true;
                    leaves |= self.z[next] == NOTHING;
                    stack.push(next);
                }
            }
        }
        (result, leaves)
    }

    /// Climb from a point until it reaches the border, by bisection.
    pub(super) fn climb(&self, start: usize) -> f64 {
        let low = self.z[start];
        let high = self.z.iter().copied().fold(low, f32::max);
        let (mut held, mut leaves) = (0.0f32, high - low);
        if !self.below(start, high).1 {
            return f64::from(high - low);
        }
        for _ in 0..16 {
            let mid = 0.5 * (held + leaves);
            if self.below(start, low + mid).1 { leaves = mid } else { held = mid }
        }
        f64::from(held)
    }

    /// The floor around a point.
    pub(super) fn floor(&self, start: usize, climb: f64, grain: Grain) -> Floor {
        let half = 0.5 * climb.min(TALL * grain.small);
        let (result, _) = self.below(start, self.z[start] + half as f32);
        let level = self.z[start] + (0.25 * self.cell) as f32;
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        let mut boxes = [[DVec2::INFINITY, DVec2::NEG_INFINITY]; 2];
        let little = self.z[start] + (0.5 * half).min(0.5 * grain.small) as f32;
        for k in result {
            let at = self.at(k);
            for (is_in, [low, high]) in [true, self.z[k] <= little].into_iter().zip(&mut boxes) {
                if is_in {
                    (*low, *high) = (low.min(at), high.max(at));
                }
            }
            if self.z[k] <= level {
                (sum, count) = (sum + at, count + 1.0);
            }
        }
        let [play, loose] = boxes.map(|[low, high]| 0.5 * (high - low).max_element());
        let least = 0.5 * (boxes[0][1] - boxes[0][0]).min_element();
        Floor { middle: sum / count, play, is_loose: loose >= LOOSE * grain.small, least }
    }
}

/// How much less steep a place counts at which the parts lie beside each other: of pins in a grid of holes all have to go in.
const BESIDE: f64 = 0.15;

/// The share of the smaller part's box in plan view that lies over the other's.
fn over(parts: [&Triangles; 2], sunk: &Sunk) -> f64 {
    let turns = sunk.lie.turns();
    let [fixed, moving] = [0, 1].map(|k| {
        let (low, high) = PartHeights::bounds(parts[k], &turns[k]);
        (low.truncate(), high.truncate())
    });
    let common = fixed.1.min(moving.1 + sunk.offset) - fixed.0.max(moving.0 + sunk.offset);
    let area = |(low, high): (DVec2, DVec2)| (high - low).element_product();
    (common.max(DVec2::ZERO).element_product() / area(fixed).min(area(moving))).clamp(0.0, 1.0)
}

/// A place on the fine lattice: the middle of its floor, its play, its steepness; `None` if it was an
/// artefact of the coarse lattice.
pub(super) fn refined(parts: [&Triangles; 2], mut sunk: Sunk, coarse: f64, grain: Grain) -> Option<Sunk> {
    for worn in [0, 1] {
        let window = Window::around(parts, sunk.lie.turns(), sunk.offset, worn, grain);
        let Some(start) = window.lowest(sunk.offset, 1.5 * coarse) else { continue };
        if window.climb(start) < grain.least_climb() {
            continue;
        }
        let floor = window.floor(start, sunk.climb, grain);
        // After erosion by a cell, a plug exactly as wide as its hole has half a cell of play on each side;
        // less play means a gap between samples.
        if floor.least < 0.4 * window.cell {
            continue;
        }
        (sunk.offset, sunk.height) = (floor.middle, f64::from(window.z[start]));
        (sunk.play, sunk.is_loose) = (floor.play, floor.is_loose);
        let steep = sunk.climb / (grain.small + sunk.play);
        (sunk.steep, sunk.cell) = (steep * (1.0 - BESIDE + BESIDE * over(parts, &sunk)), window.cell);
        return Some(sunk);
    }
    None
}
