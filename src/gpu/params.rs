//! The parameters that passes read, from a tessellation's inputs.

use super::MeshBuffers;
use super::layout::{LOD_GIVEN, LodView, Params};
use super::user_lod::Given;
use geometry::mesh::Mesh;
use geometry::tessellate::{self, Clip, Inputs, Lod, LodReads, Surface};

/// The parameters for these inputs. A parameter that has no effect under them is 0, so that a change of it recomputes nothing.
/// `given` is what takes the place of LOD. `culls_back`: patches that face away are left out.
pub(super) fn params_of(
    inputs: &Inputs,
    mesh: &Mesh,
    buffers: &MeshBuffers,
    given: Option<&Given>,
    culls_back: bool,
) -> Params {
    let lod = if given.is_some() { None } else { Some(inputs.tessellation.lod) };
    let reads = lod.map_or_else(LodReads::default, Lod::reads);
    let by_shader = matches!(given, Some(Given::Shader(_)));
    let looks = reads.view || by_shader || inputs.tessellation.clip != Clip::Off || culls_back;
    let view = LodView {
        clip_from_object: inputs.view.clip_from_object.to_cols_array_2d(),
        half_viewport: inputs.view.half_viewport.to_array(),
        reach: tessellate::displacement_reach(mesh, inputs),
        _pad: 0.0,
        eye: inputs.view.eye.to_array(),
        radius: inputs.view.radius,
    };
    let heights = tessellate::displacing_heights(mesh, inputs);
    let amount =
        heights.filter(|heights| heights.follow_settings()).map(|heights| tessellate::usual_amount(heights, inputs));
    let surface = inputs.tessellation.surface;
    Params {
        view: if looks { view } else { bytemuck::Zeroable::zeroed() },
        factor: if reads.factor { inputs.tessellation.factor } else { 0.0 },
        pixels_per_segment: if reads.pixels { inputs.tessellation.pixels } else { 0.0 },
        surface: inputs.evaluated_surface(mesh) as u32,
        partitioning: inputs.tessellation.partitioning as u32,
        lod: lod.map_or(LOD_GIVEN, |lod| lod as u32),
        clip: inputs.tessellation.clip as u32,
        point_count: buffers.point_count,
        patch_count: buffers.patch_count,
        factor_count: buffers.factor_count,
        curve_count: buffers.curve_count,
        edges: inputs.tessellation.edges as u32,
        tolerance: if reads.tolerance { inputs.tessellation.tolerance } else { 0.0 },
        near: if reads.distances { inputs.tessellation.near } else { 0.0 },
        far: if reads.distances { inputs.tessellation.far } else { 0.0 },
        culls_back: u32::from(culls_back),
        convention: inputs.tessellation.convention as u32,
        alpha: if inputs.surfaces(mesh).any(Surface::is_phong) { inputs.tessellation.alpha } else { 0.0 },
        normals: inputs.tessellation.normals as u32,
        displacement: heights.map_or(0, |_| inputs.tessellation.displacement as u32),
        height_scale: amount.map_or(0.0, |amount| amount.scale),
        midlevel: amount.map_or(0.0, |amount| amount.midlevel),
        chosen_surface: surface as u32,
        _pad: [0; 2],
    }
}
