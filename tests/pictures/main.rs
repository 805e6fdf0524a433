//! Pictures against what is known without them: directions by hand, lengths in proportion, every printed number in the file.

#![cfg(feature = "cli")]

#[path = "../made/mod.rs"]
mod made;
#[path = "../tools/mod.rs"]
mod tools;

mod axis;
mod calibration;
mod drawn;
mod passport;
mod svg;
