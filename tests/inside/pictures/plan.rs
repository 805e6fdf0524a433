//! The picture of a plan: its bars are as long as its numbers, next to those of the paper's eight.

use crate::inside::fixtures;
use crate::inside::picture::{number, of_class};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::plan::candidates::Angles;
use dtg_passport::plan::criterion::Criterion;
use dtg_passport::plan::{Evaluation, Plan, Question, plan};
use dtg_passport::report::picture::plan as picture;
use roxmltree::Document;

fn found(readings: u32) -> Plan {
    let question = Question {
        site: &fixtures::site(fixtures::SITE),
        stand: None,
        angles: Angles::QUADRANTS,
        gyro: &GyroType::gvk_6(),
        laboratory: &Laboratory::paper(),
        readings,
        azimuths_deg: vec![0.0],
        criterion: Criterion::A,
    };
    plan(&question).unwrap()
}

/// Expected: bars of u/T of K_x and ω_0x in the ratio of these numbers, of plan and paper; those of the errors on the same
/// scale; no bar where an error has no effect.
#[test]
fn bars_are_as_long_as_numbers() {
    let plan = found(8);
    let text = picture::plan(&plan, "bench");
    let page = Document::parse(&text).unwrap();
    let of_paper = of_class(page.root(), "open");
    let of_plan = of_class(page.root(), "bar").into_iter().filter(|bar| !of_paper.contains(bar)).collect::<Vec<_>>();
    // Each with the sample of the legend. Azimuth, level about north and seat about x and y have no effect on the plan.
    assert_eq!((of_plan.len(), of_paper.len()), (1 + 8 + 5, 1 + 8 + 9));
    let share = |u: &[f64; 8], place: usize| u[place] / plan.tolerance[place];
    let (plan_u, paper_u) = (&plan.evaluation.standard_uncertainty, &plan.paper.as_ref().unwrap().standard_uncertainty);
    let longest = |bars: &[roxmltree::Node]| bars[9..].iter().map(|bar| number(*bar, "width")).fold(0.0, f64::max);
    let largest = |of: &Evaluation| of.effects.iter().map(|effect| effect.largest_over_tolerance).fold(0.0, f64::max);
    // From the longest bar, because coordinates have one decimal.
    let scale = longest(&of_plan) / largest(&plan.evaluation);
    // The order of the paper's table: K_x, K_y, K_xy, K_yx, ω_0x, …
    for (row, place) in [(1, 0), (2, 3), (3, 1), (5, 4), (8, 7)] {
        for (bars, u) in [(&of_plan, plan_u), (&of_paper, paper_u)] {
            let width = number(bars[row], "width");
            assert!((width - scale * share(u, place)).abs() < 0.3, "row {row}: {width}");
        }
    }
    assert!((longest(&of_paper) - scale * largest(plan.paper.as_ref().unwrap())).abs() < 0.3);
    assert!(text.contains("frame’s axis at 0°") && text.contains("paper’s eight positions, axis at 90°"));
}

/// Expected: eight does not divide nine, so there is nothing to compare with.
#[test]
fn without_a_comparison_there_are_bars_of_the_plan_alone() {
    let text = picture::plan(&found(9), "bench");
    assert!(!text.contains("paper"));
    assert!(of_class(Document::parse(&text).unwrap().root(), "open").is_empty());
}
