//! Measures what is shown while the window goes on: chunk after chunk is copied back without waiting, and a thread of its
//! own measures it.

use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, channel, sync_channel};

use glam::Vec3;
use thiserror::Error;

use super::background_job::{Stopped, caught, spawn};
use crate::engine::measurements::closed_extent;
use crate::gpu::{Given, Gpu, GpuError, Readback, Recorder, Timing, vertices_of};
use crate::measure::{Agreement, AskedFactors, Cracks, EmittedChunk, Measured, Sizes, Survey, Visitor};
use crate::mesh::{Mesh, Topology};
use crate::progress::Progress;
use crate::render::Scene;
use crate::tessellate::{Convention, Edges, HullFactors, PatchFactors, Vertex, is_beyond_near};
use crate::view::ScreenView;

/// Why a measurement ended without a result.
#[derive(Debug, Error)]
pub(crate) enum Trouble {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("measuring the picture {0}; any other setting starts a new measurement")]
    Measuring(Stopped),
    #[error("counting leaks {0}; any other setting starts a new count")]
    Leaking(Stopped),
    #[error("comparing outlines {0}; any other setting starts a new comparison")]
    Comparing(Stopped),
    #[error("measuring the deviation {0}; any other setting starts a new measurement")]
    Deviating(Stopped),
}

/// The measurement of the tessellation that is shown, and its results.
#[derive(Default)]
pub(crate) struct MeasureJob {
    /// The document and tessellation that the last measurement is about.
    of: Option<(u64, u64)>,
    /// The view that sizes on screen were last measured for.
    seen_from: Option<ScreenView>,
    /// Declared before `copying`, so that it is dropped first: if `copying` went first, the channel would close, and the
    /// thread would think that it has everything.
    comparing: Option<Comparing>,
    copying: Option<Copying>,
    found: Option<Measured>,
    agreement: Option<Agreement>,
    /// The extent of a mesh whose leaks can be counted: see [`closed_extent`].
    closed: Option<[Vec3; 2]>,
    sizes: Option<Sizes>,
    /// Counts changes of the result, including its loss.
    pub generation: u64,
}

/// What the thread returns.
struct Surveyed {
    found: Measured,
    closed: Option<[Vec3; 2]>,
    sizes: Sizes,
    agreement: Option<Agreement>,
}

/// The thread that measures. It stops when this is dropped.
struct Comparing {
    found: Receiver<Result<Surveyed, Stopped>>,
    wanted: Progress,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

/// A readback under way. Its parts go to the measuring thread in order.
pub(in crate::app) struct Copying {
    readback: Readback,
    part: PartKind,
    next_chunk: usize,
    parts: SyncSender<Part>,
}

/// How many parts may wait for the measuring thread: each is as large as the arena.
pub(in crate::app) const WAITING: usize = 1;

/// The contents of a part.
#[derive(Clone, Copy)]
pub(in crate::app) enum PartKind {
    /// `patch_bytes` bytes of the patches' factors, then the factors that were asked for.
    Factors { patch_bytes: usize, asked: Asked, convention: Convention },
    /// The output of patches from `first_patch` on: `vertex_bytes` bytes of vertices, then indices.
    Chunk { first_patch: u32, vertex_bytes: usize },
}

/// What gave the factors that were asked for.
#[derive(Clone, Copy)]
pub(in crate::app) enum Asked {
    /// LOD, for every edge or every side.
    Lod(Edges),
    /// An LOD shader, a [`HullFactors`] for every patch.
    Shader,
}

/// A readback that has arrived. The measuring thread copies its bytes out.
pub(in crate::app) struct Part(pub PartKind, pub Readback);

impl MeasureJob {
    /// The results for what is shown, once measured.
    pub(crate) fn found(&self) -> Option<&Measured> {
        self.found.as_ref()
    }

    /// How the factors of an LOD shader agree, once measured.
    pub(crate) fn agreement(&self) -> Option<&Agreement> {
        self.agreement.as_ref()
    }

    /// The cracks of what is shown, once measured.
    pub(crate) fn cracks(&self) -> Option<&Cracks> {
        self.found.as_ref().map(|found| &found.cracks)
    }

    /// Sizes of the triangles shown, once measured, with the view that they were measured for.
    pub(crate) fn sizes(&self) -> Option<&Sizes> {
        self.sizes.as_ref()
    }

    /// Whether what was measured last of this document is closed, and beyond the near plane of a view.
    pub(crate) fn is_closed_in(&self, view: Option<ScreenView>) -> bool {
        self.closed.zip(view).is_some_and(|(extent, view)| is_beyond_near(view.clip_from_object, extent))
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.copying.is_some() || self.comparing.is_some()
    }

    /// Forgets results that are about another document or tessellation.
    pub(crate) fn keep_only(&mut self, document: u64, tessellation: u64) {
        if let Some(of) = self.of.filter(|of| *of != (document, tessellation)) {
            let closed = self.closed.filter(|_| of.0 == document);
            self.forget();
            self.closed = closed;
        }
    }

    /// Stops the measurement. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        (self.comparing, self.copying) = (None, None);
    }

    /// Stops the measurement and forgets its results.
    pub(crate) fn forget(&mut self) {
        *self = Self { generation: self.generation + 1, ..Self::default() };
    }

    /// Goes on measuring document `document`, whose counts must be known. Starts over if its tessellation has changed, and
    /// if `follows` is set also if its view has. Returns true if the results have changed.
    ///
    /// # Errors
    /// The device was lost, or the measurement's thread panicked.
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
            let closed = self.closed;
            *self = Self { of, closed, generation: self.generation + 1, ..Self::start(gpu, scene, view) };
            return Ok(true);
        }
        if follows && self.seen_from != Some(view) {
            // Results that don't depend on the view stay.
            let (found, agreement) = (self.found.take(), self.agreement.take());
            let (closed, generation) = (self.closed, self.generation);
            *self = Self { of, found, agreement, closed, generation, ..Self::start(gpu, scene, view) };
            return Ok(true);
        }
        copy_on(&mut self.copying, gpu, scene)?;
        match self.comparing.as_ref().map(|comparing| comparing.found.try_recv()) {
            Some(Ok(Ok(Surveyed { found, closed, sizes, agreement }))) => {
                self.agreement = agreement;
                self.comparing = None;
                self.generation += u64::from(self.found.is_none());
                self.found = Some(found);
                self.closed = closed;
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

    /// The part of all chunks that has been copied, 0 to 1; none if none are being copied.
    pub(crate) fn fraction(&self, chunks: usize) -> Option<f32> {
        self.copying.as_ref().map(|copying| copying.next_chunk as f32 / chunks.max(1) as f32)
    }

    fn start(gpu: &Gpu, scene: &Scene, view: ScreenView) -> Self {
        let (parts, received) = sync_channel(WAITING);
        let (sender, found) = channel();
        let wanted = Progress::default();
        let posed = scene.tessellator.posed().clone();
        let convention = scene.tessellator.convention();
        let given = match scene.tessellator.given() {
            Some(Given::Factors(given)) => Some(AskedFactors::given(convention, given)),
            _ => None,
        };
        let still_wanted = wanted.clone();
        spawn(move || {
            let measure = || {
                let (mesh, topology) = posed.deformed();
                survey(&received, &mesh, &topology, given, view, &still_wanted)
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

/// Sends a part that has been copied to the measuring thread, and starts to copy the next chunk.
pub(in crate::app) fn copy_on(under_way: &mut Option<Copying>, gpu: &Gpu, scene: &mut Scene) -> Result<(), GpuError> {
    let Some(copying) = under_way else { return Ok(()) };
    match copying.readback.poll() {
        Ok(true) => {}
        Ok(false) => return Ok(()),
        Err(error) => {
            // Dropping the sender ends the measuring thread as well. It isn't started again by itself.
            *under_way = None;
            return Err(error);
        }
    }
    // The measuring thread ends early only if the measurement was replaced. Dropping the sender tells it the end.
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
    let sizes = scene.tessellator.buffers();
    let (asked, buffer, asked_bytes) = match scene.tessellator.own_factors() {
        Some(own) => (Asked::Shader, own, u64::from(sizes.patch_count) * size_of::<HullFactors>() as u64),
        None => {
            let (of_lod, edges) = scene.tessellator.edge_factors();
            (Asked::Lod(edges), of_lod, u64::from(sizes.factor_count) * size_of::<f32>() as u64)
        }
    };
    let readback = Readback::start(gpu, buffers.chain([(buffer, 0..asked_bytes)]));
    let convention = scene.tessellator.convention();
    let part = PartKind::Factors { patch_bytes: patch_bytes as usize, asked, convention };
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

/// Gives a chunk that was copied back to every visitor. Returns `None` if the device was lost.
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

/// Surveys the parts as they come. `given` are the factors that a file gave in place of LOD's. Returns `None` if the result is no longer wanted, or the device was lost.
fn survey(
    parts: &Receiver<Part>,
    mesh: &Mesh,
    topology: &Topology,
    given: Option<AskedFactors>,
    view: ScreenView,
    wanted: &Progress,
) -> Option<Surveyed> {
    let Ok(Part(PartKind::Factors { patch_bytes, asked, convention }, readback)) = parts.recv() else { return None };
    let bytes = readback.bytes().ok()?;
    let (factors, read) = bytes.split_at(patch_bytes);
    let own: Vec<HullFactors> = match asked {
        Asked::Shader => bytemuck::pod_collect_to_vec(read),
        Asked::Lod(_) => Vec::new(),
    };
    let asked = given.unwrap_or_else(|| match asked {
        Asked::Shader => AskedFactors::given(convention, &own),
        Asked::Lod(edges) => AskedFactors::new(edges, convention, bytemuck::pod_collect_to_vec(read)),
    });
    // Where the sides of edges got different factors from a shader is told as it is of a file.
    let agreement = (!own.is_empty()).then(|| Agreement::of(topology, &own, convention));
    let mut sizes = Sizes::new(view);
    let mut survey = Survey::new(mesh, topology, bytemuck::pod_collect_to_vec(factors), asked);
    for Part(part, readback) in parts {
        wanted.check().ok()?;
        let PartKind::Chunk { first_patch, vertex_bytes } = part else { continue };
        visit(first_patch, vertex_bytes, &readback, &mut [&mut survey, &mut sizes])?;
    }
    wanted.check().ok()?;
    let found = survey.finish();
    Some(Surveyed { closed: closed_extent(mesh, topology, &found), found, sizes, agreement })
}
