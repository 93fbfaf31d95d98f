//! Reads a primitive's vertices in their rest pose: attributes, morph targets, then the skin or the node's transform.

use ::gltf::Semantic;
use ::gltf::accessor::Accessor;
use glam::{DMat3, DMat4, DQuat, DVec3, Vec2, Vec3};

use super::GltfError;
use super::accessor::List;
use super::materials::Resolved;
use super::notes::Notes;
use super::primitive_data::PrimitiveData;
use super::vertex_details::{VertexDetails, VertexRepairs};
use crate::binding_space::turned;
use crate::map_uvs::MapUvs;
use geometry::casts::to_u32;
use geometry::mesh::CornerDetail;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::normals::GivenNormal;

/// The greatest number of joints that move a vertex.
const MOST_JOINTS: usize = 4;

/// The pose of a primitive's node.
pub(super) struct NodePose<'a> {
    /// The transform from the mesh's space to the scene's.
    pub global: DMat4,
    /// The transform from the mesh's space to the node's.
    pub instance: DMat4,
    /// The matrices of the joints (see [`super::skin`]); empty without a skin.
    pub joints: &'a [DMat4],
    /// The weights of the morph targets; missing ones are 0.
    pub weights: &'a [f32],
}

/// The displacements by a morph target at weight 1.
pub(super) struct MorphTarget<'a> {
    /// Its weight at rest.
    weight: f32,
    positions: Option<List<'a, [f32; 3]>>,
    normals: Option<List<'a, [f32; 3]>>,
    /// None if nothing needs tangents.
    tangents: Option<List<'a, [f32; 3]>>,
}

impl MorphTarget<'_> {
    /// Returns what it adds to the position, the normal and the tangent of a vertex. Components that aren't finite become 0.
    pub(super) fn displacements(&self, i: usize) -> [[f32; 3]; 3] {
        [&self.positions, &self.normals, &self.tangents].map(|list| {
            let vector = list.as_ref().map_or([0.0; 3], |list| list.get(i));
            vector.map(|x| if x.is_finite() { x } else { 0.0 })
        })
    }
}

/// What is found out while vertices are read one after another.
#[derive(Default)]
pub(super) struct Findings {
    pub repairs: VertexRepairs,
    /// The joints that move the vertex that was read last; none if they are unusable.
    pub joints: Option<Vec<(usize, f64)>>,
}

/// A vertex in the scene's space.
pub(super) struct Vertex {
    pub corner: InputCorner,
    pub detail: CornerDetail,
    /// Whether its transform mirrors, so that its triangles must be wound the other way.
    pub mirrored: bool,
    /// Whether its normal has a direction, but wasn't of unit length in the file.
    pub rescaled: bool,
    /// The number of what moves it; 0 until it is bound.
    pub binding: u32,
}

/// The joints of a skin that move each vertex, and their weights, in sets of four.
pub(super) struct Influences<'a> {
    sets: Vec<[List<'a, [f32; 4]>; 2]>,
}

impl<'a> Influences<'a> {
    /// Returns the joints and weights of a primitive; none without a skin.
    fn read(
        source: PrimitiveData<'a>,
        pose: &NodePose,
        count: usize,
        notes: &mut Notes,
    ) -> Result<Option<Self>, GltfError> {
        if pose.joints.is_empty() {
            return Ok(None);
        }
        let mut sets = Vec::new();
        for set in 0.. {
            let joints = source.attribute::<4>(Semantic::Joints(set), count)?;
            let weights = source.attribute::<4>(Semantic::Weights(set), count)?;
            match (joints, weights) {
                (Some(joints), Some(weights)) => sets.push([joints, weights]),
                (None, None) => break,
                (joints, _) => {
                    let (has, lacks) = if joints.is_some() { ("JOINTS", "WEIGHTS") } else { ("WEIGHTS", "JOINTS") };
                    let said = format!("{} has {has}_{set} but no {lacks}_{set}; it is left out.", source.name);
                    notes.push_once(said);
                    break;
                }
            }
        }
        Ok((!sets.is_empty()).then_some(Self { sets }))
    }

    /// Collects the joints of a vertex, with weights that are scaled to add up to 1, since quantised weights don't
    /// exactly. Of more than [`MOST_JOINTS`] those with the largest weights are kept. The skin has `joint_count` joints. Returns the part of the
    /// weights that is left out, or none if the joints can't be used.
    #[expect(clippy::cast_possible_truncation, reason = "numbers of joints are whole, and few")]
    fn of(&self, vertex: usize, joint_count: usize, found: &mut Vec<(usize, f64)>) -> Option<f64> {
        let slots =
            self.sets.iter().flat_map(|[joints, weights]| joints.get(vertex).into_iter().zip(weights.get(vertex)));
        let slots = slots.filter(|(_, weight)| *weight != 0.0);
        let total: f64 = slots.clone().map(|(_, weight)| f64::from(weight)).sum();
        found.clear();
        found.extend(slots.map(|(joint, weight)| (joint as usize, f64::from(weight) / total)));
        if !total.is_finite() || total <= 0.0 || found.iter().any(|(joint, _)| *joint >= joint_count) {
            return None;
        }
        Some(if found.len() > MOST_JOINTS { cut(found) } else { 0.0 })
    }
}

/// Keeps the joints with the largest weights, whose sum becomes 1 again. Returns the sum of the others.
fn cut(found: &mut Vec<(usize, f64)>) -> f64 {
    found.sort_by_key(|(joint, _)| *joint);
    found.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        kept.1 += if is_same { next.1 } else { 0.0 };
        is_same
    });
    if found.len() <= MOST_JOINTS {
        return 0.0;
    }
    // A stable sort, so that of equal weights those of the first joints are kept.
    found.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    let left_out = found.drain(MOST_JOINTS..).map(|(_, weight)| weight).sum::<f64>();
    let kept: f64 = found.iter().map(|(_, weight)| weight).sum();
    found.iter_mut().for_each(|(_, weight)| *weight /= kept);
    left_out
}

/// Reads a primitive's vertices, and puts them into their rest pose.
pub(super) struct Vertices<'a> {
    pose: &'a NodePose<'a>,
    /// Where the base colour lies on its texture coordinates.
    own: MapUvs,
    pub count: usize,
    positions: List<'a, [f32; 3]>,
    normals: Option<List<'a, [f32; 3]>>,
    uvs: Option<List<'a, [f32; 2]>>,
    /// The morph targets that have a weight at rest; all of them if a clip changes the weights.
    pub targets: Vec<MorphTarget<'a>>,
    /// What keeps a clip from changing the weights.
    pub unmorphed: Option<String>,
    pub influences: Option<Influences<'a>>,
    /// What corners have beside that; none if no material needs it.
    details: Option<VertexDetails<'a>>,
    pub repairs: VertexRepairs,
}

impl<'a> Vertices<'a> {
    /// Prepares to read what a material needs; details of corners if `is_detailed`, and all morph targets if `is_morphing`. What the shape
    /// can do without is left out with a note if it can't be read. What is repaired is added to `repairs`.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] and [`GltfError::Primitive`].
    pub(super) fn new(
        source: PrimitiveData<'a>,
        pose: &'a NodePose<'a>,
        material: Resolved,
        is_detailed: bool,
        is_morphing: bool,
        mut repairs: VertexRepairs,
        notes: &mut Notes,
    ) -> Result<Self, GltfError> {
        let positions = source.primitive.get(&Semantic::Positions).ok_or_else(|| source.problem("has no positions"))?;
        let count = positions.count();
        let positions = source.list(&positions, "POSITION", count)?;
        let normals = source.normals(count, notes)?;
        let uvs = source.detail(Semantic::TexCoords(to_u32(material.uvs.set)), count, notes);
        let details = is_detailed.then(|| VertexDetails::new(source, count, material.needs, &mut repairs, notes));
        let mut vertices = Self {
            pose,
            own: material.uvs,
            count,
            positions,
            normals,
            uvs,
            targets: Vec::new(),
            unmorphed: None,
            influences: Influences::read(source, pose, count, notes)?,
            details,
            repairs,
        };
        vertices.read_targets(source, is_morphing, notes)?;
        Ok(vertices)
    }

    /// # Errors
    /// [`GltfError::Accessor`] for a target that has a weight at rest.
    fn read_targets(
        &mut self,
        source: PrimitiveData<'a>,
        is_morphing: bool,
        notes: &mut Notes,
    ) -> Result<(), GltfError> {
        let has_tangents = self.details.as_ref().is_some_and(|details| details.tangents.is_some());
        let weights = self.pose.weights.iter().copied().chain(std::iter::repeat(0.0));
        for (target, weight) in source.primitive.morph_targets().zip(weights) {
            if weight == 0.0 && !is_morphing {
                continue;
            }
            let list = |accessor: Option<Accessor>, name: &str| {
                accessor
                    .map(|accessor| source.list(&accessor, &format!("{name} of a morph target"), self.count))
                    .transpose()
            };
            let shape = list(target.positions(), "POSITION")
                .and_then(|positions| Ok((positions, list(target.normals(), "NORMAL")?)));
            let (positions, normals) = match shape {
                Ok(shape) => shape,
                Err(error) if weight != 0.0 => return Err(error),
                Err(error) => {
                    self.unmorphed.get_or_insert(error.to_string());
                    continue;
                }
            };
            let tangents = target.tangents().filter(|_| has_tangents);
            let tangents = tangents
                .and_then(|accessor| source.optional(&accessor, "TANGENT of a morph target", self.count, notes));
            self.targets.push(MorphTarget { weight, positions, normals, tangents });
        }
        Ok(())
    }

    /// Returns a vertex's position and normal in the file; with the morph targets' displacements at rest if
    /// `is_morphed`.
    pub(super) fn undeformed(&self, i: usize, is_morphed: bool) -> (Vec3, Option<Vec3>) {
        let mut position = Vec3::from(self.positions.get(i));
        let mut normal = self.normals.as_ref().map(|normals| Vec3::from(normals.get(i)));
        // Each displacement times its weight (specification, section 3.7.2.2).
        for target in self.targets.iter().filter(|target| is_morphed && target.weight != 0.0) {
            if let Some(positions) = &target.positions {
                position += Vec3::from(positions.get(i)) * target.weight;
            }
            if let (Some(normals), Some(normal)) = (&target.normals, &mut normal) {
                *normal += Vec3::from(normals.get(i)) * target.weight;
            }
        }
        (position, normal)
    }

    /// Reads a vertex. Each must be read only once, since repairs are counted. Its position may be too far away, or not be finite.
    pub(super) fn read(&self, i: usize, findings: &mut Findings) -> Vertex {
        let matrix = self.matrix(i, findings);
        let (position, normal) = self.undeformed(i, true);
        // The normal before morphing, which doesn't preserve unit length.
        let own = if self.is_morphed() { self.undeformed(i, false).1 } else { normal }.map(GivenNormal::new);
        let position = matrix.transform_point3(position.as_dvec3()).as_vec3();
        let linear = DMat3::from_mat4(matrix);
        // A normal without a direction becomes zero, which the builder replaces and counts.
        let normal = normal.map(|normal| turned(normal, &linear).unwrap_or(Vec3::ZERO));
        let mut uv = self.own.apply(self.uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs.get(i).into()));
        if !uv.is_finite() {
            uv = Vec2::ZERO;
            findings.repairs.flaws.bad_uvs += 1;
        }
        let rescaled = matches!(own, Some(GivenNormal::Rescaled(_))) && normal != Some(Vec3::ZERO);
        let mirrored = linear.determinant() < 0.0;
        let detail = self.detail(i, &linear, &mut findings.repairs);
        Vertex { corner: InputCorner { position, normal, uv }, detail, mirrored, rescaled, binding: 0 }
    }

    /// Whether a morph target has a weight at rest.
    fn is_morphed(&self) -> bool {
        self.targets.iter().any(|target| target.weight != 0.0)
    }

    /// Whether morph targets displace tangents, rather than turn them along with normals.
    pub(super) fn displaces_tangents(&self) -> bool {
        self.targets.iter().any(|target| target.tangents.is_some())
    }

    /// Returns the tangent of a vertex in the file if morph targets displace it; none if they turn it along with the normal, or
    /// if the vertex has no tangent that can be used.
    pub(super) fn displaced_tangent(&self, i: usize) -> Option<Vec3> {
        let tangents = self.details.as_ref()?.tangents.as_ref().filter(|_| self.displaces_tangents());
        let [x, y, z, sign] = tangents?.get(i);
        let own = Vec3::new(x, y, z);
        (own.is_finite() && own != Vec3::ZERO && !sign.is_nan()).then_some(own)
    }

    /// Reads the details of a vertex. Morph targets change its tangent, and then `linear` transforms its directions into the scene's space.
    fn detail(&self, i: usize, linear: &DMat3, repairs: &mut VertexRepairs) -> CornerDetail {
        let Some(details) = &self.details else { return CornerDetail::default() };
        let tangent = details.tangents.as_ref().map(|list| self.tangent(i, list.get(i), linear));
        repairs.flaws.bad_tangents += usize::from(tangent == Some(None));
        let (tangent, bitangent_sign) = tangent.flatten().unwrap_or((Vec3::ZERO, 1.0));
        let uvs = [0, 1].map(|set| details.uv(set, i, repairs));
        CornerDetail { uvs, color: details.color(i, repairs), tangent, bitangent_sign }
    }

    /// Transforms the tangent of a vertex; none if it has no direction. A map that mirrors turns the bitangent, whose sign this is, around:
    /// it is a cross product.
    fn tangent(&self, i: usize, [x, y, z, sign]: [f32; 4], linear: &DMat3) -> Option<(Vec3, f32)> {
        let own = Vec3::new(x, y, z);
        let tangent = (*linear * self.morphed_tangent(i, own)).try_normalize().map(DVec3::as_vec3);
        let tangent = tangent.filter(|_| own.is_finite() && !sign.is_nan())?;
        let mirrored = linear.determinant() < 0.0;
        Some((tangent, if (sign < 0.0) == mirrored { 1.0 } else { -1.0 }))
    }

    /// Returns what the morph targets make of a vertex's tangent at rest.
    fn morphed_tangent(&self, i: usize, own: Vec3) -> DVec3 {
        let unit = own.as_dvec3().normalize_or_zero();
        if !self.is_morphed() {
            return unit;
        }
        if self.displaces_tangents() {
            // Each displacement times its weight (specification, section 3.7.2.2).
            return self.targets.iter().fold(own.as_dvec3(), |sum, target| {
                sum + Vec3::from(target.displacements(i)[2]).as_dvec3() * f64::from(target.weight)
            });
        }
        let normal = |is_morphed| self.undeformed(i, is_morphed).1?.as_dvec3().try_normalize();
        match (normal(false), normal(true)) {
            (Some(own), Some(morphed)) if own != morphed => DQuat::from_rotation_arc(own, morphed) * unit,
            _ => unit,
        }
    }

    /// Returns the matrix of a vertex: the weighted mean of its joints' matrices, or the node's transform if it isn't
    /// skinned.
    fn matrix(&self, i: usize, Findings { repairs, joints: found }: &mut Findings) -> DMat4 {
        let Some(influences) = &self.influences else { return self.pose.global };
        let mut joints = found.take().unwrap_or_default();
        let Some(cut) = influences.of(i, self.pose.joints.len(), &mut joints) else {
            repairs.flaws.bad_weights += 1;
            return DMat4::IDENTITY;
        };
        repairs.cut_weights += usize::from(cut > 0.0);
        repairs.largest_cut = repairs.largest_cut.max(cut);
        let weighed = |sum, &(joint, weight): &(usize, f64)| sum + self.pose.joints[joint] * weight;
        let matrix = joints.iter().fold(DMat4::ZERO, weighed);
        *found = Some(joints);
        matrix
    }
}
