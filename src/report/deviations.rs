//! Certified deviations: their numbers as on pages, and a chart in block characters, with sign and size of α, β, γ at each
//! position on a common scale.

use super::page::number::{LARGEST_IN_ARCSEC, Number};
use super::{Language, columns, style};
use crate::stand::CertifiedPosition;
use crate::wording::plain;
use std::fmt::Write;

/// Largest number of characters of a bar on each side of the axis; each character is two halves.
const SIDE: usize = 14;

/// Smallest number of characters for which a bar shows anything.
const LEAST_SIDE: usize = 4;

/// Returns the headings of α, β, γ and their uncertainties, and the cells of each position. If one angle has degrees and
/// minutes, every cell has its mark, and the headings have no unit.
pub(crate) fn columns(positions: &[CertifiedPosition]) -> ([&'static str; 6], Vec<Vec<String>>) {
    let large =
        positions.iter().flat_map(CertifiedPosition::angles_arcsec).any(|angle| angle.abs() > LARGEST_IN_ARCSEC);
    let mark = if large { "″" } else { "" };
    let cells = positions.iter().map(|at| {
        let both = at.angles_arcsec().into_iter().zip(at.u_arcsec()).flat_map(|(arcsec, u)| {
            let words = u.map_or_else(|| "-".to_owned(), |u| format!("{u:.0$}{mark}", columns::decimals(u)));
            [angle(arcsec, u) + mark, words]
        });
        both.collect()
    });
    let headings =
        if large { ["α", "u", "β", "u", "γ", "u"] } else { ["α, ″", "u", "β, ″", "u", "γ, ″", "u"] };
    (headings, cells.collect())
}

/// Formats an angle as pages do, to the digits of its uncertainty and above 600″ with degrees and minutes, but in the
/// characters of a terminal's numbers.
fn angle(arcsec: f64, u: Option<f64>) -> String {
    plain(&Number::angle(arcsec, u.unwrap_or(0.0)).text(Language::English))
}

/// Appends a line for every position with a bar for each of α, β, γ, all to one scale; nothing if the terminal has no
/// room for bars.
pub(crate) fn picture(out: &mut String, positions: &[CertifiedPosition]) {
    let largest = positions
        .iter()
        .flat_map(CertifiedPosition::angles_arcsec)
        .fold(0.0, |largest: f64, angle| largest.max(angle.abs()));
    // Beside the bars a line has the indices, three axes and two gaps.
    let side = (columns::width().saturating_sub(8 + 3 + 4) / 6).min(SIDE);
    if largest == 0.0 || side < LEAST_SIDE {
        return;
    }
    let names = ["α", "β", "γ"].map(|name| format!("{name:^width$}", width = 2 * side + 1));
    let _ = writeln!(out, "{}", style::faint(format!("  i  j  {}", names.join("  ")).trim_end()));
    for at in positions {
        let bars = at.angles_arcsec().map(|angle| bar(angle / largest, side));
        let _ = writeln!(out, "{}", format!("{:>3}{:>3}  {}", at.i, at.j, bars.join("  ")).trim_end());
    }
    let _ = writeln!(out, "  the longest bar is {}″; bars to the left are negative", angle(largest, None));
}

/// Returns a bar for a value from -1 to 1, around the axis in its middle, with `side` characters on each side.
fn bar(part: f64, side: usize) -> String {
    let halves = (part.abs() * (2 * side) as f64).round() as usize;
    let whole = "█".repeat(halves / 2);
    let half = |character| if halves % 2 == 1 { character } else { "" };
    let (left, right) = match part < 0.0 {
        true => (format!("{}{whole}", half("▐")), String::new()),
        false => (String::new(), format!("{whole}{}", half("▌"))),
    };
    format!("{left:>side$}│{right:<side$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 4405 = 3600 + 13 · 60 + 25.
    #[test]
    fn a_large_angle_has_degrees_and_minutes() {
        assert_eq!(angle(-4405.0, Some(5.0)), "-1°13′25.0");
        assert_eq!(angle(-599.96, Some(1.2)), "-600.0");
        assert_eq!(angle(12.4, None), "12.4");
    }

    #[test]
    fn a_bar_is_as_long_as_its_part() {
        let blank = " ".repeat(SIDE);
        assert_eq!(bar(0.0, SIDE), format!("{blank}│{blank}"));
        assert_eq!(bar(1.0, SIDE), format!("{blank}│{}", "█".repeat(SIDE)));
        assert_eq!(bar(-1.0, SIDE), format!("{}│{blank}", "█".repeat(SIDE)));
        // 0.35 of 28 halves is 9.8, five blocks; 0.32 is 8.96, four and a half.
        assert_eq!(bar(-0.35, SIDE).trim(), "█████│");
        assert_eq!(bar(0.32, SIDE).trim(), "│████▌");
        assert_eq!(bar(-0.32, SIDE).trim(), "▐████│");
    }
}
