//! Verb `show`: passports as tables, or in full as JSON.

use super::inputs::{self, Each};
use super::lang::{self, Lang};
use super::trust_options::{Enquiry, OptionalTrust};
use super::{Code, Failure, Format, defaults, output};
use crate::batch::{Purpose, paths};
use crate::document::sha256_hex;
use crate::passport::{Content, Verification, content_from_anyone};
use crate::report::{doc, exported, passport};
use crate::text::{Kind, name_of};
use clap::{ArgGroup, Args};
use serde::Serialize;
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
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// Trust in the passports that are used, or the loud statement that they are not verified.
#[derive(Args)]
#[command(group(ArgGroup::new("whom").required(true).args(["trust", "no_verify"])))]
pub(super) struct Whom {
    #[command(flatten)]
    trust: OptionalTrust,
    /// Do not verify the passport; the output carries a warning
    #[arg(long, conflicts_with_all = ["issuer", "serial", "at", "time", "register"])]
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

    /// Returns the passport and the result of its verification, for programs.
    fn for_programs(&self) -> impl Serialize + use<> {
        exported::shown(&self.content, sha256_hex(&self.bytes), self.verification.as_ref())
    }
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let enquiry = options.whom.load()?;
    let read = |path: &Path| Read::of(path, enquiry.as_ref());
    let document = if options.worksheet { passport::worksheet } else { passport::document };
    let document = |read: &Read| document(&read.content, read.verification.as_ref());
    if let Some(path) = paths::one_file(&options.passports) {
        let read = read(path)?;
        return options.format.show(|| read.for_programs(), || document(&read)).map(|()| 0);
    }
    let mut before = "";
    let show = |path: &Path| read(path).map(|read| (read, 0));
    inputs::each(&options.passports, Purpose::Passports, show, |shown| {
        let shown = match shown {
            Each::Done(read) => {
                Each::Done((read.for_programs(), format!("{before}{}", doc::typed(&document(&read), lang::of_text()))))
            }
            Each::Refused { file, refusal } => Each::Refused { file, refusal },
        };
        before = "\n";
        inputs::print(&shown, options.format)
    })
}
