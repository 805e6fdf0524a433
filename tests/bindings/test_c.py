"""The C library: header, examples, memory, threads, and the same answers as the program."""

from __future__ import annotations

import hashlib
import json
import os
import re
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import PROJECT, SIGNERS, TIME, Corpus, Registers, octave, program
from orders import CURRENTS, GYRO, LABORATORY, ORDERS, PASSPORT, REFUSED, RUN, calibrated

LIBRARIES = PROJECT / "target/debug"
QUESTION = json.dumps({"time": TIME})
SANITIZERS = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
KEYS = ["delta", "b_deg_per_h", "c_deg_per_h_per_g", "n1", "n2", "n2_inverse", "omega1_deg_per_h", "omega2_deg_per_h"]


def compiled(source: Path, to: Path, *options: str, static: bool = False) -> Path:
    link = [str(LIBRARIES / "libdtg_passport.a"), "-lm", "-lpthread", "-ldl"]
    if not static:
        link = [f"-L{LIBRARIES}", f"-Wl,-rpath,{LIBRARIES}", "-ldtg_passport", "-lpthread"]
    warnings = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-g"]
    subprocess.run(["gcc", *warnings, *options, str(source), f"-I{PROJECT / 'c'}", *link, "-o", str(to)], check=True)
    return to


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("c")
    return compiled(PROJECT / "tests/bindings/library.c", folder / "library", *SANITIZERS)


def run(*command: object, given: str = "", accept: int = 0) -> str:
    done = subprocess.run([*map(str, command)], input=given, capture_output=True, text=True)
    assert done.returncode == accept, (command, done.stdout[-2000:], done.stderr[-4000:])
    return done.stdout


def test_the_header_is_what_cbindgen_writes(tmp_path: Path) -> None:
    header = tmp_path / "dtg_passport.h"
    cbindgen = PROJECT / "target/tools/bin/cbindgen"
    config = PROJECT / "c/cbindgen.toml"
    run(cbindgen, "--quiet", "--config", config, "--output", header, PROJECT / "c/src/lib.rs")
    assert header.read_text() == (PROJECT / "c/dtg_passport.h").read_text(), f"write it anew: cp {header} c/"


def test_the_header_is_good_c_and_c_plus_plus(tmp_path: Path) -> None:
    for compiler, source in (("gcc", "a.c"), ("g++", "a.cpp")):
        (tmp_path / source).write_text('#include "dtg_passport.h"\nint main(void) { dtg_free(0); return DTG_OK; }\n')
        run(compiler, "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{PROJECT / 'c'}", tmp_path / source,
            f"-L{LIBRARIES}", f"-Wl,-rpath,{LIBRARIES}", "-ldtg_passport", "-o", tmp_path / "a")  # fmt: skip
        run(tmp_path / "a")


OTHER = PROJECT / "passports/SPS-1/0203/moscow-bmstu-1.yaml"  # not the stand of these currents


@pytest.mark.parametrize("how", ["sanitized", "static", "valgrind"])
def test_the_example_calibrates(tmp_path: Path, how: str) -> None:
    options = SANITIZERS if how == "sanitized" else []
    example = compiled(PROJECT / "c/examples/calibrate.c", tmp_path / "calibrate", *options, static=how == "static")
    before = ["valgrind", "--quiet", "--leak-check=full", "--error-exitcode=9"] if how == "valgrind" else []
    printed = run(*before, example, PASSPORT, SIGNERS, QUESTION, given=CURRENTS.read_text())
    report, _, rest = printed.partition("\n}\n")
    due = json.loads(program("verify", PASSPORT, "--trust", SIGNERS, "--time", TIME, "--format", "json"))
    assert [json.loads(report + "}")] == due
    assert rest.startswith(calibrated(tmp_path, CURRENTS, {}))
    # The paper's equation (13) in the example, and in the program.
    analytic = json.loads(calibrated(tmp_path, CURRENTS, {"method": "analytic"}))
    K = np.array(analytic["results"][0]["k_deg_per_h_per_ma"]).ravel()
    found = printed.splitlines()[-1].split()
    assert found[4] == "deg/(h*mA)" and np.allclose([float(number) for number in found[:4]], K, rtol=0, atol=1e-6)

    order = (PROJECT / "docs/order.json").read_text()
    assert {key: json.loads(order)[key] for key in ("laboratory", "gyro")} == {"laboratory": LABORATORY, "gyro": GYRO}
    printed = run(*before, example, PASSPORT, SIGNERS, QUESTION, order, given=RUN.read_text())
    assert printed.endswith("\n}\n" + calibrated(tmp_path, *ORDERS["drift"]))

    (tmp_path / "altered.yaml").write_bytes(PASSPORT.read_bytes().replace(b"serial", b"Serial", 1))
    rows = CURRENTS.read_text()
    printed = run(*before, example, tmp_path / "altered.yaml", SIGNERS, QUESTION, given=rows, accept=1)
    assert json.loads(printed)["valid"] is False
    for arguments in ((tmp_path, SIGNERS, QUESTION), (PASSPORT, tmp_path / "none", QUESTION), (PASSPORT, SIGNERS, "{")):
        printed = run(*before, example, *arguments, given=rows, accept=2)
        assert json.loads(printed)["error"]["code"] in ("unusable", "unreadable")


def test_the_example_reads_every_row_or_none(tmp_path: Path) -> None:
    example = compiled(PROJECT / "c/examples/calibrate.c", tmp_path / "calibrate", *SANITIZERS)
    rows = CURRENTS.read_text()
    for malformed in (rows.replace("1,3,", "1;3;"), rows + "1,1,-0.2,-0.1,9\n", rows.replace("1,3,-0.1", "1,3,-O.1"), "", "#\n"):
        printed = run(example, PASSPORT, SIGNERS, QUESTION, given=malformed, accept=2)
        assert json.loads(printed.partition("\n}\n")[2])["error"]["code"] == "unreadable"
    # Without one of the eight positions there is no K by equation (13).
    seven = "".join(line for line in rows.splitlines(keepends=True) if not line.startswith("2,4,"))
    assert "deg/(h*mA)" not in run(example, PASSPORT, SIGNERS, QUESTION, given=seven)
    # Nor from columns in another order, nor from readings that do not fit the stand.
    turned = re.sub(r"(?m)^(\w+),(\w+),([^,]+),([^,\n]+)$", r"\1,\2,\4,\3", rows)
    for other, code in ((turned, 0), (rows.replace("1,3,-0.18", "1,3,0.18"), 1)):
        printed = run(example, PASSPORT, SIGNERS, QUESTION, given=other, accept=code)
        assert "deg/(h*mA)" not in printed and '"results"' in printed


def test_the_example_in_c_plus_plus(tmp_path: Path) -> None:
    """The program in docs/c.md, with a good passport and with one of another stand."""
    [source] = re.findall(r"```cpp\n(.*?)```", (PROJECT / "docs/c.md").read_text(), re.DOTALL)
    B = yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])["matrices"]["b_deg_per_h"]
    for serial, accept in (("0017", 0), ("0018", 1)):
        (tmp_path / "example.cpp").write_text(source.replace('"serial": "0017"', f'"serial": "{serial}"'))
        warnings = ["-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-g", *SANITIZERS]
        run("g++", *warnings, tmp_path / "example.cpp", f"-I{PROJECT / 'c'}", f"-L{LIBRARIES}",
            f"-Wl,-rpath,{LIBRARIES}", "-ldtg_passport", "-o", tmp_path / "example")  # fmt: skip
        printed = subprocess.run([tmp_path / "example"], capture_output=True, text=True, cwd=PROJECT)
        assert printed.returncode == accept, printed.stderr
        if accept == 0:
            numbers = re.fullmatch(r"B = \[(.*), (.*); (.*), (.*)\] deg/h\n", printed.stdout)
            assert numbers and [float(number) for number in numbers.groups()] == sum(B, [])
        else:
            assert "wrong_stand" in printed.stdout


def test_what_cannot_be_used_is_refused_without_harm(library: Path) -> None:
    assert run(library) == "misused\n"


def test_threads_agree(library: Path) -> None:
    assert run(library, "threads", PASSPORT, SIGNERS, QUESTION) == "threads agree\n"


def test_every_question_is_asked() -> None:
    """Each key of the question reaches the library; the codes are those of docs/commands.md."""
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    text = lambda value: None if value is None else json.dumps(value).encode()
    keys = (PROJECT / "tests/keys/examples.pub").read_text()
    for question, code in (
        ({"time": TIME, "serial": "0017", "at": [55.766, 37.685], "issuer": "examples@dtg-passport.test"}, "ok"),
        ({"time": TIME, "serial": "0018"}, "wrong_stand"),
        ({"time": TIME, "issuer": "x"}, "wrong_issuer"),
        ({"time": TIME, "at": [0, 0]}, "wrong_place"),
        ({"time": "2031-01-01T00:00:00Z"}, "expired"),
        ({"time": TIME, "revoked": [keys]}, "key_revoked"),
    ):
        passport, report = ctypes.c_void_p(), ctypes.c_char_p()
        paths = (str(PASSPORT).encode(), str(SIGNERS).encode())
        got = c.dtg_load(*paths, text(question), ctypes.byref(passport), ctypes.byref(report))
        codes = [check["code"] for check in json.loads(report.value)["checks"]]
        assert code in codes and got == (0 if code == "ok" else 1) and bool(passport) == (got == 0)
        assert json.loads(report.value)["remarks"] == []
        c.dtg_string_free(report)
        c.dtg_free(passport)


def test_every_register_gives_the_answer_of_the_program(registers: Registers) -> None:
    """As text, and as a list of bytes where it is no text."""
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    c.dtg_calibrate_csv.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_void_p]
    for asked in registers.asked:
        due, content = asked.verdict_on_content(), asked.register.read_bytes()
        questions = [asked.question()]
        if asked.name != "not text":
            questions.append({"time": asked.time, "register": content.decode()})
        for question in questions:
            passport, report, result = ctypes.c_void_p(), ctypes.c_char_p(), ctypes.c_char_p()
            text = (asked.passport.read_bytes(), asked.signers.read_bytes(), json.dumps(question).encode())
            code = c.dtg_loads(*text, ctypes.byref(passport), ctypes.byref(report))
            assert json.loads(report.value) == due, asked.name
            assert code == (0 if due["valid"] else 1) and bool(passport) == due["valid"]
            c.dtg_string_free(report)
            if due["valid"]:
                options = [*asked.options(), "--method=least-squares"]
                assert c.dtg_calibrate_csv(passport, CURRENTS.read_bytes(), None, ctypes.byref(result)) == 0
                assert result.value.decode() == program("calibrate", asked.passport, CURRENTS, *options)[:-1]
                assert json.loads(result.value)["register"] == due["register"]
                c.dtg_string_free(result)
            c.dtg_free(passport)
    good = registers.good
    paths = (str(good.passport).encode(), str(good.signers).encode())
    for register, words in ((17, "found 17, expected the content of a register"), ({}, "found a mapping"), ([256], "found a list")):
        passport, report = ctypes.c_void_p(), ctypes.c_char_p()
        question = json.dumps({"register": register}).encode()
        assert c.dtg_load(*paths, question, ctypes.byref(passport), ctypes.byref(report)) == 2 and not passport
        assert f"register: {words}" in json.loads(report.value)["error"]["message"]
        c.dtg_string_free(report)


def test_the_parameters_are_numbers_and_say_whether_they_may_be_used() -> None:
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    c.dtg_calibrate.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_void_p]
    passport, result = ctypes.c_void_p(), ctypes.c_char_p()
    paths = (str(PASSPORT).encode(), str(SIGNERS).encode(), QUESTION.encode())
    assert c.dtg_load(*paths, ctypes.byref(passport), None) == 0
    rows = np.genfromtxt(CURRENTS, delimiter=",", skip_header=1, comments="#")[-8:]
    wrong = rows.copy()
    wrong[3, 2] += 0.01
    for given, code, words in ((rows, 0, None), (rows * [1, 1, 1e-3, 1e-3], 1, "0.001000 times those of the gyro"), (wrong, 1, "not consistent")):
        given = np.ascontiguousarray(given)
        assert c.dtg_calibrate(passport, given.ctypes.data, len(given), None, ctypes.byref(result)) == code
        value, u, covariance = np.zeros(8), np.zeros(8), np.zeros(64)
        doubles = lambda array: array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        assert c.dtg_parameters(result, doubles(value), doubles(u)) == code
        found = json.loads(result.value)
        assert c.dtg_covariance(result, doubles(covariance)) == code and "0.015 %" in found["assumed_meter"]
        assert covariance.tolist() == np.ravel(found["covariance"]).tolist() and np.allclose(covariance[::9], u**2, rtol=1e-12)
        for got, stated in ((value, found["results"][0]), (u, found["results"][0]["standard_uncertainty"])):
            due = [*np.ravel(stated["k_deg_per_h_per_ma"]), *stated["omega0_deg_per_h"], stated["omega_g_deg_per_h_per_g"], stated["omega_k_deg_per_h_per_g"]]
            assert got.tolist() == due
        assert (words is None and "remarks" not in found) or words in found["remarks"][0]
        c.dtg_string_free(result)
    for text in (b"", b"{}", None):
        assert c.dtg_parameters(text, doubles(value), doubles(u)) == 2 and c.dtg_covariance(text, doubles(covariance)) == 2
    c.dtg_free(passport)


def test_the_content_and_every_number_are_those_of_the_file() -> None:
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    c.dtg_array.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_size_t]
    c.dtg_version.restype = c.dtg_sha256.restype = ctypes.c_char_p
    c.dtg_content.restype = ctypes.c_void_p
    passport = ctypes.c_void_p()
    assert c.dtg_load(str(PASSPORT).encode(), str(SIGNERS).encode(), QUESTION.encode(), ctypes.byref(passport), None) == 0
    text = ctypes.c_void_p(c.dtg_content(passport))
    content = json.loads(ctypes.string_at(text))
    c.dtg_string_free(text)
    assert content == yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])
    assert c.dtg_sha256(passport).decode() == hashlib.sha256(PASSPORT.read_bytes()).hexdigest()
    assert program("--version").split()[1] == c.dtg_version().decode()
    angles = [[at["theta_deg"], at["phi_deg"]] for at in content["positions"]]
    for name, due in (("gravity", content["earth"]["gravity_m_per_s2"]), ("angles", angles), ("delta", content["matrices"]["delta"])):
        numbers = np.zeros(np.size(due))
        assert c.dtg_array(passport, name.encode(), numbers.ctypes.data, len(numbers)) == 0
        assert numbers.tolist() == np.ravel(due).tolist()
        assert c.dtg_array(passport, name.encode(), numbers.ctypes.data, len(numbers) - 1) == 2
    assert c.dtg_array(passport, b"Delta", numbers.ctypes.data, 4) == 2
    assert c.dtg_content(None) is None and c.dtg_sha256(None) is None
    c.dtg_free(passport)


@pytest.fixture(scope="module")
def ordered() -> Callable[[bytes, bytes], tuple[int, str]]:
    """Calibrates by dtg_calibrate_csv; the sanitized program above frees what it got."""
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    passport, result = ctypes.c_void_p(), ctypes.c_char_p()
    paths = (str(PASSPORT).encode(), str(SIGNERS).encode(), QUESTION.encode())
    assert c.dtg_load(*paths, ctypes.byref(passport), None) == 0
    return lambda csv, order: (c.dtg_calibrate_csv(passport, csv, order, ctypes.byref(result)), result.value.decode())


@pytest.mark.parametrize("name", ORDERS)
def test_every_order_gives_the_bytes_of_the_program(ordered: Callable, tmp_path: Path, name: str) -> None:
    currents, order = ORDERS[name]
    assert ordered(currents.read_bytes(), json.dumps(order).encode()) == (0, calibrated(tmp_path, currents, order)[:-1])


def test_an_order_that_cannot_be_carried_out_is_refused_with_its_field(ordered: Callable, tmp_path: Path) -> None:
    assert ordered(CURRENTS.read_bytes(), None) == (0, calibrated(tmp_path, CURRENTS, {})[:-1])
    for currents, order, code, words in REFUSED:
        got, found = ordered(currents.read_bytes(), json.dumps(order).encode())
        error = json.loads(found)["error"]
        assert (got, error["code"]) == (1 if code == "refused" else 2, code) and words in error["message"], found
    for order, words in ((b'{"drift": true, "drift": false}', 'duplicate key "drift"'), (b'{"metod": 1}', "did you mean method?"),
                         (b"[]", "expected a mapping with the keys method"), (b"{", "not usable JSON"), (b"\xff", "UTF-8")):  # fmt: skip
        got, found = ordered(CURRENTS.read_bytes(), order)
        assert got == 2 and words in json.loads(found)["error"]["message"], found


def test_the_library_is_looked_for_by_its_name() -> None:
    dynamic = run("readelf", "--dynamic", LIBRARIES / "libdtg_passport.so")
    assert "soname: [libdtg_passport.so]" in dynamic


def test_every_answer_and_number_is_that_of_the_program(library: Path, corpus: Corpus) -> None:
    """Numbers against PyYAML's reading of the signed bytes, bit for bit."""
    paths = "".join(f"{path}\n" for path in corpus.paths)
    printed = run(library, corpus.signers, QUESTION, given=paths)
    bits = lambda numbers: struct.pack(f"{len(numbers)}d", *numbers)
    for path, due in zip(corpus.paths, corpus.verdicts):
        head, printed = printed.split("\n", 1)
        code, length = map(int, head.split())
        report = printed.encode()[:length] if not printed[:length].isascii() else printed[:length].encode()
        printed = printed[len(report.decode()) + 1 :]
        assert json.loads(report) == due and code == (0 if due["valid"] else 1), path
        numbers, printed = printed.split("end\n", 1)
        if not due["valid"]:
            assert numbers == ""
            continue
        content = yaml.load(path.read_bytes().partition(b"signature: |")[0], Loader=yaml.CSafeLoader)
        rows = [[float.fromhex(number) for number in line.split()] for line in numbers.splitlines()]
        for key, row in zip(KEYS, rows):
            assert bits(row) == bits(sum(content["matrices"][key], []))
        for at, row in zip(content["vectors"], rows[len(KEYS) :], strict=True):
            assert bits(row) == bits([float(at["i"]), float(at["j"]), *at["specific_force_g"], *at["omega_deg_per_h"]])


def test_a_passport_in_memory_gets_the_answer_of_its_file(corpus: Corpus) -> None:
    import ctypes

    c = ctypes.CDLL(str(LIBRARIES / "libdtg_passport.so"))
    signers, question = Path(corpus.signers).read_bytes(), QUESTION.encode()
    for path, due in zip(corpus.paths, corpus.verdicts):
        text, passport, report = path.read_bytes(), ctypes.c_void_p(), ctypes.c_char_p()
        if b"\0" in text:  # ends a text in C
            continue
        code = c.dtg_loads(text, signers, question, ctypes.byref(passport), ctypes.byref(report))
        assert json.loads(report.value) == json.loads(json.dumps(due).replace(str(path), "passport"))
        assert code == (0 if due["valid"] else 1) and bool(passport) == due["valid"]
        assert c.dtg_positions(passport) == (8 if due["valid"] else 0)
        c.dtg_string_free(report)
        c.dtg_free(passport)


def test_lists_are_arrays_in_octave(corpus: Corpus, tmp_path: Path) -> None:
    """Also where one position does not state an uncertainty that the others state."""
    stand = (PROJECT / "passports/SPS-2/0017/stand.yaml").read_text()
    (tmp_path / "stand.yaml").write_text(stand.replace(", u_beta_arcsec: 1.2", "", 1))
    who = ("--key", corpus.folder / "key", "--identity", "factory@example.org", "--issued-at", "2026-11-10T00:00:00Z")
    program("issue", tmp_path / "stand.yaml", "--site", PROJECT / "sites/moscow-bmstu.yaml", *who, "--out", tmp_path)
    [passport] = tmp_path.glob("*/*/*-1.yaml")
    script = tmp_path / "test.m"
    script.write_text(f"""
        addpath('{PROJECT}/docs/matlab');
        p = dtg_load('{passport}', '{corpus.signers}', 'time', '{TIME}');
        disp([isstruct(p.positions), numel(p.positions), isstruct(p.vectors), numel(p.vectors), p.verified]);
        disp([numel([p.positions.u_beta_arcsec]), isempty(p.positions(1).u_beta_arcsec)]);
        printf('%g ', p.positions.gamma_arcsec); printf('\\n%s\\n', p.sha256, p.checks.code);
    """)
    shape, absent, gammas, sha256, *codes = octave(script).splitlines()
    assert (shape.split(), absent.split()) == (["1", "8", "1", "8", "1"], ["7", "1"])
    assert sha256 == hashlib.sha256(passport.read_bytes()).hexdigest() and len(codes) > 5 and set(codes) == {"ok", "not_asked", ""}
    assert [float(gamma) for gamma in gammas.split()] == [at["gamma_arcsec"] for at in yaml.safe_load(stand)["positions"]]


def test_octave_and_matlab_functions(tmp_path: Path) -> None:
    """docs/matlab in Octave: numbers to one unit in the last place, which is what its jsondecode gives."""
    due = yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])
    [result] = json.loads(calibrated(tmp_path, CURRENTS, {}))["results"]
    rows = ";".join(line for line in CURRENTS.read_text().splitlines() if line[:1].isdigit())
    script = tmp_path / "test.m"
    script.write_text(f"""
        addpath('{PROJECT}/docs/matlab');
        p = dtg_load('{PASSPORT}', '{SIGNERS}', 'serial', '0017', 'time', '{TIME}');
        printf('%.17g ', p.matrices.b_deg_per_h', p.matrices.delta'); printf('\\n');
        c = dtg_calibrate('{PASSPORT}', '{SIGNERS}', [{rows}], 'serial', '0017', 'time', '{TIME}');
        printf('%.17g ', c.K', c.omega_0, c.omega_g, c.omega_k, c.u.K'); printf('\\n');
        try, dtg_load('{PASSPORT}', '{SIGNERS}', 'serial', '0018', 'time', '{TIME}'); catch e, disp(e.identifier); end
        try, dtg_load('{PASSPORT}', '{SIGNERS}', 'serail', '0017'); catch e, disp(e.identifier); end
        try, dtg_load('it''s "no" $(file)', '{SIGNERS}'); catch e, disp(e.identifier); end
        try, dtg_load('{PASSPORT}', '{SIGNERS}', 'serial', 17); catch e, disp(e.identifier); end
        try, dtg_load('{PASSPORT}', '{SIGNERS}', 'trust', '{PASSPORT}'); catch e, disp(e.identifier); end
        try, dtg_load('--help', '{SIGNERS}'); catch e, disp(e.identifier); end
        try, dtg_calibrate('{PASSPORT}', '{SIGNERS}', ones(8, 5)); catch e, disp(e.identifier); end
        try, dtg_calibrate('{PASSPORT}', '{SIGNERS}', [{rows}] + 1i); catch e, disp(e.identifier); end
        try, dtg_load('{PASSPORT}', '{SIGNERS}', 'at', [10 20], 'time', '{TIME}'); catch e, disp(e.message); end
        try, dtg_calibrate('{OTHER}', '{SIGNERS}', [{rows}], 'time', '{TIME}'); catch e, disp(e.identifier); end
        try, dtg_calibrate('{PASSPORT}', '{SIGNERS}', [{rows}] * diag([1 1 1e-3 1e-3]), 'time', '{TIME}');
        catch e, disp(e.identifier); disp(strtok(e.message, char(10))); end
        g = dtg_calibrate('{PASSPORT}', '{SIGNERS}', '{RUN}', 'time', '{TIME}', 'model', 'general', 'drift', false);
        printf('%.17g ', g.G', g.u.G'); printf('\\n'); disp(isfield(g, 'omega_g'));
        d = dtg_calibrate('{PASSPORT}', '{SIGNERS}', '{RUN}', 'time', '{TIME}', 'laboratory', '{PROJECT}/docs/laboratory.yaml', ...
            'gyro', '{PROJECT}/docs/gvk-6.yaml', 'drift', true, 'temperature-c', 21.5, 'exclude', '2,4,1,3', 'why', 'door opened');
        printf('%.17g ', d.K', d.u.omega_g, d.document.results.drift_deg_per_h_per_h); printf('\\n');
        disp(d.document.verdict.overall); disp(d.document.excluded.why); disp(d.document.subject.temperature_c);
    """)
    loaded, found, *refused = octave(script).splitlines()
    ulp = lambda printed, numbers: np.testing.assert_array_max_ulp(np.array(printed.split(), dtype=float), np.array(numbers), 1)
    ulp(loaded, np.concatenate([np.ravel(due["matrices"][key]) for key in ("b_deg_per_h", "delta")]))
    ulp(found, [*np.ravel(result["k_deg_per_h_per_ma"]), *result["omega0_deg_per_h"],
                result["omega_g_deg_per_h_per_g"], result["omega_k_deg_per_h_per_g"],
                *np.ravel(result["standard_uncertainty"]["k_deg_per_h_per_ma"])])  # fmt: skip
    expected = ["refused", "option", "unusable", "option", "option", "unusable", "unusable", "unusable"]
    assert refused[:8] == [f"dtg:{identifier}" for identifier in expected]
    assert re.fullmatch(r"exit code 1: \d+ km from moscow-bmstu; .*", refused[8])
    assert refused[9:11] == ["dtg:inconsistent", "dtg:mistake"] and "0.001000 times those of the gyro" in refused[11]
    general, drift = (json.loads(calibrated(tmp_path, *ORDERS[name])) for name in ("general", "drift"))
    [due], printed, absent, of_the_run, verdict, why, celsius = general["results"], *refused[12:]
    ulp(printed, np.ravel([due["g_matrix_deg_per_h_per_g"], due["standard_uncertainty"]["g_matrix_deg_per_h_per_g"]]))
    [due] = drift["results"]
    ulp(of_the_run, [*np.ravel(due["k_deg_per_h_per_ma"]), due["standard_uncertainty"]["omega_g_deg_per_h_per_g"],
                     *due["drift_deg_per_h_per_h"]])  # fmt: skip
    assert (absent, verdict, why, celsius) == ("0", drift["verdict"]["overall"], "door opened", "21.500")


def test_every_register_gives_the_answer_of_the_program_in_octave(registers: Registers, tmp_path: Path) -> None:
    good = registers.good
    lines = [f"addpath('{PROJECT}/docs/matlab');"]
    for asked in registers.asked:
        options = f"'{asked.signers}', 'time', '{asked.time}', 'register', '{asked.register}'"
        lines.append(f"try, p = dtg_load('{asked.passport}', {options}); printf('%s\\n', p.checks(end).code);")
        lines.append("catch e, printf('%s %s\\n', e.identifier, e.message); end")
    signers, options = f"'{good.signers}'", f"'time', '{good.time}', 'register', '{registers.passports}'"
    lines += [
        f"p = dtg_load('{good.passport}', {signers}, {options}); printf('%s %d\\n', p.register.sha256, p.register.sequence);",
        f"c = dtg_calibrate('{good.passport}', {signers}, '{CURRENTS}', {options});",
        "printf('%s\\n', c.document.register.sha256);",
        f"try, dtg_calibrate('{registers.withdrawn.passport}', {signers}, '{CURRENTS}', {options});",
        "catch e, printf('%s %s\\n', e.identifier, e.message); end",
    ]
    script = tmp_path / "test.m"
    script.write_text("\n".join(lines))
    answers = octave(script).splitlines()
    loaded, calibrated, refused, *checks = answers[len(registers.asked) :]
    for asked, answer in zip(registers.asked, answers):
        due = asked.verdict()
        assert answer == ("ok" if due["valid"] else f"dtg:refused exit code 1: {due['checks'][-1]['detail']}"), asked.name
    used = good.verdict()["register"]
    assert (loaded, calibrated) == (f"{used['sha256']} {used['sequence']}", used["sha256"])
    assert refused.startswith("dtg:refused exit code 1: ") and any("withdrawn at" in check for check in checks)
