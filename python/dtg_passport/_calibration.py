"""The result of a calibration."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ._common import Array, array, optional

NAMES = ("K_x", "K_xy", "K_yx", "K_y", "ω_0x", "ω_0y", "ω_g", "ω_k")
"""Order of the eight parameters."""


class Parameters(NamedTuple):
    """The parameters of a gyro, or their standard uncertainties."""

    K: Array
    """Scale factors [[K_x, K_xy], [K_yx, K_y]], deg/(h*mA), shape (2, 2)."""
    omega_0: Array
    """Constant drift about x and y, deg/h, shape (2,)."""
    omega_g: float
    """g-sensitive drift omega_g, deg/h per local g."""
    omega_k: float
    """g-sensitive drift omega_k, deg/h per local g."""


def _parameters(result: dict[str, Any]) -> Parameters:
    return Parameters(
        _frozen(result["k_deg_per_h_per_ma"], 2, 2),
        _frozen(result["omega0_deg_per_h"], 2),
        result["omega_g_deg_per_h_per_g"],
        result["omega_k_deg_per_h_per_g"],
    )


def _frozen(values: Any, *shape: int) -> Array:
    return array(np.array(values, dtype=np.float64).tobytes(), *shape)


class Calibration:
    """Result of a calibration: parameters, their uncertainty, and the fit. It cannot be changed."""

    __slots__ = ("_covariance", "_document", "_remarks", "_result")
    __module__ = "dtg_passport"

    _covariance: Array
    _document: dict[str, Any]
    _remarks: tuple[str, ...]
    _result: dict[str, Any]

    def __init__(self, document: dict[str, Any], covariance: bytes, remarks: tuple[str, ...]) -> None:
        """Calibrations are created by `Passport.calibrate`."""
        values = (array(covariance, 8, 8), document, remarks, document["results"][0])
        for name, value in zip(self.__slots__, values):
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a calibration cannot be changed: {name}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a calibration cannot be changed: {name}")

    @property
    def parameters(self) -> Parameters:
        """The parameters K, omega_0, omega_g, omega_k."""
        return _parameters(self._result)

    @property
    def u(self) -> Parameters:
        """Standard uncertainties of the parameters (k = 1), in their units."""
        return _parameters(self._result["standard_uncertainty"])

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
        """Covariance of K_x, K_xy, K_yx, K_y, omega_0x, omega_0y, omega_g, omega_k, shape (8, 8)."""
        return self._covariance

    @property
    def chi_square(self) -> float:
        """Chi-square of the fit, from all stated uncertainties."""
        value: float = self._result["chi_square"]["value"]
        return value

    @property
    def dof(self) -> int:
        """Degrees of freedom of the fit."""
        dof: int = self._result["chi_square"]["degrees_of_freedom"]
        return dof

    @property
    def probability(self) -> float:
        """Probability of a larger chi-square; NaN without degrees of freedom."""
        probability: float = self._result["chi_square"].get("probability", np.nan)
        return probability

    @property
    def ij(self) -> Array:
        """Indices of the positions to which the rows of `residuals` belong, shape (N, 2)."""
        return _frozen([[at["i"], at["j"]] for at in self._residuals], -1, 2)

    @property
    def residuals(self) -> Array:
        """Residuals along x and y of each position, deg/h, shape (N, 2); no rows without degrees of freedom."""
        return _frozen([[at["x"], at["y"]] for at in self._residuals], -1, 2)

    @property
    def _residuals(self) -> list[dict[str, Any]]:
        residuals: list[dict[str, Any]] = self._result.get("residuals_deg_per_h", [])
        return residuals

    @property
    def not_stated(self) -> tuple[str, ...]:
        """Inputs whose uncertainty no file states, so that it is not in `u`."""
        return tuple(self._document.get("not_stated", ()))

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on the currents, the laboratory and the fit."""
        hint = self._document.get("hint")
        return self._remarks if hint is None else (*self._remarks, hint)

    @property
    def verdict(self) -> dict[str, Any] | None:
        """Decision against the tolerances of the gyro type, or None without one; keys as in `calibrate --format json`."""
        return self.document.get("verdict")

    @property
    def document(self) -> dict[str, Any]:
        """The whole result, as `calibrate --format json` prints it, as a new dictionary."""
        import copy

        return copy.deepcopy(self._document)

    def ufloats(self) -> dict[str, Any]:
        """Return the parameters as correlated numbers of the package `uncertainties`, by name.

        Examples
        --------
        >>> from dtg_passport import load
        >>> passport = load("passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", time="2026-11-20")
        >>> found = passport.calibrate("docs/currents.csv").ufloats()
        >>> print(found["K_x"])  # deg/(h*mA)
        94.994+/-0.011
        """
        uncertainties = optional("uncertainties", "uncertainties")
        K, omega_0, omega_g, omega_k = self.parameters
        values = (*K.ravel().tolist(), *omega_0.tolist(), omega_g, omega_k)
        return dict(zip(NAMES, uncertainties.correlated_values(values, self.covariance)))

    def plot(self, ax: Any = None) -> Any:
        """Draw the residuals with their expanded uncertainties (k = 2), deg/h; return the matplotlib axes."""
        pyplot = optional("matplotlib.pyplot", "plot")
        ax = pyplot.subplots()[1] if ax is None else ax
        places = np.arange(len(self.ij))
        u = np.array([[at["u_x"], at["u_y"]] for at in self._residuals]).reshape(-1, 2)
        for axis, (name, shift) in enumerate((("x", -0.1), ("y", 0.1))):
            ax.errorbar(places + shift, self.residuals[:, axis], 2.0 * u[:, axis], fmt="o", capsize=3, label=name)
        ax.axhline(0.0, color="grey", linewidth=0.5)
        ax.set_xticks(places, [f"({i:.0f}, {j:.0f})" for i, j in self.ij])
        ax.set(xlabel="position (i, j)", ylabel="residual, deg/h", title=self._document["passport_id"])
        ax.legend()
        return ax

    def __repr__(self) -> str:
        method, passport = self._result["method"], self._document["passport_id"]
        mark = "" if self._document["passport_verified"] else " NOT VERIFIED"
        return f"<Calibration by {method} with {passport}{mark}>"
