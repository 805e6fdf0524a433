// Drives target/web/dtg_passport.mjs for tests/bindings/test_web.py: reads {folder, signers, time, paths} on standard
// input, prints a line of JSON for each path: the verdict, and the content of good ones.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { module, signers, time, paths } = JSON.parse(readFileSync(0, "utf8"));
const { verify, content } = await import(pathToFileURL(module));
const trusted = readFileSync(signers, "utf8");
let spent = 0;
for (const path of paths) {
    const passport = readFileSync(path);
    const begin = performance.now();
    const verdict = await verify(passport, trusted, { time });
    spent += performance.now() - begin;
    const read = verdict.valid ? await content(passport, trusted, { time }) : await content(passport, trusted, { time }).then(
        () => "not refused", (error) => error.cause.valid);
    console.log(JSON.stringify({ verdict, content: read }));
}
console.error(`${(spent / paths.length).toFixed(2)} ms for each verification`);
