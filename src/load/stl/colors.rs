//! The colours of a binary STL file. The format has none, but programs put them into the 16 bits after each triangle, in two ways:
//!
//! - VisCAM and SolidView: bit 15 says that the triangle has a colour: 5 bits each of red (from bit 10), green (from bit 5) and blue.
//! - Materialise Magics: `COLOR=` in the header is followed by the red, green, blue and alpha byte of the whole part, and
//!   `,MATERIAL=` after that by its diffuse colour in four bytes, which comes first. Bit 15 of a triangle is clear if it has a colour
//!   of its own: 5 bits each of blue (from bit 10), green (from bit 5) and red.
//!
//! Sources: A. van der Geest's extension as the mailing list rp-ml has it (13 June 2003, "Colour STL file format"), and The Hong Kong
//! Polytechnic University, "STL colour binary format", for both.

use glam::Vec4;

use crate::face_builder::linear_color;

/// The colours of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Colors {
    /// The colour of triangles without one as Magics writes it: bytes of red, green and blue, encoded as sRGB. None in the way of VisCAM,
    /// where they are white.
    part: Option<[u8; 3]>,
    /// Whether any triangle has a colour of its own.
    pub are_many: bool,
}

impl Colors {
    /// Finds out how a file has colours, from its header and the bits after each triangle. Returns none if it has none.
    ///
    /// Where a part has a colour and the bits of all triangles are 0, those were never written, and aren't black.
    pub(super) fn new(header: &[u8], mut attributes: impl Iterator<Item = u16> + Clone) -> Option<Self> {
        let (part, is_set) = (part_color(header), |bits: u16| bits & FACET_COLOR_BIT != 0);
        let are_many = match part {
            Some(_) => !attributes.clone().all(is_set) && attributes.any(|bits| bits != 0),
            None => attributes.any(is_set),
        };
        (part.is_some() || are_many).then_some(Self { part, are_many })
    }

    /// The colour of all triangles: linear RGBA. Where triangles have colours of their own, it is white.
    pub(super) fn of_all(&self) -> [f32; 4] {
        match self.part {
            Some([r, g, b]) if !self.are_many => linear_color([r, g, b, 255]).to_array(),
            _ => [1.0; 4],
        }
    }

    /// The colour of a triangle with these bits: linear RGBA.
    pub(super) fn of_triangle(&self, bits: u16) -> Vec4 {
        let is_set = bits & FACET_COLOR_BIT != 0;
        let [low, middle, high] = [0, 5, 10].map(|shift| widened(bits >> shift));
        let [r, g, b] = match (self.part, is_set) {
            (None, true) => [high, middle, low],
            (None, false) => [255; 3],
            (Some(part), true) => part,
            (Some(_), false) => [low, middle, high],
        };
        linear_color([r, g, b, 255])
    }
}

/// The bit that says whether the other 15 are the triangle's colour.
const FACET_COLOR_BIT: u16 = 1 << 15;

/// Widens the lowest 5 bits to a byte.
#[expect(clippy::cast_possible_truncation, reason = "at most 255")]
fn widened(bits: u16) -> u8 {
    ((u32::from(bits & 31) * 255 + 15) / 31) as u8
}

/// The colour of the whole part in the header, if Magics wrote one.
fn part_color(header: &[u8]) -> Option<[u8; 3]> {
    let after = |name: &[u8]| {
        let start = memchr::memmem::find(header, name)? + name.len();
        // Alpha is there, but parts are opaque.
        header.get(start..start + 4).and_then(|color| color.first_chunk::<3>()).copied()
    };
    let color = after(b"COLOR=")?;
    Some(after(b",MATERIAL=").unwrap_or(color))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_dialects_have_the_order_of_their_bits() {
        let plain =
            Colors::new(b"made by a test", [0x8000 | 31 << 10, 0, 0x7fff].into_iter()).expect("one has a colour");
        assert_eq!(plain.of_triangle(0x8000 | 31 << 10), Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(plain.of_triangle(0x8000 | 31), Vec4::new(0.0, 0.0, 1.0, 1.0));
        assert_eq!(plain.of_triangle(31), Vec4::ONE, "it has none");
        let header = b"x COLOR=\xff\x00\x00\xff";
        let magics = Colors::new(header, [31 << 10, 0x8000].into_iter()).expect("the part has a colour");
        assert_eq!(magics.of_triangle(31 << 10), Vec4::new(0.0, 0.0, 1.0, 1.0));
        assert_eq!(magics.of_triangle(0xffff), Vec4::new(1.0, 0.0, 0.0, 1.0), "that of the part");
        assert_eq!((magics.are_many, magics.of_all()), (true, [1.0; 4]));
    }

    #[test]
    fn a_part_of_one_colour_has_no_colours_of_triangles() {
        let header = b"COLOR=\xff\xff\xff\xff,MATERIAL=\x00\xff\x00\xff\x01\x02\x03\xff\x01\x02\x03\xff";
        for attributes in [[0, 0], [0x8000, 0xffff]] {
            let colors = Colors::new(header, attributes.into_iter()).expect("the part has a colour");
            assert_eq!((colors.are_many, colors.of_all()), (false, [0.0, 1.0, 0.0, 1.0]), "the material comes first");
        }
        assert_eq!(Colors::new(b"COLOR=\xff\xff", [7].into_iter()), None, "the header ends within it");
        assert_eq!(Colors::new(b"", [7, 0x7fff].into_iter()), None);
    }

    #[test]
    fn five_bits_reach_from_black_to_white_in_equal_steps() {
        for bits in 0..32_u16 {
            assert_eq!(widened(bits), (f64::from(bits) * 255.0 / 31.0).round() as u8);
            assert_eq!(u16::from(widened(bits)) >> 3, bits, "its highest bits are the same");
        }
    }
}
