//! A budget as bars (SVG), to be read in black and white: one panel a parameter, the largest contribution on top.

use super::budget::{Budget, ParameterBudget};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Bars of a panel; one more for what is left.
const MOST_BARS: usize = 6;

/// Width of a panel and of the names at its left, height of its title and of a bar, in pixels.
const PANEL_WIDTH: i32 = 620;
const NAMES_WIDTH: i32 = 210;
const TITLE_HEIGHT: i32 = 44;
const BAR_HEIGHT: i32 = 22;
const PANEL_HEIGHT: i32 = TITLE_HEIGHT + BAR_HEIGHT * (MOST_BARS as i32 + 1) + 14;

/// Width of the numbers at a panel's right, and height of the words below all.
const NUMBERS_WIDTH: i32 = 80;
const WORDS_HEIGHT: i32 = 34;

const WORDS: &str = "Bars: the standard uncertainty that each kind of input contributes. The frame is as wide as u, \
                     the root of the sum of their squares.";

/// The picture could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the picture could not be drawn: {0}")]
pub struct NoPicture(String);

/// The contributions to every parameter as bars, and the sum (root of squares) as the frame that they share; black and
/// grey on a white ground of its own.
///
/// # Errors
/// [`NoPicture`] when there is nothing to draw.
pub fn budget_svg(budget: &Budget) -> Result<String, NoPicture> {
    if budget.parameters.is_empty() || budget.inputs.is_empty() {
        return Err(NoPicture("nothing is uncertain".to_owned()));
    }
    let mut svg = String::new();
    draw(budget, &mut svg).map_err(|error| NoPicture(error.to_string()))?;
    // For those who hear it instead.
    let told = format!("<svg role=\"img\" aria-label=\"{}\" ", told(budget));
    Ok(svg.replacen("<svg ", &told, 1))
}

/// What the picture shows, in words.
fn told(budget: &Budget) -> String {
    let line = |line: &ParameterBudget| {
        let most = line.contributions.first().map_or_else(String::new, |first| {
            format!(", {:.0} % of its variance from {}", 100.0 * first.share, first.cause.kind())
        });
        format!("{}: u = {:.1e} {}{most}", line.parameter.symbol(), line.standard_uncertainty, line.parameter.unit())
    };
    format!("Uncertainty budget. {}.", budget.parameters.iter().map(line).collect::<Vec<_>>().join("; "))
}

type Drawn = Result<(), Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn draw(budget: &Budget, svg: &mut String) -> Drawn {
    const COLUMNS: usize = 2;
    let rows = budget.parameters.len().div_ceil(COLUMNS);
    let height = PANEL_HEIGHT * i32::try_from(rows)?;
    let size = (u32::try_from(PANEL_WIDTH)? * COLUMNS as u32, u32::try_from(height + WORDS_HEIGHT)?);
    let area = SVGBackend::with_string(svg, size).into_drawing_area();
    area.fill(&WHITE)?;
    let (panels, below) = area.split_vertically(height);
    for (panel, line) in panels.split_evenly((rows, COLUMNS)).iter().zip(&budget.parameters) {
        parameter(panel, line)?;
    }
    below.draw(&Text::new(WORDS, (14, 8), ("sans-serif", 16).into_font().color(&BLACK)))?;
    area.present()?;
    Ok(())
}

fn parameter(area: &Area, line: &ParameterBudget) -> Drawn {
    let title = ("sans-serif", 20).into_font().color(&BLACK);
    let words = ("sans-serif", 16).into_font().color(&BLACK);
    let (name, unit) = (line.parameter.symbol(), line.parameter.unit());
    let u = line.standard_uncertainty;
    area.draw(&Text::new(format!("{name}: u = {u:.1e} {unit}"), (14, 14), title))?;
    let mut bars: Vec<(String, f64)> =
        line.contributions.iter().map(|part| (part.cause.kind(), part.contribution)).collect();
    // One that is left is shown as it is.
    if bars.len() > MOST_BARS + 1 {
        let rest = bars.split_off(MOST_BARS);
        let sum: f64 = rest.iter().map(|(_, part)| part * part).sum();
        bars.push((format!("{} others", rest.len()), sum.sqrt()));
    }
    let left = NAMES_WIDTH;
    let right = PANEL_WIDTH - NUMBERS_WIDTH;
    let width = f64::from(right - left);
    let bottom = TITLE_HEIGHT + BAR_HEIGHT * i32::try_from(bars.len())?;
    for (row, (kind, part)) in bars.into_iter().enumerate() {
        let top = TITLE_HEIGHT + BAR_HEIGHT * i32::try_from(row)?;
        let length = if u > 0.0 { (width * part / u) as i32 } else { 0 };
        let right_aligned = words.clone().pos(Pos::new(HPos::Right, VPos::Top));
        area.draw(&Text::new(kind, (left - 8, top + 4), right_aligned))?;
        area.draw(&Rectangle::new([(left, top + 3), (left + length, top + BAR_HEIGHT - 4)], BLACK.mix(0.65).filled()))?;
        area.draw(&Text::new(format!("{part:.1e}"), (right + 8, top + 4), words.clone()))?;
    }
    // The frame's right side is u itself.
    let frame = [(left, TITLE_HEIGHT - 2), (right, bottom + 2)];
    area.draw(&Rectangle::new(frame, BLACK.stroke_width(1)))?;
    Ok(())
}
