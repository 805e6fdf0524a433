//! Printed passport.
//!
//! Only an authentic passport is printed: its text, signature, content, signer and numbers pass verification. An
//! authentic passport that may not be used (expired, superseded, for another site) becomes a page that says so in large
//! letters.
//!
//! * `front`: identification, signer, result of verification.
//! * `checks`: each check in words.
//! * `general`: the stand and its certificate.
//! * `characteristics`: the certified deviations, the site.
//! * `numbers`: the numbers that a calibration uses.
//! * `accuracy`: expected calibration uncertainty, inputs that are not stated.
//! * `record`: the parts to fill in by hand.

pub(crate) mod accuracy;
pub(super) mod characteristics;
pub(super) mod checks;
mod front;
pub(super) mod general;
pub(crate) mod numbers;
mod record;

use super::language::{Languages, values};
use super::parts::{contents, data_address, numbered, section, verbatim};
use super::shell::{Margins, document};
use super::symbols::italic;
use super::texts::{passport as texts, record as record_texts};
use crate::document::sha256_hex;
use crate::passport::{Content, Question, Trust, Verification, verify};
use crate::trust::PublicKey;
use maud::{Markup, html};

/// The printed form of a verified passport.
#[derive(Debug, Clone)]
pub struct PassportPage<'a> {
    text: &'a str,
    /// SHA-256 of the passport's file, lower-case hexadecimal.
    pub(crate) sha256: String,
    question: &'a Question,
    pub(crate) verification: Verification,
    pub(crate) content: Content,
    /// Key that signed the passport.
    pub(crate) key: PublicKey,
}

impl<'a> PassportPage<'a> {
    /// Verifies the bytes of a passport. `name` is the name of the file in messages.
    ///
    /// # Errors
    /// Returns the verification if the passport is not authentic; no part of it may then be printed.
    pub fn verified(
        name: &str,
        bytes: &'a [u8],
        trust: &Trust,
        question: &'a Question,
    ) -> Result<Self, Box<Verification>> {
        Self::of(bytes, question, verify(name, bytes, trust, question))
    }

    /// Creates the page of a passport that was already verified with the same trust and question.
    ///
    /// # Errors
    /// Returns the verification if the passport is not authentic, as [`Self::verified`] does.
    pub fn of(bytes: &'a [u8], question: &'a Question, verification: Verification) -> Result<Self, Box<Verification>> {
        let text = std::str::from_utf8(bytes).ok();
        let genuine = verification.authentic().map(|(content, key)| (content.clone(), key.clone()));
        match text.zip(genuine) {
            Some((text, (content, key))) => {
                Ok(Self { text, sha256: sha256_hex(bytes), question, verification, content, key })
            }
            None => Err(Box::new(verification)),
        }
    }

    /// Returns the page as one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let header = &self.content.passport;
        let margins = Margins {
            top_left: self.margin(languages),
            top_right: checks::warning(self, languages),
            bottom_left: texts::MARGIN_SHA256.filled(languages.first(), values! { sha256: self.sha256 }),
        };
        let title = format!("{} {}", languages.spoken(texts::TITLE), header.id);
        document(languages, &title, &margins, &self.body(languages))
    }

    /// Returns the name of the signed file, made from the site's id and the revision; a saved copy has it too.
    fn file_name(&self) -> String {
        format!("{}-{}.yaml", self.content.site.id, self.content.passport.revision)
    }

    fn margin(&self, languages: &Languages) -> String {
        let (stand, site) = (&self.content.stand, &self.content.site.id);
        let stand = format!("{}/{}", stand.model, stand.serial);
        let revision = &self.content.passport.revision;
        texts::MARGIN_PASSPORT.filled(languages.first(), values! { stand, site, revision })
    }

    fn body(&self, languages: &Languages) -> Markup {
        let address = data_address("application/yaml", self.text.as_bytes());
        let sections = [
            ("general", texts::GENERAL, general::section(self, languages)),
            ("characteristics", texts::CHARACTERISTICS, characteristics::section(self, languages)),
            ("numbers", texts::NUMBERS, numbers::section(self, languages)),
            ("accuracy", texts::ACCURACY, accuracy::section(self, languages)),
            ("record", record_texts::RECORD, record::section(self, languages)),
        ];
        let contents = contents(languages, texts::SAVE, (&address, &self.file_name()), &sections, texts::ANNEX);
        html! {
            (front::title(self, languages))
            main {
                (front::section(self, languages, &contents))
                (numbered(languages, &sections))
                (self.annex(languages))
            }
        }
    }

    /// Writes the signed file verbatim, to read, to copy and to save.
    fn annex(&self, languages: &Languages) -> Markup {
        let (id, name) = (&self.content.passport.id, self.file_name());
        let end = languages.label_with(|language| texts::END.filled(language, values! { id }));
        let body = html! {
            (checks::table(self, languages))
            (languages.paragraph_with(|language| italic(&texts::ANNEX_NOTE.filled(language, values! { name }))))
            (verbatim("en", self.text, &end))
        };
        section(languages, "annex", texts::ANNEX, body)
    }
}
