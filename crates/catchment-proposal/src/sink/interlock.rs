//! Interlocks of parts that are drawn docked and cannot approach along any axis: a thread, or walls that
//! would have to yield.
//!
//! ```text
//!   thread   turned by ±90° about the approach, the moving part fits if raised by ±lead / 4, and at no other height
//!
//!        ┌──┐          overlap(90°, z)   ▒▒▒▒╲    ╱▒▒▒▒        overlap(0, z)   ▒▒▒▒▒╲╱▒▒▒▒▒
//!      ╱╱│╱╱│                                 ╲__╱                                  z = 0
//!      ╱╱│╱╱│                               z = lead / 4
//!
//!   snap     the fixed part eroded by w on every side admits the moving part as far as drawn; w is the undercut
//! ```
//!
//! Not guaranteed: detection of threads whose axis is not the middle of the moving part, or whose lead is
//! longer than four times [`RAISED`]; survival of walls that yield by w.

use super::as_drawn::{columns, common};
use super::height::PartHeights;
use super::refine::Window;
use super::{Grain, Triangles};
use crate::layout::{AxisDirection, PartLayout};
use glam::{DMat3, DVec2};
use std::f64::consts::FRAC_PI_2;

/// Cells by which the fixed part is worn, at most 1.6 mm for parts of a few centimetres.
const WORN: [usize; 8] = [1, 2, 3, 4, 6, 8, 12, 16];
/// Largest offset of the moving part across the approach, and its largest height above the drawn pose, in
/// small lengths.
const ACROSS: f64 = 0.4;
const SHORT: f64 = 0.5;

/// Distance by which the walls of the fixed part would have to yield, on each side, so that the moving part
/// reaches its drawn pose.
pub(crate) fn undercut(parts: [&Triangles; 2], way: AxisDirection, grain: Grain) -> Option<f64> {
    let turns = PartLayout::as_drawn(way).turns();
    WORN.into_iter().find_map(|worn| {
        let window = Window::around(parts, turns, DVec2::ZERO, worn, grain);
        let lowest = window.lowest(DVec2::ZERO, ACROSS * grain.small)?;
        let is_home = f64::from(window.z[lowest]) <= SHORT * grain.small;
        is_home.then_some(worn as f64 * window.cell)
    })
}

/// Largest lift of a part rotated by 90°, and its resolution, in small lengths: leads of up to 8 mm.
const RAISED: f64 = 4.0;
const STEP: f64 = 0.1;
/// Columns across the overlap of both parts.
const COLUMNS: f64 = 160.0;
/// A rotated part that fits overlaps by at most this share of its overlap at other heights.
const FITS: f64 = 0.2;

/// The lead of a thread along an approach, positive for a right-handed thread: displacement of the moving
/// part per turn.
pub(crate) fn lead(parts: [&Triangles; 2], way: AxisDirection, grain: Grain) -> Option<f64> {
    let [fixed, moving] = parts;
    let turn = PartLayout::as_drawn(way).turns()[0];
    let (low, high) = PartHeights::bounds(moving, &turn);
    let middle = low.midpoint(high).truncate();
    let of_fixed = PartHeights::bounds(fixed, &turn);
    // The moving part about its middle, so that it stays there when it is turned.
    let reach = 0.5 * (high - low).truncate().length();
    let low = of_fixed.0.truncate().max(middle - reach);
    let high = of_fixed.1.truncate().min(middle + reach);
    if high.cmple(low).any() {
        return None;
    }
    let cell = (high - low).max_element() / COLUMNS;
    // Off the round numbers at which parts have their corners.
    let first = low + cell * DVec2::new(0.4837, 0.4391);
    let counts = [0, 1].map(|k| ((high[k] - low[k]) / cell).ceil() as usize);
    let socket = columns(fixed, &turn, first, cell, counts);
    let turned = |angle: f64| -> Vec<Vec<f64>> {
        let about = DMat3::from_rotation_z(angle);
        let middle = middle.extend(0.0);
        let part: Triangles =
            moving.iter().map(|corners| corners.map(|p| about * (turn * p - middle) + middle)).collect();
        columns(&part, &DMat3::IDENTITY, first, cell, counts)
    };
    let overlap = |plug: &[Vec<f64>], raised: f64| -> f64 {
        let pairs = socket.iter().zip(plug).filter(|(a, b)| !a.is_empty() && !b.is_empty());
        pairs.map(|(a, b)| common(a, &b.iter().map(|z| z + raised).collect::<Vec<f64>>())).sum()
    };
    let raised = |k: i32| f64::from(k) * STEP * grain.small;
    let steps = (RAISED / STEP).round() as i32;
    // The middle of the range of heights, nearest to the drawn height, at which the part fits; `None` if it
    // fits as drawn.
    let fits = |angle: f64| {
        let plug = turned(angle);
        let level = overlap(&plug, 0.0);
        let does_fit = |k: i32| k.abs() <= steps && overlap(&plug, raised(k)) <= FITS * level;
        if does_fit(0) {
            return None;
        }
        let nearest = (1..=steps).flat_map(|k| [k, -k]).find(|k| does_fit(*k))?;
        let onward = (1..=2 * steps).map(|k| nearest + nearest.signum() * k).take_while(|k| does_fit(*k));
        Some(0.5 * (raised(nearest) + raised(onward.last().unwrap_or(nearest))))
    };
    let (ahead, back) = (fits(FRAC_PI_2)?, fits(-FRAC_PI_2)?);
    // Raised as much without a turn it does not fit.
    let straight = turned(0.0);
    let is_screw = (ahead + back).abs() <= 2.0 * raised(1)
        && overlap(&straight, 0.0) <= FITS * overlap(&straight, ahead);
    is_screw.then_some(2.0 * (ahead - back))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sink::tests::{GRAIN, block, down};
    use glam::DVec3;
    use std::f64::consts::TAU;

    /// A rod from z = `low` to `high` around the z-axis, whose radius is that of a thread of this lead and a depth of 0.6 mm; `grown` in radius.
    fn thread([low, high]: [f64; 2], lead: f64, grown: f64, is_hole: bool) -> Triangles {
        const AROUND: usize = 48;
        let along = ((high - low) / (lead / 12.0)).round() as usize;
        let at = |i: usize, j: usize| {
            let (angle, z) = (TAU * i as f64 / AROUND as f64, low + (high - low) * j as f64 / along as f64);
            let phase = (z / lead - i as f64 / AROUND as f64).rem_euclid(1.0);
            let radius = 5.0 + grown + 0.6 * (1.0 - 2.0 * (2.0 * phase - 1.0).abs());
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        let mut all = Triangles::new();
        for (i, j) in (0..AROUND).flat_map(|i| (0..along).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            all.extend([[a, b, c], [a, c, d]]);
        }
        // Ends: a disc of a rod, a ring of a nut.
        for (j, z) in [(0, low), (along, high)] {
            for i in 0..AROUND {
                let (p, q) = (at(i, j), at(i + 1, j));
                if is_hole {
                    let out = |p: DVec3| DVec3::new(p.x, p.y, 0.0).normalize() * 9.0 + DVec3::Z * z;
                    all.extend([[p, q, out(q)], [p, out(q), out(p)]]);
                } else {
                    all.push([DVec3::Z * z, p, q]);
                }
            }
        }
        all
    }

    #[test]
    fn a_thread_is_known_by_its_lead() {
        for lead_mm in [1.6, 2.4] {
            let nut = thread([0.0, 12.0], lead_mm, 0.05, true);
            let bolt = thread([-2.0, 20.0], lead_mm, -0.05, false);
            let result = lead([&nut, &bolt], down(), GRAIN).unwrap();
            assert!((result.abs() - lead_mm).abs() < 0.11, "{lead_mm}: {result}");
        }
        // A round pin turns freely; a square pin does not turn.
        let smooth = |grown, is_hole| thread([0.0, 12.0], 1e6, grown, is_hole);
        assert_eq!(lead([&smooth(0.05, true), &smooth(-0.05, false)], down(), GRAIN), None);
    }

    #[test]
    fn an_undercut_is_the_required_wall_deflection() {
        // A hole of 10.6 mm with a lip that leaves 9.2 mm, and a square pin of 10 mm with a neck of 9 mm.
        let mut socket = Triangles::new();
        for (half, low, high) in [(5.3, -12.0, -2.0), (4.6, -2.0, 0.0)] {
            socket.extend(block([-20.0, -20.0, low], [-half, 20.0, high]));
            socket.extend(block([half, -20.0, low], [20.0, 20.0, high]));
            socket.extend(block([-half, -20.0, low], [half, -half, high]));
            socket.extend(block([-half, half, low], [half, 20.0, high]));
        }
        socket.extend(block([-20.0, -20.0, -20.0], [20.0, 20.0, -12.0]));
        let mut pin = block([-5.0, -5.0, -12.0], [5.0, 5.0, -2.2]);
        pin.extend(block([-4.5, -4.5, -2.2], [4.5, 4.5, 10.0]));
        let result = undercut([&socket, &pin], down(), GRAIN).unwrap();
        // 0.4 mm on each side, in cells of 0.1 mm, rounded up to the next tested offset.
        assert!((0.4..0.61).contains(&result), "{result}");
        // Three millimetres are no snap.
        let mut wide = block([-5.0, -5.0, -12.0], [5.0, 5.0, -2.2]);
        wide.extend(block([-1.5, -1.5, -2.2], [1.5, 1.5, 10.0]));
        let shut = block([-20.0, -20.0, -2.0], [20.0, 20.0, 0.0]);
        socket.extend(shut);
        assert_eq!(undercut([&socket, &wide], down(), GRAIN), None);
    }
}
