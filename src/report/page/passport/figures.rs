//! Pictures of the printed passport.

use crate::passport::Content;
use crate::report::page::language::Languages;
use crate::report::page::parts;
use crate::report::page::texts::passport as texts;
use crate::report::picture;
use maud::{Markup, html};

/// A picture's place on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// The stand with its parts, axes and angles.
    Stand,
    /// Stand in each position.
    Positions,
    /// Validity radius around the site.
    Radius,
    /// Earth-rate vectors, compared with those at the nominal orientation.
    EarthRate,
    /// Expected calibration uncertainty, compared with the tolerance.
    Accuracy,
}

/// Writes the picture for `slot` with its caption, or nothing if the passport lacks its data.
pub(super) fn figure(slot: Slot, content: &Content, languages: &Languages) -> Markup {
    let (id, drawing, caption) = match slot {
        Slot::Stand => {
            let azimuth_deg = content.site.frame_axis_azimuth_deg();
            ("stand", picture::stand::stand(languages, azimuth_deg), texts::FIGURE_STAND)
        }
        Slot::Positions => {
            let azimuth_deg = content.site.frame_axis_azimuth_deg();
            let drawing = picture::positions::positions(languages, &content.positions, azimuth_deg);
            ("positions", drawing, texts::FIGURE_POSITIONS)
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
