//! Splits a `.glb` file into its chunks, and checks their lengths against the file's.
//!
//! Source: glTF 2.0 specification, section 4.4.

use std::ops::Range;

use super::GltfError;

/// The length of the file's header, in bytes.
const HEADER: usize = 12;
/// The length of a chunk's header, in bytes.
const CHUNK_HEADER: usize = 8;

/// The ranges of the parts of a `.glb`.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Parts {
    pub json: Range<usize>,
    /// The first binary chunk.
    pub bin: Option<Range<usize>>,
    /// What is wrong with the lengths, though the parts are whole.
    pub warning: Option<String>,
}

/// Returns whether these bytes start like a `.glb`.
pub(super) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF")
}

/// Finds the chunks. Chunks of other kinds are ignored, and so are bytes after the length in the header, unless they belong to a chunk
/// that begins before: some programs count the file without its padding.
///
/// # Errors
/// [`GltfError::NotGltf`], with the lengths in the headers and in the file.
pub(super) fn parts(bytes: &[u8]) -> Result<Parts, GltfError> {
    let fail = |reason: String| GltfError::NotGltf { reason };
    if bytes.len() < HEADER {
        return Err(fail(format!(
            "the file ends within its header, which takes {HEADER} bytes: it has {}",
            bytes.len()
        )));
    }
    let [version, length] = [4, 8].map(|at| number(bytes, at));
    if version != 2 {
        return Err(fail(format!("its header says that its version is {version}, but only version 2 is read")));
    }
    if length < HEADER {
        return Err(fail(format!("its header says that the file has {length} bytes, but it has {}", bytes.len())));
    }
    if length > bytes.len() {
        let has = bytes.len();
        return Err(fail(format!(
            "the file was cut short: its header says that it has {length} bytes, but it has {has}"
        )));
    }
    let mut chunks = Chunks { bytes, length, next: HEADER, count: 0 };
    let Some((b"JSON", mut json)) = chunks.next()? else {
        return Err(fail("its first chunk isn't JSON".to_owned()));
    };
    // The padding should be spaces, but some exporters write zeros.
    json.end -= bytes[json.clone()].iter().rev().take_while(|byte| **byte == 0).count();
    let mut bin = None;
    while let Some((kind, range)) = chunks.next()? {
        if kind == b"BIN\0" {
            bin = Some(range);
            break;
        }
    }
    let is_longer = chunks.next > length;
    let said =
        || format!("The file's header says that it has {length} bytes, but its parts go on until {}.", chunks.next);
    Ok(Parts { json, bin, warning: is_longer.then(said) })
}

/// A chunk's kind, and the range of its data.
type Chunk<'a> = (&'a [u8; 4], Range<usize>);

struct Chunks<'a> {
    bytes: &'a [u8],
    /// The length in the header, in bytes.
    length: usize,
    next: usize,
    count: usize,
}

impl<'a> Chunks<'a> {
    /// Returns the next chunk; none at the end.
    fn next(&mut self) -> Result<Option<Chunk<'a>>, GltfError> {
        let left = self.length.saturating_sub(self.next);
        if left == 0 {
            return Ok(None);
        }
        let fail = |reason| Err(GltfError::NotGltf { reason });
        let (i, at) = (self.count, self.next);
        let Some(kind) = self.bytes[at..self.length].get(4..CHUNK_HEADER).and_then(<[u8]>::first_chunk) else {
            return fail(format!(
                "chunk {i} ends within its header, which takes {CHUNK_HEADER} bytes: {left} are left"
            ));
        };
        let length = number(self.bytes, at);
        let left = self.bytes.len() - at - CHUNK_HEADER;
        if length > left {
            return fail(format!("chunk {i} says that it has {length} bytes, but {left} are left"));
        }
        let start = at + CHUNK_HEADER;
        self.count += 1;
        self.next = start + length;
        Ok(Some((kind, start..self.next)))
    }
}

/// Reads a little-endian 32-bit number; 0 beyond the end.
fn number(bytes: &[u8], at: usize) -> usize {
    bytes[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes) as usize)
}
