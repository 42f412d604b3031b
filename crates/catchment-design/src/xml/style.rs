//! The part of CSS that decides whether a shape of a picture is drawn: the properties of an element from its
//! attributes, its `style`, and the rules of `<style>` elements.
//!
//! ```text
//! attribute < rules, by specificity and order < style="…"        of an element; inherited values come from the surrounding element
//! ```
//!
//! Selectors are lists of a name, `*`, `.class` and `#id`, joined as in `path.hole`. A rule with another
//! selector, with `!important`, or for a specific medium is rejected if it has a property that affects
//! shapes, and is ignored if not.

use super::Tag;
use super::svg::UnsupportedSvg;
use catchment_base::budget::{Budget, Limit};
use std::borrow::Cow;
use std::ops::Range;

/// Properties that hide, and those that the reader of a shape has to know of.
const PROPERTIES: [&str; 26] = [
    "display",
    "visibility",
    "opacity",
    "fill",
    "stroke",
    "fill-opacity",
    "stroke-opacity",
    "stroke-width",
    "clip-path",
    "mask",
    "filter",
    "transform",
    "transform-origin",
    "transform-box",
    "translate",
    "rotate",
    "scale",
    "offset-path",
    "content-visibility",
    "d",
    "x",
    "y",
    "cx",
    "cy",
    "r",
    "all",
];
/// Most selectors of all style sheets together.
const SELECTORS: Limit =
    Limit { most: 2000, of: "selectors in style sheets", remedy: "write the styles on the elements" };
/// Steps of comparing elements with selectors.
const STEPS: Limit = Limit {
    most: 20_000_000,
    of: "comparisons of elements with the selectors of style sheets",
    remedy: "write the styles on the elements",
};

/// A property and its value, in lower case.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Declaration {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) span: Range<usize>,
}

#[derive(Debug, Default)]
struct Selector {
    name: Option<String>,
    classes: Vec<String>,
    id: Option<String>,
}

impl Selector {
    /// As CSS counts it: ids, classes, names.
    fn specificity(&self) -> [usize; 3] {
        [usize::from(self.id.is_some()), self.classes.len(), usize::from(self.name.is_some())]
    }

    /// From its text; `None` if it is of another kind.
    fn parse(text: &str) -> Option<Self> {
        let mut selector = Self::default();
        let is_word = |c: char| c.is_alphanumeric() || c == '-' || c == '_' || !c.is_ascii();
        let mut rest = text.strip_prefix('*').unwrap_or(text);
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        if end > 0 {
            if text.starts_with('*') {
                return None;
            }
            selector.name = Some(rest[..end].to_owned());
        }
        rest = &rest[end..];
        while !rest.is_empty() {
            let word = &rest[1..];
            let end = word.find(|c| !is_word(c)).unwrap_or(word.len());
            match (rest.as_bytes()[0], end) {
                (_, 0) => return None,
                (b'.', _) => selector.classes.push(word[..end].to_owned()),
                (b'#', _) if selector.id.is_none() => selector.id = Some(word[..end].to_owned()),
                _ => return None,
            }
            rest = &word[end..];
        }
        (!text.is_empty()).then_some(selector)
    }
}

struct Rule {
    selector: Selector,
    declarations: Vec<Declaration>,
}

/// The style sheets of a picture.
pub(super) struct Sheet {
    /// Of lowest precedence first.
    rules: Vec<Rule>,
    selectors: Budget,
    steps: Budget,
}

impl Default for Sheet {
    fn default() -> Self {
        Self { rules: Vec::new(), selectors: Budget::new(SELECTORS), steps: Budget::new(STEPS) }
    }
}

impl Sheet {
    /// Adds the text of a `<style>` element that begins at a byte of the picture.
    pub(super) fn add(&mut self, text: &str, start: usize) -> Result<(), UnsupportedSvg> {
        let text = without_comments(text);
        let mut at = 0;
        while at < text.len() {
            let Some(opens) = text[at..].find(['{', ';']).map(|k| at + k) else { break };
            let head = &text[at..opens];
            let begins = at + (head.len() - head.trim_start().len());
            let head = head.trim();
            let is_statement = text.as_bytes()[opens] == b';';
            let end = if is_statement { opens + 1 } else { end_of_block(&text, opens) };
            let span = start + begins..start + begins + head.len();
            // A block that nothing ends reaches to the end of the sheet.
            let body = &text[opens + 1..end];
            let body = body.strip_suffix('}').unwrap_or(body);
            at = end;
            if head.starts_with('@') {
                at_rule(head, body, span)?;
                continue;
            }
            if is_statement {
                continue;
            }
            let declared = declarations(body, start + opens + 1)?;
            if declared.is_empty() {
                continue;
            }
            for selector in head.split(',').map(str::trim) {
                let parsed = Selector::parse(selector).ok_or_else(|| UnsupportedSvg {
                    at: span.clone(),
                    message: format!(
                        "the style of `{}` decides what is drawn, and only names, .classes and #ids are read as selectors",
                        crate::design::shortened(selector)
                    ),
                    help: "write the style on the elements",
                })?;
                self.selectors.spend(1).map_err(|over| UnsupportedSvg::overspent(span.clone(), over))?;
                self.rules.push(Rule { selector: parsed, declarations: declared.clone() });
            }
        }
        // A stable sort: of equal rules the later counts.
        self.rules.sort_by_key(|rule| rule.selector.specificity());
        Ok(())
    }

    /// The properties of an element in their order of precedence, the strongest last; without attributes of their names.
    pub(super) fn declared(&mut self, tag: &Tag<'_>) -> Result<Vec<Declaration>, UnsupportedSvg> {
        let text = |name: &str| tag.attribute(name).map(|own| own.value);
        let mut result = Vec::new();
        if !self.rules.is_empty() {
            let class = text("class").unwrap_or_default();
            let classes: Vec<&str> = class.split_ascii_whitespace().collect();
            let id = text("id");
            let steps = self.rules.len() as u64 * (1 + classes.len() as u64);
            self.steps.spend(steps).map_err(|over| UnsupportedSvg::overspent(tag.head(), over))?;
            let matches = |selector: &Selector| {
                selector.name.as_ref().is_none_or(|name| name == tag.name())
                    && selector.id.as_ref().is_none_or(|own| id.as_deref() == Some(own))
                    && selector.classes.iter().all(|class| classes.contains(&class.as_str()))
            };
            let meant = self.rules.iter().filter(|rule| matches(&rule.selector));
            result.extend(meant.flat_map(|rule| rule.declarations.iter().cloned()));
        }
        if let Some(own) = tag.attribute("style") {
            result.extend(declarations(&own.value, own.span.start)?);
        }
        Ok(result)
    }
}

/// A rule of the sheet as a whole.
fn at_rule(head: &str, body: &str, at: Range<usize>) -> Result<(), UnsupportedSvg> {
    let imports = head.starts_with("@import");
    let of_no_consequence =
        ["@charset", "@namespace", "@font-face", "@page"].iter().any(|known| head.starts_with(known));
    let decides = PROPERTIES.iter().any(|name| body.contains(name));
    if imports || decides && !of_no_consequence {
        let message = format!("the rule `{}` of a style sheet is not read", crate::design::shortened(head));
        return Err(UnsupportedSvg { at, message, help: "write the style on the elements" });
    }
    Ok(())
}

/// The relevant properties of a block; `start` is its position in the picture.
pub(super) fn declarations(block: &str, start: usize) -> Result<Vec<Declaration>, UnsupportedSvg> {
    let block = without_comments(block);
    let mut result = Vec::new();
    let mut at = 0;
    while at < block.len() {
        let end = end_of_declaration(&block, at);
        let written = &block[at..end];
        let span = start + at..start + end;
        at = end + 1;
        let Some((name, value)) = written.split_once(':') else { continue };
        let name = name.trim().to_ascii_lowercase();
        let Some(name) = PROPERTIES.iter().find(|known| **known == name) else { continue };
        let value = value.trim().to_ascii_lowercase();
        if value.contains('!') || value.contains("var(") {
            let message = format!("`{name}: {}` is not read", crate::design::shortened(&value));
            return Err(UnsupportedSvg {
                at: span,
                message,
                help: "write a plain value without !important and var()",
            });
        }
        result.push(Declaration { name, value, span });
    }
    Ok(result)
}

/// The same text with blanks in the place of comments, byte for byte.
fn without_comments(text: &str) -> Cow<'_, str> {
    if !text.contains("/*") {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(begins) = rest.find("/*") {
        let ends = rest[begins + 2..].find("*/").map_or(rest.len(), |k| begins + 2 + k + 2);
        plain.push_str(&rest[..begins]);
        plain.extend(std::iter::repeat_n(' ', ends - begins));
        rest = &rest[ends..];
    }
    plain.push_str(rest);
    Cow::Owned(plain)
}

/// End of the block that opens at a byte, after its brace; the end of the text if it is not closed.
fn end_of_block(text: &str, opens: usize) -> usize {
    let (mut depth, mut quote) = (0_usize, None);
    for (k, byte) in text.bytes().enumerate().skip(opens) {
        match (quote, byte) {
            (Some(open), byte) if open == byte => quote = None,
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'{') => depth += 1,
            (None, b'}') => {
                depth -= 1;
                if depth == 0 {
                    return k + 1;
                }
            }
            _ => {}
        }
    }
    text.len()
}

/// End of the declaration that begins at a byte: at a semicolon outside of quotes and parentheses.
fn end_of_declaration(text: &str, begins: usize) -> usize {
    let (mut depth, mut quote) = (0_usize, None);
    for (k, byte) in text.bytes().enumerate().skip(begins) {
        match (quote, byte) {
            (Some(open), byte) if open == byte => quote = None,
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'(') => depth += 1,
            (None, b')') => depth = depth.saturating_sub(1),
            (None, b';') if depth == 0 => return k,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selectors_are_names_classes_and_ids() {
        let of = |text: &str| Selector::parse(text).map(|selector| selector.specificity());
        assert_eq!(of("path"), Some([0, 0, 1]));
        assert_eq!(of("*"), Some([0, 0, 0]));
        assert_eq!(of("path.a.b#c"), Some([1, 2, 1]));
        assert_eq!(of(".st0"), Some([0, 1, 0]));
        for other in ["", "g path", "g>path", "path:hover", "[id]", ".", "#", "*x", "#a#b", "a\\b"] {
            assert_eq!(of(other), None, "{other}");
        }
    }

    #[test]
    fn a_block_that_nothing_ends_reaches_to_the_end() {
        let added = |text: &str| {
            let mut sheet = Sheet::default();
            sheet.add(text, 0).unwrap();
            sheet.rules.iter().map(|rule| rule.declarations[0].value.clone()).collect::<Vec<_>>()
        };
        assert_eq!(added("a{display:none}b{display:inline"), ["none", "inline"]);
        assert_eq!(added("a{display:none;x:\"\u{fffd}"), ["none"]);
        assert_eq!(added("a{"), [""; 0]);
    }

    #[test]
    fn declarations_are_split_where_css_splits_them() {
        let names = |text: &str| {
            let result = declarations(text, 0).unwrap();
            result.into_iter().map(|d| format!("{}={}", d.name, d.value)).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(names("fill: RED ;display:none"), "fill=red display=none");
        assert_eq!(
            names("/* display:none; */fill:url(data:a;display:none)"),
            "fill=url(data:a;display:none)"
        );
        assert_eq!(names("fill:';display:none'; colour:red; nonsense"), "fill=';display:none'");
        assert!(declarations("display:none !important", 0).is_err());
        // Broken ends end somewhere.
        for broken in ["fill:'", "fill:(", "/*", ":", ";;", "display"] {
            names(broken);
            let mut sheet = Sheet::default();
            let _ = sheet.add(broken, 0);
            let _ = sheet.add(&format!("a {{{broken}"), 0);
        }
    }

    #[test]
    fn sheets_are_read_or_refused() {
        let refused =
            |text: &str| Sheet::default().add(text, 7).err().map(|refusal| (refusal.message, refusal.at));
        assert_eq!(
            refused(".a, path { display: none } @font-face { src: url(x) } g > b { font-size: 3 }"),
            None
        );
        let (message, at) = refused("g > path { display: none }").unwrap();
        assert!(message.contains("`g > path`") && at == (7..15), "{message} {at:?}");
        assert!(refused("@media print { .a { display: none } }").unwrap().0.contains("@media print"));
        assert!(refused("@import url(a.css);").is_some());
        assert_eq!(refused("@media print { .a { font-size: 3 } }"), None);
        let many = ".a{display:none}".repeat(2001);
        assert!(refused(&many).unwrap().0.starts_with("more than 2000 selectors"));
    }
}
