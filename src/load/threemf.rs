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
mod xml;

use super::face_builder::FaceBuilder;
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::model_file::ModelFile;
use super::read_error::{FilePosition, ReadError};
use geometry::names::shown;

use archive::Archive;
use document::Document;
use images::Images;

/// Builds a mesh from a file's bytes.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    let (budget, progress) = (Budget::new(bytes.len(), file.limits.memory), file.progress);
    let mut faces = FaceBuilder::new(file, &budget);
    let archive = Archive::new(&bytes, &budget)?;
    let of_archive = budget.held();
    let document = Document::read(&archive, &budget, &progress.part(0.0, 0.4), &mut faces.notes)?;
    let of_document = budget.held() - of_archive;
    let images = Images::unpack(&archive, &document, &budget, progress)?;
    faces.notes.extend(archive.warning());
    // The file's own bytes are among those.
    budget.release(of_archive);
    drop(archive);
    drop(bytes);
    let textured = placing::place(&document, &mut faces, &budget, &progress.part(0.4, 0.5))?;
    images.give(&textured, &mut faces, of_document, &budget, progress)?;
    let holds = document.holds();
    budget.release(of_document);
    drop(document);
    faces.finish(file.name, holds, &progress.part(0.5, 1.0))
}

/// An error in a part of the archive.
fn broken(part: &str, reason: impl std::fmt::Display) -> ReadError {
    FilePosition::Everywhere.error(format!("{}: {reason}", shown(part)))
}

#[cfg(test)]
pub(super) mod tests;
