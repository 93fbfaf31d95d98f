//! Whole files, and standard input and output, which `-` stands for.

use std::io::{Read, Write};
use std::path::Path;

use super::ShotError;
use crate::adjacency_file::{self, Format};
use crate::engine::{Engine, Loaded};
use crate::render::Scene;
use geometry::mesh::adjacency::Layout;
use geometry::names::shown_path;
use geometry::progress::Progress;
use geometry::tessellate::{HullFactors, Inputs};
use gpu::{GpuError, Timing};
use load::factors_file::to_csv;
use load::files::{Limits, file_reason};

/// Reads a whole text file, or standard input if the path is `-`. Leaves out a byte order mark, which is no part of the text.
pub fn read_text(path: &Path) -> Result<String, ShotError> {
    let text = String::from_utf8(read_bytes(path)?);
    let mut text = text.map_err(|_| file_error(path, "read", &"it isn't text in UTF-8"))?;
    const MARK: char = '\u{feff}';
    if text.starts_with(MARK) {
        text.drain(..MARK.len_utf8());
    }
    Ok(text)
}

/// Reads a whole file, or standard input if the path is `-`. Refuses devices, which may have no end, and more bytes than a
/// mesh's file may have by default.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ShotError> {
    let most = Limits::default().file;
    let mut bytes = Vec::new();
    let read = match path.as_os_str() == "-" {
        true => std::io::stdin().take(most + 1).read_to_end(&mut bytes),
        false => open_input(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)),
    };
    read.map_err(|error| file_error(path, "read", &file_reason(&error)))?;
    if bytes.len() as u64 > most {
        return Err(file_error(path, "read", &format!("it has more than {most} bytes")));
    }
    Ok(bytes)
}

fn open_input(path: &Path) -> std::io::Result<std::fs::File> {
    if is_device(&std::fs::metadata(path)?) {
        return Err(std::io::Error::other("it is a device; name a file, a pipe, or - for standard input"));
    }
    std::fs::File::open(path)
}

#[cfg(unix)]
fn is_device(about: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    about.file_type().is_char_device() || about.file_type().is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: &std::fs::Metadata) -> bool {
    false
}

/// Writes a whole text, to standard output if the path is `-`.
pub fn write_text(path: &Path, text: &str) -> Result<(), ShotError> {
    write_bytes(path, text.as_bytes())
}

/// Writes a whole file, to standard output if the path is `-`.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), ShotError> {
    if path.as_os_str() == "-" {
        let mut out = std::io::stdout().lock();
        return out.write_all(bytes).and_then(|()| out.flush()).map_err(ShotError::Output);
    }
    load::files::write_whole(path, bytes).map_err(|error| file_error(path, "written", &file_reason(&error)))
}

/// Serialises a value on several lines, with a line end.
pub fn to_json(value: &impl serde::Serialize) -> Result<String, ShotError> {
    let text = serde_json::to_string_pretty(value).map_err(|error| ShotError::Output(error.into()))?;
    Ok(text + "\n")
}

pub fn file_error(path: &Path, doing: &'static str, reason: &dyn std::fmt::Display) -> ShotError {
    ShotError::File { path: shown_path(path), doing, reason: reason.to_string() }
}

/// Writes the factors of a scene with these inputs as CSV.
///
/// # Errors
/// The device was lost, or the file can't be written.
pub fn write_factors(
    engine: &Engine,
    scene: &mut Scene,
    inputs: &Inputs,
    path: &Path,
    progress: &Progress,
) -> Result<(), ShotError> {
    let factors = computed(engine, scene, inputs)?;
    progress.check()?;
    write_text(path, &to_csv(scene.tessellator.topology(), &factors, inputs.tessellation.partitioning))
}

/// Writes a mesh's index buffer of this layout.
///
/// # Errors
/// The file can't be written.
pub fn write_adjacency(
    loaded: &Loaded,
    layout: Layout,
    indices: &[u32],
    format: Format,
    path: &Path,
) -> Result<(), ShotError> {
    match format {
        Format::Json => {
            let text = adjacency_file::to_json(&loaded.mesh, &loaded.topology, layout, indices);
            write_bytes(path, text.map_err(|error| ShotError::Output(error.into()))?.as_bytes())
        }
        Format::Bin => write_bytes(path, &adjacency_file::to_bin(indices)),
    }
}

/// The factors that a hull shader would hand to the tessellator with these inputs.
pub fn computed(engine: &Engine, scene: &mut Scene, inputs: &Inputs) -> Result<Vec<HullFactors>, GpuError> {
    engine.count(scene, inputs, &mut Timing::Off)?;
    scene.tessellator.hull_factors()
}
