//! A line of allowed signers (ssh-keygen(1), ALLOWED SIGNERS): `principals [options] key-type base64-key [comment]`.

use super::lines::Line;
use super::principal::LONGEST_PATTERN;
use super::public_key::{AnyKey, shortened};
use super::{KeyError, KeyPoint, PublicKey};
use crate::text::RefusalCause;
use crate::text::problem::{MOST_COUNTED, Problem};
use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::TimeZone;
use std::sync::OnceLock;

/// Key with the principals, namespaces and validity period that it is trusted for.
#[derive(Debug, Clone)]
pub(crate) struct SignerLine {
    /// Patterns of the principals that the key may sign as.
    pub(crate) principals: String,
    pub(crate) options: Options,
    pub(crate) key: PublicKey,
    /// Curve point of the key, decoded at the first request.
    pub(super) point: OnceLock<Option<KeyPoint>>,
}

/// Namespaces and validity period that a key is trusted for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Options {
    /// Patterns of the namespaces that the key may sign for; any namespace if `None`.
    pub(crate) namespaces: Option<String>,
    /// First instant of the validity period; unlimited if `None`.
    pub(crate) valid_after: Option<Timestamp>,
    /// Last instant of the validity period; unlimited if `None`.
    pub(crate) valid_before: Option<Timestamp>,
}

/// Reads a line and reports every error in it. Of a line with a key that cannot sign passports, returns the type of that
/// key instead.
pub(super) fn read(line: &Line) -> Result<Result<SignerLine, String>, Vec<Problem>> {
    if let Some(problem) = line.control_character() {
        return Err(vec![problem]);
    }
    let mut problems = Vec::new();
    let start = blanks(line.text, 0);
    let first = word(line.text, start);
    if AnyKey::is_type(first) {
        let advice = "put the signer's identity before the key; `keygen` prints the whole line";
        return Err(vec![line.problem(start, "principals", format!("key type {first}"), "a name", advice)]);
    }
    let (principals, at) = principals(line, start).map_err(|problem| vec![problem])?;
    let blank = |at: usize, found: &str| {
        vec![line.problem(
            at,
            "",
            found,
            "principals, options and the key, separated by one space each",
            RefusalCause::OptionBlank,
        )]
    };
    if principals.ends_with(',') {
        return Err(blank(at, "a space in the list of principals"));
    }
    check_patterns(line, start, "principals", &principals, &mut problems);
    let mut options = Options::default();
    let mut key_at = at;
    if !AnyKey::is_type(word(line.text, at)) && read_key(line, at).is_err() {
        let unclosed = |quote| line.problem(at + quote, "", "a quote that is not closed", "a closing quote", "");
        let end = at + length_before(&BLANKS, &line.text[at..]).map_err(|quote| vec![unclosed(quote)])?;
        key_at = blanks(line.text, end);
        let next = word(line.text, key_at);
        let continues = line.text[..end].ends_with([',', '=']) || next.contains([',', '"']) || next.starts_with('=');
        if continues && !AnyKey::is_type(next) && !line.text[at..end].contains("cert-authority") {
            return Err(blank(end, "a space between or within the options"));
        }
        options.read(line, at, end, &mut problems);
    }
    match read_key(line, key_at) {
        Ok(_) if !problems.is_empty() => Err(problems),
        Ok(AnyKey::Signing(key)) => Ok(Ok(SignerLine { principals, options, key, point: OnceLock::new() })),
        Ok(AnyKey::Other { algorithm, .. }) => Ok(Err(algorithm)),
        Err(problem) => {
            problems.push(problem);
            Err(problems)
        }
    }
}

const BLANKS: [char; 2] = [' ', '\t'];

/// Returns the end of the whitespace that begins at `at`.
fn blanks(text: &str, at: usize) -> usize {
    let rest = &text[at..];
    text.len() - rest.trim_start_matches(BLANKS).len()
}

fn word(text: &str, at: usize) -> &str {
    text[at..].split(BLANKS).next().unwrap_or_default()
}

/// Returns the principals without their quotes, and the position of the next word.
fn principals(line: &Line, start: usize) -> Result<(String, usize), Problem> {
    let text = line.text;
    let (value, end) = match text[start..].strip_prefix('"') {
        Some(quoted) => {
            let length = quoted.find('"').ok_or_else(|| {
                line.problem(start, "principals", "a quote that is not closed", "a closing quote", "")
            })?;
            (&quoted[..length], start + length + 2)
        }
        None => {
            let unquoted = word(text, start);
            if let Some(quote) = unquoted.find('"') {
                let advice = "put quotes around the whole list of principals, or omit them";
                return Err(line.problem(start + quote, "principals", "a quote within the list", "no quote", advice));
            }
            (unquoted, start + unquoted.len())
        }
    };
    let next = blanks(text, end);
    if next == end && next < text.len() {
        return Err(line.problem(end, "principals", "text immediately after the closing quote", "a space", ""));
    }
    Ok((value.to_owned(), next))
}

/// Reports an empty list of patterns, and patterns too long for OpenSSH.
fn check_patterns(line: &Line, at: usize, field: &str, list: &str, problems: &mut Vec<Problem>) {
    if list.is_empty() {
        problems.push(line.problem(at, field, "an empty list", "at least one pattern", "use * for any"));
    }
    if let Some(long) = list.split(',').find(|pattern| pattern.len() > LONGEST_PATTERN) {
        let (found, expected) = (format!("a pattern of {} bytes", long.len()), format!("at most {LONGEST_PATTERN}"));
        let advice = "use shorter patterns, because OpenSSH does not match longer ones";
        problems.push(line.problem(at, field, found, expected, advice));
    }
}

/// Returns the length of a text up to the first of these characters outside quotes, or the place of a quote that is not
/// closed.
fn length_before(ends: &[char], text: &str) -> Result<usize, usize> {
    let (mut quote, mut escaped) = (None, false);
    for (index, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = text[index + 1..].starts_with('"'),
            '"' if quote.is_some() => quote = None,
            '"' => quote = Some(index),
            _ if quote.is_none() && ends.contains(&c) => return Ok(index),
            _ => {}
        }
    }
    quote.map_or(Ok(text.len()), Err)
}

impl Options {
    fn read(&mut self, line: &Line, start: usize, end: usize, problems: &mut Vec<Problem>) {
        let mut seen = Vec::new();
        let mut at = start;
        while at < end && problems.len() < MOST_COUNTED {
            let length = length_before(&[','], &line.text[at..end]).unwrap_or(end - at);
            if let Err(problem) = self.read_option(line, at, &line.text[at..at + length], &mut seen, problems) {
                problems.push(problem);
            }
            at += length;
            if line.text[at..end].starts_with(',') {
                at += 1;
                if at == end {
                    problems.push(line.problem(at, "", "nothing after a comma", "another option", "delete the comma"));
                }
            }
        }
        if let (Some(after), Some(before)) = (self.valid_after, self.valid_before)
            && before <= after
        {
            let (expected, advice) =
                (format!("a time after valid-after, {after}"), "exchange or correct the two times");
            problems.push(line.problem(start, "valid-before", before.to_string(), expected, advice));
        }
    }

    /// Reads one option whose name is not among those already `seen`; as in OpenSSH, it may be in upper or lower case.
    fn read_option(
        &mut self,
        line: &Line,
        at: usize,
        option: &str,
        seen: &mut Vec<String>,
        problems: &mut Vec<Problem>,
    ) -> Result<(), Problem> {
        let (name, value) = option.split_once('=').map_or((option, None), |(name, value)| (name, Some(value)));
        let name = name.to_ascii_lowercase();
        let value_at = at + name.len() + 1;
        if seen.contains(&name) {
            return Err(line.problem(at, &name, "a duplicate option", "each option once", "delete one"));
        }
        seen.push(name.clone());
        match (name.as_str(), value) {
            ("namespaces", Some(value)) => {
                let list = unquoted(line, value_at, &name, value)?;
                check_patterns(line, value_at, &name, &list, problems);
                self.namespaces = Some(list);
            }
            ("valid-after", Some(value)) => self.valid_after = Some(date(line, value_at, &name, value)?),
            ("valid-before", Some(value)) => self.valid_before = Some(date(line, value_at, &name, value)?),
            ("namespaces" | "valid-after" | "valid-before", None) => {
                let expected = format!("{name}=\"…\"");
                return Err(line.problem(at, &name, "no value", expected, "write its value in double quotes"));
            }
            ("cert-authority", None) => {
                let advice = "list each signing key, because an authority could certify further keys that this list does \
                              not show";
                return Err(line.problem(at, "", "cert-authority", "a key that signs directly", advice));
            }
            _ => {
                let expected =
                    "namespaces=\"…\", valid-after=\"…\", valid-before=\"…\" or a key such as ssh-ed25519 AAAA…";
                let advice = "write the line as: principals, options separated by commas, key";
                return Err(line.problem(at, "", code(option), expected, advice));
            }
        }
        Ok(())
    }
}

/// Returns the beginning of a word as code, or `nothing` for an empty one.
fn code(word: &str) -> String {
    if word.is_empty() { "nothing".to_owned() } else { format!("`{}`", shortened(word)) }
}

/// Returns the value of an option without its quotes; `\"` is a quote.
fn unquoted(line: &Line, at: usize, field: &str, value: &str) -> Result<String, Problem> {
    let inner =
        value.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map(|inner| inner.replace("\\\"", "\u{0}"));
    match inner {
        Some(inner) if !inner.contains('"') => Ok(inner.replace('\u{0}', "\"")),
        _ => Err(line.problem(at, field, code(value), "a value in double quotes", "write it as \"dtg-passport\"")),
    }
}

fn date(line: &Line, at: usize, field: &str, value: &str) -> Result<Timestamp, Problem> {
    let text = unquoted(line, at, field, value)?;
    instant(&text)
        .map_err(|(expected, advice)| line.problem(at, field, format!("\"{}\"", shortened(&text)), expected, advice))
}

/// Reads a date: `YYYYMMDD`, `YYYYMMDDHHMM` or `YYYYMMDDHHMMSS`, each followed by `Z` for UTC; or returns the expected
/// form and advice.
///
/// A date without `Z` is refused, because OpenSSH takes it in the verifier's local time, so that the result would
/// depend on the place. 30 February is refused too, because OpenSSH takes it for 2 March.
fn instant(text: &str) -> Result<Timestamp, (&'static str, &'static str)> {
    const EXPECTED: &str = "a date in UTC as YYYYMMDDZ, YYYYMMDDHHMMZ or YYYYMMDDHHMMSSZ";
    let digits = text.strip_suffix(['Z', 'z']).unwrap_or(text);
    if !matches!(digits.len(), 8 | 12 | 14) || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err((EXPECTED, "write it as \"20260131Z\""));
    }
    if digits.len() == text.len() {
        return Err((
            "a date in UTC, with a Z at the end",
            "add the Z; without it each verifier would apply its own local time",
        ));
    }
    let part = |from: usize, to: usize| digits.get(from..to).and_then(|part| part.parse().ok()).unwrap_or(0_i8);
    let year = digits[..4].parse().unwrap_or(0);
    DateTime::new(year, part(4, 6), part(6, 8), part(8, 10), part(10, 12), part(12, 14), 0)
        .and_then(|date| date.to_zoned(TimeZone::UTC))
        .map(|zoned| zoned.timestamp())
        .ok()
        .filter(|instant| instant.as_second() > 0)
        .ok_or(("a calendar date after 1 January 1970", "use a date and a time that exist"))
}

/// Reads the key that begins at `at`, in a line of any trust file.
pub(super) fn read_key(line: &Line, at: usize) -> Result<AnyKey, Problem> {
    const EXPECTED: &str = "a public key such as ssh-ed25519 AAAA…";
    let algorithm = word(line.text, at);
    let base64_at = blanks(line.text, at + algorithm.len());
    let base64 = word(line.text, base64_at);
    if base64.is_empty() {
        let found =
            if algorithm.is_empty() { "nothing".to_owned() } else { format!("only `{}`", shortened(algorithm)) };
        return Err(line.problem(at, "key", found, EXPECTED, "copy the whole line of the .pub file"));
    }
    AnyKey::read(algorithm, base64).map_err(|error| match error {
        KeyError::NotAPublicKey(found) => {
            line.problem(at, "key", found, EXPECTED, "copy the whole line of the .pub file")
        }
        KeyError::DamagedPublicKey(reason) => {
            let found = format!("damaged public key ({reason})");
            line.problem(base64_at, "key", found, "a complete public key", "copy the whole line of the .pub file again")
        }
        other => line.problem(at, "key", other.to_string(), EXPECTED, ""),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(text: &str) -> Option<i64> {
        instant(text).ok().map(Timestamp::as_second)
    }

    #[test]
    fn dates_in_utc_are_read() {
        assert_eq!(seconds("20260101Z"), Some(1_767_225_600));
        assert_eq!(seconds("202601010130Z"), Some(1_767_225_600 + 5400));
        assert_eq!(seconds("20260101013007z"), Some(1_767_225_600 + 5407));
        assert_eq!(seconds("20240229Z"), Some(1_709_164_800));
    }

    #[test]
    fn what_is_no_date_is_refused() {
        for text in [
            "",
            "Z",
            "2026Z",
            "2026010Z",
            "20260230Z",
            "20261301Z",
            "202601012460Z",
            "20260101235960Z",
            "19700101Z",
            "19690101Z",
            "00000000Z",
            "2026-01-01Z",
            "0x69550000",
            "+2026010Z",
            "20260101UTC",
            "20260101 Z",
            "20260101ZZ",
            "２0260101Z",
        ] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
