//! Bounds the memory that the decoder takes, before it decodes anything, by what the data and the accessors say. Data as programs write it
//! takes less. Data that was made to do harm may have seams along all edges, or bytes where the accessors have floats; it takes less
//! than twice as much.

use super::header::Header;
use super::tables::Walked;

/// Memory for each byte of the header, most of which may be metadata, in bytes.
const PER_HEADER_BYTE: u64 = 64;
/// Memory for the tables that find symbols of up to 20 bits, in bytes.
const FIXED: u64 = 5 << 20;
/// Memory for an attribute besides its values, in bytes. It takes [`ATTRIBUTE_DATA`] bytes of data at least.
const ATTRIBUTE: u64 = 768;
const ATTRIBUTE_DATA: u64 = 6;
/// Memory for a triangle in a list, in bytes; and for one by edgebreaker: corners' vertices and neighbours, symbols, and the list.
const LISTED: u64 = 24;
const CONNECTED: u64 = 48;
/// Memory for a triangle for each attribute that has seams of its own, in bytes: corners' vertices and neighbours, and the seams.
const SEAMED: u64 = 40;
/// Memory for a vertex without seams, in bytes: a corner, marks, and its place in the order.
const VERTEX: u64 = 40;
/// Memory for each byte of values of unknown attributes: the byte, and half of a number and of a symbol of 32 bits made of it.
const UNKNOWN_VALUE: u64 = 7;

/// Returns how much memory decoding takes, in bytes. `data` is the size of the data in bytes, `points` the number of vertices in the
/// accessors, and `values` the greatest size of all values of the result together, in bytes.
pub(super) fn decoding_bytes(header: &Header, walked: &Walked, data: u64, points: u64, values: u64) -> u64 {
    let triangles = header.triangles;
    let connectivity = if header.listed.is_some() {
        triangles.saturating_mul(LISTED)
    } else {
        let vertices = header.vertices.min(triangles.saturating_mul(4)).saturating_mul(VERTEX);
        triangles.saturating_mul(CONNECTED + SEAMED * header.seamed).saturating_add(vertices)
    };
    let (count, values) = match &walked.attributes {
        Some(attributes) => {
            // Values, the integers that they are made of, and for each point which of these it has.
            let kept: u64 = attributes.iter().map(|coded| coded.components * (coded.size + 4) + 8).sum();
            // The symbols of the attribute that is decoded, while their list grows.
            let symbols = attributes.iter().map(|coded| 8 * coded.components).max().unwrap_or(0);
            (attributes.len() as u64, (kept + symbols).saturating_mul(points))
        }
        None => (data / ATTRIBUTE_DATA / 2, values.saturating_mul(UNKNOWN_VALUE)),
    };
    // With half of the tables this is still more than half of what data takes that has both.
    let fixed = FIXED + walked.tables / 2 + header.end as u64 * PER_HEADER_BYTE + count * ATTRIBUTE;
    connectivity.saturating_add(values).saturating_add(fixed)
}
