"""The program and the wheel for Windows against the program for Linux: 200 good and 2,000 altered passports, and calibrations."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

from conftest import PROJECT, TIME, Corpus, program


def windows(*arguments: object, accept: int = 0) -> str:
    done = subprocess.run([os.environ["DTG_PASSPORT_WINDOWS"], *map(str, arguments)], capture_output=True)
    assert done.returncode == accept, (arguments[:3], done.stderr.decode())
    return done.stdout.decode()


def test_every_answer_is_the_same(corpus: Corpus) -> None:
    asked = ("--trust", corpus.signers, "--time", TIME, "--format", "json")
    found = []
    # A command line of Windows has at most 32,767 characters.
    for first in range(0, 2200, 200):
        some = windows("verify", *corpus.paths[first : first + 200], *asked, accept=0 if first == 0 else 1)
        found += json.loads(some)
    assert len(corpus.verdicts) == 2200 and found == corpus.verdicts


def test_every_number_is_the_same_to_the_bit(corpus: Corpus) -> None:
    """Compared as text: every digit, and every key in its place."""
    asked = ("--to", "json", "--trust", corpus.signers, "--time", TIME)
    found, due = (run("export", *corpus.good, *asked) for run in (windows, program))
    assert found == due and found.count('"verified":true') == 200


def test_calibrations_are_the_same_to_the_bit(corpus: Corpus) -> None:
    options = ("--gyro", PROJECT / "docs/gvk-6.yaml", "--laboratory", PROJECT / "docs/laboratory.yaml", "--budget",
               "--monte-carlo", "--trials", "16384", "--format", "json")  # fmt: skip
    trust = ("--trust", PROJECT / "docs/allowed_signers", "--time", TIME)
    asked = (PROJECT / "passports/SPS-2/0017/moscow-bmstu-1.yaml", PROJECT / "docs/currents.csv", *trust, *options)
    assert windows("calibrate", *asked) == program("calibrate", *asked)


def test_the_wheel_gives_the_answers_and_numbers_of_the_program(corpus: Corpus, tmp_path: Path) -> None:
    gyro, laboratory = PROJECT / "docs/gvk-6.yaml", PROJECT / "docs/laboratory.yaml"
    examples, currents = PROJECT / "docs/allowed_signers", PROJECT / "docs/currents.csv"
    passport = PROJECT / "passports/SPS-2/0017/moscow-bmstu-1.yaml"
    stand, site = PROJECT / "passports/SPS-2/0017/stand.yaml", PROJECT / "sites/moscow-bmstu.yaml"
    issue = {"stand": stand, "site": site, "key": corpus.folder / "key", "identity": "factory@example.org",
             "issued_at": "2026-11-10T00:00:00Z", "out": tmp_path / "found"}  # fmt: skip
    asked = {"time": TIME, "paths": corpus.paths, "good": corpus.good, "signers": corpus.signers, "passport": passport,
             "examples": examples, "currents": currents, "laboratory": laboratory, "gyro": gyro, "issue": issue}  # fmt: skip
    command = [os.environ["DTG_PYTHON_WINDOWS"], str(PROJECT / "tests/windows/wheel.py")]
    done = subprocess.run(command, input=json.dumps(asked, default=str), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["system"] == "win32"

    assert found["verdicts"] == [[due[key] for key in ("valid", "id", "not_asked", "remarks", "checks")] for due in corpus.verdicts]
    trust = ("--trust", corpus.signers, "--time", TIME)
    parts = ("passport", "stand", "positions", "earth", "matrices", "vectors", "self_check")
    exported = program("export", *corpus.good, "--to", "json", *trust).splitlines()
    stated = lambda one: {key: value for key, value in one.items() if value is not None}
    # As text: JSON writes every binary64 with its shortest decimals.
    for content, line in zip(found["contents"], exported, strict=True):
        due = json.loads(line, object_hook=stated)
        assert json.dumps([content.get(part) for part in parts]) == json.dumps([due.get(part) for part in parts])
    options = ("--gyro", gyro, "--laboratory", laboratory, "--budget", "--method", "least-squares", "--format", "json")
    result = program("calibrate", passport, currents, "--trust", examples, "--time", TIME, *options)
    assert found["result"] == json.loads(result)
    key = ("--key", issue["key"], "--identity", issue["identity"], "--issued-at", issue["issued_at"])
    [issued] = json.loads(program("issue", stand, "--site", site, *key, "--out", tmp_path / "due", "--format", "json"))
    assert found["sha256"] == issued["sha256"]
