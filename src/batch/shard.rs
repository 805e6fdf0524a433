//! Division of a job into equal parts, for machines that share nothing but the folder.

use sha2::{Digest, Sha256};
use std::str::FromStr;

/// Part `number` of `parts` of a job.
///
/// The part of a passport depends only on its stand, so that one machine writes its register. The parts are therefore
/// disjoint and together complete, on any machine and in any order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    number: u32,
    parts: u32,
}

impl FromStr for Shard {
    /// Says what is wrong with the specification of a part.
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once('/').and_then(|(number, parts)| Some((number.parse().ok()?, parts.parse().ok()?)));
        let (number, all): (u64, u64) = numbers.ok_or("expected K/N, the K-th of N parts, as in 2/8")?;
        let parts = u32::try_from(all).ok().filter(|&parts| parts > 0);
        let parts = parts.ok_or_else(|| format!("found {all} parts, expected 1 to 4294967295"))?;
        match u32::try_from(number) {
            Ok(number @ 1..) if number <= parts => Ok(Self { number, parts }),
            _ => Err(format!("found part {number} of {parts}, expected 1 to {parts}")),
        }
    }
}

impl Shard {
    pub(crate) const WHOLE: Self = Self { number: 1, parts: 1 };

    /// Returns `true` if a stand, `<model>/<serial>`, is in this part, with all of its passports and its register: if the
    /// first eight bytes of its SHA-256, modulo the number of parts, give this part.
    pub(crate) fn has(self, stand: &str) -> bool {
        let hash = Sha256::digest(stand.as_bytes());
        let first = hash.iter().take(8).fold(0_u64, |number, &byte| number << 8 | u64::from(byte));
        first % u64::from(self.parts) + 1 == u64::from(self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_depends_on_the_name_alone_for_ever() {
        // printf SPS-2/0017 | sha256sum | cut -c1-16, modulo 4: computed with sha256sum and bc.
        let part = (1..=4).find(|number| format!("{number}/4").parse::<Shard>().unwrap().has("SPS-2/0017"));
        assert_eq!(part, Some(1));
    }

    #[test]
    fn what_is_no_part_is_refused_in_words() {
        for (text, words) in [
            ("5/4", "found part 5 of 4, expected 1 to 4"),
            ("0/4", "found part 0 of 4, expected 1 to 4"),
            ("1/0", "found 0 parts, expected 1 to 4294967295"),
            ("1/9999999999", "found 9999999999 parts, expected 1 to 4294967295"),
            ("9999999999/4", "found part 9999999999 of 4, expected 1 to 4"),
            ("3", "expected K/N, the K-th of N parts, as in 2/8"),
            ("a/b", "expected K/N, the K-th of N parts, as in 2/8"),
            ("-1/4", "expected K/N, the K-th of N parts, as in 2/8"),
            ("1/4/2", "expected K/N, the K-th of N parts, as in 2/8"),
        ] {
            assert_eq!(text.parse::<Shard>().unwrap_err(), words);
        }
    }
}
