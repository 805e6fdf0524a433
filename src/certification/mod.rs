//! Certification of a stand from repeated readings of its angles, and the check whether it has changed since.
//!
//! * `header`: the stand file before the measurement.
//! * `readings`: the angles read, with every position in every run.
//! * `components`: variance components (the positions' own scatter, and the part common to a run).
//! * `layer`: readings within the runs, and rotations of the runs, with fits of shifts.
//! * `hypothesis`: the list of what may be wrong, and the search for what explains the measurement.
//! * `kind`: kinds of findings and the probabilities at which they are reported; `found`: findings, their words, their JSON.
//! * `remark`: remarks for the signatory.
//! * `comparison`: the comparison of a later check run with the certificate; `compared`: its parts.
//! * `measured`: evaluation of one file of readings.
//! * `differences`: check minus certificate as rotations, and the tests of them.
//! * `finding`: reasons for the result of that comparison, and its limits.
//! * `transformation`: other units, columns, rows or signs of a file or a run.
//! * `document`: the stand file as text, with comments on the origin of its numbers.
//!
//! The model and the meaning of each number are described in docs/certification.md.

mod compared;
pub(crate) mod comparison;
pub(crate) mod components;
pub(crate) mod differences;
pub(crate) mod document;
pub(crate) mod finding;
pub(crate) mod found;
pub(crate) mod header;
pub(crate) mod hypothesis;
pub(crate) mod kind;
mod layer;
#[cfg(feature = "cli")]
pub(crate) mod measured;
pub(crate) mod readings;
pub(crate) mod remark;
mod transformation;

pub use compared::{CommonTurn, ComparedPosition, NotCompared, Test};
pub use comparison::{Comparison, compare};
use components::{Common, Components, Variance};
use found::{Found, Naming, Scope};
pub use header::{Header, NominalPosition};
use hypothesis::{Accepted, At, Explanation, Measurement, predictions};
use kind::Kind;
use layer::Fit;
pub use readings::{AngleReadings, NotBalanced};
use remark::Remark;

use crate::attitude::ANGLES;
use crate::calibration::inputs::Turn;
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Evidence, Stand};
use components::{case_turn, turns_at};
use nalgebra::{DVector, Vector3};

/// Smallest number of runs for which the program does not warn that there are few.
pub(crate) const ENOUGH_RUNS: usize = 4;

/// Weight of a prediction relative to that of a reading below which the other readings do not determine the missing ones.
///
/// Readings that determine the rotations of their run give predictions of 1/5 at least (three runs, one of which keeps three
/// of eight positions). Where only the deviations of the stand, a few arcminutes, tell platform and base apart, it is 1/1000 or
/// less, and the means are worse than without the whole run.
const LEAST_WEIGHT: f64 = 0.1;

/// Reason why a stand was not certified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotCertified {
    /// Only one run, which does not show repeatability.
    #[error(
        "found one run, expected at least two (better five); move the platform away and back between runs, so that \
         repeatability can be estimated"
    )]
    OneRun,
    /// Number of positions in the readings that differs from the header's.
    #[error("found readings of {readings} positions, expected the {header} positions of the stand file")]
    OtherPositions {
        /// Number of positions read.
        readings: usize,
        /// Number of positions in the header.
        header: usize,
    },
    /// Too few positions to distinguish the common part of a run from the scatter of single positions.
    #[error(
        "too few positions to distinguish the common part of a run from the repeatability of single positions; \
         measure at least three, two of which differ in theta or phi"
    )]
    TooFewPositions,
    /// Angle that is the same in all runs.
    #[error(
        "{0} is the same in every run of every position; measure it in every run, record more digits than it varies \
         by, and do not copy runs"
    )]
    Constant(&'static str),
    /// Excluded readings that the others do not determine, or ten times worse than a reading would.
    #[error("the other readings do not determine the excluded ones; exclude the whole run, or measure it again")]
    Undetermined,
    /// Readings that do not scatter once the common rotation of each run is removed.
    #[error("the readings do not vary; check whether the runs are shifted copies of each other")]
    NoScatter,
    /// Accredited capability and a smaller expanded uncertainty (k = 2) that the certificate would state, arcsec.
    #[error(
        "the smallest U (k = 2) is {:.4} arcsec, below the accredited capability of {} arcsec (cmc_arcsec); state what the \
         capability contains in type_b",
        .0[1], .0[0]
    )]
    BelowCapability([f64; 2]),
}

impl NotCertified {
    /// Returns the finding that is the reason, if the readings themselves are.
    pub(crate) fn finding(&self) -> Option<Found> {
        let (kind, angle) = match self {
            Self::Constant(angle) => (Kind::ChannelConstant, Some(*angle)),
            Self::NoScatter => (Kind::RunsCopied, None),
            _ => return None,
        };
        Some(Found::new(kind, Scope { angle, ..Scope::default() }, 0.0, self.to_string()))
    }
}

/// Certified stand, with the evidence for its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Certification {
    /// Content of the stand file.
    pub stand: Stand,
    /// Numbers of the runs.
    pub runs: Vec<u32>,
    /// Number of rows that repeat the reading of a visit; they were averaged.
    pub repeated_rows: usize,
    pub(crate) components: Components,
    /// What explains the readings better than chance, the most likely first.
    pub(crate) findings: Vec<Found>,
    /// Variances of platform and base between the runs without what is named of them.
    pub(crate) between: Between,
    /// Remarks for the signatory of the certificate.
    pub(crate) remarks: Vec<Remark>,
    /// The remarks in words, a sentence each.
    pub warnings: Vec<String>,
}

/// Variances between whole runs, per axis, and the number of runs that were averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Between {
    pub runs: f64,
    pub platform_arcsec2: f64,
    /// Variance of the base, arcsec²; 0 if its rotations cannot be distinguished from those of the platform.
    pub base_arcsec2: f64,
    /// Degrees of freedom of all three axes.
    pub degrees_of_freedom: f64,
}

/// Certifies the stand of `header` from `readings`, whose positions are in the order of the header.
///
/// # Errors
/// Returns [`NotCertified`] if the readings do not fit the header or do not show the scatter.
pub fn certify(header: &Header, readings: &AngleReadings) -> Result<Certification, NotCertified> {
    let (found, due) = (readings.each_arcsec.len(), header.positions.len());
    if found != due {
        return Err(NotCertified::OtherPositions { readings: found, header: due });
    }
    let runs = &readings.runs;
    if runs.len() < 2 {
        return Err(NotCertified::OneRun);
    }
    if let Some(angle) = constant(readings) {
        return Err(NotCertified::Constant(angle));
    }
    let (readings, predictions) = predicted(header, readings)?;
    let readings = &readings;
    let components = fitted(header, readings)?;
    let measurement = Measurement { header, readings, components: &components };
    let explanation = measurement.explained().ok_or(NotCertified::NoScatter)?;
    let components = explanation.components.clone();
    let findings = Naming { positions: &header.positions, readings, explanation: &explanation }.all();
    let worse = measurement.worse(&explanation);
    let scatter = components.scatter_of_positions(&worse).filter(|_| !worse.is_empty());
    let biases = &explanation.biases_arcsec;
    let mut stand = Stand {
        stand: header.stand.clone(),
        certificate: header.certificate.clone(),
        datum: header.datum.clone(),
        positions: Vec::new(),
    };
    let number = runs.len() as f64;
    let each = header.positions.iter().zip(readings.means_arcsec()).zip(&components.model.turns).enumerate();
    stand.positions = each
        .map(|(place, ((nominal, mean), turn))| {
            let of_position = scatter.as_ref().map(|scatter| scatter[place]);
            let own = [0, 1, 2].map(|axis| {
                let share = share_of_mean(place, axis, readings, predictions.as_ref());
                let own = of_mean(components.own_arcsec2[axis], of_position, share, &header.certificate);
                // The suspect part of the mean was not removed.
                Variance { value: own.value + biases[3 * place + axis] * biases[3 * place + axis], ..own }
            });
            let rounding = [0, 1, 2].map(|angle| readings.rounding_arcsec(place, angle));
            certified(nominal, &mean, turn, &own, rounding)
        })
        .collect();
    let certificate = &mut stand.certificate;
    certificate.repeatability_arcsec = Some(rounded(components.pooled_arcsec2.value.sqrt()));
    certificate.repeatability_degrees_of_freedom = Some(freedom(components.pooled_arcsec2.degrees_of_freedom));
    let common = |seen: Option<&Common>, on: ActsOn| {
        let type_b = header.certificate.type_b_arcsec2(on);
        let seen = seen.map(|common| common.between_runs_arcsec2 / number).or((type_b > 0.0).then_some(0.0));
        seen.map(|seen| rounded((seen + type_b).sqrt()))
    };
    certificate.common_platform_arcsec = common(Some(&components.platform), ActsOn::Platform);
    certificate.common_base_arcsec = common(components.base.as_ref(), ActsOn::Base);
    let of_readings = |sha256: &str| Evidence {
        readings_sha256: sha256.to_owned(),
        runs: runs.len() as u32,
        excluded: Some(readings.excluded.clone()).filter(|excluded| !excluded.is_empty()),
    };
    certificate.evidence = readings.sha256.as_deref().map(of_readings);
    if let Some(below) = stand.certificate.below_capability_arcsec(&stand.positions) {
        return Err(NotCertified::BelowCapability(below));
    }
    let between = between(&components, &explanation);
    let remarks = remark::remarks(&findings, &components, readings, &stand);
    let warnings = remarks.iter().map(ToString::to_string).collect();
    let (runs, repeated_rows) = (runs.to_vec(), readings.repeated_rows);
    Ok(Certification { stand, runs, repeated_rows, components, findings, between, remarks, warnings })
}

/// Returns the variances between the runs. A run that stands out would inflate the variance by which its own effect on the mean
/// is tested; it is left out, and with it whatever else is named.
fn between(components: &Components, explanation: &Explanation) -> Between {
    let runs = components.run_turns.len() as f64;
    let is_of_runs = |at: &Accepted| matches!(at.cause.at, At::Part(_));
    let accused = explanation.accepted.iter().any(|at| is_of_runs(at) && at.probability < kind::OUTLIER);
    if !accused {
        return Between {
            runs,
            platform_arcsec2: components.platform.between_runs_arcsec2,
            base_arcsec2: components.base.map_or(0.0, |base| base.between_runs_arcsec2),
            degrees_of_freedom: 3.0 * (runs - 1.0),
        };
    }
    let mean = |axes: &[[f64; 2]]| {
        let [squares, freedom] = axes.iter().fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
        if freedom > 0.0 { squares / freedom } else { 0.0 }
    };
    let (platform, base) = explanation.of_runs.split_at(3);
    let fewest = explanation.of_runs.iter().map(|of| of[1]).fold(f64::INFINITY, f64::min);
    let degrees_of_freedom = 3.0 * fewest;
    Between { runs, platform_arcsec2: mean(platform), base_arcsec2: mean(base), degrees_of_freedom }
}

/// Replaces the angles of excluded readings by their predictions from all other readings (Yates' missing-plot
/// technique), and returns them with the fit without the predictions; `None` if no reading was excluded.
///
/// The means of the completed readings are the least-squares estimates from the readings that are there.
///
/// # Errors
/// Returns [`NotCertified`] if the others do not determine the excluded ones well enough.
pub(crate) fn predicted(
    header: &Header,
    readings: &AngleReadings,
) -> Result<(AngleReadings, Option<Fit>), NotCertified> {
    if readings.missing.is_empty() {
        return Ok((readings.clone(), None));
    }
    let fit = |readings: &AngleReadings| {
        let components = fitted(header, readings)?;
        let fit = predictions(&components, &readings.missing, &readings.runs);
        // The variance of a shift is that of a reading plus that of its prediction.
        let is_determined = |fit: &Fit| fit.spread.diagonal().iter().all(|shift| (shift - 1.0) * LEAST_WEIGHT <= 1.0);
        Ok((components.model.turns, fit.filter(is_determined).ok_or(NotCertified::Undetermined)?))
    };
    let mut completed = readings.clone();
    // The axes of a position depend on its mean, so the second pass removes what is left of the second order.
    for _ in 0..2 {
        let (turns, fit) = fit(&completed)?;
        for (number, (place, run)) in readings.missing.iter().enumerate() {
            let shift = turns[*place].angles_of_rotation() * fit.sizes.fixed_rows::<3>(3 * number);
            completed.each_arcsec[*place][*run] -= shift;
        }
    }
    let (_, fit) = fit(&completed)?;
    Ok((completed, Some(fit)))
}

/// Returns the variance of the mean of a position about an axis relative to that of one visit: 1/R for R runs, and more if
/// some of its readings are predictions.
///
/// The mean of the completed readings is that of all readings less the sum of the shifts over R, and the residuals, on
/// which the shifts depend, are uncorrelated with the mean.
fn share_of_mean(place: usize, axis: usize, readings: &AngleReadings, predictions: Option<&Fit>) -> f64 {
    let runs = readings.runs.len() as f64;
    let Some(Fit { spread, .. }) = predictions else { return 1.0 / runs };
    let missing = readings.missing.iter().enumerate().filter(|(_, (of, _))| *of == place);
    let own: Vec<usize> = missing.map(|(number, _)| 3 * number + axis).collect();
    let pairs = own.iter().flat_map(|one| own.iter().map(move |other| (*one, *other)));
    let shifts = pairs.map(|at| spread[at]).sum::<f64>();
    1.0 / runs + shifts / (runs * runs)
}

/// Returns the name of an angle that is the same in all runs of every position, or `None` if all angles vary.
fn constant(readings: &AngleReadings) -> Option<&'static str> {
    let same = |axis: usize| readings.each_arcsec.iter().all(|runs| runs.iter().all(|run| run[axis] == runs[0][axis]));
    (0..3).find(|axis| same(*axis)).map(|axis| ANGLES[axis])
}

/// Estimates the variance components of readings, at their means.
fn fitted(header: &Header, readings: &AngleReadings) -> Result<Components, NotCertified> {
    let positions: Vec<_> = header.positions.iter().map(|at| at.with_angles([0.0; 3]).to_model()).collect();
    let turns = turns_at(&positions, &readings.means_arcsec());
    let differences = differences(&turns, readings);
    components::estimate(turns, &readings.runs, &differences)
}

/// Returns the rotations of all positions from their means, one vector per run, `[3 position + axis]`, arcsec along the
/// axes of the case.
fn differences(turns: &[Turn], readings: &AngleReadings) -> Vec<DVector<f64>> {
    let means = readings.means_arcsec();
    let of_run = |run: usize| {
        let mut differences = DVector::zeros(3 * turns.len());
        for (place, turn) in turns.iter().enumerate() {
            let change = readings.each_arcsec[place][run] - means[place];
            differences.fixed_rows_mut::<3>(3 * place).copy_from(&case_turn(turn, &change));
        }
        differences
    };
    (0..readings.runs.len()).map(of_run).collect()
}

impl Certification {
    /// Adds a remark, and its words.
    pub(crate) fn add(&mut self, remark: Remark) {
        self.warnings.push(remark.to_string());
        self.remarks.push(remark);
    }

    /// Returns the degrees of freedom of the common parts of platform and base in the certificate, from the runs and the type B
    /// variances that act on them; `None` for a part that is absent or known exactly.
    pub(crate) fn freedom_of_common_parts(&self) -> [Option<f64>; 2] {
        let (components, number) = (&self.components, self.runs.len() as f64);
        let of = |seen: Option<&Common>, on: ActsOn| {
            let seen = seen.map(|common| Variance {
                value: common.between_runs_arcsec2 / number,
                degrees_of_freedom: common.degrees_of_freedom,
            });
            let freedom = Variance::sum(seen.into_iter().chain(type_b(&self.stand.certificate, on))).degrees_of_freedom;
            freedom.is_finite().then_some(freedom)
        };
        [of(Some(&components.platform), ActsOn::Platform), of(components.base.as_ref(), ActsOn::Base)]
    }
}

/// Returns the type B variances that a certificate states for `on`, arcsec².
fn type_b(certificate: &Certificate, on: ActsOn) -> impl Iterator<Item = Variance> {
    certificate.type_b_on(on).map(|line| Variance {
        value: line.u_arcsec * line.u_arcsec,
        degrees_of_freedom: line.degrees_of_freedom.unwrap_or(f64::INFINITY),
    })
}

/// Returns the variance of a certified mean about one axis of the case, arcsec²: the variance `axis` of one visit,
/// scaled by the `scatter` of the position relative to that of all and by its `share` in the mean, plus the type B
/// variances that `certificate` states for a position.
fn of_mean(axis: Variance, scatter: Option<Variance>, share: f64, certificate: &Certificate) -> Variance {
    let of_position = scatter.unwrap_or(Variance { value: 1.0, ..axis });
    let repeated = Variance { value: axis.value * of_position.value * share, ..of_position };
    Variance::sum(std::iter::once(repeated).chain(type_b(certificate, ActsOn::Position)))
}

/// Returns the certified position with the means `mean` (α, β, γ, arcsec) and their uncertainties, where `own` is the
/// variance of its rotation about each axis of the case, arcsec², and `rounding_arcsec` the standard uncertainty of the
/// rounding of each angle.
fn certified(
    nominal: &NominalPosition,
    mean: &Vector3<f64>,
    turn: &Turn,
    own: &[Variance; 3],
    rounding_arcsec: [f64; 3],
) -> CertifiedPosition {
    let to_angles = turn.angles_of_rotation();
    let u = |angle: usize| {
        let variance =
            (0..3).map(|axis| to_angles[(angle, axis)] * to_angles[(angle, axis)] * own[axis].value).sum::<f64>();
        libm::hypot(variance.sqrt(), rounding_arcsec[angle])
    };
    let least = own.iter().map(|variance| variance.degrees_of_freedom).fold(f64::INFINITY, f64::min);
    let mut position = nominal.with_angles([0, 1, 2].map(|angle| to_digits_of(mean[angle], u(angle))));
    position.u_alpha_arcsec = Some(rounded(u(0)));
    position.u_beta_arcsec = Some(rounded(u(1)));
    position.u_gamma_arcsec = Some(rounded(u(2)));
    position.degrees_of_freedom = Some(freedom(least));
    position
}

/// Returns the number of decimals with which `u` shows four significant digits.
///
/// This keeps rounding negligible in later computations from the file (GUM, 7.2.6).
fn decimals(u: f64) -> i32 {
    let exponent = if u > 0.0 { libm::floor(libm::log10(u)) as i32 } else { 0 };
    (3 - exponent).clamp(0, 9)
}

fn to_digits_of(value: f64, u: f64) -> f64 {
    let scale = 10_f64.powi(decimals(u));
    // Adding zero turns -0.0 into 0.0.
    (value * scale).round() / scale + 0.0
}

fn rounded(u: f64) -> f64 {
    to_digits_of(u, u)
}

/// Returns degrees of freedom rounded to a tenth, at least 0.1; finer digits have no practical effect.
fn freedom(value: f64) -> f64 {
    (value * 10.0).round().max(1.0) / 10.0
}
