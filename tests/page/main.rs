//! Printable passports and reports of calibrations, looked at by real programs: Chromium, poppler, axe, html-validate, zbar,
//! PyYAML.
//!
//! `browser.cjs` opens every page of [`cases`] and of [`reports`] once and tells what it found; the tests ask that. What was
//! printed stays in `target/tmp/page` and `target/tmp/report` to look at, and with `SCREENS=write` the screens too. What is
//! missing fails the tests: nothing is skipped.

#![cfg(feature = "cli")]

#[path = "../shared/fixtures.rs"]
mod fixtures;
#[path = "../shared/picture/mod.rs"]
mod picture;
#[path = "../shared/programs.rs"]
mod programs;
#[path = "../shared/language.rs"]
mod words;

mod cases;
mod certified;
mod figures;
mod language;
mod pages;
mod passports;
#[cfg(unix)]
mod pdf;
mod printed;
mod refused;
mod reports;
