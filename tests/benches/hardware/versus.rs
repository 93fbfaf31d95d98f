//! Measures one subject with our passes and with the peer.

use geometry::tessellate::Partitioning;
use gpu::embed::GpuError;
use gpu::recorder::Timing;
use image::RgbaImage;
use inspect::engine::Engine;
use load::LoadError;
use thiserror::Error;

use super::numbers::Spread;
use super::ours::{Effort, OurTimes, Subject};
use super::peer::{Peer, Pipeline};
use super::pipelines::{Kind, Nets};
use super::vulkan::{Counted, Took, VulkanError};

/// Why a bench ended.
#[derive(Debug, Error)]
pub(crate) enum BenchError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Vulkan(#[from] VulkanError),
    #[error(transparent)]
    Exported(#[from] super::vulkan::exported::ExportedError),
    #[error(transparent)]
    Load(#[from] LoadError),
}

/// The peer's times for a subject in ms. For each, the faster of its two ways to read control nets counts.
pub(crate) struct PeerTimes {
    /// The stages before the rasteriser.
    pub tessellation: Spread,
    /// The whole picture.
    pub frame: Spread,
    pub wall: Spread,
    /// The medians of both ways, in the order of [`Nets::ALL`]: tessellation, and the whole picture.
    pub ways: [[f64; 2]; 2],
    pub counted: Option<Counted>,
    /// The mean difference between the px of its picture and ours, 0 to 1.
    pub difference: f64,
}

/// The measurements of one subject, ours and the peer's.
pub(crate) struct Versus {
    pub patches: u32,
    pub vertices: u64,
    pub triangles: u64,
    /// The number of chunks of our output.
    pub chunks: usize,
    /// The number of triangles of the last chunk that cover a sample, if the others were removed before drawing.
    pub covering: Option<u64>,
    /// See [`Subject::compulsory_bytes`].
    pub bytes: u64,
    pub ours: OurTimes,
    pub peer: Option<PeerTimes>,
}

impl Versus {
    /// Counts and times a subject.
    ///
    /// # Errors
    /// A device was lost, or has no memory.
    pub(crate) fn measure(
        engine: &Engine,
        peer: Option<&Peer>,
        subject: &mut Subject,
        effort: Effort,
    ) -> Result<Self, BenchError> {
        let (vertices, triangles) = subject.count(engine)?;
        let chunks = subject.scene.tessellator.chunk_count();
        let bytes = subject.compulsory_bytes();
        let peer = peer.map(|peer| time_peer(engine, peer, subject, effort)).transpose()?;
        let ours = subject.time(engine, effort)?;
        let patches = subject.scene.tessellator.buffers().patch_count;
        let covering = subject.scene.covering_triangles()?;
        Ok(Self { patches, vertices, triangles, chunks, covering, bytes, ours, peer })
    }
}

fn time_peer(engine: &Engine, peer: &Peer, subject: &mut Subject, effort: Effort) -> Result<PeerTimes, BenchError> {
    let factors = subject.scene.tessellator.hull_factors()?;
    let patches = peer.patches(&subject.nets(engine)?, &factors)?;
    let frame = subject.frame();
    let fronts_only = subject.fronts_only();
    let pipeline = |nets: Nets, rasterises: bool| {
        let partitioning = match subject.settings.tessellation.partitioning {
            Partitioning::FractionalOdd => Partitioning::FractionalOdd,
            _ => Partitioning::Integer,
        };
        peer.pipeline(Kind { nets, partitioning, fronts_only, rasterises })
    };
    let time = |pipeline: &Pipeline| effort.repeat(|_| peer.draw(pipeline, &patches, &frame));
    let gpu = |took: &[Took]| Spread::from_times(took.iter().map(|took| took.gpu));
    let mut times = PeerTimes {
        tessellation: Spread::default(),
        frame: Spread::default(),
        wall: Spread::default(),
        ways: [[0.0; 2]; 2],
        counted: None,
        difference: 0.0,
    };
    for (way, nets) in times.ways.iter_mut().zip(Nets::ALL) {
        let tessellation = gpu(&time(&pipeline(nets, false)?)?);
        let whole = pipeline(nets, true)?;
        let took = time(&whole)?;
        *way = [tessellation.median, gpu(&took).median];
        let is_first = nets == Nets::ALL[0];
        if is_first || tessellation.median < times.tessellation.median {
            times.tessellation = tessellation;
        }
        if is_first || gpu(&took).median < times.frame.median {
            times.frame = gpu(&took);
            times.wall = Spread::from_times(took.iter().map(|took| took.wall));
        }
        times.counted = peer.count(&whole, &patches, &frame)?;
        engine.draw(&mut subject.scene, &subject.target, &subject.camera, &subject.settings, &mut Timing::Off)?;
        let own = subject.target.read(&engine.gpu)?;
        times.difference = times.difference.max(mean_difference(&peer.picture()?, &own));
    }
    Ok(times)
}

fn mean_difference(picture: &RgbaImage, other: &RgbaImage) -> f64 {
    let steps = picture.iter().zip(other.iter()).map(|(own, other)| f64::from(own.abs_diff(*other)));
    steps.sum::<f64>() / (255.0 * picture.len().max(1) as f64)
}
