//! A picture held against one that was right.

use std::path::Path;

use super::{CliError, file_error, write_picture};
use crate::measure::compare;

/// Reads the reference before anything is drawn or written.
///
/// # Errors
/// It can't be read, or the picture at `output` would replace it.
pub fn read(path: &Path, output: &Path) -> Result<image::RgbaImage, CliError> {
    let reference = image::open(path).map_err(|error| file_error(path, "read", &error))?.to_rgba8();
    // Neither path resolves if there is no such file yet.
    if std::fs::canonicalize(path).ok() == std::fs::canonicalize(output).ok() {
        return Err(file_error(path, "kept", &"the picture would replace it: write the picture elsewhere"));
    }
    Ok(reference)
}

/// Fails if the picture at `output` differs from the reference by more than `threshold`, and writes the difference beside it.
///
/// # Errors
/// It differs, or is of another size.
pub fn hold_against(
    output: &Path,
    picture: &image::RgbaImage,
    path: &Path,
    reference: &image::RgbaImage,
    threshold: f64,
) -> Result<(), CliError> {
    let comparison = compare(picture, reference)
        .map_err(|reason| CliError::Reference { reference: path.display().to_string(), reason })?;
    if comparison.difference <= threshold {
        return Ok(());
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push("-diff.png");
    let diff = output.with_file_name(name);
    // Beside a device or a pipe is no place for a picture.
    let see = if output.is_file() {
        write_picture(&diff, &comparison.map.into())?;
        format!(": see {}, where the differences are bright", diff.display())
    } else {
        String::new()
    };
    Err(CliError::Different {
        picture: output.display().to_string(),
        reference: path.display().to_string(),
        difference: comparison.difference,
        threshold,
        see,
    })
}
