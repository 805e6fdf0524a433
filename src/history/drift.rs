//! Drift of the certified deviations: a straight line through each over the years, and the tests of the line and of its
//! slope. A deviation that is not on a line has jumped: it has no rate. Deviations are also tested relative to each other, for
//! a change of one position that the parts common to all positions hide.

use crate::calibration::inputs::Turn;
use crate::certification::differences::turned;
use crate::certification::{CommonTurn, NominalPosition};
use crate::coefficients::PositionIndex;
use crate::passport::difference::u_of_deviations_arcsec;
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Stand};
use crate::statistics::straight_line::{Point, StraightLine, holm};
use crate::statistics::student::{detectable, effective_degrees_of_freedom, f_larger};
use jiff::civil::Date;
use nalgebra::{DMatrix, DVector, Matrix3};
use serde::Serialize;

/// Corrected probability below which a deviation drifts, as for an outlier in
/// [ISO 5725-2](crate::bibliography::Bibliography::Iso5725).
pub(crate) const DRIFTS: f64 = 0.01;

/// Corrected probability below which a drift is suspected, as for a straggler.
pub(crate) const SUSPECTED: f64 = 0.05;

/// Mean length of a year of the Gregorian calendar, days.
const DAYS_PER_YEAR: f64 = 365.2425;

/// Value of a deviation in one certificate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Value {
    /// Number of the certificate.
    pub certificate: String,
    /// Date to which the value belongs.
    pub date: Date,
    /// Years since the first certificate of the stand.
    #[serde(skip)]
    pub years: f64,
    /// Deviation, arcsec.
    pub arcsec: f64,
    /// Deviation without the rotations common to all positions, arcsec.
    #[serde(skip)]
    pub without_common_arcsec: f64,
    /// Combined standard uncertainty of the deviation, arcsec: own and common parts; `None` if not stated.
    pub u_arcsec: Option<f64>,
    /// Degrees of freedom of that uncertainty.
    #[serde(skip)]
    pub degrees_of_freedom: f64,
}

/// One deviation of a position over the years.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Series {
    /// Index (i, j) of the position.
    pub index: PositionIndex,
    /// Angle: 0, 1, 2 for α, β, γ.
    pub angle: usize,
    /// Values in the order of time, also those without an uncertainty, which cannot be weighted and are not tested.
    pub values: Vec<Value>,
    /// Fitted line in arcseconds over years; `None` without two certificates of different dates that state the
    /// uncertainty, and for a deviation that has jumped.
    pub line: Option<StraightLine>,
    /// Largest change, if the values are not on a line.
    pub jump: Option<Jump>,
    /// Probability of the slope or a larger one without drift, corrected for the number of tested deviations.
    pub corrected_probability: Option<f64>,
}

/// Change of a deviation that a straight line does not describe.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Jump {
    /// Numbers of the two successive certificates between which the change is largest in units of its uncertainty.
    pub certificates: [String; 2],
    /// Change between them, arcsec.
    pub change_arcsec: f64,
    /// Standard uncertainty of that change, arcsec.
    pub u_arcsec: f64,
    /// Line that was rejected.
    #[serde(skip)]
    pub line: StraightLine,
    /// Probability of a larger chi-square if the values were on a line, corrected for the number of tested deviations.
    pub corrected_probability: f64,
}

/// Rotation of all positions together between two successive certificates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CommonJump {
    /// Numbers of the certificates.
    pub certificates: [String; 2],
    pub turn: CommonTurn,
    /// Probability of a larger rotation if none occurred, corrected for the number of pairs.
    pub probability: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Drift {
    /// Significant rotations of all positions together, without which the deviations are tested.
    pub common: Vec<CommonJump>,

    /// Every deviation of every position, sorted by (i, j), then α, β, γ.
    pub series: Vec<Series>,
    /// Deviations relative to the others of their certificate; empty if no common parts are stated.
    pub relative: Vec<Series>,
}

impl Drift {
    /// Compares the certificates of one stand, which are in the order of their measurement.
    ///
    /// The uncertainties of different certificates are taken as independent. Contributions that they share, such as
    /// those of one autocollimator, then make a drift look less significant than it is. The parts common to the positions
    /// of one certificate do so, too; therefore the deviations are also tested relative to each other.
    pub(crate) fn of(certificates: &[&Stand]) -> Self {
        let Some(first) = certificates.first().map(|stand| stand.certificate.measured()) else {
            return Self { common: Vec::new(), series: Vec::new(), relative: Vec::new() };
        };
        let (common, tested) = without_common(certificates);
        let tested: Vec<&Stand> = tested.iter().collect();
        let positions = certificates.iter().flat_map(|stand| &stand.positions);
        let mut nominal: Vec<NominalPosition> = positions.map(NominalPosition::from).collect();
        let angles = |a: &NominalPosition, b: &NominalPosition| {
            a.theta_deg.total_cmp(&b.theta_deg).then(a.phi_deg.total_cmp(&b.phi_deg))
        };
        nominal.sort_by(|a, b| a.index().cmp(&b.index()).then_with(|| angles(a, b)));
        nominal.dedup();
        let mut series: Vec<Series> = nominal
            .iter()
            .flat_map(|position| (0..3).map(move |angle| (position, angle)))
            .map(|(position, angle)| {
                let both = certificates.iter().zip(&tested);
                let values = both.filter_map(|(stand, tested)| value(stand, tested, position, angle, first)).collect();
                Series::of(position.index(), angle, values)
            })
            .collect();
        let mut relative = relative_series(&tested, first);
        for all in [&mut series, &mut relative] {
            test_lines(all);
        }
        Self { common, series, relative }
    }

    pub(crate) fn tested(&self) -> usize {
        self.series.iter().filter(|series| series.line.is_some() || series.jump.is_some()).count()
    }

    pub(crate) fn jumps(&self) -> impl Iterator<Item = (&Series, &Jump)> {
        self.series.iter().filter_map(|at| Some((at, at.jump.as_ref()?)))
    }

    /// Returns the least probable jump, or `None` if no deviation has jumped.
    pub(crate) fn worst_jump(&self) -> Option<(&Series, &Jump)> {
        self.jumps().min_by(|(_, a), (_, b)| {
            let by_size = || (b.change_arcsec / b.u_arcsec).abs().total_cmp(&(a.change_arcsec / a.u_arcsec).abs());
            a.corrected_probability.total_cmp(&b.corrected_probability).then_with(by_size)
        })
    }

    /// Returns the deviation with the least corrected probability, or `None` if none was tested.
    pub(crate) fn most_significant(&self) -> Option<&Series> {
        let tested = self.series.iter().filter_map(|series| Some((series.line?.probability(), series)));
        tested.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, series)| series)
    }

    /// Returns the smallest drift that is found in any deviation with a probability of 95 %, ″/year; `None` if none was tested, or the
    /// uncertainties have too few degrees of freedom.
    pub(crate) fn detectable_arcsec_per_year(&self) -> Option<f64> {
        let level = DRIFTS / self.tested() as f64;
        let of = |line: &StraightLine| Some(line.u_slope * detectable(level, 1, line.slope_degrees_of_freedom)?);
        let each: Option<Vec<f64>> = self.series.iter().filter_map(|series| series.line.as_ref()).map(of).collect();
        each?.into_iter().reduce(f64::max)
    }

    /// Returns the deviation that has changed most relative to the others, steadily or in a jump, or `None` if no such
    /// change is significant, or if a deviation shows one by itself.
    pub(crate) fn hidden_change(&self) -> Option<&Series> {
        if self.series.iter().any(Series::has_changed) {
            return None;
        }
        // The others change too, relative to the one that moved, but less: chi-square of no change at all tells which.
        let chi_square = |at: &Series| {
            let line = at.line.or(at.jump.as_ref().map(|jump| jump.line));
            line.map_or(0.0, |line| line.chi_square + (line.slope / line.u_slope).powi(2))
        };
        let changed = self.relative.iter().filter(|at| at.has_changed());
        changed.max_by(|a, b| chi_square(a).total_cmp(&chi_square(b)))
    }

    /// Returns `true` if any deviation has drifted or jumped, by itself or relative to the others.
    pub(crate) fn has_changed(&self) -> bool {
        !self.common.is_empty() || self.series.iter().any(Series::has_changed) || self.hidden_change().is_some()
    }

    /// Returns whether any deviation drifts steadily, by itself or relative to the others, or `None` if none was tested.
    pub(crate) fn drifts(&self) -> Option<bool> {
        (self.tested() > 0).then(|| self.series.iter().chain(self.hidden_change()).any(Series::is_drift))
    }
}

/// Returns the places of the series that have a `probability`, with this probability corrected for their number by Holm's
/// procedure.
fn corrected(series: &[Series], probability: impl Fn(&Series) -> Option<f64>) -> Vec<(usize, f64)> {
    let tested = series.iter().enumerate().filter_map(|(at, one)| Some((at, probability(one)?)));
    let (places, probabilities): (Vec<usize>, Vec<f64>) = tested.unzip();
    places.into_iter().zip(holm(&probabilities)).collect()
}

/// Returns the years from the first certificate to the measurement of another one.
fn years(first: Date, certificate: &Certificate) -> f64 {
    let days = first.until(certificate.measured()).map_or(0, |span| span.get_days());
    f64::from(days) / DAYS_PER_YEAR
}

/// Tests the slope of every line, and replaces the lines that their own residuals reject by the largest change. F allows for
/// the degrees of freedom of the uncertainties.
fn test_lines(series: &mut [Series]) {
    for (at, corrected) in corrected(series, |at| Some(at.line?.probability())) {
        series[at].corrected_probability = Some(corrected);
    }
    let probability = |at: &Series| {
        let line = at.line.filter(|line| line.degrees_of_freedom > 0)?;
        let fewest = at.values.iter().map(|value| value.degrees_of_freedom).fold(f64::INFINITY, f64::min);
        let ratio = line.chi_square / line.degrees_of_freedom as f64;
        Some(f_larger(ratio, line.degrees_of_freedom, fewest))
    };
    for (at, corrected) in corrected(series, probability) {
        let one = &mut series[at];
        if corrected < DRIFTS
            && let Some(jump) = one.largest_change(corrected)
        {
            one.jump = Some(jump);
            one.line = None;
            one.corrected_probability = None;
        }
    }
}

/// Returns the significant rotations of all positions together between successive certificates, such as that of a mirror
/// that was mounted anew, and the certificates with the angles without them.
fn without_common(certificates: &[&Stand]) -> (Vec<CommonJump>, Vec<Stand>) {
    let mut tested: Vec<Stand> = certificates.iter().copied().cloned().collect();
    let mut found = Vec::new();
    for place in 1..tested.len() {
        let Some((turn, _)) = turned(certificates[place - 1], certificates[place]) else { continue };
        let probability = turn.test.map_or(1.0, |test| (test.probability * (tested.len() - 1) as f64).min(1.0));
        if probability < DRIFTS {
            let certificates = [place - 1, place].map(|place| certificates[place].certificate.number.clone());
            found.push(CommonJump { certificates, turn, probability });
        }
        // All that follow a rotation have it.
        let without = turned(&tested[place - 1], certificates[place]).filter(|_| !found.is_empty());
        let angles = without.into_iter().flat_map(|(_, angles)| angles);
        for (at, angles) in tested[place].positions.iter_mut().zip(angles) {
            [at.alpha_arcsec, at.beta_arcsec, at.gamma_arcsec] = angles.into();
        }
    }
    (found, tested)
}

/// Returns the value of a deviation in a certificate, or `None` if it does not contain the position; `tested` is the
/// certificate without the rotations common to all positions.
fn value(stand: &Stand, tested: &Stand, nominal: &NominalPosition, angle: usize, first: Date) -> Option<Value> {
    let (at, without) = (position(stand, nominal)?, position(tested, nominal)?);
    let u_arcsec = u_of_deviations_arcsec(at, &stand.certificate)[angle];
    Some(Value {
        certificate: stand.certificate.number.clone(),
        date: stand.certificate.measured(),
        years: years(first, &stand.certificate),
        arcsec: at.angles_arcsec()[angle],
        without_common_arcsec: without.angles_arcsec()[angle],
        u_arcsec,
        degrees_of_freedom: u_arcsec.map_or(f64::INFINITY, |u| degrees_of_freedom(stand, at, angle, u)),
    })
}

/// Returns the effective degrees of freedom of the combined uncertainty `u` of a deviation. The part common to a run
/// varies about three axes in each of the runs but one; contributions of type B are taken as known exactly.
fn degrees_of_freedom(stand: &Stand, at: &CertifiedPosition, angle: usize, u: f64) -> f64 {
    let certificate = &stand.certificate;
    let own = at.u_arcsec()[angle].unwrap_or(0.0);
    let runs = certificate.freedom_of_runs();
    let type_b = [ActsOn::Platform, ActsOn::Base].map(|on| certificate.type_b_arcsec2(on)).iter().sum::<f64>();
    let common = (u * u - own * own).max(0.0);
    let repeated = (common - type_b).max(0.0);
    effective_degrees_of_freedom(&[
        (own, at.degrees_of_freedom.unwrap_or(f64::INFINITY)),
        (repeated.sqrt(), if runs > 0.0 { runs } else { 1.0 }),
        ((common - repeated).sqrt(), f64::INFINITY),
    ])
}

/// Returns every deviation less its expectation given the others, up to a constant, with the uncertainty of this
/// difference; `first` is the date of the first certificate. Certificates that do not state all uncertainties, and
/// positions that are not in all of the others, are left out; empty if nothing common is stated or nothing can be compared.
///
/// Platform and base are set up again for every certificate, which rotates all positions together. If these common parts are
/// larger than the own part of a position, its drift does not show in the deviation itself; its expectation given the others
/// they do not change much.
///
/// With the covariance V of the deviations y of a certificate, mean of all certificates, the difference of y_k from its
/// expectation is (V⁻¹ y)_k / (V⁻¹)_kk.
fn relative_series(certificates: &[&Stand], first: Date) -> Vec<Series> {
    let stated = |stand: &&&Stand| stand.positions.iter().all(|at| at.u_arcsec().iter().all(Option::is_some));
    let known: Vec<&Stand> = certificates.iter().filter(stated).copied().collect();
    let is_common = |stand: &&Stand| {
        let certificate = &stand.certificate;
        [certificate.common_platform_arcsec, certificate.common_base_arcsec].iter().flatten().any(|u| *u > 0.0)
    };
    if known.len() < 2 || !known.iter().any(is_common) {
        return Vec::new();
    }
    let mut wanted: Vec<NominalPosition> = known[0].positions.iter().map(NominalPosition::from).collect();
    wanted.retain(|at| known.iter().all(|stand| position(stand, at).is_some()));
    wanted.sort_by_key(NominalPosition::index);
    let each = known.iter().map(|stand| {
        let positions: Vec<_> = wanted.iter().filter_map(|at| position(stand, at)).collect();
        (covariance(&positions, &stand.certificate), positions, *stand)
    });
    let each: Vec<_> = each.collect();
    let size = 3 * wanted.len();
    let mean = each.iter().fold(DMatrix::zeros(size, size), |sum, (covariance, ..)| sum + covariance);
    let Some(inverse) = mean.cholesky().map(|factor| factor.inverse()) else { return Vec::new() };
    let relative = DMatrix::from_fn(size, size, |row, column| inverse[(row, column)] / inverse[(row, row)]);
    let values = each.iter().map(|(covariance, positions, stand)| {
        let deviations = DVector::from_iterator(size, positions.iter().flat_map(|at| at.angles_arcsec()));
        let variance = (&relative * covariance * relative.transpose()).diagonal();
        let differences = &relative * deviations;
        let value = |row: usize| Value {
            certificate: stand.certificate.number.clone(),
            date: stand.certificate.measured(),
            years: years(first, &stand.certificate),
            arcsec: differences[row],
            without_common_arcsec: differences[row],
            u_arcsec: Some(variance[row].sqrt()),
            degrees_of_freedom: positions[row / 3].degrees_of_freedom.unwrap_or(f64::INFINITY),
        };
        (0..size).map(value).collect::<Vec<_>>()
    });
    let values: Vec<Vec<Value>> = values.collect();
    let of_row = |row: usize| {
        let values = values.iter().map(|certificate| certificate[row].clone()).collect();
        Series::of(wanted[row / 3].index(), row % 3, values)
    };
    (0..size).map(of_row).collect()
}

fn position<'a>(stand: &'a Stand, nominal: &NominalPosition) -> Option<&'a CertifiedPosition> {
    stand.positions.iter().find(|at| NominalPosition::from(*at) == *nominal)
}

/// Returns the covariance of α, β, γ of all positions, arcsec²: their own parts, and the turns of platform and base.
fn covariance(positions: &[&CertifiedPosition], certificate: &Certificate) -> DMatrix<f64> {
    let size = 3 * positions.len();
    let (mut platform, mut base) = (DMatrix::zeros(size, 3), DMatrix::zeros(size, 3));
    let mut own = DVector::zeros(size);
    for (place, at) in positions.iter().enumerate() {
        let turn = Turn::of(&at.to_model(), &Matrix3::identity());
        let to_angles = turn.angles_of_rotation();
        platform.fixed_rows_mut::<3>(3 * place).copy_from(&to_angles);
        base.fixed_rows_mut::<3>(3 * place).copy_from(&(to_angles * turn.attitude));
        for (angle, u) in at.u_arcsec().into_iter().enumerate() {
            own[3 * place + angle] = u.unwrap_or(0.0) * u.unwrap_or(0.0);
        }
    }
    let common =
        |turns: DMatrix<f64>, u: Option<f64>| &turns * turns.transpose() * (u.unwrap_or(0.0) * u.unwrap_or(0.0));
    DMatrix::from_diagonal(&own)
        + common(platform, certificate.common_platform_arcsec)
        + common(base, certificate.common_base_arcsec)
}

impl Series {
    fn of(index: PositionIndex, angle: usize, values: Vec<Value>) -> Self {
        let point = |at: &Value| {
            Some(Point {
                x: at.years,
                y: at.without_common_arcsec,
                u: at.u_arcsec?,
                degrees_of_freedom: at.degrees_of_freedom,
            })
        };
        let points: Vec<Point> = values.iter().filter_map(point).collect();
        let line = StraightLine::fit(&points);
        Self { index, angle, values, line, jump: None, corrected_probability: None }
    }

    /// Returns `true` if the slope is significant.
    pub(crate) fn is_drift(&self) -> bool {
        self.corrected_probability.is_some_and(|probability| probability < DRIFTS)
    }

    fn has_changed(&self) -> bool {
        self.jump.is_some() || self.is_drift()
    }

    /// Returns the change between the first and the last tested value with its standard uncertainty, arcsec, or `None` if no
    /// value was tested.
    pub(crate) fn change(&self) -> Option<(f64, f64)> {
        let (first, last) = (self.tested_values().next()?, self.tested_values().next_back()?);
        Some((last.without_common_arcsec - first.without_common_arcsec, libm::hypot(last.u_arcsec?, first.u_arcsec?)))
    }

    /// Returns the values that were tested: those with an uncertainty.
    pub(crate) fn tested_values(&self) -> impl DoubleEndedIterator<Item = &Value> {
        self.values.iter().filter(|at| at.u_arcsec.is_some())
    }

    /// Returns the largest change between successive certificates in units of its uncertainty, as the jump that makes the
    /// line improbable.
    fn largest_change(&self, corrected_probability: f64) -> Option<Jump> {
        let line = self.line?;
        let change = |pair: &[Value]| {
            let [before, after] = pair else { return None };
            let u_arcsec = libm::hypot(before.u_arcsec?, after.u_arcsec?);
            let certificates = [before.certificate.clone(), after.certificate.clone()];
            let change_arcsec = after.without_common_arcsec - before.without_common_arcsec;
            Some(Jump { certificates, change_arcsec, u_arcsec, line, corrected_probability })
        };
        let size = |jump: &Jump| (jump.change_arcsec / jump.u_arcsec).abs();
        let known: Vec<Value> = self.tested_values().cloned().collect();
        // Of equal changes, the first.
        known.windows(2).rev().filter_map(change).max_by(|a, b| size(a).total_cmp(&size(b)))
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;

    fn stand(date: &str, number: &str, change: impl Fn(&mut CertifiedPosition)) -> Stand {
        let mut stand = Stand::from_yaml("stand", include_bytes!("../../passports/SPS-2/0017/stand.yaml")).unwrap();
        stand.certificate.performed = Some(date.parse().unwrap());
        stand.certificate.number = number.to_owned();
        stand.positions.iter_mut().for_each(change);
        stand
    }

    /// Drift over four certificates, a year apart, with these changes of γ of one position.
    fn drift(changes: [f64; 4]) -> Drift {
        let stands = [0, 1, 2, 3].map(|year| {
            stand(&format!("20{}-06-01", 20 + year), &format!("C-{year}"), |at| {
                if (at.i, at.j) == (2, 3) {
                    at.gamma_arcsec += changes[year];
                }
            })
        });
        Drift::of(&stands.each_ref())
    }

    /// Expected: one deviation with a rate of many u is found, and no other; without a rate none is.
    #[test]
    fn the_deviation_that_drifts_is_found() {
        let still = drift([0.0; 4]);
        assert_eq!((still.series.len(), still.tested(), still.drifts()), (24, 24, Some(false)));
        assert_eq!(still.most_significant().unwrap().corrected_probability, Some(1.0));
        let moving = drift([0.0, 8.0, 16.0, 24.0]);
        assert_eq!(moving.drifts(), Some(true));
        let found: Vec<_> = moving.series.iter().filter(|at| at.corrected_probability.unwrap() < DRIFTS).collect();
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].index, found[0].angle), (PositionIndex { i: 2, j: 3 }, 2));
        // Expected: 8 arcsec a year; the years have 365 and 366 days.
        assert!((found[0].line.unwrap().slope - 8.0).abs() < 0.02);
    }

    /// Expected: a change of 44.5 between the second and the third of four certificates, and one that comes and goes, are no
    /// rates. The sizes of the uncertainties, near 1, come from the stand file.
    #[test]
    fn a_jump_is_no_drift() {
        for (changes, between, change) in
            [([0.0, -1.5, 43.0, 43.5], ["C-1", "C-2"], 44.5), ([0.0, 30.0, 0.0, 0.0], ["C-0", "C-1"], 30.0)]
        {
            let drift = drift(changes);
            assert_eq!(drift.jumps().count(), 1);
            let (series, jump) = drift.worst_jump().unwrap();
            assert_eq!((series.index, series.angle), (PositionIndex { i: 2, j: 3 }, 2));
            assert_eq!(jump.certificates, between);
            assert!((jump.change_arcsec - change).abs() < 1e-9 && series.line.is_none());
            assert_eq!((drift.tested(), drift.drifts()), (24, Some(false)));
        }
    }

    /// Expected: positions that only the later certificates contain have one value and no rate; they are not tests for which
    /// the others are corrected.
    #[test]
    fn a_position_added_later_is_not_tested() {
        let mut later = stand("2026-07-16", "C-1", |_| {});
        let added = CertifiedPosition { i: 5, theta_deg: 270.0, ..later.positions[0].clone() };
        later.positions.push(added);
        for more in [false, true] {
            let mut last = later.clone();
            last.certificate.number = "C-2".to_owned();
            let stands = [&stand("2020-06-01", "C-0", |_| {}), &later, &last];
            let found = Drift::of(&stands[..2 + usize::from(more)]);
            assert_eq!((found.series.len(), found.tested()), (27, 24), "{more}");
        }
    }

    #[test]
    fn one_certificate_shows_no_drift() {
        let one = stand("2020-06-01", "C-0", |_| {});
        let drift = Drift::of(&[&one]);
        assert_eq!((drift.tested(), drift.drifts()), (0, None));
        assert!(drift.series.iter().all(|at| at.values.len() == 1 && at.line.is_none()));
        let same_day = Drift::of(&[&one, &stand("2020-06-01", "C-1", |_| {})]);
        assert_eq!(same_day.tested(), 0);
        let unstated = Drift::of(&[&one, &stand("2021-06-01", "C-1", |at| at.u_alpha_arcsec = None)]);
        assert_eq!(unstated.tested(), 16);
        let later = stand("2022-06-01", "C-2", |_| {});
        let first_unstated = Drift::of(&[&stand("2019-06-01", "C", |at| at.u_alpha_arcsec = None), &one, &later]);
        assert_eq!(first_unstated.tested(), 24);
        assert_eq!(Drift::of(&[]).series.len(), 0);
    }
}
