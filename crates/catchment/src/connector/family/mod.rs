//! The built-in families: mating surfaces facing +z, drawn in units of D, mid height at z = H/2.
//!
//! ```text
//!  v-face   s-face    x-face         pyramid, cone        x-face-3d
//!  ╲    ╱    ╱╲       ╱ layer 1      apex + rim,          four triangles
//!   ╲  ╱    ╱  ╲  ╱   ╲ layer 2      socket and plug      around a saddle
//!    ╲╱         ╲╱
//! ```
//!
//! What lies behind the mating surface counts once a half tilts, so it belongs to the family:
//! `base_thickness` backs it down to z = −`base_thickness`. Where a design names a thickness, both halves have
//! it; where it does not, the socket halves of `pyramid` and `cone` and both halves of the saddles have 0.25,
//! and everything else ends at z = 0.

mod fan;
mod planar;

use super::{Half, Problem, Side, Surface, SurfaceError};
use crate::design::{Family, FamilySpec};

/// Default backing of a socket half, in D.
const SOCKET_THICKNESS: f64 = 0.25;

/// Two halves as drawn: both facing +z, each in its own frame.
#[derive(Debug)]
pub(super) struct Drawn {
    /// The fixed half.
    pub(super) fixed: Half,
    /// The moving half, not yet mounted.
    pub(super) moving: Half,
    /// z of both face centres, in D.
    pub(super) face_height: f64,
}

/// Draws a family.
pub(super) fn draw(spec: &FamilySpec) -> Result<Drawn, Vec<Problem>> {
    let mut check = Check { spec, problems: Vec::new() };
    let height = spec.aspect_ratio;
    check.require("aspect_ratio", height, height > 0.0, "the face needs a height: give a number above 0");
    let backed = matches!(spec.family, Family::Pyramid | Family::Cone | Family::XFace3d);
    if let Some(base) = spec.base_thickness {
        if backed {
            check.require(
                "base_thickness",
                base,
                base > 0.0,
                "the bottom of the socket needs material behind it: give a number above 0",
            );
        } else {
            check.require("base_thickness", base, base >= 0.0, "give 0 or more");
        }
    }
    if spec.family == Family::Cone {
        fan::check_chord(&mut check);
    }
    check.done()?;
    let halves = match spec.family {
        Family::VFace => planar::v_face(spec),
        Family::SFace => planar::s_face(spec),
        Family::XFace => planar::x_face(spec),
        Family::Pyramid => fan::pyramid(spec),
        Family::Cone => fan::cone(spec),
        Family::XFace3d => fan::saddle(spec),
        Family::XFace3dLocking | Family::PinHole => {
            let family = spec.family.name();
            return Err(vec![Problem::Parameter {
                family,
                parameter: "family",
                value: 0.0,
                advice: "not drawn yet".into(),
            }]);
        }
    };
    let mut problems = Vec::new();
    let [fixed, moving] = halves;
    let mut half = |side, surfaces: Vec<Result<Surface, SurfaceError>>| {
        let mut half = Half::default();
        for (surface, result) in surfaces.into_iter().enumerate() {
            match result {
                Ok(s) => half.surfaces.push(s),
                Err(error) => problems.push(Problem::Surface { side, surface, error }),
            }
        }
        half
    };
    let (fixed, moving) = (half(Side::Fixed, fixed), half(Side::Moving, moving));
    if problems.is_empty() { Ok(Drawn { fixed, moving, face_height: height / 2.0 }) } else { Err(problems) }
}

/// The surfaces of the fixed and the moving half, as far as they could be built.
type Halves = [Vec<Result<Surface, SurfaceError>>; 2];

/// Collects what is wrong with a family's parameters.
struct Check<'a> {
    spec: &'a FamilySpec,
    problems: Vec<Problem>,
}

impl Check<'_> {
    fn require(&mut self, parameter: &'static str, value: f64, holds: bool, advice: impl Into<String>) {
        if !holds || !value.is_finite() {
            let family = self.spec.family.name();
            self.problems.push(Problem::Parameter { family, parameter, value, advice: advice.into() });
        }
    }

    fn done(self) -> Result<(), Vec<Problem>> {
        if self.problems.is_empty() { Ok(()) } else { Err(self.problems) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn volume(half: &Half) -> f64 {
        half.surfaces.iter().map(Surface::volume).sum()
    }

    fn spec(family: Family, aspect_ratio: f64, base_thickness: Option<f64>) -> FamilySpec {
        FamilySpec { aspect_ratio, base_thickness, ..FamilySpec::new(family) }
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
            let drawn = draw(&FamilySpec { chord_error: error, ..spec(Family::Cone, 1.0, None) }).unwrap();
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
    fn every_bad_parameter_is_named_at_once() {
        let bad = FamilySpec { chord_error: 0.0, ..spec(Family::Cone, f64::NAN, Some(0.0)) };
        let names: Vec<_> = draw(&bad)
            .unwrap_err()
            .into_iter()
            .map(|p| match p {
                Problem::Parameter { parameter, .. } => parameter,
                other => panic!("{other}"),
            })
            .collect();
        assert_eq!(names, ["aspect_ratio", "base_thickness", "chord_error"]);
    }
}
