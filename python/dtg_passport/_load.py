"""Reading and verification of passports."""

from __future__ import annotations

import datetime
import itertools
import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence

from . import _dtg_passport
from ._common import Array, Path, asked, numbers, path_or_content, whole
from ._passport import Check, Passport, Refused, Verification

# Passports verified at a time by load_many: enough work for the threads, little memory.
CHUNK = 512


def _enquiry(
    trust: Path | bytes,
    serial: str | None,
    at: Sequence[float] | Array | None,
    time: str | datetime.date | None,
    issuer: str | None,
    revoked: Path | bytes | Iterable[Path | bytes],
    register: Path | bytes | None,
) -> _dtg_passport.Enquiry:
    if isinstance(revoked, (str, bytes, os.PathLike)):
        revoked = (revoked,)
    lists = [path_or_content("revoked", one) for one in revoked]
    question = asked(serial=serial, at=None if at is None else numbers("at", at), time=time, issuer=issuer)
    return _dtg_passport.Enquiry(path_or_content("trust", trust), lists, question, register)


def _each(
    paths: Iterable[Path], enquiry: _dtg_passport.Enquiry, threads: int | None, raising: bool = True
) -> Iterator[tuple[str, _dtg_passport._Answer]]:
    if isinstance(paths, (str, bytes, os.PathLike)):
        raise TypeError(f"paths: found {paths!r}, expected a list of paths")
    of_all = 0 if threads is None else whole("threads", threads, 1, 1024)
    names = (os.fspath(path) for path in paths)

    def each() -> Iterator[tuple[str, _dtg_passport._Answer]]:
        while chunk := list(itertools.islice(names, CHUNK)):
            for name, (answer, error) in zip(chunk, enquiry.verify_files(chunk, of_all)):
                if raising and error is not None:
                    raise error
                yield name, answer

    return each()


def _passport(path: str, answer: _dtg_passport._Answer) -> Passport:
    if answer[-1] is None:
        raise Refused(path, tuple(map(Check._make, answer[3])))
    return Passport._of(answer)


def _verification(path: str, answer: _dtg_passport._Answer) -> Verification:
    id, _, _, checks, not_asked, remarks, content = answer
    passport = None if content is None else Passport._of(answer)
    return Verification(path, content is not None, id, tuple(map(Check._make, checks)), passport, tuple(not_asked), tuple(remarks))


def load(
    path: Path,
    trust: Path | bytes,
    *,
    serial: str | None = None,
    at: Sequence[float] | Array | None = None,
    time: str | datetime.date | None = None,
    issuer: str | None = None,
    revoked: Path | bytes | Iterable[Path | bytes] = (),
    register: Path | bytes | None = None,
) -> Passport:
    """Read a passport and verify it.

    Args:
        path: Passport file.
        trust: Trusted keys: the path of an OpenSSH allowed_signers file, or its content as bytes.
        serial: Serial number of the stand, read from the stand. Without it, a passport of another stand is not noticed.
        at: Place of the stand: latitude and longitude in degrees, north and east positive.
        time: Time to verify for: RFC 3339 in whole seconds, a UTC date, or a `datetime` with a time zone. Default: now.
        issuer: Required issuer.
        revoked: Lists of revoked keys: paths of OpenSSH KRLs or of lists of public keys, or their contents as bytes.
        register: Register of the stand, which lists the passports that count: its path, the path of a folder of
            passports with their registers, or the bytes of a register. Any other passport is refused, and every
            passport if the register is missing or not accepted.

    Raises:
        Refused: If a check failed. `checks` states which, and why.
        ValueError: If the trust, a list of revoked keys or an argument cannot be used.
        OSError: If a file cannot be read.

    Examples:
        >>> load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", serial="0018", time="2026-11-20")
        Traceback (most recent call last):
        ...
        dtg_passport.Refused: passports/SPS-2/0017/moscow-bmstu-1.yaml: refused
          stand (wrong_stand): the passport is for stand SPS-2 0017, not 0018; its deviations do not apply to stand 0018
    """
    return _passport(*next(_each([path], _enquiry(trust, serial, at, time, issuer, revoked, register), 1)))


def loads(
    data: bytes | bytearray | memoryview | str,
    trust: Path | bytes,
    *,
    serial: str | None = None,
    at: Sequence[float] | Array | None = None,
    time: str | datetime.date | None = None,
    issuer: str | None = None,
    revoked: Path | bytes | Iterable[Path | bytes] = (),
    register: Path | bytes | None = None,
) -> Passport:
    """Verify a passport that is in memory; all else as in `load`.

    Args:
        data: Content of the passport file: its bytes, or the text of these bytes in UTF-8.

    Examples:
        >>> from pathlib import Path
        >>> data = Path("passports/SPS-2/0017/moscow-bmstu-1.yaml").read_bytes()
        >>> loads(data, "docs/allowed_signers", time="2026-11-20").gravity  # m/s^2
        9.81572205535764
    """
    enquiry = _enquiry(trust, serial, at, time, issuer, revoked, register)
    data = data.encode() if isinstance(data, str) else bytes(data)
    return _passport("passport", enquiry.verify("passport", data))


def verify(
    path: Path,
    trust: Path | bytes,
    *,
    serial: str | None = None,
    at: Sequence[float] | Array | None = None,
    time: str | datetime.date | None = None,
    issuer: str | None = None,
    revoked: Path | bytes | Iterable[Path | bytes] = (),
    register: Path | bytes | None = None,
) -> Verification:
    """Verify a passport and return every check, passed or not; parameters as in `load`.

    Raises:
        ValueError: If the trust, a list of revoked keys or an argument cannot be used.
        OSError: If a file cannot be read.

    Examples:
        >>> answer = verify("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2029-01-01")
        >>> answer.valid
        False
        >>> [check.name for check in answer.checks if check.passed is False]
        ['in_force']
    """
    return _verification(*next(_each([path], _enquiry(trust, serial, at, time, issuer, revoked, register), 1)))


def verify_many(
    paths: Iterable[Path],
    trust: Path | bytes,
    *,
    threads: int | None = None,
    serial: str | None = None,
    at: Sequence[float] | Array | None = None,
    time: str | datetime.date | None = None,
    issuer: str | None = None,
    revoked: Path | bytes | Iterable[Path | bytes] = (),
    register: Path | bytes | None = None,
) -> Iterator[Verification]:
    """Verify many passports as `verify` does, in the order of `paths`; parameters as in `load_many`.

    A bad file raises nothing; one that cannot be read is not valid, with the code `unreadable`.

    Examples:
        >>> paths = ["passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/nowhere.yaml"]
        >>> [answer.valid for answer in verify_many(paths, "docs/allowed_signers", time="2026-11-20")]
        [True, False]
    """
    enquiry = _enquiry(trust, serial, at, time, issuer, revoked, register)
    return itertools.starmap(_verification, _each(paths, enquiry, threads, raising=False))


def load_many(
    paths: Iterable[Path],
    trust: Path | bytes,
    *,
    threads: int | None = None,
    skip: Callable[[Refused], object] | None = None,
    serial: str | None = None,
    at: Sequence[float] | Array | None = None,
    time: str | datetime.date | None = None,
    issuer: str | None = None,
    revoked: Path | bytes | Iterable[Path | bytes] = (),
    register: Path | bytes | None = None,
) -> Iterator[Passport]:
    """Read and verify many passports on several threads, in the order of `paths`; parameters as in `load`.

    Args:
        paths: Passport files, as many as you like: only some hundreds are in memory at a time.
        threads: Number of threads. Default: one for each processor. They do not hold Python's global lock.
        skip: Function that is called with each `Refused`, also of a file that cannot be read; the others follow.

    Raises:
        Refused: Without `skip`, at the first passport that failed a check, after those before it.

    Examples:
        >>> from pathlib import Path
        >>> paths = sorted(Path("passports/SPS-2/0017").glob("*-1.yaml"))
        >>> [p.id for p in load_many(paths, "docs/allowed_signers", time="2026-11-20")]
        ['SPS-2/0017/beijing-nim/1', 'SPS-2/0017/moscow-bmstu/1']
    """
    # The trust is read at once, so that an error in it does not wait for the first passport.
    enquiry = _enquiry(trust, serial, at, time, issuer, revoked, register)
    answers = _each(paths, enquiry, threads, raising=skip is None)

    def accepted() -> Iterator[Passport]:
        for name, answer in answers:
            try:
                passport = _passport(name, answer)
            except Refused as refused:
                if skip is None:
                    raise
                skip(refused)
            else:
                yield passport

    return accepted()


def load_unverified(path: Path) -> Passport:
    """Read a passport without verifying it: anyone may have written its numbers. It gives a Python warning.

    Raises:
        ValueError: If the file does not have the form of a passport.

    Examples:
        >>> import warnings
        >>> with warnings.catch_warnings(action="ignore"):
        ...     load_unverified("docs/self_check.yaml").verified
        False
    """
    answer = _dtg_passport.unverified(path)
    warnings.warn(f"{os.fspath(path)}: NOT VERIFIED: the origin of these numbers is unknown", stacklevel=2)
    return Passport._of(answer)
