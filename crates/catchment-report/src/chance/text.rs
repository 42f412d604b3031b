//! How likely drop tests dock, for people: 80 columns, the design's unit and degrees.

use super::super::table::heading;
use super::super::text::{self, grouped, line, row, significant, wrapped};
use super::{ChanceReport, MapReport, OverallReport, PoseChanceReport};
use catchment_core::acceptance::Outcome;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Circumstance, Law};

/// Poses that are told.
const MOST_POSES: usize = 40;

impl ChanceReport {
    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "method", &format!("drop, {} trials in a rigid-body engine", grouped(self.trials)));
        self.circumstances(&mut text);
        if let Some(overall) = &self.overall {
            text.push('\n');
            overall_of(&mut text, overall);
        }
        if !self.curve.is_empty() {
            text.push('\n');
            self.curve(&mut text);
        }
        if !self.poses.is_empty() {
            text.push('\n');
            self.poses(&mut text);
        }
        if let Some(map) = &self.map {
            text.push('\n');
            map_of(&mut text, map);
        }
        self.append_warnings(&mut text);
        if let Some(preset) = &self.preset {
            text.push('\n');
            line(&mut text, &format!("  {} leaves open", preset.name));
            for unknown in &preset.unknown {
                wrapped(&mut text, "    ", unknown);
            }
        }
        text
    }

    fn circumstances(&self, text: &mut String) {
        let drop = &self.settings.drop;
        for declared in &self.declared {
            row(text, declared.circumstance.name(), &self.law(declared.circumstance, &declared.law));
        }
        let rate = |rate: f64| format!("{} 1/s", tidy(rate));
        row(text, "damping", &format!("{}, of turning {}", rate(drop.damping), rate(drop.angular_damping)));
        if self.settings.held {
            let coasts = self.coasting_d.map_or_else(String::new, |coasting| {
                let length = self.length(coasting);
                format!("; at the mean speed it coasts {length} before damping has taken it")
            });
            wrapped(
                text,
                &format!("  {:<15}", "pushed"),
                &format!("as damping balances at its speed{coasts}"),
            );
        } else {
            let push = match drop.push {
                catchment_core::method::drop::Push::Force(force) => {
                    format!("by a force of {} kg·D/s²", tidy(force))
                }
                catchment_core::method::drop::Push::Gravity(gravity) => {
                    format!("by gravity of {} D/s²", tidy(gravity))
                }
            };
            row(text, "pushed", &push);
        }
    }

    /// `50.00 ± 10.00 mm/s`, `0.1 … 0.3`.
    fn law(&self, of: Circumstance, law: &Law) -> String {
        let (factor, unit) = self.unit(of);
        let shown = |value: f64| tidy(value * factor);
        let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
        match law {
            Law::Constant { value } => format!("{}{unit}", shown(*value)),
            Law::Normal { mean, sigma } => format!("{} ± {}{unit}, normal", shown(*mean), shown(*sigma)),
            Law::Uniform { from, to } => format!("{} … {}{unit}, uniform", shown(*from), shown(*to)),
            Law::Lognormal { median, factor } => {
                format!("{}{unit} times or by {}, lognormal", shown(*median), tidy(*factor))
            }
            Law::Measured { measured } => {
                format!("{}{unit} on average, {} measured values", shown(law.mean()), measured.len())
            }
        }
    }

    /// What a number of a circumstance is multiplied by to be shown, and its unit.
    pub(crate) fn unit(&self, of: Circumstance) -> (f64, String) {
        let (width, symbol) = self.design.unit.map_or((1.0, "D"), |unit| (self.design.width, unit.symbol()));
        match of.unit() {
            "D/s" => (width, format!("{symbol}/s")),
            "D" => (width, symbol.to_owned()),
            "rad/s" => (1f64.to_degrees(), "deg/s".to_owned()),
            other => (1.0, other.to_owned()),
        }
    }

    fn length(&self, value: f64) -> String {
        let (width, symbol) = self.design.unit.map_or((1.0, "D"), |unit| (self.design.width, unit.symbol()));
        format!("{} {symbol}", tidy(value * width))
    }

    fn curve(&self, text: &mut String) {
        let (factor, unit) = self.unit(Circumstance::Speed);
        line(
            text,
            &format!("  {:<15}{:>14}{:>10}   95 % interval", "all speeds", format!("mean [{unit}]"), "docks"),
        );
        if let Some(overall) = self.overall.as_ref().filter(|_| self.settings.held) {
            let [lo, hi] = overall.quasi_static_ci95.map(share);
            let still = share(overall.quasi_static);
            line(text, &format!("  {:<15}{:>14}{still:>10}   {lo} … {hi}   exact motions", "times → 0", "0"));
        }
        for at in &self.curve {
            let [lo, hi] = at.ci95.map(share);
            let times = format!("times {}", tidy(at.factor));
            let speed = tidy(at.speed * factor);
            line(text, &format!("  {times:<15}{speed:>14}{:>10}   {lo} … {hi}", share(at.probability)));
        }
    }

    fn poses(&self, text: &mut String) {
        line(text, "  docks     95 % interval        exact   pose");
        for pose in self.poses.iter().take(MOST_POSES) {
            let [lo, hi] = pose.ci95.map(share);
            line(
                text,
                &format!(
                    "  {:<9} {:<20} {:<7} {}",
                    share(pose.probability),
                    format!("{lo} … {hi}"),
                    share(pose.quasi_static),
                    self.place(&pose.error)
                ),
            );
        }
        if self.poses.len() > MOST_POSES {
            line(text, &format!("  and {} more", grouped(self.poses.len() - MOST_POSES)));
        }
        let trials = self.poses.first().map_or(0, |pose| pose.trials);
        line(text, &format!("  by {} trials each; exact: quasi-static motions", grouped(trials)));
    }

    fn place(&self, error: &PoseError) -> String {
        let (width, symbol) = self.design.unit.map_or((1.0, "D"), |unit| (self.design.width, unit.symbol()));
        let said: Vec<String> = (self.design.alignment.free.iter())
            .filter(|axis| error.to_array()[axis.index()] != 0.0)
            .map(|axis: Dof| {
                let value = error.to_array()[axis.index()];
                if axis.is_rotation() {
                    format!("{} {:.2}°", axis.name(), value.to_degrees() + 0.0)
                } else {
                    format!("{} {} {symbol}", axis.name(), text::length(value * width, width))
                }
            })
            .collect();
        if said.is_empty() { "none".to_owned() } else { said.join(", ") }
    }
}

fn map_of(text: &mut String, map: &MapReport) {
    let cells = map.cells.len().max(1) as f64;
    let over: Vec<&str> = map.axes.iter().map(|axis| axis.dof.name()).collect();
    let sizes: Vec<String> = map.axes.iter().map(|axis| axis.cells.to_string()).collect();
    let trials = map.cells.first().map_or(0, |cell| cell.trials);
    let what =
        format!("{} cells over {}, {} trials each", sizes.join(" × "), over.join(" and "), grouped(trials));
    row(text, "map", &what);
    let mean = map.cells.iter().map(|cell| cell.probability).sum::<f64>() / cells;
    let still = map.cells.iter().map(|cell| cell.quasi_static).sum::<f64>() / cells;
    row(text, "", &format!("{} of the trials dock, by exact motions {}", share(mean), share(still)));
    let mixed = map.cells.iter().filter(|cell| cell.minority > 0.0).count();
    let against = |cell: &&PoseChanceReport| (cell.probability > 0.5) != (cell.quasi_static > 0.5);
    let otherwise = map.cells.iter().filter(against).count();
    let words = format!(
        "{mixed} cells both dock and fail; in {otherwise} most trials fare otherwise than exact motion"
    );
    wrapped(text, &format!("  {:<15}", ""), &words);
}

fn overall_of(text: &mut String, overall: &OverallReport) {
    let [lo, hi] = overall.ci95.map(share);
    let errors = format!("{} errors", overall.errors);
    row(text, "docks", &format!("{}   (95 %: {lo} … {hi})   of {errors}", share(overall.probability)));
    let plain =
        if overall.plain_trials.is_finite() { overall.plain_trials.round() as usize } else { usize::MAX };
    let sure = if overall.grid_cells > 0 && plain < usize::MAX {
        format!("; as sure as {} plain ones", grouped(plain))
    } else {
        String::new()
    };
    row(text, "", &format!("{} trials{sure}", grouped(overall.trials)));
    let met: Vec<String> = Outcome::ALL
        .iter()
        .zip(overall.outcomes)
        .filter(|(_, of)| *of > 0.0)
        .map(|(outcome, of)| format!("{} {}", outcome.name(), share(of)))
        .collect();
    row(text, "outcomes", &met.join("  "));
    let [lo, hi] = overall.quasi_static_ci95.map(share);
    row(text, "quasi-static", &format!("{}   (95 %: {lo} … {hi})", share(overall.quasi_static)));
}

/// Four digits, without zeros at the end.
fn tidy(value: f64) -> String {
    let text = significant(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// `93.4 %`; what is nearly all or nearly nothing is not rounded to it.
fn share(value: f64) -> String {
    let value = 100.0 * value;
    let rounded = format!("{value:.1}");
    let digits = match rounded.as_str() {
        "100.0" if value < 100.0 => format!("{value:.3}"),
        "0.0" if value > 0.0 => format!("{value:.3}"),
        _ => rounded,
    };
    format!("{digits} %")
}
