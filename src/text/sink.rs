//! Destination of a document, written value by value: a text in canonical form, or a tree.

use super::{Field, Node};

/// Destination of the values of a document, in their order.
///
/// A single pass over the fields of a record ([`Field::emit`]) serves every form in which a document is written.
pub(crate) trait Sink: Sized {
    /// Writes `true` or `false`.
    fn boolean(&mut self, value: bool);
    /// Writes a whole number.
    fn integer(&mut self, value: i64);
    /// Writes a finite binary64 number.
    fn number(&mut self, value: f64);
    /// Writes a string.
    fn text(&mut self, value: &str);
    /// Writes a list.
    fn list<T: Field>(&mut self, items: &[T]);
    /// Writes a mapping. `entries` writes each key and its value; if `empty` is `true`, it writes none.
    fn mapping(&mut self, empty: bool, entries: impl FnOnce(&mut Self));
    /// Writes the key of the next value; returns `false` if both are to be omitted.
    fn key(&mut self, key: &str) -> bool;
}

/// Builder of a [`Node`].
#[derive(Default)]
pub(super) struct Tree {
    keys: Vec<String>,
    values: Vec<Node>,
}

impl Tree {
    pub(super) fn of(value: &impl Field) -> Option<Node> {
        let mut tree = Self::default();
        value.emit(&mut tree);
        tree.values.pop()
    }
}

impl Sink for Tree {
    fn boolean(&mut self, value: bool) {
        self.values.push(Node::Bool(value));
    }

    fn integer(&mut self, value: i64) {
        self.values.push(Node::Integer(value));
    }

    fn number(&mut self, value: f64) {
        self.values.push(Node::Number(value));
    }

    fn text(&mut self, value: &str) {
        self.values.push(Node::Text(value.to_owned()));
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
