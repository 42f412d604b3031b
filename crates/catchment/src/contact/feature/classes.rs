//! Which features of a half are each other's images: turns and reflections about the approach axis that map the half onto itself.
//!
//! Looked for are turns by multiples of 30° and 45°, and the same with y reflected before. A half has one if every facet comes to lie on
//! one of its facets, to [`GRAIN`]. Of halves of more than [`MOST_FACETS`] none is looked for but the identity.

use super::{Lookup, Sets};
use crate::connector::{Half, Surface};
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Places nearer than this are one, in D.
const GRAIN: f64 = 1e-6;
/// Facets beyond which symmetries are not looked for: each takes a search of all of them.
const MOST_FACETS: usize = 20_000;

/// The turns and reflections that map a half onto itself, the identity first.
#[derive(Debug, Clone)]
pub(crate) struct Turns(pub(crate) Vec<DMat3>);

impl Turns {
    pub(super) fn of(half: &Half) -> Self {
        let mut found = vec![DMat3::IDENTITY];
        let facets = half.surfaces.iter().map(|surface| surface.facets.len()).sum::<usize>();
        if facets <= MOST_FACETS {
            let drawn = Places::of(facets_of(half).map(|(middle, _)| middle));
            let normals: Vec<DVec3> = facets_of(half).map(|(_, normal)| normal).collect();
            let keeps = |map: &DMat3| {
                facets_of(half).all(|(middle, normal)| {
                    let lies = |k: &u32| normals[*k as usize].abs_diff_eq(*map * normal, GRAIN);
                    drawn.at(*map * middle).any(|k| lies(&k))
                })
            };
            found.extend(candidates().into_iter().filter(keeps));
        }
        Self(found)
    }
}

/// Turns by multiples of 30° and 45°, and the same with y reflected before; without the identity.
fn candidates() -> Vec<DMat3> {
    /// A turn in parts of 15°.
    const PARTS: u32 = 24;
    let reflected = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
    let turns = (0..PARTS).filter(|k| k % 2 == 0 || k % 3 == 0);
    let turn = |k: u32| DMat3::from_rotation_z(TAU * f64::from(k) / f64::from(PARTS));
    turns.flat_map(|k| [turn(k), turn(k) * reflected]).skip(1).collect()
}

/// Middle and outward normal of every facet.
fn facets_of(half: &Half) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    let facets = |surface: &'_ Surface| -> Vec<(DVec3, DVec3)> {
        let middle = |corners: &[u32]| {
            corners.iter().map(|v| surface.vertices[*v as usize]).sum::<DVec3>() / corners.len() as f64
        };
        surface.facets.iter().map(|facet| (middle(&facet.corners), facet.normal)).collect()
    };
    half.surfaces.iter().flat_map(facets)
}

/// The class of every feature: the least number of those that lie where a symmetry brings it.
pub(super) fn of(half: &Half, surfaces: &[Lookup], count: usize, turns: &Turns) -> Vec<u32> {
    let mut sets = Sets::new(count);
    let faces: Vec<u32> = surfaces.iter().flat_map(|lookup| &lookup.faces).copied().collect();
    let facets: Vec<(DVec3, DVec3)> = facets_of(half).collect();
    let middles = Places::of(facets.iter().map(|(middle, _)| *middle));
    let edges: Vec<(DVec3, u32)> = surfaces
        .iter()
        .flat_map(|lookup| {
            let at = |v: u32| lookup.vertices[v as usize];
            lookup.edges.iter().map(move |((a, b), (feature, _))| (at(*a).midpoint(at(*b)), *feature))
        })
        .collect();
    let corners: Vec<(DVec3, u32)> = surfaces
        .iter()
        .flat_map(|lookup| lookup.corners.iter().map(|(v, feature)| (lookup.vertices[*v as usize], *feature)))
        .collect();
    for turn in &turns.0 {
        for (own, (middle, normal)) in faces.iter().zip(&facets) {
            let lies = |k: &u32| facets[*k as usize].1.abs_diff_eq(*turn * *normal, GRAIN);
            for image in middles.at(*turn * *middle).filter(lies) {
                sets.join(*own, faces[image as usize]);
            }
        }
        for points in [&edges, &corners] {
            let places = Places::of(points.iter().map(|(place, _)| *place));
            for (place, own) in points {
                for image in places.at(*turn * *place) {
                    sets.join(*own, points[image as usize].1);
                }
            }
        }
    }
    (0..count as u32).map(|feature| sets.find(feature)).collect()
}

/// Points to be found by their place.
struct Places(Vec<(DVec3, u32)>);

impl Places {
    fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let mut places: Vec<(DVec3, u32)> = points.zip(0u32..).collect();
        places.sort_by(|(a, j), (b, k)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(j.cmp(k)));
        Self(places)
    }

    /// The numbers of the points at a place.
    fn at(&self, place: DVec3) -> impl Iterator<Item = u32> + '_ {
        let first = self.0.partition_point(|(point, _)| point.x < place.x - GRAIN);
        let near = self.0[first..].iter().take_while(move |(point, _)| point.x <= place.x + GRAIN);
        near.filter(move |(point, _)| point.abs_diff_eq(place, GRAIN)).map(|(_, number)| *number)
    }
}
