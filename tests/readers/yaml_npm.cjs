// The npm package yaml: `yaml_npm.cjs 1.1 FILE` and `yaml_npm.cjs 1.2 FILE` read by that version of YAML.
"use strict";

const { readFileSync } = require("node:fs");
const { parse } = require("yaml");
const tell = require("./walk.cjs");

const [version, file] = process.argv.slice(2);
// As a Map, because an object would turn a key that was read as a boolean back into a string.
tell(parse(readFileSync(file, "utf8"), { version, mapAsMap: true }));
