//! QR code as an inline SVG picture.

use maud::{Markup, html};
use qrcode::{Color, EcLevel, QrCode};
use std::fmt::Write;

/// Width of the quiet zone around the code, in modules ([ISO/IEC 18004](crate::bibliography::Bibliography::Iso18004),
/// 6.3.8).
const QUIET: usize = 4;

/// Returns the QR code of `text`, dark on white in every mode, with `label` for screen readers. Returns `None` if
/// `text` is too long for any QR code.
pub(crate) fn picture(text: &str, label: &str) -> Option<Markup> {
    let code = QrCode::with_error_correction_level(text, EcLevel::M).ok()?;
    let size = code.width() + 2 * QUIET;
    Some(html! {
        svg.code role="img" aria-label=(label) viewBox={ "0 0 " (size) " " (size) } shape-rendering="crispEdges" {
            rect width=(size) height=(size) fill="#fff" {}
            path stroke="#000" d=(path(&code)) {}
        }
    })
}

/// Returns an SVG path along the middle of every run of dark modules in a row; a line one module wide covers them.
fn path(code: &QrCode) -> String {
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
