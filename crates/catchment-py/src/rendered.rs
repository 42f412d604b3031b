//! A report as JSON, text, CSV and picture.

use crate::refusal::Refusal;
use catchment::report::document::Printed;
use catchment::report::figure::{FigureError, Picture};
use catchment::report::{ReportEnvelope, csv};
use pyo3::prelude::*;
use serde::Serialize;

/// Pixels per unit of a picture, as in the command line.
pub(crate) const PNG_SCALE: f32 = 2.0;

/// A report as JSON, as a table to read, as CSV for programs, and as a picture.
#[pyclass(frozen, module = "catchment._catchment")]
pub(crate) struct Rendered {
    /// The report, as the command line prints it.
    #[pyo3(get)]
    json: String,
    /// The report as a table to read.
    #[pyo3(get)]
    table: String,
    /// The report as CSV, for programs.
    #[pyo3(get)]
    csv: String,
    picture: Option<Picture>,
}

impl Rendered {
    /// Renders a report without a picture.
    pub(crate) fn of<B: Printed + Serialize>(report: &ReportEnvelope<B>) -> Result<Self, Refusal> {
        let csv = String::from_utf8_lossy(&csv(&report.records())?).into_owned();
        Ok(Self { json: report.to_json()?, table: report.table(), csv, picture: None })
    }

    /// Adds the picture, if there is something to draw.
    pub(crate) fn with(mut self, picture: Result<Picture, FigureError>) -> Result<Self, Refusal> {
        self.picture = match picture {
            Ok(picture) => Some(picture),
            Err(FigureError::Empty { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        Ok(self)
    }
}

#[pymethods]
impl Rendered {
    /// The picture as SVG.
    fn svg(&self) -> Option<&str> {
        self.picture.as_ref().map(Picture::svg)
    }

    /// The picture as PNG.
    fn png(&self, py: Python<'_>) -> PyResult<Option<Vec<u8>>> {
        let drawn = py.detach(|| self.picture.as_ref().map(|picture| picture.png(PNG_SCALE)).transpose());
        drawn.map_err(|error| Refusal::from(error).raise(py))
    }
}
