//! Evidence for a certificate: readings in doubt and excluded ones, components of the uncertainty, tests.

use crate::certification::Certification;
use crate::certification::components::Common;
use crate::certification::found::Found;
use crate::certification::kind::{AXES, Kind};
use crate::report::doc::{
    Block, On, Rows, Words, either, field, fields, heading, in_unit, listed, marked, probability, say, symbol,
};
use crate::stand::{Certificate, Excluded};
use crate::wording::texts::{certification as texts, checks, compass, passport, units};
use crate::wording::{Number, Outcome, Text};

/// Degrees of freedom at which a standard deviation has a relative standard uncertainty of 35 %: 1/√(2ν), JCGM 100, E.4.3.
pub(crate) const FEW_DEGREES: f64 = 4.0;

/// Which readings in the means the tests name.
pub(crate) fn outliers(found: &Certification) -> Block {
    let is_reading = |at: &&Found| matches!(at.kind, Kind::Angle | Kind::Reading);
    let named: Vec<&Found> = found.findings.iter().filter(is_reading).collect();
    let accuses = named.iter().any(|at| at.accuses());
    let readings = named.iter().filter_map(|at| {
        let runs = at.scope.run.map_or_else(|| listed(at.scope.runs.iter().copied()), Words::from);
        Some(texts::reading_of(at.scope.position?, runs))
    });
    let outcome = if accuses { Outcome::Failed } else { Outcome::Undecided };
    let said = texts::with_outliers(listed(readings), texts::TESTS);
    say((!named.is_empty()).then(|| marked(outcome, said)))
}

/// The uncertainties that all positions have in common.
pub(super) fn certified(certificate: &Certificate) -> Block {
    let each = [
        (passport::REPEATABILITY, certificate.repeatability_arcsec),
        (passport::COMMON_PLATFORM, certificate.common_platform_arcsec),
        (passport::COMMON_BASE, certificate.common_base_arcsec),
    ];
    let arcsec = |u| Words::Quantity(Number::uncertainty(u), units::ARCSEC);
    fields(each.into_iter().filter_map(|(name, u)| field(name, u.map(arcsec))))
}

pub(crate) fn components(found: &Certification) -> Vec<Block> {
    let components = &found.components;
    let visits = [texts::OWN_X, texts::OWN_Y, texts::OWN_Z].into_iter().zip(&components.own_arcsec2);
    let visits = visits.chain([(texts::POOLED, &components.pooled_arcsec2)]);
    let visits = visits.map(|(name, of)| (name, of.value.sqrt(), of.degrees_of_freedom, None));
    let of_runs = [(texts::PLATFORM, Some(&components.platform)), (texts::BASE, components.base.as_ref())];
    let of_run = |(name, of): (Text, Option<&Common>)| {
        let of = of?;
        let upper = Some(of.upper_limit_arcsec2.sqrt()).filter(|s| *s > 0.0);
        Some((name, of.between_runs_arcsec2.sqrt(), of.degrees_of_freedom, upper))
    };
    let of_runs: Vec<_> = of_runs.into_iter().filter_map(of_run).collect();
    // So few degrees of freedom say little.
    let is_few = of_runs.iter().any(|(_, _, freedom, _)| *freedom < FEW_DEGREES);
    let rows: Vec<_> = visits.chain(of_runs).collect();
    let root = (found.runs.len() as f64).sqrt();
    let mean = Words::All(vec![symbol("s"), "/√".into(), symbol("R")]);
    let table = Rows::of(&rows, "numbers")
        .named(texts::COMPONENT, |(name, ..)| *name)
        .column(in_unit(symbol("s"), units::ARCSEC), |(_, s, ..)| Number::fixed(*s, 2))
        .column(symbol("ν"), |(_, _, freedom, _)| Number::at_most(*freedom, 1))
        .column(in_unit(mean, units::ARCSEC), |(_, s, ..)| Number::fixed(s / root, 2))
        .column(texts::UPPER, |(.., upper)| upper.map(|s| Number::fixed(s, 2)));
    let has_type_b = found.stand.certificate.type_b.iter().flatten().next().is_some();
    vec![
        heading(texts::COMPONENTS),
        say([texts::COMPONENTS_NOTE]),
        table.called(texts::COMPONENTS),
        say(is_few.then_some(texts::FEW_DEGREES)),
        say((!has_type_b).then(|| texts::type_b_not_stated(either("", " (type_b)")))),
        heading(texts::RUN_TURNS),
        run_turns(found),
    ]
}

fn run_turns(found: &Certification) -> Block {
    let of_base = [compass::EAST, compass::NORTH, compass::UP].map(Words::from);
    let mut rows = Rows::of(&found.components.run_turns, "numbers").named(texts::RUN, |turn| turn.run);
    for (place, axis) in AXES.map(symbol).into_iter().chain(of_base).enumerate() {
        // A terminal has no headings over several columns.
        let part = if place < 3 { texts::OF_PLATFORM } else { texts::OF_BASE };
        let with_part = vec![part.into(), " ".into(), axis.clone()];
        rows = rows.column(either(axis, with_part), |turn| {
            Number::fixed([turn.platform_arcsec, turn.base_arcsec].as_flattened()[place], 2)
        });
    }
    rows.table.groups = vec![(3, texts::OF_PLATFORM.into()), (3, texts::OF_BASE.into())];
    rows.called(texts::RUN_TURNS)
}

/// The findings of the search for causes, and what they mean.
pub(crate) fn tests(found: &Certification) -> [Block; 2] {
    let none = say([marked(Outcome::Passed, texts::NO_FINDING)]);
    let outcome = |at: &Found| match at.accuses() {
        true => marked(Outcome::Failed, texts::SIGNIFICANT),
        false => marked(Outcome::Undecided, texts::PROBABLE),
    };
    let table = Rows::of(&found.findings, "numbers tests")
        .named(texts::FINDING, |at| texts::found!(Kind, at.kind))
        .column(checks::RESULT, outcome)
        .column(texts::SIZE, |at| at.size.map(|size| Number::fixed(size, 2)))
        .column(symbol("p"), |at| probability(at.probability));
    let table = if found.findings.is_empty() { none } else { table.called(texts::TESTS) };
    [table, say([texts::TESTS_NOTE])]
}

/// The excluded readings and runs with their reasons; a terminal says nothing if there are none.
pub(crate) fn exclusions(found: &Certification) -> Vec<Block> {
    let evidence = found.stand.certificate.evidence.as_ref();
    let excluded = evidence.and_then(|evidence| evidence.excluded.as_deref()).unwrap_or_default();
    if excluded.is_empty() {
        return [heading(texts::EXCLUSIONS), say([texts::NO_EXCLUSIONS])].map(|block| block.only(On::Page)).into();
    }
    let position = |excluded: &Excluded| excluded.index().map_or_else(|| texts::ALL_POSITIONS.into(), Words::from);
    let table = Rows::of(excluded, "")
        .column(texts::POSITION, position)
        .column(texts::RUN, |excluded| excluded.run)
        .column(texts::REASON, |excluded| Words::Given(excluded.why.clone()));
    vec![heading(texts::EXCLUSIONS), table.called(texts::EXCLUSIONS), say([texts::EXCLUSIONS_NOTE])]
}
