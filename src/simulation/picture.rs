//! The paper's Fig. 4 as SVG, to be read in black and white: lines differ by dashes and marks, not by colour.

use super::convergence::{Convergence, ConvergenceRow};
use plotters::prelude::*;

/// Width and height, pixels of SVG.
const SIZE: (u32, u32) = (900, 640);

/// The picture could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the picture could not be drawn: {0}")]
pub struct NoPicture(String);

/// Steps against the limit of the deviations, and below it the share that does not converge.
///
/// # Errors
/// [`NoPicture`] when there are no rows to draw.
pub fn convergence_svg(convergence: &Convergence) -> Result<String, NoPicture> {
    if convergence.rows.is_empty() {
        return Err(NoPicture("no rows".to_owned()));
    }
    let mut svg = String::new();
    draw(convergence, &mut svg).map_err(|error| NoPicture(error.to_string()))?;
    Ok(svg)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(convergence: &Convergence, svg: &mut String) -> Drawn {
    let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let (upper, lower) = area.split_vertically(SIZE.1 * 2 / 3);
    let of =
        |kind: &str| -> Vec<&ConvergenceRow> { convergence.rows.iter().filter(|row| row.deviations == kind).collect() };
    let (uniform, corners) = (of("uniform"), of("corners"));
    let largest = convergence.rows.iter().map(|row| row.limit_deg).fold(1.0, f64::max);
    steps(&upper, &uniform, largest, convergence.trials)?;
    share(&lower, &uniform, &corners, largest)?;
    area.present()?;
    Ok(())
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// How a line looks: dash length and gap, and its mark.
#[derive(Clone, Copy)]
enum Look {
    Solid,
    Dashed,
    Dotted,
}

/// One of the numbers of a row.
type Steps = fn(&ConvergenceRow) -> Option<f64>;

fn steps(area: &Area, rows: &[&ConvergenceRow], largest_deg: f64, trials: u64) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption(
            format!("Steps of successive approximation, {trials} stands per point, uniform within ±D"),
            ("sans-serif", 20),
        )
        .margin(12)
        .margin_right(30)
        .x_label_area_size(20)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..largest_deg, (1.0..220.0).log_scale())?;
    let axes = &mut chart.configure_mesh();
    axes.light_line_style(WHITE).bold_line_style(BLACK.mix(0.15)).y_desc("steps (first approximation = 1)");
    axes.label_style(("sans-serif", 14))
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_labels(8)
        .y_label_formatter(&|value| format!("{value:.0}"))
        .draw()?;
    let series: [(&str, Look, Steps); 3] = [
        ("most", Look::Solid, |row| row.most.map(|most| most as f64)),
        ("95th percentile", Look::Dashed, |row| row.percentile_95.map(|value| value as f64)),
        ("mean of those that converge", Look::Dotted, |row| row.mean),
    ];
    for (label, look, value) in series {
        let points: Vec<_> = rows.iter().filter_map(|row| Some((row.limit_deg, value(row)?))).collect();
        line(&mut chart, label, look, points)?;
    }
    // The paper's limit of applicability.
    let limit = vec![(15.0, 1.0), (15.0, 220.0)];
    chart.draw_series(DashedLineSeries::new(limit, 2, 4, BLACK.stroke_width(1)))?;
    chart.draw_series([Text::new("paper: 15°", (15.2, 1.4), ("sans-serif", 13))])?;
    legend(&mut chart)
}

fn share(area: &Area, uniform: &[&ConvergenceRow], corners: &[&ConvergenceRow], largest_deg: f64) -> Drawn {
    let most = uniform.iter().chain(corners).map(|row| row.not_converged_percent).fold(1.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(30)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..largest_deg, 0.0..most * 1.1)?;
    let axes = &mut chart.configure_mesh();
    axes.light_line_style(WHITE).bold_line_style(BLACK.mix(0.15)).y_desc("not in 200 steps, %");
    axes.x_desc("limit D of the deviations, degrees")
        .label_style(("sans-serif", 14))
        .x_label_formatter(&|value| format!("{value:.0}"))
        .y_labels(5)
        .y_label_formatter(&|value| format!("{value:.0}"))
        .draw()?;
    for (label, look, rows) in
        [("uniform within ±D", Look::Solid, uniform), ("every angle +D or −D", Look::Dashed, corners)]
    {
        let points: Vec<_> = rows.iter().map(|row| (row.limit_deg, row.not_converged_percent)).collect();
        line(&mut chart, label, look, points)?;
    }
    legend(&mut chart)
}

type Chart<'a, 'b, X, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>;

/// A line with a mark at each point, and its place in the legend.
fn line<'a, 'b: 'a, X, Y>(chart: &mut Chart<'a, 'b, X, Y>, label: &str, look: Look, points: Vec<(f64, f64)>) -> Drawn
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    if points.is_empty() {
        return Ok(());
    }
    let (dash, gap) = match look {
        Look::Solid => (1, 0),
        Look::Dashed => (10, 5),
        Look::Dotted => (2, 4),
    };
    let style = BLACK.stroke_width(2);
    let in_legend = move |(x, y): (i32, i32)| {
        let part = match look {
            Look::Solid => vec![(x, y), (x + 34, y)],
            Look::Dashed => vec![(x, y), (x + 13, y)],
            Look::Dotted => vec![(x, y), (x + 4, y)],
        };
        let second = part.iter().map(|(px, py)| (px + if dash == 1 { 0 } else { 20 }, *py)).collect::<Vec<_>>();
        EmptyElement::at((0, 0)) + PathElement::new(part, style) + PathElement::new(second, style)
    };
    if dash == 1 {
        chart.draw_series(LineSeries::new(points.clone(), style))?.label(label).legend(in_legend);
    } else {
        chart.draw_series(DashedLineSeries::new(points.clone(), dash, gap, style))?.label(label).legend(in_legend);
    }
    match look {
        Look::Solid => chart.draw_series(points.iter().map(|point| Circle::new(*point, 4, BLACK.filled())))?,
        Look::Dashed => chart.draw_series(points.iter().map(|point| TriangleMarker::new(*point, 6, BLACK.filled())))?,
        Look::Dotted => chart.draw_series(points.iter().map(|point| Cross::new(*point, 4, style)))?,
    };
    Ok(())
}

fn legend<'a, 'b: 'a, X, Y>(chart: &mut Chart<'a, 'b, X, Y>) -> Drawn
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .legend_area_size(44)
        .label_font(("sans-serif", 14))
        .background_style(WHITE.filled())
        .border_style(BLACK)
        .draw()?;
    Ok(())
}
