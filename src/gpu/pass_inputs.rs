//! What the passes over a mesh are bound to.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use super::arena::Arena;
use super::compute_pipeline::{BoundPass, ComputePipeline, Pass, Step, Workgroups};
use super::mesh_buffers::MeshBuffers;
use super::pipelines::{ComputePipelines, grid};
use super::relief_buffers::HeightImages;
use super::slab::SlabBuffers;
use super::user_functions::USER_PREFIX;
use super::{Gpu, GpuError};

/// What passes are bound to.
#[derive(Clone, Copy)]
pub(super) struct PassInputs<'a> {
    pub gpu: &'a Gpu,
    pub pipelines: &'a ComputePipelines,
    pub mesh: &'a MeshBuffers,
    /// A [`super::layout::Params`].
    pub params: &'a wgpu::Buffer,
    /// Hull factors that were given in place of LOD's, one for each patch.
    pub given: &'a wgpu::Buffer,
    pub arena: &'a Arena,
    /// None without heights.
    pub images: Option<&'a HeightImages>,
    /// Where passes that are bound already are.
    pub bound: &'a BoundPasses,
    /// That of a pass over a slab.
    pub slab: Option<&'a SlabBuffers>,
    /// Buffers that a pass has beside those, or in place of them, by their names in WGSL.
    pub own: &'a [(&'static str, &'a wgpu::Buffer)],
}

/// Passes that are bound. They belong to one set of buffers: when one of those is replaced, so must this be.
#[derive(Default)]
pub(super) struct BoundPasses(Mutex<HashMap<Pass, BoundPass>>);

impl<'a> PassInputs<'a> {
    /// A pass, bound when it is first requested.
    ///
    /// # Errors
    /// The pipeline can't be made: out of memory, or a lost device.
    pub(super) fn bound(&self, pass: Pass) -> Result<BoundPass, GpuError> {
        self.bound_by(&self.pipelines.get(pass))
    }

    /// The same by a pipeline of the user's own.
    ///
    /// # Errors
    /// Those of [`Self::bound`].
    pub(super) fn bound_by(&self, pipeline: &ComputePipeline) -> Result<BoundPass, GpuError> {
        // What is behind the lock is whole even if a thread panicked while it held it. Nothing is made while it is held.
        let lock = || self.bound.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bound) = lock().get(&pipeline.pass) {
            return Ok(bound.clone());
        }
        let bound = pipeline.bind(self.gpu, |name| self.resource(name))?;
        lock().insert(pipeline.pass, bound.clone());
        Ok(bound)
    }

    /// A pass with an invocation for each of so many items.
    ///
    /// # Errors
    /// Those of [`Self::bound`].
    pub(super) fn over(&self, pass: Pass, items: u32) -> Result<Step, GpuError> {
        Ok(Step { bound: self.bound(pass)?, workgroups: Workgroups::Grid(grid(items)) })
    }

    /// What a variable of a pass stands for.
    fn resource(&self, name: &str) -> Option<wgpu::BindingResource<'a>> {
        match name {
            "heights" => Some(wgpu::BindingResource::TextureView(&self.images?.view)),
            name => self.buffer(name.strip_prefix(USER_PREFIX).unwrap_or(name)).map(wgpu::Buffer::as_entire_binding),
        }
    }

    fn buffer(&self, name: &str) -> Option<&'a wgpu::Buffer> {
        if let Some((_, own)) = self.own.iter().find(|(own, _)| *own == name) {
            return Some(own);
        }
        let (mesh, slab) = (self.mesh, self.slab);
        Some(match name {
            "params" => self.params,
            "given_factors" | "user_factors" => self.given,
            "points" => &mesh.points,
            "corners" | "corner_words" | "corner_attributes" => &mesh.corners,
            "corner_details" => &mesh.corner_details,
            "patches" | "patch_words" => &mesh.patches,
            "curves" => &mesh.curves,
            "curve_sides" => &mesh.curve_sides,
            "curve_nets" | "curve_net_words" => &mesh.curve_nets,
            "factor_curves" => &mesh.factor_curves,
            "edge_factors" => &mesh.edge_factors,
            "material_patches" => &mesh.material_patches,
            "search_workgroups" => &mesh.search_workgroups,
            "maps" => &mesh.maps,
            "slab" => &slab?.uniform,
            "patch_factors" => &slab?.patch_factors,
            "offsets" => &slab?.offsets,
            "chunks" => &slab?.chunks,
            "emit_args" => &slab?.emit_args,
            "draw_args" => &slab?.draw_args,
            "vertex_halves" => &self.arena.vertices,
            "indices" => &self.arena.indices,
            name => &mesh.relief.iter().find(|(own, _)| *own == name)?.1,
        })
    }
}
