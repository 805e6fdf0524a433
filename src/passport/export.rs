//! Stand and site of a passport as files again, number for number: the inputs of another issue.

use super::content::Content;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::record::File;
use crate::text::{Document, Unreadable, canonical};

/// Returns the stand file (`dtg-stand/1`) of a passport. It is read back and compared first.
///
/// Every passport of one certificate gives the same text.
pub(crate) fn stand_file(content: &Content) -> Result<String, Unreadable> {
    let comment = "Stand exported from a verified passport, number for number. Standard uncertainties (k = 1).";
    file("the exported stand file", comment, content.to_stand(), Stand::from_yaml)
}

/// Returns the site file (`dtg-site/1`) of a passport. It is read back and compared first.
///
/// # Errors
/// Returns [`Unreadable`] if its reader refuses the file: passports of earlier versions may have sites that break rules
/// for new site files.
pub(crate) fn site_file(content: &Content) -> Result<String, Unreadable> {
    let comment = "Site exported from a verified passport, number for number.";
    file("the exported site file", comment, content.site.clone(), Site::from_yaml)
}

fn file<T: Document + PartialEq>(
    name: &str,
    comment: &str,
    document: T,
    read: fn(&str, &[u8]) -> Result<T, Unreadable>,
) -> Result<String, Unreadable> {
    let file = File(document);
    let above = |path: &str| if path == "format" { vec![comment.to_owned()] } else { Vec::new() };
    let text = canonical::write(&file, &above);
    if read(name, text.as_bytes())? == file.0 {
        return Ok(text);
    }
    Err(Unreadable::whole(name, None, "other content than was written", "the same", "report this"))
}
