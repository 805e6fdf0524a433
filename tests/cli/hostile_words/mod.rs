//! Text of others in every place where words go out: each argument of every verb in turn becomes a hostile text, the name
//! of a file that is there, or a file of hostile content. Nothing but what can be seen may come back, no line may be
//! forged, and JSON gives the very text back.

mod contents;
mod scene;

use crate::programs;
use contents::contents;
use scene::{LINES, POISON, Scene, assert_no, hidden, line_with, named, words};
use serde_json::Value;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

#[test]
fn the_lines_go_through() {
    let mut scene = Scene::new();
    for line in LINES {
        let arguments = line_with(&words(line), None, OsStr::new(""), scene.runs);
        let output = scene.run(line, &arguments);
        // A .pub whose private half no agent has; a revoked key or passport; a result against a type.
        let refused = line.contains("@key.pub") || line.contains("=help");
        let good = output.status.success() || refused;
        assert!(good, "{line}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert_no(&scene);
}

#[test]
fn arguments_and_file_names() {
    let mut scene = Scene::new();
    for line in LINES {
        let words = words(line);
        for (place, (kind, word)) in words.iter().enumerate() {
            let mut how = vec![("as a hostile text", OsString::from(POISON))];
            let not_utf8 = [POISON.as_bytes(), b"\xff\xfe"].concat();
            how.push(("as no UTF-8", OsString::from_vec(not_utf8)));
            how.push(("as a hostile option", OsString::from(format!("--{POISON}"))));
            if *kind == '@' {
                how.push(("of a hostile name", scene.hostile_copy(word)));
            }
            if *kind == '>' {
                how.push(("of a new hostile name", format!("{}{POISON}", scene.runs).into()));
            }
            for (how, hostile) in how {
                let arguments = line_with(&words, Some(place), &hostile, scene.runs);
                scene.run(&named(line, place, how), &arguments);
            }
        }
    }
    assert_no(&scene);
}

#[test]
fn contents_of_files() {
    let mut scene = Scene::new();
    for line in LINES {
        let words = words(line);
        for (place, (kind, word)) in words.iter().enumerate() {
            if *kind != '@' {
                continue;
            }
            // Of a folder of passports the files in it, the other one as it is.
            const FILES: [&str; 2] = ["here-1.yaml", "register.yaml"];
            let is_folder = ["passports", "withdrawn"].contains(word);
            for at in 0..if is_folder { 2 } else { 1 } {
                let of_stand = |root: &str, name: &str| format!("{root}/SPS-2/0017/{name}");
                let (hostile, file) = match is_folder {
                    true => (OsString::from("hostile"), OsString::from(of_stand("hostile", FILES[at]))),
                    false => (OsString::from(format!("hostile-{word}")), OsString::from(format!("hostile-{word}"))),
                };
                let path = scene.path(&file);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                let original = if is_folder { of_stand(word, FILES[at]) } else { (*word).to_owned() };
                let like = match at {
                    0 if is_folder => "passport.yaml",
                    _ if is_folder => "register.yaml",
                    _ => word,
                };
                for (what, content) in contents(like, &fs::read_to_string(scene.path(original)).unwrap()) {
                    if is_folder {
                        let other = FILES[1 - at];
                        fs::copy(scene.path(of_stand(word, other)), scene.path(of_stand("hostile", other))).unwrap();
                    }
                    fs::write(&path, content).unwrap();
                    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
                    let arguments = line_with(&words, Some(place), &hostile, scene.runs);
                    scene.run(&named(line, place, what), &arguments);
                    fs::remove_file(&path).unwrap();
                }
            }
            let _ = fs::remove_dir_all(scene.path("hostile"));
        }
    }
    assert_no(&scene);
}

#[test]
fn json_gives_the_text_back_and_csv_a_text() {
    let mut scene = Scene::new();
    let copy = scene.hostile_copy("passport.yaml");
    let name = copy.to_string_lossy().into_owned();
    fs::create_dir(scene.path("folder")).unwrap();
    // The name of a passport in a folder is text.
    let there = format!("{POISON}-1.yaml");
    fs::copy(scene.path(&copy), scene.path("folder").join(&there)).unwrap();
    let mut run = |line: &str, hostile: &OsStr| {
        let words = line.split(' ').map(|word| if word == "@" { hostile.to_owned() } else { word.into() });
        scene.run(line, &words.collect::<Vec<_>>()).stdout
    };
    let trust = "--trust allowed_signers --time 2026-11-04";
    let mut json = |line: &str, hostile: &OsStr| -> Value { serde_json::from_slice(&run(line, hostile)).unwrap() };
    let good = json(&format!("verify @ {trust} --format json"), &copy);
    assert_eq!((&good[0]["file"], &good[0]["valid"]), (&Value::from(name.as_str()), &Value::from(true)));
    let refused = json(&format!("verify @ {trust} --format json"), OsStr::new(POISON));
    assert_eq!((&refused[0]["file"], &refused[0]["valid"]), (&Value::from(POISON), &Value::from(false)));
    let register = json(&format!("register folder {trust} --format json"), OsStr::new(""));
    assert_eq!(register["alarms"][0]["code"], Value::from("misplaced"));
    assert_eq!(register["alarms"][0]["file"], Value::from(format!("folder/{there}")));
    let issue = "issue stand.yaml --site here.yaml --key key --identity factory --issued-at 2026-11-03 --out @";
    let issued = json(&format!("{issue} --format json"), OsStr::new(POISON));
    assert_eq!(issued[0]["file"], Value::from(format!("{POISON}/SPS-2/0017/here-1.yaml")));
    let register = json(&format!("register @ {trust} --format json"), OsStr::new(POISON));
    let row = &register["stands"][0]["rows"][0];
    assert_eq!(row["file"], Value::from(format!("{POISON}/SPS-2/0017/here-1.yaml")));
    // A name that a spreadsheet would take for a formula.
    let csv = run(&format!("{issue} --format csv"), OsStr::new(";=1+1"));
    let row = String::from_utf8(csv).unwrap().lines().nth(1).unwrap().to_owned();
    assert!(row.starts_with("issued,SPS-2/0017/here/1,\"';'=1+1/SPS-2/0017/here-1.yaml\","), "{row}");
    assert_no(&scene);
}

#[test]
fn pages_show_what_they_quote() {
    let mut scene = Scene::new();
    let (passport, currents) = (scene.hostile_copy("passport.yaml"), scene.hostile_copy("currents.csv"));
    let mut run = |line: &str| {
        let words = line.split(' ').map(|word| match word {
            "@passport" => passport.clone(),
            "@currents" => currents.clone(),
            word => word.into(),
        });
        assert!(scene.run(line, &words.collect::<Vec<_>>()).status.success(), "{line}");
    };
    run("render @passport -o render.html --trust allowed_signers --time 2026-11-04 --lang en,ru");
    run("calibrate @passport @currents --trust allowed_signers --time 2026-11-04 --report report.html");
    for page in ["render.html", "report.html"] {
        let page = fs::read_to_string(scene.path(page)).unwrap();
        // The blanks of typesetting are the page's own.
        let found = page.chars().find(|&c| hidden(c) && !"\u{a0}\u{2002}\u{202f}".contains(c));
        assert_eq!(found, None);
    }
    let report = fs::read_to_string(scene.path("report.html")).unwrap();
    assert!(report.contains("\\u{202e}\\u{2066}"), "the file is named");
    assert_no(&scene);
}

#[test]
fn no_path_gets_into_words_as_it_is() {
    for file in sources(&programs::project("src")) {
        let text = fs::read_to_string(&file).unwrap();
        let here = file.ends_with("src/text/printable.rs");
        assert!(here || !text.contains(".display()"), "{}: use text::shown or text::name_of", file.to_string_lossy());
        let prints = ["println!(", "print!(", "eprint"].iter().any(|printing| text.contains(printing));
        assert!(!prints, "{}: words go out through cli::output", file.to_string_lossy());
    }
}

fn sources(folder: &Path) -> Vec<std::path::PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] });
    files.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}
