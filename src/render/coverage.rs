//! Leaves out of a chunk, before it is drawn, the triangles that cover no sample of the picture. Where triangles are smaller
//! than pixels those are most, and a rasteriser takes as long for each as for one that is seen. The picture is the same.

use bytemuck::{Pod, Zeroable};

use crate::gpu::layout::DrawArgs;
use crate::gpu::{
    ChunkBuffers, Gpu, GpuError, Recorder, bind_group, compute_pipeline, dispatch, empty, grid, read_buffer,
    shader_module, uniform_buffer,
};
use crate::tessellate::CoverageView;

/// Triangles that a workgroup takes; see `shaders/pass_coverage.wgsl`.
const TILE: u32 = 2048;

/// One chunk's.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Sieve {
    pub view: CoverageView,
    pub triangle_count: u32,
    pub material_count: u32,
    /// Which of the slab's arguments are the chunk's first.
    pub first_draw: u32,
    pub _pad: u32,
}

pub struct CoveragePipelines {
    marks: wgpu::ComputePipeline,
    starts: wgpu::ComputePipeline,
    keep: wgpu::ComputePipeline,
}

impl CoveragePipelines {
    pub fn new(gpu: &Gpu) -> Self {
        let module = shader_module(gpu, "coverage");
        Self {
            marks: compute_pipeline(gpu, &module, "coverage_marks_main"),
            starts: compute_pipeline(gpu, &module, "coverage_starts_main"),
            keep: compute_pipeline(gpu, &module, "coverage_keep_main"),
        }
    }
}

/// Room for what is kept of a chunk.
pub struct Coverage {
    marks: wgpu::Buffer,
    tile_starts: wgpu::Buffer,
    /// Three a triangle, in the order that they were emitted in.
    pub indices: wgpu::Buffer,
    /// One [`DrawArgs`] a material.
    pub draw_args: wgpu::Buffer,
    capacity: u32,
}

impl Coverage {
    /// Room for as many triangles as a chunk has, or up to twice as many if there could be.
    ///
    /// # Errors
    /// More than the adapter binds.
    pub fn new(gpu: &Gpu, chunk: &ChunkBuffers, material_count: u32) -> Result<Self, GpuError> {
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

    pub fn has_room(&self, chunk: &ChunkBuffers) -> bool {
        chunk.chunk.triangle_count <= self.capacity
    }

    pub fn bytes(&self) -> u64 {
        [&self.marks, &self.tile_starts, &self.indices, &self.draw_args].iter().map(|buffer| buffer.size()).sum()
    }

    /// How many triangles were kept when it was last used, waiting for it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn kept(&self, gpu: &Gpu) -> Result<u64, GpuError> {
        let bytes = read_buffer(gpu, &self.draw_args, 0, self.draw_args.size())?;
        let draws: Vec<DrawArgs> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(draws.iter().map(|draw| u64::from(draw.index_count) / 3).sum())
    }

    /// Records the passes that keep what may be seen of a chunk, for which there is room.
    pub fn keep(
        &self,
        recorder: &mut Recorder,
        pipelines: &CoveragePipelines,
        gpu: &Gpu,
        chunk: &ChunkBuffers,
        view: CoverageView,
    ) {
        let row = size_of::<DrawArgs>() as u64;
        let sieve = Sieve {
            view,
            triangle_count: chunk.chunk.triangle_count,
            material_count: (self.draw_args.size() / row) as u32,
            first_draw: (chunk.draw_args_offset / row) as u32,
            _pad: 0,
        };
        let sieve = uniform_buffer(gpu, "coverage", bytemuck::bytes_of(&sieve));
        let group = |pipeline: &wgpu::ComputePipeline, buffers: &[(u32, &wgpu::Buffer)]| {
            bind_group(gpu, "coverage", &pipeline.get_bind_group_layout(0), buffers)
        };
        let [(vertices, _), _] = chunk.vertices();
        let marks = [(0, &sieve), (3, &self.marks), (4, &self.tile_starts)];
        let taken = [(1, vertices), (2, chunk.indices)];
        let draws = [(5, chunk.draw_args), (6, &self.draw_args)];
        let kept = [marks[1], marks[2], taken[1], (7, &self.indices)];
        let groups = [
            group(&pipelines.marks, &[&marks[..], &taken].concat()),
            group(&pipelines.starts, &[&marks[..], &draws].concat()),
            group(&pipelines.keep, &[&marks[..1], &kept].concat()),
        ];
        let tiles = grid(chunk.chunk.triangle_count.div_ceil(TILE) * 256);
        recorder.compute("coverage", |pass| {
            dispatch(pass, &pipelines.marks, &groups[0], tiles);
            dispatch(pass, &pipelines.starts, &groups[1], [1, 1, 1]);
            dispatch(pass, &pipelines.keep, &groups[2], tiles);
        });
    }
}
