//! Remarks for the signatory of a certificate: values, and their words in each language.

use super::found::{Found, arcsec};
use crate::attitude::ANGLE_SYMBOLS;
use crate::calibration::recorded::rounding_of;
use crate::stand::remarks::Odd;
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use crate::wording::words::{code, symbol};
use crate::wording::{Language, Words, plain};
use jiff::civil::Date;
use std::fmt::{Display, Formatter};

/// A remark on readings or on the certificate made of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Remark {
    Found(Box<Found>),
    FewRuns {
        runs: usize,
        degrees_of_freedom: usize,
    },
    /// Number of axes of the base, 0 to 2, about which a rotation can be distinguished from one of the platform.
    BaseAxes(usize),
    /// Number of angles whose readings stay on one step, of how many, and the step, arcsec.
    Rounding {
        angles: usize,
        of: usize,
        step_arcsec: f64,
    },
    /// Largest angle, arcsec.
    SmallAngles(f64),
    /// Standard deviation of a visit that no stand has, arcsec.
    LittleScatter(f64),
    /// No day of the measurement.
    NotDated,
    /// Expiry date of the last certificate, if this one has none.
    NoExpiry(Date),
    Odd(Odd),
}

/// The English sentences without the last full stop, with advice: the wording of terminals and of comments in a stand file.
impl Display for Remark {
    fn fmt(&self, to: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Odd(odd) => odd.fmt(to),
            _ => to.write_str(&in_english(&self.advised())),
        }
    }
}

impl Remark {
    /// Returns the relative standard uncertainty, in percent, of a standard deviation with `degrees_of_freedom`.
    ///
    /// GUM ([JCGM 100](crate::bibliography::Bibliography::Gum)), E.4.3: about 1/√(2ν).
    pub(crate) fn doubt_percent(degrees_of_freedom: usize) -> f64 {
        100.0 / (2.0 * degrees_of_freedom as f64).sqrt()
    }

    /// Returns the remark as sentences.
    pub(crate) fn words(&self) -> Words {
        let (fixed, exact) = (Number::fixed, Number::exact);
        match self {
            Self::Found(found) => found.words.clone(),
            Self::FewRuns { runs, degrees_of_freedom: freedom } => {
                let doubt = fixed(Self::doubt_percent(*freedom), 0);
                texts::few_runs(*runs, *freedom, doubt)
            }
            Self::BaseAxes(0) => texts::BASE_NOT_SEEN.into(),
            Self::BaseAxes(axes) => texts::base_in_part(*axes),
            Self::Rounding { angles, of, step_arcsec } => {
                let (step, u) = (exact(*step_arcsec), arcsec(rounding_of(*step_arcsec)));
                texts::rounding(*angles, *of, step, u)
            }
            Self::SmallAngles(largest) => texts::small_angles(hundredths_above(*largest)),
            Self::LittleScatter(scatter) => texts::little_scatter(hundredths_above(*scatter)),
            Self::Odd(Odd::FarAngle { angle, index, arcsec, usual_arcsec }) => {
                let (angle, value, usual) = (symbol(ANGLE_SYMBOLS[*angle]), fixed(*arcsec, 0), fixed(*usual_arcsec, 0));
                texts::far_angle(angle, *index, value, usual)
            }
            Self::NotDated => texts::NOT_DATED.into(),
            Self::NoExpiry(until) => texts::no_expiry(*until),
            Self::Odd(Odd::Temperature { celsius, .. }) => texts::temperature(exact(*celsius)),
            Self::Odd(Odd::OldMeasurement { performed, issued }) => texts::old_measurement(*performed, *issued),
            Self::Odd(Odd::LongValidity { valid_until, issued }) => texts::long_validity(*issued, *valid_until),
            Self::Odd(Odd::OutsideRange { celsius, range: [low, high] }) => {
                texts::outside_range(exact(*celsius), exact(*low), exact(*high))
            }
        }
    }

    /// Returns what to do at a terminal, with the keys and options of files and commands.
    fn advice(&self) -> Option<Words> {
        Some(match self {
            Self::Found(found) => return found.advice.clone(),
            Self::BaseAxes(0) => texts::do_without_base(code("common_base_arcsec")),
            Self::NotDated => texts::do_date(code("performed"), code("--performed"), code("`recertify`")),
            Self::NoExpiry(_) => texts::do_expiry(code("--valid-until")),
            Self::Rounding { .. } => texts::DO_DIGITS.into(),
            _ => return None,
        })
    }

    /// Returns the remark and what to do, as a terminal says it; an implausible value with its key in English.
    pub(crate) fn advised(&self) -> Words {
        let advised = advised(self.words(), self.advice());
        if let Self::Odd(_) = self { Words::OfLibrary(format!("{self}."), Box::new(advised)) } else { advised }
    }
}

/// Returns sentences and what to do.
pub(super) fn advised(words: Words, advice: Option<Words>) -> Words {
    let advice = advice.into_iter().flat_map(|advice| [" ".into(), advice]);
    Words::All([words].into_iter().chain(advice).collect())
}

/// Returns sentences in English without the last full stop.
pub(super) fn in_english(words: &Words) -> String {
    plain(&words.plain(Language::English)).trim_end_matches('.').to_owned()
}

/// Returns a small angle, rounded up to hundredths of an arcsecond.
fn hundredths_above(arcsec: f64) -> Number {
    Number::fixed((arcsec * 100.0).ceil() / 100.0, 2)
}
