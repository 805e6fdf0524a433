//! Straight line through points whose standard uncertainties are known, and Holm's correction for many tests.

/// Straight line y = level + slope · (x − centre), fitted with weights 1/u²:
/// [ISO/TS 28037](crate::bibliography::Bibliography::Iso28037), clause 6. Level and slope are uncorrelated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StraightLine {
    /// Weighted mean of x.
    pub centre: f64,
    pub level: f64,
    pub u_level: f64,
    pub slope: f64,
    pub u_slope: f64,
    /// Effective degrees of freedom of `u_slope`, by Welch and Satterthwaite's formula.
    pub slope_degrees_of_freedom: f64,
    /// Weighted sum of the squared residuals.
    pub chi_square: f64,
    /// Degrees of freedom of `chi_square`: the number of points less two.
    pub degrees_of_freedom: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Abscissa, known exactly.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// Standard uncertainty of `y`, positive.
    pub u: f64,
    /// Degrees of freedom of `u`; infinite if it is known exactly.
    pub degrees_of_freedom: f64,
}

impl StraightLine {
    /// Fits a line to points with independent ordinates. Returns `None` unless there are two different abscissas and all
    /// uncertainties are positive.
    pub(crate) fn fit(points: &[Point]) -> Option<Self> {
        // The spread of equal abscissas would be rounding error, not 0.
        let differ = points.iter().any(|at| at.x != points[0].x);
        if !differ || points.iter().any(|at| !(at.u > 0.0 && at.u.is_finite())) {
            return None;
        }
        let weight = |at: &Point| 1.0 / (at.u * at.u);
        let weights = points.iter().map(weight).sum::<f64>();
        let mean = |of: fn(&Point) -> f64| points.iter().map(|at| weight(at) * of(at)).sum::<f64>() / weights;
        let (centre, level) = (mean(|at| at.x), mean(|at| at.y));
        let spread = points.iter().map(|at| weight(at) * (at.x - centre) * (at.x - centre)).sum::<f64>();
        if !(spread > 0.0 && spread.is_finite()) {
            return None;
        }
        let slope = points.iter().map(|at| weight(at) * (at.x - centre) * (at.y - level)).sum::<f64>() / spread;
        let contributions: Vec<(f64, f64)> =
            points.iter().map(|at| (weight(at) * (at.x - centre) / spread * at.u, at.degrees_of_freedom)).collect();
        let residual = |at: &Point| (at.y - level - slope * (at.x - centre)) / at.u;
        Some(Self {
            centre,
            level,
            u_level: 1.0 / weights.sqrt(),
            slope,
            u_slope: 1.0 / spread.sqrt(),
            slope_degrees_of_freedom: super::student::effective_degrees_of_freedom(&contributions),
            chi_square: points.iter().map(|at| residual(at) * residual(at)).sum(),
            degrees_of_freedom: points.len().saturating_sub(2),
        })
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.level + self.slope * (x - self.centre)
    }

    /// Returns the probability that |slope| is larger by chance if there is none, by Student's distribution.
    pub(crate) fn probability(&self) -> f64 {
        super::student::student_beyond(self.slope / self.u_slope, self.slope_degrees_of_freedom)
    }
}

/// Returns `probabilities` corrected for their number by Holm's step-down procedure
/// ([Holm](crate::bibliography::Bibliography::Holm79)), which holds for dependent tests too: a corrected probability
/// below α occurs by chance in at most a share α of all such sets of tests.
pub(crate) fn holm(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|a, b| probabilities[*a].total_cmp(&probabilities[*b]));
    let (mut corrected, mut largest) = (vec![1.0; probabilities.len()], 0.0);
    for (before, at) in order.into_iter().enumerate() {
        largest = f64::max(largest, probabilities[at] * (probabilities.len() - before) as f64);
        corrected[at] = largest.min(1.0);
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(y: [f64; 6], u: [f64; 6]) -> Vec<Point> {
        let each = y.into_iter().zip(u).enumerate();
        each.map(|(k, (y, u))| Point { x: k as f64 + 1.0, y, u, degrees_of_freedom: f64::INFINITY }).collect()
    }

    /// Expected: ISO/TS 28037:2010, clause 6, the examples with equal and with unequal weights, to the printed digits.
    #[test]
    fn the_examples_of_iso_28037() {
        let equal = points([3.3, 5.6, 7.1, 9.3, 10.7, 12.1], [0.5; 6]);
        let unequal = points([3.2, 4.3, 7.6, 8.6, 11.7, 12.8], [0.5, 0.5, 0.5, 1.0, 1.0, 1.0]);
        for (points, [a, b, u_a, u_b, covariance, chi_square]) in [
            (equal, [1.867, 1.757, 0.465, 0.120, -0.050, 1.665]),
            (unequal, [0.885, 2.057, 0.530, 0.178, -0.082, 4.131]),
        ] {
            let line = StraightLine::fit(&points).unwrap();
            let u_intercept = libm::hypot(line.u_level, line.centre * line.u_slope);
            let found = [
                line.at(0.0),
                line.slope,
                u_intercept,
                line.u_slope,
                -line.centre * line.u_slope * line.u_slope,
                line.chi_square,
            ];
            for (found, due) in found.into_iter().zip([a, b, u_a, u_b, covariance, chi_square]) {
                assert!((found - due).abs() <= 0.0005 + 1e-9, "{found} {due}");
            }
            assert_eq!(line.degrees_of_freedom, 4);
        }
    }

    /// Expected: SciPy 1.17, `2*scipy.stats.t.sf(abs(d)/u, nu)` with ν of Welch and Satterthwaite by hand: two points of
    /// u = 1 and u = 2 at a distance of 3, ν = 8 and 12: u(d) = √5, ν = 25/(1/8 + 16/12) = 17.142857.
    #[test]
    fn two_points_are_compared_as_a_difference() {
        let at = |x: f64, y: f64, u: f64, degrees_of_freedom: f64| Point { x, y, u, degrees_of_freedom };
        let line = StraightLine::fit(&[at(0.0, 1.0, 1.0, 8.0), at(3.0, 7.0, 2.0, 12.0)]).unwrap();
        assert!((line.slope - 2.0).abs() < 1e-14 && (line.u_slope - 5.0_f64.sqrt() / 3.0).abs() < 1e-14);
        assert!((line.slope_degrees_of_freedom - 17.142_857_142_857_142).abs() < 1e-10);
        assert!((line.probability() - 0.01563323444628666).abs() < 1e-12, "{}", line.probability());
        assert!(line.degrees_of_freedom == 0 && line.chi_square < 1e-20);
        assert_eq!(StraightLine::fit(&[at(1.0, 1.0, 1.0, 8.0), at(1.0, 2.0, 1.0, 8.0)]), None);
        assert_eq!(StraightLine::fit(&[at(1.0, 1.0, 0.0, 8.0), at(2.0, 2.0, 1.0, 8.0)]), None);
    }

    /// Expected: R 4, `p.adjust(c(.042, .001, .031, .014, .007), "holm")`, by its definition pmin(1, cummax((n − i + 1) p)).
    #[test]
    fn holm_corrects_as_r_does() {
        let found = holm(&[0.042, 0.001, 0.031, 0.014, 0.007]);
        for (found, due) in found.into_iter().zip([0.062, 0.005, 0.062, 0.042, 0.028]) {
            assert!((found - due).abs() < 1e-15, "{found} {due}");
        }
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }
}
