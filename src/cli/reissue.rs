//! Verb `reissue`: successors of existing passports.

use super::batch::BatchOptions;
use super::options::folder_of_passports;
use super::trust_options::{self, TrustOptions};
use super::{Code, Failure, defaults, inputs, open_workspace};
use crate::batch::successors::Change;
use crate::passport::issue::time_of_issue;
use crate::passport::reissue::Reissue;
use clap::Args;
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::{Path, PathBuf};

/// Verify passports and issue their successors: another site, corrected stands or sites, another key
///
/// PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input. For a folder, the
/// passports that the register of each stand lists as current are re-issued; with --stand only those of these stands,
/// and with a corrected site only those for it.
#[derive(Args)]
pub(super) struct Options {
    /// Predecessors; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    /// New or corrected site [default: in a workspace its file of the predecessor's site, else the predecessor's site];
    /// in a workspace also its identifier
    #[arg(long, value_name = "SITE", value_parser = defaults::site())]
    site: Option<PathBuf>,
    /// Site files, each for the passports of that site: files, folders, patterns (repeatable)
    #[arg(long = "sites", value_name = "SITE", conflicts_with_all = ["site", "moved"], value_parser = defaults::site())]
    sites: Vec<PathBuf>,
    /// Corrected stand files, each for the passports of that stand: files, folders, patterns (repeatable) [default:
    /// that of the predecessor]
    #[arg(long = "stand", value_name = "STAND", value_parser = defaults::stand())]
    stands: Vec<PathBuf>,
    /// The stand has left the previous site; supersede the predecessor
    #[arg(long)]
    moved: bool,
    /// Issue a successor even if stand, site, issuer and expiry date stay the same, for example to sign with a new key
    #[arg(long)]
    same_content: bool,
    /// Reason for the re-issue, recorded in the passport
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of passports [default: the parent of <model>/<serial> in the path of each predecessor]
    #[arg(short, long, visible_aliases = ["passports", "output"], value_name = "DIR", value_parser = folder_of_passports())]
    out: Option<PathBuf>,
    #[command(flatten)]
    batch: BatchOptions,
    #[command(flatten)]
    trust: TrustOptions,
    /// Time of issue, RFC 3339 [default: now]
    #[arg(long, value_name = "TIME", value_parser = trust_options::time)]
    issued_at: Option<Timestamp>,
    /// Expiry date (inclusive), not later than that of the certificate [default: that of the predecessor, or of the
    /// certificate of a new stand]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    valid_until: Option<Date>,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let list = Path::new("-");
    let lists = options.passports.iter().filter(|path| *path == list).count();
    if lists > 1 || options.stands.iter().chain(&options.sites).any(|path| path == list) {
        return Err(Failure::unusable("standard input can supply only the list of passports"));
    }
    let (trust, question) = options.trust.load()?;
    let issued_at = time_of_issue(options.issued_at, trust_options::now()).map_err(Failure::refused)?;
    let order = Reissue {
        site: options.site.as_deref().map(inputs::site).transpose()?,
        moved: options.moved,
        valid_until: options.valid_until,
        allow_uncalibratable: options.batch.allow_uncalibratable,
        same_content: options.same_content,
        ..Reissue::new(options.batch.issuer.signing.identity(), issued_at, &options.reason)
    };
    let keys = options.batch.issuer.keys(options.out.as_deref())?;
    if let Some(public) = &keys.public {
        options.batch.warn_unless_authorised(&trust.signers, public, order.issued_at, "--trust");
    }
    let folder = options.out.clone();
    let site_file = |id: &str| open_workspace::workspace()?.site(id).filter(|path| path.exists());
    let change = Change { order, stands: &options.stands, sites: &options.sites, site_file, question, folder };
    options.batch.run(&keys, &trust, |batch, tell| {
        batch.reissue(&options.passports, &mut std::io::stdin().lock(), change, tell);
    })
}
