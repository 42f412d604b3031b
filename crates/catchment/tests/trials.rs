//! `descent` against an independent rigid-body engine: the committed trial sets of `reference/mujoco`.
//!
//! The engine integrates masses, soft contacts and time; catchment does not. Where both describe frictionless,
//! overdamped docking they must agree, except for poses on the border of the accepted set.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

use catchment::acceptance::{Domain, Outcome};
use catchment::connector::Connector;
use catchment::contact::Pair;
use catchment::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec};
use catchment::exec::Exec;
use catchment::method::descent::{self, DescentSettings};
use catchment::pose::{Dof, DofSet, PoseError};
use std::path::Path;

/// One set of trials: the pair, and per pose whether the engine aligned it (`None`: undecided).
struct Trials {
    name: String,
    pair: Pair,
    poses: Vec<PoseError>,
    aligned: Vec<Option<bool>>,
}

fn read(file: &str) -> Trials {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/mujoco").join(file);
    let set: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let number = |key: &str| set[key].as_f64().unwrap();
    let family = Family::ALL.into_iter().find(|f| f.name() == set["family"].as_str().unwrap()).unwrap();
    let free: DofSet = set["free"]
        .as_array()
        .unwrap()
        .iter()
        .map(|name| name.as_str().unwrap().parse::<Dof>().unwrap())
        .collect();
    let mut alignment = Alignment::default_for(Some(family));
    alignment.free = free;
    alignment.center_of_rotation = number("center_of_rotation");
    alignment.rotation_length = number("rotation_length");
    let spec = FamilySpec::new(family).with_aspect_ratio(number("aspect_ratio"));
    let name = set["name"].as_str().unwrap().to_owned();
    let design = Design {
        name: name.clone(),
        connector: ConnectorSpec::Family(spec),
        width: 1.0,
        unit: None,
        alignment,
    };
    let pair = Pair::new(&Connector::build(&design).unwrap(), &design.alignment);
    let rows = set["poses"].as_array().unwrap();
    let poses = rows
        .iter()
        .map(|row| PoseError::from_array(std::array::from_fn(|k| row[k].as_f64().unwrap())))
        .collect();
    let aligned = rows
        .iter()
        .map(|row| match row[5].as_str().unwrap() {
            "undecided" => None,
            outcome => Some(outcome == "aligned"),
        })
        .collect();
    Trials { name, pair, poses, aligned }
}

const SETS: [&str; 4] = [
    "pyramid-ar0.5-cor0.5-5d.json",
    "pyramid-ar1-cor0-xyyaw.json",
    "x-face-3d-cor0-xy.json",
    "x-face-3d-cor0.5-5d.json",
];

impl Trials {
    fn outcomes(&self, settings: &DescentSettings) -> Vec<Outcome> {
        let domain = Domain::Poses(self.poses.clone());
        descent::run(&self.pair, domain, settings, &Exec::new()).unwrap().0.outcomes
    }

    /// Number agreeing, number decided, and the indices of the disagreeing poses.
    fn compared(&self, outcomes: &[Outcome]) -> (usize, usize, Vec<usize>) {
        let decided: Vec<usize> = (0..self.poses.len())
            .filter(|&k| self.aligned[k].is_some() && outcomes[k] != Outcome::Undecided)
            .collect();
        let differing: Vec<usize> = decided
            .iter()
            .copied()
            .filter(|&k| self.aligned[k] != Some(outcomes[k] == Outcome::Aligned))
            .collect();
        (decided.len() - differing.len(), decided.len(), differing)
    }

    /// Distance in normalised error (each axis over its half-range, Euclidean) within which the outcome of a pose flips.
    fn flips_within(&self, k: usize, accepted: bool) -> Option<f64> {
        let alignment = &self.pair.alignment;
        let free: Vec<Dof> = alignment.free.iter().collect();
        let mut result: Option<f64> = None;
        // A low-discrepancy fan of directions (multiples of irrational numbers), at growing distances.
        for radius in [0.003, 0.006, 0.01, 0.015, 0.02, 0.025, 0.03] {
            let poses: Vec<PoseError> = (1..=96)
                .map(|n| {
                    let way: Vec<f64> = (0..free.len())
                        .map(|axis| (f64::from(n) * [0.618, 0.414, 0.732, 0.236, 0.857][axis]).fract() - 0.5)
                        .collect();
                    let length = way.iter().map(|w| w * w).sum::<f64>().sqrt().max(1e-9);
                    let mut error = self.poses[k].to_array();
                    for (dof, w) in free.iter().zip(way) {
                        error[dof.index()] += radius * w / length * alignment.half_range(*dof);
                    }
                    PoseError::from_array(error)
                })
                .collect();
            let (near, _) =
                descent::run(&self.pair, Domain::Poses(poses), &DescentSettings::default(), &Exec::new())
                    .unwrap();
            if near.accepted().any(|a| a != accepted) {
                result = Some(radius);
                break;
            }
        }
        result
    }
}

#[test]
fn descent_agrees_with_the_engine() {
    let (mut agreed, mut decided) = (0, 0);
    for file in SETS {
        let trials = read(file);
        let outcomes = trials.outcomes(&DescentSettings::default());
        let (same, of, differing) = trials.compared(&outcomes);
        println!("{}: {same} of {of}", trials.name);
        // Undecided poses leave the comparison: there may be hardly any.
        assert!(of * 100 >= trials.poses.len() * 99, "{}: only {of} decided", trials.name);
        assert!(same * 100 >= of * 96, "{}: {same} of {of}", trials.name);
        for k in differing {
            let flips = trials.flips_within(k, outcomes[k] == Outcome::Aligned);
            println!("  pose {k} differs; its outcome flips within {flips:?}");
            assert!(flips.is_some(), "{}: pose {k} differs far from the border", trials.name);
        }
        agreed += same;
        decided += of;
    }
    println!("together {agreed} of {decided}");
    assert!(agreed * 100 >= decided * 98, "{agreed} of {decided}");
}

#[test]
fn the_outcome_does_not_hang_on_the_step() {
    let (mut changed, mut tried) = (0, 0);
    for file in SETS {
        let trials = read(file);
        let whole = DescentSettings::default();
        let half = DescentSettings { step: whole.step / 2.0, ..whole.clone() };
        let (a, b) = (trials.outcomes(&whole), trials.outcomes(&half));
        changed += a.iter().zip(&b).filter(|(a, b)| a != b).count();
        tried += a.len();
    }
    println!("{changed} of {tried} change when every step is halved");
    // Less than 0.5 %.
    assert!(changed * 200 < tried, "{changed} of {tried}");
}

/// The border of a thin ravine, cell by cell: the engine confirms the Sum that descent finds there.
#[test]
fn the_engine_confirms_the_v_face_border() {
    let trials = read("v-face-ar0.5-cor-0.5-border.json");
    let outcomes = trials.outcomes(&DescentSettings::default());
    let (same, of, _) = trials.compared(&outcomes);
    println!("{same} of {of} border cells");
    // Every one of these poses lies within two cells of the border, where agreement is hardest.
    assert!(same * 100 >= of * 98, "{same} of {of}");
}

/// Two methods that share no line of code: exact quasi-static motion, and a rigid-body engine with masses, springs and time
/// steps.
#[cfg(feature = "drop")]
#[test]
fn drop_tests_agree_with_descent() {
    use catchment::method::drop;
    // One pose in so many: all 1400 take half a minute on two cores.
    const EVERY: usize = 8;
    for file in SETS {
        let trials = read(file);
        let poses: Vec<PoseError> = trials.poses.iter().copied().step_by(EVERY).collect();
        let domain = || Domain::Poses(poses.clone());
        let (descents, _) =
            descent::run(&trials.pair, domain(), &DescentSettings::default(), &Exec::new()).unwrap();
        let (drops, _) =
            drop::run(&trials.pair, domain(), &drop::DropSettings::default(), &Exec::new()).unwrap();
        let same = descents.accepted().zip(drops.accepted()).filter(|(a, b)| a == b).count();
        println!("{}: {same} of {}", trials.name, poses.len());
        assert!(same * 100 >= poses.len() * 95, "{}: {same} of {}", trials.name, poses.len());
    }
}

/// Poses whose motion is hard to follow: the half hooks under the underside of the other half, or a corner slides down a groove of the
/// lip.
#[cfg(feature = "drop")]
#[test]
fn hooked_and_grooved_motions_end_as_in_the_engine() {
    use catchment::method::drop;
    use catchment::problem::{Draft, Problem};
    let hooked = [
        (0.817_864, 22.779_77),
        (0.543_887, 19.809_80),
        (0.969_283, 7.444_75),
        (0.673_686, 16.821_94),
        (0.863_748, 1.126_27),
        (0.625_980, 25.613_38),
        (0.753_163, 17.530_24),
        (0.909_508, 33.671_78),
    ];
    let hooked = hooked.map(|(x, pitch): (f64, f64)| [x, 0.0, 0.0, pitch.to_radians(), 0.0]);
    let grooved = [
        [-0.468_784, -0.517_465, 0.831_471, 1.357_515, -1.540_394],
        [0.269_530, 0.570_028, -0.710_271, -1.474_936, -0.763_855],
        [-0.608_461, -0.904_089, -0.497_139, 0.010_955, -0.854_775],
        [0.478_061, 0.589_089, 1.354_250, 0.332_078, 0.819_121],
        [-0.370_338, -0.494_176, 0.156_527, -1.323_365, 1.164_811],
        [0.453_081, 0.946_172, 0.646_107, -0.393_672, -0.777_539],
        [-0.321_661, -0.499_271, 0.922_397, -1.285_309, -0.356_993],
    ];
    let s_face =
        "[connector]\nfamily = \"s-face\"\n[alignment]\ncenter_of_rotation = -1.0\nrotation_length = 1.0\n";
    let locking = "[connector]\nfamily = \"x-face-3d-locking\"\naspect_ratio = 0.5773502691896258\nlip_height = 0.1\n\
         draft_angle = \"0 deg\"\n[alignment]\ncenter_of_rotation = 0.5\nrotation_length = 0.5\n";
    for (text, poses) in [(s_face, hooked.as_slice()), (locking, grooved.as_slice())] {
        let source = catchment::design::SourceText::new("f.toml", text);
        let problem: Problem = Draft::read(source).and_then(Draft::build).unwrap();
        let poses = || Domain::Poses(poses.iter().map(|pose| PoseError::from_array(*pose)).collect());
        let (descents, _) =
            descent::run(problem.pair(), poses(), &DescentSettings::default(), &Exec::new()).unwrap();
        let (drops, _) =
            drop::run(problem.pair(), poses(), &drop::DropSettings::default(), &Exec::new()).unwrap();
        assert_eq!(descents.outcomes, drops.outcomes, "{text}");
    }
}

/// The same with friction: Coulomb cones in every step here, and the engine's own friction there.
#[cfg(feature = "drop")]
#[test]
fn drop_tests_agree_with_friction() {
    use catchment::method::drop;
    use catchment::problem::{Draft, Problem};
    use std::f64::consts::FRAC_PI_4;
    const POSES: u32 = 25;
    let family = |name: &str, aspect_ratio: f64| {
        format!("[connector]\nfamily = \"{name}\"\naspect_ratio = {aspect_ratio}\n")
    };
    let (pyramid, saddle) = (family("pyramid", 1.0), family("x-face-3d", 0.577_350_269_189_625_8));
    let peg = include_str!("../../../designs/chamfered-peg.toml").to_owned();
    let all = [0.5, 0.5, FRAC_PI_4, FRAC_PI_4, FRAC_PI_4];
    // Above 0.25 the pyramid wedges, and soft contacts release where rigid ones do not.
    for (name, text, friction, half) in [
        ("pyramid", &pyramid, 0.1, all),
        ("pyramid", &pyramid, 0.2, all),
        ("saddle", &saddle, 0.1, all),
        ("saddle", &saddle, 0.2, all),
        ("saddle", &saddle, 0.3, all),
        ("peg", &peg, 0.1, [0.2, 0.2, 0.2, 0.2, 0.0]),
    ] {
        let source = catchment::design::SourceText::new("f.toml", text.as_str());
        let problem: Problem = Draft::read(source).and_then(Draft::build).unwrap();
        // Evenly over the error box (Roberts 2018: powers of the root of x⁶ = x + 1).
        let shares = [0.889_1f64, 0.790_6, 0.702_9, 0.625_0, 0.555_7];
        let pose = |k: u32| {
            let number = |j: usize| half[j] * (2.0 * (f64::from(k + 1) * shares[j]).fract() - 1.0);
            PoseError::from_array(std::array::from_fn(number))
        };
        let poses = || Domain::Poses((0..POSES).map(pose).collect());
        let by_motion = DescentSettings::with_friction(friction).unwrap();
        let by_drop = drop::DropSettings { friction, ..drop::DropSettings::default() };
        let (descents, _) = descent::run(problem.pair(), poses(), &by_motion, &Exec::new()).unwrap();
        let (drops, _) = drop::run(problem.pair(), poses(), &by_drop, &Exec::new()).unwrap();
        let same = descents.accepted().zip(drops.accepted()).filter(|(a, b)| a == b).count();
        println!("{name}, friction {friction}: {same} of {POSES}");
        assert!(100 * same >= 97 * POSES as usize, "{name}, friction {friction}: {same} of {POSES}");
    }
}
