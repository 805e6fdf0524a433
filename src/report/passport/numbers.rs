//! Numbers that a calibration uses: matrices, vectors, the self-check.

use crate::calibration::parameter::Parameter;
use crate::gyro::Parameters;
use crate::passport::content::{PositionCurrents as Current, PositionVectors as Vectors, SelfCheck};
use crate::passport::{Content, MatrixRows, Rows as Matrix};
use crate::report::calibration::parameters;
use crate::report::doc::{Block, On, Rows, Words, drawn, heading, in_unit, say, symbol};
use crate::report::page::language::Languages;
use crate::report::page::parts::symbol as written;
use crate::wording::texts::{passport as texts, units};
use crate::wording::{Number, Text};
use maud::{Markup, html};

/// Paper from which the equations are numbered.
const PAPER: &str = "doi:10.18698/2308-6033-2017-10-1691";

/// Decimals of numbers without an uncertainty: 1e-9 °/h and 1e-9 g are far below the resolution of any reading.
pub(crate) const DECIMALS: usize = 9;

pub(super) fn section(content: &Content) -> Vec<Block> {
    let mut doc = vec![say([texts::DIGITS_NOTE.into(), texts::equations_note(PAPER)])];
    doc.extend(match &content.matrices {
        Some(m) => {
            vec![matrices(m), say([texts::FORMULAS]).only(On::Page), Block::Drawn(drawn(formulas))]
        }
        None => vec![say([texts::NO_MATRICES])],
    });
    doc.extend([heading(texts::VECTORS), vectors(content)]);
    doc.extend(content.self_check.as_ref().map_or_else(Vec::new, self_check));
    doc
}

fn nine(value: f64) -> Number {
    Number::fixed(value, DECIMALS)
}

fn matrices(m: &MatrixRows) -> Block {
    let rows: [(&str, Text, &Matrix); 8] = [
        ("Δ", units::ONE, &m.delta),
        ("B", units::DEG_PER_H, &m.b_deg_per_h),
        ("C", units::DEG_PER_H_PER_G, &m.c_deg_per_h_per_g),
        ("n_1", units::G, &m.n1),
        ("n_2", units::G, &m.n2),
        ("n_2⁻¹", units::PER_G, &m.n2_inverse),
        ("ω_31", units::DEG_PER_H, &m.omega1_deg_per_h),
        ("ω_32", units::DEG_PER_H, &m.omega2_deg_per_h),
    ];
    // Each row is a matrix; its numbers have one alignment.
    let table = Rows::of(&rows, "numbers with-unit")
        .named(texts::MATRIX, |(name, ..)| symbol(name))
        .column(texts::UNIT, |(_, unit, _)| *unit);
    let places = [("11", 0, 0), ("12", 0, 1), ("21", 1, 0), ("22", 1, 1)];
    let table = places.into_iter().fold(table, |table, (name, i, j)| table.column(name, |(.., m)| nine(m[i][j])));
    table.captioned(texts::MATRICES_CAPTION, texts::MATRICES_CAPTION)
}

fn vectors(content: &Content) -> Block {
    let (g, rate) = (units::G, units::DEG_PER_H);
    let mut rows = Rows::of(&content.vectors, "numbers")
        .named(symbol("i"), |at| at.i)
        .named(symbol("j"), |at| at.j)
        .column(in_unit(symbol("n_x"), g), |at| nine(at.specific_force_g[0]))
        .column(in_unit(symbol("n_y"), g), |at| nine(at.specific_force_g[1]))
        .column(in_unit(symbol("n_z"), g), |at| nine(at.specific_force_z_g))
        .column(in_unit(symbol("ω_3x"), rate), |at| nine(at.omega_deg_per_h[0]))
        .column(in_unit(symbol("ω_3y"), rate), |at| nine(at.omega_deg_per_h[1]));
    let mut caption = texts::VECTORS_ALONE_CAPTION;
    if let Some(check) = &content.self_check {
        let current = |at: &Vectors| check.currents.iter().find(|current| (current.i, current.j) == (at.i, at.j));
        let ma = |name| in_unit(symbol(name), units::MILLIAMPERES);
        let of = |at: &Vectors, of: fn(&Current) -> f64| current(at).map(|current| nine(of(current)));
        rows = rows.column(ma("J_x"), |at| of(at, |at| at.jx_ma)).column(ma("J_y"), |at| of(at, |at| at.jy_ma));
        caption = texts::VECTORS_CAPTION;
    }
    rows.grouped_by(|at| at.i).captioned(caption, caption)
}

fn self_check(check: &SelfCheck) -> Vec<Block> {
    let rows = [(Words::from(texts::VALUE), numbers_of(&check.parameters()).map(|value| Some(Number::exact(value))))];
    vec![heading(texts::SELF_CHECK), say([texts::SELF_CHECK_NOTE]), parameters(&rows).called(texts::SELF_CHECK)]
}

/// Writes the paper's equations, which differ between languages in one word only.
fn formulas(languages: &Languages) -> Markup {
    let [k, b, delta, c, wn] = ["K", "B", "Δ", "C", "ω_n"].map(written);
    let [j1, j2, j11, j12, j13, j14] = ["J_1", "J_2", "J_11", "J_12", "J_13", "J_14"].map(written);
    let [j21, j22, j23, j24, j] = ["J_21", "J_22", "J_23", "J_24", "J_ij"].map(written);
    let [wg, wk, w0, w, n2, n] = ["ω_g", "ω_k", "ω_0", "ω_3ij", "n_2", "n_ij"].map(written);
    let [w11, w12, w21, w22] = ["ω_n11", "ω_n12", "ω_n21", "ω_n22"].map(written);
    let (inverse, mean) = (html! { sup { "−1" } }, languages.cell(&texts::MEAN.into()));
    let formulas = [
        (11, html! { (j1) "\u{a0}=\u{a0}(" (j11) " − " (j13) ", " (j12) " − " (j14) ")" }),
        (11, html! { (j2) "\u{a0}=\u{a0}(" (j21) " − " (j23) ", " (j22) " − " (j24) ")" }),
        (13, html! { (k) "\u{a0}=\u{a0}" (b) " (" (j1) " − " (j2) " " (delta) ")" (inverse) }),
        (15, html! { (wn) "\u{a0}=\u{a0}" (c) " − " (k) " " (j2) " " (n2) (inverse) }),
        (16, html! { (wg) "\u{a0}=\u{a0}½ (" (w11) " + " (w22) "), " (wk) "\u{a0}=\u{a0}½ (" (w21) " − " (w12) ")" }),
        (8, html! { (w0) "\u{a0}=\u{a0}" (mean) " " (w) " − " (k) " " (j) " − " (wn) " " (n) }),
    ];
    html! { ul.formulas { @for (number, formula) in formulas { li { (formula) span.equation { "(" (number) ")" } } } } }
}

/// Returns the numbers of the eight parameters: K_x, K_y, K_xy, K_yx, ω_0x, ω_0y, ω_g, ω_k.
pub(super) fn numbers_of(parameters: &Parameters) -> [f64; 8] {
    let values = parameters.to_model().to_vector();
    Parameter::AS_IN_THE_PAPER.map(|parameter| values[parameter.place()])
}
