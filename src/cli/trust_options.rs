//! Options of trust: the trusted keys, and the question to verify for. Every verb uses this code, so the options are
//! the same everywhere.

use super::{Failure, output};
use crate::earth::Place;
use crate::files;
use crate::passport::{Question, Trust};
use crate::revocation::{RevocationList, Series, claims_to_be_a_list};
use crate::text::name_of;
use crate::text::scalar::{day, impossible_date};
use crate::trust::{AllowedSigners, LARGEST_TRUST_FILE_BYTES, RevokedKeys};
use clap::Args;
use jiff::Timestamp;
use jiff::civil::Date;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct TrustFiles {
    /// Trusted signing keys: an OpenSSH allowed_signers file
    #[arg(long, value_name = "SIGNERS")]
    trust: PathBuf,
    /// Revocations: an OpenSSH KRL, a list of public keys, or a list of withdrawn passports (repeatable)
    #[arg(long, value_name = "FILE")]
    revoked: Vec<PathBuf>,
}

#[derive(Args)]
pub(super) struct Asked {
    /// Require this issuer
    #[arg(long, value_name = "WHO")]
    issuer: Option<String>,
    /// Require this serial number; read it from the stand
    #[arg(long, value_name = "S")]
    serial: Option<String>,
    /// Place of the stand: latitude and longitude in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = place, allow_hyphen_values = true)]
    at: Option<Place>,
    /// Verify as of this time: RFC 3339, or a UTC date (00:00) [default: now]
    #[arg(long, value_name = "TIME", value_parser = time)]
    time: Option<Timestamp>,
}

#[derive(Args)]
pub(super) struct TrustOptions {
    #[command(flatten)]
    files: TrustFiles,
    #[command(flatten)]
    asked: Asked,
}

/// Options of trust of a verb that also works without a passport.
#[derive(Args)]
pub(super) struct OptionalTrust {
    /// Trusted signing keys: an OpenSSH allowed_signers file
    #[arg(long, value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Revocations: an OpenSSH KRL, a list of public keys, or a list of withdrawn passports (repeatable)
    #[arg(long, value_name = "FILE", requires = "trust")]
    revoked: Vec<PathBuf>,
    #[command(flatten)]
    asked: Asked,
}

impl OptionalTrust {
    /// Returns the trust and the question, or `None` if no `--trust` is given.
    pub(super) fn load(&self) -> Result<Option<(Trust, Question)>, Failure> {
        let question = self.asked.question();
        let Some(signers) = &self.trust else { return Ok(None) };
        Ok(Some((load(signers, &self.revoked, question.time)?, question)))
    }
}

impl TrustOptions {
    pub(super) fn load(&self) -> Result<(Trust, Question), Failure> {
        let question = self.asked.question();
        Ok((load(&self.files.trust, &self.files.revoked, question.time)?, question))
    }
}

impl Asked {
    pub(super) fn question(&self) -> Question {
        Question {
            time: self.time.unwrap_or_else(now),
            issuer: self.issuer.clone(),
            serial: self.serial.clone(),
            place: self.at,
        }
    }
}

/// Reads the trust files. Lists of withdrawn passports are verified at `time`; the newest list applies.
pub(super) fn load(signers: &Path, revoked: &[PathBuf], time: Timestamp) -> Result<Trust, Failure> {
    let read = |path: &Path| files::read(path, LARGEST_TRUST_FILE_BYTES).map_err(Failure::file);
    let name = |path: &Path| name_of(path);
    let mut trust = Trust::of(AllowedSigners::parse(&name(signers), &read(signers)?).map_err(Failure::unreadable)?);
    let mut lists = Vec::new();
    for path in revoked {
        let bytes = read(path)?;
        if claims_to_be_a_list(&bytes) {
            lists.push((name(path), bytes));
        } else {
            trust.revoked.push(RevokedKeys::parse(&name(path), &bytes).map_err(Failure::unreadable)?);
        }
    }
    let verified = lists.iter().map(|(name, bytes)| {
        RevocationList::verify(name, bytes, &trust.signers, &trust.revoked, time).map_err(Failure::unusable)
    });
    let series = Series::of(verified.collect::<Result<_, _>>()?);
    for alarm in series.alarms().iter().filter(|alarm| alarm.is_contradiction()) {
        output::complain(&format!("ALARM: {alarm}; passports withdrawn by any of the lists are treated as withdrawn"));
    }
    if let Some(alarm) = series.alarms().iter().find(|alarm| alarm.is_unknown()) {
        return Err(Failure::unusable(format!("{alarm}; specify that list too, with --revoked")));
    }
    trust.withdrawn = series;
    Ok(trust)
}

/// Parses a time given as an option.
pub(super) fn time(text: &str) -> Result<Timestamp, String> {
    if let Ok(date) = date(text) {
        return Ok(day(date).0);
    }
    if let Some(words) = impossible_date(text.get(..10).unwrap_or(text)) {
        return Err(words);
    }
    match text.parse::<Timestamp>() {
        Ok(time) if time.subsec_nanosecond() == 0 => Ok(time),
        Ok(_) => Err("whole seconds, such as 2026-11-02T09:30:00Z".to_owned()),
        Err(_) => Err("a time such as 2026-11-02T09:30:00Z, or a UTC date such as 2026-11-02".to_owned()),
    }
}

/// Parses a date given as an option. A date with a time but no zone is rejected, because the time zone is unknown.
pub(super) fn date(text: &str) -> Result<Date, String> {
    let date = text.parse::<Date>().ok().filter(|date| date.to_string() == text);
    date.ok_or_else(|| impossible_date(text).unwrap_or_else(|| "a UTC date such as 2026-11-02".to_owned()))
}

pub(super) fn place(text: &str) -> Result<Place, String> {
    const FORM: &str = "two numbers with decimal points, such as 55.7658,37.6856";
    let (latitude, longitude) = text.split_once(',').ok_or(FORM)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| FORM.to_owned());
    let (latitude_deg, longitude_deg) = (number(latitude)?, number(longitude)?);
    if !(-90.0..=90.0).contains(&latitude_deg) {
        return Err(format!("latitude {latitude_deg}, expected -90 to 90"));
    }
    if !(-180.0..=180.0).contains(&longitude_deg) {
        return Err(format!("longitude {longitude_deg}, expected -180 to 180"));
    }
    Ok(Place { latitude_deg, longitude_deg })
}

/// Returns the current time in whole seconds, as passports state it.
pub(super) fn now() -> Timestamp {
    let now = Timestamp::now();
    Timestamp::from_second(now.as_second()).unwrap_or(now)
}
