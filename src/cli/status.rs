//! Verb `status`: the contents of a workspace.

use super::lang::Lang;
use super::trust_options::{self, time};
use super::{Code, Failure, Format, code, defaults};
use crate::workspace::status;
use clap::Args;
use jiff::Timestamp;
use std::path::PathBuf;

/// Show the contents of a workspace: stands, sites, passports in force, expiring within 90 days, alarms, keys
#[derive(Args)]
pub(super) struct Options {
    /// Trusted signing keys: an OpenSSH allowed_signers file
    #[arg(long, value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Revoked keys: an OpenSSH KRL, or a list of public keys (repeatable)
    #[arg(long, value_name = "FILE", requires = "trust")]
    revoked: Vec<PathBuf>,
    /// Verify as of this time: RFC 3339, or a UTC date (00:00) [default: now]
    #[arg(long, value_name = "TIME", value_parser = time)]
    time: Option<Timestamp>,
    #[command(flatten)]
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let Some(workspace) = defaults::workspace() else {
        return Err(Failure::usage(
            "no workspace was specified; give --workspace DIR or set DTG_PASSPORT_WORKSPACE (`dtg-passport init DIR` makes \
             one)",
        ));
    };
    let now = trust_options::now();
    let time = options.time.unwrap_or(now);
    let trust = options.trust.as_deref().map(|path| trust_options::load(path, &options.revoked)).transpose()?;
    let status = status(workspace, trust.as_ref(), time, now)?;
    options.format.show(|| &status, || status.document())?;
    Ok(code(status.incomplete, status.needs_attention()))
}
