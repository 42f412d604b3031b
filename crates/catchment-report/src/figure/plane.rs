//! The cutting plane along the approach axis, chosen through the contacts of the halves.
//!
//! ```text
//!   seen from above        ↑ normals of the contacts      the plane holds the main direction of their horizontal parts,
//!        ●─────────●──── u                                or, if they carry straight up, the direction from the expected contact;
//!                                                         it passes through as many contacts as possible
//! ```

use super::section::{MovingHalfPose, cut};
use catchment_core::connector::{Connector, Half};
use catchment_core::design::Design;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::PI;

/// Planes in which halves are cut: one plane, or one through each of two layers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    /// Angle from x to the direction along the plane, in (−π/2, π/2].
    pub(super) azimuth: f64,
    /// Offsets beside the axis, from far to near, in D.
    pub(super) offsets: Vec<f64>,
    /// Whether it was laid through contacts.
    pub(super) through_contacts: bool,
}

/// Two halves that touch along a face, an edge or at a point.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    /// Positions.
    pub(super) points: Vec<DVec3>,
    /// The normal there.
    pub(super) normal: DVec3,
    /// Offset of a first contact point of the moving half from its docked position, in plan view.
    pub(super) off: DVec2,
}

impl Patch {
    /// Of a moving half with this rotation and face centre.
    pub(super) fn new(points: Vec<DVec3>, normal: DVec3, (rotation, face): (DMat3, DVec3)) -> Self {
        let docked = |point: &DVec3| rotation.transpose() * (*point - face);
        let off = points.first().map_or(DVec2::ZERO, |point| (*point - docked(point)).truncate());
        Self { points, normal, off }
    }
}

/// Appearance of a patch at one position, at any depth: a point, or an edge straight across the plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stroke {
    /// Along the plane and upwards, in D.
    pub(super) at: [f64; 2],
    /// Range of offsets beside the axis, in D.
    reach: [f64; 2],
}

impl Stroke {
    /// Whether a plane so far beside the axis meets it, or passes it as near as `close`.
    pub(super) fn holds(&self, offset: f64, close: f64) -> bool {
        (self.reach[0] - close..=self.reach[1] + close).contains(&offset)
    }

    const fn middle(&self) -> f64 {
        f64::midpoint(self.reach[0], self.reach[1])
    }
}

impl Patch {
    /// Its points in a world rotated so that planes have constant y, by their visible positions.
    pub(super) fn strokes(&self, turn: &DMat3) -> Vec<Stroke> {
        let mut strokes: Vec<Stroke> = Vec::new();
        for point in &self.points {
            let DVec3 { x, y, z } = *turn * *point;
            let same = |stroke: &&mut Stroke| (stroke.at[0] - x).hypot(stroke.at[1] - z) < IN_PLANE;
            match strokes.iter_mut().find(same) {
                Some(Stroke { reach: [lo, hi], .. }) => (*lo, *hi) = (lo.min(y), hi.max(y)),
                None => strokes.push(Stroke { at: [x, z], reach: [y, y] }),
            }
        }
        strokes
    }
}

/// Nearer than this is in the plane, in D: less than the picture resolves.
const IN_PLANE: f64 = 2e-3;
/// Horizontal components below this define no direction.
const UPRIGHT: f64 = 0.02;
/// Angles below this count as zero, radians: 0.06°, less than the picture shows.
const NO_ANGLE: f64 = 1e-3;

impl Plane {
    /// The plane y = 0, or a plane through each layer.
    pub(super) fn across(connector: &Connector) -> Self {
        Self { azimuth: 0.0, offsets: super::section::cuts(connector), through_contacts: false }
    }

    /// The plane that contains most of the contacts; the usual plane if it is sufficient.
    pub(super) fn through(connector: &Connector, patches: &[Patch]) -> Self {
        let usual = Self::across(connector);
        let Some(azimuth) = direction(patches) else { return usual };
        let turn = DMat3::from_rotation_z(-azimuth);
        let strokes: Vec<Vec<Stroke>> = patches.iter().map(|patch| patch.strokes(&turn)).collect();
        let holds =
            |offset: f64, strokes: &[Stroke]| strokes.iter().any(|stroke| stroke.holds(offset, IN_PLANE));
        let counts = |offset: f64| strokes.iter().filter(|strokes| holds(offset, strokes)).count();
        let is_usual = azimuth.abs() < NO_ANGLE;
        let all = strokes.iter().all(|strokes| usual.offsets.iter().any(|offset| holds(*offset, strokes)));
        if is_usual && (all || usual.offsets.len() > 1) {
            return usual;
        }
        let middles = strokes.iter().flatten().map(Stroke::middle);
        let best = middles.chain(is_usual.then_some(0.0)).max_by(|a, b| {
            // Of equal counts, the offset nearer to the axis.
            counts(*a).cmp(&counts(*b)).then(b.abs().total_cmp(&a.abs()))
        });
        let Some(offset) = best else { return usual };
        Self { azimuth: if is_usual { 0.0 } else { azimuth }, offsets: vec![offset], through_contacts: true }
    }

    /// The plane through the contacts; the usual plane if that shows almost nothing of either half, as at a
    /// corner or a side, or without contacts; rotated about the axis if it would show the fixed half as a
    /// plain block.
    pub(super) fn showing(
        design: &Design,
        connector: &Connector,
        placement: &MovingHalfPose,
        patches: &[Patch],
    ) -> Self {
        /// Share of the usual cut of a half below which a cut shows almost nothing.
        const SLIVER: f64 = 0.2;
        let (usual, plane) = (Self::across(connector), Self::through(connector, patches));
        let halves =
            [(&connector.fixed, (DMat3::IDENTITY, DVec3::ZERO)), (&connector.moving, placement.of(design))];
        let shows = |(half, at): (&Half, _)| {
            area(&plane.outlines(half, at)) >= SLIVER * area(&usual.outlines(half, at))
        };
        if plane.through_contacts && halves.into_iter().all(shows) {
            return plane;
        }
        if usual.offsets.len() > 1 || usual.shows_features_of(&connector.fixed) {
            return usual;
        }
        let turned = [PI / 4.0, -PI / 4.0, PI / 2.0].map(|azimuth| Self { azimuth, ..usual.clone() });
        turned.into_iter().find(|plane| plane.shows_features_of(&connector.fixed)).unwrap_or(usual)
    }

    /// Whether the profile of a half varies along the plane: it is no plain block there.
    fn shows_features_of(&self, half: &Half) -> bool {
        /// A block fills its bounds but for less than this share.
        const BLOCK: f64 = 0.02;
        let outlines = self.outlines(half, (DMat3::IDENTITY, DVec3::ZERO));
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in outlines.iter().flatten() {
            for (k, value) in point.iter().enumerate() {
                (lo[k], hi[k]) = (lo[k].min(*value), hi[k].max(*value));
            }
        }
        area(&outlines) < (1.0 - BLOCK) * (hi[0] - lo[0]) * (hi[1] - lo[1])
    }

    /// A half of this rotation and face centre, cut.
    fn outlines(&self, half: &Half, (rotation, face): (DMat3, DVec3)) -> Vec<Vec<[f64; 2]>> {
        let turn = self.turn();
        self.offsets.iter().flat_map(|y| cut(half, turn * rotation, turn * face, *y)).collect()
    }

    /// Rotates the world so that the plane has constant y.
    pub(super) fn turn(&self) -> DMat3 {
        if self.azimuth == 0.0 { DMat3::IDENTITY } else { DMat3::from_rotation_z(-self.azimuth) }
    }

    /// Name of its direction on an axis: `x`, or `along 30°` from x.
    pub(super) fn name(&self) -> String {
        if self.azimuth == 0.0 {
            return "x".to_owned();
        }
        if (self.azimuth.abs() - PI / 2.0).abs() < NO_ANGLE {
            return "y".to_owned();
        }
        format!("along {:.0}° from x", self.azimuth.to_degrees()).replace('-', "−")
    }
}

/// Area enclosed by outlines, without holes, in D².
fn area(outlines: &[Vec<[f64; 2]>]) -> f64 {
    let one = |outline: &Vec<[f64; 2]>| -> f64 {
        let next = outline.iter().cycle().skip(1);
        outline.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum()
    };
    outlines.iter().map(one).sum::<f64>().abs()
}

/// The angle from x of the main horizontal direction of the normals, or else of the vectors to the docked
/// positions, or of the contacts; `None` without contacts.
fn direction(patches: &[Patch]) -> Option<f64> {
    let normals = patches.iter().map(|patch| patch.normal.truncate());
    let upright = normals.clone().all(|normal| normal.length() < UPRIGHT);
    let points = || patches.iter().flat_map(|patch| patch.points.iter().map(|point| point.truncate()));
    let count = points().count();
    if count == 0 {
        return None;
    }
    let mean = points().sum::<DVec2>() / count as f64;
    let ways: Vec<DVec2> = if !upright {
        normals.collect()
    } else if patches.iter().any(|patch| patch.off.length() > IN_PLANE) {
        patches.iter().map(|patch| patch.off).collect()
    } else if points().any(|point| point.distance(mean) > IN_PLANE) {
        points().map(|point| point - mean).collect()
    } else {
        vec![mean]
    };
    // Twice the angle of the main axis of the second moments.
    let (xx, xy) =
        ways.iter().fold((0.0, 0.0), |(xx, xy), v| (xx + v.x * v.x - v.y * v.y, xy + 2.0 * v.x * v.y));
    if xx.hypot(xy) < IN_PLANE * IN_PLANE {
        return Some(0.0);
    }
    let angle = 0.5 * xy.atan2(xx);
    Some(if angle <= -PI / 2.0 + NO_ANGLE { angle + PI } else { angle })
}

#[cfg(test)]
mod tests {
    use super::super::testing::{pyramid, v_face, x_face};
    use super::*;
    use catchment_core::pose::Dof;

    fn patch(points: &[[f64; 3]], normal: [f64; 3]) -> Patch {
        let points = points.iter().copied().map(DVec3::from_array).collect();
        Patch::new(points, DVec3::from_array(normal), (DMat3::IDENTITY, DVec3::ZERO))
    }

    #[test]
    fn the_plane_passes_through_the_contacts() {
        let contacts =
            [patch(&[[0.3, 0.1, 0.0]], [-0.7, 0.0, 0.7]), patch(&[[-0.2, 0.1, 0.0]], [0.7, 0.0, 0.7])];
        let plane = Plane::through(&pyramid(), &contacts);
        assert_eq!((plane.azimuth, plane.offsets.as_slice()), (0.0, &[0.1][..]));
        let in_plane = |contact: &Patch| contact.strokes(&plane.turn())[0].holds(plane.offsets[0], 1e-12);
        assert!(contacts.iter().all(in_plane));
        // The same contacts turned by 50°: the offset y = 0.1 becomes an offset of 0.1 from the axis.
        let by = DMat3::from_rotation_z(50f64.to_radians());
        let turned: Vec<Patch> = contacts
            .iter()
            .map(|c| {
                let points = c.points.iter().map(|p| by * *p).collect();
                Patch::new(points, by * c.normal, (DMat3::IDENTITY, DVec3::ZERO))
            })
            .collect();
        let plane = Plane::through(&pyramid(), &turned);
        assert!((plane.azimuth - 50f64.to_radians()).abs() < 1e-9 && (plane.offsets[0] - 0.1).abs() < 1e-9);
        assert_eq!(plane.name(), "along 50° from x");
    }

    /// A peg beside its hole is cut in the direction of its offset, rotated or not.
    #[test]
    fn contacts_with_vertical_normals_are_cut_along_the_offset() {
        let beside = |turn: DMat3, off: DVec3| {
            let points = [DVec3::new(0.3, 0.1, 0.0), DVec3::new(0.3, 0.11, 0.0)].map(|p| turn * p + off);
            Patch::new(points.to_vec(), DVec3::Z, (turn, off))
        };
        let plane = Plane::through(&pyramid(), &[beside(DMat3::IDENTITY, DVec3::new(0.1, -0.1, 0.2))]);
        assert_eq!(plane.name(), "along −45° from x");
        // Turned slightly about the axis: the point at x = 0.3 moves along y.
        let plane = Plane::through(&pyramid(), &[beside(DMat3::from_rotation_z(0.02), DVec3::ZERO)]);
        assert!((plane.azimuth.to_degrees() + 71.0).abs() < 2.0, "{plane:?}");
    }

    /// A side that touches along the border of the halves, at which a cut shows a block and no other half.
    #[test]
    fn an_almost_empty_cut_is_replaced_by_the_default_cut() {
        use crate::schema::testing::design;
        let design = design([Dof::X, Dof::Pitch].into_iter().collect());
        let mated = MovingHalfPose::mated(&design, 0.0);
        for y in [-0.5, 0.5] {
            let slopes = [-1.0, 1.0].map(|x| patch(&[[0.4 * x, y, 0.2]], [-0.7 * x, 0.0, 0.7]));
            assert_eq!(Plane::through(&pyramid(), &slopes).offsets, [y]);
            assert_eq!(Plane::showing(&design, &pyramid(), &mated, &slopes), Plane::across(&pyramid()));
        }
        let inside = [-1.0, 1.0].map(|x| patch(&[[0.4 * x, 0.1, 0.2]], [-0.7 * x, 0.0, 0.7]));
        assert_eq!(Plane::showing(&design, &pyramid(), &mated, &inside).offsets, [0.1]);
    }

    /// The 3-D X-Face is level along x and y.
    #[test]
    fn the_cut_turns_to_a_profile_that_varies() {
        use crate::schema::testing::design;
        let design = design(catchment_core::pose::DofSet::ALL);
        let mated = MovingHalfPose::mated(&design, 0.0);
        let text = "[connector]\nfamily = \"x-face-3d\"\n";
        let problem = catchment_core::problem::Problem::of(
            catchment_core::design::read(text, ".".as_ref()).unwrap().design,
        )
        .unwrap();
        let plane = Plane::showing(&design, problem.connector(), &mated, &[]);
        assert!((plane.azimuth.abs() - PI / 4.0).abs() < 1e-12 && plane.offsets == [0.0], "{plane:?}");
        assert_eq!(Plane::showing(&design, &pyramid(), &mated, &[]), Plane::across(&pyramid()));
    }

    /// Two points of a feature on opposite sides of a plane are not in it; an edge straight across is.
    #[test]
    fn only_features_that_meet_the_plane_lie_in_it() {
        let apart = patch(&[[0.3, -0.14, 0.0], [0.1, -0.38, 0.0]], [-0.7, 0.0, 0.7]);
        let strokes = apart.strokes(&DMat3::IDENTITY);
        assert_eq!(strokes.len(), 2);
        assert!(strokes.iter().all(|stroke| !stroke.holds(-0.26, 5e-3)));
        let edge = patch(&[[0.3, -0.25, 0.0], [0.3, 0.25, 0.0]], [-0.7, 0.0, 0.7]);
        assert!(matches!(edge.strokes(&DMat3::IDENTITY)[..], [stroke] if stroke.holds(0.1, 0.0)));
    }

    #[test]
    fn contacts_visible_in_the_default_cut_keep_it() {
        // A tip drawn along y touches along its edge: y = 0 will do; and so will the layers.
        let edge = [patch(&[[0.3, -0.25, 0.0], [0.3, 0.25, 0.0]], [-0.7, 0.0, 0.7])];
        assert_eq!(Plane::through(&v_face(), &edge), Plane::across(&v_face()));
        assert_eq!(Plane::through(&x_face(), &edge), Plane::across(&x_face()));
        assert_eq!(Plane::through(&v_face(), &[]), Plane::across(&v_face()));
    }
}
