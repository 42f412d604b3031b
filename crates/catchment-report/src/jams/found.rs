//! What is said of jams: numbers and names, with and without a report of their own.

use crate::resting::{HeldReport, ThresholdsReport};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::Share;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::run::jams::{
    Examined, Firmness, Jam, Jams, NamedFeature, PUSH, Settings, Touched, Touching,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Where motions rest that do not dock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JamsFound {
    /// How it was asked for.
    pub settings: Settings,
    /// Random poses of the error box that were followed.
    pub motions: usize,
    /// What became of them, by the names of outcomes.
    pub outcomes: BTreeMap<Outcome, Share>,
    /// The same of poses drawn from the errors that a robot makes; null where none were given.
    pub expected: Option<BTreeMap<Outcome, Share>>,
    /// The table that those poses come from; null where they were not measured.
    #[serde(default)]
    pub measured: Option<String>,
    /// The jams, the one with most of the poses first.
    pub jams: Vec<JamReport>,
    /// Which pairs of features touch in jams, the one that does so most often first.
    pub features: Vec<PairReport>,
}

/// A place of rest, or places alike.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JamReport {
    /// How many poses of the error box end here, and which share that is.
    pub of_box: Share,
    /// Their share of the poses that jam.
    pub of_jams: f64,
    /// Their share of the poses that do not dock.
    pub of_failures: f64,
    /// The same of the errors that a robot makes; null where none were given.
    pub expected: Option<Share>,
    /// The pose error of the rest in its middle.
    pub pose: PoseError,
    /// From where to where its rests lie, per free error; images by symmetry laid upon each other.
    pub extent: Vec<ExtentReport>,
    /// At how many places that are images of each other rests were seen.
    pub places: usize,
    /// z of the COR in the world frame, in D.
    pub height_d: f64,
    /// How far it is above the mated pose, in D.
    pub above_mated_d: f64,
    /// It is the mated pose turned by a symmetry of the halves, and counts as docked where the design has `symmetry` of this; null where it is not.
    #[serde(default)]
    pub docked_with_symmetry: Option<u32>,
    /// What touches.
    pub contacts: Vec<ContactReport>,
    /// What was found out about it; null of jams that were not examined.
    pub examined: Option<ExaminedReport>,
    /// The depth that the merge tree of a grid says, in D: a bound from neither side; null where no grid was asked for, or it does not say.
    pub depth_on_grid_d: Option<f64>,
    /// At least so far it must be lifted before it may come to rest elsewhere, in D, certainly; null where that was not asked for, or is not known.
    pub depth_at_least_d: Option<f64>,
}

/// From where to where rests lie along an error, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExtentReport {
    /// Which error.
    pub axis: Dof,
    /// From here.
    pub from: f64,
    /// To here.
    pub to: f64,
}

/// Two features that touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContactReport {
    /// Where, in the world frame, in D.
    pub points_d: Vec<[f64; 3]>,
    /// Unit normal, from the fixed half to the moving one.
    pub normal: [f64; 3],
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// A pair of features, and how often it touches where halves jam.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PairReport {
    /// Poses of the error box that jam on it.
    pub count: usize,
    /// Their share of the poses that jam.
    pub of_jams: f64,
    /// Their share of the poses that do not dock.
    pub of_failures: f64,
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// What was found out about a jam.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExaminedReport {
    /// `sharp`, `rounded`, `level` or `ridge`.
    pub firmness: Firmness,
    /// By how much it is pushed aside, in the metric of the motion, in D.
    pub push_d: f64,
    /// The least rise found, in D: the true least is at most that. Null where walls stop it all around.
    pub rise_at_most_d: Option<f64>,
    /// The direction of that push: offsets in D and turns in radians.
    pub weakest: PoseError,
    /// By which order contacts alone hold it; null where they do not hold the load, as where friction does.
    pub immobility: Option<HeldReport>,
    /// From which friction on it may stick; null where it touches nothing.
    #[serde(default)]
    pub sticks: Option<ThresholdsReport>,
    /// The lowest way out that was found; null where none was.
    pub way_out: Option<WayOutReport>,
    /// Poses a little off that were followed.
    pub pushed: usize,
    /// How many of them came back.
    pub back: usize,
}

/// A way out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WayOutReport {
    /// How far the half must be lifted to get out, at most, in D.
    pub climb_at_most_d: f64,
    /// What becomes of it then.
    pub to: Outcome,
    /// The pose error from which motion leads there.
    pub over: PoseError,
}

impl JamsFound {
    /// Of a design.
    pub fn new(design: &Design, found: &Jams) -> Self {
        let pair = |pair: &Touching| PairReport {
            count: pair.count,
            of_jams: share_of(pair.count, found.jammed()),
            of_failures: share_of(pair.count, found.failed()),
            fixed: pair.fixed.clone(),
            moving: pair.moving.clone(),
        };
        Self {
            settings: found.settings.clone(),
            motions: found.motions(),
            outcomes: shares(found.counts),
            expected: found.expected.map(shares),
            measured: found.measured.clone(),
            jams: found.jams.iter().map(|jam| JamReport::of(design, found, jam)).collect(),
            features: found.pairs.iter().map(pair).collect(),
        }
    }
}

/// Shares by outcome.
pub(crate) fn shares(counts: [usize; 4]) -> BTreeMap<Outcome, Share> {
    let all = counts.iter().sum();
    Outcome::ALL.into_iter().zip(counts.map(|count| Share::of(count, all))).collect()
}

pub(super) fn share_of(count: usize, all: usize) -> f64 {
    if all == 0 { 0.0 } else { count as f64 / all as f64 }
}

impl From<&Touched> for ContactReport {
    fn from(touched: &Touched) -> Self {
        let points = touched.points.iter().map(glam::DVec3::to_array).collect();
        let Touched { normal, fixed, moving, .. } = touched;
        Self { points_d: points, normal: normal.to_array(), fixed: fixed.clone(), moving: moving.clone() }
    }
}

impl From<&Examined> for ExaminedReport {
    fn from(examined: &Examined) -> Self {
        let Examined { held, immobility, sticking, way_out, pushed, back } = *examined;
        let way_out =
            way_out.map(|way| WayOutReport { climb_at_most_d: way.climb, to: way.to, over: way.over });
        let (firmness, rise_at_most_d, weakest) = (held.firmness, held.rise, held.weakest);
        let immobility = immobility.map(HeldReport::from);
        let sticks = sticking.map(ThresholdsReport::from);
        Self { firmness, push_d: PUSH, rise_at_most_d, weakest, immobility, sticks, way_out, pushed, back }
    }
}

impl ExaminedReport {
    /// Whether nothing but so much friction holds it.
    pub(crate) fn is_held_by_friction(&self, friction: f64) -> bool {
        friction > 0.0 && (self.firmness == Firmness::Ridge || self.immobility.is_none())
    }
}

impl JamReport {
    fn of(design: &Design, found: &Jams, jam: &Jam) -> Self {
        let extent = design.alignment.free.iter().map(|axis| {
            let [from, to] = jam.extent[axis.index()];
            ExtentReport { axis, from, to }
        });
        let drawn = found.expected.map_or(0, |counts| counts.iter().sum());
        Self {
            of_box: Share::of(jam.count, found.motions()),
            of_jams: share_of(jam.count, found.jammed()),
            of_failures: share_of(jam.count, found.failed()),
            expected: jam.expected.map(|count| Share::of(count, drawn)),
            pose: jam.pose,
            extent: extent.collect(),
            places: jam.places,
            height_d: jam.height,
            above_mated_d: jam.above,
            docked_with_symmetry: jam.symmetry,
            contacts: jam.contacts.iter().map(ContactReport::from).collect(),
            examined: jam.examined.as_ref().map(ExaminedReport::from),
            depth_on_grid_d: jam.depth_on_grid,
            depth_at_least_d: jam.depth_at_least,
        }
    }
}
