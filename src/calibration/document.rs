//! The JSON result of `calibrate`, which a later calibration can read for comparison.

/// Declares a part of the result. A key with `= default` is omitted while its value is the default one: `None`, or an empty
/// list. Keys that are not declared are refused.
macro_rules! result {
    ($(#[$about:meta])* $vis:vis struct $name:ident {
        $($(#[$doc:meta])* $field_vis:vis $field:ident: $type:ty $(= $default:ident)?,)*
    }) => {
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        $(#[$about])*
        $vis struct $name {
            $(
                $(#[$doc])*
                $(#[serde(skip_serializing_if = "crate::calibration::document::is_default", $default)])?
                $field_vis $field: $type,
            )*
        }
    };
}

pub(crate) mod result;

pub(crate) use result::{ResidualDocument, ResultDocument, finite};

use super::finding::by_type::NEED_A_GYRO_TYPE;
use super::parameter::symbols;
use super::readings::Exclusion;
use super::recorded::Digits;
use super::verdict::change_in_uncertainties;
use super::{
    Calibration, Finding, Found, Method, MethodResult, NotStated, NotValid, Parameter, RowScatter, Scatter, Verdict,
    against_earlier, against_type,
};
use crate::coefficients::PositionIndex;
use crate::document::RegisterUsed;
use crate::gyro::GyroType;
use crate::stand::Certificate;
use crate::statistics::distributions::normal_below;
use crate::text::Unreadable;
use crate::text::node::from_json;
use crate::text::printable::printable;
use crate::wording::texts::comparison;
use crate::wording::{Language, Words};
use jiff::civil::Date;
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

result! {
    /// JSON result of a calibration, with the keys in the order of writing.
    #[derive(Default)]
    pub struct CalibrationDocument {
        /// Identifier of the passport used.
        pub(crate) passport_id: String,
        /// `true` if the passport was verified.
        pub(crate) passport_verified: bool,
        /// Register by which the passport was checked, if one was asked.
        pub(crate) register: Option<RegisterUsed> = default,
        /// Value of g to which g-sensitive drifts refer, m/s².
        pub(crate) gravity_m_per_s2: f64,
        /// Standard uncertainty of g, m/s²; absent if it is not stated.
        pub(crate) gravity_u_m_per_s2: Option<f64> = default,
        /// Gyro, operator, conditions and file of currents; absent in results of earlier versions.
        pub(crate) subject: Option<Subject> = default,
        /// Meter that is assumed, because no laboratory is stated.
        pub(crate) assumed_meter: Option<String> = default,
        /// Visits that were left out, each with its reason.
        pub(crate) excluded: Vec<Exclusion> = default,
        /// Positions of the passport without a reading.
        pub(crate) left_out: Vec<PositionIndex> = default,
        /// Method whose result is adopted.
        #[serde(default)]
        pub(crate) adopted: String,
        /// `false` if the readings do not fit this stand, so that the parameters are not valid; `causes` says why.
        #[serde(default = "yes")]
        pub(crate) consistent: bool,
        /// Effective degrees of freedom of the adopted uncertainties by the keys of the parameters; those without a key are
        /// unlimited.
        pub(crate) degrees_of_freedom: BTreeMap<Parameter, f64> = default,
        /// Covariance of the adopted parameters, 8×8, in the order and units of [`Parameter::EIGHT`]; null for ω_g and ω_k in
        /// the general model. Results of earlier versions have none.
        pub(crate) covariance: Vec<[Option<f64>; 8]> = default,
        /// Results, one for each method, the adopted one first.
        pub(crate) results: Vec<ResultDocument>,
        /// Reasons why methods gave no result, by the keys of the methods.
        pub(crate) refused: BTreeMap<String, String> = default,
        /// Inputs whose uncertainty certificate, site and laboratory do not state; the result does not include it.
        pub(crate) not_stated: Vec<String> = default,
        /// Errors that were not looked for, because no gyro type was specified.
        pub(crate) not_tested: Vec<String> = default,
        /// Agreement of the visits of a position; present if there are several visits.
        pub(crate) scatter: Option<Scatter> = default,
        /// Agreement of the turn-ons with the gyro type; present if there are several and the type states their noise.
        pub(crate) turn_on_scatter: Option<Scatter> = default,
        /// Scatter of the rows of a visit; present if there are several rows.
        pub(crate) row_scatter: Option<RowScatter> = default,
        /// Rounding of the currents, and repeated readings without scatter; absent if there is nothing to state.
        pub(crate) digits: Option<Digits> = default,
        /// Causes that explain the readings or the parameters, the most likely first.
        pub(crate) causes: Vec<Finding> = default,
        /// The cause that makes the result invalid: the first that is not chance. Results of earlier versions have other keys.
        pub(crate) mistake: Option<Value> = default,
        /// Remarks for the user on the currents, the laboratory and the fit, one sentence each.
        pub(crate) remarks: Vec<String> = default,
        /// Comparison with the gyro type.
        #[serde(deserialize_with = "left_aside")]
        pub(crate) verdict: Option<Verdict> = default,
        /// Comparison with an earlier result.
        #[serde(deserialize_with = "left_aside")]
        pub(crate) change: Option<Verdict> = default,
        /// Standard uncertainty of each parameter from the noise of the drift between visits, with one visit to each position.
        /// It is present if only one of this result and the earlier one includes that noise.
        #[serde(skip)]
        pub(crate) u_of_single_visits: Option<[f64; 8]>,
        /// Keys that are added to a result outside this type; they are accepted and ignored on reading.
        #[serde(skip_serializing, default)]
        budget: IgnoredAny,
        #[serde(skip_serializing, default)]
        monte_carlo: IgnoredAny,
        /// Keys of results of earlier versions.
        #[serde(skip_serializing, default)]
        suspects: Vec<IgnoredAny>,
        #[serde(skip_serializing, default)]
        hint: Option<IgnoredAny>,
        #[serde(skip_serializing, default)]
        drift_probability: IgnoredAny,
    }
}

result! {
    /// Gyro, operator and conditions of a calibration, and the file of its currents.
    #[derive(Default)]
    pub(crate) struct Subject {
        pub gyro_serial: Option<String> = default,
        /// Name of the operator who took the readings.
        pub operator: Option<String> = default,
        /// Day of the readings, YYYY-MM-DD.
        pub date: Option<Date> = default,
        pub temperature_c: Option<f64> = default,
        /// Time for which the passport was verified; it may be in the past.
        pub passport_verified_as_of: Option<Timestamp> = default,
        pub currents_sha256: String,
        /// Name of the gyro type with which the result was compared.
        pub gyro_type: Option<String> = default,
    }
}

/// Reason why a difference from an earlier result is not a change of the gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoChange {
    /// Both results are from the same readings.
    SameReadings,
    /// The earlier readings did not fit the stand, or contained an error.
    EarlierNotValid,
    /// A visit or a row of the earlier readings is probably wrong.
    EarlierSuspect,
    /// The passport of the earlier result was not verified.
    EarlierNotVerified,
}

/// Probability below which a change is not chance, for all parameters together.
const CHANGED: f64 = 0.01;

/// Returns a warning if one of the `earlier` results was compared with another type than `gyro_type`: it may be that of
/// another gyro.
pub(crate) fn another_type(earlier: &[CalibrationDocument], gyro_type: Option<&GyroType>) -> Option<String> {
    let now = &gyro_type?.r#type;
    let mut stated = earlier.iter().filter_map(|result| result.subject.as_ref()?.gyro_type.as_deref());
    let other = stated.find(|before| before != now)?;
    let [before, now] = [other, now].map(printable);
    Some(format!(
        "the previous result is that of a gyro of type {before}, not {now}; check that it belongs to this gyro; otherwise the change is \
         the difference between two gyros"
    ))
}

/// Results of the first version do not say whether the readings fit.
fn yes() -> bool {
    true
}

pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Skips the decisions in an earlier result, because they are made again.
fn left_aside<'de, T, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error> {
    IgnoredAny::deserialize(deserializer).map(|_| None)
}

impl Subject {
    /// Returns a warning if the readings are from before the stand was measured for its `certificate`.
    ///
    /// # Errors
    /// Refuses, in words, a day of the readings that had not begun at the time of the verification.
    pub(crate) fn check_date(&self, certificate: &Certificate) -> Result<Option<String>, String> {
        const LARGEST_OFFSET: SignedDuration = SignedDuration::from_hours(14);
        let day_begins = |time: Timestamp| {
            let latest = time.saturating_add(LARGEST_OFFSET).unwrap_or(Timestamp::MAX);
            TimeZone::UTC.to_datetime(latest).date()
        };
        // The day has not begun in any time zone.
        let later = self.date.zip(self.passport_verified_as_of).filter(|(date, time)| *date > day_begins(*time));
        if let Some((date, time)) = later {
            return Err(format!(
                "the day of the readings, {date}, is later than the time of the verification, {time}; check the date"
            ));
        }
        let early = self.day_before_certification(certificate);
        Ok(early.map(|[date, performed]| {
            format!(
                "the day of the readings, {date}, is before the stand was measured for its certificate, {performed}; check \
                 the date; nothing shows that the stand was then as it is certified"
            )
        }))
    }

    /// Returns the day of the readings and that on which the stand was measured for its `certificate` if the readings are
    /// older, or `None` if they are not, or if one of the days is not stated.
    pub(crate) fn day_before_certification(&self, certificate: &Certificate) -> Option<[Date; 2]> {
        let (date, performed) = self.date.zip(certificate.performed)?;
        (date < performed).then_some([date, performed])
    }

    /// Returns the serial numbers of two gyros if the results are known to be those of different ones.
    pub(crate) fn another_gyro<'a>(&'a self, earlier: &'a [CalibrationDocument]) -> Option<[&'a str; 2]> {
        let mut known = earlier.iter().filter_map(CalibrationDocument::gyro_serial).chain(self.gyro_serial.as_deref());
        let first = known.next()?;
        known.find(|serial| *serial != first).map(|other| [first, other])
    }

    /// Returns a warning if a serial number is known of these readings or of the `earlier` results, but not of all.
    pub(crate) fn unknown_gyro(&self, earlier: &[CalibrationDocument]) -> Option<String> {
        let stated = |is_stated| earlier.iter().any(|result| result.gyro_serial().is_some() == is_stated);
        let which = match self.gyro_serial {
            Some(_) if stated(false) => "the previous result states no serial number",
            None if stated(true) => "the previous result states a serial number, but these readings have none",
            _ => return None,
        };
        Some(format!("{which}, so it may be that of another gyro"))
    }

    /// Returns the days of an earlier result and of these readings if the result is from later readings, or `None` if
    /// none is, or if no days are stated.
    pub(crate) fn later_result(&self, earlier: &[CalibrationDocument]) -> Option<[Date; 2]> {
        let date = self.date?;
        let days = earlier.iter().filter_map(|result| result.subject.as_ref()?.date);
        days.max().filter(|latest| *latest > date).map(|latest| [latest, date])
    }
}

impl CalibrationDocument {
    /// Creates the JSON result of a calibration. The pair contains the local g and its standard uncertainty, m/s²;
    /// `not_stated` is the list that [`Setup::stated`] returns.
    ///
    /// [`Setup::stated`]: super::inputs::Setup::stated
    pub fn new(
        passport_id: &str,
        passport_verified: bool,
        (gravity_m_per_s2, gravity_u_m_per_s2): (f64, Option<f64>),
        calibration: &Calibration,
        not_stated: &[NotStated],
    ) -> Self {
        let best = calibration.adopted();
        let adopted = best.map(|result| result.method);
        let mut results: Vec<_> = calibration.results.iter().collect();
        results.sort_by_key(|result| Some(result.method) != adopted);
        Self {
            passport_id: passport_id.to_owned(),
            passport_verified,
            gravity_m_per_s2,
            gravity_u_m_per_s2,
            adopted: adopted.map_or_else(String::new, |method| method.key().to_owned()),
            consistent: calibration.consistent,
            covariance: best.map_or_else(Vec::new, MethodResult::covariance_of_eight),
            results: results.into_iter().map(|result| result.document.clone()).collect(),
            refused: calibration
                .refused
                .iter()
                .map(|(method, why)| (method.key().to_owned(), why.to_string()))
                .collect(),
            not_stated: not_stated.iter().map(|what| what.words().to_owned()).collect(),
            not_tested: NEED_A_GYRO_TYPE.map(str::to_owned).into(),
            scatter: calibration.scatter,
            turn_on_scatter: calibration.turn_on_scatter,
            row_scatter: calibration.row_scatter,
            digits: calibration.digits,
            ..Self::default()
        }
        .explained_by(calibration)
    }

    /// Returns the result with the causes of a calibration.
    pub(crate) fn explained_by(self, calibration: &Calibration) -> Self {
        let mistake = calibration.mistake().and_then(|cause| serde_json::to_value(cause).ok());
        Self { causes: calibration.causes.clone(), mistake, ..self }
    }

    pub(crate) fn currents_sha256(&self) -> Option<&str> {
        Some(self.subject.as_ref()?.currents_sha256.as_str())
    }

    pub(crate) fn gyro_serial(&self) -> Option<&str> {
        self.subject.as_ref()?.gyro_serial.as_deref()
    }

    pub(crate) fn date(&self) -> Option<Date> {
        self.subject.as_ref()?.date
    }

    /// Sorts results from the earliest to the latest; if not every one has a date, the order stays.
    pub(crate) fn sort(results: &mut [Self]) {
        if results.iter().all(|result| result.date().is_some()) {
            results.sort_by_key(Self::date);
        }
    }

    /// Reads an earlier JSON result; `name` is the file name in messages.
    ///
    /// # Errors
    /// Returns [`Unreadable`] with line and column if `bytes` is not such a result, or contains no parameters.
    pub fn from_json(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        const EXPECTED: &str = "the JSON result of an earlier calibration";
        // A line of JSON for one of several gyros begins with the name of its file.
        let advice = match bytes.trim_ascii_start().starts_with(b"{\"file\":") {
            true => "these are the results of several gyros; `calibrate --out DIR` writes each of them to a file",
            false => "create it with `calibrate --format json`",
        };
        let document: Self = from_json(name, bytes, EXPECTED, advice)?;
        match document.results.is_empty() {
            true => Err(Unreadable::whole(name, None, "no parameters", EXPECTED, "")),
            false => Ok(document),
        }
    }

    /// Returns the adopted result if it is valid. A result that is not that of the gyro is never returned.
    ///
    /// # Errors
    /// Returns [`NotValid`] for the keys `consistent` and `mistake`, with the words of `causes`: if the readings do not fit the stand, or an
    /// error explains the parameters; or if no method gave a result.
    pub fn valid(&self) -> Result<Found, NotValid> {
        let causes = || self.causes.iter().map(|cause| cause.words.as_str()).collect::<Vec<_>>().join(" ");
        NotValid::checked(self.found(), self.consistent && self.hint.is_none(), self.mistake.is_some(), causes)
    }

    /// Returns the adopted result even if it is not valid; `None` if there is no result.
    pub(crate) fn found(&self) -> Option<Found> {
        let best = self.best()?;
        let of = |parameter: Parameter| self.degrees_of_freedom.get(&parameter).copied();
        let degrees_of_freedom = Parameter::EIGHT.map(|parameter| of(parameter).unwrap_or(f64::INFINITY));
        Some(Found { degrees_of_freedom, ..best.found(self.gravity_m_per_s2, self.gravity_u_m_per_s2) })
    }

    /// Returns the result of the adopted method. Results of the first version do not name it: it is least squares if
    /// present, otherwise the last method.
    pub(crate) fn best(&self) -> Option<&ResultDocument> {
        let of = |method: &str| self.results.iter().find(|result| result.method == method);
        of(&self.adopted).or_else(|| of(Method::LeastSquares.key())).or(self.results.last())
    }

    /// Returns the noise of the drift from visit to visit, °/h, if only this result or `earlier` includes it.
    pub(crate) fn visits_of_one(&self, earlier: &Self) -> Option<f64> {
        let mut noises = self.noises_of_one(earlier).into_iter();
        noises.find(|(what, ..)| *what == NotStated::Visits).map(|(_, _, (deg_per_h, _))| deg_per_h)
    }

    /// Returns the noises that only this result or `earlier` includes: its standard deviation, °/h, and degrees of freedom,
    /// and the place of the result that does not include it, 0 for this one and 1 for the earlier.
    fn noises_of_one(&self, earlier: &Self) -> Vec<(NotStated, usize, (f64, f64))> {
        // Results of earlier versions do not say.
        let noises = |one: &Self| Some(one.best()?.noise.as_ref()?.each());
        let Some((now, before)) = noises(self).zip(noises(earlier)) else { return Vec::new() };
        let of_one = |((what, now), before)| match (now, before) {
            (None, Some(noise)) => Some((what, 0, noise)),
            (Some(noise), None) => Some((what, 1, noise)),
            _ => None,
        };
        let each = [NotStated::Visits, NotStated::TurnOns].into_iter().zip(now).zip(before);
        each.filter_map(of_one).filter(|(_, _, (deg_per_h, _))| *deg_per_h > 0.0).collect()
    }

    /// Returns what limits a comparison with `earlier`, in words with the inputs that they are about: noise of the gyro that
    /// only one of the results includes, and inputs that only the earlier one leaves out.
    pub(crate) fn limits_of_change(
        &self,
        earlier: &Self,
    ) -> impl Iterator<Item = (fn(Words) -> Words, Vec<NotStated>)> {
        let noises: Vec<NotStated> = self.noises_of_one(earlier).into_iter().map(|(what, ..)| what).collect();
        let left_out = |one: &Self, what: &NotStated| one.not_stated.iter().any(|words| words == what.words());
        let only_before = |what: &NotStated| left_out(earlier, what) && !left_out(self, what) && !noises.contains(what);
        let before = NotStated::ALL.into_iter().filter(only_before).collect();
        [(comparison::noise_of_one as fn(Words) -> Words, noises), (comparison::left_out_before, before)]
            .into_iter()
            .filter(|(_, inputs)| !inputs.is_empty())
    }

    /// Returns the sentence on parameters that have changed since `earlier` more than the uncertainties explain.
    pub(crate) fn unexplained_in_words(&self, earlier: &Self) -> Option<Words> {
        let changed = self.unexplained_change(earlier);
        (!changed.is_empty()).then(|| comparison::unexplained(symbols(changed)))
    }

    /// Returns the limits of a comparison with `earlier` in words, a sentence each.
    pub(crate) fn limits_in_words(&self, earlier: &Self) -> Vec<String> {
        let sentence = |(words, inputs): (fn(Words) -> Words, Vec<NotStated>)| {
            let names = inputs.into_iter().map(NotStated::words).collect::<Vec<_>>().join("; ");
            words(names.into()).plain(Language::English)
        };
        self.limits_of_change(earlier).map(sentence).collect()
    }

    /// Returns this result and `earlier` for comparison. A noise of the gyro that only one of them includes is added to the
    /// other, which does not include it because it has a single turn-on, or a single visit to each position.
    pub(crate) fn with_earlier(&self, earlier: &Self) -> Option<[Found; 2]> {
        let mut both = [self.found()?, earlier.found()?];
        for (what, other, (deg_per_h, degrees_of_freedom)) in self.noises_of_one(earlier) {
            for parameter in Parameter::EIGHT {
                let u = match (what, parameter) {
                    (NotStated::Visits, _) => self.u_of_single_visits.map_or(0.0, |each| each[parameter.place()]),
                    (_, Parameter::Omega0x | Parameter::Omega0y) => deg_per_h,
                    _ => 0.0,
                };
                both[other].add(parameter, (u, degrees_of_freedom));
            }
        }
        Some(both)
    }

    /// Returns the comparison of the adopted result with a gyro type; `None` if there is no result. Nothing is
    /// decided if the readings do not fit the stand.
    pub(crate) fn judged(&self, gyro_type: &GyroType) -> Option<Verdict> {
        Some(self.withheld(against_type(&self.found()?, gyro_type)))
    }

    /// Returns the comparison of the adopted result with that of `earlier`, within the tolerance of a gyro type, as
    /// `judged` does. Nothing is decided if the results are not two measurements of the gyro.
    pub(crate) fn changed(&self, earlier: &Self, gyro_type: &GyroType) -> Option<Verdict> {
        let [found, before] = self.with_earlier(earlier)?;
        let change = against_earlier(&found, &before, gyro_type);
        Some(if self.no_change(earlier).is_some() { change.undecided() } else { self.withheld(change) })
    }

    /// Returns the reason why a difference from `earlier` is not a change of the gyro, if there is one.
    pub(crate) fn no_change(&self, earlier: &Self) -> Option<NoChange> {
        let file = self.currents_sha256().filter(|sha256| !sha256.is_empty());
        let same_file = file.is_some() && file == earlier.currents_sha256();
        // The same readings may have been saved anew.
        let same_result = || self.found().zip(earlier.found()).is_some_and(|(here, there)| here.is_same(&there));
        if same_file || same_result() {
            Some(NoChange::SameReadings)
        } else if !earlier.is_valid() {
            Some(NoChange::EarlierNotValid)
        } else if !earlier.passport_verified {
            Some(NoChange::EarlierNotVerified)
        } else {
            earlier.is_suspect().then_some(NoChange::EarlierSuspect)
        }
    }

    /// Returns `true` if a visit or a row is probably wrong.
    fn is_suspect(&self) -> bool {
        !self.suspects.is_empty() || self.causes.iter().any(Finding::is_reading)
    }

    /// Returns the parameters whose change since `earlier` is larger than chance explains, if no type decides on it: the
    /// smallest probability of all is below [`CHANGED`].
    pub(crate) fn unexplained_change(&self, earlier: &Self) -> Vec<Parameter> {
        let is_change = self.change.is_none() && self.is_valid() && self.no_change(earlier).is_none();
        let Some([found, before]) = self.with_earlier(earlier).filter(|_| is_change) else {
            return Vec::new();
        };
        let change = change_in_uncertainties(&found, &before);
        let is_unexplained = |parameter: &Parameter| {
            let probability = 2.0 * normal_below(-change[parameter.place()].abs());
            probability * Parameter::EIGHT.len() as f64 <= CHANGED
        };
        Parameter::AS_IN_THE_PAPER.into_iter().filter(is_unexplained).collect()
    }

    /// Returns the comparison with the earlier result, if a statement is made on the change.
    pub(crate) fn stated_change(&self) -> Option<&Verdict> {
        self.change.as_ref().filter(|change| !change.withheld)
    }

    /// Returns `false` if the readings do not fit the stand, if an error explains the result, or if there is none.
    pub(crate) fn is_valid(&self) -> bool {
        self.valid().is_ok()
    }

    fn withheld(&self, verdict: Verdict) -> Verdict {
        match self.is_valid() {
            true => Verdict { withheld: !self.passport_verified, ..verdict },
            false => verdict.undecided(),
        }
    }
}
