//! The version of the program that wrote a report, as Semantic Versioning 2.0.0 spells it.
//!
//! ```text
//!   0.1.0 · 1.2.0-rc.1 · 1.2.0+a4f        digits . digits . digits [- or + and ASCII letters, digits, '.', '-', '+']
//! ```

use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// Most bytes of a version.
const MOST: usize = 64;

/// A version in the format of this program; reports cannot carry any other text in its place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Version(String);

/// A text that is no version.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{shown}` is not a version of catchment, such as 0.1.0: the report was changed after it was written; compute the result again"
)]
pub struct VersionError {
    /// The beginning of the text, printable.
    shown: String,
}

impl Version {
    /// Of this program.
    pub(super) fn own() -> Self {
        Self(env!("CARGO_PKG_VERSION").to_owned())
    }

    /// Reads a version.
    ///
    /// # Errors
    /// The text is not a version.
    pub fn parse(text: &str) -> Result<Self, VersionError> {
        let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
        let (core, more) = text.split_at(text.find(['-', '+']).unwrap_or(text.len()));
        let suffix = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'+');
        let is_version = text.len() <= MOST
            && core.split('.').count() == 3
            && core.split('.').all(is_number)
            && more.len() != 1
            && more.bytes().all(suffix);
        if is_version {
            return Ok(Self(text.to_owned()));
        }
        let shown = catchment_core::terminal::printable(text).chars().take(MOST).collect();
        Err(VersionError { shown })
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl AsRef<str> for Version {
    fn as_ref(&self) -> &str {
        &self.0
    }
}

impl<'de> Deserialize<'de> for Version {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::parse(&String::deserialize(deserializer)?).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_and_nothing_else_is() {
        for text in
            ["0.1.0", "10.20.30", "1.2.0-rc.1", "1.2.0+a4f", "1.2.0-rc.1+x-y", env!("CARGO_PKG_VERSION")]
        {
            assert_eq!(Version::parse(text).unwrap().to_string(), text);
        }
        let long = format!("1.2.3-{}", "a".repeat(64));
        for text in [
            "",
            "1",
            "1.2",
            "1.2.3.4",
            "1..3",
            "1.2.x",
            "v1.2.3",
            "1.2.3-",
            "1.2.3 ",
            "1.2.3-ü",
            "1.2.3-a b",
            "1.2.3><script>",
            &long,
        ] {
            let error = Version::parse(text).unwrap_err().to_string();
            assert!(error.contains("compute the result again") && error.len() < 300, "{error}");
        }
        let error = Version::parse("1\u{1b}[2J").unwrap_err().to_string();
        assert!(error.contains("`1?[2J`"), "{error}");
    }
}
