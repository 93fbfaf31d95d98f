//! A tree of bounding boxes over positions: finds what lies near a segment, however long the segment is.

use glam::DVec3;

/// The greatest number of positions in a box without children.
const LEAF: usize = 8;

/// Numbered positions in a tree of boxes. A box is halved along its longest side until few positions are left.
pub(super) struct BoundingBoxTree {
    places: Vec<(DVec3, u32)>,
    /// Each node comes before its children.
    nodes: Vec<Node>,
}

/// A box around the positions `start..end`. Its children, if it has any, are the next node and the node `second`.
struct Node {
    min: DVec3,
    max: DVec3,
    start: usize,
    end: usize,
    second: Option<usize>,
}

impl BoundingBoxTree {
    /// Builds the tree. Takes about n log n steps, wherever the positions lie.
    pub(super) fn new(mut places: Vec<(DVec3, u32)>) -> Self {
        let mut nodes = Vec::new();
        if !places.is_empty() {
            divide(&mut places, 0, &mut nodes);
        }
        Self { places, nodes }
    }

    /// Calls `visit` with every position within `reach` of the segment from a to b, and with some others nearby.
    pub(super) fn near_segment(&self, [a, b]: [DVec3; 2], reach: f64, mut visit: impl FnMut(DVec3, u32)) {
        let mut open = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(i) = open.pop() {
            let node = &self.nodes[i];
            // Twice the reach, so that rounding doesn't lose positions that lie exactly at it.
            if !crosses([a, b], node.min - 2.0 * reach, node.max + 2.0 * reach) {
                continue;
            }
            match node.second {
                Some(second) => open.extend([i + 1, second]),
                None => self.places[node.start..node.end].iter().for_each(|&(place, number)| visit(place, number)),
            }
        }
    }
}

/// Sorts positions into nodes; `start` is the number of positions before these. The depth is the logarithm of their
/// number.
fn divide(places: &mut [(DVec3, u32)], start: usize, nodes: &mut Vec<Node>) {
    let min = places.iter().fold(DVec3::INFINITY, |min, (place, _)| min.min(*place));
    let max = places.iter().fold(DVec3::NEG_INFINITY, |max, (place, _)| max.max(*place));
    let node = nodes.len();
    nodes.push(Node { min, max, start, end: start + places.len(), second: None });
    if places.len() > LEAF {
        let axis = (max - min).max_position();
        let half = places.len() / 2;
        places.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (first, second) = places.split_at_mut(half);
        divide(first, start, nodes);
        nodes[node].second = Some(nodes.len());
        divide(second, start + half, nodes);
    }
}

/// Returns whether a segment has a point in a box.
fn crosses([a, b]: [DVec3; 2], min: DVec3, max: DVec3) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let (start, way) = (a[axis], b[axis] - a[axis]);
        if way == 0.0 {
            if start < min[axis] || start > max[axis] {
                return false;
            }
        } else {
            let (x, y) = ((min[axis] - start) / way, (max[axis] - start) / way);
            from = from.max(x.min(y));
            to = to.min(x.max(y));
        }
    }
    from <= to
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn empty_trees_and_trees_of_one_position() {
        let count = |places: Vec<(DVec3, u32)>| {
            let mut count = 0;
            BoundingBoxTree::new(places).near_segment([DVec3::ZERO, DVec3::X], 0.0, |_, _| count += 1);
            count
        };
        assert_eq!(count(Vec::new()), 0);
        assert_eq!(count((0..1000).map(|i| (DVec3::X / 2.0, i)).collect()), 1000);
        assert_eq!(count((0..1000).map(|i| (DVec3::Y, i)).collect()), 0);
    }

    #[test]
    fn a_segment_through_many_places_visits_few() {
        let places = (0..40_000).map(|i| (DVec3::new(f64::from(i % 200), f64::from(i / 200), 0.0), i)).collect();
        let mut count = 0;
        let across = [DVec3::new(-1.0, 10.4, 0.0), DVec3::new(300.0, 30.6, 0.0)];
        BoundingBoxTree::new(places).near_segment(across, 0.01, |_, _| count += 1);
        assert!(count < 1500, "{count} of 40000");
    }

    proptest! {
        #[test]
        fn all_positions_within_reach_are_visited(
            places in prop::collection::vec(prop::array::uniform3(-9_i8..9), 0..60),
            ends in prop::array::uniform2(prop::array::uniform3(-9_i8..9)),
            reach in 0_u8..4,
        ) {
            let [a, b] = ends.map(|end| DVec3::from(end.map(f64::from)));
            let reach = f64::from(reach);
            let places = places.iter().zip(0..).map(|(place, i)| (DVec3::from(place.map(f64::from)), i)).collect::<Vec<_>>();
            let mut visited = Vec::new();
            BoundingBoxTree::new(places.clone()).near_segment([a, b], reach, |_, i| visited.push(i));
            visited.sort_unstable();
            prop_assert!(visited.windows(2).all(|pair| pair[0] < pair[1]), "visited twice");
            for (place, i) in places {
                let t = ((place - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
                let distance = place.distance(a.lerp(b, t));
                prop_assert!(distance > reach || visited.contains(&i), "missed at {distance}");
            }
        }
    }
}
