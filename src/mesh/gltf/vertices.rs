//! A primitive's vertices in their rest pose: attributes read, morphed, then skinned or placed.

use ::gltf::accessor::Accessor;
use ::gltf::{Primitive, Semantic};
use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};

use super::binder::{MAX_BOUND, NodeBinder, Undeformed};
use super::extensions::UvTransform;
use super::materials::Uvs;
use super::{Accessors, Problem};
use crate::mesh::merge::LooseCorner;
use crate::mesh::normals::Given;
use crate::mesh::rig::{Delta, LARGEST_COORDINATE};

/// Memory for a displacement of a vertex that is bound, and for telling it from others, in bytes.
const PER_DELTA: u64 = 250;

/// How the primitive's node stands.
pub struct Pose<'a> {
    /// The node's own space to the scene's.
    pub global: DMat4,
    /// The joints' matrices (see [`super::skin`]); empty without a skin.
    pub joints: &'a [DMat4],
    /// The weights of the morph targets; missing ones are 0.
    pub weights: &'a [f32],
}

/// Vertices in the scene's space.
pub struct Vertices {
    pub corners: Vec<LooseCorner>,
    /// The vertex went through a mirroring transform, so its triangles must be wound the other way.
    pub mirrored: Vec<bool>,
    /// The vertex's normal has a direction, but wasn't of unit length in the file.
    pub rescaled: Vec<bool>,
    /// Numbers of the vertices' bindings; none at all if nothing moves.
    pub bindings: Vec<u32>,
    pub repairs: Repairs,
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

/// The attributes as the file has them.
#[derive(Clone)]
struct Attributes {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    uvs: Option<Vec<[f32; 2]>>,
}

/// The joints of a skin that move each vertex, and by how much.
pub struct Influences {
    joints: Vec<[f32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Influences {
    /// A vertex's joints with weights that sum to 1, which quantised ones miss; none if they are unusable, of a skin with so
    /// many joints.
    pub fn of(&self, vertex: usize, joint_count: usize) -> Option<impl Iterator<Item = (usize, f64)>> {
        let slots = || self.joints[vertex].into_iter().zip(self.weights[vertex]).filter(|(_, weight)| *weight != 0.0);
        let total: f64 = slots().map(|(_, weight)| f64::from(weight)).sum();
        let is_usable = total.is_finite() && total > 0.0 && slots().all(|(joint, _)| (joint as usize) < joint_count);
        is_usable.then(|| slots().map(move |(joint, weight)| (joint as usize, f64::from(weight) / total)))
    }
}

/// Reads and poses a primitive's vertices. `name` is the primitive's, for messages; `uvs` says which texture coordinates. They are
/// bound to what moves them where there is a `binder`.
///
/// # Errors
/// [`Problem::Accessor`] and [`Problem::Primitive`].
pub fn read(
    primitive: &Primitive,
    name: &str,
    pose: &Pose,
    uvs: Uvs,
    accessors: &Accessors,
    binder: Option<&mut NodeBinder>,
) -> Result<Vertices, Problem> {
    let attributes = Source { primitive, name, accessors };
    let borrowed = accessors.budget.borrowed();
    let mut values = attributes.read(uvs.set)?;
    // Before morphing, which leaves no normal at unit length and is no fault.
    let rescaled = rescaled(values.normals.as_deref(), values.positions.len());
    let first_weight = binder.as_ref().and_then(|binder| binder.first_weight());
    let unmorphed = first_weight.map(|_| values.clone());
    attributes.morph(&mut values, pose.weights)?;
    let count = values.positions.len();
    let influences = attributes.influences(pose, count)?;
    let too_large = |reason| Problem::Primitive { primitive: name.to_owned(), reason };
    let bytes = count as u64 * (size_of::<LooseCorner>() + 2) as u64;
    accessors.budget.borrow(bytes).map_err(too_large)?;
    let (corners, mirrored) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut vertices = Vertices { corners, mirrored, rescaled, bindings: Vec::new(), repairs: Repairs::default() };
    for i in 0..count {
        let matrix = match &influences {
            Some(influences) => skinned(pose, influences, i, &mut vertices.repairs),
            None => pose.global,
        };
        vertices.push(&values, i, &matrix, uvs.transform, name)?;
    }
    if let Some(binder) = binder {
        let Attributes { positions, normals, .. } = unmorphed.as_ref().unwrap_or(&values);
        let (normals, influences) = (normals.as_deref(), influences.as_ref());
        let deltas = first_weight.map_or(Ok(Vec::new()), |first| attributes.deltas(first, positions.len(), binder));
        let deltas = deltas.unwrap_or_else(|problem| {
            binder.give_up(problem);
            Vec::new()
        });
        vertices.bindings = binder.bind(Undeformed { positions, normals, influences, deltas }, &vertices.corners);
    }
    // The attributes as the file has them are free again.
    accessors.budget.pass(borrowed);
    accessors.budget.borrow(bytes).map_err(too_large)?;
    Ok(vertices)
}

impl Vertices {
    fn push(
        &mut self,
        values: &Attributes,
        i: usize,
        matrix: &DMat4,
        transform: Option<UvTransform>,
        name: &str,
    ) -> Result<(), Problem> {
        let position = matrix.transform_point3(values.positions[i].as_dvec3()).as_vec3();
        if !position.is_finite() {
            let reason = format!("has a position that isn't finite, at vertex {i}");
            return Err(Problem::Primitive { primitive: name.to_owned(), reason });
        }
        if position.abs().max_element() > LARGEST_COORDINATE {
            let reason = format!("has a coordinate beyond {LARGEST_COORDINATE:e}, at vertex {i}");
            return Err(Problem::Primitive { primitive: name.to_owned(), reason });
        }
        let linear = DMat3::from_mat4(*matrix);
        // One without a direction goes on as zero: the builder makes another and counts it.
        let turned = |normal| turned(normal, &linear).unwrap_or(Vec3::ZERO);
        let normal = values.normals.as_ref().map(|normals| turned(normals[i]));
        self.repairs.no_normals += usize::from(normal.is_none());
        self.rescaled[i] &= normal != Some(Vec3::ZERO);
        let mut uv = values.uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[i].into());
        if let Some(transform) = transform {
            uv = transform.apply(uv);
        }
        if !uv.is_finite() {
            uv = Vec2::ZERO;
            self.repairs.bad_uvs += 1;
        }
        self.corners.push(LooseCorner { position, normal, uv });
        self.mirrored.push(linear.determinant() < 0.0);
        Ok(())
    }
}

/// Which normals aren't of unit length (see [`Given`]).
fn rescaled(normals: Option<&[Vec3]>, count: usize) -> Vec<bool> {
    let rescaled = |normal: &Vec3| matches!(Given::new(*normal), Given::Rescaled(_));
    normals.map_or_else(|| vec![false; count], |normals| normals.iter().map(rescaled).collect())
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
struct Source<'a> {
    primitive: &'a Primitive<'a>,
    name: &'a str,
    accessors: &'a Accessors<'a>,
}

impl Source<'_> {
    fn read(&self, uv_set: u32) -> Result<Attributes, Problem> {
        let positions = self.primitive.get(&Semantic::Positions).ok_or_else(|| Problem::Primitive {
            primitive: self.name.to_owned(),
            reason: "has no positions".to_owned(),
        })?;
        let count = positions.count();
        Ok(Attributes {
            positions: self.vectors(&positions, "POSITION", count)?,
            normals: match self.primitive.get(&Semantic::Normals) {
                Some(accessor) => Some(self.vectors(&accessor, "NORMAL", count)?),
                None => None,
            },
            uvs: self.attribute(Semantic::TexCoords(uv_set), count)?,
        })
    }

    /// Adds the morph targets, each times its weight (specification, section 3.7.2.2).
    fn morph(&self, values: &mut Attributes, weights: &[f32]) -> Result<(), Problem> {
        let count = values.positions.len();
        for (target, &weight) in self.primitive.morph_targets().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            if let Some(accessor) = target.positions() {
                add(&mut values.positions, &self.vectors(&accessor, "POSITION of a morph target", count)?, weight);
            }
            if let (Some(accessor), Some(normals)) = (target.normals(), &mut values.normals) {
                add(normals, &self.vectors(&accessor, "NORMAL of a morph target", count)?, weight);
            }
        }
        Ok(())
    }

    /// What each target of weight 1 adds to each vertex, of those that it moves or turns; target 0 has weight
    /// `first_weight`.
    ///
    /// # Errors
    /// In words: it can't be read, or is too much.
    fn deltas(&self, first_weight: u32, count: usize, binder: &mut NodeBinder) -> Result<Vec<Vec<Delta>>, String> {
        let targets = self.primitive.morph_targets();
        binder.look_at(targets.clone().count().saturating_mul(count))?;
        let mut deltas = vec![Vec::new(); count];
        let (mut found, mut held) = (0, 0);
        for (target, weight) in targets.zip(first_weight..) {
            let positions = self.displacements(target.positions(), "POSITION of a morph target", count)?;
            let normals = self.displacements(target.normals(), "NORMAL of a morph target", count)?;
            let at = |vectors: &[[f32; 3]], i: usize| vectors.get(i).copied().unwrap_or_default();
            for (i, deltas) in deltas.iter_mut().enumerate() {
                let delta = Delta { position: at(&positions, i), weight, normal: at(&normals, i), _pad: 0.0 };
                if delta.position != [0.0; 3] || delta.normal != [0.0; 3] {
                    deltas.push(delta);
                    found += 1;
                }
            }
            if found > MAX_BOUND {
                return Err(format!("there are more than {MAX_BOUND} displacements of vertices"));
            }
            let kept = self.accessors.budget.hold((found - held) as u64 * PER_DELTA);
            kept.map_err(|reason| format!("{found} displacements of vertices {reason}"))?;
            held = found;
        }
        Ok(deltas)
    }

    /// A morph target's attribute, with 0 for what isn't finite; empty without one.
    fn displacements(
        &self,
        accessor: Option<Accessor>,
        attribute: &str,
        count: usize,
    ) -> Result<Vec<[f32; 3]>, String> {
        let Some(accessor) = accessor else { return Ok(Vec::new()) };
        let mut vectors = self.numbers::<3>(&accessor, attribute, count).map_err(|problem| problem.to_string())?;
        vectors.as_flattened_mut().iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
        Ok(vectors)
    }

    /// None without a skin.
    fn influences(&self, pose: &Pose, count: usize) -> Result<Option<Influences>, Problem> {
        if pose.joints.is_empty() {
            return Ok(None);
        }
        let joints = self.attribute::<4>(Semantic::Joints(0), count)?;
        let weights = self.attribute::<4>(Semantic::Weights(0), count)?;
        Ok(joints.zip(weights).map(|(joints, weights)| Influences { joints, weights }))
    }

    fn attribute<const N: usize>(&self, semantic: Semantic, count: usize) -> Result<Option<Vec<[f32; N]>>, Problem> {
        match self.primitive.get(&semantic) {
            Some(accessor) => self.numbers(&accessor, &semantic.to_string(), count).map(Some),
            None => Ok(None),
        }
    }

    fn vectors(&self, accessor: &Accessor, attribute: &str, count: usize) -> Result<Vec<Vec3>, Problem> {
        Ok(self.numbers::<3>(accessor, attribute, count)?.into_iter().map(Vec3::from).collect())
    }

    /// An attribute's values, as many as there are vertices.
    fn numbers<const N: usize>(
        &self,
        accessor: &Accessor,
        attribute: &str,
        count: usize,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let role = format!("{attribute} of {}", self.name);
        if accessor.count() != count {
            let reason = format!("has {} elements for {count} vertices", accessor.count());
            return Err(Problem::Accessor { accessor: accessor.index(), role, reason });
        }
        self.accessors.numbers(accessor, &role)
    }
}

fn add(values: &mut [Vec3], changes: &[Vec3], weight: f32) {
    for (value, change) in values.iter_mut().zip(changes) {
        *value += *change * weight;
    }
}

/// A skinned vertex's own matrix: the mean of its joints' by weight.
fn skinned(pose: &Pose, influences: &Influences, vertex: usize, repairs: &mut Repairs) -> DMat4 {
    let Some(joints) = influences.of(vertex, pose.joints.len()) else {
        repairs.bad_weights += 1;
        return DMat4::IDENTITY;
    };
    joints.fold(DMat4::ZERO, |sum, (joint, weight)| sum + pose.joints[joint] * weight)
}
