"""Types and helpers of several modules."""

from __future__ import annotations

import importlib
import os
from typing import Any

import numpy as np
import numpy.typing as npt

Path = str | os.PathLike[str]
Array = npt.NDArray[np.float64]


def array(data: bytes, *shape: int) -> Array:
    """Return float64 numbers as an array that stays read-only: its memory is that of `data`, which cannot change."""
    return np.frombuffer(data, dtype=np.float64).reshape(shape)


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
