//! Report of a drop test that was exported for other engines: its settings and its files.

use super::document::Printed;
use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::design::Design;
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::Document;
use catchment_core::pose::PoseError;
use serde::Serialize;
use std::borrow::Cow;

/// Result of an export, with its head.
pub type ExportReport = ReportEnvelope<ExportBody>;

/// Result of an export.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExportBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// The settings of the drop test.
    pub settings: serde_json::Value,
    /// The pose error at the start, in D and rad.
    pub start: PoseError,
    /// The MJCF file.
    pub mjcf: String,
    /// The SDF file.
    pub sdf: String,
    /// Number of mesh files beside it.
    pub meshes: usize,
}

impl ReportBody for ExportBody {
    const KIND: &'static str = "export";
}

impl ExportReport {
    /// From files that were written, with the warnings about their design.
    pub fn new(body: ExportBody, warnings: Vec<Diagnostic>) -> Self {
        Self::of(body, warnings, None)
    }
}

impl Printed for ExportBody {
    fn title(&self) -> Cow<'_, str> {
        (&self.design.name).into()
    }

    fn document(&self) -> Document {
        let mut document = Document::default();
        document.row("MJCF", self.mjcf.clone()).row("SDF", self.sdf.clone());
        document.row("meshes", self.meshes.to_string());
        document
    }
}
