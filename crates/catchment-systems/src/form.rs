//! A filled-in form: a TOML file of lengths, angles and choices, read completely, with the place of every
//! error.
//!
//! ```
//! use catchment::design::SourceText;
//! use catchment_systems::form::{Form, FormTable};
//!
//! #[derive(Debug)]
//! struct Arm { length: f64, angle: f64 }
//!
//! fn arm(form: &mut Form<'_>, root: &FormTable<'_>) -> Arm {
//!     let table = form.table(root, "arm");
//!     let length = form.length(&table, "length", 1.0..=1000.0, Some(100.0));
//!     let angle = form.angle(&table, "angle", 0.0..=1.6, None);
//!     form.close(&table);
//!     form.close(root);
//!     Arm { length, angle }
//! }
//!
//! let read = |text: &str| Form::read(SourceText::new("arm.toml", text), arm);
//! let arm = read("[arm]\nlength = '5 cm'\nangle = '30 deg'").unwrap();
//! assert!((arm.length - 50.0).abs() < 1e-12 && arm.angle < 0.53);
//! let refused = read("[arm]\nlenght = 5\nangle = '30 mm'").unwrap_err();
//! assert_eq!(refused.list.len(), 2);
//! assert!(refused.to_string().contains("arm.toml:2:1: unknown key `lenght` in [arm]; did you mean `length`?"));
//! ```
//!
//! Lengths are in millimetres, bare or with a unit; angles are in radians, bare or with a unit. An absent key
//! has its default; a key without a default is required. A getter also returns its default, or the end of its
//! range, if the value is wrong: the error is then on the list, and [`Form::read`] returns the list.

use catchment::design::{DesignDefect, LengthUnit, Quantity, QuantityUnit, SourceText, nearest};
use catchment::diagnostic::{Diagnostic, Diagnostics};
use catchment::suggest::{odd, value_help};
use std::cell::RefCell;
use std::fmt::Display;
use std::ops::{Range, RangeInclusive};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Number of errors that are listed; further ones are counted.
const MOST: usize = 20;

/// Collects the errors of a text.
#[derive(Debug)]
pub struct Form<'t> {
    diagnostics: Vec<Diagnostic>,
    /// Ranges in which the text is not TOML: errors there are consequences, and missing keys may have been
    /// lost.
    broken: Vec<Range<usize>>,
    text: &'t str,
}

/// A table of a form. It records the requested keys: all others are unknown.
#[derive(Debug)]
pub struct FormTable<'t> {
    path: String,
    span: Range<usize>,
    table: Option<&'t DeTable<'t>>,
    known: RefCell<Vec<&'static str>>,
}

/// A string or a number, with its place.
#[derive(Debug, Clone)]
pub struct Word<'t> {
    /// As written.
    pub text: &'t str,
    /// Its bytes in the file.
    pub span: Range<usize>,
}

impl<'t> FormTable<'t> {
    /// Byte range of the table.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Whether a key is written.
    pub fn has(&self, key: &'static str) -> bool {
        self.table.is_some_and(|table| table.contains_key(key))
    }

    /// Whether the table itself is written.
    pub fn is_written(&self) -> bool {
        self.table.is_some()
    }

    /// Byte range of a key's value; of the table if the key is missing.
    pub fn span_of(&self, key: &'static str) -> Range<usize> {
        self.table.and_then(|table| table.get(key)).map_or_else(|| self.span(), Spanned::span)
    }

    fn place(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn value(&self, key: &'static str) -> Option<&'t Spanned<DeValue<'t>>> {
        self.known.borrow_mut().push(key);
        self.table?.get(key)
    }
}

impl Form<'_> {
    /// Reads a file.
    ///
    /// # Errors
    /// All problems of the text, in order.
    pub fn read<T>(
        source: SourceText,
        fill: impl FnOnce(&mut Form<'_>, &FormTable<'_>) -> T,
    ) -> Result<T, Diagnostics> {
        let (document, syntax) = DeTable::parse_recoverable(&source.text);
        let broken = syntax.iter().map(|e| e.span().unwrap_or_default()).collect();
        let refused = |error: toml::de::Error| {
            let help = value_help(&source.text, error.span().unwrap_or_default().start);
            Diagnostic::error("file", error.message(), help).at(error.span())
        };
        let diagnostics = syntax.into_iter().map(refused).collect();
        let mut form = Form { diagnostics, broken, text: &source.text };
        let root = FormTable {
            path: String::new(),
            span: 0..0,
            table: Some(document.get_ref()),
            known: RefCell::default(),
        };
        let value = fill(&mut form, &root);
        let mut list = form.diagnostics;
        if list.is_empty() {
            return Ok(value);
        }
        list.sort_by_key(|diagnostic| diagnostic.span.as_ref().map_or(0, |span| span.start));
        let omitted = list.len().saturating_sub(MOST);
        list.truncate(MOST);
        drop(document);
        Err(Diagnostics { source: Some(source), list, omitted })
    }
}

impl<'t> Form<'t> {
    /// Notes a problem at a place of the text.
    pub fn refuse(&mut self, span: Range<usize>, message: impl Into<String>, help: Option<&str>) {
        if !self.broken.iter().any(|b| b.start <= span.end && span.start <= b.end) {
            self.diagnostics.push(Diagnostic::error("file", message, help.map(str::to_owned)).at(Some(span)));
        }
    }

    /// Whether there is any error so far: then conditions on several values need not be checked.
    pub fn is_refused(&self) -> bool {
        !self.diagnostics.is_empty()
    }

    /// The text between two bytes.
    pub fn text(&self, span: Range<usize>) -> &'t str {
        self.text.get(span).unwrap_or_default()
    }

    fn wrong(&mut self, place: &str, expected: &str, value: &Spanned<DeValue<'_>>) {
        let result = value.get_ref().type_str();
        self.refuse(value.span(), format!("`{place}` should be {expected}, not {result}"), None);
    }

    fn missing(&mut self, section: &FormTable<'_>, key: &str, expected: &str) {
        if self.broken.is_empty() {
            let message = format!("`{}` is missing: {expected}", section.place(key));
            self.refuse(section.span(), message, None);
        }
    }

    /// A table; an empty table if it is missing.
    pub fn table<'s>(&mut self, parent: &FormTable<'s>, key: &'static str) -> FormTable<'s> {
        let path = parent.place(key);
        let none = |span| FormTable { path: path.clone(), span, table: None, known: RefCell::default() };
        let Some(value) = parent.value(key) else { return none(parent.span()) };
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong(&path, "a table", value);
            return none(value.span());
        };
        FormTable { path, span: value.span(), table: Some(table), known: RefCell::default() }
    }

    /// The tables of an array, `[[key]]`.
    pub fn tables<'s>(&mut self, parent: &FormTable<'s>, key: &'static str) -> Vec<FormTable<'s>> {
        let path = parent.place(key);
        let Some(value) = parent.value(key) else { return Vec::new() };
        let DeValue::Array(array) = value.get_ref() else {
            self.wrong(&path, "an array of tables", value);
            return Vec::new();
        };
        let mut sections = Vec::new();
        for (k, entry) in array.iter().enumerate() {
            let path = format!("{path}[{k}]");
            if let DeValue::Table(table) = entry.get_ref() {
                let known = RefCell::default();
                sections.push(FormTable { path, span: entry.span(), table: Some(table), known });
            } else {
                self.wrong(&path, "a table", entry);
            }
        }
        sections
    }

    /// Reports every key that was not requested.
    pub fn close(&mut self, section: &FormTable<'_>) {
        let known = section.known.borrow();
        let named =
            if section.path.is_empty() { "the file".to_owned() } else { format!("[{}]", section.path) };
        for (name, _) in section.table.into_iter().flat_map(DeTable::iter) {
            let written: &str = name.get_ref();
            if known.contains(&written) {
                continue;
            }
            let help = match nearest(written, known.iter().copied()) {
                Some(meant) => format!("did you mean `{meant}`?"),
                None => format!("it has {}", known.join(", ")),
            };
            self.refuse(
                name.span(),
                format!("unknown key `{written}` in {named}{}", odd(written)),
                Some(&help),
            );
        }
    }

    /// A length, in millimetres.
    pub fn length(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        range: RangeInclusive<f64>,
        default: Option<f64>,
    ) -> f64 {
        self.quantity(section, key, "a length", "mm", range, default, millimetres)
    }

    /// An angle, in radians.
    pub fn angle(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        range: RangeInclusive<f64>,
        default: Option<f64>,
    ) -> f64 {
        let angle = |q: Quantity| q.angle_rad().map_err(|error| error.to_string());
        self.quantity(section, key, "an angle", "rad", range, default, angle)
    }

    /// A number.
    pub fn number(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        range: RangeInclusive<f64>,
        default: Option<f64>,
    ) -> f64 {
        let bare = |q: Quantity| match q.unit {
            QuantityUnit::Bare => Ok(q.value),
            _ => Err(format!("`{q}` is a number with a unit where a bare one is wanted")),
        };
        self.quantity(section, key, "a number", "", range, default, bare)
    }

    #[expect(clippy::too_many_arguments, reason = "the three kinds of quantities differ in all of them")]
    fn quantity(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        kind: &str,
        unit: &str,
        range: RangeInclusive<f64>,
        default: Option<f64>,
        meaning: impl Fn(Quantity) -> Result<f64, String>,
    ) -> f64 {
        let fallback = default.unwrap_or(*range.start());
        let between = format!("{kind} from {} to {} {unit}", range.start(), range.end());
        let Some(value) = section.value(key) else {
            if default.is_none() {
                self.missing(section, key, between.trim_end());
            }
            return fallback;
        };
        let place = section.place(key);
        self.quantity_of(value, &place, kind, &meaning).map_or(fallback, |number| {
            if !range.contains(&number) {
                let written = self.text(value.span());
                let message = format!("`{place}` is {written}, which is not {}", between.trim_end());
                self.refuse(value.span(), message, None);
            }
            number
        })
    }

    fn quantity_of(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        place: &str,
        kind: &str,
        meaning: &impl Fn(Quantity) -> Result<f64, String>,
    ) -> Option<f64> {
        let text: &str = match value.get_ref() {
            DeValue::String(text) => text,
            DeValue::Integer(integer) => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            _ => {
                self.wrong(place, kind, value);
                return None;
            }
        };
        // TOML lets digits be grouped.
        let text = text.replace('_', "");
        let parsed = text.parse::<Quantity>();
        match parsed
            .map_err(|error: DesignDefect| message_and_advice(&error, error.help()))
            .and_then(|q| meaning(q).map_err(|message| (message, None)))
        {
            Ok(number) => Some(number),
            Err((message, help)) => {
                self.refuse(value.span(), format!("`{place}`: {message}"), help.as_deref());
                None
            }
        }
    }

    /// An array of lengths in millimetres, with the place of each.
    pub fn lengths(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
    ) -> Option<Vec<(f64, Range<usize>)>> {
        let value = section.value(key)?;
        let place = section.place(key);
        let DeValue::Array(array) = value.get_ref() else {
            self.wrong(&place, "an array of lengths", value);
            return None;
        };
        let result: Vec<_> = array
            .iter()
            .filter_map(|entry| {
                let length = self.quantity_of(entry, &place, "a length", &millimetres)?;
                Some((length, entry.span()))
            })
            .collect();
        Some(result)
    }

    /// A whole number.
    pub fn integer(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        range: RangeInclusive<i64>,
        default: Option<i64>,
    ) -> i64 {
        let fallback = default.unwrap_or(*range.start());
        let between = format!("a whole number from {} to {}", range.start(), range.end());
        let Some(value) = section.value(key) else {
            if default.is_none() {
                self.missing(section, key, &between);
            }
            return fallback;
        };
        let place = section.place(key);
        let DeValue::Integer(integer) = value.get_ref() else {
            self.wrong(&place, "a whole number", value);
            return fallback;
        };
        let digits = integer.as_str().replace('_', "");
        if let Some(number) = i64::from_str_radix(&digits, integer.radix()).ok().filter(|n| range.contains(n))
        {
            return number;
        }
        self.refuse(value.span(), format!("`{place}` is {integer}, which is not {between}"), None);
        fallback
    }

    /// True or false.
    pub fn flag(&mut self, section: &FormTable<'_>, key: &'static str, default: bool) -> bool {
        let Some(value) = section.value(key) else { return default };
        if let DeValue::Boolean(flag) = value.get_ref() {
            *flag
        } else {
            self.wrong(&section.place(key), "true or false", value);
            default
        }
    }

    /// A string and its place.
    pub fn word<'s>(&mut self, section: &FormTable<'s>, key: &'static str) -> Option<Word<'s>> {
        let value = section.value(key)?;
        if let DeValue::String(text) = value.get_ref() {
            Some(Word { text, span: value.span() })
        } else {
            self.wrong(&section.place(key), "a string", value);
            None
        }
    }

    /// A choice among the named values; the first is the default.
    pub fn choice<T: Copy>(
        &mut self,
        section: &FormTable<'_>,
        key: &'static str,
        known: &[(&'static str, T)],
    ) -> T {
        let Some(word) = self.word(section, key) else { return known[0].1 };
        if let Some((_, value)) = known.iter().find(|(name, _)| name.eq_ignore_ascii_case(word.text)) {
            return *value;
        }
        let names = known.iter().map(|(name, _)| *name);
        let help = match nearest(word.text, names.clone()) {
            Some(meant) => format!("did you mean \"{meant}\"?"),
            None => format!("it can be {}", names.map(|n| format!("\"{n}\"")).collect::<Vec<_>>().join(", ")),
        };
        let written = catchment::terminal::printable(word.text);
        self.refuse(word.span, format!("`{}` cannot be \"{written}\"", section.place(key)), Some(&help));
        known[0].1
    }
}

fn message_and_advice(error: &impl Display, help: Option<String>) -> (String, Option<String>) {
    (error.to_string(), help)
}

/// A length of the outside world.
fn millimetres(quantity: Quantity) -> Result<f64, String> {
    match quantity.unit {
        QuantityUnit::Bare => Ok(quantity.value),
        QuantityUnit::Length(unit) => Ok(quantity.value * (unit.metres() / LengthUnit::Mm.metres())),
        QuantityUnit::D => Err(format!("`{quantity}` is in D, where a length in mm is wanted")),
        QuantityUnit::Degrees | QuantityUnit::Radians => {
            Err(format!("`{quantity}` is an angle where a length is wanted"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusals(text: &str) -> String {
        let fill = |form: &mut Form<'_>, root: &FormTable<'_>| {
            let table = form.table(root, "a");
            form.length(&table, "length", 1.0..=10.0, Some(2.0));
            form.angle(&table, "angle", 0.0..=1.0, Some(0.5));
            form.integer(&table, "count", 1..=6, None);
            form.choice(&table, "kind", &[("round", 0), ("square", 1)]);
            form.flag(&table, "open", false);
            form.close(&table);
            for step in form.tables(root, "step") {
                form.number(&step, "time", 0.0..=10.0, None);
                form.close(&step);
            }
            form.close(root);
        };
        Form::read(SourceText::new("f.toml", text), fill).map_or_else(|e| e.to_string(), |()| String::new())
    }

    #[test]
    fn valid_values_are_read() {
        assert_eq!(refusals("[a]\nlength = 0.3\ncount = 2\n").lines().count(), 1);
        assert_eq!(
            refusals("[a]\nlength='1 in'\ncount=2\nkind='Square'\n"),
            "f.toml:2:8: `a.length` is '1 in', which is not a length from 1 to 10 mm"
        );
        assert_eq!(
            refusals("[a]\nlength='1 cm'\nangle='30 deg'\ncount=1_0\n[[step]]\ntime=1\n").lines().count(),
            1
        );
        assert_eq!(refusals("[a]\ncount=0x2\nopen=true"), "");
    }

    #[test]
    fn everything_wrong_is_reported_at_once_in_order() {
        let text = "[a]\nlength = '3 D'\nangle = '4 mm'\nkind = 'rond'\nopn = true\ncount = 9\n[[step]]\n";
        let words = refusals(text);
        let starts = words.lines().map(|line| line.split(' ').next().unwrap()).collect::<Vec<_>>();
        assert_eq!(
            starts,
            ["f.toml:2:10:", "f.toml:3:9:", "f.toml:4:8:", "f.toml:5:1:", "f.toml:6:9:", "f.toml:7:1:"]
        );
        assert!(
            words.contains("did you mean \"round\"?") && words.contains("did you mean `open`?"),
            "{words}"
        );
        assert!(words.contains("`step[0].time` is missing: a number from 0 to 10"), "{words}");
        assert!(!refusals("[a]\ncount = = 2").contains("should be"), "an echo of a syntax error");
        assert!(refusals("a = 3").contains("`a` should be a table, not integer"));
        assert!(refusals("[a]\ncount = 1\nlength = inf").contains("`a.length`: "));
    }
}
