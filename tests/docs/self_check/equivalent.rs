//! Other ways to the same numbers. On exact data all equations hold in every position, so each of these is right there, however
//! differently it treats the errors of real readings.

use super::software::{At, RIGHT, Read, Software, inverse};
use nalgebra::{DMatrix, DVector, Matrix2};

/// What it does, why its numbers are the same, and the whole of it.
pub type Equivalent = (&'static str, &'static str, fn(Read) -> [f64; 8]);

pub fn all() -> Vec<Equivalent> {
    vec![
        ("(8): mean over the eight positions of the paper alone", "every position gives the same omega_0", |read| {
            let pick = |read: &mut Read| read.at.retain(|at| at.i <= 2 && at.j <= 4);
            Software { read: pick, ..RIGHT }.calibrate(read)
        }),
        ("(8): one position in place of the mean", "every position gives the same omega_0", |read| {
            Software { mean: |each| each[each.len() - 1], ..RIGHT }.calibrate(read)
        }),
        (
            "(16): omega_g and omega_k from the first column alone",
            "omega_n of (15) has the form that (5) gives it",
            |read| Software { split: |w| [w.m11, w.m21], ..RIGHT }.calibrate(read),
        ),
        ("(8): omega_n made of omega_g and omega_k", "omega_n of (15) has the form that (5) gives it", |read| {
            let omega_0 = |at: &At, k, w| {
                let [g, o] = (RIGHT.split)(w);
                at.omega - k * at.current - Matrix2::new(g, -o, o, g) * at.n
            };
            Software { omega_0, ..RIGHT }.calibrate(read)
        }),
        ("(13): its first form, B J1^-1 (1 - J2 Delta J1^-1)^-1", "the same matrix, where J1 has an inverse", |read| {
            let k = |r: &Read, j1, j2| r.b * inverse(j1) * inverse(Matrix2::identity() - j2 * r.delta * inverse(j1));
            Software { k, ..RIGHT }.calibrate(read)
        }),
        ("(17)-(19): the iteration until nothing moves", "its fixed point is (13)", |read| {
            let k = |r: &Read, j1, j2| {
                let next = |k: Matrix2<f64>| (r.omega1 - (r.c - k * j2 * r.n2_inverse) * r.n1) * inverse(j1);
                (0..200).fold(r.omega1 * inverse(j1), |k, _| next(k))
            };
            Software { k, ..RIGHT }.calibrate(read)
        }),
        (
            "Delta, B, C and n2_inverse from the vectors, the matrices left unread",
            "they follow from n and omega by (9)-(15)",
            |read| Software { read: from_vectors, ..RIGHT }.calibrate(read),
        ),
        (
            "all differences taken the other way round, n and omega too",
            "a reversed sign of both sides of (9) and (10)",
            |mut read| {
                from_vectors(&mut read);
                // Of Delta, B, C only B changes its sign with the differences, and (15) has J2 and n2 alike.
                (read.b, read.n2_inverse) = (-read.b, -read.n2_inverse);
                let pairs = |read: &Read| (RIGHT.pairs)(read).map(|differences| -differences);
                Software { pairs, ..RIGHT }.calibrate(read)
            },
        ),
        ("rows in another order, found by their i and j", "no equation depends on the order", |mut read| {
            read.at.reverse();
            RIGHT.calibrate(read)
        }),
        ("least squares of all positions", "the residuals are zero", |read| least_squares(&read, |_| 1.0)),
        ("least squares with any weights", "the residuals are zero", |read| {
            least_squares(&read, |at| 1.0 / (0.01 + at.current.norm()))
        }),
    ]
}

fn from_vectors(read: &mut Read) {
    let [n1, n2] = [1, 2].map(|i| read.differences(i, |at| at.n));
    let [omega1, omega2] = [1, 2].map(|i| read.differences(i, |at| at.omega));
    let n2_inverse = inverse(n2);
    let delta = n2_inverse * n1;
    let at = std::mem::take(&mut read.at);
    *read = Read { delta, b: omega1 - omega2 * delta, c: omega2 * n2_inverse, n1, n2, n2_inverse, omega1, at };
}

/// (5) for all positions at once: two equations each, eight unknowns.
fn least_squares(read: &Read, weight: fn(&At) -> f64) -> [f64; 8] {
    let rows = read.at.iter().flat_map(|at| {
        let ([jx, jy], [c, d]) = (<[f64; 2]>::from(at.current), <[f64; 2]>::from(at.n));
        let rows = [[jx, jy, 0.0, 0.0, 1.0, 0.0, c, -d], [0.0, 0.0, jx, jy, 0.0, 1.0, d, c]];
        rows.map(|row| row.map(|x| x * weight(at)))
    });
    let rows: Vec<f64> = rows.flatten().collect();
    let due = read.at.iter().flat_map(|at| [at.omega.x * weight(at), at.omega.y * weight(at)]);
    let design = DMatrix::from_row_slice(rows.len() / 8, 8, &rows);
    let solved = design.svd(true, true).solve(&DVector::from_iterator(rows.len() / 8, due), 0.0).unwrap();
    std::array::from_fn(|place| solved[place])
}
