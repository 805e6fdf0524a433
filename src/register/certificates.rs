//! Certificates under which the passports of a stand were issued. A certificate is superseded if a passport based on it
//! was re-issued under another one. A stand in force under two certificates has two sets of deviations, and so has one
//! whose certificate states other angles in one passport than in another. A certificate with the same angles for two
//! stands is a copy with another serial number.

use super::{Alarm, AlarmKind, Examined};
use crate::stand::CertifiedPosition;
use crate::text::first_few;
use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Certificates of each stand, `<model>/<serial>`, whose passports differ in their certificate or its angles.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Certificates(BTreeMap<String, OfStand>);

#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct OfStand {
    /// Passports in force, by certificate number.
    in_force: BTreeMap<String, Vec<InForce>>,
    /// Number of the replacing certificate and the id of the passport that shows this, by the number of the replaced
    /// one.
    replaced: BTreeMap<String, (String, String)>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct InForce {
    id: String,
    file: String,
    /// Fingerprint of the certified angles.
    angles: u64,
}

impl Certificates {
    /// Collects the certificates from files that are sorted by id and whose states are final.
    pub(super) fn of(files: &[Examined]) -> Self {
        let counted: Vec<&Examined> = files.iter().filter(|file| file.counts && file.issued).collect();
        let of_stand = counted.chunk_by(|a, b| a.line.stand == b.line.stand);
        let of = |file: &Examined| (file.line.certificate.clone(), file.angles);
        let several = of_stand.filter(|files| files.windows(2).any(|pair| of(pair[0]) != of(pair[1])));
        let several = several.map(|files| (files[0].line.stand.clone().unwrap_or_default(), OfStand::of(files)));
        Self(several.collect())
    }

    pub(super) fn alarms(&self) -> Vec<Alarm> {
        self.0.iter().filter_map(|(stand, known)| known.alarm(stand)).collect()
    }

    /// Returns which certificate replaced the one of a stand with this `number`, in words, or `None` if none did.
    pub(super) fn replacement(&self, stand: &str, number: &str) -> Option<String> {
        Some(replaced(number, self.0.get(stand)?.replaced.get(number)?))
    }
}

/// Returns an alarm for each certificate that is in force with the same angles for several stands: no two stands have
/// the same deviations, so one of them has those of the other.
pub(super) fn shared(files: &[Examined]) -> Vec<Alarm> {
    let mut known: BTreeMap<(&str, u64), BTreeMap<&str, Vec<String>>> = BTreeMap::new();
    for file in files.iter().filter(|file| file.counts && file.line.may_be_in_force()) {
        let stands = known.entry((file.certificate(), file.angles)).or_default();
        stands.entry(file.line.stand.as_deref().unwrap_or("")).or_default().push(file.line.file.clone());
    }
    let several = known.into_iter().filter(|(_, stands)| stands.len() > 1);
    let alarm = |((number, _), stands): (_, BTreeMap<&str, Vec<String>>)| {
        let ids: Vec<&str> = stands.keys().copied().collect();
        let words = format!(
            "certificate {number} is in force with the same angles for {} stands, {}; withdraw the passports with the \
             wrong serial number",
            ids.len(),
            first_few(&ids)
        );
        Alarm::of_files(AlarmKind::Certificates, words, stands.into_values().flatten().collect())
    };
    several.map(alarm).collect()
}

impl OfStand {
    fn of(files: &[&Examined]) -> Self {
        let mut known = Self::default();
        let by_sha256: HashMap<&str, &str> =
            files.iter().map(|file| (file.line.sha256.as_str(), file.certificate())).collect();
        // Go through the files in the order of issue, so that a certificate that is used again no longer counts as
        // replaced.
        let mut in_order = files.to_vec();
        in_order.sort_by_key(|file| file.issued_at);
        for file in in_order {
            let (id, number) = (file.line.id.clone().unwrap_or_default(), file.certificate());
            let old = file.superseding().and_then(|from| by_sha256.get(from.sha256.as_str()));
            if let Some(old) = old.filter(|old| **old != number) {
                known.replaced.remove(number);
                known.replaced.insert((*old).to_owned(), (number.to_owned(), id.clone()));
            }
            if file.line.may_be_in_force() {
                let in_force = InForce { id, file: file.line.file.clone(), angles: file.angles };
                known.in_force.entry(number.to_owned()).or_default().push(in_force);
            }
        }
        known
    }

    fn alarm(&self, stand: &str) -> Option<Alarm> {
        let outdated = self.in_force.keys().filter_map(|number| Some(replaced(number, self.replaced.get(number)?)));
        let mut words: Vec<String> = outdated.collect();
        let differ = |of: &[InForce]| of.iter().any(|passport| passport.angles != of[0].angles);
        if words.is_empty() && self.in_force.len() < 2 && !self.in_force.values().any(|of| differ(of)) {
            return None;
        }
        let numbers = self.in_force.iter().map(|(number, of)| match differ(of) {
            false => format!("certificate {number}"),
            true => format!("certificate {number}, with different angles ({})", ids(of)),
        });
        let numbers: Vec<String> = numbers.collect();
        words.insert(0, format!("{stand} has passports in force under {}", numbers.join(" and ")));
        let files = self.in_force.values().flatten().map(|passport| passport.file.clone()).collect();
        Some(Alarm::of_files(AlarmKind::Certificates, words.join("; "), files))
    }
}

/// Returns a number that tells sets of certified angles apart, for comparisons within one run of the program.
pub(super) fn fingerprint(positions: &[CertifiedPosition]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for at in positions {
        (at.index(), at.angles_arcsec().map(f64::to_bits)).hash(&mut hasher);
    }
    hasher.finish()
}

fn ids(passports: &[InForce]) -> String {
    let ids: Vec<&str> = passports.iter().map(|passport| passport.id.as_str()).collect();
    first_few(&ids)
}

fn replaced(number: &str, (by, id): &(String, String)) -> String {
    format!("certificate {number} was replaced by {by} ({id})")
}

impl Examined {
    fn certificate(&self) -> &str {
        self.line.certificate.as_deref().unwrap_or("")
    }
}
