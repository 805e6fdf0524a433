//! Characteristics: the certified deviations with their uncertainties, the datum surfaces, the site.

use super::PassportPage;
use crate::attitude::ANGLE_SYMBOLS;
use crate::report::page::language::{Language, Languages, Text, values};
use crate::report::page::number::{LARGEST_IN_ARCSEC, LATITUDES, LONGITUDES, Number, column};
use crate::report::page::parts::{
    Column, Table, coordinate, fields, figure, figure_with, given, heading, in_hemisphere, not_stated, quantity,
    starts, stated, symbol, symbol_and_unit, wide_stated,
};
use crate::report::page::spacing::BLANK;
use crate::report::page::symbols::italic;
use crate::report::page::texts::{passport as texts, units};
use crate::report::picture::deviations::Bars;
use crate::report::picture::{place as map, positions as picture};
use crate::site::{Earth, Site};
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Datum, Excluded, TypeB};
use crate::units::{ARCSECONDS_PER_DEGREE, sin_cos_of_degrees};
use maud::{Markup, html};

/// Length of a degree on the ground, in metres, for the number of printed digits.
const METRES_PER_DEGREE: f64 = 111e3;

pub(super) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let content = &page.content;
    let stand = picture::positions(languages, &content.positions, content.site.frame_axis_azimuth_deg());
    let factor = Number::exact(picture::exaggeration(&content.positions));
    html! {
        (heading(languages, texts::DEVIATIONS))
        (positions(&content.positions, languages))
        (deviations_note(&content.positions, true, languages))
        (figure_with(languages, "positions", &stand, |language| texts::FIGURE_POSITIONS.filled(language, values! { factor })))
        (heading(languages, texts::COMMON))
        (common(&content.certificate, languages))
        (heading(languages, texts::DATUM))
        (datum(content.datum.as_ref(), languages))
        div.titled { (heading(languages, texts::SITE)) (place(&content.site, languages)) }
        (heading(languages, texts::EARTH))
        // Without a mark the map would show the radius alone.
        @if content.earth.azimuth_deg.is_some() {
            div.with-figure {
                (the_earth(&content.site, &content.earth, languages))
                (figure(languages, "radius", &map::place(languages, content), texts::FIGURE_RADIUS))
            }
        } @else {
            (the_earth(&content.site, &content.earth, languages))
        }
    }
}

/// Writes the deviations with their bars.
pub(crate) fn positions(positions: &[CertifiedPosition], languages: &Languages) -> Markup {
    let bars = Bars::of(positions);
    let with = |symbol: Markup, unit| symbol_and_unit(languages, &symbol, unit);
    let numbers = |heading: Markup, number: &dyn Fn(&CertifiedPosition) -> Option<Number>| {
        Column::new(heading, column(languages, positions.iter().map(number)))
    };
    let mut columns = vec![
        numbers(with(symbol("θ", ""), units::DEGREES), &|at| Some(Number::exact(at.theta_deg))),
        numbers(with(symbol("φ", ""), units::DEGREES), &|at| Some(Number::exact(at.phi_deg))),
    ];
    // One angle with degrees and minutes, and all are marked in their cells.
    let large =
        positions.iter().flat_map(CertifiedPosition::angles_arcsec).any(|angle| angle.abs() > LARGEST_IN_ARCSEC);
    for (axis, name) in ANGLE_SYMBOLS.into_iter().enumerate() {
        let of = |at: &CertifiedPosition| (at.angles_arcsec()[axis], at.u_arcsec()[axis]);
        let heading = if large { symbol(name, "") } else { with(symbol(name, ""), units::ARCSEC) };
        let mut angles = numbers(heading, &|at| Some(Number::angle(of(at).0, of(at).1.unwrap_or(0.0))));
        if large {
            angles.cells.iter_mut().for_each(|angle| *angle = html! { (angle) span { "″" } });
        }
        let u_heading = with(html! { i { "u" } "(" i { (name) } ")" }, units::ARCSEC);
        let us = numbers(u_heading, &|at| of(at).1.map(Number::uncertainty));
        let cells = positions.iter().map(|at| bars.bar(of(at))).collect();
        columns.extend([
            angles,
            us,
            Column { heading: bars.heading(languages, name), cells, foot: bars.axis(languages) },
        ]);
    }
    columns.push(numbers(symbol("ν", ""), &|at| at.degrees_of_freedom.map(Number::exact)));
    let names = positions.iter().map(|at| vec![html! { (at.i) }, html! { (at.j) }]).collect();
    let table = Table {
        starts: starts(positions.iter().map(|at| at.i)),
        class: if large { "numbers deviations large" } else { "numbers deviations" },
        ..Table::of(vec![symbol("i", ""), symbol("j", "")], names, &columns)
    };
    html! { (table.captioned(languages, texts::DEVIATIONS_CAPTION)) (bars.key(languages)) }
}

/// Writes what the deviations and their uncertainties are, and, if they are `rounded` from signed numbers, how.
pub(crate) fn deviations_note(positions: &[CertifiedPosition], rounded: bool, languages: &Languages) -> Markup {
    let is_stated = positions.iter().flat_map(CertifiedPosition::u_arcsec).any(|u| u.is_some());
    languages.paragraph_with(|language| {
        html! {
            (italic(&texts::DEVIATIONS_NOTE.words(language)))
            @if is_stated { " " (italic(&texts::DEVIATIONS_U_NOTE.words(language))) }
            @if is_stated && rounded { " " (texts::DEVIATIONS_ROUNDED.words(language)) }
        }
    })
}

/// Writes an excluded reading or run, with the reason.
fn exclusion(excluded: &Excluded, languages: &Languages) -> Markup {
    let run = &excluded.run;
    let words = |language: Language| match excluded.index() {
        Some(index) => texts::EXCLUDED_READING.filled(language, values! { index, run }),
        None => texts::EXCLUDED_RUN.filled(language, values! { run }),
    };
    html! { (languages.inline_with(words)) ": " (given(&excluded.why)) }
}

pub(crate) fn common(certificate: &Certificate, languages: &Languages) -> Markup {
    let arcsec = |u| quantity(languages, &Number::uncertainty(u), units::ARCSEC);
    let freedom = certificate.repeatability_degrees_of_freedom;
    let type_b = certificate.type_b.iter().flatten().map(|line| type_b(line, languages));
    let evidence = certificate.evidence.as_ref().map(|evidence| {
        let excluded = evidence.excluded.iter().flatten().map(|excluded| exclusion(excluded, languages));
        let value = html! {
            (evidence.runs) ", SHA-256 " code { (evidence.readings_sha256) }
            @for excluded in excluded { br; (excluded) }
        };
        wide_stated(languages, texts::EVIDENCE, Some(value))
    });
    let common = [
        stated(languages, texts::REPEATABILITY, certificate.repeatability_arcsec.map(arcsec)),
        stated(languages, texts::REPEATABILITY_DOF, freedom.map(|number| Number::exact(number).markup(languages))),
        stated(languages, texts::COMMON_PLATFORM, certificate.common_platform_arcsec.map(arcsec)),
        stated(languages, texts::COMMON_BASE, certificate.common_base_arcsec.map(arcsec)),
    ];
    fields(common.into_iter().chain(type_b).chain(evidence))
}

/// Writes an uncertainty contribution that repeated measurements cannot show (type B).
fn type_b(line: &TypeB, languages: &Languages) -> Markup {
    let part = match line.acts_on {
        ActsOn::Position => texts::TYPE_B_POSITION,
        ActsOn::Platform => texts::TYPE_B_PLATFORM,
        ActsOn::Base => texts::TYPE_B_BASE,
    };
    let freedom = line.degrees_of_freedom.map(|number| Number::exact(number).markup(languages));
    let value = html! {
        (quantity(languages, &Number::exact(line.u_arcsec), units::ARCSEC))
        @if let Some(freedom) = freedom { ", " (symbol("ν", "")) " " (freedom) }
        ": " (given(&line.source))
    };
    stated(languages, part, Some(value))
}

pub(crate) fn datum(datum: Option<&Datum>, languages: &Languages) -> Markup {
    let surface = |name: Option<&String>| name.map(|name| given(name));
    fields([
        stated(languages, texts::DATUM_LEVEL, surface(datum.and_then(|datum| datum.level.as_ref()))),
        stated(languages, texts::DATUM_AZIMUTH, surface(datum.and_then(|datum| datum.azimuth.as_ref()))),
        stated(languages, texts::DATUM_SEAT, surface(datum.and_then(|datum| datum.gyro_seat.as_ref()))),
    ])
}

fn place(site: &Site, languages: &Languages) -> Markup {
    let arcsec = |value: f64| quantity(languages, &Number::exact(value), units::ARCSEC);
    let u = |u: f64| quantity(languages, &Number::exact(u), units::ARCSEC);
    let base = site.uncertainty.as_ref();
    let latitude_u = base.and_then(|base| base.latitude_arcsec);
    let measured_gravity = site.gravity_m_per_s2.map(|value| gravity(value, site.gravity_u_m_per_s2, languages));
    let measured = |value: f64, u: f64| quantity(languages, &Number::measured(value, u), units::ARCSEC);
    let deflection = site.deflection_arcsec.as_ref().map(|deflection| match deflection.u {
        Some(known) => html! {
            (symbol("ξ", "")) " " (measured(deflection.xi, known)) ", " (symbol("η", "")) " "
            (measured(deflection.eta, known)) ", " (symbol("u", "")) (BLANK) (u(known))
        },
        None => html! {
            (symbol("ξ", "")) " " (arcsec(deflection.xi)) ", " (symbol("η", "")) " " (arcsec(deflection.eta))
        },
    });
    let frame_axis = site.frame_axis_azimuth_deg.map(|azimuth_deg| {
        stated(languages, texts::FRAME_AXIS, Some(quantity(languages, &Number::exact(azimuth_deg), units::DEGREES)))
    });
    let latitude = |degrees| coordinate(languages, degrees, LATITUDES);
    // A site states one of the two latitudes, never both.
    let latitude = match site.astronomic_latitude_deg {
        Some(astronomic) => stated(languages, texts::ASTRONOMIC_LATITUDE, Some(latitude(astronomic))),
        None => stated(languages, texts::LATITUDE, site.latitude_deg.map(latitude)),
    };
    html! {
        (fields([
            wide_stated(languages, texts::NAME, site.name.as_deref().map(given)),
            stated(languages, texts::SITE_ID, Some(given(site.id.as_str()))),
            latitude,
            stated(languages, texts::LONGITUDE, site.longitude_deg.map(|degrees| coordinate(languages, degrees, LONGITUDES))),
            stated(languages, texts::HEIGHT,
                site.height_m.map(|height| quantity(languages, &Number::exact(height), units::METRES))),
            stated(languages, texts::DEFLECTION, deflection),
            stated(languages, texts::GRAVITY_MEASURED, measured_gravity),
            frame_axis.unwrap_or_default(),
            stated(languages, texts::LATITUDE_U, latitude_u.map(u)),
            stated(languages, texts::AZIMUTH_U, base.and_then(|base| base.azimuth_arcsec).map(u)),
            stated(languages, texts::LEVEL_U, base.and_then(|base| base.level_arcsec).map(u)),
            wide_stated(languages, texts::SOURCE, site.source.as_deref().map(given)),
        ]))
        (mark(site, languages))
    }
}

/// Returns an angle in degrees to the digits of its uncertainty, or to a tenth of a metre on the ground.
fn angle(degrees: f64, u_arcsec: f64) -> Number {
    match u_arcsec {
        u if u > 0.0 => Number::measured(degrees, u / ARCSECONDS_PER_DEGREE),
        _ => Number::at_most(degrees, 6),
    }
}

/// Writes g, with its uncertainty if that is known.
pub(crate) fn gravity(value: f64, u: Option<f64>, languages: &Languages) -> Markup {
    match u {
        Some(u) => with_u(value, u, units::M_PER_S2, languages),
        None => quantity(languages, &Number::exact(value), units::M_PER_S2),
    }
}

/// Writes a value and its standard uncertainty.
fn with_u(value: f64, u: f64, unit: Text, languages: &Languages) -> Markup {
    html! { (quantity(languages, &Number::measured(value, u), unit)) (its_u(languages, Some((u, unit)))) }
}

/// Writes the standard uncertainty of what stands before it.
fn its_u(languages: &Languages, u: Option<(f64, Text)>) -> Markup {
    let u = match u {
        Some((u, unit)) => html! { "=" (BLANK) (quantity(languages, &Number::uncertainty(u), unit)) },
        None => not_stated(languages),
    };
    html! { ", " span.quantity { (symbol("u", "")) (BLANK) (u) } }
}

fn mark(site: &Site, languages: &Languages) -> Markup {
    let Some(mark) = &site.azimuth_mark else { return html! {} };
    // To the digits of their uncertainty on the ground.
    let u_deg = mark.position_u_m.unwrap_or(0.0) / METRES_PER_DEGREE;
    let pair = |latitude: f64, longitude: f64| {
        let cosine = sin_cos_of_degrees(latitude).1;
        let [latitude, longitude] =
            [Number::measured(latitude, u_deg), Number::measured(longitude, u_deg / cosine.max(f64::MIN_POSITIVE))];
        html! { (in_hemisphere(languages, latitude, LATITUDES)) ", " (in_hemisphere(languages, longitude, LONGITUDES)) }
    };
    let metres = |u: f64| quantity(languages, &Number::exact(u), units::METRES);
    fields([
        stated(languages, texts::MARK, mark.name.as_deref().map(given)),
        stated(languages, texts::MARK_POSITION, Some(pair(mark.latitude_deg, mark.longitude_deg))),
        stated(languages, texts::PILLAR_POSITION, Some(pair(mark.pillar_latitude_deg, mark.pillar_longitude_deg))),
        stated(languages, texts::POSITION_U, mark.position_u_m.map(metres)),
    ])
}

fn the_earth(site: &Site, earth: &Earth, languages: &Languages) -> Markup {
    let rate = |value: f64, u: f64| match u > 0.0 {
        true => with_u(value, u, units::DEG_PER_H, languages),
        // To the place that a usual latitude determines.
        false => html! { (quantity(languages, &Number::fixed(value, 5), units::DEG_PER_H)) (its_u(languages, None)) },
    };
    let u = site.gravity_u_m_per_s2();
    let radius = quantity(languages, &Number::fixed(earth.valid_radius_m, 0), units::METRES);
    let within = quantity(languages, &Number::exact(earth.valid_within_deg_per_h), units::DEG_PER_H);
    let in_arcsec = |u: Option<f64>| its_u(languages, u.map(|u| (u, units::ARCSEC)));
    let azimuth = earth.azimuth_deg.map(|azimuth| {
        let u = earth.azimuth_u_arcsec;
        html! { (quantity(languages, &angle(azimuth, u.unwrap_or(0.0)), units::DEGREES)) (in_arcsec(u)) }
    });
    let latitude_u = site.astronomic_latitude_u_arcsec();
    let latitude = html! {
        (in_hemisphere(languages, angle(earth.latitude_deg, latitude_u), LATITUDES))
        (in_arcsec(Some(latitude_u).filter(|u| *u > 0.0)))
    };
    let [horizontal_u, vertical_u] = earth.rate_u_deg_per_h(site);
    fields([
        stated(
            languages,
            texts::EARTH_RATE,
            Some(quantity(languages, &Number::fixed(earth.rate_deg_per_h, 9), units::DEG_PER_H)),
        ),
        stated(languages, texts::EARTH_LATITUDE, Some(latitude)),
        stated(languages, texts::HORIZONTAL, Some(rate(earth.horizontal_deg_per_h, horizontal_u))),
        stated(languages, texts::VERTICAL, Some(rate(earth.vertical_deg_per_h, vertical_u))),
        stated(languages, texts::GRAVITY, Some(gravity(earth.gravity_m_per_s2, u, languages))),
        stated(languages, texts::RADIUS, Some(radius)),
        stated(languages, texts::RADIUS_WITHIN, Some(within)),
        stated(languages, texts::AZIMUTH, azimuth),
    ])
}
