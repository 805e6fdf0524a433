"""The notebook and the example on a Dask cluster: every figure is that of the program."""

from __future__ import annotations

import concurrent.futures
import copy
import json
import subprocess
import sys
from pathlib import Path

import nbclient
import nbformat
import numpy as np
import pytest
import yaml
from conftest import PROJECT, SIGNERS, TIME, Corpus, program

PASSPORT = PROJECT / "passports/SPS-2/0017/moscow-bmstu-1.yaml"
CURRENTS = PROJECT / "docs/currents.csv"
NOTEBOOK = PROJECT / "docs/calibration.ipynb"
ON_DAY = ("--trust", SIGNERS, "--time", TIME)

# What the pictures of the notebook show, printed after its own cells.
DRAWN = """
import json
heights = [bar.get_height() for bar in bars.patches]
lines = [list(map(float, line.get_ydata())) for line in points.get_lines()]
print(json.dumps([heights, lines]))
"""


@pytest.fixture(scope="module")
def outputs() -> list[list[nbformat.NotebookNode]]:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(DRAWN))
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(PROJECT / "docs")}}).execute()
    return [cell.outputs for cell in notebook.cells if cell.cell_type == "code"]


def printed(cell: list[nbformat.NotebookNode]) -> list[str]:
    return "".join(output.text for output in cell if output.output_type == "stream").splitlines()


def test_the_notebook_is_stored_without_outputs() -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert len(code) == 6 and all(cell.outputs == [] and cell.execution_count is None for cell in code)


def test_the_notebook_shows_the_passport_and_its_checks(outputs: list) -> None:
    [shown], checks = outputs[0], outputs[1]
    content = yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])
    html = shown.data["text/html"]
    assert content["passport"]["id"] in html and "all checks passed" in html
    for at in content["positions"]:
        cells = [at["i"], at["j"], at["alpha_arcsec"], at["beta_arcsec"], at["gamma_arcsec"]]
        assert "".join(f"<td>{number:g}</td>" for number in cells) in html
    [due] = json.loads(program("verify", PASSPORT, "--trust", SIGNERS, "--time", "2029-01-01", "--format", "json", accept=(1,)))
    assert printed(checks) == [f"{check['name']}: {check['code']}" for check in due["checks"]]
    assert "in_force: expired" in printed(checks)


def test_the_notebook_shows_the_calibration(outputs: list) -> None:
    files = ("--gyro", PROJECT / "docs/gvk-6.yaml", "--laboratory", PROJECT / "docs/laboratory.yaml")
    options = ("--method", "least-squares", "--monte-carlo", "--trials", "100000", "--seed", "7", "--format", "json")
    due = json.loads(program("calibrate", PASSPORT, CURRENTS, *ON_DAY, *files, *options))
    [result] = due["results"]
    K, u = result["k_deg_per_h_per_ma"], result["standard_uncertainty"]
    values = [
        ("K_x", K[0][0], u["k_deg_per_h_per_ma"][0][0], "°/(h·mA)"),
        ("K_y", K[1][1], u["k_deg_per_h_per_ma"][1][1], "°/(h·mA)"),
        ("ω_0x", result["omega0_deg_per_h"][0], u["omega0_deg_per_h"][0], "°/h"),
        ("ω_0y", result["omega0_deg_per_h"][1], u["omega0_deg_per_h"][1], "°/h"),
        ("ω_g", result["omega_g_deg_per_h_per_g"], u["omega_g_deg_per_h_per_g"], "°/(h·g)"),
        ("ω_k", result["omega_k_deg_per_h_per_g"], u["omega_k_deg_per_h_per_g"], "°/(h·g)"),
    ]
    fit = result["chi_square"]
    assert printed(outputs[3]) == [
        *(f"{name} = {value:.4f} ± {uncertainty:.4f} {unit}" for name, value, uncertainty, unit in values),
        f"χ² = {fit['value']:.2f} with {fit['degrees_of_freedom']} degrees of freedom, {due['verdict']['overall']}",
    ]
    trials = due["monte_carlo"]["trials"]
    interval = {at["parameter"]: at["symmetric_interval"] for at in due["monte_carlo"]["parameters"]}
    k_x, omega_g = list(interval.values())[0], list(interval.values())[6]
    assert printed(outputs[5]) == [
        f"K_x from {k_x[0]:.4f} to {k_x[1]:.4f} °/(h·mA), {trials} trials",
        f"ω_g from {omega_g[0]:.4f} to {omega_g[1]:.4f} °/(h·g)",
    ]
    for picture in (outputs[2], outputs[4]):
        assert [output.data["image/png"][:8] for output in picture] == ["iVBORw0K"]
    [heights, lines] = json.loads(printed(outputs[6])[0])
    positions = yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])["positions"]
    assert heights == [at[f"{angle}_arcsec"] for angle in ("alpha", "beta", "gamma") for at in positions]
    for axis in ("x", "y"):
        assert [at[axis] for at in result["residuals_deg_per_h"]] in lines


# --- A thousand stands. ---

STANDS = 1000


@pytest.fixture(scope="module")
def fleet(corpus: Corpus, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A thousand stands with deviations of their own, their passports, and the currents of a gyro on each."""
    folder = tmp_path_factory.mktemp("fleet")
    model = yaml.safe_load((PROJECT / "passports/SPS-2/0017/stand.yaml").read_text())
    draw = np.random.default_rng(16)
    for number in range(STANDS):
        stand = copy.deepcopy(model)
        stand["stand"]["serial"] = f"{number:04}"
        for at in stand["positions"]:
            at |= {f"{angle}_arcsec": round(float(draw.normal(0.0, 60.0)), 1) for angle in ("alpha", "beta", "gamma")}
        path = folder / f"stands/{number:04}/stand.yaml"
        path.parent.mkdir(parents=True)
        path.write_text(json.dumps(stand))
    program("issue", folder / "stands", "--site", PROJECT / "sites/moscow-bmstu.yaml", "--key", corpus.folder / "key",
            "--identity", "factory@example.org", "--out", folder / "passports", "--issued-at", "2026-11-10T00:00:00Z",
            "--no-sync")  # fmt: skip
    passports = sorted((folder / "passports").glob("*/*/*-1.yaml"))
    assert len(passports) == STANDS
    for passport in passports:
        content = yaml.load(passport.read_bytes().partition(b"signature: |")[0], Loader=yaml.CSafeLoader)
        # The currents of the passport's own gyro, with noise well below what is stated of the meter: every answer is valid.
        noisy = lambda current: repr(current + float(draw.normal(0.0, 5e-6)))
        rows = [f"{at['i']},{at['j']},{noisy(at['jx_ma'])},{noisy(at['jy_ma'])}" for at in content["self_check"]["currents"]]
        path = (folder / "currents" / passport.relative_to(folder / "passports")).with_suffix(".csv")
        path.parent.mkdir(parents=True)
        path.write_text("\n".join(["i,j,jx_ma,jy_ma", *rows, ""]))
    return folder


def run(corpus: Corpus, fleet: Path, currents: Path, *options: str, accept: int = 0) -> list[dict]:
    out = fleet / "results.ndjson"
    out.unlink(missing_ok=True)
    command = [sys.executable, PROJECT / "docs/fleet.py", fleet / "passports", currents, "--trust", corpus.signers]
    done = subprocess.run([*command, "--time", TIME, "--out", out, *options], capture_output=True, text=True)
    assert done.returncode == accept, done.stdout + done.stderr
    return [json.loads(line) for line in out.read_text().splitlines()]


def answer(corpus: Corpus, passport: str, currents: Path, *options: str) -> dict:
    trust = ("--trust", corpus.signers, "--time", TIME, "--method", "least-squares", "--format", "json")
    return {"passport": passport, **json.loads(program("calibrate", passport, currents, *trust, *options))}


def test_a_thousand_stands_on_a_cluster_give_the_answers_of_the_program(corpus: Corpus, fleet: Path) -> None:
    files = sorted((fleet / "currents").glob("*/*/*.csv"))
    found = run(corpus, fleet, fleet / "currents")
    assert len(found) == len(files) == STANDS
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        due = pool.map(lambda result, file: answer(corpus, result["passport"], file), found, files)
        for result, expected in zip(found, due, strict=True):
            assert result == expected
    assert len({result["results"][0]["omega_g_deg_per_h_per_g"] for result in found}) == STANDS


def test_one_wrong_current_is_a_failure(corpus: Corpus, fleet: Path) -> None:
    """Of two gyros one has a current that is 0.1 mA off: its readings do not fit the stand."""
    some = fleet / "wrong"
    for number, file in enumerate(sorted((fleet / "currents").glob("*/*/*.csv"))[:2]):
        *before, last = file.read_text().splitlines()
        i, j, jx_ma, jy_ma = last.split(",")
        copied = some / file.relative_to(fleet / "currents")
        copied.parent.mkdir(parents=True)
        copied.write_text("\n".join([*before, f"{i},{j},{jx_ma},{float(jy_ma) - 0.1 * number}", ""]))
    good, wrong = run(corpus, fleet, some, accept=1)
    assert good["consistent"] is True and "error" not in good
    assert set(wrong) == {"passport", "error"} and wrong["error"].startswith("not valid: ")


def test_trials_on_a_cluster_and_a_passport_that_is_refused(corpus: Corpus, fleet: Path) -> None:
    """Of three stands one has an altered passport: its line is the error, and the others are not affected."""
    files = sorted((fleet / "currents").glob("*/*/*.csv"))[:3]
    some = fleet / "some"
    for file in files:
        copied = some / file.relative_to(fleet / "currents")
        copied.parent.mkdir(parents=True)
        copied.write_bytes(file.read_bytes())
    altered = fleet / "passports" / files[1].relative_to(fleet / "currents").with_suffix(".yaml")
    before = altered.read_bytes()
    altered.write_bytes(before.replace(b"alpha", b"alphb", 1))
    found = run(corpus, fleet, some, "--trials", "16384", accept=1)
    altered.write_bytes(before)
    assert set(found[1]) == {"passport", "error"} and "refused" in found[1]["error"]
    for result, file in ((found[0], files[0]), (found[2], files[2])):
        assert result == answer(corpus, result["passport"], file, "--monte-carlo", "--trials", "16384")
