//! Parses the tables of own halves: pieces, a mesh, or parts.

use super::defect::DesignDefect;
use super::keys::{self, DesignTable, Key};
use super::quantity::LengthScale;
use super::read::Walk;
use super::section::Section;
use super::{FileSpec, FileUnit, HalfSpec, MeshPreparation, OutlineSpec, PartPlacement, PartSpec, ShapeSpec};
use toml::Spanned;
use toml::de::DeValue;

/// Advice on the shape of a half.
const HALF_ADVICE: &str =
    "give convex pieces = [[[x, y, z], …], …], mesh = \"half.stl\", or parts = [{ … }, …]";
/// Advice on the shape of a part.
const PART_ADVICE: &str = "give one of mesh = \"part.stl\", pieces, sphere = { radius }, cylinder = { radius, height }, \
                           cone = { radius, height }, box = [x, y, z], or profile = [[x, y], …] with height";
/// Keys that give a part its shape.
const SHAPES: [Key; 7] = [
    keys::PART_MESH,
    keys::PART_PIECES,
    keys::PART_SPHERE,
    keys::PART_CYLINDER,
    keys::PART_CONE,
    keys::PART_BOX,
    keys::PART_PROFILE,
];
/// Chord error of round surfaces, as a share of their size, while D is not known.
const ROUGH: f64 = 0.02;
/// Endings of files with outlines.
const DRAWINGS: [&str; 2] = ["svg", "dxf"];

impl<'t> Walk<'t> {
    /// A half and how it is placed.
    pub(super) fn half(
        &mut self,
        parent: &Section<'t>,
        key: &Key,
        is_assembled: bool,
        scale: Option<&LengthScale>,
    ) -> Option<(HalfSpec, PartPlacement)> {
        let Some(section) = self.reader.section(parent, key) else {
            if !parent.has(key) {
                self.reader.missing(parent, key, HALF_ADVICE);
            }
            return None;
        };
        self.reader.refuse_unknown_keys(&section, DesignTable::Half);
        let spec = self.half_spec(&section, scale);
        if is_assembled {
            self.reader.not_drawn_so(&section, &keys::FACING, is_assembled);
        }
        let none = PartPlacement::NONE;
        let placement = PartPlacement {
            facing: self.reader.direction(&section, &keys::FACING).unwrap_or(none.facing),
            rotate: self.reader.triple(&section, &keys::ROTATE, scale).unwrap_or(none.rotate),
            translate: self.reader.triple(&section, &keys::TRANSLATE, scale).unwrap_or(none.translate),
        };
        Some((spec?, placement))
    }

    fn half_spec(&mut self, section: &Section<'t>, scale: Option<&LengthScale>) -> Option<HalfSpec> {
        let later = [keys::PROFILE, keys::HEIGHTFIELD];
        for key in &later {
            if let Some(span) = section.key_span(key) {
                self.reader.report(DesignDefect::UnsupportedHalf { key: key.name }, span);
            }
        }
        let ways = [keys::PIECES, keys::MESH, keys::PARTS];
        let advice = "a half is drawn once: remove one of them, or make both parts of it";
        if !ways.iter().chain(&later).any(|key| section.has(key)) {
            self.reader.missing(section, &keys::PIECES, HALF_ADVICE);
        }
        let way = self.one_of(section, &ways, advice)?;
        if way == keys::MESH {
            let treatment = MeshPreparation {
                repair: self.reader.flag(section, &keys::REPAIR).unwrap_or(MeshPreparation::DEFAULT.repair),
                simplify: self.reader.number(section, &keys::SIMPLIFY, scale),
                deflection: self.reader.number(section, &keys::DEFLECTION, scale),
                body: self.reader.whole(section, &keys::BODY).and_then(|body| u16::try_from(body).ok()),
            };
            let file = self.file(section, &way, &keys::MESH_UNIT, scale);
            self.deflection_of(section, &keys::DEFLECTION, file.as_ref());
            return file.map(|file| HalfSpec::Mesh(FileSpec { treatment, ..file }));
        }
        let exact = if way == keys::PIECES {
            "pieces, which are taken as they are"
        } else {
            "a half of parts, whose meshes are repaired where they need it"
        };
        for key in [&keys::REPAIR, &keys::SIMPLIFY, &keys::BODY] {
            self.not_its_own(section, key, exact, "a mesh");
        }
        let owner = if way == keys::PIECES {
            "pieces, which are drawn in the unit of [connector]"
        } else {
            "a half of parts; each of its files has a unit of its own"
        };
        self.not_its_own(section, &keys::MESH_UNIT, owner, "a mesh");
        self.not_its_own(section, &keys::DEFLECTION, exact, "a STEP file");
        if way == keys::PIECES {
            self.pieces(section, &way, scale).map(HalfSpec::Pieces)
        } else {
            self.parts(section, scale).map(HalfSpec::Parts)
        }
    }

    /// Reports an error for a deflection of a file that contains triangles already.
    fn deflection_of(&mut self, section: &Section<'t>, key: &Key, file: Option<&FileSpec>) {
        if file.is_some_and(|file| !file.is_step()) {
            self.not_its_own(section, key, "a mesh file, which holds triangles already", "a STEP file");
        }
    }

    /// The one of `keys` that is written; `None` where none is, and after a defect about two of them.
    fn one_of(&mut self, section: &Section<'t>, keys: &[Key], advice: &'static str) -> Option<Key> {
        let mut written = keys.iter().filter(|key| section.has(key));
        let (first, second) = (written.next(), written.next());
        if let (Some(first), Some(second)) = (first, second) {
            let defect = DesignDefect::Contradiction {
                key: section.place(second.name),
                other: section.place(first.name),
                advice,
            };
            self.reader.report(defect, section.key_span(second).unwrap_or_default());
            return None;
        }
        first.copied()
    }

    fn not_its_own(&mut self, section: &Section<'t>, key: &Key, owner: &'static str, belongs_to: &str) {
        if let Some(span) = section.key_span(key) {
            let (key, belongs_to) = (key.name.to_owned(), belongs_to.to_owned());
            self.reader.report(DesignDefect::NotAParameter { key, owner, belongs_to }, span);
        }
    }

    fn parts(&mut self, section: &Section<'t>, scale: Option<&LengthScale>) -> Option<Vec<PartSpec>> {
        let value = self.reader.raw(section, &keys::PARTS)?;
        let place = section.place(keys::PARTS.name);
        let elements = self.reader.array(&place, "a list of parts", value)?;
        if elements.is_empty() {
            let advice = "a half has at least one part";
            self.reader.report(DesignDefect::Empty { key: place, advice }, value.span());
            return None;
        }
        if elements.len() > keys::MOST_PARTS {
            let defect = DesignDefect::TooManyParts { key: place, found: elements.len() };
            self.reader.report(defect, value.span());
            return None;
        }
        // Read every part, also after an error, to report all errors.
        let parts: Vec<_> = elements
            .iter()
            .enumerate()
            .map(|(index, element)| {
                let section = self.reader.member(format!("{place}[{index}]"), element)?;
                self.part(&section, scale)
            })
            .collect();
        parts.into_iter().collect()
    }

    fn part(&mut self, section: &Section<'t>, scale: Option<&LengthScale>) -> Option<PartSpec> {
        self.reader.refuse_unknown_keys(section, DesignTable::Part);
        let shape = self.shape(section, scale);
        let none = PartPlacement::NONE;
        let axis = self.reader.direction(section, &keys::PART_AXIS).unwrap_or(none.facing);
        let rotate = self.reader.triple(section, &keys::PART_ROTATE, scale).unwrap_or(none.rotate);
        let at = self.reader.triple(section, &keys::PART_AT, scale).unwrap_or(none.translate);
        Some(PartSpec { shape: shape?, axis, rotate, at })
    }

    fn shape(&mut self, section: &Section<'t>, scale: Option<&LengthScale>) -> Option<ShapeSpec> {
        let advice = "a part has one shape: remove one of them, or make it a part of its own";
        if !SHAPES.iter().any(|key| section.has(key)) {
            self.reader.missing_shape(section, PART_ADVICE);
        }
        let way = self.one_of(section, &SHAPES, advice)?;
        let is_drawing = way == keys::PART_PROFILE && section.is_text(&way);
        if way != keys::PART_MESH && !is_drawing {
            let owner = "a part that no file draws; its numbers are in the unit of [connector]";
            self.not_its_own(section, &keys::PART_UNIT, owner, "the parts of a file");
        }
        if way != keys::PART_PROFILE {
            self.not_its_own(section, &keys::PART_HEIGHT, "this part", "a profile");
        }
        if way != keys::PART_MESH {
            self.not_its_own(section, &keys::PART_DEFLECTION, "this part", "a STEP file");
        }
        let is_round = [keys::PART_SPHERE, keys::PART_CYLINDER, keys::PART_CONE].contains(&way) || is_drawing;
        if !is_round {
            self.not_its_own(section, &keys::PART_CHORD_ERROR, "a part without curves", "what is round");
        }
        let written = self.reader.number(section, &keys::PART_CHORD_ERROR, scale);
        let is_rough = written.is_none() && self.is_rough();
        let chord_error = written.unwrap_or(PartSpec::CHORD_ERROR);
        let chord_error = |size: f64| if is_rough { ROUGH * size } else { chord_error };
        match way {
            keys::PART_MESH => {
                let deflection = self.reader.number(section, &keys::PART_DEFLECTION, scale);
                let file = self.file(section, &way, &keys::PART_UNIT, scale);
                self.deflection_of(section, &keys::PART_DEFLECTION, file.as_ref());
                let treatment = MeshPreparation { deflection, ..MeshPreparation::DEFAULT };
                file.map(|file| ShapeSpec::Mesh(FileSpec { treatment, ..file }))
            }
            keys::PART_PIECES => self.pieces(section, &way, scale).map(ShapeSpec::Pieces),
            keys::PART_BOX => self.reader.triple(section, &way, scale).map(|size| ShapeSpec::Box { size }),
            keys::PART_PROFILE => {
                let height = self.needed(section, &keys::PART_HEIGHT, scale);
                let outline = self.outline(section, &way, scale);
                let (outline, height) = (outline?, height?);
                Some(ShapeSpec::Profile { outline, height, chord_error: chord_error(height) })
            }
            _ => self.round(section, &way, chord_error, scale),
        }
    }

    /// A sphere, a cylinder or a cone.
    fn round(
        &mut self,
        section: &Section<'t>,
        way: &Key,
        chord_error: impl Fn(f64) -> f64,
        scale: Option<&LengthScale>,
    ) -> Option<ShapeSpec> {
        let keys::ValueKind::Table(table) = way.kind else { return None };
        let section = &self.reader.section(section, way)?;
        self.reader.refuse_unknown_keys(section, table);
        if table == DesignTable::Sphere {
            let radius = self.needed(section, &keys::SPHERE_RADIUS, scale)?;
            return Some(ShapeSpec::Sphere { radius, chord_error: chord_error(radius) });
        }
        let is_cone = table == DesignTable::Cone;
        let (radius, height) = if is_cone {
            (keys::CONE_RADIUS, keys::CONE_HEIGHT)
        } else {
            (keys::CYLINDER_RADIUS, keys::CYLINDER_HEIGHT)
        };
        let radius = self.needed(section, &radius, scale);
        let height = self.needed(section, &height, scale);
        let top = is_cone.then(|| self.reader.number(section, &keys::CONE_TOP_RADIUS, scale).unwrap_or(0.0));
        let (radius, height) = (radius?, height?);
        let (top_radius, chord_error) = (top.unwrap_or(radius), chord_error(radius));
        Some(ShapeSpec::Cone { radius, top_radius, height, chord_error })
    }

    /// A number that must be there.
    fn needed(&mut self, section: &Section<'t>, key: &Key, scale: Option<&LengthScale>) -> Option<f64> {
        if !section.has(key) {
            self.reader.missing(section, key, key.doc);
        }
        self.reader.number(section, key, scale)
    }

    /// The corners of a polygon, or a drawing.
    fn outline(
        &mut self,
        section: &Section<'t>,
        key: &Key,
        scale: Option<&LengthScale>,
    ) -> Option<OutlineSpec> {
        const FEWEST: usize = 3;
        if section.is_text(key) {
            let file = self.file(section, key, &keys::PART_UNIT, scale)?;
            if !DRAWINGS.contains(&file.ending().as_str()) {
                let (written, span) = self.reader.string(section, key)?;
                let defect = DesignDefect::UnknownName {
                    what: "kind of drawing",
                    name: super::quantity::shortened(written),
                    meant: None,
                    known: vec!["an .svg or .dxf file", "a list of corners [[x, y], …]"],
                };
                self.reader.report(defect, span);
                return None;
            }
            return Some(OutlineSpec::File(file));
        }
        let value = self.reader.raw(section, key)?;
        let place = section.place(key.name);
        let elements =
            self.reader.array(&place, "a list of corners [x, y], or the path of a drawing", value)?;
        if elements.len() < FEWEST {
            let defect = DesignDefect::TooFewCorners { key: place, found: elements.len() };
            self.reader.report(defect, value.span());
            return None;
        }
        let element = key.element();
        let corners: Vec<_> = elements
            .iter()
            .map(|corner| {
                self.reader.two(&place, "a corner [x, y]", corner, |reader, place, value| {
                    reader.checked(place, &element, value, scale)
                })
            })
            .collect();
        corners.into_iter().collect::<Option<Vec<_>>>().map(OutlineSpec::Corners)
    }

    /// A file and the conversion of its coordinates to D.
    fn file(
        &mut self,
        section: &Section<'t>,
        key: &Key,
        unit_key: &Key,
        scale: Option<&LengthScale>,
    ) -> Option<FileSpec> {
        let unit = self.reader.unit(section, unit_key);
        let path = self.reader.string(section, key).and_then(|(written, span)| {
            let path = self.base_dir.join(written);
            if written.trim().is_empty() {
                let key = section.place(key.name);
                self.reader.report(DesignDefect::Empty { key, advice: "name an STL file" }, span);
                None
            } else {
                Some(path)
            }
        });
        let file = path.map(|path| FileSpec::new(path, 1.0));
        let says_it = file.as_ref().is_some_and(FileSpec::may_state_unit);
        let scale = scale?;
        let written = unit;
        let (scale, unit) = match (unit, scale.unit) {
            (Some(file), Some(design)) => {
                let unit = if says_it { FileUnit::Stated(file) } else { FileUnit::Beside };
                (file.metres() / (design.metres() * scale.width), unit)
            }
            (None, None) => (1.0 / scale.width, FileUnit::Beside),
            (Some(file), None) => {
                let text = file.symbol().to_owned();
                let span = section.key_span(unit_key)?;
                self.reader.report(DesignDefect::UnitInDimensionlessDesign { text }, span);
                return None;
            }
            (None, Some(design)) if says_it && !section.has(unit_key) => {
                (1.0 / (design.metres() * scale.width), FileUnit::InFile)
            }
            (None, Some(_)) => {
                if !section.has(unit_key) {
                    let advice = "a mesh file does not say its unit: write it beside the file, unit = \"mm\"";
                    self.reader.missing(section, unit_key, advice);
                }
                return None;
            }
        };
        Some(FileSpec { scale, unit, written, ..file? })
    }

    fn pieces(
        &mut self,
        section: &Section<'t>,
        key: &Key,
        scale: Option<&LengthScale>,
    ) -> Option<Vec<Vec<[f64; 3]>>> {
        const LEAST_POINTS: usize = 4;
        let value = self.reader.raw(section, key)?;
        let place = section.place(key.name);
        let elements = self.reader.array(&place, "a list of pieces", value)?;
        if elements.is_empty() {
            let advice = "a half has at least one convex piece";
            self.reader.report(DesignDefect::Empty { key: place, advice }, value.span());
            return None;
        }
        let mut pieces = Some(Vec::with_capacity(elements.len()));
        for (index, element) in elements.iter().enumerate() {
            let place = format!("{place}[{index}]");
            self.reader.sources.insert(place.clone(), element.span());
            let piece = self.reader.array(&place, "a list of points [x, y, z]", element).and_then(|points| {
                if points.len() < LEAST_POINTS {
                    let defect = DesignDefect::TooFewPoints { key: place.clone(), found: points.len() };
                    self.reader.report(defect, element.span());
                    return None;
                }
                // Read every point, also after an error, to report all errors.
                let points: Vec<_> = points.iter().map(|point| self.point(&place, point, scale)).collect();
                points.into_iter().collect::<Option<Vec<_>>>()
            });
            pieces = pieces.zip(piece).map(|(mut list, piece)| {
                list.push(piece);
                list
            });
        }
        pieces
    }

    fn point(
        &mut self,
        place: &str,
        value: &'t Spanned<DeValue<'t>>,
        scale: Option<&LengthScale>,
    ) -> Option<[f64; 3]> {
        self.reader.three(place, "a point [x, y, z]", value, |reader, place, value| {
            reader.checked(place, &keys::COORDINATE, value, scale)
        })
    }
}
