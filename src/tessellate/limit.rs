//! What a tessellation converges to: the surface itself, displaced if it is.

use glam::{DVec3, Vec3};

use super::Inputs;
use super::nets::Nets;
use super::relief::Relief;
use super::{ControlNet, Surface};
use crate::mesh::{Mesh, Topology};

/// The surface that a tessellation stands for, at any place and in double precision.
pub struct Limit<'a> {
    nets: Nets<'a>,
    relief: Option<Relief<'a>>,
}

impl<'a> Limit<'a> {
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        let nets = Nets::new(mesh, topology, inputs);
        Self { relief: Relief::new(&nets, inputs), nets }
    }

    /// A patch's control net, for [`Self::position`].
    pub fn net(&self, patch: u32) -> ControlNet {
        self.nets.patch(patch)
    }

    /// The point at weights `u` and `v` of a patch, whose net this is; w is the rest. Displaced by its own heights at full
    /// detail: at a seam whose sides disagree, they are not the edge's. Object units.
    pub fn position(&self, patch: u32, net: &ControlNet, u: f64, v: f64) -> DVec3 {
        let moved = self.relief.as_ref().map(|relief| relief.displacement(patch, [u, v, 1.0 - u - v]));
        self.surface(net, u, v) + moved.unwrap_or_default()
    }

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
