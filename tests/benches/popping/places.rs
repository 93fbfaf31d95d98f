//! Fixed places on every patch, at which the surfaces of two frames are compared. They divide each edge of a patch's domain into
//! 16 segments, so that they are exact in 16.16 fixed point.

use std::ops::RangeInclusive;

use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{Inputs, LodView, Normals, Partitioning, Tessellation, tessellate, unpack_normal};
use glam::{DVec3, Vec3};

const STEPS: u32 = 16;
/// The distance between places in the domain, in 16.16 fixed point.
const SPACING: u32 = 65536 / STEPS;
/// The number of places of a patch.
pub(crate) const PER_PATCH: usize = (STEPS as usize + 1) * (STEPS as usize + 2) / 2;
/// The least cosine of the angle between normals that count as equal: 1 degree, as for LOD by error.
const AGREEING: f32 = 0.99985;

/// The limit surface at a place: its position in object units, and its unit normal.
#[derive(Clone, Copy, Default)]
pub(crate) struct Place {
    pub position: DVec3,
    pub normal: DVec3,
}

/// The places of all patches of a mesh.
pub(crate) struct Places {
    places: Vec<Place>,
    is_flat: Vec<bool>,
}

impl Places {
    pub(crate) fn new(mesh: &Mesh, topology: &Topology) -> Self {
        // A tessellation whose vertices are the places, with the normals of the limit surface.
        let tessellation = Tessellation {
            partitioning: Partitioning::Subtriangulation,
            factor: STEPS as f32,
            normals: Normals::Surface,
            ..Tessellation::default()
        };
        let made = tessellate(mesh, topology, &Inputs::new(&tessellation, LodView::default()), None);
        let mut places = vec![Place::default(); topology.patches.len() * PER_PATCH];
        for vertex in &made.vertices {
            let [i, j] = vertex.domain().map(|x| (x + SPACING / 2) / SPACING);
            places[vertex.patch() as usize * PER_PATCH + index(i, j)] = Place {
                position: Vec3::from(vertex.position).as_dvec3(),
                normal: unpack_normal(vertex.normal).as_dvec3(),
            };
        }
        let patches = 0..topology.patches.len() as u32;
        Self { places, is_flat: patches.map(|patch| is_flat(mesh, topology, patch)).collect() }
    }

    /// The places of a patch.
    pub(crate) fn of_patch(&self, patch: usize) -> &[Place] {
        &self.places[patch * PER_PATCH..][..PER_PATCH]
    }

    /// Whether a patch looks the same wherever its points slide.
    pub(crate) fn is_flat(&self, patch: usize) -> bool {
        self.is_flat[patch]
    }
}

/// Returns the number of a place of a patch: that at weights of i / 16 of corner 0 and j / 16 of corner 1.
fn index(i: u32, j: u32) -> usize {
    (i * (2 * STEPS + 3 - i) / 2 + j) as usize
}

fn is_flat(mesh: &Mesh, topology: &Topology, patch: u32) -> bool {
    let [a, b, c] = topology.patch_corners(patch).map(|corner| mesh.corners[corner as usize].normal);
    let has_texture =
        mesh.materials.get(topology.material_of(patch)).is_some_and(|material| material.texture.is_some());
    a.dot(b).min(b.dot(c)).min(c.dot(a)) >= AGREEING && !has_texture
}

/// Calls `found` with every place within a triangle of a pattern, and the place's weights of the triangle's corners. The corners
/// are domain points in 16.16 fixed point. A triangle without area has no places.
pub(crate) fn places_within(corners: [[u32; 2]; 3], mut found: impl FnMut(usize, [f64; 3])) {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    // Exact: twice a triangle's area is at most 2^32.
    let cross = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let area = cross(a, b, c);
    if area == 0 {
        return;
    }
    let along = |k: usize| -> RangeInclusive<u32> {
        let [low, high] =
            [corners.iter().map(|p| p[k]).min(), corners.iter().map(|p| p[k]).max()].map(Option::unwrap_or_default);
        low.div_ceil(SPACING)..=high / SPACING
    };
    for i in along(0) {
        for j in along(1) {
            let p = [i, j].map(|x| i64::from(x * SPACING));
            let parts = [cross(p, b, c), cross(a, p, c), cross(a, b, p)].map(|part| part * area.signum());
            if parts.iter().all(|&part| part >= 0) {
                found(index(i, j), parts.map(|part| part as f64 / area.abs() as f64));
            }
        }
    }
}
