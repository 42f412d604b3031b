//! Test whether a half mates with a copy of itself: the solids of both halves, as drawn, are equal up to a
//! translation.

use super::{Connector, Half};
use catchment_base::pose::Mount;
use glam::DVec3;

/// Distance, relative to the size of a half, within which two points are the same: a mesh in single
/// precision is as good as the same solid.
const SAME: f64 = 1e-5;

impl Connector {
    /// Whether both halves, as drawn, are the same solid up to a translation (the dissertation's eq. 5.5).
    ///
    /// Compares volumes, boxes, and that every facet of each half lies on the boundary of the other; how a
    /// flat face is cut into facets does not matter, how a half is cut into pieces does.
    pub fn ungendered(&self, mount: Mount) -> bool {
        let drawn = self.moving.mapped(|p| mount.apply(p));
        let (Some(a), Some(b)) = (bounds(&self.fixed), bounds(&drawn)) else { return false };
        let tolerance = SAME * (a.1 - a.0).length();
        if ((a.1 - a.0) - (b.1 - b.0)).length() > tolerance {
            return false;
        }
        let moved = drawn.mapped(|p| p + (a.0 - b.0));
        let volume = |half: &Half| half.surfaces.iter().map(super::Surface::volume).sum::<f64>();
        // A shift of the whole boundary by the tolerance changes the volume by less than this.
        let slack = tolerance * (a.1 - a.0).length_squared() * 6.0;
        (volume(&self.fixed) - volume(&drawn)).abs() <= slack
            && lies_on(&self.fixed, &moved, tolerance)
            && lies_on(&moved, &self.fixed, tolerance)
    }
}

fn bounds(half: &Half) -> Option<(DVec3, DVec3)> {
    half.surfaces.iter().map(super::Surface::bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Whether the middle and the corners (drawn slightly inward) of every facet of `a` lie on a facet of `b`
/// that faces the same way.
fn lies_on(a: &Half, b: &Half, tolerance: f64) -> bool {
    let polygons: Vec<(DVec3, Vec<DVec3>)> = b
        .surfaces
        .iter()
        .flat_map(|s| {
            s.facets.iter().map(|f| (f.normal, f.corners.iter().map(|&k| s.vertices[k as usize]).collect()))
        })
        .collect();
    let covered = |p: DVec3, normal: DVec3| {
        polygons.iter().any(|(n, corners)| {
            n.dot(normal) > 1.0 - SAME
                && n.dot(p - corners[0]).abs() <= tolerance
                && (0..corners.len()).all(|k| {
                    let (u, v) = (corners[k], corners[(k + 1) % corners.len()]);
                    (v - u).cross(p - u).dot(*n) >= -tolerance * (v - u).length()
                })
        })
    };
    a.surfaces.iter().all(|s| {
        s.facets.iter().all(|f| {
            let corners = || f.corners.iter().map(|&k| s.vertices[k as usize]);
            let middle = corners().sum::<DVec3>() / f.corners.len() as f64;
            covered(middle, f.normal) && corners().all(|c| covered(middle.lerp(c, 0.999), f.normal))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{family, stl};
    use catchment_design::design::family::PinHole;
    use catchment_design::design::{Family, FamilySpec};

    fn connector(spec: &FamilySpec, mount: Mount) -> Connector {
        Connector::placed(&family::draw(spec).unwrap(), mount)
    }

    #[test]
    fn ungendered_families_are_those_of_the_literature() {
        for name in Family::ALL {
            let ungendered =
                matches!(name, Family::SFace | Family::XFace | Family::XFace3d | Family::XFace3dLocking);
            for mount in [Mount::X, Mount::Y] {
                assert_eq!(
                    connector(&FamilySpec::new(name), mount).ungendered(mount),
                    ungendered,
                    "{name:?}"
                );
            }
        }
        let spec = PinHole { hermaphroditic: true, chamfer: 0.05, ..PinHole::DEFAULT }.into();
        assert!(connector(&spec, Mount::X).ungendered(Mount::X));
    }

    #[test]
    fn a_mesh_in_single_precision_is_the_same_solid() {
        let mut pair = connector(&FamilySpec::new(Family::XFace3d), Mount::X);
        let mut file = Vec::new();
        stl::write(&pair.fixed, stl::StlEncoding::Binary, &mut file).unwrap();
        pair.fixed = stl::from_bytes(&file, file.len() as u64, 1.0).unwrap();
        assert!(pair.ungendered(Mount::X));
        // A wall moved by a hundredth of D is seen.
        pair.fixed = pair.fixed.mapped(|p| p * 1.01);
        assert!(!pair.ungendered(Mount::X));
    }
}
