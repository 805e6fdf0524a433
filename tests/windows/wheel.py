"""What the wheel for Windows answers, as JSON: run by CPython for Windows in `test_corpus.py`."""

import json
import sys

import dtg_passport

asked = json.load(sys.stdin)
question = {"time": asked["time"]}
verdicts = []
for answer in dtg_passport.verify_many(asked["paths"], asked["signers"], **question):
    checks = [check._asdict() for check in answer.checks]
    verdicts.append([answer.valid, answer.id, answer.not_asked, answer.remarks, checks])
contents = [passport.content for passport in dtg_passport.load_many(asked["good"], asked["signers"], **question)]
result = dtg_passport.load(asked["passport"], asked["examples"], **question).calibrate(
    asked["currents"], laboratory=asked["laboratory"], gyro=asked["gyro"], budget=True
)
issued = dtg_passport.issue(**asked["issue"])
found = {"system": sys.platform, "verdicts": verdicts, "contents": contents, "result": result.document, "sha256": issued.sha256}
json.dump(found, sys.stdout)
