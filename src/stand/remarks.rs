//! Remarks on unusual values in a certificate, which are possible and therefore not refused, but usually errors.

use super::{Certificate, CertifiedPosition};
use crate::attitude::{ANGLE_SYMBOLS, ANGLES};
use crate::text::Printable;
use crate::text::scalar::latin;
use crate::wording::Words;
use crate::wording::number::Number;
use crate::wording::texts::remarks as texts;
use crate::wording::words::symbol;
use jiff::Span;
use jiff::civil::Date;

/// Usual temperatures of a room in which stands are measured and used, °C.
const ROOM_C: std::ops::RangeInclusive<f64> = 0.0..=45.0;

/// Temperature of 0 °C in kelvin.
const ZERO_CELSIUS_K: f64 = 273.15;

/// Ratio to the larger angles of the other positions above which an angle is unusual.
const FAR_OUT: f64 = 20.0;

/// Longest usual validity of a certificate, years.
const MOST_YEARS: i64 = 10;

/// Size below which an angle is never unusual, arcsec.
const SMALL_ARCSEC: f64 = 60.0;

/// Unusual value in a certificate.
#[derive(Debug, PartialEq)]
pub(crate) struct Odd {
    /// Sentence without a full stop, with the keys of the file.
    pub sentence: String,
    /// What pages and other languages say in its place.
    pub words: Words,
}

impl Certificate {
    /// Returns a sentence if letters of the number only look Latin, or `None`; a search for the number would not find it.
    pub(crate) fn odd_number(&self) -> Option<String> {
        let (meant, odd) = latin(&self.number)?;
        let number = Printable(&self.number);
        Some(format!(
            "the number of the certificate, {number}, has the {odd}, which only looks like a Latin letter; if Latin \
                      letters are meant, type {meant} again"
        ))
    }
}

/// Returns what a temperature would be if it is in kelvin; empty if that is not a temperature of a room.
fn in_kelvin(celsius: f64) -> String {
    let from_kelvin = celsius - ZERO_CELSIUS_K;
    let is_room = ROOM_C.contains(&from_kelvin);
    if is_room { format!("; if it is in kelvin, it is {from_kelvin:.2} °C") } else { String::new() }
}

/// Returns the unusual values in a certificate and its positions.
pub(crate) fn of(certificate: &Certificate, positions: &[CertifiedPosition]) -> Vec<Odd> {
    let mut found = temperatures(certificate);
    found.extend(dates(certificate));
    for angle in 0..3 {
        let arcsec = |at: &CertifiedPosition| at.angles_arcsec()[angle];
        let mut sizes: Vec<f64> = positions.iter().map(|at| arcsec(at).abs()).collect();
        sizes.sort_by(f64::total_cmp);
        // Large angles in more than a quarter of the positions may be a property of the stand.
        let Some(usual) = sizes.len().checked_sub(1 + (sizes.len() / 4).max(1)).map(|place| sizes[place]) else {
            continue;
        };
        let odd = |at: &&CertifiedPosition| arcsec(at).abs() > f64::max(SMALL_ARCSEC, FAR_OUT * usual);
        let far = |at: &CertifiedPosition| Odd {
            sentence: format!(
                "{}_arcsec of position {} is {}, more than {FAR_OUT} times the {usual} of the other positions; check the \
                 digits, the unit and the position",
                ANGLES[angle],
                at.index(),
                arcsec(at)
            ),
            words: texts::far_angle(
                symbol(ANGLE_SYMBOLS[angle]),
                at.index(),
                Number::fixed(arcsec(at), 0),
                Number::fixed(usual, 0),
            ),
        };
        found.extend(positions.iter().filter(odd).map(far));
    }
    found
}

fn dates(certificate: &Certificate) -> impl Iterator<Item = Odd> {
    let issued = certificate.issued;
    let years_later = |date: Date, years: i64| date.saturating_add(Span::new().years(years));
    let old = certificate.performed.filter(|performed| issued > years_later(*performed, 1));
    let long = certificate.valid_until.filter(|until| *until > years_later(issued, MOST_YEARS));
    let old = old.map(|performed| Odd {
        sentence: format!("performed is {performed}, more than a year before issued, {issued}; check the years"),
        words: texts::old_measurement(performed, issued),
    });
    let long = long.map(|until| Odd {
        sentence: format!(
            "valid_until is {until}, more than {MOST_YEARS} years after issued, {issued}; check the years"
        ),
        words: texts::long_validity(issued, until),
    });
    old.into_iter().chain(long)
}

fn temperatures(certificate: &Certificate) -> Vec<Odd> {
    let range = certificate.temperature_range_c;
    let measured = certificate.temperature_c.map(|celsius| ("temperature_c", celsius));
    let ends = range.into_iter().flatten().map(|celsius| ("temperature_range_c", celsius));
    let unusual = measured.into_iter().chain(ends).filter(|(_, celsius)| !ROOM_C.contains(celsius));
    let odd = |(key, celsius)| Odd {
        sentence: format!(
            "{key} is {celsius} °C, outside the usual room temperature of {} to {} °C{}",
            ROOM_C.start(),
            ROOM_C.end(),
            in_kelvin(celsius)
        ),
        words: texts::temperature(Number::exact(celsius)),
    };
    let mut found: Vec<Odd> = unusual.map(odd).collect();
    let outside =
        certificate.temperature_c.zip(range).filter(|(celsius, [low, high])| !(low..=high).contains(&celsius));
    found.extend(outside.map(|(celsius, [low, high])| Odd {
        sentence: format!(
            "temperature_c is {celsius} °C, but temperature_range_c is {low} to {high} °C; the deviations were measured \
             outside the certified range"
        ),
        words: texts::outside_range(Number::exact(celsius), Number::exact(low), Number::exact(high)),
    }));
    found
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use crate::stand::Stand;

    const STAND: &str = include_str!("../../passports/SPS-2/0017/stand.yaml");

    fn said_of(from: &str, to: &str) -> Vec<String> {
        assert!(STAND.contains(from));
        let stand = Stand::from_yaml("stand.yaml", STAND.replace(from, to).as_bytes()).unwrap();
        super::of(&stand.certificate, &stand.positions).into_iter().map(|odd| odd.sentence).collect()
    }

    #[test]
    fn a_good_certificate_is_not_odd() {
        assert_eq!(said_of("a", "a"), Vec::<String>::new());
        for stand in
            [include_str!("../../passports/SPS-1/0203/stand.yaml"), include_str!("../../tests/cmd/files/stand.yaml")]
        {
            let stand = Stand::from_yaml("stand.yaml", stand.as_bytes()).unwrap();
            assert_eq!(super::of(&stand.certificate, &stand.positions), []);
        }
    }

    #[test]
    fn years_that_cannot_be_are_said() {
        let old = said_of("performed: \"2026-10-29\"", "performed: \"2006-10-29\"");
        assert!(old[0].contains("performed is 2006-10-29, more than a year before issued"), "{old:?}");
        let long = said_of("valid_until: \"2028-11-01\"", "valid_until: \"2128-11-01\"");
        assert!(long[0].contains("valid_until is 2128-11-01, more than 10 years after issued"), "{long:?}");
    }

    #[test]
    fn temperatures_that_cannot_be_are_said() {
        let kelvin = said_of("temperature_c: 20.0", "temperature_c: 293.15");
        assert!(kelvin[0].contains("293.15") && kelvin[0].contains("if it is in kelvin, it is 20.00 °C"), "{kelvin:?}");
        assert!(kelvin[1].contains("18 to 22 °C"), "{kelvin:?}");
        let warm = said_of("temperature_c: 20.0", "temperature_c: 25.5");
        assert!(warm.len() == 1 && warm[0].contains("25.5") && warm[0].contains("18 to 22 °C"), "{warm:?}");
        let range = said_of("[18.0, 22.0]", "[18.0, 295.0]");
        assert!(range.len() == 1 && range[0].contains("temperature_range_c is 295"), "{range:?}");
    }

    #[test]
    fn an_angle_far_out_is_said_with_its_position() {
        let odd = said_of("alpha_arcsec: -48.9", "alpha_arcsec: 67833.0");
        assert!(odd.len() == 1 && odd[0].contains("alpha_arcsec of position (1, 2) is 67833"), "{odd:?}");
        // Half of the positions, as on a stand whose frame is not perpendicular to its axis.
        let mut stand = Stand::from_yaml("stand.yaml", STAND.as_bytes()).unwrap();
        stand.positions[4..].iter_mut().for_each(|at| at.gamma_arcsec += 5400.0);
        assert_eq!(super::of(&stand.certificate, &stand.positions), []);
    }
}
