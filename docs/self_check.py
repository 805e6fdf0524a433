"""Finds the gyro of a passport's self-check by the equations of the paper. Needs PyYAML, NumPy, ssh-keygen.

Usage: python self_check.py PASSPORT.yaml SIGNERS ISSUER. Exit code 1: refused, or a number is off by more than 1e-9 of itself.
"""
import sys
import numpy as np
from passport_content import verified

passport = verified(*sys.argv[1:])
if "matrices" not in passport:
    sys.exit("no matrices: not all of the eight positions are there; fit all currents, as least_squares.py does")
matrix = {name: np.array(rows) for name, rows in passport["matrices"].items()}
check = passport["self_check"]
current = {(at["i"], at["j"]): np.array([at["jx_ma"], at["jy_ma"]]) for at in check["currents"]}
vectors = [((at["i"], at["j"]), np.array(at["omega_deg_per_h"]), np.array(at["specific_force_g"])) for at in passport["vectors"]]
j1, j2 = (np.column_stack([current[i, 1] - current[i, 3], current[i, 2] - current[i, 4]]) for i in (1, 2))  # (11)
k = matrix["b_deg_per_h"] @ np.linalg.inv(j1 - j2 @ matrix["delta"])  # (13)
omega_n = matrix["c_deg_per_h_per_g"] - k @ j2 @ matrix["n2_inverse"]  # (15)
omega_g, omega_k = (omega_n[0, 0] + omega_n[1, 1]) / 2, (omega_n[1, 0] - omega_n[0, 1]) / 2  # (16)
omega0 = np.mean([omega - k @ current[at] - omega_n @ n for at, omega, n in vectors], axis=0)  # (8)
found = {"k_deg_per_h_per_ma": k, "omega0_deg_per_h": omega0, "omega_g_deg_per_h_per_g": omega_g, "omega_k_deg_per_h_per_g": omega_k}
off = {name: np.max(np.abs(value / np.array(check[name]) - 1)) for name, value in found.items()}
for name, value in found.items():
    print(f"{name}: {np.array(value).tolist()}, off by {off[name]:.0e}")
sys.exit(int(not np.max(list(off.values())) <= 1e-9))  # a NaN is off, too
