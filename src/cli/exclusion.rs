//! Readings and runs that a certification leaves out, with their reasons.

use super::Failure;
use crate::stand::Excluded;
use crate::text::{Printable, rule};
use clap::Args;

#[derive(Args)]
pub(super) struct ExclusionOptions {
    /// Exclude a reading, given as i,j,run, or a whole run (repeatable); requires --why
    #[arg(long, value_name = "I,J,RUN|RUN", value_parser = exclusion, requires = "why")]
    exclude: Vec<Excluded>,
    /// Reason for the exclusion, recorded in the certificate; one for each --exclude, or one for all
    #[arg(long, value_name = "TEXT", requires = "exclude")]
    why: Vec<String>,
}

/// Parses an exclusion: a reading `i,j,run`, or a run. Its reason is given separately.
fn exclusion(text: &str) -> Result<Excluded, String> {
    let numbers = text.split(',').map(|number| number.trim().parse::<u32>().ok().filter(|number| *number > 0));
    let numbers = numbers.collect::<Option<Vec<_>>>().unwrap_or_default();
    match numbers[..] {
        [run] => Ok(Excluded { i: None, j: None, run, why: String::new() }),
        [i, j, run] => Ok(Excluded { i: Some(i), j: Some(j), run, why: String::new() }),
        _ => Err("expected i,j,run for a reading, such as 2,3,4, or the number of a run, such as 4".to_owned()),
    }
}

impl ExclusionOptions {
    pub(super) fn excluded(&self) -> Result<Vec<Excluded>, Failure> {
        let reasons = reasons(self.exclude.len(), &self.why)?;
        let each = self.exclude.iter().zip(reasons).map(|(excluded, why)| Excluded { why, ..excluded.clone() });
        Ok(each.collect())
    }
}

/// Returns the reason of each `--exclude`, from one `--why` for each, or one for all.
pub(super) fn reasons(excluded: usize, why: &[String]) -> Result<Vec<String>, Failure> {
    if why.len() > 1 && why.len() != excluded {
        let found = why.len();
        return Err(Failure::unusable(format!(
            "found {found} --why for {excluded} --exclude; give one for each, or one for all"
        )));
    }
    if let Some(bad) = why.iter().find(|why| why.is_empty() || !why.chars().all(rule::allowed_in_string)) {
        let words = "the reason is empty or contains a character that is not allowed in signed files; state in plain words \
                     why the reading is left out";
        return Err(Failure::unusable(format!("--why {:?}: {words}", Printable(bad).to_string())));
    }
    Ok(why.iter().chain(why.last().into_iter().cycle()).take(excluded).cloned().collect())
}
