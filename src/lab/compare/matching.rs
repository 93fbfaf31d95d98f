//! Holds another program's triangles on a patch against ours: whether they are the same points, and the same triangles.

use std::collections::HashMap;

use glam::DVec3;

use super::assignment::{Part, domain_area};
use super::domain_points::DomainPoints;
use super::locator::Place;
use super::our_mesh::{OurPatch, is_thin, sorted};
use geometry::tessellate::FIXED_ONE;

/// How a patch of theirs differs from ours.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Match {
    /// Whether both have the same domain points, but for ours that only missing triangles have.
    pub has_same_points: bool,
    /// Our vertex for each of theirs, if the domain points are the same.
    pub our_vertices: Vec<Option<u32>>,
    /// How many of their vertices lie on the surface, but were moved along it.
    pub slid: u64,
    /// How many of our triangles they don't have, while their points are the same. Those that are cut otherwise don't count.
    pub missing: u64,
    /// How many of their triangles occur once more.
    pub doubled: u64,
    /// How many of their triangles are wound the other way than the patch.
    pub flipped: u64,
    /// How many of their triangles are so thin that rounded coordinates don't tell how they are wound.
    pub thin: u64,
    /// How many of their triangles join other points than ours.
    pub other: u64,
}

/// How near a place in the domain must be to one of our points to be the same.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// As weights of corners.
    pub domain: f64,
    /// A vertex that is farther from the surface has no place of its own in the domain, in object units.
    pub fit: f64,
}

/// Fixed-point places in the domain and Newton's method are at least this exact.
pub(super) const LEAST_REACH: f64 = 2e-4;

impl Reach {
    /// The largest area in the domain of a triangle that rounding alone may turn around: that of coordinates, or of the tessellator's
    /// fixed-point places.
    fn thin(&self, [a, b, c]: [[f64; 2]; 3]) -> f64 {
        let length = |[p, q]: [[f64; 2]; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let is_rounded = self.fit.is_finite() && self.domain > LEAST_REACH;
        let longest = [[a, b], [b, c], [c, a]].map(length).into_iter().fold(0.0, f64::max);
        if is_rounded { self.domain * longest } else { 2.0 * longest / f64::from(FIXED_ONE) }
    }
}

impl Match {
    pub(super) fn new(part: &Part, own: &OurPatch, reach: Reach) -> Self {
        let mut none = Self::default();
        for weights in part.triangles.iter().map(|triangle| part.weights(*triangle)) {
            let (area, thin) = (domain_area(weights), reach.thin(weights));
            none.flipped += u64::from(area < -thin);
            none.thin += u64::from(area.abs() <= thin);
        }
        let Some((our_vertices, is_left, slid)) = our_vertices(part, own, reach) else { return none };
        let all = || 0..own.weights.len() as u32;
        // Of several points that are nearer to each other than can be told apart, one is enough.
        let covered = all().filter(|vertex| own.firsts[*vertex as usize] == *vertex && !is_left[*vertex as usize]);
        let covered = DomainPoints::new(covered.map(|vertex| own.weights[vertex as usize]));
        let is_near = |vertex: u32| covered.nearest(own.weights[vertex as usize], reach.domain).is_some();
        let has_all_points = all().all(|vertex| !is_left[vertex as usize] || is_near(vertex));
        let mut found = Self { our_vertices, slid, ..none };
        found.count_triangles(part, own, reach.domain);
        // Points are only missing with the triangles around them, or else the patch is cut more coarsely.
        found.has_same_points = has_all_points || !part.is_whole() && found.other == 0;
        found.missing = found.missing.saturating_sub(found.other);
        if found.has_same_points { found } else { none }
    }

    /// Counts triangles that are missing, doubled, or join other points.
    fn count_triangles(&mut self, part: &Part, own: &OurPatch, reach: f64) {
        // Points that are nearer to each other than can be told apart are one.
        let points = DomainPoints::new(own.weights.iter().copied());
        let first = |vertex: u32| {
            let vertex = own.firsts[vertex as usize];
            points.first(own.weights[vertex as usize], reach).unwrap_or(vertex)
        };
        let firsts: Vec<u32> = (0..own.weights.len() as u32).map(first).collect();
        let mut counts: HashMap<[u32; 3], [u64; 2]> = HashMap::new();
        for [a, b, c] in own.triangles.iter().map(|triangle| triangle.map(|vertex| firsts[vertex as usize])) {
            if !is_thin([a, b, c]) {
                counts.entry(sorted([a, b, c])).or_default()[0] += 1;
            }
        }
        for triangle in &part.triangles {
            let ours = triangle.map(|corner| self.our_vertices[corner as usize].map(|vertex| firsts[vertex as usize]));
            match ours {
                [Some(a), Some(b), Some(c)] if !is_thin([a, b, c]) => {
                    counts.entry(sorted([a, b, c])).or_default()[1] += 1;
                }
                // A triangle between two vertices that can't be told apart has no area.
                [Some(_), Some(_), Some(_)] => {}
                _ => self.other += 1,
            }
        }
        for [ours, theirs] in counts.into_values() {
            match ours {
                0 => self.other += theirs,
                _ => {
                    self.missing += u64::from(theirs == 0);
                    self.doubled += theirs.saturating_sub(ours);
                }
            }
        }
    }
}

/// Our vertex for each of theirs; for each of ours whether it is left; and how many of theirs were moved.
type OurVertices = (Vec<Option<u32>>, Vec<bool>, u64);

/// Returns our vertex for each of theirs; for each of ours whether it is left, since none of theirs is there; and how many of
/// theirs were moved along the surface. `None` if more of theirs lie where we have no point than a few vertices that were moved.
fn our_vertices(part: &Part, own: &OurPatch, reach: Reach) -> Option<OurVertices> {
    let points = DomainPoints::new(own.weights.iter().copied());
    let our_weights = |vertex: u32| own.weights[vertex as usize];
    let on_surface = |place: &Place| place.distance <= reach.fit;
    let nearest = |place: &Place| points.nearest(place.weights, reach.domain).filter(|_| on_surface(place));
    let mut found: Vec<Option<u32>> = part.places.iter().map(nearest).collect();
    let mut is_left: Vec<bool> = (0..).zip(&own.firsts).map(|(vertex, first)| *first == vertex).collect();
    found.iter().flatten().for_each(|vertex| is_left[own.firsts[*vertex as usize] as usize] = false);
    let without = found.iter().filter(|vertex| vertex.is_none()).count();
    let slid = found.iter().zip(&part.places).filter(|(vertex, place)| vertex.is_none() && on_surface(place)).count();
    let left = is_left.iter().filter(|is_left| **is_left).count();
    // Other factors move many vertices, and change how many there are.
    if slid > 0 && (slid > 1 + found.len() / 50 || left != without) {
        return None;
    }
    for (place, found) in part.places.iter().zip(&mut found).filter(|(_, found)| found.is_none()) {
        let distance = |vertex: u32| {
            let [u, v] = our_weights(vertex);
            (u - place.weights[0]).hypot(v - place.weights[1])
        };
        let left = (0..own.weights.len() as u32).filter(|vertex| is_left[*vertex as usize]);
        let vertex = left.min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        // A vertex that is moved along the surface stays on its side. On another side it is one of other factors.
        let sides = |weights: [f64; 2]| sides_at(weights, reach.domain);
        if on_surface(place) && vertex.is_some_and(|own| sides(our_weights(own)) != sides(place.weights)) {
            return None;
        }
        vertex.iter().for_each(|vertex| is_left[*vertex as usize] = false);
        *found = vertex;
    }
    Some((found, is_left, slid as u64))
}

/// On which sides of the patch a place is: those whose opposite corner has no weight there.
fn sides_at([u, v]: [f64; 2], reach: f64) -> [bool; 3] {
    [u, v, 1.0 - u - v].map(|weight| weight.abs() <= reach)
}

/// The largest distance between vertices of theirs and ours at the same domain points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Farthest {
    /// In object units.
    pub distance: f64,
    pub patch: u32,
    /// In our coordinates.
    pub theirs: DVec3,
    pub ours: DVec3,
}

impl Farthest {
    pub(super) fn farther(self, other: Self) -> Self {
        if other.distance > self.distance { other } else { self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A patch in the plane, cut into four triangles.
    fn own() -> OurPatch {
        let weights = vec![[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.5, 0.5], [0.0, 0.5], [0.5, 0.0]];
        let positions: Vec<DVec3> = weights.iter().map(|[u, v]| DVec3::new(*u, *v, 0.0)).collect();
        let triangles = vec![[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
        OurPatch { normals: vec![DVec3::Z; 6], firsts: (0..6).collect(), weights, positions, triangles }
    }

    fn part(triangles: &[[u32; 3]], left_out: usize) -> Part {
        let own = own();
        let place = |weights: &[f64; 2]| Place { patch: 0, weights: *weights, distance: 0.0 };
        let places: Vec<Place> = own.weights.iter().map(place).collect();
        let places = places[..6 - left_out].to_vec();
        Part { vertices: (0..places.len() as u32).collect(), places, triangles: triangles.to_vec() }
    }

    #[test]
    fn triangles_that_are_missing_doubled_flipped_or_cut_otherwise_are_counted() {
        let reach = Reach { domain: 0.01, fit: 1e-6 };
        let counts = |triangles: &[[u32; 3]], left_out: usize| {
            let found = Match::new(&part(triangles, left_out), &own(), reach);
            (found.has_same_points, [found.missing, found.doubled, found.flipped, found.other])
        };
        assert_eq!(counts(&own().triangles, 0), (true, [0; 4]));
        assert_eq!(counts(&[[0, 3, 5], [3, 1, 4], [5, 4, 2]], 0), (true, [1, 0, 0, 0]));
        assert_eq!(counts(&[[3, 5, 0], [3, 1, 4], [5, 4, 2], [3, 4, 5], [4, 2, 5]], 0), (true, [0, 1, 0, 0]));
        assert_eq!(counts(&[[0, 5, 3], [3, 1, 4], [5, 4, 2], [3, 4, 5]], 0), (true, [0, 0, 1, 0]));
        // The diagonal of the lower quad is turned.
        assert_eq!(counts(&[[0, 3, 5], [3, 1, 4], [3, 4, 2], [3, 2, 5]], 0), (true, [0, 0, 0, 2]));
        // One triangle for all of the patch.
        assert_eq!(counts(&[[0, 1, 2]], 3), (false, [0; 4]));
    }

    #[test]
    fn a_vertex_that_was_moved_along_the_surface_is_no_other_factor() {
        let mut moved = part(&own().triangles, 0);
        moved.places[3].weights = [0.45, 0.55];
        let found = Match::new(&moved, &own(), Reach { domain: 0.01, fit: 1e-6 });
        assert_eq!((found.has_same_points, found.slid, found.our_vertices[3]), (true, 1, Some(3)));
        // It lies on another side than the point that is left.
        let mut elsewhere = moved.clone();
        elsewhere.places[3].weights = [0.25, 0.0];
        assert!(!Match::new(&elsewhere, &own(), Reach { domain: 0.01, fit: 1e-6 }).has_same_points);
        // The side has a point more than ours.
        moved.places.push(Place { patch: 0, weights: [0.75, 0.25], distance: 0.0 });
        moved.vertices.push(6);
        assert!(!Match::new(&moved, &own(), Reach { domain: 0.01, fit: 1e-6 }).has_same_points);
    }

    #[test]
    fn a_vertex_off_the_surface_is_the_point_that_is_left() {
        let mut moved = part(&own().triangles, 0);
        moved.places[3] = Place { patch: 0, weights: [0.45, 0.45], distance: 0.1 };
        let found = Match::new(&moved, &own(), Reach { domain: 0.01, fit: 1e-6 });
        assert!(found.has_same_points && found.other + found.missing == 0, "{found:?}");
        assert_eq!(found.our_vertices[3], Some(3));
    }
}
