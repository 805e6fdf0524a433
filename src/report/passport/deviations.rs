//! The certified deviations, their expanded uncertainty with its parts, and the datum surfaces.

use crate::attitude::ANGLE_SYMBOLS;
use crate::calibration::verdict::COVERAGE_FACTOR;
use crate::passport::Content;
use crate::report::doc::{
    Block, Rows, Words, drawn, field, given, heading, in_unit, joined, listed, range, record, say, symbol, told, wide,
    with,
};
use crate::report::picture::positions as pictures;
use crate::report::picture::strips::Deviations;
use crate::stand::{ActsOn, Certificate, CertifiedPosition, Datum, Excluded, TypeB};
use crate::wording::number::LARGEST_IN_ARCSEC;
use crate::wording::texts::{passport as texts, units};
use crate::wording::{Number, Text};

pub(super) fn section(content: &Content) -> Vec<Block> {
    let Content { certificate, positions, .. } = content;
    let mut doc = vec![heading(texts::DEVIATIONS)];
    doc.extend(certified(certificate, positions));
    doc.extend([heading(texts::COMMON), budget(certificate, positions)]);
    doc.push(figure(content));
    doc.extend([heading(texts::DATUM), datum(content.datum.as_ref())].into_iter().filter(|_| content.datum.is_some()));
    doc
}

/// The certified deviations with U, or with the own parts u if nothing states the others, and what the letters mean.
pub(crate) fn certified(certificate: &Certificate, positions: &[CertifiedPosition]) -> Vec<Block> {
    let (mut doc, note) = match expanded(certificate, positions) {
        Some(combined) => {
            let notes = [texts::DEVIATIONS_NOTE, texts::DEVIATIONS_EXPANDED_NOTE, texts::DEVIATIONS_ROUNDED];
            (table(&combined, "U"), say(notes))
        }
        None => (table(positions, "u"), note(positions, true)),
    };
    doc.push(note);
    doc
}

/// Returns the positions with the combined standard uncertainties in place of their own parts; `None` if no certified
/// deviation has all parts.
fn expanded(certificate: &Certificate, positions: &[CertifiedPosition]) -> Option<Vec<CertifiedPosition>> {
    let combined: Vec<CertifiedPosition> = positions.iter().map(|at| certificate.combined(at)).collect();
    combined.iter().flat_map(CertifiedPosition::u_arcsec).any(|u| u.is_some()).then_some(combined)
}

/// Returns the least and the largest expanded uncertainty of a certified deviation; `None` if a part is not stated.
pub(crate) fn expanded_range(content: &Content) -> Option<Words> {
    let combined = expanded(&content.certificate, &content.positions)?;
    let us = combined.iter().flat_map(CertifiedPosition::u_arcsec).flatten().map(|u| COVERAGE_FACTOR * u);
    Some(range_arcsec(us))
}

/// Returns a value that some quantities share, or their range.
fn range_arcsec(values: impl Iterator<Item = f64>) -> Words {
    joined(range(values, Number::uncertainty).into_iter().map(|u| Words::Quantity(u, units::ARCSEC)), "–")
}

/// The deviations with their bars; the uncertainties of `positions` are those that `letter` names: U, of which they are
/// the half, or the own parts u.
pub(crate) fn table(positions: &[CertifiedPosition], letter: &'static str) -> Vec<Block> {
    let (bars, is_expanded) = (Deviations::of(positions), letter == "U");
    let factor = if is_expanded { COVERAGE_FACTOR } else { 1.0 };
    // One angle with degrees and minutes, and all are marked in their cells.
    let large =
        positions.iter().flat_map(CertifiedPosition::angles_arcsec).any(|angle| angle.abs() > LARGEST_IN_ARCSEC);
    let mut rows = Rows::of(positions, if large { "numbers deviations large" } else { "numbers deviations" })
        .named(symbol("i"), |at| at.i)
        .named(symbol("j"), |at| at.j)
        .column(in_unit(symbol("θ"), units::DEGREES), |at| Number::exact(at.theta_deg))
        .column(in_unit(symbol("φ"), units::DEGREES), |at| Number::exact(at.phi_deg));
    for (axis, name) in ANGLE_SYMBOLS.into_iter().enumerate() {
        let u = |at: &CertifiedPosition| at.u_arcsec()[axis].map(|u| factor * u);
        let angle = |at: &CertifiedPosition| {
            let angle = Number::angle(at.angles_arcsec()[axis], u(at).unwrap_or(0.0));
            if large { Words::Quantity(angle, units::ARCSEC) } else { angle.into() }
        };
        let whiskers = match (bars.largest_u.is_some(), is_expanded) {
            (false, _) => Words::from(""),
            (true, true) => vec!["\u{a0}±\u{a0}".into(), symbol("U")].into(),
            (true, false) => vec!["\u{a0}±\u{a0}2".into(), symbol("u")].into(),
        };
        let u_heading = vec![symbol(letter), "(".into(), symbol(name), ")".into()].into();
        rows = rows
            .column(if large { symbol(name) } else { in_unit(symbol(name), units::ARCSEC) }, angle)
            .column(in_unit(u_heading, units::ARCSEC), |at| u(at).map(Number::uncertainty))
            .strips(
                in_unit(vec![symbol(name), whiskers].into(), bars.unit()),
                |at| bars.bar((at.angles_arcsec()[axis], at.u_arcsec()[axis])),
                bars.axis(),
            );
    }
    let rows = rows
        .column(symbol("ν"), |at| at.degrees_of_freedom.map(Number::exact))
        .only_if(positions.iter().any(|at| at.degrees_of_freedom.is_some()))
        .grouped_by(|at| at.i);
    let caption = texts::DEVIATIONS_CAPTION;
    vec![rows.captioned(caption, caption), Block::Key(bars.key(is_expanded))]
}

/// What the deviations and the own parts of their uncertainties are, and, if they are `rounded` from signed numbers, how.
pub(crate) fn note(positions: &[CertifiedPosition], rounded: bool) -> Block {
    let is_stated = positions.iter().flat_map(CertifiedPosition::u_arcsec).any(|u| u.is_some());
    let of_u = is_stated.then_some(texts::DEVIATIONS_U_NOTE);
    say([texts::DEVIATIONS_NOTE]
        .into_iter()
        .chain(of_u)
        .chain((is_stated && rounded).then_some(texts::DEVIATIONS_ROUNDED)))
}

/// The parts of the uncertainty of the certified values, and how they combine; then the contributions of type B.
pub(crate) fn budget(certificate: &Certificate, positions: &[CertifiedPosition]) -> Block {
    let of_axis = |at: &[CertifiedPosition], axis: usize, factor: f64| {
        let us: Vec<f64> = at.iter().filter_map(|at| Some(factor * at.u_arcsec()[axis]?)).collect();
        (!us.is_empty()).then(|| range_arcsec(us.into_iter()))
    };
    let of_axes = |at: &[CertifiedPosition], factor: f64| {
        let each: Option<Vec<Words>> = (0..3).map(|axis| of_axis(at, axis, factor)).collect();
        each.map(listed)
    };
    let combined = expanded(certificate, positions);
    let all = [
        field(texts::EXPANDED, combined.as_deref().and_then(|combined| of_axes(combined, COVERAGE_FACTOR))),
        field(texts::OWN_PART, of_axes(positions, 1.0)),
    ];
    record(all.into_iter().chain(common_fields(certificate)))
}

/// The repeatability, the common parts, and the contributions of type B.
fn common_fields(certificate: &Certificate) -> Vec<Option<(Text, Words, bool)>> {
    let arcsec = |u| Words::Quantity(Number::uncertainty(u), units::ARCSEC);
    let freedom = certificate.repeatability_degrees_of_freedom;
    let mut all = vec![
        field(texts::COMMON_PLATFORM, certificate.common_platform_arcsec.map(arcsec)),
        field(texts::COMMON_BASE, certificate.common_base_arcsec.map(arcsec)),
        field(
            texts::REPEATABILITY,
            certificate.repeatability_arcsec.map(|u| with(arcsec(u), "ν", freedom.map(Number::exact))),
        ),
    ];
    all.extend(certificate.type_b.iter().flatten().map(type_b));
    all.push(wide(
        texts::EVIDENCE,
        certificate.evidence.as_ref().map(|evidence| {
            let mut all =
                vec![evidence.runs.into(), ", SHA-256 ".into(), Words::Code(evidence.readings_sha256.clone())];
            all.extend(evidence.excluded.iter().flatten().flat_map(|excluded| ["; ".into(), exclusion(excluded)]));
            Words::All(all)
        }),
    ));
    all
}

/// An excluded reading or run, with the reason.
fn exclusion(excluded: &Excluded) -> Words {
    let run = &excluded.run;
    let what = match excluded.index() {
        Some(index) => texts::excluded_reading(index, run),
        None => texts::excluded_run(run),
    };
    vec![what, ": ".into(), given(&excluded.why)].into()
}

/// A contribution that repeated measurements cannot show (type B).
fn type_b(line: &TypeB) -> Option<(Text, Words, bool)> {
    let u = Words::Quantity(Number::exact(line.u_arcsec), units::ARCSEC);
    let u = with(u, "ν", line.degrees_of_freedom.map(Number::exact));
    field(texts::type_b!(ActsOn, line.acts_on), Some(vec![u, ": ".into(), given(&line.source)]))
}

/// The stand in its positions.
fn figure(content: &Content) -> Block {
    let (positions, azimuth_deg) = (content.positions.clone(), content.site.frame_axis_azimuth_deg());
    Block::Drawn(drawn(move |languages| {
        let caption = told(texts::figure_positions(Number::exact(pictures::exaggeration(&positions))));
        languages.figure("positions", &pictures::positions(languages, &positions, azimuth_deg), &caption)
    }))
}

pub(crate) fn datum(datum: Option<&Datum>) -> Block {
    let surface = |of: fn(&Datum) -> &Option<String>| datum.and_then(|datum| of(datum).as_ref()).map(given);
    record([
        field(texts::DATUM_LEVEL, surface(|datum| &datum.level)),
        field(texts::DATUM_AZIMUTH, surface(|datum| &datum.azimuth)),
        field(texts::DATUM_SEAT, surface(|datum| &datum.gyro_seat)),
    ])
}
