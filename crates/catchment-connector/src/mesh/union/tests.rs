//! Unions with known volumes, facets and edges; the pieces of a cut solid unite to that solid.

use super::*;
use crate::convex_hull;
use glam::DVec3;
use proptest::prelude::*;

fn block(low: [f64; 3], high: [f64; 3]) -> Surface {
    let corner = |k: u8| DVec3::from_array([0, 1, 2].map(|i| if k >> i & 1 == 0 { low[i] } else { high[i] }));
    convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
}

fn union(surfaces: &[Surface]) -> Vec<Surface> {
    united(surfaces, EXACT, &Exec::new()).unwrap_or_else(|error| panic!("{error}"))
}

/// The single surface of a union.
fn one(surfaces: &[Surface]) -> Surface {
    let mut union = union(surfaces);
    assert_eq!(union.len(), 1);
    union.remove(0)
}

/// Corners, facets, convex edges.
fn counts(surface: &Surface) -> [usize; 3] {
    [surface.vertices.len(), surface.facets.len(), surface.edges.len()]
}

#[test]
fn boxes_that_share_a_face_are_one_box() {
    let whole = one(&[block([0.0; 3], [0.5, 1.0, 1.0]), block([0.5, 0.0, 0.0], [1.0, 1.0, 1.0])]);
    assert_eq!(counts(&whole), [8, 6, 12]);
    assert!(whole.convex && (whole.volume() - 1.0).abs() < 1e-15);
}

#[test]
fn a_box_on_a_part_of_a_face_leaves_a_step() {
    let step = one(&[block([0.0; 3], [1.0; 3]), block([1.0, 0.0, 0.0], [1.5, 1.0, 0.4])]);
    // An L, extruded: two of its facets are cut in two.
    assert_eq!((step.vertices.len(), step.edges.len()), (12, 17));
    assert!((step.volume() - 1.2).abs() < 1e-15);
    // In the middle of the face: a boss, whose foot is a hole in the face.
    let boss = one(&[block([0.0; 3], [1.0; 3]), block([1.0, 0.3, 0.3], [1.5, 0.7, 0.7])]);
    assert_eq!((boss.vertices.len(), boss.edges.len()), (16, 12 + 8));
    assert!((boss.volume() - 1.08).abs() < 1e-15);
}

#[test]
fn solids_that_overlap_or_lie_in_each_other_are_one() {
    let cross = one(&[block([0.0; 3], [1.0; 3]), block([0.25, 0.5, 0.5], [0.75, 1.5, 2.0])]);
    assert!((cross.volume() - 1.625).abs() < 1e-14);
    let inner = one(&[block([0.25; 3], [0.5; 3]), block([0.0; 3], [1.0; 3])]);
    assert_eq!(counts(&inner), [8, 6, 12]);
    let twice = one(&[block([0.0; 3], [1.0; 3]), block([0.0; 3], [1.0; 3])]);
    assert_eq!(counts(&twice), [8, 6, 12]);
}

#[test]
fn solids_apart_or_that_touch_in_an_edge_stay_as_they_are() {
    let given = [
        block([0.0; 3], [1.0; 3]),
        block([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]),
        block([3.0, 0.0, 0.0], [4.0, 1.0, 1.0]),
    ];
    assert_eq!(union(&given), given);
}

#[test]
fn a_hole_may_be_closed_all_around_and_a_cavity_stays() {
    let ring = |z: [f64; 2]| {
        vec![
            block([0.0, 0.0, z[0]], [3.0, 1.0, z[1]]),
            block([0.0, 2.0, z[0]], [3.0, 3.0, z[1]]),
            block([0.0, 1.0, z[0]], [1.0, 2.0, z[1]]),
            block([2.0, 1.0, z[0]], [3.0, 2.0, z[1]]),
        ]
    };
    let frame = one(&ring([0.0, 1.0]));
    assert_eq!((frame.vertices.len(), frame.edges.len()), (16, 12 + 8));
    assert!((frame.volume() - 8.0).abs() < 1e-12);
    let mut closed = ring([0.0, 1.0]);
    closed.extend([block([0.0, 0.0, -1.0], [3.0, 3.0, 0.0]), block([0.0, 0.0, 1.0], [3.0, 3.0, 2.0])]);
    let hollow = one(&closed);
    assert_eq!(counts(&hollow), [16, 12, 12]);
    assert!((hollow.volume() - 26.0).abs() < 1e-12);
}

/// Corners rounded as in a hand-written file.
fn rounded(surface: &Surface, digits: f64) -> Option<Surface> {
    let round = |p: &DVec3| (*p * digits).round() / digits;
    convex_hull(&surface.vertices.iter().map(round).collect::<Vec<_>>()).ok()
}

/// The part of a convex solid below a plane.
fn below(solid: &Surface, normal: DVec3, level: f64) -> Option<Surface> {
    let height = |p: DVec3| normal.dot(p) - level;
    let mut corners: Vec<DVec3> = solid.vertices.iter().copied().filter(|p| height(*p) <= 0.0).collect();
    for facet in &solid.facets {
        for (k, a) in facet.corners.iter().enumerate() {
            let b = facet.corners[(k + 1) % facet.corners.len()];
            let [p, q] = [*a, b].map(|c| solid.vertices[c as usize]);
            if *a < b && height(p) * height(q) < 0.0 {
                corners.push(p.lerp(q, height(p) / (height(p) - height(q))));
            }
        }
    }
    corners.dedup();
    convex_hull(&corners).ok()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A block cut by planes, its parts written with ten decimals, is the block again: nothing of the cuts is left.
    #[test]
    fn parts_of_a_block_are_the_block(
        cuts in prop::collection::vec((prop::array::uniform3(-1.0..1.0f64), -0.3..0.3f64), 1..5),
        digits in prop::sample::select(vec![1e9, 1e10, 1e12]),
    ) {
        let mut parts = vec![block([-0.5; 3], [0.5; 3])];
        for (normal, level) in cuts {
            let Some(normal) = DVec3::from_array(normal).try_normalize() else { return Ok(()) };
            parts = parts
                .iter()
                .flat_map(|part| [below(part, normal, level), below(part, -normal, -level)])
                .flatten()
                .collect();
        }
        let volume: f64 = parts.iter().map(Surface::volume).sum();
        prop_assume!((volume - 1.0).abs() < 1e-9);
        let parts: Option<Vec<Surface>> = parts.iter().map(|part| rounded(part, digits)).collect();
        let Some(parts) = parts else { return Ok(()) };
        let whole = one(&parts);
        prop_assert!(whole.convex && (whole.volume() - 1.0).abs() < 1e-8, "{}", whole.volume());
        prop_assert_eq!(whole.edges.len(), 12);
        prop_assert_eq!(whole.facets.len(), 6);
    }

    /// Boxes on a coarse lattice, which touch in every way, fill as many cells as are in any of them.
    #[test]
    fn boxes_on_a_lattice_fill_their_cells(
        boxes in prop::collection::vec((prop::array::uniform3(0u8..4), prop::array::uniform3(1u8..3)), 1..8)
    ) {
        let third = |k: u8| f64::from(k) / 3.0;
        let solids: Vec<Surface> = boxes
            .iter()
            .map(|(low, size)| block(low.map(third), [0, 1, 2].map(|k| third(low[k] + size[k]))))
            .collect();
        let is_filled = |cell: [u8; 3]| {
            boxes.iter().any(|(low, size)| (0..3).all(|k| (low[k]..low[k] + size[k]).contains(&cell[k])))
        };
        let cells = (0u16..216).filter(|n| is_filled([n % 6, n / 6 % 6, n / 36].map(|k| k as u8))).count();
        let volume: f64 = union(&solids).iter().map(Surface::volume).sum();
        prop_assert!((volume - cells as f64 / 27.0).abs() < 1e-12, "{volume} {cells}");
    }

    /// Convex solids anywhere: their union has at most their total volume, at least that of the largest, and
    /// the volume found by sampling.
    #[test]
    fn solids_anywhere_have_a_union(
        clouds in prop::collection::vec(
            (prop::array::uniform3(-0.5..0.5f64), prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..9)), 2..7)
    ) {
        let hull = |(middle, cloud): &([f64; 3], Vec<[f64; 3]>)| {
            let on = |p: &[f64; 3]| DVec3::from_array(*p).try_normalize().map(|p| DVec3::from_array(*middle) + 0.5 * p);
            convex_hull(&cloud.iter().map(on).collect::<Option<Vec<_>>>()?).ok()
        };
        let solids: Option<Vec<Surface>> = clouds.iter().map(hull).collect();
        let Some(solids) = solids else { return Ok(()) };
        let volumes = || solids.iter().map(Surface::volume);
        let volume: f64 = union(&solids).iter().map(Surface::volume).sum();
        prop_assert!(volume <= volumes().sum::<f64>() + 1e-9 && volume >= volumes().fold(0.0, f64::max) - 1e-9);
        let has = |p: DVec3| solids.iter().any(|s| s.facets.iter().all(|f| f.normal.dot(p - s.vertices[f.corners[0] as usize]) < 0.0));
        let count = 20_000;
        let spread = |k: usize, step: f64| 2.0 * ((k as f64 * step).fract() - 0.5);
        let hits = (0..count).filter(|k| has(DVec3::new(spread(*k, 0.819_172_5), spread(*k, 0.671_043_6), spread(*k, 0.549_700_5)))).count();
        // 3 σ of random points over a box of 8 is 0.08; these are spread evenly.
        prop_assert!((volume - 8.0 * hits as f64 / f64::from(count as u32)).abs() < 0.06, "{} {}", volume, hits);
    }
}
