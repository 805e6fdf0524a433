//! Verb `selftest`: the reference cases of the computations.

use super::{Code, Failure, Format, REFUSED};
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
    options.format.write(|| report::to_json(&cases), || report::text(&cases))?;
    Ok(if cases.iter().all(selftest::Case::passed) { 0 } else { REFUSED })
}
