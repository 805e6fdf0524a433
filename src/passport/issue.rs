//! Issue of a signed passport from a certified stand and a site.

use super::annotations::{self, Absence, absent};
use super::content::{Dated, PASSPORT_FORMAT, REFERENCE_GYRO, derive_from, passport_id};
use super::verification::{Known, Question, Trust, Verification, verify_known};
use super::{Content, NAMESPACE, PassportHeader, Predecessor, SelfCheck, Stated, content};
use crate::attitude::Deviation;
use crate::calibration::prediction::{NoiseGrowth, noise_growth};
use crate::coefficients::{Coefficients, Position, SingularPositions, StandGeometry};
use crate::document::{self, Signer, SigningFailed};
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::{self, CertifiedPosition, Stand};
use crate::text::scalar::day;
use crate::text::{LARGEST_DOCUMENT_BYTES, Path, Problems, Unreadable, rule};
use crate::trust::{BadIdentity, Message, SignatureError, check_identity};
use crate::wording::number::Number;
use crate::wording::texts::calibration::warning;
use crate::wording::texts::issued as texts;
use crate::wording::{Language, Words, plain};
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
#[non_exhaustive]
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
        Self {
            issuer: issuer.to_owned(),
            issued_at,
            valid_until: None,
            revision: 1,
            reissued: None,
            accuracy: None,
            allow_uncalibratable: false,
        }
    }
}

/// Reason why a passport was not issued.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IssueRefused {
    /// The matrix n_2 has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularPositions),
    /// The site, a date, the accuracy, the size or the self-check breaks a rule, in words.
    #[error("{0}")]
    Rule(String),
    /// The issuer's name cannot be a principal of allowed_signers.
    #[error(transparent)]
    Identity(#[from] BadIdentity),
    /// The positions do not determine the parameters of a gyro.
    #[error(
        "the positions of the stand do not determine the parameters of a gyro at this site; certify further \
         positions, or issue the passport anyway with --allow-uncalibratable"
    )]
    Uncalibratable,
    /// The text read back differs from the text written: a defect of this program.
    #[error("the text read back differs from the text written; nothing was signed. {0}")]
    ReadBack(Unreadable),
    /// The signer produced no signature.
    #[error(transparent)]
    Signing(#[from] SigningFailed),
    /// The signer produced a wrong signature.
    #[error("verification of the new signature failed: {0}")]
    BadSignature(#[from] SignatureError),
}

/// Returns the time of issue: `asked`, or the time of the `clock` if `asked` is `None`.
///
/// # Errors
/// Returns [`IssueRefused::Rule`] if the time is ahead of the clock. Such a passport would not be valid yet, and no
/// register of today could list it.
pub(crate) fn time_of_issue(asked: Option<Timestamp>, clock: Timestamp) -> Result<Timestamp, IssueRefused> {
    match asked {
        Some(issued_at) if issued_at > clock => Err(IssueRefused::Rule(format!(
            "issued_at {issued_at} is later than the clock, {clock}; specify an earlier time of issue, or omit it"
        ))),
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
        let content = content_of(&self.stand, geometry, site, issue)?;
        check_dates(&content)?;
        // Whenever the positions determine the parameters of a gyro, there is a self-check.
        if !issue.allow_uncalibratable && content.self_check.is_none() {
            return Err(IssueRefused::Uncalibratable);
        }
        let payload = annotations::payload_with(&content, text);
        if payload.len() + LONGEST_SIGNATURE > LARGEST_DOCUMENT_BYTES {
            return Err(IssueRefused::Rule(format!(
                "the passport would have {} bytes, more than the limit of {LARGEST_DOCUMENT_BYTES}; certify fewer positions",
                payload.len()
            )));
        }
        read_back(&payload, &content)?;
        if let Some(self_check) = &content.self_check {
            let error = self_check.error(&content.coefficients());
            if error.is_nan() || error > SelfCheck::LIMIT {
                let (limit, growth) = (SelfCheck::LIMIT, site.uncertainty_growth());
                return Err(IssueRefused::Rule(format!(
                    "the self-check fails: the relative error of a parameter is {error:.1e} (limit {limit:e}); on this stand \
                     at this site the eight positions do not determine the gyro (the uncertainty of K grows as \
                     1/cos(latitude), here {growth:.4})"
                )));
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

fn content_of(stand: &Stand, geometry: &StandGeometry, site: &Site, issue: &Issue) -> Result<Content, IssueRefused> {
    let derived = derive_from(geometry, site, &REFERENCE_GYRO);
    let accuracy = |stated: &Stated| stated.accuracy(&stand.certificate, &stand.positions, site);
    let accuracy = issue.accuracy.as_ref().map(accuracy).transpose();
    let unknown = |why| IssueRefused::Rule(format!("the expected calibration uncertainty cannot be computed: {why}"));
    let (reissued_from, supersedes) =
        issue.reissued.clone().map(|reissued| (reissued.from, reissued.supersedes)).unzip();
    Ok(Content {
        format: PASSPORT_FORMAT.to_owned(),
        passport: PassportHeader {
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
        accuracy: accuracy.map_err(unknown)?,
    })
}

/// Checks the site, because one that was not read from a file, such as that of a predecessor, must obey the same rules.
fn check_site(site: &Site) -> Result<(), IssueRefused> {
    let mut problems = Problems::default();
    site.check_consistency(&Path::Root.key("site"), &mut problems);
    if problems.is_empty() {
        return Ok(());
    }
    Err(IssueRefused::Rule(problems.refuse("the new passport", "").to_string()))
}

fn check_dates(content: &Content) -> Result<(), IssueRefused> {
    let (issued_at, certified) = (content.passport.issued_at, content.certificate.issued);
    let words = match (content.passport.valid_until, content.certificate.valid_until, content.last_day()) {
        _ if issued_at < day(certified).0 => {
            format!("issued_at {issued_at} is earlier than the date of the certificate, {certified} (UTC); check both")
        }
        (Some(passport), Some(certificate), _) if passport > certificate => format!(
            "the passport would be valid until {passport}, but the certificate only until {certificate}; specify an \
             earlier date (--valid-until)"
        ),
        (.., Some((last, document))) if issued_at > day(last).1 => {
            let remedy = match document {
                Dated::Certificate => "have the stand recertified",
                Dated::Passport => "specify a later one (--valid-until)",
            };
            format!("issued_at {issued_at} is later than the expiry date of the {}, {last}; {remedy}", document.word())
        }
        _ => return Ok(()),
    };
    Err(IssueRefused::Rule(words))
}

/// Reads the written text with the verifier's reader and compares its content with the original.
fn read_back(payload: &str, content: &Content) -> Result<(), IssueRefused> {
    const NAME: &str = "the new passport";
    rule::check(NAME, payload.as_bytes(), LARGEST_DOCUMENT_BYTES).map_err(IssueRefused::ReadBack)?;
    let read = content::read(NAME, payload).map_err(IssueRefused::ReadBack)?;
    if read != *content {
        let fault = Unreadable::whole(NAME, None, "other content", "the content that was written", "");
        return Err(IssueRefused::ReadBack(fault));
    }
    Ok(())
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

    /// Signs the text and verifies the file at the time of issue, as every reader will. The text was read back when it was
    /// drafted, and is hashed once.
    ///
    /// # Errors
    /// Returns [`IssueRefused::Signing`] if the signer fails. The verification says whether the file is valid.
    pub(crate) fn sign_and_verify(
        &self,
        name: &str,
        signer: &dyn Signer,
        trust: &Trust,
    ) -> Result<(String, Verification), IssueRefused> {
        let message = Message::new(NAMESPACE, self.payload.as_bytes());
        let text = document::join(&self.payload, &signer.sign_message(&message)?);
        let question = Question::at(self.content.passport.issued_at);
        let known = Known { message: &message, content: &self.content };
        let verification = verify_known(name, text.as_bytes(), Some(known), trust, &question);
        Ok((text, verification))
    }

    /// Computes remarks on the passport for the factory: noise of a calibration relative to the ideal stand, missing
    /// statements, and the growth of the uncertainty of K with latitude.
    pub fn remarks(&self) -> Remarks {
        let content = &self.content;
        let meter = (&Laboratory::paper().meter).into();
        let gyro = GyroType::gvk_6().nominal.to_model();
        let noise = self.ideal.as_ref().and_then(|ideal| noise_growth(&content.coefficients(), ideal, &gyro, meter));
        let odd = stand::remarks::of(&content.certificate, &content.positions);
        let mut odd: Vec<String> = odd.into_iter().map(|odd| odd.sentence).collect();
        odd.extend(content.certificate.odd_number());
        odd.extend(content.site.odd());
        let (positions, gravity) = (content.coefficients().positions, content.earth.gravity_m_per_s2);
        odd.extend(content.accuracy.as_ref().and_then(|accuracy| accuracy.beyond_range(&positions, gravity)));
        Remarks { noise, uncertainty_growth: content.site.uncertainty_growth(), odd, missing: absent(content) }
    }
}

/// Noise growth relative to the ideal stand from which the factory is warned.
const NOISE_WARNING: f64 = 2.0;

/// Growth of K's uncertainty towards the poles above which the factory is warned.
const POLAR_WARNING: f64 = 3.0;

/// Remarks for the factory to read before it delivers a passport.
#[derive(Debug, Clone, PartialEq)]
pub struct Remarks {
    /// Noise relative to the ideal stand; `None` if the positions do not determine all parameters.
    pub(crate) noise: Option<NoiseGrowth>,
    /// Growth of the uncertainty with latitude, 1/cos Φ.
    pub uncertainty_growth: f64,
    /// Implausible statements of certificate, site and accuracy, one sentence each.
    pub odd: Vec<String>,
    /// Missing statements, from which a page or a terminal makes sentences with symbols of units.
    pub(crate) missing: Vec<Absence>,
}

impl Remarks {
    /// Returns the missing statements and their effects, one sentence each in ASCII.
    pub fn absences(&self) -> Vec<String> {
        self.missing.iter().map(Absence::to_string).collect()
    }

    /// Returns warnings for the factory, and the inputs that the passport does not state, one sentence each in English.
    pub(crate) fn words(&self) -> Vec<String> {
        let warnings = self.warnings().into_iter().map(|words| plain(&warning(words).plain(Language::English)));
        warnings.chain(self.absences()).collect()
    }

    /// Returns warnings for the factory, one sentence each.
    pub(crate) fn warnings(&self) -> Vec<Words> {
        let noise = match &self.noise {
            None => Some(texts::NOT_DETERMINED.into()),
            Some(growth) if growth.worst() > NOISE_WARNING => Some(texts::noisy(Number::fixed(growth.worst(), 2))),
            Some(_) => None,
        };
        let is_near_the_pole = self.uncertainty_growth > POLAR_WARNING;
        let polar = is_near_the_pole.then(|| texts::polar(Number::scientific(self.uncertainty_growth, 2)));
        let odd = self.odd.iter().map(|odd| Words::Given(odd.clone()));
        noise.into_iter().chain(polar).chain(odd).collect()
    }
}
