//! The text of every document: strict YAML in, one canonical form out, errors that point into the file.
//!
//! * `rule`: what a signed text may contain, and how a string is written: writer and reader of the rule side by side.
//! * `number`: how a number is written.
//! * `canonical`: the one form that content is written in, and its reader.
//! * `sink`: what a document is written into.
//! * `node`: a document as a tree.
//! * `record`: from that tree to a Rust struct and back, every mistake reported, not only the first.
//! * `scalar`: identifiers, dates and times.
//! * `table`: tables of numbers (CSV).
//! * `yaml`: hand-written YAML to a tree, with the place of every value found again when an error needs it.
//! * `printable`: text of others among the program's own words.
//! * `problem`: what is wrong, where, what was expected, what to do; `excerpt`: the line in which.

pub(crate) mod canonical;
pub(crate) mod excerpt;
pub(crate) mod node;
pub(crate) mod number;
pub(crate) mod printable;
pub(crate) mod problem;
pub(crate) mod record;
pub(crate) mod rule;
pub(crate) mod scalar;
pub(crate) mod sink;
pub(crate) mod table;
#[cfg(feature = "factory")]
pub(crate) mod yaml;

pub(crate) use node::Node;
pub(crate) use printable::{Printable, name_of, printable, shown};
pub use problem::{Location, Problem, Unreadable};
pub(crate) use problem::{Path, Problems};
pub(crate) use record::{Field, record};
pub use scalar::Identifier;

/// The largest document that is read at all, in bytes.
///
/// A stand with a thousand positions takes a fifth of it; what is larger is not a document of this project.
pub const LARGEST_DOCUMENT_BYTES: usize = 1 << 20;
