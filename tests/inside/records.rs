//! Records: conversion of a tree to a struct and back, with every error.

use crate::text::{Field, Node, Path, Problems, record};

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
        assert_eq!(crate::text::canonical::read(&written, crate::text::Limits::DOCUMENT), Ok(place));
        let unnamed = written.replacen("a \\\"b\\\" \\\\ c", "", 1);
        assert!(
            unnamed.starts_with("name: \"\"\n")
                && crate::text::canonical::read::<Place>(&unnamed, crate::text::Limits::DOCUMENT).is_err()
        );
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
