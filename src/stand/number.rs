//! The number of a certificate, which is never used for other angles.

use super::{CertifiedPosition, Stand};
use crate::coefficients::PositionIndex;

/// Certificate number that is already used for other angles.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "certificate {number} already states other angles for this stand, first for position {index}; give the new \
     certificate its own number and dates"
)]
pub struct NumberInUse {
    /// Number of the certificate.
    pub number: String,
    /// First position with other angles.
    pub index: PositionIndex,
}

impl Stand {
    /// Checks that the certificate does not use the number of an existing one, `there`, for other angles.
    ///
    /// # Errors
    /// Returns [`NumberInUse`] if it does.
    pub(crate) fn check_number(&self, there: &Self) -> Result<(), NumberInUse> {
        let number = &self.certificate.number;
        if *number != there.certificate.number {
            return Ok(());
        }
        let kept = |at: &CertifiedPosition, among: &[CertifiedPosition]| {
            among.iter().any(|other| other.index() == at.index() && other.angles_arcsec() == at.angles_arcsec())
        };
        let new = self.positions.iter().find(|at| !kept(at, &there.positions));
        match new.or_else(|| there.positions.iter().find(|at| !kept(at, &self.positions))) {
            Some(at) => Err(NumberInUse { number: number.clone(), index: at.index() }),
            None => Ok(()),
        }
    }

    /// Checks the number as [`Self::check_number`] does, against that of a stand file from which nothing need have been issued:
    /// from the same readings it may be certified anew, because other exclusions give other angles.
    ///
    /// # Errors
    /// Returns [`NumberInUse`] if other readings gave other angles.
    pub(crate) fn check_number_of_file(&self, there: &Self) -> Result<(), NumberInUse> {
        let evidence = |stand: &Self| stand.certificate.evidence.clone();
        let same_readings = evidence(there).is_some() && evidence(there) == evidence(self);
        if same_readings { Ok(()) } else { self.check_number(there) }
    }
}
