#!/usr/bin/env python3
"""Writes frame_axis.json: orientation, specific force, Earth rate and currents of stands whose frame axis points to other
azimuths than the paper's east, in 60-digit arithmetic, rounded to binary64. Needs mpmath.

From the definitions alone: passive rotations, A = Rz(phi) Rx(theta), E = Rz(gamma) Ry(beta) Rx(alpha) (paper, eq. (3),
(4)), the base turned by Rz(90 deg - azimuth), and errors of level, azimuth and latitude as small rotations of it about
east, north and up, differentiated numerically.
"""

import json
import random
import sys
from pathlib import Path

from mpmath import cos, inverse, matrix, mp, mpf, pi, sin

mp.dps = 60
STEP = mpf(10) ** -20
RATE = mpf("7.292115e-5") * 3600 * 180 / pi
PAPER = [(i, j, 90 * (i - 1), 90 * (j - 1)) for i in (1, 2) for j in (1, 2, 3, 4)]
TURNED = [(i, j, 90 * (i - 1), 90 * (j - 1)) for i in (2, 4) for j in (1, 2, 3, 4)]
GYRO = {"k": [[95, 9.3], [-8.7, 93]], "omega0": [20, -15], "omega_g": 10, "omega_k": -7}
CASES = [(0, 55.7658, PAPER + TURNED[4:]), (37.5, -33.5, PAPER), (123.456, 78.93, TURNED), (270, 12.25, TURNED + [(7, 1, 33, 71.5)])]


def rotation(axis, angle):
    s, c = sin(angle), cos(angle)
    return matrix([
        [[1, 0, 0], [0, c, s], [0, -s, c]],
        [[c, 0, -s], [0, 1, 0], [s, 0, c]],
        [[c, s, 0], [-s, c, 0], [0, 0, 1]],
    ][axis])


def rad(degrees):
    return mpf(degrees) * pi / 180


def rounded(value):
    """Of 60 digits what is left of a zero is a zero."""
    return 0.0 if abs(value) < mpf(10) ** -30 else float(value)


def case(azimuth, latitude, positions, draw):
    def vectors(attitude, error, size):
        """omega and n in case axes, with the base turned by `size` about axis `error`, or the latitude changed by it."""
        phi = rad(latitude) + (size if error == 3 else 0)
        base = rotation(2, rad(90 - mpf(azimuth)))
        if error < 3:
            base = base * rotation(error, size)
        seen = attitude * base
        return [seen * matrix([0, RATE * cos(phi), RATE * sin(phi)]), seen * matrix([0, 0, 1])]

    k = matrix(GYRO["k"])
    omega_n = matrix([[GYRO["omega_g"], -GYRO["omega_k"]], [GYRO["omega_k"], GYRO["omega_g"]]])
    lines = []
    for i, j, theta, phi in positions:
        arcsec = [draw.uniform(-36000, 36000) for _ in range(3)]
        alpha, beta, gamma = (rad(mpf(value) / 3600) for value in arcsec)
        attitude = rotation(2, gamma) * rotation(1, beta) * rotation(0, alpha) * rotation(2, rad(phi)) * rotation(0, rad(theta))
        omega, n = vectors(attitude, 0, mpf(0))
        current = inverse(k) * (omega[:2] - matrix(GYRO["omega0"]) - omega_n * n[:2])
        changes = []
        for error in range(4):
            above, below = vectors(attitude, error, STEP), vectors(attitude, error, -STEP)
            changes.append([rounded((above[v][a] - below[v][a]) / (2 * STEP)) for v in (0, 1) for a in (0, 1)])
        lines.append({
            "i": i, "j": j, "theta_deg": theta, "phi_deg": phi, "deviations_arcsec": arcsec,
            "n": [rounded(n[0]), rounded(n[1])], "n_z": rounded(n[2]), "omega_deg_per_h": [rounded(omega[0]), rounded(omega[1])],
            "currents_ma": [float(current[0]), float(current[1])], "changes_east_north_up_latitude": changes,
        })
    return {"frame_axis_azimuth_deg": azimuth, "latitude_deg": latitude, "positions": lines}


def main():
    draw = random.Random(14)
    text = '{\n "about": "written by frame_axis.py",\n "gyro": ' + json.dumps(GYRO) + ',\n "cases": ['
    for number, (azimuth, latitude, positions) in enumerate(CASES):
        found = case(azimuth, latitude, positions, draw)
        lines = ",\n   ".join(json.dumps(line) for line in found.pop("positions"))
        text += ("," if number else "") + "\n  " + json.dumps(found)[:-1] + ', "positions": [\n   ' + lines + "]}"
    text += "]\n}\n"
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_suffix(".json")
    path.write_text(text)


main()
