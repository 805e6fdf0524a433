//! `certify` on the command line: what it writes, and every way in which its input is refused.

use crate::place::{Place, example};
use crate::programs;
use serde_json::Value;

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
    let lines = example("docs/angles.csv");
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
    folder.good("certify angles.csv --stand header.yaml -o stand.yaml");
    let (code, text, _) = folder.said("certify check.csv --against stand.yaml");
    assert!(code == 1 && text.contains("Position (2, 3) has changed"), "{text}");
    let found = folder.json("certify check.csv --against stand.yaml", 1);
    assert_eq!(found["comparison"]["same_stand"], false);
    assert!(found["not_certified"].as_str().unwrap().starts_with("found one run"));
    // Those of the certificate, saved anew, show nothing new; two of its runs agree as closely as another measurement.
    folder.write("anew.csv", folder.read("angles.csv").replace('\n', "\r\n"));
    for name in ["angles.csv", "anew.csv"] {
        let (code, text, _) = folder.said(&format!("certify {name} --against stand.yaml"));
        assert!(code == 1 && text.starts_with("◐ UNDECIDED"), "{text}");
    }
    let two_runs = |line: &&str| line.starts_with(['#', 'i']) || matches!(line.split(',').nth(2), Some("1" | "2"));
    let two_runs: String = folder.read("angles.csv").lines().filter(two_runs).map(|line| format!("{line}\n")).collect();
    folder.write("two.csv", two_runs);
    let found = folder.json("certify two.csv --against stand.yaml", 0);
    assert_eq!(found["comparison"]["same_stand"], true);
    assert_eq!(found["certification"]["stand"]["positions"].as_array().unwrap().len(), 8);
    folder.write("header.yaml", folder.read("header.yaml").replace("0017", "0018"));
    let said = folder.refused("certify check.csv --stand header.yaml --against stand.yaml", "SPS-2 0017");
    assert!(said.contains("SPS-2 0018"), "{said}");
}

/// Other angles never go under a number that is there, --force or not.
#[test]
fn a_number_keeps_its_angles() {
    let folder = folder();
    folder.good("certify angles.csv --stand header.yaml -o stand.yaml");
    let old = folder.read("stand.yaml");
    folder.write("new.csv", replaced("1,1,", 3, |text| format!("{}", text.parse::<f64>().unwrap() + 3.0)));
    for arguments in [
        "new.csv --against stand.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml",
        "new.csv --against stand.yaml --stand header.yaml -o new.yaml --force",
        "new.csv --stand header.yaml -o stand.yaml --force",
    ] {
        let said = folder.refused(&format!("certify {arguments}"), "certificate C-2026-0143");
        assert!(said.contains("position (1, 1)"), "{said}");
        assert!(!folder.path("new.yaml").exists() && folder.read("stand.yaml") == old, "{arguments}");
    }
    // The same angles under the old number, and no header that says when: nothing to write.
    folder.ends("certify angles.csv --against stand.yaml -o new.yaml", 2, "--stand HEADER.yaml");
    folder.change("header.yaml", "C-2026-0143", "C-2027-0007");
    let (code, _, said) = folder.said("certify new.csv --against stand.yaml --stand header.yaml -o new.yaml");
    assert!(said.contains("wrote new.yaml"), "{code} {said}");
}

#[test]
fn what_is_odd_is_said() {
    let folder = folder();
    folder.change("header.yaml", "temperature_c: 20.0", "temperature_c: 293.15");
    let text = programs::in_one_line(&folder.good("certify angles.csv --stand header.yaml -o stand.yaml"));
    assert!(text.contains("WARNING: temperature_c is 293.15") && text.contains("in kelvin"), "{text}");
    folder.write("r.csv", replaced("2,1,", 3, |text| format!("{:.1}", text.parse::<f64>().unwrap() + 67_833.0)));
    let text = folder.good("certify r.csv --stand header.yaml -o odd.yaml");
    assert!(text.contains("alpha_arcsec of position (2, 1) is 678"), "{text}");
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
    folder.write("bad.csv", replaced("2,3,4,", 4, |_| "9999".into()));
    folder.ends("certify bad.csv --stand header.yaml -o bad.yaml", 2, "check the digits");
    for (name, exclude, left_out, runs) in [
        ("one", "--exclude 2,3,4 --why blunder", "[[2, 3, 4]]", 5),
        ("two", "--exclude 2,3,4 --why blunder --exclude 1,2,1 --why vibration", "[[2, 3, 4], [1, 2, 1]]", 5),
        ("same", "--exclude 2,3,4 --exclude 2,3,1 --why blunder", "[[2, 3, 4], [2, 3, 1]]", 5),
        ("run", "--exclude 4 --why blunder", "[[4]]", 4),
    ] {
        let found = folder.json(&format!("certify bad.csv --stand header.yaml -o {name}.yaml {exclude}"), 0);
        let stand = &found["certification"]["stand"];
        let evidence = &stand["certificate"]["evidence"];
        assert_eq!((&evidence["runs"], evidence["excluded"][0]["run"].as_u64()), (&runs.into(), Some(4)));
        assert_eq!(evidence["excluded"][0]["why"], "blunder");
        let bad = folder.path("bad.csv");
        let due = programs::output(programs::python().args(["-c", WITHOUT]).arg(bad).arg(left_out));
        let due: Value = serde_json::from_str(&due).unwrap();
        let s = stand["certificate"]["repeatability_arcsec"].as_f64().unwrap();
        assert!((s / due["s"].as_f64().unwrap() - 1.0).abs() < 1e-3, "{name}: {s}, {due}");
        let positions = stand["positions"].as_array().unwrap();
        let u = |at: &Value| at["u_gamma_arcsec"].as_f64().unwrap();
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
        let text = folder.read(format!("{name}.yaml"));
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
        folder.ends(&format!("certify angles.csv --stand header.yaml -o out.yaml {exclude}"), code, words);
        assert!(!folder.path("out.yaml").exists());
    }
    // The same readings with other exclusions are other angles.
    let certify = "certify angles.csv --stand header.yaml -o stand.yaml";
    folder.good(certify);
    folder.refused(&format!("{certify} --force --exclude 2,3,4 --why x"), "already states other angles");
}

/// A reading that was not taken: the advice is followed, and the file is then certified.
#[test]
fn the_advice_for_an_empty_cell_works() {
    let folder = folder();
    let certify = "certify blank.csv --stand header.yaml -o blank.yaml --force";
    let excluded = format!("{certify} --exclude 2,3,4 --why skipped");
    for cell in ["", "NaN"] {
        folder.write("blank.csv", replaced("2,3,4,", 4, |_| cell.into()));
        folder.ends(certify, 2, "exclude it with --exclude 2,3,4 and --why");
        folder.good(&excluded);
    }
    let text = folder.read("angles.csv");
    let row = text.lines().find(|line| line.starts_with("2,3,4,")).unwrap();
    folder.write("blank.csv", text.replace(row, "2,3,4,,,"));
    folder.good(&excluded);
}

/// Expected: the record that was written with the certificate, with its exclusion; a stand file that was changed by hand gets none.
#[test]
fn a_certificate_gets_its_record_later() {
    let folder = folder();
    let certify = "angles.csv --stand header.yaml --exclude 2,3,4 --why lamp -o stand.yaml --report first.html";
    folder.good(&format!("certify {certify}"));
    let said = folder.good("certify angles.csv --against stand.yaml --report later.html");
    assert!(said.contains("CERTIFIED"), "{said}");
    assert_eq!(folder.read("first.html"), folder.read("later.html"));
    folder.change("stand.yaml", "alpha_arcsec: ", "alpha_arcsec: 9");
    folder.refused("certify angles.csv --against stand.yaml --report changed.html", "was changed by hand");
    assert!(!folder.path("changed.html").exists());
}
