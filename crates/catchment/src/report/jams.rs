//! Jams: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::resting::{HeldReport, Told, said};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, number, row, wrapped};
use crate::acceptance::Outcome;
use crate::design::Design;
use crate::merit::sum::wilson95;
use crate::pose::{Dof, PoseError};
use crate::run::jams::{Examined, Firmness, Jam, Jams, Named, PUSH, Settings, Touched, Touching};
use serde::{Serialize, Serializer};

/// Where motions rest that do not dock, with its head.
pub type JamsReport = Envelope<JamsBody>;

/// Where motions rest that do not dock.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JamsBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// Random poses of the error box that were followed.
    pub motions: usize,
    /// What became of them, by the names of outcomes.
    #[serde(serialize_with = "by_name")]
    pub outcomes: Vec<(Outcome, ShareReport)>,
    /// The same of poses drawn from the errors that a robot makes; null where none were given.
    #[serde(serialize_with = "by_name_or_null")]
    pub expected: Option<Vec<(Outcome, ShareReport)>>,
    /// The jams, the one with most of the poses first.
    pub jams: Vec<JamReport>,
    /// Which pairs of features touch in jams, the one that does so most often first.
    pub features: Vec<PairReport>,
}

/// How many of all poses that were followed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShareReport {
    /// How many.
    pub count: usize,
    /// Their share, in [0, 1].
    pub share: f64,
    /// Wilson's 95 % interval of it.
    pub ci95: [f64; 2],
}

/// A place of rest, or places alike.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JamReport {
    /// How many poses of the error box end here, and which share that is.
    pub of_box: ShareReport,
    /// Their share of the poses that jam.
    pub of_jams: f64,
    /// Their share of the poses that do not dock.
    pub of_failures: f64,
    /// The same of the errors that a robot makes; null where none were given.
    pub expected: Option<ShareReport>,
    /// The pose error of the rest in its middle.
    pub pose: PoseError,
    /// From where to where its rests lie, per free error; images by symmetry laid upon each other.
    pub extent: Vec<ExtentReport>,
    /// At how many places that are images of each other rests were seen.
    pub places: usize,
    /// z of the COR in the world frame, in D.
    pub height_d: f64,
    /// How far it is above the mated pose, in D.
    pub above_mated_d: f64,
    /// What touches.
    pub contacts: Vec<ContactReport>,
    /// What was found out about it; null of jams that were not examined.
    pub examined: Option<ExaminedReport>,
    /// The depth that the merge tree of a grid says, in D: a bound from neither side; null where no grid was asked for, or it does not say.
    pub depth_on_grid_d: Option<f64>,
}

/// From where to where rests lie along an error, in D or radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExtentReport {
    /// Which error.
    pub axis: Dof,
    /// From here.
    pub from: f64,
    /// To here.
    pub to: f64,
}

/// Two features that touch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactReport {
    /// Where, in the world frame, in D.
    pub points_d: Vec<[f64; 3]>,
    /// Unit normal, from the fixed half to the moving one.
    pub normal: [f64; 3],
    /// The feature of the fixed half.
    pub fixed: FeatureReport,
    /// The feature of the moving half.
    pub moving: FeatureReport,
}

/// A feature of a half.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureReport {
    /// `face`, `edge` or `corner`.
    pub kind: &'static str,
    /// In words.
    pub name: String,
    /// The number of its part in the design file, from 0; null where halves are not made up of parts of one surface each.
    pub part: Option<usize>,
    /// Where it touches, in the coordinates in which its half was drawn, in D.
    pub drawn_d: [f64; 3],
}

/// A pair of features, and how often it touches where halves jam.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairReport {
    /// Poses of the error box that jam on it.
    pub count: usize,
    /// Their share of the poses that jam.
    pub of_jams: f64,
    /// Their share of the poses that do not dock.
    pub of_failures: f64,
    /// The feature of the fixed half.
    pub fixed: FeatureReport,
    /// The feature of the moving half.
    pub moving: FeatureReport,
}

/// What was found out about a jam.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExaminedReport {
    /// `sharp`, `rounded`, `level` or `ridge`.
    pub firmness: Firmness,
    /// By how much it is pushed aside, in the metric of the motion, in D.
    pub push_d: f64,
    /// The least rise found, in D: the true least is at most that. Null where walls stop it all around.
    pub rise_at_most_d: Option<f64>,
    /// The direction of that push: offsets in D and turns in radians.
    pub weakest: PoseError,
    /// By which order contacts alone hold it; null where they do not hold the load, as where friction does.
    pub immobility: Option<HeldReport>,
    /// The lowest way out that was found; null where none was.
    pub way_out: Option<WayOutReport>,
    /// Poses a little off that were followed.
    pub pushed: usize,
    /// How many of them came back.
    pub back: usize,
}

/// A way out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WayOutReport {
    /// How far the half must be lifted to get out, at most, in D.
    pub climb_at_most_d: f64,
    /// What becomes of it then.
    pub to: Outcome,
    /// The pose error from which motion leads there.
    pub over: PoseError,
}

impl Body for JamsBody {
    const KIND: &'static str = "jams";
}

fn share_of(count: usize, all: usize) -> f64 {
    if all == 0 { 0.0 } else { count as f64 / all as f64 }
}

impl ShareReport {
    pub(super) fn of(count: usize, all: usize) -> Self {
        Self { count, share: share_of(count, all), ci95: wilson95(count, all) }
    }
}

impl From<&Named> for FeatureReport {
    fn from(named: &Named) -> Self {
        let Named { kind, name, part, drawn } = named;
        Self { kind: kind.name(), name: name.clone(), part: *part, drawn_d: drawn.to_array() }
    }
}

impl From<&Touched> for ContactReport {
    fn from(touched: &Touched) -> Self {
        let points = touched.points.iter().map(glam::DVec3::to_array).collect();
        let Touched { normal, fixed, moving, .. } = touched;
        Self { points_d: points, normal: normal.to_array(), fixed: fixed.into(), moving: moving.into() }
    }
}

impl From<&Examined> for ExaminedReport {
    fn from(examined: &Examined) -> Self {
        let Examined { held, immobility, way_out, pushed, back } = *examined;
        let way_out =
            way_out.map(|way| WayOutReport { climb_at_most_d: way.climb, to: way.to, over: way.over });
        let (firmness, rise_at_most_d, weakest) = (held.firmness, held.rise, held.weakest);
        let immobility = immobility.map(HeldReport::from);
        Self { firmness, push_d: PUSH, rise_at_most_d, weakest, immobility, way_out, pushed, back }
    }
}

impl JamReport {
    fn of(design: &Design, found: &Jams, jam: &Jam) -> Self {
        let extent = design.alignment.free.iter().map(|axis| {
            let [from, to] = jam.extent[axis.index()];
            ExtentReport { axis, from, to }
        });
        let drawn = found.expected.map_or(0, |counts| counts.iter().sum());
        Self {
            of_box: ShareReport::of(jam.count, found.motions()),
            of_jams: share_of(jam.count, found.jammed()),
            of_failures: share_of(jam.count, found.failed()),
            expected: jam.expected.map(|count| ShareReport::of(count, drawn)),
            pose: jam.pose,
            extent: extent.collect(),
            places: jam.places,
            height_d: jam.height,
            above_mated_d: jam.above,
            contacts: jam.contacts.iter().map(ContactReport::from).collect(),
            examined: jam.examined.as_ref().map(ExaminedReport::from),
            depth_on_grid_d: jam.depth_on_grid,
        }
    }
}

impl JamsReport {
    /// Of a design.
    pub fn new(design: &Design, found: &Jams, doubts: Vec<WarningReport>, timing: Option<Timing>) -> Self {
        let shares = |counts: [usize; 4]| -> Vec<(Outcome, ShareReport)> {
            let all = counts.iter().sum();
            Outcome::ALL.into_iter().zip(counts.map(|count| ShareReport::of(count, all))).collect()
        };
        let pair = |pair: &Touching| PairReport {
            count: pair.count,
            of_jams: share_of(pair.count, found.jammed()),
            of_failures: share_of(pair.count, found.failed()),
            fixed: (&pair.fixed).into(),
            moving: (&pair.moving).into(),
        };
        let body = JamsBody {
            design: design.clone(),
            settings: found.settings.clone(),
            motions: found.motions(),
            outcomes: shares(found.counts),
            expected: found.expected.map(shares),
            jams: found.jams.iter().map(|jam| JamReport::of(design, found, jam)).collect(),
            features: found.pairs.iter().map(pair).collect(),
        };
        let undecided = found.counts[3] + found.expected.map_or(0, |counts| counts[3]);
        let mut warnings = doubts;
        if undecided > 0 {
            let said = crate::acceptance::Warning::Undecided { cells: undecided };
            warnings.push(said.into());
        }
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
            line(&mut text, &format!("  and {} more, {} of the box together", grouped(more), percent(share)));
        }
        self.pair_lines(&mut text);
        for warning in &self.warnings {
            text.push('\n');
            wrapped(&mut text, "warning: ", &warning.message);
        }
        text
    }

    fn outcome_lines(&self, text: &mut String) {
        let head = if self.expected.is_some() { "of the errors expected" } else { "" };
        line(text, &format!("  {:<15}{:<30}{head}", "outcome", "of the error box"));
        for (k, (outcome, share)) in self.outcomes.iter().enumerate() {
            let expected = self.expected.as_ref().map_or_else(String::new, |of| with_interval(&of[k].1));
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
            .map_or_else(String::new, |share| format!(", {} of the errors expected", percent(share.share)));
        let share = format!(
            "{} of the box ({} … {}), {} of jams, {} of failures{expected}{places}",
            percent(jam.of_box.share),
            percent(jam.of_box.ci95[0]),
            percent(jam.of_box.ci95[1]),
            percent(jam.of_jams),
            percent(jam.of_failures)
        );
        wrapped(text, &format!("  {:<15}", format!("jam {number}")), &share);
        let told = self.told();
        said(
            text,
            "  rests",
            &format!("{}, {} above the mated pose", told.place(&jam.pose), told.length(jam.above_mated_d)),
        );
        let wide = told.extent(&jam.pose, &jam.extent);
        if !wide.is_empty() {
            said(text, "  anywhere in", &wide);
        }
        if let Some(examined) = &jam.examined {
            if let Some(held) = &examined.immobility {
                said(text, "  order", &held.words());
            }
            said(text, "  held", &told.held(examined));
            said(text, "  out", &self.out(examined));
        }
        if let Some(depth) = jam.depth_on_grid_d {
            said(text, "", &format!("{} deep by the merge tree of the grid", told.fine(depth)));
        }
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
            let shares = format!("  {:>8}{:>12}   ", percent(pair.of_jams), percent(pair.of_failures));
            wrapped(
                text,
                &shares,
                &format!("{} of the moving half on {} of the fixed one", pair.moving.name, pair.fixed.name),
            );
        }
        if self.features.len() > SHOWN {
            line(text, &format!("  and {} pairs more", self.features.len() - SHOWN));
        }
    }

    /// Jams and what touches in each as records for programs, the names of the columns first; D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "jam count share share_lo share_hi of_jams of_failures expected x y roll pitch yaw height above_mated order \
                    slope_lo slope_hi curvature firmness rise_at_most climb_at_most depth_on_grid leads_to fixed_kind fixed_name fixed_part fixed_x fixed_y fixed_z moving_kind \
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
            record.push(or_nothing(way.map(|way| way.climb_at_most_d)));
            record.push(or_nothing(jam.depth_on_grid_d));
            record.push(way.map_or("", |way| way.to.name()).to_owned());
            for contact in &jam.contacts {
                let feature = |feature: &FeatureReport| {
                    let part = feature.part.map_or_else(String::new, |part| part.to_string());
                    let named = [feature.kind.to_owned(), feature.name.clone(), part];
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

/// A share of 1 with one decimal.
fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn with_interval(share: &ShareReport) -> String {
    format!("{:>7}  ({} … {})", percent(share.share), percent(share.ci95[0]), percent(share.ci95[1]))
}

fn by_name<S: Serializer>(shares: &[(Outcome, ShareReport)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(shares.iter().map(|(outcome, share)| (outcome.name(), share)))
}

type OfErrors = Option<Vec<(Outcome, ShareReport)>>;

fn by_name_or_null<S: Serializer>(shares: &OfErrors, serializer: S) -> Result<S::Ok, S::Error> {
    match shares {
        Some(shares) => by_name(shares, serializer),
        None => serializer.serialize_none(),
    }
}

/// Jams and pairs of features that are told.
const SHOWN: usize = 6;
