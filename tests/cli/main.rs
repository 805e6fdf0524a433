//! The program on the command line: what is typed, what comes back, and what it leaves behind.

#![cfg(feature = "cli")]

#[path = "../shared/fixtures.rs"]
mod fixtures;
#[path = "../shared/programs.rs"]
mod programs;

mod calibrate;
mod certify;
mod dcc;
mod deliver;
mod export;
mod fleet;
mod generated;
mod history;
#[cfg(unix)]
mod hostile_words;
mod json_keys;
mod keystrokes;
mod laboratory;
#[cfg(unix)]
mod links;
mod place;
mod recertify;
mod report;
mod secrets;
mod selftest;
mod terminal;
mod transcripts;
