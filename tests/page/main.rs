//! The printable passport, looked at by real programs: Chromium, poppler, axe, html-validate, zbar, PyYAML.
//!
//! `browser.cjs` opens every page of [`cases`] once and tells what it found; the tests ask that. Pictures of the pages, and
//! what was printed, stay in `target/tmp/page` to look at. What is missing fails the tests: nothing is skipped.

#[path = "../made/mod.rs"]
mod made;
#[path = "../tools/mod.rs"]
mod tools;

mod cases;
mod language;
mod looked;
mod printed;
mod refused;
