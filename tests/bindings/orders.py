"""Calibrations that every language computes, with the answer of the program."""

from __future__ import annotations

import json
from pathlib import Path

import yaml
from conftest import PROJECT, SIGNERS, TIME, program

PASSPORT = PROJECT / "passports/SPS-2/0017/moscow-bmstu-1.yaml"
CURRENTS, RUN = PROJECT / "docs/currents.csv", PROJECT / "docs/run.csv"


def plain(path: Path) -> dict:
    return yaml.safe_load(path.read_text())


LABORATORY, GYRO = plain(PROJECT / "docs/laboratory.yaml"), plain(PROJECT / "docs/gvk-6.yaml")
# A meter that is not the paper's, a gyro that states its noise, and tolerances that every and no gyro meets.
OWN = {**LABORATORY, "meter": {**LABORATORY["meter"], "reading_percent": 0.02, "noise_ma": 1e-7}, "temperature_c": 35.0}
NOISY = {**GYRO, "noise": {"visit_deg_per_h": 0.001, "turn_on_deg_per_h": 0.01}}
WIDE, NARROW = ({**GYRO, "tolerance": dict.fromkeys(GYRO["tolerance"], limit)} for limit in (1e3, 1e-6))
DOOR = {"i": 2, "j": 4, "visit": 1, "cycle": 3, "why": "door opened"}

# An earlier calibration of the gyro, and one before it.
SUBJECT = {"gyro_serial": "4711", "operator": "A. Ivanova", "date": "2026-11-19", "temperature_c": 21.5}
VERIFIED = ("--trust", SIGNERS, "--time", TIME, "--format", "json")
EARLIER, EARLIEST = (
    json.loads(program("calibrate", PASSPORT, CURRENTS, *VERIFIED, f"--method={method}", f"--date={date}", "--gyro-serial=4711"))
    for method, date in (("least-squares", "2026-11-12"), ("analytic", "2026-11-05"))
)

# Currents and order of calibrations.
ORDERS: dict[str, tuple[Path, dict]] = {
    "nothing": (CURRENTS, {}),
    "laboratory": (CURRENTS, {"laboratory": OWN, "method": "iterative"}),
    "pass": (CURRENTS, {"laboratory": LABORATORY, "gyro": WIDE, "method": "analytic"}),
    "fail": (CURRENTS, {"gyro": NARROW}),
    "turn-ons": (RUN, {"laboratory": OWN, "gyro": NOISY}),
    "drift": (RUN, json.loads((PROJECT / "docs/order.json").read_text())),
    "two excluded": (RUN, {"exclude": [DOOR, {**DOOR, "cycle": 1, "why": "read late"}]}),
    "general": (RUN, {"model": "general", "gyro": GYRO}),
    "subject": (CURRENTS, {**SUBJECT, "date": "2020-01-02", "laboratory": OWN}),
    "change": (RUN, {**SUBJECT, "gyro": GYRO, "previous": [EARLIER, EARLIEST]}),
    "budget": (RUN, {"gyro": GYRO, "budget": True}),
    "files as text": (CURRENTS, {"laboratory": (PROJECT / "docs/laboratory.yaml").read_text(), "gyro": json.dumps(GYRO)}),
    "no change": (CURRENTS, {"gyro": GYRO, "previous": [EARLIEST]}),
}

# Orders that are refused, the code of the refusal, and words of it that are also those for a file.
REFUSED: list[tuple[Path, dict, str, str]] = [
    (CURRENTS, {"laboratory": {**OWN, "meter": {**OWN["meter"], "floor_ma": 0.0}}}, "unusable", "meter.floor_ma: found 0, expected a positive number"),
    (CURRENTS, {"laboratory": {**OWN, "meters": {}}}, "unusable", "unknown key \"meters\""),
    (CURRENTS, {"laboratory": GYRO}, "unusable", "format: found \"dtg-gyro/1\", expected \"dtg-laboratory/1\""),
    (CURRENTS, {"gyro": {key: GYRO[key] for key in GYRO if key != "tolerance"}}, "unusable", "tolerance: missing"),
    (CURRENTS, {"method": "exact"}, "unusable", "method: found \"exact\", expected \"analytic\""),
    (CURRENTS, {"model": "full"}, "unusable", "model: found \"full\", expected \"paper\" or \"general\""),
    (CURRENTS, {"drift": 1}, "unusable", "drift: found 1, expected true or false"),
    (RUN, {"exclude": [{"i": 2, "j": 4, "visit": 1, "why": "door opened"}]}, "unusable", "has a visit 1 in the turn-ons 1, 2, 3"),
    (RUN, {"exclude": [{**DOOR, "visit": 9}]}, "unusable", "found no visit 9 to position (2, 4)"),
    (RUN, {"exclude": [{**DOOR, "why": ""}]}, "unusable", "exclude[0].why: found empty text"),
    (CURRENTS, {"anisoelasticity": True, "model": "general"}, "unusable", "anisoelasticity: found true, expected false"),
    (CURRENTS, {"gyro_serial": " "}, "unusable", "gyro_serial: found empty text"),
    (CURRENTS, {"date": "2026-13-01"}, "unusable", "date: found \"2026-13-01\", expected a date"),
    (CURRENTS, {"date": "2030-01-01"}, "unusable", "is later than the time of the verification"),
    (CURRENTS, {"temperature_c": 300}, "unusable", "temperature_c: found 300"),
    (CURRENTS, {"previous": EARLIER}, "unusable", "previous: found a mapping"),
    (CURRENTS, {"previous": [EARLIER, {"K": 1}]}, "unreadable", "found unsuitable JSON (unknown field `K`"),
    (CURRENTS, {"previous": [{**EARLIER, "results": []}]}, "unreadable", "previous[0]: found no parameters"),
    (CURRENTS, {"gyro_serial": "4712", "previous": [EARLIER]}, "refused", "is that of gyro 4711, not of 4712"),
    (CURRENTS, {"date": "2026-11-06", "previous": [EARLIER]}, "refused", "check which is earlier"),
    (RUN, {"anisoelasticity": True}, "refused", "cannot determine ω_n (anisoelasticity)"),
    (CURRENTS, {"drift": True}, "refused", "time_s"),
    (CURRENTS, {"model": "general", "method": "analytic"}, "refused", "supports only the paper's model"),
]


def calibrated(folder: Path, currents: Path, order: dict) -> str:
    """Return the JSON that the program prints for an order."""
    options: list[object] = ["--method", order.get("method", "least-squares")]
    options += [f"--model={order['model']}"] if "model" in order else []
    options += [f"--{key}" for key in ("drift", "anisoelasticity", "budget") if order.get(key)]
    options += [f"--{key.replace('_', '-')}={order[key]}" for key in SUBJECT if key in order]
    for number, result in enumerate(order.get("previous", ())):
        (folder / f"{number}.json").write_text(json.dumps(result))
        options += ["--previous", folder / f"{number}.json"]
    for visit in order.get("exclude", ()):
        options += ["--exclude", ",".join(str(visit[key]) for key in ("i", "j", "visit", "cycle")), "--why", visit["why"]]
    for key in ("laboratory", "gyro"):
        if key in order:
            (folder / f"{key}.yaml").write_text(order[key] if isinstance(order[key], str) else yaml.safe_dump(order[key]))
            options += [f"--{key}", folder / f"{key}.yaml"]
    return program("calibrate", PASSPORT, currents, *VERIFIED, *options, accept=(0, 1))
