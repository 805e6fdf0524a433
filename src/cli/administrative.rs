//! Administrative file of Digital Calibration Certificates.

use super::{Failure, inputs};
use crate::dcc::Administrative;
use crate::text::placeholder::filled_in;
use crate::text::{Kind, Problems, Unreadable, name_of};
use std::path::Path;

/// Said once for all certificates of a run.
pub(super) const DCC_IS_NOT_SIGNED: &str =
    "the DCC is not signed; only the passport in it is: save that passport and verify it";

/// Administrative file that was read, or none.
pub(super) struct AdministrativeFile {
    name: String,
    text: String,
    content: Option<Administrative>,
}

impl AdministrativeFile {
    /// Reads the file. Without one, everything that it would state is missing.
    pub(super) fn read(path: Option<&Path>) -> Result<Self, Failure> {
        let Some(path) = path else {
            return Ok(Self { name: "--administrative".to_owned(), text: String::new(), content: None });
        };
        let name = name_of(path);
        let bytes = inputs::bytes(path, Kind::Dcc.words())?;
        let content = filled_in(&name, &bytes, Administrative::from_yaml)?;
        let text = String::from_utf8_lossy(&bytes);
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text).to_owned();
        Ok(Self { name, text, content: Some(content) })
    }

    pub(super) fn content(&self) -> Option<&Administrative> {
        self.content.as_ref()
    }

    /// Returns the refusal of a DCC, with the lines of the file.
    pub(super) fn refuse(&self, problems: Problems) -> Unreadable {
        match &self.content {
            Some(_) => problems.refuse(&self.name, &self.text).in_text(self.text.as_bytes()),
            None => problems.refuse_by_field(&self.name),
        }
    }
}
