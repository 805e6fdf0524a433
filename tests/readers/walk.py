"""Tells what a reader of YAML made of a document: one JSON array a line, the same from every reader.

A number goes as the hexadecimal form of its eight bytes, a text as that of its UTF-8, so that no second
conversion between decimal and binary can hide or make a difference.
"""

import json
import struct


def walk(value, out):
    def say(*words):
        out.write(json.dumps(words) + "\n")

    if value is None:
        say("null")
    elif isinstance(value, bool):  # before int, of which bool is a kind
        say("bool", value)
    elif isinstance(value, int):
        say("integer", str(int(value)))
    elif isinstance(value, float):
        say("number", struct.pack(">d", value).hex())
    elif isinstance(value, str):
        say("text", value.encode("utf-8").hex())
    elif isinstance(value, list):
        say("list")
        for item in value:
            walk(item, out)
        say("end")
    elif isinstance(value, dict):
        say("map")
        for key, item in value.items():
            if isinstance(key, str):
                say("key", key.encode("utf-8").hex())
            else:
                say("other", f"a key of type {type(key).__name__}")
            walk(item, out)
        say("end")
    else:
        say("other", type(value).__name__)
