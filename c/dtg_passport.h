/* C interface of dtg-passport: verify a passport, read its numbers, calibrate a gyro.
 *
 * Written by cbindgen from c/src/lib.rs; do not edit. Text is UTF-8 and ends with a zero byte. Numbers are the signed
 * ones, to the last bit. A function can be called from several threads at once, also with the same passport.
 */

#ifndef DTG_PASSPORT_H
#define DTG_PASSPORT_H

#include <stddef.h>
#include <stdint.h>

/*
 The call succeeded.
 */
#define DTG_OK 0

/*
 A check of the passport failed, or the readings do not give a result.
 */
#define DTG_REFUSED 1

/*
 An argument or a file cannot be used.
 */
#define DTG_UNUSABLE 2

/*
 Passport that passed every check; it does not change.
 */
typedef struct dtg_passport dtg_passport;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/*
 Reads a passport and verifies it.

 `question_json` is NULL or JSON, `{"time": "2026-11-20T00:00:00Z", "serial": "0017", "at": [55.7660, 37.6850],
 "issuer": "…", "revoked": ["content of a list of revoked keys", …], "register": "content of the stand's register"}`;
 every key may be absent, none null. `time` is by default now, and may also be a UTC date; `at` is latitude and longitude in degrees;
 `register` and an element of `revoked` may also be a list of bytes.

 Returns DTG_OK and the passport in `*out`, to be freed with dtg_free; DTG_REFUSED if a check failed; DTG_UNUSABLE if
 an argument, the question or a file cannot be used. `*out` is NULL unless DTG_OK is returned.

 `report_json`, unless NULL, receives a text to be freed with dtg_string_free: `{"file", "valid", "id", "not_asked": [name
 of a check, …], "remarks": [sentence, …], "register": {"sequence", "sha256", "issued_at", "fresh_until"}, "checks":
 [{"name", "passed", "code", "detail"}, …]}`, with `register` only if one was asked and accepted; or after DTG_UNUSABLE
 `{"error": {"code", "message", "problems": [{"file", "line", "column", "message"}, …]}}`.
 */
int dtg_load(const char *path,
             const char *allowed_signers_path,
             const char *question_json,
             dtg_passport **out,
             char **report_json);

/*
 Verifies a passport in memory, as dtg_load does; `passport` and `allowed_signers` are the contents of the two files.

 For callers whose paths are not UTF-8, such as LabVIEW's, and for passports that are not in files.
 */
int dtg_loads(const char *passport,
              const char *allowed_signers,
              const char *question_json,
              dtg_passport **out,
              char **report_json);

/*
 Copies a matrix row by row into `out`.

 `key` is one of "delta", "b_deg_per_h", "c_deg_per_h_per_g", "n1", "n2", "n2_inverse", "omega1_deg_per_h",
 "omega2_deg_per_h". Returns DTG_OK; DTG_REFUSED if the passport has no matrices, because its stand lacks one of the
 paper's eight positions; DTG_UNUSABLE if the key is unknown or an argument is NULL.
 */
int dtg_matrix(const dtg_passport *passport,
               const char *key,
               double *out);

/*
 Copies numbers of the passport row by row into `out`, which has room for `length` of them; NaN where nothing is stated.

 `name` is "gravity" (m/s^2), the key of a matrix as in dtg_matrix, or with a row for each position "ij", "angles" (nominal
 theta and phi, degrees), "n" (g), "omega" (deg/h), "deviations" or "u_deviations" (arcsec; alpha, beta, gamma). Returns
 DTG_OK; DTG_UNUSABLE if the name is unknown, if the numbers are not `length`, or if an argument is NULL.
 */
int dtg_array(const dtg_passport *passport,
              const char *name,
              double *out,
              size_t length);

/*
 Returns the content of the passport as JSON, the keys of the file without `signature`, to be freed with dtg_string_free; NULL
 if `passport` is NULL.
 */
char *dtg_content(const dtg_passport *passport);

/*
 Returns the SHA-256 of the whole file in lower-case hexadecimal, which lives as long as the passport; NULL if `passport` is
 NULL.
 */
const char *dtg_sha256(const dtg_passport *passport);

/*
 Returns the version of this library.
 */
const char *dtg_version(void);

/*
 Returns the number of positions, or 0 if `passport` is NULL.
 */
size_t dtg_positions(const dtg_passport *passport);

/*
 Copies position `k`, counted from 0: its indices i and j, the specific force along x and y in g, and the Earth rate
 along x and y in degrees per hour.

 Returns DTG_OK, or DTG_UNUSABLE if there is no such position or an argument is NULL.
 */
int dtg_position(const dtg_passport *passport,
                 size_t k,
                 uint32_t *ij,
                 double *n,
                 double *omega);

/*
 Calibrates a gyro.

 `currents_csv` is the content of a CSV file with the columns i, j, jx_ma, jy_ma, and if present cycle, visit, time_s.
 `order_json` is NULL or JSON, `{"method": "least-squares", "model": "paper", "anisoelasticity": false, "drift": false,
 "exclude": [{"i": 2, "j": 4, "visit": 1, "cycle": 3, "why": "door opened"}], "laboratory": {…}, "gyro": {…},
 "gyro_serial": "4711", "operator": "A. Ivanova", "date": "2026-11-20", "temperature_c": 21.5, "previous": [{…}], "budget":
 false}`; every key may be absent. `method` may also be "analytic" or "iterative", `model` "general". `laboratory` and `gyro`
 are the files dtg-laboratory/1 and dtg-gyro/1: their text, YAML or JSON, or an object. Without a laboratory the
 uncertainties are those of the meter that `assumed_meter` in the result names. Without a gyro type there is no verdict, and
 most errors such as currents in another unit are not recognised: `not_tested` in the result lists them. `previous` are
 earlier results of the same gyro. `budget` in the result is the budget of the uncertainty.

 `result_json`, unless NULL, receives a text to be freed with dtg_string_free: the JSON of the command `calibrate`,
 or `{"error": …}` as from dtg_load. Returns DTG_OK; DTG_REFUSED if the readings do not give a result, or with the result
 if it is not valid: the readings do not fit the stand, or an error explains the parameters; DTG_UNUSABLE if an argument, the
 order or a current cannot be used.
 */
int dtg_calibrate_csv(const dtg_passport *passport,
                      const char *currents_csv,
                      const char *order_json,
                      char **result_json);

/*
 Calibrates a gyro as dtg_calibrate_csv does without a laboratory: `assumed_meter` in the result names the meter.

 `currents` has `rows` rows of four numbers: i, j, and the currents along x and y in mA. `method` is NULL or
 "least-squares", "analytic", "iterative".
 */
int dtg_calibrate(const dtg_passport *passport,
                  const double *currents,
                  size_t rows,
                  const char *method,
                  char **result_json);

/*
 Copies the eight parameters of a result of dtg_calibrate_csv or dtg_calibrate and their standard uncertainties: K_x,
 K_xy, K_yx, K_y in degrees per hour and mA, omega_0x and omega_0y in degrees per hour, omega_g and omega_k in degrees per
 hour and g; these two are NaN in the general model.

 Returns DTG_OK if they may be used; DTG_REFUSED, with the same numbers, if the readings do not fit the stand, or if a
 mistake such as currents in another unit explains the parameters: `remarks` in the result says which; DTG_UNUSABLE if
 `result_json` is no such result or an argument is NULL.
 */
int dtg_parameters(const char *result_json,
                   double *value,
                   double *u);

/*
 Copies the covariance of the parameters of a result, 8 rows of 8, in the order and units of dtg_parameters; NaN for omega_g and
 omega_k in the general model. Returns as dtg_parameters does.
 */
int dtg_covariance(const char *result_json,
                   double *out);

/*
 Frees a passport; NULL is allowed.
 */
void dtg_free(dtg_passport *passport);

/*
 Frees a text that this library returned; NULL is allowed.
 */
void dtg_string_free(char *text);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* DTG_PASSPORT_H */
