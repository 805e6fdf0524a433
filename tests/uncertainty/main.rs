//! Uncertainty against independent programs and against itself: budgets, passport accuracy, Monte Carlo.

#![cfg(feature = "cli")]

#[path = "../support/mod.rs"]
mod support;
#[path = "../tools/mod.rs"]
mod tools;

mod accuracy;
mod budget;
mod cases;
mod coverage;
mod monte_carlo;
