//! Verb `status`: the contents of a workspace.

use super::lang::Lang;
use super::trust_options::{self, OptionalLists, time};
use super::{Code, Failure, Format, code, defaults};
use crate::workspace::status;
use clap::Args;
use jiff::Timestamp;

/// Show the contents of a workspace: stands, sites, passports in force, expiring within 90 days, alarms, keys
#[derive(Args)]
pub(super) struct Options {
    #[command(flatten)]
    lists: OptionalLists,
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
    let trust = options.lists.load()?;
    let status = status(workspace, trust.as_ref(), time, now)?;
    options.format.show(|| &status, || status.document())?;
    Ok(code(status.incomplete, status.needs_attention()))
}
