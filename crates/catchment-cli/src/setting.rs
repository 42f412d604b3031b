//! Settings of methods, given by options.

use crate::failure::Failure;
use catchment::method::{Method, MethodError};
use catchment::suggest::number_help;
use serde_json::{Map, Value};

/// Parses a plain finite number; the option defines its unit.
///
/// # Errors
/// Advice on the expected format.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            let help = number_help(text)
                .unwrap_or_else(|| "write it with a point and without a unit, such as 0.5".to_owned());
            Err(format!("it is not a number: {help}"))
        }
    }
}

/// A setting given by an option.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Change {
    /// The option.
    pub(crate) option: &'static str,
    /// The setting that it changes.
    pub(crate) setting: &'static str,
    /// The new value.
    pub(crate) value: Value,
}

/// A method with some of its settings changed; an error names the option.
pub(crate) fn with_changes(method: &Method, changes: &[Change]) -> Result<Method, Failure> {
    let map: Map<String, Value> =
        changes.iter().map(|change| (change.setting.to_owned(), change.value.clone())).collect();
    method.with(&map).map_err(|error| match error {
        MethodError::NoSuchSetting { method, setting, owners } => {
            let option = changes.iter().find(|change| change.setting == setting).map_or("", |c| c.option);
            let message = format!("{option} is a setting of {}; {method} has none", owners.join(" and "));
            let help =
                format!("add --method {}, or leave it out", owners.first().copied().unwrap_or_default());
            Failure::with_help(message, Some(help))
        }
        MethodError::Refused { reason, .. } => Failure::with_help(reason, None),
        error @ MethodError::Unknown { .. } => error.into(),
    })
}
