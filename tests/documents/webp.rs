//! Lossless WebP images with many prefix codes (RFC 9649).

/// Writes numbers, the lowest bit first, and codes, the highest bit first.
#[derive(Default)]
pub struct BitWriter {
    bytes: Vec<u8>,
    count: usize,
}

impl BitWriter {
    pub fn number(&mut self, width: usize, number: u32) {
        (0..width).for_each(|bit| self.bit(number >> bit & 1));
    }

    pub fn code(&mut self, width: usize, code: u32) {
        (0..width).rev().for_each(|bit| self.bit(code >> bit & 1));
    }

    fn bit(&mut self, bit: u32) {
        if self.count.is_multiple_of(8) {
            self.bytes.push(0);
        }
        self.bytes[self.count / 8] |= (bit as u8) << (self.count % 8);
        self.count += 1;
    }

    /// A prefix code of one symbol.
    pub fn single(&mut self, symbol: u32) {
        // Short, one symbol, which has 8 bits.
        self.number(3, 0b101);
        self.number(8, symbol);
    }

    /// The file of an image of this width and height in px. What was written is what comes behind its header.
    pub fn file(self, [width, height]: [u32; 2]) -> Vec<u8> {
        let sizes = (width - 1) | (height - 1) << 14;
        let data = [&[0x2f], &sizes.to_le_bytes()[..], &self.bytes].concat();
        let size = data.len() as u32;
        let padded = data.len() as u32 + 12 + size % 2;
        let pad = vec![0; size as usize % 2];
        [&b"RIFF"[..], &padded.to_le_bytes(), b"WEBPVP8L", &size.to_le_bytes(), &data, &pad].concat()
    }
}

/// An image of 4 x 4 px with so many groups of prefix codes, up to 65,536. Each of a group's five codes has a table of 4 KiB, and takes
/// 12 bytes of the file.
pub fn of_groups(groups: u32) -> Vec<u8> {
    let mut bits = BitWriter::default();
    // No transform, no cache of colours, and a px with the number of its group for each block of 4 x 4.
    bits.number(3, 0b100);
    bits.number(3, 0);
    // The image of these numbers, which has no cache, is one px.
    bits.number(1, 0);
    let last = groups - 1;
    [last & 0xff, last >> 8, 0, 0, 0].into_iter().for_each(|symbol| bits.single(symbol));
    (0..5 * groups).for_each(|_| large_code(&mut bits));
    // Zeros are the first symbol of each code.
    (0..16).for_each(|_| bits.number(32, 0));
    bits.file([4, 4])
}

/// Writes a code of the symbols 0 to 10 whose lengths are 1 to 10 and 10 bits.
fn large_code(bits: &mut BitWriter) {
    // It isn't short. 14 lengths follow for the codes of lengths: of 17, 18, 0 to 5, 16, and 6 to 10.
    bits.number(1, 0);
    bits.number(4, 10);
    [0, 0, 0, 3, 3, 3, 3, 3, 0, 3, 4, 4, 4, 4].into_iter().for_each(|length| bits.number(3, length));
    // 11 lengths are written: the number has 4 bits, and is 2 less.
    bits.number(1, 1);
    bits.number(3, 1);
    bits.number(4, 9);
    for length in (1..=10).chain([10]) {
        match length {
            1..=6 => bits.code(3, length - 1),
            _ => bits.code(4, 12 + length - 7),
        }
    }
}
