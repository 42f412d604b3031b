//! Every possible contact of the halves at the aligned rotation, as a plane over a convex polygon.
//!
//! With the COR at c = (x, y, z), a point q of the moving half (from the COR) touches a point p of the fixed
//! half with normal n if n·(c + q − p) = 0, which is a plane over (x, y). Its footprint is the set of
//! positions at which the foot of the contact lies on both features. Features that cannot support the normal
//! lie below others and are removed, with the same slack as for heights, so that for flush halves some
//! feature always counts; superfluous pairs still connect points of both halves and lie below the envelope.

use crate::connector::{Half, Surface};
use crate::contact::FLUSH;
use crate::exec::{Cancelled, Exec};
use crate::tolerance;
use glam::{DVec2, DVec3};

/// Below this z-component a normal is horizontal: the feature is a wall and has no height.
const VERTICAL: f64 = tolerance::PARALLEL;
/// Areas smaller than this, relative to lengths, count as zero: rounding only.
const ROUNDING: f64 = 1e-9;

/// A plane over a convex polygon of the lateral plane.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    /// Corners, counter-clockwise.
    pub(super) footprint: Vec<DVec2>,
    /// Height over (0, 0), in D.
    pub(super) offset: f64,
    /// Gradient of the height, dimensionless.
    pub(super) gradient: DVec2,
}

impl Sheet {
    /// Height over `at`.
    pub(super) fn height(&self, at: DVec2) -> f64 {
        self.offset + self.gradient.dot(at)
    }

    /// The contact with normal `n` of fixed point `p` and moving point `q`, over the given corners.
    fn new(n: DVec3, p: DVec3, q: DVec3, mut footprint: Vec<DVec2>) -> Option<Self> {
        let area = area(&footprint);
        let size = footprint.iter().map(|c| c.distance(footprint[0])).fold(0.0, f64::max);
        if area.abs() <= ROUNDING * size * size {
            return None;
        }
        if area < 0.0 {
            footprint.reverse();
        }
        Some(Self { footprint, offset: n.dot(p - q) / n.z, gradient: -n.truncate() / n.z })
    }
}

/// Signed area of a polygon, positive when counter-clockwise.
pub fn area(polygon: &[DVec2]) -> f64 {
    let Some(&origin) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum::<f64>() / 2.0
}

/// All sheets of a pair of halves, with the moving half relative to the COR at the aligned rotation; `None`
/// for more than `most`.
pub(super) fn sheets(
    fixed: &Half,
    moving: &Half,
    most: usize,
    exec: &Exec,
) -> Result<Option<Vec<Sheet>>, Cancelled> {
    let mut sheets = Vec::new();
    for f in &fixed.surfaces {
        for m in &moving.surfaces {
            facets_and_corners(f, m, 1.0, most, exec, &mut sheets)?;
            facets_and_corners(m, f, -1.0, most, exec, &mut sheets)?;
            edges(f, m, most, exec, &mut sheets)?;
        }
    }
    Ok((sheets.len() <= most).then_some(sheets))
}

/// Facets of `a` against corners of `b`; `up` is +1 if a is the fixed half and −1 if it is the moving half.
fn facets_and_corners(
    a: &Surface,
    b: &Surface,
    up: f64,
    most: usize,
    exec: &Exec,
    out: &mut Vec<Sheet>,
) -> Result<(), Cancelled> {
    let mut neighbours: Vec<Vec<DVec3>> = vec![Vec::new(); b.vertices.len()];
    for facet in &b.facets {
        for (k, &from) in facet.corners.iter().enumerate() {
            let to = facet.corners[(k + 1) % facet.corners.len()];
            neighbours[from as usize].push(b.vertices[to as usize] - b.vertices[from as usize]);
        }
    }
    for facet in &a.facets {
        exec.check()?;
        if facet.normal.z * up <= VERTICAL {
            continue;
        }
        if out.len() > most {
            break;
        }
        for (v, around) in b.vertices.iter().zip(&neighbours) {
            if around.is_empty() || around.iter().any(|e| facet.normal.dot(*e) < -FLUSH * e.length()) {
                continue;
            }
            let corners = facet.corners.iter().map(|&k| ((a.vertices[k as usize] - *v) * up).truncate());
            let foot = a.vertices[facet.corners[0] as usize];
            let (p, q) = if up > 0.0 { (foot, *v) } else { (*v, foot) };
            out.extend(Sheet::new(facet.normal * up, p, q, corners.collect()));
        }
    }
    Ok(())
}

/// Convex edges against convex edges.
fn edges(
    fixed: &Surface,
    moving: &Surface,
    most: usize,
    exec: &Exec,
    out: &mut Vec<Sheet>,
) -> Result<(), Cancelled> {
    for e in &fixed.edges {
        exec.check()?;
        if out.len() > most {
            break;
        }
        let [a, b] = e.ends.map(|k| fixed.vertices[k as usize]);
        let sides = e.facets.map(|k| fixed.facets[k as usize].normal);
        for g in &moving.edges {
            let [p, q] = g.ends.map(|k| moving.vertices[k as usize]);
            let Some(n) = (b - a).cross(q - p).try_normalize() else { continue };
            let n = if n.z < 0.0 { -n } else { n };
            if n.z <= VERTICAL
                || !between(n, sides, b - a)
                || !between(-n, g.facets.map(|k| moving.facets[k as usize].normal), q - p)
            {
                continue;
            }
            let [a2, b2, p2, q2] = [a, b, p, q].map(DVec3::truncate);
            out.extend(Sheet::new(n, a, p, vec![a2 - p2, b2 - p2, b2 - q2, a2 - q2]));
        }
    }
    Ok(())
}

/// Whether `n`, across a convex edge, lies between the outward normals of its two facets.
fn between(n: DVec3, [left, right]: [DVec3; 2], edge: DVec3) -> bool {
    let along = edge.normalize_or_zero();
    let along = if left.cross(right).dot(along) < 0.0 { -along } else { along };
    left.cross(n).dot(along) >= -FLUSH && n.cross(right).dot(along) >= -FLUSH && n.dot(left + right) > 0.0
}
