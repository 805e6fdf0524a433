//! Expected calibration uncertainty: the standard uncertainty of every parameter against the tolerance of a gyro type, as
//! strips of a table.

use super::drawing::{Scale, legend, line, rectangle, strip, strip_axis};
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::calibration::{Found, Parameter, against_type};
use crate::passport::Accuracy;
use crate::report::page::language::Languages;
use crate::wording::texts::pictures as texts;
use maud::{Markup, html};

const WIDTH: f64 = 300.0;
const HEIGHT: f64 = 13.0;
/// Left and right end of the bars, with room for the outer numbers of the axis.
const BARS: [f64; 2] = [10.0, 282.0];
const BAR_HALF: f64 = 4.0;

/// Largest share of the tolerance on the axis. Larger values are drawn at its end.
const LARGEST_SHARE: f64 = 20.0;

/// Shares of the tolerances that the standard uncertainties have; `None` if the tolerance is 0.
#[derive(Clone, Copy)]
pub(crate) struct Shares {
    shares: [Option<f64>; 8],
    scale: Scale,
}

impl Shares {
    /// Creates the shares that a passport states. `gravity_m_per_s2` is the passport's, because the tolerances of the
    /// drifts are compared at the type's g.
    pub(crate) fn of(accuracy: &Accuracy, gravity_m_per_s2: f64) -> Self {
        let gyro = &accuracy.gyro;
        // The verdict on a gyro with exactly this uncertainty gives tolerance and uncertainty in one unit and at one g.
        // The passport states its values per local g, so the uncertainty of g is not included.
        let found = Found {
            parameters: gyro.nominal.to_model(),
            standard_uncertainty: accuracy.standard_uncertainty.to_model().to_vector(),
            degrees_of_freedom: [f64::INFINITY; 8],
            gravity_m_per_s2,
            gravity_u_m_per_s2: 0.0,
        };
        let verdict = against_type(&found, gyro);
        let shares = Parameter::AS_IN_THE_PAPER.map(|parameter| {
            let row = verdict.parameter(parameter)?;
            (row.tolerance > 0.0).then(|| row.expanded_uncertainty / COVERAGE_FACTOR / row.tolerance)
        });
        let largest = shares.into_iter().flatten().fold(0.5, f64::max);
        let reach = (1.08 * COVERAGE_FACTOR * largest).clamp(1.25, LARGEST_SHARE);
        Self { shares, scale: Scale { values: [0.0, reach], places: BARS } }
    }

    /// Draws the share of the parameter at a place of the paper's order.
    pub(crate) fn strip(&self, place: usize) -> Markup {
        let y = 0.5 * HEIGHT;
        let bar = |share: f64, class: &str| {
            rectangle([BARS[0], y - BAR_HALF], [self.scale.clamped(share), y + BAR_HALF], class, None)
        };
        let limit = self.scale.place(1.0);
        let drawing = html! {
            @if let Some(share) = self.shares[place] { (bar(COVERAGE_FACTOR * share, "bar-open")) (bar(share, "bar")) }
            (line([BARS[0], 0.0], [BARS[0], HEIGHT], "zero"))
            (line([limit, 0.0], [limit, HEIGHT], "limit"))
        };
        strip([WIDTH, HEIGHT], &drawing)
    }

    /// Draws the axis, in percent.
    pub(crate) fn axis(&self, languages: &Languages) -> Markup {
        let values = self.scale.values.map(|share| 100.0 * share);
        strip_axis(languages, &Scale { values, ..self.scale }, WIDTH)
    }

    /// Draws what bars and line mean.
    pub(crate) fn key(languages: &Languages) -> Markup {
        let bar = |class: &str| rectangle([2.0, 2.5], [26.0, 11.5], class, None);
        let limit = line([14.0, 0.0], [14.0, 14.0], "limit");
        let entries = [
            (bar("bar"), texts::ACCURACY_U),
            (bar("bar-open"), texts::ACCURACY_EXPANDED),
            (limit, texts::ACCURACY_LIMIT),
        ];
        legend(languages, &entries)
    }
}
