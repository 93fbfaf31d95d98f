//! Records passes into one submission, and times them where that is asked for.

use std::time::Instant;

use wgpu_profiler::{GpuProfiler, GpuProfilerSettings, GpuTimerQueryResult};

use super::{Gpu, GpuError};

/// How long one pass took.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    pub pass: &'static str,
    pub ms: f64,
}

/// How passes are timed. Names of passes are the labels given to [`Recorder::compute`] and [`Recorder::render`].
pub enum Timing {
    Off,
    /// Every pass is a submission of its own and is waited for: for drivers whose timestamps are wrong (software ones).
    Submissions(Vec<PassTime>),
    /// The GPU's own timestamps.
    Timestamps(Box<GpuProfiler>),
}

impl Timing {
    /// The best way that this device has.
    pub fn on(gpu: &Gpu) -> Self {
        let profiler = || GpuProfiler::new(&gpu.device, GpuProfilerSettings::default());
        match gpu.has_timestamps().then(profiler) {
            Some(Ok(profiler)) => Self::Timestamps(Box::new(profiler)),
            _ => Self::Submissions(Vec::new()),
        }
    }
}

/// An encoder under way.
pub struct Recorder<'a> {
    gpu: &'a Gpu,
    encoder: wgpu::CommandEncoder,
    timing: &'a mut Timing,
}

impl<'a> Recorder<'a> {
    pub fn new(gpu: &'a Gpu, timing: &'a mut Timing) -> Self {
        Self { gpu, encoder: new_encoder(gpu), timing }
    }

    /// The encoder itself, for copies.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        &mut self.encoder
    }

    /// Records one compute pass named `pass`.
    pub fn compute(&mut self, pass: &'static str, record: impl FnOnce(&mut wgpu::ComputePass)) {
        self.timed(pass, |encoder, query| {
            record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(pass),
                timestamp_writes: query.and_then(|query| query.compute_pass_timestamp_writes()),
            }));
        });
    }

    /// Records one render pass named `pass` into `attachments`.
    pub fn render(
        &mut self,
        pass: &'static str,
        color: wgpu::RenderPassColorAttachment,
        depth: wgpu::RenderPassDepthStencilAttachment,
        record: impl FnOnce(&mut wgpu::RenderPass),
    ) {
        self.timed(pass, |encoder, query| {
            record(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(pass),
                color_attachments: &[Some(color)],
                depth_stencil_attachment: Some(depth),
                timestamp_writes: query.and_then(|query| query.render_pass_timestamp_writes()),
                ..Default::default()
            }));
        });
    }

    fn timed(
        &mut self,
        pass: &'static str,
        record: impl FnOnce(&mut wgpu::CommandEncoder, Option<&wgpu_profiler::GpuProfilerQuery>),
    ) {
        match self.timing {
            Timing::Off => record(&mut self.encoder, None),
            Timing::Submissions(times) => {
                let before = std::mem::replace(&mut self.encoder, new_encoder(self.gpu));
                self.gpu.queue.submit([before.finish()]);
                wait(self.gpu);
                record(&mut self.encoder, None);
                let encoder = std::mem::replace(&mut self.encoder, new_encoder(self.gpu));
                let start = Instant::now();
                self.gpu.queue.submit([encoder.finish()]);
                wait(self.gpu);
                times.push(PassTime { pass, ms: start.elapsed().as_secs_f64() * 1e3 });
            }
            Timing::Timestamps(profiler) => {
                let query = profiler.begin_pass_query(pass, &mut self.encoder);
                record(&mut self.encoder, Some(&query));
                profiler.end_query(&mut self.encoder, query);
            }
        }
    }

    /// Submits what is left.
    pub fn submit(mut self) -> wgpu::SubmissionIndex {
        if let Timing::Timestamps(profiler) = self.timing {
            profiler.resolve_queries(&mut self.encoder);
        }
        let index = self.gpu.queue.submit([self.encoder.finish()]);
        if let Timing::Timestamps(profiler) = self.timing {
            // Fails only while a query is open, and every query above is closed where it was opened.
            let ended = profiler.end_frame();
            debug_assert!(ended.is_ok());
        }
        index
    }
}

/// How long each pass took when it last ran, of those that ran since the last call; runs of one pass in one submission
/// (or, without timestamps, since the last call) are added up. With timestamps, only what the GPU has finished.
pub fn take_times(gpu: &Gpu, timing: &mut Timing) -> Vec<PassTime> {
    let mut last: Vec<PassTime> = Vec::new();
    match timing {
        Timing::Off => {}
        Timing::Submissions(times) => last = summed(times.drain(..)),
        Timing::Timestamps(profiler) => {
            while let Some(results) = profiler.process_finished_frame(gpu.queue.get_timestamp_period()) {
                let times = summed(results.iter().filter_map(pass_time));
                last.retain(|earlier| times.iter().all(|time| time.pass != earlier.pass));
                last.extend(times);
            }
        }
    }
    last
}

fn summed(times: impl Iterator<Item = PassTime>) -> Vec<PassTime> {
    let mut sums: Vec<PassTime> = Vec::new();
    for time in times {
        match sums.iter_mut().find(|sum| sum.pass == time.pass) {
            Some(sum) => sum.ms += time.ms,
            None => sums.push(time),
        }
    }
    sums
}

/// The names that passes have; a profiler's results give them back as owned text.
pub const PASSES: [&str; 12] = [
    "deform",
    "nets",
    "directions",
    "factors",
    "levels",
    "counts",
    "scan",
    "chunks",
    "emit",
    "displace",
    "coverage",
    "draw",
];

/// Those of them that make a picture of what was emitted.
pub const DRAWING: [&str; 2] = ["coverage", "draw"];

fn pass_time(result: &GpuTimerQueryResult) -> Option<PassTime> {
    let pass = PASSES.into_iter().find(|pass| *pass == result.label)?;
    let time = result.time.as_ref()?;
    Some(PassTime { pass, ms: (time.end - time.start) * 1e3 })
}

fn new_encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("pnaen") })
}

/// Waits until the device has done all that was submitted. A lost device is found out by whoever reads next.
pub fn wait(gpu: &Gpu) {
    gpu.poll(wgpu::PollType::wait_indefinitely());
}

/// Reads `bytes` bytes of `buffer` from `offset` on, waiting for them. Sizes and offsets are multiples of 4.
///
/// # Errors
/// The device was lost.
pub fn read_buffer(gpu: &Gpu, buffer: &wgpu::Buffer, offset: u64, bytes: u64) -> Result<Vec<u8>, GpuError> {
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let staging = staging_buffer(gpu, bytes);
    let mut encoder = new_encoder(gpu);
    encoder.copy_buffer_to_buffer(buffer, offset, &staging, 0, bytes);
    gpu.queue.submit([encoder.finish()]);
    read_staging(gpu, &staging)
}

/// A buffer that copies land in and the host maps.
pub fn staging_buffer(gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pnaen.staging"),
        size: bytes,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

/// Maps a staging buffer, waiting for it, and copies its bytes out.
///
/// # Errors
/// The device was lost.
pub fn read_staging(gpu: &Gpu, staging: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.map_async(wgpu::MapMode::Read, .., move |result| {
        let _ = sender.send(result);
    });
    wait(gpu);
    // What went wrong on the way explains more than what it led to.
    gpu.check()?;
    match receiver.recv() {
        Ok(Ok(())) => mapped_bytes(staging),
        Ok(Err(error)) => Err(GpuError::Readback(error.to_string())),
        Err(error) => Err(GpuError::Readback(error.to_string())),
    }
}

/// The bytes of a buffer that has been mapped.
///
/// # Errors
/// The buffer isn't mapped.
pub fn mapped_bytes(staging: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let view = staging.get_mapped_range(..).map_err(|error| GpuError::Readback(error.to_string()))?;
    Ok(view.to_vec())
}
