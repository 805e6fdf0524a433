//! Record of the stand: the parts of a product's passport according to [GOST R
//! 2.610-2019](crate::bibliography::Bibliography::GostR2610) that are filled in by hand. Fields unknown to the file
//! stay empty.

use crate::report::doc::{Block, Rows, Words, blank, given, heading, record, say};
use crate::stand::Identity;
use crate::wording::Text;
use crate::wording::texts::{passport, record as texts};

/// The forms for a stand, with the id of its passport.
pub(super) fn section(stand: &Identity, id: &str) -> Vec<Block> {
    let words = |name: Text, names: &[Text]| part(name, record(names.iter().map(|name| blank(*name))));
    let lines = |name: Text| part(name, Block::Within("lines", vec![say([Words::Blank])]));
    let statement = |text: Text| Block::Within("statement", vec![say([text])]);
    vec![
        Block::Within("save", vec![say([texts::ON_PAPER])]),
        completeness(stand, id),
        words(
            texts::WARRANTY,
            &[
                texts::MANUFACTURED,
                texts::SERVICE_LIFE,
                texts::STORAGE_LIFE,
                texts::WARRANTY_PERIOD,
                texts::WARRANTY_TERMS,
            ],
        ),
        form(texts::PRESERVATION, "form dated third", &[texts::DATE, texts::WORK, texts::PERIOD, texts::WHO], 1),
        Block::Within(
            "pair",
            vec![
                certificate(stand, texts::PACKING, texts::packing_words),
                certificate(stand, texts::ACCEPTANCE, texts::acceptance_words),
            ],
        ),
        statement(texts::VALID_WHEN_SIGNED),
        words(texts::STORAGE, &[texts::STORAGE_CONDITIONS, texts::TRANSPORT_CONDITIONS]),
        form(
            texts::MOVEMENT,
            "form dated third",
            &[texts::INSTALLED, texts::SITE, texts::REMOVED, texts::WHY_REMOVED, texts::WHO],
            2,
        ),
        form(texts::REPAIRS, "form dated", &[texts::DATE, texts::REPAIR, texts::CERTIFIED_AGAIN, texts::WHO], 2),
        statement(texts::AFTER_A_MOVE),
        form(texts::NOTES, "form dated", &[texts::DATE, texts::NOTE, texts::WHO], 2),
        Block::Within("pair", vec![lines(texts::DISPOSAL), lines(texts::SPECIAL)]),
    ]
}

fn part(name: Text, block: Block) -> Block {
    Block::Within("part pen", vec![heading(name), block])
}

/// A form of empty rows. Its class has the widths of its columns: `dated` begins with a date, whose width the `third`
/// column has too.
fn form(name: Text, class: &'static str, headings: &[Text], rows: usize) -> Block {
    let empty = vec![(); rows];
    let table = headings.iter().fold(Rows::of(&empty, class), |table, heading| table.column(*heading, |()| ""));
    part(name, table.called(name))
}

fn completeness(stand: &Identity, id: &str) -> Block {
    let name = stand.name.as_ref().map_or_else(|| texts::TEST_STAND.into(), given);
    let empty = || Words::from("");
    let rows = [
        [given(stand.model.as_str()), name, given(stand.serial.as_str())],
        [given(id), texts::THIS_PASSPORT.into(), empty()],
        [empty(), empty(), empty()],
    ];
    let table = Rows::of(&rows, "form complete")
        .column(texts::DESIGNATION, |[designation, ..]| designation.clone())
        .column(texts::ITEM, |[_, item, _]| item.clone())
        .column(texts::QUANTITY, |_| empty())
        .column(passport::SERIAL, |[.., serial]| serial.clone())
        .column(texts::NOTE, |_| empty());
    part(texts::COMPLETENESS, table.called(texts::COMPLETENESS))
}

fn certificate(stand: &Identity, name: Text, words: fn(Words, Words) -> Words) -> Block {
    let said = say([words(given(stand.model.as_str()), given(stand.serial.as_str()))]);
    let names = [texts::ORGANISATION, texts::WHO, texts::DATE, texts::STAMP];
    Block::Within("part pen", vec![heading(name), said, record(names.map(blank))])
}
