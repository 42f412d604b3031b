//! The remainder of every facet: the facet minus the sections of other solids just above it, and minus the
//! parts of the same face that an earlier solid covers.
//!
//! Computed plane by plane, in the two coordinates other than the largest of its normal, on a lattice of 2⁻⁵⁰
//! of the largest coordinate, so that a corner has the same two numbers in every use. Areas narrower than w
//! come from the rounding of abutting faces: such a solid removes nothing.

use super::UnionProblem;
use super::planes::Model;
use super::section::Cutter;
use crate::mesh::tree::overlap;
use catchment_base::disjoint::DisjointSets;
use catchment_base::exec::Exec;
use glam::DVec3;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::i_float::int::point::IntPoint;
use std::collections::BTreeMap;

type Node = IntPoint<i64>;
type Ring = Vec<Node>;

/// The remainders of all facets.
pub(super) struct Left {
    /// Of every facet its loops, interior on the left seen from outside; of those that lost nothing, its corners.
    pub(super) loops: Vec<Vec<Vec<u32>>>,
    /// Solids that share area or volume.
    pub(super) joined: DisjointSets,
}

/// Removes from every facet the parts that others cover.
pub(super) fn left(model: &mut Model, exec: &Exec) -> Result<Left, UnionProblem> {
    let whole = |facet: &super::planes::Facet| {
        if facet.corners.is_empty() { Vec::new() } else { vec![facet.corners.clone()] }
    };
    let mut loops: Vec<Vec<Vec<u32>>> = model.facets.iter().map(whole).collect();
    let mut joined = DisjointSets::new(model.boxes.len());
    for plane in 0..model.planes.len() as u32 {
        exec.check()?;
        let mut sheet = Sheet::of(model, plane);
        for k in model.members[plane as usize].clone() {
            let facet = model.facets[k as usize].clone();
            let around = model.widened(facet.bounds);
            let others: Vec<u32> = (0..model.boxes.len() as u32)
                .filter(|other| *other != facet.solid && overlap(model.boxes[*other as usize], around))
                .collect();
            if others.is_empty() {
                continue;
            }
            let mut rings = vec![sheet.ring(model, &facet.corners)];
            let is_cut = others.into_iter().fold(false, |is_cut, other| {
                let mut cover = sheet.cover(model, other, facet.is_forward);
                if other < facet.solid {
                    cover.extend(sheet.same_face(model, other, facet.is_forward));
                }
                if !sheet.has_area(&rings, &cover) {
                    return is_cut;
                }
                joined.join(facet.solid, other);
                rings = overlaid(&rings, &cover, OverlayRule::Difference);
                true
            });
            if is_cut {
                loops[k as usize] =
                    rings.iter().map(|ring| sheet.numbers(model, ring, facet.is_forward)).collect();
            }
        }
    }
    Ok(Left { loops, joined })
}

/// A plane on a lattice.
struct Sheet {
    plane: u32,
    /// The coordinate that is left out.
    axis: usize,
    scale: f64,
    /// Points by their places.
    numbers: BTreeMap<[i64; 2], u32>,
    cutter: Cutter,
    covers: BTreeMap<(u32, bool), Vec<Ring>>,
    /// Lattice steps of w.
    narrow: f64,
}

impl Sheet {
    fn of(model: &Model, plane: u32) -> Self {
        let axis = model.planes[plane as usize].normal.abs().max_position();
        let scale = model.scale;
        let (numbers, covers) = (BTreeMap::new(), BTreeMap::new());
        Self { plane, axis, scale, numbers, cutter: Cutter::new(plane), covers, narrow: model.w * scale }
    }

    /// The two coordinates that are kept, so that a turn from the first to the second is counter-clockwise seen along the third.
    fn flat(&self, p: DVec3) -> [f64; 2] {
        let p = p.to_array();
        [p[(self.axis + 1) % 3], p[(self.axis + 2) % 3]]
    }

    /// Points as a ring of lattice points, which are remembered.
    fn ring(&mut self, model: &Model, corners: &[u32]) -> Ring {
        corners
            .iter()
            .map(|corner| {
                let [x, y] =
                    self.flat(model.points[*corner as usize]).map(|v| (v * self.scale).round() as i64);
                self.numbers.entry([x, y]).or_insert(*corner);
                Node::new(x, y)
            })
            .collect()
    }

    /// Section of a solid on one side of the plane.
    fn cover(&mut self, model: &mut Model, solid: u32, is_above: bool) -> Vec<Ring> {
        if let Some(cover) = self.covers.get(&(solid, is_above)) {
            return cover.clone();
        }
        let loops = self.cutter.filled(model, solid, is_above);
        let cover: Vec<Ring> = loops.iter().map(|ring| self.ring(model, ring)).collect();
        self.covers.insert((solid, is_above), cover.clone());
        cover
    }

    /// The facets that a solid has in the plane and that face the same way.
    fn same_face(&mut self, model: &Model, solid: u32, is_forward: bool) -> Vec<Ring> {
        model.members[self.plane as usize]
            .iter()
            .map(|k| &model.facets[*k as usize])
            .filter(|facet| facet.solid == solid && facet.is_forward == is_forward)
            .map(|facet| self.ring(model, &facet.corners))
            .collect()
    }

    /// Whether two regions share more than a sliver.
    fn has_area(&self, rings: &[Ring], cover: &[Ring]) -> bool {
        if rings.is_empty() || cover.is_empty() {
            return false;
        }
        let [own, other] = [rings, cover].map(around);
        let shared = [0, 1].map(|k| own.1[k].min(other.1[k]) - own.0[k].max(other.0[k]));
        shared.iter().all(|width| *width as f64 > self.narrow)
            && overlaid(rings, cover, OverlayRule::Intersect).iter().any(|ring| !self.is_narrow(ring))
    }

    fn is_narrow(&self, ring: &Ring) -> bool {
        let next = |k: usize| ring[(k + 1) % ring.len()];
        let sides = || ring.iter().enumerate().map(|(k, p)| [*p, next(k)]);
        let length = |[p, q]: [Node; 2]| ((q.x - p.x) as f64).hypot((q.y - p.y) as f64);
        let Some(first) = ring.first() else { return true };
        let doubled: f64 = sides()
            .map(|[p, q]| {
                let [px, py, qx, qy] =
                    [p.x - first.x, p.y - first.y, q.x - first.x, q.y - first.y].map(|v| v as f64);
                px * qy - py * qx
            })
            .sum();
        doubled.abs() <= self.narrow * sides().map(length).sum::<f64>()
    }

    /// The numbers of the points of a ring, in its sense seen from outside of a facet; new points are made in the plane.
    fn numbers(&mut self, model: &mut Model, ring: &Ring, is_forward: bool) -> Vec<u32> {
        let plane = model.planes[self.plane as usize];
        let mut numbers: Vec<u32> = ring
            .iter()
            .map(|node| {
                *self.numbers.entry([node.x, node.y]).or_insert_with(|| {
                    let mut p = [0.0; 3];
                    p[(self.axis + 1) % 3] = node.x as f64 / self.scale;
                    p[(self.axis + 2) % 3] = node.y as f64 / self.scale;
                    p[self.axis] = -plane.height(DVec3::from_array(p)) / plane.normal[self.axis];
                    model.points.push(DVec3::from_array(p));
                    model.points.len() as u32 - 1
                })
            })
            .collect();
        // Seen along the coordinate that was left out, the facet may face the other way.
        if (plane.normal[self.axis] > 0.0) != is_forward {
            numbers.reverse();
        }
        numbers
    }
}

/// The box around rings.
fn around(rings: &[Ring]) -> ([i64; 2], [i64; 2]) {
    rings.iter().flatten().fold(([i64::MAX; 2], [i64::MIN; 2]), |(low, high), p| {
        ([low[0].min(p.x), low[1].min(p.y)], [high[0].max(p.x), high[1].max(p.y)])
    })
}

/// Rings of the result, outer rings counter-clockwise, holes clockwise.
fn overlaid(subject: &[Ring], clip: &[Ring], rule: OverlayRule) -> Vec<Ring> {
    let capacity = subject.iter().chain(clip).map(Vec::len).sum();
    let mut overlay = Overlay::<i64>::new_custom(capacity, IntOverlayOptions::default(), Solver::default());
    overlay.add_source(subject, ShapeType::Subject);
    overlay.add_source(clip, ShapeType::Clip);
    overlay.overlay(rule, FillRule::NonZero).into_iter().flatten().collect()
}
