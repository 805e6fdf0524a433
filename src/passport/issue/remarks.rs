//! Remarks on a new passport, for the factory to read before it delivers it.

use crate::calibration::prediction::NoiseGrowth;

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
    /// Missing statements and their effects, one sentence each.
    pub absences: Vec<String>,
}

impl Remarks {
    /// Returns warnings for the factory, and the inputs that the passport does not state, one sentence each.
    pub(crate) fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        match &self.noise {
            None => words.push(
                "WARNING: least squares cannot determine all parameters of a gyro from these positions at this site"
                    .to_owned(),
            ),
            Some(growth) if growth.worst() > NOISE_WARNING => words.push(format!(
                "WARNING: the noise of a calibration on this stand is up to {:.2} times that on an ideal stand",
                growth.worst()
            )),
            Some(_) => {}
        }
        if self.uncertainty_growth > POLAR_WARNING {
            words.push(format!(
                "WARNING: at this latitude, near the pole, the uncertainty of K is {:.1} times that at the equator",
                self.uncertainty_growth
            ));
        }
        words.extend(self.odd.iter().map(|odd| format!("WARNING: {odd}")));
        words.extend(self.absences.iter().cloned());
        words
    }
}
