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

use super::language::Languages;
use super::shell::{Annex, Page, Section, first};
use crate::document::sha256_hex;
use crate::passport::{Content, Question, Trust, Verification, verify};
use crate::report::doc::{given, told};
use crate::report::passport;
use crate::trust::PublicKey;
use crate::wording::Language;
use crate::wording::texts::{passport as texts, record as record_texts};

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
        let Some((text, (content, key))) = text.zip(genuine) else { return Err(Box::new(verification)) };
        let (sha256, prints_annex, prints_forms) = (sha256_hex(bytes), false, false);
        Ok(Self { text, sha256, question, verification, content, key, prints_annex, prints_forms })
    }

    /// Returns the page as one self-contained HTML document.
    pub fn html(&self, languages: &Languages) -> String {
        let (stand, header) = (&self.content.stand, &self.content.passport);
        let name = format!("{}/{}", stand.model, stand.serial);
        let mut sections: Vec<Section> = passport::sections(&self.content).into();
        if self.prints_forms || (languages.single() && languages.first() == Language::Russian) {
            sections.push(("record", record_texts::RECORD, record::section(stand, &header.id)));
        }
        let file_name = self.file_name();
        let page = Page {
            margins: [
                first(texts::margin_passport(name, &self.content.site.id, header.revision)),
                checks::warning(self, languages.single()),
                first(texts::margin_sha256(&self.sha256)),
            ],
            name: given(&header.id),
            title: (texts::TITLE, front::name_of_the_stand(stand), given(&header.id)),
            head: checks::refusal(self).into_iter().chain([front::answers(self)]).collect(),
            front: Some((texts::FRONT, front::below_the_answers(self))),
            sections,
            signatures: Vec::new(),
            annex: Annex {
                heading: texts::ANNEX,
                note: told(texts::annex_note(file_name.as_str())),
                save: texts::SAVE,
                name: &file_name,
                media: "application/yaml",
                tag: "en",
                bytes: self.text.as_bytes().into(),
                end: told(texts::end(&header.id)),
                is_printed: self.prints_annex,
            },
        };
        page.html(languages)
    }

    /// Returns the name of the signed file, made from the site's id and the revision; a saved copy has it too.
    fn file_name(&self) -> String {
        format!("{}-{}.yaml", self.content.site.id, self.content.passport.revision)
    }
}
