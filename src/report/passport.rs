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
use crate::report::doc::{Block, given, heading, line, marked, say, strong};
use crate::report::verdict;
use crate::wording::texts::{passport as texts, verdict as verdicts};
use crate::wording::{Outcome, Text};

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

/// Returns the whole passport, after the answer of `verification`, or that it was not verified.
pub(crate) fn document(content: &Content, verification: Option<&Verification>) -> Vec<Block> {
    let mut doc = answer(content, verification);
    doc.extend(general::of_the_passport(&content.passport, None));
    for (_, name, blocks) in sections(content) {
        // A heading directly below another says nothing more here.
        let is_headed = matches!(blocks.first(), Some(Block::Heading(_) | Block::Within(..)));
        doc.extend((!is_headed).then(|| heading(name)));
        doc.extend(blocks);
    }
    doc
}

/// Returns the steps to K by hand, after the answer of `verification`.
pub(crate) fn worksheet(content: &Content, verification: Option<&Verification>) -> Vec<Block> {
    let mut doc = answer(content, verification);
    doc.extend(worksheet::section(content));
    doc
}

fn answer(content: &Content, verification: Option<&Verification>) -> Vec<Block> {
    let answer = match verification {
        Some(verification) => verdict::answer(verification.valid(), verification.checks()),
        None => marked(Outcome::NotAsked, strong(verdicts::NOT_VERIFIED)),
    };
    vec![
        line(vec![answer, "  ".into(), strong(given(&content.passport.id))]),
        say(verification.map(|verification| verdict::counts_with_names(verification.checks()))),
    ]
}
