//! Verb `recertify`: a new certificate from new readings, and successors of the passports in force, in one step.

use super::key_options::IssuerOptions;
use super::options::{ExclusionOptions, Force, Printed, Report, folder_of_passports};
use super::output::{language, languages};
use super::trust_options::{self, TrustOptions};
use super::{Code, Failure, REFUSED, defaults, inputs, interrupt, open_workspace, output};
use crate::batch::Outcome;
use crate::batch::recertification::{AtSite, NotRecertified, Recertification, check};
use crate::certification::{Certification, Comparison, Header};
use crate::files;
use crate::interface::Failed;
use crate::passport::difference::NumberDifference;
use crate::passport::issue::time_of_issue;
use crate::report::issued::Told;
use crate::report::page::certification::CertificationPage;
use crate::report::recertification as report;
use crate::text::kind::mistaken;
use crate::text::{Identifier, Kind, name_of};
use clap::Args;
use jiff::Timestamp;
use jiff::civil::Date;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// Recertify a stand: check it against its certificate, issue a new one, and re-issue its passports in force
///
/// Everything is computed, signed and verified first; then all files are written, or none. The superseded stand file is
/// kept as stand-<certificate number>.superseded.yaml. If the stand has changed, nothing is written without --accept-change.
#[derive(Args)]
pub(super) struct Options {
    /// Passport of the stand, in force or expired; in a workspace also its identifier
    #[arg(value_name = "PASSPORT", value_parser = defaults::passport())]
    passport: PathBuf,
    /// Angles: CSV with the header i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec, and every position in every run
    #[arg(value_name = "READINGS.csv")]
    readings: PathBuf,
    /// Number of the new certificate
    #[arg(long, value_name = "N")]
    number: String,
    /// Date of issue of the new certificate
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    issued: Date,
    /// Date on which the readings were taken [default: that of --header]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    performed: Option<Date>,
    /// Site that gets a new passport: a site file, or the id of a site (repeatable) [default: every site with a passport
    /// in force in the folder of the passport]
    #[arg(long = "site", value_name = "SITE")]
    sites: Vec<PathBuf>,
    /// Reason for the re-issue, recorded in the passports
    #[arg(long, value_name = "TEXT")]
    reason: String,
    #[command(flatten)]
    issuer: IssuerOptions,
    #[command(flatten)]
    trust: TrustOptions,
    /// Header of the new certificate (dtg-stand/1 without angles) [default: that of the passport, without the dates and
    /// the temperature of its measurement]
    #[arg(long, value_name = "FILE")]
    header: Option<PathBuf>,
    /// Expiry date of the new certificate (inclusive) [default: that of --header]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    valid_until: Option<Date>,
    /// Time of issue of the passports, RFC 3339 [default: now]
    #[arg(long, value_name = "TIME", value_parser = trust_options::time)]
    issued_at: Option<Timestamp>,
    /// Folder of passports [default: the parent of <model>/<serial> in the path of the passport]
    #[arg(short, long, visible_aliases = ["passports", "output"], value_name = "DIR", value_parser = folder_of_passports())]
    out: Option<PathBuf>,
    /// Recertify a stand that has changed since its certificate; without it, the sites whose results are in question are
    /// listed, and nothing is written
    #[arg(long)]
    accept_change: bool,
    #[command(flatten)]
    exclusions: ExclusionOptions,
    #[command(flatten)]
    report: Report,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    _printed: Printed,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let cancel = interrupt::cancelled_by_ctrl_c()?;
    // Before the readings are read: exchanged arguments are then recognised by the file that is there.
    let expected = "a passport, which `issue` makes and signs";
    let name = name_of(&options.passport);
    let first = inputs::bytes(&options.passport, Kind::Passport.words())?;
    if let Some(other) = mistaken(&name, &first, expected, |kind| kind == Kind::Passport) {
        return Err(Failure::from(other));
    }
    let header = options.header.as_ref().map(|path| inputs::document(path, inputs::HEADER, Header::from_yaml));
    let (name, bytes) = (name_of(&options.readings), inputs::bytes(&options.readings, Kind::Angles.words())?);
    let sites = options.sites.iter().map(|path| at_site(path)).collect::<Result<Vec<_>, _>>()?;
    // Nothing is written if the record cannot be.
    files::check_replaceable(&options.report.path, options.force.replace)?;
    let excluded = options.exclusions.excluded()?;
    let issued_at = time_of_issue(options.issued_at, trust_options::now()).map_err(Failure::refused)?;
    // Before a passphrase is asked for.
    check(&options.number, options.issued, options.performed, options.valid_until).map_err(failure)?;
    let keys = options.issuer.keys(options.out.as_deref())?;
    keys.check_dry_run(&trust, issued_at)?;
    let dry_run = options.issuer.signing.dry_run;
    let record = RefCell::new(None);
    let print = |certification: &Certification, comparison: &Comparison, changes: &[NumberDifference]| {
        let Some(path) = &options.report.path else { return Ok(()) };
        let change = Some((comparison, changes.to_vec()));
        let page = CertificationPage { certification, readings: (&name, &bytes), change, dry_run };
        record.replace(Some((path, output::page(path, page.html(&languages()), options.force.replace)?)));
        Ok(())
    };
    let order = Recertification {
        passport: &options.passport,
        readings: (&name, &bytes),
        excluded: &excluded,
        header: header.transpose()?,
        number: &options.number,
        issued: options.issued,
        performed: options.performed,
        valid_until: options.valid_until,
        sites: &sites,
        reason: &options.reason,
        authority: keys.authority(&trust),
        issued_at,
        question,
        out: options.out.clone(),
        stands: stands(options),
        accept_change: options.accept_change,
        record: &print,
        cancel: Some(&cancel),
    };
    let found = order.run().map_err(failure)?;
    if let Some((path, page)) = record.take() {
        output::saved_too(path, page, options.force.replace)?;
    }
    output::show(|| report::to_json(&found, dry_run), || report::document(&found, dry_run))?;
    let mut told = Told::new(language());
    let issued = found.passports.iter().filter(|_| !found.refused);
    issued.filter_map(Outcome::remarks).for_each(|(id, remarks)| told.add_all(id, remarks));
    told.lines(output::is_quiet()).iter().for_each(|line| output::complain(line));
    if !found.refused {
        keys.say_without_register();
    }
    Ok(if found.refused { REFUSED } else { 0 })
}

fn failure(why: NotRecertified) -> Failure {
    match why {
        NotRecertified::Unreadable(error) => Failure::from(error),
        NotRecertified::Order(why) => Failure::usage(why),
        NotRecertified::Refused(_, ref findings) => Failed::refused(&why).because_of(findings.clone()).into(),
        why if why.is_unusable() => Failure::unusable(why),
        why => Failure::refused(why),
    }
}

/// Returns the folder of stand files, from which `issue` takes them, if the folder of passports is that of a workspace.
fn stands(options: &Options) -> Option<PathBuf> {
    let workspace = open_workspace::workspace().filter(|workspace| workspace.passports == options.out)?;
    workspace.stands.clone()
}

/// Returns the site of `--site`: the site file of that name, or else the id of a site.
fn at_site(path: &Path) -> Result<AtSite, Failure> {
    let id = path.to_str().filter(|id| !path.is_file() && Identifier::new(id).is_ok());
    match id {
        Some(id) => Ok(AtSite { id: id.to_owned(), site: None }),
        None => inputs::site(path).map(|site| AtSite { id: site.id.to_string(), site: Some(site) }),
    }
}
