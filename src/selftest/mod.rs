//! Self-test of the mathematics on the user's own computer: published numbers compared with those computed here.
//!
//! * `gum`: examples H.1, H.2, H.3 of the GUM, by the law of propagation and by least squares.
//! * `monte_carlo`: examples 9.2 and 9.3 of Supplement 1 to the GUM, by Monte Carlo.
//! * `regression`: the linear data sets of NIST, by the project's least squares.
//! * `model`: the paper's model and its analytic method, compared with 60-digit arithmetic.

pub(crate) mod gum;
pub(crate) mod model;
pub(crate) mod monte_carlo;
pub(crate) mod regression;

/// Published number and the one computed here.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Case {
    pub(crate) example: &'static str,
    /// Name of the quantity, with its unit.
    pub(crate) quantity: String,
    /// Source of the number: document, clause, table or equation.
    pub(crate) source: &'static str,
    pub(crate) expected: f64,
    /// Largest permitted difference, in the unit of the quantity.
    pub(crate) tolerance: f64,
    pub(crate) found: f64,
    /// Number of correct digits, −log₁₀ of the relative error; only for certified values.
    pub(crate) digits: Option<f64>,
}

impl Case {
    /// Creates the case of a quantity; the `numbers` are the published one, the tolerance, and the computed one.
    fn new(example: &'static str, source: &'static str, quantity: &str, numbers: [f64; 3]) -> Self {
        let ([expected, tolerance, found], quantity) = (numbers, quantity.to_owned());
        Self { example, quantity, source, expected, tolerance, found, digits: None }
    }

    /// Returns `true` if the computed value is within the tolerance.
    pub(crate) fn passed(&self) -> bool {
        (self.found - self.expected).abs() <= self.tolerance
    }
}

pub(crate) fn run() -> Vec<Case> {
    [gum::cases(), monte_carlo::cases(), regression::cases(), model::cases().to_vec()].concat()
}
