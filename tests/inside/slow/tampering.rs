//! Whoever has no key changes a passport: each byte, each bit, each line, each length. Nothing may be accepted.

use crate::inside::{fixtures, written};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::trust::SigningKey;
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

    fn with_byte(&self, place: usize, byte: u8) -> Vec<u8> {
        let mut bytes = self.good.clone();
        bytes[place] = byte;
        bytes
    }

    /// Each byte changed to a neighbour in ASCII and to a value far away, removed, doubled.
    fn bytes(&self) -> usize {
        let places = self.good.len();
        let byte = |place: usize| self.good[place];
        let changed = self.refuse_all("a byte changed", places, |place| {
            vec![self.with_byte(place, byte(place) ^ 1), self.with_byte(place, byte(place).wrapping_add(13))]
        });
        let removed = self.refuse_all("a byte removed", places, |place| {
            let mut bytes = self.good.clone();
            bytes.remove(place);
            vec![bytes]
        });
        let doubled = self.refuse_all("a byte doubled", places, |place| {
            let mut bytes = self.good.clone();
            bytes.insert(place, byte(place));
            vec![bytes]
        });
        changed + removed + doubled
    }

    /// Bytes and lines exchanged with the next, lines removed and doubled, the file cut at every length.
    fn order_and_length(&self) -> usize {
        let exchanged = self.refuse_all("two neighbouring bytes exchanged", self.good.len() - 1, |place| {
            let mut bytes = self.good.clone();
            bytes.swap(place, place + 1);
            vec![bytes]
        });
        let cut = self.refuse_all("a file cut", self.good.len(), |length| vec![self.good[..length].to_vec()]);
        let lines: Vec<&[u8]> = self.good.split_inclusive(|byte| *byte == b'\n').collect();
        let of_lines = self.refuse_all("a line exchanged with the next, removed, doubled", lines.len(), |place| {
            let mut exchanged = lines.clone();
            exchanged.swap(place, (place + 1).min(lines.len() - 1));
            let mut removed = lines.clone();
            removed.remove(place);
            let mut doubled = lines.clone();
            doubled.insert(place, lines[place]);
            [exchanged, removed, doubled].map(|lines| lines.concat()).to_vec()
        });
        exchanged + cut + of_lines
    }

    fn bits(&self) -> usize {
        self.refuse_all("a bit flipped", self.good.len(), |place| {
            (0..8).map(|bit| self.with_byte(place, self.good[place] ^ (1 << bit))).collect()
        })
    }
}

#[test]
fn no_altered_passport_is_accepted() {
    let benches = [Bench::new("arc minutes", fixtures::ARC_MINUTES), Bench::new("degrees", fixtures::DEGREES)];
    let tried: usize = benches.iter().map(|bench| bench.bytes() + bench.order_and_length()).sum();
    let tried = tried + benches[0].bits();
    println!("{tried} altered passports: accepted 0");
    assert!(tried > 100_000, "{tried}");
}
