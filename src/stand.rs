//! Test stands and their calibration certificates: the file `stand.yaml` (`dtg-stand/1`).

pub(crate) mod remarks;
pub(crate) mod type_b;

pub(crate) use type_b::Excluded;
pub use type_b::{ActsOn, Evidence, TypeB};

use crate::attitude::Deviation;
use crate::coefficients::{EIGHT_POSITIONS, Position, PositionIndex, SingularPositions, StandGeometry};
use crate::text::advice::{beyond_range, without_full_turns};
use crate::text::{Advice, Document, Identifier, Path, Problems, RefusalCause, record};
use crate::units::{ARCSECONDS_PER_DEGREE, radians_from_arcseconds};
use jiff::civil::Date;
use std::collections::BTreeSet;

/// Largest deviation that can be certified, in either direction, degrees.
pub(crate) const LARGEST_DEVIATION_DEG: f64 = 45.0;

/// Maximum number of positions of a stand. The uncertainties of all positions are computed together, in memory that
/// grows with the square of their number.
pub(crate) const MOST_POSITIONS: usize = 256;

record! {
    /// Identity of the stand.
    pub struct Identity {
        /// Manufacturer of the stand.
        pub manufacturer: Option<String>,
        /// Model; also a folder name.
        pub model: Identifier,
        /// Serial number; also a folder name.
        pub serial: Identifier,
        /// Configuration, if there are several.
        pub configuration: Option<String>,
        /// Free-text name.
        pub name: Option<String>,
        /// Customer of the certification.
        pub customer: Option<String>,
    }
}

impl Identity {
    /// Returns the model and serial number as in the identifier of a passport: `<model>/<serial>`.
    pub(crate) fn id(&self) -> String {
        format!("{}/{}", self.model, self.serial)
    }
}

record! {
    /// Calibration certificate with the deviations. Uncertainties are standard uncertainties (k = 1).
    pub struct Certificate {
        /// Number of the certificate.
        pub number: String,
        /// Date of issue.
        pub issued: Date,
        /// Date of measurement.
        pub performed: Option<Date>,
        /// Date of receipt.
        pub received: Option<Date>,
        /// Expiry date (inclusive).
        pub valid_until: Option<Date>,
        /// Basis of the validity period.
        pub valid_until_basis: Option<String>,
        /// Certifying laboratory.
        pub laboratory: String,
        /// Address of the laboratory.
        pub address: Option<String>,
        /// Person who authorised the certificate.
        pub authorized_by: Option<String>,
        /// Accreditation of the laboratory.
        pub accreditation: Option<String>,
        /// Method of measurement.
        pub method: Option<String>,
        /// Traceability to the SI.
        pub traceability: Option<String>,
        /// Certificates of the instruments.
        pub references: Option<Vec<Reference>>,
        /// Accredited capability (CMC): a certificate that states a smaller U (k = 2) of an angle is refused.
        pub cmc_arcsec: Option<f64>,
        /// Temperature during the measurement.
        pub temperature_c: Option<f64>,
        /// Temperature range of validity.
        pub temperature_range_c: Option<[f64; 2]>,
        /// Standard deviation of one visit, per axis.
        pub repeatability_arcsec: Option<f64>,
        /// Degrees of freedom of the repeatability; infinite if absent.
        pub repeatability_degrees_of_freedom: Option<f64>,
        /// Uncertainty common to all positions, per axis of the platform.
        pub common_platform_arcsec: Option<f64>,
        /// Uncertainty common to all positions, per axis of the base.
        pub common_base_arcsec: Option<f64>,
        /// Contributions that repetition does not show.
        pub type_b: Option<Vec<TypeB>>,
        /// Readings of the certificate; written by `certify`.
        pub evidence: Option<Evidence>,
    }
}

record! {
    /// Certificate of an instrument.
    pub struct Reference {
        /// Number of the certificate.
        pub number: String,
        /// Laboratory that issued it.
        pub laboratory: String,
        /// Date of issue.
        pub issued: Date,
        /// SHA-256 of its file.
        pub sha256: String,
    }
}

record! {
    /// Datum surfaces of the stand, which define the axes ξηζ and xyz.
    pub struct Datum {
        /// Surface for levelling.
        pub level: Option<String>,
        /// Surface for north alignment.
        pub azimuth: Option<String>,
        /// Gyro seat.
        pub gyro_seat: Option<String>,
    }
}

record! {
    /// Certified position: nominal angles and deviations from them.
    #[derive(Default)]
    pub struct CertifiedPosition {
        /// Frame index, from 1.
        pub i: u32,
        /// Platform index, from 1.
        pub j: u32,
        /// Frame angle θ about ξ.
        pub theta_deg: f64,
        /// Platform angle φ about the spin axis.
        pub phi_deg: f64,
        /// Deviation α about x of the platform.
        pub alpha_arcsec: f64,
        /// Deviation β about y of the platform.
        pub beta_arcsec: f64,
        /// Deviation γ about z of the platform.
        pub gamma_arcsec: f64,
        /// Standard uncertainty of α, own part.
        pub u_alpha_arcsec: Option<f64>,
        /// Standard uncertainty of β, own part.
        pub u_beta_arcsec: Option<f64>,
        /// Standard uncertainty of γ, own part.
        pub u_gamma_arcsec: Option<f64>,
        /// Degrees of freedom of the three; infinite if absent.
        pub degrees_of_freedom: Option<f64>,
    }
}

impl Certificate {
    /// Returns the date to which the deviations belong: that of the measurement, else that of issue.
    pub(crate) fn measured(&self) -> Date {
        self.performed.unwrap_or(self.issued)
    }

    /// Returns the degrees of freedom of the parts common to a run, three axes for each run after the first; infinite without
    /// evidence.
    pub(crate) fn freedom_of_runs(&self) -> f64 {
        self.evidence.as_ref().map_or(f64::INFINITY, |evidence| 3.0 * (f64::from(evidence.runs) - 1.0))
    }

    /// Returns a position with the standard uncertainties of its certified values in place of their own parts: combined
    /// with the common parts ([GUM](crate::bibliography::Bibliography::Gum), 5.1.2), `None` where a part is not stated.
    pub(crate) fn combined(&self, at: &CertifiedPosition) -> CertifiedPosition {
        let common = self.common_platform_arcsec.zip(self.common_base_arcsec);
        let common = common.map(|(platform, base)| libm::hypot(platform, base));
        // A rotation about every axis changes α and γ, whose axes are not perpendicular, by 1/cos β of what it changes β.
        let cos_beta = libm::cos(radians_from_arcseconds(at.beta_arcsec));
        let with_common = |own: Option<f64>, cosine: f64| Some(libm::hypot(own?, common? / cosine));
        CertifiedPosition {
            u_alpha_arcsec: with_common(at.u_alpha_arcsec, cos_beta),
            u_beta_arcsec: with_common(at.u_beta_arcsec, 1.0),
            u_gamma_arcsec: with_common(at.u_gamma_arcsec, cos_beta),
            ..at.clone()
        }
    }

    /// Returns the accredited capability and the smallest expanded uncertainty that is stated, arcsec (k = 2), if the latter is
    /// smaller, which ILAC-P14 (5.4) does not permit. Of an angle it contains the common parts.
    pub(crate) fn below_capability_arcsec(&self, positions: &[CertifiedPosition]) -> Option<[f64; 2]> {
        let common = [self.common_platform_arcsec, self.common_base_arcsec].map(Option::unwrap_or_default);
        let stated = positions.iter().flat_map(CertifiedPosition::u_arcsec).flatten();
        let smallest = stated.map(|u| 2.0 * libm::hypot(u, libm::hypot(common[0], common[1]))).reduce(f64::min)?;
        self.cmc_arcsec.filter(|cmc| smallest < cmc * (1.0 - type_b::ROUNDING)).map(|cmc| [cmc, smallest])
    }
}

impl CertifiedPosition {
    /// Returns the index (i, j) of the position.
    pub fn index(&self) -> PositionIndex {
        PositionIndex { i: self.i, j: self.j }
    }

    /// Returns the deviations α, β and γ.
    pub(crate) fn angles_arcsec(&self) -> [f64; 3] {
        [self.alpha_arcsec, self.beta_arcsec, self.gamma_arcsec]
    }

    /// Returns the standard uncertainties of α, β and γ, own part of the position.
    pub(crate) fn u_arcsec(&self) -> [Option<f64>; 3] {
        [self.u_alpha_arcsec, self.u_beta_arcsec, self.u_gamma_arcsec]
    }

    /// Converts the position to its model, with the deviation in radians.
    pub fn to_model(&self) -> Position {
        let deviation = Deviation::of(self.angles_arcsec().map(radians_from_arcseconds));
        Position { index: self.index(), theta_deg: self.theta_deg, phi_deg: self.phi_deg, deviation }
    }
}

record! {
    /// Stand file: stand, certificate and positions (`dtg-stand/1`).
    pub struct Stand {
        /// Identity of the stand.
        pub stand: Identity,
        /// Calibration certificate of the stand.
        pub certificate: Certificate,
        /// Datum surfaces, which define the axes.
        pub datum: Option<Datum>,
        /// Positions, sorted by (i, j) after reading; at most 256.
        #[cfg_attr(feature = "generate", schemars(length(max = 256)))]
        pub positions: Vec<CertifiedPosition>,
    }
}

impl Document for Stand {
    const FORMAT: &'static str = "dtg-stand/1";
}

impl Stand {
    /// Reads a `dtg-stand/1` file; `name` is the file name in messages.
    ///
    /// # Errors
    /// Returns [`crate::text::Unreadable`] with the line, column and field of every error.
    #[cfg(feature = "yaml")]
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, crate::text::Unreadable> {
        let read = crate::text::yaml::read_document(name, bytes, |stand: &Self, problems| {
            check(&stand.certificate, &stand.positions, problems);
        });
        let mut stand = read.map_err(|refused| without_angles(&refused).unwrap_or(refused))?;
        stand.positions.sort_by_key(CertifiedPosition::index);
        Ok(stand)
    }

    /// Checks that the certificate does not use the number of an existing one, `there`, for other angles.
    ///
    /// # Errors
    /// Returns a sentence if it does.
    #[cfg(feature = "factory")]
    pub(crate) fn check_number(&self, there: &Self) -> Result<(), String> {
        let number = &self.certificate.number;
        if *number != there.certificate.number {
            return Ok(());
        }
        let kept = |at: &CertifiedPosition, among: &[CertifiedPosition]| {
            among.iter().any(|other| other.index() == at.index() && other.angles_arcsec() == at.angles_arcsec())
        };
        let new = self.positions.iter().find(|at| !kept(at, &there.positions));
        match new.or_else(|| there.positions.iter().find(|at| !kept(at, &self.positions))) {
            Some(at) => Err(format!(
                "certificate {number} already states other angles for this stand, first for position {}; give the new \
                 certificate its own number and dates",
                at.index()
            )),
            None => Ok(()),
        }
    }

    /// Checks the number as [`Self::check_number`] does, against that of a stand file from which nothing need have been issued:
    /// from the same readings it may be certified anew, because other exclusions give other angles.
    ///
    /// # Errors
    /// Returns a sentence if other readings gave other angles.
    #[cfg(feature = "factory")]
    pub(crate) fn check_number_of_file(&self, there: &Self) -> Result<(), String> {
        let evidence = |stand: &Self| stand.certificate.evidence.clone();
        let same_readings = evidence(there).is_some() && evidence(there) == evidence(self);
        if same_readings { Ok(()) } else { self.check_number(there) }
    }
}

/// Returns the refusal of a stand file in one sentence if only the angles are missing: it is then a header.
fn without_angles(refused: &crate::text::Unreadable) -> Option<crate::text::Unreadable> {
    let angles = [".alpha_arcsec", ".beta_arcsec", ".gamma_arcsec"];
    let is_angle = |problem: &crate::text::Problem| {
        problem.found.starts_with("missing") && angles.iter().any(|angle| problem.field.ends_with(angle))
    };
    // The last one may say that there are more.
    let (angle, other): (Vec<_>, Vec<_>) = refused.problems().iter().partition(|problem| is_angle(problem));
    let is_header = angle.len() >= angles.len() && other.iter().all(|problem| problem.field.is_empty());
    let location = angle.first()?.location;
    let expected = "a certified stand, with α, β and γ of each position";
    let advice = "`certify` computes them from readings";
    let found = "positions without angles";
    is_header.then(|| crate::text::Unreadable::whole(refused.name(), location, found, expected, advice))
}

/// Returns the geometry of certified positions, which does not depend on the site.
pub(crate) fn geometry(positions: &[CertifiedPosition]) -> Result<StandGeometry, SingularPositions> {
    let positions: Vec<Position> = positions.iter().map(CertifiedPosition::to_model).collect();
    StandGeometry::new(&positions)
}

/// Checks a certificate and its positions, which are at the top level of both stand files and passports.
pub(crate) fn check(certificate: &Certificate, positions: &[CertifiedPosition], problems: &mut Problems) {
    check_certificate(certificate, problems);
    type_b::check(certificate, positions, problems);
    let cmc = Path::Root.key("certificate");
    let cmc = cmc.key("cmc_arcsec");
    if let Some([capability, smallest]) = certificate.below_capability_arcsec(positions) {
        let expected = format!("at most {smallest:.4}, the smallest U (k = 2) that the certificate states");
        problems.at(&cmc, format!("{capability}"), expected, "state no U below the accredited capability");
    }
    if let Some(capability) = certificate.cmc_arcsec.filter(|capability| *capability <= 0.0) {
        problems.at(&cmc, format!("{capability}"), "a positive number", "");
    }
    let at = Path::Root.key("positions");
    if positions.is_empty() {
        problems.at(&at, "an empty list", "at least one position", "");
    }
    // The items of a list that is too long are not checked one by one.
    if !check_length(positions, &at, problems) {
        return;
    }
    let mut seen = BTreeSet::new();
    for (index, position) in positions.iter().enumerate() {
        let at = at.item(index);
        check_position(position, &at, problems);
        if !seen.insert(position.index()) {
            let advice = "delete one";
            problems.at(&at, format!("duplicate position {}", position.index()), "each position once", advice);
        }
    }
}

/// Returns `true` if a list has no more items than a stand may have positions; otherwise reports a problem.
pub(crate) fn check_length<T>(list: &[T], at: &Path, problems: &mut Problems) -> bool {
    let fits = list.len() <= MOST_POSITIONS;
    if !fits {
        problems.at(at, format!("{} positions", list.len()), format!("at most {MOST_POSITIONS}"), "");
    }
    fits
}

fn check_certificate(certificate: &Certificate, problems: &mut Problems) {
    let at = Path::Root.key("certificate");
    let days = [
        ("received", certificate.received),
        ("performed", certificate.performed),
        ("issued", Some(certificate.issued)),
        ("valid_until", certificate.valid_until),
    ];
    let known: Vec<_> = days.into_iter().filter_map(|(key, day)| Some((key, day?))).collect();
    for pair in known.windows(2) {
        let [(earlier, from), (later, to)] = pair else { continue };
        if to < from {
            problems.at(&at.key(later), format!("{to}"), format!("a date on or after {earlier}, {from}"), "");
        }
    }
    if certificate.valid_until.is_none() && certificate.valid_until_basis.is_some() {
        problems.at(&at.key("valid_until_basis"), "a basis without valid_until", "both or neither", "");
    }
    if let Some([low, high]) = certificate.temperature_range_c
        && low > high
    {
        problems.at(&at.key("temperature_range_c"), format!("[{low}, {high}]"), "[lowest, highest]", "");
    }
    for (key, value) in [
        ("repeatability_arcsec", certificate.repeatability_arcsec),
        ("common_platform_arcsec", certificate.common_platform_arcsec),
        ("common_base_arcsec", certificate.common_base_arcsec),
    ] {
        problems.within(&at.key(key), value, 0.0, f64::MAX);
    }
    check_not_empty(certificate.references.as_ref(), &at.key("references"), "at least one certificate", problems);
    for (index, reference) in certificate.references.iter().flatten().enumerate() {
        problems.sha256(&at.key("references").item(index).key("sha256"), &reference.sha256);
    }
    let degrees_of_freedom = certificate.repeatability_degrees_of_freedom;
    check_degrees_of_freedom(degrees_of_freedom, &at.key("repeatability_degrees_of_freedom"), problems);
}

/// Refuses an optional list that is there and empty.
pub(crate) fn check_not_empty<T>(list: Option<&Vec<T>>, at: &Path, expected: &str, problems: &mut Problems) {
    if list.is_some_and(Vec::is_empty) {
        problems.at(at, "an empty list", expected, "omit the key if there is none");
    }
}

fn check_degrees_of_freedom(value: Option<f64>, at: &Path, problems: &mut Problems) {
    if let Some(value) = value
        && value <= 0.0
    {
        problems.at(at, format!("{value}"), "a positive number", "omit it if it is infinite");
    }
}

/// Returns the expected range of a deviation and the advice on this one, arcsec, or `None` if it is within the range; `remedy`
/// says what to do about an overload.
pub(crate) fn beyond_largest_deviation(value_arcsec: f64, remedy: &str) -> Option<(String, Advice)> {
    const TURN: f64 = 360.0 * ARCSECONDS_PER_DEGREE;
    let largest = LARGEST_DEVIATION_DEG * ARCSECONDS_PER_DEGREE;
    let full_turn = || {
        let meant = without_full_turns(value_arcsec, TURN, -TURN / 2.0)?;
        let words = format!("subtract or add a full turn of {TURN} arcseconds, which gives {meant}");
        (libm::remainder(value_arcsec, TURN).abs() <= largest).then(|| (RefusalCause::FullTurn, words).into())
    };
    (value_arcsec.abs() > largest).then(|| {
        let advice = beyond_range(value_arcsec, remedy).or_else(full_turn);
        let expected = format!("at most {LARGEST_DEVIATION_DEG} degrees ({largest} arcseconds) in either direction");
        (expected, advice.unwrap_or_else(|| "state deviations from the nominal position, in arcseconds".into()))
    })
}

fn check_position(position: &CertifiedPosition, at: &Path, problems: &mut Problems) {
    for (key, index) in [("i", position.i), ("j", position.j)] {
        if index == 0 {
            problems.at(&at.key(key), "0", "an index from 1", "count i and j from 1");
        }
    }
    let nominal = EIGHT_POSITIONS.iter().find(|(index, ..)| *index == position.index());
    if let Some((index, theta, phi)) = nominal {
        for (key, found, due) in [("theta_deg", position.theta_deg, *theta), ("phi_deg", position.phi_deg, *phi)] {
            if found != due {
                let advice = match libm::remainder(found - due, 360.0) {
                    0.0 => Advice::from((RefusalCause::FullTurn, format!("write {due}, which is the same without a full turn"))),
                    _ => "use another (i, j) for another orientation, because the angles of the eight positions are fixed"
                        .into(),
                };
                problems.at(&at.key(key), format!("{found}"), format!("{due} for position {index}"), advice);
            }
        }
    }
    for (key, value) in ["alpha_arcsec", "beta_arcsec", "gamma_arcsec"].into_iter().zip(position.angles_arcsec()) {
        if let Some((expected, advice)) = beyond_largest_deviation(value, "measure it in a larger range") {
            problems.at(&at.key(key), format!("{value}"), expected, advice);
        }
    }
    for (key, value) in ["u_alpha_arcsec", "u_beta_arcsec", "u_gamma_arcsec"].into_iter().zip(position.u_arcsec()) {
        problems.within(&at.key(key), value, 0.0, f64::MAX);
    }
    check_degrees_of_freedom(position.degrees_of_freedom, &at.key("degrees_of_freedom"), problems);
}
