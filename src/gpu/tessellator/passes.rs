//! The passes, from top to bottom.

use super::Tessellator;
use crate::gpu::counts::PendingCounts;
use crate::gpu::layout::EmitArgs;
use crate::gpu::pipelines::{bind_group, dispatch, grid};
use crate::gpu::recorder::{Recorder, staging_buffer};
use crate::gpu::relief::ReliefPasses;
use crate::gpu::slab::{SCAN_BLOCK, SlabPasses, UNIFORM_STRIDE};

impl Tessellator {
    /// Records the passes that decide what will be emitted: deform and nets (where they are out of date), factors, counts,
    /// scan, chunks. The recorder must be submitted before [`Self::read_counts`] or [`Self::poll_counts`].
    pub fn count(&mut self, recorder: &mut Recorder) {
        self.bind();
        if let Some(rig) = self.rig.as_ref().filter(|_| self.posed.pose().is_some() && !self.is_deformed) {
            recorder.compute("deform", |pass| rig.record(&self.gpu, &self.pipelines, &self.buffers, pass));
            self.is_deformed = true;
        }
        let shape = (self.params.surface, self.params.alpha);
        if self.nets_done != Some(shape) {
            self.record_nets(recorder);
            self.nets_done = Some(shape);
        }
        let staging = staging_buffer(&self.gpu, self.slabs.iter().map(|slab| slab.chunks.size()).sum());
        let mut offset = 0;
        for slab in &self.slabs {
            self.record_counts(recorder, slab);
            recorder.encoder().copy_buffer_to_buffer(&slab.chunks, 0, &staging, offset, slab.chunks.size());
            offset += slab.chunks.size();
        }
        self.pending = Some(PendingCounts::new(staging));
    }

    fn record_nets(&self, recorder: &mut Recorder) {
        let Some((curve_nets, centers)) = &self.nets else { return };
        recorder.compute("nets", |pass| {
            dispatch(pass, &self.pipelines.curve_nets, curve_nets, grid(self.buffers.curve_count));
            dispatch(pass, &self.pipelines.centers, centers, grid(self.buffers.patch_count));
        });
        if let Some(relief) = &self.relief {
            relief.record_directions(recorder, &self.pipelines, &self.buffers);
        }
    }

    fn record_counts(&self, recorder: &mut Recorder, slab: &SlabPasses) {
        let Some(groups) = &slab.groups else { return };
        let pipelines = &self.pipelines;
        let blocks = [(slab.slab.patch_count + 1).div_ceil(SCAN_BLOCK), 1, 1];
        if slab.slab.first_patch == 0 && self.given.is_none() {
            recorder.compute("factors", |pass| {
                dispatch(pass, &pipelines.edge_factors, &groups.edge_factors, grid(self.buffers.factor_count));
                if self.params.mixed == 1 {
                    dispatch(pass, &pipelines.heights_inside, &groups.heights_inside, grid(self.buffers.patch_count));
                }
            });
        }
        if slab.slab.first_patch == 0
            && let Some(relief) = self.relief.as_ref().filter(|_| self.is_displaced())
        {
            relief.record_levels(recorder, pipelines, &self.buffers);
        }
        recorder.compute("counts", |pass| {
            dispatch(pass, &pipelines.counts, &groups.counts, blocks);
        });
        recorder.compute("scan", |pass| dispatch(pass, &pipelines.scan, &groups.scan, blocks));
        recorder.compute("chunks", |pass| dispatch(pass, &pipelines.chunks, &groups.chunks, [1, 1, 1]));
    }

    /// Records the emission of chunk `index` into the arena, unless it is what the arena already holds.
    pub fn emit(&mut self, recorder: &mut Recorder, index: usize) {
        let (slab_index, chunk_index, _) = self.chunks[index];
        if self.emitted == Some((slab_index, chunk_index)) {
            return;
        }
        let slab = &self.slabs[slab_index];
        let Some(groups) = &slab.groups else { return };
        let args = u64::from(chunk_index) * size_of::<EmitArgs>() as u64;
        let normals = self.params.normals as usize;
        let halves = [
            (&self.pipelines.emit_vertices[normals], &groups.emit_vertices[normals], args),
            (&self.pipelines.emit_triangles, &groups.emit_triangles, args + 12),
        ];
        let run = |pass: &mut wgpu::ComputePass, pipeline, group, args| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.set_bind_group(1, &self.chunk_group(slab, pipeline, chunk_index), &[]);
            pass.dispatch_workgroups_indirect(&slab.emit_args, args);
        };
        recorder.compute("emit", |pass| {
            halves.into_iter().for_each(|(pipeline, group, args)| run(pass, pipeline, group, args));
        });
        if let Some(relief) = self.relief.as_ref().filter(|_| self.is_displaced()) {
            let group = relief.displace(slab_index);
            recorder.compute("displace", |pass| run(pass, &self.pipelines.displace, group, args + 24));
        }
        self.emitted = Some((slab_index, chunk_index));
    }

    fn chunk_group(&self, slab: &SlabPasses, pipeline: &wgpu::ComputePipeline, chunk: u32) -> wgpu::BindGroup {
        let binding = wgpu::BufferBinding {
            buffer: &slab.chunk_indices,
            offset: u64::from(chunk) * UNIFORM_STRIDE,
            size: std::num::NonZeroU64::new(4),
        };
        self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("chunk"),
            layout: &pipeline.get_bind_group_layout(1),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(binding) }],
        })
    }

    fn bind(&mut self) {
        let (b, params, given) = (&self.buffers, &self.params_buffer, &self.given_buffer);
        let nets = &self.pipelines;
        self.nets.get_or_insert_with(|| {
            let inputs = [(0, params), (1, &b.points), (6, &b.curve_nets)];
            let curves = [&inputs[..], &[(2, &b.corners), (3, &b.curves), (4, &b.curve_sides)]].concat();
            let centers = [&inputs[..], &[(5, &b.patches)]].concat();
            (
                bind_group(&self.gpu, "nets.curves", &nets.curve_nets.get_bind_group_layout(0), &curves),
                bind_group(&self.gpu, "nets.centers", &nets.centers.get_bind_group_layout(0), &centers),
            )
        });
        if let (None, Some(images)) = (&self.relief, &self.images) {
            let buffers = [params, given, &self.arena.vertices];
            self.relief = ReliefPasses::new(&self.gpu, &self.pipelines, b, images, buffers, &self.slabs);
        }
        for slab in &mut self.slabs {
            if slab.groups.is_none() {
                slab.groups = Some(slab.bind(&self.gpu, &self.pipelines, &self.buffers, params, given, &self.arena));
            }
        }
    }
}
