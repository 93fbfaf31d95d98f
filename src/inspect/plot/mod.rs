//! What all charts share: their font, colours and sizes. Charts are drawn at twice their size and then halved, which smooths
//! the edges that the plotting library leaves jagged.

mod contact_sheet;

use std::fmt::Display;

use image::imageops::{self, FilterType};
use image::{ImageBuffer, RgbImage};
use plotters::backend::BitMapBackend;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use thiserror::Error;

pub use contact_sheet::contact_sheet;

#[derive(Clone, Debug, Error, PartialEq)]
#[error("the chart could not be drawn: {0}")]
pub struct ChartError(String);

impl ChartError {
    pub fn failed(reason: &dyn Display) -> Self {
        Self(reason.to_string())
    }
}

/// Charts are drawn this many times as wide and as high, and then made smaller.
pub const DENSITY: u32 = 2;
/// The font's name in the plotting library. SVG files hold only this name, so a viewer shows them in its own sans-serif font.
pub const FONT: &str = "sans-serif";
/// The colour of text and axes.
pub const INK: RGBColor = RGBColor(40, 40, 40);

/// Colours that people with any colour vision can tell apart (Okabe and Ito 2008).
pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const BLUISH_GREEN: RGBColor = RGBColor(0, 158, 115);
pub const REDDISH_PURPLE: RGBColor = RGBColor(204, 121, 167);
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const SKY_BLUE: RGBColor = RGBColor(86, 180, 233);

/// Returns a picture of this width and height in px. `draw` draws it at [`DENSITY`] times that size.
///
/// # Errors
/// `draw` fails, or the font can't be used.
pub fn bitmap<E: Display>(
    [width, height]: [u32; 2],
    draw: impl FnOnce(&DrawingArea<BitMapBackend, Shift>) -> Result<(), E>,
) -> Result<RgbImage, ChartError> {
    use_font()?;
    let size = (width * DENSITY, height * DENSITY);
    let mut drawn: RgbImage = ImageBuffer::new(size.0, size.1);
    {
        let picture = BitMapBackend::with_buffer(&mut drawn, size).into_drawing_area();
        draw(&picture).map_err(|error| ChartError::failed(&error))?;
        picture.present().map_err(|error| ChartError::failed(&error))?;
    }
    Ok(imageops::resize(&drawn, width, height, FilterType::Triangle))
}

/// Registers the font with the plotting library.
///
/// # Errors
/// The font can't be used.
pub fn use_font() -> Result<(), ChartError> {
    register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .map_err(|_| ChartError::failed(&"its font can't be used"))
}

/// Writes a line of text into a picture, in the colour [`INK`] and `size` px high, with its top left corner at `at` (px).
///
/// # Errors
/// The font can't be used.
pub fn write_text(picture: &mut RgbImage, at: [i32; 2], size: u32, text: &str) -> Result<(), ChartError> {
    use_font()?;
    let dimensions = picture.dimensions();
    let area = BitMapBackend::with_buffer(picture, dimensions).into_drawing_area();
    area.draw_text(text, &font(size as i32), (at[0], at[1])).map_err(|error| ChartError::failed(&error))?;
    area.present().map_err(|error| ChartError::failed(&error))
}

/// The text style for letters of this height, in drawn px.
pub fn font(size: i32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&INK)
}
