//! Text and table form of a plan, for people and robots.

use super::{Pattern, PoseColumns, Prediction, TrialPlan, TrialPlanCounts, accuracy_words};
use crate::validate::{FEWEST, LIMIT};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{Column, DesignUnits, Document, Subject, Table, exact_motions, grouped};
use catchment_core::pose::{Dof, PoseError};

/// Trials that are shown.
const SHOWN: usize = 6;

impl Subject for TrialPlan {
    const KIND: &'static str = "plan";

    fn warnings(&self) -> Vec<Diagnostic> {
        let TrialPlanCounts { poses, asymmetric, open, .. } = self.counts;
        let mut warnings = Vec::new();
        if poses == 0 {
            return warnings;
        }
        let mut warn = |text: String| warnings.push(Diagnostic::warning(Self::KIND, text));
        let deciding = |docks: bool| {
            let decides =
                |prediction: &Prediction| prediction.margin() >= LIMIT && prediction.docks() == docks;
            self.points.iter().filter(|point| decides(&point.prediction)).count()
        };
        let [docking, failing] = [true, false].map(deciding);
        if docking + failing < FEWEST {
            warn(format!(
                "only {} poses are {LIMIT} accuracies or more from the border: with fewer than {FEWEST} trials there no verdict is possible",
                docking + failing
            ));
        }
        if failing == 0 {
            warn(
                "no pose beyond the border decides: the trials can show that the border is not nearer than predicted, not that it is no farther"
                    .to_owned(),
            );
        } else if docking == 0 {
            warn("no pose inside the border decides: the trials can only show that the border is no farther than predicted".to_owned());
        }
        if asymmetric > 0 {
            warn(format!(
                "{asymmetric} of {poses} poses have another outcome with other signs of their errors: positive errors do not stand for all"
            ));
        }
        if open > 0 {
            warn(format!("along {open} directions nothing fails within the error box: they are left out"));
        }
        warnings
    }

    fn setup(&self, design: &Design, document: &mut Document) {
        let settings = &self.settings;
        document.row("method", exact_motions(&format!("{} poses", grouped(self.motions)), settings.friction));
        document.row("pattern", self.pattern(DesignUnits::of(design)));
        document.row("accuracy", accuracy_words(design, &settings.accuracy));
    }

    fn document(&self, design: &Design) -> Document {
        let units = DesignUnits::of(design);
        let mut document = Document::default();
        self.describe_counts(&mut document, units);
        document.section("first trials");
        let mut first = Table::new([
            Column::new("trial"),
            Column::new("predicted").left(),
            Column::new("pose error").left(),
        ]);
        for trial in self.trials.iter().take(SHOWN) {
            let point = &self.points[trial.point];
            first.push([
                trial.number.into(),
                docks(point.prediction.word()).into(),
                units.pose(&point.error).into(),
            ]);
        }
        document.table(first);
        if self.trials.len() > SHOWN {
            document.paragraph(format!("and {} more", grouped(self.trials.len() - SHOWN)));
        }
        document.table(self.for_the_robot(design));
        document
    }
}

/// The outcome as people read it.
fn docks(word: &str) -> &str {
    if word == Outcome::Aligned.name() { Outcome::Aligned.word() } else { word }
}

/// `1 pose`, `40 poses`.
fn count(poses: usize) -> String {
    if poses == 1 { "1 pose".to_owned() } else { format!("{} poses", grouped(poses)) }
}

impl TrialPlan {
    fn describe_counts(&self, document: &mut Document, units: DesignUnits<'_>) {
        let TrialPlanCounts { trials, poses, lines, docking, failing, either, deciding, .. } = self.counts;
        let settings = &self.settings;
        let times =
            if settings.repeats > 1 { format!(", {} times each", settings.repeats) } else { String::new() };
        let [trials, poses, lines] = [trials, poses, lines].map(grouped);
        document.section(None).row("trials", format!("{trials} at {poses} poses on {lines} lines{times}"));
        let order = if settings.shuffled { "random order" } else { "the order of the pattern" };
        let blocks =
            if settings.blocks > 1 { format!(", in {} blocks", settings.blocks) } else { String::new() };
        document.more(format!("in {order}{blocks}"));
        document.row("predicted", format!("{} docked, {failing} not", count(docking)));
        document.row(
            "too close",
            format!("{}, nearer to the border than the accuracy: either outcome fits", count(either)),
        );
        document.row("decisive", format!("{}, {LIMIT} accuracies or more from the border", count(deciding)));
        let known = self.points.iter().filter_map(|point| {
            let Prediction { distance_to_border, margin_in_sigma, .. } = point.prediction;
            let decides = point.prediction.margin() >= LIMIT;
            Some((margin_in_sigma.filter(|_| decides)?, distance_to_border?, point))
        });
        if let Some((margin, distance, point)) = known.min_by(|a, b| a.0.total_cmp(&b.0)) {
            let distance = units.length(distance);
            document.row(
                "nearest of these",
                format!("at most {distance} from the border, {margin:.2} accuracies"),
            );
            document.more(units.pose(&point.error));
        }
    }

    fn pattern(&self, units: DesignUnits<'_>) -> String {
        let named = |values: &[Option<f64>; 5]| {
            let words =
                |axis: Dof| Some(format!("{} {}", axis.name(), units.amount(axis, values[axis.index()]?)));
            Dof::ALL.into_iter().filter_map(words).collect::<Vec<_>>().join(", ")
        };
        let positive = if self.settings.symmetric { ", positive errors" } else { "" };
        let pattern = match &self.settings.pattern {
            Pattern::Grid { steps, .. } => {
                let counts: Vec<String> = steps.iter().flatten().map(ToString::to_string).collect();
                format!("grid, {} points", counts.join(" × "))
            }
            Pattern::Lattice { step, along_border, .. } => {
                let border = if *along_border { " along the border" } else { "" };
                format!("lattice{border}, step {}", named(step))
            }
            Pattern::Arc { lever, pitch, yaw } => {
                let lever = units.length(*lever);
                format!("arc, lever {lever}, {} angles at {} yaws", pitch.len(), yaw.len())
            }
            Pattern::Bracket { .. } => format!("bracket, {} lines", self.counts.lines),
        };
        pattern + positive
    }

    /// A row per trial, in units of the design and degrees; `outcome` and `notes` are empty.
    fn for_the_robot(&self, design: &Design) -> Table {
        let errors: Vec<PoseError> = self.points.iter().map(|point| point.error).collect();
        let poses = PoseColumns::new(design, &errors, self.offsets_at);
        let columns = ["trial", "block", "line"].map(Column::data).into_iter().chain(poses.errors());
        let columns = columns.chain([Column::data("predicted")]).chain(poses.margins());
        let mut table = Table::new(columns.chain(["repeat", "outcome", "notes"].map(Column::data)));
        for trial in &self.trials {
            let point = &self.points[trial.point];
            let cells = [trial.number, trial.block, point.line].map(Into::into).into_iter();
            let cells = cells.chain(poses.values(&point.error)).chain([point.prediction.word().into()]);
            let cells = cells.chain(poses.margin(&point.prediction));
            table.push(cells.chain([trial.repeat.into(), "".into(), "".into()]));
        }
        table
    }
}
