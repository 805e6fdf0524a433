//! The laboratory file (`dtg-laboratory/1`): current meter, gyro seat and base.

use crate::text::{Document, Path, Problems, record};
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::{implausible, units};

/// Lowest and highest temperature of a laboratory, °C.
pub(crate) const TEMPERATURES_C: [f64; 2] = [-90.0, 100.0];

/// Standard uncertainty of a meter above which it is usually in another unit, percent of the reading or of the range.
const LARGEST_PERCENT: f64 = 1.0;

/// Standard uncertainty of a rotation of the gyro or of the base above which it is usually in another unit, arcsec: a degree.
const LARGEST_TURN_ARCSEC: f64 = 3600.0;

record! {
    /// Current meter. All values except the range are standard uncertainties.
    pub struct Meter {
        /// Largest current in either direction.
        pub range_ma: f64,
        /// Part of the specification in percent of the reading, independent for each position and channel.
        pub reading_percent: f64,
        /// Gain, common to all readings, in percent.
        pub gain_percent: f64,
        /// Offset, common to all readings.
        pub offset_ma: f64,
        /// Part of the specification that does not depend on the reading; must be positive.
        pub floor_ma: f64,
        /// Noise of a single reading; estimated from repeated rows, or 0, if absent.
        pub noise_ma: Option<f64>,
    }
}

record! {
    /// Standard uncertainties of the gyro seat on the platform: rotations about the case axes.
    pub struct Seating {
        /// Rotation about x.
        pub about_x: f64,
        /// Rotation about y.
        pub about_y: f64,
        /// Rotation about z, the spin axis.
        pub about_z: f64,
    }
}

record! {
    /// Standard uncertainties of the base as measured by the laboratory; they replace those of the site.
    pub struct Base {
        /// Uncertainty of the azimuth.
        pub azimuth_arcsec: Option<f64>,
        /// Uncertainty of the level, per axis.
        pub level_arcsec: Option<f64>,
    }
}

record! {
    /// Laboratory (`dtg-laboratory/1`).
    pub struct Laboratory {
        /// Name of the laboratory.
        pub name: Option<String>,
        /// Current meter.
        pub meter: Meter,
        /// Standard uncertainties of the gyro seat.
        pub seating_arcsec: Option<Seating>,
        /// Standard uncertainties of the base.
        pub base: Option<Base>,
        /// Temperature during the calibration.
        pub temperature_c: Option<f64>,
    }
}

impl Document for Laboratory {
    const FORMAT: &'static str = "dtg-laboratory/1";
}

impl Laboratory {
    /// Reads a `dtg-laboratory/1` file; `name` is the file name in messages.
    ///
    /// # Errors
    /// Returns [`crate::text::Unreadable`] with the line, column and field of every error.
    #[cfg(feature = "yaml")]
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, crate::text::Unreadable> {
        crate::text::yaml::read_document(name, bytes, |laboratory: &Self, problems| {
            laboratory.check(&Path::Root, problems);
        })
    }

    pub(crate) fn check(&self, at: &Path, problems: &mut Problems) {
        self.meter.check(&at.key("meter"), problems);
        if let Some(Seating { about_x, about_y, about_z }) = self.seating_arcsec {
            let at = at.key("seating_arcsec");
            for (key, value) in [("about_x", about_x), ("about_y", about_y), ("about_z", about_z)] {
                problems.within(&at.key(key), Some(value), 0.0, f64::MAX);
            }
        }
        if let Some(Base { azimuth_arcsec, level_arcsec }) = self.base {
            let at = at.key("base");
            problems.within(&at.key("azimuth_arcsec"), azimuth_arcsec, 0.0, f64::MAX);
            problems.within(&at.key("level_arcsec"), level_arcsec, 0.0, f64::MAX);
        }
        let [low, high] = TEMPERATURES_C;
        problems.within(&at.key("temperature_c"), self.temperature_c, low, high);
    }

    /// Returns the stated uncertainties that are too large for any laboratory, a sentence each without a full stop: they are
    /// possible, but usually stated in another unit, such as parts per million instead of percent.
    pub(crate) fn remarks(&self) -> Vec<Words> {
        let Meter { range_ma, reading_percent, gain_percent, offset_ma, floor_ma, noise_ma } = self.meter;
        let of_range = LARGEST_PERCENT / 100.0 * range_ma;
        let seat = self.seating_arcsec.as_ref().map_or([0.0; 3], |seat| [seat.about_x, seat.about_y, seat.about_z]);
        let [azimuth, level] = self
            .base
            .as_ref()
            .map_or([0.0; 2], |base| [base.azimuth_arcsec, base.level_arcsec].map(Option::unwrap_or_default));
        let [x, y, z] = seat.map(|arcsec| (arcsec, LARGEST_TURN_ARCSEC, units::ARCSEC));
        let each = [
            ("meter.reading_percent", (reading_percent, LARGEST_PERCENT, units::PERCENT)),
            ("meter.gain_percent", (gain_percent, LARGEST_PERCENT, units::PERCENT)),
            ("meter.offset_ma", (offset_ma, of_range, units::MILLIAMPERES)),
            ("meter.floor_ma", (floor_ma, of_range, units::MILLIAMPERES)),
            ("meter.noise_ma", (noise_ma.unwrap_or_default(), of_range, units::MILLIAMPERES)),
            ("seating_arcsec.about_x", x),
            ("seating_arcsec.about_y", y),
            ("seating_arcsec.about_z", z),
            ("base.azimuth_arcsec", (azimuth, LARGEST_TURN_ARCSEC, units::ARCSEC)),
            ("base.level_arcsec", (level, LARGEST_TURN_ARCSEC, units::ARCSEC)),
        ];
        let odd = each.into_iter().filter(|(_, (value, largest, _))| value > largest);
        let words = odd.map(|(key, (value, largest, unit))| {
            let [value, largest] = [value, largest].map(|value| Words::Quantity(Number::exact(value), unit));
            implausible::of_laboratory(key, value, largest)
        });
        words.collect()
    }

    /// Creates a laboratory with a meter of the paper's accuracy, ±0.015 % of the reading (paper, before the table),
    /// and no other statements.
    ///
    /// The limits are taken as those of a uniform distribution (GUM, 4.3.7): 0.015 %/√3 = 0.0087 %.
    pub fn paper() -> Self {
        Self {
            name: None,
            meter: Meter {
                range_ma: 1.0,
                reading_percent: 0.0087,
                gain_percent: 0.0,
                offset_ma: 0.0,
                floor_ma: 1e-6,
                noise_ma: None,
            },
            seating_arcsec: None,
            base: None,
            temperature_c: None,
        }
    }
}

impl Meter {
    fn check(&self, at: &Path, problems: &mut Problems) {
        let at_zero =
            "use at least half a digit divided by the square root of 3; no meter measures zero current without error";
        for (key, value, advice) in [("range_ma", self.range_ma, ""), ("floor_ma", self.floor_ma, at_zero)] {
            if value <= 0.0 {
                problems.at(&at.key(key), format!("{value}"), "a positive number", advice);
            }
        }
        for (key, value) in [
            ("reading_percent", self.reading_percent),
            ("gain_percent", self.gain_percent),
            ("offset_ma", self.offset_ma),
        ] {
            problems.within(&at.key(key), Some(value), 0.0, f64::MAX);
        }
        problems.within(&at.key("noise_ma"), self.noise_ma, 0.0, f64::MAX);
    }
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::wording::Language;

    const FILE: &str = r#"format: "dtg-laboratory/1"
name: "Gyro laboratory"
meter: {range_ma: 1.0, reading_percent: 0.0087, gain_percent: 0.0, offset_ma: 0.0, floor_ma: 1.0e-06}
seating_arcsec: {about_x: 5.0, about_y: 5.0, about_z: 10.0}
base: {azimuth_arcsec: 10.0, level_arcsec: 3.0}
temperature_c: 21.0
"#;

    /// Expected: a remark on the key alone that is a thousand times too large, as of a unit a thousand times smaller.
    #[test]
    fn an_uncertainty_in_another_unit_has_a_remark() {
        assert!(Laboratory::from_yaml("l", FILE.as_bytes()).unwrap().remarks().is_empty());
        for (from, to, key) in [
            ("reading_percent: 0.0087", "reading_percent: 8.7", "meter.reading_percent of the laboratory is 8.7 %,"),
            ("floor_ma: 1.0e-06", "floor_ma: 0.5", "meter.floor_ma of the laboratory is 0.5 mA,"),
            ("about_z: 10.0", "about_z: 10000.0", "seating_arcsec.about_z of the laboratory is 10\u{202f}000″,"),
            ("level_arcsec: 3.0", "level_arcsec: 3600.5", "base.level_arcsec of the laboratory is 3600.5″,"),
        ] {
            let remarks = Laboratory::from_yaml("l", FILE.replace(from, to).as_bytes()).unwrap().remarks();
            assert!(remarks.len() == 1 && remarks[0].plain(Language::English).starts_with(key), "{remarks:?}");
        }
    }

    #[test]
    fn every_mistake_is_named() {
        let file = FILE.replace("floor_ma: 1.0e-06", "floor_ma: 0.0").replace("about_x: 5.0", "about_x: -5.0");
        let error = Laboratory::from_yaml("laboratory.yaml", file.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("laboratory.yaml:3:") && error.contains("meter.floor_ma: found 0"), "{error}");
        assert!(error.contains("laboratory.yaml:4:") && error.contains("seating_arcsec.about_x: found -5"), "{error}");
        let unknown = Laboratory::from_yaml("l", FILE.replace("gain_percent", "gain").as_bytes()).unwrap_err();
        assert!(unknown.to_string().contains("unknown key \"gain\""), "{unknown}");
    }
}
