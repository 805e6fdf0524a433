//! Stand and site of a passport as files again, number for number: the inputs of another issue.

use super::content::Content;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::Unreadable;
use crate::text::yaml::write_document;

/// Returns the stand file (`dtg-stand/1`) of a passport. It is read back and compared first.
///
/// Every passport of one certificate gives the same text.
pub(crate) fn stand_file(content: &Content) -> Result<String, Unreadable> {
    let comment = "Stand exported from a verified passport, number for number. Standard uncertainties (k = 1).";
    write_document("the exported stand file", &content.to_stand(), &at_the_head(comment), Stand::from_yaml)
}

/// Returns the site file (`dtg-site/1`) of a passport. It is read back and compared first.
///
/// # Errors
/// Returns [`Unreadable`] if its reader refuses the file: passports of earlier versions may have sites that break rules
/// for new site files.
pub(crate) fn site_file(content: &Content) -> Result<String, Unreadable> {
    let comment = "Site exported from a verified passport, number for number.";
    write_document("the exported site file", &content.site, &at_the_head(comment), Site::from_yaml)
}

fn at_the_head(comment: &str) -> impl Fn(&str) -> Vec<String> {
    move |path| if path == "format" { vec![comment.to_owned()] } else { Vec::new() }
}
