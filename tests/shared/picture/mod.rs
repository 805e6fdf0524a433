//! Reader of pictures, based on a strict XML parser.

// Each crate that reads pictures uses its own part.
#![allow(dead_code, unused_imports)]

mod axis;

pub use axis::{Axis, words};
use dtg_passport::report::{Language, Languages};
use maud::Markup;
use roxmltree::{Document, Node};

/// Half of the last digit of a coordinate, with a margin.
pub const ROUNDING: f64 = 0.051;

/// Returns English alone.
pub fn english() -> Languages {
    Languages::from(Language::English)
}

/// Returns English and Russian.
pub fn both() -> Languages {
    Languages::new(Language::English, [Language::Russian])
}

/// Returns pictures as one document.
pub fn whole(pictures: &[Markup]) -> String {
    let parts: Vec<&str> = pictures.iter().map(|picture| picture.0.as_str()).collect();
    format!("<page>{}</page>", parts.join("\n"))
}

/// Returns the panels of a page.
pub fn svgs<'a>(page: &'a Document) -> Vec<Node<'a, 'a>> {
    page.descendants().filter(|node| node.attribute("role") == Some("img")).collect()
}

/// Returns the elements of a class.
pub fn of_class<'a>(node: Node<'a, 'a>, class: &str) -> Vec<Node<'a, 'a>> {
    let has = |node: &Node| node.attribute("class").is_some_and(|all| all.split(' ').any(|one| one == class));
    node.descendants().filter(has).collect()
}

/// Returns a number from an attribute of an element.
pub fn number(node: Node, attribute: &str) -> f64 {
    node.attribute(attribute).unwrap().parse().unwrap()
}

/// Returns the place where an arrow points: the first corner of its head.
pub fn tip(arrow: Node) -> [f64; 2] {
    let head = arrow.children().find(|node| node.has_tag_name("polygon")).unwrap();
    let first = head.attribute("points").unwrap().split(' ').next().unwrap();
    let (x, y) = first.split_once(',').unwrap();
    [x.parse().unwrap(), y.parse().unwrap()]
}

/// Returns the row of a bar: its name, and the numbers that carry a value.
pub fn row(svg: Node, y: f64) -> (String, Vec<f64>) {
    let of_row = |node: &Node| node.has_tag_name("text") && (number(*node, "y") - 4.0 - y).abs() < 0.2;
    let texts: Vec<Node> = svg.descendants().filter(of_row).collect();
    let values = texts.iter().flat_map(|text| text.descendants()).filter_map(|node| node.attribute("data-value"));
    (words(texts[0]), values.map(|value| value.parse().unwrap()).collect())
}

/// Returns the vertical centre of a rectangle.
pub fn middle(rectangle: Node) -> f64 {
    number(rectangle, "y") + 0.5 * number(rectangle, "height")
}

/// Returns the end of a bar that is not at zero.
pub fn end(bar: Node, value: f64) -> f64 {
    number(bar, "x") + if value > 0.0 { number(bar, "width") } else { 0.0 }
}

/// Returns both ends of a whisker.
pub fn reach(whisker: Node) -> [f64; 2] {
    let path = whisker.attribute("d").unwrap();
    ['M', 'H'].map(|letter| {
        let rest = &path[path.find(letter).unwrap() + 1..];
        rest.split([',', 'M']).next().unwrap().parse().unwrap()
    })
}
