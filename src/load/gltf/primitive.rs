//! Reads the triangles of a primitive: lists, strips and fans, with or without indices.

use std::convert::Infallible;
use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

use ::gltf::mesh::Mode;
use ::gltf::{Document, Mesh, Primitive, Semantic};

use super::accessor::List;
use super::animated_vertices::{self, AnimatedVertices};
use super::materials::Resolved;
use super::notes::{Notes, counted, counts};
use super::primitive_data::PrimitiveData;
use super::rig_builder::NodeBinder;
use crate::Budget;
use crate::face_builder::{is_near, unplaced};
use crate::import::Import;
use geometry::casts::to_u32;
use geometry::cores::in_ranges;
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::{MemoryRefused, PartStyle, Repairs};

use super::vertex_details::VertexRepairs;
pub(super) use super::vertices::NodePose;
use super::vertices::{Findings, Vertex, Vertices};
use super::{Accessors, GltfError};
use geometry::mesh::mesh_builder::{CornerRepairs, MeshBuilder, StoredCorner};

/// Reads primitives, and counts what was repaired or left out.
#[derive(Debug, Default)]
pub(super) struct PrimitiveReader {
    import: Import,
    read: usize,
    left_out: LeftOut,
    repairs: VertexRepairs,
    /// What is wrong with attributes that a primitive can do without.
    pub notes: Notes,
    /// Corners of triangles whose normal wasn't of unit length in the file.
    pub rescaled: u32,
    /// Triangles with a position that isn't finite or is too far away, and the primitive of the first one.
    unplaced: (usize, Option<String>),
}

counts! {
    struct LeftOut {
        left_over => "indices at the end of triangle lists that make no whole triangle, left out";
        points => "primitives of points, left out";
        lines => "primitives of lines, left out";
        positionless => "primitives without positions, left out";
    }
}

/// A primitive that is to be read, and where it goes.
pub(super) struct Job<'a, 'b> {
    pub mesh: &'a Mesh<'a>,
    pub primitive: &'a Primitive<'a>,
    pub pose: &'a NodePose<'a>,
    /// What its triangles have in place of what is said for all.
    pub style: PartStyle,
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
    fn new(source: &PrimitiveData<'a>, vertices: usize) -> Result<Self, GltfError> {
        let list = source.primitive.indices().map(|accessor| match source.unpacked {
            Some(unpacked) => Ok(List::new(&unpacked.indices, 0)),
            None => source.accessors.indices(&accessor, &format!("indices of {}", source.name)),
        });
        let list = list.transpose()?;
        let count = list.as_ref().map_or(vertices, List::len);
        Ok(Self { list, count })
    }

    fn get(&self, i: usize) -> u32 {
        self.list.as_ref().map_or(to_u32(i), |list| list.get(i))
    }

    /// Calls `take` with the number of the first index, and some indices, until it has had all of a range. All lists but the last have
    /// [`BLOCK`] indices.
    fn in_blocks<E>(&self, all: Range<usize>, mut take: impl FnMut(usize, &[u32]) -> Result<(), E>) -> Result<(), E> {
        let mut block = Vec::with_capacity(BLOCK.min(all.len()));
        for first in all.clone().step_by(BLOCK) {
            let range = first..(first + BLOCK).min(all.end);
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

/// How many of so many vertices, or triangles, are read on all cores before they are stored: so few that they take little memory beside
/// what is made of them all.
fn at_once(count: usize) -> usize {
    (count / 16).clamp(BATCH, 1 << 15)
}

/// The least number of vertices or triangles that are worth a thread.
const LEAST: usize = 1 << 10;

/// How many corners are stored before there is room for more.
const BATCH: usize = 256;

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
            Mode::Points => &mut self.left_out.points,
            Mode::Lines | Mode::LineLoop | Mode::LineStrip => &mut self.left_out.lines,
            _ if primitive.get(&Semantic::Positions).is_none() => {
                self.read += 1;
                &mut self.left_out.positionless
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
        let Job { mesh, primitive, pose, style, material, accessors, builder, details } = job;
        let name = name(mesh, primitive);
        let unpacked = accessors.unpacked.get(&[mesh.index(), primitive.index()]);
        let makes_normals = self.import.makes_normals_of(style);
        let source = PrimitiveData { primitive, name: &name, accessors, unpacked, makes_normals };
        let is_morphing = animated_vertices::may_morph(binder.as_deref_mut(), primitive);
        let (is_detailed, repairs, budget) = (details.is_some(), self.repairs, accessors.budget);
        let mut vertices = Vertices::new(source, pose, material, is_detailed, is_morphing, repairs, &mut self.notes)?;
        let moving = binder.map(|binder| AnimatedVertices::new(budget, &vertices, pose.instance, is_morphing, binder));
        let indices = Indices::new(&source, vertices.count)?;
        // The number and the marks of each vertex's corner, and a bit that says whether it is used.
        budget.borrow(vertices.count as u64 * 5 + vertices.count as u64 / 8).map_err(GltfError::large_scene)?;
        let used = used(&indices, vertices.count).map_err(|reason| source.problem(reason))?;
        let kept = KeptVertices::from_used(&mut vertices, &used, moving, details, builder, budget)?;
        drop(used);
        let (mode, count) = (primitive.mode(), indices.count);
        self.repairs = vertices.repairs;
        // Where it was chosen how they are made, none are missed.
        let are_missed = !makes_normals && style.crease_angle.is_none() && !source.has_normals(vertices.count);
        self.repairs.without_normals += usize::from(are_missed && vertices.count > 0);
        self.read += 1;
        if mode == Mode::Triangles {
            self.left_out.left_over += count % 3;
        }
        builder
            .make_room_for_triangles(material.index, most_triangles(mode, count), budget)
            .map_err(GltfError::large_scene)?;
        let unplaced = self.add_triangles(mode, &indices, &kept, builder, material.index);
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
    ) -> usize {
        let (all, mut unplaced) = (most_triangles(mode, indices.count), 0);
        let at_once = at_once(all);
        for first in (0..all).step_by(at_once) {
            let read = in_ranges(at_once.min(all - first), LEAST, |range| {
                PlacedTriangles::new(mode, indices, kept, first + range.start..first + range.end)
            });
            for some in read {
                unplaced += some.unplaced;
                self.rescaled += some.rescaled;
                builder.stored_triangles(material, &some.triangles, &some.repairs);
            }
        }
        unplaced
    }

    /// Returns what was left out or repaired, one sentence each, except for the mesh's own repairs.
    pub(super) fn warnings(&self) -> Vec<String> {
        let lacking = self.import.lacking_normals(self.repairs.without_normals, "primitives without normals");
        let mut found: Vec<_> = counted([lacking]).collect();
        if let Some(lacking) = found.first_mut().filter(|_| self.import.crease_angle > 0.0) {
            lacking.push_str(" glTF asks for flat ones, which a crease angle of 0 gives.");
        }
        found.extend(self.repairs.flaws.sentences().chain(self.left_out.sentences()));
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
        match (document.meshes().len(), self.left_out.points, self.left_out.lines) {
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

/// Triangles of stored corners.
#[derive(Default)]
struct PlacedTriangles {
    triangles: Vec<[u32; 3]>,
    repairs: Repairs,
    /// Their corners whose normal wasn't of unit length in the file.
    rescaled: u32,
    /// How many are left out, since they have a position that can't be drawn.
    unplaced: usize,
}

impl PlacedTriangles {
    /// Reads those of a primitive's triangles that have these numbers.
    fn new(mode: Mode, indices: &Indices, kept: &KeptVertices, numbers: Range<usize>) -> Self {
        let mut placed = Self { triangles: Vec::with_capacity(numbers.len()), ..Self::default() };
        if mode != Mode::Triangles {
            triangles(mode, numbers, |i| indices.get(i)).for_each(|triangle| placed.add(triangle, kept));
            return placed;
        }
        let Ok(()) = indices.in_blocks(3 * numbers.start..3 * numbers.end, |_, block| {
            block.as_chunks().0.iter().for_each(|triangle| placed.add(*triangle, kept));
            Ok::<_, Infallible>(())
        });
        placed
    }

    fn add(&mut self, [a, b, c]: [u32; 3], kept: &KeptVertices) {
        if [a, b, c].iter().any(|&i| kept.has(i, KeptVertices::UNPLACED)) {
            self.unplaced += 1;
            return;
        }
        let outward = if kept.has(a, KeptVertices::MIRRORED) { [a, c, b] } else { [a, b, c] };
        self.rescaled += outward.map(|i| u32::from(kept.has(i, KeptVertices::RESCALED))).iter().sum::<u32>();
        self.triangles.push(outward.map(|i| {
            let StoredCorner { id, repairs } = kept.get(i);
            repairs.count(&mut self.repairs);
            id
        }));
    }
}

/// Reads vertices one after another, and binds them to what moves them. Returns them with what was repaired.
fn read_vertices(
    vertices: &Vertices,
    range: Range<usize>,
    mut moving: Option<&mut AnimatedVertices>,
) -> (Vec<Vertex>, VertexRepairs) {
    let mut findings = Findings::default();
    let read = range.map(|i| {
        let vertex = vertices.read(i, &mut findings);
        let joints = findings.joints.as_deref();
        let binding = moving.as_mut().map_or(0, |moving| moving.bind(i, vertices, joints, &vertex.corner));
        Vertex { binding, ..vertex }
    });
    (read.collect(), findings.repairs)
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

    /// Stores the corners of the vertices whose bit in `used` is set, with what moves them and their details.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] and [`GltfError::TooLarge`].
    fn from_used(
        vertices: &mut Vertices,
        used: &[AtomicU64],
        mut moving: Option<AnimatedVertices>,
        mut details: Option<&mut DetailTable>,
        builder: &mut MeshBuilder,
        budget: &Budget,
    ) -> Result<Self, GltfError> {
        let mut kept = Self { ids: Vec::with_capacity(vertices.count), marks: Vec::with_capacity(vertices.count) };
        // What moves a vertex gets its number in the order of the vertices, and its memory before that of later corners.
        let at_once = if moving.is_some() { BATCH } else { at_once(vertices.count) };
        for first in (0..vertices.count).step_by(at_once) {
            let block = first..(first + at_once).min(vertices.count);
            let read = match &mut moving {
                Some(moving) => vec![read_vertices(vertices, block, Some(moving))],
                None => in_ranges(block.len(), LEAST, |range| {
                    read_vertices(vertices, first + range.start..first + range.end, None)
                }),
            };
            read.iter().for_each(|(_, repairs)| vertices.repairs.add(repairs));
            kept.store(&read, used, details.as_deref_mut(), builder, budget).map_err(GltfError::large_scene)?;
        }
        Ok(kept)
    }

    /// Stores the corners of the next vertices.
    fn store(
        &mut self,
        read: &[(Vec<Vertex>, VertexRepairs)],
        used: &[AtomicU64],
        mut details: Option<&mut DetailTable>,
        builder: &mut MeshBuilder,
        budget: &Budget,
    ) -> Result<(), MemoryRefused> {
        let is_stored =
            |&(i, own): &(usize, &Vertex)| used[i / 64].load(Relaxed) & 1 << (i % 64) != 0 && is_near(&own.corner);
        let numbered = (self.ids.len()..).zip(read.iter().flat_map(|(read, _)| read));
        let mut corners = Vec::with_capacity(read.iter().map(|(read, _)| read.len()).sum());
        for (_, own) in numbered.clone().filter(is_stored) {
            let binding = match &mut details {
                Some(details) => details.number(own.detail, own.binding, budget)?,
                None => own.binding,
            };
            corners.push((own.corner, binding));
        }
        let (mut rest, mut stored) = (&corners[..], Vec::with_capacity(corners.len()));
        while !rest.is_empty() {
            // Corners that turn out not to be distinct need room for a moment.
            builder.make_room(rest.len().min(BATCH), budget)?;
            let (now, later) = rest.split_at(rest.len().min(builder.room()));
            builder.corners(now, &mut stored);
            rest = later;
        }
        let mut stored = stored.into_iter();
        for own in numbered {
            let corner = if is_stored(&own) { stored.next().unwrap_or_default() } else { StoredCorner::default() };
            self.marks.push(Self::mark(own.1) | corner.repairs.0);
            self.ids.push(corner.id);
        }
        Ok(())
    }

    /// Returns how a vertex was read.
    fn mark(vertex: &Vertex) -> u8 {
        let mark = |is: bool, bit: u8| if is { bit } else { 0 };
        let unplaced = mark(!is_near(&vertex.corner), Self::UNPLACED);
        mark(vertex.mirrored, Self::MIRRORED) | mark(vertex.rescaled, Self::RESCALED) | unplaced
    }

    fn has(&self, i: u32, mark: u8) -> bool {
        self.marks[i as usize] & mark != 0
    }

    fn get(&self, i: u32) -> StoredCorner {
        let repairs = CornerRepairs(self.marks[i as usize] & (Self::MIRRORED - 1));
        StoredCorner { id: self.ids[i as usize], repairs }
    }
}

/// Returns a bit for each vertex that says whether an index names it.
///
/// # Errors
/// A clause if an index isn't a vertex.
fn used(indices: &Indices, count: usize) -> Result<Vec<AtomicU64>, String> {
    let is_listed = indices.list.is_some();
    let used: Vec<_> = (0..count.div_ceil(64)).map(|_| AtomicU64::new(if is_listed { 0 } else { u64::MAX })).collect();
    let mark = |first: usize, block: &[u32]| {
        for (i, &index) in (first..).zip(block) {
            let (index, bit) = (index as usize, 1 << (index % 64));
            if index >= count {
                return Err(format!("uses vertex {index} at index {i}, but has {count} vertices"));
            }
            // Most are used already, and are only read.
            if used[index / 64].load(Relaxed) & bit == 0 {
                used[index / 64].fetch_or(bit, Relaxed);
            }
        }
        Ok(())
    };
    let listed = if is_listed { indices.count } else { 0 };
    // The first range that fails has the first index that is none.
    in_ranges(listed, LEAST, |range| indices.in_blocks(range, mark)).into_iter().collect::<Result<(), _>>()?;
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

/// Converts indices into the triangles with these numbers (specification, section 3.7.2.1). In a strip or fan, a triangle that uses a vertex
/// twice only connects parts and is dropped; in a list, it is kept.
fn triangles(mode: Mode, numbers: Range<usize>, at: impl Fn(usize) -> u32) -> impl Iterator<Item = [u32; 3]> {
    numbers.filter_map(move |i| {
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
        triangles(mode, 0..most_triangles(mode, indices.len()), |i| indices[i]).collect()
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
