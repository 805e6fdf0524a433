//! What must hold for every reader, whatever bytes it is given.
//!
//! No panic and no hang; memory bounded by 64 × the input + 8 MiB; what is accepted, written again, is accepted again as
//! the same. Each reader has a function of bytes that says whether they were accepted, and panics when something does not
//! hold; [`TARGETS`] names them.

pub mod memory;
pub mod mutation;

use base64ct::{Base64, Encoding};
use dtg_passport::calibration::document::CalibrationDocument;
use dtg_passport::calibration::{Options, Readings, Setup, calibrate};
use dtg_passport::certification::{AngleReadings, Header, certify};
use dtg_passport::coefficients::PositionIndex;
use dtg_passport::dcc::Administrative;
use dtg_passport::document::{SignedText, join};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::issue::{Issue, draft};
use dtg_passport::passport::{FORM, NAMESPACE, Question, Trust, annotations, content, content_from_anyone, verify};
use dtg_passport::register::{self, VerifiedRegister};
use dtg_passport::report::passport as printed;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::text::record::{Document, File};
use dtg_passport::text::{Field, LARGEST_DOCUMENT_BYTES, Unreadable, canonical, rule};
use dtg_passport::trust::{AllowedSigners, PublicKey, RevokedKeys, Signature, SigningKey};
use std::fmt::Debug;
use std::sync::LazyLock;

/// A reader under test.
pub struct Target {
    /// Its name: that of its program in `targets/`, and of its folders in `seeds/` and `found/`.
    pub name: &'static str,
    /// Reads the bytes, and says whether they were accepted.
    reads: fn(&[u8]) -> bool,
}

/// Every reader.
pub const TARGETS: [Target; 19] = [
    Target { name: "stand", reads: stand },
    Target { name: "site", reads: site },
    Target { name: "gyro", reads: gyro },
    Target { name: "laboratory", reads: laboratory },
    Target { name: "dcc", reads: dcc },
    Target { name: "header", reads: header },
    Target { name: "issue", reads: issue },
    Target { name: "content", reads: content },
    Target { name: "passport", reads: passport },
    Target { name: "signed", reads: signed },
    Target { name: "register", reads: of_register },
    Target { name: "armor", reads: armor },
    Target { name: "blob", reads: blob },
    Target { name: "public_key", reads: public_key },
    Target { name: "allowed_signers", reads: allowed_signers },
    Target { name: "revoked_keys", reads: revoked_keys },
    Target { name: "currents", reads: currents },
    Target { name: "angles", reads: angles },
    Target { name: "earlier_result", reads: earlier_result },
];

impl Target {
    /// Reads the bytes within the bound on memory; says whether they were accepted.
    pub fn hold(&self, bytes: &[u8]) -> bool {
        LazyLock::force(&BENCH);
        let (accepted, most) = memory::peak(|| (self.reads)(bytes));
        let bound = memory::bound(bytes.len());
        assert!(most <= bound, "{}: {most} bytes for an input of {}, at most {bound}", self.name, bytes.len());
        accepted
    }
}

/// What the readers are given beside the bytes.
struct Bench {
    key: SigningKey,
    trust: Trust,
    question: Question,
    header: Header,
    site: Site,
    setup: Setup,
}

static BENCH: LazyLock<Bench> = LazyLock::new(|| {
    let key = SigningKey::from_openssh(include_str!("../keys/examples"), None).unwrap();
    let stand = Stand::from_yaml("stand", include_bytes!("../../passports/SPS-2/0017/stand.yaml")).unwrap();
    let site = Site::from_yaml("site", include_bytes!("../../sites/moscow-bmstu.yaml")).unwrap();
    let passport = include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let content = content_from_anyone("passport", passport).unwrap();
    let stated = Setup::stated(&content.certificate, &content.positions, &content.site, &Laboratory::paper());
    Bench {
        trust: Trust::of(AllowedSigners::parse("trust", include_bytes!("../keys/allowed_signers")).unwrap()),
        question: Question::at("2027-06-01T00:00:00Z".parse().unwrap()),
        header: Header::from(&stand),
        setup: stated.unwrap().0,
        key,
        site,
    }
});

/// A refusal has words, not too many of them, and points into the file.
fn refused(error: &Unreadable, bytes: &[u8]) -> bool {
    let words = error.to_string();
    assert!(!words.is_empty() && words.len() < 100_000 + 4 * bytes.len(), "{} bytes of words", words.len());
    let lines = bytes.iter().filter(|byte| **byte == b'\n').count() + 2;
    for at in error.problems().iter().filter_map(|problem| problem.location) {
        assert!((1..=lines).contains(&at.line) && at.column >= 1, "a mistake at {at:?} of {lines} lines");
    }
    false
}

/// A document of the kind that people write: written in its one form, it is read as the same, and that form is stable.
fn document<T: Document + PartialEq + Debug>(
    bytes: &[u8],
    from_yaml: fn(&str, &[u8]) -> Result<T, Unreadable>,
) -> bool {
    let value = match from_yaml("f", bytes) {
        Ok(value) => value,
        Err(error) => return refused(&error, bytes),
    };
    let text = written(&File(value.clone()));
    rule::check("written", text.as_bytes(), LARGEST_DOCUMENT_BYTES).expect("what is written obeys the text rule");
    let again = from_yaml("written", text.as_bytes()).expect("what is written is read");
    assert_eq!(again, value);
    assert_eq!(written(&File(again)), text);
    true
}

fn written<T: Field>(value: &T) -> String {
    canonical::write_bare(value)
}

fn stand(bytes: &[u8]) -> bool {
    document(bytes, Stand::from_yaml)
}

fn site(bytes: &[u8]) -> bool {
    document(bytes, Site::from_yaml)
}

fn gyro(bytes: &[u8]) -> bool {
    document(bytes, GyroType::from_yaml)
}

fn laboratory(bytes: &[u8]) -> bool {
    document(bytes, Laboratory::from_yaml)
}

fn dcc(bytes: &[u8]) -> bool {
    document(bytes, Administrative::from_yaml)
}

fn header(bytes: &[u8]) -> bool {
    document(bytes, Header::from_yaml)
}

/// A stand that can be read, or a site, is refused in words or gives a passport that verifies.
fn issue(bytes: &[u8]) -> bool {
    let bench = &*BENCH;
    let (stand, site) = match (Stand::from_yaml("f", bytes), Site::from_yaml("f", bytes)) {
        (Ok(stand), _) => (stand, bench.site.clone()),
        (_, Ok(site)) => {
            (Stand::from_yaml("stand", include_bytes!("../../passports/SPS-1/0203/stand.yaml")).unwrap(), site)
        }
        (Err(error), _) => return refused(&error, bytes),
    };
    let issued_at = "2026-11-19T09:30:00Z".parse().unwrap();
    let order = Issue { allow_uncalibratable: true, ..Issue::first("examples@dtg-passport.test", issued_at) };
    let draft = match draft(&stand, &site, &order) {
        Ok(draft) => draft,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    let file = draft.sign(&bench.key).expect("what was drafted is signed");
    let answer = verify("f", file.as_bytes(), &bench.trust, &Question::at(issued_at));
    let failed = answer.checks().iter().find(|check| check.passed() == Some(false));
    // A certificate of the future, or one that has ended, is no reason not to make the passport.
    assert!(failed.is_none_or(|check| check.name.as_str() == "in_force"), "{failed:?}");
    true
}

/// The signed part of a file; all of it when there is no signature.
fn payload(bytes: &[u8]) -> Option<&str> {
    let line = b"signature: |\n";
    let end = bytes.windows(line.len()).position(|window| window == line).unwrap_or(bytes.len());
    rule::check("f", &bytes[..end], LARGEST_DOCUMENT_BYTES).ok()
}

/// What may be in a passport: read, shown and calculated with.
fn content(bytes: &[u8]) -> bool {
    let Some(payload) = payload(bytes) else { return false };
    let content = match content::read("f", payload) {
        Ok(content) => content,
        Err(error) => return refused(&error, payload.as_bytes()),
    };
    assert_eq!(rule::differs(payload, &written(&content)), None);
    let written = annotations::payload(&content);
    assert_eq!(content::read("written", &written).as_ref(), Ok(&content));
    assert!(
        !dtg_passport::report::doc::typed(&printed::document(&content, None), dtg_passport::wording::Language::English)
            .is_empty()
    );
    let _ = content.coefficients();
    true
}

/// Nobody without the key makes a passport that verifies: only the published files themselves do.
fn passport(bytes: &[u8]) -> bool {
    let answer = verify("f", bytes, &BENCH.trust, &BENCH.question);
    assert!(!answer.checks().is_empty());
    let _ = content_from_anyone("f", bytes).map_err(|error| refused(&error, bytes));
    if answer.valid() {
        const PUBLISHED: [&[u8]; 4] = [
            include_bytes!("../../passports/SPS-1/0203/beijing-nim-1.yaml"),
            include_bytes!("../../passports/SPS-1/0203/moscow-bmstu-1.yaml"),
            include_bytes!("../../passports/SPS-2/0017/beijing-nim-1.yaml"),
            include_bytes!("../../passports/SPS-2/0017/moscow-bmstu-1.yaml"),
        ];
        assert!(PUBLISHED.contains(&bytes), "a forgery was accepted");
    }
    answer.valid()
}

/// A trusted key signs anything: what verifies is in its one form, and its numbers are the right ones.
fn signed(bytes: &[u8]) -> bool {
    let Some(payload) = payload(bytes) else { return false };
    let file = join(payload, &BENCH.key.sign(NAMESPACE, payload.as_bytes()).unwrap());
    let answer = verify("f", file.as_bytes(), &BENCH.trust, &BENCH.question);
    let Some(passport) = answer.passport() else { return false };
    assert_eq!(rule::differs(payload, &written(passport.content())), None);
    true
}

/// The same for a register; verified again, it is the same register in the same bytes.
fn of_register(bytes: &[u8]) -> bool {
    let Some(payload) = payload(bytes) else { return false };
    let Bench { key, trust, question, .. } = &*BENCH;
    let file = join(payload, &key.sign(register::REGISTER_NAMESPACE, payload.as_bytes()).unwrap());
    let verified = match VerifiedRegister::verify("f", file.as_bytes(), trust, question.time) {
        Ok(verified) => verified,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    assert_eq!(rule::differs(payload, &written(verified.content())), None);
    assert_eq!(verified.agree(&verified), Ok(()));
    SignedText::split("f", file.as_bytes(), &FORM).expect_err("a register is no passport");
    true
}

/// An armor that is accepted is the one that is written; it holds for no text that its key never signed.
fn armor(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    match Signature::from_armor(text) {
        Ok(signature) => {
            assert_eq!(signature.to_armor(), text);
            assert!(signature.verify(signature.namespace(), b"never signed").is_err());
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// The bytes inside an armor.
fn blob(bytes: &[u8]) -> bool {
    let base64 = Base64::encode_string(bytes);
    let lines: Vec<_> = base64.as_bytes().chunks(70).map(|line| std::str::from_utf8(line).unwrap()).collect();
    armor(format!("-----BEGIN SSH SIGNATURE-----\n{}\n-----END SSH SIGNATURE-----\n", lines.join("\n")).as_bytes())
}

fn public_key(bytes: &[u8]) -> bool {
    let Ok(line) = std::str::from_utf8(bytes) else { return false };
    match PublicKey::from_openssh(line) {
        Ok(key) => {
            let written = key.to_openssh();
            assert!(line.split_ascii_whitespace().take(2).eq(written.split(' ')), "{line} was written as {written}");
            assert_eq!(PublicKey::from_openssh(&written), Ok(key));
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// A comment before it and line ends of CR LF change no verdict of a list of allowed signers.
fn allowed_signers(bytes: &[u8]) -> bool {
    let signers = match AllowedSigners::parse("f", bytes) {
        Ok(signers) => signers,
        Err(error) => return refused(&error, bytes),
    };
    let text = std::str::from_utf8(bytes).expect("what is accepted is text");
    let other = format!("# comment\r\n{}", text.replace("\r\n", "\n").replace('\n', "\r\n"));
    let other = AllowedSigners::parse("other", other.as_bytes()).expect("the same lines");
    let key = BENCH.key.public_key();
    for principal in ["examples@dtg-passport.test", "a", "bc@d"] {
        for namespace in [NAMESPACE, register::REGISTER_NAMESPACE] {
            for time in ["2026-11-20T00:00:00Z", "1999-12-31T23:59:59Z"] {
                let verdict = |list: &AllowedSigners| list.authorise(&key, principal, namespace, time.parse().unwrap());
                assert_eq!(verdict(&signers), verdict(&other));
            }
        }
    }
    true
}

/// A key that is added to a list of revoked keys, of either kind, is revoked by it; a list that goes on is none.
fn revoked_keys(bytes: &[u8]) -> bool {
    if let Err(error) = RevokedKeys::parse("f", bytes) {
        return refused(&error, bytes);
    }
    let key = BENCH.key.public_key();
    if bytes.starts_with(b"SSHKRL") {
        assert!(RevokedKeys::parse("f", &[bytes, &[2]].concat()).is_err());
        // A section of explicit keys: its type, its length, each key with its length (PROTOCOL.krl).
        let line = key.to_openssh();
        let key_bytes = Base64::decode_vec(line.rsplit(' ').next().unwrap()).unwrap();
        let section = [&[2, 0, 0, 0, 55, 0, 0, 0, 51][..], &key_bytes].concat();
        if let Ok(longer) = RevokedKeys::parse("f", &[bytes, &section].concat()) {
            assert!(longer.revokes(&key).is_some());
        }
    } else {
        let longer = [bytes, b"\n", key.to_openssh().as_bytes()].concat();
        assert!(RevokedKeys::parse("f", &longer).expect("one line more").revokes(&key).is_some());
    }
    true
}

/// Currents that are accepted can be calibrated with, and are the same when they are written out and read again.
fn currents(bytes: &[u8]) -> bool {
    let setup = &BENCH.setup;
    let read = |bytes: &[u8]| Readings::from_csv("f", bytes, setup.coefficients(), 1.0);
    let readings = match read(bytes) {
        Ok(readings) => readings,
        Err(error) => return refused(&error, bytes),
    };
    let mut written = "i,j,cycle,visit,jx_ma,jy_ma\n".to_owned();
    for position in readings.positions() {
        let PositionIndex { i, j } = position.index;
        for visit in &position.visits {
            for current in &visit.each_ma {
                written += &format!("{i},{j},{},{},{},{}\n", visit.cycle, visit.number, current.x, current.y);
            }
        }
    }
    let again = read(written.as_bytes()).expect("what was read");
    // Written position by position, with numbers, the rows do not tell in which order the positions were visited.
    let visits = |readings: &Readings| -> Vec<_> {
        let positions = readings.positions().iter();
        let each = positions.flat_map(|at| at.visits.iter().map(move |visit| (at.index, at.mean_ma, visit.clone())));
        each.map(|(index, mean, visit)| (index, mean, visit.cycle, visit.number, visit.each_ma, visit.mean_ma))
            .collect()
    };
    assert_eq!(visits(&again), visits(&readings));
    if let Ok(calibration) = calibrate(setup, &readings, &Options::default()) {
        for result in &calibration.results {
            assert!(result.parameters.to_vector().iter().all(|value| value.is_finite()), "{result:?}");
        }
    }
    true
}

/// Angles that are accepted give a stand file that is read again, or a refusal in words.
fn angles(bytes: &[u8]) -> bool {
    let readings = match AngleReadings::from_csv("f", bytes, &BENCH.header.positions) {
        Ok(readings) => readings,
        Err(error) => return refused(&error, bytes),
    };
    match certify(&BENCH.header, &readings) {
        Ok(certified) => {
            let file = certified.to_yaml("written").expect("a stand that is read again");
            assert_eq!(Stand::from_yaml("written", file.as_bytes()).as_ref(), Ok(&certified.stand));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    true
}

/// What a calibration wrote, which a later one compares itself with.
fn earlier_result(bytes: &[u8]) -> bool {
    match CalibrationDocument::from_json("f", bytes) {
        Ok(document) => {
            let _ = document.valid();
            let written = serde_json::to_vec(&document).unwrap();
            assert_eq!(CalibrationDocument::from_json("written", &written), Ok(document));
            true
        }
        Err(error) => refused(&error, bytes),
    }
}
