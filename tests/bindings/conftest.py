"""What the tests of all languages share: the program, a corpus of good and altered passports, and registers."""

from __future__ import annotations

import datetime
import json
import os
import random
import subprocess
from pathlib import Path
from typing import NamedTuple

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


def octave(script: Path) -> str:
    """Run a script of Octave in its folder and return what it prints."""
    # MATLAB's `system` returns what the command writes to standard error too, unlike that of Octave.
    (script.parent / "system.m").write_text("""
        function [status, text] = system(command)
            [status, text] = builtin('system', ['{ ', command, '; } 2>&1']);
        end
    """)
    path = f"{Path(os.environ['DTG_PASSPORT']).parent}:{os.environ['PATH']}"
    command = ["octave-cli", "--norc", "--quiet", "--path", str(script.parent), str(script)]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PATH": path}, cwd=script.parent)
    assert done.returncode == 0, done.stderr
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


class Asked(NamedTuple):
    """A passport of which a register is asked, with the answer that is due."""

    name: str
    passport: Path
    signers: Path
    register: Path
    time: str
    code: str
    """Code of the check `register`, by the rules of registers."""

    def options(self) -> list[object]:
        return ["--trust", self.signers, "--register", self.register, "--time", self.time, "--format", "json"]

    def verdict(self) -> dict:
        """Return the answer of the program."""
        [found] = json.loads(program("verify", self.passport, *self.options(), accept=(0, 1)))
        assert (found["checks"][-1]["name"], found["checks"][-1]["code"]) == ("register", self.code), (self.name, found)
        return found

    def verdict_on_content(self) -> dict:
        """Return the answer of the program, with the names that content without a path has in other languages."""
        text = json.dumps(self.verdict()).replace(str(self.passport), "passport").replace(str(self.register), "register")
        return json.loads(text)

    def question(self) -> dict:
        return {"time": self.time, "register": list(self.register.read_bytes())}


class Registers:
    """Passports of two stands and their registers, signed by a key of their own, and registers that are not accepted."""

    def __init__(self, folder: Path) -> None:
        # A register has the time of the clock, from which a successor counts.
        now = datetime.datetime.now(datetime.timezone.utc)
        time = f"{now + datetime.timedelta(hours=1):%Y-%m-%dT%H:%M:%SZ}"
        key, self.signers, self.passports = folder / "key", folder / "allowed_signers", folder / "passports"
        who = ["--key", key, "--identity", "factory@example.org"]
        program("keygen", key, "--identity", "factory@example.org", "--no-passphrase", "--allowed-signers", self.signers)
        (folder / "sites").mkdir()
        for number in range(5):
            site = SITE.format(number=number, latitude=f"{55.766 + 3.0 * number:.3f}")
            (folder / "sites" / f"site-{number}.yaml").write_text(site)
        stands = [PROJECT / "passports/SPS-1/0203/stand.yaml", PROJECT / "passports/SPS-2/0017/stand.yaml"]
        at = ["--issued-at", "2026-11-10T00:00:00Z"]
        program("issue", *stands, "--site", folder / "sites", *who, *at, "--out", self.passports)
        of_stand = self.passports / "SPS-2/0017"
        good, old, left, withdrawn, unlisted = (of_stand / f"site-{number}-1.yaml" for number in range(5))
        trust = ["--trust", self.signers]
        program("reissue", old, "--same-content", "--reason", "test", *who, *trust)
        there = ["--site", PROJECT / "sites/beijing-nim.yaml"]
        program("reissue", left, *there, "--moved", "--reason", "test", *who, *trust)
        program("revoke", "SPS-2/0017/site-3/1", "--reason", "test", "--passports", self.passports, *who, *trust)
        program("reissue", unlisted, *there, "--without-register", "--same-content", "--reason", "test", *who, *trust)
        self.fresh_until = f"{now + datetime.timedelta(days=30):%Y-%m-%d}"
        program("register", self.passports, "--renew", "--fresh-until", self.fresh_until, *who, *trust)
        strange = folder / "strange"
        program("issue", stands[1], "--site", folder / "sites/site-0.yaml", *who, "--issued-at", "2026-11-11T00:00:00Z", "--out", strange)

        whole = (of_stand / "register.yaml").read_bytes()
        alone = folder / "alone"
        alone.write_text(self.signers.read_text().replace("dtg-passport,dtg-register", "dtg-passport"))
        stale = f"{now + datetime.timedelta(days=40):%Y-%m-%dT%H:%M:%SZ}"
        cases = [
            ("good", good, whole, "ok"),
            ("superseded", old, whole, "superseded"),
            ("moved", left, whole, "moved"),
            ("withdrawn", withdrawn, whole, "withdrawn"),
            ("not listed", of_stand / "beijing-nim-2.yaml", whole, "not_listed"),
            ("listed with other bytes", strange / "SPS-2/0017/site-0-1.yaml", whole, "not_listed"),
            ("stale", good, whole, "register_stale"),
            ("of another stand", good, (self.passports / "SPS-1/0203/register.yaml").read_bytes(), "register_unknown"),
            ("of a key without dtg-register", good, whole, "register_unknown"),
            ("changed", good, whole.replace(b'"current"', b'"cUrrent"', 1), "register_unknown"),
            ("not text", good, whole.replace(b"sequence", b"sequ\xffnce", 1), "register_unknown"),
            ("cut", good, whole[:-100], "register_unknown"),
            ("empty", good, b"", "register_unknown"),
            ("a passport", good, good.read_bytes(), "register_unknown"),
        ]
        self.asked = []
        for name, passport, content, code in cases:
            register = folder / name / "register"
            register.parent.mkdir()
            register.write_bytes(content)
            signers = alone if name == "of a key without dtg-register" else self.signers
            self.asked.append(Asked(name, passport, signers, register, stale if name == "stale" else time, code))
        [self.good, self.withdrawn] = (asked for asked in self.asked if asked.name in ("good", "withdrawn"))


@pytest.fixture(scope="session")
def registers(tmp_path_factory: pytest.TempPathFactory) -> Registers:
    return Registers(tmp_path_factory.mktemp("registers"))
