//! Effective degrees of freedom of a sum of independent contributions.
//!
//! Source: [GUM](crate::bibliography::Bibliography::Gum), eq. (G.2b).

/// Returns the effective degrees of freedom of a sum of independent contributions, each (standard uncertainty, degrees
/// of freedom), by Welch and Satterthwaite's formula; infinite if all of them are known exactly.
pub(crate) fn effective_degrees_of_freedom(contributions: &[(f64, f64)]) -> f64 {
    let variance: f64 = contributions.iter().map(|(u, _)| u * u).sum();
    let doubt: f64 = contributions.iter().map(|(u, nu)| u * u * u * u / nu).sum();
    if doubt > 0.0 { variance * variance / doubt } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equal contributions with equal degrees of freedom add them up; one that is exact adds none of its own.
    #[test]
    fn degrees_of_freedom_add() {
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, 4.0)]) - 8.0).abs() < 1e-15);
        assert!((effective_degrees_of_freedom(&[(1.0, 4.0), (1.0, f64::INFINITY)]) - 16.0).abs() < 1e-15);
        assert_eq!(effective_degrees_of_freedom(&[(1.0, f64::INFINITY)]), f64::INFINITY);
    }
}
