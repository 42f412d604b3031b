//! 3MF files: the content of their build, with each item as a separate body.
//!
//! ```text
//! ZIP ──_rels/.rels──▶ model part ──▶ unit, objects, build
//!                          └ items and components: an object, of this part or of another, moved by an affine map
//! ```
//!
//! Follows the core specification and, from the production extension, the paths of items and components.
//! Objects that are not models (supports, surfaces) are skipped, as are colours, slices and everything else
//! that does not bound the solid. A file that requires an unsupported extension is rejected. The winding of a
//! mirrored item is reversed, as the specification requires.
//!
//! The reader is our own because it processes the XML as a stream: an archive of a megabyte may contain
//! gigabytes, of which at most [`MOST_UNPACKED`] are unpacked and only numbers are stored. Existing libraries
//! keep the text, and do not report the place of a defect.

mod model;

use super::mesh::{self, FileOffset, MAX_TRIANGLES, MeshProblem, Triangle, TriangleLocation};
use super::source::{FileBytes, FileContent, ZIP};
use catchment_base::budget::{Budget, Limit};
use glam::{DAffine3, DVec3};
use model::{Geometry, Model};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// Longest file that is read.
pub(super) const MAX_BYTES: u64 = super::stl::MAX_BYTES;
/// Largest number of unpacked bytes: four times the size of the largest number of triangles of a half.
const MOST_UNPACKED: u64 = 64 << 20;
/// Largest number of model parts of a file: programs that split models make a part per object.
const MOST_MODELS: usize = 64;
/// Items and components that are followed, and how deep: two that hold two each, and so on, are soon more than any file has bytes.
const COMPONENTS: Limit =
    Limit { most: 10_000, of: "items and components", remedy: "unite the solids before exporting" };
const DEPTH: Limit =
    Limit { most: 16, of: "components nested in each other", remedy: "unite the solids before exporting" };
/// How an entry of the directory of an archive begins.
const ENTRY: &[u8] = b"PK\x01\x02";
/// Entries of an archive, which are pictures and settings but for the models.
const ENTRIES: Limit = Limit { most: 10_000, of: "entries", remedy: "export the part alone" };
/// The part with the model, if no relationship names it.
const USUAL_MODEL: &str = "3D/3dmodel.model";
/// How the relationship to it ends.
const MODEL_RELATION: &str = "/3dmodel";

fn refused(message: impl Into<String>) -> Vec<MeshProblem> {
    vec![MeshProblem::NotThreeMf { message: message.into() }]
}

/// As the table of formats wants it.
pub(super) fn read(file: &FileBytes) -> Result<FileContent, Vec<MeshProblem>> {
    if file.bytes.is_empty() {
        return Err(vec![MeshProblem::Empty]);
    }
    if file.size > MAX_BYTES {
        return Err(refused(format!("{} bytes, more than the {MAX_BYTES} that are read", file.size)));
    }
    // Opening it takes memory for every entry.
    let entries = file.bytes.windows(ENTRY.len()).filter(|window| *window == ENTRY).count();
    ENTRIES.allows(entries as u64).map_err(|over| mesh::overspent("the archive", over))?;
    let archive = ZipArchive::new(Cursor::new(file.bytes.as_slice())).map_err(|error| {
        refused(format!("it is no ZIP archive, or was cut off ({error}): export it again"))
    })?;
    let mut package =
        Package { archive, left: MOST_UNPACKED, models: BTreeMap::new(), vertices: 0, triangles: 0 };
    let root = package.root()?;
    package.load(&root)?;
    let components = Budget::new(COMPONENTS);
    let mut build = Build { package, bodies: Vec::new(), placed: BTreeSet::new(), components, triangles: 0 };
    let metres = build.package.models[&root].metres;
    for item in build.package.models[&root].items.clone() {
        let path = item.path.map_or_else(|| root.clone(), |path| part_name(&path));
        build.add(&path, item.object, item.transform, 0)?;
    }
    Ok(FileContent { bodies: build.bodies, metres: Some(metres), curves: None })
}

/// The name of a part as archives have it.
fn part_name(path: &str) -> String {
    path.trim_start_matches('/').to_owned()
}

struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// Bytes that may still be unpacked.
    left: u64,
    models: BTreeMap<String, Model>,
    vertices: usize,
    triangles: usize,
}

impl Package<'_> {
    /// The model that the package is about.
    fn root(&mut self) -> Result<String, Vec<MeshProblem>> {
        let named = match self.find("_rels/.rels") {
            Some(relations) => {
                let part = self.archive.by_index(relations).map_err(|error| refused(error.to_string()))?;
                let mut part = part.take(self.left);
                let named = model::target(&mut part, MODEL_RELATION)
                    .map_err(|error| refused(format!("_rels/.rels: {error}")))?;
                self.left = part.limit();
                named.map(|path| part_name(&path))
            }
            None => None,
        };
        let name = named.unwrap_or_else(|| USUAL_MODEL.to_owned());
        if self.find(&name).is_some() { Ok(name) } else { Err(vec![MeshProblem::Foreign { what: ZIP }]) }
    }

    /// The number of a part by its name, whose case does not count.
    fn find(&self, name: &str) -> Option<usize> {
        (0..self.archive.len()).find(|k| {
            self.archive
                .name_for_index(*k)
                .is_some_and(|own| own.is_ok_and(|own| own.eq_ignore_ascii_case(name)))
        })
    }

    /// Reads a model part, once.
    fn load(&mut self, name: &str) -> Result<(), Vec<MeshProblem>> {
        if self.models.contains_key(name) {
            return Ok(());
        }
        if self.models.len() == MOST_MODELS {
            return Err(refused(format!(
                "it has more than {MOST_MODELS} model parts: export the part alone"
            )));
        }
        let number = self.find(name).ok_or_else(|| refused(format!("it has no part {name}")))?;
        let located = |message: String| refused(format!("{name}: {message}"));
        let left = self.left;
        let part = self.archive.by_index(number).map_err(|error| located(error.to_string()))?;
        // One byte more than the limit, to distinguish "too long" from "cut off".
        let mut part = part.take(left + 1);
        let model = Model::read(&mut part);
        let Some(left) = part.limit().checked_sub(1) else {
            return Err(refused(format!("it unpacks to more than {MOST_UNPACKED} bytes")));
        };
        self.left = left;
        let model = model.map_err(located)?;
        let [vertices, triangles] = model.counts();
        self.vertices += vertices;
        self.triangles += triangles;
        if self.triangles > MAX_TRIANGLES || self.vertices > model::MOST_VERTICES {
            return Err(vec![MeshProblem::TooMany { count: self.triangles as u64 }]);
        }
        self.models.insert(name.to_owned(), model);
        Ok(())
    }
}

/// The combined items of a build.
struct Build<'a> {
    package: Package<'a>,
    bodies: Vec<Vec<Triangle>>,
    /// Placed meshes, each with its part and its transform: a repeated mesh in the same place is the same
    /// solid.
    placed: BTreeSet<(String, u32, [u64; 12])>,
    components: Budget,
    triangles: usize,
}

impl Build<'_> {
    /// Adds an object, or all that it is composed of.
    fn add(&mut self, path: &str, id: u32, placed: DAffine3, depth: usize) -> Result<(), Vec<MeshProblem>> {
        let over = |over| mesh::overspent(format!("{path}, object {id}"), over);
        self.components.spend(1).map_err(over)?;
        DEPTH.allows(depth as u64).map_err(over)?;
        self.package.load(path)?;
        let Some(object) = self.package.models[path].objects.get(&id) else {
            return Err(refused(format!("{path}: there is no object {id}")));
        };
        match object {
            Geometry::LeftOut => Ok(()),
            Geometry::Components(components) => {
                let count = components.len();
                for k in 0..count {
                    // Clone components singly: a copy of the whole list would be held at every depth.
                    let Some(Geometry::Components(components)) = self.package.models[path].objects.get(&id)
                    else {
                        break;
                    };
                    let component = components[k].clone();
                    let path = component.path.map_or_else(|| path.to_owned(), |path| part_name(&path));
                    self.add(&path, component.object, placed * component.transform, depth + 1)?;
                }
                Ok(())
            }
            Geometry::Mesh { vertices, triangles } => {
                let place = placed.to_cols_array().map(|number| (number + 0.0).to_bits());
                if !self.placed.insert((path.to_owned(), id, place)) {
                    return Ok(());
                }
                self.triangles += triangles.len();
                if self.triangles > MAX_TRIANGLES {
                    return Err(vec![MeshProblem::TooMany { count: self.triangles as u64 }]);
                }
                let mirrored = placed.matrix3.determinant() < 0.0;
                mesh::BODIES.allows(self.bodies.len() as u64 + 1).map_err(over)?;
                let first: usize = self.bodies.iter().map(Vec::len).sum();
                let mut body = Vec::with_capacity(triangles.len());
                for (k, corners) in triangles.iter().enumerate() {
                    let at = |v: u32| vertices.get(v as usize).map(|p| placed.transform_point3(*p));
                    let [a, b, c] = corners.map(at);
                    let (Some(a), Some(b), Some(c)) = (a, b, c) else {
                        return Err(refused(format!(
                            "{path}: triangle {k} of object {id} has a corner that is no vertex"
                        )));
                    };
                    let corners: [DVec3; 3] = if mirrored { [a, c, b] } else { [a, b, c] };
                    body.push(Triangle {
                        corners,
                        place: TriangleLocation { triangle: first + k, start: FileOffset::Memory },
                    });
                }
                self.bodies.push(body);
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests;
