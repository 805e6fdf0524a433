//! Registers of all stands in a folder, compared with the files next to them.
//!
//! Each folder is read by itself, so memory grows with the entries of accepted registers only, not with other files.

use super::place::{file_name, is_in_place, listed_content, numbered, path_of_id, stand_of};
use super::registers::{self, Memory, doubt};
use crate::document::sha256_hex;
use crate::files::leftovers::is_lasting;
use crate::files::walk::{Entry as Listed, LINK, SPECIAL, Walk};
use crate::files::{self, FileError};
use crate::history::{History, Recorded};
use crate::parallel;
use crate::passport::{Content, Question, Trust, verify};
use crate::register::{Doubt, Entry, FILE_NAME, Row, State, VerifiedRegister};
use crate::text::{Kind, LARGEST_DOCUMENT_BYTES, Printable, first_few, name_of, words};
use jiff::Timestamp;
use jiff::civil::Date;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::{self, Display};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// Folder of passports, and the trust and the question by which it is read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Query<'a> {
    pub trust: &'a Trust,
    /// Stands, issuers and places of the rows; alarms are for all.
    pub question: &'a Question,
    /// Last accepted registers, in a workspace.
    pub memory: Option<&'a Memory>,
    /// `true` if listed passports may be absent, as in a laboratory.
    pub may_lack: bool,
    pub threads: usize,
}

/// Register of a stand.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct StandRows {
    pub stand: String,
    pub sequence: u64,
    pub sha256: String,
    pub issued_at: Timestamp,
    pub fresh_until: Option<Date>,
    pub rows: Vec<Row>,
    #[serde(skip)]
    pub issuer: String,
    /// Number of passports, with those that the question does not concern.
    #[serde(skip)]
    pub listed: usize,
}

words! {
    /// Kind of an [`Alarm`].
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub(crate) enum AlarmCode: pub(crate) key {
        /// Authentic passport that the register does not list.
        NotListed = "not_listed",
        /// File that is not the listed one.
        Differs = "differs",
        /// Listed passport without a file.
        Missing = "missing",
        /// Authentic passports without a register.
        NoRegister = "no_register",
        /// Register that is damaged or not trusted.
        RegisterUnknown = "register_unknown",
        /// Register that is no longer fresh.
        RegisterStale = "register_stale",
        /// Register that is older than the last one of the workspace.
        RegisterOlder = "register_older",
        /// Register that contradicts the last one of the workspace.
        RegisterContradicted = "register_contradicted",
        /// Stand that is current under several certificates, or certificate with several sets of angles, or for several
        /// stands.
        Certificates = "certificates",
        /// File in another place than its content requires.
        Misplaced = "misplaced",
        /// List of withdrawn passports of an earlier version.
        RevocationList = "revocation_list",
        /// File or folder that cannot be read.
        Unreadable = "unreadable",
    }
}

/// Finding in a folder of passports that requires attention.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Alarm {
    pub code: AlarmCode,
    pub stand: Option<String>,
    pub file: Option<String>,
    pub detail: String,
}

impl Alarm {
    fn new(code: AlarmCode, stand: Option<&str>, file: Option<&Path>, detail: impl Display) -> Self {
        Self { code, stand: stand.map(str::to_owned), file: file.map(name_of), detail: detail.to_string() }
    }
}

impl Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let file = self.file.as_deref().map_or_else(String::new, |file| format!("{file}: "));
        Printable(format_args!("ALARM ({}): {file}{}", self.code.key(), self.detail)).fmt(f)
    }
}

/// Registers of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub(crate) struct Overview {
    pub stands: Vec<StandRows>,
    pub alarms: Vec<Alarm>,
    /// Remarks on files that have no effect, for the user.
    #[serde(skip)]
    pub remarks: Vec<String>,
    /// Listed passports that are absent, which a laboratory need not have; in words.
    #[serde(skip)]
    pub absent: Vec<String>,
}

/// Findings in one folder.
#[derive(Default)]
struct Found {
    own: Overview,
    /// Fingerprint of the certified angles, by certificate number, of the current passports.
    angles: BTreeSet<(String, u64)>,
}

impl Found {
    fn alarm(&mut self, code: AlarmCode, stand: Option<&str>, file: &Path, detail: impl Display) {
        self.own.alarms.push(Alarm::new(code, stand, Some(file), detail));
    }
}

impl Overview {
    /// Reads every register under `root`, and compares it with the files next to it.
    ///
    /// # Errors
    /// Returns [`FileError`] if `root` cannot be read; an unreadable file or folder below it is an alarm.
    pub(crate) fn of(root: &Path, query: Query) -> Result<Self, FileError> {
        let (folders, unreadable) = folders(root)?;
        let found = parallel::map(&folders, query.threads, |folder| query.folder(root, folder));
        let mut overview = Self::default();
        let unread = |error: &FileError| Alarm::new(AlarmCode::Unreadable, None, Some(error.path()), error);
        overview.alarms.extend(unreadable.iter().map(unread));
        let mut shared: BTreeMap<(String, u64), Vec<String>> = BTreeMap::new();
        for Found { own, angles } in found {
            for (stand, angles) in own.stands.iter().flat_map(|stand| angles.iter().map(move |angles| (stand, angles)))
            {
                shared.entry(angles.clone()).or_default().push(stand.stand.clone());
            }
            overview.alarms.extend(own.alarms);
            overview.remarks.extend(own.remarks);
            overview.absent.extend(own.absent);
            overview.stands.extend(own.stands);
        }
        for ((number, _), stands) in shared.into_iter().filter(|(_, stands)| stands.len() > 1) {
            // No two stands have the same deviations, so one of them has those of the other.
            let detail = format!(
                "certificate {number} has the same angles for {} stands, {}; withdraw the passports with the wrong serial \
                 number",
                stands.len(),
                first_few(&stands)
            );
            overview.alarms.push(Alarm::new(AlarmCode::Certificates, None, None, detail));
        }
        Ok(overview)
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = &Row> {
        self.stands.iter().flat_map(|stand| &stand.rows)
    }

    /// Returns `true` if there is an alarm, or a current passport that has expired.
    pub(crate) fn needs_attention(&self) -> bool {
        !self.alarms.is_empty() || self.rows().any(|row| row.state == State::Current && row.expired)
    }

    /// Returns `true` if the system refused to read a file or folder.
    pub(crate) fn is_incomplete(&self) -> bool {
        self.alarms.iter().any(|alarm| alarm.code == AlarmCode::Unreadable)
    }
}

/// Returns the folders under `root` that contain a file, and the errors of those that cannot be read.
fn folders(root: &Path) -> Result<(Vec<PathBuf>, Vec<FileError>), FileError> {
    let (mut folders, mut unreadable) = (BTreeSet::new(), Vec::new());
    for entry in Walk::deep(root, is_lasting) {
        match entry {
            Ok(Listed::File(path) | Listed::Link(path) | Listed::Special(path)) => {
                folders.insert(files::folder_of(&path).to_owned());
            }
            Err(error) if error.path() == root => return Err(error),
            Err(error) => unreadable.push(error),
        }
    }
    Ok((folders.into_iter().collect(), unreadable))
}

impl Query<'_> {
    fn folder(&self, root: &Path, folder: &Path) -> Found {
        let mut found = Found::default();
        let register_path = folder.join(FILE_NAME);
        let is_there = register_path.symlink_metadata().is_ok();
        let register = is_there.then(|| self.register(root, &register_path, &mut found)).flatten();
        let mut rows: Vec<Row> = Vec::new();
        let mut places: HashMap<PathBuf, usize> = HashMap::new();
        let time = self.question.time;
        if let Some(register) = &register {
            rows.extend(register.entries().iter().map(|entry| Row::of(entry, time)));
            let path = |entry: &Entry| {
                let (site, revision) = entry.site_and_revision();
                folder.join(file_name(site, revision))
            };
            places.extend(register.entries().iter().map(path).zip(0..));
        }
        let mut bytes = Vec::new();
        for entry in Walk::flat(folder, is_lasting) {
            let path = match entry {
                Ok(Listed::File(path)) if path == register_path => continue,
                Ok(Listed::File(path)) => path,
                Ok(Listed::Link(path) | Listed::Special(path)) => {
                    // Not read; what is where a passport belongs is reported.
                    if places.contains_key(&path) || path.file_name().and_then(numbered).is_some() {
                        let why = if path.is_symlink() { LINK } else { SPECIAL };
                        found.alarm(AlarmCode::Unreadable, None, &path, why);
                    }
                    continue;
                }
                Err(error) => {
                    found.alarm(AlarmCode::Unreadable, None, error.path(), &error);
                    continue;
                }
            };
            let listed = places.get(&path).copied();
            let name = path.file_name().unwrap_or_default();
            if let Err(error) = files::read_into(&mut bytes, &path, LARGEST_DOCUMENT_BYTES)
                && (listed.is_some() || matches!(error, FileError::Read(..)))
            {
                found.alarm(AlarmCode::Unreadable, None, &path, &error);
                continue;
            }
            if let (Some(place), Some(register)) = (listed, &register)
                && sha256_hex(&bytes) == rows[place].sha256
            {
                self.listed(&mut rows[place], register, &path, &bytes, &mut found);
                continue;
            }
            let kind = Kind::of(&bytes);
            if kind == Some(Kind::RevocationList) {
                let detail = "a list of withdrawn passports of an earlier version, which has no effect; make registers \
                              with `register DIR --renew`, then remove it";
                found.alarm(AlarmCode::RevocationList, None, &path, detail);
            } else if kind == Some(Kind::Passport) || numbered(name).is_some() {
                let id = listed.map(|place| rows[place].id.as_str());
                let is_good = self.unlisted(&path, &bytes, id, register.as_ref(), &mut found);
                let is_told = || found.own.alarms.iter().any(|alarm| alarm.code == AlarmCode::NoRegister);
                if is_good && !is_there && !is_told() {
                    let detail = "has passports, but no register; make it with `register DIR --renew`, or restore it from \
                                  the backup";
                    found.alarm(AlarmCode::NoRegister, stand_of(folder).as_deref(), folder, detail);
                }
            }
        }
        if let Some(register) = register {
            self.finish(&register, rows, folder, &mut found);
        }
        found
    }

    /// Reads the register of a folder; returns `None` after an alarm if it does not count.
    fn register(&self, root: &Path, path: &Path, found: &mut Found) -> Option<VerifiedRegister> {
        let stand = stand_of(files::folder_of(path));
        let register = match registers::read(path, self.trust, self.question.now) {
            Ok(register) => register,
            Err(refused) => {
                found.own.alarms.push(Alarm::new(AlarmCode::RegisterUnknown, stand.as_deref(), None, refused));
                return None;
            }
        };
        let of = register.header().stand.clone();
        if stand.as_deref() != Some(&of) && files::folder_of(path) != root {
            found.alarm(AlarmCode::Misplaced, Some(&of), path, format!("this is the register of {of}"));
            return None;
        }
        if let Some(memory) = self.memory {
            match memory.last(&of, self.trust, self.question.now) {
                Err(refused) => found.alarm(AlarmCode::RegisterUnknown, Some(&of), path, refused),
                Ok((last, remark)) => {
                    found.own.remarks.extend(remark);
                    if let Some(doubt) = last.and_then(|last| doubt(&register, &last)) {
                        let code = match doubt {
                            Doubt::Older(_) => AlarmCode::RegisterOlder,
                            Doubt::Contradicted(_) => AlarmCode::RegisterContradicted,
                            Doubt::Unconfirmed(_) => AlarmCode::RegisterUnknown,
                        };
                        found.alarm(code, Some(&of), path, doubt);
                    }
                }
            }
        }
        Some(register)
    }

    /// Notes the file of a listed passport.
    fn listed(&self, row: &mut Row, register: &VerifiedRegister, path: &Path, bytes: &[u8], found: &mut Found) {
        row.file = Some(name_of(path));
        let angles = fingerprint(bytes);
        let number = row.certificate.clone();
        if row.state != State::Withdrawn
            && let Some(angles) = angles
        {
            if found.angles.iter().any(|(other, known)| *other == number && *known != angles) {
                let detail = format!("{} states other angles under the number of certificate {number}", row.id);
                found.alarm(AlarmCode::Certificates, Some(&register.header().stand), path, detail);
            }
            found.angles.insert((number, angles));
        }
    }

    /// Reports a file that the register does not list; returns `true` if it is an authentic passport.
    fn unlisted(
        &self,
        path: &Path,
        bytes: &[u8],
        place_of: Option<&str>,
        register: Option<&VerifiedRegister>,
        found: &mut Found,
    ) -> bool {
        let verification = verify(&name_of(path), bytes, self.trust, &Question::at(self.question.now));
        let stand = register.map(|register| register.header().stand.as_str());
        let Some((content, _)) = verification.authentic() else {
            let why = verification.why();
            match place_of {
                Some(id) => {
                    found.alarm(AlarmCode::Differs, stand, path, format!("is not the listed file of {id}: {why}"));
                }
                None => found.own.remarks.push(format!("{}: has no effect: {why}", name_of(path))),
            }
            return false;
        };
        let id = &content.passport.id;
        let due = path_of_id(id);
        match place_of {
            Some(place) if place == id => {
                found.alarm(AlarmCode::Differs, stand, path, format!("is another passport {id} than the listed one"));
            }
            _ if !is_in_place(path, &due) => {
                found.alarm(AlarmCode::Misplaced, stand, path, format!("contains {id}, expected in {due}"));
            }
            // Next to a register that does not count, nothing is known to be unlisted.
            _ if register.is_some() => {
                let advice =
                    "run the command that issued it again, or take it over with `register DIR --renew --adopt`";
                let sha256 = sha256_hex(bytes);
                let detail = format!("{id} is authentic, but not listed (SHA-256 {sha256}); {advice}");
                found.alarm(AlarmCode::NotListed, stand, path, detail);
            }
            _ => {}
        }
        true
    }

    fn finish(&self, register: &VerifiedRegister, mut rows: Vec<Row>, folder: &Path, found: &mut Found) {
        let header = register.header();
        let stand = Some(header.stand.as_str());
        if register.is_stale(self.question.time.max(self.question.now)) {
            let last = header.fresh_until.map_or_else(String::new, |last| last.to_string());
            let detail =
                format!("was fresh until {last} (inclusive); renew it with `register DIR --renew --fresh-until`");
            found.alarm(AlarmCode::RegisterStale, stand, &folder.join(FILE_NAME), detail);
        }
        for row in rows.iter().filter(|row| row.file.is_none()) {
            let due = path_of_id(&row.id);
            let path = folder.join(due.rsplit('/').next().unwrap_or(&due));
            if path.symlink_metadata().is_ok() {
                continue;
            }
            match self.may_lack {
                true => found.own.absent.push(format!("{}: listed, but not here", row.id)),
                false => {
                    let detail = format!("{} is listed, but its file is missing; restore it from the backup", row.id);
                    found.alarm(AlarmCode::Missing, stand, &path, detail);
                }
            }
        }
        let current = rows.iter().filter(|row| row.state == State::Current);
        let numbers: BTreeSet<&str> = current.map(|row| row.certificate.as_str()).collect();
        if numbers.len() > 1 {
            let numbers: Vec<&str> = numbers.into_iter().collect();
            let detail = format!(
                "{} is current under {} certificates, {}; withdraw or re-issue the passports of the outdated one",
                header.stand,
                numbers.len(),
                numbers.join(", ")
            );
            found.own.alarms.push(Alarm::new(AlarmCode::Certificates, stand, None, detail));
        }
        found
            .angles
            .retain(|(number, _)| rows.iter().any(|row| row.state == State::Current && row.certificate == *number));
        rows.retain(|row| self.selects(row, header));
        found.own.stands.push(StandRows {
            stand: header.stand.clone(),
            sequence: header.sequence,
            sha256: register.sha256().to_owned(),
            issued_at: header.issued_at,
            fresh_until: header.fresh_until,
            rows,
            issuer: header.issuer.clone(),
            listed: register.entries().len(),
        });
    }

    /// Returns `true` if issuer, stand and place of the question match a row. The place needs the file of the passport.
    fn selects(&self, row: &Row, header: &crate::register::RegisterHeader) -> bool {
        let serial = header.stand.rsplit('/').next();
        self.question.issuer.as_ref().is_none_or(|issuer| *issuer == header.issuer)
            && self.question.serial.as_deref().is_none_or(|asked| serial == Some(asked))
            && (self.question.place.is_none() || content(row).is_some_and(|content| self.question.concerns(&content)))
    }
}

/// Returns the content of the file of a row; `None` if it has changed since it was compared with the register.
fn content(row: &Row) -> Option<Content> {
    listed_content(Path::new(row.file.as_deref()?), &row.sha256)
}

/// Returns a fingerprint of the certified angles in the text of a passport, which is in canonical form.
fn fingerprint(bytes: &[u8]) -> Option<u64> {
    const POSITIONS: &[u8] = b"\npositions:\n";
    let from = memchr::memmem::find(bytes, POSITIONS)? + POSITIONS.len();
    let mut hasher = DefaultHasher::new();
    let lines = bytes[from..].split(|byte| *byte == b'\n');
    lines.take_while(|line| line.starts_with(b"  - {")).for_each(|line| line.hash(&mut hasher));
    Some(hasher.finish())
}

impl Overview {
    /// Reads the registers of a stand, `<model>/<serial>`, as [`Overview::of`] does.
    pub(crate) fn of_stand(root: &Path, stand: &str, query: Query) -> Result<Self, FileError> {
        let below = root.join(stand);
        Self::of(if below.is_dir() { &below } else { root }, query)
    }

    /// Returns the history of a stand, or `None` without a register of it.
    pub(crate) fn history(&self, stand: &str, query: Query) -> Option<History> {
        let found = self.stands.iter().find(|found| found.stand == stand)?;
        let recorded = |row: &Row| Recorded { row: row.clone(), content: content(row) };
        let recorded = parallel::map(&found.rows, query.threads, recorded);
        let concerns = |alarm: &&Alarm| alarm.stand.as_ref().is_none_or(|of| of == stand);
        let alarms = self.alarms.iter().filter(concerns).map(ToString::to_string).collect();
        Some(History::of(stand, recorded, alarms, query.question.time))
    }
}
