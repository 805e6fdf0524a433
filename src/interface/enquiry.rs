//! Whom to trust and what to ask, and the answer on each passport.

use super::{Asked, Failed, Verdict, json};
use crate::earth::Place;
#[cfg(feature = "factory")]
use crate::files::{self, FileError};
#[cfg(feature = "factory")]
use crate::folder::Registers;
#[cfg(feature = "factory")]
use crate::parallel;
#[cfg(feature = "factory")]
use crate::passport::verification;
use crate::passport::{Question, Trust, Verification, verify};
use crate::register::{RegisterRefused, VerifiedRegister};
use crate::site::beyond_180;
use crate::text::scalar::day;
use crate::text::{Field, LARGEST_DOCUMENT_BYTES, Node, Path, Problems, name_of};
use crate::trust::{AllowedSigners, RevokedKeys};
use jiff::Timestamp;
use jiff::civil::{Date, DateTime};
use std::path::{Path as FilePath, PathBuf};

/// Trusted keys and the question to verify passports for.
#[derive(Debug)]
pub struct Enquiry {
    /// Trusted keys, without what is revoked.
    pub trust: Trust,
    /// Question to verify passports for.
    pub question: Question,
    pub(crate) register: Option<Source>,
}

/// Registers that are asked.
#[derive(Debug)]
pub(crate) enum Source {
    /// Verified register, or the reason why it is not accepted.
    Given(Box<Result<VerifiedRegister, RegisterRefused>>),
    /// Register in a file, or that of each stand in a folder.
    #[cfg(feature = "factory")]
    Files(Registers),
}

/// Answer on one passport.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Name of the file.
    pub file: String,
    /// Every check, and the content if all passed.
    pub verification: Verification,
    /// SHA-256 of the whole file, in lower-case hexadecimal.
    pub sha256: String,
    /// Time for which the passport was verified.
    pub time: Timestamp,
    /// Remarks for the user on the registers that were read, one sentence each.
    pub remarks: Vec<String>,
}

impl Answer {
    /// Returns the verdict as JSON: `{file, valid, id, not_asked, remarks, checks: [{name, passed, code, detail}]}`.
    pub fn to_json(&self) -> String {
        json(&Verdict::of(&self.file, &self.verification, &self.remarks))
    }
}

impl Enquiry {
    /// Creates an enquiry that trusts `signers`, the name and content of an allowed_signers file.
    ///
    /// `revoked` are names and contents of lists of revoked keys: OpenSSH KRLs, lists of public keys. `question` is JSON,
    /// `{time, serial, at: [latitude, longitude], issuer, revoked: [text or bytes, …], register: text or bytes}`, in which
    /// every key may be absent, but not null: `time` in RFC 3339 or as a UTC date, by default `now`; `at` in degrees.
    ///
    /// # Errors
    /// Returns [`Failed`] if the question, the signers or a list of revoked keys cannot be used.
    pub fn new(
        signers: (&str, &[u8]),
        revoked: &[(String, Vec<u8>)],
        question: &str,
        now: Timestamp,
    ) -> Result<Self, Failed> {
        let mut asked = Asked::new("question", question)?;
        let (given, at) = (asked.key("time", String::read), asked.key("at", Vec::read));
        let (serial, issuer) = (asked.key("serial", name), asked.key("issuer", name));
        let listed = asked.key("revoked", lists).unwrap_or_default();
        let register = asked.key("register", content);
        asked.done()?;
        let given = given.map(|text| read("time", &text, time)).transpose()?;
        let now = Timestamp::from_second(now.as_second()).unwrap_or(now);
        let time = given.unwrap_or(now);
        let place = at.map(|at: Vec<f64>| match at[..] {
            [latitude_deg, longitude_deg] => place(latitude_deg, longitude_deg),
            _ => Err(format!("found {at:?}, expected [latitude, longitude] in degrees")),
        });
        let place = place.transpose().map_err(|why| Failed::unusable(format!("at: {why}")))?;
        let listed = listed.into_iter().enumerate().map(|(index, list)| (format!("revoked[{index}]"), list));
        let revoked: Vec<_> = revoked.iter().cloned().chain(listed).collect();
        let enquiry = Self::of(trust(signers, &revoked)?, Question { time, now, issuer, serial, place });
        Ok(match register {
            Some(bytes) => enquiry.with_register_text("register", &bytes),
            None => enquiry,
        })
    }

    /// Creates an enquiry without a register.
    pub(crate) fn of(trust: Trust, question: Question) -> Self {
        Self { trust, question, register: None }
    }

    /// Adds the register of the stand, the content of a file of this name. One that is not accepted makes no passport valid.
    #[must_use]
    pub fn with_register_text(self, name: &str, bytes: &[u8]) -> Self {
        let register = VerifiedRegister::verify(name, bytes, &self.trust, self.question.now);
        Self { register: Some(Source::Given(Box::new(register))), ..self }
    }

    /// Adds the registers at `path`: a register, or a folder of passports that has the register of each stand as
    /// `<model>/<serial>/register.yaml`, or of one stand as `register.yaml`. Each is read when it is first asked.
    #[cfg(feature = "factory")]
    #[must_use]
    pub fn with_register(self, path: &FilePath) -> Self {
        let registers = Registers::new(path, self.trust.clone(), self.question.now, None);
        self.with_registers(registers)
    }

    #[cfg(feature = "factory")]
    pub(crate) fn with_registers(self, registers: Registers) -> Self {
        Self { register: Some(Source::Files(registers)), ..self }
    }

    /// Verifies the bytes of a passport; `file` is the file name in messages.
    pub fn verify(&self, file: &str, bytes: &[u8]) -> Answer {
        self.answer(file, self.verification(file, bytes))
    }

    fn answer(&self, file: &str, verification: Verification) -> Answer {
        let sha256 = verification.sha256().to_owned();
        Answer { file: file.to_owned(), verification, sha256, time: self.question.time, remarks: self.remarks() }
    }

    /// Returns the remarks on skipped keys and on the registers that were read.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let of_registers = match &self.register {
            #[cfg(feature = "factory")]
            Some(Source::Files(registers)) => registers.remarks(),
            _ => Vec::new(),
        };
        self.trust.skipped().into_iter().chain(of_registers).collect()
    }

    pub(crate) fn verification(&self, file: &str, bytes: &[u8]) -> Verification {
        self.in_register(verify(file, bytes, &self.trust, &self.question))
    }

    /// Returns the result for a file that could not be read; `why` is the system's error message.
    #[cfg(feature = "factory")]
    pub(crate) fn unreadable(&self, why: &str) -> Verification {
        self.in_register(verification::unreadable(why, &self.trust, &self.question))
    }

    fn in_register(&self, verification: Verification) -> Verification {
        match &self.register {
            Some(Source::Given(register)) => {
                verification.with_register(register.as_ref().as_ref().map(|register| (register, None)), &self.question)
            }
            #[cfg(feature = "factory")]
            Some(Source::Files(registers)) => registers.asked(verification, &self.question),
            None => verification,
        }
    }

    /// Verifies files on up to `threads` threads (0: one for each processor); the answers are in the order of the
    /// paths, each with the bytes of the file. A file that cannot be read is not valid.
    #[cfg(feature = "factory")]
    pub fn verify_files(&self, paths: &[PathBuf], threads: usize) -> Vec<(Answer, Result<Vec<u8>, FileError>)> {
        let threads = if threads == 0 { parallel::processors() } else { threads };
        parallel::map(paths, threads, |path| {
            // One byte above the size limit is enough to show that the file is not a passport.
            let (name, bytes) = (name_of(path), files::read_first(path, LARGEST_DOCUMENT_BYTES + 1));
            let answer = match &bytes {
                Ok(bytes) => self.verify(&name, bytes),
                Err(error) => self.answer(&name, self.unreadable(&error.to_string())),
            };
            (answer, bytes)
        })
    }
}

/// Reads a name that is asked for or stated. An empty one would ask or state nothing.
pub(super) fn name(node: &Node, at: &Path, problems: &mut Problems) -> Option<String> {
    let name = String::read(node, at, problems)?;
    if name.trim().is_empty() {
        problems.at(at, "empty text", "text", "leave the key out otherwise");
        return None;
    }
    Some(name)
}

/// Returns the content of a file, given as text or as a list of its bytes; `None` for another value.
fn content_of(node: &Node) -> Option<Vec<u8>> {
    let byte = |node: &Node| if let Node::Integer(byte) = node { u8::try_from(*byte).ok() } else { None };
    match node {
        Node::Text(text) => Some(text.clone().into_bytes()),
        Node::List(bytes) => bytes.iter().map(byte).collect(),
        _ => None,
    }
}

fn content(node: &Node, at: &Path, problems: &mut Problems) -> Option<Vec<u8>> {
    or_refused(content_of(node), (node, at), "the content of a register, its text or a list of its bytes", problems)
}

/// Reads lists of revoked keys, each as text or as a list of its bytes.
fn lists(node: &Node, at: &Path, problems: &mut Problems) -> Option<Vec<Vec<u8>>> {
    let lists = if let Node::List(all) = node { all.iter().map(content_of).collect() } else { None };
    let expected = "a list of revocations (KRLs or lists), each its text or a list of its bytes";
    or_refused(lists, (node, at), expected, problems)
}

/// Returns what was read from a value, or says what was expected instead of it.
pub(super) fn or_refused<T>(
    read: Option<T>,
    (node, at): (&Node, &Path),
    expected: &str,
    problems: &mut Problems,
) -> Option<T> {
    if read.is_none() {
        problems.at(at, node.describe(), expected, "");
    }
    read
}

/// Returns the trust in `signers` without what `revoked` revokes. The files are names and contents.
pub(crate) fn trust(signers: (&str, &[u8]), revoked: &[(String, Vec<u8>)]) -> Result<Trust, Failed> {
    let mut trust = Trust::of(AllowedSigners::parse(signers.0, signers.1)?);
    for (name, bytes) in revoked {
        trust.revoked.push(RevokedKeys::parse(name, bytes)?);
    }
    Ok(trust)
}

/// Reads the text of a key, with a parser whose errors end a sentence about what was found.
pub(super) fn read<T>(key: &str, text: &str, parse: fn(&str) -> Result<T, String>) -> Result<T, Failed> {
    parse(text).map_err(|why| Failed::unusable(format!("{key}: found {text:?}; {why}")))
}

/// Expected form of a time.
const TIME: &str = "expected a time such as 2026-11-02T09:30:00Z, or a UTC date such as 2026-11-02";

/// Parses a time, or a date, which is its first second in UTC.
pub(crate) fn time(text: &str) -> Result<Timestamp, String> {
    if let Ok(date) = date(text) {
        return Ok(day(date).0);
    }
    match text.parse::<Timestamp>() {
        Ok(time) if time.subsec_nanosecond() == 0 => Ok(time),
        Ok(_) => Err("expected whole seconds, such as 2026-11-02T09:30:00Z".to_owned()),
        Err(_) if text.contains(':') && text.parse::<DateTime>().is_ok() => {
            Err("the time zone is missing; for UTC, write Z at the end, as in 2026-11-02T09:30:00Z".to_owned())
        }
        Err(_) => Err(TIME.to_owned()),
    }
}

/// Parses a date. A date with a time but no zone is rejected, because the time zone is unknown.
pub(crate) fn date(text: &str) -> Result<Date, String> {
    let date = text.parse::<Date>().ok().filter(|date| date.to_string() == text);
    date.ok_or_else(|| "expected a UTC date such as 2026-11-02".to_owned())
}

/// Parses a place: latitude and longitude as decimal degrees, or in degrees, minutes and seconds with the letters of the
/// hemispheres. A semicolon between them permits decimal commas.
#[cfg(feature = "cli")]
pub(crate) fn place_of(text: &str) -> Result<Place, String> {
    const FORM: &str = "expected two numbers with decimal points, such as 55.7658,37.6856, or 55°45′56″N,37°41′08″E";
    let (latitude, longitude) = match (text.split_once(';'), text.matches(',').count()) {
        (Some((latitude, longitude)), _) => (latitude.replace(',', "."), longitude.replace(',', ".")),
        (None, 1) => text.split_once(',').map(|(one, other)| (one.to_owned(), other.to_owned())).ok_or(FORM)?,
        (None, 0) => return Err(FORM.to_owned()),
        (None, _) => return Err("with decimal commas, put a semicolon between the two: 55,7658; 37,6856".to_owned()),
    };
    let latitude_deg = angle(&latitude, ['N', 'S']).ok_or(FORM)?;
    let longitude_deg = angle(&longitude, ['E', 'W']).ok_or(FORM)?;
    place(latitude_deg, longitude_deg).map_err(|refused| match text.contains(['.', ';', '°']) {
        true => refused,
        // A decimal comma splits a number in two.
        false => format!("{refused}; the decimal mark is a point, as in 55.7658,37.6856"),
    })
}

/// Reads one coordinate, degrees; `letters` are those of its positive and of its negative side. Minutes need a letter: without
/// it, a southern latitude would be one of the north.
#[cfg(feature = "cli")]
fn angle(text: &str, letters: [char; 2]) -> Option<f64> {
    let text = text.trim();
    let side = letters.into_iter().position(|letter| text.ends_with(letter));
    let digits = text.trim_end_matches(letters).trim_end();
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let Some((degrees, rest)) = digits.split_once('°') else {
        let value = number(digits)?;
        return match side {
            None => Some(value),
            Some(side) => (value >= 0.0 && !digits.starts_with('-')).then_some(if side == 0 { value } else { -value }),
        };
    };
    let whole = |text: &str| text.trim().parse::<u16>().ok().map(f64::from);
    let sixtieth = |text: &str| number(text).filter(|part| (0.0..60.0).contains(part) && !text.contains(['-', '+']));
    let rest = rest.trim().replace(['\'', '’'], "′").replace(['"', '”'], "″").replace("′′", "″");
    let value = match rest.split_once('′') {
        None if rest.is_empty() => number(degrees).filter(|_| !degrees.contains(['-', '+']))?,
        None => return None,
        Some((minutes, seconds)) if seconds.trim().is_empty() => whole(degrees)? + sixtieth(minutes)? / 60.0,
        Some((minutes, seconds)) => {
            let seconds = sixtieth(seconds.trim().strip_suffix('″')?)?;
            whole(degrees)? + (whole(minutes).filter(|minutes| *minutes < 60.0)? * 60.0 + seconds) / 3600.0
        }
    };
    Some(if side? == 0 { value } else { -value })
}

/// Checks the place of a question, degrees.
pub(crate) fn place(latitude_deg: f64, longitude_deg: f64) -> Result<Place, String> {
    if !(-90.0..=90.0).contains(&latitude_deg) {
        return Err(format!("latitude {latitude_deg}, expected -90 to 90; give the latitude first"));
    }
    if !(-180.0..=180.0).contains(&longitude_deg) {
        let advice = beyond_180(longitude_deg).map_or_else(String::new, |advice| format!("; {advice}"));
        return Err(format!("longitude {longitude_deg}, expected -180 to 180{advice}"));
    }
    Ok(Place { latitude_deg, longitude_deg })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGNERS: (&str, &[u8]) = ("allowed_signers", include_bytes!("../../docs/allowed_signers"));

    fn ask(question: &str) -> Result<Enquiry, Failed> {
        Enquiry::new(SIGNERS, &[], question, "2026-11-20T00:00:00Z".parse().unwrap())
    }

    /// Expected: each angle in degrees, by hand; 45′ 56″ are 2756″, of which 3600 make a degree.
    #[cfg(feature = "cli")]
    #[test]
    fn a_place_is_written_in_several_ways() {
        let dms = (55.0 + 2756.0 / 3600.0, 37.0 + 2468.0 / 3600.0);
        for (text, due) in [
            ("55.7658,37.6856", (55.7658, 37.6856)),
            ("-33.8688, 151.2093", (-33.8688, 151.2093)),
            ("33.8688S,151.2093 E", (-33.8688, 151.2093)),
            ("55,7658; 37,6856", (55.7658, 37.6856)),
            ("55°45′56″N,37°41′08″E", dms),
            ("55°45'56\"N, 37° 41' 8\" E", dms),
            ("55°45'56''N,37°41'8.0''E", dms),
            ("55°30′S; 37°W", (-55.5, -37.0)),
        ] {
            let found = place_of(text).unwrap_or_else(|why| panic!("{text}: {why}"));
            assert_eq!((found.latitude_deg, found.longitude_deg), due, "{text}");
        }
        for text in [
            "",
            "55.7",
            "55,7658,37,6856",
            "55°45′56″,37°41′08″",
            "-55°45′56″N,37°E",
            "55°60′00″N,37°E",
            "55°45′60″N,37°E",
            "37°E,55°N",
            "-33.8S,151",
            "55°45N,37°E",
            "inf,0",
            "NaN,0",
            "91,0",
            "5°-1′N,0°E",
            "55.5°45′N,37°E",
        ] {
            assert!(place_of(text).is_err(), "{text}");
        }
    }

    #[test]
    fn what_cannot_be_asked_is_refused_with_its_key() {
        for (question, words) in [
            ("", "not usable JSON"),
            (r#"{"times": "2026-11-20"}"#, "unknown key \"times\""),
            (r#"{"time": "tomorrow"}"#, "time: found \"tomorrow\"; expected a time such as"),
            (r#"{"time": "2026-02-30"}"#, "time: found \"2026-02-30\"; expected a time such as 2026-11-02T09:30:00Z"),
            (r#"{"time": "2026-11-20T10:00:00"}"#, "the time zone is missing"),
            (r#"{"time": "20261120"}"#, "time: found \"20261120\"; expected a time such as"),
            (r#"{"serial": 17}"#, "serial: found 17, expected text"),
            (r#"{"serial": " "}"#, "serial: found empty text"),
            (r#"{"serial": null}"#, "serial: found null, expected a value; leave the key out if it is not asked"),
            (r#"{"time": null}"#, "time: found null"),
            (r#"{"at": null}"#, "at: found null"),
            (r#"{"issuer": null}"#, "issuer: found null"),
            (r#"{"revoked": null}"#, "revoked: found null"),
            (r#"{"issuer": ""}"#, "issuer: found empty text"),
            (r#"{"time": "2026-11-20T10:00:00.5Z"}"#, "whole seconds"),
            (r#"{"at": [91, 0]}"#, "latitude 91"),
            (r#"{"at": [0, 181]}"#, "longitude 181"),
            (r#"{"serial": "0018", "serial": "0017"}"#, "duplicate key \"serial\""),
            (r#"["0017"]"#, "found a list of 1 item, expected a mapping with the keys time, at, serial"),
            (r#"{"at": [1e999, 0]}"#, "JSON"),
            (r#"{"at": [0]}"#, "at: found [0.0], expected [latitude, longitude]"),
            (r#"{"revoked": "rubbish"}"#, "revoked: found \"rubbish\", expected a list"),
            (
                r#"{"revoked": [[256]]}"#,
                "revoked: found a list of 1 item, expected a list of revocations (KRLs or lists), each",
            ),
            (r#"{"revoked": ["rubbish"]}"#, "revoked[0]"),
            (r#"{"revoked": [[83, 83, 72, 75, 82, 76, 10, 0]]}"#, "revoked[0]"),
        ] {
            let failed = ask(question).unwrap_err();
            assert!(failed.to_string().contains(words), "{question}: {failed}");
            let read: serde_json::Value = serde_json::from_str(&failed.to_json()).unwrap();
            assert!(read["error"]["message"].as_str().unwrap().contains(words));
        }
    }
}
