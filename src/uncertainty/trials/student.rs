//! Student's t from normal deviates, for inputs that depend on an estimate with few degrees of freedom (JCGM 101,
//! 6.4.9).

use crate::elementary::ln;
use crate::wide_random::{Column, WIDTH, WideRandom};

/// Largest whole number of degrees of freedom that is drawn without branches. The product of that many uniform numbers,
/// none below 2⁻⁵², is far above the smallest number of binary64.
const MOST_WITHOUT_BRANCHES: f64 = 38.0;

/// Draws ν/χ² for every trial: the variance given an estimate of 1 with ν degrees of freedom.
#[inline(always)]
pub fn variance(lanes: &mut WideRandom, factor: &mut Column, degrees_of_freedom: f64) {
    *factor = chi_square(lanes, degrees_of_freedom);
    for value in factor {
        *value = degrees_of_freedom / *value;
    }
}

/// Draws χ² with any degrees of freedom.
#[inline(always)]
pub fn chi_square(lanes: &mut WideRandom, degrees_of_freedom: f64) -> Column {
    if degrees_of_freedom <= MOST_WITHOUT_BRANCHES && degrees_of_freedom.fract() == 0.0 {
        whole(lanes, degrees_of_freedom)
    } else {
        any(lanes, degrees_of_freedom)
    }
}

/// Draws χ² with a whole number of degrees of freedom: with 2 m of them it is −2 ln of the product of m uniform
/// numbers, and one more adds the square of a normal number.
#[inline(always)]
fn whole(lanes: &mut WideRandom, degrees_of_freedom: f64) -> Column {
    let pairs = (0.5 * degrees_of_freedom) as u32;
    let mut product = [1.0; WIDTH];
    let mut uniform = [0.0; WIDTH];
    for _ in 0..pairs {
        lanes.uniform(&mut uniform);
        for trial in 0..WIDTH {
            // In (0, 1].
            product[trial] *= 0.5 - 0.5 * uniform[trial];
        }
    }
    let mut chi_square = [0.0; WIDTH];
    if f64::from(2 * pairs) < degrees_of_freedom {
        let (mut normal, mut spare) = ([0.0; WIDTH], [0.0; WIDTH]);
        lanes.normals(&mut normal, &mut spare);
        for trial in 0..WIDTH {
            chi_square[trial] = normal[trial] * normal[trial];
        }
    }
    for trial in 0..WIDTH {
        chi_square[trial] -= 2.0 * ln(product[trial]);
    }
    chi_square
}

/// Draws χ² with any degrees of freedom, by the method of
/// Marsaglia and Tsang for the gamma distribution.
#[cold]
#[inline(never)]
fn any(lanes: &mut WideRandom, degrees_of_freedom: f64) -> Column {
    let mut source = Source { lanes, normals: [[0.0; WIDTH]; 2], uniform: [0.0; WIDTH], left: [0; 2] };
    std::array::from_fn(|_| source.chi_square(degrees_of_freedom))
}

/// Source of single random numbers, taken from columns.
struct Source<'a> {
    lanes: &'a mut WideRandom,
    normals: [Column; 2],
    uniform: Column,
    /// Numbers of normal and of uniform deviates that remain.
    left: [usize; 2],
}

impl Source<'_> {
    fn normal(&mut self) -> f64 {
        if self.left[0] == 0 {
            let [one, other] = &mut self.normals;
            self.lanes.normals(one, other);
            self.left[0] = 2 * WIDTH;
        }
        self.left[0] -= 1;
        self.normals[self.left[0] / WIDTH][self.left[0] % WIDTH]
    }

    /// Returns a uniform number in (0, 1].
    fn unit(&mut self) -> f64 {
        if self.left[1] == 0 {
            self.lanes.uniform(&mut self.uniform);
            self.left[1] = WIDTH;
        }
        self.left[1] -= 1;
        0.5 - 0.5 * self.uniform[self.left[1]]
    }

    fn chi_square(&mut self, degrees_of_freedom: f64) -> f64 {
        let shape = 0.5 * degrees_of_freedom;
        // A shape below 1 is drawn as shape + 1, times a power of a uniform number.
        let small = shape < 1.0;
        let d = (if small { shape + 1.0 } else { shape }) - 1.0 / 3.0;
        let c = 1.0 / (9.0 * d).sqrt();
        loop {
            let x = self.normal();
            let base = 1.0 + c * x;
            let v = base * base * base;
            let unit = self.unit();
            if v > 0.0 && libm::log(unit) < 0.5 * x * x + d - d * v + d * libm::log(v) {
                let boost = if small { libm::pow(self.unit(), 1.0 / shape) } else { 1.0 };
                return 2.0 * d * v * boost;
            }
        }
    }
}
