//! The JSON schema of every report, derived from the serialised types.
//!
//! ```text
//!   #[derive(Serialize, JsonSchema)] ──▶ add(generator) ──▶ reports.schema.json ──▶ requirements, the reference of fields, other programs
//!                                          a test compares
//! ```
//!
//! The file is JSON Schema 2020-12; a report of kind `window` matches `#/$defs/window`. It is written by
//! `UPDATE_SCHEMA=1 cargo test -p catchment-cli --all-features --test cli schema`, and the same test fails if
//! the file is stale. Programs therefore need neither the feature `schema` nor the time to derive it.

use catchment_core::run::ReportSchema;
use serde_json::Value;
use std::sync::LazyLock;

/// The schema of all reports as text.
pub const TEXT: &str = include_str!("../reports.schema.json");

static ROOT: LazyLock<Value> = LazyLock::new(|| serde_json::from_str(TEXT).unwrap_or_default());

/// The schema of reports of a kind; `None` for an unknown kind.
pub fn of_kind(kind: &str) -> Option<ReportSchema<'static>> {
    ReportSchema::of(&ROOT, kind)
}

/// Adds the schemas of types of reports to a generator, each under its kind.
#[cfg(feature = "schema")]
#[doc(hidden)]
#[macro_export]
macro_rules! add_json_schemas {
    ($generator:expr, $($report:ty),+ $(,)?) => {{ $($generator.subschema_for::<$report>();)+ }};
}
#[cfg(feature = "schema")]
pub use add_json_schemas as add;

/// Adds the JSON schemas of all reports of this crate to a generator.
#[cfg(feature = "schema")]
pub fn add_all(generator: &mut schemars::SchemaGenerator) {
    crate::subjects::add_json_schemas(generator);
    add!(
        generator,
        crate::Report,
        crate::CheckReport,
        crate::ComparisonReport,
        crate::ExportReport,
        crate::FacesReport,
        crate::ReportEnvelope<crate::outcomes::Answer<'static>>,
        crate::SolidsReport,
        crate::TraceReport,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_known() {
        assert!(ROOT.is_object());
        assert!(of_kind("window").is_some() && of_kind("run").is_some() && of_kind("Window").is_none());
    }
}
