//! Decodes ETC1S, one of the two codecs of Basis Universal: blocks of 4 x 4 px, each a base colour and a pattern of four shades,
//! which are entries of two lists. BasisLZ compresses the lists and the blocks' indices.
//!
//! Source: KTX 2.0 specification, appendices "BasisLZ" and "ETC1S".

use super::bits::Bits;
use super::prefix_code::{PrefixCode, read_code};

/// What is added to the base colour for each of the four shades, by intensity.
const SHADES: [[i32; 4]; 8] = [
    [-8, -2, 2, 8],
    [-17, -5, 5, 17],
    [-29, -9, 9, 29],
    [-42, -13, 13, 42],
    [-60, -18, 18, 60],
    [-80, -24, 24, 80],
    [-106, -33, 33, 106],
    [-183, -47, 47, 183],
];
/// The symbol that says that the last symbol of predictions is repeated.
const REPEAT: u32 = 256;
/// The length of the list of bytes that precedes the images, and of each image's entry.
pub(super) const HEADER: usize = 20;

/// The lists that all images of a file share.
pub(super) struct Codebooks {
    endpoints: Vec<Endpoint>,
    selectors: Vec<Selector>,
    predictions: PrefixCode,
    endpoint_steps: PrefixCode,
    selector_codes: PrefixCode,
    run_lengths: PrefixCode,
    /// How many selectors the history holds.
    history: usize,
}

/// A base colour of 5 bits a component, and an index of shades.
#[derive(Clone, Copy)]
struct Endpoint {
    color: [u8; 3],
    intensity: u8,
}

/// The shades of a block: a byte a row, 2 bits a texel, the lowest for the texel on the left.
type Selector = [u8; 4];

/// Reads where the colours and the alpha of image `index` are by the global data, as start and length in its level; none if that isn't there.
pub(super) fn slices(global: &[u8], index: usize) -> Option<[[u32; 2]; 2]> {
    let entry = global.get(HEADER * (index + 1)..)?.first_chunk::<HEADER>()?;
    let [_, a, b, c, d] = std::array::from_fn(|i| u32::from_le_bytes(std::array::from_fn(|k| entry[4 * i + k])));
    Some([[a, b], [c, d]])
}

impl Codebooks {
    /// Reads the lists from the global data of a file with so many images; none if they are wrong.
    pub(super) fn read(global: &[u8], images: usize) -> Option<Self> {
        let header = global.first_chunk::<HEADER>()?;
        let short = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
        let long = |at: usize| u32::from_le_bytes(std::array::from_fn(|k| header[at + k])) as usize;
        let rest = global.get(HEADER.checked_mul(images + 1)?..)?;
        let (endpoints, rest) = rest.split_at_checked(long(4))?;
        let (selectors, rest) = rest.split_at_checked(long(8))?;
        let mut tables = Bits::new(rest.get(..long(12))?);
        let codebooks = Self {
            endpoints: read_endpoints(&mut Bits::new(endpoints), short(0))?,
            selectors: read_selectors(&mut Bits::new(selectors), short(2))?,
            predictions: read_code(&mut tables)?,
            endpoint_steps: read_code(&mut tables)?,
            selector_codes: read_code(&mut tables)?,
            run_lengths: read_code(&mut tables)?,
            history: tables.take(13) as usize,
        };
        (!tables.is_past_end() && codebooks.history > 0).then_some(codebooks)
    }

    /// Reads a slice of an image of `blocks` blocks across and down, and gives `put` each block's place and texels as RGB, row by
    /// row. Returns none if the data is wrong.
    pub(super) fn decode(
        &self,
        slice: &[u8],
        blocks: [usize; 2],
        mut put: impl FnMut([usize; 2], [[u8; 3]; 16]),
    ) -> Option<()> {
        let mut reader = SliceReader::new(self, slice, blocks);
        for y in 0..blocks[1] {
            for x in 0..blocks[0] {
                let endpoint = self.endpoints.get(reader.endpoint(x, y)?)?;
                let selector = self.selectors.get(reader.selector()?)?;
                put([x, y], endpoint.texels(selector));
            }
            if reader.bits.is_past_end() {
                return None;
            }
        }
        Some(())
    }
}

/// Each component is stored as a step from that of the entry before.
fn read_endpoints(bits: &mut Bits, count: usize) -> Option<Vec<Endpoint>> {
    let [low, middle, high] = [read_code(bits)?, read_code(bits)?, read_code(bits)?];
    let intensities = read_code(bits)?;
    let is_gray = bits.take(1) == 1;
    let mut last = Endpoint { color: [16; 3], intensity: 0 };
    let mut endpoints = Vec::with_capacity(count);
    for _ in 0..count {
        last.intensity = (u32::from(last.intensity) + intensities.symbol(bits)?) as u8 & 7;
        for component in &mut last.color[..if is_gray { 1 } else { 3 }] {
            let steps = match *component {
                0..10 => &low,
                10..22 => &middle,
                _ => &high,
            };
            *component = (u32::from(*component) + steps.symbol(bits)?) as u8 & 31;
        }
        if is_gray {
            last.color = [last.color[0]; 3];
        }
        endpoints.push(last);
    }
    (!bits.is_past_end()).then_some(endpoints)
}

fn read_selectors(bits: &mut Bits, count: usize) -> Option<Vec<Selector>> {
    let [is_global, is_hybrid, is_raw] = [(); 3].map(|()| bits.take(1) == 1);
    if is_global || is_hybrid {
        return None;
    }
    let changes = if is_raw { PrefixCode::default() } else { read_code(bits)? };
    let mut selectors: Vec<Selector> = Vec::with_capacity(count);
    for _ in 0..count {
        let mut selector = [0; 4];
        for (row, byte) in selector.iter_mut().enumerate() {
            *byte = match selectors.last().filter(|_| !is_raw) {
                Some(last) => last[row] ^ changes.symbol(bits)? as u8,
                None => bits.take(8) as u8,
            };
        }
        selectors.push(selector);
    }
    (!bits.is_past_end()).then_some(selectors)
}

impl Endpoint {
    fn texels(self, selector: &Selector) -> [[u8; 3]; 16] {
        let base = self.color.map(|component| i32::from(component << 3 | component >> 2));
        let shades = SHADES[usize::from(self.intensity)].map(|more| base.map(|own| (own + more).clamp(0, 255) as u8));
        std::array::from_fn(|texel| shades[usize::from(selector[texel / 4] >> (texel % 4 * 2) & 3)])
    }
}

/// Reads the indices of blocks, row by row.
struct SliceReader<'a> {
    books: &'a Codebooks,
    bits: Bits<'a>,
    /// For each pair of columns, the predictions of the two blocks in the odd row below.
    below: Vec<u8>,
    /// The predictions of the block that comes next, 2 bits each, the lowest first.
    predictions: u32,
    last_symbol: u32,
    repeats: u32,
    /// The endpoints of the last block in each column, and of the one above and to the left of the next block.
    endpoints: Vec<usize>,
    above_left: usize,
    last_endpoint: usize,
    /// The selectors that were used lately, those that are used often near the front, and the place of the next one.
    history: Vec<usize>,
    next: usize,
    /// For how many blocks the first selector of the history is used.
    run: u32,
}

impl<'a> SliceReader<'a> {
    fn new(books: &'a Codebooks, slice: &'a [u8], [across, _]: [usize; 2]) -> Self {
        Self {
            books,
            bits: Bits::new(slice),
            below: vec![0; across.div_ceil(2)],
            predictions: 0,
            last_symbol: 0,
            repeats: 0,
            endpoints: vec![0; across],
            above_left: 0,
            last_endpoint: 0,
            history: vec![0; books.history],
            next: books.history / 2,
            run: 0,
        }
    }

    /// Reads the predictions of four blocks, of which this is the one at the top left.
    fn prediction(&mut self) -> Option<u32> {
        if self.repeats > 0 {
            self.repeats -= 1;
            return Some(self.last_symbol);
        }
        let symbol = self.books.predictions.symbol(&mut self.bits)?;
        if symbol == REPEAT {
            self.repeats = self.number(4).saturating_add(2);
        } else {
            self.last_symbol = symbol;
        }
        Some(self.last_symbol)
    }

    /// Reads a number in groups of `width` bits, each followed by a bit that says whether there are more.
    fn number(&mut self, width: u32) -> u32 {
        let (mut number, mut shift) = (0, 0);
        loop {
            let group = self.bits.take(width + 1);
            number |= (group & ((1 << width) - 1)) << shift;
            shift += width;
            if group >> width == 0 || shift >= 32 {
                return number;
            }
        }
    }

    fn endpoint(&mut self, x: usize, y: usize) -> Option<usize> {
        if x.is_multiple_of(2) {
            self.predictions = if y.is_multiple_of(2) {
                let all = self.prediction()?;
                self.below[x / 2] = (all >> 4) as u8;
                all
            } else {
                self.below[x / 2].into()
            };
        }
        let prediction = self.predictions & 3;
        self.predictions >>= 2;
        let above = self.endpoints[x];
        let endpoint = match prediction {
            0 if x > 0 => self.last_endpoint,
            1 if y > 0 => above,
            2 if x > 0 && y > 0 => self.above_left,
            3 => {
                let count = self.books.endpoints.len();
                let endpoint = self.last_endpoint + self.books.endpoint_steps.symbol(&mut self.bits)? as usize;
                if endpoint < count { endpoint } else { endpoint - count }
            }
            _ => return None,
        };
        (self.endpoints[x], self.above_left, self.last_endpoint) = (endpoint, above, endpoint);
        Some(endpoint)
    }

    fn selector(&mut self) -> Option<usize> {
        if self.run > 0 {
            self.run -= 1;
            return Some(self.history[0]);
        }
        let symbol = self.books.selector_codes.symbol(&mut self.bits)? as usize;
        let Some(place) = symbol.checked_sub(self.books.selectors.len()) else {
            // Replaces a selector of the second half.
            let count = self.history.len();
            self.history[self.next] = symbol;
            self.next = if self.next + 1 < count { self.next + 1 } else { count / 2 };
            return Some(symbol);
        };
        if place == self.history.len() {
            let length = self.books.run_lengths.symbol(&mut self.bits)?;
            let length = if length == 63 { self.number(7) } else { length };
            // A run has three blocks more; this is the first.
            self.run = length.saturating_add(2);
            return Some(self.history[0]);
        }
        let selector = *self.history.get(place)?;
        // It moves half way to the front.
        self.history.swap(place, place / 2);
        Some(selector)
    }
}
