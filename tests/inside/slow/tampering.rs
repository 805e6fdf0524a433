//! Whoever has no key changes a passport: each byte, each bit, each line, each length. Nothing may be accepted.

use crate::inside::{fixtures, written};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::trust::SigningKey;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A passport that is good, and the means to say so.
struct Bench {
    name: &'static str,
    good: Vec<u8>,
    trust: Trust,
    question: Question,
}

impl Bench {
    fn new(name: &'static str, stand: &str) -> Self {
        let key = SigningKey::generate().unwrap();
        let content = fixtures::content(&fixtures::stand(stand), &fixtures::site(fixtures::SITE));
        let good = written(&content, &key).into_bytes();
        let bench = Self { name, good, trust: fixtures::trust(&key), question: fixtures::question() };
        assert!(bench.accepts(&bench.good), "{name}: the untouched passport");
        bench
    }

    fn accepts(&self, bytes: &[u8]) -> bool {
        verify(self.name, bytes, &self.trust, &self.question).valid()
    }

    /// Verifies every forgery of every place; gives how many there were.
    ///
    /// `forgeries` gives those of one place; places are shared among threads.
    fn refuse_all(&self, what: &str, places: usize, forgeries: impl Fn(usize) -> Vec<Vec<u8>> + Sync) -> usize {
        let (next, tried) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let threads = std::thread::available_parallelism().map_or(2, usize::from);
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    while let Some(place) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|place| *place < places) {
                        for forgery in forgeries(place).iter().filter(|forgery| **forgery != self.good) {
                            tried.fetch_add(1, Ordering::Relaxed);
                            assert!(!self.accepts(forgery), "{}: {what} at {place} was accepted", self.name);
                        }
                    }
                });
            }
        });
        let tried = tried.into_inner();
        println!("{}: {tried:>6} x {what}: accepted 0", self.name);
        tried
    }

    /// Bits and bytes changed, removed, doubled and exchanged, lines too, and the file cut at every length.
    fn refuse_every_change(&self, bits: Range<u32>) -> usize {
        let (good, places) = (&self.good, self.good.len());
        let changed = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = good.clone();
            change(&mut bytes);
            bytes
        };
        let lines: Vec<&[u8]> = good.split_inclusive(|byte| *byte == b'\n').collect();
        let of_lines = |change: &dyn Fn(&mut Vec<&[u8]>)| {
            let mut lines = lines.clone();
            change(&mut lines);
            lines.concat()
        };
        let tried = [
            self.refuse_all("a bit flipped", places, |place| {
                bits.clone().map(|bit| changed(&|bytes| bytes[place] ^= 1 << bit)).collect()
            }),
            self.refuse_all("a byte changed to one far away", places, |place| {
                vec![changed(&|bytes| bytes[place] = bytes[place].wrapping_add(13))]
            }),
            self.refuse_all("a byte removed", places, |place| vec![changed(&|bytes| _ = bytes.remove(place))]),
            self.refuse_all("a byte doubled", places, |place| {
                vec![changed(&|bytes| bytes.insert(place, bytes[place]))]
            }),
            self.refuse_all("two neighbouring bytes exchanged", places - 1, |place| {
                vec![changed(&|bytes| bytes.swap(place, place + 1))]
            }),
            self.refuse_all("a file cut", places, |length| vec![changed(&|bytes| bytes.truncate(length))]),
            self.refuse_all("a line exchanged with the next, removed, doubled", lines.len(), |place| {
                let next = (place + 1).min(lines.len() - 1);
                vec![
                    of_lines(&|all| all.swap(place, next)),
                    of_lines(&|all| _ = all.remove(place)),
                    of_lines(&|all| all.insert(place, all[place])),
                ]
            }),
        ];
        tried.iter().sum()
    }
}

#[test]
fn no_altered_passport_is_accepted() {
    // Of the second only the lowest bits, which make neighbours in ASCII.
    let tried = Bench::new("arc minutes", fixtures::ARC_MINUTES).refuse_every_change(0..8)
        + Bench::new("degrees", fixtures::DEGREES).refuse_every_change(0..1);
    println!("{tried} altered passports: accepted 0");
    assert!(tried > 100_000, "{tried}");
}
