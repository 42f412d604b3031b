//! Rests: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::jams::shares;
use super::resting::{Told, friction_line, said};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, number, row, tenths, tenths_between, wrapped};
use super::{ContactReport, ExaminedReport, ExtentReport};
use catchment_core::acceptance::{Outcome, Warning};
use catchment_core::design::Design;
use catchment_core::document::Share;
use catchment_core::pose::PoseError;
use catchment_core::run::rests::{Place, Rests, Settings};
use serde::Serialize;
use std::collections::BTreeMap;

/// Where halves come to rest, with its head.
pub type RestsReport = Envelope<RestsBody>;

/// Where halves come to rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RestsBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// Random poses of the error box that were followed.
    pub motions: usize,
    /// What became of them, by the names of outcomes.
    pub outcomes: BTreeMap<Outcome, Share>,
    /// The rests, the one with most of the poses first.
    pub rests: Vec<RestReport>,
}

/// A place of rest, or places alike.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RestReport {
    /// How many poses of the error box end here: its basin.
    pub of_box: Share,
    /// How many of them count as docked.
    pub docked: usize,
    /// The pose error of the rest in its middle.
    pub pose: PoseError,
    /// From where to where its rests lie, per free error; images by symmetry laid upon each other.
    pub extent: Vec<ExtentReport>,
    /// At how many places that are images of each other rests were seen.
    pub places: usize,
    /// z of the centre of rotation in the world frame, in D: the energy per unit of weight.
    pub height_d: f64,
    /// How far it is above the mated pose, in D.
    pub above_mated_d: f64,
    /// At most so far it must be lifted to leave, in D; null where no way out was found, or it was not examined.
    pub depth_at_most_d: Option<f64>,
    /// At least so far it must be lifted before it may come to rest elsewhere, in D, certainly; null where that was not asked for, or is not known.
    pub depth_at_least_d: Option<f64>,
    /// The depth that the merge tree of a grid says, in D: a bound from neither side; null where no grid was asked for, or it does not say.
    pub depth_on_grid_d: Option<f64>,
    /// The rest to which that way leads, from 0 in this list; null where it leads off.
    pub leads_to: Option<usize>,
    /// What touches.
    pub contacts: Vec<ContactReport>,
    /// What was found out about it; null of rests that were not examined.
    pub examined: Option<ExaminedReport>,
}

impl Body for RestsBody {
    const KIND: &'static str = "rests";
}

impl RestReport {
    fn of(design: &Design, motions: usize, place: &Place) -> Self {
        let found = &place.found;
        let extent = design.alignment.free.iter().map(|axis| {
            let [from, to] = found.extent[axis.index()];
            ExtentReport { axis, from, to }
        });
        let way = found.examined.and_then(|examined| examined.way_out);
        Self {
            of_box: Share::of(found.count, motions),
            docked: place.docked,
            pose: found.pose,
            extent: extent.collect(),
            places: found.places,
            height_d: found.height,
            above_mated_d: found.above,
            depth_at_most_d: way.map(|way| way.climb),
            depth_at_least_d: found.depth_at_least,
            depth_on_grid_d: found.depth_on_grid,
            leads_to: place.leads_to,
            contacts: found.contacts.iter().map(ContactReport::from).collect(),
            examined: found.examined.as_ref().map(ExaminedReport::from),
        }
    }

    /// Whether most of its poses count as docked.
    pub const fn is_docked(&self) -> bool {
        2 * self.docked > self.of_box.count
    }
}

impl RestsReport {
    /// Of a design.
    pub fn new(design: &Design, found: &Rests, doubts: Vec<WarningReport>, timing: Option<Timing>) -> Self {
        let motions = found.motions();
        let body = RestsBody {
            design: design.clone(),
            settings: found.settings.clone(),
            motions,
            outcomes: shares(found.counts),
            rests: found.rests.iter().map(|place| RestReport::of(design, motions, place)).collect(),
        };
        let mut warnings = doubts;
        if found.counts[3] > 0 {
            warnings.push(Warning::Undecided { cells: found.counts[3] }.into());
        }
        Self::of(body, warnings, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        row(&mut text, "load", "along -z, through the centre of rotation");
        row(&mut text, "method", &format!("descent, {} random poses, no grid", grouped(self.motions)));
        let off: Vec<String> = self
            .outcomes
            .iter()
            .filter(|(outcome, share)| {
                matches!(outcome, Outcome::Missed | Outcome::Undecided) && share.count > 0
            })
            .map(|(outcome, share)| format!("{} {} of the box", outcome.name(), with_interval(share)))
            .collect();
        if !off.is_empty() {
            row(&mut text, "no rest", &off.join(", "));
        }
        for (number, rest) in self.rests.iter().take(SHOWN).enumerate() {
            text.push('\n');
            self.rest_lines(&mut text, number + 1, rest);
        }
        if self.rests.is_empty() {
            text.push('\n');
            line(&mut text, "  nothing comes to rest");
        }
        if self.rests.len() > SHOWN {
            let poses: usize = self.rests[SHOWN..].iter().map(|rest| rest.of_box.count).sum();
            let share = Share::of(poses, self.motions);
            text.push('\n');
            let more = grouped(self.rests.len() - SHOWN);
            line(&mut text, &format!("  and {more} more, {} of the box together", tenths(share.share)));
        }
        self.append_warnings(&mut text);
        text
    }

    fn rest_lines(&self, text: &mut String, number: usize, rest: &RestReport) {
        let told = Told::of(&self.design);
        let places = match rest.places {
            0 | 1 => String::new(),
            n => format!(", at {n} places that are images of each other"),
        };
        let docked = if rest.is_docked() { ", docked" } else { "" };
        let share = format!("basin {} of the box{docked}{places}", with_interval(&rest.of_box));
        wrapped(text, &format!("  {:<15}", format!("rest {number}")), &share);
        let place = told.place(&rest.pose);
        said(text, "  rests", &format!("{place}{}", told.above(rest.above_mated_d)));
        let wide = told.extent(&rest.pose, &rest.extent);
        if !wide.is_empty() {
            said(text, "  anywhere in", &wide);
        }
        if let Some(examined) = &rest.examined {
            if let Some(held) = &examined.immobility {
                said(text, "  order", &held.words());
            }
            said(text, "  held", &told.held(examined, 0.0));
            friction_line(text, examined, 0.0);
            said(text, "  depth", &self.out(rest));
        }
        let asked = [self.settings.certified && rest.examined.is_some(), self.settings.resolution.is_some()];
        told.depth_lines(text, asked, rest.depth_at_least_d, rest.depth_on_grid_d);
        told.contact_lines(text, &rest.contacts);
    }

    /// How far it must be lifted to leave, and where that leads, in words.
    pub(super) fn out(&self, rest: &RestReport) -> String {
        let Some(depth) = rest.depth_at_most_d else { return "no way out was found".to_owned() };
        let lifted = Told::of(&self.design).lifted(depth);
        let way = rest.examined.and_then(|examined| examined.way_out);
        let to = match (way.map(|way| way.to), rest.leads_to) {
            (Some(Outcome::Missed), _) => "slides off".to_owned(),
            (_, Some(k)) if self.rests.get(k).is_some_and(|to| std::ptr::eq(to, rest)) => {
                "comes to an image of this place".to_owned()
            }
            (_, Some(k)) => format!("comes to rest {}", k + 1),
            _ => "comes to another place".to_owned(),
        };
        format!("{lifted}, and it {to}")
    }

    /// Rests as records for programs, the names of the columns first; D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "rest count share share_lo share_hi docked x y roll pitch yaw height above_mated order slope_lo slope_hi free curvature \
                    firmness holds_from slips_until wedges_from depth_at_most depth_at_least depth_on_grid leads_to touching";
        let mut records = vec![head.split_whitespace().map(str::to_owned).collect::<Vec<_>>()];
        let or_nothing = |value: Option<f64>| value.map_or_else(String::new, number);
        for (k, rest) in self.rests.iter().enumerate() {
            let mut record = vec![(k + 1).to_string(), rest.of_box.count.to_string()];
            record.extend([rest.of_box.share, rest.of_box.ci95[0], rest.of_box.ci95[1]].map(number));
            record.push(rest.docked.to_string());
            record.extend(rest.pose.to_array().map(number));
            record.extend([rest.height_d, rest.above_mated_d].map(number));
            let held = rest.examined.and_then(|examined| examined.immobility);
            record.push(held.map_or("", |held| held.order.name()).to_owned());
            record.extend([0, 1].map(|k| or_nothing(held.map(|held| held.slope[k]))));
            record.push(held.map_or_else(String::new, |held| held.free.to_string()));
            record.push(or_nothing(held.and_then(|held| held.curvature_per_d)));
            record.push(rest.examined.map_or("", |examined| examined.firmness.name()).to_owned());
            let sticks = rest.examined.and_then(|examined| examined.sticks);
            record.push(or_nothing(sticks.and_then(|sticks| sticks.holds_from)));
            record.push(or_nothing(sticks.and_then(|sticks| sticks.slips_until)));
            record.push(or_nothing(sticks.and_then(|sticks| sticks.wedges_from)));
            record.push(or_nothing(rest.depth_at_most_d));
            record.extend([rest.depth_at_least_d, rest.depth_on_grid_d].map(or_nothing));
            record.push(rest.leads_to.map_or_else(String::new, |to| (to + 1).to_string()));
            record.push(super::resting::words(&rest.contacts).join("; "));
            records.push(record);
        }
        records
    }
}

fn with_interval(share: &Share) -> String {
    tenths_between(share.share, share.ci95)
}

/// Rests that are told.
const SHOWN: usize = 6;
