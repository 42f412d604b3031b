//! A repaired mesh bounds the same solid as the sound mesh; a sound mesh is not changed by a bit.

use super::*;
use crate::convex_hull;
use proptest::prelude::*;

type Soup = Vec<[DVec3; 3]>;

fn soup(surface: &Surface) -> Soup {
    surface.triangles().into_iter().map(|t| t.map(|k| surface.vertices[k as usize])).collect()
}

/// A box from a corner to the other.
fn block(lo: [f64; 3], hi: [f64; 3]) -> Soup {
    let pick = |i: u8| {
        let at = |k: usize| if i >> k & 1 == 0 { lo[k] } else { hi[k] };
        DVec3::new(at(0), at(1), at(2))
    };
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .iter()
        .flat_map(|q: &[u8; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
        .map(|t| t.map(pick))
        .collect()
}

/// Result for a single body.
fn treated(soup: &Soup, treatment: MeshPreparation) -> Result<Solid, Vec<MeshProblem>> {
    let place = |triangle| TriangleLocation { triangle, start: FileOffset::Memory };
    let list = soup.iter().enumerate().map(|(k, corners)| Triangle { corners: *corners, place: place(k) });
    solid(list.collect(), 1.0, treatment)
}

fn repaired(soup: &Soup) -> Solid {
    treated(soup, MeshPreparation::DEFAULT).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn refused(soup: &Soup) -> Vec<MeshProblem> {
    treated(soup, MeshPreparation::DEFAULT).map(|ready| ready.repairs).unwrap_err()
}

#[test]
fn a_sound_mesh_stays_unchanged() {
    let cube = block([0.0; 3], [1.0; 3]);
    let (kept, ready) = (treated(&cube, MeshPreparation::AS_IT_IS).unwrap(), repaired(&cube));
    assert_eq!(kept.surface, ready.surface);
    assert!(ready.repairs.is_none() && kept.repairs.is_none());
    assert_eq!(from_triangles(&cube).unwrap().surfaces, [ready.surface]);
}

#[test]
fn a_triangle_without_area_goes_and_its_neighbour_is_divided() {
    let mut cube = block([0.0; 3], [1.0; 3]);
    // The first triangle of the top ends at the midpoint of its edge; a triangle without area fills the gap.
    let [a, b, c] = cube[2];
    let middle = a.midpoint(b);
    cube[2] = [a, middle, c];
    cube.push([middle, b, c]);
    cube.push([b, middle, a]);
    let problems = treated(&cube, MeshPreparation::AS_IT_IS).map(|ready| ready.repairs).unwrap_err();
    assert!(matches!(problems[0], MeshProblem::ZeroArea { .. }), "{problems:?}");
    let ready = repaired(&cube);
    assert!(ready.repairs.without_area == 1 && ready.repairs.deviation < 1e-15, "{:?}", ready.repairs);
    assert!((ready.surface.volume() - 1.0).abs() < 1e-15);
    assert_eq!((ready.surface.facets.len(), ready.surface.edges.len()), (6, 12));
}

#[test]
fn solids_that_touch_along_an_edge_are_parted() {
    let touching: Soup = [block([0.0; 3], [1.0; 3]), block([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])].concat();
    let ready = repaired(&touching);
    assert!(ready.repairs.parted == 1 && ready.repairs.deviation < 1e-15, "{:?}", ready.repairs);
    assert!((ready.surface.volume() - 2.0).abs() < 1e-15);
    // Every edge of both is convex.
    assert_eq!((ready.surface.vertices.len(), ready.surface.edges.len()), (16, 24));
}

/// A ring of blocks that touches itself along a single edge: both ends of the edge belong to the same fan of
/// triangles.
#[test]
fn a_solid_that_touches_itself_is_parted_in_the_middle() {
    // Around a hole, from (1, 1) to (1, 1): the blocks at (0, 0) and (1, 1) meet along the edge x = y = 1 only.
    let blocks = [
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
        ([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]),
        ([0.0, 0.0, -1.0], [1.0, 1.0, 0.0]),
        ([1.0, 0.0, -1.0], [2.0, 1.0, 0.0]),
        ([1.0, 1.0, -1.0], [2.0, 2.0, 0.0]),
    ];
    let ready = repaired(&blocks.map(|(lo, hi)| block(lo, hi)).concat());
    assert!(ready.repairs.doubled > 0 && ready.repairs.parted == 1, "{:?}", ready.repairs);
    assert!((ready.surface.volume() - 5.0).abs() < 1e-12, "{}", ready.surface.volume());
}

/// Blocks of size 1 at these places of a lattice.
fn cells(at: impl IntoIterator<Item = [f64; 3]>) -> Soup {
    at.into_iter().flat_map(|lo| block(lo, lo.map(|c| c + 1.0))).collect()
}

#[test]
fn a_lid_across_a_hole_is_removed() {
    let ring = (0..9).filter(|k| *k != 4).map(|k| [f64::from(k % 3), f64::from(k / 3), 0.0]);
    let mut frame = cells(ring);
    let [a, b, c, d] = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    // Wound against each other: a lid has no outside.
    frame.extend([[a, b, c], [a, d, c]]);
    let ready = repaired(&frame);
    assert_eq!((ready.repairs.lids, ready.repairs.deviation), (2, 0.0), "{:?}", ready.repairs);
    assert!((ready.surface.volume() - 8.0).abs() < 1e-12, "{}", ready.surface.volume());
}

#[test]
fn an_ambiguous_lid_on_a_blind_hole_is_refused() {
    let cup = (0..18).filter(|k| *k != 13).map(|k| [k % 3, k / 3 % 3, k / 9].map(f64::from));
    let mut cup = cells(cup);
    let [a, b, c, d] = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 2.0));
    cup.extend([[a, b, c], [a, c, d]]);
    let problems = refused(&cup);
    assert!(matches!(problems[0], MeshProblem::NonManifold { count: 3, .. }), "{problems:?}");
}

#[test]
fn windings_are_made_consistent() {
    let mut cube = block([0.0; 3], [1.0; 3]);
    for k in [1, 7, 8] {
        cube[k].swap(0, 1);
    }
    let ready = repaired(&cube);
    assert!(ready.repairs.turned == 3 && (ready.surface.volume() - 1.0).abs() < 1e-15);
    // A cube that is inside out as a whole, and a cavity that stays a cavity.
    let hollow =
        [block([0.0; 3], [1.0; 3]), block([0.2; 3], [0.6; 3]).iter().map(|t| [t[0], t[2], t[1]]).collect()];
    let sound = repaired(&hollow.concat());
    assert!(sound.repairs.is_none() && (sound.surface.volume() - 0.936).abs() < 1e-15);
    let turned: Soup = block([0.0; 3], [1.0; 3]).iter().map(|t| [t[0], t[2], t[1]]).collect();
    assert_eq!(repaired(&turned).repairs.turned, 12);
    // Beside a sound solid, an inside-out solid subtracts volume; the check distinguishes it from a cavity.
    let beside: Soup = block([1.5, 0.0, 0.0], [2.0, 0.5, 0.5]).iter().map(|t| [t[0], t[2], t[1]]).collect();
    let both = [block([0.0; 3], [1.0; 3]), beside].concat();
    let problems = treated(&both, MeshPreparation::AS_IT_IS).map(|ready| ready.repairs).unwrap_err();
    assert!(matches!(problems[..], [MeshProblem::InsideOut { .. }]), "{problems:?}");
    assert!((repaired(&both).surface.volume() - 1.125).abs() < 1e-15);
}

#[test]
fn shells_that_cross_are_united() {
    let cross = [block([0.0; 3], [1.0; 3]), block([0.25, 0.5, 0.5], [0.75, 1.5, 2.0])].concat();
    let ready = repaired(&cross);
    assert!(ready.repairs.united > 0 && ready.repairs.deviation < 1e-12, "{:?}", ready.repairs);
    // 1 + 0.5 · 1 · 1.5 − 0.5 · 0.5 · 0.5
    assert!((ready.surface.volume() - 1.625).abs() < 1e-12, "{}", ready.surface.volume());
    assert!(treated(&cross, MeshPreparation::AS_IT_IS).is_err());
}

#[test]
fn a_hole_is_not_closed() {
    let mut cube = block([0.0; 3], [1.0; 3]);
    cube.pop();
    assert!(refused(&cube).iter().all(|p| matches!(p, MeshProblem::Open { .. })));
    // Nor is a mesh repaired that has a hole and crosses itself.
    let cross = [cube, block([0.3, 0.4, 0.5], [1.3, 1.4, 1.5])].concat();
    assert!(matches!(refused(&cross)[0], MeshProblem::Open { .. }));
}

/// A half sphere of so many rings, closed by a disc.
fn dome(rings: usize) -> Soup {
    use std::f64::consts::{FRAC_PI_2, TAU};
    let sectors = 4 * rings;
    let at = |i: usize, k: usize| {
        let (up, around) = (FRAC_PI_2 * i as f64 / rings as f64, TAU * (k % sectors) as f64 / sectors as f64);
        DVec3::new(0.5 * up.sin() * around.cos(), 0.5 * up.sin() * around.sin(), 0.5 * up.cos())
    };
    let mut soup = Vec::new();
    for k in 0..sectors {
        soup.push([at(0, 0), at(1, k), at(1, k + 1)]);
        for i in 1..rings {
            soup.extend([
                [at(i, k), at(i + 1, k), at(i + 1, k + 1)],
                [at(i, k), at(i + 1, k + 1), at(i, k + 1)],
            ]);
        }
        soup.push([DVec3::ZERO, at(rings, k + 1), at(rings, k)]);
    }
    soup
}

#[test]
fn a_simplified_surface_keeps_to_its_tolerance() {
    let dome = dome(40);
    for tolerance in [1e-4, 1e-3, 1e-2] {
        let ready = treated(&dome, MeshPreparation { simplify: Some(tolerance), ..MeshPreparation::DEFAULT })
            .unwrap_or_else(|p| panic!("{p:?}"));
        let [before, after] = ready.repairs.simplified.unwrap();
        assert!(before == dome.len() && after == ready.triangles && after < before, "{after}");
        let Repairs { deviation, .. } = ready.repairs;
        assert!(deviation > 0.0 && deviation <= tolerance, "{deviation}");
        // Every corner is near the sphere, the disc or their edge, and the volume changes by less than area times tolerance.
        let whole = std::f64::consts::PI / 12.0;
        assert!(
            (ready.surface.volume() - whole).abs() < 2.4 * tolerance + 2e-4,
            "{}",
            ready.surface.volume()
        );
    }
    // Who lets the surface move farther gets no more triangles.
    let left = |tolerance: f64| {
        treated(&dome, MeshPreparation { simplify: Some(tolerance), ..MeshPreparation::DEFAULT })
            .unwrap()
            .triangles
    };
    let left: Vec<usize> = (0..8).map(|k| left(2e-4 * 2f64.powi(k))).collect();
    assert!(left.is_sorted_by(|a, b| a >= b) && left[0] > 4 * left[7], "{left:?}");
    let none = treated(
        &block([0.0; 3], [1.0; 3]),
        MeshPreparation { simplify: Some(1e-3), ..MeshPreparation::DEFAULT },
    )
    .unwrap();
    assert!(none.repairs.simplified == Some([12, 12]) && none.repairs.deviation < 1e-15);
}

proptest! {
    /// A convex solid, spoilt in every way that does not change it, is repaired to the original.
    #[test]
    fn a_spoilt_solid_is_repaired_to_the_original(
        points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 6..16),
        flat in prop::collection::vec((0usize..1000, 0usize..3, 0.2..0.8f64), 0..4),
        turned in prop::collection::vec(0usize..1000, 0..4),
        doubled in prop::collection::vec(0usize..1000, 0..3),
    ) {
        let sphere: Vec<DVec3> = points.into_iter().filter_map(|p| DVec3::from_array(p).try_normalize()).collect();
        prop_assume!((0..sphere.len()).all(|i| (0..i).all(|j| sphere[i].distance(sphere[j]) > 0.2)));
        let Ok(hull) = convex_hull(&sphere) else { return Ok(()) };
        let mut spoilt = soup(&hull);
        let Ok(sound) = treated(&spoilt, MeshPreparation::AS_IT_IS) else { return Ok(()) };
        for (k, side, part) in flat {
            // Divide a side for one neighbour only, and fill the gap with a triangle without area.
            let count = spoilt.len();
            let [a, b, c] = [0, 1, 2].map(|i| spoilt[k % count][(side + i) % 3]);
            let on = a.lerp(b, part);
            prop_assume!(on.distance(a) > 1e-3 && on.distance(b) > 1e-3 && (b - a).cross(c - a).length() > 1e-3);
            spoilt[k % count] = [a, on, c];
            spoilt.extend([[on, b, c], [b, on, a]]);
        }
        for k in turned {
            let count = spoilt.len();
            spoilt[k % count].swap(0, 2);
        }
        // Copies of the same winding: two of opposite winding form a sheet without thickness, which the
        // repair removes.
        let count = spoilt.len();
        for k in doubled {
            spoilt.push(spoilt[k % count]);
        }
        let ready = match treated(&spoilt, MeshPreparation::DEFAULT) {
            Ok(ready) => ready,
            Err(problems) => return Err(TestCaseError::fail(format!("{problems:?}"))),
        };
        // Points on an edge are rounded, and the remainder of a triangle without area has slender neighbours.
        prop_assert!((ready.surface.volume() - sound.surface.volume()).abs() < 1e-12);
        prop_assert!(ready.repairs.deviation < 1e-9, "{}", ready.repairs.deviation);
        for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::new(1.0, -2.0, 0.5)] {
            let height = |s: &Surface| s.vertices.iter().map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(height(&ready.surface), height(&sound.surface));
        }
    }

    /// Two boxes that overlap, or not, have the volume of their union.
    #[test]
    fn a_union_counts_the_shared_volume_once(
        shift in prop::array::uniform3(0.05..1.4f64), size in prop::array::uniform3(0.3..1.2f64)
    ) {
        let (lo, hi) = (DVec3::from_array(shift), DVec3::from_array(shift) + DVec3::from_array(size));
        prop_assume!([lo, hi].iter().all(|p| (*p - DVec3::ONE).abs().min_element() > 1e-3));
        let both = [block([0.0; 3], [1.0; 3]), block(shift, hi.to_array())].concat();
        let shared = (hi.min(DVec3::ONE) - lo).max(DVec3::ZERO);
        let expected = 1.0 + size.iter().product::<f64>() - shared.x * shared.y * shared.z;
        // A box wholly inside of the other crosses nothing and stays as it is: its walls cannot be touched.
        prop_assume!(hi.max_element() > 1.0);
        let ready = repaired(&both);
        prop_assert!((ready.surface.volume() - expected).abs() < 1e-9, "{} {}", ready.surface.volume(), expected);
    }
}

proptest! {
    /// Tetrahedra with corners on a small lattice, which touch in every way: an accepted result has at least
    /// the volume of the largest and at most that of all.
    #[test]
    fn touching_tetrahedra_are_united_or_refused(
        corners in prop::collection::vec(prop::array::uniform4(prop::array::uniform3(0u8..4)), 2..5)
    ) {
        let mut soup = Soup::new();
        let (mut largest, mut all) = (0.0, 0.0);
        for four in corners {
            let [a, b, c, d] = four.map(|p| DVec3::from_array(p.map(f64::from)) / 3.0);
            let six = (b - a).cross(c - a).dot(d - a);
            if six.abs() < 1e-3 {
                continue;
            }
            let (b, c) = if six > 0.0 { (c, b) } else { (b, c) };
            soup.extend([[a, b, c], [a, c, d], [c, b, d], [b, a, d]]);
            largest = f64::max(largest, six.abs() / 6.0);
            all += six.abs() / 6.0;
        }
        prop_assume!(!soup.is_empty());
        if let Ok(ready) = treated(&soup, MeshPreparation::DEFAULT) {
            let volume = ready.surface.volume();
            prop_assert!(volume > largest - 1e-9 && volume < all + 1e-9, "{} of {} to {}", volume, largest, all);
        }
    }
}

/// Found by the property above: the library that unites shells finds no ray that runs along nothing, and panics.
#[test]
fn a_panicking_union_is_refused() {
    let corners =
        [[[0, 1, 0], [2, 0, 0], [1, 2, 0], [0, 0, 1]], [[1, 2, 1], [0, 0, 1], [0, 1, 1], [1, 1, 0]]];
    let mut soup = Soup::new();
    for four in corners {
        let [a, b, c, d] = four.map(|p: [u8; 3]| DVec3::from_array(p.map(f64::from)) / 3.0);
        let (b, c) = if (b - a).cross(c - a).dot(d - a) > 0.0 { (c, b) } else { (b, c) };
        soup.extend([[a, b, c], [a, c, d], [c, b, d], [b, a, d]]);
    }
    assert!(treated(&soup, MeshPreparation::DEFAULT).is_err());
}

/// Facets, edges and corners of the surfaces of a half.
fn counts(surface: &Surface) -> [usize; 3] {
    [surface.facets.len(), surface.edges.len(), surface.vertices.len()]
}

#[test]
fn faces_are_polygons_again_however_they_were_cut() {
    // A cube with one divided edge; its top is a fan from the dividing point.
    let mut cube = block([0.0; 3], [1.0; 3]);
    cube.retain(|t| !t.iter().all(|p| p.z == 1.0));
    let ring =
        [[0.3, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
    cube.extend((1..4).map(|k| [ring[0], ring[k], ring[k + 1]]));
    let ready = treated(&cube, MeshPreparation::AS_IT_IS).unwrap();
    assert_eq!(counts(&ready.surface), [6, 12, 8]);
    assert_eq!(ready.triangles, 14);
    assert!((ready.surface.volume() - 1.0).abs() < 1e-15);
}

#[test]
fn a_plate_with_a_hole_keeps_convex_facets() {
    // A square ring: its top and bottom are not convex.
    let outer = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let at = |k: usize, inner: bool, z: f64| {
        let [x, y] = outer[k % 4];
        let size = if inner { 0.4 } else { 0.5 };
        DVec3::new(size * x, size * y, z)
    };
    let mut soup = Soup::new();
    for k in 0..4 {
        let quad = |[a, b, c, d]: [DVec3; 4]| [[a, b, c], [a, c, d]];
        soup.extend(quad([
            at(k, false, 0.0),
            at(k + 1, false, 0.0),
            at(k + 1, false, 1.0),
            at(k, false, 1.0),
        ]));
        soup.extend(quad([at(k + 1, true, 0.0), at(k, true, 0.0), at(k, true, 1.0), at(k + 1, true, 1.0)]));
        soup.extend(quad([at(k, false, 1.0), at(k + 1, false, 1.0), at(k + 1, true, 1.0), at(k, true, 1.0)]));
        soup.extend(quad([at(k + 1, false, 0.0), at(k, false, 0.0), at(k, true, 0.0), at(k + 1, true, 0.0)]));
    }
    let surface = treated(&soup, MeshPreparation::AS_IT_IS).unwrap().surface;
    // Four pieces on either side, as there must be; outside, all edges but the four of the hole's walls are convex.
    assert_eq!(counts(&surface), [16, 20, 16]);
    assert!((surface.volume() - 0.36).abs() < 1e-15);
    for facet in &surface.facets {
        let at = |k: usize| surface.vertices[facet.corners[k % facet.corners.len()] as usize];
        for k in 0..facet.corners.len() {
            assert!(facet.normal.dot((at(k + 1) - at(k)).cross(at(k + 2) - at(k + 1))) > 0.0);
        }
    }
}

#[test]
fn a_slightly_bent_face_stays_bent() {
    // A roof so flat that single precision could not hold it: two facets, however flat.
    for (rise, facets) in [(1e-9, 2), (1e-14, 1)] {
        let mut cube = block([0.0; 3], [1.0; 3]);
        for corner in cube.iter_mut().flatten().filter(|p| p.x == 1.0 && p.z == 1.0 && p.y == 1.0) {
            corner.z += rise;
        }
        let surface = treated(&cube, MeshPreparation::AS_IT_IS).unwrap().surface;
        assert_eq!(surface.facets.iter().filter(|f| f.normal.z > 0.5).count(), facets, "{rise}");
    }
}
