//! Stitching of facet borders: merges points, divides edges at the ends of others, and cancels opposite
//! edges.
//!
//! ```text
//!      ┌──────┐                    the border of a face is a sum of directed edges: edges of two of its facets
//!      │  F   │                    in opposite directions cancel, and a sliver with coinciding sides
//!   a──┴──m───┴──b   a→m, m→b      has no border
//!      │  G   │
//! ```
//!
//! The surface closes if, over all faces, every edge occurs as often in one direction as in the other.

use super::UnionProblem;
use super::planes::{Model, welded};
use crate::mesh::tree::{Bounds, Tree, overlap};
use glam::DVec3;
use std::collections::BTreeMap;

/// New points are merged within this distance, in w, and edges are divided at points within it.
pub(super) const SPLIT: f64 = 4.0;
/// Largest number of passes that divide all edges: a division moves an edge by less than the tolerance, which
/// may bring it to another point.
const PASSES: usize = 4;

/// The remainder of the solids of a cluster on one side of a plane.
#[derive(Debug)]
pub(super) struct Face {
    pub(super) cluster: u32,
    pub(super) plane: u32,
    pub(super) is_forward: bool,
    /// Its border, interior on the left seen from outside.
    pub(super) border: Vec<[u32; 2]>,
}

/// Which face a border belongs to: cluster, plane, side.
type Key = (u32, u32, bool);
/// Edges, the lower number first, by how much more often they run up than down.
type Net = BTreeMap<[u32; 2], i32>;

fn add(net: &mut Net, [a, b]: [u32; 2], times: i32) {
    if a == b || times == 0 {
        return;
    }
    let (edge, times) = if a < b { ([a, b], times) } else { ([b, a], -times) };
    let sum = net.entry(edge).or_insert(0);
    *sum += times;
    if *sum == 0 {
        net.remove(&edge);
    }
}

/// Faces from the loops that are left of every facet of a solid that is in a cluster.
pub(super) fn stitched(
    model: &mut Model,
    mut loops: Vec<Vec<Vec<u32>>>,
    cluster: impl Fn(u32) -> Option<u32>,
) -> Result<Vec<Face>, UnionProblem> {
    let tolerance = SPLIT * model.w;
    for (facet, loops) in model.facets.iter().zip(&mut loops) {
        if cluster(facet.solid).is_none() {
            loops.clear();
        }
    }
    let mut is_used = vec![false; model.points.len()];
    loops.iter().flatten().flatten().for_each(|point| is_used[*point as usize] = true);
    let used: Vec<u32> = (0..model.points.len() as u32).filter(|point| is_used[*point as usize]).collect();
    let places: Vec<DVec3> = used.iter().map(|point| model.points[*point as usize]).collect();
    let mut same: Vec<u32> = (0..model.points.len() as u32).collect();
    for (point, first) in used.iter().zip(welded(&places, tolerance)) {
        same[*point as usize] = used[first as usize];
    }
    let mut faces: BTreeMap<Key, Net> = BTreeMap::new();
    for (facet, loops) in model.facets.iter().zip(loops) {
        let Some(cluster) = cluster(facet.solid) else { continue };
        let net = faces.entry((cluster, facet.plane, facet.is_forward)).or_default();
        for ring in loops {
            for (k, a) in ring.iter().enumerate() {
                add(net, [*a, ring[(k + 1) % ring.len()]].map(|point| same[point as usize]), 1);
            }
        }
    }
    let ends: Vec<u32> = used.into_iter().filter(|point| same[*point as usize] == *point).collect();
    let splitter = Splitter::over(&model.points, ends, tolerance);
    for _ in 0..PASSES {
        let mut is_split = false;
        for net in faces.values_mut() {
            let mut divided = Net::new();
            for (edge, times) in net.iter() {
                let stops = splitter.stops(&model.points, *edge);
                is_split |= stops.len() > 2;
                stops.windows(2).for_each(|pair| add(&mut divided, [pair[0], pair[1]], *times));
            }
            *net = divided;
        }
        if !is_split {
            break;
        }
    }
    closes(&faces, &model.points)?;
    straighten(&mut faces, &model.points, tolerance);
    let face = |((cluster, plane, is_forward), net): (Key, Net)| {
        let border = net.into_iter().flat_map(|([a, b], times)| {
            let edge = if times > 0 { [a, b] } else { [b, a] };
            std::iter::repeat_n(edge, times.unsigned_abs() as usize)
        });
        Face { cluster, plane, is_forward, border: border.collect() }
    };
    Ok(faces.into_iter().map(face).filter(|face| !face.border.is_empty()).collect())
}

/// Removes points at which only a single straight edge continues.
fn straighten(faces: &mut BTreeMap<Key, Net>, points: &[DVec3], tolerance: f64) {
    let mut neighbours: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for ((cluster, ..), net) in faces.iter() {
        for [a, b] in net.keys() {
            neighbours.entry((*cluster, *a)).or_default().push(*b);
            neighbours.entry((*cluster, *b)).or_default().push(*a);
        }
    }
    for list in neighbours.values_mut() {
        list.sort_unstable();
        list.dedup();
    }
    let corners: Vec<(u32, u32)> = neighbours.keys().copied().collect();
    let mut replaced: BTreeMap<(u32, u32), [u32; 2]> = BTreeMap::new();
    for (cluster, at) in corners {
        let Some([a, b]) =
            neighbours.get(&(cluster, at)).and_then(|list| <[u32; 2]>::try_from(&list[..]).ok())
        else {
            continue;
        };
        let [p, q, r] = [a, at, b].map(|point| points[point as usize]);
        let share = (q - p).dot(r - p) / (r - p).length_squared();
        if !(share > 0.0 && share < 1.0 && (q - p - (r - p) * share).length() <= tolerance) {
            continue;
        }
        for (end, other) in [(a, b), (b, a)] {
            if let Some(list) = neighbours.get_mut(&(cluster, end)) {
                list.iter_mut().filter(|point| **point == at).for_each(|point| *point = other);
                list.sort_unstable();
                list.dedup();
            }
        }
        neighbours.remove(&(cluster, at));
        replaced.insert((cluster, at), [a, b]);
    }
    for ((cluster, ..), net) in faces.iter_mut() {
        // In order of removal: a removed point may be replaced by points that were removed later.
        let gone: Vec<(u32, [u32; 2])> = net
            .keys()
            .flatten()
            .filter_map(|point| Some((*point, *replaced.get(&(*cluster, *point))?)))
            .collect();
        let mut gone = gone;
        gone.sort_unstable();
        gone.dedup();
        for (at, [a, b]) in gone {
            let edge = [a.min(at), a.max(at)];
            let times = net.get(&edge).copied().unwrap_or(0) * if a < at { 1 } else { -1 };
            add(net, [a, at], -times);
            add(net, [at, b], -times);
            add(net, [a, b], times);
        }
    }
}

/// Whether the faces of every cluster close.
fn closes(faces: &BTreeMap<Key, Net>, points: &[DVec3]) -> Result<(), UnionProblem> {
    let mut all: BTreeMap<u32, Net> = BTreeMap::new();
    for ((cluster, ..), net) in faces {
        let all = all.entry(*cluster).or_default();
        for (edge, times) in net {
            add(all, *edge, *times);
        }
    }
    match all.values().flat_map(BTreeMap::keys).next() {
        None => Ok(()),
        Some([a, b]) => {
            let [p, q] = [a, b].map(|end| points[*end as usize]);
            Err(UnionProblem::Open { at: p.midpoint(q).into() })
        }
    }
}

/// Finds the points on an edge.
struct Splitter {
    ends: Vec<u32>,
    boxes: Vec<Bounds>,
    tree: Tree,
    tolerance: f64,
}

impl Splitter {
    fn over(points: &[DVec3], ends: Vec<u32>, tolerance: f64) -> Self {
        let around = |end: &u32| (points[*end as usize] - tolerance, points[*end as usize] + tolerance);
        let boxes: Vec<Bounds> = ends.iter().map(around).collect();
        Self { tree: Tree::over(&boxes), ends, boxes, tolerance }
    }

    /// The ends of an edge and the points between them on it, in their order.
    fn stops(&self, points: &[DVec3], [a, b]: [u32; 2]) -> Vec<u32> {
        let [from, to] = [a, b].map(|end| points[end as usize]);
        let around = (from.min(to), from.max(to));
        let along = to - from;
        let mut on: Vec<(f64, u32)> = Vec::new();
        self.tree.visit(
            |bounds| overlap(bounds, around),
            |k| {
                let end = self.ends[k];
                if end == a || end == b || !overlap(self.boxes[k], around) {
                    return;
                }
                let apart = points[end as usize] - from;
                let share = apart.dot(along) / along.length_squared();
                if share > 0.0 && share < 1.0 && (apart - along * share).length() <= self.tolerance {
                    on.push((share, end));
                }
            },
        );
        on.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        std::iter::once(a).chain(on.into_iter().map(|(_, end)| end)).chain([b]).collect()
    }
}
