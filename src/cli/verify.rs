//! Verb `verify`: the check that a passport is valid for this stand, place and time.

use super::lang::Lang;
use super::trust_options::TrustAmong;
use super::{Code, Failure, Format, REFUSED, UNUSABLE, defaults, output};
use crate::batch::paths;
use crate::files::{self, FileError};
use crate::report::verdict;
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, name_of};
use clap::Args;
use std::io;
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
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.trust.load()?;
    let mut code = 0;
    let (mut verdicts, mut blocks, mut unread) = (Vec::new(), Vec::new(), Vec::new());
    for path in paths::named(&options.passports, &mut io::stdin().lock()) {
        let read = path.map_err(|failed| (failed.what.clone(), Failure::input(&failed).failed.message));
        // One byte above the size limit is enough to show that the file is not a passport; the result is a normal
        // verdict.
        let read = read.and_then(|path| match files::read_first(&path, LARGEST_DOCUMENT_BYTES + 1) {
            Ok(bytes) => Ok((name_of(&path), bytes)),
            Err(error @ FileError::Folder(_)) => {
                Err((name_of(&path), format!("{error}; list its passports with `register`, or give the files")))
            }
            Err(error) => Err((name_of(&path), Failure::of_file(error, Some(Kind::Passport.words())).failed.message)),
        });
        match read {
            Ok((name, bytes)) => {
                let verification = enquiry.verification(&name, &bytes);
                code = code.max(if verification.valid() { 0 } else { REFUSED });
                let verdict = verdict::Verdict::of(&name, &verification, &enquiry.remarks());
                blocks.extend(verdict::document(&verdict, &verification, &enquiry.question));
                verdicts.push(verdict);
            }
            Err((name, words)) => {
                code = code.max(UNUSABLE);
                let refused = verdict::Verdict::of(&name, &enquiry.unreadable(&words), &enquiry.remarks());
                blocks.extend(verdict::not_read(&refused));
                verdicts.push(refused);
                unread.push(words);
            }
        }
    }
    blocks.extend(verdict::summary(&verdicts, unread.len()));
    let written = options.format.show(|| &verdicts, || blocks);
    unread.iter().for_each(|words| output::complain(words));
    written.map(|()| code)
}
