//! `certify` on the command line: what it writes, and every way in which its input is refused.

use crate::deliver::Place;
use crate::programs;
use std::fs;

fn example(name: &str) -> String {
    fs::read_to_string(programs::project("docs").join(name)).unwrap()
}

/// A folder with the examples of the documentation.
fn folder() -> Place {
    Place::of(&[
        ("docs/angles.csv", "angles.csv"),
        ("docs/check.csv", "check.csv"),
        ("docs/header.yaml", "header.yaml"),
    ])
}

/// The line of position (i, j) in a run, its number replaced.
fn replaced(place: &str, column: usize, value: impl Fn(&str) -> String) -> String {
    let lines = example("angles.csv");
    let lines = lines.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line.starts_with(place) {
            cells[column] = value(&cells[column]);
        }
        cells.join(",") + "\n"
    });
    lines.collect()
}

/// A check: exit code 1 when it is not the same stand, and the position by name; another stand is refused.
#[test]
fn a_check_has_an_exit_code() {
    let folder = folder();
    assert_eq!(folder.said("certify angles.csv --stand header.yaml -o stand.yaml").0, 0);
    let (code, text, _) = folder.said("certify check.csv --against stand.yaml");
    assert!(code == 1 && text.contains("Position (2, 3) has changed"), "{text}");
    let (code, text, _) = folder.said("certify check.csv --against stand.yaml --format json");
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(code == 1 && found["comparison"]["same_stand"] == false, "{text}");
    assert!(found["not_certified"].as_str().unwrap().starts_with("found one run"));
    // Those of the certificate, saved anew, show nothing new; two of its runs agree as closely as another measurement.
    for (name, again) in
        [("same.csv", example("angles.csv")), ("anew.csv", example("angles.csv").replace('\n', "\r\n"))]
    {
        fs::write(folder.path(name), again).unwrap();
        let (code, text, _) = folder.said(&format!("certify {name} --against stand.yaml"));
        assert!(code == 1 && text.starts_with("◐ UNDECIDED"), "{text}");
    }
    let two_runs = |line: &&str| line.starts_with(['#', 'i']) || matches!(line.split(',').nth(2), Some("1" | "2"));
    let two_runs: String = example("angles.csv").lines().filter(two_runs).map(|line| format!("{line}\n")).collect();
    fs::write(folder.path("two.csv"), two_runs).unwrap();
    let (code, text, said) = folder.said("certify two.csv --against stand.yaml --format json");
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(code == 0 && found["comparison"]["same_stand"] == true, "{said}{text}");
    assert_eq!(found["certification"]["stand"]["positions"].as_array().unwrap().len(), 8);
    fs::write(folder.path("header.yaml"), example("header.yaml").replace("0017", "0018")).unwrap();
    let (code, _, said) = folder.said("certify check.csv --stand header.yaml --against stand.yaml");
    assert!(code == 1 && said.contains("SPS-2 0017") && said.contains("SPS-2 0018"), "{said}");
}

/// Other angles never go under a number that is there, --force or not.
#[test]
fn a_number_keeps_its_angles() {
    let folder = folder();
    assert_eq!(folder.said("certify angles.csv --stand header.yaml -o stand.yaml").0, 0);
    let old = fs::read(folder.path("stand.yaml")).unwrap();
    fs::write(folder.path("new.csv"), replaced("1,1,", 3, |text| format!("{}", text.parse::<f64>().unwrap() + 3.0)))
        .unwrap();
    for arguments in [
        "new.csv --against stand.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml --force",
        "new.csv --stand header.yaml -o stand.yaml --force",
    ] {
        let (code, _, said) = folder.said(&format!("certify {arguments}"));
        assert_eq!(code, 1, "{arguments}: {said}");
        assert!(said.contains("certificate C-2026-0143") && said.contains("position (1, 1)"), "{said}");
        assert!(
            !folder.path("new.yaml").exists() && fs::read(folder.path("stand.yaml")).unwrap() == old,
            "{arguments}"
        );
    }
    // The same angles under the old number, and no header that says when: nothing to write.
    let (code, _, said) = folder.said("certify angles.csv --against stand.yaml -o new.yaml");
    assert!(code == 2 && said.contains("--stand HEADER.yaml"), "{said}");
    let header = example("header.yaml").replace("C-2026-0143", "C-2027-0007");
    fs::write(folder.path("header.yaml"), header).unwrap();
    let (code, _, said) = folder.said("certify new.csv --against stand.yaml --stand header.yaml -o new.yaml");
    assert!(said.contains("wrote new.yaml"), "{code} {said}");
}

/// Least squares with NumPy on the readings that are there: a mean for each position, and a rotation of platform and base
/// for each run, whose sum over the runs is zero. Prints the means that the missing readings concern, the ratio of their u
/// to those of other positions, and the repeatability.
const WITHOUT: &str = r##"
import csv, json, sys
import numpy as np
path, left_out = sys.argv[1], json.loads(sys.argv[2])
rows = [row for row in csv.DictReader(line for line in open(path) if not line.startswith("#"))]
rows = [{k: float(v) for k, v in row.items()} for row in rows]
rows = [r for r in rows if [r["i"], r["j"], r["run"]] not in left_out and [r["run"]] not in left_out]
places = sorted({(r["i"], r["j"]) for r in rows}); runs = sorted({r["run"] for r in rows})
arcsec = np.pi / 648000
def turn(axis, angle):
    c, s = np.cos(angle), np.sin(angle); a, b = [(1, 2), (2, 0), (0, 1)][axis]
    m = np.eye(3); m[a, a] = m[b, b] = c; m[a, b] = s; m[b, a] = -s
    return m
angles = {p: np.mean([[r["alpha_arcsec"], r["beta_arcsec"], r["gamma_arcsec"]] for r in rows if (r["i"], r["j"]) == p], axis=0) for p in places}
design, seen = [], []
for r in rows:
    p = (r["i"], r["j"]); a, b, g = angles[p] * arcsec
    z = turn(2, g); zy = z @ turn(1, b); e = zy @ turn(0, a)
    axes = np.column_stack([zy @ [1, 0, 0], z @ [0, 1, 0], [0, 0, 1]])
    nominal = turn(2, np.radians(90 * (p[1] - 1))) @ turn(0, np.radians(90 * (p[0] - 1)))
    row = np.zeros((3, 3 * len(places) + 6 * (len(runs) - 1)))
    k = places.index(p); row[:, 3 * k:3 * k + 3] = np.eye(3)
    effect = np.hstack([np.eye(3), e @ nominal]); q = runs.index(r["run"])
    for other in range(len(runs) - 1):
        sign = 1 if q == other else -1 if q == len(runs) - 1 else 0
        at = 3 * len(places) + 6 * other; row[:, at:at + 6] = sign * effect
    design.append(row)
    seen.append(axes @ (np.array([r["alpha_arcsec"], r["beta_arcsec"], r["gamma_arcsec"]]) - angles[p]))
design, seen = np.vstack(design), np.concatenate(seen)
found, _, rank, _ = np.linalg.lstsq(design, seen, rcond=None)
assert rank == design.shape[1]
rest = seen - design @ found
cov = np.linalg.inv(design.T @ design)
means = {f"{int(p[0])},{int(p[1])}": list(angles[p] + found[3 * k:3 * k + 3]) for k, p in enumerate(places)}
share = {f"{int(p[0])},{int(p[1])}": float(cov[3 * k + 2, 3 * k + 2]) * len(runs) for k, p in enumerate(places)}
print(json.dumps({"means": means, "share": share, "s": float(np.sqrt(rest @ rest / (len(seen) - rank)))}))
"##;

/// Expected: NumPy's least squares on the incomplete readings. The certificate states four digits of u, and its angles at
/// the last of these; for one mean reading alone, u is that of one run less.
#[test]
fn an_excluded_reading_is_left_out_and_recorded() {
    let folder = folder();
    // A blunder that no certification would accept.
    let bad = replaced("2,3,4,", 4, |_| "9999".into());
    fs::write(folder.path("bad.csv"), &bad).unwrap();
    let (code, _, said) = folder.said("certify bad.csv --stand header.yaml -o bad.yaml");
    assert!(code == 2 && said.contains("check the digits"), "{said}");
    for (name, exclude, left_out, runs) in [
        ("one", "--exclude 2,3,4 --why blunder", "[[2, 3, 4]]", 5),
        ("two", "--exclude 2,3,4 --why blunder --exclude 1,2,1 --why vibration", "[[2, 3, 4], [1, 2, 1]]", 5),
        ("same", "--exclude 2,3,4 --exclude 2,3,1 --why blunder", "[[2, 3, 4], [2, 3, 1]]", 5),
        ("run", "--exclude 4 --why blunder", "[[4]]", 4),
    ] {
        let (code, text, said) =
            folder.said(&format!("certify bad.csv --stand header.yaml -o {name}.yaml --format json {exclude}"));
        assert_eq!(code, 0, "{said}");
        let found: serde_json::Value = serde_json::from_str(&text).unwrap();
        let stand = &found["certification"]["stand"];
        let evidence = &stand["certificate"]["evidence"];
        assert_eq!((&evidence["runs"], evidence["excluded"][0]["run"].as_u64()), (&runs.into(), Some(4)));
        assert_eq!(evidence["excluded"][0]["why"], "blunder");
        let mut python = programs::python();
        python.args(["-c", WITHOUT]).arg(folder.path("bad.csv")).arg(left_out);
        let due: serde_json::Value = serde_json::from_str(&programs::output(python)).unwrap();
        let s = stand["certificate"]["repeatability_arcsec"].as_f64().unwrap();
        assert!((s / due["s"].as_f64().unwrap() - 1.0).abs() < 1e-3, "{name}: {s}, {due}");
        let positions = stand["positions"].as_array().unwrap();
        let u = |at: &serde_json::Value| at["u_gamma_arcsec"].as_f64().unwrap();
        let whole = u(&positions[0]);
        for at in positions {
            let key = format!("{},{}", at["i"], at["j"]);
            for (axis, angle) in ["alpha", "beta", "gamma"].iter().enumerate() {
                let (mean, due) = (&at[format!("{angle}_arcsec")], &due["means"][&key][axis]);
                let apart = (mean.as_f64().unwrap() - due.as_f64().unwrap()).abs();
                assert!(apart < 1e-3, "{name}, {key}: {mean}, {due}");
            }
            let share = due["share"][&key].as_f64().unwrap();
            assert!((u(at) / whole / share.sqrt() - 1.0).abs() < 5e-3, "{name}, {key}: {}, {share}", u(at) / whole);
        }
        // The file is read again, and a passport of it says what was excluded.
        let text = fs::read_to_string(folder.path(&format!("{name}.yaml"))).unwrap();
        assert!(text.contains("    excluded:\n      - {"), "{text}");
    }
}

#[test]
fn bad_exclusions_are_refused() {
    let folder = folder();
    for (exclude, code, words) in [
        ("--exclude 2,3,9 --why x", 2, "no reading of position (2, 3) in run 9 to exclude"),
        ("--exclude 9 --why x", 2, "no reading of run 9 to exclude"),
        ("--exclude 2,3 --why x", 2, "i,j,run for a reading"),
        ("--exclude 2,3,4", 2, "--why"),
        ("--why x", 2, "--exclude"),
        ("--exclude 2,3,4 --why x --why y", 2, "found 2 --why for 1 --exclude"),
        ("--exclude 2,3,1 --exclude 2,3,2 --exclude 2,3,3 --exclude 2,3,4 --why x", 2, "1 readings of position (2, 3)"),
        ("--exclude 1 --exclude 2 --exclude 3 --exclude 4 --why x", 1, "one run"),
        ("--exclude 2,1,3 --exclude 2,2,3 --exclude 2,3,3 --exclude 2,4,3 --why x", 1, "exclude the whole run"),
    ] {
        let (found, _, said) = folder.said(&format!("certify angles.csv --stand header.yaml -o out.yaml {exclude}"));
        assert!(found == code && said.contains(words), "{exclude}: {found} {said}");
        assert!(!folder.path("out.yaml").exists());
    }
    // The same readings with other exclusions are other angles.
    assert_eq!(folder.said("certify angles.csv --stand header.yaml -o stand.yaml").0, 0);
    let again = "angles.csv --stand header.yaml -o stand.yaml --force --exclude 2,3,4 --why x";
    let (code, _, said) = folder.said(&format!("certify {again}"));
    assert!(code == 1 && said.contains("already states other angles"), "{said}");
}

/// A reading that was not taken: the advice is followed, and the file is then certified.
#[test]
fn the_advice_for_an_empty_cell_works() {
    let folder = folder();
    for cell in ["", "NaN"] {
        fs::write(folder.path("blank.csv"), replaced("2,3,4,", 4, |_| cell.into())).unwrap();
        let (code, _, said) = folder.said("certify blank.csv --stand header.yaml -o blank.yaml");
        assert!(code == 2 && said.contains("exclude it with --exclude 2,3,4 and --why"), "{said}");
        let (code, _, said) =
            folder.said("certify blank.csv --stand header.yaml -o blank.yaml --exclude 2,3,4 --why skipped --force");
        assert_eq!(code, 0, "{said}");
    }
    let row = |line: &str| if line.starts_with("2,3,4,") { "2,3,4,,,\n".to_owned() } else { format!("{line}\n") };
    let text = fs::read_to_string(folder.path("angles.csv")).unwrap();
    fs::write(folder.path("empty.csv"), text.lines().map(row).collect::<String>()).unwrap();
    let (code, _, said) =
        folder.said("certify empty.csv --stand header.yaml -o empty.yaml --exclude 2,3,4 --why skipped");
    assert_eq!(code, 0, "{said}");
}

/// Expected: the record that was written with the certificate, with its exclusion; a stand file that was changed by hand gets none.
#[test]
fn a_certificate_gets_its_record_later() {
    let folder = folder();
    let certify = "angles.csv --stand header.yaml --exclude 2,3,4 --why lamp -o stand.yaml --report first.html";
    assert_eq!(folder.said(&format!("certify {certify}")).0, 0);
    let (code, stdout, said) = folder.said("certify angles.csv --against stand.yaml --report later.html");
    assert!(code == 0 && stdout.contains("CERTIFIED"), "{stdout}{said}");
    let record = |name: &str| fs::read_to_string(folder.path(name)).unwrap();
    assert_eq!(record("first.html"), record("later.html"));
    let (stand, other) = (record("stand.yaml"), "alpha_arcsec: 9");
    fs::write(folder.path("stand.yaml"), stand.replacen("alpha_arcsec: ", other, 1)).unwrap();
    let (code, _, said) = folder.said("certify angles.csv --against stand.yaml --report changed.html");
    assert!(code == 1 && said.contains("was changed by hand") && !folder.path("changed.html").exists(), "{said}");
}
