//! Random fleet for the benchmarks: stands with certified deviations, typical sites, and tools for measuring time.

// Every benchmark is a program of its own, and none uses all of this.
#![allow(dead_code)]

use dtg_passport::coefficients::EIGHT_POSITIONS;
use dtg_passport::earth::normal_gravity_m_per_s2;
use dtg_passport::passport::issue::Issue;
use dtg_passport::simulation::Stream;
use dtg_passport::site::{Deflection, Site, SiteUncertainty};
use dtg_passport::stand::{Certificate, CertifiedPosition, Datum, Identity, Stand};
use dtg_passport::text::Identifier;
use jiff::civil::date;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

pub const ISSUER: &str = "factory@example.org";
pub const ISSUED_AT: &str = "2026-11-09T08:00:00Z";

/// Creates low-cost stands: deviations within 5 arcminutes, rounded to 0.1 arcseconds, everything certified.
pub fn stands(count: usize) -> Vec<Stand> {
    let mut stream = Stream::new(1);
    (0..count).map(|number| stand(number, &mut stream)).collect()
}

fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

fn identifier(text: &str) -> Identifier {
    text.parse().expect("an identifier")
}

fn stand(number: usize, stream: &mut Stream) -> Stand {
    let text = |text: &str| Some(text.to_owned());
    let positions = EIGHT_POSITIONS.map(|(index, theta_deg, phi_deg)| CertifiedPosition {
        i: index.i,
        j: index.j,
        theta_deg,
        phi_deg,
        alpha_arcsec: tenths(stream.within(300.0)),
        beta_arcsec: tenths(stream.within(300.0)),
        gamma_arcsec: tenths(stream.within(300.0)),
        u_alpha_arcsec: Some(1.2),
        u_beta_arcsec: Some(1.2),
        u_gamma_arcsec: Some(2.0),
        degrees_of_freedom: Some(4.0),
    });
    Stand {
        stand: Identity {
            manufacturer: text("Example Stand Works"),
            model: identifier("SPS-2"),
            serial: identifier(&format!("{number:05}")),
            configuration: text("A"),
            name: text("Two-axis test stand"),
            customer: None,
        },
        certificate: Certificate {
            number: format!("C-2026-{number:05}"),
            issued: date(2026, 11, 2),
            performed: Some(date(2026, 10, 29)),
            received: None,
            valid_until: Some(date(2028, 11, 1)),
            valid_until_basis: text("agreed with the customer"),
            laboratory: "Example Stand Works, angle laboratory".to_owned(),
            address: None,
            authorized_by: None,
            accreditation: None,
            method: text("two autocollimators on a mirror cube at the gyro seat, levelled base, five runs"),
            traceability: text("autocollimators calibrated against the national angle standard"),
            temperature_c: Some(20.0),
            temperature_range_c: Some([18.0, 22.0]),
            repeatability_arcsec: Some(1.5),
            repeatability_degrees_of_freedom: Some(32.0),
            common_platform_arcsec: Some(0.8),
            common_base_arcsec: Some(0.8),
            cmc_arcsec: None,
            references: None,
            type_b: None,
            evidence: None,
        },
        datum: Some(Datum {
            level: text("upper face of the base plate"),
            azimuth: text("mirror M1 on the base, facing north"),
            gyro_seat: text("platform face P with pins 1 and 2 along x"),
        }),
        positions: positions.to_vec(),
    }
}

/// Creates sites between 70 degrees south and north; every fourth has a measured deflection and gravity.
pub fn sites(count: usize) -> Vec<Site> {
    let mut stream = Stream::new(2);
    (0..count)
        .map(|number| {
            let surveyed = number % 4 == 0;
            let degrees = |value: f64| (1e6 * value).round() / 1e6;
            let latitude_deg = degrees(stream.within(70.0));
            let longitude_deg = degrees(stream.within(180.0));
            let height_m = tenths(200.0 + stream.within(200.0));
            let normal_gravity = normal_gravity_m_per_s2(latitude_deg, height_m);
            Site {
                id: identifier(&format!("laboratory-{number:05}")),
                name: Some(format!("Calibration laboratory {number}, building 3, pillar 2")),
                latitude_deg: Some(latitude_deg),
                astronomic_latitude_deg: None,
                longitude_deg: Some(longitude_deg),
                height_m: Some(height_m),
                deflection_arcsec: surveyed.then(|| Deflection {
                    xi: tenths(stream.within(10.0)),
                    eta: tenths(stream.within(10.0)),
                    u: Some(0.5),
                }),
                gravity_m_per_s2: surveyed.then(|| degrees(normal_gravity + stream.within(0.002))),
                gravity_u_m_per_s2: surveyed.then_some(1e-6),
                azimuth_mark: None,
                frame_axis_azimuth_deg: None,
                valid_within_deg_per_h: None,
                uncertainty: Some(SiteUncertainty {
                    latitude_arcsec: Some(1.0),
                    azimuth_arcsec: Some(30.0),
                    level_arcsec: Some(5.0),
                }),
                source: Some("levelled and surveyed by the laboratory, report of 2026".to_owned()),
            }
        })
        .collect()
}

/// Returns the order for revision 1 of every passport.
pub fn order() -> Issue {
    Issue::first(ISSUER, ISSUED_AT.parse().expect("a time"))
}

/// Secret of the benchmark's key.
pub const SECRET: [u8; 32] = [7; 32];

/// Returns the benchmark's key in the format of OpenSSH.
pub fn openssh_key() -> String {
    let pair = ssh_key::private::Ed25519Keypair::from_seed(&SECRET);
    let key = ssh_key::PrivateKey::from(pair);
    key.to_openssh(ssh_key::LineEnding::LF).expect("a key").to_string()
}

/// Writes the benchmark's key to a file, as a factory would store it.
pub fn write_key(path: &Path) -> io::Result<()> {
    let mut options = File::options();
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.write(true).create_new(true).open(path)?.write_all(openssh_key().as_bytes())
}

/// Does `pieces` pieces of work, each once, on `threads` threads.
pub fn on_threads(threads: usize, pieces: usize, work: impl Fn(usize) + Sync) {
    let next = AtomicUsize::new(0);
    let worker = || {
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= pieces {
                return;
            }
            work(piece);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(worker);
        }
        worker();
    });
}

/// Time that some work took, in seconds.
#[derive(Debug, Clone, Copy, Default)]
pub struct Time {
    /// Wall-clock time.
    pub wall: f64,
    /// CPU time of this process and of the child processes that it waited for: least affected by other load. Resolution
    /// 0.01 s (Linux).
    pub processor: f64,
    /// Part of the CPU time in user mode: the program's own work.
    pub user: f64,
}

/// Does some work and returns the time that it took.
pub fn timed(work: impl FnOnce()) -> Time {
    let (start, [user, system]) = (Instant::now(), processor_seconds());
    work();
    let (wall, used) = (start.elapsed().as_secs_f64(), processor_seconds());
    Time { wall, processor: used[0] + used[1] - user - system, user: used[0] - user }
}

/// Returns the CPU time of this process and of its finished children in seconds: user, system.
fn processor_seconds() -> [f64; 2] {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the program's name in brackets: state, ten numbers, then ticks: user and system, own and of children.
    let numbers = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11);
    let ticks: Vec<f64> = numbers.take(4).map(|ticks| ticks.parse().unwrap_or(f64::NAN)).collect();
    let [user, system, user_waited_for, system_waited_for] = ticks[..] else { return [f64::NAN; 2] };
    [(user + user_waited_for) / TICKS_PER_SECOND, (system + system_waited_for) / TICKS_PER_SECOND]
}

/// Writes a file under a temporary name next to its place and renames it; nothing is synced.
pub fn write_and_rename(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let beside = path.with_extension("tmp");
    File::create_new(&beside)?.write_all(bytes)?;
    fs::rename(beside, path)
}

/// Creates an empty folder for the files of a benchmark, on the disk of the project.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

pub fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Returns the number that follows a command-line option, or `None` if there is none.
pub fn option(name: &str) -> Option<usize> {
    std::env::args().skip_while(|word| word != name).nth(1)?.parse().ok()
}

/// Returns the data that OpenSSH signs instead of the message (PROTOCOL.sshsig), written independently for the
/// benchmark.
pub fn signed_data(sha512: &[u8]) -> Vec<u8> {
    let mut data = b"SSHSIG".to_vec();
    for field in [b"dtg-passport".as_slice(), b"", b"sha512", sha512] {
        data.extend((field.len() as u32).to_be_bytes());
        data.extend(field);
    }
    data
}
