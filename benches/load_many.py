"""Measures the Python module: `load_many` against a laboratory that has only PyYAML and cryptography, and against
`register` of the program; memory after many loads; and the import.

    tests/bindings/run --install; packaging/release linux wheel
    target/bindings/venv/bin/pip install --no-deps --force-reinstall target/packages/*manylinux*.whl
    DTG_PASSPORT=target/static/dtg-passport target/bindings/venv/bin/python benches/load_many.py [COUNT]

Module and program are those of packages, because `tests/bindings/run` compiles them without optimisation.

Both read the same files, verify the signature of each, and give four matrices as arrays. The laboratory's program knows
no revocation, no expiry and no canonical form; `load_many` runs every check, on all processors.
"""

import base64
import hashlib
import os
import re
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROJECT = Path(__file__).parents[1]
PROGRAM = os.environ.get("DTG_PASSPORT", PROJECT / "target/debug/dtg-passport")
SITE = 'format: "dtg-site/1"\nid: "site-{number}"\nlatitude_deg: {latitude:.6f}\nlongitude_deg: 37.5\n'
WHO = "factory@example.org"
TIME = "2026-11-20"
FORM = re.compile(rb"(.*\n)signature: \|\n  -----BEGIN SSH SIGNATURE-----\n(.*)  -----END SSH SIGNATURE-----\n", re.S)


def passports(folder: Path, count: int) -> list[Path]:
    (folder / "sites").mkdir()
    for number in range(count // 2):
        site = SITE.format(number=number, latitude=-80 + 160 * number / count)
        (folder / f"sites/site-{number}.yaml").write_text(site)
    run = lambda *arguments: subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)
    run("keygen", folder / "key", "--identity", WHO, "--no-passphrase", "--allowed-signers", folder / "signers")
    stands = [PROJECT / "passports/SPS-1/0203/stand.yaml", PROJECT / "passports/SPS-2/0017/stand.yaml"]
    run("issue", *stands, "--site", folder / "sites", "--key", folder / "key", "--identity", WHO, "--out", folder / "passports",
        "--issued-at", "2026-11-10T00:00:00Z", "--no-sync")  # fmt: skip
    return sorted((folder / "passports").glob("*/*/*-1.yaml"))


def by_hand(paths: list[Path], signers: Path) -> float:
    import numpy
    import yaml
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    key_blob = base64.b64decode(signers.read_text().split()[-2 if signers.read_text().split()[-1][:4] != "AAAA" else -1])
    public = Ed25519PublicKey.from_public_bytes(key_blob[-32:])
    begin = time.perf_counter()
    for path in paths:
        message, armor = FORM.fullmatch(path.read_bytes()).groups()
        blob = base64.b64decode(armor)
        assert key_blob in blob
        text = lambda value: struct.pack(">I", len(value)) + value
        digest = hashlib.sha512(message).digest()
        public.verify(blob[-64:], b"SSHSIG" + text(b"dtg-passport") + text(b"") + text(b"sha512") + text(digest))
        content = yaml.load(message, Loader=yaml.CSafeLoader)
        assert content["passport"]["issuer"] == WHO
        for name in ("delta", "b_deg_per_h", "c_deg_per_h_per_g", "n2_inverse"):
            numpy.array(content["matrices"][name])
    return time.perf_counter() - begin


def by_module(paths: list[Path], signers: Path, threads: int | None) -> float:
    import dtg_passport

    begin = time.perf_counter()
    for passport in dtg_passport.load_many(paths, signers, time=TIME, threads=threads):
        passport.delta, passport.B, passport.C, passport.n2_inverse
    return time.perf_counter() - begin


def by_register(folder: Path, signers: Path) -> float:
    """Time of the whole program, which verifies every passport too and finds out which of them are in force."""
    begin = time.perf_counter()
    command = [PROGRAM, "register", folder / "passports", "--trust", signers, "--time", TIME]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begin


def resident_kib() -> int:
    status = Path("/proc/self/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1])


def memory(paths: list[Path], signers: Path) -> None:
    import dtg_passport

    for number in range(100_001):
        dtg_passport.load(paths[number % len(paths)], signers, time=TIME).delta
        if number in (1_000, 10_000, 100_000):
            print(f"resident memory after {number} loads: {resident_kib()} KiB")


def import_ms() -> float:
    code = "import numpy, time; begin = time.perf_counter(); import dtg_passport; print(1e3 * (time.perf_counter() - begin))"
    runs = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout) for _ in range(21)]
    return sorted(runs)[10]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = passports(folder, count)
        signers = folder / "signers"
        assert len(paths) == count
        memory(paths[:100], signers)
        by_module(paths, signers, None)  # reads every file once, so that both find them in memory
        hand = by_hand(paths, signers)
        register = sorted(by_register(folder, signers) for _ in range(3))[1]
        for threads in (None, 1):
            module = sorted(by_module(paths, signers, threads) for _ in range(3))[1]
            words = "one thread" if threads else "all processors"
            print(f"load_many, {words}: {1e6 * module / count:.0f} us each; by hand {1e6 * hand / count:.0f} us; "
                  f"{hand / module:.1f} times as fast")  # fmt: skip
            if threads is None:
                print(f"register: {1e6 * register / count:.0f} us each; load_many {register / module:.2f} times as fast")
    print(f"import dtg_passport after numpy: {import_ms():.1f} ms, median of 21")


main()
