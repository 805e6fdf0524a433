"""Types and helpers of several modules."""

from __future__ import annotations

import datetime
import importlib
import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Path = str | os.PathLike[str]
Array = npt.NDArray[np.float64]
File = Path | Mapping[str, Any]
"""A file of the factory or the laboratory: its path, or its content as a mapping."""


class Frozen:
    """Thing whose attributes cannot be changed."""

    __slots__ = ()

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


def named(path: Path) -> tuple[str, bytes]:
    """Return the name and the content of a file."""
    with open(path, "rb") as file:
        return os.fspath(path), file.read()


def document(file: File, name: str) -> tuple[str, bytes]:
    """Return the name and the content of a file or of a mapping. A mapping becomes JSON, which is also YAML."""
    if not isinstance(file, Mapping):
        return named(file)
    return name, json.dumps(dict(file), default=_plain, ensure_ascii=False, indent=1).encode()


def documents(gyro: File | None, laboratory: File | None) -> tuple[tuple[str, bytes] | None, tuple[str, bytes] | None]:
    """Return the name and the content of a gyro type and of a laboratory."""
    return (
        None if gyro is None else document(gyro, "gyro"),
        None if laboratory is None else document(laboratory, "laboratory"),
    )


def moment(time: str | datetime.date | None) -> str | None:
    """Return a time or a date as text."""
    if isinstance(time, datetime.datetime):
        return time.isoformat(timespec="seconds")
    return time.isoformat() if isinstance(time, datetime.date) else time


def _plain(value: Any) -> Any:
    """Convert what JSON lacks: dates, mappings, numbers and arrays of NumPy."""
    if isinstance(value, Mapping):
        return dict(value)
    return moment(value) if isinstance(value, datetime.date) else value.tolist()
