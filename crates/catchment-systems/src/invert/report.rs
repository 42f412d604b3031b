//! The report of an inverse: JSON and text.

use super::file::pieces;
use super::{Between, Inverse, InvertSettings, REACHED, Shortfall, measure, warnings};
use catchment::design::Design;
use catchment::diagnostic::Diagnostic;
use catchment::document::{Document, Subject, percent, significant};
use catchment::method::zraa::area;
use catchment::report::ReportOf;
use glam::{DVec2, DVec3};
use serde::Serialize;

/// Places of shortfalls that are listed in JSON.
const MOST_LISTED: usize = 20;
/// Places of shortfalls that are shown to people.
const SHOWN: usize = 3;

/// An inverse with its head.
pub type InvertReport = ReportOf<InvertBody>;

/// Manufacturing limits of a part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ManufacturingLimits {
    /// Smallest width of a facet, in D.
    pub feature_d: f64,
    /// Smallest angle between the surface and the direction of pull (z), in radians.
    pub draft_rad: f64,
}

/// The moving half that realises wanted heights on the fixed half of a design. Lengths in D.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InvertBody {
    /// The settings.
    pub settings: InvertSettings,
    /// Manufacturing limits of the part.
    pub limits: ManufacturingLimits,
    /// Convex pieces of the moving half, as drawn (facing +z, face centre at z = 0): their corners.
    pub pieces_d: Vec<Vec<[f64; 3]>>,
    /// Whether every wanted height is reached.
    pub attained: bool,
    /// Largest h* − h.
    pub most_unattained_d: f64,
    /// Area of the offsets at which h* is not reached, in D².
    pub unattained_area_d2: f64,
    /// The largest shortfall of every place, deepest first.
    pub unattained: Vec<Shortfall>,
    /// Number of rotations besides 0 at which heights were wanted.
    pub turns: usize,
    /// Bounds between these rotations.
    pub between: Option<Between>,
    /// Wanted and reached height at zero error.
    pub mated_height_d: [Option<f64>; 2],
    /// Area of contact between the halves at zero error, in D².
    pub contact_patch_d2: f64,
    /// Area of the plan of the moving half, in D².
    pub plan_d2: f64,
    /// Smallest angle between the new surface and the direction of pull, in radians.
    pub draft_rad: f64,
    /// Smallest width of a facet of the new surface.
    pub narrowest_d: f64,
}

/// The report of an inverse.
pub fn report(design: &Design, found: &Inverse, limits: ManufacturingLimits) -> InvertReport {
    let at_zero = DVec2::ZERO;
    let body = InvertBody {
        settings: found.settings.clone(),
        limits,
        pieces_d: pieces(design, found).iter().map(|p| p.iter().map(DVec3::to_array).collect()).collect(),
        attained: found.shortfalls.is_empty(),
        most_unattained_d: found.shortfalls.first().map_or(0.0, |s| s.most),
        unattained_area_d2: found.shortfalls.iter().map(|s| area(&s.polygon)).sum(),
        unattained: measure::places(&found.shortfalls, MOST_LISTED),
        turns: found.turns,
        between: found.between,
        mated_height_d: [found.wanted.at(at_zero), found.reached.at(at_zero)],
        contact_patch_d2: found.patch,
        plan_d2: found.plan,
        draft_rad: (1.0 / found.steepest).atan(),
        narrowest_d: found.narrowest,
    };
    ReportOf::new(design, body, warnings(design, found), None)
}

impl Subject for InvertBody {
    const KIND: &'static str = "invert";

    fn warnings(&self) -> Vec<Diagnostic> {
        let mut warnings = Vec::new();
        let limits = &self.limits;
        if self.narrowest_d < limits.feature_d {
            let [width, least] = [self.narrowest_d, limits.feature_d].map(significant);
            let text = format!(
                "a facet of the new half is only {width} D wide, less than the {least} D that can be made"
            );
            warnings.push(Diagnostic::warning(Self::KIND, text));
        }
        if self.draft_rad < limits.draft_rad {
            let [draft, least] = [self.draft_rad, limits.draft_rad].map(degrees);
            let text =
                format!("the draft is only {draft}, less than {least}: the half may stick in its mould");
            warnings.push(Diagnostic::warning(Self::KIND, text));
        }
        warnings
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        let pieces = self.pieces_d.len();
        document
            .section("moving half for the wanted heights")
            .row("moving half", format!("{pieces} convex pieces over {} D²", significant(self.plan_d2)));
        self.describe_heights(&mut document);
        let share = percent(self.contact_patch_d2 / self.plan_d2);
        document
            .row("contact", format!("{} D², {share} of the plan", significant(self.contact_patch_d2)))
            .row("draft", format!("{} at least", degrees(self.draft_rad)))
            .row("least width", format!("{} D, of a facet", significant(self.narrowest_d)));
        if self.turns > 0 {
            self.describe_turns(&mut document);
        }
        document
    }
}

impl InvertBody {
    fn describe_heights(&self, document: &mut Document) {
        if self.attained {
            document.row("heights", format!("reached everywhere, to {REACHED:e} D"));
        } else {
            let [most, area] = [self.most_unattained_d, self.unattained_area_d2].map(significant);
            document.row("unattained", format!("up to {most} D lower, over {area} D² of offsets"));
            for short in self.unattained.iter().take(SHOWN) {
                let [x, y] = short.at.to_array().map(significant);
                document.more(format!("{} D at x {x}, y {y}", significant(short.most)));
            }
        }
        if let [Some(wanted), Some(reached)] = self.mated_height_d {
            let [wanted, reached] = [wanted, reached].map(|height| significant(near_zero(height)));
            document.row("without error", format!("height {reached} D, wanted {wanted} D"));
        }
    }

    fn describe_turns(&self, document: &mut Document) {
        let InvertSettings { roll, pitch, yaw, .. } = &self.settings;
        let axes = [("roll", roll), ("pitch", pitch), ("yaw", yaw)];
        let wanted: Vec<String> = axes
            .into_iter()
            .filter(|(_, angles)| !angles.is_empty())
            .map(|(name, angles)| format!("{name} {}", listed(angles)))
            .collect();
        document.row("also at", format!("{}: {} rotations", wanted.join("; "), self.turns));
        let Some(between) = self.between else { return };
        let bound = significant(between.bound_d);
        document
            .row("between", format!("at most {bound} D higher than wanted at some place within {bound} D"));
        if let Some(most) = between.most_d.filter(|most| *most > REACHED) {
            let [roll, pitch, yaw] = between.angles_rad.map(degrees);
            let [x, y] = between.at_d.map(|v| significant(near_zero(v)));
            let most = significant(most);
            document.more(format!(
                "{most} D higher than wanted midway, at x {x}, y {y}, roll {roll}, pitch {pitch}, yaw {yaw}"
            ));
        } else {
            document.more(format!("nowhere higher than wanted at {} rotations midway", between.midway));
        }
    }
}

/// A number in D, with rounding errors set to zero.
fn near_zero(value: f64) -> f64 {
    if value.abs() < REACHED { 0.0 } else { value }
}

fn degrees(angle: f64) -> String {
    format!("{}°", significant(angle.to_degrees()))
}

/// Angles in degrees: all of a few, the ends and the number of many.
fn listed(angles: &[f64]) -> String {
    /// Largest number of angles that are listed singly.
    const FEW: usize = 6;
    if angles.len() <= FEW {
        return angles.iter().map(|angle| degrees(*angle)).collect::<Vec<_>>().join(", ");
    }
    let [low, high] = [
        angles.iter().copied().fold(f64::INFINITY, f64::min),
        angles.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    format!("{} angles from {} to {}", angles.len(), degrees(low), degrees(high))
}
