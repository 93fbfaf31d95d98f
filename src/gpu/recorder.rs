//! Records passes into one submission, and times them where that is requested.

use std::time::Instant;

use wgpu_profiler::{GpuProfiler, GpuProfilerSettings, GpuTimerQueryResult};

use super::{Gpu, GpuError};

/// How long one pass took.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    pub pass: &'static str,
    pub ms: f64,
}

/// How passes are timed. A pass is named by the label given to [`Recorder::compute`] or [`Recorder::render`].
#[derive(Default)]
pub enum Timing {
    #[default]
    Off,
    /// By the clock of the host: every pass is submitted alone and waited for. For drivers without usable timestamps, such as
    /// those in software.
    Submissions(Vec<PassTime>),
    /// The GPU's own timestamps.
    Timestamps(Box<GpuProfiler>),
}

impl Timing {
    /// The most precise way that this device has.
    pub fn on(gpu: &Gpu) -> Self {
        let profiler = || GpuProfiler::new(&gpu.device, GpuProfilerSettings::default());
        match gpu.has_timestamps().then(profiler) {
            Some(Ok(profiler)) => Self::Timestamps(Box::new(profiler)),
            _ => Self::Submissions(Vec::new()),
        }
    }
}

/// Whatever compute passes can be recorded into.
pub trait RecordPasses {
    /// Records one compute pass named `pass`.
    fn compute(&mut self, pass: &'static str, record: impl FnOnce(&mut wgpu::ComputePass));
}

/// The encoder of a host program, which submits it.
impl RecordPasses for wgpu::CommandEncoder {
    fn compute(&mut self, pass: &'static str, record: impl FnOnce(&mut wgpu::ComputePass)) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(pass), timestamp_writes: None };
        record(&mut self.begin_compute_pass(&descriptor));
    }
}

impl RecordPasses for Recorder<'_> {
    fn compute(&mut self, pass: &'static str, record: impl FnOnce(&mut wgpu::ComputePass)) {
        self.timed(pass, |encoder, query| {
            record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(pass),
                timestamp_writes: query.and_then(|query| query.compute_pass_timestamp_writes()),
            }));
        });
    }
}

/// Records passes into a command encoder, which [`Recorder::submit`] submits.
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

    /// Records one render pass named `pass`, with a colour attachment, a depth attachment, or both.
    pub fn render(
        &mut self,
        pass: &'static str,
        color: Option<wgpu::RenderPassColorAttachment>,
        depth: Option<wgpu::RenderPassDepthStencilAttachment>,
        record: impl FnOnce(&mut wgpu::RenderPass),
    ) {
        self.timed(pass, |encoder, query| {
            record(&mut encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(pass),
                color_attachments: if color.is_some() { std::slice::from_ref(&color) } else { &[] },
                depth_stencil_attachment: depth,
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
                self.gpu.wait();
                record(&mut self.encoder, None);
                let encoder = std::mem::replace(&mut self.encoder, new_encoder(self.gpu));
                let start = Instant::now();
                self.gpu.queue.submit([encoder.finish()]);
                self.gpu.wait();
                times.push(PassTime { pass, ms: start.elapsed().as_secs_f64() * 1e3 });
            }
            Timing::Timestamps(profiler) => {
                let query = profiler.begin_pass_query(pass, &mut self.encoder);
                record(&mut self.encoder, Some(&query));
                profiler.end_query(&mut self.encoder, query);
            }
        }
    }

    /// Submits what was recorded (when passes are timed by submission, what was recorded since the last one).
    pub fn submit(mut self) -> wgpu::SubmissionIndex {
        if let Timing::Timestamps(profiler) = self.timing {
            profiler.resolve_queries(&mut self.encoder);
        }
        let index = self.gpu.queue.submit([self.encoder.finish()]);
        if let Timing::Timestamps(profiler) = self.timing {
            // This fails only while a query is open, and `timed` ends every query that it begins.
            let ended = profiler.end_frame();
            debug_assert!(ended.is_ok());
        }
        index
    }
}

/// Records passes that aren't timed, and submits them.
///
/// # Errors
/// Those of `record`. Nothing is submitted then.
pub fn submit_untimed<T>(gpu: &Gpu, record: impl FnOnce(&mut Recorder) -> Result<T, GpuError>) -> Result<T, GpuError> {
    let mut timing = Timing::Off;
    let mut recorder = Recorder::new(gpu, &mut timing);
    let recorded = record(&mut recorder)?;
    recorder.submit();
    Ok(recorded)
}

/// How long each pass took that ran since the last call. A pass that ran several times in the last submission that had it (or,
/// without timestamps, since the last call) has the sum. With timestamps, only what the GPU has finished is known.
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

/// The names of all passes that are timed, in the order in which they run.
pub const PASSES: [&str; 13] = [
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
    "least",
    "coverage",
    "draw",
];

/// Those of [`PASSES`] that draw what was emitted, or compute what an overlay shows; the others emit it.
pub const DRAWING: [&str; 3] = ["least", "coverage", "draw"];

/// The time of those passes together that draw, or of the others, in ms.
pub fn ms_of(passes: &[PassTime], are_drawing: bool) -> f64 {
    passes.iter().filter(|time| DRAWING.contains(&time.pass) == are_drawing).map(|time| time.ms).sum()
}

/// The profiler returns labels as owned text; this finds the static name again.
fn pass_time(result: &GpuTimerQueryResult) -> Option<PassTime> {
    let pass = PASSES.into_iter().find(|pass| *pass == result.label)?;
    let time = result.time.as_ref()?;
    Some(PassTime { pass, ms: (time.end - time.start) * 1e3 })
}

fn new_encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("pnaen") })
}
