//! What the canonical writer writes, every YAML reader reads back the same: numbers bit for bit, texts byte for byte.
//!
//! The readers are the real ones, each called by a small program in `tests/readers/` which tells what it read as one
//! JSON array a line: `["number", "3ff0000000000000"]`, `["text", "61"]`, `["list"]` … `["end"]`.

use crate::inside::programs;
use dtg_passport::text::Node;
use dtg_passport::text::canonical;
use dtg_passport::text::field::{Scalar, Sink};
use dtg_passport::text::rule::{self, allowed_in_string};
use dtg_passport::text::yaml;
use dtg_passport::text::{Field, Path as At, Problems};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::iter::once;
use std::path::Path;
use std::process::Command;

/// How many values of binary64 go through every reader.
const VALUES: usize = 5_000;

/// How many nasty strings there must be at least.
const NASTY_STRINGS: usize = 200;

/// The seed of the random values: any, but always the same one.
const SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// What runs it, its program in `tests/readers/`, and what that is told beside the file.
type Program = (fn() -> Command, &'static str, &'static [&'static str]);

/// One reader of YAML as a laboratory uses it.
struct Reader {
    name: &'static str,
    program: Program,
    /// Tells whole numbers from others; JavaScript has one type of number.
    has_integers: bool,
}

const READERS: [Reader; 9] = [
    reader("PyYAML, pure", (programs::python, "pyyaml.py", &["pure"]), true),
    reader("PyYAML, C", (programs::python, "pyyaml.py", &["c"]), true),
    reader("ruamel.yaml, safe", (programs::python, "ruamel_yaml.py", &["safe"]), true),
    reader("ruamel.yaml, rt", (programs::python, "ruamel_yaml.py", &["rt"]), true),
    reader("js-yaml", (programs::node, "js_yaml.cjs", &["js-yaml"]), false),
    reader("js-yaml 4", (programs::node, "js_yaml.cjs", &["js-yaml-4"]), false),
    reader("yaml (npm), 1.1", (programs::node, "yaml_npm.cjs", &["1.1"]), false),
    reader("yaml (npm), 1.2", (programs::node, "yaml_npm.cjs", &["1.2"]), false),
    reader("Psych", (programs::ruby, "psych.rb", &[]), true),
];

const fn reader(name: &'static str, program: Program, has_integers: bool) -> Reader {
    Reader { name, program, has_integers }
}

impl Reader {
    /// What its program tells of the file.
    fn read(&self, file: &Path) -> Vec<Value> {
        let (language, program, arguments) = self.program;
        let mut command = language();
        command.arg(programs::project("tests/readers").join(program)).args(arguments).arg(file);
        let line = |line: &str| serde_json::from_str(line).unwrap_or_else(|error| panic!("{line}: {error}"));
        programs::output(command).lines().map(line).collect()
    }
}

/// What a program tells of a document, line by line; a binary64 by its bits, so that nothing but the same value is equal.
fn told(document: &Node, has_integers: bool) -> Vec<Value> {
    let number = |value: f64| vec![json!(["number", format!("{:016x}", value.to_bits())])];
    let hex = |text: &str| text.bytes().map(|byte| format!("{byte:02x}")).collect::<String>();
    let listed = |kind: &str, items: &mut dyn Iterator<Item = Value>| {
        once(json!([kind])).chain(items).chain(once(json!(["end"]))).collect()
    };
    match document {
        Node::Null => vec![json!(["null"])],
        Node::Bool(value) => vec![json!(["bool", value])],
        Node::Integer(value) if has_integers => vec![json!(["integer", value.to_string()])],
        Node::Integer(value) => number(*value as f64),
        Node::Number(value) => number(*value),
        Node::Text(text) => vec![json!(["text", hex(text)])],
        Node::List(items) => listed("list", &mut items.iter().flat_map(|item| told(item, has_integers))),
        Node::Map(entries) => {
            let entry = |(key, value): &(String, Node)| once(json!(["key", hex(key)])).chain(told(value, has_integers));
            listed("map", &mut entries.iter().flat_map(entry))
        }
    }
}

/// A line that was told, with the letters of a text or a key.
fn readable(line: &Value) -> String {
    let byte = |digits: &[u8]| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok();
    match (line[0].as_str(), line[1].as_str()) {
        (Some(kind @ ("text" | "key")), Some(digits)) => {
            let bytes: Option<Vec<u8>> = digits.as_bytes().chunks(2).map(byte).collect();
            format!("{kind} {:?}", String::from_utf8_lossy(&bytes.unwrap_or_default()))
        }
        _ => line.to_string(),
    }
}

/// Writes the text where the readers' programs find it.
fn file(name: &str, text: &str) -> tempfile::TempPath {
    let folder = std::env::temp_dir();
    let file = tempfile::Builder::new().prefix(name).suffix(".yaml").tempfile_in(folder).expect("a temporary file");
    std::fs::write(file.path(), text).expect("the file can be written");
    file.into_temp_path()
}

/// A tree is written like the records of documents, so that the readers see every value that a document may have.
impl Field for Node {
    fn read(node: &Node, _: &At, _: &mut Problems) -> Option<Self> {
        Some(node.clone())
    }

    fn is_mapping(&self) -> bool {
        matches!(self, Node::Map(_))
    }

    fn emit<S: Sink>(&self, sink: &mut S) {
        match self {
            Node::Null => panic!("no document has an empty value"),
            Node::Bool(value) => sink.scalar(Scalar::Bool(*value)),
            Node::Integer(value) => sink.scalar(Scalar::Integer(*value)),
            Node::Number(value) => sink.scalar(Scalar::Number(*value)),
            Node::Text(value) => sink.scalar(Scalar::Text(value)),
            Node::List(items) => sink.list(items),
            Node::Map(entries) => sink.mapping(entries.is_empty(), |sink| {
                for (key, value) in entries {
                    if sink.key(key) {
                        value.emit(sink);
                    }
                }
            }),
        }
    }
}

/// Writes the document canonically and requires that every reader, the library's own too, gives it back.
fn goes_through_every_reader(name: &str, document: &Node) {
    let text = canonical::write(document, &|path| match path {
        "first" => vec!["A comment, with \"quotes\", a colon: and # signs".to_owned()],
        _ => Vec::new(),
    });
    assert_eq!(rule::check(name, text.as_bytes(), usize::MAX).map_err(|error| error.to_string()), Ok(text.as_str()));

    let (own, _) = yaml::tree(name, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    assert_same("the library", &told(document, true), &told(&own, true));
    assert_eq!(rule::differs(&text, &canonical::write_bare(&own)), None);

    let file = file(name, &text);
    // Each reader is a process of its own, so they share the cores; a panic in any of them is the test's.
    std::thread::scope(|scope| {
        for reader in &READERS {
            let file = &file;
            scope.spawn(move || assert_same(reader.name, &told(document, reader.has_integers), &reader.read(file)));
        }
    });
}

fn assert_same(reader: &str, expected: &[Value], found: &[Value]) {
    let same = expected.iter().zip(found).take_while(|(expected, found)| expected == found).count();
    if same < expected.len().max(found.len()) {
        let after = expected[..same].iter().rev().find(|line| line[0] == "key").map(readable);
        let [expected, found] = [expected, found].map(|lines| lines.get(same).map(readable));
        panic!("{reader}: after {after:?} expected {expected:?}, found {found:?}");
    }
}

fn map<K: Into<String>>(entries: impl IntoIterator<Item = (K, Node)>) -> Node {
    Node::Map(entries.into_iter().map(|(key, value)| (key.into(), value)).collect())
}

fn text(text: &str) -> Node {
    Node::Text(text.to_owned())
}

/// Sebastiano Vigna's SplitMix64, which needs no more than these lines.
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let first = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let second = (first ^ (first >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    second ^ (second >> 31)
}

/// Exactly [`VALUES`] different values of every magnitude: first those where a writer or reader of decimals errs,
/// then random bits.
fn values() -> Vec<f64> {
    let mut state = SEED;
    let mut values = vec![0.0, f64::MAX, f64::MIN_POSITIVE, f64::MIN_POSITIVE.next_down(), f64::EPSILON];
    let mut and_neighbours = |value: f64| values.extend([value.next_down(), value, value.next_up()]);
    for exponent in -323..=308 {
        and_neighbours(format!("1e{exponent}").parse().expect("a power of ten"));
    }
    // Beyond 2^53 not every whole number is a binary64; from 1e16 on the writer changes its form.
    for exponent in [24, 31, 32, 52, 53, 54, 63, 64] {
        and_neighbours(f64::from(exponent).exp2());
    }
    for whole in [1.0, 2.0, 100.0, 255.0, 65_535.0, 999_999.0, 123_456_789.0, 9_007_199_254_740_991.0] {
        and_neighbours(whole);
    }
    // Long known to be read or written wrongly by one program or another.
    for hard in [
        "2.2250738585072011e-308",
        "6.631236846766476e-316",
        "8.41e+21",
        "9.5367431640625e-07",
        "2.98023223876953125e-8",
    ] {
        and_neighbours(hard.parse().expect("a number"));
    }
    // A power of two is nearer to its lower neighbour than to its upper one: of every binade both ends in turn.
    for exponent in -1074..=1023 {
        let power = if exponent < -1022 { f64::from_bits(1 << (exponent + 1074)) } else { 2.0_f64.powi(exponent) };
        values.push([(power * 2.0).next_down(), power, power.next_up()][exponent.unsigned_abs() as usize % 3]);
    }
    // What a passport is made of: angles, rates and currents with a few digits.
    for decimals in 0..9 {
        let scale = 10_f64.powi(decimals);
        values.extend((0..20).map(|_| (random(&mut state) % 360_000_000) as f64 / scale));
    }

    let mut seen = HashSet::new();
    values.retain(|value| value.is_finite() && seen.insert(value.to_bits()));
    assert!(values.len() < VALUES, "{} values leave no room for random ones", values.len());
    while values.len() < VALUES {
        let value = f64::from_bits(random(&mut state) >> 1);
        if value.is_finite() && seen.insert(value.to_bits()) {
            values.push(value);
        }
    }
    // The writer knows one zero only; of every other value the sign is drawn.
    values.into_iter().map(|value| if value != 0.0 && random(&mut state) & 1 == 1 { -value } else { value }).collect()
}

#[test]
fn numbers_come_back_bit_for_bit() {
    let values = values();
    let magnitudes: HashSet<u64> = values.iter().map(|value| (value.to_bits() >> 52) & 0x7FF).collect();
    assert_eq!(magnitudes.len(), 0x7FF, "every binary exponent of a finite value occurs");
    assert!([0.0001, 1e16, 5e-324].iter().all(|edge| values.iter().any(|value| value.abs() == *edge)));

    let row = |values: &[f64]| Node::List(values.iter().map(|value| Node::Number(*value)).collect());
    let matrix = |values: &[f64]| Node::List(values.chunks(2).map(row).collect());
    // As items of a mapping on one line, as a position is written.
    let position = |(i, pair)| map([("i", Node::Integer(i)), ("j", Node::Integer(-i)), ("omega", row(pair))]);
    let document = map([
        ("first", Node::Integer(1)),
        ("matrices", map(values.chunks(8).enumerate().map(|(at, chunk)| (format!("m{at}"), matrix(chunk))))),
        ("values", map(values.iter().enumerate().map(|(at, value)| (format!("v{at}"), Node::Number(*value))))),
        ("positions", Node::List((1..=8).zip(values.chunks(2)).map(position).collect())),
    ]);
    goes_through_every_reader("numbers", &document);
}

/// Strings that a reader, a terminal or a careless writer could take for something else.
#[rustfmt::skip] // one string a line would be pages
const NASTY: &[&str] = &[
    // Nothing, blanks at either end.
    "", " ", "  ", " x", "x ", " x ", "   leading", "trailing   ", "two  blanks", "a b",
    // Booleans and nothing in YAML 1.1, 1.2 or Python.
    "y", "Y", "n", "N", "yes", "Yes", "YES", "no", "No", "NO", "on", "On", "ON", "off", "Off", "OFF", "true", "True",
    "TRUE", "false", "False", "FALSE", "null", "Null", "NULL", "~", "nil", "None", "undefined", "t", "f", "NaN",
    "nan",
    // Numbers in one version or another.
    "0", "-0", "+0", "1", "-1", "+1", "00", "007", "010", "08", "0o17", "0x1F", "0X1f", "0b101", "-0x1F", "1_000",
    "1,000", "1,5", "_1", "1_", "0.", ".5", "-.5", "+.5", ".", "..", "...", "-", "--", "---", "--- x", "... x", "1.",
    "1.0", "1e6", "1e+6", "1E6", "1.0e6", "1.0e-06", "1.5e+300", "1e400", "1e", "e1", ".e1", "1.2.3", "1__0.0",
    ".inf", "-.inf", "+.inf", ".Inf", ".INF", "inf", "Infinity", "-Infinity", ".nan", ".NaN", "685_230.15",
    "9007199254740993", "18446744073709551616", "123456789012345678901234567890", "0.1", "1/2", "100%", "1 000", "$1",
    // Times, dates, angles in base 60.
    "12:30:45", "190:20:30", "190:20:30.15", "1:1", "-1:30", "12:30", "2026-11-02", "2026-1-2",
    "2026-11-02T09:30:00Z", "2026-11-02 09:30:00", "2026-11-02 09:30:00 +3", "2001-12-14t21:59:43.10-05:00",
    "20261102", "09:30", "55:45:56",
    // Marks of the syntax, alone and in front.
    "<<", "=", "!", "!!", "!!str x", "!<tag>", "&", "&a", "&anchor x", "*", "*a", "*.yaml", "%", "%YAML 1.1",
    "%TAG ! x", "@", "@a", "`", "`a`", "|", "|-", ">", ">+", "> x", "?", "? a", "?a", ":", ": ", ": a", ":a",
    ":symbol", ":\"x\"", "a:", "a: b", "a : b", "a:b", "::", ",", ", a", "a, b", "[", "]", "[]", "[1, 2]", "][", "{",
    "}", "{}", "{a: 1}", "}{", "- ", "- a", "-a", "- - a", "#", "# no comment", "a # no comment", "a #", "a#b",
    " # x", "http://x/#y",
    // Quotes and backslashes, which are escaped or are not.
    "\"", "\"\"", "\"x\"", "x\"", "\"x", "a\"b\"c", "'", "''", "'x'", "it's", "\\", "\\\\", "\\\\\\", "\\\"", "\"\\",
    "\\n", "\\t", "\\0", "\\x41", "\\u0041", "\\U0001F600", "\\N", "\\_", "\\L", "\\P", "\\e", "\\ ", "\\/", "a\\",
    "C:\\stand\\new", "\\\\server\\share", "x\\\"y", "\"; rm -rf /; \"", "${HOME}", "$(date)", "{{ x }}", "<%= 1 %>",
    "<b>&amp;</b>", "=1+1", "+1+1", "@SUM(A1)", "a\u{7E}b",
    // The words of a passport where they do not belong.
    "signature: |", "\"signature\": |", "-----BEGIN SSH SIGNATURE-----", "format: \"dtg-passport/1\"", "__proto__",
    "constructor", "toString", "hasOwnProperty", "!ruby/object:Object", "!!python/object/apply:os.system",
    // Other writings: those of the factory, of the laboratories, of letters that look like others.
    "Лаборатория гироскопии", "МГТУ им. Н. Э. Баумана", "ёЁйЙ", "нет", "да", "СПС-2А", "а", "ΔΦλ ωΓ ωΒ", "ξηζ", "Ω",
    "µ", "北京航空航天大学", "惯性技术实验室", "测试台", "一", "龥", "計測標準", "ひらがな", "カタカナー", "々", "・", "한국표준과학연구원", "가", "힣", "№ 17",
    "№17", "20 ℃", "20 °C", "55° 45′ 56″", "±0.5″", "→", "← → ↔ ⇒", "ω ≈ 15.04 °/h", "∑ √ ∞ ≤ ≥ ≠ ∂ ∈", "−1",
    "‐ ‑ ‒ – — ―", "“quoted”", "‘x’", "«ёлочки»", "„x“", "…", "• ‣ ․ ‥ ‧", "‰ ‱ ′ ″ ‴", "€ 5", "（全角）", "：", "１２３",
    "！", "～", "「」", "『』", "、。", "【x】", "é à ü ß ñ ø å ž ł", "¡¿§¶·¼½¾×÷", "Ā ſ ƀ ɐ ʯ", "´ ` ¨",
];

#[test]
fn nasty_strings_come_back_byte_for_byte() {
    let mut strings: Vec<String> = NASTY.iter().map(|text| (*text).to_owned()).collect();
    for string in &strings {
        assert!(string.chars().all(allowed_in_string), "{string} may not stand in a document");
    }
    assert!(strings.len() >= NASTY_STRINGS, "{} strings", strings.len());
    // The first and the last character of every range of the repertoire, alone and at both ends.
    for edge in repertoire().into_iter().filter(|c| !(beside(*c, 1) && beside(*c, -1))) {
        strings.extend([edge.to_string(), format!("{edge}x{edge}"), format!(" {edge}: {edge} # {edge}")]);
    }
    // Longer than the 1,024 characters in which some readers look for the colon of a key.
    strings.push("long ".repeat(1_000));
    strings.push("長".repeat(2_000));

    let texts = || strings.iter().map(|string| text(string));
    let keyed = || (1..).zip(texts()).map(|(i, value)| (format!("s{i}"), value));
    let document = map([
        ("first", text("1")),
        ("values", map(keyed())),
        ("items", Node::List(keyed().map(|(_, value)| map([("i", Node::Integer(1)), ("s", value)])).collect())),
        ("list", Node::List(texts().collect())),
    ]);
    goes_through_every_reader("strings", &document);
}

/// Every character that a string may hold.
fn repertoire() -> Vec<char> {
    ('\0'..=char::MAX).filter(|c| allowed_in_string(*c)).collect()
}

/// Whether the character `step` further on is allowed too.
fn beside(c: char, step: i32) -> bool {
    u32::from(c).checked_add_signed(step).and_then(char::from_u32).is_some_and(allowed_in_string)
}

#[test]
fn every_allowed_character_comes_back() {
    let characters = repertoire();
    assert!(characters.len() > 30_000);
    let chunks = characters.chunks(64).map(|chunk| text(&chunk.iter().collect::<String>()));
    let document =
        map([("first", text("1")), ("chunks", map((0..).zip(chunks).map(|(at, chunk)| (format!("c{at}"), chunk))))]);
    goes_through_every_reader("characters", &document);
}

/// Every key of a passport and of a register.
#[rustfmt::skip] // one string a line would be pages
const KEYS: &[&str] = &[
    "format", "passport", "id", "revision", "issued_at", "issuer", "valid_until", "issued_with", "reissued_from",
    "sha256", "reason", "changed", "supersedes", "stand", "manufacturer", "model", "serial", "configuration", "name",
    "customer", "certificate", "number", "issued", "performed", "received", "valid_until_basis", "laboratory",
    "address", "authorized_by", "accreditation", "method", "traceability", "references", "cmc_arcsec", "temperature_c", "temperature_range_c",
    "repeatability_arcsec", "repeatability_degrees_of_freedom", "common_platform_arcsec", "common_base_arcsec",
    "type_b", "acts_on", "u_arcsec", "evidence", "readings_sha256", "runs", "excluded", "run", "why", "datum", "level", "azimuth", "gyro_seat", "positions", "i", "j", "theta_deg", "phi_deg", "alpha_arcsec",
    "beta_arcsec", "gamma_arcsec", "u_alpha_arcsec", "u_beta_arcsec", "u_gamma_arcsec", "degrees_of_freedom", "site",
    "latitude_deg", "astronomic_latitude_deg", "longitude_deg", "height_m", "deflection_arcsec", "xi", "eta", "u",
    "gravity_m_per_s2", "gravity_u_m_per_s2", "azimuth_mark", "pillar_latitude_deg", "pillar_longitude_deg",
    "position_u_m", "valid_within_deg_per_h", "uncertainty", "latitude_arcsec", "azimuth_arcsec", "level_arcsec",
    "source", "earth", "rate_deg_per_h", "horizontal_deg_per_h", "vertical_deg_per_h", "valid_radius_m",
    "azimuth_deg", "azimuth_u_arcsec", "matrices", "delta", "b_deg_per_h", "c_deg_per_h_per_g", "n1", "n2",
    "n2_inverse", "omega1_deg_per_h", "omega2_deg_per_h", "vectors", "specific_force_g", "specific_force_z_g",
    "omega_deg_per_h", "self_check", "currents", "jx_ma", "jy_ma", "k_deg_per_h_per_ma", "omega0_deg_per_h",
    "omega_g_deg_per_h_per_g", "omega_k_deg_per_h_per_g", "accuracy", "gyro", "type", "nominal", "tolerance",
    "k_main_percent", "k_cross_percent", "k_cross_deg_per_h_per_ma", "meter", "range_ma", "reading_percent",
    "gain_percent", "offset_ma",
    "floor_ma", "seating_arcsec", "about_x", "about_y", "about_z", "base", "standard_uncertainty", "signature",
    "register", "sequence", "previous_sha256", "fresh_until", "passports", "state", "since", "by",
];

/// Whether a document may have `key`: no word that YAML 1.1 reads as a boolean or as nothing, and no `e` with digits
/// alone, which yaml (npm) takes for an exponent in its 1.1 mode (as a key it comes back as NaN).
fn may_be_a_key(key: &str) -> bool {
    let exponent = key.strip_prefix('e').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    !exponent && !["y", "n", "yes", "no", "on", "off", "true", "false", "null"].contains(&key)
}

#[test]
fn keys_come_back_as_texts() {
    // Beside the passport's: all of one or two characters that the rule of keys allows.
    let letters = || ('a'..='z').map(String::from);
    let ends = ('a'..='z').chain('0'..='9').chain(['_']);
    let short = letters().chain(letters().flat_map(|first| ends.clone().map(move |last| format!("{first}{last}"))));
    assert!(KEYS.iter().all(|key| may_be_a_key(key)));
    let mut once = HashSet::new();
    let keys: Vec<String> = (KEYS.iter().map(|key| (*key).to_owned()))
        .chain(short)
        .filter(|key| may_be_a_key(key) && once.insert(key.clone()))
        .collect();

    let all = |value: &Node| map(keys.iter().map(|key| (key.as_str(), value.clone())));
    let document = map([
        ("first", Node::Integer(1)),
        ("block", all(&Node::Bool(true))),
        ("items", Node::List(vec![all(&Node::Bool(false)), all(&text("")), all(&Node::Integer(-7))])),
        ("empty_list", Node::List(Vec::new())),
        ("empty_map", Node::Map(Vec::new())),
    ]);
    goes_through_every_reader("keys", &document);
}

/// The traps are real: without the rule these readers give something else, and this test would notice.
#[test]
fn what_the_rule_forbids_is_read_differently() {
    let differently = |reader: &str, key: &str, yaml: &str, value: Node| {
        let reader = READERS.iter().find(|known| known.name == reader).expect("a known reader");
        let found = reader.read(&file("trap", &format!("{key}: {yaml}\n")));
        assert_ne!(found, told(&map([(key, value)]), reader.has_integers), "{}: {key}: {yaml}", reader.name);
    };
    for reader in ["PyYAML, pure", "PyYAML, C", "Psych"] {
        differently(reader, "a", "1e-6", Node::Number(1e-6));
        differently(reader, "no", "1.0", Node::Number(1.0));
        differently(reader, "a", "12:30:45", text("12:30:45"));
    }
    for key in ["n", "e1"] {
        differently("yaml (npm), 1.1", key, "1.0", Node::Number(1.0));
    }
    differently("PyYAML, C", "a", "\"x\u{85}\"", text("x\u{85}"));
    differently("Psych", "a", "1_000", text("1_000"));
}
