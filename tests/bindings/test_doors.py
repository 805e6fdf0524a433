"""The same question of the same passport has the same answer in every language: verdict, checks, `not_asked`, remarks."""

from __future__ import annotations

import ctypes
import json
import os
import random
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import dtg_passport
import pytest
from conftest import PROGRAM, PROJECT, Corpus, Registers, octave

# The figures of docs/development/figures.md: `DTG_QUESTIONS=300 tests/bindings/run -s test_doors.py`. A browser and Octave, which
# starts the program for each passport, take a hundred times as long as the libraries: else they get fewer questions.
QUESTIONS, PASSPORTS = int(os.environ.get("DTG_QUESTIONS", "60")), 200
OF_SLOW_DOORS = int(os.environ.get("DTG_QUESTIONS", "4"))
KEYS = ("valid", "id", "not_asked", "remarks", "checks")


class Case(NamedTuple):
    """A question, in a folder of its own with the files that it names."""

    folder: Path
    question: dict
    """Time, serial, at, issuer."""
    files: list[str]
    """`revoked[0]` and `register`, as far as they are asked."""
    answers: list[dict]
    """Answers of the program on each passport."""


class Asked:
    def __init__(self, folder: Path, corpus: Corpus, registers: Registers) -> None:
        draw = random.Random(57)
        self.signers = folder / "allowed_signers"
        # A key of another type is skipped with a remark.
        subprocess.run(["ssh-keygen", "-q", "-t", "ecdsa", "-N", "", "-f", folder / "other"], check=True)
        other = b"other@example.org " + (folder / "other.pub").read_bytes()
        self.signers.write_bytes(corpus.signers.read_bytes() + registers.signers.read_bytes() + other)
        others = [asked.passport for asked in registers.asked]
        chosen = [*dict.fromkeys(others), *draw.sample(corpus.good, 110), *draw.sample(corpus.altered, 100)][:PASSPORTS]
        assert len(chosen) == PASSPORTS
        self.passports = []
        for number, path in enumerate(chosen):
            (folder / f"{number}.yaml").write_bytes(path.read_bytes())
            self.passports.append(f"../{number}.yaml")
        keys = [line.split()[-2:] for signers in (corpus.signers, registers.signers) for line in signers.read_text().splitlines() if line[:1] != "#"]
        lists = [b"# none yet\n", *(" ".join(key).encode() + b"\n" for key in keys), (PROJECT / "tests/keys/examples.pub").read_bytes()]
        contents = [asked.register.read_bytes() for asked in registers.asked]
        choices = {
            "time": ["2026-11-20", "2026-11-20T09:30:00Z", "2024-01-01", "2026-11-10T00:00:00Z", "2031-01-01", registers.good.time],
            "serial": ["0017", "0203", "0018", "17", "0017 "],
            "at": [[55.766, 37.5], [55.766, 37.685], [-80.0, 37.5], [39.9, 116.4], [0, 0], [90, 0]],
            "issuer": ["factory@example.org", "Factory@example.org", "examples@dtg-passport.test"],
        }
        self.cases = []
        for number in range(QUESTIONS):
            question = {key: draw.choice(some) for key, some in choices.items() if draw.random() < (0.8 if key == "time" else 0.4)}
            here, files = folder / f"question-{number}", []
            here.mkdir()
            for name, some in (("revoked[0]", lists), ("register", contents)):
                if draw.random() < 0.5:
                    (here / name).write_bytes(draw.choice(some))
                    files.append(name)
            self.cases.append(Case(here, question, files, self.program(here, question, files)))

    def program(self, here: Path, question: dict, files: list[str]) -> list[dict]:
        options = [f"--{key}={value if isinstance(value, str) else ','.join(map(str, value))}" for key, value in question.items()]
        options += [f"--{name.partition('[')[0]}={name}" for name in files]
        command = [PROGRAM, "verify", "--format=json", f"--trust={self.signers}", *options, "--", *self.passports]
        done = subprocess.run(command, cwd=here, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        answers = json.loads(done.stdout)
        assert [answer["file"] for answer in answers] == self.passports
        return answers


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory, corpus: Corpus, registers: Registers) -> Asked:
    return Asked(tmp_path_factory.mktemp("doors"), corpus, registers)


def python(asked: Asked, case: Case) -> Iterator[dict]:
    files = {name.partition("[")[0]: name for name in case.files}
    for answer in dtg_passport.verify_many(asked.passports, asked.signers, **case.question, **files):
        checks = [check._asdict() for check in answer.checks]
        yield {**answer._asdict(), "not_asked": list(answer.not_asked), "remarks": list(answer.remarks), "checks": checks}


def contents(case: Case) -> dict:
    """Return the question with the contents of its files."""
    files = {name.partition("[")[0]: list(Path(name).read_bytes()) for name in case.files}
    return case.question | files | ({"revoked": [files["revoked"]]} if "revoked" in files else {})


def c(asked: Asked, case: Case) -> Iterator[dict]:
    library = ctypes.CDLL(str(PROJECT / "target/debug/libdtg_passport.so"))
    question, signers = json.dumps(contents(case)).encode(), str(asked.signers).encode()
    for path in asked.passports:
        passport, report = ctypes.c_void_p(), ctypes.c_char_p()
        code = library.dtg_load(path.encode(), signers, question, ctypes.byref(passport), ctypes.byref(report))
        answer = json.loads(report.value)
        assert code == (0 if answer["valid"] else 1), answer
        yield answer
        library.dtg_string_free(report)
        library.dtg_free(passport)


NODE = """
    import { readFileSync } from "node:fs";
    import { verify } from "%s";
    const { signers, passports, question } = JSON.parse(readFileSync(0, "utf8"));
    for (const path of passports) console.log(JSON.stringify(await verify(readFileSync(path), readFileSync(signers), question)));
"""


def node(asked: Asked, case: Case) -> Iterator[dict]:
    question = contents(case)
    given = json.dumps({"signers": str(asked.signers), "passports": asked.passports, "question": question})
    command = ["node", "--input-type=module", "--eval", NODE % (PROJECT / "target/web/dtg_passport.mjs")]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=True)
    yield from map(json.loads, done.stdout.splitlines())


PAGE = """
    const fs = require("fs");
    const { chromium } = require("playwright-core");
    (async () => {
        const { page: address, signers, passports, question, register, revoked } = JSON.parse(fs.readFileSync(0, "utf8"));
        const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
        const page = await browser.newPage();
        await page.goto(address);
        const { at: [latitude, longitude] = ["", ""], ...fields } = question;
        for (const [id, value] of Object.entries({ latitude, longitude, ...fields })) await page.fill(`#${id}`, String(value));
        for (const [id, file] of Object.entries({ "signers-file": signers, register, revoked })) if (file) await page.setInputFiles(`#${id}`, file);
        const answers = await page.evaluate(async (passports) => {
            const result = document.querySelector("#result");
            const answers = [];
            for (const text of passports) {
                const held = new DataTransfer();
                held.items.add(new File([Uint8Array.from(text, (c) => c.charCodeAt(0))], "passport"));
                document.querySelector("#passport").files = held.files;
                result.replaceChildren();
                const shown = new Promise((done) => {
                    const observer = new MutationObserver(() => { if (result.querySelector("h2")) { observer.disconnect(); done(); } });
                    observer.observe(result, { childList: true });
                });
                document.querySelector("form").requestSubmit();
                await shown;
                const of = (selector) => [...result.querySelectorAll(selector)].map((one) => one.textContent);
                const [answer, id] = of(":scope > p");
                const rows = [...result.querySelector("table").tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent));
                answers.push({ answer, id, remarks: of(":scope > strong"), rows });
            }
            return answers;
        }, passports.map((path) => fs.readFileSync(path, "latin1")));
        await browser.close();
        console.log(answers.map((answer) => JSON.stringify(answer)).join("\\n"));
    })();
"""


def page(asked: Asked, case: Case) -> Iterator[dict]:
    address = (PROJECT / "target/web/verify.html").as_uri()
    files = {name.partition("[")[0]: str(case.folder / name) for name in case.files}
    given = {"page": address, "signers": str(asked.signers), "passports": asked.passports, "question": case.question} | files
    environment = {**os.environ, "NODE_PATH": str(PROJECT / "target/test-tools/page/node_modules")}
    done = subprocess.run(["node", "--eval", PAGE], input=json.dumps(given), capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    for answer in map(json.loads, done.stdout.splitlines()):
        checks = [{"name": name, "passed": {"ok": True, "FAILED": False}.get(mark), "code": code, "detail": detail}
                  for mark, name, code, detail in answer["rows"]]  # fmt: skip
        identity = None if answer["id"] == "(id not verified)" else answer["id"]
        yield {"valid": answer["answer"].startswith("VALID"), "so_far": answer["answer"] == "VALID SO FAR",
               "id": identity, "remarks": answer["remarks"], "checks": checks}  # fmt: skip


def matlab(asked: Asked, case: Case) -> Iterator[dict]:
    """Answers of docs/matlab in Octave."""
    options = {key: value for key, value in case.question.items()}
    options |= {name.partition("[")[0]: name for name in case.files}
    (case.folder / "asked.json").write_text(json.dumps({"passports": asked.passports, "options": options}))
    script = case.folder / "asked.m"
    script.write_text(f"""
        addpath('{PROJECT}/docs/matlab');
        warning('off', 'dtg:remark');
        asked = jsondecode(fileread('asked.json'));
        options = [fieldnames(asked.options)'; cellfun(@(value) reshape(value, 1, []), struct2cell(asked.options)', 'UniformOutput', false)];
        for k = 1:numel(asked.passports)
            answer = struct();
            try
                p = dtg_load(asked.passports{{k}}, '{asked.signers}', options{{:}});
                answer.id = p.passport.id;
                answer.not_asked = p.not_asked;
                answer.remarks = p.remarks;
                answer.checks = p.checks;
            catch e
                answer.identifier = e.identifier;
                answer.message = e.message;
            end
            printf('%s\\n', jsonencode(answer));
        end
    """)
    yield from map(json.loads, octave(script).splitlines())


def not_asked(case: Case) -> set[str]:
    """Return what was not asked. Expected: the contract; it does not depend on the passport."""
    unasked = {name for name, key in (("revocation", "revoked[0]"), ("register", "register")) if key not in case.files}
    return unasked | {name for name, key in (("issuer", "issuer"), ("stand", "serial"), ("place", "at")) if key not in case.question}


@pytest.mark.parametrize("door", [python, c, node, page, matlab])
def test_every_door_gives_the_answer_of_the_program(asked: Asked, door: object, monkeypatch: pytest.MonkeyPatch) -> None:
    codes = set()
    cases = asked.cases[:OF_SLOW_DOORS] if door in (page, matlab) else asked.cases
    for case in cases:
        if door is page and case.question.get("serial", "").endswith(" "):
            continue  # a field of a form is read without blanks at its ends
        monkeypatch.chdir(case.folder)
        unasked = not_asked(case)
        for path, due, found in zip(asked.passports, case.answers, door(asked, case), strict=True):  # type: ignore[operator]
            if door in (node, page):  # they do not get the name
                due = json.loads(json.dumps(due).replace(path, "passport"))
            keys = KEYS
            if door is page:
                keys = ("valid", "id", "remarks", "checks")
                assert found["so_far"] == (due["valid"] and not unasked.isdisjoint({"stand", "place", "register"}))
            elif door is matlab:
                keys = ("id", "not_asked", "remarks", "checks") if due["valid"] else ("identifier", "message")
                said = [check["detail"] for check in due["checks"] if check["passed"] is False] + due["remarks"]
                due = due | {"identifier": "dtg:refused", "message": f"exit code 1: {'; '.join(said)}"}
                # Octave writes null as an empty list.
                found |= {"checks": [{**check, "passed": None if check["passed"] == [] else check["passed"]} for check in found.get("checks", [])]}
            assert {key: found[key] for key in keys} == {key: due[key] for key in keys}, (case.question, case.files, path)
            codes.update(check["code"] for check in due["checks"])
        assert all(set(answer["not_asked"]) == unasked for answer in case.answers), (case.question, case.files)
    assert len(codes) >= (15 if len(cases) >= 60 else 12), codes
    print(f"\n{door.__name__}: {len(cases)} questions x {len(asked.passports)} passports, codes {sorted(codes)}")  # type: ignore[attr-defined]
