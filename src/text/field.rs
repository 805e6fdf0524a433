//! Fields of documents, and destinations of a document, written value by value: a text in canonical form, or a tree.

use super::canonical::scanner::Scanner;
use super::{Advice, Node, Path, Problems};

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

/// Reports a value that is not what its key expects.
pub(crate) fn refuse<T: Field>(
    node: &Node,
    at: &Path,
    advice: impl Into<Advice>,
    problems: &mut Problems,
) -> Option<T> {
    problems.at(at, node.describe(), T::expected(at.last_key()), advice);
    None
}

/// Destination of the values of a document, in their order.
///
/// A single pass over the fields of a record ([`Field::emit`]) serves every form in which a document is written.
pub(crate) trait Sink: Sized {
    fn scalar(&mut self, value: Scalar);
    fn list<T: Field>(&mut self, items: &[T]);
    /// Writes a mapping. `entries` writes each key and its value; if `empty` is `true`, it writes none.
    fn mapping(&mut self, empty: bool, entries: impl FnOnce(&mut Self));
    /// Writes a mapping on the line of its key.
    fn one_line(&mut self, value: impl FnOnce(&mut Self)) {
        value(self);
    }
    /// Writes the key of the next value; returns `false` if both are to be omitted.
    fn key(&mut self, key: &str) -> bool;
}

/// Value that is neither a list nor a mapping.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Scalar<'a> {
    Bool(bool),
    Integer(i64),
    /// Finite binary64 number.
    Number(f64),
    Text(&'a str),
}

/// Destination that is a [`Node`].
#[derive(Default)]
struct Tree {
    keys: Vec<String>,
    values: Vec<Node>,
}

impl Tree {
    fn of(value: &impl Field) -> Option<Node> {
        let mut tree = Self::default();
        value.emit(&mut tree);
        tree.values.pop()
    }
}

impl Sink for Tree {
    fn scalar(&mut self, value: Scalar) {
        self.values.push(match value {
            Scalar::Bool(value) => Node::Bool(value),
            Scalar::Integer(value) => Node::Integer(value),
            Scalar::Number(value) => Node::Number(value),
            Scalar::Text(value) => Node::Text(value.to_owned()),
        });
    }

    fn list<T: Field>(&mut self, items: &[T]) {
        let first = self.values.len();
        items.iter().for_each(|item| item.emit(self));
        let items = self.values.split_off(first);
        self.values.push(Node::List(items));
    }

    fn mapping(&mut self, _empty: bool, entries: impl FnOnce(&mut Self)) {
        let (first_key, first_value) = (self.keys.len(), self.values.len());
        entries(self);
        let (keys, values) = (self.keys.split_off(first_key), self.values.split_off(first_value));
        self.values.push(Node::Map(keys.into_iter().zip(values).collect()));
    }

    fn key(&mut self, key: &str) -> bool {
        self.keys.push(key.to_owned());
        true
    }
}
