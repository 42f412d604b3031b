//! From loose triangles to a closed surface, or to every reason why they are none.

use super::divide::divide;
use super::shells::Shells;
use super::{MAX_REPORTED, MeshProblem, Reported, Triangle, WELD};
use crate::connector::Surface;
use glam::{DVec3, I64Vec3};
use std::collections::{BTreeMap, HashMap};

/// Area of a triangle, relative to the square of its longest side, below which it has none: the rounding of
/// single-precision corners moves the area of a unit triangle by about 1e-7.
const NO_AREA: f64 = 1e-7;

/// Welds, checks and scales. One surface, or one per shell where shells cross each other.
pub(super) fn surfaces(triangles: &[Triangle], scale: f64) -> Result<Vec<Surface>, Vec<MeshProblem>> {
    let size =
        triangles.iter().flat_map(|t| t.corners).fold(0.0, |size: f64, c| size.max(c.abs().max_element()));
    let tolerance = WELD * size;
    let (vertices, mut indexed) = weld(triangles, tolerance);
    let mut triangles = triangles.to_vec();
    let sides = divide(&mut triangles, &mut indexed, &vertices, tolerance);
    let triangles = triangles.as_slice();
    let mut reported = Reported::default();
    reported.extend(zero_areas(triangles, &vertices, &indexed));
    reported.extend(open_edges(triangles, &vertices, &sides));
    reported.extend(crowded_edges(&vertices, &sides));
    reported.extend(wrong_windings(triangles, &sides));
    let mut bodies = None;
    if reported.problems.is_empty() {
        let shells = Shells::of(&vertices, &indexed, &sides);
        bodies = shells.bodies();
        if bodies.is_none() {
            reported.extend([MeshProblem::InsideOut]);
        }
        let mut overlap = false;
        reported.extend(crossings(triangles, &vertices, &indexed, tolerance, &shells.of, &mut overlap));
        if !overlap {
            bodies = bodies.map(|_| vec![(0..indexed.len()).collect()]);
        }
    }
    reported.done()?;
    // Everything that the surface refuses has been looked for above; what is left can only be rounding.
    let refused = |_| vec![MeshProblem::InsideOut];
    let bodies = bodies.unwrap_or_default();
    bodies
        .iter()
        .map(|body| {
            let (vertices, polygons) = gathered(&vertices, &indexed, body);
            Surface::from_polygons(vertices.iter().map(|v| *v * scale).collect(), &polygons).map_err(refused)
        })
        .collect()
}

/// The triangles of one body, over corners of their own.
fn gathered(vertices: &[DVec3], indexed: &[[u32; 3]], body: &[usize]) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    if body.len() == indexed.len() {
        return (vertices.to_vec(), indexed.iter().map(|t| t.to_vec()).collect());
    }
    let mut own = HashMap::new();
    let mut gathered = Vec::new();
    let mut renumbered = |v: u32| {
        *own.entry(v).or_insert_with(|| {
            gathered.push(vertices[v as usize]);
            gathered.len() as u32 - 1
        })
    };
    let polygons = body.iter().map(|&k| indexed[k].map(&mut renumbered).to_vec()).collect();
    (gathered, polygons)
}

/// Joins corners within `tolerance` of each other. The first corner met gives the coordinates.
fn weld(triangles: &[Triangle], tolerance: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let pitch = tolerance.max(f64::MIN_POSITIVE);
    let key = |p: DVec3| (p / pitch).floor().as_i64vec3();
    let mut cells: HashMap<I64Vec3, Vec<u32>> = HashMap::new();
    let mut vertices: Vec<DVec3> = Vec::new();
    let mut find = |p: DVec3| {
        let home = key(p);
        let near = (0..27i64).find_map(|k| {
            let step = I64Vec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            let close = |&&v: &&u32| vertices[v as usize].distance(p) <= tolerance;
            cells.get(&home.saturating_add(step)).and_then(|cell| cell.iter().find(close)).copied()
        });
        near.unwrap_or_else(|| {
            let index = vertices.len() as u32;
            vertices.push(p);
            cells.entry(home).or_default().push(index);
            index
        })
    };
    let indexed = triangles.iter().map(|t| t.corners.map(&mut find)).collect();
    (vertices, indexed)
}

pub(super) fn corners(vertices: &[DVec3], triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|k| vertices[k as usize])
}

fn zero_areas(triangles: &[Triangle], vertices: &[DVec3], indexed: &[[u32; 3]]) -> Vec<MeshProblem> {
    let flat = |t: [u32; 3]| {
        let [a, b, c] = corners(vertices, t);
        let longest = [b - a, c - b, a - c].into_iter().map(DVec3::length_squared).fold(0.0, f64::max);
        (b - a).cross(c - a).length() <= NO_AREA * longest
    };
    triangles
        .iter()
        .zip(indexed)
        .filter(|&(_, &t)| flat(t))
        .map(|(t, _)| MeshProblem::ZeroArea { place: t.place, at: t.corners[0] })
        .collect()
}

/// Per undirected edge: its triangles, and whether each runs along it upwards.
pub(super) type Sides = BTreeMap<[u32; 2], Vec<(usize, bool)>>;

pub(super) fn sides(indexed: &[[u32; 3]]) -> Sides {
    let mut sides = Sides::new();
    for (k, t) in indexed.iter().enumerate() {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            // A side without length belongs to a triangle without area, which is reported as such.
            if a != b {
                sides.entry([a.min(b), a.max(b)]).or_default().push((k, a < b));
            }
        }
    }
    sides
}

fn open_edges(triangles: &[Triangle], vertices: &[DVec3], sides: &Sides) -> Vec<MeshProblem> {
    sides
        .iter()
        .filter(|(_, owners)| owners.len() == 1)
        .map(|([a, b], owners)| MeshProblem::Open {
            place: triangles[owners[0].0].place,
            from: vertices[*a as usize],
            to: vertices[*b as usize],
        })
        .collect()
}

fn crowded_edges(vertices: &[DVec3], sides: &Sides) -> Vec<MeshProblem> {
    sides
        .iter()
        .filter(|(_, owners)| owners.len() > 2)
        .map(|([a, b], owners)| MeshProblem::NonManifold {
            count: owners.len(),
            from: vertices[*a as usize],
            to: vertices[*b as usize],
        })
        .collect()
}

fn wrong_windings(triangles: &[Triangle], sides: &Sides) -> Vec<MeshProblem> {
    sides
        .values()
        .filter_map(|owners| match owners[..] {
            [(first, up), (second, also_up)] if up == also_up => {
                Some(MeshProblem::Winding { first: triangles[first].place, second: triangles[second].place })
            }
            _ => None,
        })
        .collect()
}

/// Pairs of triangles of one shell that cross: an edge of the one pierces the other. Sorted sweep along x, which ends with the first
/// few: a mesh in which everything crosses has as many pairs as the square of its triangles. `overlap` tells whether two shells cross.
fn crossings(
    triangles: &[Triangle],
    vertices: &[DVec3],
    indexed: &[[u32; 3]],
    tolerance: f64,
    shell: &[usize],
    overlap: &mut bool,
) -> Vec<MeshProblem> {
    let boxes: Vec<(DVec3, DVec3)> = indexed
        .iter()
        .map(|&t| {
            let [a, b, c] = corners(vertices, t);
            (a.min(b).min(c), a.max(b).max(c))
        })
        .collect();
    let sheets: Vec<Sheet> = indexed.iter().map(|&t| Sheet::of(corners(vertices, t))).collect();
    let mut order: Vec<usize> = (0..indexed.len()).collect();
    order.sort_by(|&a, &b| boxes[a].0.x.total_cmp(&boxes[b].0.x).then(a.cmp(&b)));
    let mut found = Vec::new();
    for (position, &i) in order.iter().enumerate() {
        for &j in &order[position + 1..] {
            if boxes[j].0.x > boxes[i].1.x {
                break;
            }
            let apart = boxes[i].0.cmpgt(boxes[j].1).any() || boxes[j].0.cmpgt(boxes[i].1).any();
            let same = shell[i] == shell[j];
            if apart
                || !same && *overlap
                || sheets[i].is_clear_of(&sheets[j], tolerance) && !share_a_side(indexed[i], indexed[j])
            {
                continue;
            }
            let Some(at) = cross(vertices, indexed[i], indexed[j], tolerance) else { continue };
            if !same {
                *overlap = true;
                continue;
            }
            if found.len() == MAX_REPORTED {
                found.push(MeshProblem::NotLookedAt { count: order.len() - position });
                return found;
            }
            let (first, second) = (i.min(j), i.max(j));
            let (first, second) = (triangles[first].place, triangles[second].place);
            found.push(MeshProblem::SelfIntersection { first, second, at });
        }
    }
    found
}

/// A triangle and the plane that it lies in.
struct Sheet {
    corners: [DVec3; 3],
    normal: DVec3,
}

impl Sheet {
    fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self { corners, normal: (b - a).cross(c - a).normalize_or_zero() }
    }

    /// Whether no side of either can pierce the other: each lies on one side of the other's plane. By the same numbers as
    /// [`pierced`], so that nothing is missed.
    fn is_clear_of(&self, other: &Self, tolerance: f64) -> bool {
        self.has_on_one_side(other, tolerance) && other.has_on_one_side(self, tolerance)
    }

    fn has_on_one_side(&self, other: &Self, tolerance: f64) -> bool {
        let heights = other.corners.map(|corner| self.normal.dot(corner - self.corners[0]));
        heights.iter().all(|h| *h <= tolerance) || heights.iter().all(|h| *h >= -tolerance)
    }
}

fn share_a_side(first: [u32; 3], second: [u32; 3]) -> bool {
    first.iter().filter(|k| second.contains(k)).count() >= 2
}

/// Where two triangles cross, if they do. Sharing a corner or a side is no crossing, folding over it is.
fn cross(vertices: &[DVec3], first: [u32; 3], second: [u32; 3], tolerance: f64) -> Option<DVec3> {
    let shared = first.iter().filter(|k| second.contains(k)).count();
    let (a, b) = (corners(vertices, first), corners(vertices, second));
    if shared >= 2 {
        let apex = |of: [u32; 3], other: [u32; 3]| of.into_iter().find(|k| !other.contains(k));
        let (Some(p), Some(q)) = (apex(first, second), apex(second, first)) else { return Some(a[0]) };
        let hinge = vertices[first.into_iter().find(|k| second.contains(k))? as usize];
        let (p, q) = (vertices[p as usize], vertices[q as usize]);
        let (n, m) = ((a[1] - a[0]).cross(a[2] - a[0]), (b[1] - b[0]).cross(b[2] - b[0]));
        // Folded flat on itself: opposite normals, apexes on the same side of the common edge.
        let folded = n.dot(m) < 0.0 && n.cross(m).length() <= NO_AREA * n.length() * m.length();
        return folded.then(|| hinge.lerp(p.midpoint(q), 0.5));
    }
    let pierce = |edges: [u32; 3], corners_of: [DVec3; 3], other: [u32; 3]| {
        (0..3).find_map(|k| {
            let (p, q) = (edges[k], edges[(k + 1) % 3]);
            if other.contains(&p) || other.contains(&q) {
                return None;
            }
            pierced(vertices[p as usize], vertices[q as usize], corners_of, tolerance)
        })
    };
    pierce(first, b, second).or_else(|| pierce(second, a, first))
}

/// Where the segment p–q passes through a triangle from one side to the other.
fn pierced(p: DVec3, q: DVec3, [a, b, c]: [DVec3; 3], tolerance: f64) -> Option<DVec3> {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let (above, below) = (normal.dot(p - a), normal.dot(q - a));
    if above.abs() <= tolerance || below.abs() <= tolerance || above.signum() == below.signum() {
        return None;
    }
    let at = p.lerp(q, above / (above - below));
    let inside = [(a, b), (b, c), (c, a)].into_iter().all(|(u, v)| (v - u).cross(at - u).dot(normal) >= 0.0);
    inside.then_some(at)
}
