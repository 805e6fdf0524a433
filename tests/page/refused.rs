//! No page is made of a passport whose numbers do not follow, even if its issuer signed it. Other refusals are in `cmd/render.md`.

use crate::fixtures;
use dtg_passport::passport::Code;
use dtg_passport::report::PassportPage;
use dtg_passport::trust::SigningKey;

#[test]
fn a_wrong_number_that_is_rightly_signed_has_no_page() {
    let key = SigningKey::generate().unwrap();
    let (stand, site) = (fixtures::stand(fixtures::ARC_MINUTES), fixtures::site(fixtures::SITE));
    let draft = fixtures::drafted(&stand, &site, 1);
    let (before, number) = draft.payload().split_once("horizontal_deg_per_h: ").unwrap();
    let (number, after) = number.split_once('\n').unwrap();
    let wrong: f64 = number.parse::<f64>().unwrap() + 1e-6;
    let passport = fixtures::signed(&format!("{before}horizontal_deg_per_h: {wrong}\n{after}"), &key);
    let (trust, question) = (fixtures::trust(&key), fixtures::question());
    let refused = PassportPage::verified("passport.yaml", passport.as_bytes(), &trust, &question).unwrap_err();
    let failed = refused.checks().iter().find(|check| check.passed() == Some(false)).unwrap();
    assert_eq!(failed.code, Code::WrongNumber);
}
