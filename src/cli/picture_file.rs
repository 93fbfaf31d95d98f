//! PNG files, and the texts in them that say what was drawn.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbaImage};

use super::{CliError, file_error};
use crate::files::{file_reason, write_whole};
use crate::settings::{Settings, Value, options};

/// What the texts in a PNG file say.
pub(crate) struct Stamp<'a> {
    /// The command that draws the picture.
    pub command: &'a str,
    pub settings: &'a Settings,
}

/// Keywords of the texts. The first is one of the PNG specification's own.
const SOFTWARE: &str = "Software";
const COMMAND: &str = "pnaen command";
const SETTINGS: &str = "pnaen settings";

/// Writes a PNG file, whatever its name ends in.
pub(crate) fn write_picture(path: &Path, picture: &DynamicImage) -> Result<(), CliError> {
    write(path, &png_bytes(picture).map_err(|error| file_error(path, "encoded", &error))?)
}

/// A picture as a PNG file.
pub(super) fn png_bytes(picture: &DynamicImage) -> image::ImageResult<Vec<u8>> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder)?;
    Ok(bytes)
}

/// Writes a PNG file with texts that say how to draw it again.
pub(crate) fn write_stamped(path: &Path, picture: &RgbaImage, stamp: &Stamp) -> Result<(), CliError> {
    let bytes = stamped(picture, stamp).map_err(|error| file_error(path, "encoded", &error))?;
    write(path, &bytes)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    write_whole(path, bytes).map_err(|error| file_error(path, "written", &file_reason(&error)))
}

/// A PNG file with texts; [`image`] writes none.
fn stamped(picture: &RgbaImage, stamp: &Stamp) -> Result<Vec<u8>, png::EncodingError> {
    let (width, height) = picture.dimensions();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::Adaptive);
    let settings = settings_text(stamp.settings);
    for (keyword, text) in
        [(SOFTWARE, concat!("pnaen ", env!("CARGO_PKG_VERSION"))), (COMMAND, stamp.command), (SETTINGS, &settings)]
    {
        let (keyword, text) = (keyword.to_owned(), text.to_owned());
        match is_latin_1(&text) {
            true => encoder.add_text_chunk(keyword, text)?,
            false => encoder.add_itxt_chunk(keyword, text)?,
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.as_raw())?;
    writer.finish()?;
    Ok(bytes)
}

/// Whether a text can be in a tEXt chunk: printable characters of Latin-1, and line ends.
fn is_latin_1(text: &str) -> bool {
    text.chars().all(|c| matches!(c, '\n' | ' '..='~' | '\u{a1}'..='\u{ff}'))
}

/// Every setting that has an effect, one a line, in the options' names.
fn settings_text(settings: &Settings) -> String {
    let used = options::all().filter(|option| (option.no_effect)(settings).is_none());
    let line = |(name, value): (&str, Value)| match value {
        Value::Unset => format!("{name}: none"),
        Value::Switch(is_on) => format!("{name}: {}", if is_on { "on" } else { "off" }),
        Value::Names(names) if names.is_empty() => format!("{name}: none"),
        value => format!("{name}: {value}"),
    };
    used.map(|option| line((option.name, option.get(settings)))).collect::<Vec<_>>().join("\n")
}
