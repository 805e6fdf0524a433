//! Conversion of a [`Node`] to a Rust struct and back; the declaration in `record!` defines the format.

use super::canonical::Scanner;
use super::node::{Sink, Tree};
use super::scalar::{STRAIGHT_QUOTES, latin, typographic_quote};
use super::{Node, Path, Problems, advice};
use std::collections::HashSet;

/// Type of a field of a document.
pub(crate) trait Field: Sized + Clone + Send + Sync + 'static {
    /// Reads a value; returns `None` after an error, which is then in `problems`.
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self>;

    /// Returns the value of an absent key, or `None` if the key is required.
    fn absent() -> Option<Self> {
        None
    }

    /// Describes the expected value of `key`, for a message.
    fn expected(_key: &str) -> String {
        "a mapping".to_owned()
    }

    /// Returns `true` if the key is omitted.
    fn is_absent(&self) -> bool {
        false
    }

    /// Returns `true` if the value is written as a mapping.
    fn is_mapping(&self) -> bool {
        false
    }

    /// Writes the value; writes nothing if its key is omitted.
    fn emit<S: Sink>(&self, sink: &mut S);

    /// Converts the value to a tree, or returns `None` if the key is omitted.
    fn write(&self) -> Option<Node> {
        Tree::of(self)
    }

    /// Reads a value from a text in canonical form; returns `None` after an error, or if the text is not canonical.
    fn scan(scanner: &mut Scanner) -> Option<Self> {
        Self::read(&scanner.scalar()?, &Path::Root, &mut Problems::default())
    }
}

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
                    Node::Text(text) if typographic_quote(text).is_some() => STRAIGHT_QUOTES.to_owned(),
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
                sink.text(T::FORMAT);
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

        impl $crate::text::Field for $name {
            fn read(
                node: &$crate::text::Node,
                at: &$crate::text::Path,
                problems: &mut $crate::text::Problems,
            ) -> Option<Self> {
                $crate::text::record::Record::read_beside(node, &[], at, problems)
            }

            fn is_mapping(&self) -> bool {
                true
            }

            fn emit<S: $crate::text::node::Sink>(&self, sink: &mut S) {
                let empty = true $(&& $crate::text::Field::is_absent(&self.$field))*;
                sink.mapping(empty, |sink| $crate::text::record::Record::emit_entries(self, sink));
            }

            fn scan(scanner: &mut $crate::text::canonical::Scanner) -> Option<Self> {
                scanner.mapping(|scanner| {
                    Some(Self { $($field: scanner.entry(const { $crate::text::record::key(stringify!($field)) })?,)* })
                })
            }
        }

        /// Serialises the record with the keys of the file.
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serde::Serialize::serialize(&$crate::text::Field::write(self), serializer)
            }
        }

        impl $crate::text::record::Record for $name {
            const KEYS: &'static [&'static str] = &[$($crate::text::record::key(stringify!($field))),*];

            fn emit_entries<S: $crate::text::node::Sink>(&self, sink: &mut S) {
                $(if !$crate::text::Field::is_absent(&self.$field)
                    && sink.key(const { $crate::text::record::key(stringify!($field)) })
                {
                    $crate::text::Field::emit(&self.$field, sink);
                })*
            }

            fn read_beside(
                node: &$crate::text::Node,
                beside: &[&str],
                at: &$crate::text::Path,
                problems: &mut $crate::text::Problems,
            ) -> Option<Self> {
                let known: Vec<&str> = beside.iter().chain(Self::KEYS).copied().collect();
                let entries = $crate::text::record::entries(node, at, problems, &known)?;
                $(let $field = $crate::text::record::read_field(entries, $crate::text::record::key(stringify!($field)), at, problems);)*
                Some(Self { $($field: $field?,)* })
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

fn unknown_key_advice(entries: &[(String, Node)], index: usize, key: &str, value: &Node, known: &[&str]) -> String {
    let previous = index.checked_sub(1).and_then(|before| entries.get(before));
    if let Some((name, Node::Integer(whole))) = previous
        && *value == Node::Null
        && key.bytes().all(|byte| byte.is_ascii_digit())
    {
        return format!("use a decimal point: {name}: {whole}.{key}");
    }
    if let Some(advice) = advice::on_name(known, key) {
        return advice;
    }
    let alike = |name: &&str| strsim::jaro_winkler(name, key);
    match known.iter().max_by(|a, b| alike(a).total_cmp(&alike(b))) {
        Some(name) if alike(name) > ALIKE => format!("did you mean {name}?"),
        _ => "delete it, or make it a comment".to_owned(),
    }
}

/// Jaro-Winkler similarity from which an unknown key is taken for a misspelt known one.
const ALIKE: f64 = 0.85;

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

/// Reports a value that is not what its key expects.
pub(crate) fn refuse<T: Field>(node: &Node, at: &Path, advice: &str, problems: &mut Problems) -> Option<T> {
    problems.at(at, node.describe(), T::expected(at.last_key()), advice);
    None
}

impl Field for f64 {
    fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
        match node {
            // Adding zero turns -0.0 into 0.0, the only zero that a document can contain.
            Node::Number(value) if value.is_finite() => Some(*value + 0.0),
            Node::Integer(value) => Some(*value as f64),
            other => refuse(other, at, advice::on_yaml(other, at), problems),
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
            ("_deg", "in degrees"),
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
        sink.number(*self);
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
        sink.integer(i64::from(*self));
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
        sink.boolean(*self);
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
            let found = format!("character U+{:04X}", u32::from(refused));
            let advice = "delete it, or use a composed character (NFC); control, combining, bidirectional, invisible \
                          and separator characters cannot be signed";
            problems.at(at, found, "printable text on one line", advice);
            return None;
        }
        Some(text.clone())
    }

    fn expected(_: &str) -> String {
        "text".to_owned()
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        sink.text(self);
    }

    fn scan(scanner: &mut Scanner) -> Option<Self> {
        scanner.string().filter(|text| !text.is_empty() && refused_in_string(text).is_none())
    }
}

/// Returns the first character that no string of a signed document may contain, or `None` if there is none.
fn refused_in_string(text: &str) -> Option<char> {
    if super::rule::is_printable_ascii(text.as_bytes()) {
        return None;
    }
    text.chars().find(|&c| !super::rule::allowed_in_string(c))
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
        scanner.list()
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
        scanner.array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the value, and what the message says about it.
    fn read<T: Field>(node: Node) -> (Option<T>, Option<String>) {
        let mut problems = Problems::default();
        let value = T::read(&node, &Path::Root, &mut problems);
        let refused = (!problems.is_empty()).then(|| problems.refuse_by_field("f").problems()[0].found.clone());
        (value, refused)
    }

    #[test]
    fn a_value_is_either_read_or_described() {
        let described = |found: &str| Some(found.to_owned());
        assert_eq!(read::<u32>(Node::Integer(4_294_967_295)), (Some(u32::MAX), None));
        assert_eq!(read::<u32>(Node::Integer(4_294_967_296)), (None, described("4294967296")));
        assert_eq!(read::<u32>(Node::Integer(-1)), (None, described("-1")));
        assert_eq!(read::<f64>(Node::Number(f64::INFINITY)), (None, described("inf")));
        let list = |length| Node::List(vec![Node::Integer(1); length]);
        assert_eq!(read::<[u32; 3]>(list(3)), (Some([1; 3]), None));
        assert_eq!(read::<[u32; 3]>(list(2)), (None, described("a list of 2 items")));
        assert_eq!(read::<String>(Node::Text("a\u{301}".to_owned())), (None, described("character U+0301")));
        // A document has one zero.
        assert!(read::<f64>(Node::Number(-0.0)).0.unwrap().is_sign_positive());
    }

    record! {
        /// Record with every kind of value.
        pub struct Place {
            /// Text.
            pub name: String,
            /// Boolean.
            pub open: bool,
            /// Number.
            pub height_m: f64,
            /// Whole number.
            pub floors: u32,
            /// Text that may be absent.
            pub remark: Option<String>,
        }
    }

    fn map(entries: &[(&str, Node)]) -> Node {
        Node::Map(entries.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect())
    }

    fn text(text: &str) -> Node {
        Node::Text(text.to_owned())
    }

    /// Expected: the canonical form of the contract, and the tree of the same values.
    #[test]
    fn a_record_is_written_and_read_as_text_and_as_a_tree() {
        let entries = [
            ("name", text("a \"b\" \\ c")),
            ("open", Node::Bool(true)),
            ("height_m", Node::Number(-2.5)),
            ("floors", Node::Integer(12)),
            ("remark", text("d")),
        ];
        let written = "name: \"a \\\"b\\\" \\\\ c\"\nopen: true\nheight_m: -2.5\nfloors: 12\nremark: \"d\"\n";
        for length in [5, 4] {
            let (tree, written) = (map(&entries[..length]), written.split_inclusive('\n').take(length));
            let written: String = written.collect();
            let place = read::<Place>(tree.clone()).0.unwrap();
            assert_eq!(place.open && place.remark.is_some(), length == 5);
            assert_eq!(place.write(), Some(tree));
            assert_eq!(crate::text::canonical::write_bare(&place), written);
            assert_eq!(crate::text::canonical::read(&written), Ok(place));
            let unnamed = written.replacen("a \\\"b\\\" \\\\ c", "", 1);
            assert!(unnamed.starts_with("name: \"\"\n") && crate::text::canonical::read::<Place>(&unnamed).is_err());
        }
    }

    /// Returns what was found, expected and advised of each error in a [`Place`].
    fn refused(node: &Node) -> Vec<[String; 3]> {
        let mut problems = Problems::default();
        assert_eq!(Place::read(node, &Path::Root, &mut problems), None);
        let refused = problems.refuse_by_field("f");
        refused.problems().iter().map(|at| [at.found.clone(), at.expected.clone(), at.advice.clone()]).collect()
    }

    /// Expected: the unit that each key of the contract ends with.
    #[test]
    fn a_missing_key_says_what_belongs_there() {
        let expected: Vec<String> = refused(&map(&[])).into_iter().map(|[_, expected, _]| expected).collect();
        assert_eq!(expected, ["text", "true or false", "a number in metres", "a whole number"]);
        for (key, unit) in [
            ("alpha_arcsec", "a number in arcseconds"),
            ("latitude_deg", "a number in degrees"),
            ("k_x_deg_per_h_per_ma", "a number in degrees per hour per milliampere"),
            ("gravity_m_per_s2", "a number in metres per second squared"),
            ("size", "a number"),
        ] {
            assert_eq!(f64::expected(key), unit);
        }
        assert_eq!([Place::expected(""), <Vec<f64>>::expected("")], ["a mapping", "a list"]);
        assert_eq!(<[f64; 3]>::expected(""), "a list of 3 items");
    }

    #[test]
    fn an_unknown_key_is_named_with_the_key_that_was_meant() {
        let advice = |entries: &[(&str, Node)]| refused(&map(entries)).swap_remove(0);
        let unknown = |key: &str| format!("unknown key {key:?}");
        for (key, due) in [
            ("hieght_m", "did you mean height_m?"),
            ("colour", "delete it, or make it a comment"),
            ("fl\u{43E}ors", "the Cyrillic letter 'о' (U+043E) only looks like a Latin letter; type floors again"),
        ] {
            let [found, _, advice] = advice(&[(key, Node::Integer(1))]);
            assert_eq!((found, advice.as_str()), (unknown(key), due));
        }
        let comma = advice(&[("height_m", Node::Integer(12)), ("4", Node::Null)]);
        assert_eq!((&comma[0], comma[2].as_str()), (&unknown("4"), "use a decimal point: height_m: 12.4"));
        let no_comma = advice(&[("height_m", Node::Integer(12)), ("4", Node::Integer(1))]);
        assert_eq!(no_comma[2], "delete it, or make it a comment");
        assert_eq!(advice(&[("open", Node::Bool(true)), ("open", Node::Bool(true))])[0], "duplicate key \"open\"");
    }
}
