//! Jams: as versioned JSON, as text, as records for programs.

mod found;

use found::share_of;
pub(super) use found::shares;
pub use found::{
    ContactReport, ExaminedReport, ExtentReport, JamReport, JamsFound, PairReport, WayOutReport,
};

use super::envelope::{Body, Envelope};
use super::resting::{Told, friction_line, said};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, number, row, tenths, wrapped};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::Share;
use catchment_core::method::descent::HARDLY;
use catchment_core::run::jams::{Jams, NamedFeature};
use serde::Serialize;
use std::ops::Deref;

/// Where motions rest that do not dock, with its head.
pub type JamsReport = Envelope<JamsBody>;

/// Where motions rest that do not dock.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JamsBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// What was found.
    #[serde(flatten)]
    pub found: JamsFound,
}

impl Body for JamsBody {
    const KIND: &'static str = "jams";
}

impl Deref for JamsBody {
    type Target = JamsFound;

    fn deref(&self) -> &JamsFound {
        &self.found
    }
}

impl JamsReport {
    /// Of a design.
    pub fn new(design: &Design, found: &Jams, doubts: Vec<WarningReport>, timing: Option<Timing>) -> Self {
        let body = JamsBody { design: design.clone(), found: JamsFound::new(design, found) };
        let undecided = found.counts[3] + found.expected.map_or(0, |counts| counts[3]);
        let mut warnings = doubts;
        if undecided > 0 {
            let said = catchment_core::acceptance::Warning::Undecided { cells: undecided };
            warnings.push(said.into());
        }
        warnings.extend(hardly_held(&body.found).map(|said| WarningReport::note(&said)));
        Self::of(body, warnings, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        let motions = format!("descent, {} random poses, no grid", grouped(self.motions));
        row(&mut text, "method", &motions);
        if self.settings.friction > 0.0 {
            row(&mut text, "friction", &format!("{} between the halves (Coulomb)", self.settings.friction));
        }
        text.push('\n');
        self.outcome_lines(&mut text);
        for (number, jam) in self.jams.iter().take(SHOWN).enumerate() {
            text.push('\n');
            self.jam_lines(&mut text, number + 1, jam);
        }
        if self.jams.len() > SHOWN {
            let rest: usize = self.jams[SHOWN..].iter().map(|jam| jam.of_box.count).sum();
            text.push('\n');
            let more = self.jams.len() - SHOWN;
            let share = share_of(rest, self.motions);
            line(&mut text, &format!("  and {} more, {} of the box together", grouped(more), tenths(share)));
        }
        self.pair_lines(&mut text);
        self.append_warnings(&mut text);
        text
    }

    fn outcome_lines(&self, text: &mut String) {
        let head = if self.expected.is_some() { "of the errors expected" } else { "" };
        line(text, &format!("  {:<15}{:<30}{head}", "outcome", "of the error box"));
        for (outcome, share) in &self.outcomes {
            let expected = self.expected.as_ref().map_or_else(String::new, |of| with_interval(&of[outcome]));
            line(text, &format!("  {:<15}{:<30}{expected}", outcome.name(), with_interval(share)));
        }
    }

    fn jam_lines(&self, text: &mut String, number: usize, jam: &JamReport) {
        let places = match jam.places {
            0 | 1 => String::new(),
            n => format!(", at {n} places that are images of each other"),
        };
        let expected = jam
            .expected
            .as_ref()
            .map_or_else(String::new, |share| format!(", {} of the errors expected", tenths(share.share)));
        let share = format!(
            "{} of the box ({} … {}), {} of jams, {} of failures{expected}{places}",
            tenths(jam.of_box.share),
            tenths(jam.of_box.ci95[0]),
            tenths(jam.of_box.ci95[1]),
            tenths(jam.of_jams),
            tenths(jam.of_failures)
        );
        wrapped(text, &format!("  {:<15}", format!("jam {number}")), &share);
        let told = self.told();
        said(text, "  rests", &format!("{}{}", told.place(&jam.pose), told.above(jam.above_mated_d)));
        if let Some(symmetry) = jam.docked_with_symmetry {
            let turned = "the mated pose, turned by a symmetry of the halves: it counts as docked";
            said(text, "  turned", &format!("{turned} where the design says symmetry = {symmetry}"));
        }
        let wide = told.extent(&jam.pose, &jam.extent);
        if !wide.is_empty() {
            said(text, "  anywhere in", &wide);
        }
        if let Some(examined) = &jam.examined {
            if let Some(held) = &examined.immobility {
                said(text, "  order", &held.words());
            }
            let friction = self.settings.friction;
            // Friction stops a half just before all contacts of the mated pose close: how it would be held there says nothing.
            if friction == 0.0 || jam.docked_with_symmetry.is_none() {
                said(text, "  held", &told.held(examined, friction));
                friction_line(text, examined, friction);
            }
            said(text, "  out", &self.out(examined));
        }
        let asked = [self.settings.certified && jam.examined.is_some(), self.settings.resolution.is_some()];
        told.depth_lines(text, asked, jam.depth_at_least_d, jam.depth_on_grid_d);
        told.contact_lines(text, &jam.contacts);
    }

    fn out(&self, examined: &ExaminedReport) -> String {
        let Some(way) = &examined.way_out else { return "no way out was found".to_owned() };
        let to = match way.to {
            Outcome::Aligned => "and it docks",
            Outcome::Missed => "and it slides off",
            Outcome::Jammed | Outcome::Undecided => "and it comes to a lower rest",
        };
        let lifted = self.told().lifted(way.climb_at_most_d);
        format!("{lifted}, {to}")
    }

    /// Tells places of rest.
    pub(super) fn told(&self) -> Told<'_> {
        Told::of(&self.design)
    }

    fn pair_lines(&self, text: &mut String) {
        if self.features.is_empty() {
            return;
        }
        text.push('\n');
        line(text, &format!("  {:>8}{:>12}   what touches where it jams", "of jams", "of failures"));
        for pair in self.features.iter().take(SHOWN) {
            let shares = format!("  {:>8}{:>12}   ", tenths(pair.of_jams), tenths(pair.of_failures));
            wrapped(
                text,
                &shares,
                &format!("{} of the moving half on {} of the fixed one", pair.moving.name, pair.fixed.name),
            );
        }
        if self.features.len() > SHOWN {
            line(text, &more_pairs(self.features.len() - SHOWN));
        }
    }

    /// Jams and what touches in each as records for programs, the names of the columns first; D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "jam count share share_lo share_hi of_jams of_failures expected x y roll pitch yaw height above_mated order \
                    slope_lo slope_hi curvature firmness rise_at_most holds_from slips_until wedges_from symmetry climb_at_most depth_at_least depth_on_grid leads_to fixed_kind fixed_name fixed_part fixed_x fixed_y fixed_z moving_kind \
                    moving_name moving_part moving_x moving_y moving_z";
        let mut records = vec![head.split_whitespace().map(str::to_owned).collect::<Vec<_>>()];
        for (k, jam) in self.jams.iter().enumerate() {
            let mut record = vec![(k + 1).to_string(), jam.of_box.count.to_string()];
            record.extend([jam.of_box.share, jam.of_box.ci95[0], jam.of_box.ci95[1]].map(number));
            record.extend([jam.of_jams, jam.of_failures].map(number));
            record.push(jam.expected.map_or_else(String::new, |share| number(share.share)));
            record.extend(jam.pose.to_array().map(number));
            record.extend([jam.height_d, jam.above_mated_d].map(number));
            let examined = jam.examined.as_ref();
            let or_nothing = |value: Option<f64>| value.map_or_else(String::new, number);
            let way = examined.and_then(|examined| examined.way_out);
            let held = examined.and_then(|examined| examined.immobility);
            record.push(held.map_or("", |held| held.order.name()).to_owned());
            record.extend([0, 1].map(|k| or_nothing(held.map(|held| held.slope[k]))));
            record.push(or_nothing(held.and_then(|held| held.curvature_per_d)));
            record.push(examined.map_or("", |examined| examined.firmness.name()).to_owned());
            record.push(or_nothing(examined.and_then(|examined| examined.rise_at_most_d)));
            let sticks = examined.and_then(|examined| examined.sticks);
            record.push(or_nothing(sticks.and_then(|sticks| sticks.holds_from)));
            record.push(or_nothing(sticks.and_then(|sticks| sticks.slips_until)));
            record.push(or_nothing(sticks.and_then(|sticks| sticks.wedges_from)));
            record.push(jam.docked_with_symmetry.map_or_else(String::new, |n| n.to_string()));
            record.push(or_nothing(way.map(|way| way.climb_at_most_d)));
            record.extend([jam.depth_at_least_d, jam.depth_on_grid_d].map(or_nothing));
            record.push(way.map_or("", |way| way.to.name()).to_owned());
            for contact in &jam.contacts {
                let feature = |feature: &NamedFeature| {
                    let part = feature.part.map_or_else(String::new, |part| part.to_string());
                    let named = [feature.kind.name().to_owned(), feature.name.clone(), part];
                    named.into_iter().chain(feature.drawn_d.map(number)).collect::<Vec<_>>()
                };
                let features = feature(&contact.fixed).into_iter().chain(feature(&contact.moving));
                records.push(record.iter().cloned().chain(features).collect());
            }
            if jam.contacts.is_empty() {
                record.resize(records[0].len(), String::new());
                records.push(record);
            }
        }
        records
    }
}

/// Which jams are held by hardly more friction than they slip at, as a sentence: there rigid halves and those of engines part.
fn hardly_held(found: &JamsFound) -> Option<String> {
    let friction = found.settings.friction;
    let is_hardly_held = |jam: &JamReport| {
        let examined = jam.examined.as_ref().filter(|examined| examined.is_held_by_friction(friction));
        let slips_until = examined.and_then(|examined| examined.sticks?.slips_until);
        slips_until.is_some_and(|until| friction < HARDLY * until)
    };
    let jams: Vec<String> = (1..)
        .zip(&found.jams)
        .filter(|(_, jam)| is_hardly_held(jam))
        .map(|(number, _)| number.to_string())
        .collect();
    let which = match jams.as_slice() {
        [] => return None,
        [one] => format!("jam {one} is"),
        [most @ .., last] => format!("jams {} and {last} are", most.join(", ")),
    };
    Some(format!(
        "{which} held by hardly more friction than would let it slip: rigid halves stick there, and halves that give, as those of engines do, may let go"
    ))
}

/// How many pairs of features are not told.
pub(super) fn more_pairs(count: usize) -> String {
    format!("  and {} {} more", grouped(count), if count == 1 { "pair" } else { "pairs" })
}

fn with_interval(share: &Share) -> String {
    format!("{:>7}  ({} … {})", tenths(share.share), tenths(share.ci95[0]), tenths(share.ci95[1]))
}

/// Jams and pairs of features that are told.
const SHOWN: usize = 6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pair_is_one() {
        assert_eq!(
            [1, 2, 1200].map(more_pairs),
            ["  and 1 pair more", "  and 2 pairs more", "  and 1 200 pairs more"]
        );
    }
}
