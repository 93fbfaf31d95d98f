//! The control nets of a whole mesh on the CPU: what `shaders/pass_nets.wgsl` computes.

use glam::Vec3;

use super::{
    ControlNet, DistinctNormals, Edges, Inputs, Normals, Surface, Tessellation, add_normal, center_control_point,
    crease_control_point, sharing, side_control_points,
};
use crate::mesh::{Curves, Mesh, Topology};

/// Returns the control net of one patch of a mesh, without those of the others.
pub fn patch_net(mesh: &Mesh, topology: &Topology, inputs: &Inputs, patch: u32) -> ControlNet {
    let mut edges = topology.patches[patch as usize].sides.map(|side| topology.sides[side as usize].edge);
    edges.sort_unstable();
    ControlNets::from_edges(mesh, topology, inputs, edges.into_iter()).patch(patch)
}

/// The control nets of a mesh: two control points for each curve, and one for each patch, which is computed when
/// needed.
pub(super) struct ControlNets<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    /// The surface as which all patches are evaluated.
    pub(super) surface: Surface,
    pub(super) normals: Normals,
    pub(super) edges: Edges,
    pub(super) curves: Curves,
    /// For each curve, the control points near its start and near its end, in object units.
    pub(super) curve_nets: Vec<[Vec3; 2]>,
}

impl<'a> ControlNets<'a> {
    /// Computes the control points of all curves.
    pub(super) fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        Self::from_edges(mesh, topology, inputs, 0..topology.edges.len() as u32)
    }

    /// Computes the control points of the curves of some edges alone, in ascending order.
    pub(super) fn from_edges(
        mesh: &'a Mesh,
        topology: &'a Topology,
        inputs: &Inputs,
        some: impl Iterator<Item = u32>,
    ) -> Self {
        let Tessellation { surface, alpha, normals, edges, .. } = inputs.tessellation;
        let mut curves = Curves::build_some(mesh, topology, (sharing(surface, edges), inputs.styles()), some);
        if inputs.tessellation.partitioning.has_one_factor() {
            curves.styles.iter_mut().for_each(|style| style.detail = 1.0);
        }
        let net = |(index, curve): (usize, &crate::mesh::Curve)| {
            let surface = curves.styles.get(index).map_or(surface, |style| style.surface);
            let [a, b] = curve.points.map(|p| topology.points[p as usize]);
            let sides = &curves.sides[curve.first_side as usize..][..curve.side_count as usize];
            let (mut ab, mut ba) = (Vec3::ZERO, Vec3::ZERO);
            let (mut around_a, mut around_b) = (DistinctNormals::default(), DistinctNormals::default());
            for side in sides {
                let [at_a, at_b] = side.map(|corner| mesh.corners[corner as usize].normal);
                let proposed = side_control_points(surface, alpha, a, b, at_a, at_b);
                ab += proposed[0];
                ba += proposed[1];
                around_a = add_normal(around_a, at_a);
                around_b = add_normal(around_b, at_b);
            }
            let share = 1.0 / curve.side_count as f32;
            let (ab, ba) = (ab * share, ba * share);
            if surface.has_creases() {
                return [crease_control_point(a, b, around_a, ab), crease_control_point(b, a, around_b, ba)];
            }
            [ab, ba]
        };
        let curve_nets = curves.curves.iter().enumerate().map(net).collect();
        Self { mesh, topology, surface: inputs.evaluated_surface(mesh), normals, edges, curves, curve_nets }
    }

    /// Returns the curve of a patch's side, and whether the side runs in the opposite direction.
    pub(super) fn curve(&self, patch: u32, side: usize) -> (usize, bool) {
        let side = self.topology.patches[patch as usize].sides[side];
        (self.curves.side_curves[side as usize] as usize, self.curves.runs_against(self.topology, side))
    }

    /// Returns the position of a patch's corner, in object units.
    pub(super) fn corner(&self, patch: u32, k: usize) -> Vec3 {
        let corner = self.topology.patch_corners(patch)[k];
        self.topology.points[self.topology.corner_points[corner as usize] as usize]
    }

    /// Returns a patch's control net.
    pub(super) fn patch(&self, patch: u32) -> ControlNet {
        let corners = [0, 1, 2].map(|k| self.corner(patch, k));
        let [[b210, b120], [b021, b012], [b102, b201]] = [0, 1, 2].map(|k| {
            let (curve, reversed) = self.curve(patch, k);
            let [ab, ba] = self.curve_nets[curve];
            if reversed { [ba, ab] } else { [ab, ba] }
        });
        let edges = [b210, b120, b021, b012, b102, b201];
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }
}
