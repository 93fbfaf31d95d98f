//! The limit surface of a tessellation, which it converges to as its factors grow, with displacement.

use glam::{DMat2, DVec2, DVec3, Vec3};

use super::Inputs;
use super::control_nets::ControlNets;
use super::mesh_displacement::MeshDisplacement;
use super::{ControlNet, Lod, Surface};
use crate::mesh::{Mesh, Topology};

/// The surface that a tessellation approximates, evaluated in f64 at any point.
pub(crate) struct LimitSurface<'a> {
    nets: ControlNets<'a>,
    displacement: Option<MeshDisplacement<'a>>,
}

impl<'a> LimitSurface<'a> {
    /// Builds the surface of a mesh.
    pub(crate) fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        let nets = ControlNets::new(mesh, topology, inputs);
        Self { displacement: MeshDisplacement::new(&nets, inputs), nets }
    }

    /// Returns a patch's control net, which [`Self::position`] needs.
    pub(crate) fn net(&self, patch: u32) -> ControlNet {
        self.nets.patch(patch)
    }

    /// Returns the point of a patch at weights `u` and `v` (w is the rest of 1), in object units. `net` is the patch's
    /// net.
    ///
    /// Heights are read at the patch's own texture coordinates from mip level 0. So at a seam the sides of an edge may
    /// have different limits.
    pub(crate) fn position(&self, patch: u32, net: &ControlNet, u: f64, v: f64) -> DVec3 {
        let moved =
            self.displacement.as_ref().map(|displacement| displacement.exact_displacement(patch, [u, v, 1.0 - u - v]));
        self.surface(net, u, v) + moved.unwrap_or_default()
    }

    /// Returns whether LOD by error shows a patch as one triangle since its surface is flat, though its points slide: see
    /// `flat_patch.rs`. The distance that counts there is the one to the nearest point.
    pub(crate) fn slides(&self, inputs: &Inputs, patch: u32) -> bool {
        inputs.tessellation.lod == Lod::Error && self.nets.slides(inputs, self.displacement.as_ref(), patch)
    }

    /// Returns the point of a patch that is nearest to `target`, without displacement: by Newton's method, starting from
    /// the weights `u` and `v`. A point that is farther than where it started is never returned.
    pub(crate) fn nearest(&self, net: &ControlNet, u: f64, v: f64, target: DVec3) -> DVec3 {
        const STEP: f64 = 1e-4;
        let (mut best, mut at) = (self.surface(net, u, v), DVec2::new(u, v));
        for _ in 0..12 {
            let point = self.surface(net, at.x, at.y);
            if point.distance(target) < best.distance(target) {
                best = point;
            }
            let along_u = (self.surface(net, at.x + STEP, at.y) - point) / STEP;
            let along_v = (self.surface(net, at.x, at.y + STEP) - point) / STEP;
            let metric = DMat2::from_cols_array(&[
                along_u.dot(along_u),
                along_u.dot(along_v),
                along_u.dot(along_v),
                along_v.dot(along_v),
            ]);
            let aside = target - point;
            let step = metric.inverse() * DVec2::new(along_u.dot(aside), along_v.dot(aside));
            if !step.is_finite() {
                break;
            }
            // Back into the patch.
            at = (at + step).max(DVec2::ZERO);
            at /= (at.x + at.y).max(1.0);
        }
        best
    }

    /// Returns the point without displacement.
    fn surface(&self, net: &ControlNet, u: f64, v: f64) -> DVec3 {
        let weights = [u, v, 1.0 - u - v];
        let [a, b, c] = net.corners.map(Vec3::as_dvec3);
        if self.nets.surface == Surface::Flat {
            return a * weights[0] + b * weights[1] + c * weights[2];
        }
        let [x, y, z] = weights;
        let [ab, ba, bc, cb, ca, ac] = net.edges.map(Vec3::as_dvec3);
        let edge = |a: DVec3, ab: DVec3, ba: DVec3, x: f64, y: f64| a * (x * x * x) + (ab * x + ba * y) * (3.0 * x * y);
        edge(a, ab, ba, x, y)
            + edge(b, bc, cb, y, z)
            + edge(c, ca, ac, z, x)
            + net.center.as_dvec3() * (6.0 * x * y * z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;
    use crate::progress::Progress;
    use crate::settings::Settings;
    use crate::tessellate::{LodView, Tessellation};
    use glam::{Mat4, Vec2};

    /// Returns the x coordinate of the surface at the weights 1/2, 1/3 and 1/6, if the control points have these.
    fn at_a_half_and_a_third(surface: Surface, corners: [f32; 3], edges: [f32; 6], center: f32) -> f64 {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let settings = Settings::from(Tessellation { surface, ..Tessellation::default() });
        let inputs = settings.inputs(LodView::new(Mat4::IDENTITY, Vec2::ONE));
        let at = |x: f32| Vec3::X * x;
        let net = ControlNet { corners: corners.map(at), edges: edges.map(at), center: at(center) };
        LimitSurface::new(&mesh, &topology, &inputs).position(0, &net, 1.0 / 2.0, 1.0 / 3.0).x
    }

    #[test]
    fn positions_are_those_of_the_bernstein_polynomials() {
        // With these control points, each bit of the sum would show a wrong weight.
        let (corners, edges, center) = ([1.0, 2.0, 4.0], [8.0, 16.0, 32.0, 64.0, 128.0, 256.0], 512.0);
        let cubic = at_a_half_and_a_third(Surface::PnAen, corners, edges, center);
        // The ten weights, times 216.
        let corner_sum = 27.0 * 1.0 + 8.0 * 2.0 + 1.0 * 4.0;
        let edge_sum = 54.0 * 8.0 + 36.0 * 16.0 + 12.0 * 32.0 + 6.0 * 64.0 + 9.0 * 128.0 + 27.0 * 256.0;
        let expected = (corner_sum + edge_sum + 36.0 * 512.0) / 216.0;
        assert!((cubic - expected).abs() < 1e-9, "{cubic}, not {expected}");
        let flat = at_a_half_and_a_third(Surface::Flat, corners, edges, center);
        assert!((flat - (1.0 / 2.0 + 2.0 / 3.0 + 4.0 / 6.0)).abs() < 1e-12, "{flat}: a flat surface has corners alone");
    }
}
