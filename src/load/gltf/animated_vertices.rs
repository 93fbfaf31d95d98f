//! Binds the vertices of a primitive of an animated mesh.

use ::gltf::{Primitive, Semantic};
use glam::DMat4;

use super::rig_builder::{NodeBinder, PER_DELTA, UndeformedVertex, VertexFrame};
use super::vertices::Vertices;
use crate::memory_budget::Budget;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::rig::Delta;

/// Memory for a displacement of a tangent, and for finding equal ones, in bytes.
const PER_TANGENT: u64 = 120;

pub(super) struct AnimatedVertices<'a, 'b, 'c> {
    binder: &'b mut NodeBinder<'c>,
    frame: VertexFrame,
    budget: &'a Budget,
    /// Where the node's weights start, if a clip changes them.
    first_weight: Option<u32>,
    /// The displacements of the vertex that is being bound.
    deltas: Vec<Delta>,
    /// What each of them adds to the vertex's tangent; empty if tangents turn along with normals.
    tangents: Vec<[f32; 3]>,
}

/// Returns whether a clip changes the weights of a primitive's morph targets. They aren't to be read if they have too many elements.
pub(super) fn may_morph(binder: Option<&mut NodeBinder>, primitive: &Primitive) -> bool {
    let Some(binder) = binder.filter(|binder| binder.first_weight().is_some()) else { return false };
    let vertices = primitive.get(&Semantic::Positions).map_or(0, |positions| positions.count());
    let looked = binder.look_at(primitive.morph_targets().count().saturating_mul(vertices));
    looked.map_err(|problem| binder.binder.give_up(problem)).is_ok()
}

impl<'a, 'b, 'c> AnimatedVertices<'a, 'b, 'c> {
    /// `instance` is the transform from the mesh's space to its node's. Whether a clip changes weights is known from [`may_morph`].
    pub(super) fn new(
        budget: &'a Budget,
        vertices: &Vertices,
        instance: DMat4,
        is_morphing: bool,
        binder: &'b mut NodeBinder<'c>,
    ) -> Self {
        let frame = binder.frame(vertices.influences.is_some(), instance);
        let mut first_weight = binder.first_weight().filter(|_| is_morphing);
        if let Some(problem) = &vertices.unmorphed {
            binder.binder.give_up(problem.clone());
            first_weight = None;
        }
        Self { binder, frame, budget, first_weight, deltas: Vec::new(), tangents: Vec::new() }
    }

    /// Returns the number of the binding of a vertex, which these joints move.
    pub(super) fn bind(
        &mut self,
        i: usize,
        vertices: &Vertices,
        joints: Option<&[(usize, f64)]>,
        corner: &InputCorner,
    ) -> u32 {
        if let Err(problem) = self.displace(i, vertices) {
            self.binder.binder.give_up(problem);
        }
        let (position, normal) = vertices.undeformed(i, self.first_weight.is_none());
        let normal = normal.unwrap_or_default();
        let tangent = self.first_weight.and_then(|_| vertices.displaced_tangent(i));
        let tangent = tangent.map(|tangent| (tangent, &mut self.tangents[..]));
        let (influences, deltas) = (joints, &mut self.deltas);
        let vertex = UndeformedVertex { position, normal, influences, deltas, tangent };
        self.binder.bind(&self.frame, vertex, corner)
    }

    /// Collects the displacements of a vertex by the targets that move or turn it, at weight 1.
    ///
    /// # Errors
    /// A clause if they take too much memory.
    fn displace(&mut self, i: usize, vertices: &Vertices) -> Result<(), String> {
        self.deltas.clear();
        self.tangents.clear();
        let Some(first_weight) = self.first_weight else { return Ok(()) };
        let has_tangents = vertices.displaces_tangents();
        for (target, weight) in vertices.targets.iter().zip(first_weight..) {
            let [position, normal, tangent] = target.displacements(i);
            if [position, normal, tangent] != [[0.0; 3]; 3] {
                self.deltas.push(Delta { position, weight, normal, tangent: 0 });
                self.tangents.extend(has_tangents.then_some(tangent));
            }
        }
        let memory = self.deltas.len() as u64 * PER_DELTA + self.tangents.len() as u64 * PER_TANGENT;
        self.budget.hold(memory).map_err(|reason| format!("with displacements of vertices, the load {reason}"))
    }
}
