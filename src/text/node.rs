//! Documents as trees: every key is kept in order, including duplicates. Trees are serialised as JSON.

pub(crate) use super::characters::without_byte_order_mark;

use super::kind::{Kind, mistaken};
use super::{Advice, LARGEST_DOCUMENT_BYTES, Location, Path, RefusalCause, Unreadable, large_file};
use serde::de::{self, DeserializeOwned, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Serialize, Serializer};
use std::cell::Cell;
use std::fmt;

/// Value in a document.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Node {
    /// Empty value after a colon.
    Null,
    Bool(bool),
    /// Whole number without point or exponent.
    Integer(i64),
    /// Number with a point or an exponent.
    Number(f64),
    Text(String),
    List(Vec<Node>),
    /// Mapping in the order of the text; a duplicate key is kept twice.
    #[serde(serialize_with = "in_order")]
    Map(Vec<(String, Node)>),
}

impl Node {
    pub(crate) fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        let mut json = serde_json::Deserializer::from_str(text);
        // JSON has no aliases, so no text becomes much larger.
        let node = Builder(&Cell::new(usize::MAX)).deserialize(&mut json)?;
        json.end().map(|()| node)
    }

    /// Describes the value for a message: the value itself if it is short, otherwise its kind.
    pub(crate) fn describe(&self) -> String {
        match self {
            Node::Null => "nothing".to_owned(),
            Node::Bool(value) => format!("{value}"),
            Node::Integer(value) => format!("{value}"),
            Node::Number(value) => format!("{value}"),
            Node::Text(value) if value.chars().count() <= 60 => format!("{value:?}"),
            Node::Text(value) => format!("text of {} characters", value.chars().count()),
            Node::List(items) if items.len() == 1 => "a list of 1 item".to_owned(),
            Node::List(items) => format!("a list of {} items", items.len()),
            Node::Map(_) => "a mapping".to_owned(),
        }
    }

    /// Returns the value under `key` of a mapping, or `None` if there is none.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        match self {
            Node::Map(entries) => entries.iter().find(|(name, _)| name == key).map(|(_, value)| value),
            _ => None,
        }
    }

    /// Calls `found` for every value in the one at `at` that is neither a list nor a mapping, with its path.
    pub(crate) fn each_scalar(&self, at: &Path, found: &mut impl FnMut(&Path, &Node)) {
        match self {
            Node::List(items) => items.iter().enumerate().for_each(|(n, item)| item.each_scalar(&at.item(n), found)),
            Node::Map(entries) => entries.iter().for_each(|(key, value)| value.each_scalar(&at.key(key), found)),
            scalar => found(at, scalar),
        }
    }
}

/// Returns the bytes of a signed document as text if they are UTF-8 without a byte order mark and have LF line endings
/// only.
pub(crate) fn plain_text<'a>(name: &str, bytes: &'a [u8], largest_bytes: usize) -> Result<&'a str, Unreadable> {
    let advice = "get the file from the issuer again, because saving it in another form changes what was signed";
    text_of(name, bytes, largest_bytes, Some(advice))
}

/// Returns the bytes as text, as [`plain_text`] does. `signed` is the advice on a document in another encoding, or `None` if
/// its author can save it again.
fn text_of<'a>(name: &str, bytes: &'a [u8], largest_bytes: usize, signed: Option<&str>) -> Result<&'a str, Unreadable> {
    let resaved = signed.unwrap_or("save the file as UTF-8");
    let refuse = |location, found: &str, expected: &str, advice: &str| {
        Err(Unreadable::whole(name, location, found, expected, advice))
    };
    if bytes.is_empty() {
        return refuse(None, "an empty file", "a document", "the file may be truncated; copy it again");
    }
    if bytes.len() > largest_bytes {
        let found = format!("more than {largest_bytes} bytes");
        return refuse(None, &found, "fewer", large_file(name));
    }
    if bytes.starts_with(&[0xEF, 0xBB, 0xBF]) {
        return refuse(Some(Location { line: 1, column: 1 }), "a byte order mark (BOM)", "plain UTF-8", resaved);
    }
    let text = utf8(name, bytes, signed)?;
    if let Some(index) = memchr::memchr(b'\r', bytes) {
        let at = Some(location_of(&bytes[..index]));
        return if text[index..].starts_with("\r\n") {
            let advice = "transfer the file again byte for byte (git autocrlf may have changed it), or save your own \
                          file with LF line endings";
            refuse(at, "CR LF line endings", "LF line endings", advice)
        } else {
            let advice = signed.unwrap_or("save the file with LF line endings");
            refuse(at, "a carriage return (CR)", "LF line endings", advice)
        };
    }
    Ok(text)
}

/// Returns the bytes as text if they are UTF-8; `signed` is as in [`text_of`].
pub(crate) fn utf8<'a>(name: &str, bytes: &'a [u8], signed: Option<&str>) -> Result<&'a str, Unreadable> {
    if is_utf16(bytes) {
        let advice = signed.map_or(RefusalCause::Utf16.into(), |advice| Advice::from((RefusalCause::Utf16, advice)));
        return Err(Unreadable::whole(name, None, "UTF-16", "UTF-8", advice));
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let (valid, rest) = bytes.split_at(error.valid_up_to());
        let found = format!("byte 0x{:02X}, which is not valid UTF-8", rest[0]);
        let advice = signed.unwrap_or("save the file as UTF-8");
        Unreadable::whole(name, Some(location_of(valid)), found, "UTF-8", advice)
    })
}

/// Reads a file of JSON that is what is `expected`. It may begin with a byte order mark, which PowerShell writes.
pub(crate) fn from_json<T: DeserializeOwned>(
    name: &str,
    bytes: &[u8],
    expected: &str,
    advice: &str,
) -> Result<T, Unreadable> {
    let read = || {
        let text = utf8(name, without_byte_order_mark(bytes), None)?;
        serde_json::from_str(text).map_err(|error| {
            if let Some((at, found, cause)) = odd_character(text) {
                return Unreadable::whole(name, Some(location_of(&text.as_bytes()[..at])), found, expected, cause);
            }
            let location = (error.line() > 0).then(|| Location { line: error.line(), column: error.column().max(1) });
            let mut found = error.to_string();
            // Names of all keys, or a place, which is given apart.
            let end = [", expected one of ", " at line "].into_iter().filter_map(|rest| found.find(rest)).min();
            found.truncate(end.unwrap_or(found.len()));
            Unreadable::whole(name, location, format!("unsuitable JSON ({found})"), expected, advice)
        })
    };
    read().map_err(|unreadable| {
        let other = mistaken(name, bytes, expected, |kind| kind == Kind::Result);
        other.unwrap_or_else(|| unreadable.in_text(bytes))
    })
}

/// Describes a character that a person does not see as what it is, with its cause; `None` for all others. A carriage return
/// is checked as part of the line ending.
pub(crate) fn odd(c: char) -> Option<(String, RefusalCause)> {
    let (name, cause) = match c {
        '\n' | '\t' | '\r' | ' ' => return None,
        _ if c.is_control() => ("control character", RefusalCause::ControlCharacter),
        '\u{2028}' | '\u{2029}' => ("line separator", RefusalCause::NoBreakSpace),
        '\u{A0}' | '\u{2007}' | '\u{202F}' => ("no-break space", RefusalCause::NoBreakSpace),
        _ if c.is_whitespace() => ("space", RefusalCause::NoBreakSpace),
        _ => return None,
    };
    Some((format!("{name} U+{:04X}", u32::from(c)), cause))
}

/// Returns the place, the description and the cause of the first [`odd`] character; spaces in comments do not count, except
/// separators, which end a line, and so a comment, in YAML 1.1 but not in YAML 1.2.
pub(crate) fn odd_character(text: &str) -> Option<(usize, String, RefusalCause)> {
    let (mut in_comment, mut before) = (false, '\n');
    for (at, c) in text.char_indices() {
        in_comment = c != '\n' && (in_comment || c == '#' && before.is_ascii_whitespace());
        before = c;
        let is_space = c.is_whitespace() && !"\u{85}\u{2028}\u{2029}".contains(c);
        if let Some((found, cause)) = odd(c).filter(|_| !(in_comment && is_space)) {
            return Some((at, found, cause));
        }
    }
    None
}

/// Returns the text of a hand-written file, without byte order mark and with LF line endings, as editors of Windows and
/// spreadsheets write them.
pub(crate) fn hand_written_text(name: &str, bytes: &[u8]) -> Result<String, Unreadable> {
    let bytes = without_byte_order_mark(bytes);
    if bytes.len() > LARGEST_DOCUMENT_BYTES {
        // It is refused, and no copy is made of it.
        return text_of(name, bytes, LARGEST_DOCUMENT_BYTES, None).map(str::to_owned);
    }
    let is_kept = |(index, byte): &(usize, &u8)| **byte != b'\r' || bytes.get(index + 1) != Some(&b'\n');
    let plain: Vec<u8> = bytes.iter().enumerate().filter(is_kept).map(|(_, byte)| *byte).collect();
    text_of(name, &plain, LARGEST_DOCUMENT_BYTES, None).map(str::to_owned)
}

/// Returns `true` if the bytes are UTF-16, with or without a byte order mark: other text does not have NUL as exactly
/// one of its first two bytes.
pub(crate) fn is_utf16(bytes: &[u8]) -> bool {
    matches!(bytes, [0xFE, 0xFF, ..] | [0xFF, 0xFE, ..] | [0, 1..=255, ..] | [1..=255, 0, ..])
}

/// Returns the location just after `before`, which must be valid UTF-8.
pub(crate) fn location_of(before: &[u8]) -> Location {
    let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
    Location {
        line: before.iter().filter(|&&byte| byte == b'\n').count() + 1,
        column: String::from_utf8_lossy(&before[line_start..]).chars().count() + 1,
    }
}

fn in_order<S: Serializer>(entries: &[(String, Node)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(key, value)| (key, value)))
}

/// Error message for a document that exceeds its budget.
pub(super) const REPEATED: &str = "aliases that repeat too much";

/// Deserialiser of the whole tree, with the amount that may still be built. It limits aliases, because they can make a small
/// text very large.
#[derive(Clone, Copy)]
pub(super) struct Builder<'a>(pub(super) &'a Cell<usize>);

impl Builder<'_> {
    fn spend<E: de::Error>(self, cost: usize) -> Result<(), E> {
        let left = self.0.get().checked_sub(cost).ok_or_else(|| E::custom(REPEATED))?;
        self.0.set(left);
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for Builder<'_> {
    type Value = Node;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Node, D::Error> {
        self.spend(1)?;
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Builder<'_> {
    type Value = Node;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a plain YAML value without a tag")
    }
    fn visit_unit<E: de::Error>(self) -> Result<Node, E> {
        Ok(Node::Null)
    }
    fn visit_bool<E: de::Error>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Bool(value))
    }
    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Integer(value))
    }
    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Node, E> {
        Ok(i64::try_from(value).map_or(Node::Number(value as f64), Node::Integer))
    }
    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Number(value))
    }
    fn visit_str<E: de::Error>(self, value: &str) -> Result<Node, E> {
        self.spend(value.len())?;
        Ok(Node::Text(value.to_owned()))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Node, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element_seed(self)? {
            items.push(item);
        }
        Ok(Node::List(items))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node, A::Error> {
        let mut entries = Vec::new();
        while let Some(key) = map.next_key_seed(self)? {
            let key = match key {
                Node::Text(key) => key,
                // In braces, `alpha_arcsec: 12,4` contains a key 4 without a value. It is kept, so that it is refused
                // by name.
                Node::Integer(key) => key.to_string(),
                other => return Err(de::Error::custom(format!("{} as a key", other.describe()))),
            };
            entries.push((key, map.next_value_seed(self)?));
        }
        Ok(Node::Map(entries))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_may_be_as_large_as_stated_and_no_larger() {
        let of = |bytes: usize| format!("a\r\n{}", "b".repeat(bytes - 3));
        assert!(plain_text("f", of(1_048_576).replace('\r', "b").as_bytes(), LARGEST_DOCUMENT_BYTES).is_ok());
        assert_eq!(hand_written_text("f", of(1_048_576).as_bytes()).map(|text| text.len()), Ok(1_048_575));
        for refused in [
            plain_text("f", of(1_048_577).replace('\r', "b").as_bytes(), LARGEST_DOCUMENT_BYTES).map(str::len),
            hand_written_text("f", of(1_048_577).as_bytes()).map(|text| text.len()),
        ] {
            assert!(refused.unwrap_err().to_string().contains("found more than 1048576 bytes"));
        }
    }

    #[test]
    fn a_long_text_is_described_by_its_length() {
        let of = |characters: usize| Node::Text("ж".repeat(characters)).describe();
        assert_eq!((of(60), of(61)), (format!("{:?}", "ж".repeat(60)), "text of 61 characters".to_owned()));
    }
}
