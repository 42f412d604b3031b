//! Patterns of trial poses.
//!
//! ```text
//!   grid            lattice, along the border      arc, about a joint        bracket
//!   · · · · ·            · ·                        ●╮  ╲ lever L               ·      border ± distinguishable distance,
//!   · · · · ·            ○ · ·                      │ ╲  ╲                   ·──┼─·    along lines from zero
//!   · · · · ·              ○ · ·                    │  ╰──● x = −L·sin pitch     ·
//! ```
//!
//! A point belongs to a line, along which outcomes are read outwards: for a grid and a lattice along their
//! first error, for an arc at each yaw, for a bracket from zero.

use super::border::{DockingOracle, Search, random_direction};
use super::prediction::for_each;
use super::{MOST_TRIALS, TrialPlanError};
use crate::validate::LIMIT;
use catchment_core::acceptance::Stream;
use catchment_core::exec::Exec;
use catchment_core::method::descent;
use catchment_core::pose::{CorPose, Dof, PoseError, face_from_cor};
use catchment_core::problem::Problem;
use catchment_core::tolerance::SINGLE;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A pattern of poses. Lengths in D, angles in radians, lists in the order of [`Dof::ALL`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Pattern {
    /// A number of points along each error, evenly spaced up to the largest value.
    Grid {
        /// Number of points, at least 2; errors without a number stay 0.
        steps: [Option<usize>; 5],
        /// Largest value; by default the half-ranges of the error box.
        max: [Option<f64>; 5],
    },
    /// Multiples of a step.
    Lattice {
        /// Step of each error; errors without a step stay 0.
        step: [Option<f64>; 5],
        /// Largest value; by default the half-ranges of the error box.
        max: [Option<f64>; 5],
        /// Whether to keep only points within a step of the predicted border, on either side.
        along_border: bool,
    },
    /// The face rotates about a joint of the robot, which couples x and pitch.
    Arc {
        /// Distance from the joint to the face centre, in D, above 0.
        lever: f64,
        /// Angles of the joint.
        pitch: Vec<f64>,
        /// Yaw angles at which the arc is repeated.
        yaw: Vec<f64>,
    },
    /// Poses on both sides of the border, along lines from zero, and a few far from it.
    Bracket {
        /// Number of trials in total.
        trials: usize,
        /// Number of lines; by default as many as possible with two points each.
        lines: Option<usize>,
        /// Smallest useful distance to the border; never below two standard deviations of the robot.
        resolution: [Option<f64>; 5],
    },
}

/// A pose of a pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placed {
    pub(super) error: PoseError,
    pub(super) line: usize,
}

/// Results of the pattern besides its poses.
#[derive(Debug, Default)]
pub(super) struct Made {
    pub(super) poses: Vec<Placed>,
    pub(super) followed: usize,
    /// Directions along which nothing fails within the error box.
    pub(super) open: usize,
}

/// A line of a bracket: the position of its first failure, and the distance from it, on either side, at which
/// a point is decisive; as shares of the length through the error box.
struct Border {
    along: [f64; 5],
    at: f64,
    sides: [f64; 2],
}

/// How a pattern is laid out.
pub(super) struct Maker<'a> {
    pub(super) problem: &'a Problem,
    pub(super) accuracy: PoseError,
    pub(super) motions: &'a descent::DescentSettings,
    pub(super) symmetric: bool,
    pub(super) seed: u64,
}

/// Looks along a line of a bracket for its first failure.
const LOOKS: usize = 48;
/// Bisections of a border along a line: to 2⁻²⁰ of it.
const HALVINGS: usize = 20;
/// Points of a bracket are at least so many accuracies from the border: a little more than the two from which a trial decides.
const TOLD_APART: f64 = 2.02;
/// Of more than two errors the nearest border may lie in directions that were not looked in: so much farther.
const LEEWAY: f64 = 1.25;
/// How often a point that is nearer than that is moved out.
const MOVES: usize = 6;
/// One trial in this many is a control, far inside or far outside.
const CONTROLS: usize = 8;
/// Number of directions tried for each wanted line.
const TRIES: usize = 8;

impl Maker<'_> {
    pub(super) fn make(&self, pattern: &Pattern, exec: &Exec) -> Result<Made, TrialPlanError> {
        match pattern {
            Pattern::Grid { steps, max } => {
                let values = |axis: Dof| {
                    let (count, most) = (steps[axis.index()]?, self.most(axis, max));
                    let at = |k: usize| {
                        let share = k as f64 / (count - 1).max(1) as f64;
                        if self.symmetric { share * most } else { (2.0 * share - 1.0) * most }
                    };
                    Some((0..count).map(at).collect())
                };
                Ok(Made { poses: self.product(values)?, ..Made::default() })
            }
            Pattern::Lattice { step, max, along_border } => {
                let poses = self.lattice(step, max)?;
                if *along_border {
                    self.along_border(poses, step, exec)
                } else {
                    Ok(Made { poses, ..Made::default() })
                }
            }
            Pattern::Arc { lever, pitch, yaw } => self.arc(*lever, pitch, yaw),
            Pattern::Bracket { trials, lines, resolution } => self.bracket(*trials, *lines, resolution, exec),
        }
    }

    fn most(&self, axis: Dof, max: &[Option<f64>; 5]) -> f64 {
        max[axis.index()].unwrap_or_else(|| self.problem.alignment().half_range(axis))
    }

    fn lattice(
        &self,
        step: &[Option<f64>; 5],
        max: &[Option<f64>; 5],
    ) -> Result<Vec<Placed>, TrialPlanError> {
        /// A multiple that rounding puts beyond the largest is there all the same.
        const ROUNDING: f64 = 1e-9;
        let mut far = None;
        let values = |axis: Dof| {
            let step = step[axis.index()].filter(|step| *step > 0.0)?;
            let count = self.most(axis, max) / step + ROUNDING;
            if count > MOST_TRIALS as f64 {
                far = Some(axis);
                return Some(Vec::new());
            }
            let count = count.floor() as i32;
            Some((if self.symmetric { 0 } else { -count }..=count).map(|k| f64::from(k) * step).collect())
        };
        let poses = self.product(values)?;
        if far.is_some() { Err(TrialPlanError::TooMany { most: MOST_TRIALS }) } else { Ok(poses) }
    }

    /// All combinations; lines run along the first error, outwards from 0.
    fn product(
        &self,
        mut values: impl FnMut(Dof) -> Option<Vec<f64>>,
    ) -> Result<Vec<Placed>, TrialPlanError> {
        let axes: Vec<(Dof, Vec<f64>)> =
            self.problem.alignment().free.iter().filter_map(|axis| Some((axis, values(axis)?))).collect();
        if axes.is_empty() {
            return Err(TrialPlanError::Nothing);
        }
        let total = axes.iter().try_fold(1usize, |total, (_, values)| total.checked_mul(values.len()));
        let Some(total) = total.filter(|total| *total <= MOST_TRIALS) else {
            return Err(TrialPlanError::TooMany { most: MOST_TRIALS });
        };
        let along = axes[0].1.len();
        let pose = |number: usize| {
            let mut rest = number;
            let mut error = [0.0; 5];
            for (axis, values) in &axes {
                error[axis.index()] = values[rest % values.len()];
                rest /= values.len();
            }
            let backwards = usize::from(error[axes[0].0.index()] < 0.0);
            Placed { error: PoseError::from_array(error), line: 2 * (number / along) + backwards + 1 }
        };
        Ok(numbered((0..total).map(pose).collect()))
    }

    /// Only points within a step of the border.
    fn along_border(
        &self,
        poses: Vec<Placed>,
        step: &[Option<f64>; 5],
        exec: &Exec,
    ) -> Result<Made, TrialPlanError> {
        /// A point that rounding puts beyond a step is within it.
        const ROUNDING: f64 = 1e-9;
        /// Directions of a first trial may meet the border farther away than its distance by this factor.
        const OBLIQUE: f64 = 3.0;
        let steps = PoseError::from_array(step.map(Option::unwrap_or_default));
        let search = Search::new(self.problem, &steps, OBLIQUE);
        let random = Stream::new(self.seed).branch(1);
        let result = for_each(
            poses.len(),
            exec,
            || DockingOracle::new(self.problem, self.motions),
            |judge, k| {
                let before = judge.followed();
                let error = &poses[k].error;
                let docks = judge.docks(error);
                let border = search.nearest(judge, error, docks, None, random.branch(k as u64));
                let near = border.is_some_and(|border| border.sigmas <= 1.0 + ROUNDING);
                (near, judge.followed() - before)
            },
        )?;
        let kept = poses.into_iter().zip(&result).filter(|(_, (near, _))| *near).map(|(placed, _)| placed);
        Ok(Made { poses: numbered(kept.collect()), followed: result.iter().map(|(_, n)| n).sum(), open: 0 })
    }

    fn arc(&self, lever: f64, pitch: &[f64], yaw: &[f64]) -> Result<Made, TrialPlanError> {
        if !(lever.is_finite() && lever > 0.0) {
            return Err(TrialPlanError::Lever { lever });
        }
        if pitch.len().saturating_mul(yaw.len()) > MOST_TRIALS {
            return Err(TrialPlanError::TooMany { most: MOST_TRIALS });
        }
        let alignment = self.problem.alignment();
        let mut poses = Vec::new();
        for (number, yaw) in yaw.iter().enumerate() {
            for pitch in pitch {
                let turned = PoseError { pitch: *pitch, yaw: *yaw, ..PoseError::default() };
                let face = face_from_cor(&turned.rotation(), -lever);
                // A face that does not move has offset exactly 0, without rounding.
                let clean = |value: f64| if value.abs() < f64::EPSILON { 0.0 } else { value };
                let error = PoseError { x: clean(face.x), y: clean(face.y), ..turned };
                let locked = |axis: Dof| !alignment.free.contains(axis);
                let turning = [(Dof::Pitch, *pitch), (Dof::Yaw, *yaw)];
                if let Some((axis, _)) =
                    turning.into_iter().find(|(axis, value)| *value != 0.0 && locked(*axis))
                {
                    return Err(TrialPlanError::Locked { axis });
                }
                let held = CorPose::from_error(
                    &error,
                    alignment.center_of_rotation,
                    catchment_core::pose::DofSet::ALL,
                )
                .lateral;
                for (axis, off) in [(Dof::X, held.x), (Dof::Y, held.y)] {
                    if locked(axis) && off.abs() > SINGLE {
                        return Err(TrialPlanError::JointElsewhere {
                            axis,
                            lever,
                            cor: alignment.center_of_rotation,
                        });
                    }
                }
                poses.push(Placed { error, line: 2 * number + usize::from(*pitch < 0.0) + 1 });
            }
        }
        if poses.is_empty() {
            Err(TrialPlanError::Nothing)
        } else {
            Ok(Made { poses: numbered(poses), ..Made::default() })
        }
    }

    fn bracket(
        &self,
        trials: usize,
        lines: Option<usize>,
        resolution: &[Option<f64>; 5],
        exec: &Exec,
    ) -> Result<Made, TrialPlanError> {
        let controls = 2 * (trials / (2 * CONTROLS)).max(1);
        let fewest = 2 * lines.unwrap_or(1) + controls;
        if trials < fewest || lines == Some(0) {
            return Err(TrialPlanError::TooFew { trials, fewest });
        }
        if trials > MOST_TRIALS {
            return Err(TrialPlanError::TooMany { most: MOST_TRIALS });
        }
        let wanted = lines.unwrap_or((trials - controls) / 2);
        let mut judge = DockingOracle::new(self.problem, self.motions);
        if !judge.docks(&PoseError::default()) {
            return Err(TrialPlanError::NotDocked);
        }
        let mut made = Made::default();
        // Lines on which a pair fits between zero and the error box first.
        let (mut borders, mut narrow) = (Vec::new(), Vec::new());
        for (number, along) in self.directions(wanted).into_iter().enumerate() {
            exec.check()?;
            if borders.len() == wanted {
                break;
            }
            let Some(at) = self.border(&mut judge, &along) else {
                made.open += 1;
                continue;
            };
            let sides = [-1.0, 1.0]
                .map(|sign| sign * self.decisive_distance(&mut judge, &along, at, sign, resolution, number));
            let border = Border { along, at, sides };
            let fits = sides.iter().all(|side| is_within(at + side));
            if fits { &mut borders } else { &mut narrow }.push(border);
        }
        let missing = wanted - borders.len();
        borders.extend(narrow.into_iter().take(missing));
        if borders.is_empty() {
            return Err(TrialPlanError::NoBorder);
        }
        // If there are fewer lines than requested, their trials become further pairs, and the remainder
        // becomes controls.
        let pairs = (trials - controls) / (2 * borders.len());
        for (number, Border { along, at, sides }) in borders.iter().enumerate() {
            for side in sides {
                // The widest pair first: each pair halves the interval that the previous pair left.
                let at = (0..pairs).rev().map(|pair| at + side * f64::from(1u32 << pair.min(16)));
                let place = |t: f64| Placed { error: self.scaled(along, t), line: number + 1 };
                made.poses.extend(at.filter(|t| is_within(*t)).map(place));
            }
        }
        for number in 0..trials - made.poses.len() {
            let (line, round) = ((number / 2) % borders.len(), number / (2 * borders.len()));
            let Border { along, at, .. } = &borders[line];
            let share = between(round);
            let t = if number % 2 == 0 { share * at } else { at + share * (1.0 - at) };
            made.poses.push(Placed { error: self.scaled(along, t), line: line + 1 });
        }
        made.followed = judge.followed();
        made.poses.sort_by_key(|placed| placed.line);
        Ok(made)
    }

    /// Distance from the border along a line at which a point is decisive, as a share of the length through
    /// the box.
    fn decisive_distance(
        &self,
        judge: &mut DockingOracle<'_>,
        along: &[f64; 5],
        border: f64,
        sign: f64,
        resolution: &[Option<f64>; 5],
        number: usize,
    ) -> f64 {
        let speed = |units: [f64; 5]| {
            let rate = |k: usize| {
                let part = along[k] * self.problem.alignment().half_range(Dof::ALL[k]);
                if units[k] > 0.0 { (part / units[k]).powi(2) } else { 0.0 }
            };
            (0..5).map(rate).sum::<f64>().sqrt()
        };
        let inverse = |rate: f64| if rate > 0.0 { rate.recip() } else { 0.0 };
        let is_wide = self.problem.alignment().free.len() > 2;
        let wanted = TOLD_APART * if is_wide { LEEWAY } else { 1.0 };
        let mut apart = (wanted * inverse(speed(self.accuracy.to_array())))
            .max(inverse(speed(resolution.map(Option::unwrap_or_default))));
        let search = Search::new(self.problem, &self.accuracy, 2.0 * wanted);
        let random = Stream::new(self.seed).branch(2).branch(number as u64);
        for _ in 0..MOVES {
            let t = border + sign * apart;
            if !is_within(t) {
                break;
            }
            let error = self.scaled(along, t);
            let docks = judge.docks(&error);
            match search.nearest(judge, &error, docks, None, random) {
                Some(result) if result.sigmas < wanted * LIMIT / TOLD_APART => {
                    apart *= (wanted / result.sigmas).clamp(1.05, 2.0);
                }
                _ => break,
            }
        }
        apart
    }

    /// Position of the first failure along a direction, as a share of the length through the error box.
    fn border(&self, judge: &mut DockingOracle<'_>, along: &[f64; 5]) -> Option<f64> {
        let fails = (1..=LOOKS).find(|k| !judge.docks(&self.scaled(along, *k as f64 / LOOKS as f64)))?;
        let [mut docks, mut fails] = [fails - 1, fails].map(|k| k as f64 / LOOKS as f64);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(docks, fails);
            if judge.docks(&self.scaled(along, middle)) {
                docks = middle;
            } else {
                fails = middle;
            }
        }
        Some(fails)
    }

    /// A pose so far along a direction whose largest part is 1: at 1 it is on the surface of the error box.
    fn scaled(&self, along: &[f64; 5], t: f64) -> PoseError {
        let range = |k: usize| self.problem.alignment().half_range(Dof::ALL[k]);
        PoseError::from_array(std::array::from_fn(|k| t * along[k] * range(k)))
    }

    /// Directions through the error box: evenly for two errors, for more along each error first and then
    /// random directions.
    fn directions(&self, wanted: usize) -> Vec<[f64; 5]> {
        let axes: Vec<usize> = self.problem.alignment().free.iter().map(Dof::index).collect();
        let signs: &[f64] = if self.symmetric { &[1.0] } else { &[1.0, -1.0] };
        let mut all: Vec<[f64; 5]> = Vec::new();
        if let [a, b] = axes[..] {
            let turn =
                if self.symmetric { FRAC_PI_2 / (wanted - 1).max(1) as f64 } else { TAU / wanted as f64 };
            for k in 0..wanted {
                let (sin, cos) = (turn * k as f64).sin_cos();
                let clean = |part: f64| if part.abs() < f64::EPSILON { 0.0 } else { part };
                let mut along = [0.0; 5];
                (along[a], along[b]) = (clean(cos), clean(sin));
                all.push(along);
            }
        } else {
            for k in &axes {
                for sign in signs {
                    let mut along = [0.0; 5];
                    along[*k] = *sign;
                    all.push(along);
                }
            }
        }
        if axes.len() > 1 {
            let random = Stream::new(self.seed).branch(3);
            for number in 0..(TRIES * wanted) as u64 {
                let normal = random_direction(random, number);
                let part = |k: usize| if self.symmetric { normal[k].abs() } else { normal[k] };
                all.push(std::array::from_fn(|k| if axes.contains(&k) { part(k) } else { 0.0 }));
            }
        }
        let largest = |along: &[f64; 5]| along.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        all.iter().map(|along| along.map(|part| part / largest(along))).collect()
    }
}

/// Whether a point so far along a line is beyond zero and not beyond the error box.
fn is_within(t: f64) -> bool {
    t > 0.0 && t <= 1.0
}

/// Positions of controls between two ends, half way first: 1/2, 1/4, 3/4, 1/8, 5/8, …, without repetition.
fn between(round: usize) -> f64 {
    let (mut rest, mut digit, mut share) = (round + 1, 0.5, 0.0);
    while rest > 0 {
        share += digit * (rest % 2) as f64;
        (rest, digit) = (rest / 2, digit / 2.0);
    }
    share
}

/// Lines numbered 1, 2, 3, … in the order in which they are met.
fn numbered(mut poses: Vec<Placed>) -> Vec<Placed> {
    let mut met = std::collections::BTreeMap::new();
    for placed in &mut poses {
        let next = met.len() + 1;
        placed.line = *met.entry(placed.line).or_insert(next);
    }
    poses
}
