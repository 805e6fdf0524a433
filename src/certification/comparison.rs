//! Comparison of a later check run with the certificate: has the stand changed?
//!
//! The paper requires that positions repeat. The differences between check and certificate are therefore split into a
//! rotation common to all positions (of the platform or the base, because a datum surface, a level or a seat has
//! changed) and the remaining rotation of each position. Positions that do not repeat are found one by one, starting
//! with the worst, and are excluded from the common rotation. One bad position therefore does not make the others look
//! bad.

use super::compared::{CommonTurn, ComparedPosition, NotCompared, Test};
use super::components::Variance;
use super::differences::{Differences, certified_u_arcsec, square};
use super::finding::{Finding, Role, findings};
use super::found::{Found, Scope};
use super::kind::{Kind, OUTLIER};
use super::remark::Remark;
use super::transformation::{self, CLEARLY, Transformation};
use super::{AngleReadings, Between, Certification, Header, NominalPosition};
use crate::calibration::recorded::rounding_of;
use crate::coefficients::PositionIndex;
use crate::stand::Stand;
use crate::statistics::student::{detectable, f_beyond};
use crate::wording::number::{Number, Probability};
use crate::wording::texts::remarks as texts;
use crate::wording::words::code;
use nalgebra::Vector3;
use serde::Serialize;

/// Factor by which a transformation must reduce the sum of the squared differences if then all positions repeat.
const MOSTLY: f64 = 4.0;

/// Probability by chance below which a check agrees better with the certificate than a new measurement can.
const TOO_CLOSE: f64 = 1e-6;

/// Ratio of the scatter of a check to the certified one above which nothing is decided.
const MUCH_MORE: f64 = 2.0;

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

impl Comparison {
    /// Returns what has changed, or is wrong with the whole of the readings, as findings.
    pub(crate) fn causes(&self) -> impl Iterator<Item = Found> {
        self.findings.iter().filter_map(|finding| finding.cause.clone())
    }

    /// Returns `true` if the readings of the check do not show whether the stand has changed: because of outliers among
    /// them, because they scatter much more than the certificate states, or because they are those of the certificate.
    pub(crate) fn is_undecided(&self) -> bool {
        let unusable = [Role::Outlier, Role::OfCertificate, Role::LargeScatter];
        let is_unusable = self.findings.iter().any(|found| unusable.contains(&found.role));
        !self.same_stand && is_unusable && !self.findings.iter().any(Finding::is_change)
    }

    /// Returns `true` if all that was found is that the angles stand in other places or in another unit.
    pub(crate) fn is_misread(&self) -> bool {
        let mut changes = self.findings.iter().filter(|found| found.is_change()).peekable();
        changes.peek().is_some() && changes.all(|found| found.role == Role::Misplaced)
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
    let misplaced = misplaced(certificate, readings, scatter, &differences, &repeating)?;
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
    let untested = between.err().map(|remark| *remark).or_else(|| common.test.is_none().then(no_common_parts));
    let moved = common.test.is_some_and(|test| test.probability < OUTLIER);
    let same_stand = repeating.len() == places.len() && all.probability >= OUTLIER && !moved;
    let every = || {
        let setting = differences.setting(&header.positions).map(|found| Finding::of(Role::Change, found));
        let worn = |correlation| {
            let words = texts::worn(Number::fixed(correlation, 2));
            let worn = Found::new(Kind::StandChanged, Scope::default(), all.probability, words);
            Finding::of(Role::Change, worn.advised(texts::DO_RECERTIFY))
        };
        let worn = || differences.resemblance(certificate, &readings.means_arcsec()).map(worn);
        let another = || Finding::of_stand(Role::Change, all.probability, texts::ANOTHER_STAND);
        setting.or_else(worn).unwrap_or_else(another)
    };
    let mut findings = findings(all, &positions, &common, again, moved, misplaced, every);
    findings.extend(untested.map(|remark| Finding::new(Role::Limit, remark)));
    if let Some((of_check, probability)) = more {
        let [found, certified] = [of_check, scatter].map(|variance| variance.value.sqrt());
        let role = if found > MUCH_MORE * certified { Role::LargeScatter } else { Role::Limit };
        let [found, certified] = [found, certified].map(|value| Number::significant(value, 2));
        let words = texts::scatters_more(found, certified, Probability(probability));
        findings.push(Finding::new(role, Remark::advising(words, texts::DO_TELL_WHICH)));
    }
    let is_stated = certificate.positions.iter().all(|at| certified_u_arcsec(at).is_some());
    if !is_stated {
        let [alpha, beta, gamma] = ["u_alpha_arcsec", "u_beta_arcsec", "u_gamma_arcsec"].map(code);
        let remark = Remark::advising(texts::TREATED_AS_EXACT, texts::do_state_u(alpha, beta, gamma));
        findings.push(Finding::new(Role::Limit, remark));
    }
    let evidence = certificate.certificate.evidence.as_ref();
    if evidence.is_some_and(|evidence| readings.sha256.as_ref() == Some(&evidence.readings_sha256)) {
        findings.push(Finding::new(Role::OfCertificate, texts::SAME_READINGS));
    } else if let Some(certified) = evidence
        && let Some(test) = differences.of_repeatability(scatter, [certified.runs as usize, readings.runs.len()])
        && 1.0 - test.probability < TOO_CLOSE
    {
        let found = Found::new(Kind::Computed, Scope::default(), TOO_CLOSE, texts::TOO_CLOSE);
        findings.push(Finding::of(Role::OfCertificate, found.advised(texts::DO_CHECK_AND_MEASURE)));
    }
    let is_unusable = |found: &Finding| matches!(found.role, Role::OfCertificate | Role::LargeScatter);
    let same_stand = same_stand && !findings.iter().any(is_unusable);
    if let Some(position_arcsec) = detectable_arcsec(&positions).filter(|_| same_stand && is_stated) {
        let position = Number::significant(position_arcsec, 2);
        let words = match common.detectable_arcsec() {
            Some(turn) => texts::detects(position, Number::significant(turn, 2)),
            None => texts::detects_of_position(position),
        };
        findings.push(Finding::new(Role::Limit, words));
    }
    let words = findings.iter().map(ToString::to_string).collect();
    let certificate = certificate.certificate.number.clone();
    Ok(Comparison { certificate, runs, all, positions, common, same_stand, findings, words })
}

/// Returns the remark that the rotation of the whole was not tested, because the certificate lacks the common parts.
fn no_common_parts() -> Remark {
    let advice = texts::do_common_parts(code("common_platform_arcsec"), code("common_base_arcsec"));
    Remark::advising(texts::NOT_TESTED_COMMON_PARTS, advice)
}

/// Returns the rotation about any axis of the case that is found with a probability of 95 % in each of the `positions`, or
/// `None` if the uncertainties have too few degrees of freedom.
pub(crate) fn detectable_arcsec(positions: &[ComparedPosition]) -> Option<f64> {
    let largest_u = positions.iter().flat_map(|at| at.u_arcsec).fold(0.0, f64::max);
    // All have the same degrees of freedom.
    let test = positions.first()?.test;
    Some(largest_u * detectable(OUTLIER / positions.len() as f64, test.degrees_of_freedom, test.of_u)?)
}

/// Returns what is found of readings whose angles stand in other places or in another unit.
fn misplaced(
    certificate: &Stand,
    readings: &AngleReadings,
    scatter: Variance,
    differences: &Differences,
    repeating: &[usize],
) -> Result<Vec<Found>, NotCompared> {
    let certified: Vec<_> = certificate.positions.iter().map(|at| Vector3::from(at.angles_arcsec())).collect();
    let exchanged = exchanged(certificate, &certified, readings, scatter, repeating)?;
    let places: Vec<usize> = (0..certified.len()).collect();
    let agree = |differences: &Differences| differences.rest(&places).is_some_and(|test| test.probability >= OUTLIER);
    let changed = places.len() - repeating.len();
    if !exchanged.is_empty() || changed == 1 || changed == 0 && agree(differences) {
        return Ok(exchanged.into_iter().map(exchange).collect());
    }
    let means = readings.means_arcsec();
    let Some(rest) = differences.without_common() else { return Ok(Vec::new()) };
    let nearest = Transformation::nearest(&means, &certified, [], &rest);
    let explains = |nearest: &Transformation| {
        let corrected = differences.of(&nearest.corrected(&means, &certified), &certified);
        let repeat = || agree(&corrected) && corrected.repeating(&places).len() == places.len();
        nearest.explains(CLEARLY, 0.0) || (nearest.explains(MOSTLY, 0.0) || nearest.is_known_factor()) && repeat()
    };
    Ok(nearest.filter(explains).map(|nearest| nearest.found()).into_iter().collect())
}

/// Returns the finding that two positions are exchanged.
fn exchange([one, other]: [PositionIndex; 2]) -> Found {
    let scope = Scope { between: Some([one, other].map(|at| [at.i, at.j])), ..Scope::default() };
    Found::new(Kind::RowsExchanged, scope, 0.0, texts::exchanged(one, other)).advised(texts::DO_CHECK_ROWS)
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
    let rows = transformation::exchanged(&readings.means_arcsec(), certified).unwrap_or_default();
    let is_changed = |pair: &[usize; 2]| pair[0] < pair[1] && pair.iter().all(|place| !repeating.contains(place));
    let pairs = rows.iter().enumerate().filter_map(|(one, other)| Some([one, (*other)?]));
    let pairs: Vec<[usize; 2]> = pairs.filter(is_changed).collect();
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
    let again = again.filter(|again| !again.findings.iter().any(|found| found.kind == Kind::Bump))?;
    let found = again.components.pooled_arcsec2;
    let expected = scatter.value + square(rounding_of(readings.step_arcsec));
    let probability = f_beyond(found.value / expected, found.degrees_of_freedom, scatter.degrees_of_freedom);
    (probability < OUTLIER).then_some((found, probability))
}
