//! Order of immobility of a rest: first order by the positions of its contacts, second order by their
//! curvature (Rimon and Burdick).
//!
//! ```text
//!   lowest z  subject to  gapᵢ(q, z) ≥ 0        at a rest    −load = Σ μᵢ aᵢ,  μᵢ ≥ 0        aᵢ the row of contact i, μᵢ its force
//!
//!   first order    the load lies inside the cone of all aᵢ: pushed in any direction, the half rises in proportion to the push
//!   second order   free to first order along d with aᵢ·d = 0:  rise = ½ κ s²,  κ(d) = max over all μ of  −Σ μᵢ gapᵢ″(d)
//! ```
//!
//! E. Rimon and J. Burdick (*Mobility of bodies in contact I and II*, IEEE Trans. Robotics and Automation 14,
//! 1998) call a body that surrounding bodies hold without a load first-order immobile. If contacts leave it free to
//! first order, it is second-order immobile if the relative curvature of the contacts holds it.
//! Here a force, the load, is given and counts as an additional finger that follows. For facets, edges and
//! corners gapᵢ has a closed form at every pose, also beyond the borders of the features, so that κ is exact
//! except for the finite differences (10⁻⁶ per D).
//!
//! The smallest slope of a first-order rest is that of the nearest facet of the hull of the contacts' height
//! gradients, exact for up to [`MOST_HULL`] contacts; for more contacts it is bracketed by the holding forces
//! along the axes. If two or more directions are free to first order, the smallest κ is found by search: the
//! true minimum may be lower.
//!
//! Not promised: the result of higher orders if κ is 0. Features closer to flush than [`super::TOUCHING`]
//! count as flush. Lengths in the metric of the motion, in D.

use super::holding::Holding;
use super::projection::{MAX_COORDINATES, Vector, dot};
use crate::acceptance::Stream;
use crate::contact::Pair;
use crate::polytope::{Polytope, PolytopePoint};
use crate::pose::{PoseError, rotation};
use crate::tolerance::SINGLE;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// A slope below this counts as zero: motions end on slopes as gentle.
const LEVEL: f64 = 1e-3;
/// More gradients than this have no hull in reasonable time.
const MOST_HULL: usize = 40;
/// Gradients steeper than this are walls, and count as if they were as steep.
const STEEPEST: f64 = 500.0;
/// The pushes by which curvature is taken, in D: rounding of 10⁻¹⁶ leaves 10⁻⁹, the next order 10⁻⁷.
const PUSH: f64 = 3e-4;
/// A curvature below this counts as zero, per D: a radius of a thousand widths.
const FLAT: f64 = 1e-3;
/// Curvatures above this count as infinite, per D: a radius of a thousandth of D.
const MOST_CURVED: f64 = 1e3;
/// Number of directions that are tried if several are free to first order, per direction, and of variations
/// of the best.
const TRIES: u64 = 24;
const MOVES: u64 = 48;
/// Change of the load, as a share of the preload, in the test whether a contact can carry.
const MORE: f64 = 1e-3;
/// Number of bisections of the remaining range of the contact forces.
const HALVINGS: usize = 40;

/// Order of immobility of a rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ImmobilityOrder {
    /// Height rises in proportion to the displacement, in every direction.
    First,
    /// In some direction height rises with the square of the displacement.
    Second,
    /// In some direction height neither rises nor falls, to second order.
    Neutral,
    /// In some direction height falls with the square of the displacement: an unstable equilibrium.
    Unstable,
}

impl ImmobilityOrder {
    /// The lower-case name used in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
            Self::Neutral => "neutral",
            Self::Unstable => "unstable",
        }
    }
}

/// Immobility of a rest by its contacts (Rimon and Burdick).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Immobility {
    /// `first`, `second`, `neutral` or `unstable`.
    pub order: ImmobilityOrder,
    /// Bounds on the smallest slope of a first-order rest, in D per D of the metric of the motion; 0 if the
    /// rest is not first-order immobile.
    pub slope: [f64; 2],
    /// Independent directions that are free to first order.
    pub free: usize,
    /// Smallest curvature of the height among these directions, per D: a displacement s raises it by half of
    /// this times s². Null if no direction is free.
    #[serde(rename = "curvature_per_d")]
    pub curvature: Option<f64>,
    /// The direction of smallest curvature: offsets in D and rotations in radians; 0 if no direction is free.
    pub weakest: PoseError,
}

/// Immobility of a rest; `None` if its contacts do not balance the load.
pub fn immobility(pair: &Pair, holding: &Holding, error: &PoseError, seed: u64) -> Option<Immobility> {
    let mut rest = At::new(pair, holding, error)?;
    if rest.is_inside() {
        let slope = rest.slope();
        return Some(Immobility {
            order: ImmobilityOrder::First,
            slope,
            free: 0,
            curvature: None,
            weakest: PoseError::default(),
        });
    }
    rest.keep_carrying();
    let free = rest.free_directions();
    if free.is_empty() {
        // Immobile, but the slope is below the threshold.
        let (slope, weakest) = ([0.0, LEVEL], PoseError::default());
        return Some(Immobility {
            order: ImmobilityOrder::Neutral,
            slope,
            free: 0,
            curvature: None,
            weakest,
        });
    }
    let (curvature, way) = rest.least_curvature(&free, Stream::new(seed))?;
    let order = if curvature > FLAT {
        ImmobilityOrder::Second
    } else if curvature < -FLAT {
        ImmobilityOrder::Unstable
    } else {
        ImmobilityOrder::Neutral
    };
    let weakest = rest.as_error(&way);
    Some(Immobility { order, slope: [0.0; 2], free: free.len(), curvature: Some(curvature), weakest })
}

/// A rest, with its carrying contacts.
struct At<'a> {
    pair: &'a Pair,
    holding: Holding,
    error: PoseError,
    /// Coordinates of displacements that are free, z aside.
    axes: Vec<usize>,
    preload: Vector,
    /// The rows of the contacts that may carry, and which they are.
    carrying: Vec<usize>,
}

impl<'a> At<'a> {
    fn new(pair: &'a Pair, holding: &Holding, error: &PoseError) -> Option<Self> {
        let mut holding = holding.clone();
        let preload = holding.preload(0.0)?;
        let axes =
            pair.alignment.free.iter().map(|dof| if dof.index() < 2 { dof.index() } else { dof.index() + 1 });
        let carrying = (0..holding.rows().len()).collect();
        Some(Self { pair, holding, error: *error, axes: axes.collect(), preload, carrying })
    }

    /// Whether a small load along every axis is held, either way: the load lies inside of the cone.
    fn is_inside(&mut self) -> bool {
        let axes = self.axes.clone();
        axes.iter().all(|axis| {
            [LEVEL, -LEVEL].iter().all(|more| {
                let mut push = self.preload;
                push[*axis] += more;
                self.holding.holds(&push, 0.0)
            })
        })
    }

    /// The smallest slope: that of the nearest facet of the hull of all gradients, or bounds from the holding
    /// forces along the axes.
    fn slope(&mut self) -> [f64; 2] {
        let mut gradients: Vec<PolytopePoint> = Vec::new();
        for row in self.holding.rows() {
            let size = self.axes.iter().map(|axis| row[*axis] * row[*axis]).sum::<f64>().sqrt();
            let up = row[2].max(size / STEEPEST);
            if up <= 0.0 {
                continue;
            }
            let mut gradient = [0.0; MAX_COORDINATES];
            for (k, axis) in self.axes.iter().enumerate() {
                gradient[k] = -row[*axis] / up;
            }
            if gradients.iter().all(|other| distance(other, &gradient) > SINGLE) {
                gradients.push(gradient);
            }
        }
        if gradients.len() <= MOST_HULL
            && let Some(hull) = Polytope::hull(self.axes.len(), &gradients)
        {
            let least = hull.facets().iter().map(|facet| facet.offset).fold(f64::INFINITY, f64::min);
            return [least; 2];
        }
        let (axes, spherical) = (self.axes.clone(), self.axes.len() as f64);
        let mut least = f64::INFINITY;
        for axis in axes {
            for sign in [1.0, -1.0] {
                let mut load = [0.0; MAX_COORDINATES];
                load[axis] = sign;
                least = least.min(self.holding.largest(&load, 0.0).unwrap_or(0.0));
            }
        }
        // The ball in the cross-polytope of the holding forces along the axes.
        [least / spherical.sqrt(), least]
    }

    /// Keeps the contacts that carry something under some forces that hold the load.
    fn keep_carrying(&mut self) {
        let rows = self.holding.rows().to_vec();
        let carries = |at: &mut Self, k: usize| {
            let push: Vector = std::array::from_fn(|j| at.preload[j] + MORE * rows[k][j]);
            at.holding.holds(&push, 0.0)
        };
        self.carrying = (0..rows.len()).filter(|k| carries(self, *k)).collect();
    }

    /// Directions that all contacts which carry leave free to first order: orthonormal.
    fn free_directions(&self) -> Vec<Vector> {
        let mut held: Vec<Vector> = Vec::new();
        for k in &self.carrying {
            let mut row = self.holding.rows()[*k];
            row[2] = 0.0;
            take_out(&mut row, &held);
            if let Some(row) = unit(&row, LEVEL) {
                held.push(row);
            }
        }
        let mut free: Vec<Vector> = Vec::new();
        for axis in &self.axes {
            let mut way = [0.0; MAX_COORDINATES];
            way[*axis] = 1.0;
            take_out(&mut way, &held);
            take_out(&mut way, &free);
            if let Some(way) = unit(&way, LEVEL) {
                free.push(way);
            }
        }
        free
    }

    /// The smallest curvature over directions that no other contact blocks, with its direction.
    fn least_curvature(&mut self, free: &[Vector], stream: Stream) -> Option<(f64, Vector)> {
        let combined = |parts: &[f64]| -> Option<Vector> {
            let mut way = [0.0; MAX_COORDINATES];
            for (part, direction) in parts.iter().zip(free) {
                (0..MAX_COORDINATES).for_each(|k| way[k] += part * direction[k]);
            }
            unit(&way, SINGLE)
        };
        let count = free.len();
        let axis =
            |k: usize, sign: f64| (0..count).map(|j| if j == k { sign } else { 0.0 }).collect::<Vec<_>>();
        let mut tried: Vec<Vec<f64>> = (0..count).flat_map(|k| [axis(k, 1.0), axis(k, -1.0)]).collect();
        if count > 1 {
            tried.extend((0..TRIES * count as u64).map(|k| random(stream, k, count)));
        }
        let mut best: Option<(f64, Vec<f64>, Vector)> = None;
        for parts in tried {
            let Some(way) = combined(&parts).filter(|way| self.is_open(way)) else { continue };
            let result = self.curvature(&way);
            if best.as_ref().is_none_or(|(least, ..)| result < *least) {
                best = Some((result, parts, way));
            }
        }
        if count > 1 {
            for k in 0..MOVES {
                let Some((least, at, _)) = best.clone() else { break };
                // Smaller and smaller moves: from a radian to a hundredth.
                let share = 0.01f64.powf(k as f64 / MOVES as f64);
                let moves = random(stream, TRIES * count as u64 + k, count);
                let parts: Vec<f64> = at.iter().zip(moves).map(|(a, b)| a + share * b).collect();
                let Some(way) = combined(&parts).filter(|way| self.is_open(way)) else { continue };
                let result = self.curvature(&way);
                if result < least {
                    best = Some((result, parts, way));
                }
            }
        }
        best.map(|(least, _, way)| (least, way))
    }

    /// Whether no contact that does not carry stands in the way.
    fn is_open(&self, way: &Vector) -> bool {
        self.holding.rows().iter().all(|row| dot(row, way) > -LEVEL)
    }

    /// κ of a direction that is free to first order: the most that forces which hold the load make of how the gaps bend.
    fn curvature(&mut self, way: &Vector) -> f64 {
        let rows = self.holding.rows();
        let bends: Vec<f64> = self.carrying.iter().map(|k| -self.bend(*k, way)).collect();
        // The direction is free: each row may carry the bend of its gap along it, and the load their weighted
        // sum.
        let rows: Vec<Vector> = self
            .carrying
            .iter()
            .zip(&bends)
            .map(|(k, bend)| {
                let along = dot(&rows[*k], way);
                std::array::from_fn(|j| rows[*k][j] + (bend - along) * way[j])
            })
            .collect();
        let along = dot(&self.preload, way);
        let load: Vector = std::array::from_fn(|j| self.preload[j] - along * way[j]);
        let with = |kappa: f64| -> Vector { std::array::from_fn(|j| load[j] - kappa * way[j]) };
        let mut one = self.holding.some(&self.carrying);
        let mut most: f64 = one.forces(&load).iter().map(|(k, force)| force * bends[*k]).sum();
        one.replace_rows(rows);
        let (mut held, mut step) = (most, FLAT * FLAT);
        while step < MOST_CURVED && one.holds(&with(held + step), 0.0) {
            held += step;
            step *= 2.0;
        }
        if held > most {
            let (mut from, mut to) = (held, held + step);
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(from, to);
                if one.holds(&with(middle), 0.0) { from = middle } else { to = middle }
            }
            most = from;
        }
        most
    }

    /// The second derivative of the gap of a contact along a direction.
    fn bend(&self, contact: usize, way: &Vector) -> f64 {
        let gap = |push: f64| {
            let (rotation, cor) = self.displaced(way, push);
            let (before, meeting) = &self.holding.contacts()[contact];
            self.pair.contact(before, meeting, &rotation, cor).gap
        };
        (gap(PUSH) + gap(-PUSH) - 2.0 * gap(0.0)) / (PUSH * PUSH)
    }

    fn displaced(&self, way: &Vector, push: f64) -> (DMat3, DVec3) {
        let cor = self.holding.cor() + DVec3::new(way[0], way[1], 0.0) * push;
        let turn = [way[3], way[4], way[5]].map(|part| part * push / self.pair.alignment.rotation_length);
        let turned = if self.pair.alignment.free.rotations() == 3 {
            let by = DVec3::from_array(turn);
            let spun =
                by.try_normalize().map_or(DMat3::IDENTITY, |axis| DMat3::from_axis_angle(axis, by.length()));
            spun * *self.holding.rotation()
        } else {
            let PoseError { roll, pitch, yaw, .. } = self.error;
            rotation(roll + turn[0], pitch + turn[1], yaw + turn[2])
        };
        (turned, cor)
    }

    fn as_error(&self, way: &Vector) -> PoseError {
        let rho = self.pair.alignment.rotation_length;
        PoseError { x: way[0], y: way[1], roll: way[3] / rho, pitch: way[4] / rho, yaw: way[5] / rho }
    }
}

fn distance(a: &PolytopePoint, b: &PolytopePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Removes from a vector its components along orthonormal vectors.
fn take_out(vector: &mut Vector, from: &[Vector]) {
    for other in from {
        let along = dot(vector, other);
        (0..MAX_COORDINATES).for_each(|k| vector[k] -= along * other[k]);
    }
}

/// Of length 1, if it is longer than `least`.
fn unit(vector: &Vector, least: f64) -> Option<Vector> {
    let size = dot(vector, vector).sqrt();
    (size > least).then(|| vector.map(|part| part / size))
}

/// So many numbers in (−1, 1), group k of a stream.
fn random(stream: Stream, k: u64, count: usize) -> Vec<f64> {
    (0..count as u64).map(|j| 2.0 * stream.uniform(MAX_COORDINATES as u64 * k + j) - 1.0).collect()
}
