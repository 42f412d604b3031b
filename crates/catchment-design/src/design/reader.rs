//! A typed traversal of a TOML document that records every error and continues.
//!
//! A getter returns `None` if the key is absent *or* its value is wrong; in the second case the error is on
//! the list, and a document with errors never becomes a design.

use super::defect::DesignDefect;
use super::keys::{self, DesignTable, Key, ValueKind};
use super::located_defect::{LocatedDefects, Sources};
use super::quantity::{LengthScale, Quantity, QuantityUnit, shortened};
use super::section::Section;
use super::{Family, LengthUnit};
use catchment_base::pose::{Dof, Mount};
use catchment_base::suggest::{nearest, value_help};
use glam::DVec3;
use std::ops::Range;
use toml::Spanned;
use toml::de::DeValue;

/// The ways to draw halves, and whether they are drawn assembled.
pub(super) const DRAWN: [(&str, bool); 2] = [("facing", false), ("assembled", true)];

/// Directions by name.
pub(super) const DIRECTIONS: [(&str, [f64; 3]); 6] = [
    ("+x", [1.0, 0.0, 0.0]),
    ("-x", [-1.0, 0.0, 0.0]),
    ("+y", [0.0, 1.0, 0.0]),
    ("-y", [0.0, -1.0, 0.0]),
    ("+z", [0.0, 0.0, 1.0]),
    ("-z", [0.0, 0.0, -1.0]),
];

/// Collects problems and sources.
pub(super) struct Reader<'t> {
    text: &'t str,
    defects: Vec<(DesignDefect, Range<usize>)>,
    omitted: usize,
    broken: Vec<Range<usize>>,
    pub sources: Sources,
    /// Whether D is measured from the halves, so that the lengths that draw them cannot be in D.
    pub measures_width: bool,
    /// Whether D is not known yet: ranges are checked when it is.
    pub is_provisional: bool,
}

/// Problems kept before they are sorted: enough that the first [`LocatedDefects::MOST`] are among them unless the
/// file is hopeless, few enough that a hopeless one costs nothing.
const MOST_KEPT: usize = 1000;

impl<'t> Reader<'t> {
    pub(super) fn new(text: &'t str, syntax: Vec<toml::de::Error>) -> Self {
        let mut reader = Self {
            text,
            defects: Vec::new(),
            omitted: 0,
            broken: Vec::new(),
            sources: Sources::default(),
            measures_width: false,
            is_provisional: false,
        };
        for error in syntax {
            let span = error.span().unwrap_or(0..0);
            let syntax = || DesignDefect::Syntax {
                message: error.message().to_owned(),
                help: value_help(text, span.start),
            };
            reader.note(syntax, span.clone());
            if reader.broken.len() < MOST_KEPT {
                reader.broken.push(span);
            }
        }
        reader
    }

    /// All problems, if any.
    pub(super) fn finish(self) -> Result<Sources, LocatedDefects> {
        if self.defects.is_empty() {
            Ok(self.sources)
        } else {
            Err(LocatedDefects::new(self.defects, self.omitted, self.text))
        }
    }

    fn note(&mut self, defect: impl FnOnce() -> DesignDefect, span: Range<usize>) {
        if self.defects.len() < MOST_KEPT {
            self.defects.push((defect(), span));
        } else {
            self.omitted += 1;
        }
    }

    /// Notes a problem, unless it is the echo of a syntax error at the same place.
    pub(super) fn report(&mut self, defect: DesignDefect, span: Range<usize>) {
        self.complain_with(|| defect, span);
    }

    /// The same; it is spelled out only if it is kept.
    fn complain_with(&mut self, defect: impl FnOnce() -> DesignDefect, span: Range<usize>) {
        let echo = self.broken.iter().any(|b| b.start <= span.end && span.start <= b.end);
        if !echo {
            self.note(defect, span);
        }
    }

    /// Notes that something is not there, unless syntax errors may have swallowed it.
    pub(super) fn missing(&mut self, section: &Section<'t>, key: &Key, advice: &'static str) {
        if self.broken.is_empty() {
            let defect = DesignDefect::Missing { key: section.place(key.name), advice };
            self.report(defect, section.span.clone());
        }
    }

    /// Reports an error for a part without a shape.
    pub(super) fn missing_shape(&mut self, section: &Section<'t>, advice: &'static str) {
        if self.broken.is_empty() {
            let defect = DesignDefect::NoShape { key: section.path.clone(), advice };
            self.report(defect, section.span.clone());
        }
    }

    fn wrong_type(&mut self, place: String, expected: &'static str, value: &Spanned<DeValue<'t>>) {
        let defect = DesignDefect::WrongType { key: place, expected, found: value.get_ref().type_str() };
        self.report(defect, value.span());
    }

    fn out_of_range(&mut self, key: &Key, found: String, range: keys::Range, span: Range<usize>) {
        let defect = DesignDefect::OutOfRange { key: key.name.to_owned(), found, range, doc: key.doc };
        self.report(defect, span);
    }

    /// Reports an error for each key that `table` does not have.
    pub(super) fn refuse_unknown_keys(&mut self, section: &Section<'t>, table: DesignTable) {
        for (name, _) in section.table {
            let written: &str = name.get_ref();
            if table.keys().any(|key| key.name == written) {
                continue;
            }
            let defect = || DesignDefect::UnknownKey {
                key: shortened(written),
                table: table.name(),
                meant: nearest(written, table.keys().map(|key| key.name)),
                elsewhere: DesignTable::ALL
                    .into_iter()
                    .find(|other| other.keys().any(|key| key.name == written))
                    .map(DesignTable::name),
                known: table.keys().map(|key| key.name).collect(),
            };
            self.complain_with(defect, name.span());
        }
    }

    fn value(&mut self, section: &Section<'t>, key: &Key) -> Option<&'t Spanned<DeValue<'t>>> {
        let (name, value) = section.entry(key.name)?;
        // After a syntax error the span of the value may be empty; the key's span is used instead.
        let span = if value.span().is_empty() { name.span() } else { value.span() };
        self.sources.insert(section.place(key.name), span);
        Some(value)
    }

    pub(super) fn section(&mut self, parent: &Section<'t>, key: &Key) -> Option<Section<'t>> {
        let value = self.value(parent, key)?;
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(parent.place(key.name), "a table", value);
            return None;
        };
        Some(Section { path: parent.place(key.name), span: value.span(), table })
    }

    /// A table that is a member of a list, `place` in the file.
    pub(super) fn member(&mut self, place: String, value: &'t Spanned<DeValue<'t>>) -> Option<Section<'t>> {
        self.sources.insert(place.clone(), value.span());
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(place, "a table", value);
            return None;
        };
        Some(Section { path: place, span: value.span(), table })
    }

    /// A string and its place.
    pub(super) fn string(&mut self, section: &Section<'t>, key: &Key) -> Option<(&'t str, Range<usize>)> {
        let value = self.value(section, key)?;
        let DeValue::String(text) = value.get_ref() else {
            self.wrong_type(section.place(key.name), "a string", value);
            return None;
        };
        Some((text, value.span()))
    }

    /// A line for people.
    pub(super) fn line(&mut self, section: &Section<'t>, key: &Key) -> Option<String> {
        let (text, span) = self.string(section, key)?;
        let place = section.place(key.name);
        if text.trim().is_empty() {
            self.report(DesignDefect::Empty { key: place, advice: "write a name, or remove the key" }, span);
            None
        } else if text.chars().count() > keys::LONGEST_LINE || text.contains(char::is_control) {
            self.report(DesignDefect::NotALine { key: place, longest: keys::LONGEST_LINE }, span);
            None
        } else {
            Some(text.to_owned())
        }
    }

    pub(super) fn flag(&mut self, section: &Section<'t>, key: &Key) -> Option<bool> {
        let value = self.value(section, key)?;
        let DeValue::Boolean(flag) = value.get_ref() else {
            self.wrong_type(section.place(key.name), "true or false", value);
            return None;
        };
        Some(*flag)
    }

    /// A whole number and its place, unchecked.
    pub(super) fn integer(&mut self, section: &Section<'t>, key: &Key) -> Option<(i64, Range<usize>)> {
        let value = self.value(section, key)?;
        let DeValue::Integer(integer) = value.get_ref() else {
            self.wrong_type(section.place(key.name), "a whole number", value);
            return None;
        };
        // Beyond 64 bits every range refuses it.
        let number = i64::from_str_radix(integer.as_str(), integer.radix()).unwrap_or(i64::MAX);
        Some((number, value.span()))
    }

    /// A whole number in the range of its key.
    pub(super) fn whole(&mut self, section: &Section<'t>, key: &Key) -> Option<u32> {
        let (number, span) = self.integer(section, key)?;
        let ValueKind::Whole { min, max } = key.kind else { return None };
        match u32::try_from(number) {
            Ok(number) if (min..=max).contains(&number) => Some(number),
            _ => {
                let range = keys::Range { min: f64::from(min), max: f64::from(max), unit: "" };
                self.out_of_range(key, number.to_string(), range, span);
                None
            }
        }
    }

    /// A finite number, with a unit or bare.
    pub(super) fn quantity(&mut self, place: &str, value: &Spanned<DeValue<'t>>) -> Option<Quantity> {
        let number = match value.get_ref() {
            DeValue::String(text) => {
                let quantity = match text.parse::<Quantity>() {
                    Ok(Quantity { unit: QuantityUnit::Bare, .. }) => {
                        Err(DesignDefect::NoUnit { text: shortened(text) })
                    }
                    other => other,
                };
                return quantity.map_err(|defect| self.report(defect, value.span())).ok();
            }
            DeValue::Integer(integer) => {
                i64::from_str_radix(integer.as_str(), integer.radix()).map_or(f64::INFINITY, |i| i as f64)
            }
            DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::NAN),
            _ => {
                self.wrong_type(place.to_owned(), "a number, or a string such as \"5 mm\"", value);
                return None;
            }
        };
        if number.is_finite() {
            return Some(Quantity { value: number, unit: QuantityUnit::Bare });
        }
        let text = shortened(&self.text[value.span()]);
        self.report(DesignDefect::NotFinite { text }, value.span());
        None
    }

    /// The number of a key in the unit of its range (D, radians or without a unit). `scale` is `None` if the
    /// width or the unit of the design is wrong: values that need them are then not checked.
    pub(super) fn number(
        &mut self,
        section: &Section<'t>,
        key: &Key,
        scale: Option<&LengthScale>,
    ) -> Option<f64> {
        let value = self.value(section, key)?;
        self.checked(&section.place(key.name), key, value, scale)
    }

    /// A value as the number of a key.
    pub(super) fn checked(
        &mut self,
        place: &str,
        key: &Key,
        value: &Spanned<DeValue<'t>>,
        scale: Option<&LengthScale>,
    ) -> Option<f64> {
        let quantity = self.quantity(place, value)?;
        if self.measures_width
            && quantity.unit == QuantityUnit::D
            && matches!(key.kind, ValueKind::DrawnLength(_))
        {
            self.report(DesignDefect::ShapesWidth { text: quantity.to_string() }, value.span());
            return None;
        }
        match key.checked(quantity, scale) {
            Ok(number) => number,
            Err(DesignDefect::OutOfRange { .. }) if self.is_provisional && key.depends_on_width(quantity) => {
                key.unchecked(quantity, scale)
            }
            Err(defect) => {
                self.report(defect, value.span());
                None
            }
        }
    }

    fn name<T: Copy>(
        &mut self,
        what: &'static str,
        known: &[(&'static str, T)],
        (written, span): (&str, Range<usize>),
    ) -> Option<T> {
        if let Some((_, value)) = known.iter().find(|(name, _)| *name == written) {
            return Some(*value);
        }
        self.report(unknown_name(what, written, known.iter().map(|(name, _)| *name)), span);
        None
    }

    pub(super) fn unit(&mut self, section: &Section<'t>, key: &Key) -> Option<LengthUnit> {
        let written = self.string(section, key)?;
        self.name("unit", &LengthUnit::ALL.map(|unit| (unit.symbol(), unit)), written)
    }

    pub(super) fn family(&mut self, section: &Section<'t>, key: &Key) -> Option<Family> {
        let written = self.string(section, key)?;
        self.name("family", &Family::ALL.map(|family| (family.name(), family)), written)
    }

    pub(super) fn mount(&mut self, section: &Section<'t>, key: &Key) -> Option<Mount> {
        let written = self.string(section, key)?;
        self.name("mount", &[("x", Mount::X), ("y", Mount::Y)], written)
    }

    /// Whether halves are drawn assembled.
    pub(super) fn is_assembled(&mut self, section: &Section<'t>, key: &Key) -> Option<bool> {
        let written = self.string(section, key)?;
        self.name("way to draw halves", &DRAWN, written)
    }

    /// Reports an error for a key of halves that are drawn the other way.
    pub(super) fn not_drawn_so(&mut self, section: &Section<'t>, key: &Key, is_assembled: bool) {
        if let Some(span) = section.key_span(key) {
            let [facing, assembled] = ["halves that are drawn facing +z", "halves that are drawn assembled"];
            let (owner, belongs_to) = if is_assembled { (assembled, facing) } else { (facing, assembled) };
            let belongs_to = belongs_to.to_owned();
            let defect = DesignDefect::NotAParameter { key: key.name.to_owned(), owner, belongs_to };
            self.report(defect, span);
        }
    }

    /// A unit vector.
    pub(super) fn direction(&mut self, section: &Section<'t>, key: &Key) -> Option<[f64; 3]> {
        let value = self.value(section, key)?;
        let place = section.place(key.name);
        if let DeValue::String(text) = value.get_ref() {
            return self.name("direction", &DIRECTIONS, (text, value.span()));
        }
        let expected = "a direction such as \"-z\", or [x, y, z]";
        let number = |reader: &mut Self, place: &str, element: &Spanned<DeValue<'t>>| {
            let Quantity { value, unit } = reader.quantity(place, element)?;
            if unit == QuantityUnit::Bare {
                return Some(value);
            }
            reader.wrong_type(place.to_owned(), "a bare number", element);
            None
        };
        let vector = DVec3::from_array(self.three(&place, expected, value, number)?);
        let unit = vector.try_normalize();
        if unit.is_none() {
            self.report(DesignDefect::NoDirection { key: place }, value.span());
        }
        Some(unit?.to_array())
    }

    /// Three numbers in the unit of the key's range.
    pub(super) fn triple(
        &mut self,
        section: &Section<'t>,
        key: &Key,
        scale: Option<&LengthScale>,
    ) -> Option<[f64; 3]> {
        let value = self.value(section, key)?;
        let place = section.place(key.name);
        let element = key.element();
        self.three(&place, "a list [x, y, z]", value, |reader, place, value| {
            reader.checked(place, &element, value, scale)
        })
    }

    /// A list of three, each read by `one`; all are checked, even after an error.
    pub(super) fn three<T>(
        &mut self,
        place: &str,
        expected: &'static str,
        value: &'t Spanned<DeValue<'t>>,
        one: impl FnMut(&mut Self, &str, &'t Spanned<DeValue<'t>>) -> Option<T>,
    ) -> Option<[T; 3]> {
        self.several(place, expected, value, one)
    }

    /// A list of two, in the same way.
    pub(super) fn two<T>(
        &mut self,
        place: &str,
        expected: &'static str,
        value: &'t Spanned<DeValue<'t>>,
        one: impl FnMut(&mut Self, &str, &'t Spanned<DeValue<'t>>) -> Option<T>,
    ) -> Option<[T; 2]> {
        self.several(place, expected, value, one)
    }

    fn several<T, const N: usize>(
        &mut self,
        place: &str,
        expected: &'static str,
        value: &'t Spanned<DeValue<'t>>,
        mut one: impl FnMut(&mut Self, &str, &'t Spanned<DeValue<'t>>) -> Option<T>,
    ) -> Option<[T; N]> {
        let elements = self.array(place, expected, value)?;
        if elements.len() != N {
            let defect = DesignDefect::NotAPoint { key: place.to_owned(), found: elements.len(), needed: N };
            self.report(defect, value.span());
            return None;
        }
        let read: Vec<Option<T>> = elements.iter().map(|element| one(self, place, element)).collect();
        read.into_iter().collect::<Option<Vec<T>>>()?.try_into().ok()
    }

    /// The elements of an array.
    pub(super) fn array(
        &mut self,
        place: &str,
        expected: &'static str,
        value: &'t Spanned<DeValue<'t>>,
    ) -> Option<&'t [Spanned<DeValue<'t>>]> {
        let DeValue::Array(array) = value.get_ref() else {
            self.wrong_type(place.to_owned(), expected, value);
            return None;
        };
        Some(array)
    }

    /// The value of a key that is read by the caller.
    pub(super) fn raw(&mut self, section: &Section<'t>, key: &Key) -> Option<&'t Spanned<DeValue<'t>>> {
        self.value(section, key)
    }

    /// A list of distinct degrees of freedom, each with its place.
    pub(super) fn dofs(&mut self, section: &Section<'t>, key: &Key) -> Option<Vec<(Dof, Range<usize>)>> {
        let value = self.value(section, key)?;
        let place = section.place(key.name);
        let elements = self.array(&place, "a list such as [\"x\", \"pitch\"]", value)?;
        let known = Dof::ALL.map(|dof| (dof.name(), dof));
        let mut list: Vec<(Dof, Range<usize>)> = Vec::new();
        for element in elements {
            let DeValue::String(text) = element.get_ref() else {
                self.wrong_type(place.clone(), "a list of strings", element);
                continue;
            };
            let Some(dof) = self.name("degree of freedom", &known, (text, element.span())) else { continue };
            if list.iter().any(|(other, _)| *other == dof) {
                self.report(DesignDefect::Repeated { dof }, element.span());
            } else {
                list.push((dof, element.span()));
            }
        }
        Some(list)
    }
}

/// The defect about a word that is none of `known`.
pub(super) fn unknown_name(
    what: &'static str,
    written: &str,
    known: impl Iterator<Item = &'static str> + Clone,
) -> DesignDefect {
    DesignDefect::UnknownName {
        what,
        name: shortened(written),
        meant: nearest(written, known.clone()),
        known: known.collect(),
    }
}
