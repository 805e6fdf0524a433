//! Series of all lists of withdrawn passports: withdrawals, contradictions, and the next list.

use super::{Continued, Entry, NoNewList, REVOCATION_FORMAT, RevocationList, VerifiedList};
use crate::text::rule;
use crate::trust::check_identity;
use jiff::Timestamp;
use std::collections::{BTreeSet, HashMap};

/// Verified lists in the order of their sequence numbers, and the alarms of the series.
///
/// A gap, two lists with one number, a lost entry or a step back in time raises an alarm, because old lists may be
/// presented as new ones. Every withdrawal in any list applies. The program cannot tell which of two contradicting
/// lists is right, and a withdrawn passport must not become valid again unnoticed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    lists: Vec<VerifiedList>,
    /// Index of the list and of the entry in it, by the SHA-256 of the passport.
    withdrawn: HashMap<String, (usize, usize)>,
    alarms: Vec<SeriesAlarm>,
}

/// Irregularity in a series of lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SeriesAlarm {
    /// The lists before this first one are missing.
    #[error("gap: the series of lists of withdrawn passports begins with {0}, not with 1")]
    Beginning(u32),
    /// Lists in the middle are missing.
    #[error("gap: list {from} of withdrawn passports is followed by list {to}")]
    Gap {
        /// Number of the last list before the gap.
        from: u32,
        /// Number of the first list after the gap.
        to: u32,
    },
    /// A list that another one continues is missing, so its withdrawals are unknown.
    #[error(
        "list {list} of withdrawn passports continues list {missing}, which is missing; the withdrawals of list {missing} are \
         unknown"
    )]
    Missing {
        /// Number of the list that continues the missing one.
        list: u32,
        /// Number of the missing list.
        missing: u32,
    },
    /// Two different lists have the same number.
    #[error("fork: two different lists of withdrawn passports have the number {0}")]
    Fork(u32),
    /// A later list has an earlier time of issue.
    #[error("step back in time: list {to} of withdrawn passports was issued earlier than list {from}")]
    StepBack {
        /// Number of the earlier list.
        from: u32,
        /// Number of the later list.
        to: u32,
    },
    /// A later list lacks an entry of an earlier one.
    #[error("list {to} of withdrawn passports lacks an entry of list {from}")]
    LostEntry {
        /// Number of the earlier list.
        from: u32,
        /// Number of the later list.
        to: u32,
    },
}

impl SeriesAlarm {
    /// Returns `true` if the lists contradict each other. Otherwise some are only missing, as when single lists are
    /// given.
    pub(crate) fn is_contradiction(self) -> bool {
        !matches!(self, Self::Beginning(_) | Self::Gap { .. } | Self::Missing { .. })
    }

    /// Returns `true` if entries are missing that no given list repeats. No passport can then be shown not to be
    /// withdrawn.
    pub(crate) fn is_unknown(self) -> bool {
        matches!(self, Self::Missing { .. })
    }
}

impl Series {
    /// Creates the series of these lists, in any order.
    pub fn of(mut lists: Vec<VerifiedList>) -> Self {
        lists.sort_by(|a, b| {
            let key = |at: &VerifiedList| (at.list.sequence, at.list.issued_at);
            key(a).cmp(&key(b)).then_with(|| a.sha256.cmp(&b.sha256))
        });
        lists.dedup_by(|a, b| a.list == b.list);
        let alarms = alarms(&lists);
        let mut withdrawn = HashMap::new();
        for (place, verified) in lists.iter().enumerate() {
            for (index, entry) in verified.list.entries.iter().enumerate() {
                // The entry of the newest list replaces earlier ones for the same passport.
                withdrawn.insert(entry.sha256.clone(), (place, index));
            }
        }
        Self { lists, withdrawn, alarms }
    }

    /// Returns the lists, so that they can be put in order with others.
    pub(crate) fn into_lists(self) -> Vec<VerifiedList> {
        self.lists
    }

    pub(crate) fn alarms(&self) -> &[SeriesAlarm] {
        &self.alarms
    }

    /// Returns the list with the highest number, or `None` if there is no list.
    pub fn newest(&self) -> Option<&RevocationList> {
        self.lists.last().map(|verified| &verified.list)
    }

    /// Returns the number of withdrawn passports.
    pub(crate) fn count(&self) -> usize {
        self.withdrawn.len()
    }

    /// Returns the entry of a passport by the SHA-256 of its file, or `None` if it is not withdrawn. Another file with
    /// the same id is another passport, which need not be withdrawn.
    pub(crate) fn entry(&self, sha256: &str) -> Option<&Entry> {
        let &(place, index) = self.withdrawn.get(sha256)?;
        self.lists.get(place)?.list.entries.get(index)
    }

    /// Creates the next list: the entries of the newest list, followed by `new`. If that would be too large to be read
    /// again, the next list has only `new`, and continues the newest list. Without any list, it is the first.
    ///
    /// # Errors
    /// Returns [`NoNewList`] if an entry cannot be added or the list would be too large.
    pub fn following(&self, issuer: &str, now: Timestamp, new: Vec<Entry>) -> Result<RevocationList, NoNewList> {
        check_identity(issuer)?;
        let texts = new.iter().flat_map(|entry| [&entry.id, &entry.reason]);
        for text in texts {
            if text.is_empty() || !text.chars().all(rule::allowed_in_string) {
                return Err(NoNewList::BadText(text.to_owned()));
            }
        }
        for (index, entry) in new.iter().enumerate() {
            if new[..index].iter().any(|other| other.sha256 == entry.sha256) {
                return Err(NoNewList::Twice(entry.id.clone()));
            }
            if let Some(there) = self.entry(&entry.sha256) {
                let Entry { id, revoked_at, reason, .. } = there.clone();
                return Err(NoNewList::AlreadyRevoked { id, revoked_at, reason });
            }
        }
        let last = self.lists.last();
        if let Some(last) = last.map(|last| last.list.issued_at).filter(|last| *last > now) {
            return Err(NoNewList::BeforeLast { now, last });
        }
        let list = |continues: Option<Continued>, entries: Vec<Entry>| RevocationList {
            format: REVOCATION_FORMAT.to_owned(),
            sequence: last.map_or(1, |last| last.list.sequence.saturating_add(1)),
            issued_at: now,
            issuer: issuer.to_owned(),
            continues,
            entries,
        };
        let count = new.len();
        let Some(VerifiedList { list: newest, sha256 }) = last else {
            return Some(list(None, new)).filter(RevocationList::fits).ok_or(NoNewList::TooMany(count));
        };
        let longer = list(newest.continues.clone(), [&newest.entries[..], &new[..]].concat());
        if longer.fits() {
            return Ok(longer);
        }
        let continued = Continued { sequence: newest.sequence, sha256: sha256.clone() };
        Some(list(Some(continued), new)).filter(RevocationList::fits).ok_or(NoNewList::TooMany(count))
    }
}

/// Returns the alarms of lists that are in the order of their numbers.
fn alarms(lists: &[VerifiedList]) -> Vec<SeriesAlarm> {
    let first = lists.first().map(|first| first.list.sequence).filter(|first| *first != 1);
    let mut alarms: Vec<SeriesAlarm> = first.map(SeriesAlarm::Beginning).into_iter().collect();
    for pair in lists.windows(2) {
        let [VerifiedList { list: earlier, .. }, VerifiedList { list: later, .. }] = pair else { continue };
        let (from, to) = (earlier.sequence, later.sequence);
        if from == to {
            alarms.push(SeriesAlarm::Fork(from));
        } else if to - from > 1 {
            alarms.push(SeriesAlarm::Gap { from, to });
        }
        if later.issued_at < earlier.issued_at {
            alarms.push(SeriesAlarm::StepBack { from, to });
        }
        if from != to && has_lost(lists, earlier, later) {
            alarms.push(SeriesAlarm::LostEntry { from, to });
        }
    }
    for list in lists.iter().map(|verified| &verified.list) {
        if let Some(continued) = &list.continues
            && continued_by(lists, list).is_none()
        {
            alarms.push(SeriesAlarm::Missing { list: list.sequence, missing: continued.sequence });
        }
    }
    alarms
}

/// Returns the list that `list` continues, or `None` if it is not present.
fn continued_by<'l>(lists: &'l [VerifiedList], list: &RevocationList) -> Option<&'l RevocationList> {
    let Continued { sequence, sha256 } = list.continues.as_ref()?;
    let there = lists.iter().find(|other| other.list.sequence == *sequence && other.sha256 == *sha256)?;
    Some(&there.list)
}

/// Returns `true` if the chain of the later list is complete and lacks an entry of the earlier one.
fn has_lost(lists: &[VerifiedList], earlier: &RevocationList, later: &RevocationList) -> bool {
    // The numbers in a chain decrease, so the chain ends.
    let chain = std::iter::successors(Some(later), |list| continued_by(lists, list));
    let (mut entries, mut whole) = (BTreeSet::new(), true);
    for list in chain {
        entries.extend(&list.entries);
        whole = list.continues.is_none();
    }
    whole && !earlier.entries.iter().all(|entry| entries.contains(entry))
}

#[cfg(all(test, feature = "factory"))]
mod tests {
    use super::*;
    use crate::text::LARGEST_DOCUMENT_BYTES;
    use crate::trust::{AllowedSigners, SigningKey};

    fn entry(id: &str) -> Entry {
        let revoked_at = Timestamp::from_second(100).unwrap();
        Entry { id: id.to_owned(), sha256: format!("{id:0>64}"), revoked_at, reason: "wrong site".to_owned() }
    }

    fn list(sequence: u32, second: i64, ids: &[&str]) -> VerifiedList {
        let issued_at = Timestamp::from_second(second).unwrap();
        let entries = ids.iter().map(|id| entry(id)).collect();
        let (format, issuer) = (REVOCATION_FORMAT.to_owned(), "f".to_owned());
        let list = RevocationList { format, sequence, issued_at, issuer, continues: None, entries };
        VerifiedList { list, sha256: format!("{sequence:0>32}{second:0>32}") }
    }

    /// Returns `list` as the continuation of an earlier list.
    fn continuing(mut list: VerifiedList, earlier: &VerifiedList) -> VerifiedList {
        let (sequence, sha256) = (earlier.list.sequence, earlier.sha256.clone());
        list.list.continues = Some(Continued { sequence, sha256 });
        list
    }

    fn alarms(lists: Vec<VerifiedList>) -> Vec<String> {
        Series::of(lists).alarms().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_series_that_only_grows_is_good() {
        let series = Series::of(vec![list(2, 300, &["a", "b"]), list(1, 200, &["a"]), list(1, 200, &["a"])]);
        assert_eq!(series.newest().unwrap().sequence, 2);
        assert!(series.alarms().is_empty());
    }

    #[test]
    fn gaps_forks_and_steps_back_are_alarms() {
        let cases = [
            (vec![list(2, 200, &["a"])], "begins with 2"),
            (vec![list(1, 200, &["a"]), list(3, 300, &["a"])], "gap: "),
            (vec![list(1, 200, &["a"]), list(1, 200, &["b"])], "fork: "),
            (vec![list(1, 300, &["a"]), list(2, 200, &["a"])], "step back in time: "),
            (vec![list(1, 200, &["a"]), list(2, 300, &["b"])], "lacks an entry"),
        ];
        for (lists, words) in cases {
            let alarms = alarms(lists);
            assert!(alarms.iter().any(|alarm| alarm.contains(words)), "{alarms:?}");
        }
    }

    #[test]
    fn what_was_withdrawn_once_does_not_come_back() {
        let withdraws = |lists: Vec<VerifiedList>, ids: &[&str]| {
            let series = Series::of(lists);
            assert_eq!(series.count(), ids.len());
            for id in ids {
                assert_eq!(series.entry(&entry(id).sha256), Some(&entry(id)));
            }
            assert_eq!(series.entry(&entry("d").sha256), None);
        };
        withdraws(vec![list(1, 200, &["a"]), list(1, 250, &["b"])], &["a", "b"]);
        withdraws(vec![list(1, 200, &["a", "c"]), list(2, 300, &["a"]), list(3, 300, &["b"])], &["a", "b", "c"]);
        withdraws(vec![list(1, 200, &["a"]), list(2, 300, &["a", "b"])], &["a", "b"]);
    }

    #[test]
    fn single_lists_are_no_contradiction() {
        let alarms = |lists| Series::of(lists).alarms().iter().filter(|alarm| alarm.is_contradiction()).count();
        assert_eq!(alarms(vec![list(2, 200, &["a"]), list(5, 300, &["a", "b"])]), 0);
        assert_eq!(alarms(vec![list(2, 200, &["a"]), list(2, 300, &["b"])]), 1);
    }

    #[test]
    fn the_entries_of_a_whole_chain_count() {
        let first = list(1, 100, &["a"]);
        let second = continuing(list(2, 200, &["b"]), &first);
        let third = continuing(list(3, 300, &["b", "c"]), &first);
        let fourth = continuing(list(4, 400, &["d"]), &third);
        let series = Series::of(vec![fourth.clone(), first.clone(), third.clone(), second.clone()]);
        assert_eq!(series.alarms(), []);
        assert_eq!(series.count(), 4);
        assert!(["a", "b", "c", "d"].iter().all(|id| series.entry(&entry(id).sha256).is_some()));
        // As in a series, a missing list that no other list continues is not a contradiction.
        let single = Series::of(vec![fourth.clone(), first.clone(), third.clone()]);
        assert!(!single.alarms().iter().any(|alarm| alarm.is_contradiction() || alarm.is_unknown()));
    }

    #[test]
    fn a_list_that_is_continued_and_absent_makes_the_answer_unknown() {
        let first = list(1, 100, &["a"]);
        let second = continuing(list(2, 200, &["b"]), &first);
        let third = continuing(list(3, 300, &["c"]), &second);
        // A list with the same number but another SHA-256 is not the referenced one.
        let other = VerifiedList { sha256: "f".repeat(64), ..first.clone() };
        for lists in [
            vec![second.clone()],
            vec![third.clone(), second],
            vec![third, first],
            vec![continuing(list(2, 200, &["b"]), &list(1, 100, &["a"])), other],
        ] {
            let series = Series::of(lists);
            assert!(series.alarms().iter().any(|alarm| alarm.is_unknown()), "{:?}", series.alarms());
        }
    }

    #[test]
    fn a_chain_that_lost_an_entry_is_an_alarm() {
        let first = list(1, 100, &["a"]);
        let second = list(2, 200, &["a", "b"]);
        let third = continuing(list(3, 300, &["c"]), &first);
        assert_eq!(alarms(vec![first, second, third]), ["list 3 of withdrawn passports lacks an entry of list 2"]);
    }

    #[test]
    fn a_list_that_would_be_too_large_begins_anew_and_continues_the_last() {
        let key = SigningKey::generate().unwrap();
        let line = format!("f {}", key.public_key().to_openssh());
        let signers = AllowedSigners::parse("signers", line.as_bytes()).unwrap();
        let now = Timestamp::from_second(1_000).unwrap();
        let verified = |list: &RevocationList| {
            let text = list.sign(&key).unwrap();
            assert!(text.len() <= LARGEST_DOCUMENT_BYTES, "{} bytes", text.len());
            RevocationList::verify("list", text.as_bytes(), &signers, &[], now).unwrap()
        };
        // An entry has about 150 bytes, or 1.1 kB with this reason, so fewer than 950 fit into 1 MiB.
        let batch = |names: std::ops::Range<usize>| -> Vec<Entry> {
            names.map(|name| Entry { reason: "why ".repeat(240), ..entry(&format!("{name}")) }).collect()
        };
        let mut lists = Vec::new();
        let mut sizes = Vec::new();
        for step in 0..5 {
            let series = Series::of(lists.clone());
            let next = series.following("f", now, batch(400 * step..400 * (step + 1))).unwrap();
            sizes.push((next.entries.len(), next.continues.as_ref().map(|continued| continued.sequence)));
            lists.push(verified(&next));
        }
        assert_eq!(sizes, [(400, None), (800, None), (400, Some(2)), (800, Some(2)), (400, Some(4))]);
        let series = Series::of(lists);
        assert_eq!((series.alarms(), series.count()), (&[][..], 2000));
        let again = series.following("f", now, batch(0..1)).unwrap_err();
        assert!(matches!(again, NoNewList::AlreadyRevoked { .. }), "{again}");
        let many = series.following("f", now, batch(2000..3000)).unwrap_err();
        assert!(matches!(many, NoNewList::TooMany(1000)), "{many}");
    }
}
