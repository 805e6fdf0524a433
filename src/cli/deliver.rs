//! Verb `deliver`: what a laboratory gets, in one file.

use super::lang::{self, Lang};
use super::output::Format;
use super::trust_options::TrustOptions;
use super::{Code, Failure, defaults, output};
use crate::delivery::{Delivery, NotDelivered, Wanted, deliver};
use crate::passport::{Question, Trust};
use crate::text::shown;
use crate::workspace::Workspace;
use clap::Args;
use std::path::{Path, PathBuf};

/// Hand passports to a laboratory in one file: those in force, their register, the public keys, and a page with the first
/// steps; the fingerprints of the keys are printed, because they must go by another way
#[derive(Args)]
pub(super) struct Options {
    /// Stands, or one site of them
    #[arg(required = true, value_name = "MODEL/SERIAL[/SITE]")]
    wanted: Vec<Wanted>,
    /// Folder of passports
    #[arg(long, value_name = "DIR", default_value = "passports")]
    passports: PathBuf,
    /// Archive to write
    #[arg(short, long, visible_alias = "out", value_name = "FILE.zip")]
    output: PathBuf,
    #[command(flatten)]
    trust: TrustOptions,
    /// Replace an existing archive
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    _lang: Lang,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let (trust, question) = options.trust.load()?;
    let delivery = of(&options.passports, &options.wanted, &trust, &question)?;
    output::file(&options.output, &delivery.archive, options.force)?;
    options.format.show(|| &delivery, || delivery.document(&shown(&options.output).to_string()))?;
    Ok(0)
}

fn of(passports: &Path, wanted: &[Wanted], trust: &Trust, question: &Question) -> Result<Delivery, Failure> {
    let memory = defaults::workspace().map(Workspace::memory);
    deliver(passports, wanted, (trust, question), memory, lang::of_text()).map_err(|refused| match refused {
        NotDelivered::File(error) => error.into(),
        NotDelivered::NotValid(name, verification) => {
            Failure::verdict("nothing was handed over", &name, &verification, question)
        }
        refused => Failure::refused(refused),
    })
}
