"""What the tests of all languages share: the program, and a corpus of good and altered passports."""

from __future__ import annotations

import json
import os
import random
import subprocess
from pathlib import Path

import pytest
import yaml

PROJECT = Path(__file__).parents[2]
PROGRAM = os.environ["DTG_PASSPORT"]
SIGNERS = PROJECT / "docs/allowed_signers"
# Within the validity of the certificates of both stands.
TIME = "2026-11-20T00:00:00Z"
SHIPPED = sorted(PROJECT.glob("passports/*/*/*-[0-9].yaml")) + [PROJECT / "docs/self_check.yaml"]
assert len(SHIPPED) >= 4

# Sites of the corpus: a hundred latitudes for each of the two stands.
SITE = 'format: "dtg-site/1"\nid: "site-{number}"\nlatitude_deg: {latitude}\nlongitude_deg: 37.5\n'
ALTERED = 2000


def program(*arguments: object, accept: tuple[int, ...] = (0,)) -> str:
    """Return what the command line program prints."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode in accept, (arguments, done.stderr)
    return done.stdout


PASSPORT = PROJECT / "passports/SPS-2/0017/moscow-bmstu-1.yaml"
CURRENTS, RUN = PROJECT / "docs/currents.csv", PROJECT / "docs/run.csv"


def plain(path: Path) -> dict:
    return yaml.safe_load(path.read_text())


LABORATORY, GYRO = plain(PROJECT / "docs/laboratory.yaml"), plain(PROJECT / "docs/gvk-6.yaml")
# A meter that is not the paper's, a gyro that states its noise, and tolerances that every and no gyro meets.
OWN = {**LABORATORY, "meter": {**LABORATORY["meter"], "reading_percent": 0.02, "noise_ma": 1e-7}, "temperature_c": 35.0}
NOISY = {**GYRO, "noise": {"visit_deg_per_h": 0.001, "turn_on_deg_per_h": 0.01}}
WIDE, NARROW = ({**GYRO, "tolerance": dict.fromkeys(GYRO["tolerance"], limit)} for limit in (1e3, 1e-6))
DOOR = {"i": 2, "j": 4, "visit": 1, "cycle": 3, "why": "door opened"}

# Currents and order of calibrations.
ORDERS: dict[str, tuple[Path, dict]] = {
    "nothing": (CURRENTS, {}),
    "laboratory": (CURRENTS, {"laboratory": OWN, "method": "iterative"}),
    "pass": (CURRENTS, {"laboratory": LABORATORY, "gyro": WIDE, "method": "analytic"}),
    "fail": (CURRENTS, {"gyro": NARROW}),
    "turn-ons": (RUN, {"laboratory": OWN, "gyro": NOISY}),
    "drift": (RUN, json.loads((PROJECT / "docs/order.json").read_text())),
    "two excluded": (RUN, {"exclude": [DOOR, {**DOOR, "cycle": 1, "why": "read late"}]}),
    "general": (RUN, {"model": "general", "gyro": GYRO}),
}

# Orders that are refused, the code of the refusal, and words of it that are also those for a file.
REFUSED: list[tuple[Path, dict, str, str]] = [
    (CURRENTS, {"laboratory": {**OWN, "meter": {**OWN["meter"], "floor_ma": 0.0}}}, "unusable", "meter.floor_ma: found 0, expected a positive number"),
    (CURRENTS, {"laboratory": {**OWN, "meters": {}}}, "unusable", "unknown key \"meters\""),
    (CURRENTS, {"laboratory": GYRO}, "unusable", "format: found \"dtg-gyro/1\", expected \"dtg-laboratory/1\""),
    (CURRENTS, {"gyro": {key: GYRO[key] for key in GYRO if key != "tolerance"}}, "unusable", "tolerance: missing"),
    (CURRENTS, {"method": "exact"}, "unusable", "method: found \"exact\", expected \"analytic\""),
    (CURRENTS, {"model": "full"}, "unusable", "model: found \"full\", expected \"paper\" or \"general\""),
    (CURRENTS, {"drift": 1}, "unusable", "drift: found 1, expected true or false"),
    (RUN, {"exclude": [{"i": 2, "j": 4, "visit": 1, "why": "door opened"}]}, "unusable", "has a visit 1 in the cycles [1, 2, 3]"),
    (RUN, {"exclude": [{**DOOR, "visit": 9}]}, "unusable", "found no visit 9 to position (2, 4)"),
    (RUN, {"exclude": [{**DOOR, "why": ""}]}, "unusable", "exclude[0].why: found empty text"),
    (CURRENTS, {"drift": True}, "refused", "time_s"),
    (CURRENTS, {"model": "general", "method": "analytic"}, "refused", "has only the paper's model"),
]


def calibrated(folder: Path, currents: Path, order: dict) -> str:
    """Return the JSON that the program prints for an order."""
    options: list[object] = ["--method", order.get("method", "least-squares"), "--model", order.get("model", "paper")]
    options += ["--drift"] if order.get("drift") else []
    for visit in order.get("exclude", ()):
        options += ["--exclude", ",".join(str(visit[key]) for key in ("i", "j", "visit", "cycle")), "--why", visit["why"]]
    for key in ("laboratory", "gyro"):
        if key in order:
            (folder / f"{key}.yaml").write_text(yaml.safe_dump(order[key]))
            options += [f"--{key}", folder / f"{key}.yaml"]
    verified = ("--trust", SIGNERS, "--time", TIME, "--format", "json")
    return program("calibrate", PASSPORT, currents, *verified, *options, accept=(0, 1))


def altered(good: list[bytes], count: int) -> list[bytes]:
    """Return passports with one change each: a byte, a bit, a line or a digit, always at the same places."""
    draw = random.Random(16)
    found: list[bytes] = []
    while len(found) < count:
        data = bytearray(draw.choice(good))
        at = draw.randrange(len(data))
        match draw.randrange(7):
            case 0:
                data[at] ^= 1 << draw.randrange(8)
            case 1:
                del data[at]
            case 2:
                data.insert(at, draw.randrange(256))
            case 3:
                del data[at:]
            case 4:
                digits = [place for place, byte in enumerate(data) if byte in b"0123456789"]
                data[draw.choice(digits)] = draw.choice(b"0123456789")
            case 5:
                lines = bytes(data).splitlines(keepends=True)
                lines.insert(draw.randrange(len(lines)), draw.choice(lines))
                data = bytearray(b"".join(lines))
            case 6:
                lines = bytes(data).splitlines(keepends=True)
                del lines[draw.randrange(len(lines))]
                data = bytearray(b"".join(lines))
        if bytes(data) not in good:
            found.append(bytes(data))
    return found


class Corpus:
    """Passports with the verdict and, for good ones, the JSON of the command line program."""

    def __init__(self, folder: Path) -> None:
        sites = folder / "sites"
        sites.mkdir()
        for number in range(100):
            latitude = -80.0 + 1.61 * number
            (sites / f"site-{number}.yaml").write_text(SITE.format(number=number, latitude=f"{latitude:.4f}"))
        key = folder / "key"
        self.signers = folder / "allowed_signers"
        program("keygen", key, "--identity", "factory@example.org", "--no-passphrase", "--allowed-signers", self.signers)
        stands = [PROJECT / "passports/SPS-1/0203/stand.yaml", PROJECT / "passports/SPS-2/0017/stand.yaml"]
        program("issue", *stands, "--site", sites, "--key", key, "--identity", "factory@example.org",
                "--out", folder / "good", "--issued-at", "2026-11-10T00:00:00Z", "--no-sync")  # fmt: skip
        self.good = sorted((folder / "good").glob("*/*/*-1.yaml"))
        assert len(self.good) == 200
        (folder / "altered").mkdir()
        self.altered = []
        for number, data in enumerate(altered([path.read_bytes() for path in self.good], ALTERED)):
            path = folder / "altered" / f"{number}.yaml"
            path.write_bytes(data)
            self.altered.append(path)
        self.paths = [*self.good, *self.altered]
        verdicts = program("verify", *self.paths, "--trust", self.signers, "--time", TIME, "--format", "json", accept=(1,))
        self.verdicts = json.loads(verdicts)
        assert [verdict["valid"] for verdict in self.verdicts] == [True] * 200 + [False] * ALTERED
        self.folder = folder


@pytest.fixture(scope="session")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Corpus:
    return Corpus(tmp_path_factory.mktemp("corpus"))
