// Tells what a reader of YAML made of a document: one JSON array a line, the same from every reader (see walk.py).
// JavaScript has one type of number: whole ones too go as the eight bytes of a binary64.
"use strict";

function bytes(number) {
  const buffer = Buffer.alloc(8);
  buffer.writeDoubleBE(number);
  return buffer.toString("hex");
}

function walk(value, say) {
  const text = (string) => Buffer.from(string, "utf8").toString("hex");
  const map = (entries) => {
    say("map");
    for (const [key, item] of entries) {
      if (typeof key === "string") say("key", text(key));
      else say("other", `a key of type ${typeof key}`);
      walk(item, say);
    }
    say("end");
  };
  if (value === null) say("null");
  else if (typeof value === "boolean") say("bool", value);
  else if (typeof value === "number") say("number", bytes(value));
  else if (typeof value === "string") say("text", text(value));
  else if (Array.isArray(value)) {
    say("list");
    for (const item of value) walk(item, say);
    say("end");
  } else if (value instanceof Map) map(value);
  else if (typeof value === "object" && [Object.prototype, null].includes(Object.getPrototypeOf(value))) {
    map(Object.entries(value));
  } else say("other", value?.constructor?.name ?? typeof value);
}

module.exports = (value) => {
  const lines = [];
  walk(value, (...words) => lines.push(JSON.stringify(words)));
  process.stdout.write(lines.join("\n") + "\n");
};
