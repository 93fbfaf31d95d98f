//! A primitive's triangles: lists, strips and fans, indexed or not.

use ::gltf::mesh::Mode;
use ::gltf::{Document, Mesh, Primitive};

use super::binder::NodeBinder;
use super::materials::Uvs;
pub use super::vertices::Pose;
use super::vertices::Vertices;
use super::{Accessors, Problem, vertices};
use crate::mesh::merge::LooseCorner;

/// Reads primitives and remembers what was odd about them.
#[derive(Debug, Default)]
pub struct Primitives {
    read: usize,
    points: usize,
    lines: usize,
    /// Primitives without normals, vertices with bad uvs or weights.
    without_normals: usize,
    bad_uvs: usize,
    bad_weights: usize,
    /// Indices at the end of lists that make no whole triangle.
    left_over: usize,
    /// Corners of triangles whose normal wasn't of unit length in the file.
    pub rescaled: u32,
}

/// A primitive's triangles, by its vertices.
pub struct Triangles {
    vertices: Vertices,
    mode: Mode,
    indices: Vec<u32>,
}

impl Triangles {
    /// Corners, and the numbers of their bindings: 0 for all if nothing moves.
    pub fn iter(&self) -> impl Iterator<Item = ([LooseCorner; 3], [u32; 3])> {
        let Vertices { corners, bindings, .. } = &self.vertices;
        let binding = |vertex: u32| bindings.get(vertex as usize).copied().unwrap_or_default();
        self.outward().map(move |t| (t.map(|vertex| corners[vertex as usize]), t.map(binding)))
    }

    /// Vertices of triangles, counter-clockwise seen from outside.
    fn outward(&self) -> impl Iterator<Item = [u32; 3]> {
        let outward = |[a, b, c]: [u32; 3]| if self.vertices.mirrored[a as usize] { [a, c, b] } else { [a, b, c] };
        triangles(self.mode, &self.indices).map(outward)
    }
}

impl Primitives {
    /// Whether there are no triangles in it by its very kind; counts it then.
    pub fn skip(&mut self, primitive: &Primitive) -> bool {
        let count = match primitive.mode() {
            Mode::Points => &mut self.points,
            Mode::Lines | Mode::LineLoop | Mode::LineStrip => &mut self.lines,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => return false,
        };
        *count += 1;
        true
    }

    /// The triangles of a primitive in the scene's space, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// [`Problem::Accessor`] and [`Problem::Primitive`].
    pub fn read(
        &mut self,
        mesh: &Mesh,
        primitive: &Primitive,
        pose: &Pose,
        uvs: Uvs,
        accessors: &Accessors,
        binder: Option<&mut NodeBinder>,
    ) -> Result<Triangles, Problem> {
        let name = name(mesh, primitive);
        let vertices = vertices::read(primitive, &name, pose, uvs, accessors, binder)?;
        let indices = match primitive.indices() {
            Some(accessor) => accessors.indices(&accessor, &format!("indices of {name}"))?,
            None => (0..vertices.corners.len() as u32).collect(),
        };
        self.count(&vertices.repairs, primitive.mode(), indices.len());
        let count = vertices.corners.len();
        if let Some((i, index)) = indices.iter().enumerate().find(|(_, index)| **index as usize >= count) {
            let reason = format!("uses vertex {index} of {count}, at index {i}");
            return Err(Problem::Primitive { primitive: name, reason });
        }
        let triangles = Triangles { vertices, mode: primitive.mode(), indices };
        let vertex_rescaled = |vertex: &u32| triangles.vertices.rescaled[*vertex as usize];
        self.rescaled += triangles.outward().flatten().filter(vertex_rescaled).count() as u32;
        Ok(triangles)
    }

    fn count(&mut self, repairs: &vertices::Repairs, mode: Mode, indices: usize) {
        self.read += 1;
        self.without_normals += usize::from(repairs.no_normals > 0);
        self.bad_uvs += repairs.bad_uvs;
        self.bad_weights += repairs.bad_weights;
        if mode == Mode::Triangles {
            self.left_over += indices % 3;
        }
    }

    /// What was left out or repaired, one sentence each; what the mesh's own repairs count is not among them.
    pub fn warnings(&self) -> Vec<String> {
        let sentences = [
            (self.without_normals, "primitives without normals, which got ones that are smooth within 60 degrees"),
            (self.bad_uvs, "uvs that aren't finite, replaced by (0, 0)"),
            (self.bad_weights, "vertices with unusable joints or weights, left unskinned"),
            (self.left_over, "indices at the end of triangle lists that make no whole triangle, left out"),
            (self.points, "primitives of points, left out"),
            (self.lines, "primitives of lines, left out"),
        ];
        let found = sentences.into_iter().filter(|(count, _)| *count > 0);
        found.map(|(count, sentence)| format!("{sentence}: {count}.")).collect()
    }

    /// What there is in place of triangles.
    pub fn holds(&self, document: &Document) -> String {
        match (document.meshes().len(), self.points, self.lines) {
            (0, ..) => "the document has no meshes".to_owned(),
            (_, 0, 0) if self.read == 0 => "no node of its scene has a mesh".to_owned(),
            (_, 0, 0) => format!("the {} primitives of its scene are empty", self.read),
            (_, points, lines) => format!("its scene holds {points} primitives of points and {lines} of lines"),
        }
    }
}

/// A primitive's place in the document, for messages.
pub fn name(mesh: &Mesh, primitive: &Primitive) -> String {
    let mesh_name = mesh.name().map_or(String::new(), |name| format!(" ({:?})", super::uri::shown(name)));
    format!("/meshes/{}/primitives/{}{mesh_name}", mesh.index(), primitive.index())
}

/// Indices as triangles (specification, section 3.7.2.1). Triangles of a strip or fan that use a vertex twice only
/// carry it to its next part and are dropped; those of a list are kept.
fn triangles(mode: Mode, indices: &[u32]) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
    let whole = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::TriangleStrip => {
            let windows = indices.array_windows().enumerate();
            Box::new(windows.map(|(i, &[a, b, c])| if i % 2 == 0 { [a, b, c] } else { [a, c, b] }).filter(whole))
        }
        Mode::TriangleFan => {
            let Some((&hub, rim)) = indices.split_first() else { return Box::new(std::iter::empty()) };
            Box::new(rim.array_windows().map(move |&[a, b]| [a, b, hub]).filter(whole))
        }
        _ => Box::new(indices.as_chunks().0.iter().copied()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
        triangles(mode, indices).collect()
    }

    #[test]
    fn strips_alternate_and_fans_turn() {
        let indices = [0, 1, 2, 3, 4];
        assert_eq!(all(Mode::TriangleStrip, &indices), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(all(Mode::TriangleFan, &indices), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert_eq!(all(Mode::Triangles, &indices), [[0, 1, 2]]);
    }

    #[test]
    fn stitches_of_strips_are_dropped() {
        assert_eq!(all(Mode::TriangleStrip, &[0, 1, 2, 2, 3, 3, 4, 5]), [[0, 1, 2], [3, 5, 4]]);
        for mode in [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan] {
            assert!(all(mode, &[]).is_empty() && all(mode, &[7]).is_empty());
        }
    }
}
