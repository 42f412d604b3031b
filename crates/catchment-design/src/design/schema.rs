//! The JSON schema of design files, for completion and checks in editors.

use super::keys::{self, Applies, DesignTable, Key, ValueKind};
use super::reader::{DIRECTIONS, DRAWN};
use super::{Family, LengthUnit};
use catchment_base::pose::Dof;
use serde_json::{Map, Value, json};

/// The schema (JSON Schema 2020-12), pretty-printed. It is generated from [`keys`], like the reader;
/// conditions that a schema cannot express (files that exist, keys that exclude each other) are checked only
/// by the reader.
pub fn json_schema() -> String {
    let mut schema = Map::new();
    schema.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    schema.insert("title".into(), json!("catchment design"));
    schema.extend(table(DesignTable::Root));
    format!("{:#}\n", Value::Object(schema))
}

fn table(table: DesignTable) -> Map<String, Value> {
    let properties: Map<String, Value> = table
        .keys()
        .filter(|key| key.kind != ValueKind::Later)
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    schema.insert("additionalProperties".into(), json!(false));
    if table == DesignTable::Root {
        schema.insert("required".into(), json!([keys::CONNECTOR.name]));
    }
    schema.insert("properties".into(), Value::Object(properties));
    schema
}

fn property(key: &Key) -> Value {
    let mut schema = match key.kind {
        ValueKind::Table(inner) => Value::Object(table(inner)),
        ValueKind::Line => json!({ "type": "string", "minLength": 1, "maxLength": keys::LONGEST_LINE }),
        ValueKind::Path => json!({ "type": "string", "minLength": 1 }),
        ValueKind::Ratio(range) => json!({ "type": "number", "minimum": range.min, "maximum": range.max }),
        ValueKind::Whole { min, max } => json!({ "type": "integer", "minimum": min, "maximum": max }),
        ValueKind::Flag => json!({ "type": "boolean" }),
        ValueKind::Length(range) | ValueKind::Angle(range) | ValueKind::Width(range) => json!({ "anyOf": [
            { "type": "number", "minimum": range.min, "maximum": range.max },
            with_unit(key.kind),
        ]}),
        ValueKind::DrawnLength(_) => json!({ "anyOf": [{ "type": "number" }, with_unit(key.kind)] }),
        ValueKind::Unit => json!({ "enum": LengthUnit::ALL.map(LengthUnit::symbol) }),
        ValueKind::Family => json!({ "enum": Family::ALL.map(Family::name) }),
        ValueKind::Mount => json!({ "enum": ["x", "y"] }),
        ValueKind::Drawn => json!({ "enum": DRAWN.map(|(name, _)| name) }),
        ValueKind::Direction => json!({ "anyOf": [
            { "enum": DIRECTIONS.map(|(name, _)| name) },
            three(&json!({ "type": "number" })),
        ]}),
        ValueKind::Point(_) | ValueKind::Turns(_) => {
            three(&json!({ "anyOf": [{ "type": "number" }, with_unit(key.element().kind)] }))
        }
        ValueKind::Dofs => json!({
            "type": "array",
            "uniqueItems": true,
            "items": { "enum": Dof::ALL.map(Dof::name) },
        }),
        ValueKind::Pieces => json!({
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "array",
                "minItems": 4,
                "items": three(&json!({ "anyOf": [{ "type": "number" }, with_unit(key.kind)] })),
            },
        }),
        ValueKind::Parts => json!({
            "type": "array",
            "minItems": 1,
            "maxItems": keys::MOST_PARTS,
            "items": Value::Object(table(DesignTable::Part)),
        }),
        ValueKind::Outline(_) => json!({ "anyOf": [
            { "type": "string", "minLength": 1 },
            { "type": "array", "minItems": 3, "items": {
                "type": "array",
                "minItems": 2,
                "maxItems": 2,
                "items": { "anyOf": [{ "type": "number" }, with_unit(key.element().kind)] },
            }},
        ]}),
        ValueKind::Later => json!(false),
    };
    let doc = match key.applies {
        Applies::Always => key.doc.to_owned(),
        applies => format!("{} (Of {applies}.)", key.doc),
    };
    schema["description"] = json!(doc);
    schema
}

/// A list of three.
fn three(items: &Value) -> Value {
    json!({ "type": "array", "minItems": 3, "maxItems": 3, "items": items })
}

/// A string that carries a unit.
fn with_unit(kind: ValueKind) -> Value {
    let units = match kind {
        ValueKind::Angle(_) => "deg|°|rad",
        ValueKind::Width(_) => "um|µm|mm|cm|m|in|inch",
        _ => "D|um|µm|mm|cm|m|in|inch",
    };
    let number = r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*";
    json!({ "type": "string", "pattern": format!("{number}({units})\\s*$") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The schema beside the example designs is the schema that this program generates. To renew it:
    /// `catchment schema -o designs/schema.json --force`.
    #[test]
    fn the_committed_schema_is_current() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/schema.json");
        let committed = std::fs::read_to_string(&path).unwrap();
        assert!(committed == json_schema(), "run `catchment schema -o designs/schema.json --force`");
    }

    #[test]
    fn the_schema_has_every_key() {
        let schema: Value = serde_json::from_str(&json_schema()).unwrap();
        let properties = |value: &Value| value["properties"].as_object().unwrap().len();
        let connector = &schema["properties"]["connector"];
        let part = &connector["properties"]["fixed"]["properties"]["parts"]["items"];
        let shapes = ["sphere", "cylinder", "cone"].map(|shape| properties(&part["properties"][shape]));
        let counted = properties(&schema)
            + properties(connector)
            + properties(&connector["properties"]["fixed"])
            + properties(part)
            + shapes.iter().sum::<usize>()
            + properties(&schema["properties"]["alignment"])
            + properties(&schema["properties"]["errors"])
            + properties(&schema["properties"]["docked"]);
        assert_eq!(counted, keys::KEYS.iter().filter(|key| key.kind != ValueKind::Later).count());
    }
}
