//! The built-in families: mating surfaces facing +z, drawn in units of D, mid height at z = H/2.
//!
//! ```text
//!  v-face   s-face    x-face         pyramid, cone        x-face-3d
//!  ╲    ╱    ╱╲       ╱ layer 1      apex + rim,          four triangles
//!   ╲  ╱    ╱  ╲  ╱   ╲ layer 2      socket and plug      around a saddle
//!    ╲╱         ╲╱
//! ```
//!
//! The material behind the mating surface can touch once a half tilts, so it belongs to the family:
//! `base_thickness` extends it down to z = −`base_thickness`. A thickness that the design states applies to
//! both halves. By default the socket halves of `pyramid` and `cone` and both halves of the saddles and of
//! `pin-hole` have 0.25; all other halves end at z = 0.

mod fan;
mod locking;
mod pin_hole;
mod planar;

pub(super) use fan::{MAX_CORNERS, circle, corners_of_circle};

use super::{GeometryDefect, Half, HalfRole, Surface, SurfaceError};
use catchment_design::design::FamilySpec;

/// Default backing of a socket half, in D.
const SOCKET_THICKNESS: f64 = 0.25;

/// Two halves as drawn: both facing +z, each in its own frame.
#[derive(Debug)]
pub(super) struct DrawnHalves {
    /// The fixed half.
    pub(super) fixed: Half,
    /// The moving half, not yet mounted.
    pub(super) moving: Half,
    /// z of both face centres, in D.
    pub(super) face_height: f64,
}

/// Geometry from a family's parameters.
trait Draw {
    /// Checks the parameters that are specific to this family.
    fn check(&self, _check: &mut Check) {}

    /// The surfaces, once the parameters are sound.
    fn halves(&self) -> Halves;

    /// z of both face centres, in D, if it differs from H/2.
    fn face_height(&self) -> Option<f64> {
        None
    }
}

/// The table of families: which parameters are drawn how.
fn drawing(spec: &FamilySpec) -> &dyn Draw {
    match spec {
        FamilySpec::VFace(face) => face,
        FamilySpec::SFace(face) => face,
        FamilySpec::XFace(face) => face,
        FamilySpec::Pyramid(pyramid) => pyramid,
        FamilySpec::Cone(cone) => cone,
        FamilySpec::XFace3d(saddle) => saddle,
        FamilySpec::XFace3dLocking(saddle) => saddle,
        FamilySpec::PinHole(plate) => plate,
    }
}

/// Draws a family.
pub(super) fn draw(spec: &FamilySpec) -> Result<DrawnHalves, Vec<GeometryDefect>> {
    let family = spec.family();
    let mut check = Check { family: family.name(), problems: Vec::new() };
    let height = spec.aspect_ratio();
    check.require("aspect_ratio", height, height > 0.0, "the face needs a height: give a number above 0");
    if let Some(base) = spec.base_thickness() {
        if family.is_planar() {
            check.require("base_thickness", base, base >= 0.0, "give 0 or more");
        } else {
            check.require(
                "base_thickness",
                base,
                base > 0.0,
                "the face needs material behind it: give a number above 0",
            );
        }
    }
    let drawing = drawing(spec);
    drawing.check(&mut check);
    check.done()?;
    let halves = drawing.halves();
    let mut problems = Vec::new();
    let [fixed, moving] = halves;
    let mut half = |side, surfaces: Vec<Result<Surface, SurfaceError>>| {
        let mut half = Half::default();
        for (surface, result) in surfaces.into_iter().enumerate() {
            match result {
                Ok(s) => half.surfaces.push(s),
                Err(error) => problems.push(GeometryDefect::Surface { side, surface, error }),
            }
        }
        half
    };
    let (fixed, moving) = (half(HalfRole::Fixed, fixed), half(HalfRole::Moving, moving));
    let face_height = drawing.face_height().unwrap_or(height / 2.0);
    if problems.is_empty() { Ok(DrawnHalves { fixed, moving, face_height }) } else { Err(problems) }
}

/// The surfaces of the fixed and the moving half, as far as they could be built.
type Halves = [Vec<Result<Surface, SurfaceError>>; 2];

/// Collects the errors in a family's parameters.
struct Check {
    family: &'static str,
    problems: Vec<GeometryDefect>,
}

impl Check {
    fn require(&mut self, parameter: &'static str, value: f64, holds: bool, advice: impl Into<String>) {
        if !holds || !value.is_finite() {
            let family = self.family;
            self.problems.push(GeometryDefect::Parameter { family, parameter, value, advice: advice.into() });
        }
    }

    fn done(self) -> Result<(), Vec<GeometryDefect>> {
        if self.problems.is_empty() { Ok(()) } else { Err(self.problems) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_design::design::Family;
    use catchment_design::design::family::{PinHole, XFace3dLocking};
    use glam::DVec3;

    fn volume(half: &Half) -> f64 {
        half.surfaces.iter().map(Surface::volume).sum()
    }

    fn spec(family: Family, aspect_ratio: f64, base_thickness: Option<f64>) -> FamilySpec {
        FamilySpec::new(family).with_aspect_ratio(aspect_ratio).with_base_thickness(base_thickness)
    }

    /// Sums of at most a hundred terms below 1 round by less than 1e-14.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn volumes_are_the_closed_forms() {
        let h = 0.6;
        // (family, base, fixed, moving): area of the profile × depth, or base area × height / 3.
        let cases = [
            (Family::VFace, None, h / 2.0, h / 2.0),
            (Family::VFace, Some(0.5), h / 2.0 + 0.5, h / 2.0 + 0.5),
            (Family::SFace, None, h / 2.0, h / 2.0),
            (Family::SFace, Some(0.5), h / 2.0 + 0.5, h / 2.0 + 0.5),
            (Family::XFace, None, 0.9 * h / 2.0, 0.9 * h / 2.0),
            (Family::XFace, Some(0.5), 0.9 * (h / 2.0 + 0.5), 0.9 * (h / 2.0 + 0.5)),
            (Family::Pyramid, None, h * 2.0 / 3.0 + 0.25, h / 3.0),
            (Family::Pyramid, Some(0.1), h * 2.0 / 3.0 + 0.1, h / 3.0 + 0.1),
            (Family::XFace3d, None, h / 2.0 + 0.25, h / 2.0 + 0.25),
        ];
        for (family, base, fixed, moving) in cases {
            let drawn = draw(&spec(family, h, base)).unwrap();
            assert!((volume(&drawn.fixed) - fixed).abs() < ROUNDING, "{family:?} {base:?}");
            assert!((volume(&drawn.moving) - moving).abs() < ROUNDING, "{family:?} {base:?}");
        }
    }

    #[test]
    fn the_cone_is_inscribed_and_within_its_chord_error() {
        for error in [0.05, 0.01, 0.001, 1e-4] {
            let drawn = draw(&spec(Family::Cone, 1.0, None).with_chord_error(error)).unwrap();
            let plug = &drawn.moving.surfaces[0];
            let rim: Vec<DVec3> = plug.vertices.iter().copied().filter(|v| v.z == 0.0).collect();
            for (k, p) in rim.iter().enumerate() {
                let q = rim[(k + 1) % rim.len()];
                assert!((p.length() - 0.5).abs() < ROUNDING);
                assert!(0.5 - p.midpoint(q).length() <= error * (1.0 + 1e-9), "{error}");
            }
            assert_eq!(rim.len() % 4, 0);
        }
    }

    #[test]
    fn locking_halves_have_the_mean_height_of_their_face() {
        // z − mid is odd in x, so the volume is that of the block up to mid height; vertical faces lose the
        // strip over which they stand back: H·m + ℓ over two L-shapes of width c/2.
        let (h, lip, c): (f64, f64, f64) = (0.5, 0.2, 0.02);
        for draft_angle in [0.0, 0.01, 0.3] {
            let default = XFace3dLocking { aspect_ratio: h, ..XFace3dLocking::DEFAULT };
            let spec = XFace3dLocking { draft_angle, lip_height: lip, clearance: c, ..default };
            let drawn = draw(&spec.into()).unwrap();
            let area = c / 2.0 - c.powi(2) / 4.0;
            let moment = c.powi(2) / 8.0 - c.powi(3) / 12.0;
            let lost = if draft_angle == 0.0 { 2.0 * (h * moment + lip * area) } else { 0.0 };
            assert!((volume(&drawn.fixed) - (0.25 + 0.35 - lost)).abs() < ROUNDING, "{draft_angle}");
            assert_eq!(drawn.fixed, drawn.moving);
        }
    }

    #[test]
    fn pins_and_holes_have_the_volume_of_their_polygons() {
        for (pins, hermaphroditic, chamfer) in [
            (1, false, 0.1),
            (2, false, 0.1),
            (3, false, 0.02),
            (4, false, 0.03),
            (2, true, 0.02),
            (3, true, 0.05),
        ] {
            let s = PinHole { pins, hermaphroditic, chamfer, ..PinHole::DEFAULT };
            let drawn = draw(&s.into()).unwrap();
            // Area of the inscribed n-gon of radius r, and a frustum's volume between two of them.
            let n = super::fan::corners_of_circle(s.pin_radius + s.clearance + chamfer, s.chord_error);
            let unit = n / 2.0 * (2.0 * std::f64::consts::PI / n).sin();
            let frustum = |a: f64, b: f64, h: f64| unit * h * (a * a + a * b + b * b) / 3.0;
            let (h, r, c) = (s.aspect_ratio, s.pin_radius, s.clearance);
            let point = chamfer.min(r);
            let pin = frustum(r, r, h - point) + frustum(r, r - point, point);
            let hole = frustum(r + c + chamfer, r + c, chamfer)
                + frustum(r + c, r + c, h - chamfer - point - c)
                + frustum(r + c, r - point, point + c);
            let n = f64::from(pins);
            let (fixed, moving) = if hermaphroditic {
                let v = h + 0.25 + n * (pin - hole);
                (v, v)
            } else {
                (h + 0.25 - n * hole, 0.25 + n * pin)
            };
            assert!((volume(&drawn.fixed) - fixed).abs() < ROUNDING, "{pins} {hermaphroditic}");
            assert!((volume(&drawn.moving) - moving).abs() < ROUNDING, "{pins} {hermaphroditic}");
        }
    }

    #[test]
    fn pins_that_overlap_or_leave_the_plate_are_refused() {
        let default = PinHole::DEFAULT;
        for bad in [
            PinHole { pins: 0, ..default },
            PinHole { pins: 12, ..default },
            PinHole { circle_radius: 0.4, ..default },
            PinHole { aspect_ratio: 0.15, ..default },
            PinHole { chord_error: 1e-9, ..default },
        ] {
            assert_eq!(draw(&bad.into()).unwrap_err().len(), 1, "{bad:?}");
        }
    }

    #[test]
    fn every_bad_parameter_is_named_at_once() {
        let bad = spec(Family::Cone, f64::NAN, Some(0.0)).with_chord_error(0.0);
        let names: Vec<_> = draw(&bad)
            .unwrap_err()
            .into_iter()
            .map(|p| match p {
                GeometryDefect::Parameter { parameter, .. } => parameter,
                other => panic!("{other}"),
            })
            .collect();
        assert_eq!(names, ["aspect_ratio", "base_thickness", "chord_error"]);
    }
}
