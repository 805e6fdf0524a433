//! The compiled part of the Python module `dtg_passport`: converts types and calls `dtg_passport::interface`.

use dtg_passport::folder::FileError;
use dtg_passport::gyro::{GyroParameters, GyroType};
use dtg_passport::interface::{self, Failed, Order};
use dtg_passport::jiff::Timestamp;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::{Content as Passport, RegisterUsed, SelfCheck};
use dtg_passport::signing::{KeyFileError, signer};
use dtg_passport::uncertainty::Trials;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBytes, PyTuple};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Name and content of a file. Python gives them, or a path.
struct File(String, Vec<u8>);

/// Name, result, code and detail of a check.
type Check = (&'static str, Option<bool>, &'static str, String);

/// Id and SHA-256 of a passport, its bytes, every check, the checks that were not asked, remarks, and the content if every check
/// passed.
type Answer = (Option<String>, String, Vec<u8>, Vec<Check>, Vec<&'static str>, Vec<String>, Option<Content>);

fn failed(error: Failed) -> PyErr {
    match error.code {
        "unwritable" | "exists" => PyOSError::new_err(error.message),
        _ => PyValueError::new_err(error.message),
    }
}

impl File {
    /// Returns the file as the library takes it.
    fn given(&self) -> (&str, &[u8]) {
        (&self.0, &self.1)
    }
}

impl<'py> FromPyObject<'_, 'py> for File {
    type Error = PyErr;

    fn extract(file: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok((name, bytes)) = file.extract() {
            return Ok(Self(name, bytes));
        }
        let path: PathBuf = file.extract()?;
        let bytes = file.py().detach(|| interface::read(&path)).map_err(|error| match error {
            FileError::Special(_) | FileError::TooLarge(..) => PyValueError::new_err(error.to_string()),
            _ => os_error(file.py(), &error),
        })?;
        Ok(Self(path.to_string_lossy().into_owned(), bytes))
    }
}

fn answered(found: interface::Answer, data: Vec<u8>) -> Answer {
    let verification = &found.verification;
    let checks = verification.checks().iter();
    let checks = checks.map(|check| (check.name.as_str(), check.passed(), check.code.as_str(), check.detail.clone()));
    let verified = Some((found.time, verification.register().cloned()));
    let content = verification.passport().map(|of| Content { passport: of.content().clone(), verified });
    let (id, not_asked) = (verification.id_from_anyone().map(str::to_owned), verification.not_asked());
    (id, found.sha256, data, checks.collect(), not_asked, found.remarks, content)
}

/// Returns the result of a calibration, and the reason why it is not valid.
fn judged(found: Result<String, Failed>) -> Result<(String, Option<String>), Failed> {
    match found {
        Ok(result) => Ok((result, None)),
        Err(Failed { result: Some(result), message, .. }) => Ok((result, Some(message))),
        Err(failed) => Err(failed),
    }
}

/// Returns the reason why an earlier result is not valid.
#[pyfunction]
fn earlier(result: &str) -> PyResult<Option<String>> {
    let found = interface::earlier(result).map(|()| String::new());
    judged(found).map(|(_, not_valid)| not_valid).map_err(failed)
}

/// Returns numbers as bytes, float64 each.
fn float64(py: Python<'_>, numbers: impl IntoIterator<Item = f64>) -> Bound<'_, PyBytes> {
    PyBytes::new(py, &numbers.into_iter().flat_map(f64::to_ne_bytes).collect::<Vec<_>>())
}

/// Converts an error of a file to the subclass of OSError that Python users expect.
fn os_error(py: Python, error: &FileError) -> PyErr {
    let known = match error {
        FileError::Read(path, system) => system.raw_os_error().map(|number| (number, path)),
        FileError::Folder(path) => Some((21, path)), // EISDIR
        _ => None,
    };
    let words = |number: i32| py.import("os")?.call_method1("strerror", (number,))?.extract::<String>();
    let known = known.and_then(|(number, path)| Some((number, words(number).ok()?, path.as_os_str().to_owned())));
    known.map_or_else(|| PyOSError::new_err(error.to_string()), PyOSError::new_err)
}

/// Register of a stand, or the path of one or of a folder of passports with their registers.
#[derive(FromPyObject)]
enum Register {
    Content(PyBackedBytes),
    Path(PathBuf),
}

/// Trusted keys and the question to verify passports for.
#[pyclass(frozen)]
struct Enquiry(interface::Enquiry);

#[pymethods]
impl Enquiry {
    #[new]
    fn new(trust: File, revoked: Vec<File>, question: &str, register: Option<Register>) -> PyResult<Self> {
        let revoked: Vec<_> = revoked.into_iter().map(|File(name, bytes)| (name, bytes)).collect();
        let enquiry = interface::Enquiry::new(trust.given(), &revoked, question, Timestamp::now());
        let enquiry = enquiry.map_err(failed)?;
        Ok(Self(match register {
            Some(Register::Content(bytes)) => enquiry.with_register_text("register", &bytes),
            Some(Register::Path(path)) => enquiry.with_register(&path),
            None => enquiry,
        }))
    }

    fn verify(&self, py: Python, file: &str, data: &[u8]) -> Answer {
        py.detach(|| answered(self.0.verify(file, data), data.to_owned()))
    }

    /// Verifies files. The list has one element for each file: its answer, and an OSError if it cannot be read.
    fn verify_files(&self, py: Python, paths: Vec<PathBuf>, threads: usize) -> Vec<(Answer, Option<PyErr>)> {
        let answers = py.detach(|| self.0.verify_files(&paths, threads));
        let each = answers.into_iter().map(|(answer, bytes)| {
            let error = bytes.as_ref().err().map(|error| os_error(py, error));
            (answered(answer, bytes.unwrap_or_default()), error)
        });
        each.collect()
    }
}

/// Content of a passport.
#[pyclass(frozen)]
struct Content {
    passport: Passport,
    /// Time for which the passport was verified, and the register that was asked.
    verified: Option<(Timestamp, Option<RegisterUsed>)>,
}

#[pymethods]
impl Content {
    fn json(&self, py: Python) -> String {
        py.detach(|| interface::content_json(&self.passport))
    }

    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyBytes>> {
        let numbers = interface::array(&self.passport, name);
        let numbers = numbers.ok_or_else(|| PyValueError::new_err(format!("no array {name}")))?;
        Ok(float64(py, numbers))
    }

    /// Returns the JSON of `calibrate`, the reason why it is not valid, and the Monte Carlo of the same calibration; `files`
    /// are a gyro type and a laboratory.
    fn calibrate(
        slf: Py<Self>,
        py: Python,
        currents: File,
        order: &str,
        files: [Option<File>; 2],
    ) -> PyResult<(String, Option<String>, Distributions)> {
        let [gyro, laboratory] = files;
        let Self { passport, verified } = slf.get();
        let verified = verified.as_ref().map(|(time, register)| (*time, register.as_ref()));
        let done = py.detach(|| {
            let mut order: Order = order.parse()?;
            order.gyro = gyro.map(|File(name, bytes)| GyroType::from_yaml(&name, &bytes)).transpose()?;
            if let Some(File(name, bytes)) = laboratory {
                order.laboratory = Some(Laboratory::from_yaml(&name, &bytes)?);
            }
            let found = interface::calibrate_json(passport, verified, currents.given(), &order);
            Ok((judged(found)?, order))
        });
        let ((found, not_valid), order) = done.map_err(failed)?;
        Ok((found, not_valid, Distributions(slf, currents, order)))
    }

    /// Returns the relative error of each of the eight parameters found from the currents of the self-check, and the
    /// limit.
    fn self_check_errors(&self, found: [f64; 8]) -> PyResult<([f64; 8], f64)> {
        let check = self.passport.self_check.as_ref();
        let check = check.ok_or_else(|| PyValueError::new_err("this passport has no self-check"))?;
        Ok((check.errors(&GyroParameters::from_vector(&found)), SelfCheck::LIMIT))
    }
}

/// Passport, currents and order of a calibration, for its Monte Carlo.
#[pyclass(frozen)]
struct Distributions(Py<Content>, File, Order);

#[pymethods]
impl Distributions {
    /// Returns the JSON of a Monte Carlo. Between the waves of trials `progress` is called, and signals are handled; an
    /// exception of either ends the run.
    fn __call__(
        &self,
        py: Python,
        trials: Option<u64>,
        seed: u64,
        threads: Option<usize>,
        progress: Py<PyAny>,
    ) -> PyResult<String> {
        let (cancel, raised) = (AtomicBool::new(false), OnceLock::new());
        let tell = |done: u64, due: u64| {
            let told = Python::attach(|py| {
                py.check_signals()?;
                progress.call1(py, (done, due)).map(drop)
            });
            if let Err(error) = told {
                cancel.store(true, Ordering::Relaxed);
                let _ = raised.set(error);
            }
        };
        let mut run = Trials::adaptive(seed);
        (run.trials, run.cancel) = (trials, Some(&cancel));
        run.progress = Some(&tell);
        run.threads = threads.unwrap_or(run.threads);
        let Self(content, currents, order) = self;
        let found = py.detach(|| interface::monte_carlo(&content.get().passport, currents.given(), order, &run));
        raised.into_inner().map_or(found.map_err(failed), Err)
    }
}

/// Parses a passport without verifying it.
#[pyfunction]
fn unverified(file: File) -> PyResult<Answer> {
    let (passport, sha256) = interface::unverified(&file.0, &file.1).map_err(failed)?;
    let id = Some(passport.passport.id.clone());
    let content = Some(Content { passport, verified: None });
    Ok((id, sha256, file.1, Vec::new(), Vec::new(), Vec::new(), content))
}

/// Issues a passport; `files` are its stand and site, and `accuracy` a gyro type and a laboratory. Returns its id, path and
/// SHA-256, whether it is new, and remarks.
#[pyfunction]
#[expect(clippy::too_many_arguments)]
fn issue<'py>(
    py: Python<'py>,
    files: [File; 2],
    order: &str,
    accuracy: Option<[Option<File>; 2]>,
    key: PathBuf,
    passphrase: Option<String>,
    trust: Option<File>,
    out: PathBuf,
) -> PyResult<(String, OsString, String, bool, Bound<'py, PyTuple>)> {
    let accuracy = accuracy.as_ref().map(|files| files.each_ref().map(|file| file.as_ref().map(File::given)));
    let words = || "give its passphrase, or set DTG_PASSPORT_PASSPHRASE".to_owned();
    let ask = |_: &Path| passphrase.clone().map(Into::into).ok_or_else(words);
    let issued = py.detach(|| {
        let signer = signer(&key, &ask).map_err(Err)?;
        let (files, trust) = (files.each_ref().map(File::given), trust.as_ref().map(File::given));
        interface::issue(files, order, accuracy, &*signer, trust, &out, Timestamp::now()).map_err(Ok)
    });
    let (issued, remarks) = issued.map_err(|error| match error {
        Ok(error) => failed(error),
        Err(KeyFileError::File(error)) => os_error(py, &error),
        Err(error) => PyValueError::new_err(error.to_string()),
    })?;
    Ok((issued.id, issued.path.into(), issued.sha256, issued.new, PyTuple::new(py, remarks)?))
}

/// Returns the JSON of `plan`; `files` are a gyro type and a laboratory.
#[pyfunction]
fn plan(py: Python, site: File, stand: Option<File>, files: [Option<File>; 2], question: &str) -> PyResult<String> {
    let [stand, gyro, laboratory] = [&stand, &files[0], &files[1]].map(|file| file.as_ref().map(File::given));
    py.detach(|| interface::plan(site.given(), stand, gyro, laboratory, question)).map_err(failed)
}

#[pymodule]
mod _dtg_passport {
    #[pymodule_export]
    #[expect(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::{Content, Distributions, Enquiry, earlier, issue, plan, unverified};
}
