//! What a mesh becomes besides triangles if it can move: nodes and skins as joints, vertices as bindings to them.

use std::collections::HashMap;

use ::gltf::Document;
use glam::{DMat4, Vec3};

use super::hanging::{Hang, carries_shown, hang};
use super::nodes::{self, Placed};
use super::skin;
use super::space::{Space, untwisted};
use crate::mesh::Mesh;
use crate::mesh::mesh_builder::LooseCorner;
use crate::mesh::normals::Given;
use crate::mesh::rig::{Binding, Clip, Delta, Joint, Morph, Mover, Property, Reach, Rig};

/// Vertices, and displacements of them, that are bound at most: no memory is taken out of proportion.
pub const MAX_BOUND: usize = 1 << 24;
/// Elements of morph targets that are looked at.
const MAX_DISPLACED: usize = 1 << 28;

/// Gathers bindings, node by node, and makes a [`Rig`] of them.
pub struct Binder {
    /// Their targets are movers and morphs.
    clips: Vec<Clip>,
    movers: Vec<Mover>,
    /// What moves each node of the document, and how the node stands beneath that.
    hangs: Vec<Hang>,
    morphs: Vec<Morph>,
    /// Of nodes whose morph targets' weights a clip changes.
    node_morphs: HashMap<usize, usize>,
    joints: Vec<Joint>,
    joint_ids: HashMap<(Option<u32>, [u64; 16]), u32>,
    bound: Vec<Bound>,
    bound_ids: HashMap<[u32; 8], u32>,
    /// Numbers of lists that are told apart.
    lists: HashMap<Vec<u32>, u32>,
    deltas: Vec<Delta>,
    /// Elements of morph targets that have been looked at.
    displaced: usize,
    /// Why there can be no rig.
    problem: Option<String>,
}

/// A vertex to be deformed.
struct Bound {
    binding: Binding,
    alike: u32,
    /// Whether its normal is to be found from the one that its corner gets.
    without_normal: bool,
}

impl Binder {
    /// None if none of the clips (whose targets are nodes of the document) moves anything that is shown; those that don't
    /// are among the warnings.
    pub fn new(clips: Vec<Clip>, document: &Document, placed: &Placed, warnings: &mut Vec<String>) -> Option<Self> {
        if clips.is_empty() {
            return None;
        }
        let mut moved = vec![false; placed.global.len()];
        for channel in clips.iter().flat_map(|clip| &clip.channels) {
            moved[channel.target as usize] |= channel.property != Property::Weights;
        }
        let carries = carries_shown(document, placed);
        moved.iter_mut().zip(&carries).for_each(|(moved, carries)| *moved &= carries);
        let (movers, hangs) = hang(document, placed, &moved);
        let mut binder = Self {
            clips: Vec::new(),
            movers,
            hangs,
            morphs: Vec::new(),
            node_morphs: HashMap::new(),
            joints: Vec::new(),
            joint_ids: HashMap::new(),
            bound: Vec::new(),
            bound_ids: HashMap::new(),
            lists: HashMap::new(),
            deltas: Vec::new(),
            displaced: 0,
            problem: None,
        };
        binder.add_morphs(&clips, document, placed);
        for clip in clips {
            let (name, clip) = (clip.name.clone(), binder.retargeted(clip, &moved));
            if clip.channels.is_empty() {
                warnings.push(format!("animation \"{name}\" moves nothing that is shown; it is left out."));
            } else {
                binder.clips.push(clip);
            }
        }
        (!binder.clips.is_empty()).then_some(binder)
    }

    /// The nodes that are shown and whose weights a clip changes.
    fn add_morphs(&mut self, clips: &[Clip], document: &Document, placed: &Placed) {
        let mut weighed = vec![false; placed.global.len()];
        for channel in clips.iter().flat_map(|clip| &clip.channels) {
            weighed[channel.target as usize] |= channel.property == Property::Weights;
        }
        let mut first_weight = 0;
        for &index in placed.shown.iter().filter(|&&node| weighed[node]) {
            let Some(node) = document.nodes().nth(index) else { continue };
            let mut rest = super::weights(&node).to_vec();
            rest.resize(nodes::target_count(&node), 0.0);
            self.node_morphs.insert(index, self.morphs.len());
            self.morphs.push(Morph { first_weight, rest });
            first_weight += self.morphs.last().map_or(0, |morph| morph.rest.len() as u32);
        }
    }

    /// The clip with those channels that move something shown, and their targets.
    fn retargeted(&self, mut clip: Clip, moved: &[bool]) -> Clip {
        clip.channels.retain_mut(|channel| {
            let node = channel.target as usize;
            let target = match channel.property {
                Property::Weights => self.node_morphs.get(&node).map(|&morph| morph as u32),
                _ => self.hangs[node].mover.filter(|_| moved[node]),
            };
            channel.target = target.unwrap_or_default();
            target.is_some()
        });
        clip
    }

    /// For the vertices of a node's mesh.
    pub fn node<'a>(&'a mut self, node: usize, skin: Option<&'a skin::Joints>) -> NodeBinder<'a> {
        for &joint in skin.map_or(&[][..], |skin| &skin.nodes) {
            if let Some(Hang { mover: Some(mover), .. }) = self.hangs.get(joint) {
                self.movers[*mover as usize].is_joint = true;
            }
        }
        let skin_joints = vec![None; skin.map_or(0, |skin| skin.nodes.len())];
        NodeBinder { node, skin, skin_joints, binder: self }
    }

    /// There will be no rig. The first reason stays.
    fn give_up(&mut self, reason: String) {
        self.problem.get_or_insert(reason);
    }

    /// The rig of a mesh whose corners have these bindings; a warning in its place if there can't be one.
    pub fn finish(self, mesh: &Mesh, corners: &[u32]) -> Result<Rig, String> {
        if let Some(problem) = self.problem {
            return Err(format!("animations are left out: {problem}."));
        }
        let mut rig = Rig {
            bindings: corners.iter().map(|&id| self.bound[id as usize].binding).collect(),
            alike: corners.iter().map(|&id| self.bound[id as usize].alike).collect(),
            deltas: self.deltas,
            movers: self.movers,
            joints: self.joints,
            morphs: self.morphs,
            clips: self.clips,
            reach: Reach::default(),
        };
        let rest = rig.rest();
        for ((binding, corner), &id) in rig.bindings.iter_mut().zip(&mesh.corners).zip(corners) {
            if self.bound[id as usize].without_normal {
                binding.normal = untwisted(binding, &rest, corner.normal).to_array();
            }
        }
        rig.reach = Reach::of(&rig.bindings, &rig.deltas);
        Ok(rig)
    }

    fn joint(&mut self, joint: Joint) -> u32 {
        let key = (joint.mover, joint.offset.to_cols_array().map(|x| (x + 0.0).to_bits()));
        *self.joint_ids.entry(key).or_insert_with(|| {
            self.joints.push(joint);
            self.joints.len() as u32 - 1
        })
    }

    fn list(&mut self, list: Vec<u32>) -> u32 {
        let next = self.lists.len() as u32;
        *self.lists.entry(list).or_insert(next)
    }

    /// The number of a binding; equal ones have the same.
    fn bind(&mut self, mut bound: Bound, deltas: &[Delta]) -> u32 {
        let bits = |v: [f32; 3]| v.map(|x| (x + 0.0).to_bits());
        let Binding { position, normal, joints, weights, .. } = bound.binding;
        let list = |vector: fn(&Delta) -> [f32; 3]| {
            let deltas = deltas.iter().filter(move |delta| vector(delta) != [0.0; 3]);
            deltas.flat_map(move |delta| [delta.weight].into_iter().chain(bits(vector(delta))))
        };
        let hung = joints.into_iter().chain(weights.map(f32::to_bits));
        bound.alike = self.list(hung.chain(list(|delta| delta.position)).collect());
        let turned = self.list(list(|delta| delta.normal).collect());
        let ([x, y, z], [a, b, c]) = (bits(position), bits(normal));
        let next = self.bound.len() as u32;
        let id = *self.bound_ids.entry([bound.alike, turned, x, y, z, a, b, c]).or_insert(next);
        if id == next {
            bound.binding.first_delta = self.deltas.len() as u32;
            bound.binding.delta_count = deltas.len() as u32;
            self.deltas.extend_from_slice(deltas);
            self.bound.push(bound);
        }
        if self.bound.len().max(self.deltas.len()) > MAX_BOUND {
            self.give_up(format!("there are more than {MAX_BOUND} vertices, or displacements of them"));
        }
        id
    }
}

/// Binds the vertices of one node's mesh.
pub struct NodeBinder<'a> {
    node: usize,
    skin: Option<&'a skin::Joints>,
    /// The palette's indices of the skin's joints that have been met.
    skin_joints: Vec<Option<u32>>,
    binder: &'a mut Binder,
}

/// A vertex, not deformed.
pub struct Undeformed<'a> {
    pub position: Vec3,
    pub normal: Vec3,
    /// The joints of its skin that move it; none if they are unusable.
    pub influences: Option<&'a [(usize, f64)]>,
    /// What morph targets add to it.
    pub deltas: &'a mut [Delta],
}

/// What a primitive's vertices are bound to, if they have no joints of a skin, and from where.
pub struct Frame {
    rigid: Option<u32>,
    space: Space,
}

impl NodeBinder<'_> {
    /// Where the node's weights start, if a clip changes them: its morph targets aren't added once and for all then.
    pub fn first_weight(&self) -> Option<u32> {
        let morph = self.binder.node_morphs.get(&self.node)?;
        Some(self.binder.morphs[*morph].first_weight)
    }

    /// Counts elements of morph targets that are about to be read.
    ///
    /// # Errors
    /// In words: there are too many.
    pub fn look_at(&mut self, elements: usize) -> Result<(), String> {
        self.binder.displaced = self.binder.displaced.saturating_add(elements);
        if self.binder.displaced > MAX_DISPLACED {
            return Err(format!("morph targets have more than {MAX_DISPLACED} elements"));
        }
        Ok(())
    }

    /// There will be no rig. The first reason stays.
    pub fn give_up(&mut self, reason: String) {
        self.binder.give_up(reason);
    }

    /// For a primitive's vertices.
    pub fn frame(&mut self, is_skinned: bool) -> Frame {
        let hang = self.binder.hangs[self.node];
        if is_skinned {
            return Frame { rigid: None, space: Space::new(DMat4::IDENTITY) };
        }
        let rigid = self.binder.joint(Joint { mover: hang.mover, offset: DMat4::IDENTITY });
        Frame { rigid: Some(rigid), space: Space::new(hang.below) }
    }

    /// The number of a vertex's binding. `corner` is the vertex at rest.
    pub fn bind(&mut self, frame: &Frame, vertex: Undeformed, corner: &LooseCorner) -> u32 {
        if self.binder.problem.is_some() {
            return 0;
        }
        let (joints, weights) = match frame.rigid {
            Some(joint) => ([joint, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
            None => self.influences(vertex.influences.unwrap_or_default()),
        };
        let without_normal = corner.normal.is_none_or(|normal| Given::new(normal).unit().is_none());
        let normal = if without_normal { Vec3::ZERO } else { vertex.normal };
        if without_normal {
            vertex.deltas.iter_mut().for_each(|delta| delta.normal = [0.0; 3]);
        }
        let (position, normal) = frame.space.take(vertex.position, normal, vertex.deltas);
        let binding = Binding { position, normal, joints, weights, ..Binding::default() };
        self.binder.bind(Bound { binding, alike: 0, without_normal }, vertex.deltas)
    }

    /// A skinned vertex's joints in the palette's order, each once, with weights that sum to 1.
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
            // As the vertex stands at rest: where its mesh has it.
            slots.push((self.binder.joint(Joint { mover: None, offset: DMat4::IDENTITY }), 1.0));
        }
        let (mut joints, mut weights) = ([0; 4], [0.0; 4]);
        for (i, (joint, weight)) in slots.into_iter().enumerate().take(4) {
            (joints[i], weights[i]) = (joint, weight as f32);
        }
        (joints, weights)
    }

    fn skin_joint(&mut self, joint: usize) -> u32 {
        if let Some(Some(id)) = self.skin_joints.get(joint) {
            return *id;
        }
        let of_skin = self.skin.and_then(|skin| Some((*skin.nodes.get(joint)?, *skin.inverse_binds.get(joint)?)));
        let (node, inverse_bind) = of_skin.unwrap_or((usize::MAX, DMat4::IDENTITY));
        let hang = self.binder.hangs.get(node).copied().unwrap_or(Hang { mover: None, below: DMat4::IDENTITY });
        let id = self.binder.joint(Joint { mover: hang.mover, offset: hang.below * inverse_bind });
        if let Some(known) = self.skin_joints.get_mut(joint) {
            *known = Some(id);
        }
        id
    }
}
