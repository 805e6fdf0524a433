//! Files that verbs write below a folder: one rule for all, that of `issue`.

use crate::place::{Place, example};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

const PASSPORT: &str = "passports/SPS-2/0017/moscow-bmstu-1.yaml";
const TRUST: &str = "--trust docs/allowed_signers --time 2026-11-20";

/// A folder with a passport, a stand without angles and its readings; `out` is the folder to write to.
fn place() -> Place {
    let place = Place::of(&[PASSPORT, "docs/allowed_signers", "docs/angles.csv"].map(|name| (name, name)));
    place.write("headers/angles.yaml", header_of(&example("passports/SPS-2/0017/stand.yaml")));
    fs::create_dir(place.path("elsewhere")).unwrap();
    place
}

/// A stand before its angles are known.
pub fn header_of(stand: &str) -> String {
    const OF_CERTIFICATE: [&str; 5] = ["repeatability", "common_", "evidence", "type_b", "{source"];
    let lines = stand.lines().filter(|line| !OF_CERTIFICATE.iter().any(|key| line.contains(key)));
    let nominal =
        lines.map(|line| line.split_once(", alpha_arcsec").map_or(line.to_owned(), |(begin, _)| format!("{begin}}}")));
    nominal.map(|line| line + "\n").collect()
}

/// Runs the program, which must refuse with the `words`.
fn refused(place: &Place, arguments: &str, words: &str) {
    let (code, _, said) = place.said(arguments);
    assert!([1, 2].contains(&code) && said.contains(words), "{arguments}: {code}, lacks {words}\n{said}");
}

/// Every verb that names the files below a folder itself, with the last one that it writes there.
fn verbs() -> [(String, &'static str); 5] {
    let of_passport = |verb: &str| format!("{verb} {PASSPORT} {TRUST} --out out");
    [
        (of_passport("render"), "SPS-2/0017/moscow-bmstu-1.html"),
        (of_passport("export --to stand"), "SPS-2/0017/stand.yaml"),
        (of_passport("export --to json"), "SPS-2/0017/moscow-bmstu-1.json"),
        (of_passport("export --to stand,site"), "moscow-bmstu.yaml"),
        ("certify docs/angles.csv --stand headers --out out".to_owned(), "SPS-2/0017/stand.yaml"),
    ]
}

/// Expected: what `issue` does. A link below the folder may lead out of it.
#[test]
fn no_verb_writes_through_a_link_below_its_folder() {
    let place = place();
    let out = place.path("out");
    for (verb, file) in verbs() {
        for link in Path::new(file).ancestors().filter(|link| !link.as_os_str().is_empty()) {
            for target in ["elsewhere", "nowhere"] {
                fs::create_dir_all(out.join(link).parent().unwrap()).unwrap();
                symlink(place.path(target), out.join(link)).unwrap();
                for force in ["", " --force"] {
                    refused(&place, &(verb.clone() + force), &format!("out/{}: is a link", link.display()));
                    assert!(place.names("elsewhere").is_empty(), "{verb}{force} {link:?}");
                }
                fs::remove_dir_all(&out).unwrap();
            }
        }
    }
    assert!(!place.path("nowhere").exists());
}

/// Expected: what `issue` does, because Windows and macOS do not distinguish the two.
#[test]
fn no_verb_writes_next_to_a_name_that_differs_only_in_case() {
    let place = place();
    let out = place.path("out");
    for (verb, file) in verbs() {
        let other = Path::new(file).components().next().unwrap().as_os_str().to_str().unwrap();
        let other = if other.ends_with("yaml") { other.to_uppercase() } else { other.to_lowercase() };
        place.write(format!("out/{other}{}", if file == "moscow-bmstu.yaml" { "" } else { "/0017/x" }), "there");
        refused(&place, &verb, &format!("found out/{other}, which differs only in case"));
        assert_eq!(place.names("out"), [other], "{verb}");
        fs::remove_dir_all(&out).unwrap();
    }
}

/// Expected: the word "link", because a message that such a file "already exists" sends the user to look for it.
#[test]
fn a_link_where_one_file_will_be_written_is_called_a_link() {
    let place = place();
    place.write("mine", "mine");
    for target in ["nowhere", "mine"] {
        for (name, verb) in [
            ("link.html", format!("render {PASSPORT} {TRUST} -o link.html")),
            ("link.html", format!("render {PASSPORT} {TRUST} -o link.html --force")),
            ("link.yaml", "certify docs/angles.csv --stand headers/angles.yaml -o link.yaml --force".to_owned()),
            ("link", "certify docs/angles.csv --stand headers/angles.yaml -o stand.yaml --report link".to_owned()),
            ("link", "new stand link".to_owned()),
            ("link", "keygen link --identity me --no-passphrase".to_owned()),
        ] {
            symlink(place.path(target), place.path(name)).unwrap();
            refused(&place, &verb, &format!("{name}: is a link"));
            let link = fs::read_link(place.path(name)).unwrap();
            assert_eq!(link, place.path(target), "{verb}");
            assert!(!place.path("stand.yaml").exists() && !place.path("nowhere").exists(), "{verb}");
            fs::remove_file(place.path(name)).unwrap();
        }
    }
    assert_eq!(place.read("mine"), "mine");
    // Of a list of keys only a link that leads nowhere is refused: one that leads to the shared list is usual.
    symlink(place.path("nowhere"), place.path("signers")).unwrap();
    refused(&place, "keygen key --identity me --no-passphrase --allowed-signers signers", "signers: is a link");
    assert!(!place.path("key").exists());
}
