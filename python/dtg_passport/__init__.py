"""Signed passports of gyro test stands as NumPy arrays.

A passport states the certified deviations of a test stand and what a calibration of a dynamically tuned gyro needs at
one site. `load` verifies it before it gives any number:

>>> import dtg_passport
>>> passport = dtg_passport.load(
...     "passports/SPS-2/0017/moscow-bmstu-1.yaml", "docs/allowed_signers", serial="0017", time="2026-11-20")
>>> passport.id
'SPS-2/0017/moscow-bmstu/1'
>>> passport.B.round(4)
array([[1.20000e-03, 1.69235e+01],
       [1.69235e+01, 1.20000e-03]])
>>> found = passport.calibrate("docs/currents.csv")
>>> f"{found.omega_g:.4f} +- {found.u.omega_g:.4f} deg/h/g"
'10.0003 +- 0.0013 deg/h/g'
"""

from ._calibration import Calibration, MonteCarlo, NotValid, Parameters, table
from ._dtg_passport import __version__ as __version__
from ._factory import Issued, Plan, issue, plan
from ._load import load, load_many, load_unverified, loads, verify, verify_many
from ._passport import Check, Passport, Position, Refused, SelfCheck, Verification

__all__ = [
    "Calibration",
    "Check",
    "Issued",
    "MonteCarlo",
    "NotValid",
    "Parameters",
    "Passport",
    "Plan",
    "Position",
    "Refused",
    "SelfCheck",
    "Verification",
    "issue",
    "load",
    "load_many",
    "load_unverified",
    "loads",
    "plan",
    "table",
    "verify",
    "verify_many",
]
