//! Verb `status`: the contents of a workspace.

use super::options::Lang;
use super::output::language;
use super::trust_options::{self, Lists, time};
use super::{Code, Failure, code, inputs, open_workspace, output};
use crate::workspace::{SOON_DAYS, due, status};
use clap::{Args, ValueEnum};
use jiff::Timestamp;

/// Show the contents of a workspace: stands, sites, passports in force, expiring within 90 days, alarms, keys
#[derive(Args)]
pub(super) struct Options {
    #[command(flatten)]
    lists: Lists,
    /// Verify as of this time: RFC 3339, or a UTC date (00:00) [default: now]
    #[arg(long, value_name = "TIME", value_parser = time)]
    time: Option<Timestamp>,
    /// List what expires or stops being fresh within DAYS days, by date, with certificate and customer
    #[arg(long, value_name = "DAYS", value_parser = inputs::whole::<i32>(0..=36_500))]
    days: Option<i32>,
    #[command(flatten)]
    _lang: Lang,
    /// Output format; csv and ics list what is due
    #[arg(long, value_enum, default_value = "text")]
    format: Form,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Form {
    /// Text for a terminal
    Text,
    /// JSON for programs
    Json,
    /// CSV for spreadsheet programs
    Csv,
    /// Calendar with an event for each day
    Ics,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let Some(workspace) = open_workspace::workspace() else {
        return Err(Failure::usage(
            "no workspace was specified; give --workspace DIR or set DTG_PASSPORT_WORKSPACE (`dtg-passport init DIR` makes \
             one)",
        ));
    };
    let now = trust_options::now();
    let time = options.time.unwrap_or(now);
    let trust = options.lists.load()?;
    let days = options.days.unwrap_or(SOON_DAYS);
    let status = status(workspace, trust.as_ref(), (time, now), days)?;
    match options.format {
        Form::Json => output::json(&status)?,
        Form::Text => {
            let due = options.days.map(|days| due::lines(&status.due, days));
            output::document(&[status.document(), due.unwrap_or_default()].concat())?;
        }
        // Its cells are escaped; a byte order mark must not be.
        Form::Csv => output::own(&due::csv(&status.due, language()))?,
        Form::Ics => output::own(&due::ics(&status.due, time, language()))?,
    }
    Ok(code(status.incomplete, status.needs_attention()))
}
