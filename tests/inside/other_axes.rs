//! Runs with exchanged columns, or with the sign of a column reversed, are refused like runs in another unit.

use crate::inside::simulated_stands::{Truth, csv, header, normal, read};
use dtg_passport::certification::AngleReadings;
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector3;

/// What is wrong with the angles of a run.
type Change = fn(&mut Vector3<f64>);

/// Columns exchanged, or the sign of one reversed, in one run of three and of five: refused at the line of the run, and
/// the same run as it should be is not.
#[test]
fn a_run_with_other_axes_is_refused() {
    let small = Truth { angles_arcsec: [(); 8].map(|()| Vector3::zeros()), ..Truth::new([1.5; 3], 2.0, 1.0) };
    let mut stream = Stream::new(41);
    for runs in [3, 5] {
        let angles = [(); 8].map(|()| normal(&mut stream, [60.0; 3]));
        let good = Truth { angles_arcsec: angles, ..small }.measured(&mut stream, runs);
        let changes: [(Change, &str); 4] = [
            (|at| at.swap_rows(0, 1), "beta where the other runs have alpha, alpha where the other runs have beta"),
            (|at| at.z = -at.z, "which has -gamma where the other runs have gamma"),
            (|at| *at = Vector3::new(at.y, at.z, at.x), "gamma where the other runs have alpha"),
            (|at| *at = Vector3::new(at.x, -at.z, at.y), "gamma where the other runs have beta"),
        ];
        for (change, words) in changes {
            let mut each = good.each_arcsec.clone();
            each.iter_mut().for_each(|of_runs| change(&mut of_runs[2]));
            let text = csv(&AngleReadings::new(good.runs.clone(), each).unwrap());
            let refused =
                AngleReadings::from_csv("a.csv", text.as_bytes(), &header().positions).unwrap_err().to_string();
            // The header of the table, two runs of eight, and then the first line of the run.
            assert!(refused.starts_with("a.csv:18:5: run: found run 3, which has "), "{refused}");
            assert!(refused.contains(words), "{refused}");
            assert_eq!(refused.matches("a.csv:").count(), 1, "{refused}");
        }
        read(&csv(&good));
    }
    // Angles that are nothing but scatter have no axes to exchange.
    for _ in 0..200 {
        read(&csv(&small.measured(&mut stream, 3)));
    }
}
