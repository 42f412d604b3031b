//! The saddle with a lip along its centre lines.
//!
//! With m(x, y) = sign(xy)·min(|x|, |y|) the plain saddle is z = H·m about its mid height. The lip lifts the
//! two quadrants xy > 0 by ℓ/2 and lowers the other two by as much, so that mating faces of height ℓ stand
//! along both centre lines:
//!
//! ```text
//!   z = H·m + clamp(k·m, −ℓ/2, ℓ/2),    k = cot δ − H
//! ```
//!
//! δ is the draft angle of the mating faces from the vertical; δ = 0 is the limit, a step. z is odd in x and
//! in y like the plain saddle, so the half mates with a copy of itself under either mount. The whole face is
//! H + ℓ high, its lowest corners at z = 0.

use super::{Check, Halves, SOCKET_THICKNESS};
use crate::connector::{Surface, SurfaceError};
use crate::design::FamilySpec;
use glam::{DVec2, DVec3};

/// Smallest draft other than none, radians: below it the mating faces would be slivers narrower than any
/// workshop makes and than the kernel's seams like.
const MIN_DRAFT: f64 = 1e-3;

/// Refuses lips that do not fit on the face.
pub(super) fn check(check: &mut Check) {
    let spec = check.spec;
    let (h, lip, draft) = (spec.aspect_ratio, spec.lip_height, spec.draft_angle);
    check.require("lip_height", lip, lip > 0.0, "give a number above 0, or use x-face-3d");
    let steepest = (1.0 / (h + lip)).atan();
    check.require(
        "draft_angle",
        draft,
        draft == 0.0 || (MIN_DRAFT..steepest).contains(&draft),
        format!("give 0, or between {MIN_DRAFT} rad and {steepest:.4} rad: beyond it the lip is wider than the face"),
    );
}

/// Height of the whole mating face, in D.
pub(super) fn height(spec: &FamilySpec) -> f64 {
    spec.aspect_ratio + spec.lip_height
}

/// Both halves: the same solid.
pub(super) fn locking(spec: &FamilySpec) -> Halves {
    let solid = vec![if spec.draft_angle == 0.0 { stepped(spec) } else { drafted(spec) }];
    [solid.clone(), solid]
}

/// The k-th point of the square's border at multiples of 45°: even ones on the axes, odd ones in the corners.
fn border(k: usize) -> DVec2 {
    const POINTS: [(f64, f64); 8] = [
        (0.5, 0.0),
        (0.5, 0.5),
        (0.0, 0.5),
        (-0.5, 0.5),
        (-0.5, 0.0),
        (-0.5, -0.5),
        (0.0, -0.5),
        (0.5, -0.5),
    ];
    POINTS[k % 8].into()
}

/// +1 in the raised quadrants, −1 in the lowered ones; octants counted counter-clockwise from the x axis.
fn sign(octant: usize) -> f64 {
    if octant / 2 % 2 == 0 { 1.0 } else { -1.0 }
}

/// Vertical mating faces.
fn stepped(spec: &FamilySpec) -> Result<Surface, SurfaceError> {
    let (h, lip) = (spec.aspect_ratio, spec.lip_height);
    let mid = height(spec) / 2.0;
    let base = spec.base_thickness.unwrap_or(SOCKET_THICKNESS);
    // The centre at the foot of the lip, and once more at the top of each raised quadrant: the two quadrants
    // meet along a vertical line, and separate corners keep every edge between two facets.
    let mut vertices = vec![DVec3::new(0.0, 0.0, mid - lip / 2.0)];
    vertices.extend([DVec3::new(0.0, 0.0, mid + lip / 2.0); 2]);
    let centre = |octant: usize| if sign(octant) < 0.0 { 0 } else { 1 + (octant / 4) as u32 };
    let corner = |k: usize| 3 + (k % 8 / 2) as u32;
    vertices.extend([1, 3, 5, 7].map(|k| border(k).extend(mid + sign(k) * (h + lip) / 2.0)));
    let low = |k: usize| 7 + (k % 8 / 2) as u32;
    let high = |k: usize| 11 + (k % 8 / 2) as u32;
    for step in [-lip, lip] {
        vertices.extend([0, 2, 4, 6].map(|k| border(k).extend(mid + step / 2.0)));
    }
    let floor = |k: usize| 15 + (k % 8) as u32;
    vertices.extend((0..8).map(|k| border(k).extend(-base)));

    let mut polygons: Vec<Vec<u32>> = Vec::new();
    for octant in 0..8 {
        let raised = sign(octant) > 0.0;
        let axis = |k: usize| if raised { high(k) } else { low(k) };
        let (c, next) = (centre(octant), octant + 1);
        // A raised octant's outer wall also has the foot of the lip on its border.
        let mut wall = vec![floor(octant), floor(next)];
        if octant % 2 == 0 {
            polygons.push(vec![c, axis(octant), corner(next)]);
            wall.extend([corner(next), axis(octant)]);
            if raised {
                wall.push(low(octant));
                polygons.push(vec![high(octant), c, 0, low(octant)]);
            }
        } else {
            polygons.push(vec![c, corner(octant), axis(next)]);
            if raised {
                wall.push(low(next));
                polygons.push(vec![c, high(next), low(next), 0]);
            }
            wall.extend([axis(next), corner(octant)]);
        }
        polygons.push(wall);
    }
    polygons.push((0..8).rev().map(floor).collect());
    Surface::from_polygons(vertices, &polygons)
}

/// Mating faces inclined by the draft angle.
fn drafted(spec: &FamilySpec) -> Result<Surface, SurfaceError> {
    let (h, lip) = (spec.aspect_ratio, spec.lip_height);
    let mid = height(spec) / 2.0;
    let base = spec.base_thickness.unwrap_or(SOCKET_THICKNESS);
    // Half width of a mating face in plan view, and its height over the centre at that distance.
    let width = lip / 2.0 / (1.0 / spec.draft_angle.tan() - h);
    let top = h * width + lip / 2.0;
    // Per axis point: the rim at the foot or top of the lip, clockwise and counter-clockwise of it; then the corner.
    let mut rim = Vec::new();
    for k in [0, 2, 4, 6] {
        let along = border(k);
        let across = along.perp() * (2.0 * width);
        rim.push((along - across).extend(mid - sign(k) * top));
        rim.push((along + across).extend(mid + sign(k) * top));
        rim.push(border(k + 1).extend(mid + sign(k) * (h + lip) / 2.0));
    }
    let inner = [1, 3, 5, 7].map(|k| (border(k) * (2.0 * width)).extend(mid + sign(k) * top));
    let n = rim.len();
    let at = |k: usize| 5 + (k % n) as u32;
    let floor = |k: usize| at(k) + n as u32;
    let mut vertices = vec![DVec3::new(0.0, 0.0, mid)];
    vertices.extend(inner);
    vertices.extend(&rim);
    vertices.extend(rim.iter().map(|p| p.truncate().extend(-base)));

    let mut polygons: Vec<Vec<u32>> = Vec::new();
    for q in 0..4 {
        let (before, after) = (1 + ((q + 3) % 4) as u32, 1 + q as u32);
        let k = 3 * q;
        polygons.push(vec![0, before, at(k), at(k + 1), after]);
        polygons.push(vec![after, at(k + 1), at(k + 2)]);
        polygons.push(vec![after, at(k + 2), at(k + 3)]);
    }
    polygons.extend((0..n).map(|k| vec![floor(k), floor(k + 1), at(k + 1), at(k)]));
    polygons.push((0..n).rev().map(floor).collect());
    Surface::from_polygons(vertices, &polygons)
}
