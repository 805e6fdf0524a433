//! Issue of a signed passport from a certified stand and a site.

mod refused;
mod remarks;

pub use refused::IssueRefused;
pub use remarks::Remarks;

use super::annotations::{self, absences};
use super::content::{PASSPORT_FORMAT, REFERENCE_GYRO, derive_from, passport_id};
use super::{Content, Header, NAMESPACE, Predecessor, SelfCheck, Stated, read};
use crate::attitude::Deviation;
use crate::calibration::prediction::noise_growth;
use crate::coefficients::{Coefficients, Position, SingularPositions, StandGeometry};
use crate::document::{self, Signer};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::{self, CertifiedPosition, Stand};
use crate::text::scalar::day;
use crate::text::{LARGEST_DOCUMENT_BYTES, Path, Problems, Unreadable, rule};
use crate::trust::check_identity;
use jiff::Timestamp;
use jiff::civil::Date;

/// Upper limit for the size of an armored signature, bytes. Usual signatures need a quarter of it; those of tokens,
/// which include an application string, need more, but less than the limit.
const LONGEST_SIGNATURE: usize = 2000;

/// Link from a re-issued passport to its predecessor.
#[derive(Debug, Clone, PartialEq)]
pub struct Reissued {
    /// Identifier of the predecessor and SHA-256 of its file.
    pub from: Predecessor,
    /// Whether the new passport supersedes its predecessor.
    pub supersedes: bool,
}

/// Issuer, dates and options of a new passport.
#[derive(Debug, Clone, PartialEq)]
pub struct Issue {
    /// Issuer: a principal of allowed_signers.
    pub issuer: String,
    /// Time of issue, whole seconds.
    pub issued_at: Timestamp,
    /// Expiry date of the passport (inclusive); that of the certificate if `None`.
    pub valid_until: Option<Date>,
    /// Revision, from 1 for each site of a stand.
    pub revision: u32,
    /// Link to the predecessor of a re-issue; `None` for a first issue.
    pub reissued: Option<Reissued>,
    /// Gyro type and laboratory for which the passport states the expected calibration uncertainty; not stated if
    /// `None`.
    pub accuracy: Option<Stated>,
    /// Whether to issue a passport even if its positions do not determine the parameters of a gyro.
    pub allow_uncalibratable: bool,
}

impl Issue {
    /// Creates an issue with revision 1 that expires with the certificate.
    pub fn first(issuer: &str, issued_at: Timestamp) -> Self {
        let issuer = issuer.to_owned();
        Self {
            issuer,
            issued_at,
            valid_until: None,
            revision: 1,
            reissued: None,
            accuracy: None,
            allow_uncalibratable: false,
        }
    }
}

/// Returns the time of issue: `asked`, or the time of the `clock` if `asked` is `None`.
///
/// # Errors
/// Returns [`IssueRefused::AheadOfClock`] if the time is more than a day ahead of the clock. Such a passport would not
/// be valid yet, and would rank as later than every passport issued until then.
pub(crate) fn time_of_issue(asked: Option<Timestamp>, clock: Timestamp) -> Result<Timestamp, IssueRefused> {
    const DAY_S: i64 = 86_400;
    match asked {
        Some(issued_at) if issued_at.as_second() - clock.as_second() > DAY_S => {
            Err(IssueRefused::AheadOfClock { issued_at, clock })
        }
        asked => Ok(asked.unwrap_or(clock)),
    }
}

/// Unsigned passport, checked and ready to be signed.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    content: Content,
    payload: String,
    /// Coefficients of the stand without deviations, if it has any.
    ideal: Option<Coefficients>,
}

/// Certified stand with the parts that all of its passports share: its geometry, without deviations too, and its part of
/// the text.
///
/// They are computed once. Every passport is the same as if they had been computed for it alone.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedStand {
    stand: Stand,
    geometry: Result<(StandGeometry, String), SingularPositions>,
    ideal: Option<StandGeometry>,
}

impl PreparedStand {
    /// Prepares a stand. If n_2 has no inverse, [`PreparedStand::draft`] returns that error for every site.
    pub fn new(stand: Stand) -> Self {
        let geometry = stand::geometry(&stand.positions).map(|geometry| {
            let text = annotations::payload_of_stand(&stand, geometry.has_eight());
            (geometry, text)
        });
        let ideal = |at: &CertifiedPosition| Position { deviation: Deviation::default(), ..at.to_model() };
        let ideal: Vec<Position> = stand.positions.iter().map(ideal).collect();
        Self { stand, geometry, ideal: StandGeometry::new(&ideal).ok() }
    }

    pub(crate) fn stand(&self) -> &Stand {
        &self.stand
    }

    /// Returns the part of the payload that is the same at every site; empty if n_2 has no inverse.
    pub(crate) fn text(&self) -> &str {
        self.geometry.as_ref().map_or("", |(_, text)| text)
    }

    /// Computes all numbers of the passport at `site`, writes the text, and reads it back as a check.
    ///
    /// # Errors
    /// Returns [`IssueRefused`] if an input breaks a rule, the self-check fails, or the text read back differs.
    pub fn draft(&self, site: &Site, issue: &Issue) -> Result<Draft, IssueRefused> {
        check_identity(&issue.issuer)?;
        check_site(site)?;
        let (geometry, text) = self.geometry.as_ref().map_err(|singular| *singular)?;
        let content = content(&self.stand, geometry, site, issue)?;
        check_dates(&content)?;
        // Whenever the positions determine the parameters of a gyro, there is a self-check.
        if !issue.allow_uncalibratable && content.self_check.is_none() {
            return Err(IssueRefused::Uncalibratable);
        }
        let payload = annotations::payload_with(&content, text);
        if payload.len() + LONGEST_SIGNATURE > LARGEST_DOCUMENT_BYTES {
            return Err(IssueRefused::TooLarge(payload.len()));
        }
        let read_back = read_back(&payload, &content)?;
        if let Some(self_check) = &read_back.self_check {
            let error = self_check.error(&read_back.coefficients());
            if error.is_nan() || error > SelfCheck::LIMIT {
                return Err(IssueRefused::SelfCheckFails { error, growth: site.uncertainty_growth() });
            }
        }
        let ideal = self.ideal.as_ref().map(|ideal| ideal.at(content.earth.rate(site)));
        Ok(Draft { content, payload, ideal })
    }
}

/// Drafts the passport of a stand for one site; for many sites, use [`PreparedStand::draft`].
///
/// # Errors
/// Returns the errors of [`PreparedStand::draft`].
pub fn draft(stand: &Stand, site: &Site, issue: &Issue) -> Result<Draft, IssueRefused> {
    PreparedStand::new(stand.clone()).draft(site, issue)
}

fn content(stand: &Stand, geometry: &StandGeometry, site: &Site, issue: &Issue) -> Result<Content, IssueRefused> {
    let derived = derive_from(geometry, site, &REFERENCE_GYRO);
    let accuracy = |stated: &Stated| stated.accuracy(&stand.certificate, &stand.positions, site);
    let accuracy = issue.accuracy.as_ref().map(accuracy);
    let (reissued_from, supersedes) =
        issue.reissued.clone().map(|reissued| (reissued.from, reissued.supersedes)).unzip();
    Ok(Content {
        format: PASSPORT_FORMAT.to_owned(),
        passport: Header {
            id: passport_id(&stand.stand, &site.id, issue.revision),
            revision: issue.revision,
            issued_at: issue.issued_at,
            issuer: issue.issuer.clone(),
            valid_until: issue.valid_until.or(stand.certificate.valid_until),
            issued_with: Some(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).to_owned()),
            reissued_from,
            supersedes,
        },
        stand: stand.stand.clone(),
        certificate: stand.certificate.clone(),
        datum: stand.datum.clone(),
        positions: stand.positions.clone(),
        site: site.clone(),
        earth: derived.earth,
        matrices: derived.matrices,
        vectors: derived.vectors,
        self_check: derived.self_check,
        accuracy: accuracy.transpose()?,
    })
}

/// Checks the site, because one that was not read from a file, such as that of a predecessor, must obey the same rules.
fn check_site(site: &Site) -> Result<(), IssueRefused> {
    let mut problems = Problems::new();
    site.check_consistency(&Path::Root.key("site"), &mut problems);
    if problems.is_empty() {
        return Ok(());
    }
    Err(IssueRefused::ImplausibleSite(problems.refuse("the new passport", "")))
}

fn check_dates(content: &Content) -> Result<(), IssueRefused> {
    let issued_at = content.passport.issued_at;
    let certified = content.certificate.issued;
    if issued_at < day(certified).0 {
        return Err(IssueRefused::BeforeCertificate { issued_at, certified });
    }
    if let (Some(passport), Some(certificate)) = (content.passport.valid_until, content.certificate.valid_until)
        && passport > certificate
    {
        return Err(IssueRefused::BeyondCertificate { passport, certificate });
    }
    match content.last_day() {
        Some((last, document)) if issued_at > day(last).1 => {
            Err(IssueRefused::AlreadyExpired { issued_at, last, document })
        }
        _ => Ok(()),
    }
}

/// Reads the written text with the verifier's reader and compares its content with the original.
fn read_back(payload: &str, content: &Content) -> Result<Content, IssueRefused> {
    const NAME: &str = "the new passport";
    rule::check(NAME, payload.as_bytes()).map_err(IssueRefused::ReadBack)?;
    let read = read::content(NAME, payload).map_err(IssueRefused::ReadBack)?;
    if read != *content {
        let fault = Unreadable::whole(NAME, None, "other content", "the content that was written", "");
        return Err(IssueRefused::ReadBack(fault));
    }
    Ok(read)
}

impl Draft {
    /// Returns the content of the passport.
    pub fn content(&self) -> &Content {
        &self.content
    }

    /// Returns the text to be signed.
    pub fn payload(&self) -> &str {
        &self.payload
    }

    /// Signs the text, verifies the new signature, and returns the whole file.
    ///
    /// # Errors
    /// Returns [`IssueRefused::Signing`] if the signer fails, and [`IssueRefused::BadSignature`] if its signature is
    /// wrong.
    pub fn sign(&self, signer: &dyn Signer) -> Result<String, IssueRefused> {
        document::sign(&self.payload, NAMESPACE, signer)
    }

    /// Computes remarks on the passport for the factory: noise of a calibration relative to the ideal stand, missing
    /// statements, and the growth of the uncertainty of K with latitude.
    pub fn remarks(&self) -> Remarks {
        let content = &self.content;
        let meter = (&Laboratory::paper().meter).into();
        let gyro = GyroType::gvk_6().nominal.to_model();
        let noise = self.ideal.as_ref().and_then(|ideal| noise_growth(&content.coefficients(), ideal, &gyro, meter));
        let odd = stand::remarks::of(&content.certificate, &content.positions);
        let mut odd: Vec<String> = odd.iter().map(ToString::to_string).collect();
        odd.extend(content.site.odd());
        odd.extend(content.accuracy.as_ref().and_then(|accuracy| accuracy.beyond_range(content)));
        Remarks { noise, uncertainty_growth: content.site.uncertainty_growth(), odd, absences: absences(content) }
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::passport::content::derive;

    const STANDS: [&str; 2] =
        [include_str!("../../passports/SPS-1/0203/stand.yaml"), include_str!("../../passports/SPS-2/0017/stand.yaml")];
    const SITES: [&str; 3] = [
        include_str!("../../sites/moscow-bmstu.yaml"),
        include_str!("../../sites/ny-alesund-kartverket.yaml"),
        include_str!("../../sites/singapore-nus.yaml"),
    ];

    /// The shipped stands, and reduced copies of each: no datum, seven positions, no optional statement.
    fn stands() -> Vec<Stand> {
        let variants = |number: usize| {
            let (stand, _) = read(number, 0);
            let without_datum = Stand { datum: None, ..stand.clone() };
            let mut seven = stand.clone();
            seven.positions.remove(3);
            let mut bare = stand.clone();
            bare.certificate.repeatability_arcsec = None;
            bare.certificate.traceability = None;
            bare.certificate.valid_until = None;
            bare.certificate.valid_until_basis = None;
            bare.positions.iter_mut().for_each(|position| position.u_beta_arcsec = None);
            [stand, without_datum, seven, bare]
        };
        (0..STANDS.len()).flat_map(variants).collect()
    }

    fn read(stand: usize, site: usize) -> (Stand, Site) {
        let stand = Stand::from_yaml("stand", STANDS[stand].as_bytes()).unwrap();
        (stand, Site::from_yaml("site", SITES[site].as_bytes()).unwrap())
    }

    fn order() -> Issue {
        Issue::first("factory@example.org", "2026-11-09T08:00:00Z".parse().unwrap())
    }

    #[test]
    fn what_a_stand_has_in_common_is_what_each_passport_would_find() {
        for stand in stands() {
            let prepared = PreparedStand::new(stand.clone());
            for number in 0..SITES.len() {
                let (_, site) = read(0, number);
                let draft = prepared.draft(&site, &order()).unwrap();
                assert_eq!(draft.payload(), annotations::payload(draft.content()));
                let alone = derive(&stand.positions, &site, &REFERENCE_GYRO).unwrap();
                let content = draft.content().clone();
                assert_eq!((content.earth, content.matrices), (alone.earth, alone.matrices));
                assert_eq!((content.vectors, content.self_check), (alone.vectors, alone.self_check));
            }
        }
    }

    /// Expected: a day of 86,400 seconds is allowed, a second more is not.
    #[test]
    fn nothing_is_issued_more_than_a_day_ahead_of_the_clock() {
        let clock = "2026-11-09T08:00:00Z".parse().unwrap();
        assert_eq!(time_of_issue(None, clock), Ok(clock));
        for good in ["1970-01-01T00:00:07Z", "2026-11-10T08:00:00Z"] {
            assert_eq!(time_of_issue(Some(good.parse().unwrap()), clock), Ok(good.parse().unwrap()));
        }
        for bad in ["2026-11-10T08:00:01Z", "2036-11-09T08:00:00Z"] {
            let refused = IssueRefused::AheadOfClock { issued_at: bad.parse().unwrap(), clock };
            assert_eq!(time_of_issue(Some(bad.parse().unwrap()), clock), Err(refused));
        }
    }

    #[test]
    fn no_passport_outlasts_its_certificate() {
        let (stand, site) = read(1, 0);
        let mut endless = stand.clone();
        (endless.certificate.valid_until, endless.certificate.valid_until_basis) = (None, None);
        let last_day = |day: &str| Issue { valid_until: Some(day.parse().unwrap()), ..order() };
        // The certificate ends on 2028-11-01.
        draft(&stand, &site, &last_day("2028-11-01")).unwrap();
        let refused = draft(&stand, &site, &last_day("2028-11-02"));
        assert!(matches!(refused, Err(IssueRefused::BeyondCertificate { .. })), "{refused:?}");
        draft(&endless, &site, &last_day("2038-11-02")).unwrap();
    }

    /// Expected: three positions give six readings, fewer than the eight parameters; seven give fourteen.
    #[test]
    fn a_stand_that_determines_no_gyro_is_issued_on_request_alone() {
        let (whole, site) = read(1, 0);
        let with = |positions: usize| Stand { positions: whole.positions[..positions].to_vec(), ..whole.clone() };
        let all_the_same = Issue { allow_uncalibratable: true, ..order() };
        draft(&with(7), &site, &order()).unwrap();
        for few in [1, 2, 3] {
            assert_eq!(draft(&with(few), &site, &order()), Err(IssueRefused::Uncalibratable), "{few}");
            draft(&with(few), &site, &all_the_same).unwrap();
        }
    }

    /// All positions have the same orientation, so n_2 is zero.
    #[test]
    fn a_stand_without_passports_says_so_for_each() {
        let (mut stand, site) = read(0, 0);
        for position in &mut stand.positions {
            (position.theta_deg, position.phi_deg) = (0.0, 0.0);
            (position.alpha_arcsec, position.beta_arcsec, position.gamma_arcsec) = (0.0, 0.0, 0.0);
        }
        let prepared = PreparedStand::new(stand);
        for _ in 0..2 {
            assert!(matches!(prepared.draft(&site, &order()), Err(IssueRefused::Singular(_))));
        }
    }
}
