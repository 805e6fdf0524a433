//! Verb `issue`: one passport for every stand at every site.

use super::batch::BatchOptions;
use super::options::{Instruments, folder_of_passports};
use super::{Code, Failure, defaults, inputs, open_workspace, output, trust_options};
use crate::batch::deliveries::{Deliveries, Placed};
use crate::batch::issue::Job;
use crate::passport::Stated;
use crate::passport::issue::{Issue, time_of_issue};
use clap::Args;
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::{Path, PathBuf};

/// Issue a signed passport for every stand at every site
///
/// STAND and SITE are files, quoted patterns, or folders. For a folder, STAND means every stand.yaml below it, and SITE
/// every *.yaml in it (also .yml). A - reads a list of paths from standard input, separated by line feeds or NUL.
#[derive(Args)]
#[command(mut_arg("gyro", |gyro| gyro.requires("accuracy")), mut_arg("laboratory", |laboratory| laboratory.requires("accuracy")))]
pub(super) struct Options {
    /// Stand files (dtg-stand/1); in a workspace also MODEL/SERIAL
    #[arg(required_unless_present = "deliveries", value_name = "STAND", value_parser = defaults::stand())]
    stands: Vec<PathBuf>,
    /// Site files (dtg-site/1; repeatable); in a workspace also the identifiers of sites
    #[arg(
        long = "site",
        required_unless_present = "deliveries",
        value_name = "SITE",
        value_parser = defaults::site()
    )]
    sites: Vec<PathBuf>,
    /// Instead of STAND and --site: a table of which stand goes where, one passport for each row. CSV with the columns stand,
    /// site and optionally valid_until, customer; names as in a workspace, or paths of files
    #[arg(long, value_name = "TABLE.csv", conflicts_with_all = ["stands", "sites"])]
    deliveries: Option<PathBuf>,
    /// Folder of passports
    #[arg(short, long, visible_aliases = ["passports", "output"], value_name = "DIR", value_parser = folder_of_passports(), default_value = "passports")]
    out: PathBuf,
    #[command(flatten)]
    batch: BatchOptions,
    /// Time of issue, RFC 3339 [default: now]
    #[arg(long, value_name = "TIME", value_parser = trust_options::time)]
    issued_at: Option<Timestamp>,
    /// Expiry date (inclusive), not later than that of the certificate [default: that of the certificate]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    valid_until: Option<Date>,
    /// Include the expected calibration uncertainty, for --gyro and --laboratory
    #[arg(long)]
    accuracy: bool,
    #[command(flatten)]
    instruments: Instruments,
    /// Believe existing passports and registers, and write new ones, only if they pass verification with this
    /// allowed_signers file [default: the own key]
    #[arg(long, help_heading = "Verification", value_name = "SIGNERS")]
    trust: Option<PathBuf>,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let list = Path::new("-");
    if options.stands.iter().chain(&options.sites).filter(|path| *path == list).count() > 1 {
        return Err(Failure::unusable("standard input can supply only one list, that of stands or that of sites"));
    }
    let now = trust_options::now();
    let issued_at = time_of_issue(options.issued_at, now).map_err(Failure::refused)?;
    let keys = options.batch.issuer.keys(Some(&options.out))?;
    let given = options.trust.as_deref().map(|path| trust_options::load(path, &[])).transpose()?;
    match (&keys.public, &given) {
        (Some(public), None) => options.batch.warn_of_other_identity(public, issued_at),
        (_, Some(trust)) => keys.check_dry_run(trust, issued_at)?,
        (None, None) => {}
    }
    let trust = given.map_or_else(|| keys.own_trust(), Ok)?;
    let order = Issue {
        valid_until: options.valid_until,
        accuracy: options.accuracy.then(|| stated(&options.instruments)).transpose()?,
        allow_uncalibratable: options.batch.allow_uncalibratable,
        ..Issue::first(options.batch.issuer.signing.identity(), issued_at)
    };
    let folder = options.batch.folder(&options.out);
    let placed = options.deliveries.as_deref().map(|path| placed(&inputs::deliveries(path)?)).transpose()?;
    let (stands, sites) = match &placed {
        Some(placed) => (&placed.stands, &placed.sites),
        None => (&options.stands, &options.sites),
    };
    let rows = placed.as_ref().map(|placed| &placed.rows);
    let job = Job { folder: &folder, stands, sites, order: &order, rows };
    options.batch.run(&keys, &trust, |batch, tell| {
        batch.issue(&job, &mut std::io::stdin().lock(), tell);
    })
}

/// Finds the files of the stands and sites of a table, by their names in the workspace or by their paths.
fn placed(deliveries: &Deliveries) -> Result<Placed, Failure> {
    let workspace = open_workspace::workspace();
    let stand = |name: &str| workspace.and_then(|workspace| workspace.stand(name)).unwrap_or_else(|| name.into());
    let site = |name: &str| workspace.and_then(|workspace| workspace.site(name)).unwrap_or_else(|| name.into());
    deliveries.placed(stand, site).map_err(|failures| {
        let (last, others) = failures.split_last().expect("a refusal has a reason");
        others.iter().for_each(|failed| output::complain(&Failure::input(failed).failed.message));
        Failure::input(last)
    })
}

/// Reads the gyro type and the laboratory for which the passports state the expected calibration uncertainty.
fn stated(instruments: &Instruments) -> Result<Stated, Failure> {
    Ok(Stated { gyro: instruments.gyro_or_usual()?, laboratory: instruments.laboratory()? })
}
