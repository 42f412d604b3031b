//! A streaming XML reader: tags and texts, one at a time, within limits; and the visible shapes of an SVG
//! picture ([`svg`]).
//!
//! ```text
//! bytes ──▶ <a x="1"> ──▶ text ──▶ </a>      one tokenizer; attributes, depth, elements and bytes of a piece are counted on its own tokens
//! ```
//!
//! Only the current piece is kept, so that a document of any size needs no more memory than its longest
//! piece. Document types are rejected, and with them entities that expand.
//!
//! Not promised: namespaces are not resolved, and malformed text is rejected only if it would change the
//! tags.

mod element;
mod style;
pub mod svg;

use catchment_base::budget::{Budget, Limit, Overspent};
use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};
use std::borrow::Cow;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::Range;

/// Limits of a document.
#[derive(Debug, Clone, Copy)]
pub struct XmlLimits {
    /// Elements.
    pub elements: Limit,
    /// Elements within each other.
    pub depth: Limit,
    /// Attributes of an element.
    pub attributes: Limit,
    /// Bytes of a tag, a text or a comment.
    pub piece: Limit,
}

/// An error of a document, with its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct XmlError {
    /// Byte at which the piece begins, from 0.
    pub at: usize,
    /// Description, with a remedy if there is one.
    pub message: String,
    /// The limit, if the error is an exceeded limit.
    pub over: Option<Overspent>,
}

impl XmlError {
    fn broken(at: usize, message: &impl ToString) -> Self {
        Self { at, message: message.to_string(), over: None }
    }

    fn overspent(at: usize, over: Overspent) -> Self {
        Self { at, message: over.to_string(), over: Some(over) }
    }
}

/// A piece of a document.
#[derive(Debug)]
pub enum Piece<'b> {
    /// Start of an element. An empty element ends with the next piece.
    Start(Tag<'b>),
    /// An element ends.
    End,
    /// Text between tags as it is written, entities not replaced, and the byte at which it begins.
    Text(String, usize),
}

/// The beginning of an element.
#[derive(Debug)]
pub struct Tag<'b> {
    start: BytesStart<'static>,
    parent: Option<&'b [u8]>,
    /// Its byte range in the document.
    span: Range<usize>,
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct XmlAttribute<'t> {
    /// With its entities replaced.
    pub value: Cow<'t, str>,
    /// Its byte range in the document, without quotes.
    pub span: Range<usize>,
}

impl<'b> Tag<'b> {
    fn of(
        start: BytesStart<'static>,
        parent: Option<&'b [u8]>,
        span: Range<usize>,
        most: Limit,
    ) -> Result<Self, XmlError> {
        let at = span.start;
        // Each is compared with those before it, of which there are no more than the limit.
        for (attribute, count) in start.attributes().zip(1..) {
            most.allows(count).map_err(|over| XmlError::overspent(at, over))?;
            let attribute = attribute.map_err(|error| XmlError::broken(at, &error))?;
            if attribute.value.contains(&b'&') {
                unescape(&String::from_utf8_lossy(&attribute.value))
                    .map_err(|error| XmlError::broken(at, &error))?;
            }
        }
        Ok(Self { start, parent, span })
    }

    /// Its name without a prefix.
    pub fn name(&self) -> &str {
        std::str::from_utf8(self.start.local_name().into_inner()).unwrap_or_default()
    }

    /// The prefix of its name.
    pub fn prefix(&self) -> Option<&str> {
        self.start.name().prefix().map(|prefix| std::str::from_utf8(prefix.into_inner()).unwrap_or_default())
    }

    /// Its start, from `<` to the end of its name.
    pub fn head(&self) -> Range<usize> {
        let end = self.span.start + 1 + self.start.name().into_inner().len();
        self.span.start..end.min(self.span.end)
    }

    /// Whether the element around it has this name, without a prefix.
    pub fn is_within(&self, parent: &str) -> bool {
        self.parent.is_some_and(|own| own == parent.as_bytes())
    }

    /// Whether nothing is around it.
    pub const fn is_root(&self) -> bool {
        self.parent.is_none()
    }

    /// The attribute whose whole name this is.
    pub fn attribute(&self, name: &str) -> Option<XmlAttribute<'_>> {
        self.find(|key| key == name.as_bytes())
    }

    /// The first attribute with this name behind any prefix.
    pub fn local_attribute(&self, name: &str) -> Option<XmlAttribute<'_>> {
        let local = |key: &[u8]| key.iter().position(|byte| *byte == b':').map_or(0, |colon| colon + 1);
        self.find(|key| &key[local(key)..] == name.as_bytes())
    }

    fn find(&self, is_meant: impl Fn(&[u8]) -> bool) -> Option<XmlAttribute<'_>> {
        // All of them were read when the tag was.
        let own =
            self.start.attributes().with_checks(false).flatten().find(|own| is_meant(own.key.as_ref()))?;
        let offset = (own.value.as_ptr() as usize).saturating_sub(self.start.as_ptr() as usize);
        let start = self.span.start + 1 + offset;
        let span = start.min(self.span.end)..(start + own.value.len()).min(self.span.end);
        let written = match own.value {
            Cow::Borrowed(bytes) => String::from_utf8_lossy(bytes),
            Cow::Owned(bytes) => Cow::Owned(String::from_utf8_lossy(&bytes).into_owned()),
        };
        let value = match unescape(&written) {
            Ok(Cow::Owned(plain)) => Cow::Owned(plain),
            _ => written,
        };
        Some(XmlAttribute { value, span })
    }
}

/// A reader that ends if a piece is too long.
struct Metered<R> {
    inner: BufReader<R>,
    piece: u64,
    most: Limit,
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: Read> BufRead for Metered<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.most.allows(self.piece).map_err(io::Error::other)?;
        self.inner.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.piece += count as u64;
        self.inner.consume(count);
    }
}

/// The pieces of a document, in order.
pub struct Walk<R> {
    reader: Reader<Metered<R>>,
    buffer: Vec<u8>,
    /// Names of the elements that are open.
    open: Vec<Vec<u8>>,
    elements: Budget,
    limits: XmlLimits,
}

impl<R: Read> Walk<R> {
    /// From its beginning.
    pub fn new(document: R, limits: XmlLimits) -> Self {
        let metered = Metered { inner: BufReader::new(document), piece: 0, most: limits.piece };
        let mut reader = Reader::from_reader(metered);
        reader.config_mut().expand_empty_elements = true;
        Self { reader, buffer: Vec::new(), open: Vec::new(), elements: Budget::new(limits.elements), limits }
    }

    /// The next piece; `None` at the end of a document.
    ///
    /// # Errors
    /// If the document is malformed, truncated, or exceeds a limit. Do not continue after that.
    #[expect(clippy::should_implement_trait, reason = "a piece borrows from the walk")]
    pub fn next(&mut self) -> Result<Option<Piece<'_>>, XmlError> {
        loop {
            self.reader.get_mut().piece = 0;
            self.buffer.clear();
            let at = self.reader.buffer_position() as usize;
            let located = |message: &str| XmlError::broken(at, &message);
            let over = |over: Overspent| XmlError::overspent(at, over);
            let event = self.reader.read_event_into(&mut self.buffer);
            if let Err(too_long) = self.limits.piece.allows(self.reader.get_ref().piece) {
                return Err(over(too_long));
            }
            match event.map_err(|error| XmlError::broken(at, &error))? {
                Event::Start(start) => {
                    let is_second = self.open.is_empty() && self.elements.left() < self.limits.elements.most;
                    if is_second {
                        return Err(located("something follows the end of the document"));
                    }
                    self.elements.spend(1).map_err(over)?;
                    self.limits.depth.allows(self.open.len() as u64 + 1).map_err(over)?;
                    self.open.push(start.local_name().into_inner().to_vec());
                    let start = start.into_owned();
                    let span = at..self.reader.buffer_position() as usize;
                    let parent = self.open.len().checked_sub(2).map(|k| self.open[k].as_slice());
                    let tag = Tag::of(start, parent, span, self.limits.attributes)?;
                    return Ok(Some(Piece::Start(tag)));
                }
                Event::End(_) => {
                    self.open.pop();
                    return Ok(Some(Piece::End));
                }
                Event::Text(text) => {
                    return Ok(Some(Piece::Text(String::from_utf8_lossy(&text).into_owned(), at)));
                }
                Event::CData(text) => {
                    let text = String::from_utf8_lossy(&text).into_owned();
                    return Ok(Some(Piece::Text(text, at + "<![CDATA[".len())));
                }
                Event::DocType(_) => {
                    return Err(located("a document type has no place in it: delete <!DOCTYPE …>"));
                }
                Event::Eof if !self.open.is_empty() => return Err(located("it was cut off")),
                Event::Eof if self.elements.left() == self.limits.elements.most => {
                    return Err(located("there is no XML in it"));
                }
                Event::Eof => return Ok(None),
                _ => {}
            }
        }
    }
}
