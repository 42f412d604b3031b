//! Access to the JSON schema of a report: its paths, and their types.
//!
//! ```text
//!   #/$defs/window ──properties.window──▶ ──$ref──▶ #/$defs/HalfWidths ──properties.yaw──▶ { "type": "number" }
//! ```
//!
//! Supports the parts of JSON Schema that `schemars` writes for results: `$ref`, `anyOf`, `oneOf`, `allOf`,
//! `properties`, `patternProperties`, `additionalProperties`, `items`, `prefixItems`, `type`, `const` and
//! `enum`. A schema without any of them accepts everything.

use serde_json::{Map, Value};

/// How deep references may lead; those of results lead three deep.
const DEEPEST: usize = 32;

/// The schema of reports of a kind, among those of all kinds.
#[derive(Debug, Clone, Copy)]
pub struct ReportSchema<'a> {
    root: &'a Value,
    kind: &'a Value,
}

impl<'a> ReportSchema<'a> {
    /// The schema of a kind, in a document whose `$defs` contain every kind under its name; `None` for an
    /// unknown kind.
    pub fn of(root: &'a Value, kind: &str) -> Option<Self> {
        let kind = root.get("$defs")?.get(kind)?;
        Some(Self { root, kind })
    }

    /// The alternatives at the top of a report.
    pub fn of_kind(&self) -> Vec<&'a Value> {
        self.alternatives(self.kind)
    }

    /// Every alternative that a place may have, without references.
    fn alternatives(&self, schema: &'a Value) -> Vec<&'a Value> {
        let (mut result, mut open) = (Vec::new(), vec![(schema, 0)]);
        while let Some((schema, depth)) = open.pop() {
            if depth > DEEPEST {
                continue;
            }
            let target = schema
                .get("$ref")
                .and_then(Value::as_str)
                .and_then(|path| self.root.pointer(path.strip_prefix('#')?));
            open.extend(target.map(|target| (target, depth + 1)));
            let mut is_choice = target.is_some();
            for key in ["anyOf", "oneOf", "allOf"] {
                let choices = schema.get(key).and_then(Value::as_array);
                is_choice |= choices.is_some();
                open.extend(choices.into_iter().flatten().rev().map(|choice| (choice, depth + 1)));
            }
            if !is_choice || schema.get("properties").is_some() {
                result.push(schema);
            }
        }
        result
    }

    /// The schemas after a step; empty if the step does not exist.
    pub fn step(&self, here: &[&'a Value], step: &str) -> Vec<&'a Value> {
        let next = here.iter().filter_map(|schema| self.below(schema, step));
        next.flat_map(|schema| self.alternatives(schema)).collect()
    }

    fn below(&self, schema: &'a Value, step: &str) -> Option<&'a Value> {
        let Some(fields) = schema.as_object() else {
            return (schema == &Value::Bool(true)).then_some(schema);
        };
        let named = |key: &str| fields.get(key).and_then(Value::as_object);
        if let Some(result) = named("properties").and_then(|properties| properties.get(step)) {
            return Some(result);
        }
        if let Some(result) = named("patternProperties").and_then(|patterns| patterns.values().next()) {
            return Some(result);
        }
        let position = step.parse::<usize>();
        if let Some(items) =
            fields.get("items").filter(|items| items.is_object() || *items == &Value::Bool(true))
        {
            let most = fields.get("maxItems").and_then(Value::as_u64).unwrap_or(u64::MAX);
            let is_there = match position {
                Ok(position) => (position as u64) < most,
                Err(_) => self.names(items).is_none_or(|names| names.iter().any(|name| name == step)),
            };
            return is_there.then_some(items);
        }
        if let Some(items) = fields.get("prefixItems").and_then(Value::as_array) {
            return items.get(position.ok()?);
        }
        match fields.get("additionalProperties") {
            Some(Value::Bool(false)) => None,
            Some(further) => Some(further),
            // A schema without a type permits any value.
            None => (!fields.contains_key("type")
                && !fields.contains_key("const")
                && !fields.contains_key("enum"))
            .then_some(schema),
        }
    }

    /// The names by which items of a list are accessed: their axes; `None` if any name is possible, as for
    /// robots.
    fn names(&self, items: &'a Value) -> Option<Vec<String>> {
        let item = self.alternatives(items);
        let are_objects = item.iter().all(|schema| schema.get("properties").is_some());
        if are_objects && !self.step(&item, "robot").is_empty() {
            return None;
        }
        let axis = if are_objects { self.step(&item, "axis") } else { Vec::new() };
        Some(axis.iter().flat_map(|axis| words(axis)).collect())
    }

    /// The names of the possible steps, as far as the schema defines them.
    pub fn known(&self, here: &[&'a Value]) -> Vec<String> {
        let properties = |schema: &&'a Value| {
            let fields = schema.get("properties").and_then(Value::as_object);
            fields
                .map(|fields: &Map<String, Value>| fields.keys().cloned().collect::<Vec<_>>())
                .unwrap_or_default()
        };
        let items = here.iter().filter_map(|schema| self.names(schema.get("items")?));
        here.iter().flat_map(properties).chain(items.flatten()).collect()
    }

    /// The types at a place, `integer` as `number`; empty if any type is possible.
    pub fn types(&self, here: &[&'a Value]) -> Vec<&'a str> {
        let mut result = Vec::new();
        for schema in here {
            match schema.get("type") {
                Some(Value::String(one)) => result.push(one.as_str()),
                Some(Value::Array(several)) => result.extend(several.iter().filter_map(Value::as_str)),
                _ if schema.get("const").or_else(|| schema.get("enum")).is_some() => result.push("string"),
                _ => return Vec::new(),
            }
        }
        result.iter_mut().filter(|of| **of == "integer").for_each(|of| *of = "number");
        result
    }

    /// The type at a place that cannot hold a number.
    pub fn other_than_a_number(&self, here: &[&'a Value]) -> Option<&'static str> {
        let types = self.types(here);
        if types.is_empty() || types.contains(&"number") {
            return None;
        }
        // The alternative "null" is not its type.
        let of = types.iter().find(|of| **of != "null").unwrap_or(&"null");
        Some(match *of {
            "boolean" => "true or false",
            "string" => "a text",
            "array" => "a list",
            "object" => "an object",
            _ => "null",
        })
    }
}

/// The words that a text may be.
fn words(schema: &Value) -> Vec<String> {
    let listed = schema.get("enum").and_then(Value::as_array).into_iter().flatten();
    listed.chain(schema.get("const")).filter_map(Value::as_str).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::super::requirement::{Requirement, RequirementError};
    use super::*;
    use serde_json::json;

    fn schema() -> Value {
        json!({ "$defs": {
            "run": { "type": "object", "properties": {
                "sum": { "type": "number" },
                "name": { "type": "string" },
                "ci95": { "type": ["array", "null"], "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
                "limits": { "type": "array", "items": { "$ref": "#/$defs/Limit" } },
                "basins": { "anyOf": [{ "$ref": "#/$defs/Basins" }, { "type": "null" }] },
                "robots": { "type": "array", "items": { "type": "object", "properties": { "robot": { "type": "string" }, "p": { "type": "number" } } } },
                "outcomes": { "type": "object", "additionalProperties": { "type": "number" } },
                "settings": true,
                "loop": { "$ref": "#/$defs/Loop" },
            } },
            "Limit": { "type": "object", "properties": { "axis": { "$ref": "#/$defs/Dof" }, "plus": { "type": "number" } } },
            "Dof": { "oneOf": [{ "type": "string", "const": "x" }, { "type": "string", "enum": ["y", "yaw"] }] },
            "Basins": { "type": "object", "properties": { "count": { "type": "integer" } } },
            "Loop": { "$ref": "#/$defs/Loop" },
        } })
    }

    fn check(text: &str, absent: &[&str]) -> Result<(), RequirementError> {
        let root = schema();
        let requirement: Requirement = text.parse().unwrap();
        requirement.check(&ReportSchema::of(&root, "run").unwrap(), absent)
    }

    #[test]
    fn places_of_a_schema_are_known_before_there_is_a_report() {
        for path in [
            "sum",
            "ci95.0",
            "ci95.1",
            "limits.x.plus",
            "limits.yaw.plus",
            "limits.7.plus",
            "basins.count",
            "robots.arm A.p",
            "outcomes.jammed",
            "settings.descent.friction",
        ] {
            assert_eq!(check(&format!("{path} >= 1"), &[]), Ok(()), "{path}");
        }
        assert_eq!(check("limits.yaw.plus >= 5 deg", &[]), Ok(()));
    }

    #[test]
    fn other_places_are_refused_with_the_nearest() {
        let message = |text: &str| check(text, &["basins"]).unwrap_err().to_string();
        assert_eq!(message("smu > 1"), "the report has no `smu`; did you mean `sum`?");
        assert_eq!(message("limits.z.plus > 1"), "the report has no `limits.z`; did you mean `limits.x`?");
        assert_eq!(message("limits.x.mid > 1"), "the report has no `limits.x.mid`; there are axis, plus");
        assert_eq!(message("ci95.2 > 1"), "the report has no `ci95.2`");
        assert_eq!(message("sum.x > 1"), "the report has no `sum.x`");
        assert_eq!(message("name > 1"), "`name` is a text in this report, not a number");
        assert_eq!(message("limits > 1"), "`limits` is a list in this report, not a number");
        assert_eq!(message("basins.count > 1"), "`basins.count` is null in this report, not a number");
        assert!(message("loop.a > 1").contains("the report has no `loop`"));
        assert!(message("sum > 1 mm").contains("a unit is for errors alone"));
    }
}
