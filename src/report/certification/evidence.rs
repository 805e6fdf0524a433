//! Evidence for a certificate: readings in doubt and excluded ones, components of the uncertainty, tests.

use crate::certification::Certification;
use crate::certification::components::Common;
use crate::certification::rotated_runs::{FEWEST_RUNS, FEWEST_RUNS_OF_A_MOVE, Pattern, RotatedRuns, most_suspect};
use crate::certification::suspects::{AXES, OUTLIER, STRAGGLER};
use crate::report::doc::{Block, On, Rows, Words, fields, heading, in_unit, listed, marked, probability, say, symbol};
use crate::report::page::language::Text;
use crate::report::page::number::Number;
use crate::report::style::Outcome;
use crate::stand::{Certificate, Excluded};
use crate::statistics::outlier::Bartlett;
use crate::wording::texts::{certification as texts, checks, compass, passport, units};

/// Degrees of freedom at which a standard deviation has a relative standard uncertainty of 35 %: 1/√(2ν), JCGM 100, E.4.3.
pub(crate) const FEW_DEGREES: f64 = 4.0;

/// Which readings in the means the tests name.
pub(crate) fn outliers(found: &Certification) -> Block {
    let mut named: Vec<_> = found.suspects.outliers.iter().map(|out| (out.index, out.run, out.probability)).collect();
    named.dedup_by_key(|(index, run, _)| (*index, *run));
    let worst = named.iter().map(|(.., p)| *p).reduce(f64::min);
    let readings = listed(named.iter().map(|(index, run, _)| texts::reading_of(*index, *run)));
    say(worst.map(|worst| marked(graded(worst), texts::with_outliers(readings, texts::TESTS))))
}

/// The uncertainties that all positions have in common.
pub(super) fn certified(certificate: &Certificate) -> Block {
    let each = [
        (passport::REPEATABILITY, certificate.repeatability_arcsec),
        (passport::COMMON_PLATFORM, certificate.common_platform_arcsec),
        (passport::COMMON_BASE, certificate.common_base_arcsec),
    ];
    let stated = |(name, u): (Text, Option<f64>)| {
        u.map(|u| (name, Words::Quantity(Number::uncertainty(u), units::ARCSEC), false))
    };
    fields(each.into_iter().filter_map(stated).collect())
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
    let key = Words::Either(Box::new("".into()), Box::new(" (type_b)".into()));
    vec![
        heading(texts::COMPONENTS),
        say([texts::COMPONENTS_NOTE]),
        table.called(texts::COMPONENTS),
        say(is_few.then_some(texts::FEW_DEGREES)),
        say((!has_type_b).then(|| texts::type_b_not_stated(key))),
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
        let with_part = vec![part.into(), " ".into(), axis.clone()].into();
        rows = rows.column(Words::Either(Box::new(axis), Box::new(with_part)), |turn| {
            Number::fixed([turn.platform_arcsec, turn.base_arcsec].as_flattened()[place], 2)
        });
    }
    rows.table.groups = vec![(3, texts::OF_PLATFORM.into()), (3, texts::OF_BASE.into())];
    rows.called(texts::RUN_TURNS)
}

/// A row of the table of tests: what was tested, what was found, and the numbers behind it.
struct Tested {
    name: Words,
    result: Words,
    statistic: Option<Number>,
    freedom: Option<usize>,
    probability: Option<f64>,
}

/// A test that was made: `words` say that it finds nothing, a straggler, an outlier.
fn tested(name: impl Into<Words>, words: [Text; 3], found: Option<(Number, f64)>) -> Tested {
    let outcome = found.as_ref().map_or(Outcome::Passed, |(_, p)| graded(*p));
    let word = match outcome {
        Outcome::Failed => words[2],
        Outcome::Undecided => words[1],
        Outcome::Passed | Outcome::NotAsked => words[0],
    };
    let (statistic, probability) = found.unzip();
    Tested { name: name.into(), result: marked(outcome, word), statistic, freedom: None, probability }
}

fn bartlett(name: Text, test: Option<&Bartlett>) -> Tested {
    let Some(test) = test else {
        let result = marked(Outcome::NotAsked, texts::NOT_MADE);
        return Tested { result, ..tested(name, [texts::NOT_MADE; 3], None) };
    };
    let found = (Number::chi_square(test.statistic), test.probability);
    let of_variances = tested(name, [texts::EQUAL, texts::DOUBTFUL, texts::UNEQUAL], Some(found));
    Tested { freedom: Some(test.degrees_of_freedom), ..of_variances }
}

const OF_VALUES: [Text; 3] = [texts::NOT_SUSPECT, texts::STRAGGLER, texts::OUTLIER];

/// The tests, and what they mean.
pub(crate) fn tests(found: &Certification) -> [Block; 2] {
    let suspects = &found.suspects;
    let value = |statistic: f64, p: f64| Some((Number::fixed(statistic, 2), p));
    let mut rows = vec![
        bartlett(texts::BARTLETT_POSITIONS, suspects.positions.as_ref()),
        bartlett(texts::BARTLETT_AXES, suspects.axes.as_ref()),
    ];
    let worse = suspects.worse.iter();
    rows.extend(worse.map(|at| tested(texts::cochran(at.index), OF_VALUES, value(at.ratio, at.probability))));
    rows.extend(suspects.outliers.iter().map(|out| {
        let name = texts::grubbs(out.index, out.run, AXES[out.axis]);
        tested(name, OF_VALUES, value(out.residual_arcsec, out.probability))
    }));
    rows.extend(found.rotated_runs.iter().map(|at| {
        let axis = at.axis.word();
        let name = match (at.pattern, at.axis.is_of_the_base()) {
            (Pattern::One(run), true) => texts::grubbs_base(run, axis),
            (Pattern::One(run), false) => texts::grubbs_platform(run, axis),
            (Pattern::Move(run, _), true) => texts::move_base(run, axis),
            (Pattern::Move(run, _), false) => texts::move_platform(run, axis),
            (Pattern::Drift, true) => texts::drift_base(axis),
            (Pattern::Drift, false) => texts::drift_platform(axis),
        };
        // A shift or a drift is not an outlier.
        let of_moves = [texts::NOT_SUSPECT, texts::PROBABLE, texts::SIGNIFICANT];
        let words = if at.pattern.is_in_order() { of_moves } else { OF_VALUES };
        tested(name, words, value(at.turn_arcsec(), at.probability))
    }));
    rows.extend(without_findings(found));
    let table = Rows::of(&rows, "numbers tests")
        .named(texts::TEST, |test| test.name.clone())
        .column(checks::RESULT, |test| test.result.clone())
        .column(texts::STATISTIC, |test| test.statistic.clone())
        .column(symbol("ν"), |test| test.freedom)
        .column(symbol("p"), |test| test.probability.map(probability));
    [table.called(texts::TESTS), say([texts::TESTS_NOTE])]
}

/// The tests that were made and name nothing.
fn without_findings(found: &Certification) -> impl Iterator<Item = Tested> {
    let (suspects, components) = (&found.suspects, &found.components);
    let runs = found.runs.len();
    let (bumped, moved): (Vec<&RotatedRuns>, Vec<_>) = found.rotated_runs.iter().partition(|at| at.run().is_some());
    let rotated = |in_order: bool| {
        let at = most_suspect(components, &suspects.outliers, &found.rotated_runs, in_order)?;
        Some((at.turn_arcsec(), at.probability))
    };
    let none = [
        (
            texts::outlying_angles(found.tested_angles()),
            (suspects.outliers.is_empty() && suspects.split.is_none()).then(|| suspects.most_suspect_angle(components)),
        ),
        (
            texts::rotated_runs(runs, 3 + components.base_axes),
            (bumped.is_empty() && runs >= FEWEST_RUNS).then(|| rotated(false)),
        ),
        (texts::move_or_drift(runs), (moved.is_empty() && runs >= FEWEST_RUNS_OF_A_MOVE).then(|| rotated(true))),
    ];
    none.into_iter().filter_map(|(name, found)| {
        // What would be suspect but for the resolution of the readings is not.
        let found = found?.filter(|(_, probability)| graded(*probability) == Outcome::Passed);
        Some(tested(name, OF_VALUES, found.map(|(value, p)| (Number::fixed(value, 2), p))))
    })
}

/// Returns the outcome of a test from its probability: an outlier fails, a straggler decides nothing.
fn graded(probability: f64) -> Outcome {
    match probability {
        p if p < OUTLIER => Outcome::Failed,
        p if p < STRAGGLER => Outcome::Undecided,
        _ => Outcome::Passed,
    }
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
