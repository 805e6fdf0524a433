//! No reading, however absurd, makes the library panic, or gives a number that is none.

use crate::inside::reference::*;
use dtg_passport::calibration::inputs::MeterUncertainty;
use dtg_passport::calibration::{InputUncertainty, Model, Options, Readings, calibrate};
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector2;

/// Currents of any size, zeros and repeated values among them.
#[test]
fn absurd_readings() {
    for number in 0..300 {
        let stream = &mut Stream::new(number);
        let limit_deg = 22.5 + stream.within(22.5);
        let setup = setup(&drawn_stand(stream, limit_deg), stream.within(89.999));
        let mut current = || {
            let any = [1.0, 1e6, 1e-9].map(|limit| stream.within(limit));
            [0.0, 0.1, -0.1, any[0], any[1], any[2], 1e300, -1e-300][stream.below(8)]
        };
        let currents: Vec<_> = (0..8).map(|_| Vector2::new(current(), current())).collect();
        let model = [Model::Paper, Model::Anisoelastic, Model::General][stream.below(3)];
        let options = Options { model, ..Options::default() };
        if let Ok(found) = calibrate(&setup, &readings(&setup, &currents), &options) {
            for result in &found.results {
                assert!(result.parameters.to_vector().iter().all(|x| x.is_finite()), "{number}: {result:?}");
                assert!((0.0..=1.0).contains(&result.chi_square.probability), "{number}: {:?}", result.chi_square);
            }
            assert!(found.consistent || !found.causes.is_empty() || !found.settled, "{number}: {found:?}");
        }
    }
}

/// A meter without any uncertainty would weigh without limit: refused, in words.
#[test]
fn a_meter_without_uncertainty() {
    let none = MeterUncertainty { reading: 0.0, floor_ma: 0.0, noise_ma: 0.0, gain: 0.0, offset_ma: 0.0 };
    let setup = with_uncertainty(&eight([[1e-3; 3]; 8]), LATITUDE_DEG, InputUncertainty::of_meter(none));
    let currents = currents(&setup, &gvk_6());
    let error = calibrate(&setup, &readings(&setup, &currents), &Options::default()).unwrap_err();
    assert!(error.to_string().contains("every uncertainty positive"), "{error}");
    let index = setup.coefficients().positions[0].index;
    let error = Readings::new(setup.coefficients(), &[(index, Vector2::new(f64::NAN, 0.0))]).unwrap_err();
    assert!(error.to_string().contains("not finite"));
}

/// Readings of four positions at a stand of eight.
#[test]
fn readings_of_other_positions() {
    let whole = setup(&eight([[1e-3; 3]; 8]), LATITUDE_DEG);
    let half = setup(&eight([[1e-3; 3]; 8])[..4], LATITUDE_DEG);
    let readings = readings(&half, &currents(&half, &gvk_6()));
    let error = calibrate(&whole, &readings, &Options::default()).unwrap_err();
    assert!(error.to_string().contains("for different positions"), "{error}");
}
