//! `register`: what is in force in a folder of passports.

use super::output::{self, TableFormat};
use super::trust_options::TrustOptions;
use super::{Code, Failure, REFUSED};
use clap::{Args, ValueEnum};
use dtg_passport::files;
use dtg_passport::folder::search::{self, Found};
use dtg_passport::passport::{Question, Trust};
use dtg_passport::register::{Alarm, Register, examine};
use dtg_passport::report::register as report;
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use std::path::{Path, PathBuf};

/// List every passport under a folder: in force, superseded, moved, expired, revoked, broken
#[derive(Args)]
pub struct Options {
    /// The folder; revocation lists in it count too
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Name those that expire within this many days
    #[arg(long, value_name = "DAYS")]
    within: Option<u32>,
    /// Sort by
    #[arg(long, value_enum, default_value = "stand")]
    by: By,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: TableFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum By {
    Stand,
    Site,
    Issuer,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let mut register = read(&options.folder, trust, &question, options.within)?;
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
    Ok(if register.needs_attention() { REFUSED } else { 0 })
}

/// Reads a folder: its revocation lists first, then every passport.
pub fn read(folder: &Path, mut trust: Trust, question: &Question, within: Option<u32>) -> Result<Register, Failure> {
    let Found { passports, revocation_lists, links } = search::find(folder).map_err(Failure::unusable)?;
    let mut alarms = search::withdraw(&revocation_lists, &mut trust, question.time).map_err(Failure::unusable)?;
    alarms.extend(links.iter().map(|path| Alarm::link(&path.display().to_string())));
    let mut examined = Vec::with_capacity(passports.len());
    for path in &passports {
        let name = path.display().to_string();
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) => examined.push(examine(&name, &bytes, &trust, question, within)),
            Err(files::FileError::TooLarge { .. }) => alarms.push(Alarm::too_large(&name)),
            Err(error) => return Err(Failure::unusable(error)),
        }
    }
    Ok(Register::of(examined, alarms))
}
