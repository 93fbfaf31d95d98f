//! Decodes the two codecs of Basis Universal, ETC1S and UASTC. They are here because no crate for them is both fuzzed and kept: `basisu` has
//! one release, and `basis-universal` 0.3.1 builds the C++ encoder along with its decoder, both of version 1.16, where 2.1 is current.

#![expect(clippy::cast_possible_truncation, reason = "a code's bits are as many as the type has room for")]

mod bits;
mod etc1s;
mod prefix_code;
mod uastc;

use super::part;
use etc1s::Codebooks;

/// The size of a block of UASTC, in bytes.
pub(super) const UASTC_BLOCK: usize = uastc::BLOCK;

/// Decodes an image of this width and height in px to RGBA.
///
/// # Errors
/// A clause that says what is wrong.
pub(super) fn uastc(data: &[u8], size: [u32; 2]) -> Result<Vec<u8>, String> {
    let mut image = Image::new(size);
    let across = image.blocks()[0];
    for (index, block) in data.as_chunks().0.iter().enumerate() {
        let texels = uastc::texels(block).ok_or_else(|| format!("its UASTC block {index} has no mode"))?;
        image.put([index % across, index / across], |to, texel| to.copy_from_slice(&texels[texel]));
    }
    Ok(image.rgba)
}

/// Decodes an image of this width and height in px to RGBA: number `index` of a file's `images`, which share the global data, where
/// codebooks are and where each image is.
///
/// # Errors
/// A clause that says what is wrong.
pub(super) fn etc1s(
    data: &[u8],
    size: [u32; 2],
    global: &[u8],
    [index, images]: [usize; 2],
    has_alpha: bool,
) -> Result<Vec<u8>, String> {
    let wrong = || "its ETC1S data is broken".to_owned();
    let books = Codebooks::read(global, images).ok_or_else(wrong)?;
    let [color, alpha] = etc1s::slices(global, index).ok_or_else(wrong)?;
    let mut image = Image::new(size);
    let blocks = image.blocks();
    let color = part(data, color.map(u64::from), "its ETC1S colours")?;
    let put = |at, texels: [[u8; 3]; 16]| image.put(at, |to, texel| to[..3].copy_from_slice(&texels[texel]));
    books.decode(color, blocks, put).ok_or_else(wrong)?;
    if has_alpha {
        let alpha = part(data, alpha.map(u64::from), "its ETC1S alpha")?;
        let put = |at, texels: [[u8; 3]; 16]| image.put(at, |to, texel| to[3] = texels[texel][1]);
        books.decode(alpha, blocks, put).ok_or_else(wrong)?;
    }
    Ok(image.rgba)
}

/// An image that is put together from blocks of 4 x 4 px, of which those at the right and at the bottom may reach beyond it.
struct Image {
    size: [usize; 2],
    rgba: Vec<u8>,
}

impl Image {
    /// Makes an opaque black image.
    fn new(size: [u32; 2]) -> Self {
        let size = size.map(|side| side as usize);
        Self { size, rgba: [0, 0, 0, 255].repeat(size[0] * size[1]) }
    }

    fn blocks(&self) -> [usize; 2] {
        self.size.map(|side| side.div_ceil(4))
    }

    /// Calls `set` with each pixel of a block, and the index of its texel.
    fn put(&mut self, [x, y]: [usize; 2], set: impl Fn(&mut [u8], usize)) {
        let [width, height] = self.size;
        for row in 0..4.min(height - 4 * y) {
            let start = 4 * ((4 * y + row) * width + 4 * x);
            let columns = 4.min(width - 4 * x);
            for (column, px) in self.rgba[start..start + 4 * columns].chunks_exact_mut(4).enumerate() {
                set(px, 4 * row + column);
            }
        }
    }
}
