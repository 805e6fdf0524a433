/** Bytes of a file; of allowed_signers, currents, lists of revoked keys and registers also the text. */
export type Bytes = Uint8Array | ArrayBuffer;

/**
 * What to ask of a passport; every key may be absent. It is a plain object without other keys, and no value may be
 * `undefined` or `null`: a check that was silently left out would look like one that passed.
 */
export interface Question {
    /** RFC 3339 in whole seconds, a UTC date, or a Date; default: now. */
    time?: string | Date;
    serial?: string;
    /** Latitude and longitude, degrees. */
    at?: [number, number];
    issuer?: string;
    /** Lists of revoked keys: OpenSSH KRLs or public keys. */
    revoked?: (string | Bytes)[];
    /** Register of the stand: whether the passport counts. */
    register?: string | Bytes;
}

/** How to calibrate; every key may be absent, but not `undefined` or `null`. */
export interface Order {
    method?: "least-squares" | "analytic" | "iterative";
    model?: "paper" | "general";
    /** Fit the anisoelastic coefficient too. */
    anisoelasticity?: boolean;
    drift?: boolean;
    exclude?: { i: number; j: number; visit: number; cycle?: number; why: string }[];
    /** The keys of a file dtg-laboratory/1; default: the paper's meter. */
    laboratory?: object;
    /** The keys of a file dtg-gyro/1; default: no verdict. */
    gyro?: object;
    gyro_serial?: string;
    operator?: string;
    /** Day of the readings, YYYY-MM-DD. */
    date?: string;
    /** Temperature during the readings, °C. */
    temperature_c?: number;
    /** Earlier results of the same gyro. */
    previous?: Calibration[];
}

/** Register of a stand, by which a passport was checked. */
export interface Register {
    sequence: number;
    /** SHA-256 of the whole file. */
    sha256: string;
    issued_at: string;
    /** Last UTC day on which the register counts as fresh; null if it states none. */
    fresh_until: string | null;
}

export interface Verdict {
    valid: boolean;
    id: string | null;
    /** Names of the checks that the question did not request. */
    not_asked: string[];
    /** What else to show. */
    remarks: string[];
    /** Register that was asked and accepted; absent otherwise. */
    register?: Register;
    checks: { name: string; passed: boolean | null; code: string; detail: string }[];
}

/**
 * The JSON of `calibrate`, described in docs/commands.md. Use the parameters only if `consistent` is true and `mistake` is
 * absent; `remarks` has what else to show.
 */
export interface Calibration {
    consistent: boolean;
    mistake?: object;
    /** Errors that were not looked for, because the order has no gyro type. */
    not_tested?: string[];
    register?: Register;
    remarks?: string[];
    verdict?: { overall: "pass" | "fail" | "undecided"; [key: string]: unknown };
    results: { [key: string]: any }[];
    [key: string]: unknown;
}

// Unusable input throws an Error with `cause: {code, message, problems}`; a refusal, one with `cause: {valid, id, checks}`.

/** Verifies a passport with the keys of an OpenSSH allowed_signers file. */
export function verify(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<Verdict>;
/** Verifies a passport and returns its content: the keys of the file but `signature`. Throws if a check failed. */
export function content(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<{ [key: string]: any }>;
/** Verifies a passport and returns it in printed form, one HTML document. Throws if the passport is not authentic. */
export function print(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<string>;
/** Verifies a passport and calibrates a gyro from currents as CSV. Throws if refused. */
export function calibrate(
    passport: Bytes, allowedSigners: string | Bytes, currents: string | Bytes, question?: Question, order?: Order | string,
): Promise<Calibration>;
