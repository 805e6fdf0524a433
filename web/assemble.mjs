// Puts the WebAssembly module into dtg_passport.mjs, and that into verify.html: assemble.mjs MODULE.wasm FOLDER
import { createHash } from "node:crypto";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [wasm, folder] = process.argv.slice(2);
const here = (name) => readFileSync(new URL(name, import.meta.url), "utf8");
const digest = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const compressed = gzipSync(readFileSync(wasm), { level: 9 }).toString("base64");
const [, version] = here("Cargo.toml").match(/^version = "(.*)"$/m);
const module = here("dtg_passport.mjs").replace("@WASM@", () => compressed).replace("@VERSION@", version);
writeFileSync(`${folder}/dtg_passport.mjs`, module);
copyFileSync(new URL("dtg_passport.d.mts", import.meta.url), `${folder}/dtg_passport.d.mts`);

// In the page the functions are in the same script as their callers.
const script = `${module.replaceAll(/^export /gm, "")}\n${here("verify.js")}`;
const page = here("verify.html").replace("@SCRIPT@", () => script).replace("@SCRIPT_DIGEST@", digest(script));
writeFileSync(`${folder}/verify.html`, page);
