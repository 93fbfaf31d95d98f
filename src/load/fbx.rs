//! Reads FBX, binary and text: the polygons of all meshes and NURBS surfaces that the file shows, in their rest pose, with
//! materials, skins, blend shapes and animations. Axes are turned so that Y points up, and the file's unit becomes metres, unless
//! another axis or unit was chosen: then its coordinates are taken as they are.
//!
//! FBX has no public specification. The library ufbx parses the file, with limits on its memory; what it returns is checked like
//! the file itself, since its lists hold what the file says. It runs in this process, on a thread of its own, so that the stack is the
//! same on every system (see the design notes).

mod beyond;
mod clips;
mod convert;
mod left_out;
mod looks;
mod materials;
mod morphs;
mod nodes;
mod nurbs;
mod parse;
mod skin;
mod smoothing;
mod surfaces;
mod textures;
mod vertices;

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::model_file::ModelFile;
use super::notes::Notes;
use super::read_error::ReadError;
use super::rig_builder::{RigBuilder, bones};
use super::uri::Files;

use nodes::Placed;
use nurbs::Meshes;
use surfaces::Surfaces;

/// The stack of the thread that reads, in bytes. ufbx needs less than 128 KiB, since it hardly recurses; decoders of images, and
/// MikkTSpace, need more.
const STACK: usize = 8 << 20;

/// Builds a mesh from a file's bytes.
///
/// # Errors
/// [`ReadError`]. A missing texture isn't an error but a warning.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().name("fbx".to_owned()).stack_size(STACK);
        let thread = thread.spawn_scoped(scope, || read_here(bytes, file));
        let thread = thread.map_err(|error| ReadError::NoThread { reason: error.to_string() })?;
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// Builds a mesh as [`read`] does, on the caller's thread.
///
/// # Errors
/// As [`read`].
pub(super) fn read_here(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    let (import, progress) = (file.selected.import, file.progress);
    let budget = Budget::new(bytes.len(), file.limits.memory);
    let scene = parse::scene(&bytes, &import, &budget, &progress.part(0.0, 0.3))?;
    budget.release(bytes.len() as u64);
    drop(bytes);
    let mut notes = Notes::default();
    left_out::warn(&scene, &mut notes);
    let meshes = Meshes::new(&scene, &budget, progress, &mut notes)?;
    let mut placed = Placed::new(&meshes, file, &budget, &mut notes)?;
    let clips = clips::read(&scene, &placed, &file.selected, &budget, &progress.part(0.3, 0.4), &mut notes)?;
    placed.grow(&clips);
    let binder = RigBuilder::new(clips, &placed.scene, &mut notes);
    let files = Files::new(file.folder, &file.limits, &budget, progress);
    let mut surfaces = Surfaces::new(&meshes, &placed, file, &files, binder)?;
    let mut drawn = Vec::new();
    for (i, &node) in placed.shown.iter().enumerate() {
        progress.set(0.4 + 0.4 * i as f32 / placed.shown.len() as f32);
        drawn.extend(surfaces.add(node, &file.selected, progress)?.then_some(node));
    }
    let holds = left_out::holds(&scene, &placed);
    let (mut faces, details, binder) = surfaces.into_parts(&mut notes);
    let of_node = |node: usize| Some(&*scene.nodes[node].element.name).filter(|name| !name.is_empty());
    let bones = bones(nodes::joints(&scene, &drawn), of_node, &placed.scene, &placed.global, binder.as_ref());
    notes.append(std::mem::take(&mut faces.notes));
    faces.notes = notes;
    budget.release(scene.metadata.result_memory_used as u64 + meshes.memory);
    let morph_targets = morphs::file_weights(&scene);
    drop(placed);
    drop(meshes);
    drop(scene);
    progress.set(0.8);
    let (mut loaded, numbers, mut notes) = faces.finish_numbered(file.name, holds, &progress.part(0.8, 1.0))?;
    loaded.mesh.bones = bones;
    RigBuilder::complete(&mut loaded.mesh, numbers, details, binder, &mut notes, &budget, progress)?;
    loaded.contents.morph_targets = morph_targets;
    let (files, file_bytes) = (files.named(), budget.files());
    Ok(LoadedMesh { warnings: notes.into_warnings(), files, file_bytes, ..loaded })
}

#[cfg(test)]
pub(super) mod tests;
