//! A walk over what a scene emits while the window goes on: chunk after chunk is copied back without waiting, and a thread of its own
//! visits them.

use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, sync_channel};

use super::background_job::{Stopped, caught, sent};
use geometry::progress::Progress;
use gpu::{Gpu, GpuError, Readback};
use inspect::engine::CopiedChunk;
use inspect::measure::Visitor;
use inspect::render::Scene;

/// How many parts may wait for the thread: each is as large as the arena.
const WAITING: usize = 1;

/// A walk that is under way, to a result.
pub(crate) struct Walk<T> {
    ended: Receiver<Result<T, Stopped>>,
    /// None once everything is copied.
    copying: Option<PendingReadback>,
    chunks: usize,
    wanted: Progress,
}

/// How a walk ended: with its result, without one as the device was lost or nobody wanted it, or with a panic.
type Ended<T> = Result<Option<T>, Stopped>;

/// A readback under way. It goes to the thread in its turn.
struct PendingReadback {
    part: Part,
    next_chunk: usize,
    parts: SyncSender<Part>,
}

enum Part {
    /// What a walk needs besides what is emitted.
    First(Readback),
    Chunk(CopiedChunk),
}

/// What the thread receives, in order.
pub(in crate::app) struct Parts<'a> {
    received: Receiver<Part>,
    chunks: usize,
    pub wanted: &'a Progress,
}

impl<T> Drop for Walk<T> {
    fn drop(&mut self) {
        // Before the channel closes, which would tell the thread that it has everything.
        self.wanted.cancel();
    }
}

impl<T: Send + 'static> Walk<T> {
    /// Starts to walk over a scene, whose counts must be known. `visit` runs on the thread; it returns `None` if the parts end too soon.
    /// It gets `first`, if there is such a readback, before all chunks.
    ///
    /// # Errors
    /// The device was lost.
    pub(in crate::app) fn start(
        gpu: &Gpu,
        scene: &mut Scene,
        first: Option<Readback>,
        visit: impl FnOnce(&Parts) -> Option<T> + Send + 'static,
    ) -> Result<Self, GpuError> {
        let (parts, received) = sync_channel(WAITING);
        let wanted = Progress::default();
        let copying = match first {
            Some(readback) => Some(PendingReadback { part: Part::First(readback), next_chunk: 0, parts }),
            None => copy_chunk(gpu, scene, 0, parts)?,
        };
        let (chunks, still_wanted) = (scene.tessellator.chunk_count(), wanted.clone());
        let walk = move || visit(&Parts { received, chunks, wanted: &still_wanted });
        let ended = sent(None, || caught(walk).transpose());
        Ok(Self { ended, copying, chunks, wanted })
    }

    /// Goes on copying. Returns how the walk ended, once it has.
    ///
    /// # Errors
    /// The device was lost. The walk then ends without a result.
    pub(in crate::app) fn go_on(&mut self, gpu: &Gpu, scene: &mut Scene) -> Result<Option<Ended<T>>, GpuError> {
        if let Some(copying) = self.copying.take() {
            self.copying = copying.go_on(gpu, scene)?;
        }
        Ok(match self.ended.try_recv() {
            Ok(result) => Some(result.map(Some)),
            Err(TryRecvError::Disconnected) => Some(Ok(None)),
            Err(TryRecvError::Empty) => None,
        })
    }

    /// The part of several chunks that has been copied, 0 to 1; none if none are being copied.
    pub(in crate::app) fn copied(&self) -> Option<f32> {
        let copying = self.copying.as_ref().filter(|_| self.chunks > 1)?;
        Some(copying.next_chunk as f32 / self.chunks as f32)
    }

    /// The part of its work that the thread says it has done, 0 to 1.
    pub(in crate::app) fn fraction(&self) -> f32 {
        self.wanted.fraction()
    }

    /// Stops copying, so that the walk ends without a result.
    pub(in crate::app) fn stop_copying(&mut self) {
        self.copying = None;
    }
}

impl PendingReadback {
    /// Sends the part to the thread once it has been copied, and starts to copy the next chunk.
    fn go_on(mut self, gpu: &Gpu, scene: &mut Scene) -> Result<Option<Self>, GpuError> {
        let (Part::First(readback) | Part::Chunk(CopiedChunk { readback, .. })) = &mut self.part;
        if !readback.poll()? {
            return Ok(Some(self));
        }
        let Self { part, next_chunk, parts } = self;
        match parts.try_send(part) {
            Err(TrySendError::Full(part)) => Ok(Some(Self { part, next_chunk, parts })),
            // The thread ends early only if nobody wants its result. Dropping the sender tells it the end.
            _ => copy_chunk(gpu, scene, next_chunk, parts),
        }
    }
}

/// Starts to copy a chunk; none if there are no more.
fn copy_chunk(
    gpu: &Gpu,
    scene: &mut Scene,
    index: usize,
    parts: SyncSender<Part>,
) -> Result<Option<PendingReadback>, GpuError> {
    if index >= scene.tessellator.chunk_count() {
        return Ok(None);
    }
    let part = Part::Chunk(CopiedChunk::start(gpu, scene, index)?);
    Ok(Some(PendingReadback { part, next_chunk: index + 1, parts }))
}

impl Parts<'_> {
    /// The bytes of the walk's first readback. None if nobody wants the walk any more, or the device was lost.
    pub(in crate::app) fn first(&self) -> Option<Vec<u8>> {
        let Ok(Part::First(readback)) = self.received.recv() else { return None };
        readback.bytes().ok()
    }

    /// Gives all chunks to every visitor, as they come. Returns none if nobody wants the walk any more, or the device was lost.
    pub(in crate::app) fn visit(&self, visitors: &mut [&mut dyn Visitor]) -> Option<()> {
        let (mut count, mut vertices) = (0, Vec::new());
        for part in &self.received {
            self.wanted.check().ok()?;
            let Part::Chunk(chunk) = part else { continue };
            chunk.visit(&mut vertices, visitors).ok()?;
            count += 1;
        }
        self.wanted.check().ok()?;
        (count == self.chunks).then_some(())
    }
}
