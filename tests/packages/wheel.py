"""The installed module gives the numbers and the bytes of the program: wheel.py CLONE ANSWERS, from another folder.

ANSWERS is a folder with what the program printed, and with the passport that it issued with the key that is there.
"""

import json
import pathlib
import sys
import tempfile

import dtg_passport

clone, answers = map(pathlib.Path, sys.argv[1:])
passport_file, signers = clone / "passports/SPS-2/0017/moscow-bmstu-1.yaml", clone / "docs/allowed_signers"
asked = {"serial": "0017", "at": (55.7660, 37.6850), "time": "2026-11-20"}


def answer(name: str) -> dict:
    return json.loads((answers / name).read_text(encoding="utf-8"))


passport = dtg_passport.load(passport_file, signers, **asked)
due = answer("passport.json")
assert passport.id == due["passport"]["id"] and passport.sha256 == due["sha256"], passport
for array, key in ((passport.delta, "delta"), (passport.B, "b_deg_per_h"), (passport.C, "c_deg_per_h_per_g")):
    assert array.shape == (2, 2) and array.tolist() == due["matrices"][key], key
assert [check.name for check in passport.checks] == [check["name"] for check in due["checks"]]

found = passport.calibrate(clone / "docs/currents.csv", gyro=clone / "docs/gvk-6.yaml", laboratory=clone / "docs/laboratory.yaml")
due = answer("calibrate.json")
drawn = due.pop("monte_carlo")
assert {**found.document, "subject": None} == {**due, "subject": None}
assert found.monte_carlo(16384, seed=1).document == drawn

altered = passport_file.read_bytes().replace(b"0017", b"0018", 1)
try:
    dtg_passport.loads(altered, signers, time="2026-11-20")
except dtg_passport.Refused as refused:
    assert [check.name for check in refused.checks if check.passed is False][0] == "signature", refused.checks
else:
    raise AssertionError("an altered passport was accepted")

with tempfile.TemporaryDirectory() as folder:
    issued = dtg_passport.issue(
        clone / "passports/SPS-2/0017/stand.yaml", clone / "sites/moscow-bmstu.yaml",
        key=answers / "key", identity="release@example.org", issued_at="2026-11-09", out=folder,
    )  # fmt: skip
    place = "SPS-2/0017/moscow-bmstu-1.yaml"
    assert pathlib.Path(folder, place).read_bytes() == (answers / "issued" / place).read_bytes()
print(f"{passport.id}: numbers, calibration, trials and issued bytes are those of the program; {sys.version.split()[0]}, {sys.platform}")
