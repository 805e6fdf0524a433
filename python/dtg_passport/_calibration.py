"""The result of a calibration."""

from __future__ import annotations

import contextlib
import json
import sys
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _dtg_passport
from ._common import Array, Frozen, frozen, optional, whole, whole_numbers

NAMES = ("k_x", "k_xy", "k_yx", "k_y", "omega_0x", "omega_0y", "omega_g", "omega_k")
"""Names and order of the eight parameters."""


class Parameters(NamedTuple):
    """The parameters of a gyro, or their standard uncertainties."""

    K: Array
    """Scale factors [[K_x, K_xy], [K_yx, K_y]], deg/(h*mA), shape (2, 2)."""
    omega_0: Array
    """Constant drift about x and y, deg/h, shape (2,)."""
    omega_g: float
    """g-sensitive drift omega_g, deg/h per local g; NaN in the general model."""
    omega_k: float
    """g-sensitive drift omega_k, deg/h per local g; NaN in the general model."""


class MonteCarlo(NamedTuple):
    """Distributions of the parameters by Monte Carlo (JCGM 101), in their units."""

    mean: Parameters
    """Means of the trials."""
    u: Parameters
    """Standard deviations of the trials."""
    interval: tuple[Parameters, Parameters]
    """Ends of the probabilistically symmetric 95 % coverage intervals."""
    shortest: tuple[Parameters, Parameters]
    """Ends of the shortest 95 % coverage intervals."""
    covariance: Array
    """Covariance of k_x, k_xy, k_yx, k_y, omega_0x, omega_0y, omega_g, omega_k, shape (8, 8)."""
    trials: int
    """Number of trials made."""
    stable: bool
    """Whether two digits of every uncertainty are stable."""
    document: dict[str, Any]
    """The whole result: the key `monte_carlo` of `calibrate --format json`."""


def parameters(result: dict[str, Any]) -> Parameters:
    """Return the parameters of a gyro from their keys."""
    return Parameters(
        frozen(result["k_deg_per_h_per_ma"], 2, 2),
        frozen(result["omega0_deg_per_h"], 2),
        result.get("omega_g_deg_per_h_per_g", np.nan),
        result.get("omega_k_deg_per_h_per_g", np.nan),
    )


def _eight(values: list[float]) -> Parameters:
    return Parameters(frozen(values[:4], 2, 2), frozen(values[4:6], 2), *values[6:])


def eight(of: Any) -> list[float]:
    """Return the numbers of K (2, 2), omega_0 (2,), omega_g and omega_k in the order of `NAMES`."""
    numbers = [np.asarray(part, dtype=np.float64).ravel() for part in of]
    if [len(part) for part in numbers] != [4, 2, 1, 1]:
        raise ValueError("expected K of shape (2, 2), omega_0 of shape (2,), omega_g and omega_k")
    return list(np.concatenate(numbers).tolist())


class Calibration(Frozen):
    """Result of `Passport.calibrate`: parameters, their uncertainty, and the fit. It cannot be changed."""

    __slots__ = ("_document", "_result", "_draw")
    __module__ = "dtg_passport"

    _document: dict[str, Any]
    _result: dict[str, Any]
    _draw: _dtg_passport.Distributions | None

    @classmethod
    def from_json(cls, result: str | bytes) -> Calibration:
        """Return a result that was kept: the JSON of `calibrate` of the program, or of `document`.

        It has no `monte_carlo`, which needs the currents.

        Raises:
            NotValid: If the parameters are not those of the gyro, as `Passport.calibrate` does.
            ValueError: If `result` is not such JSON.

        Examples:
            >>> import json
            >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> kept = json.dumps(passport.calibrate("docs/currents.csv").document)
            >>> Calibration.from_json(kept).omega_g.__round__(4)
            10.0003
        """
        text = result if isinstance(result, str) else bytes(result).decode()
        return judged(text, _dtg_passport.earlier(text), None)

    def __reduce__(self) -> Any:
        return Calibration.from_json, (json.dumps(self._document),)

    @property
    def parameters(self) -> Parameters:
        """The parameters K, omega_0, omega_g, omega_k."""
        return parameters(self._result)

    @property
    def u(self) -> Parameters:
        """Standard uncertainties of the parameters (k = 1), in their units."""
        return parameters(self._result["standard_uncertainty"])

    @property
    def K(self) -> Array:
        """Scale factors [[K_x, K_xy], [K_yx, K_y]], deg/(h*mA), shape (2, 2)."""
        return self.parameters.K

    @property
    def omega_0(self) -> Array:
        """Constant drift about x and y, deg/h, shape (2,)."""
        return self.parameters.omega_0

    @property
    def omega_g(self) -> float:
        """g-sensitive drift omega_g, deg/h per local g."""
        return self.parameters.omega_g

    @property
    def omega_k(self) -> float:
        """g-sensitive drift omega_k, deg/h per local g."""
        return self.parameters.omega_k

    @property
    def covariance(self) -> Array:
        """Covariance of k_x, k_xy, k_yx, k_y, omega_0x, omega_0y, omega_g, omega_k, shape (8, 8).

        It is NaN for omega_g and omega_k in the general model, and in results of earlier versions.
        """
        return frozen(self._document.get("covariance", np.full((8, 8), np.nan)), 8, 8)

    @property
    def chi_square(self) -> float:
        """Chi-square of the fit, from all stated uncertainties."""
        return float(self._result["chi_square"]["value"])

    @property
    def dof(self) -> int:
        """Degrees of freedom of the fit."""
        return int(self._result["chi_square"]["degrees_of_freedom"])

    @property
    def probability(self) -> float:
        """Probability of a larger chi-square; NaN without degrees of freedom."""
        return float(self._result["chi_square"].get("probability", np.nan))

    @property
    def ij(self) -> npt.NDArray[np.int64]:
        """Indices of the positions to which the rows of `residuals` belong, int64, shape (N, 2)."""
        return whole_numbers([[at["i"], at["j"]] for at in self._residuals])

    @property
    def residuals(self) -> Array:
        """Residuals along x and y of each position, deg/h, shape (N, 2); no rows without degrees of freedom."""
        return frozen([[at["x"], at["y"]] for at in self._residuals], -1, 2)

    @property
    def _residuals(self) -> list[dict[str, Any]]:
        return list(self._result.get("residuals_deg_per_h", ()))

    @property
    def not_stated(self) -> tuple[str, ...]:
        """Inputs whose uncertainty no file states, so that it is not in `u`."""
        return tuple(self._document.get("not_stated", ()))

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on the currents, the laboratory and the fit; each was also a Python warning."""
        return tuple(self._document.get("remarks", ()))

    @property
    def assumed_meter(self) -> str | None:
        """Meter whose uncertainty is in `u` because no laboratory was stated, or None."""
        return self._document.get("assumed_meter")

    @property
    def consistent(self) -> bool:
        """Whether the readings fit the stand; False only in `NotValid.result`, whose `remarks` have possible causes.

        Without degrees of freedom (`dof` 0) any readings fit.
        """
        return bool(self._document["consistent"])

    @property
    def mistake(self) -> dict[str, Any] | None:
        """Error that explains parameters far from the gyro's, such as currents in another unit; only in `NotValid.result`.

        The keys are those of `calibrate --format json`; `remarks` has it in words.
        """
        return self.document.get("mistake")

    @property
    def not_tested(self) -> tuple[str, ...]:
        """Errors that were not looked for, because no gyro type was given; empty with one."""
        return tuple(self._document.get("not_tested", ()))

    @property
    def verified(self) -> bool:
        """Whether the passport was verified."""
        return bool(self._document["passport_verified"])

    @property
    def verdict(self) -> dict[str, Any] | None:
        """Decision against the tolerances of the gyro type, or None without one; keys as in `calibrate --format json`."""
        return self.document.get("verdict")

    @property
    def document(self) -> dict[str, Any]:
        """The whole result, as `calibrate --format json` prints it, as a new dictionary."""
        import copy

        return copy.deepcopy(self._document)

    def monte_carlo(
        self,
        trials: int | None = None,
        *,
        seed: int = 1,
        threads: int | None = None,
        progress: Callable[[int, int], object] | bool | None = None,
    ) -> MonteCarlo:
        """Return the distributions of the parameters by Monte Carlo, as `calibrate --monte-carlo` does.

        Args:
            trials: Number of trials, rounded up to a multiple of 16384. Default: until every digit is stable.
            seed: Seed of the random numbers, which determines every bit of the result.
            threads: Number of threads. Default: one for each processor. They do not hold Python's global lock.
            progress: Function that is called with the number of trials done and the number due as far as it is known;
                True for a bar of the package `tqdm`, False for none. Default: a bar if tqdm is installed and standard
                error is a terminal. An exception of the function ends the run, as Ctrl-C does.

        Raises:
            KeyboardInterrupt: If Ctrl-C ended the run.
            ValueError: If an argument cannot be used, or if the result is from `from_json`.

        Examples:
            >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> found = passport.calibrate("docs/currents.csv").monte_carlo(100_000, seed=7)
            >>> found.trials
            114688
            >>> low, high = found.interval
            >>> f"{low.omega_g:.3f} to {high.omega_g:.3f} deg/h/g"
            '9.998 to 10.003 deg/h/g'
        """
        if self._draw is None:
            raise ValueError("a result from JSON has no currents; calibrate again for a Monte Carlo")
        trials = None if trials is None else whole("trials", trials, 1, 10**12)
        seed = whole("seed", seed, 0, 2**64 - 1)
        threads = None if threads is None else whole("threads", threads, 1, 1024)
        if not (progress is None or isinstance(progress, bool) or callable(progress)):
            raise TypeError(f"progress: found {progress!r}, expected a function, True or False")
        bar: Any = None
        if progress is True or (progress is None and sys.stderr is not None and sys.stderr.isatty()):
            try:
                bar = optional("tqdm.auto", "progress").tqdm(unit=" trials", unit_scale=True)
            except ImportError:
                if progress:
                    raise

        def draw(done: int, due: int) -> None:
            if bar is not None:
                bar.total = due
                bar.update(done - bar.n)

        with contextlib.nullcontext() if bar is None else bar:
            found = json.loads(self._draw(trials, seed, threads, progress if callable(progress) else draw))
        each = found["parameters"]
        mean, u = (_eight([at[key] for at in each]) for key in ("mean", "standard_uncertainty"))
        low, high = (_eight([at["symmetric_interval"][end] for at in each]) for end in (0, 1))
        left, right = (_eight([at["shortest_interval"][end] for at in each]) for end in (0, 1))
        covariance = frozen(found["covariance"], 8, 8)
        return MonteCarlo(mean, u, (low, high), (left, right), covariance, found["trials"], found["stable"], found)

    def ufloats(self) -> dict[str, Any]:
        """Return the parameters as correlated numbers of the package `uncertainties`, by name.

        Examples:
            >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
            >>> found = passport.calibrate("docs/currents.csv").ufloats()
            >>> print(found["k_x"])  # deg/(h*mA)
            94.994+/-0.011
        """
        uncertainties = optional("uncertainties", "uncertainties")
        values = eight(self.parameters)
        known = 6 if np.isnan(values[-1]) else 8  # omega_g and omega_k come last
        return dict(zip(NAMES, uncertainties.correlated_values(values[:known], self.covariance[:known, :known])))

    def plot(self, ax: Any = None) -> Any:
        """Draw the residuals with their expanded uncertainties (k = 2), deg/h; return the matplotlib axes."""
        ax = optional("matplotlib.pyplot", "plot").subplots()[1] if ax is None else ax
        places = np.arange(len(self.ij))
        u = np.array([[at["u_x"], at["u_y"]] for at in self._residuals]).reshape(-1, 2)
        for axis, (name, shift) in enumerate((("x", -0.1), ("y", 0.1))):
            ax.errorbar(places + shift, self.residuals[:, axis], 2.0 * u[:, axis], fmt="o", capsize=3, label=name)
        ax.axhline(0.0, color="grey", linewidth=0.5)
        ax.set_xticks(places, [f"({i}, {j})" for i, j in self.ij])
        ax.set(xlabel="position (i, j)", ylabel="residual, deg/h", title=self._document["passport_id"])
        ax.legend()
        return ax

    def __repr__(self) -> str:
        method, passport = self._result["method"], self._document["passport_id"]
        marks = ("" if self.verified else " NOT VERIFIED") + ("" if self.consistent else " NOT CONSISTENT")
        marks += "" if self.mistake is None else " NOT THIS GYRO"
        return f"<Calibration by {method} with {passport}{marks}>"


class NotValid(Exception):
    """A result whose parameters are not those of the gyro: the readings do not fit the stand, or an error explains them."""

    __module__ = "dtg_passport"

    result: Calibration
    """The result, for its `remarks`, residuals and `document["causes"]`; do not use its parameters."""

    def __init__(self, reason: str, result: Calibration) -> None:
        super().__init__(reason, result)
        self.result = result

    def __str__(self) -> str:
        return str(self.args[0])


def judged(text: str, not_valid: str | None, draw: _dtg_passport.Distributions | None) -> Calibration:
    """Return the result in the JSON of `calibrate`, or raise `NotValid` with it."""
    document = json.loads(text)
    found = Calibration(document, document["results"][0], draw)
    if not_valid is not None:
        raise NotValid(not_valid, found)
    return found


def table(calibrations: Iterable[Calibration]) -> Any:
    """Return results as a pandas DataFrame, a row for each: what was calibrated, the parameters, their uncertainties, the fit.

    Examples:
        >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
        >>> [row] = table([passport.calibrate("docs/currents.csv", gyro_serial="4711")]).itertuples()
        >>> f"{row.gyro_serial}: {row.k_x:.3f} +- {row.u_k_x:.3f} deg/(h*mA)"
        '4711: 94.994 +- 0.011 deg/(h*mA)'
    """
    rows = []
    for found in calibrations:
        subject, verdict = found._document.get("subject", {}), found._document.get("verdict", {})
        rows.append(
            {"gyro_serial": subject.get("gyro_serial"), "date": subject.get("date"),
             "passport": found._document["passport_id"], "method": found._result["method"]}
            | dict(zip(NAMES, eight(found.parameters)))
            | {f"u_{name}": u for name, u in zip(NAMES, eight(found.u))}
            | {"chi_square": found.chi_square, "dof": found.dof, "probability": found.probability,
               "verdict": verdict.get("overall")}
        )  # fmt: skip
    return optional("pandas", "pandas").DataFrame(rows)
