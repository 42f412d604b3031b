//! The jams of a pair, and the results of the examination of each.

use super::{EscapePath, JamsSettings, Stability};
use crate::acceptance::Outcome;
use crate::contact::FeatureKind;
use crate::document::Share;
use crate::method::descent::{Immobility, Sticking};
use crate::pose::{Dof, PoseError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The jams of a pair: rests outside the seat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Jams {
    /// The settings, with all defaults filled in.
    pub settings: JamsSettings,
    /// Number of poses sampled from the error box and followed.
    pub motions: usize,
    /// Outcomes of the sampled poses.
    #[cfg_attr(feature = "schema", schemars(schema_with = "crate::document::shares_by_outcome"))]
    pub outcomes: BTreeMap<Outcome, Share>,
    /// Outcomes of poses sampled from the errors of the robot; null if no errors were given.
    #[cfg_attr(feature = "schema", schemars(schema_with = "crate::document::shares_or_null"))]
    pub expected: Option<BTreeMap<Outcome, Share>>,
    /// The table of measured errors from which those poses come; null if the errors were not measured.
    #[serde(default)]
    pub measured: Option<String>,
    /// The jams, largest basin first.
    pub jams: Vec<Jam>,
    /// Pairs of features in contact in jams, most frequent first.
    pub features: Vec<JammingPair>,
}

impl Jams {
    /// How many of the poses of the error box jam.
    pub fn jammed(&self) -> usize {
        self.jams.iter().map(|jam| jam.of_box.count).sum()
    }
}

/// A rest outside the seat, or several equivalent ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Jam {
    /// Poses of the error box that end here: number and share.
    pub of_box: Share,
    /// Share of the jammed poses that end here.
    pub of_jams: f64,
    /// Share of the failed poses that end here.
    pub of_failures: f64,
    /// Poses from the errors of the robot that end here; null if no errors were given.
    pub expected: Option<Share>,
    /// Pose error of the central rest.
    pub pose: PoseError,
    /// Range of the rests in each free error, with symmetric images mapped onto each other.
    pub extent: Vec<Extent>,
    /// Number of symmetric images of this place at which rests were observed.
    pub places: usize,
    /// z of the COR in the world frame, in D.
    pub height_d: f64,
    /// Height above the mated pose, in D.
    pub above_mated_d: f64,
    /// The value of `symmetry` with which this rest would count as docked, because it is the mated pose
    /// rotated by a symmetry of the halves; null if it is no such pose.
    #[serde(default)]
    pub docked_with_symmetry: Option<u32>,
    /// The contacts.
    pub contacts: Vec<FeatureContact>,
    /// Results of the examination; null for a jam that was not examined.
    pub examined: Option<Examined>,
    /// Escape height in the merge tree of a grid, in D; neither an upper nor a lower bound; null without
    /// `resolution`, or if the tree does not contain the rest.
    pub depth_on_grid_d: Option<f64>,
    /// Certified lower bound on the escape height to another rest, in D; null without `certified`, or if no
    /// bound is known.
    pub depth_at_least_d: Option<f64>,
}

/// Range of the rests in an error, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Extent {
    /// The error.
    pub axis: Dof,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
}

/// A contact between two features.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FeatureContact {
    /// Contact points in the world frame, in D: the points that carry force.
    pub points_d: Vec<[f64; 3]>,
    /// Contact normal at the first point: unit vector from the fixed half to the moving half.
    pub normal: [f64; 3],
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// A feature of a half in contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NamedFeature {
    /// `face`, `edge` or `corner`.
    pub kind: FeatureKind,
    /// Description, such as `edge between top and wall`.
    pub name: String,
    /// Number of its part in the design file, from 0; null if the half does not consist of parts with one
    /// surface each.
    pub part: Option<usize>,
    /// Contact point in the coordinates in which the half was drawn, in D.
    pub drawn_d: [f64; 3],
}

/// A pair of features, and how often they are in contact in jams.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JammingPair {
    /// Number of poses of the error box that jam on this pair.
    pub count: usize,
    /// Share of the jammed poses.
    pub of_jams: f64,
    /// Share of the poses that fail to dock.
    pub of_failures: f64,
    /// The feature of the fixed half.
    pub fixed: NamedFeature,
    /// The feature of the moving half.
    pub moving: NamedFeature,
}

/// Results of the examination of a rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Examined {
    /// `sharp`, `rounded`, `level` or `ridge`.
    #[serde(alias = "firmness")]
    pub stability: Stability,
    /// Displacement of the test, in the metric of the motion, in D.
    pub push_d: f64,
    /// Smallest rise found, in D: an upper bound on the true minimum. Null if walls block every direction.
    pub rise_at_most_d: Option<f64>,
    /// Direction of the smallest rise: offsets in D and rotations in radians.
    pub weakest: PoseError,
    /// Immobility by the contacts alone; null if they do not balance the load without friction.
    pub immobility: Option<Immobility>,
    /// Friction thresholds for stiction; null if the half touches nothing.
    #[serde(default)]
    pub sticks: Option<Sticking>,
    /// Lowest escape path that was found; null if the search found no path.
    #[serde(alias = "way_out")]
    pub escape_path: Option<EscapePath>,
    /// Number of nearby poses that were followed.
    #[serde(alias = "pushed")]
    pub displaced: usize,
    /// Number of these that returned to the rest.
    #[serde(alias = "back")]
    pub returned: usize,
}
