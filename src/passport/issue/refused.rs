//! Reasons why a passport is not issued.

use crate::coefficients::SingularPositions;
use crate::document::SigningFailed;
use crate::passport::accuracy::NoAccuracy;
use crate::passport::content::{Dated, SelfCheck};
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable};
use crate::trust::{BadIdentity, SignatureError};
use jiff::Timestamp;
use jiff::civil::Date;

/// Reason why a passport was not issued.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IssueRefused {
    /// The matrix n_2 has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularPositions),
    /// The time of issue is earlier than the date of the certificate.
    #[error("issued_at {issued_at} is earlier than the date of the certificate, {certified} (UTC); check both")]
    BeforeCertificate {
        /// Time of issue.
        issued_at: Timestamp,
        /// Date of the certificate.
        certified: Date,
    },
    /// The time of issue is ahead of the clock.
    #[error(
        "issued_at {issued_at} is more than one day later than the clock, {clock}; specify the time of issue, or omit \
         it"
    )]
    AheadOfClock {
        /// Requested time of issue.
        issued_at: Timestamp,
        /// Time of the clock.
        clock: Timestamp,
    },
    /// The passport would be valid longer than its certificate.
    #[error(
        "the passport would be valid until {passport}, but the certificate only until {certificate}; specify an \
             earlier date"
    )]
    BeyondCertificate {
        /// Requested expiry date of the passport.
        passport: Date,
        /// Expiry date of the certificate.
        certificate: Date,
    },
    /// The time of issue is later than the expiry date.
    #[error(
        "issued_at {issued_at} is later than {last}, until which the {} is valid; {}",
        document.word(),
        if *document == Dated::Certificate { "have the stand recertified" } else { "specify a later date" }
    )]
    AlreadyExpired {
        /// Time of issue.
        issued_at: Timestamp,
        /// Earlier of the two expiry dates.
        last: Date,
        /// Document with that expiry date.
        document: Dated,
    },
    /// The statements of the site contradict each other.
    #[error("{0}")]
    ImplausibleSite(Unreadable),
    /// The expected calibration uncertainty cannot be computed.
    #[error("the expected calibration uncertainty cannot be computed: {0}")]
    Accuracy(#[from] NoAccuracy),
    /// The issuer's name cannot be a principal of allowed_signers.
    #[error(transparent)]
    Identity(#[from] BadIdentity),
    /// The positions do not determine the parameters of a gyro.
    #[error(
        "the positions of the stand do not determine the parameters of a gyro at this site; certify further \
         positions, or issue the passport anyway with --allow-uncalibratable"
    )]
    Uncalibratable,
    /// The self-check does not reproduce its own parameters.
    #[error(
        "the self-check fails: the relative error of a parameter is {error:.1e} (limit {limit:e}); on this stand at this \
         site the eight positions do not determine the gyro (the uncertainty of K grows as 1/cos(latitude), here \
         {growth:.4})",
        limit = SelfCheck::LIMIT
    )]
    SelfCheckFails {
        /// Largest relative error of a parameter.
        error: f64,
        /// Growth of the uncertainty, 1/cos Φ, which is large near the poles.
        growth: f64,
    },
    /// The passport would have this many bytes without its signature, more than verifiers accept.
    #[error(
        "the passport would have {0} bytes, more than the limit of {LARGEST_DOCUMENT_BYTES}; certify fewer \
         positions"
    )]
    TooLarge(usize),
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
