//! What the passes computed and emitted, read back.

use std::sync::atomic::Ordering;

use glam::Vec3;

use super::Engine;
use crate::measure::{EmittedChunk, PointsAgreement, RequestedFactors, Visitor};
use crate::render::Scene;
use geometry::progress::Progress;
use geometry::tessellate::{HullFactors, Inputs, PatchFactors, Tessellated, Tessellation, Vertex};
use gpu::layout::{Chunk, CurveNet};
use gpu::{Given, Gpu, GpuError, Readback, Timing, put_together, read_buffer, read_buffers, submit_untimed};

/// A chunk on its way back from the device.
pub struct CopiedChunk {
    first_patch: u32,
    vertex_bytes: usize,
    /// The first halves of its vertices, the second halves, and its triangles.
    pub readback: Readback,
}

impl CopiedChunk {
    /// Emits a chunk and requests it. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn start(gpu: &Gpu, scene: &mut Scene, index: usize) -> Result<Self, GpuError> {
        submit_untimed(gpu, |recorder| scene.tessellator.emit(recorder, index))?;
        let buffers = scene.tessellator.chunk(index);
        let Chunk { first_patch, vertex_count, triangle_count, .. } = buffers.chunk;
        let triangle_bytes = u64::from(triangle_count) * size_of::<[u32; 3]>() as u64;
        let [first, second] = buffers.vertices();
        let readback = Readback::start(gpu, [first, second, (buffers.indices, 0..triangle_bytes)]);
        Ok(Self { first_patch, vertex_bytes: vertex_count as usize * size_of::<Vertex>(), readback })
    }

    /// Gives the chunk, which must be here, to every visitor. `vertices` is where its vertices are put together, a list that may be used
    /// again. It may be called on any thread.
    ///
    /// # Errors
    /// The chunk isn't here, or the device was lost.
    pub fn visit(&self, vertices: &mut Vec<Vertex>, visitors: &mut [&mut dyn Visitor]) -> Result<(), GpuError> {
        self.readback.with_bytes(|bytes| {
            let (halves, indices) = bytes.split_at(self.vertex_bytes);
            put_together(halves, vertices);
            let chunk =
                EmittedChunk { first_patch: self.first_patch, vertices, triangles: bytemuck::cast_slice(indices) };
            visitors.iter_mut().for_each(|visitor| visitor.take(&chunk));
        })
    }
}

impl Engine {
    /// Walks once over everything that is emitted: each chunk is emitted, read back once, and given to every visitor. Reads
    /// nothing without visitors. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn visit(&self, scene: &mut Scene, visitors: &mut [&mut dyn Visitor]) -> Result<(), GpuError> {
        self.visit_watched(scene, visitors, &Progress::new())
    }

    /// Does the same, and reports how much was read. If `progress` is cancelled, the walk ends early.
    ///
    /// # Errors
    /// The same.
    pub fn visit_watched(
        &self,
        scene: &mut Scene,
        visitors: &mut [&mut dyn Visitor],
        progress: &Progress,
    ) -> Result<(), GpuError> {
        let chunks = if visitors.is_empty() { 0 } else { scene.tessellator.chunk_count() };
        // Of all chunks, since memory that is new takes longer than the copy.
        let mut vertices = Vec::new();
        let mut next = if chunks > 0 { Some(CopiedChunk::start(&self.gpu, scene, 0)?) } else { None };
        let mut index = 0;
        while let Some(mut chunk) = next.take() {
            chunk.readback.arrive(&self.gpu)?;
            self.chunks_read.fetch_add(1, Ordering::Relaxed);
            index += 1;
            // The device goes on while the visitors look at this one.
            if index < chunks && progress.check().is_ok() {
                next = Some(CopiedChunk::start(&self.gpu, scene, index)?);
            }
            chunk.visit(&mut vertices, visitors)?;
            progress.set(index as f32 / chunks as f32);
        }
        Ok(())
    }

    /// How many chunks of output this engine and its clones have read back so far.
    pub fn chunks_read(&self) -> u64 {
        self.chunks_read.load(Ordering::Relaxed)
    }

    /// The factors that every patch was emitted with.
    ///
    /// # Errors
    /// The device was lost.
    pub fn patch_factors(&self, scene: &Scene) -> Result<Vec<PatchFactors>, GpuError> {
        let item = size_of::<PatchFactors>() as u64;
        let parts = scene.tessellator.patch_factors().map(|(buffer, count)| (buffer, 0..u64::from(count) * item));
        Ok(bytemuck::pod_collect_to_vec(&read_buffers(&self.gpu, parts)?))
    }

    /// The factors that LOD, a file or an LOD shader gave, before the tessellator clamps and rounds them.
    ///
    /// # Errors
    /// The device was lost.
    pub fn requested_factors(&self, scene: &Scene) -> Result<RequestedFactors, GpuError> {
        let convention = scene.tessellator.convention();
        match scene.tessellator.given() {
            Some(Given::Factors(given)) => return Ok(RequestedFactors::given(convention, given)),
            Some(Given::Shader(_)) => return Ok(RequestedFactors::given(convention, &self.user_factors(scene)?)),
            None => {}
        }
        let (buffer, edges) = scene.tessellator.edge_factors();
        let factors = items(&self.gpu, buffer, scene.tessellator.buffers().factor_count)?;
        Ok(RequestedFactors::new(edges, convention, factors))
    }

    /// The factors that an LOD shader gave every patch, as it gave them; none without such a shader. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn user_factors(&self, scene: &Scene) -> Result<Vec<HullFactors>, GpuError> {
        let Some(buffer) = scene.tessellator.user_factors() else { return Ok(Vec::new()) };
        items(&self.gpu, buffer, scene.tessellator.buffers().patch_count)
    }

    /// How the control points that a surface shader gave the sides of every edge agree; none without such a shader. The counts
    /// must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn user_points_agreement(&self, scene: &Scene) -> Result<Option<PointsAgreement>, GpuError> {
        let (tessellator, topology) = (&scene.tessellator, scene.tessellator.topology());
        if tessellator.surface_shader().is_none() {
            return Ok(None);
        }
        let buffers = tessellator.buffers();
        let nets: Vec<CurveNet> = items(&self.gpu, &buffers.curve_nets, buffers.curve_count)?;
        let nets: Vec<_> = nets.iter().map(|net| [net.ab, net.ba].map(Vec3::from)).collect();
        let curves = buffers.grouping.curves(tessellator.mesh(), topology);
        Ok(Some(PointsAgreement::new(topology, &curves, &nets)))
    }

    /// The number of triangles that LOD by error emits at a tolerance of `tolerance_px` px, with all other inputs as they are;
    /// none if the tessellator hasn't enough segments for it. Subtriangulation has one number of segments everywhere, so
    /// that integer partitioning stands in for it. The scene is counted with `inputs` again when this returns.
    ///
    /// # Errors
    /// The device was lost.
    pub fn triangles_by_error(
        &self,
        scene: &mut Scene,
        inputs: &Inputs,
        tolerance_px: f32,
    ) -> Result<Option<u64>, GpuError> {
        let by_error = inputs.tessellation.by_error(tolerance_px);
        let given = scene.tessellator.given().cloned();
        if given.is_some() {
            scene.tessellator.give(None)?;
        }
        self.count(scene, &Inputs { tessellation: by_error, ..*inputs }, &mut Timing::Off)?;
        let (_, triangles) = scene.tessellator.totals();
        let is_enough = self.factors_capped(scene, &by_error)? == 0;
        if given.is_some() {
            scene.tessellator.give(given)?;
        }
        self.count(scene, inputs, &mut Timing::Off)?;
        Ok(is_enough.then_some(triangles))
    }

    /// The number of factors that request more segments than the partitioning has: of edges (sides, if factors are as
    /// published or given), and under LOD by error of insides. The counts must be known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    pub fn factors_capped(&self, scene: &Scene, tessellation: &Tessellation) -> Result<u64, GpuError> {
        let edges = self.requested_factors(scene)?.beyond(tessellation.partitioning);
        if !tessellation.used_lod().is_by_error() {
            return Ok(edges);
        }
        let written = scene.tessellator.hull_factors()?;
        Ok(edges + written.iter().filter(|factors| factors.inside_is_capped(tessellation.partitioning)).count() as u64)
    }

    /// The minimum triangle count of every patch: the fewest triangles with which it alone would keep the tolerance of LOD by error,
    /// whichever LOD is used. The counts must be known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    pub fn minimum(&self, scene: &mut Scene) -> Result<Vec<u32>, GpuError> {
        submit_untimed(&self.gpu, |recorder| scene.tessellator.record_minimum(recorder))?;
        let Some(buffer) = scene.tessellator.minimum() else { return Ok(Vec::new()) };
        items(&self.gpu, buffer, scene.tessellator.buffers().patch_count)
    }

    /// The whole tessellated mesh, read back. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_tessellated(&self, scene: &mut Scene) -> Result<Tessellated, GpuError> {
        let mut out = Tessellated {
            patch_factors: self.patch_factors(scene)?,
            edge_factors: self.requested_factors(scene)?.into_factors(),
            ..Tessellated::default()
        };
        self.visit(scene, &mut [&mut |chunk: &EmittedChunk| out.append(chunk.vertices, chunk.triangles)])?;
        Ok(out)
    }
}

/// Reads the first items of a buffer.
fn items<T: bytemuck::Pod>(gpu: &Gpu, buffer: &wgpu::Buffer, count: u32) -> Result<Vec<T>, GpuError> {
    let bytes = read_buffer(gpu, buffer, 0, u64::from(count) * size_of::<T>() as u64)?;
    // The bytes may not be aligned.
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}
