//! A whole mesh, tessellated on the CPU: what the passes do, in the same order, one patch after another.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::{
    Clip, ControlNet, FIXED_ONE, Lod, LodView, Partitioning, PatchFactors, Surface, center_control_point, domain_point,
    domain_triangle, edge_control_point, edge_position, linear_normal, linear_uv, pack_normal, paper_edge_factor,
    patch_is_clipped, patch_position, point_count, process, round_pow2, straight_control_point, triangle_count,
};
use crate::mesh::{Curves, Mesh, Sharing, Topology};

/// What a tessellation is a function of, besides the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    pub surface: Surface,
    pub factor: f32,
    pub partitioning: Partitioning,
    pub lod: Lod,
    /// Px a segment, for adaptive LOD.
    pub pixels: f32,
    pub clip: Clip,
    pub view: LodView,
}

/// An emitted vertex.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Object units.
    pub position: [f32; 3],
    /// Patch and domain coordinates: see [`pack_key`].
    pub key: [u32; 2],
    /// See [`super::pack_normal`].
    pub normal: u32,
    pub uv: [f32; 2],
}

impl Vertex {
    /// The patch that emitted it.
    pub fn patch(&self) -> u32 {
        self.key[1] >> 2
    }

    /// Its domain point: U and V in 16.16 fixed point.
    pub fn domain(&self) -> [u32; 2] {
        [self.key[0] & 0x1ffff, (self.key[0] >> 17) | ((self.key[1] & 3) << 15)]
    }
}

/// U and V need 17 bits each; the patch gets the other 30. Twin of `pack_key` in `shaders/types.wgsl`.
pub fn pack_key(patch: u32, [u, v]: [u32; 2]) -> [u32; 2] {
    [u | (v << 17), (v >> 15) | (patch << 2)]
}

/// Everything emitted, patch after patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellated {
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// One for each patch.
    pub patch_factors: Vec<PatchFactors>,
}

/// Which sides share a curve under a surface.
pub fn sharing(surface: Surface) -> Sharing {
    match surface {
        Surface::Pn => Sharing::EqualNormals,
        Surface::Flat | Surface::PnAen => Sharing::AllSides,
    }
}

/// Tessellates the mesh. With `edge_factors`, one for each edge, those are used in place of the ones that LOD gives.
pub fn tessellate(mesh: &Mesh, topology: &Topology, inputs: &Inputs, edge_factors: Option<&[f32]>) -> Tessellated {
    let nets = Nets::new(mesh, topology, inputs.surface);
    let own = edge_factors.is_none().then(|| nets.edge_factors(inputs));
    let edge_factors = edge_factors.or(own.as_deref()).unwrap_or_default();
    let mut out = Tessellated::default();
    for patch in 0..topology.patches.len() as u32 {
        let net = nets.patch(patch);
        let mut factors = patch_factors(topology, inputs.partitioning, edge_factors, patch);
        if inputs.clip == Clip::Paper && patch_is_clipped(&inputs.view, &net) {
            factors = PatchFactors::zeroed();
        }
        let corners = topology.patches[patch as usize].corners.map(|corner| &mesh.corners[corner as usize]);
        let base = out.vertices.len() as u32;
        for i in 0..point_count(factors) {
            let uv = domain_point(factors, i);
            out.vertices.push(Vertex {
                position: nets.position(patch, &net, uv).to_array(),
                key: pack_key(patch, uv),
                normal: pack_normal(linear_normal(corners.map(|corner| corner.normal), uv[0], uv[1])),
                uv: linear_uv(corners.map(|corner| corner.uv), uv[0], uv[1]).to_array(),
            });
        }
        out.triangles.extend((0..triangle_count(factors)).map(|t| domain_triangle(factors, t).map(|i| base + i)));
        out.patch_factors.push(factors);
    }
    out
}

/// Vertices and triangles that [`tessellate`] would emit, clipping aside.
pub fn totals(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> (u64, u64) {
    let edge_factors = edge_factors(mesh, topology, inputs);
    let counts = (0..topology.patches.len() as u32).map(|patch| {
        let factors = patch_factors(topology, inputs.partitioning, &edge_factors, patch);
        (u64::from(point_count(factors)), u64::from(triangle_count(factors)))
    });
    counts.fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1))
}

/// One factor for each edge, as LOD gives them.
pub fn edge_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<f32> {
    Nets::new(mesh, topology, inputs.surface).edge_factors(inputs)
}

/// Factor i belongs to the edge opposite corner i: side i + 1. Inside: the largest of the three.
fn patch_factors(topology: &Topology, partitioning: Partitioning, edge_factors: &[f32], patch: u32) -> PatchFactors {
    let sides = topology.patches[patch as usize].sides;
    let edges = [1, 2, 0].map(|k: usize| edge_factors[topology.sides[sides[k] as usize].edge as usize]);
    process(partitioning, edges, edges[0].max(edges[1]).max(edges[2]))
}

/// Control nets of a mesh: two control points a curve, one a patch.
struct Nets<'a> {
    topology: &'a Topology,
    surface: Surface,
    curves: Curves,
    curve_nets: Vec<[Vec3; 2]>,
}

impl<'a> Nets<'a> {
    fn new(mesh: &Mesh, topology: &'a Topology, surface: Surface) -> Self {
        let curves = Curves::build(mesh, topology, sharing(surface));
        let net = |curve: &crate::mesh::Curve| {
            let [a, b] = curve.points.map(|p| topology.points[p as usize]);
            if surface == Surface::Flat {
                return [straight_control_point(a, b), straight_control_point(b, a)];
            }
            let sides = &curves.sides[curve.first_side as usize..][..curve.side_count as usize];
            let (mut ab, mut ba) = (Vec3::ZERO, Vec3::ZERO);
            for side in sides {
                let [at_a, at_b] = side.map(|corner| mesh.corners[corner as usize].normal);
                ab += edge_control_point(a, b, at_a);
                ba += edge_control_point(b, a, at_b);
            }
            let share = 1.0 / curve.side_count as f32;
            [ab * share, ba * share]
        };
        let curve_nets = curves.curves.iter().map(net).collect();
        Self { topology, surface, curves, curve_nets }
    }

    /// One factor an edge: the largest that any of its curves asks for.
    fn edge_factors(&self, inputs: &Inputs) -> Vec<f32> {
        let factor = |curve: usize| {
            let [a, b] = self.curves.curves[curve].points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve];
            paper_edge_factor(&inputs.view, inputs.pixels, [a, ab, ba, b])
        };
        let edge = |curves: &[u32]| {
            let factor = match inputs.lod {
                Lod::Uniform => inputs.factor,
                Lod::Paper => (curves[0]..curves[1]).map(|curve| factor(curve as usize)).fold(1.0, f32::max),
            };
            if inputs.partitioning == Partitioning::Pow2 { round_pow2(factor) } else { factor }
        };
        self.curves.edge_curves.windows(2).map(edge).collect()
    }

    /// The curve of a patch's side, and whether the side runs against it.
    fn curve(&self, patch: u32, side: usize) -> (usize, bool) {
        let side = self.topology.patches[patch as usize].sides[side] as usize;
        (self.curves.side_curves[side] as usize, self.topology.sides[side].reversed)
    }

    fn corner(&self, patch: u32, k: usize) -> Vec3 {
        let corner = self.topology.patches[patch as usize].corners[k];
        self.topology.points[self.topology.corner_points[corner as usize] as usize]
    }

    fn patch(&self, patch: u32) -> ControlNet {
        let corners = [0, 1, 2].map(|k| self.corner(patch, k));
        let [[b210, b120], [b021, b012], [b102, b201]] = [0, 1, 2].map(|k| {
            let (curve, reversed) = self.curve(patch, k);
            let [ab, ba] = self.curve_nets[curve];
            if reversed { [ba, ab] } else { [ab, ba] }
        });
        let edges = [b210, b120, b021, b012, b102, b201];
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    fn position(&self, patch: u32, net: &ControlNet, [u, v]: [u32; 2]) -> Vec3 {
        match place(u, v) {
            Some((side, t)) => self.rim_position(patch, side, t),
            None => patch_position(self.surface, net, u, v),
        }
    }

    /// A point on a patch's rim, computed in the edge's own direction.
    fn rim_position(&self, patch: u32, side: usize, t: u32) -> Vec3 {
        let (start, end) = (self.corner(patch, side), self.corner(patch, (side + 1) % 3));
        if t == 0 {
            return start;
        }
        if t == FIXED_ONE {
            return end;
        }
        let (curve, reversed) = self.curve(patch, side);
        let [ab, ba] = self.curve_nets[curve];
        let (a, b, t) = if reversed { (end, start, FIXED_ONE - t) } else { (start, end, t) };
        edge_position(self.surface, a, ab, ba, b, t)
    }
}

/// Where on the patch's rim (u, v, w) lies: the side, and the weight of the side's far end; `None` inside.
fn place(u: u32, v: u32) -> Option<(usize, u32)> {
    let w = FIXED_ONE - u - v;
    if w == 0 {
        Some((0, v))
    } else if u == 0 {
        Some((1, w))
    } else if v == 0 {
        Some((2, u))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_gives_back_what_was_packed() {
        for patch in [0, 1, (1 << 30) - 1] {
            for uv in [[0, 0], [65536, 0], [0, 65536], [32767, 32768], [21845, 21845]] {
                let vertex = Vertex { key: pack_key(patch, uv), ..Zeroable::zeroed() };
                assert_eq!((vertex.patch(), vertex.domain()), (patch, uv));
            }
        }
    }
}
