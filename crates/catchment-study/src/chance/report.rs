//! Text and table form of drop tests.

use super::results::place;
use super::{Chance, ChanceMap, Overall, PoseChance};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{
    Cell, Column, DesignUnits, Document, Subject, Table, grouped, percent, significant,
};
use catchment_core::method::drop::Push;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Circumstance, ScalarDistribution};

/// Poses that people see.
const MOST_POSES: usize = 40;
/// A shorter coasting distance, in D, gives a warning: speed then has no visible effect.
const FAINT_COAST: f64 = 0.003;
/// A larger share of a law that is drawn again is a warning.
const MUCH_CUT: f64 = 0.01;

impl Subject for Chance {
    const KIND: &'static str = "chance";

    fn warnings(&self) -> Vec<Diagnostic> {
        let mut notes = Vec::new();
        for declared in self.declared.iter().filter(|declared| declared.cut > MUCH_CUT) {
            notes.push(format!(
                "{} of the law of {} is out of its range and drawn again: what is tried is the rest of the law",
                percent(declared.cut),
                declared.circumstance.name()
            ));
        }
        if self.settings.held
            && let Some(coasting) = self.coasting_d.filter(|coasting| *coasting < FAINT_COAST)
        {
            notes.push(format!(
                "damping takes the speed within {coasting:.1e} D: as good as quasi-static; with less damping speed would show"
            ));
        }
        let drop = &self.settings.drop;
        if self.settings.held && (drop.angular_damping != drop.damping || drop.inertia_factor != 1.0) {
            notes.push(
                "turning and moving are damped differently: exact motions, which damp both alike by rho, are not the limit of zero speed"
                    .to_owned(),
            );
        }
        if !self.settings.held && !self.curve.is_empty() {
            notes.push(
                "what pushes the half stays as it is where speeds are multiplied: the slowest is let go nearly at rest, which is no \
                 quasi-static motion"
                    .to_owned(),
            );
        }
        if !self.settings.dynamics.varies() {
            notes.push(format!(
                "nothing is declared to vary: trials of a pose differ by their starts alone, {} D or less",
                drop.perturbation
            ));
        }
        let undecided = place(Outcome::Undecided);
        let cells = self.map.iter().flat_map(|map| &map.cells);
        let open: usize = self.poses.iter().chain(cells).map(|pose| pose.outcomes[undecided]).sum();
        let share = self.overall.as_ref().map_or(0.0, |overall| overall.outcomes[undecided]);
        if open > 0 {
            notes.push(format!("{open} trials still moved when their time was up: they count as failures"));
        }
        if share > 0.0 {
            notes.push(format!(
                "{} of the expected errors still moved when their time was up: they count as failures",
                percent(share)
            ));
        }
        notes.into_iter().map(|text| Diagnostic::warning(Self::KIND, text)).collect()
    }

    fn setup(&self, design: &Design, document: &mut Document) {
        document.row("method", format!("drop, {} trials in a rigid-body engine", grouped(self.trials)));
        self.describe_circumstances(design, document);
    }

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        document.table(self.records());
        if let Some(overall) = &self.overall {
            overall.describe(&mut document);
        }
        if !self.curve.is_empty() {
            document.section("probability of docking with all speeds multiplied").table(self.speeds(design));
        }
        if let Some(first) = self.poses.first() {
            let title = format!(
                "docking by pose, {} trials each; exact motion is quasi-static",
                grouped(first.trials)
            );
            document.titled(Some(title)).table(self.places(design));
            if self.poses.len() > MOST_POSES {
                document.paragraph(format!("and {} more poses", grouped(self.poses.len() - MOST_POSES)));
            }
        }
        if let Some(map) = &self.map {
            map.describe(&mut document);
        }
        if let Some(preset) = &self.preset {
            document.titled(Some(format!("{} leaves open", preset.name)));
            for unknown in &preset.unknown {
                document.paragraph(*unknown);
            }
        }
        document
    }
}

impl Chance {
    /// A row for each probability, in D, radians and D/s.
    fn records(&self) -> Table {
        let mut table =
            Table::data("what factor speed x y roll pitch yaw trials probability low high quasi_static");
        let nowhere = || [const { Cell::Empty }; Dof::ALL.len()];
        let mut push = |head: [Cell; 3], at: [Cell; Dof::ALL.len()], trials: usize, of: [Cell; 4]| {
            table.push(head.into_iter().chain(at).chain([trials.into()]).chain(of));
        };
        if let Some(Overall { probability, ci95: [lo, hi], trials, quasi_static, .. }) = &self.overall {
            let of = [probability, lo, hi, quasi_static].map(|value| Cell::from(*value));
            push(["overall".into(), Cell::Empty, Cell::Empty], nowhere(), *trials, of);
        }
        for at in &self.curve {
            let [lo, hi] = at.ci95.map(Cell::from);
            let head = ["speed".into(), at.factor.into(), at.speed.into()];
            push(head, nowhere(), at.trials, [at.probability.into(), lo, hi, Cell::Empty]);
        }
        let cells = self.map.iter().flat_map(|map| &map.cells).map(|cell| ("cell", cell));
        for (what, pose) in self.poses.iter().map(|pose| ("pose", pose)).chain(cells) {
            let of = [pose.probability, pose.ci95[0], pose.ci95[1], pose.quasi_static].map(Cell::from);
            let at = pose.error.to_array().map(Cell::from);
            push([what.into(), Cell::Empty, Cell::Empty], at, pose.trials, of);
        }
        table
    }

    fn describe_circumstances(&self, design: &Design, document: &mut Document) {
        let drop = &self.settings.drop;
        for declared in &self.declared {
            let law = law_in_words(design, declared.circumstance, &declared.law);
            document.row(declared.circumstance.name(), law);
        }
        let [moving, turning] =
            [drop.damping, drop.angular_damping].map(|rate| format!("{} 1/s", without_zeros(rate)));
        document.row("damping", format!("{moving} (linear), {turning} (angular)"));
        let push = match drop.push {
            _ if self.settings.held => {
                let units = DesignUnits::of(design);
                let coasts = self.coasting_d.map_or_else(String::new, |coasting| {
                    let length = without_zeros(coasting * units.scale());
                    format!("; not driven, it would coast {length} {}", units.unit())
                });
                format!("by the force that damping balances at the approach speed{coasts}")
            }
            Push::Force(force) => format!("by a force of {} kg·D/s²", without_zeros(force)),
            Push::Gravity(gravity) => format!("by gravity of {} D/s²", without_zeros(gravity)),
        };
        document.row("driven", push);
    }

    fn speeds(&self, design: &Design) -> Table {
        let (factor, unit) = unit_of(design, Circumstance::Speed);
        let mut table = Table::new([
            Column::new("all speeds").left(),
            Column::new(format!("mean [{unit}]")),
            Column::new("docks (95 % CI)"),
        ]);
        if let Some(overall) = self.overall.as_ref().filter(|_| self.settings.held) {
            let still = between(overall.quasi_static, overall.quasi_static_ci95);
            table.push(["times → 0, exact motions".into(), "0".into(), still.into()]);
        }
        for at in &self.curve {
            table.push([
                format!("times {}", without_zeros(at.factor)).into(),
                without_zeros(at.speed * factor).into(),
                between(at.probability, at.ci95).into(),
            ]);
        }
        table
    }

    fn places(&self, design: &Design) -> Table {
        let mut table = Table::new([
            Column::new("docks (95 % CI)"),
            Column::new("by exact motion"),
            Column::new("pose error").left(),
        ]);
        for pose in self.poses.iter().take(MOST_POSES) {
            table.push([
                between(pose.probability, pose.ci95).into(),
                in_percent(pose.quasi_static).into(),
                pose_in_words(design, &pose.error).into(),
            ]);
        }
        table
    }
}

impl Overall {
    fn describe(&self, document: &mut Document) {
        let [lo, hi] = self.ci95.map(in_percent);
        let docks = in_percent(self.probability);
        document
            .section(None)
            .row("docks", format!("{docks} of {} errors (95 % CI {lo} … {hi})", self.errors));
        let plain =
            if self.plain_trials.is_finite() { self.plain_trials.round() as usize } else { usize::MAX };
        let sure = if self.grid_cells > 0 && plain < usize::MAX {
            format!(" (stratified sampling: as precise as {} independent ones)", grouped(plain))
        } else {
            String::new()
        };
        document.more(format!("{} trials{sure}", grouped(self.trials)));
        let outcomes = Outcome::ALL.iter().zip(self.outcomes).filter(|(_, share)| *share > 0.0);
        let outcomes: Vec<String> =
            outcomes.map(|(outcome, share)| format!("{} {}", outcome.word(), in_percent(share))).collect();
        document.row("outcomes", outcomes.join(", "));
        let [lo, hi] = self.quasi_static_ci95.map(in_percent);
        let still = in_percent(self.quasi_static);
        document.row("quasi-static", format!("{still} (95 % CI {lo} … {hi})"));
    }
}

impl ChanceMap {
    fn describe(&self, document: &mut Document) {
        let over: Vec<&str> = self.axes.iter().map(|axis| axis.dof.name()).collect();
        let sizes: Vec<String> = self.axes.iter().map(|axis| axis.cells.to_string()).collect();
        let (sizes, over) = (sizes.join(" × "), over.join(" and "));
        let trials = grouped(self.cells.first().map_or(0, |cell| cell.trials));
        let count = self.cells.len().max(1) as f64;
        let mean = |of: fn(&PoseChance) -> f64| in_percent(self.cells.iter().map(of).sum::<f64>() / count);
        let (docks, still) = (mean(|cell| cell.probability), mean(|cell| cell.quasi_static));
        let mixed = self.cells.iter().filter(|cell| cell.minority > 0.0).count();
        let differs = |cell: &&PoseChance| (cell.probability > 0.5) != (cell.quasi_static > 0.5);
        let other = self.cells.iter().filter(differs).count();
        document
            .section(None)
            .row("map", format!("{sizes} cells over {over}, {trials} trials each"))
            .more(format!("{docks} of the trials dock, by exact motions {still}"))
            .more(format!(
                "{mixed} cells both dock and fail; in {other} most trials have another outcome than exact motion"
            ));
    }
}

/// `50 ± 10 mm/s, normal`, `0.1 … 0.3, uniform`.
fn law_in_words(design: &Design, of: Circumstance, law: &ScalarDistribution) -> String {
    let (factor, unit) = unit_of(design, of);
    let shown = |value: f64| without_zeros(value * factor);
    let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
    match law {
        ScalarDistribution::Constant { value } => format!("{}{unit}", shown(*value)),
        ScalarDistribution::Normal { mean, sigma } => {
            format!("{} ± {}{unit}, normal", shown(*mean), shown(*sigma))
        }
        ScalarDistribution::Uniform { from, to } => {
            format!("{} … {}{unit}, uniform", shown(*from), shown(*to))
        }
        ScalarDistribution::Lognormal { median, factor } => {
            format!("{}{unit} times or by {}, lognormal", shown(*median), without_zeros(*factor))
        }
        ScalarDistribution::Measured { measured } => {
            format!("{}{unit} on average, {} measured values", shown(law.mean()), measured.len())
        }
    }
}

/// The factor by which a number of a circumstance is multiplied to be shown, and its unit then.
pub fn unit_of(design: &Design, of: Circumstance) -> (f64, String) {
    let units = DesignUnits::of(design);
    match of.unit() {
        "D/s" => (units.scale(), format!("{}/s", units.unit())),
        "D" => (units.scale(), units.unit().to_owned()),
        "rad/s" => (1f64.to_degrees(), "deg/s".to_owned()),
        other => (1.0, other.to_owned()),
    }
}

/// The free errors that are not 0.
fn pose_in_words(design: &Design, error: &PoseError) -> String {
    let (units, error) = (DesignUnits::of(design), error.to_array());
    let free = design.alignment.free.iter().map(|axis| (axis, error[axis.index()]));
    let parts: Vec<String> = free
        .filter(|(_, value)| *value != 0.0)
        .map(|(axis, value)| format!("{} {}", axis.name(), units.amount(axis, value)))
        .collect();
    if parts.is_empty() { "none".to_owned() } else { parts.join(", ") }
}

/// Four digits, without zeros at the end.
fn without_zeros(value: f64) -> String {
    let text = significant(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// `93.4 %`; nearly all and nearly nothing have more digits.
fn in_percent(share: f64) -> String {
    let value = 100.0 * share;
    let rounded = format!("{value:.1}");
    let digits = match rounded.as_str() {
        "100.0" if value < 100.0 => format!("{value:.3}"),
        "0.0" if value > 0.0 => format!("{value:.3}"),
        _ => rounded,
    };
    format!("{digits} %")
}

/// The same with its 95 % interval.
fn between(share: f64, ci95: [f64; 2]) -> String {
    let [lo, hi] = ci95.map(in_percent);
    format!("{} ({lo} … {hi})", in_percent(share))
}
