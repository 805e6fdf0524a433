"""Work of the factory: passports are issued, and positions are planned."""

from __future__ import annotations

import datetime
import json
import os
from collections.abc import Iterable
from typing import Any, NamedTuple

from . import _dtg_passport
from ._calibration import Parameters, parameters
from ._common import Array, File, Path, asked, frozen, given, numbers, pair, path_or_content, whole


class Issued(NamedTuple):
    """A passport that exists now."""

    id: str
    """Identifier: model, serial number, site and revision, separated by `/`."""
    path: str
    """Path of the file."""
    sha256: str
    """SHA-256 of the file, in lower-case hexadecimal."""
    new: bool
    """Whether the passport is new; False if an equal one existed, which was left unchanged."""
    remarks: tuple[str, ...]
    """What the factory should know before it delivers a new passport, a sentence each."""


class Plan(NamedTuple):
    """The best positions to certify or to read."""

    order: Array
    """Nominal angles theta and phi of each visit, in the best order, degrees, shape (N, 2)."""
    u: Parameters
    """Standard uncertainties from errors of single readings; those that all share are in `document`."""
    paper_u: Parameters | None
    """The same with the paper's eight positions; None if they cannot be compared."""
    frame_axis_azimuth: float
    """Azimuth of the frame's axis, degrees clockwise from north."""
    value: float
    """Value by the criterion; the smallest of all plans that were compared."""
    document: dict[str, Any]
    """The whole plan, as `plan --format json` prints it."""


def issue(
    stand: File,
    site: File,
    *,
    key: Path,
    identity: str,
    out: Path = "passports",
    issued_at: str | datetime.date | None = None,
    valid_until: str | datetime.date | None = None,
    accuracy: bool = False,
    gyro: File | None = None,
    laboratory: File | None = None,
    trust: Path | bytes | None = None,
    allow_uncalibratable: bool = False,
    passphrase: str | None = None,
) -> Issued:
    """Issue the signed passport of a stand for a site: the same bytes as `dtg-passport issue`.

    An equal passport that exists is left unchanged, and no passport is replaced. The register of the stand, beside it,
    then lists it.

    Args:
        stand: Certified stand, `dtg-stand/1`: path of the file, or a mapping.
        site: Site, `dtg-site/1`: path of the file, or a mapping.
        key: Private key file, or a .pub file whose private half is in ssh-agent or a FIDO token.
        identity: Issuer: the principal of the key in allowed_signers.
        out: Folder of passports; the file is `<model>/<serial>/<site id>-1.yaml` in it.
        issued_at: Time of issue: RFC 3339, a UTC date, or a `datetime` with a time zone. Default: now.
        valid_until: Expiry date (inclusive), not later than that of the certificate. Default: that of the certificate.
        accuracy: Whether to include the expected calibration uncertainty.
        gyro, laboratory: Gyro type and laboratory for `accuracy`: paths, or mappings. Default: the paper's.
        trust: Allowed_signers, a path or content as bytes: the passport is written only if it passes verification with it.
            The key needs the namespaces dtg-passport and dtg-register.
        allow_uncalibratable: Whether to issue even if the positions do not determine the parameters of a gyro.
        passphrase: Passphrase of an encrypted key. Default: the environment variable DTG_PASSPORT_PASSPHRASE.

    Raises:
        ValueError: If an input cannot be used, or the passport is refused. No file is then left.
        OSError: If a file cannot be read or written.

    Examples:
        >>> import subprocess, tempfile
        >>> folder = tempfile.mkdtemp()
        >>> _ = subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", f"{folder}/key"])
        >>> issued = issue("passports/SPS-2/0017/stand.yaml", "sites/moscow-bmstu.yaml", key=f"{folder}/key",
        ...                identity="factory@example.org", issued_at="2026-11-09", out=folder)
        >>> issued.id, issued.new
        ('SPS-2/0017/moscow-bmstu/1', True)
    """
    if not accuracy and (gyro is not None or laboratory is not None):
        raise ValueError("gyro and laboratory are those of the accuracy; give accuracy=True too")
    return Issued(*_dtg_passport.issue(
        (given("stand", stand), given("site", site)),
        asked(identity=identity, issued_at=issued_at, valid_until=valid_until, allow_uncalibratable=allow_uncalibratable),
        pair(gyro, laboratory) if accuracy else None,
        key,
        os.environ.get("DTG_PASSPORT_PASSPHRASE") if passphrase is None else passphrase,
        None if trust is None else path_or_content("trust", trust),
        out,
    ))  # fmt: skip


def plan(
    site: File,
    *,
    stand: File | None = None,
    gyro: File | None = None,
    laboratory: File | None = None,
    readings: int = 8,
    step: float | None = None,
    frame_axis_azimuths: Iterable[float] = (),
    criterion: str = "a",
) -> Plan:
    """Find the best positions to certify or to read, how often and in which order, as `dtg-passport plan` does.

    Args:
        site: Site, `dtg-site/1`: path of the file, or a mapping.
        stand: Certified stand to read, `dtg-stand/1`: path or mapping. Default: nominal positions, without deviations.
        gyro, laboratory: Gyro type and laboratory: paths, or mappings. Default: the paper's.
        readings: Number of readings, 4 to 256, each after a return to its position.
        step: Step of theta and phi to choose from without a stand, degrees. Default: quadrants.
        frame_axis_azimuths: Azimuths of the frame's axis to choose from, degrees clockwise from north. Default: that of
            the site.
        criterion: What plans are compared by: `a`, the sum of (u/tolerance)^2; `d`, the determinant of the covariance;
            `worst`, the largest u/tolerance.

    Raises:
        ValueError: If an input cannot be used, or no choice determines the parameters.
        OSError: If a file cannot be read.

    Examples:
        >>> found = plan("sites/moscow-bmstu.yaml", readings=8, frame_axis_azimuths=[90, 0])
        >>> found.order.shape, found.frame_axis_azimuth
        ((8, 2), 0.0)
        >>> f"{found.u.omega_g:.5f} deg/h/g, with the paper's positions {found.paper_u.omega_g:.5f}"
        "0.00084 deg/h/g, with the paper's positions 0.00120"
    """
    question = asked(
        readings=whole("readings", readings, 4, 256),
        step_deg=None if step is None else float(step),
        frame_axis_azimuths_deg=numbers("frame_axis_azimuths", frame_axis_azimuths),
        criterion=criterion,
    )
    files = (given("site", site), None if stand is None else given("stand", stand), pair(gyro, laboratory))
    found = json.loads(_dtg_passport.plan(*files, question))
    u, paper = found["standard_uncertainty"], found.get("paper")
    paper_u = None if paper is None else parameters(paper["standard_uncertainty"])
    return Plan(frozen(found["order"], -1, 2), parameters(u), paper_u, found["frame_axis_azimuth_deg"], found["value"], found)
