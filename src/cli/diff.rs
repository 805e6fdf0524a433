//! Verb `diff`: two passports, number by number.

use super::options::Printed;
use super::trust_options::{Enquiry, TrustAmong};
use super::{Code, Failure, defaults, inputs, output};
use crate::document::sha256_hex;
use crate::passport::difference::Differences;
use crate::report::difference::{self, Side};
use crate::text::{Kind, name_of, printable};
use clap::Args;
use std::path::{Path, PathBuf};

/// Compare two passports number by number, in units of their uncertainty
#[derive(Args)]
pub(super) struct Options {
    /// First passport, for example the predecessor; in a workspace also its identifier
    #[arg(value_name = "PASSPORT", value_parser = defaults::passport())]
    a: PathBuf,
    /// Second passport
    #[arg(value_name = "PASSPORT", value_parser = defaults::passport())]
    b: PathBuf,
    #[command(flatten)]
    trust: TrustAmong,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.trust.load()?;
    let a = past(&options.a, &enquiry)?;
    let b = past(&options.b, &enquiry)?;
    let found = Differences::of(&a.content, &b.content);
    output::show(|| difference::to_json(&a, &b, &found), || difference::document(&a, &b, &found))?;
    Ok(0)
}

/// Reads and verifies a passport to compare it, not to use it: it may have expired, or been superseded or withdrawn,
/// which is reported.
pub(super) fn past(path: &Path, enquiry: &Enquiry) -> Result<Side, Failure> {
    let bytes = inputs::bytes(path, Kind::Passport.words())?;
    let file = name_of(path);
    let verification = enquiry.verification(&file, &bytes);
    let Some(content) = verification.content_even_if_past().cloned() else {
        return Err(Failure::verdict("", &file, &verification, &enquiry.question));
    };
    for check in verification.checks().iter().filter(|check| check.passed() == Some(false)) {
        output::say(&format!("{}: {}", printable(&file), check.detail));
    }
    Ok(Side { file, sha256: sha256_hex(&bytes), content })
}
