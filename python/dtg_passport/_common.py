"""Types and helpers of several modules."""

from __future__ import annotations

import contextlib
import datetime
import importlib
import json
import math
import operator
import os
from collections.abc import Iterable, Mapping, Set
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _dtg_passport

Path = str | os.PathLike[str]
Array = npt.NDArray[np.float64]
File = Path | bytes | Mapping[str, Any]
"""A file of the factory or the laboratory: its path, or its content as bytes or as a mapping."""


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


def whole_numbers(values: Any) -> npt.NDArray[np.int64]:
    """Return pairs of indices as an array that stays read-only."""
    return np.frombuffer(np.array(values, dtype=np.int64).tobytes(), dtype=np.int64).reshape(-1, 2)


def optional(module: str, extra: str) -> Any:
    """Import a package that only some functions need."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        raise ImportError(f'{name} is not installed; install it with: pip install "dtg-passport[{extra}]"') from error


def numbers(name: str, values: Any) -> list[float]:
    """Return the numbers of a list; a text, a set or a mapping is none."""
    if isinstance(values, Iterable) and not isinstance(values, (str, bytes, Set, Mapping)):
        with contextlib.suppress(TypeError, ValueError):
            return [float(value) for value in values]
    raise TypeError(f"{name}: found {values!r}, expected a list of numbers")


def whole(name: str, value: Any, least: int, most: int) -> int:
    """Return a whole number within limits, of any type that is one."""
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: found {value!r}, expected a whole number") from None
    if not least <= found <= most:
        raise ValueError(f"{name}: found {found}, expected a whole number from {least} to {most}")
    return found


def given(name: str, file: File) -> _dtg_passport._File:
    """Return a file as the compiled part reads it: its path, or a name and its content."""
    if not isinstance(file, Mapping):
        return path_or_content(name, file)
    values = {key: _plain(f"{name}: {key}", value) for key, value in file.items()}
    # JSON is also YAML; errors name the line.
    return name, json.dumps(values, ensure_ascii=False, indent=1).encode()


def pair(gyro: File | None, laboratory: File | None) -> _dtg_passport._Pair:
    """Return a gyro type and a laboratory as the compiled part reads them."""
    return (
        None if gyro is None else given("gyro", gyro),
        None if laboratory is None else given("laboratory", laboratory),
    )


def asked(**values: Any) -> str:
    """Return a question or an order as JSON, which the library checks; of None, the key is left out."""
    return json.dumps({key: _plain(key, value) for key, value in values.items() if value is not None}, ensure_ascii=False)


def path_or_content(name: str, file: Path | bytes) -> _dtg_passport._File:
    """Return a file as the compiled part reads it. Bytes are its content, and anything else is its path."""
    return (name, file) if isinstance(file, bytes) else file


def _plain(at: str, value: Any) -> Any:
    """Convert what JSON lacks: dates, mappings, results, numbers and arrays of NumPy. An error names its place."""
    if value is None:
        return None
    value = getattr(value, "_document", value)
    if isinstance(value, (np.generic, np.ndarray)) and not np.ma.is_masked(value):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"{at}: found {value}, expected a finite number")
    if isinstance(value, (str, int, float)):
        return value
    if isinstance(value, datetime.datetime):
        return value.isoformat(timespec="seconds")
    if isinstance(value, datetime.date):
        return value.isoformat()
    if isinstance(value, Mapping):
        return {key: _plain(f"{at}.{key}", part) for key, part in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, (bytes, Set)):
        return [_plain(f"{at}[{place}]", part) for place, part in enumerate(value)]
    raise TypeError(f"{at}: found {value!r}, expected text, numbers, lists and mappings")
