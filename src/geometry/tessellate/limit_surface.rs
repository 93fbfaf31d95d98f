//! The limit surface of a tessellation, which it converges to as its factors grow, with displacement.

use glam::{DMat2, DVec2, DVec3, Vec3};

use super::mesh_factors::MeshLod;
use super::piece_error::{SeenPatch, may_slide};
use super::{ControlNet, Inputs, Tessellation};
use crate::mesh::{Mesh, Topology};

/// The surface that a tessellation approximates, evaluated in f64 at any point.
pub struct LimitSurface<'a>(MeshLod<'a>);

impl<'a> LimitSurface<'a> {
    /// Builds the surface of a mesh.
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        Self(MeshLod::new(mesh, topology, inputs))
    }

    /// Returns a patch's control net, which [`Self::position`] needs.
    pub fn net(&self, patch: u32) -> ControlNet {
        self.0.nets.patch(patch)
    }

    /// Returns how many times as fine as others LOD makes a patch.
    pub fn detail(&self, patch: u32) -> f32 {
        self.0.nets.topology.detail_of(self.0.nets.mesh, patch)
    }

    /// Returns the point of a patch at weights `u` and `v` (w is the rest of 1), in object units. `net` is the patch's
    /// net.
    ///
    /// Heights are read at the patch's own texture coordinates from mip level 0. So at a seam the sides of an edge may
    /// have different limits.
    pub fn position(&self, patch: u32, net: &ControlNet, u: f64, v: f64) -> DVec3 {
        let moved = self.0.displacement.as_ref().map(|own| own.exact_displacement(patch, [u, v, 1.0 - u - v]));
        self.surface(net, u, v) + moved.unwrap_or_default()
    }

    /// Returns a patch as it is seen.
    pub fn seen_patch(&self, patch: u32) -> SeenPatch {
        self.0.seen_patch(patch)
    }

    /// Returns whether LOD by error allows points of a patch to slide along its surface, which is flat: see `flat_patch.rs`.
    /// The distance that counts there is the one to the nearest point.
    pub fn slides(&self, patch: u32) -> bool {
        let Tessellation { lod, tolerance, .. } = self.0.inputs.tessellation;
        lod.is_by_error() && may_slide(&self.seen_patch(patch), tolerance)
    }

    /// Returns the point of a patch that is nearest to `target` as `on_screen` shows both, without displacement: by Newton's
    /// method, starting from the weights `u` and `v`. A point that is farther than where it started is never returned.
    pub fn nearest(
        &self,
        net: &ControlNet,
        [u, v]: [f64; 2],
        target: DVec3,
        on_screen: impl Fn(DVec3) -> DVec2,
    ) -> DVec3 {
        let seen = |point: DVec3| on_screen(point).extend(0.0);
        let found = nearest_weights(DVec2::new(u, v), seen(target), |at| seen(self.surface(net, at.x, at.y)));
        self.surface(net, found.x, found.y)
    }

    /// Returns the weights of corners 0 and 1 of a patch's point that is nearest to `target`, and its distance in object units:
    /// as [`Self::nearest`], but in space, and with displacement.
    pub fn nearest_in_space(&self, patch: u32, net: &ControlNet, [u, v]: [f64; 2], target: DVec3) -> ([f64; 2], f64) {
        let point = |at: DVec2| self.position(patch, net, at.x, at.y);
        let found = nearest_weights(DVec2::new(u, v), target, point);
        (found.to_array(), point(found).distance(target))
    }

    /// Returns the point without displacement.
    fn surface(&self, net: &ControlNet, u: f64, v: f64) -> DVec3 {
        let weights = [u, v, 1.0 - u - v];
        let [a, b, c] = net.corners.map(Vec3::as_dvec3);
        if self.0.nets.surface.is_flat() {
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

/// Returns the weights of corners 0 and 1 of the point that is nearest to `target`: by Newton's method, starting from `start`.
/// `point` gives the point at some weights.
fn nearest_weights(start: DVec2, target: DVec3, point: impl Fn(DVec2) -> DVec3) -> DVec2 {
    const STEP: f64 = 1e-4;
    /// A step that is shorter no longer moves the point.
    const CONVERGED: f64 = 1e-14;
    let (mut best, mut least, mut at) = (start, point(start).distance(target), start);
    for _ in 0..20 {
        let place = point(at);
        let aside = target - place;
        if aside.length() < least {
            (best, least) = (at, aside.length());
        }
        let along = [DVec2::X, DVec2::Y].map(|axis| (point(at + axis * STEP) - place) / STEP);
        let next = next_weights(at, along, aside);
        if !next.is_finite() || next.distance(at) < CONVERGED {
            break;
        }
        at = next;
    }
    best
}

/// Returns the weights of corners 0 and 1 after a step of Newton's method that doesn't leave the patch. `along` says how the
/// point changes with each of the two weights, and `aside` what is missing. On a side that the step would lead out of, the step
/// goes along the side.
fn next_weights(at: DVec2, along: [DVec3; 2], aside: DVec3) -> DVec2 {
    let [u, v] = along;
    let metric = DMat2::from_cols(DVec2::new(u.dot(u), u.dot(v)), DVec2::new(v.dot(u), v.dot(v)));
    // A patch that is seen from the side has no inverse without this.
    let damped = metric + DMat2::from_diagonal(DVec2::splat(1e-9 * (metric.x_axis.x + metric.y_axis.y)));
    let step = damped.inverse() * DVec2::new(u.dot(aside), v.dot(aside));
    let (share, side) = share_within(at, step);
    if share > 1e-9 {
        return at + step * share;
    }
    let side = [DVec2::Y, DVec2::X, DVec2::new(1.0, -1.0)][side];
    let moved = u * side.x + v * side.y;
    let step = side * (moved.dot(aside) / moved.length_squared());
    at + step * share_within(at, step).0
}

/// Returns the share of a step, 1 at most, that leads no farther than to a side of the patch, and that side: the number of the
/// corner whose weight is 0 there.
fn share_within(at: DVec2, step: DVec2) -> (f64, usize) {
    /// A weight that is less is rounding: the step would shrink to nothing before a side that it is on already.
    const ON_SIDE: f64 = 1e-12;
    let (weights, changes) = ([at.x, at.y, 1.0 - at.x - at.y], [step.x, step.y, -step.x - step.y]);
    let weight = |k: usize| if weights[k] > ON_SIDE { weights[k] } else { 0.0 };
    let share = |k: usize| if changes[k] < 0.0 { weight(k) / -changes[k] } else { f64::INFINITY };
    let side = (0..3).min_by(|&a, &b| share(a).total_cmp(&share(b))).unwrap_or(0);
    (share(side).min(1.0), side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;
    use crate::progress::Progress;
    use crate::tessellate::{LodView, Surface, Tessellation};
    use glam::{Mat4, Vec2};

    /// Returns the x coordinate of the surface at the weights 1/2, 1/3 and 1/6, if the control points have these.
    fn at_a_half_and_a_third(surface: Surface, corners: [f32; 3], edges: [f32; 6], center: f32) -> f64 {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let tessellation = Tessellation { surface, ..Tessellation::default() };
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
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

    #[test]
    fn the_nearest_point_is_found_within_and_on_the_border() {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let inputs = Inputs::new(&Tessellation::default(), LodView::new(Mat4::IDENTITY, Vec2::ONE));
        let limit = LimitSurface::new(&mesh, &topology, &inputs);
        // Flat, with one edge bent outwards.
        let at = |x: f32, y: f32| Vec3::new(x, y, 0.5);
        let corners = [at(0.0, 0.0), at(3.0, 0.0), at(0.0, 3.0)];
        let edges = [at(1.0, -0.8), at(2.0, -0.5), at(2.0, 1.0), at(1.0, 2.0), at(0.0, 2.0), at(0.0, 1.0)];
        let net = ControlNet { corners, edges, center: at(1.0, 0.8) };
        let on_screen = |p: DVec3| p.truncate();
        let mut random = fastrand::Rng::with_seed(1);
        let weights = || (0..=60).flat_map(|i| (0..=60 - i).map(move |j| [f64::from(i) / 60.0, f64::from(j) / 60.0]));
        let grid: Vec<DVec3> = weights().map(|[u, v]| limit.surface(&net, u, v)).collect();
        for _ in 0..300 {
            let start = weights().nth(random.usize(0..grid.len())).expect("as many as points");
            let aside = DVec3::new(random.f64() - 0.5, random.f64() - 0.5, 0.0);
            let target = limit.surface(&net, start[0], start[1]) + aside * 0.6;
            let sampled = grid.iter().map(|p| p.distance(target)).fold(f64::INFINITY, f64::min);
            let nearest = limit.nearest(&net, start, target, on_screen).distance(target);
            assert!(nearest <= sampled + 1e-3 || nearest < 1e-6, "{target}: {nearest}, {sampled} on a grid");
        }
    }
}
