"""The verifier for browsers and Node.js: the same answers as the program, no imports, no network."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import yaml
from conftest import PROJECT, SIGNERS, TIME, Corpus, Registers, program
from orders import CURRENTS, ORDERS, PASSPORT, REFUSED, RUN, calibrated

WEB = PROJECT / "target/web"


def node(script: str, given: object = None) -> subprocess.CompletedProcess[str]:
    command = ["node", script] if script.endswith("js") else ["node", "--input-type=module", "--eval", script]
    tools = PROJECT / "target/test-tools/page/node_modules"
    done = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True, env={**os.environ, "NODE_PATH": str(tools)})
    assert done.returncode == 0, done.stderr
    return done


def test_the_module_imports_nothing_and_the_page_is_small() -> None:
    text = (WEB / "dtg_passport.mjs").read_text()
    [packed] = re.findall(r'const WASM = "([A-Za-z0-9+/=]+)"', text)
    module = WEB / "module.wasm"
    module.write_bytes(gzip.decompress(base64.b64decode(packed)))
    script = f"""
        import {{ readFileSync }} from "node:fs";
        const module = new WebAssembly.Module(readFileSync("{module}"));
        console.log(JSON.stringify([WebAssembly.Module.imports(module), WebAssembly.Module.exports(module).map((e) => e.name)]));
    """
    imports, exports = json.loads(node(script).stdout)
    assert imports == [] and {"verify", "content", "print", "calibrated", "room", "memory"} <= set(exports)
    page = WEB / "verify.html"
    assert page.stat().st_size <= 1_500_000
    print(f"\nmodule {module.stat().st_size} bytes, page {page.stat().st_size} bytes")
    # One file: nothing is loaded from elsewhere.
    assert not re.search(r'(src|href)="', page.read_text().replace(packed, "").replace('rel="', ""))


def test_every_answer_and_number_is_that_of_the_program(corpus: Corpus) -> None:
    """Numbers against PyYAML's reading of the signed bytes; JSON has the same binary64 values in both."""
    given = {"module": str(WEB / "dtg_passport.mjs"), "signers": str(corpus.signers), "time": TIME}
    done = node(str(PROJECT / "tests/bindings/check.mjs"), {**given, "paths": [str(path) for path in corpus.paths]})
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(lines) == len(corpus.paths)
    print(f"\n{done.stderr.strip()}")
    for path, due, found in zip(corpus.paths, corpus.verdicts, lines):
        # The name of the file is in details of the form.
        checks = json.loads(json.dumps(due["checks"]).replace(json.dumps(due["file"])[1:-1], "passport"))
        verdict = {**{key: due[key] for key in ("valid", "id", "not_asked", "remarks")}, "checks": checks}
        assert found["verdict"] == verdict, path
        if due["valid"]:
            content = yaml.load(path.read_bytes().partition(b"signature: |")[0], Loader=yaml.CSafeLoader)
            assert found["content"] == {"sha256": hashlib.sha256(path.read_bytes()).hexdigest(), **content}
        else:
            assert found["content"] is False


ASK = """
    import { readFileSync } from "node:fs";
    import * as dtg from "%s";
    const [passport, signers, currents] = [%s].map((path) => readFileSync(path));
    const keys = readFileSync("%s");
    const answer = async (what) => { try { return await what(); } catch (error) { return error.cause ?? String(error); } };
    const text = signers.toString();
    const buffer = passport.buffer.slice(passport.byteOffset, passport.byteOffset + passport.length);
    const time = "2026-11-20";
    console.log(JSON.stringify(await Promise.all([
        () => dtg.verify(passport, signers, { time }),
        () => dtg.verify(buffer, text, { time: new Date("2026-11-20T00:00:00.5Z"), serial: "0017", at: [55.766, 37.685] }),
        () => dtg.verify(passport, text, { time, serial: "0018" }),
        () => dtg.verify(passport, text, { time, at: [0, 0] }),
        () => dtg.verify(passport, text, { time, issuer: "x" }),
        () => dtg.verify(passport, text, { time: "2031-01-01" }),
        () => dtg.verify(passport, text, { time, revoked: [keys] }),
        () => dtg.verify(passport, text, { time, revoked: [keys.toString()] }),
        () => dtg.verify(passport, text),
        () => dtg.verify(passport, text, { time: "tomorrow" }),
        () => dtg.verify(passport, currents, { time }),
        () => dtg.verify(new Uint8Array(), text, { time }),
        () => dtg.calibrate(passport, text, currents, { time }),
        () => dtg.calibrate(passport, text, passport, { time }),
        () => dtg.calibrate(passport, text, currents, { time, serial: "0018" }),
        () => dtg.print(passport, text, { time }),
        () => dtg.print(currents, text, { time }),
    ].map(answer))));
"""


def test_every_function_and_question(tmp_path: Path) -> None:
    files = ", ".join(json.dumps(str(path)) for path in (PASSPORT, SIGNERS, CURRENTS))
    found = json.loads(node(ASK % (WEB / "dtg_passport.mjs", files, PROJECT / "tests/keys/examples.pub")).stdout)
    good, asked, *refused = found[:8]
    assert good["valid"] and asked["valid"] and good["id"] == "SPS-2/0017/moscow-bmstu/1"
    # Expected: the contract; what was not asked has no result.
    assert good["not_asked"] == ["revocation", "issuer", "stand", "place", "register"] and good["remarks"] == []
    assert asked["not_asked"] == ["revocation", "issuer", "register"]
    assert [check["name"] for check in good["checks"] if check["code"] == "not_asked"] == good["not_asked"]
    codes = ["wrong_stand", "wrong_place", "wrong_issuer", "expired", "key_revoked", "key_revoked"]
    for answer, code in zip(refused, codes):
        assert answer["valid"] is False and code in [check["code"] for check in answer["checks"]]
    # Without a time it is that of the clock.
    assert found[8]["checks"][6]["name"] == "in_force" and found[8]["checks"][6]["passed"] is not None
    assert 'time: found "tomorrow"; expected a time' in found[9]["message"] and found[10]["code"] == "unreadable" and found[10]["problems"]
    assert found[11]["valid"] is False and found[11]["checks"][0]["code"] == "malformed"
    assert found[12] == json.loads(calibrated(tmp_path, CURRENTS, {}))
    assert found[13]["code"] == "unreadable" and found[14]["valid"] is False
    assert found[15].startswith("<!DOCTYPE html>") and "SPS-2/0017/moscow-bmstu/1" in found[15]
    assert found[16]["valid"] is False


ORDERED = """
    import { readFileSync } from "node:fs";
    import { calibrate } from "%s";
    const [passport, signers] = [%s].map((path) => readFileSync(path));
    const answer = ([currents, order]) => calibrate(passport, signers, readFileSync(currents), { time: "%s" }, order)
        .catch((error) => error.cause ?? error.message);
    const orders = JSON.parse(readFileSync(0, "utf8"));
    const lost = [{ gyro: undefined }, { drift: () => true }, { laboratory: { meter: { noise_ma: NaN } } }, new Map(), null];
    console.log(JSON.stringify(await Promise.all([...orders, ...lost.map((order) => [orders[0][0], order])].map(answer))));
"""


def test_every_order_is_carried_out_as_by_the_program_or_refused(tmp_path: Path) -> None:
    """Also as JSON, whose duplicate keys JavaScript would lose, and never without a key that is undefined."""
    files = ", ".join(json.dumps(str(path)) for path in (PASSPORT, SIGNERS))
    texts = [('{"drift": true, "drift": false}', 'duplicate key "drift"'), ('{"metod": 1}', "did you mean method?")]
    orders = [*ORDERS.values(), *(case[:2] for case in REFUSED), *((CURRENTS, text) for text, _ in texts)]
    given = [(str(currents), order) for currents, order in orders]
    found = iter(json.loads(node(ORDERED % (WEB / "dtg_passport.mjs", files, TIME), given).stdout))
    for currents, order in ORDERS.values():
        assert next(found) == json.loads(calibrated(tmp_path, currents, order))
    for _, order, code, words in REFUSED:
        refused = next(found)
        assert refused["code"] == code and words in refused["message"], (order, refused)
    for _, words in texts:
        assert words in next(found)["message"]
    words = ["gyro: found undefined", "drift: found function", "noise_ma: found NaN", "found Map", "found null"]
    assert all(due in said for due, said in zip(words, found, strict=True))


TYPED = """
    import { calibrate, content, print, verify, type Order, type Question } from "./dtg_passport.mjs";
    const passport = new Uint8Array();
    const question: Question = { serial: "0017", time: new Date(), at: [55.766, 37.685], revoked: [passport, "text"], register: passport };
    const visit = { i: 2, j: 4, visit: 1, why: "door opened" };
    const order: Order = { method: "least-squares", model: "general", drift: true, exclude: [visit], laboratory: {}, gyro: "format: dtg-gyro/1", date: "2026-11-19" };
    const { valid, register, checks } = await verify(passport, "signers", question);
    const found = await calibrate(passport.buffer, passport, "i,j,jx_ma,jy_ma", question, order);
    const said: string[] = [...(found.remarks ?? []), register?.sha256 ?? "", found.register?.issued_at ?? "", await print(passport, "signers"), ...checks.map(({ code }) => code)];
    const numbers: number[] = found.results[0].omega0_deg_per_h;
    const gravity: number = (await content(passport, "signers")).earth.gravity_m_per_s2;
    export { valid, said, numbers, gravity };
"""


def test_the_types_for_typescript_hold(tmp_path: Path) -> None:
    """A user with the strictest options, and one error each: in a question, an order, an answer."""
    (tmp_path / "dtg_passport.d.mts").write_bytes((WEB / "dtg_passport.d.mts").read_bytes())
    tsc = PROJECT / "target/bindings/node_modules/typescript/bin/tsc"
    strict = ["--noEmit", "--strict", "--exactOptionalPropertyTypes", "--noUncheckedIndexedAccess", "--module", "nodenext", "--target", "es2022"]
    for right, wrong, words in (("", "", ""), ("serial:", "serail:", "'serail' does not exist"), ('"general"', '"full"', '"full"'),
                                ("checks }", "check }", "'check' does not exist"), ("[0].omega0", "[0].omega", "'unknown' is not assignable to type 'number[]'"), ("[55.766, 37.685]", "[55.766]", "not assignable")):  # fmt: skip
        (tmp_path / "user.mts").write_text(TYPED.replace(right, wrong) if right else TYPED)
        done = subprocess.run(["node", tsc, *strict, tmp_path / "user.mts"], capture_output=True, text=True)
        assert (done.returncode == 0) == (words == "") and words in done.stdout, done.stdout


MISUSED = """
    import { readFileSync } from "node:fs";
    import * as dtg from "%s";
    const [passport, signers, currents] = %s.map((path) => readFileSync(path));
    class Stand { get serial() { return "0018"; } }
    const wrong = [new Map([["serial", "0018"]]), new URLSearchParams("serial=0018"), Object.create({ serial: "0018" }),
        new Stand(), { serial: () => "0018" }, { serial: Symbol("0018") }, { serial: undefined }, { serial: null }, { serial: "" },
        { serial: 18 }, { register: undefined }, { register: 17 }, { register: {} }, { at: [NaN, 37] }, { at: "55,37" }, ["0018"], null, "0018"];
    const said = (question) => dtg.verify(passport, signers, question).then(({ valid }) => `valid ${valid}`, (error) => error.message);
    const other_world = (await import("node:vm")).runInNewContext("({ time: '2026-11-20', serial: '0018' })");
    const semicolons = currents.toString().replaceAll(".", "¤").replaceAll(",", ";").replaceAll("¤", ",");
    const amperes = currents.toString().replace(/-?0\\.\\d+/g, (number) => (number / 1000).toPrecision(12));
    const calibrated = (text) => dtg.calibrate(passport, signers, new TextEncoder().encode(text), { time: "2026-11-20" });
    const not_valid = (text) => calibrated(text).then(() => "valid", ({ message, cause }) => ({ message, ...cause }));
    console.log(JSON.stringify({
        refused: await Promise.all(wrong.map(said)),
        other_world: await said(other_world),
        semicolons: await calibrated(semicolons),
        amperes: await not_valid(amperes),
        version: dtg.version,
    }));
"""


def test_a_question_is_never_left_out_and_remarks_are_handed_on(corpus: Corpus) -> None:
    """A check that is silently left out would make a passport of another stand valid."""
    [mine] = [path for path in corpus.good if path.parts[-2:] == ("0017", "site-60-1.yaml")]
    paths = json.dumps([str(path) for path in (mine, corpus.signers, CURRENTS)])
    found = json.loads(node(MISUSED % (WEB / "dtg_passport.mjs", paths)).stdout)
    assert not [said for said in found["refused"] if said.startswith("valid")], found["refused"]
    for words in ("question: found Map", "serial: found undefined; leave the key out", "serial: found null", "serial: found empty text",
                  "serial: found 18, expected text", "register: found undefined; leave the key out",
                  "register: found 17, expected the content of a register", "register: found a mapping", "0: found NaN"):  # fmt: skip
        assert any(words in said for said in found["refused"]), (words, found["refused"])
    assert found["other_world"] == "valid false"
    assert any("decimal commas" in remark for remark in found["semicolons"]["remarks"])
    amperes = found["amperes"]
    assert "0.001000 times those of the gyro" in amperes["remarks"][0] and amperes["mistake"] and amperes["message"].startswith("not valid: ")
    assert found["version"] == program("--version").split()[1]


REGISTERED = """
    import { readFileSync } from "node:fs";
    import * as dtg from "%s";
    const currents = readFileSync("%s");
    const cases = JSON.parse(readFileSync(0, "utf8"));
    const answer = (what) => what.catch((error) => error.cause ?? error.message);
    for (const { passport, signers, register, time } of cases) {
        const files = [readFileSync(passport), readFileSync(signers, "utf8")];
        const content = readFileSync(register);
        const text = content.toString("utf8");
        const shapes = [content, content.buffer.slice(content.byteOffset, content.byteOffset + content.length)];
        if (Buffer.from(text).equals(content)) shapes.push(text);
        const found = [];
        for (const given of shapes) {
            const question = { time, register: given };
            found.push([await dtg.verify(...files, question), await answer(dtg.content(...files, question)),
                await answer(dtg.calibrate(...files, currents, question)), await answer(dtg.print(...files, question))]);
        }
        console.log(JSON.stringify(found));
    }
"""


def test_every_register_gives_the_answer_of_the_program(registers: Registers, tmp_path: Path) -> None:
    cases = [{key: str(value) for key, value in asked._asdict().items()} for asked in registers.asked]
    lines = node(REGISTERED % (WEB / "dtg_passport.mjs", CURRENTS), cases).stdout.splitlines()
    for asked, line in zip(registers.asked, lines, strict=True):
        due = asked.verdict_on_content()
        del due["file"]
        program("render", asked.passport, "-o", tmp_path / "due.html", "--force", *asked.options()[:-2], accept=(0, 1))
        page = (tmp_path / "due.html").read_text().replace(str(asked.register), "register")
        found = json.loads(line)
        assert len(found) == (2 if asked.name == "not text" else 3)
        for verdict, content, calibration, printed in found:
            assert verdict == due and list(verdict) == list(due), asked.name
            assert printed == page, asked.name
            if due["valid"]:
                options = [*asked.options(), "--method=least-squares"]
                assert calibration == json.loads(program("calibrate", asked.passport, CURRENTS, *options))
                assert calibration["register"] == due["register"] and content["passport"]["id"] == due["id"]
            else:
                assert content == calibration == {"valid": False, "id": due["id"], "checks": due["checks"]}


def test_the_printed_passport_is_that_of_the_program(tmp_path: Path) -> None:
    program("render", PASSPORT, "-o", tmp_path / "due.html", "--trust", SIGNERS, "--time", TIME)
    files = ", ".join(json.dumps(str(path)) for path in (PASSPORT, SIGNERS))
    script = f"""
        import {{ readFileSync }} from "node:fs";
        import {{ print }} from "{WEB / "dtg_passport.mjs"}";
        process.stdout.write(await print(...[{files}].map((path) => readFileSync(path)), {{ time: "{TIME}" }}));
    """
    assert node(script).stdout == (tmp_path / "due.html").read_text()


def test_the_page_in_chromium(registers: Registers, tmp_path: Path) -> None:
    altered = tmp_path / "altered.yaml"
    altered.write_bytes(PASSPORT.read_bytes().replace(b"alpha_arcsec: 12.4", b"alpha_arcsec: 12.5", 1))
    hostile = tmp_path / "<img src=x onerror=alert(1)>.yaml"
    hostile.write_bytes(b'<script>alert(1)</script>: "<img src=x onerror=alert(1)>"\n')
    files = {"passport": str(PASSPORT), "signers-file": str(SIGNERS)}
    revoked = str(PROJECT / "tests/keys/examples.pub")
    (tmp_path / "order.json").write_text(json.dumps(ORDERS["general"][1]))
    asked = {"time": TIME}
    serial = {**asked, "serial": "0017"}
    cases = [
        {"files": {**files, "currents": str(CURRENTS)}, "fields": {**asked, "serial": "0017", "latitude": "55.766", "longitude": "37.685"}},
        {"files": {**files, "passport": str(altered)}, "fields": asked},
        {"files": {**files, "revoked": revoked}, "fields": asked},
        {"files": {**files, "passport": str(hostile)}, "fields": {"time": TIME}},
        {"files": files, "fields": {"time": "<img src=x onerror=alert(1)>"}},
        {"files": {"passport": str(PASSPORT)}, "fields": {"signers": SIGNERS.read_text(), **asked}},
        {"files": {}, "fields": {}},
        {"files": {}, "fields": serial, "drops": [[str(PASSPORT), str(SIGNERS), str(CURRENTS)]]},
        {"files": files, "fields": asked},
        {"files": {}, "fields": serial, "drops": [[str(PASSPORT), str(SIGNERS), str(RUN), str(tmp_path / "order.json")]]},
    ]
    registered = [{"files": {"passport": str(one.passport), "signers-file": str(one.signers), "register": str(one.register)}, "fields": {"time": one.time}}
                  for one in registers.asked]  # fmt: skip
    # A dropped register is told from a passport by its content.
    [given] = registered[:1]
    whole = registers.passports / "SPS-2/0017/register.yaml"
    dropped = {"files": {}, "fields": {**given["fields"], "serial": "0017"}, "drops": [[given["files"]["passport"], given["files"]["signers-file"], str(whole)]]}
    cases += [dropped, *registered]
    found = json.loads(node(str(PROJECT / "tests/bindings/page.cjs"), {"page": str(WEB / "verify.html"), "cases": cases}).stdout)
    good, changed, withdrawn, strange, no_time, typed, nothing, dropped, again, general, *registered = found["results"]
    for result in (good, typed, dropped, again):
        assert "VALID SO FAR" in result["text"] and result["headings"][:2] == ["Answer", "Numbers"]
        assert result["frame"] > 10_000 and "SPS-2/0017/moscow-bmstu/1" in result["text"]
        assert "SPS-2" in result["printed"]
    content = yaml.safe_load(PASSPORT.read_bytes().partition(b"signature: |")[0])
    checks, matrices, positions, parameters = good["rows"]
    made = [row[1] for row in checks if row[0] == "ok"]
    assert made == ["grammar", "signature", "schema", "signer", "recomputed", "in_force", "stand", "place"]
    assert [row[1] for row in checks if row[0] == "not asked"] == ["revocation", "issuer", "register"]
    shown = {key: [[float(number) for number in line.split()] for line in rows.splitlines()] for key, rows in matrices}
    assert shown == content["matrices"]
    for row, at, vector in zip(positions, content["positions"], content["vectors"], strict=True):
        due = [at["i"], at["j"], at["alpha_arcsec"], at["beta_arcsec"], at["gamma_arcsec"]]
        assert [float(cell) for cell in row] == [*due, *vector["specific_force_g"], *vector["omega_deg_per_h"]]
    [result] = json.loads(calibrated(tmp_path, CURRENTS, {}))["results"]
    assert [float(number) for number in parameters[0][1].split()] == sum(result["k_deg_per_h_per_ma"], [])
    assert "Calibration by least-squares" in dropped["headings"] and "Calibration by least-squares" not in again["headings"]
    currents, order = ORDERS["general"]
    due = json.loads(calibrated(tmp_path, currents, order))
    shown = {key: [float(number) for number in u.split()] for key, _, u, _ in general["rows"][3]}
    u = due["results"][0]["standard_uncertainty"]
    assert shown == {key: [*np.ravel(u[key])] for key in ("k_deg_per_h_per_ma", "omega0_deg_per_h", "g_matrix_deg_per_h_per_g")}
    assert f"Decision for the gyro type: {due['verdict']['overall']}" in general["text"]

    for result, code in ((changed, "altered"), (withdrawn, "key_revoked"), (strange, "malformed")):
        assert "REFUSED" in result["text"] and code in [row[2] for row in result["rows"][0]]
        assert result["headings"] == ["Answer"] and result["frame"] is None
    for result, asked in zip(registered, [registers.good, *registers.asked], strict=True):
        due = asked.verdict_on_content()
        assert ("VALID SO FAR" if due["valid"] else "REFUSED") in result["text"], asked.name
        *_, (mark, *answer) = result["rows"][0]
        check = due["checks"][-1]
        assert mark == ("ok" if due["valid"] else "FAILED") and answer == [check["name"], check["code"], check["detail"]]
        used = due.get("register")
        words = f"register {used['sequence']} of {used['issued_at']}, SHA-256 {used['sha256']}, fresh until {used['fresh_until']}" if used else ""
        assert words in result["text"] and ("SHA-256" in result["text"]) == bool(used), asked.name
    assert no_time["headings"] == ["No answer"] and "expected a time" in no_time["text"]
    assert nothing["headings"] == ["No answer"] and "choose a passport" in nothing["text"]
    assert all(result["scripts"] == 0 for result in found["results"])
    assert [result["violations"] for result in found["results"]] == [[]] * len(cases)

    assert all(re.match(r"(file|blob|data|about):", request) for request in found["requests"]), found["requests"]
    assert found["fetched"] == ["refused"] * 3 and found["messages"] == []
    assert found["errors"] == []
    assert len(found["refusals"]) >= 3 and all("Content Security Policy" in words for words in found["refusals"])
    print(f"\none verification in Chromium: {found['times']:.1f} ms, median of 21")
    # Far above what was measured (docs/development/figures.md), for a machine that does other things.
    assert found["times"] < 100


def test_dropped_files_and_late_answers(tmp_path: Path) -> None:
    """What is shown belongs to the files that the page holds; a drop takes no file that it cannot tell, and no second one."""
    altered = tmp_path / "altered.yaml"
    altered.write_bytes(PASSPORT.read_bytes().replace(b"alpha_arcsec: 12.4", b"alpha_arcsec: 12.5", 1))
    # Names say nothing: a passport is a .csv, currents are a .yaml, and trusted keys a .json.
    renamed = [tmp_path / name for name in ("passport.csv", "currents.yaml", "signers.json", "order")]
    for path, source in zip(renamed, (PASSPORT, CURRENTS, SIGNERS)):
        path.write_bytes(source.read_bytes())
    renamed[3].write_text("{}")
    unknown, keys = tmp_path / "notes.yaml", PROJECT / "tests/keys/examples.pub"
    unknown.write_text("format: other/1\n")
    other = tmp_path / "signers"
    other.write_text("# examples\n" + SIGNERS.read_text().replace("examples@dtg-passport.test", "other@example.org"))
    good, fields = [str(PASSPORT), str(SIGNERS)], {"time": TIME, "serial": "0017"}
    files = {"passport": str(PASSPORT), "signers-file": str(SIGNERS)}
    cases = [
        {"files": files, "fields": fields, "drops": [good[:1], [str(altered)]]},
        {"files": files, "fields": fields, "drops": [[str(altered)], good[:1]]},
        {"files": {}, "fields": fields, "drops": [list(map(str, renamed))]},
        {"files": files, "fields": fields, "drops": [[str(PASSPORT), str(altered)]]},
        {"files": files, "fields": fields, "drops": [[str(altered), str(unknown)]]},
        {"files": files, "fields": fields, "drops": [[str(altered), str(keys)]]},
        {"files": files, "fields": fields, "drops": [[str(other)]]},
        {"files": {}, "fields": {**fields, "signers": SIGNERS.read_text()}, "drops": [[str(PASSPORT), str(other)]]},
        {"files": {}, "fields": {"time": TIME}, "drops": [good]},
    ]
    found = json.loads(node(str(PROJECT / "tests/bindings/page.cjs"), {"page": str(WEB / "verify.html"), "cases": cases}).stdout)
    late, last, by_content, two, strange, revoked, chosen, typed, waiting = found["results"]
    assert "REFUSED" in late["text"] and "VALID" not in late["text"] and late["chosen"]["passport"] == ["altered.yaml"]
    assert "VALID" in last["text"] and "REFUSED" not in last["text"] and last["chosen"]["passport"] == [PASSPORT.name]
    assert "VALID" in by_content["text"] and "Calibration by least-squares" in by_content["headings"]
    names = {"passport": "passport.csv", "currents": "currents.yaml", "signers-file": "signers.json", "order": "order"}
    assert all(by_content["chosen"][id] == [name] for id, name in names.items())
    # Nothing was taken, and no answer stands beside the refusal.
    refused = ((two, "a passport, as is"), (strange, "notes.yaml: neither a passport"), (revoked, "a list of revoked keys, which must be chosen"),
               (chosen, "already chosen above"), (typed, "already chosen above"))  # fmt: skip
    for result, words in refused:
        assert result["headings"] == ["No answer"] and words in result["text"] and "VALID" not in result["text"], result["text"]
        held = [] if result is typed else [PASSPORT.name]
        assert result["chosen"]["passport"] == held and result["chosen"]["revoked"] == []
    assert chosen["chosen"]["signers-file"] == [SIGNERS.name]
    # Without the serial number it waits, with the files in place.
    assert waiting["headings"] == ["Serial number"] and waiting["focus"] == "serial" and "VALID" not in waiting["text"]
    assert waiting["chosen"]["passport"] == [PASSPORT.name] and waiting["chosen"]["signers-file"] == [SIGNERS.name]
    assert found["errors"] == [] and all(result["violations"] == [] for result in found["results"])


def test_the_library_compiles_without_features() -> None:
    subprocess.run([PROJECT / "web/build", "check"], check=True, cwd=PROJECT)
