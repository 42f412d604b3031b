//! The definition of transport in executable form: all cells, sorted by height, one after the other; every
//! contact is recomputed at every cell. Slow and plain: the reference for the fast path.

use super::links::{CROSSINGS, LEAST, NEGLIGIBLE};
use super::{TransportSettings, surface};
use crate::acceptance::Outcome;
use crate::contact::Pair;
use crate::landscape::{Grid, Landscape};
use crate::method::descent;
use crate::method::metric::Metric;
use crate::pose::CorPose;
use crate::tolerance::{COINCIDENT, PARALLEL};

/// Fraction of every cell that arrives; grids as for [`super::run`].
pub fn fractions(pair: &Pair, landscape: &Landscape, settings: &TransportSettings) -> Vec<f64> {
    let Landscape { grid, heights } = landscape;
    let velocities: Vec<Vec<f64>> = (0..grid.len()).map(|cell| velocity(pair, grid, cell)).collect();
    let mut order: Vec<usize> = (0..grid.len()).filter(|c| heights[*c].is_finite()).collect();
    order.sort_by(|a, b| heights[*a].total_cmp(&heights[*b]));
    let mut fractions = vec![0.0; grid.len()];
    let follow_out = surface(grid) <= settings.followed_out;
    for cell in order {
        let mut links: Vec<(usize, f64)> = Vec::new();
        let (mut total, mut leaves) = (0.0, false);
        let mut front = vec![(cell, 1.0)];
        for crossing in 0..=CROSSINGS {
            let mut next: Vec<(usize, f64)> = Vec::new();
            for (from, weight) in front {
                if weight < f64::from(NEGLIGIBLE) {
                    continue;
                }
                let (corners, out) = corners(grid, from, &velocities[from]);
                leaves |= crossing == 0 && out;
                for (to, share) in corners {
                    let weight = weight * share;
                    if to == cell {
                        continue;
                    }
                    if heights[to] < heights[cell] {
                        links.push((to, weight));
                        total += weight;
                    } else {
                        match next.iter_mut().find(|n| n.0 == to) {
                            Some(known) => known.1 += weight,
                            None => next.push((to, weight)),
                        }
                    }
                }
            }
            front = next;
        }
        fractions[cell] = if total >= f64::from(LEAST) {
            links.iter().map(|(to, weight)| weight * fractions[*to]).sum::<f64>() / total
        } else if leaves && !follow_out {
            0.0
        } else {
            match descent::outcome(pair, &grid.pose(cell), &settings.descent).outcome {
                Outcome::Aligned => 1.0,
                Outcome::Jammed | Outcome::Missed => 0.0,
                Outcome::Undecided => 0.5,
            }
        };
    }
    fractions
}

/// Velocity at a cell in cells per axis: of the first contact that carries the half there.
fn velocity(pair: &Pair, grid: &Grid, cell: usize) -> Vec<f64> {
    let error = grid.pose(cell);
    let alignment = &pair.alignment;
    let pose = CorPose::from_error(&error, alignment.center_of_rotation, alignment.free);
    let mut envelope = pair.at_rotation(pose.rotation);
    let Some(z) = envelope.height(pose.lateral) else { return vec![0.0; grid.axes.len()] };
    let cor = pose.lateral.extend(z);
    let mut contacts = Vec::new();
    envelope.contacts(cor, COINCIDENT, &mut contacts);
    let Some(contact) = contacts.iter().find(|c| c.normal.z > PARALLEL) else {
        return vec![0.0; grid.axes.len()];
    };
    let ([gx, gy], turn) = contact.gradient(cor);
    Metric::new(pair, grid, &error).velocity(&[gx, gy, turn.x, turn.y, turn.z])[..grid.axes.len()].to_vec()
}

/// Corners within the grid of the simplex that the velocity points into, with their weights; and whether some
/// corner lies outside.
fn corners(grid: &Grid, cell: usize, velocity: &[f64]) -> (Vec<(usize, f64)>, bool) {
    let mut order: Vec<usize> = (0..velocity.len()).filter(|k| velocity[*k] != 0.0).collect();
    order.sort_by(|a, b| velocity[*b].abs().total_cmp(&velocity[*a].abs()));
    let mut at = grid.cell(cell);
    let mut corners = Vec::new();
    for (k, &axis) in order.iter().enumerate() {
        let to = at[axis].wrapping_add_signed(if velocity[axis] > 0.0 { 1 } else { -1 });
        if to >= grid.axes[axis].cells {
            return (corners, true);
        }
        at[axis] = to;
        let next = order.get(k + 1).map_or(0.0, |a| velocity[*a].abs());
        let weight = (velocity[axis].abs() - next) / velocity[order[0]].abs();
        if weight > 0.0 {
            corners.push((grid.index(&at), weight));
        }
    }
    (corners, false)
}
