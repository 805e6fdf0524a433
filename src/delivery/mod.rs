//! What a laboratory gets, in one file: the passports of its stands that are in force, their registers, the public keys that
//! signed them, and a page that says what to do first. The fingerprints of the keys go by another way.
//!
//! * `archive`: the file, from anyone, and the names in it.
//! * `received`: what is in it, verified and laid into a workspace.

mod archive;
mod received;

pub(crate) use archive::LARGEST_ARCHIVE_BYTES;
pub(crate) use received::{NotReceived, Order, receive};

use crate::files::{self, FileError};
use crate::folder::{Folder, Memory, Registers};
use crate::passport::{Question, Trust, Verification, verify};
use crate::register::{Entry, FILE_NAME, RegisterRefused, State};
use crate::report::Languages;
use crate::report::doc::{Block, Words, given, line, listed, marked};
use crate::report::page::instructions::instructions;
use crate::text::scalar::identifiers;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of as shown_name};
use crate::trust::PublicKey;
use crate::wording::Language;
use crate::wording::texts::delivery as texts;
use archive::{BadArchive, name_of};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Stand, or one site of it, whose passports are handed over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Wanted {
    pub stand: String,
    pub site: Option<String>,
}

impl Wanted {
    /// Returns the path of its archive in a folder of archives.
    pub(crate) fn path_in(&self, folder: &Path) -> PathBuf {
        folder.join(&self.stand).join(format!("{}.zip", self.site.as_deref().unwrap_or("all")))
    }
}

impl std::str::FromStr for Wanted {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match (identifiers::<2>(text), identifiers(text)) {
            (Some(_), _) => Ok(Self { stand: text.to_owned(), site: None }),
            (_, Some([model, serial, site])) => {
                Ok(Self { stand: format!("{model}/{serial}"), site: Some(site.to_owned()) })
            }
            _ => Err("expected MODEL/SERIAL or MODEL/SERIAL/SITE, such as SPS-2/0017/moscow-bmstu"),
        }
    }
}

/// Passport in a delivery.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Delivered {
    pub id: String,
    pub sha256: String,
}

/// Key that signed something in a delivery.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Signer {
    pub principal: String,
    pub fingerprint: String,
}

/// Delivery to one laboratory.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Delivery {
    pub passports: Vec<Delivered>,
    pub keys: Vec<Signer>,
    #[serde(skip)]
    pub archive: Vec<u8>,
}

/// Reason why nothing is handed over.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotDelivered {
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Register(#[from] RegisterRefused),
    #[error("{0}: no passport is in force{1}; issue one, or specify another site")]
    None(String, String),
    /// Passport that may not be used, by this verification of the file of this name.
    #[error("{0}: may not be used")]
    NotValid(String, Box<Verification>),
    #[error("the archive would be refused, because it {0}")]
    Archive(#[from] BadArchive),
}

/// Returns the delivery of what is `wanted` from the folder of passports `root`, with a page in all languages, `first` first.
///
/// # Errors
/// Returns [`NotDelivered`] if a register is not accepted or not fresh, or if a passport is not in force.
pub(crate) fn deliver(
    root: &Path,
    wanted: &[Wanted],
    (trust, question): (&Trust, &Question),
    memory: Option<Memory>,
    first: Language,
) -> Result<Delivery, NotDelivered> {
    let registers = Registers::new(root, trust.clone(), question.now, memory);
    let (mut files, mut keys) = (BTreeMap::new(), BTreeMap::new());
    let mut passports = Vec::new();
    for Wanted { stand, site } in wanted {
        let found = registers.of(stand)?;
        let register = &found.register;
        let is_wanted = |entry: &&Entry| site.as_ref().is_none_or(|site| entry.site_and_revision().0 == site);
        let entries: Vec<&Entry> = register.entries().iter().filter(is_wanted).collect();
        let mut current = entries.iter().filter(|entry| entry.state == State::Current).peekable();
        if current.peek().is_none() {
            let last = entries.last().map(|entry| format!(" ({} is {})", entry.id, entry.state.key()));
            let name = site.as_ref().map_or_else(|| stand.clone(), |site| format!("{stand}/{site}"));
            return Err(NotDelivered::None(name, last.unwrap_or_default()));
        }
        for entry in current {
            let path = Folder::new(root).path_of_id(&entry.id).unwrap_or_default();
            let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES)?;
            let name = shown_name(&path);
            let verification = registers.asked(verify(&name, &bytes, trust, question), question);
            let Some(passport) = verification.passport() else {
                return Err(NotDelivered::NotValid(name, Box::new(verification)));
            };
            let issuer = &passport.content().passport.issuer;
            keys.insert((issuer.clone(), passport.key().fingerprint()), passport.key().clone());
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            if files.insert(name_of(stand, &file), bytes).is_none() {
                passports.push(Delivered { id: entry.id.clone(), sha256: entry.sha256.clone() });
            }
        }
        let (issuer, key) = (&register.header().issuer, register.key());
        keys.insert((issuer.clone(), key.fingerprint()), key.clone());
        let (path, bytes) = registers.bytes_of(stand)?;
        if crate::document::sha256_hex(&bytes) != register.sha256() {
            let why = format!("{}: was replaced meanwhile; run the command again", shown_name(&path));
            return Err(RegisterRefused::Unreadable(why).into());
        }
        files.insert(name_of(stand, FILE_NAME), bytes);
    }
    let languages = Languages::new(first, Language::ALL);
    let page = instructions(passports.iter().map(|passport| passport.id.as_str()), &languages);
    let mut members = vec![(archive::PAGE.to_owned(), page.into_bytes())];
    let line = |((principal, _), key): (&(String, String), &PublicKey)| format!("{} {principal}\n", key.to_openssh());
    members.push((archive::KEYS.to_owned(), keys.iter().map(line).collect::<String>().into_bytes()));
    members.extend(files);
    let archive = archive::write(&members)?;
    let keys = keys.into_keys().map(|(principal, fingerprint)| Signer { principal, fingerprint }).collect();
    Ok(Delivery { passports, keys, archive })
}

impl Delivery {
    /// Returns what is handed over in the file of this name, and the fingerprints that go by another way.
    pub(crate) fn document(&self, name: &str) -> Vec<Block> {
        let mut lines = passports(&self.passports);
        lines.extend(keys(&self.keys));
        vec![line(marked(Some(true), texts::delivered(given(name)))), Block::Whole("", lines), line(texts::TELL)]
    }

    /// Returns what is handed over in the file of this name as one line.
    pub(crate) fn row(&self, name: &str) -> Vec<Block> {
        let ids = listed(self.passports.iter().map(|passport| given(&passport.id)));
        let words = vec![texts::delivered(given(name)), "  ".into(), ids];
        vec![Block::Whole("", vec![vec![marked(Some(true), words)]])]
    }
}

/// Returns the fingerprints that go by another way.
pub(crate) fn tell(of: &[Signer]) -> Vec<Block> {
    vec![Block::Whole("", keys(of).collect()), line(texts::TELL)]
}

fn passports(all: &[Delivered]) -> Vec<Vec<Words>> {
    all.iter().map(|passport| vec![texts::PASSPORT.into(), given(&passport.id)]).collect()
}

fn keys(all: &[Signer]) -> impl Iterator<Item = Vec<Words>> {
    let words = |key: &Signer| Words::All(vec![given(&key.principal), "  ".into(), given(&key.fingerprint)]);
    all.iter().map(move |key| vec![texts::KEY.into(), words(key)])
}
