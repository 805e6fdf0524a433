"""The program for Windows against that for Linux: 200 good and 2,000 altered passports, and calibrations."""

from __future__ import annotations

import json
import os
import subprocess

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
