//! Expected calibration uncertainty of a stated gyro type on a stand at a site with a stated meter.
//!
//! Computed by first-order propagation ([JCGM 100](crate::bibliography::Bibliography::Gum), 5.1.2 and 5.2.2) for
//! weighted least squares with one reading in each position. `calibrate` will state the same uncertainty for such
//! a gyro; a passport states it before delivery.

use crate::calibration::least_squares::NoLeastSquares;
use crate::calibration::parameter::Parameter;
use crate::calibration::readings::NoReadings;
use crate::calibration::{Method, NoSetup, Options, Readings, Setup, calibrate};
use crate::gyro::{GYRO_FORMAT, GyroNoise, GyroParameters, GyroType, Parameters, Tolerance};
use crate::laboratory::{Base, LABORATORY_FORMAT, Laboratory, Meter, Seating};
use crate::site::Site;
use crate::stand::{Certificate, CertifiedPosition};
use crate::text::{Path, Problems, record};

record! {
    /// Gyro type as specified, without `format`.
    pub struct StatedGyro {
        /// Name of the type.
        pub r#type: String,
        /// Nominal parameters.
        pub nominal: Parameters,
        /// Tolerances of the parameters.
        pub tolerance: Tolerance,
        /// Value of g to which the drifts of the type refer; 9.80665 if absent.
        pub gravity_m_per_s2: Option<f64>,
        /// Noise of the gyro's own drift.
        pub noise: Option<GyroNoise>,
    }
}

record! {
    /// Laboratory as specified, without `format`.
    pub struct StatedLaboratory {
        /// Name of the laboratory.
        pub name: Option<String>,
        /// Current meter.
        pub meter: Meter,
        /// Standard uncertainties of the gyro seat.
        pub seating_arcsec: Option<Seating>,
        /// Standard uncertainties of the base's azimuth and level.
        pub base: Option<Base>,
        /// Temperature during the calibration.
        pub temperature_c: Option<f64>,
    }
}

record! {
    /// Expected uncertainty of a calibration of a gyro of this type in this laboratory.
    pub struct Accuracy {
        /// Gyro type.
        pub gyro: StatedGyro,
        /// Laboratory.
        pub laboratory: StatedLaboratory,
        /// Standard uncertainties of the parameters; drifts per local g.
        pub standard_uncertainty: Parameters,
    }
}

impl From<GyroType> for StatedGyro {
    fn from(gyro: GyroType) -> Self {
        let GyroType { r#type, nominal, tolerance, gravity_m_per_s2, noise, .. } = gyro;
        Self { r#type, nominal, tolerance, gravity_m_per_s2, noise }
    }
}

impl StatedGyro {
    /// Returns the gyro type as its file states it.
    pub(crate) fn to_type(&self) -> GyroType {
        let Self { r#type, nominal, tolerance, gravity_m_per_s2, noise } = self.clone();
        GyroType { format: GYRO_FORMAT.to_owned(), r#type, nominal, tolerance, gravity_m_per_s2, noise }
    }
}

impl From<Laboratory> for StatedLaboratory {
    fn from(laboratory: Laboratory) -> Self {
        let Laboratory { name, meter, seating_arcsec, base, temperature_c, .. } = laboratory;
        Self { name, meter, seating_arcsec, base, temperature_c }
    }
}

impl StatedLaboratory {
    fn to_laboratory(&self) -> Laboratory {
        let Self { name, meter, seating_arcsec, base, temperature_c } = self.clone();
        Laboratory { format: LABORATORY_FORMAT.to_owned(), name, meter, seating_arcsec, base, temperature_c }
    }
}

/// Gyro type and laboratory for which an accuracy is stated.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated {
    /// Gyro type.
    pub gyro: StatedGyro,
    /// Laboratory.
    pub laboratory: StatedLaboratory,
}

/// Reason why no accuracy can be stated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoAccuracy {
    /// The stand cannot be used, or an uncertainty is invalid.
    #[error(transparent)]
    Setup(#[from] NoSetup),
    /// The positions do not determine the parameters of the gyro.
    #[error(transparent)]
    LeastSquares(#[from] NoLeastSquares),
    /// The currents of the gyro are not finite.
    #[error(transparent)]
    Currents(#[from] NoReadings),
    /// The nominal K has no inverse.
    #[error("the nominal K of this gyro type has no inverse")]
    SingularGyro,
}

impl Stated {
    /// Returns the gyro type and the laboratory that a passport states.
    pub(crate) fn of(accuracy: &Accuracy) -> Self {
        Self { gyro: accuracy.gyro.clone(), laboratory: accuracy.laboratory.clone() }
    }

    /// Computes the standard uncertainties of the parameters on a certified stand at a site.
    ///
    /// # Errors
    /// Returns [`NoAccuracy`] if the inputs are unusable or do not determine the parameters.
    pub(crate) fn accuracy(
        &self,
        certificate: &Certificate,
        positions: &[CertifiedPosition],
        site: &Site,
    ) -> Result<Accuracy, NoAccuracy> {
        let laboratory = self.laboratory.to_laboratory();
        let (setup, _) = Setup::stated(certificate, positions, site, &laboratory)?;
        let setup = setup.of_gyro(self.gyro.noise.as_ref());
        let gyro = at_gravity(&self.gyro.to_type(), site.earth().gravity_m_per_s2);
        let each = setup.coefficients().positions.iter().map(|at| Some((at.index, gyro.currents_ma(at)?)));
        let currents: Vec<_> = each.collect::<Option<_>>().ok_or(NoAccuracy::SingularGyro)?;
        let readings = Readings::new(setup.coefficients(), &currents)?;
        let options = Options { methods: vec![Method::LeastSquares], ..Options::default() };
        let calibration = calibrate(&setup, &readings, &options)?;
        let u = |parameter| calibration.answer().and_then(|found| found.standard_uncertainty(parameter)).unwrap_or(0.0);
        let standard_uncertainty = Parameters {
            k_deg_per_h_per_ma: [[u(Parameter::Kx), u(Parameter::Kxy)], [u(Parameter::Kyx), u(Parameter::Ky)]],
            omega0_deg_per_h: [u(Parameter::Omega0x), u(Parameter::Omega0y)],
            omega_g_deg_per_h_per_g: u(Parameter::OmegaG),
            omega_k_deg_per_h_per_g: u(Parameter::OmegaK),
        };
        Ok(Accuracy { gyro: self.gyro.clone(), laboratory: self.laboratory.clone(), standard_uncertainty })
    }
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
    /// Checks the inputs by the rules of the files that they came from.
    pub(crate) fn check(&self, at: &Path, problems: &mut Problems) {
        self.gyro.to_type().check(&at.key("gyro"), problems);
        self.laboratory.to_laboratory().check(&at.key("laboratory"), problems);
    }
}
