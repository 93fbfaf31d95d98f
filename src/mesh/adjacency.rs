//! Index buffers for PN-AEN: each patch with its neighbours' corners.
//!
//! The nine-index patch is that of McDonald and Kilgard 2010, "Crack-Free Point-Normal Triangles using Adjacent Edge
//! Normals"; the twelve-index one adds the dominant corners of McDonald 2011, "Tessellation on Any Budget", in the
//! order in which meshoptimizer writes them.

use super::topology::Topology;

/// A patch's corners 0, 1, 2, then the neighbours' corners across its sides 0-1, 1-2 and 2-0, each pair in the patch's
/// own direction: entry 3 lies on the same point as corner 0, entry 4 as corner 1, entry 5 as corner 1, and so on.
/// Where there is no single neighbour (a boundary, or three sides and more) the patch's own corners stand in.
///
/// # Panics
/// When `patch` isn't an index into [`Topology::patches`].
pub fn nine(topology: &Topology, patch: u32) -> [u32; 9] {
    let own = topology.patches[patch as usize].corners;
    let mut indices = [0; 9];
    indices[..3].copy_from_slice(&own);
    for k in 0..3 {
        let across = neighbour(topology, patch, k).unwrap_or([own[k], own[(k + 1) % 3]]);
        indices[3 + 2 * k..5 + 2 * k].copy_from_slice(&across);
    }
    indices
}

/// The nine of [`nine`], then the dominant corner of corners 0, 1 and 2: the lowest corner on the same point, which is
/// the same for every patch around it.
///
/// # Panics
/// When `patch` isn't an index into [`Topology::patches`].
pub fn twelve(topology: &Topology, patch: u32) -> [u32; 12] {
    let mut indices = [0; 12];
    indices[..9].copy_from_slice(&nine(topology, patch));
    for (k, corner) in topology.patches[patch as usize].corners.into_iter().enumerate() {
        let point = topology.corner_points[corner as usize];
        indices[9 + k] = topology.point_corners[point as usize];
    }
    indices
}

/// [`nine`] for every patch: 9 indices each, in the order of the patches.
pub fn nine_all(topology: &Topology) -> Vec<u32> {
    (0..topology.patches.len() as u32).flat_map(|patch| nine(topology, patch)).collect()
}

/// [`twelve`] for every patch: 12 indices each, in the order of the patches.
pub fn twelve_all(topology: &Topology) -> Vec<u32> {
    (0..topology.patches.len() as u32).flat_map(|patch| twelve(topology, patch)).collect()
}

/// The corners that the one other patch has along side k, in this patch's own direction.
fn neighbour(topology: &Topology, patch: u32, k: usize) -> Option<[u32; 2]> {
    let own = topology.patches[patch as usize].sides[k];
    let side = topology.sides[own as usize];
    let range = topology.edges[side.edge as usize].sides.clone();
    if range.len() != 2 {
        return None;
    }
    let other = if own == range.start { range.start + 1 } else { range.start };
    let [a, b] = topology.sides[other as usize].corners;
    Some(if side.reversed { [b, a] } else { [a, b] })
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::mesh::shapes::Shape;
    use crate::mesh::{Corner, Mesh, Progress};

    fn topology(mesh: &Mesh) -> Topology {
        Topology::build(mesh, &Progress::new()).unwrap()
    }

    /// A square of two triangles, each with corners of its own.
    fn square() -> Mesh {
        let at = |x: f32, y: f32, n: Vec3| Corner { position: Vec3::new(x, y, 0.0), normal: n, uv: Vec2::ZERO };
        let one = [at(0.0, 0.0, Vec3::Z), at(1.0, 0.0, Vec3::Z), at(1.0, 1.0, Vec3::Z)];
        let two = [at(0.0, 0.0, Vec3::X), at(1.0, 1.0, Vec3::X), at(0.0, 1.0, Vec3::X)];
        Mesh { corners: [one, two].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]], ..Mesh::default() }
    }

    #[test]
    fn neighbours_lie_opposite_and_boundaries_repeat() {
        let topology = topology(&square());
        assert_eq!(nine(&topology, 0), [0, 1, 2, 0, 1, 1, 2, 4, 3]);
        assert_eq!(nine(&topology, 1), [3, 4, 5, 0, 2, 4, 5, 5, 3]);
        assert_eq!(twelve(&topology, 1)[9..], [0, 2, 5]);
    }

    #[test]
    fn three_sides_have_no_single_neighbour() {
        let mut mesh = square();
        mesh.corners.push(Corner { position: Vec3::Z, normal: Vec3::Z, uv: Vec2::ZERO });
        mesh.triangles.push([0, 2, 6]);
        assert_eq!(nine(&topology(&mesh), 0)[7..], [2, 0]);
    }

    #[test]
    fn neighbours_wound_the_same_way_are_neighbours() {
        let mut mesh = square();
        mesh.triangles[1] = [4, 3, 5];
        assert_eq!(nine(&topology(&mesh), 0)[7..], [4, 3]);
    }

    #[test]
    fn every_pair_lies_on_the_corners_points() {
        for shape in Shape::ALL {
            let topology = topology(&shape.build());
            let point = |corner: u32| topology.corner_points[corner as usize];
            for indices in nine_all(&topology).chunks(9) {
                for k in 0..3 {
                    assert_eq!(point(indices[3 + 2 * k]), point(indices[k]));
                    assert_eq!(point(indices[4 + 2 * k]), point(indices[(k + 1) % 3]));
                }
            }
        }
    }

    /// meshoptimizer as a peer. (It knows only neighbours that run the edge the other way, so the Möbius strip's join
    /// is not for it.)
    #[test]
    fn meshoptimizer_writes_the_same_twelve() {
        for shape in Shape::ALL.into_iter().filter(|shape| *shape != Shape::Moebius) {
            let mesh = shape.build();
            let positions: Vec<f32> = mesh.corners.iter().flat_map(|c| c.position.to_array()).collect();
            let bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_ne_bytes()).collect();
            let vertices = meshopt::VertexDataAdapter::new(&bytes, 12, 0).unwrap();
            let theirs = meshopt::generate_tessellation_indices(mesh.triangles.as_flattened(), &vertices);
            assert_eq!(twelve_all(&topology(&mesh)), theirs, "{}", shape.name());
        }
    }
}
