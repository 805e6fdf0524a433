//! Findings: what is wrong with a measurement or has changed, where, by how much, and with which probability; their words.
//!
//! One type carries a finding from the search to the words, which are made from its kind, and to JSON.

use super::AngleReadings;
use super::header::NominalPosition;
use super::hypothesis::{Accepted, At, Cause, Change, Explanation};
use super::kind::{AXES, Kind, OUTLIER, Part, Setting};
use super::layer::Runs;
use crate::attitude::{ANGLE_SYMBOLS, ANGLES};
use crate::coefficients::PositionIndex;
use crate::statistics::student::student_factor;
use crate::text::number::decimals;
use crate::wording::number::{Number, Probability};
use crate::wording::texts::{compass, findings as texts, remarks};
use crate::wording::words::{code, symbol};
use crate::wording::{Language, Text, Words, plain};
use nalgebra::Vector3;
use serde::Serialize;
use serde_json::{Value, json};

/// What a finding concerns; all of the measurement if nothing is stated.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Scope {
    #[serde(flatten)]
    pub position: Option<PositionIndex>,
    pub run: Option<u32>,
    pub runs: Vec<u32>,
    pub angle: Option<&'static str>,
    pub angles: Vec<&'static str>,
    pub axis: Option<&'static str>,
    pub part: Option<&'static str>,
    pub after_run: Option<u32>,
    /// Indices (i, j) of two positions.
    pub between: Option<[[u32; 2]; 2]>,
    pub setting: Option<&'static str>,
    pub theta_deg: Option<f64>,
    pub phi_deg: Option<f64>,
    pub certificates: Vec<String>,
}

impl Scope {
    /// Returns the scope of the positions with one value of a setting, degrees.
    pub(super) fn of_setting(setting: Setting, angle_deg: f64) -> Self {
        let [theta_deg, phi_deg] = Setting::ALL.map(|of| (of == setting).then_some(angle_deg));
        Self { theta_deg, phi_deg, ..Self::default() }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub kind: Kind,
    pub scope: Scope,
    /// Size in `unit`; `None` if the finding has none.
    pub size: Option<f64>,
    /// Unit of the size; of another unit of the angles its name, if the angles agree with it.
    pub unit: Option<&'static str>,
    /// Probability that chance makes any cause explain as much.
    pub probability: f64,
    /// Sentences.
    pub words: Words,
    /// What to do at a terminal, with the keys and options of files and commands.
    pub advice: Option<Words>,
    /// Rotation about three axes, arcsec.
    pub turns_arcsec: [f64; 3],
}

impl Found {
    /// Returns a finding without a place and a size.
    pub(crate) fn new(kind: Kind, scope: Scope, probability: f64, words: impl Into<Words>) -> Self {
        let words = words.into();
        Self { kind, scope, size: None, unit: None, probability, words, advice: None, turns_arcsec: [0.0; 3] }
    }

    pub(crate) fn sized(self, arcsec: f64) -> Self {
        Self { size: Some(arcsec), unit: Some("arcsec"), ..self }
    }

    pub(crate) fn advised(self, advice: impl Into<Words>) -> Self {
        Self { advice: Some(advice.into()), ..self }
    }

    /// Returns `true` if chance explains the finding in less than 1 % of the measurements.
    pub(crate) fn accuses(&self) -> bool {
        self.probability < OUTLIER
    }

    pub(crate) fn to_json(&self) -> Value {
        let mut json = json!({
            "kind": self.kind.code(), "scope": self.scope, "size": self.size, "unit": self.unit,
            "probability": self.probability, "words": plain(&self.words.plain(Language::English)),
        });
        let is_stated = |value: &Value| !value.is_null() && value.as_array().is_none_or(|list| !list.is_empty());
        if let Some(entries) = json.as_object_mut() {
            entries.retain(|key, value| key != "unit" || is_stated(value));
        }
        if let Some(scope) = json["scope"].as_object_mut() {
            scope.retain(|_, value| is_stated(value));
        }
        json
    }
}

/// Returns findings as JSON, the most likely first; where chance is about as likely, it is among them.
pub(crate) fn to_json<'a>(found: impl IntoIterator<Item = &'a Found>) -> Value {
    let mut all: Vec<&Found> = found.into_iter().collect();
    all.sort_by(|a, b| a.probability.total_cmp(&b.probability));
    let mut json: Vec<Value> = all.iter().map(|found| found.to_json()).collect();
    if let Some(first) = all.first().filter(|first| !first.accuses()) {
        json.push(Found::new(Kind::Chance, Scope::default(), first.probability, texts::CHANCE).to_json());
    }
    Value::Array(json)
}

/// Names positions, runs and axes of what explains a measurement.
pub(super) struct Naming<'a> {
    pub(super) positions: &'a [NominalPosition],
    pub(super) readings: &'a AngleReadings,
    pub(super) explanation: &'a Explanation,
}

impl Naming<'_> {
    pub(super) fn all(&self) -> Vec<Found> {
        self.explanation.accepted.iter().map(|at| self.found(at)).collect()
    }

    fn found(&self, accepted: &Accepted) -> Found {
        let Accepted { cause, sizes_arcsec, probability } = accepted;
        let runs = &self.readings.runs;
        let index = |place: usize| self.positions[place].index();
        let turns = self.turns_arcsec(accepted);
        let ([x, y, z], length) = (together(turns), Vector3::from(turns).norm());
        let (p, of_visits) = (Probability(*probability), self.explanation.components.pooled_arcsec2.value.sqrt());
        let new = |words: Words| Found {
            turns_arcsec: turns,
            ..Found::new(cause.kind, self.scope(*cause), *probability, words).sized(length)
        };
        // The run, or the first one after a step, and the one before.
        let at = if let Change::Shift(Runs::One(run) | Runs::From(run)) = cause.change { run } else { 0 };
        let [last, run] = [at.saturating_sub(1), at].map(|at| runs[at]);
        let line = |place| -> Words {
            match self.readings.line(place, at) {
                Some(line) if runs.len() > 2 => vec![" ".into(), texts::line(line)].into(),
                _ => "".into(),
            }
        };
        match (cause.at, cause.change) {
            (At::Angle(place, angle), _) => {
                let (name, size) = (symbol(ANGLE_SYMBOLS[angle]), sizes_arcsec[0]);
                let words = texts::angle(name, index(place), run, line(place), arcsec(size), p);
                self.repeated(new(words).sized(size), place, run)
            }
            (At::Position(place), Change::Shift(Runs::One(_))) => {
                self.repeated(new(texts::reading(index(place), run, line(place), x, y, z, p)), place, run)
            }
            (At::Position(place), Change::Shift(_)) => {
                new(texts::position_moved(index(place), last, run, x, y, z, p)).advised(later_runs(run))
            }
            (At::Position(place), Change::Scatter) => {
                let s = self.scatter_arcsec(&[place]);
                new(texts::position_scatter(index(place), arcsec(s), arcsec(of_visits), p)).sized(s)
            }
            (At::Positions(setting, angle_deg), _) => {
                let places = (0..self.positions.len()).filter(|at| setting.of(&self.positions[*at]) == angle_deg);
                let s = self.scatter_arcsec(&places.collect::<Vec<_>>());
                let angle = Number::exact(angle_deg);
                let words = texts::setting_scatter(symbol(setting.symbol()), angle, arcsec(s), arcsec(of_visits), p);
                new(words).sized(s).advised(remarks::DO_FIND)
            }
            (At::Setting(setting), _) => {
                let s = sizes_arcsec[0];
                let words = texts::shared_setting(symbol(setting.symbol()), arcsec(s), p);
                new(words).sized(s).advised(remarks::DO_MEASURE)
            }
            (At::Visits(part, between), _) => {
                let [before, after] = between.map(index);
                new(texts::bump(run, after, x, y, z, part.axes(), before, p)).advised(without_run(run))
            }
            (At::Part(part), Change::Shift(Runs::One(_))) => {
                let mean = arcsec(length / runs.len() as f64);
                new(texts::run_turned(run, x, y, z, part.axes(), p, mean)).advised(without_run(run))
            }
            (At::Part(part), Change::Shift(Runs::From(_))) => {
                new(texts::stand_moved(last, run, x, y, z, part.axes(), p)).advised(later_runs(run))
            }
            (At::Part(part), _) => {
                new(texts::stand_drift(x, y, z, part.axes(), p)).advised(remarks::DO_FIND_AND_MEASURE)
            }
            (At::Axis(axis), _) => {
                let s = self.explanation.components.own_arcsec2[axis].value.sqrt();
                new(texts::axis_scatter(symbol(AXES[axis]), arcsec(s), arcsec(of_visits), p)).sized(s)
            }
            (At::RunAxis(axis), _) => self.run_axis(axis, p, &new),
            (At::Runs(one, other), _) => {
                Found { size: None, unit: None, ..new(texts::runs_copied(runs[one], runs[other], p)) }
            }
        }
    }

    /// Returns what a cause concerns.
    fn scope(&self, cause: Cause) -> Scope {
        let runs = &self.readings.runs;
        let index = |place: usize| self.positions[place].index();
        let (all, of_part) = (Scope::default(), |part: Part| Scope { part: Some(part.key()), ..Scope::default() });
        let scope = match cause.at {
            At::Position(place) => Scope { position: Some(index(place)), ..all },
            At::Angle(place, angle) => Scope { position: Some(index(place)), angle: Some(ANGLES[angle]), ..all },
            At::Positions(setting, angle_deg) => Scope::of_setting(setting, angle_deg),
            At::Setting(setting) => Scope { setting: Some(setting.key()), ..all },
            At::Visits(part, places) => {
                Scope { between: Some(places.map(index).map(|at| [at.i, at.j])), ..of_part(part) }
            }
            At::Part(part) => of_part(part),
            At::Axis(axis) => Scope { axis: Some(AXES[axis]), ..all },
            At::RunAxis(axis) => Scope { axis: Some(axis_of_part(axis).en), ..of_part(Part::ALL[axis / 3]) },
            At::Runs(one, other) => Scope { runs: vec![runs[one], runs[other]], ..all },
        };
        match (cause.change, &runs[..]) {
            // Of two runs, either may be wrong.
            (Change::Shift(Runs::One(_)), [_, _]) => Scope { runs: runs.clone(), ..scope },
            (Change::Shift(Runs::One(run)), _) => Scope { run: Some(runs[run]), ..scope },
            (Change::Shift(Runs::From(after)), _) => Scope { after_run: Some(runs[after - 1]), ..scope },
            _ => scope,
        }
    }

    /// Returns a finding on one reading, with what to do.
    fn repeated(&self, found: Found, place: usize, run: u32) -> Found {
        let PositionIndex { i, j } = self.positions[place].index();
        match self.readings.runs[..] {
            [one, other] => {
                let words = vec![found.words.clone(), " ".into(), texts::two_runs(one, other)].into();
                Found { words, ..found }.advised(remarks::DO_THIRD_RUN)
            }
            _ => found.advised(remarks::do_exclude_reading(code(format!("--exclude {i},{j},{run}")), code("--why"))),
        }
    }

    /// Returns the rotation of a cause about three axes, arcsec.
    fn turns_arcsec(&self, at: &Accepted) -> [f64; 3] {
        let turns = match at.cause.at {
            At::Visits(Part::Base, _) | At::Part(Part::Base) => {
                &self.explanation.components.model.base_axes * &at.sizes_arcsec
            }
            _ => at.sizes_arcsec.clone(),
        };
        std::array::from_fn(|axis| turns.get(axis).copied().unwrap_or(0.0))
    }

    /// Returns the standard deviation of a visit to some positions, arcsec.
    fn scatter_arcsec(&self, places: &[usize]) -> f64 {
        let components = &self.explanation.components;
        let each = components.scatter_of_positions(&[places.to_vec()]).map_or(1.0, |of| of[places[0]].value);
        let axes = components.own_arcsec2.iter().map(|own| own.value).sum::<f64>() / 3.0;
        (each * axes).sqrt()
    }

    fn run_axis(&self, axis: usize, p: Probability, new: &dyn Fn(Words) -> Found) -> Found {
        let runs = self.readings.runs.len() as f64;
        let variation = self.explanation.components.variation(&self.explanation.of_runs, axis);
        let freedom = self.explanation.of_runs[axis][1];
        // The variance of a single axis has few degrees of freedom, and those of the common parts are not in the file.
        let widened = student_factor(0.05, freedom) / student_factor(0.05, f64::INFINITY);
        let missing = ((variation.own_arcsec2 * widened * widened - variation.between_arcsec2).max(0.0) / runs).sqrt();
        let name = axis_of_part(axis);
        let (own, others) = (variation.own_arcsec2.sqrt(), variation.others_arcsec2.sqrt());
        let [s, rest, type_b] = [own, others, missing].map(arcsec);
        let freedom = Number::at_most(freedom, 1);
        let (words, advice) = match Part::ALL[axis / 3] {
            Part::Base => (
                texts::run_axis_scatter_of_base(s, name, rest, p, type_b.clone(), freedom),
                remarks::do_state_type_b_base(code("type_b"), type_b),
            ),
            Part::Platform => (
                texts::run_axis_scatter_of_platform(s, symbol(name.en), rest, p, type_b.clone(), freedom),
                remarks::do_state_type_b_platform(code("type_b"), type_b),
            ),
        };
        new(words).sized(own).advised(advice)
    }
}

/// Returns the name of an axis: 0, 1, 2 for x, y, z of the platform, 3, 4, 5 for east, north, up of the base.
fn axis_of_part(axis: usize) -> Text {
    let [x, y, z] = AXES.map(|name| Text { en: name, ru: name });
    [x, y, z, compass::EAST, compass::NORTH, compass::UP][axis]
}

fn without_run(run: u32) -> Words {
    remarks::do_exclude_run(code(format!("--exclude {run}")), code("--why"))
}

fn later_runs(first: u32) -> Words {
    remarks::do_certify_later_runs(first, code("--exclude"), code("--why"))
}

/// Returns an angle in arcseconds, whole or with two significant digits.
pub(super) fn arcsec(angle: f64) -> Number {
    Number::fixed(angle, decimals_of_angle(angle))
}

/// Returns rotations about three axes to one place, the second digit of the largest if it is below 10.
pub(crate) fn together(turns: [f64; 3]) -> [Number; 3] {
    let decimals = decimals_of_angle(turns.iter().fold(0.0, |largest, turn| turn.abs().max(largest)));
    turns.map(|turn| Number::fixed(turn, decimals))
}

/// Returns the decimals of an angle with two significant digits, at most hundredths of an arcsecond.
fn decimals_of_angle(arcsec: f64) -> usize {
    if arcsec == 0.0 { 0 } else { decimals(arcsec.abs()).min(2) }
}
