"""The passport and its checks."""

from __future__ import annotations

import datetime
import json
import os
import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _dtg_passport
from ._calibration import NAMES, Calibration, Parameters, eight, judged
from ._common import Array, File, Frozen, array, asked, optional, pair, whole_numbers

# Unit of every array, and what its rows and columns are.
_ARRAYS = {
    "delta": ("1", "row", "column"),
    "B": ("deg/h", "row", "column"),
    "C": ("deg/(h*g)", "row", "column"),
    "n2_inverse": ("1/g", "row", "column"),
    "ij": ("1", "position", "index"),
    "omega": ("deg/h", "position", "axis"),
    "n": ("g", "position", "axis"),
    "deviations": ("arcsec", "position", "angle"),
    "u_deviations": ("arcsec", "position", "angle"),
}


class Check(NamedTuple):
    """Result of one check."""

    name: str
    """Name of the check, such as `signature`."""
    passed: bool | None
    """Whether the check passed, or None if it was not run or not requested (`code` is then `not_run` or `not_asked`)."""
    code: str
    """Result as a code for programs, such as `altered`."""
    detail: str
    """Result as a sentence."""


class Verification(NamedTuple):
    """Answer to the question whether a passport may be used."""

    path: str
    """Path of the file."""
    valid: bool
    """Whether every requested check passed."""
    id: str | None
    """Id of the passport, or None if the signature or the content is not correct."""
    checks: tuple[Check, ...]
    """Every check."""
    passport: Passport | None
    """The passport if every check passed, otherwise None."""
    not_asked: tuple[str, ...]
    """Names of the checks that the question did not request."""
    remarks: tuple[str, ...]
    """Remarks on the trusted keys and the register."""

    def __bool__(self) -> bool:
        """Return `valid`."""
        return self.valid


class Refused(Exception):
    """A passport that failed a check."""

    __module__ = "dtg_passport"

    path: str
    """Path of the file."""
    checks: tuple[Check, ...]
    """Every check; those with `passed` False failed."""

    def __init__(self, path: str, checks: tuple[Check, ...]) -> None:
        super().__init__(path, checks)
        self.path = path
        self.checks = checks

    def __str__(self) -> str:
        failed = [f"  {check.name} ({check.code}): {check.detail}" for check in self.checks if check.passed is False]
        return "\n".join([f"{self.path}: refused", *failed])


class _Dict(dict[str, Any]):
    """A mapping of the content, which cannot be changed; a deep copy can."""

    def _refuse(self, *_: Any, **__: Any) -> Any:
        raise TypeError("the content of a passport cannot be changed; change a copy.deepcopy of it")

    __setitem__ = __delitem__ = __ior__ = update = setdefault = pop = popitem = clear = _refuse

    def __deepcopy__(self, memo: Any) -> dict[str, Any]:
        import copy

        return {key: copy.deepcopy(value, memo) for key, value in self.items()}


class _List(list[Any]):
    """A list of the content, which cannot be changed; a deep copy can."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = _Dict._refuse
    append = extend = insert = pop = remove = clear = sort = reverse = _Dict._refuse

    def __deepcopy__(self, memo: Any) -> list[Any]:
        import copy

        return [copy.deepcopy(value, memo) for value in self]


def _unchangeable(value: Any) -> Any:
    if isinstance(value, dict):
        return _Dict((key, _unchangeable(part)) for key, part in value.items())
    return _List(map(_unchangeable, value)) if isinstance(value, list) else value


class Position(NamedTuple):
    """Coefficients and deviations of one position."""

    n: Array
    """Specific force along x and y, g, shape (2,)."""
    omega: Array
    """Earth rate along x and y, deg/h, shape (2,)."""
    deviations: Array
    """Certified deviations alpha, beta, gamma, arcsec, shape (3,)."""
    u_deviations: Array
    """Their standard uncertainties, arcsec, shape (3,); NaN where none is stated."""


class SelfCheck(NamedTuple):
    """Result of a self-check of laboratory software."""

    passed: bool
    """Whether every parameter agrees within `limit`."""
    errors: Mapping[str, float]
    """Relative error |found/stated - 1| of each parameter."""
    limit: float
    """Largest permitted error, 1e-9."""

    def __bool__(self) -> bool:
        """Return `passed`."""
        return self.passed


class Passport(Frozen):
    """A passport. Its numbers are those that were signed, to the last bit, and cannot be changed.

    It is created by `load` and its siblings. Arrays are float64 and read-only. What the passport does not state is NaN.
    Rows belong to the positions in the order of `ij`.
    """

    __slots__ = ("_id", "_sha256", "_data", "_checks", "_content", "_parsed")
    __module__ = "dtg_passport"

    _id: str
    _sha256: str
    _data: bytes
    _checks: list[_dtg_passport._Check]
    _content: _dtg_passport.Content
    _parsed: _Dict

    @classmethod
    def _of(cls, answer: _dtg_passport._Answer) -> Passport:
        id, sha256, data, checks, _, _, content = answer
        return cls(id, sha256, data, checks, content)

    def __reduce__(self) -> Any:
        raise TypeError("a passport is not pickled, because its verification would be believed without being made: send "
                        "`passport.data` and verify it with `loads` where it arrives")  # fmt: skip

    def __copy__(self) -> Passport:
        return self

    def __deepcopy__(self, memo: Any) -> Passport:
        return self

    @property
    def data(self) -> bytes:
        """The bytes of the file, for `loads` elsewhere."""
        return self._data

    @property
    def serial(self) -> str:
        """Serial number of the stand."""
        return str(self.content["stand"]["serial"])

    @property
    def site(self) -> str:
        """Identifier of the site."""
        return str(self.content["site"]["id"])

    @property
    def latitude(self) -> float:
        """Latitude for which the Earth rates were computed, degrees, north positive."""
        return float(self.content["earth"]["latitude_deg"])

    @property
    def expires(self) -> datetime.date | None:
        """Last UTC day on which the passport is valid, or None if neither it nor its certificate states one."""
        stated = (self.content[part].get("valid_until") for part in ("passport", "certificate"))
        return min((datetime.date.fromisoformat(day) for day in stated if day), default=None)

    @property
    def id(self) -> str:
        """Identifier: model, serial number, site and revision, separated by `/`."""
        return self._id

    @property
    def sha256(self) -> str:
        """SHA-256 of the whole file, in lower-case hexadecimal."""
        return self._sha256

    @property
    def verified(self) -> bool:
        """Whether the passport was verified; False only after `load_unverified`."""
        return bool(self._checks)

    @property
    def checks(self) -> tuple[Check, ...]:
        """Every check that was run; empty after `load_unverified`."""
        return tuple(map(Check._make, self._checks))

    @property
    def delta(self) -> Array:
        """Matrix Delta = n2_inverse @ n1 of the paper, eq. (13), shape (2, 2); NaN without the paper's eight positions."""
        return self._array("delta", 2, 2)

    @property
    def B(self) -> Array:
        """Matrix B of the paper, eq. (13), deg/h, shape (2, 2); NaN without the paper's eight positions."""
        return self._array("b_deg_per_h", 2, 2)

    @property
    def C(self) -> Array:
        """Matrix C of the paper, eq. (15), deg/(h*g), shape (2, 2); NaN without the paper's eight positions."""
        return self._array("c_deg_per_h_per_g", 2, 2)

    @property
    def n2_inverse(self) -> Array:
        """Inverse of n_2, 1/g, shape (2, 2); NaN without the paper's eight positions."""
        return self._array("n2_inverse", 2, 2)

    @property
    def ij(self) -> npt.NDArray[np.int64]:
        """Indices i (frame) and j (platform) of the positions, counted from 1, int64, shape (N, 2)."""
        return whole_numbers(self._array("ij", -1, 2))

    @property
    def theta(self) -> Array:
        """Nominal angle theta (frame) of each position, degrees, shape (N,)."""
        return self._array("angles", -1, 2)[:, 0]

    @property
    def phi(self) -> Array:
        """Nominal angle phi (platform) of each position, degrees, shape (N,)."""
        return self._array("angles", -1, 2)[:, 1]

    @property
    def n(self) -> Array:
        """Specific force along x and y of the case in each position, g, shape (N, 2)."""
        return self._array("n", -1, 2)

    @property
    def omega(self) -> Array:
        """Earth rate along x and y of the case in each position, deg/h, shape (N, 2)."""
        return self._array("omega", -1, 2)

    @property
    def deviations(self) -> Array:
        """Certified deviations alpha, beta, gamma of each position, arcsec, shape (N, 3)."""
        return self._array("deviations", -1, 3)

    @property
    def u_deviations(self) -> Array:
        """Standard uncertainties of `deviations`, arcsec, shape (N, 3); NaN where none is stated."""
        return self._array("u_deviations", -1, 3)

    @property
    def gravity(self) -> float:
        """Local gravity to which g-sensitive drifts refer, m/s^2."""
        return float(self._array("gravity"))

    @property
    def units(self) -> Mapping[str, str]:
        """Unit of every array and of `gravity`.

        >>> passport = load("docs/self_check.yaml", "docs/allowed_signers", time="2026-11-20")
        >>> passport.units["C"]
        'deg/(h*g)'
        """
        return MappingProxyType({name: unit for name, (unit, _, _) in _ARRAYS.items()} | {"gravity": "m/s^2"})

    @property
    def content(self) -> dict[str, Any]:
        """All keys of the file but `signature`, as a dictionary that cannot be changed.

        >>> passport = load("docs/self_check.yaml", "docs/allowed_signers", time="2026-11-20")
        >>> passport.content["passport"]["issuer"]
        'examples@dtg-passport.test'
        """
        if not hasattr(self, "_parsed"):
            object.__setattr__(self, "_parsed", _unchangeable(json.loads(self._content.json())))
        return self._parsed

    def _array(self, name: str, *shape: int) -> Array:
        return array(self._content.array(name), *shape)

    def at(self, i: int, j: int) -> Position:
        """Return the coefficients and deviations of position (i, j).

        Raises:
            KeyError: If the passport has no such position.

        Examples:
            >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> passport.at(1, 3).deviations
            array([77.2, 40.6, 21.5])
        """
        [places] = np.nonzero((self.ij == (i, j)).all(axis=1))
        if len(places) == 0:
            raise KeyError(f"the passport has no position ({i}, {j})")
        k = int(places[0])
        return Position(self.n[k], self.omega[k], self.deviations[k], self.u_deviations[k])

    def calibrate(
        self,
        currents: object,
        *,
        laboratory: File | None = None,
        gyro: File | None = None,
        method: str = "least-squares",
        model: str = "paper",
        anisoelasticity: bool = False,
        drift: bool = False,
        exclude: Iterable[Mapping[str, Any]] = (),
        gyro_serial: str | None = None,
        operator: str | None = None,
        date: datetime.date | str | None = None,
        temperature_c: float | None = None,
        previous: Iterable[Calibration | Mapping[str, Any]] = (),
        budget: bool = False,
    ) -> Calibration:
        """Calibrate a gyro from its currents in every position.

        Args:
            currents: Path of a CSV file; a table (of pandas, Polars or Arrow, a mapping, or a structured array) with
                the columns `i`, `j`, `jx_ma`, `jy_ma`, and if present `cycle`, `visit`, `time_s`, `theta_deg`,
                `phi_deg`; or an array of shape (N, 4) with rows i, j, jx_ma, jy_ma. Currents in mA.
            laboratory: Laboratory, `dtg-laboratory/1`: path of the file, its bytes, or a mapping. Default: the paper's
                meter, 0.015 %; `assumed_meter` then says so.
            gyro: Gyro type, `dtg-gyro/1`, for the verdict: path of the file, its bytes, or a mapping.
            method: `least-squares`, `analytic` or `iterative`.
            model: Model of the g-sensitive drift: `paper`, or `general` for the full 2x3 matrix `G`; omega_g and
                omega_k are then NaN.
            anisoelasticity: Whether to fit the anisoelastic coefficient too; the eight positions alone do not determine
                it.
            drift: Whether to fit a linear drift of omega_0 in time; needs `time_s`.
            exclude: Visits to leave out, with the keys `i`, `j`, `visit`, if needed `cycle`, and `why`, the reason.
            gyro_serial, operator, date, temperature_c: Serial number of the gyro, name of the operator, day
                (`datetime.date` or `YYYY-MM-DD`) and temperature (°C) of the readings; the result repeats them.
            previous: Earlier results of the same gyro: a Calibration or its `document`. With `gyro`,
                `document["change"]` is the change since the latest of them.
            budget: Whether to add the budget of the uncertainty, `document["budget"]`.

        Raises:
            NotValid: If the parameters are not those of the gyro, because the readings do not fit the stand, or an error
                such as currents in another unit explains them. It has the `result`.
            ValueError: If the currents cannot be used, or do not determine the parameters; with the line and column. Or
                if an argument cannot be used.

        Examples:
            >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> found = passport.calibrate("docs/currents.csv", gyro="docs/gvk-6.yaml")
            >>> found.K.round(3)  # deg/(h*mA)
            array([[94.994,  9.499],
                   [ 9.5  , 95.   ]])
            >>> found.verdict["overall"]
            'undecided'
        """
        order = asked(method=method, model=model, anisoelasticity=anisoelasticity, drift=drift, exclude=exclude,
                      gyro_serial=gyro_serial, operator=operator, date=date, temperature_c=temperature_c,
                      previous=previous, budget=budget)  # fmt: skip
        found = judged(*self._content.calibrate(_csv(currents), order, pair(gyro, laboratory)))
        for remark in found.remarks:
            warnings.warn(remark, stacklevel=2)
        return found

    def self_check(self, function: Callable[[Passport, Array], Calibration | Sequence[npt.ArrayLike]]) -> SelfCheck:
        """Test laboratory software with the self-check of this passport.

        Args:
            function: Software under test. It is called with the passport and currents, rows i, j, jx_ma, jy_ma of shape
                (N, 4), and returns a Calibration, or the four parameters K (2, 2), omega_0 (2,), omega_g and omega_k.

        Raises:
            ValueError: If the passport has no self-check.

        Examples:
            >>> passport = load("docs/self_check.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> passport.self_check(lambda passport, currents: passport.calibrate(currents, method="analytic")).passed
            True
        """
        currents = self._array("self_check", -1, 4)
        if len(currents) == 0:
            raise ValueError("this passport has no self-check: its positions do not determine the eight parameters")
        found = function(self, currents)
        numbers = eight(found.parameters if isinstance(found, Calibration) else found)
        errors, limit = self._content.self_check_errors(numbers)
        # A NaN is not within the limit.
        return SelfCheck(all(error <= limit for error in errors), dict(zip(NAMES, errors)), limit)

    def to_dataframe(self) -> Any:
        """Return the positions as a pandas DataFrame with the index (i, j); units are in the names of the columns."""
        pandas = optional("pandas", "pandas")
        columns: dict[str, Any] = {}
        for name, unit, parts in (
            ("angles", "deg", ("theta", "phi")),
            ("deviations", "arcsec", ("alpha", "beta", "gamma")),
            ("u_deviations", "arcsec", ("u_alpha", "u_beta", "u_gamma")),
            ("n", "g", ("n_x", "n_y")),
            ("omega", "deg_per_h", ("omega_x", "omega_y")),
        ):
            columns.update(zip([f"{part}_{unit}" for part in parts], self._array(name, -1, len(parts)).T))
        index = pandas.MultiIndex.from_arrays(self.ij.T, names=["i", "j"])
        return pandas.DataFrame(columns, index=index)

    def to_xarray(self) -> Any:
        """Return every array as an xarray Dataset; each variable has the attribute `units`."""
        xarray = optional("xarray", "xarray")
        named = [(name, unit, of) for name, (unit, *of) in _ARRAYS.items() if name != "ij"]
        variables = {name: (of, getattr(self, name), {"units": unit}) for name, unit, of in named}
        i, j = self.ij.T
        coordinates = {
            "i": ("position", i),
            "j": ("position", j),
            "axis": ["x", "y"],
            "angle": ["alpha", "beta", "gamma"],
        }
        attributes = {"id": self.id, "sha256": self.sha256, "verified": int(self.verified), "gravity_m_per_s2": self.gravity}
        return xarray.Dataset(variables, coordinates, attributes)

    def plot(self, ax: Any = None) -> Any:
        """Draw the certified deviations with their expanded uncertainties (k = 2), arcsec; return the matplotlib axes."""
        ax = optional("matplotlib.pyplot", "plot").subplots()[1] if ax is None else ax
        places = np.arange(len(self.ij))
        for part, (symbol, shift) in enumerate((("α", -0.25), ("β", 0.0), ("γ", 0.25))):
            error = 2.0 * np.nan_to_num(self.u_deviations[:, part])
            ax.bar(places + shift, self.deviations[:, part], 0.25, yerr=error, label=symbol)
        ax.set_xticks(places, [f"({i}, {j})" for i, j in self.ij])
        ax.set(xlabel="position (i, j)", ylabel="deviation, arcsec", title=f"{self.id}{self._mark}")
        ax.legend()
        return ax

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Passport) and (self.sha256, self.verified) == (other.sha256, other.verified)

    def __hash__(self) -> int:
        return hash(self.sha256)

    @property
    def _mark(self) -> str:
        return "" if self.verified else " NOT VERIFIED"

    def __repr__(self) -> str:
        return f"<Passport {self.id}{self._mark}>"

    def _repr_html_(self) -> str:
        import html

        content = self.content
        header, certificate = content["passport"], content["certificate"]
        facts = (
            f"issued {header['issued_at']} by {header['issuer']}",
            f"certificate {certificate['number']} of {certificate['issued']}, {certificate['laboratory']}",
            f"SHA-256 {self.sha256}",
        )
        verified = "all checks passed" if self.verified else "<strong>NOT VERIFIED</strong>"
        title = f"<strong>Passport {html.escape(self.id)}</strong>: {verified}"
        words = "".join(f"<div>{html.escape(fact)}</div>" for fact in facts)
        table = "<tr><th>i</th><th>j</th><th>α, ″</th><th>β, ″</th><th>γ, ″</th></tr>"
        for row in np.hstack([self.ij, self.deviations]):
            table += "<tr>" + "".join(f"<td>{number:g}</td>" for number in row) + "</tr>"
        return f"<div>{title}{words}<table>{table}</table></div>"


# Columns of currents: the first four are those of an array, the others may be in a table too.
_COLUMNS = ("i", "j", "jx_ma", "jy_ma", "cycle", "visit", "time_s", "theta_deg", "phi_deg")


def _csv(currents: object) -> _dtg_passport._File:
    """Return currents as a path, or as a name and CSV, which the library reads with every check."""
    if isinstance(currents, (str, os.PathLike)):
        return currents
    if currents is None or isinstance(currents, (bytes, Set)):
        raise TypeError(f"currents: found {type(currents).__name__}, expected a path, a table, a mapping or an array")
    if not isinstance(currents, Mapping):
        table: Any = currents
        if hasattr(table, "reset_index"):  # of pandas; columns may be in the index, as in `to_dataframe`
            table = table.reset_index([name for name in table.index.names if name is not None and name not in table])
        of_frame = getattr(table, "column_names", getattr(table, "columns", None))  # of Arrow; of pandas and Polars
        names = getattr(getattr(table, "dtype", None), "names", None) if of_frame is None else of_frame
        currents = table if names is None else {name: table[name] for name in names}
    if isinstance(currents, Mapping):
        known = [name for name in _COLUMNS if name in currents]
        columns = {name: _column(name, currents[name]) for name in known}
        if len(set(map(len, columns.values()))) > 1:
            lengths = ", ".join(f"{name} {len(column)}" for name, column in columns.items())
            raise ValueError(f"currents: found columns of different lengths ({lengths})")
        # Of other columns only the name goes on, which may be a misspelt one. Their text could be read as rows.
        others = [re.sub(r'[",;\s]+', " ", str(name)).strip() or "_" for name in currents if name not in known]
        rows = [",".join((*row, *("" for _ in others))) for row in zip(*columns.values())]
        return "currents", "\n".join([",".join((*known, *others)), *rows, ""]).encode()
    table = np.asanyarray(currents)  # keeps a mask
    if table.ndim != 2 or table.shape[1] != 4:
        raise ValueError(f"currents: found an array of shape {table.shape}, expected (N, 4): {', '.join(_COLUMNS[:4])}")
    return _csv(dict(zip(_COLUMNS, table.T)))


def _column(name: str, values: Any) -> list[str]:
    """Return the cells of a column of numbers, none of which loses its mask or its imaginary part on the way.

    NumPy makes even whole numbers such as i and j floats.
    """
    if np.ma.is_masked(values):
        raise ValueError(f"currents: {name}: found masked values; leave out the rows that have one")
    if np.iscomplexobj(values):
        raise TypeError(f"currents: {name}: found complex numbers, expected real ones")
    try:
        cells = np.asarray(values)
        if cells.dtype.kind in "mM" and name != "time_s":
            raise TypeError(f"found {cells.dtype}, expected numbers")
        cells = cells - cells[:1] if cells.dtype.kind == "M" else cells
        cells = cells / np.timedelta64(1, "s") if cells.dtype.kind == "m" else cells
        numbers = cells.astype(np.float64).ravel().tolist()
    except (TypeError, ValueError) as error:
        raise ValueError(f"currents: {name}: {error}") from None
    return [str(int(number)) if number.is_integer() and abs(number) < 2**53 else repr(number) for number in numbers]
