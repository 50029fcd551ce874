//! As much of JSON Schema as `docs/schema` uses. Stricter in one way: members that the schema does not name are
//! refused, so that the schema stays complete.

use serde_json::Value;

/// Checks `value` against `schema`, whose `$ref`s point into `root`.
pub fn check(root: &Value, schema: &Value, value: &Value, path: &str) -> Result<(), String> {
    if let Some(reference) = schema["$ref"].as_str() {
        let target = reference.trim_start_matches('#');
        let found = root.pointer(target).ok_or(format!("{path}: no {reference}"))?;
        return check(root, found, value, path);
    }
    if let Some(any) = schema["anyOf"].as_array() {
        let fits = any.iter().any(|s| check(root, s, value, path).is_ok());
        return if fits { Ok(()) } else { Err(format!("{path}: no alternative fits {value}")) };
    }
    if let Some(words) = schema["enum"].as_array()
        && !words.contains(value)
    {
        return Err(format!("{path}: {value} is not one of {words:?}"));
    }
    if !schema["const"].is_null() && schema["const"] != *value {
        return Err(format!("{path}: {value} is not {}", schema["const"]));
    }
    check_type(&schema["type"], value, path)?;
    if let Some(object) = value.as_object() {
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            object.get(name).ok_or(format!("{path}: {name} is missing"))?;
        }
        for (name, member) in object {
            let own = &schema["properties"][name];
            let known = if own.is_null() { &schema["additionalProperties"] } else { own };
            if !known.is_object() {
                return Err(format!("{path}: {name} is not in the schema"));
            }
            check(root, known, member, &format!("{path}.{name}"))?;
        }
    }
    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
        check(root, &schema["items"], item, &format!("{path}[{index}]"))?;
    }
    Ok(())
}

fn check_type(wanted: &Value, value: &Value, path: &str) -> Result<(), String> {
    let fits = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        _ => false,
    };
    let ok = match wanted {
        Value::String(name) => fits(name),
        Value::Array(names) => names.iter().filter_map(Value::as_str).any(fits),
        _ => true,
    };
    if ok { Ok(()) } else { Err(format!("{path}: {value} is not of type {wanted}")) }
}
