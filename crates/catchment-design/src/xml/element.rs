//! An element of a picture: its inherited properties, its visibility, and its unsupported features that would
//! change the picture.

use super::style::{Declaration, Sheet};
use super::svg::{HOLDERS, INTO_PATHS, LARGEST, NAMESPACE, NOT_DRAWN, SHAPES, UnsupportedSvg};
use super::{Tag, XmlAttribute};
use kurbo::{Affine, Vec2};
use std::ops::Range;
use std::str::FromStr;
use svgtypes::Transform;

/// Prefixes under which the elements of the picture stand.
#[derive(Default)]
pub(super) struct Prefixes {
    root: Option<String>,
    others: Vec<String>,
}

impl Prefixes {
    pub(super) fn of(root: &Tag<'_>) -> Self {
        // The usual prefix, if the root binds it.
        let bound = ["svg"].iter().filter(|prefix| {
            root.attribute(&format!("xmlns:{prefix}")).is_some_and(|own| own.value == NAMESPACE)
        });
        Self { root: root.prefix().map(ToOwned::to_owned), others: bound.map(ToString::to_string).collect() }
    }

    /// Whether an element belongs to SVG.
    fn has(&self, tag: &Tag<'_>) -> bool {
        let prefix = tag.prefix();
        let is_bound = prefix.is_none()
            || prefix == self.root.as_deref()
            || self.others.iter().any(|own| Some(own.as_str()) == prefix);
        is_bound && tag.attribute("xmlns").is_none_or(|own| own.value == NAMESPACE || tag.is_root())
    }
}

/// An open element, and the properties that its members inherit.
#[derive(Clone, Default)]
pub(super) struct Open {
    pub(super) frame: Affine,
    pub(super) moved: Option<Range<usize>>,
    is_hidden: bool,
    /// Whether it, or an enclosing element, is invisible by its opacity.
    is_clear: bool,
    fill: Paint,
    stroke: Paint,
    has_no_width: bool,
}

/// Whether a fill or a stroke paints nothing.
#[derive(Clone, Copy, Default)]
struct Paint {
    is_none: bool,
    is_clear: bool,
}

impl Paint {
    const fn shows(self) -> bool {
        !self.is_none && !self.is_clear
    }
}

/// Handling of an element.
pub(super) enum Entered {
    /// Draws nothing: whether because it is hidden.
    Left(bool),
    Open(Open),
}

/// Enters an element; unsupported features are rejected.
pub(super) fn entered(
    tag: &Tag<'_>,
    outer: Option<&Open>,
    own: &Prefixes,
    sheet: &mut Sheet,
) -> Result<Entered, UnsupportedSvg> {
    let name = tag.name();
    let is_root = tag.is_root();
    let is_shape = SHAPES.contains(&name);
    let is_holder = HOLDERS.contains(&name) && (is_root || name != "svg");
    if !own.has(tag) {
        return if is_shape || HOLDERS.contains(&name) {
            Err(UnsupportedSvg::element(tag, "of another namespace is not read", "save it as plain SVG"))
        } else {
            Ok(Entered::Left(false))
        };
    }
    if NOT_DRAWN.contains(&name) {
        return Ok(Entered::Left(false));
    }
    let inherited = outer
        .cloned()
        .unwrap_or_else(|| Open { stroke: Paint { is_none: true, is_clear: false }, ..Open::default() });
    let style = Style { declared: sheet.declared(tag)?, tag };
    if style.value("display").is_some_and(|(value, _)| value == "none") {
        return Ok(Entered::Left(true));
    }
    if !is_shape && !is_holder {
        return Err(UnsupportedSvg::element(tag, "is not read", INTO_PATHS));
    }
    let mut open = style.inherited(&inherited);
    if is_shape && open.is_hidden {
        return Ok(Entered::Left(true));
    }
    if is_shape && (open.is_clear || !(open.fill.shows() || open.stroke.shows() && !open.has_no_width)) {
        let what = if open.is_clear { "has an opacity of 0" } else { "has neither a fill nor a stroke" };
        let message = format!("<{name}> {what}, so that nothing shows whether it is meant");
        let help = "give it a stroke, delete it, or hide it with display=\"none\"";
        return Err(UnsupportedSvg { at: tag.head(), message, help });
    }
    style.refuse_changes(is_shape)?;
    for condition in ["systemLanguage", "requiredExtensions", "requiredFeatures"] {
        if let Some(result) = tag.attribute(condition) {
            let message = format!("`{condition}` is not read, which draws an element for some readers only");
            return Err(UnsupportedSvg {
                at: result.span,
                message,
                help: "delete the attribute, or the element",
            });
        }
    }
    if let Some((map, at)) = style.transform()? {
        open.frame = inherited.frame * map;
        open.moved = Some(at.clone());
        if !open.frame.as_coeffs().iter().all(|c| c.abs() <= LARGEST) {
            let message = "its transform moves it far too far".to_owned();
            return Err(UnsupportedSvg { at, message, help: "check the unit of the picture" });
        }
    }
    Ok(Entered::Open(open))
}

/// The properties of an element.
struct Style<'t, 'b> {
    declared: Vec<Declaration>,
    tag: &'t Tag<'b>,
}

impl Style<'_, '_> {
    /// The value of a property that may be an attribute as well.
    fn value(&self, name: &str) -> Option<(String, Range<usize>)> {
        if let Some(own) = self.declared.iter().rev().find(|own| own.name == name) {
            return Some((own.value.clone(), own.span.clone()));
        }
        let XmlAttribute { value, span } = self.tag.attribute(name)?;
        Some((value.trim().to_ascii_lowercase(), span))
    }

    /// The properties that members inherit from the element.
    fn inherited(&self, outer: &Open) -> Open {
        let mut open = outer.clone();
        let value = |name| self.value(name).map(|(value, _)| value).filter(|value| value != "inherit");
        match value("visibility").as_deref() {
            Some("hidden" | "collapse") => open.is_hidden = true,
            Some("visible" | "initial") => open.is_hidden = false,
            _ => {}
        }
        open.is_clear |= value("opacity").is_some_and(|value| is_zero(&value));
        let is_none = |value: &str| ["none", "transparent"].contains(&value);
        let paints =
            [("fill", "fill-opacity", &mut open.fill), ("stroke", "stroke-opacity", &mut open.stroke)];
        for (name, opacity, paint) in paints {
            if let Some(value) = value(name) {
                paint.is_none = is_none(&value);
            }
            if let Some(value) = value(opacity) {
                paint.is_clear = is_zero(&value);
            }
        }
        if let Some(value) = value("stroke-width") {
            open.has_no_width = is_zero(&value);
        }
        open
    }

    /// Rejects properties that change the drawing.
    fn refuse_changes(&self, is_shape: bool) -> Result<(), UnsupportedSvg> {
        let refused = |name: &str, value: &str, at: Range<usize>, help| {
            let message = format!(
                "`{name}` of <{}> is not read: `{}`",
                self.tag.name(),
                crate::design::shortened(value)
            );
            Err(UnsupportedSvg { at, message, help })
        };
        for name in ["clip-path", "mask", "filter"] {
            if let Some((value, at)) = self.value(name).filter(|(value, _)| value != "none") {
                return refused(name, &value, at, "release the clip, mask or filter in the drawing program");
            }
        }
        // As attributes they are read, or mean nothing.
        let by_style =
            |name: &str| self.declared.iter().rev().find(|own| own.name == name && own.value != "none");
        for name in ["transform", "translate", "rotate", "scale", "offset-path", "content-visibility", "all"]
        {
            if let Some(Declaration { value, span, .. }) = by_style(name) {
                return refused(name, value, span.clone(), "apply the transforms in the drawing program");
            }
        }
        if is_shape {
            for name in ["d", "x", "y", "cx", "cy", "r"] {
                if let Some(Declaration { value, span, .. }) = by_style(name) {
                    return refused(name, value, span.clone(), "write it as an attribute, not as a style");
                }
            }
        }
        Ok(())
    }

    /// Its transform about its origin, and the place of it.
    fn transform(&self) -> Result<Option<(Affine, Range<usize>)>, UnsupportedSvg> {
        let Some(XmlAttribute { value, span }) = self.tag.attribute("transform") else { return Ok(None) };
        let t = Transform::from_str(&value).map_err(|error| UnsupportedSvg {
            at: span.clone(),
            message: format!("its transform cannot be read: {error}"),
            help: "apply the transforms in the drawing program",
        })?;
        let map = Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]);
        let Some((origin, at)) = self.value("transform-origin") else { return Ok(Some((map, span))) };
        let numbers: Option<Vec<f64>> = origin
            .split_ascii_whitespace()
            .map(|word| word.trim_end_matches("px").parse().ok().filter(|n: &f64| n.abs() <= LARGEST))
            .collect();
        let (Some([x, y]), None) = (numbers.as_deref(), self.value("transform-box")) else {
            let message = format!(
                "`transform-origin` is read as two plain numbers, not as `{}`",
                crate::design::shortened(&origin)
            );
            return Err(UnsupportedSvg { at, message, help: "apply the transforms in the drawing program" });
        };
        let about = Vec2::new(*x, *y);
        Ok(Some((Affine::translate(about) * map * Affine::translate(-about), span)))
    }
}

fn is_zero(value: &str) -> bool {
    value
        .trim_end_matches(|c: char| c == '%' || c.is_ascii_alphabetic())
        .parse::<f64>()
        .is_ok_and(|number| number <= 0.0)
}
