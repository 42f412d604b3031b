//! A plan of trials: as versioned JSON, as text, and as the table that goes to the robot and comes back with outcomes.

use super::bench::Told;
use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, row, wrapped};
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Observed, OffsetsAt};
use catchment_study::plan::{Foretold, Pattern, Plan, Settings};
use catchment_study::validate::{FEWEST, LIMIT};
use serde::Serialize;

/// What a plan has to say, with its head.
pub type PlanReport = Envelope<PlanBody>;

/// What a plan has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlanBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// The point at which the table gives x and y; those of this report are of the face centre.
    pub offsets_at: OffsetsAt,
    /// How many of what.
    pub plan: PlanCounts,
    /// The poses, line by line.
    pub points: Vec<PlanPointReport>,
    /// The trials in their order.
    pub trials: Vec<PlannedReport>,
    /// Exact motions in all.
    pub motions: usize,
}

/// How many of what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlanCounts {
    /// Trials.
    pub trials: usize,
    /// Poses.
    pub poses: usize,
    /// Lines.
    pub lines: usize,
    /// Poses that dock.
    pub docking: usize,
    /// Poses that do not.
    pub failing: usize,
    /// Of both, those that may go either way: nearer to the border than the accuracy.
    pub either: usize,
    /// Of both, those that decide: two accuracies or more from the border.
    pub deciding: usize,
    /// Poses that fare otherwise with other signs of their errors; of plans with positive errors alone.
    pub asymmetric: usize,
    /// Directions along which nothing fails within the error box; of brackets.
    pub open: usize,
}

/// A pose, in D and radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlanPointReport {
    /// The pose error.
    pub error: PoseError,
    /// Its line, from 1.
    pub line: usize,
    /// What becomes of it; null where that is undecided.
    pub predicted: Option<Observed>,
    /// Whether the robot's accuracy lets it go either way.
    pub either: bool,
    /// To the border at most, in D, rotations times the rotation length; null where none was found within the error box.
    pub distance_to_border: Option<f64>,
    /// The same in units of the accuracy.
    pub margin_in_sigma: Option<f64>,
    /// The same as a share of the error box.
    pub margin_in_box: Option<f64>,
}

/// A trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlannedReport {
    /// From 1, in the order in which they are made.
    pub trial: usize,
    /// Its part of the test, from 1.
    pub block: usize,
    /// The how manieth time of its pose.
    pub repeat: usize,
    /// Which of the poses, from 0.
    pub point: usize,
}

impl Body for PlanBody {
    const KIND: &'static str = "plan";
}

impl PlanPointReport {
    /// Of a pose.
    pub(super) fn new(error: PoseError, line: usize, foretold: &Foretold) -> Self {
        Self {
            error,
            line,
            predicted: foretold.predicted,
            either: foretold.is_either(),
            distance_to_border: foretold.border.map(|border| border.distance),
            margin_in_sigma: foretold.border.map(|border| border.sigmas),
            margin_in_box: foretold.border.map(|border| border.box_share),
        }
    }

    pub(super) const fn docks(&self) -> bool {
        matches!(self.predicted, Some(Observed::Aligned | Observed::AlignedElsewhere))
    }
}

/// Trials that are shown as text.
const SHOWN: usize = 6;

impl PlanReport {
    /// Of a design; the table gives offsets at a point.
    pub fn new(
        design: &Design,
        found: &Plan,
        offsets_at: OffsetsAt,
        mut doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let points: Vec<PlanPointReport> =
            found.points.iter().map(|p| PlanPointReport::new(p.error, p.line, &p.foretold)).collect();
        let count = |is: &dyn Fn(&PlanPointReport) -> bool| points.iter().filter(|p| is(p)).count();
        let decides = |p: &PlanPointReport| {
            p.predicted.is_some() && p.margin_in_sigma.is_none_or(|margin| margin >= LIMIT)
        };
        let plan = PlanCounts {
            trials: found.trials.len(),
            poses: points.len(),
            lines: points.iter().map(|p| p.line).max().unwrap_or(0),
            docking: count(&PlanPointReport::docks),
            failing: count(&|p| !p.docks()),
            either: count(&|p| p.either),
            deciding: count(&decides),
            asymmetric: found.asymmetric,
            open: found.open,
        };
        let sides = [count(&|p| decides(p) && p.docks()), count(&|p| decides(p) && !p.docks())];
        doubts.extend(doubts_of(&plan, sides).iter().map(WarningReport::note));
        let trials = found.trials.iter().map(|trial| PlannedReport {
            trial: trial.number,
            block: trial.block,
            repeat: trial.repeat,
            point: trial.point,
        });
        let body = PlanBody {
            design: design.clone(),
            settings: found.settings.clone(),
            offsets_at,
            plan,
            trials: trials.collect(),
            points,
            motions: found.motions,
        };
        Self::of(body, doubts, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let told = Told { design: &self.design };
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "method", &format!("descent, {} motions, no grid", grouped(self.motions)));
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        wrapped(&mut text, "  pattern        ", &self.pattern(&told));
        let accuracy = format!("{} (one standard deviation)", told.accuracy(&self.settings.accuracy));
        wrapped(&mut text, "  accuracy       ", &accuracy);
        text.push('\n');
        let PlanCounts { trials, poses, lines, docking, failing, either, deciding, .. } = self.plan;
        let times = if self.settings.repeats > 1 {
            format!(", {} times each", self.settings.repeats)
        } else {
            String::new()
        };
        row(
            &mut text,
            "trials",
            &format!("{} at {} poses on {} lines{times}", grouped(trials), grouped(poses), grouped(lines)),
        );
        let order = if self.settings.shuffled { "random order" } else { "the order of the pattern" };
        let blocks = if self.settings.blocks > 1 {
            format!(", in {} blocks", self.settings.blocks)
        } else {
            String::new()
        };
        row(&mut text, "", &format!("in {order}{blocks}"));
        row(&mut text, "predicted", &format!("{docking} dock, {failing} do not"));
        row(&mut text, "either", &format!("{either}, nearer to the border than the accuracy"));
        row(&mut text, "decide", &format!("{deciding}, {LIMIT} accuracies or more from it"));
        if let Some(point) = self.nearest() {
            let margin = point.margin_in_sigma.unwrap_or_default();
            row(
                &mut text,
                "nearest",
                &format!(
                    "at most {} from it, {margin:.2} accuracies",
                    told.length(point.distance_to_border.unwrap_or_default())
                ),
            );
            wrapped(&mut text, "                 ", &told.pose(&point.error));
        }
        text.push('\n');
        line(&mut text, "  first trials");
        for trial in self.trials.iter().take(SHOWN) {
            let point = &self.points[trial.point];
            let pose = format!("{}: {}", told.pose(&point.error), predicted(point));
            wrapped(&mut text, &format!("  {:>5}  ", trial.trial), &pose);
        }
        if self.trials.len() > SHOWN {
            line(&mut text, &format!("      …  {} more", grouped(self.trials.len() - SHOWN)));
        }
        self.append_warnings(&mut text);
        text
    }

    /// The deciding pose that is nearest to the border.
    fn nearest(&self) -> Option<&PlanPointReport> {
        let deciding = self.points.iter().filter(|p| p.predicted.is_some());
        let known = deciding.filter_map(|p| Some((p.margin_in_sigma.filter(|margin| *margin >= LIMIT)?, p)));
        known.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
    }

    fn pattern(&self, told: &Told<'_>) -> String {
        let named = |values: &[Option<f64>; 5]| {
            let of = |axis: Dof| Some(told.size(axis, values[axis.index()]?));
            Dof::ALL.into_iter().filter_map(of).collect::<Vec<_>>().join(", ")
        };
        let positive = if self.settings.symmetric { ", positive errors" } else { "" };
        let told = match &self.settings.pattern {
            Pattern::Grid { steps, .. } => {
                let counts: Vec<String> = steps.iter().flatten().map(ToString::to_string).collect();
                format!("grid, {} points", counts.join(" × "))
            }
            Pattern::Lattice { step, along_border, .. } => {
                let where_ = if *along_border { " along the border" } else { "" };
                format!("lattice{where_}, step {}", named(step))
            }
            Pattern::Arc { lever, pitch, yaw } => {
                format!("arc, lever {}, {} angles at {} yaws", told.length(*lever), pitch.len(), yaw.len())
            }
            Pattern::Bracket { .. } => format!("bracket, {} lines", self.plan.lines),
        };
        told + positive
    }

    /// The table for the robot as records, the names of the columns first: units of the design, degrees. `outcome` and `notes` are empty.
    pub fn records(&self) -> Vec<Vec<String>> {
        let told = Told { design: &self.design };
        let errors: Vec<PoseError> = self.points.iter().map(|point| point.error).collect();
        let columns = told.columns(&errors, self.offsets_at);
        let unit = self.design.unit.map_or_else(String::new, |unit| format!("_{}", unit.symbol()));
        let mut head: Vec<String> = ["trial", "block", "line"].map(str::to_owned).to_vec();
        head.extend(columns.iter().map(|(name, _)| name.clone()));
        head.push("predicted".to_owned());
        head.push(format!("distance_to_border{unit}"));
        head.extend(["margin_in_sigma", "repeat", "outcome", "notes"].map(str::to_owned));
        let mut records = vec![head];
        for trial in &self.trials {
            let point = &self.points[trial.point];
            let mut record = vec![trial.trial.to_string(), trial.block.to_string(), point.line.to_string()];
            record.extend(columns.iter().map(|(_, axis)| told.cell(&point.error, *axis, self.offsets_at)));
            record.push(predicted(point).to_owned());
            let short = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
            record.push(short(point.distance_to_border.map(|distance| distance * told.width())));
            record.push(short(point.margin_in_sigma));
            record.extend([trial.repeat.to_string(), String::new(), String::new()]);
            records.push(record);
        }
        records
    }
}

/// What a robot is to expect.
pub(super) const fn predicted(point: &PlanPointReport) -> &'static str {
    match point.predicted {
        _ if point.either => "either",
        Some(observed) => observed.name(),
        None => "undecided",
    }
}

/// What should be known of a plan.
fn doubts_of(plan: &PlanCounts, [docking, failing]: [usize; 2]) -> Vec<String> {
    let mut doubts = Vec::new();
    if plan.poses == 0 {
        return doubts;
    }
    if docking + failing < FEWEST {
        doubts.push(format!(
            "only {} poses are {LIMIT} accuracies or more from the border: with fewer than {FEWEST} trials there no verdict is possible",
            docking + failing
        ));
    }
    if failing == 0 {
        doubts.push(
            "no pose beyond the border decides: the trials can show that the border is not nearer than predicted, not that it is no farther"
                .to_owned(),
        );
    } else if docking == 0 {
        doubts.push("no pose inside the border decides: the trials can only show that the border is no farther than predicted".to_owned());
    }
    if plan.asymmetric > 0 {
        doubts.push(format!(
            "{} of {} poses fare otherwise with other signs of their errors: positive errors do not stand for all",
            plan.asymmetric, plan.poses
        ));
    }
    if plan.open > 0 {
        doubts.push(format!(
            "along {} directions nothing fails within the error box: they are left out",
            plan.open
        ));
    }
    doubts
}
