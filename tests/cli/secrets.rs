//! A file with a secret that is given instead of another: no more than 8 of its characters are shown.

use crate::place::Place;
use crate::programs;
use std::fs;

/// A key of age (BIP 173), 32 bytes as base64 and as hexadecimal (RFC 4648), none of which was ever used.
const SECRETS: [&str; 4] = [
    "AGE-SECRET-KEY-1QYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSZQGPQYQSQ",
    "LXEWQrcmsEQBYnyp+6wy9chTD7GQPMTbAiWHF5IaSIE=",
    "2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881",
    "2D711642B726B04401627CA9FBAC32F5C8530FB1903CC4DB02258717921A4881",
];

/// Forms of the file: the secret alone, in a list, as a value, and in JSON.
const FORMS: [&str; 6] =
    ["@\n", "# key\n@\n", "i,j,@,jx_ma,jy_ma\n", "format: @\n", "@: 1\n", "{\"passport_id\": \"@\"}\n"];

const COMMANDS: [&str; 22] = [
    "verify PASSPORT --trust FILE",
    "verify PASSPORT --trust SIGNERS --revoked FILE",
    "verify PASSPORT --trust SIGNERS --revoked FILE --format json",
    "verify FILE --trust SIGNERS",
    "verify FILE --trust SIGNERS --format json",
    "show FILE --no-verify",
    "calibrate PASSPORT FILE --trust SIGNERS",
    "calibrate PASSPORT FILE --trust SIGNERS --format json",
    "calibrate PASSPORT CURRENTS --trust SIGNERS --laboratory FILE",
    "calibrate PASSPORT CURRENTS --trust SIGNERS --gyro FILE",
    "calibrate PASSPORT CURRENTS --trust SIGNERS --previous FILE",
    "export PASSPORT --trust SIGNERS --to dcc --administrative FILE --out out",
    "certify FILE --stand STAND -o out.yaml",
    "certify ANGLES --stand FILE -o out.yaml",
    "plan --site FILE",
    "plan --site SITE --stand FILE",
    "issue STAND --site FILE --key KEY --identity a@b --out out",
    "issue FILE --site SITE --key KEY --identity a@b --out out",
    "issue STAND --site SITE --key FILE --identity a@b --out out",
    "keygen new --identity a@b --no-passphrase --allowed-signers FILE",
    "status --workspace WORKSPACE",
    "verify - --trust SIGNERS",
];

#[test]
fn of_a_secret_at_most_eight_characters_are_shown() {
    let folder = Place::of(&[(programs::KEY, "key")]);
    let places = [
        ("PASSPORT", programs::project("passports/SPS-2/0017/moscow-bmstu-1.yaml")),
        ("STAND", programs::project("passports/SPS-2/0017/stand.yaml")),
        ("SITE", programs::project("sites/moscow-bmstu.yaml")),
        ("SIGNERS", programs::project("docs/allowed_signers")),
        ("CURRENTS", programs::project("docs/currents.csv")),
        ("ANGLES", programs::project("docs/angles.csv")),
        ("KEY", folder.path("key")),
        ("WORKSPACE", folder.path("workspace")),
        ("FILE", folder.path("secret")),
    ];
    let mut shown = 0;
    for (secret, form) in SECRETS.iter().flat_map(|secret| FORMS.map(|form| (secret, form))) {
        let text = form.replace('@', secret);
        folder.write("secret", &text);
        folder.write("workspace/dtg-passport.toml", &text);
        for command in COMMANDS {
            let arguments = command.split(' ').map(|word| {
                let place = places.iter().find(|(name, _)| *name == word);
                place.map_or_else(|| word.into(), |(_, path)| path.clone().into_os_string())
            });
            let stdin = fs::File::open(folder.path("secret")).unwrap();
            let output = folder.program().args(arguments).stdin(stdin).output().unwrap();
            assert!(!output.status.success(), "{command}\n{text}");
            let words = [output.stdout, output.stderr].concat();
            let words = String::from_utf8_lossy(&words);
            for at in 0..secret.len() - 9 {
                assert!(!words.contains(&secret[at..at + 9]), "{command}\n{text}{words}");
            }
            shown += usize::from(words.contains(&format!("{}…", &secret[..8])));
        }
    }
    assert!(shown > 40, "{shown}");
}
