"""Types and helpers of several modules."""

from __future__ import annotations

import datetime
import importlib
import json
import operator
import os
import stat
from collections.abc import Iterable, Mapping, Set
from typing import Any

import numpy as np
import numpy.typing as npt

Path = str | os.PathLike[str]
Array = npt.NDArray[np.float64]
File = Path | Mapping[str, Any]
"""A file of the factory or the laboratory: its path, or its content as a mapping."""


class Frozen:
    """Thing whose attributes cannot be changed."""

    __slots__: tuple[str, ...] = ()

    def __init__(self, *values: object) -> None:
        for name, value in zip(self.__slots__, values):
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a {type(self).__name__.lower()} cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        self.__setattr__(name, None)


def array(data: bytes, *shape: int) -> Array:
    """Return float64 numbers as an array that stays read-only: its memory is that of `data`, which cannot change."""
    return np.frombuffer(data, dtype=np.float64).reshape(shape)


def frozen(values: Any, *shape: int) -> Array:
    """Return numbers as an array that stays read-only."""
    return array(np.array(values, dtype=np.float64).tobytes(), *shape)


def optional(module: str, extra: str) -> Any:
    """Import a package that only some functions need."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        raise ImportError(f'{name} is not installed; install it with: pip install "dtg-passport[{extra}]"') from error


# No file that is read here may be longer; it is that of allowed_signers.
LARGEST_FILE_BYTES = 1 << 24


def named(path: Path) -> tuple[str, bytes]:
    """Return the name and the content of a file. A pipe or a device is refused, because reading it might never end."""
    name = os.fspath(path)
    kind = os.stat(path).st_mode
    if not stat.S_ISREG(kind) and not stat.S_ISDIR(kind):
        raise ValueError(f"{name}: found a pipe, a device or a socket, expected a file")
    with open(path, "rb") as file:
        data = file.read(LARGEST_FILE_BYTES + 1)
    if len(data) > LARGEST_FILE_BYTES:
        raise ValueError(f"{name}: found more than {LARGEST_FILE_BYTES} bytes; check that this is the right file")
    return name, data


def numbers(name: str, values: Any) -> list[float]:
    """Return the numbers of a list; a text, a set or a mapping is none."""
    if isinstance(values, (str, bytes, Set, Mapping)) or not isinstance(values, Iterable):
        raise TypeError(f"{name}: found {values!r}, expected a list of numbers")
    try:
        return [float(value) for value in values]
    except (TypeError, ValueError):
        raise TypeError(f"{name}: found {values!r}, expected a list of numbers") from None


def text(name: str, value: object) -> str | None:
    """Return a text, or None."""
    if value is None or isinstance(value, str):
        return value
    raise TypeError(f"{name}: found {value!r}, expected a text")


def whole(name: str, value: Any, least: int, most: int) -> int:
    """Return a whole number within limits, of any type that is one."""
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: found {value!r}, expected a whole number") from None
    if not least <= found <= most:
        raise ValueError(f"{name}: found {found}, expected a whole number from {least} to {most}")
    return found


def document(file: File, name: str) -> tuple[str, bytes]:
    """Return the name and the content of a file or of a mapping."""
    if not isinstance(file, Mapping):
        return named(file)
    return name, json_text(file).encode()


def json_text(values: Mapping[str, Any]) -> str:
    """Return values as JSON, which is also YAML."""
    return json.dumps(dict(values), default=_plain, ensure_ascii=False, indent=1)


def documents(gyro: File | None, laboratory: File | None) -> tuple[tuple[str, bytes] | None, tuple[str, bytes] | None]:
    """Return the name and the content of a gyro type and of a laboratory."""
    return (
        None if gyro is None else document(gyro, "gyro"),
        None if laboratory is None else document(laboratory, "laboratory"),
    )


def moment(name: str, time: str | datetime.date | None) -> str | None:
    """Return a time or a date as text."""
    if isinstance(time, datetime.datetime):
        return time.isoformat(timespec="seconds")
    return time.isoformat() if isinstance(time, datetime.date) else text(name, time)


def _plain(value: Any) -> Any:
    """Convert what JSON lacks: dates, mappings, numbers and arrays of NumPy."""
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, datetime.date):
        return moment("", value)
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"found {value!r}, expected text, numbers, lists and mappings")
