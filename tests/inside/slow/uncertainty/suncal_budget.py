"""A calibration in suncal: its own Monte Carlo of the closed solution in plain NumPy.

Reads a list of cases like that of gtc_budget.py, and writes the standard uncertainties of the eight parameters for each.
"""
import json
import sys

import numpy as np
import suncal

def turned(v, d):
    return [v[0] + v[1] * d[2] - v[2] * d[1], v[1] + v[2] * d[0] - v[0] * d[2], v[2] + v[0] * d[1] - v[1] * d[0]]


def inverse(m):
    f = 1.0 / (m[0][0] * m[1][1] - m[0][1] * m[1][0])
    return [[m[1][1] * f, -m[0][1] * f], [-m[1][0] * f, m[0][0] * f]]


def times(a, b):
    return [[a[i][0] * b[0][j] + a[i][1] * b[1][j] for j in (0, 1)] for i in (0, 1)]


def minus(a, b):
    return [[a[i][j] - b[i][j] for j in (0, 1)] for i in (0, 1)]


def pair(x, a, b, c, d):
    return [[x[a][i] - x[b][i], x[c][i] - x[d][i]] for i in (0, 1)]


def inputs(case):
    """Names of all uncertain inputs with their standard uncertainties."""
    u = case["u"]
    found = {}
    for p, at in enumerate(case["positions"]):
        for axis in range(3):
            found[f"angle_{p}_{axis}"] = at["u"][axis]
            found[f"back_{p}_{axis}"] = u["return"]
        for axis in range(2):
            found[f"reading_{p}_{axis}"] = u["reading"]
            found[f"floor_{p}_{axis}"] = u["floor"]
    for axis in range(3):
        found[f"platform_{axis}"] = u["platform"]
        found[f"seat_{axis}"] = u["seat"][axis]
        found[f"base_{axis}"] = u["base"]
        found[f"level_{axis}"] = u["azimuth"] if axis == 2 else u["level"]
    found.update({name: u[name] for name in ("latitude", "deflection", "gain", "offset")})
    return {name: spread for name, spread in found.items() if spread > 0}


def gyro(case, errors):
    def small(name):
        return [errors.get(f"{name}_{axis}", 0.0) for axis in range(3)]

    latitude = case["latitude"] + errors.get("latitude", 0.0) + errors.get("deflection", 0.0)
    earth = [0.0, case["rate"] * np.cos(latitude), case["rate"] * np.sin(latitude)]
    base = [a + b for a, b in zip(small("base"), small("level"))]
    vectors = [turned([0.0, 0.0, 1.0], base), turned(earth, base)]
    n, w, j = [], [], []
    for p, at in enumerate(case["positions"]):
        a, b, g = (x + e for x, e in zip(at["angles"], small(f"angle_{p}")))
        parts = zip(small(f"back_{p}"), small("platform"), small("seat"))
        seat = [x + y + z for x, y, z in parts]
        seen = []
        for vector in vectors:
            v = [sum(row[k] * vector[k] for k in range(3)) for row in at["nominal"]]
            v = [v[0], np.cos(a) * v[1] + np.sin(a) * v[2], np.cos(a) * v[2] - np.sin(a) * v[1]]
            v = [np.cos(b) * v[0] - np.sin(b) * v[2], v[1], np.sin(b) * v[0] + np.cos(b) * v[2]]
            v = [np.cos(g) * v[0] + np.sin(g) * v[1], np.cos(g) * v[1] - np.sin(g) * v[0], v[2]]
            seen.append(turned(v, seat))
        n.append(seen[0])
        w.append(seen[1])
        j.append(
            [
                x * (1.0 + errors[f"reading_{p}_{axis}"]) * (1.0 + errors["gain"])
                + errors["offset"]
                + errors[f"floor_{p}_{axis}"]
                for axis, x in enumerate(at["currents"])
            ]
        )
    first, second = (0, 2, 1, 3), (4, 6, 5, 7)
    n1, n2, w1, w2, j1, j2 = (pair(x, *places) for x in (n, w, j) for places in (first, second))
    n2_inverse = inverse(n2)
    delta = times(n2_inverse, n1)
    k = times(minus(w1, times(w2, delta)), inverse(minus(j1, times(j2, delta))))
    wn = times(minus(w2, times(k, j2)), n2_inverse)
    o = [
        sum(w[p][i] - k[i][0] * j[p][0] - k[i][1] * j[p][1] - wn[i][0] * n[p][0] - wn[i][1] * n[p][1] for p in range(8)) / 8
        for i in (0, 1)
    ]
    return (*k[0], *k[1], *o, (wn[0][0] + wn[1][1]) / 2, (wn[1][0] - wn[0][1]) / 2)


OUTPUTS = ["k_x", "k_xy", "k_yx", "k_y", "omega_0x", "omega_0y", "omega_g", "omega_k"]


def uncertainties(case):
    spreads = inputs(case)
    model = suncal.ModelCallable(lambda **errors: gyro(case, errors), names=OUTPUTS, argnames=list(spreads))
    for name, spread in spreads.items():
        model.var(name).measure(0.0).typeb(std=spread)
    np.random.seed(1)
    trials = model.monte_carlo(samples=int(case["samples"]))
    return [float(trials.uncertainty[name]) for name in OUTPUTS]


json.dump([uncertainties(case) for case in json.load(sys.stdin)], sys.stdout)
