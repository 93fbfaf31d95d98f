//! Reads the triangles of a primitive: lists, strips and fans, with or without indices.

use ::gltf::mesh::Mode;
use ::gltf::{Document, Mesh, Primitive, Semantic};

use super::accessor::List;
use super::animated_vertices::{self, AnimatedVertices};
use super::materials::Resolved;
use super::notes::Notes;
use super::primitive_data::PrimitiveData;
use super::rig_builder::NodeBinder;
use crate::Budget;
use crate::face_builder::{is_near, unplaced};
use crate::import::Import;
use geometry::casts::to_u32;
use geometry::mesh::MemoryRefused;
use geometry::mesh::detail_table::DetailTable;

use super::vertex_repairs::VertexRepairs;
pub(super) use super::vertices::NodePose;
use super::vertices::{Vertex, Vertices};
use super::{Accessors, GltfError};
use geometry::mesh::mesh_builder::{CornerRepairs, MeshBuilder, StoredCorner};

/// Reads primitives, and counts what was repaired or left out.
#[derive(Debug, Default)]
pub(super) struct PrimitiveReader {
    import: Import,
    read: usize,
    points: usize,
    lines: usize,
    positionless: usize,
    repairs: VertexRepairs,
    /// What is wrong with attributes that a primitive can do without.
    pub notes: Notes,
    /// Indices at the end of a list that don't make a whole triangle.
    left_over: usize,
    /// Corners of triangles whose normal wasn't of unit length in the file.
    pub rescaled: u32,
    /// Triangles with a position that isn't finite or is too far away, and the primitive of the first one.
    unplaced: (usize, Option<String>),
}

/// A primitive that is to be read, and where it goes.
pub(super) struct Job<'a, 'b> {
    pub mesh: &'a Mesh<'a>,
    pub primitive: &'a Primitive<'a>,
    pub pose: &'a NodePose<'a>,
    pub material: Resolved,
    pub accessors: &'a Accessors<'a>,
    pub builder: &'b mut MeshBuilder,
    /// None if no material needs details of corners.
    pub details: Option<&'b mut DetailTable>,
}

/// The vertices of a primitive's triangles. Without indices they are in order.
struct Indices<'a> {
    list: Option<List<'a, u32>>,
    count: usize,
}

impl<'a> Indices<'a> {
    /// Those of a primitive with so many vertices.
    ///
    /// # Errors
    /// [`GltfError::Accessor`].
    fn of(source: &PrimitiveData<'a>, vertices: usize) -> Result<Self, GltfError> {
        let list = source.primitive.indices().map(|accessor| match source.unpacked {
            Some(unpacked) => Ok(List::of(&unpacked.indices, 0)),
            None => source.accessors.indices(&accessor, &format!("indices of {}", source.name)),
        });
        let list = list.transpose()?;
        let count = list.as_ref().map_or(vertices, List::len);
        Ok(Self { list, count })
    }

    fn get(&self, i: usize) -> u32 {
        self.list.as_ref().map_or(to_u32(i), |list| list.get(i))
    }

    /// Calls `take` with the number of the first index, and some indices, until it has had all. All lists but the last have
    /// [`BLOCK`] indices.
    fn in_blocks<E>(&self, mut take: impl FnMut(usize, &[u32]) -> Result<(), E>) -> Result<(), E> {
        let mut block = Vec::with_capacity(BLOCK.min(self.count));
        for first in (0..self.count).step_by(BLOCK) {
            let range = first..(first + BLOCK).min(self.count);
            block.clear();
            match &self.list {
                Some(list) => list.append(range, &mut block),
                None => block.extend(range.map(to_u32)),
            }
            take(first, &block)?;
        }
        Ok(())
    }
}

/// How many vertices are read before their corners are stored.
const TOGETHER: usize = 256;

/// How many indices are decoded at a time: whole triangles.
const BLOCK: usize = 3 << 10;

impl PrimitiveReader {
    /// Prepares to read; normals are those that `import` says.
    pub(super) fn importing(import: Import) -> Self {
        Self { import, ..Self::default() }
    }

    /// Returns whether a primitive consists of points or lines, or has no positions, and counts it if so.
    pub(super) fn skip(&mut self, primitive: &Primitive) -> bool {
        let count = match primitive.mode() {
            Mode::Points => &mut self.points,
            Mode::Lines | Mode::LineLoop | Mode::LineStrip => &mut self.lines,
            _ if primitive.get(&Semantic::Positions).is_none() => {
                self.read += 1;
                &mut self.positionless
            }
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => return false,
        };
        *count += 1;
        true
    }

    /// Adds the triangles of a primitive to the builder, in the scene's space, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// [`GltfError::Accessor`], [`GltfError::Primitive`] and [`GltfError::TooLarge`].
    pub(super) fn read(&mut self, job: Job, mut binder: Option<&mut NodeBinder>) -> Result<(), GltfError> {
        let Job { mesh, primitive, pose, material, accessors, builder, details } = job;
        let name = name(mesh, primitive);
        let unpacked = accessors.unpacked.get(&[mesh.index(), primitive.index()]);
        let source =
            PrimitiveData { primitive, name: &name, accessors, unpacked, makes_normals: self.import.makes_normals() };
        let is_morphing = animated_vertices::may_morph(binder.as_deref_mut(), primitive);
        let (is_detailed, repairs, budget) = (details.is_some(), self.repairs, accessors.budget);
        let mut vertices = Vertices::new(source, pose, material, is_detailed, is_morphing, repairs, &mut self.notes)?;
        let moving = binder.map(|binder| AnimatedVertices::new(budget, &vertices, pose.instance, is_morphing, binder));
        let indices = Indices::of(&source, vertices.count)?;
        // The number and the marks of each vertex's corner, and a bit that says whether it is used.
        budget.borrow(vertices.count as u64 * 5 + vertices.count as u64 / 8).map_err(too_large)?;
        let used = used(&indices, vertices.count).map_err(|reason| source.problem(reason))?;
        let kept = KeptVertices::of(&mut vertices, &used, moving, details, builder, budget)?;
        let (mode, count) = (primitive.mode(), indices.count);
        self.repairs = vertices.repairs;
        self.read += 1;
        if mode == Mode::Triangles {
            self.left_over += count % 3;
        }
        builder.make_room_for_triangles(material.index, most_triangles(mode, count), budget).map_err(too_large)?;
        let unplaced = self.add_triangles(mode, &indices, &kept, builder, material.index)?;
        if unplaced > 0 {
            self.unplaced.0 += unplaced;
            self.unplaced.1.get_or_insert_with(|| name.clone());
        }
        Ok(())
    }

    /// Adds the triangles of stored corners, whose material has this number. Returns how many are left out, since they have a position
    /// that can't be drawn.
    fn add_triangles(
        &mut self,
        mode: Mode,
        indices: &Indices,
        kept: &KeptVertices,
        builder: &mut MeshBuilder,
        material: usize,
    ) -> Result<usize, GltfError> {
        let mut unplaced = 0;
        let mut add = |[a, b, c]: [u32; 3]| {
            if [a, b, c].iter().any(|&i| kept.has(i, KeptVertices::UNPLACED)) {
                unplaced += 1;
                return;
            }
            let outward = if kept.has(a, KeptVertices::MIRRORED) { [a, c, b] } else { [a, b, c] };
            self.rescaled += outward.map(|i| u32::from(kept.has(i, KeptVertices::RESCALED))).iter().sum::<u32>();
            builder.stored_triangle(material, outward.map(|i| kept.get(i)));
        };
        if mode != Mode::Triangles {
            triangles(mode, indices.count, |i| indices.get(i)).for_each(add);
            return Ok(unplaced);
        }
        indices.in_blocks(|_, block| {
            block.as_chunks().0.iter().for_each(|triangle| add(*triangle));
            Ok::<_, GltfError>(())
        })?;
        Ok(unplaced)
    }

    /// Returns what was left out or repaired, one sentence each, except for the mesh's own repairs.
    pub(super) fn warnings(&self) -> Vec<String> {
        let VertexRepairs { without_normals, bad_uvs, missing_uvs, bad_colors, bad_tangents, bad_weights, .. } =
            self.repairs;
        let (without_normals, made) = self.import.lacking_normals(without_normals, "primitives without normals");
        let sentences = [
            (without_normals, made.as_str()),
            (bad_uvs, "uvs that aren't finite, replaced by (0, 0)"),
            (missing_uvs, "primitives without the texture coordinates of a map, which has (0, 0) there"),
            (bad_colors, "colours of vertices that aren't finite, replaced by white"),
            (bad_tangents, "tangents without a direction, replaced by ones that are computed"),
            (bad_weights, "vertices with unusable joints or weights, left unskinned"),
            (self.left_over, "indices at the end of triangle lists that make no whole triangle, left out"),
            (self.points, "primitives of points, left out"),
            (self.lines, "primitives of lines, left out"),
            (self.positionless, "primitives without positions, left out"),
        ];
        let found = sentences.into_iter().filter(|(count, _)| *count > 0);
        let mut found: Vec<_> = found.map(|(count, sentence)| format!("{sentence}: {count}.")).collect();
        if without_normals > 0 && self.import.crease_angle > 0.0 {
            // It is the first.
            found[0].push_str(" glTF asks for flat ones, which a crease angle of 0 gives.");
        }
        if self.repairs.cut_weights > 0 {
            let (count, percent) = (self.repairs.cut_weights, self.repairs.largest_cut * 100.0);
            let said = "vertices that more than four joints move, of which the four with the largest weights are kept";
            found.push(format!("{said}: {count}. At most {percent:.2} % of a vertex's weights are left out."));
        }
        found.extend(self.unplaced().map(|unplaced| format!("{unplaced}; they are left out.")));
        found
    }

    /// Returns what the document holds instead of triangles.
    pub(super) fn holds(&self, document: &Document) -> String {
        match (document.meshes().len(), self.points, self.lines) {
            (0, ..) => "the document has no meshes".to_owned(),
            (_, 0, 0) if self.read == 0 => "no node of its scene has a mesh".to_owned(),
            (_, 0, 0) => {
                self.unplaced().unwrap_or_else(|| format!("the {} primitives of its scene are empty", self.read))
            }
            (_, points, lines) => format!("its scene holds {points} primitives of points and {lines} of lines"),
        }
    }

    fn unplaced(&self) -> Option<String> {
        let (count, first) = &self.unplaced;
        first.as_ref().map(|first| unplaced(*count, first))
    }
}

/// The corners of a primitive's vertices in the builder.
struct KeptVertices {
    ids: Vec<u32>,
    /// The corner's repairs, and three bits more.
    marks: Vec<u8>,
}

impl KeptVertices {
    const MIRRORED: u8 = 1 << CornerRepairs::BITS;
    const RESCALED: u8 = 2 << CornerRepairs::BITS;
    const UNPLACED: u8 = 4 << CornerRepairs::BITS;

    fn new(count: usize) -> Self {
        Self { ids: Vec::with_capacity(count), marks: Vec::with_capacity(count) }
    }

    /// Stores the corners of the vertices whose bit in `used` is set, with what moves them and their details.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] and [`GltfError::TooLarge`].
    fn of(
        vertices: &mut Vertices,
        used: &[u64],
        mut moving: Option<AnimatedVertices>,
        mut details: Option<&mut DetailTable>,
        builder: &mut MeshBuilder,
        budget: &Budget,
    ) -> Result<Self, GltfError> {
        let is_stored =
            |kept: &Self, i: usize| used[i / 64] & 1 << (i % 64) != 0 && !kept.has(to_u32(i), Self::UNPLACED);
        let mut kept = Self::new(vertices.count);
        let (mut corners, mut stored) = (Vec::with_capacity(TOGETHER), Vec::with_capacity(TOGETHER));
        for first in (0..vertices.count).step_by(TOGETHER) {
            let range = first..(first + TOGETHER).min(vertices.count);
            corners.clear();
            for i in range.clone() {
                let vertex = vertices.read(i);
                let binding = moving.as_mut().map_or(0, |moving| moving.bind(i, vertices, &vertex.corner));
                kept.mark(&vertex);
                if is_stored(&kept, i) {
                    let binding = match &mut details {
                        Some(details) => details.number(vertex.detail, binding, budget).map_err(too_large)?,
                        None => binding,
                    };
                    corners.push((vertex.corner, binding));
                }
            }
            builder.make_room(corners.len(), budget).map_err(too_large)?;
            stored.clear();
            builder.corners(&corners, &mut stored);
            let mut stored = stored.iter().copied();
            range.for_each(|i| {
                let own = if is_stored(&kept, i) { stored.next() } else { None };
                kept.push(own.unwrap_or_default());
            });
        }
        Ok(kept)
    }

    /// Notes how the next vertex was read.
    fn mark(&mut self, vertex: &Vertex) {
        let mark = |is: bool, bit: u8| if is { bit } else { 0 };
        let unplaced = mark(!is_near(&vertex.corner), Self::UNPLACED);
        self.marks.push(mark(vertex.mirrored, Self::MIRRORED) | mark(vertex.rescaled, Self::RESCALED) | unplaced);
    }

    /// Adds the corner of the first vertex without one.
    fn push(&mut self, kept: StoredCorner) {
        self.marks[self.ids.len()] |= kept.repairs.0;
        self.ids.push(kept.id);
    }

    fn has(&self, i: u32, mark: u8) -> bool {
        self.marks[i as usize] & mark != 0
    }

    fn get(&self, i: u32) -> StoredCorner {
        let repairs = CornerRepairs(self.marks[i as usize] & (Self::MIRRORED - 1));
        StoredCorner { id: self.ids[i as usize], repairs }
    }
}

/// The error of a scene that takes too much memory.
fn too_large(refused: MemoryRefused) -> GltfError {
    GltfError::TooLarge { what: "the scene".to_owned(), reason: refused.into() }
}

/// Returns a bit for each vertex that says whether an index names it.
///
/// # Errors
/// A clause if an index isn't a vertex.
fn used(indices: &Indices, count: usize) -> Result<Vec<u64>, String> {
    if indices.list.is_none() {
        return Ok(vec![u64::MAX; count.div_ceil(64)]);
    }
    let mut used = vec![0; count.div_ceil(64)];
    indices.in_blocks(|first, block| {
        for (i, &index) in (first..).zip(block) {
            let index = index as usize;
            if index >= count {
                return Err(format!("uses vertex {index} at index {i}, but has {count} vertices"));
            }
            used[index / 64] |= 1 << (index % 64);
        }
        Ok(())
    })?;
    Ok(used)
}

/// Returns a primitive's place in the document, for messages.
pub(super) fn name(mesh: &Mesh, primitive: &Primitive) -> String {
    let mesh_name = mesh.name().map_or(String::new(), |name| format!(" ({:?})", crate::uri::shown(name)));
    format!("/meshes/{}/primitives/{}{mesh_name}", mesh.index(), primitive.index())
}

/// Returns the greatest number of triangles that so many indices make.
pub(super) fn most_triangles(mode: Mode, indices: usize) -> usize {
    if mode == Mode::Triangles { indices / 3 } else { indices.saturating_sub(2) }
}

/// Converts indices into triangles (specification, section 3.7.2.1). In a strip or fan, a triangle that uses a vertex
/// twice only connects parts and is dropped; in a list, it is kept.
fn triangles(mode: Mode, count: usize, at: impl Fn(usize) -> u32) -> impl Iterator<Item = [u32; 3]> {
    (0..most_triangles(mode, count)).filter_map(move |i| {
        let triangle = match mode {
            Mode::TriangleStrip if i % 2 == 0 => [i, i + 1, i + 2],
            Mode::TriangleStrip => [i, i + 2, i + 1],
            Mode::TriangleFan => [i + 1, i + 2, 0],
            _ => [3 * i, 3 * i + 1, 3 * i + 2],
        };
        let [a, b, c] = triangle.map(&at);
        let is_whole = a != b && b != c && c != a;
        (is_whole || mode == Mode::Triangles).then_some([a, b, c])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
        triangles(mode, indices.len(), |i| indices[i]).collect()
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
