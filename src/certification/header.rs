//! Header of a certification: a stand file whose positions have no angles yet.

use crate::coefficients::PositionIndex;
use crate::stand::{self, Certificate, CertifiedPosition, Datum, Identity, Stand};
use crate::text::record::Document;
use crate::text::{Path, Problems, Unreadable, record, yaml};

record! {
    /// Position to be certified, with its nominal angles only.
    pub struct NominalPosition {
        /// Frame index, from 1.
        pub i: u32,
        /// Platform index, from 1.
        pub j: u32,
        /// Frame angle θ about ξ.
        pub theta_deg: f64,
        /// Platform angle φ about the spin axis.
        pub phi_deg: f64,
    }
}

impl NominalPosition {
    pub(crate) fn index(&self) -> PositionIndex {
        PositionIndex { i: self.i, j: self.j }
    }

    /// Returns the position with the deviations `angles_arcsec` (α, β, γ) and no uncertainty.
    pub(crate) fn with_angles(&self, angles_arcsec: [f64; 3]) -> CertifiedPosition {
        let [alpha_arcsec, beta_arcsec, gamma_arcsec] = angles_arcsec;
        CertifiedPosition {
            i: self.i,
            j: self.j,
            theta_deg: self.theta_deg,
            phi_deg: self.phi_deg,
            alpha_arcsec,
            beta_arcsec,
            gamma_arcsec,
            ..CertifiedPosition::default()
        }
    }
}

impl From<&CertifiedPosition> for NominalPosition {
    fn from(position: &CertifiedPosition) -> Self {
        Self { i: position.i, j: position.j, theta_deg: position.theta_deg, phi_deg: position.phi_deg }
    }
}

record! {
    /// Stand file (`dtg-stand/1`) before the measurement: stand, certificate, and positions without deviations.
    pub struct Header {
        /// Identity of the stand.
        pub stand: Identity,
        /// Certificate, without the results of the measurement.
        pub certificate: Certificate,
        /// Datum surfaces, which define the axes.
        pub datum: Option<Datum>,
        /// Positions, sorted by (i, j) after reading.
        pub positions: Vec<NominalPosition>,
    }
}

impl Document for Header {
    const FORMAT: &'static str = Stand::FORMAT;
}

impl Header {
    /// Reads a header; `name` is its name in messages.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with every error at its line, column and field: those of a stand file, and numbers that
    /// the certification computes itself.
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let read = yaml::read_document(name, bytes, |header: &Self, problems| {
            let positions: Vec<_> = header.positions.iter().map(|at| at.with_angles([0.0; 3])).collect();
            stand::check(&header.certificate, &positions, problems);
            check_not_measured(&header.certificate, problems);
        });
        // A certified stand breaks the rules of a header in every position; one sentence is enough.
        let mut header = read.map_err(|refused| match Stand::from_yaml(name, bytes) {
            Ok(_) => {
                let expected = "a header: positions without angles, and no measured numbers";
                let advice = "check this stand with --against, or write a header with `dtg-passport new header`";
                Unreadable::whole(name, None, "a certified stand", expected, advice)
            }
            Err(_) => refused,
        })?;
        header.positions.sort_by_key(NominalPosition::index);
        Ok(header)
    }
}

impl From<&Stand> for Header {
    /// Returns the header for a new measurement of the positions of a certified stand. It omits the results and the
    /// dates of the earlier measurement, but keeps the number and the date of issue of the certificate, which every
    /// header needs.
    fn from(stand: &Stand) -> Self {
        let certificate = Certificate {
            performed: None,
            received: None,
            valid_until: None,
            valid_until_basis: None,
            temperature_c: None,
            repeatability_arcsec: None,
            repeatability_degrees_of_freedom: None,
            common_platform_arcsec: None,
            common_base_arcsec: None,
            evidence: None,
            ..stand.certificate.clone()
        };
        Self {
            stand: stand.stand.clone(),
            certificate,
            datum: stand.datum.clone(),
            positions: stand.positions.iter().map(NominalPosition::from).collect(),
        }
    }
}

/// Refuses results of a measurement in the header: they would be overwritten, or mistaken for measured values.
fn check_not_measured(certificate: &Certificate, problems: &mut Problems) {
    let at = Path::Root.key("certificate");
    let measured = [
        ("repeatability_arcsec", certificate.repeatability_arcsec),
        ("repeatability_degrees_of_freedom", certificate.repeatability_degrees_of_freedom),
        ("common_platform_arcsec", certificate.common_platform_arcsec),
        ("common_base_arcsec", certificate.common_base_arcsec),
    ];
    let measured = measured.into_iter().filter_map(|(key, value)| Some((key, format!("{}", value?))));
    let evidence = certificate.evidence.iter().map(|_| ("evidence", "a mapping".to_owned()));
    for (key, found) in measured.chain(evidence) {
        let advice = "omit it; it is computed from the readings";
        problems.at(&at.key(key), found, "a header without measured numbers", advice);
    }
}
