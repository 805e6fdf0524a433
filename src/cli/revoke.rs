//! Verb `revoke`: withdrawal of passports in the registers of their stands.

use super::key_options::IssuerOptions;
use super::options::Printed;
use super::register::not_renewed;
use super::trust_options::TrustOptions;
use super::{Code, Failure, output};
use crate::folder::renewal::Withdrawal;
use crate::report::register as report;
use clap::Args;
use std::path::PathBuf;

/// Withdraw passports: end their entries in the registers of their stands, whatever is in their files
#[derive(Args)]
pub(super) struct Options {
    /// Identifiers (model/serial/site/revision), or quoted patterns of them, such as 'SPS-2/*/samara/*'
    #[arg(required = true, value_name = "PASSPORT-ID")]
    ids: Vec<String>,
    /// Reason, recorded in the registers, at most 500 characters
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    #[command(flatten)]
    issuer: IssuerOptions,
    #[command(flatten)]
    trust: TrustOptions,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, _) = options.trust.load()?;
    let keys = options.issuer.keys(Some(&options.passports))?;
    let withdrawal = Withdrawal { ids: &options.ids, reason: &options.reason };
    let withdrawn = withdrawal.run(&options.passports, &keys.authority(&trust)).map_err(not_renewed)?;
    if withdrawn.is_empty() {
        output::say("already withdrawn; nothing was written");
    }
    let dry_run = options.issuer.signing.dry_run;
    output::show(|| report::withdrawn_json(&withdrawn), || vec![report::withdrawn(&withdrawn, dry_run)])?;
    withdrawn.iter().flat_map(|one| &one.alarms).for_each(|alarm| output::complain(&format!("ALARM: {alarm}")));
    Ok(0)
}
