//! Tessellation inside a program that has a wgpu device of its own.
//!
//! The device is borrowed: no handlers are installed on it, no work is submitted, and nothing waits for the GPU. The host
//! records the passes into its own command encoder, and draws what they emit in its own render pass.
//!
//! ```no_run
//! # mod pnaen { pub use geometry::{mesh, tessellate}; pub use pnaen_gpu::embed; }
//! # fn main() {}
//! use pnaen::embed::{Context, Capacity, TessellatedMesh};
//! use pnaen::mesh::{Mesh, MeshSlices};
//! use pnaen::tessellate::{LodView, Tessellation};
//!
//! # fn draw(device: &wgpu::Device, queue: &wgpu::Queue, slices: &MeshSlices, view: LodView,
//! #         encoder: &mut wgpu::CommandEncoder, render_pass: &mut wgpu::RenderPass)
//! # -> Result<(), Box<dyn std::error::Error>> {
//! // Once:
//! let context = Context::new(device, queue)?;
//! let capacity = Capacity { vertices: 100_000, triangles: 200_000 };
//! let mut mesh = TessellatedMesh::new(&context, Mesh::from_slices(slices)?, capacity)?;
//!
//! // Every frame, before the render pass begins:
//! mesh.set(&Tessellation { factor: 12.0, ..Default::default() }, view)?;
//! mesh.record(encoder)?;
//!
//! // In the render pass, whose pipeline has [`VERTEX_LAYOUTS`]:
//! let [places, details] = mesh.vertex_buffers();
//! render_pass.set_vertex_buffer(0, places);
//! render_pass.set_vertex_buffer(1, details);
//! render_pass.set_index_buffer(mesh.index_buffer(), wgpu::IndexFormat::Uint32);
//! let (arguments, offset) = mesh.draw_arguments(0)?;
//! render_pass.draw_indexed_indirect(arguments, offset);
//! # Ok(())
//! # }
//! ```
//!
//! A mesh that is seen from several cameras with adaptive LOD needs a [`TessellatedMesh`] for each:
//! [`TessellatedMesh::another_view`] makes them, and they share the mesh.
//!
//! `examples/embed.rs` is a whole program; `examples/animate.rs` changes settings and a pose over time.

use std::ops::Range;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use crate::layout::{Chunk, DrawArgs};
use crate::{ComputePipelines, Gpu, Tessellator};
use geometry::mesh::{Mesh, Pose, Rig, Topology};
use geometry::tessellate::{Inputs, LodView, Tessellation};

pub use crate::GpuError;
pub use crate::arena::Capacity;

/// The layout of the vertices in slots 0 and 1, whose shader locations are
/// 0. the position in object units: `vec3<f32>`,
/// 1. the unit normal: a `u32` that the function `unpack_normal` of [`NORMAL_WGSL`] unpacks,
/// 2. the patch and the place in it: `vec2<u32>`, packed as [`geometry::tessellate::Vertex::key`],
/// 3. the texture coordinate: `vec2<f32>`.
///
/// A pipeline that needs only positions and normals may take the first layout alone.
pub const VERTEX_LAYOUTS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    Some(wgpu::VertexBufferLayout {
        array_stride: 16,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32],
    }),
    Some(wgpu::VertexBufferLayout {
        array_stride: 16,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![2 => Uint32x2, 3 => Float32x2],
    }),
];

/// WGSL for the host's vertex shader: `fn unpack_normal(bits: u32) -> vec3<f32>`, and the functions `pack_normal` and
/// `sign_not_zero` beside it.
pub const NORMAL_WGSL: &str = shaders::text("octahedral_normal");

/// A borrowed device with the pipelines on it. Cheap to clone; clones share the pipelines.
#[derive(Clone)]
pub struct Context {
    gpu: Gpu,
    pipelines: Arc<ComputePipelines>,
}

/// A mesh on the device with memory for its tessellation.
pub struct TessellatedMesh {
    tessellator: Tessellator,
    inputs: Option<Inputs>,
}

/// What the passes wrote about their output: see [`TessellatedMesh::status_buffer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct OutputStatus {
    first_patch: u32,
    /// The number of patches that were tessellated, of [`TessellatedMesh::patches`].
    pub patches: u32,
    first: [u32; 2],
    /// The number of vertices that were emitted.
    pub vertices: u32,
    /// The number of triangles that were emitted.
    pub triangles: u32,
}
const _: () = assert!(size_of::<OutputStatus>() == size_of::<Chunk>());

impl Context {
    /// Borrows a device, which stays the host's. Nothing is compiled before it is needed.
    ///
    /// # Errors
    /// [`GpuError::Limits`] if the device allows less than WebGPU's default limits in something that the passes need.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, GpuError> {
        check_limits(&device.limits())?;
        Ok(Self { gpu: Gpu::borrowed(device, queue), pipelines: Arc::default() })
    }
}

fn check_limits(has: &wgpu::Limits) -> Result<(), GpuError> {
    type Limit = fn(&wgpu::Limits) -> u32;
    let limits: [(&'static str, Limit); 4] = [
        ("storage buffers in a shader stage", |limits| limits.max_storage_buffers_per_shader_stage),
        ("invocations in a compute workgroup", |limits| limits.max_compute_invocations_per_workgroup),
        ("bytes of workgroup memory", |limits| limits.max_compute_workgroup_storage_size),
        ("workgroups in a dispatch", |limits| limits.max_compute_workgroups_per_dimension),
    ];
    let needs = wgpu::Limits::default();
    match limits.into_iter().find(|(_, limit)| limit(has) < limit(&needs)) {
        Some((what, limit)) => Err(GpuError::Limits { what, has: limit(has).into(), needs: limit(&needs).into() }),
        None => Ok(()),
    }
}

/// Refuses a pose of another rig, beyond whose matrices and weights the passes would read.
fn check_pose(rig: &Rig, pose: &Pose) -> Result<(), GpuError> {
    let [joints, weights] = pose.lengths();
    let [rig_joints, rig_weights] = rig.pose_lengths();
    let counts = [("joint matrices", joints, rig_joints), ("morph weights", weights, rig_weights)];
    match counts.into_iter().find(|(_, has, needs)| has != needs) {
        Some((what, has, needs)) => Err(GpuError::OtherRig { what, has, needs }),
        None => Ok(()),
    }
}

impl TessellatedMesh {
    /// Uploads a mesh, and allocates memory for its output.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the mesh or its output is larger than the device binds, and [`GpuError::TooManyPatches`] if
    /// the mesh has more than 262,144 triangles.
    pub fn new(context: &Context, mesh: impl Into<Arc<Mesh>>, capacity: Capacity) -> Result<Self, GpuError> {
        let mesh = mesh.into();
        let topology = Arc::new(Topology::new(&mesh));
        let (gpu, pipelines) = (&context.gpu, context.pipelines.clone());
        Ok(Self { tessellator: Tessellator::with_capacity(gpu, pipelines, mesh, topology, capacity)?, inputs: None })
    }

    /// Makes another view of the same mesh, with its own settings, pose and output. Both share the mesh, its topology and its height
    /// images.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the output is larger than the device binds.
    pub fn another_view(&self, capacity: Capacity) -> Result<Self, GpuError> {
        Ok(Self { tessellator: self.tessellator.sibling_with_capacity(capacity)?, inputs: None })
    }

    /// The mesh at rest.
    pub fn mesh(&self) -> &Mesh {
        self.tessellator.mesh()
    }

    /// How the mesh's triangles are connected: its patches, edges and sides.
    pub fn topology(&self) -> &Topology {
        self.tessellator.topology()
    }

    /// The number of patches: the mesh's triangles, except those with two corners at one position.
    pub fn patches(&self) -> u32 {
        self.topology().patches.len() as u32
    }

    /// Takes a tessellation, and the view that adaptive LOD, clipping and back-face culling are computed for. What is
    /// the same as before is not computed again.
    ///
    /// Call this at most once between two submissions. The parameters are written through the queue, so passes that
    /// were recorded before, but not submitted, would run with the later ones.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the mesh's control points under another surface are larger than the device binds. What
    /// was set before then stays.
    pub fn set(&mut self, tessellation: &Tessellation, view: LodView) -> Result<(), GpuError> {
        let inputs = Inputs::new(tessellation, view);
        self.tessellator.set(&inputs)?;
        self.inputs = Some(inputs);
        Ok(())
    }

    /// Takes a pose of the mesh's rig, or the mesh at rest with `None`. A mesh without a rig stays at rest. As for
    /// [`set`](Self::set), call this at most once between two submissions.
    ///
    /// # Errors
    /// [`GpuError::OtherRig`] if the pose has other numbers of joints or morph targets than the mesh's rig, and
    /// [`GpuError::TooLarge`] if the rig is larger than the device binds.
    pub fn set_pose(&mut self, pose: Option<Pose>) -> Result<(), GpuError> {
        if let Some((rig, pose)) = self.mesh().rig.as_ref().zip(pose.as_ref()) {
            check_pose(rig, pose)?;
        }
        self.tessellator.set_pose(pose.map(Arc::new))?;
        self.inputs.map_or(Ok(()), |inputs| self.tessellator.set(&inputs))
    }

    /// Forgets what was computed, so that the next [`record`](Self::record) records every pass: for a host that dropped an
    /// encoder instead of submitting it.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn invalidate(&mut self) -> Result<(), GpuError> {
        self.tessellator.forget();
        self.inputs.map_or(Ok(()), |inputs| self.tessellator.set(&inputs))
    }

    /// Records the compute passes whose results have changed since they were last recorded; none if nothing has. The host
    /// submits the encoder, and may draw in it after this. Before the first [`set`](Self::set) there is nothing to record.
    ///
    /// The encoder must be submitted: later calls rely on what it computes (see [`invalidate`](Self::invalidate)). The
    /// first call that needs a pipeline compiles it, which may take some tenths of a second in all.
    ///
    /// # Errors
    /// A pipeline can't be made, since the device is out of memory or lost.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.tessellator.record_first_chunk(encoder)
    }

    /// The vertices, for slots 0 and 1 of [`VERTEX_LAYOUTS`]: two ranges of one buffer.
    pub fn vertex_buffers(&self) -> [wgpu::BufferSlice<'_>; 2] {
        let (vertices, _) = self.tessellator.arena();
        let half = vertices.size() / 2;
        [vertices.slice(..half), vertices.slice(half..)]
    }

    /// The indices (`Uint32`): three for each triangle, counter-clockwise seen from outside.
    pub fn index_buffer(&self) -> wgpu::BufferSlice<'_> {
        let (_, indices) = self.tessellator.arena();
        indices.slice(..)
    }

    /// The buffer, and the offset in it in bytes, of a material's arguments for `draw_indexed_indirect`. Materials are numbered
    /// as in [`Mesh::materials`].
    ///
    /// # Errors
    /// [`GpuError::NoSuchMaterial`].
    pub fn draw_arguments(&self, material: u32) -> Result<(&wgpu::Buffer, u64), GpuError> {
        let has = self.mesh().materials.len();
        if material as usize >= has {
            return Err(GpuError::NoSuchMaterial { material, has });
        }
        let (arguments, _) = self.tessellator.first_chunk();
        Ok((arguments, u64::from(material) * size_of::<DrawArgs>() as u64))
    }

    /// The buffer that holds an [`OutputStatus`], and the range of its bytes there. The host may copy
    /// these bytes and read them later, to learn whether the output fits its [`Capacity`].
    pub fn status_buffer(&self) -> (&wgpu::Buffer, Range<u64>) {
        let (_, status) = self.tessellator.first_chunk();
        (status, 0..size_of::<OutputStatus>() as u64)
    }

    /// Whether the last patches were left out, since the output doesn't fit its [`Capacity`]. The others are whole.
    /// `status` must be of passes that have run: before, it is all zeros, which means that all patches were left out.
    pub fn has_overflowed(&self, status: &OutputStatus) -> bool {
        status.patches < self.patches()
    }
}
