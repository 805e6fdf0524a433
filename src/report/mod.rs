//! What people read: verdicts, tables, words about a result.
//!
//! * `budget`: where the uncertainty comes from.
//! * `verdict`: the answer of `verify`.
//! * `calibration`: the result of a calibration.
//! * `certification`: a certified stand, and a check run.
//! * `columns`: text in columns.
//! * `deviations`: the certified deviations, drawn in block characters.
//! * `mistake`: what explains a result that is not the gyro's.
//! * `monte_carlo`: intervals, and whether first order is valid.
//! * `issued`: what became of an order, and what the factory should know about it.
//! * `page`: pages for print and screen, in several languages.
//! * `passport_table`: a passport in a terminal.
//! * `picture`: what a document says, drawn.
//! * `register`: what is in force in a folder.
//! * `selftest`: the reference cases.
//! * `simulation`: the tables of simulations.
//! * `style`: emphasis in a terminal.

pub(crate) mod budget;
pub(crate) mod calibration;
#[cfg(feature = "factory")]
pub(crate) mod certification;
pub(crate) mod columns;
pub(crate) mod deviations;
#[cfg(feature = "factory")]
pub(crate) mod issued;
pub(crate) mod mistake;
pub(crate) mod monte_carlo;
pub(crate) mod page;
pub(crate) mod passport_table;
pub(crate) mod picture;
pub(crate) mod register;
pub(crate) mod selftest;
pub(crate) mod simulation;
pub(crate) mod style;
pub(crate) mod verdict;

pub use page::{CalibrationPage, Language, Languages, PassportPage, UsedPassport};
