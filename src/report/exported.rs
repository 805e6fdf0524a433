//! Passport as one JSON object for programs that compute with it, with the result of its verification.

use crate::passport::verification::not_run;
use crate::passport::{Check, Content, RegisterUsed, Verification};
use crate::stand::{CertifiedPosition, TypeB};
use crate::text::record::Record;
use crate::text::{Field, Node};
use serde::Serialize;

/// A passport with the result of its verification, whose keys come after those of `show` and before those of `export`.
#[derive(Serialize)]
struct Exported<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    #[serde(flatten)]
    shown: Option<Node>,
    verified: bool,
    sha256: String,
    not_asked: Vec<&'static str>,
    remarks: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    register: Option<RegisterUsed>,
    checks: Vec<Check>,
    #[serde(flatten)]
    exported: Option<Node>,
}

impl Exported<'_> {
    fn of(sha256: String, verification: &Verification, remarks: Vec<String>) -> Self {
        let (register, checks) = (verification.register().cloned(), verification.checks().to_vec());
        let (file, shown, exported) = (None, None, None);
        let (verified, not_asked) = (verification.valid(), verification.not_asked());
        Self { file, shown, verified, sha256, not_asked, remarks, register, checks, exported }
    }
}

/// Returns a passport as JSON: `{file, verified, sha256, not_asked, remarks, register, checks, …}`, then the keys of the
/// passport if every check passed. The objects in a list have the same keys, null where a value is absent, so that programs
/// such as MATLAB read the list as an array.
pub(crate) fn json(file: &str, sha256: String, verification: &Verification, remarks: Vec<String>) -> impl Serialize {
    let exported = verification.passport().and_then(|passport| uniform_content(passport.content()));
    Exported { file: Some(file), exported, ..Exported::of(sha256, verification, remarks) }
}

/// Returns a passport as JSON with the keys of its file, in their order, and then what [`json`] says of its
/// verification; without `verification` no check was run.
pub(crate) fn shown(
    content: &Content,
    sha256: String,
    verification: Option<&Verification>,
    remarks: Vec<String>,
) -> impl Serialize + use<> {
    Exported { shown: content.write(), ..Exported::of(sha256, verification.unwrap_or(&not_run()), remarks) }
}

/// Returns the keys of a passport and their values, with uniform keys in its lists.
fn uniform_content(content: &Content) -> Option<Node> {
    let mut node = content.write()?;
    uniform(value_of(&mut node, "positions"), CertifiedPosition::KEYS);
    uniform(value_of(&mut node, "certificate").and_then(|certificate| value_of(certificate, "type_b")), TypeB::KEYS);
    Some(node)
}

fn value_of<'n>(node: &'n mut Node, key: &str) -> Option<&'n mut Node> {
    let Node::Map(entries) = node else { return None };
    entries.iter_mut().find(|(name, _)| name == key).map(|(_, value)| value)
}

/// Gives every object of a list the same `keys`, in their order.
fn uniform(list: Option<&mut Node>, keys: &[&str]) {
    let Some(Node::List(items)) = list else { return };
    for item in items {
        let filled = keys.iter().map(|key| ((*key).to_owned(), item.get(key).cloned().unwrap_or(Node::Null)));
        *item = Node::Map(filled.collect());
    }
}
