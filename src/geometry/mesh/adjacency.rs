//! Index buffers for PN-AEN: the corners of each patch and of its neighbours.
//!
//! The nine-index patch is that of McDonald and Kilgard 2010, "Crack-Free Point-Normal Triangles using Adjacent Edge
//! Normals". Its first three indices are the mesh's own index buffer; the other six can be kept in a buffer of their own,
//! beside that one. The twelve-index patch adds the dominant corners of McDonald 2011, "Tessellation on Any Budget", in
//! the order in which meshoptimizer writes them. The eighteen-index patch adds the corners of its edges' dominant sides.

use crate::choice::choices;
use std::ops::Range;

use super::topology::{Patch, Side, Topology};
use crate::casts::to_u32;

choices! {
    /// How many indices a patch has, and which.
    pub enum Layout {
        Six => "6", "6",
            "What PN-AEN adds to the mesh's own index buffer: the neighbours' corners along the sides 0-1, 1-2, 2-0.";
        Nine => "9", "9", "The triangle's corners 0, 1, 2, then the six.";
        Twelve => "12", "12", "The nine, then the dominant corners on the points of corners 0, 1, 2.";
        Eighteen => "18", "18",
            "The twelve, then the corners of the dominant sides of the edges 0-1, 1-2, 2-0: what exported shaders need \
             to displace.";
    }
}

/// A part of a patch's indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The triangle's corners.
    Corners,
    /// The neighbour's corners along side k, which runs from corner k to corner (k + 1) % 3.
    Side(u32),
    /// The dominant corners.
    Dominant,
    /// The corners of the dominant side of side k's edge.
    DominantSide(u32),
}

impl Layout {
    /// The number of indices of each patch.
    pub fn per_patch(self) -> usize {
        self.of_eighteen().len()
    }

    /// Returns which of a patch's eighteen indices belong to this layout.
    fn of_eighteen(self) -> Range<usize> {
        match self {
            Self::Six => 3..9,
            Self::Nine => 0..9,
            Self::Twelve => 0..12,
            Self::Eighteen => 0..18,
        }
    }

    /// Returns the indices of all patches, in the order of the patches.
    pub fn indices(self, topology: &Topology) -> Vec<u32> {
        let (per_patch, of_eighteen) = (self.per_patch(), self.of_eighteen());
        let mut indices = Vec::with_capacity(per_patch * topology.patches.len());
        for patch in &topology.patches {
            indices.extend_from_slice(&alone(topology, patch)[of_eighteen.clone()]);
        }
        // Goes through the edges, not the patches: an edge's sides are neighbours in memory. Looking up each patch's
        // neighbours is several times slower if the triangles are in random order.
        let place = |side: &Side| per_patch * side.patch() as usize + pair(side.index()).start - of_eighteen.start;
        // Two sides with the same corners have each other's indices already.
        for edge in topology.edges.iter().filter(|edge| !edge.shares_corners) {
            if let [a, b] = topology.edge_sides(edge) {
                // Until now, each side has its own corners there.
                let (first, second) = (place(a), place(b));
                let opposed = usize::from(a.reversed() != b.reversed());
                indices.swap(first, second + opposed);
                indices.swap(first + 1, second + 1 - opposed);
            }
        }
        indices
    }

    /// Returns the parts of a patch's indices, and where each lies among them.
    pub fn parts(self) -> impl Iterator<Item = (Part, Range<usize>)> {
        let first = pair(0).start - self.of_eighteen().start;
        let corners = (self != Self::Six).then_some((Part::Corners, 0..3));
        let sides = (0..3).map(move |k| (Part::Side(to_u32(k)), first + 2 * k..first + 2 * k + 2));
        let has_dominant = matches!(self, Self::Twelve | Self::Eighteen);
        let dominant = has_dominant.then_some((Part::Dominant, 9..12));
        let dominant_sides = if self == Self::Eighteen { 0..3 } else { 0..0 };
        let dominant_sides = dominant_sides.map(|k: usize| (Part::DominantSide(to_u32(k)), 12 + 2 * k..14 + 2 * k));
        corners.into_iter().chain(sides).chain(dominant).chain(dominant_sides)
    }
}

/// Returns the three corners of a patch, followed by its neighbours' corners along the sides 0-1, 1-2 and 2-0. Each
/// pair is in the patch's own direction: the first corner of the first pair lies on the point of corner 0, the second
/// on the point of corner 1, and so on. On an edge with one side, or with three or more, the pair holds the patch's own
/// corners.
///
/// These nine indices are followed by the dominant corners on the points of corners 0, 1 and 2, and by the
/// corners of the dominant sides of the edges 0-1, 1-2 and 2-0, in the patch's own direction. A point's dominant corner is
/// the lowest one on it, and an edge's dominant side the first one, so that all patches around them agree.
///
/// # Panics
/// If `patch` isn't an index into [`Topology::patches`].
pub fn eighteen(topology: &Topology, patch: u32) -> [u32; 18] {
    let patch = &topology.patches[patch as usize];
    let mut indices = alone(topology, patch);
    for (k, own) in patch.sides.map(|own| &topology.sides[own as usize]).into_iter().enumerate() {
        if let [a, b] = topology.edge_sides(&topology.edges[own.edge as usize]) {
            indices[pair(k)].copy_from_slice(&across(topology, own, if a == own { b } else { a }));
        }
    }
    indices
}

/// Returns the eighteen indices of a patch, with its own corners in place of its neighbours'.
fn alone(topology: &Topology, patch: &Patch) -> [u32; 18] {
    let corners = topology.corners(patch);
    let [a, b, c] = corners;
    let [d, e, f] = corners.map(|corner| {
        let point = topology.corner_points[corner as usize];
        topology.point_corners[point as usize]
    });
    let [[g, h], [i, j], [k, l]] = patch.sides.map(|own| {
        let side = &topology.sides[own as usize];
        let first = topology.edges[side.edge as usize].first_side;
        across(topology, side, &topology.sides[first as usize])
    });
    [a, b, c, a, b, b, c, c, a, d, e, f, g, h, i, j, k, l]
}

/// Returns the place among the indices of the neighbour's corners along side k.
fn pair(k: usize) -> Range<usize> {
    3 + 2 * k..5 + 2 * k
}

/// Returns the corners of `other` in the direction of `own`.
fn across(topology: &Topology, own: &Side, other: &Side) -> [u32; 2] {
    let [a, b] = topology.side_corners(other);
    if own.reversed() { [b, a] } else { [a, b] }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Vec2, Vec3};

    use super::*;
    use crate::mesh::shapes::Shape;
    use crate::mesh::{Corner, Mesh};
    use crate::progress::Progress;

    fn topology(mesh: &Mesh) -> Topology {
        let topology = Topology::build(mesh, &Progress::new()).unwrap();
        let one_by_one = (0..topology.patches.len() as u32).flat_map(|patch| eighteen(&topology, patch));
        assert!(
            Layout::Eighteen.indices(&topology).into_iter().eq(one_by_one),
            "all patches at once are each by itself"
        );
        topology
    }

    /// A square of two triangles that share no corners.
    fn square() -> Mesh {
        let at = |x: f32, y: f32, n: Vec3| Corner { position: Vec3::new(x, y, 0.0), normal: n, uv: Vec2::ZERO };
        let one = [at(0.0, 0.0, Vec3::Z), at(1.0, 0.0, Vec3::Z), at(1.0, 1.0, Vec3::Z)];
        let two = [at(0.0, 0.0, Vec3::X), at(1.0, 1.0, Vec3::X), at(0.0, 1.0, Vec3::X)];
        Mesh { corners: [one, two].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]].into(), ..Mesh::default() }
    }

    #[test]
    fn neighbours_lie_opposite_and_boundaries_repeat() {
        let topology = topology(&square());
        assert_eq!(eighteen(&topology, 0)[..9], [0, 1, 2, 0, 1, 1, 2, 4, 3]);
        assert_eq!(eighteen(&topology, 1)[..9], [3, 4, 5, 0, 2, 4, 5, 5, 3]);
        assert_eq!(Layout::Six.indices(&topology)[6..], [0, 2, 4, 5, 5, 3], "without the corners");
        assert_eq!(eighteen(&topology, 1)[9..12], [0, 2, 5]);
        assert_eq!(eighteen(&topology, 1)[12..], [0, 2, 4, 5, 5, 3], "the first patch speaks for the edge");
        assert_eq!(eighteen(&topology, 0)[12..], [0, 1, 1, 2, 2, 0]);
    }

    #[test]
    fn three_sides_have_no_single_neighbour() {
        let mut mesh = square();
        mesh.corners.push(Corner { position: Vec3::Z, normal: Vec3::Z, uv: Vec2::ZERO });
        Arc::make_mut(&mut mesh.triangles).push([0, 2, 6]);
        assert_eq!(eighteen(&topology(&mesh), 0)[7..9], [2, 0]);
    }

    #[test]
    fn neighbours_wound_the_same_way_are_neighbours() {
        let mut mesh = square();
        Arc::make_mut(&mut mesh.triangles)[1] = [4, 3, 5];
        assert_eq!(eighteen(&topology(&mesh), 0)[7..9], [4, 3]);
    }

    #[test]
    fn every_pair_lies_on_the_corners_points() {
        for shape in Shape::ALL {
            let topology = topology(&shape.build());
            let point = |corner: u32| topology.corner_points[corner as usize];
            for indices in Layout::Nine.indices(&topology).chunks(9) {
                for k in 0..3 {
                    assert_eq!(point(indices[3 + 2 * k]), point(indices[k]));
                    assert_eq!(point(indices[4 + 2 * k]), point(indices[(k + 1) % 3]));
                }
            }
        }
    }

    #[test]
    fn the_patches_of_an_edge_agree_on_its_dominant_side() {
        for shape in Shape::ALL {
            let topology = topology(&shape.build());
            let indices = Layout::Eighteen.indices(&topology);
            let mut of_edges = vec![None; topology.edges.len()];
            for (patch, own) in topology.patches.iter().zip(indices.chunks(18)) {
                for (k, &side) in patch.sides.iter().enumerate() {
                    let side = &topology.sides[side as usize];
                    let mut pair = [own[12 + 2 * k], own[13 + 2 * k]];
                    let points = pair.map(|corner| topology.corner_points[corner as usize]);
                    assert_eq!(points, [k, (k + 1) % 3].map(|k| topology.corner_points[own[k] as usize]));
                    if side.reversed() {
                        pair.reverse();
                    }
                    assert_eq!(*of_edges[side.edge as usize].get_or_insert(pair), pair, "{}", shape.name());
                }
            }
        }
    }

    #[test]
    fn parts_are_all_there_is_and_layouts_contain_each_other() {
        let topology = topology(&Shape::Cylinder.build());
        let of = |layout: Layout| layout.indices(&topology).chunks(layout.per_patch()).map(<[u32]>::to_vec).collect();
        let [six, nine, twelve, eighteen]: [Vec<Vec<u32>>; 4] = Layout::ALL.map(of);
        for (patch, six) in six.iter().enumerate() {
            assert_eq!([&topology.patch_corners(patch as u32)[..], six].concat(), nine[patch]);
            assert_eq!(nine[patch], twelve[patch][..9]);
            assert_eq!(twelve[patch], eighteen[patch][..12]);
        }
        for layout in Layout::ALL {
            let places: Vec<_> = layout.parts().flat_map(|(_, range)| range).collect();
            assert_eq!(places, (0..layout.per_patch()).collect::<Vec<_>>(), "{layout:?}");
        }
    }

    /// Compares with meshoptimizer. It only recognises neighbours that use the edge in the opposite direction, so the
    /// edge where the Möbius strip's ends meet is left out.
    #[test]
    fn meshoptimizer_writes_the_same_twelve() {
        for shape in Shape::ALL.into_iter().filter(|shape| *shape != Shape::Moebius) {
            let mesh = shape.build();
            let positions: Vec<f32> = mesh.corners.iter().flat_map(|c| c.position.to_array()).collect();
            let bytes: Vec<u8> = positions.iter().flat_map(|x| x.to_ne_bytes()).collect();
            let vertices = meshopt::VertexDataAdapter::new(&bytes, 12, 0).unwrap();
            let theirs = meshopt::generate_tessellation_indices(mesh.triangles.as_flattened(), &vertices);
            assert_eq!(Layout::Twelve.indices(&topology(&mesh)), theirs, "{}", shape.name());
        }
    }
}
