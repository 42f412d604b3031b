//! Description of rests in words: position, stability, escape height, contacts.

use super::{Examined, Extent, FeatureContact, NamedFeature, Stability};
use crate::design::Design;
use crate::document::{DesignUnits, Document, NOTHING, rounded_down, significant};
use crate::method::descent::{Immobility, ImmobilityOrder, Sticking};
use crate::pose::{Dof, PoseError};
use crate::tolerance::TOUCHING;

/// Cosine of a pitch at which roll and yaw can no longer be distinguished: 89°.
const ON_ITS_SIDE: f64 = 0.0175;
/// Contacts whose places are shown.
const MOST_CONTACTS: usize = 4;
/// Rests within this are at the same place, in D or radians.
const ONE_PLACE: f64 = 0.01;
/// Dry halves have no more friction than this, mostly: wedging beyond it is not shown.
const MOST_COMMON: f64 = 1.0;

impl Immobility {
    /// By which order it is held, in words.
    pub fn words(&self) -> String {
        let ways = if self.free == 1 { "one direction" } else { "some directions" };
        let bends = self.curvature.map_or_else(String::new, |curvature| {
            format!(", curvature {} per D", significant(curvature).replace('-', "−"))
        });
        match self.order {
            ImmobilityOrder::First => {
                "first-order immobile: any small displacement raises the COR".to_owned()
            }
            ImmobilityOrder::Second => format!(
                "second-order immobile: in {ways} only the curvature of the contacts raises the COR{bends}"
            ),
            ImmobilityOrder::Neutral if self.free == 0 => {
                "first-order immobile, but its smallest slope is almost 0".to_owned()
            }
            ImmobilityOrder::Neutral => "neutral: it can slide without rising".to_owned(),
            ImmobilityOrder::Unstable => format!("unstable: in {ways} the contacts let the COR fall{bends}"),
        }
    }
}

impl Sticking {
    /// From which friction it sticks, in words.
    pub fn words(&self) -> String {
        let held = match (self.holds_from, self.slips_until) {
            (None, _) => "slips at any friction coefficient".to_owned(),
            (Some(0.0), _) => "its contacts hold it without friction".to_owned(),
            (Some(from), None) => format!("may stick from {from:.3} on, and may slip at any friction"),
            (Some(from), Some(until)) => format!("may stick from {from:.3} on, slips until {until:.3}"),
        };
        match self.wedges_from.filter(|from| *from <= MOST_COMMON) {
            Some(from) => format!("{held}; wedges from {from:.3} on, and may then hold against a pull out"),
            None => held,
        }
    }
}

impl Examined {
    /// Whether nothing but so much friction holds it.
    pub fn is_held_by_friction(&self, friction: f64) -> bool {
        friction > 0.0 && (self.stability == Stability::Ridge || self.immobility.is_none())
    }
}

/// Two features that touch, in words: `rim of the moving half on wall of the fixed one`.
pub fn contact_in_words(fixed: &NamedFeature, moving: &NamedFeature) -> String {
    format!("{} of the moving half on {} of the fixed one", moving.name, fixed.name)
}

/// The contacts in words, with equal pairs combined:
/// `rim of the moving half on wall of the fixed one, twice`.
pub fn contacts_in_words(contacts: &[FeatureContact]) -> Vec<String> {
    let mut pairs: Vec<(String, usize)> = Vec::new();
    for contact in contacts {
        let words = contact_in_words(&contact.fixed, &contact.moving);
        match pairs.iter_mut().find(|(other, _)| *other == words) {
            Some((_, count)) => *count += 1,
            None => pairs.push((words, 1)),
        }
    }
    let times = |count: usize| match count {
        1 => String::new(),
        2 => ", twice".to_owned(),
        n => format!(", {n} times"),
    };
    pairs.into_iter().map(|(words, count)| words + &times(count)).collect()
}

/// What the names of faces mean ([`FaceOrientation::name`](crate::contact::feature::FaceOrientation::name)).
pub(in crate::run) const FACES: &str = "top: the foremost level face of a half; underside: a face turned away from the other half; \
     slopes are measured from level.";

/// The escape height in words.
pub fn escape_height(design: &Design, climb: f64) -> String {
    if climb < NOTHING {
        "escape height 0".to_owned()
    } else {
        format!("escape height at most {}", DesignUnits::of(design).fine(climb))
    }
}

/// Rests of a design in words.
#[derive(Debug, Clone, Copy)]
pub(in crate::run) struct RestDescriptions<'a> {
    units: DesignUnits<'a>,
    friction: f64,
}

impl<'a> RestDescriptions<'a> {
    pub(in crate::run) const fn of(design: &'a Design, friction: f64) -> Self {
        Self { units: DesignUnits::of(design), friction }
    }

    /// The pose of a rest, and its height above the mated pose.
    pub(in crate::run) fn pose(
        self,
        document: &mut Document,
        pose: &PoseError,
        above: f64,
        extent: &[Extent],
    ) {
        document.row("  typical rest", format!("{}{}", self.units.pose(pose), self.above(above)));
        let wide = self.extent(pose, extent);
        if !wide.is_empty() {
            document.row("  range of rests", wide);
        }
    }

    /// `, 1.2 mm above the mated pose`; empty for equal height.
    fn above(self, above: f64) -> String {
        if above.abs() < TOUCHING {
            return String::new();
        }
        let side = if above < 0.0 { "below" } else { "above" };
        format!(", {} {side} the mated pose", self.units.length(above.abs()))
    }

    /// The range of the rests, if they are at more than a single place.
    fn extent(self, pose: &PoseError, extent: &[Extent]) -> String {
        // On its side, roll and yaw rotate about the same axis: only their sum, or difference, is defined.
        let on_its_side = pose.pitch.cos().abs() < ON_ITS_SIDE;
        let is_shown = |axis: Dof| !(on_its_side && matches!(axis, Dof::Roll | Dof::Yaw));
        let wide = extent.iter().filter(|side| is_shown(side.axis) && side.to - side.from > ONE_PLACE);
        let parts: Vec<String> = wide
            .map(|side| {
                if side.axis.is_rotation() {
                    let [from, to] = [side.from, side.to].map(|value| value.to_degrees() + 0.0);
                    format!("{} {from:.1} … {to:.1}°", side.axis.name())
                } else {
                    let [from, to] = [side.from, side.to].map(|value| self.units.plain(value));
                    format!("{} {from} … {to} {}", side.axis.name(), self.units.unit())
                }
            })
            .collect();
        parts.join(", ")
    }

    /// By which order contacts hold it.
    pub(in crate::run) fn order(document: &mut Document, examined: &Examined) {
        if let Some(held) = &examined.immobility {
            document.row("  stability", held.words());
        }
    }

    /// The stability, and the friction thresholds: with friction, or if the contacts alone do not hold the
    /// half.
    pub(in crate::run) fn held(self, document: &mut Document, examined: &Examined) {
        document.row("  if displaced", self.stability(examined));
        let matters = self.friction > 0.0 || examined.immobility.is_none();
        if let Some(sticks) = examined.sticks.filter(|_| matters) {
            document.row("  friction", sticks.words());
        }
    }

    fn stability(self, examined: &Examined) -> String {
        let push = self.units.length(examined.push_d);
        let Examined { returned, displaced, .. } = examined;
        if examined.is_held_by_friction(self.friction) {
            return format!(
                "held by friction alone; {returned} of {displaced} random displacements by half of {push} end in the same group of rests"
            );
        }
        let rise = match (examined.stability, examined.rise_at_most_d) {
            (Stability::Level, Some(rise)) => {
                let (level, rises) = if rise < NOTHING {
                    ("level", "does not rise".to_owned())
                } else {
                    ("almost level", format!("rises only {}", self.units.fine(rise)))
                };
                format!("{level}: by {push} in the direction of least rise, the COR {rises}")
            }
            (Stability::Ridge, _) => {
                format!(
                    "unstable: by {push} in the direction of least rise, the COR falls; the rest is on a ridge"
                )
            }
            (_, Some(rise)) => {
                let rise = self.units.fine(rise);
                format!("stable: by {push} in the direction of least rise, the COR rises {rise}")
            }
            (_, None) => "stable: walls all around".to_owned(),
        };
        format!(
            "{rise}; {returned} of {displaced} random displacements of half this size end in the same group of rests"
        )
    }

    /// The escape height, with the end of the escape path.
    pub(in crate::run) fn escape(self, climb: f64, to: &str) -> String {
        if climb < NOTHING {
            format!("0: pushed sideways it {to} without rising")
        } else {
            format!("at most {}: raised by this on the easiest path found, it {to}", self.units.fine(climb))
        }
    }

    /// Other bounds on the escape height: from below, and on a grid, if the settings request them.
    pub(in crate::run) fn depths(
        self,
        document: &mut Document,
        [certified, grid]: [bool; 2],
        at_least: Option<f64>,
        on_grid: Option<f64>,
    ) {
        if let Some(depth) = at_least {
            let depth = if depth < NOTHING { 0.0 } else { depth };
            let depth = rounded_down(depth * self.units.scale());
            document.more(format!("at least {depth} {}, certified", self.units.unit()));
        } else if certified {
            document.more("no certified lower bound was found");
        }
        if let Some(depth) = on_grid {
            document.more(format!("{} by the merge tree of the grid", self.units.fine(depth)));
        } else if grid {
            document.more(
                "not known by the grid: it rests outside the error box, or in the basin of a neighbour",
            );
        }
    }

    /// The contacts, with their positions on both halves.
    pub(in crate::run) fn contacts(self, document: &mut Document, contacts: &[FeatureContact]) {
        // Corners, edges and facets that meet at one point are one place.
        let mut places: Vec<String> = Vec::new();
        for (k, words) in contacts_in_words(contacts).into_iter().enumerate() {
            let pair = |contact: &&FeatureContact| {
                words.starts_with(&contact_in_words(&contact.fixed, &contact.moving))
            };
            let mut at: Vec<String> = Vec::new();
            let mut is_listed = false;
            for contact in contacts.iter().filter(pair) {
                let [fixed, moving] = [&contact.fixed, &contact.moving].map(|feature| self.drawn(feature));
                let place =
                    format!("at {fixed} of the fixed half as drawn, {moving} of the moving half as drawn");
                if places.contains(&place) {
                    is_listed = true;
                } else if places.len() < MOST_CONTACTS {
                    places.push(place.clone());
                    at.push(place);
                }
            }
            document.row(if k == 0 { "  contact" } else { "" }, words);
            if at.is_empty() && is_listed {
                document.more("at the same point as above");
            }
            for place in at {
                document.more(place);
            }
        }
    }

    fn drawn(self, feature: &NamedFeature) -> String {
        let part =
            feature.part.map_or_else(String::new, |part| format!(" (its part {part}, counted from 0)"));
        format!("{}{part}", self.units.point(feature.drawn_d))
    }
}
