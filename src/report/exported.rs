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
    #[serde(skip_serializing_if = "Option::is_none")]
    register: Option<RegisterUsed>,
    checks: Vec<Check>,
}

impl Outcome {
    fn of(sha256: String, verification: &Verification) -> Self {
        let (register, checks) = (verification.register().cloned(), verification.checks().to_vec());
        Self { verified: verification.valid(), sha256, register, checks }
    }
}

/// Returns a passport as JSON: `{file, verified, sha256, register, checks, …}`, then the keys of the passport if every check
/// passed. The objects in a list have the same keys, null where a value is absent, so that programs such as MATLAB read
/// the list as an array.
pub(crate) fn json(file: &str, sha256: String, verification: &Verification) -> impl Serialize {
    #[derive(Serialize)]
    struct Exported<'a> {
        file: &'a str,
        #[serde(flatten)]
        outcome: Outcome,
        #[serde(flatten)]
        content: Option<Node>,
    }
    let content = verification.passport().and_then(|passport| uniform_content(passport.content()));
    Exported { file, outcome: Outcome::of(sha256, verification), content }
}

/// Returns a passport as JSON with the keys of its file, in their order, and then `verified`, `sha256`, `register` and `checks`,
/// as [`json`] writes them; without `verification` no check was run.
pub(crate) fn shown(content: &Content, sha256: String, verification: Option<&Verification>) -> impl Serialize + use<> {
    #[derive(Serialize)]
    struct Shown {
        #[serde(flatten)]
        content: Option<Node>,
        #[serde(flatten)]
        outcome: Outcome,
    }
    Shown { content: content.write(), outcome: Outcome::of(sha256, verification.unwrap_or(&not_run())) }
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
