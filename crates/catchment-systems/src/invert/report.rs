//! What is told of an inverse: JSON, a table, and the pair as a design file.

use super::{Heights, Inverse, REACHED, Settings, doubts};
use catchment::connector::Half;
use catchment::design::Design;
use catchment::method::zraa::HeightFacet;
use catchment::pose::{Dof, Mount};
use catchment::report::schema::WarningReport;
use catchment::report::text::{line, percent, row, significant, wrapped};
use catchment::report::{Body, Envelope, number};
use glam::{DVec2, DVec3};
use serde::Serialize;

/// Most convex pieces of a half that a design file takes.
pub const MAX_PIECES: usize = 256;
/// Shortfalls that are listed; more are counted.
const MOST_TOLD: usize = 20;

/// An inverse with its head.
pub type InvertReport = Envelope<InvertBody>;

/// What a part must have to be made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Limits {
    /// Least width of a facet, in D.
    pub feature_d: f64,
    /// Least angle between the surface and the direction of pull (z), in radians.
    pub draft_rad: f64,
}

/// The half that wanted heights ask for. Lengths in D.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    /// The deepest shortfalls.
    pub unattained: Vec<ShortfallReport>,
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

/// Corners of the convex pieces of the moving half as drawn.
fn pieces(design: &Design, found: &Inverse) -> Vec<Vec<DVec3>> {
    let mount: Mount = design.alignment.mount;
    let drawn = |corners: Vec<DVec3>| corners.into_iter().map(|p| mount.apply(p)).collect();
    found.moving.columns(found.back).into_iter().map(drawn).collect()
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
        unattained_area_d2: found.shortfalls.iter().map(|s| super::heights::area(&s.polygon)).sum(),
        unattained: found
            .shortfalls
            .iter()
            .take(MOST_TOLD)
            .map(|s| ShortfallReport {
                polygon: s.polygon.iter().map(DVec2::to_array).collect(),
                most: s.most,
                at: s.at.to_array(),
            })
            .collect(),
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
        if !self.settings.yaw.is_empty() {
            let turns: Vec<String> = self.settings.yaw.iter().map(|v| significant(v.to_degrees())).collect();
            wrapped(
                text,
                "  also at yaw    ",
                &format!("{}°; nothing is promised between", turns.join("°, ")),
            );
        }
        std::mem::take(text)
    }
}

/// The fixed half in convex pieces, and whether they are its own: else they are columns under its upper side.
fn fixed_pieces(fixed: &Half) -> (Vec<Vec<DVec3>>, bool) {
    if fixed.surfaces.iter().all(|surface| surface.convex) {
        return (fixed.surfaces.iter().map(|surface| surface.vertices.clone()).collect(), true);
    }
    let lowest = fixed.surfaces.iter().map(|s| s.bounds().0.z).fold(f64::INFINITY, f64::min);
    let upper = fixed.surfaces.iter().flat_map(|surface| {
        surface.facets.iter().filter(|f| f.normal.z > REACHED).map(|f| {
            let corners: Vec<DVec3> = f.corners.iter().map(|k| surface.vertices[*k as usize]).collect();
            let gradient = -f.normal.truncate() / f.normal.z;
            HeightFacet {
                offset: corners[0].z - gradient.dot(corners[0].truncate()),
                gradient,
                polygon: corners.iter().map(|c| c.truncate()).collect(),
            }
        })
    });
    (Heights { facets: upper.collect() }.columns(lowest), false)
}

/// The pair as a design file. Lengths in the unit of the design.
pub fn design_file(design: &Design, found: &Inverse) -> String {
    let alignment = &design.alignment;
    let mut text = String::new();
    let name = catchment::report::printable(&design.name).replace(['"', '\\'], "'");
    line(
        &mut text,
        "# The moving half was computed from the fixed one and wanted heights: catchment invert.",
    );
    let (fixed, own) = fixed_pieces(&found.connector.fixed);
    if !own {
        line(&mut text, "# The fixed half is solid below its upper side: undercuts are filled.");
    }
    line(&mut text, "schema = 1");
    line(&mut text, &format!("name = \"{name}, inverted\""));
    line(&mut text, "[connector]");
    line(&mut text, &format!("width = {}", number(design.width)));
    if let Some(unit) = design.unit {
        line(&mut text, &format!("unit = \"{}\"", unit.symbol()));
    }
    line(&mut text, "face_height = 0");
    for (side, pieces) in [("fixed", fixed), ("moving", pieces(design, found))] {
        line(&mut text, &format!("{side}.pieces = ["));
        for piece in pieces {
            let corners: Vec<String> = piece
                .iter()
                .map(|p| format!("[{}]", (*p * design.width).to_array().map(|v| number(v + 0.0)).join(", ")))
                .collect();
            line(&mut text, &format!("  [{}],", corners.join(", ")));
        }
        line(&mut text, "]");
    }
    let names = |dofs: catchment::pose::DofSet| -> String {
        let names: Vec<String> =
            Dof::ALL.into_iter().filter(|d| dofs.contains(*d)).map(|d| format!("\"{}\"", d.name())).collect();
        names.join(", ")
    };
    line(&mut text, "[alignment]");
    line(&mut text, &format!("free = [{}]", names(alignment.free)));
    line(&mut text, &format!("mount = \"{}\"", if alignment.mount == Mount::X { "x" } else { "y" }));
    line(&mut text, &format!("center_of_rotation = {}", number(alignment.center_of_rotation)));
    line(&mut text, &format!("rotation_length = {}", number(alignment.rotation_length)));
    line(&mut text, "[errors]");
    for dof in Dof::ALL.into_iter().filter(|dof| alignment.free.contains(*dof)) {
        line(&mut text, &format!("{} = {}", dof.name(), number(alignment.half_range(dof))));
    }
    text
}
