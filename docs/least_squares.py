"""Verifies a passport with OpenSSH and fits all currents by least squares. Needs PyYAML, NumPy, ssh-keygen.

Usage: python least_squares.py PASSPORT.yaml CURRENTS.csv SIGNERS ISSUER
"""
import csv, sys
import numpy as np
from passport_content import verified

passport, currents, signers, issuer = sys.argv[1:]
vectors = verified(passport, signers, issuer)["vectors"]

current = {}
for row in csv.DictReader(line for line in open(currents, encoding="utf-8-sig") if not line.startswith("#")):
    at = int(row["i"]), int(row["j"])
    if at in current:
        sys.exit(f"{currents}: refused: a second row for position {at}; give the mean, or use `dtg-passport calibrate`")
    current[at] = float(row["jx_ma"]), float(row["jy_ma"])
if current.keys() != {(at["i"], at["j"]) for at in vectors}:
    sys.exit(f"{currents}: refused: its positions are not those of the passport")

# K J + omega_0 + omega_n n = omega_3, eq. (5); unknown: K row by row, omega_0, omega_g, omega_k
a, b = [], []
for at in vectors:
    (jx, jy), (c, d) = current[at["i"], at["j"]], at["specific_force_g"]
    a += [[jx, jy, 0, 0, 1, 0, c, -d], [0, 0, jx, jy, 0, 1, d, c]]
    b += at["omega_deg_per_h"]
kx, kxy, kyx, ky, x, y, omega_g, omega_k = np.linalg.lstsq(np.array(a), np.array(b), rcond=None)[0]
print(f"K = {kx:.5f}, {kxy:.5f}; {kyx:.5f}, {ky:.5f} °/(h·mA)")
print(f"omega_0 = {x:.5f}, {y:.5f} °/h")
print(f"omega_g = {omega_g:.5f}, omega_k = {omega_k:.5f} °/(h·g)")
