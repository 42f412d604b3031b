//! Whether robots dock, for people: 80 columns, the design's unit and degrees.

use super::super::table::heading;
use super::super::text::{self, grouped, line, percent, row, significant, wrapped};
use super::{DockingReport, FirstReport, FitReport, SuccessesReport};
use catchment_core::pose::{Dof, PoseError};
use catchment_study::success::Factor;

impl SuccessesReport {
    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "method", &format!("descent, {} motions", grouped(self.motions)));
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        for robot in &self.robots {
            text.push('\n');
            self.robot(&mut text, robot);
        }
        if self.robots.len() > 1 {
            text.push('\n');
            let said = format!("{}, {}", self.success.robot, chance(self.success.probability));
            row(&mut text, "most seldom", &said);
        }
        self.append_warnings(&mut text);
        text
    }

    fn robot(&self, text: &mut String, robot: &DockingReport) {
        let [lo, hi] = robot.ci95;
        wrapped(text, &format!("  {:<15}", "robot"), &format!("{}: {}", robot.robot, self.errors(robot)));
        row(
            text,
            "success",
            &format!("{}   (95 %: {} … {})", chance(robot.probability), chance(lo), chance(hi)),
        );
        let cost = if robot.grid.cells > 0 {
            format!(
                "{} exact motions; as sure as {} plain ones",
                grouped(robot.motions),
                grouped(rounded(robot.plain_motions))
            )
        } else {
            format!("{} exact motions, each error alike", grouped(robot.motions))
        };
        row(text, "", &cost);
        if let Some(fit) = &robot.fit {
            told_fit(text, robot, fit);
        }
        self.failures(text, robot);
        text.push('\n');
        self.improve(text, robot);
    }

    /// `normal, σ x 1.000 mm, yaw 2.00°`
    fn errors(&self, robot: &DockingReport) -> String {
        let errors = &robot.errors;
        let sigma = errors.sigma.to_array();
        let axes = Dof::ALL.into_iter().filter(|dof| sigma[dof.index()] > 0.0);
        let said: Vec<String> =
            axes.map(|axis| format!("{} {}", axis.name(), self.length(axis, sigma[axis.index()]))).collect();
        let correlated = (0..5).any(|i| (0..i).any(|j| errors.correlation[i][j] != 0.0));
        let kind = match (errors.kind, errors.rows) {
            ("measured", Some(rows)) => format!("{} measured errors", grouped(rows)),
            ("normal", _) if correlated => "correlated normal errors".to_owned(),
            (kind, _) => format!("{kind} errors"),
        };
        let mean = if errors.mean.to_array().iter().any(|mean| *mean != 0.0) {
            format!(", around {}", self.place(&errors.mean, &errors.sigma))
        } else {
            String::new()
        };
        format!("{kind}, σ {}{mean}", said.join(", "))
    }

    fn failures(&self, text: &mut String, robot: &DockingReport) {
        let failures = &robot.failures;
        if failures.share == 0.0 && failures.first.as_ref().is_none_or(|first| first.distance > 0.0) {
            row(text, "failures", "none was met");
            if let Some(first) = &failures.first {
                self.first(text, robot, first, "further out");
            }
            return;
        }
        let mut kinds: Vec<String> =
            [("jammed", failures.jammed), ("missed", failures.missed), ("undecided", failures.undecided)]
                .into_iter()
                .filter(|(_, share)| *share > 0.0)
                .map(|(name, share)| format!("{:.0} % {name}", 100.0 * share))
                .collect();
        if kinds.is_empty() {
            kinds.push("none of the sample".to_owned());
        }
        let along = failures.dominating.and_then(|axis| {
            let along = failures.along.iter().find(|along| along.axis == axis)?;
            Some(format!(
                "; mostly by {}: {:.1} σ on average, {:.1} σ where it docks",
                axis.name(),
                along.failed?,
                along.docked?
            ))
        });
        wrapped(
            text,
            &format!("  {:<15}", "failures"),
            &format!("{}{}", kinds.join(", "), along.unwrap_or_default()),
        );
        match &failures.first {
            Some(first) if first.distance == 0.0 => {
                row(text, "fails first", &format!("at its mean: {}", first.outcome.name()));
            }
            Some(first) => self.first(text, robot, first, "fails first"),
            None => {}
        }
    }

    fn first(&self, text: &mut String, robot: &DockingReport, first: &FirstReport, name: &str) {
        let unit = if robot.errors.kind == "uniform" { "of the half-width" } else { "σ" };
        let said: Vec<String> = robot
            .failures
            .along
            .iter()
            .map(|along| format!("{} {:+.2}", along.axis.name(), first.sigmas.to_array()[along.axis.index()]))
            .collect();
        let distance = format!("{}, at a distance of {:.2}", first.outcome.name(), first.distance);
        wrapped(text, &format!("  {name:<15}"), &format!("{} {unit}: {distance}", said.join(", ")));
        row(text, "", &self.place(&first.error, &robot.errors.sigma));
    }

    fn improve(&self, text: &mut String, robot: &DockingReport) {
        let required = percent(robot.tolerable.required);
        line(
            text,
            &format!(
                "  {:<9}{:>12}{:>22}{:>14}   {:>17}",
                "improve",
                "σ",
                "halved: success",
                "gain, points",
                format!("σ for {required}")
            ),
        );
        for improve in &robot.improve {
            let alone = robot.tolerable.alone.iter().find(|alone| alone.axis == improve.axis);
            let allowed = alone.map_or_else(String::new, |alone| match alone.factor {
                Factor { is_less: true, .. } => "not by it alone".to_owned(),
                Factor { is_more: true, .. } => format!("> {}", self.length(improve.axis, alone.sigma)),
                _ => self.length(improve.axis, alone.sigma),
            });
            let [lo, hi] = improve.gain_ci95;
            let doubt = if lo <= 0.0 && hi >= 0.0 { "?" } else { "" };
            line(
                text,
                &format!(
                    "  {:<9}{:>12}{:>22}{:>13}{doubt:<1}   {allowed:>17}",
                    improve.axis.name(),
                    self.length(improve.axis, improve.sigma),
                    chance(improve.halved),
                    points(improve.gain),
                ),
            );
        }
        if robot.improve.iter().any(|improve| improve.gain_ci95[0] <= 0.0 && improve.gain_ci95[1] >= 0.0) {
            line(text, "  ? within what the random errors leave open");
        }
        let all = robot.tolerable.all;
        let said = match all {
            Factor { is_less: true, .. } => format!("{required} is not reached however small they all are"),
            Factor { is_more: true, factor, .. } => {
                format!("{required} still holds with all of them {} times as large", significant(factor))
            }
            Factor { factor, ci95: [lo, hi], .. } if lo <= 0.0 => {
                format!("{required} with all of them times {factor:.2}   (95 %: at most {hi:.2})")
            }
            Factor { factor, ci95: [lo, hi], .. } => {
                format!("{required} with all of them times {factor:.2}   (95 %: {lo:.2} … {hi:.2})")
            }
        };
        row(text, "together", &said);
        if all.factor > 0.0 && all.ci95[0] <= 0.0 && !all.is_less && !all.is_more {
            row(text, "", "more motions would tell");
        }
    }

    /// `1.250 mm`, `0.0250 D` or `3.00°`.
    fn length(&self, axis: Dof, value: f64) -> String {
        if axis.is_rotation() {
            return format!("{:.2}°", value.to_degrees());
        }
        match self.design.unit {
            Some(unit) => {
                format!("{} {}", text::length(value * self.design.width, self.design.width), unit.symbol())
            }
            None => format!("{value:.4} D"),
        }
    }

    /// The errors that vary or are not 0.
    fn place(&self, error: &PoseError, sigma: &PoseError) -> String {
        let (error, sigma) = (error.to_array(), sigma.to_array());
        let said: Vec<String> = Dof::ALL
            .into_iter()
            .filter(|dof| sigma[dof.index()] > 0.0 || error[dof.index()] != 0.0)
            .map(|dof| format!("{} {}", dof.name(), self.length(dof, error[dof.index()])))
            .collect();
        said.join(", ")
    }
}

/// The normal fit beside measured errors.
fn told_fit(text: &mut String, robot: &DockingReport, fit: &FitReport) {
    let verdict = if fit.rejected { "rejected" } else { "not rejected" };
    let p = if fit.p_value < 0.001 { "p < 0.001".to_owned() } else { format!("p = {:.3}", fit.p_value) };
    let success = match (fit.probability, fit.ci95) {
        (Some(probability), Some([lo, hi])) => {
            format!(": {} by it ({} … {})", chance(probability), chance(lo), chance(hi))
        }
        _ => String::new(),
    };
    row(text, "normal fit", &format!("{verdict}, {p}{success}"));
    if !fit.rejected {
        let worst = fit.axes.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value));
        if let (Some(worst), Some(rows)) = (worst, robot.errors.rows) {
            let said =
                format!("least normal is {}; {} rows reject what is far from normal only", worst.axis, rows);
            if rows < FEW {
                row(text, "", &said);
            }
        }
    }
}

/// Fewer rows reject little.
const FEW: usize = 50;

/// `98.76 %`; between that and certainty as many digits as tell them apart.
pub(crate) fn chance(probability: f64) -> String {
    let left = 1.0 - probability;
    match left {
        l if l > 0.0 && l < 5e-5 => format!("{:.4} %", 100.0 * probability),
        l if l > 0.0 && l < 5e-4 => format!("{:.3} %", 100.0 * probability),
        _ => percent(probability),
    }
}

/// A difference of two probabilities: `+4.6 points`.
fn points(gain: f64) -> String {
    let shown = format!("{:+.2}", 100.0 * gain);
    if shown == "-0.00" { "+0.00".to_owned() } else { shown }
}

/// To two digits.
fn rounded(count: f64) -> usize {
    if !(count.is_finite() && count > 0.0) {
        return 0;
    }
    let scale = 10f64.powf(count.log10().floor() - 1.0).max(1.0);
    ((count / scale).round() * scale) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::testing::design;
    use catchment_core::exec::Exec;
    use catchment_core::poses::{Robot, Spread};
    use catchment_core::problem::Problem;
    use catchment_study::success::{Settings, run};

    /// An interval that begins at nothing says only where it ends.
    #[test]
    fn a_factor_that_is_known_from_above_alone_is_told_so() {
        let problem = Problem::of(design([Dof::X].into_iter().collect())).unwrap();
        let errors = Spread::normal(PoseError { x: 0.2, ..PoseError::default() });
        let robots = [Robot { name: "robot".to_owned(), errors }];
        let settings = Settings { motions: Some(100), ..Settings::default() };
        let found = run(&problem, &robots, &settings, &Exec::new()).unwrap();
        let mut report = SuccessesReport::new(problem.design(), &found, Vec::new(), None);
        let all = &mut report.robots[0].tolerable.all;
        *all = Factor { factor: 1.08, ci95: [0.0, 1.12], is_more: false, is_less: false };
        let told = report.table();
        assert!(told.contains("times 1.08   (95 %: at most 1.12)\n"), "{told}");
        assert!(told.contains("more motions would tell") && told.lines().all(|l| l.chars().count() <= 80));
        report.robots[0].tolerable.all.ci95[0] = 0.9;
        assert!(report.table().contains("(95 %: 0.90 … 1.12)") && !report.table().contains("more motions"));
    }
}
