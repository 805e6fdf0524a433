//! Pages for print, screen and phone: one HTML file each, without scripts and without external resources.
//!
//! * [`calibration`]: the report of a calibration.
//! * `certification`: the record of a certification.
//! * `instructions`: the first steps of a laboratory.
//! * [`language`]: the languages of a page, and texts as its elements.
//! * [`texts`]: the table of texts.
//! * [`number`]: numbers as elements, and columns of them.
//! * [`parts`]: tables, figures, forms.
//! * [`code`]: QR codes.
//! * [`spacing`]: words that no line breaks.
//! * `symbols`: symbols of quantities within texts.
//! * [`shell`]: the enclosing HTML document, its style and its running heads.
//! * [`passport`]: the printed passport.

pub(crate) mod calibration;
#[cfg(feature = "factory")]
pub(crate) mod certification;
pub(crate) mod code;
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
pub(crate) use number::Number;
pub use passport::PassportPage;
