//! Sentences about a mistake that explains a result, for the terminal and for pages.

use crate::calibration::diagnosis::numbering;
use crate::calibration::{CurrentsMistaken, Mistake};
use crate::wording::number::{LATITUDES, Number};
use crate::wording::spacing::{BLANK, spaced};
use crate::wording::texts::calibration as texts;
use crate::wording::{Language, Words};

/// Power of ten by which microamperes exceed milliamperes.
const MICROAMPERES: i32 = 3;

/// Returns the finding, its explanation and the remedy as whole sentences.
pub(crate) fn words(mistake: &Mistake) -> Words {
    match mistake {
        Mistake::Currents(mistaken) => {
            let each = causes(mistaken).into_iter().enumerate().flat_map(|(place, cause)| {
                let and = (place > 0).then(|| Words::All(vec![", ".into(), texts::MISTAKE_AND.into(), " ".into()]));
                and.into_iter().chain([cause])
            });
            texts::mistake_currents(each.collect::<Vec<_>>())
        }
        Mistake::OtherPlace { latitude_deg } => {
            let (degrees, hemisphere) = Number::fixed(*latitude_deg, 1).in_hemisphere(LATITUDES);
            let sign = format!("°{BLANK}");
            texts::mistake_place(vec![degrees.into(), sign.into(), hemisphere.into()])
        }
        Mistake::GyroTurned { by_deg } => texts::mistake_gyro_turned(*by_deg),
        Mistake::Rotated { by_deg } => texts::mistake_rotated(Number::significant(*by_deg, 2)),
        Mistake::Scaled { factor } => texts::mistake_currents(too_large(*factor > 1.0, factor_of(*factor))),
        Mistake::TypeScaled { factor } => match *factor > 1.0 {
            true => texts::mistake_type_too_small(factor_of(*factor)),
            false => texts::mistake_type_too_large(factor_of(*factor)),
        },
        Mistake::Renumbered { i, j } => texts::mistake_renumbered(spaced(&numbering(i, j))),
        Mistake::OtherAxis { frame_axis_azimuth_deg } => texts::mistake_other_axis(*frame_axis_azimuth_deg),
    }
}

fn too_large(is: bool, factor: Words) -> Words {
    if is { texts::mistake_too_large(factor) } else { texts::mistake_too_small(factor) }
}

/// Returns a factor or its inverse, whichever is larger, with three significant digits, and whole from 1000 on.
fn factor_of(factor: f64) -> Words {
    let factor = factor.max(1.0 / factor);
    times(if factor < 1000.0 { Number::significant(factor, 3) } else { Number::fixed(factor, 0) })
}

/// Returns a factor, in Russian with the noun that agrees with its digits.
fn times(factor: Number) -> Words {
    let digits = factor.text(Language::Russian);
    let before_last = digits.chars().rev().nth(1);
    let is_few = digits.ends_with(['2', '3', '4']) && before_last != Some('1');
    if digits.contains(',') || is_few { texts::times_few(factor) } else { texts::times(factor) }
}

fn causes(mistaken: &CurrentsMistaken) -> Vec<Words> {
    let reversed = match (mistaken.x_reversed, mistaken.y_reversed) {
        (true, true) => Some(texts::MISTAKE_REVERSED),
        (true, false) => Some(texts::MISTAKE_X_REVERSED),
        (false, true) => Some(texts::MISTAKE_Y_REVERSED),
        (false, false) => None,
    };
    let factor = || times(Number::fixed(libm::pow(10.0, f64::from(mistaken.power_of_ten.abs())), 0));
    let unit = match mistaken.power_of_ten {
        0 => None,
        MICROAMPERES => Some(texts::MISTAKE_MICROAMPERES.into()),
        power => Some(too_large(power > 0, factor())),
    };
    let exchanged = mistaken.exchanged.then(|| texts::MISTAKE_EXCHANGED.into());
    exchanged.into_iter().chain(reversed.map(Words::from)).chain(unit).collect()
}
