//! Text and table form of holding forces.

use super::{COLUMNS, HoldingForces, LoadLimits};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, DesignUnits, Document, Subject, Table, significant};

/// Directions that people see.
const SHOWN: usize = 8;
/// Shares of the preload below this are nothing: rounding.
const NOTHING: f64 = 1e-6;

impl Subject for HoldingForces {
    const KIND: &'static str = "hold";
    const SAMPLES_ERRORS: bool = false;

    fn setup(&self, design: &Design, document: &mut Document) {
        self.describe_rest(DesignUnits::of(design), document);
    }

    fn document(&self, design: &Design) -> Document {
        let units = DesignUnits::of(design);
        let mut document = Document::default();
        document.table(self.records());
        let force = self.force_unit();
        if !self.sideways.is_empty() {
            document
                .titled(Some(format!("sideways force before the half moves, in {force}")))
                .table(self.forces());
        }
        if !self.torques.is_empty() {
            document
                .titled(Some(format!("torque before the half moves, in {force} {}", units.unit())))
                .table(self.moments(units));
        }
        let at = if self.settings.lever == 0.0 {
            "at".to_owned()
        } else {
            format!("{} above", units.length(self.settings.lever))
        };
        let (torques, axis) = if self.torques.is_empty() {
            ("", "")
        } else {
            (", torques about the COR", " or about this axis")
        };
        let free = design.alignment.free;
        document.section(None).paragraph(format!(
            "Forces act {at} the face centre of the moving half{torques}. guided: the half can move only along this force{axis}, and up. free: it can move in \
             {free} at once, and up. Limits by statics: no contact forces balance a larger load."
        ));
        if self.slides() {
            let gap = units.fine(self.settings.play);
            document.paragraph(format!(
                "0: no contact resists: the half slides under any force until a wall stops it at the end of its play, or away if there is none. Gaps up to \
                 {gap} count as closed."
            ));
        }
        document
    }
}

impl HoldingForces {
    fn describe_rest(&self, units: DesignUnits<'_>, document: &mut Document) {
        let preload = self.preload_n.map_or_else(|| "F".to_owned(), |n| format!("{} N", significant(n)));
        document.row(
            "preload",
            format!("{preload}, the force that presses the halves together, along -z through the COR"),
        );
        let place =
            if self.settings.pose.is_none() { "the mated pose".to_owned() } else { units.pose(&self.pose) };
        let docked = if self.outcome == Outcome::Aligned { "" } else { ", not docked" };
        let points = match self.contacts.len() {
            1 => "1 contact point".to_owned(),
            count => format!("{count} contact points"),
        };
        document.row("rests at", format!("{place}{docked}; {points}"));
        if self.settings.friction > 0.0 {
            let friction = self.settings.friction;
            document.row("friction", format!("μ = {friction} between the halves (Coulomb)"));
            let mut loads = self.loads();
            if loads.all(|withstood| withstood.smooth.is_none()) {
                document.more("without friction the preload alone moves the half");
            }
        }
    }

    /// The holding loads in all directions.
    fn loads(&self) -> impl Iterator<Item = LoadLimits> {
        let forces = self.sideways.iter().map(|side| side.withstood);
        forces.chain(self.torques.iter().map(|torque| torque.withstood))
    }

    /// Every load, as a share of the preload, or of it times D; infinite if any load is resisted.
    fn records(&self) -> Table {
        let mut table =
            Table::data("load direction_rad sign smooth_guided smooth_free rough_guided rough_free");
        let mut push = |head: [Cell; 3], withstood: &LoadLimits| {
            table.push(head.into_iter().chain(withstood.columns().map(Cell::from)));
        };
        for side in &self.sideways {
            push(["sideways".into(), side.direction_rad.into(), Cell::Empty], &side.withstood);
        }
        for torque in &self.torques {
            push([torque.axis.name().into(), Cell::Empty, torque.sign.into()], &torque.withstood);
        }
        table
    }

    fn forces(&self) -> Table {
        let mut table = self.table("angle from +x");
        let step = self.sideways.len().div_ceil(SHOWN).max(1);
        let scale = self.preload_n.unwrap_or(1.0);
        for side in self.sideways.iter().step_by(step) {
            self.push(&mut table, degrees(side.direction_rad), side.withstood.columns(), scale);
        }
        let weakest = self.weakest.columns();
        let values: [Option<f64>; COLUMNS] = std::array::from_fn(|k| {
            let is_known = self.sideways.iter().any(|side| side.withstood.columns()[k].is_some());
            let force = weakest[k].map_or(Some(f64::INFINITY), |side| side.withstood.columns()[k]);
            force.filter(|_| is_known)
        });
        self.push(&mut table, "weakest".to_owned(), values, scale);
        if weakest.iter().any(Option::is_some) {
            let at = weakest.map(|side| side.map(|side| format!("at {}", degrees(side.direction_rad))));
            table.push(std::iter::once(Cell::Empty).chain(self.of_columns(at).map(Cell::from)));
        }
        table
    }

    fn moments(&self, units: DesignUnits<'_>) -> Table {
        let mut table = self.table("about");
        let scale = self.preload_n.unwrap_or(1.0) * units.scale();
        for torque in &self.torques {
            let sign = if torque.sign > 0.0 { '+' } else { '-' };
            let name = format!("{sign}{}", torque.axis.name());
            self.push(&mut table, name, torque.withstood.columns(), scale);
        }
        table
    }

    /// A table of loads: the columns without friction, and those with friction if there is any.
    fn table(&self, name: &str) -> Table {
        let friction = self.settings.friction;
        let columns = if friction > 0.0 {
            let rough = [format!("guided, μ = {friction}"), format!("free, μ = {friction}")];
            ["guided, μ = 0", "free, μ = 0"].map(str::to_owned).into_iter().chain(rough).collect()
        } else {
            vec!["guided".to_owned(), "free".to_owned()]
        };
        Table::new(std::iter::once(Column::new(name).left()).chain(columns.into_iter().map(Column::new)))
    }

    fn push(&self, table: &mut Table, name: String, values: [Option<f64>; COLUMNS], scale: f64) {
        let shown = |value: f64| match value {
            f64::INFINITY => "any".to_owned(),
            value if value < NOTHING => "0".to_owned(),
            value => significant(value * scale),
        };
        let cells = self.of_columns(values).map(|value| value.map(shown).into());
        table.push(std::iter::once(name.into()).chain(cells));
    }

    /// Those of the columns that the table has.
    fn of_columns<T>(&self, all: [T; COLUMNS]) -> impl Iterator<Item = T> {
        let count = if self.settings.friction > 0.0 { COLUMNS } else { COLUMNS / 2 };
        all.into_iter().take(count)
    }

    /// Whether an arbitrarily small force moves it sideways without friction.
    fn slides(&self) -> bool {
        let least = self.weakest.smooth_free.and_then(|side| side.withstood.column(1));
        least.is_some_and(|force| force <= NOTHING)
    }

    /// The unit of forces: N, or the preload F.
    pub const fn force_unit(&self) -> &'static str {
        if self.preload_n.is_some() { "N" } else { "F" }
    }
}

/// A direction in degrees, to a tenth if needed.
fn degrees(direction: f64) -> String {
    let degrees = direction.to_degrees();
    let degrees = if degrees > 359.95 { 0.0 } else { degrees };
    let whole = degrees.round();
    if (degrees - whole).abs() < 0.05 { format!("{}°", whole + 0.0) } else { format!("{degrees:.1}°") }
}
