//! A delivery as it is received: everything is verified before anything is believed, and written only then.

use super::archive::{self, Member, name_of};
use super::{Delivered, Signer, keys, passports};
use crate::document::SignedText;
use crate::files::{self, FileError, together};
use crate::folder::registers::{self, doubt};
use crate::folder::{Folder, FolderRefused};
use crate::passport::{self, Question, Trust, Verification, verify};
use crate::register::{self, Doubt, FILE_NAME, FORM, Register, VerifiedRegister};
use crate::report::doc::{Block, Words, code, given, line, listed, marked};
use crate::report::{Languages, PassportPage};
use crate::signing::append_line;
use crate::text::{LARGEST_DOCUMENT_BYTES, name_of as shown_name, printable, shown};
use crate::trust::{AllowedSigners, LARGEST_TRUST_FILE_BYTES, NotAuthorised, PublicKey, check_identity};
use crate::wording::texts::delivery as texts;
use crate::workspace::{Kind, WORKSPACE_FILE, Workspace, make};
use jiff::Timestamp;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Folder of a workspace with the printed passports.
const PAGES: &str = "pages";

/// What an archive has for one stand.
#[derive(Debug, Default)]
struct Lot {
    register: Vec<u8>,
    /// Passports by the names of their files.
    passports: BTreeMap<String, Vec<u8>>,
}

/// Key, and the last time at which it signed for each namespace.
type Signed = (PublicKey, BTreeMap<&'static str, Timestamp>);

/// Archive that was read; nothing in it is believed yet.
#[derive(Debug)]
struct Parcel {
    stands: BTreeMap<String, Lot>,
    /// Keys by principal and fingerprint.
    signers: BTreeMap<(String, String), Signed>,
}

/// Key that a workspace does not trust yet for its principal. A person has to confirm its fingerprint, which is not to be
/// shown before that.
#[derive(Debug)]
struct NewKey {
    principal: String,
    fingerprint: String,
    /// `true` if the workspace trusts another key of this principal, or this one for other documents.
    is_another: bool,
    line: String,
}

/// What was received.
#[derive(Debug, Serialize)]
pub(crate) struct Received {
    pub workspace: String,
    /// `true` if the workspace was made.
    #[serde(rename = "made")]
    pub is_new: bool,
    /// Stands that the workspace does not state.
    #[serde(skip)]
    unknown: Vec<String>,
    pub stands: Vec<String>,
    pub passports: Vec<Delivered>,
    /// Keys that are trusted from now on.
    pub keys: Vec<Signer>,
    pub pages: Vec<String>,
}

/// Reason why nothing is received.
#[derive(Debug)]
pub(crate) enum NotReceived {
    /// Archive, document or workspace that is refused, and why, in words.
    Refused(String),
    /// Passport that may not be used, by this verification of the file of this name.
    NotValid(String, Box<Verification>),
}

impl<E: std::error::Error> From<E> for NotReceived {
    fn from(error: E) -> Self {
        refused(error)
    }
}

fn refused(why: impl Display) -> NotReceived {
    NotReceived::Refused(why.to_string())
}

fn not_stated(key: &str) -> NotReceived {
    refused(format!("the workspace states no {key} in dtg-passport.toml"))
}

impl Parcel {
    /// Reads an archive from anyone, and the keys that signed what is in it.
    ///
    /// # Errors
    /// Returns [`NotReceived`] for an archive or a document that is damaged, or that no delivery has.
    fn open(bytes: &[u8], now: Timestamp) -> Result<Self, NotReceived> {
        let mut parcel = Self { stands: BTreeMap::new(), signers: BTreeMap::new() };
        let nobody = Trust::of(AllowedSigners::default());
        for (member, bytes) in archive::read(bytes)? {
            match member {
                Member::Other => {}
                Member::Register(stand) => {
                    let name = name_of(&stand, FILE_NAME);
                    let text = SignedText::split(&name, &bytes, &FORM).map_err(|malformed| refused(malformed.fault))?;
                    text.signed_payload(None, None).map_err(|error| refused(format!("{name}: {error}")))?;
                    let content = Register::from_anyone(&name, &bytes)?;
                    let header = content.header();
                    parcel.note(&header.issuer, text.key(), register::REGISTER_NAMESPACE, header.issued_at);
                    parcel.stands.entry(stand).or_default().register = bytes;
                }
                Member::Passport(stand, file) => {
                    let name = name_of(&stand, &file);
                    let verification = verify(&name, &bytes, &nobody, &Question::at(now));
                    let (content, key) = (verification.content_from_anyone(), verification.key_from_anyone());
                    let Some((content, key)) = content.zip(key) else {
                        // These checks come before that of the key, so they show no fingerprint.
                        return Err(refused(format!("{name}: {}", verification.why())));
                    };
                    let header = &content.passport;
                    parcel.note(&header.issuer, key, passport::NAMESPACE, header.issued_at);
                    parcel.stands.entry(stand).or_default().passports.insert(file, bytes);
                }
            }
        }
        if parcel.stands.is_empty() {
            return Err(refused("it has no passport"));
        }
        match parcel.stands.iter().find(|(_, lot)| lot.register.is_empty() || lot.passports.is_empty()) {
            Some((stand, _)) => Err(refused(format!(
                "it has no register for the passports of {stand}, or no passport for the register"
            ))),
            None => Ok(parcel),
        }
    }

    fn note(&mut self, issuer: &str, key: &PublicKey, namespace: &'static str, at: Timestamp) {
        let signer = self.signers.entry((issuer.to_owned(), key.fingerprint()));
        let times = &mut signer.or_insert_with(|| (key.clone(), BTreeMap::new())).1;
        let last = times.entry(namespace).or_insert(at);
        *last = at.max(*last);
    }

    /// Returns the keys that `signers` does not give to their principals, each with the line that would.
    ///
    /// # Errors
    /// Returns [`NotReceived`] if a principal could be read as a pattern of several.
    fn new_keys(&self, signers: &AllowedSigners) -> Result<Vec<NewKey>, NotReceived> {
        let mut new = Vec::new();
        for ((principal, fingerprint), (key, times)) in &self.signers {
            let lacks = |(namespace, at): (&&'static str, &Timestamp)| match signers
                .authorise(key, principal, namespace, *at)
            {
                // A validity period is a decision of the laboratory, which the check of the document explains.
                Ok(()) | Err(NotAuthorised::NotYetValid(_) | NotAuthorised::Expired(_)) => None,
                Err(_) => Some(*namespace),
            };
            let lacking: Vec<&str> = times.iter().filter_map(lacks).collect();
            if lacking.is_empty() {
                continue;
            }
            check_identity(principal)
                .map_err(|error| refused(format!("its issuer cannot be trusted by name: {error}")))?;
            let line = format!("{principal} namespaces=\"{}\" {}", lacking.join(","), key.to_openssh());
            let (principal, fingerprint) = (principal.clone(), fingerprint.clone());
            new.push(NewKey { is_another: signers.knows(&principal), principal, fingerprint, line });
        }
        Ok(new)
    }

    /// Checks that a person gave the fingerprint of every key of `new`, and no other; with `may_replace` also those of
    /// further keys of a principal.
    ///
    /// # Errors
    /// Returns [`NotReceived`] without any fingerprint but those that were given.
    fn confirm(&self, new: &[NewKey], given: &[String], may_replace: bool) -> Result<(), NotReceived> {
        let signed: BTreeSet<&str> = self.signers.keys().map(|(_, fingerprint)| fingerprint.as_str()).collect();
        if let Some(other) = given.iter().find(|given| !signed.contains(given.as_str())) {
            let other = printable(other);
            return Err(refused(format!(
                "no key that signed it has the fingerprint {other}; if the factory told you this one, the archive is not \
                 from it"
            )));
        }
        for NewKey { principal, fingerprint, is_another, .. } in new {
            if *is_another && !may_replace {
                return Err(refused(format!(
                    "this workspace trusts another key of {principal}; if the factory told you that it has a new one, give \
                     --new-key too"
                )));
            }
            if !given.contains(fingerprint) {
                return Err(refused(format!(
                    "this workspace does not trust the key that signed for {principal} yet; ask the factory for the \
                     fingerprint by another way, not by this archive, and give it with --fingerprint SHA256:…"
                )));
            }
        }
        Ok(())
    }

    /// Verifies everything for a workspace by `trust`, which has the keys that a person confirmed.
    ///
    /// # Errors
    /// Returns [`NotReceived`] if a passport may not be used, or if a register is older than the last one accepted or
    /// contradicts it.
    fn verified(
        &self,
        workspace: &Workspace,
        trust: &Trust,
        question: &Question,
    ) -> Result<Vec<Good<'_>>, NotReceived> {
        let root = workspace.passports.as_deref().ok_or(not_stated("passports"))?;
        let mut passports = Vec::new();
        for (stand, lot) in &self.stands {
            let name = name_of(stand, FILE_NAME);
            let register = VerifiedRegister::verify(&name, &lot.register, trust, question.now)?;
            let header = register.header();
            if header.stand != *stand {
                return Err(refused(format!("{name}: is of another stand, {}", header.stand)));
            }
            // What lies there was perhaps never asked, and so is not remembered.
            let there = registers::read(&root.join(stand).join(FILE_NAME), trust, question.now).ok();
            let remembered = workspace.memory().last(stand, trust, question.now)?.0;
            for last in remembered.into_iter().chain(there) {
                match doubt(&register, &last) {
                    None => {}
                    Some(Doubt::Older(last)) => {
                        return Err(refused(format!(
                            "register {} of {stand} is older than {last}, the last one accepted; get the last delivery from \
                             the factory",
                            header.sequence
                        )));
                    }
                    Some(doubt) => return Err(refused(doubt)),
                }
            }
            for (file, bytes) in &lot.passports {
                let name = name_of(stand, file);
                let verification = verify(&name, bytes, trust, question).with_register(Ok((&register, None)), question);
                let Some(passport) = verification.passport() else {
                    return Err(NotReceived::NotValid(name, Box::new(verification)));
                };
                let id = passport.content().passport.id.clone();
                let path = Folder::new(root).path_of_id(&id).unwrap_or_default();
                if path != root.join(stand).join(file) {
                    return Err(refused(format!("{name}: is of another stand, {id}")));
                }
                passports.push(Good { id, path, bytes, verification });
            }
        }
        Ok(passports)
    }
}

/// Passport that may be used.
struct Good<'a> {
    id: String,
    path: PathBuf,
    bytes: &'a [u8],
    verification: Verification,
}

/// Where a delivery goes, and what a person says of it.
pub(crate) struct Order<'a> {
    /// Folder of a laboratory's workspace, which is made if there is none.
    pub root: &'a Path,
    /// Fingerprints that a person gave.
    pub given: &'a [String],
    /// Asks a person for the fingerprint of a principal's key; `None` where nobody can be asked.
    pub ask: &'a dyn Fn(&str) -> Option<String>,
    /// `true` if a principal may have a further key.
    pub may_replace: bool,
    pub languages: &'a Languages,
    pub now: Timestamp,
}

/// Lays the delivery in `bytes` into a workspace: passports, registers, lines of the new keys, and pages that are made anew.
///
/// # Errors
/// Returns [`NotReceived`]; nothing is then written.
pub(crate) fn receive(bytes: &[u8], order: &Order) -> Result<Received, NotReceived> {
    let parcel = Parcel::open(bytes, order.now)?;
    let stands: Vec<String> = parcel.stands.keys().cloned().collect();
    let is_there = order.root.join(WORKSPACE_FILE).symlink_metadata().is_ok();
    let workspace = match is_there {
        true => Workspace::read(order.root)?,
        false => Workspace::of_a_new_laboratory(order.root, &stands)?,
    };
    if !workspace.is_of_a_laboratory() {
        let root = shown(order.root);
        return Err(refused(format!("{root}: is the workspace of a factory; give the folder of a laboratory's")));
    }
    let path = workspace.trust.clone().ok_or(not_stated("trust"))?;
    let (mut text, known) = match files::read(&path, LARGEST_TRUST_FILE_BYTES) {
        Err(error) if error.is_missing() => (Vec::new(), AllowedSigners::default()),
        read => {
            let text = read?;
            let known = AllowedSigners::parse(&shown_name(&path), &text)?;
            (text, known)
        }
    };
    let new = parcel.new_keys(&known)?;
    let mut given = order.given.to_owned();
    let to_ask = new.iter().filter(|key| (!key.is_another || order.may_replace) && !given.contains(&key.fingerprint));
    let typed: Vec<String> = to_ask.filter_map(|key| (order.ask)(&key.principal)).collect();
    given.extend(typed);
    parcel.confirm(&new, &given, order.may_replace)?;
    new.iter().for_each(|key| append_line(&mut text, &key.line));
    let trust = Trust::of(AllowedSigners::parse(&shown_name(&path), &text)?);
    let question = Question::at(order.now);
    let good = parcel.verified(&workspace, &trust, &question)?;
    let mut files = Files::default();
    let root = workspace.passports.as_deref().unwrap_or(order.root);
    let (folder, workspace_folder) = (Folder::new(root), Folder::new(order.root));
    let (mut passports, mut pages) = (Vec::new(), Vec::new());
    for Good { id, path, bytes, verification } in good {
        let below = path.strip_prefix(root).unwrap_or(&path);
        let place = order.root.join(PAGES).join(below).with_extension("html");
        folder.check_place(&path)?;
        match files::read(&path, LARGEST_DOCUMENT_BYTES) {
            Ok(there) if there == bytes => {}
            Err(error) if error.is_missing() => files.new.push((path, bytes.to_owned())),
            Err(error) => return Err(error.into()),
            Ok(_) => return Err(FileError::Exists { path, replaceable: false }.into()),
        }
        let sha256 = verification.sha256().to_owned();
        let page = PassportPage::of(bytes, &question, verification);
        let page = page.map_err(|verification| NotReceived::NotValid(id.clone(), verification))?;
        pages.push(shown_name(&place));
        files.replace(&workspace_folder, place, page.html(order.languages).into_bytes())?;
        passports.push(Delivered { id, sha256 });
    }
    for (stand, lot) in &parcel.stands {
        files.replace(&workspace_folder, workspace.memory().path_of(stand), lot.register.clone())?;
        files.replace(&folder, root.join(stand).join(FILE_NAME), lot.register.clone())?;
    }
    if !new.is_empty() {
        if path.is_symlink() {
            return Err(FolderRefused::Link(path).into());
        }
        files.last.push((path, text));
    }
    if !is_there {
        make(order.root, &Kind::Laboratory(&stands), false)?;
    }
    together::write_together(&files.new, &files.last)?;
    let signer = |key: NewKey| Signer { principal: key.principal, fingerprint: key.fingerprint };
    let keys = new.into_iter().map(signer).collect();
    let unknown = stands.iter().filter(|stand| !workspace.stand.contains(stand)).cloned().collect();
    Ok(Received { workspace: shown_name(order.root), is_new: !is_there, unknown, stands, passports, keys, pages })
}

/// Files to be written together.
#[derive(Default)]
struct Files {
    new: Vec<(PathBuf, Vec<u8>)>,
    last: Vec<(PathBuf, Vec<u8>)>,
}

impl Files {
    /// Adds a file in `folder` that may replace another one; no link is on the way to it.
    fn replace(&mut self, folder: &Folder, path: PathBuf, bytes: Vec<u8>) -> Result<(), FolderRefused> {
        folder.check_place(&path)?;
        self.last.push((path, bytes));
        Ok(())
    }
}

impl Received {
    /// Returns what was received, and what to do next.
    pub(crate) fn document(&self) -> Vec<Block> {
        let mut lines = passports(&self.passports);
        lines.extend(keys(&self.keys));
        lines.extend(self.pages.iter().map(|page| vec![Words::from(texts::PAGE), given(page)]));
        let new = || texts::next_in_new(code("at"), code(WORKSPACE_FILE), code("calibrate 4711.csv"));
        let unknown = || texts::next(listed(self.unknown.iter().map(given)), code("stand"), code(WORKSPACE_FILE));
        let next = self.is_new.then(new).or_else(|| (!self.unknown.is_empty()).then(unknown));
        let mut doc = vec![line(marked(Some(true), texts::received(given(&self.workspace)))), Block::Whole("", lines)];
        doc.extend(next.map(line));
        doc
    }
}
