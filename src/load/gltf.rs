//! Reads glTF 2.0 (`.gltf`, `.glb` and `.vrm`): the triangles of one scene in their rest pose, and its animations.
//!
//! [`schema_check`] takes out what is wrong in a document, and [`reach`] finds what the scene uses of it. Then [`repair`] decides which faults
//! are errors: those that the shape depends on. Others cost a warning. The fault of an accessor, a buffer view or a buffer is for what reads it.
//!
//! The `gltf` crate parses the document. Its accessor readers aren't used, since they panic on some broken files;
//! [`accessor`] reads instead, and checks every range.
//!
//! Source: Khronos, glTF 2.0 specification, <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod animated_vertices;
mod animations;
mod buffers;
mod cameras;
mod carried;
mod document;
mod draco;
mod extension_table;
mod extensions;
mod glb;
mod gltf_error;
mod instances;
mod json;
mod lenient;
mod lights;
pub mod material_members;
mod material_source;
mod materials;
mod meshopt;
mod morph_targets;
mod node_parts;
mod nodes;
mod primitive;
mod primitive_data;
mod reach;
mod repair;
mod rig_nodes;
pub(super) mod scene_size;
pub(super) mod scenes;
mod schema;
mod schema_check;
mod skin;
mod texture_source;
mod variants;
mod vertex_details;
mod vertices;

use std::collections::HashMap;
use std::sync::Arc;

use ::gltf::{Document, Node, Semantic};
use glam::DMat4;

use super::attachment::below;
use super::loaded_mesh::{Contents, LoadedMesh};
use super::memory_budget::Budget;
use super::model_file::ModelFile;
use super::notes::Notes;
use super::rig_builder::{RigBuilder, SkinJoints, bones};
use super::uri::Files;
use super::warnings::repair_warnings;
use super::{notes, rig_builder};
use geometry::casts::to_f32;
use geometry::mesh::Borrowed;
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::mesh_builder::MeshBuilder;
use geometry::mesh::rig::Joint;
use geometry::progress::Progress;

use accessor::Accessors;
use buffers::Buffers;
use extensions::InstancingExtension;
use materials::Materials;
use node_parts::NodeParts;
use nodes::Placed;
use primitive::PrimitiveReader;
use scene_size::SceneNeeds;

pub use gltf_error::GltfError;

/// Builds a mesh from a document's bytes.
///
/// What is selected says which scene is read, and with the materials of which variant, if the document has it.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, GltfError> {
    let &ModelFile { folder, name, selected, ref limits, progress } = file;
    let budget = Budget::new(bytes.len(), limits.memory);
    let mut parsed = document::parse(bytes, selected, &budget, progress)?;
    let (document, notes) = (&parsed.document, &mut parsed.notes);
    let (extensions, reach, lists) = (&parsed.extensions, &parsed.reach, &parsed.lists);
    progress.check()?;
    let files = Files::new(folder, limits, &budget, progress);
    let buffers = Buffers::new(document, &extensions.fallback, &parsed.faults, &files, parsed.blob);
    progress.set(0.3);
    let mut placed = nodes::place(document, &reach.hiding, notes)?;
    let mut accessors = Accessors::new(document, buffers, &extensions.compressed, &parsed.faults, &budget);
    accessors.unpacked = draco::unpack(&accessors, document, &placed, &extensions.packed, progress)?;
    let clips = animations::read(parsed.animations, document, &accessors, notes);
    progress.check()?;
    let moves_meshes = rig_nodes::move_meshes(&clips, document, &placed);
    let (mut binder, mut grown) = (None, None);
    if !clips.is_empty() {
        let also = parsed.lights.nodes().chain(parsed.cameras.nodes());
        rig_nodes::complete(&mut placed, document, also);
        placed.scene.grow(&clips);
        grown = (!placed.scene.grown.is_empty()).then(|| placed.scene.global());
        binder = RigBuilder::new(clips, &placed.scene, notes);
    }
    let mut materials = Materials::new(lists, document, &placed, &accessors, &files)?;
    let is_detailed = needs_details(document, &placed, &materials);
    let check = |moves| scene_size::check(document, &placed, &extensions.instances, &accessors, moves, is_detailed);
    let needs = afforded(check, &mut binder, moves_meshes, notes)?;
    materials.read_images(needs.bytes)?;
    let mut scene = Scene {
        document,
        global: grown.as_deref().unwrap_or(&placed.global),
        parts: &parsed.parts,
        instances: &extensions.instances,
        accessors: &accessors,
        materials,
        builder: MeshBuilder::with_crease_angle(selected.import.crease_angle),
        primitives: PrimitiveReader::importing(selected.import),
        binder,
        details: is_detailed.then(DetailTable::default),
    };
    scene.builder.expect(needs.vertices, needs.corners);
    for (i, &node) in placed.shown.iter().enumerate() {
        progress.set(0.3 + 0.5 * i as f32 / placed.shown.len() as f32);
        scene.add(node, progress)?;
    }
    let Scene { materials, mut builder, mut primitives, binder, details, .. } = scene;
    let of_materials = parsed.parts.list.enter_materials(&mut builder, &budget);
    of_materials.map_err(GltfError::too_large("the list of materials"))?;
    if builder.is_empty() {
        let mut holds = match reach.hidden {
            0 if parsed.parts.is_cut || parsed.parts.list.are_hidden() => {
                format!("its named parts are hidden; {}", parsed.parts.list.names())
            }
            0 => primitives.holds(document),
            hidden => {
                let said = "nodes of its scene that have a mesh (--show-hidden shows them)";
                format!("KHR_node_visibility hides the {hidden} {said}")
            }
        };
        holds += if parsed.contents.scenes.len() > 1 { "; --scene shows another of its scenes" } else { "" };
        return Err(GltfError::Empty { holds });
    }
    notes.append(accessors.notes.take());
    notes.append(materials.into_notes());
    notes.append(std::mem::take(&mut primitives.notes));
    notes.extend(primitives.warnings());
    budget.release(accessors.buffer_bytes());
    drop(accessors);
    budget.release(lists.bytes());
    drop(parsed.lists);
    progress.set(0.8);
    let lights = parsed.lights.shown(&placed, notes);
    let cameras = parsed.cameras.shown(&placed, notes);
    let mounts = [mounts(binder.as_ref(), &lights), mounts(binder.as_ref(), &cameras)];
    let joints = rig_nodes::joints(document, &placed);
    let of_node = |node| document.nodes().nth(node)?.name();
    let bones = bones(joints, of_node, &placed.scene, &placed.global, binder.as_ref());
    let (mut mesh, bindings) = builder.finish_bound(name.to_owned(), &budget, progress)?;
    let parts = parsed.parts.list.finish(&mut mesh, notes);
    mesh.bones = bones;
    RigBuilder::complete(&mut mesh, bindings, details, binder, notes, &budget, progress)?;
    if let Some(rig) = mesh.rig.as_mut().and_then(Arc::get_mut) {
        [rig.lights, rig.cameras] = mounts;
    }
    // The builder gets transformed normals of unit length, so the reader counts those that weren't in the file.
    mesh.repairs.normals_rescaled += primitives.rescaled;
    mesh.lights = lights.into_iter().map(|(_, light)| light).collect();
    mesh.cameras = cameras.into_iter().map(|(_, camera)| camera).collect();
    let mut warnings = parsed.notes.into_warnings();
    warnings.extend(repair_warnings(&mesh.repairs, &selected.import));
    let contents = Contents { parts, ..parsed.contents };
    let (files, file_bytes) = (files.named(), budget.files());
    Ok(LoadedMesh { mesh, warnings, contents, files, file_bytes, is_refined: false })
}

/// The scene that is being read, and the mesh that is being built from it.
struct Scene<'a, 'p> {
    document: &'a Document,
    /// The transform from each node's own space to the scene's, in which the meshes are built.
    global: &'a [DMat4],
    parts: &'p NodeParts,
    /// By node, the instances of its mesh.
    instances: &'a HashMap<usize, InstancingExtension>,
    accessors: &'a Accessors<'a>,
    materials: Materials<'a>,
    builder: MeshBuilder,
    primitives: PrimitiveReader,
    /// None if nothing is animated.
    binder: Option<RigBuilder>,
    /// None if no material needs details of corners.
    details: Option<DetailTable>,
}

impl Scene<'_, '_> {
    /// Adds the triangles of a node's mesh, if it has one: once, or once for each of its instances.
    fn add(&mut self, node: usize, progress: &Progress) -> Result<(), GltfError> {
        let Some(node) = self.document.nodes().nth(node) else { return Ok(()) };
        let Some(mesh) = node.mesh() else { return Ok(()) };
        let _scope = Borrowed::from(self.accessors.budget);
        let skin = node.skin().map(|skin| skin::read(&skin, self.accessors)).transpose()?;
        let joints = skin.as_ref().map_or_else(Vec::new, |skin| skin.matrices(self.global));
        self.builder.enter_part(self.parts.of_node.get(&node.index()).copied());
        let mut own = self.instances.get(&node.index());
        if own.is_some() && skin.is_some() {
            // Vertices of a skin don't move with their node.
            let said = "has instances of a mesh that a skin moves, which EXT_mesh_gpu_instancing doesn't define";
            self.primitives.notes.push(format!("/nodes/{} {said}; it is shown once.", node.index()));
            own = None;
        }
        let Some(own) = own else {
            return self.add_once(&node, &mesh, skin.as_ref(), &joints, DMat4::IDENTITY, progress);
        };
        for instance in instances::transforms(self.document, self.accessors, own, node.index())? {
            self.add_once(&node, &mesh, None, &[], instance, progress)?;
        }
        Ok(())
    }

    /// Adds the triangles of a node's mesh. `instance` is the transform from the mesh's space to the node's.
    fn add_once(
        &mut self,
        node: &Node,
        mesh: &::gltf::Mesh,
        skin: Option<&SkinJoints>,
        joints: &[DMat4],
        instance: DMat4,
        progress: &Progress,
    ) -> Result<(), GltfError> {
        let mut binder = self.binder.as_mut().map(|binder| binder.node(node.index(), skin));
        let global = self.global.get(node.index()).copied().unwrap_or(DMat4::IDENTITY);
        let global = below(global, instance);
        // Vertices of a skin don't move with their node.
        let scale = if skin.is_some() { 1.0 } else { to_f32(global.determinant().abs().cbrt()) };
        for primitive in mesh.primitives() {
            progress.check()?;
            let _scope = Borrowed::from(self.accessors.budget);
            if self.primitives.skip(&primitive) {
                continue;
            }
            let material = self.materials.resolve(&primitive.material(), scale, &mut self.builder);
            let own = self.builder.material_mut(material.index);
            self.parts.list.give_style(own);
            let style = self.parts.list.style(self.parts.of_node.get(&node.index()).copied(), own.style);
            let pose = primitive::NodePose { global, instance, joints, weights: weights(node) };
            let job = primitive::Job {
                mesh,
                primitive: &primitive,
                pose: &pose,
                style,
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
    let mut primitives = placed.meshes(document).flat_map(|mesh| mesh.primitives());
    primitives.any(|primitive| {
        primitive.get(&Semantic::Colors(0)).is_some() || materials.needs_details(&primitive.material())
    })
}

/// Returns what a scene needs, if that fits into memory. Animations that move only lights and cameras are left out where it fits
/// without them alone.
fn afforded(
    check: impl Fn(bool) -> Result<SceneNeeds, GltfError>,
    binder: &mut Option<RigBuilder>,
    moves_meshes: bool,
    notes: &mut Notes,
) -> Result<SceneNeeds, GltfError> {
    match check(binder.is_some()) {
        Err(GltfError::TooLarge { .. }) if binder.is_some() && !moves_meshes => {
            *binder = None;
            let said = "animations are left out: they move only lights and cameras, and for a mesh of this size that takes too \
                        much memory.";
            notes.push(said.to_owned());
            check(false)
        }
        checked => checked,
    }
}

/// What moves each of the lights or cameras that are shown, by their nodes; empty if nothing moves any.
fn mounts<T>(binder: Option<&RigBuilder>, shown: &[(usize, T)]) -> Vec<Joint> {
    let all: Vec<_> = binder.iter().flat_map(|own| shown.iter().map(|(node, _)| own.mount(*node))).collect();
    if all.iter().any(|mount| mount.node.is_some()) { all } else { Vec::new() }
}

/// Returns the weights of a node's morph targets at rest: the node's own, or else those of its mesh.
fn weights<'a>(node: &Node<'a>) -> &'a [f32] {
    node.weights().or_else(|| node.mesh().and_then(|mesh| mesh.weights())).unwrap_or(&[])
}

#[cfg(test)]
pub(super) mod tests;
