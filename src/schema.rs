//! JSON Schemas of the formats, made from the records that read and write them.

use crate::gyro::{GYRO_FORMAT, GyroType};
use crate::laboratory::{LABORATORY_FORMAT, Laboratory};
use crate::passport::Content;
use crate::passport::content::PASSPORT_FORMAT;
use crate::site::{SITE_FORMAT, SiteFile};
use crate::stand::{STAND_FORMAT, Stand};
use schemars::{JsonSchema, Schema, schema_for};
use serde_json::{Value, json};

/// Of a stand file.
pub fn stand() -> Schema {
    with_format(schema_for!(Stand), STAND_FORMAT)
}

/// Of a site file.
pub fn site() -> Schema {
    with_format(schema_for!(SiteFile), SITE_FORMAT)
}

/// Of a gyro type.
pub fn gyro() -> Schema {
    with_format(schema_for!(GyroType), GYRO_FORMAT)
}

/// Of a laboratory.
pub fn laboratory() -> Schema {
    with_format(schema_for!(Laboratory), LABORATORY_FORMAT)
}

/// Of a passport, its signature included. A text that fits the schema need not be a passport: see `verify`.
pub fn passport() -> Schema {
    #[derive(JsonSchema)]
    #[allow(dead_code)]
    #[schemars(rename = "Passport", deny_unknown_fields)]
    struct Signed {
        #[schemars(flatten)]
        content: Content,
        /// OpenSSH's armored signature over every byte before this key.
        signature: String,
    }
    with_format(schema_for!(Signed), PASSPORT_FORMAT)
}

/// The value that `format` must have.
fn with_format(mut schema: Schema, format: &str) -> Schema {
    if let Some(Value::Object(property)) = schema.pointer_mut("/properties/format") {
        property.insert("const".to_owned(), json!(format));
    }
    schema
}
