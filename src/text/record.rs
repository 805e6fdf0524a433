//! Conversion of a [`Node`] to a Rust struct and back; the declaration in `record!` defines the format.

use super::canonical::Scanner;
use super::characters::{allowed_in_string, is_printable_ascii, latin};
use super::field::{Field, Scalar, Sink, refuse};
use super::problem::UPDATE;
use super::{Advice, Node, Path, Problems, RefusalCause, advice, misspelt, node, rule};
use std::collections::HashSet;

/// Type whose fields are the keys of a mapping.
pub(crate) trait Record: Field {
    /// Keys of the record, in the order of the file.
    const KEYS: &'static [&'static str];

    /// Writes the keys of the record into a mapping that may also have others.
    fn emit_entries<S: Sink>(&self, sink: &mut S);

    /// Reads the record from a mapping that also has the keys `beside`, which the caller reads.
    fn read_beside(node: &Node, beside: &[&str], at: &Path, problems: &mut Problems) -> Option<Self>;
}

/// Record that a file of its own holds, after the key `format`.
pub(crate) trait Document: Record {
    /// Value of `format`.
    const FORMAT: &'static str;
}

/// The content of a file: `format`, then the keys of the document.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct File<T>(pub(crate) T);

impl<T: Document> Field for File<T> {
    /// If a file has another format, only the format is reported.
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        const RIGHT_FILE: &str = "check that this is the right file";
        let format = T::FORMAT;
        match node.get("format") {
            Some(Node::Text(found)) if found == format => {}
            Some(found) => {
                let advice = match found {
                    Node::Text(text) if rule::is_later_format(text, format) => UPDATE.to_owned(),
                    Node::Text(text) => latin(text).filter(|(latin, _)| latin == format).map_or_else(
                        || RIGHT_FILE.to_owned(),
                        |(_, odd)| format!("type the {odd} again, as a Latin letter"),
                    ),
                    _ => RIGHT_FILE.to_owned(),
                };
                problems.at(&at.key("format"), found.describe(), format!("{format:?}"), advice);
                return None;
            }
            None if matches!(node, Node::Map(_)) => {
                let advice = "add the format in the first line, or check that this is the right file";
                problems.missing(at, "format", format!("{format:?}"), advice);
            }
            None => {}
        }
        T::read_beside(node, &["format"], at, problems).map(Self)
    }

    fn is_mapping(&self) -> bool {
        true
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.mapping(false, |sink| {
            if sink.key("format") {
                sink.scalar(Scalar::Text(T::FORMAT));
            }
            self.0.emit_entries(sink);
        });
    }
}

/// Declares a struct whose fields are the keys of a mapping, in the order in which they are written.
///
/// A field of type `Option` may be absent; every other field is required. Unknown and duplicate keys are refused.
macro_rules! record {
    ($(#[$about:meta])* $vis:vis struct $name:ident { $($(#[$doc:meta])* pub $field:ident : $type:ty,)* }) => {
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
        $(#[$about])*
        $vis struct $name { $($(#[$doc])* pub $field: $type,)* }

        const _: () = {
            use $crate::text::canonical::Scanner;
            use $crate::text::field::{Field, Sink};
            use $crate::text::record::{Record, entries, key, read_field};
            use $crate::text::{Node, Path, Problems};

            impl Field for $name {
                fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
                    Self::read_beside(node, &[], at, problems)
                }

                fn is_mapping(&self) -> bool {
                    true
                }

                fn emit<S: Sink>(&self, sink: &mut S) {
                    let empty = true $(&& self.$field.is_absent())*;
                    sink.mapping(empty, |sink| self.emit_entries(sink));
                }

                fn scan(scanner: &mut Scanner) -> Option<Self> {
                    scanner.mapping(Self::KEYS, |scanner| {
                        Some(Self { $($field: scanner.entry(const { key(stringify!($field)) }, Field::absent, Field::scan)?,)* })
                    })
                }
            }

            impl Record for $name {
                const KEYS: &'static [&'static str] = &[$(key(stringify!($field))),*];

                fn emit_entries<S: Sink>(&self, sink: &mut S) {
                    $(if !self.$field.is_absent() && sink.key(const { key(stringify!($field)) }) {
                        self.$field.emit(sink);
                    })*
                }

                fn read_beside(node: &Node, beside: &[&str], at: &Path, problems: &mut Problems) -> Option<Self> {
                    let known: Vec<&str> = beside.iter().chain(Self::KEYS).copied().collect();
                    let entries = entries(node, at, problems, &known)?;
                    $(let $field = read_field(entries, key(stringify!($field)), at, problems);)*
                    Some(Self { $($field: $field?,)* })
                }
            }
        };

        /// Serialises the record with the keys of the file.
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serde::Serialize::serialize(&$crate::text::Field::write(self), serializer)
            }
        }
    };
}
pub(crate) use record;

/// Returns the key of a field. `type` is a reserved word of Rust, so its field is `r#type`.
pub(crate) const fn key(field: &str) -> &str {
    match field.as_bytes() {
        [b'r', b'#', ..] => field.split_at(2).1,
        _ => field,
    }
}

/// Returns the entries of a mapping after reporting unknown and duplicate keys.
pub(crate) fn entries<'n>(
    node: &'n Node,
    at: &Path,
    problems: &mut Problems,
    known: &[&str],
) -> Option<&'n [(String, Node)]> {
    let Node::Map(entries) = node else {
        problems.at(at, node.describe(), format!("a mapping with the keys {}", known.join(", ")), "");
        return None;
    };
    let mut seen = HashSet::new();
    for (index, (key, value)) in entries.iter().enumerate() {
        if problems.is_full() {
            break;
        }
        if !seen.insert(key) {
            let advice = "delete one, because readers differ in which one they use";
            problems.at(&Path::Entry(at, index), format!("duplicate key {key:?}"), "each key once", advice);
        } else if !known.contains(&key.as_str()) {
            let advice = unknown_key_advice(entries, index, key, value, known);
            let expected = format!("one of {}", known.join(", "));
            problems.at(&Path::Entry(at, index), format!("unknown key {key:?}"), expected, advice);
        }
    }
    Some(entries)
}

fn unknown_key_advice(entries: &[(String, Node)], index: usize, key: &str, value: &Node, known: &[&str]) -> Advice {
    let previous = index.checked_sub(1).and_then(|before| entries.get(before));
    if let Some((name, Node::Integer(whole))) = previous
        && *value == Node::Null
        && key.bytes().all(|byte| byte.is_ascii_digit())
    {
        return match (1..1000).contains(&whole.abs()) && key.len() == 3 {
            true => (
                RefusalCause::Thousands,
                format!("write {name}: {whole}{key}, or, with a decimal point, {whole}.{key}"),
            ),
            false => (RefusalCause::DecimalComma, format!("use a decimal point: {name}: {whole}.{key}")),
        }
        .into();
    }
    if let Some(advice) = advice::on_name(known, key) {
        return advice;
    }
    match misspelt::key(known, key) {
        Some(name) => Advice::from(misspelt::question(name)).meaning(name),
        None => "delete it, or make it a comment".into(),
    }
}

/// Reads the field `key`, or returns its default if it may be absent.
pub(crate) fn read_field<T: Field>(
    entries: &[(String, Node)],
    key: &str,
    at: &Path,
    problems: &mut Problems,
) -> Option<T> {
    match entries.iter().find(|(name, _)| name == key) {
        Some((_, node)) => T::read(node, &at.key(key), problems),
        None => T::absent().or_else(|| {
            problems.missing(at, key, T::expected(key), "add it");
            None
        }),
    }
}

impl Field for f64 {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        match node {
            // Adding zero turns -0.0 into 0.0, the only zero that a document can contain.
            Node::Number(value) if value.is_finite() => Some(*value + 0.0),
            Node::Integer(value) => Some(*value as f64),
            other => refuse(other, at, advice::on_yaml(other), problems),
        }
    }

    /// Describes the expected number; the suffix of its key is the unit.
    fn expected(key: &str) -> String {
        const UNITS: [(&str, &str); 12] = [
            ("_deg_per_h_per_g2", "in degrees per hour per g squared"),
            ("_deg_per_h_per_g", "in degrees per hour per g"),
            ("_deg_per_h_per_ma", "in degrees per hour per milliampere"),
            ("_deg_per_h", "in degrees per hour"),
            ("_arcsec", "in arcseconds"),
            ("_deg", "in decimal degrees"),
            ("_ma", "in milliamperes"),
            ("_m_per_s2", "in metres per second squared"),
            ("_m", "in metres"),
            ("_percent", "in percent"),
            ("_temperature_c", "in degrees Celsius"),
            ("_g", "in g"),
        ];
        UNITS
            .iter()
            .find(|(suffix, _)| key.ends_with(suffix))
            .map_or_else(|| "a number".to_owned(), |(_, unit)| format!("a number {unit}"))
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Number(*self));
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.number().filter(|value| value.is_finite())
    }
}

impl Field for u32 {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        match node {
            Node::Integer(value) if u32::try_from(*value).is_ok() => u32::try_from(*value).ok(),
            other => refuse(other, at, "", problems),
        }
    }

    fn expected(_: &str) -> String {
        "a whole number".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Integer(i64::from(*self)));
    }
}

/// Largest whole number that a JSON reader with binary64 numbers reads exactly.
pub(crate) const LARGEST_EXACT_INTEGER: u64 = (1 << 53) - 1;

impl Field for u64 {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        let value = if let Node::Integer(value) = node { Self::try_from(*value).ok() } else { None };
        value.filter(|value| *value <= LARGEST_EXACT_INTEGER).or_else(|| refuse(node, at, "", problems))
    }

    fn expected(_: &str) -> String {
        format!("a whole number up to {LARGEST_EXACT_INTEGER}")
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Integer(i64::try_from(*self).unwrap_or(i64::MAX)));
    }
}

/// Record that a signed text has on one line, `{key: value, …}`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "generate", derive(schemars::JsonSchema), schemars(transparent))]
pub struct OneLine<T>(pub T);

impl<T: Record> Field for OneLine<T> {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        T::read(node, at, problems).map(Self)
    }

    fn expected(key: &str) -> String {
        T::expected(key)
    }

    fn is_mapping(&self) -> bool {
        true
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.one_line(|sink| self.0.emit(sink));
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.on_the_line(T::scan).map(Self)
    }
}

impl Field for bool {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        match node {
            Node::Bool(value) => Some(*value),
            other => refuse(other, at, "", problems),
        }
    }

    fn expected(_: &str) -> String {
        "true or false".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Bool(*self));
    }
}

impl Field for String {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        let Node::Text(text) = node else { return refuse(node, at, "put it in double quotes", problems) };
        if text.is_empty() {
            problems.at(at, "empty text", "text", "enter text, or omit the key if it is optional");
            return None;
        }
        if let Some(refused) = refused_in_string(text) {
            const ADVICE: &str = "delete it, or use a composed character (NFC); control, combining, bidirectional, invisible \
                                  and separator characters cannot be signed";
            let (found, advice): (String, Advice) = match node::odd(refused) {
                Some((found, cause @ RefusalCause::NoBreakSpace)) => (found, cause.into()),
                _ => (format!("character U+{:04X}", u32::from(refused)), ADVICE.into()),
            };
            problems.at(at, found, "printable text on one line", advice);
            return None;
        }
        Some(text.clone())
    }

    fn expected(_: &str) -> String {
        "text".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.scalar(Scalar::Text(self));
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.string().filter(|text| !text.is_empty() && refused_in_string(text).is_none())
    }
}

/// Returns the first character that no string of a signed document may contain, or `None` if there is none.
fn refused_in_string(text: &str) -> Option<char> {
    if is_printable_ascii(text.as_bytes()) {
        return None;
    }
    text.chars().find(|&c| !allowed_in_string(c))
}

impl<T: Field> Field for Option<T> {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        T::read(node, at, problems).map(Some)
    }

    fn absent() -> Option<Self> {
        Some(None)
    }

    fn is_absent(&self) -> bool {
        self.is_none()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        if let Some(value) = self {
            value.emit(sink);
        }
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        T::scan(scanner).map(Some)
    }
}

impl<T: Field> Field for Vec<T> {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        let Node::List(items) = node else { return refuse(node, at, "", problems) };
        let read: Vec<Option<T>> =
            items.iter().enumerate().map(|(index, item)| T::read(item, &at.item(index), problems)).collect();
        read.into_iter().collect()
    }

    fn expected(_: &str) -> String {
        "a list".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.list(self);
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.list(T::scan)
    }
}

impl<T: Field, const N: usize> Field for [T; N] {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        match node {
            Node::List(items) if items.len() == N => Vec::read(node, at, problems)?.try_into().ok(),
            other => refuse(other, at, "", problems),
        }
    }

    fn expected(_: &str) -> String {
        format!("a list of {N} items")
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.list(self);
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.list(T::scan)?.try_into().ok()
    }
}
