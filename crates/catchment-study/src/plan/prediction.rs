//! Predicted outcomes of the poses of a plan, and their distances from the border.

use super::border::{Border, DockingOracle, Search};
use catchment_core::acceptance::Stream;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent;
use catchment_core::pose::PoseError;
use catchment_core::poses::ObservedOutcome;
use catchment_core::problem::Problem;
use serde::Serialize;

/// Prediction of a pose by exact motion. Distances are null if the error box contains no border.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Prediction {
    /// Predicted outcome; null if it is undecided.
    pub predicted: Option<ObservedOutcome>,
    /// Whether the border is closer than the standard deviation of the robot, so that the pose may dock or
    /// fail.
    pub either: bool,
    /// Upper bound on the distance to the border, in D, with rotations times the characteristic length.
    pub distance_to_border: Option<f64>,
    /// The same distance in standard deviations of the robot.
    pub margin_in_sigma: Option<f64>,
    /// The same distance as a share of the error box.
    pub margin_in_box: Option<f64>,
}

impl Prediction {
    /// Of a predicted outcome and the nearest pose found whose outcome differs.
    pub(crate) fn new(predicted: Option<ObservedOutcome>, border: Option<Border>) -> Self {
        let mut prediction = Self {
            predicted,
            either: false,
            distance_to_border: border.map(|border| border.distance),
            margin_in_sigma: border.map(|border| border.sigmas),
            margin_in_box: border.map(|border| border.box_share),
        };
        prediction.either = prediction.margin() < 1.0;
        prediction
    }

    /// Whether it docks, turned or not.
    pub const fn docks(&self) -> bool {
        matches!(self.predicted, Some(ObservedOutcome::Aligned | ObservedOutcome::AlignedElsewhere))
    }

    /// Distance from the border, in standard deviations; infinite if no border was found, 0 for an undecided
    /// pose.
    pub fn margin(&self) -> f64 {
        match (self.predicted, self.margin_in_sigma) {
            (None, _) => 0.0,
            (_, Some(sigmas)) => sigmas,
            (_, None) => f64::INFINITY,
        }
    }

    /// The prediction in a word: `either` if the pose may dock or fail.
    pub const fn word(&self) -> &'static str {
        match self.predicted {
            _ if self.either => "either",
            Some(observed) => observed.name(),
            None => "undecided",
        }
    }
}

/// Work on every number below `count`, each thread with a tool of its own; in the order of the numbers.
pub(crate) fn for_each<T: Send, A: Send>(
    count: usize,
    exec: &Exec,
    tool: impl Fn() -> A + Sync,
    work: impl Fn(&mut A, usize) -> T + Sync,
) -> Result<Vec<T>, Cancelled> {
    let tally = exec.tally(count, "motions");
    exec.map_with(count, tool, |tool, k| {
        let result = work(tool, k);
        tally.add(1);
        result
    })
}

/// Follows poses and looks for the border about each; and how many motions that took.
pub(crate) fn foretell(
    problem: &Problem,
    accuracy: &PoseError,
    motions: &descent::DescentSettings,
    poses: &[PoseError],
    seed: u64,
    exec: &Exec,
) -> Result<(Vec<Prediction>, usize), Cancelled> {
    /// Part of the time that the poses themselves take.
    const FIRST: f64 = 0.05;
    let judge = || DockingOracle::new(problem, motions);
    let first = exec.part([0.0, FIRST], "motions");
    let predicted = for_each(poses.len(), &first, judge, |judge, k| {
        let before = judge.followed();
        (judge.predict(&poses[k]), judge.followed() - before)
    })?;
    let mut followed: usize = predicted.iter().map(|(_, count)| count).sum();
    let search = Search::new(problem, accuracy, f64::INFINITY);
    let mut prediction: Vec<Prediction> =
        predicted.into_iter().map(|(predicted, _)| Prediction::new(predicted, None)).collect();
    let random = Stream::new(seed).branch(4);
    let rest = exec.part([FIRST, 1.0], "motions");
    let borders = for_each(poses.len(), &rest, judge, |judge, k| {
        let before = judge.followed();
        let docks = prediction[k].docks();
        let others =
            (0..poses.len()).filter(|other| prediction[*other].docks() != docks).map(|other| &poses[other]);
        let nearest = others.min_by(|a, b| search.apart(&poses[k], a).total_cmp(&search.apart(&poses[k], b)));
        let border = search.nearest(judge, &poses[k], docks, nearest, random.branch(k as u64));
        (border, judge.followed() - before)
    })?;
    for (prediction, (border, count)) in prediction.iter_mut().zip(borders) {
        *prediction = Prediction::new(prediction.predicted, border);
        followed += count;
    }
    Ok((prediction, followed))
}
