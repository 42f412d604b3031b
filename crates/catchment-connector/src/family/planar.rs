//! Planar families: profiles in the x–z plane, extruded along y.

use super::{Check, Draw, Halves};
use crate::{Surface, SurfaceError};
use catchment_design::design::family::{SFace, VFace, XFace};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Slab in which a planar half with a single layer is extruded, in D.
const SLAB: [f64; 2] = [-0.5, 0.5];

type Cell = Vec<DVec2>;

impl Draw for VFace {
    /// Notch z = H·2|x| and tip z = H·(1 − 2|x|).
    fn halves(&self) -> Halves {
        let (h, b) = (self.aspect_ratio, self.base_thickness.unwrap_or(0.0));
        // With b = 0 the two sides of the notch touch along a line only, so they are two solids. With b > 0
        // they form a single solid.
        let left = cell(&[(-0.5, -b), (0.0, -b), (0.0, 0.0), (-0.5, h)]);
        let right = cell(&[(0.0, -b), (0.5, -b), (0.5, h), (0.0, 0.0)]);
        let notch = if b > 0.0 { vec![vec![left, right]] } else { vec![vec![left], vec![right]] };
        let tip = cell(&[(-0.5, -b), (0.5, -b), (0.5, 0.0), (0.0, h), (-0.5, 0.0)]);
        [notch.iter().map(|cells| extrude(cells, SLAB)).collect(), vec![extrude(&[tip], SLAB)]]
    }
}

impl Draw for SFace {
    /// Polyline with its maximum H at x = −1/6 and its minimum 0 at x = 1/6; ends at H/2.
    fn halves(&self) -> Halves {
        let (h, b) = (self.aspect_ratio, self.base_thickness.unwrap_or(0.0));
        let x = 1.0 / 6.0;
        let left = cell(&[(-0.5, -b), (x, -b), (x, 0.0), (-x, h), (-0.5, h / 2.0)]);
        let right = cell(&[(x, -b), (0.5, -b), (0.5, h / 2.0), (x, 0.0)]);
        let half = if b > 0.0 { vec![vec![left, right]] } else { vec![vec![left], vec![right]] };
        let surfaces: Vec<_> = half.iter().map(|cells| extrude(cells, SLAB)).collect();
        [surfaces.clone(), surfaces]
    }
}

impl Draw for XFace {
    fn check(&self, check: &mut Check) {
        for (name, length) in [("layer_thickness", self.layer_thickness), ("layer_gap", self.layer_gap)] {
            if let Some(length) = length {
                check.require(name, length, length > 0.0, "give a number above 0");
            }
        }
    }

    /// Two ramps that cross, z = H·(½ ± x), in two layers with a gap between them, which keeps a layer to its own counterpart.
    fn halves(&self) -> Halves {
        let (h, b) = (self.aspect_ratio, self.base_thickness.unwrap_or(0.0));
        let near = self.layer_gap.unwrap_or(Self::DEFAULT_LAYER_GAP) / 2.0;
        let far = near + self.layer_thickness.unwrap_or(Self::DEFAULT_LAYER_THICKNESS);
        let rising = cell(&[(-0.5, -b), (0.5, -b), (0.5, h), (-0.5, 0.0)]);
        let falling = cell(&[(-0.5, -b), (0.5, -b), (0.5, 0.0), (-0.5, h)]);
        let surfaces = vec![extrude(&[rising], [near, far]), extrude(&[falling], [-far, -near])];
        [surfaces.clone(), surfaces]
    }
}

/// A convex profile, counter-clockwise, without the corners that fall together.
fn cell(corners: &[(f64, f64)]) -> Cell {
    let mut cell: Cell = corners.iter().map(|&(x, z)| DVec2::new(x, z)).collect();
    cell.dedup();
    if cell.first() == cell.last() {
        cell.pop();
    }
    cell
}

/// The solid over convex cells that share corners, between two values of y.
fn extrude(cells: &[Cell], [near, far]: [f64; 2]) -> Result<Surface, SurfaceError> {
    let mut profile: Vec<DVec2> = Vec::new();
    let indexed: Vec<Vec<u32>> = cells
        .iter()
        .map(|cell| {
            let mut index = |p: &DVec2| {
                profile.iter().position(|q| q == p).unwrap_or_else(|| {
                    profile.push(*p);
                    profile.len() - 1
                }) as u32
            };
            cell.iter().map(&mut index).collect()
        })
        .collect();
    let n = profile.len() as u32;
    let at = |y: f64| profile.iter().map(move |p| DVec3::new(p.x, y, p.y));
    let vertices = at(near).chain(at(far)).collect();
    let mut polygons = Vec::new();
    // An edge that the neighbouring cell runs through the other way lies inside the solid.
    let mut outline: BTreeSet<(u32, u32)> = BTreeSet::new();
    for cell in &indexed {
        polygons.push(cell.clone());
        polygons.push(cell.iter().rev().map(|i| i + n).collect());
        for (k, &a) in cell.iter().enumerate() {
            let b = cell[(k + 1) % cell.len()];
            if !outline.remove(&(b, a)) {
                outline.insert((a, b));
            }
        }
    }
    polygons.extend(outline.iter().map(|&(a, b)| vec![b, a, a + n, b + n]));
    Surface::from_polygons(vertices, &polygons)
}
