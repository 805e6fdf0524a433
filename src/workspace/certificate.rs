//! Finds what belongs to a certificate number: readings, header, record, stand file and passports.

use crate::batch::paths::has_extension;
use crate::certification::Header;
use crate::document::sha256_hex;
use crate::files::walk::Walk;
use crate::files::{self, FileError};
use crate::folder::overview::{Overview, Query};
use crate::history::PastCertificate;
use crate::register::Row;
use crate::report::doc::{Block, Words, given, line, marked};
use crate::report::register::state;
use crate::report::style::Outcome;
use crate::stand::{Certificate, Stand};
use crate::text::characters::with_latin;
use crate::text::{Document, LARGEST_DOCUMENT_BYTES, name_of};
use crate::wording::Text;
use crate::wording::texts::history as texts;
use jiff::civil::Date;
use memchr::memmem;
use serde::Serialize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Files and passports of a certificate.
#[derive(Debug, Serialize)]
pub(crate) struct Trace {
    certificate: String,
    stand: String,
    issued: Date,
    performed: Option<Date>,
    laboratory: String,
    /// SHA-256 of the readings, as the certificate states it.
    readings_sha256: Option<String>,
    readings: Vec<File>,
    header: Option<String>,
    record: Option<String>,
    stand_file: Option<String>,
    passports: Vec<Row>,
    /// Certificates of the stand that were measured later.
    recertifications: Vec<Later>,
    /// Kinds of files that were not found.
    missing: Vec<&'static str>,
    /// Stand files of this number with other contents.
    changed: Vec<String>,
    /// Alarms of the register and remarks on its certificates, in words.
    remarks: Vec<String>,
}

#[derive(Debug, Serialize)]
struct File {
    path: String,
    sha256: String,
}

#[derive(Debug, Serialize)]
struct Later {
    number: String,
    issued: Date,
}

impl Trace {
    /// Finds a certificate by its number, whose letters may also be those that only look like them, among the passports in a
    /// folder and the files under `root`; `None` if neither a register nor a stand file has it.
    ///
    /// # Errors
    /// Returns [`FileError`] if the folder of passports cannot be read.
    pub(crate) fn of(number: &str, root: &Path, passports: &Path, query: Query) -> Result<Option<Self>, FileError> {
        let number = with_latin(number);
        let is_it = |other: &str| with_latin(other) == number;
        let overview = Overview::of(passports, query)?;
        let lists_it = |rows: &[Row]| rows.iter().any(|row| is_it(&row.certificate));
        let of_stand = overview.stands.iter().find(|found| lists_it(&found.rows));
        let history = of_stand.and_then(|found| overview.history(&found.stand, query));
        let certificates = history.as_ref().map_or(&[][..], |history| &history.certificates);
        let has_number = |at: &&PastCertificate| is_it(&at.stand.certificate.number);
        let files: Vec<_> = Walk::deep(root, is_wanted).files().filter_map(read).collect();
        let stand_files: Vec<(&String, Stand)> = files
            .iter()
            .filter_map(|(path, bytes)| Some((path, Stand::from_yaml(path, bytes).ok()?)))
            .filter(|(_, stand)| is_it(&stand.certificate.number))
            .collect();
        let certified = certificates.iter().rfind(has_number).map(|at| &at.stand);
        let Some(certified) = certified.or(stand_files.first().map(|(_, stand)| stand)) else { return Ok(None) };
        let same = |stand: &Stand| stand.certificate == certified.certificate && stand.positions == certified.positions;
        let Certificate { number, issued, performed, laboratory, evidence, .. } = certified.certificate.clone();
        let readings_sha256 = evidence.map(|evidence| evidence.readings_sha256);
        let file = |(path, bytes): &(String, Vec<u8>)| File { path: path.clone(), sha256: sha256_hex(bytes) };
        let readings = files.iter().map(file).filter(|file| readings_sha256.as_ref() == Some(&file.sha256)).collect();
        let is_header = |(path, bytes): &&(String, Vec<u8>)| {
            Header::from_yaml(path, bytes).is_ok_and(|header| is_it(&header.certificate.number))
        };
        let is_record = |(path, bytes): &&(String, Vec<u8>)| {
            path.ends_with(".html") && readings_sha256.as_ref().is_some_and(|sha256| contains(bytes, sha256))
        };
        let later = certificates.iter().filter(|at| at.stand.certificate.measured() > certified.certificate.measured());
        let mut found = Self {
            stand: certified.stand.id(),
            header: files.iter().find(is_header).map(|(path, _)| path.clone()),
            record: files.iter().find(is_record).map(|(path, _)| path.clone()),
            stand_file: stand_files.iter().find(|(_, stand)| same(stand)).map(|(path, _)| (*path).clone()),
            changed: stand_files.iter().filter(|(_, stand)| !same(stand)).map(|(path, _)| (*path).clone()).collect(),
            passports: of_stand
                .map_or(&[][..], |found| &found.rows)
                .iter()
                .filter(|row| is_it(&row.certificate))
                .cloned()
                .collect(),
            recertifications: later
                .map(|at| Later { number: at.stand.certificate.number.clone(), issued: at.stand.certificate.issued })
                .collect(),
            remarks: history.as_ref().map_or_else(Vec::new, |history| history.remarks.clone()),
            certificate: number,
            missing: Vec::new(),
            issued,
            performed,
            laboratory,
            readings_sha256,
            readings,
        };
        found.missing = found.files().into_iter().filter(|(.., files)| files.is_empty()).map(|(key, ..)| key).collect();
        Ok(Some(found))
    }

    /// Returns the kinds of files: JSON key, heading, and paths.
    fn files(&self) -> [(&'static str, Text, Vec<&String>); 4] {
        let readings = self.readings.iter().map(|file| &file.path).collect();
        [
            ("readings", texts::READINGS, readings),
            ("header", texts::HEADER, self.header.iter().collect()),
            ("record", texts::RECORD, self.record.iter().collect()),
            ("stand_file", texts::STAND_FILE, self.stand_file.iter().collect()),
        ]
    }

    /// Returns the certificate, its files, its passports and its successors, and what is missing or has changed.
    pub(crate) fn document(&self) -> Vec<Block> {
        let is_whole = self.missing.is_empty() && self.changed.is_empty() && self.remarks.is_empty();
        let outcome = if is_whole { Outcome::Passed } else { Outcome::Undecided };
        let certificate = texts::of_certificate(given(&self.certificate), given(&self.laboratory), self.issued);
        let mut lines = Vec::new();
        for (_, heading, paths) in self.files() {
            let missing = paths.is_empty().then(|| marked(Outcome::Failed, texts::MISSING));
            lines.extend(paths.into_iter().map(given).chain(missing).map(|words| vec![heading.into(), words]));
        }
        let changed = |path: &String| marked(Outcome::Failed, texts::differs(given(path)));
        lines.extend(self.changed.iter().map(|path| vec![texts::STAND_FILE.into(), changed(path)]));
        let of_passport = |row: &Row| vec![given(&row.id), "  ".into(), state(row).into()].into();
        lines.extend(self.passports.iter().map(|row| vec![texts::PASSPORTS.into(), of_passport(row)]));
        let later = |at: &Later| vec![given(&at.number), "  ".into(), Words::Date(at.issued)].into();
        lines.extend(self.recertifications.iter().map(|at| vec![texts::RECERTIFIED.into(), later(at)]));
        let mut doc =
            vec![line(vec![marked(outcome, given(&self.stand)), "  ".into(), certificate]), Block::Whole("", lines)];
        doc.extend(self.remarks.iter().map(|remark| line(texts::remark(given(remark)))));
        doc
    }
}

/// Returns `true` for the name of a file that may belong to a certificate.
fn is_wanted(name: &OsStr) -> bool {
    has_extension(name, &["csv", "txt", "yaml", "yml", "html"])
}

/// Reads a file, if it is a table, a stand file or header, or a page that embeds a table, as a record does.
fn read(path: PathBuf) -> Option<(String, Vec<u8>)> {
    let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES).ok()?;
    let is_table = path.file_name().is_some_and(|name| has_extension(name, &["csv", "txt"]));
    let is_kept = is_table || contains(&bytes, Stand::FORMAT) || contains(&bytes, "data:text/csv");
    is_kept.then(|| (name_of(&path), bytes))
}

fn contains(bytes: &[u8], text: &str) -> bool {
    memmem::find(bytes, text.as_bytes()).is_some()
}
