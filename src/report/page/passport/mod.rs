//! The printable passport.
//!
//! A page is made only of a passport that is its issuer's own word: text, signature, content, signer and numbers hold.
//! One that is good but may not be used (expired, superseded, for another place) becomes a page that says so large.
//!
//! * `front`: which passport, who signed it, what verification found.
//! * `checks`: each check in words.
//! * `general`: the stand and its certificate.
//! * `characteristics`: the certified deviations, the place of delivery.
//! * `numbers`: what a calibration computes with.
//! * `accuracy`: what the stand is good for, what is not stated.
//! * `record`: the parts to fill in with a pen.
//! * `annex`: the signed file.
//! * `figures`: where pictures stand.

pub(super) mod accuracy;
mod annex;
mod characteristics;
pub(super) mod checks;
mod figures;
mod front;
mod general;
pub(super) mod numbers;
mod record;

use super::language::Languages;
use super::shell::{Margins, document};
use super::texts::passport as texts;
use crate::document::sha256_hex;
use crate::passport::{Content, Question, Trust, Verification, verify};
use crate::register::Register;
use crate::trust::PublicKey;
use maud::{Markup, html};

/// A passport that was verified for a page.
#[derive(Debug, Clone)]
pub struct PassportPage<'a> {
    text: &'a str,
    sha256: String,
    trust: &'a Trust,
    question: &'a Question,
    verification: Verification,
    content: Content,
    key: PublicKey,
}

impl<'a> PassportPage<'a> {
    /// Verifies the bytes of a passport, and against `register` whether another one supersedes it; `name` is the file's
    /// name, for messages.
    ///
    /// # Errors
    /// The answer of the verification, when the passport is not its issuer's own word: nothing of it may be printed.
    pub fn verified(
        name: &str,
        bytes: &'a [u8],
        trust: &'a Trust,
        question: &'a Question,
        register: Option<&Register>,
    ) -> Result<Self, Box<Verification>> {
        let verification = verify(name, bytes, trust, question);
        let verification = match register {
            Some(register) => register.asked(verification, bytes),
            None => verification,
        };
        Self::of(bytes, trust, question, verification)
    }

    /// Of a passport that was verified already, with the same trust and question.
    ///
    /// # Errors
    /// As [`Self::verified`].
    pub fn of(
        bytes: &'a [u8],
        trust: &'a Trust,
        question: &'a Question,
        verification: Verification,
    ) -> Result<Self, Box<Verification>> {
        let text = std::str::from_utf8(bytes).ok();
        let genuine = verification.authentic().map(|(content, key)| (content.clone(), key.clone()));
        match text.zip(genuine) {
            Some((text, (content, key))) => {
                Ok(Self { text, sha256: sha256_hex(bytes), trust, question, verification, content, key })
            }
            None => Err(Box::new(verification)),
        }
    }

    /// What verification found.
    pub(crate) fn verification(&self) -> &Verification {
        &self.verification
    }

    /// What the passport says.
    pub(crate) fn content(&self) -> &Content {
        &self.content
    }

    /// SHA-256 of its file, lower-case hexadecimal.
    pub(crate) fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The key that signed it.
    pub(crate) fn key(&self) -> &PublicKey {
        &self.key
    }

    /// The page, one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let header = &self.content.passport;
        let margins = Margins {
            top_left: self.margin(languages),
            top_right: if self.verification.valid() {
                String::new()
            } else {
                checks::headline(self, languages.first())
            },
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), &[("sha256", &self.sha256)]),
        };
        let title = format!("{} {}", languages.spoken(texts::TITLE), header.id);
        document(languages, &title, &margins, &self.body(languages))
    }

    /// The file's name by its id: that of a saved copy too.
    fn file_name(&self) -> String {
        format!("{}-{}.yaml", self.content.site.id, self.content.passport.revision)
    }

    fn margin(&self, languages: &Languages) -> String {
        let (stand, site) = (&self.content.stand, &self.content.site.id);
        let stand = format!("{}/{}", stand.model, stand.serial);
        let revision = self.content.passport.revision.to_string();
        let values = [("stand", stand.as_str()), ("site", site.as_str()), ("revision", &revision)];
        texts::MARGIN_PASSPORT.filled(languages.first(), &values)
    }

    fn body(&self, languages: &Languages) -> Markup {
        html! {
            header.title {
                p.kind { (languages.label(texts::TITLE)) }
                h1 { (self.content.passport.id) }
                p.subject { (languages.label(texts::SUBTITLE)) }
            }
            main {
                (front::section(self, languages))
                (general::section(self, languages))
                (characteristics::section(self, languages))
                (numbers::section(self, languages))
                (accuracy::section(self, languages))
                (record::section(self, languages))
                (annex::section(self, languages))
            }
        }
    }
}
