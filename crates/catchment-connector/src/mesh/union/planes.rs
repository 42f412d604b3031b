//! Merging of corners, and grouping of facets by plane.
//!
//! Touching facets that lie in a common plane within 2w, whatever their orientation, share the plane of the
//! largest of them. Facets without contact to the group may have their own plane that is equal to rounding;
//! no result depends on that.

use super::super::tree::{Bounds, Tree, overlap};
use crate::Surface;
use glam::DVec3;

/// Distance from a plane, in w, below which a corner lies in it: welding moves a corner by up to one w.
const ON_PLANE: f64 = 2.0;
/// Facets whose normals differ by more than this cosine are not coplanar, however small they are.
const SAME_WAY: f64 = 0.9;

/// A plane `normal · p = level`, `normal` of unit length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    pub(super) normal: DVec3,
    pub(super) level: f64,
}

impl Plane {
    /// Height of a point above it.
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.level
    }
}

/// A facet of a solid.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    pub(super) solid: u32,
    /// Numbers of its corners, counter-clockwise seen from outside; empty if welding left it no area.
    pub(super) corners: Vec<u32>,
    /// The number of its plane.
    pub(super) plane: u32,
    /// Whether it faces as the normal of its plane does.
    pub(super) is_forward: bool,
    pub(super) bounds: Bounds,
}

/// The solids, with shared corners and planes.
#[derive(Debug)]
pub(super) struct Model {
    /// The corners of all solids, and those that are made on the way.
    pub(super) points: Vec<DVec3>,
    pub(super) facets: Vec<Facet>,
    pub(super) planes: Vec<Plane>,
    /// The facets of every plane.
    pub(super) members: Vec<Vec<u32>>,
    /// Of every solid the numbers of its facets.
    pub(super) of_solid: Vec<std::ops::Range<u32>>,
    /// The box around every solid.
    pub(super) boxes: Vec<Bounds>,
    pub(super) w: f64,
    /// Steps of the lattice per D.
    pub(super) scale: f64,
}

/// Bits of the largest coordinate on the lattice.
const BITS: i32 = 50;

impl Model {
    pub(super) fn of(surfaces: &[Surface], w: f64) -> Self {
        let all: Vec<DVec3> = surfaces.iter().flat_map(|surface| surface.vertices.iter().copied()).collect();
        let same = welded(&all, w);
        let mut facets = Vec::new();
        let mut of_solid = Vec::new();
        let mut first = 0;
        for (solid, surface) in (0u32..).zip(surfaces) {
            let start = facets.len() as u32;
            for facet in &surface.facets {
                let mut corners: Vec<u32> = facet.corners.iter().map(|k| same[first + *k as usize]).collect();
                corners.dedup();
                while corners.len() > 1 && corners.first() == corners.last() {
                    corners.pop();
                }
                if corners.len() < 3 {
                    corners.clear();
                }
                let bounds = bounds_of(corners.iter().map(|k| all[*k as usize]));
                facets.push(Facet { solid, corners, plane: u32::MAX, is_forward: true, bounds });
            }
            of_solid.push(start..facets.len() as u32);
            first += surface.vertices.len();
        }
        let boxes = surfaces.iter().map(Surface::bounds).collect();
        let (planes, members) = (Vec::new(), Vec::new());
        let size = all.iter().fold(f64::MIN_POSITIVE, |size, p| size.max(p.abs().max_element()));
        let scale = f64::from(BITS - size.log2().ceil() as i32).exp2();
        let mut model = Self { points: all, facets, planes, members, of_solid, boxes, w, scale };
        model.find_planes();
        model
    }

    /// Gives every facet its plane, the largest facets first.
    fn find_planes(&mut self) {
        let area = |corners: &[u32]| -> DVec3 {
            let Some(&first) = corners.first() else { return DVec3::ZERO };
            let at = |k: u32| self.points[k as usize] - self.points[first as usize];
            corners.windows(2).map(|pair| at(pair[0]).cross(at(pair[1]))).sum()
        };
        let areas: Vec<DVec3> = self.facets.iter().map(|facet| area(&facet.corners)).collect();
        let near: Vec<Bounds> = self.facets.iter().map(|facet| self.widened(facet.bounds)).collect();
        let tree = Tree::over(&near);
        let mut order: Vec<u32> = (0..self.facets.len() as u32).collect();
        order.sort_by(|a, b| {
            areas[*b as usize].length_squared().total_cmp(&areas[*a as usize].length_squared()).then(a.cmp(b))
        });
        let mut touching = Vec::new();
        for k in order {
            let own = &self.facets[k as usize];
            let Some(normal) = areas[k as usize].try_normalize() else {
                self.facets[k as usize].corners.clear();
                continue;
            };
            touching.clear();
            tree.visit(
                |bounds| overlap(bounds, own.bounds),
                |other| {
                    if overlap(near[other], own.bounds) {
                        touching.push(self.facets[other].plane);
                    }
                },
            );
            touching.sort_unstable();
            touching.dedup();
            let is_level = |plane: &u32| {
                let plane = self.planes.get(*plane as usize)?;
                (plane.normal.dot(normal).abs() > SAME_WAY && self.is_in(&own.corners, plane)).then_some(())
            };
            let mut level: Vec<u32> =
                touching.iter().copied().filter(|plane| is_level(plane).is_some()).collect();
            let plane = if level.is_empty() {
                let middle = own.corners.iter().map(|c| normal.dot(self.points[*c as usize])).sum::<f64>();
                self.planes.push(Plane { normal, level: middle / own.corners.len() as f64 });
                self.members.push(Vec::new());
                self.planes.len() as u32 - 1
            } else {
                level.remove(0)
            };
            // Planes that touch only through this face may coincide, too.
            for other in level {
                self.merge(other, plane);
            }
            self.members[plane as usize].push(k);
            let is_forward = self.planes[plane as usize].normal.dot(normal) > 0.0;
            let facet = &mut self.facets[k as usize];
            (facet.plane, facet.is_forward) = (plane, is_forward);
        }
        for members in &mut self.members {
            members.sort_unstable();
        }
    }

    /// Moves the facets of a plane to another plane, if they lie in it.
    fn merge(&mut self, from: u32, into: u32) {
        let plane = self.planes[into as usize];
        let corners = |k: &u32| &self.facets[*k as usize].corners;
        if !self.members[from as usize].iter().all(|k| self.is_in(corners(k), &plane)) {
            return;
        }
        let is_turned = plane.normal.dot(self.planes[from as usize].normal) < 0.0;
        let members = std::mem::take(&mut self.members[from as usize]);
        for k in &members {
            let facet = &mut self.facets[*k as usize];
            facet.plane = into;
            facet.is_forward ^= is_turned;
        }
        self.members[into as usize].extend(members);
    }

    /// Whether corners lie in a plane.
    fn is_in(&self, corners: &[u32], plane: &Plane) -> bool {
        corners.iter().all(|corner| plane.height(self.points[*corner as usize]).abs() <= self.on_plane())
    }

    /// Height above a plane below which a corner lies in it, in D.
    pub(super) fn on_plane(&self) -> f64 {
        ON_PLANE * self.w
    }

    /// A box enlarged by the rounding distance.
    pub(super) fn widened(&self, (low, high): Bounds) -> Bounds {
        (low - self.on_plane(), high + self.on_plane())
    }
}

/// The box around points.
pub(super) fn bounds_of(points: impl Iterator<Item = DVec3>) -> Bounds {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

/// For every point the first point within `tolerance` that represents itself.
pub(super) fn welded(points: &[DVec3], tolerance: f64) -> Vec<u32> {
    let boxes: Vec<Bounds> = points.iter().map(|p| (*p - tolerance, *p + tolerance)).collect();
    let tree = Tree::over(&boxes);
    let mut same: Vec<u32> = (0..points.len() as u32).collect();
    for (k, p) in points.iter().enumerate() {
        let mut first = k;
        tree.visit(
            |bounds| overlap(bounds, (*p, *p)),
            |other| {
                if other < first && same[other] as usize == other && points[other].distance(*p) <= tolerance {
                    first = other;
                }
            },
        );
        same[k] = first as u32;
    }
    same
}
