//! Parameters by every method, and the steps of the iteration.

use super::Report;
use crate::calibration::analytic::NoAnalyticSolution;
use crate::calibration::document::ResultDocument;
use crate::calibration::iterative::NoIterativeSolution;
use crate::calibration::result::MethodRefusal;
use crate::calibration::{Method, Parameter};
use crate::report::doc::{Block, Rows, Words, fields, heading, say, symbol};
use crate::wording::Number;
use crate::wording::texts::{calibration as texts, passport, units};

pub(super) fn section(of: &Report) -> Vec<Block> {
    let results = &of.document.results;
    let is_compared = results.iter().any(|result| result.from_least_squares.is_some()) && has_least_squares(results);
    let mut doc = vec![table(of), say(is_compared.then_some(texts::OFF_BY_NOTE))];
    doc.extend(results.iter().flat_map(iteration));
    doc.extend(refused(of));
    doc
}

/// The methods of a result that is not [in agreement](agreement): their values if there are several, and those that gave none.
pub(super) fn brief(of: &Report) -> Vec<Block> {
    // Of parameters that are not valid a comparison says nothing more.
    let is_valid = of.calibration.consistent;
    let is_compared = is_valid && of.document.results.len() > 1 && agreement(of).is_none();
    is_compared.then(|| table(of)).into_iter().chain(refused(of)).collect()
}

/// A sentence on each method that gave no result.
fn refused(of: &Report) -> impl Iterator<Item = Block> {
    let refused = of.calibration.refused.iter();
    refused.map(|(method, why)| say([texts::no_result(texts::method!(Method, method), reason(why))]))
}

/// The reason why a method gave no result.
fn reason(refusal: &MethodRefusal) -> Words {
    match refusal {
        MethodRefusal::Analytic(NoAnalyticSolution::EightPositionsMissing)
        | MethodRefusal::Iterative(NoIterativeSolution::EightPositionsMissing) => texts::EIGHT_MISSING.into(),
        MethodRefusal::Analytic(NoAnalyticSolution::SingularCurrents)
        | MethodRefusal::Iterative(NoIterativeSolution::SingularCurrents) => texts::SINGULAR.into(),
        MethodRefusal::Iterative(NoIterativeSolution::Diverges(radius) | NoIterativeSolution::TooManySteps(radius)) => {
            texts::diverges(Number::significant(*radius, 2))
        }
        MethodRefusal::NotThisModel => texts::NOT_THIS_MODEL.into(),
        // Without least squares there is no report.
        MethodRefusal::LeastSquares(refusal) => refusal.to_string().into(),
    }
}

/// Returns `true` if the values from which the others differ are among the results.
fn has_least_squares(results: &[ResultDocument]) -> bool {
    results.iter().any(|result| result.method == Method::LeastSquares.key())
}

/// The sentence that the paper's methods agree with least squares, whose values are then stated alone; `None` if they do not,
/// or with details.
pub(super) fn agreement(of: &Report) -> Option<Words> {
    let results = &of.document.results;
    let are_compared = results.len() > 1 && of.calibration.refused.is_empty() && has_least_squares(results);
    let others_agree = are_compared && !of.details && results.iter().all(agrees);
    others_agree.then(|| texts::methods_agree(Number::exact(MOST_OFF)))
}

/// Largest difference between methods that agree, in its standard uncertainties.
const MOST_OFF: f64 = 3.0;

fn agrees(result: &ResultDocument) -> bool {
    result.from_least_squares.is_none_or(|off| off.iter().all(|off| off.is_nan() || off.abs() <= MOST_OFF))
}

fn table(of: &Report) -> Block {
    let results = &of.document.results;
    let rows = results.iter().flat_map(|result| {
        let found = result.found(1.0, None);
        let (values, u) = (found.parameters.to_vector(), found.standard_uncertainty);
        let cells = |number: &dyn Fn(usize) -> Number| {
            // The general model has no ω_g and ω_k.
            Parameter::AS_IN_THE_PAPER.map(|one| (!values[one.place()].is_nan()).then(|| number(one.place())))
        };
        let adopted = of.adopted().is_some_and(|adopted| adopted.method == result.method);
        let method = Method::ALL.into_iter().find(|method| method.key() == result.method);
        let method = method.map(|method| texts::method!(Method, method));
        let name = if adopted { texts::adopted(method) } else { method.into() };
        let mut rows = vec![
            (Words::Strong(Box::new(name)), cells(&|place| Number::measured(values[place], u[place]))),
            (symbol("u"), cells(&|place| Number::uncertainty(u[place]))),
        ];
        let off = result.from_least_squares.filter(|_| has_least_squares(results));
        rows.extend(off.map(|off| (texts::OFF_BY.into(), cells(&|place| Number::fixed(off[place], 1)))));
        rows
    });
    let (g, u) = (of.document.gravity_m_per_s2, of.document.gravity_u_m_per_s2);
    let caption = texts::parameters_caption(Number::measured(g, u.unwrap_or(0.0)));
    parameters(&rows.collect::<Vec<_>>()).captioned(texts::METHODS, caption)
}

/// Returns a table of the eight parameters in the paper's groups, one row for each quantity. A group without any number is
/// omitted: the general model has no ω_g and ω_k.
pub(crate) fn parameters<T: Into<Words> + Clone>(
    rows: &[(Words, [Option<T>; 8])],
) -> Rows<'_, (Words, [Option<T>; 8])> {
    let groups = [
        (passport::SCALE_FACTORS_MAIN, units::DEG_PER_H_PER_MA),
        (passport::SCALE_FACTORS_CROSS, units::DEG_PER_H_PER_MA),
        (passport::DRIFT_CONSTANT, units::DEG_PER_H),
        (passport::DRIFT_G, units::DEG_PER_H_PER_G),
    ];
    let mut table = Rows::of(rows, "numbers parameters").named("", |(name, _)| name.clone());
    for (group, (name, unit)) in groups.into_iter().enumerate() {
        let places = [2 * group, 2 * group + 1];
        if rows.iter().any(|(_, cells)| places.iter().any(|place| cells[*place].is_some())) {
            for place in places {
                let heading = symbol(Parameter::AS_IN_THE_PAPER[place].symbol());
                table = table.column(heading, |(_, cells)| cells[place].clone());
            }
            table.table.groups.push((2, units::named(name, unit)));
        }
    }
    table
}

/// The spectral radius and the steps of the iterative method; nothing for the other methods.
fn iteration(result: &ResultDocument) -> Vec<Block> {
    let Some((radius, steps)) = result.spectral_radius.zip(result.iterations) else { return Vec::new() };
    let errors = result.remaining_errors();
    let remaining = |place: usize, unit| {
        errors.map_or(Words::Blank, |errors| match errors[place] {
            None => texts::NEGLIGIBLE.into(),
            Some(most) => Words::Quantity(Number::scientific(most, 2), unit),
        })
    };
    let course = fields(vec![
        (texts::SPECTRAL_RADIUS, Number::scientific(radius, 2).into(), false),
        (texts::STEPS, (steps as usize).into(), false),
        (texts::REMAINDER_K, remaining(0, units::DEG_PER_H_PER_MA), false),
        (texts::REMAINDER_OMEGA, remaining(1, units::DEG_PER_H_PER_G), false),
    ]);
    vec![heading(texts::ITERATIVE), course]
}
