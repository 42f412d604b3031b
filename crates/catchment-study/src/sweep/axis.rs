//! An axis of a sweep: a key of the design file and its values.

use catchment_core::design::{DesignDefect, Quantity, key_path};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A key and its values: `aspect_ratio=0.25,0.5,1`, `cor=-1..1/5` (five from −1 to 1), `errors.yaw=10 deg,20 deg`,
/// `family=v-face,x-face`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepAxis {
    /// Path of the key, such as `connector.aspect_ratio`.
    pub key: String,
    /// Values as the user writes them.
    pub values: Vec<String>,
}

/// Why a text is no axis.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SweepAxisError {
    /// There is no `=`.
    #[error("`{text}` is not KEY=VALUE,VALUE,… such as aspect_ratio=0.25,0.5,1")]
    NoValues {
        /// As written.
        text: String,
    },
    /// The key is unknown.
    #[error("{defect}{}", advice(defect))]
    Key {
        /// The error.
        defect: DesignDefect,
    },
    /// A value is empty or stands twice.
    #[error("`{key}` has the value `{value}` {how}")]
    Value {
        /// The key.
        key: String,
        /// The value.
        value: String,
        /// Twice, or without anything in it.
        how: &'static str,
    },
    /// An invalid range.
    #[error(
        "`{text}` is no range: write first..last/number, such as -1..1/5, the number from 2 to {}",
        SweepAxis::MOST
    )]
    Range {
        /// As written.
        text: String,
    },
}

fn advice(defect: &DesignDefect) -> String {
    defect.help().map_or_else(String::new, |help| format!("; {help}"))
}

impl SweepAxis {
    /// Largest number of values of an axis.
    pub const MOST: usize = 1000;

    /// The last word of its key.
    pub fn name(&self) -> &str {
        self.key.rsplit('.').next().unwrap_or_default()
    }

    /// Its values as numbers in their common unit, with that unit's name; `None` if they are not such
    /// numbers.
    pub fn numbers(&self) -> Option<(Vec<f64>, String)> {
        let quantities: Vec<Quantity> =
            self.values.iter().map(|value| value.parse().ok()).collect::<Option<_>>()?;
        let unit = quantities.first()?.unit;
        let same = quantities.iter().all(|quantity| quantity.unit == unit);
        let name = || quantities[0].to_string().trim_start_matches(|c: char| !c.is_alphabetic()).to_owned();
        // The number may have letters itself: 1e5.
        let unit_name = if unit == catchment_core::design::QuantityUnit::Bare {
            String::new()
        } else {
            last_word(&name())
        };
        same.then(|| (quantities.iter().map(|quantity| quantity.value).collect(), unit_name))
    }
}

fn last_word(text: &str) -> String {
    text.rsplit(' ').next().unwrap_or_default().to_owned()
}

impl fmt::Display for SweepAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.values.join(","))
    }
}

impl FromStr for SweepAxis {
    type Err = SweepAxisError;

    fn from_str(text: &str) -> Result<Self, SweepAxisError> {
        let no_values = || SweepAxisError::NoValues { text: short(text) };
        let (name, list) = text.split_once('=').ok_or_else(no_values)?;
        if name.trim().is_empty() || list.trim().is_empty() {
            return Err(no_values());
        }
        let key = key_path(name).map_err(|defect| SweepAxisError::Key { defect })?;
        let mut values: Vec<String> = Vec::new();
        for part in parts(list) {
            let result = if is_range(part) { range(part)? } else { vec![part.to_owned()] };
            for value in result {
                let wrong = |how| SweepAxisError::Value { key: key.clone(), value: short(&value), how };
                if value.is_empty() {
                    return Err(wrong("with nothing in it"));
                }
                if values.contains(&value) {
                    return Err(wrong("twice"));
                }
                values.push(value);
            }
        }
        if values.len() > Self::MOST {
            return Err(SweepAxisError::Range { text: short(list) });
        }
        Ok(Self { key, values })
    }
}

/// The parts between commas outside quotes and brackets.
fn parts(list: &str) -> Vec<&str> {
    let (mut depth, mut quote, mut start, mut result) = (0usize, None, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match (c, quote) {
            ('"' | '\'', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            ('[' | '{', None) => depth += 1,
            (']' | '}', None) => depth = depth.saturating_sub(1),
            (',', None) if depth == 0 => {
                result.push(list[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    result.push(list[start..].trim());
    result
}

/// Whether a value denotes a range: a number, two dots. Paths begin differently.
fn is_range(part: &str) -> bool {
    part.split_once("..").is_some_and(|(first, _)| first.trim().parse::<Quantity>().is_ok())
}

/// `first..last/number`, with a unit after the last: this number of equidistant values, written with only as
/// many digits as distinguish them.
fn range(text: &str) -> Result<Vec<String>, SweepAxisError> {
    let wrong = || SweepAxisError::Range { text: short(text) };
    let (ends, number) = text.rsplit_once('/').ok_or_else(wrong)?;
    let (first, last) = ends.split_once("..").ok_or_else(wrong)?;
    let number: usize = number.trim().parse().map_err(|_| wrong())?;
    let last: Quantity = last.parse().map_err(|_| wrong())?;
    let first: Quantity = first.parse().map_err(|_| wrong())?;
    let unit_fits = first.unit == last.unit || first.unit == catchment_core::design::QuantityUnit::Bare;
    if !(2..=SweepAxis::MOST).contains(&number) || first.value == last.value || !unit_fits {
        return Err(wrong());
    }
    let step = (last.value - first.value) / (number - 1) as f64;
    // Enough decimals for a thousandth of a step: no 0.30000000000000004.
    let decimals = (3.0 - step.abs().log10().floor()).clamp(0.0, 15.0) as usize;
    let written = |k: usize| {
        let value = if k + 1 == number { last.value } else { first.value + step * k as f64 };
        let text = format!("{value:.decimals$}");
        let value = text.parse().unwrap_or(value) + 0.0;
        Quantity { value, unit: last.unit }.to_string()
    };
    Ok((0..number).map(written).collect())
}

fn short(text: &str) -> String {
    let most = 60;
    let mut short: String = text.chars().take(most).map(|c| if c.is_control() { '?' } else { c }).collect();
    if text.chars().nth(most).is_some() {
        short.push('…');
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> SweepAxis {
        text.parse().unwrap()
    }

    #[test]
    fn lists_ranges_and_words_are_read() {
        assert_eq!(axis("aspect_ratio=0.25, 0.5,1").values, ["0.25", "0.5", "1"]);
        assert_eq!(axis("cor=-1..1/5").to_string(), "alignment.center_of_rotation=-1,-0.5,0,0.5,1");
        assert_eq!(axis("cor=0..0.3/4").values, ["0", "0.1", "0.2", "0.3"]);
        assert_eq!(axis("errors.yaw=10..30 deg/3").values, ["10 deg", "20 deg", "30 deg"]);
        assert_eq!(axis("cor=1..2/3,5").values, ["1", "1.5", "2", "5"]);
        assert_eq!(axis("free=[\"x\",\"yaw\"],[\"x\"]").values, ["[\"x\",\"yaw\"]", "[\"x\"]"]);
        assert_eq!(axis("connector.fixed.mesh=../a.stl,b/c.stl").values, ["../a.stl", "b/c.stl"]);
    }

    #[test]
    fn numbers_have_one_unit() {
        assert_eq!(axis("cor=5 mm,1e1 mm").numbers(), Some((vec![5.0, 10.0], "mm".to_owned())));
        assert_eq!(axis("cor=1,2").numbers(), Some((vec![1.0, 2.0], String::new())));
        assert_eq!(axis("cor=1 mm,2").numbers(), None);
        assert_eq!(axis("family=cone,pyramid").numbers(), None);
    }

    #[test]
    fn invalid_axes_are_reported() {
        let refusal = |text: &str| text.parse::<SweepAxis>().unwrap_err().to_string();
        assert!(refusal("aspect_ratio").contains("KEY=VALUE"));
        assert!(refusal("=1").contains("KEY=VALUE"));
        assert!(refusal("aspct_ratio=1").ends_with("did you mean `aspect_ratio`?"));
        assert!(refusal("mesh=a.stl").ends_with("write connector.fixed.mesh or connector.moving.mesh"));
        assert!(refusal("cor=1,2,1").contains("twice"));
        assert!(refusal("cor=1,,2").contains("nothing"));
        for range in [
            "cor=1..1/3",
            "cor=1..2/1",
            "cor=1..2/1000000",
            "cor=1..b/3",
            "cor=1..2",
            "cor=1 mm..2 deg/3",
            "cor=1..2/x",
        ] {
            assert!(refusal(range).contains("is no range"), "{range}");
        }
        assert!(
            refusal(&format!("cor={}", (0..1001).map(|k| k.to_string()).collect::<Vec<_>>().join(",")))
                .contains("1000")
        );
    }
}
