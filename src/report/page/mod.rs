//! Pages for print, screen and telephone: one HTML file each, no script, nothing from outside.
//!
//! * [`calibration`]: the report of a calibration.
//! * [`language`]: the languages of a page, and a text in each of them.
//! * [`texts`]: the table of texts.
//! * [`number`]: numbers as people read them.
//! * [`parts`]: tables, figures, forms.
//! * [`code`]: codes to scan.
//! * [`shell`]: the document around them, its style and its running heads.
//! * [`passport`]: the printable passport.

pub(crate) mod calibration;
pub(crate) mod code;
pub(crate) mod language;
pub(crate) mod number;
pub(crate) mod parts;
pub(crate) mod passport;
pub(crate) mod shell;
pub(crate) mod texts;

pub use calibration::{CalibrationPage, UsedPassport};
pub use language::{Language, Languages};
pub(crate) use number::Number;
pub use passport::PassportPage;
