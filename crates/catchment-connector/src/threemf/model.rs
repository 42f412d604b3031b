//! A model part of a 3MF file: its unit, its objects and its build, read as a stream.

use crate::mesh::MAX_TRIANGLES;
use catchment_base::budget::Limit;
use catchment_design::design::shortened;
use catchment_design::xml::{Piece, Tag, Walk, XmlError, XmlLimits};
use glam::{DAffine3, DMat3, DVec3};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

/// Largest number of vertices of a file: three for every triangle, as if no vertex were shared.
pub(super) const MOST_VERTICES: usize = 3 * MAX_TRIANGLES;
/// Limits on the XML of a part. Elements of extensions are counted with those of the solids.
const LIMITS: XmlLimits = XmlLimits {
    elements: Limit { most: 4_000_000, of: "elements", remedy: "export the solids alone" },
    depth: Limit { most: 64, of: "elements within each other", remedy: "export the part again" },
    attributes: Limit { most: 64, of: "attributes of an element", remedy: "export the part again" },
    piece: Limit { most: 1 << 20, of: "bytes in a tag or a text", remedy: "export the part again" },
};
/// Bytes of the path of a part: archives have names of dozens.
const PATH: Limit = Limit { most: 1024, of: "bytes in the path of a part", remedy: "export the part again" };
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
/// Namespaces of required extensions that do not change solids, or that are supported.
const KNOWN_EXTENSIONS: [&str; 3] = ["/production/", "/material/", "/slice/"];

/// An item of the build, or a component of an object.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Use {
    pub(super) object: u32,
    /// Its part, if it is in another part.
    pub(super) path: Option<String>,
    pub(super) transform: DAffine3,
}

/// Geometry of an object.
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

/// The start tags of the elements, in order.
fn walk(part: impl Read, mut each: impl FnMut(&Tag<'_>) -> Result<(), String>) -> Result<(), String> {
    let mut walk = Walk::new(part, LIMITS);
    loop {
        let piece = walk.next().map_err(|XmlError { at, message, .. }| format!("byte {at}: {message}"))?;
        match piece {
            Some(Piece::Start(tag)) => {
                each(&tag).map_err(|message| format!("byte {}: {message}", tag.head().start))?;
            }
            Some(_) => {}
            None => return Ok(()),
        }
    }
}

/// The value of an attribute by its local name.
fn attribute<'t>(tag: &'t Tag<'_>, name: &str) -> Option<Cow<'t, str>> {
    tag.local_attribute(name).map(|own| own.value)
}

fn number<T: std::str::FromStr>(tag: &Tag<'_>, name: &str) -> Result<T, String> {
    let element = || shortened(tag.name());
    let written = attribute(tag, name).ok_or_else(|| format!("<{}> has no {name}", element()))?;
    written.trim().parse().map_err(|_| {
        format!("{name} of <{}> is `{}`, which is no number here", element(), shortened(&written))
    })
}

/// Twelve numbers: the images of the axes, and the origin.
fn transform(tag: &Tag<'_>) -> Result<DAffine3, String> {
    let Some(written) = attribute(tag, "transform") else { return Ok(DAffine3::IDENTITY) };
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

fn used(tag: &Tag<'_>) -> Result<Use, String> {
    let path = attribute(tag, "path");
    PATH.allows(path.as_ref().map_or(0, |path| path.len() as u64)).map_err(|over| over.to_string())?;
    Ok(Use { object: number(tag, "objectid")?, path: path.map(Cow::into_owned), transform: transform(tag)? })
}

/// The target of the first relationship whose type ends in `kind`.
pub(super) fn target(part: impl Read, kind: &str) -> Result<Option<String>, String> {
    let mut target = None;
    walk(part, |tag| {
        if tag.name() == "Relationship"
            && target.is_none()
            && attribute(tag, "Type").is_some_and(|own| own.ends_with(kind))
        {
            target = attribute(tag, "Target").map(Cow::into_owned);
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
        walk(part, |tag| {
            let within = |parent: &str| tag.is_within(parent);
            match tag.name() {
                "model" if tag.is_root() => model.head(tag)?,
                _ if tag.is_root() => return Err("it is no model of a 3MF file".to_owned()),
                "object" if within("resources") => {
                    let id = number(tag, "id")?;
                    let kind = attribute(tag, "type");
                    let is_model = kind.is_none_or(|kind| kind == "model");
                    let left_out = (!is_model).then_some(Geometry::LeftOut);
                    let nothing = || Geometry::Components(Vec::new());
                    model.objects.insert(id, left_out.unwrap_or_else(nothing));
                    uses += 1;
                    current = is_model.then_some(id);
                }
                "mesh" if within("object") => {
                    if let Some(id) = current {
                        model
                            .objects
                            .insert(id, Geometry::Mesh { vertices: Vec::new(), triangles: Vec::new() });
                    }
                }
                "vertex" if within("vertices") => {
                    if let Some(Geometry::Mesh { vertices: own, .. }) = model.current(current) {
                        own.push(DVec3::new(number(tag, "x")?, number(tag, "y")?, number(tag, "z")?));
                        vertices += 1;
                    }
                }
                "triangle" if within("triangles") => {
                    if let Some(Geometry::Mesh { triangles: own, .. }) = model.current(current) {
                        own.push([number(tag, "v1")?, number(tag, "v2")?, number(tag, "v3")?]);
                        triangles += 1;
                    }
                }
                "component" if within("components") => {
                    if let Some(Geometry::Components(own)) = model.current(current) {
                        own.push(used(tag)?);
                        uses += 1;
                    }
                }
                "item" if within("build") => {
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

    /// The unit, and the extensions that the file requires.
    fn head(&mut self, tag: &Tag<'_>) -> Result<(), String> {
        if let Some(unit) = attribute(tag, "unit") {
            let known = UNITS.iter().find(|(name, _)| *name == unit);
            self.metres = known.ok_or_else(|| format!("unknown unit `{}`", shortened(&unit)))?.1;
        }
        for prefix in attribute(tag, "requiredextensions").unwrap_or_default().split_whitespace() {
            let space = attribute(tag, prefix).unwrap_or_default();
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
