//! The trees compared with the list of all elements, bit for bit, and with the brute-force reference.

use super::*;
use crate::connector::{Connector, Half, HalfSource, convex_hull};
use crate::contact::candidates::{Candidates, FLUSH, Sieve};
use crate::contact::turned::Turned;
use crate::contact::{Contact, HeightEnvelope, Lattice, Meeting, brute, meshes};
use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use crate::pose::{CorPose, DofSet, Mount, rotation};
use proptest::prelude::*;

/// The pair with trees, however small it is.
fn with_trees(connector: &Connector) -> Pair {
    let mut pair = Pair::new(connector, &Alignment::new(DofSet::ALL, Mount::X));
    pair.trees = Some(Trees::over(&pair.fixed_shapes, &pair.moving_shapes));
    pair
}

fn funnel(count: usize) -> Pair {
    let [fixed, moving] = meshes::funnel(count).map(HalfSource::Triangles);
    with_trees(&Connector::from_sources(&fixed, &moving, 0.0, Mount::X).unwrap())
}

fn family(family: Family) -> Pair {
    let spec = ConnectorSpec::Family(FamilySpec::new(family).with_chord_error(0.02));
    let alignment = Alignment::new(DofSet::ALL, Mount::X);
    let design = Design { name: String::new(), connector: spec, width: 1.0, unit: None, alignment };
    with_trees(&Connector::build(&design).unwrap())
}

/// Halves of tetrahedra that cross each other.
fn soup(corners: &[[f64; 3]]) -> Pair {
    let hull =
        |four: &[[f64; 3]]| convex_hull(&four.iter().map(|p| DVec3::from_array(*p)).collect::<Vec<_>>()).ok();
    let half = |corners: &[[f64; 3]]| Half::of(corners.chunks_exact(4).filter_map(hull).collect());
    let (fixed, moving) = corners.split_at(corners.len() / 2);
    with_trees(&Connector::from_halves(half(fixed), half(moving)))
}

/// The pair at a given rotation: by the list of all elements, and by its trees.
fn both<'a>(pair: &'a Pair, rotation: &DMat3, counts: Counts) -> [Turned<'a>; 2] {
    let mut listed = Turned::new(pair);
    let mut candidates = Candidates::default();
    let sieve = Sieve { slack: counts.slack, lowest: counts.lowest, skin: 0.0, window: None };
    candidates.collect(pair, rotation, &sieve);
    listed.turn(rotation, &candidates, counts);
    let mut searched = Turned::new(pair);
    searched.turn_trees(rotation, pair.trees.as_ref().unwrap(), counts);
    [listed, searched]
}

fn contacts(turned: &mut Turned<'_>, position: DVec3, reach: f64) -> Vec<(Contact, Meeting)> {
    let mut out = Vec::new();
    turned.contacts(position, Gaps::within(reach), SEAM, |contact| out.push(contact));
    out
}

fn poses(lateral: f64, turn: f64) -> impl Strategy<Value = CorPose> {
    (proptest::array::uniform2(-lateral..lateral), proptest::array::uniform3(-turn..turn))
        .prop_map(|(at, [r, p, w])| CorPose { lateral: DVec2::from_array(at), rotation: rotation(r, p, w) })
}

/// Heights, heights below a ceiling, and contacts are those of the list.
fn agree(pair: &Pair, pose: &CorPose, slack: f64, reach: f64, below: f64) -> Result<(), TestCaseError> {
    let heights = Counts { slack: FLUSH, lowest: VERTICAL };
    let [mut listed, mut searched] = both(pair, &pose.rotation, heights);
    let whole = listed.height_below(pose.lateral, f64::INFINITY);
    prop_assert_eq!(searched.height_below(pose.lateral, f64::INFINITY), whole);
    let Some(z) = whole.0 else { return Ok(()) };
    let ceiling = z - below;
    let expected = listed.height_below(pose.lateral, ceiling);
    // The second call tries the previous active contacts first.
    prop_assert_eq!(searched.height_below(pose.lateral, ceiling), expected);
    prop_assert_eq!(searched.height_below(pose.lateral, ceiling), expected);
    for level in [z - 1e-3, z, z + 1e-3] {
        prop_assert_eq!(searched.height_about(pose.lateral, ceiling, level), expected);
        prop_assert_eq!(searched.height_about(pose.lateral, f64::INFINITY, level), whole);
        prop_assert_eq!(searched.is_stopped_above(pose.lateral, level), z > level);
    }
    let counts = Counts { slack: slack.max(FLUSH), lowest: -0.5 };
    let [mut listed, mut searched] = both(pair, &pose.rotation, counts);
    let position = pose.lateral.extend(z - below.min(reach));
    prop_assert_eq!(contacts(&mut searched, position, reach), contacts(&mut listed, position, reach));
    // The overlaps only, and whether there is any overlap.
    let lower = position - DVec3::Z * (0.5 * reach);
    let overlaps = |turned: &mut Turned<'_>| {
        let mut out = Vec::new();
        let gaps = Gaps { deep: reach, front: -1e-9 };
        turned.contacts(lower, gaps, SEAM, |contact| out.push(contact));
        out
    };
    prop_assert_eq!(overlaps(&mut searched), overlaps(&mut listed));
    for at in [position, lower, position - DVec3::Z * reach] {
        let by_plan = pair.overlaps_by_plan(&pose.rotation, at);
        prop_assert_eq!(pair.overlaps(&pose.rotation, at), by_plan);
    }
    prop_assert_eq!(contacts(&mut searched, position, reach), contacts(&mut listed, position, reach));
    // Elements found for a wider slack are filtered for a smaller slack.
    let fewer = Counts { slack: 0.5 * counts.slack, ..counts };
    let mut listed = both(pair, &pose.rotation, fewer)[0].clone();
    searched.turn_trees(&pose.rotation, pair.trees.as_ref().unwrap(), fewer);
    prop_assert_eq!(
        contacts(&mut searched, position, 0.5 * reach),
        contacts(&mut listed, position, 0.5 * reach)
    );
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn trees_of_families_agree_with_the_list(
        which in proptest::sample::select(Family::ALL.to_vec()), pose in poses(0.8, 1.5),
        slack in 0.0..0.1f64, reach in 0.0..0.1f64, below in 0.0..0.3f64,
    ) {
        agree(&family(which), &pose, slack, reach, below)?;
    }

    #[test]
    fn trees_of_soups_agree_with_the_list(
        corners in proptest::collection::vec(proptest::array::uniform3(-0.5..0.5f64), 8..64), pose in poses(0.6, 3.0),
        slack in 0.0..0.1f64, reach in 0.0..0.1f64, below in 0.0..0.3f64,
    ) {
        agree(&soup(&corners), &pose, slack, reach, below)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn trees_of_stretched_distant_soups_agree_with_the_list(
        corners in proptest::collection::vec(proptest::array::uniform3(-0.5..0.5f64), 8..64), pose in poses(0.6, 3.0),
        wide in proptest::array::uniform3(0.02..16.0f64), far in proptest::array::uniform3(-16.0..16.0f64),
        slack in 0.0..0.1f64, reach in 0.0..0.1f64,
    ) {
        let stretched = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k] * wide[k] + far[k]);
        let corners: Vec<[f64; 3]> = corners.iter().map(stretched).collect();
        let pair = soup(&corners);
        // Over each other, wherever they are.
        let far = DVec3::from_array(far);
        let lateral = (far - pose.rotation * far).truncate() + pose.lateral * DVec2::new(wide[0], wide[1]);
        agree(&pair, &CorPose { lateral, ..pose }, slack, reach, 0.1)?;
    }
}

#[test]
fn trees_of_a_funnel_agree_with_the_list() {
    let pair = funnel(1000);
    // Far from the mated pose, near it, and at it, with contact everywhere.
    for (size, reach) in [(1.0, 0.02), (0.3, 0.02), (1e-2, 1e-2), (1e-3, 1e-4), (1e-6, 1e-4), (0.0, 1e-5)] {
        for k in 0..6 {
            let a = f64::from(k);
            let pose = CorPose {
                lateral: DVec2::new(a.sin(), (2.0 * a).cos()) * (0.7 * size),
                rotation: rotation(size * (3.0 * a).sin(), size * (5.0 * a).cos(), size * a),
            };
            agree(&pair, &pose, 0.02 * size, reach, 0.1 * size).unwrap();
        }
    }
}

/// Steps of all lengths, back and forth: stored results equal those without storage.
fn walk(pair: &Pair, start: &CorPose, seed: f64) {
    let mut kept = Turned::new(pair);
    let (mut at, mut turn) = (start.lateral.extend(0.0), start.rotation);
    let mut seen = [0; 2];
    for k in 0..80 {
        let a = seed + f64::from(k);
        let size = 10f64.powf(-1.0 - 4.0 * (7.0 * a).sin().abs());
        let (before, was) = (at, turn);
        at += DVec3::new((3.0 * a).sin(), (5.0 * a).cos(), 0.0) * size;
        turn = rotation(size * (2.0 * a).sin(), size * (11.0 * a).cos(), size * (13.0 * a).sin()) * turn;
        let pose = CorPose { lateral: at.truncate(), rotation: turn };
        let Some(z) = pair.height(&pose) else {
            (at, turn) = (before, was);
            continue;
        };
        let counts = Counts { slack: 0.1 * size, lowest: if k % 9 == 4 { -2.0 } else { -0.5 } };
        let [mut listed, _] = both(pair, &turn, counts);
        kept.turn_trees(&turn, pair.trees.as_ref().unwrap(), counts);
        for (below, reach) in [(0.0, 1e-5), (0.3 * size, size), (size, 0.1)] {
            let position = pose.lateral.extend(z - below);
            let result = contacts(&mut listed, position, reach);
            assert_eq!(contacts(&mut kept, position, reach), result, "step {k}");
            let overlap = pair.overlaps_by_plan(&turn, position);
            assert_eq!(kept.overlaps(&turn, position), overlap, "step {k}");
            seen = [seen[0] + result.len(), seen[1] + usize::from(overlap)];
        }
        // A step that is tried is taken back now and then.
        if k % 3 == 0 {
            (at, turn) = (before, was);
        }
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}

#[test]
fn cached_neighbourhoods_agree_with_the_list() {
    for seed in 0..8 {
        let seed = 0.37 * f64::from(seed);
        let start = CorPose { lateral: DVec2::new(0.1, -0.05), rotation: rotation(0.05, 0.1, 0.2) };
        walk(&funnel(300), &start, seed);
        for which in [Family::Pyramid, Family::PinHole, Family::XFace3dLocking] {
            walk(&family(which), &start, seed);
        }
    }
}

#[test]
fn funnel_heights_agree_with_brute_force() {
    let pair = funnel(1000);
    for k in 0..4 {
        let a = f64::from(k);
        let pose = CorPose {
            lateral: DVec2::new(0.2 * a.sin(), 0.1 * a.cos()),
            rotation: rotation(0.3 * (3.0 * a).sin(), 0.2 * a.cos(), a),
        };
        let (fast, slow) = (pair.height(&pose).unwrap(), brute::height(&pair, &pose).unwrap());
        assert!((fast - slow).abs() < 1e-11, "{fast} against {slow}");
    }
}

#[test]
fn lattice_heights_by_tree_and_list_agree() {
    let mut pair = funnel(300);
    let turn = rotation(0.1, -0.2, 0.3);
    let lattice = |first: f64| Lattice { first, step: 0.11, count: 14 };
    let (x, y) = (lattice(-0.7), lattice(-0.65));
    let cells = x.count * y.count;
    let mut solve = |lists: bool| {
        pair.lists = lists;
        let (mut single, mut heights, mut carriers) = (vec![0.0; cells], vec![0.0; cells], vec![0; cells]);
        let mut envelope = pair.at_rotation(turn);
        envelope.heights(x, y, &mut single);
        envelope.heights_and_carriers(x, y, &mut heights, &mut carriers);
        assert_eq!(single, heights);
        let at = |k: usize| DVec2::new(x.at(k % x.count), y.at(k / x.count));
        let carried = |(k, carrier): (usize, &u32)| {
            (*carrier != HeightEnvelope::NOTHING).then(|| envelope.carried_by(*carrier, at(k)))
        };
        (heights, carriers.iter().enumerate().map(carried).collect::<Vec<_>>())
    };
    let (listed, by_list) = solve(true);
    let (searched, by_search) = solve(false);
    assert!(listed.iter().filter(|h| h.is_finite()).count() > cells / 4);
    for k in 0..cells {
        // Rounding of a plane along a row.
        assert!(listed[k] == searched[k] || (listed[k] - searched[k]).abs() < 1e-12);
        // Whatever carries there carries as high.
        let cor = |by: &Option<(Contact, DVec3)>| by.as_ref().map_or(f64::NEG_INFINITY, |(_, cor)| cor.z);
        assert!((cor(&by_list[k]).max(-9.0) - cor(&by_search[k]).max(-9.0)).abs() < 1e-12);
    }
}
