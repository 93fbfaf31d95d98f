//! Walks over Draco data without decoding it, to find how much memory the decoder will take: which attributes follow, and how large
//! the tables of probabilities are.
//!
//! The decoder allocates as many symbols as a table says that it has, as long as these are no more than 64 for each byte that
//! is left. Data that was made to do harm may say so in a few bytes; tables that an encoder writes have a few thousand symbols.
//! The walk reads what each table says. It ends where the length of the data is known only after decoding: at values that are
//! coded with tags, or not at all. From there on, 64 symbols a byte are counted. Only a few symbols with tags are decoded, as encoders
//! write them for valences that are rare.
//!
//! Source: Google, Draco bitstream specification, sections 4 to 14, <https://google.github.io/draco/spec/>.

use draco_core::symbol_encoding::{SymbolEncodingOptions, decode_symbols};
use draco_core::{DataType, DecoderBuffer};

use super::header::Header;
use geometry::casts::to_usize;

/// Memory for each symbol of a table of probabilities, in bytes.
const PER_SYMBOL: u64 = 8;
/// Memory for each symbol of a complete table, in bytes: it grows to the next power of two, with the old and the new table in
/// memory.
const PER_WHOLE_SYMBOL: u64 = 3 * PER_SYMBOL;
/// How many symbols the decoder reserves for each remaining byte of the data.
const SYMBOLS_A_BYTE: u64 = 64;

/// What a walk found.
#[derive(Debug)]
pub(super) struct Walked {
    /// The greatest amount of memory that tables of probabilities take at one time, in bytes.
    pub tables: u64,
    /// The attributes; none if the walk didn't come to them.
    pub attributes: Option<Vec<Coded>>,
}

/// An attribute, as its decoder's header has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coded {
    pub components: u64,
    /// The size of a component, in bytes.
    pub size: u64,
    /// 0 for values as they are, 1 for integers, 2 for quantised values, 3 for normals.
    decoder: u8,
}

/// Walks over data with this header.
pub(super) fn walk(bytes: &[u8], header: &Header) -> Walked {
    let mut walk = Walk::new(bytes, header.end);
    let is_whole = walk.buffer.set_position(header.end).is_ok() && walk.mesh(header).is_some();
    let known = walk.symbols * PER_WHOLE_SYMBOL;
    let rest = &bytes[walk.walked.min(bytes.len())..];
    let unknown = (rest.len() as u64 * SYMBOLS_A_BYTE * PER_SYMBOL).max(symbols(rest) * PER_WHOLE_SYMBOL);
    Walked { tables: if is_whole { known } else { known.max(unknown) }, attributes: walk.attributes }
}

/// Returns the greatest number of symbols of a complete table in these bytes. A byte whose two lowest bits are set says
/// how many further symbols have probability zero; any other byte is a symbol's probability, or a part of it.
fn symbols(bytes: &[u8]) -> u64 {
    bytes.iter().map(|byte| if byte & 3 == 3 { u64::from(byte >> 2) + 1 } else { 1 }).sum()
}

/// How many parallelograms a prediction may use, each with a list of flags of its own.
const PARALLELOGRAMS: usize = 4;
/// The bytes of a prediction's transform: two numbers.
const TRANSFORM: u64 = 8;
/// How many contexts the symbols of a traversal by valence have.
const VALENCES: usize = 6;
/// The greatest number of symbols that the walk decodes.
const FEW_SYMBOLS: u64 = 4096;
/// The number of tags: how many bits a number may have, from 0 to 32.
const TAGS: u64 = 33;

/// Each step returns none where it can't go on.
struct Walk<'a> {
    buffer: DecoderBuffer<'a>,
    /// Where the part ends that the walk is sure of.
    walked: usize,
    /// The greatest number of symbols of a table.
    symbols: u64,
    attributes: Option<Vec<Coded>>,
}

impl<'a> Walk<'a> {
    fn new(bytes: &'a [u8], start: usize) -> Self {
        let mut buffer = DecoderBuffer::new(bytes);
        buffer.set_version(2, 2);
        Self { buffer, walked: start, symbols: 0, attributes: None }
    }

    fn mesh(&mut self, header: &Header) -> Option<()> {
        match header.listed {
            Some(points) => self.indices(header.triangles.checked_mul(3)?, points)?,
            None => self.edgebreaker(header)?,
        }
        self.attributes(header.listed.is_none())
    }

    fn byte(&mut self) -> Option<u8> {
        self.buffer.decode_u8().ok()
    }

    fn varint(&mut self) -> Option<u64> {
        self.buffer.decode_varint().ok()
    }

    fn skip(&mut self, bytes: u64) -> Option<()> {
        self.buffer.try_advance(usize::try_from(bytes).ok()?).ok()
    }

    /// Notes that the walk has come this far.
    fn reached(&mut self) {
        self.walked = self.buffer.position();
    }

    /// The vertices of the triangles.
    fn indices(&mut self, count: u64, points: u64) -> Option<()> {
        match (self.byte()?, points) {
            // Without symbols or points nothing is read, and the list ends elsewhere.
            (_, 0) => return None,
            (0, _) if count > 0 => self.symbols()?,
            (1, 0..0x100) => self.skip(count)?,
            (1, 0x100..0x1_0000) => self.skip(count.checked_mul(2)?)?,
            (1, 0x1_0000..0x20_0000) => (0..count).try_for_each(|_| self.varint().map(|_| ()))?,
            (1, _) => self.skip(count.checked_mul(4)?)?,
            _ => return None,
        }
        self.reached();
        Some(())
    }

    fn edgebreaker(&mut self, header: &Header) -> Option<()> {
        let &Header { traversal, seamed, symbols, events, .. } = header;
        for _ in 0..events {
            self.varint()?;
            self.varint()?;
        }
        // One bit an event.
        self.skip(events.div_ceil(8))?;
        if symbols == 0 {
            return None;
        }
        self.reached();
        match traversal {
            0 => {
                let length = self.varint()?;
                self.skip(length)?;
                self.bits()?;
                (0..seamed).try_for_each(|_| self.bits())?;
            }
            2 => {
                self.bits()?;
                (0..seamed).try_for_each(|_| self.bits())?;
                for _ in 0..VALENCES {
                    self.reached();
                    let count = self.varint()?;
                    if count > 0 {
                        self.context(count)?;
                    }
                }
            }
            _ => return None,
        }
        self.reached();
        Some(())
    }

    /// Coded bits: their probability, their length in bytes, and they themselves.
    #[expect(clippy::cast_possible_truncation, reason = "the decoder keeps 32 bits of it")]
    fn bits(&mut self) -> Option<()> {
        self.byte()?;
        let length = self.varint()?;
        self.skip(u64::from(length as u32))
    }

    /// The symbols of a valence, of which there are so many. If these are few and have tags, they are decoded to find their end.
    fn context(&mut self, count: u64) -> Option<()> {
        let start = self.buffer.position();
        let is_tagged = self.byte()? == 0;
        let are_few = is_tagged && count <= FEW_SYMBOLS && self.varint()? <= TAGS;
        self.buffer.set_position(start).ok()?;
        if !are_few {
            return self.symbols();
        }
        let options = SymbolEncodingOptions::default();
        decode_symbols(to_usize(count), 1, &options, &mut self.buffer, &mut Vec::new()).ok()
    }

    /// Coded symbols.
    fn symbols(&mut self) -> Option<()> {
        let (is_raw, bits) = (self.byte()? == 1, self.byte()?);
        if !is_raw || !(1..=18).contains(&bits) {
            return None;
        }
        self.table()?;
        let length = self.varint()?;
        self.skip(length)
    }

    /// A table of probabilities: the number of its symbols, then one to three bytes for each, or one byte for up to 64 symbols
    /// of probability zero.
    fn table(&mut self) -> Option<()> {
        let count = self.varint()?;
        if count > self.buffer.remaining_size() as u64 * SYMBOLS_A_BYTE {
            return None;
        }
        self.symbols = self.symbols.max(count);
        let mut read = 0;
        while read < count {
            let byte = self.byte()?;
            match byte & 3 {
                3 => read += u64::from(byte >> 2) + 1,
                more => {
                    self.skip(u64::from(more))?;
                    read += 1;
                }
            }
        }
        (read == count).then_some(())
    }

    /// The attributes, in groups that are decoded together.
    fn attributes(&mut self, has_traversals: bool) -> Option<()> {
        let groups = self.byte()?;
        if has_traversals {
            // The number of the seams, the kind, and the traversal.
            self.skip(3 * u64::from(groups))?;
        }
        let groups = (0..groups).map(|_| self.header()).collect::<Option<Vec<_>>>()?;
        self.attributes = Some(groups.concat());
        for group in groups {
            for attribute in &group {
                self.reached();
                self.values(attribute)?;
            }
            for attribute in group {
                self.skip(match attribute.decoder {
                    // The least values, the range and the number of bits.
                    2 => 4 * (attribute.components + 1) + 1,
                    3 => 1,
                    _ => 0,
                })?;
            }
        }
        Some(())
    }

    /// Returns the attributes of a decoder. Each takes five bytes at least, so that the list isn't longer than the data.
    fn header(&mut self) -> Option<Vec<Coded>> {
        let count = self.varint()?;
        if count > self.buffer.remaining_size() as u64 / 5 {
            return None;
        }
        let mut coded = Vec::new();
        for _ in 0..count {
            // The meaning.
            self.byte()?;
            let size = DataType::try_from(self.byte()?).ok()?.byte_length() as u64;
            let components = u64::from(self.byte()?);
            // Whether it is normalised.
            self.byte()?;
            self.varint()?;
            coded.push(Coded { components, size, decoder: 0 });
        }
        for attribute in &mut coded {
            attribute.decoder = self.byte()?;
        }
        Some(coded)
    }

    /// The values of an attribute, with what their prediction needs.
    #[expect(clippy::cast_possible_truncation, reason = "the decoder keeps 32 bits of it")]
    fn values(&mut self, attribute: &Coded) -> Option<()> {
        if !(1..=3).contains(&attribute.decoder) {
            return None;
        }
        let method = self.byte()?;
        let is_predicted = method < 0xfe;
        if is_predicted {
            // The transform.
            self.byte()?;
        }
        if self.byte()? == 0 {
            return None;
        }
        self.symbols()?;
        match method {
            // Differences, and parallelograms.
            0 | 1 => self.skip(TRANSFORM),
            // Several parallelograms, of which flags say which are used.
            4 => {
                for _ in 0..PARALLELOGRAMS {
                    if self.varint()? as u32 > 0 {
                        self.bits()?;
                    }
                }
                self.skip(TRANSFORM)
            }
            // Texture coordinates by positions: the number of orientations, and these.
            5 => {
                self.skip(4)?;
                self.bits()?;
                self.skip(TRANSFORM)
            }
            // Normals of neighbouring triangles, and which are flipped.
            6 => {
                self.skip(TRANSFORM)?;
                self.bits()
            }
            _ if !is_predicted => Some(()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use draco_core::{
        DataType, EncoderBuffer, EncoderOptions, GeometryAttributeType as Kind, Mesh, MeshEncoder, PointAttribute,
    };

    use super::*;

    /// Returns how far a walk comes in bytes, or none if it doesn't come to the end; and the memory of the tables in bytes.
    fn walk(bytes: &[u8]) -> (Option<usize>, u64) {
        let header = Header::read(bytes).expect("a header");
        let mut walk = Walk::new(bytes, header.end);
        walk.buffer.set_position(header.end).expect("within the data");
        let reached = walk.mesh(&header).map(|()| walk.buffer.position());
        (reached, super::walk(bytes, &header).tables)
    }

    /// A wavy sheet of 2 * 60 * 60 triangles. With seams each row has texture coordinates of its own.
    fn sheet(method: i32, speed: i32, has_seams: bool) -> Vec<u8> {
        const SIDE: usize = 60;
        let next = SIDE + 1;
        let squares = (0..SIDE * SIDE).map(|i| i / SIDE * next + i % SIDE);
        let triangles: Vec<[usize; 3]> =
            squares.flat_map(|a| [[a, a + 1, a + next], [a + 1, a + next + 1, a + next]]).collect();
        let corners = triangles.as_flattened();
        let mut mesh = Mesh::new();
        mesh.set_num_points(corners.len());
        mesh.try_set_num_faces(triangles.len()).expect("memory");
        for i in 0..triangles.len() {
            mesh.set_face_from_indices(i, [0, 1, 2].map(|k| (3 * i + k) as u32));
        }
        let mut options = EncoderOptions::new();
        options.set_encoding_method(method);
        options.set_global_int("encoding_speed", speed);
        options.set_global_int("decoding_speed", speed);
        let mut add = |kind: Kind, width: u8, value: &dyn Fn(usize, usize) -> Vec<f32>| {
            let mut attribute = PointAttribute::new();
            attribute.init(kind, width, DataType::Float32, false, corners.len());
            let numbers = corners.iter().enumerate().flat_map(|(i, corner)| value(i, *corner));
            attribute.buffer_mut().write(0, &numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>());
            let id = mesh.add_attribute(attribute);
            options.set_attribute_quantization(id, 11);
        };
        let at = |corner: usize| [(corner % next) as f32, (corner / next) as f32];
        add(Kind::Position, 3, &|_, corner| vec![at(corner)[0], at(corner)[1], (at(corner)[0] * 0.3).sin()]);
        add(Kind::Normal, 3, &|_, corner| {
            let slope = (at(corner)[0] * 0.3).cos();
            vec![-slope / slope.hypot(1.0), 0.0, 1.0 / slope.hypot(1.0)]
        });
        add(Kind::TexCoord, 2, &|i, corner| {
            let row = if has_seams { (i / (6 * SIDE)) as f32 } else { 0.0 };
            vec![at(corner)[0] / 60.0, at(corner)[1] / 60.0 + row]
        });
        mesh.deduplicate_attribute_values().expect("attributes that can be compared");
        mesh.deduplicate_point_ids();
        let (mut encoder, mut bytes) = (MeshEncoder::new(), EncoderBuffer::new());
        encoder.set_mesh(mesh);
        encoder.encode(&options, &mut bytes).expect("a mesh that can be compressed");
        bytes.data().to_vec()
    }

    /// A walk that read something differently from the decoder wouldn't end where the data does.
    #[test]
    fn walks_end_where_the_data_ends() {
        let cube = include_bytes!("../tests/cube.drc");
        let mut streams = vec![("cube".to_owned(), cube.to_vec())];
        for (method, speed) in [(0, 5), (1, 0), (1, 1), (1, 3), (1, 5), (1, 7), (1, 10)] {
            for has_seams in [false, true] {
                let name = format!("method {method}, speed {speed}, seams {has_seams}");
                streams.push((name, sheet(method, speed, has_seams)));
            }
        }
        let mut whole = 0;
        for (name, bytes) in &streams {
            let (reached, memory) = walk(bytes);
            println!("{name}: {reached:?} of {} bytes, {} KiB of tables", bytes.len(), memory >> 10);
            let header = Header::read(bytes).expect("a header");
            assert!(super::walk(bytes, &header).attributes.is_some(), "{name}: its attributes aren't found");
            if let Some(reached) = reached {
                whole += 1;
                assert_eq!(reached, bytes.len(), "{name}");
            }
        }
        assert!(whole * 3 >= streams.len() * 2, "{whole} of {}", streams.len());
    }

    /// One triangle whose indices have a table that says that it has 2^20 symbols, of which few follow.
    #[test]
    fn a_table_counts_for_what_it_says() {
        let start = b"DRACO\x02\x02\x01\0\0\0\x01\x03\0\x01\x01";
        let claim = [0x80, 0x80, 0x40];
        let bytes = [&start[..], &claim, &[0; 20_000]].concat();
        assert!(walk(&bytes).1 >= (3 * 8) << 20);
        // More than 64 symbols a byte are refused by the decoder before it takes memory for them.
        let short = [&start[..], &claim, &[0; 2000]].concat();
        assert!(walk(&short).1 < 2 << 20);
    }
}
