"""The peer of benches/issue.rs: the same passports from an honest factory in Python, one process.

NumPy computes all sites of a stand at once; PyYAML's C writer writes only what is new in a passport (the parts of the
stand and of the site are written once and reused); OpenSSL, through `cryptography`, signs in OpenSSH's framing; the file
is written beside its place and renamed. Where the fleet says "checked", every text is read back before it is signed, by
PyYAML's C reader, and every signature verified before the file is written, as the program does that it is compared with.
Reads the fleet as JSON from standard input, prints seconds (imports aside) and its numbers.
"""
import base64
import hashlib
import json
import os
import struct
import sys
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"
import numpy as np
import yaml
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

RATE_DEG_PER_H = 7.292115e-5 * (3600.0 * 180.0 / np.pi)
WITHIN_DEG_PER_H = 0.001
K = np.array([[95.0, 9.3], [-8.7, 93.0]])
OMEGA0 = np.array([20.0, -15.0])
OMEGA_G, OMEGA_K = 10.0, -7.0
STAND_KEYS = ("stand", "certificate", "datum", "positions")
OMEGA_N = np.array([[OMEGA_G, -OMEGA_K], [OMEGA_K, OMEGA_G]])


def dump(content):
    return yaml.dump(
        content, Dumper=yaml.CSafeDumper, sort_keys=False, default_flow_style=None, width=1 << 20, allow_unicode=True
    )


def rows(*elements):
    """A matrix for every entry of its elements, which may be arrays: ... x 3 x 3."""
    return np.stack(np.broadcast_arrays(*elements), axis=-1).reshape(-1, 3, 3)


def attitudes(positions):
    """E A of every position, paper eq. (3) and (4): positions x 3 x 3."""
    column = lambda key: np.array([position[key] for position in positions])
    theta, phi = np.radians(column("theta_deg")), np.radians(column("phi_deg"))
    a, b, g = (np.radians(column(key) / 3600.0) for key in ("alpha_arcsec", "beta_arcsec", "gamma_arcsec"))
    (st, ct), (sp, cp) = (np.sin(theta), np.cos(theta)), (np.sin(phi), np.cos(phi))
    (sa, ca), (sb, cb), (sg, cg) = ((np.sin(x), np.cos(x)) for x in (a, b, g))
    nominal = rows(cp, ct * sp, st * sp, -sp, ct * cp, st * cp, 0.0, -st, ct)
    deviation = rows(
        cb * cg, ca * sg + sa * sb * cg, sa * sg - ca * sb * cg,
        -cb * sg, ca * cg - sa * sb * sg, sa * cg + ca * sb * sg,
        sb, -sa * cb, ca * cb,
    )  # fmt: skip
    return deviation @ nominal


def differences(x):
    """X_1 and X_2 of vectors of the eight positions (... x 8 x 2), differences of opposite ones as columns."""
    column = lambda one, other: x[..., one, :] - x[..., other, :]
    return tuple(np.stack([column(i, i + 2), column(i + 1, i + 3)], axis=-1) for i in (0, 4))


def meridian_m(latitude):
    """Distance from the equator along the meridian (WGS 84), series in the third flattening."""
    a, f = 6378137.0, 1 / 298.257223563
    n = f / (2 - f)
    return (a - a * f / 2) * (
        (1 + n**2 / 4 + n**4 / 64) * latitude
        - 3 / 2 * (n - n**3 / 8) * np.sin(2 * latitude)
        + 15 / 16 * (n**2 - n**4 / 4) * np.sin(4 * latitude)
        - 35 / 48 * n**3 * np.sin(6 * latitude)
        + 315 / 512 * n**4 * np.sin(8 * latitude)
    )


def earth(sites):
    """What the Earth does at every site: arrays by key."""
    column = lambda key, default: np.array([site.get(key, default) for site in sites], dtype=float)
    xi = np.array([site.get("deflection_arcsec", {}).get("xi", 0.0) for site in sites])
    geodetic_deg = column("latitude_deg", 0.0)
    latitude_deg = geodetic_deg + xi / 3600.0
    geodetic, latitude = np.radians(geodetic_deg), np.radians(latitude_deg)
    sin2, h = np.sin(geodetic) ** 2, column("height_m", 0.0) / 6378137.0
    normal = 9.7803253359 * (1 + 0.00193185265241 * sin2) / np.sqrt(1 - 0.00669437999014 * sin2)
    f, m = 1 / 298.257223563, 0.00344978650684
    normal *= 1 - 2 * (1 + f + m - 2 * f * sin2) * h + 3 * h * h
    measured = column("gravity_m_per_s2", np.nan)

    def towards(north):
        change = np.full_like(latitude, WITHIN_DEG_PER_H / RATE_DEG_PER_H)
        for _ in range(8):
            between = latitude + north * change / 2
            larger = np.maximum(np.abs(np.sin(between)), np.abs(np.cos(between)))
            change = 2 * np.arcsin(WITHIN_DEG_PER_H / RATE_DEG_PER_H / (2 * larger))
        return np.abs(meridian_m(geodetic + north * change) - meridian_m(geodetic))

    return {
        "rate_deg_per_h": np.full_like(latitude, RATE_DEG_PER_H),
        "latitude_deg": latitude_deg,
        "horizontal_deg_per_h": RATE_DEG_PER_H * np.cos(latitude),
        "vertical_deg_per_h": RATE_DEG_PER_H * np.sin(latitude),
        "gravity_m_per_s2": np.where(np.isnan(measured), normal, measured),
        "valid_radius_m": np.round(np.minimum(towards(1), towards(-1)), 6),
        "valid_within_deg_per_h": np.full_like(latitude, WITHIN_DEG_PER_H),
    }


def string(data):
    return struct.pack(">I", len(data)) + data


class Signer:
    def __init__(self, secret, checked):
        self.checked = checked
        self.key = Ed25519PrivateKey.from_private_bytes(secret)
        public = self.key.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw)
        self.head = b"SSHSIG" + struct.pack(">I", 1) + string(string(b"ssh-ed25519") + string(public))
        self.rest = string(b"dtg-passport") + string(b"") + string(b"sha512")

    def armor(self, payload):
        """OpenSSH's PROTOCOL.sshsig."""
        signed = b"SSHSIG" + self.rest + string(hashlib.sha512(payload).digest())
        signature = self.key.sign(signed)
        if self.checked:
            self.key.public_key().verify(signature, signed)
        blob = self.head + self.rest + string(string(b"ssh-ed25519") + string(signature))
        text = base64.b64encode(blob).decode()
        lines = [text[at : at + 70] for at in range(0, len(text), 70)]
        lines = ["-----BEGIN SSH SIGNATURE-----", *lines, "-----END SSH SIGNATURE-----"]
        return "".join(f"  {line}\n" for line in lines)


def main():
    fleet = json.load(sys.stdin)
    start, used = time.perf_counter(), os.times()
    sites, signer = fleet["sites"], Signer(bytes(fleet["secret"]), fleet["checked"])
    at = earth(sites)
    horizontal, vertical = (at[key][:, None, None] for key in ("horizontal_deg_per_h", "vertical_deg_per_h"))
    earth_rows = [dict(zip(at, row)) for row in zip(*(column.tolist() for column in at.values()))]
    site_texts = [dump({"site": site, "earth": row}) for site, row in zip(sites, earth_rows)]
    k_inverse = np.linalg.inv(K)
    computed = []
    for stand in fleet["stands"]:
        positions = stand["positions"]
        attitude = attitudes(positions)
        north, up, up_z = attitude[:, :2, 1], attitude[:, :2, 2], attitude[:, 2, 2].tolist()
        (a1, a2), (n1, n2) = differences(north), differences(up)
        n2_inverse = np.linalg.inv(n2)
        delta = n2_inverse @ n1
        omega = north * horizontal + up * vertical  # sites x 8 x 2
        omega1, omega2 = differences(omega)
        b, c = omega1 - omega2 @ delta, omega2 @ n2_inverse
        currents = (omega - OMEGA0 - up @ OMEGA_N.T) @ k_inverse.T
        shared = {"n1": n1.tolist(), "n2": n2.tolist(), "n2_inverse": n2_inverse.tolist()}
        stand_text = dump({key: stand[key] for key in STAND_KEYS if key in stand})
        delta, forces, index = delta.tolist(), up.tolist(), [(position["i"], position["j"]) for position in positions]
        identity = stand["stand"]["model"] + "/" + stand["stand"]["serial"]
        folder = os.path.join(fleet["folder"], stand["stand"]["serial"])
        os.makedirs(folder, exist_ok=True)
        arrays = (array.tolist() for array in (b, c, omega1, omega2, omega, currents))
        for site, site_text, *numbers in zip(sites, site_texts, *arrays):
            b_rows, c_rows, omega1_rows, omega2_rows, omega_rows, current_rows = numbers
            head = {
                "format": "dtg-passport/1",
                "passport": {
                    "id": f"{identity}/{site['id']}/1",
                    "revision": 1,
                    "issued_at": fleet["issued_at"],
                    "issuer": fleet["issuer"],
                    "valid_until": stand["certificate"]["valid_until"],
                    "issued_with": "python",
                },
            }
            tail = {
                "matrices": {
                    "delta": delta,
                    "b_deg_per_h": b_rows,
                    "c_deg_per_h_per_g": c_rows,
                    **shared,
                    "omega1_deg_per_h": omega1_rows,
                    "omega2_deg_per_h": omega2_rows,
                },
                "vectors": [
                    {"i": i, "j": j, "specific_force_g": n, "specific_force_z_g": z, "omega_deg_per_h": w}
                    for (i, j), n, z, w in zip(index, forces, up_z, omega_rows)
                ],
                "self_check": {
                    "currents": [
                        {"i": i, "j": j, "jx_ma": x, "jy_ma": y} for (i, j), (x, y) in zip(index, current_rows)
                    ],
                    "k_deg_per_h_per_ma": K.tolist(),
                    "omega0_deg_per_h": OMEGA0.tolist(),
                    "omega_g_deg_per_h_per_g": OMEGA_G,
                    "omega_k_deg_per_h_per_g": OMEGA_K,
                },
            }
            payload = dump(head) + stand_text + site_text + dump(tail)
            if fleet["checked"]:
                due = {**head, "site": site, **tail, **{key: stand[key] for key in STAND_KEYS if key in stand}}
                read = yaml.load(payload, Loader=yaml.CSafeLoader)
                assert read.pop("earth") and read == due, "the text says something else"
            file = (payload + "signature: |\n" + signer.armor(payload.encode())).encode()
            path = os.path.join(folder, site["id"] + "-1.yaml")
            with open(path + ".tmp", "xb") as beside:
                beside.write(file)
            os.rename(path + ".tmp", path)
            computed.append((delta, b_rows, c_rows, omega_rows))
    seconds, now = time.perf_counter() - start, os.times()
    user, system = now.user - used.user, now.system - used.system
    times = {"seconds": seconds, "processor_seconds": user + system, "user_seconds": user}
    json.dump({**times, "computed": computed}, sys.stdout)


main()
