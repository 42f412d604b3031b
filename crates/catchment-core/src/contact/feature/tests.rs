//! Features of halves with known features.

use super::*;
use crate::connector::Connector;
use crate::design::{Alignment, Family, FamilySpec};
use crate::pose::{DofSet, Mount};

fn features(family: Family) -> Features {
    let alignment = Alignment::default_for(Some(family));
    let connector = Connector::of_family(&FamilySpec::new(family), alignment.mount).unwrap();
    Features::of(&Pair::new(&connector, &alignment))
}

fn count(features: &Features, side: HalfRole, kind: FeatureKind) -> usize {
    features.halves[index(side)].features.iter().filter(|feature| feature.kind == kind).count()
}

#[test]
fn a_pyramid_has_five_faces_eight_edges_five_corners() {
    let result = features(Family::Pyramid);
    let counts = [FeatureKind::Face, FeatureKind::Edge, FeatureKind::Corner]
        .map(|kind| count(&result, HalfRole::Moving, kind));
    assert_eq!(counts, [5, 8, 5]);
    // By its symmetries: base and flank; base edge and flank edge; apex and base corner.
    let classes: BTreeSet<u32> = result.halves[1].classes.iter().copied().collect();
    assert_eq!(classes.len(), 6);
    assert_eq!(result.turns(HalfRole::Moving).0.len(), 8);
}

#[test]
fn a_cone_is_round_and_pointed() {
    let alignment = Alignment::new(DofSet::ALL, Mount::X);
    let connector = Connector::of_family(&FamilySpec::new(Family::Cone), Mount::X).unwrap();
    let result = Features::of(&Pair::new(&connector, &alignment));
    let counts = [FeatureKind::Face, FeatureKind::Edge, FeatureKind::Corner]
        .map(|kind| count(&result, HalfRole::Moving, kind));
    assert_eq!(counts, [2, 1, 1], "{:?}", result.halves[1].features);
    let names: Vec<String> = result.halves[1].features.iter().map(Feature::name).collect();
    assert!(names.iter().any(|name| name.starts_with("edge between ")), "{names:?}");
}

#[test]
fn names_describe_face_orientations() {
    let lie = |least: f64, most: f64| FaceOrientation {
        least: least.to_radians(),
        most: most.to_radians(),
        is_top: false,
    };
    let edge = |faces: Vec<FaceOrientation>| Feature { kind: FeatureKind::Edge, surface: 0, faces }.name();
    assert_eq!(edge(vec![lie(0.0, 0.0), lie(90.0, 90.0)]), "edge between flat and wall");
    assert_eq!(edge(vec![lie(45.0, 45.0), lie(45.0, 45.0)]), "edge between two slopes of 45°");
    assert_eq!(lie(0.0, 80.0).name(), "rounded surface");
    assert_eq!(lie(180.0, 180.0).name(), "underside");
    let corner =
        Feature { kind: FeatureKind::Corner, surface: 0, faces: vec![lie(90.0, 90.0), lie(0.0, 0.0)] };
    assert_eq!(corner.name(), "corner of flat and wall");
}
