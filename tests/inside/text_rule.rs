//! The text rule of signed documents from outside: its repertoire as laid down, and every forbidden construct refused
//! at its place, before anything is parsed.

use dtg_passport::text::rule;

/// What a double-quoted string may hold beside ASCII, first and last of every range, as the rule is laid down.
const REPERTOIRE: [(u32, u32); 22] = [
    (0x00A1, 0x00AC),
    (0x00AE, 0x02AF),
    (0x0370, 0x0373),
    (0x0375, 0x0377),
    (0x037A, 0x037D),
    (0x037F, 0x037F),
    (0x0384, 0x0386),
    (0x0388, 0x0482),
    (0x048A, 0x052F),
    (0x2010, 0x2027),
    (0x2030, 0x205E),
    (0x20AC, 0x20AC),
    (0x2103, 0x2103),
    (0x2116, 0x2116),
    (0x2190, 0x22FF),
    (0x3001, 0x3003),
    (0x3005, 0x3011),
    (0x3041, 0x3096),
    (0x309D, 0x30FF),
    (0x4E00, 0x9FFF),
    (0xAC00, 0xD7A3),
    (0xFF01, 0xFF5E),
];

#[test]
fn a_string_may_hold_the_repertoire_and_nothing_else() {
    for c in '\0'..=char::MAX {
        let code = u32::from(c);
        let laid_down = (0x20..=0x7E).contains(&code) || REPERTOIRE.iter().any(|(a, b)| (*a..=*b).contains(&code));
        assert_eq!(rule::allowed_in_string(c), laid_down, "U+{code:04X}");
    }
}

/// Where `check` refuses `bytes`, as `line:column`; `-` when it refuses them as a whole.
fn refused_at(bytes: &[u8]) -> Option<String> {
    let refused = rule::check("t.yaml", bytes, 1 << 20).err()?;
    assert_eq!(refused.problems().len(), 1, "{refused}");
    Some(refused.problems()[0].location.map_or("-".to_owned(), |at| format!("{}:{}", at.line, at.column)))
}

/// A forbidden construct, a text with it, the place where it must be refused.
const FORBIDDEN: &[(&str, &str, &str)] = &[
    ("an anchor", "a: &x 1.0\n", "1:4"),
    ("an anchor of a mapping", "a: 1.0\nb: &x\n  c: 1.0\n", "2:4"),
    ("an alias", "a: 1.0\nb: *x\n", "2:4"),
    ("a short tag", "a: !!str 1.0\n", "1:4"),
    ("a local tag", "a: 1.0\nb: {c: !x 1.0}\n", "2:8"),
    ("a tag in full", "a: !<tag:yaml.org,2002:str> 1.0\n", "1:4"),
    ("a merge key", "a:\n  <<: {b: 1.0}\n", "2:3"),
    ("a merge key on one line", "a: {<<: {b: 1.0}}\n", "1:5"),
    ("a default key", "=: 1.0\n", "1:1"),
    ("a document start", "---\na: 1.0\n", "1:1"),
    ("a second document", "a: 1.0\n---\nb: 1.0\n", "2:1"),
    ("a document start with content", "a: 1.0\n--- {b: 1.0}\n", "2:1"),
    ("a document end", "a: 1.0\n...\n", "2:1"),
    ("a document end and a blank", "a: 1.0\n... \n", "2:1"),
    ("a document end and a comment", "a: 1.0\n... # x\n", "2:1"),
    ("a YAML directive", "%YAML 1.1\n", "1:1"),
    ("a TAG directive", "%TAG ! tag:x,2026:\n", "1:1"),
    ("an explicit key", "? a\n: 1.0\n", "1:1"),
    ("an explicit key on one line", "a: {? b: 1.0}\n", "1:5"),
    ("the quoted signature key as an explicit one", "a: 1.0\n? \"signature\"\n: 1.0\n", "2:1"),
    ("a tab after a colon", "a:\t1.0\n", "1:3"),
    ("a tab as indent", "a:\n\tb: 1.0\n", "2:1"),
    ("a tab in a string", "a: \"x\ty\"\n", "1:6"),
    ("a tab in a comment", "a: 1.0\n# x\ty\n", "2:4"),
    ("a tab at the end of a line", "a: 1.0\t\n", "1:7"),
    ("a tab before a comment", "\t# x\na: 1.0\n", "1:1"),
    ("single quotes", "a: 'x'\n", "1:4"),
    ("a single-quoted key", "'a': 1.0\n", "1:1"),
    ("a literal block", "a: |\n  x\n", "1:4"),
    ("a literal block without its line feed", "a: |-\n  x\n", "1:4"),
    ("a literal block with an indent", "a: 1.0\nb: |2\n  x\n", "2:4"),
    ("a folded block", "a: >\n  x\n", "1:4"),
    ("a folded block with all line feeds", "a: >+\n  x\n", "1:4"),
    ("a comment after a number", "a: 1.0 # x\n", "1:8"),
    ("a comment after a string", "a: \"x\" # x\n", "1:8"),
    ("a comment after a matrix", "a: [[1.0, 2.0]] # x\n", "1:17"),
    ("a comment after a key", "a: # x\n  b: 1.0\n", "1:4"),
    ("a comment that is not ASCII", "# \u{2116}\na: 1.0\n", "1:3"),
    ("NEL in a string", "a: \"x\u{85}y\"\n", "1:6"),
    ("NEL in a comment", "# x\u{85}signature: 1.0\n", "1:4"),
    ("NEL at the end of a line", "a: 1.0\u{85}\n", "1:7"),
    ("a line separator in a string", "a: \"x\u{2028}y\"\n", "1:6"),
    ("a line separator in a comment", "# x\u{2028}a: 1.0\n", "1:4"),
    ("a paragraph separator in a string", "a: 1.0\nb: \"\u{2029}\"\n", "2:5"),
    ("a byte order mark in front", "\u{FEFF}a: 1.0\n", "1:1"),
    ("a byte order mark in a string", "a: \"\u{FEFF}\"\n", "1:5"),
    ("a byte order mark before a later line", "a: 1.0\n\u{FEFF}b: 1.0\n", "2:1"),
    ("CR LF", "a: 1.0\r\nb: 1.0\r\n", "1:7"),
    ("CR LF further down", "a: 1.0\nb: 1.0\r\n", "2:7"),
    ("CR alone", "a: 1.0\rb: 1.0\n", "1:7"),
    ("CR in a string", "a: \"x\ry\"\n", "1:6"),
    ("CR in a comment", "# x\rsignature: 1.0\n", "1:4"),
    ("a quote that is not closed", "a: \"x\n", "1:6"),
    ("a quote that is not opened", "a: x\"\n", "1:6"),
    ("a third quote", "a: \"x\" \"\n", "1:9"),
    ("a string of two lines", "a: \"x\n  y\"\n", "1:6"),
    ("a string continued by a backslash", "a: \"x\\\n  y\"\n", "1:7"),
    ("a closing quote that is escaped", "a: \"x\\\"\n", "1:8"),
    ("the escape \\n", "a: \"\\n\"\n", "1:6"),
    ("the escape \\t", "a: \"\\t\"\n", "1:6"),
    ("the escape \\0", "a: \"x\\0\"\n", "1:7"),
    ("the escape \\/", "a: \"x\\/\"\n", "1:7"),
    ("the escape of a blank", "a: \"x\\ \"\n", "1:7"),
    ("the escape \\x41", "a: \"\\x41\"\n", "1:6"),
    ("the escape \\u0041", "a: \"\\u0041\"\n", "1:6"),
    ("the escape \\U00000041", "a: \"\\U00000041\"\n", "1:6"),
    ("the escape \\N", "a: \"\\N\"\n", "1:6"),
    ("a backslash outside a string", "a: \\\"x\\\"\n", "1:4"),
    ("a capital letter outside a string", "a: True\n", "1:4"),
    ("a capital exponent", "a: 1.0E+16\n", "1:7"),
    ("a key in capitals", "A: 1.0\n", "1:1"),
    ("nothing, as ~", "a: ~\n", "1:4"),
    ("an at sign", "a: @x\n", "1:4"),
    ("a backquote", "a: `x`\n", "1:4"),
    ("a letter of another writing as key", "\u{430}: 1.0\n", "1:1"),
    ("a fullwidth digit as number", "a: \u{FF11}.0\n", "1:4"),
    ("no line feed at the end", "a: 1.0", "1:7"),
    ("no line feed after a comment", "a: 1.0\n# x", "2:4"),
    ("nothing at all", "", "-"),
];

#[test]
fn every_forbidden_construct_is_refused_at_its_place() {
    for (what, text, place) in FORBIDDEN {
        assert_eq!(refused_at(text.as_bytes()).as_deref(), Some(*place), "{what}: {text:?}");
    }
}

/// Characters that are not drawn, change the order or the look of others, end lines or are no characters at all.
#[rustfmt::skip] // a kind a line
const FORBIDDEN_CHARACTERS: &[(&str, &[char])] = &[
    ("controls", &['\0', '\u{1}', '\u{7}', '\u{8}', '\u{B}', '\u{C}', '\u{1B}', '\u{1F}', '\u{7F}', '\u{80}', '\u{9B}', '\u{9F}']),
    ("line ends", &['\u{85}', '\u{2028}', '\u{2029}']),
    ("blanks beside U+0020", &['\u{A0}', '\u{1680}', '\u{2000}', '\u{2009}', '\u{200A}', '\u{202F}', '\u{205F}', '\u{3000}']),
    ("bidirectional", &['\u{61C}', '\u{200E}', '\u{200F}', '\u{202A}', '\u{202B}', '\u{202C}', '\u{202D}', '\u{202E}']),
    ("isolates", &['\u{2066}', '\u{2067}', '\u{2068}', '\u{2069}', '\u{206A}', '\u{206F}']),
    ("letters from right to left", &['\u{5D0}', '\u{627}', '\u{FB1D}', '\u{FDFA}', '\u{10800}']),
    ("zero width", &['\u{AD}', '\u{200B}', '\u{200C}', '\u{200D}', '\u{2060}', '\u{2064}', '\u{180E}', '\u{FEFF}']),
    ("combining", &['\u{300}', '\u{301}', '\u{308}', '\u{34F}', '\u{36F}', '\u{483}', '\u{489}', '\u{20D7}', '\u{3099}', '\u{309A}']),
    ("variation selectors", &['\u{FE00}', '\u{FE0F}', '\u{E0100}']),
    ("tone marks", &['\u{302A}', '\u{302F}']),
    ("fillers", &['\u{115F}', '\u{1160}', '\u{3164}', '\u{FFA0}']),
    ("syllables in parts", &['\u{1100}', '\u{1161}', '\u{11A8}']),
    ("look-alikes of the Kelvin, Angstrom and Ohm kind", &['\u{212A}', '\u{212B}', '\u{2126}']),
    ("compatibility ideographs", &['\u{F900}', '\u{2F00}', '\u{2F800}']),
    ("private, no characters, replacement", &['\u{E000}', '\u{FDD0}', '\u{FFFD}', '\u{FFFE}', '\u{FFFF}', '\u{10FFFF}']),
    ("beyond the basic plane", &['\u{10000}', '\u{1D400}', '\u{1F600}', '\u{20000}', '\u{E0001}', '\u{E0061}']),
];

#[test]
fn no_other_character_passes_anywhere() {
    for (kind, characters) in FORBIDDEN_CHARACTERS {
        for c in *characters {
            let code = u32::from(*c);
            for (text, place) in [
                (format!("a: 1.0\nb: \"\u{410}{c}x\"\n"), "2:6"),
                (format!("# x{c}\na: 1.0\n"), "1:4"),
                (format!("a: 1.0\nb{c}: 1.0\n"), "2:2"),
            ] {
                assert_eq!(refused_at(text.as_bytes()).as_deref(), Some(place), "{kind}, U+{code:04X}: {text:?}");
            }
        }
    }
}
