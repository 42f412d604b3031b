//! A result as one page to click: a file without a network, for any browser.
//!
//! ```text
//!   report · jams · window   JSON ──────────────────────────┐
//!   outcomes                 u8, chunks, deflate, base64 ───┼──▶ page.html
//!   halves                   Half::to_bytes, deflate ───────┤      viewer (script, style), motions (WebAssembly)
//! ```
//!
//! The page draws what is here and computes no acceptance. A pose that is clicked is followed in the page, by the same code as
//! [`Problem::trace`](crate::problem::Problem::trace), compiled to WebAssembly. The viewer is built from `viewer/` of the source tree and lies here
//! as it is shipped, so that no other tool is needed. The same result gives the same bytes: no time stands in a page.
//!
//! Not promised: motions to the last bit, where the browser's machine rounds sines otherwise. Lengths in D, angles in radians; the page shows the
//! design's own unit and degrees.

mod grid;
mod parts;

pub use parts::{Parts, Studies};

use super::{JamsReport, Report, WindowReport};
use crate::acceptance::Acceptance;
use crate::connector::{Connector, Half};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::merit::MeritError;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;

/// The viewer, for the page itself.
const VIEWER: &str = include_str!("bundle/viewer.js");
/// What the viewer runs beside the page: outcomes, surfaces, motions.
const WORKER: &str = include_str!("bundle/worker.js");
/// What draws in space beside the page.
const PAINTER: &str = include_str!("bundle/painter.js");
/// How it looks.
const STYLE: &str = include_str!("bundle/viewer.css");
/// The core of the library as WebAssembly, deflated (zlib).
const MOTIONS: &[u8] = include_bytes!("bundle/motions.wasm.z");

/// What a page may do: nothing but run what it holds. A page that is served asks whoever served it, and nobody else.
pub const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; \
     style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'";

/// What a page shows.
#[derive(Debug, Clone)]
pub struct Page<'a> {
    /// The run.
    pub report: &'a Report,
    /// The outcomes behind it, over a grid.
    pub acceptance: &'a Acceptance,
    /// The halves; `None` where they cannot be had any more: nothing is drawn in space then, and no pose can be followed.
    pub halves: Option<&'a Connector>,
    /// Where it jams.
    pub jams: Option<&'a JamsReport>,
    /// The window.
    pub window: Option<&'a WindowReport>,
    /// What a person should know of the page, such as why a part of it is missing.
    pub notes: Vec<String>,
    /// Whether it is served by the program, which computes again where the page asks for it.
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
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Page<'_> {
    /// The page, HTML in UTF-8.
    ///
    /// # Errors
    /// See [`PageError`].
    pub fn html(&self, exec: &Exec) -> Result<String, PageError> {
        let chunks = grid::packed(self.acceptance, exec)?;
        let data = json!({
            "report": told(self.report)?,
            "jams": self.jams.map(told).transpose()?,
            "window": self.window.map(told).transpose()?,
            "friction": self.report.friction(),
            "notes": self.notes,
            "served": self.is_served,
            "chunk_cells": chunks.cells,
            "chunks": chunks.packed.len(),
        });
        let policy = if self.is_served { format!("{POLICY}; connect-src 'self'") } else { POLICY.to_owned() };
        let mut page = String::new();
        let title = escaped(&self.report.design.name);
        // Writing into a string fails nowhere.
        let _ = write!(
            page,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
             <meta name=\"generator\" content=\"catchment {}\">\n<title>{title} · catchment</title>\n<style>\n{STYLE}</style>\n</head>\n\
             <body>\n<noscript>This page draws its result by a script that it holds itself; let it run.</noscript>\n",
            self.report.catchment
        );
        element(&mut page, "application/json", "data", &inert(&serde_json::to_string(&data)?));
        if let Some(Connector { fixed, moving, .. }) = self.halves {
            element(&mut page, "text/plain", "fixed", &half(fixed)?);
            element(&mut page, "text/plain", "moving", &half(moving)?);
            element(&mut page, "text/plain", "motions", &STANDARD.encode(MOTIONS));
        }
        for (number, chunk) in chunks.packed.iter().enumerate() {
            element(&mut page, "text/plain", &format!("outcomes-{number}"), &STANDARD.encode(chunk));
        }
        element(&mut page, "text/plain", "worker", WORKER);
        element(&mut page, "text/plain", "painter", PAINTER);
        let _ = write!(page, "<script>\n{VIEWER}</script>\n</body>\n</html>\n");
        Ok(page)
    }
}

/// A report without what differs between equal runs, and without the design, which the run has.
fn told<T: serde::Serialize>(report: &T) -> Result<Value, serde_json::Error> {
    let mut value = serde_json::to_value(report)?;
    value["timing"] = Value::Null;
    if value["kind"] != "run" {
        value["design"] = Value::Null;
    }
    Ok(value)
}

/// Something that the viewer finds by its name.
fn element(page: &mut String, kind: &str, id: &str, content: &str) {
    let _ = writeln!(page, "<script type=\"{kind}\" id=\"{id}\">{content}</script>");
}

/// JSON that cannot end the script that it stands in: in JSON `<` occurs in strings alone.
fn inert(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Text for people, between tags.
fn escaped(text: &str) -> String {
    crate::terminal::printable(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn half(half: &Half) -> Result<String, PageError> {
    Ok(STANDARD.encode(deflated(&half.to_bytes())?))
}

/// As browsers read it (`DecompressionStream("deflate")`).
fn deflated(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    packed.write_all(bytes)?;
    packed.finish()
}

#[cfg(test)]
mod tests;
