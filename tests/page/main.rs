//! Printable passports and reports of calibrations, looked at by real programs: Chromium, poppler, axe, html-validate, zbar,
//! PyYAML.
//!
//! `browser.cjs` opens every page of [`cases`] and of [`reports`] once and tells what it found; the tests ask that. Pictures of
//! the pages, and what was printed, stay in `target/tmp/page` and `target/tmp/report` to look at. What is missing fails the
//! tests: nothing is skipped.

#![cfg(feature = "cli")]

#[path = "../made/mod.rs"]
mod made;
#[path = "../tools/mod.rs"]
mod tools;

mod cases;
mod every;
mod language;
mod looked;
mod printed;
mod refused;
mod reports;
