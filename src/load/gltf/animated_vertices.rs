//! Binds the vertices of a primitive of an animated mesh.

use glam::DMat4;

use super::GltfError;
use super::primitive_data::{MorphTarget, PrimitiveData};
use super::rig_builder::{MAX_BOUND, NodeBinder, UndeformedVertex, VertexFrame};
use super::vertex_details::VertexDetails;
use super::vertices::Vertices;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::rig::Delta;

/// Memory for a displacement of a bound vertex, and for finding equal ones, in bytes.
const PER_DELTA: u64 = 250;
/// The same for the displacement of a tangent.
const PER_TANGENT: u64 = 120;

pub(super) struct AnimatedVertices<'a, 'b, 'c> {
    binder: &'b mut NodeBinder<'c>,
    frame: VertexFrame,
    source: PrimitiveData<'a>,
    /// Where the node's weights start, if a clip changes them.
    first_weight: Option<u32>,
    /// The morph targets of those weights.
    targets: Vec<MorphTarget<'a>>,
    /// The displacements of the vertex that is being bound.
    deltas: Vec<Delta>,
    /// What each of them adds to the vertex's tangent; empty if tangents turn along with normals.
    tangents: Vec<[f32; 3]>,
    /// The number of displacements so far.
    found: usize,
}

impl<'a, 'b, 'c> AnimatedVertices<'a, 'b, 'c> {
    /// `instance` is the transform from the mesh's space to its node's.
    pub(super) fn new(
        source: PrimitiveData<'a>,
        vertices: &Vertices,
        instance: DMat4,
        binder: &'b mut NodeBinder<'c>,
    ) -> Self {
        let (frame, first_weight) = (binder.frame(vertices.is_skinned(), instance), binder.first_weight());
        let (targets, deltas, tangents) = (Vec::new(), Vec::new(), Vec::new());
        let mut moving = Self { binder, frame, source, first_weight, targets, deltas, tangents, found: 0 };
        if first_weight.is_some() {
            match moving.read_targets(vertices.count) {
                Ok(targets) => moving.targets = targets,
                Err(problem) => moving.binder.give_up(problem),
            }
        }
        moving
    }

    /// # Errors
    /// A clause if the targets can't be read, or if there are too many.
    fn read_targets(&mut self, count: usize) -> Result<Vec<MorphTarget<'a>>, String> {
        let targets = self.source.primitive.morph_targets();
        self.binder.look_at(targets.clone().count().saturating_mul(count))?;
        let targets: Result<_, GltfError> = targets.map(|target| self.source.target(&target, count)).collect();
        targets.map_err(|problem| problem.to_string())
    }

    /// Returns the number of the binding of the vertex that was read last.
    pub(super) fn bind(&mut self, i: usize, vertices: &Vertices, corner: &InputCorner) -> u32 {
        let details = vertices.details.as_ref().filter(|details| details.displaces_tangents());
        if let Err(problem) = self.displace(i, details) {
            self.binder.give_up(problem);
        }
        let (position, normal) = vertices.undeformed(i, self.first_weight.is_none());
        let normal = normal.unwrap_or_default();
        let tangent = details.filter(|_| self.first_weight.is_some()).and_then(|details| details.displaced_tangent(i));
        let tangent = tangent.map(|tangent| (tangent, &mut self.tangents[..]));
        let (influences, deltas) = (vertices.joints(), &mut self.deltas);
        let vertex = UndeformedVertex { position, normal, influences, deltas, tangent };
        self.binder.bind(&self.frame, vertex, corner)
    }

    /// Collects the displacements of a vertex by the targets that move or turn it, at weight 1. Components that aren't
    /// finite become 0. `tangents` are the details of vertices whose tangents are displaced.
    ///
    /// # Errors
    /// A clause if they take too much memory.
    fn displace(&mut self, i: usize, tangents: Option<&VertexDetails>) -> Result<(), String> {
        self.deltas.clear();
        self.tangents.clear();
        let Some(first_weight) = self.first_weight else { return Ok(()) };
        for (index, (target, weight)) in self.targets.iter().zip(first_weight..).enumerate() {
            let [position, normal] = [&target.positions, &target.normals].map(|list| {
                let vector = list.as_ref().map_or([0.0; 3], |list| list.get(i));
                vector.map(|x| if x.is_finite() { x } else { 0.0 })
            });
            let tangent = tangents.map(|details| details.tangent_displacement(index, i));
            if position != [0.0; 3] || normal != [0.0; 3] || tangent.is_some_and(|tangent| tangent != [0.0; 3]) {
                self.deltas.push(Delta { position, weight, normal, tangent: 0 });
                self.tangents.extend(tangent);
            }
        }
        self.found += self.deltas.len();
        if self.found > MAX_BOUND {
            return Err(format!("there are more than {MAX_BOUND} displacements of vertices"));
        }
        let memory = self.deltas.len() as u64 * PER_DELTA + self.tangents.len() as u64 * PER_TANGENT;
        let kept = self.source.accessors.budget.hold(memory);
        kept.map_err(|reason| format!("{} displacements of vertices {reason}", self.found))
    }
}
