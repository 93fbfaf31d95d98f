//! Where nodes are, and how a mesh stands at rest: global transforms, skins and morph targets' default weights.

use glam::{Mat3, Mat4, Vec3, Vec4};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Data;

use super::gltf_accessors::{Problem, check};

/// Global transforms of all nodes of a document.
pub struct Pose {
    globals: Vec<Mat4>,
}

impl Pose {
    /// Walks the nodes from those that no other has as a child.
    ///
    /// # Errors
    /// A node with two parents, or one that is its own ancestor.
    pub fn new(document: &gltf::Document) -> Result<Self, Problem> {
        let count = document.nodes().len();
        let mut has_parent = vec![false; count];
        for node in document.nodes() {
            for child in node.children() {
                if std::mem::replace(&mut has_parent[child.index()], true) {
                    return Err(format!("is the child of two nodes (node {})", child.index()));
                }
            }
        }
        let mut globals = vec![Mat4::IDENTITY; count];
        let mut reached = 0;
        let mut stack: Vec<_> =
            document.nodes().filter(|node| !has_parent[node.index()]).map(|node| (node, Mat4::IDENTITY)).collect();
        while let Some((node, parent)) = stack.pop() {
            reached += 1;
            let global = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
            globals[node.index()] = global;
            stack.extend(node.children().map(|child| (child, global)));
        }
        if reached < count { Err("form a cycle".into()) } else { Ok(Self { globals }) }
    }

    pub fn global(&self, node: &gltf::Node) -> Mat4 {
        self.globals[node.index()]
    }

    /// What each joint of a skin does to a vertex: its global transform after the inverse bind matrix (glTF 2.0, section
    /// 3.7.3.3).
    ///
    /// # Errors
    /// Inverse bind matrices that are damaged, or too few.
    pub fn joint_matrices(&self, skin: &gltf::Skin, buffers: &[Data]) -> Result<Vec<Mat4>, Problem> {
        let joints: Vec<Mat4> = skin.joints().map(|joint| self.global(&joint)).collect();
        let Some(accessor) = skin.inverse_bind_matrices() else { return Ok(joints) };
        check(&accessor, buffers, &[DataType::F32], Dimensions::Mat4)?;
        let reader = skin.reader(|buffer| buffers.get(buffer.index()).map(|data| &data[..]));
        let inverse: Vec<Mat4> =
            reader.read_inverse_bind_matrices().into_iter().flatten().map(|m| Mat4::from_cols_array_2d(&m)).collect();
        if inverse.len() < joints.len() {
            return Err(format!("has {} inverse bind matrices for {} joints", inverse.len(), joints.len()));
        }
        Ok(joints.iter().zip(inverse).map(|(joint, inverse)| *joint * inverse).collect())
    }
}

/// Where a primitive's vertices are put.
pub enum Placement {
    /// By their node.
    Node(Mat4),
    /// By their joints: a matrix for each vertex.
    Skin(Vec<Mat4>),
}

impl Placement {
    pub fn position(&self, vertex: usize, position: Vec3) -> Vec3 {
        self.matrix(vertex).transform_point3(position)
    }

    /// The normal in the same place, not yet unit.
    pub fn normal(&self, vertex: usize, normal: Vec3) -> Vec3 {
        let linear = Mat3::from_mat4(*self.matrix(vertex));
        // The cofactor matrix is the inverse transpose but for a positive scale, and exists for every matrix.
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let cofactors = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        cofactors * normal * linear.determinant().signum()
    }

    /// Whether triangles turn inside out, and must be wound the other way.
    pub fn mirrors(&self) -> bool {
        matches!(self, Self::Node(matrix) if Mat3::from_mat4(*matrix).determinant() < 0.0)
    }

    fn matrix(&self, vertex: usize) -> &Mat4 {
        match self {
            Self::Node(matrix) => matrix,
            Self::Skin(matrices) => &matrices[vertex],
        }
    }
}

/// The matrix of every vertex of a skinned primitive; `None` if the primitive has no joints or weights.
///
/// # Errors
/// Damaged accessors, or joints that the skin doesn't have.
pub fn skin_matrices(
    primitive: &gltf::Primitive,
    joints: &[Mat4],
    count: usize,
    buffers: &[Data],
) -> Result<Option<Vec<Mat4>>, Problem> {
    let (Some(joint_accessor), Some(weight_accessor)) =
        (primitive.get(&gltf::Semantic::Joints(0)), primitive.get(&gltf::Semantic::Weights(0)))
    else {
        return Ok(None);
    };
    check(&joint_accessor, buffers, &[DataType::U8, DataType::U16], Dimensions::Vec4)?;
    check(&weight_accessor, buffers, &[DataType::F32, DataType::U8, DataType::U16], Dimensions::Vec4)?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data[..]));
    let (Some(indices), Some(weights)) = (reader.read_joints(0), reader.read_weights(0)) else { return Ok(None) };
    let mut matrices = Vec::with_capacity(count);
    for (indices, weights) in indices.into_u16().zip(weights.into_f32()).take(count) {
        let weights = Vec4::from(weights);
        let sum = weights.element_sum();
        let mut matrix = Mat4::ZERO;
        for (index, weight) in indices.into_iter().zip(weights.to_array()) {
            if weight != 0.0 {
                let joint = joints.get(usize::from(index));
                let joint = joint.ok_or_else(|| format!("uses joint {index} of a skin that has {}", joints.len()))?;
                matrix += *joint * (weight / sum);
            }
        }
        matrices.push(if sum > 0.0 { matrix } else { Mat4::IDENTITY });
    }
    if matrices.len() < count {
        return Err(format!("has joints for {} of {count} vertices", matrices.len()));
    }
    Ok(Some(matrices))
}

/// Adds morph targets to positions and normals, by the node's weights or else the mesh's (glTF 2.0, section 3.7.2.2).
///
/// # Errors
/// Damaged accessors.
pub fn morph(
    primitive: &gltf::Primitive,
    weights: &[f32],
    positions: &mut [Vec3],
    normals: Option<&mut Vec<Vec3>>,
    buffers: &[Data],
) -> Result<(), Problem> {
    let mut normals = normals;
    for target in primitive.morph_targets() {
        for accessor in [target.positions(), target.normals()].into_iter().flatten() {
            check(&accessor, buffers, &[DataType::F32], Dimensions::Vec3)?;
        }
        if let Some(tangents) = target.tangents() {
            check(&tangents, buffers, &[DataType::F32], Dimensions::Vec3)?;
        }
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data[..]));
    for ((moved, turned, _), &weight) in reader.read_morph_targets().zip(weights) {
        if weight == 0.0 {
            continue;
        }
        for (position, offset) in positions.iter_mut().zip(moved.into_iter().flatten()) {
            *position += Vec3::from(offset) * weight;
        }
        if let Some(normals) = normals.as_deref_mut() {
            for (normal, offset) in normals.iter_mut().zip(turned.into_iter().flatten()) {
                *normal += Vec3::from(offset) * weight;
            }
        }
    }
    Ok(())
}
