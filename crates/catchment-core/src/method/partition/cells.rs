//! The cells of the contact space and the gates through which motion leaves them.
//!
//! ```text
//!        ┌───────────┐           q̇ = −M⁻¹ ∇h is constant over a cell, so the points that leave through a
//!        │   cell    │           part of a facet are that part, swept back along −q̇: convex again
//!        │    ↘      │
//!        └──▓▓▓▓▓────┘  gate     through it: into a lower cell, along a ravine, off the halves, out of the box
//!           ▓ next ▓
//! ```
//!
//! Neighbours are found through an R-tree of bounding boxes (the original compared all pairs, which took most
//! of its time).

use super::compose::Compartment;
use super::space::{Affine, Tile};
use crate::polytope::{Halfspace, MAX_DIMENSION, Polytope, PolytopePoint, RESOLUTION};
use crate::pose::{Dof, DofSet, ROTATIONS, euler_rates};
use crate::tolerance::PARALLEL;
use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};
use std::array;

/// Heights closer than this are equal, in D: ten times the error of a vertex on a plane, at slopes up to 10.
pub(super) const LEVEL: f64 = 100.0 * RESOLUTION;

/// Cells meet if they are this close, in D and radians: cuts move their corners by a few times the
/// resolution.
pub(super) const TOUCH: f64 = 16.0 * RESOLUTION;

/// A part of the contact space with the motion over it.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// The pose errors (of the COR) over which it lies.
    pub(super) region: Polytope,
    /// Height of first contact.
    pub(super) height: Affine,
    /// `−M⁻¹∇h`, per unit of mobility.
    pub(super) velocity: PolytopePoint,
    /// How fast the height falls along it: the squared slope in the ρ-metric.
    pub(super) descent: f64,
    /// Exits of its motion.
    pub(super) gates: Vec<Gate>,
}

/// A part of a facet through which all motion continues in the same way.
#[derive(Debug, Clone)]
pub(super) struct Gate {
    /// The facet of the cell.
    pub(super) facet: usize,
    /// The coordinate that the facet's plane gives from the others.
    pub(super) dropped: usize,
    /// The part, in the other coordinates.
    pub(super) region: Polytope,
    /// The region beyond.
    pub(super) to: GateTarget,
}

/// The region beyond a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GateTarget {
    /// A cell that is not higher there.
    Cell(usize),
    /// A cell with opposing motion, or a wall: motion continues along the gate itself.
    Ravine,
    /// No contact.
    Nothing,
    /// The last slice of a rotation.
    Border,
}

/// All cells with an index over their boxes.
#[derive(Debug)]
pub(super) struct Cells {
    /// The cells.
    pub(super) all: Vec<Cell>,
    index: RTree<Boxed>,
    /// Lowest and highest pose error of every free rotation, at its place among the coordinates.
    limits: Vec<(usize, [f64; 2])>,
}

type Boxed = GeomWithData<Rectangle<PolytopePoint>, usize>;

fn rectangle(polytope: &Polytope, margin: f64) -> AABB<PolytopePoint> {
    let (low, high) = polytope.bounds();
    AABB::from_corners(low.map(|v| v - margin), high.map(|v| v + margin))
}

impl Cells {
    /// Cells of the tiles of each compartment, with their gates.
    pub(super) fn new(
        tiles: &[(Compartment, Vec<Tile>)],
        free: DofSet,
        rotation_length: f64,
        limits: Vec<(usize, [f64; 2])>,
    ) -> Self {
        let cells: Vec<Cell> = tiles
            .iter()
            .flat_map(|(_, tiles)| tiles)
            .map(|tile| Cell::new(tile, free, rotation_length))
            .collect();
        let boxed =
            |(k, cell): (usize, &Cell)| Boxed::new(Rectangle::from_aabb(rectangle(&cell.region, 0.0)), k);
        let index = RTree::bulk_load(cells.iter().enumerate().map(boxed).collect());
        Self { all: cells, index, limits }
    }

    /// The cells whose boxes meet that of `polytope`, in order.
    fn near(&self, polytope: &Polytope) -> Vec<usize> {
        let envelope = rectangle(polytope, TOUCH);
        let mut near: Vec<usize> =
            self.index.locate_in_envelope_intersecting(envelope).map(|boxed| boxed.data).collect();
        near.sort_unstable();
        near
    }

    /// The cells that hold `q`, in order.
    pub(super) fn holding(&self, q: &PolytopePoint) -> Vec<usize> {
        let envelope = AABB::from_corners(q.map(|v| v - TOUCH), q.map(|v| v + TOUCH));
        let mut holding: Vec<usize> = self
            .index
            .locate_in_envelope_intersecting(envelope)
            .map(|boxed| boxed.data)
            .filter(|k| touches(&self.all[*k].region, q))
            .collect();
        holding.sort_unstable();
        holding
    }

    /// The gates of a cell.
    pub(super) fn gates_of(&self, k: usize) -> Vec<Gate> {
        let cell = &self.all[k];
        let near = self.near(&cell.region);
        let mut gates = Vec::new();
        for (facet, plane) in cell.region.facets().iter().enumerate() {
            if !cell.crosses(plane) {
                continue;
            }
            let dropped = steepest_axis(plane, cell.region.dimension());
            let Some(whole) = cell.region.facet_projected(facet, dropped) else { continue };
            let mut open = vec![whole];
            for &other in near.iter().filter(|other| **other != k) {
                let neighbour = &self.all[other];
                let Some(back) = facing(&neighbour.region, plane) else { continue };
                let Some(side) = neighbour.region.facet_projected(back, dropped) else { continue };
                let shared: Vec<Polytope> = open.iter().filter_map(|part| part.intersection(&side)).collect();
                if shared.is_empty() {
                    continue;
                }
                open = open.iter().flat_map(|part| part.difference(&side)).collect();
                let counter = neighbour.crosses(&plane.flipped());
                for part in shared {
                    for (region, rise) in self.split_at_steps(part, k, other, plane, dropped) {
                        let to = match rise {
                            Step::Up => GateTarget::Ravine,
                            Step::Level if counter => GateTarget::Ravine,
                            Step::Level | Step::Down => GateTarget::Cell(other),
                        };
                        gates.push(Gate { facet, dropped, region, to });
                    }
                }
            }
            let to = if self.on_border(plane) { GateTarget::Border } else { GateTarget::Nothing };
            // Narrower gaps are left by rounding between cells that meet.
            let is_gap = |region: &Polytope| {
                let (low, high) = region.bounds();
                (0..region.dimension()).any(|k| high[k] - low[k] <= LEVEL)
            };
            let open = open.into_iter().filter(|region| !is_gap(region));
            gates.extend(open.map(|region| Gate { facet, dropped, region, to }));
        }
        gates
    }

    /// Whether a facet's plane is the last slice of a rotation.
    pub(super) fn on_border(&self, plane: &Halfspace) -> bool {
        self.limits.iter().any(|&(axis, [low, high])| {
            let at = plane.offset * plane.normal[axis];
            plane.normal[axis].abs() > 1.0 - PARALLEL
                && ((at - low).abs() <= LEVEL || (at - high).abs() <= LEVEL)
        })
    }

    /// A shared part of a facet, cut at the line at which the height step changes from up to down.
    fn split_at_steps(
        &self,
        part: Polytope,
        from: usize,
        to: usize,
        plane: &Halfspace,
        dropped: usize,
    ) -> Vec<(Polytope, Step)> {
        let [from, to] = [from, to].map(|k| self.all[k].height);
        let rises = |polytope: &Polytope| {
            let rise = |y: &PolytopePoint| {
                let q = lifted(y, plane, dropped);
                to.at(&q) - from.at(&q)
            };
            polytope
                .vertices()
                .iter()
                .map(rise)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], r| [low.min(r), high.max(r)])
        };
        let step = |polytope: &Polytope| match rises(polytope) {
            [low, high] if low >= -LEVEL && high <= LEVEL => Step::Level,
            [low, _] if low >= -LEVEL => Step::Up,
            _ => Step::Down,
        };
        let [low, high] = rises(&part);
        if low < -LEVEL && high > LEVEL {
            // The rise is affine over the facet: q_dropped = (offset − Σ n y)/n_dropped.
            let n = plane.normal;
            let slope: PolytopePoint = array::from_fn(|k| to.slope[k] - from.slope[k]);
            let per_dropped = slope[dropped] / n[dropped];
            let normal = removed(&array::from_fn(|k| slope[k] - per_dropped * n[k]), dropped);
            let level = to.level - from.level + per_dropped * plane.offset;
            if let Some(cut) = Halfspace::new(normal, -level) {
                let (down, up) = part.split(&cut);
                return down
                    .map(|part| (part, Step::Down))
                    .into_iter()
                    .chain(up.map(|part| (part, Step::Up)))
                    .collect();
            }
        }
        let step = step(&part);
        vec![(part, step)]
    }
}

/// Change of the height beyond a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Up,
    Level,
    Down,
}

impl Cell {
    fn new(tile: &Tile, free: DofSet, rotation_length: f64) -> Self {
        let slope = &tile.height.slope;
        let velocity = mobility(&tile.region.centroid(), free, rotation_length, slope).map(|v| -v);
        let descent = -dot(&velocity, slope);
        Self { region: tile.region.clone(), height: tile.height, velocity, descent, gates: Vec::new() }
    }

    /// Whether motion leaves the cell through a facet with this outward plane.
    pub(super) fn crosses(&self, plane: &Halfspace) -> bool {
        let speed = dot(&self.velocity, &self.velocity).sqrt();
        // No slope, no motion: below it the height changes by less than its own error over the whole box.
        self.descent > LEVEL * LEVEL && dot(&self.velocity, &plane.normal) > PARALLEL * speed
    }

    /// The part of the cell that leaves through `through`, a part of the plane of one of its facets.
    pub(super) fn upstream(&self, facet: usize, dropped: usize, through: &Polytope) -> Option<Polytope> {
        let plane = &self.region.facets()[facet];
        let speed = dot(&self.velocity, &plane.normal);
        // q is carried to y = q + t·v on the plane, t = (offset − n·q)/(n·v): c·y ≤ e is a half-space of q.
        let swept = through.facets().iter().filter_map(|side| {
            let c = inserted(&side.normal, dropped);
            let along = dot(&c, &self.velocity) / speed;
            let normal = array::from_fn(|k| c[k] - along * plane.normal[k]);
            Halfspace::new(normal, side.offset - along * plane.offset)
        });
        let swept: Vec<Halfspace> = swept.collect();
        self.region.intersection_of(&swept)
    }
}

/// `M⁻¹ g` in the ρ-metric, the turn from the rates of the free Euler angles at the pose error `q`.
fn mobility(q: &PolytopePoint, free: DofSet, rotation_length: f64, g: &PolytopePoint) -> PolytopePoint {
    let places: Vec<Dof> = free.iter().collect();
    let place = |dof: Dof| places.iter().position(|free| *free == dof);
    let of = |values: &PolytopePoint, dof: Dof| place(dof).map_or(0.0, |k| values[k]);
    let torque = ROTATIONS.map(|dof| of(g, dof));
    // Singular only at the pole of the Euler angles; no cell has its centroid there.
    let rates = euler_rates(of(q, Dof::Pitch), of(q, Dof::Yaw), free, rotation_length, torque);
    let mut mobile = *g;
    for (rate, dof) in rates.into_iter().zip(ROTATIONS) {
        if let Some(k) = place(dof) {
            mobile[k] = rate;
        }
    }
    mobile
}

/// Whether a point is in a polytope, or touches it.
pub(super) fn touches(polytope: &Polytope, q: &PolytopePoint) -> bool {
    polytope.facets().iter().all(|facet| facet.excess(q) <= TOUCH)
}

/// The facet of `polytope` that lies on `plane` and faces it.
pub(super) fn facing(polytope: &Polytope, plane: &Halfspace) -> Option<usize> {
    // Two unit normals that differ by this much part by less than LEVEL over the box.
    let opposed = |facet: &Halfspace| {
        (facet.offset + plane.offset).abs() <= LEVEL
            && (0..MAX_DIMENSION).all(|k| (facet.normal[k] + plane.normal[k]).abs() <= LEVEL)
    };
    polytope.facets().iter().position(opposed)
}

/// The axis along which a plane's normal is longest.
fn steepest_axis(plane: &Halfspace, dimension: usize) -> usize {
    (1..dimension).fold(0, |best, k| if plane.normal[k].abs() > plane.normal[best].abs() { k } else { best })
}

/// The point of `plane` whose coordinates but `dropped` are `y`.
pub(super) fn lifted(y: &PolytopePoint, plane: &Halfspace, dropped: usize) -> PolytopePoint {
    let mut q = inserted(y, dropped);
    q[dropped] = (plane.offset - dot(&q, &plane.normal)) / plane.normal[dropped];
    q
}

/// `y` with a zero put in at `axis`.
fn inserted(y: &PolytopePoint, axis: usize) -> PolytopePoint {
    array::from_fn(|k| match k {
        k if k < axis => y[k],
        k if k == axis => 0.0,
        k => y[k - 1],
    })
}

/// `q` without its coordinate `axis`.
pub(super) fn removed(q: &PolytopePoint, axis: usize) -> PolytopePoint {
    array::from_fn(|k| match k {
        k if k < axis => q[k],
        k if k + 1 < MAX_DIMENSION => q[k + 1],
        _ => 0.0,
    })
}

pub(super) fn dot(a: &PolytopePoint, b: &PolytopePoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
