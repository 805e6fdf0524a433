//! No reading, however absurd, makes the library panic, or gives a number that is none.

use crate::inside::reference::*;
use dtg_passport::calibration::inputs::MeterUncertainty;
use dtg_passport::calibration::{InputUncertainty, Model, Options, Readings, calibrate};
use dtg_passport::statistics::random::Stream;
use nalgebra::Vector2;
use proptest::prelude::*;

/// Currents of any size, zeros and repeated values among them.
fn current() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(0.1),
        Just(-0.1),
        -1.0..1.0_f64,
        -1e6..1e6_f64,
        -1e-9..1e-9_f64,
        Just(1e300),
        Just(-1e-300)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn absurd_readings(
        seed in any::<u64>(), limit_deg in 0.0..45.0, latitude in -89.999..89.999,
        values in prop::collection::vec(current(), 16), model in 0..3_usize,
    ) {
        let setup = setup(&drawn_stand(&mut Stream::new(seed), limit_deg), latitude);
        let currents: Vec<_> = values.chunks_exact(2).map(|pair| Vector2::new(pair[0], pair[1])).collect();
        let options = Options { model: [Model::Paper, Model::Anisoelastic, Model::General][model], ..Options::default() };
        if let Ok(found) = calibrate(&setup, &readings(&setup, &currents), &options) {
            for result in &found.results {
                prop_assert!(result.parameters.to_vector().iter().all(|x| x.is_finite()), "{result:?}");
                prop_assert!((0.0..=1.0).contains(&result.chi_square.probability), "{:?}", result.chi_square);
            }
            prop_assert!(found.consistent || !found.causes.is_empty() || !found.settled, "{found:?}");
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
