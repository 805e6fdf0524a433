//! Passport as one JSON object for programs that compute with it, with the result of its verification.

use crate::passport::verification::not_run;
use crate::passport::{Check, Content, RegisterUsed, Verification};
use crate::stand::{CertifiedPosition, TypeB};
use crate::text::record::Record;
use crate::text::{Field, Node};
use serde::Serialize;

/// Result of a verification.
#[derive(Serialize)]
struct Outcome {
    verified: bool,
    sha256: String,
    not_asked: Vec<&'static str>,
    remarks: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    register: Option<RegisterUsed>,
    checks: Vec<Check>,
}

impl Outcome {
    fn of(sha256: String, verification: &Verification, remarks: Vec<String>) -> Self {
        let (register, checks) = (verification.register().cloned(), verification.checks().to_vec());
        let (verified, not_asked) = (verification.valid(), verification.not_asked());
        Self { verified, sha256, not_asked, remarks, register, checks }
    }
}

/// Returns a passport as JSON: `{file, verified, sha256, not_asked, remarks, register, checks, …}`, then the keys of the passport if every check
/// passed. The objects in a list have the same keys, null where a value is absent, so that programs such as MATLAB read
/// the list as an array.
pub(crate) fn json(file: &str, sha256: String, verification: &Verification, remarks: Vec<String>) -> impl Serialize {
    #[derive(Serialize)]
    struct Exported<'a> {
        file: &'a str,
        #[serde(flatten)]
        outcome: Outcome,
        #[serde(flatten)]
        content: Option<Node>,
    }
    let content = verification.passport().and_then(|passport| uniform_content(passport.content()));
    Exported { file, outcome: Outcome::of(sha256, verification, remarks), content }
}

/// Returns a passport as JSON with the keys of its file, in their order, and then what [`json`] says of its
/// verification; without `verification` no check was run.
pub(crate) fn shown(
    content: &Content,
    sha256: String,
    verification: Option<&Verification>,
    remarks: Vec<String>,
) -> impl Serialize + use<> {
    #[derive(Serialize)]
    struct Shown {
        #[serde(flatten)]
        content: Option<Node>,
        #[serde(flatten)]
        outcome: Outcome,
    }
    Shown { content: content.write(), outcome: Outcome::of(sha256, verification.unwrap_or(&not_run()), remarks) }
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
