//! Text and table form of the success of robots.

use super::{Factor, NearestFailure, NormalFit, RobotDocking, Success};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{
    Cell, Column, DesignUnits, Document, Subject, Table, exact_motions, grouped, percent, significant,
};
use catchment_core::pose::{Dof, PoseError};

/// A larger share of errors outside of the error box is a warning.
const MUCH_OUTSIDE: f64 = 0.01;
/// The name of the only robot of a command line.
const UNNAMED: &str = "robot";
/// Fewer rows reject little.
const FEW: usize = 50;

impl Subject for Success {
    const KIND: &'static str = "success";

    fn warnings(&self) -> Vec<Diagnostic> {
        let is_one_of_many = self.robots.len() > 1;
        let of = |robot: &RobotDocking| {
            let name = if is_one_of_many { format!("{}: ", robot.robot) } else { String::new() };
            robot
                .warnings()
                .into_iter()
                .map(move |text| Diagnostic::warning(Self::KIND, format!("{name}{text}")))
        };
        self.robots.iter().flat_map(of).collect()
    }

    fn setup(&self, _: &Design, document: &mut Document) {
        document.row("method", exact_motions(&self.poses_in_words(), self.settings.friction));
    }

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        document.table(self.records());
        for robot in &self.robots {
            robot.describe(design, &mut document);
        }
        if self.robots.len() > 1 {
            let success = in_percent(self.success.probability);
            document.section(None).row("lowest success", format!("{}, {success}", self.success.robot));
        }
        document
    }
}

impl Success {
    /// `4 020 poses (200 sampled errors; the others for the largest σ and the nearest failure)`
    fn poses_in_words(&self) -> String {
        let sampled: usize = self.robots.iter().map(|robot| robot.motions).sum();
        let all = grouped(self.motions);
        if sampled < self.motions {
            format!(
                "{all} poses ({} sampled errors; the others to search the largest σ and the nearest failure)",
                grouped(sampled)
            )
        } else {
            format!("{all} sampled errors")
        }
    }

    /// Probability, gains and factors of every robot and error.
    fn records(&self) -> Table {
        let mut table = Table::data(
            "robot probability low high axis sigma slope halved gain tolerable_factor tolerable_sigma",
        );
        for robot in &self.robots {
            for improve in &robot.improve {
                let alone = robot.tolerable.alone.iter().find(|alone| alone.axis == improve.axis);
                table.push([
                    robot.robot.as_str().into(),
                    robot.probability.into(),
                    robot.ci95[0].into(),
                    robot.ci95[1].into(),
                    improve.axis.name().into(),
                    improve.sigma.into(),
                    improve.slope.into(),
                    improve.halved.into(),
                    improve.gain.into(),
                    alone.map(|alone| alone.factor.factor).into(),
                    alone.map(|alone| alone.sigma).into(),
                ]);
            }
        }
        table
    }
}

impl RobotDocking {
    /// Why its numbers may be wrong.
    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.failures.first.as_ref().is_some_and(|first| first.distance == 0.0) {
            warnings.push(
                "its mean error alone does not dock: smaller standard deviations do not help".to_owned(),
            );
        }
        if self.undecided > 0 {
            warnings.push(format!(
                "{} of {} motions could not be followed to their end: they count as failures, and the interval reaches to where they \
                 are not",
                self.undecided, self.motions
            ));
        }
        if self.outside_box > MUCH_OUTSIDE {
            warnings.push(format!(
                "{:.1} % of the robot's errors lie outside the design's error box; the success includes them",
                100.0 * self.outside_box
            ));
        }
        let Some(fit) = &self.fit else { return warnings };
        if fit.rejected {
            warnings.push(format!(
                "its measured errors are not normal (p = {:.2}): the probability uses the rows alone; do not trust the normal fit",
                fit.p_value
            ));
        }
        if !fit.trending.is_empty() {
            let names: Vec<&str> = fit.trending.iter().map(|dof| dof.name()).collect();
            warnings.push(format!(
                "neighbouring rows are alike in {}: they are fewer independent measurements than rows, and the interval is too narrow",
                names.join(", ")
            ));
        }
        warnings
    }

    fn describe(&self, design: &Design, document: &mut Document) {
        let named = if self.robot == UNNAMED { String::new() } else { format!("{}: ", self.robot) };
        document.section(None).row("errors", named + &self.errors_in_words(design));
        document.row("success", between(self.probability, self.ci95));
        let motions = grouped(self.motions);
        document.more(if self.grid.cells > 0 {
            let plain = grouped(two_digits(self.plain_motions));
            format!("{motions} sampled errors (stratified sampling: as precise as {plain} independent ones)")
        } else {
            format!("{motions} sampled errors")
        });
        if let Some(fit) = &self.fit {
            fit.describe(self.errors.rows, document);
        }
        self.describe_failures(design, document);
        self.describe_improvements(design, document);
    }

    /// `normal errors, σ x 1.000 mm, yaw 2.00°`
    fn errors_in_words(&self, design: &Design) -> String {
        let moments = &self.errors.moments;
        let sigma = moments.sigma.to_array();
        let axes = Dof::ALL.into_iter().filter(|axis| sigma[axis.index()] > 0.0);
        let sizes: Vec<String> = axes
            .map(|axis| format!("{} {}", axis.name(), amount(design, axis, sigma[axis.index()])))
            .collect();
        let is_correlated = (0..5).any(|i| (0..i).any(|j| moments.correlation[i][j] != 0.0));
        let kind = match (self.errors.kind, self.errors.rows) {
            ("measured", Some(rows)) => format!("{} measured errors", grouped(rows)),
            ("normal", _) if is_correlated => "correlated normal errors".to_owned(),
            (kind, _) => format!("{kind} errors"),
        };
        let mean = if moments.mean.to_array().iter().any(|mean| *mean != 0.0) {
            format!(", around {}", self.pose(design, &moments.mean))
        } else {
            String::new()
        };
        format!("{kind}, standard deviations σ {}{mean}{}", sizes.join(", "), self.without_sigma(design))
    }

    /// The free errors that have no standard deviation: `; roll, pitch without σ: always 0`.
    fn without_sigma(&self, design: &Design) -> String {
        let moments = &self.errors.moments;
        let (sigma, mean) = (moments.sigma.to_array(), moments.mean.to_array());
        let is_zero = |axis: &Dof| sigma[axis.index()] == 0.0 && mean[axis.index()] == 0.0;
        let names: Vec<&str> = design.alignment.free.iter().filter(is_zero).map(Dof::name).collect();
        if names.is_empty() { String::new() } else { format!("; {} without σ: always 0", names.join(", ")) }
    }

    /// The errors of a pose that vary or are not 0.
    fn pose(&self, design: &Design, error: &PoseError) -> String {
        let (error, sigma) = (error.to_array(), self.errors.moments.sigma.to_array());
        let axes = Dof::ALL.into_iter().map(|axis| (axis, error[axis.index()], sigma[axis.index()]));
        let parts: Vec<String> = axes
            .filter(|(_, error, sigma)| *sigma > 0.0 || *error != 0.0)
            .map(|(axis, error, _)| format!("{} {}", axis.name(), amount(design, axis, error)))
            .collect();
        parts.join(", ")
    }

    fn describe_failures(&self, design: &Design, document: &mut Document) {
        let failures = &self.failures;
        if failures.share == 0.0 && failures.first.as_ref().is_none_or(|first| first.distance > 0.0) {
            document.row("failures", "0 in the sample");
            if let Some(first) = &failures.first {
                self.describe_first(first, "nearest failure", design, document);
            }
            return;
        }
        let kinds =
            [("jammed", failures.jammed), ("missed", failures.missed), ("undecided", failures.undecided)];
        let mut kinds: Vec<String> = kinds
            .into_iter()
            .filter(|(_, share)| *share > 0.0)
            .map(|(name, share)| format!("{:.0} % {name}", 100.0 * share))
            .collect();
        if kinds.is_empty() {
            kinds.push("0 in the sample".to_owned());
        }
        let along = failures.dominating.and_then(|axis| {
            let along = failures.along.iter().find(|along| along.axis == axis)?;
            let (axis, failed, docked) = (axis.name(), along.failed?, along.docked?);
            Some(format!(
                "; dominant error {axis} (mean |{axis}| {failed:.1} σ in failures, {docked:.1} σ in successes)"
            ))
        });
        document.row("failures", kinds.join(", ") + &along.unwrap_or_default());
        match &failures.first {
            Some(first) if first.distance == 0.0 => {
                document.row("nearest failure", format!("at the mean error: {}", first.outcome.word()));
            }
            Some(first) => self.describe_first(first, "nearest failure", design, document),
            None => {}
        }
    }

    fn describe_first(&self, first: &NearestFailure, name: &str, design: &Design, document: &mut Document) {
        let unit = if self.errors.kind == "uniform" { "of the half-width" } else { "σ" };
        let sigmas = first.sigmas.to_array();
        let axes = self.failures.along.iter().map(|along| along.axis);
        let parts: Vec<String> =
            axes.map(|axis| format!("{} {:+.2}", axis.name(), sigmas[axis.index()])).collect();
        let (outcome, distance) = (first.outcome.word(), first.distance);
        document
            .row(
                name,
                format!(
                    "{} {unit} from the mean: {outcome}; distance {distance:.2} {unit}",
                    parts.join(", ")
                ),
            )
            .more(self.pose(design, &first.error));
    }

    fn describe_improvements(&self, design: &Design, document: &mut Document) {
        let required = percent(self.tolerable.required);
        let mut table = Table::new([
            Column::new("error").left(),
            Column::new("σ"),
            Column::new("success with σ halved"),
            Column::new("gain (percentage points)"),
            Column::new(format!("largest σ for {required} success")),
        ]);
        let (mut is_open, mut is_beyond) = (false, false);
        for improve in &self.improve {
            let axis = improve.axis;
            let alone = self.tolerable.alone.iter().find(|alone| alone.axis == axis);
            let allowed = alone.map(|alone| match alone.factor {
                Factor { is_less: true, .. } => "not by this σ alone".to_owned(),
                Factor { is_more: true, .. } => format!("> {}", amount(design, axis, alone.sigma)),
                _ => amount(design, axis, alone.sigma),
            });
            is_beyond |= alone.is_some_and(|alone| alone.factor.is_more);
            let [lo, hi] = improve.gain_ci95;
            let may_be_none = lo <= 0.0 && hi >= 0.0;
            is_open |= may_be_none;
            table.push([
                axis.name().into(),
                amount(design, axis, improve.sigma).into(),
                in_percent(improve.halved).into(),
                Cell::Text(points(improve.gain) + if may_be_none { " ?" } else { "" }),
                allowed.into(),
            ]);
        }
        document.section("which standard deviation σ to improve, most helpful first").table(table);
        let mut legend = format!(
            "largest σ: the largest standard deviation of this error, the others as given, at which {required} of the errors dock."
        );
        if is_beyond {
            legend += " >: larger ones were not tried.";
        }
        if is_open {
            legend += " ?: the gain may be 0 (its 95 % CI includes 0).";
        }
        document.paragraph(legend);
        document.row("all σ together", self.tolerable.all.in_words(&required));
    }
}

impl Factor {
    fn in_words(&self, required: &str) -> String {
        let Self { factor, ci95: [lo, hi], .. } = *self;
        if self.is_less {
            return format!("{required} success is not reached however small every σ is");
        }
        if self.is_more {
            return format!(
                "{required} success even if every σ is {} times as large, the most that was tried",
                significant(factor)
            );
        }
        if lo <= 0.0 {
            return format!(
                "{required} success with every σ times {factor:.2} (95 % CI: at most {hi:.2}; its lower end needs more samples)"
            );
        }
        format!("{required} success with every σ times {factor:.2} (95 % CI {lo:.2} … {hi:.2})")
    }
}

impl NormalFit {
    /// The normal fit beside so many rows of measured errors.
    fn describe(&self, rows: Option<usize>, document: &mut Document) {
        let verdict = if self.rejected { "rejected" } else { "not rejected" };
        let p =
            if self.p_value < 0.001 { "p < 0.001".to_owned() } else { format!("p = {:.3}", self.p_value) };
        let success = match (self.probability, self.ci95) {
            (Some(probability), Some(ci95)) => format!(": success {}", between(probability, ci95)),
            _ => String::new(),
        };
        document.row("normal fit", format!("{verdict}, {p}{success}"));
        let least = self.axes.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value));
        if let (Some(least), Some(rows)) = (least, rows.filter(|rows| *rows < FEW && !self.rejected)) {
            let axis = least.axis;
            document.more(format!("least normal is {axis}; {rows} rows reject only errors far from normal"));
        }
    }
}

/// An error, in D or radians: `1.250 mm`, `0.0250 D` or `3.00°`.
fn amount(design: &Design, axis: Dof, value: f64) -> String {
    if axis.is_rotation() || design.unit.is_some() {
        return DesignUnits::of(design).amount(axis, value);
    }
    format!("{value:.4} D")
}

/// `98.76 %`; between that and certainty as many digits as distinguish them.
pub fn in_percent(probability: f64) -> String {
    match 1.0 - probability {
        rest if rest > 0.0 && rest < 5e-5 => format!("{:.4} %", 100.0 * probability),
        rest if rest > 0.0 && rest < 5e-4 => format!("{:.3} %", 100.0 * probability),
        _ => percent(probability),
    }
}

/// The same with its 95 % interval.
fn between(probability: f64, ci95: [f64; 2]) -> String {
    let [lo, hi] = ci95.map(in_percent);
    format!("{} (95 % CI {lo} … {hi})", in_percent(probability))
}

/// A difference of two probabilities, in percentage points: `+4.61`.
fn points(gain: f64) -> String {
    let shown = format!("{:+.2}", 100.0 * gain);
    if shown == "-0.00" { "+0.00".to_owned() } else { shown }
}

/// To two digits.
fn two_digits(count: f64) -> usize {
    if !(count.is_finite() && count > 0.0) {
        return 0;
    }
    let scale = 10f64.powf(count.log10().floor() - 1.0).max(1.0);
    ((count / scale).round() * scale) as usize
}
