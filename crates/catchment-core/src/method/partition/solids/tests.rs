use super::*;
use crate::acceptance::Stream;
use crate::connector::{Connector, Half, convex_hull};
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::polytope::Collection;
use crate::pose::{CorPose, PoseError};
use glam::{DMat3, DVec2};

const X: &[Dof] = &[Dof::X];
const XY: &[Dof] = &[Dof::X, Dof::Y];
const X_PITCH: &[Dof] = &[Dof::X, Dof::Pitch];

fn alignment(family: Family, cor: f64, free: &[Dof]) -> Alignment {
    let mut alignment = Alignment::default_for(Some(family));
    alignment.center_of_rotation = cor;
    alignment.free = free.iter().copied().collect();
    alignment
}

fn connector(family: Family, aspect_ratio: f64, alignment: &Alignment) -> Connector {
    let mut spec = FamilySpec::new(family).with_aspect_ratio(aspect_ratio);
    if family == Family::Cone {
        spec = spec.with_chord_error(0.03);
    }
    let connector = ConnectorSpec::Family(spec);
    let alignment = alignment.clone();
    let design = Design { name: String::new(), connector, width: 1.0, unit: None, alignment };
    Connector::build(&design).unwrap()
}

fn pair(family: Family, aspect_ratio: f64, cor: f64, free: &[Dof]) -> Pair {
    let alignment = alignment(family, cor, free);
    Pair::new(&connector(family, aspect_ratio, &alignment), &alignment)
}

fn made(pair: &Pair, subject: SolidShape, slices: usize) -> Solids {
    shapes(pair, subject, &PartitionSettings { slices, strips: 1 }, &Exec::new()).unwrap()
}

/// The half-spaces (normal, offset) whose intersection is the body.
fn planes(solid: &Solid) -> Vec<(DVec3, f64)> {
    let at = |k: usize| solid.vertices[k];
    let area = |face: &[usize]| -> DVec3 {
        face.windows(2).map(|w| (at(w[0]) - at(face[0])).cross(at(w[1]) - at(face[0]))).sum()
    };
    if let [face] = &solid.faces[..] {
        let across = area(face);
        return (0..face.len())
            .map(|k| {
                let (a, b) = (at(face[k]), at(face[(k + 1) % face.len()]));
                let normal = (b - a).cross(across).normalize();
                (normal, normal.dot(a))
            })
            .collect();
    }
    solid
        .faces
        .iter()
        .map(|face| {
            let normal = area(face).normalize();
            (normal, normal.dot(at(face[0])))
        })
        .collect()
}

/// Intersection of the body with the upright line over x and y of the file.
fn range(solid: &Solid, x: f64, y: f64) -> Option<[f64; 2]> {
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    for (normal, offset) in planes(solid) {
        let rest = offset - normal.x * x - normal.y * y;
        if normal.z.abs() < 1e-9 {
            if rest < 0.0 {
                return None;
            }
        } else if normal.z > 0.0 {
            high = high.min(rest / normal.z);
        } else {
            low = low.max(rest / normal.z);
        }
    }
    (low <= high).then_some([low, high])
}

/// The lowest and highest place of a shape over x and y of the file.
fn sides(shape: &Solids, x: f64, y: f64) -> Option<[f64; 2]> {
    let ranges = shape.solids.iter().filter_map(|solid| {
        let flat = solid.faces.len() == 1 && shape.axes == ["x", "y", "z"];
        range(solid, x, if flat { solid.vertices[0].y } else { y })
    });
    ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// Signed volume, or twice the area against −y of a flat body in the x–z plane.
fn measure(solid: &Solid) -> f64 {
    let at = |k: usize| solid.vertices[k];
    if let [face] = &solid.faces[..] {
        let flat = |k: usize| DVec2::new(at(face[k]).x, at(face[k]).z);
        return (0..face.len()).map(|k| flat(k).perp_dot(flat((k + 1) % face.len()))).sum::<f64>() / 2.0;
    }
    let cone = |face: &Vec<usize>| -> f64 {
        face.windows(2).map(|w| at(face[0]).dot(at(w[0]).cross(at(w[1]))) / 6.0).sum()
    };
    solid.faces.iter().map(cone).sum()
}

/// The measure of the union of flat bodies.
fn union(shape: &Solids) -> f64 {
    let flat = |v: &DVec3| [v.x, v.z, 0.0, 0.0, 0.0, 0.0];
    let polytope = |solid: &Solid| Polytope::hull(2, &solid.vertices.iter().map(flat).collect::<Vec<_>>());
    shape.solids.iter().filter_map(polytope).collect::<Collection>().volume()
}

#[test]
fn every_body_is_closed_and_faces_out() {
    let mut bodies = 0;
    for (family, free) in [
        (Family::VFace, X),
        (Family::VFace, X_PITCH),
        (Family::XFace, X_PITCH),
        (Family::SFace, X_PITCH),
        (Family::Pyramid, XY),
        (Family::XFace3d, XY),
        (Family::Cone, XY),
        (Family::XFace3dLocking, XY),
        (Family::Pyramid, &[Dof::X, Dof::Roll]),
        (Family::Pyramid, &[Dof::Y, Dof::Roll]),
        (Family::Pyramid, &[Dof::Y, Dof::Yaw]),
    ] {
        let pair = pair(family, 0.5, 0.2, free);
        for subject in [SolidShape::Halves, SolidShape::Swept, SolidShape::Collision] {
            let Ok(shape) = shapes(&pair, subject, &PartitionSettings { slices: 3, strips: 1 }, &Exec::new())
            else {
                assert_eq!(subject, SolidShape::Swept);
                continue;
            };
            assert!(!shape.solids.is_empty());
            for solid in &shape.solids {
                bodies += 1;
                assert!(measure(solid) > 0.0, "{family:?} {subject:?}: {solid:?}");
                let mut edges: Vec<[usize; 2]> = solid
                    .faces
                    .iter()
                    .flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]))
                    .collect();
                edges.sort_unstable();
                if solid.faces.len() > 1 {
                    let twice = edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok());
                    assert!(twice, "{family:?} {subject:?}: {solid:?}");
                    // Euler.
                    let corners = solid.vertices.len() + solid.faces.len();
                    assert_eq!(corners, edges.len() / 2 + 2, "{family:?} {subject:?}: {solid:?}");
                } else {
                    assert_eq!(edges.len(), solid.vertices.len());
                }
                assert!(edges.windows(2).all(|pair| pair[0] != pair[1]));
                let behind = |v: &DVec3| planes(solid).iter().all(|(n, o)| n.dot(*v) <= o + 1e-9);
                assert!(solid.vertices.iter().all(behind), "{family:?} {subject:?}: {solid:?}");
            }
        }
    }
    assert!(bodies > 1000, "{bodies}");
}

#[test]
fn halves_have_the_volume_of_their_surfaces() {
    for (family, free) in
        [(Family::VFace, XY), (Family::XFace3d, XY), (Family::Pyramid, XY), (Family::Cone, XY)]
    {
        let pair = pair(family, 0.5, 0.2, free);
        let shape = made(&pair, SolidShape::Halves, 3);
        for (half, is_fixed) in [(&pair.fixed, true), (&pair.moving, false)] {
            let of_half = shape.solids.iter().filter(|solid| solid.fixed.is_some() == is_fixed);
            let (pieces, whole) = (
                of_half.map(measure).sum::<f64>(),
                half.surfaces.iter().map(crate::connector::Surface::volume).sum::<f64>(),
            );
            assert!((pieces - whole).abs() < 1e-9, "{family:?}: {pieces} {whole}");
        }
    }
    // Flat: notch and tip of H = ½ are both half of their box, as are both layers of both halves of the X.
    for (family, pieces, area) in [(Family::VFace, [2, 1], 0.5), (Family::XFace, [2, 2], 1.0)] {
        let shape = made(&pair(family, 0.5, 0.0, X_PITCH), SolidShape::Halves, 3);
        assert_eq!((shape.pieces, shape.dimension), (pieces, 2));
        assert!((shape.solids.iter().map(measure).sum::<f64>() - area).abs() < 1e-9, "{family:?}");
    }
}

#[test]
fn collision_solids_of_boxes_add_their_sides() {
    let brick = |size: DVec3, center: DVec3| {
        let corner = |k: u8| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) - 0.5;
        let corners: Vec<DVec3> = (0..8).map(|k| center + size * corner(k)).collect();
        Half::of(vec![convex_hull(&corners).unwrap()])
    };
    let (a, b) = (DVec3::new(1.0, 0.5, 0.25), DVec3::new(0.5, 0.75, 0.125));
    let connector = Connector::from_halves(
        brick(a, DVec3::new(0.0, 0.0, -0.125)),
        brick(b, DVec3::new(0.0, 0.0, 0.0625)),
    );
    let pair = Pair::new(&connector, &alignment(Family::Pyramid, 0.0, XY));
    let shape = made(&pair, SolidShape::Collision, 3);
    let size = a + b;
    assert_eq!(shape.solids.len(), 1);
    assert!((measure(&shape.solids[0]) - size.x * size.y * size.z).abs() < 1e-12);
    let sides = sides(&shape, 0.3, -0.2).unwrap();
    // From the top of the moving brick at the bottom of the fixed brick, to its bottom at the fixed brick's
    // top.
    assert!((sides[0] + size.z).abs() < 1e-12 && sides[1].abs() < 1e-12, "{sides:?}");
    // A single translation: the rectangle of x and z, placed on the y axis if y is the free error.
    for (free, side) in [(X, size.x), (&[Dof::Y], size.y)] {
        let shape =
            made(&Pair::new(&connector, &alignment(Family::Pyramid, 0.0, free)), SolidShape::Collision, 3);
        let corners = || shape.solids.iter().flat_map(|s| &s.vertices).copied();
        let extent = corners().reduce(DVec3::max).unwrap() - corners().reduce(DVec3::min).unwrap();
        assert_eq!(shape.dimension, 2);
        let [across, locked] = if free == X { [extent.x, extent.y] } else { [extent.y, extent.x] };
        assert!((across - side).abs() < 1e-12 && locked == 0.0 && (extent.z - size.z).abs() < 1e-12);
    }
}

/// Triangles with the sides (½, 0), (−½, H), (0, −H) and (1, 0), (−½, H), (−½, −H): their sum has the sides of both, those that run
/// alike joined, and 7/4 H of area. The mirror image overlaps it in the tip: 3 H in all.
#[test]
fn a_v_over_its_notch_collides_over_three_times_its_height() {
    for (height, cor) in [(0.5, 0.0), (1.0, 0.3), (2.0, -1.0)] {
        let shape = made(&pair(Family::VFace, height, cor, X), SolidShape::Collision, 3);
        assert_eq!((shape.pieces, shape.dimension, shape.axes), ([2, 1], 2, ["x", "y", "z"]));
        assert!(shape.solids.iter().all(|solid| (measure(solid) - 1.75 * height).abs() < 1e-9));
        assert!((union(&shape) - 3.0 * height).abs() < 1e-9, "{}", union(&shape));
    }
}

/// Every body of the composition is a cone over a slice with its apex on the next: a third of area times step.
#[test]
fn a_swept_tip_is_made_of_cones() {
    let height = 0.5;
    let shape = made(&pair(Family::VFace, height, -height / 6.0, X_PITCH), SolidShape::Swept, 15);
    assert_eq!((shape.axes, shape.dimension), (["x", "pitch", "z"], 3));
    // 15 slices of 12° about 0, and a half slice at either end: 16 intervals of 2 · 3 bodies.
    assert_eq!(shape.solids.len(), 16 * 6);
    for solid in &shape.solids {
        let (_, [low, high]) = solid.slice.unwrap();
        let cone = 0.5 * height * (high - low) / 3.0;
        assert!((measure(solid) - cone).abs() < 1e-9, "{} {cone}", measure(solid));
        // To the lattice of hulls.
        assert!(solid.vertices.iter().all(|v| [low, high].iter().any(|end| (v.y - end).abs() < 1e-11)));
    }
    // Turned about its centroid, whose distance to the corners of the base is the largest.
    let reach = (0.25 + (height / 3.0).powi(2)).sqrt();
    let farthest = shape.solids.iter().flat_map(|s| &s.vertices).map(|v| v.x.hypot(v.z)).fold(0.0, f64::max);
    assert!((farthest - reach).abs() < 1e-9, "{farthest} {reach}");
}

#[test]
fn the_upper_side_is_first_contact_and_the_lower_side_contact_from_below() {
    let cases = [
        (Family::VFace, 0.5, X),
        (Family::SFace, 1.0, X),
        (Family::XFace, 1.0, X),
        (Family::Pyramid, 0.5, XY),
        (Family::XFace3d, 0.6, XY),
        (Family::XFace3dLocking, 0.6, XY),
        (Family::Cone, 0.5, XY),
        (Family::Pyramid, 0.5, X),
    ];
    for (case, (family, ratio, free)) in cases.into_iter().enumerate() {
        let cor = 0.3;
        let upright = alignment(family, cor, free);
        let halves = connector(family, ratio, &upright);
        let pair = Pair::new(&halves, &upright);
        // Both halves turned about x by 180°, so that top and bottom swap.
        let over = |half: &Half| half.mapped(|p| DVec3::new(p.x, -p.y, -p.z));
        let turned = Connector::from_halves(over(&halves.fixed), over(&halves.moving));
        let below = Pair::new(&turned, &Alignment { center_of_rotation: -cor, ..upright.clone() });
        let shape = made(&pair, SolidShape::Collision, 3);
        let stream = Stream::new(case as u64);
        let mut met = 0;
        for k in 0..150 {
            let [x, y] = [0, 1].map(|j| 2.4 * stream.uniform(2 * k + j) - 1.2);
            let y = if free == XY { y } else { 0.0 };
            let height = |pair: &Pair, y: f64| {
                pair.height(&CorPose { lateral: DVec2::new(x, y), rotation: DMat3::IDENTITY })
            };
            let sides = sides(&shape, x, y);
            let expected = height(&below, -y).zip(height(&pair, y)).map(|(low, high)| [-low, high]);
            match (sides, expected) {
                (None, None) => {}
                (Some(sides), Some(expected)) => {
                    met += 1;
                    let near = (0..2).all(|k| (sides[k] - expected[k]).abs() < 1e-8);
                    assert!(near, "{family:?} at {x} {y}: {sides:?} {expected:?}");
                }
                other => panic!("{family:?} at {x} {y}: {other:?}"),
            }
        }
        assert!(met > 50, "{family:?}: {met}");
    }
}

/// On slices exactly. Between them a corner runs along the chord of its circle: never above by more than the
/// sagitta of the step plus the bulge of the edges.
#[test]
fn with_a_rotation_the_upper_side_is_first_contact_on_every_slice() {
    let free = X_PITCH;
    for (case, (family, cor)) in
        [(Family::VFace, 0.0), (Family::XFace, 0.5), (Family::SFace, -0.5)].into_iter().enumerate()
    {
        let pair = pair(family, 1.0, cor, free);
        let shape = made(&pair, SolidShape::Collision, 15);
        let stream = Stream::new(case as u64);
        let mut met = 0;
        for k in 0..80 {
            let x = 2.0 * stream.uniform(2 * k) - 1.0;
            // Multiples of 12°.
            let angle = ((15.0 * stream.uniform(2 * k + 1)).floor() - 7.0) * std::f64::consts::PI / 15.0;
            let rotation = PoseError { pitch: angle, ..PoseError::default() }.rotation();
            let expected = pair.height(&CorPose { lateral: DVec2::new(x, 0.0), rotation });
            // Bodies on both sides of the slice end there, to the rounding of an angle.
            let high = sides(&shape, x, angle - 1e-12).into_iter().chain(sides(&shape, x, angle + 1e-12));
            let high = high.map(|sides| sides[1]).reduce(f64::max);
            let (Some(high), Some(expected)) = (high, expected) else {
                assert_eq!(high.is_some(), expected.is_some(), "{family:?} at {x} {angle}");
                continue;
            };
            met += 1;
            assert!((high - expected).abs() < 1e-7, "{family:?} at {x} {angle}: {high} {expected}");
        }
        assert!(met > 20, "{family:?}: {met}");
    }
}

#[test]
fn unsuitable_errors_and_settings_are_refused() {
    let ask = |free: &[Dof], subject| {
        let pair = pair(Family::Pyramid, 0.5, 0.0, free);
        shapes(&pair, subject, &PartitionSettings { slices: 3, strips: 1 }, &Exec::new()).unwrap_err()
    };
    assert_eq!(ask(XY, SolidShape::Swept), SolidError::NothingTurns);
    assert_eq!(ask(&[], SolidShape::Collision), SolidError::NothingMoves);
    let of = |error| match error {
        SolidError::Dimensions { dimensions, .. } => dimensions,
        other => panic!("{other:?}"),
    };
    assert_eq!(of(ask(&[Dof::X, Dof::Yaw], SolidShape::Swept)), 4);
    assert_eq!(of(ask(&[Dof::X, Dof::Y, Dof::Yaw], SolidShape::Collision)), 4);
    assert_eq!(of(ask(&[Dof::Pitch, Dof::Yaw], SolidShape::Collision)), 4);
    let planar = pair(Family::VFace, 1.0, 0.0, X_PITCH);
    let many = PartitionSettings { slices: 1000, strips: 200 };
    let small = Exec::new().with_memory_budget(1 << 20);
    let refused = shapes(&planar, SolidShape::Collision, &many, &small).unwrap_err();
    assert!(matches!(refused, SolidError::Partition(PartitionError::OutOfBudget(_))), "{refused:?}");
    let none = PartitionSettings { slices: 0, strips: 1 };
    let refused = shapes(&planar, SolidShape::Halves, &none, &Exec::new()).unwrap_err();
    assert!(matches!(refused, SolidError::Partition(PartitionError::Setting { .. })), "{refused:?}");
}
