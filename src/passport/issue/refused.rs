//! Why a passport is not issued.

use crate::coefficients::SingularPositions;
use crate::document::SigningFailed;
use crate::passport::accuracy::NoAccuracy;
use crate::passport::content::{Dated, SELF_CHECK_LIMIT};
use crate::text::{LARGEST_DOCUMENT_BYTES, Unreadable};
use crate::trust::{BadIdentity, SignatureError};
use jiff::Timestamp;
use jiff::civil::Date;

/// Why no passport was issued.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IssueRefused {
    /// n_2 has no inverse.
    #[error(transparent)]
    Singular(#[from] SingularPositions),
    /// The issue is dated before the certificate.
    #[error("issued_at {issued_at} is earlier than the date of the certificate, {certified}; check the clock")]
    BeforeCertificate {
        /// When the passport would be issued.
        issued_at: Timestamp,
        /// When the certificate was.
        certified: Date,
    },
    /// The issue is dated ahead of the clock.
    #[error(
        "issued_at {issued_at} is more than one day later than the clock, {clock}; specify the time of issue, or omit \
         it"
    )]
    AheadOfClock {
        /// The time of issue that was asked for.
        issued_at: Timestamp,
        /// The time by the clock.
        clock: Timestamp,
    },
    /// The passport would outlast its certificate.
    #[error(
        "the passport would be valid until {passport}, but the certificate only until {certificate}; specify an \
             earlier date"
    )]
    BeyondCertificate {
        /// The last day of the passport that was asked for.
        passport: Date,
        /// The last day of the certificate.
        certificate: Date,
    },
    /// The passport would have ended before it began.
    #[error(
        "issued_at {issued_at} is later than {last}, until which the {document} is valid; {}",
        if *document == Dated::Certificate { "have the stand recertified" } else { "specify a later date" }
    )]
    AlreadyExpired {
        /// When the passport would be issued.
        issued_at: Timestamp,
        /// The earlier one of the two last days.
        last: Date,
        /// The document that ends on this day.
        document: Dated,
    },
    /// The statements of the site contradict each other.
    #[error("{0}")]
    ImplausibleSite(Unreadable),
    /// What the stand is good for cannot be stated.
    #[error("the expected calibration uncertainty cannot be computed: {0}")]
    Accuracy(#[from] NoAccuracy),
    /// The issuer's name is none that allowed signers could give a key to.
    #[error(transparent)]
    Identity(#[from] BadIdentity),
    /// No set of currents in these positions gives the parameters of a gyro.
    #[error(
        "the positions of the stand do not determine the parameters of a gyro at this site; certify further \
         positions, or issue the passport anyway with --allow-uncalibratable"
    )]
    Uncalibratable,
    /// The self-check does not give its own parameters back.
    #[error(
        "the self-check fails: the relative error of a parameter is {error:.1e} (limit {SELF_CHECK_LIMIT:e}); on this \
         stand at this site the eight positions do not determine the gyro (the uncertainty of K grows as \
         1/cos(latitude), here {growth:.4})"
    )]
    SelfCheckFails {
        /// How far the worst parameter is off, relative to its size.
        error: f64,
        /// 1/cos Φ, which is large near the poles.
        growth: f64,
    },
    /// The passport would be larger than any verifier reads.
    #[error(
        "the passport would have {bytes} bytes, more than the limit of {LARGEST_DOCUMENT_BYTES}; certify fewer \
         positions"
    )]
    TooLarge {
        /// Its size, the signature aside.
        bytes: usize,
    },
    /// The text, read again, is not what was written: a defect of this program.
    #[error("the text read back differs from the text written; nothing was signed. {0}")]
    ReadBack(Unreadable),
    /// The signer gave no signature.
    #[error(transparent)]
    Signing(#[from] SigningFailed),
    /// The signer gave a signature that does not hold.
    #[error("verification of the new signature failed: {0}")]
    BadSignature(#[from] SignatureError),
}
