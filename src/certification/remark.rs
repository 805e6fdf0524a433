//! Remarks: sentences in each language, with what to do; those for the signatory of a certificate.

use super::components::Components;
use super::found::{Found, arcsec};
use super::{AngleReadings, ENOUGH_RUNS};
use crate::calibration::recorded::rounding_of;
use crate::stand::remarks::Odd;
use crate::stand::{self, CertifiedPosition, Stand};
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use crate::wording::words::code;
use crate::wording::{Language, Words, plain};
use jiff::civil::Date;
use std::fmt::{Display, Formatter};

/// Standard deviation of a visit, arcsec, below which the readings may be in arcminutes: two-axis stands repeat to about an
/// arcsecond, and an autocollimator itself to a few hundredths.
const LEAST_SCATTER_ARCSEC: f64 = 0.1;

/// Remark on readings, on the certificate made of them, or on what a comparison has found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Remark {
    /// Sentences.
    pub words: Words,
    /// What to do at a terminal, with the keys and options of files and commands.
    advice: Option<Words>,
}

/// The English sentences without the last full stop, with advice: the wording of terminals and of comments in a stand file.
impl Display for Remark {
    fn fmt(&self, to: &mut Formatter<'_>) -> std::fmt::Result {
        to.write_str(&in_english(&self.advised()))
    }
}

impl<T: Into<Words>> From<T> for Remark {
    fn from(words: T) -> Self {
        Self { words: words.into(), advice: None }
    }
}

impl Remark {
    pub(super) fn advising(words: impl Into<Words>, advice: impl Into<Words>) -> Self {
        Self { words: words.into(), advice: Some(advice.into()) }
    }

    pub(super) fn of(found: &Found) -> Self {
        Self { words: found.words.clone(), advice: found.advice.clone() }
    }

    /// Returns the remark that a certificate does not expire as the last one did.
    pub(crate) fn no_expiry(until: Date) -> Self {
        Self::advising(texts::no_expiry(until), texts::do_expiry(code("--valid-until")))
    }

    /// Returns the remark and what to do, as a terminal says it.
    pub(crate) fn advised(&self) -> Words {
        let advice = self.advice.iter().flat_map(|advice| [" ".into(), advice.clone()]);
        Words::All([self.words.clone()].into_iter().chain(advice).collect())
    }
}

/// Returns the remarks on readings, with what was found in them, and on the certified `stand`.
pub(super) fn remarks(
    findings: &[Found],
    components: &Components,
    readings: &AngleReadings,
    stand: &Stand,
) -> Vec<Remark> {
    let mut remarks: Vec<Remark> = findings.iter().map(Remark::of).collect();
    let runs = readings.runs.len();
    if runs < ENOUGH_RUNS {
        let freedom = 3 * (runs - 1);
        // Relative standard uncertainty of a standard deviation, about 1/√(2ν): GUM (JCGM 100), E.4.3.
        let doubt = Number::fixed(100.0 / (2.0 * freedom as f64).sqrt(), 0);
        remarks.push(texts::few_runs(runs, freedom, doubt).into());
    }
    match components.base_axes {
        0 => remarks.push(Remark::advising(texts::BASE_NOT_SEEN, texts::do_without_base(code("common_base_arcsec")))),
        axes @ 1..3 => remarks.push(texts::base_in_part(axes).into()),
        _ => {}
    }
    let angles = stand.positions.iter().flat_map(CertifiedPosition::angles_arcsec);
    let largest_arcsec = angles.fold(0.0, |a, b| f64::max(a, b.abs()));
    let scatter_arcsec = components.pooled_arcsec2.value.sqrt();
    if largest_arcsec < 0.5 {
        remarks.push(texts::small_angles(hundredths_above(largest_arcsec)).into());
    } else if scatter_arcsec < LEAST_SCATTER_ARCSEC && readings.step_arcsec < LEAST_SCATTER_ARCSEC {
        // Readings in coarser steps do not show their scatter.
        remarks.push(texts::little_scatter(hundredths_above(scatter_arcsec)).into());
    }
    let places = 0..stand.positions.len();
    let each = places.flat_map(|place| [0, 1, 2].map(|angle| readings.rounding_arcsec(place, angle)));
    let on_one_step = each.filter(|u| *u > 0.0).count();
    if on_one_step > 0 {
        let (step, u) = (Number::exact(readings.step_arcsec), arcsec(rounding_of(readings.step_arcsec)));
        let words = texts::rounding(on_one_step, 3 * stand.positions.len(), step, u);
        remarks.push(Remark::advising(words, texts::DO_DIGITS));
    }
    if stand.certificate.performed.is_none() {
        let advice = texts::do_date(code("performed"), code("--performed"), code("`recertify`"));
        remarks.push(Remark::advising(texts::NOT_DATED, advice));
    }
    let of_library = |odd: Odd| Words::OfLibrary(format!("{}.", odd.sentence), Box::new(odd.words)).into();
    remarks.extend(stand::remarks::of(&stand.certificate, &stand.positions).into_iter().map(of_library));
    remarks
}

/// Returns sentences in English without the last full stop.
pub(super) fn in_english(words: &Words) -> String {
    plain(&words.plain(Language::English)).trim_end_matches('.').to_owned()
}

/// Returns a small angle, rounded up to hundredths of an arcsecond.
fn hundredths_above(arcsec: f64) -> Number {
    Number::fixed((arcsec * 100.0).ceil() / 100.0, 2)
}
