//! Halves written as convex pieces equal the union of the pieces: the same heights, the same outcomes.
//!
//! ```text
//!   ┌─╲      ╱─┐      rings of wedges on a floor: they abut, upper ones over the seams of lower ones, and planes
//!   │  ╲─┐┌─╱  │      cut some of them once more; corners are written with ten decimals
//!   │   ╲││╱   │
//!   ├────┴┴────┤
//!   └──────────┘
//! ```

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::{Domain, Outcome};
use catchment::connector::{Connector, Half, HalfSource, Surface, convex_hull};
use catchment::contact::{Pair, brute};
use catchment::design::{self, Alignment};
use catchment::exec::Exec;
use catchment::method::descent::{self, DescentSettings};
use catchment::pose::{CorPose, DofSet, Mount, PoseError, rotation};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::path::Path;

fn read(name: &str) -> (Connector, Alignment) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pieces");
    let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    let design = design::read(&text, &folder).unwrap().design;
    (Connector::build(&design).unwrap(), design.alignment)
}

fn outcome(pair: &Pair, [x, y, roll, pitch, yaw]: [f64; 5]) -> Outcome {
    descent::outcome(pair, &PoseError { x, y, roll, pitch, yaw }, &DescentSettings::default()).outcome
}

/// Outcomes of poses of these designs as closed meshes that another program made of the same pieces. As pieces, the first once came to rest on a seam
/// of the guide with a downhill slope of 0.6, and the others hung on seams of the key's slot.
#[test]
fn motions_do_not_rest_on_seams() {
    let (connector, alignment) = read("dovetail");
    let dovetail = Pair::new(&connector, &alignment);
    assert_eq!(
        outcome(&dovetail, [-0.118_209, -0.227_331, 0.301_862, 0.252_82, 0.402_937]),
        Outcome::Aligned
    );
    assert_eq!(
        outcome(&dovetail, [0.013_946, -0.221_734, -0.082_329, 0.329_434, -0.432_228]),
        Outcome::Jammed
    );
    let (connector, alignment) = read("keyway");
    let keyway = Pair::new(&connector, &alignment);
    for error in [
        [0.094_277, 0.016_784, 0.116_688, 0.304_416, 0.154_249],
        [0.176_578, 0.082_287, 0.120_019, 0.097_066, 0.181_131],
        [-0.117_593, 0.140_808, -0.072_145, -0.236_315, 0.227_788],
        [-0.006_377, 0.155_112, -0.075_444, -0.167_319, 0.099_525],
        [-0.001, 0.004, 0.012_217, -0.012_217, -0.010_123],
    ] {
        assert_eq!(outcome(&keyway, error), Outcome::Aligned, "{error:?}");
    }
}

/// Corners, facets (coplanar ones counted once) and convex edges of the unions, as computed by two other libraries. The walls between pieces are
/// gone, and the pieces are kept.
#[test]
fn designs_are_one_surface() {
    for (name, pieces, corners, edges) in [
        ("keyway", [52, 3], [42, 32], [38, 34]),
        ("dovetail", [14, 3], [20, 28], [20, 36]),
        ("petals", [15, 15], [84, 84], [102, 102]),
        ("dish", [9, 2], [32, 24], [32, 40]),
        ("cross", [11, 3], [32, 48], [28, 48]),
    ] {
        let (connector, _) = read(name);
        for (k, half) in [&connector.fixed, &connector.moving].into_iter().enumerate() {
            assert_eq!((half.surfaces.len(), half.pieces.len()), (1, pieces[k]), "{name}");
            let surface = &half.surfaces[0];
            assert_eq!((surface.vertices.len(), surface.edges.len()), (corners[k], edges[k]), "{name}");
        }
    }
}

/// The union of their pieces itself, and as loose triangles in memory, which are welded and merged again.
#[test]
fn triangles_keep_the_outcomes_of_designs() {
    const POSES: usize = 40;
    for name in ["keyway", "dovetail", "dish", "cross"] {
        let (connector, alignment) = read(name);
        let triangles = |half: &Half| {
            let of = |surface: &Surface| -> Vec<[DVec3; 3]> {
                surface.triangles().iter().map(|t| t.map(|k| surface.vertices[k as usize])).collect()
            };
            HalfSource::Triangles(half.surfaces.iter().flat_map(of).collect())
        };
        let drawn = connector.moving.mapped(|p| alignment.mount.apply(p));
        let again =
            Connector::from_sources(&triangles(&connector.fixed), &triangles(&drawn), 0.0, alignment.mount)
                .unwrap();
        let changed = changed(&connector, &again, &alignment, POSES);
        assert!(changed <= 1, "{name}: {changed} of {POSES}");
    }
}

/// Number of sampled poses whose outcomes differ.
fn changed(one: &Connector, other: &Connector, alignment: &Alignment, poses: usize) -> usize {
    let outcomes = |connector: &Connector| {
        let domain = Domain::random(alignment, poses, 1);
        let pair = Pair::new(connector, alignment);
        descent::run(&pair, domain, &DescentSettings::default(), &Exec::new()).unwrap().0.outcomes
    };
    let (one, other) = (outcomes(one), outcomes(other));
    one.iter().zip(&other).filter(|(a, b)| a != b).count()
}

/// A funnel of two stages on a floor, with as many sides, and a peg of two stages.
#[derive(Debug, Clone)]
struct Funnel {
    sides: usize,
    /// Radii of the hole at the floor, between the stages, and at the top.
    radii: [f64; 3],
    depth: [f64; 2],
    cuts: Vec<([f64; 3], f64)>,
}

const OUTSIDE: f64 = 0.8;
const FLOOR: f64 = 0.2;

fn funnels() -> impl Strategy<Value = Funnel> {
    let cut = (prop::array::uniform3(-1.0..1.0f64), -0.3..0.3f64);
    (3usize..9, 0.12..0.3f64, 0.02..0.15f64, 0.05..0.2f64, 0.1..0.25f64, prop::collection::vec(cut, 0..4))
        .prop_map(|(sides, floor, lower, upper, depth, cuts)| Funnel {
            sides,
            radii: [floor, floor + lower, floor + lower + upper],
            depth: [depth, 0.25],
            cuts,
        })
}

impl Funnel {
    fn ring(&self, radius: f64, z: f64, turn: f64) -> Vec<DVec3> {
        let at = |k: usize| DVec2::from_angle(TAU * (k as f64 + turn) / self.sides as f64) * radius;
        (0..self.sides).map(|k| at(k).extend(z)).collect()
    }

    /// From below the outside over the rim to the floor, as one surface.
    fn surface(&self) -> Surface {
        let [low, high] = self.depth;
        let [a, b, c] = self.radii;
        let rings = [
            self.ring(OUTSIDE, -FLOOR, 0.0),
            self.ring(OUTSIDE, low + high, 0.0),
            self.ring(c, low + high, 0.0),
            self.ring(b, low, 0.0),
            self.ring(a, 0.0, 0.0),
        ];
        let n = self.sides as u32;
        let mut polygons: Vec<Vec<u32>> = vec![(0..n).rev().collect(), (4 * n..5 * n).collect()];
        for ring in 0..4 {
            polygons.extend((0..n).map(|k| {
                let (a, b) = (ring * n + k, ring * n + (k + 1) % n);
                vec![a, b, b + n, a + n]
            }));
        }
        Surface::from_polygons(rings.concat(), &polygons).unwrap()
    }

    /// The same solid in convex pieces.
    fn pieces(&self) -> Vec<Surface> {
        let [low, high] = self.depth;
        let wedge = |k: usize, inner: [f64; 2], z: [f64; 2]| {
            let rings = [(inner[0], z[0]), (inner[1], z[1]), (OUTSIDE, z[0]), (OUTSIDE, z[1])]
                .map(|(radius, z)| self.ring(radius, z, 0.0));
            rings.iter().flat_map(|ring| [ring[k], ring[(k + 1) % self.sides]]).collect::<Vec<_>>()
        };
        let mut pieces = vec![[self.ring(OUTSIDE, -FLOOR, 0.0), self.ring(OUTSIDE, 0.0, 0.0)].concat()];
        for k in 0..self.sides {
            pieces.push(wedge(k, [self.radii[0], self.radii[1]], [0.0, low]));
            pieces.push(wedge(k, [self.radii[1], self.radii[2]], [low, low + high]));
        }
        for (normal, level) in &self.cuts {
            let Some(normal) = DVec3::from_array(*normal).try_normalize() else { continue };
            let cut = |piece: &Vec<DVec3>| {
                let solid = convex_hull(piece).unwrap();
                let parts = [below(&solid, normal, *level), below(&solid, -normal, -level)];
                // No design would contain a piece this thin.
                let is_thick = |part: &Vec<DVec3>| convex_hull(part).is_ok_and(|part| part.volume() > 1e-5);
                if parts.iter().all(is_thick) { parts.to_vec() } else { vec![piece.clone()] }
            };
            pieces = pieces.iter().flat_map(cut).collect();
        }
        let rounded = |p: &DVec3| (*p * 1e10).round() / 1e10;
        let written =
            |piece: &Vec<DVec3>| convex_hull(&piece.iter().map(rounded).collect::<Vec<_>>()).unwrap();
        pieces.iter().map(written).collect()
    }

    /// A peg smaller by a hundredth, in two pieces; drawn facing up.
    fn peg(&self) -> Vec<Surface> {
        let [low, high] = self.depth;
        let [a, b, c] = self.radii.map(|radius| radius - 0.01);
        let turn = 0.0;
        let hull = |rings: [Vec<DVec3>; 2]| convex_hull(&rings.concat()).unwrap();
        vec![
            hull([self.ring(c, 0.0, turn), self.ring(b, high, turn)]),
            hull([self.ring(b, high, turn), self.ring(a, high + low, turn)]),
        ]
    }

    fn mounted(&self, fixed: Half, moving: &Half) -> Connector {
        let [low, high] = self.depth;
        Connector::from_halves(fixed, moving.mapped(|p| Mount::X.apply(p - DVec3::Z * (low + high))))
    }
}

/// Corners of the part of a convex solid below a plane.
fn below(solid: &Surface, normal: DVec3, level: f64) -> Vec<DVec3> {
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
    corners
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    /// The union has the heights that brute force finds over its pieces, and the outcomes of the solid drawn as one
    /// surface.
    #[test]
    fn a_funnel_in_pieces_is_the_funnel(
        funnel in funnels(),
        poses in prop::collection::vec((prop::array::uniform2(-0.9..0.9f64), prop::array::uniform3(-1.2..1.2f64)), 12),
    ) {
        let alignment = {
            let mut alignment = Alignment::new(DofSet::ALL, Mount::X);
            alignment.center_of_rotation = 0.1;
            alignment.half_ranges = [0.2, 0.2, 0.3, 0.3, 0.3];
            alignment
        };
        let (pieces, peg) = (funnel.pieces(), funnel.peg());
        let united = funnel.mounted(Half::union_of(pieces.clone()).unwrap(), &Half::union_of(peg.clone()).unwrap());
        prop_assert_eq!((united.fixed.surfaces.len(), united.moving.surfaces.len()), (1, 1));
        let apart = funnel.mounted(Half::of(pieces), &Half::of(peg));
        let [pair, judge] = [&united, &apart].map(|connector| Pair::new(connector, &alignment));
        for ([x, y], [roll, pitch, yaw]) in poses {
            let pose = CorPose { lateral: DVec2::new(x, y), rotation: rotation(roll, pitch, yaw) };
            match (pair.height(&pose), brute::height(&judge, &pose)) {
                (Some(fast), Some(slow)) => prop_assert!((fast - slow).abs() < 1e-9, "{} {}", fast, slow),
                // Beside each other by rounding only.
                (fast, slow) => prop_assert!(fast.is_some() == slow.is_some(), "{:?} {:?}", fast, slow),
            }
        }
        let whole = Connector::from_halves(Half::of(vec![funnel.surface()]), united.moving.clone());
        let changed = changed(&united, &whole, &alignment, 50);
        prop_assert!(changed <= 1, "{} of 50 outcomes differ", changed);
    }
}
