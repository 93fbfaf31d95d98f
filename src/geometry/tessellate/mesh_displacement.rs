//! Displacement of a whole mesh on the CPU: what `shaders/pass_levels.wgsl` and `shaders/pass_displace.wgsl` do.

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::control_nets::ControlNets;
use super::displace::{
    Displacement, Spot, direction_slopes, height_at, height_slopes, raised_normal, segment_level, spot, texel_length,
    uv_gradients,
};
use super::factors::{inside_value, last_factor};
use super::normal::{Normals, edge_normal, facing_or, linear_normal, unit_or};
use super::octahedral_normal::{pack_normal, unpack_normal};
use super::surface::{UNIT, linear_uv, patch_tangents};
use super::vertex::Vertex;
use super::{Convention, FIXED_ONE, HullFactors, Inputs, PatchFactors, Tessellation, factor_side};
use crate::mesh::{
    Curves, Dominance, HeightAmount, HeightMap, Heights, Mesh, PatchRelief, Sharing, Topology, patch_reliefs,
};

/// Returns the heights that displace a mesh with these inputs, if any.
pub fn displacing_heights<'a>(mesh: &'a Mesh, inputs: &Inputs) -> Option<&'a Heights> {
    mesh.heights.as_deref().filter(|_| inputs.tessellation.displacement.is_on())
}

/// Returns how far images without an amount of their own move the surface. It depends on the size of the mesh at rest, so that it is
/// the same in every pose.
pub fn usual_amount(heights: &Heights, inputs: &Inputs) -> HeightAmount {
    let Tessellation { height_scale, midlevel, .. } = inputs.tessellation;
    HeightAmount { scale: height_scale * heights.radius, midlevel }
}

/// Returns the largest distance by which a point is displaced, in object units.
pub fn displacement_reach(mesh: &Mesh, inputs: &Inputs) -> f32 {
    displacing_heights(mesh, inputs).map_or(0.0, |heights| heights.reach(usual_amount(heights, inputs)))
}

/// The heights over a mesh, and what its patches share at edges and points.
pub(super) struct MeshDisplacement<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    heights: &'a Heights,
    mode: Displacement,
    normals: Normals,
    /// How far images without an amount of their own move the surface.
    usual: HeightAmount,
    /// The largest factor that there is.
    last_factor: f32,
    dominance: Dominance,
    /// The unit direction of displacement of each point.
    directions: Vec<Vec3>,
    /// The gradients of both texture coordinates at each corner, averaged over the triangles around it. Linear and
    /// quadratic shading normals are tilted by heights along these, which are as smooth across edges as the normals
    /// are.
    frames: Vec<[Vec3; 2]>,
    /// What LOD by error knows of the heights over each patch.
    reliefs: Vec<PatchRelief>,
    /// Whether positions take their heights from level 0, from which LOD by error bounds the distance.
    reads_level_0: bool,
    /// The mip level of each factor's edge. `point_levels` has for each point the finest level of its edges.
    factor_levels: Vec<f32>,
    point_levels: Vec<f32>,
}

/// Where the height of a point is read: weights `u` and `v` in a patch, and a mip level.
#[derive(Clone, Copy)]
struct Lookup {
    patch: u32,
    u: u32,
    v: u32,
    level: f32,
}

/// Returns the weights of corners 0 and 1 for the point at `t` (16.16 fixed point) along a side.
fn side_weights(side: usize, t: u32) -> [u32; 2] {
    match side {
        0 => [FIXED_ONE - t, t],
        1 => [0, FIXED_ONE - t],
        _ => [t, 0],
    }
}

impl<'a> MeshDisplacement<'a> {
    /// Returns what displaces the mesh with these inputs, if anything. Mip levels aren't set yet: see
    /// [`Self::with_levels`].
    pub(super) fn new(nets: &ControlNets<'a>, inputs: &Inputs) -> Option<Self> {
        let (mesh, topology) = (nets.mesh, nets.topology);
        let heights = displacing_heights(mesh, inputs)?;
        let dominance = Dominance::new(topology, &nets.curves, &heights.angles);
        Some(Self {
            mesh,
            topology,
            heights,
            mode: inputs.tessellation.displacement,
            normals: inputs.tessellation.normals,
            usual: usual_amount(heights, inputs),
            last_factor: last_factor(inputs.tessellation.partitioning),
            directions: directions(mesh, &dominance),
            frames: frames(mesh, topology),
            reliefs: patch_reliefs(Some(heights), mesh, topology),
            reads_level_0: false,
            factor_levels: vec![0.0; dominance.sides.len()],
            point_levels: vec![0.0; dominance.corners.len()],
            dominance,
        })
    }

    /// Sets the mip levels for the factors of edges. LOD by error reads heights from level 0.
    pub(super) fn with_levels(mut self, factors: &[f32], by_error: bool) -> Self {
        self.reads_level_0 = by_error;
        self.factor_levels = (0..factors.len()).map(|factor| self.factor_level(factor, factors[factor])).collect();
        let starts = self.dominance.factor_starts.windows(2);
        let finest = |ends: &[u32]| {
            let own = &self.dominance.factors[ends[0] as usize..ends[1] as usize];
            own.iter().map(|&factor| self.factor_levels[factor as usize]).fold(f32::INFINITY, f32::min)
        };
        self.point_levels = starts.map(finest).collect();
        self
    }

    /// Returns each edge's factor if a hull shader's factors are given: the one of its dominant side.
    pub(super) fn given_factors(&self, convention: Convention, given: &[HullFactors]) -> Vec<f32> {
        let of = |&dominant: &u32| {
            let own = given[dominant as usize / 4].edges;
            let index = (0..3).find(|&i| factor_side(convention, i) == dominant % 4);
            index.map_or(1.0, |i| own[i as usize])
        };
        self.dominance.sides.iter().map(of).collect()
    }

    /// Returns the directions in which a patch's corners move, the distance between black and white in object units, and what is known
    /// of the heights over the patch.
    pub(super) fn relief(&self, patch: u32) -> ([Vec3; 3], f32, PatchRelief) {
        let packed = self.corner_directions(patch).map(pack_normal);
        let scale = self.map(patch).map_or(0.0, |map| self.amount(map).scale);
        (packed.map(unpack_normal), scale, self.reliefs[patch as usize])
    }

    /// Returns the displacement of a place in a patch in object units, in f64. Heights are read from mip level 0 at the
    /// patch's own texture coordinates.
    pub(super) fn exact_displacement(&self, patch: u32, weights: [f64; 3]) -> DVec3 {
        let Some(map) = self.map(patch) else { return DVec3::ZERO };
        let uv = (0..3).map(|k| self.uvs(patch)[k].as_dvec2() * weights[k]).sum::<DVec2>();
        let directions = self.corner_directions(patch);
        let direction = (0..3).map(|k| directions[k].as_dvec3() * weights[k]).sum::<DVec3>().normalize_or_zero();
        direction * f64::from(self.moved(map, 0.0, uv.as_vec2()))
    }

    /// Returns the mip level of an edge, by the length of its dominant side in the image.
    fn factor_level(&self, factor: usize, segments: f32) -> f32 {
        let dominant = self.dominance.sides[factor];
        let (patch, side) = (dominant / 4, dominant as usize % 4);
        let uvs = self.uvs(patch);
        let Some(map) = self.map(patch) else { return 0.0 };
        segment_level(
            map,
            texel_length(map, uvs[side], uvs[(side + 1) % 3]),
            if segments >= 1.0 { segments.min(self.last_factor) } else { 1.0 },
        )
    }

    /// Returns the height map of a patch.
    fn map(&self, patch: u32) -> Option<&'a HeightMap> {
        self.heights.map(self.topology.patches[patch as usize].triangle)
    }

    /// Returns how far an image moves the surface.
    fn amount(&self, map: &HeightMap) -> HeightAmount {
        map.amount.unwrap_or(self.usual)
    }

    /// Returns how far an image moves a place of the surface, in object units.
    fn moved(&self, map: &HeightMap, level: f32, uv: Vec2) -> f32 {
        let HeightAmount { scale, midlevel } = self.amount(map);
        scale * (height_at(map, level, uv) - midlevel)
    }

    fn uvs(&self, patch: u32) -> [Vec2; 3] {
        self.topology.patch_corners(patch).map(|corner| self.mesh.corners[corner as usize].uv)
    }

    /// Returns the mip level inside a patch that has so many segments inside.
    fn inside_level(&self, patch: u32, segments: f32) -> f32 {
        let Some(map) = self.map(patch) else { return 0.0 };
        let [a, b, c] = self.uvs(patch);
        let longest = texel_length(map, a, b).max(texel_length(map, b, c)).max(texel_length(map, c, a));
        segment_level(map, longest, segments)
    }

    /// Displaces a vertex of a patch with these factors.
    pub(super) fn displaced(&self, nets: &ControlNets, factors: PatchFactors, vertex: Vertex) -> Vertex {
        let (patch, [u, v]) = (vertex.patch(), vertex.domain());
        let segments = inside_value(factors) as f32 * UNIT;
        let (position, normal) = (Vec3::from(vertex.position), unpack_normal(vertex.normal));
        let (own, shared) = self.lookups(patch, u, v, segments);
        let lookup = if self.mode == Displacement::PerPatch { own } else { shared };
        let direction = self.direction(patch, u, v);
        let offset = self.offset(lookup);
        let moved = position + direction * offset;
        let normal = if self.normals == Normals::Surface {
            // The patch's own normal, as without displacement.
            let (slopes, tangents) = self.slopes(nets, own, offset);
            let (along_u, along_v) = (tangents[0] + direction * slopes.x, tangents[1] + direction * slopes.y);
            facing_or([along_u, along_v], normal)
        } else {
            raised_normal(self.uphill(lookup), normal)
        };
        Vertex { position: moved.to_array(), normal: pack_normal(normal), ..vertex }
    }

    /// Returns where a patch by itself would read its point's height, and where all patches read it that share the
    /// point.
    fn lookups(&self, patch: u32, u: u32, v: u32, segments: f32) -> (Lookup, Lookup) {
        match spot(u, v) {
            Spot::Inside => {
                let own = Lookup { patch, u, v, level: self.inside_level(patch, segments) };
                (own, own)
            }
            Spot::Corner(k) => {
                let point = self.point(patch, k);
                let level = self.point_levels[point as usize];
                let dominant = self.dominance.corners[point as usize];
                let weight = |corner: u32| if dominant % 4 == corner { FIXED_ONE } else { 0 };
                let shared = Lookup { patch: dominant / 4, u: weight(0), v: weight(1), level };
                (Lookup { patch, u, v, level }, shared)
            }
            Spot::Side(side, t) => {
                let factor = self.factor(patch, side);
                let level = self.factor_levels[factor as usize];
                let dominant = self.dominance.sides[factor as usize];
                let (other, start) = (dominant / 4, dominant as usize % 4);
                let same_way = self.point(patch, side) == self.point(other, start);
                let [x, y] = side_weights(start, if same_way { t } else { FIXED_ONE - t });
                (Lookup { patch, u, v, level }, Lookup { patch: other, u: x, v: y, level })
            }
        }
    }

    fn point(&self, patch: u32, k: usize) -> u32 {
        self.topology.corner_points[self.topology.patch_corners(patch)[k] as usize]
    }

    fn factor(&self, patch: u32, side: usize) -> u32 {
        self.dominance.patch_factors[patch as usize][side]
    }

    /// Returns the unit direction in which a patch's point is displaced. On a side it is computed in the direction of
    /// the dominant side, so that all sides get the same.
    fn direction(&self, patch: u32, u: u32, v: u32) -> Vec3 {
        let corners = self.corner_directions(patch);
        match spot(u, v) {
            Spot::Corner(k) => corners[k],
            Spot::Side(side, t) => {
                let dominant = self.dominance.sides[self.factor(patch, side) as usize];
                let same_way = self.point(patch, side) == self.point(dominant / 4, dominant as usize % 4);
                let (a, b) = (corners[side], corners[(side + 1) % 3]);
                let (a, b, t) = if same_way { (a, b, t) } else { (b, a, FIXED_ONE - t) };
                edge_normal(a, b, t)
            }
            Spot::Inside => linear_normal(corners, u, v),
        }
    }

    /// Returns the directions of displacement at a patch's corners: their points' or, as published, their own normals.
    fn corner_directions(&self, patch: u32) -> [Vec3; 3] {
        if self.mode == Displacement::On {
            return [0, 1, 2].map(|k| self.directions[self.point(patch, k) as usize]);
        }
        self.topology.patch_corners(patch).map(|corner| self.mesh.corners[corner as usize].normal)
    }

    /// Returns how far a point is displaced, in object units.
    fn offset(&self, at: Lookup) -> f32 {
        let Some(map) = self.map(at.patch) else { return 0.0 };
        let level = if self.reads_level_0 { 0.0 } else { at.level.min((map.levels - 1) as f32) };
        self.moved(map, level, linear_uv(self.uvs(at.patch), at.u, at.v))
    }

    /// Returns the gradient of the height in object space, by the frames of the patch's corners.
    fn uphill(&self, at: Lookup) -> Vec3 {
        let Some(map) = self.map(at.patch) else { return Vec3::ZERO };
        let level = at.level.min((map.levels - 1) as f32);
        let rises = height_slopes(map, level, linear_uv(self.uvs(at.patch), at.u, at.v)) * self.amount(map).scale;
        let [a, b, c] = self.topology.patch_corners(at.patch).map(|corner| self.frames[corner as usize]);
        let [x, y, z] = [at.u, at.v, FIXED_ONE - at.u - at.v].map(|weight| weight as f32 * UNIT);
        let along_u = a[0] * x + b[0] * y + c[0] * z;
        let along_v = a[1] * x + b[1] * y + c[1] * z;
        along_u * rises.x + along_v * rises.y
    }

    /// Returns the derivatives of a patch's height by u and by v, in object units, and the tangents of the surface that
    /// is displaced by `offset` everywhere.
    fn slopes(&self, nets: &ControlNets, at: Lookup, offset: f32) -> (Vec2, [Vec3; 2]) {
        let uvs = self.uvs(at.patch);
        let net = nets.patch(at.patch);
        let [along_u, along_v] = patch_tangents(nets.surface, &net, at.u, at.v);
        let corners = self.corner_directions(at.patch);
        let [x, y, z] = [at.u, at.v, FIXED_ONE - at.u - at.v].map(|weight| weight as f32 * UNIT);
        let sum = corners[0] * x + corners[1] * y + corners[2] * z;
        let direction = unit_or(sum, linear_normal(corners, at.u, at.v));
        let [turn_u, turn_v] = direction_slopes(corners, direction, sum.length());
        let tangents = [along_u + turn_u * offset, along_v + turn_v * offset];
        let Some(map) = self.map(at.patch) else { return (Vec2::ZERO, tangents) };
        let level = at.level.min((map.levels - 1) as f32);
        let rises = height_slopes(map, level, linear_uv(uvs, at.u, at.v)) * self.amount(map).scale;
        (Vec2::new(rises.dot(uvs[0] - uvs[2]), rises.dot(uvs[1] - uvs[2])), tangents)
    }
}

/// Returns the gradients of both texture coordinates at each corner: their mean over the patches around it, weighted by
/// area.
fn frames(mesh: &Mesh, topology: &Topology) -> Vec<[Vec3; 2]> {
    let alike = mesh.alike_corners();
    let mut sums = vec![([Vec3::ZERO; 2], 0.0_f32); mesh.corners.len()];
    for (index, patch) in (0..).zip(&topology.patches) {
        let uvs = topology.corners(patch).map(|corner| mesh.corners[corner as usize].uv);
        let (gradients, area) = uv_gradients(topology.patch_positions(index), uvs);
        for corner in topology.corners(patch) {
            let sum = &mut sums[alike[corner as usize] as usize];
            *sum = ([sum.0[0] + gradients[0], sum.0[1] + gradients[1]], sum.1 + area);
        }
    }
    let mean = |(sum, area): ([Vec3; 2], f32)| if area > 0.0 { sum.map(|x| x * (1.0 / area)) } else { sum };
    alike.iter().map(|&corner| mean(sums[corner as usize])).collect()
}

/// Returns the direction of displacement of each point: the mean of the normals there, weighted by angle, or the normal
/// of the dominant corner if they cancel.
fn directions(mesh: &Mesh, dominance: &Dominance) -> Vec<Vec3> {
    let of = |ends: &[u32]| {
        let parts = &dominance.parts[ends[0] as usize..ends[1] as usize];
        let normal = |corner: u32| mesh.corners[corner as usize].normal;
        let sum = parts.iter().fold(Vec3::ZERO, |sum, &(corner, part)| sum + normal(corner) * part);
        unit_or(sum, parts.first().map_or(Vec3::Z, |&(corner, _)| normal(corner)))
    };
    dominance.part_starts.windows(2).map(of).collect()
}

/// What displacement needs of a corner in shaders that see single patches: the unit direction in which its point moves, the gradients
/// of both texture coordinates in 1 / object unit, and the length of the point's shortest edge in px of the height image's level 0.
pub type DisplacedCorner = [f32; 10];

/// Returns what displacement needs of every corner of a mesh that one height image displaces everywhere; `None` if there is no image, or
/// several, or some triangle has none.
pub fn displaced_corners(mesh: &Mesh, topology: &Topology) -> Option<Vec<DisplacedCorner>> {
    let heights = mesh.heights.as_deref()?;
    let [map] = &heights.maps[..] else { return None };
    if !topology.patches.iter().all(|patch| heights.map_of(patch.triangle).is_some()) {
        return None;
    }
    let dominance = Dominance::new(topology, &Curves::build(mesh, topology, Sharing::AllSides), &heights.angles);
    let (directions, frames) = (directions(mesh, &dominance), frames(mesh, topology));
    let texels = |&factor: &u32| {
        let (patch, side) = (dominance.sides[factor as usize] / 4, dominance.sides[factor as usize] as usize % 4);
        let [a, b] = [side, (side + 1) % 3].map(|k| mesh.corners[topology.patch_corners(patch)[k] as usize].uv);
        texel_length(map, a, b)
    };
    let shortest = |ends: &[u32]| {
        let own = &dominance.factors[ends[0] as usize..ends[1] as usize];
        own.iter().map(texels).reduce(f32::min).unwrap_or(0.0)
    };
    let shortest: Vec<_> = dominance.factor_starts.windows(2).map(shortest).collect();
    let of = |(&point, [along_u, along_v]): (&u32, &[Vec3; 2])| {
        let ([x, y, z], [a, b, c], [d, e, f]) =
            (directions[point as usize].into(), (*along_u).into(), (*along_v).into());
        [x, y, z, a, b, c, d, e, f, shortest[point as usize]]
    };
    Some(topology.corner_points.iter().zip(&frames).map(of).collect())
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;
    use std::sync::Arc;

    use super::*;
    use crate::mesh::{Corner, CornerDetail, Material, Shape};
    use crate::progress::Progress;
    use crate::tessellate::{LimitSurface, LodView, Partitioning, Surface, Tessellation, tessellate};
    use glam::{Mat4, vec2, vec3};

    /// Returns a square of two triangles from (-1, -1) to (1, 1), over the middle half of an image that rises by 1/2
    /// across and by 1/4 down.
    fn square() -> Mesh {
        let corner = |x: f32, y: f32| Corner {
            position: vec3(x, y, 0.0),
            normal: Vec3::Z,
            uv: vec2(0.5 + 0.25 * x, 0.5 - 0.25 * y),
        };
        let mut material = Material::plain("plain", [1.0; 4]);
        material.triangles = 0..2;
        let mut mesh = Mesh {
            corners: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x, y)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
            materials: vec![material],
            ..Mesh::default()
        };
        let height = |i: u32| ((i % 64) as f32 + 0.5) / 128.0 + ((i / 64) as f32 + 0.5) / 256.0;
        let map = HeightMap::new([64, 64], (0..4096).map(height).collect());
        mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, map)));
        mesh
    }

    /// The bits of every position on edges and points, by a number of the edge or point and a place along the edge.
    fn shared_places(mesh: &Mesh, topology: &Topology, displacement: Displacement) -> HashMap<[u32; 3], [u32; 3]> {
        let own = Tessellation { displacement, factor: 5.3, height_scale: 0.2, ..Tessellation::default() };
        let view = LodView::new(Mat4::IDENTITY, Vec2::ONE);
        let mut places = HashMap::new();
        for vertex in &tessellate(mesh, topology, &Inputs::new(&own, view), None).vertices {
            let (patch, [u, v]) = (vertex.patch(), vertex.domain());
            let point = |k: usize| topology.corner_points[topology.patch_corners(patch)[k % 3] as usize];
            let place = match spot(u, v) {
                Spot::Inside => continue,
                Spot::Corner(k) => [0, point(k), 0],
                Spot::Side(side, t) => {
                    let edge = topology.sides[topology.patches[patch as usize].sides[side] as usize].edge;
                    [1, edge, if point(side) < point(side + 1) { t } else { FIXED_ONE - t }]
                }
            };
            let bits = vertex.position.map(f32::to_bits);
            assert_eq!(*places.entry(place).or_insert(bits), bits, "a crack at {place:?}");
        }
        places
    }

    #[test]
    fn materials_meet_at_the_image_of_the_dominant_side() {
        let mut mesh = Shape::Torus.build();
        let half = mesh.triangles.len() as u32 / 2;
        let of = |triangles| Material { triangles, ..mesh.materials[0].clone() };
        mesh.materials = vec![of(0..half), of(half..2 * half)];
        let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
        let ramp = HeightMap::new([8, 8], (0..64).map(|i| (i % 8) as f32 / 8.0).collect());
        let steps = HeightMap::new([5, 3], (0..15).map(|i| (i * 7 % 15) as f32 / 15.0).collect());
        let steps = steps.with_amount(HeightAmount::from_factor(0.3, 0.1));
        let mut places = |own: [Option<&HeightMap>; 2]| {
            let own = own.map(|map| map.cloned());
            mesh.heights = Some(Arc::new(
                Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("few maps"),
            ));
            shared_places(&mesh, &topology, Displacement::On)
        };
        let [flat, first, second, both] =
            [[None, None], [Some(&steps), None], [None, Some(&ramp)], [Some(&steps), Some(&ramp)]].map(&mut places);
        let patches_of = |side: &u32| topology.sides[*side as usize].patch();
        let mut met = 0;
        for (place, bits) in &both {
            let [1, edge, _] = *place else { continue };
            let sides: Vec<_> =
                (0..).zip(&topology.sides).filter(|(_, side)| side.edge == edge).map(|own| own.0).collect();
            let is_first = |side: &u32| patches_of(side) < half;
            // The first side of an edge is the dominant one, and that of the first material comes first.
            let expected = if sides.iter().any(is_first) { &first } else { &second };
            assert_eq!(expected[place], *bits);
            if sides.iter().any(is_first) && !sides.iter().all(is_first) {
                met += 1;
                let at = |bits: &[u32; 3]| bits.map(f32::from_bits);
                assert_eq!(at(&second[place]), at(&flat[place]), "its dominant side has no image");
                assert_ne!(first[place], flat[place]);
            }
        }
        assert!(met > 20, "{met} places between the materials");
    }

    #[test]
    fn corners_that_differ_in_details_alone_have_one_frame() {
        let whole = Shape::Torus.build();
        let mut split = whole.clone();
        let count = whole.corners.len() as u32;
        split.corners.extend(whole.corners.clone());
        let mut details = vec![CornerDetail::default(); split.corners.len()];
        details[count as usize..].iter_mut().for_each(|detail| detail.color.x = 0.0);
        split.details = Some(Arc::new(details));
        for triangle in Arc::make_mut(&mut split.triangles).iter_mut().step_by(2) {
            *triangle = triangle.map(|corner| corner + count);
        }
        let [own, other] = [&whole, &split].map(|mesh| frames(mesh, &Topology::new(mesh)));
        for (corners, copies) in whole.triangles.iter().zip(split.triangles.iter()) {
            for (&corner, &copy) in corners.iter().zip(copies) {
                assert_eq!(own[corner as usize], other[copy as usize]);
            }
        }
    }

    #[test]
    fn every_corner_has_its_direction_its_gradients_and_its_shortest_edge() {
        let mesh = square();
        let corners = displaced_corners(&mesh, &Topology::new(&mesh)).expect("one image everywhere");
        // Texture coordinates rise by 1/4 for each unit to the right, and fall by 1/4 for each unit up. A side is 32 px long.
        let expected = [0.0, 0.0, 1.0, 0.25, 0.0, 0.0, 0.0, -0.25, 0.0, 32.0];
        for own in corners {
            assert!(own.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-5), "{own:?}");
        }
        let mut plain = mesh.clone();
        plain.heights = None;
        assert_eq!(displaced_corners(&plain, &Topology::new(&plain)), None);
        let mut partly = mesh;
        let heights = Heights { ranges: Vec::new(), ..partly.heights.as_deref().expect("heights").clone() };
        partly.heights = Some(Arc::new(heights));
        assert_eq!(displaced_corners(&partly, &Topology::new(&partly)), None);
    }

    #[test]
    fn a_slope_over_a_square_is_a_slope() {
        let mesh = square();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        // In object units from black to white; the square's bounding radius is the root of 2.
        let scale = 2.0;
        // The height rises by 1/2 over 4 units across and by 1/4 over 4 units down.
        let rise = vec2(scale / 8.0, -scale / 16.0);
        let normal = vec3(-rise.x, -rise.y, 1.0).normalize();
        for (surface, normals) in [
            (Surface::Flat, Normals::Linear),
            (Surface::PnAen, Normals::Quadratic),
            (Surface::PnAen, Normals::Surface),
            (Surface::Flat, Normals::Surface),
        ] {
            for displacement in [Displacement::On, Displacement::PerPatch] {
                let tessellation = Tessellation {
                    surface,
                    normals,
                    displacement,
                    height_scale: scale / 2.0_f32.sqrt(),
                    midlevel: 0.25,
                    // Segments shorter than a px: heights are read from level 0.
                    partitioning: Partitioning::Integer,
                    factor: 64.0,
                    ..Tessellation::default()
                };
                let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
                let limit = LimitSurface::new(&mesh, &topology, &inputs);
                for vertex in tessellate(&mesh, &topology, &inputs, None).vertices {
                    let position = Vec3::from(vertex.position);
                    // In the middle of the image the height is 3/8.
                    let expected = vec3(position.x, position.y, rise.dot(position.truncate()) + scale * (0.375 - 0.25));
                    let what = format!("{surface:?} {normals:?} {displacement:?} at {position}");
                    assert!(position.distance(expected) < 1e-5, "{what}, not {expected}");
                    let own = unpack_normal(vertex.normal);
                    assert!(own.distance(normal) < 1e-3, "{what}: {own}, not {normal}");
                    let [u, v] = vertex.domain().map(|weight| f64::from(weight) / f64::from(FIXED_ONE));
                    let exact = limit.position(vertex.patch(), &limit.net(vertex.patch()), u, v);
                    assert!(exact.distance(position.as_dvec3()) < 1e-5, "{what}: {exact} on the limit surface");
                }
            }
        }
    }
}
