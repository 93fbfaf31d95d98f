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

/// Finds the chunks. Chunks of other kinds are ignored, and so are bytes after the length in the header, unless they belong to a chunk
/// that begins before: some programs count the file without its padding.
///
/// # Errors
/// [`GltfError::NotGltf`], with the lengths in the headers and in the file.
pub(super) fn parts(bytes: &[u8]) -> Result<Parts, GltfError> {
    let fail = |reason: String| GltfError::NotGltf { reason };
    if bytes.len() < HEADER {
        let has = bytes.len();
        return Err(fail(format!("the file ends within its header, which takes {HEADER} bytes: it has {has}")));
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
    let (mut next, mut json, mut bin) = (HEADER, None, None);
    for i in 0.. {
        let left = length.saturating_sub(next);
        if left == 0 || bin.is_some() {
            break;
        }
        let kind = bytes[next..length].get(4..CHUNK_HEADER).ok_or_else(|| {
            fail(format!("chunk {i} ends within its header, which takes {CHUNK_HEADER} bytes: {left} are left"))
        })?;
        let (start, size) = (next + CHUNK_HEADER, number(bytes, next));
        let left = bytes.len() - start;
        if size > left {
            return Err(fail(format!("chunk {i} says that it has {size} bytes, but {left} are left")));
        }
        next = start + size;
        match (i, kind) {
            (0, b"JSON") => json = Some(start..next),
            (0, _) => break,
            (_, b"BIN\0") => bin = Some(start..next),
            _ => {}
        }
    }
    let mut json = json.ok_or_else(|| fail("its first chunk isn't JSON".to_owned()))?;
    // The padding should be spaces, but some exporters write zeros.
    json.end -= bytes[json.clone()].iter().rev().take_while(|byte| **byte == 0).count();
    let said = || format!("The file's header says that it has {length} bytes, but its parts go on until {next}.");
    Ok(Parts { json, bin, warning: (next > length).then(said) })
}

/// Reads a little-endian 32-bit number; 0 beyond the end.
fn number(bytes: &[u8], at: usize) -> usize {
    bytes[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes) as usize)
}
