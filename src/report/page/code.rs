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
            path fill="#000" d=(path(&code)) {}
        }
    })
}

/// Returns an SVG path with one rectangle, one module high, for every run of dark modules in a row.
fn path(code: &QrCode) -> String {
    let mut path = String::new();
    let modules = code.to_colors();
    for (y, row) in modules.chunks(code.width()).enumerate() {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let length = run.len();
            if run.first() == Some(&Color::Dark) {
                let _ = write!(path, "M{} {}h{length}v1h-{length}z", x + QUIET, y + QUIET);
            }
            x += length;
        }
    }
    path
}
