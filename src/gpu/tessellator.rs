//! One mesh being tessellated: what is recomputed when, and the passes from top to bottom.

use std::sync::Arc;

use glam::Mat4;

use super::arena::Arena;
use super::buffers::filled;
use super::counts::PendingCounts;
use super::layout::{Chunk, DrawArgs, EmitArgs, Params};
use super::params::params_of;
use super::pipelines::bind_group;
use super::recorder::{Recorder, staging_buffer, wait};
use super::relief::{HeightImages, ReliefPasses};
use super::rig::RigBuffers;
use super::slab::{SCAN_BLOCK, SlabPasses, UNIFORM_STRIDE, uniform_buffer};
use super::{ComputePipelines, Gpu, GpuError, MeshBuffers, hull};
use crate::mesh::{Mesh, Pose, Sharing, Topology};
use crate::tessellate::{self, Clip, Convention, Displacement, Edges, HullFactors, Inputs, Posed, Solid, sharing};

/// Patches that one scan covers: few enough that no count of vertices or triangles overflows 32 bits at factor 64.
const SLAB_PATCHES: u32 = 1 << 19;

/// A tessellated mesh on the device.
pub struct Tessellator {
    gpu: Gpu,
    pipelines: Arc<ComputePipelines>,
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    posed: Posed,
    solid: Option<Solid>,
    buffers: MeshBuffers,
    /// What poses are made from, once there was one.
    rig: Option<RigBuffers>,
    /// Whether points and corners are those of the pose.
    is_deformed: bool,
    inputs: Option<Inputs>,
    params: Params,
    params_buffer: wgpu::Buffer,
    convention: Convention,
    given: Option<Vec<HullFactors>>,
    given_buffer: wgpu::Buffer,
    arena: Arena,
    slabs: Vec<SlabPasses>,
    nets: Option<(wgpu::BindGroup, wgpu::BindGroup)>,
    /// Of a mesh that can be displaced.
    images: Option<HeightImages>,
    relief: Option<ReliefPasses>,
    /// For which surface, and how strong it is.
    nets_done: Option<(u32, f32)>,
    counts_done: bool,
    pending: Option<PendingCounts>,
    generation: u64,
    chunks: Vec<(usize, u32, Chunk)>,
    emitted: Option<(usize, u32)>,
}

/// What a chunk left in the arena, for whoever draws or reads it.
pub struct ChunkBuffers<'a> {
    pub chunk: Chunk,
    pub vertices: &'a wgpu::Buffer,
    pub indices: &'a wgpu::Buffer,
    /// One [`DrawArgs`] a material, from `draw_args_offset` bytes on.
    pub draw_args: &'a wgpu::Buffer,
    pub draw_args_offset: u64,
    /// The factors of the slab's patches, the first of which is `first_patch`.
    pub patch_factors: &'a wgpu::Buffer,
    pub first_patch: u32,
    /// The slab itself: a [`super::layout::Slab`].
    pub slab: &'a wgpu::Buffer,
}

impl Tessellator {
    /// Uploads a mesh. `arena_bytes` bounds the memory for output; what does not fit goes through it in chunks.
    ///
    /// # Errors
    /// The mesh is larger than the adapter binds.
    pub fn new(
        gpu: &Gpu,
        pipelines: Arc<ComputePipelines>,
        mesh: Arc<Mesh>,
        topology: Arc<Topology>,
        arena_bytes: u64,
    ) -> Result<Self, GpuError> {
        let buffers = MeshBuffers::new(gpu, &mesh, &topology, Sharing::AllSides)?;
        let arena = Arena::new(gpu, buffers.patch_count, arena_bytes)?;
        let mut slabs = Vec::new();
        for first_patch in (0..buffers.patch_count.max(1)).step_by(SLAB_PATCHES as usize) {
            let patch_count = (buffers.patch_count - first_patch).min(SLAB_PATCHES);
            slabs.push(SlabPasses::new(gpu, &buffers, &arena, first_patch, patch_count)?);
        }
        let images = mesh.heights.as_deref().map(|heights| HeightImages::new(gpu, heights)).transpose()?;
        let params: Params = bytemuck::Zeroable::zeroed();
        let params_buffer = uniform_buffer(gpu, "params", bytemuck::bytes_of(&params));
        Ok(Self {
            gpu: gpu.clone(),
            pipelines,
            solid: Solid::find(&mesh, &topology),
            posed: Posed::new(mesh.clone(), topology.clone(), None),
            mesh,
            topology,
            buffers,
            rig: None,
            is_deformed: false,
            inputs: None,
            params,
            params_buffer,
            convention: Convention::default(),
            given: None,
            given_buffer: filled::<HullFactors>(gpu, "given factors", &[])?,
            arena,
            slabs,
            nets: None,
            images,
            relief: None,
            nets_done: None,
            counts_done: false,
            pending: None,
            generation: 0,
            chunks: Vec::new(),
            emitted: None,
        })
    }

    /// Takes new inputs. What no longer holds is forgotten; nothing is recorded yet.
    ///
    /// # Errors
    /// The mesh's curves under another surface are larger than the adapter binds.
    pub fn set(&mut self, inputs: &Inputs) -> Result<(), GpuError> {
        let sharing = sharing(inputs.surface, inputs.edges);
        if sharing != self.buffers.sharing {
            self.upload(sharing)?;
        }
        self.inputs = Some(*inputs);
        self.convention = inputs.convention;
        let culls_back = inputs.cull_back_faces && self.hides_backs(inputs);
        let params = params_of(inputs, &self.mesh, &self.buffers, self.given.is_some(), culls_back);
        if params != self.params || self.nets_done.is_none() {
            self.params = params;
            self.gpu.queue.write_buffer(&self.params_buffer, 0, bytemuck::bytes_of(&params));
            self.counts_done = false;
            self.pending = None;
            self.emitted = None;
            self.generation += 1;
        }
        Ok(())
    }

    /// Takes a pose, or none for the mesh as it is at rest; a mesh without a rig stays so. Takes effect with the next
    /// [`Self::set`]; the pose that it has already recomputes nothing.
    ///
    /// # Errors
    /// The mesh's rig is larger than the adapter binds.
    pub fn set_pose(&mut self, pose: Option<Arc<Pose>>) -> Result<(), GpuError> {
        let Some(rig) = self.mesh.rig.clone().filter(|_| self.posed.pose() != pose.as_deref()) else { return Ok(()) };
        match (&pose, &mut self.rig) {
            (Some(pose), Some(rig)) => rig.set_pose(&self.gpu, pose)?,
            (Some(pose), None) => self.rig = Some(RigBuffers::new(&self.gpu, &rig, &self.topology, pose)?),
            (None, _) => self.upload(self.buffers.sharing)?,
        }
        self.posed = Posed::new(self.mesh.clone(), self.topology.clone(), pose);
        self.forget();
        Ok(())
    }

    /// What is shown, for the host.
    pub fn posed(&self) -> &Posed {
        &self.posed
    }

    /// Uploads the mesh as it is at rest.
    fn upload(&mut self, sharing: Sharing) -> Result<(), GpuError> {
        self.buffers = MeshBuffers::new(&self.gpu, &self.mesh, &self.topology, sharing)?;
        self.is_deformed = false;
        self.nets = None;
        self.relief = None;
        self.nets_done = None;
        self.slabs.iter_mut().for_each(|slab| slab.groups = None);
        Ok(())
    }

    /// Takes what a hull shader wrote, one for each patch, in place of what LOD gives; none for LOD's. Takes effect with the
    /// next [`Self::set`].
    ///
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub fn give(&mut self, given: Option<Vec<HullFactors>>) -> Result<(), GpuError> {
        self.given_buffer = filled(&self.gpu, "given factors", given.as_deref().unwrap_or_default())?;
        self.given = given;
        self.relief = None;
        self.slabs.iter_mut().for_each(|slab| slab.groups = None);
        self.forget();
        Ok(())
    }

    /// Forgets all that was computed, so that every pass runs again: for timing.
    pub fn forget(&mut self) {
        self.is_deformed = false;
        self.nets_done = None;
    }

    /// Whether patches that face away can be left out of this mesh at all.
    pub fn is_solid(&self) -> bool {
        self.solid.is_some()
    }

    /// Whether all that is seen in this view is the front of something: so of a solid whose surface nothing tears, as long
    /// as nothing was left out for another view.
    pub fn shows_fronts_only(&self, clip_from_object: Mat4) -> bool {
        let Some(inputs) = self.inputs else { return false };
        let leaves_out = inputs.cull_back_faces || inputs.clip != Clip::Off;
        let seen = Inputs { view: tessellate::LodView { clip_from_object, ..inputs.view }, ..inputs };
        (!leaves_out || inputs.view.clip_from_object == clip_from_object) && self.hides_backs(&seen)
    }

    /// Given factors may tear any edge, and a pose may turn a part inside out.
    fn hides_backs(&self, inputs: &Inputs) -> bool {
        self.given.is_none() && self.posed.pose().is_none() && self.solid.is_some_and(|solid| solid.hides_backs(inputs))
    }

    /// Whether vertices are moved after they were emitted.
    fn is_displaced(&self) -> bool {
        self.params.displacement != Displacement::Off as u32
    }

    /// Counts the changes of what is emitted: views that don't matter under the inputs are none.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Whether what will be emitted is known.
    pub fn is_counted(&self) -> bool {
        self.counts_done
    }

    /// Whether [`Self::count`] has to run before anything can be emitted.
    pub fn needs_count(&self) -> bool {
        !self.counts_done && self.pending.is_none()
    }

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
            dispatch(pass, &pipelines.counts, &groups.counts, grid(slab.slab.patch_count + 1));
        });
        recorder.compute("scan", |pass| {
            dispatch(pass, &pipelines.scan_blocks, &groups.scan[0], blocks);
            dispatch(pass, &pipelines.scan_sums, &groups.scan[1], [1, 1, 1]);
            dispatch(pass, &pipelines.scan_add, &groups.scan[2], blocks);
        });
        recorder.compute("chunks", |pass| dispatch(pass, &pipelines.chunks, &groups.chunks, [1, 1, 1]));
    }

    /// Asks for the counts after the recorder was submitted; [`Self::poll_counts`] says when they are here.
    pub fn request_counts(&mut self) {
        if let Some(pending) = &mut self.pending {
            pending.request();
        }
    }

    /// Takes the counts if the device has finished them. True once they are known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll_counts(&mut self) -> Result<bool, GpuError> {
        if let Some(table) = self.pending.as_ref().map(PendingCounts::poll).transpose()?.flatten() {
            self.pending = None;
            self.take_chunks(&table);
        }
        Ok(self.counts_done)
    }

    /// Waits for the counts, if they are on their way.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_counts(&mut self) -> Result<(), GpuError> {
        self.request_counts();
        wait(&self.gpu);
        self.gpu.check()?;
        if let Some(table) = self.pending.as_ref().map(PendingCounts::wait).transpose()?.flatten() {
            self.pending = None;
            self.take_chunks(&table);
        }
        Ok(())
    }

    fn take_chunks(&mut self, table: &[Chunk]) {
        self.counts_done = true;
        self.chunks.clear();
        let mut rows = table.iter();
        for (index, slab) in self.slabs.iter().enumerate() {
            for chunk in 0..slab.slab.chunk_capacity {
                if let Some(row) = rows.next().filter(|row| row.vertex_count > 0) {
                    self.chunks.push((index, chunk, *row));
                }
            }
        }
    }

    /// How many chunks the output takes; 0 before the counts are known, and when nothing is emitted.
    pub fn chunk_count(&self) -> usize {
        if self.counts_done { self.chunks.len() } else { 0 }
    }

    /// Vertices and triangles of the whole output.
    pub fn totals(&self) -> (u64, u64) {
        let sum = |count: fn(&Chunk) -> u32| self.chunks.iter().map(|(_, _, chunk)| u64::from(count(chunk))).sum();
        (sum(|chunk| chunk.vertex_count), sum(|chunk| chunk.triangle_count))
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
        let halves = [
            (&self.pipelines.emit_vertices, &groups.emit_vertices, args),
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
            recorder.compute("displace", |pass| run(pass, &self.pipelines.displace, group, args));
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

    /// The arena as chunk `index` left it.
    pub fn chunk(&self, index: usize) -> ChunkBuffers<'_> {
        let (slab_index, chunk_index, chunk) = self.chunks[index];
        let slab = &self.slabs[slab_index];
        let row = size_of::<DrawArgs>() as u64 * u64::from(self.buffers.material_count);
        ChunkBuffers {
            chunk,
            vertices: &self.arena.vertices,
            indices: &self.arena.indices,
            draw_args: &slab.draw_args,
            draw_args_offset: u64::from(chunk_index) * row,
            patch_factors: &slab.patch_factors,
            first_patch: slab.slab.first_patch,
            slab: &slab.slab_buffer,
        }
    }

    /// Room for vertices and for indices, whatever chunk they hold.
    pub fn arena(&self) -> (&wgpu::Buffer, &wgpu::Buffer) {
        (&self.arena.vertices, &self.arena.indices)
    }

    /// The factors of all patches, slab by slab.
    pub fn patch_factors(&self) -> impl Iterator<Item = (&wgpu::Buffer, u32)> + Clone {
        self.slabs.iter().map(|slab| (&slab.patch_factors, slab.slab.patch_count))
    }

    /// The factors that LOD gave, and whether they are the edges' or the sides'.
    pub fn edge_factors(&self) -> (&wgpu::Buffer, Edges) {
        let published = self.buffers.sharing.is_per_patch();
        (&self.buffers.edge_factors, if published { Edges::AsPublished } else { Edges::PerEdge })
    }

    /// What a hull shader wrote in place of LOD's factors, if that was given.
    pub fn given(&self) -> Option<&[HullFactors]> {
        self.given.as_deref()
    }

    /// Under which convention factors were written and weights are read.
    pub fn convention(&self) -> Convention {
        self.convention
    }

    /// What the hull shader writes, one for each patch. The counts must be known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    pub fn hull_factors(&self) -> Result<Vec<HullFactors>, GpuError> {
        hull::read(&self.gpu, &self.buffers, &self.params_buffer, &self.given_buffer)
    }

    pub fn buffers(&self) -> &MeshBuffers {
        &self.buffers
    }

    /// At rest.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// At rest; in a pose, as connected.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Bytes of the output's memory, whatever part of it is in use.
    pub fn arena_bytes(&self) -> u64 {
        self.arena.vertices.size() + self.arena.indices.size()
    }

    /// Bytes of height images, counts, scans and indirect arguments, and of what a pose is made from.
    pub fn work_bytes(&self) -> u64 {
        let images = self.images.as_ref().map_or(0, HeightImages::bytes);
        let rig = self.rig.as_ref().map_or(0, RigBuffers::bytes);
        images + rig + self.slabs.iter().map(SlabPasses::bytes).sum::<u64>()
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

/// Twin of `grid` in `shaders/types.wgsl`.
pub fn grid(items: u32) -> [u32; 3] {
    let workgroups = items.div_ceil(256);
    [workgroups.min(32768), workgroups.div_ceil(32768), 1]
}

/// Runs one entry point over a grid.
pub fn dispatch(
    pass: &mut wgpu::ComputePass,
    pipeline: &wgpu::ComputePipeline,
    group: &wgpu::BindGroup,
    [x, y, z]: [u32; 3],
) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(x, y, z);
}
