//! The name that a misspelt one means.

use std::fmt::Display;

/// Jaro-Winkler similarity from which an unknown key is taken for a misspelt known one.
const ALIKE: f64 = 0.85;

/// Returns the known key that is most like an unknown one, above all in its beginning; `None` if none is.
pub(crate) fn key<'a>(known: &[&'a str], unknown: &str) -> Option<&'a str> {
    let alike = |known: &str| strsim::jaro_winkler(known, unknown);
    let nearest = known.iter().copied().max_by(|one, other| alike(one).total_cmp(&alike(other)));
    nearest.filter(|nearest| alike(nearest) > ALIKE)
}

/// Returns the name nearest to an unknown one, the first of equally near ones; `None` if each differs from it in more than
/// `most` letters, or in all of its own. Capitals count as small letters.
pub(crate) fn name<T: AsRef<str>>(names: impl IntoIterator<Item = T>, unknown: &str, most: usize) -> Option<T> {
    let unknown = unknown.to_lowercase();
    let with_distance = names.into_iter().map(|name| {
        let lower = name.as_ref().to_lowercase();
        (strsim::damerau_levenshtein(&lower, &unknown), lower.chars().count(), name)
    });
    let near = with_distance.filter(|(distance, length, _)| *distance <= most && distance < length);
    near.min_by_key(|(distance, ..)| *distance).map(|(.., name)| name)
}

/// Returns the question whether a name is meant.
pub(crate) fn question(name: impl Display) -> String {
    format!("did you mean {name}?")
}
