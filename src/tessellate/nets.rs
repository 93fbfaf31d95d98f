//! A mesh's control nets on the CPU, and the factors that LOD gives by them.

use glam::Vec3;

use super::relief::Relief;
use super::spans::Maps;
use super::{
    ControlNet, EDGE_SHARE, Edges, HullFactors, Inputs, Lod, Meeting, Normals, Partitioning, SURFACE_SHARE, Surface,
    center_control_point, crease_control_point, distance_factor, edge_error_factor, edge_length_factor,
    inside_error_factor, level, meet, paper_edge_factor, round_pow2, sharing, side_control_points,
};
use crate::mesh::{Curves, Mesh, Topology};

/// Control nets of a mesh: two control points a curve, one a patch.
pub(super) struct Nets<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) topology: &'a Topology,
    pub(super) surface: Surface,
    pub(super) normals: Normals,
    pub(super) edges: Edges,
    pub(super) curves: Curves,
    pub(super) curve_nets: Vec<[Vec3; 2]>,
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
    pub(super) fn edge_factors(&self, inputs: &Inputs, relief: Option<&Relief>) -> Vec<f32> {
        let asked = |form: &dyn Fn(&Inputs, [Vec3; 4]) -> f32, curve: u32| {
            let [a, b] = self.curves.curves[curve as usize].points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve as usize];
            form(inputs, [a, ab, ba, b])
        };
        let largest = |form: fn(&Inputs, [Vec3; 4]) -> f32, curves: &[u32]| {
            (curves[0]..curves[1]).map(|c| asked(&form, c)).fold(1.0, f32::max)
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
                Lod::Error => return self.error_factor(inputs, relief, index, Maps::All),
            };
            if inputs.partitioning == Partitioning::Pow2 { round_pow2(factor) } else { factor }
        };
        (0..).zip(self.curves.factor_curves.windows(2)).map(edge).collect()
    }

    /// What the error of an edge asks for, and the heights of these maps.
    fn error_factor(&self, inputs: &Inputs, relief: Option<&Relief>, factor: u32, maps: Maps) -> f32 {
        let share = if relief.is_some() { SURFACE_SHARE } else { 1.0 };
        let tolerance = EDGE_SHARE * (inputs.tolerance * share);
        let asked = |curve: u32| {
            let points = self.curves.curves[curve as usize].points;
            let [a, b] = points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve as usize];
            let net = [a, ab, ba, b];
            let is_flat = inputs.surface == Surface::Flat;
            let own = if is_flat { 1.0 } else { edge_error_factor(&inputs.view, tolerance, net) };
            relief.map_or(own, |relief| own.max(relief.edge_factor(inputs, factor, maps, points, net)))
        };
        let curves = &self.curves.factor_curves[factor as usize..factor as usize + 2];
        level(inputs.partitioning, (curves[0]..curves[1]).map(asked).fold(1.0, f32::max))
    }

    /// What heights ask for inside a patch: as much as on its edges, where its own map alone speaks for them.
    fn heights_inside(&self, inputs: &Inputs, relief: &Relief, patch: u32, sides: [f32; 3]) -> f32 {
        let own = |k: usize| {
            let factor = self.curves.factor(self.topology, self.topology.patches[patch as usize].sides[k]);
            let maps = relief.own_maps(patch, factor);
            maps.map_or(sides[k], |maps| self.error_factor(inputs, Some(relief), factor, maps))
        };
        own(0).max(own(1)).max(own(2))
    }

    /// The sides' factors in the order of the convention. Inside: the largest of the three, or what the error asks for,
    /// which takes edges by the corners that they are opposite, whatever the convention.
    pub(super) fn hull_factors(
        &self,
        inputs: &Inputs,
        relief: Option<&Relief>,
        edge_factors: &[f32],
        patch: u32,
        net: &ControlNet,
    ) -> HullFactors {
        let Inputs { view, tolerance, partitioning, .. } = inputs;
        let sides = self.topology.patches[patch as usize].sides;
        let sides = sides.map(|side| edge_factors[self.curves.factor(self.topology, side) as usize]);
        let by_heights = relief.filter(|_| inputs.lod == Lod::Error);
        let by_heights = by_heights.map(|relief| self.heights_inside(inputs, relief, patch, sides));
        let inside = if inputs.lod == Lod::Error && inputs.surface != Surface::Flat {
            let tolerance = tolerance * if by_heights.is_some() { SURFACE_SHARE } else { 1.0 };
            let own = inside_error_factor(view, tolerance, *partitioning, net, [sides[1], sides[2], sides[0]]);
            by_heights.map_or(own, |heights| own.max(heights))
        } else {
            by_heights.unwrap_or(sides[0].max(sides[1]).max(sides[2]))
        };
        HullFactors::of_sides(inputs.convention, sides, inside)
    }

    /// The curve of a patch's side, and whether the side runs against it.
    pub(super) fn curve(&self, patch: u32, side: usize) -> (usize, bool) {
        let side = self.topology.patches[patch as usize].sides[side];
        (self.curves.side_curves[side as usize] as usize, self.curves.runs_against(self.topology, side))
    }

    pub(super) fn corner(&self, patch: u32, k: usize) -> Vec3 {
        let corner = self.topology.patch_corners(patch)[k];
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
}
