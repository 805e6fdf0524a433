//! Pictures against what is known without them: directions by hand, lengths in proportion, every printed number in the file.

mod calibration;
mod drawn;
mod passport;
mod plan;
mod simulation;
