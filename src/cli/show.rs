//! Verb `show`: passports as tables, or in full as JSON.

use super::inputs::{self, Answer, Lines};
use super::options::Printed;
use super::trust_options::{Enquiry, OptionalTrust};
use super::{Code, Failure, defaults, output};
use crate::batch::{Purpose, paths};
use crate::document::sha256_hex;
use crate::passport::{Content, Verification, content_from_anyone};
use crate::report::{exported, passport};
use crate::text::{Kind, name_of};
use clap::{ArgGroup, Args};
use std::path::{Path, PathBuf};

/// Show passports as tables, or in full as JSON for tools without YAML
///
/// PASSPORT is a file, a quoted pattern, or a folder; a - reads a list of paths from standard input. For several
/// passports, JSON has one line each.
#[derive(Args)]
pub(super) struct Options {
    /// Passport files; in a workspace also their identifiers
    #[arg(required = true, value_name = "PASSPORT", value_parser = defaults::passport())]
    passports: Vec<PathBuf>,
    #[command(flatten)]
    whom: Whom,
    /// Show the steps to compute K by hand instead, by the paper's analytic method
    #[arg(long, conflicts_with = "format")]
    worksheet: bool,
    #[command(flatten)]
    _printed: Printed,
}

/// Trust in the passports that are used, or the loud statement that they are not verified.
#[derive(Args)]
#[command(group(ArgGroup::new("whom").required(true).args(["trust", "no_verify"])))]
pub(super) struct Whom {
    #[command(flatten)]
    trust: OptionalTrust,
    /// Do not verify the passport; the output carries a warning
    #[arg(long, help_heading = "Verification", conflicts_with_all = ["issuer", "serial", "at", "time", "register"])]
    no_verify: bool,
}

/// A passport that was read, and the result of its verification.
pub(super) struct Read {
    pub content: Content,
    pub bytes: Vec<u8>,
    /// `None` if the passport was not verified.
    pub verification: Option<Verification>,
}

impl Whom {
    /// Loads the trust, or warns that passports are not verified, and returns `None`.
    pub(super) fn load(&self) -> Result<Option<Enquiry>, Failure> {
        let verified = self.trust.load()?;
        if verified.is_none() {
            output::complain("NOT VERIFIED (--no-verify): the origin of these numbers is unknown");
        }
        Ok(verified)
    }
}

impl Read {
    /// Reads a passport and verifies it, unless there is no `enquiry`. A passport that fails a check is refused with its
    /// verdict.
    pub(super) fn of(path: &Path, enquiry: Option<&Enquiry>) -> Result<Self, Failure> {
        let bytes = inputs::bytes(path, Kind::Passport.words())?;
        let name = name_of(path);
        let Some(enquiry) = enquiry else {
            let content = content_from_anyone(&name, &bytes)?;
            return Ok(Self { content, bytes, verification: None });
        };
        let verification = enquiry.verification(&name, &bytes);
        match verification.passport() {
            Some(passport) => {
                let content = passport.content().clone();
                Ok(Self { content, bytes, verification: Some(verification) })
            }
            None => Err(Failure::verdict("", &name, &verification, &enquiry.question)),
        }
    }
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.whom.load()?;
    let document = if options.worksheet { passport::worksheet } else { passport::document };
    let show = |path: &Path| {
        let Read { content, bytes, verification } = Read::of(path, enquiry.as_ref())?;
        let verification = verification.as_ref();
        let remarks = enquiry.as_ref().map(Enquiry::remarks).unwrap_or_default();
        let value = exported::shown(&content, sha256_hex(&bytes), verification, remarks);
        Ok::<_, Failure>((value, document(&content, verification)))
    };
    if let Some(path) = paths::one_file(&options.passports) {
        let (value, document) = show(path)?;
        return output::show(|| value, || document).map(|()| 0);
    }
    let mut before = "";
    let (code, _) = inputs::each(&options.passports, Purpose::Passports, Lines::or(Lines::Text), |path| {
        let between = std::mem::replace(&mut before, "\n");
        let (value, document) = show(path)?;
        Ok(Answer { value, text: format!("{between}{}", output::typed(&document)), code: 0 })
    })?;
    Ok(code)
}
