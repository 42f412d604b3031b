//! End of the motion from a point of the contact space: the reference for the partition, and the partition's
//! rule for ravines.
//!
//! From a point, motion crosses the cell whose own velocity leads into it (the steepest, if several), up to
//! the facet through which it leaves. If there is no such cell, motion runs along a ravine or a wall to its
//! lowest point (the dissertation's ravine rule, section 5.1.6; exact over two pose errors; over more, the
//! ravine's own slope would bend the path). If no lower point exists, the motion has come to rest.

use super::cells::{Cells, Gate, GateTarget, LEVEL, TOUCH, dot, lifted, removed, touches};
use crate::polytope::{MAX_DIMENSION, PolytopePoint};
use std::array;

/// End of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MotionEnd {
    /// At rest, in contact.
    Rest(PolytopePoint),
    /// Contact lost.
    Lost,
    /// Beyond the last slice of a rotation.
    Left,
}

/// Motion that has not fallen by [`LEVEL`] over so many cells circles a point of rest.
const ROUND: usize = 64;

/// End of the motion from first contact at `q`.
pub(super) fn fate(cells: &Cells, q: &PolytopePoint) -> MotionEnd {
    let top = cells.holding(q).into_iter().map(|k| cells.all[k].height.at(q)).max_by(f64::total_cmp);
    top.map_or(MotionEnd::Lost, |height| fate_from(cells, q, height))
}

/// End of the motion from `q` at a height: below first contact, beside a wall.
pub(super) fn fate_from(cells: &Cells, start: &PolytopePoint, height: f64) -> MotionEnd {
    let (mut q, mut height) = (*start, height);
    let at = |k: usize, q: &PolytopePoint| cells.all[k].height.at(q);
    let mut falling_from = f64::INFINITY;
    for step in 0.. {
        if step % ROUND == 0 {
            if height > falling_from - LEVEL {
                break;
            }
            falling_from = height;
        }
        // Cells that stand higher here are walls.
        let under: Vec<usize> =
            cells.holding(&q).into_iter().filter(|k| at(*k, &q) <= height + LEVEL).collect();
        match leading(cells, &under, &q) {
            Some(k) => {
                let (next, facet) = crossed(cells, k, &q);
                height = at(k, &next);
                let beyond = cells.holding(&next);
                if beyond.iter().all(|other| *other == k) {
                    let border = cells.on_border(&cells.all[k].region.facets()[facet]);
                    return if border { MotionEnd::Left } else { MotionEnd::Lost };
                }
                q = next;
            }
            None => match ravine(cells, &under, &q, height) {
                Some(next) => {
                    q = next;
                    height = cells
                        .holding(&q)
                        .into_iter()
                        .map(|k| at(k, &q))
                        .filter(|h| *h <= height + LEVEL)
                        .fold(f64::NEG_INFINITY, f64::max);
                }
                None => return resting(cells, &under, &q),
            },
        }
    }
    MotionEnd::Rest(q)
}

/// The cell whose motion leads into it from `q`: the steepest.
fn leading(cells: &Cells, under: &[usize], q: &PolytopePoint) -> Option<usize> {
    let inward = |k: &usize| {
        let cell = &cells.all[*k];
        let mut active = cell.region.facets().iter().filter(|facet| facet.excess(q) >= -TOUCH);
        cell.descent > LEVEL * LEVEL && !active.any(|facet| cell.crosses(facet))
    };
    let steeper = |a: &usize, b: &usize| cells.all[*a].descent.total_cmp(&cells.all[*b].descent);
    under.iter().copied().filter(inward).max_by(|a, b| steeper(a, b).then(b.cmp(a)))
}

/// Point at which the motion from `q` leaves the cell, and the facet.
fn crossed(cells: &Cells, k: usize, q: &PolytopePoint) -> (PolytopePoint, usize) {
    let cell = &cells.all[k];
    let time = |facet: usize| {
        let plane = &cell.region.facets()[facet];
        (-plane.excess(q)).max(0.0) / dot(&cell.velocity, &plane.normal)
    };
    let (facet, time) = (0..cell.region.facets().len())
        .filter(|facet| cell.crosses(&cell.region.facets()[*facet]))
        .map(|facet| (facet, time(facet)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or((0, 0.0));
    (array::from_fn(|j| q[j] + time * cell.velocity[j]), facet)
}

/// The lowest point of the steepest ravine or wall that leads down from `q`.
fn ravine(cells: &Cells, under: &[usize], q: &PolytopePoint, height: f64) -> Option<PolytopePoint> {
    let mut best: Option<(f64, PolytopePoint)> = None;
    for &k in under {
        let cell = &cells.all[k];
        for gate in cell.gates.iter().filter(|gate| gate.to == GateTarget::Ravine) {
            let plane = &cell.region.facets()[gate.facet];
            if plane.excess(q).abs() > LEVEL || !touches(&gate.region, &removed(q, gate.dropped)) {
                continue;
            }
            let (low, bottom) = lowest(cells, k, gate);
            let way = (0..q.len()).map(|j| (bottom[j] - q[j]).powi(2)).sum::<f64>().sqrt();
            let slope = (height - low) / way;
            if height - low > LEVEL && best.is_none_or(|(steepest, _)| slope > steepest) {
                best = Some((slope, bottom));
            }
        }
    }
    best.map(|(_, bottom)| bottom)
}

/// The lowest point of a gate and its height.
pub(super) fn lowest(cells: &Cells, k: usize, gate: &Gate) -> (f64, PolytopePoint) {
    let cell = &cells.all[k];
    let plane = &cell.region.facets()[gate.facet];
    gate.region
        .vertices()
        .iter()
        .map(|y| lifted(y, plane, gate.dropped))
        .map(|q| (cell.height.at(&q), q))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or((f64::INFINITY, cell.region.centroid()))
}

/// Rest of a motion that reaches a level gate: the aligned pose if the gate contains it, else its middle.
pub(super) fn level(cells: &Cells, k: usize, gate: &Gate) -> Option<PolytopePoint> {
    let cell = &cells.all[k];
    let plane = &cell.region.facets()[gate.facet];
    let heights = gate.region.vertices().iter().map(|y| cell.height.at(&lifted(y, plane, gate.dropped)));
    let [low, high] =
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)]);
    if high - low > LEVEL {
        return None;
    }
    let aligned = [0.0; MAX_DIMENSION];
    let holds = plane.excess(&aligned).abs() <= LEVEL && gate.region.contains(&aligned);
    Some(if holds { aligned } else { lifted(&gate.region.centroid(), plane, gate.dropped) })
}

/// A point without a downward path: a rest, unless the contact space ends there.
fn resting(cells: &Cells, under: &[usize], q: &PolytopePoint) -> MotionEnd {
    let mut fate = MotionEnd::Rest(*q);
    for &k in under {
        let cell = &cells.all[k];
        for gate in &cell.gates {
            let plane = &cell.region.facets()[gate.facet];
            if plane.excess(q).abs() > LEVEL || !touches(&gate.region, &removed(q, gate.dropped)) {
                continue;
            }
            match gate.to {
                GateTarget::Nothing => return MotionEnd::Lost,
                GateTarget::Border => fate = MotionEnd::Left,
                _ => {}
            }
        }
    }
    fate
}
