//! A result as an interactive page: a single file without network access, for any browser.
//!
//! ```text
//!   report · jams · window   JSON ──────────────────────────┐
//!   outcomes · planes        u8, chunks, deflate, base64 ───┼──▶ page.html
//!   halves                   Half::to_bytes, deflate ───────┤      viewer (script, style), motions (WebAssembly)
//! ```
//!
//! Text from a design or a stored result is never markup: `html` is the only way into the page, and the
//! page's own policy permits only the script with the stated hash.
//!
//! The page draws the stored results and computes no acceptance. It follows a clicked pose by the same code
//! as [`Problem::trace`](catchment_core::problem::Problem::trace), compiled to WebAssembly. The viewer is
//! built from `viewer/` of the source tree and committed here as it is shipped, so that no other tool is
//! needed. The same result gives the same bytes: a page contains no time.
//!
//! Not promised: motions to the last bit, if the browser's machine rounds sines differently. Lengths in D,
//! angles in radians; the page shows the design's own unit and degrees.

mod grid;

mod parts;

pub use crate::html::policy;
pub use parts::{PageParts, Studies};

use super::{JamsReport, Report, WindowReport};
use crate::html::Html;
use catchment_core::acceptance::Acceptance;
use catchment_core::connector::Connector;
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::merit::MeritError;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};
use std::io::Write as _;

/// The viewer, for the page itself.
const VIEWER: &str = include_str!("bundle/viewer.js");
/// The worker script of the viewer: outcomes, surfaces, motions.
const WORKER: &str = include_str!("bundle/worker.js");
/// The drawing script of the viewer.
const PAINTER: &str = include_str!("bundle/painter.js");
/// How it looks.
const STYLE: &str = include_str!("bundle/viewer.css");
/// The core of the library as WebAssembly, deflated (zlib).
const MOTIONS: &[u8] = include_bytes!("bundle/motions.wasm.z");

/// Content of a page.
#[derive(Debug, Clone)]
pub struct Page<'a> {
    /// The run.
    pub report: &'a Report,
    /// The outcomes behind it, over a grid.
    pub acceptance: &'a Acceptance,
    /// Outcomes over planes through zero ([`catchment_study::planes`]); empty: slices at zero show the cells
    /// of the grid.
    pub planes: &'a [Acceptance],
    /// The halves; `None` if they are no longer available: nothing is drawn in space then, and no pose can be
    /// followed.
    pub halves: Option<&'a Connector>,
    /// The jams.
    pub jams: Option<&'a JamsReport>,
    /// The window.
    pub window: Option<&'a WindowReport>,
    /// Notes about the page, such as the reason for a missing part.
    pub notes: Vec<String>,
    /// Whether the program serves it, and recomputes results at the page's request.
    pub is_served: bool,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The outcomes are not over a grid.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// A report has no JSON form.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// Nothing could be packed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Page<'_> {
    /// The permissions of the page, for a header of its server: the page contains the same.
    pub fn policy(&self) -> String {
        policy(&[VIEWER], &[STYLE], self.is_served)
    }

    /// The page, HTML in UTF-8.
    ///
    /// # Errors
    /// See [`PageError`].
    pub fn html(&self, exec: &Exec) -> Result<String, PageError> {
        let chunks = grid::packed(self.acceptance, exec)?;
        let planes =
            self.planes.iter().map(|plane| grid::plane(plane, exec)).collect::<Result<Vec<_>, _>>()?;
        let data = json!({
            "report": json_of(self.report)?,
            "jams": self.jams.map(json_of).transpose()?,
            "window": self.window.map(json_of).transpose()?,
            "friction": self.report.friction(),
            "notes": self.notes,
            "served": self.is_served,
            "chunk_cells": chunks.cells,
            "chunks": chunks.packed.len(),
            "planes": planes.iter().map(|plane| &plane.axes).collect::<Vec<_>>(),
        });
        let mut page = Html::default()
            .fixed(
                "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
                 <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
                 <meta http-equiv=\"Content-Security-Policy\" content=\"",
            )
            .text(&self.policy())
            .fixed("\">\n<meta name=\"generator\" content=\"catchment ")
            .text(self.report.catchment.as_ref())
            .fixed("\">\n<title>")
            .text(&self.report.design.name)
            .fixed(" · catchment</title>\n<style>")
            .fixed(STYLE)
            .fixed("</style>\n</head>\n<body>\n<noscript>This page needs its own script: allow scripts for it.</noscript>\n")
            .fixed("<script type=\"application/json\" id=\"data\">")
            .json(&data)?
            .fixed(END);
        if let Some(Connector { fixed, moving, .. }) = self.halves {
            page = packed(page, "fixed", None, &deflated(&fixed.to_bytes())?);
            page = packed(page, "moving", None, &deflated(&moving.to_bytes())?);
            page = packed(page, "motions", None, MOTIONS);
        }
        for (number, chunk) in chunks.packed.iter().enumerate() {
            page = packed(page, "outcomes", Some(number), chunk);
        }
        for (number, plane) in planes.iter().enumerate() {
            page = packed(page, "plane", Some(number), &plane.packed);
        }
        for (id, script) in [("worker", WORKER), ("painter", PAINTER)] {
            page = text_element(page, id, None).fixed(script).fixed(END);
        }
        Ok(page.fixed("<script>").fixed(VIEWER).fixed("</script>\n</body>\n</html>\n").into_string())
    }
}

const END: &str = "</script>\n";

/// The beginning of an element that is text to a browser, and that the viewer finds by its name.
fn text_element(page: Html, id: &'static str, number: Option<usize>) -> Html {
    let page = page.fixed("<script type=\"text/plain\" id=\"").fixed(id);
    match number {
        Some(number) => page.fixed("-").number(number),
        None => page,
    }
    .fixed("\">")
}

/// Bytes that the viewer finds by their name.
fn packed(page: Html, id: &'static str, number: Option<usize>, bytes: &[u8]) -> Html {
    text_element(page, id, number).bytes(bytes).fixed(END)
}

/// A report without the parts that differ between equal runs, and without the design, which the run contains.
fn json_of<T: serde::Serialize>(report: &T) -> Result<Value, serde_json::Error> {
    let mut value = serde_json::to_value(report)?;
    value["timing"] = Value::Null;
    if value["kind"] != "run" {
        value["design"] = Value::Null;
    }
    Ok(value)
}

/// As browsers read it (`DecompressionStream("deflate")`).
fn deflated(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    packed.write_all(bytes)?;
    packed.finish()
}

#[cfg(test)]
mod tests;
