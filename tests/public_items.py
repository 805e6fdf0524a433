#!/usr/bin/env python3
"""Counts what users of the library can see, from the pages of `cargo doc --no-deps`: modules, types, traits, functions,
methods and constants; no fields, variants or implementations of traits. `--list` names them. It fails above the limit."""

import re
import sys
from collections import Counter
from pathlib import Path

LIMIT = 350

pages = Path(__file__).parent.parent / "target/doc/dtg_passport"
items = []
for page in sorted(pages.rglob("*.html")):
    text = page.read_text()
    if 'http-equiv="refresh"' in text:  # the old address of an item that is shown elsewhere
        continue
    module = "::".join(page.relative_to(pages).parent.parts)
    if page.name == "index.html":
        items.append(("module", module or "dtg_passport"))
    elif found := re.fullmatch(r"(struct|enum|trait|fn|constant|static|type|macro)\.(\w+)\.html", page.name):
        kind, name = found.groups()
        items.append((kind, f"{module}::{name}"))
        own = re.split(r'id="(?:trait|synthetic|blanket)-implementations"', text)[0]
        parts = r'<section id="(method|tymethod|associatedconstant)\.(\w+)" class="(?:method|associatedconstant)'
        items += [(part, f"{module}::{name}::{of}") for part, of in re.findall(parts, own) if kind in ("struct", "enum", "trait")]
if "--list" in sys.argv:
    for kind, name in sorted(items, key=lambda item: item[1]):
        print(kind, name)
print(f"public items: {len(items)}", dict(Counter(kind for kind, _ in items)))
sys.exit(not 0 < len(items) <= LIMIT)
