//! Certified stand file as text: canonical, with comments on what its numbers are.

use super::Certification;
use crate::stand::Stand;
use crate::text::Unreadable;
use crate::text::yaml::write_document;

impl Certification {
    /// Returns the stand file (`dtg-stand/1`), which is read back and compared first; `name` is its name in messages.
    ///
    /// # Errors
    /// Returns [`Unreadable`] if its reader refuses the file, for instance because a mean is outside the certifiable
    /// range.
    pub fn to_yaml(&self, name: &str) -> Result<String, Unreadable> {
        write_document(name, &self.stand, &|path| self.comments(path), Stand::from_yaml)
    }

    fn comments(&self, path: &str) -> Vec<String> {
        match path {
            "format" => vec!["Stand certified from repeated readings. Standard uncertainties (k = 1).".to_owned()],
            "certificate.repeatability_arcsec" => vec![
                "Repeatability of one visit, without the part common to all positions of a run; common_* are uncertainties of \
                 the mean of the runs."
                    .to_owned(),
            ],
            "positions" => {
                let means = format!("Means of {} runs, with the standard uncertainties u_* of the means.", self.runs.len());
                let warnings = self.warnings.iter().map(|warning| format!("Warning: {warning}."));
                [means].into_iter().chain(warnings).collect()
            }
            _ => Vec::new(),
        }
    }
}
