//! Saves a chart as a picture or a table.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::{Subject, bitmap, columns, svg};
use geometry::names::shown_path;
use inspect::export::ending;
use inspect::plot::ChartError;
use inspect::shot::files::{file_error, write_bytes, write_text};
use inspect::shot::{ShotError, write_picture};

#[derive(Debug, Error)]
pub enum SaveError {
    #[error("{}: a chart's name must end in .svg, .png or .csv", shown_path(.0))]
    Ending(PathBuf),
    #[error(transparent)]
    Chart(#[from] ChartError),
    #[error(transparent)]
    Write(#[from] ShotError),
}

/// Writes an SVG or PNG picture or a CSV table, depending on the path's ending.
///
/// # Errors
/// The ending is another one, or the file can't be written.
pub fn save(path: &Path, subject: &Subject) -> Result<(), SaveError> {
    let subjects = std::slice::from_ref(subject);
    match ending(path).as_str() {
        "svg" => write_text(path, &svg(subjects)?)?,
        "png" => write_picture(path, &bitmap(subjects)?.into())?,
        "csv" => write_bytes(path, &table(subject).map_err(|error| file_error(path, "written", &error))?)?,
        _ => return Err(SaveError::Ending(path.to_owned())),
    }
    Ok(())
}

fn table(subject: &Subject) -> std::io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns())?;
    for row in &subject.rows {
        writer.write_record(row.record())?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}
