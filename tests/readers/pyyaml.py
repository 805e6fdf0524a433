"""PyYAML: `pyyaml.py pure FILE` reads with Python alone, `pyyaml.py c FILE` with libyaml."""

import sys

import yaml

from walk import walk

LOADERS = {"pure": yaml.SafeLoader, "c": yaml.CSafeLoader}

with open(sys.argv[2], encoding="utf-8", newline="") as file:
    walk(yaml.load(file.read(), Loader=LOADERS[sys.argv[1]]), sys.stdout)
