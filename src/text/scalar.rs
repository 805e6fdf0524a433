//! Texts with a prescribed form: identifiers, dates, times and digests.

pub(crate) use super::characters::latin;

use super::characters::character;
use super::field::{Scalar, Sink, refuse};
use super::{Field, Node, Path, Problems};
use jiff::Timestamp;
use jiff::civil::Date;
use jiff::tz::TimeZone;
use sha2::{Digest, Sha256};
use std::fmt;
use std::str::FromStr;

/// Name that can be a folder or file name on every system: `[A-Za-z0-9][A-Za-z0-9._-]{0,63}` without `..`, without a
/// dot at the end, and not reserved by Windows.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(transparent))]
pub struct Identifier(#[cfg_attr(feature = "generate", schemars(regex(pattern = PATTERN)))] String);

#[cfg(feature = "generate")]
const PATTERN: &str = concat!(
    r"^(?!.*\.\.)(?!.*\.$)",
    r"(?!([Cc][Oo][Nn]|[Pp][Rr][Nn]|[Aa][Uu][Xx]|[Nn][Uu][Ll]|([Cc][Oo][Mm]|[Ll][Pp][Tt])[0-9])(\.|$))",
    r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}$"
);

/// Device names that Windows reserves in every folder, with or without an extension ("Naming Files, Paths, and
/// Namespaces", learn.microsoft.com); names of ports have one more digit.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
const PORTS: [&str; 2] = ["com", "lpt"];

/// Returns `true` if Windows takes a name for a device.
pub(crate) fn is_device(text: &str) -> bool {
    let name = text.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let is_port = |port: &&str| name.strip_prefix(*port).is_some_and(|rest| matches!(rest.as_bytes(), [b'0'..=b'9']));
    DEVICES.contains(&name.as_str()) || PORTS.iter().any(is_port)
}

/// Fault of a text that is not an [`Identifier`]; its words complete a message "found …, expected …".
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct NotAnIdentifier(String);

impl FromStr for Identifier {
    type Err = NotAnIdentifier;

    fn from_str(text: &str) -> Result<Self, NotAnIdentifier> {
        Self::new(text)
    }
}

impl Identifier {
    pub(crate) fn new(text: &str) -> Result<Self, NotAnIdentifier> {
        let odd = text.chars().find(|&c| !c.is_ascii_alphanumeric() && !"._-".contains(c));
        let fault = match (odd, text.chars().next()) {
            (Some(odd), _) => format!("{} in {text:?}", character(odd)),
            (_, None) => "empty text".to_owned(),
            (_, Some(first)) if !first.is_ascii_alphanumeric() => format!("{first:?} at the start of {text:?}"),
            _ if text.len() > 64 => format!("{} characters", text.len()),
            _ if text.contains("..") => format!("\"..\" in {text:?}"),
            _ if text.ends_with('.') => format!("a dot at the end of {text:?}"),
            _ if is_device(text) => format!("{text:?}, a device name of Windows"),
            _ => return Ok(Self(text.to_owned())),
        };
        Err(NotAnIdentifier(fault))
    }

    /// Returns the identifier as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// Returns the identifiers in a text that has one slash between them, such as model and serial number of a stand; `None` if
/// there is another number of them, or if a part is not an identifier.
pub(crate) fn identifiers<const N: usize>(text: &str) -> Option<[&str; N]> {
    let names: [&str; N] = text.split('/').collect::<Vec<_>>().try_into().ok()?;
    names.iter().all(|name| Identifier::new(name).is_ok()).then_some(names)
}

impl fmt::Display for Identifier {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Field for Identifier {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        const VALID: &str = "use a name that is valid for files and folders; put free text into name";
        let (found, advice) = match node {
            Node::Text(text) => match Self::new(text) {
                Ok(identifier) => return Some(identifier),
                Err(found) => (found.to_string(), VALID),
            },
            Node::Integer(_) | Node::Number(_) => {
                (format!("the number {}", node.describe()), "put it in double quotes")
            }
            other => (other.describe(), VALID),
        };
        problems.at(at, found, Self::expected(""), advice);
        None
    }

    fn expected(_: &str) -> String {
        "1 to 64 ASCII letters, digits, '.', '_' or '-', starting with a letter or digit, without '..', without '.' \
         at the end, and not a Windows device name"
            .to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Text(&self.0));
    }
}

/// Returns the value of a text that is exactly as the value is displayed.
fn exact<T: FromStr + fmt::Display>(node: &Node) -> Option<T> {
    let Node::Text(text) = node else { return None };
    text.parse().ok().filter(|value: &T| value.to_string() == *text)
}

impl Field for Date {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        if let Some(date) = exact(node) {
            return Some(date);
        }
        refuse(node, at, "write year, month and day of the calendar, in double quotes", problems)
    }

    fn expected(_: &str) -> String {
        "a date such as \"2026-11-02\"".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Text(&self.to_string()));
    }
}

impl Field for Timestamp {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        let time = exact(node).filter(|time: &Self| time.subsec_nanosecond() == 0);
        time.or_else(|| refuse(node, at, "use RFC 3339, UTC, whole seconds", problems))
    }

    fn expected(_: &str) -> String {
        "a time such as \"2026-11-02T09:30:00Z\"".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Text(&self.to_string()));
    }
}

/// Returns the first and the last second of a UTC day, both included.
///
/// The calendar of dates is slightly longer than the range of timestamps. "9999-12-31", an expiry date for unlimited
/// validity, ends with the last timestamp.
pub(crate) fn day(date: Date) -> (Timestamp, Timestamp) {
    let beyond = if date.year() > 0 { Timestamp::MAX } else { Timestamp::MIN };
    let start = TimeZone::UTC.to_timestamp(date.at(0, 0, 0, 0)).unwrap_or(beyond);
    let end = start.as_second().saturating_add(86_399);
    (start, Timestamp::from_second(end).unwrap_or(Timestamp::MAX))
}

/// Computes the SHA-256 of a file, in lower-case hexadecimal.
pub(crate) fn sha256_hex(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_safe_file_names() {
        for good in ["a", "SPS-2", "0017", "moscow-bmstu", "A.b_c-9", "con-1", "COM", "COM10", "lpt-1", "a.con", "nul1"]
        {
            assert!(Identifier::new(good).is_ok(), "{good}");
        }
        let long = "a".repeat(65);
        for bad in ["", "../x", "a..b", ".a", "-a", "a b", "а", "a/b", "a\\b", "a\0", &long, "é"] {
            assert!(Identifier::new(bad).is_err(), "{bad}");
        }
        // Expected: Windows stores none of them under its own name.
        for bad in ["CON", "con.1", "Prn", "aux.a.b", "NUL", "COM1", "com9.x", "LPT0", "a.", "a.b."] {
            assert!(Identifier::new(bad).is_err(), "{bad}");
        }
        assert!(Identifier::new("SPS-2А").unwrap_err().to_string().contains("Cyrillic"));
    }

    #[test]
    fn a_day_is_its_86400_seconds() {
        let (start, end) = day("2026-11-02".parse().unwrap());
        assert_eq!(start.to_string(), "2026-11-02T00:00:00Z");
        assert_eq!(end.to_string(), "2026-11-02T23:59:59Z");
        assert_eq!(day("9999-12-31".parse().unwrap()), (Timestamp::MAX, Timestamp::MAX));
        assert_eq!(day("9999-12-30".parse().unwrap()).1, Timestamp::MAX);
        assert!(day(Date::MIN).1 < day("0001-01-01".parse().unwrap()).0);
    }
}
