//! Verb `diff`: two passports, number by number.

use super::output::{self, Format};
use super::trust_options::TrustOptions;
use super::{Code, Failure, defaults, inputs};
use crate::document::sha256_hex;
use crate::passport::difference::Differences;
use crate::passport::{CheckName, Content, Question, Trust, verify};
use crate::report::difference::{self, Side};
use crate::text::kind::Kind;
use crate::text::{name_of, printable};
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
    trust: TrustOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let a = Past::read(&options.a, &trust, &question)?;
    let b = Past::read(&options.b, &trust, &question)?;
    let found = Differences::of(&a.content, &b.content);
    match options.format {
        Format::Json => output::json(&difference::to_json(a.side(), b.side(), &found))?,
        Format::Text => output::text(&difference::text(a.side(), b.side(), &found))?,
    }
    Ok(0)
}

/// Verified passport that may have expired: it is compared, not used.
pub(super) struct Past {
    pub name: String,
    pub sha256: String,
    pub content: Content,
}

impl Past {
    /// Reads and verifies a passport; it may have expired, which is reported.
    pub(super) fn read(path: &Path, trust: &Trust, question: &Question) -> Result<Self, Failure> {
        let bytes = inputs::bytes(path, Kind::Passport.words())?;
        let name = name_of(path);
        let verification = verify(&name, &bytes, trust, question);
        let Some(content) = verification.content_even_if_expired().cloned() else {
            return Err(Failure::verdict("", &name, &verification));
        };
        let expired = verification.checks().iter().find(|check| check.name == CheckName::InForce);
        if let Some(check) = expired.filter(|check| check.passed() == Some(false)) {
            output::say(&format!("{}: {}", printable(&name), check.detail));
        }
        Ok(Self { sha256: sha256_hex(&bytes), name, content })
    }

    pub(super) fn side(&self) -> Side<'_> {
        Side { file: &self.name, sha256: &self.sha256, content: &self.content }
    }
}
