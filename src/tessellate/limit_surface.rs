//! The limit surface of a tessellation, which it converges to as its factors grow, with displacement.

use glam::{DVec3, Vec3};

use super::Inputs;
use super::control_nets::ControlNets;
use super::mesh_displacement::MeshDisplacement;
use super::{ControlNet, Surface};
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
