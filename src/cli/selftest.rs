//! Verb `selftest`: the reference cases of the computations.

use super::output::Format;
use super::{Code, Failure, REFUSED, output};
use crate::report::selftest as report;
use crate::selftest;
use clap::Args;

/// Compare the computations on this machine with published reference cases
#[derive(Args)]
pub(super) struct Options {
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let cases = selftest::run();
    match options.format {
        Format::Json => output::json(&report::to_json(&cases))?,
        Format::Text => output::text(&report::text(&cases))?,
    }
    Ok(if cases.iter().all(selftest::Case::passed) { 0 } else { REFUSED })
}
