//! What is shown, measured beside the window: chunk after chunk is copied back without waiting, and looked at on a
//! thread of its own.

use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, channel, sync_channel};

use thiserror::Error;

use super::background_job::{Stopped, caught, spawn};
use crate::gpu::{Gpu, GpuError, Readback, Recorder, Timing, vertices_of};
use crate::measure::{AskedFactors, Cracks, EmittedChunk, Measured, Sizes, Survey, Visitor};
use crate::mesh::{Mesh, Topology};
use crate::progress::Progress;
use crate::render::Scene;
use crate::tessellate::{Convention, Edges, PatchFactors, Vertex};
use crate::view::ScreenView;

/// Why nothing more is learnt of what is shown.
#[derive(Debug, Error)]
pub(crate) enum Trouble {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("measuring what is shown {0}; another setting is measured anew")]
    Measuring(Stopped),
    #[error("measuring the deviation {0}; another setting is measured anew")]
    Deviating(Stopped),
}

/// What is known about the shown tessellation.
#[derive(Default)]
pub(crate) struct MeasureJob {
    /// Document and tessellation that were last asked for.
    of: Option<(u64, u64)>,
    /// Where sizes on screen were last asked for.
    seen_from: Option<ScreenView>,
    /// Before the copying: dropped first, so that its thread doesn't take an end of parts for all of them.
    comparing: Option<Comparing>,
    copying: Option<Copying>,
    found: Option<Measured>,
    sizes: Option<Sizes>,
    /// Counts results, and their absence.
    pub generation: u64,
}

/// The thread that compares; it gives up when this is dropped.
struct Comparing {
    found: Receiver<Result<(Measured, Sizes), Stopped>>,
    wanted: Progress,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

/// A readback under way. Its parts go to the comparing thread in order.
pub(in crate::app) struct Copying {
    readback: Readback,
    part: PartKind,
    next_chunk: usize,
    parts: SyncSender<Part>,
}

/// Parts that wait for the comparing thread at most: each is as large as the arena.
pub(in crate::app) const WAITING: usize = 1;

/// What a copy holds.
#[derive(Clone, Copy)]
pub(in crate::app) enum PartKind {
    /// As many bytes of patches' factors, then of those that LOD gave.
    Factors { patch_bytes: usize, edges: Edges, convention: Convention },
    /// The output of patches from `first_patch` on: as many bytes of vertices, then indices.
    Chunk { first_patch: u32, vertex_bytes: usize },
}

/// Bytes that are on the host, but not copied out yet: the comparing thread does that.
pub(in crate::app) struct Part(pub PartKind, pub Readback);

impl MeasureJob {
    /// What is shown, once measured.
    pub(crate) fn found(&self) -> Option<&Measured> {
        self.found.as_ref()
    }

    /// The cracks of what is shown, once measured.
    pub(crate) fn cracks(&self) -> Option<&Cracks> {
        self.found.as_ref().map(|found| &found.cracks)
    }

    /// Sizes of the triangles shown, once measured; they say where they were seen from.
    pub(crate) fn sizes(&self) -> Option<&Sizes> {
        self.sizes.as_ref()
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.copying.is_some() || self.comparing.is_some()
    }

    /// Forgets what was found about anything but this document and tessellation.
    pub(crate) fn keep_only(&mut self, document: u64, tessellation: u64) {
        if self.of.is_some_and(|of| of != (document, tessellation)) {
            self.forget();
        }
    }

    /// Stops what is under way, and doesn't try it again by itself.
    pub(crate) fn give_up(&mut self) {
        (self.comparing, self.copying) = (None, None);
    }

    /// Forgets everything, and stops what is under way.
    pub(crate) fn forget(&mut self) {
        *self = Self { generation: self.generation + 1, ..Self::default() };
    }

    /// Goes on measuring document `document`, whose counts are known; starts over if it emits something else by now, and if
    /// `follows` is set also if it is seen from elsewhere. True when what is known has changed.
    ///
    /// # Errors
    /// The device was lost, or measuring this stopped.
    pub(crate) fn go_on(
        &mut self,
        gpu: &Gpu,
        scene: &mut Scene,
        document: u64,
        view: ScreenView,
        follows: bool,
    ) -> Result<bool, Trouble> {
        let of = Some((document, scene.tessellator.generation()));
        if self.of != of {
            *self = Self { of, generation: self.generation + 1, ..Self::start(gpu, scene, view) };
            return Ok(true);
        }
        if follows && self.seen_from != Some(view) {
            // What doesn't depend on the view stays known.
            let (found, generation) = (self.found.take(), self.generation);
            *self = Self { of, found, generation, ..Self::start(gpu, scene, view) };
            return Ok(true);
        }
        copy_on(&mut self.copying, gpu, scene)?;
        match self.comparing.as_ref().map(|comparing| comparing.found.try_recv()) {
            Some(Ok(Ok((found, sizes)))) => {
                self.comparing = None;
                self.generation += u64::from(self.found.is_none());
                self.found = Some(found);
                self.sizes = Some(sizes);
                Ok(true)
            }
            Some(Ok(Err(stopped))) => {
                self.comparing = None;
                Err(Trouble::Measuring(stopped))
            }
            Some(Err(TryRecvError::Disconnected)) => {
                self.comparing = None;
                Ok(false)
            }
            _ => Ok(false),
        }
    }

    /// The part of all chunks that has been copied, 0 to 1, while they are.
    pub(crate) fn fraction(&self, chunks: usize) -> Option<f32> {
        self.copying.as_ref().map(|copying| copying.next_chunk as f32 / chunks.max(1) as f32)
    }

    fn start(gpu: &Gpu, scene: &Scene, view: ScreenView) -> Self {
        let (parts, received) = sync_channel(WAITING);
        let (sender, found) = channel();
        let wanted = Progress::default();
        let posed = scene.tessellator.posed().clone();
        let still_wanted = wanted.clone();
        spawn(move || {
            let measure = || {
                let (mesh, topology) = posed.deformed();
                survey(&received, &mesh, &topology, view, &still_wanted)
            };
            if let Some(result) = caught(measure).transpose() {
                let _ = sender.send(result);
            }
        });
        let copying = Some(copy_factors(gpu, scene, parts));
        let comparing = Some(Comparing { found, wanted });
        Self { copying, comparing, seen_from: Some(view), ..Self::default() }
    }
}

/// Sends on what has been copied, and copies the next chunk.
pub(in crate::app) fn copy_on(under_way: &mut Option<Copying>, gpu: &Gpu, scene: &mut Scene) -> Result<(), GpuError> {
    let Some(copying) = under_way else { return Ok(()) };
    match copying.readback.poll() {
        Ok(true) => {}
        Ok(false) => return Ok(()),
        Err(error) => {
            // Without a sender the comparing thread ends as well: it isn't tried again by itself.
            *under_way = None;
            return Err(error);
        }
    }
    // The comparing thread ends early only when the measurement was replaced; without a sender it knows of the end.
    let Some(Copying { readback, part, next_chunk, parts }) = under_way.take() else { return Ok(()) };
    if let Err(TrySendError::Full(Part(part, readback))) = parts.try_send(Part(part, readback)) {
        *under_way = Some(Copying { readback, part, next_chunk, parts });
    } else if next_chunk < scene.tessellator.chunk_count() {
        *under_way = Some(copy_chunk(gpu, scene, next_chunk, parts)?);
    }
    Ok(())
}

fn copy_factors(gpu: &Gpu, scene: &Scene, parts: SyncSender<Part>) -> Copying {
    let item = size_of::<PatchFactors>() as u64;
    let buffers = scene.tessellator.patch_factors().map(|(buffer, count)| (buffer, 0..u64::from(count) * item));
    let patch_bytes: u64 = buffers.clone().map(|(_, bytes)| bytes.end).sum();
    let (asked, edges) = scene.tessellator.edge_factors();
    let asked_bytes = u64::from(scene.tessellator.buffers().factor_count) * size_of::<f32>() as u64;
    let readback = Readback::start(gpu, buffers.chain([(asked, 0..asked_bytes)]));
    let convention = scene.tessellator.convention();
    let part = PartKind::Factors { patch_bytes: patch_bytes as usize, edges, convention };
    Copying { readback, part, next_chunk: 0, parts }
}

pub(in crate::app) fn copy_chunk(
    gpu: &Gpu,
    scene: &mut Scene,
    index: usize,
    parts: SyncSender<Part>,
) -> Result<Copying, GpuError> {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    scene.tessellator.emit(&mut recorder, index)?;
    recorder.submit();
    let chunk = scene.tessellator.chunk(index);
    let vertex_bytes = u64::from(chunk.chunk.vertex_count) * size_of::<Vertex>() as u64;
    let index_bytes = u64::from(chunk.chunk.triangle_count) * size_of::<[u32; 3]>() as u64;
    let [first, second] = chunk.vertices();
    let readback = Readback::start(gpu, [first, second, (chunk.indices, 0..index_bytes)]);
    let part = PartKind::Chunk { first_patch: chunk.chunk.first_patch, vertex_bytes: vertex_bytes as usize };
    Ok(Copying { readback, part, next_chunk: index + 1, parts })
}

/// Gives a chunk that was copied back to every visitor. `None` if the device was lost.
pub(in crate::app) fn visit(
    first_patch: u32,
    vertex_bytes: usize,
    readback: &Readback,
    visitors: &mut [&mut dyn Visitor],
) -> Option<()> {
    let bytes = readback.bytes().ok()?;
    let (vertices, indices) = bytes.split_at(vertex_bytes);
    let (vertices, triangles) = (vertices_of(vertices), bytemuck::pod_collect_to_vec::<u8, [u32; 3]>(indices));
    let chunk = EmittedChunk { first_patch, vertices: &vertices, triangles: &triangles };
    visitors.iter_mut().for_each(|visitor| visitor.take(&chunk));
    Some(())
}

/// Looks at the parts as they come, and compares once all are there. `None` if no longer wanted, or the device was lost.
fn survey(
    parts: &Receiver<Part>,
    mesh: &Mesh,
    topology: &Topology,
    view: ScreenView,
    wanted: &Progress,
) -> Option<(Measured, Sizes)> {
    let Ok(Part(PartKind::Factors { patch_bytes, edges, convention }, readback)) = parts.recv() else { return None };
    let bytes = readback.bytes().ok()?;
    let (factors, asked) = bytes.split_at(patch_bytes);
    let asked = AskedFactors::new(edges, convention, bytemuck::pod_collect_to_vec(asked));
    let mut sizes = Sizes::new(view);
    let mut survey = Survey::new(mesh, topology, bytemuck::pod_collect_to_vec(factors), asked);
    for Part(part, readback) in parts {
        wanted.check().ok()?;
        let PartKind::Chunk { first_patch, vertex_bytes } = part else { continue };
        visit(first_patch, vertex_bytes, &readback, &mut [&mut survey, &mut sizes])?;
    }
    wanted.check().ok()?;
    Some((survey.finish(), sizes))
}
