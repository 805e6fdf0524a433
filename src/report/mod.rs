//! What people read: verdicts, tables, words about a result.
//!
//! * [`budget`]: where the uncertainty comes from.
//! * [`verdict`]: the answer of `verify`.
//! * [`calibration`]: the result of a calibration.
//! * `certification`: a certified stand, and a check run.
//! * [`columns`]: text in columns.
//! * [`deviations`]: the certified deviations, drawn in block characters.
//! * [`mistake`]: what explains a result that is not the gyro's.
//! * [`monte_carlo`]: intervals, and whether first order is valid.
//! * `issued`: what became of an order, and what the factory should know about it.
//! * [`page`]: pages for print and screen, in several languages.
//! * [`passport_table`]: a passport in a terminal.
//! * [`picture`]: what a document says, drawn.
//! * [`register`]: what is in force in a folder.
//! * [`selftest`]: the reference cases.
//! * [`simulation`]: the tables of simulations.
//! * [`style`]: emphasis in a terminal.

pub mod budget;
pub mod calibration;
#[cfg(feature = "factory")]
pub mod certification;
pub mod columns;
pub mod deviations;
#[cfg(feature = "factory")]
pub mod issued;
pub mod mistake;
pub mod monte_carlo;
pub mod page;
pub mod passport_table;
pub mod picture;
pub mod register;
pub mod selftest;
pub mod simulation;
pub mod style;
pub mod verdict;
