//! Attacks on a register: somebody who can change its files, but has no trusted key, wants a passport used that no longer
//! counts. Each has a name, and is one file or two taken away, altered, added or given another name.

use crate::inside::fixtures;
use crate::inside::fixtures::{ARC_MINUTES, ISSUER, SITE, issued_plus, trust_as};
use crate::inside::written;
use dtg_passport::document::sha256_hex;
use dtg_passport::folder::search;
use dtg_passport::passport::content::{Content, Predecessor};
use dtg_passport::passport::{CheckName, Question, Trust, Verification, verify};
use dtg_passport::register::{Asked, Register, State};
use dtg_passport::revocation::{Entry, Series};
use dtg_passport::text::scalar::Identifier;
use dtg_passport::trust::SigningKey;
use jiff::Timestamp;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of one stand.
const STAND: &str = "passports/SPS-2/0017";

/// Three days after the first passport: what is asked about.
fn now() -> Timestamp {
    day(3)
}

fn day(number: i64) -> Timestamp {
    issued_plus(24 * 3600 * number)
}

/// A factory's key and a folder of passports.
struct Factory {
    folder: tempfile::TempDir,
    key: SigningKey,
    trust: Trust,
}

/// A passport: its id and its file's text.
#[derive(Clone)]
struct Passport {
    id: String,
    text: String,
}

impl Factory {
    fn new() -> Self {
        let key = SigningKey::generate().unwrap();
        // Two levels above the register nothing of other tests stands.
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("work/place").join(STAND)).unwrap();
        Self { folder, trust: trust_as(ISSUER, &key), key }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("work/place").join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), bytes).unwrap();
    }

    fn remove(&self, name: &str) {
        fs::remove_file(self.path(name)).unwrap();
    }

    /// A passport of stand SPS-2 0017; `change` has the last word.
    fn passport(&self, site: &str, revision: u32, issued_at: Timestamp, change: impl FnOnce(&mut Content)) -> Passport {
        self.signed_by(&self.key, site, revision, issued_at, change)
    }

    fn signed_by(
        &self,
        key: &SigningKey,
        site: &str,
        revision: u32,
        issued_at: Timestamp,
        change: impl FnOnce(&mut Content),
    ) -> Passport {
        let site = SITE.replace("\"bench\"", &format!("\"{site}\""));
        let mut content = fixtures::content(&fixtures::stand(ARC_MINUTES), &fixtures::site(&site));
        content.passport.revision = revision;
        content.passport.issued_at = issued_at;
        change(&mut content);
        content.passport.id = content.id_of_parts();
        Passport { id: content.passport.id.clone(), text: written(&content, key) }
    }

    /// A passport made from another one, which it supersedes.
    fn successor(&self, old: &Passport, site: &str, revision: u32, issued_at: Timestamp) -> Passport {
        self.passport(site, revision, issued_at, made_from(old, true))
    }

    /// Puts a passport where it belongs.
    fn put(&self, passport: &Passport) -> String {
        let (series, revision) = passport.id.rsplit_once('/').unwrap();
        let name = format!("passports/{series}-{revision}.yaml");
        self.write(&name, &passport.text);
        name
    }

    /// `here/1` and `here/2`, which supersedes it.
    fn two_revisions(&self) -> [Passport; 2] {
        let first = self.passport("here", 1, day(0), |_| {});
        let second = self.successor(&first, "here", 2, day(1));
        [&first, &second].into_iter().for_each(|passport| drop(self.put(passport)));
        [first, second]
    }

    /// A stand that moved twice: `here/1`, `there/1`, `hall/1`.
    fn two_moves(&self) -> [Passport; 3] {
        let first = self.passport("here", 1, day(0), |_| {});
        let second = self.successor(&first, "there", 1, day(1));
        let third = self.successor(&second, "hall", 1, day(2));
        [&first, &second, &third].into_iter().for_each(|passport| drop(self.put(passport)));
        [first, second, third]
    }

    /// The text of the first list, which withdraws these.
    fn list_of(&self, key: &SigningKey, passports: &[&Passport]) -> String {
        let entry = |passport: &&Passport| Entry {
            id: passport.id.clone(),
            sha256: sha256_hex(passport.text.as_bytes()),
            revoked_at: day(1),
            reason: "wrong latitude".to_owned(),
        };
        let entries = passports.iter().map(entry).collect();
        Series::default().following(ISSUER, day(1), entries).unwrap().sign(key).unwrap()
    }

    /// `here/1`, withdrawn, and `there/1`, in force; the text of the list.
    fn one_withdrawn(&self) -> ([Passport; 2], String) {
        let passports = ["here", "there"].map(|site| self.passport(site, 1, day(0), |_| {}));
        passports.iter().for_each(|passport| drop(self.put(passport)));
        let list = self.list_of(&self.key, &[&passports[0]]);
        self.write("passports/revocation-1.yaml", &list);
        (passports, list)
    }

    fn register(&self, folder: &str, time: Timestamp) -> (Register, Trust) {
        search::register(&self.path(folder), self.trust.clone(), &Asked::at(time), 1).unwrap()
    }

    /// `verify --register` of a passport that the laboratory has.
    fn verify_in(&self, folder: &str, passport: &Passport, time: Timestamp) -> Verification {
        let (register, trust) = self.register(folder, time);
        let bytes = passport.text.as_bytes();
        register.asked(verify("own-copy", bytes, &trust, &Question::at(time)), bytes)
    }

    fn verify(&self, passport: &Passport) -> Verification {
        self.verify_in("passports", passport, now())
    }

    /// The state in the register of every copy of a passport.
    fn states(&self, passport: &Passport) -> Vec<State> {
        let (lines, sha256) = (self.register("passports", now()).0.passports, sha256_hex(passport.text.as_bytes()));
        lines.iter().filter(|line| line.sha256 == sha256).map(|line| line.state).collect()
    }

    fn alarms(&self) -> BTreeSet<&'static str> {
        self.register("passports", now()).0.alarms.iter().map(|alarm| alarm.kind.key()).collect()
    }
}

fn made_from(old: &Passport, supersedes: bool) -> impl FnOnce(&mut Content) {
    let (id, sha256) = (old.id.clone(), sha256_hex(old.text.as_bytes()));
    move |content| {
        let (reason, changed) = ("test".to_owned(), "nothing".to_owned());
        content.passport.reissued_from = Some(Predecessor { id, sha256, reason, changed });
        content.passport.supersedes = Some(supersedes);
    }
}

fn code(verification: &Verification, name: CheckName) -> &'static str {
    verification.code(name).unwrap().as_str()
}

/// What came of an attack: what `verify --register` says of the passport that the attacker wants used, and the alarms.
struct Attacked {
    name: String,
    check: CheckName,
    code: &'static str,
    alarm: Option<&'static str>,
    verification: Verification,
    in_force: bool,
    alarms: BTreeSet<&'static str>,
}

impl Attacked {
    /// `code` and `alarm` are what must come back.
    fn of(factory: &Factory, name: &str, wanted: &Passport, code: &'static str, alarm: Option<&'static str>) -> Self {
        Self {
            name: name.to_owned(),
            check: if code == "passport_revoked" { CheckName::Revocation } else { CheckName::Register },
            code,
            alarm,
            verification: factory.verify(wanted),
            in_force: factory.states(wanted).iter().any(|state| matches!(state, State::InForce | State::Expiring)),
            alarms: factory.alarms(),
        }
    }

    fn assert_refused(&self) {
        let Self { name, check, code, alarm, verification, in_force, alarms } = self;
        assert!(!verification.valid(), "{name}: VALID");
        assert_eq!(self::code(verification, *check), *code, "{name}: {:#?}", verification.checks());
        assert!(!in_force, "{name}: the register says that it is in force");
        assert!(alarm.is_none_or(|alarm| alarms.contains(alarm)), "{name}: {alarms:?}");
    }
}

fn utf_16(text: &str, to_bytes: fn(u16) -> [u8; 2], mark: bool) -> Vec<u8> {
    let mark = if mark { "\u{FEFF}" } else { "" };
    format!("{mark}{text}").encode_utf16().flat_map(to_bytes).collect()
}

/// What a file becomes that somebody wants not to be read any more.
fn damaged(text: &str) -> Vec<(&'static str, Vec<u8>)> {
    let armor = text.find("-----BEGIN").unwrap();
    vec![
        ("one digit altered", text.replacen("sha256: \"", "sha256: \"0", 1).into_bytes()),
        ("a comment altered", text.replacen("# ", "#  ", 1).into_bytes()),
        ("cut by a byte", text.as_bytes()[..text.len() - 1].to_vec()),
        ("cut in the middle", text.as_bytes()[..text.len() / 2].to_vec()),
        ("cut before the signature", text.as_bytes()[..text.find("signature: |").unwrap()].to_vec()),
        ("without its head", text.as_bytes()[armor..].to_vec()),
        ("UTF-16, little end first", utf_16(text, u16::to_le_bytes, true)),
        ("UTF-16, big end first", utf_16(text, u16::to_be_bytes, true)),
        ("UTF-16 without a mark", utf_16(text, u16::to_le_bytes, false)),
        ("with a byte order mark", format!("\u{FEFF}{text}").into_bytes()),
        ("with CR LF", text.replace('\n', "\r\n").into_bytes()),
        ("with text after it", format!("{text}\n").into_bytes()),
        ("larger than any document", format!("{text}{}", "#".repeat(2 << 20)).into_bytes()),
        ("emptied", Vec::new()),
        ("blanked", b"\n\n".to_vec()),
        ("full of zeros, as after a loss of power", vec![0; text.len()]),
    ]
}

/// A passport of the chain is taken away.
fn removals() -> Vec<Attacked> {
    let mut attacked = Vec::new();
    let factory = Factory::new();
    let [first, _, _] = factory.two_moves();
    assert_eq!(code(&factory.verify(&first), CheckName::Register), "superseded");
    assert!(factory.alarms().is_empty());
    factory.remove(&format!("{STAND}/there-1.yaml"));
    attacked.push(Attacked::of(&factory, "removed middle", &first, "register_unknown", Some("missing")));

    let factory = Factory::new();
    let [_, second, _] = factory.two_moves();
    factory.remove(&format!("{STAND}/here-1.yaml"));
    attacked.push(Attacked::of(
        &factory,
        "removed first, the middle asked about",
        &second,
        "superseded",
        Some("missing"),
    ));

    let factory = Factory::new();
    let [first, second] = factory.two_revisions();
    let other = factory.successor(&first, "there", 1, day(2));
    factory.put(&other);
    assert_eq!(factory.alarms(), BTreeSet::from(["forked"]));
    factory.remove(&format!("{STAND}/here-1.yaml"));
    assert_eq!(factory.alarms(), BTreeSet::from(["forked", "missing"]));
    for branch in [&second, &other] {
        let name = format!("removed predecessor of a fork, {}", branch.id);
        attacked.push(Attacked::of(&factory, &name, branch, "register_unknown", Some("forked")));
    }

    let factory = Factory::new();
    let [first, _] = factory.two_revisions();
    let copy = factory.passport("there", 1, day(2), made_from(&first, false));
    factory.put(&copy);
    factory.remove(&format!("{STAND}/here-1.yaml"));
    attacked.push(Attacked::of(
        &factory,
        "removed predecessor of a second place",
        &copy,
        "register_unknown",
        Some("missing"),
    ));
    attacked
}

/// Two passports are shown for one.
fn second_passports() -> Vec<Attacked> {
    let another = |factory: &Factory| {
        factory
            .passport("here", 1, day(1), |content| content.passport.valid_until = Some("2028-06-01".parse().unwrap()))
    };
    let mut attacked = Vec::new();
    let factory = Factory::new();
    factory.two_revisions();
    let other = another(&factory);
    factory.write("passports/copies/SPS-2/0017/here-1.yaml", &other.text);
    let alarm = Some("duplicate_id");
    attacked.push(Attacked::of(&factory, "second first revision beside the first", &other, "superseded", alarm));

    let factory = Factory::new();
    factory.two_revisions();
    let other = another(&factory);
    attacked.push(Attacked::of(&factory, "second first revision outside the register", &other, "superseded", None));
    factory.put(&other);
    attacked.push(Attacked::of(
        &factory,
        "second first revision in place of the first",
        &other,
        "superseded",
        Some("missing"),
    ));

    let factory = Factory::new();
    let (first, other) = (factory.passport("here", 1, day(0), |_| {}), another(&factory));
    factory.put(&first);
    factory.write("passports/copies/SPS-2/0017/here-1.yaml", &other.text);
    for passport in [&first, &other] {
        attacked.push(Attacked::of(&factory, "one id with two hashes", passport, "superseded", alarm));
    }
    factory.remove(&format!("{STAND}/here-1.yaml"));
    attacked.push(Attacked::of(
        &factory,
        "one id with two hashes, one outside the register",
        &first,
        "superseded",
        None,
    ));
    attacked
}

/// The list that withdraws a passport is not to be read any more.
fn lists() -> Vec<Attacked> {
    let mut attacked = Vec::new();
    let list_file = "passports/revocation-1.yaml";
    let wanted = |name: String, change: &dyn Fn(&Factory, &str), code: &'static str, alarm: &'static str| {
        let factory = Factory::new();
        let ([first, _], list) = factory.one_withdrawn();
        assert_eq!(code_of_revocation(&factory, &first), "passport_revoked");
        change(&factory, &list);
        Attacked::of(&factory, &name, &first, code, Some(alarm))
    };
    let kinds: Vec<&str> = damaged(&Factory::new().one_withdrawn().1).into_iter().map(|(kind, _)| kind).collect();
    for (index, kind) in kinds.into_iter().enumerate() {
        let damage = |factory: &Factory, list: &str| factory.write(list_file, damaged(list).swap_remove(index).1);
        // Of what says no more that it is a list the register knows only that it is damaged.
        let unclear = kind == "without its head" || kind == "emptied" || kind == "blanked" || kind.starts_with("full");
        let alarm = if unclear { "damaged" } else { "revocation" };
        attacked.push(wanted(format!("list {kind}"), &damage, "register_unknown", alarm));
    }
    let altered = |list: &str| list.replace("latitude", "longitude");
    type Damage<'a> = &'a dyn Fn(&Factory, &str);
    let cases: [(&str, Damage, &'static str, &'static str); 6] = [
        (
            "list damaged and renamed",
            &|factory, list| {
                factory.remove(list_file);
                factory.write("passports/notes.txt", altered(list));
            },
            "register_unknown",
            "revocation",
        ),
        (
            "list damaged and hidden in another stand's folder",
            &|factory, list| {
                factory.remove(list_file);
                factory.write("passports/SPS-2/0018/.hidden", altered(list));
            },
            "register_unknown",
            "revocation",
        ),
        (
            "list renamed as a passport",
            &|factory, list| {
                factory.remove(list_file);
                factory.write(&format!("{STAND}/there-2.yaml"), list);
            },
            "passport_revoked",
            "misplaced",
        ),
        (
            "list renamed as nothing in particular",
            &|factory, list| {
                factory.remove(list_file);
                factory.write("passports/old.txt", list);
            },
            "passport_revoked",
            "misplaced",
        ),
        (
            "list damaged beside its copy",
            &|factory, list| {
                factory.write(list_file, altered(list));
                factory.write("passports/copy/revocation-1.yaml", list);
            },
            "passport_revoked",
            "revocation",
        ),
        (
            "first of two lists emptied",
            &|factory, list| {
                factory.write("passports/revocation-2.yaml", list);
                factory.write(list_file, "");
            },
            "passport_revoked",
            "damaged",
        ),
    ];
    attacked.extend(cases.into_iter().map(|(name, change, code, alarm)| wanted(name.to_owned(), change, code, alarm)));
    attacked
}

fn code_of_revocation(factory: &Factory, passport: &Passport) -> &'static str {
    code(&factory.verify(passport), CheckName::Revocation)
}

/// The successor of a passport is not to be read any more.
fn damaged_successors() -> Vec<Attacked> {
    let kinds: Vec<&str> = damaged(&Factory::new().two_revisions()[1].text).into_iter().map(|(kind, _)| kind).collect();
    let mut attacked: Vec<Attacked> = kinds
        .into_iter()
        .enumerate()
        .map(|(index, kind)| {
            let factory = Factory::new();
            let [first, second] = factory.two_revisions();
            factory.write(&format!("{STAND}/here-2.yaml"), damaged(&second.text).swap_remove(index).1);
            Attacked::of(&factory, &format!("successor {kind}"), &first, "register_unknown", Some("damaged"))
        })
        .collect();
    for (name, file) in [
        ("successor damaged and renamed", "passports/SPS-2/0017/notes.txt"),
        ("successor damaged and moved to the root", "passports/here-2.yaml"),
        ("successor damaged and moved to the model's folder", "passports/SPS-2/here-2.yaml"),
        ("successor damaged and moved deeper", "passports/SPS-2/0017/old/here-2.yaml"),
    ] {
        let factory = Factory::new();
        let [first, second] = factory.two_revisions();
        factory.remove(&format!("{STAND}/here-2.yaml"));
        factory.write(file, second.text.replace("supersedes: true", "supersedes: false"));
        attacked.push(Attacked::of(&factory, name, &first, "register_unknown", Some("damaged")));
    }
    attacked
}

/// Files added by somebody without a trusted key, and what is not yet issued: passports that count stay as they are.
fn nothing_is_blocked() -> usize {
    let forger = SigningKey::generate().unwrap();
    type Attack<'a> = &'a dyn Fn(&Factory, &Passport);
    let cases: [(&str, Attack); 7] = [
        ("junk", &|factory, _| factory.write("passports/junk.bin", b"\x00\x01\xFFnothing of a passport".repeat(99))),
        ("junk called as a passport", &|factory, _| {
            factory.write("passports/SPS-2/0017/here-2.yaml", "not a passport\n")
        }),
        ("junk called as a list", &|factory, _| factory.write("passports/revocation-9.yaml", "nothing\n")),
        ("a stand file", &|factory, _| factory.write("passports/SPS-2/0017/stand.yaml", ARC_MINUTES)),
        ("a forged successor", &|factory, good| {
            drop(factory.put(&factory.signed_by(&forger, "here", 2, day(1), made_from(good, true))));
        }),
        ("a forged list", &|factory, good| {
            factory.write("passports/revocation-1.yaml", factory.list_of(&forger, &[good]));
        }),
        ("a forged passport of the same id", &|factory, _| {
            factory.write(
                "passports/copies/SPS-2/0017/here-1.yaml",
                factory.signed_by(&forger, "here", 1, day(0), |_| {}).text,
            );
        }),
    ];
    for (name, change) in &cases {
        let factory = Factory::new();
        let good = factory.passport("here", 1, day(0), |_| {});
        factory.put(&good);
        change(&factory, &good);
        let answer = factory.verify(&good);
        assert!(answer.valid(), "{name}: {:#?}", answer.checks());
        assert!(factory.states(&good).contains(&State::InForce), "{name}");
    }
    cases.len()
}

#[test]
fn every_attack_is_refused() {
    let attacked: Vec<Attacked> =
        [removals(), second_passports(), lists(), damaged_successors()].into_iter().flatten().collect();
    attacked.iter().for_each(Attacked::assert_refused);
    let blocked_nobody = nothing_is_blocked();
    let all = attacked.len() + blocked_nobody;
    println!("register attacks refused: {all} of {all} ({blocked_nobody} of them files that must block nobody)");
}

fn of_another_stand(content: &mut Content) {
    content.stand.serial = Identifier::new("0018").unwrap();
    content.certificate.number = "C-2026-0143".to_owned();
}

#[test]
fn damage_concerns_no_more_than_it_must() {
    let factory = Factory::new();
    let [first, _] = factory.two_revisions();
    let other = factory.passport("here", 1, day(0), of_another_stand);
    factory.put(&other);
    assert!(factory.verify(&other).valid());
    // In the folder of a stand: that stand. Elsewhere: all.
    let damaged = first.text.replace("SPS-2", "SPS-3");
    factory.write(&format!("{STAND}/there-1.yaml"), &damaged);
    assert_eq!(code(&factory.verify(&other), CheckName::Register), "ok");
    factory.write("passports/there-1.yaml", &damaged);
    assert_eq!(code(&factory.verify(&other), CheckName::Register), "register_unknown");
    factory.remove("passports/there-1.yaml");
    factory.remove(&format!("{STAND}/there-1.yaml"));
    // A missing predecessor concerns its stand.
    factory.remove(&format!("{STAND}/here-1.yaml"));
    assert_eq!(code(&factory.verify(&other), CheckName::Register), "ok");
    assert_eq!(factory.alarms(), BTreeSet::from(["missing"]));
}

#[test]
fn nothing_supersedes_before_its_own_date() {
    let factory = Factory::new();
    let [first, second] = factory.two_revisions();
    let before = Timestamp::from_second(day(1).as_second() - 1).unwrap();
    for (time, code_of_first) in [(before, "ok"), (day(1), "superseded")] {
        let answer = factory.verify_in("passports", &first, time);
        assert_eq!(code(&answer, CheckName::Register), code_of_first, "{time}");
    }
    assert!(!factory.verify_in("passports", &second, before).valid());
    // Nor does another passport of the same id.
    let later = factory.passport("here", 2, day(9), made_from(&first, true));
    factory.write("passports/copies/SPS-2/0017/here-2.yaml", &later.text);
    assert!(factory.verify(&second).valid());
    assert_eq!(code(&factory.verify_in("passports", &second, day(9)), CheckName::Register), "superseded");
}

#[test]
fn of_two_with_one_id_the_one_that_is_left_is_in_force_again() {
    let factory = Factory::new();
    let first = factory.passport("here", 1, day(0), |_| {});
    let other = factory.passport("here", 1, day(1), |_| {});
    factory.put(&first);
    factory.write("passports/copies/SPS-2/0017/here-1.yaml", &other.text);
    assert!(!factory.verify(&first).valid() && !factory.verify(&other).valid());
    factory.write("passports/revocation-1.yaml", factory.list_of(&factory.key, &[&other]));
    assert!(factory.verify(&first).valid());
    assert_eq!(code_of_revocation(&factory, &other), "passport_revoked");
    assert!(!factory.alarms().contains("duplicate_id"));
}

fn only_the_first_is_withdrawn(factory: &Factory, folder: &str, [first, second]: [&Passport; 2]) {
    let (register, _) = factory.register(folder, now());
    assert!(register.alarms.is_empty(), "{folder}: {:?}", register.alarms);
    let states: Vec<State> = register.passports.iter().map(|line| line.state).collect();
    assert_eq!(states, [State::Revoked, State::InForce], "{folder}");
    assert_eq!(code(&factory.verify_in(folder, first, now()), CheckName::Revocation), "passport_revoked");
    assert!(factory.verify_in(folder, second, now()).valid());
}

#[test]
fn lists_above_a_subfolder_count() {
    let factory = Factory::new();
    let ([first, second], list) = factory.one_withdrawn();
    for folder in ["passports", "passports/SPS-2", STAND] {
        only_the_first_is_withdrawn(&factory, folder, [&first, &second]);
    }
    // A damaged one is no less missed from below; a forged one, or other text, is nothing to a register below.
    factory.write("passports/revocation-1.yaml", list.replace("latitude", "longitude"));
    assert_eq!(code(&factory.verify_in(STAND, &second, now()), CheckName::Register), "register_unknown");
    factory.write("passports/revocation-1.yaml", factory.list_of(&SigningKey::generate().unwrap(), &[&second]));
    factory.write("passports/README.md", "Lists are `dtg-revocation/1`.\n");
    assert!(factory.verify_in(STAND, &second, now()).valid());
}

#[test]
fn lists_in_a_folder_next_to_the_passports_count() {
    let factory = Factory::new();
    let ([first, second], list) = factory.one_withdrawn();
    factory.remove("passports/revocation-1.yaml");
    let beside = "revocations/revocation-1.yaml";
    let (folders, without) = (["passports", "passports/SPS-2", STAND], factory.verify(&first));
    assert!(without.valid(), "{:?}", without.checks());
    factory.write(beside, &list);
    for folder in folders {
        only_the_first_is_withdrawn(&factory, folder, [&first, &second]);
    }
    // A damaged one may have withdrawn any passport.
    for (how, bytes) in damaged(&list) {
        factory.write(beside, bytes);
        for folder in folders {
            let asked = factory.verify_in(folder, &second, now());
            assert_eq!(code(&asked, CheckName::Register), "register_unknown", "{how}, {folder}");
        }
    }
    // That of a stranger is reported and withdraws nothing.
    factory.write(beside, factory.list_of(&SigningKey::generate().unwrap(), &[&second]));
    assert!(factory.verify(&second).valid());
    assert!(factory.alarms().contains("revocation"));
    // A register of the folder of the lists itself reads each of them once.
    factory.write(beside, &list);
    assert!(factory.register("revocations", now()).0.alarms.is_empty());
}

#[cfg(unix)]
#[test]
fn a_folder_of_lists_that_cannot_be_reached_makes_the_answer_unknown() {
    let factory = Factory::new();
    let ([first, second], list) = factory.one_withdrawn();
    factory.remove("passports/revocation-1.yaml");
    factory.write("elsewhere/revocation-1.yaml", list);
    std::os::unix::fs::symlink("elsewhere", factory.path("revocations")).unwrap();
    assert_eq!(code_of_revocation(&factory, &first), "passport_revoked");
    assert!(factory.verify(&second).valid());
    fs::rename(factory.path("elsewhere"), factory.path("unmounted")).unwrap();
    assert_eq!(code(&factory.verify(&second), CheckName::Register), "register_unknown");
}

#[test]
fn lists_in_both_places_are_one_series() {
    let factory = Factory::new();
    let ([first, second], list) = factory.one_withdrawn();
    let place = |name: &str| factory.path(name);
    let newest = |folder: &str| {
        let lists = search::lists(&place(folder), &place("passports"), &factory.trust, now()).unwrap();
        lists.newest().map(|list| list.sequence)
    };
    // A folder of lists that was made later continues the lists with the passports.
    assert_eq!(search::place_of_lists(&place("passports")), place("passports"));
    fs::create_dir(place("revocations")).unwrap();
    assert_eq!(search::place_of_lists(&place("passports")), place("revocations"));
    assert_eq!(newest("revocations"), Some(1));
    let lists = search::lists(&place("revocations"), &place("passports"), &factory.trust, now()).unwrap();
    let (sha256, reason) = (sha256_hex(second.text.as_bytes()), "wrong site".to_owned());
    let entry = Entry { id: second.id.clone(), sha256, revoked_at: now(), reason };
    let next = lists.following(ISSUER, now(), vec![entry]).unwrap();
    factory.write("revocations/revocation-2.yaml", next.sign(&factory.key).unwrap());
    assert_eq!([newest("revocations"), newest("passports")], [Some(2), Some(2)]);
    // A register would not find a list in another folder.
    assert!(search::lists(&place("other"), &place("passports"), &factory.trust, now()).is_err());
    let withdrawn = |passport: &Passport| code_of_revocation(&factory, passport) == "passport_revoked";
    assert!(withdrawn(&first) && withdrawn(&second) && factory.alarms().is_empty());
    // Each place alone still withdraws what its lists contain.
    factory.remove("passports/revocation-1.yaml");
    assert!(withdrawn(&first) && withdrawn(&second));
    factory.write("passports/revocation-1.yaml", list);
    factory.remove("revocations/revocation-2.yaml");
    assert!(withdrawn(&first) && !withdrawn(&second));
}

#[test]
fn questions_choose_lines_and_no_alarm() {
    let factory = Factory::new();
    factory.two_revisions();
    let other = factory.passport("there", 1, day(0), of_another_stand);
    factory.put(&other);
    factory.remove(&format!("{STAND}/here-1.yaml"));
    let ask = |change: &dyn Fn(&mut Question)| {
        let mut asked = Asked::at(now());
        change(&mut asked.question);
        let (register, _) = search::register(&factory.path("passports"), factory.trust.clone(), &asked, 1).unwrap();
        assert_eq!(register.alarms.len(), 1, "{:?}", register.alarms);
        register.passports.iter().map(|line| line.id.clone().unwrap()).collect::<Vec<_>>()
    };
    let (here, there) = ("SPS-2/0017/here/2", "SPS-2/0018/there/1");
    assert_eq!(ask(&|_| {}), [here, there]);
    assert_eq!(ask(&|question| question.serial = Some("0018".to_owned())), [there]);
    assert_eq!(ask(&|question| question.issuer = Some(ISSUER.to_owned())), [here, there]);
    assert!(ask(&|question| question.issuer = Some("quality".to_owned())).is_empty());
    let place = |latitude_deg| dtg_passport::earth::Place { latitude_deg, longitude_deg: 37.6856 };
    assert_eq!(ask(&|question| question.place = Some(place(55.7658))), [here, there]);
    assert!(ask(&|question| question.place = Some(place(-55.7658))).is_empty());
}

#[test]
fn a_stand_in_force_under_two_certificates_is_an_alarm() {
    let factory = Factory::new();
    let under = |number: &'static str| move |content: &mut Content| content.certificate.number = number.to_owned();
    let first = factory.passport("here", 1, day(0), under("C-1"));
    let [_, there] =
        [&first, &factory.passport("there", 1, day(0), under("C-1"))].map(|passport| factory.put(passport));
    assert!(factory.alarms().is_empty());
    let again = factory.passport("here", 2, day(1), |content| {
        made_from(&first, true)(content);
        under("C-2")(content);
    });
    factory.put(&again);
    let words = || {
        let alarms = factory.register("passports", now()).0.alarms;
        alarms
            .into_iter()
            .filter(|alarm| alarm.kind.key() == "certificates")
            .map(|alarm| alarm.words)
            .collect::<Vec<_>>()
    };
    let due = "SPS-2/0017 has passports in force under certificate C-1 and certificate C-2; certificate C-1 was replaced by C-2 (SPS-2/0017/here/2)";
    assert_eq!(words(), [due]);
    // The one under the old certificate is not in force any more.
    factory.remove(&there);
    assert!(words().is_empty());
    // Issued from the old certificate once more, when the new one has expired or was withdrawn.
    factory.put(&factory.passport("hall", 1, day(2), under("C-1")));
    factory.write("passports/revocation-1.yaml", factory.list_of(&factory.key, &[&again]));
    assert_eq!(
        words(),
        [
            "SPS-2/0017 has passports in force under certificate C-1; certificate C-1 was replaced by C-2 (SPS-2/0017/here/2)"
        ]
    );
    let (register, _) = factory.register("passports", now());
    assert_eq!(register.against_certificate("SPS-2/0017", "C-1").len(), 1);
    assert_eq!(register.against_certificate("SPS-2/0017", "C-2").len(), 1);
    assert!(register.against_certificate("SPS-2/0018", "C-2").is_empty());
}

#[test]
fn a_site_that_is_called_revocation_blocks_no_list() {
    let factory = Factory::new();
    let first = factory.passport("revocation", 1, day(0), |_| {});
    factory.put(&first);
    let lists = || search::lists(&factory.path("passports"), &factory.path("passports"), &factory.trust, now());
    let newest = || lists().map(|lists| lists.newest().map(|list| list.sequence));
    assert_eq!(newest().unwrap(), None);
    assert!(factory.verify(&first).valid());
    let list = factory.list_of(&factory.key, &[&first]);
    factory.write("passports/revocation-1.yaml", &list);
    assert_eq!(newest().unwrap(), Some(1));
    // Whatever the lists are called; but none is continued where one of them is damaged.
    factory.remove("passports/revocation-1.yaml");
    factory.write("passports/old.txt", &list);
    assert_eq!(newest().unwrap(), Some(1));
    factory.write("passports/older.txt", list.replace("latitude", "longitude"));
    newest().unwrap_err();
    let none = search::lists(Path::new("no such folder"), Path::new("none"), &factory.trust, now()).unwrap();
    assert_eq!(none.newest(), None);
}
