//! Table of certificates: what one header for many stands leaves open, by the serial numbers of the stands.

use crate::certification::Header;
use crate::text::node::Node;
use crate::text::table::Table;
use crate::text::{Unreadable, yaml};
use std::collections::BTreeMap;

/// Columns of the table, with the key of the header that each fills in.
const COLUMNS: [(&str, &str); 8] = [
    ("serial", "stand"),
    ("number", "certificate"),
    ("issued", "certificate"),
    ("performed", "certificate"),
    ("received", "certificate"),
    ("valid_until", "certificate"),
    ("temperature_c", "certificate"),
    ("customer", "stand"),
];

/// Rows by serial number.
#[derive(Debug)]
pub(crate) struct Certificates(BTreeMap<String, Result<Vec<Filled>, String>>);

/// Key of the header, key in it, and value.
type Filled = (&'static str, &'static str, Node);

impl Certificates {
    /// Reads a table with the columns `serial`, `number`, `issued` and any of `performed`, `received`, `valid_until`,
    /// `customer`, `temperature_c`. Rows with a serial or a certificate number that another row has are refused when they are
    /// used, so that the others can be.
    ///
    /// # Errors
    /// Returns every cell that has no value or no number.
    pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Self, Unreadable> {
        let names = COLUMNS.map(|(column, _)| column);
        let table = Table::read(name, bytes, [&names[..3], &[], &names[3..]])?;
        let (mut rows, mut numbers, mut problems) = (BTreeMap::new(), BTreeMap::new(), Vec::new());
        for row in &table.rows {
            let mut filled = Vec::new();
            for (column, key) in COLUMNS {
                let Some(place) = table.place(column) else { continue };
                let cell = &row[place];
                match column {
                    _ if cell.text.is_empty() && place < 3 => {
                        problems.push(table.problem(cell, place, "an empty cell".to_owned(), "text", ""));
                    }
                    _ if cell.text.is_empty() => {}
                    "temperature_c" => {
                        filled.extend(
                            table.number(row, place, "", &mut problems).map(|t| (key, column, Node::Number(t))),
                        );
                    }
                    _ => filled.push((key, column, Node::Text(cell.text.clone()))),
                }
            }
            let [serial, number] = [0, 1].map(|place| row[place].text.clone());
            let other = numbers.insert(number.clone(), serial.clone());
            let twice = if rows.contains_key(&serial) { Some(format!("serial {serial} has two rows")) } else { None };
            let twice = twice.or_else(|| other.as_ref().map(|_| format!("certificate {number} has two rows")));
            if let (Some(why), Some(other)) = (&twice, other) {
                rows.insert(other, Err(why.clone()));
            }
            rows.insert(serial, twice.map_or(Ok(filled), Err));
        }
        if problems.is_empty() { Ok(Self(rows)) } else { Err(table.refuse(problems)) }
    }

    /// Returns the serial numbers.
    pub(crate) fn serials(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// Returns the header of a stand: that of all stands, in the YAML file `name`, with the values of its row.
    ///
    /// # Errors
    /// Returns why there is none, in words.
    pub(crate) fn header(&self, name: &str, bytes: &[u8], serial: &str) -> Result<Header, String> {
        let filled = self.0.get(serial).ok_or_else(|| format!("the table has no row for serial {serial}"))?;
        let filled = filled.as_ref().map_err(Clone::clone)?;
        let (mut tree, _) = yaml::tree(name, bytes).map_err(|refused| refused.to_string())?;
        for (key, column, value) in filled {
            set(entry(&mut tree, key), column, value.clone());
        }
        // JSON is YAML; a place in it would be none of the header.
        let json = serde_json::to_string(&tree).map_err(|error| error.to_string())?;
        Header::from_yaml(name, json.as_bytes()).map_err(|refused| {
            let mut problems = refused.problems().to_vec();
            problems.iter_mut().for_each(|problem| problem.location = None);
            Unreadable::of(name, problems).to_string()
        })
    }
}

/// Returns the mapping under a key, which is made if it is missing.
fn entry<'a>(tree: &'a mut Node, key: &str) -> &'a mut Node {
    if tree.get(key).is_none() {
        set(tree, key, Node::Map(Vec::new()));
    }
    match tree {
        Node::Map(all) => all.iter_mut().find(|(name, _)| name == key).map(|(_, value)| value).expect("was just set"),
        other => other,
    }
}

/// Sets a key of a mapping; anything else is left to the reader of the header, which refuses it.
fn set(tree: &mut Node, key: &str, value: Node) {
    let Node::Map(all) = tree else { return };
    match all.iter_mut().find(|(name, _)| name == key) {
        Some((_, there)) => *there = value,
        None => all.push((key.to_owned(), value)),
    }
}
