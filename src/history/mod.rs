//! One stand over the years: its certificates, passports, places and withdrawals, and the drift of its deviations.
//!
//! `drift`: the deviations of all certificates, also relative to each other, and the test of whether they drift.
//!
//! A history is a function of verified passports; [`crate::folder`] finds the files.

pub(crate) mod drift;

use crate::document::sha256_hex;
use crate::passport::{Content, Question, Trust, verify};
use crate::register::{Alarm, Line, Register, State};
use crate::revocation::Entry;
use crate::stand::Stand;
use crate::text::first_few;
use crate::text::scalar::day;
use drift::Drift;
use jiff::Timestamp;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::iter;

/// Certificate of the stand, as its passports state it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PastCertificate {
    /// Stand with its certificate and its certified positions.
    pub stand: Stand,
    /// Identifiers of the passports that contain it.
    pub passports: Vec<String>,
    /// `true` unless all of its passports were withdrawn; the deviations of a withdrawn certificate are not used.
    pub counts: bool,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct PastPassport {
    /// Entry of the register.
    #[serde(flatten)]
    pub line: Line,
    /// Time of issue; null unless the passport is authentic.
    pub issued_at: Option<Timestamp>,
    /// Time from which the passport was no longer in force: superseded, moved, expired or withdrawn; null if it still
    /// is, or was never.
    pub ended_at: Option<Timestamp>,
    /// Time at which a passport in force expires, if it does; for pictures.
    #[serde(skip)]
    pub expires_at: Option<Timestamp>,
    pub predecessor: Option<String>,
    pub reason: Option<String>,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Stay {
    pub site: String,
    /// Issue of the first passport for the site.
    pub from: Timestamp,
    /// End of the last passport for the site; null if it is in force.
    pub until: Option<Timestamp>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct History {
    /// Model and serial number, `<model>/<serial>`.
    pub stand: String,
    /// Certificates in the order of their measurement.
    pub certificates: Vec<PastCertificate>,
    /// Passports in the order of their issue; those that are not authentic come last.
    pub passports: Vec<PastPassport>,
    /// Stays of the stand at sites, in the order of their beginning.
    pub places: Vec<Stay>,
    /// Withdrawals, in the order of their time.
    pub withdrawals: Vec<Entry>,
    /// Change of the deviations over the years.
    pub drift: Drift,
    /// Alarms of the register that concern the stand, and remarks on its certificates, in words.
    pub remarks: Vec<String>,
}

/// File of a passport of the stand: its entry in the register, and its content if it is authentic.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recorded {
    line: Line,
    content: Option<Content>,
}

impl Recorded {
    /// Verifies the file of a register entry again, to obtain its content. A file that has changed since has none.
    pub(crate) fn of(line: &Line, bytes: &[u8], trust: &Trust, time: Timestamp) -> Self {
        let same = sha256_hex(bytes) == line.sha256;
        let verification = same.then(|| verify(&line.file, bytes, trust, &Question::at(time)));
        let content = verification.as_ref().and_then(|found| found.authentic()).map(|(content, _)| content.clone());
        Self { line: line.clone(), content }
    }
}

impl History {
    /// Creates the history of a stand, `<model>/<serial>`, from the files of its passports; `register` and `trust` are
    /// those of their folder.
    pub(crate) fn of(stand: &str, recorded: Vec<Recorded>, register: &Register, trust: &Trust, now: Timestamp) -> Self {
        let concerns =
            |alarm: &&Alarm| alarm.concerns(stand) || recorded.iter().any(|at| alarm.files.contains(&at.line.file));
        let mut remarks: Vec<String> = register.alarms.iter().filter(concerns).map(ToString::to_string).collect();
        let certificates = certificates(&recorded, &mut remarks);
        let passports = passports(&recorded, trust, now);
        let withdrawals = withdrawals(&recorded, trust);
        let drift = Drift::of(&independent(&certificates, &mut remarks));
        Self {
            stand: stand.to_owned(),
            places: places(&passports),
            certificates,
            passports,
            withdrawals,
            drift,
            remarks,
        }
    }

    /// Returns the identifiers of the sites, in the order of the first stay.
    pub(crate) fn sites(&self) -> Vec<&str> {
        let mut known = BTreeSet::new();
        self.places.iter().map(|stay| stay.site.as_str()).filter(|site| known.insert(*site)).collect()
    }
}

fn certificates(recorded: &[Recorded], remarks: &mut Vec<String>) -> Vec<PastCertificate> {
    let mut found: Vec<PastCertificate> = Vec::new();
    let authentic = recorded.iter().filter_map(|at| Some((at, at.content.as_ref()?)));
    for (at, content) in authentic {
        let stand = content.to_stand();
        let counts = at.line.state != State::Revoked;
        let id = content.passport.id.clone();
        match found
            .iter_mut()
            .find(|known| known.stand.certificate == stand.certificate && known.stand.positions == stand.positions)
        {
            Some(known) => {
                known.counts |= counts;
                known.passports.push(id);
            }
            None => found.push(PastCertificate { stand, passports: vec![id], counts }),
        }
    }
    found.sort_by(|a, b| {
        let key = |at: &PastCertificate| (at.stand.certificate.measured(), at.stand.certificate.issued);
        key(a).cmp(&key(b)).then_with(|| a.stand.certificate.number.cmp(&b.stand.certificate.number))
    });
    for (place, at) in found.iter().enumerate() {
        let number = &at.stand.certificate.number;
        if found[..place].iter().any(|other| other.stand.certificate.number == *number) {
            remarks.push(format!("certificate {number} has different contents in {}", first_few(&at.passports)));
        }
        if !at.counts {
            remarks.push(format!(
                "all passports of certificate {number} were withdrawn; its deviations are not used for the drift"
            ));
        } else if at.stand.certificate.performed.is_none() {
            remarks.push(format!(
                "certificate {number} does not state the date of measurement; rates of drift are computed from its date of \
                 issue"
            ));
        }
    }
    found
}

/// Returns the stands whose deviations are compared: those of certificates that count, one for each file of readings.
///
/// A second certificate from the same readings is not evidence that the stand has not changed, and is left out. Deviations
/// that agree in every digit were copied, because no measurement repeats them. A correction has the same date of
/// measurement as the certificate that it corrects, and replaces it.
fn independent<'a>(certificates: &'a [PastCertificate], remarks: &mut Vec<String>) -> Vec<&'a Stand> {
    let readings = |stand: &Stand| Some(stand.certificate.evidence.as_ref()?.readings_sha256.clone());
    let mut used: Vec<&Stand> = Vec::new();
    for stand in certificates.iter().filter(|at| at.counts).map(|at| &at.stand) {
        let angles = |stand: &Stand| -> Vec<_> { stand.positions.iter().map(|at| at.angles_arcsec()).collect() };
        let same_readings = |other: &Stand| readings(stand).is_some() && readings(stand) == readings(other);
        let same = |other: &&mut &Stand| same_readings(other) || angles(stand) == angles(other);
        let Some(other) = used.iter_mut().find(same) else {
            used.push(stand);
            continue;
        };
        let corrects = stand.certificate.measured() == other.certificate.measured();
        let [kept, left_out] = if corrects { [stand, *other] } else { [*other, stand] };
        *other = kept;
        let why = match same_readings(kept) && same_readings(left_out) {
            true => "were computed from the same readings",
            false => "state the same deviations to the last digit",
        };
        let [kept, left_out] = [kept, left_out].map(|stand| &stand.certificate.number);
        remarks.push(format!(
            "certificates {kept} and {left_out} {why}; the deviations of {left_out} are not used for the drift"
        ));
    }
    used
}

fn passports(recorded: &[Recorded], trust: &Trust, now: Timestamp) -> Vec<PastPassport> {
    // Time from which a file is superseded, by its SHA-256.
    let mut superseded: BTreeMap<&str, Timestamp> = BTreeMap::new();
    let mut predecessors: BTreeMap<&str, &str> = BTreeMap::new();
    for (line, content) in recorded.iter().filter_map(|at| Some((&at.line, at.content.as_ref()?))) {
        let header = &content.passport;
        if let Some(from) = &header.reissued_from {
            predecessors.insert(&line.sha256, &from.sha256);
        }
        if let (Some(from), Some(true)) = (&header.reissued_from, header.supersedes) {
            let first = superseded.entry(&from.sha256).or_insert(header.issued_at);
            *first = (*first).min(header.issued_at);
        }
    }
    let mut passports: Vec<PastPassport> = recorded
        .iter()
        .map(|Recorded { line, content }| {
            let header = content.as_ref().map(|content| &content.passport);
            let expired = content.as_ref().and_then(Content::last_day).map(|(last, _)| day(last).1);
            let withdrawn = trust.withdrawn.entry(&line.sha256).map(|entry| entry.revoked_at);
            let ends = [superseded.get(line.sha256.as_str()).copied(), expired, withdrawn];
            let end = header.and(ends.into_iter().flatten().min());
            PastPassport {
                line: line.clone(),
                issued_at: header.map(|header| header.issued_at),
                ended_at: end.filter(|end| *end <= now),
                expires_at: end.filter(|end| *end > now && matches!(line.state, State::InForce | State::Expiring)),
                predecessor: header.and_then(|header| Some(header.reissued_from.as_ref()?.id.clone())),
                reason: header.and_then(|header| Some(header.reissued_from.as_ref()?.reason.clone())),
            }
        })
        .collect();
    let ancestors = |at: &PastPassport| {
        let before = |sha256: &&str| predecessors.get(sha256).copied();
        // A chain cannot be longer than the number of files.
        iter::successors(before(&at.line.sha256.as_str()), before).take(recorded.len()).count()
    };
    passports.sort_by(|a, b| {
        // Of two passports of the same second, the predecessor comes first.
        let key = |at: &PastPassport| (at.issued_at.is_none(), at.issued_at, ancestors(at));
        key(a).cmp(&key(b)).then_with(|| a.line.id.cmp(&b.line.id)).then_with(|| a.line.file.cmp(&b.line.file))
    });
    passports
}

fn places(passports: &[PastPassport]) -> Vec<Stay> {
    let mut places: Vec<Stay> = Vec::new();
    let mut left: BTreeSet<&str> = BTreeSet::new();
    for passport in passports {
        let (Some(from), Some(site)) = (passport.issued_at, &passport.line.site) else { continue };
        // A stand that returns to a site begins a new stay there.
        match places.iter_mut().rfind(|stay| stay.site == *site).filter(|_| !left.remove(site.as_str())) {
            // The passports of a site follow each other, so the later end counts; one without an end is in force.
            Some(stay) => stay.until = stay.until.zip(passport.ended_at).map(|(a, b)| a.max(b)),
            None => places.push(Stay { site: site.clone(), from, until: passport.ended_at }),
        }
        if passport.line.state == State::Moved {
            left.insert(site);
        }
    }
    places
}

fn withdrawals(recorded: &[Recorded], trust: &Trust) -> Vec<Entry> {
    let entries = recorded.iter().filter_map(|at| trust.withdrawn.entry(&at.line.sha256));
    let mut found: Vec<Entry> = entries.cloned().collect();
    found.sort_by(|a, b| (a.revoked_at, &a.id).cmp(&(b.revoked_at, &b.id)));
    found.dedup();
    found
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::stand::Evidence;

    /// Expected: of two certificates from the same readings one is used: the first, or, if both have the date of the
    /// measurement, the one issued last. Other readings, or none stated, are used, unless the deviations are the same.
    #[test]
    fn the_same_readings_count_once() {
        let certificate = |number: &str, performed: &str, readings: Option<&str>| {
            let mut stand = Stand::from_yaml("s", include_bytes!("../../passports/SPS-2/0017/stand.yaml")).unwrap();
            stand.certificate.number = number.to_owned();
            stand.certificate.performed = Some(performed.parse().unwrap());
            let evidence = |digit: &str| Evidence { readings_sha256: digit.repeat(64), runs: 5, excluded: None };
            stand.certificate.evidence = readings.map(evidence);
            stand.positions[0].alpha_arcsec = number[2..].parse::<f64>().unwrap() % 7.0;
            PastCertificate { stand, passports: Vec::new(), counts: true }
        };
        let certificates = [
            certificate("C-1", "2020-06-01", Some("1")),
            certificate("C-2", "2021-06-01", None),
            certificate("C-3", "2022-06-01", Some("1")),
            certificate("C-4", "2023-06-01", None),
            certificate("C-5", "2024-06-01", Some("2")),
            certificate("C-6", "2024-06-01", Some("2")),
            certificate("C-11", "2025-06-01", None),
        ];
        let mut remarks = Vec::new();
        let used = independent(&certificates, &mut remarks);
        let numbers: Vec<&str> = used.iter().map(|stand| stand.certificate.number.as_str()).collect();
        assert_eq!(numbers, ["C-1", "C-2", "C-4", "C-6"]);
        let said = [
            "C-1 and C-3 were computed from the same readings; the deviations of C-3",
            "the deviations of C-5",
            "C-4 and C-11 state the same deviations to the last digit; the deviations of C-11",
        ];
        assert!(
            remarks.len() == 3 && remarks.iter().zip(said).all(|(remark, due)| remark.contains(due)),
            "{remarks:?}"
        );
    }
}
