/** Version of this module. */
export const version: string;

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
    /** A file dtg-laboratory/1: its text, YAML or JSON, or an object; default: the paper's meter. */
    laboratory?: object | string;
    /** A file dtg-gyro/1: its text, YAML or JSON, or an object; default: no verdict. */
    gyro?: object | string;
    gyro_serial?: string;
    operator?: string;
    /** Day of the readings, YYYY-MM-DD. */
    date?: string;
    /** Temperature during the readings, °C. */
    temperature_c?: number;
    /** Earlier results of the same gyro. */
    previous?: Calibration[];
    /** Add the budget of the uncertainty to the result. */
    budget?: boolean;
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

export type CheckName =
    | "grammar" | "signature" | "schema" | "signer" | "revocation" | "recomputed" | "in_force" | "issuer" | "stand"
    | "place" | "register";

/** Results of checks; further ones may follow. */
export type Code =
    | "ok" | "not_run" | "not_asked" | "unreadable" | "malformed" | "unsupported_key" | "altered" | "wrong_namespace"
    | "bad_content" | "newer_format" | "unknown_key" | "wrong_principal" | "key_not_yet_valid" | "key_expired"
    | "key_revoked" | "wrong_number" | "not_yet_valid" | "expired" | "wrong_issuer" | "wrong_stand" | "wrong_place"
    | "withdrawn" | "superseded" | "moved" | "not_listed" | "register_stale" | "register_older"
    | "register_contradicted" | "register_unknown"
    | (string & {});

export interface Verdict {
    valid: boolean;
    id: string | null;
    /** Names of the checks that the question did not request. */
    not_asked: CheckName[];
    /** What else to show. */
    remarks: string[];
    /** Register that was asked and accepted; absent otherwise. */
    register?: Register;
    checks: { name: CheckName; passed: boolean | null; code: Code; detail: string }[];
}

/** Content of a passport: the keys of the file but `signature`, described in docs/keys.md, and the SHA-256 of the file. */
export interface Content {
    sha256: string;
    passport: { id: string; revision: number; issued_at: string; issuer: string; valid_until?: string; [key: string]: unknown };
    stand: { model: string; serial: string; [key: string]: unknown };
    site: { id: string; [key: string]: unknown };
    earth: { latitude_deg: number; gravity_m_per_s2: number; [key: string]: unknown };
    positions: {
        i: number; j: number; theta_deg: number; phi_deg: number;
        alpha_arcsec: number; beta_arcsec: number; gamma_arcsec: number; [key: string]: unknown;
    }[];
    vectors: { i: number; j: number; specific_force_g: [number, number]; omega_deg_per_h: [number, number]; [key: string]: unknown }[];
    /** Absent without the paper's eight positions. */
    matrices?: { [key: string]: [[number, number], [number, number]] };
    [key: string]: unknown;
}

/** Values of a method, or their standard uncertainties; a key without a value is absent. */
export interface Values {
    k_deg_per_h_per_ma: [[number, number], [number, number]];
    omega0_deg_per_h: [number, number];
    omega_n_deg_per_h_per_g?: [[number, number], [number, number]];
    omega_g_deg_per_h_per_g?: number;
    omega_k_deg_per_h_per_g?: number;
    g_matrix_deg_per_h_per_g?: [[number, number, number], [number, number, number]];
    drift_deg_per_h_per_h?: [number, number];
    anisoelasticity_deg_per_h_per_g2?: number;
}

export interface Result extends Values {
    method: "least-squares" | "analytic" | "iterative";
    model: "paper" | "general";
    standard_uncertainty: Values;
    chi_square: { value: number; degrees_of_freedom: number; probability?: number; uncertainty_degrees_of_freedom?: number };
    residuals_deg_per_h?: { i: number; j: number; x: number; y: number; u_x?: number; u_y?: number }[];
    [key: string]: unknown;
}

/** A parameter of a gyro; lists and the covariance have this order. */
export type Parameter = "k_x" | "k_xy" | "k_yx" | "k_y" | "omega_0x" | "omega_0y" | "omega_g" | "omega_k";

export type Decision = "pass" | "fail" | "undecided";

/** The JSON of `calibrate`, described in docs/commands.md; `remarks` has what else to show. */
export interface Calibration {
    passport_id: string;
    passport_verified: boolean;
    register?: Register;
    gravity_m_per_s2: number;
    /** Meter whose uncertainty is assumed, because the order has no laboratory. */
    assumed_meter?: string;
    /** `false` only in the `cause` of an Error. */
    consistent: boolean;
    /** Only in the `cause` of an Error. */
    mistake?: object;
    /** Those without a key are unlimited. */
    degrees_of_freedom?: { [parameter: string]: number };
    /** Covariance of the eight parameters; null for omega_g and omega_k in the general model. */
    covariance: (number | null)[][];
    results: [Result, ...Result[]];
    not_stated?: string[];
    /** Errors that were not looked for, because the order has no gyro type. */
    not_tested?: string[];
    causes?: { kind: string; words: string; [key: string]: unknown }[];
    remarks?: string[];
    verdict?: { overall: Decision; parameters: { parameter: Parameter; [key: string]: unknown }[]; [key: string]: unknown };
    change?: { overall: Decision; [key: string]: unknown };
    budget?: { [key: string]: unknown };
    [key: string]: unknown;
}

// Unusable input throws an Error with `cause: {code, message, problems}`; a refusal, one with `cause: {valid, id, checks}`; a
// calibration whose result is not valid, one with the Calibration as `cause`.

/** Verifies a passport with the keys of an OpenSSH allowed_signers file. */
export function verify(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<Verdict>;
/** Verifies a passport and returns its content. Throws if a check failed. */
export function content(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<Content>;
/** Verifies a passport and returns it in printed form, one HTML document. Throws if the passport is not authentic. */
export function print(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<string>;
/** Verifies a passport and calibrates a gyro from currents as CSV. Throws if refused, or if the result is not valid. */
export function calibrate(
    passport: Bytes, allowedSigners: string | Bytes, currents: string | Bytes, question?: Question, order?: Order | string,
): Promise<Calibration>;
