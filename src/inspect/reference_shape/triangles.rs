//! Triangles, and the point of them that is nearest to a place.

use std::time::Duration;

use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};

/// Triangles in a bounding volume hierarchy. The crate builds the hierarchy; distances are computed here, in f64.
pub struct Triangles {
    tree: Bvh2,
    /// The triangles in the order of the hierarchy, scaled.
    corners: Vec<[Vec3; 3]>,
    /// A power of two that brings coordinates near 1, so that the areas of boxes are within the range of f32. It causes
    /// no rounding.
    scale: f64,
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

struct Bounded([Vec3; 3]);

impl Boundable for Bounded {
    fn aabb(&self) -> Aabb {
        let [a, b, c] = self.0;
        Aabb { min: Vec3A::from(a.min(b).min(c)), max: Vec3A::from(a.max(b).max(c)) }
    }
}

impl Triangles {
    /// Builds the hierarchy from the corners of triangles, which must be finite. Returns `None` if there are no
    /// triangles.
    pub fn new(triangles: impl Iterator<Item = [Vec3; 3]> + Clone) -> Option<Self> {
        triangles.clone().next()?;
        let largest = triangles.clone().flatten().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let scale = if largest > 0.0 { f64::from(largest).log2().floor().exp2().recip() } else { 1.0 };
        let scaled = |corner: Vec3| (corner.as_dvec3() * scale).as_vec3();
        let bounded: Vec<Bounded> = triangles.map(|triangle| Bounded(triangle.map(scaled))).collect();
        let tree = build_bvh2(&bounded, BvhBuildParams::very_fast_build(), &mut Duration::default());
        let corners = tree.primitive_indices.iter().map(|triangle| bounded[*triangle as usize].0).collect();
        Some(Self { tree, corners, scale })
    }

    /// Returns the least and the greatest coordinates.
    pub fn extent(&self) -> [DVec3; 2] {
        let root = self.tree.nodes[0].aabb();
        [root.min, root.max].map(|corner| Vec3::from(corner).as_dvec3() / self.scale)
    }

    /// Returns the nearest point, if one is nearer than `within`.
    pub fn closest(&self, p: DVec3, within: f64) -> Option<Closest> {
        let mut best = None;
        self.search(p, within, 0.0, |closest| {
            best = Some(closest);
            false
        });
        best
    }

    /// Returns the nearest point; or if points are at most `enough` away, any of those, which is found faster. `hint` is
    /// the [`Closest::place`] that was found for a place nearby, and becomes that of this one.
    pub(crate) fn closest_or_within(&self, p: DVec3, enough: f64, hint: &mut u32) -> Option<Closest> {
        let mut best = self.corners.get(*hint as usize).map(|_| self.closest_of(*hint, p * self.scale));
        let within = best.map_or(f64::INFINITY, |closest| closest.distance);
        if within > enough {
            self.search(p, within, 0.0, |closest| {
                best = Some(closest);
                closest.distance <= enough
            });
        }
        *hint = best.map_or(*hint, |closest| closest.place);
        best
    }

    /// Returns the nearest points of all triangles that are at most `slack` farther away than the nearest triangle.
    pub fn all_closest(&self, p: DVec3, slack: f64) -> Vec<Closest> {
        let mut all: Vec<Closest> = Vec::new();
        self.search(p, f64::INFINITY, slack, |closest| {
            all.push(closest);
            false
        });
        let nearest = all.iter().map(|closest| closest.distance).fold(f64::INFINITY, f64::min);
        all.retain(|closest| closest.distance <= nearest + slack);
        all
    }

    /// Calls `take` with each nearest point of a triangle that is nearer than `within` and at most `slack` farther than
    /// the nearest one so far, until `take` returns that this is enough.
    fn search(&self, p: DVec3, within: f64, slack: f64, mut take: impl FnMut(Closest) -> bool) {
        let (p, slack) = (p * self.scale, slack * self.scale);
        let mut nearest = within * self.scale;
        let mut limit = (nearest + slack) * (nearest + slack);
        let to_box = |node: u32| {
            let Aabb { min, max } = self.tree.nodes[node as usize].aabb();
            let [min, max] = [*min, *max].map(|corner| Vec3::from(corner).as_dvec3());
            p.distance_squared(p.clamp(min, max))
        };
        let mut open = Vec::with_capacity(64);
        open.push((to_box(0), 0));
        while let Some((distance, index)) = open.pop() {
            if distance >= limit {
                continue;
            }
            let node = &self.tree.nodes[index as usize];
            if !node.is_leaf() {
                let [a, b] = [node.first_index, node.first_index + 1].map(|child| (to_box(child), child));
                open.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                continue;
            }
            for place in node.first_index..node.first_index + node.prim_count {
                // Most triangles of a leaf are farther than the limit, which their boxes tell faster.
                let [a, b, c] = self.corners[place as usize];
                let [min, max] = [a.min(b).min(c), a.max(b).max(c)].map(Vec3::as_dvec3);
                if p.distance_squared(p.clamp(min, max)) >= limit {
                    continue;
                }
                let (weights, point) = closest_on_triangle([a, b, c].map(Vec3::as_dvec3), p);
                let squared = p.distance_squared(point);
                if squared >= limit {
                    continue;
                }
                let distance = squared.sqrt();
                if distance < nearest {
                    nearest = distance;
                    limit = (nearest + slack) * (nearest + slack);
                }
                if take(self.found(place, weights, point, distance)) {
                    return;
                }
            }
        }
    }

    /// Returns the nearest point of the triangle at a place of the hierarchy. `p` is scaled.
    fn closest_of(&self, place: u32, p: DVec3) -> Closest {
        let (weights, point) = closest_on_triangle(self.corners[place as usize].map(Vec3::as_dvec3), p);
        self.found(place, weights, point, p.distance(point))
    }

    /// Returns a point of a triangle, without the scale.
    fn found(&self, place: u32, weights: [f64; 3], point: DVec3, distance: f64) -> Closest {
        let triangle = self.tree.primitive_indices[place as usize];
        Closest { triangle, place, weights, point: point / self.scale, distance: distance / self.scale }
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
