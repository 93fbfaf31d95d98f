//! Tessellates a whole mesh on the CPU, patch after patch, in the same order as the GPU's passes.

use bytemuck::Zeroable;
use glam::{Vec2, Vec3};

use super::control_nets::ControlNets;
use super::mesh_displacement::displacement_reach;
use super::mesh_factors::MeshLod;
use super::vertex::{Vertex, pack_key};
use super::{
    Clip, ControlNet, Edges, FIXED_ONE, HullFactors, Inputs, NOT_CULLED, Normals, PatchFactors, Solid, Tessellation,
    corner_weights, cull_reason, edge_normal, edge_position, edge_uv, linear_normal, linear_uv, outline_place,
    pack_normal, patch_position, point_count, quadratic_edge_normal, quadratic_normal, surface_normal, triangle_count,
};
use crate::mesh::{Mesh, Topology};

/// The output of a tessellation, patch after patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellated {
    /// The vertices of the first patch, then those of the next.
    pub vertices: Vec<Vertex>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// The factors of each patch.
    pub patch_factors: Vec<PatchFactors>,
    /// The factors that LOD gave: one for each edge, or with edges as published one for each side. Empty if the
    /// patches' factors were given.
    pub edge_factors: Vec<f32>,
}

impl Tessellated {
    /// Appends vertices, and triangles whose indices refer to these vertices.
    pub fn append(&mut self, vertices: &[Vertex], triangles: &[[u32; 3]]) {
        let base = self.vertices.len() as u32;
        self.vertices.extend_from_slice(vertices);
        self.triangles.extend(triangles.iter().map(|triangle| triangle.map(|index| base + index)));
    }
}

/// Tessellates the mesh. `factors` replace the ones that LOD gives to edges: one for each, or with edges as published one
/// for each curve.
///
/// # Panics
/// If `factors` are fewer than that.
pub fn tessellate(mesh: &Mesh, topology: &Topology, inputs: &Inputs, factors: Option<&[f32]>) -> Tessellated {
    let mut lod = MeshLod::new(mesh, topology, &seen_with_reach(mesh, inputs));
    let made = factors.map_or_else(|| lod.mesh_factors(), |edges| lod.factors_beside(edges));
    let by_error = inputs.tessellation.lod.is_by_error();
    lod.displacement = lod.displacement.map(|displacement| displacement.with_levels(&made.edges, by_error));
    let out = lod.emit(culls_back(mesh, topology, &lod.inputs), |patch| lod.hull_factors(&made, patch));
    Tessellated { edge_factors: made.edges, ..out }
}

/// Returns the inputs with the view's `reach` set to how far the mesh is displaced.
pub(super) fn seen_with_reach(mesh: &Mesh, inputs: &Inputs) -> Inputs {
    Inputs { view: inputs.view.with_reach(displacement_reach(mesh, inputs)), ..*inputs }
}

/// Returns whether patches that show only their backs are left out.
fn culls_back(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> bool {
    inputs.tessellation.cull_back_faces
        && Solid::find(mesh, topology).is_some_and(|solid| solid.hides_backs(mesh, topology, inputs))
}

/// Tessellates the mesh with the factors that a hull shader wrote for each patch, instead of LOD's. Patches that show
/// only their backs are drawn, since given factors may crack any edge.
pub fn tessellate_given(mesh: &Mesh, topology: &Topology, inputs: &Inputs, given: &[HullFactors]) -> Tessellated {
    let mut lod = MeshLod::new(mesh, topology, &seen_with_reach(mesh, inputs));
    lod.displacement = lod.displacement.map(|displacement| {
        let factors = displacement.given_factors(inputs.tessellation.convention, given);
        displacement.with_levels(&factors, false)
    });
    lod.emit(false, |patch| given[patch as usize].rounded(inputs.tessellation.partitioning))
}

/// Returns the factors that the hull shader writes for each patch under LOD; zeros for patches that are left out.
pub fn hull_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<HullFactors> {
    let lod = MeshLod::new(mesh, topology, &seen_with_reach(mesh, inputs));
    let culls_back = culls_back(mesh, topology, &lod.inputs);
    let factors = lod.mesh_factors();
    let written = |patch| {
        let net = lod.nets.patch(patch);
        match cull_reason(inputs.tessellation.clip, culls_back, &lod.inputs.view, &net) {
            NOT_CULLED => lod.hull_factors(&factors, patch),
            _ => HullFactors::default(),
        }
    };
    (0..topology.patches.len() as u32).map(written).collect()
}

/// Returns the numbers of vertices and triangles that [`tessellate`] would emit without clipping and culling.
pub fn totals(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> (u64, u64) {
    let tessellation = Tessellation { clip: Clip::Off, cull_back_faces: false, ..inputs.tessellation };
    given_totals(&hull_factors(mesh, topology, &Inputs { tessellation, ..*inputs }), inputs)
}

/// Returns the numbers of vertices and triangles that [`tessellate_given`] would emit without clipping.
pub fn given_totals(given: &[HullFactors], inputs: &Inputs) -> (u64, u64) {
    let partitioning = inputs.tessellation.partitioning;
    let patches = given.iter().map(|written| written.rounded(partitioning).process(partitioning));
    let counts = patches.map(|factors| (u64::from(point_count(factors)), u64::from(triangle_count(factors))));
    counts.fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1))
}

/// Returns the factors that LOD gives: one for each edge, or with edges as published one for each curve.
pub fn edge_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<f32> {
    MeshLod::new(mesh, topology, &seen_with_reach(mesh, inputs)).mesh_factors().edges
}

impl MeshLod<'_> {
    /// Emits all patches. `written` returns the factors that the hull shader writes for a patch.
    fn emit(&self, culls_back: bool, written: impl Fn(u32) -> HullFactors) -> Tessellated {
        let Self { nets, inputs: Inputs { tessellation, view }, displacement } = self;
        let mut out = Tessellated::default();
        for patch in 0..nets.topology.patches.len() as u32 {
            let net = nets.patch(patch);
            let factors = match cull_reason(tessellation.clip, culls_back, view, &net) {
                NOT_CULLED => written(patch).process(tessellation.partitioning),
                why => PatchFactors { inside: why, ..PatchFactors::zeroed() },
            };
            let vertex = |point| {
                let own = nets.vertex(patch, &net, corner_weights(tessellation.convention, point));
                displacement.as_ref().map_or(own, |displacement| displacement.displaced(nets, factors, own))
            };
            let vertices: Vec<Vertex> = factors.points().into_iter().map(vertex).collect();
            out.append(&vertices, &factors.triangles());
            out.patch_factors.push(factors);
        }
        out
    }
}

impl ControlNets<'_> {
    /// Returns the vertex of a patch at the weights `uv` of corners 0 and 1, before displacement.
    fn vertex(&self, patch: u32, net: &ControlNet, uv: [u32; 2]) -> Vertex {
        let [u, v] = uv;
        let (position, normal, texture_uv) = match outline_place(u, v) {
            Some((side, t)) if self.edges == Edges::PerEdge => self.on_outline(patch, side, t),
            _ => self.inside(patch, net, u, v),
        };
        let normal = match self.normals {
            // The patch's own normal, on the outline too, where neighbouring patches have other normals.
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

    /// Returns the position, normal and texture coordinate that the patch has by itself.
    fn inside(&self, patch: u32, net: &ControlNet, u: u32, v: u32) -> (Vec3, Vec3, Vec2) {
        let corners = self.topology.patch_corners(patch).map(|c| self.mesh.corners[c as usize]);
        let normals = corners.map(|corner| corner.normal);
        let normal = match self.normals {
            Normals::Quadratic => quadratic_normal(net.corners, normals, u, v),
            Normals::Linear | Normals::Surface => linear_normal(normals, u, v),
        };
        (patch_position(self.surface, net, u, v), normal, linear_uv(corners.map(|corner| corner.uv), u, v))
    }

    /// Returns the position, normal and texture coordinate of a point on a patch's outline, computed in the edge's own
    /// direction, so that all its sides get the same.
    fn on_outline(&self, patch: u32, side: usize, t: u32) -> (Vec3, Vec3, Vec2) {
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::{HeightMap, Heights, Shape};
    use crate::progress::Progress;
    use crate::tessellate::{Convention, Displacement, Lod, LodView, Partitioning, Tessellation};
    use glam::{Mat4, Vec2};

    /// Returns a torus with a relief, and inputs under which its edges have different factors.
    fn torus(convention: Convention, partitioning: Partitioning) -> (Mesh, Topology, Inputs) {
        let mut mesh = Shape::Torus.build();
        let heights = (0..4096).map(|i| ((i % 64) * (i / 64) % 7) as f32 / 6.0).collect();
        mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, HeightMap::new([64, 64], heights))));
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let tessellation = Tessellation {
            lod: Lod::EdgeLength,
            displacement: Displacement::On,
            convention,
            partitioning,
            ..Tessellation::default()
        };
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::splat(100.0)));
        (mesh, topology, inputs)
    }

    #[test]
    fn totals_are_what_is_emitted() {
        for partitioning in Partitioning::ALL {
            let (mesh, topology, inputs) = torus(Convention::D3d11, partitioning);
            let out = tessellate(&mesh, &topology, &inputs, None);
            let emitted = (out.vertices.len() as u64, out.triangles.len() as u64);
            assert_eq!(totals(&mesh, &topology, &inputs), emitted, "{partitioning:?}");
            let given = hull_factors(&mesh, &topology, &inputs);
            assert_eq!(given_totals(&given, &inputs), emitted, "{partitioning:?}, given");
        }
    }

    #[test]
    fn the_factors_of_a_hull_shader_give_the_mesh_that_they_were_written_for() {
        for convention in Convention::ALL.into_iter().filter(|convention| convention.is_consistent()) {
            let (mesh, topology, inputs) = torus(convention, Partitioning::Integer);
            let out = tessellate(&mesh, &topology, &inputs, None);
            assert!(out.edge_factors.iter().any(|&factor| factor < 0.5 * out.edge_factors[0]), "edges are alike");
            let given = tessellate_given(&mesh, &topology, &inputs, &hull_factors(&mesh, &topology, &inputs));
            assert!(given == Tessellated { edge_factors: Vec::new(), ..out }, "{convention:?}");
        }
    }
}
