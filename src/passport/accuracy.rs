//! Expected calibration uncertainty of a stated gyro type on a stand at a site with a stated meter.
//!
//! Computed by first-order propagation ([JCGM 100](crate::bibliography::Bibliography::Gum), 5.1.2 and 5.2.2) for
//! weighted least squares with one reading in each position. `calibrate` will state the same uncertainty for such
//! a gyro; a passport states it before delivery.

use crate::calibration::prediction::exact_currents_ma;
use crate::calibration::{Method, Options, Parameter, Readings, Setup, calibrate};
use crate::coefficients::PositionCoefficients;
use crate::gyro::{GyroParameters, GyroType, Parameters};
use crate::laboratory::Laboratory;
use crate::site::Site;
use crate::stand::{Certificate, CertifiedPosition};
use crate::text::{Path, Problems, record};

record! {
    /// Expected uncertainty of a calibration of a gyro of this type in this laboratory.
    pub struct Accuracy {
        /// Gyro type.
        pub gyro: GyroType,
        /// Laboratory.
        pub laboratory: Laboratory,
        /// Standard uncertainties; drifts per local g.
        pub standard_uncertainty: Parameters,
    }
}

/// Gyro type and laboratory for which an accuracy is stated.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated {
    /// Gyro type.
    pub gyro: GyroType,
    /// Laboratory.
    pub laboratory: Laboratory,
}

impl Stated {
    /// Returns the gyro type and the laboratory that a passport states.
    pub(crate) fn of(accuracy: &Accuracy) -> Self {
        Self { gyro: accuracy.gyro.clone(), laboratory: accuracy.laboratory.clone() }
    }

    /// Computes the standard uncertainties of the parameters on a certified stand at a site.
    ///
    /// # Errors
    /// Returns the reason why no accuracy can be stated, in words.
    pub(crate) fn accuracy(
        &self,
        certificate: &Certificate,
        positions: &[CertifiedPosition],
        site: &Site,
    ) -> Result<Accuracy, String> {
        let (setup, _) = Setup::stated(certificate, positions, site, &self.laboratory).map_err(words)?;
        let setup = setup.of_gyro(self.gyro.noise.as_ref());
        let gyro = at_gravity(&self.gyro, site.earth().gravity_m_per_s2);
        let currents = exact_currents_ma(&setup, &gyro).ok_or("the nominal K of this gyro type has no inverse")?;
        let readings = Readings::new(setup.coefficients(), &currents).map_err(words)?;
        let options = Options { methods: vec![Method::LeastSquares], ..Options::default() };
        let calibration = calibrate(&setup, &readings, &options).map_err(words)?;
        let u =
            |parameter| calibration.adopted().and_then(|found| found.standard_uncertainty(parameter)).unwrap_or(0.0);
        let standard_uncertainty = Parameters::of(&GyroParameters::from_vector(&Parameter::EIGHT.map(u)));
        // The laboratory and its customer agree on the decision rule.
        let gyro = GyroType { decision: None, ..self.gyro.clone() };
        Ok(Accuracy { gyro, laboratory: self.laboratory.clone(), standard_uncertainty })
    }
}

fn words(error: impl std::error::Error) -> String {
    error.to_string()
}

/// Returns the nominal parameters of the gyro with the drifts per local g.
pub(crate) fn at_gravity(gyro: &GyroType, gravity_m_per_s2: f64) -> GyroParameters {
    let ratio = gravity_m_per_s2 / gyro.gravity();
    let nominal = gyro.nominal.to_model();
    GyroParameters {
        omega_g_deg_per_h_per_g: nominal.omega_g_deg_per_h_per_g * ratio,
        omega_k_deg_per_h_per_g: nominal.omega_k_deg_per_h_per_g * ratio,
        ..nominal
    }
}

impl Accuracy {
    /// Returns a sentence if the gyro needs more current in a position of the passport than the meter can read.
    pub(crate) fn beyond_range(&self, positions: &[PositionCoefficients], gravity_m_per_s2: f64) -> Option<String> {
        let gyro = at_gravity(&self.gyro, gravity_m_per_s2);
        let each = positions.iter().filter_map(|at| Some((gyro.currents_ma(at)?.amax(), at.index)));
        let (current_ma, index) = each.max_by(|(one, _), (other, _)| one.total_cmp(other))?;
        let range_ma = self.laboratory.meter.range_ma;
        (current_ma > range_ma).then(|| {
            format!(
                "a gyro of type {} needs {current_ma:.3} mA in position {index}, more than {range_ma} mA, the range of the \
                 meter for which the accuracy is stated",
                self.gyro.r#type
            )
        })
    }

    /// Checks the inputs by the rules of the files that they came from.
    pub(crate) fn check(&self, at: &Path, problems: &mut Problems) {
        self.gyro.check(&at.key("gyro"), problems);
        self.laboratory.check(&at.key("laboratory"), problems);
    }
}
