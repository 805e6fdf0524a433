//! Recertification of a stand: the check against its certificate, the new certificate, and the successors of its
//! passports in force, in one step.
//!
//! Everything is computed, signed and verified before anything is written, and the files are then written together. A
//! second run with the same input completes a run that was killed in between, and changes nothing otherwise.

use super::Outcome;
use crate::certification::finding::Role;
use crate::certification::found::Found;
use crate::certification::remark::Remark;
use crate::certification::{AngleReadings, Certification, Comparison, Header, certify, compare, predicted};
use crate::document::sha256_hex;
use crate::files::{self, FileError, folder_of, leftovers};
use crate::folder::archive::Superseded;
use crate::folder::{Authority, Folder, FolderRefused, Next, Sealed, StandFolder};
use crate::passport::checks::{Check, for_the_issuer};
use crate::passport::difference::{NumberDifference, of_deviations};
use crate::passport::issue::PreparedStand;
use crate::passport::reissue::{Reissue, successor};
use crate::passport::{Code, Content, Question, Trust, Verification, verify};
use crate::register::{Entry, Row, State};
use crate::site::Site;
use crate::stand::{Excluded, Stand};
use crate::text::scalar::day;
use crate::text::{LARGEST_DOCUMENT_BYTES, Printable, Unreadable, first_few, name_of, rule, shown};
use jiff::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Place at which a new passport is requested.
#[derive(Debug, Clone)]
pub(crate) struct AtSite {
    pub id: String,
    /// Corrected site; `None` for the site as the passport in force states it.
    pub site: Option<Site>,
}

/// Function that makes the record of a certification from its check and the changed deviations.
pub(crate) type Record<'a> = dyn Fn(&Certification, &Comparison, &[NumberDifference]) -> Result<(), FileError> + 'a;

#[derive(Clone)]
pub(crate) struct Recertification<'a> {
    /// Passport of the stand, which is in force or has expired.
    pub passport: &'a Path,
    /// Name and content of the file of readings.
    pub readings: (&'a str, &'a [u8]),
    /// Readings and runs to leave out.
    pub excluded: &'a [Excluded],
    /// Header of the new certificate; that of the passport if `None`.
    pub header: Option<Header>,
    pub number: &'a str,
    pub issued: Date,
    /// Date on which the readings were taken; that of the header if `None`.
    pub performed: Option<Date>,
    /// Expiry date of the new certificate (inclusive); that of the header if `None`.
    pub valid_until: Option<Date>,
    /// Places that get a new passport; all in force if empty.
    pub sites: &'a [AtSite],
    pub reason: &'a str,
    /// Issuer; without a signer it is a dry run, which computes and checks everything and writes nothing.
    pub authority: Authority<'a>,
    pub issued_at: Timestamp,
    /// Question by which the passport is verified.
    pub question: Question,
    /// Root of the new files; that of the passport's path if `None`.
    pub out: Option<PathBuf>,
    /// Root of the stand file; that of the new files if `None`.
    pub stands: Option<PathBuf>,
    /// `true` to recertify a stand that has changed since its certificate.
    pub accept_change: bool,
    /// Makes the record of the certification before anything is written, so that nothing is if it fails.
    pub record: &'a Record<'a>,
    /// Flag that cancels the recertification before anything is written.
    pub cancel: Option<&'a AtomicBool>,
}

#[derive(Debug)]
pub(crate) struct Recertified {
    /// New certificate, with its evidence.
    pub certification: Certification,
    /// Check of the stand against the old certificate.
    pub comparison: Comparison,
    pub old_number: String,
    /// Deviations of the old and the new certificate.
    pub changes: Vec<NumberDifference>,
    /// Passports under the old certificate, in every state, with the customer of the stand, if the stand has changed: results
    /// since its measurement are in question.
    pub in_question: Vec<(Row, Option<String>)>,
    /// Date of the measurement of the old certificate, the last good check.
    pub measured: Date,
    /// `true` if nothing was written, because the stand has changed and this was not accepted.
    pub refused: bool,
    /// Passports that an earlier run issued, which were in force before this one.
    pub done: Vec<Row>,
    /// Successors that exist now, or that would be issued without the dry run.
    pub passports: Vec<Outcome>,
    /// Passports of the stand that stay in force under the old certificate.
    pub remaining: Vec<String>,
    pub stand_file: PathBuf,
    /// Path under which the superseded stand file is kept.
    pub superseded: Option<PathBuf>,
}

/// Reason why a stand was not recertified; nothing was written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotRecertified {
    /// Value that no certificate can state.
    #[error("{0}")]
    Order(String),
    /// Rule that the order or the readings break, with the findings that are the reason, as JSON.
    #[error("{0}; nothing was written")]
    Refused(String, Vec<serde_json::Value>),
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
    /// Successor that cannot be issued.
    #[error("{0}: {1}; nothing was written")]
    Folder(String, Box<FolderRefused>),
    #[error(transparent)]
    File(#[from] FileError),
}

impl NotRecertified {
    /// Returns `true` if a file cannot be used, `false` if a document was refused.
    pub(crate) fn is_unusable(&self) -> bool {
        match self {
            Self::Refused(..) | Self::File(FileError::Exists { .. }) => false,
            Self::Order(_) | Self::Unreadable(_) | Self::File(_) => true,
            Self::Folder(_, refused) => refused.is_unusable(),
        }
    }
}

fn refused(why: impl std::fmt::Display) -> NotRecertified {
    NotRecertified::Refused(why.to_string(), Vec::new())
}

/// Predecessor in force, with its file.
struct Old {
    path: PathBuf,
    bytes: Vec<u8>,
    verification: Verification,
    content: Content,
    site: Option<Site>,
}

impl Recertification<'_> {
    /// Recertifies the stand.
    pub(crate) fn run(&self) -> Result<Recertified, NotRecertified> {
        check(self.number, self.issued, self.performed, self.valid_until)?;
        let bytes = files::read(self.passport, LARGEST_DOCUMENT_BYTES)?;
        let (_, old) = verified(self.passport, &bytes, self.authority.trust, &self.question)?;
        let old_stand = old.to_stand();
        let header = self.header(&old_stand)?;
        let (certification, comparison) = self.measured(&old_stand, &header)?;
        let new = certification.stand.clone();
        let root = self.root(&old_stand)?;
        let stands = Folder::new(self.stands.as_deref().unwrap_or(&root));
        let stand_file = stands.stand_file(&new.stand);
        let text = certification.to_yaml(&name_of(&stand_file))?;
        stands.check_place(&stand_file).map_err(refused)?;
        self.check_there(&stand_file, &certification)?;
        let failed = |refused| NotRecertified::Folder(old_stand.stand.id(), Box::new(refused));
        let source = match Folder::root_of(self.passport, &old_stand.stand) {
            Ok(above) => Folder::new(above),
            Err(_) => Folder::new(&root),
        };
        let folder = Folder::new(&root);
        let from = StandFolder::open(&source, &old_stand.stand.id(), &self.authority, |_| false).map_err(failed)?;
        let to = (source.root() != folder.root())
            .then(|| StandFolder::open(&folder, &old_stand.stand.id(), &self.authority, |_| false))
            .transpose()
            .map_err(failed)?;
        let chosen = self.chosen(&from, &old_stand, &new)?;
        let has_changed = !comparison.same_stand && !comparison.is_undecided();
        let in_question = if has_changed { self.in_question(&from, &old_stand) } else { Vec::new() };
        let refused_change = has_changed && !self.accept_change;
        let to = to.as_ref().unwrap_or(&from);
        let prepared = Arc::new(PreparedStand::new(new.clone()));
        let mut next = Vec::new();
        for predecessor in &chosen.predecessors {
            next.push(self.next(predecessor, to, &prepared)?);
        }
        let superseded = Superseded::of(&stand_file, text.as_bytes())?;
        let changes = of_deviations(&old_stand, &new);
        if !refused_change {
            (self.record)(&certification, &comparison, &changes)?;
        }
        let passports = match self.authority.signer.filter(|_| !refused_change) {
            None => next.into_iter().map(Outcome::from).collect(),
            Some(_) => {
                let sealed = next.into_iter().map(|next| {
                    let id = next.id().to_owned();
                    to.seal(next).map_err(|refused| NotRecertified::Folder(id, Box::new(refused)))
                });
                let sealed = sealed.collect::<Result<Vec<_>, _>>()?;
                if self.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed)) {
                    return Err(refused("interrupted"));
                }
                write(to, &sealed, (&stand_file, &text), superseded.as_ref())?;
                sealed.into_iter().map(|sealed| Outcome::There(sealed.issued)).collect()
            }
        };
        Ok(Recertified {
            changes,
            measured: old_stand.certificate.measured(),
            old_number: old_stand.certificate.number,
            in_question,
            refused: refused_change,
            certification,
            comparison,
            done: chosen.done,
            passports,
            remaining: chosen.remaining,
            stand_file,
            superseded: superseded.map(|superseded| superseded.path),
        })
    }

    fn header(&self, old: &Stand) -> Result<Header, NotRecertified> {
        let mut header = self.header.clone().unwrap_or_else(|| Header::from(old));
        if header.stand.id() != old.stand.id() {
            let (given, old) = (header.stand.id(), old.stand.id());
            return Err(refused(format!("the header is for {given}, but the passport is for {old}")));
        }
        let before = &old.certificate;
        if self.issued < before.issued {
            return Err(refused(format!(
                "the new certificate would be dated {}, before certificate {} of {}, which it replaces; check the year \
                 of --issued",
                self.issued,
                Printable(&before.number),
                before.issued
            )));
        }
        if self.issued > self.issued_at.to_zoned(TimeZone::UTC).date() {
            return Err(refused(format!(
                "the new certificate would be dated {}, after its passports, which are issued at {}; check the year of \
                 --issued",
                self.issued, self.issued_at
            )));
        }
        self.number.clone_into(&mut header.certificate.number);
        header.certificate.issued = self.issued;
        header.certificate.performed = self.performed.or(header.certificate.performed);
        header.certificate.valid_until = self.valid_until.or(header.certificate.valid_until);
        Ok(header)
    }

    /// Certifies the stand from the readings, and compares it with the old certificate.
    fn measured(&self, old: &Stand, header: &Header) -> Result<(Certification, Comparison), NotRecertified> {
        let (name, bytes) = self.readings;
        let of_readings = |why: &dyn std::fmt::Display| refused(format!("{}: {why}", Printable(name)));
        let readings = AngleReadings::from_csv_without(name, bytes, &header.positions, self.excluded, Some(old))?;
        let (readings, _) = predicted(header, &readings).map_err(|why| of_readings(&why))?;
        let because = |why: &dyn std::fmt::Display, findings: Vec<Found>| {
            let why = format!("{}: {why}", Printable(name));
            NotRecertified::Refused(why, findings.iter().map(Found::to_json).collect())
        };
        let mut certification =
            certify(header, &readings).map_err(|why| because(&why, why.finding().into_iter().collect()))?;
        if let (None, Some(until)) = (header.certificate.valid_until, old.certificate.valid_until) {
            certification.add(Remark::no_expiry(until));
        }
        if certification.stand.check_number(old).is_err() || old.certificate.number == self.number {
            let number = self.number;
            return Err(refused(format!(
                "certificate {number} is the certificate of the passport; give the new certificate its own number with \
                 --number"
            )));
        }
        let comparison = compare(old, header, &readings, Some(&certification)).map_err(|why| of_readings(&why))?;
        if let Some(misplaced) = comparison.findings.iter().find(|found| found.role == Role::Misplaced) {
            return Err(because(misplaced, comparison.causes().collect()));
        }
        if comparison.positions.iter().all(|at| !at.repeats) {
            let why = "no more than half of the positions agree with the certificate; check that these are the readings of this \
                       stand. For a stand that has worn or was rebuilt, use `certify`, then `reissue FOLDER --stand` with the \
                       new stand file";
            return Err(because(&why, comparison.causes().collect()));
        }
        match comparison.findings.iter().find(|finding| finding.role == Role::OfCertificate) {
            Some(finding) => {
                let advice = "To correct the certificate without new readings, use `certify` and `reissue --stand`";
                Err(because(&format!("{finding}. {advice}"), comparison.causes().collect()))
            }
            None => Ok((certification, comparison)),
        }
    }

    /// Returns the folder of passports into which the new files are written.
    fn root(&self, stand: &Stand) -> Result<PathBuf, NotRecertified> {
        let shown_by_path = || Folder::root_of(self.passport, &stand.stand).map(Path::to_owned);
        let unknown = |why| refused(format!("{}: {why}", shown(self.passport)));
        self.out.clone().map_or_else(shown_by_path, Ok).map_err(unknown)
    }

    /// Checks that the existing stand file does not state other angles under the new number.
    fn check_there(&self, path: &Path, new: &Certification) -> Result<(), NotRecertified> {
        match files::read(path, LARGEST_DOCUMENT_BYTES) {
            Err(error) if error.is_missing() => Ok(()),
            Err(error) => Err(error.into()),
            Ok(bytes) => {
                let there = Stand::from_yaml(&name_of(path), &bytes)?;
                new.stand.check_number_of_file(&there).map_err(|why| refused(format!("{}: {why}", shown(path))))
            }
        }
    }

    /// Selects the passports that get a successor: the current ones in the register.
    fn chosen(&self, from: &StandFolder, old: &Stand, new: &Stand) -> Result<Chosen, NotRecertified> {
        let entries = from.entries();
        let time = self.question.time;
        let given = entries.iter().find(|entry| same_file(&from.path_of_entry(entry), self.passport));
        let Some(given) = given else {
            let words = format!("{}: not listed in the register of {}", shown(self.passport), old.stand.id());
            return Err(refused(words));
        };
        // Passports that expired with the given one are replaced too.
        let expired = given.is_expired(time).then_some(given.valid_until);
        let counts = |entry: &&Entry| {
            entry.state == State::Current && (!entry.is_expired(time) || Some(entry.valid_until) == expired)
        };
        let current: Vec<&Entry> = entries.iter().filter(counts).collect();
        let in_force: Vec<&str> = current.iter().map(|entry| entry.site_and_revision().0).collect();
        if let Some(asked) = self.sites.iter().find(|asked| !in_force.contains(&asked.id.as_str())) {
            return Err(refused(format!(
                "no passport of the stand is in force for site {}; found {}",
                asked.id,
                first_few(&in_force)
            )));
        }
        let mut chosen = Chosen::default();
        for entry in &current {
            let asked = self.sites.iter().find(|asked| asked.id == entry.site_and_revision().0);
            let path = from.path_of_entry(entry);
            let bytes = files::read(&path, LARGEST_DOCUMENT_BYTES)?;
            if sha256_hex(&bytes) != entry.sha256 {
                return Err(refused(format!("{}: is not the listed file; restore it from the backup", shown(&path))));
            }
            let (verification, content) = verified(&path, &bytes, self.authority.trust, &Question::at(time))?;
            if content.to_stand() == *new {
                chosen.done.push(Row { file: Some(name_of(&path)), ..Row::of(entry, time) });
            } else if content.certificate.number == new.certificate.number {
                let number = &new.certificate.number;
                return Err(refused(format!(
                    "{}: certificate {number} already states different contents",
                    shown(&path)
                )));
            } else if self.sites.is_empty() || asked.is_some() {
                let site = asked.and_then(|asked| asked.site.clone());
                chosen.predecessors.push(Old { path, bytes, verification, content, site });
            } else {
                chosen.remaining.push(content.passport.id);
            }
        }
        if !counts(&given) && chosen.done.is_empty() {
            let in_force: Vec<&str> = current.iter().map(|entry| entry.id.as_str()).collect();
            let in_force = if in_force.is_empty() { "none is".to_owned() } else { in_force.join(", ") };
            let words = format!(
                "{}: the passport is not in force: {}; give one that is in force ({in_force})",
                shown(self.passport),
                given.ended()
            );
            return Err(refused(words));
        }
        Ok(chosen)
    }

    /// Returns the passports under the certificate of `old`, in every state, with the customer that their files state.
    fn in_question(&self, from: &StandFolder, old: &Stand) -> Vec<(Row, Option<String>)> {
        let of_entry = |entry: &Entry| {
            let customer = from.listed_content(entry).and_then(|content| content.stand.customer);
            (Row::of(entry, self.question.time), customer)
        };
        from.entries().iter().filter(|entry| entry.certificate == old.certificate.number).map(of_entry).collect()
    }

    /// Returns the next step for the successor of one passport.
    fn next(&self, old: &Old, to: &StandFolder, stand: &Arc<PreparedStand>) -> Result<Next, NotRecertified> {
        let order = Reissue {
            stand: Some(Arc::clone(stand)),
            site: old.site.clone(),
            allow_uncalibratable: old.content.self_check.is_none(),
            ..Reissue::new(self.authority.issuer, self.issued_at, self.reason)
        };
        let next = successor(&old.bytes, &old.verification, &order)
            .map_err(|why| refused(format!("{}: {why}", shown(&old.path))))?;
        to.next_successor(&next).map_err(|why| NotRecertified::Folder(old.content.passport.id.clone(), Box::new(why)))
    }
}

/// Checks the values that have no file which a message could name.
pub(crate) fn check(
    number: &str,
    issued: Date,
    performed: Option<Date>,
    valid_until: Option<Date>,
) -> Result<(), NotRecertified> {
    if number.trim().is_empty() || !number.chars().all(rule::allowed_in_string) {
        return Err(NotRecertified::Order(format!(
            "--number {number:?}: is empty or contains a character that is not allowed in signed files, expected the \
             number of the new certificate, such as C-2027-0009"
        )));
    }
    let words = match (valid_until, performed) {
        (Some(until), _) if until < issued => format!("--valid-until {until} is before --issued {issued}"),
        (_, Some(performed)) if performed > issued => format!("--performed {performed} is after --issued {issued}"),
        _ => return Ok(()),
    };
    Err(NotRecertified::Order(format!("{words}; check the years")))
}

/// Verifies a passport that passes every check of `question`, or did before it expired: many stands return to the factory
/// only then.
fn verified(
    path: &Path,
    bytes: &[u8],
    trust: &Trust,
    question: &Question,
) -> Result<(Verification, Content), NotRecertified> {
    let mut found = verify(&name_of(path), bytes, trust, question);
    let has_expired = found.checks().iter().any(|check| check.code == Code::Expired);
    if let Some((last, _)) = found.content_from_anyone().filter(|_| has_expired).and_then(Content::last_day) {
        found = verify(&name_of(path), bytes, trust, &Question { time: day(last).1, ..question.clone() });
    }
    if let Some(content) = found.passport().map(|passport| passport.content().clone()) {
        return Ok((found, content));
    }
    let why = |check: &Check| format!(" ({}: {})", check.name.as_str(), for_the_issuer(&check.detail));
    let why = found.failed().map_or_else(String::new, why);
    Err(refused(format!("{}: the passport failed verification{why}", shown(path))))
}

/// Passports of a stand that get successors or have them.
#[derive(Default)]
struct Chosen {
    predecessors: Vec<Old>,
    /// Passports that an earlier run has already issued.
    done: Vec<Row>,
    /// Ids of the passports that were not requested.
    remaining: Vec<String>,
}

fn same_file(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// Writes the superseded stand file under its new name, then all passports, the register and the new stand file together.
fn write(
    to: &StandFolder,
    sealed: &[Sealed],
    (stand_file, text): (&Path, &str),
    superseded: Option<&Superseded>,
) -> Result<(), NotRecertified> {
    leftovers::remove(folder_of(stand_file));
    let passport = |sealed: &Sealed| Some((sealed.issued.path.clone(), sealed.text.clone()?.into_bytes()));
    let kept = superseded.and_then(Superseded::new_file);
    let new: Vec<(PathBuf, Vec<u8>)> = kept.into_iter().chain(sealed.iter().filter_map(passport)).collect();
    let written = to.list_together(&new, (stand_file.to_owned(), text.as_bytes().to_vec()));
    written.map_err(|refused| match refused {
        FolderRefused::File(error) => NotRecertified::File(error),
        refused => NotRecertified::Folder(to.stand.clone(), Box::new(refused)),
    })
}
