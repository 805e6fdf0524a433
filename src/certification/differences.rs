//! Differences between a check and the certificate as rotations of the case, and the tests of them.

use super::compared::{CommonTurn, NotCompared, Test};
use super::components::{RunModel, Variance, case_turn, turns_at};
use super::found::{Found, Scope, arcsec};
use super::kind::{Kind, OUTLIER, Setting};
use super::remark::Remark;
use super::{AngleReadings, Between, Certification, NominalPosition};
use crate::calibration::inputs::Turn;
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Stand};
use crate::statistics::least_squares::Factorised;
use crate::statistics::student::{f_beyond, f_larger};
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use crate::wording::words::symbol;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Differences between check and certificate as rotations of the case, with their standard uncertainties and the model of
/// the common rotation.
#[derive(Clone)]
pub(super) struct Differences {
    turns_arcsec: DVector<f64>,
    u_arcsec: DVector<f64>,
    degrees_of_freedom: f64,
    model: RunModel,
}

/// Returns the certified standard uncertainties of α, β, γ of a position, or `None` if one is not stated.
pub(super) fn certified_u_arcsec(position: &CertifiedPosition) -> Option<Vector3<f64>> {
    Some(Vector3::new(position.u_alpha_arcsec?, position.u_beta_arcsec?, position.u_gamma_arcsec?))
}

/// Returns the certified angles (α, β, γ) of every position, arcsec.
fn angles_of(stand: &Stand) -> Vec<Vector3<f64>> {
    stand.positions.iter().map(|at| Vector3::from(at.angles_arcsec())).collect()
}

/// Returns the rotation common to most positions between two certificates, with its test, and the `later` angles without it;
/// `None` if the certificates have other positions or lack uncertainties, or if no more than half of the positions agree.
pub(crate) fn turned(earlier: &Stand, later: &Stand) -> Option<(CommonTurn, Vec<Vector3<f64>>)> {
    let nominal = |stand: &Stand| stand.positions.iter().map(NominalPosition::from).collect::<Vec<_>>();
    let is_stated = |at: &CertifiedPosition| certified_u_arcsec(at).is_some();
    if nominal(earlier) != nominal(later) || !earlier.positions.iter().chain(&later.positions).all(is_stated) {
        return None;
    }
    let of_later = |place: usize, turn: &Turn| {
        let at = &later.positions[place];
        let own = own_variance(turn, &certified_u_arcsec(at).unwrap_or_default());
        (own, at.degrees_of_freedom.unwrap_or(f64::INFINITY), Vector3::zeros())
    };
    let differences = Differences::with(earlier, &angles_of(later), of_later)?;
    let repeating = differences.repeating(&(0..later.positions.len()).collect::<Vec<_>>());
    let [before, after] = [earlier, later].map(|stand| &stand.certificate);
    let between = Between {
        runs: 1.0,
        platform_arcsec2: square(after.common_platform_arcsec?),
        base_arcsec2: square(after.common_base_arcsec.unwrap_or(0.0)),
        degrees_of_freedom: before.freedom_of_runs().min(after.freedom_of_runs()),
    };
    let common = differences.common(&repeating, earlier, Some(&between)).filter(|_| !repeating.is_empty())?;
    let (shared, ..) = differences.shared(&repeating)?;
    let turns = &differences.model.design * shared;
    let without = differences
        .model
        .turns
        .iter()
        .zip(angles_of(later))
        .enumerate()
        .map(|(place, (turn, angles))| angles - turn.angles_of_rotation() * turns.fixed_rows::<3>(3 * place));
    Some((common, without.collect()))
}

impl Differences {
    pub(super) fn new(certificate: &Stand, readings: &AngleReadings, scatter: Variance) -> Result<Self, NotCompared> {
        let of_check = Vector3::repeat(scatter.value / readings.runs.len() as f64);
        let found = Self::with(certificate, &readings.means_arcsec(), |place, turn| {
            let rounding = [0, 1, 2].map(|angle| readings.rounding_of_mean_arcsec(place, angle));
            (of_check, scatter.degrees_of_freedom, own_variance(turn, &rounding.into()))
        });
        found.ok_or(NotCompared::TooFewPositions)
    }

    /// Returns the differences of the `read` angles; `own` gives the variances of their rotation in a position, with their
    /// degrees of freedom, and those that are known exactly.
    fn with(
        certificate: &Stand,
        read: &[Vector3<f64>],
        own: impl Fn(usize, &Turn) -> (Vector3<f64>, f64, Vector3<f64>),
    ) -> Option<Self> {
        let positions: Vec<_> = certificate.positions.iter().map(CertifiedPosition::to_model).collect();
        let certified = angles_of(certificate);
        let model = RunModel::new(turns_at(&positions, &certified))?;
        let mut u = DVector::zeros(3 * positions.len());
        let mut freedom = f64::INFINITY;
        for (place, turn) in model.turns.iter().enumerate() {
            let position = &certificate.positions[place];
            let before = own_variance(turn, &certified_u_arcsec(position).unwrap_or_default());
            let (after, of_after, exact) = own(place, turn);
            let both = before + after + exact;
            u.fixed_rows_mut::<3>(3 * place).copy_from(&both.map(f64::sqrt));
            // Welch and Satterthwaite, GUM (JCGM 100), eq. (G.2b), for the axis with the fewest degrees of freedom.
            let of_before = position.degrees_of_freedom.unwrap_or(f64::INFINITY);
            for axis in 0..3 {
                let parts = square(before[axis]) / of_before + square(after[axis]) / of_after;
                freedom = freedom.min(square(both[axis]) / parts);
            }
        }
        let none = Self { turns_arcsec: DVector::zeros(0), u_arcsec: u, degrees_of_freedom: freedom, model };
        Some(none.of(read, &certified))
    }

    /// Returns the differences of the angles `read` (α, β, γ of every position, arcsec) from the `certified` ones, with the
    /// same uncertainties.
    pub(super) fn of(&self, read: &[Vector3<f64>], certified: &[Vector3<f64>]) -> Self {
        let changes: Vec<_> = read.iter().zip(certified).map(|(read, certified)| read - certified).collect();
        Self { turns_arcsec: self.turned(&changes), ..self.clone() }
    }

    /// Returns the rotations of the case that angles are.
    fn turned(&self, angles: &[Vector3<f64>]) -> DVector<f64> {
        let turns =
            self.model.turns.iter().zip(angles).flat_map(|(turn, angles)| <[f64; 3]>::from(case_turn(turn, angles)));
        DVector::from_iterator(3 * angles.len(), turns)
    }

    /// Returns what is left of angles, in units of their standard uncertainties, without the rotations common to all
    /// positions; `None` if they do not determine these.
    pub(super) fn without_common(&self) -> Option<impl Fn(&[Vector3<f64>]) -> DVector<f64>> {
        let by_u = |mut rows: DMatrix<f64>| {
            rows.row_iter_mut().zip(&self.u_arcsec).for_each(|(mut row, u)| row /= *u);
            rows
        };
        let model = Factorised::new(by_u(self.model.design.clone()))?;
        Some(move |angles: &[Vector3<f64>]| {
            let mut rest = by_u(DMatrix::from_columns(&[self.turned(angles)]));
            model.rotate(&mut rest);
            rest.column(0).rows(model.columns, rest.nrows() - model.columns).into_owned()
        })
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
    pub(super) fn of_repeatability(&self, scatter: Variance, runs: [usize; 2]) -> Option<Test> {
        let variance: f64 = runs.into_iter().map(|runs| scatter.value / runs as f64).sum();
        let places: Vec<usize> = (0..self.u_arcsec.len() / 3).collect();
        let u_arcsec = DVector::repeat(self.u_arcsec.len(), variance.sqrt());
        Self { u_arcsec, degrees_of_freedom: scatter.degrees_of_freedom, ..self.clone() }.rest(&places)
    }

    /// Returns the chi-square test of positions relative to each other, or `None` if they leave no degrees of freedom.
    pub(super) fn rest(&self, places: &[usize]) -> Option<Test> {
        let degrees_of_freedom = (3 * places.len()).checked_sub(self.model.design.ncols()).filter(|rest| *rest > 0)?;
        let (_, _, chi_square) = self.shared(places)?;
        Some(self.test(chi_square, degrees_of_freedom))
    }

    /// Returns the change of one setting that explains all differences: the positions with one value of θ or φ have rotated
    /// about the axis of that angle.
    pub(super) fn setting(&self, positions: &[NominalPosition]) -> Option<Found> {
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
            explains.then_some((rest, (setting, angle_deg, found[columns])))
        };
        let each = Setting::ALL.into_iter().flat_map(|setting| {
            // Of two values either may have changed: the smaller is the reference.
            setting.values(positions).into_iter().skip(1).map(move |angle_deg| (setting, angle_deg))
        });
        let found = each.filter_map(|(setting, angle_deg)| of_value(setting, angle_deg));
        found.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, (setting, angle_deg, turn))| {
            let words = texts::setting_changed(symbol(setting.symbol()), Number::exact(angle_deg), arcsec(turn));
            let probability = self.rest(&places).map_or(1.0, |test| test.probability);
            let found = Found::new(Kind::StandChanged, Scope::of_setting(setting, angle_deg), probability, words);
            found.sized(turn).advised(texts::DO_CHECK_SETTING)
        })
    }

    /// Returns the correlation of the readings with the certified deviations, without the rotations common to all
    /// positions, or `None` if it may be chance (Student's t, one-sided).
    pub(super) fn resemblance(&self, certificate: &Stand, read: &[Vector3<f64>]) -> Option<f64> {
        let rest = self.without_common()?;
        let certified = rest(&angles_of(certificate));
        let read = rest(read);
        let correlation = read.dot(&certified) / (read.norm() * certified.norm());
        let freedom = read.len().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
        let t_square = correlation * correlation * freedom / (1.0 - correlation * correlation);
        (correlation > 0.0 && f_larger(t_square, 1, freedom) / 2.0 < OUTLIER).then_some(correlation)
    }

    fn test(&self, chi_square: f64, degrees_of_freedom: usize) -> Test {
        Test::new(chi_square, degrees_of_freedom, self.degrees_of_freedom)
    }

    /// Returns the rotation of a position relative to that of the `others` (without itself), its standard
    /// uncertainties, and the test of all three components at once.
    pub(super) fn of_position(&self, place: usize, others: &[usize]) -> Option<([f64; 3], [f64; 3], Test)> {
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
    pub(super) fn repeating(&self, places: &[usize]) -> Vec<usize> {
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
    pub(super) fn common(
        &self,
        repeating: &[usize],
        certificate: &Stand,
        between: Option<&Between>,
    ) -> Option<CommonTurn> {
        let every: Vec<usize> = (0..certificate.positions.len()).collect();
        let (shared, r_inverse, _) = self.shared(if repeating.is_empty() { &every } else { repeating })?;
        let [platform_arcsec, base_arcsec] = self.model.rotations(&shared);
        let certificate = &certificate.certificate;
        let tested = between.and_then(|between| self.common_test(&shared, &r_inverse, certificate, between));
        let (test, u_platform_arcsec) = tested.map_or((None, 0.0), |(test, u)| (Some(test), u));
        Some(CommonTurn { platform_arcsec, base_arcsec, test, u_platform_arcsec })
    }

    /// Tests the common rotation against the variation between whole runs, and returns the largest standard uncertainty of the
    /// platform's rotation too, arcsec; `None` if the certificate does not state its common parts.
    fn common_test(
        &self,
        shared: &DVector<f64>,
        r_inverse: &DMatrix<f64>,
        certificate: &Certificate,
        between: &Between,
    ) -> Option<(Test, f64)> {
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
        let u_platform_arcsec = covariance.diagonal().rows(0, 3).max().sqrt();
        let chi_square = shared.dot(&covariance.cholesky()?.solve(shared));
        let freedom = between.degrees_of_freedom.min(self.degrees_of_freedom);
        Some((Test::new(chi_square, shared.len(), freedom), u_platform_arcsec))
    }
}

pub(super) fn square(value: f64) -> f64 {
    value * value
}

/// Probability below which the variances of check and certificate are not pooled: that of platform and base together.
const PARTED: f64 = 0.05;

impl Between {
    /// Returns the variation of the check itself, as `again` has it, if it has several runs, pooled with that of the certificate's readings where
    /// they do not differ (F test); of a check of one run the latter alone.
    ///
    /// # Errors
    /// Returns a remark that the rotation of the whole was not tested, with the reason, if neither shows it.
    pub(super) fn new(
        certificate: &Certificate,
        runs: usize,
        again: Option<&Certification>,
    ) -> Result<Self, Box<Remark>> {
        let evidence = certificate.evidence.as_ref().map(|evidence| f64::from(evidence.runs));
        let of_certificate = certificate.freedom_of_runs();
        let stated =
            [(certificate.common_platform_arcsec, ActsOn::Platform), (certificate.common_base_arcsec, ActsOn::Base)];
        let stated = |evidence: f64| {
            stated.map(|(common, on)| {
                let of_mean = square(common.unwrap_or(0.0)) - certificate.type_b_arcsec2(on);
                of_mean.max(0.0) * evidence
            })
        };
        let unknown = || Box::new(Remark::advising(texts::NOT_TESTED_RUNS, texts::DO_TWO_RUNS));
        if runs == 1 {
            let [platform_arcsec2, base_arcsec2] = stated(evidence.ok_or_else(unknown)?);
            return Ok(Self { runs: 1.0, platform_arcsec2, base_arcsec2, degrees_of_freedom: of_certificate });
        }
        let mut found = again.ok_or_else(|| Box::new(texts::NOT_TESTED_VARIATION.into()))?.between;
        let own = found.degrees_of_freedom;
        found.degrees_of_freedom = own.min(of_certificate);
        let Some(stated) = evidence.filter(|runs| *runs > 1.0).map(stated) else { return Ok(found) };
        let both = [found.platform_arcsec2, found.base_arcsec2].into_iter().zip(stated);
        // An estimate of 0 is no smaller than another.
        let compared = both.clone().filter(|(check, certified)| *check > 0.0 && *certified > 0.0);
        let of_either_side = PARTED / (2 * compared.clone().count()) as f64;
        let mut is_alike = compared.map(|(check, certified)| {
            let ratio = check / certified;
            f_beyond(ratio, own, of_certificate).min(f_beyond(1.0 / ratio, of_certificate, own)) > of_either_side
        });
        if is_alike.all(|is_alike| is_alike) {
            let pooled: Vec<f64> = both
                .map(|(check, certified)| (check * own + certified * of_certificate) / (own + of_certificate))
                .collect();
            (found.platform_arcsec2, found.base_arcsec2) = (pooled[0], pooled[1]);
            found.degrees_of_freedom = own + of_certificate;
        }
        Ok(found)
    }
}

/// Returns the variances of the rotation about x, y, z of the case that result from the uncertainties of α, β, γ.
fn own_variance(turn: &Turn, u_arcsec: &Vector3<f64>) -> Vector3<f64> {
    (0..3).fold(Vector3::zeros(), |sum, angle| {
        let part = turn.axes[angle] * u_arcsec[angle];
        sum + part.component_mul(&part)
    })
}
