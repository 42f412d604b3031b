//! The outline compared with closed forms, another library's areas, and random lengths.

use super::*;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use proptest::prelude::*;

/// Area of two polygons combined, by another library in whole numbers of 64 bits.
fn combined(a: &Polygon, b: &Polygon, rule: OverlayRule) -> f64 {
    let flat = |polygon: &Polygon| polygon.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
    flat(a)
        .overlay_as::<i64>(&flat(b), rule, FillRule::NonZero)
        .iter()
        .flatten()
        .map(|path| area(&path.iter().map(|p| DVec2::from_array(*p)).collect::<Vec<_>>()))
        .sum()
}

fn turned(geometry: &Geometry, polygon: &Polygon) -> Polygon {
    polygon.iter().map(|p| geometry.turned(*p)).collect()
}

/// The numbers that were computed by hand from the same sentences.
#[test]
fn the_defaults_give_the_recomputed_geometry() {
    let geometry = Geometry::of(&LatchDesign::default()).unwrap();
    let lever = geometry.lever();
    let printed = [
        geometry.profile.end.to_degrees(),
        geometry.height(),
        geometry.pivot.x,
        geometry.pivot.y,
        lever.x,
        lever.y,
        geometry.slit_end,
    ];
    let digits = [1, 1, 2, 1, 2, 1, 1];
    let printout: Vec<String> = printed.iter().zip(digits).map(|(v, d)| format!("{v:.d$}")).collect();
    assert_eq!(printout, ["75.7", "36.5", "46.25", "-40.0", "10.95", "43.0", "-44.3"]);
    assert!(geometry.tangent_miss() < 1e-9);
}

#[test]
fn chords_are_near_the_curve() {
    let geometry = Geometry::of(&LatchDesign::default()).unwrap();
    for pair in geometry.arm_profile().windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let drop = geometry.profile.height(middle.x) - middle.y;
        // Straight up from the chord is farther than across it.
        let off = drop * geometry.profile.angle(middle.x).cos();
        assert!((-1e-9..CHORD).contains(&off), "{off}");
    }
}

/// Two halves fill their box: nothing twice, nothing left over but slits and cut-outs.
#[test]
fn halves_mate_without_gap_or_overlap() {
    for overhang in [2.5, 3.8, 5.1] {
        let latch = LatchDesign { overhang, ..LatchDesign::default() };
        let geometry = Geometry::of(&latch).unwrap();
        let (solid, layer) = (geometry.solid(), geometry.layer());
        let full = latch.width * latch.base;
        // The turned half fills the rest of the box, so each half has half of the area.
        assert!((area(&solid) - full).abs() < 1e-9);
        let partner = turned(&geometry, &solid);
        assert!(combined(&solid, &partner, OverlayRule::Intersect) < 1e-4);
        assert!((combined(&solid, &partner, OverlayRule::Union) - 2.0 * full).abs() < 1e-4);
        let partner = turned(&geometry, &layer);
        assert!(combined(&layer, &partner, OverlayRule::Intersect) < 1e-4);
        let cut = area(&solid) - area(&layer);
        let slot = (geometry.slit[0] - latch.neck) * latch.l_eq;
        // Along a gap of 0.36 the face is straight but for a micrometre.
        let slit = latch.slit_gap * latch.slit_depth;
        assert!((cut - slot - slit).abs() < 0.06, "{cut} {slot} {slit}");
    }
}

#[test]
fn outlines_are_closed_simple_and_made_of_their_parts() {
    let geometry = Geometry::of(&LatchDesign::default()).unwrap();
    let layer = geometry.layer();
    assert!(is_simple(&layer) && is_simple(&geometry.separator()) && area(&layer) > 0.0);
    let neck = geometry.neck * (geometry.cutout[1] - geometry.cutout[0]);
    let parts = area(&geometry.arm()) + area(&geometry.body()) + neck;
    // The drawn body has a straight edge, but the slit ends slightly deeper.
    let deeper = (geometry.slit[1] - geometry.slit[0]) * (geometry.cutout[0] - geometry.slit_end);
    assert!((parts - area(&layer) - deeper).abs() < 1e-6);
    let mirrored = geometry.mirrored(&layer);
    assert!((area(&mirrored) - area(&layer)).abs() < 1e-9);
    let mut crossed = layer;
    crossed.swap(3, 200);
    assert!(!is_simple(&crossed));
}

/// The common part of both layers leaves the partner's separator free; the union of both would not.
#[test]
fn separators_do_not_meet() {
    let geometry = Geometry::of(&LatchDesign::default()).unwrap();
    let separator = geometry.separator();
    let partner = turned(&geometry, &separator);
    assert!(combined(&separator, &partner, OverlayRule::Intersect) < 1e-6);
    let front = geometry.solid();
    let both = combined(&front, &geometry.mirrored(&front), OverlayRule::Intersect);
    assert!(
        (both - area(&separator)).abs()
            < geometry.overhang * 2.0 * geometry.profile.height(geometry.width / 2.0)
    );
    // The union extends above the plane into the space of the partner's lower part.
    let union: Vec<Vec<[f64; 2]>> = {
        let flat = |polygon: &Polygon| polygon.iter().map(|p| [p.x, p.y]).collect::<Vec<[f64; 2]>>();
        let shapes = flat(&front).overlay_as::<i64>(
            &flat(&geometry.mirrored(&front)),
            OverlayRule::Union,
            FillRule::NonZero,
        );
        shapes.into_iter().flatten().collect()
    };
    let union: Polygon = union[0].iter().map(|p| DVec2::from_array(*p)).collect();
    assert!(combined(&union, &turned(&geometry, &union), OverlayRule::Intersect) > 1000.0);
}

#[test]
fn impossible_outlines_are_refused() {
    // A cut-out as high as that puts P above the hook.
    let refuse = |latch: LatchDesign| Geometry::of(&latch).unwrap_err().key();
    assert_eq!(refuse(LatchDesign { slit_distance: 2.0, ..LatchDesign::default() }), "slit_distance");
    assert_eq!(refuse(LatchDesign { slit_distance: 40.0, ..LatchDesign::default() }), "slit_distance");
    assert_eq!(refuse(LatchDesign { l_eq: 100.0, ..LatchDesign::default() }), "spline_start");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// For any lengths, the profile falls, bends one way and ends towards P, and halves fill their box.
    #[test]
    fn every_outline_meets_its_definition(
        o in 1.0f64..8.0, t in 2.0f64..5.0, hook in 1.0f64..6.0, bend in 3.0f64..12.0, start in 20f64..45.0,
    ) {
        let latch = LatchDesign { overhang: o, neck: t, hook, bend, spline_start: start.to_radians(), base: 90.0, ..LatchDesign::default() };
        let geometry = Geometry::of(&latch).unwrap();
        let profile = &geometry.profile;
        for k in 1..40 {
            let x = profile.x_end * f64::from(k) / 40.0;
            prop_assert!(profile.slope(x) < 0.0 && profile.second(x) < 0.0);
            prop_assert!(profile.height(x) < geometry.height());
        }
        prop_assert!(geometry.tangent_miss() < 1e-6);
        prop_assert!((area(&geometry.solid()) - latch.width * latch.base).abs() < 1e-6);
        let solid = geometry.solid();
        prop_assert!(combined(&solid, &turned(&geometry, &solid), OverlayRule::Intersect) < 1e-3);
    }
}
