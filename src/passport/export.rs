//! Stand and site of a passport as files again, number for number: the inputs of another issue.

use super::content::Content;
use crate::site::Site;
use crate::stand::Stand;
use crate::text::record::File;
use crate::text::{Unreadable, canonical};

/// Returns the stand file (`dtg-stand/1`) of a passport. It is read back and compared first.
///
/// Every passport of one certificate gives the same text.
///
/// # Errors
/// Returns [`Unreadable`] if its reader refuses the file.
pub(crate) fn stand_file(content: &Content) -> Result<String, Unreadable> {
    const NAME: &str = "the exported stand file";
    let stand = content.to_stand();
    let comment = "Stand exported from a verified passport, number for number. Standard uncertainties (k = 1).";
    let text = canonical::write(&File(stand.clone()), &|path| above_the_format(path, comment));
    let read = Stand::from_yaml(NAME, text.as_bytes())?;
    if read == stand { Ok(text) } else { Err(other_content(NAME)) }
}

/// Returns the site file (`dtg-site/1`) of a passport. It is read back and compared first.
///
/// # Errors
/// Returns [`Unreadable`] if its reader refuses the file: passports of earlier versions may have sites that break rules
/// for new site files.
pub(crate) fn site_file(content: &Content) -> Result<String, Unreadable> {
    const NAME: &str = "the exported site file";
    let comment = "Site exported from a verified passport, number for number.";
    let text = canonical::write(&File(content.site.clone()), &|path| above_the_format(path, comment));
    let read = Site::from_yaml(NAME, text.as_bytes())?;
    if read == content.site { Ok(text) } else { Err(other_content(NAME)) }
}

fn above_the_format(path: &str, comment: &str) -> Vec<String> {
    if path == "format" { vec![comment.to_owned()] } else { Vec::new() }
}

fn other_content(name: &str) -> Unreadable {
    Unreadable::whole(name, None, "other content than was written", "the same", "report this")
}
