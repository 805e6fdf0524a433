"""Checks a CycloneDX bill of materials: by the standard's schema, and against what cargo says the program is made of."""

import json
import sys

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

bill_path, metadata_path = sys.argv[1:]
text = open(bill_path, encoding="utf-8").read()
error = JsonStrictValidator(SchemaVersion.V1_5).validate_str(text)
if error is not None:
    sys.exit(f"{bill_path} is no CycloneDX 1.5: {error}")

bill = json.loads(text)
named = {(component["name"], component["version"]): component for component in bill["components"]}

# What the program is built from: its dependencies and theirs, for any platform, those of tests aside.
metadata = json.load(open(metadata_path, encoding="utf-8"))
packages = {package["id"]: package for package in metadata["packages"]}
nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
todo, found = [metadata["resolve"]["root"]], set()
while todo:
    node = nodes[todo.pop()]
    for dependency in node["deps"]:
        if any(kind["kind"] != "dev" for kind in dependency["dep_kinds"]) and dependency["pkg"] not in found:
            found.add(dependency["pkg"])
            todo.append(dependency["pkg"])
expected = {(packages[name]["name"], packages[name]["version"]) for name in found}

if expected != set(named):
    sys.exit(f"missing: {sorted(expected - set(named))}\nnot used: {sorted(set(named) - expected)}")
# The project's own crate of the trials comes from no registry, which would state its hash.
own = {(package["name"], package["version"]) for package in packages.values() if package["source"] is None}
bare = [
    name
    for name, component in named.items()
    if not component.get("licenses") or not (component.get("hashes") or name in own)
]
if bare:
    sys.exit(f"without a licence or a hash: {sorted(bare)}")
print(f"{bill_path}: valid CycloneDX 1.5, {len(named)} components, each with a licence, all from a registry with SHA-256")
