//! The solids behind the contact space: their content, and their files.
//!
//! ```text
//!   Solids ──▶ vtp   VTK's `PolyData` in XML, text: ParaView, pyvista, vtk; numbers per face
//!         ├──▶ obj   Wavefront: a group per convex piece
//!         └──▶ figure::bodies
//! ```

mod obj;
#[cfg(test)]
mod tests;
mod vtp;

pub use obj::obj;
pub use vtp::vtp;

use super::document::Printed;
use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{Column, ColumnFormat, Document, Table, grouped};
use catchment_core::method::partition::{PartitionSettings, Solid, SolidShape, Solids};
use glam::DVec3;
use serde::Serialize;
use std::borrow::Cow;

/// A shape, with its head.
pub type SolidsReport = ReportEnvelope<SolidsBody>;

/// Content of an exported solid.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SolidsBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// The exported solid.
    pub shape: SolidShape,
    /// Meaning of the three axes of a file: `x`, `y` and `z` are lengths in D, the others angles in radians.
    pub axes: [&'static str; 3],
    /// 3, or 2 for flat bodies.
    pub dimension: usize,
    /// Slices and strips; null for the halves.
    pub settings: Option<PartitionSettings>,
    /// Number of convex pieces of the fixed half.
    pub fixed_pieces: usize,
    /// Number of convex pieces of the moving half.
    pub moving_pieces: usize,
    /// Number of convex bodies of the solid, which may overlap.
    pub bodies: usize,
    /// Number of their corners.
    pub corners: usize,
    /// Number of their faces.
    pub faces: usize,
    /// Smallest coordinates, on the axes of a file.
    pub low: [f64; 3],
    /// Largest coordinates.
    pub high: [f64; 3],
}

impl ReportBody for SolidsBody {
    const KIND: &'static str = "solids";
}

impl SolidsReport {
    /// Report of a solid, with the warnings about its design.
    pub fn new(design: &Design, shape: &Solids, warnings: Vec<Diagnostic>) -> Self {
        let (low, high) = bounds(shape);
        let sum = |count: fn(&Solid) -> usize| shape.solids.iter().map(count).sum();
        let body = SolidsBody {
            design: design.clone(),
            shape: shape.subject,
            axes: shape.axes,
            dimension: shape.dimension,
            settings: (shape.subject != SolidShape::Halves).then_some(shape.settings),
            fixed_pieces: shape.pieces[0],
            moving_pieces: shape.pieces[1],
            bodies: shape.solids.len(),
            corners: sum(|solid| solid.vertices.len()),
            faces: sum(|solid| solid.faces.len()),
            low: low.into(),
            high: high.into(),
        };
        Self::of(body, warnings, None)
    }
}

impl Printed for SolidsBody {
    fn title(&self) -> Cow<'_, str> {
        (&self.design.name).into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        document.row("shape", in_words(self.shape));
        document.row("pieces", format!("{} fixed, {} moving", self.fixed_pieces, self.moving_pieces));
        if let Some(PartitionSettings { slices, strips }) = self.settings {
            let turns = self.axes.iter().any(|axis| is_angle(axis));
            let slices = if turns { format!("{slices} slices, ") } else { String::new() };
            document.row("made of", format!("{slices}{strips} strips per D"));
        }
        let kind = if self.dimension == 2 { "flat bodies" } else { "bodies" };
        document
            .row("bodies", format!("{} convex {kind}, {} faces", grouped(self.bodies), grouped(self.faces)));
        let mut table = Table::new([
            Column::new("axis").key("axis").left(),
            Column::new("from").key("low").format(ColumnFormat::Significant),
            Column::new("to").key("high").format(ColumnFormat::Significant),
            Column::new("unit").key("unit").left(),
        ]);
        for (k, axis) in self.axes.iter().enumerate() {
            let unit = if is_angle(axis) { "rad" } else { "D" };
            table.push([(*axis).into(), self.low[k].into(), self.high[k].into(), unit.into()]);
        }
        document.table(table);
        document
    }
}

/// Description of a solid.
pub fn in_words(shape: SolidShape) -> &'static str {
    match shape {
        SolidShape::Halves => "both halves as convex pieces, docked",
        SolidShape::Swept => "the moving half, reflected and turned through its slices",
        SolidShape::Collision => "places of the centre of rotation at which the halves overlap",
    }
}

/// Whether an axis of a file shows an angle.
pub fn is_angle(axis: &str) -> bool {
    !matches!(axis, "x" | "y" | "z")
}

/// The least and the greatest coordinates of a shape; both 0 for nothing.
pub fn bounds(shape: &Solids) -> (DVec3, DVec3) {
    let corners = || shape.solids.iter().flat_map(|solid| &solid.vertices).copied();
    (corners().reduce(DVec3::min).unwrap_or_default(), corners().reduce(DVec3::max).unwrap_or_default())
}

/// A line on the axes of a file, for its head.
fn heading(shape: &Solids) -> String {
    let axis = |(file, axis): (&str, &&str)| {
        format!("{file} is {axis} ({})", if is_angle(axis) { "rad" } else { "D" })
    };
    let axes: Vec<String> = ["x", "y", "z"].into_iter().zip(&shape.axes).map(axis).collect();
    format!(
        "catchment {}: {}; {}, z along the approach",
        env!("CARGO_PKG_VERSION"),
        in_words(shape.subject),
        axes.join(", ")
    )
}

/// The middle of a face's corners.
fn middle(solid: &Solid, face: &[usize]) -> DVec3 {
    face.iter().map(|k| solid.vertices[*k]).sum::<DVec3>() / face.len() as f64
}
