//! Pictures against what is known without them: directions by hand, lengths in proportion, every printed number in the file.

#[path = "../made/mod.rs"]
mod made;

mod calibration;
mod passport;
mod svg;
