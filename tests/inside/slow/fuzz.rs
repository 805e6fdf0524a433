//! The fuzz targets without a fuzzer: their seeds, whatever was ever found to fail, and a fixed number of random changes.
//!
//! With coverage to guide it, `tests/fuzz/run` goes on from here; see `tests/fuzz/README.md`.

use super::alone::alone;
use crate::fuzzing::{TARGETS, Target, mutation};
use dtg_passport::passport::issue::{Issue, draft};
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::statistics::random::Stream;
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use std::fs;
use std::path::Path;

/// Executions of each target: some seconds in all.
const EXECUTIONS: usize = 4_000;

/// The target of this name.
fn of(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).unwrap()
}

/// The files of a folder beside this one, in the order of their names.
fn files(folder: &str, target: &Target) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz").join(folder).join(target.name);
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| (path.display().to_string(), fs::read(&path).unwrap())).collect()
}

#[test]
fn every_seed_is_accepted_and_everything_found_is_handled() {
    alone(|| {
        for target in &TARGETS {
            let seeds = files("seeds", target);
            assert!(!seeds.is_empty(), "{} has no seeds", target.name);
            for (name, bytes) in seeds {
                assert!(target.hold(&bytes), "{name} is refused");
            }
            for (name, bytes) in files("found", target) {
                println!("{name}: accepted: {}", target.hold(&bytes));
            }
        }
    });
}

/// What was accepted is changed again, so that changes add up.
#[test]
fn random_changes() {
    alone(|| {
        for target in &TARGETS {
            let mut pool: Vec<Vec<u8>> = files("seeds", target).into_iter().map(|(_, bytes)| bytes).collect();
            let mut stream = Stream::new(1);
            let longest = 2 * pool.iter().map(Vec::len).max().unwrap_or(0);
            let mut accepted = 0;
            for _ in 0..EXECUTIONS {
                let mut bytes = pool[stream.below(pool.len())].clone();
                mutation::mutate(&mut bytes, &mut stream, longest);
                if target.hold(&bytes) {
                    accepted += 1;
                    if pool.len() < 500 {
                        pool.push(bytes);
                    }
                }
            }
            println!("{}: {accepted} of {EXECUTIONS} accepted", target.name);
            // Without the key nothing is accepted but what its owner wrote.
            assert!(accepted > 0 || target.name == "passport", "{}: no change is ever accepted", target.name);
            assert!(accepted < EXECUTIONS, "{}: no change is ever refused", target.name);
        }
    });
}

/// Texts of many small things, up to the largest size: what the bound on memory is about.
const CROWDS: [(&str, &str, &str, &str); 32] = [
    // target, before, again and again, after
    ("stand", "a: [", "~,", "]\n"),
    ("stand", "a: {", "~,", "}\n"),
    ("stand", "a: [", "'',", "]\n"),
    ("stand", "a: [", "[],", "]\n"),
    ("stand", "a: [x\"", ",", "]\n"),
    ("stand", "a: {", "a: ,", "}\n"),
    ("stand", "a: {", "? ,", "}\n"),
    ("stand", "", "a:\n", ""),
    ("stand", "", "- - \n", ""),
    ("stand", "", "-\n", ""),
    ("stand", "", "- ", "\n"),
    ("stand", "", "? a\n", ""),
    ("stand", "a: >\n", "  x\n", ""),
    ("stand", "a: [", "0.000, ", "]\n"),
    ("stand", "a: &a 1\nb: [", "*a,", "]\n"),
    (
        "stand",
        "positions:\n",
        "- {i: 1, j: 1, theta_deg: 0, phi_deg: 0, alpha_arcsec: 0, beta_arcsec: 0, gamma_arcsec: 0}\n",
        "",
    ),
    ("content", "a: [", "0,", "]\n"),
    ("content", "", "a: 0.0\n", ""),
    ("content", "vectors:\n", "  - {i: 1, j: 1, specific_force_g: [0.0, 0.0], specific_force_z_g: 0.0}\n", ""),
    ("register", "passports:\n", "  - {id: \"a\", sha256: \"\", reason: \"b\"}\n", ""),
    ("currents", "i,j,jx_ma,jy_ma\n", "1,1,0.1,.1\n", ""),
    ("currents", "i,j,jx_ma,jy_ma\n", "0,0,0,0\n", ""),
    ("currents", "i,j,jx_ma,jy_ma\n", ",\n", ""),
    ("currents", "i,j,jx_ma,jy_ma\n", "0,", "\n"),
    ("currents", "", "a,", "\n"),
    ("angles", "i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec\n", "1,1,1,0,0,0\n", ""),
    ("allowed_signers", "", "a\n", ""),
    ("allowed_signers", "a ", "a,", "\n"),
    ("revoked_keys", "", "a\n", ""),
    ("revoked_keys", "SSHKRL\n\0", "\0\0\0\0", ""),
    ("armor", "-----BEGIN SSH SIGNATURE-----\n", "AAAA\n", "-----END SSH SIGNATURE-----\n"),
    ("earlier_result", "{\"not_stated\":[", "\"\",", "]}"),
];

#[test]
fn memory_is_bounded_by_the_input() {
    alone(|| {
        for (name, before, unit, after) in CROWDS {
            for size in [1 << 17, 1 << 18, LARGEST_DOCUMENT_BYTES] {
                let room = size - before.len() - after.len();
                of(name).hold(format!("{before}{}{after}", unit.repeat(room / unit.len())).as_bytes());
            }
        }
    });
}

/// The same for what is good: a stand with as many positions as it may have, and its passport.
#[test]
fn memory_is_bounded_for_good_documents() {
    alone(|| {
        let mut stand = "format: \"dtg-stand/1\"\nstand: {model: \"a\", serial: \"b\"}\n".to_owned();
        stand += "certificate: {number: \"1\", issued: \"2026-01-01\", laboratory: \"x\"}\npositions:\n";
        // As many as a stand may have.
        for j in 1..=256 {
            stand += &format!(
                "  - {{i: 3, j: {j}, theta_deg: 45, phi_deg: {j}, alpha_arcsec: 1, beta_arcsec: 2, gamma_arcsec: 3}}\n"
            );
        }
        assert!(of("stand").hold(stand.as_bytes()));
        let stand = Stand::from_yaml("stand", stand.as_bytes()).unwrap();
        let site = Site::from_yaml("site", b"format: \"dtg-site/1\"\nid: \"c\"\nlatitude_deg: 10\n").unwrap();
        // Positions of one frame angle determine no gyro.
        let order = Issue { allow_uncalibratable: true, ..Issue::first("d", "2026-01-02T00:00:00Z".parse().unwrap()) };
        let passport = draft(&stand, &site, &order).unwrap();
        assert_eq!(passport.content().positions.len(), 256);
        assert!(of("content").hold(passport.payload().as_bytes()));
    });
}

/// Five thousand runs of eight positions, a line each: the largest table that is one.
#[test]
fn many_runs_are_read_soon() {
    alone(|| {
        let mut table = "i,j,run,alpha_arcsec,beta_arcsec,gamma_arcsec\n".to_owned();
        for run in 1..=5_000 {
            for (i, j) in [(1, 1), (1, 2), (1, 3), (1, 4), (2, 1), (2, 2), (2, 3), (2, 4)] {
                table += &format!("{i},{j},{run},{},.{run:05},{}\n", run % 7, run % 11);
            }
        }
        assert!(table.len() < LARGEST_DOCUMENT_BYTES && of("angles").hold(table.as_bytes()));
    });
}
