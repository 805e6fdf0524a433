//! `history`: the lines and their tests against SciPy, and the picture as a drawing.

use crate::place::{Place, example};
use crate::programs::{self, with_angles};

/// Reads the passports with PyYAML, and fits and tests every deviation with SciPy; prints the largest relative difference
/// from the JSON of the program, and the number of fits.
const COMPARE: &str = r#"
import json, sys, datetime, yaml, scipy.stats, scipy.optimize
found = json.load(open(sys.argv[1]))
series = {}
for path in sys.argv[2:]:
    text = open(path, encoding="utf-8").read().split("\nsignature: |")[0] + "\n"
    passport = yaml.safe_load(text)
    c = passport["certificate"]
    day = datetime.date.fromisoformat(c["performed"])
    type_b = sum(line["u_arcsec"] ** 2 for line in c.get("type_b", []) if line["acts_on"] != "position")
    common = c["common_platform_arcsec"] ** 2 + c["common_base_arcsec"] ** 2
    for at in passport["positions"]:
        for angle in ("alpha", "beta", "gamma"):
            own = at[f"u_{angle}_arcsec"] ** 2
            doubt = own ** 2 / at["degrees_of_freedom"] + (common - type_b) ** 2 / (3 * (c["evidence"]["runs"] - 1))
            point = (day, at[f"{angle}_arcsec"], own + common, (own + common) ** 2 / doubt)
            series.setdefault((at["i"], at["j"], angle), []).append(point)
fits = {}
for key, points in series.items():
    first = min(day for day, *_ in points)
    x = [(day - first).days / 365.2425 for day, *_ in points]
    w = [1 / variance for _, _, variance, _ in points]
    mean = sum(a * b for a, b in zip(w, x)) / sum(w)
    spread = sum(a * (b - mean) ** 2 for a, b in zip(w, x))
    c = [a * (b - mean) / spread for a, b in zip(w, x)]
    slope = sum(a * y for a, (_, y, *_) in zip(c, points))
    variance = sum(a * a * v for a, (_, _, v, _) in zip(c, points))
    freedom = variance ** 2 / sum((a * a * v) ** 2 / n for a, (_, _, v, n) in zip(c, points))
    level = sum(a * y for a, (_, y, *_) in zip(w, points)) / sum(w)
    rest = sum(a * (y - level - slope * (b - mean)) ** 2 for a, b, (_, y, *_) in zip(w, x, points))
    p = 2 * scipy.stats.t.sf(abs(slope) / variance ** 0.5, freedom)
    fits[key] = [slope, variance ** 0.5, freedom, p, rest]
order = sorted(fits, key=lambda key: fits[key][3])
largest = 0
for before, key in enumerate(order):
    largest = max(largest, min(1, fits[key][3] * (len(order) - before)))
    fits[key].append(largest)
worst = 0
for at in found["drift"]["deviations"]:
    mine = [at["slope_arcsec_per_year"], at["u_slope_arcsec_per_year"], at["degrees_of_freedom"], at["probability"],
            at["chi_square"]["value"], at["corrected_probability"]]
    due = fits[at["i"], at["j"], at["angle"]]
    worst = max(worst, *(abs(a / b - 1) for a, b in zip(mine, due)))
def detectable(slope, u, freedom, *_):
    critical = scipy.stats.f.isf(0.01 / len(order), 1, freedom)
    missed = lambda c: 0.95 - scipy.stats.ncf.sf(critical, 1, freedom, c * c)
    return u * scipy.optimize.brentq(missed, 1, 12, xtol=1e-12)
worst = max(worst, abs(found["drift"]["detectable_arcsec_per_year"] / max(detectable(*fits[key]) for key in order) - 1))
print(worst, len(order), len(fits) - len(found["drift"]["deviations"]), found["drift"]["drifts"], order[0])
"#;

/// The readings of the guide with the angle of one position shifted and all others slightly different.
fn readings(year: u32) -> String {
    with_angles(&example("docs/angles.csv"), |line, row, column, angle| {
        let drift = if line.starts_with("2,3,") && column == 5 { 4.0 * f64::from(year) } else { 0.0 };
        angle + f64::from((row * 7 + column * 5 + year * 11) % 13) / 13.0 + drift
    })
}

/// Expected: SciPy, from the passports as PyYAML reads them. The program also takes the angles between the axes of the
/// deviations into account, which changes u by 1e-6 for the arc minutes of this stand.
#[test]
fn the_drift_is_what_scipy_finds() {
    let folder = Place::of(&[
        ("tests/cmd/files/allowed_signers", "allowed_signers"),
        ("tests/cmd/files/sites/here.yaml", "here.yaml"),
        (programs::KEY, "key"),
    ]);
    let header = example("docs/header.yaml");
    let mut passports = Vec::new();
    for (revision, year) in (1..).zip([0, 2, 3, 6]) {
        let date = format!("{}-03-0{revision}", 2016 + year);
        let edited: String = header
            .lines()
            .filter(|line| !line.contains("valid_until"))
            .map(|line| match line.trim_start().split(':').next() {
                Some("number") => format!("  number: \"C-{year}\"\n"),
                Some("issued") => format!("  issued: \"{date}\"\n"),
                Some("performed") => format!("  performed: \"{date}\"\n"),
                Some("datum") => {
                    "  type_b: [{source: \"scale\", acts_on: \"platform\", u_arcsec: 0.3}]\ndatum:\n".to_owned()
                }
                _ => format!("{line}\n"),
            })
            .collect();
        folder.write("header.yaml", edited);
        folder.write("angles.csv", readings(year));
        folder.good(&format!("certify angles.csv --stand header.yaml -o stand-{year}.yaml"));
        let sign = format!("--key key --identity factory --issued-at {date}T12:00:00Z");
        if revision == 1 {
            folder.good(&format!("issue stand-{year}.yaml --site here.yaml {sign}"));
        } else {
            let old = revision - 1;
            let trust = "--trust allowed_signers --reason certified";
            let passport = format!("passports/SPS-2/0017/here-{old}.yaml");
            folder.good(&format!("reissue {passport} --stand stand-{year}.yaml {sign} {trust}"));
        }
        passports.push(folder.path(format!("passports/SPS-2/0017/here-{revision}.yaml")));
    }
    let history = "history SPS-2/0017 --trust allowed_signers --time 2026-11-21";
    folder.write("found.json", folder.good(&format!("{history} --format json -o years.svg")));
    let found = folder.path("found.json");
    let compared = programs::output(programs::python().args(["-c", COMPARE]).arg(found).args(&passports));
    let words: Vec<&str> = compared.trim().splitn(5, ' ').collect();
    assert!(words[0].parse::<f64>().unwrap() < 1e-5, "{compared}");
    assert_eq!(words[1..], ["24", "0", "True", "(2, 3, 'gamma')"], "{compared}");
    // The picture is well-formed XML, with a mark for each value and each certificate, and one in the legend of each.
    let count = "import sys, xml.dom.minidom as x; d = x.parse(sys.argv[1]); \
                 print(len(d.getElementsByTagName('circle')), 'drifts' in d.toxml())";
    let counted = programs::output(programs::python().args(["-c", count]).arg(folder.path("years.svg")));
    assert_eq!(counted.trim(), format!("{} True", 24 * 4 + 4 + 2));
}

/// Returns the widths of the bars of a class, without that of the legend.
fn widths(svg: &str, class: &str) -> Vec<f64> {
    let bars = svg.split("<rect ").filter(|tag| tag.starts_with(&format!("class=\"{class}\"")));
    let width = |tag: &str| tag.split_once("width=\"").unwrap().1.split_once('"').unwrap().0.parse().unwrap();
    bars.skip(1).map(width).collect()
}

/// Expected by hand: both passports are of 2026-11-09, 09:00, which is 295.6 days before 2027-09-01; 428 days later, at the
/// end of 2028-11-01, the certificate expires. A bar is long as the time, but for the leap year: 0.3 %.
#[test]
fn a_bar_continues_paler_until_its_passport_expires() {
    let folder = Place::empty();
    let [passports, signers] = ["passports", "docs/allowed_signers"].map(programs::project);
    let history = format!("history SPS-2/0017 --passports {} --trust {}", passports.display(), signers.display());
    let svg_at = |time: &str| {
        folder.good(&format!("{history} --time {time} -o {time}.svg"));
        folder.read(format!("{time}.svg"))
    };
    let during = svg_at("2027-09-01");
    let (past, ahead) = (widths(&during, "bar"), widths(&during, "grid"));
    assert_eq!([past.len(), ahead.len()], [2, 2]);
    for (past, ahead) in past.iter().zip(&ahead) {
        assert!((past / ahead / (295.6 / 428.0) - 1.0).abs() < 0.005, "{past} {ahead}");
    }
    assert!(during.contains("in force, expires 2028-11-01T23:59:59Z") && during.contains(">as of 2027-09-01<"));
    let after = svg_at("2029-01-01");
    assert_eq!([widths(&after, "bar").len(), widths(&after, "grid").len()], [2, 0]);
}
