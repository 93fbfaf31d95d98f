//! Cracks of what is shown, measured beside the window: chunk after chunk is copied back without waiting, and compared
//! on a thread of its own.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use crate::gpu::{Gpu, GpuError, Recorder, Timing, mapped_bytes, staging_buffer};
use crate::measure::{Cracks, Rims};
use crate::mesh::{Progress, Topology};
use crate::render::Scene;
use crate::tessellate::{PatchFactors, Vertex};

/// What is known about the cracks of the shown tessellation.
#[derive(Default)]
pub struct Measuring {
    /// Document and tessellation that were last asked for.
    of: Option<(u64, u64)>,
    copying: Option<Copying>,
    comparing: Option<Comparing>,
    found: Option<Found>,
    /// Counts results, and their absence.
    pub generation: u64,
}

/// The thread that compares; it gives up when this is dropped.
struct Comparing {
    found: Receiver<Found>,
    wanted: Progress,
}

impl Drop for Comparing {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}

struct Found {
    cracks: Cracks,
    culled: u32,
}

/// A readback under way. Its parts go to the comparing thread in order.
struct Copying {
    staging: wgpu::Buffer,
    first_patch: Option<u32>,
    mapped: Receiver<Result<(), wgpu::BufferAsyncError>>,
    next_chunk: usize,
    parts: Sender<Part>,
}

enum Part {
    Factors(Vec<u8>),
    Vertices(u32, Vec<u8>),
    /// All there is.
    End,
}

impl Measuring {
    /// The cracks of what is shown, once measured.
    pub fn cracks(&self) -> Option<&Cracks> {
        self.found.as_ref().map(|found| &found.cracks)
    }

    /// How many patches emit nothing, once measured.
    pub fn culled(&self) -> Option<u32> {
        self.found.as_ref().map(|found| found.culled)
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
        let (topology, still_wanted) = (scene.tessellator.topology().clone(), wanted.clone());
        std::thread::spawn(move || {
            if let Some(result) = compare(&received, &topology, &still_wanted) {
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
        let part = match copying.first_patch {
            None => Part::Factors(bytes),
            Some(first_patch) => Part::Vertices(first_patch, bytes),
        };
        // The comparing thread ends early only when the measurement was replaced.
        let _ = copying.parts.send(part);
        if copying.next_chunk < scene.tessellator.chunk_count() {
            self.copying = Some(copy_chunk(gpu, scene, copying.next_chunk, copying.parts));
        } else {
            let _ = copying.parts.send(Part::End);
        }
        Ok(())
    }
}

fn copy_factors(gpu: &Gpu, scene: &Scene, parts: Sender<Part>) -> Copying {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    let item = size_of::<PatchFactors>() as u64;
    let total: u64 = scene.tessellator.patch_factors().map(|(_, count)| u64::from(count) * item).sum();
    let staging = staging_buffer(gpu, total.max(4));
    let mut offset = 0;
    for (buffer, count) in scene.tessellator.patch_factors() {
        let bytes = u64::from(count) * item;
        recorder.encoder().copy_buffer_to_buffer(buffer, 0, &staging, offset, bytes);
        offset += bytes;
    }
    recorder.submit();
    let mapped = map(&staging);
    Copying { staging, first_patch: None, mapped, next_chunk: 0, parts }
}

fn copy_chunk(gpu: &Gpu, scene: &mut Scene, index: usize, parts: Sender<Part>) -> Copying {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    scene.tessellator.emit(&mut recorder, index);
    let chunk = scene.tessellator.chunk(index);
    let bytes = u64::from(chunk.chunk.vertex_count) * size_of::<Vertex>() as u64;
    let staging = staging_buffer(gpu, bytes.max(4));
    recorder.encoder().copy_buffer_to_buffer(chunk.vertices, 0, &staging, 0, bytes);
    let first_patch = Some(chunk.chunk.first_patch);
    recorder.submit();
    let mapped = map(&staging);
    Copying { staging, first_patch, mapped, next_chunk: index + 1, parts }
}

fn map(staging: &wgpu::Buffer) -> Receiver<Result<(), wgpu::BufferAsyncError>> {
    let (sender, mapped) = channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = sender.send(result);
    });
    mapped
}

/// Puts the parts together, and compares once all are there. `None` if no longer wanted.
fn compare(parts: &Receiver<Part>, topology: &Arc<Topology>, wanted: &Progress) -> Option<Found> {
    let Ok(Part::Factors(factors)) = parts.recv() else { return None };
    let mut factors: Vec<PatchFactors> = bytemuck::pod_collect_to_vec(&factors);
    factors.truncate(topology.patches.len());
    let mut rims = Rims::new(factors);
    loop {
        wanted.check().ok()?;
        match parts.recv().ok()? {
            Part::Vertices(first_patch, bytes) => {
                rims.take(first_patch, &bytemuck::pod_collect_to_vec::<u8, Vertex>(&bytes));
            }
            Part::Factors(_) | Part::End => break,
        }
    }
    Some(Found { culled: rims.culled(), cracks: rims.cracks(topology) })
}
