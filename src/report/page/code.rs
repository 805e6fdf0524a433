//! A QR code as an inline picture.

use maud::{Markup, html};
use qrcode::{Color, EcLevel, QrCode};
use std::fmt::Write;

/// The quiet zone around the code, in modules ([ISO/IEC 18004](crate::bibliography::Bibliography::Iso18004), 6.3.8).
const QUIET: usize = 4;

/// The code of `text`, dark on white in every mode, and what it says for those who do not see it; `None` when `text` is
/// too long for any code.
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

/// Every run of dark modules of a row as a rectangle one module high.
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
