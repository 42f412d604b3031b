//! A model part of a 3MF file: its unit, its objects and its build, read piece by piece.

use crate::connector::mesh::MAX_TRIANGLES;
use crate::design::shortened;
use glam::{DAffine3, DMat3, DVec3};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Read};

/// Most vertices of a file: three for every triangle, where none are shared.
pub(super) const MOST_VERTICES: usize = 3 * MAX_TRIANGLES;
/// Most bytes of one piece of XML, a tag or a text.
const LONGEST_PIECE: usize = 1 << 20;
/// Deepest nesting of elements.
const DEEPEST: usize = 64;
/// Most objects, items and components of a part.
const MOST_OBJECTS: usize = 100_000;
/// Metres in the units of the format.
const UNITS: [(&str, f64); 6] = [
    ("micron", 1e-6),
    ("millimeter", 1e-3),
    ("centimeter", 1e-2),
    ("inch", 0.0254),
    ("foot", 0.3048),
    ("meter", 1.0),
];
/// What the namespaces of required extensions hold that change no solid, or that are read.
const KNOWN_EXTENSIONS: [&str; 3] = ["/production/", "/material/", "/slice/"];

/// An item of the build, or a component of an object.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Use {
    pub(super) object: u32,
    /// The part that it is in, where that is another one.
    pub(super) path: Option<String>,
    pub(super) transform: DAffine3,
}

/// What an object is.
#[derive(Debug)]
pub(super) enum Geometry {
    Mesh {
        vertices: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
    },
    Components(Vec<Use>),
    /// No model: a support, or a surface.
    LeftOut,
}

/// A model part.
#[derive(Debug, Default)]
pub(super) struct Model {
    pub(super) metres: f64,
    pub(super) objects: BTreeMap<u32, Geometry>,
    pub(super) items: Vec<Use>,
}

/// Ends where one piece is too long.
struct Metered<R> {
    inner: R,
    piece: usize,
}

impl<R: BufRead> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Metered<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.piece > LONGEST_PIECE {
            return Err(io::Error::other(format!("a tag or a text of more than {LONGEST_PIECE} bytes")));
        }
        self.inner.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.piece += count;
        self.inner.consume(count);
    }
}

/// Every element that begins, with the names of those around it.
fn walk(
    part: impl Read,
    mut each: impl FnMut(&BytesStart<'_>, &[Vec<u8>]) -> Result<(), String>,
) -> Result<(), String> {
    let metered = Metered { inner: BufReader::new(part), piece: 0 };
    let mut reader = Reader::from_reader(metered);
    let mut buffer = Vec::new();
    let mut open: Vec<Vec<u8>> = Vec::new();
    let mut any = false;
    loop {
        reader.get_mut().piece = 0;
        buffer.clear();
        let at = reader.buffer_position();
        let located = |message: String| format!("byte {at}: {message}");
        match reader.read_event_into(&mut buffer).map_err(|error| located(error.to_string()))? {
            Event::Start(tag) => {
                each(&tag, &open).map_err(located)?;
                if open.len() == DEEPEST {
                    return Err(located(format!("elements are nested more than {DEEPEST} deep")));
                }
                open.push(tag.local_name().as_ref().to_vec());
                any = true;
            }
            Event::Empty(tag) => {
                each(&tag, &open).map_err(located)?;
                any = true;
            }
            Event::End(_) => drop(open.pop()),
            Event::DocType(_) => return Err(located("a document type has no place in it".to_owned())),
            Event::Eof if !open.is_empty() => return Err(located("it was cut off".to_owned())),
            Event::Eof if !any => return Err("there is no XML in it".to_owned()),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// The value of an attribute by its local name.
fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    for attribute in tag.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attribute.key.local_name().as_ref() == name.as_bytes() {
            let text = String::from_utf8_lossy(&attribute.value);
            let plain = quick_xml::escape::unescape(&text).map_err(|error| error.to_string())?;
            return Ok(Some(plain.into_owned()));
        }
    }
    Ok(None)
}

fn number<T: std::str::FromStr>(tag: &BytesStart<'_>, name: &str) -> Result<T, String> {
    let element = || shortened(&String::from_utf8_lossy(tag.local_name().as_ref()));
    let written = attribute(tag, name)?.ok_or_else(|| format!("<{}> has no {name}", element()))?;
    written.trim().parse().map_err(|_| {
        format!("{name} of <{}> is `{}`, which is no number here", element(), shortened(&written))
    })
}

/// Twelve numbers: where the axes go, and the origin.
fn transform(tag: &BytesStart<'_>) -> Result<DAffine3, String> {
    let Some(written) = attribute(tag, "transform")? else { return Ok(DAffine3::IDENTITY) };
    let numbers: Vec<f64> = written.split_whitespace().filter_map(|number| number.parse().ok()).collect();
    let whole = numbers.len() == 12 && numbers.iter().all(|number: &f64| number.is_finite());
    if !whole || written.split_whitespace().count() != 12 {
        return Err(format!("the transform `{}` is not twelve numbers", shortened(&written)));
    }
    let axis = |k: usize| DVec3::from_slice(&numbers[3 * k..]);
    let matrix3 = DMat3::from_cols(axis(0), axis(1), axis(2));
    if matrix3.determinant() == 0.0 {
        return Err(format!("the transform `{}` flattens what it moves", shortened(&written)));
    }
    Ok(DAffine3 { matrix3, translation: axis(3) })
}

fn used(tag: &BytesStart<'_>) -> Result<Use, String> {
    Ok(Use { object: number(tag, "objectid")?, path: attribute(tag, "path")?, transform: transform(tag)? })
}

/// The target of the first relationship whose type ends in `kind`.
pub(super) fn target(part: impl Read, kind: &str) -> Result<Option<String>, String> {
    let mut target = None;
    walk(part, |tag, _| {
        if tag.local_name().as_ref() == b"Relationship"
            && target.is_none()
            && attribute(tag, "Type")?.is_some_and(|own| own.ends_with(kind))
        {
            target = attribute(tag, "Target")?;
        }
        Ok(())
    })?;
    Ok(target)
}

impl Model {
    /// Reads a part.
    pub(super) fn read(part: impl Read) -> Result<Self, String> {
        let mut model = Self { metres: 1e-3, ..Self::default() };
        let mut current = None;
        let (mut vertices, mut triangles, mut uses) = (0, 0, 0);
        walk(part, |tag, open| {
            let name = tag.local_name();
            let within = |parent: &str| open.last().is_some_and(|own| own == parent.as_bytes());
            match name.as_ref() {
                b"model" if open.is_empty() => model.head(tag)?,
                _ if open.is_empty() => return Err("it is no model of a 3MF file".to_owned()),
                b"object" if within("resources") => {
                    let id = number(tag, "id")?;
                    let kind = attribute(tag, "type")?;
                    let is_model = kind.is_none_or(|kind| kind == "model");
                    let left_out = (!is_model).then_some(Geometry::LeftOut);
                    let nothing = || Geometry::Components(Vec::new());
                    model.objects.insert(id, left_out.unwrap_or_else(nothing));
                    uses += 1;
                    current = is_model.then_some(id);
                }
                b"mesh" if within("object") => {
                    if let Some(id) = current {
                        model
                            .objects
                            .insert(id, Geometry::Mesh { vertices: Vec::new(), triangles: Vec::new() });
                    }
                }
                b"vertex" if within("vertices") => {
                    if let Some(Geometry::Mesh { vertices: own, .. }) = model.current(current) {
                        own.push(DVec3::new(number(tag, "x")?, number(tag, "y")?, number(tag, "z")?));
                        vertices += 1;
                    }
                }
                b"triangle" if within("triangles") => {
                    if let Some(Geometry::Mesh { triangles: own, .. }) = model.current(current) {
                        own.push([number(tag, "v1")?, number(tag, "v2")?, number(tag, "v3")?]);
                        triangles += 1;
                    }
                }
                b"component" if within("components") => {
                    if let Some(Geometry::Components(own)) = model.current(current) {
                        own.push(used(tag)?);
                        uses += 1;
                    }
                }
                b"item" if within("build") => {
                    model.items.push(used(tag)?);
                    uses += 1;
                }
                _ => {}
            }
            if vertices > MOST_VERTICES || triangles > MAX_TRIANGLES || uses > MOST_OBJECTS {
                return Err(format!(
                    "more than {MAX_TRIANGLES} triangles, {MOST_VERTICES} vertices or {MOST_OBJECTS} objects: \
                     export a coarser mesh"
                ));
            }
            Ok(())
        })?;
        Ok(model)
    }

    fn current(&mut self, id: Option<u32>) -> Option<&mut Geometry> {
        self.objects.get_mut(&id?)
    }

    /// The unit, and what the file requires of its reader.
    fn head(&mut self, tag: &BytesStart<'_>) -> Result<(), String> {
        if let Some(unit) = attribute(tag, "unit")? {
            let known = UNITS.iter().find(|(name, _)| *name == unit);
            self.metres = known.ok_or_else(|| format!("unknown unit `{}`", shortened(&unit)))?.1;
        }
        for prefix in attribute(tag, "requiredextensions")?.unwrap_or_default().split_whitespace() {
            let space = attribute(tag, prefix)?.unwrap_or_default();
            if !KNOWN_EXTENSIONS.iter().any(|known| space.contains(known)) {
                return Err(format!(
                    "it requires the extension `{}`, which is not read: export it without, or as STL",
                    shortened(if space.is_empty() { prefix } else { &space })
                ));
            }
        }
        Ok(())
    }

    /// Vertices and triangles of all objects.
    pub(super) fn counts(&self) -> [usize; 2] {
        let meshes = self.objects.values().filter_map(|object| match object {
            Geometry::Mesh { vertices, triangles } => Some([vertices.len(), triangles.len()]),
            _ => None,
        });
        meshes.fold([0; 2], |[v, t], [more_v, more_t]| [v + more_v, t + more_t])
    }
}
