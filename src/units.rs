//! Conversion of angles and rates, in one module. Internal units are radians for angles and degrees per hour for rates.

use std::f64::consts::PI;

pub(crate) const SECONDS_PER_HOUR: f64 = 3600.0;

pub(crate) const ARCSECONDS_PER_DEGREE: f64 = 3600.0;

pub(crate) const ARCSECONDS_PER_RADIAN: f64 = 648_000.0 / PI;

pub(crate) fn radians_from_arcseconds(arcseconds: f64) -> f64 {
    arcseconds * (PI / 648_000.0)
}

pub(crate) fn arcseconds_from_radians(radians: f64) -> f64 {
    radians * ARCSECONDS_PER_RADIAN
}

pub(crate) fn radians_from_degrees(degrees: f64) -> f64 {
    degrees * (PI / 180.0)
}

pub(crate) fn degrees_from_radians(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

pub(crate) fn degrees_per_hour_from_radians_per_second(rate: f64) -> f64 {
    // The product of the constants is one factor, so the rate is rounded once.
    rate * (SECONDS_PER_HOUR * 180.0 / PI)
}

/// Returns the sine and cosine of an angle in degrees; at whole quadrants they are exactly 0 and ±1.
///
/// The angle is reduced by whole quadrants, without rounding, before conversion to radians. Therefore `cos 90° = 0`,
/// whereas the cosine of the nearest binary64 to π/2 is 6e-17.
pub(crate) fn sin_cos_of_degrees(degrees: f64) -> (f64, f64) {
    let (rest, quadrant) = libm::remquo(degrees, 90.0);
    let (sin, cos) = libm::sincos(radians_from_degrees(rest));
    let (sin, cos) = match quadrant.rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    };
    // Adding zero converts -0.0 to 0.0.
    (sin + 0.0, cos + 0.0)
}

/// Returns a unit in its printed form: `°`, powers raised, one solidus, with brackets around a compound denominator (SI
/// Brochure, 5.1).
/// Keys of files and `unit` values in JSON do not change.
pub(crate) fn printed(unit: &str) -> String {
    let unit = unit.replace("deg/", "°/").replace("^2", "²");
    match unit.split_once('/') {
        Some((above, below)) if below.contains('/') => format!("{above}/({})", below.replace('/', "·")),
        _ => unit,
    }
}

/// Returns a value with its unit in printed form; a space separates them, but not before ″ (SI Brochure, 5.4.3).
pub(crate) fn quantity(value: &str, unit: &str) -> String {
    match unit {
        "arcsec" => format!("{value}″"),
        unit => format!("{value} {}", printed(unit)),
    }
}

/// Returns a distance for people: in metres, from 10 km on in kilometres with three digits or more.
pub(crate) fn distance(metres: f64) -> String {
    let km = metres / 1000.0;
    match km {
        ..9.9995 => format!("{metres:.0} m"),
        ..99.95 => format!("{km:.1} km"),
        _ => format!("{km:.0} km"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: SI Brochure, 5.4.3: a space before every unit but °, ′ and ″.
    #[test]
    fn no_space_is_before_arcseconds() {
        assert_eq!(quantity("1.5", "arcsec"), "1.5″");
        assert_eq!(quantity("0.3", "deg/h/g"), "0.3 °/(h·g)");
    }

    #[test]
    fn a_distance_is_in_metres_or_kilometres() {
        let cases = [(44.4, "44 m"), (9_999.4, "9999 m"), (9_999.6, "10.0 km"), (99_949.0, "99.9 km")];
        for (metres, due) in cases.into_iter().chain([(99_951.0, "100 km"), (585_421.0, "585 km")]) {
            assert_eq!(distance(metres), due);
        }
    }

    #[test]
    fn a_printed_unit_has_one_solidus() {
        let cases = [("%", "%"), ("deg/h", "°/h"), ("deg/h/mA", "°/(h·mA)"), ("deg/h/g^2", "°/(h·g²)")];
        for (unit, due) in cases {
            assert_eq!(printed(unit), due);
        }
    }

    #[test]
    fn whole_quadrants_are_exact() {
        let cases = [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (270.0, -1.0, 0.0), (360.0, 0.0, 1.0)];
        for (degrees, sin, cos) in cases {
            for turn in [-720.0, -360.0, 0.0, 360.0] {
                let found = sin_cos_of_degrees(degrees + turn);
                assert_eq!(found, (sin, cos), "{degrees} + {turn}");
                assert!(found.0.is_sign_positive() || sin < 0.0);
            }
        }
    }

    /// Expected values: sin 30° = 1/2, cos 60° = 1/2, tan 45° = 1.
    #[test]
    fn other_angles_keep_their_digits() {
        assert!((sin_cos_of_degrees(30.0).0 - 0.5).abs() < 1e-16);
        assert!((sin_cos_of_degrees(-60.0).1 - 0.5).abs() < 2e-16);
        let (sin, cos) = sin_cos_of_degrees(225.0);
        assert!((sin / cos - 1.0).abs() < 2e-16 && sin < 0.0);
    }
}
