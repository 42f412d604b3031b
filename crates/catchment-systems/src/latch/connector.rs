//! The latching face as a connector: a design file for `catchment run`.
//!
//! ```text
//!   z = g(x) = f(x) − f(L/2)        left of the middle, turned by 180° about it on the right; the second layer mirrored
//! ```
//!
//! Arms are rigid and hooks are left out: a rigid hook lets nothing pass. What is left is the part of the docking that aligns, from
//! first contact until the hooks meet; its seat is where they do, 2·f(L/2) above the latched pose. Left of the middle g is the
//! profile itself, lowered, so that the slopes that slide are those of the part.
//!
//! Sliding alone it corrects a whole width either way, exactly, as every X-Face does. With pitch free its area of acceptance is *not*
//! to be had this way: curves become facets, and rigid frictionless facets of both halves nest in each other off the seat; with 6, 12
//! and 28 of them the same poses end differently. The dissertation says that hand trials, with arms that give, showed no
//! significant change against the X-Face: that is the better estimate. So only x is free in what is written.

use super::{Geometry, Latch};
use glam::DVec2;
use std::fmt::Write;

/// Straight pieces of a half profile.
const STRIPS: usize = 12;
/// Body below the lowest point, as a share of the width.
const BODY: f64 = 0.1;

/// Convex pieces of one layer, x from the middle and z, counter-clockwise.
fn cells(geometry: &Geometry) -> Vec<Vec<DVec2>> {
    let middle = 0.5 * geometry.width;
    let down = geometry.profile.height(middle);
    let corner = |k: usize| {
        let x = middle * k as f64 / STRIPS as f64;
        DVec2::new(x - middle, geometry.profile.height(x) - down)
    };
    let left: Vec<DVec2> = (0..=STRIPS).map(corner).collect();
    let bottom = -left[0].y - BODY * geometry.width;
    // Under a curve of negative curvature everything is convex.
    let mut hill = vec![DVec2::new(-middle, bottom), DVec2::new(0.0, bottom)];
    hill.extend(left.iter().rev());
    let mut cells = vec![hill];
    // Under its turned image only strips are.
    for pair in left.windows(2) {
        let (from, to) = (-pair[1], -pair[0]);
        cells.push(vec![DVec2::new(from.x, bottom), DVec2::new(to.x, bottom), to, from]);
    }
    cells
}

/// The design file of the face.
pub fn design(latch: &Latch, geometry: &Geometry) -> String {
    let gap = 0.5 * latch.separator;
    let slabs = [[gap, gap + latch.sheet], [-gap - latch.sheet, -gap]];
    let mut pieces = String::new();
    for (layer, [near, far]) in slabs.into_iter().take(latch.layers as usize).enumerate() {
        for cell in cells(geometry) {
            let points: Vec<String> = cell
                .iter()
                .flat_map(|p| {
                    let x = if layer == 0 { p.x } else { -p.x };
                    [near, far].map(|y| format!("[{x:.6}, {y:.6}, {:.6}]", p.y))
                })
                .collect();
            // Writing to a String cannot fail.
            let _ = writeln!(pieces, "  [{}],", points.join(", "));
        }
    }
    format!(
        "# The aligning part of a latching X-Face: arms rigid, hooks left out. Written by `catchment latch`.\n\
         # Its seat is where the hooks meet, {:.2} mm before the halves are latched. Only x is free: with pitch the facets of\n\
         # both halves nest off the seat, which the part with its yielding arms does not; take the X-Face for that.\n\
         schema = 1\nname = \"latching X-Face, aligning\"\n\n\
         [connector]\nwidth = {} # D\nunit = \"mm\"\nface_height = 0.0\nfixed.pieces = [\n{pieces}]\nmoving.pieces = [\n{pieces}]\n\n\
         [alignment]\nfree = [\"x\"]\ncenter_of_rotation = 0.5\nrotation_length = 1.0\n\n\
         [errors]\nx = 1.0\n",
        2.0 * geometry.profile.height(0.5 * geometry.width),
        latch.width,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::design::SourceText;
    use catchment::exec::Exec;
    use catchment::method::zraa::{Settings, Zraa, run};
    use catchment::problem::Draft;

    /// Like every X-Face the halves correct a whole width either way by sliding alone, and they are one shape.
    #[test]
    fn sliding_alone_corrects_a_width() {
        let latch = Latch::default();
        let text = design(&latch, &Geometry::of(&latch).unwrap());
        let draft = Draft::read(SourceText::new("face.toml", text)).unwrap();
        let problem = draft.build().unwrap();
        let zraa = run(problem.pair(), &Settings::default(), &Exec::new()).unwrap();
        let Zraa::Interval { from, to, .. } = zraa else { panic!("{zraa:?}") };
        // Coordinates are written to 1e-6 mm.
        assert!((from + 1.0).abs() < 1e-6 && (to - 1.0).abs() < 1e-6, "{from} {to}");
    }
}
