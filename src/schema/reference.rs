//! Lists of keys in Markdown, generated from the schemas, so that they always agree with what the program reads.

use serde_json::{Map, Value};
use std::collections::HashMap;
use std::fmt::Write;

/// Returns the keys of every format as Markdown, with a section for each; what has the same keys is described once.
pub(crate) fn lists(schemas: &[&Value]) -> String {
    let mut seen = HashMap::new();
    schemas.iter().map(|&schema| Section { schema, seen: &mut seen }.write()).collect::<Vec<_>>().join("\n")
}

/// Section of one format.
struct Section<'a> {
    schema: &'a Value,
    /// Key sets of described mappings, each with the place of its description.
    seen: &'a mut HashMap<Vec<String>, String>,
}

impl Section<'_> {
    fn write(mut self) -> String {
        let root = self.schema.as_object().cloned().unwrap_or_default();
        let format = self.schema.pointer("/properties/format/const").or(self.schema.get("title"));
        let format = format.and_then(Value::as_str).unwrap_or_default();
        let mut out = format!("## `{format}`\n\n{}\n\n", text(&root, "description"));
        self.seen.insert(keys(&root), format.to_owned());
        self.rows(&root, "", format, &mut out);
        out
    }

    /// Writes a line for each key of a mapping; the keys of a nested mapping follow its own line.
    fn rows(&mut self, mapping: &Map<String, Value>, prefix: &str, format: &str, out: &mut String) {
        let required: Vec<&str> =
            mapping.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str).collect();
        for (name, property) in mapping.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let Some(property) = property.as_object().filter(|_| name != "format") else { continue };
            let key = format!("{prefix}{name}");
            let (part, below) = match items(property) {
                Some(items) if reference(items).is_some() => (reference(items), "[]."),
                _ => (reference(property), "."),
            };
            let part = part.and_then(|name| self.definition(name)).filter(is_mapping);
            let seen = part.as_ref().and_then(|part| self.seen.get(&keys(part)));
            let see = seen.map_or_else(String::new, |place| format!(" See `{place}`."));
            let bold = if required.contains(&name.as_str()) { "**" } else { "" };
            let value = format!(" ({})", self.value(property)).replace(" ()", "").replace(" (number)", "");
            let _ = writeln!(out, "- {bold}`{key}`{bold}{value}: {}{see}", text(property, "description"));
            if let Some(part) = part.filter(|_| see.is_empty()) {
                self.seen.insert(keys(&part), format!("{key}` of `{format}"));
                self.rows(&part, &format!("{key}{below}"), format, out);
            }
        }
    }

    fn definition(&self, name: &str) -> Option<Map<String, Value>> {
        let found = self.schema.pointer(&format!("/$defs/{name}"))?.as_object()?;
        // A record on one line refers to the record.
        reference(found).map_or_else(|| Some(found.clone()), |record| self.definition(record))
    }

    /// Returns the kind of a value, in words; empty for a text and a mapping. A line leaves out that of a number too.
    fn value(&self, property: &Map<String, Value>) -> String {
        // Of a mapping these are keys that exclude each other.
        if let Some(choices) = property.get("oneOf").and_then(Value::as_array).filter(|_| !is_mapping(property)) {
            return choices
                .iter()
                .filter_map(Value::as_object)
                .map(|one| self.value(one))
                .collect::<Vec<_>>()
                .join(", ");
        }
        if let Some(constant) = property.get("const") {
            return format!("`{constant}`");
        }
        if let Some(part) = reference(property).and_then(|name| self.definition(name)) {
            return self.value(&part);
        }
        match property.get("type").and_then(Value::as_str) {
            Some("object") => String::new(),
            Some("array") => self.list(property),
            Some("integer") => "integer".to_owned(),
            Some("boolean") => "true or false".to_owned(),
            Some("string") => match property.get("format").and_then(Value::as_str) {
                Some("date") => "day".to_owned(),
                Some("date-time") => "time".to_owned(),
                _ => String::new(),
            },
            Some(other) => other.to_owned(),
            None => String::new(),
        }
    }

    fn list(&self, property: &Map<String, Value>) -> String {
        let of = items(property).map_or_else(String::new, |items| self.value(items));
        match property.get("minItems").and_then(Value::as_u64) {
            Some(length) if property.get("maxItems") == property.get("minItems") => format!("{length}×{of}"),
            _ if of.is_empty() => "list".to_owned(),
            _ => format!("list: {of}"),
        }
    }
}

/// Returns the names of a mapping's keys without `format`, by which a file that is part of another one is recognised.
fn keys(mapping: &Map<String, Value>) -> Vec<String> {
    let properties = mapping.get("properties").and_then(Value::as_object);
    properties.into_iter().flatten().map(|(name, _)| name.clone()).filter(|name| name != "format").collect()
}

fn is_mapping(part: &Map<String, Value>) -> bool {
    part.get("properties").is_some()
}

fn items(property: &Map<String, Value>) -> Option<&Map<String, Value>> {
    property.get("items")?.as_object()
}

/// Returns the name of the definition that a property refers to, or `None` if it refers to none.
fn reference(property: &Map<String, Value>) -> Option<&str> {
    property.get("$ref")?.as_str()?.strip_prefix("#/$defs/")
}

fn text(object: &Map<String, Value>, key: &str) -> String {
    object.get(key).and_then(Value::as_str).unwrap_or_default().replace('\n', " ")
}
