//! Verb `revoke`: withdrawal of passports.

use super::key_options::KeyOptions;
use super::trust_options::{TrustOptions, now};
use super::{Code, Failure, output};
use crate::files::{self, Access};
use crate::folder::Folder;
use crate::folder::search::{self, NoNewestList};
use crate::passport::verify;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of, shown};
use clap::Args;
use std::path::{Path, PathBuf};

/// Withdraw passports: add them to the signed list in a folder
#[derive(Args)]
pub(super) struct Options {
    /// Identifiers (model/serial/site/revision, looked up in --passports) or files
    #[arg(required = true, value_name = "PASSPORT-ID")]
    ids: Vec<String>,
    /// Reason, recorded in the list
    #[arg(long, value_name = "TEXT")]
    reason: String,
    /// Folder of revocation lists; the newest list is extended
    #[arg(long, value_name = "FOLDER")]
    list: PathBuf,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    #[command(flatten)]
    key: KeyOptions,
    #[command(flatten)]
    trust: TrustOptions,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let lists = search::lists(&options.list, &trust, question.time).map_err(|error| match error {
        NoNewestList::File(error) => Failure::unusable(error),
        refused => Failure::refused(refused),
    })?;
    let mut entries = Vec::new();
    for id in &options.ids {
        let path = file_of(id, &options.passports);
        let bytes = read(&path)?;
        let verification = verify(&name_of(&path), &bytes, &trust, &question);
        entries.push(verification.withdrawal(&bytes, now(), &options.reason).map_err(|failed| {
            let words = failed.map_or("", |check| &check.detail);
            Failure::refused(format!("{}: cannot be withdrawn: {words}", shown(&path)))
        })?);
    }
    let count = lists.count() + entries.len();
    let list = lists.following(&options.key.identity, now(), entries).map_err(Failure::refused)?;
    let signer = options.key.signer()?;
    let path = options.list.join(list.file_name());
    let text = list.sign_for(&name_of(&path), signer.as_ref(), &trust.signers, &trust.revoked);
    let text = text.map_err(Failure::refused)?;
    files::write_new(&path, text.as_bytes(), Access::Shared).map_err(Failure::file)?;
    output::result(&format!("revoked    passports in all: {}  {}\n", count, shown(&path)))?;
    Ok(0)
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    files::read(path, LARGEST_DOCUMENT_BYTES).map_err(Failure::unusable)
}

/// Returns the file of an id in `passports`, or `id` itself as a path if it is not an id or if only that file exists.
fn file_of(id: &str, passports: &Path) -> PathBuf {
    match Folder::new(passports).path_of_id(id) {
        Some(path) if path.exists() || !Path::new(id).exists() => path,
        _ => PathBuf::from(id),
    }
}
