"""What the tests of all languages share: the program, and a corpus of good and altered passports."""

from __future__ import annotations

import json
import os
import random
import subprocess
from pathlib import Path

import pytest

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
