//! Meshes of which one only ever sees the outside.

use glam::{Mat4, Vec3};

use super::{Edges, Inputs, Surface, beyond_near};
use crate::mesh::{EdgeKind, Mesh, Topology};

/// A mesh that is closed, that is wound outward in all its parts, and whose materials are single-sided: a line of sight
/// that comes from without enters it wherever it leaves it, so that what faces away is always behind what doesn't. (Where
/// a mesh passes through itself inside out, a back may come first; what is behind it is seen then, never a hole.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Least and greatest coordinates of all control points on any surface, in object units.
    pub extent: [Vec3; 2],
    /// Whether PN triangles tear it.
    pub has_split_normals: bool,
}

impl Solid {
    /// The mesh as a solid, if it is one.
    pub fn find(mesh: &Mesh, topology: &Topology) -> Option<Self> {
        let single_sided = mesh.materials.iter().all(|material| !material.double_sided);
        if !single_sided || !topology.is_closed_and_oriented() || topology.part_volumes().any(|volume| volume <= 0.0) {
            return None;
        }
        let reach = Vec3::splat(control_point_reach(mesh, topology));
        let bounds = mesh.bounds();
        let has_split_normals = topology.edges.iter().any(|edge| edge.kind == EdgeKind::Split);
        Some(Self { extent: [bounds.min - reach, bounds.max + reach], has_split_normals })
    }

    /// Whether nothing that faces away can be seen under these inputs: nothing tears, and the near plane cuts nothing open.
    pub fn hides_backs(&self, inputs: &Inputs) -> bool {
        let tears = inputs.surface == Surface::Pn && self.has_split_normals;
        inputs.edges == Edges::PerEdge && !tears && is_beyond_near(inputs.view.clip_from_object, self.extent)
    }
}

/// How far control points may be from the triangles that they belong to: an edge's by a third of what the edge rises over
/// a corner's plane, and a patch's centre by half as much again as those are on average.
fn control_point_reach(mesh: &Mesh, topology: &Topology) -> f32 {
    let rise = |side: &crate::mesh::Side| {
        let [a, b] = side.corners.map(|corner| corner as usize);
        let along =
            topology.points[topology.corner_points[b] as usize] - topology.points[topology.corner_points[a] as usize];
        along.dot(mesh.corners[a].normal).abs().max(along.dot(mesh.corners[b].normal).abs())
    };
    topology.sides.iter().map(rise).fold(0.0, f32::max) * 0.5
}

/// Whether a box (its least and greatest coordinates) lies beyond the near plane as a whole, so that nothing in it is cut.
pub fn is_beyond_near(clip_from_object: Mat4, [min, max]: [Vec3; 2]) -> bool {
    (0..8).all(|corner| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
        beyond_near(clip_from_object * Vec3::new(pick(0), pick(1), pick(2)).extend(1.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Progress, Shape};
    use crate::settings::Settings;
    use crate::tessellate::{Limit, LodView};

    fn solid(mesh: &Mesh) -> Option<Solid> {
        Solid::find(mesh, &Topology::build(mesh, &Progress::default()).expect("nobody cancels"))
    }

    #[test]
    fn closed_single_sided_shapes_wound_outward_are_solids() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let closed = !matches!(shape, Shape::Saddle | Shape::Moebius);
            assert_eq!(solid(&mesh).is_some(), closed, "{shape:?}");
            let mut inward = mesh.clone();
            inward.triangles.iter_mut().for_each(|triangle| triangle.reverse());
            assert_eq!(solid(&inward), None, "{shape:?} wound inward");
            let mut double = mesh.clone();
            double.materials[0].double_sided = true;
            assert_eq!(solid(&double), None, "{shape:?} seen from both sides");
        }
    }

    #[test]
    fn a_part_wound_inward_is_enough() {
        let mut mesh = Shape::Icosahedron.build();
        let count = mesh.corners.len() as u32;
        let smaller = mesh.corners.clone().into_iter().map(|c| crate::mesh::Corner { position: c.position * 0.5, ..c });
        mesh.corners.extend(smaller);
        let inner: Vec<_> = mesh.triangles.iter().map(|&[a, b, c]| [a + count, c + count, b + count]).collect();
        assert!(solid(&mesh).is_some());
        mesh.triangles.extend(inner);
        mesh.materials[0].triangles.end = mesh.triangles.len() as u32;
        assert_eq!(solid(&mesh), None, "a hollow ball's inside could be seen through nothing, but that isn't proved");
    }

    #[test]
    fn control_points_stay_within_the_extent() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
            let reach = Vec3::splat(control_point_reach(&mesh, &topology));
            let [min, max] = [mesh.bounds().min - reach, mesh.bounds().max + reach];
            for surface in [Surface::Flat, Surface::Pn, Surface::PnAen] {
                let settings = Settings { surface, ..Settings::default() };
                let inputs = settings.inputs(LodView::new(Mat4::IDENTITY, glam::Vec2::ONE));
                let limit = Limit::new(&mesh, &topology, &inputs);
                for patch in 0..topology.patches.len() as u32 {
                    let net = limit.net(patch);
                    for p in net.corners.iter().chain(&net.edges).chain([&net.center]) {
                        assert!(p.cmpge(min - 1e-6).all() && p.cmple(max + 1e-6).all(), "{shape:?} {surface:?}: {p}");
                    }
                }
            }
        }
    }
}
