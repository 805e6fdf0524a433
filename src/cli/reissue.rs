//! `reissue`: a new passport from an old one.

use super::issue::{print, read_site, read_stand, report};
use super::key_options::KeyOptions;
use super::output::{Format, code_of};
use super::trust_options::{self, TrustOptions};
use super::{Code, Failure, REFUSED, UNUSABLE, output};
use clap::Args;
use dtg_passport::files;
use dtg_passport::folder::{Folder, Seal};
use dtg_passport::passport::reissue::{Order, ReissueRefused, successor};
use dtg_passport::passport::verify;
use dtg_passport::report::issued;
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::PathBuf;

/// Verify a passport and issue its successor: another site, a corrected stand or site, another key
#[derive(Args)]
pub struct Options {
    /// The old passports
    #[arg(required = true, value_name = "PASSPORT")]
    passports: Vec<PathBuf>,
    /// The new or corrected site [default: the old passport's]
    #[arg(long, value_name = "SITE")]
    site: Option<PathBuf>,
    /// The corrected stand [default: the old passport's]
    #[arg(long, value_name = "STAND")]
    stand: Option<PathBuf>,
    /// The stand has left the old site: the old passport is superseded
    #[arg(long)]
    moved: bool,
    /// Why there is a new passport
    #[arg(long, value_name = "TEXT")]
    reason: String,
    #[command(flatten)]
    key: KeyOptions,
    #[command(flatten)]
    trust: TrustOptions,
    /// Folder of the passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    out: PathBuf,
    /// Time of issue, RFC 3339 [default: now]
    #[arg(long, value_name = "TIME", value_parser = trust_options::time)]
    issued_at: Option<Timestamp>,
    /// Last day of the passport [default: the old passport's, or a new stand's certificate's]
    #[arg(long, value_name = "DATE", value_parser = trust_options::date)]
    valid_until: Option<Date>,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let order = Order {
        stand: options.stand.as_deref().map(read_stand).transpose()?,
        site: options.site.as_deref().map(read_site).transpose()?,
        moved: options.moved,
        reason: options.reason.clone(),
        issuer: options.key.identity.clone(),
        issued_at: options.issued_at.unwrap_or_else(trust_options::now),
        valid_until: options.valid_until,
    };
    let signer = options.key.signer()?;
    let seal = Seal { signer: signer.as_ref(), trust: None };
    let folder = Folder::new(&options.out);
    let mut code = 0;
    let mut reports = Vec::new();
    for path in &options.passports {
        let name = path.display().to_string();
        let mut refuse = |refused_code: Code, reason: String| {
            code = code.max(refused_code);
            // A file that cannot be read is named by the reason itself.
            let named = reason.starts_with(&format!("{name}: "));
            output::say(&if named { reason.clone() } else { format!("{name}: {reason}") });
            reports.push(issued::Report::refused(name.clone(), reason));
        };
        let bytes = match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                refuse(UNUSABLE, error.to_string());
                continue;
            }
        };
        let verification = verify(&name, &bytes, &trust, &question);
        match successor(&bytes, &verification, &order) {
            Err(refused @ ReissueRefused::BadReason) => refuse(UNUSABLE, refused.to_string()),
            Err(refused) => refuse(REFUSED, refused.to_string()),
            Ok(successor) => match folder.reissue(&successor, seal) {
                Err(refused) => refuse(code_of(&refused), refused.to_string()),
                Ok(issued) => reports.push(report(&issued)),
            },
        }
    }
    print(&reports, options.format)?;
    Ok(code)
}
