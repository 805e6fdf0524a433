//! `register`: what is in force in a folder of passports.

use super::trust_options::TrustOptions;
use super::{Code, Failure, REFUSED, UNUSABLE, output};
use clap::{Args, ValueEnum};
use dtg_passport::files::{self, FileError};
use dtg_passport::folder;
use dtg_passport::passport::{Question, Trust};
use dtg_passport::register::{Alarm, Register, examine};
use dtg_passport::report::register as report;
use dtg_passport::revocation::{RevocationList, Series, claims_to_be_a_list};
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableFormat {
    Text,
    Json,
    Csv,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let (mut register, _) = read(&options.folder, trust, &question, options.within)?;
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

/// Reads a folder: its revocation lists first, then every passport. The trust that comes back knows what those lists
/// withdraw.
pub fn read(
    folder: &Path,
    mut trust: Trust,
    question: &Question,
    within: Option<u32>,
) -> Result<(Register, Trust), Failure> {
    let found = folder::find(folder).map_err(Failure::unusable)?;
    let name = |path: &Path| path.display().to_string();
    let mut alarms: Vec<Alarm> = found.unreadable.iter().map(unreadable).collect();
    alarms.extend(found.links.iter().map(|path| Alarm::link(&name(path))));
    alarms.extend(found.special.iter().map(|path| Alarm::special(&name(path))));
    let mut good: Vec<RevocationList> = trust.withdrawn.take().into_iter().collect();
    let mut passports = found.passports;
    for path in found.revocation_lists {
        match files::read(&path, LARGEST_DOCUMENT_BYTES) {
            // A site may be called so.
            Ok(bytes) if !claims_to_be_a_list(&bytes) => passports.push(path),
            Ok(bytes) => {
                match RevocationList::verify(&name(&path), &bytes, &trust.signers, &trust.revoked, question.time) {
                    Ok(list) => {
                        if path.file_name().is_none_or(|name| *name != *list.file_name()) {
                            alarms.push(Alarm::misnamed_list(&list, &name(&path)));
                        }
                        good.push(list);
                    }
                    Err(error) => alarms.push(Alarm::refused_list(&error, &name(&path))),
                }
            }
            Err(error) => alarms.push(unreadable(&error)),
        }
    }
    let series = Series::of(good);
    alarms.extend(series.alarms.into_iter().map(Alarm::series));
    trust.withdrawn = series.newest;
    let mut examined = Vec::with_capacity(passports.len());
    for path in &passports {
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) => examined.push(examine(&name(path), &bytes, &trust, question, within)),
            Err(error) => alarms.push(unreadable(&error)),
        }
    }
    Ok((Register::of(examined, alarms), trust))
}

/// One file that cannot be read hides none of the others.
fn unreadable(error: &FileError) -> Alarm {
    match error {
        FileError::TooLarge { path, .. } => Alarm::too_large(&path.display().to_string()),
        FileError::Read { path, error } => {
            Alarm::unreadable(&format!("cannot be read: {}", files::reason(error)), &path.display().to_string())
        }
        other => Alarm::unreadable(&other.to_string(), ""),
    }
}
