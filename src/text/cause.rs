//! Recognised causes of errors in documents, and the advice on an error.

use super::words;

words! {
    /// Recognised cause of an error in a document; [`RefusalCause::code`] is its word in JSON. The second text is the usual
    /// advice.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum RefusalCause: pub code, advice {
        /// Comma as the decimal mark.
        DecimalComma = "decimal_comma", "use a decimal point";
        /// Unit of a column or key that is not written as in the format.
        HeaderUnit = "header_unit", "write the name as in the header of the format, which contains the unit";
        /// Row of units below the header.
        UnitsRow = "units_row", "delete it, because the names of the columns state the units";
        /// Second header, as in joined tables.
        RepeatedHeader = "repeated_header", "delete it, and check that the joined tables belong together";
        /// Row with means or other statistics.
        SummaryRow = "summary_row", "delete it, because the program computes from the readings themselves";
        /// Date that a spreadsheet program made of a number.
        SpreadsheetDate = "spreadsheet_date",
            "a spreadsheet program has made a date of a number: set the format of the column to text, and import the \
             original file again";
        /// Value or word that an instrument writes for an overload.
        Overload = "overload", "instruments write such a value for an overload";
        /// Angle that is right except for a full turn.
        FullTurn = "full_turn", "subtract or add a full turn";
        /// Times that begin again at midnight.
        Midnight = "midnight", "the times seem to start again at midnight: add 86400 s to them from there on";
        /// Control character, such as Ctrl-Z or NUL at the end of a file.
        ControlCharacter = "control_character",
            "delete it; old programs end a file with Ctrl-Z (U+001A), and an interrupted copy may end with NUL \
             (U+0000)";
        /// Separators of thousands.
        Thousands = "thousands",
            "write the number without separators of thousands; if the mark is a decimal comma, use a decimal point";
        /// Whole number with a leading zero.
        LeadingZero = "leading_zero", "omit the leading zero, because some YAML readers take such a number as octal";
        /// No-break or other space that is not ASCII.
        NoBreakSpace = "no_break_space", "replace it with a space, or delete it within a number";
        /// Space within the options of a trusted key.
        OptionBlank = "option_blank", "delete the space; options and principals are separated by commas alone";
        /// File in UTF-16.
        Utf16 = "utf16", "save the file as UTF-8; PowerShell's `>` and \"Unicode\" in Windows programs mean UTF-16";
    }
}

/// Advice on an error, with its cause if that is recognised.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Advice {
    pub(crate) cause: Option<RefusalCause>,
    pub(crate) words: String,
    /// Known name that an unknown one stands for.
    pub(crate) meant: Option<String>,
}

impl From<RefusalCause> for Advice {
    fn from(cause: RefusalCause) -> Self {
        (cause, cause.advice()).into()
    }
}

impl From<&str> for Advice {
    fn from(words: &str) -> Self {
        words.to_owned().into()
    }
}

impl From<String> for Advice {
    fn from(words: String) -> Self {
        Self { words, ..Self::default() }
    }
}

/// Advice on an error with this cause that says more than the usual one.
impl<W: Into<String>> From<(RefusalCause, W)> for Advice {
    fn from((cause, words): (RefusalCause, W)) -> Self {
        Self { cause: Some(cause), words: words.into(), meant: None }
    }
}

impl Advice {
    /// Adds that the known `name` is meant.
    pub(super) fn meaning(self, name: &str) -> Self {
        Self { meant: Some(name.to_owned()), ..self }
    }
}
