//! Set algebra: cuts, differences and unions, by volume and by membership.

use super::super::*;
use super::clouds::{check, cloud, nearly_flat_cloud, real};
use proptest::prelude::*;

/// Largest error of sums of volumes: slivers thinner than [`RESOLUTION`], a few for each operation, over
/// areas up to 8.
const SLIVERS: f64 = 1e-7;
/// Nearer to a border than this, membership is not compared.
const BORDER: f64 = 1e-6;

/// Distance of a point outside; negative inside.
fn excess(polytope: &Polytope, point: &PolytopePoint) -> f64 {
    polytope.facets().iter().map(|facet| facet.excess(point)).fold(f64::NEG_INFINITY, f64::max)
}

fn volume(pieces: &[Polytope]) -> f64 {
    pieces.iter().map(Polytope::volume).sum()
}

/// A plane of an awkward kind: general, through vertices, or nearly that of a facet.
#[derive(Clone, Debug)]
struct Plane {
    kind: usize,
    picks: [usize; 6],
    normal: PolytopePoint,
    offset: f64,
    shift: f64,
}

fn plane() -> impl Strategy<Value = Plane> {
    let shift = (-15.0..-3.0f64, any::<bool>())
        .prop_map(|(exponent, up)| if up { 10f64.powf(exponent) } else { -10f64.powf(exponent) });
    (0..6usize, prop::array::uniform6(0..1000usize), real(6), -0.3..0.3f64, shift)
        .prop_map(|(kind, picks, normal, offset, shift)| Plane { kind, picks, normal, offset, shift })
}

impl Plane {
    fn of(&self, polytope: &Polytope) -> Option<Halfspace> {
        let dimension = polytope.dimension();
        let mut normal = self.normal;
        normal[dimension..].fill(0.0);
        let vertex = |pick: usize| polytope.vertices()[self.picks[pick] % polytope.vertices().len()];
        match self.kind {
            0 | 1 => Halfspace::new(normal, self.offset),
            // Through a vertex, or nearly.
            2 => {
                let plane = Halfspace::new(normal, 0.0)?;
                Some(Halfspace { offset: dot(&plane.normal, &vertex(0)) + self.shift, ..plane })
            }
            // Through two vertices and more.
            3 | 4 => {
                let points: Vec<PolytopePoint> = (0..dimension).map(vertex).collect();
                let mut center = polytope.centroid();
                center.iter_mut().zip(&self.normal).take(dimension).for_each(|(c, n)| *c += 3.0 * n);
                let mut simplex = points.clone();
                simplex.push(center);
                let simplex = Polytope::hull(dimension, &simplex)?;
                let facet =
                    simplex.facets().iter().find(|f| points.iter().all(|p| f.excess(p).abs() < 1e-9))?;
                let shift = if self.kind == 3 { self.shift } else { 0.0 };
                Some(Halfspace { offset: facet.offset + shift, ..*facet })
            }
            // A facet, turned and shifted by a little.
            _ => {
                let facet = polytope.facets()[self.picks[0] % polytope.facets().len()];
                let turned = std::array::from_fn(|i| facet.normal[i] + self.shift * normal[i]);
                let plane = Halfspace::new(turned, 0.0)?;
                Some(Halfspace { offset: dot(&plane.normal, &vertex(1)), ..plane })
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn parts_make_the_whole(
        (dimension, points) in cloud(1..=5, 12),
        planes in prop::collection::vec(plane(), 1..10),
        probes in prop::collection::vec(real(6), 10),
    ) {
        let Some(whole) = Polytope::hull(dimension, &points) else { return Ok(()) };
        let mut rest = whole;
        // Bodies in five dimensions soon have hundreds of vertices.
        for plane in planes.into_iter().take(if dimension > 4 { 3 } else { 10 }) {
            let Some(by) = plane.of(&rest) else { continue };
            let (inside, outside) = rest.split(&by);
            let parts: Vec<&Polytope> = inside.iter().chain(&outside).collect();
            for part in &parts {
                check(part)?;
            }
            let sum: f64 = parts.iter().map(|part| part.volume()).sum();
            prop_assert!((sum - rest.volume()).abs() < SLIVERS, "{sum} {} {by:?} {rest:?}", rest.volume());
            prop_assert_eq!(format!("{:?}", rest.cut(&by)), format!("{inside:?}"));
            for mut probe in probes.iter().copied() {
                probe[dimension..].fill(0.0);
                let (whole, side) = (excess(&rest, &probe), by.excess(&probe));
                if whole.abs() > BORDER && side.abs() > BORDER {
                    let holds = |part: &Option<Polytope>| part.as_ref().is_some_and(|p| p.contains(&probe));
                    prop_assert_eq!(holds(&inside), whole < 0.0 && side < 0.0);
                    prop_assert_eq!(holds(&outside), whole < 0.0 && side > 0.0);
                }
            }
            let larger = inside.into_iter().chain(outside).max_by(|a, b| a.volume().total_cmp(&b.volume()));
            // Both parts are too thin for a polytope.
            let Some(larger) = larger else { break };
            rest = larger;
        }
    }

    #[test]
    fn nearly_flat_bodies_are_cut_as_well(
        (dimension, points) in nearly_flat_cloud(2..=4, 10),
        planes in prop::collection::vec(plane(), 1..6),
    ) {
        let Some(mut rest) = Polytope::hull(dimension, &points) else { return Ok(()) };
        for plane in planes {
            let Some(by) = plane.of(&rest) else { continue };
            let (inside, outside) = rest.split(&by);
            let parts: Vec<Polytope> = inside.into_iter().chain(outside).collect();
            for part in &parts {
                check(part)?;
            }
            let sum = volume(&parts);
            prop_assert!((sum - rest.volume()).abs() < SLIVERS, "{sum} {} {by:?} {rest:?}", rest.volume());
            let larger = parts.into_iter().max_by(|a, b| a.volume().total_cmp(&b.volume()));
            let Some(larger) = larger else { break };
            rest = larger;
        }
    }

    #[test]
    fn difference_and_intersection_partition_a_body(
        (dimension, a) in cloud(1..=4, 9),
        b in cloud(4..=4, 9),
        share in 0..3usize,
        probes in prop::collection::vec(real(6), 20),
    ) {
        let mut b: Vec<PolytopePoint> = b.1;
        for point in &mut b {
            point[dimension..].fill(0.0);
        }
        // Bodies that share vertices, edges or facets.
        b.extend(a.iter().take(share * dimension / 2));
        let hull = |points: &[PolytopePoint]| Polytope::hull(dimension, points);
        let (Some(a), Some(b)) = (hull(&a), hull(&b)) else { return Ok(()) };
        let (pieces, shared) = (a.difference(&b), a.intersection(&b));
        for piece in pieces.iter().chain(&shared) {
            check(piece)?;
        }
        prop_assert_eq!(shared.is_some(), a.overlaps(&b));
        let common = shared.as_ref().map_or(0.0, Polytope::volume);
        prop_assert!((b.intersection(&a).map_or(0.0, |p| p.volume()) - common).abs() < SLIVERS);
        prop_assert!((volume(&pieces) + common - a.volume()).abs() < SLIVERS, "{a:?} {b:?}");
        for (index, piece) in pieces.iter().enumerate() {
            prop_assert!(!piece.overlaps(&b), "{a:?} {b:?}");
            prop_assert!(pieces[..index].iter().all(|other| !piece.overlaps(other)));
        }
        for mut probe in probes {
            probe[dimension..].fill(0.0);
            let (in_a, in_b) = (excess(&a, &probe), excess(&b, &probe));
            if in_a.abs() > BORDER && in_b.abs() > BORDER {
                prop_assert_eq!(pieces.iter().any(|p| p.contains(&probe)), in_a < 0.0 && in_b > 0.0);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn unions_obey_the_algebra_of_sets(
        bodies in prop::collection::vec(cloud(3..=3, 7), 6),
        planar in any::<bool>(),
        probes in prop::collection::vec(real(6), 40),
    ) {
        let dimension = if planar { 2 } else { 3 };
        let mut bodies: Vec<Polytope> =
            bodies.iter().filter_map(|(_, points)| Polytope::hull(3, points)).collect();
        if planar {
            bodies = bodies.iter().filter_map(|body| body.project(&[2, 0])).collect();
        }
        let b = Collection { polytopes: bodies.split_off(bodies.len() / 2) };
        let a = Collection { polytopes: bodies };
        let (without, common) = (a.difference(&b), a.intersection(&b));
        let both: Collection = a.polytopes.iter().chain(&b.polytopes).cloned().collect();
        prop_assert!((without.volume() + common.volume() - a.volume()).abs() < SLIVERS);
        prop_assert!((without.volume() + b.volume() - both.volume()).abs() < SLIVERS);
        let disjoint = both.disjoint();
        for (index, piece) in disjoint.polytopes.iter().enumerate() {
            check(piece)?;
            prop_assert!(disjoint.polytopes[..index].iter().all(|other| !piece.overlaps(other)));
        }
        for mut probe in probes {
            probe[dimension..].fill(0.0);
            let near = |body: &Polytope| excess(body, &probe).abs() < BORDER;
            if both.polytopes.iter().any(near) {
                continue;
            }
            let (in_a, in_b) = (a.contains(&probe), b.contains(&probe));
            prop_assert_eq!(without.contains(&probe), in_a && !in_b);
            prop_assert_eq!(common.contains(&probe), in_a && in_b);
            prop_assert_eq!(disjoint.contains(&probe), in_a || in_b);
        }
    }

    #[test]
    fn sums_and_shadows_of_unions(
        one in cloud(3..=3, 6),
        other in cloud(3..=3, 6),
        third in prop::collection::vec(real(3), 4),
        probe in real(3),
    ) {
        let hull = |points: &[PolytopePoint]| Polytope::hull(3, points);
        let (Some(one), Some(other), Some(third)) = (hull(&one.1), hull(&other.1), hull(&third)) else {
            return Ok(());
        };
        let union = Collection { polytopes: vec![one, other] };
        let sum = union.minkowski_sum(&third.into());
        let shadow = sum.project(&[0, 2]);
        prop_assert_eq!((sum.polytopes.len(), shadow.polytopes.len()), (2, 2));
        let cells = sum.disjoint();
        prop_assert!((cells.volume() - sum.volume()).abs() < SLIVERS);
        prop_assert!(sum.volume() <= volume(&sum.polytopes) + SLIVERS);
        if sum.contains(&probe) {
            prop_assert!(shadow.contains(&[probe[0], probe[2], 0.0, 0.0, 0.0, 0.0]));
        }
    }
}
