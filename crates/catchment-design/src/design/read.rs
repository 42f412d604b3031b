//! Parses the text of a design file into a [`Design`], or into all its errors at once.

use super::defect::DesignDefect;
use super::family::Value;
use super::keys::{self, Applies, DesignTable, Key, ValueKind};
use super::located_defect::{LocatedDefects, Sources};
use super::quantity::LengthScale;
use super::reader::Reader;
use super::section::Section;
use super::{Alignment, ConnectorSpec, Design, DrawnFrames, Family, FamilySpec, OwnSpec, WidthFrom};
use catchment_base::pose::{Dof, DofSet};
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// Largest design file, in bytes. Larger geometry belongs into a mesh file; the worst text of this size takes
/// the TOML parser half a gigabyte.
pub const LARGEST_FILE: usize = 4 << 20;

/// A design and the places of its keys.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignFile {
    /// The design.
    pub design: Design,
    /// The places of its values.
    pub sources: Sources,
}

/// Reads a design file. Paths in it are relative to `base_dir`, the folder it lies in. No file is touched:
/// whether the mesh files exist shows when the halves are built.
///
/// # Errors
/// All problems of the text, in order.
pub fn read(text: &str, base_dir: &Path) -> Result<DesignFile, LocatedDefects> {
    read_as(text, base_dir, Width::Written).map(|(file, _)| file)
}

/// State of D for own halves with a unit, if the file does not state it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// The file must state it.
    Written,
    /// D is measured later: until then lengths are in this provisional D, and may be out of range. Without a
    /// provisional D lengths are in the unit itself, and round surfaces are drawn coarsely.
    Provisional(Option<f64>),
    /// It was measured.
    Measured(f64, WidthFrom),
}

/// The same; and whether `width` was used.
pub fn read_as(text: &str, base_dir: &Path, width: Width) -> Result<(DesignFile, bool), LocatedDefects> {
    if text.len() > LARGEST_FILE {
        let defect = DesignDefect::TooLarge { limit: LARGEST_FILE };
        return Err(LocatedDefects::new(vec![(defect, 0..0)], 0, text));
    }
    let (document, syntax) = DeTable::parse_recoverable(text);
    let mut walk = Walk { reader: Reader::new(text, syntax), base_dir, width };
    let design = walk.design(&Section::root(&document));
    let is_measured = walk.reader.measures_width;
    let mut sources = walk.reader.finish()?;
    // Every missing key has been reported already, so this is the only exit without a design.
    let Some(design) = design else {
        let defect = DesignDefect::Missing { key: "connector".to_owned(), advice: NO_CONNECTOR };
        return Err(LocatedDefects::new(vec![(defect, 0..0)], 0, text));
    };
    sources.insert(String::new(), 0..0);
    Ok((DesignFile { design, sources }, is_measured))
}

const NO_CONNECTOR: &str = "name a built-in family: [connector] family = \"pyramid\"; or give own halves: \
                            [connector.fixed] and [connector.moving]. `catchment new` writes a starting point";

/// Whose parameters the file gives.
#[derive(Clone, Copy, PartialEq)]
enum Owner {
    Family(Family),
    OwnHalves,
    /// The family is misspelt or missing: every parameter is let pass.
    Unknown,
}

impl Owner {
    const fn family(self) -> Option<Family> {
        match self {
            Self::Family(family) => Some(family),
            Self::OwnHalves | Self::Unknown => None,
        }
    }
}

pub(super) struct Walk<'t> {
    pub(super) reader: Reader<'t>,
    pub(super) base_dir: &'t Path,
    width: Width,
}

impl<'t> Walk<'t> {
    fn design(&mut self, root: &Section<'t>) -> Option<Design> {
        self.reader.refuse_unknown_keys(root, DesignTable::Root);
        if let Some((found, span)) = self.reader.integer(root, &keys::SCHEMA_KEY)
            && found != keys::SCHEMA
        {
            self.reader.report(DesignDefect::OtherSchema { found, known: keys::SCHEMA }, span);
        }
        let name = self.reader.line(root, &keys::NAME);
        let connector = self.reader.section(root, &keys::CONNECTOR);
        if !root.has(&keys::CONNECTOR) {
            self.reader.missing(root, &keys::CONNECTOR, NO_CONNECTOR);
        }
        let owner = connector.as_ref().map_or(Owner::Unknown, |section| self.owner(section));
        let scale = connector.as_ref().and_then(|section| self.scale(section, owner));
        let spec = connector.as_ref().and_then(|section| self.connector(section, owner, scale.as_ref()));
        let alignment = self.alignment(root, owner, spec.as_ref(), scale.as_ref());
        let (LengthScale { width, unit }, connector) = (scale?, spec?);
        let name =
            name.unwrap_or_else(|| owner.family().map_or("own halves", |family| family.name()).to_owned());
        Some(Design { name, connector, width, unit, alignment })
    }

    /// Family or own halves; reports an error for both, for neither, and for parameters of the wrong kind.
    fn owner(&mut self, section: &Section<'t>) -> Owner {
        self.reader.refuse_unknown_keys(section, DesignTable::Connector);
        let halves = [keys::FIXED, keys::MOVING];
        let owner = if section.has(&keys::FAMILY) {
            for half in &halves {
                if let Some(span) = section.key_span(half) {
                    let defect = DesignDefect::Contradiction {
                        key: section.place(half.name),
                        other: section.place(keys::FAMILY.name),
                        advice: "a design has a built-in family or own halves: remove one of them",
                    };
                    self.reader.report(defect, span);
                }
            }
            self.reader.family(section, &keys::FAMILY).map_or(Owner::Unknown, Owner::Family)
        } else if halves.iter().any(|half| section.has(half)) {
            Owner::OwnHalves
        } else {
            self.reader.missing(section, &keys::FAMILY, NO_CONNECTOR);
            Owner::Unknown
        };
        if owner == Owner::Unknown {
            return owner;
        }
        for key in DesignTable::Connector.keys().filter(|key| !key.applies.to(owner.family())) {
            if let Some(span) = section.key_span(key)
                && !halves.contains(key)
            {
                let defect = DesignDefect::NotAParameter {
                    key: key.name.to_owned(),
                    owner: owner.family().map_or("own halves", Family::name),
                    belongs_to: key.applies.to_string(),
                };
                self.reader.report(defect, span);
            }
        }
        owner
    }

    /// Width and unit; `None` if either is wrong.
    fn scale(&mut self, section: &Section<'t>, owner: Owner) -> Option<LengthScale> {
        let unit = self.reader.unit(section, &keys::UNIT);
        if section.has(&keys::UNIT) && unit.is_none() {
            return None;
        }
        if !section.has(&keys::WIDTH) {
            let width = match self.width {
                Width::Provisional(width) => Some(width.unwrap_or(1.0)),
                Width::Measured(width, _) => Some(width),
                Width::Written => None,
            };
            if let (Owner::OwnHalves, Some(width), Some(_)) = (owner, width, unit) {
                self.reader.measures_width = true;
                self.reader.is_provisional = matches!(self.width, Width::Provisional(_));
                return Some(LengthScale { width, unit });
            }
            if unit.is_some() {
                self.reader.missing(section, &keys::WIDTH, "a design with a unit needs its D: width = 50.0");
                return None;
            }
            return Some(LengthScale { width: 1.0, unit });
        }
        // In "widths of 1 unit", the number is the width in the unit of the design.
        let width = self.reader.number(section, &keys::WIDTH, Some(&LengthScale { width: 1.0, unit }))?;
        Some(LengthScale { width, unit })
    }

    /// Whether round surfaces are drawn coarsely, because D is not known yet.
    pub(super) fn is_rough(&self) -> bool {
        self.reader.measures_width && self.width == Width::Provisional(None)
    }

    fn connector(
        &mut self,
        section: &Section<'t>,
        owner: Owner,
        scale: Option<&LengthScale>,
    ) -> Option<ConnectorSpec> {
        // The parameters of an unknown family are checked against the ranges of the pyramid.
        let spec = self.family_spec(section, owner.family().unwrap_or(Family::Pyramid), scale);
        match owner {
            Owner::Family(_) => Some(ConnectorSpec::Family(spec)),
            Owner::OwnHalves => self.own_spec(section, scale).map(ConnectorSpec::Own),
            Owner::Unknown => None,
        }
    }

    /// Every parameter that is written is checked, also those that the family does not have.
    fn family_spec(
        &mut self,
        section: &Section<'t>,
        family: Family,
        scale: Option<&LengthScale>,
    ) -> FamilySpec {
        let mut spec = FamilySpec::new(family);
        let of_families = |key: &&Key| matches!(key.applies, Applies::AnyFamily | Applies::Families(_));
        for key in DesignTable::Connector.keys().filter(of_families) {
            let value = match key.kind {
                ValueKind::Whole { .. } => self.reader.whole(section, key).map(Value::Whole),
                ValueKind::Flag => self.reader.flag(section, key).map(Value::Flag),
                _ => self.reader.number(section, key, scale).map(Value::Number),
            };
            if let Some(value) = value {
                spec.set(key, value);
            }
        }
        spec
    }

    fn own_spec(&mut self, section: &Section<'t>, scale: Option<&LengthScale>) -> Option<OwnSpec> {
        let is_assembled = self.reader.is_assembled(section, &keys::DRAWN).unwrap_or_default();
        let approach = self.reader.direction(section, &keys::APPROACH);
        let face_center = self.reader.triple(section, &keys::FACE_CENTER, scale);
        let face_height = self.reader.number(section, &keys::FACE_HEIGHT, scale);
        let (drawn, not_its_own) = if is_assembled {
            let approach = approach.unwrap_or([0.0, 0.0, -1.0]);
            (DrawnFrames::Assembled { approach, face_center }, &[keys::FACE_HEIGHT][..])
        } else {
            (DrawnFrames::Facing, &[keys::APPROACH, keys::FACE_CENTER][..])
        };
        for key in not_its_own {
            self.reader.not_drawn_so(section, key, is_assembled);
        }
        let settle = self.reader.flag(section, &keys::SETTLE).unwrap_or_default();
        let fixed = self.half(section, &keys::FIXED, is_assembled, scale);
        let moving = self.half(section, &keys::MOVING, is_assembled, scale);
        let ((fixed, fixed_placement), (moving, moving_placement)) = (fixed?, moving?);
        let width_from = match self.width {
            Width::Measured(_, from) if self.reader.measures_width => from,
            _ => WidthFrom::Written,
        };
        Some(OwnSpec {
            face_height,
            drawn,
            width_from,
            settle,
            fixed,
            moving,
            fixed_placement,
            moving_placement,
        })
    }

    fn alignment(
        &mut self,
        root: &Section<'t>,
        owner: Owner,
        connector: Option<&ConnectorSpec>,
        scale: Option<&LengthScale>,
    ) -> Alignment {
        let mut alignment = Alignment::default_for(owner.family());
        if let Some(section) = self.reader.section(root, &keys::ALIGNMENT) {
            self.reader.refuse_unknown_keys(&section, DesignTable::Alignment);
            self.freedom(&section, connector, &mut alignment);
            if let Some(cor) = self.reader.number(&section, &keys::CENTER_OF_ROTATION, scale) {
                alignment.center_of_rotation = cor;
            }
            if let Some(length) = self.reader.number(&section, &keys::ROTATION_LENGTH, scale) {
                alignment.rotation_length = length;
            }
            if let Some(mount) = self.reader.mount(&section, &keys::MOUNT) {
                alignment.mount = mount;
            }
            if let Some(symmetry) = self.reader.whole(&section, &keys::SYMMETRY) {
                alignment.symmetry = symmetry;
            }
        }
        if let Some(section) = self.reader.section(root, &keys::ERRORS) {
            self.reader.refuse_unknown_keys(&section, DesignTable::Errors);
            for (half_range, key) in alignment.half_ranges.iter_mut().zip(&keys::ERROR_KEYS) {
                if let Some(number) = self.reader.number(&section, key, scale) {
                    *half_range = number;
                }
            }
            if let (Some(defect), Some(span)) =
                (alignment.beyond_the_pole(), section.key_span(&keys::ERROR_PITCH))
            {
                self.reader.report(defect, span);
            }
        }
        if let Some(section) = self.reader.section(root, &keys::DOCKED) {
            self.reader.refuse_unknown_keys(&section, DesignTable::Docked);
            if let Some(depth) = self.reader.number(&section, &keys::DOCKED_DEPTH, scale) {
                alignment.docked.depth = depth;
            }
            for (limit, key) in alignment.docked.limits.iter_mut().zip(&keys::DOCKED_KEYS) {
                *limit = self.reader.number(&section, key, scale);
            }
        }
        alignment
    }

    /// `free` and `dont_care`.
    fn freedom(
        &mut self,
        section: &Section<'t>,
        connector: Option<&ConnectorSpec>,
        alignment: &mut Alignment,
    ) {
        let family = match connector {
            Some(ConnectorSpec::Family(spec)) => Some(spec),
            Some(ConnectorSpec::Own(_)) | None => None,
        };
        let set = |list: &[(Dof, _)]| list.iter().map(|(dof, _)| *dof).collect::<DofSet>();
        if let Some(list) = self.reader.dofs(section, &keys::FREE) {
            let empty = self
                .reader
                .raw(section, &keys::FREE)
                .filter(|value| matches!(value.get_ref(), DeValue::Array(elements) if elements.is_empty()));
            if let Some(value) = empty {
                let defect = DesignDefect::nothing_free(section.place(keys::FREE.name));
                self.reader.report(defect, value.span());
            }
            for (dof, span) in &list {
                if let Some(defect) = DesignDefect::out_of_plane(*dof, family) {
                    self.reader.report(defect, span.clone());
                }
            }
            alignment.free = set(&list);
            // A listed error overrides the default.
            for (dof, _) in &list {
                alignment.dont_care = alignment.dont_care.without(*dof);
            }
        }
        if let Some(list) = self.reader.dofs(section, &keys::DONT_CARE) {
            let free_is_written = section.has(&keys::FREE);
            for (dof, span) in &list {
                if !dof.is_rotation() {
                    self.reader.report(DesignDefect::DontCareTranslation { dof: *dof }, span.clone());
                } else if free_is_written && alignment.free.contains(*dof) {
                    self.reader.report(DesignDefect::FreeAndDontCare { dof: *dof }, span.clone());
                }
            }
            alignment.dont_care = set(&list);
            for (dof, _) in &list {
                alignment.free = alignment.free.without(*dof);
            }
        }
    }
}
