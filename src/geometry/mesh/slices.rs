//! Makes a mesh from a program's own arrays.

use glam::{Vec2, Vec3};

use super::build_limits::MAX_TRIANGLES;
use super::mesh_builder::{InputCorner, MeshBuilder};
use super::rig::LARGEST_COORDINATE;
use super::{Material, Mesh};
use crate::progress::Progress;

/// The arrays of an indexed triangle mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshSlices<'a> {
    /// A position for each vertex, in object units.
    pub positions: &'a [[f32; 3]],
    /// A normal for each vertex, of any length; or empty, and smooth normals are computed. A normal without a direction is
    /// replaced by a smooth one.
    pub normals: &'a [[f32; 3]],
    /// A texture coordinate for each vertex, in texture widths and heights; or empty for (0, 0) everywhere.
    pub uvs: &'a [[f32; 2]],
    /// Three vertices for each triangle, counter-clockwise seen from outside.
    pub indices: &'a [u32],
}

/// Why arrays can't become a mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum SliceError {
    /// There are not as many normals or texture coordinates as positions.
    #[error("there are {found} {what} for {vertices} vertices: give one for each vertex, or none at all")]
    Lengths { what: &'static str, found: usize, vertices: usize },
    /// The number of indices isn't a multiple of 3.
    #[error("there are {0} indices, which is not a multiple of 3")]
    NoTriangles(usize),
    /// An index is beyond the vertices.
    #[error("index {at} is {index}, but there are only {vertices} vertices")]
    Index { at: usize, index: u32, vertices: usize },
    /// A vertex's position isn't finite, or too far away.
    #[error("vertex {0} has a position that isn't finite, or a coordinate beyond {LARGEST_COORDINATE:e}")]
    Position(usize),
    /// A vertex's texture coordinate isn't finite.
    #[error("vertex {0} has a texture coordinate that isn't finite")]
    Uv(usize),
    /// There are more triangles than a mesh can have.
    #[error("there are {0} triangles, but a mesh can have at most {MAX_TRIANGLES}")]
    TooManyTriangles(usize),
}

impl MeshSlices<'_> {
    fn check(&self) -> Result<(), SliceError> {
        let vertices = self.positions.len();
        for (what, found) in [("normals", self.normals.len()), ("texture coordinates", self.uvs.len())] {
            if found != 0 && found != vertices {
                return Err(SliceError::Lengths { what, found, vertices });
            }
        }
        if !self.indices.len().is_multiple_of(3) {
            return Err(SliceError::NoTriangles(self.indices.len()));
        }
        if self.indices.len() as u64 / 3 > MAX_TRIANGLES {
            return Err(SliceError::TooManyTriangles(self.indices.len() / 3));
        }
        let beyond = |(_, index): &(usize, &u32)| **index as usize >= vertices;
        if let Some((at, &index)) = self.indices.iter().enumerate().find(beyond) {
            return Err(SliceError::Index { at, index, vertices });
        }
        // The comparison is false for NaN.
        let is_held = |position: &[f32; 3]| position.iter().all(|x| x.abs() <= LARGEST_COORDINATE);
        if let Some(vertex) = self.positions.iter().position(|position| !is_held(position)) {
            return Err(SliceError::Position(vertex));
        }
        match self.uvs.iter().position(|uv| uv.iter().any(|x| !x.is_finite())) {
            Some(vertex) => Err(SliceError::Uv(vertex)),
            None => Ok(()),
        }
    }

    fn corner(&self, vertex: u32) -> InputCorner {
        let vertex = vertex as usize;
        InputCorner {
            position: self.positions[vertex].into(),
            normal: self.normals.get(vertex).copied().map(Vec3::from),
            uv: self.uvs.get(vertex).copied().map_or(Vec2::ZERO, Vec2::from),
        }
    }
}

impl Mesh {
    /// Makes a mesh of one material, without height images and without a rig, from arrays. It has the material even
    /// without triangles. Equal vertices become one corner (-0 counts as 0), vertices that no triangle uses are left
    /// out, and [`Mesh::repairs`] counts what was repaired. Takes time linear in the number of triangles.
    ///
    /// ```
    /// use pnaen_geometry::mesh::{Mesh, MeshSlices};
    ///
    /// let quad = Mesh::from_slices(&MeshSlices {
    ///     positions: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    ///     indices: &[0, 1, 2, 0, 2, 3],
    ///     ..Default::default()
    /// })?;
    /// assert_eq!((quad.corners.len(), quad.triangles.len()), (4, 2));
    /// assert_eq!(quad.corners[0].normal.to_array(), [0.0, 0.0, 1.0]);
    /// # Ok::<(), pnaen_geometry::mesh::SliceError>(())
    /// ```
    ///
    /// # Errors
    /// [`SliceError`] says what is wrong with the arrays.
    pub fn from_slices(slices: &MeshSlices) -> Result<Self, SliceError> {
        slices.check()?;
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("", [1.0; 4]));
        for triangle in slices.indices.chunks_exact(3) {
            builder.triangle(material, [0, 1, 2].map(|k| slices.corner(triangle[k])));
        }
        // Nothing else holds this progress, so nothing cancels it; too many triangles were refused above.
        let mut mesh = builder.finish(String::new(), &Progress::new()).unwrap_or_default();
        if mesh.materials.is_empty() {
            // The builder leaves out materials without triangles, but hosts draw material 0 of whatever arrays they have.
            mesh.materials.push(Material::plain("", [1.0; 4]));
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSITIONS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    const SQUARE: MeshSlices =
        MeshSlices { positions: &POSITIONS, normals: &[], uvs: &[], indices: &[0, 1, 2, 0, 2, 3] };

    #[test]
    fn corners_have_what_the_arrays_have() {
        let normals = [[0.0, 0.0, 2.0]; 4];
        let uvs = [[0.0, 0.25], [1.0, 0.25], [1.0, 0.75], [0.0, 0.75]];
        let mesh = Mesh::from_slices(&MeshSlices { normals: &normals, uvs: &uvs, ..SQUARE }).expect("a square");
        assert_eq!(*mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        for (corner, (position, uv)) in mesh.corners.iter().zip(POSITIONS.into_iter().zip(uvs)) {
            assert_eq!((corner.position, corner.normal, corner.uv), (position.into(), Vec3::Z, uv.into()));
        }
        assert_eq!((mesh.repairs.normals_rescaled, mesh.materials[0].triangles.clone()), (6, 0..2));
    }

    #[test]
    fn normals_are_computed_where_there_are_none() {
        let mesh = Mesh::from_slices(&SQUARE).expect("a square");
        assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z));
        assert_eq!(mesh.repairs.normals_made, 6);
    }

    #[test]
    fn no_triangles_make_an_empty_mesh() {
        let mesh = Mesh::from_slices(&MeshSlices { indices: &[], ..SQUARE }).expect("nothing");
        assert!(mesh.triangles.is_empty() && mesh.corners.is_empty());
        assert_eq!((mesh.materials.len(), mesh.materials[0].triangles.clone()), (1, 0..0));
    }

    #[test]
    fn invalid_arrays_are_refused_with_their_place() {
        let refused = |slices: MeshSlices| Mesh::from_slices(&slices).expect_err("refused");
        let lengths = |what, found| SliceError::Lengths { what, found, vertices: 4 };
        assert_eq!(refused(MeshSlices { normals: &[[0.0; 3]; 3], ..SQUARE }), lengths("normals", 3));
        assert_eq!(refused(MeshSlices { uvs: &[[0.0; 2]; 5], ..SQUARE }), lengths("texture coordinates", 5));
        assert_eq!(refused(MeshSlices { indices: &[0, 1], ..SQUARE }), SliceError::NoTriangles(2));
        let beyond = SliceError::Index { at: 4, index: 4, vertices: 4 };
        assert_eq!(refused(MeshSlices { indices: &[0, 1, 2, 0, 4, 2], ..SQUARE }), beyond);
        for bad in [f32::NAN, f32::INFINITY, -2e37] {
            let mut positions = POSITIONS;
            positions[2][1] = bad;
            assert_eq!(refused(MeshSlices { positions: &positions, ..SQUARE }), SliceError::Position(2));
        }
        let uvs = [[0.0, 0.0], [0.0, f32::NAN], [0.0, 0.0], [0.0, 0.0]];
        assert_eq!(refused(MeshSlices { uvs: &uvs, ..SQUARE }), SliceError::Uv(1));
    }
}
