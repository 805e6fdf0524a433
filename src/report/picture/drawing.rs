//! Common parts of all pictures: panels with words for screen readers, lines, arrows, labels, hatches, scales, plot areas.
//!
//! A picture consists of one or more panels. Each has about the size at which it is shown, so that letters stay
//! readable if a narrow screen puts the panels below each other. Nothing has a fixed colour: the classes are defined in
//! `style.css`.

use crate::report::page::language::Languages;
use crate::report::page::symbols::{Piece, index_letters, pieces};
use crate::wording::number::localised;
use crate::wording::{Language, Number};
use maud::{Markup, html};

/// A point of a drawing: distance to the right and down, in units of the drawing.
pub(crate) type Point = [f64; 2];

/// Largest magnification of a panel.
const LARGEST: f64 = 1.15;

/// Returns a drawing as an image with a description: a title, and the numbers in words. Its `name` is unique on a page, and
/// the ids within are even on a page that is repeated for each language. A unit of its width and height is about a CSS pixel.
pub(crate) fn panel(
    (name, languages): (&str, &Languages),
    size: Point,
    title: impl Fn(Language) -> String,
    description: impl Fn(Language) -> String,
    drawing: &[Markup],
) -> Markup {
    let [width, height] = size.map(coordinate);
    let tags: Vec<&str> = languages.iter().map(Language::tag).collect();
    let id = |part: &str, language: Language| format!("{name}-{part}-{}-{}", tags.join("-"), language.tag());
    // All words of one language before the next: the title, then the description.
    let labels = languages.iter().flat_map(|at| [id("title", at), id("desc", at)]);
    html! {
        svg.picture viewBox={ "0 0 " (width) " " (height) } style={ "max-width:" (rem(LARGEST * size[0])) }
            role="img" aria-labelledby=(labels.collect::<Vec<_>>().join(" ")) {
            @for language in languages.iter() {
                title id=(id("title", language)) lang=(language.tag()) { (title(language)) }
                desc id=(id("desc", language)) lang=(language.tag()) { (description(language)) }
            }
            @for part in drawing { (part) }
        }
    }
}

/// Lays out the panels of a picture, with the legend below: up to `columns` side by side, if each has `width` pixels of
/// screen.
pub(crate) fn panels(columns: u32, width: u32, drawings: &[Markup], legend: &Markup) -> Markup {
    html! {
        div.panels style={ "--columns:" (columns) ";--panel:" (rem(f64::from(width))) } { @for drawing in drawings { (drawing) } }
        (legend)
    }
}

/// Draws a strip for the cell of a table. The row's other cells have its numbers, so screen readers skip it.
pub(crate) fn strip([width, height]: Point, drawing: &Markup) -> Markup {
    html! {
        svg class="picture strip" viewBox={ "0 0 " (coordinate(width)) " " (coordinate(height)) } aria-hidden="true" {
            (drawing)
        }
    }
}

/// Draws an interval with marks at its ends, `half` high, where it is `capped`.
pub(crate) fn whisker(ends: [f64; 2], capped: [bool; 2], y: f64, half: f64) -> Markup {
    let [x1, x2, above, below] = [ends[0], ends[1], y - half, y + half].map(coordinate);
    let cap = |x: &str, is: bool| if is { format!("M{x},{above}V{below}") } else { String::new() };
    let caps = [cap(&x1, capped[0]), cap(&x2, capped[1])].concat();
    html! { path.whisker d={ "M" (x1) "," (coordinate(y)) "H" (x2) (caps) } {} }
}

/// Returns a length relative to the font size of the page, which is smaller in print.
fn rem(pixels: f64) -> String {
    const PIXELS_OF_THE_SCREEN: f64 = 16.0;
    format!("{:.2}rem", pixels / PIXELS_OF_THE_SCREEN)
}

/// Formats a coordinate to a tenth of a unit, which is finer than print.
pub(crate) fn coordinate(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Formats points for the attributes `points` and `d`.
pub(crate) fn list(points: &[Point]) -> String {
    let each: Vec<String> = points.iter().map(|[x, y]| format!("{},{}", coordinate(*x), coordinate(*y))).collect();
    each.join(" ")
}

pub(crate) fn line([x1, y1]: Point, [x2, y2]: Point, class: &str) -> Markup {
    html! { line class=(class) x1=(coordinate(x1)) y1=(coordinate(y1)) x2=(coordinate(x2)) y2=(coordinate(y2)) {} }
}

pub(crate) fn polygon(points: &[Point], class: &str) -> Markup {
    html! { polygon class=(class) points=(list(points)) {} }
}

/// Draws a rectangle between two opposite corners, given in any order.
pub(crate) fn rectangle([x1, y1]: Point, [x2, y2]: Point, class: &str, fill: Option<&str>) -> Markup {
    html! {
        rect class=(class) x=(coordinate(x1.min(x2))) y=(coordinate(y1.min(y2))) width=(coordinate((x2 - x1).abs()))
            height=(coordinate((y2 - y1).abs())) fill=[fill] {}
    }
}

/// The position of a label relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The label begins at the point.
    Start,
    /// The middle of the label is at the point.
    Middle,
    /// The label ends at the point.
    End,
}

/// Draws words or a symbol with the baseline at a point.
pub(crate) fn label([x, y]: Point, anchor: Anchor, class: &str, words: &Markup) -> Markup {
    let anchor = match anchor {
        Anchor::Start => None,
        Anchor::Middle => Some("middle"),
        Anchor::End => Some("end"),
    };
    html! { text class=[(!class.is_empty()).then_some(class)] x=(coordinate(x)) y=(coordinate(y)) text-anchor=[anchor] { (words) } }
}

pub(crate) fn words(at: Point, anchor: Anchor, class: &str, words: &str) -> Markup {
    label(at, anchor, class, &html! { (words) })
}

/// Returns the largest possible width of words in class `small`, with some reserve.
pub(crate) fn width(words: &str) -> f64 {
    let letter = |c: char| match c {
        ',' | '.' | ' ' => 3.2,
        '…' => 10.8,
        _ => 6.0,
    };
    words.chars().map(letter).sum()
}

/// Draws a number of a document; programs can find it by its value.
pub(crate) fn number(at: Point, anchor: Anchor, class: &str, value: f64, printed: &str) -> Markup {
    label(at, anchor, class, &html! { tspan data-value=(crate::text::number::decimal(value)) { (printed) } })
}

/// Writes a symbol of the paper: the part after the underscore is a subscript.
pub(crate) fn symbol(name: &str) -> Markup {
    let (letter, index) = name.split_once('_').unwrap_or((name, ""));
    with_index(letter, index)
}

fn with_index(letter: &str, index: &str) -> Markup {
    html! {
        tspan.letter { (letter) }
        @if !index.is_empty() {
            tspan.index dy="3" {
                @for (c, italic) in index_letters(index) { @if italic { tspan.letter { (c) } } @else { (c) } }
            }
        }
    }
}

/// Writes words with their symbols.
pub(crate) fn symbols(words: &str) -> Markup {
    let pieces = pieces(words);
    let is_index = |piece: &Piece| matches!(piece, Piece::Symbol(_, index) if !index.is_empty());
    html! {
        @for (place, piece) in pieces.iter().enumerate() {
            @let written = match piece {
                Piece::Words(words) => html! { (words) },
                Piece::Symbol(letter, index) => with_index(letter, index),
            };
            // What follows an index returns to the line.
            @if place > 0 && is_index(&pieces[place - 1]) { tspan dy="-3" { (written) } } @else { (written) }
        }
    }
}

/// Returns a symbol of the paper for plain text: `K_x` becomes Kx.
pub(crate) fn plain_symbol(name: &str) -> String {
    name.replace('_', "")
}

/// Draws a line with a head at its end. If the line is shorter than its head, only the head is drawn; if it has no
/// length, nothing.
pub(crate) fn arrow(from: Point, to: Point, class: &str) -> Markup {
    const HEAD: f64 = 8.0;
    const HALF_WIDTH: f64 = 3.2;
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = libm::hypot(dx, dy);
    if length < 0.05 {
        return html! {};
    }
    let (ux, uy) = (dx / length, dy / length);
    let scale = (length / HEAD).min(1.0);
    let (head, half) = (HEAD * scale, HALF_WIDTH * scale);
    let neck = [to[0] - head * ux, to[1] - head * uy];
    let corners = [to, [neck[0] - half * uy, neck[1] + half * ux], [neck[0] + half * uy, neck[1] - half * ux]];
    html! {
        g class=(class) {
            line x1=(coordinate(from[0])) y1=(coordinate(from[1])) x2=(coordinate(neck[0])) y2=(coordinate(neck[1])) {}
            polygon points=(list(&corners)) {}
        }
    }
}

/// Draws the mark of a point. Each frame index has its own shape, so that the marks differ without colour.
pub(crate) fn mark([x, y]: Point, index: u32, class: &str) -> Markup {
    const R: f64 = 3.6;
    match index % 4 {
        1 => html! { circle class=(class) cx=(coordinate(x)) cy=(coordinate(y)) r=(R) {} },
        2 => rectangle([x - 3.3, y - 3.3], [x + 3.3, y + 3.3], class, None),
        3 => polygon(&[[x, y - 4.4], [x + 4.0, y + 3.0], [x - 4.0, y + 3.0]], class),
        _ => polygon(&[[x, y - 4.6], [x + 4.6, y], [x, y + 4.6], [x - 4.6, y]], class),
    }
}

/// A linear scale: values to places along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    /// Values at both ends.
    pub values: [f64; 2],
    /// Places of both ends.
    pub places: [f64; 2],
}

impl Scale {
    pub(crate) fn place(&self, value: f64) -> f64 {
        let ([from, to], [start, end]) = (self.values, self.places);
        start + (value - from) / (to - from) * (end - start)
    }

    /// Returns the place of a value, or an end of the scale if the value is beyond it: for values without a limit.
    pub(crate) fn clamped(&self, value: f64) -> f64 {
        let [from, to] = self.values;
        self.place(value.clamp(from.min(to), from.max(to)))
    }
}

/// The appearance of a series: the frame index whose mark it uses, and the class of its line.
pub(crate) type Look = (u32, &'static str);

/// A plot area: values increase to the right along `x`, upwards along `y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field {
    /// Horizontal scale, from the left end to the right end.
    pub x: Scale,
    /// Vertical scale, from the lower end to the upper end.
    pub y: Scale,
}

impl Field {
    /// Draws both axes, and at each axis mark a faint line with its number.
    pub(crate) fn axes(&self, x_marks: &[(f64, String)], y_marks: &[(f64, String)]) -> Markup {
        let ([left, right], [bottom, top]) = (self.x.places, self.y.places);
        html! {
            @for (value, printed) in x_marks {
                @let x = self.x.place(*value);
                (line([x, top], [x, bottom + 4.0], "grid"))
                (words([x, bottom + 16.0], Anchor::Middle, "small", printed))
            }
            @for (value, printed) in y_marks {
                @let y = self.y.place(*value);
                (line([left - 4.0, y], [right, y], "grid"))
                (words([left - 7.0, y + 4.0], Anchor::End, "small", printed))
            }
            (line([left, top], [left, bottom], "zero"))
            (line([left, bottom], [right, bottom], "zero"))
        }
    }

    /// Draws a line through `values`, with the mark of `index` at each. Values beyond an axis are drawn at its end.
    pub(crate) fn series(&self, values: &[Point], (index, class): Look) -> Markup {
        let points: Vec<Point> = values.iter().map(|[x, y]| [self.x.clamped(*x), self.y.clamped(*y)]).collect();
        html! {
            polyline class=(class) points=(list(&points)) {}
            @for at in &points { (mark(*at, index, "mark")) }
        }
    }
}

/// Draws the sample of a series for a legend.
pub(crate) fn sample((index, class): Look) -> Markup {
    html! { (line([1.0, 7.0], [27.0, 7.0], class)) (mark([14.0, 7.0], index, "mark")) }
}

/// Round values for the marks of an axis: multiples of 1, 2 or 5 times a power of ten.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// Distance between neighbouring values.
    pub step: f64,
    /// Values from the lowest to the highest.
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// Creates at most about `most` values between `low` and `high`, but if possible two, because one is no scale.
    pub(crate) fn between(low: f64, high: f64, most: usize) -> Self {
        let most = most.max(1);
        let of = |number: usize| Self::of_step(low, high, round_step((high - low) / number as f64));
        (most..=2 * most).map(of).find(|ticks| ticks.values.len() > 1).unwrap_or_else(|| of(most))
    }

    fn of_step(low: f64, high: f64, (step, exponent): (f64, i32)) -> Self {
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let values = (first..=last).map(|multiple| multiple as f64 * step + 0.0).collect();
        Self { step, values, decimals: usize::try_from(-exponent).unwrap_or(0) }
    }

    /// Creates as many values as have room for their numbers along `scale`, at least one beside 0.
    pub(crate) fn along(scale: &Scale, language: Language) -> Self {
        const LETTER: f64 = 6.0;
        const GAP: f64 = 6.0;
        let [low, high] = scale.values;
        let length = (scale.places[1] - scale.places[0]).abs();
        let fits = |ticks: &Self| {
            let widths: Vec<f64> =
                ticks.marks(language).iter().map(|(_, text)| LETTER * text.chars().count() as f64).collect();
            let room = ticks.step / (high - low) * length - GAP;
            widths.len() > 1 && widths.windows(2).all(|next| 0.5 * (next[0] + next[1]) <= room)
        };
        let fewer = (2..=8).rev().map(|most| Self::between(low, high, most));
        let largest = round_below(high.max(-low));
        fewer.into_iter().find(fits).unwrap_or_else(|| Self::of_step(low, high, (largest, exponent(largest))))
    }

    /// Returns each value, and how it is written at the axis.
    pub(crate) fn marks(&self, language: Language) -> Vec<(f64, String)> {
        let text = |value: &f64| (*value, Number::fixed(*value, self.decimals).text(language));
        self.values.iter().map(text).collect()
    }
}

/// Returns the smallest round step that is not below `step`, and its power of ten.
fn round_step(step: f64) -> (f64, i32) {
    let exponent = exponent(step);
    let is_enough = |digit: &f64| digit * power_of_ten(exponent) >= step * (1.0 - 1e-9);
    let digit = [1.0, 2.0, 5.0].into_iter().find(is_enough);
    digit.map_or((power_of_ten(exponent + 1), exponent + 1), |digit| (digit * power_of_ten(exponent), exponent))
}

pub(crate) fn power_of_ten(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

/// Returns the largest value not above `value` that is 1, 2 or 5 times a power of ten: the length of a scale bar.
pub(crate) fn round_below(value: f64) -> f64 {
    let unit = power_of_ten(exponent(value));
    [5.0, 2.0].into_iter().find(|digit| digit * unit <= value * (1.0 + 1e-9)).unwrap_or(1.0) * unit
}

/// Returns a unit with the power of ten that is factored out of its numbers, such as `10⁻³ °/h`.
pub(crate) fn with_power(exponent: i32, unit: &str, language: Language) -> String {
    match exponent {
        0 => unit.to_owned(),
        exponent => format!("{}\u{a0}{unit}", localised(&format!("1e{exponent}"), language)),
    }
}

/// Returns the power of ten of the first digit of `value`.
fn exponent(value: f64) -> i32 {
    if value > 0.0 && value.is_finite() { libm::floor(libm::log10(value)) as i32 } else { 0 }
}

/// Returns the power of ten to factor out of the numbers of an axis up to `reach`: 0 unless they would have many zeros.
pub(crate) fn crowding(reach: f64) -> i32 {
    Some(exponent(reach)).filter(|exponent| !(-1..4).contains(exponent)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 0…90 in at most five steps needs 18 a step, and the next round one is 20.
    #[test]
    fn ticks_are_round() {
        let ticks = Ticks::between(0.0, 90.0, 5);
        assert_eq!(ticks.values, [0.0, 20.0, 40.0, 60.0, 80.0]);
        let ticks = Ticks::between(-0.003, 0.003, 4);
        assert_eq!(ticks.step, 0.002);
        assert_eq!(ticks.values.len(), 3);
        assert_eq!(ticks.marks(Language::Russian)[0].1, "\u{2212}0,002");
        assert_eq!(Ticks::between(0.0, 0.0, 4).values, [0.0]);
        // A step of 5 would leave 0 alone.
        assert_eq!(Ticks::between(-4.6, 4.6, 4).values, [-4.0, -2.0, 0.0, 2.0, 4.0]);
    }

    #[test]
    fn a_scale_bar_is_a_round_length_not_too_long() {
        assert_eq!(round_below(513.0), 500.0);
        assert_eq!(round_below(499.0), 200.0);
        assert_eq!(round_below(0.19), 0.1);
        assert_eq!(round_below(1000.0), 1000.0);
    }

    #[test]
    fn coordinates_are_short_and_know_no_minus_zero() {
        assert_eq!([12.0, 12.25, -0.04, -3.0].map(coordinate), ["12", "12.2", "0", "-3"]);
    }

    #[test]
    fn an_index_stands_lower_and_what_follows_does_not() {
        let html = symbol("ω_0x").into_string();
        let index = r#"<tspan class="index" dy="3">0<tspan class="letter">x</tspan></tspan>"#;
        assert_eq!(html, format!(r#"<tspan class="letter">ω</tspan>{index}"#));
        let html = symbols("ω_g, °/h").into_string();
        let index = r#"<tspan class="index" dy="3">g</tspan><tspan dy="-3">, °/h</tspan>"#;
        assert_eq!(html, format!(r#"<tspan class="letter">ω</tspan>{index}"#));
    }
}
