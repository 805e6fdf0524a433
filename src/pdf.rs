//! Pages as PDF: an installed browser prints them, with the fonts of the system.
//!
//! The browser gets a file and no way to look up a host. The page and a fresh profile are in a folder next to the output,
//! because a browser from a snap sees neither `/tmp` nor hidden folders. The folder is removed afterwards.

use crate::files::{self, FileError, folder_of, or_here};
use crate::signing::PASSPHRASE_VARIABLE;
use crate::text::shown;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Environment variable with the browser that prints: a program, options that begin with `--`, or both.
pub(crate) const BROWSER_VARIABLE: &str = "DTG_PASSPORT_BROWSER";

/// Names of browsers in PATH, in the order in which they are tried.
const IN_PATH: [&str; 8] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "microsoft-edge",
    "microsoft-edge-stable",
    "chrome",
    "msedge",
];

/// Variables of Windows with folders of programs, and the browsers in them.
const WINDOWS_FOLDERS: [&str; 3] = ["ProgramFiles", "ProgramFiles(x86)", "LOCALAPPDATA"];
const ON_WINDOWS: [&str; 2] = ["Google/Chrome/Application/chrome.exe", "Microsoft/Edge/Application/msedge.exe"];

/// Names of the browsers of macOS, whose folders contain a program of the same name.
const ON_MACOS: [&str; 3] = ["Chromium", "Google Chrome", "Microsoft Edge"];

const OPTIONS: [&str; 13] = [
    "--headless",
    "--no-pdf-header-footer",
    // No request: not for the page, which has none, and not by the browser for itself.
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--disable-gpu",
    "--no-first-run",
    "--no-default-browser-check",
    // No helper that outlives the browser and writes into its profile.
    "--disable-breakpad",
    "--disable-crash-reporter",
    // An administrator's browser on Windows would start another one and end before that has printed.
    "--do-not-de-elevate",
];

/// Number and length of the waits for the browser, two minutes in all. It usually takes seconds.
const WAITS: u32 = 2400;
const WAIT: Duration = Duration::from_millis(50);

/// Number of attempts to remove the folder, into which processes of the browser may write until they have ended too.
const REMOVALS: u32 = 40;

/// Advice if no browser is found, or if the one that was found prints nothing.
const ADVICE: &str = "install Chromium, Google Chrome or Microsoft Edge, specify one by DTG_PASSPORT_BROWSER, or write \
                      .html and print that";

const LARGEST_PDF_BYTES: usize = 1 << 28;

/// Number of the last lines of a browser's messages that are repeated.
const LAST_LINES: usize = 3;

/// Returns a page as PDF, printed by `browser`, as [`BROWSER_VARIABLE`] states it, or else by the first one that is installed.
///
/// # Errors
/// Returns [`FileError::Write`] for `path`, the file to be written, if there is no browser or if it leaves no PDF.
pub(crate) fn print(html: &str, path: &Path, browser: Option<&str>) -> Result<Vec<u8>, FileError> {
    printed(html, path, browser, WAITS).map_err(|error| FileError::Write(path.to_owned(), error))
}

fn printed(html: &str, path: &Path, browser: Option<&str>, waits: u32) -> io::Result<Vec<u8>> {
    // The folder of the output is made only when there is something to write.
    let above = folder_of(path).ancestors().map(or_here).find(|above| above.exists()).unwrap_or(Path::new("."));
    let mut folder = tempfile::Builder::new();
    let folder = folder.prefix("dtg-passport-").suffix(".tmp").tempdir_in(std::path::absolute(above)?)?;
    let pdf = in_folder(html, folder.path(), browser, waits);
    for _ in 0..REMOVALS {
        match fs::remove_dir_all(folder.path()) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => sleep(WAIT),
            _ => break,
        }
    }
    pdf
}

fn in_folder(html: &str, folder: &Path, browser: Option<&str>, waits: u32) -> io::Result<Vec<u8>> {
    let [page, pdf, messages, profile] = ["page.html", "page.pdf", "messages", "profile"].map(|name| folder.join(name));
    fs::write(&page, html)?;
    let words = format!(" {}", browser.unwrap_or_default());
    let mut words = words.split(" --");
    let named = words.next().map(str::trim).filter(|name| !name.is_empty()).map(PathBuf::from);
    let further: Vec<String> = words.map(|word| format!("--{}", word.trim())).collect();
    for program in named.as_ref().map_or_else(installed, |named| vec![named.clone()]) {
        let mut command = Command::new(&program);
        command.args(OPTIONS).arg(option("--user-data-dir=", &profile)).arg(option("--print-to-pdf=", &pdf));
        command.args(&further).arg(&page).env_remove(PASSPHRASE_VARIABLE);
        // A pipe would stay open as long as any process of the browser.
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(&messages)?);
        match command.spawn() {
            Err(error) if [io::ErrorKind::NotFound, io::ErrorKind::PermissionDenied].contains(&error.kind()) => {}
            Err(error) => return Err(failed(&program, &format!("cannot be started: {error}"), "")),
            Ok(mut child) => {
                let status = wait(&mut child, waits)?;
                let bytes = files::read(&pdf, LARGEST_PDF_BYTES).unwrap_or_default();
                let is_whole = bytes.starts_with(b"%PDF-") && bytes.trim_ascii_end().ends_with(b"%%EOF");
                let what = match status {
                    Some(status) if status.success() && is_whole => return Ok(bytes),
                    Some(status) => format!("printed no PDF ({status})"),
                    None => format!("printed no PDF within {} s", (WAIT * waits).as_secs()),
                };
                let said = files::read(&messages, LARGEST_PDF_BYTES).unwrap_or_default();
                return Err(failed(&program, &what, &String::from_utf8_lossy(&said)));
            }
        }
    }
    let looked_for = match named {
        Some(named) => format!("no {}, which {BROWSER_VARIABLE} specifies", shown(&named)),
        None => format!("no browser in PATH or in the usual folders ({})", IN_PATH.join(", ")),
    };
    Err(io::Error::other(format!("found {looked_for}; {ADVICE}")))
}

/// Returns the browsers that may be installed, by name or by path.
fn installed() -> Vec<PathBuf> {
    let on_macos = ON_MACOS.map(|name| format!("/Applications/{name}.app/Contents/MacOS/{name}").into());
    let folders = WINDOWS_FOLDERS.into_iter().filter_map(std::env::var_os).map(PathBuf::from);
    // Collected again, a path has the separators of its system.
    let on_windows = folders.flat_map(|folder| ON_WINDOWS.map(|name| folder.join(name).components().collect()));
    IN_PATH.map(PathBuf::from).into_iter().chain(on_macos).chain(on_windows).collect()
}

fn option(name: &str, path: &Path) -> OsString {
    let mut option = OsString::from(name);
    option.push(path);
    option
}

/// Waits for the end of a browser, and kills it if it has not ended after so many waits.
fn wait(child: &mut Child, waits: u32) -> io::Result<Option<ExitStatus>> {
    for _ in 0..waits {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        sleep(WAIT);
    }
    child.kill()?;
    child.wait()?;
    Ok(None)
}

/// Returns the failure of a browser, with the end of what it said.
fn failed(program: &Path, what: &str, said: &str) -> io::Error {
    let lines: Vec<&str> = said.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    // A trace of the stack may follow it.
    let no_sandbox = lines.iter().find(|line| line.contains("no-sandbox"));
    let last = lines[lines.len().saturating_sub(LAST_LINES)..].join("; ");
    let said = no_sandbox.map_or(last, |line| (*line).to_owned());
    let (program, colon) = (shown(program), if said.is_empty() { "" } else { ": " });
    let advice = match no_sandbox.is_some() {
        true => format!("to do without its sandbox, set {BROWSER_VARIABLE}='{program} --no-sandbox'; or {ADVICE}"),
        false => ADVICE.to_owned(),
    };
    io::Error::other(format!("{program} {what}{colon}{said}; {advice}"))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn a_browser_that_hangs_is_ended_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("a browser");
        fs::write(&script, "#!/bin/sh\necho waiting >&2\nexec sleep 3600\n").unwrap();
        fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).unwrap();
        let path = folder.path().join("page.pdf");
        let words = printed("<p>", &path, script.to_str(), 40).unwrap_err().to_string();
        assert!(
            words.contains("a browser printed no PDF within 2 s: waiting; install Chromium, Google Chrome"),
            "{words}"
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
