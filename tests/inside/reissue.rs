//! What a re-issue takes over from an old passport whose key nobody trusts any more: its id and its hash, and nothing
//! that whoever signed it could have put there.

use crate::inside::fixtures;
use crate::inside::fixtures::{ISSUER, issued_plus};
use dtg_passport::gyro::GyroType;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::accuracy::Stated;
use dtg_passport::passport::issue::{Issue, PreparedStand, draft};
use dtg_passport::passport::reissue::{Reissue, successor};
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::trust::SigningKey;
use std::sync::Arc;

#[test]
fn of_a_passport_that_may_only_be_named_nothing_but_its_id_and_hash_is_taken_over() {
    let (stand, site) = (fixtures::stand(fixtures::ARC_MINUTES), fixtures::site(fixtures::SITE));
    let issue = Issue {
        accuracy: Some(Stated { gyro: GyroType::gvk_6(), laboratory: Laboratory::paper() }),
        valid_until: Some("2027-11-02".parse().unwrap()),
        ..Issue::first(ISSUER, issued_plus(0))
    };
    let (lost, new) = (SigningKey::generate().unwrap(), SigningKey::generate().unwrap());
    let old = draft(&stand, &site, &issue).unwrap().sign(&lost).unwrap();
    let order = Reissue {
        stand: Some(Arc::new(PreparedStand::new(stand.clone()))),
        site: Some(site.clone()),
        ..Reissue::new(ISSUER, issued_plus(3600), "the key was lost")
    };
    let accuracy_of_successor = |trust: &Trust| {
        let verification = verify("old.yaml", old.as_bytes(), trust, &Question::at(order.issued_at));
        let content = successor(old.as_bytes(), &verification, &order).unwrap().draft(2).unwrap().content().clone();
        assert_eq!(content.passport.valid_until, stand.certificate.valid_until);
        content.accuracy
    };
    // A passport that holds gives its gyro and laboratory too; one whose key is unknown could hold anybody's.
    assert!(accuracy_of_successor(&fixtures::trust(&lost)).is_some());
    assert_eq!(accuracy_of_successor(&fixtures::trust(&new)), None);
}
