//! Verb `history`: one stand over the years.

use super::options::{Picture, Printed};
use super::register::refuse_file;
use super::trust_options::TrustOptions;
use super::{Code, Failure, code, open_workspace, output};
use crate::folder::overview::{Overview, Query};
use crate::folder::place;
use crate::passport::Question;
use crate::report::history as report;
use crate::report::picture::history as picture;
use crate::text::scalar::identifiers;
use crate::text::{Printable, first_few, shown};
use crate::workspace::{Trace, Workspace};
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use std::path::PathBuf;

/// Show one stand over the years: certificates, passports, sites, withdrawals, and whether it drifts
#[derive(Args)]
#[command(mut_args(|arg| match arg.get_id().as_str() {
    "issuer" | "serial" | "at" => arg.help("Has no effect on a history"),
    _ => arg,
}))]
pub(super) struct Options {
    /// Stand; or the number of a certificate, whose files and passports are then found in the workspace or the folder of passports
    #[arg(value_name = "MODEL/SERIAL|NUMBER", value_parser = NonEmptyStringValueParser::new())]
    stand: String,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    #[command(flatten)]
    picture: Picture,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    refuse_file(&options.passports)?;
    let (trust, question) = options.trust.load()?;
    if !question.is_open() {
        output::warn("--issuer, --serial and --at have no effect on a history");
    }
    let question = Question { now: question.now, ..Question::at(question.time) };
    let query = Workspace::query(open_workspace::workspace(), &trust, &question);
    // Model and serial number may also be the number of a certificate.
    if identifiers::<2>(&options.stand).is_none() {
        return of_certificate(options, query);
    }
    let overview = Overview::of_stand(&options.passports, &options.stand, query)?;
    let Some(history) = overview.history(&options.stand, query) else { return of_certificate(options, query) };
    options.picture.save(|| Ok(picture::history(&history, question.time)))?;
    output::show(|| report::to_json(&history), || report::document(&history))?;
    Ok(code(overview.is_incomplete(), false))
}

/// Shows the files and passports of a certificate.
fn of_certificate(options: &Options, query: Query) -> Result<Code, Failure> {
    let root = open_workspace::workspace().map_or(&options.passports, |workspace| &workspace.root);
    if let Some(found) = Trace::of(&options.stand, root, &options.passports, query)? {
        if options.picture.out.is_some() {
            return Err(Failure::usage("-o draws the years of a stand; give MODEL/SERIAL"));
        }
        output::show(|| &found, || found.document())?;
        return Ok(0);
    }
    let (folder, stand) = (shown(&options.passports), Printable(&options.stand));
    let known: Vec<String> = place::stands(&options.passports)?.into_iter().map(|(_, stand)| stand).collect();
    Err(Failure::refused(match identifiers::<2>(&options.stand).is_some() {
        false => format!("{folder}: no register and no stand file states certificate {stand}; a stand is MODEL/SERIAL"),
        true if known.contains(&options.stand) => format!(
            "{folder}: has passports of {stand}, but no register of it that counts; make it with `register {folder} \
             --renew`, or restore it from the backup"
        ),
        true if known.is_empty() => format!("{folder}: found no register of {stand}; the folder contains no registers"),
        true => format!(
            "{folder}: found no register of {stand}; the folder contains registers of {}",
            Printable(first_few(&known))
        ),
    }))
}
