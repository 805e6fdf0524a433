//! First steps of a laboratory, which go with the passports of its stands.

use super::language::Languages;
use super::shell::document;
use crate::report::doc::{Block, Words, code, given};
use crate::wording::texts::delivery as texts;
use maud::html;

/// Returns the page as one self-contained HTML document, for passports with these identifiers. It has no fingerprint.
pub(crate) fn instructions<'a>(ids: impl Iterator<Item = &'a str>, languages: &Languages) -> String {
    let title = languages.plain(&texts::TITLE.into());
    let margins = [title.clone(), String::new(), String::new()];
    let steps: [Words; 6] = [
        texts::STEP_PROGRAM.into(),
        texts::STEP_FINGERPRINT.into(),
        texts::step_receive(code("dtg-passport receive FILE.zip DIR --fingerprint SHA256:…")),
        texts::step_place(code("dtg-passport.toml"), code("at")),
        texts::step_calibrate(code("dtg-passport calibrate 4711.csv --workspace DIR"), code("results")),
        texts::STEP_LATER.into(),
    ];
    let body = html! {
        header.title { h1 { (languages.name(&texts::TITLE.into())) } }
        main {
            (languages.blocks(&[Block::Each(texts::CONTENT.into()), Block::List(ids.map(given).collect())]))
            ol { @for step in steps { li { (languages.blocks(&[Block::Each(step)])) } } }
        }
    };
    document(languages, &title, margins, &body)
}
