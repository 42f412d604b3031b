//! The pair as a design file.

use super::{Heights, Inverse, REACHED};
use catchment::connector::Half;
use catchment::design::Design;
use catchment::document::number;
use catchment::method::zraa::HeightFacet;
use catchment::pose::{Dof, Mount};
use catchment::report::text::line;
use glam::DVec3;

/// Most convex pieces of a half that a design file takes.
pub const MAX_PIECES: usize = 256;

/// Corners of the convex pieces of the moving half as drawn.
pub(super) fn pieces(design: &Design, found: &Inverse) -> Vec<Vec<DVec3>> {
    let mount: Mount = design.alignment.mount;
    let drawn = |corners: Vec<DVec3>| corners.into_iter().map(|p| mount.apply(p)).collect();
    found.moving.columns(found.back).into_iter().map(drawn).collect()
}

/// The fixed half in convex pieces, and whether they are its own: else they are columns under its upper side.
fn fixed_pieces(fixed: &Half) -> (Vec<Vec<DVec3>>, bool) {
    if fixed.solids().iter().all(|solid| solid.convex) {
        return (fixed.solids().iter().map(|solid| solid.vertices.clone()).collect(), true);
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
    let name = catchment::terminal::printable(&design.name).replace(['"', '\\'], "'");
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
