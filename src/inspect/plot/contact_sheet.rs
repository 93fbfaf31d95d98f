//! Contact sheets: pictures in rows, each with a caption above it.

use image::{Rgb, RgbImage, imageops};

use super::{ChartError, write_text};

/// The space between pictures and around them, in px.
const GAP: u32 = 4;

/// Puts pictures of one size in rows of `columns` on white, each with its caption above it. `text` is the height of captions
/// in px.
///
/// # Errors
/// The font of the captions can't be used.
pub fn contact_sheet(parts: &[(String, RgbImage)], columns: u32, text: u32) -> Result<RgbImage, ChartError> {
    let (width, height) = parts.first().map_or((0, 0), |(_, part)| part.dimensions());
    let room = text + text / 3;
    let (across, down) = (width + GAP, height + GAP + room);
    let rows = (parts.len() as u32).div_ceil(columns);
    let mut all = RgbImage::from_pixel(columns * across + GAP, rows * down + GAP, Rgb([255; 3]));
    for (index, (caption, part)) in (0..).zip(parts) {
        let (left, top) = (GAP + index % columns * across, GAP + index / columns * down);
        imageops::replace(&mut all, part, left.into(), (top + room).into());
        write_text(&mut all, [left as i32 + 2, top as i32 + 2], text, caption)?;
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_in_rows_under_their_captions() {
        let part = |shade: u8| RgbImage::from_pixel(40, 30, Rgb([shade; 3]));
        let parts = [("one", 10), ("two", 20), ("three", 30)].map(|(name, shade)| (name.to_owned(), part(shade)));
        let all = contact_sheet(&parts, 2, 18).expect("a font");
        assert_eq!(all.dimensions(), (2 * 44 + 4, 2 * 58 + 4));
        let at = |x, y| all.get_pixel(x, y).0[0];
        assert_eq!([at(20, 40), at(64, 40), at(20, 98), at(64, 98)], [10, 20, 30, 255]);
        assert!((4..40).any(|x| (4..28).any(|y| at(x, y) < 128)), "a caption");
    }
}
