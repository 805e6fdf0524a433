//! Advice on what a person or a program wrote where a number belongs, and on unknown names that are known ones in letters of
//! another alphabet, or in another unit.

use super::placeholder::{self, is_placeholder};
use super::scalar::{STRAIGHT_QUOTES, latin, typographic_quote};
use super::{Node, Path};

const NOT_FINITE: &str = "use a finite number, because NaN and infinity are not measured values";

const WITHOUT_QUOTES: &str = "write the number without quotes";

const ASCII: &str = "use ASCII digits, a decimal point and an ASCII minus";

/// Advice for a tolerance that is written as two limits, or with ±.
const TOLERANCE: &str = "a tolerance is one number for both directions and both axes: state half the width of the interval, and \
                         its middle as the nominal value";

/// Advice for an angle in degrees, minutes and seconds where the unit is the arcsecond.
const ARCSECONDS: &str = "write degrees, minutes and seconds of arc as one number of arcseconds";

/// Returns what to do about a value of YAML that is not a number; empty without such advice.
pub(super) fn on_yaml(node: &Node, at: &Path) -> &'static str {
    let key = at.last_key();
    let is_tolerance = matches!(at, Path::Key(parent, _) if parent.last_key() == "tolerance");
    match node {
        Node::List(_) | Node::Map(_) if is_tolerance => TOLERANCE,
        Node::Text(text) if is_tolerance && text.contains(['±', '/']) => TOLERANCE,
        Node::Text(text) if has_two_points(text) && key.ends_with("_deg") => {
            "it has two points; write degrees, minutes and seconds as decimal degrees, with one point"
        }
        Node::Text(text) if has_two_points(text) => "it has two points; use one decimal point",
        Node::Text(text) if is_number(unquoted(text)) && typographic_quote(text).is_some() => STRAIGHT_QUOTES,
        Node::Text(text) if is_number(unquoted(text)) => WITHOUT_QUOTES,
        Node::Text(text) if text.contains(',') && text.chars().all(|c| c.is_ascii_digit() || "+-,. ".contains(c)) => {
            "use a decimal point"
        }
        Node::Text(text) if key.ends_with("_deg") && is_in_minutes(text) => {
            "write decimal degrees, such as 55.7658; south and west are negative"
        }
        Node::Text(text) if key.ends_with("_arcsec") && is_in_parts(text) => ARCSECONDS,
        Node::Text(text) if has_unit(text) => "write the number alone, in the unit that the key states",
        Node::Text(text) if !text.is_ascii() => ASCII,
        Node::Text(text) if text.parse::<f64>().is_ok() => NOT_FINITE,
        Node::Number(_) => NOT_FINITE,
        _ => "",
    }
}

/// Returns how to write the number that a cell of CSV in a column of this name seems to mean, or `None` if it means none.
pub(super) fn on_cell(text: &str, column: &str) -> Option<&'static str> {
    if is_placeholder(text) {
        Some(placeholder::ADVICE)
    } else if text.contains(';') {
        Some("separate columns by commas")
    } else if column.ends_with("_arcsec") && is_in_parts(text) {
        Some(ARCSECONDS)
    } else if text.contains(':') && column.ends_with("_s") {
        Some("count seconds from the first reading, as one number")
    } else if has_two_points(text) {
        Some("it has two points; use one decimal point")
    } else if unquoted(text) != text && is_number(unquoted(text)) {
        Some(WITHOUT_QUOTES)
    } else if text.strip_prefix('(').and_then(|text| text.strip_suffix(')')).is_some_and(is_number) {
        Some("write a negative number with a minus, without parentheses")
    } else if is_number(&text.replace([',', ' ', '\u{A0}', '\u{202F}'], "")) {
        Some("use a decimal point, and no thousands separators")
    } else if is_number(&text.replace(['D', 'd'], "E")) {
        Some("write the exponent with E, such as 1.0E-3")
    } else if has_unit(text) {
        Some("write the number alone, in the unit that the column name states")
    } else if text.chars().any(|c| c.is_ascii_digit()) && !text.is_ascii() {
        Some(ASCII)
    } else {
        None
    }
}

/// Returns `true` for an angle with a sign of degrees, in several numbers, or with the letter of a hemisphere.
fn is_in_minutes(text: &str) -> bool {
    let numbers = numbers_in(text);
    numbers > 1 && !text.contains(',') || numbers > 0 && text.contains(|c| "°′″NSEW".contains(c))
}

/// Returns `true` for an angle in several numbers with colons or the signs of degrees, minutes and seconds between them.
fn is_in_parts(text: &str) -> bool {
    numbers_in(text) > 1 && text.contains(|c| ":°′'".contains(c))
}

fn numbers_in(text: &str) -> usize {
    text.split(|c: char| !c.is_ascii_digit() && c != '.').filter(|part| !part.is_empty()).count()
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok_and(f64::is_finite)
}

fn has_unit(text: &str) -> bool {
    if text.parse::<f64>().is_ok() {
        return false;
    }
    let number = text.trim_start_matches(['+', '-']);
    let rest = number.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    // A spreadsheet may have made a date of a number: 01.Feb.
    let is_whole = rest.len() < number.len() && !number[..number.len() - rest.len()].ends_with('.');
    is_whole && rest.trim_start().starts_with(|c: char| c.is_alphabetic() || "°%″′µ".contains(c))
}

/// Returns a text without the quotes around it, straight or typographic.
pub(super) fn unquoted(text: &str) -> &str {
    text.trim_matches(|c| "\"'“”„‟«»‘’".contains(c)).trim()
}

/// Returns `true` for digits with two points between them.
fn has_two_points(text: &str) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    digits.matches('.').count() == 2
        && digits.split('.').all(|part| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Last parts of names that are units.
const UNITS: [&str; 36] = [
    "s", "ms", "us", "ns", "min", "h", "a", "ma", "ua", "na", "v", "mv", "uv", "deg", "rad", "mrad", "urad", "arcsec",
    "arcmin", "gon", "ppm", "percent", "mm", "cm", "m", "km", "ft", "s2", "g", "g2", "gal", "mgal", "c", "k", "f",
    "mas",
];

/// Returns the advice for an unknown name that only looks like one of the `known`, is one of them in another unit, whose
/// numbers must be converted, or is an expanded uncertainty instead of a standard one; `None` for other names.
pub(super) fn on_name(known: &[&str], found: &str) -> Option<String> {
    if let Some((latin, odd)) = latin(found).filter(|(latin, _)| known.contains(&latin.as_str())) {
        return Some(format!("the {odd} only looks like a Latin letter; type {latin} again"));
    }
    if let Some(name) = known.iter().find(|name| found.starts_with("U_") && **name == found.to_lowercase()) {
        return Some(format!(
            "if U is an expanded uncertainty, divide the numbers by its coverage factor k; then name it {name}"
        ));
    }
    let found = found.to_lowercase();
    let (quantity, unit) = split(&found)?;
    let (name, known) = known.iter().find_map(|name| {
        let (of, known) = split(name)?;
        (of == quantity && known != unit).then_some((name, known))
    })?;
    let words = |unit: &str| unit.split('_').map(unit_in_words).collect::<Vec<_>>().join(" ");
    Some(format!("convert the numbers from {} to {}, then name it {name}", words(unit), words(known)))
}

/// Returns a part of a unit in a name as people write it.
fn unit_in_words(part: &str) -> &str {
    match part {
        "a" => "A",
        "ma" => "mA",
        "ua" => "µA",
        "na" => "nA",
        "mgal" => "mGal",
        "deg" => "degrees",
        "arcmin" => "arcminutes",
        "arcsec" => "arcseconds",
        other => other,
    }
}

/// Returns the quantity and the unit of a name such as `alpha_arcsec` or `k_x_deg_per_h_per_ma`; `None` if it states no unit.
fn split(name: &str) -> Option<(&str, &str)> {
    let is_unit = |(_, unit): &(&str, &str)| UNITS.contains(unit);
    let (mut quantity, _) = name.rsplit_once('_').filter(is_unit)?;
    while let Some((stem, _)) = quantity.strip_suffix("_per").and_then(|name| name.rsplit_once('_')).filter(is_unit) {
        quantity = stem;
    }
    Some((quantity, &name[quantity.len() + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_with_two_points_are_neither_number_nor_other_text() {
        for text in ["12.5.6", "+1.2.3", "-55.45.0"] {
            assert!(has_two_points(text), "{text}");
        }
        for text in ["12.5", "1.2.3.4", "1..2", ".1.2", "1.2.", "a.b.c", "1.2.x", ""] {
            assert!(!has_two_points(text), "{text}");
        }
    }

    fn text(text: &str) -> Node {
        Node::Text(text.to_owned())
    }

    /// Expected: the one remedy for what a person wrote.
    #[test]
    fn the_advice_on_a_number_fits_what_was_written() {
        const DECIMAL_DEGREES: &str = "write decimal degrees, such as 55.7658; south and west are negative";
        const WITHOUT_UNIT: &str = "write the number alone, in the unit that the key states";
        for (written, key, due) in [
            ("55.45.56", "alpha_arcsec", "it has two points; use one decimal point"),
            ("\u{201C}1.5\u{201D}", "alpha_arcsec", STRAIGHT_QUOTES),
            ("'1.5'", "alpha_arcsec", WITHOUT_QUOTES),
            ("'inf'", "alpha_arcsec", ""),
            ("1.5", "alpha_arcsec", WITHOUT_QUOTES),
            ("150,0", "alpha_arcsec", "use a decimal point"),
            ("-1 000,5", "latitude_deg", "use a decimal point"),
            ("a,b", "alpha_arcsec", ""),
            ("55°45′56″", "latitude_deg", DECIMAL_DEGREES),
            ("55 45 56", "latitude_deg", DECIMAL_DEGREES),
            ("55.7 N", "latitude_deg", DECIMAL_DEGREES),
            ("55.7°", "latitude_deg", DECIMAL_DEGREES),
            ("55.7°", "alpha_arcsec", WITHOUT_UNIT),
            ("12 mA", "jx_ma", WITHOUT_UNIT),
            ("-.5m", "height_m", WITHOUT_UNIT),
            ("5280 ft", "height_m", WITHOUT_UNIT),
            ("0°01′10.9″", "alpha_arcsec", ARCSECONDS),
            ("-1:10.9", "u_arcsec", ARCSECONDS),
            ("m 5", "height_m", ""),
            ("5 (m)", "height_m", ""),
            ("a,b 1 2", "latitude_deg", ""),
            ("NORTH", "latitude_deg", ""),
            ("about 55", "latitude_deg", ""),
            ("°", "latitude_deg", ASCII),
            ("\u{2212}5", "alpha_arcsec", ASCII),
            ("nan", "alpha_arcsec", NOT_FINITE),
        ] {
            assert_eq!(on_yaml(&text(written), &Path::Root.key(key)), due, "{written}");
        }
        assert!(on_yaml(&text("55.45.56"), &Path::Root.key("latitude_deg")).contains("degrees, minutes and seconds"));
        let alpha = Path::Root.key("alpha_arcsec");
        assert_eq!(on_yaml(&Node::Number(f64::INFINITY), &alpha), NOT_FINITE);
        assert_eq!(on_yaml(&Node::Bool(true), &alpha), "");
    }

    /// Expected: of a tolerance alone, what to do about an interval that is not symmetric.
    #[test]
    fn an_interval_in_place_of_a_tolerance_has_its_advice() {
        let limits = Node::List(vec![Node::Number(-0.1), Node::Number(0.3)]);
        let [tolerance, nominal] = ["tolerance", "nominal"].map(|key| Path::Root.key(key));
        for (node, due) in [(limits, TOLERANCE), (text("±0.3"), TOLERANCE), (text("-0.1/+0.3"), TOLERANCE)] {
            assert_eq!(on_yaml(&node, &tolerance.key("omega0_deg_per_h")), due);
            assert_ne!(on_yaml(&node, &nominal.key("omega_g_deg_per_h_per_g")), due);
        }
        assert_eq!(on_yaml(&text("0,01"), &tolerance.key("omega0_deg_per_h")), "use a decimal point");
    }

    /// Expected: the one remedy for what a person or a program wrote into a cell.
    #[test]
    fn the_advice_on_a_cell_fits_what_was_written() {
        const WITHOUT_UNIT: &str = "write the number alone, in the unit that the column name states";
        const NO_THOUSANDS: &str = "use a decimal point, and no thousands separators";
        for (written, column, due) in [
            ("-1:10.9", "beta_arcsec", ARCSECONDS),
            ("0°01′10.9″", "alpha_arcsec", ARCSECONDS),
            ("10.9″", "alpha_arcsec", WITHOUT_UNIT),
            ("10:02:03", "time_s", "count seconds from the first reading, as one number"),
        ] {
            assert_eq!(on_cell(written, column), Some(due), "{written}");
        }
        assert_eq!(on_cell("0:10", "jx_ma"), None);
        for (written, due) in [
            ("1;2", "separate columns by commas"),
            ("1.2.3", "it has two points; use one decimal point"),
            ("(0.2)", "write a negative number with a minus, without parentheses"),
            ("'1.5'", WITHOUT_QUOTES),
            ("1,234.5", NO_THOUSANDS),
            ("-1\u{A0}234.5", NO_THOUSANDS),
            ("-0,2003", NO_THOUSANDS),
            ("-2.003D-01", "write the exponent with E, such as 1.0E-3"),
            ("\u{2212}1.5", ASCII),
            ("1.5mA", WITHOUT_UNIT),
            ("1.5 µA", WITHOUT_UNIT),
            ("-1.5 mA", WITHOUT_UNIT),
        ] {
            assert_eq!(on_cell(written, "jx_ma"), Some(due), "{written}");
        }
        for written in
            ["", "'inf'", "NaN", "-", "—", "#DIV/0!", "#N/A", "OVERLOAD", "01.Feb", "about 1.5", "a lot", "1.5 (?)"]
        {
            assert_eq!(on_cell(written, "jx_ma"), None, "{written}");
        }
    }

    /// Expected: the units by hand; GUM 2.3.5 and 6.2.1 for U = k u.
    #[test]
    fn another_unit_is_to_be_converted() {
        let known = [
            "alpha_arcsec",
            "u_arcsec",
            "u_alpha_arcsec",
            "jx_ma",
            "time_s",
            "gravity_m_per_s2",
            "height_m",
            "omega_g_deg_per_h_per_g",
        ];
        for (found, from, to, name) in [
            ("alpha_arcmin", "arcminutes", "arcseconds", "alpha_arcsec"),
            ("alpha_deg", "degrees", "arcseconds", "alpha_arcsec"),
            ("alpha_mrad", "mrad", "arcseconds", "alpha_arcsec"),
            ("u_arcmin", "arcminutes", "arcseconds", "u_arcsec"),
            ("jx_uA", "µA", "mA", "jx_ma"),
            ("jx_A", "A", "mA", "jx_ma"),
            ("time_ms", "ms", "s", "time_s"),
            ("gravity_mGal", "mGal", "m per s2", "gravity_m_per_s2"),
            ("height_km", "km", "m", "height_m"),
            ("omega_g_rad_per_s_per_g", "rad per s per g", "degrees per h per g", "omega_g_deg_per_h_per_g"),
        ] {
            let due = format!("convert the numbers from {from} to {to}, then name it {name}");
            assert_eq!(on_name(&known, found), Some(due), "{found}");
        }
        for name in ["u_arcsec", "u_alpha_arcsec"] {
            let said = on_name(&known, &name.replacen('u', "U", 1)).unwrap();
            assert!(said.contains("divide") && said.ends_with(name), "{said}");
        }
        for other in ["alpha_arcsecs", "alfa_arcsec", "alpha", "jx_mA", "time_of_day", "omega_k_deg_per_h_per_g", "k"] {
            assert_eq!(on_name(&known, other), None, "{other}");
        }
    }
}
