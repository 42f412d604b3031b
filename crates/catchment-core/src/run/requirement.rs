//! A requirement on a report: `onaa.edge >= 0.3`.
//!
//! ```text
//!   PATH OP NUMBER     PATH  keys of the JSON report, joined by dots; list items by number from 0, or by the name of
//!                            the axis or robot, if they have names: tolerances.x.plus, robots.arm A.probability,
//!                            acceptance.sum_ci95.0
//!                      OP    >=  <=  >  <  ==
//!                      NUMBER  in D and radians as in the report; for an error also with a unit: window.yaw >= 5 deg
//! ```

use super::report_schema::ReportSchema;
use crate::design::{LengthScale, LengthUnit, Quantity, QuantityUnit, nearest};
use crate::pose::Dof;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::fmt;
use std::str::FromStr;

/// How a value is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    AtLeast,
    AtMost,
    Equal,
    Above,
    Below,
}

/// Every relation with its sign; longer signs first, so that `>=` is not read as `>`.
const RELATIONS: [(Relation, &str); 5] = [
    (Relation::AtLeast, ">="),
    (Relation::AtMost, "<="),
    (Relation::Equal, "=="),
    (Relation::Above, ">"),
    (Relation::Below, "<"),
];

/// A requirement on a number of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirement {
    path: String,
    relation: Relation,
    bound: Quantity,
}

/// Reason why a requirement cannot be evaluated.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RequirementError {
    /// Not `PATH OP NUMBER`.
    #[error(
        "`{text}` is no requirement; write PATH OP NUMBER such as onaa.edge>=0.3, OP one of >= <= > < =="
    )]
    Syntax {
        /// The text of the requirement.
        text: String,
    },
    /// A report has no such place.
    #[error("the report has no `{path}`{}", described(known, meant.as_deref()))]
    NoSuchPath {
        /// The path as far as it leads nowhere.
        path: String,
        /// The existing names.
        known: Vec<String>,
        /// The nearest of these.
        meant: Option<String>,
    },
    /// There is something else at the place.
    #[error("`{path}` is {what} in this report, not a number")]
    NotANumber {
        /// The path.
        path: String,
        /// Its type.
        what: &'static str,
    },
    /// A unit without a meaning there.
    #[error("`{path}` and {bound}: {reason}")]
    Unit {
        /// The path.
        path: String,
        /// The bound, as it was written.
        bound: String,
        /// Why not.
        reason: String,
    },
}

fn described(known: &[String], meant: Option<&str>) -> String {
    match meant {
        Some(meant) => format!("; did you mean `{meant}`?"),
        None if known.is_empty() => String::new(),
        None => format!("; there are {}", known.join(", ")),
    }
}

impl FromStr for Requirement {
    type Err = RequirementError;

    fn from_str(text: &str) -> Result<Self, RequirementError> {
        let syntax = || RequirementError::Syntax { text: text.to_owned() };
        let start = text.find(['<', '>', '=']).ok_or_else(syntax)?;
        let (path, rest) = text.split_at(start);
        let (relation, sign) = RELATIONS.into_iter().find(|(_, s)| rest.starts_with(s)).ok_or_else(syntax)?;
        let bound: Quantity = rest[sign.len()..].parse().map_err(|_| syntax())?;
        let path = path.trim();
        if path.is_empty() {
            return Err(syntax());
        }
        Ok(Self { path: path.to_owned(), relation, bound })
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = RELATIONS.iter().find(|(r, _)| *r == self.relation).map_or("", |(_, sign)| sign);
        write!(f, "{} {sign} {}", self.path, self.bound)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Requirement {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Requirement".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        String::json_schema(generator)
    }
}

impl Serialize for Requirement {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Requirement {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Result of a requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct RequirementCheck {
    /// The requirement.
    pub requirement: Requirement,
    /// The number that it is about.
    pub value: f64,
    /// Whether it is met.
    pub met: bool,
}

impl fmt::Display for RequirementCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let met = if self.met { "met" } else { "not met" };
        write!(f, "{met}: {} (it is {})", self.requirement, self.value)
    }
}

impl Requirement {
    /// Evaluates the requirement on a report.
    ///
    /// # Errors
    /// If the report has no such place, or no number there.
    pub fn judge(&self, report: &Value) -> Result<RequirementCheck, RequirementError> {
        let value = self.value(report)?;
        let bound = self.bound(report)?;
        let met = self.holds(value, bound);
        Ok(RequirementCheck { requirement: self.clone(), value, met })
    }

    /// Whether a number that has no unit meets the bound as it is written.
    pub fn is_met_by(&self, value: f64) -> bool {
        self.holds(value, self.bound.value)
    }

    fn holds(&self, value: f64, bound: f64) -> bool {
        match self.relation {
            Relation::AtLeast => value >= bound,
            Relation::AtMost => value <= bound,
            Relation::Equal => value == bound,
            Relation::Above => value > bound,
            Relation::Below => value < bound,
        }
    }

    /// The bound as the report counts: in D and radians.
    fn bound(&self, report: &Value) -> Result<f64, RequirementError> {
        if self.bound.unit == QuantityUnit::Bare {
            return Ok(self.bound.value);
        }
        let refused = |reason: String| RequirementError::Unit {
            path: self.path.clone(),
            bound: self.bound.to_string(),
            reason,
        };
        let of = |step: &str| Dof::ALL.into_iter().find(|dof| dof.name() == step);
        let Some(axis) = self.path.rsplit('.').find_map(of) else {
            return Err(refused(
                "a unit is for errors alone: write a bare number, in D and radians".to_owned(),
            ));
        };
        let read = if axis.is_rotation() {
            self.bound.angle_rad()
        } else {
            let design = &report["design"];
            let unit = serde_json::from_value::<Option<LengthUnit>>(design["unit"].clone()).unwrap_or(None);
            self.bound.length_d(&LengthScale { width: design["width"].as_f64().unwrap_or(1.0), unit })
        };
        read.map_err(|defect| refused(defect.to_string()))
    }

    /// The number that the requirement is about.
    ///
    /// # Errors
    /// If the report has no such place, or no number there.
    pub fn value(&self, report: &Value) -> Result<f64, RequirementError> {
        let what = match self.place(report)? {
            Value::Number(number) => return Ok(number.as_f64().unwrap_or(f64::NAN)),
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::String(_) => "a text",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        };
        Err(RequirementError::NotANumber { path: self.path.clone(), what })
    }

    fn place<'a>(&self, report: &'a Value) -> Result<&'a Value, RequirementError> {
        let mut here = report;
        for (before, step) in self.steps() {
            let steps = steps(here);
            let Some((_, next)) = steps.iter().find(|(names, _)| names.iter().any(|name| name == step))
            else {
                let known = steps.into_iter().filter_map(|(mut n, _)| n.pop()).collect();
                return Err(no_such_path(before, step, known));
            };
            here = next;
        }
        Ok(here)
    }

    /// Rejects a requirement on a place that no report of a JSON schema has, or that holds no number.
    /// `absent` are places that are null in the report at hand.
    ///
    /// # Errors
    /// If there is no such place, no number there, or a unit without a meaning there.
    pub fn check(&self, schema: &ReportSchema<'_>, absent: &[&str]) -> Result<(), RequirementError> {
        let mut here = schema.of_kind();
        for (before, step) in self.steps() {
            let next = schema.step(&here, step);
            if next.is_empty() {
                return Err(no_such_path(before, step, schema.known(&here)));
            }
            here = next;
        }
        let within = |place: &&str| {
            self.path.strip_prefix(*place).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        if absent.iter().any(within) {
            return Err(RequirementError::NotANumber { path: self.path.clone(), what: "null" });
        }
        if let Some(what) = schema.other_than_a_number(&here) {
            return Err(RequirementError::NotANumber { path: self.path.clone(), what });
        }
        // Whether a length has a meaning depends on the design, which may have any unit.
        self.bound(&serde_json::json!({ "design": { "width": 1.0, "unit": "mm" } })).map(|_| ())
    }

    /// Refuses a requirement on an item that a list at the top of the report does not have: the items have these names, in their order.
    ///
    /// # Errors
    /// If it is about another item of this list.
    pub fn check_items(&self, list: &str, names: &[&str]) -> Result<(), RequirementError> {
        let mut steps = self.steps();
        let is_of_list = steps.next().is_some_and(|(_, step)| step == list);
        let Some((before, item)) = steps.next().filter(|_| is_of_list) else { return Ok(()) };
        if names.contains(&item) || item.parse::<usize>().is_ok_and(|position| position < names.len()) {
            return Ok(());
        }
        Err(no_such_path(before, item, names.iter().map(|name| (*name).to_owned()).collect()))
    }

    /// Every step of the path, with the path before it: empty, or ending with a dot.
    fn steps(&self) -> impl Iterator<Item = (&str, &str)> {
        let start = |step: &str| step.as_ptr() as usize - self.path.as_ptr() as usize;
        self.path.split('.').map(move |step| (&self.path[..start(step)], step))
    }
}

fn no_such_path(before: &str, step: &str, mut known: Vec<String>) -> RequirementError {
    known.sort();
    let meant = nearest(step, known.iter().map(String::as_str)).map(|word| format!("{before}{word}"));
    RequirementError::NoSuchPath { path: format!("{before}{step}"), known, meant }
}

/// The possible steps from a value, under each of their names, the name for messages last.
fn steps(value: &Value) -> Vec<(Vec<String>, &Value)> {
    match value {
        Value::Object(map) => map.iter().map(|(key, next)| (vec![key.clone()], next)).collect(),
        Value::Array(list) => list
            .iter()
            .enumerate()
            .map(|(k, next)| {
                let named = |key: &str| next.get(key).and_then(Value::as_str).map(str::to_owned);
                (
                    std::iter::once(k.to_string()).chain(named("axis").or_else(|| named("robot"))).collect(),
                    next,
                )
            })
            .collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn report() -> Value {
        json!({
            "acceptance": { "sum": 2.5, "sum_ci95": [2.4, 2.6], "sample": null },
            "tolerances": [{ "axis": "x", "plus": 0.5 }, { "axis": "yaw", "plus": 1.0 }],
            "method": "descent",
            "design": { "width": 50.0, "unit": "mm" },
        })
    }

    fn judge(text: &str) -> Result<bool, RequirementError> {
        let requirement: Requirement = text.parse()?;
        Ok(requirement.judge(&report())?.met)
    }

    #[test]
    fn items_of_a_list_are_known_by_their_names() {
        let check = |text: &str| {
            let requirement: Requirement = text.parse().unwrap();
            requirement.check_items("robots", &["arm-a", "arm-b"]).map_err(|error| error.to_string())
        };
        for path in ["robots.arm-a.p >= 1", "robots.1.p >= 1", "motions >= 1", "errors.arm-c >= 1"] {
            assert_eq!(check(path), Ok(()), "{path}");
        }
        let message = "the report has no `robots.arm-c`; did you mean `robots.arm-a`?";
        assert_eq!(check("robots.arm-c.p >= 1"), Err(message.to_owned()));
        assert!(check("robots.2.p >= 1").is_err());
    }

    #[test]
    fn every_relation_is_judged_on_both_sides() {
        for (text, met) in [
            ("acceptance.sum>=2.5", true),
            ("acceptance.sum >= 2.6", false),
            ("acceptance.sum<= 2.5", true),
            ("acceptance.sum <=2.4", false),
            ("acceptance.sum > 2.5", false),
            ("acceptance.sum<2.6", true),
            ("acceptance.sum == 2.5", true),
            ("acceptance.sum == -2.5", false),
            ("acceptance.sum_ci95.1 > 2.5", true),
            ("tolerances.yaw.plus >= 1", true),
            ("tolerances.0.plus >= 1", false),
            ("tolerances.x.plus >= 25 mm", true),
            ("tolerances.x.plus>25.001mm", false),
            ("tolerances.x.plus <= 0.5 D", true),
            ("tolerances.yaw.plus >= 57.2 deg", true),
            ("tolerances.yaw.plus >= 57.3 deg", false),
        ] {
            assert_eq!(judge(text), Ok(met), "{text}");
        }
    }

    #[test]
    fn invalid_requirements_are_reported() {
        for text in ["", "sum", ">= 3", "sum = 3", "sum >= much", "sum >= nan", "sum >= 3 parsec"] {
            assert!(matches!(judge(text), Err(RequirementError::Syntax { .. })), "{text}");
        }
        let message = |text: &str| judge(text).unwrap_err().to_string();
        assert_eq!(message("aceptance.sum > 1"), "the report has no `aceptance`; did you mean `acceptance`?");
        assert_eq!(
            message("tolerances.z.plus > 1"),
            "the report has no `tolerances.z`; did you mean `tolerances.x`?"
        );
        assert_eq!(
            message("acceptance.onaa > 1"),
            "the report has no `acceptance.onaa`; there are sample, sum, sum_ci95"
        );
        assert_eq!(message("acceptance.sum.x > 1"), "the report has no `acceptance.sum.x`");
        assert_eq!(
            message("acceptance.sample > 1"),
            "`acceptance.sample` is null in this report, not a number"
        );
        assert_eq!(
            message("acceptance.sum >= 3 mm"),
            "`acceptance.sum` and 3 mm: a unit is for errors alone: write a bare number, in D and radians"
        );
        assert!(message("tolerances.yaw.plus >= 3 mm").contains("3 mm"));
        assert_eq!(message("method == 1"), "`method` is a text in this report, not a number");
    }

    #[test]
    fn requirements_display_as_they_are_parsed() {
        for text in ["onaa.edge >= 0.3", "a.0 == -1", "b < 2", "window.yaw >= 5 deg"] {
            assert_eq!(text.parse::<Requirement>().unwrap().to_string(), text);
        }
    }
}
