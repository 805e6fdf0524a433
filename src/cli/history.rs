//! Verb `history`: one stand over the years.

use super::lang::Lang;
use super::register::refuse_file;
use super::trust_options::TrustOptions;
use super::{Code, Failure, Format, code, defaults, output};
use crate::folder::overview::{self, Query};
use crate::parallel;
use crate::passport::Question;
use crate::report::history as report;
use crate::report::picture::history as picture;
use crate::text::{Identifier, Printable, first_few, shown};
use crate::workspace::Workspace;
use clap::Args;
use std::path::PathBuf;

/// Show one stand over the years: certificates, passports, sites, withdrawals, and whether it drifts
#[derive(Args)]
pub(super) struct Options {
    /// Stand
    #[arg(value_name = "MODEL/SERIAL", value_parser = stand)]
    stand: String,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Write a picture of the timeline and of the drift
    #[arg(short, long, value_name = "FILE.svg", value_parser = output::path_of(output::PICTURE))]
    output: Option<PathBuf>,
    /// Replace an existing picture
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    _lang: Lang,
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
    let memory = defaults::workspace().map(Workspace::memory);
    let query = Query {
        trust: &trust,
        question: &Question { now: question.now, ..Question::at(question.time) },
        memory: memory.as_ref(),
        may_lack: defaults::is_of_a_laboratory(),
        threads: parallel::processors(),
    };
    let (history, is_incomplete) = overview::history(&options.passports, &options.stand, query)?;
    let history = history.map_err(|known| {
        let (folder, stand) = (shown(&options.passports), &options.stand);
        Failure::refused(match known.contains(stand) {
            true => format!(
                "{folder}: has passports of {stand}, but no register of it that counts; make it with `register {folder} \
                 --renew`, or restore it from the backup"
            ),
            false if known.is_empty() => format!("{folder}: found no register of {stand}; the folder contains no registers"),
            false => format!(
                "{folder}: found no register of {stand}; the folder contains registers of {}",
                Printable(first_few(&known))
            ),
        })
    })?;
    if let Some(path) = &options.output {
        output::saved_too(path, picture::history(&history, question.time), options.force)?;
    }
    options.format.show(|| report::to_json(&history), || report::document(&history))?;
    Ok(code(is_incomplete, false))
}
