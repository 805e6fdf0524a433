//! Issues the passports of a stand for many sites into a folder, signed with a new key:
//!
//! ```sh
//! cargo run --example issue_for_sites -- passports/SPS-1/0203/stand.yaml out sites/*.yaml
//! ```

use dtg_passport::folder::{Authority, Folder};
use dtg_passport::jiff::Timestamp;
use dtg_passport::passport::Trust;
use dtg_passport::passport::issue::{Issue, PreparedStand};
use dtg_passport::signing::allowed_signers_line;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, SigningKey};
use std::error::Error;
use std::fs;

const ISSUER: &str = "factory@example.org";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, stand, out, sites @ ..] = &arguments[..] else {
        return Err("usage: issue_for_sites STAND OUT SITE...".into());
    };

    // A factory reads its own key: `signing::signer` asks for the passphrase, or signs through the agent.
    let key = SigningKey::generate()?;
    let line = allowed_signers_line(ISSUER, &key.public_key())?;
    let trust = Trust::of(AllowedSigners::parse("allowed_signers", line.as_bytes())?);

    // The part that depends on the stand alone is computed once. Every new passport is verified before it is written, and
    // listed in the register of the stand, which is dated by the clock.
    let stand = PreparedStand::new(Stand::from_yaml(stand, &fs::read(stand)?)?);
    let folder = Folder::new(out);
    let authority = Authority::new(ISSUER, &key, &trust, &Timestamp::now);
    let order = Issue::first(ISSUER, Timestamp::from_second(Timestamp::now().as_second())?);
    for path in sites {
        let site = Site::from_yaml(path, &fs::read(path)?)?;
        let issued = folder.issue(&stand, &site, &order, &authority)?;
        println!("{}  {}", issued.id, issued.path.display());
    }
    print!("line of allowed_signers for the laboratories:\n{line}");
    Ok(())
}
