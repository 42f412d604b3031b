//! Heights of first contact and descents of committed designs: the unit of work of every method.

mod designs;
mod meshes;
mod rates;

use catchment_core::acceptance::{Domain, Outcome};
use catchment_core::connector::{Connector, HalfSource};
use catchment_core::contact::{Lattice, Pair, brute, mated};
use catchment_core::design::Alignment;
use catchment_core::method::descent;
use catchment_core::pose::{CorPose, Dof, DofSet, Mount, PoseError, rotation};
use designs::pair;
use glam::{DMat3, DVec2};
use rates::Rates;
use std::hint::black_box;

/// Cells per side of a slice.
const SIDE: usize = 24;
/// Random poses followed.
const POSES: usize = 64;

fn main() {
    let mut rates = Rates::of("contact");
    for name in ["v-face", "pyramid", "x-face-3d", "cone"] {
        let pair = pair(&format!("{name}.toml"));
        slice(&mut rates, name, &pair);
        one_height(&mut rates, name, &pair);
    }
    for name in ["v-face", "pyramid", "x-face-3d"] {
        let pair = pair(&format!("{name}.toml"));
        descents(&mut rates, &format!("random poses of {name}"), &pair, 0.0);
        descents(&mut rates, &format!("friction 0.2, random poses of {name}"), &pair, 0.2);
    }
    for count in FACETS {
        lathed(&mut rates, &format!("a funnel of {count}"), || meshes::funnel(count));
    }
    lathed(&mut rates, "a cone of 960 slivers", || meshes::cone(160));
    rates.finish();
}

/// Triangles per half of the funnels: a list and trees, and how time grows with ten times as many.
const FACETS: [usize; 3] = [1_000, 10_000, 100_000];
/// Poses of a funnel whose heights are computed, and the number of these that are followed.
const HEIGHTS: usize = 50;
const MOTIONS: usize = 10;

/// A filleted funnel as CAD exports it, or a cone: the whole check, heights of first contact, motions. Heights are the judge's at a thousand
/// triangles, which the tests of the room hold.
fn lathed(rates: &mut Rates, name: &str, halves: impl Fn() -> [meshes::Triangles; 2]) {
    let build = || {
        let [fixed, moving] = halves().map(HalfSource::Triangles);
        let connector = Connector::from_sources(&fixed, &moving, 0.0, Mount::X).expect("sound meshes");
        let alignment = Alignment::new(DofSet::ALL.without(Dof::Yaw), Mount::X);
        let pair = Pair::new(&connector, &alignment);
        assert_eq!(mated::problems(&pair), [], "the plug is seated");
        pair
    };
    let pair = build();
    // A third of the error box: where most poses touch.
    let poses: Vec<PoseError> = match Domain::random(&pair.alignment, HEIGHTS, 1) {
        Domain::Poses(poses) => {
            poses.iter().map(|e| PoseError::from_array(e.to_array().map(|x| x / 3.0))).collect()
        }
        Domain::Grid(_) => Vec::new(),
    };
    let placed =
        |e: &PoseError| CorPose::from_error(e, pair.alignment.center_of_rotation, pair.alignment.free);
    let heights = || poses.iter().map(|e| pair.height(&placed(e))).collect::<Vec<_>>();
    let known = heights();
    rates.measure(&format!("check of {name}"), "checks", 1, &mut || drop(build()), None);
    rates.measure(
        &format!("poses of {name}"),
        "heights",
        HEIGHTS,
        &mut || assert_eq!(heights(), known),
        None,
    );
    let settings = descent::DescentSettings::default();
    rates.measure(
        &format!("random poses of {name}"),
        "descents",
        MOTIONS,
        &mut || {
            let aligned =
                |error: &&PoseError| descent::outcome(&pair, error, &settings).outcome == Outcome::Aligned;
            assert!(poses.iter().take(MOTIONS).filter(aligned).count() > 0, "none of {MOTIONS} aligned");
        },
        None,
    );
}

/// A tilted half, so that no edge is parallel to another by accident.
fn tilt(pair: &Pair) -> DMat3 {
    if pair.alignment.free.rotations() == 1 { rotation(0.0, 0.3, 0.0) } else { rotation(0.2, -0.3, 0.4) }
}

/// One rotation, all lateral positions: the unit of work of every grid method.
fn slice(rates: &mut Rates, name: &str, pair: &Pair) {
    let lattice = Lattice { first: -1.0, step: 2.0 / (SIDE - 1) as f64, count: SIDE };
    let heights = |out: &mut [f64]| pair.at_rotation(tilt(pair)).heights(lattice, lattice, out);
    let mut known = vec![0.0; SIDE * SIDE];
    heights(&mut known);
    let mut fast = known.clone();
    rates.measure(
        &format!("slice of {SIDE} × {SIDE}, {name}"),
        "heights",
        SIDE * SIDE,
        &mut || heights(black_box(&mut fast)),
        Some(&mut || {
            for (k, fast) in known.iter().enumerate() {
                let lateral = DVec2::new(lattice.at(k % SIDE), lattice.at(k / SIDE));
                let pose = CorPose { lateral, rotation: tilt(pair) };
                let slow = brute::height(pair, &pose).unwrap_or(f64::NEG_INFINITY);
                assert!(*fast == slow || (fast - slow).abs() < 1e-11, "the judge disagrees");
            }
        }),
    );
}

/// One pose at a new rotation.
fn one_height(rates: &mut Rates, name: &str, pair: &Pair) {
    let pose = CorPose { lateral: DVec2::new(0.1, 0.0), rotation: tilt(pair) };
    let height = || pair.height(black_box(&pose)).expect("they meet");
    let known = height();
    rates.measure(
        &format!("each at a new rotation, {name}"),
        "heights",
        1,
        &mut || assert_eq!(height(), known),
        Some(&mut || {
            let slow = brute::height(pair, &pose).expect("they meet");
            assert!((known - slow).abs() < 1e-11, "the judge disagrees");
        }),
    );
}

/// Motions from first contact to their end, from random poses, on one thread. There is no slower way to follow a pose
/// here; rigid-body engines take 27 to 80 ms for one.
fn descents(rates: &mut Rates, name: &str, pair: &Pair, friction: f64) {
    let poses = match Domain::random(&pair.alignment, POSES, 1) {
        Domain::Poses(poses) => poses,
        Domain::Grid(_) => Vec::new(),
    };
    let settings = descent::DescentSettings::with_friction(friction).expect("a coefficient of friction");
    rates.measure(
        name,
        "descents",
        POSES,
        &mut || {
            let aligned = |error| descent::outcome(pair, error, &settings).outcome == Outcome::Aligned;
            let count = poses.iter().filter(|error| aligned(error)).count();
            assert!((POSES / 32..POSES).contains(&count), "{name}: {count} of {POSES} aligned");
        },
        None,
    );
}
