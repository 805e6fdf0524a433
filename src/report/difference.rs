//! Differences of two passports, also as JSON.

use crate::passport::Content;
use crate::passport::difference::{Differences, NumberDifference, OtherDifference};
use crate::report::columns::decimals;
use crate::report::doc::{Block, On, Rows, Words, code, given, heading, line, say, strong, symbol};
use crate::report::passport::numbers::DECIMALS;
use crate::text::{Node, Printable, number};
use crate::wording::Number;
use crate::wording::texts::difference as texts;
use serde_json::{Value, json};

/// Passport that is compared: its file, the SHA-256 of the file, and its content.
pub(crate) struct Side {
    pub(crate) file: String,
    pub(crate) sha256: String,
    pub(crate) content: Content,
}

impl Side {
    fn json(&self) -> Value {
        let header = &self.content.passport;
        json!({
            "file": self.file, "id": header.id, "sha256": self.sha256, "issued_at": header.issued_at.to_string(),
            "certificate": self.content.certificate.number,
        })
    }
}

/// Returns the differences as JSON: `{a, b, compared, numbers, others}`.
pub(crate) fn to_json(a: &Side, b: &Side, found: &Differences) -> Value {
    json!({
        "a": a.json(),
        "b": b.json(),
        "compared": found.compared,
        "numbers": numbers_json(&found.numbers),
        "others": found.others,
    })
}

/// Returns numbers that differ as JSON: a list of `{key, a, b, difference, standard_uncertainty, ratio}`.
pub(crate) fn numbers_json(numbers: &[NumberDifference]) -> Value {
    let of = |number: &NumberDifference| {
        json!({
            "key": number.key, "a": number.a, "b": number.b, "difference": number.difference(),
            "standard_uncertainty": number.standard_uncertainty, "ratio": number.ratio(),
        })
    };
    numbers.iter().map(of).collect()
}

/// Returns the differences: a table of the numbers, then the other values.
pub(crate) fn document(a: &Side, b: &Side, found: &Differences) -> Vec<Block> {
    let (differ, all) = (found.numbers.len(), found.compared);
    let first = match differ {
        0 if found.others.is_empty() => texts::equal(all),
        _ => texts::differ(differ, all, largest(&found.numbers)),
    };
    let [one, other] = [a, b].map(|side| side.content.stand.id());
    let mut doc = Vec::new();
    doc.extend((one != other).then(|| line(texts::other_stands(given(one), given(other)))));
    let sides = [("A", a), ("B", b)].into_iter().flat_map(|(name, side)| {
        let (header, certificate) = (&side.content.passport, &side.content.certificate);
        let passport = Words::All(vec![strong(given(&header.id)), "  ".into(), given(&side.file)]);
        let issued = texts::issued(header.issued_at, given(&certificate.number), certificate.issued);
        [vec![name.into(), passport], vec!["".into(), issued]]
    });
    doc.extend([line(first), Block::Gap, Block::Lines("", sides.collect())]);
    if !found.numbers.is_empty() {
        // Computed numbers say nothing beyond those from which they were computed, if these differ.
        let given: Vec<_> = found.numbers.iter().filter(|at| !is_computed(&at.key)).cloned().collect();
        let shown = if given.is_empty() { &found.numbers } else { &given };
        doc.extend([Block::Gap, line(texts::u_of("B - A")), numbers(shown)]);
        let hidden = differ - shown.len();
        doc.push(say((hidden > 0).then(|| texts::not_shown(hidden, code("--format json")))));
    }
    if !found.others.is_empty() {
        doc.push(heading(texts::others("A -> B")).only(On::Terminal));
        doc.extend(found.others.iter().map(|OtherDifference { key, a, b }| {
            say([vec![given(key), ": ".into(), shown(a.as_ref()), " -> ".into(), shown(b.as_ref())]])
        }));
    }
    doc
}

/// The number with the largest difference in units of its uncertainty, which goes on a sentence; nothing if none has one.
fn largest(numbers: &[NumberDifference]) -> Words {
    let ratios = numbers.iter().filter_map(|at| Some((at.ratio()?, &at.key)));
    let largest = ratios.max_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()));
    largest.map_or_else(|| "".into(), |(ratio, key)| texts::largest(Number::fixed(ratio.abs(), 1), given(key)))
}

/// A table of numbers that differ.
fn numbers(numbers: &[NumberDifference]) -> Block {
    let rounded =
        |at: &NumberDifference| at.standard_uncertainty.map(decimals).or_else(|| decimals_on_the_page(&at.key));
    let decimals_of_row = |at: &NumberDifference| match (rounded(at), at.a.zip(at.b)) {
        (Some(decimals), _) => decimals,
        // The difference of two numbers as people write them is exact.
        (None, Some((a, b))) if is_short(a) && is_short(b) => {
            Number::exact(a).decimals().max(Number::exact(b).decimals())
        }
        (None, _) => at.difference().map_or(6, |difference| Number::significant(difference, 3).decimals()),
    };
    let plain = |at: &NumberDifference, value: Option<f64>| {
        // As it is in the file if it is short, as those are that people write.
        value.map(|value| match rounded(at).is_none() && is_short(value) {
            true => Number::exact(value),
            false => Number::fixed(value, decimals_of_row(at)),
        })
    };
    let or_nothing = |number: Option<Number>| number.map_or_else(|| "".into(), Words::from);
    // Without spaces, so that each heading stays on one line.
    Rows::of(numbers, "keys")
        .named("", |at| given(&at.key))
        .column("A", |at| plain(at, at.a))
        .column("B", |at| plain(at, at.b))
        .column("B-A", |at| or_nothing(at.difference().map(|value| Number::fixed(value, decimals_of_row(at)).signed())))
        .column(symbol("u"), |at| or_nothing(at.standard_uncertainty.map(|u| Number::fixed(u, decimals_of_row(at)))))
        .column("(B-A)/u", |at| or_nothing(at.ratio().map(|ratio| Number::fixed(ratio, 1).signed())))
        .called(texts::NUMBERS)
}

/// Returns the decimals with which a page prints a computed number without an uncertainty, by its key, or `None` for a
/// number that people write.
fn decimals_on_the_page(key: &str) -> Option<usize> {
    match key {
        "earth.valid_radius_m" => Some(0),
        _ => is_computed(key).then_some(DECIMALS),
    }
}

/// Returns `true` for a number that is computed from the deviations and the site, and used without an uncertainty.
fn is_computed(key: &str) -> bool {
    ["matrices.", "vectors[", "self_check.currents["].iter().any(|part| key.starts_with(part))
}

fn is_short(value: f64) -> bool {
    const SHORT: usize = 12;
    number::decimal(value).len() <= SHORT
}

fn shown(value: Option<&Node>) -> Words {
    match value {
        None => texts::ABSENT.into(),
        Some(Node::Text(text)) => format!("\"{}\"", Printable(text)).into(),
        Some(Node::Number(value)) => number::decimal(*value).into(),
        Some(other) => given(other.describe()),
    }
}
