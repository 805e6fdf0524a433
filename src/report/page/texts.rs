//! The table of texts: what pages say, in every language, side by side. `{name}` stands for a value.

use super::language::texts;

texts! {
    PASSPORT { en: "Passport of a test stand", ru: "Паспорт испытательного стенда" }
}

/// Units. Angles are written alike in both languages.
pub mod units {
    use super::texts;

    texts! {
        ARCSEC { en: "″", ru: "″" }
        DEGREES { en: "°", ru: "°" }
        METRES { en: "m", ru: "м" }
        MILLIAMPERES { en: "mA", ru: "мА" }
        DEG_PER_H { en: "°/h", ru: "°/ч" }
        DEG_PER_H_PER_G { en: "°/h/g", ru: "°/ч/g" }
        DEG_PER_H_PER_MA { en: "°/h/mA", ru: "°/ч/мА" }
        M_PER_S2 { en: "m/s²", ru: "м/с²" }
        CELSIUS { en: "°C", ru: "°C" }
        PERCENT { en: "%", ru: "%" }
    }
}
