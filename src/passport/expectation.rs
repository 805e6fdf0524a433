//! What a passport says when its numbers are those that this program computes: to read it is then to write and compare.

use super::content::{Content, Derived, Header, check_inputs, derive_at};
use crate::coefficients::StandGeometry;
use crate::document;
use crate::gyro::{GyroType, Parameters};
use crate::site::{Earth, Site};
use crate::stand::{self, Certificate, CertifiedPosition, Datum, Identity};
use crate::text::scalar::Identifier;
use crate::text::{Problems, record};
use std::collections::HashMap;

/// So many sites are kept; with the next one it begins anew.
const MOST_SITES: usize = 4096;

record! {
    /// What a passport begins with. All the rest follows from it, the gyro of the self-check and the accuracy aside.
    pub struct Given {
        /// As of [`Content`].
        pub format: String,
        /// As of [`Content`].
        pub passport: Header,
        /// As of [`Content`].
        pub stand: Identity,
        /// As of [`Content`].
        pub certificate: Certificate,
        /// As of [`Content`].
        pub datum: Option<Datum>,
        /// As of [`Content`].
        pub positions: Vec<CertifiedPosition>,
        /// As of [`Content`].
        pub site: Site,
    }
}

/// What is expected, and what was worked out before: the geometry of the last stand, the Earth at every site.
#[derive(Debug, Clone)]
pub struct Expectation {
    gyro: Parameters,
    stand: Option<(Vec<CertifiedPosition>, StandGeometry)>,
    sites: HashMap<Identifier, (Site, Earth)>,
}

impl Expectation {
    /// That the self-check is for the type of gyro that is usual.
    pub fn new() -> Self {
        Self { gyro: GyroType::gvk_6().nominal, stand: None, sites: HashMap::new() }
    }

    /// From now on a self-check is expected for the gyro that this passport has it for.
    pub fn learn(&mut self, content: &Content) {
        if let Some(self_check) = &content.self_check {
            self.gyro = self_check.parameters();
        }
    }

    /// The whole passport, without an accuracy; `None` when what is given breaks a rule or nothing follows from it.
    pub fn content(&mut self, given: Given) -> Option<Content> {
        let rules = |given: &Given, problems: &mut Problems| {
            check_inputs(&given.certificate, &given.positions, &given.site, problems);
        };
        if !document::obeys(&given, rules) {
            return None;
        }
        let earth = self.earth(&given.site);
        let Given { format, passport, stand, certificate, datum, positions, site } = given;
        let geometry = geometry(&mut self.stand, &positions)?;
        let Derived { earth, matrices, vectors, self_check } = derive_at(geometry, earth, &self.gyro);
        Some(Content {
            format,
            passport,
            stand,
            certificate,
            datum,
            positions,
            site,
            earth,
            matrices,
            vectors,
            self_check,
            accuracy: None,
        })
    }

    fn earth(&mut self, site: &Site) -> Earth {
        match self.sites.get(&site.id) {
            Some((known, earth)) if known == site => earth.clone(),
            _ => {
                if self.sites.len() >= MOST_SITES {
                    self.sites.clear();
                }
                let earth = site.earth();
                self.sites.insert(site.id.clone(), (site.clone(), earth.clone()));
                earth
            }
        }
    }
}

fn geometry<'k>(
    known: &'k mut Option<(Vec<CertifiedPosition>, StandGeometry)>,
    positions: &[CertifiedPosition],
) -> Option<&'k StandGeometry> {
    if known.as_ref().is_none_or(|(of, _)| of != positions) {
        *known = Some((positions.to_vec(), stand::geometry(positions).ok()?));
    }
    known.as_ref().map(|(_, geometry)| geometry)
}

impl Default for Expectation {
    fn default() -> Self {
        Self::new()
    }
}
