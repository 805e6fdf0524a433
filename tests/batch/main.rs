//! Many passports at once, by the program itself: what is named and how, what is bad and what it costs, and that nothing
//! is ever lost.

#![cfg(feature = "cli")]

#[path = "../shared/programs.rs"]
mod programs;

mod inputs;
mod kills;
mod limits;
mod registers;
mod scale;
mod successors;
mod workshop;
