//! Places of a text where no line ends: numbers stay with their units, and short words with the words they belong to
//! (SI Brochure, 5.4.3; GOST 8.417, 5.3).

/// Non-breaking space.
pub(crate) const BLANK: char = '\u{00A0}';

/// Units that follow a number after a space; those that begin with ° are not listed.
const UNITS: [&str; 14] = ["%", "m", "km", "mA", "µA", "g", "m/s²", "м", "км", "мА", "мкА", "м/с²", "UTC", "{unit}"];

/// Words that a number follows.
const BEFORE_NUMBERS: [&str; 9] = ["No.", "eq.", "JCGM", "GOST", "ГОСТ", "WGS", "Figure", "Рисунок", "формула"];

/// Signs that stay with what is on either side of them.
const SIGNS: [&str; 6] = ["=", "≤", "≥", "<", ">", "·"];

/// Units of angles after a comma, as in the head of a column.
const MARKS_OF_ANGLES: [&str; 3] = ["°", "′", "″"];

/// Returns the text with a non-breaking space wherever a line must not end. Names in braces count as numbers.
pub(crate) fn spaced(text: &str) -> String {
    let words: Vec<&str> = text.split(' ').collect();
    let mut spaced = String::with_capacity(text.len() + 16);
    for (index, word) in words.iter().enumerate() {
        if index > 0 {
            spaced.push(if belong(words[index - 1], word) { BLANK } else { ' ' });
        }
        spaced.push_str(word);
    }
    spaced
}

/// Returns `true` if no line ends between two words.
fn belong(before: &str, after: &str) -> bool {
    let before = before.rsplit(BLANK).next().unwrap_or(before).trim_start_matches(['(', '«']);
    let first = after.split(BLANK).next().unwrap_or(after);
    let unit = first.trim_end_matches(['.', ',', ';', ':', ')']);
    let number = |c: char| c.is_ascii_digit() || "{(+−±".contains(c);
    let is_dash = matches!(first, "—" | "–");
    let is_unit = UNITS.contains(&unit) || unit.starts_with('°');
    is_dash
        || MARKS_OF_ANGLES.contains(&unit)
        || SIGNS.contains(&before)
        || SIGNS.contains(&first) && !before.ends_with([',', ';'])
        || is_unit && before.ends_with(|c: char| c.is_ascii_digit() || c == '}')
        || BEFORE_NUMBERS.contains(&before) && first.starts_with(number)
        || before == "№"
        || is_initial(before) && is_initial(first)
        || is_short_word(before)
        || is_axis(before.trim_end_matches(',')) && before.ends_with(',') && is_axis(unit)
}

/// Returns `true` for a capital letter with a point, as in «М. П.».
pub(crate) fn is_initial(word: &str) -> bool {
    let mut letters = word.chars();
    matches!((letters.next(), letters.next()), (Some(letter), Some('.')) if letter.is_uppercase())
}

/// Returns `true` for an axis, as in `x, y, z`.
fn is_axis(word: &str) -> bool {
    matches!(word, "x" | "y" | "z")
}

/// Returns `true` for a Russian word of one letter: a preposition or conjunction.
fn is_short_word(word: &str) -> bool {
    let mut letters = word.chars();
    matches!((letters.next(), letters.next()), (Some(letter), None) if "авикосуАВИКОСУ".contains(letter))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `_` is a non-breaking space. Expected: GOST 8.417-81, 5.3, SI Brochure, 5.4.3, and the rules of Russian
    /// typesetting for dashes, initials and one-letter words.
    #[test]
    fn lines_end_only_where_they_may() {
        for due in [
            "u_— неопределённость (k_=_1), в_осях x и_y",
            "М._П., №_сертификата, №_{serial}, No._{serial}, Рисунок_1. Стенд",
            "от_{low} до 22_°C, {g}_°/(ч·g), 95_%. Все 5_м/с²",
            "the 5_mA of position {index} in {unit}: {u}_{unit}, < {limit}",
            "JCGM_106, 8.3; eq._(4) to_(5), p_≤_0.05",
            "relative to the mean,_″; θ,_°",
            "about x,_y,_z of the platform: x, then y",
            "a table of A and B, o and O",
        ] {
            let due = due.replace("от_", "от ").replace("to_(", "to (").replace("< {", "<_{").replace('_', "\u{a0}");
            assert_eq!(spaced(&due.replace(BLANK, " ")), due);
            assert_eq!(spaced(&due), due);
        }
    }
}
