//! Table of deliveries: which stand goes where. One row is one passport, and one archive.

use super::Failure;
use super::catalogue::{self, Listed};
use crate::interface::enquiry::date;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::table::Table;
use crate::text::{Location, Problem, Unreadable, rule};
use jiff::civil::Date;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Expiry date and customer of the passport for one stand at one site.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Terms {
    /// Expiry date of the passport (inclusive).
    pub valid_until: Option<Date>,
    /// Customer, instead of that of the stand.
    pub customer: Option<String>,
}

/// Rows of a table, by the texts in their columns `stand` and `site`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Deliveries(BTreeMap<(String, String), Terms>);

/// Rows by the identifiers of stand and site, and the files of both.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Placed {
    pub rows: BTreeMap<(String, String), Terms>,
    pub stands: Vec<PathBuf>,
    pub sites: Vec<PathBuf>,
}

impl Deliveries {
    /// Reads a table with the columns `stand`, `site` and optionally `valid_until`, `customer`.
    ///
    /// # Errors
    /// Returns every cell that is not as it should be, and every row that is there twice.
    pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let table = Table::read(name, bytes, [&["stand", "site"], &[], &["valid_until", "customer"]])?;
        let (mut rows, mut problems) = (BTreeMap::new(), Vec::new());
        for row in &table.rows {
            let text = |column: &str| table.place(column).map(|place| (place, &row[place]));
            let mut refuse = |column: usize, expected: &str| {
                let cell = &row[column];
                problems.push(table.problem(cell, column, format!("{:?}", cell.text), expected, ""));
            };
            for column in [0, 1].into_iter().filter(|column| row[*column].text.is_empty()) {
                refuse(column, "a name");
            }
            let mut terms = Terms::default();
            if let Some((place, cell)) = text("valid_until").filter(|(_, cell)| !cell.text.is_empty()) {
                match date(&cell.text) {
                    Ok(day) => terms.valid_until = Some(day),
                    Err(why) => refuse(place, why.strip_prefix("expected ").unwrap_or(&why)),
                }
            }
            if let Some((place, cell)) = text("customer").filter(|(_, cell)| !cell.text.is_empty()) {
                match cell.text.chars().all(rule::allowed_in_string) {
                    true => terms.customer = Some(cell.text.clone()),
                    false => refuse(place, "characters that a passport may contain"),
                }
            }
            if rows.insert((row[0].text.clone(), row[1].text.clone()), terms).is_some() {
                refuse(0, "each stand once for a site");
            }
        }
        if rows.is_empty() && problems.is_empty() {
            let at = Some(Location { line: 1, column: 1 });
            problems.push(Problem::new(at, "", "no row", "a row for each passport", ""));
        }
        if problems.is_empty() { Ok(Self(rows)) } else { Err(table.refuse(problems)) }
    }

    /// Returns the stands and sites of the rows, as they are written.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.keys().map(|(stand, site)| (stand.as_str(), site.as_str()))
    }

    /// Reads the files that `stand` and `site` find for the names in the rows.
    ///
    /// # Errors
    /// Returns the files that cannot be read, and two names for one stand at one site.
    pub(crate) fn placed(
        &self,
        stand: impl Fn(&str) -> PathBuf,
        site: impl Fn(&str) -> PathBuf,
    ) -> Result<Placed, Vec<Failure>> {
        let mut failures = Vec::new();
        let stands = found::<Stand>(self.rows().map(|row| row.0), stand, &mut failures);
        let sites = found::<Site>(self.rows().map(|row| row.1), site, &mut failures);
        let mut rows = BTreeMap::new();
        for ((stand, site), terms) in &self.0 {
            let Some(((stand, path), (site, _))) = stands.get(stand).zip(sites.get(site)) else { continue };
            if rows.insert((stand.clone(), site.clone()), terms.clone()).is_some() {
                failures.push(Failure::refused(path, format!("{stand} has two rows for {site}")));
            }
        }
        let paths = |all: Found| all.into_values().map(|(_, path)| path).collect();
        if failures.is_empty() {
            Ok(Placed { rows, stands: paths(stands), sites: paths(sites) })
        } else {
            Err(failures)
        }
    }
}

/// Identifiers and paths of files by the names in a table.
type Found = BTreeMap<String, (String, PathBuf)>;

/// Reads the files of names, each once, and notes those that cannot be read.
fn found<'a, T: Listed>(
    names: impl Iterator<Item = &'a str>,
    path_of: impl Fn(&str) -> PathBuf,
    failures: &mut Vec<Failure>,
) -> Found {
    let read = |name: &str| {
        let path = path_of(name);
        catalogue::read::<T>(&path).map(|(document, _)| (name.to_owned(), (document.id(), path)))
    };
    let names: BTreeSet<&str> = names.collect();
    names.into_iter().filter_map(|name| read(name).map_err(|failure| failures.push(failure)).ok()).collect()
}
