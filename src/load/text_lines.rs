//! Splits text into lines and words, for OBJ, MTL, OFF, and STL and PLY in text.

use memchr::memchr;

use super::read_error::{FilePosition, ReadError};

/// The greatest length of a line, in bytes: enough for a polygon of half a million corners.
const MAX_LINE: usize = 1 << 22;

/// The lines of a text, one after another.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    /// The text that hasn't been read.
    pub rest: &'a [u8],
    /// The byte that ends a line.
    pub end: u8,
    /// How many lines have been read, or come before the text.
    pub count: usize,
    /// Whether the line that was read last has no end, because the text ends within it or just after it.
    pub is_open: bool,
}

/// A line without its end.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    pub text: &'a [u8],
    /// The line's number, from 1.
    pub number: usize,
}

impl<'a> Lines<'a> {
    /// Splits lines as Unix, Windows or, in a text without `\n`, old Macs end them.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let end = if memchr(b'\n', bytes).is_some() { b'\n' } else { b'\r' };
        Self::ending(bytes, end)
    }

    /// Splits a text into lines that end with this byte. A byte order mark isn't part of the first line.
    pub(super) fn ending(bytes: &'a [u8], end: u8) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), end, count: 0, is_open: false }
    }

    /// Returns the next line, if there is one.
    ///
    /// # Errors
    /// [`ReadError::Broken`] for a line that is longer than 4 MiB.
    pub(super) fn next(&mut self) -> Result<Option<Line<'a>>, ReadError> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        self.count += 1;
        let end = memchr(self.end, self.rest);
        self.is_open = end.is_none();
        let length = end.unwrap_or(self.rest.len());
        self.check(length)?;
        let text = &self.rest[..length];
        self.rest = self.rest.get(length + 1..).unwrap_or_default();
        Ok(Some(Line { text: text.strip_suffix(b"\r").unwrap_or(text), number: self.count }))
    }

    /// Checks the length of the line that was read last, in bytes.
    ///
    /// # Errors
    /// The same as [`next`](Self::next)'s.
    pub(super) fn check(&self, length: usize) -> Result<(), ReadError> {
        if length <= MAX_LINE {
            return Ok(());
        }
        let reason = format!("the line has {length} bytes, but at most {MAX_LINE} are read");
        Err(FilePosition::Line(self.count).error(reason))
    }
}

impl Line<'_> {
    pub(super) fn place(&self) -> FilePosition {
        FilePosition::Line(self.number)
    }
}

/// Returns the words of a text, which are separated by white space.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// Returns the first word, and the rest after it; both without white space around them.
pub(super) fn first_word(text: &[u8]) -> (&[u8], &[u8]) {
    let text = text.trim_ascii();
    let length = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
    (&text[..length], text[length..].trim_ascii_start())
}

/// Parses a word as a number of this type; none if it isn't one.
pub(super) fn parsed<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Parses the first N words as numbers, and ignores further words. What isn't there is NaN.
pub(super) fn numbers_or_nan<const N: usize>(text: &[u8]) -> [f32; N] {
    numbers(text, number_or_nan).0
}

/// Parses the first N words; words that aren't there are parsed as empty ones. Returns how many words there are, too, up to one
/// more than N.
pub(super) fn numbers<T: Copy, const N: usize>(text: &[u8], parse: impl Fn(&[u8]) -> T) -> ([T; N], usize) {
    let (mut numbers, mut count) = ([parse(b""); N], 0);
    for word in words(text) {
        count += 1;
        let Some(number) = numbers.get_mut(count - 1) else { break };
        *number = parse(word);
    }
    (numbers, count)
}

/// Parses a number; what isn't one is NaN. A comma may stand for the point, as programs write it that take numbers from the system's
/// language.
pub(super) fn number_or_nan(word: &[u8]) -> f32 {
    parsed(word).or_else(|| parsed(&with_point(word)?)).unwrap_or(f32::NAN)
}

/// Returns a word with a point instead of its comma, if it has a single comma and no point.
fn with_point(word: &[u8]) -> Option<Vec<u8>> {
    let at = memchr(b',', word)?;
    let is_single = memchr(b',', &word[at + 1..]).is_none() && memchr(b'.', word).is_none();
    is_single.then(|| [&word[..at], b".", &word[at + 1..]].concat())
}

/// Returns a text in UTF-8, if it is in UTF-16 and says so with a byte order mark.
pub(super) fn of_utf16(bytes: &[u8]) -> Option<Vec<u8>> {
    let (is_big, units) = match bytes {
        [0xff, 0xfe, units @ ..] => (false, units),
        [0xfe, 0xff, units @ ..] => (true, units),
        _ => return None,
    };
    // A unit of 16 bits becomes 3 bytes at most.
    let mut text = Vec::with_capacity(3 * (units.len() / 2));
    let units = units
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&unit| if is_big { u16::from_be_bytes(unit) } else { u16::from_le_bytes(unit) });
    for letter in char::decode_utf16(units) {
        text.extend(letter.unwrap_or(char::REPLACEMENT_CHARACTER).encode_utf8(&mut [0; 4]).bytes());
    }
    Some(text)
}

/// Returns a text in UTF-8. From UTF-16 that takes half as much memory again, which every file is allowed.
pub(super) fn in_utf8(bytes: Vec<u8>) -> Vec<u8> {
    of_utf16(&bytes).unwrap_or(bytes)
}

/// Returns the number, from 1, of the line with the first text at `byte` or after it. A CSV reader's own line number
/// is too low where it skips empty lines before a record.
pub(super) fn line_at(text: &[u8], byte: usize) -> usize {
    let start = byte.min(text.len());
    let passed = text[start..].iter().take_while(|&&byte| byte == b'\n' || byte == b'\r').count();
    1 + text[..start + passed].iter().filter(|&&byte| byte == b'\n').count()
}

/// Returns the start of a word for a message, in quotes.
pub(super) fn shown(word: &[u8]) -> String {
    let start = String::from_utf8_lossy(&word[..word.len().min(160)]);
    let short: String = start.chars().take(40).collect();
    let cut = if short.len() < start.len() || word.len() > 160 { "..." } else { "" };
    format!("{:?}", short + cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &[u8]) -> Vec<(usize, Vec<u8>)> {
        let mut lines = Lines::new(text);
        let mut all = Vec::new();
        while let Some(line) = lines.next().unwrap() {
            all.push((line.number, line.text.to_vec()));
        }
        all
    }

    #[test]
    fn lines_of_every_system() {
        let expected = [(1, b"a".to_vec()), (2, b"".to_vec()), (3, b"b c".to_vec())];
        for text in ["a\n\nb c", "a\r\n\r\nb c\r\n", "a\r\rb c", "\u{feff}a\n\nb c\n"] {
            assert_eq!(all(text.as_bytes()), expected, "{text:?}");
        }
        assert!(all(b"").is_empty());
    }

    #[test]
    fn a_line_has_a_longest_length() {
        let text = [b"a\n", &vec![b'x'; MAX_LINE][..], b"\n", &vec![b'x'; MAX_LINE + 1]].concat();
        let mut lines = Lines::new(&text);
        assert!(lines.next().is_ok() && lines.next().is_ok());
        let message = lines.next().err().unwrap().to_string();
        assert_eq!(message, "line 3: the line has 4194305 bytes, but at most 4194304 are read; export the model again");
    }

    #[test]
    fn words_and_numbers() {
        assert_eq!(first_word(b"\t usemtl  old  wood \r"), (&b"usemtl"[..], &b"old  wood"[..]));
        assert_eq!(first_word(b"  "), (&b""[..], &b""[..]));
        assert_eq!(numbers_or_nan(b" 1\t-2.5e1 +.5 7"), [1.0, -25.0, 0.5]);
        assert_eq!(parsed::<f32>(b"1,5"), None);
        assert_eq!(shown(&[0xff; 500]), format!("\"{}...\"", "\u{fffd}".repeat(40)));
    }

    #[test]
    fn what_is_not_a_number_is_nan() {
        let found: [f32; 6] = numbers_or_nan(b"1.5 1.#IND 2,5,1 2.5,1 ,");
        assert_eq!(found[0], 1.5);
        assert!(found[1..].iter().all(|number| number.is_nan()));
    }

    #[test]
    fn a_comma_may_stand_for_the_point() {
        assert_eq!(numbers_or_nan(b"1,5 -2,5e1 0,"), [1.5, -25.0, 0.0]);
    }

    #[test]
    fn utf_16_is_read_in_both_byte_orders() {
        let text = "v 1 \u{1f98a}\n";
        let units = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect::<Vec<_>>();
        let read = |mark: [u8; 2], units: Vec<u8>| of_utf16(&[mark.to_vec(), units].concat());
        assert_eq!(read([0xff, 0xfe], units(u16::to_le_bytes)), Some(text.as_bytes().to_vec()));
        assert_eq!(read([0xfe, 0xff], units(u16::to_be_bytes)), Some(text.as_bytes().to_vec()));
        assert_eq!(of_utf16(text.as_bytes()), None);
        assert_eq!(read([0xff, 0xfe], vec![0, 0xd8, b'v']), Some("\u{fffd}".as_bytes().to_vec()), "half of a pair");
    }
}
