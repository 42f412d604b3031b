//! Closed forms here; the fast algorithms compared with the reference, and set algebra on random input, in
//! the modules.

mod clouds;
mod hulls;
mod sets;

use super::*;

fn point(coordinates: &[f64]) -> PolytopePoint {
    let mut point = [0.0; MAX_DIMENSION];
    point[..coordinates.len()].copy_from_slice(coordinates);
    point
}

fn cube(dimension: usize) -> Polytope {
    Polytope::cuboid(dimension, &[0.0; MAX_DIMENSION], &[1.0; MAX_DIMENSION]).unwrap()
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// Rounding of a volume of order 1 to 100.
const EXACT: f64 = 1e-11;

#[test]
fn the_simplex_has_volume_one_over_d_factorial() {
    for dimension in 1..=MAX_DIMENSION {
        let mut points = vec![[0.0; MAX_DIMENSION]; dimension + 1];
        for axis in 0..dimension {
            points[axis + 1][axis] = 1.0;
        }
        let simplex = Polytope::hull(dimension, &points).unwrap();
        assert_eq!(simplex.facets().len(), dimension + 1);
        assert_eq!(simplex.vertices().len(), dimension + 1);
        assert!((simplex.volume() - 1.0 / factorial(dimension)).abs() < EXACT);
        for c in &simplex.centroid()[..dimension] {
            assert!((c - 1.0 / (dimension as f64 + 1.0)).abs() < EXACT);
        }
    }
}

#[test]
fn the_hull_of_a_cubes_lattice_points_is_the_cube() {
    for dimension in 1..=5usize {
        let sides: usize = 3;
        let points: Vec<PolytopePoint> = (0..sides.pow(dimension as u32))
            .map(|index| {
                let mut p = [0.0; MAX_DIMENSION];
                for (axis, c) in p.iter_mut().enumerate().take(dimension) {
                    *c = (index / sides.pow(axis as u32) % sides) as f64 / 2.0;
                }
                p
            })
            .collect();
        let hull = Polytope::hull(dimension, &points).unwrap();
        assert_eq!(hull.vertices().len(), 1 << dimension, "{dimension}");
        assert_eq!(hull.facets().len(), 2 * dimension, "{dimension}");
        assert!((hull.volume() - 1.0).abs() < EXACT);
    }
}

#[test]
fn the_cross_polytope_has_volume_two_to_the_d_over_d_factorial() {
    for dimension in 2..=MAX_DIMENSION {
        let mut points = Vec::new();
        for axis in 0..dimension {
            for sign in [1.0, -1.0] {
                let mut p = [0.0; MAX_DIMENSION];
                p[axis] = sign;
                points.push(p);
            }
        }
        let cross = Polytope::hull(dimension, &points).unwrap();
        assert_eq!(cross.facets().len(), 1 << dimension);
        assert!((cross.volume() - (1usize << dimension) as f64 / factorial(dimension)).abs() < EXACT);
    }
}

#[test]
fn a_cube_cut_at_its_corner() {
    for dimension in 1..=MAX_DIMENSION {
        let by = Halfspace::new(point(&vec![1.0; dimension]), 1.0).unwrap();
        let (inside, outside) = cube(dimension).split(&by);
        let inside = inside.unwrap();
        assert!((inside.volume() - 1.0 / factorial(dimension)).abs() < EXACT);
        assert_eq!(inside.vertices().len(), dimension + 1);
        let rest = outside.map_or(0.0, |outside| outside.volume());
        assert!((rest + inside.volume() - 1.0).abs() < EXACT);
    }
}

#[test]
fn degenerate_input_is_refused() {
    let square = [point(&[0.0, 0.0]), point(&[1.0, 0.0]), point(&[0.0, 1.0]), point(&[1.0, 1.0])];
    assert!(Polytope::hull(3, &square).is_none());
    assert!(Polytope::hull(2, &square).is_some());
    assert!(Polytope::hull(0, &square).is_none());
    assert!(Polytope::hull(7, &square).is_none());
    assert!(Polytope::hull(2, &[]).is_none());
    assert!(Polytope::hull(1, &[]).is_none());
    assert!(Polytope::hull(2, &[point(&[f64::NAN, 0.0]); 4]).is_none());
    assert!(Polytope::cuboid(2, &[0.0; MAX_DIMENSION], &point(&[1.0, 1e-10])).is_none());
    assert!(Polytope::cuboid(2, &[0.0; MAX_DIMENSION], &point(&[1.0, f64::NAN])).is_none());
    assert!(Halfspace::new([0.0; MAX_DIMENSION], 1.0).is_none());
    assert!(Halfspace::new(point(&[f64::NAN]), 1.0).is_none());
    let huge = Halfspace::new(point(&[3e300, 4e300]), 5e300).unwrap();
    assert!((huge.normal[0] - 0.6).abs() < EXACT && (huge.offset - 1.0).abs() < EXACT);
}

#[test]
fn a_hole_in_a_square() {
    let hole = Polytope::cuboid(2, &point(&[0.25, 0.25]), &point(&[0.75, 0.75])).unwrap();
    let pieces = cube(2).difference(&hole);
    assert_eq!(pieces.len(), 4);
    assert!((pieces.iter().map(Polytope::volume).sum::<f64>() - 0.75).abs() < EXACT);
    assert!(hole.difference(&cube(2)).is_empty());
    let beside = Polytope::cuboid(2, &point(&[1.0, 0.0]), &point(&[2.0, 1.0])).unwrap();
    assert!(!beside.overlaps(&cube(2)));
    assert_eq!(beside.difference(&cube(2)).len(), 1);
}

#[test]
fn a_prism_is_a_sum_and_its_shadow_and_section_are_its_base() {
    let base = [point(&[0.0, 0.0]), point(&[1.0, 0.0]), point(&[0.3, 0.9])];
    let prism = minkowski_sum_of(3, &base, &[point(&[0.0, 0.0, 0.0]), point(&[0.2, 0.1, 2.0])]).unwrap();
    assert_eq!((prism.vertices().len(), prism.facets().len()), (6, 5));
    assert!((prism.volume() - 0.9).abs() < EXACT);
    assert!((prism.slice(2, 1.0).unwrap().volume() - 0.45).abs() < EXACT);
    assert!((prism.slice(2, 0.0).unwrap().volume() - 0.45).abs() < EXACT);
    assert!(prism.slice(2, 2.1).is_none() && prism.slice(3, 0.0).is_none());
    let top = prism.facets().iter().position(|f| f.normal[2] > 0.99).unwrap();
    assert!((prism.facet_projected(top, 2).unwrap().volume() - 0.45).abs() < EXACT);
    assert!(prism.facet_projected(top, 0).is_none());
    assert_eq!(prism.facet_vertices(top).count(), 3);
    assert_eq!(prism.project(&[0, 1]).unwrap().vertices().len(), 5);
    assert!(prism.project(&[0, 3]).is_none() && prism.project(&[0, 0]).is_none());
}
