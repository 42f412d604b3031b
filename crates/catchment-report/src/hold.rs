//! What a half withstands: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{self, line, number, row, significant, wrapped};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::pose::{Dof, PoseError};
use catchment_study::hold::{ANY, Both, Hold, Settings, Sideways, Torque, Withstood};
use serde::Serialize;

/// What a half withstands, with its head.
pub type HoldReport = Envelope<HoldBody>;

/// What a half withstands: forces as shares of the preload, torques of the preload times D.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HoldBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// The preload, in N; null where none was given.
    pub preload_n: Option<f64>,
    /// The pose error in which it rests.
    pub pose: PoseError,
    /// Whether that counts as docked.
    pub outcome: Outcome,
    /// z of the centre of rotation there, in D.
    pub height_d: f64,
    /// Points in which it touches.
    pub contacts: Vec<PointReport>,
    /// Forces sideways, by their directions.
    pub sideways: Vec<SidewaysReport>,
    /// The weakest direction of every column.
    pub weakest: WeakestReport,
    /// Torques about the axes of free rotations.
    pub torques: Vec<TorqueReport>,
    /// The least of all forces sideways in free errors, with friction where it was asked for; 10⁶ where any is withstood,
    /// null where none can act: x and y are locked.
    pub least_force: Option<f64>,
    /// The same of torques; null where rotations are locked.
    pub least_torque: Option<f64>,
}

/// A point in which halves touch, in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PointReport {
    /// Where, in D.
    pub point_d: [f64; 3],
    /// Unit normal, from the fixed half to the moving one.
    pub normal: [f64; 3],
}

/// How much of a load is withstood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WithstoodReport {
    /// Where the half can move that way alone, and up; null: any.
    pub guided: Option<f64>,
    /// Where it can move in all free errors, and up; null: any.
    pub free: Option<f64>,
}

/// A force sideways.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SidewaysReport {
    /// From x towards y, in radians.
    pub direction_rad: f64,
    /// Without friction; null where friction alone holds the preload.
    pub smooth: Option<WithstoodReport>,
    /// With friction; null where none was asked for.
    pub rough: Option<WithstoodReport>,
}

/// A torque.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TorqueReport {
    /// The error whose axis it turns about.
    pub axis: Dof,
    /// 1 or −1.
    pub sign: f64,
    /// Without friction; null where friction alone holds the preload.
    pub smooth: Option<WithstoodReport>,
    /// With friction; null where none was asked for.
    pub rough: Option<WithstoodReport>,
}

/// The weakest directions; null where any force is withstood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WeakestReport {
    /// Without friction, guided.
    pub smooth_guided: Option<SidewaysReport>,
    /// Without friction, free.
    pub smooth_free: Option<SidewaysReport>,
    /// With friction, guided.
    pub rough_guided: Option<SidewaysReport>,
    /// With friction, free.
    pub rough_free: Option<SidewaysReport>,
}

impl Body for HoldBody {
    const KIND: &'static str = "hold";
}

impl From<Withstood> for WithstoodReport {
    fn from(Withstood { guided, free }: Withstood) -> Self {
        Self { guided, free }
    }
}

fn both(of: &Both) -> [Option<WithstoodReport>; 2] {
    [of.smooth, of.rough].map(|of| of.map(WithstoodReport::from))
}

impl From<&Sideways> for SidewaysReport {
    fn from(side: &Sideways) -> Self {
        let [smooth, rough] = both(&side.withstood);
        Self { direction_rad: side.direction, smooth, rough }
    }
}

impl From<&Torque> for TorqueReport {
    fn from(torque: &Torque) -> Self {
        let [smooth, rough] = both(&torque.withstood);
        Self { axis: torque.axis, sign: torque.sign, smooth, rough }
    }
}

/// A number of each column: without friction guided and free, with it guided and free; infinite for any, `None` where it was not asked.
type Columns = [Option<f64>; 4];

fn columns(smooth: Option<WithstoodReport>, rough: Option<WithstoodReport>) -> Columns {
    let any = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
    [
        smooth.map(|of| any(of.guided)),
        smooth.map(|of| any(of.free)),
        rough.map(|of| any(of.guided)),
        rough.map(|of| any(of.free)),
    ]
}

/// The column that decides: free, with friction where it was asked for.
fn decides(columns: &Columns) -> Option<f64> {
    columns[3].or(columns[1]).map(|value| value.min(ANY))
}

fn least(all: impl Iterator<Item = Columns>) -> Option<f64> {
    all.filter_map(|columns| decides(&columns)).min_by(f64::total_cmp)
}

impl HoldReport {
    /// Of a design, with a preload in N if that is known.
    pub fn new(
        design: &Design,
        found: &Hold,
        preload_n: Option<f64>,
        doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let [smooth_guided, smooth_free, rough_guided, rough_free] =
            found.weakest.map(|side| side.as_ref().map(SidewaysReport::from));
        let sideways: Vec<SidewaysReport> = found.sideways.iter().map(SidewaysReport::from).collect();
        let torques: Vec<TorqueReport> = found.torques.iter().map(TorqueReport::from).collect();
        let weakest = WeakestReport { smooth_guided, smooth_free, rough_guided, rough_free };
        let refined = [rough_free, smooth_free].into_iter().flatten();
        let forces = sideways.iter().copied().chain(refined);
        let least_force = least(forces.map(|side| columns(side.smooth, side.rough)));
        let least_torque = least(torques.iter().map(|torque| columns(torque.smooth, torque.rough)));
        let contacts = found
            .contacts
            .iter()
            .map(|[point, normal]| PointReport { point_d: point.to_array(), normal: normal.to_array() });
        let body = HoldBody {
            design: design.clone(),
            settings: found.settings.clone(),
            preload_n,
            pose: found.pose,
            outcome: found.outcome,
            height_d: found.height,
            contacts: contacts.collect(),
            sideways,
            weakest,
            torques,
            least_force,
            least_torque,
        };
        Self::of(body, doubts, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        let preload = self.preload_n.map_or_else(|| "F".to_owned(), |n| format!("{} N", significant(n)));
        row(&mut text, "preload", &format!("{preload} along -z, through the centre of rotation"));
        let rest =
            if self.settings.pose.is_none() { "the mated pose".to_owned() } else { self.place(&self.pose) };
        let docked = if self.outcome == Outcome::Aligned { "" } else { ", not docked" };
        row(&mut text, "rests", &format!("{rest}{docked}, touching in {} points", self.contacts.len()));
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
            if self.sideways.iter().all(|side| side.smooth.is_none())
                && self.torques.iter().all(|torque| torque.smooth.is_none())
            {
                row(&mut text, "", "without it the preload alone moves the half");
            }
        }
        if !self.sideways.is_empty() {
            text.push('\n');
            self.head(&mut text, "sideways at", &format!("withstood, {}", self.force_unit()));
            let step = self.sideways.len().div_ceil(SHOWN);
            let is_shown = |k: usize| self.sideways.len() <= SHOWN || k.is_multiple_of(step);
            for (_, side) in self.sideways.iter().enumerate().filter(|(k, _)| is_shown(*k)) {
                let name = degrees(side.direction_rad);
                numbers(&mut text, &name, &columns(side.smooth, side.rough), self.force_scale());
            }
            self.weakest_lines(&mut text);
        }
        if !self.torques.is_empty() {
            text.push('\n');
            self.head(&mut text, "torque", &format!("withstood, {}", self.torque_unit()));
            for torque in &self.torques {
                let sign = if torque.sign > 0.0 { '+' } else { '-' };
                let name = format!("{sign}{}", torque.axis.name());
                numbers(&mut text, &name, &columns(torque.smooth, torque.rough), self.torque_scale());
            }
        }
        text.push('\n');
        let lever = if self.settings.lever == 0.0 {
            String::new()
        } else {
            format!("{} above ", self.length(self.settings.lever))
        };
        wrapped(
            &mut text,
            "  ",
            &format!(
                "sideways forces act {}the face centre of the moving half, torques about the centre of rotation; guided: it moves as it is pushed and up, \
                 nothing else; free: in all free errors",
                if lever.is_empty() { "at ".to_owned() } else { lever }
            ),
        );
        if self.slides() {
            let said =
                "0: sideways it slides as it stands, on level ground or until the play of its fit is used";
            wrapped(&mut text, "  ", said);
        }
        self.append_warnings(&mut text);
        text
    }

    /// Whether some force as small as one likes moves it sideways where there is no friction.
    fn slides(&self) -> bool {
        let least = self.weakest.smooth_free.and_then(|side| side.smooth).and_then(|force| force.free);
        least.is_some_and(|force| force <= NOTHING)
    }

    fn head(&self, text: &mut String, name: &str, what: &str) {
        let rough = self.settings.friction > 0.0;
        let friction = format!("friction {}", self.settings.friction);
        line(text, &format!("  {name:<15}{what}"));
        if rough {
            line(text, &format!("  {:<15}{:>28}{friction:>28}", "", "no friction"));
        }
        let guided = format!("{:>14}{:>14}", "guided", "free");
        line(text, &format!("  {:<15}{guided}{}", "", if rough { guided.as_str() } else { "" }));
    }

    fn weakest_lines(&self, text: &mut String) {
        let WeakestReport { smooth_guided, smooth_free, rough_guided, rough_free } = self.weakest;
        let found = [smooth_guided, smooth_free, rough_guided, rough_free];
        let mut values: Columns = [None; 4];
        let mut at: Vec<String> = Vec::new();
        for (k, side) in found.iter().enumerate() {
            let asked = k < 2 || self.settings.friction > 0.0;
            values[k] = match side {
                Some(side) => columns(side.smooth, side.rough)[k],
                None => asked.then_some(f64::INFINITY),
            };
            let told =
                side.as_ref().map_or_else(String::new, |side| format!("at {}", degrees(side.direction_rad)));
            at.push(format!("{told:>14}"));
        }
        numbers(text, "weakest", &values, self.force_scale());
        if found.iter().any(Option::is_some) {
            line(text, &format!("  {:<15}{}", "", at.concat()));
        }
    }

    /// What sideways forces are told in.
    fn force_unit(&self) -> &'static str {
        if self.preload_n.is_some() { "N" } else { "F" }
    }

    fn force_scale(&self) -> f64 {
        self.preload_n.unwrap_or(1.0)
    }

    fn torque_unit(&self) -> String {
        format!("{} {}", self.force_unit(), self.design.unit.map_or("D", |unit| unit.symbol()))
    }

    fn torque_scale(&self) -> f64 {
        self.force_scale() * self.width()
    }

    fn width(&self) -> f64 {
        if self.design.unit.is_some() { self.design.width } else { 1.0 }
    }

    fn length(&self, value: f64) -> String {
        let unit = self.design.unit.map_or("D", |unit| unit.symbol());
        format!("{} {unit}", text::length(value * self.width(), self.width()))
    }

    fn place(&self, error: &PoseError) -> String {
        let said = self.design.alignment.free.iter().map(|axis| {
            let value = error.to_array()[axis.index()];
            if axis.is_rotation() {
                format!("{} {:.2}°", axis.name(), value.to_degrees() + 0.0)
            } else {
                format!("{} {}", axis.name(), self.length(value))
            }
        });
        said.collect::<Vec<_>>().join(", ")
    }

    /// Loads as records for programs, the names of the columns first; shares of the preload, and of it times D; `inf` where any is withstood, empty where
    /// nothing was asked.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "load direction_rad sign smooth_guided smooth_free rough_guided rough_free";
        let mut records = vec![head.split_whitespace().map(str::to_owned).collect::<Vec<_>>()];
        let mut add = |name: &str, direction: String, sign: String, columns: Columns| {
            let mut record = vec![name.to_owned(), direction, sign];
            record.extend(columns.map(|value| value.map_or_else(String::new, number)));
            records.push(record);
        };
        for side in &self.sideways {
            add("sideways", number(side.direction_rad), String::new(), columns(side.smooth, side.rough));
        }
        for torque in &self.torques {
            let sign = number(torque.sign);
            add(torque.axis.name(), String::new(), sign, columns(torque.smooth, torque.rough));
        }
        records
    }
}

/// A line of numbers, one of each column.
fn numbers(text: &mut String, name: &str, columns: &Columns, scale: f64) {
    let told = |value: f64| match value {
        f64::INFINITY => "any".to_owned(),
        value if value < NOTHING => "0".to_owned(),
        value => significant(value * scale),
    };
    let cells: Vec<String> =
        columns.iter().map(|value| format!("{:>14}", value.map_or_else(String::new, told))).collect();
    line(text, &format!("  {name:<15}{}", cells.concat()));
}

/// Directions that are told.
const SHOWN: usize = 8;
/// Shares of the preload below this are nothing: rounding.
const NOTHING: f64 = 1e-6;

/// A direction in degrees, to a tenth where that matters.
fn degrees(direction: f64) -> String {
    let degrees = direction.to_degrees();
    let whole = degrees.round();
    if (degrees - whole).abs() < 0.05 { format!("{}°", whole + 0.0) } else { format!("{degrees:.1}°") }
}
