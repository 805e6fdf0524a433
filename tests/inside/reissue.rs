//! What a re-issue takes over from an old passport whose key nobody trusts any more: its id and its hash, and nothing
//! that whoever signed it could have put there.

use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::accuracy::Stated;
use dtg_passport::passport::issue::{self, Issue, PreparedStand};
use dtg_passport::passport::reissue::{Reissue, successor};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::signing::allowed_signers_line;
use dtg_passport::site::Site;
use dtg_passport::stand::Stand;
use dtg_passport::trust::{AllowedSigners, SigningKey};
use jiff::Timestamp;
use std::sync::Arc;

fn time(text: &str) -> Timestamp {
    text.parse().unwrap()
}

fn trust(key: &SigningKey) -> Trust {
    let line = allowed_signers_line("factory", &key.public_key()).unwrap();
    Trust::of(AllowedSigners::parse("allowed_signers", line.as_bytes()).unwrap())
}

#[test]
fn of_a_passport_that_may_only_be_named_nothing_but_its_id_and_hash_is_taken_over() {
    let stand = Stand::from_yaml("stand.yaml", include_bytes!("../cmd/files/stand.yaml")).unwrap();
    let site = Site::from_yaml("here.yaml", include_bytes!("../cmd/files/sites/here.yaml")).unwrap();
    let issue = Issue {
        accuracy: Some(Stated { gyro: GyroType::gvk_6(), laboratory: Laboratory::paper() }),
        issuer: "factory".to_owned(),
        issued_at: time("2026-11-03T00:00:00Z"),
        valid_until: Some("2027-11-02".parse().unwrap()),
        revision: 1,
        reissued: None,
        allow_uncalibratable: false,
    };
    let (lost, new) = (SigningKey::generate().unwrap(), SigningKey::generate().unwrap());
    let old = issue::draft(&stand, &site, &issue).unwrap().sign(&lost).unwrap();
    let order = Reissue {
        stand: Some(Arc::new(PreparedStand::new(stand.clone()))),
        site: Some(site.clone()),
        ..Reissue::new("factory", time("2026-11-20T00:00:00Z"), "the key was lost")
    };
    let accuracy_of_successor = |trust: &Trust| {
        let verification = verify("old.yaml", old.as_bytes(), trust, &Question::at(order.issued_at));
        let content = successor(old.as_bytes(), &verification, &order).unwrap().draft(2).unwrap().content().clone();
        assert_eq!(content.passport.valid_until, stand.certificate.valid_until);
        content.accuracy
    };
    // A passport that holds gives its gyro and laboratory too; one whose key is unknown could hold anybody's.
    assert!(accuracy_of_successor(&trust(&lost)).is_some());
    assert_eq!(accuracy_of_successor(&trust(&new)), None);
}
