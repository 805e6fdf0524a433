//! Printed passport.
//!
//! Only an authentic passport is printed: its text, signature, content, signer and numbers pass verification. An
//! authentic passport that may not be used (expired, superseded, for another site) becomes a page that says so in large
//! letters.
//!
//! * `front`: identification, signer, result of verification.
//! * `checks`: each check in words.
//! * `record`: the parts to fill in by hand.

pub(crate) mod checks;
mod front;
mod record;

use super::language::{Language, Languages};
use super::parts::{Section, data_address};
use super::shell::{Margins, document};
use crate::document::sha256_hex;
use crate::passport::{Content, Question, Trust, Verification, verify};
use crate::report::doc::told;
use crate::report::passport;
use crate::trust::PublicKey;
use crate::wording::texts::{passport as texts, record as record_texts};
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
    /// `true` to print the signed file verbatim too; otherwise it is on the screen and as a download only.
    pub prints_annex: bool,
    /// `true` to print the blank forms of [GOST R 2.610](crate::bibliography::Bibliography::GostR2610) in any language;
    /// otherwise a page has them in Russian alone.
    pub prints_forms: bool,
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
                let sha256 = sha256_hex(bytes);
                Ok(Self {
                    text,
                    sha256,
                    question,
                    verification,
                    content,
                    key,
                    prints_annex: false,
                    prints_forms: false,
                })
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
            bottom_left: texts::margin_sha256(&self.sha256).plain(languages.first()),
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
        texts::margin_passport(stand, site, revision).plain(languages.first())
    }

    fn body(&self, languages: &Languages) -> Markup {
        let address = data_address("application/yaml", self.text.as_bytes());
        let mut sections: Vec<Section> = passport::sections(&self.content).into();
        if self.prints_forms || (languages.single() && languages.first() == Language::Russian) {
            let forms = record::section(&self.content.stand, &self.content.passport.id);
            sections.push(("record", record_texts::RECORD, forms));
        }
        let contents = languages.contents(texts::SAVE, (&address, &self.file_name()), &sections, texts::ANNEX);
        html! {
            (front::title(self, languages))
            main {
                (front::section(self, languages, &contents))
                (languages.numbered(&sections))
                (self.annex(languages))
            }
        }
    }

    /// Writes the signed file verbatim, to read, to copy and to save.
    fn annex(&self, languages: &Languages) -> Markup {
        let note = (texts::ANNEX, told(texts::annex_note(self.file_name())));
        languages.annex(note, ("en", self.text), &told(texts::end(&self.content.passport.id)), self.prints_annex)
    }
}
