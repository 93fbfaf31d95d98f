//! Puts the corners of a node's mesh into their rest pose.

use glam::{DMat3, DMat4, DVec3, Vec3};
use ufbx::{Mesh, Node};

use super::convert::{at_corner, matrix, vec3};
use super::morphs::{Morphs, rest_weights};
use super::nurbs::Polygons;
use super::skin::Skin;
use super::{looks, smoothing};
use crate::binding_space::turned;
use crate::memory_budget::Budget;
use crate::read_error::{FilePosition, ReadError};
use crate::selection::Selection;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::rig::Delta;

/// The vertices of a node's mesh.
pub(super) struct Vertices<'a> {
    pub mesh: &'a Mesh,
    /// The NURBS surface whose polygons the mesh is.
    pub surface: Option<&'a Polygons<'a>>,
    pub skin: Option<&'a Skin<'a>>,
    pub morphs: Morphs<'a>,
    /// The weights of its morph targets.
    rest: Vec<f32>,
    /// The transform from the mesh's space to the scene's.
    rigid: DMat4,
    /// The transform from the mesh's space to the node's.
    pub to_node: DMat4,
    /// The normals of corners that the file doesn't have, but says how smooth they are.
    pub made: Option<Vec<Vec3>>,
    /// Whether normals are made of the corners that are read next, whatever the file has.
    pub makes_normals: bool,
}

/// A corner in its rest pose, and as it was before.
pub(super) struct PosedCorner {
    pub corner: InputCorner,
    /// The position and normal in the mesh's space, without blend shapes, and with them at rest.
    pub undeformed: (Vec3, Option<Vec3>),
    pub morphed: (Vec3, Option<Vec3>),
    /// Transforms its directions.
    pub linear: DMat3,
}

impl<'a> Vertices<'a> {
    /// Prepares to read; `at` is the node's place.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn new(
        node: &Node,
        mesh: &'a Mesh,
        at: DMat4,
        skin: Option<&'a Skin<'a>>,
        selected: &Selection,
        budget: &Budget,
    ) -> Result<Self, ReadError> {
        let to_node = matrix(&node.geometry_to_node);
        let is_smoothed = !mesh.vertex_normal.exists && !selected.makes_all_normals();
        let made = if is_smoothed { smoothing::normals(mesh, budget)? } else { None };
        Ok(Self {
            mesh,
            surface: None,
            skin,
            morphs: Morphs::new(mesh, budget)?,
            rest: rest_weights(mesh, selected),
            rigid: at * to_node,
            to_node,
            made,
            makes_normals: false,
        })
    }

    /// Returns the vertex of a corner.
    ///
    /// # Errors
    /// [`ReadError::Broken`] if there is no such vertex.
    pub(super) fn vertex(&self, corner: usize) -> Result<usize, ReadError> {
        let vertex = self.mesh.vertex_indices.get(corner).map(|&vertex| vertex as usize);
        let vertex = vertex.filter(|&vertex| vertex < self.mesh.vertices.len());
        vertex.ok_or_else(|| {
            let name = looks::name(&self.mesh.element);
            FilePosition::Everywhere.error(format!("mesh \"{name}\" has a polygon with a vertex that doesn't exist"))
        })
    }

    /// Returns a corner in the scene's space, without texture coordinates. `influences` are the joints of its vertex, and `deltas`
    /// what its morph targets add. Its position may be too far away, or not be finite.
    pub(super) fn posed(
        &self,
        corner: usize,
        vertex: usize,
        influences: &[(usize, f64)],
        deltas: &[Delta],
    ) -> PosedCorner {
        let own = self.mesh.vertices.get(vertex).map_or(DVec3::ZERO, vec3);
        let normal = self.normal(corner);
        let (mut position, mut morphed) = (own, normal);
        for delta in deltas {
            let weight = self.rest.get(delta.weight as usize).copied().unwrap_or_default();
            position += Vec3::from(delta.position).as_dvec3() * f64::from(weight);
            morphed = morphed.map(|normal| normal + Vec3::from(delta.normal) * weight);
        }
        let (undeformed, morphed) = ((own.as_vec3(), normal), (position.as_vec3(), morphed));
        let matrix = match self.skin {
            Some(skin) if !influences.is_empty() => skin.matrix(influences),
            _ => self.rigid,
        };
        let position = matrix.transform_point3(position).as_vec3();
        let linear = DMat3::from_mat4(matrix);
        // A normal without a direction becomes zero, which the builder replaces and counts.
        let normal = morphed.1.map(|normal| turned(normal, &linear).unwrap_or(Vec3::ZERO));
        PosedCorner { corner: InputCorner { position, normal, uv: glam::Vec2::ZERO }, undeformed, morphed, linear }
    }

    fn normal(&self, corner: usize) -> Option<Vec3> {
        let normals = &self.mesh.vertex_normal;
        match (self.surface, &self.made) {
            _ if self.makes_normals => None,
            (Some(surface), _) => Some(surface.normal(corner)),
            (None, Some(made)) => made.get(corner).copied(),
            (None, None) => at_corner(&normals.values, &normals.indices, corner).map(|normal| vec3(normal).as_vec3()),
        }
    }
}
