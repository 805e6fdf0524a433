//! Many passports at once, by the program itself: what is named and how, what is bad and what it costs, and that nothing
//! is ever lost.

#![cfg(feature = "cli")]

#[path = "../tools/mod.rs"]
mod tools;

mod inputs;
mod kills;
mod limits;
mod scale;
mod successors;
mod workshop;
