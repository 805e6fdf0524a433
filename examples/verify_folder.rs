//! Lists the passports of a stand by its register, and verifies each file:
//!
//! ```sh
//! cargo run --example verify_folder -- passports/SPS-2/0017 docs/allowed_signers
//! ```

use dtg_passport::jiff::Timestamp;
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::register::VerifiedRegister;
use dtg_passport::trust::AllowedSigners;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, folder, signers] = &arguments[..] else { return Err("usage: verify_folder FOLDER ALLOWED_SIGNERS".into()) };
    let folder = Path::new(folder);

    let trust = Trust::of(AllowedSigners::parse(signers, &fs::read(signers)?)?);
    let question = Question::at(Timestamp::now());
    let bytes = fs::read(folder.join("register.yaml"))?;
    let register = VerifiedRegister::verify("register.yaml", &bytes, &trust, question.now)?;

    let mut is_any_usable = false;
    for entry in register.entries() {
        // The identifier `<model>/<serial>/<site>/<revision>` names the file `<site>-<revision>.yaml`.
        let parts: Vec<&str> = entry.id.split('/').collect();
        let [.., site, revision] = parts[..] else { continue };
        let name = format!("{site}-{revision}.yaml");
        let Ok(bytes) = fs::read(folder.join(&name)) else {
            println!("{:12}  {}: {name} cannot be read", entry.state.key(), entry.id);
            continue;
        };
        // The register answers for this file only: it lists the SHA-256.
        let answer = verify(&name, &bytes, &trust, &question).with_register(Ok((&register, None)), &question);
        let failed = answer.checks().iter().find(|check| check.passed() == Some(false));
        println!("{:12}  {}: {}", entry.state.key(), entry.id, failed.map_or("valid", |check| &check.detail));
        is_any_usable |= answer.valid();
    }
    Ok(if is_any_usable { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
