//! Expected calibration uncertainty: the standard uncertainty of every parameter against the tolerance of a gyro type.

use super::drawing::{Anchor, Panel, Scale, Ticks, label, legend, line, plain_symbol, rectangle, symbol, words};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::calibration::{Found, Parameter, against_type};
use crate::passport::Accuracy;
use crate::report::page::Number;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::texts::{pictures as texts, units};
use maud::{Markup, html};

const PANEL_PIXELS: u32 = 330;
const WIDTH: f64 = 460.0;
const BARS: [f64; 2] = [44.0, 450.0];
const TOP: f64 = 5.0;
const ROW: f64 = 17.0;
const BAR_HALF: f64 = 5.0;
const AXIS_HEIGHT: f64 = 20.0;

/// Largest share of the tolerance on the axis. Larger values are drawn at its end.
const LARGEST_SHARE: f64 = 20.0;

/// A parameter, its standard uncertainty, and its share of the tolerance, which is `None` if the tolerance is 0.
struct Row {
    parameter: Parameter,
    u: f64,
    share: Option<f64>,
}

/// Draws the accuracy that a passport states. `gravity_m_per_s2` is the passport's, because the tolerances of the
/// drifts are compared at the type's g.
pub(crate) fn accuracy(languages: &Languages, accuracy: &Accuracy, gravity_m_per_s2: f64) -> Markup {
    let rows = rows(accuracy, gravity_m_per_s2);
    let largest = rows.iter().filter_map(|row| row.share).fold(0.5, f64::max);
    let reach = (1.08 * COVERAGE_FACTOR * largest).clamp(1.25, LARGEST_SHARE);
    let scale = Scale { values: [0.0, reach], places: BARS };
    let bottom = TOP + ROW * rows.len() as f64;
    let panel = Panel { name: "accuracy", languages, size: [WIDTH, bottom + AXIS_HEIGHT] };
    let drawing = [
        panel.hatch("beyond"),
        rectangle([scale.place(1.0), TOP], [BARS[1], bottom], "beyond", Some(&panel.filled_with("beyond"))),
        grid(languages, &scale, bottom),
        html! { @for (place, row) in rows.iter().enumerate() { (bar(row, &scale, TOP + ROW * (place as f64 + 0.5))) } },
        line([BARS[0], TOP], [BARS[0], bottom], "zero"),
        line([scale.place(1.0), TOP - 5.0], [scale.place(1.0), bottom + 5.0], "limit"),
    ];
    let description = |language| in_words(language, &rows);
    panel.alone(PANEL_PIXELS, texts::ACCURACY_TITLE, description, &drawing, &key(&panel))
}

fn key(panel: &Panel) -> Markup {
    let bar = |class: &str| rectangle([2.0, 2.5], [26.0, 11.5], class, None);
    let beyond = html! {
        (rectangle([14.0, 0.0], [26.0, 14.0], "beyond", Some(&panel.filled_with("beyond"))))
        (line([14.0, 0.0], [14.0, 14.0], "limit"))
    };
    let entries =
        [(bar("bar"), texts::ACCURACY_U), (bar("bar-open"), texts::ACCURACY_EXPANDED), (beyond, texts::ACCURACY_LIMIT)];
    legend(panel.languages, &entries)
}

fn rows(accuracy: &Accuracy, gravity_m_per_s2: f64) -> Vec<Row> {
    let gyro = &accuracy.gyro;
    let standard_uncertainty = accuracy.standard_uncertainty.to_model().to_vector();
    // The verdict on a gyro with exactly this uncertainty gives tolerance and uncertainty in one unit and at one g.
    // The passport states its values per local g, so the uncertainty of g is not included.
    let parameters = gyro.nominal.to_model();
    let degrees_of_freedom = [f64::INFINITY; 8];
    let found =
        Found { parameters, standard_uncertainty, degrees_of_freedom, gravity_m_per_s2, gravity_u_m_per_s2: 0.0 };
    let verdict = against_type(&found, gyro);
    let share = |parameter: Parameter| {
        let row = verdict.parameter(parameter)?;
        (row.tolerance > 0.0).then(|| row.expanded_uncertainty / COVERAGE_FACTOR / row.tolerance)
    };
    let row =
        |parameter: Parameter| Row { parameter, u: standard_uncertainty[parameter.place()], share: share(parameter) };
    Parameter::AS_IN_THE_PAPER.map(row).into()
}

/// Returns the unit of a parameter on pages.
pub(crate) fn unit(parameter: Parameter) -> Text {
    match parameter {
        Parameter::Kx | Parameter::Kxy | Parameter::Kyx | Parameter::Ky => units::DEG_PER_H_PER_MA,
        Parameter::Omega0x | Parameter::Omega0y | Parameter::TurnOn(_) => units::DEG_PER_H,
        Parameter::OmegaG | Parameter::OmegaK | Parameter::G(..) => units::DEG_PER_H_PER_G,
        Parameter::Drift(_) => units::DEG_PER_H2,
        Parameter::Anisoelasticity => units::DEG_PER_H_PER_G2,
    }
}

fn grid(languages: &Languages, scale: &Scale, bottom: f64) -> Markup {
    let ticks = Ticks::between(0.0, 100.0 * scale.values[1], 6);
    html! {
        @for (percent, text) in ticks.marks(languages.first()) {
            @let x = scale.place(percent / 100.0);
            (line([x, TOP], [x, bottom + 4.0], "grid"))
            (words([x, bottom + 16.0], Anchor::Middle, "small", &format!("{text}\u{a0}%")))
        }
    }
}

fn bar(row: &Row, scale: &Scale, y: f64) -> Markup {
    let bars = row.share.map_or_else(Markup::default, |share| {
        let end = |share: f64, half: f64| [scale.clamped(share), y + half];
        html! {
            (rectangle([BARS[0], y - BAR_HALF], end(COVERAGE_FACTOR * share, BAR_HALF), "bar-open", None))
            (rectangle([BARS[0], y - BAR_HALF], end(share, BAR_HALF), "bar", None))
        }
    });
    html! {
        (label([36.0, y + 4.0], Anchor::End, "", &symbol(row.parameter.symbol())))
        (bars)
    }
}

fn in_words(language: Language, rows: &[Row]) -> String {
    let each = rows.iter().map(|row| {
        let (parameter, u, unit) =
            (plain_symbol(row.parameter.symbol()), Number::uncertainty(row.u), unit(row.parameter));
        match row.share.map(|share| Number::whole_or_two_digits(100.0 * share)) {
            Some(share) => texts::ACCURACY_IN_WORDS.filled(language, values! { parameter, u, unit, share }),
            None => texts::ACCURACY_NO_TOLERANCE_IN_WORDS.filled(language, values! { parameter, u, unit }),
        }
    });
    each.collect::<Vec<_>>().join("; ") + "."
}
