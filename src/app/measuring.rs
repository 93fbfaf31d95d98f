//! What is shown, measured beside the window: chunk after chunk is copied back without waiting, and looked at on a
//! thread of its own.

use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use crate::gpu::{Gpu, GpuError, Recorder, Timing, mapped_bytes, staging_buffer};
use crate::measure::{AskedFactors, Cracks, Measured, Survey};
use crate::mesh::{Mesh, Progress, Topology};
use crate::render::Scene;
use crate::tessellate::{Convention, Edges, PatchFactors, Vertex};

/// What is known about the shown tessellation.
#[derive(Default)]
pub struct Measuring {
    /// Document and tessellation that were last asked for.
    of: Option<(u64, u64)>,
    copying: Option<Copying>,
    comparing: Option<Comparing>,
    found: Option<Measured>,
    /// Counts results, and their absence.
    pub generation: u64,
}

/// The thread that compares; it gives up when this is dropped.
struct Comparing {
    found: Receiver<Measured>,
    wanted: Progress,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

/// A readback under way. Its parts go to the comparing thread in order.
struct Copying {
    staging: wgpu::Buffer,
    part: PartKind,
    mapped: Receiver<Result<(), wgpu::BufferAsyncError>>,
    next_chunk: usize,
    parts: Sender<Part>,
}

/// What a copy holds.
#[derive(Clone, Copy)]
enum PartKind {
    /// As many bytes of patches' factors, then of those that LOD gave.
    Factors { patch_bytes: usize, edges: Edges, convention: Convention },
    /// The output of patches from `first_patch` on: as many bytes of vertices, then indices.
    Chunk { first_patch: u32, vertex_bytes: usize },
}

/// A copy on its way to the comparing thread.
enum Part {
    Copied(PartKind, Vec<u8>),
    /// All there is.
    End,
}

impl Measuring {
    /// What is shown, once measured.
    pub fn found(&self) -> Option<&Measured> {
        self.found.as_ref()
    }

    /// The cracks of what is shown, once measured.
    pub fn cracks(&self) -> Option<&Cracks> {
        self.found.as_ref().map(|found| &found.cracks)
    }

    pub fn is_busy(&self) -> bool {
        self.copying.is_some() || self.comparing.is_some()
    }

    /// Goes on measuring document `document`, whose counts are known; starts over if it emits something else by now. True
    /// when what is known has changed.
    ///
    /// # Errors
    /// The device was lost.
    pub fn go_on(&mut self, gpu: &Gpu, scene: &mut Scene, document: u64) -> Result<bool, GpuError> {
        let of = Some((document, scene.tessellator.generation()));
        if self.of != of {
            *self = Self { of, generation: self.generation + 1, ..Self::start(gpu, scene) };
            return Ok(true);
        }
        self.copy_on(gpu, scene)?;
        match self.comparing.as_ref().map(|comparing| comparing.found.try_recv()) {
            Some(Ok(found)) => {
                self.comparing = None;
                self.found = Some(found);
                self.generation += 1;
                Ok(true)
            }
            Some(Err(TryRecvError::Disconnected)) => {
                self.comparing = None;
                Ok(false)
            }
            _ => Ok(false),
        }
    }

    fn start(gpu: &Gpu, scene: &Scene) -> Self {
        let (parts, received) = channel();
        let (sender, found) = channel();
        let wanted = Progress::default();
        let (mesh, topology) = (scene.tessellator.mesh().clone(), scene.tessellator.topology().clone());
        let still_wanted = wanted.clone();
        std::thread::spawn(move || {
            if let Some(result) = survey(&received, &mesh, &topology, &still_wanted) {
                let _ = sender.send(result);
            }
        });
        let copying = Some(copy_factors(gpu, scene, parts));
        Self { copying, comparing: Some(Comparing { found, wanted }), ..Self::default() }
    }

    /// Sends on what has been copied, and copies the next chunk.
    fn copy_on(&mut self, gpu: &Gpu, scene: &mut Scene) -> Result<(), GpuError> {
        let Some(copying) = &self.copying else { return Ok(()) };
        match copying.mapped.try_recv() {
            Err(TryRecvError::Empty) => return Ok(()),
            Err(TryRecvError::Disconnected) => return Err(GpuError::Readback("a copy was dropped".into())),
            Ok(Err(error)) => return Err(GpuError::Readback(error.to_string())),
            Ok(Ok(())) => {}
        }
        let Some(copying) = self.copying.take() else { return Ok(()) };
        let bytes = mapped_bytes(&copying.staging)?;
        // The comparing thread ends early only when the measurement was replaced.
        let _ = copying.parts.send(Part::Copied(copying.part, bytes));
        if copying.next_chunk < scene.tessellator.chunk_count() {
            self.copying = Some(copy_chunk(gpu, scene, copying.next_chunk, copying.parts));
        } else {
            let _ = copying.parts.send(Part::End);
        }
        Ok(())
    }
}

fn copy_factors(gpu: &Gpu, scene: &Scene, parts: Sender<Part>) -> Copying {
    let item = size_of::<PatchFactors>() as u64;
    let buffers = scene.tessellator.patch_factors().map(|(buffer, count)| (buffer, u64::from(count) * item));
    let patch_bytes: u64 = buffers.clone().map(|(_, bytes)| bytes).sum();
    let (asked, edges) = scene.tessellator.edge_factors();
    let asked_bytes = u64::from(scene.tessellator.buffers().factor_count) * size_of::<f32>() as u64;
    let staging = copy(gpu, buffers.chain([(asked, asked_bytes)]));
    let convention = scene.tessellator.convention();
    let part = PartKind::Factors { patch_bytes: patch_bytes as usize, edges, convention };
    Copying { mapped: map(&staging), staging, part, next_chunk: 0, parts }
}

fn copy_chunk(gpu: &Gpu, scene: &mut Scene, index: usize, parts: Sender<Part>) -> Copying {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    scene.tessellator.emit(&mut recorder, index);
    recorder.submit();
    let chunk = scene.tessellator.chunk(index);
    let vertex_bytes = u64::from(chunk.chunk.vertex_count) * size_of::<Vertex>() as u64;
    let index_bytes = u64::from(chunk.chunk.triangle_count) * size_of::<[u32; 3]>() as u64;
    let staging = copy(gpu, [(chunk.vertices, vertex_bytes), (chunk.indices, index_bytes)].into_iter());
    let part = PartKind::Chunk { first_patch: chunk.chunk.first_patch, vertex_bytes: vertex_bytes as usize };
    Copying { mapped: map(&staging), staging, part, next_chunk: index + 1, parts }
}

/// Copies the starts of buffers, one after another, where the host can read them.
fn copy<'a>(gpu: &Gpu, buffers: impl Iterator<Item = (&'a wgpu::Buffer, u64)> + Clone) -> wgpu::Buffer {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    let total: u64 = buffers.clone().map(|(_, bytes)| bytes).sum();
    let staging = staging_buffer(gpu, total.max(4));
    let mut offset = 0;
    for (buffer, bytes) in buffers {
        recorder.encoder().copy_buffer_to_buffer(buffer, 0, &staging, offset, bytes);
        offset += bytes;
    }
    recorder.submit();
    staging
}

fn map(staging: &wgpu::Buffer) -> Receiver<Result<(), wgpu::BufferAsyncError>> {
    let (sender, mapped) = channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = sender.send(result);
    });
    mapped
}

/// Looks at the parts as they come, and compares once all are there. `None` if no longer wanted.
fn survey(parts: &Receiver<Part>, mesh: &Mesh, topology: &Topology, wanted: &Progress) -> Option<Measured> {
    let Ok(Part::Copied(PartKind::Factors { patch_bytes, edges, convention }, bytes)) = parts.recv() else {
        return None;
    };
    let (factors, asked) = bytes.split_at(patch_bytes);
    let asked = AskedFactors::new(edges, convention, bytemuck::pod_collect_to_vec(asked));
    let mut survey = Survey::new(mesh, topology, bytemuck::pod_collect_to_vec(factors), asked);
    loop {
        wanted.check().ok()?;
        match parts.recv().ok()? {
            Part::Copied(PartKind::Chunk { first_patch, vertex_bytes }, bytes) => {
                let (vertices, indices) = bytes.split_at(vertex_bytes);
                let vertices: Vec<Vertex> = bytemuck::pod_collect_to_vec(vertices);
                survey.take(first_patch, &vertices, &bytemuck::pod_collect_to_vec::<u8, [u32; 3]>(indices));
            }
            Part::Copied(PartKind::Factors { .. }, _) | Part::End => break,
        }
    }
    Some(survey.finish())
}
