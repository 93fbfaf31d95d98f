//! The tessellation factors that LOD gives to the edges and patches of a mesh, on the CPU: what
//! `shaders/pass_factors.wgsl` computes.

use glam::Vec3;

use super::control_nets::ControlNets;
use super::mesh_displacement::MeshDisplacement;
use super::texel_lengths::Maps;
use super::{
    ControlNet, EDGE_SHARE, HullFactors, Inputs, Lod, Partitioning, SURFACE_SHARE, Surface, Tessellation,
    distance_factor, edge_error_factor, edge_length_factor, inside_error_factor, nesting_factor, paper_edge_factor,
    round_pow2,
};

impl ControlNets<'_> {
    /// Returns the factor of each edge: the largest that any of its curves needs. With edges as published, each curve
    /// has its own factor.
    pub(super) fn edge_factors(&self, inputs: &Inputs, displacement: Option<&MeshDisplacement>) -> Vec<f32> {
        let needed = |form: &dyn Fn([Vec3; 4]) -> f32, curve: u32| {
            let [a, b] = self.curves.curves[curve as usize].points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve as usize];
            form([a, ab, ba, b])
        };
        let largest = |form: &dyn Fn([Vec3; 4]) -> f32, curves: &[u32]| {
            (curves[0]..curves[1]).map(|c| needed(form, c)).fold(1.0, f32::max)
        };
        let edge = |(index, curves): (u32, &[u32])| {
            let Inputs { tessellation: Tessellation { factor, pixels, near, far, .. }, ref view } = *inputs;
            let factor = match inputs.tessellation.lod {
                Lod::Uniform => factor,
                Lod::Paper => largest(&|net| paper_edge_factor(view, pixels, net), curves),
                Lod::EdgeLength => largest(&|net| edge_length_factor(view, pixels, net), curves),
                Lod::Distance => largest(&|net| distance_factor(view, factor, near, far, net), curves),
                Lod::Error => return self.error_factor(inputs, displacement, index, Maps::All),
            };
            if inputs.tessellation.partitioning == Partitioning::Pow2 { round_pow2(factor) } else { factor }
        };
        (0..).zip(self.curves.factor_curves.windows(2)).map(edge).collect()
    }

    /// Returns the factor that LOD by error gives to an edge: for its curves and, with displacement, for the heights of
    /// `maps`.
    fn error_factor(&self, inputs: &Inputs, displacement: Option<&MeshDisplacement>, factor: u32, maps: Maps) -> f32 {
        let share = if displacement.is_some() { SURFACE_SHARE } else { 1.0 };
        let tolerance = EDGE_SHARE * (inputs.tessellation.tolerance * share);
        let needed = |curve: u32| {
            let points = self.curves.curves[curve as usize].points;
            let [a, b] = points.map(|p| self.topology.points[p as usize]);
            let [ab, ba] = self.curve_nets[curve as usize];
            let net = [a, ab, ba, b];
            let is_flat = inputs.tessellation.surface == Surface::Flat;
            let own = if is_flat { 1.0 } else { edge_error_factor(&inputs.view, tolerance, net) };
            displacement
                .map_or(own, |displacement| own.max(displacement.edge_factor(inputs, factor, maps, points, net)))
        };
        let curves = &self.curves.factor_curves[factor as usize..factor as usize + 2];
        nesting_factor(inputs.tessellation.partitioning, (curves[0]..curves[1]).map(needed).fold(1.0, f32::max))
    }

    /// Returns the inside factor that a patch's heights need: the largest factor of its sides. A side whose factor
    /// depends on other maps too counts with the factor that the patch's own map needs there.
    fn heights_inside(&self, inputs: &Inputs, displacement: &MeshDisplacement, patch: u32, sides: [f32; 3]) -> f32 {
        let own = |k: usize| {
            let factor = self.curves.factor(self.topology, self.topology.patches[patch as usize].sides[k]);
            let maps = displacement.own_maps(patch, factor);
            maps.map_or(sides[k], |maps| self.error_factor(inputs, Some(displacement), factor, maps))
        };
        own(0).max(own(1)).max(own(2))
    }

    /// Returns the factors that the hull shader writes for a patch. The sides' factors are in the order of the
    /// convention.
    ///
    /// The inside factor is the largest of the three, or under LOD by error the one that the patch needs. The latter
    /// takes each edge's factor by the opposite corner, whatever the convention.
    pub(super) fn hull_factors(
        &self,
        inputs: &Inputs,
        displacement: Option<&MeshDisplacement>,
        edge_factors: &[f32],
        patch: u32,
        net: &ControlNet,
    ) -> HullFactors {
        let Inputs { tessellation: Tessellation { lod, surface, tolerance, partitioning, .. }, ref view } = *inputs;
        let sides = self.topology.patches[patch as usize].sides;
        let sides = sides.map(|side| edge_factors[self.curves.factor(self.topology, side) as usize]);
        let by_heights = displacement.filter(|_| lod == Lod::Error);
        let by_heights = by_heights.map(|displacement| self.heights_inside(inputs, displacement, patch, sides));
        let inside = if lod == Lod::Error && surface != Surface::Flat {
            let tolerance = tolerance * if by_heights.is_some() { SURFACE_SHARE } else { 1.0 };
            let own = inside_error_factor(view, tolerance, partitioning, net, [sides[1], sides[2], sides[0]]);
            by_heights.map_or(own, |heights| own.max(heights))
        } else {
            by_heights.unwrap_or(sides[0].max(sides[1]).max(sides[2]))
        };
        HullFactors::of_sides(inputs.tessellation.convention, sides, inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Mesh, Shape, Topology};
    use crate::progress::Progress;
    use crate::tessellate::{LodView, Tessellation};
    use glam::{Mat4, Vec2};

    #[test]
    fn edges_use_three_quarters_of_the_tolerance() {
        let mesh: Mesh = Shape::Torus.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let tessellation = Tessellation {
            lod: Lod::Error,
            tolerance: 2.0,
            partitioning: Partitioning::Integer,
            ..Tessellation::default()
        };
        let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::splat(500.0)));
        let nets = ControlNets::new(&mesh, &topology, &inputs);
        let own = nets.edge_factors(&inputs, None);
        // Every edge of the torus has one curve.
        assert_eq!(own.len(), nets.curve_nets.len());
        for ((curve, [ab, ba]), factor) in nets.curves.curves.iter().zip(&nets.curve_nets).zip(&own) {
            let [a, b] = curve.points.map(|point| topology.points[point as usize]);
            let least = edge_error_factor(&inputs.view, 1.5, [a, *ab, *ba, b]);
            assert_eq!(*factor, nesting_factor(Partitioning::Integer, least), "{curve:?}");
        }
        assert!(own.iter().any(|&factor| factor > 2.0), "{own:?}");
    }
}
