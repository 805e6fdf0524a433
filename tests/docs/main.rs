//! What is shipped beside the program is true: the documentation, the example passports and sites, the self-check.

#![cfg(feature = "cli")]

#[path = "../shared/fixtures.rs"]
mod fixtures;
#[path = "../shared/programs.rs"]
mod programs;

mod compatibility;
mod documentation;
mod examples;
mod recipes;
mod self_check;
mod worksheet;
