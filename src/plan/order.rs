//! The order of visits in which a drift of ω_0 during the run changes the parameters least.
//!
//! The run lasts one unit of time with equal intervals, and ω_0 rises linearly by 1 °/h about its mean, first on x, then on
//! y. A parameter changes by b = Σ G_p τ_p, where τ_p is the mean time of the visits of position p. The order with the
//! smallest Σ (b/T)² over parameters and axes is wanted, without the same position twice in a row.

use super::candidates::Design;
use crate::statistics::random::Stream;

/// Changes of the eight parameters in units of their tolerances, for a drift on x and then on y.
type Changes = [f64; 16];

/// Largest number of orders that are all compared; eight positions have 40,320, ten visits at most 3,628,800.
const MOST_ORDERS: f64 = 4e6;

/// Number of exchanges of two visits that the search for longer orders tries.
const TRIED: usize = 6_000_000;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Order {
    /// For each visit the place of its position in [`Design::readings`].
    pub places: Vec<usize>,
    /// Σ (b/T)² for a rise of 1 °/h over the run.
    pub value: f64,
    /// Largest |b/T| of a parameter if ω_0 rises or falls by 1 °/h over the run on x and on y, whichever signs are worst.
    pub largest_over_tolerance: f64,
}

/// Positions with their numbers of visits, and the effect of the time of a visit.
struct Problem {
    /// Change for each visit, per unit of time.
    per_visit: Vec<Changes>,
    visits: Vec<u32>,
    readings: usize,
}

/// Cost of an order: the number of positions twice in a row, then Σ (b/T)².
type Cost = (usize, f64);

pub(crate) fn best(design: &Design) -> Order {
    let problem = Problem::new(design);
    let places = if problem.number_of_orders() <= MOST_ORDERS { problem.exhaustive() } else { problem.searched(TRIED) };
    problem.order(places)
}

/// Returns the order that the search for long orders finds when it tries `times` as many exchanges as usual.
#[cfg(test)]
pub(crate) fn searched(design: &Design, times: usize) -> Order {
    let problem = Problem::new(design);
    problem.order(problem.searched(times * TRIED))
}

impl Problem {
    fn new(design: &Design) -> Self {
        let visited: Vec<(usize, u32)> = design.visited().collect();
        let of_visit = |(place, visits): &(usize, u32)| {
            let mut changes = [0.0; 16];
            let response = design.response(*place);
            let share = 1.0 / f64::from(*visits);
            changes.iter_mut().zip(&response).for_each(|(change, value)| *change = value * share);
            changes
        };
        let per_visit = visited.iter().map(of_visit).collect();
        let visits: Vec<u32> = visited.iter().map(|(_, visits)| *visits).collect();
        let readings = visits.iter().sum::<u32>() as usize;
        Self { per_visit, visits, readings }
    }

    /// Returns the time of a visit, from −1/2 to 1/2.
    fn time(&self, visit: usize) -> f64 {
        visit as f64 / (self.readings - 1) as f64 - 0.5
    }

    /// Returns the number of different orders, N!/Π m!.
    fn number_of_orders(&self) -> f64 {
        let mut number = 1.0;
        let mut placed = 0;
        for visits in &self.visits {
            for visit in 1..=*visits {
                placed += 1;
                number *= f64::from(placed) / f64::from(visit);
            }
        }
        number
    }

    fn order(&self, places: Vec<usize>) -> Order {
        let changes = self.changes(&places);
        let of_both = (0..8).map(|parameter| changes[parameter].abs() + changes[parameter + 8].abs());
        let largest = of_both.fold(0.0, f64::max);
        Order { value: squares(&changes), largest_over_tolerance: largest, places }
    }

    fn changes(&self, places: &[usize]) -> Changes {
        let mut changes = [0.0; 16];
        for (visit, place) in places.iter().enumerate() {
            add(&mut changes, &self.per_visit[*place], self.time(visit));
        }
        changes
    }

    fn exhaustive(&self) -> Vec<usize> {
        let mut search = Exhaustive {
            problem: self,
            left: self.visits.clone(),
            places: Vec::with_capacity(self.readings),
            best: (usize::MAX, f64::INFINITY),
            found: Vec::new(),
        };
        search.descend(&[0.0; 16], 0);
        search.found
    }

    /// Exchanges two visits as long as that helps, from many random orders, until about `most` exchanges were tried.
    fn searched(&self, most: usize) -> Vec<usize> {
        let pairs = self.readings * (self.readings - 1) / 2;
        let mut stream = Stream::new(1);
        let mut best: (Cost, Vec<usize>) = ((usize::MAX, f64::INFINITY), Vec::new());
        let mut tried = 0;
        while tried < most && !is_nothing(best.0) || best.1.is_empty() {
            let mut places = self.shuffled(&mut stream);
            let mut changes = self.changes(&places);
            let mut cost = (repeats(&places), squares(&changes));
            loop {
                let improved = self.sweep(&mut places, &mut changes, &mut cost);
                tried += pairs;
                if !improved {
                    break;
                }
            }
            if is_less(cost, best.0) {
                best = (cost, places);
            }
        }
        best.1
    }

    fn shuffled(&self, stream: &mut Stream) -> Vec<usize> {
        let each = self.visits.iter().enumerate();
        let mut places: Vec<usize> = each.flat_map(|(place, visits)| vec![place; *visits as usize]).collect();
        for last in (1..places.len()).rev() {
            places.swap(last, (stream.unit() * (last + 1) as f64) as usize);
        }
        places
    }

    /// Tries every exchange of two visits once and keeps those that help. Returns `true` if one did.
    fn sweep(&self, places: &mut [usize], changes: &mut Changes, cost: &mut Cost) -> bool {
        let mut improved = false;
        for one in 0..places.len() {
            for other in one + 1..places.len() {
                let (a, b) = (places[one], places[other]);
                if a == b {
                    continue;
                }
                let later = self.time(other) - self.time(one);
                let mut new = *changes;
                add(&mut new, &self.per_visit[a], later);
                add(&mut new, &self.per_visit[b], -later);
                let value = squares(&new);
                // Most exchanges end here, before the neighbours are compared.
                if value >= cost.1 && cost.0 == 0 {
                    continue;
                }
                places.swap(one, other);
                let found = (repeats(places), value);
                if is_less(found, *cost) {
                    (*changes, *cost) = (new, found);
                    improved = true;
                } else {
                    places.swap(one, other);
                }
            }
        }
        improved
    }
}

struct Exhaustive<'a> {
    problem: &'a Problem,
    left: Vec<u32>,
    places: Vec<usize>,
    best: Cost,
    found: Vec<usize>,
}

impl Exhaustive<'_> {
    fn descend(&mut self, changes: &Changes, repeated: usize) {
        let visit = self.places.len();
        if visit == self.problem.readings {
            let cost = (repeated, squares(changes));
            if is_less(cost, self.best) {
                self.best = cost;
                self.found.clone_from(&self.places);
            }
            return;
        }
        let before = self.places.last().copied();
        let time = self.problem.time(visit);
        for place in 0..self.left.len() {
            let repeated = repeated + usize::from(before == Some(place));
            if self.left[place] == 0 || repeated > self.best.0 {
                continue;
            }
            let mut changes = *changes;
            add(&mut changes, &self.problem.per_visit[place], time);
            self.left[place] -= 1;
            self.places.push(place);
            self.descend(&changes, repeated);
            self.places.pop();
            self.left[place] += 1;
        }
    }
}

/// Returns `true` if a cost is less; equal values differ by rounding, and the first one found stays.
fn is_less(one: Cost, other: Cost) -> bool {
    one.0 < other.0 || one.0 == other.0 && one.1 < other.1 * (1.0 - 1e-9)
}

/// Returns `true` if no position is twice in a row and the drift changes nothing but the last digits.
fn is_nothing(cost: Cost) -> bool {
    const ROUNDING: f64 = 1e-20;
    cost.0 == 0 && cost.1 < ROUNDING
}

/// Returns the number of positions twice in a row.
fn repeats(places: &[usize]) -> usize {
    places.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

fn add(changes: &mut Changes, other: &Changes, share: f64) {
    changes.iter_mut().zip(other).for_each(|(change, other)| *change += share * other);
}

fn squares(changes: &Changes) -> f64 {
    changes.iter().map(|change| change * change).sum()
}
