//! What all pictures share: the frame with its words for screen readers, lines, arrows, labels, hatches, scales.
//!
//! A picture is one or more panels, each of about the size at which it is shown, so that letters stay readable where a
//! narrow screen lays the panels one under the other. Nothing has a fixed colour: the classes stand in `style.css`.

use crate::report::page::language::{Language, Languages, Text};
use crate::report::page::number::{Number, localised};
use maud::{Markup, PreEscaped, html};

/// A point of a drawing: to the right and down, in its own units.
pub(crate) type Point = [f64; 2];

/// Panels are drawn at most so many times their size.
const LARGEST: f64 = 1.15;

/// One drawing with its words.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Panel<'a> {
    /// Of a page, unique: the ids within begin with it.
    pub name: &'a str,
    /// The languages of its words.
    pub languages: &'a Languages,
    /// Width and height; a unit is about a pixel of CSS.
    pub size: Point,
}

impl Panel<'_> {
    /// An id for `part`, unique on a page even where the page stands once for each language.
    pub(crate) fn id(&self, part: &str) -> String {
        let tags: Vec<&str> = self.languages.iter().map(Language::tag).collect();
        format!("{}-{part}-{}", self.name, tags.join("-"))
    }

    /// The drawing as an image that says what it shows: a title, and the numbers in words.
    pub(crate) fn svg(
        &self,
        title: impl Fn(Language) -> String,
        description: impl Fn(Language) -> String,
        drawing: &[Markup],
    ) -> Markup {
        let [width, height] = self.size.map(coordinate);
        // A language at a time: what it is called, then what it shows.
        let words: Vec<_> = self.languages.iter().flat_map(|at| [("title", at), ("desc", at)]).collect();
        let id = |part: &str, language: Language| format!("{}-{}", self.id(part), language.tag());
        let labels: Vec<String> = words.iter().map(|(part, language)| id(part, *language)).collect();
        html! {
            svg.picture viewBox={ "0 0 " (width) " " (height) } style={ "max-width:" (rem(LARGEST * self.size[0])) }
                role="img" aria-labelledby=(labels.join(" ")) {
                @for language in self.languages.iter() {
                    title id=(id("title", language)) lang=(language.tag()) { (title(language)) }
                    desc id=(id("desc", language)) lang=(language.tag()) { (description(language)) }
                }
                @for part in drawing { (part) }
            }
        }
    }

    /// A hatch under the id of `part`, for a `fill` by [`Panel::filled_with`].
    pub(crate) fn hatch(&self, part: &str) -> Markup {
        html! {
            pattern id=(self.id(part)) width="5" height="5" patternUnits="userSpaceOnUse" patternTransform="rotate(45)" {
                line.hatch x1="0" y1="0" x2="0" y2="5" {}
            }
        }
    }

    /// The `fill` of what is hatched.
    pub(crate) fn filled_with(&self, part: &str) -> String {
        format!("url(#{})", self.id(part))
    }
}

/// The panels of a picture, up to `columns` side by side where there is room for `width` pixels of a screen each, and the legend beneath.
pub(crate) fn panels(columns: u32, width: u32, drawings: &[Markup], legend: &Markup) -> Markup {
    html! {
        div.panels style={ "--columns:" (columns) ";--panel:" (rem(f64::from(width))) } { @for drawing in drawings { (drawing) } }
        (legend)
    }
}

/// What the marks mean: a sample of each, and its words.
pub(crate) fn legend(languages: &Languages, entries: &[(Markup, Text)]) -> Markup {
    html! {
        ul.legend {
            @for (sample, words) in entries {
                li {
                    svg.sample viewBox="0 0 28 14" aria-hidden="true" { (sample) }
                    span { (languages.label(*words)) }
                }
            }
        }
    }
}

/// A length on the page, for the size of letters that the page has there: print has smaller ones.
fn rem(pixels: f64) -> String {
    const PIXELS_OF_THE_SCREEN: f64 = 16.0;
    format!("{:.2}rem", pixels / PIXELS_OF_THE_SCREEN)
}

/// A coordinate to a tenth, which is finer than print.
pub(crate) fn coordinate(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Points as `points` and `d` have them.
pub(crate) fn list(points: &[Point]) -> String {
    let each: Vec<String> = points.iter().map(|[x, y]| format!("{},{}", coordinate(*x), coordinate(*y))).collect();
    each.join(" ")
}

/// A straight line.
pub(crate) fn line([x1, y1]: Point, [x2, y2]: Point, class: &str) -> Markup {
    html! { line class=(class) x1=(coordinate(x1)) y1=(coordinate(y1)) x2=(coordinate(x2)) y2=(coordinate(y2)) {} }
}

/// A closed shape.
pub(crate) fn polygon(points: &[Point], class: &str) -> Markup {
    html! { polygon class=(class) points=(list(points)) {} }
}

/// A rectangle between two corners, whichever they are.
pub(crate) fn rectangle([x1, y1]: Point, [x2, y2]: Point, class: &str, fill: Option<&str>) -> Markup {
    html! {
        rect class=(class) x=(coordinate(x1.min(x2))) y=(coordinate(y1.min(y2))) width=(coordinate((x2 - x1).abs()))
            height=(coordinate((y2 - y1).abs())) fill=[fill] {}
    }
}

/// Where a label stands to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The label begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// Words or a symbol with its baseline at a point.
pub(crate) fn label([x, y]: Point, anchor: Anchor, class: &str, words: &Markup) -> Markup {
    let anchor = match anchor {
        Anchor::Start => None,
        Anchor::Middle => Some("middle"),
        Anchor::End => Some("end"),
    };
    html! { text class=[(!class.is_empty()).then_some(class)] x=(coordinate(x)) y=(coordinate(y)) text-anchor=[anchor] { (words) } }
}

/// The same of plain words.
pub(crate) fn words(at: Point, anchor: Anchor, class: &str, words: &str) -> Markup {
    label(at, anchor, class, &html! { (words) })
}

/// The number of a document, which a program finds again by its value.
pub(crate) fn number(at: Point, anchor: Anchor, value: f64, printed: &str) -> Markup {
    label(at, anchor, "", &html! { tspan data-value=(crate::text::number::decimal(value)) { (printed) } })
}

/// A symbol of the paper: what follows the underscore stands lower.
pub(crate) fn symbol(name: &str) -> Markup {
    let (letter, index) = name.split_once('_').unwrap_or((name, ""));
    html! {
        tspan.letter { (letter) }
        @if !index.is_empty() { tspan.index dy="3" { (index) } }
    }
}

/// The same within plain words: `K_x` is Kx.
pub(crate) fn plain_symbol(name: &str) -> String {
    name.replace('_', "")
}

/// A title, in lines for each language, and how much room the lines beyond the first one take.
pub(crate) fn heading(languages: &Languages, at: Point, text: Text) -> (Markup, f64) {
    const LINE: f64 = 15.0;
    let mut said: Vec<&str> = Vec::new();
    let mut lines: Vec<(&str, String)> = Vec::new();
    for (place, language) in languages.iter().enumerate() {
        let words = text.of(language);
        if !said.contains(&words) {
            said.push(words);
            let class = if place == 0 { "title" } else { "small" };
            lines.extend(lines_of(words).into_iter().map(|line| (class, line)));
        }
    }
    let drawn = html! {
        @for (row, (class, line)) in lines.iter().enumerate() {
            (words([at[0], at[1] + LINE * row as f64], Anchor::Start, class, line))
        }
    };
    (drawn, LINE * (lines.len() - 1) as f64)
}

/// A title in lines that are no wider than a panel.
fn lines_of(title: &str) -> Vec<String> {
    const LONGEST: usize = 42;
    let mut lines: Vec<String> = Vec::new();
    for word in title.split(' ') {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= LONGEST) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A line with a head at its end. One that is shorter than its head is the head alone, and a point is nothing.
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

/// A mark of a point: frame index by frame index another shape, so that no colour is needed to tell them apart.
pub(crate) fn mark([x, y]: Point, index: u32, class: &str) -> Markup {
    const R: f64 = 3.6;
    match index % 4 {
        1 => html! { circle class=(class) cx=(coordinate(x)) cy=(coordinate(y)) r=(R) {} },
        2 => rectangle([x - 3.3, y - 3.3], [x + 3.3, y + 3.3], class, None),
        3 => polygon(&[[x, y - 4.4], [x + 4.0, y + 3.0], [x - 4.0, y + 3.0]], class),
        _ => polygon(&[[x, y - 4.6], [x + 4.6, y], [x, y + 4.6], [x - 4.6, y]], class),
    }
}

/// A scale: values to places along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    /// The two values at its ends.
    pub values: [f64; 2],
    /// Where they stand.
    pub places: [f64; 2],
}

impl Scale {
    /// The place of a value.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let ([from, to], [start, end]) = (self.values, self.places);
        start + (value - from) / (to - from) * (end - start)
    }

    /// The same, at an end of the scale when it is beyond: for values that nobody limits.
    pub(crate) fn clamped(&self, value: f64) -> f64 {
        let [from, to] = self.values;
        self.place(value.clamp(from.min(to), from.max(to)))
    }
}

/// Round values for the marks of an axis: multiples of 1, 2 or 5 times a power of ten.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// The distance of one from the next.
    pub step: f64,
    /// From the lowest to the highest.
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// At most about `most` of them between `low` and `high`.
    pub(crate) fn between(low: f64, high: f64, most: usize) -> Self {
        let (step, exponent) = round_step((high - low) / most.max(1) as f64);
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let values = (first..=last).map(|multiple| multiple as f64 * step + 0.0).collect();
        Self { step, values, decimals: usize::try_from(-exponent).unwrap_or(0) }
    }

    /// As many as have room for their numbers along `scale`.
    pub(crate) fn along(scale: &Scale, language: Language) -> Self {
        const LETTER: f64 = 6.0;
        const GAP: f64 = 10.0;
        let [low, high] = scale.values;
        let length = (scale.places[1] - scale.places[0]).abs();
        let fits = |ticks: &Self| {
            let widest =
                ticks.values.iter().map(|value| ticks.text(*value, language).chars().count()).max().unwrap_or(0);
            LETTER * widest as f64 + GAP <= ticks.step / (high - low) * length
        };
        let fewer = (2..=8).rev().map(|most| Self::between(low, high, most));
        fewer.into_iter().find(fits).unwrap_or_else(|| Self::between(low, high, 1))
    }

    /// A value as the axis prints it.
    pub(crate) fn text(&self, value: f64, language: Language) -> String {
        Number::fixed(value, self.decimals).text(language)
    }
}

/// The next round step not below `step`, and its power of ten.
fn round_step(step: f64) -> (f64, i32) {
    if !(step > 0.0 && step.is_finite()) {
        return (1.0, 0);
    }
    let exponent = libm::floor(libm::log10(step)) as i32;
    let rounded = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power_of_ten(exponent) >= step * (1.0 - 1e-9));
    match rounded {
        Some(digit) => (digit * power_of_ten(exponent), exponent),
        None => (power_of_ten(exponent + 1), exponent + 1),
    }
}

/// 10 to the power `exponent`.
pub(crate) fn power_of_ten(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

/// The largest value of 1, 2 or 5 times a power of ten that is not above `value`: the length of a scale bar.
pub(crate) fn round_below(value: f64) -> f64 {
    let exponent = libm::floor(libm::log10(value)) as i32;
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power_of_ten(exponent) <= value * (1.0 + 1e-9));
    digit.unwrap_or(1.0) * power_of_ten(exponent)
}

/// `10⁻³` as a factor of a unit.
pub(crate) fn power(exponent: i32, language: Language) -> String {
    let one = localised(&format!("1e{exponent}"), language);
    one.find("10").map_or_else(String::new, |at| one[at..].to_owned())
}

/// The power of ten of the first digit of `value`.
fn exponent(value: f64) -> i32 {
    if value > 0.0 && value.is_finite() { libm::floor(libm::log10(value)) as i32 } else { 0 }
}

/// The power of ten to take out of the numbers of an axis that reaches to `reach`: 0 unless they had many zeros.
pub(crate) fn crowding(reach: f64) -> i32 {
    Some(exponent(reach)).filter(|exponent| !(-2..4).contains(exponent)).unwrap_or(0)
}

/// Nothing.
pub(crate) fn nothing() -> Markup {
    PreEscaped(String::new())
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
        assert_eq!(ticks.text(ticks.values[0], Language::Russian), "\u{2212}0,002");
        assert_eq!(Ticks::between(0.0, 0.0, 4).values, [0.0]);
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
    fn an_index_stands_lower() {
        let html = symbol("ω_0x").into_string();
        assert_eq!(html, r#"<tspan class="letter">ω</tspan><tspan class="index" dy="3">0x</tspan>"#);
    }
}
