//! Recomputation of every number of a passport that follows from its inputs, and comparison with the stated ones.

use super::accuracy::Stated;
use super::content::{Content, Derived, PositionCurrents, PositionVectors, REFERENCE_GYRO, SelfCheck, derive};
use crate::earth::{AZIMUTH_QUANTUM_DEG, LENGTH_QUANTUM_M};
use crate::text::{Field, Node};

/// Largest allowed difference, relative to the largest element of each matrix, each set of vectors or each number.
pub(crate) const LIMIT: f64 = 1e-12;

/// A number that does not follow from the passport's own inputs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WrongNumber {
    /// Path of the field, such as `matrices.delta[0][1]`.
    pub field: String,
    /// Value that the passport states; NaN if it states none.
    pub stated: f64,
    /// Value computed from the inputs; NaN if there is none.
    pub computed: f64,
}

impl std::fmt::Display for WrongNumber {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let words = |value: f64| if value.is_nan() { "nothing".to_owned() } else { format!("{value}") };
        let (stated, computed) = (words(self.stated), words(self.computed));
        write!(f, "{}: the passport states {stated}, its inputs give {computed}", self.field)
    }
}

/// Compares Earth parameters, matrices, vectors, self-check and accuracy with the values computed from the signed
/// inputs.
///
/// The self-check is computed for the gyro that it states. A passport may have none, because no calibration needs it.
///
/// # Errors
/// Returns the wrong numbers in the order of comparison, or the reason why there is nothing to compare with.
pub(crate) fn compare(content: &Content) -> Result<(), Vec<WrongNumber>> {
    let gyro = content.self_check.as_ref().map_or(REFERENCE_GYRO, SelfCheck::parameters);
    let Ok(mut derived) = derive(&content.positions, &content.site, &gyro) else {
        let field = "matrices.n2_inverse".to_owned();
        return Err(vec![WrongNumber { field, stated: f64::NAN, computed: f64::NAN }]);
    };
    if content.self_check.is_none() {
        derived.self_check = None;
    }
    let mut wrong = Vec::new();
    if !states_the_same(content, &derived) {
        compare_derived(content, &derived, &mut wrong);
    }
    // Consistent numbers are not enough: if the stated gyro is absurd, no software can recover its parameters.
    if let Some(self_check) = &content.self_check {
        let error = self_check.error(&content.coefficients());
        if error.is_nan() || error > SelfCheck::LIMIT {
            let field = "self_check (calibrated again, relative error)".to_owned();
            wrong.push(WrongNumber { field, stated: 0.0, computed: error });
        }
    }
    compare_accuracy(content, &mut wrong);
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// Returns `true` if every number equals the computed one bit for bit, as it does if the same program computed both.
fn states_the_same(content: &Content, derived: &Derived) -> bool {
    content.earth == derived.earth
        && content.matrices == derived.matrices
        && content.vectors == derived.vectors
        && content.self_check == derived.self_check
}

/// Compares number by number, within the limits.
fn compare_derived(content: &Content, derived: &Derived, wrong: &mut Vec<WrongNumber>) {
    for (key, stated, computed) in [
        ("earth", content.earth.write(), derived.earth.write()),
        ("matrices", content.matrices.write(), derived.matrices.write()),
        ("self_check", parameters(&content.self_check), parameters(&derived.self_check)),
    ] {
        compare_entries(key, &stated, &computed, wrong);
    }
    let currents = |check: &Option<SelfCheck>| check.as_ref().map_or_else(Vec::new, |check| check.currents.clone());
    let (stated, computed) = (currents(&content.self_check), currents(&derived.self_check));
    compare_sets("self_check.currents", &stated, &computed, &CURRENTS, wrong);
    compare_sets("vectors", &content.vectors, &derived.vectors, &VECTORS, wrong);
}

/// Compares the expected calibration uncertainty, each number by itself.
fn compare_accuracy(content: &Content, wrong: &mut Vec<WrongNumber>) {
    let Some(accuracy) = &content.accuracy else { return };
    let computed = Stated::of(accuracy).accuracy(&content.certificate, &content.positions, &content.site);
    let numbers = |node: Option<Node>| {
        let mut numbers = Vec::new();
        if let Some(node) = node {
            collect(&node, "accuracy.standard_uncertainty", &mut numbers);
        }
        numbers
    };
    let stated = numbers(accuracy.standard_uncertainty.write());
    let computed = numbers(computed.ok().and_then(|found| found.standard_uncertainty.write()));
    for (index, number) in stated.iter().enumerate() {
        let computed = computed.get(index).map_or(&[][..], std::slice::from_ref);
        compare_numbers(std::slice::from_ref(number), computed, 0.0, wrong);
    }
}

/// Compares the values of two mappings key by key, each value relative to its own largest element.
fn compare_entries(path: &str, stated: &Option<Node>, computed: &Option<Node>, wrong: &mut Vec<WrongNumber>) {
    let entries = |node: &Option<Node>| match node {
        Some(Node::Map(entries)) => entries.clone(),
        _ => Vec::new(),
    };
    let (stated, computed) = (entries(stated), entries(computed));
    let keys = stated.iter().chain(&computed).map(|(key, _)| key);
    let mut seen: Vec<&String> = Vec::new();
    for key in keys {
        if seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let numbers = |entries: &[(String, Node)]| {
            let mut numbers = Vec::new();
            if let Some((_, node)) = entries.iter().find(|(name, _)| name == key) {
                collect(node, &format!("{path}.{key}"), &mut numbers);
            }
            numbers
        };
        compare_numbers(&numbers(&stated), &numbers(&computed), quantum(key), wrong);
    }
}

/// Returns the step to which a number was rounded, because another platform's trigonometry may round it the other way.
fn quantum(key: &str) -> f64 {
    match key {
        "valid_radius_m" => LENGTH_QUANTUM_M,
        "azimuth_deg" => AZIMUTH_QUANTUM_DEG,
        "azimuth_u_arcsec" => 1e-6,
        _ => 0.0,
    }
}

fn collect(node: &Node, path: &str, numbers: &mut Vec<(String, f64)>) {
    match node {
        Node::Number(value) => numbers.push((path.to_owned(), *value)),
        Node::Integer(value) => numbers.push((path.to_owned(), *value as f64)),
        Node::List(items) => {
            for (index, item) in items.iter().enumerate() {
                collect(item, &format!("{path}[{index}]"), numbers);
            }
        }
        Node::Map(entries) => {
            for (key, value) in entries {
                collect(value, &format!("{path}.{key}"), numbers);
            }
        }
        _ => {}
    }
}

/// Returns the parameters of a self-check; its currents are compared as a set of vectors.
fn parameters(self_check: &Option<SelfCheck>) -> Option<Node> {
    self_check.as_ref().and_then(|check| check.parameters().write())
}

/// Numbers of a position that are compared together, relative to the largest of them in any position.
type Set<T> = (&'static str, fn(&T) -> Vec<f64>);

/// Sets of numbers in the vectors: specific forces, Earth rates, and the indices, which may be large.
const VECTORS: [Set<PositionVectors>; 4] = [
    ("i, j", |at| vec![f64::from(at.i), f64::from(at.j)]),
    ("specific_force_g", |at| at.specific_force_g.to_vec()),
    ("specific_force_z_g", |at| vec![at.specific_force_z_g]),
    ("omega_deg_per_h", |at| at.omega_deg_per_h.to_vec()),
];

/// Sets of numbers in the currents of the self-check: one for each axis, because their sizes may differ.
const CURRENTS: [Set<PositionCurrents>; 3] = [
    ("i, j", |at| vec![f64::from(at.i), f64::from(at.j)]),
    ("jx_ma", |at| vec![at.jx_ma]),
    ("jy_ma", |at| vec![at.jy_ma]),
];

fn compare_sets<T>(path: &str, stated: &[T], computed: &[T], sets: &[Set<T>], wrong: &mut Vec<WrongNumber>) {
    for (key, of) in sets {
        let numbers = |positions: &[T]| -> Vec<(String, f64)> {
            let each = positions.iter().enumerate();
            each.flat_map(|(index, at)| of(at).into_iter().map(move |x| (format!("{path}[{index}].{key}"), x)))
                .collect()
        };
        compare_numbers(&numbers(stated), &numbers(computed), 0.0, wrong);
    }
}

fn compare_numbers(stated: &[(String, f64)], computed: &[(String, f64)], quantum: f64, wrong: &mut Vec<WrongNumber>) {
    let largest = computed.iter().fold(0.0, |largest: f64, (_, value)| largest.max(value.abs()));
    // Allow 1.5 steps: neighbouring rounded values, plus their own binary64 rounding.
    let limit = (LIMIT * largest).max(1.5 * quantum);
    for index in 0..stated.len().max(computed.len()) {
        let number = |numbers: &[(String, f64)]| numbers.get(index).map_or(f64::NAN, |(_, value)| *value);
        let (s, c) = (number(stated), number(computed));
        // Check that `c` is finite, because the limit would be infinite for an infinite number. A NaN fails every
        // comparison.
        let agrees = c.is_finite() && (s - c).abs() <= limit;
        if !agrees {
            let field = stated.get(index).or(computed.get(index)).map(|(field, _)| field.clone()).unwrap_or_default();
            wrong.push(WrongNumber { field, stated: s, computed: c });
        }
    }
}
