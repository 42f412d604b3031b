//! Pictures: SVG, and PNG drawn from it with an embedded font, so that a machine without fonts draws the same.
//!
//! ```text
//!   slices      outcomes over pairs of errors, the border of the accepted set, the ONAA cube
//!   matrix      slices of all pairs of errors, in a triangle with shared axes
//!   convergence Sum and ONAA against resolution and time, every method
//!   difference  cells at which two acceptances differ, and the border of the first
//!   agreement   agreement of each pair of methods of a design
//!   number_maps tables of numbers in colours, side by side
//!   curves      any curves over a logarithmic scale, side by side
//!   sensitivity the Sum against rho
//!   success     the success of robots over the factor of their errors, and what each error gains
//!   chance      probability that trials dock over two errors, and against speed
//!   sweep       the Sum of many designs in colours, and the accepted set of each
//!   heights     height of first contact over a pair, contours, the same border on top
//!   section     both halves cut along the approach axis, at any pose
//!   solids      both halves in space
//!   pair        both halves as read from the design: apart in space, mated in section
//!   lever       the first contact with its lever arms and angles, as in the kinematic method
//!   faces       designs side by side, mated and at the largest offset that still slides home
//!   bodies      convex pieces of the halves, their swept volumes and overlaps
//!   hold        largest sideways force on a docked half, over the direction, and largest torques
//!   jams        rests of halves that do not dock, cut through their contacts, and in space; rests likewise
//!   trajectory  the moving half along its path, and its remaining errors
//!   region      offsets that are corrected without any rotation, and the largest square among them
//!   trials      the exact region beside the outcomes of single trials
//!   bench       trials of a plan over the accepted set: their poses and observed outcomes
//!   basins      depths of all minima, and the accepted share over the depth tolerance
//!   watersheds  halves, heights, the labels of flooding before and after merging
//!   partition   the contact space as polygons, and the exact outline of the accepted set
//!   overview    the picture of a design: halves, acceptance, heights
//! ```
//!
//! Pictures of a run use its report and compute nothing: their numbers are those of its table, rounded by the
//! same functions.
//!
//! For people: lengths in the design's unit if it has a unit (else D), angles in degrees. The same input
//! gives the same bytes. Maps and solids are embedded images, everything else is vector graphics.

mod agreement;
mod answer;
mod basins;
mod bench;
mod bodies;
#[cfg(feature = "drop")]
mod chance;
mod convergence;
mod curves;
mod depth_buffer;
mod difference;
pub mod draw;
mod faces;
mod friction;
mod glyphs;
mod heights;
mod hold;
mod jams;
mod lever;
mod map;
mod matrix;
mod memory;
mod number_map;
mod overview;
mod pair;
mod partition;
mod plane;
mod raster;
mod region;
mod sampled;
mod section;
mod sensitivity;
mod slices;
mod solid;
mod success;
mod sweep;
mod trajectory;
mod trials;
mod triangle;
mod watersheds;

pub use agreement::agreement;
pub use answer::DrawnFigures;
pub use basins::basins;
pub use bench::{plan, validation};
pub use bodies::bodies;
#[cfg(feature = "drop")]
pub use chance::chance;
pub use convergence::convergence;
pub use curves::{Curve, CurveChart, CurvePoint, curves};
pub use difference::difference;
pub use faces::{PicturedDesign, faces};
pub use friction::friction;
pub use heights::heights;
pub use hold::hold;
pub use jams::{jams, rests};
pub use lever::lever;
pub use matrix::slice_matrix;
pub use memory::{ensure_fits, ensure_grid_fits, ensure_run_fits};
pub use number_map::{Colouring, Digits, NumberMap, number_maps};
pub use overview::overview;
pub use pair::pair;
pub use partition::partition;
pub use region::region;
pub use sampled::sampled;
pub use section::{MovingHalfPose, panel as section_panel, section};
pub use sensitivity::sensitivity;
pub use slices::slices;
pub use solid::{panel as solid_panel, solids};
pub use success::success;
pub use sweep::{sweep_map, sweep_outlines};
pub use trajectory::trajectory;
pub use trials::trials;
pub use watersheds::watersheds;

use super::{Report, run};
use catchment_core::document::percent;
use catchment_core::merit::MeritError;
use catchment_core::merit::onaa::Interval;

/// Why a picture cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The grid does not have the content of the picture.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// There is nothing to show.
    #[error("there is nothing to draw: {what}")]
    Empty {
        /// The missing item.
        what: &'static str,
    },
    /// The image could not be encoded.
    #[error("cannot encode the image: {reason}")]
    Encode {
        /// Message of the encoder.
        reason: String,
    },
}

/// A finished picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    svg: String,
}

impl Picture {
    /// A picture from a drawing.
    pub fn of(drawing: draw::svg::Svg) -> Self {
        Self { svg: drawing.finish() }
    }

    /// The picture as SVG. Text requests `DejaVu Sans` and falls back to fonts of the viewer.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// The picture as PNG, `scale` pixels per SVG unit (2 is good for screens and slides).
    ///
    /// # Errors
    /// If the scale gives an image that cannot be held.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, FigureError> {
        raster::render(&self.svg, scale)
    }
}

/// The numbers of a run in a line: `Sum 12.587 ± 0.023 D²·rad³  ·  16.32 % of the error box  ·  ONAA edge 0.3100  ·
/// by transport`.
fn headline(report: &Report) -> String {
    let result = &report.acceptance;
    let sum = run::sum(result);
    let share = if run::upper_end(result).is_some() {
        String::new()
    } else {
        format!("  ·  {} of the error box", percent(result.fraction))
    };
    let onaa =
        report.onaa.as_ref().map_or_else(String::new, |onaa| format!("  ·  ONAA edge {:.4}", onaa.edge));
    format!("Sum {sum}{share}{onaa}  ·  by {}", report.method)
}

/// Bounds of the largest cube of a run; empty if there is none.
fn cube(report: &Report) -> &[Interval] {
    report.onaa.as_ref().map_or(&[], |onaa| &onaa.bounds)
}

#[cfg(test)]
pub(crate) mod testing {
    //! A pair of halves to draw, and checks of the picture.

    use super::Picture;
    use crate::Report;
    use catchment_core::acceptance::Acceptance;
    use catchment_core::connector::{Connector, Half, Surface};
    use catchment_core::design::Design;
    use catchment_core::exec::Exec;
    use glam::DVec3;

    /// A convex prism over a polygon in x–z (counter-clockwise seen from −y), `lo` to `hi` along y.
    fn prism(profile: &[[f64; 2]], lo: f64, hi: f64) -> Surface {
        let n = profile.len() as u32;
        let at = |y: f64| profile.iter().map(move |[x, z]| DVec3::new(*x, y, *z));
        let mut polygons = vec![(0..n).collect::<Vec<u32>>(), (n..2 * n).rev().collect()];
        polygons.extend((0..n).map(|k| vec![(k + 1) % n, k, k + n, (k + 1) % n + n]));
        Surface::from_polygons(at(lo).chain(at(hi)).collect(), &polygons).unwrap()
    }

    /// A V notch and its tip, face centres at the origin.
    pub(crate) fn v_face() -> Connector {
        let (h, d) = (0.25, 0.5);
        let left = prism(&[[-d, -h], [0.0, -h], [-d, h]], -0.25, 0.25);
        let right = prism(&[[d, -h], [d, h], [0.0, -h]], -0.25, 0.25);
        let tip = prism(&[[-d, h], [0.0, -h], [d, h]], -0.25, 0.25);
        Connector::from_halves(Half::of(vec![left, right]), Half::of(vec![tip]))
    }

    /// Two crossed ramps in two layers, as the fixed half and a copy of it turned over.
    pub(crate) fn x_face() -> Connector {
        let h = 0.25;
        let rising = prism(&[[-0.5, -h], [0.5, -h], [0.5, h]], -0.25, 0.0);
        let falling = prism(&[[-0.5, -h], [0.5, -h], [-0.5, h]], 0.0, 0.25);
        let fixed = Half::of(vec![rising, falling]);
        let moving = fixed.mapped(|p| catchment_core::pose::Mount::Y.apply(p));
        Connector::from_halves(fixed, moving)
    }

    /// A square pyramid over its socket, which is four wedges on a base.
    pub(crate) fn pyramid() -> Connector {
        let (h, d, base) = (0.25, 0.5, 0.5);
        let ring = [[-d, -d], [d, -d], [d, d], [-d, d]];
        let rim = |z: f64| ring.iter().map(move |[x, y]| DVec3::new(*x, *y, z));
        let mut vertices: Vec<DVec3> = rim(-base).chain(rim(h)).collect();
        vertices.push(DVec3::new(0.0, 0.0, -h));
        let mut polygons = vec![vec![3, 2, 1, 0]];
        polygons.extend((0..4u32).map(|k| vec![k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4]));
        polygons.extend((0..4u32).map(|k| vec![k + 4, (k + 1) % 4 + 4, 8]));
        let socket = Surface::from_polygons(vertices, &polygons).unwrap();
        let mut vertices: Vec<DVec3> = rim(h).collect();
        vertices.push(DVec3::new(0.0, 0.0, -h));
        let mut polygons = vec![vec![0, 1, 2, 3]];
        polygons.extend((0..4u32).map(|k| vec![(k + 1) % 4, k, 4]));
        let plug = Surface::from_polygons(vertices, &polygons).unwrap();
        Connector::from_halves(Half::of(vec![socket]), Half::of(vec![plug]))
    }

    /// The report of an acceptance over a grid.
    pub(crate) fn report_of(design: &Design, acceptance: &Acceptance) -> Report {
        Report::new(design, acceptance, serde_json::Value::Null, None, &Exec::new()).unwrap()
    }

    /// The same with a Sum corrected by samples to an eighth of the error box.
    pub(crate) fn corrected(mut report: Report, sum: f64, ci95: [f64; 2]) -> Report {
        let acceptance = &mut report.body.acceptance;
        (acceptance.sum, acceptance.sum_ci95, acceptance.fraction) = (sum, Some(ci95), 0.125);
        report
    }

    /// Checks that the picture is well formed and not blank; writes it to `$CATCHMENT_PICTURES` for eyes.
    pub(crate) fn look(name: &str, picture: &Picture) {
        resvg::usvg::roxmltree::Document::parse(picture.svg()).unwrap();
        let bytes = picture.png(2.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let dark = pixels.chunks_exact(4).filter(|p| p[0] < 128 && p[1] < 128 && p[2] < 128).count();
        assert!(dark * 1000 > pixels.len() / 4, "{name}: fewer than one dark pixel in a thousand");
        if let Some(folder) = std::env::var_os("CATCHMENT_PICTURES") {
            let folder = std::path::PathBuf::from(folder);
            std::fs::write(folder.join(format!("{name}.png")), bytes).unwrap();
            std::fs::write(folder.join(format!("{name}.svg")), picture.svg()).unwrap();
        }
    }
}
