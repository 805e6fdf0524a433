//! K by the analytic method with a pocket calculator: every step with the numbers of the passport.

use super::numbers::DECIMALS;
use crate::passport::{Content, MatrixRows};
use crate::report::doc::{Block, Rows, Words, heading, say};
use crate::wording::Number;
use crate::wording::texts::passport as texts;

/// Printed decimals of K: all that numbers of nine decimals determine.
const DECIMALS_OF_K: usize = 5;

/// Factor of a product: the result of an earlier line, or a number of the passport.
enum Factor {
    Line(usize),
    Number(f64),
}
use Factor::{Line, Number as Of};

/// What a line computes, and its result for the self-check.
struct Row(Words, Number);

/// Returns the steps of (11) and (13), with their results for the currents of the self-check.
pub(super) fn section(content: &Content) -> Vec<Block> {
    let Some(matrices) = &content.matrices else { return vec![say([texts::NO_MATRICES])] };
    let check = content.self_check.as_ref();
    let current = |i, j| {
        let at = check?.currents.iter().find(|at| (at.i, at.j) == (i, j))?;
        Some([at.jx_ma, at.jy_ma].map(rounded))
    };
    let rows = steps(matrices, |i, j| current(i, j).unwrap_or_default());
    let numbered: Vec<_> = (1..).zip(&rows).collect();
    let table = Rows::of(&numbered, "numbers")
        .named(texts::LINE, |(line, _): &(usize, _)| format!("({line})"))
        .column(texts::CALCULATION, |(_, Row(formula, _))| formula.clone())
        .column(texts::FOR_CHECK, |(_, Row(_, value))| value)
        .only_if(check.is_some())
        .column(texts::RESULT, |_| "..........");
    vec![heading(texts::WORKSHEET), say([texts::WORKSHEET_NOTE]), table.called(texts::WORKSHEET)]
}

/// Returns a number as it is printed: whoever computes by hand goes on with these decimals.
fn rounded(value: f64) -> f64 {
    const UNIT: f64 = 1e9;
    (value * UNIT).round() / UNIT
}

fn steps(m: &MatrixRows, currents: impl Fn(u32, u32) -> [f64; 2]) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    // Lines 1 to 4 are J_1, and 5 to 8 are J_2, by rows.
    for (i, axis) in [(1, 0), (1, 1), (2, 0), (2, 1)] {
        for (j, opposite) in [(1, 3), (2, 4)] {
            let name = ["J_x", "J_y"][axis];
            let difference = currents(i, j)[axis] - currents(i, opposite)[axis];
            rows.push(Row(format!("{name}{i}{j} − {name}{i}{opposite}").into(), Number::fixed(difference, DECIMALS)));
        }
    }
    // Lines 9 to 12 are J_1 − J_2 Δ, and line 13 its determinant.
    for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let j2 = 5 + 2 * row;
        let delta = [0, 1].map(|k| Of(m.delta[k][column]));
        let [first, second] = delta;
        let of_j1 = vec![Line(1 + 2 * row + column)];
        sum(&mut rows, &[(1.0, of_j1), (-1.0, vec![first, Line(j2)]), (-1.0, vec![second, Line(j2 + 1)])]);
    }
    sum(&mut rows, &[(1.0, vec![Line(9), Line(12)]), (-1.0, vec![Line(10), Line(11)])]);
    // Lines 14 to 17 are B times the adjugate, lines 18 to 21 are K.
    for [b1, b2] in m.b_deg_per_h {
        sum(&mut rows, &[(1.0, vec![Of(b1), Line(12)]), (-1.0, vec![Of(b2), Line(11)])]);
        sum(&mut rows, &[(1.0, vec![Of(b2), Line(9)]), (-1.0, vec![Of(b1), Line(10)])]);
    }
    for (line, name) in [(14, "K_x"), (15, "K_xy"), (16, "K_yx"), (17, "K_y")] {
        let value = rows[line - 1].1.value / rows[12].1.value;
        rows.push(Row(format!("{name} = ({line}) / (13)").into(), Number::fixed(value, DECIMALS_OF_K)));
    }
    rows
}

/// Adds the line of a sum of products. A negative number of the passport changes the sign before it.
fn sum(rows: &mut Vec<Row>, terms: &[(f64, Vec<Factor>)]) {
    let (mut formula, mut total): (Vec<Words>, f64) = (Vec::new(), 0.0);
    for (sign, factors) in terms {
        let start = formula.len();
        let mut product = *sign;
        for factor in factors {
            let (value, words) = match factor {
                Line(line) => (rounded(rows[line - 1].1.value), format!("({line})").into()),
                Of(value) => (rounded(*value), Number::fixed(value.abs(), DECIMALS).into()),
            };
            if formula.len() > start {
                formula.push(" × ".into());
            }
            formula.push(words);
            product *= value;
        }
        let is_negative = factors.iter().any(|factor| matches!(factor, Of(value) if *value < 0.0)) != (*sign < 0.0);
        let before = match (start, is_negative) {
            (0, false) => "",
            (0, true) => "−",
            (_, false) => " + ",
            (_, true) => " − ",
        };
        formula.insert(start, before.into());
        total += product;
    }
    rows.push(Row(formula.into(), Number::fixed(rounded(total), DECIMALS)));
}
