"""A calibration in GTC: standard uncertainties, covariances, degrees of freedom by its own automatic derivatives.

Reads a list of cases (JSON) from standard input: positions, Earth rate, inputs with their uncertainties, currents. Writes
for each the covariance of the parameters of the closed solution, and their effective degrees of freedom. Nothing here
knows how the program computes its derivatives.
"""
import json
import sys

from GTC import cos, dof, get_covariance, sin, ureal

INFINITY = float("inf")


def quantity(estimate, u, df=INFINITY):
    return ureal(estimate, u, INFINITY if df is None else df) if u > 0 else estimate


def matrix(a, b):
    """a b for lists of rows."""
    return [[sum((a[i][k] * b[k][j] for k in range(len(b))), 0.0) for j in range(len(b[0]))] for i in range(len(a))]


def minus(a, b):
    return [[x - y for x, y in zip(p, q)] for p, q in zip(a, b)]


def inverse(m):
    (a, b), (c, d) = m
    determinant = a * d - b * c
    return [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]


def turn(x, y, z):
    """Coordinates turned by a small vector, to first order: v + v x delta."""
    return [[1.0, z, -y], [-z, 1.0, x], [y, -x, 1.0]]


def rx(angle):
    return [[1.0, 0.0, 0.0], [0.0, cos(angle), sin(angle)], [0.0, -sin(angle), cos(angle)]]


def ry(angle):
    return [[cos(angle), 0.0, -sin(angle)], [0.0, 1.0, 0.0], [sin(angle), 0.0, cos(angle)]]


def rz(angle):
    return [[cos(angle), sin(angle), 0.0], [-sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]]


def solve(case):
    u = case["u"]
    platform = turn(*(quantity(0.0, u["platform"]) for _ in "xyz"))
    seat = turn(*(quantity(0.0, s) for s in u["seat"]))
    base = turn(*(quantity(0.0, u["base"]) for _ in "xyz"))
    level = turn(quantity(0.0, u["level"]), quantity(0.0, u["level"]), quantity(0.0, u["azimuth"]))
    latitude = quantity(case["latitude"], u["latitude"]) + quantity(0.0, u["deflection"])
    rate = case["rate"]
    earth = [[0.0], [rate * cos(latitude)], [rate * sin(latitude)]]
    gain = 1.0 + quantity(0.0, u["gain"])
    offset = quantity(0.0, u["offset"])
    n, omega, j = [], [], []
    for at in case["positions"]:
        angles = [quantity(a, s, at["df"]) for a, s in zip(at["angles"], at["u"])]
        e = matrix(rz(angles[2]), matrix(ry(angles[1]), rx(angles[0])))
        attitude = matrix(e, matrix(at["nominal"], matrix(base, level)))
        attitude = matrix(platform, attitude)
        back = turn(*(quantity(0.0, u["return"]) for _ in "xyz"))
        attitude = matrix(back, matrix(seat, attitude))
        pair = []
        for current in at["currents"]:
            own = 1.0 + quantity(0.0, u["reading"])
            pair.append(current * own * gain + offset + quantity(0.0, u["floor"]))
        j.append(pair)
        n.append([attitude[0][2], attitude[1][2]])
        w = matrix(attitude, earth)
        omega.append([w[0][0], w[1][0]])
    return n, omega, j


def differences(x):
    def columns(a, b, c, d):
        return [[a[0] - b[0], c[0] - d[0]], [a[1] - b[1], c[1] - d[1]]]

    return columns(x[0], x[2], x[1], x[3]), columns(x[4], x[6], x[5], x[7])


def passport(n, omega):
    (n1, n2), (w1, w2) = differences(n), differences(omega)
    n2_inverse = inverse(n2)
    delta = matrix(n2_inverse, n1)
    return delta, minus(w1, matrix(w2, delta)), matrix(w2, n2_inverse), n2_inverse


def flat(*matrices):
    return [x for m in matrices for row in m for x in row]


def covariance(numbers):
    return [[get_covariance(a, b) for b in numbers] for a in numbers]


def budget(case):
    n, omega, j = solve(case)
    delta, b, c, n2_inverse = passport(n, omega)
    j1, j2 = differences(j)
    k = matrix(b, inverse(minus(j1, matrix(j2, delta))))
    wn = minus(c, matrix(matrix(k, j2), n2_inverse))
    omega0 = []
    for axis in range(2):
        terms = []
        for at, w, current in zip(n, omega, j):
            kj = k[axis][0] * current[0] + k[axis][1] * current[1]
            terms.append(w[axis] - kj - wn[axis][0] * at[0] - wn[axis][1] * at[1])
        omega0.append(sum(terms, 0.0) / len(terms))
    parameters = flat(k) + omega0 + [(wn[0][0] + wn[1][1]) / 2, (wn[1][0] - wn[0][1]) / 2]
    return {
        "covariance": covariance(parameters),
        "degrees_of_freedom": [d if (d := dof(p)) < 1e300 else None for p in parameters],
    }


json.dump([budget(case) for case in json.load(sys.stdin)], sys.stdout)
