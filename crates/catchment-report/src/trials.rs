//! Trials beside the exact region: as versioned JSON, as text, as rows for programs.

use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::text::{line, number, percent, significant};
use catchment_core::design::Design;
use catchment_core::pose::Dof;
use catchment_study::trials::{Round, Trials};
use serde::Serialize;
use serde_json::Value;

/// Trials beside the exact region, with their head.
pub type TrialsReport = Envelope<TrialsBody>;

/// Trials beside the exact region.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialsBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// What decided the trials.
    pub method: String,
    /// Its settings, but for the time step, which the rounds have.
    pub settings: Value,
    /// Seed of the places in the cells.
    pub seed: u64,
    /// `D` or `D²`: of all measures.
    pub unit: &'static str,
    /// Measure of the exact region.
    pub exact: f64,
    /// One per resolution and time step.
    pub rounds: Vec<Round>,
    /// The trials of the last round.
    pub trials: Vec<TrialReport>,
}

/// A trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialReport {
    /// Offset in x, D.
    pub x: f64,
    /// Offset in y, D.
    pub y: f64,
    /// What became of it.
    pub outcome: catchment_core::acceptance::Outcome,
    /// Whether the exact region holds it.
    pub inside: bool,
}

impl Body for TrialsBody {
    const KIND: &'static str = "trials";
}

impl TrialsReport {
    /// Of a study, with the doubts about its design.
    pub fn new(
        design: &Design,
        found: &Trials,
        warnings: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let trial = |trial: &catchment_study::trials::Trial| TrialReport {
            x: trial.error.x,
            y: trial.error.y,
            outcome: trial.outcome,
            inside: trial.inside,
        };
        let body = TrialsBody {
            design: design.clone(),
            method: found.settings.method.name().to_owned(),
            settings: found.settings.method.settings(),
            seed: found.settings.seed,
            unit: if found.grid.axes.len() == 2 { "D²" } else { "D" },
            exact: found.exact,
            rounds: found.rounds.clone(),
            trials: found.last.iter().map(trial).collect(),
        };
        Self::of(body, warnings, timing)
    }

    /// For eyes: a line per round.
    pub fn table(&self) -> String {
        let mut text = String::new();
        line(&mut text, &self.design.name);
        let told = format!(
            "  without rotation, exactly: {} {}; beside it trials by {}",
            significant(self.exact),
            self.unit,
            self.method
        );
        line(&mut text, &told);
        let head = format!(
            "  {:>7} {:>9} {:>8} {:>9} {:>8} {:>9}   {}",
            "trials", "step [s]", "accepted", "rejected", "accepted", "disagree", "95 % interval"
        );
        line(&mut text, &head);
        line(&mut text, &format!("  {:>7} {:>9} {:>8} {:>9} {:>8}", "", "", self.unit, "inside", "outside"));
        for round in &self.rounds {
            let step = round.timestep.map_or_else(String::new, number);
            let [lo, hi] = round.disagreeing_ci95.map(percent);
            let told = format!(
                "  {:>7} {:>9} {:>8.4} {:>9} {:>8} {:>9}   {lo} … {hi}",
                round.trials,
                step,
                round.accepted,
                round.rejected_inside,
                round.accepted_outside,
                percent(round.disagreeing),
            );
            line(&mut text, &told);
        }
        text
    }

    /// The trials of the last round as records for programs, the names of the columns first: free offsets in D, outcome, and whether the
    /// exact region holds them.
    pub fn records(&self) -> Vec<Vec<String>> {
        let free = |dof: Dof| self.design.alignment.free.contains(dof);
        let row = |x: String, y: String, outcome: &str, inside: String| {
            let places = [(Dof::X, x), (Dof::Y, y)].into_iter().filter(|(dof, _)| free(*dof));
            places.map(|(_, text)| text).chain([outcome.to_owned(), inside]).collect()
        };
        let mut records = vec![row("x".to_owned(), "y".to_owned(), "outcome", "inside".to_owned())];
        records.extend(self.trials.iter().map(|trial| {
            row(number(trial.x), number(trial.y), trial.outcome.name(), trial.inside.to_string())
        }));
        records
    }
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::design;
    use super::*;
    use catchment_core::acceptance::Outcome;
    use catchment_core::landscape::Grid;
    use catchment_core::method::zraa::Zraa;
    use catchment_core::pose::PoseError;
    use catchment_study::trials::{Settings, Trial};

    /// Two trials along x, one of them on the wrong side.
    pub(crate) fn found() -> (Design, Trials) {
        let design = design([Dof::X].into_iter().collect());
        let settings =
            Settings { method: "descent".parse().unwrap(), resolutions: vec![2], halvings: 0, seed: 7 };
        let round = Round {
            resolution: 2,
            timestep: Some(1e-3),
            trials: 2,
            rejected_inside: 1,
            accepted_outside: 0,
            undecided: 0,
            disagreeing: 0.5,
            disagreeing_ci95: [0.1, 0.9],
            measure: 1.0,
            measure_ci95: [0.2, 1.8],
            accepted: 1.0,
        };
        let trial =
            |x: f64, outcome| Trial { error: PoseError { x, ..PoseError::default() }, outcome, inside: true };
        let zraa = Zraa::Interval { axis: Dof::X, from: -0.5, to: 0.5 };
        let grid = Grid::over(&design.alignment, |_| 2);
        let last = vec![trial(-0.25, Outcome::Aligned), trial(0.25, Outcome::Jammed)];
        (design, Trials { settings, exact: 1.0, zraa, rounds: vec![round], grid, last })
    }

    #[test]
    fn rounds_and_trials_are_told() {
        let (design, found) = found();
        let report = TrialsReport::new(&design, &found, Vec::new(), None);
        let json: Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
        assert_eq!((&json["kind"], &json["unit"], &json["seed"]), (&"trials".into(), &"D".into(), &7.into()));
        assert_eq!(json["rounds"][0]["rejected_inside"], 1);
        assert_eq!(
            (&json["trials"][1]["outcome"], &json["trials"][1]["inside"]),
            (&"jammed".into(), &true.into())
        );
        let table = report.table();
        assert!(table.contains("50.00 %   10.00 % … 90.00 %") && table.contains("0.001"), "{table}");
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        assert_eq!(
            report.records(),
            [
                vec!["x", "outcome", "inside"],
                vec!["-0.25", "aligned", "true"],
                vec!["0.25", "jammed", "true"]
            ]
        );
    }

    #[cfg(feature = "figure")]
    #[test]
    fn theory_and_trials_are_drawn_side_by_side() {
        use crate::figure::testing::look;
        let (design, line) = found();
        let picture = crate::figure::trials(&design, &line);
        look("trials-line", &picture);
        let design = crate::schema::testing::design([Dof::X, Dof::Y].into_iter().collect());
        let corner = |x: f64, y: f64| glam::DVec2::new(x, y);
        let polygons = vec![vec![corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)]];
        let grid = Grid::over(&design.alignment, |_| 12);
        let last = (0..144)
            .map(|k| {
                let error = grid.pose(k);
                let inside = error.x.abs().max(error.y.abs()) < 0.5;
                let aligned = inside != (k % 17 == 0);
                Trial { error, outcome: if aligned { Outcome::Aligned } else { Outcome::Missed }, inside }
            })
            .collect();
        let region = Trials { zraa: Zraa::Region { polygons, area: 1.0, seam: 0.0 }, grid, last, ..line };
        let picture = crate::figure::trials(&design, &region);
        look("trials-region", &picture);
        assert!(picture.svg().contains("on the wrong side") && !picture.svg().contains("NaN"));
    }
}
