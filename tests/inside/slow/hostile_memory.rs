//! What a hostile file of 1 MiB may cost in memory, whoever signed it.
//!
//! `cargo test --release --lib inside::slow::hostile_memory -- --nocapture` prints the figures of docs/development/figures.md.

use super::alone::alone;
use crate::fuzzing::memory::{bound, peak};
use crate::inside::{fixtures, written};
use dtg_passport::folder::overview::{Overview, Query};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::accuracy::Accuracy;
use dtg_passport::passport::annotations::payload;
use dtg_passport::passport::content::{Content, PositionVectors};
use dtg_passport::passport::{CheckName, Code, Trust, verify};
use dtg_passport::stand::{CertifiedPosition, MOST_POSITIONS};
use dtg_passport::text::LARGEST_DOCUMENT_BYTES;
use dtg_passport::trust::SigningKey;
use std::fs;
use std::time::Instant;

/// A passport of the paper's eight positions and more, made from the eight.
fn with_positions(count: usize) -> Content {
    let mut content = fixtures::content(&fixtures::stand(fixtures::DEGREES), &fixtures::site(fixtures::SITE));
    let of = content.positions[0].clone();
    let more = (8..count).map(|index| CertifiedPosition {
        i: 3 + index as u32 / 1000,
        j: index as u32 % 1000 + 1,
        ..of.clone()
    });
    content.positions.extend(more);
    let gyro = GyroType::gvk_6();
    let standard_uncertainty = gyro.nominal.clone();
    content.accuracy = Some(Accuracy { gyro, laboratory: Laboratory::paper(), standard_uncertainty });
    content
}

fn with_vectors(count: usize) -> Content {
    let mut content = with_positions(8);
    let of = content.vectors[0].clone();
    content.vectors = (0..count).map(|_| PositionVectors { ..of.clone() }).collect();
    content
}

/// A passport of so many positions as no issuer writes it, so that it is for the reader that tells what is wrong.
fn in_another_form(count: usize) -> String {
    payload(&with_positions(count)).replace("phi_deg: 0.0", "phi_deg: 0.00")
}

/// The largest of these that fits into the size limit, signed.
fn largest(make: impl Fn(usize) -> String, key: &SigningKey) -> String {
    let file = |count| fixtures::signed(&make(count), key);
    let bytes = |count| file(count).len();
    let each = (bytes(1008) - bytes(508)) / 500;
    let file = file((LARGEST_DOCUMENT_BYTES - bytes(8)) / (each + 4));
    assert!((LARGEST_DOCUMENT_BYTES * 9 / 10..=LARGEST_DOCUMENT_BYTES).contains(&file.len()), "{}", file.len());
    file
}

/// The result, and the most memory that it took at a time, in bytes; this and the time are printed for figures.md.
fn measured<T>(name: &str, run: impl FnOnce() -> T) -> (T, usize) {
    let start = Instant::now();
    let (result, most) = peak(run);
    println!("{name}: {:.1} MiB, {:.0?}", most as f64 / (1 << 20) as f64, start.elapsed());
    (result, most)
}

#[test]
fn a_hostile_file_costs_little_memory_alone_and_in_a_folder() {
    alone(|| {
        let (factory, stranger) = (SigningKey::generate().unwrap(), SigningKey::generate().unwrap());
        let trust = fixtures::trust(&factory);
        let verified = |name: &str, file: &str| {
            let (answer, most) = measured(name, || verify(name, file.as_bytes(), &trust, &fixtures::question()));
            assert!(!answer.valid() && most <= bound(file.len()), "{name}: {most} bytes, {:?}", answer.checks());
            answer
        };
        let files = [
            ("positions", largest(|count| payload(&with_positions(count)), &stranger)),
            ("positions of the factory", largest(|count| payload(&with_positions(count)), &factory)),
            ("vectors", largest(|count| payload(&with_vectors(count)), &stranger)),
            ("positions in another form", largest(in_another_form, &stranger)),
        ];
        for (name, file) in &files {
            let answer = verified(name, file);
            assert_eq!(answer.code(CheckName::Schema), Some(Code::BadContent), "{name}");
            assert!(answer.checks().iter().all(|check| check.detail.len() < 10_000), "{name}");
        }
        // As many positions as there may be: of a stranger nothing is computed, of the factory everything.
        let full = written(&with_positions(MOST_POSITIONS), &stranger);
        let answer = verified("256 positions of a stranger", &full);
        let codes = [CheckName::Schema, CheckName::Signer, CheckName::Recomputed, CheckName::InForce];
        let found = codes.map(|name| answer.code(name));
        assert_eq!(found, [Code::Ok, Code::UnknownKey, Code::NotRun, Code::NotRun].map(Some));
        let own = written(&with_positions(MOST_POSITIONS), &factory);
        assert_eq!(verified("256 positions of the factory", &own).code(CheckName::Recomputed), Some(Code::WrongNumber));
        in_a_folder(&files, &factory, &trust);
    });
}

/// All of them in the folder of one stand, beside a good passport in that of another, by two threads.
fn in_a_folder(files: &[(&str, String)], factory: &SigningKey, trust: &Trust) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    for (index, (_, file)) in files.iter().enumerate() {
        write(&format!("SPS-9/0001/hostile-{index}.yaml"), file);
    }
    let good = fixtures::content(&fixtures::stand(fixtures::DEGREES), &fixtures::site(fixtures::SITE));
    write("SPS-1/0203/bench-1.yaml", &written(&good, factory));
    let question = fixtures::question();
    let query = Query { trust, question: &question, memory: None, may_lack: false, threads: 2 };
    let (found, most) = measured("a folder of them", || Overview::of(folder.path(), query).unwrap());
    assert!(most <= 2 * bound(LARGEST_DOCUMENT_BYTES), "{most} bytes");
    // The good passport has no register; the others are not authentic.
    assert_eq!(found.alarms.iter().map(|alarm| alarm.code.key()).collect::<Vec<_>>(), ["no_register"]);
    assert_eq!(found.remarks.len(), files.len());
}

/// Expected: a quarter of the limit of a listing, 64 MiB, for 20,000 files that are not passports and 1,500 false registers of
/// 1 MiB.
#[test]
fn junk_and_false_registers_cost_little_memory() {
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..20_000 {
            let place = folder.path().join(format!("SPS-9/{:04}", number / 1000));
            fs::create_dir_all(&place).unwrap();
            fs::write(place.join(format!("{number}.txt")), "junk\n").unwrap();
        }
        for number in 0..1_500 {
            let place = folder.path().join(format!("SPS-8/{number:04}"));
            fs::create_dir_all(&place).unwrap();
            let file = fs::File::create(place.join("register.yaml")).unwrap();
            std::io::Write::write_all(&mut &file, b"format: \"dtg-register/1\"\n").unwrap();
            file.set_len(1 << 20).unwrap();
        }
        let (trust, question) = (fixtures::trust(&SigningKey::generate().unwrap()), fixtures::question());
        let query = Query { trust: &trust, question: &question, memory: None, may_lack: false, threads: 2 };
        let (found, most) = measured("junk and false registers", || Overview::of(folder.path(), query).unwrap());
        assert!(most <= 16 << 20, "{most} bytes");
        assert_eq!(found.alarms.len(), 1_500);
    });
}
