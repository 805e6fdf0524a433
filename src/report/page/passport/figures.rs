//! Where pictures stand on the page.

use crate::passport::Content;
use crate::report::page::language::Languages;
use crate::report::page::parts;
use crate::report::page::texts::passport as texts;
use crate::report::picture;
use maud::{Markup, html};

/// A place for a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// The stand in each position.
    Positions,
    /// The certified deviations.
    Deviations,
    /// The radius of validity about the site.
    Radius,
    /// The Earth-rate vectors against the ideal ones.
    EarthRate,
    /// What a calibration here is good for, against the tolerance.
    Accuracy,
}

/// The picture for a place, with its caption; nothing where the passport has not what it shows.
pub(super) fn figure(slot: Slot, content: &Content, languages: &Languages) -> Markup {
    let (id, drawing, caption) = match slot {
        Slot::Positions => {
            ("positions", picture::positions::positions(languages, &content.positions), texts::FIGURE_POSITIONS)
        }
        Slot::Deviations => {
            ("deviations", picture::deviations::deviations(languages, &content.positions), texts::FIGURE_DEVIATIONS)
        }
        Slot::Radius => ("radius", picture::place::place(languages, content), texts::FIGURE_RADIUS),
        Slot::EarthRate => ("vectors", picture::vectors::vectors(languages, content), texts::FIGURE_VECTORS),
        Slot::Accuracy => {
            let Some(accuracy) = &content.accuracy else { return html! {} };
            let drawing = picture::accuracy::accuracy(languages, accuracy, content.earth.gravity_m_per_s2);
            ("tolerance", drawing, texts::FIGURE_ACCURACY)
        }
    };
    parts::figure(languages, id, &drawing, caption)
}
