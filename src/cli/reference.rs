//! The option `--reference`: compares the picture with a reference picture.

use std::io::BufReader;
use std::path::Path;

use image::{ImageError, ImageReader};

use super::{CliError, compare, file_error, write_picture};
use crate::files::open_file;
use crate::names::shown_path;

/// Reads the reference picture. The command calls this before it draws or writes anything.
///
/// # Errors
/// It can't be read.
pub(super) fn read(path: &Path) -> Result<image::RgbaImage, CliError> {
    let fail = |reason: &dyn std::fmt::Display| file_error(path, "read", reason);
    let file = open_file(path).map_err(|error| fail(&error))?;
    let file = file.ok_or_else(|| fail(&"it is not a file; name a PNG, JPEG or WebP image"))?.0;
    let reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|error| fail(&error))?;
    let reference = reader.decode().map_err(|error| match error {
        ImageError::Unsupported(_) => fail(&"it is no image; name a PNG, JPEG or WebP one"),
        error => fail(&error),
    })?;
    Ok(reference.to_rgba8())
}

/// Fails if the picture at `output` differs from the reference by more than `threshold`, and writes the difference beside it.
///
/// # Errors
/// It differs, or is of another size.
pub(super) fn compare_with(
    output: &Path,
    picture: &image::RgbaImage,
    path: &Path,
    reference: &image::RgbaImage,
    threshold: f64,
) -> Result<(), CliError> {
    let comparison =
        compare(picture, reference).map_err(|reason| CliError::Reference { reference: shown_path(path), reason })?;
    if comparison.difference <= threshold {
        return Ok(());
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push("-diff.png");
    let diff = output.with_file_name(name);
    // A device or a pipe has no folder for the picture of the difference.
    let see = if output.is_file() {
        write_picture(&diff, &comparison.map.into())?;
        format!(": see {}, where the differences are bright", shown_path(&diff))
    } else {
        String::new()
    };
    Err(CliError::Different {
        picture: shown_path(output),
        reference: shown_path(path),
        difference: comparison.difference,
        threshold,
        see,
    })
}
