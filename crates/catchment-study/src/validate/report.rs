//! Text and table form of a verdict.

use super::{
    Count, Evidence, FEWEST, FrictionInterval, LEVEL, PredictedTrial, PredictionVerdict, TrialLine,
    Validation,
};
use crate::plan::{PoseColumns, accuracy_words};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{Column, DesignUnits, Document, Subject, Table, grouped, percent};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::ObservedOutcome;

/// Disagreements, and lines, that are shown.
const SHOWN: usize = 10;

impl Subject for Validation {
    const KIND: &'static str = "validate";

    fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        let mut warn = |text: String| warnings.push(Diagnostic::warning(Self::KIND, text));
        let Evidence { inside, outside, beyond, .. } = self.evidence;
        let limit = self.settings.limit;
        if self.verdict == PredictionVerdict::Undecided {
            warn(format!(
                "{} trials are {limit} accuracies or more from the border, and a verdict takes {FEWEST}: try more poses, or with a more accurate robot",
                inside + outside
            ));
        } else if outside == 0 {
            warn(
                "no trial beyond the border decides: the border is not nearer than predicted, but may be farther"
                    .to_owned(),
            );
        } else if inside == 0 {
            warn(
                "no trial inside the border decides: the border is no farther than predicted, but may be nearer"
                    .to_owned(),
            );
        }
        if self.early.p_value < LEVEL && self.early.disagreeing > 0 {
            warn(format!(
                "{} of {} trials failed where docking was predicted, and errors of the robot explain {:.1} of them at most: friction, or a border \
                 that is predicted too far out",
                self.early.disagreeing, self.early.trials, self.early.expected
            ));
        }
        if beyond > 0 && self.verdict == PredictionVerdict::Consistent {
            warn(format!(
                "{beyond} trials beyond {limit} accuracies disagree; of so many trials the robot's errors explain that"
            ));
        }
        if self.turned > 0 {
            warn(format!("{} trials docked, but in another orientation than predicted", self.turned));
        }
        if self.differing_predictions > 0 {
            warn(format!(
                "the prediction in the table differs from that of this design for {} trials: it was planned for another one, or with other friction",
                self.differing_predictions
            ));
        }
        warnings
    }

    fn setup(&self, design: &Design, document: &mut Document) {
        document.row("method", format!("descent, {} motions, no grid", grouped(self.motions)));
        if self.settings.friction > 0.0 {
            document.row("friction", format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        document.row("accuracy", accuracy_words(design, &self.settings.accuracy));
    }

    fn document(&self, design: &Design) -> Document {
        let units = DesignUnits::of(design);
        let mut document = Document::default();
        self.describe_verdict(&mut document);
        document.section(None).table(self.matrix());
        if let Some(friction) = &self.friction {
            friction.describe(&mut document);
        }
        self.describe_lines(&mut document, units);
        self.describe_disagreements(&mut document, units);
        document.table(self.for_programs(design));
        document
    }
}

impl Validation {
    fn describe_verdict(&self, document: &mut Document) {
        let Evidence { inside, outside, beyond, p_value } = self.evidence;
        document.section(None).row("verdict", self.verdict.name());
        document.more(format!(
            "{} trials are {} accuracies or more from the border, {inside} inside and {outside} outside; {beyond} of them disagree",
            inside + outside,
            self.settings.limit,
        ));
        if p_value < 1.0 {
            document.more(format!("by the errors of the robot alone: chance {}", chance(p_value)));
        }
        if let Some(share) = self.agreement.share {
            let [low, high] = self.agreement.ci95.map(percent);
            document.row(
                "agreement",
                format!(
                    "{} of {} trials, {} (95 % CI {low} … {high})",
                    self.agreement.agreed,
                    self.agreement.trials,
                    percent(share)
                ),
            );
        }
        for (name, side, predicted) in [
            ("early failures", &self.early, "predicted to dock"),
            ("late successes", &self.late, "predicted to fail"),
        ] {
            if side.trials > 0 {
                let by_chance = if side.disagreeing > 0 {
                    format!(", chance {}", chance(side.p_value))
                } else {
                    String::new()
                };
                document.row(name, format!("{} of {} {predicted}{by_chance}", side.disagreeing, side.trials));
            }
        }
        if self.blank > 0 {
            document.row("not made", format!("{} trials", grouped(self.blank)));
        }
    }

    /// Trials by their predicted and observed outcome.
    fn matrix(&self) -> Table {
        let outcomes = ObservedOutcome::ALL.map(|observed| Column::new(observed.word()));
        let mut table = Table::new([Column::new("predicted \\ observed").left()].into_iter().chain(outcomes));
        let mut rows: Vec<(bool, Option<ObservedOutcome>)> = Vec::new();
        for Count { either, predicted, .. } in &self.counts {
            if !rows.contains(&(*either, *predicted)) {
                rows.push((*either, *predicted));
            }
        }
        for row in rows {
            let trials = |observed: ObservedOutcome| {
                let same =
                    |count: &&Count| (count.either, count.predicted) == row && count.observed == observed;
                self.counts.iter().find(same).map_or(0, |count| count.trials).into()
            };
            let (either, predicted) = row;
            let name = predicted.map_or("undecided", ObservedOutcome::word);
            let name = if either { format!("either ({name})") } else { name.to_owned() };
            table.push([name.into()].into_iter().chain(ObservedOutcome::ALL.map(trials)));
        }
        table
    }

    fn describe_lines(&self, document: &mut Document, units: DesignUnits<'_>) {
        let crossed: Vec<(&TrialLine, PoseError, PoseError)> = self
            .lines
            .iter()
            .filter_map(|line| Some((line, line.last_success?, line.first_failure?)))
            .collect();
        if crossed.is_empty() {
            return;
        }
        document.titled(Some(format!(
            "the observed border, along {} of {} lines",
            crossed.len(),
            self.lines.len()
        )));
        let mut table =
            Table::new([Column::new("line"), Column::new("docks at").left(), Column::new("fails at").left()]);
        for (line, docked, failed) in crossed.iter().take(SHOWN) {
            let axes = differing(docked, failed);
            let words = |pose: &PoseError| {
                let part = |axis: &Dof| {
                    format!("{} {}", axis.name(), units.amount(*axis, pose.to_array()[axis.index()]))
                };
                axes.iter().map(part).collect::<Vec<_>>().join(", ")
            };
            let order = if line.in_order { "" } else { " (mixed)" };
            table.push([line.number.into(), words(docked).into(), (words(failed) + order).into()]);
        }
        document.table(table);
        more(document, crossed.len());
    }

    fn describe_disagreements(&self, document: &mut Document, units: DesignUnits<'_>) {
        if self.disagreements.is_empty() {
            return;
        }
        document.section("trials that contradict the prediction, the farthest from the border first");
        let mut table = Table::new([
            Column::new("trial"),
            Column::new("observed").left(),
            Column::new("from the border").left(),
            Column::new("pose error").left(),
        ]);
        for trial in self.disagreements.iter().take(SHOWN) {
            let prediction = trial.prediction();
            let margin = prediction.margin_in_sigma.map_or_else(
                || "no border in the error box".to_owned(),
                |margin| {
                    let share = percent(prediction.margin_in_box.unwrap_or_default());
                    format!("{margin:.2} accuracies, {share} of the error box")
                },
            );
            table.push([
                trial.trial.to_string().into(),
                trial.observed.map(ObservedOutcome::word).into(),
                margin.into(),
                units.pose(&trial.point.error).into(),
            ]);
        }
        document.table(table);
        more(document, self.disagreements.len());
    }

    /// A row per trial, in units of the design and degrees.
    fn for_programs(&self, design: &Design) -> Table {
        let errors: Vec<PoseError> = self.trials.iter().map(|trial| trial.point.error).collect();
        let poses = PoseColumns::new(design, &errors, self.offsets_at);
        let columns = ["trial", "line"].map(Column::data).into_iter().chain(poses.errors());
        let columns = columns.chain(["predicted", "observed", "either", "disagrees"].map(Column::data));
        let mut table = Table::new(columns.chain(poses.margins()));
        for PredictedTrial { trial, observed, disagrees, point, .. } in &self.trials {
            let prediction = &point.prediction;
            let cells = [trial.to_string().into(), point.line.into()].into_iter();
            let cells = cells.chain(poses.values(&point.error)).chain([
                prediction.predicted.map_or("undecided", ObservedOutcome::name).into(),
                observed.map(ObservedOutcome::name).into(),
                prediction.either.into(),
                (*disagrees).into(),
            ]);
            table.push(cells.chain(poses.margin(prediction)));
        }
        table
    }
}

impl FrictionInterval {
    fn describe(&self, document: &mut Document) {
        let high = if self.open { "or more".to_owned() } else { format!("{:.3}", self.high) };
        let range = format!("{:.3} … {high}", self.low);
        let explained = if self.explains {
            format!("{range} explains every trial beyond the limit")
        } else {
            format!("none explains all; {range} leaves {} disagreements", self.fewest)
        };
        document.section(None).row("friction", explained);
        if self.broken {
            document.more("not everywhere between: some coefficients leave more");
        }
        let is_tenth = |friction: f64| ((friction * 10.0).round() / 10.0 - friction).abs() < 1e-9;
        let left: Vec<String> = self
            .tried
            .iter()
            .filter(|tried| is_tenth(tried.friction))
            .map(|tried| format!("{}: {}", tried.friction, tried.beyond))
            .collect();
        document.more(format!("disagreements that each leaves: {}", left.join(", ")));
    }
}

/// The number of rows of a list that are not shown.
fn more(document: &mut Document, count: usize) {
    if count > SHOWN {
        document.paragraph(format!("and {} more", count - SHOWN));
    }
}

/// Errors in which two poses differ.
fn differing(a: &PoseError, b: &PoseError) -> Vec<Dof> {
    let differs = |axis: &Dof| a.to_array()[axis.index()] != b.to_array()[axis.index()];
    Dof::ALL.into_iter().filter(differs).collect()
}

/// A chance in words.
fn chance(p: f64) -> String {
    /// The last digit that is shown.
    const LEAST: f64 = 1e-4;
    if p < LEAST { "< 0.0001".to_owned() } else { format!("{p:.4}") }
}
