//! The text rule of signed documents: what they may contain, and the one way in which content is written.
//!
//! Every YAML 1.1 and 1.2 reader finds the same content in such a text, to the last bit of every number. The
//! writer ([`number`], [`quoted`]) and the reader of the rule ([`check`], [`differs`]) stand side by side.

use super::node::{location_of, plain_text};
use super::problem::Unreadable;
use std::ops::RangeInclusive;

/// Characters beyond ASCII that a quoted string may hold: letters, punctuation and symbols that are drawn alone,
/// from left to right, and that no YAML reader takes for a line end.
const BEYOND_ASCII: [RangeInclusive<char>; 22] = [
    '\u{00A1}'..='\u{00AC}',
    '\u{00AE}'..='\u{02AF}',
    '\u{0370}'..='\u{0373}',
    '\u{0375}'..='\u{0377}',
    '\u{037A}'..='\u{037D}',
    '\u{037F}'..='\u{037F}',
    '\u{0384}'..='\u{0386}',
    '\u{0388}'..='\u{0482}',
    '\u{048A}'..='\u{052F}',
    '\u{2010}'..='\u{2027}',
    '\u{2030}'..='\u{205E}',
    '\u{20AC}'..='\u{20AC}',
    '\u{2103}'..='\u{2103}',
    '\u{2116}'..='\u{2116}',
    '\u{2190}'..='\u{22FF}',
    '\u{3001}'..='\u{3003}',
    '\u{3005}'..='\u{3011}',
    '\u{3041}'..='\u{3096}',
    '\u{309D}'..='\u{30FF}',
    '\u{4E00}'..='\u{9FFF}',
    '\u{AC00}'..='\u{D7A3}',
    '\u{FF01}'..='\u{FF5E}',
];

/// Whether a string of a signed document may hold `c`.
pub fn allowed_in_string(c: char) -> bool {
    (' '..='~').contains(&c) || BEYOND_ASCII.iter().any(|range| range.contains(&c))
}

/// Whether `c` may stand outside strings and comments: keys, numbers, `true`, `false` and the brackets need no more.
fn allowed_outside(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || " _:,{}[]+-.".contains(c)
}

/// A binary64 value as every YAML reader reads it back, bit for bit.
///
/// The shortest decimal that gives the value back, always with a point; with an exponent of a sign and at least two
/// digits below 1e-4 and from 1e16 on (`1.0e-06`: PyYAML and Psych read `1e-6` as a string).
///
/// # Panics
/// Never for a finite value; a value that is not finite is not a number of any document, and refused before.
pub fn number(value: f64) -> String {
    let mut text = String::new();
    write_number(value, |part| text.push_str(part));
    text
}

/// The same in parts.
pub(super) fn write_number(value: f64, mut push: impl FnMut(&str)) {
    debug_assert!(value.is_finite(), "only finite numbers are written");
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return push("0.0");
    }
    let plain = (1e-4..1e16).contains(&magnitude);
    let mut buffer = zmij::Buffer::new();
    let shortest = buffer.format_finite(value);
    if may_be_midway(value, shortest) {
        let digits = if plain { format!("{value}") } else { format!("{value:e}") };
        return push_parts(&digits, push);
    }
    match shortest.strip_prefix('-').unwrap_or(shortest).strip_prefix("0.0000") {
        // From 1e-5 to 1e-4.
        Some(digits) if !plain => {
            let (first, others) = digits.split_at(1);
            push(if value < 0.0 { "-" } else { "" });
            push(first);
            push(".");
            push(if others.is_empty() { "0" } else { others });
            push("e-05");
        }
        _ if plain => push(shortest),
        _ => push_parts(shortest, push),
    }
}

/// A number in digits of the rule, from the digits of any other form.
fn push_parts(digits: &str, mut push: impl FnMut(&str)) {
    let (mantissa, exponent) = digits.split_once('e').map_or((digits, None), |(m, e)| (m, Some(e)));
    push(mantissa);
    push(if mantissa.contains('.') { "" } else { ".0" });
    if let Some(exponent) = exponent {
        let unsigned = exponent.trim_start_matches(['-', '+']);
        push(if exponent.starts_with('-') { "e-" } else { "e+" });
        push(if unsigned.len() < 2 { "0" } else { "" });
        push(unsigned);
    }
}

/// Whether a value may lie exactly between two decimals of so many places: then zmij takes the even one and the standard
/// library the larger, which is what has always been written.
///
/// odd/2^f = (2k + 1)/(2·10^d) needs f = d + 1; and shortest decimals of d places are no coarser than the value's own
/// steps of 2^-52 of it, which ends at f = 25.
fn may_be_midway(value: f64, shortest: &str) -> bool {
    const MOST_BINARY_PLACES: i64 = 25;
    let bits = value.to_bits();
    let exponent = (bits >> 52 & 0x7FF) as i64;
    let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
    let binary_places = 1075 - exponent - i64::from(mantissa.trailing_zeros());
    binary_places <= MOST_BINARY_PLACES && {
        let (mantissa, exponent) = shortest.split_once('e').unwrap_or((shortest, "0"));
        let places = mantissa.split_once('.').map_or(0, |(_, places)| places.len() as i64);
        binary_places == places - exponent.parse().unwrap_or(0) + 1
    }
}

/// A string in double quotes, with the only two escapes of the rule.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::new();
    write_quoted(text, |part| quoted.push_str(part));
    quoted
}

/// The same in parts.
pub(super) fn write_quoted(text: &str, mut push: impl FnMut(&str)) {
    push("\"");
    let mut rest = text;
    while let Some(at) = memchr::memchr2(b'"', b'\\', rest.as_bytes()) {
        let (plain, others) = rest.split_at(at);
        let (escaped, after) = others.split_at(1);
        [plain, "\\", escaped].into_iter().for_each(&mut push);
        rest = after;
    }
    push(rest);
    push("\"");
}

/// Checks the bytes against the rule, before anything is parsed; gives the text.
pub fn check<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Unreadable> {
    let text = plain_text(name, bytes)?;
    if !text.ends_with('\n') {
        let at = location_of(bytes);
        return Err(Unreadable::whole(name, Some(at), "no line feed at the end", "one", "was it copied to the end?"));
    }
    let mut line_start = 0;
    for line_end in memchr::memchr_iter(b'\n', bytes) {
        let line = &text[line_start..line_end];
        if !is_plain(line.as_bytes())
            && let Some((offset, found, expected)) = first_fault(line)
        {
            let at = location_of(&bytes[..line_start + offset]);
            let advice = "the text is not as any issuer writes it";
            return Err(Unreadable::whole(name, Some(at), found, expected, advice));
        }
        line_start = line_end + 1;
    }
    Ok(text)
}

/// Whether all bytes are printable ASCII.
pub(super) fn is_printable_ascii(bytes: &[u8]) -> bool {
    // To the end in any case: so the compiler looks at many at once.
    bytes.iter().fold(true, |good, byte| good & (b' '..=b'~').contains(byte))
}

/// Whether a line obeys the rule and no character of it needs a closer look than its byte: almost every line does.
fn is_plain(line: &[u8]) -> bool {
    let start = line.iter().position(|byte| *byte != b' ').unwrap_or(line.len());
    match line.get(start) {
        Some(b'#') => return is_printable_ascii(line),
        Some(b'-' | b'.') if start == 0 => return false,
        _ => {}
    }
    let mut rest = line;
    while let Some(quote) = memchr::memchr(b'"', rest) {
        let (outside, string) = (&rest[..quote], &rest[quote + 1..]);
        let Some(end) = memchr::memchr(b'"', string) else { return false };
        let without_escapes = |string: &[u8]| memchr::memchr(b'\\', string).is_none();
        if !may_stand_outside(outside) || !is_printable_ascii(&string[..end]) || !without_escapes(&string[..end]) {
            return false;
        }
        rest = &string[end + 1..];
    }
    may_stand_outside(rest)
}

/// Whether all bytes are characters that [`allowed_outside`] lets through.
fn may_stand_outside(bytes: &[u8]) -> bool {
    let good = |byte: &u8| {
        (b'a'..=b'{').contains(byte)
            | (b'0'..=b':').contains(byte)
            | (b'+'..=b'.').contains(byte)
            | matches!(byte, b' ' | b'[' | b']' | b'_' | b'}')
    };
    bytes.iter().fold(true, |all, byte| all & good(byte))
}

/// The byte offset of the first character of a line that breaks the rule, what it is, and what was expected.
fn first_fault(line: &str) -> Option<(usize, String, &'static str)> {
    // Of allowed characters alone, but with what follows another document: readers differ in which one they give.
    if let Some(marker) = ["---", "..."].into_iter().find(|marker| line.starts_with(marker)) {
        return Some((0, format!("the document marker `{marker}`"), "one document without markers"));
    }
    let comment = line.trim_start_matches(' ').starts_with('#');
    let mut in_string = false;
    let mut escaped = false;
    for (offset, c) in line.char_indices() {
        let (allowed, expected) = match (comment, in_string) {
            (true, _) => ((' '..='~').contains(&c), "printable ASCII in a comment"),
            (_, true) if escaped => (c == '"' || c == '\\', "after a backslash only \" or \\"),
            (_, true) => (allowed_in_string(c), "a character that a string may hold"),
            (_, false) => (c == '"' || allowed_outside(c), "only keys, numbers, brackets and double-quoted strings"),
        };
        if !allowed {
            return Some((offset, named(c), expected));
        }
        if !comment {
            let quote = c == '"' && !escaped;
            escaped = in_string && c == '\\' && !escaped;
            in_string ^= quote;
        }
    }
    in_string.then(|| (line.len(), "the end of the line inside a string".to_owned(), "a closing double quote"))
}

fn named(c: char) -> String {
    match c {
        '\t' => "a tab".to_owned(),
        ' '..='~' => format!("the character {c:?}"),
        _ => format!("the character U+{:04X}", u32::from(c)),
    }
}

/// Where `text`, its comments and blank lines aside, differs from `canonical`: line number, found, expected.
pub fn differs(text: &str, canonical: &str) -> Option<(usize, String, String)> {
    let mut expected = canonical.lines();
    let content = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim_matches(' ').is_empty() && !line.trim_start_matches(' ').starts_with('#'));
    for (index, found) in content {
        match expected.next() {
            Some(expected) if expected == found => {}
            other => {
                let expected = other.map_or_else(|| "the end".to_owned(), shortened);
                return Some((index + 1, shortened(found), expected));
            }
        }
    }
    expected.next().map(|missing| (text.lines().count() + 1, "the end".to_owned(), shortened(missing)))
}

fn shortened(line: &str) -> String {
    const LONGEST: usize = 100;
    if line.chars().count() <= LONGEST {
        return format!("`{line}`");
    }
    format!("`{}...`", line.chars().take(LONGEST).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected texts from `contract`: a point always, an exponent with sign and two digits, `0.0` for both zeros.
    #[test]
    fn numbers_have_one_form() {
        let cases = [
            (0.0, "0.0"),
            (-0.0, "0.0"),
            (1.0, "1.0"),
            (-20.0, "-20.0"),
            (0.1, "0.1"),
            (1e-4, "0.0001"),
            (9.999e-5, "9.999e-05"),
            (1e-6, "1.0e-06"),
            (-2.5e-300, "-2.5e-300"),
            (5e-324, "5.0e-324"),
            (1e15, "1000000000000000.0"),
            (1e16, "1.0e+16"),
            (1.7976931348623157e308, "1.7976931348623157e+308"),
            (15.04106687606545, "15.04106687606545"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    /// Expected: what the standard library finds, in the form of the rule, for values of every size.
    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let due = |value: f64| {
            if (1e-4..1e16).contains(&value.abs()) {
                let decimal = format!("{value}");
                return if decimal.contains('.') { decimal } else { decimal + ".0" };
            }
            let scientific = format!("{value:e}");
            let (mantissa, exponent) = scientific.split_once('e').unwrap();
            let point = if mantissa.contains('.') { "" } else { ".0" };
            let exponent: i32 = exponent.parse().unwrap();
            format!("{mantissa}{point}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
        };
        let mut stream = crate::statistics::random::Stream::new(5);
        let mut bits = || (stream.unit() * (1_u64 << 53) as f64) as u64 * 2048 + stream.below(2048) as u64;
        for _ in 0..200_000 {
            let value = f64::from_bits(bits());
            if value.is_finite() && value != 0.0 {
                assert_eq!(number(value), due(value), "{:x}", value.to_bits());
            }
        }
        // Midway between two decimals of sixteen digits.
        for value in [-8_895_655_562_136_013.0 / 4.0, 1_073_741_825.0 / 2048.0, 1_125_899_906_842_624.125] {
            assert_eq!(number(value), due(value));
        }
        for bits in 20..52 {
            for odd in 0..500 {
                let value =
                    f64::from(2 * odd + 1) * libm::pow(2.0, f64::from(bits - 52)) + libm::pow(2.0, f64::from(bits));
                assert_eq!(number(value), due(value));
            }
        }
        for exponent in -20..20 {
            for digits in 1..2000 {
                let value = f64::from(digits) * libm::pow(10.0, f64::from(exponent));
                assert_eq!(number(-value), due(-value));
            }
        }
    }

    #[test]
    fn a_line_is_refused_at_its_first_forbidden_character() {
        let good = [
            "a: \"x\"",
            "  # a comment!",
            "  - {i: 1, s: \"\\\"\\\\\", m: [[1.0e-06, -2.0]]}",
            "a: \"# no comment\"",
            "",
        ];
        for line in good {
            assert_eq!(first_fault(line), None, "{line}");
            assert!(is_plain(line.as_bytes()) || line.contains('\\'), "{line}");
        }
        let bad = [
            ("a: 'x'", 3),
            ("a: &x 1", 3),
            ("a: \"x\" # late comment", 7),
            ("a: \"\\n\"", 5),
            ("a:\t1", 2),
            ("# Комментарий", 2),
            ("a: \"x", 5),
            ("a: |", 3),
            ("a: \"\u{202E}\"", 4),
            ("a: \"e\u{301}\"", 5),
            ("? a", 0),
            ("%YAML 1.2", 0),
            ("---", 0),
            ("... # x", 0),
            ("<<: {}", 0),
            ("a: 1E5", 4),
        ];
        for (line, offset) in bad {
            assert_eq!(first_fault(line).map(|fault| fault.0), Some(offset), "{line}");
            assert!(!is_plain(line.as_bytes()), "{line}");
        }
    }

    /// Every byte between two neighbours, outside of strings, inside and in comments: quick and slow agree.
    #[test]
    fn no_line_is_plain_that_breaks_the_rule() {
        for byte in 0..=127_u8 {
            for (before, after) in [("", ""), ("a: ", "1.0"), ("a: \"x", "y\""), ("  # ", "z"), ("a: \"x\\", "\"\"")] {
                let line = format!("{before}{}{after}", char::from(byte));
                assert!(!is_plain(line.as_bytes()) || first_fault(&line).is_none(), "{line:?}");
                let needs_no_look = !line.contains(['\\', '\n']) && !line.starts_with(['-', '.']);
                assert!(!needs_no_look || is_plain(line.as_bytes()) == first_fault(&line).is_none(), "{line:?}");
            }
        }
    }

    #[test]
    fn comments_and_blank_lines_do_not_differ_anything_else_does() {
        let canonical = "a: 1\nb:\n  c: 2.0\n";
        assert_eq!(differs("# x\na: 1\n\nb:\n  # y\n  c: 2.0\n", canonical), None);
        assert_eq!(differs("a: 1\nb:\n  c: 2.00\n", canonical).map(|found| found.0), Some(3));
        assert_eq!(differs("a: 1\n", canonical).map(|found| found.0), Some(2));
        assert_eq!(differs("a: 1\nb:\n  c: 2.0\nd: 1\n", canonical).map(|found| found.0), Some(4));
    }
}
