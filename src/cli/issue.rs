//! `issue`: one passport for every stand at every site.

use super::calibrate::read_laboratory;
use super::key_options::KeyOptions;
use super::output::{Format, code_of};
use super::simulate::read_gyro;
use super::{Code, Failure, UNUSABLE, output, trust_options};
use clap::Args;
use dtg_passport::files;
use dtg_passport::folder::{Folder, Issued, Seal};
use dtg_passport::gyro::GyroType;
use dtg_passport::passport::accuracy::Stated;
use dtg_passport::passport::issue::Issue;
use dtg_passport::report::issued;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::{Path, PathBuf};

/// Issue a signed passport for every stand at every site
#[derive(Args)]
pub struct Options {
    /// Stand files (dtg-stand/1)
    #[arg(required = true, value_name = "STAND")]
    stands: Vec<PathBuf>,
    /// Site file (dtg-site/1; repeatable)
    #[arg(long = "site", required = true, value_name = "SITE")]
    sites: Vec<PathBuf>,
    #[command(flatten)]
    key: KeyOptions,
    /// Folder of the passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    out: PathBuf,
    /// Time of issue, RFC 3339 [default: now]
    #[arg(long, value_name = "TIME", value_parser = trust_options::time)]
    issued_at: Option<Timestamp>,
    /// Last day of the passport [default: the certificate's]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    valid_until: Option<Date>,
    /// State in the passport what the stand is good for
    #[arg(long)]
    accuracy: bool,
    /// For this type of gyro (dtg-gyro/1) [default: the paper's GVK-6]
    #[arg(long, value_name = "FILE", requires = "accuracy")]
    gyro: Option<PathBuf>,
    /// In this laboratory (dtg-laboratory/1) [default: the paper's meter, 0.015 %]
    #[arg(long, value_name = "FILE", requires = "accuracy")]
    laboratory: Option<PathBuf>,
    /// Write only what would verify by this allowed_signers
    #[arg(long, value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let mut code = 0;
    let (stands, sites) = read_inputs(options, &mut code);
    let signer = options.key.signer()?;
    let now = trust_options::now();
    let trust = options.trust.as_deref().map(|path| trust_options::load(path, &[], now)).transpose()?;
    let seal = Seal { signer: signer.as_ref(), trust: trust.as_ref() };
    let issued_at = options.issued_at.unwrap_or(now);
    let order = Issue {
        valid_until: options.valid_until,
        accuracy: options.accuracy.then(|| stated(options)).transpose()?,
        ..Issue::first(&options.key.identity, issued_at, GyroType::gvk_6().nominal)
    };
    let folder = Folder::new(&options.out);
    let mut reports = Vec::new();
    for stand in &stands {
        for site in &sites {
            match folder.issue(stand, site, &order, seal) {
                Ok(issued) => reports.push(report(&issued)),
                Err(refused) => {
                    code = code.max(code_of(&refused));
                    let id = format!("{}/{}/{}/1", stand.stand.model, stand.stand.serial, site.id);
                    output::say(&format!("{id}: {refused}"));
                    reports.push(issued::Report::refused(id, refused.to_string()));
                }
            }
        }
    }
    print(&reports, options.format)?;
    Ok(code)
}

/// For whom the passports state what the stand is good for.
fn stated(options: &Options) -> Result<Stated, Failure> {
    let gyro = read_gyro(options.gyro.as_deref())?.unwrap_or_else(GyroType::gvk_6);
    let laboratory = read_laboratory(options.laboratory.as_deref())?;
    Ok(Stated { gyro: gyro.into(), laboratory: laboratory.into() })
}

/// Reads all inputs first, so that every mistake is reported before anything is signed.
fn read_inputs(options: &Options, code: &mut Code) -> (Vec<Stand>, Vec<Site>) {
    let stands = options.stands.iter().filter_map(|path| keep(read_stand(path), code)).collect();
    let sites = options.sites.iter().filter_map(|path| keep(read_site(path), code)).collect();
    (stands, sites)
}

fn keep<T>(result: Result<T, Failure>, code: &mut Code) -> Option<T> {
    result
        .map_err(|failure| {
            output::say(&failure.message);
            *code = UNUSABLE;
        })
        .ok()
}

/// Reads a stand file.
pub fn read_stand(path: &Path) -> Result<Stand, Failure> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::unusable)?;
    Stand::from_yaml(&path.display().to_string(), &bytes).map_err(Failure::unusable)
}

/// Reads a site file.
pub fn read_site(path: &Path) -> Result<Site, Failure> {
    let bytes = files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::unusable)?;
    let site = Site::from_yaml(&path.display().to_string(), &bytes).map_err(Failure::unusable)?;
    if path.file_stem().is_some_and(|stem| stem != site.id.as_str()) {
        output::say(&format!("{}: the file's name is not its id, {}", path.display(), site.id));
    }
    Ok(site)
}

/// Says what the factory should know, and gives the report.
pub fn report(issued: &Issued) -> issued::Report {
    // An equal passport that is there already was remarked upon when it was issued.
    for warning in issued::warnings(&issued.remarks).into_iter().filter(|_| issued.new) {
        output::say(&format!("{}: {warning}", issued.id));
    }
    issued::Report::of(issued)
}

/// Prints what became of every order.
pub fn print(reports: &[issued::Report], format: Format) -> Result<(), Failure> {
    match format {
        Format::Json => output::json(&reports),
        Format::Text => output::result(&issued::text(reports)),
    }
}
