//! Comparison of a later check run with the certificate: has the stand changed?
//!
//! The paper requires that positions repeat. The differences between check and certificate are therefore split into a
//! rotation common to all positions (of the platform or the base, because a datum surface, a level or a seat has
//! changed) and the remaining rotation of each position. Positions that do not repeat are found one by one, starting
//! with the worst, and are excluded from the common rotation. One bad position therefore does not make the others look
//! bad.

use super::components::{RunModel, Variance, case_turn, turns_at};
use super::finding::{ChangedSetting, Finding, Untested, findings};
use super::misread::Misread;
use super::rotated_runs;
use super::shared_settings::Setting;
use super::suspects::OUTLIER;
use super::{AngleReadings, Certification, Header, NominalPosition};
use crate::calibration::inputs::Turn;
use crate::calibration::recorded::rounding_of;
use crate::coefficients::PositionIndex;
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Stand};
use crate::statistics::beta::{f_beyond, f_larger};
use crate::statistics::least_squares::Factorised;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use serde::Serialize;

/// Probability by chance below which a check agrees better with the certificate than a new measurement can.
const TOO_CLOSE: f64 = 1e-6;

/// Reason why readings were not compared with a certificate.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotCompared {
    /// Certificate of another stand.
    #[error("the certificate is for {certificate}, but the readings are from {readings}")]
    OtherStand {
        /// Model and serial number in the certificate.
        certificate: String,
        /// Model and serial number in the header.
        readings: String,
    },
    /// Positions that are missing from the certificate or from the readings.
    #[error("certificate and readings differ in their positions or nominal angles: {0}")]
    OtherPositions(PositionIndex),
    /// Missing repeatability: the certificate states none, and a single run does not show it.
    #[error("the certificate states no repeatability, and one run does not show it; measure two runs or more")]
    NoRepeatability,
    /// Too few positions to distinguish a common rotation from changes of single positions.
    #[error("too few positions to distinguish a common rotation from changes of single positions")]
    TooFewPositions,
}

/// Result of a test with F, which is chi-square over its degrees of freedom if the uncertainties are known exactly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Test {
    /// Chi-square: the sum of squared differences in units of their standard uncertainties.
    pub chi_square: f64,
    /// Degrees of freedom of chi-square.
    pub degrees_of_freedom: usize,
    /// Probability of a larger value for an unchanged stand, by the F distribution, because the uncertainties have
    /// finite degrees of freedom themselves.
    pub probability: f64,
    /// Degrees of freedom of the uncertainties.
    #[serde(skip)]
    pub(crate) of_u: f64,
}

impl Test {
    fn new(chi_square: f64, degrees_of_freedom: usize, of_u: f64) -> Self {
        let probability = f_larger(chi_square / degrees_of_freedom as f64, degrees_of_freedom, of_u);
        Self { chi_square, degrees_of_freedom, probability, of_u }
    }

    /// Returns the statistic to which the probability belongs.
    pub(crate) fn f(&self) -> f64 {
        self.chi_square / self.degrees_of_freedom as f64
    }
}

/// Result of a comparison for one position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ComparedPosition {
    /// Index (i, j) of the position.
    #[serde(flatten)]
    pub index: PositionIndex,
    /// Rotation since the certificate about x, y, z of the case, relative to the other positions, arcsec.
    pub turn_arcsec: [f64; 3],
    /// Standard uncertainties of `turn_arcsec`, arcsec.
    pub u_arcsec: [f64; 3],
    /// Test of all three components at once, relative to the rotation common to the other positions.
    pub test: Test,
    /// `true` if the position repeats.
    pub repeats: bool,
}

/// Rotation common to all positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CommonTurn {
    /// Rotation of the platform about x, y, z of the case, arcsec.
    pub platform_arcsec: [f64; 3],
    /// Rotation of the base about east, north, up, arcsec; what cannot be distinguished from the platform is in
    /// `platform_arcsec`.
    pub base_arcsec: [f64; 3],
    /// Test of the common rotation against the variation between runs; `None` if that is unknown.
    pub test: Option<Test>,
}

/// Comparison of a check run with a certificate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Number of the certificate.
    pub certificate: String,
    /// Number of runs of the check.
    pub runs: usize,
    /// `true` if the stand has not changed: all positions repeat and agree, and no common rotation is significant.
    pub same_stand: bool,
    /// Test of all positions relative to each other, with the common rotation removed.
    pub all: Test,
    /// Results of the single positions.
    pub positions: Vec<ComparedPosition>,
    /// Rotation common to all positions that repeat.
    pub common: CommonTurn,
    /// Reasons and limits of the result.
    #[serde(skip)]
    pub(crate) findings: Vec<Finding>,
    /// The findings in words, a sentence each.
    pub words: Vec<String>,
}

/// Differences between check and certificate as rotations of the case, with their standard uncertainties and the model of
/// the common rotation.
#[derive(Clone)]
struct Differences {
    turns_arcsec: DVector<f64>,
    u_arcsec: DVector<f64>,
    degrees_of_freedom: f64,
    model: RunModel,
}

impl Comparison {
    /// Returns `true` if the readings of the check do not show whether the stand has changed: because of outliers among
    /// them, because they scatter much more than the certificate states, or because they are those of the certificate.
    pub(crate) fn is_undecided(&self) -> bool {
        let is_any = |of: fn(&Finding) -> bool| self.findings.iter().any(of);
        let unusable =
            is_any(Finding::is_outlier) || is_any(Finding::is_of_the_certificate) || is_any(Finding::is_large_scatter);
        !self.same_stand && unusable && !is_any(Finding::is_change)
    }
}

/// Compares `readings` of the stand of `header` with its certificate. `again` is the certification from these readings
/// alone, if they contain two runs or more.
///
/// # Errors
/// Returns [`NotCompared`] if the certificate is for another stand or other positions, if no repeatability is known, or
/// if there are too few positions.
pub fn compare(
    certificate: &Stand,
    header: &Header,
    readings: &AngleReadings,
    again: Option<&Certification>,
) -> Result<Comparison, NotCompared> {
    check_same(certificate, header)?;
    let scatter = repeatability(certificate, again).ok_or(NotCompared::NoRepeatability)?;
    let places: Vec<usize> = (0..certificate.positions.len()).collect();
    let mut differences = Differences::new(certificate, readings, scatter)?;
    let mut repeating = differences.repeating(&places);
    let misplaced = misplaced(certificate, readings, scatter, &repeating)?;
    // Misplaced readings scatter as if they were others, and explain more.
    let more = larger_scatter(scatter, again, readings).filter(|_| misplaced.is_empty());
    if let Some((of_check, _)) = more {
        differences = Differences::new(certificate, readings, of_check)?;
        repeating = differences.repeating(&places);
    }
    let all = differences.rest(&places).ok_or(NotCompared::TooFewPositions)?;
    let positions: Vec<_> = places
        .iter()
        .filter_map(|&place| {
            let of_position = differences.of_position(place, &repeating);
            // If too few positions repeat to give a reference for this one, compare it with all others.
            let (turn, u, test) = of_position.or_else(|| differences.of_position(place, &places))?;
            let repeats = repeating.contains(&place);
            let index = certificate.positions[place].index();
            Some(ComparedPosition { index, turn_arcsec: turn, u_arcsec: u, test, repeats })
        })
        .collect();
    let runs = readings.runs.len();
    let between = Between::new(&certificate.certificate, runs, again);
    let common = differences.common(&repeating, certificate, between.as_ref().ok());
    let common = common.ok_or(NotCompared::TooFewPositions)?;
    let untested = between.err().or(common.test.is_none().then_some(Untested::CommonParts));
    let moved = common.test.is_some_and(|test| test.probability < OUTLIER);
    let same_stand = repeating.len() == places.len() && all.probability >= OUTLIER && !moved;
    let mut findings = findings(all, &positions, &common, again, moved, untested, misplaced);
    if let Some(other) = findings.iter_mut().find(|found| **found == Finding::AnotherStand) {
        let setting = differences.setting(&header.positions).map(Finding::Setting);
        let worn = || differences.resemblance(certificate).map(Finding::Worn);
        *other = setting.or_else(worn).unwrap_or(Finding::AnotherStand);
    }
    if let Some((of_check, probability)) = more {
        let [of_check_arcsec, certified_arcsec] = [of_check, scatter].map(|variance| variance.value.sqrt());
        findings.push(Finding::ScattersMore { of_check_arcsec, certified_arcsec, probability });
    }
    if certificate.positions.iter().any(|at| certified_u_arcsec(at).is_none()) {
        findings.push(Finding::TreatedAsExact);
    }
    let evidence = certificate.certificate.evidence.as_ref();
    if evidence.is_some_and(|evidence| readings.sha256.as_ref() == Some(&evidence.readings_sha256)) {
        findings.push(Finding::SameReadings);
    } else if let Some(certified) = evidence
        && let Some(test) = differences.of_repeatability(scatter, [certified.runs as usize, readings.runs.len()])
        && 1.0 - test.probability < TOO_CLOSE
    {
        findings.push(Finding::TooClose);
    }
    let same_stand =
        same_stand && !findings.iter().any(|found| found.is_of_the_certificate() || found.is_large_scatter());
    let words = findings.iter().map(ToString::to_string).collect();
    let certificate = certificate.certificate.number.clone();
    Ok(Comparison { certificate, runs, all, positions, common, same_stand, findings, words })
}

/// Returns the findings on readings of which the angles stand in other places or in another unit.
fn misplaced(
    certificate: &Stand,
    readings: &AngleReadings,
    scatter: Variance,
    repeating: &[usize],
) -> Result<Vec<Finding>, NotCompared> {
    let certified: Vec<_> = certificate.positions.iter().map(|at| Vector3::from(at.angles_arcsec())).collect();
    let exchanged = exchanged(certificate, &certified, readings, scatter, repeating)?;
    let mut misplaced: Vec<Finding> = exchanged.into_iter().map(Finding::Exchanged).collect();
    if misplaced.is_empty() && repeating.is_empty() {
        misplaced.extend(Misread::of(&readings.means_arcsec(), &certified).map(Finding::Misread));
    }
    Ok(misplaced)
}

/// Returns the pairs of positions whose readings are exchanged: neither is among the `repeating` ones, the angles of each
/// are nearest to those `certified` for the other (α, β, γ, arcsec), and both repeat once they are exchanged.
fn exchanged(
    certificate: &Stand,
    certified: &[Vector3<f64>],
    readings: &AngleReadings,
    scatter: Variance,
    repeating: &[usize],
) -> Result<Vec<[PositionIndex; 2]>, NotCompared> {
    let places: Vec<usize> = (0..certified.len()).collect();
    let nearest: Vec<usize> = readings
        .means_arcsec()
        .iter()
        .map(|mean| {
            let distance = |place: usize| (mean - certified[place]).norm();
            places.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or_default()
        })
        .collect();
    let pair = |one: usize| {
        let other = nearest[one];
        let changed = [one, other].iter().all(|place| !repeating.contains(place));
        (one < other && nearest[other] == one && changed).then_some([one, other])
    };
    let pairs: Vec<[usize; 2]> = places.iter().filter_map(|place| pair(*place)).collect();
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let mut right = readings.clone();
    pairs.iter().for_each(|[one, other]| right.each_arcsec.swap(*one, *other));
    let repeating = Differences::new(certificate, &right, scatter)?.repeating(&places);
    let repeat = |pair: &&[usize; 2]| pair.iter().all(|place| repeating.contains(place));
    Ok(pairs.iter().filter(repeat).map(|pair| pair.map(|place| certificate.positions[place].index())).collect())
}

fn check_same(certificate: &Stand, header: &Header) -> Result<(), NotCompared> {
    let name = |stand: &crate::stand::Identity| format!("{} {}", stand.model, stand.serial);
    let (of_certificate, of_readings) = (name(&certificate.stand), name(&header.stand));
    if of_certificate != of_readings {
        return Err(NotCompared::OtherStand { certificate: of_certificate, readings: of_readings });
    }
    let nominal: Vec<NominalPosition> = certificate.positions.iter().map(NominalPosition::from).collect();
    let alone = |a: &[NominalPosition], b: &[NominalPosition]| a.iter().find(|at| !b.contains(at)).map(|at| at.index());
    match alone(&nominal, &header.positions).or_else(|| alone(&header.positions, &nominal)) {
        Some(index) => Err(NotCompared::OtherPositions(index)),
        None => Ok(()),
    }
}

/// Returns the variance of one visit, arcsec²: the certificate's, else the check's own; `None` if neither states one.
fn repeatability(certificate: &Stand, again: Option<&Certification>) -> Option<Variance> {
    let stated = certificate.certificate.repeatability_arcsec.filter(|u| *u > 0.0);
    let degrees_of_freedom = certificate.certificate.repeatability_degrees_of_freedom.unwrap_or(f64::INFINITY);
    let stated = stated.map(|u| Variance { value: u * u, degrees_of_freedom });
    stated.or_else(|| again.map(|again| again.components.pooled_arcsec2))
}

/// Returns the variance of one visit of the check, arcsec², and its probability by chance, if it is larger than the
/// certified one, `scatter`, by more than chance and the rounding of the readings explain. Outliers, which are suspect
/// already, do not count.
fn larger_scatter(
    scatter: Variance,
    again: Option<&Certification>,
    readings: &AngleReadings,
) -> Option<(Variance, f64)> {
    let again = again.filter(|again| {
        again.suspects.split.is_none() && again.suspects.outliers.iter().all(|out| out.probability >= OUTLIER)
    })?;
    let found = again.components.pooled_arcsec2;
    let expected = scatter.value + square(rounding_of(readings.step_arcsec));
    let probability = f_beyond(found.value / expected, found.degrees_of_freedom, scatter.degrees_of_freedom);
    (probability < OUTLIER).then_some((found, probability))
}

/// Returns the certified standard uncertainties of α, β, γ of a position, or `None` if one is not stated.
fn certified_u_arcsec(position: &CertifiedPosition) -> Option<Vector3<f64>> {
    Some(Vector3::new(position.u_alpha_arcsec?, position.u_beta_arcsec?, position.u_gamma_arcsec?))
}

impl Differences {
    fn new(certificate: &Stand, readings: &AngleReadings, scatter: Variance) -> Result<Self, NotCompared> {
        let positions: Vec<_> = certificate.positions.iter().map(CertifiedPosition::to_model).collect();
        let certified: Vec<_> = certificate.positions.iter().map(|at| Vector3::from(at.angles_arcsec())).collect();
        let turns = turns_at(&positions, &certified);
        let model = RunModel::new(turns).ok_or(NotCompared::TooFewPositions)?;
        let rows = 3 * positions.len();
        let (mut turned, mut u) = (DVector::zeros(rows), DVector::zeros(rows));
        let of_check = scatter.value / readings.runs.len() as f64;
        let mut freedom = f64::INFINITY;
        for (place, turn) in model.turns.iter().enumerate() {
            let change = readings.means_arcsec()[place] - certified[place];
            turned.fixed_rows_mut::<3>(3 * place).copy_from(&case_turn(turn, &change));
            let position = &certificate.positions[place];
            let own = own_variance(turn, &certified_u_arcsec(position).unwrap_or_default());
            let rounding = [0, 1, 2].map(|angle| readings.rounding_of_mean_arcsec(place, angle));
            let both = (own + own_variance(turn, &rounding.into())).map(|variance| variance + of_check);
            u.fixed_rows_mut::<3>(3 * place).copy_from(&both.map(f64::sqrt));
            // Welch and Satterthwaite, GUM (JCGM 100), eq. (G.2b), for the axis with the fewest degrees of freedom.
            let of_certificate = position.degrees_of_freedom.unwrap_or(f64::INFINITY);
            for axis in 0..3 {
                let parts = own[axis] * own[axis] / of_certificate + of_check * of_check / scatter.degrees_of_freedom;
                freedom = freedom.min(both[axis] * both[axis] / parts);
            }
        }
        Ok(Self { turns_arcsec: turned, u_arcsec: u, degrees_of_freedom: freedom, model })
    }

    /// Returns the rotation common to `places` by weighted least squares, the R⁻¹ of the fit, and the residual
    /// chi-square; `None` if these positions do not determine it.
    fn shared(&self, places: &[usize]) -> Option<(DVector<f64>, DMatrix<f64>, f64)> {
        self.fit(&self.model.design, places)
    }

    /// Fits the rotations of a `design` to those of `places`, as [`Self::shared`] does.
    fn fit(&self, design: &DMatrix<f64>, places: &[usize]) -> Option<(DVector<f64>, DMatrix<f64>, f64)> {
        let rows: Vec<usize> = places.iter().flat_map(|place| (3 * place)..(3 * place + 3)).collect();
        let weighted = DMatrix::from_fn(rows.len(), design.ncols(), |row, column| {
            design[(rows[row], column)] / self.u_arcsec[rows[row]]
        });
        let mut right =
            DMatrix::from_fn(rows.len(), 1, |row, _| self.turns_arcsec[rows[row]] / self.u_arcsec[rows[row]]);
        let model = Factorised::new(weighted)?;
        if model.condition_bound() > 1e6 {
            return None;
        }
        model.rotate(&mut right);
        let (shared, _) = model.solve_rotated(&right);
        let rest = right.column(0).rows(model.columns, rows.len() - model.columns).norm_squared();
        Some((shared, model.r_inverse, rest))
    }

    /// Returns the chi-square test of all positions relative to each other if only the repeatability acts. `scatter` is the
    /// variance of one visit, and `runs` the numbers of runs of certificate and check.
    fn of_repeatability(&self, scatter: Variance, runs: [usize; 2]) -> Option<Test> {
        let variance: f64 = runs.into_iter().map(|runs| scatter.value / runs as f64).sum();
        let places: Vec<usize> = (0..self.u_arcsec.len() / 3).collect();
        let u_arcsec = DVector::repeat(self.u_arcsec.len(), variance.sqrt());
        Self { u_arcsec, degrees_of_freedom: scatter.degrees_of_freedom, ..self.clone() }.rest(&places)
    }

    /// Returns the chi-square test of positions relative to each other, or `None` if they leave no degrees of freedom.
    fn rest(&self, places: &[usize]) -> Option<Test> {
        let degrees_of_freedom = (3 * places.len()).checked_sub(self.model.design.ncols()).filter(|rest| *rest > 0)?;
        let (_, _, chi_square) = self.shared(places)?;
        Some(self.test(chi_square, degrees_of_freedom))
    }

    /// Returns the change of one setting that explains all differences: the positions with one value of θ or φ have rotated
    /// about the axis of that angle.
    fn setting(&self, positions: &[NominalPosition]) -> Option<ChangedSetting> {
        let places: Vec<usize> = (0..positions.len()).collect();
        let columns = self.model.design.ncols();
        let freedom = (3 * positions.len()).checked_sub(columns + 1).filter(|freedom| *freedom > 0)?;
        let of_value = |setting: Setting, angle_deg: f64| {
            let mut design = self.model.design.clone().insert_column(columns, 0.0);
            for place in places.iter().copied().filter(|place| setting.of(&positions[*place]) == angle_deg) {
                let axis = setting.axis(&self.model.turns[place]);
                design.fixed_view_mut::<3, 1>(3 * place, columns).copy_from(&axis);
            }
            let (found, _, rest) = self.fit(&design, &places)?;
            let explains = self.test(rest, freedom).probability >= OUTLIER;
            explains.then_some((rest, ChangedSetting { setting, angle_deg, turn_arcsec: found[columns] }))
        };
        let each = Setting::ALL.into_iter().flat_map(|setting| {
            let mut values: Vec<f64> = positions.iter().map(|at| setting.of(at)).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            // Of two values either may have changed: the smaller is the reference.
            values.into_iter().skip(1).map(move |angle_deg| (setting, angle_deg))
        });
        let found = each.filter_map(|(setting, angle_deg)| of_value(setting, angle_deg));
        found.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, changed)| changed)
    }

    /// Returns the correlation of the readings with the certified deviations, without the rotations common to all
    /// positions, or `None` if it may be chance (Student's t, one-sided).
    fn resemblance(&self, certificate: &Stand) -> Option<f64> {
        let certified = certificate.positions.iter().zip(&self.model.turns);
        let certified: Vec<f64> = certified
            .flat_map(|(at, turn)| <[f64; 3]>::from(case_turn(turn, &Vector3::from(at.angles_arcsec()))))
            .collect();
        let certified = DVector::from_vec(certified);
        let mut both = DMatrix::from_columns(&[&certified + &self.turns_arcsec, certified]);
        let model = Factorised::new(self.model.design.clone())?;
        model.rotate(&mut both);
        let rest = both.rows(model.columns, both.nrows() - model.columns);
        let (read, certified) = (rest.column(0), rest.column(1));
        let correlation = read.dot(&certified) / (read.norm() * certified.norm());
        let freedom = rest.nrows().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
        let t_square = correlation * correlation * freedom / (1.0 - correlation * correlation);
        (correlation > 0.0 && f_larger(t_square, 1, freedom) / 2.0 < OUTLIER).then_some(correlation)
    }

    fn test(&self, chi_square: f64, degrees_of_freedom: usize) -> Test {
        Test::new(chi_square, degrees_of_freedom, self.degrees_of_freedom)
    }

    /// Returns the rotation of a position relative to that of the `others` (without itself), its standard
    /// uncertainties, and the test of all three components at once.
    fn of_position(&self, place: usize, others: &[usize]) -> Option<([f64; 3], [f64; 3], Test)> {
        let others: Vec<usize> = others.iter().copied().filter(|other| *other != place).collect();
        let (shared, r_inverse, _) = self.shared(&others)?;
        let design = self.model.design.rows(3 * place, 3);
        let turn: Vector3<f64> = self.turns_arcsec.fixed_rows::<3>(3 * place) - design * shared;
        let spread = design * r_inverse;
        let own = self.u_arcsec.fixed_rows::<3>(3 * place).map(|u| u * u);
        let covariance = Matrix3::from_diagonal(&own) + &spread * spread.transpose();
        let chi_square = turn.dot(&covariance.cholesky()?.solve(&turn));
        let u = covariance.diagonal().map(f64::sqrt);
        Some((turn.into(), u.into(), self.test(chi_square, 3)))
    }

    /// Returns the positions that repeat: the worst is removed repeatedly while it disagrees with the others.
    fn repeating(&self, places: &[usize]) -> Vec<usize> {
        let mut left = places.to_vec();
        while let Some(worst) = self.worst(&left, places.len()) {
            left.retain(|place| *place != worst);
            // If no more than half agree, the readings do not show which half is right.
            if 2 * left.len() <= places.len() {
                return Vec::new();
            }
        }
        left
    }

    fn worst(&self, left: &[usize], positions: usize) -> Option<usize> {
        let tests = left.iter().filter_map(|&place| Some((place, self.of_position(place, left)?.2)));
        let worst = tests.max_by(|(_, a), (_, b)| a.chi_square.total_cmp(&b.chi_square));
        // Bonferroni correction: this is the largest of `positions` test values.
        worst.filter(|(_, test)| test.probability * (positions as f64) < OUTLIER).map(|(place, _)| place)
    }

    /// Returns the rotation common to the `repeating` positions (to all if none repeat), with its test.
    fn common(&self, repeating: &[usize], certificate: &Stand, between: Option<&Between>) -> Option<CommonTurn> {
        let every: Vec<usize> = (0..certificate.positions.len()).collect();
        let (shared, r_inverse, _) = self.shared(if repeating.is_empty() { &every } else { repeating })?;
        let [platform_arcsec, base_arcsec] = self.model.rotations(&shared);
        let certificate = &certificate.certificate;
        let test = between.and_then(|between| self.common_test(&shared, &r_inverse, certificate, between));
        Some(CommonTurn { platform_arcsec, base_arcsec, test })
    }

    /// Tests the common rotation against the variation between whole runs; returns `None` if the certificate does not
    /// state its common parts.
    fn common_test(
        &self,
        shared: &DVector<f64>,
        r_inverse: &DMatrix<f64>,
        certificate: &Certificate,
        between: &Between,
    ) -> Option<Test> {
        let platform = square(certificate.common_platform_arcsec?) + between.platform_arcsec2 / between.runs;
        let base = match shared.len() {
            3 => 0.0,
            _ => square(certificate.common_base_arcsec?) + between.base_arcsec2 / between.runs,
        };
        // The scatter of the positions, in certificate and check, also contributes to the estimated common rotation.
        let mut covariance = r_inverse * r_inverse.transpose();
        for at in 0..shared.len() {
            covariance[(at, at)] += if at < 3 { platform } else { base };
        }
        let chi_square = shared.dot(&covariance.cholesky()?.solve(shared));
        Some(Test::new(chi_square, shared.len(), between.degrees_of_freedom.min(self.degrees_of_freedom)))
    }
}

fn square(value: f64) -> f64 {
    value * value
}

/// Variances between whole runs, per axis, and the number of runs that the check averages.
struct Between {
    runs: f64,
    platform_arcsec2: f64,
    base_arcsec2: f64,
    /// Degrees of freedom: three axes in each run but one, of whichever of check and certificate has fewer.
    degrees_of_freedom: f64,
}

impl Between {
    /// Returns the variation of the check itself if it has several runs, else that of the certificate's readings.
    ///
    /// # Errors
    /// Returns the reason if neither shows it.
    fn new(certificate: &Certificate, runs: usize, again: Option<&Certification>) -> Result<Self, Untested> {
        let evidence = certificate.evidence.as_ref().map(|evidence| f64::from(evidence.runs));
        let degrees_of_freedom = |runs: f64| 3.0 * (runs - 1.0);
        let of_certificate = evidence.map_or(f64::INFINITY, degrees_of_freedom);
        if runs > 1 {
            let again = again.ok_or(Untested::Variation)?;
            let of_check = rotated_runs::variance(&again.components, &again.rotated_runs);
            return Ok(Self {
                runs: runs as f64,
                platform_arcsec2: of_check.platform_arcsec2,
                base_arcsec2: of_check.base_arcsec2,
                degrees_of_freedom: (3.0 * of_check.changes as f64).min(of_certificate),
            });
        }
        let evidence = evidence.ok_or(Untested::NumberOfRuns)?;
        let of_one_run = |common: Option<f64>, on: ActsOn| {
            let of_mean = square(common.unwrap_or(0.0)) - certificate.type_b_arcsec2(on);
            of_mean.max(0.0) * evidence
        };
        Ok(Self {
            runs: 1.0,
            platform_arcsec2: of_one_run(certificate.common_platform_arcsec, ActsOn::Platform),
            base_arcsec2: of_one_run(certificate.common_base_arcsec, ActsOn::Base),
            degrees_of_freedom: of_certificate,
        })
    }
}

/// Returns the variances of the rotation about x, y, z of the case that result from the uncertainties of α, β, γ.
fn own_variance(turn: &Turn, u_arcsec: &Vector3<f64>) -> Vector3<f64> {
    (0..3).fold(Vector3::zeros(), |sum, angle| {
        let part = turn.axes[angle] * u_arcsec[angle];
        sum + part.component_mul(&part)
    })
}
