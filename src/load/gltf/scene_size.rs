//! Computes the size of a scene before it is read: with a mesh on many nodes, a small file can ask for much memory.

use std::collections::HashMap;

use ::gltf::accessor::Accessor;
use ::gltf::{Document, Mesh, Semantic};

use super::extensions::InstancingExtension;
use super::nodes::Placed;
use super::{Accessors, GltfError, instances, primitive};
use crate::memory_budget::edge_bytes;
use geometry::casts::to_usize;
use geometry::mesh::borrowing;
use geometry::mesh::build_limits::MAX_TRIANGLES;
use geometry::mesh::detail_table::{DetailTable, id_bytes};

/// The greatest number of vertices, their displacements and indices, each counted as often as it is used.
const MAX_ELEMENTS: u64 = 1 << 29;

/// Memory for a corner while the mesh is built, in bytes (see [`crate::memory_budget`]).
const PER_CORNER: u64 = 32;
/// Memory for a triangle while the mesh is built, in bytes.
const PER_TRIANGLE: u64 = 12;
/// What a vertex without data in the file counts as, in bytes: it takes time, and adds nothing to the file's size.
const PER_ZERO: u64 = 100;
/// Memory for the binding of a corner of an animated mesh, in bytes.
const PER_BOUND: u64 = 256;
/// Memory for reading a primitive and its node, in bytes, besides its elements.
const PER_PRIMITIVE: u64 = 200;

/// Memory for the details of a corner once they are read, in bytes.
const PER_DETAIL: u64 = 104;

/// The size of a mesh, or of all that is shown.
#[derive(Clone, Copy, Debug, Default)]
struct SceneSize {
    triangles: u64,
    /// The number of distinct corners: the greatest possible, or without indices that of a closed surface.
    corners: u64,
    /// The greatest number of vertices that triangles use.
    vertices: u64,
    /// Vertices without data in the file.
    zeros: u64,
    elements: u64,
    primitives: u64,
}

/// What is known of a scene before it is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneNeeds {
    /// The greatest number of vertices of triangles.
    pub vertices: usize,
    /// The greatest number of distinct corners.
    pub corners: usize,
    /// The memory that the rest of the load takes beside textures, in bytes, until the mesh has its edges.
    pub bytes: u64,
}

/// Checks that the data of everything that is shown is there, and that the budget has room for it. `moves` says whether vertices have
/// bindings to joints, and `is_detailed` whether corners have details.
///
/// # Errors
/// [`GltfError::Accessor`], and [`GltfError::TooLarge`].
pub(crate) fn check(
    document: &Document,
    placed: &Placed,
    instances: &HashMap<usize, InstancingExtension>,
    accessors: &Accessors,
    moves: bool,
    is_detailed: bool,
) -> Result<SceneNeeds, GltfError> {
    let budget = accessors.budget;
    let mut known: HashMap<usize, SceneSize> = HashMap::new();
    let mut all = SceneSize::default();
    for node in placed.shown.iter().filter_map(|&index| document.nodes().nth(index)) {
        let Some(mesh) = node.mesh() else { continue };
        let size = match known.get(&mesh.index()) {
            Some(size) => *size,
            None => {
                let size = SceneSize::new(&mesh, accessors)?;
                known.insert(mesh.index(), size);
                size
            }
        };
        let own = instances.get(&node.index()).filter(|_| node.skin().is_none());
        all.add(size, own.map_or(1, |own| instances::count(document, own) as u64));
        let joints = node.skin().map_or(0, |skin| skin.joints().len() as u64);
        all.elements = all.elements.saturating_add(joints);
    }
    let refuse = |count: u64, what: &str, most: u64| {
        let reason = format!("{count} {what}, but at most {most} are read");
        Err(GltfError::TooLarge { what: "the scene has".to_owned(), reason })
    };
    if all.triangles > MAX_TRIANGLES {
        return refuse(all.triangles, "triangles", MAX_TRIANGLES);
    }
    if all.elements > MAX_ELEMENTS {
        return refuse(all.elements, "vertices, displacements of vertices and indices", MAX_ELEMENTS);
    }
    let moving = if moves { all.vertices.saturating_mul(PER_BOUND) } else { 0 };
    let details = if is_detailed { DetailTable::bytes_for(to_usize(all.corners)) } else { 0 };
    let read = id_bytes(to_usize(all.corners)) + all.triangles * PER_TRIANGLE;
    // All triangles are put into one list after the buffers have been freed.
    let finished = (all.corners * 4 + all.triangles * 2 * PER_TRIANGLE).saturating_sub(accessors.buffer_bytes());
    let finished = if all.primitives > 1 { finished } else { 0 };
    let scene = format!("the scene of {} triangles", all.triangles);
    let beside = moving.saturating_add(all.primitives.saturating_mul(PER_PRIMITIVE));
    let ahead = all.corners * PER_CORNER + all.zeros * PER_ZERO + details + read.max(finished);
    // What is borrowed is only checked: the builder takes the memory as it goes.
    let ahead_of = || borrowing(budget, || budget.borrow(ahead)).inspect_err(|_| budget.release(beside));
    budget.hold(beside).and_then(|()| ahead_of()).map_err(GltfError::too_large(&scene))?;
    // By then the file's data has been freed.
    let edges = edge_bytes(all.corners, all.triangles) + if is_detailed { all.corners * PER_DETAIL } else { 0 };
    let bytes = ahead.max(edges.saturating_sub(accessors.buffer_bytes()));
    Ok(SceneNeeds { vertices: to_usize(all.vertices), corners: to_usize(all.corners), bytes })
}

impl SceneSize {
    fn new(mesh: &Mesh, accessors: &Accessors) -> Result<Self, GltfError> {
        let mut size = Self::default();
        for primitive in mesh.primitives() {
            // Points and lines have no attributes.
            let Some(positions) = primitive.get(&Semantic::Positions) else {
                size.primitives += 1;
                continue;
            };
            let name = primitive::name(mesh, &primitive);
            // The size of decompressed data has been compared with the accessors.
            let is_unpacked = accessors.unpacked.contains_key(&[mesh.index(), primitive.index()]);
            if !is_unpacked {
                let targets =
                    primitive.morph_targets().flat_map(|own| [own.positions(), own.normals(), own.tangents()]);
                let attributes = primitive.attributes().map(|(_, accessor)| accessor);
                attributes.chain(targets.flatten()).for_each(|accessor| accessors.prepare(&accessor));
            }
            let check = |accessor: &Accessor, role: &str| match is_unpacked {
                true => Ok(()),
                false => accessors.check(accessor, &format!("{role} of {name}")),
            };
            check(&positions, "POSITION")?;
            let vertices = positions.count() as u64;
            let mut indices = vertices;
            if let Some(accessor) = primitive.indices() {
                check(&accessor, "indices")?;
                indices = accessor.count() as u64;
            }
            let triangles = primitive::most_triangles(primitive.mode(), to_usize(indices)) as u64;
            let used = vertices.min(triangles.saturating_mul(3));
            let targets = primitive.morph_targets().len() as u64;
            let own = Self {
                triangles,
                corners: if primitive.indices().is_some() { used } else { used.min(triangles / 2 + 2) },
                vertices: used,
                zeros: if positions.view().is_none() && !is_unpacked { vertices } else { 0 },
                elements: vertices.saturating_mul(1 + targets).saturating_add(indices),
                primitives: 1,
            };
            size.add(own, 1);
        }
        Ok(size)
    }

    /// Adds another size, so many times.
    fn add(&mut self, other: Self, times: u64) {
        let add = |to: &mut u64, from: u64| *to = to.saturating_add(from.saturating_mul(times));
        add(&mut self.triangles, other.triangles);
        add(&mut self.corners, other.corners);
        add(&mut self.vertices, other.vertices);
        add(&mut self.zeros, other.zeros);
        add(&mut self.elements, other.elements);
        add(&mut self.primitives, other.primitives);
    }
}
