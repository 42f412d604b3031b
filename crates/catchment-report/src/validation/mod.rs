//! A verdict on a prediction: as versioned JSON, as text, as records for programs.

use super::bench::Told;
use super::envelope::{Body, Envelope};
use super::plan::PlanPointReport;
use super::schema::{Timing, WarningReport};
use catchment_core::design::Design;
use catchment_core::pose::PoseError;
use catchment_core::poses::{Observed, OffsetsAt};
use catchment_study::validate::{OneSided, Settings, Validation, Verdict};
use serde::Serialize;

mod text;

/// What a verdict has to say, with its head.
pub type ValidationReport = Envelope<ValidationBody>;

/// What a verdict has to say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ValidationBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// The point at which the table gave x and y; those of this report are of the face centre.
    pub offsets_at: OffsetsAt,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict as a number for requirements: 1 consistent, 0 undecided, −1 inconsistent.
    pub consistent: i8,
    /// What it rests on.
    pub evidence: EvidenceReport,
    /// Predicted and observed, poses that may go either way apart.
    pub counts: Vec<CountReport>,
    /// How often trials fared as predicted, those apart that may go either way.
    pub agreement: AgreedReport,
    /// Failures where docking was predicted.
    pub early: OneSidedReport,
    /// Docked where it was not.
    pub late: OneSidedReport,
    /// Every trial whose outcome contradicts the prediction, the farthest from the border first; none within one accuracy of it.
    pub disagreements: Vec<TriedReport>,
    /// Where the border was seen.
    pub lines: Vec<LineReport>,
    /// Which friction explains the trials; null where that was not asked for.
    pub friction: Option<ExplainingReport>,
    /// Every trial in the order of the table.
    pub trials: Vec<TriedReport>,
    /// Trials that were not made.
    pub blank: usize,
    /// Exact motions in all.
    pub motions: usize,
}

/// What a verdict rests on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EvidenceReport {
    /// Trials beyond the limit, predicted to dock.
    pub inside: usize,
    /// The same, predicted to fail.
    pub outside: usize,
    /// Of both, otherwise than predicted.
    pub beyond: usize,
    /// The chance that the robot's own errors make so many, or so far ones.
    pub p_value: f64,
}

/// So many trials were predicted and seen like that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CountReport {
    /// What was predicted; null where that was undecided.
    pub predicted: Option<Observed>,
    /// What was seen.
    pub observed: Observed,
    /// Whether the poses may go either way.
    pub either: bool,
    /// How many.
    pub trials: usize,
}

/// How often trials fared as predicted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AgreedReport {
    /// Trials at least one accuracy from the border.
    pub trials: usize,
    /// Of them, as predicted.
    pub agreed: usize,
    /// Their share; null without trials.
    pub share: Option<f64>,
    /// Clopper and Pearson's 95 % interval of it.
    pub ci95: [f64; 2],
}

/// Disagreements on one side of the border.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OneSidedReport {
    /// How many.
    pub disagreeing: usize,
    /// Of so many on that side, one accuracy from the border or more.
    pub trials: usize,
    /// So many are expected at most of the robot's errors.
    pub expected: f64,
    /// The chance of so many or more: one-sided.
    pub p_value: f64,
}

/// A trial, in D and radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TriedReport {
    /// Its number.
    pub trial: u64,
    /// What was seen; null where it was not made.
    pub observed: Option<Observed>,
    /// Whether the outcome contradicts the prediction; never within one accuracy of the border.
    pub disagrees: bool,
    /// Its pose, and what was to be expected there.
    #[serde(flatten)]
    pub point: PlanPointReport,
}

/// A line, in D and radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LineReport {
    /// Its number.
    pub line: u64,
    /// Trials on it.
    pub trials: usize,
    /// The outermost pose that docked.
    pub last_success: Option<PoseError>,
    /// The innermost pose that did not.
    pub first_failure: Option<PoseError>,
    /// The outermost pose predicted to dock.
    pub predicted_success: Option<PoseError>,
    /// The innermost pose predicted to fail.
    pub predicted_failure: Option<PoseError>,
    /// Whether all that docked lies nearer to zero than all that did not.
    pub in_order: bool,
}

/// Which friction explains the trials.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExplainingReport {
    /// Whether some coefficient leaves no disagreement beyond the limit.
    pub explains: bool,
    /// The fewest that any coefficient leaves.
    pub fewest: usize,
    /// The smallest coefficient that leaves so few.
    pub low: f64,
    /// The largest.
    pub high: f64,
    /// It goes on beyond the largest that was tried.
    pub open: bool,
    /// Some coefficient between them leaves more.
    pub broken: bool,
    /// Every coefficient that was tried.
    pub tried: Vec<FrictionTried>,
}

/// What a coefficient leaves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrictionTried {
    /// The coefficient.
    pub friction: f64,
    /// Disagreements beyond the limit.
    pub beyond: usize,
}

const fn one_sided(found: &OneSided) -> OneSidedReport {
    OneSidedReport {
        disagreeing: found.disagreeing,
        trials: found.trials,
        expected: found.expected,
        p_value: found.p_value,
    }
}

impl Body for ValidationBody {
    const KIND: &'static str = "validate";
}

impl ValidationReport {
    /// Of a design; the table gave offsets at a point.
    pub fn new(
        design: &Design,
        found: &Validation,
        offsets_at: OffsetsAt,
        mut doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        doubts.extend(text::doubts(found).iter().map(WarningReport::note));
        let trials: Vec<TriedReport> = found
            .trials
            .iter()
            .map(|judged| TriedReport {
                trial: judged.tried.trial,
                observed: judged.tried.observed,
                disagrees: judged.disagrees(),
                point: PlanPointReport::new(judged.tried.error, judged.tried.line as usize, &judged.foretold),
            })
            .collect();
        let mut disagreements: Vec<TriedReport> =
            trials.iter().copied().filter(|trial| trial.disagrees).collect();
        let far = |trial: &TriedReport| trial.point.margin_in_sigma.unwrap_or(f64::INFINITY);
        disagreements.sort_by(|a, b| far(b).total_cmp(&far(a)));
        let friction = found.friction.as_ref().map(|friction| ExplainingReport {
            explains: friction.fewest == 0,
            fewest: friction.fewest,
            low: friction.interval[0],
            high: friction.interval[1],
            open: friction.open,
            broken: friction.broken,
            tried: friction
                .tried
                .iter()
                .map(|(friction, beyond)| FrictionTried { friction: *friction, beyond: *beyond })
                .collect(),
        });
        let lines = found.lines.iter().map(|line| LineReport {
            line: line.number,
            trials: line.made,
            last_success: line.last_success,
            first_failure: line.first_failure,
            predicted_success: line.predicted[0],
            predicted_failure: line.predicted[1],
            in_order: line.in_order,
        });
        let counts = found.counts.iter().map(|count| CountReport {
            predicted: count.predicted,
            observed: count.observed,
            either: count.either,
            trials: count.trials,
        });
        let agreement = found.agreement;
        let body = ValidationBody {
            design: design.clone(),
            settings: found.settings.clone(),
            offsets_at,
            verdict: found.verdict,
            consistent: match found.verdict {
                Verdict::Consistent => 1,
                Verdict::Undecided => 0,
                Verdict::Inconsistent => -1,
            },
            evidence: EvidenceReport {
                inside: found.deciding[0],
                outside: found.deciding[1],
                beyond: found.beyond,
                p_value: found.p_value,
            },
            counts: counts.collect(),
            agreement: AgreedReport {
                trials: agreement.trials,
                agreed: agreement.agreed,
                share: (agreement.trials > 0).then(|| agreement.agreed as f64 / agreement.trials as f64),
                ci95: agreement.ci95,
            },
            early: one_sided(&found.early),
            late: one_sided(&found.late),
            disagreements,
            lines: lines.collect(),
            friction,
            trials,
            blank: found.blank,
            motions: found.motions,
        };
        Self::of(body, doubts, timing)
    }

    /// A line per trial for programs, the names of the columns first: units of the design, degrees.
    pub fn records(&self) -> Vec<Vec<String>> {
        let told = Told { design: &self.design };
        let errors: Vec<PoseError> = self.trials.iter().map(|trial| trial.point.error).collect();
        let columns = told.columns(&errors, self.offsets_at);
        let unit = self.design.unit.map_or_else(String::new, |unit| format!("_{}", unit.symbol()));
        let mut head: Vec<String> = ["trial", "line"].map(str::to_owned).to_vec();
        head.extend(columns.iter().map(|(name, _)| name.clone()));
        head.extend(["predicted", "observed", "either", "disagrees"].map(str::to_owned));
        head.extend([format!("distance_to_border{unit}"), "margin_in_sigma".to_owned()]);
        let mut records = vec![head];
        let name =
            |observed: Option<Observed>, none: &'static str| observed.map_or(none, Observed::name).to_owned();
        for trial in &self.trials {
            let TriedReport { point, .. } = trial;
            let mut record = vec![trial.trial.to_string(), point.line.to_string()];
            record.extend(columns.iter().map(|(_, axis)| told.cell(&point.error, *axis, self.offsets_at)));
            record.extend([name(point.predicted, "undecided"), name(trial.observed, "")]);
            record.extend([point.either.to_string(), trial.disagrees.to_string()]);
            let short = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
            record.push(short(point.distance_to_border.map(|distance| distance * told.width())));
            record.push(short(point.margin_in_sigma));
            records.push(record);
        }
        records
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::exec::Exec;
    use catchment_core::poses::Tried;
    use catchment_core::problem::Problem;
    use catchment_study::validate::run;
    use std::path::Path;

    /// A V-Face that slides along x alone: the border is at D/2. Trials within one accuracy of it are counted apart, and stand
    /// neither in the list of disagreements nor in its column.
    #[test]
    fn disagreements_leave_out_trials_within_one_accuracy_of_the_border() {
        let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
        let problem = Problem::of(catchment_core::design::read(text, Path::new("")).unwrap().design).unwrap();
        let seen = [
            (0.1, Observed::Aligned),
            (0.49, Observed::Missed),
            (0.499_999, Observed::Jammed),
            (0.51, Observed::Aligned),
            (0.3, Observed::Jammed),
        ];
        let tried = |(k, (x, observed)): (usize, &(f64, Observed))| Tried {
            trial: k as u64 + 1,
            line: 1,
            error: PoseError { x: *x, ..PoseError::default() },
            observed: Some(*observed),
            predicted: None,
        };
        let tried: Vec<Tried> = seen.iter().enumerate().map(tried).collect();
        let settings = Settings::new(PoseError { x: 0.02, ..PoseError::default() });
        let found = run(&problem, &tried, &settings, &Exec::new()).unwrap();
        let report = ValidationReport::new(problem.design(), &found, OffsetsAt::Face, Vec::new(), None);
        let listed: Vec<u64> = report.disagreements.iter().map(|trial| trial.trial).collect();
        assert_eq!(listed, [5]);
        let records = report.records();
        let column = |name: &str| records[0].iter().position(|head| head == name).unwrap();
        let both = [column("either"), column("disagrees")];
        let shown: Vec<[&str; 2]> = records[1..].iter().map(|row| both.map(|k| row[k].as_str())).collect();
        assert_eq!(shown[1..4], [["true", "false"]; 3]);
        assert!(!report.table().contains("0.00 accuracies"), "{}", report.table());
    }
}
