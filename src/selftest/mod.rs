//! The reference cases of the mathematics, on the user's own machine: what documents print against what is found here.
//!
//! * `gum`: the examples H.1, H.2, H.3 of the GUM, by the law of propagation and by least squares.
//! * `monte_carlo`: the examples 9.2 and 9.3 of its Supplement 1, by drawing.
//! * `regression`: NIST's Norris and Longley, by the project's least squares.
//! * `model`: the paper's model and its analytic method against 60-digit arithmetic.

pub(crate) mod gum;
pub(crate) mod model;
pub(crate) mod monte_carlo;
pub(crate) mod regression;

/// One number that a document prints, and what is found.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Which example.
    pub example: &'static str,
    /// Which quantity, with its unit.
    pub quantity: String,
    /// Document, clause, table or equation.
    pub source: &'static str,
    /// What is printed there.
    pub expected: f64,
    /// How far off it may be, in the quantity's unit.
    pub tolerance: f64,
    /// What is found.
    pub found: f64,
    /// Right digits, −log₁₀ of the relative error, for certified values.
    pub digits: Option<f64>,
}

impl Case {
    /// Whether it is within its tolerance.
    pub fn passed(&self) -> bool {
        (self.found - self.expected).abs() <= self.tolerance
    }
}

/// All cases.
pub fn run() -> Vec<Case> {
    let mut cases = gum::cases();
    cases.extend(monte_carlo::cases());
    cases.extend(regression::cases());
    cases.extend(model::cases());
    cases
}
