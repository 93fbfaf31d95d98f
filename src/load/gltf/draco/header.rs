//! Reads the start of Draco data: how large the mesh is.
//!
//! Source: Google, Draco bitstream specification, sections 4 to 6, <https://google.github.io/draco/spec/>.

use draco_core::{DecoderBuffer, DracoError, GeometryMetadata};

/// The flag that says that metadata follows.
const METADATA: u16 = 0x8000;
/// The most bytes of a header that are read: most of them may be metadata, which take up to a hundred times as much memory.
const LONGEST: usize = 1 << 20;
/// The version that glTF uses.
const VERSION: [u8; 2] = [2, 2];

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Header {
    pub triangles: u64,
    /// The number of vertices if the triangles' vertices are a list; none if they are encoded by edgebreaker, as the rest says.
    pub listed: Option<u64>,
    /// 0 for the standard traversal, 2 for one by valence.
    pub traversal: u8,
    /// The number of vertices before seams split them, with those that are joined again: one for each split.
    pub vertices: u64,
    /// The number of attributes with seams of their own.
    pub seamed: u64,
    /// The number of symbols, each of which makes a triangle. The triangles that start a component have none.
    pub symbols: u64,
    /// The number of events that say where the boundary was split.
    pub events: u64,
    /// Where the header ends, in bytes.
    pub end: usize,
}

impl Header {
    /// # Errors
    /// A clause if the data isn't a mesh, or has another version.
    #[expect(clippy::cast_possible_truncation, reason = "the decoder keeps 32 bits of it")]
    pub(super) fn read(bytes: &[u8]) -> Result<Self, String> {
        let cut = |_: DracoError| format!("has data that ends within its header, after {} bytes", bytes.len());
        let mut buffer = DecoderBuffer::new(&bytes[..bytes.len().min(LONGEST)]);
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
            let listed = Some(buffer.decode_varint().map_err(cut)?);
            return Ok(Self { triangles, listed, end: buffer.position(), ..Self::default() });
        }
        let traversal = buffer.decode_u8().map_err(cut)?;
        // The decoder keeps 32 bits of this number.
        let encoded = u64::from(buffer.decode_varint().map_err(cut)? as u32);
        let triangles = buffer.decode_varint().map_err(cut)?;
        let seamed = u64::from(buffer.decode_u8().map_err(cut)?);
        let symbols = buffer.decode_varint().map_err(cut)?;
        let splits = buffer.decode_varint().map_err(cut)?;
        let events = buffer.decode_varint().map_err(cut)?;
        let vertices = encoded.saturating_add(splits);
        Ok(Self { triangles, listed: None, traversal, vertices, seamed, symbols, events, end: buffer.position() })
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
        match self.listed.filter(|points| *points != vertices) {
            Some(points) => Err(format!("holds {points} vertices, but its accessors have {vertices}")),
            None => Ok(()),
        }
    }
}
