//! One of several equal parts of a job, for machines that share nothing but the folder.

use sha2::{Digest, Sha256};
use std::path::Path;
use std::str::FromStr;

/// Part `number` of `parts`. Which part a passport is in follows from its stand and site alone: the parts have nothing
/// in common, and together they are the whole, on whatever machine and in whatever order each is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    number: u32,
    parts: u32,
}

/// What is no part.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoShard {
    /// Not two whole numbers.
    #[error("expected K/N, the K-th of N parts, as in 2/8")]
    Form,
    /// More parts than anybody has machines, or none.
    #[error("found {0} parts, expected 1 to 4294967295")]
    Parts(u64),
    /// A part that the whole has not.
    #[error("found part {number} of {parts}, expected 1 to {parts}")]
    Number {
        /// The part asked for.
        number: u64,
        /// How many there are.
        parts: u32,
    },
}

impl FromStr for Shard {
    type Err = NoShard;

    fn from_str(text: &str) -> Result<Self, NoShard> {
        let (number, parts) = text.split_once('/').ok_or(NoShard::Form)?;
        let number: u64 = number.parse().map_err(|_| NoShard::Form)?;
        let parts: u64 = parts.parse().map_err(|_| NoShard::Form)?;
        let parts = u32::try_from(parts).ok().filter(|&parts| parts > 0).ok_or(NoShard::Parts(parts))?;
        match u32::try_from(number) {
            Ok(number @ 1..) if number <= parts => Ok(Self { number, parts }),
            _ => Err(NoShard::Number { number, parts }),
        }
    }
}

impl Shard {
    /// The whole job.
    pub(crate) const WHOLE: Self = Self { number: 1, parts: 1 };

    /// How many of `orders` are about to be in this part.
    pub(crate) fn share(self, orders: u64) -> u64 {
        orders.div_ceil(u64::from(self.parts))
    }

    /// Whether the passports of a stand (`<model>/<serial>`) for a site are in this part.
    pub(crate) fn has(self, stand: &str, site: &str) -> bool {
        self.parts == 1 || self.has_key(&format!("{stand}/{site}"))
    }

    /// Whether a passport's file is in this part, by where it stands: `<model>/<serial>/<site>-<revision>.yaml`.
    pub(crate) fn has_file(self, path: &Path) -> bool {
        if self.parts == 1 {
            return true;
        }
        // Whoever runs it elsewhere may name the same file from another folder.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let mut names: Vec<_> = path.iter().rev().take(3).map(|name| name.to_string_lossy()).collect();
        names.reverse();
        let name = names.join("/");
        self.has_key(name.rsplit_once('-').map_or(name.as_str(), |(site, _revision)| site))
    }

    /// The first eight bytes of its SHA-256, modulo the number of parts.
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
            for site in 0..3000 {
                let (stand, site) = ("SPS-2/0017", format!("site-{site}"));
                let having: Vec<usize> = (0..shards.len()).filter(|&index| shards[index].has(stand, &site)).collect();
                assert_eq!(having.len(), 1);
                sizes[having[0]] += 1;
                // By its file a passport of any revision is in the same part.
                let file = format!("any/where/{stand}/{site}-12.yaml");
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
        // printf SPS-2/0017/here | sha256sum | cut -c1-16, modulo 4: computed with sha256sum and bc.
        let part = (1..=4).find(|number| format!("{number}/4").parse::<Shard>().unwrap().has("SPS-2/0017", "here"));
        assert_eq!(part, Some(3));
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
            assert_eq!(text.parse::<Shard>().unwrap_err().to_string(), words);
        }
    }
}
