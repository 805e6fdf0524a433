//! Options of trust: the trusted keys, the question to verify for, and the folder of passports that tells which are
//! current. Every verb uses this code, so the options are the same everywhere.

use super::{Failure, open_workspace, output};
use crate::earth::Place;
use crate::files;
use crate::folder::Registers;
pub(super) use crate::interface::Enquiry;
use crate::interface::enquiry;
pub(super) use crate::interface::enquiry::{date, time};
use crate::passport::{Question, Trust};
use crate::text::name_of;
use crate::trust::LARGEST_TRUST_FILE_BYTES;
use crate::workspace::Workspace;
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use jiff::Timestamp;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct Asked {
    /// Require this issuer
    #[arg(long, help_heading = "Verification", value_name = "WHO", value_parser = NonEmptyStringValueParser::new())]
    issuer: Option<String>,
    /// Require this serial number; read it from the stand
    #[arg(long, help_heading = "Verification", value_name = "S", value_parser = NonEmptyStringValueParser::new())]
    serial: Option<String>,
    /// Place of the stand: latitude and longitude in degrees, north and east positive, or 55°45′56″N,37°41′08″E
    #[arg(long, help_heading = "Verification", value_name = "LAT,LON", value_parser = enquiry::place_of, allow_hyphen_values = true)]
    at: Option<Place>,
    /// Verify as of this time: RFC 3339, or a UTC date (00:00) [default: now]
    #[arg(long, help_heading = "Verification", value_name = "TIME", value_parser = time)]
    time: Option<Timestamp>,
}

/// Lists of trusted and of revoked keys.
#[derive(Args)]
pub(super) struct Lists {
    /// Trusted signing keys: an OpenSSH allowed_signers file
    #[arg(long, help_heading = "Verification", value_name = "SIGNERS")]
    trust: Option<PathBuf>,
    /// Revoked keys: an OpenSSH KRL, or a list of public keys (repeatable)
    #[arg(long, help_heading = "Verification", value_name = "FILE", requires = "trust")]
    revoked: Vec<PathBuf>,
}

impl Lists {
    /// Reads the lists, or returns `None` if no `--trust` is given.
    pub(super) fn load(&self) -> Result<Option<Trust>, Failure> {
        self.trust.as_deref().map(|path| load(path, &self.revoked)).transpose()
    }
}

/// Options of trust of a verb that cannot do without it.
#[derive(Args)]
#[command(mut_arg("trust", |trust| trust.required(true)))]
pub(super) struct TrustOptions {
    #[command(flatten)]
    lists: Lists,
    #[command(flatten)]
    asked: Asked,
}

/// Options of trust of a verb that reads passports.
#[derive(Args)]
#[command(mut_arg("trust", |trust| trust.required(true)))]
pub(super) struct TrustAmong {
    #[command(flatten)]
    trust: OptionalTrust,
}

/// Options of trust of a verb that also works without a passport.
#[derive(Args)]
pub(super) struct OptionalTrust {
    #[command(flatten)]
    lists: Lists,
    #[command(flatten)]
    asked: Asked,
    /// Register of the stand, or the folder of passports that has it as MODEL/SERIAL/register.yaml
    #[arg(long, help_heading = "Verification", visible_alias = "passports", value_name = "FILE|DIR")]
    register: Option<PathBuf>,
}

impl OptionalTrust {
    /// Returns the enquiry, or `None` if no `--trust` is given.
    pub(super) fn load(&self) -> Result<Option<Enquiry>, Failure> {
        let question = self.asked.question();
        let trust = self.lists.load()?;
        Ok(trust.map(|trust| among(trust, question, self.register.as_deref())))
    }
}

impl TrustAmong {
    pub(super) fn load(&self) -> Result<Enquiry, Failure> {
        self.trust.load()?.ok_or_else(missing)
    }
}

impl TrustOptions {
    pub(super) fn load(&self) -> Result<(Trust, Question), Failure> {
        let question = self.asked.question();
        let trust = self.lists.load()?.ok_or_else(missing)?;
        Ok((trust, question))
    }
}

fn missing() -> Failure {
    Failure::usage("missing --trust SIGNERS")
}

impl Asked {
    pub(super) fn question(&self) -> Question {
        let now = now();
        Question {
            time: self.time.unwrap_or(now),
            now,
            issuer: self.issuer.clone(),
            serial: self.serial.clone(),
            place: self.at,
        }
    }
}

/// Adds the registers at a path to the question, if one is given. Those of a workspace are compared with the last ones that it
/// has accepted.
pub(super) fn among(trust: Trust, question: Question, registers: Option<&Path>) -> Enquiry {
    let Some(path) = registers else { return Enquiry::of(trust, question) };
    let memory = open_workspace::workspace().map(Workspace::memory).cloned();
    let registers = Registers::new(path, trust.clone(), question.now, memory);
    Enquiry::of(trust, question).with_registers(registers)
}

/// Reads the trust files.
pub(super) fn load(signers: &Path, revoked: &[PathBuf]) -> Result<Trust, Failure> {
    let read = |path: &Path| files::read(path, LARGEST_TRUST_FILE_BYTES);
    let keys = read(signers).map_err(|error| {
        let advice =
            "ask the factory for its allowed_signers file; `keygen KEY --allowed-signers FILE` writes one for your key";
        let unknown = error.is_unlike_any();
        let failure = Failure::from(error);
        if unknown { failure.with_advice(advice) } else { failure }
    });
    let revoked = revoked.iter().map(|path| Ok((name_of(path), read(path)?)));
    let revoked = revoked.collect::<Result<Vec<_>, Failure>>()?;
    let trust = enquiry::trust((&name_of(signers), &keys?), &revoked)?;
    trust.skipped().iter().for_each(|remark| output::complain_after(remark));
    Ok(trust)
}

/// Returns the current time in whole seconds, as passports state it.
pub(super) fn now() -> Timestamp {
    let now = Timestamp::now();
    Timestamp::from_second(now.as_second()).unwrap_or(now)
}
