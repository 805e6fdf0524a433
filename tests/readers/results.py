"""Checks JSON results against their schemas, in which no key may be unsaid: results.py SCHEMAS FOLDER. The files of the
folder are named <verb>.*; refusals are left aside. Prints the number of checked results of each verb, as JSON."""
import collections, json, pathlib, sys
from jsonschema import Draft202012Validator


def closed(schema):
    """Returns the schema with no further keys than those that it names."""
    if isinstance(schema, list):
        return [closed(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    inner = {key: closed(value) for key, value in schema.items()}
    return {**inner, "additionalProperties": False} if isinstance(schema.get("properties"), dict) and "required" in schema else inner


def values(text):
    """Returns one JSON text, or one for each line."""
    try:
        return [json.loads(text)] if text.strip() else []
    except json.JSONDecodeError:
        return [json.loads(line) for line in text.splitlines()]


def is_refusal(value):
    return isinstance(value, dict) and "error" in value


schemas = json.load(open(sys.argv[1], encoding="utf-8"))
counts = collections.Counter()
for verb, schema in schemas.items():
    Draft202012Validator.check_schema(schema)
    validators = [Draft202012Validator(closed(schema))]
    if verb in ("verify", "register"):  # with ndjson, elements are lines
        element = schema["items"] if verb == "verify" else schema["properties"]["stands"]["items"]
        validators.append(Draft202012Validator(closed(element)))
    for file in sorted(pathlib.Path(sys.argv[2]).glob(f"{verb}.*")):
        for value in values(file.read_text(encoding="utf-8")):
            if is_refusal(value):
                continue
            errors = [min((list(validator.iter_errors(value)) for validator in validators), key=len)]
            if errors[0]:
                sys.exit(f"{file.name}: {errors[0][0].json_path}: {errors[0][0].message[:500]}")
            counts[verb] += 1
print(json.dumps(counts))
