//! `show`: the passport as tables, or whole as JSON.

use super::output::Format;
use super::trust_options::{self, Asked};
use super::{Code, Failure, REFUSED, output};
use clap::{ArgGroup, Args};
use dtg_passport::files;
use dtg_passport::passport::verify;
use dtg_passport::report::{passport_table, verdict};
use dtg_passport::text::{Field, LARGEST_DOCUMENT_BYTES};
use std::path::PathBuf;

/// Show a passport as tables, or the whole of it as JSON for tools that read no YAML
#[derive(Args)]
#[command(group(ArgGroup::new("whom").required(true).args(["trust", "no_verify"])))]
pub struct Options {
    /// The passport
    #[arg(value_name = "PASSPORT")]
    passport: PathBuf,
    /// The keys that may sign: OpenSSH's allowed_signers
    #[arg(long, value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Keys that no longer count: a KRL of OpenSSH or a list of public keys (repeatable)
    #[arg(long, value_name = "FILE", requires = "trust")]
    revoked: Vec<PathBuf>,
    #[command(flatten)]
    asked: Asked,
    /// Verify nothing, and say so loudly
    #[arg(long)]
    no_verify: bool,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let bytes = files::read(&options.passport, LARGEST_DOCUMENT_BYTES).map_err(Failure::unusable)?;
    let name = options.passport.display().to_string();
    let content = match &options.trust {
        Some(signers) => {
            let trust = trust_options::load(signers, &options.revoked)?;
            let verification = verify(&name, &bytes, &trust, &options.asked.question());
            let Some(passport) = verification.passport() else {
                let verdict = verdict::Verdict::of(&name, &verification);
                return Err(Failure { message: verdict::text(&[verdict]), code: REFUSED });
            };
            passport.content().clone()
        }
        None => {
            output::say("NOT VERIFIED (--no-verify): anybody may have written these numbers");
            dtg_passport::passport::read::unverified(&name, &bytes).map_err(Failure::unusable)?
        }
    };
    match options.format {
        Format::Json => output::json(&content.write())?,
        Format::Text => output::result(&passport_table::text(&content, options.trust.is_some()))?,
    }
    Ok(0)
}
