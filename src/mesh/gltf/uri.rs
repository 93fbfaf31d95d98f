//! URIs of buffers and images: data in the document itself, or files next to it.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// The bytes that a URI stands for, `limit` of them at most.
///
/// Files must lie in the document's folder or below it: a model can't make the program read anything else.
///
/// # Errors
/// A clause that says what is wrong.
pub fn read(uri: &str, folder: &Path, limit: u64) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        return read_data(data);
    }
    let path = folder.join(relative_path(uri)?);
    let named = |error: std::io::Error| format!("{}: {error}", path.display());
    // A pipe or a device could block for ever.
    if !path.metadata().map_err(named)?.is_file() {
        return Err(format!("{} is not a file", path.display()));
    }
    let mut bytes = Vec::new();
    File::open(&path).and_then(|file| file.take(limit).read_to_end(&mut bytes)).map_err(named)?;
    Ok(bytes)
}

/// A URI fit for a message: data URIs are long.
pub fn shown(uri: &str) -> String {
    let (start, rest) = uri.split_at(uri.char_indices().nth(60).map_or(uri.len(), |(i, _)| i));
    if rest.is_empty() { start.to_owned() } else { format!("{start}...") }
}

fn read_data(data: &str) -> Result<Vec<u8>, String> {
    let (header, body) = data.split_once(',').ok_or("the data URI has no comma")?;
    match header.ends_with(";base64") {
        true => base64(body),
        false => Ok(percent_decoded(body)),
    }
}

fn relative_path(uri: &str) -> Result<PathBuf, String> {
    // A scheme ends at a colon before any slash; the drive of a Windows path looks the same.
    if uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err("only files next to the document are read, and it names another place".to_owned());
    }
    let decoded = String::from_utf8(percent_decoded(uri)).map_err(|_| "its name is not UTF-8".to_owned())?;
    let path = PathBuf::from(decoded);
    let inside = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    if path.as_os_str().is_empty() {
        return Err("its name is empty".to_owned());
    }
    if !path.components().all(inside) {
        return Err("only files in the document's folder are read, and it lies outside".to_owned());
    }
    Ok(path)
}

/// %XX as the byte it stands for; a % that no two hexadecimal digits follow stays.
fn percent_decoded(text: &str) -> Vec<u8> {
    let digit = |byte: &u8| char::from(*byte).to_digit(16);
    let mut decoded = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, tail)) = rest.split_first() {
        rest = tail;
        let byte = match (first, tail) {
            (b'%', [high, low, ..]) => digit(high).zip(digit(low)).map(|(high, low)| (16 * high + low) as u8),
            _ => None,
        };
        if byte.is_some() {
            rest = &tail[2..];
        }
        decoded.push(byte.unwrap_or(first));
    }
    decoded
}

/// RFC 4648, section 4; line breaks and missing padding are forgiven.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0_u32, 0);
    let digits = text.bytes().filter(|byte| !byte.is_ascii_whitespace());
    for byte in digits.take_while(|&byte| byte != b'=') {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return Err(format!("the data URI has a character that isn't base64: {:?}", char::from(byte))),
        };
        // Six bits in, eight out whenever there are enough; what was given out is shifted out of sight.
        bits = (bits << 6) | u32::from(digit);
        held += 6;
        if held >= 8 {
            held -= 8;
            decoded.push((bits >> held) as u8);
        }
    }
    Ok(decoded)
}

/// Base64 of some bytes, for documents made in tests.
#[cfg(test)]
pub fn to_base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let bits = chunk.iter().fold(0_u32, |bits, &byte| (bits << 8) | u32::from(byte)) << (8 * (3 - chunk.len()));
        for k in 0..4 {
            let digit = char::from(DIGITS[(bits >> (18 - 6 * k)) as usize & 63]);
            text.push(if k <= chunk.len() { digit } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_base64() {
        for (text, bytes) in [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9v\nYmFy", "foobar")] {
            assert_eq!(base64(text), Ok(bytes.into()));
        }
        assert!(base64("Zm9*").is_err());
    }

    #[test]
    fn percent_signs() {
        assert_eq!(relative_path("a%20b/c.bin"), Ok("a b/c.bin".into()));
        assert_eq!(percent_decoded("100%_%4"), b"100%_%4");
        assert!(relative_path("%ff").is_err());
    }

    #[test]
    fn only_files_below_the_folder() {
        for uri in ["../a", "/elsewhere/a", "file:///elsewhere/a", "https://example.org/a.bin", "a/%2e%2e/../b", ""] {
            assert!(relative_path(uri).is_err(), "{uri}");
        }
        assert!(relative_path("./textures/a.png").is_ok());
    }

    proptest! {
        #[test]
        fn base64_there_and_back(bytes in prop::collection::vec(any::<u8>(), 0..50)) {
            prop_assert_eq!(base64(&to_base64(&bytes)), Ok(bytes));
        }
    }
}
