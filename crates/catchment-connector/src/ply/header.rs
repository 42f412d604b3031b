//! The header of a PLY file: its dialect, and the properties of its elements.

use catchment_base::budget::Limit;

/// Bytes of a head: those that exporters write have hundreds.
const BYTES: Limit =
    Limit { most: 1 << 20, of: "bytes in the header", remedy: "export the mesh without comments" };
/// Elements and properties of a head.
const ENTRIES: Limit = Limit {
    most: 1000,
    of: "elements and properties in the header",
    remedy: "export vertices and faces alone",
};

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Int { bytes: usize, is_signed: bool },
    Float { bytes: usize },
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::Int { bytes: 1, is_signed: true },
            "uchar" | "uint8" => Self::Int { bytes: 1, is_signed: false },
            "short" | "int16" => Self::Int { bytes: 2, is_signed: true },
            "ushort" | "uint16" => Self::Int { bytes: 2, is_signed: false },
            "int" | "int32" => Self::Int { bytes: 4, is_signed: true },
            "uint" | "uint32" => Self::Int { bytes: 4, is_signed: false },
            "float" | "float32" => Self::Float { bytes: 4 },
            "double" | "float64" => Self::Float { bytes: 8 },
            _ => return None,
        })
    }

    /// Bytes of a number of a binary body.
    pub(super) const fn bytes(self) -> usize {
        match self {
            Self::Int { bytes, .. } | Self::Float { bytes } => bytes,
        }
    }

    pub(super) const fn is_float(self) -> bool {
        matches!(self, Self::Float { .. })
    }
}

/// A number of every element of a kind, or a list of them.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Type of the length of a list.
    pub(super) count: Option<Kind>,
}

/// Elements of a kind.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Line of its declaration in the header, from 1.
    pub(super) line: usize,
}

impl Element {
    /// Smallest number of bytes of such an element in a body.
    fn least_bytes(&self, dialect: Dialect) -> u64 {
        let of = |own: &Property| own.count.unwrap_or(own.kind).bytes() as u64;
        match dialect {
            // Each value needs at least one character and a separator.
            Dialect::Text => 2 * self.properties.len() as u64 - 1,
            _ => self.properties.iter().map(of).sum(),
        }
    }
}

/// The head of a file.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) dialect: Dialect,
    pub(super) elements: Vec<Element>,
    /// Start of the body: its byte from 0, its line from 1.
    pub(super) end: usize,
    pub(super) lines: usize,
}

impl Header {
    /// Reads the head of a file, of which every element takes a byte of the file at least.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        let (mut dialect, mut elements): (_, Vec<Element>) = (None, Vec::new());
        let (mut at, mut line, mut entries) = (0, 0, 0);
        loop {
            let rest = &bytes[at..];
            let Some(end) = rest.iter().position(|byte| *byte == b'\n') else {
                return Err(format!("line {}: the header has no end: it was cut off", line + 1));
            };
            at += end + 1;
            line += 1;
            let located = |message: &str| Err(format!("line {line}: {message}"));
            BYTES.allows(at as u64).map_err(|over| format!("line {line}: {over}"))?;
            let Ok(text) = std::str::from_utf8(&rest[..end]) else {
                return located("the header is not text");
            };
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            match words[..] {
                ["ply"] if line == 1 => {}
                _ if line == 1 => return located("expected `ply`"),
                ["format", name, _] => {
                    dialect = Some(match name {
                        "ascii" => Dialect::Text,
                        "binary_little_endian" => Dialect::LittleEndian,
                        "binary_big_endian" => Dialect::BigEndian,
                        _ => {
                            return located(
                                "expected a format: ascii, binary_little_endian or binary_big_endian",
                            );
                        }
                    });
                }
                ["element", name, count] => {
                    let Ok(count) = count.parse() else { return located("expected a number of elements") };
                    if elements.iter().any(|own| own.name == name) {
                        return located("the header announces these elements twice");
                    }
                    elements.push(Element { name: name.to_owned(), count, properties: Vec::new(), line });
                    entries += 1;
                }
                ["property", ref kinds @ .., name] => {
                    let (count, kind) = match kinds {
                        ["list", count, kind] => (Some(*count), Some(*kind)),
                        [kind] => (None, Some(*kind)),
                        _ => (None, None),
                    };
                    let is_known =
                        count.is_none_or(|count| Kind::of(count).is_some_and(|kind| !kind.is_float()));
                    let (Some(kind), true) = (kind.and_then(Kind::of), is_known) else {
                        return located(
                            "expected a property: its type, or `list` and two types, and its name",
                        );
                    };
                    let Some(element) = elements.last_mut() else {
                        return located("a property stands before the first element");
                    };
                    let count = count.and_then(Kind::of);
                    element.properties.push(Property { name: name.to_owned(), kind, count });
                    entries += 1;
                }
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => {}
                _ => return located("expected format, element, property, comment or end_header"),
            }
            ENTRIES.allows(entries).map_err(|over| format!("line {line}: {over}"))?;
        }
        let Some(dialect) = dialect else { return Err("the header names no format".to_owned()) };
        for element in elements.iter().filter(|element| element.count > 0) {
            let Element { name, count, line, .. } = element;
            if element.properties.is_empty() {
                return Err(format!(
                    "line {line}: the {count} elements `{}` have no properties: export vertices and faces alone",
                    catchment_design::design::shortened(name)
                ));
            }
            // A header that announces more elements than the file has bytes for is wrong. The last line of a
            // text needs no line end.
            let least = u128::from(*count) * u128::from(element.least_bytes(dialect));
            if least > (bytes.len() - at) as u128 + 1 {
                return Err(format!(
                    "line {line}: the header announces {count} of `{}`, more than the file has bytes for: it was cut off, or its header is broken",
                    catchment_design::design::shortened(name)
                ));
            }
        }
        elements.retain(|element| element.count > 0);
        Ok(Self { dialect, elements, end: at, lines: line })
    }
}
