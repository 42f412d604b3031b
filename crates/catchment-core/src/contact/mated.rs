//! Checks the mated pose: in it the halves must touch without overlap, and no small error may let the moving
//! half sink deeper.
//!
//! ```text
//!   h(aligned) = −cor        the face centres coincide at first contact
//!   h(aligned ⊕ ε·d) ≥ h(aligned)   for every free direction d
//! ```
//!
//! The second line is tested for every combination of signs of the free degrees of freedom. Slopes below 1 %
//! and directions far from all of these are missed: the test detects wrong geometry and proves nothing. For a
//! half in unstable balance the first order is not sufficient; exact motions from small errors decide
//! ([`LossOfSeat`]).
//!
//! The seat must also locate the half: if it leaves an error more play than the design allows, such as flat
//! on flat or the yaw of a round plug, the mated pose is not unique, and the design must state the docking
//! tolerance.

use super::Pair;
use super::display_unit::{DisplayUnit, number};
use super::play::{Play, directions, play_on, unit};
use super::side_by_side::{self, SideBySide};
use crate::design::Alignment;
use crate::exec::Exec;
use crate::pose::{Dof, DofSet, PoseError};
use crate::tolerance;
use glam::DVec2;
use std::fmt;

/// Largest distance of the aligned halves from contact, in D: above single precision and drawings rounded to
/// four digits, below any play that matters.
pub const CONTACT_TOLERANCE: f64 = tolerance::TOUCHING;
/// Length of a probe in the ρ-metric, in D: small beside any facet, so that only the facets that meet at the
/// mated pose are seen.
const PROBE: f64 = 1e-3;
/// Name of the progress stage, and the share of it for the search for a deeper pose.
const STAGE: &str = "mated pose";
const DEEPEST: f64 = 0.2;
/// An offset to write, such as this much of D.
const SUCH_AS: f64 = 0.01;
/// Slope of a descent that counts: above the curvature of a rotation over a probe (some 1e-3).
const SLOPE: f64 = 1e-2;

/// Reason why the aligned pose is not a valid mated pose. Shown with lengths in D; reports of designs use the
/// design's own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MatedProblem {
    /// The halves overlap in the aligned pose.
    Collision {
        /// Distance by which they would have to be separated, in D.
        overlap: f64,
    },
    /// The halves do not touch in the aligned pose.
    Gap {
        /// Distance between them, in D.
        gap: f64,
    },
    /// Halves that are drawn docked do not touch there.
    DrawnApart {
        /// Distance between them, in D.
        gap: f64,
    },
    /// Halves that are drawn docked are stopped before.
    DrawnDeeper {
        /// How much deeper, in D.
        overlap: f64,
    },
    /// No vertical line meets both halves.
    Apart,
    /// The halves share a vertical plane, and no area in plan view.
    SideBySide(SideBySide),
    /// The aligned pose is no local minimum of the height.
    NotMinimum {
        /// The error that lets them sink deepest among those tried.
        error: PoseError,
        /// Additional depth, in D; infinite if they pass each other by.
        sinks: f64,
    },
    /// No rest is near.
    RunsOff,
    /// The seat leaves an error free.
    Free {
        /// Which.
        dof: Dof,
        /// Lower bound on its play, D or radians.
        play: f64,
    },
    /// A half is round, and its yaw counts.
    Round {
        /// Which half.
        half: &'static str,
    },
    /// Not all that may rest in the seat counts.
    LimitCutsPlay {
        /// Which error.
        dof: Dof,
        /// Its limit, D or radians.
        limit: f64,
        /// Its play, D or radians.
        play: f64,
    },
}

impl std::error::Error for MatedProblem {}

impl fmt::Display for MatedProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words(DisplayUnit::IN_D))
    }
}

impl MatedProblem {
    /// The problem as a sentence.
    pub fn in_words(&self, display: DisplayUnit) -> String {
        match self {
            Self::Collision { overlap } => format!(
                "in the aligned pose the halves overlap by {} along the approach: check face_height, mount, and that both halves are drawn \
                 facing +z",
                display.length(*overlap)
            ),
            Self::Gap { gap } => format!(
                "in the aligned pose the halves are {} apart along the approach: check face_height and that both halves are drawn to the same \
                 scale",
                display.length(*gap)
            ),
            Self::DrawnApart { gap } => format!(
                "as drawn the halves are {} apart along the approach, which is not docked: draw them docked, check the approach, or draw each \
                 half facing +z in a frame of its own",
                display.length(*gap)
            ),
            Self::DrawnDeeper { overlap } => format!(
                "as drawn the moving half is {} deeper than it gets by a straight approach: check the approach, whether something is in the \
                 way, and whether the halves overlap",
                display.length(*overlap)
            ),
            Self::Apart => "in the aligned pose the halves pass each other by: check that both are drawn around the approach axis".to_owned(),
            Self::SideBySide(SideBySide { across, .. }) => format!(
                "in the aligned pose the halves share nothing but a plane across {}: they lie side by side, pushed together nothing carries, and the least \
                 offset apart they pass each other by",
                direction(*across)
            ),
            Self::NotMinimum { error, sinks } => {
                let sink = if sinks.is_finite() {
                    format!("sink {} deeper", display.length(*sinks))
                } else {
                    "pass each other by".to_owned()
                };
                format!(
                    "the aligned pose does not hold: with an error of {} the halves {sink}; check the mount, the centre of rotation, or lock \
                     that degree of freedom",
                    display.error(error)
                )
            }
            Self::RunsOff => "let go as drawn, the halves run off: nothing holds them near; draw them closer to how they dock, or check the \
                              approach, the mount and what is free"
                .to_owned(),
            Self::Free { dof, play } => format!(
                "the seat leaves {} free: {} off the half rests as deep as without any error",
                dof.name(),
                display.amount(*dof, *play)
            ),
            Self::Round { half } => {
                format!("rotation about z changes nothing: the {half} half is round about the approach axis (found)")
            }
            Self::LimitCutsPlay { dof, limit, play } => format!(
                "docked.{} = {} is less than the play of the seat, {}: a half may be seated and not count as docked",
                dof.name(),
                display.amount(*dof, *limit),
                display.amount(*dof, *play)
            ),
        }
    }

    /// Advice.
    pub(crate) fn help(&self, display: DisplayUnit) -> Option<String> {
        match self {
            Self::Free { dof, .. } => {
                let name = dof.name();
                let ignore =
                    if *dof == Dof::Yaw { ", dont_care = [\"yaw\"] in the place of free if it does not matter" } else { "" };
                let unit = if dof.is_rotation() { "1 deg".to_owned() } else { display.length(SUCH_AS) };
                Some(format!(
                    "say how far off still counts as docked: [docked] {name} = \"{unit}\"{ignore}, or lock it: leave {name} \
                     out of free"
                ))
            }
            Self::Round { .. } => Some(
                "leave yaw out of free and write dont_care = [\"yaw\"]; or, if its facets are meant, [docked] yaw = \"1 deg\""
                    .to_owned(),
            ),
            Self::LimitCutsPlay { .. } => Some("allow more, or draw a tighter seat".to_owned()),
            Self::SideBySide(SideBySide { across, apart }) => Some(format!(
                "move the moving half by {} along {}, so that the middles of both lie on each other: translate of a half, at of a part",
                display.length(*apart),
                direction(-*across)
            )),
            _ => None,
        }
    }
}

/// A direction in plan view: `+y`, or its parts.
fn direction(way: DVec2) -> String {
    let named = [("+x", DVec2::X), ("-x", DVec2::NEG_X), ("+y", DVec2::Y), ("-y", DVec2::NEG_Y)];
    named
        .into_iter()
        .find(|(_, axis)| axis.distance(way) < 1e-9)
        .map_or_else(|| format!("({}, {})", number(way.x), number(way.y)), |(name, _)| name.to_owned())
}

/// A rest below the seat, to which a half comes that is a little off: the aligned pose is level about it, or falls off close by.
///
/// ```text
///     ╲   ___●___   ╱     level within the probes; a half slightly off tips, and slides to the bottom
///      ╲_╱       ╲_╱
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LossOfSeat {
    /// Pose error at the release; `None` if it falls by itself.
    pub from: PoseError,
    /// Pose error of its rest.
    pub rest: PoseError,
    /// Its depth below the aligned pose, in D; infinite if it runs off.
    pub sinks: f64,
}

/// Motions of halves that are released slightly off the mated pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReleaseResult {
    /// The first that falls out of the seat.
    pub(crate) fall: Option<LossOfSeat>,
    /// Largest distance from the mated pose at which they end, in the ρ-metric; 0 if it is not known.
    pub(crate) home: f64,
}

impl LossOfSeat {
    /// The problem as a sentence.
    pub fn in_words(&self, display: DisplayUnit) -> String {
        let let_go = match self.from {
            from if from == PoseError::default() => "a half let go without any error".to_owned(),
            from => format!("a half let go with an error of {}", display.error(&from)),
        };
        let goes = if self.sinks.is_finite() {
            format!("comes to rest {} deeper, at {}", display.length(self.sinks), display.error(&self.rest))
        } else {
            "runs off".to_owned()
        };
        format!("the aligned pose does not hold: {let_go} {goes}")
    }
}

/// All reasons why the aligned pose of a pair is not a valid mated pose; empty if it is valid.
pub fn problems(pair: &Pair) -> Vec<MatedProblem> {
    problems_on(pair, &Exec::new())
}

/// The same, with its progress.
pub fn problems_on(pair: &Pair, exec: &Exec) -> Vec<MatedProblem> {
    let height = pair.mated_height();
    if let Some(found) = side_by_side::of(pair) {
        return vec![MatedProblem::SideBySide(found)];
    }
    if height == f64::NEG_INFINITY {
        return vec![MatedProblem::Apart];
    }
    let above = height + pair.alignment.center_of_rotation;
    let mut problems = Vec::new();
    if above > CONTACT_TOLERANCE {
        problems.push(MatedProblem::Collision { overlap: above });
    } else if above < -CONTACT_TOLERANCE {
        problems.push(MatedProblem::Gap { gap: -above });
    }
    problems.extend(deepest(pair, DofSet::ALL, &exec.part([0.0, DEEPEST], STAGE)));
    // The play of the seat is only defined if there is a seat.
    if problems.is_empty() {
        if let Some(half) = round_half(pair) {
            problems.push(MatedProblem::Round { half });
        } else {
            let found = play_on(pair, DofSet::ALL, &exec.part([DEEPEST, 1.0], STAGE));
            problems.extend(found.iter().filter_map(|play| loose(pair, play)));
        }
    }
    problems
}

/// The problem with the play of an error.
fn loose(pair: &Pair, found: &Play) -> Option<MatedProblem> {
    let (dof, play) = (found.axis, found.most());
    let docked = &pair.alignment.docked;
    if play <= docked.most_play(dof) {
        return None;
    }
    Some(match docked.limit(dof) {
        Some(limit) => MatedProblem::LimitCutsPlay { dof, limit, play },
        None => MatedProblem::Free { dof, play },
    })
}

/// A half that is round in the region in which it can meet the other, if yaw counts without a docking
/// tolerance in the design.
pub fn round_half(pair: &Pair) -> Option<&'static str> {
    let Alignment { free, dont_care, docked, .. } = &pair.alignment;
    if !free.contains(Dof::Yaw) || dont_care.contains(Dof::Yaw) || docked.limit(Dof::Yaw).is_some() {
        return None;
    }
    let ([_, top], [bottom, _]) = (pair.fixed.span(), pair.moving.span());
    let height = pair.mated_height();
    if pair.moving.is_round([f64::NEG_INFINITY, top - height]) {
        return Some("moving");
    }
    pair.fixed.is_round([bottom + height, f64::INFINITY]).then_some("fixed")
}

/// Whether an error in some of the free degrees of freedom lets the aligned half sink deeper.
pub(crate) fn sinking(pair: &Pair, among: DofSet) -> Option<MatedProblem> {
    deepest(pair, among, &Exec::new())
}

/// The probe that sinks deepest, if it sinks more than rounding and curvature explain.
fn deepest(pair: &Pair, among: DofSet, exec: &Exec) -> Option<MatedProblem> {
    let aligned = pair.mated_energy();
    let matters = |dof: &Dof| among.contains(*dof) && !pair.alignment.dont_care.contains(*dof);
    let free: Vec<Dof> = pair.alignment.free.iter().filter(matters).collect();
    let mut nearby = pair.about(PROBE);
    let mut worst: Option<(f64, PoseError)> = None;
    let all = 3usize.pow(free.len() as u32);
    for (tried, signs) in directions(free.len()).enumerate() {
        exec.report(tried as f64 / all as f64, STAGE);
        let count = signs.iter().filter(|s| **s != 0.0).count();
        let mut error = [0.0; 5];
        for (dof, sign) in free.iter().zip(&signs) {
            error[dof.index()] = sign * PROBE / (count as f64).sqrt() / unit(pair, *dof);
        }
        let error = PoseError::from_array(error);
        if nearby.is_above(&error, aligned - SLOPE * PROBE) {
            continue;
        }
        // Passing by altogether is the deepest fall there is.
        let sinks = nearby.energy(&error).map_or(f64::INFINITY, |energy| aligned - energy);
        if sinks > SLOPE * PROBE && worst.is_none_or(|(most, _)| sinks > most) {
            worst = Some((sinks, error));
        }
    }
    worst.map(|(sinks, error)| MatedProblem::NotMinimum { error, sinks })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::family::{PinHole, XFace3dLocking};
    use crate::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec, HalfSpec, OwnSpec};
    use crate::pose::Mount;

    fn design(connector: ConnectorSpec, mount: Mount, free: DofSet, cor: f64) -> Design {
        let alignment = Alignment { center_of_rotation: cor, ..Alignment::new(free, mount) };
        Design { name: "test".into(), connector, width: 1.0, unit: None, alignment }
    }

    fn pair(design: &Design) -> Pair {
        Pair::new(&Connector::build(design).unwrap(), &design.alignment)
    }

    fn family(spec: FamilySpec, cor: f64) -> Design {
        let planar = spec.family().is_planar();
        let free = match spec.family() {
            _ if planar => [Dof::X, Dof::Pitch].into_iter().collect(),
            Family::Cone => DofSet::ALL.without(Dof::Yaw),
            _ => DofSet::ALL,
        };
        let mount = if planar { Mount::Y } else { Mount::X };
        design(ConnectorSpec::Family(spec), mount, free, cor)
    }

    #[test]
    fn every_family_is_mated() {
        let coarse = |family| FamilySpec::new(family).with_chord_error(0.05);
        let mut specs: Vec<FamilySpec> = Family::ALL.into_iter().map(coarse).collect();
        specs.push(XFace3dLocking { draft_angle: 0.2, ..XFace3dLocking::DEFAULT }.into());
        let pins = PinHole { hermaphroditic: true, chamfer: 0.05, chord_error: 0.05, ..PinHole::DEFAULT };
        specs.push(pins.into());
        specs.extend(
            [Family::VFace, Family::SFace, Family::XFace, Family::Pyramid]
                .map(|f| coarse(f).with_base_thickness(Some(0.5))),
        );
        for spec in specs {
            for cor in [-0.5, 0.0, 0.5, 1.0] {
                assert_eq!(problems(&pair(&family(spec, cor))), [], "{spec:?} {cor}");
            }
        }
    }

    #[test]
    fn a_wrong_face_height_is_a_collision_or_a_gap() {
        let block = |z: f64| {
            let corner = |i: u8| [f64::from(i & 1) - 0.5, f64::from(i >> 1 & 1) - 0.5, z * f64::from(i >> 2)];
            HalfSpec::Pieces(vec![(0..8).map(corner).collect()])
        };
        for (face_height, expected) in [(0.2, 0.2), (0.3, 0.0), (0.4, -0.2)] {
            let own = OwnSpec::new(face_height, block(0.3), block(0.3));
            let free = DofSet::EMPTY.with(Dof::X);
            let found = problems(&pair(&design(ConnectorSpec::Own(own), Mount::X, free, 0.0)));
            match found[..] {
                // Flat on flat slides: x is free.
                [MatedProblem::Free { dof: Dof::X, .. }] => assert_eq!(expected, 0.0),
                [MatedProblem::Collision { overlap }] => assert!((overlap - expected).abs() < 1e-14),
                [MatedProblem::Gap { gap }] => assert!((gap + expected).abs() < 1e-14),
                _ => panic!("{found:?}"),
            }
        }
    }

    #[test]
    fn the_wrong_mount_puts_ridges_on_ridges() {
        // Turned about y instead of x a V-notch's tip still fits; pins on a circle of three do not.
        let spec = PinHole { pins: 3, chord_error: 0.05, ..PinHole::DEFAULT };
        let mut wrong = family(spec.into(), 0.0);
        wrong.alignment.mount = Mount::Y;
        assert!(matches!(problems(&pair(&wrong))[0], MatedProblem::Collision { .. }));
    }

    #[test]
    fn a_pose_on_a_ridge_is_no_minimum() {
        // Two tips, point on point: any lateral error lets them slide past each other.
        let tip = || {
            HalfSpec::Pieces(vec![vec![
                [-0.5, -0.5, 0.0],
                [0.5, -0.5, 0.0],
                [0.5, 0.5, 0.0],
                [-0.5, 0.5, 0.0],
                [0.0, 0.0, 0.5],
            ]])
        };
        let own = OwnSpec::new(0.5, tip(), tip());
        let found = problems(&pair(&design(ConnectorSpec::Own(own), Mount::X, DofSet::ALL, 0.0)));
        assert!(matches!(found[..], [MatedProblem::NotMinimum { .. }]), "{found:?}");
    }

    /// Two blocks that end in the plane y = 0, on opposite sides of it, and the same blocks overlapping.
    #[test]
    fn halves_that_share_a_plane_alone_are_not_mated() {
        let block = |y: [f64; 2]| {
            let corner =
                |i: u8| [f64::from(i & 1) - 0.5, y[usize::from(i >> 1 & 1)], 0.3 * f64::from(i >> 2)];
            HalfSpec::Pieces(vec![(0..8).map(corner).collect()])
        };
        // Mounted by half a turn about x, the moving half lies at −y.
        let found = |moving: [f64; 2]| {
            let own = OwnSpec::new(0.3, block([0.0, 0.4]), block(moving));
            problems(&pair(&design(ConnectorSpec::Own(own), Mount::X, DofSet::EMPTY.with(Dof::Yaw), 0.0)))
        };
        let [MatedProblem::SideBySide(SideBySide { across, apart })] = found([0.0, 0.4])[..] else {
            panic!("{:?}", found([0.0, 0.4]))
        };
        assert_eq!(across, DVec2::NEG_Y);
        assert!((apart - 0.4).abs() < 1e-15);
        let help = found([0.0, 0.4])[0].help(DisplayUnit::IN_D).unwrap();
        assert!(help.contains("by 0.4 D along +y"), "{help}");
        assert!(!found([-0.4, 0.0]).iter().any(|problem| matches!(problem, MatedProblem::SideBySide(_))));
        // A hundredth of a millimetre of 50 is an area.
        assert!(!found([-2e-4, 0.4]).iter().any(|problem| matches!(problem, MatedProblem::SideBySide(_))));
    }

    #[test]
    fn halves_beside_each_other_never_meet() {
        let block = |x: f64| {
            let corner =
                |i: u8| [x + 0.2 * f64::from(i & 1), f64::from(i >> 1 & 1) - 0.5, 0.3 * f64::from(i >> 2)];
            HalfSpec::Pieces(vec![(0..8).map(corner).collect()])
        };
        let own = OwnSpec::new(0.3, block(-0.5), block(0.3));
        let found = problems(&pair(&design(ConnectorSpec::Own(own), Mount::X, DofSet::ALL, 0.0)));
        assert_eq!(found, [MatedProblem::Apart]);
    }
}
