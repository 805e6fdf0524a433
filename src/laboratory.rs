//! The laboratory: its meter, how the gyro sits, how the base stands: the file `dtg-laboratory/1`.

use crate::text::{Path, Problems, record};

/// The format of a laboratory file.
pub(crate) const LABORATORY_FORMAT: &str = "dtg-laboratory/1";

record! {
    /// The meter of the torquer currents. All but the range are standard uncertainties.
    pub struct Meter {
        /// The largest current that it reads, either way.
        pub range_ma: f64,
        /// Of the meter's specification, in percent of the reading: own of each position and channel, and not made smaller by
        /// reading again.
        pub reading_percent: f64,
        /// Of the gain that all readings share, in percent.
        pub gain_percent: f64,
        /// Of the offset that all readings share.
        pub offset_ma: f64,
        /// Of the specification too, whatever the size of the reading; never 0, or a zero current would count without limit.
        pub floor_ma: f64,
        /// Noise of every single reading. Absent: 0, and repeated rows show what it is.
        pub noise_ma: Option<f64>,
    }
}

record! {
    /// Standard uncertainties of the gyro's seat on the platform: turns about the case axes.
    pub struct Seating {
        /// About x.
        pub about_x: f64,
        /// About y.
        pub about_y: f64,
        /// About z, the spin axis.
        pub about_z: f64,
    }
}

record! {
    /// Standard uncertainties of the base as the laboratory measured it, in place of the site's.
    pub struct Base {
        /// Of its azimuth.
        pub azimuth_arcsec: Option<f64>,
        /// Of its level, per axis.
        pub level_arcsec: Option<f64>,
    }
}

record! {
    /// A laboratory (`dtg-laboratory/1`).
    pub struct Laboratory {
        /// Always "dtg-laboratory/1".
        pub format: String,
        /// Its name.
        pub name: Option<String>,
        /// Its meter.
        pub meter: Meter,
        /// How well the gyro sits.
        pub seating_arcsec: Option<Seating>,
        /// How well the base stands.
        pub base: Option<Base>,
        /// Temperature during the calibration.
        pub temperature_c: Option<f64>,
    }
}

impl Laboratory {
    /// Reads a `dtg-laboratory/1` file; `name` is its name in messages.
    ///
    /// # Errors
    /// Every mistake with its line, column and field: see [`crate::text::Unreadable`].
    #[cfg(feature = "factory")]
    pub fn from_yaml(name: &str, bytes: &[u8]) -> Result<Self, crate::text::Unreadable> {
        crate::text::yaml::read_document(name, bytes, LABORATORY_FORMAT, |laboratory: &Self, problems| {
            laboratory.check(&Path::Root, problems);
        })
    }

    /// The rules of a laboratory's content.
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
        problems.within(&at.key("temperature_c"), self.temperature_c, -90.0, 100.0);
    }

    /// A meter of the paper's accuracy and nothing else stated: ±0.015 % of the reading (paper, before the table).
    ///
    /// Limits are read as those of a uniform distribution (GUM, 4.3.7): 0.015 %/√3 = 0.0087 %.
    pub fn paper() -> Self {
        Self {
            format: LABORATORY_FORMAT.to_owned(),
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
        for (key, value) in [("range_ma", self.range_ma), ("floor_ma", self.floor_ma)] {
            if value <= 0.0 {
                let advice = match key {
                    "floor_ma" => "no meter reads a zero current without error: half a digit over the square root of 3",
                    _ => "",
                };
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

    const FILE: &str = r#"format: "dtg-laboratory/1"
name: "Gyro laboratory"
meter: {range_ma: 1.0, reading_percent: 0.0087, gain_percent: 0.0, offset_ma: 0.0, floor_ma: 1.0e-06}
seating_arcsec: {about_x: 5.0, about_y: 5.0, about_z: 10.0}
base: {azimuth_arcsec: 10.0, level_arcsec: 3.0}
temperature_c: 21.0
"#;

    #[test]
    fn reads_what_the_format_says() {
        let laboratory = Laboratory::from_yaml("laboratory.yaml", FILE.as_bytes()).unwrap();
        assert_eq!(laboratory.meter, Laboratory::paper().meter);
        assert_eq!(laboratory.seating_arcsec.unwrap().about_z, 10.0);
        assert_eq!(laboratory.base.unwrap().level_arcsec, Some(3.0));
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
