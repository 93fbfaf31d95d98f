//! A whole mesh, tessellated on the CPU: what the passes do, in the same order, one patch after another.

use bytemuck::{Pod, Zeroable};
use clap::ValueEnum;
use glam::{Vec2, Vec3};

use super::relief::{Relief, displacing, reach};
use super::{
    Clip, ControlNet, Convention, Displacement, EDGE_SHARE, FIXED_ONE, HullFactors, Lod, LodView, Meeting, Normals,
    Partitioning, PatchFactors, SEEN, SURFACE_SHARE, Solid, Surface, center_control_point, corner_weights,
    crease_control_point, distance_factor, domain_plan, domain_point, domain_triangle, edge_error_factor,
    edge_length_factor, edge_normal, edge_position, edge_uv, inside_error_factor, level, linear_normal, linear_uv,
    meet, pack_normal, paper_edge_factor, patch_position, place, point_count, quadratic_edge_normal, quadratic_normal,
    round_pow2, side_control_points, surface_normal, triangle_count, unseen,
};
use crate::mesh::{Curves, Mesh, Sharing, Topology};

/// Who computes what the sides of an edge must agree on: control points, factor, positions and normals along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[repr(u32)]
pub enum Edges {
    /// The edge itself, once, in its own direction: all sides get the same bits, and nothing cracks.
    PerEdge = 0,
    /// Every patch for itself, in its own direction, as the white paper's shaders do (McDonald and Kilgard 2010): the
    /// same but for rounding, so that edges crack in their last bits. In the window, LOD by length and clipping switch to
    /// the white paper's form too.
    AsPublished = 1,
}

/// What a tessellation is a function of, besides the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    pub surface: Surface,
    /// How strong Phong tessellation is, 0 (flat) to 1.
    pub alpha: f32,
    pub normals: Normals,
    pub edges: Edges,
    pub factor: f32,
    pub partitioning: Partitioning,
    pub lod: Lod,
    /// Px a segment, for adaptive LOD.
    pub pixels: f32,
    /// Under LOD by error: the distance in px that what is emitted keeps to the surface.
    pub tolerance: f32,
    /// Under LOD by distance: up to which the factor is `factor`, and from which on it is 1, in bounding radii.
    pub near: f32,
    pub far: f32,
    pub clip: Clip,
    /// Whether patches that show their backs only are left out, where [`Solid`] allows it.
    pub cull_back_faces: bool,
    pub convention: Convention,
    pub displacement: Displacement,
    /// How far white is above black, in bounding radii of the mesh at rest.
    pub height_scale: f32,
    /// The height that stays where it is, 0 to 1.
    pub midlevel: f32,
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

    /// Its domain point: the weights of corners 0 and 1 in 16.16 fixed point, whatever the convention calls them.
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
    /// As LOD gave them: one for each edge, or as published one for each side. None where patches' were given.
    pub edge_factors: Vec<f32>,
}

/// Which sides share a curve under a surface.
pub fn sharing(surface: Surface, edges: Edges) -> Sharing {
    let alone = surface.tears() || surface == Surface::Flat;
    match edges {
        Edges::PerEdge if surface.tears() => Sharing::EqualNormals,
        Edges::PerEdge => Sharing::AllSides,
        Edges::AsPublished if alone => Sharing::None,
        Edges::AsPublished => Sharing::NoneAveraged,
    }
}

/// Tessellates the mesh. With `factors`, those are used in place of the ones that LOD gives: one for each edge, or as
/// published one for each curve (see [`Curves::factor`]).
pub fn tessellate(mesh: &Mesh, topology: &Topology, inputs: &Inputs, factors: Option<&[f32]>) -> Tessellated {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs);
    let edge_factors = factors.map_or_else(|| nets.edge_factors(inputs, relief.as_ref()), <[f32]>::to_vec);
    let culls_back = culls_back(mesh, topology, inputs);
    let relief = relief.map(|relief| relief.with_levels(&edge_factors));
    let out = nets
        .emit(inputs, relief.as_ref(), culls_back, |patch, net| nets.hull_factors(inputs, &edge_factors, patch, net));
    Tessellated { edge_factors, ..out }
}

/// The same inputs, with a view that knows how far the mesh is displaced.
fn seen_with_reach(mesh: &Mesh, inputs: &Inputs) -> Inputs {
    Inputs { view: LodView { reach: reach(mesh, inputs), ..inputs.view }, ..*inputs }
}

/// Whether patches that face away are left out.
fn culls_back(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> bool {
    inputs.cull_back_faces && Solid::find(mesh, topology).is_some_and(|solid| solid.hides_backs(inputs))
}

/// Tessellates the mesh with what a hull shader wrote, one for each patch, in place of what LOD gives. Backs stay: given
/// factors may tear any edge.
pub fn tessellate_given(mesh: &Mesh, topology: &Topology, inputs: &Inputs, given: &[HullFactors]) -> Tessellated {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let relief = Relief::new(&nets, inputs).map(|relief| {
        let factors = relief.given_factors(inputs.convention, given);
        relief.with_levels(&factors)
    });
    let written = |patch: u32, _: &ControlNet| given[patch as usize].rounded(inputs.partitioning);
    nets.emit(inputs, relief.as_ref(), false, written)
}

/// What the hull shader writes under LOD, one for each patch; zeros for those that are left out.
pub fn hull_factors(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> Vec<HullFactors> {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let edge_factors = nets.edge_factors(inputs, Relief::new(&nets, inputs).as_ref());
    let culls_back = culls_back(mesh, topology, inputs);
    let written = |patch| {
        let net = nets.patch(patch);
        match unseen(inputs.clip, culls_back, &inputs.view, &net) {
            SEEN => nets.hull_factors(inputs, &edge_factors, patch, &net),
            _ => HullFactors::default(),
        }
    };
    (0..topology.patches.len() as u32).map(written).collect()
}

/// Vertices and triangles that [`tessellate`] would emit, clipping aside.
pub fn totals(mesh: &Mesh, topology: &Topology, inputs: &Inputs) -> (u64, u64) {
    let inputs = &seen_with_reach(mesh, inputs);
    let nets = Nets::new(mesh, topology, inputs);
    let edge_factors = nets.edge_factors(inputs, Relief::new(&nets, inputs).as_ref());
    let patches = 0..topology.patches.len() as u32;
    let written = patches.map(|patch| nets.hull_factors(inputs, &edge_factors, patch, &nets.patch(patch)));
    sums(written.map(|written| written.process(inputs.partitioning)))
}

/// Vertices and triangles that [`tessellate_given`] would emit, clipping aside.
pub fn given_totals(given: &[HullFactors], inputs: &Inputs) -> (u64, u64) {
    sums(given.iter().map(|written| written.rounded(inputs.partitioning).process(inputs.partitioning)))
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

/// Control nets of a mesh: two control points a curve, one a patch.
pub(super) struct Nets<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) surface: Surface,
    normals: Normals,
    edges: Edges,
    pub(super) curves: Curves,
    curve_nets: Vec<[Vec3; 2]>,
}

impl<'a> Nets<'a> {
    pub(super) fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        let Inputs { surface, alpha, normals, edges, .. } = *inputs;
        let curves = Curves::build(mesh, topology, sharing(surface, edges));
        let net = |curve: &crate::mesh::Curve| {
            let [a, b] = curve.points.map(|p| topology.points[p as usize]);
            let sides = &curves.sides[curve.first_side as usize..][..curve.side_count as usize];
            let (mut ab, mut ba) = (Vec3::ZERO, Vec3::ZERO);
            let (mut around_a, mut around_b) = (Meeting::default(), Meeting::default());
            for side in sides {
                let [at_a, at_b] = side.map(|corner| mesh.corners[corner as usize].normal);
                let proposed = side_control_points(surface, alpha, a, b, at_a, at_b);
                ab += proposed[0];
                ba += proposed[1];
                around_a = meet(around_a, at_a);
                around_b = meet(around_b, at_b);
            }
            let share = 1.0 / curve.side_count as f32;
            let (ab, ba) = (ab * share, ba * share);
            if surface == Surface::PnCrease {
                return [crease_control_point(a, b, around_a, ab), crease_control_point(b, a, around_b, ba)];
            }
            [ab, ba]
        };
        let curve_nets = curves.curves.iter().map(net).collect();
        Self { mesh, topology, surface, normals, edges, curves, curve_nets }
    }

    /// The largest factor that any of an edge's curves asks for; as published, what each curve asks for.
    fn edge_factors(&self, inputs: &Inputs, relief: Option<&Relief>) -> Vec<f32> {
        let asked = |form: &dyn Fn(&Inputs, [Vec3; 4]) -> f32, curve: u32| {
            let [a, b] = self.curves.curves[curve as usize].points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve as usize];
            form(inputs, [a, ab, ba, b])
        };
        let largest = |form: fn(&Inputs, [Vec3; 4]) -> f32, curves: &[u32]| {
            (curves[0]..curves[1]).map(|c| asked(&form, c)).fold(1.0, f32::max)
        };
        let share = if relief.is_some() { SURFACE_SHARE } else { 1.0 };
        let heights = |factor: u32, curves: &[u32]| {
            let asked = |relief: &Relief, curve: u32| {
                let points = self.curves.curves[curve as usize].points;
                let [a, b] = points.map(|p| self.topology.points[p as usize]);
                let [ab, ba] = self.curve_nets[curve as usize];
                relief.edge_factor(inputs, factor, points, [a, ab, ba, b])
            };
            relief.map_or(1.0, |relief| (curves[0]..curves[1]).map(|curve| asked(relief, curve)).fold(1.0, f32::max))
        };
        let edge = |(index, curves): (u32, &[u32])| {
            let factor = match inputs.lod {
                Lod::Uniform => inputs.factor,
                Lod::Paper => largest(|inputs, net| paper_edge_factor(&inputs.view, inputs.pixels, net), curves),
                Lod::EdgeLength => largest(|inputs, net| edge_length_factor(&inputs.view, inputs.pixels, net), curves),
                Lod::Distance => largest(
                    |Inputs { view, factor, near, far, .. }, net| distance_factor(view, *factor, *near, *far, net),
                    curves,
                ),
                Lod::Error if inputs.surface == Surface::Flat => heights(index, curves),
                Lod::Error => {
                    let tolerance = EDGE_SHARE * (inputs.tolerance * share);
                    let asked = |curve| asked(&|inputs, net| edge_error_factor(&inputs.view, tolerance, net), curve);
                    (curves[0]..curves[1]).map(asked).fold(heights(index, curves), f32::max)
                }
            };
            match (inputs.lod, inputs.partitioning) {
                (Lod::Error, partitioning) => level(partitioning, factor),
                (_, Partitioning::Pow2) => round_pow2(factor),
                _ => factor,
            }
        };
        (0..).zip(self.curves.factor_curves.windows(2)).map(edge).collect()
    }

    /// The sides' factors in the order of the convention. Inside: the largest of the three, or what the error asks for,
    /// which takes edges by the corners that they are opposite, whatever the convention.
    fn hull_factors(&self, inputs: &Inputs, edge_factors: &[f32], patch: u32, net: &ControlNet) -> HullFactors {
        let Inputs { view, tolerance, partitioning, .. } = inputs;
        let sides = self.topology.patches[patch as usize].sides;
        let sides = sides.map(|side| edge_factors[self.curves.factor(self.topology, side) as usize]);
        let inside = if inputs.lod == Lod::Error && inputs.surface != Surface::Flat {
            let is_displaced = displacing(self.mesh, inputs).is_some();
            let tolerance = tolerance * if is_displaced { SURFACE_SHARE } else { 1.0 };
            let own = inside_error_factor(view, tolerance, *partitioning, net, [sides[1], sides[2], sides[0]]);
            // Heights are as fine inside as on the edges.
            if is_displaced { own.max(sides[0]).max(sides[1]).max(sides[2]) } else { own }
        } else {
            sides[0].max(sides[1]).max(sides[2])
        };
        HullFactors::of_sides(inputs.convention, sides, inside)
    }

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
            let factors = match unseen(inputs.clip, culls_back, &inputs.view, &net) {
                SEEN => written(patch, &net).process(inputs.partitioning),
                why => PatchFactors { inside: why, ..PatchFactors::zeroed() },
            };
            let plan = domain_plan(factors);
            let vertex = |i| {
                let uv = corner_weights(inputs.convention, domain_point(&plan, i));
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

    /// The curve of a patch's side, and whether the side runs against it.
    fn curve(&self, patch: u32, side: usize) -> (usize, bool) {
        let side = self.topology.patches[patch as usize].sides[side];
        (self.curves.side_curves[side as usize] as usize, self.curves.runs_against(self.topology, side))
    }

    fn corner(&self, patch: u32, k: usize) -> Vec3 {
        let corner = self.topology.patches[patch as usize].corners[k];
        self.topology.points[self.topology.corner_points[corner as usize] as usize]
    }

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
        let corners = self.topology.patches[patch as usize].corners.map(|c| self.mesh.corners[c as usize]);
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
        let corners = self.topology.patches[patch as usize].corners;
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
