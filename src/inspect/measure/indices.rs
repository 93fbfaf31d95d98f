//! Compares PN-AEN indices that were given with the mesh's own: which patches differ, where, and what each difference means.

use std::ops::Range;

use geometry::choice::texts;
use geometry::mesh::adjacency::{Layout, Part};
use geometry::mesh::{Mesh, Topology};

texts! {
    /// What a difference means, the most harmless first.
    #[derive(PartialOrd, Ord)]
    pub enum Meaning, fn text {
        Turned => "the same patch, starting at another corner",
        /// All patches around a point, or on an edge, name other corners as the dominant ones.
        OtherDominant => "another dominant corner, the same for all patches around it",
        /// The surface is the same.
        SameNormals => "other corners, same points and normals",
        OtherNormals => "other corners, same points, other normals",
        /// Patches around a point, or on an edge, name different corners as the dominant ones.
        MixedDominant => "not the same dominant corner for all patches around it",
        Exchanged => "the side's two corners exchanged",
        OtherPoints => "other points",
    }
}

/// A part of a patch that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexDifference {
    pub patch: u32,
    pub part: Part,
    /// Its range among all indices.
    pub places: Range<usize>,
    pub meaning: Meaning,
}

/// Every part of every patch in which `given` differs from `computed`, the mesh's own indices in the same layout; in the
/// order of the patches. A patch that only starts at another corner is reported as a difference in its corners.
///
/// # Panics
/// There are fewer indices given than computed, or one isn't a corner of the mesh.
pub fn index_differences(
    mesh: &Mesh,
    topology: &Topology,
    layout: Layout,
    given: &[u32],
    computed: &[u32],
) -> Vec<IndexDifference> {
    let count = layout.per_patch();
    let dominants = Dominants::new(topology, layout, given);
    let mut differences = Vec::new();
    for (patch, computed) in computed.chunks(count).enumerate() {
        let first = patch * count;
        let given = &given[first..first + count];
        if given == computed {
            continue;
        }
        let at = |part, range: Range<usize>, meaning| {
            let places = first + range.start..first + range.end;
            IndexDifference { patch: patch as u32, part, places, meaning }
        };
        if is_turned(layout, given, computed) {
            differences.push(at(Part::Corners, 0..3, Meaning::Turned));
            continue;
        }
        for (part, range) in layout.parts().filter(|(_, range)| given[range.clone()] != computed[range.clone()]) {
            let (given, computed) = (&given[range.clone()], &computed[range.clone()]);
            let meaning = match (part, same_corners(mesh, topology, given, computed)) {
                (Part::Dominant, Meaning::SameNormals | Meaning::OtherNormals) => dominants.meaning(topology, given),
                (Part::DominantSide(k), Meaning::SameNormals | Meaning::OtherNormals) => {
                    dominants.side_meaning(topology, topology.patches[patch].sides[k as usize])
                }
                (_, meaning) => meaning,
            };
            differences.push(at(part, range, meaning));
        }
    }
    differences
}

/// Whether a patch is the computed one, starting at another corner. Six indices don't hold the patch's own corners, so their
/// start is fixed.
fn is_turned(layout: Layout, given: &[u32], computed: &[u32]) -> bool {
    if layout == Layout::Six {
        return false;
    }
    let turned = |by: usize| {
        let mut patch = computed.to_vec();
        patch[..3].rotate_left(by);
        patch[3..9].rotate_left(2 * by);
        if layout != Layout::Nine {
            patch[9..12].rotate_left(by);
            patch[12..].rotate_left(if layout == Layout::Eighteen { 2 * by } else { 0 });
        }
        patch
    };
    turned(1) == given || turned(2) == given
}

/// What it means that a part has the given corners in place of the computed ones.
fn same_corners(mesh: &Mesh, topology: &Topology, given: &[u32], computed: &[u32]) -> Meaning {
    let point = |&corner: &u32| topology.corner_points[corner as usize];
    let normal = |&corner: &u32| mesh.corners[corner as usize].normal;
    if given.iter().map(point).eq(computed.iter().map(point)) {
        let same = given.iter().map(normal).eq(computed.iter().map(normal));
        if same { Meaning::SameNormals } else { Meaning::OtherNormals }
    } else if given.len() == 2 && given.iter().rev().map(point).eq(computed.iter().map(point)) {
        Meaning::Exchanged
    } else {
        Meaning::OtherPoints
    }
}

/// What the given indices name as dominant.
#[derive(Default)]
struct Dominants {
    /// For each point, the lowest and the highest of its corners that are named.
    corners: Vec<[u32; 2]>,
    /// For each edge, the least and the greatest pair of corners that are named, in the direction of the edge.
    sides: Vec<[[u32; 2]; 2]>,
}

impl Dominants {
    fn new(topology: &Topology, layout: Layout, given: &[u32]) -> Self {
        let mut named = Self::default();
        let patches = || topology.patches.iter().zip(given.chunks(layout.per_patch()));
        if layout.parts().any(|(part, _)| part == Part::Dominant) {
            named.corners = vec![[u32::MAX, 0]; topology.points.len()];
            for &corner in patches().flat_map(|(_, indices)| &indices[9..12]) {
                let [lowest, highest] = &mut named.corners[topology.corner_points[corner as usize] as usize];
                *lowest = corner.min(*lowest);
                *highest = corner.max(*highest);
            }
        }
        if layout == Layout::Eighteen {
            named.sides = vec![[[u32::MAX; 2], [0; 2]]; topology.edges.len()];
            for (patch, indices) in patches() {
                for (&side, pair) in patch.sides.iter().zip(indices[12..].chunks(2)) {
                    let side = &topology.sides[side as usize];
                    let pair = if side.reversed() { [pair[1], pair[0]] } else { [pair[0], pair[1]] };
                    let [least, greatest] = &mut named.sides[side.edge as usize];
                    *least = pair.min(*least);
                    *greatest = pair.max(*greatest);
                }
            }
        }
        named
    }

    /// The meaning of a difference in the corners of a dominant side that lie on the right points.
    fn side_meaning(&self, topology: &Topology, side: u32) -> Meaning {
        let [least, greatest] = self.sides[topology.sides[side as usize].edge as usize];
        if least == greatest { Meaning::OtherDominant } else { Meaning::MixedDominant }
    }

    /// The meaning of a difference in dominant corners that lie on the right points.
    fn meaning(&self, topology: &Topology, given: &[u32]) -> Meaning {
        let is_one = |&corner: &u32| {
            let [lowest, highest] = self.corners[topology.corner_points[corner as usize] as usize];
            lowest == highest
        };
        if given.iter().all(is_one) { Meaning::OtherDominant } else { Meaning::MixedDominant }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Shape;
    use geometry::progress::Progress;

    fn cylinder() -> (Mesh, Topology) {
        let mesh = Shape::Cylinder.build();
        let topology = Topology::build(&mesh, &Progress::new()).unwrap();
        (mesh, topology)
    }

    /// The differences that are found after a change to the computed indices.
    fn found(layout: Layout, change: impl FnOnce(&Mesh, &Topology, &mut [u32])) -> Vec<(u32, Part, Meaning)> {
        let (mesh, topology) = cylinder();
        let computed = layout.indices(&topology);
        let mut given = computed.clone();
        change(&mesh, &topology, &mut given);
        let differences = index_differences(&mesh, &topology, layout, &given, &computed);
        for IndexDifference { places, .. } in &differences {
            assert_ne!(given[places.clone()], computed[places.clone()]);
        }
        differences.into_iter().map(|found| (found.patch, found.part, found.meaning)).collect()
    }

    /// Another corner on the same point, with the same normal or another one.
    fn other(mesh: &Mesh, topology: &Topology, corner: u32, same_normal: bool) -> Option<u32> {
        let point = |corner: u32| topology.corner_points[corner as usize];
        let normal = |corner: u32| mesh.corners[corner as usize].normal;
        let fits = |&c: &u32| c != corner && point(c) == point(corner) && (normal(c) == normal(corner)) == same_normal;
        (0..mesh.corners.len() as u32).find(fits)
    }

    #[test]
    fn computed_indices_do_not_differ() {
        for layout in Layout::ALL {
            assert_eq!(found(layout, |_, _, _| ()), []);
        }
    }

    #[test]
    fn a_patch_may_start_at_another_corner_unless_its_corners_are_not_given() {
        let turn = |count: usize, by: usize| {
            move |_: &Mesh, _: &Topology, given: &mut [u32]| {
                let patch = &mut given[count..2 * count];
                let corners = if count == 6 { 0 } else { 3 };
                patch[..corners].rotate_left(by % 3 * usize::from(corners > 0));
                patch[corners..corners + 6].rotate_left(2 * by);
                if count > 9 {
                    patch[9..12].rotate_left(by);
                    patch[12..].rotate_left(if count == 18 { 2 * by } else { 0 });
                }
            }
        };
        for by in [1, 2] {
            for (layout, count) in [(Layout::Nine, 9), (Layout::Twelve, 12), (Layout::Eighteen, 18)] {
                assert_eq!(found(layout, turn(count, by)), [(1, Part::Corners, Meaning::Turned)]);
            }
            let sides = [0, 1, 2].map(|side| (1, Part::Side(side), Meaning::OtherPoints));
            assert_eq!(found(Layout::Six, turn(6, by)), sides);
        }
    }

    #[test]
    fn differences_of_sides_are_told_apart() {
        let exchanged = found(Layout::Six, |_, _, given| given.swap(2, 3));
        assert_eq!(exchanged, [(0, Part::Side(1), Meaning::Exchanged)]);
        let elsewhere = found(Layout::Nine, |_, _, given| given[9 + 7] = given[9 + 1]);
        assert_eq!(elsewhere, [(1, Part::Side(2), Meaning::OtherPoints)]);
        for (same_normal, meaning) in [(true, Meaning::SameNormals), (false, Meaning::OtherNormals)] {
            let mut place = 0;
            let differences = found(Layout::Nine, |mesh, topology, given| {
                let sides = (0..given.len()).filter(|place| place % 9 >= 3);
                let (at, corner) = sides
                    .filter_map(|at| Some((at, other(mesh, topology, given[at], same_normal)?)))
                    .next()
                    .expect("a uv seam and a crease");
                (place, given[at]) = (at, corner);
            });
            let part = Part::Side((place % 9 - 3) as u32 / 2);
            assert_eq!(differences, [((place / 9) as u32, part, meaning)]);
        }
    }

    #[test]
    fn another_dominant_corner_is_harmless_only_if_all_patches_name_it() {
        let places = |given: &[u32]| (0..given.len()).filter(|place| place % 12 >= 9).collect::<Vec<_>>();
        let first = |mesh: &Mesh, topology: &Topology, given: &[u32]| {
            let choice = |&at: &usize| Some((given[at], other(mesh, topology, given[at], false)?));
            places(given).iter().find_map(choice).expect("a crease")
        };
        let all = found(Layout::Twelve, |mesh, topology, given| {
            let (old, new) = first(mesh, topology, given);
            places(given).into_iter().for_each(|at| given[at] = if given[at] == old { new } else { given[at] });
        });
        assert!(all.len() > 2, "{all:?}");
        assert!(all.iter().all(|&(_, part, meaning)| (part, meaning) == (Part::Dominant, Meaning::OtherDominant)));
        let one = found(Layout::Twelve, |mesh, topology, given| {
            let (old, new) = first(mesh, topology, given);
            let at = places(given).into_iter().find(|&at| given[at] == old).expect("it is there");
            given[at] = new;
        });
        assert_eq!(one.iter().map(|found| found.2).collect::<Vec<_>>(), [Meaning::MixedDominant]);
        let elsewhere = found(Layout::Twelve, |_, _, given| given.swap(9, 10));
        assert_eq!(elsewhere, [(0, Part::Dominant, Meaning::OtherPoints)]);
    }

    #[test]
    fn another_dominant_side_is_harmless_only_if_both_patches_name_it() {
        // The place of a side, and that of its neighbour, whose corners are others there.
        let pair = |topology: &Topology, given: &[u32]| {
            let ends = |edge: &geometry::mesh::Edge| {
                topology.edge_sides(edge).iter().map(|side| (side.patch() as usize, side.index())).collect::<Vec<_>>()
            };
            let of = |edge: &geometry::mesh::Edge| match ends(edge)[..] {
                [(a, k), (b, l)] => {
                    let places = [18 * a + 12 + 2 * k, 18 * b + 12 + 2 * l];
                    let other = [given[18 * a + 3 + 2 * k], given[18 * a + 4 + 2 * k]];
                    (other != [given[places[0]], given[places[0] + 1]]).then_some((places, other))
                }
                _ => None,
            };
            topology.edges.iter().find_map(of).expect("a crease between two patches")
        };
        let both = found(Layout::Eighteen, |_, topology, given| {
            let ([one, other], [a, b]) = pair(topology, given);
            // Neighbours run against each other.
            given[one..one + 2].copy_from_slice(&[a, b]);
            given[other..other + 2].copy_from_slice(&[b, a]);
        });
        assert_eq!(both.iter().map(|found| found.2).collect::<Vec<_>>(), [Meaning::OtherDominant; 2]);
        let one = found(Layout::Eighteen, |_, topology, given| {
            let ([one, _], own) = pair(topology, given);
            given[one..one + 2].copy_from_slice(&own);
        });
        assert_eq!(one.iter().map(|found| found.2).collect::<Vec<_>>(), [Meaning::MixedDominant]);
        let exchanged = found(Layout::Eighteen, |_, _, given| given.swap(12, 13));
        assert_eq!(exchanged, [(0, Part::DominantSide(0), Meaning::Exchanged)]);
    }
}
