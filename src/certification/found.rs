//! Findings: what is wrong with a measurement or has changed, where, by how much, and with which probability; their words.
//!
//! One type carries a finding from the search to the words, which are made from its kind, and to JSON.

use super::AngleReadings;
use super::header::NominalPosition;
use super::hypothesis::{Accepted, Cause, Explanation};
use super::kind::{AXES, Kind, OUTLIER, Part, Setting};
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
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<u32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<&'static str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_run: Option<u32>,
    /// Indices (i, j) of two positions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between: Option<[[u32; 2]; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub setting: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub theta_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phi_deg: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
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
        if let (None, Some(entries)) = (self.unit, json.as_object_mut()) {
            entries.remove("unit");
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

    fn found(&self, at: &Accepted) -> Found {
        let runs = &self.readings.runs;
        let index = |place: usize| self.positions[place].index();
        let turns = self.turns_arcsec(at);
        let ([x, y, z], length) = (together(turns), Vector3::from(turns).norm());
        let (p, of_visits) = (Probability(at.probability), self.explanation.components.pooled_arcsec2.value.sqrt());
        let new = |scope: Scope, words: Words| Found {
            turns_arcsec: turns,
            ..Found::new(at.cause.kind(), scope, at.probability, words).sized(length)
        };
        let of_part = |part: Part| Scope { part: Some(part.key()), ..Scope::default() };
        let of_position = |place: usize| Scope { position: Some(index(place)), ..Scope::default() };
        // Of two runs, either may be wrong.
        let in_run = |run: usize, scope: Scope| match runs[..] {
            [one, other] => Scope { runs: vec![one, other], ..scope },
            _ => Scope { run: Some(runs[run]), ..scope },
        };
        let line = |place, run| -> Words {
            match self.readings.line(place, run) {
                Some(line) if runs.len() > 2 => vec![" ".into(), texts::line(line)].into(),
                _ => "".into(),
            }
        };
        match at.cause {
            Cause::Angle { place, run, angle } => {
                let size = at.sizes_arcsec[0];
                let scope = in_run(run, Scope { angle: Some(ANGLES[angle]), ..of_position(place) });
                let name = symbol(ANGLE_SYMBOLS[angle]);
                let words = texts::angle(name, index(place), runs[run], line(place, run), arcsec(size), p);
                self.repeated(new(scope, words).sized(size), place, run)
            }
            Cause::Reading { place, run } => {
                let words = texts::reading(index(place), runs[run], line(place, run), x, y, z, p);
                self.repeated(new(in_run(run, of_position(place)), words), place, run)
            }
            Cause::Bump { run, before, after, part } => {
                let between = [index(before), index(after)].map(|at| [at.i, at.j]);
                let scope = Scope { run: Some(runs[run]), between: Some(between), ..of_part(part) };
                new(scope, texts::bump(runs[run], index(after), x, y, z, part.axes(), index(before), p))
                    .advised(without_run(runs[run]))
            }
            Cause::Run { run, part } => {
                let mean = arcsec(length / runs.len() as f64);
                let scope = Scope { run: Some(runs[run]), ..of_part(part) };
                new(scope, texts::run_turned(runs[run], x, y, z, part.axes(), p, mean)).advised(without_run(runs[run]))
            }
            Cause::Move { after, part } => {
                let (last, next) = (runs[after - 1], runs[after]);
                let scope = Scope { after_run: Some(last), ..of_part(part) };
                new(scope, texts::stand_moved(last, next, x, y, z, part.axes(), p)).advised(later_runs(next))
            }
            Cause::Drift { part } => {
                new(of_part(part), texts::stand_drift(x, y, z, part.axes(), p)).advised(remarks::DO_FIND_AND_MEASURE)
            }
            Cause::MovedPosition { place, after } => {
                let (last, next) = (runs[after - 1], runs[after]);
                let scope = Scope { after_run: Some(last), ..of_position(place) };
                new(scope, texts::position_moved(index(place), last, next, x, y, z, p)).advised(later_runs(next))
            }
            Cause::Position(place) => {
                let s = self.scatter_arcsec(&[place]);
                let words = texts::position_scatter(index(place), arcsec(s), arcsec(of_visits), p);
                new(of_position(place), words).sized(s)
            }
            Cause::Positions(setting, angle_deg) => {
                let places = (0..self.positions.len()).filter(|at| setting.of(&self.positions[*at]) == angle_deg);
                let s = self.scatter_arcsec(&places.collect::<Vec<_>>());
                let angle = Number::exact(angle_deg);
                let words = texts::setting_scatter(symbol(setting.symbol()), angle, arcsec(s), arcsec(of_visits), p);
                new(Scope::of_setting(setting, angle_deg), words).sized(s).advised(remarks::DO_FIND)
            }
            Cause::Shared(setting) => {
                let s = at.sizes_arcsec[0];
                let scope = Scope { setting: Some(setting.key()), ..Scope::default() };
                new(scope, texts::shared_setting(symbol(setting.symbol()), arcsec(s), p))
                    .sized(s)
                    .advised(remarks::DO_MEASURE)
            }
            Cause::Axis(axis) => {
                let s = self.explanation.components.own_arcsec2[axis].value.sqrt();
                let scope = Scope { axis: Some(AXES[axis]), ..Scope::default() };
                new(scope, texts::axis_scatter(symbol(AXES[axis]), arcsec(s), arcsec(of_visits), p)).sized(s)
            }
            Cause::RunAxis(axis) => self.run_axis(axis, p, &new),
            Cause::Copied(one, other) => {
                let scope = Scope { runs: vec![runs[one], runs[other]], ..Scope::default() };
                Found { size: None, unit: None, ..new(scope, texts::runs_copied(runs[one], runs[other], p)) }
            }
        }
    }

    /// Returns a finding on one reading, with what to do.
    fn repeated(&self, found: Found, place: usize, run: usize) -> Found {
        let (PositionIndex { i, j }, run) = (self.positions[place].index(), self.readings.runs[run]);
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
        let turns = match at.cause {
            Cause::Bump { part: Part::Base, .. }
            | Cause::Run { part: Part::Base, .. }
            | Cause::Move { part: Part::Base, .. }
            | Cause::Drift { part: Part::Base } => &self.explanation.components.model.base_axes * &at.sizes_arcsec,
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

    fn run_axis(&self, axis: usize, p: Probability, new: &dyn Fn(Scope, Words) -> Found) -> Found {
        let runs = self.readings.runs.len() as f64;
        let variation = self.explanation.components.variation(&self.explanation.of_runs, axis);
        let freedom = self.explanation.of_runs[axis][1];
        // The variance of a single axis has few degrees of freedom, and those of the common parts are not in the file.
        let widened = student_factor(0.05, freedom) / student_factor(0.05, f64::INFINITY);
        let missing = ((variation.own_arcsec2 * widened * widened - variation.between_arcsec2).max(0.0) / runs).sqrt();
        let part = Part::ALL[axis / 3];
        let [x, y, z] = AXES.map(|name| Text { en: name, ru: name });
        let name = [x, y, z, compass::EAST, compass::NORTH, compass::UP][axis];
        let (own, others) = (variation.own_arcsec2.sqrt(), variation.others_arcsec2.sqrt());
        let [s, rest, type_b] = [own, others, missing].map(arcsec);
        let freedom = Number::at_most(freedom, 1);
        let words = match part {
            Part::Base => texts::run_axis_scatter_of_base(s, name, rest, p, type_b, freedom),
            Part::Platform => texts::run_axis_scatter_of_platform(s, symbol(name.en), rest, p, type_b, freedom),
        };
        let state = match part {
            Part::Base => remarks::do_state_type_b_base,
            Part::Platform => remarks::do_state_type_b_platform,
        };
        new(Scope { part: Some(part.key()), axis: Some(name.en), ..Scope::default() }, words)
            .sized(own)
            .advised(state(code("type_b"), arcsec(missing)))
    }
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
