//! JSON Schemas of the file formats, generated from the records that read and write them, and the tables of their keys.

mod reference;

pub(crate) use reference::tables;

use crate::passport::Content;
use crate::passport::content::PASSPORT_FORMAT;
use crate::register::{self, Register};
use crate::text::Document;
use schemars::{JsonSchema, Schema, schema_for};
use serde_json::{Value, json};

/// Returns the JSON Schema of a passport with its signature. Text that fits the schema need not be a valid passport:
/// see `verify`.
pub(crate) fn passport() -> Schema {
    signed::<Content>("Passport", PASSPORT_FORMAT)
}

/// Returns the JSON Schema of a register with its signature.
pub(crate) fn register_file() -> Schema {
    signed::<Register>("Register", register::FORMAT)
}

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
pub(crate) fn of_file<T: JsonSchema + Document>() -> Schema {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gyro::GyroType;
    use crate::site::Site;

    /// Expected: the rules of docs/formats.md, that a type has one tolerance of K_xy and K_yx, and a site one latitude.
    #[test]
    fn of_two_keys_that_exclude_each_other_a_schema_requires_one() {
        let one_of = |keys: [&str; 2]| json!(keys.map(|key| json!({"required": [key]})));
        let tolerances = one_of(["k_cross_percent", "k_cross_deg_per_h_per_ma"]);
        let latitudes = one_of(["latitude_deg", "astronomic_latitude_deg"]);
        let [gyro, site, passport] = [of_file::<GyroType>(), of_file::<Site>(), passport()];
        assert_eq!(gyro.pointer("/$defs/Tolerance/oneOf"), Some(&tolerances));
        assert_eq!(site.pointer("/oneOf"), Some(&latitudes));
        assert_eq!(passport.pointer("/$defs/Tolerance/oneOf"), Some(&tolerances));
        assert_eq!(passport.pointer("/$defs/Site/oneOf"), Some(&latitudes));
    }
}
