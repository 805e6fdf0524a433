"""Types of the compiled part, which converts types and calls the Rust library."""

from collections.abc import Callable
from typing import final

__all__ = ["Content", "Enquiry", "__version__", "issue", "plan"]

_File = tuple[str, bytes]
_Files = tuple[_File | None, _File | None]
_Check = tuple[str, bool | None, str, str]
_Answer = tuple[str | None, str, list[_Check], Content | None]

__version__: str

@final
class Enquiry:
    def __new__(cls, signers: _File, revoked: list[_File], question: str, register: str | None) -> Enquiry: ...
    def remarks(self) -> list[str]: ...
    def verify(self, file: str, data: bytes) -> _Answer: ...
    def verify_files(self, paths: list[str], threads: int) -> list[_Answer | OSError]: ...

@final
class Content:
    @staticmethod
    def unverified(file: str, data: bytes) -> Content: ...
    @property
    def id(self) -> str: ...
    @property
    def gravity(self) -> float: ...
    def json(self) -> str: ...
    def array(self, name: str) -> bytes: ...
    def calibrate(self, currents: _File, order: str, files: _Files) -> tuple[str, bytes]: ...
    def monte_carlo(
        self,
        currents: _File,
        order: str,
        files: _Files,
        trials: int | None,
        seed: int,
        threads: int | None,
        progress: Callable[[int, int], object] | None,
    ) -> str: ...
    def self_check_errors(self, found: list[float]) -> tuple[list[float], float]: ...

def issue(
    stand: _File,
    site: _File,
    order: str,
    accuracy: _Files | None,
    key: str,
    passphrase: str | None,
    signers: _File | None,
    out: str,
) -> tuple[str, str, str, bool, list[str]]: ...
def plan(site: _File, stand: _File | None, files: _Files, question: str) -> str: ...
