//! The visible shapes of an SVG picture, one after the other, with the transform from their coordinates to
//! those of the picture.
//!
//! ```text
//! <g transform="A"> <path transform="B" d="…"/> ──▶ shape, A·B        display, visibility, class and layer hide it: it is counted, and no shape
//! ```
//!
//! Every feature that changes the drawn shapes is supported or rejected with its place: hidden shapes are
//! skipped; clips, masks, filters, animations and movement by style are rejected, as are texts, references
//! and pictures, unknown elements, and shapes without paint. Elements of other namespaces (metadata of
//! drawing programs) draw nothing.
//!
//! Not promised: fills, strokes and fill rules are read only to detect hidden shapes, so that the line of a
//! shape is its path.

use super::element::{Entered, Open, Prefixes, entered};
use super::style::Sheet;
use super::{Piece, Tag, Walk, XmlAttribute, XmlError, XmlLimits};
use catchment_base::budget::{Limit, Overspent};
use kurbo::Affine;
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};

/// The namespace of SVG.
pub(super) const NAMESPACE: &str = "http://www.w3.org/2000/svg";
/// Elements that contain drawn elements.
pub(super) const HOLDERS: [&str; 3] = ["svg", "g", "a"];
/// Elements that draw a line.
pub(super) const SHAPES: [&str; 7] = ["path", "rect", "circle", "ellipse", "polygon", "polyline", "line"];
/// Elements that draw nothing in place, with their members.
pub(super) const NOT_DRAWN: [&str; 15] = [
    "defs",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "symbol",
    "metadata",
    "style",
    "title",
    "desc",
    "linearGradient",
    "radialGradient",
    "filter",
    "view",
    "font",
];
/// Limits of a picture.
const LIMITS: XmlLimits = XmlLimits {
    elements: Limit { most: 100_000, of: "elements", remedy: "delete what is no outline" },
    depth: Limit { most: 256, of: "elements within each other", remedy: "ungroup them" },
    attributes: Limit { most: 200, of: "attributes of an element", remedy: "save it as plain SVG" },
    piece: Limit { most: 64 << 20, of: "bytes in a tag or text", remedy: "save it as plain SVG" },
};
/// Numbers of a transform above this lead nowhere: arcs take longer the larger they are.
pub(super) const LARGEST: f64 = 1e9;
/// Advice for unsupported features.
pub(super) const INTO_PATHS: &str = "turn everything into paths in the drawing program";

/// A shape that is drawn.
#[derive(Debug)]
pub struct SvgShape<'s> {
    /// Its element: a path, rect, circle, ellipse, polygon, polyline or line.
    pub tag: &'s Tag<'s>,
    /// From its coordinates to those of the picture, y down.
    pub frame: Affine,
    /// Byte range of the nearest enclosing transform, if any.
    pub moved: Option<Range<usize>>,
}

/// Why a picture, or a part of it, is not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnsupportedSvg {
    /// Byte range in the text.
    pub at: Range<usize>,
    /// The unsupported feature.
    pub message: String,
    /// Advice.
    pub help: &'static str,
}

impl UnsupportedSvg {
    pub(super) fn overspent(at: Range<usize>, overspent: Overspent) -> Self {
        let Limit { most, of, remedy } = overspent.limit;
        Self { at, message: format!("more than {most} {of}"), help: remedy }
    }

    fn broken(error: &XmlError) -> Self {
        if let Some(over) = error.over {
            return Self::overspent(error.at..error.at, over);
        }
        let message = format!("this is no SVG picture: {}", error.message);
        Self { at: error.at..error.at, message, help: "save it again from the drawing program" }
    }

    pub(super) fn element(tag: &Tag<'_>, what: &str, help: &'static str) -> Self {
        Self { at: tag.head(), message: format!("<{}> {what}", crate::design::shortened(tag.name())), help }
    }
}

/// The attributes of the picture itself, by their full names, each with its place.
///
/// # Errors
/// If the text does not begin like an SVG picture.
pub fn head(text: &str) -> Result<BTreeMap<&'static str, (String, Range<usize>)>, UnsupportedSvg> {
    const READ: [&str; 5] = ["width", "height", "viewBox", "preserveAspectRatio", "data-unit"];
    let mut walk = Walk::new(text.as_bytes(), LIMITS);
    loop {
        match walk.next().map_err(|error| UnsupportedSvg::broken(&error))? {
            Some(Piece::Start(tag)) => {
                let own = |name| {
                    let XmlAttribute { value, span } = tag.attribute(name)?;
                    Some((name, (value.into_owned(), span)))
                };
                return Ok(READ.into_iter().filter_map(own).collect());
            }
            Some(_) => {}
            None => return Ok(BTreeMap::new()),
        }
    }
}

/// Gives every shape that is drawn, and every reason why something is not read, in the order of the picture, until `each` breaks; how many elements with
/// all that is in them are hidden.
pub fn shapes(
    text: &str,
    mut each: impl FnMut(Result<SvgShape<'_>, UnsupportedSvg>) -> ControlFlow<()>,
) -> usize {
    let mut sheet = match sheets(text) {
        Ok(sheet) => sheet,
        Err(refusal) => {
            let _ = each(Err(refusal));
            return 0;
        }
    };
    let mut walk = Walk::new(text.as_bytes(), LIMITS);
    let mut open: Vec<Open> = Vec::new();
    let mut own = Prefixes::default();
    // Elements of which nothing is drawn, and how many are open within them.
    let (mut hidden, mut skipped) = (0, 0_usize);
    loop {
        let flow = match walk.next() {
            Err(error) => {
                let _ = each(Err(UnsupportedSvg::broken(&error)));
                return hidden;
            }
            Ok(None) => return hidden,
            Ok(Some(Piece::Text(..))) => continue,
            Ok(Some(Piece::End)) => {
                if skipped > 0 {
                    skipped -= 1;
                } else {
                    open.pop();
                }
                continue;
            }
            Ok(Some(Piece::Start(_))) if skipped > 0 => {
                skipped += 1;
                continue;
            }
            Ok(Some(Piece::Start(tag))) => {
                if tag.is_root() {
                    own = Prefixes::of(&tag);
                }
                match entered(&tag, open.last(), &own, &mut sheet) {
                    Ok(Entered::Left(is_hidden)) => {
                        hidden += usize::from(is_hidden);
                        skipped = 1;
                        continue;
                    }
                    Ok(Entered::Open(inner)) => {
                        let flow = if SHAPES.contains(&tag.name()) {
                            each(Ok(SvgShape { tag: &tag, frame: inner.frame, moved: inner.moved.clone() }))
                        } else {
                            ControlFlow::Continue(())
                        };
                        open.push(inner);
                        flow
                    }
                    Err(refusal) => {
                        skipped = 1;
                        each(Err(refusal))
                    }
                }
            }
        };
        if flow.is_break() {
            return hidden;
        }
    }
}

/// The style sheets of a picture, wherever they stand in it.
fn sheets(text: &str) -> Result<Sheet, UnsupportedSvg> {
    let mut sheet = Sheet::default();
    // A picture without the word has no style sheet.
    if !text.contains("style") {
        return Ok(sheet);
    }
    let mut walk = Walk::new(text.as_bytes(), LIMITS);
    let (mut depth, mut style) = (0_usize, None);
    // A syntax error is reported later, when the shapes are read.
    while let Ok(Some(piece)) = walk.next() {
        match piece {
            Piece::Start(tag) => {
                depth += 1;
                if tag.name() == "style" && style.is_none() {
                    let other = tag
                        .attribute("media")
                        .filter(|own| !["", "all", "screen"].contains(&own.value.trim()));
                    if let Some(media) = other {
                        let message = format!(
                            "a style sheet for `{}` is not read",
                            crate::design::shortened(&media.value)
                        );
                        return Err(UnsupportedSvg {
                            at: media.span,
                            message,
                            help: "write the style on the elements",
                        });
                    }
                    style = Some(depth);
                }
            }
            Piece::End => {
                if style == Some(depth) {
                    style = None;
                }
                depth = depth.saturating_sub(1);
            }
            Piece::Text(text, at) => {
                if style.is_some() {
                    sheet.add(&text, at)?;
                }
            }
        }
    }
    Ok(sheet)
}
