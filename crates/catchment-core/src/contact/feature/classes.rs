//! Classes of equivalent features of a half: rotations and reflections about the approach axis that map the
//! half onto itself map the features of a class onto each other.
//!
//! The search covers rotations by multiples of 30° and 45°, and the same after a reflection of y. A half has
//! such a symmetry if every crease maps onto one of its creases, to [`GRAIN`], independent of the division of
//! its faces into facets. For halves of more than [`MOST_FACETS`] only the identity is considered.

use super::Lookup;
use crate::connector::Half;
use crate::contact::crease::{self, Crease};
use crate::disjoint::DisjointSets;
use crate::tolerance;
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Positions closer than this are equal, in D.
const GRAIN: f64 = tolerance::SINGLE;
/// Number of facets beyond which symmetries are not searched: each takes a search of all facets.
const MOST_FACETS: usize = 20_000;

/// The turns and reflections that map a half onto itself, the identity first.
#[derive(Debug, Clone)]
pub(crate) struct Symmetries(pub(crate) Vec<DMat3>);

impl Symmetries {
    pub(super) fn of(half: &Half) -> Self {
        let mut result = vec![DMat3::IDENTITY];
        let facets = half.surfaces.iter().map(|surface| surface.facets.len()).sum::<usize>();
        if facets <= MOST_FACETS {
            let creases = Creases::of(half);
            let keeps = |map: &DMat3| creases.list.iter().all(|crease| creases.image(crease, map).is_some());
            result.extend(candidates().into_iter().filter(keeps));
        }
        Self(result)
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

/// Creases to be found by their places.
struct Creases {
    list: Vec<Crease>,
    middles: PointIndex,
}

impl Creases {
    fn of(half: &Half) -> Self {
        let list = crease::of(half);
        let middles = PointIndex::of(list.iter().map(Crease::middle));
        Self { list, middles }
    }

    /// The crease onto which `map` maps a given crease.
    fn image(&self, crease: &Crease, map: &DMat3) -> Option<&Crease> {
        let [a, b] = crease.ends.map(|end| *map * end);
        let lies = |crease: &&Crease| {
            let [c, d] = crease.ends;
            let same = |p: DVec3, q: DVec3| p.abs_diff_eq(c, GRAIN) && q.abs_diff_eq(d, GRAIN);
            same(a, b) || same(b, a)
        };
        self.middles.at(*map * crease.middle()).map(|k| &self.list[k as usize]).find(lies)
    }
}

/// The class of every feature: the smallest number among its symmetric images.
pub(super) fn of(half: &Half, surfaces: &[Lookup], count: usize, turns: &Symmetries) -> Vec<u32> {
    let mut sets = DisjointSets::new(count);
    let faces: Vec<u32> = surfaces.iter().flat_map(|lookup| &lookup.faces).copied().collect();
    let edge = |crease: &Crease| {
        let [a, b] = crease.edge;
        surfaces[crease.surface].edges.get(&(a, b)).map(|(feature, _)| *feature)
    };
    let creases = Creases::of(half);
    let corners: Vec<(DVec3, u32)> = surfaces
        .iter()
        .flat_map(|lookup| lookup.corners.iter().map(|(v, feature)| (lookup.vertices[*v as usize], *feature)))
        .collect();
    let places = PointIndex::of(corners.iter().map(|(place, _)| *place));
    for turn in &turns.0 {
        for crease in &creases.list {
            let Some(image) = creases.image(crease, turn) else { continue };
            for (facet, normal) in crease.facets.iter().zip(crease.normals) {
                let mut its = image.facets.iter().zip(image.normals);
                if let Some((other, _)) = its.find(|(_, own)| own.abs_diff_eq(*turn * normal, GRAIN)) {
                    sets.join(faces[*facet as usize], faces[*other as usize]);
                }
            }
            if let [Some(own), Some(other)] = [edge(crease), edge(image)] {
                sets.join(own, other);
            }
        }
        for (place, own) in &corners {
            for image in places.at(*turn * *place) {
                sets.join(*own, corners[image as usize].1);
            }
        }
    }
    (0..count as u32).map(|feature| sets.find(feature)).collect()
}

/// Points to be found by their place.
struct PointIndex(Vec<(DVec3, u32)>);

impl PointIndex {
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
