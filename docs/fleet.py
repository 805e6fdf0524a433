"""Calibrate many gyros, each with its own stand and passport, on a Dask cluster.

python docs/fleet.py passports currents --trust allowed_signers --out results.ndjson

The currents that were read with passports/<model>/<serial>/<site>-<revision>.yaml are in
currents/<model>/<serial>/<site>-<revision>.csv. Each result is one line: the JSON of `dtg-passport calibrate`, and the
path of the passport; or that path and the error. All workers must see both folders under the same path.
"""

import argparse
import functools
import json
import sys
from pathlib import Path
from typing import Any

import dtg_passport
from distributed import Client


def calibrate(currents: str, passport: str, trust: bytes, time: str | None, trials: int | None) -> dict[str, Any]:
    """Verify a passport and calibrate the gyro; one task, on one processor."""
    try:
        found = dtg_passport.load(passport, trust, time=time).calibrate(currents)
        result = {"passport": passport, **found.document}
        if trials is not None:
            result["monte_carlo"] = found.monte_carlo(trials, threads=1, progress=False).document
    except dtg_passport.NotValid as error:
        # The parameters are not those of the gyro.
        return {"passport": passport, "error": f"not valid: {error}"}
    except (dtg_passport.Refused, ValueError, OSError) as error:
        return {"passport": passport, "error": str(error)}
    return result


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("passports", type=Path)
    parser.add_argument("currents", type=Path)
    parser.add_argument("--trust", type=Path, required=True, help="allowed_signers")
    parser.add_argument("--out", type=Path, required=True, help="file to write, one line for each gyro")
    parser.add_argument("--time", help="time to verify for (default: now)")
    parser.add_argument("--trials", type=int, help="Monte Carlo too, with this number of trials")
    parser.add_argument("--scheduler", help="address of a Dask scheduler (default: a cluster on this machine)")
    asked = parser.parse_args()

    files = sorted(asked.currents.glob("*/*/*.csv"))
    passports = [str(asked.passports / file.relative_to(asked.currents).with_suffix(".yaml")) for file in files]
    work = functools.partial(calibrate, trust=asked.trust.read_bytes(), time=asked.time, trials=asked.trials)
    # Without a scheduler, one process for each processor: calibrations do not wait for anything.
    with Client(asked.scheduler) if asked.scheduler else Client(threads_per_worker=1) as client:
        results = client.gather(client.map(work, [str(file) for file in files], passports, pure=False))
    asked.out.write_text("".join(f"{json.dumps(result, ensure_ascii=False)}\n" for result in results), encoding="utf-8")
    failed = [result for result in results if "error" in result]
    for result in failed:
        print(f"{result['passport']}: {result['error']}", file=sys.stderr)
    print(f"calibrated {len(results) - len(failed)}, failed {len(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
