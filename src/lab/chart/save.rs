//! Saves a chart as a picture or a table.

use std::path::Path;

use super::{Subject, bitmap, columns, svg};
use inspect::export::ending;
use inspect::shot::files::{file_error, write_bytes, write_text};
use inspect::shot::{ShotError, write_picture};

/// Writes an SVG or PNG picture or a CSV table, depending on the path's ending.
///
/// # Errors
/// The ending is another one, or the file can't be written.
pub fn save(path: &Path, subjects: &[Subject]) -> Result<(), ShotError> {
    match ending(path).as_str() {
        "svg" => write_text(path, &svg(subjects)?),
        "png" => write_picture(path, &bitmap(subjects)?.into()),
        "csv" => write_bytes(path, &table(subjects).map_err(|error| file_error(path, "written", &error))?),
        _ => Err(file_error(path, "written", &"a chart's name must end in .svg, .png or .csv")),
    }
}

fn table(subjects: &[Subject]) -> std::io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns())?;
    for row in subjects.iter().flat_map(|subject| &subject.rows) {
        writer.write_record(row.record())?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}
