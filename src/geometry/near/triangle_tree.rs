//! A tree of boxes over triangles, and the point of them that is nearest to a place.

use std::collections::HashSet;
use std::time::Duration;

use foldhash::fast::RandomState;
use glam::{DVec3, Vec3, Vec3A, Vec3Swizzles};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

/// Triangles in a bounding volume hierarchy. The crate builds the hierarchy; distances are computed here, in f64.
pub struct TriangleTree {
    tree: Bvh2,
    /// The triangles in the order of the hierarchy, scaled. Of equal ones it has the first.
    corners: Vec<[Vec3; 3]>,
    /// The index of each.
    numbers: Vec<u32>,
    /// A power of two that brings coordinates near 1, so that the areas of boxes are within the range of f32. It causes
    /// no rounding.
    pub(super) scale: f64,
}

/// The nearest point of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The index of the triangle.
    pub triangle: u32,
    /// Where the triangle stands in the hierarchy, as a hint for the next search.
    pub place: u32,
    /// The weights of the triangle's corners.
    pub weights: [f64; 3],
    /// The point, and its distance from the place, in object units.
    pub point: DVec3,
    pub distance: f64,
}

/// The part of the largest coordinate that all rounding errors of a search together stay below. One operation in f64 errs by
/// 2^-53 of it, and a corner of a piece of a triangle has been rounded for each of the at most 120 cuts before it.
pub(super) const ROUNDING: f64 = 1.0 / (1_u64 << 44) as f64;

/// The place of a triangle in the hierarchy, and the distance to it, in scaled units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub place: u32,
    pub distance: f64,
}

struct Bounded([Vec3; 3]);

impl Boundable for Bounded {
    fn aabb(&self) -> Aabb {
        let [a, b, c] = self.0;
        Aabb { min: Vec3A::from(a.min(b).min(c)), max: Vec3A::from(a.max(b).max(c)) }
    }
}

impl TriangleTree {
    /// Builds the hierarchy from the corners of triangles, which must be finite. Returns `None` if there are no
    /// triangles.
    pub fn new(triangles: impl Iterator<Item = [Vec3; 3]> + Clone) -> Option<Self> {
        triangles.clone().next()?;
        let largest = triangles.clone().flatten().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let scale = if largest > 0.0 { f64::from(largest).log2().floor().exp2().recip() } else { 1.0 };
        let scaled = |corner: Vec3| (corner.as_dvec3() * scale).as_vec3();
        // A crowd of equal boxes would become a chain, which takes quadratic time.
        let mut known: HashSet<_, RandomState> = HashSet::default();
        let bits = |triangle: [Vec3; 3]| triangle.map(|corner| (corner + 0.0).to_array().map(f32::to_bits));
        let unique = (0..).zip(triangles).filter(|(_, triangle)| known.insert(bits(*triangle)));
        let (numbers, bounded): (Vec<u32>, Vec<Bounded>) =
            unique.map(|(number, triangle)| (number, Bounded(triangle.map(scaled)))).unzip();
        let tree = build_bvh2(&bounded, BvhBuildParams::very_fast_build(), &mut Duration::default());
        let in_order = || tree.primitive_indices.iter().map(|triangle| *triangle as usize);
        let corners = in_order().map(|triangle| bounded[triangle].0).collect();
        let numbers = in_order().map(|triangle| numbers[triangle]).collect();
        Some(Self { tree, corners, numbers, scale })
    }

    /// Returns the least and the greatest coordinates.
    pub fn extent(&self) -> [DVec3; 2] {
        let root = self.tree.nodes[0].aabb();
        [root.min, root.max].map(|corner| Vec3::from(corner).as_dvec3() / self.scale)
    }

    /// Returns the nearest point, if one is nearer than `within`.
    pub fn closest(&self, p: DVec3, within: f64) -> Option<Closest> {
        let mut best = None;
        self.search(p, within, 0.0, |closest| best = Some(closest));
        best
    }

    /// Returns the nearest point. `hint` is the [`Closest::place`] that was found for a place nearby, and becomes that of this
    /// one.
    pub fn closest_near(&self, p: DVec3, hint: &mut u32) -> Closest {
        *hint = self.nearest(p * self.scale, *hint, 0.0).place;
        self.closest_of(*hint, p * self.scale)
    }

    /// A distance that no triangle is nearer to p than for certain. `closest` is the nearest point that was found.
    pub fn proven(&self, p: DVec3, closest: &Closest) -> f64 {
        let margin = ROUNDING * self.largest_coordinate().max((p * self.scale).abs().max_element());
        (self.proven_distance(p * self.scale, closest.distance * self.scale) - margin).max(0.0) / self.scale
    }

    /// Whether a triangle for which `is_one` is true has a point that is at most `reach` away.
    pub fn any_within(&self, p: DVec3, reach: f64, is_one: impl Fn(u32) -> bool) -> bool {
        let (p, reach) = (p * self.scale, reach * self.scale);
        let mut is_any = false;
        // What is exactly so far away counts, too.
        self.visit(p, reach * (1.0 + 1e-9) + f64::MIN_POSITIVE, |place| {
            is_any |= self.distance_to(place, p) <= reach && is_one(self.numbers[place as usize]);
            is_any.then_some(0.0)
        });
        is_any
    }

    /// Calls `visit` with each triangle whose box overlaps that of these corners, and with some others.
    pub(super) fn overlapping(&self, corners: [Vec3; 3], visit: impl FnMut(u32)) {
        let own = Bounded(corners.map(|corner| (corner.as_dvec3() * self.scale).as_vec3())).aabb();
        self.in_boxes(|Aabb { min, max }| own.min.cmple(*max).all() && own.max.cmpge(*min).all(), visit);
    }

    /// Calls `visit` with each triangle whose box is within `reach` of the segment from a to b, and with some others nearby.
    pub(crate) fn near_segment(&self, ends: [DVec3; 2], reach: f64, visit: impl FnMut(u32)) {
        let ends = ends.map(|end| end * self.scale);
        // Twice the reach, so that rounding doesn't lose what lies exactly at it.
        let margin = 2.0 * reach * self.scale;
        let crosses = |bounds: &Aabb| {
            let [min, max] = [bounds.min, bounds.max].map(|corner| Vec3::from(corner).as_dvec3());
            crosses(ends, min - margin, max + margin)
        };
        self.in_boxes(crosses, visit);
    }

    /// Calls `visit` with each triangle of the boxes that `is_met` is true for.
    fn in_boxes(&self, is_met: impl Fn(&Aabb) -> bool, mut visit: impl FnMut(u32)) {
        let mut open = vec![0];
        while let Some(index) = open.pop() {
            let node = &self.tree.nodes[index as usize];
            if !is_met(node.aabb()) {
                continue;
            }
            match node.is_leaf() {
                true => (node.first_index..node.first_index + node.prim_count)
                    .for_each(|place| visit(self.numbers[place as usize])),
                false => open.extend([node.first_index, node.first_index + 1]),
            }
        }
    }

    /// Returns the nearest points of all triangles that are at most `slack` farther away than the nearest triangle.
    pub fn all_closest(&self, p: DVec3, slack: f64) -> Vec<Closest> {
        let mut all: Vec<Closest> = Vec::new();
        self.search(p, f64::INFINITY, slack, |closest| all.push(closest));
        let nearest = all.iter().map(|closest| closest.distance).fold(f64::INFINITY, f64::min);
        all.retain(|closest| closest.distance <= nearest + slack);
        all
    }

    /// Calls `take` with each nearest point of a triangle that is nearer than `within` and at most `slack` farther than
    /// the nearest one so far.
    fn search(&self, p: DVec3, within: f64, slack: f64, mut take: impl FnMut(Closest)) {
        let (p, slack) = (p * self.scale, slack * self.scale);
        let mut nearest = within * self.scale;
        self.visit(p, nearest + slack, |place| {
            let closest = self.closest_of(place, p);
            let distance = closest.distance * self.scale;
            if distance >= nearest + slack {
                return None;
            }
            nearest = nearest.min(distance);
            take(closest);
            Some(nearest + slack)
        });
    }

    /// Calls `take` with the place of each triangle whose box is nearer to p than `within`, and of some others. `take` may
    /// return a smaller `within`. All is scaled.
    fn visit(&self, p: DVec3, within: f64, mut take: impl FnMut(u32) -> Option<f64>) {
        let mut limit = within * within;
        let to_box = |min: DVec3, max: DVec3| p.distance_squared(p.clamp(min, max));
        let to_node = |node: u32| {
            let Aabb { min, max } = self.tree.nodes[node as usize].aabb();
            let [min, max] = [*min, *max].map(|corner| Vec3::from(corner).as_dvec3());
            to_box(min, max)
        };
        let mut open = Vec::with_capacity(64);
        open.push((to_node(0), 0));
        while let Some((distance, index)) = open.pop() {
            if distance >= limit {
                continue;
            }
            let node = &self.tree.nodes[index as usize];
            if !node.is_leaf() {
                let [a, b] = [node.first_index, node.first_index + 1].map(|child| (to_node(child), child));
                open.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                continue;
            }
            for place in node.first_index..node.first_index + node.prim_count {
                // Most triangles of a leaf are farther than the limit, which their boxes tell faster.
                let [a, b, c] = self.corners[place as usize];
                if to_box(a.min(b).min(c).as_dvec3(), a.max(b).max(c).as_dvec3()) < limit {
                    limit = take(place).map_or(limit, |within| within * within);
                }
            }
        }
    }

    /// The largest coordinate, scaled.
    pub(super) fn largest_coordinate(&self) -> f64 {
        let root = self.tree.nodes[0].aabb();
        [root.min, root.max].iter().map(|corner| f64::from(corner.abs().max_element())).fold(0.0, f64::max)
    }

    /// The point of the triangle at a place of the hierarchy that is nearest to p. All is scaled.
    pub(super) fn closest_at(&self, place: u32, p: DVec3) -> DVec3 {
        closest_on_triangle(self.corners[place as usize].map(Vec3::as_dvec3), p).1
    }

    /// The planes through the sides of the triangle at a place of the hierarchy that are perpendicular to it: a point, and
    /// the unit normal outwards, scaled. A triangle without an area has none.
    pub(super) fn borders(&self, place: u32) -> impl Iterator<Item = [DVec3; 2]> {
        let corners = self.corners[place as usize].map(Vec3::as_dvec3);
        let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        [0, 1, 2].into_iter().filter_map(move |i| {
            let side = corners[(i + 1) % 3] - corners[i];
            Some([corners[i], side.cross(face).try_normalize()?])
        })
    }

    /// The plane of the triangle at a place of the hierarchy: a point, and a unit normal, or 0 if the triangle has no area.
    pub(super) fn plane(&self, place: u32) -> [DVec3; 2] {
        let [a, b, c] = self.corners[place as usize].map(Vec3::as_dvec3);
        [a, (b - a).cross(c - a).normalize_or_zero()]
    }

    /// The distance to it.
    pub(super) fn distance_to(&self, place: u32, p: DVec3) -> f64 {
        p.distance(self.closest_at(place, p))
    }

    /// The triangle that is nearest to p, or one that is at most `enough` away. `hint` is the place of a triangle that may be
    /// near. All is scaled.
    pub(super) fn nearest(&self, p: DVec3, hint: u32, enough: f64) -> Near {
        let mut near = Near { place: hint, distance: self.distance_to(hint, p) };
        if near.distance > enough {
            self.visit(p, near.distance, |place| {
                let distance = self.distance_to(place, p);
                if distance < near.distance {
                    near = Near { place, distance };
                }
                Some(if near.distance > enough { near.distance } else { 0.0 })
            });
        }
        near
    }

    /// A distance that no triangle is nearer to p than, whatever was rounded, but for the last bits of coordinates. `near` is
    /// the distance of the nearest one, as it was found. All is scaled.
    ///
    /// A triangle lies on one side of the plane that is perpendicular to the way to its nearest point. If that point isn't
    /// quite the nearest one, the plane through the corner that is nearest along that way still has all of it on one side.
    pub(super) fn proven_distance(&self, p: DVec3, near: f64) -> f64 {
        let mut proven = near;
        self.visit(p, near, |place| {
            let point = self.closest_at(place, p);
            let corners = self.corners[place as usize].map(Vec3::as_dvec3);
            let along =
                |way: DVec3| corners.map(|corner| (p - corner).dot(way)).into_iter().fold(f64::INFINITY, f64::min);
            let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let ways = [p - point, face, -face].map(DVec3::normalize_or_zero);
            proven = ways.map(along).into_iter().fold(0.0, f64::max).min(proven);
            None
        });
        proven
    }

    /// Returns the nearest point of the triangle at a place of the hierarchy, without the scale. `p` is scaled.
    fn closest_of(&self, place: u32, p: DVec3) -> Closest {
        let (weights, point) = closest_on_triangle(self.corners[place as usize].map(Vec3::as_dvec3), p);
        let triangle = self.numbers[place as usize];
        let distance = p.distance(point) / self.scale;
        Closest { triangle, place, weights, point: point / self.scale, distance }
    }
}

/// Returns the point of a triangle that is nearest to p, and its weights before it. Triangles may be degenerate.
pub fn closest_on_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> ([f64; 3], DVec3) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let squared = normal.length_squared();
    if squared > 0.0 {
        let at_b = ap.cross(ac).dot(normal) / squared;
        let at_c = ab.cross(ap).dot(normal) / squared;
        if at_b >= 0.0 && at_c >= 0.0 && at_b + at_c <= 1.0 {
            return ([1.0 - at_b - at_c, at_b, at_c], a + ab * at_b + ac * at_c);
        }
    }
    let along = |from: DVec3, to: DVec3| {
        let squared = from.distance_squared(to);
        let t = if squared > 0.0 { ((p - from).dot(to - from) / squared).clamp(0.0, 1.0) } else { 0.0 };
        (t, from.lerp(to, t))
    };
    let ((t, on_ab), (u, on_bc), (v, on_ca)) = (along(a, b), along(b, c), along(c, a));
    let sides = [([1.0 - t, t, 0.0], on_ab), ([0.0, 1.0 - u, u], on_bc), ([v, 0.0, 1.0 - v], on_ca)];
    let nearer = |x: ([f64; 3], DVec3), y: ([f64; 3], DVec3)| {
        if p.distance_squared(y.1) < p.distance_squared(x.1) { y } else { x }
    };
    nearer(nearer(sides[0], sides[1]), sides[2])
}

/// Returns whether a segment has a point in a box: whether no axis separates them, of the box's and those across it and the segment
/// (Ericson 2005, "Real-Time Collision Detection", section 5.3.3).
fn crosses([a, b]: [DVec3; 2], min: DVec3, max: DVec3) -> bool {
    // All lengths twice.
    let (way, size, apart) = (b - a, max - min, a + b - min - max);
    let along = way.abs();
    let beside = size.yzx() * along.zxy() + size.zxy() * along.yzx();
    apart.abs().cmple(size + along).all() && apart.cross(way).abs().cmple(beside).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The numbers of the places that the tree visits near a segment, in order.
    fn near(places: impl Iterator<Item = Vec3> + Clone, ends: [DVec3; 2], reach: f64) -> Vec<u32> {
        let mut visited = Vec::new();
        if let Some(tree) = TriangleTree::new(places.map(|place| [place; 3])) {
            tree.near_segment(ends, reach, |i| visited.push(i));
        }
        visited.sort_unstable();
        visited
    }

    #[test]
    fn empty_trees_and_trees_of_one_position() {
        let count = |place: Vec3, count| near(std::iter::repeat_n(place, count), [DVec3::ZERO, DVec3::X], 0.0).len();
        assert_eq!(count(Vec3::X, 0), 0);
        assert_eq!(count(Vec3::X / 2.0, 1000), 1, "of equal ones, the first");
        assert_eq!(count(Vec3::Y, 1000), 0);
    }

    #[test]
    fn a_segment_through_many_places_visits_few() {
        let places = (0..200).flat_map(|y| (0..200).map(move |x| Vec3::new(x as f32, y as f32, 0.0)));
        let across = [DVec3::new(-1.0, 10.4, 0.0), DVec3::new(300.0, 30.6, 0.0)];
        let count = near(places, across, 0.01).len();
        assert!(count < 1500, "{count} of 40000");
    }

    proptest! {
        #[test]
        fn all_positions_within_reach_are_visited(
            places in prop::collection::hash_set(prop::array::uniform3(-9_i8..9), 0..60),
            ends in prop::array::uniform2(prop::array::uniform3(-9_i8..9)),
            reach in 0_u8..4,
        ) {
            let [a, b] = ends.map(|end| DVec3::from(end.map(f64::from)));
            let reach = f64::from(reach);
            let places: Vec<Vec3> = places.into_iter().map(|place| Vec3::from(place.map(f32::from))).collect();
            let visited = near(places.iter().copied(), [a, b], reach);
            prop_assert!(visited.windows(2).all(|pair| pair[0] < pair[1]), "visited twice");
            for (place, i) in places.iter().map(|place| place.as_dvec3()).zip(0..) {
                let t = ((place - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
                let distance = place.distance(a.lerp(b, t));
                prop_assert!(distance > reach || visited.contains(&i), "missed at {distance}");
            }
        }
    }
}
