//! Issue of passports: of stands that were prepared, at the limits of dates and of positions.

use crate::inside::fixtures;
use dtg_passport::document::{Signer, SigningFailed};
use dtg_passport::folder::{Authority, Folder, FolderRefused};
use dtg_passport::passport::annotations;
use dtg_passport::passport::content::{REFERENCE_GYRO, derive};
use dtg_passport::passport::issue::{Issue, IssueRefused, PreparedStand, draft};
use dtg_passport::stand::Stand;
use dtg_passport::trust::{Signature, SigningKey};
use std::fs;

const SITES: [&str; 3] = [
    include_str!("../../sites/moscow-bmstu.yaml"),
    include_str!("../../sites/ny-alesund-kartverket.yaml"),
    include_str!("../../sites/singapore-nus.yaml"),
];

/// The shipped stands, and reduced copies of each: no datum, seven positions, no optional statement.
fn stands() -> Vec<Stand> {
    let variants = |text: &str| {
        let stand = fixtures::stand(text);
        let without_datum = Stand { datum: None, ..stand.clone() };
        let mut seven = stand.clone();
        seven.positions.remove(3);
        let mut bare = stand.clone();
        bare.certificate.repeatability_arcsec = None;
        bare.certificate.traceability = None;
        bare.certificate.valid_until = None;
        bare.certificate.valid_until_basis = None;
        bare.positions.iter_mut().for_each(|position| position.u_beta_arcsec = None);
        [stand, without_datum, seven, bare]
    };
    [fixtures::DEGREES, fixtures::ARC_MINUTES].into_iter().flat_map(variants).collect()
}

fn order() -> Issue {
    Issue::first(fixtures::ISSUER, fixtures::at(fixtures::ISSUED_AT))
}

#[test]
fn what_a_stand_has_in_common_is_what_each_passport_would_find() {
    for stand in stands() {
        let prepared = PreparedStand::new(stand.clone());
        for site in SITES.map(fixtures::site) {
            let draft = prepared.draft(&site, &order()).unwrap();
            assert_eq!(draft.payload(), annotations::payload(draft.content()));
            let alone = derive(&stand.positions, &site, &REFERENCE_GYRO).unwrap();
            let content = draft.content().clone();
            assert_eq!((content.earth, content.matrices), (alone.earth, alone.matrices));
            assert_eq!((content.vectors, content.self_check), (alone.vectors, alone.self_check));
        }
    }
}

/// A signer that signs another text, as a faulty token would.
struct Faulty<'a>(&'a SigningKey);

impl Signer for Faulty<'_> {
    fn sign(&self, namespace: &str, message: &[u8]) -> Result<Signature, SigningFailed> {
        let altered: Vec<u8> = message.iter().map(|byte| byte ^ 1).collect();
        Ok(self.0.sign(namespace, &altered)?)
    }
}

#[test]
fn a_passport_with_a_wrong_signature_or_an_untrusted_key_is_not_written() {
    let (key, site, clock) = (SigningKey::generate().unwrap(), fixtures::site(SITES[0]), || order().issued_at);
    let (trust, stand) = (fixtures::trust(&key), PreparedStand::new(fixtures::stand(fixtures::DEGREES)));
    let root = tempfile::tempdir().unwrap();
    let issue = |signer: &(dyn Signer + Sync)| {
        let authority = Authority::new(fixtures::ISSUER, signer, &trust, &clock);
        let authority = Authority { register_signer: None, ..authority };
        Folder::new(root.path()).issue(&stand, &site, &order(), &authority)
    };
    let stranger = SigningKey::generate().unwrap();
    for (signer, check) in [(&Faulty(&key) as &(dyn Signer + Sync), "signature"), (&stranger, "signer")] {
        let refused = issue(signer).unwrap_err();
        assert!(matches!(&refused, FolderRefused::NotVerifiable(found, _) if *found == check), "{check}: {refused}");
    }
    let left: Vec<_> = fs::read_dir(root.path()).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
    // With its own key the same order is carried out.
    issue(&key).unwrap();
}

/// Expected: three positions give six readings, fewer than the eight parameters; seven give fourteen.
#[test]
fn a_stand_that_determines_no_gyro_is_issued_on_request_alone() {
    let (whole, site) = (fixtures::stand(fixtures::ARC_MINUTES), fixtures::site(SITES[0]));
    let with = |positions: usize| Stand { positions: whole.positions[..positions].to_vec(), ..whole.clone() };
    let all_the_same = Issue { allow_uncalibratable: true, ..order() };
    draft(&with(7), &site, &order()).unwrap();
    for few in [1, 2, 3] {
        assert_eq!(draft(&with(few), &site, &order()), Err(IssueRefused::Uncalibratable), "{few}");
        draft(&with(few), &site, &all_the_same).unwrap();
    }
}

/// All positions have the same orientation, so n_2 is zero.
#[test]
fn a_stand_without_passports_says_so_for_each() {
    let (mut stand, site) = (fixtures::stand(fixtures::DEGREES), fixtures::site(SITES[0]));
    for position in &mut stand.positions {
        (position.theta_deg, position.phi_deg) = (0.0, 0.0);
        (position.alpha_arcsec, position.beta_arcsec, position.gamma_arcsec) = (0.0, 0.0, 0.0);
    }
    let prepared = PreparedStand::new(stand);
    for _ in 0..2 {
        assert!(matches!(prepared.draft(&site, &order()), Err(IssueRefused::Singular(_))));
    }
}
