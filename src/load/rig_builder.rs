//! Builds the rig of an animated mesh: nodes and skins become joints, and vertices are bound to them.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3};

use super::attachment::{Attachment, SceneNodes, attachments};
use super::binding_space::{BindingSpace, posed, unturned, untwisted};
use super::notes::Notes;
use super::tangents;
use geometry::casts::{to_f32, to_u32};
use geometry::mesh::build_limits::{BuildError, MemoryRefused};
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::normals::GivenNormal;
use geometry::mesh::rig::{Binding, Clip, Delta, Joint, Morph, Placement, Property, Reach, Rig};
use geometry::mesh::subdivision::Refinement;
use geometry::mesh::{Bone, Budget, CornerDetail, CornerDetails, Mesh};
use geometry::names::shown;
use geometry::progress::{Cancelled, Progress};

/// The greatest number of bound vertices, and of their displacements, which limits the memory.
const MAX_BOUND: usize = 1 << 24;
/// Memory for a displacement of a bound vertex, and for finding equal ones, in bytes.
pub(super) const PER_DELTA: u64 = 250;
/// The greatest number of elements of morph targets that are read.
const MAX_DISPLACED: usize = 1 << 28;

/// Collects bindings, node by node, and builds a [`Rig`] of them.
#[derive(Default)]
pub(super) struct RigBuilder {
    /// What is there of it so far, without bindings.
    rig: Rig,
    /// For each node of the scene, the animated node that moves it.
    attachments: Vec<Attachment>,
    /// The animated nodes that are scaled to nothing at rest, with their placements then. Until the rig is finished, they are as large as
    /// in a clip.
    grown: Vec<(u32, Placement)>,
    /// Which animated nodes are these, or below them.
    is_grown: Vec<bool>,
    /// For each node whose morph targets a clip weights, its index in `morphs`.
    node_morphs: HashMap<usize, usize>,
    joint_ids: HashMap<(Option<u32>, [[u64; 16]; 2]), u32>,
    bound: Vec<BoundVertex>,
    bound_ids: HashMap<[u32; 8], u32>,
    /// Numbers for distinct lists of joints, weights and displacements.
    lists: HashMap<Vec<u32>, u32>,
    /// The displacements of tangents. Until the rig is finished, [`Delta::tangent`] is 1 more than an index into these.
    tangent_deltas: Vec<[f32; 3]>,
    /// How many elements of morph targets have been read.
    displaced: usize,
    /// Why no rig can be built.
    problem: Option<String>,
}

/// The joints of a skin.
pub(super) struct SkinJoints {
    /// Indices of the scene's nodes.
    pub nodes: Vec<usize>,
    /// The transforms from the mesh's bind pose to each joint's own space.
    pub inverse_binds: Vec<DMat4>,
    /// Where a copy of the mesh is, relative to the mesh that the joints move.
    pub place: DMat4,
}

impl SkinJoints {
    /// Returns, for each joint, the matrix that takes a vertex from the mesh's bind pose to the scene: the joint's
    /// global transform times its inverse bind matrix, and the copy's place. The skinned node's own transform isn't used (glTF 2.0
    /// specification, section 3.7.3).
    pub(super) fn matrices(&self, global: &[DMat4]) -> Vec<DMat4> {
        let place = |&joint: &usize| global.get(joint).copied().unwrap_or(DMat4::IDENTITY);
        let joints = self.nodes.iter().map(place).zip(&self.inverse_binds);
        joints.map(|(joint, inverse)| self.place * joint * *inverse).collect()
    }
}

/// A vertex that will be deformed.
struct BoundVertex {
    binding: Binding,
    alike: u32,
    /// Whether its normal must be computed from the one that its corner gets.
    without_normal: bool,
    /// Its tangent, if morph targets displace that.
    tangent: Option<[f32; 3]>,
}

impl RigBuilder {
    /// Prepares for some clips, whose targets are nodes of the scene. Returns none if no clip moves anything that is
    /// shown. Adds a warning for each clip that doesn't.
    pub(super) fn new(clips: Vec<Clip>, scene: &SceneNodes, notes: &mut Notes) -> Option<Self> {
        if clips.is_empty() {
            return None;
        }
        let mut moved = vec![false; scene.local.len()];
        for channel in clips.iter().flat_map(|clip| &clip.channels) {
            moved[channel.target as usize] |= channel.property != Property::Weights;
        }
        moved.iter_mut().zip(&scene.carries).for_each(|(moved, carries)| *moved &= carries);
        let (nodes, attachments) = attachments(scene, &moved);
        let moved_by =
            |&(node, rest): &(usize, Placement)| Some((attachments[node].node.filter(|_| moved[node])?, rest));
        let grown: Vec<(u32, Placement)> = scene.grown.iter().filter_map(moved_by).collect();
        let mut is_grown = vec![false; nodes.len()];
        grown.iter().for_each(|(node, _)| is_grown[*node as usize] = true);
        for (i, node) in nodes.iter().enumerate() {
            is_grown[i] |= node.parent.is_some_and(|parent| is_grown[parent as usize]);
        }
        let mut binder = Self { rig: Rig { nodes, ..Rig::default() }, attachments, grown, is_grown, ..Self::default() };
        binder.add_morphs(&clips, scene);
        for clip in clips {
            let (name, clip) = (clip.name.clone(), binder.retargeted(clip, &moved));
            if clip.channels.is_empty() {
                notes.push(format!("animation \"{name}\" moves nothing that is shown; it is left out."));
            } else {
                binder.rig.clips.push(clip);
            }
        }
        (!binder.rig.clips.is_empty()).then_some(binder)
    }

    /// Adds the morph targets of the nodes that are shown and whose weights a clip changes.
    fn add_morphs(&mut self, clips: &[Clip], scene: &SceneNodes) {
        let mut weighed = vec![false; scene.local.len()];
        for channel in clips.iter().flat_map(|clip| &clip.channels) {
            weighed[channel.target as usize] |= channel.property == Property::Weights;
        }
        let mut first_weight = 0;
        for (node, rest) in scene.morphed.iter().filter(|(node, _)| weighed[*node]) {
            self.node_morphs.insert(*node, self.rig.morphs.len());
            self.rig.morphs.push(Morph { first_weight, rest: rest.clone() });
            first_weight += to_u32(rest.len());
        }
    }

    /// Keeps a clip's channels that move something shown, and replaces their targets by indices into the rig.
    fn retargeted(&self, mut clip: Clip, moved: &[bool]) -> Clip {
        clip.channels.retain_mut(|channel| {
            let node = channel.target as usize;
            let target = match channel.property {
                Property::Weights => self.node_morphs.get(&node).map(|&morph| to_u32(morph)),
                _ => self.attachments[node].node.filter(|_| moved[node]),
            };
            channel.target = target.unwrap_or_default();
            target.is_some()
        });
        clip
    }

    /// Returns a binder for the vertices of a node's mesh.
    pub(super) fn node<'a>(&'a mut self, node: usize, skin: Option<&'a SkinJoints>) -> NodeBinder<'a> {
        for &joint in skin.map_or(&[][..], |skin| &skin.nodes) {
            if let Some(Attachment { node: Some(node), .. }) = self.attachments.get(joint) {
                self.rig.nodes[*node as usize].is_joint = true;
            }
        }
        let skin_joints = vec![None; skin.map_or(0, |skin| skin.nodes.len())];
        NodeBinder { node, skin, skin_joints, binder: self }
    }

    /// Returns what moves something that is on a node, in the node's own space.
    pub(super) fn mount(&self, node: usize) -> Joint {
        let Attachment { node, below } = self.attachments.get(node).copied().unwrap_or_default();
        Joint { node, offset: below, ..Joint::default() }
    }

    /// Gives up building a rig. The first reason is reported.
    pub(super) fn give_up(&mut self, reason: String) {
        self.problem.get_or_insert(reason);
    }

    /// Builds the rig of a mesh whose corners have these bindings, and puts corners below nodes that are scaled to nothing at rest where
    /// they are then. If no rig can be built, returns a warning.
    fn finish(mut self, mesh: &mut Mesh, corners: &[u32]) -> Result<Rig, String> {
        let mut rig = std::mem::take(&mut self.rig);
        if self.problem.is_none() {
            self.bind_corners(&mut rig, mesh, corners);
        }
        self.grown.iter().for_each(|(node, rest)| rig.nodes[*node as usize].rest = *rest);
        let rest = rig.rest();
        if self.problem.is_some() {
            mesh.bones = mesh.bones_in(Some(&rest));
        }
        for (corner, &id) in mesh.corners.iter_mut().zip(corners) {
            let binding = self.bound.get(id as usize).map(|bound| &bound.binding);
            if let Some(binding) = binding.filter(|own| is_moved_by(own, &rig.joints, &self.is_grown)) {
                corner.position = posed(binding, &rig.deltas, &rest);
            }
        }
        self.problem.map_or(Ok(rig), |problem| Err(format!("animations are left out: {problem}.")))
    }

    /// Finishes a mesh whose corners have these numbers, with their details and its rig.
    ///
    /// # Errors
    /// Those of [`tangents::with_details`].
    pub(super) fn complete(
        mesh: &mut Mesh,
        mut numbers: Vec<u32>,
        details: Option<DetailTable>,
        binder: Option<Self>,
        notes: &mut Notes,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<(), BuildError> {
        if let Some(details) = details {
            numbers = tangents::with_details(mesh, details, &numbers, notes, budget, progress)?;
        }
        match binder.map(|binder| binder.finish(mesh, &numbers)) {
            Some(Ok(rig)) => mesh.rig = Some(Arc::new(rig)),
            Some(Err(warning)) => notes.push(warning),
            None => {}
        }
        Ok(())
    }

    fn bind_corners(&self, rig: &mut Rig, mesh: &Mesh, corners: &[u32]) {
        rig.bindings = corners.iter().map(|&id| self.bound[id as usize].binding).collect();
        rig.alike = corners.iter().map(|&id| self.bound[id as usize].alike).collect();
        let rest = rig.rest();
        for ((binding, corner), &id) in rig.bindings.iter_mut().zip(&mesh.corners).zip(corners) {
            if self.bound[id as usize].without_normal {
                let own = &rig.deltas[binding.first_delta as usize..][..binding.delta_count as usize];
                let turned = own.iter().map(|delta| Vec3::from(delta.normal) * rest.weights[delta.weight as usize]);
                binding.normal = (untwisted(binding, &rest, corner.normal) - turned.sum::<Vec3>()).to_array();
            }
        }
        if let Some(details) = mesh.details.as_ref().filter(|details| has_tangents(details)) {
            let bindings = rig.bindings.iter().zip(details.iter()).zip(corners);
            let tangent = |((binding, detail), &id): ((&Binding, &CornerDetail), &u32)| {
                let tangent = unturned(binding, &rig.deltas, &rest, detail);
                let [x, y, z] = self.bound[id as usize].tangent.unwrap_or([tangent[0], tangent[1], tangent[2]]);
                [x, y, z, tangent[3]]
            };
            rig.tangents = bindings.map(tangent).collect();
        }
        refer_to_tangents(rig, &self.tangent_deltas);
        rig.reach = Reach::new(&rig.bindings, &rig.deltas, &self.tangent_deltas);
    }

    /// Binds the points that a cage is refined to, as combinations of what the cage's points are bound to, by the numbers of `cage`:
    /// their positions, weights and displacements are those of the limit. Of a point's joints the four with the largest weights are
    /// used, and its normal is computed from the one that its corner gets. Returns the points' numbers.
    ///
    /// # Errors
    /// [`MemoryRefused`] and [`Cancelled`].
    pub(super) fn bind_refined<E: From<MemoryRefused> + From<Cancelled>>(
        &mut self,
        refinement: &Refinement,
        cage: &[u32],
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Vec<u32>, E> {
        let ask = |count: usize, each: u64| {
            progress.check()?;
            Ok::<(), E>(budget.hold(count as u64 * each)?)
        };
        let binding = |&id: &u32| self.bound.get(id as usize).map_or_else(Binding::default, |bound| bound.binding);
        let cage: Vec<Binding> = cage.iter().map(binding).collect();
        let vector = |vector: [f32; 3]| Vec3::from(vector).as_dvec3();
        let positions = refinement.refine(&cage.iter().map(|own| vector(own.position)).collect::<Vec<_>>());
        let positions = refinement.limit(&positions).values();
        // What isn't used of a vertex's joints comes last, and has no weight.
        let hung = |own: &Binding| own.joints.into_iter().zip(own.weights.map(f64::from)).collect();
        // Memory for joints is held with the points.
        let joints = refinement.limit_of_some(&cage.iter().map(hung).collect::<Vec<_>>(), |count| ask(count, 0))?;
        // A target moves positions under an even number, and turns normals under an odd one.
        let displaced = |own: &Binding| {
            let deltas = &self.rig.deltas[own.first_delta as usize..][..own.delta_count as usize];
            let both = |delta: &Delta| [(2 * delta.weight, delta.position), (2 * delta.weight + 1, delta.normal)];
            deltas.iter().flat_map(both).map(|(number, own)| (number, vector(own))).collect()
        };
        let displaced: Vec<Vec<(u32, DVec3)>> = cage.iter().map(displaced).collect();
        let displaced = refinement.limit_of_some(&displaced, |count| ask(count, PER_DELTA))?;
        let points = positions.into_iter().zip(joints).zip(displaced);
        Ok(points.map(|((position, joints), displaced)| self.bind_point(position, joints, &displaced)).collect())
    }

    /// Binds a refined point; joints' weights needn't add up to 1.
    fn bind_point(&mut self, position: DVec3, mut joints: Vec<(u32, f64)>, displaced: &[(u32, DVec3)]) -> u32 {
        if self.problem.is_some() {
            return u32::MAX;
        }
        joints.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        joints.truncate(4);
        joints.sort_by_key(|(joint, _)| *joint);
        let sum: f64 = joints.iter().map(|(_, weight)| weight).sum();
        let mut binding = Binding { position: position.as_vec3().to_array(), ..Binding::default() };
        for (k, (joint, weight)) in joints.into_iter().enumerate() {
            (binding.joints[k], binding.weights[k]) = (joint, to_f32(weight / sum));
        }
        let deltas = displaced.chunk_by(|a, b| a.0 / 2 == b.0 / 2).map(|own| {
            let part = |odd| own.iter().find(|own| own.0 % 2 == odd).map_or([0.0; 3], |own| own.1.as_vec3().to_array());
            Delta { position: part(0), weight: own[0].0 / 2, normal: part(1), tangent: 0 }
        });
        let bound = BoundVertex { binding, alike: 0, without_normal: true, tangent: None };
        self.bind(bound, &deltas.collect::<Vec<_>>(), &[])
    }

    fn joint(&mut self, joint: Joint) -> u32 {
        let bits = |matrix: DMat4| matrix.to_cols_array().map(|x| (x + 0.0).to_bits());
        let key = (joint.node, [joint.offset, joint.place].map(bits));
        *self.joint_ids.entry(key).or_insert_with(|| {
            self.rig.joints.push(joint);
            to_u32(self.rig.joints.len()) - 1
        })
    }

    fn list(&mut self, list: Vec<u32>) -> u32 {
        let next = to_u32(self.lists.len());
        *self.lists.entry(list).or_insert(next)
    }

    /// Returns the number of a binding; equal bindings have the same number. `tangents` has what each of `deltas` adds to the
    /// tangent if that is displaced.
    fn bind(&mut self, mut bound: BoundVertex, deltas: &[Delta], tangents: &[[f32; 3]]) -> u32 {
        let bits = |v: [f32; 3]| v.map(|x| (x + 0.0).to_bits());
        let Binding { position, normal, joints, weights, .. } = bound.binding;
        let list = |vector: fn(&Delta) -> [f32; 3]| {
            let deltas = deltas.iter().filter(move |delta| vector(delta) != [0.0; 3]);
            deltas.flat_map(move |delta| [delta.weight].into_iter().chain(bits(vector(delta))))
        };
        let hung = joints.into_iter().chain(weights.map(f32::to_bits));
        // What has one position at rest only because it is scaled to nothing doesn't stay together.
        let is_grown = is_moved_by(&bound.binding, &self.rig.joints, &self.is_grown);
        let hung = hung.chain(bits(position).into_iter().filter(|_| is_grown));
        bound.alike = self.list(hung.chain(list(|delta| delta.position)).collect());
        // No weight has the number that the tangents begin with.
        let displaced = bound.tangent.into_iter().flat_map(|tangent| {
            let added = deltas.iter().zip(tangents);
            let added = added.flat_map(|(delta, added)| [delta.weight].into_iter().chain(bits(*added)));
            [u32::MAX].into_iter().chain(bits(tangent)).chain(added)
        });
        let turned = self.list(list(|delta| delta.normal).chain(displaced).collect());
        let ([x, y, z], [a, b, c]) = (bits(position), bits(normal));
        let next = to_u32(self.bound.len());
        let id = *self.bound_ids.entry([bound.alike, turned, x, y, z, a, b, c]).or_insert(next);
        if id == next {
            bound.binding.first_delta = to_u32(self.rig.deltas.len());
            bound.binding.delta_count = to_u32(deltas.len());
            let first = to_u32(self.tangent_deltas.len()) + 1;
            let numbers = (first..first + to_u32(tangents.len())).chain(std::iter::repeat(0));
            self.rig.deltas.extend(deltas.iter().zip(numbers).map(|(delta, tangent)| Delta { tangent, ..*delta }));
            self.tangent_deltas.extend_from_slice(tangents);
            self.bound.push(bound);
        }
        if self.bound.len().max(self.rig.deltas.len()) > MAX_BOUND {
            self.give_up(format!("there are more than {MAX_BOUND} vertices, or displacements of them"));
        }
        id
    }
}

/// Returns these joints as bones, each once, parents before children. What no clip moves is where `global` has it. `name` gives a
/// node's name, if it has one.
pub(super) fn bones<'a>(
    joints: impl Iterator<Item = usize>,
    name: impl Fn(usize) -> Option<&'a str>,
    scene: &SceneNodes,
    global: &[DMat4],
    binder: Option<&RigBuilder>,
) -> Vec<Bone> {
    let parents = &scene.parents;
    let mut is_joint = vec![false; parents.len()];
    joints.for_each(|joint| is_joint[joint] = true);
    // Of each node the bone that it is, or else the nearest one above it.
    let mut nearest: Vec<Option<u32>> = vec![None; parents.len()];
    let mut bones = Vec::new();
    for &node in &scene.order {
        let parent = parents[node].and_then(|parent| nearest[parent]);
        nearest[node] = if is_joint[node] { Some(to_u32(bones.len())) } else { parent };
        if is_joint[node] {
            let name = name(node).map_or_else(|| format!("node {node}"), shown).into();
            let still = || Joint { offset: global[node], ..Joint::default() };
            let Joint { node, offset, .. } = binder.map_or_else(still, |binder| binder.mount(node));
            bones.push(Bone { name, node, place: offset.w_axis.truncate().as_vec3(), parent });
        }
    }
    bones
}

/// Puts the displacements of tangents behind the tangents of a rig, and lets its deltas refer to them there. They are left out
/// if the rig has no tangents.
fn refer_to_tangents(rig: &mut Rig, displacements: &[[f32; 3]]) {
    let first = to_u32(rig.tangents.len());
    for delta in &mut rig.deltas {
        delta.tangent = if first > 0 && delta.tangent > 0 { first + delta.tangent - 1 } else { 0 };
    }
    if first > 0 {
        rig.tangents.extend(displacements.iter().map(|&[x, y, z]| [x, y, z, 0.0]));
    }
}

/// Whether one of these nodes moves a vertex.
fn is_moved_by(binding: &Binding, joints: &[Joint], nodes: &[bool]) -> bool {
    let moving = binding.joints.iter().zip(binding.weights).filter(|(_, weight)| *weight > 0.0);
    moving.filter_map(|(joint, _)| joints[*joint as usize].node).any(|node| nodes[node as usize])
}

fn has_tangents(details: &CornerDetails) -> bool {
    details.iter().any(|detail| detail.tangent != Vec3::ZERO)
}

/// Binds the vertices of one node's mesh.
pub(super) struct NodeBinder<'a> {
    node: usize,
    skin: Option<&'a SkinJoints>,
    /// For each joint of the skin, its index in the palette once it is used.
    skin_joints: Vec<Option<u32>>,
    /// What the vertices of all nodes are bound to.
    pub binder: &'a mut RigBuilder,
}

/// A vertex before it is deformed.
pub(super) struct UndeformedVertex<'a> {
    pub position: Vec3,
    pub normal: Vec3,
    /// The joints of its skin that move it, with their weights; none if they are unusable.
    pub influences: Option<&'a [(usize, f64)]>,
    /// Its displacements by morph targets.
    pub deltas: &'a mut [Delta],
    /// Its tangent, and what each of these displacements adds to it; none if the tangent turns along with the normal.
    pub tangent: Option<(Vec3, &'a mut [[f32; 3]])>,
}

/// The joint and the space of a primitive's vertices. Skinned vertices have joints of their own.
pub(super) struct VertexFrame {
    rigid: Option<u32>,
    space: BindingSpace,
}

impl NodeBinder<'_> {
    /// Returns where the node's weights start if a clip changes them. Its morph targets are then applied in each pose,
    /// and not once at rest.
    pub(super) fn first_weight(&self) -> Option<u32> {
        let morph = self.binder.node_morphs.get(&self.node)?;
        Some(self.binder.rig.morphs[*morph].first_weight)
    }

    /// Counts elements of morph targets that are about to be read.
    ///
    /// # Errors
    /// A clause if there are too many.
    pub(super) fn look_at(&mut self, elements: usize) -> Result<(), String> {
        self.binder.displaced = self.binder.displaced.saturating_add(elements);
        if self.binder.displaced > MAX_DISPLACED {
            return Err(format!("morph targets have more than {MAX_DISPLACED} elements"));
        }
        Ok(())
    }

    /// Returns the joint and the space of a mesh's vertices; `to_node` takes them to the node's own space.
    pub(super) fn frame(&mut self, is_skinned: bool, to_node: DMat4) -> VertexFrame {
        let attachment = self.binder.attachments[self.node];
        if is_skinned {
            return VertexFrame { rigid: None, space: BindingSpace::new(DMat4::IDENTITY) };
        }
        let rigid = self.binder.joint(Joint { node: attachment.node, ..Joint::default() });
        VertexFrame { rigid: Some(rigid), space: BindingSpace::new(attachment.below * to_node) }
    }

    /// Returns how many displacements are stored, of all vertices together.
    pub(super) fn deltas(&self) -> usize {
        self.binder.rig.deltas.len()
    }

    /// Returns the number of a vertex's binding. `corner` is the vertex at rest.
    pub(super) fn bind(&mut self, frame: &VertexFrame, vertex: UndeformedVertex, corner: &InputCorner) -> u32 {
        let (joints, weights) = match frame.rigid {
            Some(joint) => ([joint, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
            None => self.influences(vertex.influences.unwrap_or_default()),
        };
        let without_normal = corner.normal.is_none_or(|normal| GivenNormal::new(normal).unit().is_none());
        let normal = if without_normal { Vec3::ZERO } else { vertex.normal };
        if without_normal {
            vertex.deltas.iter_mut().for_each(|delta| delta.normal = [0.0; 3]);
        }
        let (position, normal) = frame.space.take(vertex.position, normal, vertex.deltas);
        let binding = Binding { position, normal, joints, weights, ..Binding::default() };
        let mut bound = BoundVertex { binding, alike: 0, without_normal, tangent: None };
        if self.binder.problem.is_some() {
            // Without a rig, only what has grown is bound, to be put back. Others have the number of no binding.
            let is_grown = is_moved_by(&bound.binding, &self.binder.rig.joints, &self.binder.is_grown);
            return if is_grown { self.binder.bind(bound, &[], &[]) } else { u32::MAX };
        }
        let Some((tangent, displacements)) = vertex.tangent.filter(|_| !without_normal) else {
            return self.binder.bind(bound, vertex.deltas, &[]);
        };
        bound.tangent = frame.space.take_tangent(tangent, displacements);
        let displacements: &[_] = if bound.tangent.is_some() { displacements } else { &[] };
        self.binder.bind(bound, vertex.deltas, displacements)
    }

    /// Returns a skinned vertex's joints, each once and in the palette's order, with weights that add up to 1.
    fn influences(&mut self, found: &[(usize, f64)]) -> ([u32; 4], [f32; 4]) {
        let mut slots: Vec<(u32, f64)> = Vec::with_capacity(4);
        for &(joint, weight) in found {
            let id = self.skin_joint(joint);
            match slots.iter_mut().find(|(known, _)| *known == id) {
                Some((_, sum)) => *sum += weight,
                None => slots.push((id, weight)),
            }
        }
        slots.sort_unstable_by_key(|(id, _)| *id);
        if slots.is_empty() {
            // The vertex stays where it is at rest.
            slots.push((self.binder.joint(Joint::default()), 1.0));
        }
        let (mut joints, mut weights) = ([0; 4], [0.0; 4]);
        for (i, (joint, weight)) in slots.into_iter().enumerate().take(4) {
            (joints[i], weights[i]) = (joint, to_f32(weight));
        }
        (joints, weights)
    }

    fn skin_joint(&mut self, joint: usize) -> u32 {
        if let Some(Some(id)) = self.skin_joints.get(joint) {
            return *id;
        }
        let of_skin = self.skin.and_then(|skin| Some((*skin.nodes.get(joint)?, *skin.inverse_binds.get(joint)?)));
        let (node, inverse_bind) = of_skin.unwrap_or((usize::MAX, DMat4::IDENTITY));
        let Attachment { node, below } = self.binder.attachments.get(node).copied().unwrap_or_default();
        let place = self.skin.map_or(DMat4::IDENTITY, |skin| skin.place);
        let id = self.binder.joint(Joint { node, offset: below * inverse_bind, place });
        if let Some(known) = self.skin_joints.get_mut(joint) {
            *known = Some(id);
        }
        id
    }
}
