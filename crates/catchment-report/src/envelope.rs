//! The common head of every JSON report, printed or stored.
//!
//! ```text
//!   { "schema": 4, "catchment": "0.1.0", "kind": "run",     version of the layout, program, kind of result
//!     … fields of the kind, at the top level …
//!     "warnings": […], "timing": … }                        timing: the only part that differs between equal runs
//! ```
//!
//! [`SCHEMA`] increases if a field changes its meaning or is removed, for all kinds together. New fields and
//! new kinds of warnings may appear under the same number: a reader ignores unknown fields. This program
//! reads the layouts from [`OLDEST`] on; a newer layout is rejected.

use super::schema::Timing;
use super::version::Version;
use catchment_core::diagnostic::Diagnostic;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::{Deref, DerefMut};

/// Version of the layout that is written.
pub const SCHEMA: u32 = 4;

/// The oldest layout that is read: 3 added `kind`, and a run of 2 lacks nothing else.
pub const OLDEST: u32 = 3;

/// Content of a report of a kind, besides its head.
pub trait ReportBody {
    /// Its name in `kind`.
    const KIND: &'static str;
}

/// A report: its head, and a body whose fields stand beside it. `report.design` is `report.body.design`.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportEnvelope<T> {
    /// Version of the program that wrote it.
    pub catchment: Version,
    /// The fields of its kind.
    pub body: T,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// Time of the computation; null if it was not measured.
    pub timing: Option<Timing>,
}

impl<T: ReportBody> ReportEnvelope<T> {
    /// A report of this program.
    pub fn of(body: T, warnings: Vec<Diagnostic>, timing: Option<Timing>) -> Self {
        Self { catchment: Version::own(), body, warnings, timing }
    }
}

impl<T: ReportBody + Serialize> ReportEnvelope<T> {
    /// The report as indented JSON, ending with a line break. Characters that control a terminal are escaped.
    ///
    /// # Errors
    /// Never at present: every field has a JSON form.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|text| escaped(text) + "\n")
    }
}

/// JSON with `\u` and a number for every character that could steer a terminal; they stand in strings alone.
fn escaped(json: String) -> String {
    let raw = |c: char| c != '\n' && catchment_core::terminal::steers(c);
    if !json.contains(raw) {
        return json;
    }
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        if raw(c) {
            text.extend(c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")));
        } else {
            text.push(c);
        }
    }
    text
}

impl<T: ReportBody + for<'de> Deserialize<'de>> ReportEnvelope<T> {
    /// Reads a report back. Unknown fields are ignored.
    ///
    /// # Errors
    /// If the text is not a report of this kind, or has an unsupported layout.
    pub fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }
}

impl<T> Deref for ReportEnvelope<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.body
    }
}

impl<T> DerefMut for ReportEnvelope<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.body
    }
}

/// The form of a report in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct Written<'a, T> {
    /// Version of the layout.
    schema: u32,
    /// Version of the program that wrote it.
    catchment: &'a Version,
    /// Kind of the report.
    kind: &'static str,
    #[serde(flatten)]
    body: &'a T,
    /// Warnings about the numbers: a code and a sentence each.
    warnings: &'a [Diagnostic],
    /// Wall-clock time and threads; null for reports without a long computation. Never compared.
    timing: &'a Option<Timing>,
}

impl<T: ReportBody + Serialize> Serialize for ReportEnvelope<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { catchment, body, warnings, timing } = self;
        Written { schema: SCHEMA, catchment, kind: T::KIND, body, warnings, timing }.serialize(serializer)
    }
}

#[cfg(feature = "schema")]
impl<T: ReportBody + schemars::JsonSchema + 'static> schemars::JsonSchema for ReportEnvelope<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::KIND.into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Written::<'static, T>::json_schema(generator)
    }
}

impl<'de, T: ReportBody + Deserialize<'de>> Deserialize<'de> for ReportEnvelope<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Read<T> {
            // An unknown version is rejected as soon as it is read: the remaining fields may have any form.
            #[serde(rename = "schema")]
            _schema: Known,
            catchment: Version,
            kind: Option<String>,
            #[serde(flatten)]
            body: T,
            #[serde(default)]
            warnings: Vec<Diagnostic>,
            timing: Option<Timing>,
        }
        let Read { catchment, kind, body, warnings, timing, .. } = Read::<T>::deserialize(deserializer)?;
        match kind {
            Some(kind) if kind != T::KIND => {
                let shown = catchment_core::terminal::escaped(&kind);
                Err(D::Error::custom(format_args!("it is a report of `{shown}`, not of `{}`", T::KIND)))
            }
            _ => Ok(Self { catchment, body, warnings, timing }),
        }
    }
}

/// The page that lists what was renamed.
const RENAMED: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs/versions.md");

/// The number of a layout that this program reads.
struct Known;

impl<'de> Deserialize<'de> for Known {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match u32::deserialize(deserializer)? {
            OLDEST..=SCHEMA => Ok(Self),
            newer if newer > SCHEMA => Err(D::Error::custom(format_args!(
                "it was written by a newer version of catchment: its schema is {newer}, this one reads up to {SCHEMA}; \
                 update catchment, or compute the result again with this one"
            ))),
            older => Err(D::Error::custom(format_args!(
                "its schema is {older}, this version of catchment reads from {OLDEST} to {SCHEMA}; compute the result \
                 again, or see {RENAMED}"
            ))),
        }
    }
}
