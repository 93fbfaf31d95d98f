//! The passes that run over a whole mesh, each bound to the mesh's buffers when it first runs.

use std::sync::{Arc, OnceLock};

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::lazy::get_or_try;
use super::mesh_buffers::MeshBuffers;
use super::own_lod::LodShader;
use super::own_lod_passes::OwnLodPasses;
use super::own_surface::SurfaceShader;
use super::own_surface_passes::OwnSurfacePasses;
use super::relief_buffers::{HeightImages, ReliefBuffers};
use super::search_passes::SearchPasses;

/// These belong to one set of mesh buffers: when those are replaced, so must this be.
#[derive(Default)]
pub(super) struct MeshPasses {
    curve_nets: OnceLock<BoundPass>,
    centers: OnceLock<BoundPass>,
    directions: OnceLock<BoundPass>,
    frames: OnceLock<BoundPass>,
    edge_factors: OnceLock<BoundPass>,
    heights_inside: OnceLock<BoundPass>,
    factor_levels: OnceLock<BoundPass>,
    point_levels: OnceLock<BoundPass>,
    own_lod: OnceLock<OwnLodPasses>,
    own_surface: OnceLock<OwnSurfacePasses>,
    pub searches: SearchPasses,
}

type Bound<'a> = Result<&'a BoundPass, GpuError>;

impl MeshPasses {
    /// The control points of every curve.
    pub(super) fn curve_nets(&self, on: &PassInputs) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.curves),
            (4, &mesh.curve_sides),
            (6, &mesh.curve_nets),
        ];
        BoundPass::once(&self.curve_nets, on.gpu, &on.pipelines.curve_nets, &buffers)
    }

    /// The control points of every curve by a function of the user's own, which is always the same.
    pub(super) fn own_surface(
        &self,
        on: &PassInputs,
        shader: &Arc<SurfaceShader>,
        report: &wgpu::Buffer,
    ) -> Result<&OwnSurfacePasses, GpuError> {
        get_or_try(&self.own_surface, || OwnSurfacePasses::new(on, shader, report))
    }

    /// The control point at the centre of every patch.
    pub(super) fn centers(&self, on: &PassInputs) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [(0, on.params), (1, &mesh.points), (5, &mesh.patches), (6, &mesh.curve_nets)];
        BoundPass::once(&self.centers, on.gpu, &on.pipelines.centers, &buffers)
    }

    /// The direction in which displacement moves every point.
    pub(super) fn directions(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let buffers =
            [(0, on.params), (2, &on.mesh.corners), (6, &on.mesh.shares), (7, &relief.part_starts), (8, &relief.parts)];
        BoundPass::once(&self.directions, on.gpu, &on.pipelines.directions, &buffers)
    }

    /// How texture coordinates change at every corner.
    pub(super) fn frames(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.patches),
            (6, &mesh.shares),
            (7, &relief.corner_ranges),
            (9, &relief.corner_patches),
        ];
        BoundPass::once(&self.frames, on.gpu, &on.pipelines.frames, &buffers)
    }

    /// LOD's factor of every edge.
    pub(super) fn edge_factors(&self, on: &PassInputs) -> Bound<'_> {
        BoundPass::once(
            &self.edge_factors,
            on.gpu,
            &on.pipelines.edge_factors,
            &factor_buffers(on.mesh, on.params, &on.mesh.edge_factors),
        )
    }

    /// The factors of every patch by functions of the user's own, which are always the same.
    pub(super) fn own_lod(
        &self,
        on: &PassInputs,
        shader: &Arc<LodShader>,
        report: &wgpu::Buffer,
    ) -> Result<&OwnLodPasses, GpuError> {
        get_or_try(&self.own_lod, || OwnLodPasses::new(on, shader, report))
    }

    /// The factor that the heights of every patch need inside it.
    pub(super) fn heights_inside(&self, on: &PassInputs) -> Bound<'_> {
        let edges = factor_buffers(on.mesh, on.params, &on.mesh.edge_factors);
        let buffers = [&edges[..], &[(7, &on.mesh.patches)]].concat();
        BoundPass::once(&self.heights_inside, on.gpu, &on.pipelines.heights_inside, &buffers)
    }

    /// The level at which heights are looked up on every edge.
    pub(super) fn factor_levels(&self, on: &PassInputs, images: &HeightImages) -> Bound<'_> {
        let mesh = on.mesh;
        let buffers = [
            (0, on.params),
            (1, &mesh.points),
            (2, &mesh.corners),
            (3, &mesh.patches),
            (4, &mesh.edge_factors),
            (5, on.given),
            (6, &mesh.shares),
            (21, &images.maps),
        ];
        BoundPass::once(&self.factor_levels, on.gpu, &on.pipelines.factor_levels, &buffers)
    }

    /// The level at which heights are looked up at every point.
    pub(super) fn point_levels(&self, on: &PassInputs, relief: &ReliefBuffers) -> Bound<'_> {
        let buffers = [(0, on.params), (6, &on.mesh.shares), (7, &relief.factor_starts), (9, &relief.factors)];
        BoundPass::once(&self.point_levels, on.gpu, &on.pipelines.point_levels, &buffers)
    }
}

/// What passes over edges read, and the factors that they write.
pub(super) fn factor_buffers<'a>(
    mesh: &'a MeshBuffers,
    params: &'a wgpu::Buffer,
    factors: &'a wgpu::Buffer,
) -> [(u32, &'a wgpu::Buffer); 8] {
    [
        (0, params),
        (1, &mesh.points),
        (2, &mesh.curves),
        (3, &mesh.curve_nets),
        (4, &mesh.factor_curves),
        (5, factors),
        (6, &mesh.shares),
        (22, &mesh.details),
    ]
}
