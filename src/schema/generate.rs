//! JSON Schemas, generated from the records that read and write the files.

use super::FORMATS;
use crate::dcc::Administrative;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::Content;
use crate::passport::content::PASSPORT_FORMAT;
use crate::register::{self, Register};
use crate::site::Site;
use crate::stand::Stand;
use crate::text::Document;
use schemars::{JsonSchema, Schema, schema_for};
use serde_json::{Map, Value, json};

/// Returns the schemas as [`super::schemas`] reads them.
pub(crate) fn schemas() -> Map<String, Value> {
    let schemas = [
        of_file::<Stand>(),
        of_file::<Site>(),
        of_file::<GyroType>(),
        of_file::<Laboratory>(),
        of_file::<Administrative>(),
        signed::<Content>("Passport", PASSPORT_FORMAT),
        signed::<Register>("Register", register::FORMAT),
    ];
    FORMATS.map(str::to_owned).into_iter().zip(schemas.map(|schema| json!(schema))).collect()
}

/// Returns the JSON Schema of a document with its signature. Text that fits the schema need not be valid: see `verify`.
fn signed<T: JsonSchema>(title: &str, format: &str) -> Schema {
    #[derive(JsonSchema)]
    #[allow(dead_code)]
    #[schemars(deny_unknown_fields)]
    struct Signed<T> {
        #[schemars(flatten)]
        content: T,
        /// OpenSSH's armored signature over every byte before this key.
        signature: String,
    }
    let mut schema = schema_for!(Signed<T>);
    schema.insert("title".to_owned(), title.into());
    with_format(schema, format)
}

/// Returns the JSON Schema of a file: `format`, then the keys of the document.
fn of_file<T: JsonSchema + Document>() -> Schema {
    let mut schema = schema_for!(T);
    let format = json!({"description": format!("Always {:?}.", T::FORMAT), "type": "string"});
    let object = schema.ensure_object();
    if let Some(Value::Object(properties)) = object.get_mut("properties") {
        properties.shift_insert(0, "format".to_owned(), format);
    }
    match object.get_mut("required") {
        Some(Value::Array(required)) => required.insert(0, json!("format")),
        _ => {
            object.insert("required".to_owned(), json!(["format"]));
        }
    }
    with_format(schema, T::FORMAT)
}

/// Fixes the value of `format`, and removes null from the schema, because an absent key is omitted and never null.
fn with_format(mut schema: Schema, format: &str) -> Schema {
    if let Some(Value::Object(property)) = schema.pointer_mut("/properties/format") {
        property.insert("const".to_owned(), json!(format));
    }
    schema.ensure_object().values_mut().for_each(without_null);
    schema
}

fn without_null(value: &mut Value) {
    match value {
        Value::Object(object) => {
            if let Some(Value::Array(types)) = object.get_mut("type") {
                types.retain(|kind| kind != "null");
                if let [one] = types.as_slice() {
                    object["type"] = one.clone();
                }
            }
            if let Some(Value::Array(choices)) = object.get_mut("anyOf") {
                choices.retain(|choice| *choice != json!({"type": "null"}));
                if let [Value::Object(one)] = choices.as_slice() {
                    let one = one.clone();
                    object.shift_remove("anyOf");
                    object.extend(one);
                }
            }
            object.values_mut().for_each(without_null);
        }
        Value::Array(items) => items.iter_mut().for_each(without_null),
        _ => {}
    }
}
