//! Mistakes that people make in laboratory software, one at a time.

use super::software::{At, RIGHT, Read, Software, inverse};
use nalgebra::{Matrix2, Vector2};

type Wrong = (&'static str, Software);

pub fn all() -> Vec<Wrong> {
    let groups =
        [reading(), numbers(), pairs(), scale_factors(), drifts_per_g(), constant_drifts(), telling(), signs()];
    groups.into_iter().flatten().collect()
}

fn exchange(v: &mut Vector2<f64>) {
    *v = Vector2::new(v.y, v.x);
}

/// Matrices and lists taken the wrong way.
fn reading() -> Vec<Wrong> {
    let read = |read| Software { read, ..RIGHT };
    vec![
        ("Delta transposed", read(|r| r.delta.transpose_mut())),
        ("B transposed", read(|r| r.b.transpose_mut())),
        ("C transposed", read(|r| r.c.transpose_mut())),
        ("n2_inverse transposed", read(|r| r.n2_inverse.transpose_mut())),
        (
            "all matrices transposed: lists of rows read as columns",
            read(|r| r.matrices().into_iter().for_each(Matrix2::transpose_mut)),
        ),
        ("n2 in place of n2_inverse", read(|r| r.n2_inverse = r.n2)),
        ("omega1 in place of B", read(|r| r.b = r.omega1)),
        ("n1 in place of Delta", read(|r| r.delta = r.n1)),
        ("rows of B exchanged", read(|r| r.b.swap_rows(0, 1))),
        ("rows of Delta exchanged", read(|r| r.delta.swap_rows(0, 1))),
        ("J_x and J_y exchanged", read(|r| r.currents().for_each(exchange))),
        ("omega_x and omega_y exchanged", read(|r| r.at.iter_mut().for_each(|at| exchange(&mut at.omega)))),
        ("c and d of the specific force exchanged", read(|r| r.at.iter_mut().for_each(|at| exchange(&mut at.n)))),
        ("sign of J_x reversed", read(|r| r.currents().for_each(|current| current.x *= -1.0))),
        ("sign of J_y reversed", read(|r| r.currents().for_each(|current| current.y *= -1.0))),
        ("sign of both currents reversed", read(|r| r.currents().for_each(|current| *current *= -1.0))),
        ("sign of the specific force reversed", read(|r| r.at.iter_mut().for_each(|at| at.n *= -1.0))),
        ("sign of omega reversed", read(|r| r.at.iter_mut().for_each(|at| at.omega *= -1.0))),
        ("currents sorted by j, then i", read(|r| currents_sorted_by(r, |at| i64::from(100 * at.j + at.i)))),
        ("currents sorted backwards", read(|r| currents_sorted_by(r, |at| -i64::from(100 * at.i + at.j)))),
        ("currents sorted by size", read(|r| currents_sorted_by(r, |at| (at.current.x * 1e9) as i64))),
        (
            "currents one row too late",
            read(|r| {
                let currents: Vec<_> = r.at.iter().map(|at| at.current).collect();
                r.at.iter_mut().zip(currents.iter().cycle().skip(1)).for_each(|(at, current)| at.current = *current);
            }),
        ),
        (
            "the first eight of the list taken for the eight",
            read(|r| {
                let eight = [(1, 1), (1, 2), (1, 3), (1, 4), (2, 1), (2, 2), (2, 3), (2, 4)];
                r.at.truncate(8);
                r.at.iter_mut().zip(eight).for_each(|(at, (i, j))| (at.i, at.j) = (i, j));
            }),
        ),
        ("an ideal stand: deviations left out", read(ideal)),
        ("deviations left out of Delta", read(|r| r.delta.fill(0.0))),
    ]
}

fn currents_sorted_by(read: &mut Read, key: fn(&At) -> i64) {
    let mut sorted = read.at.clone();
    sorted.sort_by_key(key);
    read.at.iter_mut().zip(sorted).for_each(|(at, other)| at.current = other.current);
}

/// B, C, Δ and n_2 of a stand without deviations; the rates from the passport's.
fn ideal(read: &mut Read) {
    let (horizontal, vertical) = (read.b.abs().max() / 2.0, read.c.trace() / 2.0);
    read.delta.fill(0.0);
    read.b = Matrix2::new(0.0, 2.0 * horizontal, 2.0 * horizontal, 0.0);
    read.c = Matrix2::identity() * vertical;
    read.n2_inverse = Matrix2::new(0.0, 0.5, 0.5, 0.0);
}

/// Digits and units.
fn numbers() -> Vec<Wrong> {
    fn each(read: &mut Read, change: fn(f64) -> f64) {
        let Read { delta, b, c, n1, n2, n2_inverse, omega1, at } = read;
        for matrix in [delta, b, c, n1, n2, n2_inverse, omega1] {
            matrix.apply(|x| *x = change(*x));
        }
        for vector in at.iter_mut().flat_map(|At { n, omega, current, .. }| [n, omega, current]) {
            vector.apply(|x| *x = change(*x));
        }
    }
    let read = |read| Software { read, ..RIGHT };
    fn single(x: f64) -> f64 {
        f64::from(x as f32)
    }
    vec![
        ("all numbers in single precision", read(|r| each(r, single))),
        ("currents in single precision", read(|r| r.currents().for_each(|current| *current = current.map(single)))),
        ("matrices in single precision", read(|r| r.matrices().into_iter().for_each(|m| *m = m.map(single)))),
        ("all numbers to six decimals", read(|r| each(r, |x| (x * 1e6).round() / 1e6))),
        ("all numbers to nine decimals, as printed pages show them", read(|r| each(r, |x| (x * 1e9).round() / 1e9))),
        (
            "currents to whole nanoamperes",
            read(|r| r.currents().for_each(|current| *current = current.map(|x| (x * 1e6).round() / 1e6))),
        ),
        ("currents in microamperes", read(|r| r.currents().for_each(|current| *current *= 1e3))),
        ("currents in amperes", read(|r| r.currents().for_each(|current| *current *= 1e-3))),
        ("omega in radians per hour", read(|r| r.at.iter_mut().for_each(|at| at.omega *= 1_f64.to_radians()))),
        ("B in radians per hour", read(|r| r.b *= 1_f64.to_radians())),
        ("C in degrees per second", read(|r| r.c /= 3600.0)),
        (
            "drifts per 9.80665 m/s2 in place of the local g",
            Software { split: |w| (RIGHT.split)(w).map(|per_g| per_g * 9.80665 / 9.8), ..RIGHT },
        ),
    ]
}

/// Eq. (11).
fn pairs() -> Vec<Wrong> {
    fn of(read: &Read, plus: [u32; 2], minus: [u32; 2]) -> [Matrix2<f64>; 2] {
        [1, 2].map(|i| {
            let difference = |place: usize| read.find(i, plus[place]).current - read.find(i, minus[place]).current;
            Matrix2::from_columns(&[difference(0), difference(1)])
        })
    }
    fn rearranged(read: &Read, change: fn(Matrix2<f64>, Matrix2<f64>) -> [Matrix2<f64>; 2]) -> [Matrix2<f64>; 2] {
        let [j1, j2] = (RIGHT.pairs)(read);
        change(j1, j2)
    }
    let pairs = |pairs| Software { pairs, ..RIGHT };
    vec![
        ("pairs reversed: (3) - (1), (4) - (2)", pairs(|r| of(r, [3, 4], [1, 2]))),
        ("first pair reversed: (3) - (1)", pairs(|r| of(r, [3, 2], [1, 4]))),
        ("second pair reversed: (4) - (2)", pairs(|r| of(r, [1, 4], [3, 2]))),
        ("neighbours paired: (1) - (2), (3) - (4)", pairs(|r| of(r, [1, 3], [2, 4]))),
        ("pairs in the other order: (2) - (4), (1) - (3)", pairs(|r| of(r, [2, 1], [4, 3]))),
        (
            "sums of pairs in place of differences",
            pairs(|r| {
                let sum = |i, a, b| r.find(i, a).current + r.find(i, b).current;
                [1, 2].map(|i| Matrix2::from_columns(&[sum(i, 1, 3), sum(i, 2, 4)]))
            }),
        ),
        ("halves of the differences", pairs(|r| rearranged(r, |j1, j2| [j1 / 2.0, j2 / 2.0]))),
        ("J1 and J2 exchanged", pairs(|r| rearranged(r, |j1, j2| [j2, j1]))),
        ("J1 and J2 as rows in place of columns", pairs(|r| rearranged(r, |j1, j2| [j1.transpose(), j2.transpose()]))),
        ("J1 as rows in place of columns", pairs(|r| rearranged(r, |j1, j2| [j1.transpose(), j2]))),
        ("J2 as rows in place of columns", pairs(|r| rearranged(r, |j1, j2| [j1, j2.transpose()]))),
        ("sign of J1 reversed", pairs(|r| rearranged(r, |j1, j2| [-j1, j2]))),
        ("sign of J2 reversed", pairs(|r| rearranged(r, |j1, j2| [j1, -j2]))),
    ]
}

/// Eq. (13) and (17)-(19).
fn scale_factors() -> Vec<Wrong> {
    /// The iteration, with this many steps after the first approximation.
    fn iterated(r: &Read, j1: Matrix2<f64>, j2: Matrix2<f64>, steps: usize) -> Matrix2<f64> {
        let first = r.omega1 * inverse(j1);
        (0..steps).fold(first, |k, _| (r.omega1 - (r.c - k * j2 * r.n2_inverse) * r.n1) * inverse(j1))
    }
    let k = |k| Software { k, ..RIGHT };
    vec![
        ("(13): multiplied from the left", k(|r, j1, j2| inverse(j1 - j2 * r.delta) * r.b)),
        ("(13): Delta J2 in place of J2 Delta", k(|r, j1, j2| r.b * inverse(j1 - r.delta * j2))),
        ("(13): plus in place of minus", k(|r, j1, j2| r.b * inverse(j1 + j2 * r.delta))),
        ("(13): J2 left out", k(|r, j1, _| r.b * inverse(j1 - r.delta))),
        ("(13): inverse forgotten", k(|r, j1, j2| r.b * (j1 - j2 * r.delta))),
        ("(13): inverse of K", k(|r, j1, j2| (j1 - j2 * r.delta) * inverse(r.b))),
        ("(13): divided element by element", k(|r, j1, j2| r.b.component_div(&(j1 - j2 * r.delta)))),
        ("(13): multiplied element by element", k(|r, j1, j2| r.b * inverse(j1 - j2.component_mul(&r.delta)))),
        (
            "(13): factors of its second form exchanged",
            k(|r, j1, j2| r.b * inverse(Matrix2::identity() - j2 * r.delta * inverse(j1)) * inverse(j1)),
        ),
        ("the first approximation alone", k(|r, j1, j2| iterated(r, j1, j2, 0))),
        ("one step of the iteration", k(|r, j1, j2| iterated(r, j1, j2, 1))),
        (
            "the iteration stopped where K_x and K_y move by less than 0.1 %",
            k(|r, j1, j2| {
                let mut k = iterated(r, j1, j2, 0);
                for steps in 1..200 {
                    let next = iterated(r, j1, j2, steps);
                    let moved = (next.diagonal() - k.diagonal()).component_div(&k.diagonal()).abs().max();
                    k = next;
                    if moved <= 1e-3 {
                        break;
                    }
                }
                k
            }),
        ),
        (
            "(18): n1 left out",
            k(|r, j1, j2| (r.omega1 - (r.c - iterated(r, j1, j2, 0) * j2 * r.n2_inverse)) * inverse(j1)),
        ),
    ]
}

/// Eq. (15) and (16).
fn drifts_per_g() -> Vec<Wrong> {
    let omega_n = |omega_n| Software { omega_n, ..RIGHT };
    let split = |split| Software { split, ..RIGHT };
    vec![
        ("(15): plus in place of minus", omega_n(|r, k, [_, j2]| r.c + k * j2 * r.n2_inverse)),
        ("(15): n2_inverse from the left", omega_n(|r, k, [_, j2]| r.c - r.n2_inverse * k * j2)),
        ("(15): J2 K in place of K J2", omega_n(|r, k, [_, j2]| r.c - j2 * k * r.n2_inverse)),
        ("(15): J1 in place of J2", omega_n(|r, k, [j1, _]| r.c - k * j1 * r.n2_inverse)),
        ("(15): n2_inverse left out", omega_n(|r, k, [_, j2]| r.c - k * j2)),
        ("(15): C left out", omega_n(|r, k, [_, j2]| -k * j2 * r.n2_inverse)),
        ("(15): sign of the whole reversed", omega_n(|r, k, [_, j2]| k * j2 * r.n2_inverse - r.c)),
        ("(15): transposed", omega_n(|r, k, j| (RIGHT.omega_n)(r, k, j).transpose())),
        ("(16): halves forgotten", split(|w| [w.m11 + w.m22, w.m21 - w.m12])),
        ("(16): sum for omega_k", split(|w| [(w.m11 + w.m22) / 2.0, (w.m21 + w.m12) / 2.0])),
        ("(16): difference for omega_g", split(|w| [(w.m11 - w.m22) / 2.0, (w.m21 - w.m12) / 2.0])),
        ("(16): omega_k from the other element, its sign forgotten", split(|w| [w.m11, w.m12])),
    ]
}

/// Eq. (8).
fn constant_drifts() -> Vec<Wrong> {
    let omega_0 = |omega_0| Software { omega_0, ..RIGHT };
    let mean = |mean| Software { mean, ..RIGHT };
    vec![
        ("(8): omega_n n left out", omega_0(|at, k, _| at.omega - k * at.current)),
        ("(8): K J left out", omega_0(|at, _, w| at.omega - w * at.n)),
        ("(8): omega left out", omega_0(|at, k, w| -k * at.current - w * at.n)),
        ("(8): sign of omega_n n", omega_0(|at, k, w| at.omega - k * at.current + w * at.n)),
        ("(8): sign of K J", omega_0(|at, k, w| at.omega + k * at.current - w * at.n)),
        ("(8): sign of the whole", omega_0(|at, k, w| k * at.current + w * at.n - at.omega)),
        ("(8): K transposed", omega_0(|at, k, w| at.omega - k.transpose() * at.current - w * at.n)),
        ("(8): omega_n transposed", omega_0(|at, k, w| at.omega - k * at.current - w.transpose() * at.n)),
        (
            "(8): omega_n times n element by element",
            omega_0(|at, k, w| at.omega - k * at.current - w.diagonal().component_mul(&at.n)),
        ),
        ("(8): sum in place of the mean", mean(|each| each.iter().sum())),
        ("(8): sum of all positions divided by eight", mean(|each| each.iter().sum::<Vector2<f64>>() / 8.0)),
        ("(8): mean over one position less", mean(|each| each.iter().sum::<Vector2<f64>>() / (each.len() - 1) as f64)),
        ("(8): divided by the count twice", mean(|each| (RIGHT.mean)(each) / each.len() as f64)),
    ]
}

/// The right numbers in the wrong places.
fn telling() -> Vec<Wrong> {
    /// Tells for each of K_x, K_xy, K_yx, K_y the one at that place.
    fn k_from(told: &mut [f64; 8], places: [usize; 4]) {
        let k = places.map(|place| told[place]);
        told[..4].copy_from_slice(&k);
    }
    let tell = |tell| Software { tell, ..RIGHT };
    vec![
        ("K transposed: K_xy and K_yx exchanged", tell(|told| k_from(told, [0, 2, 1, 3]))),
        ("K_x and K_y exchanged", tell(|told| k_from(told, [3, 1, 2, 0]))),
        ("x and y of K exchanged", tell(|told| k_from(told, [3, 2, 1, 0]))),
        ("columns of K exchanged", tell(|told| k_from(told, [1, 0, 3, 2]))),
        ("rows of K exchanged", tell(|told| k_from(told, [2, 3, 0, 1]))),
        ("K made symmetric", tell(|told| (told[1], told[2]) = ((told[1] + told[2]) / 2.0, (told[1] + told[2]) / 2.0))),
        ("K_yx taken for -K_xy", tell(|told| told[2] = -told[1])),
        ("K_y taken for K_x", tell(|told| k_from(told, [0, 1, 2, 0]))),
        ("omega_0x and omega_0y exchanged", tell(|told| told.swap(4, 5))),
        ("omega_g and omega_k exchanged", tell(|told| told.swap(6, 7))),
        ("sizes without signs", tell(|told| *told = told.map(f64::abs))),
    ]
}

/// The sign of each number by itself.
fn signs() -> Vec<Wrong> {
    let tell = |tell| Software { tell, ..RIGHT };
    vec![
        ("sign of K_x", tell(|told| told[0] *= -1.0)),
        ("sign of K_xy", tell(|told| told[1] *= -1.0)),
        ("sign of K_yx", tell(|told| told[2] *= -1.0)),
        ("sign of K_y", tell(|told| told[3] *= -1.0)),
        ("sign of omega_0x", tell(|told| told[4] *= -1.0)),
        ("sign of omega_0y", tell(|told| told[5] *= -1.0)),
        ("sign of omega_g", tell(|told| told[6] *= -1.0)),
        ("sign of omega_k", tell(|told| told[7] *= -1.0)),
    ]
}
