//! Reads blend shapes. Each shape is a morph target; a channel may have several, each at a weight of its own (in-betweens).

use ufbx::{BlendChannel, BlendShape, Mesh, Scene};

use super::convert::vec3;
use super::looks::name;
use crate::memory_budget::Budget;
use crate::read_error::ReadError;
use crate::selection::{MorphWeights, Selection};
use geometry::casts::to_f32;
use geometry::groups::in_groups;
use geometry::mesh::rig::Delta;

/// Returns the channels of a mesh, in the order of its targets.
pub(super) fn channels(mesh: &Mesh) -> impl Iterator<Item = &BlendChannel> {
    mesh.blend_deformers.into_iter().flat_map(|deformer| &deformer.channels)
}

/// Returns the weights of all channels at rest, as the file has them.
pub(super) fn file_weights(scene: &Scene) -> MorphWeights {
    scene.blend_channels.into_iter().map(|channel| (channel_name(channel), to_f32(channel.weight))).collect()
}

/// Returns a channel's name; one without is called by its number.
fn channel_name(channel: &BlendChannel) -> String {
    let name = name(&channel.element);
    if name.is_empty() { format!("channel {}", channel.element.typed_id) } else { name }
}

/// Returns the weights of a mesh's targets at rest.
pub(super) fn rest_weights(mesh: &Mesh, selected: &Selection) -> Vec<f32> {
    let mut weights = Vec::new();
    channels(mesh).for_each(|channel| shape_weights(channel, rest_weight(channel, selected), &mut weights));
    weights
}

/// Returns the weight of a channel at rest: the chosen one, or else the file's.
pub(super) fn rest_weight(channel: &BlendChannel, selected: &Selection) -> f64 {
    selected.morph(&channel_name(channel)).map_or(channel.weight, f64::from)
}

/// Adds the weight of each shape of a channel. Between the weights of two shapes both are blended linearly; at 0 there is none.
pub(super) fn shape_weights(channel: &BlendChannel, weight: f64, weights: &mut Vec<f32>) {
    let targets: Vec<f64> = channel.keyframes.iter().map(|key| key.target_weight).collect();
    let mut knots: Vec<(f64, Option<usize>)> = targets.iter().enumerate().map(|(i, &at)| (at, Some(i))).collect();
    knots.push((0.0, None));
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let first = weights.len();
    weights.resize(first + targets.len(), 0.0);
    // Beyond the last shape the last two go on.
    let next = knots.iter().position(|knot| knot.0 > weight).unwrap_or(knots.len());
    let next = next.clamp(1, knots.len().saturating_sub(1).max(1));
    let [Some(&(from, before)), Some(&(to, after))] = [knots.get(next - 1), knots.get(next)] else { return };
    let part = (weight - from) / (to - from);
    for (shape, weight) in [(before, 1.0 - part), (after, part)] {
        if let Some(shape) = shape.filter(|_| weight.is_finite()) {
            weights[first + shape] = to_f32(weight);
        }
    }
}

/// The displacements of a mesh's vertices, by vertex.
#[derive(Default)]
pub(super) struct Morphs<'a> {
    pub shapes: Vec<&'a BlendShape>,
    /// For each vertex, where its entries begin; the last number is their end. Empty without shapes.
    starts: Vec<u32>,
    /// A shape, and the index of an offset.
    entries: Vec<[u32; 2]>,
}

impl<'a> Morphs<'a> {
    /// Prepares to read a mesh's shapes.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn new(mesh: &'a Mesh, budget: &Budget) -> Result<Self, ReadError> {
        let keys = channels(mesh).flat_map(|channel| channel.keyframes.iter());
        let shapes: Vec<&BlendShape> = keys.map(|key| key.shape.as_ref()).collect();
        if shapes.is_empty() {
            return Ok(Self::default());
        }
        let count: u64 = shapes.iter().map(|shape| shape.offset_vertices.len() as u64).sum();
        if count > u64::from(u32::MAX) {
            return Err(ReadError::TooMany { limit: u32::MAX.into(), what: "offsets of blend shapes" });
        }
        let vertices = mesh.num_vertices;
        budget.borrow(count * 8 + (vertices as u64 + 1) * 8)?;
        let offsets = shapes.iter().zip(0_u32..).flat_map(|(shape, number)| {
            let numbered = shape.offset_vertices.iter().zip(0_u32..);
            let known = numbered.filter(move |(vertex, _)| (**vertex as usize) < vertices);
            known.map(move |(vertex, offset)| (*vertex, [number, offset]))
        });
        let (starts, entries) = in_groups(vertices, offsets);
        Ok(Self { shapes, starts, entries })
    }

    /// Collects the displacements of a vertex by the shapes that move or turn it, at weight 1.
    pub(super) fn of(&self, vertex: usize, deltas: &mut Vec<Delta>) {
        deltas.clear();
        let [Some(&start), Some(&end)] = [self.starts.get(vertex), self.starts.get(vertex + 1)] else { return };
        for &[shape, offset] in self.entries.get(start as usize..end as usize).unwrap_or_default() {
            let own = self.shapes[shape as usize];
            // Blender limits a shape by the weights of a vertex group, which it writes as one for each offset.
            let weight = own.offset_weights.get(offset as usize).copied().unwrap_or(1.0);
            let [position, normal] = [&own.position_offsets, &own.normal_offsets].map(|offsets| {
                let vector = offsets.get(offset as usize).map(|v| (vec3(v) * weight).as_vec3());
                vector.filter(|vector| vector.is_finite()).unwrap_or_default().to_array()
            });
            if position != [0.0; 3] || normal != [0.0; 3] {
                deltas.push(Delta { position, weight: shape, normal, tangent: 0 });
            }
        }
    }
}
