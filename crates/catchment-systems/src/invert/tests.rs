//! Round trips, and unattainable heights.

use super::heights::common;
use super::*;
use catchment::design::SourceText;
use catchment::method::zraa::area;
use catchment::problem::{Draft, Problem};

pub(super) fn problem(text: &str) -> Problem {
    Draft::read(SourceText::new("d.toml", text)).unwrap().build().unwrap()
}

pub(super) fn family(name: &str) -> Problem {
    problem(&format!(
        "[connector]\nfamily = \"{name}\"\naspect_ratio = 0.5\n[alignment]\nrotation_length = 0.5\n"
    ))
}

pub(super) fn own_heights(problem: &Problem) -> Heights {
    heights_of(problem.design(), problem.connector(), DMat3::IDENTITY, &Exec::new()).unwrap()
}

pub(super) fn inverted(problem: &Problem, wanted: Heights, settings: &InvertSettings) -> Inverse {
    let own = problem.connector();
    invert(problem.design(), own, wanted, own, settings, &Exec::new()).unwrap()
}

pub(super) const FAMILIES: [&str; 5] = ["v-face", "s-face", "x-face", "pyramid", "x-face-3d"];

/// Wanted: the heights of a family. Given: its fixed half. Got: its moving half.
#[test]
fn heights_of_a_family_and_its_fixed_half_give_back_its_moving_half() {
    for name in FAMILIES {
        let problem = family(name);
        let result = inverted(&problem, own_heights(&problem), &InvertSettings::default());
        let own = lower_surface(&problem.connector().moving, &Exec::new()).unwrap();
        let mut compared = 0.0;
        for a in &own.facets {
            for b in &result.moving.facets {
                let Some(polygon) = common(&a.polygon, &b.polygon) else { continue };
                compared += area(&polygon);
                for p in &polygon {
                    let apart = (a.height(*p) - b.height(*p)).abs();
                    assert!(apart < REACHED, "{name} at {p}: {apart:e}");
                }
            }
        }
        let plan: f64 = own.facets.iter().map(|f| area(&f.polygon)).sum();
        assert!((compared - plan).abs() < 1e-9, "{name}: {compared} of {plan}");
        assert_eq!(result.shortfalls, [], "{name}");
        // Complementary faces touch all over when mated.
        assert!((result.patch - plan).abs() < 1e-8, "{name}: {} of {plan}", result.patch);
        assert!(result.reached.at(DVec2::ZERO).unwrap().abs() < REACHED, "{name}");
    }
}

#[test]
fn the_envelope_is_the_height_of_first_contact() {
    for name in FAMILIES {
        let problem = family(name);
        let heights = own_heights(&problem);
        let aligned = catchment::pose::CorPose { lateral: DVec2::ZERO, rotation: DMat3::IDENTITY };
        let pair = problem.pair();
        let cor = problem.alignment().center_of_rotation;
        for k in 0..40 {
            let x = -0.9 + 0.0437 * f64::from(k);
            let y = if is_planar(problem.design()) { 0.0 } else { 0.31 * (f64::from(k) * 0.7).sin() };
            let lateral = DVec2::new(x, y);
            let exact = pair.height(&catchment::pose::CorPose { lateral, ..aligned });
            // The library gives the height of the centre of rotation, which is that far below the face.
            let (Some(ours), Some(exact)) = (heights.at(lateral), exact) else { continue };
            assert!((ours - (exact + cor)).abs() < 1e-9, "{name} {lateral}: {ours} {exact} {cor}");
        }
    }
}

/// Heights lower than the pair's stops are wanted, over a small square of offsets: they are unattainable, and
/// the result gives their place.
#[test]
fn lowered_heights_are_unattainable_and_located() {
    for name in ["pyramid", "x-face-3d", "v-face"] {
        let problem = family(name);
        let heights = own_heights(&problem);
        let center = DVec2::new(0.2, 0.0);
        let dent: Vec<DVec2> = [(-0.05, -0.05), (0.05, -0.05), (0.05, 0.05), (-0.05, 0.05)]
            .map(|(x, y)| center + DVec2::new(x, y))
            .to_vec();
        let lowered = 0.03;
        let mut wanted = Heights::default();
        for facet in &heights.facets {
            let mut pieces = vec![facet.polygon.clone()];
            if let Some(inside) = common(&facet.polygon, &dent) {
                wanted.facets.push(HeightFacet {
                    polygon: inside,
                    offset: facet.offset - lowered,
                    gradient: facet.gradient,
                });
                pieces = outside(&facet.polygon, &dent);
            }
            wanted.facets.extend(pieces.into_iter().map(|polygon| HeightFacet { polygon, ..facet.clone() }));
        }
        let result = inverted(&problem, wanted.clone(), &InvertSettings::default());
        // Nowhere higher than wanted.
        for want in &counted(problem.design(), wanted).facets {
            for got in &result.reached.facets {
                if let Some(polygon) = common(&want.polygon, &got.polygon) {
                    for p in &polygon {
                        assert!(got.height(*p) <= want.height(*p) + 1e-9, "{name} {p}");
                    }
                }
            }
        }
        // The moving half receded at the dent, so heights beside it are missed, by at most the depth of the
        // dent.
        let worst = result.shortfalls.first().unwrap_or_else(|| panic!("{name}: all reached"));
        assert!(worst.most > 0.01 && worst.most < 10.0 * lowered, "{name}: {}", worst.most);
        let short = result.reached.at(worst.at).unwrap();
        assert!(short.is_finite());
    }
}

/// Convex pieces of a polygon outside a convex polygon.
fn outside(polygon: &[DVec2], region: &[DVec2]) -> Vec<Vec<DVec2>> {
    let far = 100.0;
    let mut pieces = Vec::new();
    let mut rest = polygon.to_vec();
    for (k, &from) in region.iter().enumerate() {
        let along = (region[(k + 1) % region.len()] - from).normalize();
        let out = -along.perp();
        let half = |way: DVec2| {
            let side = DVec2::new(-way.y, way.x);
            let mut square = vec![
                from - side * far,
                from + side * far,
                from + side * far + way * far,
                from - side * far + way * far,
            ];
            if area(&square) < 0.0 {
                square.reverse();
            }
            square
        };
        pieces.extend(common(&rest, &half(out)));
        match common(&rest, &half(-out)) {
            Some(inner) => rest = inner,
            None => return pieces,
        }
    }
    pieces
}

#[test]
fn constant_wanted_heights_give_a_plate() {
    // Over the pyramid's socket, whose rim is at H/2 = 0.25, constant wanted heights: the moving half makes
    // contact with its deepest point only. g(u) = max f − h* wherever the rim can come over u: a plate.
    let problem = family("pyramid");
    let table = "x,y,height\n-2,-2,1\n2,-2,1\n-2,2,1\n2,2,1\n";
    let wanted = wanted_from_table(SourceText::new("w.csv", table)).unwrap();
    let result = inverted(&problem, wanted, &InvertSettings::default());
    let [low, high] = result.moving.range().unwrap();
    assert!((low - (0.25 - 1.0)).abs() < 1e-9 && (high - low).abs() < 1e-9, "{low} {high}");
    assert!(
        result.reached.facets.iter().all(|f| f.polygon.iter().all(|p| (f.height(*p) - 1.0).abs() < 1e-9))
    );
}

#[test]
fn rotations_already_satisfied_change_nothing() {
    let problem = family("pyramid");
    let plain = inverted(&problem, own_heights(&problem), &InvertSettings::default());
    let settings = InvertSettings { yaw: vec![-0.3, 0.3], ..InvertSettings::default() };
    let turned = inverted(&problem, own_heights(&problem), &settings);
    // The pair's own moving half keeps its own heights at each rotation, so the rotations require nothing
    // more.
    for facet in &turned.moving.facets {
        for p in &facet.polygon {
            let before = plain.moving.at(*p).unwrap();
            assert!((facet.height(*p) - before).abs() < 1e-8, "{p}: {} {before}", facet.height(*p));
        }
    }
    assert_eq!(turned.shortfalls, []);
}

/// Higher heights are wanted, and at a rotation the old heights: without the rotation the half comes out too
/// deep for it.
#[test]
fn heights_at_a_rotation_hold_only_if_requested() {
    let problem = family("pyramid");
    let (turn, higher) = (0.3, 0.2);
    let mut wanted = own_heights(&problem);
    for facet in &mut wanted.facets {
        facet.offset += higher;
    }
    let there = |connector: &Connector| {
        heights_of(problem.design(), connector, DMat3::from_rotation_z(turn), &Exec::new()).unwrap()
    };
    let limit = there(problem.connector());
    // Most that a half stops above the limit at the turn.
    let excess = |yaw: &[f64]| {
        let settings = InvertSettings { yaw: yaw.to_vec(), ..InvertSettings::default() };
        let result = inverted(&problem, wanted.clone(), &settings);
        let mut most = f64::NEG_INFINITY;
        for want in &limit.facets {
            for got in &there(&result.connector).facets {
                if let Some(polygon) = common(&want.polygon, &got.polygon) {
                    most = polygon.iter().map(|p| got.height(*p) - want.height(*p)).fold(most, f64::max);
                }
            }
        }
        most
    };
    assert!((excess(&[]) - higher).abs() < 1e-8, "{}", excess(&[]));
    assert!(excess(&[turn]) < 1e-8, "{}", excess(&[turn]));
}

#[test]
fn the_result_is_a_design_that_runs() {
    for name in FAMILIES {
        let problem = family(name);
        let result = inverted(&problem, own_heights(&problem), &InvertSettings::default());
        let limits = ManufacturingLimits { feature_d: 0.01, draft_rad: 0.05 };
        let printed = report(problem.design(), &result, limits);
        assert!(printed.table().lines().all(|line| line.chars().count() <= 80), "{}", printed.table());
        assert!(printed.pieces_d.len() <= MAX_PIECES, "{name}: {} pieces", printed.pieces_d.len());
        let text = design_file(problem.design(), &result);
        let again = super::tests::problem(&text);
        let [a, b] = [own_heights(&problem), own_heights(&again)];
        for k in 0..60 {
            let p =
                DVec2::new(-0.8 + 0.027 * f64::from(k), if is_planar(problem.design()) { 0.0 } else { 0.1 });
            match (a.at(p), b.at(p)) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1e-8, "{name} {p}: {a} {b}"),
                (a, b) => assert_eq!(a.is_some(), b.is_some(), "{name} {p}"),
            }
        }
    }
}

#[test]
fn table_defects_are_reported_in_their_places() {
    let error_of = |text: &str| wanted_from_table(SourceText::new("w.csv", text)).unwrap_err().to_string();
    assert!(error_of("x,y,z\n0,0,0\n").contains("w.csv:1:1: the columns are not x,y,height"));
    assert!(error_of("x,y,height\n0,0,nan\n").contains("w.csv:2:1: the line is not three finite numbers"));
    assert!(error_of("x,y,height\n0,0,0\n0,0,1\n").contains("w.csv:3:1: (0, 0) is there twice"));
    assert!(
        error_of("x,y,height\n0,0,0\n1,0,0\n0,1,0\n").contains("3 places do not make a grid of 2 x by 2 y")
    );
    assert!(error_of("x,y,height\n0,0,0,0\n").contains("w.csv:2:1: the line is not three finite numbers"));
    assert!(
        error_of(&("x,y,height\n".to_owned() + &"0,0,0\n".repeat(901))).contains("the grid has 901 places")
    );
    let many = "x,y,height\n".to_owned() + &"a,b,c\n".repeat(1000);
    let refused = wanted_from_table(SourceText::new("w.csv", many)).unwrap_err();
    assert_eq!((refused.list.len(), refused.omitted), (20, 980));
}
