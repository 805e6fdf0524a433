//! The compiled part of the Python module `dtg_passport`: converts types and calls `dtg_passport::interface`.

use dtg_passport::folder::FileError;
use dtg_passport::gyro::{GyroParameters, GyroType};
use dtg_passport::interface::{self, Failed, Order};
use dtg_passport::jiff::Timestamp;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::{Content as Passport, SelfCheck, content_from_anyone};
use dtg_passport::signing::{KeyFileError, signer};
use dtg_passport::uncertainty::Trials;
use pyo3::exceptions::{PyIsADirectoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Name and content of a file.
type File = (String, Vec<u8>);

/// Name, result, code and detail of a check.
type Check = (&'static str, Option<bool>, &'static str, String);

/// Id and SHA-256 of a passport, every check, and the content if every check passed.
type Answer = (Option<String>, String, Vec<Check>, Option<Content>);

/// Gyro type and laboratory.
type Files = (Option<File>, Option<File>);

fn failed(error: Failed) -> PyErr {
    match error.code {
        "unwritable" | "exists" => PyOSError::new_err(error.message),
        _ => PyValueError::new_err(error.message),
    }
}

/// Returns a file as the library takes it.
fn given((name, bytes): &File) -> (&str, &[u8]) {
    (name, bytes)
}

fn answered(found: &interface::Answer) -> Answer {
    let verification = &found.verification;
    let checks = verification.checks().iter();
    let checks = checks.map(|check| (check.name.as_str(), check.passed(), check.code.as_str(), check.detail.clone()));
    let verified_as_of = Some(found.time);
    let content = verification.passport().map(|of| Content { passport: of.content().clone(), verified_as_of });
    (verification.id_from_anyone().map(str::to_owned), found.sha256.clone(), checks.collect(), content)
}

/// Returns numbers as bytes, float64 each.
fn float64(py: Python<'_>, numbers: impl IntoIterator<Item = f64>) -> Bound<'_, PyBytes> {
    PyBytes::new(py, &numbers.into_iter().flat_map(f64::to_ne_bytes).collect::<Vec<_>>())
}

/// Reads an order of a calibration, with the files of its gyro type and its laboratory.
fn ordered(order: &str, (gyro, laboratory): Files) -> PyResult<Order> {
    let read = || {
        let mut order: Order = order.parse()?;
        if let Some((name, bytes)) = gyro {
            order.gyro = Some(GyroType::from_yaml(&name, &bytes)?);
        }
        if let Some((name, bytes)) = laboratory {
            order.laboratory = Laboratory::from_yaml(&name, &bytes)?;
        }
        Ok(order)
    };
    read().map_err(failed)
}

/// Converts an error of a file to the subclass of OSError that Python users expect.
fn os_error(py: Python, error: &FileError) -> PyErr {
    match error {
        FileError::Read(path, system) => {
            let words = |number: i32| py.import("os")?.call_method1("strerror", (number,))?.extract::<String>();
            match system.raw_os_error().and_then(|number| Some((number, words(number).ok()?))) {
                Some((number, words)) => PyOSError::new_err((number, words, path.as_os_str().to_owned())),
                None => PyOSError::new_err(error.to_string()),
            }
        }
        FileError::Folder(_) => PyIsADirectoryError::new_err(error.to_string()),
        _ => PyOSError::new_err(error.to_string()),
    }
}

/// Trusted keys and the question to verify passports for.
#[pyclass(frozen)]
struct Enquiry(interface::Enquiry);

#[pymethods]
impl Enquiry {
    #[new]
    fn new(py: Python, signers: File, revoked: Vec<File>, question: &str, register: Option<PathBuf>) -> PyResult<Self> {
        let name = (signers.0.as_str(), signers.1.as_slice());
        let enquiry = interface::Enquiry::new(name, &revoked, question, Timestamp::now()).map_err(failed)?;
        match register {
            Some(folder) => {
                py.detach(|| enquiry.with_register(&folder)).map(Self).map_err(|error| os_error(py, &error))
            }
            None => Ok(Self(enquiry)),
        }
    }

    fn remarks(&self) -> Vec<String> {
        self.0.remarks.clone()
    }

    fn verify(&self, py: Python, file: &str, data: &[u8]) -> Answer {
        py.detach(|| answered(&self.0.verify(file, data)))
    }

    /// Verifies files. The list has one element for each file: its answer, or an OSError if it cannot be read.
    fn verify_files<'py>(
        &self,
        py: Python<'py>,
        paths: Vec<PathBuf>,
        threads: usize,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let answers = py.detach(|| self.0.verify_files(&paths, threads));
        let answers = answers.into_iter().map(|answer| match answer {
            Ok(answer) => Ok(answered(&answer).into_pyobject(py)?.into_any()),
            Err(error) => Ok(os_error(py, &error).into_value(py).into_bound(py).into_any()),
        });
        answers.collect()
    }
}

/// Content of a passport.
#[pyclass(frozen)]
struct Content {
    passport: Passport,
    verified_as_of: Option<Timestamp>,
}

#[pymethods]
impl Content {
    /// Parses a passport without verifying it.
    #[staticmethod]
    fn unverified(file: &str, data: &[u8]) -> PyResult<Self> {
        let passport = content_from_anyone(file, data).map_err(|error| failed(error.into()))?;
        Ok(Self { passport, verified_as_of: None })
    }

    #[getter]
    fn id(&self) -> &str {
        &self.passport.passport.id
    }

    #[getter]
    fn gravity(&self) -> f64 {
        self.passport.earth.gravity_m_per_s2
    }

    fn json(&self, py: Python) -> String {
        py.detach(|| interface::content_json(&self.passport))
    }

    /// Returns an array as bytes, float64 row by row; empty for a self-check that the passport does not have.
    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyBytes>> {
        const NOT_STATED: f64 = f64::NAN;
        let Passport { positions, vectors, matrices, self_check, .. } = &self.passport;
        let matrix = |of: fn(&_) -> [[f64; 2]; 2]| matrices.as_ref().map_or([[NOT_STATED; 2]; 2], of).concat();
        let each = |of: fn(&_) -> Vec<f64>| positions.iter().flat_map(of).collect();
        let vectors = |of: fn(&_) -> [f64; 2]| {
            let of_one = |i, j| vectors.iter().find(|at| (at.i, at.j) == (i, j)).map_or([NOT_STATED; 2], of);
            positions.iter().flat_map(|at| of_one(at.i, at.j)).collect()
        };
        let numbers: Vec<f64> = match name {
            "delta" => matrix(|of| of.delta),
            "B" => matrix(|of| of.b_deg_per_h),
            "C" => matrix(|of| of.c_deg_per_h_per_g),
            "n2_inverse" => matrix(|of| of.n2_inverse),
            "ij" => each(|at| vec![at.i.into(), at.j.into()]),
            "angles" => each(|at| vec![at.theta_deg, at.phi_deg]),
            "n" => vectors(|at| at.specific_force_g),
            "omega" => vectors(|at| at.omega_deg_per_h),
            "deviations" => each(|at| vec![at.alpha_arcsec, at.beta_arcsec, at.gamma_arcsec]),
            "u_deviations" => each(|at| {
                [at.u_alpha_arcsec, at.u_beta_arcsec, at.u_gamma_arcsec].map(|u| u.unwrap_or(NOT_STATED)).into()
            }),
            "self_check" => {
                let currents = self_check.iter().flat_map(|check| &check.currents);
                currents.flat_map(|at| [at.i.into(), at.j.into(), at.jx_ma, at.jy_ma]).collect()
            }
            _ => return Err(PyValueError::new_err(format!("no array {name}"))),
        };
        Ok(float64(py, numbers))
    }

    /// Returns the JSON of `calibrate`, and the covariance (8, 8) as bytes.
    fn calibrate<'py>(
        &self,
        py: Python<'py>,
        currents: File,
        order: &str,
        files: Files,
    ) -> PyResult<(String, Bound<'py, PyBytes>)> {
        let (passport, order) = (&self.passport, ordered(order, files)?);
        let found = py.detach(|| interface::calibrate(passport, self.verified_as_of, given(&currents), &order));
        let found = found.map_err(failed)?;
        Ok((found.json, float64(py, found.covariance.into_iter().flatten())))
    }

    /// Returns the JSON of a Monte Carlo. Between the waves of trials `progress` is called, and signals are handled; an
    /// exception of either ends the run.
    #[expect(clippy::too_many_arguments)]
    fn monte_carlo(
        &self,
        py: Python,
        currents: File,
        order: &str,
        files: Files,
        trials: Option<u64>,
        seed: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<String> {
        let order = ordered(order, files)?;
        let (cancel, raised) = (AtomicBool::new(false), Mutex::new(None));
        let tell = |done: u64, due: u64| {
            let told = Python::attach(|py| {
                py.check_signals()?;
                progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (done, due)).map(drop))
            });
            if let Err(error) = told {
                cancel.store(true, Ordering::Relaxed);
                *raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            }
        };
        let mut run = Trials { trials, cancel: Some(&cancel), progress: Some(&tell), ..Trials::adaptive(seed) };
        run.threads = threads.unwrap_or(run.threads);
        let found =
            py.detach(|| interface::monte_carlo(&self.passport, given(&currents), &order, &run)).map_err(failed);
        raised.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(found, Err)
    }

    /// Returns the relative error of each of the eight parameters found from the currents of the self-check, and the
    /// limit.
    fn self_check_errors(&self, found: [f64; 8]) -> PyResult<([f64; 8], f64)> {
        let check = self.passport.self_check.as_ref();
        let check = check.ok_or_else(|| PyValueError::new_err("this passport has no self-check"))?;
        Ok((check.errors(&GyroParameters::from_vector(&found)), SelfCheck::LIMIT))
    }
}

/// Issues a passport; `accuracy` is a gyro type and a laboratory. Returns its id, path and SHA-256, whether it is new, and
/// remarks.
#[pyfunction]
#[expect(clippy::too_many_arguments)]
fn issue(
    py: Python,
    stand: File,
    site: File,
    order: &str,
    accuracy: Option<Files>,
    key: PathBuf,
    passphrase: Option<String>,
    signers: Option<File>,
    out: PathBuf,
) -> PyResult<(String, PathBuf, String, bool, Vec<String>)> {
    let accuracy = accuracy.as_ref().map(|(gyro, laboratory)| [gyro, laboratory].map(|file| file.as_ref().map(given)));
    let ask = |_: &std::path::Path| {
        let words = || "give its passphrase, or set DTG_PASSPORT_PASSPHRASE".to_owned();
        passphrase.clone().map(Into::into).ok_or_else(words)
    };
    let issued = py.detach(|| {
        let signer = signer(&key, &ask).map_err(Err)?;
        let (files, signers) = ([given(&stand), given(&site)], signers.as_ref().map(given));
        interface::issue(files, order, accuracy, &*signer, signers, &out, Timestamp::now()).map_err(Ok)
    });
    let (issued, remarks) = issued.map_err(|error| match error {
        Ok(error) => failed(error),
        Err(KeyFileError::File(error)) => os_error(py, &error),
        Err(error) => PyValueError::new_err(error.to_string()),
    })?;
    Ok((issued.id, issued.path, issued.sha256, issued.new, remarks))
}

/// Returns the JSON of `plan`.
#[pyfunction]
fn plan(py: Python, site: File, stand: Option<File>, files: Files, question: &str) -> PyResult<String> {
    let [stand, gyro, laboratory] = [&stand, &files.0, &files.1].map(|file| file.as_ref().map(given));
    py.detach(|| interface::plan(given(&site), stand, gyro, laboratory, question)).map_err(failed)
}

#[pymodule]
mod _dtg_passport {
    #[pymodule_export]
    #[expect(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::{Content, Enquiry, issue, plan};
}
