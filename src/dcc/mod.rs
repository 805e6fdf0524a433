//! Digital Calibration Certificates (DCC) in the format of PTB, version 3.3.0.
//!
//! * `administrative`: the file `dtg-dcc/1` with what a DCC must state and no passport contains.
//! * `facts`: the facts that every DCC states, and what is missing of them.
//! * `gyro`: the certificate of a gyro, with decisions on conformity.
//! * `parts`: elements that every DCC has; the order in the code is that of the schema.
//! * `stand`: the certificate of a stand, with its signed passport inside.
//! * `words`: words of the program, in every language.
//! * `xml`: elements and their text.
//!
//! A DCC depends only on its inputs, not on the clock, so the same input gives the same bytes.

mod administrative;
mod facts;
mod gyro;
mod parts;
mod stand;
pub(crate) mod xml;

pub(crate) use administrative::Administrative;
pub(crate) use gyro::{Calibrated, of_gyro};
pub(crate) use stand::of_stand;

use crate::text::scalar::is_device;

#[derive(Debug)]
pub(crate) struct Dcc {
    pub number: String,
    pub xml: String,
}

impl Dcc {
    /// Returns the file name: the number of the certificate, with `_` instead of each character that is unsuitable in a
    /// file name.
    pub(crate) fn file_name(&self) -> String {
        const LONGEST: usize = 100;
        let safe = |c: char| if c.is_alphanumeric() || " ._-".contains(c) { c } else { '_' };
        let stem: String = self.number.trim().chars().map(safe).take(LONGEST).collect();
        // Windows reserves some names, with or without an extension.
        let first = stem.split('.').next().unwrap_or_default().trim_end();
        let is_hidden_or_option = stem.starts_with(['.', '-']);
        let prefix = if is_device(first) || is_hidden_or_option { "certificate_" } else { "" };
        format!("{prefix}{stem}.xml")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_makes_the_name_of_one_file_in_the_folder() {
        let name = |number: &str| Dcc { number: number.to_owned(), xml: String::new() }.file_name();
        assert_eq!(name("C-2026-0142"), "C-2026-0142.xml");
        assert_eq!(name("№ 12/34"), "_ 12_34.xml");
        assert_eq!(name("../../etc"), "certificate_.._.._etc.xml");
        assert_eq!(name("-rf"), "certificate_-rf.xml");
        assert_eq!(name("CON"), "certificate_CON.xml");
        assert_eq!(name("nul.1"), "certificate_nul.1.xml");
        assert_eq!(name("Аттестат 7"), "Аттестат 7.xml");
        assert_eq!(name(&"9".repeat(400)).len(), 104);
    }
}
