//! Numbers that a calibration uses: matrices, vectors, the self-check.

use super::PassportPage;
use crate::calibration::parameter::Parameter;
use crate::gyro::Parameters;
use crate::passport::Content;
use crate::passport::content::{MatrixRows, Rows, SelfCheck};
use crate::report::page::language::{Languages, Text, values};
use crate::report::page::number::{Cell, Number, column};
use crate::report::page::parts::{Column, Table, figure, heading, starts, symbol, symbol_and_unit};
use crate::report::page::symbols::italic;
use crate::report::page::texts::{passport as texts, units};
use crate::report::picture::vectors::vectors as picture;
use maud::{Markup, html};

/// Paper from which the equations are numbered.
const PAPER: &str = "doi:10.18698/2308-6033-2017-10-1691";

/// Decimals of numbers without an uncertainty: 1e-9 °/h and 1e-9 g are far below the resolution of any reading.
pub(crate) const DECIMALS: usize = 9;

pub(crate) fn section(page: &PassportPage, languages: &Languages) -> Markup {
    let content = &page.content;
    html! {
        (languages.paragraph_with(|language| {
            let equations = texts::EQUATIONS_NOTE.filled(language, values! { source: PAPER });
            italic(&format!("{} {equations}", texts::DIGITS_NOTE.words(language)))
        }))
        @match &content.matrices {
            Some(m) => {
                (matrices(m, languages))
                (languages.paragraph(texts::FORMULAS))
                (formulas(languages))
            }
            None => (languages.paragraph(texts::NO_MATRICES)),
        }
        (heading(languages, texts::VECTORS))
        (vectors(content, languages))
        (figure(languages, "vectors", &picture(languages, content), texts::FIGURE_VECTORS))
        @if let Some(check) = &content.self_check {
            (heading(languages, texts::SELF_CHECK))
            (languages.paragraph(texts::SELF_CHECK_NOTE))
            (self_check(check, languages))
        }
    }
}

fn numbers(languages: &Languages, values: &[Option<f64>]) -> Vec<Markup> {
    column(languages, values.iter().map(|value| value.map(|value| Number::fixed(value, DECIMALS))))
}

fn matrices(m: &MatrixRows, languages: &Languages) -> Markup {
    let row = |name: Markup, unit: Text, [[a, b], [c, d]]: &Rows| {
        let cells = numbers(languages, &[Some(*a), Some(*b), Some(*c), Some(*d)]);
        [name, languages.inline(unit)].into_iter().chain(cells).collect()
    };
    let inverse = html! { (symbol("n", "2")) sup { "−1" } };
    let rows = vec![
        row(symbol("Δ", ""), units::ONE, &m.delta),
        row(symbol("B", ""), units::DEG_PER_H, &m.b_deg_per_h),
        row(symbol("C", ""), units::DEG_PER_H_PER_G, &m.c_deg_per_h_per_g),
        row(symbol("n", "1"), units::G, &m.n1),
        row(symbol("n", "2"), units::G, &m.n2),
        row(inverse, units::PER_G, &m.n2_inverse),
        row(symbol("ω", "31"), units::DEG_PER_H, &m.omega1_deg_per_h),
        row(symbol("ω", "32"), units::DEG_PER_H, &m.omega2_deg_per_h),
    ];
    let mut headings = vec![languages.label(texts::MATRIX), languages.label(texts::UNIT)];
    headings.extend(["11", "12", "21", "22"].map(|place| html! { (place) }));
    let table = Table { headings, rows, row_headings: 1, class: "numbers with-unit", ..Table::default() };
    table.captioned(languages, texts::MATRICES_CAPTION)
}

/// Writes the paper's equations, which differ between languages in one word only.
fn formulas(languages: &Languages) -> Markup {
    let (k, b, delta) = (symbol("K", ""), symbol("B", ""), symbol("Δ", ""));
    let j = |index| symbol("J", index);
    let (j1, j2) = (j("1"), j("2"));
    let wn = symbol("ω", "n");
    let inverse = html! { sup { "−1" } };
    html! {
        ul.formulas {
            li { (j1) "\u{a0}=\u{a0}(" (j("11")) " − " (j("13")) ", " (j("12")) " − " (j("14")) ")" span.equation { "(11)" } }
            li { (j2) "\u{a0}=\u{a0}(" (j("21")) " − " (j("23")) ", " (j("22")) " − " (j("24")) ")" span.equation { "(11)" } }
            li { (k) "\u{a0}=\u{a0}" (b) " (" (j1) " − " (j2) " " (delta) ")" (inverse) span.equation { "(13)" } }
            li { (wn) "\u{a0}=\u{a0}" (symbol("C", "")) " − " (k) " " (j2) " " (symbol("n", "2")) (inverse) span.equation { "(15)" } }
            li { (symbol("ω", "g")) "\u{a0}=\u{a0}½ (" (symbol("ω", "n11")) " + " (symbol("ω", "n22")) "), "
                (symbol("ω", "k")) "\u{a0}=\u{a0}½ (" (symbol("ω", "n21")) " − " (symbol("ω", "n12")) ")" span.equation { "(16)" } }
            li { (symbol("ω", "0")) "\u{a0}=\u{a0}" (languages.inline(texts::MEAN)) " " (symbol("ω", "3ij")) " − " (k) " "
                (j("ij")) " − " (wn) " " (symbol("n", "ij")) span.equation { "(8)" } }
        }
    }
}

fn vectors(content: &Content, languages: &Languages) -> Markup {
    let currents = content.self_check.as_ref().map(|check| &check.currents);
    let starts = starts(content.vectors.iter().map(|at| at.i));
    let rows = content.vectors.iter().map(|at| {
        let [nx, ny] = at.specific_force_g;
        let [wx, wy] = at.omega_deg_per_h;
        let mut values = vec![Some(nx), Some(ny), Some(at.specific_force_z_g), Some(wx), Some(wy)];
        if let Some(currents) = currents {
            let found = currents.iter().find(|current| (current.i, current.j) == (at.i, at.j));
            values.extend([found.map(|current| current.jx_ma), found.map(|current| current.jy_ma)]);
        }
        let index = [html! { (at.i) }, html! { (at.j) }];
        index.into_iter().chain(numbers(languages, &values)).collect()
    });
    let unit = |symbol: Markup, unit| symbol_and_unit(languages, &symbol, unit);
    let mut headings = vec![symbol("i", ""), symbol("j", "")];
    headings.extend(["x", "y", "z"].map(|axis| unit(symbol("n", axis), units::G)));
    headings.extend(["3x", "3y"].map(|index| unit(symbol("ω", index), units::DEG_PER_H)));
    if currents.is_some() {
        headings.extend(["x", "y"].map(|axis| unit(symbol("J", axis), units::MILLIAMPERES)));
    }
    let caption = if currents.is_some() { texts::VECTORS_CAPTION } else { texts::VECTORS_ALONE_CAPTION };
    let rows = rows.collect();
    let table = Table { headings, rows, starts, row_headings: 2, class: "numbers", ..Table::default() };
    table.captioned(languages, caption)
}

fn self_check(check: &SelfCheck, languages: &Languages) -> Markup {
    let values = numbers_of(&check.parameters()).map(|value| Cell::Number(Number::exact(value)));
    let rows = vec![(languages.label(texts::VALUE), values)];
    parameters(languages, rows).markup(languages.spoken(texts::SELF_CHECK))
}

/// Returns a table of the eight parameters of a gyro in the paper's groups, one row for each quantity. Cells have the
/// order of [`numbers_of`]. A group without any number is omitted: the general model has no ω_g and ω_k.
pub(crate) fn parameters(languages: &Languages, rows: Vec<(Markup, [Cell; 8])>) -> Table {
    let symbols = [("K", "x"), ("K", "y"), ("K", "xy"), ("K", "yx"), ("ω", "0x"), ("ω", "0y"), ("ω", "g"), ("ω", "k")];
    let is_number = |place: usize| rows.iter().any(|(_, cells)| matches!(cells[place], Cell::Number(_)));
    let shown = |group: &usize| is_number(2 * group) || is_number(2 * group + 1);
    let shown: Vec<usize> = (0..4).filter(shown).collect();
    let places = shown.iter().flat_map(|group| [2 * group, 2 * group + 1]);
    let columns = places.map(|place| {
        let (letter, subscript) = symbols[place];
        let cells = rows.iter().map(|(_, cells)| cells[place].clone());
        Column::new(symbol(letter, subscript), column(languages, cells))
    });
    let columns: Vec<Column> = columns.collect();
    let groups = [
        (texts::SCALE_FACTORS_MAIN, units::DEG_PER_H_PER_MA),
        (texts::SCALE_FACTORS_CROSS, units::DEG_PER_H_PER_MA),
        (texts::DRIFT_CONSTANT, units::DEG_PER_H),
        (texts::DRIFT_G, units::DEG_PER_H_PER_G),
    ];
    let groups = shown.iter().map(|group| {
        let (name, unit) = groups[*group];
        (2, languages.label_with(|language| format!("{}, {}", name.words(language), unit.of(language))))
    });
    let groups = groups.collect();
    let names = rows.into_iter().map(|(name, _)| vec![name]).collect();
    Table { groups, class: "numbers parameters", ..Table::of(vec![html! {}], names, &columns) }
}

/// Returns the numbers of the eight parameters: K_x, K_y, K_xy, K_yx, ω_0x, ω_0y, ω_g, ω_k.
pub(crate) fn numbers_of(parameters: &Parameters) -> [f64; 8] {
    let values = parameters.to_model().to_vector();
    Parameter::AS_IN_THE_PAPER.map(|parameter| values[parameter.place()])
}
