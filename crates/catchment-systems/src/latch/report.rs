//! The report of a latch: JSON, text, the record of a press.

use super::force::{Failure, Forces, Latching};
use super::measured::{THREE_SIDED_FAILURE, THREE_SIDED_LATCHING};
use super::press::{Dip, Position, Record};
use super::rules::{play, rules};
use super::{Geometry, LatchDesign, LatchRule, RuleCheck, stiffness};
use catchment::diagnostic::Diagnostic;
use catchment::document::{Cell, Column, Document, Table};
use catchment::report::document::Printed;
use catchment::report::{ReportBody, ReportEnvelope};
use serde::Serialize;
use std::borrow::Cow;

/// Results for a latch, with their head.
pub type LatchReport = ReportEnvelope<LatchBody>;

/// N·mm in a N·m.
const MILLI: f64 = 1e-3;

/// Results for a latch; mm, rad, N, `MPa` unless a unit is named.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LatchBody {
    /// The design as in the file, with defaults.
    pub design: LatchDesign,
    /// The outline in numbers.
    pub outline: OutlineReport,
    /// The rules for the design, and whether it fulfils them.
    pub rules: Vec<LatchRule>,
    /// Stiffness of a layer's neck, in N·m/rad.
    pub stiffness_nm_per_rad: f64,
    /// Stiffness of a neck that cannot narrow sideways: an upper bound.
    pub stiffness_plane_strain_nm_per_rad: f64,
    /// Largest strain in the neck as the hooks pass.
    pub neck_strain: f64,
    /// Free play in tension until the slit closes, in degrees.
    pub play_deg: f64,
    /// Force to latch.
    pub latching: Latching,
    /// Force to break.
    pub failure: Failure,
    /// Mean stress in the necks at which they break, in `MPa`.
    pub neck_strength_mpa: f64,
    /// Force to break divided by force to latch.
    pub bonding_ratio: f64,
    /// Bonding ratio with the force to latch plus and minus one standard error.
    pub bonding_ratio_interval: [f64; 2],
    /// Two halves pressed together, modelled as springs with friction.
    pub press: PressReport,
    /// Names of the files that were written.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
}

/// The outline in numbers; mm and degrees.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutlineReport {
    /// f(0), and the depth of the lowest point.
    pub height_mm: f64,
    /// Angle at the outer edge.
    pub start_deg: f64,
    /// Angle at the hook.
    pub end_deg: f64,
    /// The pivot.
    pub pivot_mm: [f64; 2],
    /// Vector from the pivot to the hook's corner, across and up.
    pub lever_mm: [f64; 2],
    /// Lower end of the slit.
    pub slit_end_mm: f64,
    /// Lower and upper side of the cut-out.
    pub cutout_mm: [f64; 2],
}

/// A press in numbers: springs and friction alone, which give less than measurements show.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PressReport {
    /// Largest force, in N.
    pub peak_n: f64,
    /// Largest force as a share of the force to latch, which is fitted to measurements.
    pub peak_share_of_latching: f64,
    /// Measured force to latch of a prototype with this overhang and neck, in N; null without a prototype.
    pub measured_latching_n: Option<f64>,
    /// Height of the largest force above the seat, in mm.
    pub peak_above_mm: f64,
    /// Height of first contact.
    pub first_contact_mm: f64,
    /// Drops of the force as hooks pass.
    pub dips: Vec<Dip>,
    /// Positions in order; the last is the deepest.
    #[serde(skip)]
    positions: Vec<Position>,
}

impl ReportBody for LatchBody {
    const KIND: &'static str = "latch";
}

/// The report of a latch whose geometry and press are known, without files.
pub fn report(latch: &LatchDesign, geometry: &Geometry, forces: &Forces, record: &Record) -> LatchReport {
    let (lever, profile) = (geometry.lever(), &geometry.profile);
    let (latching, failure) = (forces.latching(latch, geometry), forces.failure(latch));
    let [low, high] = latching.interval_n;
    let rules = rules(latch, geometry);
    let unmet = rules.iter().filter(|rule| rule.verdict == RuleCheck::Doubt);
    let mut warnings: Vec<String> =
        unmet.map(|rule| format!("not met: {} ({}); {}", rule.rule, rule.found, rule.reason)).collect();
    for (name, doubts) in [("force to latch", &latching.doubts), ("force to break", &failure.doubts)] {
        warnings.extend(doubts.iter().map(|doubt| format!("{name}: {doubt}")));
    }
    if latch.sides == 3 {
        warnings.push(format!(
                "three-sided: the drawing is of one face. Three need a narrower cut-out, turned to fit, which is not \
                 described; the one that was measured (o 5.1, t 3.0) latched at {THREE_SIDED_LATCHING} N and broke at \
                 {THREE_SIDED_FAILURE} N"
            ));
    }
    let swing =
        record.positions.iter().flat_map(|p| p.layers.iter().map(|hold| hold.swing)).fold(0.0, f64::max);
    let body = LatchBody {
        design: latch.clone(),
        outline: OutlineReport {
            height_mm: geometry.height(),
            start_deg: profile.start.to_degrees(),
            end_deg: profile.end.to_degrees(),
            pivot_mm: geometry.pivot.to_array(),
            lever_mm: lever.to_array(),
            slit_end_mm: geometry.slit_end,
            cutout_mm: geometry.cutout,
        },
        stiffness_nm_per_rad: MILLI * stiffness::torsional(latch),
        stiffness_plane_strain_nm_per_rad: MILLI * stiffness::plane_strain(latch),
        neck_strain: stiffness::bending_strain(latch, swing),
        play_deg: play(latch, geometry).to_degrees(),
        bonding_ratio: failure.force_n / latching.force_n,
        bonding_ratio_interval: [failure.force_n / high, failure.force_n / low],
        neck_strength_mpa: forces.neck_stress(),
        press: PressReport {
            peak_n: record.peak,
            peak_share_of_latching: record.peak / latching.force_n,
            measured_latching_n: forces.prototype(latch).map(|row| row.latching_force_n),
            peak_above_mm: record.peak_above,
            first_contact_mm: record.first_contact,
            dips: record.dips.clone(),
            positions: record.positions.clone(),
        },
        latching,
        failure,
        rules,
        files: Vec::new(),
    };
    let warnings = warnings.into_iter().map(|text| Diagnostic::warning(LatchBody::KIND, text)).collect();
    ReportEnvelope::of(body, warnings, None)
}

impl Printed for LatchBody {
    fn title(&self) -> Cow<'_, str> {
        Cow::Borrowed(&self.design.name)
    }

    fn document(&self) -> Document {
        let (d, o) = (&self.design, &self.outline);
        let mut document = Document::default();
        document
            .row(
                "part",
                format!(
                    "{} mm wide, overhang {}, neck {}, hook {}, sheet {} mm",
                    d.width, d.overhang, d.neck, d.hook, d.sheet
                ),
            )
            .row(
                "profile",
                format!(
                    "{:.1}° at the edge, {:.1}° at the hook, {:.2} mm high",
                    o.start_deg, o.end_deg, o.height_mm
                ),
            )
            .row(
                "pivot P",
                format!(
                    "x {:.2}, y {:.2} mm; hook {:.2} mm across, {:.2} mm up",
                    o.pivot_mm[0], o.pivot_mm[1], o.lever_mm[0], o.lever_mm[1]
                ),
            );
        self.describe_forces(&mut document);
        document
            .section("rules")
            .paragraph("Basis: D stated by the dissertation, I our reading.")
            .table(self.rule_table());
        if !self.files.is_empty() {
            document.section(None).row("files", self.files.join(", "));
        }
        document.table(self.press.table());
        document
    }
}

impl LatchBody {
    fn describe_forces(&self, document: &mut Document) {
        let (latching, failure) = (&self.latching, &self.failure);
        let bound = if failure.upper_bound { "at most " } else { "" };
        let [low, high] = latching.interval_n;
        document
            .section(None)
            .row(
                "stiffness k",
                format!(
                    "{:.4} N·m/rad per layer; a wide neck up to {:.3}",
                    self.stiffness_nm_per_rad, self.stiffness_plane_strain_nm_per_rad
                ),
            )
            .more("l_eq is not stated: its default of 6 mm was set from the stated 4.99 N·m/rad")
            .row(
                "to latch",
                format!(
                    "{:.1} N   ({low:.1} … {high:.1}: one standard error of a new design)",
                    latching.force_n
                ),
            )
            .more(format!(
                "the spring alone, friction {}: {:.2} N per layer, too little by the measurements",
                self.design.press.friction, latching.spring_n
            ))
            .row(
                "to break",
                format!(
                    "{bound}{:.0} N   mode: {}; necks tear at {:.1} MPa",
                    failure.force_n,
                    failure.mode.name(),
                    self.neck_strength_mpa
                ),
            );
        let [low, high] = self.bonding_ratio_interval;
        document.row("bonding ratio", format!("{bound}{:.1}   ({low:.1} … {high:.1})", self.bonding_ratio));
        self.describe_press(document);
        document.row(
            "neck",
            format!(
                "strain {:.2} % as hooks pass; play in tension {:.2}°",
                100.0 * self.neck_strain,
                self.play_deg
            ),
        );
    }

    fn describe_press(&self, document: &mut Document) {
        let press = &self.press;
        document.row(
            "pressed",
            format!(
                "springs and friction: first contact {:.2} mm above the seat, at most {:.2} N, {:.2} mm above it",
                press.first_contact_mm, press.peak_n, press.peak_above_mm
            ),
        );
        if press.peak_share_of_latching < 1.0 {
            let measured = press
                .measured_latching_n
                .map_or_else(String::new, |force| format!("; the prototype of these sizes took {force} N"));
            document.more(format!(
                "that is {:.2} of the {:.1} N to latch, which are fitted to measurements{measured}. Read the shape of \
                 this record, not its height",
                press.peak_share_of_latching, self.latching.force_n
            ));
        }
        for dip in &press.dips {
            document.more(format!(
                "layer {} snaps {:.2} mm beyond the seat: {:.2} → {:.2} N",
                dip.layer, -dip.above, dip.from, dip.to
            ));
        }
    }

    fn rule_table(&self) -> Table {
        let mut table = Table::new(["verdict", "basis", "rule"].map(|title| Column::new(title).left()));
        for LatchRule { verdict, basis, rule, found, reason, .. } in &self.rules {
            let verdict = match verdict {
                RuleCheck::Holds => "ok",
                RuleCheck::Doubt => "doubt",
                RuleCheck::Broken => "broken",
            };
            let rule = format!("{rule}: {found}, because {reason}");
            table.push([verdict.into(), basis.letter().into(), rule.into()]);
        }
        table
    }
}

impl PressReport {
    /// The press for programs.
    fn table(&self) -> Table {
        let layers = self.positions.first().map_or(0, |position| position.layers.len());
        let of_layers = (1..=layers)
            .flat_map(|k| ["contact", "swing_rad", "force_n"].map(|name| format!("layer_{k}_{name}")));
        let columns = ["above_mm", "force_n"].map(str::to_owned).into_iter().chain(of_layers);
        let mut table = Table::new(columns.map(Column::data));
        for position in &self.positions {
            let layers = position.layers.iter().flat_map(|hold| -> [Cell; 3] {
                [hold.contact.name().into(), hold.swing.into(), hold.force.into()]
            });
            table.push([position.above.into(), position.force.into()].into_iter().chain(layers));
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::super::press::record;
    use super::*;

    fn report(latch: &LatchDesign) -> LatchReport {
        let geometry = Geometry::of(latch).unwrap();
        let record = record(latch, &geometry).unwrap();
        super::report(latch, &geometry, &Forces::new().unwrap(), &record)
    }

    #[test]
    fn the_defaults_have_no_warning_and_fit_eighty_columns() {
        let report = report(&LatchDesign::default());
        let text = report.table();
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(
            text.contains("5.0006 N·m/rad") && text.contains("13.4 N") && !text.contains("doubt "),
            "{text}"
        );
        assert!(report.warnings.is_empty() && report.rules.len() >= 15);
        let json: serde_json::Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
        assert_eq!((&json["kind"], &json["failure"]["mode"]), (&"latch".into(), &"neck".into()));
        assert!((json["bonding_ratio"].as_f64().unwrap() - 640.88 / 13.353).abs() < 0.01);
    }

    /// The record of a press comes from springs and friction alone, and stays below the measured force: the
    /// report gives the ratio.
    #[test]
    fn a_record_below_the_measured_force_is_reported() {
        let usual = report(&LatchDesign::default());
        let press = &usual.press;
        assert_eq!(press.measured_latching_n, Some(16.36));
        assert!((press.peak_share_of_latching - press.peak_n / usual.latching.force_n).abs() < 1e-12);
        assert!(press.peak_share_of_latching < 0.6, "{press:?}");
        let words = usual.table().split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            words.contains("0.59 of the 13.4 N to latch, which are fitted to measurements; the prototype of these sizes took 16.36 N"),
            "{words}"
        );
        let other = report(&LatchDesign { overhang: 4.0, ..LatchDesign::default() });
        assert_eq!(other.press.measured_latching_n, None);
        assert!(other.table().contains("not its height") && !other.table().contains("prototype of"));
    }

    #[test]
    fn warnings_have_their_reasons() {
        let small = report(&LatchDesign { overhang: 1.27, ..LatchDesign::default() });
        let stated = small.warnings.iter().map(|w| w.message.clone()).collect::<Vec<_>>().join("\n");
        assert!(stated.contains("less than 1 mm") && stated.contains("upper bound"), "{stated}");
        assert!(small.table().contains("at most"));
        let three = report(&LatchDesign { sides: 3, base: 47.5, ..LatchDesign::default() });
        assert!(three.warnings.iter().any(|w| w.message.contains("9.61 N")));
    }
}
