//! How much a scene will be, before any of it is read: what a document repeats is what a small file asks much with.

use std::collections::HashMap;

use ::gltf::accessor::Accessor;
use ::gltf::mesh::Mode;
use ::gltf::{Document, Mesh, Semantic};

use super::nodes::Placed;
use super::{Accessors, Problem, primitive};
use crate::load::memory_budget::Budget;
use crate::mesh::build_limits::MAX_TRIANGLES;
use crate::mesh::interner::Interner;
use crate::mesh::{MemoryAccount, MemoryRefused};

/// Vertices, displacements of them and indices that are read at most, each as often as it is used.
const MAX_ELEMENTS: u64 = 1 << 29;

/// Memory for a corner and for a triangle while they are gathered, in bytes (see [`crate::load::memory_budget`]), and for what moves a
/// corner.
const PER_CORNER: u64 = 32;
const PER_TRIANGLE: u64 = 12;
/// What a vertex counts that is nowhere: it takes time, and no file brings it.
const PER_ZERO: u64 = 100;
const PER_BOUND: u64 = 240;
/// As much as reading a primitive takes beside its elements, and a node.
const PER_PRIMITIVE: u64 = 200;

/// Of a mesh, or of all that is shown.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    triangles: u64,
    /// Distinct ones: at most, or where nothing is said of it as many as a closed surface has.
    corners: u64,
    /// Vertices of triangles, at most.
    vertices: u64,
    /// Those of which the file holds nothing.
    zeros: u64,
    elements: u64,
    primitives: u64,
}

/// Makes sure that all that is shown is there, and that there is room for it, which is held. How many vertices of
/// triangles there are at most, and how many distinct corners there may be.
///
/// # Errors
/// [`Problem::Accessor`], and [`Problem::TooLarge`].
pub fn check(
    document: &Document,
    placed: &Placed,
    accessors: &Accessors,
    budget: &Budget,
    moves: bool,
) -> Result<[usize; 2], Problem> {
    let mut known: HashMap<usize, Extent> = HashMap::new();
    let mut all = Extent::default();
    for node in placed.shown.iter().filter_map(|&index| document.nodes().nth(index)) {
        let Some(mesh) = node.mesh() else { continue };
        let extent = match known.get(&mesh.index()) {
            Some(extent) => *extent,
            None => {
                let extent = Extent::of(&mesh, accessors)?;
                known.insert(mesh.index(), extent);
                extent
            }
        };
        all.add(extent);
        let joints = node.skin().map_or(0, |skin| skin.joints().len() as u64);
        all.elements = all.elements.saturating_add(joints);
    }
    let refuse = |count: u64, what: &str, most: u64| {
        let reason = format!("{count} {what}, and {most} are read at most");
        Err(Problem::TooLarge { what: "the scene has".to_owned(), reason })
    };
    if all.triangles > MAX_TRIANGLES {
        return refuse(all.triangles, "triangles", MAX_TRIANGLES);
    }
    if all.elements > MAX_ELEMENTS {
        return refuse(all.elements, "vertices, displacements of them and indices", MAX_ELEMENTS);
    }
    let moving = if moves { all.vertices.saturating_mul(PER_BOUND) } else { 0 };
    let read = Interner::bytes_for(all.corners as usize) + all.triangles * PER_TRIANGLE;
    // All triangles in one list, when the buffers are no longer held.
    let finished = (all.corners * 4 + all.triangles * 2 * PER_TRIANGLE).saturating_sub(accessors.buffer_bytes());
    let finished = if all.primitives > 1 { finished } else { 0 };
    let too_large = |refused: MemoryRefused| Problem::TooLarge {
        what: format!("the scene of {} triangles", all.triangles),
        reason: refused.into(),
    };
    let beside = moving.saturating_add(all.primitives.saturating_mul(PER_PRIMITIVE));
    let ahead = all.corners * PER_CORNER + all.zeros * PER_ZERO + read.max(finished);
    let borrowed = budget.borrowed();
    budget.hold(beside).and_then(|()| budget.borrow(ahead)).map_err(too_large)?;
    // That was a look ahead: the builder takes it as it goes.
    budget.give_back_to(borrowed);
    Ok([all.vertices as usize, all.corners as usize])
}

impl Extent {
    fn of(mesh: &Mesh, accessors: &Accessors) -> Result<Self, Problem> {
        let mut extent = Self::default();
        for primitive in mesh.primitives() {
            extent.primitives += 1;
            let Some(positions) = primitive.get(&Semantic::Positions).filter(|_| is_read(primitive.mode())) else {
                continue;
            };
            let name = primitive::name(mesh, &primitive);
            // What was decompressed is there, and as much as the accessors say.
            let is_unpacked = accessors.unpacked.contains_key(&[mesh.index(), primitive.index()]);
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
            let triangles = primitive::most_triangles(primitive.mode(), indices as usize) as u64;
            let used = vertices.min(triangles.saturating_mul(3));
            let targets = primitive.morph_targets().len() as u64;
            extent.add(Self {
                triangles,
                corners: if primitive.indices().is_some() { used } else { used.min(triangles / 2 + 2) },
                vertices: used,
                zeros: if positions.view().is_none() && !is_unpacked { vertices } else { 0 },
                elements: vertices.saturating_mul(1 + targets).saturating_add(indices),
                primitives: 0,
            });
        }
        Ok(extent)
    }

    fn add(&mut self, other: Self) {
        self.triangles = self.triangles.saturating_add(other.triangles);
        self.corners = self.corners.saturating_add(other.corners);
        self.vertices = self.vertices.saturating_add(other.vertices);
        self.zeros = self.zeros.saturating_add(other.zeros);
        self.elements = self.elements.saturating_add(other.elements);
        self.primitives = self.primitives.saturating_add(other.primitives);
    }
}

fn is_read(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}
