//! Output for people: verdicts, tables, sentences about a result, pages and pictures.
//!
//! * `verdict`: the answer of `verify`.
//! * `calibration`: the report of a calibration.
//! * `certification`: a certified stand, and a check run.
//! * `columns`: text in columns.
//! * `deviations`: the certified deviations, drawn in block characters.
//! * `difference`: differences of two passports.
//! * `doc`: a document before it has a medium or a language, and its two renderers.
//! * `exported`: a verified passport as JSON, with what its verification found.
//! * `gyros`: the results of several gyros on one stand.
//! * `history`: one stand over the years.
//! * `issued`: the outcomes of the orders of a batch.
//! * `page`: pages for print and screen, in several languages.
//! * `passport`: a passport.
//! * `plan`: the best positions, and what they cannot see.
//! * `picture`: the contents of a document as pictures.
//! * `recertification`: a new certificate of a stand, and the successors of its passports.
//! * `recorded`: what the digits of the currents show.
//! * `register`: the passports in a folder and their states.
//! * `selftest`: the reference cases.
//! * `simulation`: the tables of simulations.
//! * `style`: emphasis in a terminal.
//! * `uncertainty`: the uncertainty budget; coverage intervals, and the test of linear propagation.

pub(crate) mod calibration;
#[cfg(feature = "factory")]
pub(crate) mod certification;
pub(crate) mod columns;
pub(crate) mod deviations;
pub(crate) mod difference;
pub(crate) mod doc;
pub(crate) mod exported;
pub(crate) mod gyros;
#[cfg(feature = "factory")]
pub(crate) mod history;
#[cfg(feature = "factory")]
pub(crate) mod issued;
pub(crate) mod page;
pub(crate) mod passport;
pub(crate) mod picture;
#[cfg(feature = "factory")]
pub(crate) mod plan;
#[cfg(feature = "factory")]
pub(crate) mod recertification;
pub(crate) mod recorded;
#[cfg(feature = "factory")]
pub(crate) mod register;
pub(crate) mod selftest;
pub(crate) mod simulation;
pub(crate) mod style;
pub(crate) mod uncertainty;
pub(crate) mod verdict;

pub use page::{CalibrationPage, Language, Languages, PassportPage, UsedPassport};
