//! Every text in all languages, from the tables in `texts/`; `build.rs` makes a module of each table, and an item of each
//! text.

// Features use parts of a table; in the whole program an unused text is a warning.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports, unused_macros))]
// A text has as many values as its sentence needs.
#![allow(clippy::too_many_arguments)]

include!(concat!(env!("OUT_DIR"), "/texts.rs"));
