//! Gives every triangle of another program to the patch that it lies on.

use std::collections::{BTreeSet, HashMap};

use glam::DVec3;

use super::foreign::{ForeignMesh, spread};
use super::locator::{Locator, Place};
use super::our_mesh::sorted;
use super::twins::Twins;
use geometry::cores::in_ranges;
use geometry::groups::in_groups;
use geometry::mesh::Topology;

/// Another program's mesh over our surface.
pub(super) struct Overlaid<'a> {
    pub theirs: &'a ForeignMesh,
    pub topology: &'a Topology,
    /// Finds places; there is none where all of their triangles are ours.
    pub locator: Option<Locator<'a>>,
    /// Their positions in our coordinates.
    pub positions: &'a [DVec3],
    /// Which of their triangles are ours.
    pub twins: Twins<'a>,
    /// The nearest place of each of their vertices.
    pub places: Vec<Place>,
    /// Vertices that are farther from the surface don't lie on it, in object units.
    pub fit: f64,
}

/// Their triangles, patch by patch.
pub(super) struct Assignment<'a> {
    pub overlaid: &'a Overlaid<'a>,
    /// Their triangles in the order of the patches.
    order: Vec<u32>,
    /// Where each patch's begin in `order`, and the end.
    starts: Vec<u32>,
}

/// Their triangles on one patch.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Their vertices, each once for each vertex of ours that it is: indices into [`ForeignMesh::positions`].
    pub vertices: Vec<u32>,
    /// Where each lies on this patch.
    pub places: Vec<Place>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

/// The place of a vertex that is on no patch.
const NOWHERE: Place = Place { patch: 0, weights: [0.0; 2], distance: f64::INFINITY };

/// How many triangles are asked how they are wound.
const WOUND: usize = 300;
/// How many vertices or triangles are worth a thread.
const LEAST: usize = 1 << 10;

/// Returns what `make` makes of the numbers below `count`, on all cores.
pub(super) fn made_of_all<R: Send>(count: usize, make: impl Fn(usize) -> R + Sync) -> Vec<R> {
    in_ranges(count, LEAST, |range| range.map(&make).collect::<Vec<_>>()).into_iter().flatten().collect()
}

impl<'a> Overlaid<'a> {
    /// Finds the place of each of their vertices: that of our vertex that it is, or the nearest.
    pub(super) fn new(
        theirs: &'a ForeignMesh,
        topology: &'a Topology,
        locator: Option<Locator<'a>>,
        twins: Twins<'a>,
        positions: &'a [DVec3],
        fit: f64,
    ) -> Self {
        let nearest = |index: usize| locator.as_ref().and_then(|locator| locator.place(positions[index]));
        // Without a locator, triangles that aren't ours are too thin to be anywhere.
        let nowhere = if locator.is_some() { NOWHERE } else { Place { distance: 0.0, ..NOWHERE } };
        let place = |index: usize| twins.places[index].or_else(|| nearest(index)).unwrap_or(nowhere);
        let places = made_of_all(positions.len(), place);
        Self { theirs, topology, locator, positions, twins, places, fit }
    }

    /// The same vertices over another surface.
    pub(super) fn over(&self, locator: Option<Locator<'a>>, twins: Twins<'a>) -> Self {
        Self::new(self.theirs, self.topology, locator, twins, self.positions, self.fit)
    }

    /// Their vertices that don't lie on the surface.
    pub(super) fn strays(&self) -> Vec<u32> {
        let is_stray = |index: &u32| self.places[*index as usize].distance > self.fit;
        (0..self.places.len() as u32).filter(is_stray).collect()
    }

    /// The place of a vertex on one patch.
    fn place_on(&self, vertex: u32, patch: u32) -> Place {
        let own = self.places[vertex as usize];
        if own.patch == patch {
            return own;
        }
        let position = self.positions[vertex as usize];
        self.locator.as_ref().and_then(|locator| locator.place_on(patch, position)).unwrap_or(NOWHERE)
    }

    /// The patch that is nearest to the middle of a triangle.
    fn nearest_patch(&self, triangle: [u32; 3]) -> u32 {
        let middle = triangle.map(|corner| self.positions[corner as usize]).into_iter().sum::<DVec3>() / 3.0;
        self.locator.as_ref().and_then(|locator| locator.patch(middle)).unwrap_or_default()
    }

    /// How most of their triangles are wound that lie on the nearest patch: 1 as the patch, -1 the other way.
    fn winding(&self) -> f64 {
        let triangles = &self.theirs.triangles;
        let fit = |triangle: [u32; 3]| self.fit_on(self.nearest_patch(triangle), triangle, 1.0);
        let fits = spread(triangles.len(), WOUND).map(|index| fit(triangles[index])).filter(|fit| fit.corners == 3);
        let (alike, turned): (Vec<Fit>, Vec<Fit>) = fits.partition(|fit| fit.is_good);
        if turned.len() > alike.len() { -1.0 } else { 1.0 }
    }

    fn fit_on(&self, patch: u32, triangle: [u32; 3], winding: f64) -> Fit {
        let places = triangle.map(|corner| self.place_on(corner, patch));
        let corners = places.iter().filter(|place| place.distance <= self.fit).count();
        let is_good = corners == 3 && winding * domain_area(places.map(|place| place.weights)) > 0.0;
        let distance: f64 = places.iter().map(|place| place.distance).sum();
        Fit { corners, is_good, nearness: if corners == 3 { 0.0 } else { -distance } }
    }

    /// Returns the patch that a triangle lies on: the one on whose surface most of its corners are, and on which it is wound as
    /// most are.
    fn patch_of(&self, triangle: [u32; 3], winding: f64) -> u32 {
        let nearest = self.nearest_patch(triangle);
        let [a, b, c] = triangle.map(|corner| self.places[corner as usize].patch);
        let near = [nearest, a, b, c];
        let (mut best, mut tried): (Option<(Fit, u32)>, _) = (None, Vec::new());
        for patch in near.into_iter().chain(near.into_iter().flat_map(|patch| self.neighbours(patch))) {
            if tried.contains(&patch) {
                continue;
            }
            tried.push(patch);
            let fit = self.fit_on(patch, triangle, winding);
            if best.is_none_or(|(other, _)| fit > other) {
                best = Some((fit, patch));
            }
            if fit.is_good {
                break;
            }
        }
        best.map_or(nearest, |(_, patch)| patch)
    }

    /// The patches that share an edge with a patch.
    fn neighbours(&self, patch: u32) -> Vec<u32> {
        let sides = self.topology.patches[patch as usize].sides;
        let edges = sides.map(|side| &self.topology.edges[self.topology.sides[side as usize].edge as usize]);
        edges.into_iter().flat_map(|edge| self.topology.edge_sides(edge)).map(|side| side.patch()).collect()
    }
}

/// How well a triangle fits a patch: the greater, the better.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Fit {
    /// How many of its corners lie on the patch's surface.
    corners: usize,
    /// Whether all do, and it is wound as it should be: as the patch, or the other way.
    is_good: bool,
    /// The sum of its corners' distances from the patch in object units, times -1; 0 where all lie on it.
    nearness: f64,
}

/// The area of a triangle in the domain, whose own area is 1: negative if it is wound the other way than the patch. Its corners
/// are weights of the patch's corners 0 and 1.
pub(super) fn domain_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

impl<'a> Assignment<'a> {
    /// Assigns all triangles whose corners can be told apart: the twins of ours to the patches that emit these, and others to those that
    /// they lie on.
    pub(super) fn new(overlaid: &'a Overlaid<'a>) -> Self {
        let (triangles, twins) = (&overlaid.theirs.triangles, &overlaid.twins);
        let winding = if twins.are_all() { 1.0 } else { overlaid.winding() };
        let patches = made_of_all(triangles.len(), |index| match twins.corners[index] {
            Some([vertex, ..]) => twins.place(vertex).patch,
            None if twins.is_thin[index] => 0,
            None => overlaid.patch_of(triangles[index], winding),
        });
        let seen = patches.iter().copied().zip(0..).filter(|(_, triangle)| !twins.is_thin[*triangle as usize]);
        let (starts, order) = in_groups(overlaid.topology.patches.len(), seen);
        Self { overlaid, order, starts }
    }

    /// The number of their triangles on a patch.
    pub(super) fn count(&self, patch: u32) -> u32 {
        self.starts[patch as usize + 1] - self.starts[patch as usize]
    }

    /// Their triangles on a patch.
    pub(super) fn part(&self, patch: u32) -> Part {
        let own = &self.order[self.starts[patch as usize] as usize..self.starts[patch as usize + 1] as usize];
        let (mut part, mut numbers, mut known) = (Part::default(), HashMap::new(), HashMap::new());
        // Twins first: what they say of a vertex holds for other triangles, too.
        let twins = &self.overlaid.twins;
        let (of_ours, others): (Vec<u32>, Vec<u32>) =
            own.iter().copied().partition(|triangle| twins.corners[*triangle as usize].is_some());
        for triangle in of_ours.into_iter().chain(others) {
            let twins = twins.corners[triangle as usize];
            let vertices = self.overlaid.theirs.triangles[triangle as usize];
            let corners = [0, 1, 2].map(|k| {
                let vertex = vertices[k];
                let twin = match twins {
                    Some(twins) => Some(*known.entry(vertex).insert_entry(twins[k]).get()),
                    None => known.get(&vertex).copied(),
                };
                *numbers.entry((vertex, twin)).or_insert_with(|| {
                    part.vertices.push(vertex);
                    part.places.push(self.place_on(vertex, twin, patch));
                    part.vertices.len() as u32 - 1
                })
            });
            part.triangles.push(corners);
        }
        part
    }

    /// The place of a vertex on one patch: that of the vertex of ours that it is, if it is one.
    fn place_on(&self, vertex: u32, twin: Option<u32>, patch: u32) -> Place {
        twin.map_or_else(|| self.overlaid.place_on(vertex, patch), |twin| self.overlaid.twins.place(twin))
    }
}

impl Part {
    /// The weights of corners 0 and 1 at a triangle's corners.
    pub(super) fn weights(&self, triangle: [u32; 3]) -> [[f64; 2]; 3] {
        triangle.map(|corner| self.places[corner as usize].weights)
    }

    /// Whether its triangles cover the patch without gaps. Those that occur twice count once.
    pub(super) fn is_whole(&self) -> bool {
        let triangles: BTreeSet<_> = self.triangles.iter().map(|triangle| sorted(*triangle)).collect();
        let area: f64 = triangles.into_iter().map(|triangle| domain_area(self.weights(triangle)).abs()).sum();
        area >= 0.999
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::locator::FINE;
    use geometry::mesh::Shape;
    use geometry::tessellate::{Inputs, LodView, Surface, Tessellation, tessellate};
    use glam::Vec3;

    #[test]
    fn triangles_are_given_to_the_patches_that_emitted_them() {
        for surface in [Surface::Pn, Surface::PnAen, Surface::Flat] {
            for shape in [Shape::CubeSplit, Shape::Moebius, Shape::Torus, Shape::Cone] {
                let mesh = shape.build();
                let topology = Topology::new(&mesh);
                let tessellation = Tessellation { surface, ..Tessellation::default() };
                let inputs = Inputs::new(&tessellation, LodView::default());
                let out = tessellate(&mesh, &topology, &inputs, None);
                let positions: Vec<Vec3> = out.vertices.iter().map(|vertex| Vec3::from(vertex.position)).collect();
                let theirs = ForeignMesh::new(&positions, out.triangles.iter().rev().copied());
                let locator = Locator::from_surface(&mesh, &topology, &inputs.into(), FINE);
                let own: Vec<DVec3> = theirs.positions.iter().map(|position| position.as_dvec3()).collect();
                // As if none of them were ours.
                let twins = Twins::none(&theirs);
                let overlaid = Overlaid::new(&theirs, &topology, locator, twins, &own, 1e-5);
                assert!(overlaid.strays().is_empty(), "{shape} {surface:?}");
                let assignment = Assignment::new(&overlaid);
                let mut emitted = vec![0; topology.patches.len()];
                for triangle in &out.triangles {
                    emitted[out.vertices[triangle[0] as usize].patch() as usize] += 1;
                }
                // Slivers between vertices that round to one position are left out.
                assert_eq!(theirs.degenerate, 0);
                for patch in 0..topology.patches.len() as u32 {
                    assert_eq!(assignment.count(patch), emitted[patch as usize], "{shape} {surface:?}, patch {patch}");
                }
            }
        }
    }
}
