//! No page is made of a passport that is not its issuer's own word.

use crate::cases;
use crate::fixtures;
use dtg_passport::passport::{Code, Question, Trust, Verification};
use dtg_passport::report::{Language, PassportPage};
use dtg_passport::trust::SigningKey;

fn page<'a>(bytes: &'a [u8], trust: &'a Trust, question: &'a Question) -> Result<PassportPage<'a>, Box<Verification>> {
    PassportPage::verified("passport.yaml", bytes, trust, question)
}

/// The code of the first check that failed.
fn first_failure(verification: &Verification) -> Code {
    verification.checks().iter().find(|check| check.passed() == Some(false)).expect("a check that failed").code
}

#[test]
fn neither_altered_nor_of_a_stranger_nor_of_a_revoked_key() {
    let good = cases::usual("usual-en", &[Language::English]);
    assert!(page(good.passport.as_bytes(), &good.trust, &good.question).is_ok());

    let altered = good.passport.replacen("alpha_arcsec: 12.4", "alpha_arcsec: 12.5", 1);
    let refused = page(altered.as_bytes(), &good.trust, &good.question).unwrap_err();
    assert_eq!(first_failure(&refused), Code::Altered);

    let stranger = fixtures::trust(&SigningKey::generate().unwrap());
    let refused = page(good.passport.as_bytes(), &stranger, &good.question).unwrap_err();
    assert_eq!(first_failure(&refused), Code::UnknownKey);

    let question = Question { issuer: Some("somebody@else.example".to_owned()), ..good.question.clone() };
    let refused = page(good.passport.as_bytes(), &good.trust, &question).unwrap_err();
    assert_eq!(first_failure(&refused), Code::WrongIssuer);

    let key = SigningKey::generate().unwrap();
    let passport = fixtures::signed(&payload(), &key);
    let question = fixtures::question();
    assert!(page(passport.as_bytes(), &fixtures::trust(&key), &question).is_ok());
    let revoked = fixtures::trust_without(&key, key.public_key().to_openssh().as_bytes());
    let refused = page(passport.as_bytes(), &revoked, &question).unwrap_err();
    assert_eq!(first_failure(&refused), Code::KeyRevoked);
}

fn payload() -> String {
    let (stand, site) = (fixtures::stand(fixtures::ARC_MINUTES), fixtures::site(fixtures::SITE));
    fixtures::drafted(&stand, &site, 1).payload().to_owned()
}

/// Rightly signed, but a number does not follow: the issuer's mistake is not printed either.
#[test]
fn nor_with_a_wrong_number() {
    let key = SigningKey::generate().unwrap();
    let right = payload();
    let (before, number) = right.split_once("horizontal_deg_per_h: ").unwrap();
    let (number, after) = number.split_once('\n').unwrap();
    let wrong: f64 = number.parse::<f64>().unwrap() + 1e-6;
    let passport = fixtures::signed(&format!("{before}horizontal_deg_per_h: {wrong}\n{after}"), &key);
    let (trust, question) = (fixtures::trust(&key), fixtures::question());
    let refused = page(passport.as_bytes(), &trust, &question).unwrap_err();
    assert_eq!(first_failure(&refused), Code::WrongNumber);
}
