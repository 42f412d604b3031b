//! What is told of an inverse: JSON, a table, and the pair as a design file.

use super::file::pieces;
use super::{Between, Inverse, REACHED, Settings, doubts, measure};
use catchment::design::Design;
use catchment::method::zraa::area;
use catchment::report::schema::WarningReport;
use catchment::report::text::{line, percent, row, significant, wrapped};
use catchment::report::{Body, Envelope};
use glam::{DVec2, DVec3};
use serde::Serialize;

/// Places of shortfalls that are listed.
const MOST_TOLD: usize = 20;

/// An inverse with its head.
pub type InvertReport = Envelope<InvertBody>;

/// What a part must have to be made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Limits {
    /// Least width of a facet, in D.
    pub feature_d: f64,
    /// Least angle between the surface and the direction of pull (z), in radians.
    pub draft_rad: f64,
}

/// The half that wanted heights ask for. Lengths in D.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InvertBody {
    /// Whose fixed half it is for.
    pub design: Design,
    /// What was asked.
    pub settings: Settings,
    /// What the part must have.
    pub limits: Limits,
    /// Convex pieces of the moving half, as drawn (facing +z, face centre at z = 0): their corners.
    pub pieces_d: Vec<Vec<[f64; 3]>>,
    /// Whether the wanted heights are reached wherever they are wanted.
    pub attained: bool,
    /// Largest h* − h.
    pub most_unattained_d: f64,
    /// Area of the offsets at which h* is not reached, in D².
    pub unattained_area_d2: f64,
    /// The deepest shortfalls, one of every place.
    pub unattained: Vec<ShortfallReport>,
    /// Rotations beside none at which the heights were wanted.
    pub turns: usize,
    /// What holds between them.
    pub between: Option<Between>,
    /// Wanted and reached height without error.
    pub mated_height_d: [Option<f64>; 2],
    /// Area on which the halves touch without error, in D².
    pub contact_patch_d2: f64,
    /// Area of the plan of the moving half, in D².
    pub plan_d2: f64,
    /// Least angle between the new surface and the direction of pull, in radians.
    pub draft_rad: f64,
    /// Least width of a facet of the new surface.
    pub narrowest_d: f64,
}

/// One polygon of offsets at which the wanted height is not reached, in D.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ShortfallReport {
    /// Corners of the offsets.
    pub polygon: Vec<[f64; 2]>,
    /// Largest h* − h over it.
    pub most: f64,
    /// Where.
    pub at: [f64; 2],
}

impl Body for InvertBody {
    const KIND: &'static str = "invert";
}

/// What is told of an inverse.
pub fn report(design: &Design, found: &Inverse, limits: Limits) -> InvertReport {
    let at_zero = DVec2::ZERO;
    let body = InvertBody {
        design: design.clone(),
        settings: found.settings.clone(),
        limits,
        pieces_d: pieces(design, found).iter().map(|p| p.iter().map(DVec3::to_array).collect()).collect(),
        attained: found.shortfalls.is_empty(),
        most_unattained_d: found.shortfalls.first().map_or(0.0, |s| s.most),
        unattained_area_d2: found.shortfalls.iter().map(|s| area(&s.polygon)).sum(),
        unattained: measure::places(&found.shortfalls, MOST_TOLD)
            .into_iter()
            .map(|s| ShortfallReport {
                polygon: s.polygon.iter().map(DVec2::to_array).collect(),
                most: s.most,
                at: s.at.to_array(),
            })
            .collect(),
        turns: found.turns,
        between: found.between,
        mated_height_d: [found.wanted.at(at_zero), found.reached.at(at_zero)],
        contact_patch_d2: found.patch,
        plan_d2: found.plan,
        draft_rad: (1.0 / found.steepest).atan(),
        narrowest_d: found.narrowest,
    };
    let mut warnings: Vec<WarningReport> = doubts(design, found).iter().map(WarningReport::note).collect();
    if body.narrowest_d < limits.feature_d {
        let message = format!(
            "a facet of the new half is only {} D wide, less than the {} D that can be made",
            significant(body.narrowest_d),
            significant(limits.feature_d)
        );
        warnings.push(WarningReport::note(&message));
    }
    if body.draft_rad < limits.draft_rad {
        let [draft, least] = [body.draft_rad, limits.draft_rad].map(|angle| significant(angle.to_degrees()));
        let message =
            format!("the draft is only {draft}°, less than {least}°: the half may stick in its mould");
        warnings.push(WarningReport::note(&message));
    }
    Envelope::of(body, warnings, None)
}

impl InvertBody {
    /// The inverse for a person.
    pub fn table(&self) -> String {
        let text = &mut String::new();
        line(text, &format!("{}: the moving half that the wanted heights ask for", self.design.name));
        row(
            text,
            "moving half",
            &format!("{} convex pieces over {} D²", self.pieces_d.len(), significant(self.plan_d2)),
        );
        if self.attained {
            row(text, "heights", &format!("reached everywhere, to {REACHED:e} D"));
        } else {
            let most = significant(self.most_unattained_d);
            let area = significant(self.unattained_area_d2);
            row(text, "unattained", &format!("up to {most} D lower, over {area} D² of offsets"));
            for short in self.unattained.iter().take(3) {
                let [x, y] = short.at.map(significant);
                row(text, "", &format!("{} D at x {x}, y {y}", significant(short.most)));
            }
        }
        if let [Some(wanted), Some(reached)] = self.mated_height_d {
            let [wanted, reached] =
                [wanted, reached].map(|v| significant(if v.abs() < REACHED { 0.0 } else { v }));
            row(text, "without error", &format!("height {reached} D, wanted {wanted} D"));
        }
        let share = percent(self.contact_patch_d2 / self.plan_d2);
        row(text, "contact", &format!("{} D², {share} of the plan", significant(self.contact_patch_d2)));
        row(text, "draft", &format!("{}° at least", significant(self.draft_rad.to_degrees())));
        row(text, "least width", &format!("{} D, of a facet", significant(self.narrowest_d)));
        if self.turns > 0 {
            self.tell_turns(text);
        }
        std::mem::take(text)
    }
    fn tell_turns(&self, text: &mut String) {
        let Settings { roll, pitch, yaw, .. } = &self.settings;
        let axes = [("roll", roll), ("pitch", pitch), ("yaw", yaw)];
        let told: Vec<String> = axes
            .into_iter()
            .filter(|(_, angles)| !angles.is_empty())
            .map(|(name, angles)| format!("{name} {}", listed(angles)))
            .collect();
        let also = format!("{}: {} rotations", told.join("; "), self.turns);
        wrapped(text, "  also at        ", &also);
        let Some(between) = self.between else { return };
        let bound = significant(between.bound_d);
        wrapped(
            text,
            "  between        ",
            &format!("at most {bound} D higher than wanted at some place within {bound} D"),
        );
        if let Some(most) = between.most_d.filter(|most| *most > REACHED) {
            let [roll, pitch, yaw] = between.angles_rad.map(|angle| significant(angle.to_degrees()));
            let near_zero = |v: f64| if v.abs() < REACHED { 0.0 } else { v };
            let [x, y] = between.at_d.map(|v| significant(near_zero(v)));
            let at = format!("x {x}, y {y}, roll {roll}°, pitch {pitch}°, yaw {yaw}°");
            wrapped(
                text,
                "                 ",
                &format!("{} D higher than wanted midway, at {at}", significant(most)),
            );
        } else {
            row(text, "", &format!("nowhere higher than wanted at {} rotations midway", between.midway));
        }
    }
}

/// Angles in degrees: all of a few, the ends and the number of many.
fn listed(angles: &[f64]) -> String {
    /// Most angles that are told one by one.
    const FEW: usize = 6;
    let degrees = |angle: f64| format!("{}°", significant(angle.to_degrees()));
    if angles.len() <= FEW {
        return angles.iter().map(|angle| degrees(*angle)).collect::<Vec<_>>().join(", ");
    }
    let [low, high] = [
        angles.iter().copied().fold(f64::INFINITY, f64::min),
        angles.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    format!("{} angles from {} to {}", angles.len(), degrees(low), degrees(high))
}
