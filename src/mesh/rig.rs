//! How a mesh moves: what its corners are before they are deformed, the nodes that move them, and clips that say where
//! those nodes are at a time.
//!
//! A corner hangs on up to four *joints*: matrices of one palette. A joint of a skin is one, and so is a node that a clip
//! moves, for all that hangs on it rigidly. What no clip moves hangs on the identity.
//!
//! Source: Khronos, glTF 2.0 specification, sections 3.7.2.2 (morph targets), 3.7.3 (skins) and 3.11 (animations).

mod clip;
mod mover;

use std::fmt;

use bytemuck::{Pod, Zeroable};
use glam::DMat4;
use serde::Serialize;

pub use clip::{Channel, Clip, Interpolation, Keys, Property};
pub use mover::{Mover, Placement};

/// A mesh's bindings to its joints and morph targets, and the clips that move those.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// One for each of the mesh's corners.
    pub bindings: Vec<Binding>,
    /// Each binding's own run, one a morph target that moves or turns it.
    pub deltas: Vec<Delta>,
    /// Corners at one position with the same number stay together in every pose: same joints, weights and displacements.
    pub alike: Vec<u32>,
    /// Parents before children.
    pub movers: Vec<Mover>,
    /// The palette's matrices.
    pub joints: Vec<Joint>,
    pub morphs: Vec<Morph>,
    /// Each moves something.
    pub clips: Vec<Clip>,
    pub reach: Reach,
}

/// The largest coordinates of what is deformed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    position: f64,
    /// Of positions and normals, by morph targets of weight 1.
    delta: f64,
}

/// A corner before it is deformed, in the space that its joints' matrices start from. Also the shaders' struct.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Binding {
    pub position: [f32; 3],
    pub first_delta: u32,
    /// Of any length, if morph targets are to be added.
    pub normal: [f32; 3],
    pub delta_count: u32,
    /// Indices into the palette; those without weight are 0.
    pub joints: [u32; 4],
    /// They sum to 1.
    pub weights: [f32; 4],
}

/// What a morph target of weight 1 adds to a corner. Also the shaders' struct.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Delta {
    pub position: [f32; 3],
    /// Index into [`Pose::weights`].
    pub weight: u32,
    pub normal: [f32; 3],
    pub _pad: f32,
}

/// The first three rows of a matrix, whose fourth is (0, 0, 0, 1). Also the shaders' struct.
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

/// A matrix of the palette: `offset`, then whatever moves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Index into [`Rig::movers`]; none if no clip moves it.
    pub mover: Option<u32>,
    pub offset: DMat4,
}

/// The morph targets of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Morph {
    /// Their run of [`Pose::weights`] starts here.
    pub first_weight: u32,
    /// One a target.
    pub rest: Vec<f32>,
}

/// Where everything is at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    pub palette: Vec<JointMatrix>,
    /// Of all morph targets of all nodes; never empty, so that there is something to bind.
    pub weights: Vec<f32>,
}

/// A clip and a time in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Index into [`Rig::clips`].
    pub clip: usize,
    /// s.
    pub time: f64,
}

/// What a clip moves, in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Moved {
    /// Joints of skins.
    pub joints: usize,
    /// Other nodes.
    pub nodes: usize,
    /// Morph targets.
    pub targets: usize,
}

impl fmt::Display for Moved {
    /// In words, without what there is none of.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let counts = [(self.joints, "joint"), (self.nodes, "node"), (self.targets, "morph target")];
        for (i, (count, what)) in counts.into_iter().filter(|(count, _)| *count > 0).enumerate() {
            let (comma, plural) = (if i > 0 { ", " } else { "" }, if count == 1 { "" } else { "s" });
            write!(f, "{comma}{count} {what}{plural}")?;
        }
        Ok(())
    }
}

/// In object units. Control points, which are sums of several positions, stay within f32.
pub const LARGEST_COORDINATE: f32 = 1e37;

impl Rig {
    /// The clip of this name; of several, the first, and the second is `NAME#2`. Without one, the only clip of this name but for
    /// its case.
    pub fn clip(&self, name: &str) -> Option<usize> {
        let named = |name: &str, nth: usize| {
            self.clips.iter().enumerate().filter(|(_, clip)| clip.name == name).nth(nth).map(|(index, _)| index)
        };
        let of_several = || {
            let (name, number) = name.rsplit_once('#')?;
            named(name, number.parse::<usize>().ok()?.checked_sub(1)?)
        };
        let exact = named(name, 0).or_else(of_several);
        let alike = |clip: &Clip| clip.name.to_lowercase() == name.to_lowercase();
        let only = || self.clips.iter().filter(|clip| alike(clip)).count() == 1;
        exact.or_else(|| self.clips.iter().position(alike).filter(|_| only()))
    }

    /// The name by which [`Self::clip`] finds a clip.
    pub fn clip_name(&self, clip: usize) -> String {
        let name = &self.clips[clip].name;
        match self.clips[..clip].iter().filter(|other| other.name == *name).count() {
            0 => name.clone(),
            before => format!("{name}#{}", before + 1),
        }
    }

    /// Where everything is at a moment. Before the first and after the last key a channel keeps its value. A pose in
    /// which coordinates would leave f32 is the one at rest.
    pub fn pose(&self, Moment { clip, time }: Moment) -> Pose {
        let mut placements: Vec<Placement> = self.movers.iter().map(|mover| mover.rest).collect();
        let mut weights = self.rest_weights();
        for channel in self.clips.get(clip).map_or(&[][..], |clip| &clip.channels) {
            let target = channel.target as usize;
            if channel.property == Property::Weights {
                let first = self.morphs[target].first_weight as usize;
                channel.keys.sample(time, |i, value| weights[first + i] = value as f32);
            } else {
                placements[target].animate(channel, time);
            }
        }
        let pose = Pose { palette: self.palette(&placements), weights };
        if self.is_held(&pose) { pose } else { self.rest() }
    }

    /// What it takes, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let keys = |channel: &Channel| channel.keys.times.len() + channel.keys.values.len();
        let clips =
            self.clips.iter().flat_map(|clip| &clip.channels).map(|channel| size_of::<Channel>() + 4 * keys(channel));
        size_of_val(&self.bindings[..])
            + size_of_val(&self.deltas[..])
            + size_of_val(&self.alike[..])
            + size_of_val(&self.movers[..])
            + size_of_val(&self.joints[..])
            + clips.sum::<usize>()
    }

    /// The pose without any clip.
    pub fn rest(&self) -> Pose {
        let placements: Vec<Placement> = self.movers.iter().map(|mover| mover.rest).collect();
        Pose { palette: self.palette(&placements), weights: self.rest_weights() }
    }

    /// What a clip moves.
    pub fn moved(&self, clip: &Clip) -> Moved {
        let targets = |weights: bool| {
            let channels = clip.channels.iter().filter(|channel| (channel.property == Property::Weights) == weights);
            let mut targets: Vec<usize> = channels.map(|channel| channel.target as usize).collect();
            targets.sort_unstable();
            targets.dedup();
            targets
        };
        let movers = targets(false);
        let joints = movers.iter().filter(|&&mover| self.movers[mover].is_joint).count();
        let morphs = targets(true);
        Moved {
            joints,
            nodes: movers.len() - joints,
            targets: morphs.iter().map(|&morph| self.morphs[morph].rest.len()).sum(),
        }
    }

    fn rest_weights(&self) -> Vec<f32> {
        let mut weights: Vec<f32> = self.morphs.iter().flat_map(|morph| morph.rest.iter().copied()).collect();
        if weights.is_empty() {
            weights.push(0.0);
        }
        weights
    }

    fn palette(&self, placements: &[Placement]) -> Vec<JointMatrix> {
        let mut global: Vec<DMat4> = Vec::with_capacity(self.movers.len());
        for (mover, placement) in self.movers.iter().zip(placements) {
            let above = mover.parent.map_or(DMat4::IDENTITY, |parent| global[parent as usize]);
            global.push(above * mover.between * placement.matrix());
        }
        let matrix = |joint: &Joint| {
            JointMatrix::new(joint.mover.map_or(joint.offset, |mover| global[mover as usize] * joint.offset))
        };
        self.joints.iter().map(matrix).collect()
    }

    /// Whether no corner leaves f32 in this pose, by bounds on its coordinates.
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
    pub fn of(bindings: &[Binding], deltas: &[Delta]) -> Self {
        let largest = |sum: f64, vector: &[f32; 3]| vector.iter().map(|x| f64::from(x.abs())).fold(sum, f64::max);
        Self {
            position: bindings.iter().map(|binding| &binding.position).fold(0.0, largest),
            delta: deltas.iter().flat_map(|delta| [&delta.position, &delta.normal]).fold(0.0, largest),
        }
    }
}

#[cfg(test)]
mod tests;
