//! Decodes UASTC, one of the two codecs of Basis Universal: blocks of 4 x 4 px in 128 bits, which use a part of ASTC with
//! another packing.
//!
//! Sources: KTX 2.0 specification, appendix "UASTC texture encoding"; Khronos Data Format Specification 1.3, chapter 23 (ASTC):
//! section 23.13 for endpoints, 23.15 for weights, 23.21 for partitions, which are tables here.

use super::bits::Bits;

/// The number of bytes of a block.
pub(super) const BLOCK: usize = 16;

/// How a block is stored. A block begins with the code of its mode.
struct Mode(
    /// The code and its length in bits.
    (u8, u32),
    /// Bits for other transcoders, which are passed over.
    u32,
    /// Bits of a weight.
    u32,
    Endpoints,
    /// The number of components: 2 (luminance and alpha), 3 (RGB) or 4 (RGBA).
    usize,
    Partition,
    Plane,
);

/// The codes that endpoints have: some bits, and above them a trit or a quint; the number of what may be there.
#[derive(Clone, Copy)]
struct Endpoints(u32, u32);

const NEITHER: u32 = 1;
const TRIT: u32 = 3;
const QUINT: u32 = 5;

/// How texels are divided into subsets, which have endpoints of their own: bits of an index, how many subsets there are, and by index the
/// subsets of the texels: one bit each for two, two bits for three, those of the first texel lowest.
type Partition = (u32, usize, &'static [u32]);

/// Which component has weights of its own.
#[derive(Clone, Copy)]
enum Plane {
    None,
    /// The block says which.
    Told,
    Alpha,
}

/// The mode of blocks of one colour.
const SOLID: usize = 8;

const ONE: Partition = (0, 1, &[0]);
const TWO: Partition = (5, 2, &TWO_SUBSETS);
const OTHER_TWO: Partition = (5, 2, &OTHER_TWO_SUBSETS);
const THREE: Partition = (4, 3, &THREE_SUBSETS);

#[rustfmt::skip]
static MODES: [Mode; 19] = [
    Mode((0x01, 4), 15, 4, Endpoints(6, TRIT), 3, ONE, Plane::None),
    Mode((0x35, 6), 15, 2, Endpoints(8, NEITHER), 3, ONE, Plane::None),
    Mode((0x1d, 5), 15, 3, Endpoints(4, NEITHER), 3, TWO, Plane::None),
    Mode((0x03, 5), 15, 2, Endpoints(2, TRIT), 3, THREE, Plane::None),
    Mode((0x13, 5), 15, 2, Endpoints(3, QUINT), 3, TWO, Plane::None),
    Mode((0x0b, 5), 15, 3, Endpoints(8, NEITHER), 3, ONE, Plane::None),
    Mode((0x1b, 5), 15, 2, Endpoints(5, QUINT), 3, ONE, Plane::Told),
    Mode((0x07, 5), 15, 2, Endpoints(3, QUINT), 3, OTHER_TWO, Plane::None),
    Mode((0x17, 5), 0, 0, Endpoints(8, NEITHER), 4, ONE, Plane::None),
    Mode((0x0f, 5), 23, 2, Endpoints(4, NEITHER), 4, TWO, Plane::None),
    Mode((0x02, 3), 17, 4, Endpoints(4, TRIT), 4, ONE, Plane::None),
    Mode((0x00, 2), 17, 2, Endpoints(4, TRIT), 4, ONE, Plane::Told),
    Mode((0x06, 3), 17, 3, Endpoints(6, TRIT), 4, ONE, Plane::None),
    Mode((0x1f, 5), 23, 1, Endpoints(8, NEITHER), 4, ONE, Plane::Told),
    Mode((0x0d, 5), 23, 2, Endpoints(8, NEITHER), 4, ONE, Plane::None),
    Mode((0x05, 7), 23, 4, Endpoints(8, NEITHER), 2, ONE, Plane::None),
    Mode((0x15, 6), 23, 2, Endpoints(8, NEITHER), 2, TWO, Plane::None),
    Mode((0x25, 6), 23, 2, Endpoints(8, NEITHER), 2, ONE, Plane::Alpha),
    Mode((0x09, 4), 15, 5, Endpoints(5, NEITHER), 3, ONE, Plane::None),
];

/// Partitions that ASTC and BC7 have in common.
static TWO_SUBSETS: [u32; 30] = [
    0xcccc, 0x8888, 0x1111, 0xecc8, 0x377f, 0xfeec, 0x0137, 0x137f, 0xc800, 0x0013, 0xfe80, 0x17ff, 0x0017, 0x00ff,
    0xfff0, 0x0fff, 0xff71, 0x8eff, 0x08ce, 0x008c, 0x7310, 0xceff, 0x7331, 0x088c, 0xceef, 0x6666, 0xf00f, 0x5555,
    0x0f0f, 0x36c9,
];
static THREE_SUBSETS: [u32; 11] = [
    0xa5a5_0000,
    0xaa00_5555,
    0xaa00_0055,
    0x0000_aa55,
    0x2525_2525,
    0x9494_9494,
    0x5858_5858,
    0x5656_0202,
    0x9292_9292,
    0x55aa_0055,
    0xa050_50a0,
];
/// Partitions into two, which BC7 has only as partitions into three.
static OTHER_TWO_SUBSETS: [u32; 19] = [
    0x00f0, 0x4444, 0x0133, 0xcc80, 0xf0ff, 0x2222, 0xffc8, 0xccce, 0x3c03, 0x00ee, 0x7700, 0x3003, 0x00ce, 0xff80,
    0x6fff, 0x1333, 0x11ff, 0x136c, 0x00ef,
];

/// Returns the texels of a block as RGBA, row by row; none if it is no block of UASTC.
pub(super) fn texels(block: &[u8; BLOCK]) -> Option<[[u8; 4]; 16]> {
    let mut bits = Bits::new(block);
    let is_code = |Mode((code, length), ..): &Mode| u32::from(block[0]) & ((1_u32 << length) - 1) == u32::from(*code);
    let index = MODES.iter().position(is_code)?;
    let Mode((_, length), hints, weight_bits, endpoints, components, partition, plane) = MODES[index];
    bits.take(length);
    if index == SOLID {
        return Some([[0; 4].map(|_: u8| bits.take(8) as u8); 16]);
    }
    bits.take(hints);
    let (width, count, subsets) = partition;
    let subsets = *subsets.get(bits.take(width) as usize)?;
    let second = match plane {
        Plane::None => None,
        Plane::Told => Some(bits.take(2) as usize),
        Plane::Alpha => Some(3),
    };
    let ends = ends(&mut bits, endpoints, components, count);
    let mut texels = [[0; 4]; 16];
    let mut seen = [false; 3];
    for (i, texel) in texels.iter_mut().enumerate() {
        let subset = (subsets >> (i * (count - 1))) as usize & ((1 << (count - 1)) - 1);
        // The highest bit of the first weight of a subset is 0, and isn't stored.
        let is_first = !std::mem::replace(&mut seen[subset], true);
        let mut weight = || unquantized(bits.take(weight_bits - u32::from(is_first)), weight_bits);
        let all = weight();
        let own = second.map(|component| (component, weight()));
        for (component, value) in texel.iter_mut().enumerate() {
            let weight = own.filter(|own| own.0 == component).map_or(all, |own| own.1);
            let [low, high] = ends[subset][component].map(|end| end * 257);
            *value = ((low * (64 - weight) + high * weight + 32) >> 14) as u8;
        }
    }
    Some(texels)
}

/// Returns a weight of up to 5 bits as a number from 0 to 64.
fn unquantized(weight: u32, bits: u32) -> u32 {
    let six = match bits {
        1 => weight * 63,
        2 => weight * 21,
        3 => weight * 9,
        4 => weight << 2 | weight >> 2,
        _ => weight << 1 | weight >> 4,
    };
    six + u32::from(six > 32)
}

/// Reads the ends of the lines of colours: for each subset and component the low and the high one, 0 to 255.
fn ends(bits: &mut Bits, endpoints: Endpoints, components: usize, subsets: usize) -> [[[u32; 2]; 4]; 3] {
    let count = 2 * components * subsets;
    let mut values = [0; 18];
    endpoints.read(bits, &mut values[..count]);
    let mut ends = [[[0, 0], [0, 0], [0, 0], [255, 255]]; 3];
    for (own, values) in ends.iter_mut().zip(values[..count].chunks_exact(2 * components)) {
        let pairs = values.as_chunks::<2>().0;
        match *pairs {
            [luminance, alpha] => *own = [luminance, luminance, luminance, alpha],
            _ => own[..pairs.len()].copy_from_slice(pairs),
        }
    }
    ends
}

impl Endpoints {
    /// Reads endpoints, from 0 to 255. All groups of trits or quints stand before the bits.
    fn read(self, bits: &mut Bits, values: &mut [u32]) {
        let Self(width, base) = self;
        // How many values are in a group, and how many bits a group of so many values has.
        let sizes: &[u32] = match base {
            TRIT => &[0, 2, 4, 5, 7, 8],
            QUINT => &[0, 3, 5, 7],
            _ => &[],
        };
        let mut above = [0; 18];
        for group in above[..values.len()].chunks_mut(sizes.len().max(2) - 1) {
            let mut packed = if sizes.is_empty() { 0 } else { bits.take(sizes[group.len()]) };
            for value in group {
                (*value, packed) = (packed % base, packed / base);
            }
        }
        for (value, above) in values.iter_mut().zip(above) {
            *value = self.unquantized(bits.take(width), above);
        }
    }

    /// Returns the number from 0 to 255 of some bits and the trit or quint above. The factors and the places of bits are those of
    /// the tables in section 23.13.
    fn unquantized(self, bits: u32, above: u32) -> u32 {
        let x = bits >> 1;
        let (factor, places) = match self {
            Self(8, NEITHER) => return bits,
            Self(5, NEITHER) => return bits << 3 | bits >> 2,
            Self(_, NEITHER) => return bits * 17,
            Self(2, TRIT) => (93, x * 0b1_0001_0110),
            Self(4, TRIT) => (22, x << 6 | x),
            Self(_, TRIT) => (5, x << 4 | x >> 4),
            Self(3, _) => (26, x << 7 | x << 1 | x >> 1),
            Self(..) => (6, x << 5 | x >> 3),
        };
        let lowest = if bits & 1 != 0 { 511 } else { 0 };
        (lowest & 128) | ((above * factor + places) ^ lowest) >> 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_uastc_mean_what_the_specification_says() {
        // The mode of one colour.
        let mut solid = [0; 16];
        solid[..5].copy_from_slice(&(0x17_u64 | 0x4433_2211 << 5).to_le_bytes()[..5]);
        assert_eq!(texels(&solid), Some([[0x11, 0x22, 0x33, 0x44]; 16]));
        // Mode 1: after 6 and 15 bits six endpoints of 8 bits, then weights of 2 bits, the first one without its highest.
        let mut bits = 0x35_u128;
        for (i, end) in [0_u128, 255, 10, 10, 255, 0].into_iter().enumerate() {
            bits |= end << (21 + 8 * i);
        }
        bits |= 0b111_0011 << 69;
        let texels = super::texels(&bits.to_le_bytes()).expect("a mode");
        assert_eq!(texels[..4], [[84, 10, 171, 255], [84, 10, 171, 255], [171, 10, 84, 255], [255, 10, 0, 255]]);
        assert_eq!(texels[4..], [[0, 10, 255, 255]; 12]);
        // The code that no mode has.
        assert_eq!(super::texels(&[0x45; 16]), None);
    }
}
