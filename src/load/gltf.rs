//! Reads glTF 2.0 (`.gltf` and `.glb`): the triangles of the default scene in their rest pose, and its animations.
//!
//! The `gltf` crate parses the document. Its accessor readers aren't used, since they panic on some broken files;
//! [`accessor`] reads instead, and checks every range.
//!
//! Source: Khronos, glTF 2.0 specification, <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod animated_vertices;
mod animations;
mod attachment;
mod binding_space;
mod buffers;
mod cameras;
mod decompressed_primitive;
mod document;
mod draco;
mod extensions;
mod glb;
mod gltf_error;
mod json;
mod lenient;
mod lights;
mod material_lists;
mod material_source;
mod materials;
mod meshopt;
mod nodes;
mod notes;
mod primitive;
mod primitive_data;
mod rig_builder;
pub(super) mod scene_size;
mod schema;
mod schema_check;
mod skin;
mod tangents;
mod texture_source;
mod uv_transform;
mod variants;
mod vertex_details;
mod vertices;

use std::path::Path;
use std::sync::Arc;

use ::gltf::{Document, Node, Semantic};
use glam::DMat4;

use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::uri::Files;
use super::warnings::repair_warnings;
use crate::files::Limits;
use crate::mesh::detail_table::DetailTable;
use crate::mesh::mesh_builder::MeshBuilder;
use crate::mesh::{MemoryAccount, MemoryRefused, Mesh};
use crate::progress::Progress;

use accessor::Accessors;
use materials::Materials;
use nodes::Placed;
use notes::Notes;
use primitive::PrimitiveReader;
use rig_builder::RigBuilder;
use scene_size::PerVertex;
use tangents::DetailedMesh;

pub use gltf_error::GltfError;

/// Builds a mesh from a document's bytes.
///
/// `folder` is the document's folder; `name` becomes the mesh's name. Materials are those of a variant, if the document has it. `limits` apply to the files that the document
/// names.
///
/// # Errors
/// [`GltfError`].
pub(super) fn read(
    bytes: Vec<u8>,
    folder: &Path,
    name: &str,
    variant: Option<&str>,
    limits: &Limits,
    progress: &Progress,
) -> Result<LoadedMesh, GltfError> {
    let budget = Budget::new(bytes.len(), limits);
    let document::Parsed { document, blob, extensions, animations, lists, lights, cameras, variants, mut notes } =
        document::parse(bytes, variant, &budget, progress)?;
    progress.check()?;
    let files = Files::new(folder, limits, &budget, progress);
    let buffers = buffers::load(&document, &files, &extensions.fallback, blob, progress)?;
    progress.set(0.3);
    let placed = nodes::place(&document)?;
    let mut accessors = Accessors::new(&document, &extensions, &buffers, &budget)?;
    accessors.unpacked = draco::unpack(&accessors, &document, &placed, &extensions.packed, progress)?;
    let mut warnings = Vec::new();
    let clips = animations::read(animations, &document, &accessors, &mut warnings);
    progress.check()?;
    let binder = RigBuilder::new(clips, &document, &placed, &mut warnings);
    notes.extend(std::mem::take(&mut warnings));
    let mut materials = Materials::new(&lists, &document, &placed, (&accessors, &files), &budget)?;
    let is_detailed = needs_details(&document, &placed, &materials);
    let beside = PerVertex { moves: binder.is_some(), is_detailed };
    let needs = scene_size::check(&document, &placed, &accessors, &budget, beside)?;
    materials.read_images(needs.bytes, progress)?;
    let mut scene = Scene {
        document: &document,
        placed: &placed,
        accessors: &accessors,
        materials,
        builder: MeshBuilder::new(),
        primitives: PrimitiveReader::default(),
        binder,
        details: is_detailed.then(DetailTable::default),
    };
    scene.builder.expect(needs.vertices, needs.corners);
    for (i, &node) in placed.shown.iter().enumerate() {
        progress.set(0.3 + 0.5 * i as f32 / placed.shown.len() as f32);
        scene.add(node, progress)?;
    }
    let Scene { materials, builder, mut primitives, binder, details, .. } = scene;
    if builder.is_empty() {
        return Err(GltfError::Empty { holds: primitives.holds(&document) });
    }
    notes.append(materials.into_notes());
    notes.append(std::mem::take(&mut primitives.notes));
    notes.extend(primitives.warnings());
    budget.release(accessors.buffer_bytes());
    budget.give_back_to(0);
    drop(accessors);
    drop(buffers);
    budget.release(lists.bytes());
    drop(lists);
    progress.set(0.8);
    let mut mesh = finished(name, (builder, details, binder), &mut notes, (&budget, progress))?;
    // The builder gets transformed normals of unit length, so the reader counts those that weren't in the file.
    mesh.repairs.normals_rescaled += primitives.rescaled;
    mesh.lights = lights.shown(&placed, &mut notes);
    mesh.cameras = cameras.shown(&placed, &mut notes);
    warnings = notes.into_warnings();
    warnings.extend(repair_warnings(&mesh.repairs));
    Ok(LoadedMesh { mesh, warnings, variants, files: files.named(), file_bytes: budget.files() })
}

/// The scene that is being read, and the mesh that is being built from it.
struct Scene<'a> {
    document: &'a Document,
    placed: &'a Placed,
    accessors: &'a Accessors<'a>,
    materials: Materials<'a>,
    builder: MeshBuilder,
    primitives: PrimitiveReader,
    /// None if nothing is animated.
    binder: Option<RigBuilder>,
    /// None if no material needs details of corners.
    details: Option<DetailTable>,
}

impl<'a> Scene<'a> {
    /// Adds the triangles of a node's mesh, if it has one.
    fn add(&mut self, node: usize, progress: &Progress) -> Result<(), GltfError> {
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
            let material = self.materials.resolve(&primitive.material(), &mut self.builder)?;
            let pose = primitive::NodePose { global, joints: &joints, weights: weights(&node) };
            let job = primitive::Job {
                mesh: &mesh,
                primitive: &primitive,
                pose: &pose,
                material,
                accessors: self.accessors,
                builder: &mut self.builder,
                details: self.details.as_mut(),
            };
            self.primitives.read(job, binder.as_mut())?;
        }
        Ok(())
    }
}

/// Returns whether corners of what is shown need more than position, normal and texture coordinates.
fn needs_details(document: &Document, placed: &Placed, materials: &Materials) -> bool {
    let mut seen = vec![false; document.meshes().len()];
    let shown = placed.shown.iter().filter_map(|&node| document.nodes().nth(node)?.mesh());
    let mut meshes = shown.filter(|mesh| !std::mem::replace(&mut seen[mesh.index()], true));
    meshes.any(|mesh| {
        mesh.primitives().any(|primitive| {
            primitive.get(&Semantic::Colors(0)).is_some() || materials.needs_details(&primitive.material())
        })
    })
}

/// Builds the mesh from what was collected, with the details of its corners and its rig.
///
/// # Errors
/// [`GltfError::TooLarge`] and [`GltfError::Cancelled`].
fn finished(
    name: &str,
    (builder, details, binder): (MeshBuilder, Option<DetailTable>, Option<RigBuilder>),
    notes: &mut Notes,
    (budget, progress): (&Budget, &Progress),
) -> Result<Mesh, GltfError> {
    let (mut mesh, mut bindings) = builder.finish_bound(name.to_owned(), budget, progress)?;
    if let Some(details) = details {
        bindings = with_details(&mut mesh, details, &bindings, notes, (budget, progress))?;
    }
    match binder.map(|binder| binder.finish(&mesh, &bindings)) {
        Some(Ok(rig)) => mesh.rig = Some(Arc::new(rig)),
        Some(Err(warning)) => notes.push(warning),
        None => {}
    }
    Ok(mesh)
}

/// Gives the mesh the details of its corners, whose numbers in the table these are. Returns their bindings to joints.
///
/// # Errors
/// [`GltfError::TooLarge`] and [`GltfError::Cancelled`].
fn with_details(
    mesh: &mut Mesh,
    table: DetailTable,
    numbers: &[u32],
    notes: &mut Notes,
    (budget, progress): (&Budget, &Progress),
) -> Result<Vec<u32>, GltfError> {
    let too_large =
        |refused: MemoryRefused| GltfError::TooLarge { what: "the scene".to_owned(), reason: refused.into() };
    let (mut details, mut bindings) = table.into_lists(numbers, budget).map_err(too_large)?;
    let detailed = DetailedMesh { mesh, details: &mut details, bindings: &mut bindings };
    notes.extend(tangents::complete(detailed, budget, progress)?);
    mesh.details = Some(Arc::new(details));
    Ok(bindings)
}

/// Returns the weights of a node's morph targets at rest: the node's own, or else those of its mesh.
fn weights<'a>(node: &Node<'a>) -> &'a [f32] {
    node.weights().or_else(|| node.mesh().and_then(|mesh| mesh.weights())).unwrap_or(&[])
}

#[cfg(test)]
pub(super) mod tests;
