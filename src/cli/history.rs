//! Verb `history`: one stand over the years.

use super::register::refuse_file;
use super::trust_options::TrustOptions;
use super::{Code, Failure, Format, code, output};
use crate::folder::search;
use crate::parallel;
use crate::report::history as report;
use crate::report::picture::history as picture;
use crate::text::{Identifier, Printable, first_few, shown};
use clap::Args;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Show one stand over the years: certificates, passports, sites, withdrawals, and whether it drifts
#[derive(Args)]
pub(super) struct Options {
    /// Stand
    #[arg(value_name = "MODEL/SERIAL", value_parser = stand)]
    stand: String,
    /// Folder of passports; lists of withdrawn passports count in it, in `revocations` next to it, and in the folders up
    /// to two levels above
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Write a picture of the timeline and of the drift
    #[arg(short, long, value_name = "FILE.svg", value_parser = output::path_of("svg"))]
    output: Option<PathBuf>,
    /// Replace an existing picture
    #[arg(long)]
    force: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

fn stand(text: &str) -> Result<String, String> {
    let parts =
        text.split_once('/').filter(|(model, serial)| [model, serial].iter().all(|name| Identifier::new(name).is_ok()));
    parts.map(|_| text.to_owned()).ok_or_else(|| "expected model and serial number, such as SPS-2/0017".to_owned())
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    refuse_file(&options.passports)?;
    let (trust, question) = options.trust.load()?;
    if !question.is_open() {
        output::warn("--issuer, --serial and --at have no effect on a history");
    }
    let (history, register) =
        search::history(&options.passports, &options.stand, trust, question.time, parallel::processors())?;
    let Some(history) = history else {
        let known: BTreeSet<&str> = register.passports.iter().filter_map(|line| line.stand.as_deref()).collect();
        let known: Vec<&str> = known.into_iter().collect();
        let there =
            if known.is_empty() { "no passports".to_owned() } else { format!("passports of {}", first_few(&known)) };
        return Err(Failure::refused(format!(
            "{}: found no passport of {}; the folder contains {}",
            shown(&options.passports),
            options.stand,
            Printable(there)
        )));
    };
    if let Some(path) = &options.output {
        output::saved_too(path, &picture::history(&history, question.time), options.force)?;
    }
    options.format.write(|| report::to_json(&history), || report::text(&history))?;
    Ok(code(register.is_incomplete(), false))
}
