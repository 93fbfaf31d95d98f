//! A primitive's vertices in their rest pose, one after another: attributes read, morphed, then skinned or placed.

use ::gltf::accessor::Accessor;
use ::gltf::{Primitive, Semantic};
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};

use super::accessor::List;
use super::extensions::UvTransform;
use super::materials::Uvs;
use super::unpacked::Unpacked;
use super::{Accessors, Problem};
use crate::mesh::mesh_builder::LooseCorner;
use crate::mesh::normals::Given;
use crate::mesh::rig::LARGEST_COORDINATE;

/// How the primitive's node stands.
pub struct Pose<'a> {
    /// The node's own space to the scene's.
    pub global: DMat4,
    /// The joints' matrices (see [`super::skin`]); empty without a skin.
    pub joints: &'a [DMat4],
    /// The weights of the morph targets; missing ones are 0.
    pub weights: &'a [f32],
}

/// A vertex in the scene's space.
pub struct Vertex {
    pub corner: LooseCorner,
    /// It went through a mirroring transform, so its triangles must be wound the other way.
    pub mirrored: bool,
    /// Its normal has a direction, but wasn't of unit length in the file.
    pub rescaled: bool,
}

/// What had to be mended, in vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// The primitive had no normals at all.
    pub no_normals: usize,
    /// A uv was not finite and is (0, 0) now.
    pub bad_uvs: usize,
    /// Weights didn't sum to anything, or named a joint that isn't there; the vertex was left as the mesh has it.
    pub bad_weights: usize,
}

/// What a morph target adds at weight 1.
pub struct Target<'a> {
    pub positions: Option<List<'a, [f32; 3]>>,
    pub normals: Option<List<'a, [f32; 3]>>,
}

/// The joints of a skin that move each vertex, and by how much.
struct Influences<'a> {
    joints: List<'a, [f32; 4]>,
    weights: List<'a, [f32; 4]>,
}

impl Influences<'_> {
    /// Puts a vertex's joints with weights that sum to 1, which quantised ones miss, into a list; or says that they are
    /// unusable, of a skin with so many joints.
    fn of(&self, vertex: usize, joint_count: usize, found: &mut Vec<(usize, f64)>) -> bool {
        let slots = self.joints.get(vertex).into_iter().zip(self.weights.get(vertex));
        let slots = slots.filter(|(_, weight)| *weight != 0.0);
        let total: f64 = slots.clone().map(|(_, weight)| f64::from(weight)).sum();
        found.clear();
        found.extend(slots.map(|(joint, weight)| (joint as usize, f64::from(weight) / total)));
        total.is_finite() && total > 0.0 && found.iter().all(|(joint, _)| *joint < joint_count)
    }
}

/// Reads and poses a primitive's vertices, where they lie.
pub struct Vertices<'a> {
    source: Source<'a>,
    pose: &'a Pose<'a>,
    transform: Option<UvTransform>,
    pub count: usize,
    positions: List<'a, [f32; 3]>,
    normals: Option<List<'a, [f32; 3]>>,
    uvs: Option<List<'a, [f32; 2]>>,
    /// Of those that weigh something at rest.
    targets: Vec<(f32, Target<'a>)>,
    influences: Option<Influences<'a>>,
    /// Joints of the vertex that was read last; none if they are unusable.
    joints: Option<Vec<(usize, f64)>>,
    pub repairs: Repairs,
}

impl<'a> Vertices<'a> {
    /// `uvs` says which texture coordinates.
    ///
    /// # Errors
    /// [`Problem::Accessor`] and [`Problem::Primitive`].
    pub fn new(source: Source<'a>, pose: &'a Pose<'a>, uvs: Uvs) -> Result<Self, Problem> {
        let positions = source.primitive.get(&Semantic::Positions).ok_or_else(|| source.problem("has no positions"))?;
        let count = positions.count();
        let weights = pose.weights.iter().copied();
        let weighed = source.primitive.morph_targets().zip(weights).filter(|(_, weight)| *weight != 0.0);
        Ok(Self {
            pose,
            transform: uvs.transform,
            count,
            positions: source.list(&positions, "POSITION", count)?,
            normals: source.attribute(Semantic::Normals, count)?,
            uvs: source.attribute(Semantic::TexCoords(uvs.set), count)?,
            targets: weighed
                .map(|(target, weight)| Ok((weight, source.target(&target, count)?)))
                .collect::<Result<_, Problem>>()?,
            influences: source.influences(pose, count)?,
            joints: None,
            repairs: Repairs::default(),
            source,
        })
    }

    pub fn is_skinned(&self) -> bool {
        self.influences.is_some()
    }

    /// The joints that move the vertex that was read last.
    pub fn joints(&self) -> Option<&[(usize, f64)]> {
        self.joints.as_deref()
    }

    /// A vertex's position and normal in the file, morphed as it is at rest or not at all.
    pub fn undeformed(&self, i: usize, is_morphed: bool) -> (Vec3, Option<Vec3>) {
        let mut position = Vec3::from(self.positions.get(i));
        let mut normal = self.normals.as_ref().map(|normals| Vec3::from(normals.get(i)));
        let targets = if is_morphed { self.targets.as_slice() } else { &[] };
        // Each times its weight (specification, section 3.7.2.2).
        for (weight, target) in targets {
            if let Some(positions) = &target.positions {
                position += Vec3::from(positions.get(i)) * *weight;
            }
            if let (Some(normals), Some(normal)) = (&target.normals, &mut normal) {
                *normal += Vec3::from(normals.get(i)) * *weight;
            }
        }
        (position, normal)
    }

    /// A vertex; each is to be read once, as what is mended is counted.
    ///
    /// # Errors
    /// [`Problem::Primitive`]: it isn't anywhere.
    pub fn read(&mut self, i: usize) -> Result<Vertex, Problem> {
        let matrix = self.matrix(i);
        let (position, normal) = self.undeformed(i, true);
        // Before morphing, which leaves no normal at unit length and is no fault.
        let own = self.normals.as_ref().map(|normals| Given::new(normals.get(i).into()));
        let position = matrix.transform_point3(position.as_dvec3()).as_vec3();
        if !position.is_finite() {
            return Err(self.source.problem(format!("has a position that isn't finite, at vertex {i}")));
        }
        if position.abs().max_element() > LARGEST_COORDINATE {
            return Err(self.source.problem(format!("has a coordinate beyond {LARGEST_COORDINATE:e}, at vertex {i}")));
        }
        let linear = DMat3::from_mat4(matrix);
        // One without a direction goes on as zero: the builder makes another and counts it.
        let normal = normal.map(|normal| turned(normal, &linear).unwrap_or(Vec3::ZERO));
        self.repairs.no_normals += usize::from(normal.is_none());
        let mut uv = self.uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs.get(i).into());
        if let Some(transform) = self.transform {
            uv = transform.apply(uv);
        }
        if !uv.is_finite() {
            uv = Vec2::ZERO;
            self.repairs.bad_uvs += 1;
        }
        let rescaled = matches!(own, Some(Given::Rescaled(_))) && normal != Some(Vec3::ZERO);
        let mirrored = linear.determinant() < 0.0;
        Ok(Vertex { corner: LooseCorner { position, normal, uv }, mirrored, rescaled })
    }

    /// A skinned vertex's own: the mean of its joints' by weight. Any other's is its node's.
    fn matrix(&mut self, i: usize) -> DMat4 {
        let Some(influences) = &self.influences else { return self.pose.global };
        let mut joints = self.joints.take().unwrap_or_default();
        if !influences.of(i, self.pose.joints.len(), &mut joints) {
            self.repairs.bad_weights += 1;
            return DMat4::IDENTITY;
        }
        let weighed = |sum, &(joint, weight): &(usize, f64)| sum + self.pose.joints[joint] * weight;
        let matrix = joints.iter().fold(DMat4::ZERO, weighed);
        self.joints = Some(joints);
        matrix
    }
}

/// A normal through the inverse transpose of a linear map, of unit length; none if that has no direction.
fn turned(normal: Vec3, linear: &DMat3) -> Option<Vec3> {
    let normal = Given::new(normal).unit()?;
    if *linear == DMat3::IDENTITY {
        return Some(normal);
    }
    // The cofactors are the inverse transpose times the determinant, and exist where the inverse doesn't.
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    (sign * (cofactors * normal.as_dvec3())).try_normalize().map(DVec3::as_vec3)
}

/// Where a primitive's attributes come from.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    pub primitive: &'a Primitive<'a>,
    /// For messages.
    pub name: &'a str,
    pub accessors: &'a Accessors<'a>,
    /// If Draco compressed the primitive.
    pub unpacked: Option<&'a Unpacked>,
}

impl<'a> Source<'a> {
    pub fn problem(&self, reason: impl Into<String>) -> Problem {
        Problem::Primitive { primitive: self.name.to_owned(), reason: reason.into() }
    }

    /// # Errors
    /// [`Problem::Accessor`].
    pub fn target(&self, target: &::gltf::mesh::MorphTarget, count: usize) -> Result<Target<'a>, Problem> {
        let list = |accessor: Option<Accessor>, attribute| {
            accessor.map(|accessor| self.list(&accessor, attribute, count)).transpose()
        };
        Ok(Target {
            positions: list(target.positions(), "POSITION of a morph target")?,
            normals: list(target.normals(), "NORMAL of a morph target")?,
        })
    }

    /// None without a skin.
    fn influences(&self, pose: &Pose, count: usize) -> Result<Option<Influences<'a>>, Problem> {
        if pose.joints.is_empty() {
            return Ok(None);
        }
        let joints = self.attribute::<4>(Semantic::Joints(0), count)?;
        let weights = self.attribute::<4>(Semantic::Weights(0), count)?;
        Ok(joints.zip(weights).map(|(joints, weights)| Influences { joints, weights }))
    }

    fn attribute<const N: usize>(
        &self,
        semantic: Semantic,
        count: usize,
    ) -> Result<Option<List<'a, [f32; N]>>, Problem> {
        let accessor = self.primitive.get(&semantic);
        accessor.map(|accessor| self.list(&accessor, &semantic.to_string(), count)).transpose()
    }

    /// An attribute's values, as many as there are vertices.
    fn list<const N: usize>(
        &self,
        accessor: &Accessor,
        attribute: &str,
        count: usize,
    ) -> Result<List<'a, [f32; N]>, Problem> {
        let role = format!("{attribute} of {}", self.name);
        if accessor.count() != count {
            let reason = format!("has {} elements for {count} vertices", accessor.count());
            return Err(Problem::Accessor { accessor: accessor.index(), role, reason });
        }
        match self.unpacked.and_then(|unpacked| unpacked.values(attribute)) {
            Some(values) => Ok(List::of(values, [0.0; N])),
            None => self.accessors.list(accessor, &role),
        }
    }
}
