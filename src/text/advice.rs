//! Advice on what a person or a program wrote where a number belongs, and on unknown names that are known ones in letters of
//! another alphabet, or in another unit.

use super::characters::latin;
use super::{Advice, Node, RefusalCause};
#[cfg(feature = "yaml")]
use super::{Path, Problems};

/// Word that a template contains instead of a value that only the user knows, and that no document of theirs may contain.
const PLACEHOLDER: &str = "CHANGE";
const REPLACE: &str = "replace the word from the template";

/// Returns `true` if `text` is a placeholder: the word alone, or the word, a colon and what is to be written.
fn is_placeholder(text: &str) -> bool {
    let rest = text.trim().strip_prefix(PLACEHOLDER);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
}

/// Reports every placeholder in a hand-written document. A value with an error already, such as no number, gets the advice.
#[cfg(feature = "yaml")]
pub(crate) fn check_placeholders(node: &Node, problems: &mut Problems) {
    node.each_scalar(&Path::Root, &mut |at, scalar| {
        if let Node::Text(text) = scalar
            && is_placeholder(text)
            && !problems.advise(at, REPLACE)
        {
            problems.at(at, format!("{text:?}"), "your value", REPLACE);
        }
    });
}

/// Way in which people and programs write what is not a number, with its cause.
type Way = (fn(&str) -> bool, RefusalCause);

/// The ways; the first that fits is taken.
const WAYS: [Way; 5] = [
    (|text| text.chars().any(char::is_control), RefusalCause::ControlCharacter),
    (is_date, RefusalCause::SpreadsheetDate),
    (is_overload, RefusalCause::Overload),
    (is_grouped, RefusalCause::Thousands),
    (has_decimal_comma, RefusalCause::DecimalComma),
];

const NOT_FINITE: &str = "use a finite number, because NaN and infinity are not measured values";

/// Returns what to do about a text where a number belongs, or `None` without such advice.
fn on_text(text: &str) -> Option<Advice> {
    if is_placeholder(text) {
        return Some(REPLACE.into());
    }
    let way = WAYS.iter().find(|(fits, _)| fits(text)).map(|(_, cause)| (*cause).into());
    // The minus of printed numbers.
    way.or_else(|| text.contains('\u{2212}').then(|| "use an ASCII minus".into()))
}

/// Returns what to do about a value of YAML that is not a number; empty without such advice.
pub(crate) fn on_yaml(node: &Node) -> Advice {
    match node {
        Node::Text(text) if has_leading_zero(text) => RefusalCause::LeadingZero.into(),
        Node::Text(text) => match text.parse::<f64>() {
            Ok(number) if number.is_finite() => "write the number without quotes".into(),
            Ok(_) => NOT_FINITE.into(),
            Err(_) => on_text(text).unwrap_or_default(),
        },
        Node::Number(_) => NOT_FINITE.into(),
        _ => Advice::default(),
    }
}

/// Returns how to write the number that a cell of CSV seems to mean; for a reading that was not taken, it ends with the advice
/// `not_taken`.
pub(crate) fn on_cell(text: &str, not_taken: &str) -> Advice {
    let advice = on_text(text).unwrap_or_else(|| not_taken.into());
    if advice.cause == Some(RefusalCause::Overload) { overload(not_taken) } else { advice }
}

/// Returns the advice on the sign of an instrument for an overload, followed by what to do about it.
fn overload(remedy: &str) -> Advice {
    let Advice { cause, words, meant } = RefusalCause::Overload.into();
    Advice { cause, words: format!("{words}; {remedy}"), meant }
}

/// Returns the advice on a number beyond its range that has a recognised cause; `remedy` says what to do about an overload.
pub(crate) fn beyond_range(value: f64, remedy: &str) -> Option<Advice> {
    const LEAST_OVERLOAD: f64 = 1e9;
    let digits = format!("{}", value.abs()).replace('.', "");
    let is_full_scale = digits.len() >= 4 && digits.bytes().all(|digit| digit == b'9');
    (value.abs() >= LEAST_OVERLOAD || is_full_scale).then(|| overload(remedy))
}

/// Returns an angle with full turns of `turn` added or subtracted, so that it is from `least` to less than `least + turn`: as
/// text with the decimals of the angle, because 316.8 − 360 is not exactly −43.2. `None` if no full turn is needed.
pub(crate) fn without_full_turns(angle: f64, turn: f64, least: f64) -> Option<String> {
    let decimals = format!("{angle}").split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let within = (angle - least).rem_euclid(turn) + least;
    (!(least..least + turn).contains(&angle)).then(|| format!("{within:.decimals$}"))
}

/// Beginnings of the names of months: English, German, French, Russian.
const MONTHS: &str = "jan feb mar apr may jun jul aug sep oct nov dec mär mai okt dez fév avr jui aoû déc \
                      янв фев мар апр май мая июн июл авг сен окт ноя дек";

/// Returns `true` for a date in which a spreadsheet program shows a number such as 10.9: a month in letters with a day or a
/// year, or day, month and year in digits.
fn is_date(text: &str) -> bool {
    let lower = text.to_lowercase();
    let parts: Vec<&str> = lower.split(|c: char| " .-/,".contains(c)).filter(|part| !part.is_empty()).collect();
    let is_month = |part: &&&str| {
        part.chars().all(char::is_alphabetic)
            && MONTHS.split_whitespace().any(|month| part.starts_with(month) && part.len() <= 2 * month.len() + 4)
    };
    let number = |part: &str| part.parse::<u32>().ok().filter(|_| part.len() <= 4);
    let numbers: Vec<u32> = parts.iter().filter_map(|part| number(part)).collect();
    match numbers[..] {
        [_] | [_, _] if parts.len() == numbers.len() + 1 => parts.iter().filter(is_month).count() == 1,
        [year, month, day] | [day, month, year] if parts.len() == 3 && (1900..2100).contains(&year) => {
            (1..=31).contains(&day) && (1..=31).contains(&month) && day.min(month) <= 12
        }
        _ => false,
    }
}

/// Returns `true` for a word that a meter writes for an overload, such as OL, +OVLD or 1.#INF.
fn is_overload(text: &str) -> bool {
    let word = text.trim_matches(|c: char| "+- ".contains(c)).to_ascii_uppercase();
    ["OVER", "OVL", "OVR", "OVF", "OFL", "1.#INF"].iter().any(|beginning| word.starts_with(beginning))
        || ["OL", "O.L", "O.L.", "0L", "0.L", "0.L."].contains(&word.as_str())
}

/// Returns `true` for a number in groups of three digits with equal separators between them.
fn is_grouped(text: &str) -> bool {
    let digits = with_ascii_minus(text);
    let digits = digits.trim_start_matches(['+', '-']);
    let is_digits = |part: &str| !part.is_empty() && part.bytes().all(|digit| digit.is_ascii_digit());
    let Some(mark) = digits.chars().find(|c| ",.'’_ \u{A0}\u{2009}\u{202F}".contains(*c)) else { return false };
    let fraction = digits.rsplit_once(|c| ",.".contains(c) && c != mark);
    let whole = fraction.map_or(digits, |(whole, _)| whole);
    let mut groups = whole.split(mark);
    let is_first = |first: &str| first.len() <= 3 && is_digits(first) && !first.starts_with('0');
    // A single point is a decimal point.
    (mark != '.' || fraction.is_some() || whole.matches('.').count() > 1)
        && groups.next().is_some_and(is_first)
        && groups.all(|group| group.len() == 3 && is_digits(group))
        && fraction.is_none_or(|(_, fraction)| is_digits(fraction))
}

fn has_leading_zero(text: &str) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    digits.len() > 1 && digits.starts_with('0') && digits.bytes().all(|digit| digit.is_ascii_digit())
}

fn has_decimal_comma(text: &str) -> bool {
    text.contains(',') && with_ascii_minus(text).replacen(',', ".", 1).parse::<f64>().is_ok_and(f64::is_finite)
}

fn with_ascii_minus(text: &str) -> String {
    text.replace('\u{2212}', "-")
}

/// Last parts of names that are units.
const UNITS: [&str; 36] = [
    "s", "ms", "us", "ns", "min", "h", "a", "ma", "ua", "na", "v", "mv", "uv", "deg", "rad", "mrad", "urad", "arcsec",
    "arcmin", "gon", "ppm", "percent", "mm", "cm", "m", "km", "ft", "s2", "g", "g2", "gal", "mgal", "c", "k", "f",
    "mas",
];

/// Returns the advice for an unknown name that only looks like one of the `known`, or is one of them in another unit or another
/// way of writing it; `None` for other names.
pub(crate) fn on_name(known: &[&str], found: &str) -> Option<Advice> {
    if let Some((latin, odd)) = latin(found).filter(|(latin, _)| known.contains(&latin.as_str())) {
        return Some(
            Advice::from(format!("the {odd} only looks like a Latin letter; type {latin} again")).meaning(&latin),
        );
    }
    let lower = found.to_lowercase();
    let of_name = split(&lower).map(|(quantity, unit)| (quantity.to_owned(), unit.to_owned()));
    let is_written = of_name.is_none();
    let (quantity, unit) = of_name.or_else(|| written_unit(&lower))?;
    let (name, is_same) = known.iter().find_map(|name| {
        let (of, known) = split(name)?;
        (of.replace('_', "") == quantity.replace('_', "") && (is_written || known != unit))
            .then_some((*name, known == unit))
    })?;
    let words = match is_same {
        true => format!("name it {name}, which states the unit"),
        false => format!("convert the numbers, then name it {name}"),
    };
    let advice = if is_written { (RefusalCause::HeaderUnit, words).into() } else { Advice::from(words) };
    Some(advice.meaning(name))
}

/// Units of names, with the ways in which people write them, in lower case and without dots and spaces; Cyrillic and Latin
/// letters may be mixed.
const WRITTEN_UNITS: [(&str, &str); 10] = [
    ("ma", "ма mа мa"),
    ("ua", "мка µa μa"),
    ("na", "на"),
    ("a", "а"),
    ("arcsec", "″ \" '' ′′ угл углс углсек asec"),
    ("arcmin", "′"),
    ("deg", "° град"),
    ("s", "с сек sec"),
    ("ms", "мс"),
    ("m", "м"),
];

/// Returns the unit in the form that names have, or `None` if `text` is no unit. Brackets around it do not count.
pub(super) fn unit(text: &str) -> Option<&str> {
    let text = text.trim_matches(|c: char| "()[]., ".contains(c));
    let written: String = text.to_lowercase().chars().filter(|c| !". ".contains(*c)).collect();
    let known = WRITTEN_UNITS.iter().find(|(_, ways)| ways.split(' ').any(|way| way == written));
    known.map(|(unit, _)| *unit).or_else(|| UNITS.into_iter().find(|unit| *unit == written))
}

/// Returns the quantity and the unit of a name such as `jx, мА`, `j_x (ma)` or `α [″]`, in the form that names have.
fn written_unit(lower: &str) -> Option<(String, String)> {
    let (quantity, written) = lower.split_once([',', '(', '[', '/']).or_else(|| lower.rsplit_once([' ', '_']))?;
    let quantity: String = quantity.chars().filter(|c| c.is_alphanumeric()).collect();
    let greek = [("α", "alpha"), ("β", "beta"), ("γ", "gamma"), ("θ", "theta"), ("φ", "phi")];
    let quantity = greek.into_iter().fold(quantity, |name, (letter, word)| name.replace(letter, word));
    let quantity = latin(&quantity).map_or(quantity, |(latin, _)| latin);
    Some((quantity, unit(written)?.to_owned()))
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
