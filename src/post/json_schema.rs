//! The JSON Schema of post files, made of the table of keys.

use serde_json::{Map, Value, json};

use super::schema::{Key, ROOT, Shape};

/// The schema of `*.post.toml`, for editors.
#[must_use]
pub fn json_schema() -> Value {
    let mut schema = table(ROOT);
    if let Some(object) = schema.as_object_mut() {
        object.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
        object.insert("title".into(), "Partwright post file".into());
    }
    schema
}

fn table(keys: &[Key]) -> Value {
    let properties: Map<String, Value> =
        keys.iter().map(|key| (key.name.to_owned(), property(key))).collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

fn property(key: &Key) -> Value {
    let mut value = shape(key.shape);
    if let Some(object) = value.as_object_mut() {
        object.insert("description".into(), key.doc.into());
    }
    value
}

fn shape(shape: Shape) -> Value {
    let number = |low: f64, high: f64| json!({ "type": "number", "minimum": low, "maximum": high });
    let integer = |low: i64, high: i64| json!({ "type": "integer", "minimum": low, "maximum": high });
    let texts = || json!({ "type": "array", "items": { "type": "string" } });
    match shape {
        Shape::Text => json!({ "type": "string" }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Integer(low, high) => integer(low, high),
        Shape::Number(low, high) => number(low, high),
        Shape::IntegerByUnit(low, high) => by_unit(&integer(low, high)),
        Shape::NumberByUnit(low, high) => by_unit(&number(low, high)),
        Shape::TextByUnit => by_unit(&json!({ "type": "string" })),
        Shape::FlagByUnit => by_unit(&json!({ "type": "boolean" })),
        Shape::Choices(words) => {
            json!({ "type": "array", "items": { "type": "string", "enum": words }, "uniqueItems": true })
        }
        Shape::Choice(words) => json!({ "type": "string", "enum": words }),
        Shape::TextList => texts(),
        Shape::TextLists => json!({ "type": "array", "items": texts() }),
        Shape::Range => {
            json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 })
        }
        Shape::Table(keys) => table(keys),
        Shape::Tables(keys) => json!({ "type": "object", "additionalProperties": table(keys) }),
        Shape::TextListTable => json!({ "type": "object", "additionalProperties": texts() }),
        Shape::Texts => json!({ "type": "object", "additionalProperties": { "type": "string" } }),
    }
}

/// One value, or one each for mm and inch.
fn by_unit(single: &Value) -> Value {
    json!({ "anyOf": [single, {
        "type": "object",
        "properties": { "mm": single, "inch": single },
        "required": ["mm", "inch"],
        "additionalProperties": false,
    }] })
}
