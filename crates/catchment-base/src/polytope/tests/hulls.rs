//! Hulls, sums, shadows and sections compared with their points and with the slow reference.

use super::super::*;
use super::clouds::{check, cloud, nearly_flat_cloud, real, sums, support};
use proptest::prelude::*;

/// Largest error of a support function: rounding to the lattice, and removed splinters; corners as sharp as
/// those of random points stand out of a splinter by some thousand times its thickness.
const SHARP: f64 = 1e-7;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_hull_holds_its_points_and_no_more(
        (dimension, points) in cloud(1..=6, 14),
        directions in prop::collection::vec(real(6), 20),
    ) {
        let Some(hull) = Polytope::hull(dimension, &points) else { return Ok(()) };
        check(&hull)?;
        for point in &points {
            prop_assert!(hull.contains(point));
        }
        for mut direction in directions {
            direction[dimension..].fill(0.0);
            prop_assert!((hull.support(&direction) - support(&points, &direction)).abs() < 1e-9);
        }
    }

    #[test]
    fn hull_facets_and_edges_agree_with_brute_force((dimension, points) in cloud(2..=4, 10)) {
        let brute = brute::facets(dimension, &points);
        let depth = |f: &Halfspace| points.iter().map(|p| -f.excess(p)).fold(0.0, f64::max);
        // Brute force cannot distinguish the sides of a nearly flat set.
        prop_assume!(brute.iter().all(|f| depth(f) > 1e-3 || depth(f) < 1e-9));
        let Some(hull) = Polytope::hull(dimension, &points) else {
            // All points are coplanar: each plane through them has all points behind it, on both sides.
            prop_assert!(brute.iter().all(|f| points.iter().all(|p| f.excess(p) >= -1e-6)), "{brute:?}");
            return Ok(());
        };
        for facet in &brute {
            let alike = |f: &Halfspace| {
                dot(&f.normal, &facet.normal) > 1.0 - 1e-6 && (f.offset - facet.offset).abs() < 1e-4
            };
            prop_assert!(hull.facets().iter().any(alike), "{facet:?} is missing in {hull:?}");
        }
        prop_assert_eq!(brute.len(), hull.facets().len());
        for a in 0..hull.vertices().len() {
            for b in 0..a {
                prop_assert_eq!(hull.is_edge(a, b), brute::is_edge(&hull, a, b), "{} {} {:?}", a, b, hull);
            }
        }
    }

    #[test]
    fn the_order_of_points_does_not_matter((dimension, points) in cloud(2..=5, 14), turn in 0..14usize) {
        let mut other = points.clone();
        let turn = turn % points.len();
        other.rotate_left(turn);
        other.swap(0, points.len() / 2);
        other.extend_from_slice(&points[..turn]);
        let (one, other) = (Polytope::hull(dimension, &points), Polytope::hull(dimension, &other));
        prop_assert_eq!(format!("{one:?}"), format!("{other:?}"));
    }

    #[test]
    fn nearly_flat_points_have_a_sound_hull(
        (dimension, points) in nearly_flat_cloud(2..=4, 10),
        directions in prop::collection::vec(real(6), 20),
    ) {
        let Some(hull) = Polytope::hull(dimension, &points) else { return Ok(()) };
        check(&hull)?;
        for mut direction in directions {
            direction[dimension..].fill(0.0);
            prop_assert!((hull.support(&direction) - support(&points, &direction)).abs() < SHARP);
        }
    }

    #[test]
    fn a_sums_support_is_the_sum_of_supports(
        (dimension, a) in cloud(2..=4, 8),
        b in prop::collection::vec(real(6), 1..5),
        flat in any::<bool>(),
        directions in prop::collection::vec(real(6), 20),
    ) {
        let mut b = b;
        for point in &mut b {
            point[dimension - usize::from(flat)..].fill(0.0);
        }
        let Some(sum) = minkowski_sum_of(dimension, &a, &b) else { return Ok(()) };
        check(&sum)?;
        for mut direction in directions {
            direction[dimension..].fill(0.0);
            let expected = support(&a, &direction) + support(&b, &direction);
            prop_assert!((sum.support(&direction) - expected).abs() < 1e-9);
        }
        let by_points = Polytope::hull(dimension, &sums(&a, &b)).unwrap();
        prop_assert!((by_points.volume() - sum.volume()).abs() < 1e-8);
    }

    #[test]
    fn a_zonotope_has_the_faces_and_the_volume_of_its_formula(
        dimension in 2..=4usize,
        generators in prop::collection::vec(real(6), 4..=6),
    ) {
        let (n, origin) = (generators.len(), [0.0; MAX_DIMENSION]);
        let generators: Vec<PolytopePoint> = generators.into_iter().map(|mut g| {
            g[dimension..].fill(0.0);
            g
        }).collect();
        // Any subset of as many generators as there are dimensions spans a parallelepiped, which is one cell.
        let factorial: f64 = (1..=dimension).map(|k| k as f64).product();
        let mut cells = Vec::new();
        brute::each_subset(n, dimension, 0, &mut Vec::new(), &mut |chosen| {
            let simplex: Vec<PolytopePoint> = chosen.iter().map(|g| generators[*g]).chain([origin]).collect();
            cells.push(Polytope::hull(dimension, &simplex).map_or(0.0, |simplex| factorial * simplex.volume()));
        });
        prop_assume!(cells.iter().all(|volume| *volume > 1e-4));
        let mut vertices = vec![origin];
        let mut sum = None;
        for generator in &generators {
            sum = minkowski_sum_of(dimension, &vertices, &[origin, *generator]);
            // Flat at first.
            let flat = || sums(&vertices, &[origin, *generator]);
            vertices = sum.as_ref().map_or_else(flat, |sum: &Polytope| sum.vertices().to_vec());
        }
        let sum = sum.unwrap();
        check(&sum)?;
        let choose = |k: usize, of: usize| (0..k).fold(1, |c, i| c * (of - i) / (i + 1));
        // Buck, Partition of Space (1943): n planes through the origin make 2 Σ C(n − 1, i) regions; d − 1 generators
        // make two facets.
        prop_assert_eq!(sum.vertices().len(), 2 * (0..dimension).map(|i| choose(i, n - 1)).sum::<usize>());
        prop_assert_eq!(sum.facets().len(), 2 * choose(dimension - 1, n));
        prop_assert!((sum.volume() - cells.iter().sum::<f64>()).abs() < 1e-8);
    }

    #[test]
    fn a_shadows_support_is_that_of_the_body(
        (dimension, points) in cloud(3..=5, 12),
        axes in Just(vec![0usize, 1, 2, 3, 4]).prop_shuffle(),
        size in 1..4usize,
        directions in prop::collection::vec(real(6), 10),
    ) {
        let Some(body) = Polytope::hull(dimension, &points) else { return Ok(()) };
        let axes: Vec<usize> = axes.into_iter().filter(|a| *a < dimension).take(size).collect();
        let shadow = body.project(&axes).unwrap();
        check(&shadow)?;
        for direction in directions {
            let (mut inner, mut outer) = ([0.0; MAX_DIMENSION], [0.0; MAX_DIMENSION]);
            for (index, axis) in axes.iter().enumerate() {
                inner[index] = direction[index];
                outer[*axis] = direction[index];
            }
            prop_assert!((shadow.support(&inner) - body.support(&outer)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_section_agrees_with_the_body_on_its_plane(
        (dimension, points) in cloud(2..=5, 12),
        axis in 0..5usize,
        value in -0.5..0.5f64,
        probes in prop::collection::vec(real(6), 40),
    ) {
        let axis = axis % dimension;
        let Some(body) = Polytope::hull(dimension, &points) else { return Ok(()) };
        let Some(section) = body.slice(axis, value) else { return Ok(()) };
        check(&section)?;
        for probe in probes {
            let mut at = probe;
            at[dimension..].fill(0.0);
            at[axis] = value;
            let mut inner: Vec<f64> = at.to_vec();
            inner.remove(axis);
            inner.push(0.0);
            let inner: PolytopePoint = inner.try_into().unwrap();
            // Near the border the two may differ.
            let depth = body.facets().iter().map(|f| f.excess(&at)).fold(f64::NEG_INFINITY, f64::max);
            prop_assume!(depth.abs() > 1e-6);
            prop_assert_eq!(section.contains(&inner), depth < 0.0);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn volumes_are_those_of_evenly_strewn_points((dimension, points) in cloud(1..=4, 12)) {
        let Some(hull) = Polytope::hull(dimension, &points) else { return Ok(()) };
        let facets = hull.facets().to_vec();
        let (low, high) = hull.bounds();
        let room: f64 = low.iter().zip(&high).take(dimension).map(|(l, h)| h - l).product();
        let (mut count, mut middle) = (0.0, [0.0; MAX_DIMENSION]);
        let expected = brute::volume(dimension, &low, &high, 20_000, |point| {
            let inside = brute::contains(&facets, point);
            if inside {
                count += 1.0;
                middle = std::array::from_fn(|i| middle[i] + point[i]);
            }
            inside
        });
        // Random points would have a standard error of 0.0035 of the box; the low-discrepancy points err
        // less.
        prop_assert!((hull.volume() - expected).abs() < 0.012 * room, "{} {expected} {room}", hull.volume());
        let centroid = hull.centroid();
        prop_assert!(hull.contains(&centroid));
        if expected > 0.05 * room {
            for (c, m) in centroid.iter().zip(middle) {
                prop_assert!((c - m / count).abs() < 0.1, "{c} {}", m / count);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Every edge once each way, all corners, and the volume that it encloses by the divergence theorem.
    #[test]
    fn the_boundary_is_closed_and_faces_out((dimension, points) in cloud(2..=3, 14)) {
        let Some(hull) = Polytope::hull(dimension, &points) else { return Ok(()) };
        let boundary = hull.boundary();
        let mut edges: Vec<[usize; 2]> = boundary
            .iter()
            .flat_map(|walk| (0..walk.len()).map(|k| [walk[k], walk[(k + 1) % walk.len()]]))
            .collect();
        edges.sort_unstable();
        let count = edges.len();
        edges.dedup();
        prop_assert_eq!(count, edges.len(), "{:?}", boundary);
        let at = |k: usize| glam::DVec3::from_slice(&hull.vertices()[k][..3]);
        let measure: f64 = if dimension == 2 {
            prop_assert_eq!(boundary[0].len(), hull.vertices().len());
            edges.iter().map(|e| at(e[0]).truncate().perp_dot(at(e[1]).truncate()) / 2.0).sum()
        } else {
            prop_assert!(edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok()), "{:?}", boundary);
            let cone = |w: &Vec<usize>| w.windows(2).map(|e| at(w[0]).dot(at(e[0]).cross(at(e[1]))) / 6.0).sum::<f64>();
            boundary.iter().map(cone).sum()
        };
        prop_assert!((measure - hull.volume()).abs() < SHARP, "{measure} {}", hull.volume());
    }
}
