//! The latching face as a connector: a design file for `catchment run`.
//!
//! ```text
//!   z = g(x) = f(x) − f(L/2)        left of the middle, turned by 180° about it on the right; the second layer mirrored
//! ```
//!
//! Arms are rigid and hooks are omitted, because a rigid hook would block. The remainder is the aligning part
//! of the docking, from first contact until the hooks meet; its seat is the pose at which they meet, 2·f(L/2)
//! above the latched pose. Left of the middle g is the profile itself, lowered, so that the sliding slopes
//! are those of the part.
//!
//! Curves become facets, whose corners lie on the curve. The hill on the left is convex. The valley on the
//! right is the union of the half-planes below each of its facets' lines, as no line of a valley rises above
//! it: pieces that reach across the valley, and overlap. The library unites them into a single surface.
//!
//! In sliding alone the face corrects a whole width either way, exactly, as every X-Face does. With pitch
//! free its area of acceptance no longer depends on the number of facets (`docs/latch.md` has the figures).
//! The dissertation states that hand trials, with compliant arms, showed no significant change against the
//! X-Face.

use super::{Geometry, LatchDesign};
use glam::DVec2;
use std::fmt::Write;

/// Facets of a half profile.
const FACETS: u32 = 12;
/// Body below the lowest point, as a share of the width.
const BODY: f64 = 0.1;

/// Convex pieces of a layer, x from the middle and z, counter-clockwise.
fn cells(geometry: &Geometry, facets: u32) -> Vec<Vec<DVec2>> {
    let middle = 0.5 * geometry.width;
    let down = geometry.profile.height(middle);
    let corner = |k: u32| {
        let x = middle * f64::from(k) / f64::from(facets);
        DVec2::new(x - middle, geometry.profile.height(x) - down)
    };
    // The hill without the middle corner: there its last facet and the first facet of the valley are
    // coplanar.
    let hill: Vec<DVec2> = (0..facets).map(corner).collect();
    let floor = -hill[0].y - BODY * geometry.width;
    let mut cells: Vec<Vec<DVec2>> = Vec::new();
    // From the middle outward: the valley is the hill turned, and its first facet carries the hill.
    let mut inner = DVec2::ZERO;
    for outer in hill.iter().rev().map(|p| -*p) {
        let slope = (outer.y - inner.y) / (outer.x - inner.x);
        let line = |x: f64| inner.y + slope * (x - inner.x);
        let end = DVec2::new(middle, line(middle));
        let mut cell =
            if cells.is_empty() { vec![DVec2::new(-middle, floor)] } else { vec![DVec2::new(0.0, floor)] };
        if end.y > floor {
            cell.extend([DVec2::new(middle, floor), end]);
        } else {
            cell.push(DVec2::new(inner.x + (floor - inner.y) / slope, floor));
        }
        if cells.is_empty() {
            cell.extend(hill.iter().rev());
        } else {
            cell.push(DVec2::new(0.0, line(0.0)));
        }
        cells.push(cell);
        inner = outer;
    }
    cells
}

/// The design file of the face.
pub fn design(latch: &LatchDesign, geometry: &Geometry) -> String {
    faceted(latch, geometry, FACETS)
}

fn faceted(latch: &LatchDesign, geometry: &Geometry, facets: u32) -> String {
    let gap = 0.5 * latch.separator;
    let slabs = [[gap, gap + latch.sheet], [-gap - latch.sheet, -gap]];
    let mut pieces = String::new();
    for (layer, [near, far]) in slabs.into_iter().take(latch.layers as usize).enumerate() {
        for cell in cells(geometry, facets) {
            let points: Vec<String> = cell
                .iter()
                .flat_map(|p| {
                    let x = if layer == 0 { p.x } else { -p.x };
                    [near, far].map(|y| format!("[{x:.9}, {y:.6}, {:.9}]", p.y))
                })
                .collect();
            // Writing to a String cannot fail.
            let _ = writeln!(pieces, "  [{}],", points.join(", "));
        }
    }
    format!(
        "# The aligning part of a latching X-Face: arms rigid, hooks left out. Written by `catchment latch`.\n\
         # Its seat is where the hooks meet, {:.2} mm before the halves are latched.\n\
         schema = 1\nname = \"latching X-Face, aligning\"\n\n\
         [connector]\nwidth = {} # D\nunit = \"mm\"\nface_height = 0.0\nfixed.pieces = [\n{pieces}]\nmoving.pieces = [\n{pieces}]\n\n\
         [alignment]\nfree = [\"x\", \"pitch\"]\ncenter_of_rotation = 0.5\nrotation_length = 1.0\n\n\
         [errors]\nx = 1.0\npitch = 0.5\n",
        2.0 * geometry.profile.height(0.5 * geometry.width),
        latch.width,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment::acceptance::Outcome;
    use catchment::design::SourceText;
    use catchment::exec::Exec;
    use catchment::method::descent;
    use catchment::method::zraa::{Zraa, ZraaSettings, run};
    use catchment::pose::PoseError;
    use catchment::problem::{Draft, Problem};

    fn problem(facets: u32) -> Problem {
        let latch = LatchDesign::default();
        let text = faceted(&latch, &Geometry::of(&latch).unwrap(), facets);
        Draft::read(SourceText::new("face.toml", text)).unwrap().build().unwrap()
    }

    /// Like every X-Face the halves correct a whole width either way by sliding alone, and they have the same
    /// shape.
    #[test]
    fn sliding_alone_corrects_a_width() {
        for facets in [2, 5, FACETS] {
            let problem = problem(facets);
            let zraa = run(problem.pair(), &ZraaSettings::default(), &Exec::new()).unwrap();
            let Zraa::Interval { from, to, .. } = zraa else { panic!("{zraa:?}") };
            // Coordinates are written to 1e-9 mm.
            assert!((from + 1.0).abs() < 1e-8 && (to - 1.0).abs() < 1e-8, "{facets}: {from} {to}");
        }
    }

    /// Of strips that abut, 26 of 60 such poses jam with 3 facets, 41 with 6, 57 with 12.
    #[test]
    fn facets_do_not_jam_with_pitch() {
        for facets in [2, 3, 6, FACETS] {
            let problem = problem(facets);
            for k in 0..16 {
                let spread = |step: f64| 2.0 * (f64::from(k) * step + 0.3).fract() - 1.0;
                let error = PoseError {
                    x: 0.8 * spread(0.618_034),
                    pitch: 0.4 * spread(0.754_878),
                    ..PoseError::default()
                };
                let outcome =
                    descent::outcome(problem.pair(), &error, &descent::DescentSettings::default()).outcome;
                assert_eq!(outcome, Outcome::Aligned, "{facets} {error:?}");
            }
        }
    }
}
