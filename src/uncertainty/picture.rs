//! A budget as bars (SVG), to be read in black and white: one panel a parameter, the largest contribution on top.

use super::budget::{Budget, ParameterBudget};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Bars of a panel at most; the rest is one bar.
const MOST_BARS: usize = 6;

/// Width of a panel and of the names at its left, height of its title and of a bar, in pixels.
const PANEL_WIDTH: i32 = 620;
const NAMES_WIDTH: i32 = 210;
const TITLE_HEIGHT: i32 = 44;
const BAR_HEIGHT: i32 = 22;
const PANEL_HEIGHT: i32 = TITLE_HEIGHT + BAR_HEIGHT * (MOST_BARS as i32 + 1) + 14;

/// The picture could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the picture could not be drawn: {0}")]
pub struct NoPicture(String);

/// The contributions to every parameter as bars, and the sum (root of squares) as the frame that they share.
///
/// # Errors
/// [`NoPicture`] when there is nothing to draw.
pub fn budget_svg(budget: &Budget) -> Result<String, NoPicture> {
    if budget.parameters.is_empty() || budget.inputs.is_empty() {
        return Err(NoPicture("nothing is uncertain".to_owned()));
    }
    let mut svg = String::new();
    draw(budget, &mut svg).map_err(|error| NoPicture(error.to_string()))?;
    Ok(svg)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn draw(budget: &Budget, svg: &mut String) -> Drawn {
    const COLUMNS: usize = 2;
    let rows = budget.parameters.len().div_ceil(COLUMNS);
    let size = (u32::try_from(PANEL_WIDTH)? * COLUMNS as u32, u32::try_from(PANEL_HEIGHT)? * u32::try_from(rows)?);
    let area = SVGBackend::with_string(svg, size).into_drawing_area();
    area.fill(&WHITE)?;
    for (panel, line) in area.split_evenly((rows, COLUMNS)).iter().zip(&budget.parameters) {
        parameter(panel, line)?;
    }
    area.present()?;
    Ok(())
}

fn parameter(area: &Area, line: &ParameterBudget) -> Drawn {
    let title = ("sans-serif", 17).into_font().color(&BLACK);
    let words = ("sans-serif", 13).into_font().color(&BLACK);
    let (name, unit) = (line.parameter.symbol(), line.parameter.unit());
    let u = line.standard_uncertainty;
    area.draw(&Text::new(format!("{name}: u = {u:.2e} {unit}"), (14, 14), title))?;
    let mut bars: Vec<(String, f64)> =
        line.contributions.iter().map(|part| (part.cause.kind(), part.contribution)).collect();
    if bars.len() > MOST_BARS {
        let rest = bars.split_off(MOST_BARS);
        let sum: f64 = rest.iter().map(|(_, part)| part * part).sum();
        bars.push((format!("{} others", rest.len()), sum.sqrt()));
    }
    let left = NAMES_WIDTH;
    let width = f64::from(PANEL_WIDTH - left - 90);
    let bottom = TITLE_HEIGHT + BAR_HEIGHT * i32::try_from(bars.len())?;
    for (row, (kind, part)) in bars.into_iter().enumerate() {
        let top = TITLE_HEIGHT + BAR_HEIGHT * i32::try_from(row)?;
        let length = if u > 0.0 { (width * part / u) as i32 } else { 0 };
        let right_aligned = words.clone().pos(Pos::new(HPos::Right, VPos::Top));
        area.draw(&Text::new(kind, (left - 8, top + 4), right_aligned))?;
        area.draw(&Rectangle::new([(left, top + 3), (left + length, top + BAR_HEIGHT - 4)], BLACK.mix(0.65).filled()))?;
        area.draw(&Text::new(format!("{part:.1e}"), (left + length + 6, top + 4), words.clone()))?;
    }
    // The frame's right side is u itself.
    let frame = [(left, TITLE_HEIGHT - 2), (left + width as i32, bottom + 2)];
    area.draw(&Rectangle::new(frame, BLACK.stroke_width(1)))?;
    Ok(())
}
