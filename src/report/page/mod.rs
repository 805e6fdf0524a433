//! Pages for print, screen and phone: one HTML file each, without scripts and without external resources.
//!
//! * [`calibration`]: the report of a calibration.
//! * `certification`: the record of a certification.
//! * `instructions`: the first steps of a laboratory.
//! * [`language`]: the languages of a page.
//! * [`number`]: numbers as elements.
//! * [`parts`]: quantities, figures, forms, QR codes.
//! * [`spacing`]: words that no line breaks.
//! * `symbols`: symbols of quantities within texts.
//! * [`shell`]: what every page has: the enclosing HTML document, style, running heads, contents, sections, annex.
//! * [`passport`]: the printed passport.

pub(crate) mod calibration;
#[cfg(feature = "factory")]
pub(crate) mod certification;
#[cfg(feature = "cli")]
pub(crate) mod instructions;
pub(crate) mod language;
pub(crate) mod number;
pub(crate) mod parts;
pub(crate) mod passport;
pub(crate) mod shell;
pub(crate) mod spacing;
pub(crate) mod symbols;

pub use calibration::{CalibrationPage, UsedPassport};
pub use language::{Language, Languages};
pub use passport::PassportPage;
