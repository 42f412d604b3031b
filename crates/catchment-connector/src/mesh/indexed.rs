//! Triangles by the indices of their corners; coinciding corners share an index.
//!
//! Corners closer than [`WELD`] of the largest coordinate are merged; the first of them gives the
//! coordinates. Not promised: a result for corners in a chain of such distances; their merging depends on
//! their order in the file, and on nothing else.

use super::divide::divide;
use super::sides::Sides;
use super::{FileOffset, Triangle, TriangleLocation, WELD};
use glam::{DVec3, I64Vec3};
use manifold_rust::types::MeshGL64;
use std::collections::HashMap;

/// Triangles that share corners, in the coordinates of their source.
#[derive(Debug, Clone)]
pub(super) struct Indexed {
    pub(super) vertices: Vec<DVec3>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Place of each triangle in its file.
    pub(super) places: Vec<TriangleLocation>,
    /// Distance below which two points are merged.
    pub(super) tolerance: f64,
}

impl Indexed {
    /// Merges corners, and divides edges that a neighbour divides; also returns the triangles at each edge.
    pub(super) fn of(triangles: Vec<Triangle>) -> (Self, Sides) {
        let size = triangles
            .iter()
            .flat_map(|t| t.corners)
            .fold(0.0, |size: f64, c| size.max(c.abs().max_element()));
        let tolerance = WELD * size;
        let (vertices, indexed) = weld(&triangles, tolerance);
        let places = triangles.iter().map(|t| t.place).collect();
        drop(triangles);
        let mut mesh = Self { vertices, triangles: indexed, places, tolerance };
        let sides = divide(&mut mesh);
        (mesh, sides)
    }

    /// The result of a library: its corners are shared already.
    pub(super) fn made(result: &MeshGL64, tolerance: f64) -> Self {
        let width = result.num_prop as usize;
        let vertices: Vec<DVec3> =
            result.vert_properties.chunks_exact(width).map(|v| DVec3::new(v[0], v[1], v[2])).collect();
        // The library repeats corners, for example where vertex properties differ.
        let mut same: Vec<u32> = (0..vertices.len() as u32).collect();
        for (from, to) in result.merge_from_vert.iter().zip(&result.merge_to_vert) {
            same[*from as usize] = *to as u32;
        }
        let corners = |t: &[u64]| [t[0], t[1], t[2]].map(|k| same[k as usize]);
        let triangles: Vec<[u32; 3]> = result.tri_verts.chunks_exact(3).map(corners).collect();
        let places = (0..triangles.len())
            .map(|triangle| TriangleLocation { triangle, start: FileOffset::Made })
            .collect();
        Self { vertices, triangles, places, tolerance }
    }

    /// The triangles around each corner, in the order of their numbers.
    pub(super) fn around(&self) -> Vec<Vec<u32>> {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.vertices.len()];
        for (k, t) in self.triangles.iter().enumerate() {
            for corner in t {
                around[*corner as usize].push(k as u32);
            }
        }
        around
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|k| self.vertices[k as usize])
    }

    /// The point with a number.
    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        self.vertices[vertex as usize]
    }

    /// Keeps the triangles for which `keep` is true, by their numbers; returns the number of removed
    /// triangles.
    pub(super) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> usize {
        let before = self.triangles.len();
        let mut k = 0..before;
        self.triangles.retain(|_| k.next().is_some_and(&keep));
        let mut k = 0..before;
        self.places.retain(|_| k.next().is_some_and(&keep));
        before - self.triangles.len()
    }

    /// Leaves out points that are no corners.
    pub(super) fn compact(&mut self) {
        let mut numbers = vec![u32::MAX; self.vertices.len()];
        for corner in self.triangles.iter().flatten() {
            numbers[*corner as usize] = 0;
        }
        for (next, number) in numbers.iter_mut().filter(|number| **number == 0).enumerate() {
            *number = next as u32;
        }
        let mut k = 0..numbers.len();
        self.vertices.retain(|_| k.next().is_some_and(|k| numbers[k] != u32::MAX));
        self.triangles.iter_mut().flatten().for_each(|corner| *corner = numbers[*corner as usize]);
    }

    /// Lowest and highest coordinates.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        self.vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)))
    }
}

/// Joins corners within `tolerance` of each other. The first corner met gives the coordinates.
pub(super) fn weld(triangles: &[Triangle], tolerance: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    /// No vertex, or no further vertex in its cell.
    const NONE: u32 = u32::MAX;
    let pitch = tolerance.max(f64::MIN_POSITIVE);
    let key = |p: DVec3| (p / pitch).floor().as_i64vec3();
    // Of each cell the vertex met first, and of each vertex the next in its cell.
    let mut cells: HashMap<I64Vec3, u32> = HashMap::with_capacity(triangles.len() / 2);
    let mut vertices: Vec<DVec3> = Vec::new();
    let mut next: Vec<u32> = Vec::new();
    let mut locate = |p: DVec3| {
        let home = key(p);
        let near = (0..27i64).find_map(|k| {
            let step = I64Vec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            let mut v = cells.get(&home.saturating_add(step)).copied().unwrap_or(NONE);
            while v != NONE {
                if vertices[v as usize].distance(p) <= tolerance {
                    return Some(v);
                }
                v = next[v as usize];
            }
            None
        });
        near.unwrap_or_else(|| {
            let index = vertices.len() as u32;
            vertices.push(p);
            next.push(NONE);
            let mut last = *cells.entry(home).or_insert(index);
            while last != index {
                let following = next[last as usize];
                if following == NONE {
                    next[last as usize] = index;
                    break;
                }
                last = following;
            }
            index
        })
    };
    // Most corners are written again with the same digits.
    let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(triangles.len() / 2);
    let mut find = |p: DVec3| {
        let digits = p.to_array().map(|c| (c + 0.0).to_bits());
        *known.entry(digits).or_insert_with(|| locate(p))
    };
    let indexed = triangles.iter().map(|t| t.corners.map(&mut find)).collect();
    (vertices, indexed)
}
