//! One mesh being tessellated: its state, and what is recomputed when.

mod given;
mod output;
mod passes;
mod user_surface;

use std::sync::Arc;

use glam::Mat4;

use super::arena::{Arena, Capacity};
use super::buffer::{filled, uniform_buffer};
use super::layout::{Chunk, Params};
use super::mesh_buffers::Grouping;
use super::minimum::Minimum;
use super::params::params_of;
use super::pass_inputs::BoundPasses;
use super::readback::Readback;
use super::relief_buffers::HeightImages;
use super::rig::RigBuffers;
use super::slab::SlabBuffers;
use super::{ComputePipelines, Given, Gpu, GpuError, MeshBuffers, UserReport};
use geometry::mesh::{Mesh, Pose, Topology};
use geometry::tessellate::{Clip, Convention, Edges, HullFactors, Inputs, PosedMesh, Solid};

pub use output::ChunkBuffers;
use user_surface::UserSurface;

/// Patches that one scan covers: few enough that no count of vertices or triangles overflows 32 bits with the most rows.
const SLAB_PATCHES: u32 = 1 << 18;

/// A tessellated mesh on the device.
pub struct Tessellator {
    gpu: Gpu,
    pipelines: Arc<ComputePipelines>,
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    posed: PosedMesh,
    solid: Option<Solid>,
    buffers: MeshBuffers,
    /// What poses are made from, once there was one.
    rig: Option<RigBuffers>,
    /// Whether points and corners are those of the pose.
    is_deformed: bool,
    inputs: Option<Inputs>,
    params: Params,
    params_buffer: wgpu::Buffer,
    given: Option<Given>,
    given_buffer: wgpu::Buffer,
    /// Where functions of the user's own report, an [`UserReport`], if they give factors.
    user_report: Option<wgpu::Buffer>,
    /// What they reported last.
    user_lod_report: Option<UserReport>,
    /// What takes the place of the surface, if something does.
    user_surface: Option<UserSurface>,
    arena: Arena,
    slabs: Vec<SlabBuffers>,
    /// The passes over the mesh.
    bound: BoundPasses,
    /// Those over each slab.
    slab_passes: Vec<BoundPasses>,
    /// Made when it is first requested.
    minimum: Option<Minimum>,
    /// None if the mesh has no heights.
    images: Option<HeightImages>,
    /// The surface that the nets were made for, and how strong it is ([`Params::surface`] and [`Params::alpha`]).
    nets_done: Option<(u32, f32)>,
    counts_done: bool,
    /// The chunk tables of all slabs, on their way to the host.
    pending: Option<Readback>,
    generation: u64,
    /// The chunks that emit something: the slab's index, the chunk's number in the slab, and its table entry.
    chunks: Vec<(usize, u32, Chunk)>,
    /// The chunk that the arena holds: the slab's index, and the chunk's number in the slab.
    emitted: Option<(usize, u32)>,
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
        let images = mesh.heights.as_deref().map(|heights| HeightImages::new(gpu, heights)).transpose()?;
        let solid = Solid::find(&mesh, &topology);
        Self::with(gpu, pipelines, mesh, topology, solid, images, |mesh| Arena::new(gpu, mesh, arena_bytes))
    }

    /// Uploads a mesh for a host program that draws without waiting for the GPU: all output has to fit the arena at once, which has
    /// room for so many vertices and triangles.
    ///
    /// # Errors
    /// The mesh is larger than the adapter binds, or has more patches than one scan covers.
    pub fn with_capacity(
        gpu: &Gpu,
        pipelines: Arc<ComputePipelines>,
        mesh: Arc<Mesh>,
        topology: Arc<Topology>,
        capacity: Capacity,
    ) -> Result<Self, GpuError> {
        let (patches, limit) = (topology.patches.len() as u64, u64::from(SLAB_PATCHES));
        if patches > limit {
            return Err(GpuError::TooManyPatches { patches, limit });
        }
        let images = mesh.heights.as_deref().map(|heights| HeightImages::new(gpu, heights)).transpose()?;
        let (solid, arena) = (Solid::find(&mesh, &topology), Arena::with_capacity(gpu, capacity)?);
        Self::with(gpu, pipelines, mesh, topology, solid, images, |_| Ok(arena))
    }

    /// Makes another one of the same mesh for another view of a host program, as [`Self::with_capacity`] does: it shares mesh, topology and
    /// height images, and has output of its own.
    ///
    /// # Errors
    /// The output is larger than the adapter binds.
    pub fn sibling_with_capacity(&self, capacity: Capacity) -> Result<Self, GpuError> {
        let images = self.images.as_ref().map(HeightImages::shared);
        let arena = Arena::with_capacity(&self.gpu, capacity)?;
        let (mesh, topology) = (self.mesh.clone(), self.topology.clone());
        Self::with(&self.gpu, self.pipelines.clone(), mesh, topology, self.solid.clone(), images, |_| Ok(arena))
    }

    /// Makes another tessellator of the same mesh, on whatever thread: it shares mesh, topology and height images, and has
    /// output of its own. What takes the place of LOD and of the surface is the same.
    pub fn sibling(&self, arena_bytes: u64) -> impl FnOnce() -> Result<Self, GpuError> + Send + use<> {
        let (gpu, pipelines, solid) = (self.gpu.clone(), self.pipelines.clone(), self.solid.clone());
        let (mesh, topology) = (self.mesh.clone(), self.topology.clone());
        let images = self.images.as_ref().map(HeightImages::shared);
        let (given, surface_shader) = (self.given.clone(), self.surface_shader().cloned());
        move || {
            let make_arena = |mesh: &MeshBuffers| Arena::new(&gpu, mesh, arena_bytes);
            let mut other = Self::with(&gpu, pipelines, mesh, topology, solid, images, make_arena)?;
            if given.is_some() {
                other.give(given)?;
            }
            other.set_surface_shader(surface_shader)?;
            Ok(other)
        }
    }

    fn with(
        gpu: &Gpu,
        pipelines: Arc<ComputePipelines>,
        mesh: Arc<Mesh>,
        topology: Arc<Topology>,
        solid: Option<Solid>,
        images: Option<HeightImages>,
        make_arena: impl FnOnce(&MeshBuffers) -> Result<Arena, GpuError>,
    ) -> Result<Self, GpuError> {
        let buffers = MeshBuffers::new(gpu, &mesh, &topology, Grouping::default())?;
        let arena = make_arena(&buffers)?;
        let mut slabs = Vec::new();
        for first_patch in (0..buffers.patch_count.max(1)).step_by(SLAB_PATCHES as usize) {
            let patch_count = (buffers.patch_count - first_patch).min(SLAB_PATCHES);
            slabs.push(SlabBuffers::new(gpu, &buffers, &arena, first_patch, patch_count)?);
        }
        let params: Params = bytemuck::Zeroable::zeroed();
        let params_buffer = uniform_buffer(gpu, "params", bytemuck::bytes_of(&params));
        Ok(Self {
            gpu: gpu.clone(),
            pipelines,
            solid,
            posed: PosedMesh::new(mesh.clone(), topology.clone(), None),
            mesh,
            topology,
            buffers,
            rig: None,
            is_deformed: false,
            inputs: None,
            params,
            params_buffer,
            given: None,
            given_buffer: filled::<HullFactors>(gpu, "given factors", &[])?,
            user_report: None,
            user_lod_report: None,
            user_surface: None,
            arena,
            slab_passes: slabs.iter().map(|_| BoundPasses::default()).collect(),
            slabs,
            bound: BoundPasses::default(),
            minimum: None,
            images,
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
        let inputs = &self.with_user_surface(inputs);
        let grouping = self.grouping(inputs);
        if grouping != self.buffers.grouping {
            self.upload(grouping)?;
        }
        self.inputs = Some(*inputs);
        let culls_back = inputs.tessellation.cull_back_faces && self.hides_backs(inputs);
        let params = params_of(inputs, &self.mesh, &self.buffers, self.given.as_ref(), culls_back);
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
        self.pose_as(&PosedMesh::new(self.mesh.clone(), self.topology.clone(), pose))
    }

    /// The same as another tessellator of the mesh has it: what the host makes of the pose is made once.
    ///
    /// # Errors
    /// The mesh's rig is larger than the adapter binds.
    pub fn pose_as(&mut self, posed: &PosedMesh) -> Result<(), GpuError> {
        let Some(rig) = self.mesh.rig.clone().filter(|_| self.posed.pose() != posed.pose()) else { return Ok(()) };
        match (posed.pose(), &mut self.rig) {
            (Some(pose), Some(rig)) => rig.set_pose(&self.gpu, pose)?,
            (Some(pose), None) => self.rig = Some(RigBuffers::new(&self.gpu, &rig, &self.topology, pose)?),
            (None, _) => self.upload(self.buffers.grouping)?,
        }
        self.posed = posed.clone();
        self.forget();
        Ok(())
    }

    /// What is shown, for the host.
    pub fn posed(&self) -> &PosedMesh {
        &self.posed
    }

    /// Uploads the mesh as it is at rest.
    fn upload(&mut self, grouping: Grouping) -> Result<(), GpuError> {
        self.buffers = MeshBuffers::new(&self.gpu, &self.mesh, &self.topology, grouping)?;
        self.is_deformed = false;
        self.nets_done = None;
        self.unbind();
        Ok(())
    }

    /// Lets go of what passes are bound to, since some of those buffers were replaced.
    fn unbind(&mut self) {
        self.bound = BoundPasses::default();
        self.minimum = None;
        self.slab_passes.fill_with(BoundPasses::default);
    }

    /// Forgets all that was computed, so that every pass runs again: for timing.
    pub fn forget(&mut self) {
        self.is_deformed = false;
        self.nets_done = None;
        if let Some(minimum) = &mut self.minimum {
            minimum.forget();
        }
    }

    /// Whether patches that face away can be left out of this mesh at all.
    pub fn is_solid(&self) -> bool {
        self.solid.is_some()
    }

    /// Whether all that is seen in this view is the front of something: so of a solid whose surface nothing tears, as long
    /// as nothing was left out for another view.
    pub fn shows_fronts_only(&self, clip_from_object: Mat4) -> bool {
        let Some(inputs) = self.inputs else { return false };
        let leaves_out = inputs.tessellation.cull_back_faces || inputs.tessellation.clip != Clip::Off;
        let seen = Inputs { view: inputs.view.seen_through(clip_from_object, inputs.view.half_viewport), ..inputs };
        (!leaves_out || inputs.view.clip_from_object == clip_from_object) && self.hides_backs(&seen)
    }

    /// Given factors and control points of the user's own may tear any edge, and a pose may turn a part inside out.
    fn hides_backs(&self, inputs: &Inputs) -> bool {
        let is_ours = self.given.is_none() && self.user_surface.is_none();
        let hides = |solid: &Solid| solid.hides_backs(&self.mesh, &self.topology, inputs);
        is_ours && self.posed.pose().is_none() && self.solid.as_ref().is_some_and(hides)
    }

    /// Counts the changes of what is emitted: views that don't matter under the inputs are none.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Whether what will be emitted is known.
    pub fn is_counted(&self) -> bool {
        self.counts_done
    }

    /// Takes the counts if the device has finished them. True once they are known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll_counts(&mut self) -> Result<bool, GpuError> {
        if let Some(pending) = &mut self.pending
            && pending.poll()?
        {
            let tables = pending.bytes()?;
            self.pending = None;
            self.take_chunks(&tables);
        }
        Ok(self.counts_done)
    }

    /// Waits for the counts, if they are on their way.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_counts(&mut self) -> Result<(), GpuError> {
        match &mut self.pending {
            Some(pending) => pending.arrive(&self.gpu)?,
            None => self.gpu.check()?,
        }
        self.poll_counts().map(drop)
    }

    /// The minimum triangle count of every patch: the number of triangles with which it alone would keep the tolerance. None until
    /// [`Self::record_minimum`] has run.
    pub fn minimum(&self) -> Option<&wgpu::Buffer> {
        self.minimum.as_ref().map(|minimum| &minimum.triangles)
    }

    /// The factors that LOD gave, and whether they are the edges' or the sides'.
    pub fn edge_factors(&self) -> (&wgpu::Buffer, Edges) {
        let published = self.buffers.grouping.sharing.is_per_patch();
        (&self.buffers.edge_factors, if published { Edges::AsPublished } else { Edges::PerEdge })
    }

    /// Under which convention factors were written and weights are read.
    pub fn convention(&self) -> Convention {
        self.inputs.map(|inputs| inputs.tessellation.convention).unwrap_or_default()
    }

    pub fn buffers(&self) -> &MeshBuffers {
        &self.buffers
    }

    /// The parameters of the passes, a [`Params`], as they were last set.
    pub fn params(&self) -> &wgpu::Buffer {
        &self.params_buffer
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
        let images = self.images.as_ref().map_or(0, |images| images.bytes);
        let rig = self.rig.as_ref().map_or(0, RigBuffers::bytes);
        let least = self.minimum.as_ref().map_or(0, Minimum::bytes);
        images + rig + least + self.slabs.iter().map(SlabBuffers::bytes).sum::<u64>()
    }
}
