//! Division of a job into equal parts, for machines that share nothing but the folder.

use sha2::{Digest, Sha256};
use std::path::Path;
use std::str::FromStr;

/// Part `number` of `parts` of a job.
///
/// The part of a passport depends only on its stand, so that one machine writes its register. The parts are therefore disjoint and together complete,
/// on any machine and in any order.
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

    /// Returns the approximate number of `orders` in this part.
    pub(crate) fn share(self, orders: u64) -> u64 {
        orders.div_ceil(u64::from(self.parts))
    }

    /// Returns `true` if a stand, `<model>/<serial>`, is in this part, with all of its passports and its register.
    pub(crate) fn has(self, stand: &str) -> bool {
        self.parts == 1 || self.has_key(stand)
    }

    /// Returns `true` if a passport's file is in this part, by its path `<model>/<serial>/<site>-<revision>.yaml`.
    pub(crate) fn has_file(self, path: &Path) -> bool {
        if self.parts == 1 {
            return true;
        }
        // On another machine the same file may be given relative to another folder.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let mut names: Vec<_> = path.iter().rev().skip(1).take(2).map(|name| name.to_string_lossy()).collect();
        names.reverse();
        self.has_key(&names.join("/"))
    }

    /// Returns `true` if the first eight bytes of the key's SHA-256, modulo the number of parts, give this part.
    fn has_key(self, key: &str) -> bool {
        let hash = Sha256::digest(key.as_bytes());
        let first = hash.iter().take(8).fold(0_u64, |number, &byte| number << 8 | u64::from(byte));
        first % u64::from(self.parts) + 1 == u64::from(self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_are_disjoint_and_complete_and_about_equal() {
        for parts in [1, 2, 3, 7] {
            let shards: Vec<Shard> = (1..=parts).map(|number| format!("{number}/{parts}").parse().unwrap()).collect();
            let mut sizes = vec![0; shards.len()];
            for serial in 0..3000 {
                let stand = format!("SPS-2/{serial:04}");
                let having: Vec<usize> = (0..shards.len()).filter(|&index| shards[index].has(&stand)).collect();
                assert_eq!(having.len(), 1);
                sizes[having[0]] += 1;
                // Files of all revisions of a passport are in the same part.
                let file = format!("any/where/{stand}/here-12.yaml");
                assert!(shards[having[0]].has_file(Path::new(&file)));
            }
            let even = 3000 / sizes.len();
            // Five standard deviations of a binomial.
            let off = 5.0 * (even as f64).sqrt();
            assert!(sizes.iter().all(|&size| (size as f64 - even as f64).abs() <= off), "{sizes:?}");
        }
    }

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
