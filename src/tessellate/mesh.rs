//! A whole mesh, tessellated on the CPU: what the passes do, in the same order, one patch after another.

use bytemuck::Zeroable;
use glam::{Vec2, Vec3};

use super::nets::Nets;
use super::relief::{Relief, reach};
use super::vertex::{Vertex, pack_key};
use super::{
    ControlNet, Edges, FIXED_ONE, HullFactors, Inputs, LodView, Normals, PatchFactors, SEEN, Solid, corner_weights,
    domain_plan, domain_point, domain_triangle, edge_normal, edge_position, edge_uv, linear_normal, linear_uv,
    pack_normal, patch_position, place, point_count, quadratic_edge_normal, quadratic_normal, surface_normal,
    triangle_count, unseen,
};
use crate::mesh::{Mesh, Topology};

/// Everything emitted, patch after patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellated {
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// One for each patch.
    pub patch_factors: Vec<PatchFactors>,
    /// As LOD gave them: one for each edge, or as published one for each side. None where patches' were given.
    pub edge_factors: Vec<f32>,
}

impl Tessellated {
    /// Takes vertices, and triangles of indices into these.
    pub fn append(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let base = self.vertices.len() as u32;
        self.vertices.extend_from_slice(vertices);
        self.triangles.extend(triangles.iter().map(|triangle| triangle.map(|index| base + index)));
    }
}

/// Tessellates the mesh. With `factors`, those are used in place of the ones that LOD gives: one for each edge, or as
/// published one for each curve (see [`crate::mesh::Curves::factor`]).
pub fn tessellate(mesh: &Mesh, topology: &Topology, inputs: &Inputs, factors: Option<&[f32]>) -> Tessellated {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs);
    let edge_factors = factors.map_or_else(|| nets.edge_factors(inputs, relief.as_ref()), <[f32]>::to_vec);
    let culls_back = culls_back(mesh, topology, inputs);
    let relief = relief.map(|relief| relief.with_levels(&edge_factors));
    let relief = relief.as_ref();
    let written = |patch, net: &ControlNet| nets.hull_factors(inputs, relief, &edge_factors, patch, net);
    let out = nets.emit(inputs, relief, culls_back, written);
    Tessellated { edge_factors, ..out }
}

/// The same inputs, with a view that knows how far the mesh is displaced.
fn seen_with_reach(mesh: &Mesh, inputs: &Inputs) -> Inputs {
    Inputs { view: LodView { reach: reach(mesh, inputs), ..inputs.view }, ..*inputs }
}

/// Whether patches that face away are left out.
fn culls_back(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> bool {
    inputs.tessellation.cull_back_faces && Solid::find(mesh, topology).is_some_and(|solid| solid.hides_backs(inputs))
}

/// Tessellates the mesh with what a hull shader wrote, one for each patch, in place of what LOD gives. Backs stay: given
/// factors may tear any edge.
pub fn tessellate_given(mesh: &Mesh, topology: &Topology, inputs: &Inputs, given: &[HullFactors]) -> Tessellated {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs).map(|relief| {
        let factors = relief.given_factors(inputs.tessellation.convention, given);
        relief.with_levels(&factors)
    });
    let written = |patch: u32, _: &ControlNet| given[patch as usize].rounded(inputs.tessellation.partitioning);
    nets.emit(inputs, relief.as_ref(), false, written)
}

/// What the hull shader writes under LOD, one for each patch; zeros for those that are left out.
pub fn hull_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<HullFactors> {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs);
    let edge_factors = nets.edge_factors(inputs, relief.as_ref());
    let culls_back = culls_back(mesh, topology, inputs);
    let written = |patch| {
        let net = nets.patch(patch);
        match unseen(inputs.tessellation.clip, culls_back, &inputs.view, &net) {
            SEEN => nets.hull_factors(inputs, relief.as_ref(), &edge_factors, patch, &net),
            _ => HullFactors::default(),
        }
    };
    (0..topology.patches.len() as u32).map(written).collect()
}

/// Vertices and triangles that [`tessellate`] would emit, clipping aside.
pub fn totals(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> (u64, u64) {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs);
    let edge_factors = nets.edge_factors(inputs, relief.as_ref());
    let patches = 0..topology.patches.len() as u32;
    let written =
        patches.map(|patch| nets.hull_factors(inputs, relief.as_ref(), &edge_factors, patch, &nets.patch(patch)));
    sums(written.map(|written| written.process(inputs.tessellation.partitioning)))
}

/// Vertices and triangles that [`tessellate_given`] would emit, clipping aside.
pub fn given_totals(given: &[HullFactors], inputs: &Inputs) -> (u64, u64) {
    sums(
        given
            .iter()
            .map(|written| written.rounded(inputs.tessellation.partitioning).process(inputs.tessellation.partitioning)),
    )
}

fn sums(patches: impl Iterator<Item = PatchFactors>) -> (u64, u64) {
    let counts = patches.map(|factors| (u64::from(point_count(factors)), u64::from(triangle_count(factors))));
    counts.fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1))
}

/// The factors that LOD gives: one for each edge, or as published one for each curve.
pub fn edge_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<f32> {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    nets.edge_factors(inputs, Relief::new(&nets, inputs).as_ref())
}

impl Nets<'_> {
    /// Every patch's output, given what the hull shader writes for it.
    fn emit(
        &self,
        inputs: &Inputs,
        relief: Option<&Relief>,
        culls_back: bool,
        written: impl Fn(u32, &ControlNet) -> HullFactors,
    ) -> Tessellated {
        let mut out = Tessellated::default();
        for patch in 0..self.topology.patches.len() as u32 {
            let net = self.patch(patch);
            let factors = match unseen(inputs.tessellation.clip, culls_back, &inputs.view, &net) {
                SEEN => written(patch, &net).process(inputs.tessellation.partitioning),
                why => PatchFactors { inside: why, ..PatchFactors::zeroed() },
            };
            let plan = domain_plan(factors);
            let vertex = |i| {
                let uv = corner_weights(inputs.tessellation.convention, domain_point(&plan, i));
                let own = self.vertex(patch, &net, uv);
                relief.map_or(own, |relief| relief.displaced(self, factors, own))
            };
            let base = out.vertices.len() as u32;
            out.vertices.extend((0..point_count(factors)).map(vertex));
            let triangles = (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t));
            out.triangles.extend(triangles.map(|corners| corners.map(|i| base + i)));
            out.patch_factors.push(factors);
        }
        out
    }

    fn vertex(&self, patch: u32, net: &ControlNet, uv: [u32; 2]) -> Vertex {
        let [u, v] = uv;
        let (position, normal, texture_uv) = match place(u, v) {
            Some((side, t)) if self.edges == Edges::PerEdge => self.rim(patch, side, t),
            _ => self.inside(patch, net, u, v),
        };
        let normal = match self.normals {
            // Every patch's own, also on its rim, where its neighbours' differ.
            Normals::Surface => surface_normal(self.surface, net, u, v, normal),
            Normals::Linear | Normals::Quadratic => normal,
        };
        Vertex {
            position: position.to_array(),
            key: pack_key(patch, uv),
            normal: pack_normal(normal),
            uv: texture_uv.to_array(),
        }
    }

    /// Position, normal and uv as the patch alone has them.
    fn inside(&self, patch: u32, net: &ControlNet, u: u32, v: u32) -> (Vec3, Vec3, Vec2) {
        let corners = self.topology.patch_corners(patch).map(|c| self.mesh.corners[c as usize]);
        let normals = corners.map(|corner| corner.normal);
        let normal = match self.normals {
            Normals::Quadratic => quadratic_normal(net.corners, normals, u, v),
            Normals::Linear | Normals::Surface => linear_normal(normals, u, v),
        };
        (patch_position(self.surface, net, u, v), normal, linear_uv(corners.map(|corner| corner.uv), u, v))
    }

    /// Position, normal and uv of a point on a patch's rim, computed in the edge's own direction.
    fn rim(&self, patch: u32, side: usize, t: u32) -> (Vec3, Vec3, Vec2) {
        let (curve, reversed) = self.curve(patch, side);
        let corners = self.topology.patch_corners(patch);
        let (start, end) = (side, (side + 1) % 3);
        let (from, to, t) = if reversed { (end, start, FIXED_ONE - t) } else { (start, end, t) };
        let (a, b) = (self.corner(patch, from), self.corner(patch, to));
        let [ab, ba] = self.curve_nets[curve];
        let [at_a, at_b] = [from, to].map(|k| self.mesh.corners[corners[k] as usize]);
        let position = match t {
            0 => a,
            FIXED_ONE => b,
            t => edge_position(self.surface, a, ab, ba, b, t),
        };
        let normal = match self.normals {
            Normals::Quadratic => quadratic_edge_normal(a, b, at_a.normal, at_b.normal, t),
            Normals::Linear | Normals::Surface => edge_normal(at_a.normal, at_b.normal, t),
        };
        (position, normal, edge_uv(at_a.uv, at_b.uv, t))
    }
}
