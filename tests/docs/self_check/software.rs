//! Laboratory software for the paper's closed solution, each step of which can be replaced; it shares no code with the library.

use dtg_passport::passport::Content;
use nalgebra::{Matrix2, Vector2};

/// One position of a passport, and the currents of its self-check there.
#[derive(Clone, Copy)]
pub struct At {
    pub i: u32,
    pub j: u32,
    pub n: Vector2<f64>,
    pub omega: Vector2<f64>,
    pub current: Vector2<f64>,
}

/// What software reads from a passport, in the passport's order.
#[derive(Clone)]
pub struct Read {
    pub delta: Matrix2<f64>,
    pub b: Matrix2<f64>,
    pub c: Matrix2<f64>,
    pub n1: Matrix2<f64>,
    pub n2: Matrix2<f64>,
    pub n2_inverse: Matrix2<f64>,
    pub omega1: Matrix2<f64>,
    pub at: Vec<At>,
}

fn matrix(rows: &[[f64; 2]; 2]) -> Matrix2<f64> {
    Matrix2::new(rows[0][0], rows[0][1], rows[1][0], rows[1][1])
}

impl Read {
    pub fn of(content: &Content) -> Self {
        let matrices = content.matrices.as_ref().unwrap();
        let currents = &content.self_check.as_ref().unwrap().currents;
        let at = content.vectors.iter().zip(currents).map(|(at, current)| {
            assert_eq!((at.i, at.j), (current.i, current.j));
            let (n, omega) = (at.specific_force_g.into(), at.omega_deg_per_h.into());
            At { i: at.i, j: at.j, n, omega, current: Vector2::new(current.jx_ma, current.jy_ma) }
        });
        Self {
            delta: matrix(&matrices.delta),
            b: matrix(&matrices.b_deg_per_h),
            c: matrix(&matrices.c_deg_per_h_per_g),
            n1: matrix(&matrices.n1),
            n2: matrix(&matrices.n2),
            n2_inverse: matrix(&matrices.n2_inverse),
            omega1: matrix(&matrices.omega1_deg_per_h),
            at: at.collect(),
        }
    }

    pub fn find(&self, i: u32, j: u32) -> &At {
        self.at.iter().find(|at| (at.i, at.j) == (i, j)).unwrap()
    }

    pub fn matrices(&mut self) -> [&mut Matrix2<f64>; 4] {
        [&mut self.delta, &mut self.b, &mut self.c, &mut self.n2_inverse]
    }

    pub fn currents(&mut self) -> impl Iterator<Item = &mut Vector2<f64>> {
        self.at.iter_mut().map(|at| &mut at.current)
    }

    /// X_i of the quantity `x`: (x_i1 − x_i3, x_i2 − x_i4) as columns, eq. (9)-(11).
    pub fn differences(&self, i: u32, x: fn(&At) -> Vector2<f64>) -> Matrix2<f64> {
        let x = |j| x(self.find(i, j));
        Matrix2::from_columns(&[x(1) - x(3), x(2) - x(4)])
    }
}

pub fn inverse(matrix: Matrix2<f64>) -> Matrix2<f64> {
    matrix.try_inverse().unwrap_or_else(|| Matrix2::repeat(f64::NAN))
}

/// A matrix of the positions with θ = 0° and one of those with θ = 90°.
pub type Pair = [Matrix2<f64>; 2];

/// The steps of the software, in their order.
pub struct Software {
    /// Changes what was read.
    pub read: fn(&mut Read),
    /// J_1 and J_2, eq. (11).
    pub pairs: fn(&Read) -> Pair,
    /// K, eq. (13).
    pub k: fn(&Read, Matrix2<f64>, Matrix2<f64>) -> Matrix2<f64>,
    /// ω_n from K, J_1 and J_2, eq. (15).
    pub omega_n: fn(&Read, Matrix2<f64>, Pair) -> Matrix2<f64>,
    /// ω_g and ω_k, eq. (16).
    pub split: fn(Matrix2<f64>) -> [f64; 2],
    /// One position's ω_0 from K and ω_n, eq. (8).
    pub omega_0: fn(&At, Matrix2<f64>, Matrix2<f64>) -> Vector2<f64>,
    /// The mean of them over the positions.
    pub mean: fn(&[Vector2<f64>]) -> Vector2<f64>,
    /// Changes what is told: K_x, K_xy, K_yx, K_y, ω_0x, ω_0y, ω_g, ω_k.
    pub tell: fn(&mut [f64; 8]),
}

/// The paper's equations.
pub const RIGHT: Software = Software {
    read: |_| {},
    pairs: |read| [read.differences(1, |at| at.current), read.differences(2, |at| at.current)],
    k: |read, j1, j2| read.b * inverse(j1 - j2 * read.delta),
    omega_n: |read, k, [_, j2]| read.c - k * j2 * read.n2_inverse,
    split: |omega_n| [(omega_n.m11 + omega_n.m22) / 2.0, (omega_n.m21 - omega_n.m12) / 2.0],
    omega_0: |at, k, omega_n| at.omega - k * at.current - omega_n * at.n,
    mean: |each| each.iter().sum::<Vector2<f64>>() / each.len() as f64,
    tell: |_| {},
};

impl Software {
    pub fn calibrate(&self, mut read: Read) -> [f64; 8] {
        (self.read)(&mut read);
        let pairs = (self.pairs)(&read);
        let k = (self.k)(&read, pairs[0], pairs[1]);
        let omega_n = (self.omega_n)(&read, k, pairs);
        let [omega_g, omega_k] = (self.split)(omega_n);
        let each: Vec<_> = read.at.iter().map(|at| (self.omega_0)(at, k, omega_n)).collect();
        let omega_0 = (self.mean)(&each);
        let mut told = [k.m11, k.m12, k.m21, k.m22, omega_0.x, omega_0.y, omega_g, omega_k];
        (self.tell)(&mut told);
        told
    }
}
