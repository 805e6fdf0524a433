//! Reading pictures: as a strict reader of XML finds them.

// Each crate that reads pictures uses its own part.
#![allow(dead_code, unused_imports)]

mod axis;

pub use axis::{Axis, words};
use dtg_passport::report::{Language, Languages};
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

/// What stands in the row of a bar: its name, and the number that carries a value.
pub fn row(svg: Node, y: f64) -> (String, Vec<f64>) {
    let of_row = |node: &Node| node.has_tag_name("text") && (number(*node, "y") - 4.0 - y).abs() < 0.2;
    let texts: Vec<Node> = svg.descendants().filter(of_row).collect();
    let values = texts.iter().flat_map(|text| text.descendants()).filter_map(|node| node.attribute("data-value"));
    (words(texts[0]), values.map(|value| value.parse().unwrap()).collect())
}

/// Half as far down as its rectangle reaches.
pub fn middle(rectangle: Node) -> f64 {
    number(rectangle, "y") + 0.5 * number(rectangle, "height")
}

/// The end of a bar that is not at zero.
pub fn end(bar: Node, value: f64) -> f64 {
    number(bar, "x") + if value > 0.0 { number(bar, "width") } else { 0.0 }
}

/// From where to where a whisker reaches.
pub fn reach(whisker: Node) -> [f64; 2] {
    let path = whisker.attribute("d").unwrap();
    ['M', 'H'].map(|letter| {
        let rest = &path[path.find(letter).unwrap() + 1..];
        rest.split([',', 'M']).next().unwrap().parse().unwrap()
    })
}
