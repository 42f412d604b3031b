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
//! δ is the draft angle of the mating faces from the vertical. z is odd in x and in y like the plain saddle,
//! so the half mates with a copy of itself under either mount. The whole face is H + ℓ high, with its lowest
//! corners at z = 0.
//!
//! With δ = 0 the lip is a vertical step, which needs play for insertion: its faces are set back from the
//! centre lines into the raised quadrants, so that `clearance` is the distance between the faces of the two
//! halves.

use super::{Check, Draw, Halves, SOCKET_THICKNESS};
use crate::{Surface, SurfaceError};
use catchment_design::design::family::XFace3dLocking;
use glam::{DVec2, DVec3};

/// Smallest draft other than 0, radians: below it the mating faces would be slivers too narrow to manufacture
/// and to compute with.
const MIN_DRAFT: f64 = 1e-3;

impl Draw for XFace3dLocking {
    /// Refuses lips that do not fit on the face.
    fn check(&self, check: &mut Check) {
        let (h, lip, draft) = (self.aspect_ratio, self.lip_height, self.draft_angle);
        check.require("lip_height", lip, lip > 0.0, "give a number above 0, or use x-face-3d");
        check.require(
            "clearance",
            self.clearance,
            draft != 0.0 || (self.clearance > 0.0 && self.clearance < 0.5),
            "vertical lips need play to go in: give a number above 0 and below 0.5, or a draft_angle",
        );
        let steepest = (1.0 / (h + lip)).atan();
        check.require(
            "draft_angle",
            draft,
            draft == 0.0 || (MIN_DRAFT..steepest).contains(&draft),
            format!("give 0, or between {MIN_DRAFT} rad and {steepest:.4} rad: beyond it the lip is wider than the face"),
        );
    }

    /// Both halves: the same solid.
    fn halves(&self) -> Halves {
        let solid = vec![if self.draft_angle == 0.0 { stepped(self) } else { drafted(self) }];
        [solid.clone(), solid]
    }

    fn face_height(&self) -> Option<f64> {
        Some(height(self) / 2.0)
    }
}

/// Height of the whole mating face, in D.
fn height(spec: &XFace3dLocking) -> f64 {
    spec.aspect_ratio + spec.lip_height
}

/// Vertices of a raised quadrant and the lowered quadrant after it, with vertical lips.
const TURN: u32 = 16;

/// The k-th point of the square's border at multiples of 45°: even k on the axes, odd k in the corners.
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

/// +1 in the raised quadrants, −1 in the lowered quadrants; octants counted counter-clockwise from the x
/// axis.
fn sign(octant: usize) -> f64 {
    if (octant / 2).is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// Vertical mating faces, drawn back by half the play into the raised quadrants.
fn stepped(spec: &XFace3dLocking) -> Result<Surface, SurfaceError> {
    let (h, lip, back) = (spec.aspect_ratio, spec.lip_height, spec.clearance / 2.0);
    let mid = height(spec) / 2.0;
    let base = spec.base_thickness.unwrap_or(SOCKET_THICKNESS);
    let rise = height(spec) / 2.0;
    let (foot, top) = (mid - lip / 2.0, mid + lip / 2.0 + h * back);
    let mut vertices = vec![DVec3::new(0.0, 0.0, foot)];
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    // Each turn adds a raised quadrant and the lowered quadrant after it; the second turn is the opposite
    // copy.
    for turn in 0..2u32 {
        let k = 4 * turn as usize;
        let (along, across, corner) = (border(k), border(k + 2), border(k + 1));
        let inner = corner * (2.0 * back);
        let (near, far) = (along + across * (2.0 * back), across + along * (2.0 * back));
        let lowered = border(k + 3).extend(mid - rise);
        let raised = corner.extend(mid + rise);
        vertices.extend([inner.extend(foot), near.extend(foot), far.extend(foot)]);
        vertices.extend([inner.extend(top), near.extend(top), far.extend(top)]);
        vertices.extend([along.extend(foot), raised, across.extend(foot), lowered]);
        vertices.extend([along, near, corner, far, across, border(k + 3)].map(|p| p.extend(-base)));
        let first = 1 + TURN * turn;
        let [inner_foot, near_foot, far_foot, inner_top, near_top, far_top, start, raised, end, lowered] =
            std::array::from_fn(|i| first + i as u32);
        let floor: [u32; 6] = std::array::from_fn(|i| first + 10 + i as u32);
        let after = 1 + TURN * (1 - turn);
        let (next_start, next_floor) = (after + 6, after + 10);
        polygons.extend([
            vec![inner_top, near_top, raised],
            vec![inner_top, raised, far_top],
            vec![near_top, inner_top, inner_foot, near_foot],
            vec![inner_top, far_top, far_foot, inner_foot],
            vec![0, start, near_foot, inner_foot],
            vec![0, inner_foot, far_foot, end],
            vec![0, end, lowered],
            vec![0, lowered, next_start],
            vec![floor[0], floor[1], near_foot, start],
            vec![floor[1], floor[2], raised, near_top, near_foot],
            vec![floor[2], floor[3], far_foot, far_top, raised],
            vec![floor[3], floor[4], end, far_foot],
            vec![floor[4], floor[5], lowered, end],
            vec![floor[5], next_floor, next_start, lowered],
        ]);
    }
    let ring = |turn: u32| (0..6).map(move |i| 1 + TURN * turn + 10 + i);
    polygons.push(ring(0).chain(ring(1)).rev().collect());
    Surface::from_polygons(vertices, &polygons)
}

/// Mating faces inclined by the draft angle.
fn drafted(spec: &XFace3dLocking) -> Result<Surface, SurfaceError> {
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
