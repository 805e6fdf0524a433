//! Verb `register`: the passports in a folder by their registers, and the renewal of registers.

use super::key_options::SigningOptions;
use super::options::Tabular;
use super::output::Format;
use super::trust_options::{TrustOptions, date};
use super::{Code, Failure, code, inputs, open_workspace, output};
use crate::folder::overview::Overview;
use crate::folder::renewal::{NotRenewed, Renewal};
use crate::register::{Row, State};
use crate::report::register as report;
use crate::text::{Printable, misspelt, shown};
use crate::workspace::Workspace;
use clap::Args;
use jiff::civil::Date;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// List every passport under a folder by the register of its stand: current, superseded, moved, withdrawn, expired; or
/// renew the registers
#[derive(Args)]
#[command(
    mut_arg("issuer", |arg| arg.help("Only passports of this issuer")),
    mut_arg("serial", |arg| arg.help("Only passports of stands with this serial number")),
    mut_arg("at", |arg| arg.help("Only passports for this place: latitude and longitude in degrees, north and east positive"))
)]
pub(super) struct Options {
    /// Folder of passports
    #[arg(value_name = "DIR", required_unless_present = "passports")]
    folder: Option<PathBuf>,
    /// Folder of passports (the same as the argument DIR)
    #[arg(long, value_name = "DIR", conflicts_with = "folder")]
    passports: Option<PathBuf>,
    #[command(flatten)]
    trust: TrustOptions,
    /// Only current passports that expire within DAYS days
    #[arg(long, value_name = "DAYS", value_parser = inputs::whole::<u32>(0..=36_500))]
    within: Option<u32>,
    /// Only passports in these states
    #[arg(long, value_delimiter = ',', value_name = "STATE", value_parser = STATES)]
    state: Vec<String>,
    /// Only passports of this site
    #[arg(long, value_name = "ID")]
    site: Option<String>,
    /// Sign every register again, and make first ones where passports have none; read with --dry-run what is concluded
    #[arg(long)]
    renew: bool,
    #[command(flatten)]
    renewal: RenewalOptions,
    #[command(flatten)]
    _printed: Tabular,
}

/// States of passports, `expired` among them.
const STATES: [&str; 5] = ["current", "superseded", "moved", "withdrawn", "expired"];

#[derive(Args)]
#[command(mut_arg("dry_run", |dry_run| dry_run.requires("renew")))]
struct RenewalOptions {
    /// With --renew: date until which the new registers count as fresh (inclusive), or `never` [default: as before]
    #[arg(long, value_name = "DATE|never", value_parser = fresh_until, requires = "renew")]
    fresh_until: Option<Fresh>,
    /// With --renew: take over the passport that is not listed, or the register under a signing key that is no longer
    /// trusted, with this SHA-256 (repeatable)
    #[arg(long, value_name = "SHA256", requires = "renew")]
    adopt: Vec<String>,
    /// With --renew: join with another register of the same stand
    #[arg(long = "with", value_name = "REGISTER", requires = "renew")]
    other: Option<PathBuf>,
    /// With --renew: withdraw this passport, which a list of an earlier version withdraws; --reason says why (repeatable)
    #[arg(long, value_name = "ID", requires_all = ["renew", "reason"])]
    withdrawn: Vec<String>,
    /// Reason for the withdrawal of the passport of --withdrawn, in the same order; a single one is for all
    #[arg(long, value_name = "TEXT", requires = "withdrawn")]
    reason: Vec<String>,
    /// With --renew: do not withdraw this passport, although a list of an earlier version does (repeatable)
    #[arg(long, value_name = "ID", requires = "renew")]
    not_withdrawn: Vec<String>,
    #[command(flatten)]
    keys: SigningOptions,
}

/// Last day of freshness, or none.
#[derive(Debug, Clone, Copy)]
struct Fresh(Option<Date>);

fn fresh_until(text: &str) -> Result<Fresh, String> {
    if text == "never" { Ok(Fresh(None)) } else { date(text).map(|last| Fresh(Some(last))) }
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.folder.as_ref().or(options.passports.as_ref());
    let folder = folder.ok_or_else(|| Failure::usage("missing DIR, the folder of passports"))?;
    refuse_file(folder)?;
    if options.renew {
        return renew(options, folder);
    }
    let (trust, question) = options.trust.load()?;
    let query = Workspace::query(open_workspace::workspace(), &trust, &question);
    let mut overview = Overview::of(folder, query)?;
    let code = code(overview.is_incomplete(), overview.needs_attention());
    overview.remarks.iter().chain(&overview.absent).for_each(|words| output::say(words));
    overview.alarms.iter().for_each(|alarm| output::complain_after(&alarm.to_string()));
    let serial = question.serial.as_deref();
    for words in [no_such_stand(serial, &overview), options.no_such_site(&overview)].into_iter().flatten() {
        output::say(&words);
    }
    let listed = overview.stands.iter().map(|stand| stand.listed).sum();
    // The filters select rows; alarms concern all passports.
    for stand in &mut overview.stands {
        stand.rows.retain(|row| options.selects(row, question.time));
    }
    match output::format() {
        Format::Text => output::document(&report::document(&overview, listed))?,
        Format::Json => output::json(&overview)?,
        Format::Ndjson => overview.stands.iter().try_for_each(output::json_line)?,
        Format::Csv => output::result(&report::csv(&overview))?,
    }
    Ok(code)
}

/// Signs the registers again.
fn renew(options: &Options, folder: &Path) -> Result<Code, Failure> {
    let RenewalOptions { fresh_until, adopt, other, withdrawn, reason, not_withdrawn, keys } = &options.renewal;
    let (trust, _) = options.trust.load()?;
    if keys.identity.is_none() {
        return Err(Failure::usage("--renew needs --identity WHO"));
    }
    if !keys.dry_run && keys.lacks_key() {
        return Err(Failure::usage("--renew needs --key KEY, or --register-key KEY, or --dry-run"));
    }
    let reasons: Vec<&String> = match reason.as_slice() {
        [one] => withdrawn.iter().map(|_| one).collect(),
        each if each.len() == withdrawn.len() => each.iter().collect(),
        _ => return Err(Failure::usage("give one --reason for each --withdrawn, or a single one for all")),
    };
    let renewal = Renewal {
        fresh_until: fresh_until.map(|Fresh(last)| last),
        adopt: adopt.clone(),
        with: other.clone(),
        withdrawn: withdrawn.iter().cloned().zip(reasons.into_iter().cloned()).collect(),
        not_withdrawn: not_withdrawn.clone(),
        workspace: open_workspace::workspace().map(|workspace| workspace.root.clone()),
    };
    let dry_run = keys.dry_run;
    let keys = keys.keys(Some(folder))?;
    let renewed = renewal.run(folder, &keys.authority(&trust)).map_err(not_renewed)?;
    output::show(|| report::renewed_json(&renewed), || vec![report::renewed(&renewed, dry_run)])?;
    Ok(0)
}

pub(super) fn not_renewed(refused: NotRenewed) -> Failure {
    match refused {
        NotRenewed::File(error) => Failure::from(error),
        refused if refused.is_unusable() => Failure::unusable(refused),
        refused => Failure::refused(refused),
    }
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
fn no_such_stand(serial: Option<&str>, overview: &Overview) -> Option<String> {
    let serial = serial.filter(|_| overview.rows().next().is_none())?;
    let words = "every character counts, including leading zeros";
    Some(format!("no passport of a stand with the serial number {}; {words}", Printable(serial)))
}

impl Options {
    /// Returns a remark if no passport is of the site asked for, which may be mistyped.
    fn no_such_site(&self, overview: &Overview) -> Option<String> {
        let site = self.site.as_deref()?;
        let there: BTreeSet<&str> = overview.rows().map(|row| row.site.as_str()).collect();
        if there.contains(site) {
            return None;
        }
        let nearest = misspelt::name(there, site, site.len() / 3 + 1);
        let nearest = nearest.map_or_else(String::new, |near| format!("; {}", misspelt::question(Printable(near))));
        Some(format!("no passport of site {}{nearest}", Printable(site)))
    }

    fn selects(&self, row: &Row, time: jiff::Timestamp) -> bool {
        let is_current = row.state == State::Current;
        let within =
            |days: u32| row.is_in_force() && row.days_left(time).is_some_and(|left| i64::from(left) <= i64::from(days));
        let state = if is_current && row.expired { "expired" } else { row.state.key() };
        (self.state.is_empty() || self.state.iter().any(|asked| asked == state))
            && self.site.as_ref().is_none_or(|site| row.site == *site)
            && self.within.is_none_or(within)
    }
}
