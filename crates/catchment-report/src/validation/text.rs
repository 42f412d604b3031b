//! The text of a verdict.

use super::super::bench::Told;
use super::super::table::heading;
use super::super::text::{grouped, line, percent, row, wrapped};
use super::{TriedReport, ValidationReport};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::Observed;
use catchment_study::validate::{FEWEST, LEVEL, Validation, Verdict};

/// Disagreements, and lines, that are shown.
const SHOWN: usize = 10;

impl ValidationReport {
    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let told = Told { design: &self.design };
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "method", &format!("descent, {} motions, no grid", grouped(self.motions)));
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        let accuracy = format!("{} (one standard deviation)", told.accuracy(&self.settings.accuracy));
        wrapped(&mut text, "  accuracy       ", &accuracy);
        text.push('\n');
        row(&mut text, "verdict", self.verdict.name());
        row(
            &mut text,
            "",
            &format!(
                "{} trials are {} accuracies or more from the border,",
                self.evidence.inside + self.evidence.outside,
                self.settings.limit
            ),
        );
        row(
            &mut text,
            "",
            &format!(
                "{} inside and {} outside; of them {} disagree",
                self.evidence.inside, self.evidence.outside, self.evidence.beyond
            ),
        );
        if self.evidence.p_value < 1.0 {
            row(
                &mut text,
                "",
                &format!("by the robot's errors alone: chance {}", chance(self.evidence.p_value)),
            );
        }
        let agreement = &self.agreement;
        if let Some(share) = agreement.share {
            let [low, high] = agreement.ci95.map(percent);
            row(
                &mut text,
                "agreement",
                &format!(
                    "{} of {} trials, {} (95 %: {low} … {high})",
                    agreement.agreed,
                    agreement.trials,
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
                let told = format!("{} of {} {predicted}{by_chance}", side.disagreeing, side.trials);
                row(&mut text, name, &told);
            }
        }
        if self.blank > 0 {
            row(&mut text, "not made", &grouped(self.blank));
        }
        text.push('\n');
        self.matrix(&mut text);
        self.frictions(&mut text);
        self.lines(&mut text, &told);
        self.disagreements(&mut text, &told);
        self.append_warnings(&mut text);
        text
    }

    fn matrix(&self, text: &mut String) {
        line(text, "  predicted \\ observed  aligned  elsewhere   jammed   missed");
        for either in [false, true] {
            let mut predictions: Vec<Option<Observed>> = Vec::new();
            for count in self.counts.iter().filter(|count| count.either == either) {
                if !predictions.contains(&count.predicted) {
                    predictions.push(count.predicted);
                }
            }
            for predicted in predictions {
                let number = |observed: Observed| {
                    let same = |c: &&super::CountReport| {
                        c.either == either && c.predicted == predicted && c.observed == observed
                    };
                    self.counts.iter().find(same).map_or(0, |count| count.trials)
                };
                let [a, e, j, m] = Observed::ALL.map(number);
                let name = predicted.map_or("undecided", Observed::name);
                let name = if either { format!("either ({name})") } else { name.to_owned() };
                line(text, &format!("  {name:<20}  {a:>7}  {e:>9}  {j:>7}  {m:>7}"));
            }
        }
    }

    fn frictions(&self, text: &mut String) {
        let Some(friction) = &self.friction else { return };
        text.push('\n');
        let high = if friction.open { "or more".to_owned() } else { format!("{:.3}", friction.high) };
        let range = format!("{:.3} … {high}", friction.low);
        if friction.explains {
            row(text, "friction", &format!("{range} explains every trial beyond the limit"));
        } else {
            row(text, "friction", &format!("none explains all; {range} leaves {}", friction.fewest));
        }
        if friction.broken {
            row(text, "", "not everywhere between: some coefficients leave more");
        }
        let shown =
            friction.tried.iter().filter(|t| ((t.friction * 10.0).round() / 10.0 - t.friction).abs() < 1e-9);
        let shown_values: Vec<String> =
            shown.map(|tried| format!("{}: {}", tried.friction, tried.beyond)).collect();
        wrapped(text, "                 ", &format!("left by each: {}", shown_values.join(", ")));
    }

    fn lines(&self, text: &mut String, told: &Told<'_>) {
        let crossed: Vec<_> =
            self.lines.iter().filter(|l| l.last_success.is_some() && l.first_failure.is_some()).collect();
        if crossed.is_empty() {
            return;
        }
        text.push('\n');
        line(
            text,
            &format!("  the border as it was seen, along {} of {} lines", crossed.len(), self.lines.len()),
        );
        for seen in crossed.iter().take(SHOWN) {
            let order = if seen.in_order { "" } else { " (mixed)" };
            let [docked, failed] = [seen.last_success, seen.first_failure].map(Option::unwrap_or_default);
            let varying = varying(&docked, &failed);
            let some = |pose: &PoseError| {
                let told: Vec<String> =
                    varying.iter().map(|axis| told.size(*axis, pose.to_array()[axis.index()])).collect();
                told.join(", ")
            };
            let where_ = format!("docks at {}, fails at {}{order}", some(&docked), some(&failed));
            wrapped(text, &format!("  {:>4}  ", seen.line), &where_);
        }
        if crossed.len() > SHOWN {
            line(text, &format!("     …  {} more", crossed.len() - SHOWN));
        }
    }

    fn disagreements(&self, text: &mut String, told: &Told<'_>) {
        if self.disagreements.is_empty() {
            return;
        }
        text.push('\n');
        line(text, "  otherwise than predicted, the farthest from the border first");
        for TriedReport { trial, observed, point, .. } in self.disagreements.iter().take(SHOWN) {
            let seen = observed.map_or("", Observed::name);
            let margin = point.margin_in_sigma.map_or_else(
                || "no border in the error box".to_owned(),
                |margin| {
                    format!(
                        "{margin:.2} accuracies, {} of the box",
                        percent(point.margin_in_box.unwrap_or_default())
                    )
                },
            );
            let pose = format!("{}: {seen}", told.pose(&point.error));
            wrapped(text, &format!("  {trial:>5}  "), &pose);
            line(text, &format!("         {margin}"));
        }
        if self.disagreements.len() > SHOWN {
            line(text, &format!("      …  {} more", self.disagreements.len() - SHOWN));
        }
    }
}

/// Errors in which two poses differ.
fn varying(a: &PoseError, b: &PoseError) -> Vec<Dof> {
    let differs = |axis: &Dof| a.to_array()[axis.index()] != b.to_array()[axis.index()];
    Dof::ALL.into_iter().filter(differs).collect()
}

/// A chance for eyes.
fn chance(p: f64) -> String {
    const LEAST: f64 = 1e-4;
    if p < LEAST { "< 0.0001".to_owned() } else { format!("{p:.4}") }
}

/// What should be known of a verdict.
pub(super) fn doubts(found: &Validation) -> Vec<String> {
    let mut doubts = Vec::new();
    let [inside, outside] = found.deciding;
    let limit = found.settings.limit;
    if found.verdict == Verdict::Undecided {
        doubts.push(format!(
            "{} trials are {limit} accuracies or more from the border, and a verdict takes {FEWEST}: try more poses, or with a more accurate robot",
            inside + outside
        ));
    } else if outside == 0 {
        doubts.push(
            "no trial beyond the border decides: the border is not nearer than predicted, but may be farther"
                .to_owned(),
        );
    } else if inside == 0 {
        doubts.push(
            "no trial inside the border decides: the border is no farther than predicted, but may be nearer"
                .to_owned(),
        );
    }
    if found.early.p_value < LEVEL && found.early.disagreeing > 0 {
        doubts.push(format!(
            "{} of {} trials failed where docking was predicted, and errors of the robot explain {:.1} of them at most: friction, or a border \
             that is predicted too far out",
            found.early.disagreeing, found.early.trials, found.early.expected
        ));
    }
    if found.beyond > 0 && found.verdict == Verdict::Consistent {
        doubts.push(format!(
            "{} trials beyond {limit} accuracies disagree; of so many trials the robot's errors explain that",
            found.beyond
        ));
    }
    if found.turned > 0 {
        doubts.push(format!("{} trials docked, but in another orientation than predicted", found.turned));
    }
    if found.otherwise_planned > 0 {
        doubts.push(format!(
            "of {} trials the table predicts otherwise than this design does: it was planned for another one, or with other friction",
            found.otherwise_planned
        ));
    }
    doubts
}
