//! The text rule of signed documents: what they may contain, and the one way in which content is written.
//!
//! Every YAML 1.1 and 1.2 reader finds the same content in such a text, to the last bit of every number. The
//! writer ([`write()`], [`number`], [`quoted`]) and the reader of the rule ([`check`], [`differs`]) stand side by side.

use super::Node;
use super::node::{location_of, plain_text};
use super::problem::Unreadable;
use std::fmt::Write as _;
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
    debug_assert!(value.is_finite(), "only finite numbers are written");
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0.0".to_owned();
    }
    if (1e-4..1e16).contains(&magnitude) {
        let decimal = format!("{value}");
        return if decimal.contains('.') { decimal } else { decimal + ".0" };
    }
    let scientific = format!("{value:e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
    format!("{mantissa}{point}e{sign}{digits:0>2}")
}

/// A string in double quotes, with the only two escapes of the rule.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        if c == '"' || c == '\\' {
            quoted.push('\\');
        }
        quoted.push(c);
    }
    quoted.push('"');
    quoted
}

/// The comment lines above a key, given as a path like `earth.gravity_m_per_s2`; without the `# `.
pub type Comments<'a> = &'a dyn Fn(&str) -> Vec<String>;

/// No comments at all: the form that texts are compared in.
pub fn no_comments(_: &str) -> Vec<String> {
    Vec::new()
}

/// Writes a mapping: nested mappings as blocks, each item of a list of mappings on its own line, a matrix on one line.
pub fn write(document: &Node, comments: Comments) -> String {
    let mut text = String::new();
    write_block(&mut text, document, "", 0, comments);
    text
}

fn write_block(text: &mut String, node: &Node, path: &str, indent: usize, comments: Comments) {
    let Node::Map(entries) = node else { return };
    for (key, value) in entries {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        for line in comments(&path) {
            let _ = writeln!(text, "{:indent$}# {line}", "");
        }
        let _ = write!(text, "{:indent$}{key}:", "");
        match value {
            Node::Map(entries) if !entries.is_empty() => {
                text.push('\n');
                write_block(text, value, &path, indent + 2, comments);
            }
            Node::List(items) if matches!(items.first(), Some(Node::Map(_))) => {
                text.push('\n');
                for item in items {
                    let _ = write!(text, "{:indent$}  - ", "");
                    write_flow(text, item);
                    text.push('\n');
                }
            }
            value => {
                text.push(' ');
                write_flow(text, value);
                text.push('\n');
            }
        }
    }
}

fn write_flow(text: &mut String, node: &Node) {
    match node {
        Node::Null => text.push_str("null"),
        Node::Bool(value) => {
            let _ = write!(text, "{value}");
        }
        Node::Integer(value) => {
            let _ = write!(text, "{value}");
        }
        Node::Number(value) => text.push_str(&number(*value)),
        Node::Text(value) => text.push_str(&quoted(value)),
        Node::List(items) => {
            text.push('[');
            for (index, item) in items.iter().enumerate() {
                text.push_str(if index > 0 { ", " } else { "" });
                write_flow(text, item);
            }
            text.push(']');
        }
        Node::Map(entries) => {
            text.push('{');
            for (index, (key, value)) in entries.iter().enumerate() {
                let _ = write!(text, "{}{key}: ", if index > 0 { ", " } else { "" });
                write_flow(text, value);
            }
            text.push('}');
        }
    }
}

/// Checks the bytes against the rule, before anything is parsed; gives the text.
pub fn check<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Unreadable> {
    let text = plain_text(name, bytes)?;
    if !text.ends_with('\n') {
        let at = location_of(bytes);
        return Err(Unreadable::whole(name, Some(at), "no line feed at the end", "one", "was it copied to the end?"));
    }
    let mut line_start = 0;
    for line in text.split_inclusive('\n') {
        if let Some((offset, found, expected)) = first_fault(line.trim_end_matches('\n')) {
            let at = location_of(&bytes[..line_start + offset]);
            let advice = "the text is not as any issuer writes it";
            return Err(Unreadable::whole(name, Some(at), found, expected, advice));
        }
        line_start += line.len();
    }
    Ok(text)
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
