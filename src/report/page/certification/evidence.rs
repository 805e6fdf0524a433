//! Evidence for a certificate: readings, exclusions, components of the uncertainty, tests.

use super::CertificationPage;
use crate::certification::components::{Common, Variance};
use crate::certification::rotated_runs::{self, FEWEST_RUNS, FEWEST_RUNS_OF_A_MOVE, Pattern, RotatedRuns};
use crate::certification::suspects::{AXES, OUTLIER, STRAGGLER};
use crate::report::page::language::{Languages, Text, values};
use crate::report::page::number::{Cell, Number, column};
use crate::report::page::parts::{
    Column, Table, field, fields, file_name, given, heading, marked, symbol, symbol_and_unit, wide_field,
};
use crate::report::page::passport::characteristics;
use crate::report::page::texts::{certification as texts, checks, units};
use crate::report::style::Outcome;
use crate::statistics::outlier::Bartlett;
use crate::wording::compass;
use maud::{Markup, html};

/// Degrees of freedom at which a standard deviation has a relative standard uncertainty of 35 %: 1/√(2ν), JCGM 100, E.4.3.
pub(super) const FEW_DEGREES: f64 = 4.0;

pub(super) fn readings(page: &CertificationPage, languages: &Languages) -> Markup {
    let certification = page.certification;
    let runs: Vec<String> = certification.runs.iter().map(u32::to_string).collect();
    let evidence = certification.stand.certificate.evidence.as_ref();
    let excluded = evidence.and_then(|evidence| evidence.excluded.as_deref()).unwrap_or_default();
    let rows = excluded.iter().map(|excluded| {
        let position = match excluded.index() {
            Some(index) => html! { (index.to_string()) },
            None => languages.inline(texts::ALL_POSITIONS),
        };
        vec![position, html! { (excluded.run) }, given(&excluded.why)]
    });
    let table = Table {
        headings: [texts::POSITION, texts::RUN, texts::REASON].map(|text| languages.label(text)).into(),
        rows: rows.collect(),
        ..Table::default()
    };
    html! {
        (fields([
            field(languages, texts::FILE, Some(given(file_name(page.readings.0)))),
            field(languages, texts::RUNS, Some(html! { (runs.len()) " (" (runs.join(", ")) ")" })),
            field(languages, texts::POSITIONS, Some(html! { (certification.stand.positions.len()) })),
            field(languages, texts::REPEATED, Some(html! { (certification.repeated_rows) })),
            wide_field(languages, texts::FILE_SHA256, Some(html! { code { (page.sha256()) } })),
        ]))
        (heading(languages, texts::EXCLUSIONS))
        @if excluded.is_empty() {
            (languages.paragraph(texts::NO_EXCLUSIONS))
        } @else {
            (table.markup(languages.spoken(texts::EXCLUSIONS)))
            (languages.paragraph(texts::EXCLUSIONS_NOTE))
        }
    }
}

pub(super) fn uncertainty(page: &CertificationPage, languages: &Languages) -> Markup {
    html! {
        (heading(languages, texts::BUDGET))
        (characteristics::common(&page.certification.stand.certificate, languages))
        (heading(languages, texts::COMPONENTS))
        (languages.paragraph(texts::COMPONENTS_NOTE))
        (components(page, languages))
        @if has_few_degrees(page) { (languages.paragraph(texts::FEW_DEGREES)) }
        (heading(languages, texts::RUN_TURNS))
        (run_turns(page, languages))
    }
}

/// Returns `true` if the common part of the platform or of the base has so few degrees of freedom that it says little.
fn has_few_degrees(page: &CertificationPage) -> bool {
    let components = &page.certification.components;
    let mut common = std::iter::once(&components.platform).chain(&components.base);
    common.any(|part| part.degrees_of_freedom < FEW_DEGREES)
}

fn components(page: &CertificationPage, languages: &Languages) -> Markup {
    let components = &page.certification.components;
    let [x, y, z] = &components.own_arcsec2;
    let visit = |name: Text, of: &Variance| (name, of.value.sqrt(), of.degrees_of_freedom, None);
    let run = |name: Text, of: &Common| {
        (
            name,
            of.between_runs_arcsec2.sqrt(),
            of.degrees_of_freedom,
            Some(of.upper_limit_arcsec2.sqrt()).filter(|s| *s > 0.0),
        )
    };
    let mut found = vec![
        visit(texts::OWN_X, x),
        visit(texts::OWN_Y, y),
        visit(texts::OWN_Z, z),
        visit(texts::POOLED, &components.pooled_arcsec2),
        run(texts::PLATFORM, &components.platform),
    ];
    found.extend(components.base.iter().map(|base| run(texts::BASE, base)));
    let root = (page.certification.runs.len() as f64).sqrt();
    let arcsec = |markup: Markup| symbol_and_unit(languages, &markup, units::ARCSEC);
    let mean = arcsec(html! { span.symbol { i { "s" } "/√" i { "R" } } });
    let s = column(languages, found.iter().map(|(_, s, ..)| Number::fixed(*s, 2)));
    let freedom = column(languages, found.iter().map(|(_, _, freedom, _)| Number::at_most(*freedom, 1)));
    let of_mean = column(languages, found.iter().map(|(_, s, ..)| Number::fixed(s / root, 2)));
    let upper = column(languages, found.iter().map(|(.., upper)| upper.map(|s| Number::fixed(s, 2))));
    let columns = [
        Column::new(arcsec(symbol("s", "")), s),
        Column::new(symbol("ν", ""), freedom),
        Column::new(mean, of_mean),
        Column::named(languages, texts::UPPER, upper),
    ];
    let names = found.iter().map(|(name, ..)| vec![languages.label(*name)]).collect();
    let table = Table::of(vec![languages.label(texts::COMPONENT)], names, &columns);
    table.markup(languages.spoken(texts::COMPONENTS))
}

fn run_turns(page: &CertificationPage, languages: &Languages) -> Markup {
    let turns = &page.certification.components.run_turns;
    let of_base = [compass::EAST, compass::NORTH, compass::UP].map(|text| languages.label(text));
    let headings = AXES.map(|axis| symbol(axis, "")).into_iter().chain(of_base);
    let columns = headings.enumerate().map(|(place, heading)| {
        let values = turns.iter().map(|turn| turn.platform_arcsec.iter().chain(&turn.base_arcsec).nth(place));
        Column::new(heading, column(languages, values.map(|value| value.map(|value| Number::fixed(*value, 2)))))
    });
    let columns: Vec<Column> = columns.collect();
    let names = turns.iter().map(|turn| vec![html! { (turn.run) }]).collect();
    let table = Table {
        groups: vec![(3, languages.label(texts::OF_PLATFORM)), (3, languages.label(texts::OF_BASE))],
        ..Table::of(vec![languages.label(texts::RUN)], names, &columns)
    };
    table.markup(languages.spoken(texts::RUN_TURNS))
}

/// A row of the table of tests: what was tested, what was found, and the numbers behind it.
struct Tested {
    name: Markup,
    result: Markup,
    statistic: Option<Number>,
    freedom: Option<Number>,
    probability: Option<f64>,
}

pub(super) fn tests(page: &CertificationPage, languages: &Languages) -> Markup {
    let suspects = &page.certification.suspects;
    let mut found: Vec<Tested> = Vec::new();
    let said = |outcome: Outcome, text: Text| marked(outcome, &languages.inline(text));
    let bartlett = |name: Text, test: &Bartlett| Tested {
        name: languages.label(name),
        result: match graded(test.probability) {
            Outcome::Failed => said(Outcome::Failed, texts::UNEQUAL),
            Outcome::Undecided => said(Outcome::Undecided, texts::DOUBTFUL),
            passed => said(passed, texts::EQUAL),
        },
        statistic: Some(Number::chi_square(test.statistic)),
        freedom: Some(Number::exact(test.degrees_of_freedom as f64)),
        probability: Some(test.probability),
    };
    // A test names something only below the limit of stragglers.
    let graded_as = |[significant, doubtful]: [Text; 2], name: Markup, statistic: f64, p: f64| Tested {
        name,
        result: match graded(p) {
            Outcome::Failed => said(Outcome::Failed, significant),
            _ => said(Outcome::Undecided, doubtful),
        },
        statistic: Some(Number::fixed(statistic, 2)),
        freedom: None,
        probability: Some(p),
    };
    let named = |name, statistic, p| graded_as([texts::OUTLIER, texts::STRAGGLER], name, statistic, p);
    let of_variances = [(texts::BARTLETT_POSITIONS, &suspects.positions), (texts::BARTLETT_AXES, &suspects.axes)];
    found.extend(of_variances.map(|(name, test)| match test {
        Some(test) => bartlett(name, test),
        None => Tested {
            name: languages.label(name),
            result: said(Outcome::NotAsked, texts::NOT_MADE),
            statistic: None,
            freedom: None,
            probability: None,
        },
    }));
    found.extend(suspects.worse.iter().map(|at| {
        let name = languages.label_with(|language| texts::COCHRAN.filled(language, values! { index: at.index }));
        named(name, at.ratio, at.probability)
    }));
    found.extend(suspects.outliers.iter().map(|out| {
        let name = languages.label_with(|language| {
            texts::GRUBBS.filled(language, values! { index: out.index, run: out.run, axis: AXES[out.axis] })
        });
        named(name, out.residual_arcsec, out.probability)
    }));
    found.extend(page.certification.rotated_runs.iter().map(|at| {
        let (of, run) = match (at.pattern, at.axis.is_of_the_base()) {
            (Pattern::One(run), true) => (texts::GRUBBS_BASE, run),
            (Pattern::One(run), false) => (texts::GRUBBS_PLATFORM, run),
            (Pattern::Move(run, _), true) => (texts::MOVE_BASE, run),
            (Pattern::Move(run, _), false) => (texts::MOVE_PLATFORM, run),
            (Pattern::Drift, true) => (texts::DRIFT_BASE, 0),
            (Pattern::Drift, false) => (texts::DRIFT_PLATFORM, 0),
        };
        let name = languages.label_with(|language| of.filled(language, values! { run, axis: at.axis.word() }));
        match at.pattern {
            Pattern::One(_) => named(name, at.turn_arcsec(), at.probability),
            // A shift or a drift is not an outlier.
            _ => graded_as([texts::SIGNIFICANT, texts::PROBABLE], name, at.turn_arcsec(), at.probability),
        }
    }));
    found.extend(without_findings(page, languages));
    let cells = |cell: fn(&Tested) -> Option<Cell>| {
        column(languages, found.iter().map(|test| cell(test).unwrap_or_else(Cell::none)))
    };
    let columns = [
        Column::named(languages, checks::RESULT, found.iter().map(|test| test.result.clone()).collect()),
        Column::named(languages, texts::STATISTIC, cells(|test| test.statistic.clone().map(Cell::Number))),
        Column::new(symbol("ν", ""), cells(|test| test.freedom.clone().map(Cell::Number))),
        Column::named(languages, texts::PROBABILITY, cells(|test| test.probability.map(Cell::probability))),
    ];
    let names = found.iter().map(|test| vec![test.name.clone()]).collect();
    let table = Table { class: "numbers tests", ..Table::of(vec![languages.label(texts::TEST)], names, &columns) };
    html! {
        (table.markup(languages.spoken(texts::TESTS)))
        (languages.paragraph(texts::TESTS_NOTE))
        @if !page.certification.remarks.is_empty() {
            (heading(languages, texts::WARNINGS))
            ul {
                @for remark in &page.certification.remarks {
                    li { (languages.label_with(|language| remark.words(language))) }
                }
            }
        }
    }
}

/// Returns the tests that were made and named nothing.
fn without_findings<'a>(page: &CertificationPage, languages: &'a Languages) -> impl Iterator<Item = Tested> + 'a {
    let (suspects, components) = (&page.certification.suspects, &page.certification.components);
    let (runs, axes) = (page.certification.runs.len(), 3 + components.base_axes);
    let (bumped, moved): (Vec<&RotatedRuns>, Vec<_>) =
        page.certification.rotated_runs.iter().partition(|at| at.run().is_some());
    let angles = page.certification.tested_angles();
    let rotated = |in_order: bool| {
        let named = &page.certification.rotated_runs;
        let at = rotated_runs::most_suspect(components, &suspects.outliers, named, in_order)?;
        Some((at.turn_arcsec(), at.probability))
    };
    let none = [
        (
            texts::OUTLYING_ANGLES,
            angles,
            (suspects.outliers.is_empty() && suspects.split.is_none()).then(|| suspects.most_suspect_angle(components)),
        ),
        (texts::ROTATED_RUNS, runs, (bumped.is_empty() && runs >= FEWEST_RUNS).then(|| rotated(false))),
        (texts::MOVE_OR_DRIFT, runs, (moved.is_empty() && runs >= FEWEST_RUNS_OF_A_MOVE).then(|| rotated(true))),
    ];
    none.into_iter().filter_map(move |(name, count, found)| {
        // What would be suspect but for the resolution of the readings is not.
        let found = found?.filter(|(_, probability)| graded(*probability) == Outcome::Passed);
        Some(Tested {
            name: languages.label_with(|language| name.filled(language, values! { axes, count })),
            result: marked(Outcome::Passed, &languages.inline(texts::NOT_SUSPECT)),
            statistic: found.map(|(value, _)| Number::fixed(value, 2)),
            freedom: None,
            probability: found.map(|(_, probability)| probability),
        })
    })
}

/// Returns the outcome of a test from its probability: an outlier fails, a straggler decides nothing.
pub(super) fn graded(probability: f64) -> Outcome {
    match probability {
        p if p < OUTLIER => Outcome::Failed,
        p if p < STRAGGLER => Outcome::Undecided,
        _ => Outcome::Passed,
    }
}
