"""The peer of benches/monte_carlo.rs: the same trials in NumPy, in the best layout found for it.

Component first (a row is one number of every trial of a chunk), 2x2 matrices written out, chunks that stay in the cache
(the best of several sizes counts), the fastest generator of NumPy, one core. Reads the case as JSON from standard input
and prints nanoseconds a trial (wall clock, processor) and standard deviations for both kinds of work.
"""
import json
import os
import sys
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"
import numpy as np

case = json.load(sys.stdin)
certified = np.array(case["angles_rad"]).T[:, :, None]  # 3 x 8 x 1
u_angle = case["u_angle_rad"]
v = np.array(case["vertical"]).T[:, :, None]  # A z, 3 x 8 x 1
w = np.array(case["earth"]).T[:, :, None]  # A w
means = np.array(case["currents_ma"]).T[:, :, None]  # 2 x 8 x 1
limit = case["reading_limit"]
weights = np.array(case["weights"]).T[:, :, None]  # p11, p12, p22: 3 x 8 x 1
generator = np.random.Generator(np.random.SFC64(1))


def seen(m, normals, units):
    """n, omega and currents of m trials: 2 x 8 x m each."""
    generator.standard_normal(out=normals)
    generator.standard_normal(out=units)
    np.multiply(normals, u_angle, out=normals)
    angles = normals.reshape(3, 8, m)
    angles += certified
    sa, sb, sg = np.sin(angles)
    ca, cb, cg = np.cos(angles)

    def turned(x):
        y1 = ca * x[1] + sa * x[2]
        z1 = ca * x[2] - sa * x[1]
        x2 = cb * x[0] - sb * z1
        return cg * x2 + sg * y1, cg * y1 - sg * x2

    units *= limit / 3.0**0.5
    units += 1.0
    return turned(v), turned(w), means * units.reshape(2, 8, m)


def differences(x, first):
    """X_1 (first = 0) or X_2 (first = 4) by elements."""
    a, b, c, d = first, first + 2, first + 1, first + 3
    return x[0][a] - x[0][b], x[0][c] - x[0][d], x[1][a] - x[1][b], x[1][c] - x[1][d]


def times(a, b):
    return a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2], a[2] * b[1] + a[3] * b[3]


def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]


def inverse(a):
    factor = 1.0 / (a[0] * a[3] - a[1] * a[2])
    return a[3] * factor, -a[1] * factor, -a[2] * factor, a[0] * factor


def analytic(n, omega, j):
    n1, n2, w1, w2 = differences(n, 0), differences(n, 4), differences(omega, 0), differences(omega, 4)
    j1, j2 = differences(j, 0), differences(j, 4)
    n2_inverse = inverse(n2)
    delta = times(n2_inverse, n1)
    k = times(minus(w1, times(w2, delta)), inverse(minus(j1, times(j2, delta))))
    wn = times(minus(w2, times(k, j2)), n2_inverse)
    sums = [x.sum(axis=0) for pair in (omega, j, n) for x in pair]
    o_x = (sums[0] - (k[0] * sums[2] + k[1] * sums[3] + wn[0] * sums[4] + wn[1] * sums[5])) / 8
    o_y = (sums[1] - (k[2] * sums[2] + k[3] * sums[3] + wn[2] * sums[4] + wn[3] * sums[5])) / 8
    return (*k, o_x, o_y, 0.5 * (wn[0] + wn[3]), 0.5 * (wn[2] - wn[1]))


def least_squares(n, omega, j):
    """One linear weighted fit: sums of products by elements, then LAPACK on all 8x8 systems at once."""
    p11, p12, p22 = weights
    (nx, ny), (wx, wy), (jx, jy) = n, omega, j
    m = jx.shape[1]
    g1, g2 = p11 * nx + p12 * ny, p12 * nx + p22 * ny
    k1, k2 = p12 * nx - p11 * ny, p22 * nx - p12 * ny
    e1, e2 = p11 * wx + p12 * wy, p12 * wx + p22 * wy
    xx, xy, yy = jx * jx, jx * jy, jy * jy
    total = np.sum
    normal = np.empty((m, 8, 8))
    lower = [
        [p11 * xx],
        [p11 * xy, p11 * yy],
        [p12 * xx, p12 * xy, p22 * xx],
        [p12 * xy, p12 * yy, p22 * xy, p22 * yy],
        [p11 * jx, p11 * jy, p12 * jx, p12 * jy, p11],
        [p12 * jx, p12 * jy, p22 * jx, p22 * jy, p12, p22],
        [jx * g1, jy * g1, jx * g2, jy * g2, g1, g2, nx * g1 + ny * g2],
        [jx * k1, jy * k1, jx * k2, jy * k2, k1, k2, nx * k1 + ny * k2, nx * k2 - ny * k1],
    ]
    for row, elements in enumerate(lower):
        for column, element in enumerate(elements):
            normal[:, row, column] = normal[:, column, row] = total(element, axis=0)
    right = np.empty((m, 8, 1))
    for row, element in enumerate(
        (jx * e1, jy * e1, jx * e2, jy * e2, e1, e2, nx * e1 + ny * e2, nx * e2 - ny * e1)
    ):
        right[:, row, 0] = total(element, axis=0)
    return np.linalg.solve(normal, right)[:, :, 0].T


def rate(solve, m, seconds):
    """Nanoseconds a trial, by the wall clock and by the processor, and standard deviations, with chunks of m trials."""
    normals, units = np.empty((24, m)), np.empty((16, m))
    start_values = solve(*seen(m, normals, units))
    centre = np.array([x.mean() for x in start_values])
    sums, squares, trials = np.zeros(8), np.zeros(8), 0
    begin, begin_processor = time.perf_counter(), time.process_time()
    while (passed := time.perf_counter() - begin) < seconds:
        for place, x in enumerate(solve(*seen(m, normals, units))):
            x = x - centre[place]
            sums[place] += x.sum()
            squares[place] += x @ x
        trials += m
    processor = time.process_time() - begin_processor
    deviations = np.sqrt(squares / trials - (sums / trials) ** 2)
    return {"wall_ns": 1e9 * passed / trials, "processor_ns": 1e9 * processor / trials, "standard_deviations": list(deviations)}


best = {}
for name, solve, sizes in (("analytic", analytic, (250, 500, 1000, 2000)), ("least_squares", least_squares, (250, 1000))):
    tried = [rate(solve, m, case["seconds"]) for m in sizes for _ in range(2)]
    best[name] = min(tried, key=lambda one: one["processor_ns"])
json.dump(best, sys.stdout)
