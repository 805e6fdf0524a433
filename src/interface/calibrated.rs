//! Calibration with a passport: from currents as CSV to the JSON of `calibrate`.

use super::{Failed, Order, json};
use crate::calibration::document::{NoChange, Subject, another_type};
use crate::calibration::finding::by_type;
use crate::calibration::prediction::{FurtherVisit, best_further_visit, cost_of_missing, u_of_single_visits};
use crate::calibration::stated::{TemperatureOutside, temperature_c};
use crate::calibration::verdict::without_nominal;
use crate::calibration::{
    self, Calibration, CalibrationDocument, Decision, Kind, Method, Model, NoLeastSquares, NotStated, Options,
    Parameter, Readings, Setup, Verdict,
};
use crate::document::sha256_hex;
use crate::gyro::GyroType;
use crate::laboratory::Laboratory;
use crate::passport::{Content, RegisterUsed};
use crate::text::printable;
use crate::uncertainty::Budget;
#[cfg(feature = "monte-carlo")]
use crate::uncertainty::{self, Engine, MonteCarlo, Trials};
use crate::wording::{Language, Words, plain};
use jiff::Timestamp;
use serde::Serialize;
use std::collections::BTreeMap;

/// Calibrates a gyro with the content of a passport, and returns the JSON of `calibrate` with one element in `results`.
/// `verified` is the time for which the passport was verified and the register that was asked, or `None` if the passport was
/// not verified.
///
/// `currents` are the name and content of a CSV file with the columns `i`, `j`, `jx_ma`, `jy_ma`, and if present `cycle`,
/// `visit`, `time_s`.
///
/// # Errors
/// Returns [`Failed`] if the currents cannot be read, if a visit to leave out is not among them, if they do not determine the
/// parameters, or if the result is not valid; it is then [`Failed::result`].
pub fn calibrate_json(
    content: &Content,
    verified: Option<(Timestamp, Option<&RegisterUsed>)>,
    currents: (&str, &[u8]),
    order: &Order,
) -> Result<String, Failed> {
    let (time, register) = verified.unzip();
    let subject = Subject { passport_verified_as_of: time, ..order.subject.clone() };
    let mut done = prepared(content, currents, order)?.run(&order.options, subject, &order.previous)?;
    done.document.register = register.flatten().cloned();
    let budget = budget(&done, order);
    checked(&done.document, json(&WholeDocument { calibration: &done.document, budget, monte_carlo: None::<&()> }))
}

/// Returns the budget of the uncertainty as JSON if `order` asks for it.
fn budget(done: &Done, order: &Order) -> Option<serde_json::Value> {
    done.calibration.adopted().filter(|_| order.budget)?;
    let budget = Budget::of(&done.calibration, &done.setup, &done.readings, &order.options).ok()?;
    Some(budget.to_json(order.gyro.as_ref().map(|gyro| &gyro.tolerance)))
}

/// Calibration result with the requested budget and Monte Carlo.
#[derive(Serialize)]
pub(crate) struct WholeDocument<'a, M> {
    #[serde(flatten)]
    pub calibration: &'a CalibrationDocument,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub budget: Option<serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<&'a M>,
}

/// Returns the JSON of a result if the result is valid; earlier results are read from files.
///
/// # Errors
/// Returns [`Failed`], with the result, if it is not valid.
fn checked(document: &CalibrationDocument, json: String) -> Result<String, Failed> {
    match document.valid() {
        Ok(_) => Ok(json),
        Err(why) => Err(Failed { result: Some(json), ..Failed::refused(why) }),
    }
}

/// Checks the JSON of an earlier [`calibrate_json`].
///
/// # Errors
/// Returns [`Failed`] if it is not such JSON, or as [`calibrate_json`] does if the result is not valid.
pub fn earlier(result: &str) -> Result<(), Failed> {
    checked(&CalibrationDocument::from_json("result", result.as_bytes())?, result.to_owned()).map(drop)
}

/// Meter of [`Laboratory::paper`] in words.
const ASSUMED_METER: &str = "the paper's meter, 0.015 % of the reading: no laboratory was stated";

/// Largest number of results without suspects: of several that are wrong, each is found only without the others.
const MOST_WITHOUT: usize = 16;

/// Returns the results without each visit or row that is probably wrong, and without each that is suspect then: no decision
/// may rest on one of them. A result is `None` if it cannot be found.
fn without_suspects(
    calibration: &Calibration,
    readings: &Readings,
    calibrate: impl Fn(&Readings) -> Option<(CalibrationDocument, Calibration)>,
) -> Vec<Option<CalibrationDocument>> {
    let left_out = |of: &Calibration, from: &Readings| -> Vec<Readings> {
        of.suspects().filter_map(|suspect| suspect.left_out(from)).collect()
    };
    let mut found = Vec::new();
    let mut rests = left_out(calibration, readings);
    while let Some(rest) = rests.pop() {
        let result = if found.len() < MOST_WITHOUT { calibrate(&rest) } else { None };
        rests.extend(result.iter().flat_map(|(_, calibration)| left_out(calibration, &rest)));
        found.push(result.map(|(document, _)| document));
    }
    found
}

/// Reads the currents, and leaves out the visits that `order` names.
fn prepared<'a>(content: &'a Content, currents: (&str, &[u8]), order: &'a Order) -> Result<Prepared<'a>, Failed> {
    let mut prepared = Prepared::new(content, order.laboratory.as_ref(), order.gyro.as_ref(), currents)?;
    for exclusion in &order.exclude {
        prepared.readings.exclude(exclusion.clone()).map_err(Failed::unusable)?;
    }
    Ok(prepared)
}

/// Returns the parameters of the adopted result and their standard uncertainties, in the order and units of
/// [`Parameter::EIGHT`], and whether they may be used: the readings fit the stand, and no mistake explains the parameters
/// better. ω_g and ω_k are NaN in the general model. `result` is the JSON of [`calibrate_json`].
///
/// # Errors
/// Returns [`Failed`] if `result` is not such JSON.
pub fn parameters(result: &str) -> Result<([f64; 8], [f64; 8], bool), Failed> {
    let document = CalibrationDocument::from_json("result", result.as_bytes())?;
    let found = document.found().ok_or_else(|| Failed::unusable("result: found no parameters"))?;
    Ok((found.parameters.to_vector(), found.standard_uncertainty, document.is_valid()))
}

/// Returns the covariance of the adopted parameters, 8×8, in the order and units of [`Parameter::EIGHT`], and whether the result
/// may be used, as [`parameters`] does.
///
/// # Errors
/// Returns [`Failed`] if `result` is not the JSON of [`calibrate_json`], or that of an earlier version without a covariance.
pub fn covariance(result: &str) -> Result<([[f64; 8]; 8], bool), Failed> {
    let document = CalibrationDocument::from_json("result", result.as_bytes())?;
    let rows: Vec<_> = document.covariance.iter().map(|row| row.map(|value| value.unwrap_or(f64::NAN))).collect();
    let rows = rows.try_into().map_err(|_| Failed::unusable("result: has no covariance"))?;
    Ok((rows, document.is_valid()))
}

/// Returns the distributions of the parameters by Monte Carlo (JCGM 101), as the key `monte_carlo` of `calibrate`.
///
/// The inputs are those of [`calibrate_json`]. A seed gives the same numbers on any number of threads.
///
/// # Errors
/// Returns the errors of [`calibrate_json`], and [`Failed`] if the trials do not have the model of `order`, or if the run was
/// cancelled before its first trials were complete.
#[cfg(feature = "monte-carlo")]
pub fn monte_carlo(content: &Content, currents: (&str, &[u8]), order: &Order, run: &Trials) -> Result<String, Failed> {
    let options = &order.options;
    let prepared = prepared(content, currents, order)?;
    let Done { setup, readings, calibration, .. } = prepared.run(options, Subject::default(), &[])?;
    let budget = Budget::of(&calibration, &setup, &readings, options).map_err(Failed::refused)?;
    Ok(json(&distributions(&setup, &readings, (&budget, options), run)?))
}

/// Runs the trials of a calibration.
///
/// # Errors
/// Returns [`Failed`] if the method does not suit the readings or the model of `options`, or if the run was cancelled
/// before its first trials were complete.
#[cfg(feature = "monte-carlo")]
pub(crate) fn distributions(
    setup: &Setup,
    readings: &Readings,
    (budget, options): (&Budget, &Options),
    run: &Trials,
) -> Result<MonteCarlo, Failed> {
    if let Some(why) = uncertainty::monte_carlo::refused_model(options) {
        return Err(Failed::refused(why));
    }
    let engine = Engine::new(setup, readings, budget.method).map_err(Failed::refused)?;
    let found = uncertainty::monte_carlo(&engine, budget, run);
    if found.trials == 0 {
        return Err(Failed::refused("interrupted before the first trial was completed"));
    }
    Ok(found)
}

/// Inputs of a calibration with a passport, read and checked.
pub(crate) struct Prepared<'a> {
    content: &'a Content,
    laboratory: Option<&'a Laboratory>,
    gyro_type: Option<&'a GyroType>,
    setup: Setup,
    missing: Vec<NotStated>,
    /// Name of the file of currents.
    name: String,
    currents_sha256: String,
    /// Readings, from which visits may still be excluded.
    pub readings: Readings,
}

/// Calibration with a passport: the inputs as they were used, and what was found.
pub(crate) struct Done {
    pub setup: Setup,
    pub readings: Readings,
    pub calibration: Calibration,
    /// Inputs without a stated uncertainty.
    pub missing: Vec<NotStated>,
    /// Result as `calibrate` writes it, with the verdict and the change.
    pub document: CalibrationDocument,
    /// Earlier result with which this one was compared, and the reason why the difference is not a change.
    pub earlier: Option<(CalibrationDocument, Option<NoChange>)>,
    /// Warning that the earlier result may be that of another gyro, because a serial number is missing.
    pub unknown_gyro: Option<String>,
    /// Parameter that suffers most from positions without a reading, and the ratio of its uncertainty.
    pub cost_of_missing: Option<(Parameter, f64)>,
    /// Parameter whose uncertainty takes most of its tolerance, and the single visit that would reduce it most.
    pub further: Option<(Parameter, FurtherVisit)>,
    /// Warning on the conditions in the laboratory.
    pub warning: Option<TemperatureOutside>,
    /// Range of temperatures for which the deviations are certified, °C, if the temperature of the readings is not stated.
    pub unchecked_range_c: Option<[f64; 2]>,
    /// `true` if local g is normal gravity at 0 m, because the height of the site is unknown.
    pub without_height: bool,
}

impl Done {
    /// Returns `true` if the result is not valid, or if a parameter or its change fails by the decision rule.
    #[cfg(feature = "cli")]
    pub(crate) fn is_refused(&self) -> bool {
        let failed = |verdict: &Verdict| verdict.overall == Decision::Fail;
        !self.document.is_valid() || self.document.verdict.iter().chain(&self.document.change).any(failed)
    }
}

impl<'a> Prepared<'a> {
    /// Reads the currents, a CSV file given by its name and content, for the positions of a passport. Without a laboratory the
    /// paper's meter is assumed.
    pub(crate) fn new(
        content: &'a Content,
        laboratory: Option<&'a Laboratory>,
        gyro_type: Option<&'a GyroType>,
        (name, currents): (&str, &[u8]),
    ) -> Result<Self, Failed> {
        let paper = Laboratory::paper();
        let of_meter = laboratory.unwrap_or(&paper);
        let stated = Setup::stated(&content.certificate, &content.positions, &content.site, of_meter);
        let (setup, missing) = stated.map_err(Failed::refused)?;
        let setup = setup.of_gyro(gyro_type.and_then(|gyro_type| gyro_type.noise.as_ref()));
        if let Some(parameter) = gyro_type.and_then(without_nominal) {
            return Err(Failed::refused(format!(
                "the gyro type has no tolerance of {}: it is in percent of the nominal value, which is 0; state \
                 k_cross_deg_per_h_per_ma instead of k_cross_percent, or calibrate without a gyro type",
                parameter.symbol()
            )));
        }
        let angles: Vec<_> = content.positions.iter().map(|at| (at.index(), [at.theta_deg, at.phi_deg])).collect();
        let range_ma = of_meter.meter.range_ma;
        let readings = Readings::from_csv_at(&angles, name, currents, setup.coefficients(), range_ma)?;
        let currents_sha256 = sha256_hex(currents);
        let name = name.to_owned();
        Ok(Self { content, laboratory, gyro_type, setup, missing, name, currents_sha256, readings })
    }

    /// Calibrates the gyro. `subject` says which one and under which conditions; its SHA-256 is filled in here. The result
    /// is compared with the last of the `previous` ones.
    pub(crate) fn run(
        mut self,
        options: &Options,
        subject: Subject,
        previous: &[CalibrationDocument],
    ) -> Result<Done, Failed> {
        let (content, laboratory, gyro_type) = (self.content, self.laboratory, self.gyro_type);
        let early = subject.check_date(&content.certificate).map_err(Failed::unusable)?;
        let warning = TemperatureOutside::of(&content.certificate, &subject, laboratory);
        check_gyro_and_day(&subject, previous)?;
        let unknown_gyro = subject.unknown_gyro(previous);
        let mut calibration = self.calibrated(options)?;
        self.missing.extend(calibration.noise_not_stated());
        let last = previous.last();
        let verified = subject.passport_verified_as_of.is_some();
        let documented = |readings: &Readings, calibration: &Calibration| {
            self.documented((readings, calibration), options, verified, last)
        };
        let mut document = documented(&self.readings, &calibration);
        let gyro = gyro_type.map(|gyro_type| gyro_type.r#type.clone());
        document.subject = Some(Subject { currents_sha256: self.currents_sha256.clone(), gyro_type: gyro, ..subject });
        document.assumed_meter = laboratory.is_none().then(|| ASSUMED_METER.to_owned());
        (document.excluded, document.left_out) = (self.readings.exclusions.clone(), self.readings.left_out.clone());
        let Some(found) = document.found() else {
            let words = document.refused.iter().map(|(method, why)| format!("{method}: {why}"));
            return Err(Failed::refused(words.collect::<Vec<_>>().join("\n")));
        };
        // Without a type or a valid earlier result, the nominal values of the paper's gyro still reveal an error by a
        // factor of a thousand.
        let usual = last.filter(|earlier| earlier.is_valid()).and_then(CalibrationDocument::found);
        let usual = usual.map_or_else(|| GyroType::gvk_6().nominal.to_model(), |found| found.parameters);
        if let Some(gyro_type) = gyro_type {
            by_type::narrow(&mut calibration.causes, &found, gyro_type);
        }
        calibration.causes.retain(|cause| cause.kind != Kind::Range || !calibration.consistent);
        let case = (&self.setup, &self.readings, options);
        let of_type = if calibration.fits() { by_type::causes(case, &found, gyro_type, &usual) } else { Vec::new() };
        calibration.with_words(of_type);
        let mut document = document.explained_by(&calibration);
        document.remarks = calibration::remarks::remarks(&calibration, &self.readings);
        let of_laboratory = laboratory.into_iter().flat_map(Laboratory::remarks);
        let of_files = of_laboratory.chain(gyro_type.into_iter().flat_map(GyroType::remarks));
        let english = |words: Words| plain(&words.plain(Language::English));
        let of_conditions = warning.map(|warning| warning.to_string()).into_iter().chain(of_files.map(english));
        let of_others = of_conditions.chain(early).chain(another_type(previous, gyro_type)).chain(unknown_gyro.clone());
        document.remarks.extend(self.readings.remarks.iter().cloned().chain(of_others));
        if let Some(gyro_type) = gyro_type {
            self.judge(&mut document, &calibration, gyro_type, (options, last), documented);
        }
        let unexplained = last.and_then(|earlier| document.unexplained_in_words(earlier));
        let of_verdict = document.verdict.as_ref().filter(|verdict| !verdict.withheld);
        let common_factor = of_verdict.and_then(Verdict::common_factor_in_words);
        document.remarks.extend(unexplained.into_iter().chain(common_factor).map(english));
        let limits = last.map_or_else(Vec::new, |earlier| document.limits_in_words(earlier));
        document.remarks.extend(limits);
        let earlier = last.map(|earlier| (earlier.clone(), document.no_change(earlier)));
        // With a type, the drifts are stated at its g: the local g is in their uncertainties.
        let of_gravity = |parameter| if document.verdict.is_some() { found.u_from_gravity(parameter) } else { 0.0 };
        let cost_of_missing = cost_of_missing(&self.setup, &self.readings, &found.parameters, of_gravity);
        // A further visit is of no use as long as one is suspect.
        let sound = of_verdict.filter(|_| calibration.suspects().next().is_none());
        let least_certain = sound.and_then(Verdict::least_certain);
        let further = least_certain.and_then(|row| {
            let result = (&calibration, &found.parameters);
            let visit = best_further_visit(&self.setup, &self.readings, result, (row.parameter, options))?;
            Some((row.parameter, FurtherVisit { ratio: row.ratio_with_gravity(visit.ratio), ..visit }))
        });
        let stated_c = document.subject.as_ref().and_then(|subject| temperature_c(subject, laboratory));
        let unchecked_range_c = content.certificate.temperature_range_c.filter(|_| stated_c.is_none());
        let without_height = content.site.is_gravity_without_height();
        let Self { setup, readings, missing, .. } = self;
        Ok(Done {
            setup,
            readings,
            calibration,
            missing,
            document,
            earlier,
            unknown_gyro,
            cost_of_missing,
            further,
            warning,
            unchecked_range_c,
            without_height,
        })
    }

    /// Calibrates the gyro, or says what is to be read for it.
    fn calibrated(&self, options: &Options) -> Result<Calibration, Failed> {
        let name = printable::printable(&self.name);
        let calibration = calibration::calibrate(&self.setup, &self.readings, options).map_err(|error| {
            let unread: Vec<String> = self.readings.left_out.iter().map(ToString::to_string).collect();
            let is_remediable = matches!(error, NoLeastSquares::Inseparable { .. }) && options.model == Model::Paper;
            let remedy = match unread.as_slice() {
                _ if !is_remediable => String::new(),
                [] => "; check that each axis was recorded from its own channel, or read more positions (`plan` finds them)"
                    .to_owned(),
                unread => format!("; read the other positions of the passport too: {}", unread.join(", ")),
            };
            Failed::refused(format!("{name}: {error}{remedy}"))
        })?;
        match calibration.meaningless() {
            Some(words) => Err(Failed::refused(format!("{name}: {words}"))),
            None => Ok(calibration),
        }
    }

    /// Returns a calibration from `readings` as a document, without a verdict.
    fn documented(
        &self,
        (readings, calibration): (&Readings, &Calibration),
        options: &Options,
        verified: bool,
        last: Option<&CalibrationDocument>,
    ) -> CalibrationDocument {
        let content = self.content;
        let gravity = (content.earth.gravity_m_per_s2, content.site.gravity_u_m_per_s2());
        let mut document =
            CalibrationDocument::new(&content.passport.id, verified, gravity, calibration, &self.missing);
        let budget = calibration.adopted().and_then(|_| Budget::of(calibration, &self.setup, readings, options).ok());
        if self.gyro_type.is_some() {
            document.not_tested.clear();
        }
        document.degrees_of_freedom = budget.map_or_else(BTreeMap::new, |budget| budget.degrees_of_freedom());
        let noise = last.and_then(|earlier| document.visits_of_one(earlier)).zip(document.found());
        document.u_of_single_visits =
            noise.and_then(|(noise, found)| u_of_single_visits(&self.setup, readings, &found.parameters, noise));
        document
    }

    /// Adds the verdict by the type and the change since the `last` result, on which the results with and without the suspect
    /// visits agree; `documented` makes a document of a calibration.
    fn judge(
        &self,
        document: &mut CalibrationDocument,
        calibration: &Calibration,
        gyro_type: &GyroType,
        (options, last): (&Options, Option<&CalibrationDocument>),
        documented: impl Fn(&Readings, &Calibration) -> CalibrationDocument,
    ) {
        let without = without_suspects(calibration, &self.readings, |rest| {
            // Without a visit, the paper's methods may not have a result.
            let methods = vec![Method::LeastSquares];
            let mut found = calibration::calibrate(&self.setup, rest, &Options { methods, ..options.clone() }).ok()?;
            found.with_words(calibration.mistake().filter(|cause| cause.invalidates()).cloned());
            Some((documented(rest, &found), found))
        });
        let agreed = |judged: &dyn Fn(&CalibrationDocument) -> Option<Verdict>| {
            let others = without.iter().map(|found| found.as_ref().and_then(judged));
            Some(others.fold(judged(document)?, Verdict::agreed))
        };
        let verdict = agreed(&|found| found.judged(gyro_type));
        let change = last.and_then(|earlier| agreed(&|found| found.changed(earlier, gyro_type)));
        (document.verdict, document.change) = (verdict, change);
    }
}

/// Refuses earlier results of another gyro, and later ones.
fn check_gyro_and_day(subject: &Subject, previous: &[CalibrationDocument]) -> Result<(), Failed> {
    if let Some([before, now]) = subject.another_gyro(previous) {
        let [before, now] = [before, now].map(printable::printable);
        return Err(Failed::refused(format!(
            "the previous result is that of gyro {before}, not of {now}; give the result of the same gyro, or correct the \
             serial number"
        )));
    }
    match subject.later_result(previous) {
        Some([later, now]) => Err(Failed::refused(format!(
            "the previous result is of {later}, after these readings of {now}; check which is earlier"
        ))),
        None => Ok(()),
    }
}
