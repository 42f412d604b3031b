//! Friction: as versioned JSON, as text, as records for programs.

use super::envelope::{Body, Envelope};
use super::jams::{FeatureReport, ShareReport, more_pairs};
use super::schema::{Timing, WarningReport};
use super::table::heading;
use super::text::{grouped, line, number, row, tenths, wrapped};
use catchment_core::acceptance::{Outcome, Warning};
use catchment_core::design::Design;
use catchment_core::run::jams::Sticks;
use catchment_study::friction::{Friction, Kept, Rung, Settings};
use serde::{Serialize, Serializer};

/// What friction does to a design, with its head.
pub type FrictionReport = Envelope<FrictionBody>;

/// What friction does to a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrictionBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// How it was asked for.
    pub settings: Settings,
    /// Random poses of the error box, the same at every friction.
    pub motions: usize,
    /// What becomes of them, none first.
    pub curve: Vec<RungReport>,
    /// Up to which friction what docks without it docks still, by how much of it: `p95` is 95 %.
    #[serde(serialize_with = "by_share")]
    pub kept: Vec<KeptReport>,
    /// What sticks where the first poses are lost.
    pub sticks_first: SticksReport,
    /// Poses that are lost at some friction and dock again at a larger one.
    pub come_back: usize,
}

/// What becomes of the poses at one friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RungReport {
    /// The coefficient of friction.
    pub friction: f64,
    /// Poses that dock.
    pub aligned: ShareReport,
    /// Poses that jam.
    pub jammed: ShareReport,
    /// Poses that miss.
    pub missed: ShareReport,
    /// Poses of which it is not known.
    pub undecided: ShareReport,
    /// Poses that dock without friction and not at this.
    pub lost: usize,
    /// Poses that dock at this friction and not without.
    pub gained: usize,
    /// Poses that dock, and by Coulomb's law might have stuck on the way.
    pub may_stick: usize,
    /// Of the lost those that dock with a tenth less friction: halves that give a little may dock as well.
    pub hardly_held: usize,
    /// Poses that jam and wedge there: some force would hold them against a pull straight out as well.
    pub wedged: usize,
    /// Poses that dock by the static test along the frictionless way.
    pub static_docks: usize,
    /// Poses of which that test says the wrong thing.
    pub static_wrong: usize,
}

/// Up to which friction a share of what docks without it docks still.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct KeptReport {
    /// The share.
    pub share: f64,
    /// Up to this friction.
    pub friction: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// It is the largest friction that was tried, and perhaps more.
    pub is_top: bool,
}

/// What sticks first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SticksReport {
    /// How many poses were looked at: those that are lost first and stick.
    pub poses: usize,
    /// The pairs of features that touch there, the one that does so most often first.
    pub features: Vec<StickingReport>,
}

/// Two features that touch where poses stick.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StickingReport {
    /// In how many of the poses.
    pub count: usize,
    /// Their share.
    pub share: f64,
    /// The least of the frictions at which these poses are lost.
    pub critical_least: f64,
    /// The middle one of them.
    pub critical_median: f64,
    /// The feature of the fixed half.
    pub fixed: FeatureReport,
    /// The feature of the moving half.
    pub moving: FeatureReport,
}

impl Body for FrictionBody {
    const KIND: &'static str = "friction";
}

impl RungReport {
    fn of(rung: &Rung) -> Self {
        let tally = rung.tally;
        let all = tally.counts.iter().sum();
        let [aligned, jammed, missed, undecided] = tally.counts.map(|count| ShareReport::of(count, all));
        Self {
            friction: rung.friction,
            aligned,
            jammed,
            missed,
            undecided,
            lost: tally.lost,
            gained: tally.gained,
            may_stick: tally.may_stick,
            hardly_held: tally.hardly_held,
            wedged: tally.wedged,
            static_docks: tally.static_docks,
            static_wrong: tally.static_wrong,
        }
    }
}

impl From<&Kept> for KeptReport {
    fn from(kept: &Kept) -> Self {
        let Kept { share, friction, ci95, is_top } = *kept;
        Self { share, friction, ci95, is_top }
    }
}

impl FrictionReport {
    /// Of a design.
    pub fn new(
        design: &Design,
        found: &Friction,
        doubts: Vec<WarningReport>,
        timing: Option<Timing>,
    ) -> Self {
        let (poses, features) = &found.first;
        let sticking = |Sticks { touching, critical }: &Sticks| StickingReport {
            count: touching.count,
            share: touching.count as f64 / (*poses).max(1) as f64,
            critical_least: critical.first().copied().unwrap_or_default(),
            critical_median: critical.get(critical.len() / 2).copied().unwrap_or_default(),
            fixed: (&touching.fixed).into(),
            moving: (&touching.moving).into(),
        };
        let body = FrictionBody {
            design: design.clone(),
            settings: found.settings.clone(),
            motions: found.motions(),
            curve: found.rungs.iter().map(RungReport::of).collect(),
            kept: found.kept.iter().map(KeptReport::from).collect(),
            sticks_first: SticksReport { poses: *poses, features: features.iter().map(sticking).collect() },
            come_back: found.come_back,
        };
        let undecided = Outcome::ALL.iter().position(|outcome| *outcome == Outcome::Undecided);
        let undecided: usize =
            undecided.map_or(0, |k| found.rungs.iter().map(|rung| rung.tally.counts[k]).sum());
        let mut warnings = doubts;
        if undecided > 0 {
            warnings.push(Warning::Undecided { cells: undecided }.into());
        }
        // Right beside the border any friction tells: worth a word is what is more than chance among the poses.
        let hardly = found.rungs.iter().filter(|rung| {
            let [lo, hi] = RungReport::of(rung).aligned.ci95;
            rung.tally.hardly_held as f64 > 0.5 * (hi - lo) * found.motions() as f64
        });
        if let Some(Rung { friction, tally }) = hardly.max_by_key(|rung| rung.tally.hardly_held) {
            let count = tally.hardly_held;
            let text = format!(
                "{} poses are lost at a friction of {friction} and dock with a tenth less of it: rigid halves stick there, and halves that give, as real ones \
                 and those of engines do, may let go",
                grouped(count),
            );
            warnings.push(Warning::Note { text }.into());
        }
        if let Some(friction) = found.wedges_from() {
            let text = format!(
                "from a friction of {friction} on some poses wedge: the halves press against each other, and rigid ones may stay even against a pull straight \
                 out; halves that give a little, as real ones and those of engines do, may come loose there"
            );
            warnings.push(Warning::Note { text }.into());
        }
        Self::of(body, warnings, timing)
    }

    /// The report as text of 80 columns; ends with a line break.
    pub fn table(&self) -> String {
        let mut text = String::new();
        heading(&mut text, &self.design);
        let motions = format!("descent, {} random poses at every friction", grouped(self.motions));
        row(&mut text, "method", &motions);
        text.push('\n');
        line(
            &mut text,
            &format!(
                "  {:<9}{:<23}{:>6}{:>7}{:>11}{:>8}{:>8}{:>6}",
                "friction", "docks", "lost", "gained", "may stick", "hardly", "static", "wrong"
            ),
        );
        for rung in &self.curve {
            let [lo, hi] = rung.aligned.ci95.map(|share| format!("{:.1}", 100.0 * share));
            let docks = format!("{} ({lo} … {hi})", tenths(rung.aligned.share));
            let against = if rung.friction == 0.0 {
                String::new()
            } else {
                let share = tenths(rung.static_docks as f64 / self.motions.max(1) as f64);
                let RungReport { lost, gained, may_stick, hardly_held, static_wrong, .. } = rung;
                format!("{lost:>6}{gained:>7}{may_stick:>11}{hardly_held:>8}{share:>8}{static_wrong:>6}")
            };
            line(&mut text, &format!("  {:<9}{docks:<23}{against}", rung.friction));
        }
        text.push('\n');
        self.kept_lines(&mut text);
        self.sticking_lines(&mut text);
        if self.come_back > 0 {
            text.push('\n');
            let said =
                format!("{} are lost at some friction and dock again at a larger one", poses(self.come_back));
            wrapped(&mut text, "  note           ", &said);
        }
        self.append_warnings(&mut text);
        text
    }

    /// The largest friction that was tried.
    fn top(&self) -> f64 {
        self.curve.last().map_or(0.0, |rung| rung.friction)
    }

    /// A friction up to which something docks, in words: `beyond 0.5` where that is all of them.
    pub(super) fn up_to(&self, friction: f64) -> String {
        let top = self.top();
        if friction >= top { format!("beyond {top}") } else { format!("{friction:.3}") }
    }

    fn kept_lines(&self, text: &mut String) {
        if self.curve.first().is_none_or(|rung| rung.aligned.count == 0) {
            line(text, "  nothing docks without friction: there is nothing that friction could take");
            return;
        }
        line(text, "  of what docks without friction");
        for kept in &self.kept {
            let friction = if kept.is_top {
                format!("beyond {}, the largest that was tried", self.top())
            } else {
                let [lo, hi] = kept.ci95.map(|friction| self.up_to(friction));
                format!("up to a friction of {:.3}  ({lo} … {hi})", kept.friction)
            };
            let share = format!("{:.0} % docks", 100.0 * kept.share);
            line(text, &format!("  {share:<15}{friction}"));
        }
    }

    fn sticking_lines(&self, text: &mut String) {
        let SticksReport { poses: count, features } = &self.sticks_first;
        if features.is_empty() {
            return;
        }
        text.push('\n');
        line(text, &format!("  what sticks where the first are lost ({})", poses(*count)));
        for pair in features.iter().take(SHOWN) {
            let [least, median] = [pair.critical_least, pair.critical_median].map(|mu| format!("{mu:.3}"));
            wrapped(
                text,
                &format!("  {:>8}   ", tenths(pair.share)),
                &format!("{}: from a friction of {least} on, half of them by {median}", pair.words()),
            );
        }
        if features.len() > SHOWN {
            line(text, &more_pairs(features.len() - SHOWN));
        }
    }

    /// The curve as records for programs, the names of the columns first.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = "friction motions aligned aligned_lo aligned_hi jammed missed undecided lost gained may_stick hardly_held wedged static_docks static_wrong";
        let mut records = vec![head.split(' ').map(str::to_owned).collect::<Vec<_>>()];
        records.extend(self.curve.iter().map(|rung| {
            let [lo, hi] = rung.aligned.ci95;
            let mut record = vec![number(rung.friction), self.motions.to_string()];
            record.extend([rung.aligned.share, lo, hi, rung.jammed.share, rung.missed.share].map(number));
            record.push(number(rung.undecided.share));
            let RungReport {
                lost, gained, may_stick, hardly_held, wedged, static_docks, static_wrong, ..
            } = *rung;
            let counts = [lost, gained, may_stick, hardly_held, wedged, static_docks, static_wrong];
            record.extend(counts.map(|count| count.to_string()));
            record
        }));
        records
    }
}

impl StickingReport {
    /// What touches what, in words.
    pub fn words(&self) -> String {
        format!("{} of the moving half on {} of the fixed one", self.moving.name, self.fixed.name)
    }
}

impl KeptReport {
    /// `p95`.
    fn name(&self) -> String {
        format!("p{:.0}", 100.0 * self.share)
    }
}

fn by_share<S: Serializer>(kept: &[KeptReport], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(kept.iter().map(|kept| (kept.name(), kept)))
}

fn poses(count: usize) -> String {
    if count == 1 { "1 pose".to_owned() } else { format!("{} poses", grouped(count)) }
}

/// Pairs of features that are told.
const SHOWN: usize = 6;
