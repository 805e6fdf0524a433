"""The Python module against PyYAML, NumPy, and the command line program."""

from __future__ import annotations

import copy
import csv
import datetime
import doctest
import json
import os
import pickle
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import dtg_passport
import numpy as np
import pytest
import yaml
from conftest import PROJECT, SHIPPED, SIGNERS, TIME, Corpus, Registers, program
from orders import CURRENTS, LABORATORY, ORDERS, PASSPORT, REFUSED, RUN, calibrated, plain

def load(path: Path = PASSPORT, **asked: object) -> dtg_passport.Passport:
    return dtg_passport.load(path, SIGNERS, **{"time": TIME, **asked})


def signed(path: Path) -> dict:
    """Return what PyYAML reads in the signed bytes."""
    return yaml.load(path.read_bytes().partition(b"signature: |")[0], Loader=yaml.CSafeLoader)


def bits(values: object) -> bytes:
    return np.array(values, dtype=np.float64).tobytes()


# --- What is read. ---


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_number_is_the_signed_one_to_the_last_bit(path: Path) -> None:
    passport, content = load(path), signed(path)
    matrices, positions = content["matrices"], content["positions"]
    vectors = {(at["i"], at["j"]): at for at in content["vectors"]}
    for name, key in (("delta", "delta"), ("B", "b_deg_per_h"), ("C", "c_deg_per_h_per_g"), ("n2_inverse", "n2_inverse")):
        assert getattr(passport, name).tobytes() == bits(matrices[key])
        assert getattr(passport, name).shape == (2, 2)
    assert passport.ij.tolist() == [[at["i"], at["j"]] for at in positions]
    assert passport.theta.tolist() == [at["theta_deg"] for at in positions]
    assert passport.phi.tolist() == [at["phi_deg"] for at in positions]
    angles = ("alpha", "beta", "gamma")
    assert passport.deviations.tobytes() == bits([[at[f"{angle}_arcsec"] for angle in angles] for at in positions])
    u = [[at.get(f"u_{angle}_arcsec", np.nan) for angle in angles] for at in positions]
    assert np.array_equal(passport.u_deviations, u, equal_nan=True)
    rows = [vectors[at["i"], at["j"]] for at in positions]
    assert passport.n.tobytes() == bits([at["specific_force_g"] for at in rows])
    assert passport.omega.tobytes() == bits([at["omega_deg_per_h"] for at in rows])
    assert passport.gravity == content["earth"]["gravity_m_per_s2"]
    assert passport.content == content
    # 1 == 1.0, so the types are compared apart.
    assert json.dumps(passport.content) == json.dumps(content)
    assert passport.id == content["passport"]["id"] and passport.data == path.read_bytes()
    assert (passport.serial, passport.site) == (content["stand"]["serial"], content["site"]["id"])
    assert passport.latitude == content["earth"]["latitude_deg"]
    stated = [content[part]["valid_until"] for part in ("passport", "certificate") if "valid_until" in content[part]]
    assert (passport.expires and str(passport.expires)) == min(stated, default=None)


def test_the_digest_is_that_of_the_whole_file() -> None:
    out = subprocess.run(["sha256sum", PASSPORT], capture_output=True, text=True, check=True).stdout
    assert load().sha256 == out.split()[0]


def test_a_position_has_its_row() -> None:
    passport = load()
    for k, (i, j) in enumerate(passport.ij):
        at = passport.at(int(i), int(j))
        for row, whole in zip(at, (passport.n, passport.omega, passport.deviations, passport.u_deviations)):
            assert row.tobytes() == whole[k].tobytes()
    with pytest.raises(KeyError, match=r"no position \(3, 1\)"):
        passport.at(3, 1)


def test_what_is_not_stated_is_nan(corpus: Corpus, tmp_path: Path) -> None:
    """A stand without the position (2, 4) and without uncertainties has no matrices."""
    stand = yaml.safe_load((PROJECT / "passports/SPS-2/0017/stand.yaml").read_text())
    stand["positions"] = [
        {key: value for key, value in at.items() if not key.startswith("u_")}
        for at in stand["positions"]
        if (at["i"], at["j"]) != (2, 4)
    ]
    stand["certificate"] = {key: stand["certificate"][key] for key in ("number", "issued", "laboratory")}
    (tmp_path / "stand.yaml").write_text(yaml.safe_dump(stand))
    site = corpus.folder / "sites/site-60.yaml"
    program("issue", tmp_path / "stand.yaml", "--site", site, "--key", corpus.folder / "key", "--identity",
            "factory@example.org", "--out", tmp_path, "--issued-at", "2026-11-10T00:00:00Z")  # fmt: skip
    [path] = tmp_path.glob("*/*/*-1.yaml")
    passport = dtg_passport.load(path, corpus.signers, time=TIME)
    for name in ("delta", "B", "C", "n2_inverse"):
        assert getattr(passport, name).shape == (2, 2) and np.isnan(getattr(passport, name)).all()
    assert passport.u_deviations.shape == (7, 3) and np.isnan(passport.u_deviations).all()
    assert np.isfinite(passport.deviations).all() and "matrices" not in passport.content


ARRAYS = ("delta", "B", "C", "n2_inverse", "ij", "n", "omega", "deviations", "u_deviations")


def test_nothing_can_be_changed() -> None:
    passport = load()
    found = passport.calibrate(CURRENTS)
    arrays = [getattr(passport, name) for name in ARRAYS] + list(passport.at(1, 1))
    arrays += [found.K, found.omega_0, found.u.K, found.u.omega_0, found.covariance, found.residuals, found.ij]
    assert [array.dtype for array in arrays].count(np.dtype(np.int64)) == 2  # the two `ij`
    for array in arrays:
        assert array.dtype in (np.float64, np.int64) and not array.flags.writeable
        # Neither the array nor anything that it is a view of can be made writeable.
        base = array
        while isinstance(base, np.ndarray):
            with pytest.raises(ValueError):
                base.flags.writeable = True
            base = base.base
        assert isinstance(base, bytes)
        with pytest.raises(ValueError):
            array[...] = 0.0
    for thing, names in ((passport, [*ARRAYS, "id", "gravity", "new"]), (found, ["K", "u", "covariance", "new"])):
        for name in names:
            with pytest.raises(AttributeError):
                setattr(thing, name, 1.0)
            with pytest.raises(AttributeError):
                delattr(thing, name)
    with pytest.raises(TypeError):
        passport.units["B"] = "rad/s"  # type: ignore[index]
    changes = (lambda: passport.content["passport"].update(issuer="someone else"), lambda: passport.content.pop("passport"),
               lambda: passport.content["positions"].append(1), lambda: passport.content["positions"].sort())  # fmt: skip
    for change in changes:
        with pytest.raises(TypeError, match="cannot be changed"):
            change()
    mine = copy.deepcopy(passport.content)
    mine["passport"]["issuer"] = mine["positions"][0]["i"] = 7
    assert passport.content["passport"]["issuer"] == "examples@dtg-passport.test" and passport.content["positions"][0]["i"] == 1
    assert passport.content is passport.content
    found.document["results"][0]["omega_g_deg_per_h_per_g"] = 0.0
    assert found.omega_g > 9


# --- Who is believed. ---


def test_every_altered_passport_is_refused_as_by_the_program(corpus: Corpus) -> None:
    for path, due in zip(corpus.paths, corpus.verdicts):
        answer = dtg_passport.verify(path, corpus.signers, time=TIME)
        assert answer.valid == due["valid"] and answer.id == due["id"]
        # The program prints the detail escaped, as this JSON does.
        assert [check._asdict() for check in answer.checks] == due["checks"], path
        assert (answer.passport is None) == (not due["valid"])


def test_a_refusal_carries_the_checks(corpus: Corpus) -> None:
    path = corpus.altered[0]
    with pytest.raises(dtg_passport.Refused) as refused:
        dtg_passport.load(path, corpus.signers, time=TIME)
    assert refused.value.path == str(path)
    assert [check._asdict() for check in refused.value.checks] == corpus.verdicts[200]["checks"]
    again = pickle.loads(pickle.dumps(refused.value))
    assert (again.path, again.checks, str(again)) == (refused.value.path, refused.value.checks, str(refused.value))


@pytest.mark.parametrize(
    ("asked", "code"),
    [
        ({"serial": "0018"}, "wrong_stand"),
        ({"issuer": "factory@example.org"}, "wrong_issuer"),
        ({"at": (39.9, 116.4)}, "wrong_place"),
        ({"time": "2031-01-01"}, "expired"),
        ({"time": datetime.date(2031, 1, 1)}, "expired"),
        ({"time": np.datetime64("2031-01-01")}, "expired"),
        ({"time": datetime.datetime(2020, 1, 1, tzinfo=datetime.timezone.utc)}, "not_yet_valid"),
    ],
)
def test_every_question_is_asked(asked: dict, code: str) -> None:
    with pytest.raises(dtg_passport.Refused) as refused:
        load(**asked)
    assert code in [check.code for check in refused.value.checks]


def test_good_questions_pass_every_check() -> None:
    passport = load(serial="0017", issuer="examples@dtg-passport.test", at=(55.7660, 37.6850))
    passed = [check.name for check in passport.checks if check.passed and check.code == "ok"]
    assert passed == ["grammar", "signature", "schema", "signer", "recomputed", "in_force", "issuer", "stand", "place"]
    # No list of revoked keys and no register were given, so nothing is known about them.
    others = [(check.name, check.code) for check in passport.checks if check.passed is None]
    assert others == [("revocation", "not_asked"), ("register", "not_asked")] and passport.verified


def test_a_str_is_always_a_path_and_bytes_are_always_content(corpus: Corpus, tmp_path: Path) -> None:
    text = SIGNERS.read_text()
    [line] = [line for line in text.splitlines() if line and not line.startswith("#")]
    odd = tmp_path / "of AAAA\nsigners"
    odd.write_text(text)
    for trust in (SIGNERS, str(SIGNERS), text.encode(), line.replace(" ", "\t").encode(), odd, str(odd)):
        assert dtg_passport.load(PASSPORT, trust, time=TIME).verified
    # A text is the name of a file that does not exist, or one that no system allows.
    for trust in (text, line, line.replace(" ", "\t")):
        with pytest.raises(OSError):
            dtg_passport.load(PASSPORT, trust, time=TIME)
    key = (PROJECT / "tests/keys/examples.pub").read_text()
    list_of_keys = tmp_path / "of AAAA\nkeys"
    list_of_keys.write_text(key)
    for revoked in (str(list_of_keys), [list_of_keys], key.encode(), [key.replace(" ", "\t").encode()]):
        with pytest.raises(dtg_passport.Refused, match="key_revoked"):
            load(revoked=revoked)
    with pytest.raises(OSError):
        load(revoked=key)
    with pytest.raises(ValueError, match="allowed_signers|currents.csv"):
        dtg_passport.load(PASSPORT, CURRENTS, time=TIME)
    with pytest.raises(FileNotFoundError):
        dtg_passport.load(PASSPORT, "nowhere", time=TIME)
    with pytest.raises(dtg_passport.Refused, match="unknown_key"):
        dtg_passport.load(PASSPORT, corpus.signers, time=TIME)


def test_revoked_keys_count(registers: Registers) -> None:
    good = registers.good
    keys = Path(f"{good.signers.with_name('key')}.pub")
    for revoked in (keys, str(keys), [keys.read_bytes()]):
        with pytest.raises(dtg_passport.Refused, match="key_revoked"):
            dtg_passport.load(good.passport, good.signers, time=good.time, revoked=revoked)
    with pytest.raises(ValueError, match="currents.csv"):
        dtg_passport.load(good.passport, good.signers, time=good.time, revoked=[CURRENTS])


def test_every_register_gives_the_answer_of_the_program(registers: Registers) -> None:
    """As a path, as text with the path, and as bytes; by every function."""
    for asked in registers.asked:
        of_file, of_content = asked.verdict(), asked.verdict_on_content()
        content = asked.register.read_bytes()
        for register, due in ((asked.register, of_file), (str(asked.register), of_file), (content, of_content)):
            options = {"time": asked.time, "register": register}
            answer = dtg_passport.verify(asked.passport, asked.signers, **options)
            assert (answer.valid, answer.id) == (due["valid"], due["id"]) and (answer.passport is None) == (not due["valid"])
            assert [check._asdict() for check in answer.checks] == due["checks"], asked.name
            found = [
                lambda: dtg_passport.load(asked.passport, asked.signers, **options),
                lambda: dtg_passport.loads(asked.passport.read_bytes(), asked.signers, **options),
                lambda: next(dtg_passport.load_many([asked.passport], asked.signers, **options)),
            ]
            for load in found:
                if due["valid"]:
                    assert load().verified and load().checks == answer.checks
                    continue
                with pytest.raises(dtg_passport.Refused) as refused:
                    load()
                assert refused.value.checks == answer.checks


def test_a_folder_of_passports_has_a_register_for_each_stand(registers: Registers, tmp_path: Path) -> None:
    paths = sorted(registers.passports.glob("*/*/*-[0-9].yaml"))
    time, trust, folder = registers.good.time, registers.signers, registers.passports
    options = ["--trust", trust, "--register", folder, "--time", time, "--format", "json"]
    due = json.loads(program("verify", *paths, *options, accept=(1,)))
    found = [dtg_passport.verify(path, trust, time=time, register=str(folder)) for path in paths]
    assert [[check._asdict() for check in answer.checks] for answer in found] == [verdict["checks"] for verdict in due]
    # The five of one stand; of the other two that did not change, and two successors.
    current = [path for path, answer in zip(paths, found) if answer.valid]
    assert len(current) == 9
    assert [passport.verified for passport in dtg_passport.load_many(current, trust, time=time, register=folder)] == [True] * 9
    with pytest.raises(dtg_passport.Refused, match="superseded"):
        list(dtg_passport.load_many([*current, registers.asked[1].passport], trust, time=time, register=folder))
    # A missing register makes nothing valid, and what is no register is no argument.
    for nothing in (tmp_path, tmp_path / "nowhere", "", os.devnull):
        answer = dtg_passport.verify(current[0], trust, time=time, register=nothing)
        assert not answer.valid and answer.checks[-1].code == "register_unknown"
    for wrong in (17, ["register.yaml"], True):
        with pytest.raises(TypeError):
            dtg_passport.verify(current[0], trust, time=time, register=wrong)  # type: ignore[arg-type]


def test_a_calibration_states_the_register(registers: Registers) -> None:
    good = registers.good
    due = program("calibrate", good.passport, CURRENTS, *good.options(), "--method=least-squares", accept=(0, 1))
    for register in (good.register, good.register.read_bytes()):
        passport = dtg_passport.load(good.passport, good.signers, time=good.time, register=register)
        document = passport.calibrate(CURRENTS).document
        assert document == json.loads(due) and document["register"] == good.verdict()["register"]
    assert document["register"]["fresh_until"] == registers.fresh_until
    unasked = dtg_passport.load(good.passport, good.signers, time=good.time).calibrate(CURRENTS)
    assert "register" not in unasked.document
    # Such a result is read again, as an earlier one.
    assert "change" in passport.calibrate(CURRENTS, gyro=PROJECT / "docs/gvk-6.yaml", previous=[document]).document
    # `show` states it as `verify` does.
    shown = json.loads(program("show", good.passport, *good.options()))
    assert shown["register"] == document["register"]


def test_an_unverified_passport_says_so() -> None:
    with pytest.warns(UserWarning, match="NOT VERIFIED"):
        passport = dtg_passport.load_unverified(PASSPORT)
    assert not passport.verified and passport.checks == ()
    assert "NOT VERIFIED" in repr(passport) and "NOT VERIFIED" in passport._repr_html_()
    assert passport.B.tobytes() == load().B.tobytes() and passport.sha256 == load().sha256
    assert "NOT VERIFIED" in repr(passport.calibrate(CURRENTS))
    assert passport.calibrate(CURRENTS).document["passport_verified"] is False
    with pytest.raises(ValueError, match="expected a passport"):
        dtg_passport.load_unverified(CURRENTS)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"at": (91.0, 0.0)}, "latitude 91"),
        ({"at": (float("nan"), 0.0)}, "at.0.: found nan, expected a finite number"),
        ({"at": "12"}, "at: found '12'"),
        ({"at": {55.7, 37.6}}, "at: found {"),
        ({"at": (1.0,)}, "at: found"),
        ({"time": "yesterday"}, "time: found .yesterday.; expected a time"),
        ({"time": "2026-02-30"}, "time: found .2026-02-30.; expected a time such as"),
        ({"time": datetime.datetime(2026, 11, 20)}, "time zone is missing"),
        ({"time": np.datetime64("2026-11-20T10:00")}, "time zone is missing"),
        ({"time": np.datetime64("NaT")}, "time: found None, expected"),
        ({"time": 20261120}, "time: found 20261120, expected text"),
        ({"serial": 17}, "serial: found 17, expected text"),
        ({"serial": b"0017"}, "serial: found b'0017'"),
        ({"serial": ""}, "serial: found empty text"),
    ],
)
def test_what_cannot_be_asked_is_named(asked: dict, words: str) -> None:
    with pytest.raises((ValueError, TypeError), match=words):
        load(**asked)


def test_a_file_that_never_ends_is_refused(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for endless in (pipe, Path("/dev/zero")):
        with pytest.raises(ValueError, match="expected a file"):
            dtg_passport.load(PASSPORT, endless, time=TIME)
        with pytest.raises(ValueError, match="expected a file"):
            load().calibrate(endless)
    large = tmp_path / "large"
    with open(large, "wb") as file:
        file.truncate(1 << 32)
    with pytest.raises(ValueError, match="more than 16777216 bytes"):
        load().calibrate(large)


# --- Many at once. ---


def test_many_come_in_order_and_stop_at_the_first_refused(corpus: Corpus) -> None:
    for threads in (None, 1, 3):
        many = dtg_passport.load_many(iter(corpus.good), corpus.signers, threads=threads, time=TIME)
        assert iter(many) is many
        one = dtg_passport.load(corpus.good[7], corpus.signers, time=TIME)
        found = list(many)
        assert [p.id for p in found] == [verdict["id"] for verdict in corpus.verdicts[:200]]
        assert found[7].B.tobytes() == one.B.tobytes() and found[7].sha256 == one.sha256
    broken = [*corpus.good[:5], corpus.altered[3], *corpus.good[5:]]
    many = dtg_passport.load_many(broken, corpus.signers, time=TIME)
    assert [next(many).id for _ in range(5)] == [verdict["id"] for verdict in corpus.verdicts[:5]]
    with pytest.raises(dtg_passport.Refused) as refused:
        next(many)
    assert refused.value.path == str(corpus.altered[3])
    missing = dtg_passport.load_many([corpus.good[0], "nowhere.yaml"], corpus.signers, time=TIME)
    next(missing)
    with pytest.raises(FileNotFoundError, match="nowhere.yaml"):
        next(missing)
    with pytest.raises(ValueError, match="threads"):
        dtg_passport.load_many(corpus.good, corpus.signers, threads=0)
    with pytest.raises(TypeError, match="expected a list of paths"):
        dtg_passport.load_many(str(corpus.good[0]), corpus.signers)
    with pytest.raises(FileNotFoundError):
        dtg_passport.load_many(corpus.good, "nowhere")


def test_other_threads_run_meanwhile(corpus: Corpus) -> None:
    """A thread that counts goes on while 2,000 passports are verified in one call."""
    from dtg_passport._load import _enquiry

    enquiry = _enquiry(corpus.signers, None, None, TIME, None, (), None)
    ticks, done = 0, threading.Event()

    def count() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    time.sleep(0.01)
    before = ticks
    enquiry.verify_files([str(path) for path in corpus.good] * 10, 1)
    during = ticks - before
    done.set()
    counter.join()
    assert during > 10


# --- Calibration. ---


def fitted(passport: dtg_passport.Passport, rows: np.ndarray, u_ma: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Fit K J + omega_0 + omega_n n = omega_3 by NumPy: parameters, covariance, chi-square; u_ma of every current."""
    current = {(int(i), int(j)): (jx, jy) for i, j, jx, jy in rows}
    a, b = [], []
    for (i, j), (c, d), omega in zip(passport.ij, passport.n, passport.omega):
        jx, jy = current[int(i), int(j)]
        a += [[jx, jy, 0, 0, 1, 0, c, -d], [0, 0, jx, jy, 0, 1, d, c]]
        b += list(omega)
    A, b_ = np.array(a), np.array(b)
    x = np.linalg.lstsq(A, b_, rcond=None)[0]
    # An error of the currents is an error of the rates by K: each pair of equations is whitened by it.
    for _ in range(50):
        W = np.kron(np.eye(len(passport.ij)), np.linalg.inv(x[:4].reshape(2, 2)) / u_ma)
        x = np.linalg.lstsq(W @ A, W @ b_, rcond=None)[0]
    W = np.kron(np.eye(len(passport.ij)), np.linalg.inv(x[:4].reshape(2, 2)) / u_ma)
    residuals = W @ (A @ x - b_)
    return x, np.linalg.inv(A.T @ W.T @ W @ A), float(residuals @ residuals)


def eight(parameters: dtg_passport.Parameters) -> np.ndarray:
    return np.array([*parameters.K.ravel(), *parameters.omega_0, parameters.omega_g, parameters.omega_k])


@pytest.fixture
def uncertain_meter_only(corpus: Corpus, tmp_path: Path) -> tuple[dtg_passport.Passport, Path]:
    """A passport that states no uncertainty but those of zero, and a meter with the same error at every current."""
    stand = yaml.safe_load((PROJECT / "passports/SPS-1/0203/stand.yaml").read_text())
    stand["positions"] = [{key: at[key] for key in at if not key.startswith("u_")} for at in stand["positions"]]
    stand["certificate"] = {key: stand["certificate"][key] for key in ("number", "issued", "laboratory")}
    (tmp_path / "stand.yaml").write_text(yaml.safe_dump(stand))
    site = 'format: "dtg-site/1"\nid: "bench"\nastronomic_latitude_deg: 55.7658\nlongitude_deg: 37.5\n'
    (tmp_path / "bench.yaml").write_text(site)
    program("issue", tmp_path / "stand.yaml", "--site", tmp_path / "bench.yaml", "--key", corpus.folder / "key",
            "--identity", "factory@example.org", "--out", tmp_path, "--issued-at", "2026-11-10T00:00:00Z")  # fmt: skip
    laboratory = tmp_path / "laboratory.yaml"
    meter = "{range_ma: 1.0, reading_percent: 0.0, gain_percent: 0.0, offset_ma: 0.0, floor_ma: 2.0e-07}"
    laboratory.write_text(f'format: "dtg-laboratory/1"\nmeter: {meter}\n')
    [path] = tmp_path.glob("*/*/*-1.yaml")
    return dtg_passport.load(path, corpus.signers, time=TIME), laboratory


def test_least_squares_are_those_of_numpy(uncertain_meter_only: tuple[dtg_passport.Passport, Path]) -> None:
    passport, laboratory = uncertain_meter_only
    exact = np.array([[at["i"], at["j"], at["jx_ma"], at["jy_ma"]] for at in passport.content["self_check"]["currents"]])
    noise = np.random.default_rng(5).normal(0.0, 2e-7, (len(exact), 2))
    rows = exact + np.hstack([np.zeros((len(exact), 2)), noise])
    found = passport.calibrate(rows, laboratory=laboratory)
    x, covariance, chi_square = fitted(passport, rows, 2e-7)
    u = np.sqrt(np.diag(covariance))
    # The same least squares by other arithmetic. The noise is a millionth of the currents, so that whatever is of the
    # second order in it cannot be seen.
    assert np.max(np.abs(eight(found.parameters) - x) / u) < 1e-3
    assert np.max(np.abs(eight(found.u) / u - 1)) < 1e-3
    correlation = np.max(np.abs((found.covariance - covariance) / np.outer(u, u)))
    assert correlation < 1e-3
    assert found.chi_square == pytest.approx(chi_square, rel=1e-3) and found.dof == 2 * len(rows) - 8


def test_the_documented_program_finds_the_same_gyro() -> None:
    """docs/least_squares.py gives every reading the same weight: it agrees within the uncertainty."""
    script = PROJECT / "docs/least_squares.py"
    run = [sys.executable, script, PASSPORT, CURRENTS, SIGNERS, "examples@dtg-passport.test"]
    printed = subprocess.run(run, capture_output=True, text=True, check=True, cwd=PROJECT / "docs").stdout
    numbers = [float(word.strip(",;")) for word in printed.split() if word.strip(",;").replace(".", "", 1).isdigit()]
    assert len(numbers) == 8
    found = load().calibrate(CURRENTS)
    assert np.all(np.abs(eight(found.parameters) - numbers) < 3 * eight(found.u))


@pytest.mark.parametrize("method", ["least-squares", "analytic", "iterative"])
def test_a_calibration_is_that_of_the_program(method: str) -> None:
    options = ["--gyro", PROJECT / "docs/gvk-6.yaml", "--laboratory", PROJECT / "docs/laboratory.yaml"]
    printed = program("calibrate", PASSPORT, CURRENTS, "--trust", SIGNERS, "--time", TIME, "--method", method, *options,
                      "--format", "json")  # fmt: skip
    found = load().calibrate(CURRENTS, gyro=options[1], laboratory=options[3], method=method)
    assert found.document == json.loads(printed)
    [result] = found.document["results"]
    assert found.K.tobytes() == bits(result["k_deg_per_h_per_ma"])
    assert found.u.K.tobytes() == bits(result["standard_uncertainty"]["k_deg_per_h_per_ma"])
    assert np.allclose(np.sqrt(np.diag(found.covariance)), eight(found.u), rtol=1e-14)
    assert found.verdict == json.loads(printed)["verdict"]
    assert found.not_stated == tuple(json.loads(printed)["not_stated"]) and "latitude (latitude_arcsec)" in found.not_stated
    residuals = result.get("residuals_deg_per_h", [])
    assert found.residuals.tobytes() == bits([[at["x"], at["y"]] for at in residuals])
    assert (found.chi_square, found.dof) == (result["chi_square"]["value"], result["chi_square"]["degrees_of_freedom"])


@pytest.mark.parametrize("name", ORDERS)
def test_every_order_is_carried_out_as_by_the_program(tmp_path: Path, name: str) -> None:
    currents, order = ORDERS[name]
    due = json.loads(calibrated(tmp_path, currents, order))
    order = {key: value.encode() if key in ("laboratory", "gyro") and isinstance(value, str) else value for key, value in order.items()}
    found = load().calibrate(currents, **order)
    assert json.dumps(found.document) == json.dumps(due)
    files = {key: tmp_path / f"{key}.yaml" for key in ("laboratory", "gyro") if key in order}
    assert load().calibrate(currents, **{**order, **files}).document == due


def test_an_order_that_cannot_be_carried_out_is_refused_with_its_field() -> None:
    for currents, order, _, words in REFUSED:
        with pytest.raises(ValueError, match=re.escape(words)):
            load().calibrate(currents, **order)


def test_the_general_model_has_no_numbers_of_the_papers() -> None:
    """Its covariance is that of K and ω_0; the elements of G take the places of ω_g and ω_k inside the library."""
    found = load().calibrate(RUN, model="general")
    u, of_the_paper = eight(found.u), np.array([False] * 6 + [True] * 2)
    assert (np.isnan(eight(found.parameters)) == of_the_paper).all() and (np.isnan(u) == of_the_paper).all()
    assert (np.isnan(found.covariance) == (of_the_paper[:, None] | of_the_paper)).all()
    assert np.allclose(np.sqrt(np.diag(found.covariance))[:6], u[:6], rtol=1e-14)
    numbers = found.ufloats()
    assert list(numbers) == ["k_x", "k_xy", "k_yx", "k_y", "omega_0x", "omega_0y"] and numbers["k_x"].n == found.K[0, 0]
    with pytest.raises(ValueError, match="model"):
        found.monte_carlo(1)


def test_currents_come_in_every_form() -> None:
    import pandas

    passport, frame = load(), pandas.read_csv(CURRENTS, comment="#")
    # The SHA-256 is that of the file, or of the CSV that was made of the currents.
    without = lambda found: {key: value for key, value in found.document.items() if key != "subject"}
    due = without(passport.calibrate(CURRENTS))
    with open(CURRENTS) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = {name: [float(row[name]) if name[0] == "j" and len(name) > 1 else int(row[name]) for row in rows] for name in rows[0]}
    array = frame[["i", "j", "jx_ma", "jy_ma"]].to_numpy()
    for currents in (str(CURRENTS), frame, columns, array, array.tolist(), array[::-1]):
        assert without(passport.calibrate(currents)) == due
    for currents in (array[:, :3], array[0], np.zeros((0, 4)), frame.drop(columns="jy_ma"), {"i": [1]}, array * np.nan):
        with pytest.raises(ValueError):
            passport.calibrate(currents)
    with pytest.raises(ValueError, match="currents:4:5.*jx_ma"):
        passport.calibrate(np.vstack([array[:2], [[1, 3, 5.0, 0.1]], array[3:]]))
    with pytest.raises(ValueError, match="laboratory|currents.csv"):
        passport.calibrate(CURRENTS, laboratory=CURRENTS)


def test_columns_are_found_by_their_names() -> None:
    """Of a table of any kind, in any order, and of an index of pandas."""
    import pandas
    import polars
    import pyarrow

    passport, frame = load(), pandas.read_csv(CURRENTS, comment="#")
    due = passport.calibrate(CURRENTS).K.tolist()
    turned = frame[["jy_ma", "j", "jx_ma", "i"]]
    tables = (turned, polars.from_pandas(turned), pyarrow.Table.from_pandas(turned), turned.to_records(index=False))
    for table in (*tables, turned.to_xarray(), turned.set_index(["j", "i"]), turned.set_index("jx_ma"), turned.to_records()):
        assert passport.calibrate(table).K.tolist() == due, type(table)
    wrong = turned.rename(columns={"jx_ma": "jx_ua"})
    for table in (wrong, polars.from_pandas(wrong), pyarrow.Table.from_pandas(wrong), wrong.to_records(index=False)):
        with pytest.raises(ValueError, match="jx_ma"):
            passport.calibrate(table)
    # What the visits and turn-ons are is in the index of a group, too.
    run = pandas.read_csv(RUN, comment="#")
    of_file = passport.calibrate(RUN)
    for table in (run.set_index(["cycle", "visit"]), run.set_index("time_s"), run.groupby("cycle")[list(run)].apply(lambda one: one)):
        found = passport.calibrate(table)
        assert found.K.tolist() == of_file.K.tolist() and found.document["results"] == of_file.document["results"]


def test_times_may_be_dates_or_durations() -> None:
    import pandas
    import polars

    passport, run = load(), pandas.read_csv(RUN, comment="#")
    due = passport.calibrate(RUN, drift=True).document["results"]
    seconds = pandas.to_timedelta(run.time_s, unit="s")
    start = pandas.Timestamp("2026-11-20 09:00")
    for times in (seconds, seconds.astype("timedelta64[ms]"), start + seconds, (start + seconds).astype("datetime64[ms]")):
        for table in (run.assign(time_s=times), polars.from_pandas(run.assign(time_s=times))):
            assert passport.calibrate(table, drift=True).document["results"] == due, times.dtype
    with pytest.raises((TypeError, ValueError), match="jx_ma: found timedelta64"):
        passport.calibrate(run.assign(jx_ma=seconds))


def test_a_result_is_kept_and_read_again() -> None:
    found = load().calibrate(RUN, gyro=PROJECT / "docs/gvk-6.yaml", laboratory=LABORATORY)
    kept = json.dumps(found.document)
    for again in (dtg_passport.Calibration.from_json(kept), dtg_passport.Calibration.from_json(kept.encode()), pickle.loads(pickle.dumps(found))):
        assert again.document == found.document and again.covariance.tobytes() == found.covariance.tobytes()
        with pytest.raises(ValueError, match="no currents"):
            again.monte_carlo(1)
    assert found.assumed_meter is None and "0.015 %" in load().calibrate(CURRENTS).assumed_meter
    with pytest.raises(ValueError, match="unsuitable JSON"):
        dtg_passport.Calibration.from_json("{}")
    # Expected: the rows of `verdict` and the covariance have one order.
    names = ["k_x", "k_xy", "k_yx", "k_y", "omega_0x", "omega_0y", "omega_g", "omega_k"]
    assert [row["parameter"] for row in found.verdict["parameters"]] == names
    of_table = dtg_passport.table([found, found])
    assert np.array_equal(of_table.loc[1, [f"u_{name}" for name in names]].astype(float), np.sqrt(np.diag(found.covariance)))


def test_a_passport_goes_elsewhere_as_its_bytes() -> None:
    passport = load()
    with pytest.raises(TypeError, match="passport.data.*loads"):
        pickle.dumps(passport)
    assert copy.copy(passport) is passport and copy.deepcopy([passport]) == [passport]
    assert dtg_passport.loads(passport.data, SIGNERS, time=TIME) == passport


def test_bad_files_do_not_end_a_batch(tmp_path: Path) -> None:
    bad = tmp_path / "bad.yaml"
    bad.write_bytes(PASSPORT.read_bytes().replace(b"0017", b"0018", 1))
    paths = [PASSPORT, bad, tmp_path / "nowhere.yaml", tmp_path, PASSPORT]
    answers = list(dtg_passport.verify_many(paths, SIGNERS, time=TIME))
    assert [answer.valid for answer in answers] == [True, False, False, False, True]
    due = dtg_passport.verify(PASSPORT, SIGNERS, time=TIME)
    assert answers[0] == due and due.not_asked == ("revocation", "issuer", "stand", "place", "register")
    assert all(answer.not_asked == due.not_asked for answer in answers)
    assert [answer.checks[0].code for answer in answers] == ["ok", "ok", "unreadable", "unreadable", "ok"]
    skipped: list[dtg_passport.Refused] = []
    found = list(dtg_passport.load_many(paths, SIGNERS, time=TIME, skip=skipped.append))
    assert found == [load(), load()] and [refused.path for refused in skipped] == [str(path) for path in paths[1:4]]
    with pytest.raises(FileNotFoundError):
        list(dtg_passport.load_many([PASSPORT, paths[2]], SIGNERS, time=TIME))


def test_a_laboratory_and_a_gyro_type_are_a_path_bytes_or_a_mapping() -> None:
    content = (PROJECT / "docs/gvk-6.yaml").read_bytes()
    of_path = load().calibrate(CURRENTS, gyro=PROJECT / "docs/gvk-6.yaml").document
    assert load().calibrate(CURRENTS, gyro=content).document == of_path


def test_remarks_are_handed_on() -> None:
    import pandas

    frame = pandas.read_csv(CURRENTS, comment="#").assign(operator="N. N.")
    assert any("operator" in remark for remark in load().calibrate(frame).remarks)
    with pytest.raises(dtg_passport.NotValid, match="far from the gyro's") as not_valid:
        load().calibrate(frame.assign(jx_ma=frame.jx_ma / 1000, jy_ma=frame.jy_ma / 1000))
    amperes = not_valid.value.result
    assert amperes.consistent and (amperes.mistake["kind"], amperes.mistake["size"]) == ("range", 0.001)
    assert "0.001000 times those of the gyro" in amperes.remarks[0] and "NOT THIS GYRO" in repr(amperes)
    with pytest.raises(dtg_passport.NotValid, match="far from the gyro's"):
        dtg_passport.Calibration.from_json(json.dumps(amperes.document))
    # Four positions have as many readings as unknowns.
    few = load().calibrate(frame.iloc[[0, 1, 2, 4]])
    assert few.dof == 0 and any("cannot be tested" in remark for remark in few.remarks)
    again = pandas.concat([frame.assign(visit=1), frame.iloc[[7]].assign(visit=2, jx_ma=0.5, jy_ma=0.5)])
    assert any("larger than the stated uncertainties explain" in remark for remark in load().calibrate(again).remarks)
    for found in (amperes, few):
        assert not any("{" in remark for remark in found.remarks) and found.document["remarks"] == list(found.remarks)


def test_no_text_of_a_table_becomes_a_reading() -> None:
    """Names and cells of other columns are text of others: rows, comments, quotes and separators among them."""
    import pandas

    passport, frame = load(), pandas.read_csv(CURRENTS, comment="#")
    without = lambda found: {key: value for key, value in found.document.items() if key not in ("subject", "remarks")}
    due = without(passport.calibrate(frame))
    for cell in ("x\n2,4,0.5,0.5,y", "#", '"', "a,b", "1;2"):
        table = frame.copy()
        table.insert(0, "note", [cell] * 8)
        assert without(passport.calibrate(table)) == due, cell
        assert without(passport.calibrate(frame.rename_axis(columns=None).assign(**{cell: 1}))) == due, cell
    masked = np.ma.array(frame.to_numpy(), mask=False)
    assert without(passport.calibrate(masked)) == due
    masked[3, 2] = np.ma.masked
    for wrong, words in (
        (masked, "masked"),
        (frame.to_numpy() * (1 + 0j), "complex"),
        (frame.assign(jx_ma="0,1"), "jx_ma: could not convert"),
        ({**{name: frame[name] for name in frame}, "j": [1]}, "different lengths"),
        (None, "expected a path"),
        (frame.assign(visits=1), "visit"),
    ):
        with pytest.raises((ValueError, TypeError), match=words):
            passport.calibrate(wrong)


def test_the_trials_are_those_of_the_program() -> None:
    """Every figure to the bit, on any number of threads; the bar and the function see the same numbers."""
    files = {"gyro": PROJECT / "docs/gvk-6.yaml", "laboratory": PROJECT / "docs/laboratory.yaml"}
    options = ["--gyro", files["gyro"], "--laboratory", files["laboratory"], "--method", "least-squares"]
    run = ["--monte-carlo", "--trials", "40000", "--seed", "11", "--format", "json"]
    printed = program("calibrate", PASSPORT, CURRENTS, "--trust", SIGNERS, "--time", TIME, *options, *run)
    due, seen = json.loads(printed)["monte_carlo"], []
    found = load().calibrate(CURRENTS, **files)
    for threads in (None, 1, 3):
        drawn = found.monte_carlo(40_000, seed=11, threads=threads, progress=lambda *at: seen.append(at))
        assert drawn.document == due and json.dumps(drawn.document) == json.dumps(due)
    assert seen == [(49152, 49152)] * 3 and (drawn.trials, drawn.stable) == (49152, False)
    each = due["parameters"]
    for parameters, values in (
        (drawn.mean, [at["mean"] for at in each]),
        (drawn.u, [at["standard_uncertainty"] for at in each]),
        (drawn.interval[0], [at["symmetric_interval"][0] for at in each]),
        (drawn.interval[1], [at["symmetric_interval"][1] for at in each]),
        (drawn.shortest[0], [at["shortest_interval"][0] for at in each]),
        (drawn.shortest[1], [at["shortest_interval"][1] for at in each]),
    ):
        assert eight(parameters).tobytes() == bits(values)
    assert drawn.covariance.tobytes() == bits(due["covariance"]) and not drawn.covariance.flags.writeable
    assert found.monte_carlo(40_000, seed=12).mean.omega_g != drawn.mean.omega_g
    # JCGM 101 against first order: the program finds them equal within a twentieth of u here.
    assert np.all(np.abs(eight(drawn.u) / eight(found.u) - 1) < 0.05)
    for wrong in ({"trials": 0}, {"seed": -1}, {"seed": 2**64}, {"threads": 0}, {"threads": 10**30}, {"trials": 1.5}, {"progress": "yes"}):
        with pytest.raises((ValueError, TypeError), match=f"{next(iter(wrong))}: found"):
            found.monte_carlo(**wrong)


def test_trials_can_be_watched_and_stopped(capsys: pytest.CaptureFixture) -> None:
    """By an exception of the function, by Ctrl-C, and with other threads running meanwhile."""
    found = load().calibrate(CURRENTS)
    found.monte_carlo(16_384, progress=True)
    assert "16.4k/16.4k" in capsys.readouterr().err
    found.monte_carlo(16_384)
    found.monte_carlo(16_384, progress=False)
    assert capsys.readouterr().err == ""

    def full(done: int, due: int) -> None:
        raise KeyError(done)

    with pytest.raises(KeyError, match=r"^16384$"):
        found.monte_carlo(16_384, progress=full)
    code = f"""if True:
        import dtg_passport, os, signal, threading, time
        found = dtg_passport.load({str(PASSPORT)!r}, {str(SIGNERS)!r}, time={TIME!r}).calibrate({str(CURRENTS)!r})
        # The timer is a thread of Python, so it could not run if the trials held the lock.
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        try:
            found.monte_carlo(10**12)
        except KeyboardInterrupt:
            print("stopped")
    """
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stdout, done.stderr) == (0, "stopped\n", "")


# --- The factory. ---

STAND, SITE = PROJECT / "passports/SPS-2/0017/stand.yaml", PROJECT / "sites/moscow-bmstu.yaml"


def issue(corpus: Corpus, out: Path, **asked: object) -> dtg_passport.Issued:
    given = {"stand": STAND, "site": SITE, "key": corpus.folder / "key", "identity": "factory@example.org",
             "issued_at": "2026-11-10T00:00:00Z", "out": out}  # fmt: skip
    return dtg_passport.issue(**{**given, **asked})


@pytest.mark.parametrize(
    ("asked", "options"),
    [
        ({}, []),
        ({"valid_until": datetime.date(2027, 5, 1), "issued_at": datetime.date(2026, 11, 9)},
         ["--valid-until", "2027-05-01", "--issued-at", "2026-11-09"]),
        ({"accuracy": True}, ["--accuracy"]),
        ({"accuracy": True, "gyro": PROJECT / "docs/gvk-6.yaml", "laboratory": PROJECT / "docs/laboratory.yaml"},
         ["--accuracy", "--gyro", PROJECT / "docs/gvk-6.yaml", "--laboratory", PROJECT / "docs/laboratory.yaml"]),
        ({"stand": plain(STAND), "site": plain(SITE)}, []),
    ],
)  # fmt: skip
def test_an_issued_passport_has_the_bytes_of_the_program(corpus: Corpus, tmp_path: Path, asked: dict, options: list) -> None:
    key = ("--key", corpus.folder / "key", "--identity", "factory@example.org", "--out", tmp_path / "due")
    issued_at = [] if "--issued-at" in options else ["--issued-at", "2026-11-10T00:00:00Z"]
    due = json.loads(program("issue", STAND, "--site", SITE, *key, *issued_at, *options, "--format", "json"))[0]
    found = issue(corpus, tmp_path / "found", **asked)
    path = tmp_path / "found/SPS-2/0017/moscow-bmstu-1.yaml"
    assert path.read_bytes() == Path(due["file"]).read_bytes()
    assert (found.id, found.path, found.sha256, found.new) == (due["id"], str(path), due["sha256"], True)
    assert found.remarks == tuple(due["absences"])
    assert dtg_passport.load(path, corpus.signers, time=TIME, register=tmp_path / "found").id == found.id
    again = issue(corpus, tmp_path / "found", **asked)
    assert again == found._replace(new=False, remarks=())


@pytest.mark.parametrize("site", ["moscow-bmstu", "beijing-nim"])
@pytest.mark.parametrize("stand", ["SPS-1/0203", "SPS-2/0017"])
def test_the_module_issues_the_shipped_passports(corpus: Corpus, tmp_path: Path, stand: str, site: str) -> None:
    """`cargo test --test docs examples` compares the program with the same files, with `--release` that of a release build."""
    folder = PROJECT / "passports" / stand
    key = tmp_path / "key"
    key.touch(mode=0o600)  # Git does not keep this mode.
    key.write_bytes((PROJECT / "tests/keys/examples").read_bytes())
    found = issue(corpus, tmp_path, stand=folder / "stand.yaml", site=PROJECT / f"sites/{site}.yaml", key=key,
                  identity="examples@dtg-passport.test", issued_at="2026-11-09T09:00:00Z")  # fmt: skip
    assert Path(found.path).read_bytes() == (folder / f"{site}-1.yaml").read_bytes()


def test_keys_are_found_as_by_the_program(corpus: Corpus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An encrypted key file, and a key in ssh-agent: the same bytes, because Ed25519 signatures have no random part."""
    due = Path(issue(corpus, tmp_path / "due").path).read_bytes()
    encrypted = tmp_path / "encrypted"
    encrypted.write_bytes((corpus.folder / "key").read_bytes())
    encrypted.chmod(0o600)
    subprocess.run(["ssh-keygen", "-q", "-p", "-P", "", "-N", "word", "-f", encrypted], check=True, stdout=subprocess.DEVNULL)
    with pytest.raises(ValueError, match="encrypted: give its passphrase, or set DTG_PASSPORT_PASSPHRASE"):
        issue(corpus, tmp_path / "none", key=encrypted)
    with pytest.raises(ValueError, match="passphrase"):
        issue(corpus, tmp_path / "none", key=encrypted, passphrase="other")
    assert Path(issue(corpus, tmp_path / "a", key=encrypted, passphrase="word").path).read_bytes() == due
    monkeypatch.setenv("DTG_PASSPORT_PASSPHRASE", "word")
    assert Path(issue(corpus, tmp_path / "b", key=encrypted).path).read_bytes() == due

    public = tmp_path / "only.pub"
    public.write_bytes((corpus.folder / "key.pub").read_bytes())
    with pytest.raises(ValueError, match="found only the public half"):
        issue(corpus, tmp_path / "none", key=public)
    agent = subprocess.run(["ssh-agent", "-s"], capture_output=True, text=True, check=True).stdout
    values = dict(part.split("=", 1) for line in agent.splitlines() for part in line.split(";") if "=" in part)
    monkeypatch.setenv("SSH_AUTH_SOCK", values["SSH_AUTH_SOCK"])
    try:
        subprocess.run(["ssh-add", "-q", corpus.folder / "key"], check=True)
        assert Path(issue(corpus, tmp_path / "c", key=public).path).read_bytes() == due
    finally:
        subprocess.run(["ssh-agent", "-k"], env={**os.environ, "SSH_AGENT_PID": values["SSH_AGENT_PID"]}, check=True,
                       stdout=subprocess.DEVNULL)  # fmt: skip
    assert not (tmp_path / "none").exists()


def test_what_cannot_be_issued_leaves_no_file(corpus: Corpus, tmp_path: Path) -> None:
    wrong = plain(STAND) | {"positions": plain(STAND)["positions"][:3]}
    (tmp_path / "file").write_text("")
    other = (PROJECT / "docs/allowed_signers").read_bytes()
    for asked, error, words in (
        ({"stand": "nowhere.yaml"}, FileNotFoundError, "nowhere.yaml"),
        ({"key": "nowhere"}, FileNotFoundError, "nowhere"),
        ({"stand": SITE}, ValueError, "dtg-stand/1"),
        ({"stand": wrong}, ValueError, "do not determine"),
        ({"site": plain(SITE) | {"latitude_deg": float("nan")}}, ValueError, "site:.*latitude_deg"),
        ({"site": plain(SITE) | {"latitude": 55}}, ValueError, "latitude"),
        ({"identity": "a b"}, ValueError, "identity"),
        ({"issued_at": "2040-01-01"}, ValueError, "later than the clock"),
        ({"issued_at": "2026-11-10T00:00:00"}, ValueError, "issued_at: found.*the time zone is missing"),
        ({"valid_until": "2040-01-01"}, ValueError, "certificate"),
        ({"trust": other}, ValueError, "verification"),
        ({"gyro": PROJECT / "docs/gvk-6.yaml"}, ValueError, "accuracy=True"),
        ({"out": tmp_path / "file"}, OSError, "file"),
    ):
        with pytest.raises(error, match=f"(?s){words}"):
            issue(corpus, **{"out": tmp_path / "out", **asked})
    assert not (tmp_path / "out").exists()
    first = issue(corpus, tmp_path / "out", trust=corpus.signers)
    with pytest.raises(ValueError, match="already exists with different content"):
        issue(corpus, tmp_path / "out", valid_until="2027-01-01")
    assert issue(corpus, tmp_path / "out").sha256 == first.sha256


@pytest.mark.parametrize(
    ("asked", "options"),
    [
        ({}, []),
        ({"stand": STAND, "readings": 16, "criterion": "worst"}, ["--stand", STAND, "--readings", "16", "--criterion", "worst"]),
        ({"step": 45, "frame_axis_azimuths": (90, 0), "criterion": "d"},
         ["--angles", "45", "--frame-axis", "east,north", "--criterion", "d"]),
        ({"gyro": plain(PROJECT / "docs/gvk-6.yaml"), "laboratory": PROJECT / "docs/laboratory.yaml"},
         ["--gyro", PROJECT / "docs/gvk-6.yaml", "--laboratory", PROJECT / "docs/laboratory.yaml"]),
    ],
)  # fmt: skip
def test_a_plan_is_that_of_the_program(asked: dict, options: list) -> None:
    due = json.loads(program("plan", "--site", SITE, *options, "--format", "json"))
    found = dtg_passport.plan(SITE, **asked)
    assert found.document == due and found.value == due["value"]
    assert found.order.tobytes() == bits(due["order"]) and len(found.order) == asked.get("readings", 8)
    assert found.u.K.tobytes() == bits(due["standard_uncertainty"]["k_deg_per_h_per_ma"])
    assert found.frame_axis_azimuth == due["frame_axis_azimuth_deg"]
    assert found.paper_u is not None and found.paper_u.omega_0.tobytes() == bits(due["paper"]["standard_uncertainty"]["omega0_deg_per_h"])
    assert dtg_passport.plan(SITE, readings=9).paper_u is None
    for wrong in ({"readings": 3}, {"step": 7}, {"criterion": "best"}, {"frame_axis_azimuths": [400]},
                  {"frame_axis_azimuths": "90"}, {"readings": 8.0}, {"stand": SITE}):
        with pytest.raises((ValueError, TypeError), match="expected"):
            dtg_passport.plan(SITE, **wrong)


# --- The self-check. ---


def by_hand(passport: dtg_passport.Passport, currents: np.ndarray) -> tuple:
    """The paper's analytic method, eq. (11), (13), (15), (16) and (8), in NumPy."""
    current = {(int(i), int(j)): np.array([jx, jy]) for i, j, jx, jy in currents}
    j1, j2 = (np.column_stack([current[i, 1] - current[i, 3], current[i, 2] - current[i, 4]]) for i in (1, 2))
    K = passport.B @ np.linalg.inv(j1 - j2 @ passport.delta)
    omega_n = passport.C - K @ j2 @ passport.n2_inverse
    omega_g, omega_k = (omega_n[0, 0] + omega_n[1, 1]) / 2, (omega_n[1, 0] - omega_n[0, 1]) / 2
    turn = np.array([[omega_g, -omega_k], [omega_k, omega_g]])
    ij = [(int(i), int(j)) for i, j in passport.ij]
    omega_0 = np.mean([w - K @ current[at] - turn @ n for at, w, n in zip(ij, passport.omega, passport.n)], axis=0)
    return K, omega_0, omega_g, omega_k


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_correct_software_passes_the_self_check(path: Path) -> None:
    passport = load(path)
    assert passport.self_check(by_hand).passed
    for method in ("analytic", "least-squares"):
        assert passport.self_check(lambda p, currents: p.calibrate(currents, method=method)).passed


@pytest.mark.parametrize(
    "wrong",
    [
        lambda K, w, g, k: (K.T, w, g, k),
        lambda K, w, g, k: (K, w[::-1], g, k),
        lambda K, w, g, k: (K, w, g, -k),
        lambda K, w, g, k: (K, w, k, g),
        lambda K, w, g, k: (K * (1 + 2e-9), w, g, k),
        lambda K, w, g, k: (K, w, float("nan"), k),
        lambda K, w, g, k: (K, w, g, float("nan")),
        lambda K, w, g, k: (K, w, g, float("inf")),
    ],
)
def test_wrong_software_fails_the_self_check(wrong: object) -> None:
    passport = load(PROJECT / "docs/self_check.yaml")
    result = passport.self_check(lambda p, currents: wrong(*by_hand(p, currents)))  # type: ignore[operator]
    names = ["k_x", "k_xy", "k_yx", "k_y", "omega_0x", "omega_0y", "omega_g", "omega_k"]
    assert not result.passed and result.limit == 1e-9 and list(result.errors) == names
    with pytest.raises(ValueError, match="expected K"):
        passport.self_check(lambda p, currents: (1.0, 2.0, 3.0, 4.0))


# --- Tables, pictures, packages. ---


def test_tables_have_the_numbers() -> None:
    passport = load()
    frame, dataset = passport.to_dataframe(), passport.to_xarray()
    assert frame.loc[(1, 3), "gamma_arcsec"] == passport.at(1, 3).deviations[2]
    assert frame[["omega_x_deg_per_h", "omega_y_deg_per_h"]].to_numpy().tobytes() == passport.omega.tobytes()
    assert list(frame["theta_deg"]) == [0.0] * 4 + [90.0] * 4
    for name, unit in passport.units.items():
        if name in dataset:
            assert dataset[name].values.tobytes() == getattr(passport, name).tobytes()
            assert dataset[name].attrs["units"] == unit
    assert set(dataset) == set(ARRAYS) - {"ij"}


def test_pictures_show_the_numbers() -> None:
    import matplotlib

    matplotlib.use("Agg")
    passport = load()
    heights = np.array([bar.get_height() for bar in passport.plot().patches])
    assert np.array_equal(heights.reshape(3, 8).T, passport.deviations)
    found = passport.calibrate(CURRENTS)
    lines = found.plot().get_lines()
    assert any(np.array_equal(line.get_ydata(), found.residuals[:, 0]) for line in lines)


def test_correlated_numbers_keep_the_covariance() -> None:
    import uncertainties

    found = load().calibrate(CURRENTS)
    numbers = list(found.ufloats().values())
    scale = np.outer(eight(found.u), eight(found.u))
    difference = np.array(uncertainties.covariance_matrix(numbers)) - found.covariance
    assert np.max(np.abs(difference / scale)) < 1e-9


def test_html_is_escaped() -> None:
    html = load()._repr_html_()
    assert load().id in html and "all checks passed" in html and "<script" not in html
    import xml.etree.ElementTree

    xml.etree.ElementTree.fromstring(html)


@pytest.mark.parametrize(
    ("package", "call"),
    [
        ("pandas", lambda passport: passport.to_dataframe()),
        ("xarray", lambda passport: passport.to_xarray()),
        ("matplotlib", lambda passport: passport.plot()),
        ("uncertainties", lambda passport: passport.calibrate(CURRENTS).ufloats()),
        ("tqdm", lambda passport: passport.calibrate(CURRENTS).monte_carlo(1, progress=True)),
    ],
)
def test_a_missing_package_is_named(package: str, call: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in [name for name in sys.modules if name.split(".")[0] == package]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=f"{package} is not installed; install it with: pip install"):
        call(load())


def test_the_optional_packages_are_not_imported() -> None:
    code = "import sys, dtg_passport; print([name for name in ('pandas', 'xarray', 'matplotlib', 'uncertainties', 'tqdm') if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


@pytest.mark.parametrize("name", ["dtg_passport", *dtg_passport.__all__])
def test_examples_in_docstrings(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(PROJECT)
    thing = getattr(dtg_passport, name, dtg_passport)
    finder = doctest.DocTestFinder(recurse=isinstance(thing, type))
    tests = finder.find(thing, name, module=False, globs=dict(vars(dtg_passport)))
    runner = doctest.DocTestRunner()
    for test in tests:
        runner.run(test)
    result = runner.summarize()
    assert result.failed == 0
    assert result.attempted > 0 or name not in ("load", "loads", "load_many", "verify", "issue", "plan", "Passport", "Calibration")


def test_the_examples_of_the_guide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(PROJECT)
    result = doctest.testfile(str(PROJECT / "docs/python.md"), module_relative=False, encoding="utf-8")
    assert result.failed == 0 and result.attempted > 10


def test_every_public_thing_has_a_docstring() -> None:
    for name in dtg_passport.__all__:
        thing = getattr(dtg_passport, name)
        assert thing.__doc__, name
        for part, value in vars(thing).items() if isinstance(thing, type) else ():
            if not part.startswith("_") and isinstance(value, property | type(lambda: 0)):
                assert value.__doc__, f"{name}.{part}"


def test_types_and_stubs_hold(tmp_path: Path) -> None:
    """mypy --strict for the module and for a user; stubtest compares the stub with the compiled part."""
    user = tmp_path / "user.py"
    user.write_text(
        "import dtg_passport, numpy, numpy.typing\n"
        "p = dtg_passport.load('p', 't', at=(55.0, 37.0))\n"
        "B: numpy.typing.NDArray[numpy.float64] = p.B\n"
        "K, g = p.calibrate('c').K, p.calibrate('c').omega_g\n"
        "g + 1.0, B @ K\n"
        "for q in dtg_passport.load_many(['p'], 't', threads=2): q.id.upper()\n"
        "m = p.calibrate('c', gyro={}, model='general', exclude=[{'i': 1}]).monte_carlo(5, progress=lambda done, due: print(done / due))\n"
        "m.interval[0].K @ B, m.trials + 1\n"
        "dtg_passport.issue('s', {'format': 'dtg-site/1'}, key='k', identity='w').path.upper()\n"
        "u = dtg_passport.plan('s', frame_axis_azimuths=[90]).paper_u\n"
        "u is None or u.omega_g + 1.0\n"
    )
    installed = Path(dtg_passport.__file__).parent
    for check in (
        ["mypy", "--strict", str(PROJECT / "python/dtg_passport")],
        ["mypy", "--strict", str(user)],
        ["mypy.stubtest", "dtg_passport._dtg_passport"],
    ):
        done = subprocess.run([sys.executable, "-m", *check], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
    assert (installed / "py.typed").exists() and (installed / "_dtg_passport.pyi").exists()
    user.write_text("import dtg_passport\ndtg_passport.load('p', 't').B = 1\n")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", str(user)], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 1 and 'read-only' in done.stdout, done.stdout
