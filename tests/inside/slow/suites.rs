//! The public test suites of YAML (yaml/yaml-test-suite) and JSON (nst/JSONTestSuite), read by the readers of this project.

use crate::inside::programs;
use dtg_passport::calibration::document::CalibrationDocument;
use dtg_passport::text::{Node, yaml};
use serde::Deserialize;
use serde_json::{Deserializer, Value};

#[derive(Deserialize)]
struct Suites {
    yaml: Vec<Yaml>,
    json: Vec<Json>,
}

#[derive(Deserialize)]
struct Yaml {
    id: String,
    yaml: String,
    /// `true` if the text is not YAML.
    fail: bool,
    /// The documents of the text, if JSON can state them.
    json: Option<String>,
}

#[derive(Deserialize)]
struct Json {
    /// The first letter is y for JSON, n for a text that is not JSON, and i where RFC 8259 lets the reader decide.
    name: String,
    input: String,
}

fn suites() -> Suites {
    let mut node = programs::node();
    node.arg(programs::project("tests/readers/suites.cjs"));
    serde_json::from_str(&programs::output(node)).unwrap()
}

fn value(node: &Node) -> Value {
    match node {
        Node::Null => Value::Null,
        Node::Bool(value) => (*value).into(),
        Node::Integer(value) => (*value as f64).into(),
        Node::Number(value) => (*value).into(),
        Node::Text(text) => text.as_str().into(),
        Node::List(items) => items.iter().map(value).collect(),
        Node::Map(entries) => Value::Object(entries.iter().map(|(key, node)| (key.clone(), value(node))).collect()),
    }
}

/// Returns the value with every number as binary64.
fn with_floats(value: &Value) -> Value {
    match value {
        Value::Number(number) => number.as_f64().into(),
        Value::Array(items) => items.iter().map(with_floats).collect(),
        Value::Object(entries) => entries.iter().map(|(key, value)| (key.clone(), with_floats(value))).collect(),
        other => other.clone(),
    }
}

/// Texts that YAML 1.2 refuses and libyaml reads, nearly all with the value that their author meant: a comment without a
/// space before it, a `-` in brackets, a line that is indented too little.
const READ_ALTHOUGH_INVALID: [&str; 12] = [
    "9C9N/0", "9JBA/0", "CVW2/0", "DK95/1", "G5U8/0", "MUS6/0", "QB6E/0", "S98Z/0", "SU5Z/0", "X4QW/0", "Y79Y/3",
    "YJV2/0",
];

/// Texts that libyaml reads as YAML 1.1 or otherwise wrongly: a `?` that begins a word in brackets, an anchor with a colon,
/// blank lines at the end of a text whose last line has no line feed.
const READ_OTHERWISE: [&str; 5] = ["652Z/0", "HM87/1", "JEF9/2", "L24T/1", "Y2GN/0"];

/// Expected: the values of the suite. A document of this project needs no tags, no several documents, no keys other than
/// texts, so that a refusal of valid YAML is right too.
#[test]
fn yaml_is_read_as_its_test_suite_says_or_refused() {
    let (mut although_invalid, mut otherwise) = (Vec::new(), Vec::new());
    let [mut same, mut refused, mut refused_invalid] = [0; 3];
    for Yaml { id, yaml, fail, json } in suites().yaml {
        let json = json.unwrap_or_default();
        let documents: Vec<Value> = Deserializer::from_str(&json).into_iter().map(Result::unwrap).collect();
        match (yaml::tree("f.yaml", yaml.as_bytes()), fail) {
            (Err(_), true) => refused_invalid += 1,
            (Err(_), false) => refused += 1,
            (Ok(_), true) => although_invalid.push(id),
            (Ok((node, _)), false) if documents.iter().map(with_floats).eq([value(&node)]) => same += 1,
            (Ok(_), false) => otherwise.push(id),
        }
    }
    assert_eq!(
        (although_invalid, otherwise),
        (READ_ALTHOUGH_INVALID.map(str::to_owned).into(), READ_OTHERWISE.map(str::to_owned).into())
    );
    assert_eq!((same, refused, refused_invalid), (209, 94, 82));
}

/// Expected: what the name of each text says. Of those that RFC 8259 leaves open, 15 are read: numbers that underflow or
/// have many digits, and U+FFFD, which the package has in place of bytes that are not UTF-8.
#[test]
fn json_is_read_as_its_test_suite_says() {
    let [mut read, mut refused, mut open] = [0; 3];
    for Json { name, input } in suites().json {
        let node = Node::from_json(&input);
        match name.split_once('_').unwrap().0 {
            "y" => read += usize::from(node.is_ok()),
            "n" => refused += usize::from(node.is_err()),
            _ => open += usize::from(node.is_ok()),
        }
        // None of them is a result of a calibration or a plan.
        assert!(CalibrationDocument::from_json("f.json", input.as_bytes()).is_err(), "{name}");
    }
    assert_eq!((read, refused, open), (95, 188, 15));
}
