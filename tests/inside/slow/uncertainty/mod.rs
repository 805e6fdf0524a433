//! Uncertainty against independent programs and against itself: budgets, passport accuracy, Monte Carlo.

mod budget;
mod cases;
mod coverage;
mod monte_carlo;
