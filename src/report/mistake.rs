//! Sentences about a mistake that explains a result, for the terminal and for pages.

use super::page::Number;
use super::page::language::{Language, Text, values};
use super::page::number::LATITUDES;
use super::page::spacing::BLANK;
use super::page::texts::calibration as texts;
use crate::calibration::diagnosis::numbering;
use crate::calibration::{CurrentsMistaken, Mistake};
use crate::wording::Value;
use crate::wording::spacing::spaced;

/// Power of ten by which microamperes exceed milliamperes.
const MICROAMPERES: i32 = 3;

/// Returns the finding, its explanation and the remedy as whole sentences.
pub(crate) fn words(mistake: &Mistake, language: Language) -> String {
    match mistake {
        Mistake::Currents(mistaken) => {
            let causes = causes(mistaken, language).join(&format!(", {} ", texts::MISTAKE_AND.words(language)));
            texts::MISTAKE_CURRENTS.filled(language, values! { causes })
        }
        Mistake::OtherPlace { latitude_deg } => {
            let (degrees, hemisphere) = Number::fixed(*latitude_deg, 1).in_hemisphere(LATITUDES);
            let latitude = format!("{}°{BLANK}{}", degrees.text(language), hemisphere.words(language));
            texts::MISTAKE_PLACE.filled(language, values! { latitude })
        }
        Mistake::GyroTurned { by_deg } => texts::MISTAKE_GYRO_TURNED.filled(language, &[("angle", by_deg)]),
        Mistake::Rotated { by_deg } => {
            texts::MISTAKE_ROTATED.filled(language, values! { angle: Number::significant(*by_deg, 2) })
        }
        Mistake::Scaled { factor } => {
            let text = if *factor > 1.0 { texts::MISTAKE_TOO_LARGE } else { texts::MISTAKE_TOO_SMALL };
            let factor = factor_of(*factor);
            texts::MISTAKE_CURRENTS.filled(language, values! { causes: text.filled(language, values! { factor }) })
        }
        Mistake::TypeScaled { factor } => {
            let text = if *factor > 1.0 { texts::MISTAKE_TYPE_TOO_SMALL } else { texts::MISTAKE_TYPE_TOO_LARGE };
            text.filled(language, values! { factor: factor_of(*factor) })
        }
        Mistake::Renumbered { i, j } => {
            texts::MISTAKE_RENUMBERED.filled(language, values! { numbers: spaced(&numbering(i, j)) })
        }
        Mistake::OtherAxis { frame_axis_azimuth_deg } => {
            texts::MISTAKE_OTHER_AXIS.filled(language, &[("azimuth", frame_axis_azimuth_deg)])
        }
    }
}

/// Returns a factor or its inverse, whichever is larger, with three significant digits, and whole from 1000 on.
fn factor_of(factor: f64) -> Times {
    let factor = factor.max(1.0 / factor);
    Times(if factor < 1000.0 { Number::significant(factor, 3) } else { Number::fixed(factor, 0) })
}

/// A factor, in Russian with the noun that agrees with its digits.
struct Times(Number);

impl Value for Times {
    fn said(&self, language: Language) -> String {
        let digits = self.0.text(language);
        let before_last = digits.chars().rev().nth(1);
        let is_few = digits.ends_with(['2', '3', '4']) && before_last != Some('1');
        match language {
            Language::English => digits,
            Language::Russian if digits.contains(',') || is_few => format!("{digits}{BLANK}раза"),
            Language::Russian => format!("{digits}{BLANK}раз"),
        }
    }
}

fn causes(mistaken: &CurrentsMistaken, language: Language) -> Vec<String> {
    let mut causes = Vec::new();
    let mut add = |text: Text| causes.push(text.words(language));
    if mistaken.exchanged {
        add(texts::MISTAKE_EXCHANGED);
    }
    match (mistaken.x_reversed, mistaken.y_reversed) {
        (true, true) => add(texts::MISTAKE_REVERSED),
        (true, false) => add(texts::MISTAKE_X_REVERSED),
        (false, true) => add(texts::MISTAKE_Y_REVERSED),
        (false, false) => {}
    }
    let factor = Times(Number::fixed(libm::pow(10.0, f64::from(mistaken.power_of_ten.abs())), 0));
    let too = |text: Text| text.filled(language, values! { factor });
    match mistaken.power_of_ten {
        0 => {}
        MICROAMPERES => add(texts::MISTAKE_MICROAMPERES),
        power if power > 0 => causes.push(too(texts::MISTAKE_TOO_LARGE)),
        _ => causes.push(too(texts::MISTAKE_TOO_SMALL)),
    }
    causes
}
