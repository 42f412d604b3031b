//! Labels compared with exact motions.

use super::*;
use crate::acceptance::Stream;
use crate::connector::Connector;
use crate::design::{Alignment, Family, FamilySpec, SourceText};
use crate::landscape::{Landscape, Resolution};
use crate::method::{descent, flood};
use crate::pose::{DofSet, PoseError};
use crate::problem::Draft;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

pub(super) fn pair_of(family: Family, free: &[Dof], cor: f64) -> Pair {
    let mut alignment = Alignment::default_for(Some(family));
    if !free.is_empty() {
        alignment.free = free.iter().copied().collect::<DofSet>();
    }
    alignment.center_of_rotation = cor;
    let connector = Connector::of_family(&FamilySpec::new(family), alignment.mount).unwrap();
    Pair::new(&connector, &alignment)
}

/// Random numbers in [0, 1), in sequence.
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let (stream, mut next) = (Stream::new(seed), 0);
    move || {
        next += 1;
        stream.uniform(next)
    }
}

/// A random box of poses in the error box, up to `most` of the range wide, and a random pose in it.
pub(super) fn random_box(pair: &Pair, most: f64, number: &mut impl FnMut() -> f64) -> (PoseBox, PoseError) {
    let (mut poses, mut error) = ([Interval::ZERO; 5], [0.0; 5]);
    for dof in pair.alignment.free.iter() {
        let (half, k) = (pair.alignment.half_range(dof), dof.index());
        let width = 2.0 * half * most * number();
        let lo = -half + (2.0 * half - width) * number();
        poses[k] = Interval::new(lo, lo + width);
        error[k] = lo + width * number();
    }
    (poses, PoseError::from_array(error))
}

impl Certified {
    /// Whether all motions of the box around a pose dock, or none; `None` if undecided.
    fn label_at(&self, error: &PoseError) -> Option<bool> {
        self.whole_label_at(error).map(|label| label == Label::Yes)
    }

    fn whole_label_at(&self, error: &PoseError) -> Option<Label> {
        let poses = error.to_array().map(Interval::thin);
        self.tree.common_label(&self.tree.places(&poses)?)
    }
}

fn certified(pair: &Pair, boxes: usize) -> Certified {
    certify(pair, &CertifiedSettings { boxes, ..CertifiedSettings::default() }, &Exec::new()).unwrap()
}

/// Number of random motions per planar design in this variable, or a small default: `docs/certified.md`
/// mentions 100 000.
fn motions() -> usize {
    std::env::var("CATCHMENT_MOTIONS").ok().and_then(|number| number.parse().ok()).unwrap_or(300)
}

/// No exact motion from a random pose contradicts its label; returns the number of labelled poses. If a step
/// of a motion ends on the other side of a ridge that falls to either side, a step of a sixteenth decides:
/// rarely.
fn contradicts_nothing(pair: &Pair, found: &Certified, poses: usize) -> usize {
    /// Largest share of motions that finer steps may have to decide: one in this many.
    const FINER: usize = 20_000;
    let (settings, mut number) = (descent::DescentSettings::default(), numbers(5));
    let finer = descent::DescentSettings { step: settings.step / 16.0, ..settings };
    let mut follower = descent::Follower::new(pair, &settings);
    let (mut labelled, mut finely) = (0, 0);
    for _ in 0..poses {
        let (_, error) = random_box(pair, 1.0, &mut number);
        if let Some(label) = found.whole_label_at(&error) {
            labelled += 1;
            let agrees = |end: &descent::End| {
                (end.outcome == Outcome::Aligned) == (label == Label::Yes)
                    && (label != Label::Jams || end.outcome == Outcome::Jammed)
            };
            let mut end = follower.follow(&error);
            if !agrees(&end) {
                finely += 1;
                end = descent::Follower::new(pair, &finer).follow(&error);
            }
            assert!(agrees(&end), "{label:?}, and {error:?} ends {end:?}");
        }
    }
    assert!(finely <= poses.div_ceil(FINER), "{finely} of {poses} by finer steps");
    labelled
}

#[test]
fn no_motion_contradicts_a_planar_certificate() {
    // Upper bounds on the undecided share, with a margin above the measured share.
    for (family, cor, boxes, most) in [
        (Family::VFace, 0.0, 8000, 0.3),
        (Family::XFace, 0.5, 12_000, 0.15),
        (Family::SFace, 0.0, 10_000, 0.5),
    ] {
        let pair = pair_of(family, &[], cor);
        let found = certified(&pair, boxes);
        let BoxCertificate { yes, no, undecided, retention_at_least, retention_at_most, .. } =
            found.certificate;
        assert!((yes + no + undecided - 1.0).abs() < 1e-9, "{:?}", found.certificate);
        assert!(undecided < most && yes > 0.02, "{family:?} {:?}", found.certificate);
        let motions = motions();
        assert!(contradicts_nothing(&pair, &found, motions) > motions / 3);
        // The upper bound may be missing: it needs boxes along a whole escape path.
        assert!(retention_at_least > 0.0, "{family:?} {retention_at_least}");
        assert!(retention_at_most.is_none_or(|most| most >= retention_at_least));
    }
}

/// The other designs whose shares are in the guide: other slopes, another centre, spatial halves over two
/// errors and three, a dock of the gallery.
#[test]
fn no_motion_contradicts_the_other_certificates() {
    let planar = |aspect_ratio: f64, cor: f64| {
        let mut alignment = Alignment::default_for(Some(Family::XFace));
        alignment.center_of_rotation = cor;
        let spec = FamilySpec::new(Family::XFace).with_aspect_ratio(aspect_ratio);
        Pair::new(&Connector::of_family(&spec, alignment.mount).unwrap(), &alignment)
    };
    let [x, y, yaw] = [Dof::X, Dof::Y, Dof::Yaw];
    let charger = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/gallery/pyramid-charger.toml");
    let charger = Draft::open(&charger).and_then(Draft::build).unwrap();
    // A longer test run (more motions) uses more boxes, too.
    let motions = motions();
    let more = if motions > 1000 { 16 } else { 1 };
    for (pair, boxes, least) in [
        (&planar(2.0, 0.5), 10_000, 0.2),
        (&planar(0.25, 0.5), 10_000, 0.2),
        (&planar(1.0, 0.0), 5000, 0.2),
        (&pair_of(Family::XFace3d, &[x, y], 0.0), 2500, 0.5),
        (&narrow(Family::XFace3d, 0.0, &[(x, 0.5), (y, 0.5), (yaw, 0.52)]), 12_000, 0.02),
        // Its border takes hundreds of thousands of boxes.
        (charger.pair(), 5000, 0.0),
    ] {
        let found = certified(pair, more * boxes);
        let labelled = contradicts_nothing(pair, &found, motions);
        assert!(
            labelled as f64 >= least * motions as f64,
            "{labelled} of {motions}: {:?}",
            found.certificate
        );
    }
}

/// Poses left open by the budget are undecided, and no label is wrong.
#[test]
fn a_time_budget_ends_certification() {
    let pair = pair_of(Family::VFace, &[], 0.0);
    let settings = CertifiedSettings { boxes: usize::MAX, gap: 0.0, budget_s: Some(0.3) };
    let found = certify(&pair, &settings, &Exec::new()).unwrap();
    assert!(found.certificate.undecided > 0.0, "{:?}", found.certificate);
    contradicts_nothing(&pair, &found, 300);
}

/// A half that slides off beside its seat, out of the error box, is not jammed.
#[test]
fn nothing_jams_where_all_slides_off() {
    for (family, free) in [(Family::VFace, &[Dof::X][..]), (Family::Pyramid, &[Dof::X, Dof::Y])] {
        let pair = pair_of(family, free, 0.0);
        let found = certified(&pair, 4000);
        assert!(contradicts_nothing(&pair, &found, 300) > 200);
    }
}

/// In translation the pyramid leaves its socket when its tip is at the rim: lifted by the depth H.
#[test]
fn the_escape_height_of_the_pyramid_is_its_depth() {
    let pair = pair_of(Family::Pyramid, &[Dof::X, Dof::Y], 0.0);
    let found = certified(&pair, 20_000);
    let depth = FamilySpec::new(Family::Pyramid).aspect_ratio();
    let BoxCertificate { retention_at_least: least, retention_at_most: most, yes, .. } = found.certificate;
    let most = most.unwrap();
    assert!(
        least <= depth + 1e-9 && depth <= most + 1e-9 && most - least < 0.2 * depth,
        "{least} {depth} {most}"
    );
    // The captured set is the open square |x|, |y| < 1/2: a quarter of the error box. The undecided part
    // shrinks to its border.
    assert!(
        yes <= 0.25 + 1e-9 && yes > 0.23 && found.certificate.undecided <= 0.02,
        "{:?}",
        found.certificate
    );
    assert!(contradicts_nothing(&pair, &found, 1000) > 900);
}

/// A pair of which these errors go so far, all others are locked.
fn narrow(family: Family, cor: f64, ranges: &[(Dof, f64)]) -> Pair {
    let mut alignment = Alignment::default_for(Some(family));
    alignment.free = ranges.iter().map(|(dof, _)| *dof).collect::<DofSet>();
    alignment.center_of_rotation = cor;
    for (dof, range) in ranges {
        alignment.half_ranges[dof.index()] = *range;
    }
    let connector = Connector::of_family(&FamilySpec::new(family), alignment.mount).unwrap();
    Pair::new(&connector, &alignment)
}

/// Everything docks from as near as that, and is certain to.
#[test]
fn all_of_a_box_of_three_errors_docks() {
    let pair = narrow(Family::Pyramid, 0.0, &[(Dof::X, 0.4), (Dof::Y, 0.4), (Dof::Yaw, 0.35)]);
    let found = certified(&pair, 20_000);
    assert!(found.certificate.undecided <= 0.05 && found.certificate.no == 0.0, "{:?}", found.certificate);
    assert!(contradicts_nothing(&pair, &found, 300) > 280);
}

/// A border through a box of three errors: motions that slide off along it are decided by their progress
/// across the errors.
#[test]
fn a_border_in_three_errors_is_reported() {
    let pair = narrow(Family::Pyramid, 0.0, &[(Dof::X, 0.6), (Dof::Y, 0.6), (Dof::Yaw, 0.35)]);
    let found = certified(&pair, 70_000);
    let BoxCertificate { yes, no, undecided, .. } = found.certificate;
    assert!(yes > 0.6 && no > 0.2 && undecided < 0.12, "{:?}", found.certificate);
    let motions = motions();
    assert!(contradicts_nothing(&pair, &found, motions) > motions * 8 / 10);
}

/// Trials of an independent engine end in agreement with the labels of their boxes.
#[test]
fn no_engine_trial_contradicts_the_labels() {
    for (file, boxes, least) in
        [("x-face-3d-cor0-xy.json", 8000, 150), ("pyramid-ar1-cor0-xyyaw.json", 20_000, 10)]
    {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reference/mujoco").join(file);
        let set: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let family = Family::ALL.into_iter().find(|family| set["family"] == family.name()).unwrap();
        let mut alignment = Alignment::default_for(Some(family));
        let free = set["free"].as_array().unwrap().iter();
        alignment.free = free.map(|name| name.as_str().unwrap().parse::<Dof>().unwrap()).collect();
        alignment.center_of_rotation = set["center_of_rotation"].as_f64().unwrap();
        alignment.rotation_length = set["rotation_length"].as_f64().unwrap();
        let spec = FamilySpec::new(family).with_aspect_ratio(set["aspect_ratio"].as_f64().unwrap());
        let pair = Pair::new(&Connector::of_family(&spec, alignment.mount).unwrap(), &alignment);
        let found = certified(&pair, boxes);
        let mut labelled = 0;
        for row in set["poses"].as_array().unwrap() {
            let error = PoseError::from_array(std::array::from_fn(|k| row[k].as_f64().unwrap()));
            let outcome = row[5].as_str().unwrap();
            if let Some(docks) = found.label_at(&error).filter(|_| outcome != "undecided") {
                labelled += 1;
                assert_eq!(outcome == "aligned", docks, "{file} {error:?}: {outcome}");
            }
        }
        assert!(labelled > least, "{file}: {labelled}");
    }
}

/// The lowest exit from the seat on a grid lies between its certified bounds, up to the height difference
/// between cells.
#[test]
fn the_merge_tree_escape_lies_between_the_bounds() {
    let translations = [Dof::X, Dof::Y];
    for (family, free, cor) in
        [(Family::VFace, &[][..], 0.0), (Family::XFace, &[], 0.5), (Family::Pyramid, &translations, 0.0)]
    {
        let pair = pair_of(family, free, cor);
        let BoxCertificate { retention_at_least: least, retention_at_most: most, .. } =
            certified(&pair, 8000).certificate;
        let grid =
            Resolution::uniform(200).unwrap().grid(&pair.alignment, &Resolution::DEFAULT_CELLS).unwrap();
        let landscape = Landscape::compute(&pair, &grid, &Exec::new()).unwrap();
        let docks = flood::docks(&pair, &grid);
        let settings = flood::FloodSettings::default();
        let flooding = flood::flood(&landscape, &pair.alignment, &docks, &settings, &Exec::new()).unwrap();
        let basins = &flooding.hierarchy.basins;
        let seat = basins.iter().find(|basin| basin.outcome == Outcome::Aligned).unwrap();
        let pass = seat.height + seat.escape - pair.mated_height();
        // Slopes are 1 at most here, in the metric.
        let step = |axis: &crate::landscape::GridAxis| {
            axis.step() * if axis.dof.is_rotation() { pair.alignment.rotation_length } else { 1.0 }
        };
        let between: f64 = 2.0 * grid.axes.iter().map(step).sum::<f64>();
        assert!(
            least - between <= pass && most.is_none_or(|most| pass <= most + between),
            "{family:?}: {least} {pass} {most:?} {between}"
        );
    }
}

/// With all five errors free boxes are too many, but the neighbourhood of the mated pose is certain, and with it a part of the set that has a volume.
#[test]
fn five_errors_have_a_certified_inner_set() {
    let pair = pair_of(Family::Pyramid, &[], 0.5);
    let bodies = Bodies::of(&pair);
    let root = pair.alignment.half_ranges.map(|range| Interval::new(-range, range));
    let home = Home::find(&bodies, &root, pair.mated_height(), &mut pair.about(REACH), &Exec::new());
    let home = home.unwrap().unwrap();
    let (mut number, mut nearby) = (numbers(3), pair.about(REACH));
    let settings = descent::DescentSettings::default();
    let mut follower = descent::Follower::new(&pair, &settings);
    for k in 0..200 {
        // On its border the height is no less than its level, and within all motions dock that begin below that.
        let mut error: [f64; 5] = home.poses.map(|range| range.up * (2.0 * number() - 1.0));
        error[k % 5] = home.poses[k % 5].up;
        let height = nearby.height(&PoseError::from_array(error)).unwrap();
        assert!(height >= home.level - 1e-9, "{error:?}");
        let within = PoseError::from_array(error.map(|error| 0.1 * error));
        if nearby.height(&within).unwrap() < home.level {
            assert_eq!(follower.follow(&within).outcome, Outcome::Aligned, "{within:?}");
        }
    }
    let found = certified(&pair, 14_000).certificate;
    for _ in 0..motions() {
        let within = pair.alignment.half_ranges.map(|range| found.window * range * (2.0 * number() - 1.0));
        let end = follower.follow(&PoseError::from_array(within));
        assert_eq!(end.outcome, Outcome::Aligned, "{within:?}");
    }
    assert!(found.yes > 0.0 && found.measures[0] > 1e-16 && found.no == 0.0, "{found:?}");
    assert!(found.retention_at_least > 1e-3, "{found:?}");
}

/// A ball in a pit of eight slopes of 45°, whose rim lies H high: its centre rests √2·r above the apex, and leaves r above the rim.
#[test]
fn the_escape_height_of_a_ball_is_that_over_the_rim() {
    const SIDES: usize = 8;
    let (rim, beyond, depth, radius, chord) = (0.4, 0.6, 0.4, 0.25, 0.01);
    let wedge = |k: usize| {
        let at = |reach: f64, side: usize, z: f64| {
            let turn = std::f64::consts::TAU * (side as f64 - 0.5) / SIDES as f64;
            let reach = reach / (std::f64::consts::PI / SIDES as f64).cos();
            format!("[{}, {}, {z}]", reach * turn.cos(), reach * turn.sin())
        };
        let corners = [(rim, depth), (beyond, depth), (beyond, -0.2)];
        let corners: Vec<String> =
            corners.iter().flat_map(|(reach, z)| [at(*reach, k, *z), at(*reach, k + 1, *z)]).collect();
        format!("[[0, 0, 0], [0, 0, -0.2], {}]", corners.join(", "))
    };
    let wedges: Vec<String> = (0..SIDES).map(wedge).collect();
    let text = format!(
        "schema = 1\n[connector]\nwidth = 1.0\nunit = \"mm\"\n[[connector.fixed.parts]]\npieces = [{}]\n\
         [[connector.moving.parts]]\nsphere = {{ radius = {radius} }}\nchord_error = {chord}\n\
         [alignment]\nfree = [\"x\", \"y\"]\ncenter_of_rotation = 0.0\n[errors]\nx = 0.8\ny = 0.8\n",
        wedges.join(", ")
    );
    let problem = Draft::read(SourceText::new("ball.toml", text)).and_then(Draft::build).unwrap();
    let BoxCertificate { retention_at_least: least, retention_at_most: most, .. } =
        certified(problem.pair(), 12_000).certificate;
    let closed = depth + radius - f64::sqrt(2.0) * radius;
    // The facets of the ball lie inside it, at the contact by no more than the chord error.
    let most = most.unwrap();
    assert!(
        0.95 * closed <= least && least <= most && (most - closed).abs() <= 2.0 * chord,
        "{least} {closed} {most}"
    );
}

#[test]
fn threads_change_no_bit() {
    let pair = pair_of(Family::XFace, &[], 0.5);
    let on = |threads: usize| {
        let exec = Exec::new().with_threads(threads).unwrap();
        let found = certify(&pair, &CertifiedSettings { boxes: 3000, ..CertifiedSettings::default() }, &exec)
            .unwrap();
        let labels: Vec<_> = found
            .tree
            .cells
            .iter()
            .map(|cell| (cell.corner, cell.label, cell.height.map(|h| h.lo.to_bits())))
            .collect();
        (found.certificate, labels)
    };
    let one = on(1);
    assert!(on(2) == one && on(4) == one);
}

#[test]
fn a_cancelled_certification_ends_soon() {
    let pair = pair_of(Family::Pyramid, &[], 0.0);
    let exec = Exec::new();
    let flag = exec.cancel_flag();
    let requested = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(300));
        flag.store(true, Ordering::Relaxed);
        Instant::now()
    });
    let settings = CertifiedSettings { gap: 0.0, boxes: 10_000_000, ..CertifiedSettings::default() };
    let found = certify(&pair, &settings, &exec);
    assert!(matches!(found, Err(CertifiedError::Cancelled(_))));
    assert!(requested.join().unwrap().elapsed() < Duration::from_secs(1));
}
