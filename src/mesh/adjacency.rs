//! Index buffers of PN-AEN patches. All indices are corners of the mesh.

use super::Topology;

/// The PN-AEN patch (McDonald and Kilgard 2010): corners 0, 1, 2; then the neighbour's corners across edges 0-1, 1-2 and
/// 2-0, in the patch's own direction. Where there is not exactly one neighbour, the patch's own corners.
pub fn nine(topology: &Topology, patch: u32) -> [u32; 9] {
    let corners = topology.patches[patch as usize].corners;
    let [[a, b], [c, d], [e, f]] = [0, 1, 2].map(|k| across(topology, patch, k));
    let [i, j, k] = corners;
    [i, j, k, a, b, c, d, e, f]
}

/// The nine, and the dominant corners of the patch's points: of all corners on a point, the one with the lowest index
/// (as meshoptimizer's `meshopt_generateTessellationIndexBuffer` writes them). `dominant` is from [`dominant_corners`].
pub fn twelve(topology: &Topology, dominant: &[u32], patch: u32) -> [u32; 12] {
    let [i, j, k, a, b, c, d, e, f] = nine(topology, patch);
    let [x, y, z] = [i, j, k].map(|corner| dominant[topology.corner_points[corner as usize] as usize]);
    [i, j, k, a, b, c, d, e, f, x, y, z]
}

/// The dominant corner of each point.
pub fn dominant_corners(topology: &Topology) -> Vec<u32> {
    let mut dominant = vec![u32::MAX; topology.points.len()];
    for (corner, &point) in topology.corner_points.iter().enumerate() {
        let first = &mut dominant[point as usize];
        *first = (*first).min(corner as u32);
    }
    dominant
}

/// Corners on the other side of side `k`, at its start and its end.
fn across(topology: &Topology, patch: u32, k: usize) -> [u32; 2] {
    let own_index = topology.patches[patch as usize].sides[k];
    let own = topology.sides[own_index as usize];
    let range = topology.edges[own.edge as usize].sides.clone();
    let other = match range.len() {
        2 => topology.sides[(range.start + range.end - 1 - own_index) as usize],
        _ => own,
    };
    let [a, b] = other.corners;
    if own.reversed { [b, a] } else { [a, b] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Mesh, Progress, Shape};

    fn built(shape: Shape) -> (Mesh, Topology) {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        (mesh, topology)
    }

    #[test]
    fn neighbours_lie_on_the_same_points() {
        for shape in Shape::ALL {
            let (_, topology) = built(shape);
            for patch in 0..topology.patches.len() as u32 {
                let indices = nine(&topology, patch).map(|corner| topology.corner_points[corner as usize]);
                let [i, j, k, rest @ ..] = indices;
                assert_eq!(rest, [i, j, j, k, k, i], "{shape:?}");
            }
        }
    }

    #[test]
    fn a_neighbour_is_not_the_patch_itself_unless_there_is_none() {
        let (_, topology) = built(Shape::CubeSplit);
        for patch in 0..topology.patches.len() as u32 {
            let [i, j, k, a, b, c, d, e, f] = nine(&topology, patch);
            let own = [[i, j], [j, k], [k, i]];
            let same = own.into_iter().zip([[a, b], [c, d], [e, f]]).filter(|(own, across)| own == across);
            assert_eq!(same.count(), 1, "only across the face's diagonal are the corners shared");
        }
        let (_, topology) = built(Shape::Saddle);
        let open = topology.edges.iter().find(|edge| edge.sides.len() == 1).expect("a saddle has a border");
        let side = topology.sides[open.sides.start as usize];
        let own = topology.patches[side.patch as usize].corners;
        let k = usize::from(side.index);
        assert_eq!(across(&topology, side.patch, k), [own[k], own[(k + 1) % 3]]);
    }

    #[test]
    fn meshoptimizer_writes_the_same_twelve() {
        for shape in Shape::ALL.into_iter().filter(|shape| *shape != Shape::Moebius) {
            let (mesh, topology) = built(shape);
            let indices: Vec<u32> = topology.patches.iter().flat_map(|patch| patch.corners).collect();
            let positions: Vec<f32> = mesh.corners.iter().flat_map(|corner| corner.position.to_array()).collect();
            let bytes = bytemuck::cast_slice(&positions);
            let adapter = meshopt::VertexDataAdapter::new(bytes, 12, 0).expect("three floats a vertex");
            let theirs = meshopt::generate_tessellation_indices(&indices, &adapter);
            let dominant = dominant_corners(&topology);
            let patches = 0..topology.patches.len() as u32;
            let ours: Vec<u32> = patches.flat_map(|patch| twelve(&topology, &dominant, patch)).collect();
            assert_eq!(ours, theirs, "{shape:?}");
        }
    }
}
