//! Certified deviations as a chart in block characters, with sign and size of α, β, γ at each position on a common scale.

use crate::report::doc::{Block, On, say};
use crate::report::page::Number;
use crate::report::{columns, style};
use crate::stand::CertifiedPosition;
use crate::wording::texts::passport as texts;
use std::fmt::Write;

/// Largest number of characters of a bar on each side of the axis; each character is two halves.
const SIDE: usize = 14;

/// Smallest number of characters for which a bar shows anything.
const LEAST_SIDE: usize = 4;

/// A line for every position with a bar for each of α, β, γ, all to one scale; nothing if the terminal has no room for bars.
pub(super) fn chart(positions: &[CertifiedPosition]) -> Vec<Block> {
    let largest = positions
        .iter()
        .flat_map(CertifiedPosition::angles_arcsec)
        .fold(0.0, |largest: f64, angle| largest.max(angle.abs()));
    // Beside the bars a line has the indices, three axes and two gaps.
    let side = (columns::width().saturating_sub(8 + 3 + 4) / 6).min(SIDE);
    if largest == 0.0 || side < LEAST_SIDE {
        return Vec::new();
    }
    let mut out = String::new();
    let names = ["α", "β", "γ"].map(|name| format!("{name:^width$}", width = 2 * side + 1));
    let _ = writeln!(out, "{}", style::faint(format!("  i  j  {}", names.join("  ")).trim_end()));
    for at in positions {
        let bars = at.angles_arcsec().map(|angle| bar(angle / largest, side));
        let _ = writeln!(out, "{}", format!("{:>3}{:>3}  {}", at.i, at.j, bars.join("  ")).trim_end());
    }
    vec![Block::Typed(out), say([texts::longest_bar(Number::angle(largest, 0.0))]).only(On::Terminal)]
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
