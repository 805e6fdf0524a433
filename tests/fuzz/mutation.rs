//! Changes to an input that keep some of its structure: of numbers, words, lines, lengths and single bytes.

use dtg_passport::statistics::random::Stream;
use std::ops::Range;

/// Values that readers stumble over.
const NUMBERS: [&[u8]; 28] = [
    b"0",
    b"-0",
    b"-0.0",
    b"1",
    b"-1",
    b"90",
    b"-90",
    b"180",
    b"45.0",
    b"162000",
    b"1e308",
    b"-1e308",
    b"1e309",
    b"1.0e-320",
    b"5e-324",
    b"1e-400",
    b".inf",
    b".nan",
    b"NaN",
    b"inf",
    b"4294967295",
    b"4294967296",
    b"9223372036854775808",
    b"-9223372036854775809",
    b"18446744073709551616",
    b"0x1F",
    b"0o17",
    b"1_000",
];

/// Pieces of the languages that are read here.
const PIECES: [&[u8]; 42] = [
    b"\n",
    b"\r\n",
    b"\r",
    b" ",
    b"  ",
    b"\t",
    b",",
    b";",
    b":",
    b": ",
    b"- ",
    b"[",
    b"]",
    b"{",
    b"}",
    b"[]",
    b"{}",
    b"\"",
    b"\\",
    b"\\\"",
    b"'",
    b"#",
    b"# ",
    b"!",
    b"*",
    b"?",
    b"&a ",
    b"*a",
    b"<<: *a",
    b"!!str ",
    b"---\n",
    b"...\n",
    b"? ",
    b"|\n",
    b">\n",
    b"%YAML 1.1\n",
    b"\xEF\xBB\xBF",
    b"\0",
    b"\xC2\x85",
    b"\xE2\x80\xA8",
    b"\xCC\x81",
    b"signature: |\n",
];

/// A number below `end`.
fn below(stream: &mut Stream, end: usize) -> usize {
    stream.below(end)
}

/// Changes `bytes` once to eight times, mostly few; the result has at most `longest` bytes.
pub fn mutate(bytes: &mut Vec<u8>, stream: &mut Stream, longest: usize) {
    let most = 1 + below(stream, 8);
    for _ in 0..=below(stream, most) {
        once(bytes, stream);
    }
    bytes.truncate(longest);
}

/// The same for a fuzzer's buffer, in turn with the fuzzer's own changes; gives the new length.
#[cfg(feature = "fuzzing")]
pub fn in_place(
    data: &mut [u8],
    size: usize,
    max_size: usize,
    seed: u32,
    fuzzers_own: impl FnOnce(&mut [u8], usize, usize) -> usize,
) -> usize {
    let mut stream = Stream::new(u64::from(seed));
    if below(&mut stream, 2) == 0 {
        return fuzzers_own(data, size, max_size);
    }
    let mut bytes = data[..size].to_vec();
    mutate(&mut bytes, &mut stream, max_size);
    data[..bytes.len()].copy_from_slice(&bytes);
    bytes.len()
}

fn once(bytes: &mut Vec<u8>, stream: &mut Stream) {
    let at = below(stream, bytes.len() + 1);
    let kind = below(stream, 14);
    match kind {
        0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << below(stream, 8)),
        1 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = below(stream, 256) as u8),
        2 => insert(bytes, at, PIECES[below(stream, PIECES.len())]),
        3 => insert(bytes, at, NUMBERS[below(stream, NUMBERS.len())]),
        4 => drop(bytes.drain(span(bytes, at, stream))),
        5 => {
            let copy = bytes[span(bytes, at, stream)].to_vec();
            let to = below(stream, bytes.len() + 1);
            insert(bytes, to, &copy);
        }
        // A number becomes another one, a word another word of the same text.
        6 | 7 => replace_run(
            bytes,
            at,
            |byte| byte.is_ascii_digit() || b".+-".contains(&byte),
            NUMBERS[below(stream, NUMBERS.len())],
        ),
        8 => {
            let is_word = |byte: u8| byte.is_ascii_alphanumeric() || b"_-./+".contains(&byte);
            let other = run(bytes, below(stream, bytes.len() + 1), is_word);
            let word = bytes[other].to_vec();
            replace_run(bytes, at, is_word, &word);
        }
        9..=12 => lines(bytes, kind - 9, stream),
        // A length in SSH's binary encoding: a little more or less, or far too much.
        _ => {
            if let Some(length) = bytes.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<4>()) {
                let value = u32::from_be_bytes(*length);
                let new = [value.wrapping_add(1), value.wrapping_sub(1), u32::MAX, 0, 1 << 31][below(stream, 5)];
                *length = new.to_be_bytes();
            }
        }
    }
}

fn insert(bytes: &mut Vec<u8>, at: usize, piece: &[u8]) {
    bytes.splice(at..at, piece.iter().copied());
}

/// A short range from `at` on, now and then a long one.
fn span(bytes: &[u8], at: usize, stream: &mut Stream) -> Range<usize> {
    let longest = if below(stream, 8) == 0 { bytes.len() } else { 16 };
    at..(at + 1 + below(stream, longest)).min(bytes.len()).max(at)
}

/// The first run of such bytes from `at` on.
fn run(bytes: &[u8], at: usize, belongs: impl Fn(u8) -> bool) -> Range<usize> {
    let start = (at..bytes.len()).find(|&index| belongs(bytes[index])).unwrap_or(bytes.len());
    let end = (start..bytes.len()).find(|&index| !belongs(bytes[index])).unwrap_or(bytes.len());
    start..end
}

fn replace_run(bytes: &mut Vec<u8>, at: usize, belongs: impl Fn(u8) -> bool, by: &[u8]) {
    let found = run(bytes, at, belongs);
    bytes.splice(found, by.iter().copied());
}

/// Lines exchanged, doubled, removed, or one put in another's place.
fn lines(bytes: &mut Vec<u8>, how: usize, stream: &mut Stream) {
    let mut lines: Vec<Vec<u8>> = bytes.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    if lines.is_empty() {
        return;
    }
    let (one, other) = (below(stream, lines.len()), below(stream, lines.len()));
    match how {
        0 => lines.swap(one, other),
        1 => lines.insert(other, lines[one].clone()),
        2 => drop(lines.remove(one)),
        _ => lines[other] = lines[one].clone(),
    }
    *bytes = lines.concat();
}
