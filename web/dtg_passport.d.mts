/** Bytes of a file; of allowed_signers, currents and revocation lists also the text. */
export type Bytes = Uint8Array | ArrayBuffer;

/** What to ask of a passport; every key may be absent, but not `undefined`. */
export interface Question {
    time?: string | Date;
    serial?: string;
    /** Latitude and longitude, degrees. */
    at?: [number, number];
    issuer?: string;
    revoked?: (string | Bytes)[];
}

/** How to calibrate; every key may be absent, but not `undefined`. */
export interface Order {
    method?: "least-squares" | "analytic" | "iterative";
    model?: "paper" | "general";
    /** Fit the anisoelastic coefficient too. */
    anisoelasticity?: boolean;
    drift?: boolean;
    exclude?: { i: number; j: number; visit: number; cycle?: number; why: string }[];
    /** The keys of a file dtg-laboratory/1. */
    laboratory?: object;
    /** The keys of a file dtg-gyro/1. */
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

export interface Verdict {
    valid: boolean;
    id: string | null;
    checks: { name: string; passed: boolean | null; code: string; detail: string }[];
    remarks?: string[];
}

/** The JSON of `calibrate`, described in docs/commands.md. */
export interface Calibration {
    consistent: boolean;
    mistake?: object;
    remarks?: string[];
    verdict?: { overall: "pass" | "fail" | "undecided"; [key: string]: unknown };
    results: { [key: string]: any }[];
    [key: string]: unknown;
}

export function verify(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<Verdict>;
export function content(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<{ [key: string]: any }>;
export function print(passport: Bytes, allowedSigners: string | Bytes, question?: Question): Promise<string>;
export function calibrate(
    passport: Bytes, allowedSigners: string | Bytes, currents: string | Bytes, question?: Question, order?: Order | string,
): Promise<Calibration>;
