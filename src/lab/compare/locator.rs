//! Finds the patch and the place in its domain that a position belongs to.

use std::borrow::Cow;

use glam::{DVec3, Vec3};

use super::net_mistakes::NetMistake;
use geometry::groups::group_starts;
use geometry::mesh::{Mesh, Topology};
use geometry::near::{TriangleTree, closest_on_triangle};
use geometry::tessellate::{
    ControlNet, Inputs, LimitSurface, Partitioning, Tessellated, Tessellation, Vertex, tessellate,
};

/// Patches that are cut into triangles, with a hierarchy of boxes to find the nearest one.
pub(super) struct Locator<'a> {
    cut: Cow<'a, Tessellated>,
    /// The first triangle of each patch, and the end.
    starts: Vec<u32>,
    tree: TriangleTree,
    /// The surface that the triangles approximate; `None` if they are the surface themselves.
    limit: Option<LimitSurface<'a>>,
    /// What is wrong with that surface's control points.
    mistake: Option<NetMistake>,
    /// How far the surface is from the triangles, in object units.
    sag: f64,
}

/// A surface of ours, or what a mistake makes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OurSurface {
    pub inputs: Inputs,
    pub mistake: Option<NetMistake>,
}

impl OurSurface {
    /// Where vertices of ours would be on it.
    pub(super) fn positions(&self, mesh: &Mesh, topology: &Topology, vertices: &[Vertex]) -> Vec<Vec3> {
        let limit = LimitSurface::new(mesh, topology, &self.inputs);
        let position = |vertex: &Vertex| {
            let [u, v] = vertex.exact_domain();
            let net = with_mistake(limit.net(vertex.patch()), self.mistake);
            limit.position(vertex.patch(), &net, u, v).as_vec3()
        };
        vertices.iter().map(position).collect()
    }
}

impl From<Inputs> for OurSurface {
    fn from(inputs: Inputs) -> Self {
        Self { inputs, mistake: None }
    }
}

fn with_mistake(net: ControlNet, mistake: Option<NetMistake>) -> ControlNet {
    mistake.map_or(net, |mistake| mistake.apply(net))
}

/// Where a position lies on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub patch: u32,
    /// The weights of the patch's corners 0 and 1.
    pub weights: [f64; 2],
    /// The distance from the position to this point of the surface, in object units.
    pub distance: f64,
}

/// The most triangles that patches are cut into, all together, unless the patches are more.
pub(super) const FINE: usize = 1 << 19;
/// The same where only a sample is looked for.
pub(super) const COARSE: usize = 1 << 14;

impl<'a> Locator<'a> {
    /// Prepares the surface of a tessellation with these inputs, which displace nothing. `triangles` is about how many triangles it
    /// is searched with. Returns `None` if the mesh has no patches.
    pub(super) fn from_surface(
        mesh: &'a Mesh,
        topology: &'a Topology,
        surface: &OurSurface,
        triangles: usize,
    ) -> Option<Self> {
        let OurSurface { inputs, mistake } = surface;
        let segments = ((triangles / topology.patches.len().max(1)) as f32).sqrt().floor().clamp(1.0, 16.0);
        let tessellation = Tessellation {
            partitioning: Partitioning::Subtriangulation,
            ..inputs.tessellation.with_one_factor(segments)
        };
        let mut cut = tessellate(mesh, topology, &Inputs { tessellation, ..*inputs }, None);
        if mistake.is_some() {
            let positions = surface.positions(mesh, topology, &cut.vertices);
            cut.vertices.iter_mut().zip(positions).for_each(|(vertex, position)| vertex.position = position.to_array());
        }
        let limit = LimitSurface::new(mesh, topology, inputs);
        Self::new(Cow::Owned(cut), topology, Some(limit), *mistake)
    }

    /// Prepares the triangles that were emitted, which are the surface themselves. Returns `None` if there are none.
    pub(super) fn from_emitted(emitted: &'a Tessellated, topology: &Topology) -> Option<Self> {
        Self::new(Cow::Borrowed(emitted), topology, None, None)
    }

    fn new(
        cut: Cow<'a, Tessellated>,
        topology: &Topology,
        limit: Option<LimitSurface<'a>>,
        mistake: Option<NetMistake>,
    ) -> Option<Self> {
        let at = |index: u32| Vec3::from(cut.vertices[index as usize].position);
        let tree = TriangleTree::new(cut.triangles.iter().map(|triangle| triangle.map(at)))?;
        let patches = cut.triangles.iter().map(|triangle| cut.vertices[triangle[0] as usize].patch());
        let starts = group_starts(topology.patches.len(), patches);
        let mut made = Self { starts, tree, limit, mistake, cut, sag: 0.0 };
        made.sag = made.largest_sag();
        Some(made)
    }

    fn net(&self, limit: &LimitSurface, patch: u32) -> ControlNet {
        with_mistake(limit.net(patch), self.mistake)
    }

    /// The largest distance between the middles of triangles and the surface there.
    fn largest_sag(&self) -> f64 {
        let Some(limit) = &self.limit else { return 0.0 };
        let sag = |triangle: &[u32; 3]| {
            let corners = triangle.map(|index| &self.cut.vertices[index as usize]);
            let middle = corners.map(|vertex| Vec3::from(vertex.position).as_dvec3()).into_iter().sum::<DVec3>() / 3.0;
            let [u, v] = [0, 1].map(|k| corners.iter().map(|vertex| vertex.exact_domain()[k]).sum::<f64>() / 3.0);
            let patch = corners[0].patch();
            limit.position(patch, &self.net(limit, patch), u, v).distance(middle)
        };
        self.cut.triangles.iter().map(sag).fold(0.0, f64::max)
    }

    /// The distance from a position to the triangles: quick, and near the distance to the surface.
    pub(super) fn rough_distance(&self, position: DVec3) -> f64 {
        self.tree.closest(position, f64::INFINITY).map_or(f64::INFINITY, |closest| closest.distance)
    }

    /// The patch whose triangles are nearest.
    pub(super) fn patch(&self, position: DVec3) -> Option<u32> {
        let closest = self.tree.closest(position, f64::INFINITY)?;
        Some(self.patch_of(closest.triangle))
    }

    fn patch_of(&self, triangle: u32) -> u32 {
        self.cut.vertices[self.cut.triangles[triangle as usize][0] as usize].patch()
    }

    /// The nearest point of the surface.
    pub(super) fn place(&self, position: DVec3) -> Option<Place> {
        /// A position that is nearer than this part of the triangles' distance from the surface lies on the patch.
        const CLOSE: f64 = 0.01;
        let closest = self.tree.closest(position, f64::INFINITY)?;
        let first = self.refined(closest.triangle, closest.weights, closest.distance, position);
        if first.distance <= CLOSE * self.sag || self.limit.is_none() {
            return Some(first);
        }
        // The surface of another patch may be nearer, though its triangles aren't.
        let mut others = self.tree.all_closest(position, 2.0 * self.sag);
        others.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut tried = vec![first.patch];
        let mut best = first;
        for other in others {
            let patch = self.patch_of(other.triangle);
            if !tried.contains(&patch) {
                tried.push(patch);
                let place = self.refined(other.triangle, other.weights, other.distance, position);
                best = if place.distance < best.distance { place } else { best };
            }
        }
        Some(best)
    }

    /// The nearest point of the surface itself.
    pub(super) fn point(&self, position: DVec3) -> Option<DVec3> {
        let Some(limit) = &self.limit else { return Some(self.tree.closest(position, f64::INFINITY)?.point) };
        let Place { patch, weights: [u, v], .. } = self.place(position)?;
        Some(limit.position(patch, &self.net(limit, patch), u, v))
    }

    /// The nearest point of one patch; `None` if it has no triangles.
    pub(super) fn place_on(&self, patch: u32, position: DVec3) -> Option<Place> {
        let nearest = |triangle: u32| {
            let corners = self.cut.triangles[triangle as usize];
            let corners = corners.map(|index| Vec3::from(self.cut.vertices[index as usize].position).as_dvec3());
            let (weights, point) = closest_on_triangle(corners, position);
            (triangle, weights, point.distance(position))
        };
        let own = self.starts[patch as usize]..self.starts[patch as usize + 1];
        let (triangle, weights, distance) = own.map(nearest).min_by(|a, b| a.2.total_cmp(&b.2))?;
        Some(self.refined(triangle, weights, distance, position))
    }

    /// The nearest point of a patch, from the nearest point of one of its triangles.
    fn refined(&self, triangle: u32, weights: [f64; 3], distance: f64, position: DVec3) -> Place {
        let corners = self.cut.triangles[triangle as usize].map(|index| &self.cut.vertices[index as usize]);
        let patch = corners[0].patch();
        let start = [0, 1].map(|k| (0..3).map(|i| weights[i] * corners[i].exact_domain()[k]).sum::<f64>());
        match &self.limit {
            None => Place { patch, weights: start, distance },
            Some(limit) => {
                let (weights, distance) = limit.nearest_in_space(patch, &self.net(limit, patch), start, position);
                Place { patch, weights, distance }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Shape;
    use geometry::tessellate::{FIXED_ONE, LodView, Surface};

    /// Checks that a locator finds emitted vertices at their own places.
    fn check(locator: &Locator, vertices: &[Vertex]) {
        for vertex in vertices {
            let position = Vec3::from(vertex.position).as_dvec3();
            let own = vertex.domain().map(|weight| f64::from(weight) / f64::from(FIXED_ONE));
            for place in [locator.place(position), locator.place_on(vertex.patch(), position)] {
                let place = place.expect("a place");
                assert!(place.distance < 1e-6, "{place:?}");
                let apart = [0, 1].map(|k| (place.weights[k] - own[k]).abs());
                let is_inside = own[0] > 0.0 && own[1] > 0.0 && own[0] + own[1] < 1.0;
                // On an edge the nearest place may be the neighbour's.
                let is_own = place.patch == vertex.patch();
                assert!(if is_own { apart[0].max(apart[1]) < 1e-4 } else { !is_inside }, "{place:?}, not {own:?}");
            }
        }
    }

    #[test]
    fn emitted_vertices_are_found_at_their_our_places() {
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::new(&mesh);
        for surface in Surface::ALL {
            let inputs = Inputs::new(&Tessellation { surface, ..Tessellation::default() }, LodView::default());
            let out = tessellate(&mesh, &topology, &inputs, None);
            check(
                &Locator::from_surface(&mesh, &topology, &inputs.into(), FINE).expect("it has patches"),
                &out.vertices,
            );
            check(&Locator::from_emitted(&out, &topology).expect("it has triangles"), &out.vertices);
        }
    }
}
