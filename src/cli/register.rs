//! Verb `register`: the passports in a folder and their states.

use super::trust_options::{TrustOptions, date};
use super::{Code, Failure, code, output};
use crate::folder::search;
use crate::parallel;
use crate::register::{Asked, Line, Register, State};
use crate::report::issued::Form;
use crate::report::register as report;
use crate::text::{Printable, shown};
use clap::{Args, ValueEnum};
use jiff::civil::Date;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// List every passport under a folder: in force, superseded, moved, expired, revoked, broken
#[derive(Args)]
pub(super) struct Options {
    /// Folder of passports; lists of withdrawn passports count in it, in `revocations` next to it, and in the folders up
    /// to two levels above
    #[arg(value_name = "DIR", required_unless_present = "passports")]
    folder: Option<PathBuf>,
    /// Folder of passports (the same as the argument DIR)
    #[arg(long, value_name = "DIR", conflicts_with = "folder")]
    passports: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustOptions,
    /// Flag passports that expire within DAYS days
    #[arg(long, value_name = "DAYS")]
    within: Option<u32>,
    /// Only passports in these states
    #[arg(long, value_delimiter = ',', value_name = "STATE", value_parser = State::ALL.map(State::key))]
    state: Vec<String>,
    /// Only passports of this site
    #[arg(long, value_name = "ID")]
    site: Option<String>,
    /// Only passports in force whose expiry date is before this UTC date
    #[arg(long, value_name = "DATE", value_parser = date)]
    expiring_before: Option<Date>,
    /// Sort order
    #[arg(long, value_enum, value_name = "WHAT", default_value = "stand")]
    by: By,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Form,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum By {
    Stand,
    Site,
    Issuer,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.folder.as_ref().or(options.passports.as_ref());
    let folder = folder.ok_or_else(|| Failure::usage("missing DIR, the folder of passports"))?;
    refuse_file(folder)?;
    if options.within.is_none() && options.state.iter().any(|state| state == State::Expiring.key()) {
        return Err(Failure::usage("--state expiring needs --within DAYS, such as --within 90"));
    }
    let (trust, question) = options.trust.load()?;
    let serial = question.serial.clone();
    let asked = Asked { question, within_days: options.within };
    let (mut register, _) = search::register(folder, trust, &asked, parallel::processors())?;
    let code = code(register.is_incomplete(), register.needs_attention());
    for words in [no_such_stand(serial.as_deref(), &register), options.no_such_site(&register)].into_iter().flatten() {
        output::say(&words);
    }
    // The filters select rows; alarms concern all passports.
    register.passports.retain(|line| options.selects(line));
    match options.by {
        By::Stand => {}
        By::Site => register.passports.sort_by(|a, b| a.site.cmp(&b.site)),
        By::Issuer => register.passports.sort_by(|a, b| a.issuer.cmp(&b.issuer)),
    }
    match options.format {
        Form::Text => output::text(&report::text(&register))?,
        Form::Json => output::json(&register)?,
        Form::Csv => output::result(&report::csv(&register))?,
    }
    Ok(code)
}

/// Refuses a file given instead of the folder of passports.
pub(super) fn refuse_file(folder: &Path) -> Result<(), Failure> {
    if folder.is_file() {
        let folder = shown(folder);
        let words = "found a file, expected a folder; check one passport with `verify`";
        return Err(Failure::usage(format!("{folder}: {words}")));
    }
    Ok(())
}

/// Returns a remark if no passport is of the stand asked for, which may be mistyped.
fn no_such_stand(serial: Option<&str>, register: &Register) -> Option<String> {
    let serial = serial.filter(|_| register.passports.is_empty())?;
    let words = "every character counts, including leading zeros";
    Some(format!("no passport of a stand with the serial number {}; {words}", Printable(serial)))
}

impl Options {
    /// Returns a remark if no passport is of the site asked for, which may be mistyped.
    fn no_such_site(&self, register: &Register) -> Option<String> {
        let site = self.site.as_deref()?;
        let there: BTreeSet<&str> = register.passports.iter().filter_map(|line| line.site.as_deref()).collect();
        if there.contains(site) {
            return None;
        }
        let distance = |other: &&str| strsim::damerau_levenshtein(other, site);
        let nearest = there.into_iter().min_by_key(distance).filter(|other| distance(other) <= site.len() / 3 + 1);
        let nearest = nearest.map_or_else(String::new, |nearest| format!("; did you mean {}?", Printable(nearest)));
        Some(format!("no passport of site {}{nearest}", Printable(site)))
    }

    fn selects(&self, line: &Line) -> bool {
        let before = |date: Date| line.is_usable() && line.valid_until.is_some_and(|until| until < date);
        (self.state.is_empty() || self.state.iter().any(|state| state == line.state.key()))
            && self.site.as_ref().is_none_or(|site| line.site.as_ref() == Some(site))
            && self.expiring_before.is_none_or(before)
    }
}
