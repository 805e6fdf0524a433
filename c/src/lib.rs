//! C interface of dtg-passport. It only converts types and calls `dtg_passport::interface`; no panic crosses it.
//!
//! The comments of the functions are those of the header `dtg_passport.h`. A function that takes a pointer is unsafe as a
//! whole, by the one duty of its caller: to pass NULL, or what the header states.

#![allow(unsafe_op_in_unsafe_fn)]

use passports::interface::{Enquiry, Failed, array, calibrate_json, content_json, covariance, matrix, parameters};
use passports::jiff::Timestamp;
use passports::passport::{Content, RegisterUsed};
use passports::text::LARGEST_DOCUMENT_BYTES;
use passports::trust::LARGEST_TRUST_FILE_BYTES;
use std::borrow::Cow;
use std::ffi::{CStr, CString, c_char, c_double, c_int};
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::ptr;

/// The call succeeded.
pub const DTG_OK: c_int = 0;
/// A check of the passport failed, or the readings do not give a result.
pub const DTG_REFUSED: c_int = 1;
/// An argument or a file cannot be used.
pub const DTG_UNUSABLE: c_int = 2;

/// Passport that passed every check; it does not change.
#[allow(non_camel_case_types)]
pub struct dtg_passport {
    content: Content,
    sha256: CString,
    verified_as_of: Timestamp,
    register: Option<RegisterUsed>,
}

/// Reads a passport and verifies it.
///
/// `question_json` is NULL or JSON, `{"time": "2026-11-20T00:00:00Z", "serial": "0017", "at": [55.7660, 37.6850],
/// "issuer": "…", "revoked": ["content of a list of revoked keys", …], "register": "content of the stand's register"}`;
/// every key may be absent, none null. `time` is by default now, and may also be a UTC date; `at` is latitude and longitude in degrees;
/// `register` and an element of `revoked` may also be a list of bytes.
///
/// Returns DTG_OK and the passport in `*out`, to be freed with dtg_free; DTG_REFUSED if a check failed; DTG_UNUSABLE if
/// an argument, the question or a file cannot be used. `*out` is NULL unless DTG_OK is returned.
///
/// `report_json`, unless NULL, receives a text to be freed with dtg_string_free: `{"file", "valid", "id", "not_asked": [name
/// of a check, …], "remarks": [sentence, …], "register": {"sequence", "sha256", "issued_at", "fresh_until"}, "checks":
/// [{"name", "passed", "code", "detail"}, …]}`, with `register` only if one was asked and accepted; or after DTG_UNUSABLE
/// `{"error": {"code", "message", "problems": [{"file", "line", "column", "message"}, …]}}`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_load(
    path: *const c_char,
    allowed_signers_path: *const c_char,
    question_json: *const c_char,
    out: *mut *mut dtg_passport,
    report_json: *mut *mut c_char,
) -> c_int {
    loaded(question_json, out, report_json, || {
        let (path, signers) = (file_name(path, "path")?, file_name(allowed_signers_path, "allowed_signers_path")?);
        Ok([read(signers, LARGEST_TRUST_FILE_BYTES)?, read(path, LARGEST_DOCUMENT_BYTES)?])
    })
}

/// Verifies a passport in memory, as dtg_load does; `passport` and `allowed_signers` are the contents of the two files.
///
/// For callers whose paths are not UTF-8, such as LabVIEW's, and for passports that are not in files.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_loads(
    passport: *const c_char,
    allowed_signers: *const c_char,
    question_json: *const c_char,
    out: *mut *mut dtg_passport,
    report_json: *mut *mut c_char,
) -> c_int {
    loaded(question_json, out, report_json, || {
        let given = |name, text| bytes(text, name).map(|bytes| (Cow::from(name), Cow::from(bytes)));
        Ok([given("allowed_signers", allowed_signers)?, given("passport", passport)?])
    })
}

/// Verifies a passport; `files` returns the names and contents of allowed_signers and of the passport.
unsafe fn loaded<'a>(
    question_json: *const c_char,
    out: *mut *mut dtg_passport,
    report_json: *mut *mut c_char,
    files: impl FnOnce() -> Result<[(Cow<'a, str>, Cow<'a, [u8]>); 2], Failed>,
) -> c_int {
    give(out, ptr::null_mut());
    guarded(report_json, || {
        if out.is_null() {
            return Err(Failed::unusable("out is NULL"));
        }
        let question = if question_json.is_null() { "{}" } else { text(question_json, "question_json")? };
        let [(signers_name, signers), (name, passport)] = files()?;
        let enquiry = Enquiry::new((&signers_name, &signers), &[], question, Timestamp::now())?;
        let answer = enquiry.verify(&name, &passport);
        let Some(passport) = answer.verification.passport() else { return Ok((DTG_REFUSED, answer.to_json())) };
        let register = answer.verification.register().cloned();
        let (content, sha256) = (passport.content().clone(), CString::new(passport.sha256()).unwrap_or_default());
        let passport = dtg_passport { content, sha256, verified_as_of: answer.time, register };
        give(out, Box::into_raw(Box::new(passport)));
        Ok((DTG_OK, answer.to_json()))
    })
}

/// Copies a matrix row by row into `out`.
///
/// `key` is one of "delta", "b_deg_per_h", "c_deg_per_h_per_g", "n1", "n2", "n2_inverse", "omega1_deg_per_h",
/// "omega2_deg_per_h". Returns DTG_OK; DTG_REFUSED if the passport has no matrices, because its stand lacks one of the
/// paper's eight positions; DTG_UNUSABLE if the key is unknown or an argument is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_matrix(passport: *const dtg_passport, key: *const c_char, out: *mut c_double) -> c_int {
    guarded(ptr::null_mut(), || {
        let (key, passport, out) = (text(key, "key")?, given(passport, "passport")?, room(out, 4, "out")?);
        let rows = matrix(&passport.content, key).ok_or_else(|| Failed::unusable("unknown key of a matrix"))?;
        if passport.content.matrices.is_none() {
            return Ok((DTG_REFUSED, String::new()));
        }
        out.copy_from_slice(rows.as_flattened());
        Ok((DTG_OK, String::new()))
    })
}

/// Copies numbers of the passport row by row into `out`, which has room for `length` of them; NaN where nothing is stated.
///
/// `name` is "gravity" (m/s^2), the key of a matrix as in dtg_matrix, or with a row for each position "ij", "angles" (nominal
/// theta and phi, degrees), "n" (g), "omega" (deg/h), "deviations" or "u_deviations" (arcsec; alpha, beta, gamma). Returns
/// DTG_OK; DTG_UNUSABLE if the name is unknown, if the numbers are not `length`, or if an argument is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_array(
    passport: *const dtg_passport,
    name: *const c_char,
    out: *mut c_double,
    length: usize,
) -> c_int {
    guarded(ptr::null_mut(), || {
        let (name, passport) = (text(name, "name")?, given(passport, "passport")?);
        let numbers = array(&passport.content, name).filter(|numbers| numbers.len() == length);
        let numbers = numbers.ok_or_else(|| Failed::unusable("unknown name, or another length"))?;
        room(out, length, "out")?.copy_from_slice(&numbers);
        Ok((DTG_OK, String::new()))
    })
}

/// Returns the content of the passport as JSON, the keys of the file without `signature`, to be freed with dtg_string_free; NULL
/// if `passport` is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_content(passport: *const dtg_passport) -> *mut c_char {
    let mut json = ptr::null_mut();
    let code = guarded(&raw mut json, || Ok((DTG_OK, content_json(&given(passport, "passport")?.content))));
    if code == DTG_OK {
        return json;
    }
    dtg_string_free(json);
    ptr::null_mut()
}

/// Returns the SHA-256 of the whole file in lower-case hexadecimal, which lives as long as the passport; NULL if `passport` is
/// NULL.
#[unsafe(no_mangle)]
pub extern "C" fn dtg_sha256(passport: Option<&dtg_passport>) -> *const c_char {
    passport.map_or(ptr::null(), |passport| passport.sha256.as_ptr())
}

/// Returns the version of this library.
#[unsafe(no_mangle)]
pub extern "C" fn dtg_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// Returns the number of positions, or 0 if `passport` is NULL.
#[unsafe(no_mangle)]
pub extern "C" fn dtg_positions(passport: Option<&dtg_passport>) -> usize {
    passport.map_or(0, |passport| passport.content.vectors.len())
}

/// Copies position `k`, counted from 0: its indices i and j, the specific force along x and y in g, and the Earth rate
/// along x and y in degrees per hour.
///
/// Returns DTG_OK, or DTG_UNUSABLE if there is no such position or an argument is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_position(
    passport: *const dtg_passport,
    k: usize,
    ij: *mut u32,
    n: *mut c_double,
    omega: *mut c_double,
) -> c_int {
    guarded(ptr::null_mut(), || {
        let (ij, n, omega) = (room(ij, 2, "ij")?, room(n, 2, "n")?, room(omega, 2, "omega")?);
        let position = given(passport, "passport")?.content.vectors.get(k);
        let position = position.ok_or_else(|| Failed::unusable("k is not below dtg_positions"))?;
        ij.copy_from_slice(&[position.i, position.j]);
        n.copy_from_slice(&position.specific_force_g);
        omega.copy_from_slice(&position.omega_deg_per_h);
        Ok((DTG_OK, String::new()))
    })
}

/// Calibrates a gyro.
///
/// `currents_csv` is the content of a CSV file with the columns i, j, jx_ma, jy_ma, and if present cycle, visit, time_s.
/// `order_json` is NULL or JSON, `{"method": "least-squares", "model": "paper", "anisoelasticity": false, "drift": false,
/// "exclude": [{"i": 2, "j": 4, "visit": 1, "cycle": 3, "why": "door opened"}], "laboratory": {…}, "gyro": {…},
/// "gyro_serial": "4711", "operator": "A. Ivanova", "date": "2026-11-20", "temperature_c": 21.5, "previous": [{…}], "budget":
/// false}`; every key may be absent. `method` may also be "analytic" or "iterative", `model` "general". `laboratory` and `gyro`
/// are the files dtg-laboratory/1 and dtg-gyro/1: their text, YAML or JSON, or an object. Without a laboratory the
/// uncertainties are those of the meter that `assumed_meter` in the result names. Without a gyro type there is no verdict, and
/// most errors such as currents in another unit are not recognised: `not_tested` in the result lists them. `previous` are
/// earlier results of the same gyro. `budget` in the result is the budget of the uncertainty.
///
/// `result_json`, unless NULL, receives a text to be freed with dtg_string_free: the JSON of the command `calibrate`,
/// or `{"error": …}` as from dtg_load. Returns DTG_OK; DTG_REFUSED if the readings do not give a result, or with the result
/// if it is not valid: the readings do not fit the stand, or an error explains the parameters; DTG_UNUSABLE if an argument, the
/// order or a current cannot be used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_calibrate_csv(
    passport: *const dtg_passport,
    currents_csv: *const c_char,
    order_json: *const c_char,
    result_json: *mut *mut c_char,
) -> c_int {
    guarded(result_json, || {
        let order = if order_json.is_null() { "{}" } else { text(order_json, "order_json")? };
        calibrated(given(passport, "passport")?, text(currents_csv, "currents_csv")?, order)
    })
}

/// Calibrates a gyro as dtg_calibrate_csv does without a laboratory: `assumed_meter` in the result names the meter.
///
/// `currents` has `rows` rows of four numbers: i, j, and the currents along x and y in mA. `method` is NULL or
/// "least-squares", "analytic", "iterative".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_calibrate(
    passport: *const dtg_passport,
    currents: *const c_double,
    rows: usize,
    method: *const c_char,
    result_json: *mut *mut c_char,
) -> c_int {
    guarded(result_json, || {
        let passport = given(passport, "passport")?;
        given(currents, "currents")?;
        let method = if method.is_null() { "least-squares" } else { text(method, "method")? };
        let numbers = rows.checked_mul(4).filter(|count| *count <= isize::MAX as usize / size_of::<c_double>());
        let numbers = numbers.ok_or_else(|| Failed::unusable("rows is too large"))?;
        let (rows, _) = std::slice::from_raw_parts(currents, numbers).as_chunks::<4>();
        let rows = rows.iter().map(|[i, j, jx_ma, jy_ma]| format!("{i},{j},{jx_ma},{jy_ma}\n"));
        let csv = "i,j,jx_ma,jy_ma\n".to_owned() + &rows.collect::<String>();
        calibrated(passport, &csv, &format!(r#"{{"method": {method:?}}}"#))
    })
}

/// Copies the eight parameters of a result of dtg_calibrate_csv or dtg_calibrate and their standard uncertainties: K_x,
/// K_xy, K_yx, K_y in degrees per hour and mA, omega_0x and omega_0y in degrees per hour, omega_g and omega_k in degrees per
/// hour and g; these two are NaN in the general model.
///
/// Returns DTG_OK if they may be used; DTG_REFUSED, with the same numbers, if the readings do not fit the stand, or if a
/// mistake such as currents in another unit explains the parameters: `remarks` in the result says which; DTG_UNUSABLE if
/// `result_json` is no such result or an argument is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_parameters(result_json: *const c_char, value: *mut c_double, u: *mut c_double) -> c_int {
    guarded(ptr::null_mut(), || {
        let (value, u) = (room(value, 8, "value")?, room(u, 8, "u")?);
        let (found, uncertainty, usable) = parameters(text(result_json, "result_json")?)?;
        value.copy_from_slice(&found);
        u.copy_from_slice(&uncertainty);
        Ok((if usable { DTG_OK } else { DTG_REFUSED }, String::new()))
    })
}

/// Copies the covariance of the parameters of a result, 8 rows of 8, in the order and units of dtg_parameters; NaN for omega_g and
/// omega_k in the general model. Returns as dtg_parameters does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_covariance(result_json: *const c_char, out: *mut c_double) -> c_int {
    guarded(ptr::null_mut(), || {
        let out = room(out, 64, "out")?;
        let (found, usable) = covariance(text(result_json, "result_json")?)?;
        out.copy_from_slice(found.as_flattened());
        Ok((if usable { DTG_OK } else { DTG_REFUSED }, String::new()))
    })
}

/// Frees a passport; NULL is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn dtg_free(passport: Option<Box<dtg_passport>>) {
    drop(passport);
}

/// Frees a text that this library returned; NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dtg_string_free(text: *mut c_char) {
    if !text.is_null() {
        drop(CString::from_raw(text));
    }
}

fn calibrated(passport: &dtg_passport, csv: &str, order: &str) -> Result<(c_int, String), Failed> {
    let verified = Some((passport.verified_as_of, passport.register.as_ref()));
    Ok((DTG_OK, calibrate_json(&passport.content, verified, ("currents", csv.as_bytes()), &order.parse()?)?))
}

/// Runs `work`, hands out its text, and returns its code. A panic becomes DTG_UNUSABLE.
unsafe fn guarded(json: *mut *mut c_char, work: impl FnOnce() -> Result<(c_int, String), Failed>) -> c_int {
    let done = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(Failed::unusable("internal error")));
    let (code, text) = done
        .unwrap_or_else(|failed| (if failed.code == "refused" { DTG_REFUSED } else { DTG_UNUSABLE }, failed.to_json()));
    // A text that the caller did not ask for would never be freed.
    if !json.is_null() {
        // JSON has no zero byte.
        give(json, CString::new(text).map_or(ptr::null_mut(), CString::into_raw));
    }
    code
}

/// Stores a pointer, unless the caller did not ask for it.
unsafe fn give<T>(place: *mut *mut T, value: *mut T) {
    if let Some(place) = place.as_mut() {
        *place = value;
    }
}

/// Returns what a pointer points to; refuses NULL.
unsafe fn given<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Failed> {
    pointer.as_ref().ok_or_else(|| Failed::unusable(format!("{name} is NULL")))
}

/// Returns the room that the caller gives for `length` numbers.
unsafe fn room<'a, T>(pointer: *mut T, length: usize, name: &str) -> Result<&'a mut [T], Failed> {
    given(pointer, name)?;
    Ok(std::slice::from_raw_parts_mut(pointer, length))
}

/// Returns a text, which ends with a zero byte.
unsafe fn bytes<'a>(pointer: *const c_char, name: &str) -> Result<&'a [u8], Failed> {
    Ok(CStr::from_ptr(given(pointer, name)?).to_bytes())
}

unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, Failed> {
    std::str::from_utf8(bytes(pointer, name)?).map_err(|_| Failed::unusable(format!("{name} is not UTF-8")))
}

/// Returns a path; outside Unix it must be UTF-8.
unsafe fn file_name<'a>(pointer: *const c_char, name: &str) -> Result<&'a Path, Failed> {
    #[cfg(unix)]
    let name = <std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(bytes(pointer, name)?);
    #[cfg(not(unix))]
    let name = text(pointer, name)?;
    Ok(Path::new(name))
}

/// Reads a file; of a larger one than `limit`, one byte more, which is enough to refuse it. A pipe is refused, because
/// reading it might never end.
fn read(path: &Path, limit: usize) -> Result<(Cow<'_, str>, Cow<'static, [u8]>), Failed> {
    let name = path.to_string_lossy();
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound if name.is_empty() => Failed::unusable("the path is empty"),
        ErrorKind::NotFound => Failed::unreadable(&name, "no such file"),
        ErrorKind::PermissionDenied => Failed::unreadable(&name, "permission denied"),
        _ => Failed::unreadable(&name, format!("cannot be read: {error}")),
    };
    let kind = fs::metadata(path).map_err(failed)?;
    if !kind.is_file() {
        let found = if kind.is_dir() { "a folder" } else { "a pipe, a device or a socket" };
        return Err(Failed::unreadable(&name, format!("found {found}, expected a file")));
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(failed)?.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(failed)?;
    Ok((name, bytes.into()))
}
