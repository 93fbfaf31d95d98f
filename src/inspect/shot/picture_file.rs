//! PNG files, and the texts in them that say what was drawn.

use std::io::{BufRead, Seek};
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbaImage};

use super::ShotError;
use super::files::file_error;
use crate::settings::{Settings, Value, options};
use gpu::identity;
use load::files::{file_reason, write_whole};

/// Keywords of the texts. The first is one of the PNG specification's own.
const SOFTWARE: &str = "Software";
const ADAPTER: &str = "pnaen adapter";
const COMMAND: &str = "pnaen command";
const SETTINGS: &str = "pnaen settings";

/// Writes a PNG file, whatever its name ends in.
pub fn write_picture(path: &Path, picture: &DynamicImage) -> Result<(), ShotError> {
    write(path, &png_bytes(picture).map_err(|error| file_error(path, "encoded", &error))?)
}

/// A picture as a PNG file.
pub fn png_bytes(picture: &DynamicImage) -> image::ImageResult<Vec<u8>> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder)?;
    Ok(bytes)
}

/// Writes a PNG file with texts that say what drew it, and how to draw it again.
pub(crate) fn write_stamped(
    path: &Path,
    picture: &RgbaImage,
    adapter: &wgpu::AdapterInfo,
    command: &str,
    settings: &Settings,
) -> Result<(), ShotError> {
    let settings = settings_text(settings);
    write_drawn(path, picture, adapter, &[(COMMAND, command), (SETTINGS, &settings)])
}

/// Writes a PNG file with texts that say what drew it, and these.
pub fn write_drawn(
    path: &Path,
    picture: &RgbaImage,
    adapter: &wgpu::AdapterInfo,
    texts: &[(&str, &str)],
) -> Result<(), ShotError> {
    let identity = identity(adapter);
    let adapter = identity.as_deref().map(|identity| (ADAPTER, identity));
    let software = (SOFTWARE, concat!("pnaen ", env!("CARGO_PKG_VERSION")));
    let all: Vec<_> = [software].into_iter().chain(adapter).chain(texts.iter().copied()).collect();
    write(path, &with_texts(picture, &all).map_err(|error| file_error(path, "encoded", &error))?)
}

/// What drew the picture in a PNG file, if that is known.
pub(crate) fn adapter_of(file: impl BufRead + Seek) -> Option<String> {
    let reader = png::Decoder::new(file).read_info().ok()?;
    let info = reader.info();
    let latin_1 =
        info.uncompressed_latin1_text.iter().find(|text| text.keyword == ADAPTER).map(|text| text.text.clone());
    let utf_8 = || info.utf8_text.iter().find(|text| text.keyword == ADAPTER)?.get_text().ok();
    latin_1.or_else(utf_8)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), ShotError> {
    write_whole(path, bytes).map_err(|error| file_error(path, "written", &file_reason(&error)))
}

/// A PNG file with texts; [`image`] writes none.
fn with_texts(picture: &RgbaImage, texts: &[(&str, &str)]) -> Result<Vec<u8>, png::EncodingError> {
    let (width, height) = picture.dimensions();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::Adaptive);
    for (keyword, text) in texts {
        // A tEXt chunk has printable characters of Latin-1, and line ends.
        let is_latin_1 = text.chars().all(|c| matches!(c, '\n' | ' '..='~' | '\u{a1}'..='\u{ff}'));
        let add = if is_latin_1 { png::Encoder::add_text_chunk } else { png::Encoder::add_itxt_chunk };
        add(&mut encoder, (*keyword).to_owned(), (*text).to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.as_raw())?;
    writer.finish()?;
    Ok(bytes)
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
