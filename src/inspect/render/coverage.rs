//! Removes from a chunk, before it is drawn, the triangles that cover no sample of the picture. Where triangles are smaller than
//! pixels, most triangles cover none, and each takes the rasteriser as long as one that is seen. The picture stays the same.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use geometry::tessellate::CoverageView;
use gpu::layout::DrawArgs;
use gpu::{
    ChunkBuffers, ComputePipeline, Gpu, GpuError, RecordPasses, Recorder, ShaderModule, WORKGROUP, empty, grid,
    uniform_buffer,
};

/// How many triangles each workgroup tests; `TILE` in `shaders/pass_coverage.wgsl`.
pub(super) const TILE: u32 = 2048;

/// What the passes over one chunk read as `sieve`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Sieve {
    pub view: CoverageView,
    pub triangle_count: u32,
    pub material_count: u32,
    /// Index of the chunk's first draw arguments among those of its slab.
    pub first_draw: u32,
    pub _pad: u32,
}

/// The pipelines of these passes, each made when it is first needed.
pub(super) fn coverage_pipelines() -> [ComputePipeline; 3] {
    let module = Arc::new(ShaderModule::new("pass_coverage"));
    let entry_points = ["coverage_marks_main", "coverage_starts_main", "coverage_keep_main"];
    entry_points.map(|entry_point| ComputePipeline::new(&module, entry_point))
}

/// Buffers for the triangles that are kept of a chunk.
pub(super) struct Coverage {
    marks: wgpu::Buffer,
    tile_starts: wgpu::Buffer,
    /// Three for each kept triangle, in the order in which the triangles were emitted.
    pub indices: wgpu::Buffer,
    /// A [`DrawArgs`] for each material.
    pub draw_args: wgpu::Buffer,
    capacity: u32,
}

impl Coverage {
    /// Buffers for as many triangles as this chunk has, or for up to twice as many if later chunks may have more.
    ///
    /// # Errors
    /// The buffers are larger than the adapter can bind.
    pub(super) fn new(gpu: &Gpu, chunk: &ChunkBuffers, material_count: u32) -> Result<Self, GpuError> {
        let most = (chunk.indices.size() / size_of::<[u32; 3]>() as u64) as u32;
        let capacity = chunk.chunk.triangle_count.next_power_of_two().min(most);
        let tiles = capacity.div_ceil(TILE) as usize;
        Ok(Self {
            marks: empty::<[u32; TILE as usize / 32]>(gpu, "coverage marks", tiles)?,
            tile_starts: empty::<u32>(gpu, "coverage tiles", tiles + 1)?,
            indices: empty::<[u32; 3]>(gpu, "covering triangles", capacity as usize)?,
            draw_args: empty::<DrawArgs>(gpu, "covering draws", material_count as usize)?,
            capacity,
        })
    }

    /// Whether the buffers are large enough for a chunk.
    pub(super) fn has_room(&self, chunk: &ChunkBuffers) -> bool {
        chunk.chunk.triangle_count <= self.capacity
    }

    /// The size of all buffers.
    pub(super) fn bytes(&self) -> u64 {
        [&self.marks, &self.tile_starts, &self.indices, &self.draw_args].iter().map(|buffer| buffer.size()).sum()
    }

    /// Records the passes that keep the triangles of a chunk that may be seen. The chunk must fit: see [`Self::has_room`].
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn keep(
        &self,
        recorder: &mut Recorder,
        pipelines: &[ComputePipeline; 3],
        gpu: &Gpu,
        chunk: &ChunkBuffers,
        view: CoverageView,
    ) -> Result<(), GpuError> {
        let row = size_of::<DrawArgs>() as u64;
        let sieve = Sieve {
            view,
            triangle_count: chunk.chunk.triangle_count,
            material_count: (self.draw_args.size() / row) as u32,
            first_draw: (chunk.draw_args_offset / row) as u32,
            _pad: 0,
        };
        let sieve = uniform_buffer(gpu, "coverage", bytemuck::bytes_of(&sieve));
        let [(vertices, _), _] = chunk.vertices();
        let buffer = |name: &str| {
            let buffer = match name {
                "sieve" => &sieve,
                "vertex_halves" => vertices,
                "indices" => chunk.indices,
                "marks" => &self.marks,
                "tile_starts" => &self.tile_starts,
                "draw_args" => chunk.draw_args,
                "kept_args" => &self.draw_args,
                _ => &self.indices,
            };
            Some(buffer.as_entire_binding())
        };
        let [marks, starts, keep] = pipelines.each_ref().map(|pipeline| pipeline.bind(gpu, buffer));
        let (marks, starts, keep) = (marks?, starts?, keep?);
        let tiles = grid(chunk.chunk.triangle_count.div_ceil(TILE) * WORKGROUP);
        recorder.compute("coverage", |pass| {
            marks.dispatch(pass, tiles);
            starts.dispatch(pass, [1, 1, 1]);
            keep.dispatch(pass, tiles);
        });
        Ok(())
    }
}
