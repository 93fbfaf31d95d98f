//! The start of a stream: what it will become, and what decoding it may take.
//!
//! Source: Google, Draco bitstream specification, sections 4 to 6, <https://google.github.io/draco/spec/>.

use draco_core::{DecoderBuffer, DracoError, GeometryMetadata};

/// The bits of a stream's flags that say that metadata follow.
const METADATA: u16 = 0x8000;
/// The version that glTF has.
const VERSION: [u8; 2] = [2, 2];

/// Memory for a symbol in a table of probabilities: room is made for 64 a byte that is left of the stream, whatever it holds. Of a
/// table that turns out whole, the next power of two is made, with old and new both alive.
const PER_SYMBOL: u64 = 8;
const PER_WHOLE_SYMBOL: u64 = 3 * PER_SYMBOL;
const SYMBOLS_A_BYTE: u64 = 64;
/// For each triangle, its edges' neighbours and as many vertices as it has corners, with the order in which they are met.
const PER_TRIANGLE: u64 = 212;
/// For each triangle, once more for every attribute whose seams cut the mesh, and for the vertices that they make.
const PER_SEAMED: u64 = 64;
const SEAMS: u64 = 48;
/// For each byte of what comes out: as it is, as whole numbers, and as the symbols that those were.
const PER_VALUE: u64 = 9;
/// For the largest tables of a decoder of symbols.
const FIXED: u64 = 8 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    triangles: u64,
    /// None if that is seen only when the triangles are there.
    vertices: Option<u64>,
    /// Attributes that have seams of their own.
    seamed: u64,
}

impl Header {
    /// # Errors
    /// A clause: it is no stream of a mesh, or of another version.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let cut = |_: DracoError| format!("ends within its header: it has {} bytes", bytes.len());
        let mut buffer = DecoderBuffer::new(bytes);
        let mut start = [0; 9];
        buffer.decode_bytes(&mut start).map_err(cut)?;
        let [b'D', b'R', b'A', b'C', b'O', major, minor, kind, method] = start else {
            return Err("is of data that don't begin with DRACO".to_owned());
        };
        if [major, minor] != VERSION {
            return Err(format!("is of Draco's version {major}.{minor}, and 2.2 is read"));
        }
        if kind != 1 || method > 1 {
            return Err(format!("is of kind {kind} and method {method}, and a mesh is of kind 1 and method 0 or 1"));
        }
        buffer.set_version(major, minor);
        if buffer.decode_u16().map_err(cut)? & METADATA != 0 {
            GeometryMetadata::decode(&mut buffer).map_err(|_| "has metadata that can't be read".to_owned())?;
        }
        if method == 0 {
            let triangles = buffer.decode_varint().map_err(cut)?;
            return Ok(Self { triangles, vertices: Some(buffer.decode_varint().map_err(cut)?), seamed: 0 });
        }
        // How it was walked, and vertices before seams cut them.
        buffer.decode_u8().map_err(cut)?;
        buffer.decode_varint().map_err(cut)?;
        let triangles = buffer.decode_varint().map_err(cut)?;
        Ok(Self { triangles, vertices: None, seamed: u64::from(buffer.decode_u8().map_err(cut)?) })
    }

    /// Whether that is what accessors say.
    ///
    /// # Errors
    /// A clause with both numbers.
    pub fn check(&self, vertices: u64, indices: u64) -> Result<(), String> {
        let triangles = self.triangles;
        if triangles.checked_mul(3) != Some(indices) {
            return Err(format!("holds {triangles} triangles, and its indices' accessor says {indices} indices"));
        }
        match self.vertices.filter(|has| *has != vertices) {
            Some(has) => Err(format!("holds {has} vertices, and its accessors say {vertices}")),
            None => Ok(()),
        }
    }

    /// How much decoding the stream takes at most, if it becomes so many bytes of values.
    pub fn memory(&self, bytes: &[u8], values: u64) -> u64 {
        let tables = (bytes.len() as u64 * SYMBOLS_A_BYTE * PER_SYMBOL).max(symbols(bytes) * PER_WHOLE_SYMBOL);
        let seams = if self.seamed > 0 { SEAMS + self.seamed * PER_SEAMED } else { 0 };
        let triangles = self.triangles.saturating_mul(PER_TRIANGLE + seams);
        tables.saturating_add(triangles).saturating_add(values.saturating_mul(PER_VALUE)).saturating_add(FIXED)
    }
}

/// How many symbols a whole table in these bytes has at most: a byte that ends in two set bits says how many more come to
/// nothing, any other is one's probability, or a part of it.
fn symbols(bytes: &[u8]) -> u64 {
    bytes.iter().map(|byte| if byte & 3 == 3 { u64::from(byte >> 2) + 1 } else { 1 }).sum()
}
