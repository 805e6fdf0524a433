//! Verb `receive`: what a factory hands over, verified and laid into a workspace.

use super::options::Printed;
use super::output::languages;
use super::trust_options::now;
use super::{Code, Failure, open_workspace, output};
use crate::delivery::{LARGEST_ARCHIVE_BYTES, NotReceived, Order, receive};
use crate::files;
use crate::passport::Question;
use crate::text::name_of;
use clap::Args;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;

/// Receive what a factory hands over: verify all of it, and lay it into the workspace of a laboratory, which is made if there
/// is none
///
/// A key that the workspace does not trust yet needs its fingerprint, which the factory tells by another way. The program
/// never shows it before it was typed or given.
#[derive(Args)]
pub(super) struct Options {
    /// Archive that `deliver` wrote
    #[arg(value_name = "FILE.zip")]
    file: PathBuf,
    /// Folder of the workspace [default: that of --workspace or DTG_PASSPORT_WORKSPACE]
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Fingerprint of a key, as the factory told it (repeatable)
    #[arg(long, value_name = "SHA256:…", value_parser = fingerprint)]
    fingerprint: Vec<String>,
    /// Accept a further key of a factory that the workspace already trusts
    #[arg(long)]
    new_key: bool,
    #[command(flatten)]
    _printed: Printed,
}

/// Parses a fingerprint; base64 of 32 bytes has 43 characters.
fn fingerprint(text: &str) -> Result<String, &'static str> {
    let text = text.trim();
    let is_base64 =
        |text: &str| text.len() == 43 && text.bytes().all(|c| c.is_ascii_alphanumeric() || b"+/".contains(&c));
    match text.strip_prefix("SHA256:").filter(|rest| is_base64(rest)) {
        Some(_) => Ok(text.to_owned()),
        None => Err("expected SHA256: and 43 characters, as the factory told it"),
    }
}

/// Asks for the fingerprint of a key, if there is a terminal.
fn ask(principal: &str) -> Option<String> {
    if !std::io::stdin().is_terminal() {
        return None;
    }
    let mut stderr = std::io::stderr().lock();
    let _ = write!(stderr, "Fingerprint of the key of {principal}, as the factory told it (SHA256:…): ");
    let _ = stderr.flush();
    let mut line = String::new();
    std::io::stdin().read_line(&mut line).ok()?;
    Some(line.trim().to_owned())
}

pub(super) fn run(options: &Options) -> Result<Code, Failure> {
    let folder = options.folder.as_ref().or(open_workspace::folder());
    let folder = folder.ok_or_else(|| {
        Failure::usage(
            "missing DIR, the folder of the workspace; give it, or --workspace, or set DTG_PASSPORT_WORKSPACE",
        )
    })?;
    let (name, now) = (name_of(&options.file), now());
    let bytes = files::read(&options.file, LARGEST_ARCHIVE_BYTES)?;
    let order = Order {
        root: folder,
        given: &options.fingerprint,
        ask: &ask,
        may_replace: options.new_key,
        languages: &languages(),
        now,
    };
    let received = receive(&bytes, &order).map_err(|refused| match refused {
        NotReceived::NotValid(name, verification) => {
            Failure::verdict("nothing was written", &name, &verification, &Question::at(now))
        }
        NotReceived::Refused(why) => Failure::refused(format!("{name}: {why}; nothing was written")),
    })?;
    output::show(|| &received, || received.document())?;
    Ok(0)
}
