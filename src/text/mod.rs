//! Text of documents: strict YAML input, canonical output, and errors with their location in the file.
//!
//! * `characters`: what signed texts may contain, and what looks alike.
//! * `rule`: allowed content of signed texts, form of strings, and the check of both.
//! * `number`: form of numbers; `advice`: what to do about text where a number is expected, and about unknown names.
//! * `canonical`: canonical form of content, and its reader.
//! * `node`: documents as trees; `field`: their values, and destinations of a document.
//! * `record`: conversion of trees to Rust structs and back; every error is reported, not only the first.
//! * `words`: enums whose variants are words.
//! * `scalar`: identifiers, dates and times.
//! * `table`: tables of numbers (CSV).
//! * `yaml`: conversion of hand-written YAML to a tree; `locate`: location of a value, found again if an error needs it.
//! * `misspelt`: the name that a misspelt one means.
//! * `printable`: safe display of text from other sources.
//! * `kind`: what a file is that was given instead of another.
//! * `cause`: recognised causes of errors, and the advice on each; `advice`: how they are recognised in what was written.
//! * `problem`: location, found content, expected content and advice of an error; `excerpt`: its line.

pub(crate) mod advice;
pub(crate) mod canonical;
pub(crate) mod cause;
pub(crate) mod characters;
pub(crate) mod excerpt;
pub(crate) mod field;
pub(crate) mod kind;
#[cfg(feature = "yaml")]
mod locate;
pub(crate) mod misspelt;
pub(crate) mod node;
pub(crate) mod number;
pub(crate) mod printable;
pub(crate) mod problem;
pub(crate) mod record;
pub(crate) mod rule;
pub(crate) mod scalar;
pub(crate) mod table;
pub(crate) mod words;
#[cfg(feature = "yaml")]
pub(crate) mod yaml;

pub(crate) use cause::Advice;
pub use cause::RefusalCause;
pub use excerpt::Location;
pub(crate) use field::Field;
pub(crate) use kind::Kind;
pub(crate) use node::Node;
pub(crate) use printable::{Printable, name_of, printable, shown, without_secrets};
pub(crate) use problem::{Path, Problems};
pub use problem::{Problem, Unreadable};
pub(crate) use record::{Document, record};
pub use scalar::{Identifier, NotAnIdentifier};
pub(crate) use words::{first_few, word_of_a_key, words};

/// Size of the largest document that is read, in bytes.
///
/// A stand with a thousand positions needs a fifth of it; a larger file is not a document of this project.
pub const LARGEST_DOCUMENT_BYTES: usize = 1 << 20;

/// Largest size of a signed text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Limits {
    pub bytes: usize,
    /// Opening brackets, including those in strings.
    pub brackets: usize,
}

impl Limits {
    /// Limits of a passport; one of the largest size has about 18,000 brackets.
    pub(crate) const DOCUMENT: Self = Self { bytes: LARGEST_DOCUMENT_BYTES, brackets: 25_000 };
}

/// Returns the advice on a file that is too large; `name` is that of a file, or the word for currents that are not in one.
pub(crate) fn large_file(name: &str) -> &'static str {
    match name == "currents" || name.to_lowercase().ends_with(".csv") {
        true => {
            "check that this is the right file; of a long record of readings, give the means, for example of each second"
        }
        false => "check that this is the right file",
    }
}
