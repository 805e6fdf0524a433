//! Hand-written YAML to a tree through `serde_yaml`, with the line and column of every mistake.

use super::node::{MOST_BRACKETS, location_of, plain_text};
use super::problem::{Location, Problems, Step, Target, Unreadable};
use super::{Field, Node, Path};
use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use std::cell::Cell;
use std::fmt;

/// Reads one YAML document.
///
/// `name` is the file's name, for messages. Refused are: more than [`super::LARGEST_DOCUMENT_BYTES`], bytes that are
/// no UTF-8, a byte order mark, CR, and whatever `serde_yaml` cannot read (with line and column).
pub(crate) fn tree(name: &str, bytes: &[u8]) -> Result<(Node, String), Unreadable> {
    let text = plain_text(name, bytes)?;
    if text.lines().all(|line| line.trim_start().is_empty() || line.trim_start().starts_with('#')) {
        return Err(Unreadable::whole(name, None, "only spaces and comments", "a YAML document", ""));
    }
    refuse_control_characters(name, text)?;
    refuse_deep(name, text)?;
    let budget = Budget::of(text);
    match Whole(&budget).deserialize(serde_yaml::Deserializer::from_str(text)) {
        Ok(node) => Ok((node, text.to_owned())),
        Err(error) => Err(unreadable_yaml(name, &error)),
    }
}

/// The YAML reader refuses control characters too, but gives a position that no editor shows. Separators end a line, and
/// so a comment, for YAML 1.1 and not for YAML 1.2.
fn refuse_control_characters(name: &str, text: &str) -> Result<(), Unreadable> {
    const SEPARATORS: [char; 2] = ['\u{2028}', '\u{2029}'];
    let refused = |c: char| (c.is_control() && !"\n\t".contains(c)) || SEPARATORS.contains(&c);
    let Some((index, c)) = text.char_indices().find(|(_, c)| refused(*c)) else {
        return Ok(());
    };
    let at = Some(location_of(&text.as_bytes()[..index]));
    let kind = if SEPARATORS.contains(&c) { "line separator" } else { "control character" };
    Err(Unreadable::whole(name, at, format!("{kind} U+{:04X}", u32::from(c)), "text", "delete it"))
}

fn unreadable_yaml(name: &str, error: &serde_yaml::Error) -> Unreadable {
    let location = error.location().map(|at| Location { line: at.line(), column: at.column() });
    let mut words = error.to_string();
    if let Some(at) = words.find(" at line ") {
        words.truncate(at);
    }
    // What the reader could read but does not, in words that name what is in the file.
    let (found, advice) = match words.as_str() {
        deep if deep.ends_with("recursion limit exceeded") => {
            ("values nested too deeply", "check that this is the right file")
        }
        aliases if aliases.ends_with(REPEATED) || aliases.ends_with("repetition limit exceeded") => {
            ("aliases (`*name`) that repeat too much content", "write out the content")
        }
        tag if tag.contains("invalid type: enum") => ("a tag (`!name`)", "delete it"),
        several if several.contains("more than one document") => ("several documents (`---`)", "keep one document"),
        _ => {
            let advice = "check the quotes, brackets and indentation of this line and the one before";
            return Unreadable::whole(name, location, format!("invalid YAML ({words})"), "a YAML mapping", advice);
        }
    };
    Unreadable::whole(name, location, found, "a plain YAML mapping", advice)
}

/// Finds the line and column of a mistake by reading the text again up to it.
///
/// `serde_yaml` tells the place of an error and of nothing else; so this reader makes an error at the target.
pub(crate) fn locate(text: &str, target: &Target) -> Option<Location> {
    let probe = Probe { steps: &target.steps, entry: target.entry };
    let error = probe.deserialize(serde_yaml::Deserializer::from_str(text)).err()?;
    error.location().map(|at| Location { line: at.line(), column: at.column() })
}

/// The most brackets in each other that any document may have; a position's matrix in a list needs four.
const DEEPEST: usize = 64;

/// The most values: so many in any text, and one more for every so many bytes. A stand of 4,000 positions has a sixth of
/// its bytes; what has more is no document.
const MOST_VALUES: (usize, usize) = (25_000, 5);

/// Refuses brackets in more than [`DEEPEST`] others, strings and comments aside, more than [`MOST_BRACKETS`] in all, and
/// more than [`MOST_VALUES`].
///
/// The parser looks at every open bracket at every token: a million of them would keep it busy for minutes. For every
/// value it keeps some hundred bytes, twice that while it makes room: a text of nothing but commas would take two hundred
/// times its size. A string is taken to end with its line, as every string of a signed text does, and any quote to begin
/// one. A quote inside a plain word begins none and so hides the brackets behind it: so the numbers in all count what is
/// in strings too.
fn refuse_deep(name: &str, text: &str) -> Result<(), Unreadable> {
    let refuse = |line: usize, column: usize, found: String| {
        let at = Some(Location { line: line + 1, column: column + 1 });
        Err(Unreadable::whole(name, at, found, "a file of dtg-passport", "check that this is the right file"))
    };
    let most_values = MOST_VALUES.0 + text.len() / MOST_VALUES.1;
    let (mut depth, mut opened, mut values) = (0_usize, 0_usize, 0_usize);
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with('#')) {
        let (mut in_string, mut escaped) = (false, false);
        // A comma without a colon since the last one can end two values: in braces a key that has none.
        let mut paired = false;
        values += 1;
        for (column, c) in line.chars().enumerate() {
            opened += usize::from("[{".contains(c));
            values += match c {
                ':' | '?' => 1,
                '-' | '[' | '{' => 2,
                ',' => 2 - usize::from(paired),
                _ => 0,
            };
            paired = c == ':' || (paired && c != ',');
            match c {
                _ if escaped => escaped = false,
                '\\' => escaped = in_string,
                '"' => in_string = !in_string,
                '[' | '{' if !in_string => depth += 1,
                ']' | '}' if !in_string => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth > DEEPEST {
                return refuse(index, column, format!("more than {DEEPEST} nested brackets"));
            }
            if opened > MOST_BRACKETS {
                return refuse(index, column, format!("more than {MOST_BRACKETS} brackets"));
            }
            if values > most_values {
                return refuse(index, column, format!("more than {most_values} values in {} bytes", text.len()));
            }
        }
    }
    Ok(())
}

/// What is said when that is too much.
const REPEATED: &str = "aliases that repeat too much";

/// What may still be built: aliases make much out of little.
struct Budget(Cell<usize>);

impl Budget {
    /// Every value and every byte of a string takes room in the text, unless an alias repeats it: without aliases no
    /// document needs as much.
    fn of(text: &str) -> Self {
        Self(Cell::new(4 * text.len() + 64))
    }

    fn unlimited() -> Self {
        Self(Cell::new(usize::MAX))
    }

    fn spend<E: de::Error>(&self, cost: usize) -> Result<(), E> {
        let left = self.0.get().checked_sub(cost).ok_or_else(|| E::custom(REPEATED))?;
        self.0.set(left);
        Ok(())
    }
}

/// Builds the tree.
#[derive(Clone, Copy)]
struct Whole<'a>(&'a Budget);

impl<'de> DeserializeSeed<'de> for Whole<'_> {
    type Value = Node;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Node, D::Error> {
        self.0.spend(1)?;
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Whole<'_> {
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
        self.0.spend(value.len())?;
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
                // `alpha_arcsec: 12,4` inside braces is a key 4 without a value: kept, and refused by name.
                Node::Integer(key) => key.to_string(),
                other => return Err(de::Error::custom(format!("{} as a key", other.describe()))),
            };
            entries.push((key, map.next_value_seed(self)?));
        }
        Ok(Node::Map(entries))
    }
}

/// Reads to the target and fails there, so that `serde_yaml` says where that is.
#[derive(Clone, Copy)]
struct Probe<'a> {
    steps: &'a [Step],
    entry: Option<usize>,
}

impl<'de> DeserializeSeed<'de> for Probe<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl Probe<'_> {
    fn here<E: de::Error>() -> Result<(), E> {
        Err(E::custom("here"))
    }
}

impl<'de> Visitor<'de> for Probe<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a plain YAML value without a tag")
    }
    fn visit_unit<E: de::Error>(self) -> Result<(), E> {
        Self::here()
    }
    fn visit_bool<E: de::Error>(self, _: bool) -> Result<(), E> {
        Self::here()
    }
    fn visit_i64<E: de::Error>(self, _: i64) -> Result<(), E> {
        Self::here()
    }
    fn visit_u64<E: de::Error>(self, _: u64) -> Result<(), E> {
        Self::here()
    }
    fn visit_f64<E: de::Error>(self, _: f64) -> Result<(), E> {
        Self::here()
    }
    fn visit_str<E: de::Error>(self, _: &str) -> Result<(), E> {
        Self::here()
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let Some((Step::Item(target), rest)) = self.steps.split_first() else {
            return Self::here();
        };
        for _ in 0..*target {
            list.next_element::<de::IgnoredAny>()?;
        }
        list.next_element_seed(Probe { steps: rest, entry: self.entry })?;
        Self::here()
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        match (self.steps.split_first(), self.entry) {
            (Some((Step::Key(target), rest)), _) => {
                let budget = Budget::unlimited();
                while let Some(key) = map.next_key_seed(Whole(&budget))? {
                    if key == Node::Text(target.clone()) {
                        map.next_value_seed(Probe { steps: rest, entry: self.entry })?;
                    } else {
                        map.next_value::<de::IgnoredAny>()?;
                    }
                }
                Self::here()
            }
            (None, Some(entry)) => {
                for _ in 0..entry {
                    map.next_entry::<de::IgnoredAny, de::IgnoredAny>()?;
                }
                map.next_key_seed(Probe { steps: &[], entry: None })?;
                Self::here()
            }
            _ => Self::here(),
        }
    }
}

/// Reads a document of the record type `T`: the tree, its `format`, then the fields, then the rules of its content
/// (`check`). Every mistake of the stage that fails is reported.
pub(crate) fn read_document<T: Field>(
    name: &str,
    bytes: &[u8],
    format: &str,
    check: impl FnOnce(&T, &mut Problems),
) -> Result<T, Unreadable> {
    parse(name, bytes, format, check).map_err(|unreadable| unreadable.in_text(bytes))
}

fn parse<T: Field>(
    name: &str,
    bytes: &[u8],
    format: &str,
    check: impl FnOnce(&T, &mut Problems),
) -> Result<T, Unreadable> {
    let (node, text) = tree(name, bytes)?;
    let mut problems = Problems::new();
    let expected = format!("{format:?}");
    if let Some(found) = node.get("format").filter(|found| **found != Node::Text(format.to_owned())) {
        let advice = "check that this is the right file";
        problems.at(&Path::Root.key("format"), found.describe(), expected, advice);
        return Err(problems.refuse(name, &text));
    }
    let value = T::read(&node, &Path::Root, &mut problems);
    problems.expect_missing(
        "format",
        &expected,
        "add the format in the first line, or check that this is the right \
         file",
    );
    if let Some(value) = &value {
        check(value, &mut problems);
    }
    match value {
        Some(value) if problems.is_empty() => Ok(value),
        _ => Err(problems.refuse(name, &text)),
    }
}
