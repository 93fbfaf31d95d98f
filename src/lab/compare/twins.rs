//! Which triangles of another program are triangles of ours: those between the same positions. Nothing need be known of the surface
//! there, which may be folded, or lie on itself.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use super::foreign::ForeignMesh;
use super::locator::Place;
use super::our_mesh::{OurMesh, is_thin, sorted};
use geometry::mesh::weld::weld_alike;
use geometry::tessellate::Vertex;

/// What their triangles are of ours.
pub(super) struct Twins<'a> {
    own: &'a [Vertex],
    /// For each of their triangles our vertices at its corners; `None` if it isn't ours.
    pub corners: Vec<Option<[u32; 3]>>,
    /// For each of their vertices the place of a vertex of ours that it can't be told apart from, if there is one.
    pub places: Vec<Option<Place>>,
    /// For each of their triangles whether two of its corners can't be told apart, so that nothing can be said of it.
    pub is_thin: Vec<bool>,
}

/// A triangle by its points.
#[derive(Clone, Copy)]
struct Triangle {
    /// In ascending order.
    points: [u32; 3],
    /// Whether it is wound against that order.
    is_turned: bool,
    index: u32,
}

impl Triangle {
    fn new(points: [u32; 3], index: u32) -> Self {
        let [a, b, c] = points;
        let is_turned = [(a, b), (b, c), (c, a)].iter().filter(|(a, b)| a > b).count() == 2;
        Self { points: sorted(points), is_turned, index }
    }

    /// Those whose corners can be told apart, in the order of their points, and then of their winding.
    fn sorted(all: impl Iterator<Item = [u32; 3]>) -> Vec<Self> {
        let numbered = (0..).zip(all).filter(|(_, points)| !is_thin(*points));
        let mut sorted: Vec<Self> = numbered.map(|(index, points)| Self::new(points, index)).collect();
        sorted.sort_unstable_by_key(|own| (own.points, own.is_turned, own.index));
        sorted
    }
}

impl<'a> Twins<'a> {
    /// Finds the twins of their triangles, whose vertices are at `positions` in our coordinates. `own` are the positions of our
    /// vertices on the surface that theirs lie on. Positions within `tolerance` object units are the same.
    pub(super) fn find(
        ours: &OurMesh<'a>,
        own: &[Vec3],
        theirs: &ForeignMesh,
        positions: &[DVec3],
        tolerance: f64,
    ) -> Self {
        let at = |i: usize| own.get(i).copied().unwrap_or_else(|| positions[i - own.len()].as_vec3());
        let (_, points) = weld_alike(own.len() + positions.len(), |i| (at(i), 0), tolerance);
        let (our_points, their_points) = points.split_at(own.len());
        let of = |triangle: &[u32; 3], points: &[u32]| triangle.map(|vertex| points[vertex as usize]);
        let our_triangles =
            Triangle::sorted(ours.tessellated.triangles.iter().map(|triangle| of(triangle, our_points)));
        let their_triangles = Triangle::sorted(theirs.triangles.iter().map(|triangle| of(triangle, their_points)));
        let mut corners = vec![None; theirs.triangles.len()];
        let mut our_groups = our_triangles.chunk_by(|a, b| a.points == b.points).peekable();
        for group in their_triangles.chunk_by(|a, b| a.points == b.points) {
            let compared = |own: &&[Triangle]| own[0].points.cmp(&group[0].points);
            while our_groups.next_if(|own| compared(own) == Ordering::Less).is_some() {}
            let Some(our_group) = our_groups.next_if(|own| compared(own) == Ordering::Equal) else { continue };
            let their_corners = |their: u32| theirs.triangles[their as usize].map(|vertex| vertex as usize);
            let twin = |their: u32, own: u32| {
                let corners = ours.tessellated.triangles[own as usize];
                let corner =
                    |vertex: usize| corners.into_iter().find(|own| our_points[*own as usize] == their_points[vertex]);
                let [a, b, c] = their_corners(their).map(corner);
                a.zip(b).zip(c).map(|((a, b), c)| [a, b, c])
            };
            let apart = |their: u32, our_triangle: u32| {
                let twins = twin(their, our_triangle).into_iter().flatten();
                let pairs = their_corners(their).into_iter().zip(twins);
                pairs.map(|(vertex, twin)| positions[vertex].distance(own[twin as usize].as_dvec3())).sum::<f64>()
            };
            for (their, own) in pairs(group, our_group, apart) {
                corners[their as usize] = twin(their, own);
            }
        }
        let is_thin = theirs.triangles.iter().map(|triangle| is_thin(of(triangle, their_points))).collect();
        let mut at_points = vec![None; points.iter().max().map_or(0, |last| *last as usize + 1)];
        (0..).zip(our_points).for_each(|(vertex, point)| at_points[*point as usize] = Some(vertex));
        let mut twins = Self { own: &ours.tessellated.vertices, corners, places: Vec::new(), is_thin };
        let place = |point: &u32| at_points[*point as usize].map(|twin: u32| twins.place(twin));
        let mut places: Vec<Option<Place>> = their_points.iter().map(place).collect();
        for (triangle, corners) in theirs.triangles.iter().zip(&twins.corners) {
            for (&vertex, &twin) in triangle.iter().zip(corners.iter().flatten()) {
                let distance = positions[vertex as usize].distance(own[twin as usize].as_dvec3());
                places[vertex as usize] = Some(Place { distance, ..twins.place(twin) });
            }
        }
        twins.places = places;
        twins
    }

    /// As if none of their triangles were ours.
    pub(super) fn none(theirs: &ForeignMesh) -> Self {
        let (count, vertices) = (theirs.triangles.len(), theirs.positions.len());
        Self { own: &[], corners: vec![None; count], places: vec![None; vertices], is_thin: vec![false; count] }
    }

    /// The place of a vertex of ours.
    pub(super) fn place(&self, own: u32) -> Place {
        let own = &self.own[own as usize];
        Place { patch: own.patch(), weights: own.exact_domain(), distance: 0.0 }
    }

    /// Whether all of their triangles are ours, but for those of which nothing can be said.
    pub(super) fn are_all(&self) -> bool {
        self.corners.iter().zip(&self.is_thin).all(|(corners, is_thin)| corners.is_some() || *is_thin)
    }
}

/// How many of our triangles between the same points are tried for each of theirs, so that a million of them take no longer a triangle.
const TRIED: usize = 64;

/// Gives each of their triangles one of ours between the same points: the nearest that is wound alike, if there is one that no other has;
/// or else the nearest that no other has; or else the first. Both are indices, and `apart` says how far two triangles are apart.
fn pairs(theirs: &[Triangle], own: &[Triangle], apart: impl Fn(u32, u32) -> f64) -> Vec<(u32, u32)> {
    let mut left: Vec<Triangle> = own.to_vec();
    let mut found = Vec::new();
    let mut rest: Vec<Triangle> = theirs.to_vec();
    for is_alike in [true, false] {
        rest.retain(|their| {
            let alike =
                (0..left.len().min(TRIED)).filter(|place| !is_alike || left[*place].is_turned == their.is_turned);
            let distance = |place: &usize| apart(their.index, left[*place].index);
            let place = alike.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            found.extend(place.map(|place| (their.index, left.swap_remove(place).index)));
            place.is_none()
        });
    }
    found.extend(rest.iter().map(|their| (their.index, own[0].index)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn winding_is_told_whichever_corner_comes_first() {
        let turned = |points| Triangle::new(points, 0).is_turned;
        assert_eq!([[1, 2, 3], [2, 3, 1], [3, 1, 2]].map(turned), [false; 3]);
        assert_eq!([[1, 3, 2], [3, 2, 1], [2, 1, 3]].map(turned), [true; 3]);
    }

    #[test]
    fn each_gets_one_of_its_our_winding_first() {
        let list = |all: &[[u32; 3]]| Triangle::sorted(all.iter().copied());
        let found = |theirs: &[[u32; 3]], own: &[[u32; 3]]| {
            let mut found = pairs(&list(theirs), &list(own), |_, _| 0.0);
            found.sort_unstable();
            found
        };
        let [alike, turned] = [[1, 2, 3], [2, 1, 3]];
        assert_eq!(found(&[turned, alike], &[alike, turned]), [(0, 1), (1, 0)]);
        assert_eq!(found(&[turned, turned], &[alike, turned]), [(0, 1), (1, 0)]);
        assert_eq!(found(&[alike, alike], &[alike]), [(0, 0), (1, 0)]);
        assert!(list(&[[1, 1, 2]]).is_empty());
    }

    #[test]
    fn of_very_many_between_the_same_points_each_gets_one() {
        let many = Triangle::sorted((0..200_000).map(|_| [1, 2, 3]));
        let mut own: Vec<u32> = pairs(&many, &many, |_, _| 0.0).into_iter().map(|(_, own)| own).collect();
        own.sort_unstable();
        assert!(own.into_iter().eq(0..200_000));
    }
}
