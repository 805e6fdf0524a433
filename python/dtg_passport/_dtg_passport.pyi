"""Types of the compiled part, which converts types and calls the Rust library."""

import os
from collections.abc import Callable
from typing import final

__all__ = ["Content", "Distributions", "Enquiry", "__version__", "earlier", "issue", "plan", "unverified"]

_Path = str | os.PathLike[str]
_File = _Path | tuple[str, bytes]
_Pair = tuple[_File | None, _File | None]
_Check = tuple[str, bool | None, str, str]
_Answer = tuple[str | None, str, bytes, list[_Check], list[str], list[str], Content | None]

__version__: str

@final
class Enquiry:
    def __new__(cls, trust: _File, revoked: list[_File], question: str, register: _Path | bytes | None) -> Enquiry: ...
    def verify(self, file: str, data: bytes) -> _Answer: ...
    def verify_files(self, paths: list[str], threads: int) -> list[tuple[_Answer, OSError | None]]: ...

@final
class Content:
    def json(self) -> str: ...
    def array(self, name: str) -> bytes: ...
    def calibrate(self, currents: _File, order: str, files: _Pair) -> tuple[str, str | None, Distributions]: ...
    def self_check_errors(self, found: list[float]) -> tuple[list[float], float]: ...

@final
class Distributions:
    def __call__(
        self, trials: int | None, seed: int, threads: int | None, progress: Callable[[int, int], object]
    ) -> str: ...

def earlier(result: str) -> str | None: ...
def unverified(file: _File) -> _Answer: ...
def issue(
    files: tuple[_File, _File],
    order: str,
    accuracy: _Pair | None,
    key: _Path,
    passphrase: str | None,
    trust: _File | None,
    out: _Path,
) -> tuple[str, str, str, bool, tuple[str, ...]]: ...
def plan(site: _File, stand: _File | None, files: _Pair, question: str) -> str: ...
