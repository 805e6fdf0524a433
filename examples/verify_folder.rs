//! Verifies every passport in a folder and lists those that are in force now:
//!
//! ```sh
//! cargo run --example verify_folder -- passports docs/allowed_signers
//! ```

use dtg_passport::folder;
use dtg_passport::jiff::Timestamp;
use dtg_passport::passport::Trust;
use dtg_passport::register::{Asked, State};
use dtg_passport::trust::AllowedSigners;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::thread::available_parallelism;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, root, signers] = &arguments[..] else { return Err("usage: verify_folder FOLDER ALLOWED_SIGNERS".into()) };

    let trust = Trust::of(AllowedSigners::parse(signers, &fs::read(signers)?)?);
    let asked = Asked::at(Timestamp::now());
    // The second value is the trust extended by the withdrawals found in the folder: pass it to `verify`.
    let (register, _trust) = folder::register(Path::new(root), trust, &asked, available_parallelism()?.get())?;

    for line in &register.passports {
        println!("{:12}  {:30}  {}", line.state.key(), line.id.as_deref().unwrap_or("-"), line.file);
    }
    for alarm in &register.alarms {
        eprintln!("{alarm}");
    }
    let usable = register.passports.iter().any(|line| matches!(line.state, State::InForce | State::Expiring));
    Ok(if usable && !register.needs_attention() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
