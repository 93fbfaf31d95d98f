//! Recognises a file's format by its first bytes.

use memchr::memmem::find;

use super::format::Format;
use super::text_lines::{Lines, first_word, of_utf16, parsed, words};
use super::unread_formats::{self, UnreadFormat};
use super::{off, stl};

/// What a file's first bytes show.
pub(super) enum Content {
    /// A format that is read. A text may be in UTF-16.
    Read { format: Format, is_utf16: bool },
    /// A format that isn't.
    Unread(&'static UnreadFormat),
}

/// Recognises a file by its first bytes; `length` is its whole size in bytes. Returns none if they could belong to a file of any
/// format, or of none.
pub(super) fn recognised(start: &[u8], length: u64) -> Option<Content> {
    let unit_pairs = start.len() / 2 * 2;
    let text = of_utf16(&start[..unit_pairs]);
    let read = |format| Content::Read { format, is_utf16: text.is_some() };
    binary(start, length).map(read).or_else(|| {
        if let Some(unread) = unread_formats::of_content(start, length) {
            return Some(Content::Unread(unread));
        }
        let text = text.as_deref().unwrap_or(start);
        let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        text_format(text)
            .map(read)
            .or_else(|| unread_formats::of_content(text, length).map(Content::Unread))
            .or_else(|| is_obj(text).then(|| read(Format::Obj)))
    })
}

fn binary(start: &[u8], length: u64) -> Option<Format> {
    match start {
        _ if stl::has_exact_size(start, length) => Some(Format::Stl),
        [b'g', b'l', b'T', b'F', ..] => Some(Format::Gltf),
        _ if start.starts_with(b"Kaydara FBX Binary") => Some(Format::Fbx),
        _ if start.starts_with(b"ply\n") || start.starts_with(b"ply\r") => Some(Format::Ply),
        // An archive that is empty begins with its end.
        [b'P', b'K', 3, 4, ..] | [b'P', b'K', 5, 6, ..] => {
            unread_formats::of_content(start, length).is_none().then_some(Format::ThreeMf)
        }
        _ => None,
    }
}

/// Recognises a text, without its byte order mark.
fn text_format(text: &[u8]) -> Option<Format> {
    let word = first_word(text).0;
    let is_json = word.starts_with(b"{");
    if word == b"ply" {
        return Some(Format::Ply);
    }
    if text.starts_with(b"; FBX ") || word == b"FBXHeaderExtension:" {
        return Some(Format::Fbx);
    }
    if is_json && [&b"\"asset\""[..], b"\"accessors\"", b"\"bufferViews\""].iter().any(|key| find(text, key).is_some())
    {
        return Some(Format::Gltf);
    }
    if off::begins(text) {
        return Some(Format::Off);
    }
    let facets = |word: &[u8]| word.eq_ignore_ascii_case(b"facet") || word.eq_ignore_ascii_case(b"endsolid");
    let is_stl = stl::begins_as_text(text) && lines(text).any(|line| facets(first_word(line).0));
    is_stl.then_some(Format::Stl)
}

/// Statements that an OBJ file may begin with.
const OBJ_STATEMENTS: [&[u8]; 12] =
    [b"v", b"vt", b"vn", b"vp", b"f", b"o", b"g", b"s", b"l", b"p", b"usemtl", b"mtllib"];

/// Whether a text is OBJ: it has a vertex, and no statement that OBJ doesn't have.
fn is_obj(text: &[u8]) -> bool {
    let statements = || lines(text).map(|line| first_word(line).0).filter(|word| !word.is_empty() && word[0] != b'#');
    has_vertex(text) && statements().all(|word| OBJ_STATEMENTS.contains(&word))
}

/// Whether one of a text's lines is a vertex of OBJ.
pub(super) fn has_vertex(text: &[u8]) -> bool {
    lines(text).any(|line| {
        let mut words = words(line);
        words.next() == Some(b"v") && words.by_ref().take(3).filter(|word| parsed::<f32>(word).is_some()).count() == 3
    })
}

/// Returns the whole lines of the start of a text.
fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut lines = Lines::new(text);
    std::iter::from_fn(move || {
        let line = lines.next().ok().flatten()?;
        // The last line may be cut off.
        (!lines.is_open || line.number == 1).then_some(line.text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn format(start: &[u8]) -> Option<Format> {
        match recognised(start, start.len() as u64)? {
            Content::Read { format, .. } => Some(format),
            Content::Unread(_) => None,
        }
    }

    #[test]
    fn texts_are_recognised_in_every_encoding() {
        let texts = [
            ("{\n \"asset\": {\"version\": \"2.0\"}}", Format::Gltf),
            ("; FBX 7.3.0 project file\n", Format::Fbx),
            ("# made by hand\n\nmtllib a.mtl\no cube\nv 0 0 -1.5\nv 1", Format::Obj),
            ("solid cube\n facet normal 0 0 1\n outer loop\n", Format::Stl),
            ("FACET normal 0 0 1\nouter loop\n", Format::Stl),
            ("ply\nformat ascii 1.0\n", Format::Ply),
            ("# a comment\nCOFF 8 6 12\n0 0 0 1 0 0 1\n", Format::Off),
        ];
        for (text, expected) in texts {
            let bytes = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect::<Vec<_>>();
            let utf16 = [[&b"\xff\xfe"[..], &bytes(u16::to_le_bytes)], [&b"\xfe\xff"[..], &bytes(u16::to_be_bytes)]];
            assert_eq!(format(text.as_bytes()), Some(expected), "{text}");
            assert_eq!(format(format!("\u{feff}{text}").as_bytes()), Some(expected), "{text}");
            for utf16 in utf16.map(|parts| parts.concat()) {
                assert_eq!(format(&utf16), Some(expected), "{text}");
                let content = recognised(&utf16, utf16.len() as u64);
                assert!(matches!(content, Some(Content::Read { is_utf16: true, .. })), "{text}");
            }
        }
    }

    #[test]
    fn what_belongs_to_no_format_is_not_recognised() {
        let texts =
            ["", "no mesh", "newmtl red\nKd 1 0 0\n", "{\"geometries\": []}", "OFF the record\n", "solid ground\n"];
        assert_eq!(texts.map(|text| format(text.as_bytes())), [None; 6]);
        // A list of what a program did may begin with v.
        assert_eq!(format(b"v 1 2 3\nversion 1.2\n"), None);
        assert_eq!(format(&[0; 84]), None, "a binary STL file without triangles could be anything");
    }

    #[test]
    fn a_binary_stl_file_is_recognised_by_its_size_whatever_its_header_says() {
        for header in [&b"glTF"[..], b"ply\n", b"PK\x03\x04", b"solid", b"OFF\n8 6 12\n", b"v 1 2 3\n", b"\xff\xfe"] {
            let bytes = stl::tests::binary(header);
            assert_eq!(format(&bytes), Some(Format::Stl), "{header:?}");
        }
    }
}
