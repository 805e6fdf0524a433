//! The paper's Fig. 4, read off by the marks of its axes.

use crate::inside::picture::{Axis, number, of_class};
use dtg_passport::report::picture::simulation;
use dtg_passport::simulation::convergence::{Convergence, ConvergenceRow};
use roxmltree::{Document, Node};

/// Made-up numbers: uniform within ±1°, ±10° and ±farthest, corners at ±10°; of the last uniform row none converged.
fn made_up(farthest: f64) -> Convergence {
    let row = |limit_deg, deviations, steps: Option<(f64, usize, usize)>, not_converged_percent| ConvergenceRow {
        limit_deg,
        deviations,
        mean: steps.map(|(mean, ..)| mean),
        mean_u: steps.map(|_| 0.05),
        percentile_95: steps.map(|(_, percentile, _)| percentile),
        most: steps.map(|(.., most)| most),
        not_converged_percent,
        not_converged_u_percent: if matches!(not_converged_percent, 0.0 | 100.0) { 0.0 } else { 15.0 },
        stands: 7,
    };
    let rows = vec![
        row(1.0, "uniform", Some((2.5, 3, 4)), 0.0),
        row(10.0, "uniform", Some((7.25, 50, 200)), 12.5),
        row(farthest, "uniform", None, 100.0),
        row(10.0, "corners", Some((9.0, 9, 9)), 40.0),
    ];
    Convergence { trials: 7, seed: 1, rows }
}

/// The ends of the lines of a class.
fn series(group: Node) -> Vec<Vec<[f64; 2]>> {
    let at = |point: &str| point.split_once(',').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap();
    let lines = group.descendants().filter(|node| node.has_tag_name("polyline"));
    lines.map(|line| line.attribute("points").unwrap().split_whitespace().map(at).collect()).collect()
}

fn says(axes: &[Axis; 2], found: &[[f64; 2]], due: &[[f64; 2]]) {
    assert_eq!(found.len(), due.len());
    for (found, due) in found.iter().zip(due) {
        for (axis, (at, value)) in axes.iter().zip(found.iter().zip(due)) {
            axis.says(*at, *value);
        }
    }
}

#[test]
fn lines_are_where_the_axes_say() {
    let text = simulation::convergence(&made_up(30.0)).unwrap();
    let page = Document::parse(&text).unwrap();
    let picture = of_class(page.root(), "picture")[0];
    // By hand: no case in 7 has the probability 0.05 if the share is 1 - 0.05^(1/7), 34.8 %.
    for words in [
        "1°: most 4.0, 95th percentile 3.0, mean of the converged 2.5, not converged, %: < 35;",
        "30°: not converged, %: > 65;",
    ] {
        assert!(text.contains(&words.replace('<', "&lt;").replace('>', "&gt;")), "{words} in {text}");
    }
    let groups: Vec<Node> = picture.children().filter(|node| node.has_tag_name("g")).collect();
    let [steps, share] = groups.as_slice() else { panic!("{} fields", groups.len()) };

    let axes = [Axis::along_x(*steps), Axis::of_logarithms(*steps)];
    let found = series(*steps);
    assert_eq!(found.len(), 3);
    for (found, [first, second]) in found.iter().zip([[4.0, 200.0], [3.0, 50.0], [2.5, 7.25]]) {
        says(&axes, found, &[[1.0, libm::log10(first)], [10.0, libm::log10(second)]]);
    }
    axes[0].says(number(of_class(*steps, "limit")[0], "x1"), 15.0);

    let axes = [Axis::along_x(*share), Axis::along_y(*share)];
    let found = series(*share);
    assert_eq!(found.len(), 2);
    says(&axes, &found[0], &[[1.0, 0.0], [10.0, 12.5], [30.0, 100.0]]);
    says(&axes, &found[1], &[[10.0, 40.0]]);
}
