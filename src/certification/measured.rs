//! Evaluation of one file of readings: a new certificate, a check against an earlier one, or the record of an earlier one.

use super::{AngleReadings, Certification, Comparison, Header, NotCertified, NotCompared, certify, compare, predicted};
use crate::document::sha256_hex;
use crate::stand::{Excluded, Stand};
use crate::text::{Printable, Unreadable};

/// Reason why a file of readings was not evaluated.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotMeasured {
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
    #[error(transparent)]
    NotCertified(#[from] NotCertified),
    #[error(transparent)]
    NotCompared(#[from] NotCompared),
    /// Number of a certificate that does not follow from its readings.
    #[error(
        "certificate {} states other numbers than follow from its readings; it was changed by hand", Printable(.0)
    )]
    Altered(String),
    #[error("missing --stand or --against")]
    NoHeader,
}

/// Readings, certified and compared with an earlier certificate.
pub(crate) struct Measured {
    pub certified: Result<Certification, NotCertified>,
    /// `None` without an earlier certificate, and for the certificate of these readings.
    pub comparison: Option<Comparison>,
    /// `true` if the earlier certificate is that of these readings.
    pub is_own: bool,
    /// Remark on the columns of the file.
    pub remark: Option<String>,
}

impl Measured {
    /// Certifies the readings of a file with a header, or as the stand `against` which they are compared with. With
    /// `again`, a certificate that these readings were made into is certified again from them, with what it excluded.
    ///
    /// # Errors
    /// Returns [`NotMeasured`] if the readings cannot be read or compared, or if their certificate states other numbers.
    pub(crate) fn new(
        header: Option<Header>,
        against: Option<&Stand>,
        (name, bytes): (&str, &[u8]),
        mut excluded: Vec<Excluded>,
        again: bool,
    ) -> Result<Self, NotMeasured> {
        let evidence = against.and_then(|stand| stand.certificate.evidence.as_ref());
        let own = evidence.filter(|evidence| evidence.readings_sha256 == sha256_hex(bytes));
        let own = own.filter(|_| again && header.is_none());
        let header = match (header, against) {
            (Some(header), _) => header,
            (None, Some(stand)) if own.is_some() => {
                Header { certificate: stand.certificate.clone(), ..Header::from(stand) }
            }
            (None, Some(stand)) => Header::from(stand),
            (None, None) => return Err(NotMeasured::NoHeader),
        };
        if let Some(evidence) = own {
            excluded = evidence.excluded.clone().unwrap_or_default();
        }
        let earlier = against.filter(|_| own.is_none());
        let readings = AngleReadings::from_csv_without(name, bytes, &header.positions, &excluded, earlier)?;
        let remark = readings.remark.clone();
        let (readings, _) = predicted(&header, &readings)?;
        let certified = certify(&header, &readings);
        if let (Some(_), Some(stand), Ok(again)) = (own, against, &certified)
            && again.stand != *stand
        {
            return Err(NotMeasured::Altered(stand.certificate.number.clone()));
        }
        let comparison = earlier.map(|stand| compare(stand, &header, &readings, certified.as_ref().ok()));
        Ok(Self { certified, comparison: comparison.transpose()?, is_own: own.is_some(), remark })
    }
}
