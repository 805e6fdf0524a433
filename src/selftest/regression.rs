//! Linear regression of [NIST StRD](crate::bibliography::Bibliography::NistStrd), by the project's least squares: data
//! sets Norris (lower difficulty) and Longley (higher). Data and certified values are those of NIST's files, digit by
//! digit.

use super::Case;
use crate::statistics::least_squares::Factorised;
use nalgebra::DMatrix;

/// Norris data: (y, x).
#[rustfmt::skip]
const NORRIS: [(f64, f64); 36] = [
    (0.1, 0.2), (338.8, 337.4), (118.1, 118.2), (888.0, 884.6), (9.2, 10.1), (228.1, 226.5), (668.5, 666.3),
    (998.5, 996.3), (449.1, 448.6), (778.9, 777.0), (559.2, 558.2), (0.3, 0.4), (0.1, 0.6), (778.1, 775.5),
    (668.8, 666.9), (339.3, 338.0), (448.9, 447.5), (10.8, 11.6), (557.7, 556.0), (228.3, 228.1), (998.0, 995.8),
    (888.8, 887.6), (119.6, 120.2), (0.3, 0.3), (0.6, 0.3), (557.6, 556.8), (339.3, 339.1), (888.0, 887.2),
    (998.5, 999.0), (778.9, 779.0), (10.2, 11.1), (117.6, 118.3), (228.9, 229.2), (668.4, 669.1), (449.2, 448.9),
    (0.2, 0.5),
];

/// Longley data: y, x₁ to x₆.
#[rustfmt::skip]
const LONGLEY: [[f64; 7]; 16] = [
    [60323.0, 83.0, 234289.0, 2356.0, 1590.0, 107608.0, 1947.0], [61122.0, 88.5, 259426.0, 2325.0, 1456.0, 108632.0, 1948.0],
    [60171.0, 88.2, 258054.0, 3682.0, 1616.0, 109773.0, 1949.0], [61187.0, 89.5, 284599.0, 3351.0, 1650.0, 110929.0, 1950.0],
    [63221.0, 96.2, 328975.0, 2099.0, 3099.0, 112075.0, 1951.0], [63639.0, 98.1, 346999.0, 1932.0, 3594.0, 113270.0, 1952.0],
    [64989.0, 99.0, 365385.0, 1870.0, 3547.0, 115094.0, 1953.0], [63761.0, 100.0, 363112.0, 3578.0, 3350.0, 116219.0, 1954.0],
    [66019.0, 101.2, 397469.0, 2904.0, 3048.0, 117388.0, 1955.0], [67857.0, 104.6, 419180.0, 2822.0, 2857.0, 118734.0, 1956.0],
    [68169.0, 108.4, 442769.0, 2936.0, 2798.0, 120445.0, 1957.0], [66513.0, 110.8, 444546.0, 4681.0, 2637.0, 121950.0, 1958.0],
    [68655.0, 112.6, 482704.0, 3813.0, 2552.0, 123366.0, 1959.0], [69564.0, 114.2, 502601.0, 3931.0, 2514.0, 125368.0, 1960.0],
    [69331.0, 115.7, 518173.0, 4806.0, 2572.0, 127852.0, 1961.0], [70551.0, 116.9, 554894.0, 4007.0, 2827.0, 130081.0, 1962.0],
];

/// Certified estimates of Norris, with their standard deviations.
const NORRIS_CERTIFIED: [(f64, f64); 2] =
    [(-0.262323073774029, 0.232818234301152), (1.00211681802045, 0.429796848199937E-03)];

/// Certified estimates of Longley, with their standard deviations.
const LONGLEY_CERTIFIED: [(f64, f64); 7] = [
    (-3482258.63459582, 890420.383607373),
    (15.0618722713733, 84.9149257747669),
    (-0.358191792925910E-01, 0.334910077722432E-01),
    (-2.02022980381683, 0.488399681651699),
    (-1.03322686717359, 0.214274163161675),
    (-0.511041056535807E-01, 0.226073200069370),
    (1829.15146461355, 455.478499142212),
];

pub(crate) fn cases() -> Vec<Case> {
    let norris_design = DMatrix::from_fn(36, 2, |row, column| if column == 0 { 1.0 } else { NORRIS[row].1 });
    let longley_design = DMatrix::from_fn(16, 7, |row, column| if column == 0 { 1.0 } else { LONGLEY[row][column] });
    let norris = Set {
        example: "NIST StRD Norris",
        source: "NIST StRD, Norris.dat",
        certified: &NORRIS_CERTIFIED,
        residual: 0.884796396144373,
        digits_due: 11.0,
    };
    let longley = Set {
        example: "NIST StRD Longley",
        source: "NIST StRD, Longley.dat",
        certified: &LONGLEY_CERTIFIED,
        residual: 304.854073561965,
        // The condition number is 4.9e9, so a stable method gives 16 − 10 digits; it usually gives more.
        digits_due: 7.0,
    };
    let mut cases = norris.cases(norris_design, DMatrix::from_fn(36, 1, |row, _| NORRIS[row].0));
    cases.extend(longley.cases(longley_design, DMatrix::from_fn(16, 1, |row, _| LONGLEY[row][0])));
    cases
}

struct Set {
    example: &'static str,
    source: &'static str,
    certified: &'static [(f64, f64)],
    /// Certified residual standard deviation.
    residual: f64,
    /// Required number of correct digits.
    digits_due: f64,
}

impl Set {
    fn cases(&self, design: DMatrix<f64>, mut right: DMatrix<f64>) -> Vec<Case> {
        let (rows, columns) = design.shape();
        let Some(model) = Factorised::new(design) else { return vec![self.case("fit", 1.0, f64::NAN)] };
        model.rotate(&mut right);
        let (estimates, _) = model.solve_rotated(&right);
        let residual = (right.rows(columns, rows - columns).norm_squared() / (rows - columns) as f64).sqrt();
        let mut cases = Vec::new();
        for (at, (estimate, deviation)) in self.certified.iter().enumerate() {
            cases.push(self.case(&format!("B{at}"), *estimate, estimates[at]));
            cases.push(self.case(&format!("s(B{at})"), *deviation, residual * model.r_inverse.row(at).norm()));
        }
        cases.push(self.case("residual standard deviation", self.residual, residual));
        cases
    }

    fn case(&self, quantity: &str, expected: f64, found: f64) -> Case {
        // Certified values have 15 digits, so no more can be compared.
        let digits = -libm::log10(((found - expected) / expected).abs());
        let digits = Some(if digits.is_nan() { 0.0 } else { digits.min(15.0) });
        let tolerance = expected.abs() * libm::pow(10.0, -self.digits_due);
        Case { digits, ..Case::new(self.example, self.source, quantity, [expected, tolerance, found]) }
    }
}
