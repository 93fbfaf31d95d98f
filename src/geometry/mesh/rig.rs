//! Animation of a mesh: its corners before they are deformed, the nodes that move them, and clips that say how those
//! nodes move over time.
//!
//! A corner is bound to up to four *joints*: matrices of one palette. Each joint of a skin is one. So is each animated
//! node, for the meshes attached to it or below it. What no clip moves is bound to the identity matrix.
//!
//! Source: Khronos, glTF 2.0 specification, sections 3.7.2.2 (morph targets), 3.7.3 (skins) and 3.11 (animations).

mod animated_node;
pub mod clip;

use crate::casts::to_f32;
use crate::numbers::counted;
use std::fmt;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, Vec3};
use serde::Serialize;

pub use animated_node::{AnimatedNode, Placement};
pub use clip::{Channel, Clip, Interpolation, Keys, Property};

/// A mesh's bindings to joints and morph targets, and the clips that move those.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// One binding for each of the mesh's corners.
    pub bindings: Vec<Binding>,
    /// For each binding, the corner's tangent (see [`CornerDetail`](super::CornerDetail)) in the space that its joints' matrices
    /// start from, and the sign of its bitangent there. Behind them are what morph targets of weight 1 add to tangents, to which
    /// `deltas` refer. Empty without tangents.
    pub tangents: Vec<[f32; 4]>,
    /// The displacements by morph targets: one part for each binding, with an entry for each target that moves or turns
    /// it.
    pub deltas: Vec<Delta>,
    /// Corners at one position with the same number here stay together in every pose: they have the same joints,
    /// weights and displacements.
    pub alike: Vec<u32>,
    /// The animated nodes, parents before children.
    pub nodes: Vec<AnimatedNode>,
    /// The matrices of the palette.
    pub joints: Vec<Joint>,
    /// One for each node with morph targets.
    pub morphs: Vec<Morph>,
    /// The clips that move something.
    pub clips: Vec<Clip>,
    /// What moves each of the mesh's lights, which are at the origin and shine along -Z there. Empty if no clip does.
    pub lights: Vec<Joint>,
    /// The same for its cameras, which look along -Z.
    pub cameras: Vec<Joint>,
    /// Bounds on the coordinates before deformation.
    pub reach: Reach,
}

/// The largest coordinates of the data that poses deform.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// The largest coordinate of a position.
    position: f64,
    /// The largest coordinate of a displacement of a position, normal or tangent, by a morph target of weight 1.
    delta: f64,
}

/// A corner before it is deformed, in the space that the matrices of its joints start from. The shaders use this struct
/// too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Binding {
    pub position: [f32; 3],
    pub first_delta: u32,
    /// Not of unit length if morph targets are added to it.
    pub normal: [f32; 3],
    pub delta_count: u32,
    /// Indices into the palette; 0 where the weight is 0.
    pub joints: [u32; 4],
    /// They add up to 1.
    pub weights: [f32; 4],
}

/// What a morph target of weight 1 adds to a corner. The shaders use this struct too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Delta {
    pub position: [f32; 3],
    /// Index into [`Pose::weights`].
    pub weight: u32,
    pub normal: [f32; 3],
    /// Index into [`Rig::tangents`] of what the target adds to the tangent. Either all deltas of a corner have one, or all have 0:
    /// then its tangent turns along with its normal.
    pub tangent: u32,
}

/// The first three rows of a matrix whose fourth row is (0, 0, 0, 1). The shaders use this struct too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct JointMatrix {
    pub x: [f32; 4],
    pub y: [f32; 4],
    pub z: [f32; 4],
}

impl JointMatrix {
    fn new(matrix: DMat4) -> Self {
        let [x, y, z] = [0, 1, 2].map(|row| matrix.row(row).as_vec4().to_array());
        Self { x, y, z }
    }

    pub fn rows(&self) -> [[f32; 4]; 3] {
        [self.x, self.y, self.z]
    }
}

/// A matrix of the palette: `offset`, followed by the transform of the animated node, and `place`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Joint {
    /// Index into [`Rig::nodes`]; none if no clip moves the joint.
    pub node: Option<u32>,
    pub offset: DMat4,
    /// Where a copy of a skinned mesh is, relative to the mesh that the joints move.
    pub place: DMat4,
}

/// A joint of a skin, to be shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bone {
    /// Its name, fit for display.
    pub name: Arc<str>,
    /// The animated node that moves it, if any.
    pub node: Option<u32>,
    /// In the space of that node; in object space without one.
    pub place: Vec3,
    /// The nearest joint above it: an index into the mesh's bones, lower than its own.
    pub parent: Option<u32>,
}

/// The morph targets of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Morph {
    /// Where the weights of these targets start in [`Pose::weights`].
    pub first_weight: u32,
    /// The weight of each target at rest.
    pub rest: Vec<f32>,
}

/// The state of all joints and morph targets at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    pub palette: Vec<JointMatrix>,
    /// The weights of all morph targets of all nodes. Never empty, so that a buffer for them can be bound.
    pub weights: Vec<f32>,
    /// The transforms of the mesh's lights and of its cameras to object space; empty if no clip moves any.
    pub lights: Vec<DMat4>,
    pub cameras: Vec<DMat4>,
    /// The transforms of the animated nodes to object space.
    pub nodes: Vec<DMat4>,
}

impl Pose {
    /// Returns how many joint matrices and how many morph weights there are.
    pub fn lengths(&self) -> [usize; 2] {
        [self.palette.len(), self.weights.len()]
    }
}

/// A time in a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Index into [`Rig::clips`].
    pub clip: usize,
    /// In seconds.
    pub time: f64,
}

/// Numbers of the things that a clip moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct AnimatedCounts {
    /// Joints of skins.
    pub joints: usize,
    /// Nodes that aren't joints.
    pub nodes: usize,
    /// Morph targets.
    pub targets: usize,
}

impl fmt::Display for AnimatedCounts {
    /// Writes the counts as text, leaving out those that are 0.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let counts = [(self.joints, "joint"), (self.nodes, "node"), (self.targets, "morph target")];
        let some = counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| counted(count as u64, what));
        f.write_str(&some.collect::<Vec<_>>().join(", "))
    }
}

/// The greatest coordinate of a pose, in object units. Control points, which are sums of several positions, then stay
/// within f32.
pub const LARGEST_COORDINATE: f32 = 1e37;

impl Rig {
    /// Finds a clip by name. If several have the name, it is the first one's; the second is `NAME#2`, and so on. If no
    /// clip has exactly this name, and one clip has it in other upper or lower case, that clip is found.
    pub fn clip(&self, name: &str) -> Option<usize> {
        let named = |name: &str, nth: usize| {
            self.clips.iter().enumerate().filter(|(_, clip)| clip.name == name).nth(nth).map(|(index, _)| index)
        };
        let of_several = || {
            let (name, number) = name.rsplit_once('#')?;
            named(name, number.parse::<usize>().ok()?.checked_sub(1)?)
        };
        let exact = named(name, 0).or_else(of_several);
        let mut alike =
            (0..self.clips.len()).filter(|clip| self.clips[*clip].name.to_lowercase() == name.to_lowercase());
        exact.or_else(|| alike.next().filter(|_| alike.next().is_none()))
    }

    /// Returns the name by which [`Self::clip`] finds a clip.
    ///
    /// # Panics
    /// If there are not so many clips.
    pub fn clip_name(&self, clip: usize) -> String {
        let name = &self.clips[clip].name;
        match self.clips[..clip].iter().filter(|other| other.name == *name).count() {
            0 => name.clone(),
            before => format!("{name}#{}", before + 1),
        }
    }

    /// Computes the pose at a moment. Before its first and after its last key frame, a channel keeps the value of that
    /// key frame. If coordinates would leave f32, the result is the pose at rest.
    pub fn pose(&self, Moment { clip, time }: Moment) -> Pose {
        let pose = self.posed(self.clips.get(clip).map_or(&[], |clip| &clip.channels), time);
        if self.is_held(&pose) { pose } else { self.rest() }
    }

    /// Returns the size of the rig, in bytes.
    pub fn bytes(&self) -> usize {
        let keys = |channel: &Channel| channel.keys.times.len() + channel.keys.values.len();
        let clips =
            self.clips.iter().flat_map(|clip| &clip.channels).map(|channel| size_of::<Channel>() + 4 * keys(channel));
        size_of_val(&self.bindings[..])
            + size_of_val(&self.tangents[..])
            + size_of_val(&self.deltas[..])
            + size_of_val(&self.alike[..])
            + size_of_val(&self.nodes[..])
            + size_of_val(&self.joints[..])
            + size_of_val(&self.lights[..])
            + size_of_val(&self.cameras[..])
            + clips.sum::<usize>()
    }

    /// Returns the pose without any clip.
    pub fn rest(&self) -> Pose {
        self.posed(&[], 0.0)
    }

    fn posed(&self, channels: &[Channel], time: f64) -> Pose {
        let mut placements: Vec<Placement> = self.nodes.iter().map(|node| node.rest).collect();
        let mut weights: Vec<f32> = self.morphs.iter().flat_map(|morph| morph.rest.iter().copied()).collect();
        if weights.is_empty() {
            weights.push(0.0);
        }
        for channel in channels {
            let target = channel.target as usize;
            if channel.property == Property::Weights {
                let first = self.morphs[target].first_weight as usize;
                channel.keys.sample(time, |i, value| weights[first + i] = to_f32(value));
            } else {
                placements[target].animate(channel, time);
            }
        }
        let global = self.global(&placements);
        let matrix =
            |joint: &Joint| joint.place * joint.node.map_or(joint.offset, |node| global[node as usize] * joint.offset);
        Pose {
            palette: self.joints.iter().map(|joint| JointMatrix::new(matrix(joint))).collect(),
            weights,
            lights: self.lights.iter().map(matrix).collect(),
            cameras: self.cameras.iter().map(matrix).collect(),
            nodes: global,
        }
    }

    /// Counts what a clip moves.
    pub fn animated_counts(&self, clip: &Clip) -> AnimatedCounts {
        let targets = |weights: bool| {
            let channels = clip.channels.iter().filter(|channel| (channel.property == Property::Weights) == weights);
            let mut targets: Vec<usize> = channels.map(|channel| channel.target as usize).collect();
            targets.sort_unstable();
            targets.dedup();
            targets
        };
        let nodes = targets(false);
        let joints = nodes.iter().filter(|&&node| self.nodes[node].is_joint).count();
        let morphs = targets(true);
        AnimatedCounts {
            joints,
            nodes: nodes.len() - joints,
            targets: morphs.iter().map(|&morph| self.morphs[morph].rest.len()).sum(),
        }
    }

    /// Returns how many joint matrices and how many morph weights a pose of this rig has.
    pub fn pose_lengths(&self) -> [usize; 2] {
        let weights: usize = self.morphs.iter().map(|morph| morph.rest.len()).sum();
        [self.joints.len(), weights.max(1)]
    }

    /// Returns the transform of each animated node to object space.
    fn global(&self, placements: &[Placement]) -> Vec<DMat4> {
        let mut global: Vec<DMat4> = Vec::with_capacity(self.nodes.len());
        for (node, placement) in self.nodes.iter().zip(placements) {
            let above = node.parent.map_or(DMat4::IDENTITY, |parent| global[parent as usize]);
            global.push(above * node.between * placement.matrix());
        }
        global
    }

    /// Returns whether all corners stay within [`LARGEST_COORDINATE`] in this pose, by bounds on their coordinates.
    fn is_held(&self, pose: &Pose) -> bool {
        let limit = f64::from(LARGEST_COORDINATE);
        let weights: f64 = pose.weights.iter().map(|weight| f64::from(weight.abs())).sum();
        let reach = self.reach.position + weights * self.reach.delta;
        let row_is_held = |[x, y, z, offset]: [f32; 4]| {
            let linear: f64 = [x, y, z].map(|x| f64::from(x.abs())).iter().sum();
            linear * reach + f64::from(offset.abs()) <= limit
        };
        reach <= limit && pose.palette.iter().flat_map(JointMatrix::rows).all(row_is_held)
    }
}

impl Reach {
    /// `tangents` are the displacements of tangents.
    pub fn new(bindings: &[Binding], deltas: &[Delta], tangents: &[[f32; 3]]) -> Self {
        let largest = |sum: f64, vector: &[f32; 3]| vector.iter().map(|x| f64::from(x.abs())).fold(sum, f64::max);
        let deltas = deltas.iter().flat_map(|delta| [&delta.position, &delta.normal]);
        Self {
            position: bindings.iter().map(|binding| &binding.position).fold(0.0, largest),
            delta: deltas.chain(tangents).fold(0.0, largest),
        }
    }
}

#[cfg(test)]
mod tests;
