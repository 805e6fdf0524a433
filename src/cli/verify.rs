//! Verb `verify`: the check that a passport is valid for this stand, place and time.

use super::trust_options::TrustAmong;
use super::{Code, Failure, Format, REFUSED, UNUSABLE, defaults, output};
use crate::files::{self, FileError};
use crate::passport::verification::unreadable;
use crate::report::verdict;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of};
use clap::Args;
use std::path::PathBuf;

/// Check that a passport is valid for this stand, place and time
#[derive(Args)]
pub(super) struct Options {
    /// Passport files; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    #[command(flatten)]
    trust: TrustAmong,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.trust.load()?;
    let mut code = 0;
    let (mut verdicts, mut text, mut unread) = (Vec::new(), String::new(), Vec::new());
    for path in &options.passports {
        let name = name_of(path);
        // One byte above the size limit is enough to show that the file is not a passport; the result is a normal
        // verdict.
        match files::read_first(path, LARGEST_DOCUMENT_BYTES + 1) {
            Ok(bytes) => {
                let verification = enquiry.verification(&name, &bytes);
                code = code.max(if verification.valid() { 0 } else { REFUSED });
                let verdict = verdict::Verdict::of(&name, &verification);
                text += &verdict::text(&verdict);
                verdicts.push(verdict);
            }
            Err(error) => {
                let advice = "list its passports with `register`, or give the files";
                let words = match error {
                    FileError::Folder(_) => format!("{error}; {advice}"),
                    error => Failure::from(error).failed.message,
                };
                code = code.max(UNUSABLE);
                let refused = verdict::Verdict::of(&name, &unreadable(&words, &enquiry.question));
                text += &verdict::not_read(&refused);
                verdicts.push(refused);
                unread.push(words);
            }
        }
    }
    text += &verdict::summary(&verdicts, unread.len());
    let written = options.format.write(|| &verdicts, || text);
    unread.iter().for_each(|words| output::complain(words));
    written.map(|()| code)
}
