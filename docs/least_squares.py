"""Verifies a passport with OpenSSH and fits all currents by least squares. Needs PyYAML, NumPy, ssh-keygen.

Usage: python least_squares.py PASSPORT.yaml CURRENTS.csv SIGNERS ISSUER
"""
import csv, sys
import numpy as np
from passport_content import verified

# Far more than meter and gyro explain: 0.015 % of 0.3 mA are 0.004 °/h. `dtg-passport calibrate` tests with the stated u.
LIMIT_DEG_PER_H = 0.1

passport, currents, signers, issuer = sys.argv[1:]
vectors = verified(passport, signers, issuer)["vectors"]

current = {}
for row in csv.DictReader(line for line in open(currents, encoding="utf-8-sig") if not line.startswith("#")):
    try:
        at, each = (int(row["i"]), int(row["j"])), (float(row["jx_ma"]), float(row["jy_ma"]))
    except (KeyError, TypeError, ValueError) as error:
        sys.exit(f"{currents}: refused: {error!r} in {row}; expected the header i,j,jx_ma,jy_ma, and decimal points")
    if at in current:
        sys.exit(f"{currents}: refused: a second row for position {at}; give the mean, or use `dtg-passport calibrate`")
    current[at] = each
if current.keys() != {(at["i"], at["j"]) for at in vectors}:
    sys.exit(f"{currents}: refused: its positions are not those of the passport")

# K J + omega_0 + omega_n n = omega_3, eq. (5); unknown: K row by row, omega_0, omega_g, omega_k
a, b = [], []
for at in vectors:
    (jx, jy), (c, d) = current[at["i"], at["j"]], at["specific_force_g"]
    a += [[jx, jy, 0, 0, 1, 0, c, -d], [0, 0, jx, jy, 0, 1, d, c]]
    b += at["omega_deg_per_h"]
found = np.linalg.lstsq(np.array(a), np.array(b), rcond=None)[0]
scatter = np.sqrt(np.sum((np.array(a) @ found - b) ** 2) / (len(b) - len(found))) if len(b) > len(found) else 0.0
if scatter > LIMIT_DEG_PER_H:
    sys.exit(f"{currents}: refused: the residuals scatter by {scatter:.3f} °/h; the readings do not fit this stand and site")
kx, kxy, kyx, ky, x, y, omega_g, omega_k = found
print(f"K = {kx:.5f}, {kxy:.5f}; {kyx:.5f}, {ky:.5f} °/(h·mA)")
print(f"omega_0 = {x:.5f}, {y:.5f} °/h")
print(f"omega_g = {omega_g:.5f}, omega_k = {omega_k:.5f} °/(h·g)")
