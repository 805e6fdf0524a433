//! The best numbers of visits: every choice compared if they are few, else by exchange from several starts.
//!
//! The exchange takes each visit in turn and moves it to the position where it lowers the value most, until no visit can
//! be moved with a gain ([Cook and Nachtsheim](crate::bibliography::Bibliography::CookNachtsheim80), the modified Fedorov
//! procedure).

use super::candidates::Candidates;
use super::criterion::{Criterion, Matrix8};
use crate::statistics::random::Stream;
use nalgebra::SVector;

/// Largest number of choices that are all compared; 16 candidates and eight readings give 490,314.
const MOST_CHOICES: u64 = 500_000;

const STARTS: usize = 16;

/// Most rounds of the exchange from one start; it usually needs three to six.
const MOST_ROUNDS: usize = 100;

/// Relative difference below which two values count as equal: symmetric choices differ by rounding.
const SAME: f64 = 1e-9;

/// Ridge, as a share of each parameter's largest information, with which a singular start has a value.
const RIDGE: f64 = 1e-9;

/// Numbers of visits that were found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    pub value: f64,
    /// Visits of each candidate.
    pub visits: Vec<u32>,
    /// `true` if every choice was compared.
    pub exhaustive: bool,
}

impl Found {
    /// Returns Σ visits², which is smaller if the visits are spread over more positions.
    fn concentration(&self) -> u64 {
        self.visits.iter().map(|visits| u64::from(*visits) * u64::from(*visits)).sum()
    }
}

/// Returns `true` if `found` is better than `other`. Of equal values the one spread over more positions is better.
pub(crate) fn is_better(found: &Found, other: &Found) -> bool {
    let same = (found.value - other.value).abs() <= SAME * other.value.abs();
    if same { found.concentration() < other.concentration() } else { found.value < other.value }
}

/// Returns the best choice of `readings` visits, or `None` if none determines the parameters.
pub(crate) fn best(candidates: &Candidates, readings: u32, criterion: Criterion) -> Option<Found> {
    if are_few(candidates.len(), readings) {
        exhaustive(candidates, readings, criterion)
    } else {
        by_exchange(candidates, readings, criterion)
    }
}

/// Returns `true` if the choices with repetition, C(n + N − 1, N), are so few that all can be compared.
fn are_few(candidates: usize, readings: u32) -> bool {
    let mut number: u64 = 1;
    (1..=u64::from(readings)).all(|taken| {
        // Exact: the product of `taken` consecutive numbers is divisible by their number's factorial.
        number = number * (candidates as u64 + taken - 1) / taken;
        number <= MOST_CHOICES
    })
}

pub(crate) fn exhaustive(candidates: &Candidates, readings: u32, criterion: Criterion) -> Option<Found> {
    let mut all = All { candidates, criterion, visits: vec![0; candidates.len()], best: None };
    all.descend(0, readings, &Matrix8::zeros());
    all.best
}

struct All<'a> {
    candidates: &'a Candidates,
    criterion: Criterion,
    visits: Vec<u32>,
    best: Option<Found>,
}

impl All<'_> {
    /// Distributes `left` visits over the candidates from `place` on, with `sum` from those before.
    fn descend(&mut self, place: usize, left: u32, sum: &Matrix8) {
        let is_last = place + 1 == self.visits.len();
        let fewest = if is_last { left } else { 0 };
        for visits in fewest..=left {
            let sum = sum + self.candidates.information(place, visits);
            self.visits[place] = visits;
            if visits == left {
                self.compare(&sum);
            } else {
                self.descend(place + 1, left - visits, &sum);
            }
        }
        self.visits[place] = 0;
    }

    fn compare(&mut self, sum: &Matrix8) {
        let value = self.criterion.value(sum, self.candidates.turn_on);
        let may_be_better =
            value.is_finite() && self.best.as_ref().is_none_or(|best| value <= best.value + SAME * best.value.abs());
        if may_be_better {
            let found = Found { value, visits: self.visits.clone(), exhaustive: true };
            if self.best.as_ref().is_none_or(|best| is_better(&found, best)) {
                self.best = Some(found);
            }
        }
    }
}

pub(crate) fn by_exchange(candidates: &Candidates, readings: u32, criterion: Criterion) -> Option<Found> {
    let mut stream = Stream::new(1);
    let mut best: Option<Found> = None;
    for _ in 0..STARTS {
        let mut visits = vec![0; candidates.len()];
        for _ in 0..readings {
            // Less than the number of candidates, because the unit is less than 1.
            visits[(stream.unit() * candidates.len() as f64) as usize] += 1;
        }
        let mut exchange = Exchange::new(candidates, visits, criterion);
        exchange.run();
        let found = exchange.found();
        if found.value.is_finite() && best.as_ref().is_none_or(|best| is_better(&found, best)) {
            best = Some(found);
        }
    }
    best
}

struct Exchange<'a> {
    candidates: &'a Candidates,
    criterion: Criterion,
    visits: Vec<u32>,
    /// Information of all visits, with the ridge.
    sum: Matrix8,
    /// Information that one more visit of each candidate adds.
    gain: Vec<Matrix8>,
    value: f64,
}

impl<'a> Exchange<'a> {
    fn new(candidates: &'a Candidates, visits: Vec<u32>, criterion: Criterion) -> Self {
        let once = |place| candidates.information(place, 1).diagonal() * RIDGE;
        let ridge = (0..visits.len()).map(once).fold(SVector::<f64, 8>::zeros(), |most, once| most.sup(&once));
        let each = visits.iter().enumerate().map(|(place, visits)| candidates.information(place, *visits));
        let sum = each.fold(Matrix8::from_diagonal(&ridge), |sum, one| sum + one);
        let gain = visits.iter().enumerate().map(|(place, visits)| gain(candidates, place, *visits)).collect();
        let mut exchange = Self { candidates, criterion, visits, sum, gain, value: f64::INFINITY };
        exchange.value = exchange.value_of(&exchange.sum);
        exchange
    }

    fn value_of(&self, sum: &Matrix8) -> f64 {
        self.criterion.value(sum, self.candidates.turn_on)
    }

    /// Moves visits until none can be moved with a gain.
    fn run(&mut self) {
        for _ in 0..MOST_ROUNDS {
            let mut moved = false;
            for place in 0..self.visits.len() {
                while self.visits[place] > 0 && self.moves_from(place) {
                    moved = true;
                }
            }
            if !moved {
                return;
            }
        }
    }

    /// Moves one visit of `place` to where it lowers the value most. Returns `false` if it stays.
    fn moves_from(&mut self, place: usize) -> bool {
        let rest = self.sum - gain(self.candidates, place, self.visits[place] - 1);
        let mut best = (self.value - SAME * self.value.abs(), None);
        for (to, gain) in self.gain.iter().enumerate().filter(|(to, _)| *to != place) {
            let value = self.value_of(&(rest + gain));
            if value < best.0 {
                best = (value, Some(to));
            }
        }
        let (value, Some(to)) = best else { return false };
        (self.sum, self.value) = (rest + self.gain[to], value);
        self.visits[place] -= 1;
        self.visits[to] += 1;
        for changed in [place, to] {
            self.gain[changed] = gain(self.candidates, changed, self.visits[changed]);
        }
        true
    }

    /// Returns the numbers of visits, with their value without ridge.
    fn found(self) -> Found {
        let value = self.criterion.value(&self.candidates.information_of(&self.visits), self.candidates.turn_on);
        Found { value, visits: self.visits, exhaustive: false }
    }
}

/// Returns the information that one more visit of a candidate adds.
fn gain(candidates: &Candidates, place: usize, visits: u32) -> Matrix8 {
    candidates.information(place, visits + 1) - candidates.information(place, visits)
}
