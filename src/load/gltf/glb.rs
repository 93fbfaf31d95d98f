//! The container of a `.glb`: a header and chunks, whose lengths are held against the file before anything is taken.
//!
//! Source: glTF 2.0 specification, section 4.4.

use std::ops::Range;

use super::Problem;

/// Lengths of the file's header and of a chunk's, in bytes.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// Where the parts of a `.glb` lie.
#[derive(Debug, PartialEq, Eq)]
pub struct Parts {
    pub json: Range<usize>,
    /// The first binary chunk.
    pub bin: Option<Range<usize>>,
}

/// Whether these bytes say that they are a `.glb`.
pub fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF")
}

/// Finds the chunks. Those of other kinds are passed over, and so is what stands after the length that the header says.
///
/// # Errors
/// [`Problem::NotGltf`], with what is said and what is there.
pub fn parts(bytes: &[u8]) -> Result<Parts, Problem> {
    let fail = |reason: String| Problem::NotGltf { reason };
    if bytes.len() < HEADER {
        return Err(fail(format!(
            "the file ends within its header, which takes {HEADER} bytes of its {}",
            bytes.len()
        )));
    }
    let [version, length] = [4, 8].map(|at| number(bytes, at));
    if version != 2 {
        return Err(fail(format!("its header says version {version}, and 2 is read")));
    }
    if length < HEADER || length > bytes.len() {
        return Err(fail(format!("its header says {length} bytes, the file has {}", bytes.len())));
    }
    let mut chunks = Chunks { bytes: &bytes[..length], next: HEADER, count: 0 };
    let Some((b"JSON", json)) = chunks.next()? else {
        return Err(fail("its first chunk holds no JSON".to_owned()));
    };
    while let Some((kind, range)) = chunks.next()? {
        if kind == b"BIN\0" {
            return Ok(Parts { json, bin: Some(range) });
        }
    }
    Ok(Parts { json, bin: None })
}

/// A chunk's kind, and where its data lies.
type Chunk<'a> = (&'a [u8; 4], Range<usize>);

struct Chunks<'a> {
    bytes: &'a [u8],
    next: usize,
    count: usize,
}

impl<'a> Chunks<'a> {
    /// None at the end.
    fn next(&mut self) -> Result<Option<Chunk<'a>>, Problem> {
        let left = self.bytes.len() - self.next;
        if left == 0 {
            return Ok(None);
        }
        let fail = |reason| Err(Problem::NotGltf { reason });
        let (i, at) = (self.count, self.next);
        let Some(kind) = self.bytes[at..].get(4..CHUNK_HEADER).and_then(<[u8]>::first_chunk) else {
            return fail(format!("chunk {i} ends within its header, which takes {CHUNK_HEADER} bytes of {left}"));
        };
        let length = number(self.bytes, at);
        let left = left - CHUNK_HEADER;
        if length > left {
            return fail(format!("chunk {i} says {length} bytes, and {left} are left"));
        }
        let start = at + CHUNK_HEADER;
        self.count += 1;
        self.next = start + length;
        Ok(Some((kind, start..self.next)))
    }
}

/// 32 bits, little-endian; 0 beyond the end.
fn number(bytes: &[u8], at: usize) -> usize {
    bytes[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes) as usize)
}
