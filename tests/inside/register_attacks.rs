//! Attacks on the register of a stand: somebody who can change files, but has no trusted key, wants a passport used that does
//! not count, or something written. Each has a name; their number and kinds are counted at the end.

use crate::inside::fixtures::{ARC_MINUTES, ISSUER, SITE, issued_plus, signed_as, site, stand, trust_as};
use dtg_passport::document::sha256_hex;
use dtg_passport::folder::overview::{Overview, Query};
use dtg_passport::folder::registers::Registers;
use dtg_passport::folder::renewal::{Renewal, Withdrawal};
use dtg_passport::folder::{Authority, Folder, FolderRefused, Memory};
use dtg_passport::passport::issue::{Issue, PreparedStand};
use dtg_passport::passport::reissue::{Reissue, successor};
use dtg_passport::passport::{CheckName, Question, Trust, verify};
use dtg_passport::register::{Entry, REGISTER_NAMESPACE, Register, State};
use dtg_passport::site::Site;
use dtg_passport::trust::{AllowedSigners, RevokedKeys, SigningKey};
use jiff::Timestamp;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

const STAND: &str = "SPS-2/0017";

fn day(number: i64) -> Timestamp {
    issued_plus(24 * 3600 * number)
}

/// Ten days after the first passport: what is asked about.
fn now() -> Timestamp {
    day(10)
}

/// Sites and revisions of the passports that are asked about.
const ASKED: [(&str, u32); 4] = [("here", 1), ("here", 2), ("there", 1), ("hall", 1)];

/// Change of a register before it is signed.
type Change<'a> = &'a dyn Fn(&mut Register);

/// Factory with a folder of passports: `here/1`, superseded by `here/2`; `there/1`, withdrawn; `hall/1`, current.
struct Factory {
    folder: tempfile::TempDir,
    key: SigningKey,
    trust: Trust,
    tried: RefCell<BTreeMap<&'static str, BTreeSet<String>>>,
}

impl Factory {
    fn new() -> Self {
        let key = SigningKey::generate().unwrap();
        let (folder, trust) = (tempfile::tempdir().unwrap(), trust_as(ISSUER, &key));
        let factory = Self { folder, key, trust, tried: RefCell::default() };
        for name in ["here", "there", "hall"] {
            factory.issue(name, day(0)).unwrap();
        }
        fs::copy(factory.register(), factory.folder.path().join("first.yaml")).unwrap();
        factory.reissue("here", 1, day(1)).unwrap();
        factory.withdraw(&["SPS-2/0017/there/1"], day(2));
        factory
    }

    fn root(&self) -> PathBuf {
        self.folder.path().join("passports")
    }

    fn file(&self, site: &str, revision: u32) -> PathBuf {
        self.root().join(STAND).join(format!("{site}-{revision}.yaml"))
    }

    fn register(&self) -> PathBuf {
        self.root().join(STAND).join("register.yaml")
    }

    /// Register before the first successor.
    fn first_register(&self) -> Vec<u8> {
        fs::read(self.folder.path().join("first.yaml")).unwrap()
    }

    fn content(&self) -> Register {
        Register::from_anyone("r", &fs::read(self.register()).unwrap()).unwrap()
    }

    fn issue(&self, name: &str, time: Timestamp) -> Result<String, FolderRefused> {
        self.issue_with(name, time, None)
    }

    fn issue_with(&self, name: &str, time: Timestamp, memory: Option<&Memory>) -> Result<String, FolderRefused> {
        let clock = || time;
        let authority = Authority { memory, ..Authority::new(ISSUER, &self.key, &self.trust, &clock) };
        let stand = PreparedStand::new(stand(ARC_MINUTES));
        let order = Issue::first(ISSUER, day(0));
        Folder::new(self.root()).issue(&stand, &site_named(name), &order, &authority).map(|issued| issued.sha256)
    }

    fn reissue(&self, name: &str, revision: u32, time: Timestamp) -> Result<String, FolderRefused> {
        let clock = || time;
        let authority = Authority::new(ISSUER, &self.key, &self.trust, &clock);
        let bytes = fs::read(self.file(name, revision)).unwrap();
        let old = verify("old", &bytes, &self.trust, &Question::at(time));
        let order = Reissue { same_content: true, ..Reissue::new(ISSUER, day(1), "latitude of another pillar") };
        let next = successor(&bytes, &old, &order).unwrap();
        Folder::new(self.root()).reissue(&next, &authority).map(|issued| issued.sha256)
    }

    fn withdraw(&self, ids: &[&str], time: Timestamp) -> Vec<String> {
        let clock = || time;
        let authority = Authority::new(ISSUER, &self.key, &self.trust, &clock);
        let ids: Vec<String> = ids.iter().map(|id| (*id).to_owned()).collect();
        let withdrawn = Withdrawal { ids: &ids, reason: "wrong site" }.run(&self.root(), &authority).unwrap();
        withdrawn.into_iter().flat_map(|one| one.alarms).collect()
    }

    /// Returns what `verify --register` says of a passport.
    fn code_at(&self, site: &str, revision: u32, question: &Question, memory: Option<Memory>) -> &'static str {
        self.code_of(&self.file(site, revision), &self.root(), question, memory)
    }

    fn code_of(&self, file: &Path, register: &Path, question: &Question, memory: Option<Memory>) -> &'static str {
        let registers = Registers::new(register, self.trust.clone(), question.now, memory);
        let verification = verify("p", &fs::read(file).unwrap(), &self.trust, question);
        let verification = registers.asked(verification, question);
        let code = verification.code(CheckName::Register).unwrap();
        assert!(!verification.valid() || code.as_str() == "ok");
        code.as_str()
    }

    /// Notes an attack, after which `verify --register` must say `codes` of `here/1`, `here/2`, `there/1` and `hall/1`.
    fn attacked(&self, kind: &'static str, name: &str, codes: [&str; 4]) {
        let question = Question::at(now());
        let found = ASKED.map(|(site, revision)| match self.file(site, revision).exists() {
            true => self.code_at(site, revision, &question, None),
            false => "absent",
        });
        for (found, due) in found.iter().zip(codes) {
            assert!(*found == due || *found == "absent" || due == "*", "{kind}, {name}: {found:?}, expected {codes:?}");
        }
        self.note(kind, name);
    }

    fn note(&self, kind: &'static str, name: &str) {
        assert!(self.tried.borrow_mut().entry(kind).or_default().insert(name.to_owned()), "{kind}, {name}: twice");
    }

    /// Puts another file in the place of the register for one attack.
    fn with_register(&self, bytes: impl AsRef<[u8]>, attack: impl FnOnce()) {
        let good = fs::read(self.register()).unwrap();
        fs::write(self.register(), bytes).unwrap();
        attack();
        fs::write(self.register(), good).unwrap();
    }

    /// Returns the answer when the register is changed and signed by `key`.
    fn with_changed(&self, change: Change, key: &SigningKey, attack: impl FnOnce()) {
        let mut register = self.content();
        change(&mut register);
        self.with_register(signed(&register, key), attack);
    }
}

fn signed(register: &Register, key: &SigningKey) -> String {
    signed_as(REGISTER_NAMESPACE, &register.payload(), key)
}

fn site_named(name: &str) -> Site {
    site(&SITE.replace("\"bench\"", &format!("\"{name}\"")))
}

const GOOD: [&str; 4] = ["superseded", "ok", "withdrawn", "ok"];
const UNKNOWN: [&str; 4] = ["register_unknown"; 4];

/// What a file becomes that somebody wants not to be read any more.
fn damaged(text: &[u8]) -> Vec<(&'static str, Vec<u8>)> {
    let string = std::str::from_utf8(text).unwrap();
    let utf_16 = |to_bytes: fn(u16) -> [u8; 2]| string.encode_utf16().flat_map(to_bytes).collect::<Vec<u8>>();
    vec![
        ("empty", Vec::new()),
        ("cut to 1 byte", text[..1].to_vec()),
        ("cut to 100 bytes", text[..100].to_vec()),
        ("cut to 400 bytes", text[..400].to_vec()),
        ("cut in half", text[..text.len() / 2].to_vec()),
        ("without its last byte", text[..text.len() - 1].to_vec()),
        ("gzip", [&[0x1F, 0x8B, 8, 0][..], text].concat()),
        ("noise", (0..9000_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 24) as u8).collect()),
        ("UTF-16, little endian", utf_16(u16::to_le_bytes)),
        ("UTF-16, big endian", utf_16(u16::to_be_bytes)),
        ("byte order mark", [b"\xEF\xBB\xBF", text].concat()),
        ("CRLF", string.replace('\n', "\r\n").into_bytes()),
        ("one line more", [text, b"# more\n"].concat()),
        ("twice", [text, text].concat()),
        ("first letter in capitals", string.replacen("format", "Format", 1).into_bytes()),
        ("a digit of a time", flipped(string, "issued_at: \"202")),
        ("a digit of the signature", flipped(string, "U1NIU0lH")),
        ("quoted otherwise", string.replacen('"', "'", 2).into_bytes()),
    ]
}

/// Changes the character after a mark.
fn flipped(text: &str, mark: &str) -> Vec<u8> {
    let at = text.find(mark).unwrap() + mark.len();
    let mut bytes = text.as_bytes().to_vec();
    bytes[at] = if bytes[at] == b'0' { b'1' } else { b'0' };
    bytes
}

#[test]
fn a_register_that_cannot_be_read_makes_no_passport_valid() {
    let factory = Factory::new();
    factory.attacked("nothing", "nothing", GOOD);
    let (path, good) = (factory.register(), fs::read(factory.register()).unwrap());
    for (name, bytes) in damaged(&good) {
        factory.with_register(bytes, || factory.attacked("register damaged", name, UNKNOWN));
    }
    let away = factory.folder.path().join("away.yaml");
    fs::rename(&path, &away).unwrap();
    factory.attacked("register removed", "removed", UNKNOWN);
    let replaced = |kind, name, make: &dyn Fn(&Path)| {
        make(&path);
        factory.attacked(kind, name, UNKNOWN);
        fs::remove_file(&path).or_else(|_| fs::remove_dir(&path)).unwrap();
    };
    replaced("register replaced", "a folder", &|path| fs::create_dir(path).unwrap());
    replaced("register replaced", "1 TiB of nothing", &|path| {
        fs::File::create(path).unwrap().set_len(1 << 40).unwrap();
    });
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;

        replaced("register linked", "to itself elsewhere", &|path| symlink(&away, path).unwrap());
        replaced("register linked", "to nowhere", &|path| symlink("/nowhere", path).unwrap());
        replaced("register replaced", "a pipe", &|path| {
            assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
        });
        fs::rename(&away, &path).unwrap();
        let (folder, store) = (path.parent().unwrap(), factory.folder.path().join("store"));
        fs::rename(folder, &store).unwrap();
        symlink(&store, folder).unwrap();
        factory.attacked("folder linked", "of the stand", UNKNOWN);
        fs::remove_file(folder).unwrap();
        fs::rename(&store, folder).unwrap();
        fs::rename(&path, &away).unwrap();
    }
    fs::rename(&away, &path).unwrap();
    factory.attacked("nothing", "as before", GOOD);
    assert_counted(&factory, 24, 6);
}

#[test]
fn the_files_of_other_passports_have_no_effect() {
    let factory = Factory::new();
    for (site, revision) in [("here", 2), ("there", 1), ("hall", 1)] {
        let path = factory.file(site, revision);
        let good = fs::read(&path).unwrap();
        let name = |what: &str| format!("{site}-{revision}: {what}");
        for (what, bytes) in damaged(&good) {
            fs::write(&path, bytes).unwrap();
            // The state of the damaged file itself is not asked.
            let mut codes = GOOD;
            codes[ASKED.iter().position(|asked| *asked == (site, revision)).unwrap()] = "*";
            factory.attacked("passport damaged", &name(what), codes);
        }
        fs::remove_file(&path).unwrap();
        factory.attacked("passport removed", &name("removed"), GOOD);
        fs::write(&path, &good).unwrap();
    }
    // Many files, false registers, a folder named `revocations`, and files above.
    let junk = factory.root().join("SPS-2/junk");
    fs::create_dir_all(junk.join("deep/er")).unwrap();
    for number in 0..200 {
        fs::write(junk.join(format!("{number}.txt")), "format: \"dtg-passport/1\"\n").unwrap();
        fs::write(junk.join(format!("deep/er/register-{number}.yaml")), "format: \"dtg-register/1\"\n").unwrap();
    }
    fs::write(factory.root().join("register.yaml"), factory.first_register()).unwrap();
    fs::create_dir_all(factory.folder.path().join("revocations")).unwrap();
    fs::write(factory.folder.path().join("revocations/revocation-1.yaml"), "format: \"dtg-revocation/1\"\n").unwrap();
    factory.attacked("files planted", "400 files, a register above, lists", GOOD);
    let copied = factory.file("hall", 2);
    fs::copy(factory.file("here", 1), &copied).unwrap();
    factory.attacked("passport copied", "here/1 as hall/2", GOOD);
    assert_eq!(factory.code_of(&copied, &factory.root(), &Question::at(now()), None), "superseded");
    assert_counted(&factory, 54, 4);
}

/// Makes an entry that has ended current again.
fn current(entry: &mut Entry) {
    *entry = Entry { state: State::Current, since: None, by: None, ..entry.clone() };
}

/// Every field of a register is changed and signed by every wrong key; and every rule of its content is broken by the right
/// one.
#[test]
fn no_other_signature_and_no_broken_rule_is_accepted() {
    let mut factory = Factory::new();
    let [stranger, colleague, passports_only, revoked, expired, late] = [0; 6].map(|_| SigningKey::generate().unwrap());
    let line =
        |who: &str, options: &str, key: &SigningKey| format!("{who} {options} {}\n", key.public_key().to_openssh());
    let lines = [
        line(ISSUER, "", &factory.key),
        line("another@example.org", "", &colleague),
        line(ISSUER, "namespaces=\"dtg-passport\"", &passports_only),
        line(ISSUER, "", &revoked),
        line(ISSUER, "valid-before=\"20261112Z\"", &expired),
        line(ISSUER, "valid-after=\"20261115Z\"", &late),
    ];
    factory.trust = Trust {
        signers: AllowedSigners::parse("signers", lines.concat().as_bytes()).unwrap(),
        revoked: vec![RevokedKeys::parse("keys", revoked.public_key().to_openssh().as_bytes()).unwrap()],
    };
    factory.attacked("nothing", "several keys", GOOD);
    let wrong_keys = [
        ("a stranger", &stranger),
        ("a colleague", &colleague),
        ("a key for passports", &passports_only),
        ("a revoked key", &revoked),
        ("an expired key", &expired),
        ("a later key", &late),
    ];
    let changes: [(&str, Change); 9] = [
        ("nothing", &|_| {}),
        ("sequence", &|register| register.register.0.sequence += 1),
        ("previous_sha256", &|register| register.register.0.previous_sha256 = Some("0".repeat(64))),
        ("issued_at", &|register| register.register.0.issued_at = day(5)),
        ("fresh_until", &|register| register.register.0.fresh_until = Some("2099-01-01".parse().unwrap())),
        ("issuer", &|register| register.register.0.issuer = "another@example.org".to_owned()),
        ("state", &|register| current(&mut register.passports[0])),
        ("sha256", &|register| register.passports[0].sha256 = "1".repeat(64)),
        ("valid_until", &|register| register.passports[0].valid_until = None),
    ];
    for (who, key) in wrong_keys {
        for (what, change) in changes {
            let attack = || factory.attacked("signed by another key", &format!("{who}: {what}"), UNKNOWN);
            factory.with_changed(change, key, attack);
        }
    }
    let text = factory.content().payload();
    factory.with_register(signed_as("dtg-passport", &text, &factory.key), || {
        factory.attacked("signed by another key", "for passports", UNKNOWN);
    });
    let broken: [(&str, Change); 22] = [
        ("another format", &|register| register.format = "dtg-register/2".to_owned()),
        ("sequence 0", &|register| register.register.0.sequence = 0),
        ("no SHA-256 of the one before", &|register| register.register.0.previous_sha256 = None),
        ("a short SHA-256", &|register| register.register.0.previous_sha256 = Some("0".to_owned())),
        ("a stand with one name", &|register| register.register.0.stand = "SPS-2".to_owned()),
        ("no entries", &|register| register.passports.clear()),
        ("an id twice", &|register| {
            let copy = register.passports[0].clone();
            register.passports.push(Entry { sha256: "2".repeat(64), ..copy });
        }),
        ("a SHA-256 twice", &|register| register.passports[1].sha256 = register.passports[0].sha256.clone()),
        ("an id of another stand", &|register| register.passports[2].id = "SPS-2/0018/hall/1".to_owned()),
        ("revision 0", &|register| register.passports[2].id = "SPS-2/0017/hall/0".to_owned()),
        ("revisions that do not ascend", &|register| register.passports.reverse()),
        ("since before its issue", &|register| register.passports[0].since = Some(day(-1))),
        ("since after the register", &|register| register.passports[0].since = Some(day(9))),
        ("issued after the register", &|register| register.passports[2].issued_at = day(9)),
        ("by itself", &|register| register.passports[0].by = Some("SPS-2/0017/here/1".to_owned())),
        ("by one that is not listed", &|register| register.passports[0].by = Some("SPS-2/0017/here/7".to_owned())),
        ("superseded by none", &|register| register.passports[0].by = None),
        ("superseded without a time", &|register| register.passports[0].since = None),
        ("current and superseded", &|register| register.passports[0].state = State::Current),
        ("withdrawn without a reason", &|register| register.passports[1].reason = None),
        ("a reason of 501 characters", &|register| register.passports[1].reason = Some("ж".repeat(501))),
        ("current with a successor", &|register| register.passports[2].by = Some("SPS-2/0017/here/2".to_owned())),
    ];
    for (what, change) in broken {
        let attack = || factory.attacked("rule broken by the right key", what, UNKNOWN);
        factory.with_changed(change, &factory.key, attack);
    }
    for (what, from, to) in [
        ("a state that does not exist", "state: \"current\"", "state: \"valid\""),
        ("sequence 2^53", "sequence: ", "sequence: 900719925474099"),
        ("an unknown key", "state: \"current\"", "state: \"current\", note: \"x\""),
        ("a key in another place", "register: {stand", "register: { stand"),
        ("entries on two lines", ", state: \"current\"", ",\n    state: \"current\""),
    ] {
        let altered = text.replacen(from, to, 1);
        assert_ne!(altered, text, "{what}");
        factory.with_register(signed_as(REGISTER_NAMESPACE, &altered, &factory.key), || {
            factory.attacked("rule broken by the right key", what, UNKNOWN);
        });
    }
    let of_stand = |register: &mut Register, stand: &str| {
        register.register.0.stand = stand.to_owned();
        for entry in &mut register.passports {
            for id in [Some(&mut entry.id), entry.by.as_mut()].into_iter().flatten() {
                *id = id.replace(STAND, stand);
            }
        }
    };
    let not_listed = ["superseded", "ok", "withdrawn", "not_listed"];
    let others: [(&str, &str, &SigningKey, [&str; 4], Change); 5] = [
        ("register of something else", "of another stand", &factory.key, UNKNOWN, &|register| {
            of_stand(register, "SPS-2/0018");
        }),
        ("register of something else", "of another model", &factory.key, UNKNOWN, &|register| {
            of_stand(register, "SPS-3/0017");
        }),
        ("register of the future", "two days ahead", &factory.key, UNKNOWN, &|register| {
            register.register.0.issued_at = day(12);
        }),
        ("register of something else", "of another factory for this stand", &colleague, UNKNOWN, &|register| {
            register.register.0.issuer = "another@example.org".to_owned();
        }),
        ("not listed", "hall/1", &factory.key, not_listed, &|register| {
            register.passports.retain(|entry| !entry.id.contains("hall"));
        }),
    ];
    for (kind, name, key, codes, change) in others {
        factory.with_changed(change, key, || factory.attacked(kind, name, codes));
    }
    assert_counted(&factory, 80, 6);
}

/// Registers of the past: without a memory they count until they are no longer fresh, with one never.
#[test]
fn an_older_register_does_not_count_where_a_later_one_is_known() {
    let factory = Factory::new();
    let question = Question::at(now());
    let memory = || Memory::new(factory.folder.path().join("registers"));
    let remembered = |site: &str, revision: u32| factory.code_at(site, revision, &question, Some(memory()));
    assert_eq!(remembered("here", 2), "ok");
    let last = fs::read(factory.register()).unwrap();
    let first = factory.first_register();
    factory.with_register(first, || {
        assert_eq!(remembered("here", 1), "register_older");
        assert_eq!(remembered("hall", 1), "register_older");
        assert_eq!(factory.code_at("here", 1, &question, None), "ok");
        // The factory does not sign over a rollback.
        let refused = factory.issue_with("bench", now(), Some(&memory())).unwrap_err();
        assert!(matches!(refused, FolderRefused::Doubt(..)), "{refused}");
        factory.note("older register", "of last month");
    });
    fs::remove_file(factory.register()).unwrap();
    let refused = factory.issue_with("bench", now(), Some(&memory())).unwrap_err();
    assert!(matches!(refused, FolderRefused::Register(_)), "{refused}");
    let refused = factory.issue("bench", now()).unwrap_err();
    assert!(matches!(refused, FolderRefused::NoRegister { .. }), "{refused}");
    let clock = now;
    let authority =
        Authority { memory: Some(&memory()), ..Authority::new(ISSUER, &factory.key, &factory.trust, &clock) };
    Renewal::default().run(&factory.root(), &authority).unwrap_err();
    assert!(!factory.register().exists() && !factory.file("bench", 1).exists());
    factory.note("older register", "removed before the factory's next command");
    fs::write(factory.register(), &last).unwrap();
    // Contradictions, signed by the right key.
    let later = |more: u64, change: Change| {
        let mut register = factory.content();
        register.register.0.sequence += more;
        change(&mut register);
        signed(&register, &factory.key)
    };
    let cases: [(&str, u64, Change); 5] = [
        ("two of one number", 0, &|register| register.register.0.fresh_until = Some("2099-01-01".parse().unwrap())),
        ("an entry is lost", 1, &|register| drop(register.passports.remove(2))),
        ("a state goes back", 1, &|register| current(&mut register.passports[0])),
        ("another SHA-256", 1, &|register| register.passports[2].sha256 = "3".repeat(64)),
        ("another order", 1, &|register| register.passports.swap(1, 2)),
    ];
    for (name, more, change) in cases {
        factory.with_register(later(more, change), || {
            assert_eq!(remembered("here", 2), "register_contradicted", "{name}");
            factory.note("contradiction", name);
        });
    }
    let memory_of = |name: &str, register: &[u8]| {
        let memory = Memory::new(factory.folder.path().join(name));
        memory.keep(STAND, register).unwrap();
        memory
    };
    for (name, more, code) in [("1,000 further", 1000, "ok"), ("1,001 further", 1001, "register_unknown")] {
        factory.with_register(later(more, &|_| ()), || {
            assert_eq!(factory.code_at("here", 2, &question, Some(memory_of(name, &last))), code);
            factory.note("number", name);
        });
    }
    // A withdrawal counts even in a register that is too old.
    let memory = memory_of("later", later(1, &|_| ()).as_bytes());
    assert_eq!(factory.code_at("there", 1, &question, Some(memory)), "withdrawn");
    factory.note("older register", "that withdraws");
    assert_counted(&factory, 10, 3);
}

/// Another run lists a passport after the renewal has read the register: that passport is not lost.
#[test]
fn a_renewal_keeps_what_another_run_lists_meanwhile() {
    let factory = Factory::new();
    let Factory { key, trust, .. } = &factory;
    let (root, calls) = (factory.root(), AtomicUsize::new(0));
    // The first call precedes the reading of the register, and the second one follows it.
    let clock = || {
        if calls.fetch_add(1, Ordering::Relaxed) == 1 {
            let (stand, order) = (PreparedStand::new(stand(ARC_MINUTES)), Issue::first(ISSUER, day(0)));
            let other = Authority::new(ISSUER, key, trust, &now);
            Folder::new(&root).issue(&stand, &site_named("bench"), &order, &other).unwrap();
        }
        now()
    };
    let authority = Authority::new(ISSUER, key, trust, &clock);
    let refused = Renewal::default().run(&root, &authority).unwrap_err();
    assert!(refused.to_string().contains("another run has replaced the register"), "{refused}");
    let is_listed = || factory.content().passports.iter().any(|entry| entry.id == "SPS-2/0017/bench/1");
    assert!(is_listed());
    Renewal::default().run(&root, &authority).unwrap();
    assert!(is_listed());
}

/// Freshness is judged now, whatever time is asked about; `since` only decides about superseded passports.
#[test]
fn times_of_the_question_do_not_bring_a_passport_back() {
    let factory = Factory::new();
    let fresh: Change = &|register| register.register.0.fresh_until = Some("2026-11-15".parse().unwrap());
    factory.with_changed(fresh, &factory.key, || {
        let question = |time, now| Question { now, ..Question::at(time) };
        let codes = |question: &Question| {
            [("here", 1), ("here", 2), ("there", 1)]
                .map(|(site, revision)| factory.code_at(site, revision, question, None))
        };
        assert_eq!(codes(&question(day(3), day(3))), ["superseded", "ok", "withdrawn"]);
        assert_eq!(codes(&question(day(0), day(3))), ["ok", "ok", "withdrawn"]);
        assert_eq!(codes(&question(day(3), day(9))), ["superseded", "register_stale", "withdrawn"]);
        assert_eq!(codes(&question(day(0), day(9))), ["register_stale", "register_stale", "withdrawn"]);
        factory.note("time", "of last year");
    });
}

/// Somebody plants files where the factory will write or withdraw.
#[test]
fn the_factory_neither_adopts_nor_withdraws_what_was_planted() {
    let factory = Factory::new();
    let stranger = Factory::new();
    // A passport with the right content, signed by a stranger.
    fs::create_dir_all(factory.root().join(STAND)).unwrap();
    stranger.issue("bench", now()).unwrap();
    fs::copy(stranger.file("bench", 1), factory.file("bench", 1)).unwrap();
    fs::copy(stranger.file("here", 2), factory.file("here", 3)).unwrap();
    let before = snapshot(&factory.root());
    let refused = factory.issue("bench", now()).unwrap_err();
    assert!(matches!(&refused, FolderRefused::Foreign { .. }), "{refused}");
    assert!(refused.to_string().contains(&stranger.key.public_key().fingerprint()));
    let refused = factory.reissue("here", 2, now()).unwrap_err();
    assert!(matches!(refused, FolderRefused::Foreign { .. } | FolderRefused::There(..)), "{refused}");
    assert_eq!(snapshot(&factory.root()), before);
    factory.note("planted", "passports of a stranger");
    fs::remove_file(factory.file("bench", 1)).unwrap();
    fs::remove_file(factory.file("here", 3)).unwrap();
    // Another authentic passport over the one that is withdrawn.
    let hall = fs::read(factory.file("hall", 1)).unwrap();
    fs::copy(factory.file("here", 2), factory.file("hall", 1)).unwrap();
    let alarms = factory.withdraw(&["SPS-2/0017/hall/1"], now());
    assert!(alarms.len() == 1 && alarms[0].contains("another file"), "{alarms:?}");
    fs::write(factory.file("hall", 1), hall).unwrap();
    factory.attacked("planted", "a passport over another one", ["superseded", "ok", "withdrawn", "withdrawn"]);
    // A link in the place of the lock, of the register and of the folder.
    #[cfg(unix)]
    for name in [".register.lock", "register.yaml"] {
        let (path, away) = (factory.root().join(STAND).join(name), factory.folder.path().join(name));
        fs::rename(&path, &away).unwrap();
        std::os::unix::fs::symlink(&away, &path).unwrap();
        let before = fs::read(&away).unwrap();
        factory.issue("bench", now()).unwrap_err();
        assert_eq!(fs::read(&away).unwrap(), before);
        fs::remove_file(&path).unwrap();
        fs::rename(&away, &path).unwrap();
        let _ = fs::remove_file(factory.file("bench", 1));
        factory.note("planted", name);
    }
    // Passports listed as ended are not issued again.
    for (site, state) in [("here", "superseded"), ("there", "withdrawn")] {
        let refused = factory.issue(site, now()).unwrap_err().to_string();
        assert!(refused.contains(state) || refused.contains("different content"), "{refused}");
        factory.note("planted", site);
    }
}

fn snapshot(root: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => drop(found.insert(path.clone(), sha256_hex(&fs::read(&path).unwrap()))),
            }
        }
    }
    found
}

/// Expected: rule 11 of the register's description: what is an alarm, what is only named, and what is neither.
#[test]
fn a_folder_is_compared_with_its_registers() {
    let factory = Factory::new();
    let question = Question::at(now());
    let overview = || {
        let query = Query { trust: &factory.trust, question: &question, memory: None, may_lack: false, threads: 2 };
        Overview::of(&factory.root(), query).unwrap()
    };
    let codes = || {
        let found = overview();
        (found.alarms.iter().map(|alarm| alarm.code.key()).collect::<Vec<_>>(), found.remarks.len())
    };
    let good = overview();
    assert_eq!((good.alarms.len(), good.remarks.len(), good.stands.len()), (0, 0, 1));
    let states: Vec<(&str, &str)> = good.rows().map(|row| (row.id.as_str(), row.state.key())).collect();
    assert_eq!(
        states,
        [
            ("SPS-2/0017/here/1", "superseded"),
            ("SPS-2/0017/there/1", "withdrawn"),
            ("SPS-2/0017/hall/1", "current"),
            ("SPS-2/0017/here/2", "current"),
        ]
    );
    let stranger = Factory::new();
    stranger.issue("bench", now()).unwrap();
    fs::copy(stranger.file("bench", 1), factory.file("bench", 1)).unwrap();
    assert_eq!(codes(), (vec![], 1), "a stranger's file is named");
    fs::remove_file(factory.file("bench", 1)).unwrap();
    let hall = fs::read(factory.file("hall", 1)).unwrap();
    fs::remove_file(factory.file("hall", 1)).unwrap();
    assert_eq!(codes().0, ["missing"]);
    fs::copy(factory.file("here", 2), factory.file("hall", 1)).unwrap();
    assert_eq!(codes().0, ["misplaced"]);
    fs::write(factory.file("hall", 1), b"rubbish").unwrap();
    assert_eq!(codes().0, ["differs"]);
    fs::write(factory.file("hall", 1), hall).unwrap();
    fs::write(factory.root().join("old.yaml"), "format: \"dtg-revocation/1\"\n").unwrap();
    assert_eq!(codes().0, ["revocation_list"]);
    fs::remove_file(factory.root().join("old.yaml")).unwrap();
    let register = fs::read(factory.register()).unwrap();
    fs::write(factory.register(), factory.first_register()).unwrap();
    assert_eq!(codes().0, ["not_listed"]);
    fs::write(factory.register(), b"x").unwrap();
    assert_eq!(codes().0, ["register_unknown"]);
    fs::remove_file(factory.register()).unwrap();
    assert_eq!(codes().0, ["no_register"]);
    fs::write(factory.register(), register).unwrap();
    assert_eq!(codes(), (vec![], 0));
}

fn assert_counted(factory: &Factory, attacks: usize, kinds: usize) {
    let tried = factory.tried.borrow();
    let number: usize = tried.values().map(BTreeSet::len).sum();
    assert!(number >= attacks && tried.len() >= kinds, "{number} attacks of {} kinds", tried.len());
    println!("{number} attacks of {} kinds: {:?}", tried.len(), tried.keys().collect::<Vec<_>>());
}
