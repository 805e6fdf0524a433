//! Verb `show`: the passport as tables, or in full as JSON.

use super::output::Format;
use super::trust_options::{self, Asked};
use super::{Code, Failure, defaults, output};
use crate::files;
use crate::passport::{Content, Question, Trust, Verification, read, verify};
use crate::report::passport_table;
use crate::text::{Field, LARGEST_DOCUMENT_BYTES, name_of};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// Show a passport as tables, or in full as JSON for tools without YAML
#[derive(Args)]
pub(super) struct Options {
    #[command(flatten)]
    passport: PassportOptions,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// A passport that is used: verified, or, said loudly, not.
#[derive(Args)]
#[command(group(ArgGroup::new("whom").required(true).args(["trust", "no_verify"])))]
pub(super) struct PassportOptions {
    /// Passport file; in a workspace also its identifier
    #[arg(value_name = "PASSPORT", value_parser = defaults::passport())]
    passport: PathBuf,
    /// Trusted signing keys: an OpenSSH allowed_signers file
    #[arg(long, value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Revocations: an OpenSSH KRL, a list of public keys, or a list of withdrawn passports (repeatable)
    #[arg(long, value_name = "FILE", requires = "trust")]
    revoked: Vec<PathBuf>,
    #[command(flatten)]
    asked: Asked,
    /// Do not verify the passport; the output carries a warning
    #[arg(long, conflicts_with_all = ["issuer", "serial", "at", "time"])]
    no_verify: bool,
}

/// A passport that was read, and the result of its verification.
pub(super) struct Read {
    pub content: Content,
    pub bytes: Vec<u8>,
    /// Verification with the trust and the question used; `None` if the passport was not verified.
    pub verification: Option<(Verification, Trust, Question)>,
}

impl PassportOptions {
    /// Reads the passport and verifies it, unless `--no-verify` is given. A passport that fails a check is refused with
    /// its verdict.
    pub(super) fn read(&self) -> Result<Read, Failure> {
        let bytes = files::read(&self.passport, LARGEST_DOCUMENT_BYTES).map_err(Failure::file)?;
        let name = name_of(&self.passport);
        let Some(signers) = &self.trust else {
            output::complain("NOT VERIFIED (--no-verify): the origin of these numbers is unknown");
            let content = read::content_from_anyone(&name, &bytes).map_err(Failure::unreadable)?;
            return Ok(Read { content, bytes, verification: None });
        };
        let question = self.asked.question();
        let trust = trust_options::load(signers, &self.revoked, question.time)?;
        let verification = verify(&name, &bytes, &trust, &question);
        match verification.passport() {
            Some(passport) => {
                let content = passport.content().clone();
                Ok(Read { content, bytes, verification: Some((verification, trust, question)) })
            }
            None => Err(Failure::verdict("", &name, &verification)),
        }
    }
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let Read { content, verification, .. } = options.passport.read()?;
    match options.format {
        Format::Json => output::json(&content.write())?,
        Format::Text => output::text(&passport_table::text(&content, verification.is_some()))?,
    }
    Ok(0)
}
