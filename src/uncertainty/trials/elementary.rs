//! Sine, cosine and logarithm without branches, so that the compiler can vectorise many trials. They use only sums,
//! products, quotients and bits, so the result is the same on every platform. The rest of the crate uses `libm`.

use std::f64::consts::LN_2;

/// Largest angle for [`small_sin`] and [`small_cos_less_one`], radians: about 4,100 arcseconds.
pub const SMALL_RAD: f64 = 0.02;

/// Returns sin x for |x| ≤ [`SMALL_RAD`], in radians, within 0.51 units of the last place.
///
/// The error of the series after x⁷ is at most x⁹/362880, 7.1e-20 of the result. Its first term is exact. The rest is
/// below x²/6 = 6.7e-5 of it and has a relative error below 8 · 2⁻⁵³, so it adds less than 0.001 units to the half unit
/// of the last sum.
#[inline(always)]
pub fn small_sin(x: f64) -> f64 {
    let square = x * x;
    let rest = square * (-1.0 / 6.0 + square * (1.0 / 120.0 + square * (-1.0 / 5040.0)));
    x + x * rest
}

/// Returns cos x − 1 for |x| ≤ [`SMALL_RAD`], in radians, within 2 units of the last place; 1 plus the result is cos x
/// within 0.51.
///
/// The error of the series after x⁸ is at most x¹⁰/3628800, 5.7e-21 of x²/2.
#[inline(always)]
pub fn small_cos_less_one(x: f64) -> f64 {
    let square = x * x;
    square * (-0.5 + square * (1.0 / 24.0 + square * (-1.0 / 720.0 + square * (1.0 / 40320.0))))
}

/// Returns (sin x, cos x) for 0 ≤ x ≤ π/4, in radians, within 2 units of the last place.
///
/// The errors of the series after x¹⁵ and x¹⁶ are at most 6.5e-17 and 2.9e-18 of the result.
#[inline(always)]
pub fn octant_sin_cos(x: f64) -> (f64, f64) {
    let s = x * x;
    let sin = -1.0 / 6.0
        + s * (1.0 / 120.0
            + s * (-1.0 / 5040.0
                + s * (1.0 / 362_880.0
                    + s * (-1.0 / 39_916_800.0 + s * (1.0 / 6_227_020_800.0 + s * (-1.0 / 1_307_674_368_000.0))))));
    let cos = -0.5
        + s * (1.0 / 24.0
            + s * (-1.0 / 720.0
                + s * (1.0 / 40_320.0
                    + s * (-1.0 / 3_628_800.0
                        + s * (1.0 / 479_001_600.0
                            + s * (-1.0 / 87_178_291_200.0 + s * (1.0 / 20_922_789_888_000.0)))))));
    (x + x * (s * sin), 1.0 + s * cos)
}

/// Returns ln x for normal, positive, finite x, within 4 units of the last place or 3e-16, whichever is larger.
///
/// x = 2ᵏ z with √½ ≤ z < √2, and ln z = 2 artanh((z − 1)/(z + 1)), whose argument is below 0.1716. The error of the
/// series after the 19th power is at most 2.3e-17 of the result.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    const ROOT_HALF: u64 = 0x3fe6_a09e_0000_0000;
    const TO_ONE: u64 = 0x3ff0_0000_0000_0000 - ROOT_HALF;
    const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
    // The bits of 2^52: with a small whole number k in the mantissa they are 2^52 + k.
    const WHOLE: u64 = 0x4330_0000_0000_0000;
    const WHOLE_AND_BIAS: f64 = 4_503_599_627_370_496.0 + 1023.0;
    let shifted = x.to_bits().wrapping_add(TO_ONE);
    let k = f64::from_bits((shifted >> 52) | WHOLE) - WHOLE_AND_BIAS;
    let z = f64::from_bits((shifted & MANTISSA).wrapping_add(ROOT_HALF));
    let q = (z - 1.0) / (z + 1.0);
    let s = q * q;
    let series = 1.0 / 3.0
        + s * (1.0 / 5.0
            + s * (1.0 / 7.0
                + s * (1.0 / 9.0
                    + s * (1.0 / 11.0 + s * (1.0 / 13.0 + s * (1.0 / 15.0 + s * (1.0 / 17.0 + s * (1.0 / 19.0))))))));
    k * LN_2 + 2.0 * (q + q * (s * series))
}

/// Returns (sin, cos) of π/4 · `share`, `share` in [0, 1), in the octant given by the lowest three bits of `octant`.
#[inline(always)]
pub fn on_circle(share: f64, octant: u64) -> (f64, f64) {
    let (sin, cos) = octant_sin_cos(std::f64::consts::FRAC_PI_4 * share);
    let (sin, cos) = (sin.to_bits(), cos.to_bits());
    let exchanged = (sin ^ cos) & 0_u64.wrapping_sub(octant & 1);
    let sign = |bit: u64| (octant << bit) & (1 << 63);
    (f64::from_bits(sin ^ exchanged ^ sign(62)), f64::from_bits(cos ^ exchanged ^ sign(61)))
}
