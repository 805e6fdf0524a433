//! Content of a passport (`dtg-passport/1`), and the numbers in it that are computed from the stand and the site.

use super::FORM;
use super::accuracy::Accuracy;
use crate::calibration::{Model, analytic, least_squares};
use crate::coefficients::{
    Coefficients, MatrixRows, PositionCoefficients, PositionIndex, Rows, SingularPositions, StandGeometry,
};
use crate::document::{self, SignedText};
use crate::gyro::{GyroParameters, Parameters};
use crate::laboratory::Laboratory;
use crate::site::{Earth, Site};
use crate::stand::{self, Certificate, CertifiedPosition, Datum, Identity, Stand};
use crate::text::scalar::day;
use crate::text::{Identifier, Path, Problems, Unreadable, record, words};
use jiff::Timestamp;
use jiff::civil::Date;
use nalgebra::Vector2;

pub(crate) const PASSPORT_FORMAT: &str = "dtg-passport/1";

/// Returns `true` if the file states the format of a passport.
pub(crate) fn claims_to_be_a_passport(bytes: &[u8]) -> bool {
    memchr::memmem::find(bytes, b"format: \"dtg-passport/").is_some()
}

record! {
    /// Predecessor: the passport that was re-issued.
    pub struct Predecessor {
        /// Identifier of the predecessor.
        pub id: String,
        /// SHA-256 of its whole file.
        pub sha256: String,
        /// Reason for the re-issue.
        pub reason: String,
        /// Changes, in words.
        pub changed: String,
    }
}

record! {
    /// Identity, issuer and dates of the passport.
    pub struct PassportHeader {
        /// Identifier: `<model>/<serial>/<site id>/<revision>`.
        pub id: String,
        /// Revision, from 1 for each site of a stand.
        pub revision: u32,
        /// Time of issue.
        pub issued_at: Timestamp,
        /// Issuer: a principal of allowed_signers.
        pub issuer: String,
        /// Expiry date (inclusive), if any.
        pub valid_until: Option<Date>,
        /// Program and version.
        pub issued_with: Option<String>,
        /// Predecessor, if the passport is a re-issue.
        pub reissued_from: Option<Predecessor>,
        /// Whether it supersedes its predecessor.
        pub supersedes: Option<bool>,
    }
}

record! {
    /// Specific force and Earth rate in case axes, in one position.
    pub struct PositionVectors {
        /// Frame index.
        pub i: u32,
        /// Platform index.
        pub j: u32,
        /// Specific force along x and y: n = (c, d).
        pub specific_force_g: [f64; 2],
        /// Specific force along z: Ã₃₃.
        pub specific_force_z_g: f64,
        /// Earth rate ω_3 along x and y.
        pub omega_deg_per_h: [f64; 2],
    }
}

record! {
    /// Currents of the self-check in one position.
    pub struct PositionCurrents {
        /// Frame index.
        pub i: u32,
        /// Platform index.
        pub j: u32,
        /// Current J_x.
        pub jx_ma: f64,
        /// Current J_y.
        pub jy_ma: f64,
    }
}

record! {
    /// Self-check: currents, and the parameters that laboratory software should obtain from them.
    pub struct SelfCheck {
        /// Currents in every position.
        #[cfg_attr(feature = "generate", schemars(length(max = 256)))]
        pub currents: Vec<PositionCurrents>,
        /// Scale factors K.
        pub k_deg_per_h_per_ma: Rows,
        /// Constant drift ω_0.
        pub omega0_deg_per_h: [f64; 2],
        /// g-sensitive drift ω_g.
        pub omega_g_deg_per_h_per_g: f64,
        /// g-sensitive drift ω_k.
        pub omega_k_deg_per_h_per_g: f64,
    }
}

record! {
    /// Passport; keys in the order of the file.
    pub struct Content {
        /// Always "dtg-passport/1".
        pub format: String,
        /// Identity, issuer and dates of the passport.
        pub passport: PassportHeader,
        /// Identity of the stand.
        pub stand: Identity,
        /// Calibration certificate of the stand.
        pub certificate: Certificate,
        /// Datum surfaces, which define the axes.
        pub datum: Option<Datum>,
        /// Positions, sorted by (i, j); at most 256.
        #[cfg_attr(feature = "generate", schemars(length(max = 256)))]
        pub positions: Vec<CertifiedPosition>,
        /// Site of the stand.
        pub site: Site,
        /// Earth parameters at the site.
        pub earth: Earth,
        /// Matrices of the paper; absent without its eight positions.
        pub matrices: Option<MatrixRows>,
        /// Specific force and Earth rate in every position.
        #[cfg_attr(feature = "generate", schemars(length(max = 256)))]
        pub vectors: Vec<PositionVectors>,
        /// Self-check; absent if the positions do not determine the eight parameters.
        pub self_check: Option<SelfCheck>,
        /// Expected calibration uncertainty; optional.
        pub accuracy: Option<Accuracy>,
    }
}

/// Gyro of the self-check in every passport that this program issues. No two parameters are equal or opposite, so that
/// software which exchanges or transposes any of them obtains wrong values. Earlier passports use the GVK-6 of the
/// paper.
pub(crate) const REFERENCE_GYRO: Parameters = Parameters {
    k_deg_per_h_per_ma: [[95.0, 9.3], [-8.7, 93.0]],
    omega0_deg_per_h: [20.0, -15.0],
    omega_g_deg_per_h_per_g: 10.0,
    omega_k_deg_per_h_per_g: -7.0,
};

/// Numbers of a passport that are computed from its stand and its site.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Derived {
    pub earth: Earth,
    /// Matrices of the paper, or `None` without its eight positions.
    pub matrices: Option<MatrixRows>,
    pub vectors: Vec<PositionVectors>,
    /// Self-check of laboratory software for the given gyro, or `None` if the positions do not determine the
    /// parameters.
    pub self_check: Option<SelfCheck>,
}

/// Computes all numbers that follow from certified positions and a site; `gyro` is the gyro of the self-check.
pub(crate) fn derive(
    positions: &[CertifiedPosition],
    site: &Site,
    gyro: &Parameters,
) -> Result<Derived, SingularPositions> {
    Ok(derive_from(&stand::geometry(positions)?, site, gyro))
}

/// Computes all numbers that follow from the geometry of the positions and a site.
pub(crate) fn derive_from(geometry: &StandGeometry, site: &Site, gyro: &Parameters) -> Derived {
    let earth = site.earth();
    let coefficients = geometry.at(earth.rate(site));
    let vectors = coefficients.positions.iter().map(PositionVectors::from_model).collect();
    let matrices = coefficients.matrices.as_ref().map(MatrixRows::from_model);
    // Positions other than the paper's eight may not determine all parameters; laboratory software then cannot be
    // checked.
    let determined = |check: &SelfCheck| matrices.is_some() || check.error(&coefficients) <= SelfCheck::LIMIT;
    let self_check = SelfCheck::of(gyro, &coefficients).filter(determined);
    Derived { earth, matrices, vectors, self_check }
}

fn pair(vector: &Vector2<f64>) -> [f64; 2] {
    [vector.x + 0.0, vector.y + 0.0]
}

impl PositionVectors {
    fn from_model(at: &PositionCoefficients) -> Self {
        Self {
            i: at.index.i,
            j: at.index.j,
            specific_force_g: pair(&at.specific_force_g),
            specific_force_z_g: at.specific_force_z_g + 0.0,
            omega_deg_per_h: pair(&at.earth_rate_deg_per_h),
        }
    }

    fn to_model(&self) -> PositionCoefficients {
        PositionCoefficients {
            index: PositionIndex { i: self.i, j: self.j },
            specific_force_g: Vector2::from(self.specific_force_g),
            specific_force_z_g: self.specific_force_z_g,
            earth_rate_deg_per_h: Vector2::from(self.omega_deg_per_h),
        }
    }
}

impl SelfCheck {
    /// Largest relative error |found/stated − 1| of a parameter.
    pub const LIMIT: f64 = 1e-9;

    /// Computes the exact currents of `gyro`; returns `None` if its K has no inverse.
    fn of(gyro: &Parameters, coefficients: &Coefficients) -> Option<Self> {
        let model = gyro.to_model();
        let currents = coefficients.positions.iter().map(|at| {
            let [jx_ma, jy_ma] = pair(&model.currents_ma(at)?);
            Some(PositionCurrents { i: at.index.i, j: at.index.j, jx_ma, jy_ma })
        });
        Some(Self {
            currents: currents.collect::<Option<_>>()?,
            k_deg_per_h_per_ma: gyro.k_deg_per_h_per_ma,
            omega0_deg_per_h: gyro.omega0_deg_per_h,
            omega_g_deg_per_h_per_g: gyro.omega_g_deg_per_h_per_g,
            omega_k_deg_per_h_per_g: gyro.omega_k_deg_per_h_per_g,
        })
    }

    /// Returns the parameters that laboratory software should obtain from the currents.
    pub fn parameters(&self) -> Parameters {
        Parameters {
            k_deg_per_h_per_ma: self.k_deg_per_h_per_ma,
            omega0_deg_per_h: self.omega0_deg_per_h,
            omega_g_deg_per_h_per_g: self.omega_g_deg_per_h_per_g,
            omega_k_deg_per_h_per_g: self.omega_k_deg_per_h_per_g,
        }
    }

    /// Calibrates from the currents, by the paper's analytic method or, without its eight positions, by least squares.
    /// Returns the largest relative error of a parameter; infinite if there is no solution.
    pub(crate) fn error(&self, coefficients: &Coefficients) -> f64 {
        let currents: Vec<_> = self.currents.iter().map(|at| Vector2::new(at.jx_ma, at.jy_ma)).collect();
        let found = if coefficients.matrices.is_some() {
            analytic::solve(coefficients, &currents).ok().map(|found| found.parameters)
        } else {
            let meter = (&Laboratory::paper().meter).into();
            least_squares::solve(coefficients, &currents, &meter, Model::Paper).ok()
        };
        // `f64::max` would ignore a NaN.
        let worst = |errors: [f64; 8]| errors.into_iter().fold(0.0, |a, b| if b <= a || a.is_nan() { a } else { b });
        found.map_or(f64::INFINITY, |found| worst(self.errors(&found)))
    }

    /// Returns the relative error |found/stated − 1| of each parameter found from the currents: K_x, K_xy, K_yx, K_y,
    /// ω_0x, ω_0y, ω_g, ω_k. Correct software has none above [`SelfCheck::LIMIT`].
    pub fn errors(&self, found: &GyroParameters) -> [f64; 8] {
        let (found, due) = (found.to_vector(), self.parameters().to_model().to_vector());
        std::array::from_fn(|place| match (found[place], due[place]) {
            (found, 0.0) => found.abs(),
            (found, due) => (found / due - 1.0).abs(),
        })
    }
}

words! {
    /// A document with an expiry date.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Dated: pub(crate) word {
        /// The passport itself.
        Passport = "passport",
        /// The calibration certificate of the stand.
        Certificate = "certificate",
    }
}

impl Content {
    /// Returns the coefficients of the calibration equations, built from the signed numbers.
    pub fn coefficients(&self) -> Coefficients {
        Coefficients {
            positions: self.vectors.iter().map(PositionVectors::to_model).collect(),
            matrices: self.matrices.as_ref().map(MatrixRows::to_model),
        }
    }

    /// Returns the stand as the factory's file states it.
    pub(crate) fn to_stand(&self) -> Stand {
        Stand {
            stand: self.stand.clone(),
            certificate: self.certificate.clone(),
            datum: self.datum.clone(),
            positions: self.positions.clone(),
        }
    }

    /// Returns the id composed of the parts of the content: `<model>/<serial>/<site id>/<revision>`.
    pub(crate) fn id_of_parts(&self) -> String {
        passport_id(&self.stand, &self.site.id, self.passport.revision)
    }

    /// Returns the earlier of the two expiry dates (inclusive) and the document that states it, or `None` if neither
    /// states one.
    pub(crate) fn last_day(&self) -> Option<(Date, Dated)> {
        let passport = self.passport.valid_until.map(|day| (day, Dated::Passport));
        let certificate = self.certificate.valid_until.map(|day| (day, Dated::Certificate));
        // If both dates are equal, report the certificate, because a new passport would not help.
        certificate.into_iter().chain(passport).min_by_key(|(day, _)| *day)
    }

    /// Checks all rules of the content that its inputs do not already ensure.
    pub(crate) fn check(&self, problems: &mut Problems) {
        let at = Path::Root;
        stand::check(&self.certificate, &self.positions, problems);
        self.site.check(&at.key("site"), problems);
        if let Some(accuracy) = &self.accuracy {
            accuracy.check(&at.key("accuracy"), problems);
        }
        stand::check_length(&self.vectors, &at.key("vectors"), problems);
        if let Some(self_check) = &self.self_check {
            stand::check_length(&self_check.currents, &at.key("self_check").key("currents"), problems);
        }
        let header = at.key("passport");
        if self.passport.id != self.id_of_parts() {
            let expected = format!("{:?}, from stand, site and revision", self.id_of_parts());
            problems.at(&header.key("id"), format!("{:?}", self.passport.id), expected, "");
        }
        if self.passport.revision == 0 {
            problems.at(&header.key("revision"), "0", "a whole number of 1 or more", "");
        }
        let (issued_at, certified) = (self.passport.issued_at, self.certificate.issued);
        if issued_at < day(certified).0 {
            let expected = format!("a time on or after the date of the certificate, {certified}");
            problems.at(&header.key("issued_at"), format!("{issued_at}"), expected, "");
        }
        if let Some(from) = &self.passport.reissued_from {
            let (at, own) = (header.key("reissued_from"), format!("{}/", self.stand.id()));
            problems.sha256(&at.key("sha256"), &from.sha256);
            if !from.id.starts_with(&own) {
                problems.at(&at.key("id"), format!("{:?}", from.id), format!("a passport of this stand, {own}…"), "");
            }
        }
        if self.passport.reissued_from.is_some() != self.passport.supersedes.is_some() {
            problems.at(&header, "one of reissued_from and supersedes", "both or neither", "");
        }
        if !self.positions.is_sorted_by_key(CertifiedPosition::index) {
            problems.at(&at.key("positions"), "positions out of order", "positions sorted by i, then j", "");
        }
    }
}

/// Parses the payload of a passport, step 5 of verification: see [`document::parse`].
pub(crate) fn read(name: &str, payload: &str) -> Result<Content, Unreadable> {
    document::parse(name, payload, &FORM, Content::check)
}

/// Parses the content of a passport file without verifying its signature: anyone may have written it.
///
/// # Errors
/// Returns an error if the file does not have the form of a passport, or if its content breaks a rule.
pub fn content_from_anyone(name: &str, bytes: &[u8]) -> Result<Content, Unreadable> {
    let text = SignedText::split(name, bytes, &FORM).map_err(|malformed| malformed.fault)?;
    read(name, text.unverified_payload())
}

/// Returns the identifier of a passport: `<model>/<serial>/<site id>/<revision>`.
pub(crate) fn passport_id(stand: &Identity, site: &Identifier, revision: u32) -> String {
    format!("{}/{site}/{revision}", stand.id())
}
