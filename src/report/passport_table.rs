//! Passport in a terminal: aligned tables, units in the headings.

use crate::calibration::Parameter;
use crate::passport::annotations::absent;
use crate::passport::{Content, Rows, Verification};
use crate::report::page::Language;
use crate::report::page::passport::accuracy;
use crate::report::page::passport::numbers::numbers_of;
use crate::report::{columns, deviations, style, verdict};
use crate::stand::{Evidence, TypeB};
use crate::units::{ARCSECONDS_PER_DEGREE, printed};
use std::fmt::{Display, Write};

/// Width of the names on the left, in characters.
const NAME_COLUMNS: usize = 26;

/// Returns the whole passport as tables, after the answer of `verification`; `None` if it was not verified.
pub(crate) fn text(content: &Content, verification: Option<&Verification>) -> String {
    let mut out = String::new();
    let header = &content.passport;
    let answer = match verification {
        Some(verification) => verdict::answer(verification.valid(), verification.checks()),
        None => style::marked(None, &style::bad("NOT VERIFIED")),
    };
    let _ = writeln!(out, "{answer}  {}", style::heading(&header.id));
    if let Some(verification) = verification {
        let _ = writeln!(out, "  {}", verdict::counts_with_names(verification.checks()));
    }
    line(&mut out, "issued", format!("{} by {}", header.issued_at, header.issuer));
    option(&mut out, "program", header.issued_with.as_ref());
    option(&mut out, "valid until (inclusive)", header.valid_until.as_ref());
    if let Some(old) = &header.reissued_from {
        line(&mut out, "re-issued from", format!("{}, SHA-256 {}", old.id, old.sha256));
        line(&mut out, "reason", &old.reason);
        line(&mut out, "changes", &old.changed);
        line(&mut out, "supersedes", if header.supersedes == Some(true) { "yes" } else { "no" });
    }
    stand(&mut out, content);
    positions(&mut out, content);
    site(&mut out, content);
    missing(&mut out, content);
    matrices(&mut out, content);
    vectors(&mut out, content);
    self_check(&mut out, content);
    expected(&mut out, content);
    out
}

fn heading(out: &mut String, words: &str) {
    let _ = writeln!(out, "\n{}", style::heading(words));
}

/// Appends a name and its value. Further lines of a long value align with its beginning.
fn line(out: &mut String, name: &str, value: impl Display) {
    columns::named(out, name, NAME_COLUMNS, &value.to_string());
}

fn option(out: &mut String, name: &str, value: Option<impl Display>) {
    if let Some(value) = value {
        line(out, name, value);
    }
}

fn stand(out: &mut String, content: &Content) {
    let (stand, certificate) = (&content.stand, &content.certificate);
    heading(out, "Stand");
    option(out, "manufacturer", stand.manufacturer.as_ref());
    line(out, "model, serial", format!("{} {}", stand.model, stand.serial));
    option(out, "configuration", stand.configuration.as_ref());
    option(out, "name", stand.name.as_ref());
    option(out, "customer", stand.customer.as_ref());
    heading(out, "Certificate (standard uncertainties, k = 1)");
    line(out, "number", format!("{}, issued {}", certificate.number, certificate.issued));
    line(out, "laboratory", &certificate.laboratory);
    option(out, "address", certificate.address.as_ref());
    option(out, "authorised by", certificate.authorized_by.as_ref());
    option(out, "accreditation", certificate.accreditation.as_ref());
    option(out, "received", certificate.received.as_ref());
    option(out, "performed", certificate.performed.as_ref());
    option(out, "valid until (inclusive)", certificate.valid_until.as_ref());
    option(out, "basis of validity", certificate.valid_until_basis.as_ref());
    option(out, "method", certificate.method.as_ref());
    option(out, "traceability", certificate.traceability.as_ref());
    option(out, "temperature, °C", certificate.temperature_c);
    option(out, "temperature range, °C", certificate.temperature_range_c.map(|[low, high]| format!("{low} to {high}")));
    let of_repeatability = with_freedom(certificate.repeatability_degrees_of_freedom);
    option(
        out,
        "repeatability, ″",
        certificate.repeatability_arcsec.map(|u| format!("{}{of_repeatability}", columns::two_digits(u))),
    );
    option(out, "common part, platform, ″", certificate.common_platform_arcsec.map(columns::two_digits));
    option(out, "common part, base, ″", certificate.common_base_arcsec.map(columns::two_digits));
    for TypeB { source, acts_on, u_arcsec, degrees_of_freedom } in certificate.type_b.iter().flatten() {
        let known = with_freedom(*degrees_of_freedom);
        line(out, &format!("type B, {}, ″", acts_on.word()), format!("{u_arcsec}{known}: {source}"));
    }
    if let Some(Evidence { readings_sha256, runs, excluded }) = &certificate.evidence {
        line(out, "readings", format!("{runs} runs, SHA-256 {readings_sha256}"));
        for excluded in excluded.iter().flatten() {
            line(out, "excluded", format!("{}: {}", excluded.describe(), excluded.why));
        }
    }
    if let Some(datum) = &content.datum {
        heading(out, "Datum");
        option(out, "level", datum.level.as_ref());
        option(out, "azimuth", datum.azimuth.as_ref());
        option(out, "gyro seat", datum.gyro_seat.as_ref());
    }
}

fn positions(out: &mut String, content: &Content) {
    heading(out, "Positions: nominal angles, deviations and their standard uncertainties");
    let (headings, deviations) = deviations::columns(&content.positions);
    let mut names = vec!["i", "j", "θ, °", "φ, °"];
    names.extend(headings);
    let with_freedom = content.positions.iter().any(|at| at.degrees_of_freedom.is_some());
    if with_freedom {
        names.push("deg. of freedom");
    }
    let rows = content.positions.iter().zip(deviations).map(|(at, deviations)| {
        let mut row = vec![at.i.to_string(), at.j.to_string(), at.theta_deg.to_string(), at.phi_deg.to_string()];
        row.extend(deviations);
        if with_freedom {
            row.push(at.degrees_of_freedom.map_or_else(|| "-".to_owned(), columns::degrees_of_freedom));
        }
        row
    });
    columns::table(out, &names, rows);
    out.push('\n');
    deviations::picture(out, &content.positions);
}

/// Returns degrees of freedom to print after an uncertainty, or nothing if they are `None`.
fn with_freedom(degrees_of_freedom: Option<f64>) -> String {
    degrees_of_freedom.map_or_else(String::new, |known| format!(" ({})", columns::freedom(known)))
}

/// Returns a standard uncertainty to print after its value, or nothing if it is `None`.
fn with_u(u: Option<f64>) -> String {
    u.map_or_else(String::new, |u| format!(", u = {u}"))
}

/// Returns a value to the digits of its standard uncertainty, and the uncertainty; all digits if it is `None`.
fn measured(value: f64, u: Option<f64>) -> String {
    let Some(u) = u else { return value.to_string() };
    let digits = columns::decimals(u);
    format!("{value:.digits$}, u = {u:.digits$}")
}

/// Returns an angle in degrees to the digits of its standard uncertainty, and the uncertainty; all digits if it is `None`.
fn angle(degrees: f64, u_arcsec: Option<f64>) -> String {
    let Some(u) = u_arcsec else { return degrees.to_string() };
    format!("{degrees:.*}, u = {}″", columns::decimals(u / ARCSECONDS_PER_DEGREE), columns::two_digits(u))
}

fn site(out: &mut String, content: &Content) {
    let (site, earth) = (&content.site, &content.earth);
    heading(out, "Site");
    line(out, "id", &site.id);
    option(out, "name", site.name.as_ref());
    option(out, "latitude, °", site.latitude_deg);
    option(out, "astronomic lat., °", site.astronomic_latitude_deg);
    option(out, "longitude, °", site.longitude_deg);
    option(out, "height, m", site.height_m);
    if let Some(deflection) = &site.deflection_arcsec {
        let (xi, eta) = (deflection.xi, deflection.eta);
        line(out, "deflection, ″", format!("ξ {xi}, η {eta}{}", with_u(deflection.u)));
    }
    let gravity = site.gravity_m_per_s2.map(|gravity| format!("{gravity}{}", with_u(site.gravity_u_m_per_s2)));
    option(out, "measured gravity, m/s²", gravity);
    if let Some(mark) = &site.azimuth_mark {
        let name = mark.name.as_deref().unwrap_or("no name");
        line(out, "azimuth mark", format!("{name}: {}, {}", mark.latitude_deg, mark.longitude_deg));
        let pillar = format!("{}, {}", mark.pillar_latitude_deg, mark.pillar_longitude_deg);
        line(out, "pillar", pillar);
        option(out, "u of both, m", mark.position_u_m);
    }
    option(out, "frame axis azimuth, °", site.frame_axis_azimuth_deg);
    if let Some(base) = &site.uncertainty {
        option(out, "u of latitude, ″", base.latitude_arcsec);
        option(out, "u of base azimuth, ″", base.azimuth_arcsec);
        option(out, "u of base level, ″", base.level_arcsec);
    }
    option(out, "source", site.source.as_ref());
    heading(out, "Earth at the site");
    line(out, "Earth rate, °/h", format!("{:.9}", earth.rate_deg_per_h));
    let latitude_u = site.astronomic_latitude_u_arcsec();
    line(out, "astronomic latitude, °", angle(earth.latitude_deg, Some(latitude_u).filter(|u| *u > 0.0)));
    let rates = [("horizontal", earth.horizontal_deg_per_h), ("vertical", earth.vertical_deg_per_h)];
    for ((name, rate), u) in rates.into_iter().zip(earth.rate_u_deg_per_h(site)) {
        line(out, &format!("{name} component, °/h"), measured(rate, Some(u).filter(|u| *u > 0.0)));
    }
    line(out, "gravity, m/s²", measured(earth.gravity_m_per_s2, site.gravity_u_m_per_s2()));
    let radius = format!("{:.0} (Earth rate within {} °/h)", earth.valid_radius_m, earth.valid_within_deg_per_h);
    line(out, "validity radius, m", radius);
    option(out, "azimuth of mark, °", earth.azimuth_deg.map(|azimuth| angle(azimuth, earth.azimuth_u_arcsec)));
}

fn missing(out: &mut String, content: &Content) {
    let absent = absent(content);
    if !absent.is_empty() {
        heading(out, "Missing information");
    }
    for absence in absent {
        columns::paragraph(out, "  ", &accuracy::plain(absence, Language::English));
    }
}

fn matrices(out: &mut String, content: &Content) {
    let Some(m) = &content.matrices else {
        heading(out, "Matrices: none, because some of the eight positions are not certified");
        return;
    };
    heading(out, "Matrices at the site, by rows; eq. (9) to (15)");
    let row = |name: &str, unit: &str, [[a, b], [c, d]]: &Rows| {
        let mut row = vec![name.to_owned(), unit.to_owned()];
        row.extend([a, b, c, d].map(|value| columns::fixed(*value, 9)));
        row
    };
    let rows = [
        row("Δ", "1", &m.delta),
        row("B", "°/h", &m.b_deg_per_h),
        row("C", "°/(h·g)", &m.c_deg_per_h_per_g),
        row("n_1", "g", &m.n1),
        row("n_2", "g", &m.n2),
        row("n_2⁻¹", "1/g", &m.n2_inverse),
        row("ω_31", "°/h", &m.omega1_deg_per_h),
        row("ω_32", "°/h", &m.omega2_deg_per_h),
    ];
    columns::table(out, &["", "unit", "11", "12", "21", "22"], rows);
}

fn vectors(out: &mut String, content: &Content) {
    heading(out, "Specific force in g and Earth rate in °/h along the case axes, eq. (5)");
    let rows = content.vectors.iter().map(|at| {
        let [nx, ny] = at.specific_force_g;
        let [wx, wy] = at.omega_deg_per_h;
        let mut row = vec![at.i.to_string(), at.j.to_string()];
        row.extend([nx, ny, at.specific_force_z_g, wx, wy].map(|value| columns::fixed(value, 9)));
        row
    });
    columns::table(out, &["i", "j", "n_x", "n_y", "n_z", "ω_3x", "ω_3y"], rows);
}

fn expected(out: &mut String, content: &Content) {
    let Some(accuracy) = &content.accuracy else { return };
    let (gyro, laboratory) = (&accuracy.gyro, &accuracy.laboratory);
    heading(
        out,
        "Expected calibration uncertainty: standard uncertainties (k = 1) of one calibration by least \
         squares",
    );
    line(out, "gyro type", &gyro.r#type);
    option(out, "laboratory", laboratory.name.as_ref());
    let meter = &laboratory.meter;
    let noise = meter.noise_ma.map_or_else(String::new, |noise| format!(", {noise} mA noise"));
    let words = format!(
        "{} % of reading, {} % gain, {} mA offset, {} mA floor{noise}",
        meter.reading_percent, meter.gain_percent, meter.offset_ma, meter.floor_ma
    );
    line(out, "meter", words);
    let seat = laboratory.seating_arcsec.as_ref();
    option(out, "gyro seat, ″", seat.map(|seat| format!("{}, {}, {}", seat.about_x, seat.about_y, seat.about_z)));
    let u = &accuracy.standard_uncertainty;
    let (us, nominal) = (u.to_model().to_vector(), gyro.nominal.to_model().to_vector());
    let rows = Parameter::AS_IN_THE_PAPER.map(|parameter| {
        let (u, unit, limit) = (us[parameter.place()], printed(parameter.unit()), gyro.tolerance.of(parameter));
        let percent = 100.0 * u / nominal[parameter.place()].abs();
        let in_percent = parameter.is_scale_factor() && percent.is_finite();
        let percent = if in_percent { columns::two_digits(percent) } else { String::new() };
        let limit = format!("{limit} {}", if gyro.tolerance.is_in_percent(parameter) { "%" } else { &unit });
        let u = format!("{u:.*}", columns::decimals(u));
        vec![parameter.symbol().to_owned(), unit, u, percent, limit]
    });
    columns::table(out, &["", "unit", "u", "u, %", "tolerance"], rows);
    let (gravity, type_gravity) = (content.earth.gravity_m_per_s2, gyro.gravity());
    let Some(u_gravity) = content.site.gravity_u_m_per_s2().filter(|_| gravity != type_gravity) else { return };
    let [of_g, of_k] = [Parameter::OmegaG, Parameter::OmegaK]
        .map(|parameter| columns::two_digits(nominal[parameter.place()].abs() * u_gravity / gravity));
    let words = format!(
        "ω_g and ω_k refer to local g. A comparison with their tolerances, at the g of the type, adds its uncertainty: \
         u = {of_g} °/(h·g) for ω_g, {of_k} °/(h·g) for ω_k."
    );
    columns::paragraph(out, "  ", &words);
}

fn self_check(out: &mut String, content: &Content) {
    let Some(check) = &content.self_check else { return };
    heading(out, "Self-check: currents, mA (the file has all digits)");
    let rows = check
        .currents
        .iter()
        .map(|at| vec![at.i.to_string(), at.j.to_string(), format!("{:.9}", at.jx_ma), format!("{:.9}", at.jy_ma)]);
    columns::table(out, &["i", "j", "J_x", "J_y"], rows);
    heading(out, "Self-check: parameters that software should find from them, to 10⁻⁹ of each value");
    let values = numbers_of(&check.parameters());
    let rows = Parameter::AS_IN_THE_PAPER
        .into_iter()
        .zip(values)
        .map(|(parameter, value)| vec![parameter.symbol().to_owned(), printed(parameter.unit()), value.to_string()]);
    columns::table(out, &["", "unit", "value"], rows);
}
