//! Text and table form of the effect of friction.

use super::{FirstSticking, Friction, FrictionLevel, RetainedShare};
use catchment_core::design::Design;
use catchment_core::diagnostic::{Diagnostic, Warning};
use catchment_core::document::{Cell, Column, ColumnFormat, Document, Subject, Table, grouped, tenths};
use catchment_core::run::jams::contact_in_words;
use serde::Serializer;

/// Fewer docking poses than this cannot resolve a share of 99 %.
const FEW: usize = 100;
/// Pairs of features that are shown.
const SHOWN: usize = 6;

impl Subject for Friction {
    const KIND: &'static str = "friction";

    fn warnings(&self) -> Vec<Diagnostic> {
        let note = |text: String| Diagnostic::warning(Self::KIND, text);
        let undecided: usize = self.curve.iter().map(|rung| rung.undecided.count).sum();
        let mut warnings: Vec<Diagnostic> = Vec::new();
        if undecided > 0 {
            warnings.push(Warning::Undecided { cells: undecided }.into());
        }
        // Some poses always dock only just; the share is reported if it exceeds the confidence interval.
        let hardly = self.curve.iter().filter(|rung| {
            let [lo, hi] = rung.aligned.ci95;
            rung.barely_stuck as f64 > 0.5 * (hi - lo) * self.motions as f64
        });
        if let Some(FrictionLevel { friction, barely_stuck, .. }) =
            hardly.max_by_key(|rung| rung.barely_stuck)
        {
            warnings.push(note(format!(
                "{} poses are lost at μ = {friction} and dock at 0.9 of it: rigid halves stick there; compliant halves, as real ones and those of physics \
                 engines, may slip",
                grouped(*barely_stuck),
            )));
        }
        if let Some(friction) = self.wedges_from() {
            warnings.push(note(format!(
                "from μ = {friction} on some poses wedge: the halves press against each other, and rigid halves may stay even against a pull straight \
                 out; compliant halves, as real ones and those of physics engines, may come loose"
            )));
        }
        warnings
    }

    fn setup(&self, _: &Design, document: &mut Document) {
        document.row(
            "method",
            format!(
                "exact quasi-static motion of the same {} random poses at every μ",
                grouped(self.motions)
            ),
        );
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        document.section(None).table(self.table());
        document.paragraph(format!(
            "μ: friction coefficient; docks: share of the error box; other columns: poses of {}. lost: dock without friction, not at this μ; gained: the other way \
             round; may stick: counted as docked, but Coulomb's law also allows them to stick; barely stuck: lost, but dock at 0.9 μ.",
            grouped(self.motions)
        ));
        self.describe_kept(&mut document);
        self.describe_sticking(&mut document);
        if self.come_back > 0 {
            let poses = poses(self.come_back);
            document
                .section(None)
                .row("note", format!("{poses} are lost at some μ and dock again at a larger μ"));
        }
        document
    }
}

impl Friction {
    fn table(&self) -> Table {
        let mut table = Table::new([
            Column::new("μ").key("friction"),
            Column::data("motions"),
            Column::new("docks (95 % CI)").interval("aligned").format(ColumnFormat::Tenths),
            Column::data("jammed"),
            Column::data("missed"),
            Column::data("undecided"),
            Column::new("lost").key("lost"),
            Column::new("gained").key("gained"),
            Column::new("may stick").key("may_stick"),
            Column::new("barely stuck").key("barely_stuck"),
            Column::data("wedged"),
            Column::data("static_docks"),
            Column::data("static_wrong"),
        ]);
        for rung in &self.curve {
            // Without friction there is nothing to compare with.
            let against =
                |count: usize| if rung.friction > 0.0 { count.into() } else { Cell::shown("", count) };
            table.push([
                rung.friction.into(),
                self.motions.into(),
                rung.aligned.into(),
                rung.jammed.share.into(),
                rung.missed.share.into(),
                rung.undecided.share.into(),
                against(rung.lost),
                against(rung.gained),
                against(rung.may_stick),
                against(rung.barely_stuck),
                rung.wedged.into(),
                rung.static_docks.into(),
                rung.static_wrong.into(),
            ]);
        }
        table
    }

    fn describe_kept(&self, document: &mut Document) {
        if self.curve.first().is_none_or(|rung| rung.aligned.count == 0) {
            document
                .section(None)
                .paragraph("No pose docks without friction, so friction cannot prevent docking.");
            return;
        }
        let base = self.curve.first().map_or(0, |rung| rung.aligned.count);
        document.titled(Some(format!(
            "largest μ at which this share of the {} docking at μ = 0 still docks",
            poses(base)
        )));
        for kept in &self.kept {
            let friction = if kept.is_top {
                format!("above {}, the largest μ tried", self.top())
            } else {
                let [lo, hi] = kept.ci95.map(|friction| self.up_to(friction));
                format!("{:.3} (95 % CI {lo} … {hi})", kept.friction)
            };
            document.row(format!("{:.0} %", 100.0 * kept.share), friction);
        }
        if base < FEW {
            document.paragraph(format!(
                "{} are few: shares change in steps of {:.0} %, so 99 % means all of them. A larger sample gives finer shares.",
                poses(base),
                100.0 / base as f64
            ));
        }
    }

    fn describe_sticking(&self, document: &mut Document) {
        let FirstSticking { poses: count, features } = &self.sticks_first;
        if features.is_empty() {
            return;
        }
        document.titled(Some(format!(
            "contacts of the first {} lost as μ rises (several per pose)",
            poses(*count)
        )));
        for pair in features.iter().take(SHOWN) {
            let [least, median] = [pair.critical_least, pair.critical_median].map(|mu| format!("{mu:.3}"));
            document.row(
                tenths(pair.share),
                format!(
                    "{}: lost from μ = {least} on, median {median}",
                    contact_in_words(&pair.fixed, &pair.moving)
                ),
            );
        }
        if features.len() > SHOWN {
            document.more(format!("and {} more pairs of features", features.len() - SHOWN));
        }
    }

    /// The largest friction that was tried.
    fn top(&self) -> f64 {
        self.curve.last().map_or(0.0, |rung| rung.friction)
    }

    /// A friction coefficient up to which poses dock, in words: `beyond 0.5` for the largest given
    /// coefficient.
    pub fn up_to(&self, friction: f64) -> String {
        let top = self.top();
        if friction >= top { format!("beyond {top}") } else { format!("{friction:.3}") }
    }
}

/// The shares as the fields of an object: `p95`.
pub(super) fn by_share<S: Serializer>(kept: &[RetainedShare], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(kept.iter().map(|kept| (named(kept.share), kept)))
}

/// The JSON schema of that.
#[cfg(feature = "schema")]
pub(super) fn kept_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let kept = generator.subschema_for::<RetainedShare>();
    let properties: serde_json::Map<String, serde_json::Value> =
        super::SHARES.iter().map(|share| (named(*share), kept.clone().to_value())).collect();
    schemars::json_schema!({ "type": "object", "properties": properties })
}

/// `p95`.
fn named(share: f64) -> String {
    format!("p{:.0}", 100.0 * share)
}

fn poses(count: usize) -> String {
    if count == 1 { "1 pose".to_owned() } else { format!("{} poses", grouped(count)) }
}
