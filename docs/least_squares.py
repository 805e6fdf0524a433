"""Verifies a passport's signature with OpenSSH and fits all currents by least squares. Needs PyYAML, NumPy, ssh-keygen.

What this signature check leaves open is in verifying.md. Usage: python least_squares.py PASSPORT.yaml CURRENTS.csv SIGNERS ISSUER
"""
import csv, re, subprocess, sys, tempfile
import numpy as np
import yaml

passport, currents, signers, issuer = sys.argv[1:]
text, _, armor = open(passport, encoding="utf-8", newline="").read().partition('signature: |\n')
issued_at = re.sub("[-:T]", "", re.search(r'^  issued_at: "(.*)"$', text, re.M)[1])
with tempfile.NamedTemporaryFile("w", newline="") as signature:
    signature.write(armor.replace("  ", ""))
    signature.flush()
    subprocess.run(
        ["ssh-keygen", "-Y", "verify", "-f", signers, "-I", issuer, "-n", "dtg-passport", "-O", f"verify-time={issued_at}", "-s", signature.name],
        input=text.encode(), stdout=subprocess.DEVNULL, check=True)
passport = yaml.safe_load(text)  # only now, and only what is signed
assert passport["passport"]["issuer"] == issuer

rows = csv.DictReader(line for line in open(currents) if not line.startswith("#"))
current = {(int(row["i"]), int(row["j"])): (float(row["jx_ma"]), float(row["jy_ma"])) for row in rows}

# K J + omega_0 + omega_n n = omega_3, eq. (5); unknown: K row by row, omega_0, omega_g, omega_k
a, b = [], []
for at in passport["vectors"]:
    (jx, jy), (c, d) = current[at["i"], at["j"]], at["specific_force_g"]
    a += [[jx, jy, 0, 0, 1, 0, c, -d], [0, 0, jx, jy, 0, 1, d, c]]
    b += at["omega_deg_per_h"]
kx, kxy, kyx, ky, x, y, omega_g, omega_k = np.linalg.lstsq(np.array(a), np.array(b), rcond=None)[0]
print(f"K = {kx:.5f}, {kxy:.5f}; {kyx:.5f}, {ky:.5f} deg/h/mA")
print(f"omega_0 = {x:.5f}, {y:.5f} deg/h")
print(f"omega_g = {omega_g:.5f}, omega_k = {omega_k:.5f} deg/h/g")
