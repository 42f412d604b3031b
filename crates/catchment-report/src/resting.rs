//! Poses and sizes of errors in words, and what is told of a place of rest, of jams and of all others: where it is, how it is held, what touches.

use super::text::{significant, wrapped};
use super::{ContactReport, ExaminedReport, ExtentReport};
use catchment_core::design::Design;
use catchment_core::method::descent::{Immobility, Order, Sticking};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::run::jams::{Firmness, NamedFeature};
use serde::{Deserialize, Serialize};

/// By which order a rest is held (Rimon and Burdick).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HeldReport {
    /// `first`, `second`, `neutral` or `unstable`.
    pub order: Order,
    /// From where to where the least slope of a first-order rest lies, in D per D of the metric of the motion.
    pub slope: [f64; 2],
    /// Independent directions that are free to first order.
    pub free: usize,
    /// The least curvature of the height among them, per D; null where none is free.
    pub curvature_per_d: Option<f64>,
    /// The direction of that: offsets in D and turns in radians.
    pub weakest: PoseError,
}

impl From<Immobility> for HeldReport {
    fn from(found: Immobility) -> Self {
        let Immobility { order, slope, free, curvature, weakest } = found;
        Self { order, slope, free, curvature_per_d: curvature, weakest }
    }
}

impl HeldReport {
    /// In words.
    pub(super) fn words(&self) -> String {
        let slope = match self.slope {
            [from, to] if from == to => significant(to),
            [from, to] => format!("{} to {}", significant(from), significant(to)),
        };
        let ways = if self.free == 1 { "one way" } else { "some ways" };
        let bends = self.curvature_per_d.map_or_else(String::new, |curvature| {
            format!(", curvature {} per D", significant(curvature).replace('-', "−"))
        });
        match self.order {
            Order::First => format!("immobile to first order: rises by at least {slope} of any push"),
            Order::Second => format!("free {ways} to first order, immobile to second{bends}"),
            Order::Neutral if self.free == 0 => "held, but hardly: it rises by next to nothing".to_owned(),
            Order::Neutral => format!("free {ways} to first order and to second"),
            Order::Unstable => format!("free {ways} to first order, unstable to second{bends}"),
        }
    }
}

/// From which friction on a rest may stick, by Coulomb's law ([`catchment_core::method::descent::sticking()`]).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ThresholdsReport {
    /// From this friction on forces exist that hold it, 0 where contacts alone do; null: at none.
    pub holds_from: Option<f64>,
    /// Up to this friction there is a way to slip; null: at any.
    pub slips_until: Option<f64>,
    /// From this friction on it wedges, and may hold against a pull straight out as well; null: at none.
    pub wedges_from: Option<f64>,
}

impl From<Sticking> for ThresholdsReport {
    fn from(found: Sticking) -> Self {
        let Sticking { holds_from, slips_until, wedges_from } = found;
        Self { holds_from, slips_until, wedges_from }
    }
}

/// Dry halves have no more friction than this, mostly: what wedges beyond it is not told.
const MOST_COMMON: f64 = 1.0;

impl ThresholdsReport {
    /// In words.
    pub(super) fn words(&self) -> String {
        let held = match (self.holds_from, self.slips_until) {
            (None, _) => "slips, whatever the friction".to_owned(),
            (Some(0.0), _) => "none is needed, contacts alone hold it".to_owned(),
            (Some(from), None) => format!("may stick from {from:.3} on, and may slip at any"),
            (Some(from), Some(until)) => format!("may stick from {from:.3} on, slips until {until:.3}"),
        };
        match self.wedges_from.filter(|from| *from <= MOST_COMMON) {
            Some(from) => format!("{held}; wedges from {from:.3} on, and may then hold against a pull out"),
            None => held,
        }
    }
}

/// A line of a place, wrapped.
pub(super) fn said(text: &mut String, name: &str, words: &str) {
    wrapped(text, &format!("  {name:<15}"), words);
}

/// From which friction on it may stick: where friction is asked about, or contacts alone do not hold it.
pub(super) fn friction_line(text: &mut String, examined: &ExaminedReport, friction: f64) {
    if let Some(sticks) = examined.sticks.filter(|_| friction > 0.0 || examined.immobility.is_none()) {
        said(text, "  friction", &sticks.words());
    }
}

/// What touches, in words, the same pairs said once: `rim on wall, twice`.
pub(super) fn words(contacts: &[ContactReport]) -> Vec<String> {
    let mut said: Vec<(String, usize)> = Vec::new();
    for contact in contacts {
        let words =
            format!("{} of the moving half on {} of the fixed one", contact.moving.name, contact.fixed.name);
        match said.iter_mut().find(|(other, _)| *other == words) {
            Some((_, count)) => *count += 1,
            None => said.push((words, 1)),
        }
    }
    let times = |count: usize| match count {
        1 => String::new(),
        2 => ", twice".to_owned(),
        n => format!(", {n} times"),
    };
    said.into_iter().map(|(words, count)| words + &times(count)).collect()
}

/// Lengths and poses of a design, in words.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told<'a> {
    design: &'a Design,
}

impl<'a> Told<'a> {
    /// Of a design.
    pub(super) const fn of(design: &'a Design) -> Self {
        Self { design }
    }

    /// How firmly it is held, in words; with so much friction.
    pub(super) fn held(self, examined: &ExaminedReport, friction: f64) -> String {
        let push = self.length(examined.push_d);
        let ExaminedReport { back, pushed, .. } = examined;
        if examined.is_held_by_friction(friction) {
            return format!(
                "by friction alone: contacts alone do not hold it; {back} of {pushed} poses beside it stay or come back"
            );
        }
        let rise = match (examined.firmness, examined.rise_at_most_d) {
            (Firmness::Level, Some(rise)) => {
                format!("near-level: pushed {push} one way it rises by {} only", self.fine(rise))
            }
            (Firmness::Ridge, _) => {
                format!("not at all: pushed {push} one way it falls, it came to rest on a ridge")
            }
            (firmness, Some(rise)) => {
                format!(
                    "{}: pushed {push} the weakest way found it rises by {}",
                    firmness.name(),
                    self.fine(rise)
                )
            }
            (firmness, None) => format!("{}: walls all around", firmness.name()),
        };
        format!("{rise}; {back} of {pushed} poses beside it came back")
    }

    /// How far a half must be lifted, in words.
    pub(super) fn lifted(self, climb: f64) -> String {
        if climb < NOTHING {
            "not lifted at all".to_owned()
        } else {
            format!("lifted by {} at most", self.fine(climb))
        }
    }

    /// Depths beside that of the way that was found: at least, and on a grid, where these were asked for.
    pub(super) fn depth_lines(
        self,
        text: &mut String,
        asked: [bool; 2],
        at_least: Option<f64>,
        on_grid: Option<f64>,
    ) {
        if let Some(depth) = at_least {
            let depth = if depth < NOTHING { 0.0 } else { depth };
            let depth = super::text::rounded_down(depth * self.scale());
            said(text, "", &format!("by {depth} {} at least, certainly", self.unit()));
        } else if asked[0] {
            said(text, "", "how far at least is not certain");
        }
        if let Some(depth) = on_grid {
            said(text, "", &format!("by {}, the merge tree of the grid says", self.fine(depth)));
        } else if asked[1] {
            said(
                text,
                "",
                "by the grid no depth is told: it rests outside the error box, or in the basin of what lies beside",
            );
        }
    }

    /// What touches, and where on either half.
    pub(super) fn contact_lines(self, text: &mut String, contacts: &[ContactReport]) {
        for (k, words) in words(contacts).iter().enumerate() {
            said(text, if k == 0 { "  touching" } else { "" }, words);
        }
        for contact in contacts.iter().take(MOST_CONTACTS) {
            let [fixed, moving] = [&contact.fixed, &contact.moving].map(|feature| self.drawn(feature));
            said(text, "", &format!("at {fixed} of the fixed, {moving} of the moving half as drawn"));
        }
        if contacts.len() > MOST_CONTACTS {
            said(text, "", &format!("and at {} more", contacts.len() - MOST_CONTACTS));
        }
    }

    /// How far it is above the mated pose, if it is: `, 1.2 mm above the mated pose`.
    pub(super) fn above(self, above: f64) -> String {
        if above.abs() < ONE_HEIGHT {
            return String::new();
        }
        let side = if above < 0.0 { "below" } else { "above" };
        format!(", {} {side} the mated pose", self.length(above.abs()))
    }

    /// From where to where rests lie where that is more than a place.
    pub(super) fn extent(self, pose: &PoseError, extent: &[ExtentReport]) -> String {
        // On its side roll and yaw are turns about one axis: only their sum, or difference, means anything.
        let on_its_side = pose.pitch.cos().abs() < ON_ITS_SIDE;
        let is_told = |axis: Dof| !(on_its_side && matches!(axis, Dof::Roll | Dof::Yaw));
        let wide = extent.iter().filter(|side| is_told(side.axis) && side.to - side.from > ONE_PLACE);
        let said: Vec<String> = wide
            .map(|side| {
                if side.axis.is_rotation() {
                    let [from, to] = [side.from, side.to].map(|value| value.to_degrees() + 0.0);
                    format!("{} {from:.1} … {to:.1}°", side.axis.name())
                } else {
                    let [from, to] = [side.from, side.to].map(|value| self.plain(value));
                    format!("{} {from} … {to} {}", side.axis.name(), self.unit())
                }
            })
            .collect();
        said.join(", ")
    }

    fn unit(self) -> &'static str {
        self.design.unit.map_or("D", |unit| unit.symbol())
    }

    fn scale(self) -> f64 {
        if self.design.unit.is_some() { self.design.width } else { 1.0 }
    }

    fn plain(self, value: f64) -> String {
        super::text::length(value * self.scale(), self.scale())
    }

    /// A length with its unit.
    pub(super) fn length(self, value: f64) -> String {
        format!("{} {}", self.plain(value), self.unit())
    }

    /// A small length, to three digits.
    pub(super) fn fine(self, value: f64) -> String {
        let value = if value < NOTHING { 0.0 } else { value };
        format!("{} {}", super::text::significant(value * self.scale()), self.unit())
    }

    fn drawn(self, feature: &NamedFeature) -> String {
        let part = feature.part.map_or_else(String::new, |part| format!(" on part {part}"));
        format!("{}{part}", self.point(feature.drawn_d))
    }

    /// A place: `(1.2, 0.0, -3.4) mm`.
    pub(super) fn point(self, point: [f64; 3]) -> String {
        let [x, y, z] = point.map(|part| self.plain(part));
        format!("({x}, {y}, {z}) {}", self.unit())
    }

    /// `±0.402 mm` or `±12.3°`, rounded towards zero.
    pub(super) fn size(self, axis: Dof, value: f64) -> String {
        let down = |value: f64, digits: f64| (value * digits + 1e-9).floor() / digits;
        if axis.is_rotation() {
            return format!("±{:.2}°", down(value.to_degrees(), 100.0));
        }
        match self.design.unit {
            Some(unit) => {
                let decimals = super::text::decimals(self.design.width);
                let value = down(value * self.design.width, 10f64.powf(decimals as f64));
                format!("±{value:.decimals$} {}", unit.symbol())
            }
            None => format!("±{:.4} D", down(value, 10_000.0)),
        }
    }

    /// A pose error in words.
    pub(super) fn place(self, error: &PoseError) -> String {
        let free = self.design.alignment.free.iter();
        let said: Vec<String> = free
            .map(|axis| {
                let value = error.to_array()[axis.index()];
                if axis.is_rotation() {
                    let degrees = value.to_degrees();
                    format!("{} {:.2}°", axis.name(), if degrees.abs() < 5e-3 { 0.0 } else { degrees })
                } else {
                    format!("{} {}", axis.name(), self.length(value))
                }
            })
            .collect();
        said.join(", ")
    }
}

/// Cosine of a pitch at which roll and yaw can no longer be told apart: 89°.
const ON_ITS_SIDE: f64 = 0.0175;
/// Heights below this are nothing, in D: rounding.
const NOTHING: f64 = 1e-8;
/// Heights nearer than this are one, in D.
const ONE_HEIGHT: f64 = 1e-4;
/// Contacts whose places are told.
const MOST_CONTACTS: usize = 4;
/// Rests within this are at one place, in D or radians.
const ONE_PLACE: f64 = 0.01;
