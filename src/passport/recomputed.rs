//! Recomputation of every number of a passport that follows from its inputs, and comparison with the stated ones.

use super::accuracy::Stated;
use super::content::{Content, Derived, REFERENCE_GYRO, SelfCheck, derive};
use crate::earth::{AZIMUTH_QUANTUM_DEG, LENGTH_QUANTUM_M};
use crate::text::{Field, Node, Path};
use std::collections::BTreeSet;

/// Largest allowed difference, relative to the largest element of each matrix, each set of vectors or each number.
pub(crate) const LIMIT: f64 = 1e-12;

/// Describes a number that does not follow from the passport's own inputs; `field` is its path, such as
/// `matrices.delta[0][1]`. A value that is not there is NaN.
fn wrong_number(field: &str, stated: f64, computed: f64) -> String {
    let [stated, computed] =
        [stated, computed].map(|value| if value.is_nan() { "nothing".to_owned() } else { format!("{value}") });
    format!("{field}: the passport states {stated}, its inputs give {computed}")
}

/// Compares Earth parameters, matrices, vectors, self-check and accuracy with the values computed from the signed
/// inputs.
///
/// Returns the wrong numbers in words, in the order of comparison; if there is nothing to compare with, the number that
/// is absent.
/// The self-check is computed for the gyro that it states. A passport may have none, because no calibration needs it.
pub(crate) fn compare(content: &Content) -> Vec<String> {
    let gyro = content.self_check.as_ref().map_or(REFERENCE_GYRO, SelfCheck::parameters);
    let Ok(mut derived) = derive(&content.positions, &content.site, &gyro) else {
        return vec![wrong_number("matrices.n2_inverse", f64::NAN, f64::NAN)];
    };
    if content.self_check.is_none() {
        derived.self_check = None;
    }
    let mut wrong = Vec::new();
    // If the same program computed both, every number is equal bit for bit.
    let same = content.earth == derived.earth
        && content.matrices == derived.matrices
        && content.vectors == derived.vectors
        && content.self_check == derived.self_check;
    if !same {
        compare_derived(content, &derived, &mut wrong);
    }
    // Consistent numbers are not enough: if the stated gyro is absurd, no software can recover its parameters.
    if let Some(self_check) = &content.self_check {
        let error = self_check.error(&content.coefficients());
        if error.is_nan() || error > SelfCheck::LIMIT {
            wrong.push(wrong_number("self_check (calibrated again, relative error)", 0.0, error));
        }
    }
    compare_accuracy(content, &mut wrong);
    wrong
}

/// Compares number by number, within the limits: each key of a matrix or of all positions relative to its own largest
/// element.
fn compare_derived(content: &Content, derived: &Derived, wrong: &mut Vec<String>) {
    let set = |field: &str| field.split('[').map(|part| part.split_once(']').map_or(part, |(_, key)| key)).collect();
    for (path, stated, computed) in [
        ("earth", content.earth.write(), derived.earth.write()),
        ("matrices", content.matrices.write(), derived.matrices.write()),
        ("self_check", content.self_check.write(), derived.self_check.write()),
        ("vectors", content.vectors.write(), derived.vectors.write()),
    ] {
        compare_numbers(&numbers(path, stated), &numbers(path, computed), set, wrong);
    }
}

/// Compares the expected calibration uncertainty, each number by itself.
fn compare_accuracy(content: &Content, wrong: &mut Vec<String>) {
    let Some(accuracy) = &content.accuracy else { return };
    let computed = Stated::of(accuracy).accuracy(&content.certificate, &content.positions, &content.site);
    let numbers = |node| numbers("accuracy.standard_uncertainty", node);
    let stated = numbers(accuracy.standard_uncertainty.write());
    let computed = numbers(computed.ok().and_then(|found| found.standard_uncertainty.write()));
    compare_numbers(&stated, &computed, str::to_owned, wrong);
}

/// Returns the step to which a number was rounded, because another platform's trigonometry may round it the other way.
fn quantum(field: &str) -> f64 {
    match field {
        "earth.valid_radius_m" => LENGTH_QUANTUM_M,
        "earth.azimuth_deg" => AZIMUTH_QUANTUM_DEG,
        "earth.azimuth_u_arcsec" => 1e-6,
        _ => 0.0,
    }
}

/// Returns all numbers of a node with their fields, in the order of the file.
fn numbers(path: &str, node: Option<Node>) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    node.unwrap_or(Node::Null).each_scalar(&Path::Root.key(path), &mut |at, scalar| match scalar {
        Node::Number(value) => found.push((at.to_string(), *value)),
        Node::Integer(value) => found.push((at.to_string(), *value as f64)),
        _ => {}
    });
    found
}

/// Compares numbers that stand in the same place of their set, relative to the largest of it; `set` names the set to which
/// a field belongs.
fn compare_numbers(
    stated: &[(String, f64)],
    computed: &[(String, f64)],
    set: impl Fn(&str) -> String,
    wrong: &mut Vec<String>,
) {
    let mut seen = BTreeSet::new();
    for name in stated.iter().chain(computed).map(|(field, _)| set(field)).filter(|name| seen.insert(name.clone())) {
        let of_set = |numbers: &[(String, f64)]| -> Vec<(String, f64)> {
            numbers.iter().filter(|(field, _)| set(field) == name).cloned().collect()
        };
        let (stated, computed) = (of_set(stated), of_set(computed));
        let largest = computed.iter().fold(0.0, |largest: f64, (_, value)| largest.max(value.abs()));
        // Allow 1.5 steps: neighbouring rounded values, plus their own binary64 rounding.
        let limit = (LIMIT * largest).max(1.5 * quantum(&name));
        for index in 0..stated.len().max(computed.len()) {
            let number = |numbers: &[(String, f64)]| numbers.get(index).map_or(f64::NAN, |(_, value)| *value);
            let (s, c) = (number(&stated), number(&computed));
            // Check that `c` is finite, because the limit would be infinite for an infinite number. A NaN fails every
            // comparison.
            let agrees = c.is_finite() && (s - c).abs() <= limit;
            if let Some((field, _)) = stated.get(index).or(computed.get(index)).filter(|_| !agrees) {
                wrong.push(wrong_number(field, s, c));
            }
        }
    }
}
