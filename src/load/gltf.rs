//! glTF 2.0 (`.gltf` and `.glb`): the triangles of the default scene in their rest pose, and how they move.
//!
//! The `gltf` crate parses the document; its accessor readers are not used, since they panic on what a bad file may
//! say. [`accessor`] reads instead, with every range checked.
//!
//! Source: Khronos, glTF 2.0 specification, <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod animations;
mod binder;
mod buffers;
mod check;
mod document;
mod draco;
mod extensions;
pub(super) mod extent;
mod glb;
mod hanging;
mod json;
mod materials;
mod meshopt;
mod moving;
mod nodes;
mod primitive;
mod problem;
mod schema;
mod skin;
mod space;
mod unpacked;
mod vertices;

use std::path::Path;
use std::sync::Arc;

use ::gltf::{Document, Node};
use glam::DMat4;

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::uri::Files;
use super::warnings::repair_warnings;
use crate::files::Limits;
use crate::mesh::MemoryAccount;
use crate::mesh::mesh_builder::MeshBuilder;
use crate::progress::Progress;

use accessor::Accessors;
use binder::Binder;
use materials::Materials;
use nodes::Placed;
use primitive::Primitives;

pub use problem::Problem;

/// Sentences that are said of a document at most.
const MAX_WARNINGS: usize = 100;

/// Makes a mesh of a document's bytes.
///
/// `folder` is where the document lies, `name` becomes the mesh's. `limits` are those of files that it names.
///
/// # Errors
/// [`Problem`].
pub fn read(
    bytes: Vec<u8>,
    folder: &Path,
    name: &str,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, Problem> {
    let budget = Budget::new(bytes.len(), limits);
    let document::Parsed { document, blob, extensions, animations, mut warnings } =
        document::parse(bytes, &budget, progress)?;
    progress.check()?;
    let files = Files::new(folder, limits, &budget, progress);
    let buffers = buffers::load(&document, &files, &extensions.fallback, blob, progress)?;
    progress.set(0.3);
    let placed = nodes::place(&document)?;
    let mut accessors = Accessors::new(&document, &extensions, &buffers, &budget)?;
    accessors.unpacked = draco::unpack(&accessors, &document, &placed, &extensions.packed, progress)?;
    let clips = animations::read(animations, &document, &accessors, &mut warnings);
    progress.check()?;
    let binder = Binder::new(clips, &document, &placed, &mut warnings);
    let [vertices, corners] = extent::check(&document, &placed, &accessors, &budget, binder.is_some())?;
    let mut scene = Scene {
        document: &document,
        placed: &placed,
        accessors: &accessors,
        materials: Materials::new(&document, &accessors, &files, &extensions.transforms, &budget),
        builder: MeshBuilder::new(),
        primitives: Primitives::default(),
        binder,
    };
    scene.builder.expect(vertices, corners);
    for (i, &node) in placed.shown.iter().enumerate() {
        progress.set(0.3 + 0.5 * i as f32 / placed.shown.len() as f32);
        scene.add(node, progress)?;
    }
    let Scene { materials, builder, primitives, binder, .. } = scene;
    if builder.is_empty() {
        return Err(Problem::Empty { holds: primitives.holds(&document) });
    }
    warnings.extend(materials.warnings);
    warnings.extend(primitives.warnings());
    budget.release(accessors.buffer_bytes());
    budget.give_back_to(0);
    drop(accessors);
    drop(buffers);
    progress.set(0.8);
    let (mut mesh, bindings) = builder.finish_bound(name.to_owned(), &budget, progress)?;
    match binder.map(|binder| binder.finish(&mesh, &bindings)) {
        Some(Ok(rig)) => mesh.rig = Some(Arc::new(rig)),
        Some(Err(warning)) => warnings.push(warning),
        None => {}
    }
    // What reaches the builder has been turned and is of unit length: only the reader knows what the file said.
    mesh.repairs.normals_rescaled += primitives.rescaled;
    if warnings.len() > MAX_WARNINGS {
        let more = warnings.len() - MAX_WARNINGS;
        warnings.truncate(MAX_WARNINGS);
        warnings.push(format!("{more} more such sentences are left out."));
    }
    warnings.extend(repair_warnings(&mesh.repairs));
    Ok(LoadedMesh { mesh, warnings, files: files.named(), file_bytes: budget.files() })
}

/// What is needed to turn nodes into triangles, and the triangles so far.
struct Scene<'a> {
    document: &'a Document,
    placed: &'a Placed,
    accessors: &'a Accessors<'a>,
    materials: Materials<'a>,
    builder: MeshBuilder,
    primitives: Primitives,
    /// None if nothing moves.
    binder: Option<Binder>,
}

impl<'a> Scene<'a> {
    /// Adds the triangles of the node's mesh, if it has one.
    fn add(&mut self, node: usize, progress: &Progress) -> Result<(), Problem> {
        let Some(node) = self.document.nodes().nth(node) else { return Ok(()) };
        let Some(mesh) = node.mesh() else { return Ok(()) };
        let skin = node.skin().map(|skin| skin::Joints::read(&skin, self.accessors)).transpose()?;
        let joints = skin.as_ref().map_or_else(Vec::new, |skin| skin.matrices(&self.placed.global));
        let mut binder = self.binder.as_mut().map(|binder| binder.node(node.index(), skin.as_ref()));
        let global = self.placed.global.get(node.index()).copied().unwrap_or(DMat4::IDENTITY);
        for primitive in mesh.primitives() {
            progress.check()?;
            self.accessors.budget.give_back_to(0);
            if self.primitives.skip(&primitive) {
                continue;
            }
            let material = self.materials.resolve(&primitive.material(), &mut self.builder);
            let pose = primitive::Pose { global, joints: &joints, weights: weights(&node) };
            let (accessors, builder) = (self.accessors, &mut self.builder);
            let job = primitive::Job { mesh: &mesh, primitive: &primitive, pose: &pose, material, accessors, builder };
            self.primitives.read(job, binder.as_mut())?;
        }
        Ok(())
    }
}

/// The weights of the morph targets at rest: the node's, else the mesh's.
fn weights<'a>(node: &Node<'a>) -> &'a [f32] {
    node.weights().or_else(|| node.mesh().and_then(|mesh| mesh.weights())).unwrap_or(&[])
}

#[cfg(test)]
pub(super) mod tests;
