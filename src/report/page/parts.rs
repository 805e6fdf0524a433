//! Elements of pages: marks, quantities, dates, figures, forms to fill in by hand, QR codes.

use super::language::Languages;
use super::spacing::unbroken;
use super::symbols::index;
use crate::report::doc::{Block, Words, blank, heading, record, say};
use crate::wording::texts::{calibration, record as forms, units, words};
use crate::wording::{BLANK, Language, Number, Outcome, Text, date_text, time_text};
use jiff::Timestamp;
use jiff::civil::Date;
use maud::{Markup, html};
use qrcode::{Color, EcLevel, QrCode};
use std::fmt::Write;
use std::path::Path;

/// Writes words from the file, whose language is unknown; designations and the parts of an id stay whole.
pub(crate) fn given(words: &str) -> Markup {
    html! { span.given lang="" { (unbroken(words)) } }
}

/// Writes the mark of an outcome; words beside it say the same.
pub(crate) fn mark(outcome: impl Into<Outcome>) -> Markup {
    let outcome = outcome.into();
    let class = match outcome {
        Outcome::Passed => "state passed",
        Outcome::Failed => "state failed",
        Outcome::Undecided | Outcome::NotAsked => "state",
    };
    html! { span class=(class) aria-hidden="true" { (outcome.mark()) } }
}

/// The fields of a signature; `who` asks for the person.
pub(crate) fn signature(who: Text) -> Block {
    record([who, forms::SIGNATURE, forms::DATE, forms::STAMP].map(blank))
}

/// Forms for the signatures of some persons.
pub(crate) fn signatures<const N: usize>(who: [Text; N]) -> [Block; 2] {
    let form = |who| Block::Within("part pen", vec![heading(who), signature(forms::POST_AND_NAME)]);
    let forms = Block::Within("pair", who.map(form).into());
    [forms, Block::Within("statement", vec![say([calibration::VALID_WHEN_SIGNED])])]
}

impl Languages {
    /// Writes an empty space to fill in by hand.
    pub(crate) fn blank(&self) -> Markup {
        html! { span.blank role="img" aria-label=(self.spoken(words::EMPTY)) {} }
    }

    /// Writes a coordinate in degrees, with its hemisphere instead of a sign.
    pub(crate) fn in_hemisphere(&self, degrees: Number, hemispheres: [Text; 2]) -> Markup {
        let (number, hemisphere) = degrees.in_hemisphere(hemispheres);
        html! { span.quantity { (self.number(&number)) "°" (BLANK) (self.cell(&hemisphere.into())) } }
    }

    /// Writes a number and its unit without a line break between them, the unit of the second language in brackets: a solidus
    /// would be part of it.
    pub(crate) fn quantity(&self, number: &Number, unit: Text) -> Markup {
        html! { span.quantity { (self.number(number)) (gap(unit)) (self.said(&unit.into(), [" (", ")"], None)) } }
    }

    /// Returns the language in whose format the readers of all languages understand a date: year, month, day.
    fn of_dates(&self) -> Language {
        if self.single() { self.first() } else { Language::English }
    }

    /// Writes a date.
    pub(crate) fn date(&self, date: Date) -> Markup {
        html! { time datetime=(date) { (date_text(self.of_dates(), date)) } }
    }

    /// Writes a time in UTC.
    pub(crate) fn time(&self, time: Timestamp) -> Markup {
        html! { time datetime=(time) { (unbroken(&time_text(self.of_dates(), time))) } }
    }

    /// Writes a picture with its caption, which the style sheet numbers; `id` is its name there. The picture contains its own
    /// description for screen readers.
    pub(crate) fn figure(&self, id: &str, drawing: &Markup, caption: &Words) -> Markup {
        let second = self.iter().nth(1).map(|language| format!("--second:\"{}\"", words::FIGURE.of(language)));
        html! {
            figure id={ "figure-" (id) } style=[second] {
                (drawing)
                figcaption data-word=(self.spoken(words::FIGURE)) { (self.name(caption)) }
            }
        }
    }

    /// Writes what the marks of a picture mean: a sample of each, and its words.
    pub(crate) fn key(&self, entries: &[(Markup, Words)]) -> Markup {
        html! {
            ul.legend {
                @for (sample, words) in entries {
                    li {
                        @if !sample.0.is_empty() { svg.sample viewBox="0 0 28 14" preserveAspectRatio="xMaxYMid slice" aria-hidden="true" { (sample) } }
                        span { (self.name(words)) }
                    }
                }
            }
        }
    }
}

/// Returns the space between a number and its unit: none before the marks of angles (SI Brochure, 5.4.3).
pub(crate) fn gap(unit: Text) -> &'static str {
    if unit == units::ARCSEC || unit == units::DEGREES { "" } else { "\u{a0}" }
}

/// Writes a symbol of the paper: the part after the underscore is its index.
pub(crate) fn symbol(name: &str) -> Markup {
    html! {
        @match name.split_once('_') {
            None => i { (name) },
            Some((letter, below)) => span.symbol { i { (letter) } (index(below)) },
        }
    }
}

/// Returns the name of a file without its folder.
pub(crate) fn file_name(path: &str) -> &str {
    Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path)
}

/// Width of the quiet zone around the code, in modules ([ISO/IEC 18004](crate::bibliography::Bibliography::Iso18004),
/// 6.3.8).
const QUIET: usize = 4;

/// Returns the QR code of `text`, dark on white in every mode, with `label` for screen readers. Returns `None` if
/// `text` is too long for any QR code.
pub(crate) fn code(text: &str, label: &str) -> Option<Markup> {
    let code = QrCode::with_error_correction_level(text, EcLevel::M).ok()?;
    let size = code.width() + 2 * QUIET;
    Some(html! {
        svg.code role="img" aria-label=(label) viewBox={ "0 0 " (size) " " (size) } shape-rendering="crispEdges" {
            rect width=(size) height=(size) fill="#fff" {}
            path stroke="#000" d=(modules(&code)) {}
        }
    })
}

/// Returns an SVG path along the middle of every run of dark modules in a row; a line one module wide covers them.
fn modules(code: &QrCode) -> String {
    let mut path = String::new();
    let modules = code.to_colors();
    for (y, row) in modules.chunks(code.width()).enumerate() {
        let (mut x, mut drawn_to) = (QUIET, None);
        for run in row.chunk_by(|a, b| a == b) {
            if run.first() == Some(&Color::Dark) {
                let _ = match drawn_to {
                    None => write!(path, "M{x} {}.5h{}", y + QUIET, run.len()),
                    Some(end) => write!(path, "m{} 0h{}", x - end, run.len()),
                };
                drawn_to = Some(x + run.len());
            }
            x += run.len();
        }
    }
    path
}
