// js-yaml: `js_yaml.cjs js-yaml FILE` the present one, `js_yaml.cjs js-yaml-4 FILE` the one most programs still have.
"use strict";

const { readFileSync } = require("node:fs");
const tell = require("./walk.cjs");

const [name, file] = process.argv.slice(2);
tell(require(name).load(readFileSync(file, "utf8")));
