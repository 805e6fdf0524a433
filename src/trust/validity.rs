//! The dates of allowed signers (ssh-keygen(1), ALLOWED SIGNERS): `YYYYMMDD`, `YYYYMMDDHHMM` or `YYYYMMDDHHMMSS`, each
//! followed by `Z` for UTC.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::TimeZone;

/// Expected form of a date, and advice.
pub(super) type Refusal = (&'static str, &'static str);

/// Reads a date.
///
/// A date without `Z` is refused, because OpenSSH takes it in the verifier's local time, so that the result would
/// depend on the place. 30 February is refused too, because OpenSSH takes it for 2 March.
pub(super) fn instant(text: &str) -> Result<Timestamp, Refusal> {
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
    fn local_time_is_refused_with_the_reason() {
        let (_, advice) = instant("20260101").unwrap_err();
        assert!(advice.contains("each verifier"), "{advice}");
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
