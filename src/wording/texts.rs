//! Every text in all languages, from the tables in `texts/`; `build.rs` makes an item of each.

/// Takes the tables, and lists them for the tests.
macro_rules! tables {
    ($($(#[$what:meta])* $name:ident)*) => {
        $(
            $(#[$what])*
            // Features use parts of a table; in the whole program an unused text is a warning.
            #[cfg_attr(not(feature = "cli"), allow(dead_code))]
            // A text has as many values as its sentence needs.
            #[allow(clippy::too_many_arguments)]
            pub(crate) mod $name {
                include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
            }
        )*
        /// Every table with its name.
        #[cfg(test)]
        pub(crate) const TABLES: &[(&str, &[(&str, super::Text)])] = &[$((stringify!($name), $name::ALL)),*];
    };
}

tables! {
    /// Inputs that a passport does not state, and the effect of each.
    absences
    /// The report of a calibration.
    calibration
    /// Names of the causes in an uncertainty budget.
    causes
    /// The record of a certification.
    certification
    /// The checks of a verification and their results; failures for which no page is made are not included.
    checks
    /// Findings of a comparison that are warnings, not decisions.
    comparison
    /// Directions at a site.
    compass
    /// A digital calibration certificate.
    dcc
    /// What a factory hands to a laboratory, and what was received.
    delivery
    /// Differences of two passports.
    difference
    /// Causes that explain the readings of a calibration; `{p}` is a probability with its relation.
    finding
    /// A stand over the years.
    history
    /// Stated values that are possible, but usually in another unit, such as parts per million instead of percent.
    implausible
    /// Findings on readings and certificates. `{p}` is a probability with its relation.
    findings
    /// The printed passport: content of the signed file.
    passport
    /// Words in pictures, and their descriptions.
    pictures
    /// The printed passport: parts to fill in by hand.
    record
    /// Orders of a batch, and a recertification.
    issued
    /// A plan of positions.
    plan
    /// Registers of a folder, and the states of passports.
    register
    /// Remarks on a certification, and the findings of a comparison with the last certificate. `{p}` is a probability with
    /// its relation.
    remarks
    /// The contents of a workspace.
    status
    /// Angles of a file or a run in another unit, column or row.
    transformations
    /// Units, and the hemispheres of coordinates. Units of angles are the same in every language.
    units
    /// The answer of a verification.
    verdict
    /// Words that occur on any page.
    words
}
