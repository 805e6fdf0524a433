"""ruamel.yaml in Python alone: `ruamel_yaml.py safe FILE` plain values, `ruamel_yaml.py rt FILE` its default, the round trip."""

import sys

from ruamel.yaml import YAML

from walk import walk

with open(sys.argv[2], encoding="utf-8", newline="") as file:
    walk(YAML(typ=sys.argv[1], pure=True).load(file.read()), sys.stdout)
