//! Verb `register`: the passports in a folder and their states.

use super::output::{self, TableFormat};
use super::trust_options::TrustOptions;
use super::{Code, Failure, REFUSED, UNUSABLE};
use crate::folder::search;
use crate::parallel;
use crate::passport::{Question, Trust};
use crate::register::{Asked, Register};
use crate::report::register as report;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// List every passport under a folder: in force, superseded, moved, expired, revoked, broken
#[derive(Args)]
pub(super) struct Options {
    /// Folder of passports; revocation lists in it and up to two levels above are used too
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Flag passports that expire within DAYS days
    #[arg(long, value_name = "DAYS")]
    within: Option<u32>,
    /// Sort order
    #[arg(long, value_enum, default_value = "stand")]
    by: By,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: TableFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum By {
    Stand,
    Site,
    Issuer,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let asked = Asked { question, within_days: options.within };
    let register = search::register(&options.folder, trust, &asked, parallel::processors());
    let (mut register, _) = register.map_err(Failure::unusable)?;
    match options.by {
        By::Stand => {}
        By::Site => register.passports.sort_by(|a, b| a.site.cmp(&b.site)),
        By::Issuer => register.passports.sort_by(|a, b| a.issuer.cmp(&b.issuer)),
    }
    match options.format {
        TableFormat::Text => output::result(&report::text(&register))?,
        TableFormat::Json => output::json(&register)?,
        TableFormat::Csv => output::result(&report::csv(&register))?,
    }
    Ok(match (register.is_incomplete(), register.needs_attention()) {
        (true, _) => UNUSABLE,
        (_, true) => REFUSED,
        _ => 0,
    })
}

/// Reads the register of `folder`, and adds the revocation lists found there to `trust`. The register is `None` without
/// a folder.
pub(super) fn asked(
    folder: Option<&Path>,
    trust: Trust,
    question: &Question,
) -> Result<(Option<Register>, Trust), Failure> {
    let Some(folder) = folder else { return Ok((None, trust)) };
    let (register, trust) = search::register(folder, trust, &Asked::at(question.time), parallel::processors())
        .map_err(Failure::unusable)?;
    register.alarms.iter().for_each(|alarm| output::say(&alarm.to_string()));
    Ok((Some(register), trust))
}
