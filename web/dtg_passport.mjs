// Verifies passports of gyro test stands, in browsers and in Node.js. No file is read and no network is used.
//
//     import { readFile } from "node:fs/promises";
//     import { verify } from "./dtg_passport.mjs";
//     const signers = await readFile("allowed_signers", "utf8");
//     const { valid, id, checks } = await verify(await readFile("moscow-bmstu-1.yaml"), signers, { serial: "0017" });
//
// What the functions take, give and throw: dtg_passport.d.mts in the package for npm, and docs/browser.md.

const WASM = "@WASM@"; // base64 of the module, compressed with gzip

export const version = "@VERSION@";

let module;

async function compiled() {
    const compressed = Uint8Array.from(atob(WASM), (letter) => letter.charCodeAt(0));
    const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
}

function bytes(data) {
    if (typeof data === "string") return new TextEncoder().encode(data);
    if (data instanceof Uint8Array || data instanceof ArrayBuffer) return new Uint8Array(data);
    throw new TypeError(`found ${data?.constructor?.name ?? data}, expected text, a Uint8Array or an ArrayBuffer`);
}

function isPlain(value) {
    if (typeof value !== "object" || value === null) return false;
    const prototype = Object.getPrototypeOf(value);
    return prototype === null || Object.getPrototypeOf(prototype) === null; // of any window
}

/** Returns a question or an order as JSON, with dates and bytes as the module reads them. Nothing is lost silently. */
function json(what, asked) {
    if (typeof asked === "string") return asked;
    if (!isPlain(asked)) {
        const found = asked?.constructor?.name ?? String(asked);
        throw new TypeError(`${what}: found ${found}, expected a plain object such as { serial: "0017" }`);
    }
    return JSON.stringify(asked, function (key, value) {
        const given = this[key]; // before toJSON
        if (given instanceof Date) return `${given.toISOString().slice(0, 19)}Z`;
        if (given instanceof Uint8Array || given instanceof ArrayBuffer) return Array.from(bytes(given));
        const found = typeof given === "number" ? String(given) : typeof given;
        const lost = ["undefined", "function", "symbol", "bigint", "NaN", "Infinity", "-Infinity"].includes(found);
        if (lost || given !== value) {
            throw new TypeError(`${what}: ${key}: found ${found}; leave the key out if it is not asked`);
        }
        return value;
    });
}

/** Calls a function of a new instance of the module; returns its text. */
async function call(name, passport, allowedSigners, question = {}, currents = "", order = {}) {
    module ??= compiled();
    const { exports } = await WebAssembly.instantiate(await module, {});
    const asked = [json("question", question), currents, json("order", order)];
    const parts = [passport, allowedSigners, ...asked].map(bytes);
    const places = parts.map((part) => exports.room(part.length));
    const inputs = exports.room(4 * 2 * parts.length);
    // Only now, because allocating can move the memory.
    parts.forEach((part, index) => new Uint8Array(exports.memory.buffer, places[index], part.length).set(part));
    const slices = new Uint32Array(exports.memory.buffer, inputs, 2 * parts.length);
    slices.set(parts.flatMap((part, index) => [places[index], part.length]));
    const found = exports[name](inputs, Math.floor(Date.now() / 1000));
    const [start, length] = new Uint32Array(exports.memory.buffer, found, 2);
    return new TextDecoder().decode(new Uint8Array(exports.memory.buffer, start, length));
}

/** Reads JSON of the module; throws if the input could not be used. */
function parsed(text) {
    const found = JSON.parse(text);
    if (found.error) throw new Error(found.error.message, { cause: found.error });
    return found;
}

/** Calls a function that verifies first; throws if a check failed, or the result of a calibration is not valid. */
async function accepted(...inputs) {
    const text = await call(...inputs);
    const found = text.startsWith("{") ? parsed(text) : text;
    const { valid, id, checks, consistent, mistake, remarks } = found;
    if (consistent === false || mistake !== undefined) throw new Error(`not valid: ${remarks.join("\n")}`, { cause: found });
    if (valid !== false || !Array.isArray(checks)) return found;
    const failed = checks.filter((check) => check.passed === false);
    const words = failed.map(({ name, code, detail }) => `${name} (${code}): ${detail}`).join("\n");
    throw new Error(`refused: ${words}`, { cause: { valid, id, checks } });
}

export async function verify(passport, allowedSigners, question) {
    const { file, ...verdict } = parsed(await call("verify", passport, allowedSigners, question));
    return verdict;
}

export async function content(passport, allowedSigners, question) {
    return accepted("content", passport, allowedSigners, question);
}

export async function print(passport, allowedSigners, question) {
    return accepted("print", passport, allowedSigners, question);
}

export async function calibrate(passport, allowedSigners, currents, question, order) {
    return accepted("calibrated", passport, allowedSigners, question, currents, order);
}
