//! Makes the texts of `texts/*.txt` items of the crate: a constant for each text, or a function whose parameters are its
//! placeholders. So a value that is missing or has another name does not compile, and an unused text is a warning.
//!
//! A text is a line `NAME: English`, and below it, two blanks deep, the Russian. `{name}` is a placeholder; both languages
//! have the same ones. `~` is a non-breaking space, wherever a line must not end: between a number and its unit, around signs such
//! as `=`, before a dash, between initials, after a Russian word of one letter (SI Brochure, 5.4.3; GOST 8.417, 5.3). Lines that
//! begin with `#` are comments; the first says what the table is for.
//!
//! After a line `[name]`, up to an empty line, each text is that of the variants `One | Other` of an enum, `_` for those without
//! a text of their own; `Variant = table::NAME` takes a text from elsewhere. `name!(Enum, value)` is then the text of a value,
//! and a variant without a text does not compile.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::{env, error::Error, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=texts");
    let files = fs::read_dir("texts")?.map(|file| file.map(|file| file.path()));
    let files: BTreeSet<_> = files.collect::<Result<_, _>>()?;
    let (mut modules, mut tables) = (String::new(), String::new());
    for path in files {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).ok_or("the name of a table is not UTF-8")?;
        let text = fs::read_to_string(&path)?;
        let about = text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap_or_default();
        let rust = table(&text).map_err(|why| format!("{}: {why}", path.display()))?;
        write!(modules, "#[doc = {about:?}]\npub(crate) mod {stem} {{\n{rust}}}\n")?;
        write!(tables, "({stem:?}, {stem}::ALL), ")?;
    }
    write!(
        modules,
        "/// Every table with its name.\n#[cfg(test)]\n\
         pub(crate) const TABLES: &[(&str, &[(&str, crate::wording::Text)])] = &[{tables}];\n"
    )?;
    Ok(fs::write(Path::new(&env::var("OUT_DIR")?).join("texts.rs"), modules)?)
}

/// Returns the items of a table.
fn table(text: &str) -> Result<String, String> {
    let (mut rust, mut all, mut known) = (String::new(), String::new(), BTreeSet::new());
    let mut lines = (1..).zip(text.lines().chain([""])).filter(|(_, line)| !line.starts_with('#'));
    let mut variants: Option<(&str, String)> = None;
    while let Some((number, first)) = lines.next() {
        let wrong = |what: &str| format!("line {number}: {what}: {first}");
        if first.is_empty() {
            rust.extend(variants.take().map(|(name, arms)| matched(name, &arms)));
            continue;
        }
        if let Some(name) = first.strip_prefix('[').and_then(|name| name.strip_suffix(']')) {
            variants = Some((name, String::new()));
            continue;
        }
        if let Some(((_, arms), (of, path))) = variants.as_mut().zip(first.split_once(" = ")) {
            *arms += &arm(of, &format!("crate::wording::texts::{path}"));
            continue;
        }
        let (name, en) = first.split_once(": ").ok_or_else(|| wrong("no `NAME: English`"))?;
        let ru = lines.next().and_then(|(_, line)| line.strip_prefix("  ")).ok_or_else(|| wrong("no Russian below"))?;
        let [en, ru] = [en, ru].map(|words| words.replace('~', "\u{a0}"));
        let [values, in_russian] = [&en, &ru].map(|words| placeholders(words));
        let set = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<BTreeSet<_>>();
        if set(&values) != set(&in_russian) {
            return Err(wrong("the languages have other placeholders"));
        }
        let name = variants.as_ref().map_or_else(|| name.to_owned(), |(of, _)| format!("{of}: {name}"));
        if !known.insert(name.clone()) {
            return Err(wrong("this name occurs twice"));
        }
        let text = format!("crate::wording::Text {{ en: {en:?}, ru: {ru:?} }}");
        let written = if let Some((_, arms)) = &mut variants {
            *arms += &arm(first.split(": ").next().unwrap_or_default(), &text);
            Ok(())
        } else if values.is_empty() {
            write!(rust, "#[doc = {en:?}]\npub(crate) const {name}: crate::wording::Text = {text};\n")
        } else {
            let parameters = values.iter().map(|name| format!("r#{name}: impl Into<crate::wording::Words>"));
            let filled = values.iter().map(|name| format!("({name:?}, r#{name}.into())"));
            let [parameters, filled] = [parameters.collect::<Vec<_>>(), filled.collect()].map(|each| each.join(", "));
            let name = name.to_lowercase();
            write!(
                rust,
                "#[doc = {en:?}]\npub(crate) fn r#{name}({parameters}) -> crate::wording::Words {{\n    \
                 crate::wording::Words::Text({text}, vec![{filled}])\n}}\n"
            )
        };
        written.and_then(|()| write!(all, "({name:?}, {text}), ")).map_err(|why| why.to_string())?;
    }
    Ok(format!("{rust}#[cfg(test)]\npub(crate) const ALL: &[(&str, crate::wording::Text)] = &[{all}];\n"))
}

/// Returns the arm of a `match` for variants, with their text.
fn arm(variants: &str, text: &str) -> String {
    let each = variants.split(" | ").map(|name| if name == "_" { name.to_owned() } else { format!("$of::{name}") });
    format!("{} => {text}, ", each.collect::<Vec<_>>().join(" | "))
}

/// Returns the macro of the texts of an enum.
fn matched(name: &str, arms: &str) -> String {
    format!(
        "/// The text of a value.\nmacro_rules! {name} {{ ($of:ident, $value:expr) => {{ match $value {{ {arms}}} }} }}\n\
         pub(crate) use {name};\n"
    )
}

/// Returns the names of the placeholders in their order, each once.
fn placeholders(words: &str) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for name in words.split('{').skip(1).filter_map(|rest| rest.split_once('}')).map(|(name, _)| name) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}
