//! Saves a chart as a picture or a table.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::ImageFormat;
use thiserror::Error;

use super::{Subject, bitmap, columns, svg};
use geometry::names::shown_path;
use inspect::plot::ChartError;
use load::files::file_reason;

#[derive(Debug, Error)]
pub enum SaveError {
    #[error("{}: a chart's name must end in .svg, .png or .csv", shown_path(.0))]
    Ending(PathBuf),
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error("the chart could not be encoded: {0}")]
    Encode(#[from] image::ImageError),
    #[error("{} could not be written: {reason}", shown_path(.path))]
    Write { path: PathBuf, reason: String },
}

/// Writes an SVG or PNG picture or a CSV table, depending on the path's ending.
///
/// # Errors
/// The ending is another one, or the file can't be written.
pub fn save(path: &Path, subject: &Subject) -> Result<(), SaveError> {
    let failed = |reason: String| SaveError::Write { path: path.to_owned(), reason };
    let subjects = std::slice::from_ref(subject);
    let bytes = match inspect::export::ending(path).as_str() {
        "svg" => svg(subjects)?.into_bytes(),
        "png" => {
            let mut png = Cursor::new(Vec::new());
            bitmap(subjects)?.write_to(&mut png, ImageFormat::Png)?;
            png.into_inner()
        }
        "csv" => table(subject).map_err(|error| failed(error.to_string()))?,
        _ => return Err(SaveError::Ending(path.to_owned())),
    };
    load::files::write_whole(path, &bytes).map_err(|error| failed(file_reason(&error)))
}

fn table(subject: &Subject) -> std::io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns())?;
    for row in &subject.rows {
        writer.write_record(row.record())?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}
