//! Table of the texts on pages, in all languages side by side. `{name}` is a placeholder for a value.
//!
//! * [`units`], [`words`]: texts for every page.
//! * [`checks`]: the checks of a verification and their results.
//! * [`passport`]: the printed passport: content of the signed file.
//! * [`record`]: the printed passport: parts to fill in by hand.
//! * [`absences`]: inputs that a passport does not state, and the effect of each.
//! * [`calibration`]: the report of a calibration.
//! * [`certification`]: the record of a certification.
//! * [`pictures`]: words in pictures, and their descriptions.

#[cfg(test)]
use super::language::Text;
use super::language::texts;

pub(crate) mod absences;
pub(crate) mod calibration;
pub(crate) mod certification;
pub(crate) mod checks;
pub(crate) mod passport;
pub(crate) mod pictures;
pub(crate) mod record;

/// Every table with its name.
#[cfg(test)]
pub(crate) const TABLES: &[(&str, &[(&str, Text)])] = &[
    ("units", units::ALL),
    ("words", words::ALL),
    ("checks", checks::ALL),
    ("passport", passport::ALL),
    ("record", record::ALL),
    #[cfg(feature = "factory")]
    ("remarks", crate::certification::texts::ALL),
    ("compass", crate::wording::compass::ALL),
    ("implausible", crate::wording::implausible::ALL),
    ("causes", crate::calibration::causes::names::ALL),
    ("comparison", crate::wording::comparison::ALL),
    ("absences", absences::ALL),
    ("calibration", calibration::ALL),
    ("certification", certification::ALL),
    ("pictures", pictures::ALL),
];

/// Units, and the hemispheres of coordinates. Units of angles are the same in every language.
pub(crate) mod units {
    use super::texts;

    texts! {
        ARCSEC { en: "″", ru: "″" }
        DEGREES { en: "°", ru: "°" }
        METRES { en: "m", ru: "м" }
        KILOMETRES { en: "km", ru: "км" }
        G { en: "g", ru: "g" }
        MILLIAMPERES { en: "mA", ru: "мА" }
        DEG_PER_H { en: "°/h", ru: "°/ч" }
        DEG_PER_H2 { en: "°/h²", ru: "°/ч²" }
        DEG_PER_H_PER_G { en: "°/(h·g)", ru: "°/(ч·g)" }
        // Per the g of a gyro type; without a zero, per local g.
        DEG_PER_H_PER_G0 { en: "°/(h·g₀)", ru: "°/(ч·g₀)" }
        DEG_PER_H_PER_G2 { en: "°/(h·g²)", ru: "°/(ч·g²)" }
        DEG_PER_H_PER_MA { en: "°/(h·mA)", ru: "°/(ч·мА)" }
        M_PER_S2 { en: "m/s²", ru: "м/с²" }
        CELSIUS { en: "°C", ru: "°C" }
        NORTH_LATITUDE { en: "N", ru: "с. ш." }
        SOUTH_LATITUDE { en: "S", ru: "ю. ш." }
        EAST_LONGITUDE { en: "E", ru: "в. д." }
        WEST_LONGITUDE { en: "W", ru: "з. д." }
        PERCENT { en: "%", ru: "%" }
        PER_G { en: "1/g", ru: "1/g" }
        ONE { en: "1", ru: "1" }
    }
}

/// Words that occur on any page.
pub(crate) mod words {
    use super::texts;

    texts! {
        EMPTY { en: "empty field, to be filled in by hand", ru: "пустое поле, заполняется от руки" }
        NOT_STATED { en: "not stated", ru: "не указано" }
        CONTENTS { en: "Contents", ru: "Содержание" }
        FIGURE { en: "Figure", ru: "Рисунок" }
        YES { en: "yes", ru: "да" }
        NO { en: "no", ru: "нет" }
    }
}
