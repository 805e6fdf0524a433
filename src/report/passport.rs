//! A passport, composed once for a terminal and for its printed page.
//!
//! * `general`: the passport itself, the stand and its certificate.
//! * `deviations`: the certified deviations with their uncertainty, and the datum surfaces.
//! * `site`: the site and the Earth there.
//! * `numbers`: the numbers that a calibration uses.
//! * `accuracy`: expected calibration uncertainty, inputs that are not stated.
//! * `worksheet`: the steps to K by hand.

pub(crate) mod accuracy;
pub(crate) mod deviations;
pub(crate) mod general;
pub(crate) mod numbers;
pub(crate) mod site;
mod worksheet;

use crate::passport::{Content, Verification};
use crate::report::doc::{self, Block, heading};
use crate::report::page::language::{Language, Text};
use crate::report::{style, verdict};
use crate::wording::texts::passport as texts;
use std::fmt::Write;

/// Returns the sections: anchor, heading, content.
pub(crate) fn sections(content: &Content) -> [(&'static str, Text, Vec<Block>); 4] {
    let characteristics = [deviations::section(content), site::section(content)].concat();
    [
        ("general", texts::GENERAL, general::section(content)),
        ("characteristics", texts::CHARACTERISTICS, characteristics),
        ("numbers", texts::NUMBERS, numbers::section(content)),
        ("accuracy", texts::ACCURACY, accuracy::section(content)),
    ]
}

/// Returns the whole passport for a terminal, after the answer of `verification`; `None` if it was not verified.
pub(crate) fn text(content: &Content, verification: Option<&Verification>, language: Language) -> String {
    let mut out = answer(content, verification);
    doc::text(&mut out, &general::of_the_passport(&content.passport, None), language);
    for (_, name, blocks) in sections(content) {
        // A heading directly below another says nothing more here.
        let is_headed = matches!(blocks.first(), Some(Block::Heading(_) | Block::Within(..)));
        doc::text(&mut out, &if is_headed { Vec::new() } else { vec![heading(name)] }, language);
        doc::text(&mut out, &blocks, language);
    }
    out
}

/// Returns the steps to K by hand for a terminal, after the answer of `verification`.
pub(crate) fn worksheet(content: &Content, verification: Option<&Verification>, language: Language) -> String {
    let mut out = answer(content, verification);
    doc::text(&mut out, &worksheet::section(content), language);
    out
}

fn answer(content: &Content, verification: Option<&Verification>) -> String {
    let answer = match verification {
        Some(verification) => verdict::answer(verification.valid(), verification.checks()),
        None => style::marked(None, &style::bad("NOT VERIFIED")),
    };
    let mut out = format!("{answer}  {}\n", style::heading(&content.passport.id));
    if let Some(verification) = verification {
        let _ = writeln!(out, "  {}", verdict::counts_with_names(verification.checks()));
    }
    out
}
