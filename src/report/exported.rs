//! Passport as one JSON object for programs that compute with it, with the result of its verification.

use crate::passport::verification::not_run;
use crate::passport::{Content, Verification};
use crate::stand::{CertifiedPosition, TypeB};
use crate::text::record::Record;
use crate::text::{Field, Node};

/// Returns a passport as JSON: `{file, verified, sha256, checks, …}`, then the keys of the passport if every check
/// passed. The objects in a list have the same keys, null where a value is absent, so that programs such as MATLAB read
/// the list as an array.
pub(crate) fn json(file: &str, sha256: &str, verification: &Verification) -> Node {
    let mut entries = vec![("file".to_owned(), text(file))];
    entries.extend(outcome(sha256, verification));
    if let Some(passport) = verification.passport() {
        entries.extend(uniform_content(passport.content()));
    }
    Node::Map(entries)
}

/// Returns a passport as JSON with the keys of its file, in their order, and then `verified`, `sha256` and `checks`, as
/// [`json`] writes them; without `verification` no check was run.
pub(crate) fn shown(content: &Content, sha256: &str, verification: Option<&Verification>) -> Node {
    let mut entries = entries_of(content);
    entries.extend(outcome(sha256, verification.unwrap_or(&not_run())));
    Node::Map(entries)
}

/// Returns the result of a verification: `verified`, `sha256` and `checks`.
fn outcome(sha256: &str, verification: &Verification) -> [(String, Node); 3] {
    let checks = verification.checks().iter().map(|check| {
        map([
            ("name", text(check.name.as_str())),
            ("passed", check.passed().map_or(Node::Null, Node::Bool)),
            ("code", text(check.code.as_str())),
            ("detail", text(&check.detail)),
        ])
    });
    [
        ("verified".to_owned(), Node::Bool(verification.valid())),
        ("sha256".to_owned(), text(sha256)),
        ("checks".to_owned(), Node::List(checks.collect())),
    ]
}

fn text(text: &str) -> Node {
    Node::Text(text.to_owned())
}

fn map<const N: usize>(entries: [(&str, Node); N]) -> Node {
    Node::Map(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// Returns the keys of a passport and their values.
fn entries_of(content: &Content) -> Vec<(String, Node)> {
    match content.write() {
        Some(Node::Map(entries)) => entries,
        _ => Vec::new(),
    }
}

/// Returns the keys of a passport and their values, with uniform keys in its lists.
fn uniform_content(content: &Content) -> Vec<(String, Node)> {
    let mut entries = entries_of(content);
    for (key, value) in &mut entries {
        match key.as_str() {
            "positions" => uniform(value, CertifiedPosition::KEYS),
            "certificate" => {
                if let Node::Map(certificate) = value {
                    let type_b = certificate.iter_mut().filter(|(key, _)| key == "type_b");
                    type_b.for_each(|(_, lines)| uniform(lines, TypeB::KEYS));
                }
            }
            _ => {}
        }
    }
    entries
}

/// Gives every object of a list the same `keys`, in their order.
fn uniform(list: &mut Node, keys: &[&str]) {
    let Node::List(items) = list else { return };
    for item in items {
        let filled = keys.iter().map(|key| ((*key).to_owned(), item.get(key).cloned().unwrap_or(Node::Null)));
        *item = Node::Map(filled.collect());
    }
}
