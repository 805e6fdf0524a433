//! Reading pictures: as a strict reader of XML finds them.

use dtg_passport::report::page::{Language, Languages};
use maud::Markup;
use roxmltree::{Document, Node};

/// Half the last place of a coordinate, and of two.
pub const ROUNDING: f64 = 0.051;

/// English alone.
pub fn english() -> Languages {
    Languages::from(Language::English)
}

/// English and Russian.
pub fn both() -> Languages {
    Languages::new(Language::English, [Language::Russian])
}

/// Pictures as one document.
pub fn whole(pictures: &[Markup]) -> String {
    let parts: Vec<&str> = pictures.iter().map(|picture| picture.0.as_str()).collect();
    format!("<page>{}</page>", parts.join("\n"))
}

/// The panels.
pub fn svgs<'a>(page: &'a Document) -> Vec<Node<'a, 'a>> {
    page.descendants().filter(|node| node.attribute("role") == Some("img")).collect()
}

/// The elements of a class.
pub fn of_class<'a>(node: Node<'a, 'a>, class: &str) -> Vec<Node<'a, 'a>> {
    let has = |node: &Node| node.attribute("class").is_some_and(|all| all.split(' ').any(|one| one == class));
    node.descendants().filter(has).collect()
}

/// A number of an element.
pub fn number(node: Node, attribute: &str) -> f64 {
    node.attribute(attribute).unwrap().parse().unwrap()
}

/// Where an arrow points: the first corner of its head.
pub fn tip(arrow: Node) -> [f64; 2] {
    let head = arrow.children().find(|node| node.has_tag_name("polygon")).unwrap();
    let first = head.attribute("points").unwrap().split(' ').next().unwrap();
    let (x, y) = first.split_once(',').unwrap();
    [x.parse().unwrap(), y.parse().unwrap()]
}
