//! Options of a calibration.

use super::iterative::StopRule;
use super::{Method, Model};

/// Options of a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Requested methods, in the order of the results.
    pub methods: Vec<Method>,
    /// Stop rule of the iterative method.
    pub stop_rule: StopRule,
    /// Model of the g-sensitive drift that least squares fits; the paper's methods have the paper's.
    pub model: Model,
    /// `true` if least squares also fits a linear drift of ω_0 in time.
    pub drift: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { methods: Method::ALL.to_vec(), stop_rule: StopRule::default(), model: Model::Paper, drift: false }
    }
}
