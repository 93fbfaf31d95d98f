//! Reads the start of Draco data: the size of the mesh, and an estimate of the memory for decoding it.
//!
//! Source: Google, Draco bitstream specification, sections 4 to 6, <https://google.github.io/draco/spec/>.

use draco_core::{DecoderBuffer, DracoError, GeometryMetadata};

use super::tables::{self, Connectivity};

/// The flag that says that metadata follows.
const METADATA: u16 = 0x8000;
/// The version that glTF uses.
const VERSION: [u8; 2] = [2, 2];

/// Memory for each byte of the header, most of which may be metadata, in bytes.
const PER_HEADER_BYTE: u64 = 128;
/// Memory for each byte of the data: an event of the connectivity takes 16 bytes of memory and two of data at least, and an
/// attribute some 500 bytes of memory and 25 of data.
const PER_DATA_BYTE: u64 = 24;
/// Memory for each triangle, in bytes: the neighbours of its edges, its corners' vertices, and the order of the
/// traversal.
const PER_TRIANGLE: u64 = 212;
/// Additional memory for each triangle and attribute with seams, in bytes.
const PER_SEAMED: u64 = 64;
/// Additional memory for each triangle of a mesh with seams, for the vertices that they add, in bytes.
const SEAMS: u64 = 48;
/// Memory for each byte of the result: the value itself, the same as integers, and the symbols of those.
const PER_VALUE: u64 = 9;
/// Memory for the largest tables of a symbol decoder, in bytes.
const FIXED: u64 = 8 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Header {
    triangles: u64,
    /// None if the number is known only after the triangles are decoded.
    vertices: Option<u64>,
    /// The number of attributes with seams of their own.
    seamed: u64,
    connectivity: Connectivity,
    /// Where the header ends.
    end: usize,
}

impl Header {
    /// # Errors
    /// A clause if the data isn't a mesh, or has another version.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        let cut = |_: DracoError| format!("has data that ends within its header, after {} bytes", bytes.len());
        let mut buffer = DecoderBuffer::new(bytes);
        let mut start = [0; 9];
        buffer.decode_bytes(&mut start).map_err(cut)?;
        let [b'D', b'R', b'A', b'C', b'O', major, minor, kind, method] = start else {
            return Err("has data that doesn't begin with DRACO".to_owned());
        };
        if [major, minor] != VERSION {
            return Err(format!("has data of Draco version {major}.{minor}, but only version 2.2 is read"));
        }
        if kind != 1 || method > 1 {
            return Err(format!(
                "has data of kind {kind} and method {method}, but a mesh has kind 1 and method 0 or 1"
            ));
        }
        buffer.set_version(major, minor);
        if buffer.decode_u16().map_err(cut)? & METADATA != 0 {
            GeometryMetadata::decode(&mut buffer).map_err(|_| "has metadata that can't be read".to_owned())?;
        }
        if method == 0 {
            let triangles = buffer.decode_varint().map_err(cut)?;
            let points = buffer.decode_varint().map_err(cut)?;
            let connectivity = Connectivity::Sequential { triangles, points };
            let end = buffer.position();
            return Ok(Self { triangles, vertices: Some(points), seamed: 0, connectivity, end });
        }
        let traversal = buffer.decode_u8().map_err(cut)?;
        // The number of vertices before seams split them.
        buffer.decode_varint().map_err(cut)?;
        let triangles = buffer.decode_varint().map_err(cut)?;
        let seamed = u64::from(buffer.decode_u8().map_err(cut)?);
        let connectivity = Connectivity::Edgebreaker { traversal, seamed };
        Ok(Self { triangles, vertices: None, seamed, connectivity, end: buffer.position() })
    }

    /// Checks that the size agrees with the accessors.
    ///
    /// # Errors
    /// A clause with both numbers.
    pub(super) fn check(&self, vertices: u64, indices: u64) -> Result<(), String> {
        let triangles = self.triangles;
        if triangles.checked_mul(3) != Some(indices) {
            return Err(format!("holds {triangles} triangles, but the accessor of its indices has {indices} indices"));
        }
        match self.vertices.filter(|has| *has != vertices) {
            Some(has) => Err(format!("holds {has} vertices, but its accessors have {vertices}")),
            None => Ok(()),
        }
    }

    /// Returns where the data of the connectivity begins, and what kind it is.
    #[cfg(test)]
    pub(super) fn start(&self) -> (usize, Connectivity) {
        (self.end, self.connectivity)
    }

    /// Returns the greatest amount of memory, in bytes, that decoding takes if the result has `values` bytes of values.
    pub(super) fn memory(&self, bytes: &[u8], values: u64) -> u64 {
        let tables = tables::memory(bytes, self.end, self.connectivity);
        let tables = tables + self.end as u64 * PER_HEADER_BYTE + bytes.len() as u64 * PER_DATA_BYTE;
        let seams = if self.seamed > 0 { SEAMS + self.seamed * PER_SEAMED } else { 0 };
        let triangles = self.triangles.saturating_mul(PER_TRIANGLE + seams);
        tables.saturating_add(triangles).saturating_add(values.saturating_mul(PER_VALUE)).saturating_add(FIXED)
    }
}
