//! The tessellation factors that LOD gives to the edges and patches of a mesh, on the CPU: what
//! `shaders/pass_factors.wgsl`, `shaders/pass_requests.wgsl` and `shaders/pass_uniform.wgsl` compute.

use glam::Vec3;

use super::control_nets::ControlNets;
use super::factors::base_factor;
use super::flat_patch::{line_error, normals_agree, plane_error};
use super::hull_factors::inside_of_base;
use super::least_factors::{
    BEYOND_LAST, ChosenFactors, FactorSearch, SearchGoal, fewest_triangles, least_edge_factor, requests_again,
    uniform_suffices, whole_segments,
};
use super::least_rows::{fewest_rows, rows_request_again};
use super::mesh_displacement::MeshDisplacement;
use super::piece_error::{SeenPatch, heights_need, may_slide, seen_patch, seen_relief};
use super::{
    HullFactors, Inputs, Lod, Tessellation, distance_factor, edge_length_factor, last_factor, paper_edge_factor,
    process, triangle_count,
};
use crate::mesh::{Mesh, Topology};

/// The factors that LOD gives to a mesh.
pub(super) struct MeshFactors {
    /// One for each edge; with edges as published, one for each curve.
    pub edges: Vec<f32>,
    /// The inside factors of patches under LOD by error; empty under any other LOD, which takes the largest of the sides'.
    insides: Vec<f32>,
}

/// Returns how often patches may ask: once, and again as long as factors change. A patch has no more rows than its edges have
/// segments, so that under rows patches more often need more than what their neighbours have requested.
pub fn rounds(has_rows: bool) -> u32 {
    if has_rows { 5 } else { 4 }
}

/// What LOD computes a mesh's factors from: its control nets, and what displaces it with these inputs.
pub(super) struct MeshLod<'a> {
    pub nets: ControlNets<'a>,
    pub inputs: Inputs,
    pub displacement: Option<MeshDisplacement<'a>>,
}

impl<'a> MeshLod<'a> {
    pub(super) fn new(mesh: &'a Mesh, topology: &'a Topology, inputs: &Inputs) -> Self {
        Self::from_nets(ControlNets::new(mesh, topology, inputs), inputs)
    }

    pub(super) fn from_nets(nets: ControlNets<'a>, inputs: &Inputs) -> Self {
        Self { displacement: MeshDisplacement::new(&nets, inputs), nets, inputs: *inputs }
    }

    /// Returns the factors that LOD gives: to each edge the largest that any of its curves needs, or under LOD by error that
    /// any of its patches requests. With edges as published, each curve has its own factor.
    pub(super) fn mesh_factors(&self) -> MeshFactors {
        if self.inputs.tessellation.lod.is_by_error() {
            return self.factors_by_error();
        }
        let of_curve = |curve: u32| {
            let Tessellation { factor, pixels, near, far, lod, .. } = self.inputs.tessellation;
            let (net, detail) = (self.nets.curve_points(curve), self.nets.detail_of_curve(curve));
            let view = &self.inputs.view.magnified(detail);
            match lod {
                Lod::Uniform => factor * detail,
                Lod::Paper => paper_edge_factor(view, pixels, net),
                Lod::EdgeLength => edge_length_factor(view, pixels, net),
                Lod::Distance => distance_factor(view, factor * detail, near, far, net),
                Lod::Error => 1.0,
            }
        };
        let edge = |curves: &[u32]| {
            let factor = (curves[0]..curves[1]).map(of_curve).fold(1.0, f32::max);
            self.inputs.tessellation.partitioning.hull_factor(factor)
        };
        MeshFactors { edges: self.nets.curves.factor_curves.windows(2).map(edge).collect(), insides: Vec::new() }
    }

    /// Returns factors of edges, and beside them what LOD gives to insides.
    pub(super) fn factors_beside(&self, edges: &[f32]) -> MeshFactors {
        let inside = |patch| self.beside(patch, self.nets.edges_of_patch(edges, patch), 0.0).inside;
        let patches = 0..self.nets.topology.patches.len() as u32;
        let insides =
            if self.inputs.tessellation.lod.is_by_error() { patches.map(inside).collect() } else { Vec::new() };
        MeshFactors { edges: edges.to_vec(), insides }
    }

    /// Returns the factors of LOD by error: to each edge the largest that its patches request. Patches that are left out
    /// ask, too: what others look like doesn't depend on it.
    ///
    /// Beside factors that other patches requested, a patch may need a much larger inside factor than it has chosen, or find
    /// none that suffices. Such patches request again, for no less than what their edges have.
    fn factors_by_error(&self) -> MeshFactors {
        let partitioning = self.inputs.tessellation.partitioning;
        let edges = 0..self.nets.curves.factor_curves.len() as u32 - 1;
        let least: Vec<f32> = edges.map(|factor| self.least_edge_factor(factor)).collect();
        let mut requested = vec![whole_segments(partitioning, 1.0); least.len()];
        let request = |patch: u32, own: &ChosenFactors, requested: &mut [f32]| {
            for (k, own) in [1, 2, 0].into_iter().zip(own.requests(partitioning)) {
                let factor = self.nets.patch_factor(patch, k) as usize;
                requested[factor] = requested[factor].max(own);
            }
        };
        let mut chosen = Vec::new();
        for patch in 0..self.nets.topology.patches.len() as u32 {
            let seen = self.seen_patch(patch);
            let least = self.first_least(patch, &seen, |factor| least[factor as usize]);
            let own = self.fewest(&seen, least, 0.0, SearchGoal::Requests);
            request(patch, &own, &mut requested);
            chosen.push(own);
        }
        let rounds = rounds(partitioning.has_rows());
        for round in 1..=rounds {
            let before = requested.clone();
            for (patch, chosen) in (0..).zip(&mut chosen) {
                let edges = self.nets.edges_of_patch(&before, patch);
                if edges == chosen.edges {
                    continue;
                }
                let beside = self.beside(patch, edges, chosen.inner);
                let again = match partitioning.has_rows() {
                    true => rows_request_again(chosen, edges, beside.inside),
                    false => requests_again(chosen.inside, beside.inside),
                };
                let requests = !self.is_exact() && round < rounds && again;
                *chosen = beside;
                if requests {
                    let seen = self.seen_patch(patch);
                    let own = self.fewest(&seen, edges, chosen.inner, SearchGoal::Requests);
                    request(patch, &own, &mut requested);
                    if own.inside != BEYOND_LAST {
                        *chosen = own;
                    }
                }
            }
            if requested == before {
                break;
            }
        }
        let insides: Vec<f32> = chosen.iter().map(|chosen| chosen.inside).collect();
        let factors = MeshFactors { edges: requested, insides };
        let Some(factor) = self.uniform_factor(&factors) else { return factors };
        let beside = |(patch, chosen): (u32, ChosenFactors)| self.beside(patch, [factor; 3], chosen.inner).inside;
        MeshFactors { edges: vec![factor; least.len()], insides: (0..).zip(chosen).map(beside).collect() }
    }

    /// Returns the least factor that keeps LOD by error's tolerance if all edges have it, if that takes fewer triangles than
    /// these factors.
    fn uniform_factor(&self, factors: &MeshFactors) -> Option<f32> {
        let Tessellation { partitioning, tolerance, .. } = self.inputs.tessellation;
        if self.is_exact() {
            return None;
        }
        let patches = 0..self.nets.topology.patches.len() as u32;
        let of_patch = |patch| {
            let [u, v, w] = self.nets.edges_of_patch(&factors.edges, patch);
            u64::from(triangle_count(process(partitioning, [u, v, w], factors.insides[patch as usize])))
        };
        let triangles: u64 = patches.clone().map(of_patch).sum();
        let is_candidate = |factor: &f32| {
            let each = triangle_count(process(partitioning, [*factor; 3], *factor));
            let exists = *factor <= last_factor(partitioning) && whole_segments(partitioning, *factor) == *factor;
            exists && triangles > u64::from(each) * patches.len() as u64
        };
        // If one triangle were enough for every patch, none would have more.
        let mut left: Vec<f32> = (2..=64).map(|factor| factor as f32).filter(is_candidate).collect();
        for patch in patches.clone() {
            if left.is_empty() {
                break;
            }
            let seen = self.seen_patch(patch);
            left.retain(|&factor| uniform_suffices(&seen, tolerance, partitioning, factor));
        }
        left.first().copied()
    }

    /// Returns a patch as it is seen.
    pub(super) fn seen_patch(&self, patch: u32) -> SeenPatch {
        let net = self.nets.patch(patch);
        let view = &self.inputs.view.magnified(self.nets.topology.detail_of(self.nets.mesh, patch));
        let mut seen = seen_patch(view, &net);
        if self.is_plain(patch) {
            seen.off_plane = plane_error(view, &net);
            seen.off_line = line_error(view, &net);
        }
        if let Some((directions, scale, relief)) =
            self.displacement.as_ref().map(|displacement| displacement.relief(patch))
        {
            seen.relief = seen_relief(view, seen.scale, directions, scale, relief);
        }
        seen
    }

    /// Returns the factors that a patch requests at least, of the edges U == 0, V == 0 and W == 0: what `least` returns for
    /// each. Where points may slide along an edge, what the edge needs at the same places doesn't count.
    pub(super) fn first_least(&self, patch: u32, seen: &SeenPatch, least: impl Fn(u32) -> f32) -> [f32; 3] {
        let Tessellation { partitioning, tolerance, .. } = self.inputs.tessellation;
        if may_slide(seen, tolerance) {
            return [whole_segments(partitioning, 1.0); 3];
        }
        let heights = heights_need(seen, tolerance, partitioning);
        let of_side = |k: usize| {
            let own = heights[k].min(last_factor(partitioning));
            least(self.nets.patch_factor(patch, k)).max(whole_segments(partitioning, own))
        };
        [1, 2, 0].map(of_side)
    }

    /// Returns the factors with which a patch keeps LOD by error's tolerance with the fewest triangles. `least` are the least that
    /// the edges U == 0, V == 0 and W == 0 may get, or those that they have, and `inner` is as in [`ChosenFactors`].
    pub(super) fn fewest(&self, seen: &SeenPatch, least: [f32; 3], inner: f32, wanted: SearchGoal) -> ChosenFactors {
        let Tessellation { partitioning, tolerance, .. } = self.inputs.tessellation;
        if self.is_exact() {
            return ChosenFactors { edges: least, inside: whole_segments(partitioning, 1.0), inner };
        }
        let [.., inside] = heights_need(seen, tolerance, partitioning);
        let sought = FactorSearch { least, inside, inner, wanted };
        match partitioning.has_rows() {
            true => fewest_rows(seen, tolerance, &sought),
            false => fewest_triangles(seen, tolerance, partitioning, &sought),
        }
    }

    /// Returns the same beside the factors that the edges have.
    fn beside(&self, patch: u32, edges: [f32; 3], inner: f32) -> ChosenFactors {
        self.fewest(&self.seen_patch(patch), edges, inner, SearchGoal::Given)
    }

    /// Returns the factors with which a patch alone would keep the tolerance with the fewest triangles: its minimum.
    pub(super) fn minimum_factors(&self, patch: u32, seen: &SeenPatch) -> ChosenFactors {
        let least = self.first_least(patch, seen, |factor| self.least_edge_factor(factor));
        self.fewest(seen, least, 0.0, SearchGoal::Own)
    }

    /// Returns whether nothing on a patch depends on where its points slide.
    fn is_plain(&self, patch: u32) -> bool {
        let material = self.nets.mesh.materials.get(self.nets.topology.material_of(patch));
        let corners = self.nets.topology.patch_corners(patch);
        self.displacement.is_none()
            && material.is_none_or(|material| material.texture.is_none())
            && normals_agree(corners.map(|corner| self.nets.mesh.corners[corner as usize].normal))
    }

    /// Whether triangles of any size are the surface.
    fn is_exact(&self) -> bool {
        self.nets.surface.is_flat() && self.displacement.is_none()
    }

    /// Returns the least factor that an edge may get, for its curves.
    pub(super) fn least_edge_factor(&self, factor: u32) -> f32 {
        let Tessellation { partitioning, tolerance, .. } = self.inputs.tessellation;
        let curves = &self.nets.curves.factor_curves[factor as usize..factor as usize + 2];
        let own = |curve: u32| match self.nets.surface.is_flat() {
            true => 1.0,
            false => {
                let view = self.inputs.view.magnified(self.nets.detail_of_curve(curve));
                least_edge_factor(&view, tolerance, partitioning, self.nets.curve_points(curve))
            }
        };
        whole_segments(partitioning, (curves[0]..curves[1]).map(own).fold(1.0, f32::max))
    }

    /// Returns the factors that the hull shader writes for a patch. The sides' factors are in the order of the
    /// convention. The inside factor is the largest of the three, or that of LOD by error. Under rows it is that of the base.
    pub(super) fn hull_factors(&self, factors: &MeshFactors, patch: u32) -> HullFactors {
        let sides = [0, 1, 2].map(|side| factors.edges[self.nets.patch_factor(patch, side) as usize]);
        let Tessellation { convention, partitioning, .. } = self.inputs.tessellation;
        let written = HullFactors::from_sides(convention, sides, sides[0].max(sides[1]).max(sides[2]));
        let found = factors.insides.get(patch as usize).copied();
        let inside = match (partitioning.has_rows(), found) {
            (true, Some(inside)) => inside_of_base(convention, inside),
            (true, None) => base_factor(written.edges),
            (_, found) => found.unwrap_or(written.inside),
        };
        HullFactors { inside, ..written }
    }
}

impl ControlNets<'_> {
    /// Returns the four control points of a curve, in object units.
    pub(super) fn curve_points(&self, curve: u32) -> [Vec3; 4] {
        let [a, b] = self.curves.curves[curve as usize].points.map(|p| self.topology.points[p as usize]);
        let [ab, ba] = self.curve_nets[curve as usize];
        [a, ab, ba, b]
    }

    /// Returns how many times as fine as others LOD makes a curve.
    pub(super) fn detail_of_curve(&self, curve: u32) -> f32 {
        self.curves.styles.get(curve as usize).map_or(1.0, |style| style.detail)
    }

    /// Returns the factors of the edges U == 0, V == 0 and W == 0 of a patch. LOD takes each by the opposite corner, whatever
    /// the convention.
    fn edges_of_patch(&self, factors: &[f32], patch: u32) -> [f32; 3] {
        [1, 2, 0].map(|side| factors[self.patch_factor(patch, side) as usize])
    }

    /// Returns the index of the factor of a patch's side.
    pub(super) fn patch_factor(&self, patch: u32, side: usize) -> u32 {
        self.curves.factor(self.topology, self.topology.patches[patch as usize].sides[side])
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec2};

    use super::*;
    use crate::mesh::Shape;
    use crate::tessellate::{LodView, Partitioning};

    #[test]
    fn all_edges_get_the_least_factor_that_suffices_if_patches_have_more_triangles() {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::new(&mesh);
        let seen = Mat4::from_scale(Vec3::splat(0.5)) * Mat4::from_rotation_y(0.7);
        let own = Tessellation {
            lod: Lod::Error,
            tolerance: 0.5,
            partitioning: Partitioning::Integer,
            ..Tessellation::default()
        };
        let inputs = Inputs::new(&own, LodView::new(seen, Vec2::splat(300.0)));
        let lod = MeshLod::new(&mesh, &topology, &inputs);
        let given = |factor| MeshFactors {
            edges: vec![factor; topology.edges.len()],
            insides: vec![factor; topology.patches.len()],
        };
        let suffices = |factor| {
            let mut patches = 0..topology.patches.len() as u32;
            let of_patch = |patch| uniform_suffices(&lod.seen_patch(patch), own.tolerance, own.partitioning, factor);
            patches.all(of_patch)
        };
        let factor = lod.uniform_factor(&given(16.0)).expect("some factor suffices");
        assert!(factor > 2.0 && suffices(factor) && (2..factor as u32).all(|less| !suffices(less as f32)), "{factor}");
        assert_eq!(lod.uniform_factor(&given(factor)), None, "it has no fewer triangles");
        assert_eq!(lod.uniform_factor(&given(factor + 1.0)), Some(factor));
    }
}
