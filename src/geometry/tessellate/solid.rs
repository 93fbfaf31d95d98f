//! Solids: meshes whose back faces can't be seen from outside.

use std::sync::OnceLock;

use glam::{Mat4, Vec3};
use rayon::prelude::*;

use super::{Edges, Inputs, Surface, beyond_near, side_control_points, straight_control_point};
use crate::mesh::{Alpha, EdgeKind, Material, Mesh, Topology};

/// A closed mesh whose parts are all wound outward and whose materials are single-sided, without places where one sees the backs that
/// are behind them.
///
/// A line of sight that starts outside enters the mesh before it leaves it, so each back face is hidden by a front
/// face. (If a mesh intersects itself inside out, a back face may come first. Leaving it out then shows what is behind
/// it, but never a hole.)
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// The least and the greatest coordinates, in object units.
    pub extent: [Vec3; 2],
    /// The largest distance of control points from the triangles that they belong to, in object units, for each surface that
    /// has been requested.
    reaches: [OnceLock<f32>; Surface::ALL.len()],
    /// Whether surfaces for which [`Surface::tears`] crack on this mesh.
    pub has_split_normals: bool,
}

impl Solid {
    /// Returns the mesh as a solid, or `None` if it isn't one.
    pub fn find(mesh: &Mesh, topology: &Topology) -> Option<Self> {
        // Backs can be seen through the holes of a mask, and through what blends or transmits light unless all of the mesh does: then
        // no backs are drawn.
        let is_whole = |own: &Material| !own.double_sided && !matches!(own.look.alpha, Alpha::Mask(_));
        let shows_behind = mesh.materials.iter().filter(|own| own.shows_behind()).count();
        let is_even = shows_behind == 0 || shows_behind == mesh.materials.len();
        let are_hidden = mesh.materials.iter().all(is_whole) && is_even;
        if !are_hidden || !topology.is_closed_and_oriented() || topology.part_volumes().any(|volume| volume <= 0.0) {
            return None;
        }
        let bounds = mesh.bounds();
        let has_split_normals = topology.edges.iter().any(|edge| edge.kind == EdgeKind::Split);
        Some(Self { extent: [bounds.min, bounds.max], reaches: Default::default(), has_split_normals })
    }

    /// Returns whether no back face can be seen with these inputs: the tessellation has no cracks, and the near plane
    /// doesn't cut the mesh, which is the one that [`Self::find`] was given.
    pub fn hides_backs(&self, mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> bool {
        let tears = inputs.surfaces(mesh).any(Surface::tears) && self.has_split_normals;
        // A displaced surface may show its back anywhere.
        let whole = !inputs.tessellation.displacement.is_on() && !tears;
        let holds =
            inputs.tessellation.edges == Edges::PerEdge && inputs.tessellation.convention.is_consistent() && whole;
        let is_beyond = |surface| is_beyond_near(inputs.view.clip_from_object, self.extent_of(surface, mesh, topology));
        holds && inputs.surfaces(mesh).all(is_beyond)
    }

    /// Returns the least and the greatest coordinates of all control points of a surface, in object units.
    fn extent_of(&self, surface: Surface, mesh: &Mesh, topology: &Topology) -> [Vec3; 2] {
        let reach = self.reaches[surface as usize].get_or_init(|| control_point_reach(surface, mesh, topology));
        let reach = Vec3::splat(*reach);
        [self.extent[0] - reach, self.extent[1] + reach]
    }
}

/// Returns the largest distance of a surface's control points from the triangles that they belong to, in object units.
///
/// An edge's control points are at most as far from the straight edge as any side's proposal, or a third of the edge's
/// length if they are projected onto a crease. The centre is 1.5 times as far as the six others are on average.
fn control_point_reach(surface: Surface, mesh: &Mesh, topology: &Topology) -> f32 {
    let side = |side: &crate::mesh::Side| {
        let corners = topology.side_corners(side);
        let [a, b] = corners.map(|c| topology.points[topology.corner_points[c as usize] as usize]);
        let [at_a, at_b] = corners.map(|c| mesh.corners[c as usize].normal);
        let [ab, ba] = side_control_points(surface, 1.0, a, b, at_a, at_b);
        let own = ab.distance(straight_control_point(a, b)).max(ba.distance(straight_control_point(b, a)));
        if surface.has_creases() { own.max(a.distance(b) * (1.0 / 3.0)) } else { own }
    };
    topology.sides.par_iter().map(side).reduce(|| 0.0, f32::max) * 1.5
}

/// Returns whether a box, given by its least and greatest coordinates, lies completely beyond the near plane.
pub fn is_beyond_near(clip_from_object: Mat4, [min, max]: [Vec3; 2]) -> bool {
    (0..8).all(|corner| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
        beyond_near(clip_from_object * Vec3::new(pick(0), pick(1), pick(2)).extend(1.0))
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::{Look, Shape};
    use crate::progress::Progress;
    use crate::tessellate::{LimitSurface, LodView, Tessellation};

    fn solid(mesh: &Mesh) -> Option<Solid> {
        Solid::find(mesh, &Topology::build(mesh, &Progress::default()).expect("nobody cancels"))
    }

    #[test]
    fn closed_single_sided_shapes_wound_outward_are_solids() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let closed = !matches!(shape, Shape::Saddle | Shape::Bicubic | Shape::Moebius);
            assert_eq!(solid(&mesh).is_some(), closed, "{shape:?}");
            let mut inward = mesh.clone();
            Arc::make_mut(&mut inward.triangles).iter_mut().for_each(|triangle| triangle.reverse());
            assert_eq!(solid(&inward), None, "{shape:?} wound inward");
            let mut double = mesh.clone();
            double.materials[0].double_sided = true;
            assert_eq!(solid(&double), None, "{shape:?} with a double-sided material");
            let mut pierced = mesh.clone();
            pierced.materials[0].look.alpha = Alpha::Mask(0.5);
            assert_eq!(solid(&pierced), None, "{shape:?} with holes in its material");
            let mut glass = mesh.clone();
            glass.materials[0].look.alpha = Alpha::Blend;
            assert_eq!(solid(&glass).is_some(), closed, "{shape:?} that blends, whose backs aren't drawn");
            glass.materials.extend(mesh.materials.clone());
            assert_eq!(solid(&glass), None, "{shape:?} whose back is seen through what blends");
            glass.materials[0].look = Look { transmission: 0.5, ..Look::default() };
            assert_eq!(solid(&glass), None, "{shape:?} whose back is seen through what transmits light");
        }
    }

    #[test]
    fn a_mesh_with_one_part_wound_inward_is_no_solid() {
        let mut mesh = Shape::Icosahedron.build();
        let count = mesh.corners.len() as u32;
        let smaller = mesh.corners.clone().into_iter().map(|c| crate::mesh::Corner { position: c.position * 0.5, ..c });
        mesh.corners.extend(smaller);
        let inner: Vec<_> = mesh.triangles.iter().map(|&[a, b, c]| [a + count, c + count, b + count]).collect();
        assert!(solid(&mesh).is_some());
        Arc::make_mut(&mut mesh.triangles).extend(inner);
        mesh.materials[0].triangles.end = mesh.triangles.len() as u32;
        assert_eq!(solid(&mesh), None, "the inside of a hollow ball can't be seen either, but that isn't proved");
    }

    #[test]
    fn control_points_stay_within_the_extent() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
            let Some(solid) = Solid::find(&mesh, &topology) else { continue };
            for surface in Surface::ALL {
                let [min, max] = solid.extent_of(surface, &mesh, &topology);
                let tessellation = Tessellation { surface, alpha: 1.0, ..Tessellation::default() };
                let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, glam::Vec2::ONE));
                let limit = LimitSurface::new(&mesh, &topology, &inputs);
                for patch in 0..topology.patches.len() as u32 {
                    let net = limit.net(patch);
                    for p in net.corners.iter().chain(&net.edges).chain([&net.center]) {
                        assert!(p.cmpge(min - 1e-6).all() && p.cmple(max + 1e-6).all(), "{shape:?} {surface:?}: {p}");
                    }
                }
            }
        }
    }

    #[test]
    fn control_points_on_creases_reach_half_of_the_longest_edge() {
        // A cube whose normals are those of its faces: no proposal leaves its edge.
        let mut mesh = Shape::CubeSplit.build();
        for triangle in mesh.triangles.iter() {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].position);
            let normal = (b - a).cross(c - a).normalize();
            triangle.iter().for_each(|&corner| mesh.corners[corner as usize].normal = normal);
        }
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        let [min, max] = [mesh.bounds().min, mesh.bounds().max];
        let diagonal = (max.x - min.x) * 2.0_f32.sqrt();
        for (surface, reach) in [(Surface::Pn, 0.0), (Surface::PnCrease, diagonal / 2.0)] {
            let own = control_point_reach(surface, &mesh, &topology);
            assert!((own - reach).abs() < 1e-6, "{surface:?}: {own}, not {reach}");
        }
    }
}
