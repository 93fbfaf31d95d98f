//! Reads 3MF: the objects that a file's build places, with their components, materials, colours and textures. Axes are turned so that
//! Y points up, and the file's unit becomes metres, unless another axis or unit was chosen: then its coordinates are taken as they are.
//!
//! A file is a zip archive with parts in XML. Parts are unpacked and parsed piece by piece, so none is in memory as a whole.
//!
//! Sources: 3MF Core Specification 1.3.0, Materials and Properties Extension 1.2.1, Production Extension 1.1.2.

mod archive;
mod document;
mod images;
mod looks;
mod model;
mod placing;
mod properties;
mod texture2d;
mod xml;

use super::import::Import;
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::notes::Notes;
use super::read_error::{FilePosition, ReadError};
use crate::files::Limits;
use geometry::mesh::MemoryRefused;
use geometry::names::shown;
use geometry::progress::Progress;

use archive::Archive;
use document::Document;
use images::Images;

/// Builds a mesh called `name` from a file's bytes.
///
/// # Errors
/// [`ReadError`].
pub(super) fn read(
    bytes: Vec<u8>,
    name: &str,
    import: Import,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, ReadError> {
    let budget = Budget::new(bytes.len(), limits.memory);
    let mut notes = Notes::default();
    let (document, images) = {
        let archive = Archive::new(&bytes, &budget)?;
        let document = Document::read(&archive, &budget, &progress.part(0.0, 0.4), &mut notes)?;
        let images = Images::unpack(&archive, &document, &budget, progress)?;
        notes.extend(archive.warning());
        archive.release(&budget);
        (document, images)
    };
    budget.release(bytes.len() as u64);
    drop(bytes);
    let (mut faces, textured) = placing::place(&document, &import, &budget, &progress.part(0.4, 0.5), &mut notes)?;
    images.give(&textured, &mut faces, (document.held(), &budget), progress, &mut notes)?;
    let holds = document.holds();
    document.release(&budget);
    drop(document);
    faces.finish(name, holds, notes.into_warnings(), &progress.part(0.5, 1.0))
}

/// An error in a part of the archive.
fn broken(part: &str, reason: impl std::fmt::Display) -> ReadError {
    FilePosition::Everywhere.error(format!("{}: {reason}", shown(part)))
}

fn too_large(refused: MemoryRefused) -> ReadError {
    ReadError::TooLarge { reason: refused.into() }
}

#[cfg(test)]
pub(super) mod tests;
