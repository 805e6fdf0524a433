//! Verb `verify`: the check that a passport is valid for this stand, place and time.

use super::options::Printed;
use super::trust_options::TrustAmong;
use super::{Code, Failure, REFUSED, UNUSABLE, defaults, output};
use crate::batch::paths;
use crate::files::{self, FileError};
use crate::report::verdict;
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, name_of};
use clap::Args;
use std::path::PathBuf;

/// Check that a passport is valid for this stand, place and time
///
/// PASSPORT is a file or a quoted pattern; a - reads a list of paths from standard input.
#[derive(Args)]
pub(super) struct Options {
    /// Passport files; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    #[command(flatten)]
    trust: TrustAmong,
    #[command(flatten)]
    _printed: Printed,
}

/// Verifies every passport. What cannot be read has a verdict too, so that each input has one in the list.
pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.trust.load()?;
    let mut code = 0;
    let (mut verdicts, mut blocks, mut unread) = (Vec::new(), Vec::new(), Vec::new());
    for path in paths::named(&options.passports, &mut std::io::stdin().lock()) {
        let (name, read) = match &path {
            // One byte above the size limit is enough to show that the file is not a passport; the result is a normal
            // verdict.
            Ok(path) => (name_of(path), files::read_first(path, LARGEST_DOCUMENT_BYTES + 1).map_err(not_read)),
            Err(failed) => (failed.what.clone(), Err(Failure::input(failed))),
        };
        let verification = match &read {
            Ok(bytes) => enquiry.verification(&name, bytes),
            Err(failure) => enquiry.unreadable(&failure.failed.message),
        };
        let verdict = verdict::Verdict::of(&name, &verification, &enquiry.remarks());
        match read {
            Ok(_) => {
                code = code.max(if verdict.valid { 0 } else { REFUSED });
                blocks.extend(verdict::document(&verdict, &verification, &enquiry.question));
            }
            Err(failure) => {
                code = code.max(UNUSABLE);
                blocks.extend(verdict::not_read(&verdict));
                unread.push(failure);
            }
        }
        verdicts.push(verdict);
    }
    blocks.extend(verdict::summary(&verdicts, unread.len()));
    let written = output::show(|| &verdicts, || blocks);
    unread.iter().for_each(|failure| output::complain(&failure.failed.message));
    written.map(|()| code)
}

fn not_read(error: FileError) -> Failure {
    match error {
        FileError::Folder(_) => {
            Failure::refused(format!("{error}; list its passports with `register`, or give the files"))
        }
        error => Failure::of_file(error, Some(Kind::Passport.words())),
    }
}
