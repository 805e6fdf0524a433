//! One stand over the years: its certificates, passports, places and withdrawals, and the drift of its deviations.
//!
//! `drift`: the deviations of all certificates, also relative to each other, and the test of whether they drift.
//!
//! A history is a function of verified registers and of their passports; [`crate::folder`] finds the files.

pub(crate) mod drift;

use crate::passport::Content;
use crate::register::{Row, State};
use crate::stand::Stand;
use crate::text::first_few;
use crate::text::scalar::day;
use drift::Drift;
use jiff::Timestamp;
use serde::Serialize;
use std::collections::BTreeSet;

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

/// Passport of the stand: its entry in the register, and what its file adds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct PastPassport {
    pub row: Row,
    /// Time from which the passport was no longer in force: superseded, moved, expired or withdrawn; `None` if it still is.
    pub ended_at: Option<Timestamp>,
    /// Time at which a passport in force expires, if it does; for pictures.
    pub expires_at: Option<Timestamp>,
    pub predecessor: Option<String>,
    /// Reason for the re-issue.
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
    /// Change of the deviations over the years.
    pub drift: Drift,
    /// Alarms of the register that concern the stand, and remarks on its certificates, in words.
    pub remarks: Vec<String>,
}

/// Passport of the stand: its entry in the register, and its content if its file is the listed one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recorded {
    pub row: Row,
    pub content: Option<Content>,
}

impl History {
    /// Creates the history of a stand, `<model>/<serial>`, from its passports; `alarms` are those of its register, in words.
    pub(crate) fn of(stand: &str, recorded: Vec<Recorded>, alarms: Vec<String>, now: Timestamp) -> Self {
        let mut remarks = alarms;
        let certificates = certificates(&recorded, &mut remarks);
        let passports = passports(&recorded, now);
        let drift = Drift::of(&independent(&certificates, &mut remarks));
        Self { stand: stand.to_owned(), places: places(&passports), certificates, passports, drift, remarks }
    }

    /// Returns the withdrawn passports, in the order of their withdrawal.
    pub(crate) fn withdrawals(&self) -> Vec<&Row> {
        let rows = self.passports.iter().map(|passport| &passport.row);
        let mut found: Vec<&Row> = rows.filter(|row| row.state == State::Withdrawn).collect();
        found.sort_by_key(|row| (row.since, &row.id));
        found
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
        let counts = at.row.state != State::Withdrawn;
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

fn passports(recorded: &[Recorded], now: Timestamp) -> Vec<PastPassport> {
    let past = recorded.iter().map(|Recorded { row, content }| {
        let from = content.as_ref().and_then(|content| content.passport.reissued_from.as_ref());
        let end = [row.since, row.valid_until.map(|last| day(last).1)].into_iter().flatten().min();
        PastPassport {
            row: row.clone(),
            ended_at: end.filter(|end| *end <= now),
            expires_at: end.filter(|end| *end > now && row.is_in_force()),
            predecessor: from.map(|from| from.id.clone()),
            reason: from.map(|from| from.reason.clone()),
        }
    });
    let mut passports: Vec<PastPassport> = past.collect();
    // Of two passports of the same second, the one that was listed first, which the register keeps in order.
    passports.sort_by_key(|passport| passport.row.issued_at);
    passports
}

fn places(passports: &[PastPassport]) -> Vec<Stay> {
    let mut places: Vec<Stay> = Vec::new();
    let mut left: BTreeSet<&str> = BTreeSet::new();
    for passport in passports {
        let (from, site) = (passport.row.issued_at, &passport.row.site);
        // A stand that returns to a site begins a new stay there.
        match places.iter_mut().rfind(|stay| stay.site == *site).filter(|_| !left.remove(site.as_str())) {
            // The passports of a site follow each other, so the later end counts; one without an end is in force.
            Some(stay) => stay.until = stay.until.zip(passport.ended_at).map(|(a, b)| a.max(b)),
            None => places.push(Stay { site: site.clone(), from, until: passport.ended_at }),
        }
        if passport.row.state == State::Moved {
            left.insert(site);
        }
    }
    places
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
