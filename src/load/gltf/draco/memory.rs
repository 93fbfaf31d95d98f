//! Bounds the memory that the decoder `draco-core` takes, before it decodes anything.
//!
//! The numbers are those of what version 2.3.3 allocates, in the order in which it does: the triangles' corners and their
//! neighbours, the same again for each attribute with seams, and then attribute by attribute its values. Most of it stays until
//! decoding ends. A list that grows has up to twice the length that it needs, and half as much again while it is copied.
//!
//! Data that was made to do harm may have seams along all edges. So the bound is the largest of what the connectivity may take at most,
//! and of what the attributes take if the mesh has as many vertices as its accessors say; another mesh is refused before its
//! attributes are decoded.

use super::header::{Connectivity, Edgebreaker, Header};
use super::tables::{AttributeDecoder, Coded, Walked};

/// Memory for each byte of the header, most of which may be metadata, in bytes.
const PER_HEADER_BYTE: u64 = 128;
/// Memory for the tables that find symbols of up to 20 bits, in bytes.
const FIXED: u64 = 5 << 20;
/// Memory for an attribute besides its values, in bytes. It takes [`ATTRIBUTE_DATA`] bytes of data at least.
const ATTRIBUTE: u64 = 768;
const ATTRIBUTE_DATA: u64 = 6;
/// Memory for each byte of values of unknown attributes: the byte itself, a number and a symbol of 32 bits made of it, and the number
/// of the value.
const UNKNOWN_VALUE: u64 = 13;

/// What is to be decoded.
pub(super) struct Decoding<'a> {
    pub header: &'a Header,
    pub walked: &'a Walked,
    /// The size of the data, in bytes.
    pub data: u64,
    /// The number of vertices in the accessors.
    pub points: u64,
    /// The greatest size of all values of the result together, in bytes.
    pub values: u64,
}

impl Decoding<'_> {
    /// The greatest amount of memory, in bytes, that decoding takes.
    pub(super) fn peak(&self) -> u64 {
        let decoded = match self.header.connectivity {
            Connectivity::Sequential { .. } => {
                // Symbols that grow, or symbols and indices, or indices and triangles; then triangles and attributes.
                let indices = 12_u64.saturating_mul(self.header.triangles);
                indices.saturating_mul(2).max(indices.saturating_add(self.attributes(None)))
            }
            Connectivity::Edgebreaker(counts) => {
                let counts = Connected::of(self.header.triangles, &counts, self.data);
                counts.connectivity().max(self.attributes(Some(&counts)))
            }
        };
        let attributes = match &self.walked.decoders {
            Some(decoders) => decoders.iter().map(|decoder| decoder.attributes.len() as u64).sum(),
            None => self.data / ATTRIBUTE_DATA,
        };
        let fixed = FIXED + self.walked.tables + self.header.end as u64 * PER_HEADER_BYTE + attributes * ATTRIBUTE;
        decoded.saturating_add(fixed)
    }

    /// The size of the result, in bytes.
    pub(super) fn result(&self) -> u64 {
        let indices = 12_u64.saturating_mul(self.header.triangles);
        let values = match &self.walked.decoders {
            Some(decoders) => {
                let all = decoders.iter().flat_map(|decoder| &decoder.attributes);
                all.map(|coded| (coded.stride() + 4).saturating_mul(self.points)).fold(0, u64::saturating_add)
            }
            None => self.values.saturating_mul(5),
        };
        indices.saturating_add(values)
    }

    /// The size of a vertex's values, in bytes; none if the attributes aren't known.
    pub(super) fn stride(&self) -> Option<u64> {
        let decoders = self.walked.decoders.as_ref()?;
        Some(decoders.iter().flat_map(|decoder| &decoder.attributes).map(Coded::stride).sum())
    }

    /// The memory while attributes are decoded, with that for a connectivity by edgebreaker.
    fn attributes(&self, connected: Option<&Connected>) -> u64 {
        let Some(decoders) = &self.walked.decoders else {
            let values = self.values.saturating_mul(UNKNOWN_VALUE);
            let most = connected.map_or(0, |counts| {
                let points = self.values.min(counts.corners);
                counts.kept(points).saturating_add(counts.order(points) + 12 * counts.vertices + counts.search(true))
            });
            return values.saturating_add(most).saturating_add(12 * connected.map_or(0, |counts| counts.triangles));
        };
        let points = connected.map_or(self.points, |counts| self.points.min(counts.corners));
        // Several decoders share the order of vertices without seams, which is kept for them.
        let mut kept = connected.map_or(0, |counts| counts.kept(points));
        if decoders.len() > 1 {
            kept = kept.saturating_add(connected.map_or(0, |counts| 12 * counts.vertices));
        }
        let mut peak = kept;
        for decoder in decoders {
            let own = if decoder.is_seamed { points } else { 0 };
            let (order, search) =
                connected.map_or((0, 0), |counts| (counts.order(own), counts.search(decoder.by_degree) + own));
            peak = peak.max(kept.saturating_add(order + search));
            let entries = match connected {
                Some(counts) if !decoder.is_seamed => points.min(counts.vertices),
                _ => points,
            };
            let flags = connected.map_or(0, |counts| self.walked.flags.unwrap_or(4 * counts.corners).max(entries));
            kept = kept.saturating_add(decoder.kept(entries, points));
            let working = decoder.working(entries).saturating_add(flags).max(points.saturating_mul(4));
            peak = peak.max(kept.saturating_add(order).saturating_add(working));
        }
        peak
    }
}

impl Coded {
    /// The size of a value, in bytes.
    fn stride(&self) -> u64 {
        self.components * self.size
    }

    /// How many numbers of 32 bits a value is decoded from.
    fn numbers(&self) -> u64 {
        // A normal is two coordinates on an octahedron.
        if self.decoder == 3 { 2 } else { self.components }
    }
}

impl AttributeDecoder {
    /// The memory that stays until the end: values, and which one each point has. Quantised values and normals are kept as integers too.
    fn kept(&self, entries: u64, points: u64) -> u64 {
        let of = |coded: &Coded| {
            // Which value each point has.
            let places = points.saturating_mul(4);
            let integers = (4 * coded.numbers()).saturating_mul(entries).saturating_add(places);
            let values = coded.stride().saturating_mul(entries).saturating_add(places);
            values.saturating_add(if coded.decoder >= 2 { integers } else { 0 })
        };
        self.attributes.iter().map(of).fold(0, u64::saturating_add)
    }

    /// The symbols of the largest attribute, while their list grows.
    fn working(&self, entries: u64) -> u64 {
        let symbols = self.attributes.iter().map(|coded| 8 * coded.numbers()).max();
        symbols.unwrap_or(0).saturating_mul(entries)
    }
}

/// The numbers that the memory for a connectivity by edgebreaker depends on. They are small enough to be added and multiplied.
struct Connected {
    triangles: u64,
    corners: u64,
    vertices: u64,
    symbols: u64,
    /// The greatest number of edges: the triangle of a symbol brings at most one more than it brings vertices.
    edges: u64,
    events: u64,
    seamed: u64,
}

impl Connected {
    /// The decoder refuses numbers that are larger than these.
    fn of(triangles: u64, counts: &Edgebreaker, data: u64) -> Self {
        let triangles = triangles.min(u64::from(u32::MAX) / 3);
        let symbols = counts.symbols.min(triangles);
        let vertices = counts.vertices.min(4 * triangles);
        // A triangle that starts a component may take three edges from others.
        let edges = (symbols + vertices + 6 * (triangles - symbols)).min(3 * triangles);
        let events = counts.events.min(data).min(triangles);
        Self { triangles, corners: 3 * triangles, vertices, symbols, edges, events, seamed: counts.seamed }
    }

    /// What stays until the end, besides seams: corners' vertices and neighbours, a corner and a mark for each vertex, the corners of
    /// the list of vertices, the order of symbols, and the triangles.
    fn base(&self) -> u64 {
        8 * self.corners + 14 * self.vertices + 8 * self.symbols + 12 * self.triangles
    }

    /// The list of edges that are seams of an attribute.
    fn seams(&self) -> u64 {
        4 * self.edges.next_power_of_two()
    }

    /// The greatest amount of memory until the points are known.
    fn connectivity(&self) -> u64 {
        let splits = if self.events > 0 { 8 * self.symbols + 24 * self.events } else { 0 };
        // Symbols, and lists for vertices and active corners.
        let first = 8 * self.corners + 33 * self.vertices + 16 * self.symbols + splits;
        let seams = self.base() + 11 * self.vertices + 4 * self.symbols + splits;
        let second = seams + (self.seamed + 1) * self.seams();
        if self.seamed == 0 {
            return first.max(second);
        }
        // Each attribute has corners' vertices and neighbours, and a corner of each of its vertices, of which there may be as many as
        // corners.
        let tables = self.seamed * (self.seams() + 16 * self.corners + self.vertices);
        let points = 4 * self.corners + 6 * self.corners.next_power_of_two();
        first.max(second).max(self.base() + tables + points.max(5 * self.corners))
    }

    /// What stays until the end if the mesh has so many points.
    fn kept(&self, points: u64) -> u64 {
        let table = 8 * self.corners + 8 * points.max(self.vertices) + self.vertices;
        self.base() + self.seamed * (self.seams() + table)
    }

    /// The order of the vertices without seams, and with those of an attribute that has `own` vertices.
    fn order(&self, own: u64) -> u64 {
        12 * (self.vertices + own)
    }

    /// What finding an order takes: marks of triangles and vertices, and lists of corners.
    fn search(&self, by_degree: bool) -> u64 {
        self.triangles * if by_degree { 25 } else { 13 } + 5 * self.vertices
    }
}
