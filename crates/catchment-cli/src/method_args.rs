//! Command-line choice of a method and its settings.

use crate::drop_args::DropArgs;
use crate::failure::Failure;
use crate::setting::number;
use crate::setting::{Change, with_changes};
use catchment::method::{Method, REGISTRY, RegistryEntry};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use serde_json::Value;

/// A method that decides grids, and its settings.
#[derive(Debug, Args)]
pub(crate) struct MethodArgs {
    /// Method that decides the outcomes
    #[arg(long, value_name = "METHOD", default_value = REGISTRY[0].info.name, value_parser = choice_parser())]
    pub(crate) method: Choice,
    #[command(flatten)]
    pub(crate) settings: SettingArgs,
}

/// Heading of the settings that belong to a single method.
const SETTINGS: &str = "Method settings";

/// Settings of methods.
#[derive(Debug, Args)]
pub(crate) struct SettingArgs {
    /// Flooding: merge basins shallower than this depth, in D [default: in the widest gap between basin depths]
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, value_name = "DEPTH", value_parser = depth)]
    pub(crate) depth_tolerance: Option<f64>,
    /// Partition: rotation slices across the error box per free angle [default: 24 for a single angle, 4 for two]
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, value_name = "COUNT")]
    slices: Option<usize>,
    /// Partition: strips per D of the moving half; 1 is the method of the dissertation [default: 12, or 1 for two angles]
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, value_name = "COUNT")]
    strips: Option<usize>,
    /// Certified: undecided share of the error box at which the search ends [default: 0.02]
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, value_name = "SHARE", value_parser = number)]
    gap: Option<f64>,
    /// Certified: largest number of boxes of poses
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, value_name = "COUNT")]
    boxes: Option<usize>,
    /// Confluence: largest number of motions, lowest start first; the cells left over stay undecided [default: no limit]
    #[arg(long, hide_short_help = true, help_heading = SETTINGS, alias = "motions", value_name = "N")]
    max_motions: Option<usize>,
    #[command(flatten)]
    drop: DropArgs,
}

/// A method that decides each pose by itself, and its settings.
#[derive(Debug, Args)]
pub(crate) struct PoseMethodArgs {
    /// Method that follows the poses
    #[arg(long, value_name = "METHOD", default_value = "descent", value_parser = pose_method_parser())]
    method: Method,
    #[command(flatten)]
    drop: DropArgs,
}

impl SettingArgs {
    fn changes(&self) -> Vec<Change> {
        let mut changes = Vec::new();
        let mut add = |option: &'static str, setting: &'static str, value: Option<Value>| {
            changes.extend(value.map(|value| Change { option, setting, value }));
        };
        add("--depth-tolerance", "depth_tolerance", self.depth_tolerance.map(Value::from));
        add("--slices", "slices", self.slices.map(Value::from));
        add("--strips", "strips", self.strips.map(Value::from));
        add("--gap", "gap", self.gap.map(Value::from));
        add("--boxes", "boxes", self.boxes.map(Value::from));
        add("--max-motions", "motions", self.max_motions.map(Value::from));
        changes.extend(self.drop.changes());
        changes
    }

    /// The method with the options applied.
    pub(crate) fn of(&self, method: &Method) -> Result<Method, Failure> {
        with_changes(method, &self.changes())
    }

    /// Every method with those options applied that it supports; each setting belongs to one method.
    pub(crate) fn of_all(&self) -> Result<Vec<Method>, Failure> {
        let changes = self.changes();
        Method::all()
            .map(|method| {
                let own: Vec<Change> =
                    changes.iter().filter(|change| method.has(change.setting)).cloned().collect();
                with_changes(&method, &own)
            })
            .collect()
    }
}

impl PoseMethodArgs {
    /// The method with the options applied.
    pub(crate) fn of(&self) -> Result<Method, Failure> {
        with_changes(&self.method, &self.drop.changes())
    }
}

/// One method, or all methods.
#[derive(Debug, Clone)]
pub(crate) enum Choice {
    One(Method),
    All,
}

/// The name for all methods.
const ALL: &str = "all";

/// The accepted names of the selected methods.
fn possible(which: impl Fn(&RegistryEntry) -> bool) -> Vec<PossibleValue> {
    REGISTRY
        .iter()
        .filter(|entry| which(entry))
        .map(|entry| PossibleValue::new(entry.info.name).help(entry.info.summary))
        .collect()
}

/// Parser of a method name.
pub(crate) fn method_parser() -> ValueParser {
    PossibleValuesParser::new(possible(|_| true)).try_map(|name| name.parse::<Method>()).into()
}

/// Parser of the name of a method that decides each pose independently.
pub(crate) fn pose_method_parser() -> ValueParser {
    let by_pose = |entry: &RegistryEntry| entry.method().follows().is_some();
    PossibleValuesParser::new(possible(by_pose)).try_map(|name| name.parse::<Method>()).into()
}

/// Parser of a method name, or `all`.
fn choice_parser() -> ValueParser {
    let all = PossibleValue::new(ALL).help("every method that applies, side by side, and how they agree");
    PossibleValuesParser::new(possible(|_| true).into_iter().chain([all]))
        .try_map(|name| if name == ALL { Ok(Choice::All) } else { name.parse::<Method>().map(Choice::One) })
        .into()
}

fn depth(text: &str) -> Result<f64, String> {
    let depth = number(text)?;
    if depth >= 0.0 { Ok(depth) } else { Err("a depth is a number of D, at least 0".to_owned()) }
}
